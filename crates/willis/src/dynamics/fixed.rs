//! Steps of fixed length and bounded cost, for real time and for many runs.
//!
//! Semi-implicit stepping with set-valued friction: within a step the mode is one whose torques agree with the
//! speeds at the *end* of the step, so that what sticks has exactly zero slip and nothing chatters. With the maps of the
//! modes kept, a step is a small matrix–vector product and a check. First order in the step; the energies close to
//! round-off all the same (those of elastic shafts excepted), because `½ ω⁺ᵀMω⁺ − ½ ωᵀMω` is the work of the step's torques at the mean of both
//! speeds. Sources: Moreau's time stepping, as in Acary and Brogliato, *Numerical Methods for Nonsmooth Dynamical
//! Systems*, 2008, ch. 10.

use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::train::{MemberId, Signal, SourceKind, Train};

use super::engine::{Engine, Touch};
use super::fused::{ByKey, Exactly, Fused, NOISE, add_column};
use super::mode::{Mode, Pattern, Side, compose, dot, dot_size};
use super::run::initial_state;
use super::system::{System, signals_of, slope_force};

/// Groups and elements that fit the key of a mode.
const MOST_GROUPS: usize = 48;
const MOST_ELEMENTS: usize = 64;

/// Stands for a torque without bound: of a rigid lock, of a one-way clutch.
pub(super) const UNBOUNDED: f64 = 1e30;
/// What counts as such when multiplied by a ratio of gears.
const LEAST_UNBOUNDED: f64 = 1e24;

/// The map of a mode, flat: rows over ports and slips.
pub(super) struct StepMap {
    /// Accelerations of the free coordinates, then holding torques of `held`, then torques of `moving`.
    pub rows: Vec<f64>,
    pub held: Vec<u16>,
    pub moving: Vec<u16>,
    /// Torques at the first gears of the elements of held groups, in the order of `held`.
    pub still: Vec<(u16, Vec<f64>)>,
    /// Whether some of what is held is held several times over.
    redundant: bool,
    /// Torques behind prescribed speeds.
    reactions: Vec<f64>,
}

/// A friction element of a group, ready for the step.
pub(super) struct Rub {
    pub friction: usize,
    pub port: usize,
    pub factor: f64,
    /// Holds any torque, or none.
    pub is_rigid: bool,
    peak: f64,
    /// At this step: its viscous torque, and the torques with which it opposes slip of its group forward and
    /// backward.
    viscous: f64,
    opposes: [f64; 2],
}

/// What a group needs in a step.
pub(super) struct GroupStep {
    pub row: Vec<f64>,
    pub rubs: Vec<Rub>,
    pub elements: Vec<usize>,
    pub lead: (usize, f64),
    pub driven: bool,
    /// Whether several parts, teeth among them, share in holding it.
    shares: bool,
    /// Elements with losses that do not depend on load: port, torques when driving and coasting.
    pub constants: Vec<(usize, usize, [f64; 2])>,
}

/// Key of a map: which groups are held, and the sides of what moves.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) struct Key {
    held: u64,
    coast: u64,
}

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
    teeth: Vec<(usize, f64, super::system::Loss)>,
    /// Whether any group shares.
    shares: bool,
    /// The state at the start of the step, where shafts need it.
    state: Vec<f64>,
    maps: Vec<StepMap>,
    by_key: ByKey<Key>,
    /// The map of the last step and its key.
    last: Option<(Key, u32)>,
    /// Values of signals that are level until `until`.
    level: Vec<Option<f64>>,
    pub(super) until: f64,
    engagement_signals: Vec<usize>,
    /// The first signal of each source.
    signal_of: Vec<usize>,
    /// Torque of each friction element, if it does not depend on slip.
    flat: Vec<Option<f64>>,
    /// What enters a step, which of that is not level, and by what it is multiplied.
    pub(super) inputs: Vec<f64>,
    pub(super) varying: Vec<usize>,
    pub(super) factors: Vec<f64>,
    /// Steps of modes met before, and the present one with its part of level inputs and its round-off.
    pub(super) fused: Vec<Fused>,
    by_exact_key: ByKey<Exactly>,
    pub(super) present: Option<u32>,
    pub(super) base: Vec<f64>,
    pub(super) least: Vec<f64>,
    pub(super) ends: Vec<f64>,
    keeps_angles: bool,
    arch: pulp::Arch,
    /// Speeds, angles with integrals, and signs at the start.
    at_start: (Vec<f64>, Vec<f64>, Vec<i8>),
    /// Energies as the engine counts them; empty unless asked for.
    pub(super) energies: Vec<f64>,
    pub(super) came_in: Vec<f64>,
    /// Losses of the elements and torques behind prescribed speeds, when balanced by sweeps.
    losses: Vec<f64>,
    reactions: Vec<f64>,
    /// Whether the last step was balanced by sweeps: the port torques are then complete.
    swept: bool,
    pub(super) unsettled: u64,
    pub(super) impacts: u64,
}

impl FixedStep {
    /// Prepares a scenario with steps of `h`, s.
    ///
    /// # Errors
    /// As [`Simulation::new`](super::Simulation::new); and trains with more than 48 friction groups or 64 mesh
    /// elements.
    pub fn new(train: &Train, scenario: &str, h: f64) -> Result<Self, Diagnostics> {
        let fail = |message: String, hint: &str| -> Diagnostics {
            [Diagnostic::new(Code::Unfit, "", message).hint(hint)].into_iter().collect()
        };
        if !(h > 0.0 && h.is_finite()) {
            return Err(fail(format!("a step of {h} s"), "a step is longer than zero"));
        }
        let system = System::new(train, scenario)?;
        if system.groups.len() > MOST_GROUPS || system.elements.len() > MOST_ELEMENTS {
            let message = format!(
                "{} friction groups and {} mesh elements: steps of fixed length take at most {MOST_GROUPS} and {MOST_ELEMENTS}",
                system.groups.len(),
                system.elements.len()
            );
            return Err(fail(message, "use the adaptive method"));
        }
        if system.laws.is_some() {
            let message = "the losses of this train follow laws of speed and load".to_owned();
            return Err(fail(message, "steps of fixed length take constant efficiencies; use the adaptive method"));
        }
        if let Some(j) = system.elements.iter().position(|e| e.varies()) {
            let name = super::system::element_name(train, &system.elements[j].links);
            let message = format!("the efficiency of {name} depends on its speed");
            return Err(fail(message, "steps of fixed length take constant efficiencies; use the adaptive method"));
        }
        let mut engine = Engine::new(system);
        let x = initial_state(&mut engine)?;
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
        let engagement_signals =
            (0..s.scenario.engagements.len()).map(|k| signals - s.scenario.engagements.len() + k).collect();
        Ok(Self {
            h,
            start: s.scenario.start,
            count: 0,
            at_start: (v.clone(), rest.clone(), sign.clone()),
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
            state: vec![],
            groups,
            maps: Vec::with_capacity(64),
            by_key: ByKey::with_capacity_and_hasher(64, Default::default()),
            last: None,
            level: vec![None; signals],
            until: f64::NEG_INFINITY,
            engagement_signals,
            signal_of,
            flat,
            inputs: vec![0.0; inputs],
            varying: Vec::with_capacity(inputs),
            factors: vec![1.0; inputs],
            fused: Vec::with_capacity(64),
            by_exact_key: ByKey::with_capacity_and_hasher(64, Default::default()),
            present: None,
            base: vec![],
            least: vec![],
            ends: vec![],
            keeps_angles: true,
            arch: pulp::Arch::new(),
            energies: vec![],
            came_in: vec![],
            losses: vec![0.0; e],
            reactions: vec![0.0; s.prescribed],
            swept: false,
            unsettled: 0,
            impacts: 0,
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

    /// Steps whose mode was not settled within the bounded number of trials.
    pub fn unsettled_steps(&self) -> u64 {
        self.unsettled
    }

    /// Steps in which parts of different speed were joined at once, as in an inelastic impact.
    pub fn impacts(&self) -> u64 {
        self.impacts
    }

    /// Leaves out the angles, where nothing depends on them.
    pub fn without_angles(&mut self) {
        self.keeps_angles = !self.engine.system.elastic.is_empty();
    }

    /// Replaces what a source does from now on by a constant: torque, N m; set speed, rad/s; throttle or grade.
    ///
    /// # Errors
    /// If there is no such source, or it is a load that follows the speed.
    pub fn set_input(&mut self, source: &str, value: f64) -> Result<(), String> {
        self.until = f64::NEG_INFINITY;
        self.engine.system.set_input(source, value)
    }

    /// Goes back to the start; what was learned about modes stays.
    pub fn reset(&mut self) {
        let (v, rest, sign) = &self.at_start;
        self.v.copy_from_slice(v);
        self.rest.copy_from_slice(rest);
        self.sign.copy_from_slice(sign);
        self.side.fill(Side::Drive);
        self.energies.fill(0.0);
        self.came_in.fill(0.0);
        (self.count, self.unsettled, self.impacts) = (0, 0, 0);
        (self.present, self.last, self.until) = (None, None, f64::NEG_INFINITY);
    }

    /// Runs the whole scenario once and goes back to its start.
    ///
    /// A step that meets a mode for the first time prepares it, which takes many times as long as a step and
    /// memory. After a rehearsal the same run meets no new mode: its steps allocate nothing and take bounded time.
    pub fn rehearse(&mut self) {
        let end = self.engine.system.scenario.end;
        self.run((((end - self.start) / self.h - 1e-9).ceil() as u64).saturating_sub(self.count));
        self.reset();
    }

    /// Takes steps.
    pub fn run(&mut self, steps: u64) {
        for _ in 0..steps {
            self.step();
        }
    }

    /// The map of a mode, made if it was not met before: the only place that takes more than bounded time.
    #[inline]
    fn map(&mut self, key: Key) -> Option<u32> {
        if let Some((k, map)) = self.last
            && k == key
        {
            return Some(map);
        }
        let found = match self.by_key.get(&key) {
            Some(&k) => (k != u32::MAX).then_some(k),
            None => self.make(key),
        };
        if let Some(map) = found {
            self.last = Some((key, map));
        }
        found
    }

    fn make(&mut self, key: Key) -> Option<u32> {
        let s = &self.engine.system;
        let mode = Mode {
            slip: (0..self.groups.len()).map(|g| i8::from(key.held >> g & 1 == 0)).collect(),
            side: (0..s.elements.len())
                .map(|j| if key.coast >> j & 1 == 1 { Side::Coast } else { Side::Drive })
                .collect(),
        };
        let made = self.engine.maps.pattern(s, &mode).and_then(|pattern| step_map(s, &mode, pattern));
        let k = match made {
            Some(map) => {
                self.maps.push(map);
                self.maps.len() as u32 - 1
            }
            None => u32::MAX,
        };
        self.by_key.insert(key, k);
        (k != u32::MAX).then_some(k)
    }

    /// Which groups are held and which sides drive: the key of the present mode.
    #[inline]
    pub(super) fn key(&self) -> Key {
        let mut key = Key { held: 0, coast: 0 };
        for (g, group) in self.groups.iter().enumerate() {
            if self.sign[g] == 0 && !group.driven {
                key.held |= 1 << g;
            } else {
                for &j in &group.elements {
                    key.coast |= u64::from(self.side[j] == Side::Coast) << j;
                }
            }
        }
        key
    }

    /// Sets what the signals that are level for a while are worth, and which inputs are not.
    #[cold]
    pub(super) fn refresh(&mut self, t: f64) {
        let s = &self.engine.system;
        self.until = s.signals().map(|s| s.next_break(t)).fold(f64::INFINITY, f64::min);
        for (level, signal) in self.level.iter_mut().zip(s.signals()) {
            let moves = signal.moves(t);
            *level = (!moves).then(|| signal.value(t, t, &|_| 0.0));
        }
        self.varying.clear();
        let drivers = s.drivers.len();
        for (k, source) in s.scenario.sources.iter().enumerate() {
            let of_torque = matches!(source.kind, SourceKind::Torque(_) | SourceKind::Speed(_));
            if !of_torque || self.level[self.signal_of[k]].is_none() {
                self.varying.push(k);
            }
        }
        for (f, friction) in s.frictions.iter().enumerate() {
            let level = match friction.engagement {
                Some(k) => self.level[self.engagement_signals[k]].is_some(),
                None => true,
            };
            let of_slip = self.flat[f].is_none() && !friction.rigid && friction.blocks.is_none();
            if friction.group.is_some() && (!level || of_slip) {
                self.varying.push(drivers + f);
            }
        }
        self.varying.extend((0..s.elastic.len()).map(|k| drivers + s.frictions.len() + k));
    }

    /// What enters a step: torque or end speed of each source, torque with which each friction element can
    /// oppose slip, torque of each shaft, one.
    #[inline]
    pub(super) fn input(&self, k: usize, middle: f64) -> f64 {
        let w = dot(self.row_of_input(k), &self.v);
        let sum = self.integral_of(k).map_or(0.0, |i| self.rest[i]);
        self.factors[k] * self.input_at(k, middle, w, sum)
    }

    /// The speed or slip that an input may follow, over the coordinates.
    #[inline]
    pub(super) fn row_of_input(&self, k: usize) -> &[f64] {
        let s = &self.engine.system;
        match k.checked_sub(s.drivers.len()) {
            None => &s.speeds[s.drivers[k].member.index()],
            Some(f) => s.frictions.get(f).map_or(&[], |f| &f.row),
        }
    }

    /// Position of the integral of a controller.
    #[inline]
    pub(super) fn integral_of(&self, k: usize) -> Option<usize> {
        let s = &self.engine.system;
        Some(s.all() + s.drivers.get(k)?.integral?)
    }

    /// Whether formulas of speeds, or twists of shafts, enter an input.
    pub(super) fn needs_all_speeds(&self, k: usize) -> bool {
        let s = &self.engine.system;
        let engagement = |f: usize| s.frictions.get(f).and_then(|f| f.engagement);
        match k.checked_sub(s.drivers.len()) {
            None => signals_of(&s.scenario.sources[k].kind).any(|s| s.depends_on_speed()),
            Some(f) => match engagement(f) {
                Some(e) => s.scenario.engagements[e].signal.depends_on_speed(),
                None => f >= s.frictions.len(),
            },
        }
    }

    /// An input, but for its factor, at the speed or slip that it follows.
    #[inline]
    pub(super) fn input_at(&self, k: usize, middle: f64, w: f64, sum: f64) -> f64 {
        let s = &self.engine.system;
        let speed = |m: MemberId| dot(&s.speeds[m.index()], &self.v);
        let drivers = s.drivers.len();
        if k < drivers {
            let first = self.signal_of[k];
            let take = |at: usize, signal: &Signal| {
                self.level[first + at].unwrap_or_else(|| signal.value(middle, middle, &speed))
            };
            return match &s.scenario.sources[k].kind {
                SourceKind::Torque(signal) => take(0, signal),
                SourceKind::Speed(signal) => {
                    self.level[first].unwrap_or_else(|| signal.value(middle + 0.5 * self.h, middle, &|_| 0.0))
                }
                SourceKind::Controller { setpoint, feed_forward, proportional, integral, derivative } => {
                    let rate =
                        if *derivative == 0.0 { 0.0 } else { setpoint.rate(middle, middle, &speed) * derivative };
                    take(1, feed_forward) + proportional * (take(0, setpoint) - w) + integral * sum + rate
                }
                SourceKind::Linear { torque, about, slope } => torque - slope * (w - about),
                SourceKind::Quadratic { torque, about, factor, even } => {
                    let d = w - about;
                    torque - factor * if *even { d * d } else { d * d.abs() }
                }
                SourceKind::Vehicle { mass, wheel_radius, final_drive, drag_area, air_density, grade, .. } => {
                    let arm = wheel_radius / final_drive;
                    let v = w * arm;
                    -(0.5 * air_density * drag_area * v * v.abs() + slope_force(*mass, take(0, grade))) * arm
                }
                SourceKind::Motor { full_load, closed, throttle } => {
                    let (low, high) = (closed.at(w), full_load.at(w));
                    low + take(0, throttle).clamp(0.0, 1.0) * (high - low)
                }
            };
        }
        let f = k - drivers;
        if f < s.frictions.len() {
            let friction = &s.frictions[f];
            let engaged = match friction.engagement {
                None => 1.0,
                Some(k) => self.level[self.engagement_signals[k]]
                    .unwrap_or_else(|| s.scenario.engagements[k].signal.value(middle, middle, &speed)),
            };
            return match self.flat[f] {
                _ if friction.group.is_none() || friction.blocks.is_some() => 0.0,
                _ if friction.rigid => {
                    if engaged >= 0.5 {
                        UNBOUNDED
                    } else {
                        0.0
                    }
                }
                Some(torque) => torque * engaged.clamp(0.0, 1.0),
                None => friction.torque.at(w.abs()) * engaged.clamp(0.0, 1.0),
            };
        }
        let e = f - s.frictions.len();
        if e < s.elastic.len() { self.engine.shaft_torque(e, &self.state) } else { 1.0 }
    }

    /// The state as the engine's shafts know it.
    fn look_at_shafts(&mut self) {
        self.engine.speed.copy_from_slice(&self.v);
        self.state.clear();
        self.state.extend_from_slice(&self.v[..self.engine.system.free]);
        self.state.extend_from_slice(&self.rest);
        for k in 0..self.engine.system.elastic.len() {
            self.engine.touch[k] = self.engine.touch_now(k, &self.state);
        }
    }

    /// Torques of the ports in the middle of the step, friction and losses excluded, slips and capacities.
    fn load(&mut self, middle: f64) {
        if !self.engine.system.elastic.is_empty() {
            self.look_at_shafts();
        }
        for k in 0..self.inputs.len() {
            self.inputs[k] = self.input(k, middle);
        }
        let s = &self.engine.system;
        let p = s.ports;
        let v = &self.v;
        self.tau.iter_mut().for_each(|x| *x = 0.0);
        for (driver, &u) in s.drivers.iter().zip(&self.inputs) {
            match (driver.prescribed, driver.port) {
                (Some(i), _) => {
                    self.next[s.free + i] = u;
                    self.tau[s.port_of_prescribed + i] = (u - v[s.free + i]) / self.h;
                }
                (None, port) => self.tau[port.expect("a torque")] = u,
            }
        }
        for f in s.frictions.iter().filter(|f| f.viscous != 0.0) {
            self.tau[f.port] -= f.viscous * dot(&f.row, v);
        }
        let of_frictions = s.drivers.len();
        for (k, e) in s.elastic.iter().enumerate() {
            self.tau[e.port] = self.inputs[of_frictions + s.frictions.len() + k];
        }
        let (h, next) = (self.h, &self.next);
        for (g, group) in self.groups.iter_mut().enumerate() {
            // With the prescribed speeds of the end of the step.
            let slip = dot(&group.row[..s.free], &v[..s.free]) + dot(&group.row[s.free..], &next[s.free..]);
            self.slip[g] = slip;
            self.tau[p + g] = slip / h;
            let (mut slides, mut holds) = ([0.0, 0.0], [0.0, 0.0]);
            for rub in &mut group.rubs {
                let friction = &s.frictions[rub.friction];
                rub.opposes = match friction.blocks {
                    Some(blocks) => {
                        let along = f64::from(blocks) * rub.factor;
                        [along > 0.0, along < 0.0].map(|b| if b { UNBOUNDED } else { 0.0 })
                    }
                    None => [self.inputs[of_frictions + rub.friction]; 2],
                };
                rub.viscous = self.tau[rub.port];
                for k in 0..2 {
                    let c = rub.opposes[k] * rub.factor.abs();
                    slides[k] += c;
                    holds[k] += c * friction.peak;
                }
            }
            self.capacity[g] = holds;
            // What prescribed speeds alone move follows them; what has no friction has no mode, and what cannot slide
            // that way is held.
            if group.driven {
                if slip != 0.0 {
                    self.sign[g] = if slip < 0.0 { -1 } else { 1 };
                }
            } else if slides == [0.0; 2] && group.elements.is_empty() {
                self.sign[g] = 1;
            } else if self.sign[g] != 0 && slides[usize::from(self.sign[g] < 0)] >= LEAST_UNBOUNDED {
                self.impacts += u64::from(slip * f64::from(self.sign[g]) > 1e-9);
                self.sign[g] = 0;
            }
        }
    }

    /// Torques of what slides, and the losses of teeth that do not depend on load, in the present mode; at their
    /// peak in the group that is breaking away.
    #[inline(always)]
    fn rub(&mut self, breaking: Option<usize>) {
        for (g, group) in self.groups.iter().enumerate() {
            let sign = self.sign[g];
            for rub in &group.rubs {
                let opposes = match sign {
                    0 => 0.0,
                    1 => -rub.opposes[0],
                    _ => rub.opposes[1],
                };
                let opposes = if opposes.abs() >= LEAST_UNBOUNDED { 0.0 } else { opposes };
                let opposes = if breaking == Some(g) { opposes * rub.peak } else { opposes };
                self.tau[rub.port] = rub.viscous + if rub.factor < 0.0 { -opposes } else { opposes };
            }
            for &(j, port, [drive, coast]) in &group.constants {
                let (_, factor) = self.engine.system.elements[j].group.expect("of this group");
                let torque = if self.side[j] == Side::Drive { drive } else { coast };
                self.tau[port] = f64::from(sign) * factor.signum() * torque;
            }
        }
    }

    /// Round-off of the slip of a group at the end of the step.
    fn round_off(&self, g: usize) -> f64 {
        NOISE * (dot_size(&self.groups[g].row, &self.next) + self.slip[g].abs())
    }

    /// The first thing in which the mode and the end of the step disagree. Groups in `kept` came to rest at once after
    /// they were released: those that others hold as well go on sliding without moving, the rest is not released again.
    #[inline(always)]
    fn disagreement(&self, map: &StepMap, free: usize, cols: usize, kept: u64) -> Option<Flip> {
        let mut rows = map.rows[free * cols..].chunks_exact(cols);
        let mut stuck = None;
        let mut teeth = map.still.iter();
        for (g, group) in self.groups.iter().enumerate().filter(|(_, group)| !group.driven) {
            if self.sign[g] != 0 {
                let end = dot(&group.row, &self.next) * f64::from(self.sign[g]);
                let may_hold = self.capacity[g] != [0.0; 2] || !group.elements.is_empty();
                let only_noise = || kept >> g & 1 == 1 && end >= -self.round_off(g);
                if end < 0.0 && may_hold && !only_noise() {
                    return Some(Flip::Group(g, 0));
                }
                continue;
            }
            let force = group.lead.1 * dot(rows.next().expect("a row for each"), &self.tau);
            if group.shares && !map.redundant {
                // What teeth hold follows from the torque in them once they slide: that is tried.
                teeth.by_ref().nth(group.elements.len() - 1);
                continue;
            }
            let [mut forward, mut backward] = self.capacity[g];
            // Teeth at rest hold by the forces in them.
            for &j in &group.elements {
                let (_, row) = teeth.next().expect("a row for each");
                let (_, factor, loss) = self.teeth[j];
                let torque = dot(row, &self.tau);
                let upper = (loss.drive * torque + loss.drive_torque).max(loss.coast * torque + loss.coast_torque);
                let lower = (loss.drive * torque - loss.drive_torque).min(loss.coast * torque - loss.coast_torque);
                let (along, against) = if factor > 0.0 { (upper, -lower) } else { (lower, -upper) };
                forward += factor * along;
                backward += factor * against;
            }
            let noise = 1e-12 * (force.abs() + 1e-300);
            let sign = match (forward + force < -noise, backward - force < -noise) {
                (true, _) => 1,
                (_, true) => -1,
                _ => continue,
            };
            if kept >> g & 1 == 0 {
                return Some(Flip::Group(g, sign));
            }
            stuck = Some(Flip::Stuck);
        }
        for (&j, row) in map.moving.iter().zip(rows) {
            let j = usize::from(j);
            let (g, factor, loss) = self.teeth[j];
            if self.sign[g] == 0 {
                continue;
            }
            let sign = f64::from(self.sign[g]) * factor.signum();
            let torque = dot(row, &self.tau);
            let value = sign * (loss.drive - loss.coast) * torque + loss.drive_torque - loss.coast_torque;
            let value = if self.side[j] == Side::Drive { value } else { -value };
            // A mesh that carries nothing keeps its side.
            if value < 0.0 && value < -NOISE * (loss.drive - loss.coast) * dot_size(row, &self.tau) {
                return Some(Flip::Side(j));
            }
        }
        stuck
    }

    /// Whether a held group whose parts share in holding would slide off: tried in both directions.
    fn breaks_away(&mut self, g: usize) -> Option<i8> {
        let sides: u64 = self.coasting();
        let p = self.engine.system.ports;
        let (free, cols) = (self.engine.system.free, p + self.groups.len());
        for sign in [1i8, -1] {
            if self.capacity[g][usize::from(sign < 0)] >= LEAST_UNBOUNDED {
                continue;
            }
            self.sign[g] = sign;
            // Sides that agree: the last ones, else each turned once.
            for _ in 0..=self.groups[g].elements.len() {
                let Some(map) = self.map(self.key()) else { break };
                self.rub(Some(g));
                let map = &self.maps[map as usize];
                let rows = &map.rows;
                let turned = (map.moving.iter().zip(rows[(free + map.held.len()) * cols..].chunks_exact(cols)))
                    .filter(|(j, _)| self.teeth[usize::from(**j)].0 == g)
                    .find_map(|(&j, row)| {
                        let j = usize::from(j);
                        let (_, factor, loss) = self.teeth[j];
                        let along = f64::from(sign) * factor.signum();
                        let value = along * (loss.drive - loss.coast) * dot(row, &self.tau) + loss.drive_torque
                            - loss.coast_torque;
                        let side = if value >= 0.0 { Side::Drive } else { Side::Coast };
                        (side != self.side[j]).then_some((j, side))
                    });
                let Some((j, side)) = turned else { break };
                self.side[j] = side;
            }
            let Some(map) = self.map(self.key()) else { continue };
            self.rub(Some(g));
            let rows = &self.maps[map as usize].rows;
            let rate: f64 =
                (0..free).map(|i| self.groups[g].row[i] * dot(&rows[i * cols..(i + 1) * cols], &self.tau)).sum();
            let end = self.slip[g] + self.h * rate;
            // Others may hold it as well: then nothing but round-off is left.
            let size = dot_size(&self.groups[g].row, &self.v) + self.slip[g].abs();
            if end * f64::from(sign) > 1e-11 * size {
                return Some(sign);
            }
        }
        self.sign[g] = 0;
        for (j, side) in self.side.iter_mut().enumerate() {
            *side = if sides >> j & 1 == 1 { Side::Coast } else { Side::Drive };
        }
        None
    }

    fn coasting(&self) -> u64 {
        self.side.iter().enumerate().map(|(j, s)| u64::from(*s == Side::Coast) << j).sum()
    }

    /// Solves the step in the present mode.
    #[inline(always)]
    fn solve(&mut self, free: usize, cols: usize) -> Option<u32> {
        let map = self.map(self.key())?;
        self.rub(None);
        let rows = &self.maps[map as usize].rows;
        for (i, row) in rows[..free * cols].chunks_exact(cols).enumerate() {
            self.next[i] = self.v[i] + self.h * dot(row, &self.tau);
        }
        Some(map)
    }

    /// Finds the mode of the step and its end.
    #[inline(always)]
    fn settle(&mut self, free: usize, cols: usize) -> bool {
        let trials = 4 * (self.groups.len() + self.side.len()) + 4;
        // The group released last, and those that came to rest again at once.
        let (mut released, mut kept) = (None, 0u64);
        for _ in 0..trials {
            let Some(map) = self.solve(free, cols) else { return false };
            let mut flip = self.disagreement(&self.maps[map as usize], free, cols, kept);
            if flip.is_none() && self.shares && !self.maps[map as usize].redundant {
                for g in 0..self.groups.len() {
                    if self.sign[g] == 0
                        && self.groups[g].shares
                        && let Some(sign) = self.breaks_away(g)
                    {
                        flip = Some(Flip::Group(g, sign));
                        break;
                    }
                }
                if flip.is_none() {
                    self.solve(free, cols);
                }
            }
            match flip {
                None => return true,
                Some(Flip::Group(g, sign)) => {
                    let again = sign == 0 && released == Some(g) && kept >> g & 1 == 0;
                    if again {
                        kept |= 1 << g;
                    }
                    released = (sign != 0).then_some(g);
                    if !again || dot(&self.groups[g].row, &self.next).abs() > self.round_off(g) {
                        self.sign[g] = sign;
                    }
                }
                Some(Flip::Side(j)) => self.side[j] = self.side[j].other(),
                Some(Flip::Stuck) => return false,
            }
        }
        false
    }

    /// The mode in every detail.
    fn exactly(&self) -> Exactly {
        let mut key = Exactly::default();
        for (g, group) in self.groups.iter().enumerate() {
            let bit = 1 << g;
            if self.sign[g] == 0 && !group.driven {
                key.held |= bit;
            } else if self.capacity[g] == [0.0; 2] && group.elements.is_empty() {
                key.idle |= bit;
            } else if self.sign[g] > 0 {
                key.forward |= bit;
            }
        }
        key.coast = self.coasting();
        key
    }

    /// Makes the fused step of the mode just settled the present one.
    fn fuse(&mut self) {
        self.present = None;
        let Some((_, map)) = self.last else { return };
        let map = &self.maps[map as usize];
        let held_shares = self.groups.iter().zip(&self.sign).any(|(group, sign)| *sign == 0 && group.shares);
        if self.swept || !self.energies.is_empty() || held_shares && !map.redundant {
            return;
        }
        for (j, row) in &map.still {
            let torque = dot(row, &self.tau);
            self.side[usize::from(*j)] = if torque >= 0.0 { Side::Drive } else { Side::Coast };
        }
        let key = self.exactly();
        let k = match self.by_exact_key.get(&key) {
            Some(&k) => k,
            None => {
                let s = &self.engine.system;
                self.fused.push(Fused::new(s, &self.groups, &self.teeth, map, &key, self.h));
                let k = self.fused.len() as u32 - 1;
                self.by_exact_key.insert(key, k);
                k
            }
        };
        let fused = &self.fused[k as usize];
        fused.settle(&self.v, &self.inputs, &self.varying, &mut self.base, &mut self.least);
        self.ends.resize(fused.rows, 0.0);
        self.present = Some(k);
    }

    /// Takes the step in the mode of the last one; false, and nothing done, if that does not go on.
    #[inline]
    fn glide(&mut self, middle: f64) -> bool {
        let Some(k) = self.present else { return false };
        if !self.engine.system.elastic.is_empty() {
            self.look_at_shafts();
        }
        let fused = &self.fused[k as usize];
        let all = self.v.len();
        self.ends.copy_from_slice(&self.base);
        for (k, v) in self.v.iter().enumerate() {
            add_column(&mut self.ends, fused.column(k), *v);
        }
        let s = &self.engine.system;
        let (drivers, frictions) = (s.drivers.len(), s.frictions.len());
        for &k in &self.varying {
            let u = self.input(k, middle);
            // What opens, closes or locks is more than a change of torque.
            if k >= drivers && k < drivers + frictions {
                let was = self.inputs[k];
                if (u == 0.0) != (was == 0.0) || (u == UNBOUNDED) != (was == UNBOUNDED) {
                    return false;
                }
            }
            add_column(&mut self.ends, fused.column(all + k), u);
            self.inputs[k] = u;
        }
        let broken = self.ends.iter().zip(&self.least).fold(false, |broken, (end, least)| broken | (end < least));
        if broken {
            return false;
        }
        self.next[..s.free].copy_from_slice(&self.ends[..s.free]);
        if s.prescribed > 0 {
            for (driver, u) in s.drivers.iter().zip(&self.inputs) {
                if let Some(i) = driver.prescribed {
                    self.next[s.free + i] = *u;
                }
            }
        }
        true
    }

    /// The middle of the next step, s.
    pub(super) fn middle(&self) -> f64 {
        self.time() + 0.5 * self.h
    }

    /// Whether what was level is no longer.
    pub(super) fn is_over(&self, middle: f64) -> bool {
        middle >= self.until || self.until == f64::NEG_INFINITY
    }

    /// Counts prescribed speeds that jump, which takes an impact.
    pub(super) fn count_jumps(&mut self, at: f64, middle: f64) {
        let s = &self.engine.system;
        for (driver, source) in s.drivers.iter().zip(&s.scenario.sources) {
            if let (Some(_), SourceKind::Speed(signal)) = (driver.prescribed, &source.kind)
                && at.is_finite()
            {
                let [before, after] = [middle - self.h, middle].map(|inside| signal.value(at, inside, &|_| 0.0));
                self.impacts += u64::from((after - before).abs() > 1e-6 * (after.abs() + before.abs()));
            }
        }
    }

    /// Whether what a run takes in follows from more than what a batch knows of it: twists of shafts, set points that
    /// follow speeds.
    pub(super) fn needs_itself(&self) -> bool {
        let s = &self.engine.system;
        let follows =
            |kind: &SourceKind| matches!(kind, SourceKind::Controller { setpoint, .. } if setpoint.depends_on_speed());
        !s.elastic.is_empty() || s.scenario.sources.iter().any(|source| follows(&source.kind))
    }

    /// Whether all speeds are finite.
    pub(super) fn is_finite(&self) -> bool {
        self.v.iter().all(|v| v.is_finite())
    }

    /// Whether an input that is not level depends on speeds, not on time alone.
    pub(super) fn depends_on_speed(&self, k: usize) -> bool {
        let s = &self.engine.system;
        let drivers = s.drivers.len();
        let signal = match s.scenario.sources.get(k).map(|source| &source.kind) {
            Some(SourceKind::Torque(signal) | SourceKind::Speed(signal)) => signal,
            Some(_) => return true,
            None => match s.frictions.get(k - drivers) {
                Some(friction) if friction.rigid || self.flat[k - drivers].is_some() => match friction.engagement {
                    Some(e) => &s.scenario.engagements[e].signal,
                    None => return false,
                },
                _ => return true,
            },
        };
        signal.depends_on_speed()
    }

    /// Takes one step.
    pub fn step(&mut self) {
        let middle = self.middle();
        if self.is_over(middle) {
            let ended = self.until;
            self.refresh(middle);
            self.count_jumps(ended, middle);
            self.present = None;
        }
        if !self.glide(middle) {
            self.load(middle);
            let free = self.engine.system.free;
            let cols = self.tau.len();
            self.swept = false;
            if !self.arch.dispatch(Settle { step: self, free, cols }) && !self.sweep(free, cols) {
                self.unsettled += 1;
            }
            if !self.energies.is_empty() {
                self.count_energies();
            }
            self.fuse();
        }
        // What is held is at rest exactly, not but for round-off.
        if self.keeps_angles {
            let all = self.engine.system.all();
            for i in 0..all {
                self.rest[i] += self.h * self.next[i];
            }
        }
        if self.engine.system.integrals > 0 {
            let s = &self.engine.system;
            for (driver, source) in s.drivers.iter().zip(&s.scenario.sources) {
                if let (Some(i), SourceKind::Controller { setpoint, .. }) = (driver.integral, &source.kind) {
                    let set = setpoint.value(middle, middle, &|m: MemberId| dot(&s.speeds[m.index()], &self.next));
                    self.rest[s.all() + i] += self.h * (set - dot(&s.speeds[driver.member.index()], &self.next));
                }
            }
        }
        std::mem::swap(&mut self.v, &mut self.next);
        self.count += 1;
    }

    /// Balances the friction of clutches, brakes and drags by projected sweeps, where flipping single modes does not
    /// settle: each takes the torque that brings its slip to rest by the end of the step, within what it can
    /// hold. Teeth that move lose what they lose on their present sides; teeth at rest are taken to follow
    /// what holds the shafts around them, without friction of their own. True if that converged.
    #[cold]
    fn sweep(&mut self, free: usize, cols: usize) -> bool {
        const MOST_SWEEPS: usize = 2000;
        const ROUNDS: usize = 8;
        let still = |slip: f64, group: &GroupStep, v: &[f64]| slip.abs() <= 1e-9 * dot_size(&group.row, v);
        let mut converged = false;
        for _ in 0..ROUNDS {
            let mut mode = Mode { slip: vec![0; self.groups.len()], side: self.side.clone() };
            for (g, group) in self.groups.iter().enumerate() {
                let sign = if self.slip[g] < 0.0 { -1 } else { 1 };
                mode.slip[g] = if still(self.slip[g], group, &self.v) && !group.driven { 0 } else { sign };
            }
            let s = &self.engine.system;
            let Some(pattern) = self.engine.maps.pattern(s, &mode) else { return false };
            let wide = pattern.with_slips(self.groups.len());
            let tau = &mut self.tau;
            for (g, group) in self.groups.iter().enumerate() {
                group.rubs.iter().for_each(|r| tau[r.port] = r.viscous);
                for &(j, port, [drive, coast]) in &group.constants {
                    let along = f64::from(mode.slip[g]) * self.teeth[j].1.signum();
                    tau[port] = along * if self.side[j] == Side::Drive { drive } else { coast };
                }
            }
            converged = false;
            for _ in 0..MOST_SWEEPS {
                let (mut change, mut largest) = (0.0f64, 0.0f64);
                for (g, group) in self.groups.iter().enumerate().filter(|(_, group)| !group.driven) {
                    let row = &wide.slip[g * cols..(g + 1) * cols];
                    for rub in &group.rubs {
                        let [forward, backward] = rub.opposes;
                        let (low, high) = if rub.factor > 0.0 { (-forward, backward) } else { (-backward, forward) };
                        let old = tau[rub.port] - rub.viscous;
                        let next = (old - dot(row, tau) / row[rub.port]).clamp(low, high);
                        change = change.max((next - old).abs());
                        largest = largest.max(next.abs());
                        tau[rub.port] = next + rub.viscous;
                    }
                }
                if change <= 1e-13 * largest {
                    converged = true;
                    break;
                }
            }
            for i in 0..free {
                self.next[i] = self.v[i] + self.h * dot(&wide.response[i * cols..(i + 1) * cols], tau);
            }
            // Sides of what moves.
            let all = s.all();
            let mut turned = false;
            for (g, group) in self.groups.iter().enumerate() {
                let end = dot(&group.row, &self.next);
                let rest = still(end, group, &self.v) && still(end, group, &self.next);
                self.sign[g] = if rest && !group.driven {
                    0
                } else if end < 0.0 {
                    -1
                } else {
                    1
                };
                for &j in &group.elements {
                    let (_, factor, loss) = self.teeth[j];
                    let torque =
                        s.elements[j].factors[0] * dot(&wide.response[(all + j) * cols..(all + j + 1) * cols], tau);
                    let along =
                        f64::from(if self.sign[g] == 0 { mode.slip[g] } else { self.sign[g] }) * factor.signum();
                    let value = along * (loss.drive - loss.coast) * torque + loss.drive_torque - loss.coast_torque;
                    let side = if value >= 0.0 { Side::Drive } else { Side::Coast };
                    turned |= side != self.side[j] && mode.slip[g] != 0;
                    self.side[j] = side;
                }
            }
            // The losses stand beside the ports, for the count of energies.
            for (j, e) in s.elements.iter().enumerate() {
                if let Some((g, _)) = e.group
                    && mode.slip[g] != 0
                {
                    let torque = e.factors[0] * dot(&wide.response[(all + j) * cols..(all + j + 1) * cols], &self.tau);
                    self.losses[j] = super::mode::slope(self.teeth[j].2, mode.side[j]) * torque + self.tau[e.port];
                } else {
                    self.losses[j] = 0.0;
                }
            }
            for i in 0..s.prescribed {
                let row = &wide.response[(free + i) * cols..(free + i + 1) * cols];
                self.reactions[i] = dot(row, &self.tau);
            }
            if !turned {
                break;
            }
        }
        self.swept = true;
        converged
    }

    /// Begins to count energies.
    pub(super) fn with_energies(&mut self) {
        self.energies = vec![0.0; self.engine.energies()];
        self.came_in = vec![0.0; self.engine.system.drivers.len()];
    }

    /// Work of the step's torques at the mean of the speeds before and after it.
    fn count_energies(&mut self) {
        let s = &self.engine.system;
        let (free, cols) = (s.free, self.tau.len());
        let Some((_, map)) = self.last else { return };
        let map = &self.maps[map as usize];
        // Holding torques join those of the ports.
        let mut tau = self.tau[..s.ports].to_vec();
        for (k, &g) in map.held.iter().enumerate().filter(|_| !self.swept) {
            let row = &map.rows[(free + k) * cols..(free + k + 1) * cols];
            tau[self.groups[usize::from(g)].lead.0] += dot(row, &self.tau);
        }
        let mean: Vec<f64> = self.v.iter().zip(&self.next).map(|(a, b)| 0.5 * (a + b)).collect();
        for (k, (driver, source)) in s.drivers.iter().zip(&s.scenario.sources).enumerate() {
            let row = &s.speeds[driver.member.index()];
            let mut torque = match driver.prescribed {
                Some(i) => {
                    if self.swept {
                        self.reactions[i]
                    } else {
                        dot(&map.reactions[i * cols..(i + 1) * cols], &self.tau)
                    }
                }
                None => tau[driver.port.expect("a torque")],
            };
            if let SourceKind::Controller { derivative, .. } = &source.kind {
                torque -= derivative * (dot(row, &self.next) - dot(row, &self.v)) / self.h;
            }
            if let Some(f) = driver.rolling {
                torque += tau[s.frictions[f].port];
            }
            let work = torque * dot(row, &mean) * self.h;
            self.energies[k] += work;
            self.came_in[k] += work.max(0.0);
        }
        let mut at = s.drivers.len();
        for (k, f) in s.frictions.iter().enumerate() {
            if !matches!(f.what, super::system::Rubs::Rolling(_)) {
                self.energies[at + k] -= tau[f.port] * dot(&f.row, &mean) * self.h;
            }
        }
        at += s.frictions.len();
        for (k, e) in s.elastic.iter().enumerate() {
            let (spring, _) = self.engine.shaft_parts(k, &self.state);
            self.energies[at + k] -= (tau[e.port] + spring) * dot(&e.row, &mean) * self.h;
        }
        at += s.elastic.len();
        if self.swept {
            for (j, e) in s.elements.iter().enumerate() {
                let energy = self.losses[j] * dot(&e.row, &mean) * self.h;
                for &(mesh, part) in &e.shares[usize::from(self.side[j] == Side::Coast)] {
                    self.energies[at + mesh] += energy * part;
                }
            }
            return;
        }
        let moving = map.rows[(free + map.held.len()) * cols..].chunks_exact(cols);
        for (&j, row) in map.moving.iter().zip(moving) {
            let j = usize::from(j);
            let (_, _, loss) = self.teeth[j];
            let e = &s.elements[j];
            let torque = dot(row, &self.tau) * super::mode::slope(loss, self.side[j]) + tau[e.port];
            let energy = torque * dot(&e.row, &mean) * self.h;
            for &(mesh, part) in &e.shares[usize::from(self.side[j] == Side::Coast)] {
                self.energies[at + mesh] += energy * part;
            }
        }
        // Teeth that hold, in the step in which they come to rest.
        for &g in &map.held {
            let (port, _) = self.groups[usize::from(g)].lead;
            for &j in &self.groups[usize::from(g)].elements {
                if s.elements[j].port == port {
                    let energy = tau[port] * dot(&s.elements[j].row, &mean) * self.h;
                    for &(mesh, part) in &s.elements[j].shares[usize::from(self.side[j] == Side::Coast)] {
                        self.energies[at + mesh] += energy * part;
                    }
                }
            }
        }
    }

    /// What labels depend on.
    pub(super) fn state_of_modes(&self) -> (u64, u64, u64, f64) {
        let held = self.sign.iter().enumerate().map(|(g, s)| u64::from(*s == 0) << g).sum();
        let forward = self.sign.iter().enumerate().map(|(g, s)| u64::from(*s > 0) << g).sum();
        let code = |touch: &Touch| match touch {
            Touch::Gap => 0,
            Touch::On(side) => 1 + i64::from(*side),
            Touch::Limited(side) => 4 + i64::from(*side),
            Touch::Parting(side) => 7 + i64::from(*side),
        };
        let touch = self.engine.touch.iter().fold(0u64, |sum, t| sum.wrapping_mul(9).wrapping_add(code(t) as u64));
        (held, forward, touch, self.until)
    }

    /// Brings the engine to the state and mode reached.
    pub(super) fn copy_to_engine(&mut self, x: &mut Vec<f64>) {
        let free = self.engine.system.free;
        x.clear();
        x.extend_from_slice(&self.v[..free]);
        x.extend_from_slice(&self.rest);
        x.extend_from_slice(&self.energies);
        let t = self.time();
        self.engine.inside = t;
        self.engine.look(t, x);
        let mode = Mode {
            slip: (self.sign.iter().enumerate())
                .map(|(g, s)| if self.groups[g].driven && self.slip[g] == 0.0 { 0 } else { *s })
                .collect(),
            side: self.side.clone(),
        };
        for k in 0..self.engine.engaged.len() {
            let engaged = self.engine.engagement(k, t);
            let is_rigid = self.engine.system.frictions[k].rigid;
            self.engine.engaged[k] = if is_rigid { engaged >= 0.5 } else { engaged > 0.0 };
        }
        self.engine.enter(&mode);
    }
}

/// [`FixedStep::settle`] with the widest registers there are.
struct Settle<'a> {
    step: &'a mut FixedStep,
    free: usize,
    cols: usize,
}

impl pulp::WithSimd for Settle<'_> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> bool {
        self.step.settle(self.free, self.cols)
    }
}

/// The flat map of a mode.
fn step_map(s: &System, mode: &Mode, pattern: &Pattern) -> Option<StepMap> {
    let wide = pattern.with_slips(s.groups.len());
    let map = compose(s, mode, &wide, &[])?;
    let cols = wide.ports;
    let torque_row = |j: usize| -> Vec<f64> {
        let row = &map.response[(s.all() + j) * cols..(s.all() + j + 1) * cols];
        row.iter().map(|x| x * s.elements[j].factors[0]).collect()
    };
    let mut rows: Vec<f64> = map.response[..s.free * cols].to_vec();
    let held: Vec<u16> =
        (0..s.groups.len()).filter(|&g| mode.slip[g] == 0 && !s.groups[g].driven).map(|g| g as u16).collect();
    for &g in &held {
        rows.extend_from_slice(&map.holding[usize::from(g) * cols..(usize::from(g) + 1) * cols]);
    }
    let mut moving = Vec::new();
    for (j, e) in s.elements.iter().enumerate() {
        let Some((g, _)) = e.group else { continue };
        let torque = torque_row(j);
        if mode.slip[g] != 0 || s.groups[g].driven {
            moving.push(j as u16);
            rows.extend_from_slice(&torque);
        }
    }
    let still =
        (held.iter()).flat_map(|&g| &s.groups[usize::from(g)].elements).map(|&j| (j as u16, torque_row(j))).collect();
    let redundant = map.is_redundant();
    let reactions = map.response[s.free * cols..s.all() * cols].to_vec();
    Some(StepMap { rows, held, moving, still, redundant, reactions })
}

enum Flip {
    Group(usize, i8),
    Side(usize),
    /// Only groups that are kept would have to be released.
    Stuck,
}
