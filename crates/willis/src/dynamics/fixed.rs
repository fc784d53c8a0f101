//! Steps of fixed length and bounded cost, for real time and for many runs.
//!
//! Semi-implicit stepping with set-valued friction: within a step the mode is one whose torques agree with the
//! speeds at the *end* of the step, so that what sticks has exactly zero slip and nothing chatters. With the maps of the
//! modes kept, a step is a small matrix–vector product and a check. First order in the step; the energies close to
//! round-off all the same (those of elastic shafts excepted), because `½ ω⁺ᵀMω⁺ − ½ ωᵀMω` is the work of the step's
//! torques at the mean of both speeds. Sources: Moreau's time stepping, as in Acary and Brogliato, *Numerical Methods for Nonsmooth Dynamical
//! Systems*, 2008, ch. 10.

mod audit;
mod decide;
mod decided;
mod energies;
mod foresee;
pub(super) mod groups;
mod inputs;
mod kept;
mod look;
pub(super) mod map;
mod prepare;
pub(super) mod recorded;
mod settle;
pub(super) mod shafts;
mod step;
mod trail;
mod verdict;

use std::sync::Arc;

use crate::arch::Arch;
use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::train::Train;

use super::element::{Loss, element_name};
use super::engine::{Engine, Touch};
use super::fused::{Exactly, Fused};
use super::handles::{InputHandle, InputInfo, InputRefused, OutputHandle};
use super::mode::{ByKey, Mode, Side, dot};
use super::report::{Column, Outcome};
use super::shows::Shows;
use super::source::signals_of;
use super::start::initial_state;
use super::system::System;

use decided::Decided;
use groups::{GroupStep, Rub};
use kept::Kept;
use map::{Key, StepMap};
use shafts::{MOST_SHAFTS, ShaftStep};
use trail::Trail;

/// Groups and elements that fit the key of a mode.
const MOST_GROUPS: usize = 48;
const MOST_ELEMENTS: usize = 64;

/// A scenario in steps of fixed length.
///
/// # Example
/// ```
/// use willis::dynamics::FixedStep;
/// use willis::train::Train;
///
/// let train = Train::from_toml(r#"
///     format = 1
///     name = "a rotor coasts"
///     members = ["rotor"]
///     inertias = { rotor = "2 kg m^2" }
///
///     [[drag]]
///     name = "bearing"
///     members = ["rotor"]
///     coulomb = "4 N m"
///
///     [[scenario]]
///     name = "coast"
///     duration = "10 s"
///     initial_speeds = { rotor = "12 rad/s" }
/// "#)?;
/// let mut run = FixedStep::new(&train, "coast", 1e-3)?;
/// run.run(3000);
/// assert!((run.speed("rotor").unwrap() - 6.0).abs() < 1e-9);
/// run.run(7000);
/// assert_eq!(run.speed("rotor"), Some(0.0));
/// # Ok::<(), willis::Diagnostics>(())
/// ```
///
/// # In a co-simulation or a control loop
/// Inputs and outputs are found once by name; to set and to read them allocates nothing. A clone is the whole state:
/// keep one to come back to it, and the same steps from there give the same numbers to the last bit.
///
/// ```
/// use willis::dynamics::{FixedStep, ModeLabel};
/// use willis::train::Train;
///
/// let train = Train::from_toml(r#"
///     format = 1
///     name = "a motor on a rotor"
///     members = ["rotor"]
///     terminals = ["rotor"]
///     inertias = { rotor = "2 kg m^2" }
///
///     [[drag]]
///     name = "bearing"
///     members = ["rotor"]
///     coulomb = "4 N m"
///
///     [[scenario]]
///     name = "drive"
///     duration = "10 s"
///
///     [[scenario.source]]
///     name = "motor"
///     member = "rotor"
///     torque = "0 N m"
/// "#)?;
/// let mut run = FixedStep::new(&train, "drive", 1e-3)?;
/// let motor = run.input("motor")?;
/// let (speed, bearing) = (run.output("rotor.speed")?, run.output("bearing.mode")?);
/// let wrong = run.output("roter.speed").unwrap_err();
/// assert!(wrong.to_string().contains("did you mean `rotor.speed`?"));
///
/// run.prepare_modes();
/// let saved = run.clone();
/// run.set(motor, 3.0).unwrap();
/// run.run(1000);
/// assert_eq!(run.read(speed), 0.0);
/// assert_eq!(ModeLabel::of_value(run.read(bearing)), Some(ModeLabel::Stuck));
/// // The host rejects that second and takes another one.
/// run = saved;
/// run.set(motor, 6.0).unwrap();
/// run.run(1000);
/// assert!((run.read(speed) - 1.0).abs() < 1e-9);
/// # Ok::<(), willis::Diagnostics>(())
/// ```
#[derive(Clone)]
pub struct FixedStep {
    pub(super) engine: Engine,
    pub(super) h: f64,
    start: f64,
    pub(super) count: u64,
    /// Speeds of all coordinates.
    pub(super) v: Vec<f64>,
    /// Angles and integrals, as in the state of the engine.
    pub(super) rest: Vec<f64>,
    tau: Vec<f64>,
    slip: Vec<f64>,
    next: Vec<f64>,
    groups: Vec<GroupStep>,
    pub(super) sign: Vec<i8>,
    pub(super) side: Vec<Side>,
    /// Torques with which a group can oppose slip, forward and backward, at this step.
    capacity: Vec<[f64; 2]>,
    /// Group, factor and losses of each element that has any.
    teeth: Vec<(usize, f64, Loss)>,
    /// Whether any group shares.
    shares: bool,
    pub(super) shafts: Vec<ShaftStep>,
    /// Torques of the shafts against their relative accelerations.
    resists: Vec<f64>,
    /// What was learned about modes is shared with clones: it never changes.
    maps: Vec<Arc<StepMap>>,
    by_key: ByKey<Key>,
    /// The map of the last step and its key.
    last: Option<(Key, u32)>,
    /// Decisions of contacts.
    decided: Vec<Decided>,
    /// Values of signals that are level, until when each is, and all are.
    level: Vec<Option<f64>>,
    level_ends: Vec<f64>,
    pub(super) until: f64,
    /// The first signal of each source.
    signal_of: Vec<usize>,
    /// The signal that governs how far each friction element is engaged.
    governors: Vec<Option<usize>>,
    /// Torque of each friction element, if it does not depend on slip.
    flat: Vec<Option<f64>>,
    /// What enters a step, which of that is not level, and by what it is multiplied.
    pub(super) inputs: Vec<f64>,
    pub(super) varying: Vec<usize>,
    pub(super) factors: Vec<f64>,
    /// Steps of modes met before, and the present one with its part of level inputs and its round-off.
    pub(super) fused: Vec<Arc<Fused>>,
    by_exact_key: ByKey<Exactly>,
    pub(super) present: Option<u32>,
    /// By mode before a step that was searched for, the fused step of the mode found; whether those may be used.
    followed: ByKey<Exactly>,
    /// The mode found where it has no fused step, likewise; room for one that is tried.
    supposed: ByKey<Exactly, Exactly>,
    kept: Kept,
    is_certain: bool,
    pub(super) base: Vec<f64>,
    pub(super) least: Vec<f64>,
    pub(super) ends: Vec<f64>,
    keeps_angles: bool,
    arch: Arch,
    /// Speeds, angles with integrals, signs and contacts at the start.
    at_start: (Vec<f64>, Vec<f64>, Vec<i8>, Vec<Touch>),
    /// Energies as the engine counts them; empty unless asked for.
    pub(super) energies: Vec<f64>,
    pub(super) came_in: Vec<f64>,
    /// Steps whose energies are not among them yet; room for torques and mean speeds of a step.
    trail: Trail,
    room: [Vec<f64>; 2],
    /// Steps that did not go on in the mode of the one before.
    pub(super) settled: u64,
    /// Losses of the elements and torques behind prescribed speeds, when decided.
    losses: Vec<f64>,
    reactions: Vec<f64>,
    /// Whether the last step was decided: the port torques are then complete.
    is_decided: bool,
    pub(super) impacts: u64,
    /// State and mode as the engine knows them, and the step after which they were taken over.
    seen: Vec<f64>,
    seen_mode: Mode,
    seen_at: Option<u64>,
    /// Whether an output that takes forces was asked for.
    shows_forces: bool,
    /// Why the run cannot go on.
    pub(super) verdict: Option<Outcome>,
    /// Twice the largest speeds met, as a square, and how often in a row they turned round while they passed that.
    pub(super) bound: f64,
    pub(super) turns: u32,
}

impl FixedStep {
    /// Prepares a scenario with steps of `h`, s.
    ///
    /// # Errors
    /// As [`Simulation::new`](super::Simulation::new); a step that is not longer than zero; trains with more than 48
    /// friction groups or 64 mesh elements, with variators, with losses that follow laws, or with efficiencies that depend
    /// on speed.
    pub fn new(train: &Train, scenario: &str, h: f64) -> Result<Self, Diagnostics> {
        let fail =
            |message: String, hint: &str| Diagnostics::from(Diagnostic::new(Code::Unfit, "", message).hint(hint));
        if !(h > 0.0 && h.is_finite()) {
            return Err(fail(format!("a step of {h} s"), "a step is longer than zero"));
        }
        let system = System::new(train, scenario, h, false)?;
        if system.groups.len() > MOST_GROUPS || system.elements.len() > MOST_ELEMENTS {
            let message = format!(
                "{} friction groups and {} mesh elements: steps of fixed length take at most {MOST_GROUPS} and {MOST_ELEMENTS}",
                system.groups.len(),
                system.elements.len()
            );
            return Err(fail(message, "use the adaptive method"));
        }
        if system.elastic.len() > MOST_SHAFTS {
            let message =
                format!("{} elastic shafts: steps of fixed length take at most {MOST_SHAFTS}", system.elastic.len());
            return Err(fail(message, "use the adaptive method"));
        }
        if let Some(path) = system.paths.first() {
            let message = format!("`{}` is a variator", train.variators()[path.variator].name);
            return Err(fail(message, "steps of fixed length do not take one yet; use the adaptive method"));
        }
        if system.laws.is_some() {
            let message = "the losses of this train follow laws of speed and load".to_owned();
            return Err(fail(message, "steps of fixed length take constant efficiencies; use the adaptive method"));
        }
        if let Some(j) = system.elements.iter().position(|e| e.varies()) {
            let name = element_name(train, &system.elements[j].links);
            let message = format!("the efficiency of {name} depends on its speed");
            return Err(fail(message, "steps of fixed length take constant efficiencies; use the adaptive method"));
        }
        let mut engine = Engine::new(system);
        let x = initial_state(&mut engine)?;
        engine.counts = false;
        let s = &engine.system;
        let groups: Vec<GroupStep> = (s.groups.iter())
            .map(|g| GroupStep {
                row: g.row.clone(),
                rubs: (g.frictions.iter())
                    .map(|&f| {
                        let friction = &s.frictions[f];
                        Rub {
                            friction: f,
                            port: friction.port,
                            factor: friction.group.expect("of this group").1,
                            is_rigid: friction.rigid || friction.blocks.is_some(),
                            peak: friction.peak,
                            viscous: 0.0,
                            opposes: [0.0; 2],
                        }
                    })
                    .collect(),
                elements: g.elements.clone(),
                lead: g.lead,
                driven: g.driven,
                shares: !g.elements.is_empty() && g.elements.len() + g.frictions.len() > 1,
                constants: (g.elements.iter())
                    .map(|&j| (j, s.elements[j].port, s.elements[j].loss(0.0)))
                    .filter(|(.., loss)| loss.drive_torque != 0.0 || loss.coast_torque != 0.0)
                    .map(|(j, port, loss)| (j, port, [loss.drive_torque, loss.coast_torque]))
                    .collect(),
            })
            .collect();
        let (g, e, p) = (s.groups.len(), s.elements.len(), s.ports);
        let v = engine.speed.clone();
        let sign: Vec<i8> = groups.iter().map(|group| if dot(&group.row, &v) < 0.0 { -1 } else { 1 }).collect();
        let rest = x[s.free..s.free + s.all() + s.integrals].to_vec();
        let shafts = ShaftStep::all(s, h);
        let signals = s.signals().count();
        let signal_of = (s.scenario.sources.iter())
            .scan(0, |at, source| {
                let first = *at;
                *at += signals_of(&source.kind).count();
                Some(first)
            })
            .collect();
        let flat = (s.frictions.iter())
            .map(|f| {
                let points = f.torque.points();
                points.iter().all(|p| p[1] == points[0][1]).then_some(points[0][1])
            })
            .collect();
        let inputs = s.drivers.len() + s.frictions.len() + s.elastic.len() + 1;
        let governors = s.frictions.iter().map(|f| s.governor(f).map(|(at, _)| at)).collect();
        Ok(Self {
            h,
            start: s.scenario.start,
            count: 0,
            at_start: (v.clone(), rest.clone(), sign.clone(), shafts.iter().map(|shaft| shaft.touch).collect()),
            rest,
            tau: vec![0.0; p + g],
            slip: vec![0.0; g],
            next: v.clone(),
            v,
            sign,
            side: vec![Side::Drive; e],
            capacity: vec![[0.0; 2]; g],
            teeth: (s.elements.iter())
                .map(|e| {
                    let (g, factor) = e.group.unwrap_or((0, 1.0));
                    (g, factor, e.loss(0.0))
                })
                .collect(),
            shares: groups.iter().any(|g| g.shares),
            resists: vec![0.0; s.elastic.len()],
            shafts,
            groups,
            maps: Vec::with_capacity(64),
            by_key: ByKey::with_capacity_and_hasher(64, Default::default()),
            last: None,
            decided: vec![],
            level: vec![None; signals],
            level_ends: vec![f64::NEG_INFINITY; signals],
            until: f64::NEG_INFINITY,
            governors,
            signal_of,
            flat,
            inputs: vec![0.0; inputs],
            varying: Vec::with_capacity(inputs),
            factors: vec![1.0; inputs],
            fused: Vec::with_capacity(64),
            by_exact_key: ByKey::with_capacity_and_hasher(64, Default::default()),
            present: None,
            followed: ByKey::with_capacity_and_hasher(256, Default::default()),
            kept: Kept::default(),
            supposed: ByKey::with_capacity_and_hasher(256, Default::default()),
            is_certain: Self::has_one_motion(&engine),
            base: vec![],
            least: vec![],
            ends: vec![],
            keeps_angles: true,
            arch: Arch::new(),
            energies: vec![],
            came_in: vec![],
            trail: Trail::default(),
            room: Default::default(),
            settled: 0,
            losses: vec![0.0; e],
            reactions: vec![0.0; s.prescribed],
            is_decided: false,
            impacts: 0,
            seen: vec![],
            seen_mode: engine.mode.clone(),
            seen_at: None,
            shows_forces: false,
            verdict: None,
            bound: 0.0,
            turns: 0,
            engine,
        })
    }

    /// Time reached, s.
    pub fn time(&self) -> f64 {
        self.start + self.count as f64 * self.h
    }

    /// Speed of a member, rad/s.
    pub fn speed(&self, member: &str) -> Option<f64> {
        let s = &self.engine.system;
        Some(dot(&s.speeds[s.train.member(member)?.index()], &self.v))
    }

    /// Why the run cannot go on: from then on it stays at the last state that can be believed, and steps do nothing.
    pub fn verdict(&self) -> Option<&Outcome> {
        self.verdict.as_ref()
    }

    /// Steps in which parts of different speed were joined at once, as in an inelastic impact.
    pub fn impacts(&self) -> u64 {
        self.impacts
    }

    /// Leaves out the angles, where nothing depends on them.
    pub fn without_angles(&mut self) {
        self.keeps_angles = !self.engine.system.elastic.is_empty();
    }

    /// The inputs that can be set.
    pub fn inputs(&self) -> Vec<InputInfo> {
        self.engine.system.inputs()
    }

    /// The input of that name: that of a source, or `engagement.` and the name of a shift element that the scenario
    /// engages.
    ///
    /// # Errors
    /// If there is none, with the nearest name; if it is a load that follows the speed.
    pub fn input(&self, name: &str) -> Result<InputHandle, Diagnostics> {
        self.engine.system.input(name)
    }

    /// Sets an input: from now on it has this value. A prescribed speed that jumps counts as an impact.
    ///
    /// # Errors
    /// If the value is not finite.
    pub fn set(&mut self, input: InputHandle, value: f64) -> Result<(), InputRefused> {
        self.engine.system.set(input, value)?;
        let s = &self.engine.system;
        let prescribed = s.prescribed_by(input);
        self.impacts += u64::from(prescribed.is_some_and(|i| jumps(self.v[s.free + i], value)));
        (self.until, self.seen_at) = (f64::NEG_INFINITY, None);
        Ok(())
    }

    /// The outputs that can be read: the columns of a recorded run.
    pub fn outputs(&self) -> Vec<Column> {
        self.engine.columns()
    }

    /// The output of that name, with its unit or without: `sun.speed_rad_s` or `sun.speed`, `sun.angle`,
    /// `sun.acceleration`, `motor.torque`, `B.mode`, `stored_energy`.
    ///
    /// # Errors
    /// If there is none, with the nearest name.
    pub fn output(&mut self, name: &str) -> Result<OutputHandle, Diagnostics> {
        let output = OutputHandle::of(&self.engine.columns(), name)?;
        self.shows_forces |= !output.shows(&self.engine.shows).is_motion();
        Ok(output)
    }

    /// The value of an output at the time reached, in the unit of its column; NaN where it is not determined. Modes
    /// are those of the last step, read by [`ModeLabel::of_value`](super::ModeLabel::of_value); forces are those that
    /// act in them at the present speeds.
    ///
    /// Speeds and angles cost a sum. The first of the others after a step solves for the forces once.
    pub fn read(&mut self, output: OutputHandle) -> f64 {
        let shows = output.shows(&self.engine.shows);
        let s = &self.engine.system;
        match shows {
            Shows::Time => self.time(),
            Shows::Speed(m) => dot(&s.speeds[m], &self.v),
            Shows::Angle(m) => dot(&s.speeds[m], &self.rest[..s.all()]),
            _ => {
                self.look_at_forces();
                match shows {
                    Shows::Stored => self.engine.stored_now(&self.seen),
                    _ => self.engine.value(shows, self.time(), &self.seen),
                }
            }
        }
    }

    /// Begins to count where the energy goes: `lost_energy_j` can be read. Steps take up to half as long again.
    pub fn with_energies(&mut self) {
        self.engine.counts = true;
        self.energies = vec![0.0; self.engine.energies()];
        self.came_in = vec![0.0; self.engine.system.drivers.len()];
        self.trail = Trail::new(&self.engine.system);
        self.room = [self.engine.system.ports, self.v.len()].map(Vec::with_capacity);
        (self.present, self.seen_at) = (None, None);
    }

    /// Goes back to the start. What was learned about modes stays, and so do inputs that were replaced.
    pub fn reset(&mut self) {
        let (v, rest, sign, _) = &self.at_start;
        self.v.copy_from_slice(v);
        self.rest.copy_from_slice(rest);
        self.sign.copy_from_slice(sign);
        self.side.fill(Side::Drive);
        self.energies.fill(0.0);
        self.came_in.fill(0.0);
        self.trail.clear();
        self.shafts.iter_mut().zip(&self.at_start.3).for_each(|(shaft, touch)| shaft.touch = *touch);
        (self.count, self.impacts) = (0, 0);
        (self.verdict, self.bound, self.turns) = (None, 0.0, 0);
        (self.present, self.last, self.until) = (None, None, f64::NEG_INFINITY);
        self.seen_at = None;
    }

    /// Runs the whole scenario once and goes back to its start.
    ///
    /// A step that meets a mode for the first time prepares it, which takes many times as long as a step and
    /// memory. After a rehearsal the same run meets no new mode: its steps allocate nothing and take bounded time.
    /// The modes next to those met are prepared as well, up to 16 MB of them, so that few are new under other inputs.
    pub fn prepare_modes(&mut self) {
        self.reset();
        for _ in 0..self.steps() {
            self.step();
            if self.shows_forces {
                self.look_at_forces();
            }
        }
        self.prepare_neighbours();
        self.reset();
    }

    /// Steps of the whole scenario.
    fn steps(&self) -> u64 {
        ((self.engine.system.scenario.end - self.start) / self.h - 1e-9).ceil() as u64
    }
}

/// Whether a prescribed speed that goes from one value to another at once jumps.
fn jumps(from: f64, to: f64) -> bool {
    (to - from).abs() > 1e-6 * (to.abs() + from.abs())
}
