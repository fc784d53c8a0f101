//! Torques of the ports at a state, and what follows from them in a mode.

use std::sync::Arc;

use crate::operating_point::LEAST_SPEED;
use crate::train::{Contact, MemberId, SourceKind};

use super::contacts::Contacts;
use super::element::{Element, Loss};
use super::halt::Halt;
use super::mode::{Map, Maps, Mode, Side, compose, dot, slope};
use super::report::LimitExceeded;
use super::shows::{Moves, Shows};
use super::source::{out_of_domain, source_torque};
use super::still::Still;
use super::stretch::Steady;
use super::system::{PathKind, Rubs, System};
use super::warming::Warming;

/// What a backlash does.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Touch {
    /// Within the backlash.
    Gap,
    /// In contact on the side of positive or negative twist.
    On(i8),
    /// In contact, damping limited to the torque of the spring.
    Limited(i8),
    /// In contact, but the damper would pull.
    Parting(i8),
}

/// Torque with which a group can oppose its slip, forward and backward, in units of its slip.
#[derive(Clone, Copy, Debug)]
pub(super) struct Capacity {
    pub forward: f64,
    pub backward: f64,
}

/// A variator at the state looked at.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PathState {
    /// r of `ω_p = r ω_q`.
    pub ratio: f64,
    /// T, which it takes from p, N m.
    pub torque: f64,
}

/// Change in a round that counts as none, over the sum of the losses as torques.
const AGREEMENT: f64 = 1e-11;

/// The same over the size of the forces, where the losses themselves are round-off.
const ROUND_OFF: f64 = 1e-13;

/// Most rounds at a state.
const MOST_ROUNDS: usize = 100;

/// Size below which a speed, rad/s, or an angle, rad, counts as small at the start of a run.
const LEAST_SCALE: f64 = 1e-3;

/// How much less exactly than a speed the torque of a variator is followed: its damper makes a torque of the round-off of
/// speeds, below which no step can go.
const GIVE: f64 = 100.0;

/// The same for what has but a trace of inertia: its angle says where it is, and its speed, a difference of large angles
/// over a short time, need not be better than that.
const FOLLOWS: f64 = 1e6;

/// The same for an energy, J.
const LEAST_ENERGY: f64 = 1e-6;

/// A system in a mode.
#[derive(Clone)]
pub(crate) struct Engine {
    pub system: System,
    pub maps: Maps,
    pub mode: Mode,
    pub touch: Vec<Touch>,
    pub engaged: Vec<bool>,
    /// A time within the smooth piece of all signals.
    pub inside: f64,
    pub map: Option<Arc<Map>>,
    /// Whether the map follows speed or load.
    pub varying: bool,
    /// At the state looked at last: speeds of the coordinates, their rates, torques of the ports.
    pub speed: Vec<f64>,
    pub acceleration: Vec<f64>,
    pub tau: Vec<f64>,
    /// Variators at the state looked at last.
    pub path_states: Vec<PathState>,
    /// Which limit the ratio of each is at: −1 the least, 1 the greatest, 0 none.
    pub path_ends: Vec<i8>,
    /// Limits of variators that were exceeded, where they were by most.
    pub beyond: Vec<LimitExceeded>,
    /// Machines that ran outside their maps, and when first.
    pub left_maps: Vec<(String, f64)>,
    /// Machines that balance a bus and came to their limit of torque, and when first.
    pub fell_short: Vec<(String, f64)>,
    /// What is in contact, and the decisions of what it does.
    pub contacts: Contacts,
    /// Whether one motion is certain in every state.
    pub certified: bool,
    /// The same; none if there were too many states to look at.
    pub certificate: Option<bool>,
    /// Whether one motion is certain and all that is lost in meshes is a constant part of their load, so that modes can
    /// be beyond doubt by their maps.
    pub plain: bool,
    /// Whether forces and laws agreed at the state solved last.
    pub agrees: bool,
    /// Whether energies are counted.
    pub counts: bool,
    /// Temperatures that follow what is lost, and those of each place in the row made last, K.
    pub warming: Option<Box<Warming>>,
    pub warmth: Vec<f64>,
    /// Sizes of the states, against which errors are measured where a state is small.
    pub scales: Vec<f64>,
    /// Choices of which it was not proved that they are the only ones.
    pub unproved: usize,
    /// Size of the energies, J, likewise.
    pub energy_scale: f64,
    /// What can be read, in the order of the columns.
    pub shows: Vec<Shows>,
    /// The names of what has a mode, in that order.
    pub names: Vec<String>,
    /// What stands still exactly; none while that is not known.
    pub still: Option<Arc<Still>>,
    /// Those met so far, and how groups came to rest.
    pub stills: Vec<Arc<Still>>,
    pub halts: Vec<Arc<Halt>>,
    /// By how many times its round-off a force has to be beyond its limit before that counts as an event: what
    /// the integrator leaves open.
    pub slack: f64,
    /// What all states of the present stretch have in common; none where that was not asked for.
    pub steady: Option<Steady>,
    /// The same of stretches that were.
    pub stretches: Vec<Steady>,
}

impl Engine {
    pub fn new(system: System) -> Self {
        let certificate = system.every_state_is_unique();
        Self::with_certificate(system, certificate)
    }

    /// The engine of a new run, with what was learned about modes.
    pub fn anew(mut self) -> Self {
        self.leave_stretch();
        let Self { mut system, maps, stills, halts, stretches, certificate, counts, slack, .. } = self;
        if let Some(laws) = &mut system.laws {
            laws.begin();
        }
        Self { maps, stills, halts, stretches, counts, slack, ..Self::with_certificate(system, certificate) }
    }

    fn with_certificate(system: System, certificate: Option<bool>) -> Self {
        let (groups, elements) = (system.groups.len(), system.elements.len());
        let mode = Mode { slip: vec![0; groups], side: vec![Side::Drive; elements] };
        let mut scales = vec![LEAST_SCALE; system.free + system.all() + system.integrals];
        system.followers.iter().for_each(|(k, _)| scales[*k] = FOLLOWS);
        for path in &system.paths {
            // The give of a variator is tiny, and counts by its torque.
            if let PathKind::Geared(geared) = &path.kind {
                scales[system.free + system.all() + geared.slip] = LEAST_SCALE / geared.stiffness;
            }
        }
        let plain = certificate == Some(true)
            && system.laws.is_none()
            && system.prescribed == 0
            && system.elements.iter().all(Element::is_plain);
        Self {
            maps: Maps::default(),
            mode,
            touch: vec![Touch::Gap; system.elastic.len()],
            engaged: vec![false; system.frictions.len()],
            inside: 0.0,
            map: None,
            warming: None,
            warmth: vec![],
            varying: false,
            speed: vec![0.0; system.all()],
            acceleration: vec![0.0; system.all()],
            tau: vec![0.0; system.ports],
            path_states: vec![PathState::default(); system.paths.len()],
            path_ends: vec![0; system.paths.len()],
            beyond: vec![],
            left_maps: vec![],
            fell_short: vec![],
            scales,
            energy_scale: LEAST_ENERGY,
            unproved: 0,
            contacts: Contacts::default(),
            still: None,
            stills: vec![],
            halts: vec![],
            names: Moves::all(&system).into_iter().map(|moves| moves.name(&system)).collect(),
            shows: Shows::all(&system),
            plain,
            agrees: true,
            slack: 1.0,
            steady: None,
            stretches: vec![],
            counts: true,
            certified: certificate == Some(true),
            certificate,
            system,
        }
    }

    /// Remembers how large the states and the energies become.
    pub fn rescale(&mut self, x: &[f64]) {
        self.energy_scale = x[self.scales.len()..].iter().fold(self.energy_scale, |m, e| m.max(e.abs()));
        for (scale, x) in self.scales.iter_mut().zip(x) {
            *scale = scale.max(0.1 * x.abs());
        }
        let integrals = self.integrals();
        for path in &self.system.paths {
            if let PathKind::Geared(geared) = &path.kind {
                let k = integrals + geared.slip;
                self.scales[k] = self.scales[k].max(GIVE * x[k].abs());
            }
        }
    }

    /// Position of the controllers' integrals.
    pub fn integrals(&self) -> usize {
        self.system.free + self.system.all()
    }

    pub fn group_slip(&self, g: usize) -> f64 {
        match &self.still {
            Some(still) if still.holds(g) => 0.0,
            _ => dot(&self.system.groups[g].row, &self.speed),
        }
    }

    pub fn member_speed(&self, m: MemberId) -> f64 {
        dot(self.row_of(m.index()), &self.speed)
    }

    /// A formula that has no finite value at a time, at the speeds looked at last, or a variator that has no torque
    /// there, in words.
    pub fn out_of_domain(&self, t: f64) -> Option<String> {
        let s = &self.system;
        out_of_domain(&s.train, &s.scenario, t, self.inside, &|m| self.member_speed(m))
            .or_else(|| self.path_without_lever(t))
    }

    /// From now on what this mode holds stands still exactly, in the state too; the engine looks at it.
    pub fn stand_still(&mut self, mode: &Mode, x: &mut [f64]) {
        let groups = &self.system.groups;
        let held: Vec<bool> = (0..groups.len()).map(|g| mode.slip[g] == 0 && !groups[g].driven).collect();
        let still = match self.stills.iter().find(|still| still.held == held) {
            Some(still) => still.clone(),
            None => {
                let still = Arc::new(Still::of(&self.system, held));
                self.stills.push(still.clone());
                still
            }
        };
        still.settle(&mut self.speed);
        let free = self.system.free;
        x[..free].copy_from_slice(&self.speed[..free]);
        self.still = Some(still);
    }

    /// Every member's speed, or acceleration, over the coordinates.
    pub fn row_of(&self, member: usize) -> &[f64] {
        match &self.still {
            Some(still) => &still.members[member],
            None => &self.system.speeds[member],
        }
    }

    /// Takes over the speeds of a state.
    pub fn look(&mut self, t: f64, x: &[f64]) {
        let free = self.system.free;
        self.speed[..free].copy_from_slice(&x[..free]);
        let prescribes = if self.system.prescribed > 0 { &self.system.drivers[..] } else { &[] };
        for (k, driver) in prescribes.iter().enumerate() {
            if let (Some(i), SourceKind::Speed(signal)) = (driver.prescribed, &self.system.scenario.sources[k].kind) {
                self.speed[free + i] = signal.value(t, self.inside, &|_| 0.0);
                self.acceleration[free + i] = signal.rate(t, self.inside, &|_| 0.0);
            }
        }
        if let Some(still) = &self.still {
            still.settle(&mut self.speed);
        }
        if !self.path_states.is_empty() {
            self.look_at_paths(t, x);
        }
    }

    /// Torque of a source at the state looked at, without what its derivative part adds through the
    /// acceleration.
    pub fn source_torque(&self, k: usize, t: f64, x: &[f64]) -> f64 {
        let driver = &self.system.drivers[k];
        let speed = |m: MemberId| self.member_speed(m);
        if let SourceKind::Torque(signal) = &self.system.scenario.sources[k].kind {
            return signal.value(t, self.inside, &speed);
        }
        let sum = driver.integral.map_or(0.0, |i| x[self.integrals() + i]);
        source_torque(
            &self.system.scenario.sources[k].kind,
            speed(driver.member),
            sum,
            |_, signal| signal.value(t, self.inside, &speed),
            |signal| signal.rate(t, self.inside, &speed),
        )
    }

    /// Torque of an elastic shaft on its first member.
    pub fn shaft_torque(&self, k: usize, x: &[f64]) -> f64 {
        let shaft = &self.system.train.shafts()[k];
        let (spring, damper) = self.shaft_parts(k, x);
        match (self.touch[k], shaft.backlash > 0.0) {
            (_, false) => -(spring + damper),
            (Touch::Gap | Touch::Parting(_), _) => 0.0,
            (Touch::On(_), _) => -(spring + damper),
            (Touch::Limited(_), _) => -2.0 * spring,
        }
    }

    /// Power that the damper of a shaft turns into heat: what the shaft takes beyond what its spring stores.
    pub fn damper_power(&self, k: usize, x: &[f64]) -> f64 {
        let (spring, _) = self.shaft_parts(k, x);
        -(self.tau[self.system.elastic[k].port] + spring) * self.twist_rate(k)
    }

    /// Energy in the spring of a shaft.
    pub fn spring_energy(&self, k: usize, x: &[f64]) -> f64 {
        let shaft = &self.system.train.shafts()[k];
        let beyond = (self.twist(k, x).abs() - shaft.backlash / 2.0).max(0.0);
        0.5 * shaft.stiffness * beyond * beyond
    }

    /// Torque of the spring, and of the damper as if in contact. Without a kink within a mode: a contact goes on
    /// beyond its end, a gap beyond its contact.
    pub fn shaft_parts(&self, k: usize, x: &[f64]) -> (f64, f64) {
        let shaft = &self.system.train.shafts()[k];
        let half = shaft.backlash / 2.0;
        let beyond = match self.touch[k] {
            _ if half == 0.0 => self.twist(k, x),
            Touch::Gap => 0.0,
            Touch::On(side) | Touch::Limited(side) | Touch::Parting(side) => self.twist(k, x) - f64::from(side) * half,
        };
        (shaft.stiffness * beyond, shaft.damping * self.twist_rate(k))
    }

    pub fn twist(&self, k: usize, x: &[f64]) -> f64 {
        let e = &self.system.elastic[k];
        e.twist + dot(&e.row, &x[self.system.free..self.system.free + self.system.all()])
    }

    pub fn twist_rate(&self, k: usize) -> f64 {
        dot(&self.system.elastic[k].row, &self.speed)
    }

    /// What a backlash does at the state looked at.
    pub fn touch_now(&self, k: usize, x: &[f64]) -> Touch {
        let shaft = &self.system.train.shafts()[k];
        let twist = self.twist(k, x);
        let rate = self.twist_rate(k);
        let side = if twist >= 0.0 { 1 } else { -1 };
        let outside = twist.abs() - shaft.backlash / 2.0;
        let arriving = rate * f64::from(side) > 0.0;
        if outside < 0.0 || (outside == 0.0 && !arriving) {
            return Touch::Gap;
        }
        let along = f64::from(side);
        let (spring, damper) = (shaft.stiffness * outside * along, shaft.damping * rate);
        if (spring + damper) * along < 0.0 {
            Touch::Parting(side)
        } else if shaft.contact == Contact::Soft && damper * along > spring * along {
            Touch::Limited(side)
        } else {
            Touch::On(side)
        }
    }

    /// What a friction element exerts on its first member while it slides at `w` in direction `sign`, apart
    /// from its viscous part; infinite where it cannot slide that way.
    pub fn sliding(&self, f: usize, w: f64, sign: i8, peak: bool, t: f64) -> f64 {
        let friction = &self.system.frictions[f];
        let engaged = self.engagement(f, t);
        if let Some(blocks) = friction.blocks {
            return if sign == blocks { -f64::from(sign) * f64::INFINITY } else { 0.0 };
        }
        if friction.rigid {
            return if engaged >= 0.5 { -f64::from(sign) * f64::INFINITY } else { 0.0 };
        }
        if let (Rubs::Law(place), Some(laws)) = (friction.what, &self.system.laws) {
            return -f64::from(sign) * laws.torque(place);
        }
        if let Rubs::Variator(path) = friction.what {
            return self.path_friction(path, sign);
        }
        let factor = engaged.clamp(0.0, 1.0) * if peak { friction.peak } else { 1.0 };
        -f64::from(sign) * friction.torque.at(w.abs()) * factor
    }

    /// How far a friction element is engaged.
    pub fn engagement(&self, f: usize, t: f64) -> f64 {
        if let Some(level) = self.steadily_engaged(f) {
            return level;
        }
        let speed = |m: MemberId| self.member_speed(m);
        self.system.engaged(&self.system.frictions[f], |signal| signal.value(t, self.inside, &speed))
    }

    /// How fast that changes, 1/s.
    pub fn engagement_rate(&self, f: usize, t: f64) -> f64 {
        let Some(k) = self.system.frictions[f].engagement else { return 0.0 };
        let signal = &self.system.scenario.engagements[k].signal;
        let speed = |m: MemberId| self.member_speed(m);
        if signal.has_rate() {
            return signal.rate(t, self.inside, &speed);
        }
        // Where it goes from here.
        signal.value(self.inside, self.inside, &speed) - signal.value(t, self.inside, &speed)
    }

    /// Torque with which the friction elements of a group oppose its slip.
    pub fn capacity(&self, g: usize, peak: bool, t: f64) -> Capacity {
        let slip = self.group_slip(g);
        let mut c = Capacity { forward: 0.0, backward: 0.0 };
        for &f in &self.system.groups[g].frictions {
            let (_, factor) = self.system.frictions[f].group.expect("of this group");
            let w = factor * slip;
            let along = factor.signum() as i8;
            let forward = (factor * self.sliding(f, w, along, peak, t)).abs();
            c.forward += forward;
            let friction = &self.system.frictions[f];
            let tells_directions_apart = friction.blocks.is_some() || matches!(friction.what, Rubs::Variator(_));
            c.backward += match tells_directions_apart {
                false => forward,
                true => (factor * self.sliding(f, w, -along, peak, t)).abs(),
            };
        }
        c
    }

    /// Torques of the ports at a state in the present mode, those that hold groups excluded.
    pub fn load(&mut self, t: f64, x: &[f64]) {
        self.look(t, x);
        self.load_looked(t, x);
    }

    /// The same at the state looked at.
    fn load_looked(&mut self, t: f64, x: &[f64]) {
        let mut tau = std::mem::take(&mut self.tau);
        tau.iter_mut().for_each(|x| *x = 0.0);
        for (k, driver) in self.system.drivers.iter().enumerate() {
            if let Some(port) = driver.port {
                tau[port] = self.source_torque(k, t, x);
            }
            if let Some(i) = driver.prescribed {
                tau[self.system.port_of_prescribed + i] = self.acceleration[self.system.free + i];
            }
        }
        if !self.path_states.is_empty() {
            self.load_paths(t, &mut tau);
        }
        for k in 0..self.system.frictions.len() {
            let f = &self.system.frictions[k];
            if f.viscous != 0.0 {
                tau[f.port] += self.viscous_torque(k);
            }
            if f.group.is_some() {
                tau[f.port] += self.friction_torque(k, &self.mode, false, t);
            }
        }
        for (k, e) in self.system.elastic.iter().enumerate() {
            tau[e.port] = self.shaft_torque(k, x);
        }
        for j in 0..self.system.elements.len() {
            tau[self.system.elements[j].port] = self.constant_loss(j, &self.mode);
        }
        self.tau = tau;
    }

    /// Torque of a friction element in proportion to its speed.
    pub fn viscous_torque(&self, k: usize) -> f64 {
        let f = &self.system.frictions[k];
        -(f.viscous * dot(&f.row, &self.speed))
    }

    /// Torque of a sliding friction element on its first member, its viscous part excluded; 0 while it holds.
    pub fn friction_torque(&self, k: usize, mode: &Mode, peak: bool, t: f64) -> f64 {
        let f = &self.system.frictions[k];
        let Some((g, factor)) = f.group else { return 0.0 };
        match mode.slip[g] * factor.signum() as i8 {
            0 => 0.0,
            sign => {
                let slip = if f.torque.points().len() == 1 { 0.0 } else { self.group_slip(g) };
                let torque = self.sliding(k, factor * slip, sign, peak, t);
                if torque.is_finite() { torque } else { 0.0 }
            }
        }
    }

    /// The part of an element's loss that does not depend on its load.
    pub fn constant_loss(&self, j: usize, mode: &Mode) -> f64 {
        let sign = mode.element_slip(&self.system, j);
        if sign == 0 || self.plain {
            return 0.0;
        }
        let loss = self.loss(j);
        f64::from(sign)
            * match mode.side[j] {
                Side::Drive => loss.drive_torque,
                Side::Coast => loss.coast_torque,
            }
    }

    /// The map of a mode at the speeds looked at.
    pub fn map_of(&mut self, mode: &Mode) -> Option<Arc<Map>> {
        let varying: Vec<(usize, f64)> = (0..self.system.elements.len())
            .filter(|&j| self.system.elements[j].varies() && mode.element_slip(&self.system, j) != 0)
            .map(|j| (j, slope(self.loss(j), mode.side[j])))
            .collect();
        if varying.is_empty() {
            return self.maps.find(&self.system, mode);
        }
        let pattern = self.maps.pattern(&self.system, mode)?;
        compose(&self.system, mode, pattern, &varying).map(Arc::new)
    }

    /// Makes a mode the present one. False if its equations have no unique solution.
    pub fn enter(&mut self, mode: &Mode) -> bool {
        // Field by field: a derived `clone_from` would take new memory.
        self.mode.slip.clone_from(&mode.slip);
        self.mode.side.clone_from(&mode.side);
        self.leave_stretch();
        self.varying = (0..self.system.elements.len())
            .any(|j| self.system.elements[j].varies() && mode.element_slip(&self.system, j) != 0);
        self.map = self.map_of(mode);
        self.map.is_some()
    }

    /// Accelerations at a state in the present mode.
    pub fn solve(&mut self, t: f64, x: &[f64]) {
        self.look(t, x);
        if !self.load_steadily(t, x) {
            self.load_looked(t, x);
        } else if cfg!(debug_assertions) {
            let steadily = self.tau.clone();
            self.load_looked(t, x);
            let same = steadily.iter().zip(&self.tau).all(|(a, b)| a == b || a.is_nan() && b.is_nan());
            assert!(same, "at {t} s: {steadily:?}, not {:?}", self.tau);
        }
        if self.varying {
            let mode = self.mode.clone();
            self.map = self.map_of(&mode);
        }
        if self.system.laws.is_some() {
            self.agree(t, x);
        }
        match &self.map {
            Some(map) => {
                for i in 0..self.system.free {
                    self.acceleration[i] = map.unknown(i, &self.tau);
                }
                if let Some(still) = &self.still {
                    still.settle(&mut self.acceleration);
                }
            }
            None => self.acceleration[..self.system.free].iter_mut().for_each(|a| *a = f64::NAN),
        }
    }

    /// Torque that an element takes at its first gear, at the state solved last, and its round-off.
    pub fn element_torque(&self, j: usize) -> (f64, f64) {
        let Some(map) = &self.map else { return (f64::NAN, 0.0) };
        let a = self.system.elements[j].factors[0];
        let row = self.system.all() + j;
        (a * map.unknown(row, &self.tau), a.abs() * map.size(row, &self.tau))
    }

    /// Torques of all elements at their first gears, at the state solved last, and their round-off.
    pub fn element_torques(&self) -> Vec<(f64, f64)> {
        (0..self.system.elements.len()).map(|j| self.element_torque(j)).collect()
    }

    /// Loss of an element at the speeds looked at; where it follows a law, as the forces found last have it.
    pub fn loss(&self, j: usize) -> Loss {
        let e = &self.system.elements[j];
        let speed = if e.rows.len() == 1 { 0.0 } else { dot(&e.row, &self.speed).abs() };
        self.loss_at(j, speed)
    }

    /// The same where only tables take another speed.
    pub fn loss_at(&self, j: usize, speed: f64) -> Loss {
        let e = &self.system.elements[j];
        match (e.law, &self.system.laws) {
            (Some(mesh), Some(laws)) => laws.loss(mesh),
            _ => e.loss(speed),
        }
    }

    /// Brings forces and laws into agreement at the state looked at, in the present mode.
    pub fn agree(&mut self, t: f64, x: &[f64]) {
        let mode = self.mode.clone();
        self.agrees = false;
        for _ in 0..MOST_ROUNDS {
            let Some(map) = self.map.clone() else { return };
            let tau = std::mem::take(&mut self.tau);
            self.agrees = self.ask(&mode, &map, &tau);
            self.tau = tau;
            if self.agrees {
                return;
            }
            self.load(t, x);
            self.map = self.map_of(&mode);
        }
    }

    /// Asks the laws at the forces of a map. True if the answer is that of the last time, which then stands.
    fn ask(&mut self, mode: &Mode, map: &Map, tau: &[f64]) -> bool {
        let Some(mut laws) = self.system.laws.take() else { return true };
        for (speed, row) in laws.flow.speeds.iter_mut().zip(&self.system.speeds) {
            *speed = dot(row, &self.speed);
        }
        let (mut lost, mut size) = (0.0, 0.0);
        for (j, e) in self.system.elements.iter().enumerate() {
            let [link] = &e.links[..] else { continue };
            let [a, b] = e.factors;
            let row = self.system.all() + j;
            let torque = a * map.unknown(row, tau);
            let sign = mode.element_slip(&self.system, j);
            let side = mode.side[j];
            let own = match e.law {
                Some(mesh) if sign != 0 => {
                    size += a.abs() * map.size(row, tau);
                    slope(laws.loss(mesh), side) * torque
                }
                _ => 0.0,
            };
            lost += own.abs();
            let flow = &mut laws.flow.meshes[link.mesh.index()];
            // Of the second gear by the Willis equation: relative to the carrier a ω_p + b ω_q = 0.
            let other = b / a * (torque - own);
            flow.torques = [torque, other, -torque - other];
            let speed = dot(&e.row, &self.speed);
            flow.relative_speeds = [speed, a / b * speed].map(|w| w.abs().max(LEAST_SPEED));
            let driver = usize::from(side == Side::Coast);
            flow.driver = Some(driver);
            flow.potential_power = (flow.torques[driver] * flow.relative_speeds[driver]).abs();
        }
        let next = laws.physics.follow(&laws.flow);
        let torques: Vec<f64> = laws.places.iter().map(|p| next.drag(p)).collect();
        let mut change = 0.0;
        for e in &self.system.elements {
            if let Some(mesh) = e.law {
                let (new, old) = (next.lost(mesh), laws.step.lost(mesh));
                let differs = (new[0] - old[0]).abs().max((new[1] - old[1]).abs());
                change += differs * laws.flow.meshes[mesh.index()].torques[0].abs();
            }
        }
        for (new, old) in torques.iter().zip(&laws.torques) {
            change += (new - old).abs();
            lost += new;
        }
        let agrees = change <= AGREEMENT * lost + ROUND_OFF * size;
        if !agrees {
            laws.step = next;
            laws.torques = torques;
        }
        self.system.laws = Some(laws);
        agrees
    }
}
