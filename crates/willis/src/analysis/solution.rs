//! One equilibrium of an operating point as the answer shows it.

use crate::exact::Rational;
use crate::kinematics::{Configuration, Motion};
use crate::operating_point::{Convergence, Extrapolation, LossKind, Physics, ShaftLoad, Step};
use crate::power_flow::{Drag, Flow};
use crate::statics::{Equilibrium, Solution, torque_exact};
use crate::train::{FRAME, MemberId, MemberKind, Operation};

use super::doubts::doubts;
use super::loads::Loads;
use super::rounds::Agreed;
use super::{
    CirculationReport, Losses, MemberNumbers, MemberReport, MeshReport, NameMap, Role, ShiftElementReport,
    SolutionReport, variators,
};

/// Everything a solution is seen against.
pub(super) struct Frame<'a> {
    pub c: &'a Configuration<'a>,
    pub motion: &'a Motion,
    pub sigma: &'a [Option<i8>],
    pub problem: &'a Loads,
    /// The loads without drags.
    pub undragged: &'a Loads,
    pub equilibrium: &'a Equilibrium,
    pub operation: &'a Operation,
    pub drags: &'a [Drag],
    /// Whether efficiencies are wanted as fractions, beside what decides a sign.
    pub exactly: bool,
    /// Where losses are computed: the laws, and the step in force.
    pub physics: Option<(&'a Physics<'a>, &'a (Step, Convergence))>,
    /// Its numbers, where they were found in floating point.
    pub agreed: Option<&'a Agreed>,
}

impl Frame<'_> {
    pub fn flow(&self, s: &Solution) -> Flow {
        let acting = self.problem.acting(self.c, self.motion, self.equilibrium, s);
        if let Some(agreed) = self.agreed {
            return agreed.whole(self.c, &acting);
        }
        Flow::new(self.c, self.motion, s, self.problem.scale(), &acting, self.drags, &self.problem.driven)
    }

    /// The equilibrium in SI, with its margins, and where laws were used outside their ranges.
    pub fn solution(&self, s: &Solution) -> (SolutionReport, Vec<Extrapolation>) {
        let flow = self.flow(s);
        let train = self.c.train;
        let held = held(self.c, self.operation);
        let members =
            (1..train.members.len()).map(|m| (train.members[m].name.clone(), self.member(MemberId(m), &flow, &held)));
        let members = NameMap(members.collect());
        let strains = self.physics.map(|(p, (step, _))| p.strains(step, &flow));
        let doubts = strains.as_ref().map_or_else(Vec::new, |s| doubts(train, flow.input_power, s));
        let contacts = self.physics.map_or_else(NameMap::default, |(p, (step, _))| p.contacts(step, &flow));
        let (mut bearings, mut shaft_loads, mut extrapolations) = Default::default();
        if let (Some((physics, _)), Some(strains)) = (self.physics, strains) {
            bearings = physics.bearing_reports(&strains);
            let named = |(m, load): (MemberId, ShaftLoad)| (train.member_name(m).to_owned(), load);
            shaft_loads = NameMap(strains.shafts.into_iter().map(named).collect());
            extrapolations = strains.extrapolations;
        }
        let meshes = flow.meshes.iter().map(|f| {
            let mesh = &train.meshes[f.mesh.0];
            let report = MeshReport {
                driver: f.driver.map(|d| train.member_name(mesh.gears[d].member).to_owned()),
                relative_speed_rad_s: f.relative_speeds[f.driver.unwrap_or(0)],
                potential_power_w: f.potential_power,
                efficiency: match self.physics {
                    Some((physics, (step, _))) if f.potential_power > 0.0 => {
                        1.0 - physics.tooth_loss(step, f.mesh.index(), &flow) / f.potential_power
                    }
                    _ => f.efficiency,
                },
                loss_w: match self.physics {
                    Some((physics, (step, _))) => physics.tooth_loss(step, f.mesh.index(), &flow),
                    None => f.loss,
                },
                first_torque_n_m: f.torques[0] + 0.0,
                second_torque_n_m: f.torques[1] + 0.0,
                carrier_torque_n_m: f.torques[2] + 0.0,
                count: mesh.count,
            };
            (mesh.name.clone(), report)
        });
        let meshes = NameMap(meshes.collect());
        let shift_elements = flow.ties.iter().map(|t| {
            let e = &train.shift_elements[t.element.0];
            let members = e.members.map(|m| train.member_name(m).to_owned());
            (e.name.clone(), ShiftElementReport { kind: e.kind, members, torque_n_m: t.torque.map(|t| t + 0.0) })
        });
        let all_dissipated = flow.roles.contains(&1) && !flow.roles.contains(&-1);
        let rational = self.exact_efficiency(s).filter(|_| self.physics.is_none());
        // The same bits whether or not it is asked for.
        let decided = rational.as_ref().filter(|_| s.exact.is_some());
        let sources = self.physics.map(|(p, (step, _))| p.sources(step, &flow)).unwrap_or_default();
        let losses_w = match self.physics {
            Some((physics, (step, _))) => Losses::of(physics, step, &flow),
            None => {
                let variator = flow.variators.iter().map(|v| v.loss).sum::<f64>() + 0.0;
                Losses { mesh: flow.meshes.iter().map(|m| m.loss).sum::<f64>() + 0.0, variator, ..Losses::default() }
            }
        };
        let efficiency = decided.filter(|_| flow.input_power > 0.0).map(Rational::to_f64).or_else(|| efficiency(&flow));
        let report = SolutionReport {
            efficiency,
            efficiency_exact: rational.filter(|_| self.problem.is_exact),
            all_dissipated,
            input_power_w: flow.input_power,
            output_power_w: flow.output_power,
            loss_w: flow.loss,
            power_residual_w: flow.residual,
            members,
            meshes,
            shift_elements: NameMap(shift_elements.collect()),
            variators: variators::reports(train, &flow),
            beyond_limits: variators::beyond(train, &flow),
            losses_w,
            sources,
            contacts,
            doubts,
            shaft_loads,
            bearings,
            drags: self.physics.map(|(p, (step, _))| p.drags(step, &flow)).unwrap_or_default(),
            convergence: self.physics.map(|(_, (_, convergence))| *convergence),
            recirculation: flow
                .circulations(self.c)
                .iter()
                .map(|r| CirculationReport {
                    power_w: r.power,
                    share_of_input: r.power / flow.input_power,
                    path: r.path.clone(),
                })
                .collect(),
            margin: self.margin(s, &flow),
            stiction: self.stiction(s, &flow),
        };
        (report, extrapolations)
    }

    /// What a member does; `held` are those at rest by a brake, the operation, or what is tied to them.
    fn member(&self, id: MemberId, flow: &Flow, held: &[MemberId]) -> MemberReport {
        let train = self.c.train;
        let MemberNumbers { speed_rad_s, torque_n_m, power_w, role } = member(self.motion, flow, held, id);
        let carrier = (train.members[id.0].kind == MemberKind::Planet || self.c.inner[id.0])
            .then(|| train.meshes.iter().find(|x| x.gears.iter().any(|g| g.member == id)).map(|x| x.carrier))
            .flatten();
        MemberReport {
            speed_rad_s,
            carrier: carrier.filter(|c| *c != FRAME).map(|c| train.member_name(c).to_owned()),
            relative_speed_rad_s: carrier.and_then(|c| {
                let (w, c) = (self.motion.speeds[id.0].as_ref()?, self.motion.speeds[c.0].as_ref()?);
                Some((w - c).to_f64() * std::f64::consts::PI.powi(self.motion.pi_power.into()))
            }),
            torque_n_m,
            power_w,
            role,
        }
    }

    /// Output over input power in rationals; `None` where that is not asked for.
    fn exact_efficiency(&self, s: &Solution) -> Option<Rational> {
        let worked_out = || self.equilibrium.exact_forces_of(s, &self.problem.torques);
        let forces = s.exact.clone().or_else(|| if self.exactly { worked_out() } else { None })?;
        let (mut power_in, mut power_out) = (Rational::ZERO, Rational::ZERO);
        let mut add = |power: Rational| match power.sign() {
            1 => power_in += power,
            -1 => power_out += -power,
            _ => {}
        };
        for (member, prescribed) in &self.problem.terminals {
            let speed = self.motion.speeds[member.0].as_ref()?;
            let torque = match (prescribed, self.c.node(*member)) {
                (Some(t), _) => t.clone(),
                (None, Some(n)) => &torque_exact(self.c, self.equilibrium, s, &forces, n) - &self.problem.torques[n],
                (None, None) => continue,
            };
            add(speed * &torque);
        }
        (power_in.sign() > 0).then(|| power_out / power_in)
    }
}

/// Output over input power; `None` where no power comes in.
pub(super) fn efficiency(flow: &Flow) -> Option<f64> {
    let of = || if flow.loss == 0.0 { 1.0 } else { (flow.output_power / flow.input_power).clamp(0.0, 1.0) + 0.0 };
    (flow.input_power > 0.0).then(of)
}

/// Members held by a brake, by the operation, or tied to something that is.
pub(super) fn held(c: &Configuration<'_>, operation: &Operation) -> Vec<MemberId> {
    let brakes = c.engaged.iter().flat_map(|e| {
        let m = c.train.shift_elements[e.0].members;
        if m.contains(&FRAME) { m.to_vec() } else { vec![] }
    });
    brakes.chain(operation.fixed.iter().copied()).filter(|m| *m != FRAME).collect()
}

/// The numbers of a member; `held` as [`held`] has them.
pub(super) fn member(motion: &Motion, flow: &Flow, held: &[MemberId], id: MemberId) -> MemberNumbers {
    let speed = motion.si(id);
    let torque = flow.torques[id.0];
    let power = match (torque, speed) {
        // What acts beside it holds a shaft at rest, and has no power.
        (Some(_), Some(_)) if flow.powers[id.0] != 0.0 => Some(flow.powers[id.0]),
        (Some(t), Some(w)) => Some(t * w),
        (None, Some(0.0)) | (Some(0.0), None) => Some(0.0),
        _ => None,
    };
    let at_rest = motion.speeds[id.0].as_ref().is_some_and(Rational::is_zero);
    let role = match flow.roles[id.0] {
        _ if held.contains(&id) => Role::Fixed,
        1 => Role::Input,
        -1 => Role::Output,
        _ if at_rest && torque.is_none_or(|t| t != 0.0) => Role::Fixed,
        _ => Role::Idle,
    };
    MemberNumbers { speed_rad_s: speed, torque_n_m: torque.map(|t| t + 0.0), power_w: power.map(|p| p + 0.0), role }
}

impl Losses {
    /// By kind, of a step whose flow this is.
    pub(super) fn of(physics: &Physics<'_>, step: &Step, flow: &Flow) -> Self {
        let mut all = Self::default();
        physics.each_loss(step, &flow.meshes, &flow.drag_losses, |_, kind, _, loss| all.add(kind, loss));
        flow.variators.iter().for_each(|v| all.add(LossKind::Variator, v.loss));
        all
    }
}
