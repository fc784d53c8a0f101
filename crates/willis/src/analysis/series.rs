//! Many operating points of one train, one after the other: what they have in common is worked out once.
//!
//! A point whose directions of motion and drivers are those of one before it needs no exact statics: its losses and
//! torques are brought into agreement in floating point, in the same steps as those of any other point with laws, and a
//! bound on rounding shows that there is no other equilibrium. So its numbers are the same to the last bit. Every point
//! of which that is not beyond doubt is answered the long way. It is so too where the train changes and turns as before,
//! with another roughness or another law.

use std::cell::RefCell;
use std::sync::Arc;

use crate::diagnostic::Diagnostics;
use crate::exact::Rational;
use crate::heat::{HeatVerdict, Limits, Source, balance};
use crate::kinematics::{Configuration, Layout, Motion, Transfer};
use crate::operating_point::{KnownPaths, Physics, Step};
use crate::power_flow::{External, MeshFlow};
use crate::train::heat::Heat;
use crate::train::{Load, MemberId, Operation, ShiftElementId, ShiftElementKind, Train};

use super::doubts::doubts;
use super::heat::{TOLERANCE, made_by};
use super::loads::Loads;
use super::operation::{Pattern, turned_back};
use super::rounds::{Acting, Agreed, KnownIdle, Rounds};
use super::solution::{efficiency, held, member};
use super::words::{self, Finding};
use super::{LossSource, Losses, OperationReport, OutsideLaw, Role, SolutionReport, Why, at_its_temperature};

/// Most patterns of drivers that are kept of points that prescribe the same.
const MOST_PATTERNS: usize = 16;
/// Most choices of what is prescribed that are kept.
const MOST_SITUATIONS: usize = 64;
/// The numbers of a member in an operating point.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct MemberNumbers {
    /// Absolute speed, rad/s; absent when not determined.
    pub speed_rad_s: Option<f64>,
    /// External torque on it, N m; absent when statics cannot divide it.
    pub torque_n_m: Option<f64>,
    /// External power into it, W.
    pub power_w: Option<f64>,
    /// What it does.
    pub role: Role,
}

/// The numbers of the one equilibrium of an operating point that studies ask for most: a part of
/// [`SolutionReport`], without names.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct PointNumbers {
    /// Output over input power; 0 when everything is dissipated, absent when nothing is loaded.
    pub efficiency: Option<f64>,
    /// Power in, W.
    pub input_power_w: f64,
    /// Power out, W.
    pub output_power_w: f64,
    /// All losses, W.
    pub loss_w: f64,
    /// Input less output less losses, W.
    pub power_residual_w: f64,
    /// Losses by kind.
    pub losses_w: Losses,
    /// Every member but the frame, in the order of [`Train::members`].
    pub members: Vec<MemberNumbers>,
    /// The member that drives in each mesh, seen from its carrier; none when idle or without relative motion.
    pub drivers: Vec<Option<MemberId>>,
}

impl PointNumbers {
    /// The numbers of a member; none of the frame.
    pub fn member(&self, member: MemberId) -> Option<&MemberNumbers> {
        self.members.get(member.index().checked_sub(1)?)
    }

    /// Of a solution of a train.
    pub fn of(train: &Train, s: &SolutionReport) -> Self {
        let members = s.members.iter().map(|(_, m)| MemberNumbers {
            speed_rad_s: m.speed_rad_s,
            torque_n_m: m.torque_n_m,
            power_w: m.power_w,
            role: m.role,
        });
        let driver = |(mesh, (_, m)): (&crate::train::Mesh, &(String, super::MeshReport))| {
            let name = m.driver.as_ref()?;
            mesh.gears.iter().map(|g| g.member).find(|m| train.member_name(*m) == name)
        };
        Self {
            efficiency: s.efficiency,
            input_power_w: s.input_power_w,
            output_power_w: s.output_power_w,
            loss_w: s.loss_w,
            power_residual_w: s.power_residual_w,
            losses_w: s.losses_w,
            members: members.collect(),
            drivers: train.meshes.iter().zip(&s.meshes.0).map(driver).collect(),
        }
    }
}

/// What is told of a point.
#[expect(clippy::large_enum_variant, reason = "one at a time on the stack; a box would allocate at every point")]
pub(crate) enum Told {
    /// All that is known, with its warnings and notes.
    Whole(Box<OperationReport>, Diagnostics),
    /// The numbers of a point with exactly one equilibrium, what is to be said of that, warnings and notes, and which laws
    /// they are about. `sources` are the losses by source, largest first, where they are asked for.
    Numbers {
        numbers: PointNumbers,
        sources: Vec<LossSource>,
        why: Option<Why>,
        notes: Diagnostics,
        outside: Vec<OutsideLaw>,
    },
}

/// Answers at many operating points of one train.
pub(crate) struct PointSeries<'t> {
    train: &'t Train,
    situations: Vec<Situation<'t>>,
    before: Ancestors,
}

/// What is known of trains before: which ends drive at points that prescribe the same, and the paths of contact.
#[derive(Default)]
pub(crate) struct Ancestors {
    all: Vec<Ancestor>,
    paths: KnownPaths,
}

/// What is left of a situation when its train is gone.
struct Ancestor {
    asked: Asked,
    layout: Layout,
    transfer: Transfer,
    patterns: Vec<Arc<Pattern>>,
}

/// What points that prescribe the same quantities have in common.
struct Situation<'t> {
    asked: Asked,
    c: Configuration<'t>,
    transfer: Transfer,
    physics: Physics<'t>,
    patterns: Vec<Arc<Pattern>>,
    /// Of the last point: its neighbour may turn alike.
    idle: Option<KnownIdle>,
}

/// What is prescribed, without the values.
#[derive(PartialEq)]
struct Asked {
    state: Option<usize>,
    fixed: Vec<MemberId>,
    speeds: Vec<MemberId>,
    loads: Vec<(MemberId, bool)>,
}

impl Asked {
    fn of(operation: &Operation) -> Self {
        Self {
            state: operation.state,
            fixed: operation.fixed.clone(),
            speeds: operation.speeds.iter().map(|s| s.0).collect(),
            loads: operation.loads.iter().map(|(m, load)| (*m, matches!(load, Load::Power(_)))).collect(),
        }
    }

    fn is_of(&self, operation: &Operation) -> bool {
        let loads = operation.loads.iter().map(|(m, load)| (*m, matches!(load, Load::Power(_))));
        self.state == operation.state
            && self.fixed == operation.fixed
            && self.speeds.iter().copied().eq(operation.speeds.iter().map(|s| s.0))
            && self.loads.iter().copied().eq(loads)
    }
}

impl<'t> PointSeries<'t> {
    pub fn new(train: &'t Train) -> Self {
        Self::after(train, Ancestors::default())
    }

    /// Of a train that may turn like one before.
    pub fn after(train: &'t Train, before: Ancestors) -> Self {
        Self { train, situations: vec![], before }
    }

    /// What the series of another train can take over.
    pub fn into_ancestors(self) -> Ancestors {
        let Ancestors { all: before, mut paths } = self.before;
        self.situations.iter().for_each(|s| paths.keep(&s.physics));
        let own = self.situations.into_iter().filter(|s| !s.patterns.is_empty());
        let mut all: Vec<Ancestor> = own
            .map(|s| Ancestor { asked: s.asked, layout: s.c.layout(), transfer: s.transfer, patterns: s.patterns })
            .collect();
        for old in before {
            if all.len() < MOST_SITUATIONS && !all.iter().any(|a| a.asked == old.asked && a.layout == old.layout) {
                all.push(old);
            }
        }
        Ancestors { all, paths }
    }

    /// All that is known of a point.
    pub fn whole(&self, operation: &Operation) -> Result<Told, Diagnostics> {
        self.settled(operation).map(|(told, _)| told)
    }

    /// The numbers of a point, with its losses by source where `sources` are asked for, or all that is known of it.
    pub fn numbers(&mut self, operation: &Operation, sources: bool) -> Result<Told, Diagnostics> {
        if let Some(told) = self.quick(operation, sources) {
            return Ok(told);
        }
        let (told, pattern) = self.settled(operation)?;
        if let Some(pattern) = pattern
            && let Some(situation) = self.situation(operation)
            && situation.patterns.len() < MOST_PATTERNS
            && !situation.patterns.iter().any(|known| known.is_like(&pattern))
        {
            situation.patterns.push(Arc::new(pattern));
        }
        Ok(told)
    }

    fn settled(&self, operation: &Operation) -> Result<(Told, Option<Pattern>), Diagnostics> {
        let settled = at_its_temperature(self.train, operation, false)
            .map_err(|wrong| words::refused(self.train, operation, &wrong))?;
        let notes = words::found(self.train, operation, &settled.findings);
        Ok((Told::Whole(Box::new(settled.report), notes), settled.origin.map(|origin| origin.pattern)))
    }

    /// What the points that prescribe the same as this one have in common; none for those that are always answered the long
    /// way.
    fn situation(&mut self, operation: &Operation) -> Option<&mut Situation<'t>> {
        let train = self.train;
        // What of a margin is worth a warning is only known the long way, and only where two values can change.
        let many = operation.speeds.len() > 1 || operation.loads.len() > 1;
        if many || !train.depends_on_load() || !train.variators.is_empty() {
            return None;
        }
        if let Some(k) = self.situations.iter().position(|s| s.asked.is_of(operation)) {
            return Some(&mut self.situations[k]);
        }
        let engaged = operation.state.map_or(&[][..], |k| &train.states[k].engaged);
        let one_way = |e: &ShiftElementId| train.shift_elements[e.0].kind == ShiftElementKind::OneWay;
        if self.situations.len() == MOST_SITUATIONS || engaged.iter().any(one_way) {
            return None;
        }
        let physics = Physics::new(train, operation);
        self.before.paths.give(&physics);
        let speeds: Vec<MemberId> = operation.speeds.iter().map(|s| s.0).collect();
        let keep: Vec<MemberId> = speeds.iter().copied().chain(physics.visible()).collect();
        let c = Configuration::new(train, engaged, &operation.fixed, &keep);
        let layout = c.layout();
        let alike = self.before.all.iter().find(|a| a.asked.is_of(operation) && a.layout == layout);
        let (transfer, patterns) = match alike {
            Some(alike) => (alike.transfer.clone(), alike.patterns.clone()),
            None => (c.transfer(&speeds), vec![]),
        };
        let asked = Asked::of(operation);
        self.situations.push(Situation { asked, c, transfer, physics, patterns, idle: None });
        self.situations.last_mut()
    }

    /// The numbers of a point, where floating point leaves no doubt of them.
    fn quick(&mut self, operation: &Operation, sources: bool) -> Option<Told> {
        let train = self.train;
        let is_known = self.situations.iter().any(|s| s.asked.is_of(operation));
        if !is_known && !self.before.all.iter().any(|a| a.asked.is_of(operation)) {
            return None;
        }
        let Situation { c, transfer, physics, patterns, idle, .. } = self.situation(operation)?;
        let motion = c.motion_by(transfer, &operation.speeds).ok().filter(|motion| motion.deviation.is_none())?;
        let turns = (0..motion.speeds.len()).all(|m| motion.si(MemberId(m)).is_some_and(f64::is_finite));
        if !turns || !turned_back(c, &motion).is_empty() {
            return None;
        }
        let problem = Loads::new(c, operation, &motion, &[]).ok().filter(|problem| !problem.are_none())?;
        let sigma: Vec<_> = c.elements.iter().map(|e| c.sigma(e, &motion)).collect();
        let mut agreed = patterns.iter().filter(|p| p.suits(&sigma, &problem)).filter_map(|pattern| {
            let rounds = pattern.rounds(c, &motion, operation, &problem)?;
            let point = Known { train, pattern, rounds, motion: &motion };
            let agreed = point.agreed(physics, operation.temperature, idle)?;
            Some((point.rounds, agreed))
        });
        let (rounds, agreed) = agreed.next()?;
        let flow = agreed.whole(c, &externals(c, &motion, &problem, &agreed)?);
        let open = rounds.stiction(&agreed.step, &flow);
        let takes_all = !flow.roles.contains(&-1);
        let numbers = [flow.loss, flow.input_power, flow.output_power];
        let mut all = numbers.into_iter().chain(flow.torques.iter().flatten().copied());
        if takes_all && !flow.roles.contains(&1) || !all.all(f64::is_finite) {
            return None;
        }
        let step = &agreed.step;
        let strains = physics.strains(step, &flow);
        let doubts = doubts(train, flow.input_power, &strains);
        let outside = OutsideLaw::of(&strains.extrapolations);
        let why = takes_all.then_some(Why::LossesTakeAll);
        let findings = (Some(open).filter(|open| !open.is_empty()).into_iter().map(Finding::Stiction))
            .chain(why.iter().cloned().map(Finding::Why))
            .chain(outside.iter().cloned().map(Finding::Outside))
            .chain(doubts.into_iter().map(Finding::Doubt));
        let notes = words::found(train, operation, &findings.collect::<Vec<_>>());
        let held = held(c, operation);
        let driver = |m: &MeshFlow| m.driver.map(|d| train.meshes[m.mesh.index()].gears[d].member);
        let numbers = PointNumbers {
            efficiency: efficiency(&flow),
            input_power_w: flow.input_power,
            output_power_w: flow.output_power,
            loss_w: flow.loss,
            power_residual_w: flow.residual,
            losses_w: Losses::of(physics, step, &flow),
            members: (1..train.members.len()).map(|m| member(&motion, &flow, &held, MemberId(m))).collect(),
            drivers: flow.meshes.iter().map(driver).collect(),
        };
        let sources = if sources { physics.sources(step, &flow) } else { vec![] };
        Some(Told::Numbers { numbers, sources, why, notes, outside })
    }
}

/// What acts on the terminals, where the sign of every power is certain.
fn externals(c: &Configuration<'_>, motion: &Motion, problem: &Loads, agreed: &Agreed) -> Option<Vec<External>> {
    let external = |(x, (member, prescribed)): (&Acting, &(MemberId, Option<Rational>))| {
        let sign = match prescribed {
            Some(torque) => torque.sign(),
            None if c.node(*member).is_none() => 0,
            None if !x.is_certain() => return None,
            None => x.torque.signum() as i8,
        };
        let way = motion.speeds[member.0].as_ref().map_or(0, Rational::sign);
        Some(External {
            member: *member,
            torque: x.torque,
            prescribed_power: problem.powers.iter().find(|(m, _)| m == member).map(|(_, p)| *p),
            power: sign * way,
        })
    };
    agreed.acting.iter().zip(&problem.terminals).map(external).collect()
}

/// A point of which it is known which ends drive.
struct Known<'a> {
    train: &'a Train,
    pattern: &'a Pattern,
    rounds: Rounds<'a>,
    motion: &'a Motion,
}

impl Known<'_> {
    /// Its losses and torques at a temperature, else at that of the heat balance, else at that of the oil; `None` where they
    /// are not beyond doubt the only ones.
    fn agreed(
        &self,
        physics: &mut Physics<'_>,
        temperature: Option<f64>,
        idle: &mut Option<KnownIdle>,
    ) -> Option<Agreed> {
        let oil = match (temperature, &self.train.heat) {
            (Some(oil), _) => Some(oil),
            (None, Some(heat)) => Some(self.oil(physics, heat)?),
            (None, None) => self.train.lubrication.as_ref().map(|l| l.temperature),
        };
        if let Some(oil) = oil {
            physics.warm_to(oil);
        }
        self.only(self.rounds.agree_again(physics, self.motion, idle))
    }

    fn only(&self, agreed: Option<Agreed>) -> Option<Agreed> {
        agreed.filter(|agreed| self.pattern.is_only(&self.rounds, agreed))
    }

    /// The only oil temperature of its heat balance, where nothing is to be said of it.
    fn oil(&self, physics: &mut Physics<'_>, heat: &Heat) -> Option<f64> {
        let warm = Warm { point: self, heat, physics: RefCell::new(physics), last: RefCell::default() };
        let found = balance(heat, &warm, Limits { highest: heat.limit, tolerance: TOLERANCE }).ok()?;
        let reached = found.from(heat.start).filter(|e| found.verdict == HeatVerdict::Unique && e.step.is_none())?;
        (heat.cooler.is_none() || heat.cooled(reached.at.oil) >= 0.0).then_some(reached.at.oil)
    }
}

/// The losses of a point as heat, at any temperature.
struct Warm<'a, 'p, 't> {
    point: &'a Known<'a>,
    heat: &'a Heat,
    physics: RefCell<&'p mut Physics<'t>>,
    /// The losses at the last temperature.
    last: RefCell<Option<Step>>,
}

impl Source for Warm<'_, '_, '_> {
    type Error = ();

    fn heat(&self, oil: f64) -> Result<Vec<f64>, ()> {
        let Known { train, rounds, motion, .. } = self.point;
        let mut physics = self.physics.borrow_mut();
        physics.warm_to(oil);
        let mut last = self.last.borrow_mut();
        let agreed = self.point.only(rounds.agree_closely(&physics, motion, last.as_ref())).ok_or(())?;
        *last = Some(agreed.step.clone());
        Ok(made_by(train, self.heat, &physics, &agreed))
    }
}
