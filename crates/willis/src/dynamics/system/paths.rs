//! Variators in motion: where they act, and how those whose ratio is given follow it.
//!
//! Nothing between two shafts has no give: a belt creeps, oil is compressed. So the torque of a variator whose ratio r is
//! given is that of a spring and a damper against the slip of `ω_p = r ω_q`,
//!
//! ```text
//! T = k φ + d φ',   φ' = ω_p − r ω_q
//! torque on p: −T,   torque on q: r T, less what is lost
//! ```
//!
//! With `k = J/T₀²` and `d = 2 J/T₀`, critically damped, it follows its ratio after a time T₀ that nobody can see; J is the
//! inertia that resists the slip. In a steady state the slip is none.

use nalgebra::{DMatrix, DVector};

use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::dynamics::rounding::short;
use crate::train::{
    Control, ControlKind, Curve, FRAME, Machine, MemberId, Scenario, SourceKind, Store, Train, Variator, VariatorPath,
};

use super::coordinates::Coordinates;
use super::frictions::{Friction, Rubs};
use super::ports::Ports;

/// T₀ over the duration of the scenario.
const PART: f64 = 1e-5;

/// The longest T₀, s.
const LONGEST: f64 = 1e-4;

/// A variator in motion.
#[derive(Clone)]
pub(in crate::dynamics) struct Path {
    /// Position among the variators of the train.
    pub variator: usize,
    /// Position among the controls of the scenario, if it is named there.
    pub control: Option<usize>,
    pub kind: PathKind,
}

impl Path {
    /// Whether its ratio is given and has limits.
    pub fn has_ends(&self) -> bool {
        matches!(&self.kind, PathKind::Geared(geared) if geared.limits.iter().any(|limit| limit.is_finite()))
    }

    /// Members that it acts on through ports of its own, and these.
    pub fn ports(&self) -> Vec<(MemberId, usize)> {
        match &self.kind {
            PathKind::Geared(Geared { members, ports, .. }) | PathKind::Pushed { members, ports, .. } => {
                members.iter().copied().zip(ports.iter().copied()).collect()
            }
            PathKind::Bus { machines, .. } => machines
                .iter()
                .filter_map(|m| match m.does {
                    MachineDoes::Balances(port) => Some((m.member, port)),
                    MachineDoes::Driven(_) => None,
                })
                .collect(),
        }
    }
}

/// What decides its torques.
#[derive(Clone)]
pub(in crate::dynamics) enum PathKind {
    /// The ratio of its members is given.
    Geared(Geared),
    /// The torque on its first member is given.
    Pushed { members: [MemberId; 2], ports: [usize; 2], efficiency: [f64; 2] },
    /// Machines on a bus.
    Bus { machines: Vec<BusMachine>, store: GivenStore, standby: f64 },
}

/// Two members, `ω_p = r ω_q`.
#[derive(Clone)]
pub(in crate::dynamics) struct Geared {
    /// p and q.
    pub members: [MemberId; 2],
    pub ports: [usize; 2],
    /// From p to q, and from q to p.
    pub efficiency: [f64; 2],
    /// Position of φ among the integrals.
    pub slip: usize,
    /// Position of r there, if its rate is given.
    pub ratio: Option<usize>,
    /// What r lies between.
    pub limits: [f64; 2],
    /// k, N m/rad.
    pub stiffness: f64,
    /// d, N m s/rad.
    pub damping: f64,
    /// J, kg m².
    pub inertia: f64,
    /// What rubs at q by its loss, among the friction elements.
    pub friction: Option<usize>,
}

/// A machine on a bus.
#[derive(Clone, Copy)]
pub(in crate::dynamics) struct BusMachine {
    pub member: MemberId,
    pub does: MachineDoes,
}

/// What decides the torque of a machine.
#[derive(Clone, Copy)]
pub(in crate::dynamics) enum MachineDoes {
    /// A source, by its position.
    Driven(usize),
    /// It takes what the others and the store leave on the bus, through this port.
    Balances(usize),
}

/// What is known of the power out of a store.
#[derive(Clone, Copy)]
pub(in crate::dynamics) enum GivenStore {
    /// It follows a signal of the scenario.
    Signal,
    /// This much, W.
    Power(f64),
    /// It gives what balances the bus.
    Free,
}

/// All variators of a train.
pub(super) struct Paths {
    pub all: Vec<Path>,
    /// What rubs by their losses.
    pub rubbing: Vec<Friction>,
    /// Number of integrals of controllers and variators.
    pub integrals: usize,
}

impl Paths {
    /// Gives each its ports and states. `frictions`: how many friction elements come before theirs.
    ///
    /// # Errors
    /// A variator of which the scenario does not say what it does, or more than can be.
    pub fn of(
        train: &Train,
        scenario: &Scenario,
        integrals: usize,
        frictions: usize,
        ports: &mut Ports<'_>,
    ) -> Result<Self, Diagnostics> {
        let mut all = Self { all: vec![], rubbing: vec![], integrals };
        for (variator, v) in train.variators.iter().enumerate() {
            let control = scenario.controls.iter().position(|c| c.variator == variator);
            let given = control.map(|k| &scenario.controls[k]);
            let kind = match (&v.path, given.map(|c| (c, &c.kind))) {
                (VariatorPath::Bus { .. }, _) => bus(scenario, variator, v, given.is_some(), ports)?,
                (VariatorPath::Direct { members, efficiency, .. }, Some((_, ControlKind::Torque(_)))) => {
                    PathKind::Pushed {
                        members: *members,
                        ports: members.map(|m| ports.on(m)),
                        efficiency: [efficiency.forward.to_f64(), efficiency.backward.to_f64()],
                    }
                }
                (VariatorPath::Direct { members, efficiency, ratio }, Some((control, kind))) => {
                    let (inverse, by_rate) = match kind {
                        ControlKind::Rate { inverse, .. } => (*inverse, true),
                        ControlKind::Ratio { inverse, .. } => (*inverse, false),
                        ControlKind::Torque(_) | ControlKind::Store(_) => unreachable!("the other arms"),
                    };
                    let mut geared = Geared {
                        members: *members,
                        ports: members.map(|m| ports.on(m)),
                        efficiency: [efficiency.forward.to_f64(), efficiency.backward.to_f64()],
                        limits: [ratio[0].unwrap_or(f64::NEG_INFINITY), ratio[1].unwrap_or(f64::INFINITY)],
                        slip: all.integrals,
                        ratio: by_rate.then_some(all.integrals + 1),
                        stiffness: 0.0,
                        damping: 0.0,
                        inertia: 0.0,
                        friction: None,
                    };
                    if inverse {
                        geared.turn_round(v, control)?;
                    }
                    if let ControlKind::Rate { initial, .. } = kind {
                        geared.begins_within(*initial, v, control)?;
                    }
                    all.integrals += 1 + usize::from(by_rate);
                    if geared.efficiency != [1.0; 2] {
                        geared.friction = Some(frictions + all.rubbing.len());
                        let between = ports.between([geared.members[1], FRAME]);
                        let rubs = Rubs::Variator(all.all.len());
                        all.rubbing.push(Friction::new(rubs, &v.name, Curve::constant(0.0), between));
                    }
                    PathKind::Geared(geared)
                }
                (VariatorPath::Direct { .. }, None) => return Err(idle(scenario, v)),
            };
            all.all.push(Path { variator, control, kind });
        }
        Ok(all)
    }

    /// Gives those with a ratio their springs and dampers, by the inertia over the free coordinates.
    ///
    /// # Errors
    /// A ratio of members whose speeds leave none free.
    pub fn stiffen(
        &mut self,
        train: &Train,
        scenario: &Scenario,
        coordinates: &Coordinates,
        mass: &DMatrix<f64>,
    ) -> Result<(), Diagnostics> {
        let settles = settles(scenario);
        for path in &mut self.all {
            let PathKind::Geared(geared) = &mut path.kind else { continue };
            let control = &scenario.controls[path.control.expect("it has a ratio")];
            let ratio = match &control.kind {
                ControlKind::Rate { initial, .. } => *initial,
                kind => kind.signal().value(scenario.start, scenario.start, &|_| 0.0),
            };
            // Its size is all that matters.
            let ratio = if ratio.is_finite() { ratio.clamp(geared.limits[0], geared.limits[1]) } else { 1.0 };
            let [p, q] = geared.members.map(|m| &coordinates.speeds[m.index()]);
            let row = DVector::from_fn(coordinates.free, |i, _| p[i] - ratio * q[i]);
            let chol = if coordinates.free == 0 { None } else { mass.clone().cholesky() };
            let gives = chol.map_or(0.0, |m| row.dot(&m.solve(&row)));
            let most: f64 =
                (0..coordinates.free).map(|i| (p[i] * p[i] + ratio * ratio * q[i] * q[i]) / mass[(i, i)]).sum();
            if gives.is_nan() || gives <= 1e-12 * most || most == 0.0 {
                let name = &train.variators[path.variator].name;
                let message = format!(
                    "the ratio of `{name}` is given, and gears or prescribed speeds give its members one already"
                );
                let hint = "give its `torque`, or leave a speed open";
                return Err(Diagnostic::new(Code::Unfit, control.place.clone(), message).hint(hint).into());
            }
            geared.inertia = 1.0 / gives;
            geared.stiffness = geared.inertia / (settles * settles);
            geared.damping = 2.0 * geared.inertia / settles;
        }
        Ok(())
    }

    /// What stands in for what is not given, in words.
    pub fn assumptions(&self, train: &Train, scenario: &Scenario) -> Vec<String> {
        let name = |path: &Path| train.variators[path.variator].name.clone();
        let of = |path: &Path| match &path.kind {
            PathKind::Geared(g) => Some(format!(
                "{}: it follows its ratio within {} s, as a spring of {:.2e} N m/rad and a damper of {:.2e} N m s/rad do",
                name(path),
                short(settles(scenario)),
                g.stiffness,
                g.damping
            )),
            PathKind::Bus { store: GivenStore::Free, .. } => {
                Some(format!("{}: its store gives or takes what balances the bus", name(path)))
            }
            PathKind::Bus { machines, .. } => machines
                .iter()
                .zip(train.variators[path.variator].machines())
                .find(|(m, _)| matches!(m.does, MachineDoes::Balances(_)))
                .map(|(_, m)| {
                    format!("{}: {} takes what the others and the store leave on the bus", name(path), m.name)
                }),
            PathKind::Pushed { .. } => None,
        };
        self.all.iter().filter_map(of).collect()
    }
}

/// T₀ in a scenario, s.
fn settles(scenario: &Scenario) -> f64 {
    (PART * (scenario.end - scenario.start)).min(LONGEST)
}

impl Geared {
    /// # Errors
    /// A ratio at the start outside its limits.
    fn begins_within(&self, initial: f64, v: &Variator, control: &Control) -> Result<(), Diagnostics> {
        let [least, most] = self.limits;
        if least <= initial && initial <= most {
            return Ok(());
        }
        let message =
            format!("`{}` cannot start with a ratio of {initial}: it lies between {least} and {most}", v.name);
        let place = format!("{}.initial_ratio", control.place);
        Err(Diagnostic::new(Code::OutOfRange, place, message).hint("begin at a limit, or change the limits").into())
    }

    /// The ratio is that of the second member's speed over the first's.
    fn turn_round(&mut self, v: &Variator, control: &Control) -> Result<(), Diagnostics> {
        let [least, most] = self.limits;
        self.limits = match (least, most) {
            (f64::NEG_INFINITY, f64::INFINITY) => self.limits,
            // Limits on one side of zero.
            _ if least > 0.0 || most < 0.0 => [1.0 / most, 1.0 / least],
            _ => {
                let message = format!(
                    "the limits {least} to {most} of the ratio of `{}` do not say where the inverse ratio ends",
                    v.name
                );
                let hint = "leave out `inverse`, or exchange the members of the variator";
                return Err(Diagnostic::new(Code::Unfit, control.place.clone(), message).hint(hint).into());
            }
        };
        self.members.reverse();
        self.ports.reverse();
        self.efficiency.reverse();
        Ok(())
    }
}

/// The machines of a bus in a scenario; `said`: whether it says what the store gives.
fn bus(
    scenario: &Scenario,
    variator: usize,
    v: &Variator,
    said: bool,
    ports: &mut Ports<'_>,
) -> Result<PathKind, Diagnostics> {
    let unfit = |message: String, hint: &str| -> Diagnostics {
        Diagnostic::new(Code::Unfit, scenario.place.clone(), message).hint(hint).into()
    };
    let source = |k: usize| scenario.sources.iter().position(|s| s.machine == Some([variator, k]));
    let driven: Vec<Option<usize>> = (0..v.machines().len()).map(source).collect();
    let left: Vec<&str> =
        v.machines().iter().zip(&driven).filter(|(_, d)| d.is_none()).map(|(m, _)| m.name.as_str()).collect();
    let VariatorPath::Bus { store, standby, .. } = &v.path else { unreachable!("it has a bus") };
    let store = match (store, &left[..]) {
        (_, [_]) if said => GivenStore::Signal,
        (Store::Power(power), [_]) => GivenStore::Power(power.si()),
        (Store::Free, [name]) => {
            let message = format!("the store of `{}` is free, so the torque of {name} is not determined", v.name);
            let hint = format!("give {name} a source, of 0 N m if it idles, or the variator a `store`");
            return Err(unfit(message, &hint));
        }
        (_, []) => GivenStore::Free,
        (_, all) => {
            let message = format!(
                "the torques of {} are not determined: the bus of `{}` balances one machine",
                all.join(" and "),
                v.name
            );
            let hint = format!("give all machines but one a source, as in machine = \"{}\"", all[0]);
            return Err(unfit(message, &hint));
        }
    };
    if let [name] = left[..] {
        // Their torques follow from the accelerations, on which the torque of the one that balances acts.
        let late = driven.iter().flatten().map(|&k| &scenario.sources[k]).find(|s| match &s.kind {
            SourceKind::Speed(_) => true,
            SourceKind::Controller { derivative, .. } => *derivative != 0.0,
            _ => false,
        });
        if let Some(late) = late {
            let message = format!(
                "{name} balances the bus of `{}`, and the torque of `{}` follows from accelerations, which depend on it",
                v.name, late.name
            );
            let hint = "use a torque, or a controller without a derivative part";
            return Err(Diagnostic::new(Code::Unfit, late.place.clone(), message).hint(hint).into());
        }
    }
    let machine = |(m, driven): (&Machine, Option<usize>)| BusMachine {
        member: m.member,
        does: driven.map_or_else(|| MachineDoes::Balances(ports.on(m.member)), MachineDoes::Driven),
    };
    let machines = v.machines().iter().zip(driven).map(machine).collect();
    Ok(PathKind::Bus { machines, store, standby: *standby })
}

/// A variator that nothing moves.
fn idle(scenario: &Scenario, v: &Variator) -> Diagnostics {
    let message = format!("the scenario does not say what ratio or torque the variator `{}` has", v.name);
    let hint = format!("[[scenario.variator]] name = \"{}\", ratio = 1.2", v.name);
    Diagnostic::new(Code::Unfit, scenario.place.clone(), message).hint(hint).into()
}
