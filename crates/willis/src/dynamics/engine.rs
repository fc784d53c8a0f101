//! Torques of the ports at a state, and what follows from them in a mode.

use std::sync::Arc;

use crate::train::{Contact, MemberId, SourceKind};

use super::integrator::Smooth;
use super::mode::{Map, Maps, Mode, Side, compose, dot, slope};
use super::output::Shows;
use super::report::EnergyLossKind;
use super::system::{Rubs, System, source_torque};

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

/// What is watched within a mode: it changes where a margin becomes negative.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Watch {
    /// A sliding group comes to rest.
    Slip(usize),
    /// A held group breaks away, forward or backward.
    Hold(usize, i8),
    /// Held groups, held several times over, break away.
    HoldAll,
    /// The drive of an element reverses.
    Side(usize),
    /// A backlash or its damper changes.
    Touch(usize),
    /// A shift element begins or ceases to be engaged.
    Engage(usize),
}

/// A margin and the size of its round-off.
#[derive(Clone, Copy, Debug)]
pub(super) struct Margin {
    pub watch: Watch,
    pub value: f64,
    pub noise: f64,
}

impl Margin {
    pub fn is_broken(&self) -> bool {
        self.value < -self.noise
    }
}

/// Torque with which a group can oppose its slip, forward and backward, in units of its slip.
#[derive(Clone, Copy, Debug)]
pub(super) struct Capacity {
    pub forward: f64,
    pub backward: f64,
}

/// Round-off of a sum, relative to the sum of amounts.
pub(super) const NOISE: f64 = 1e-12;

/// Size below which a speed, rad/s, or an angle, rad, counts as small at the start of a run.
const LEAST_SCALE: f64 = 1e-3;

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
    /// Sides of the elements of a group as they would be if it broke away.
    pub away: Vec<[Vec<Side>; 2]>,
    /// Whether one solution is certain in every state.
    pub certified: bool,
    /// Whether forces and laws agreed at the state solved last.
    pub agrees: bool,
    /// Whether energies are counted.
    pub counts: bool,
    /// Sizes of the states, against which errors are measured where a state is small.
    pub scales: Vec<f64>,
    /// Choices in which there were too many combinations to search for other solutions.
    pub unsearched: usize,
    /// Size of the energies, J, likewise.
    pub energy_scale: f64,
    /// What can be read, in the order of the columns.
    pub shows: Vec<Shows>,
    /// Room for port torques.
    pub spare: Vec<f64>,
    /// By how many times its round-off a force has to be beyond its limit before that counts as an event: what
    /// the integrator leaves open.
    pub slack: f64,
}

impl Engine {
    pub fn new(system: System) -> Self {
        let (groups, elements) = (system.groups.len(), system.elements.len());
        let mode = Mode { slip: vec![0; groups], side: vec![Side::Drive; elements] };
        let away = system.groups.iter().map(|g| [0, 1].map(|_| vec![Side::Drive; g.elements.len()])).collect();
        Self {
            maps: Maps::default(),
            mode,
            touch: vec![Touch::Gap; system.elastic.len()],
            engaged: vec![false; system.frictions.len()],
            inside: 0.0,
            map: None,
            varying: false,
            speed: vec![0.0; system.all()],
            acceleration: vec![0.0; system.all()],
            tau: vec![0.0; system.ports],
            away,
            scales: vec![LEAST_SCALE; system.free + system.all() + system.integrals],
            energy_scale: LEAST_ENERGY,
            unsearched: 0,
            spare: vec![0.0; system.ports],
            shows: Shows::all(&system),
            agrees: true,
            slack: 1.0,
            counts: true,
            certified: system.rolling_is_unique() == Some(true) && system.sticking_is_unique() == Some(true),
            system,
        }
    }

    /// Remembers how large the states and the energies become.
    pub fn rescale(&mut self, x: &[f64]) {
        self.energy_scale = x[self.scales.len()..].iter().fold(self.energy_scale, |m, e| m.max(e.abs()));
        for (scale, x) in self.scales.iter_mut().zip(x) {
            *scale = scale.max(0.1 * x.abs());
        }
    }

    /// Position of the controllers' integrals.
    pub fn integrals(&self) -> usize {
        self.system.free + self.system.all()
    }

    pub fn group_slip(&self, g: usize) -> f64 {
        dot(&self.system.groups[g].row, &self.speed)
    }

    pub fn group_acceleration(&self, g: usize) -> f64 {
        dot(&self.system.groups[g].row, &self.acceleration)
    }

    pub fn member_speed(&self, m: MemberId) -> f64 {
        dot(&self.system.speeds[m.index()], &self.speed)
    }

    /// Takes over the speeds of a state.
    pub fn look(&mut self, t: f64, x: &[f64]) {
        let free = self.system.free;
        self.speed[..free].copy_from_slice(&x[..free]);
        for (k, driver) in self.system.drivers.iter().enumerate() {
            if let (Some(i), SourceKind::Speed(signal)) = (driver.prescribed, &self.system.scenario.sources[k].kind) {
                self.speed[free + i] = signal.value(t, self.inside, &|_| 0.0);
                self.acceleration[free + i] = signal.rate(t, self.inside, &|_| 0.0);
            }
        }
    }

    /// Torque of a source at the state looked at, without what its derivative part adds through the
    /// acceleration.
    pub fn source_torque(&self, k: usize, t: f64, x: &[f64]) -> f64 {
        let driver = &self.system.drivers[k];
        let speed = |m: MemberId| self.member_speed(m);
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
        let factor = engaged.clamp(0.0, 1.0) * if peak { friction.peak } else { 1.0 };
        -f64::from(sign) * friction.torque.at(w.abs()) * factor
    }

    /// How far a friction element is engaged.
    pub fn engagement(&self, f: usize, t: f64) -> f64 {
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
            c.forward += (factor * self.sliding(f, w, along, peak, t)).abs();
            c.backward += (factor * self.sliding(f, w, -along, peak, t)).abs();
        }
        c
    }

    /// Torques of the ports at a state in the present mode, those that hold groups excluded.
    pub fn load(&mut self, t: f64, x: &[f64]) {
        self.look(t, x);
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
        for k in 0..self.system.frictions.len() {
            let f = &self.system.frictions[k];
            if f.viscous != 0.0 {
                tau[f.port] -= f.viscous * dot(&f.row, &self.speed);
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

    /// Torque of a sliding friction element on its first member, its viscous part excluded; 0 while it holds.
    pub fn friction_torque(&self, k: usize, mode: &Mode, peak: bool, t: f64) -> f64 {
        let f = &self.system.frictions[k];
        let Some((g, factor)) = f.group else { return 0.0 };
        match mode.slip[g] * factor.signum() as i8 {
            0 => 0.0,
            sign => {
                let torque = self.sliding(k, factor * self.group_slip(g), sign, peak, t);
                if torque.is_finite() { torque } else { 0.0 }
            }
        }
    }

    /// The part of an element's loss that does not depend on its load.
    fn constant_loss(&self, j: usize, mode: &Mode) -> f64 {
        let sign = mode.element_slip(&self.system, j);
        if sign == 0 {
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
        self.varying = (0..self.system.elements.len())
            .any(|j| self.system.elements[j].varies() && mode.element_slip(&self.system, j) != 0);
        self.map = self.map_of(mode);
        self.map.is_some()
    }

    /// Accelerations at a state in the present mode.
    pub fn solve(&mut self, t: f64, x: &[f64]) {
        self.load(t, x);
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

    /// How much the present side of an element is the right one: positive if it is.
    fn side_margin(&self, j: usize, mode: &Mode, torque: f64, size: f64) -> (f64, f64) {
        let sign = f64::from(mode.element_slip(&self.system, j));
        let loss = self.loss(j);
        let spread = loss.drive - loss.coast;
        let extra = loss.drive_torque - loss.coast_torque;
        let value = sign * spread * torque + extra;
        let noise = NOISE * (spread * size + loss.drive_torque + loss.coast_torque);
        match mode.side[j] {
            Side::Drive => (value, noise),
            Side::Coast => (-value, noise),
        }
    }

    /// Whether an element, at the state solved last, carries no more than what the integrator leaves open.
    pub fn is_between_sides(&self, j: usize) -> bool {
        let (torque, size) = self.element_torque(j);
        let (value, noise) = self.side_margin(j, &self.mode, torque, size);
        value.abs() <= 1e3 * self.slack * noise
    }

    /// Torques of all elements at their first gears, at the state solved last, and their round-off.
    pub fn element_torques(&self) -> Vec<(f64, f64)> {
        (0..self.system.elements.len()).map(|j| self.element_torque(j)).collect()
    }

    /// Turns the sides that disagree with these torques, at the speeds looked at last.
    pub fn turn_sides(&self, mode: &mut Mode, torques: &[(f64, f64)]) {
        for (j, &(torque, size)) in torques.iter().enumerate() {
            if mode.element_slip(&self.system, j) != 0 {
                let (value, noise) = self.side_margin(j, mode, torque, size);
                if value < -noise {
                    mode.side[j] = mode.side[j].other();
                }
            }
        }
    }

    /// Margins of the present mode at a state, after [`Engine::solve`] there.
    pub fn margins(&mut self, t: f64, x: &[f64], out: &mut Vec<Margin>) {
        out.clear();
        let Some(map) = self.map.clone() else { return };
        for g in 0..self.system.groups.len() {
            let slip = self.group_slip(g);
            match self.mode.slip[g] {
                0 if self.system.groups[g].driven => {}
                0 if map.is_redundant() => {}
                0 => self.hold_margins(g, t, x, &map, out),
                sign => {
                    let noise = NOISE
                        * 1e-3
                        * self.system.groups[g].row.iter().zip(&self.speed).map(|(a, b)| (a * b).abs()).sum::<f64>();
                    out.push(Margin { watch: Watch::Slip(g), value: f64::from(sign) * slip, noise });
                }
            }
        }
        if map.is_redundant() {
            out.push(Margin { watch: Watch::HoldAll, value: if self.holds(t, x) { 1.0 } else { -1.0 }, noise: 0.0 });
        }
        for j in 0..self.system.elements.len() {
            if self.mode.element_slip(&self.system, j) != 0 {
                let (torque, size) = self.element_torque(j);
                let (value, noise) = self.side_margin(j, &self.mode, torque, size);
                out.push(Margin { watch: Watch::Side(j), value, noise: self.slack * noise });
            }
        }
        for k in 0..self.system.elastic.len() {
            let shaft = &self.system.train.shafts()[k];
            if shaft.backlash > 0.0 {
                out.push(Margin { watch: Watch::Touch(k), value: self.touch_margin(k, x), noise: 0.0 });
            }
        }
        for k in 0..self.system.frictions.len() {
            let f = &self.system.frictions[k];
            if let Some(e) = f.engagement
                && f.group.is_some()
                && self.system.scenario.engagements[e].signal.crosses_unannounced()
            {
                let threshold = if f.rigid { 0.5 } else { 0.0 };
                let value = self.engagement(k, t) - threshold;
                let value = if self.engaged[k] { value } else { -value };
                out.push(Margin { watch: Watch::Engage(k), value, noise: NOISE });
            }
        }
    }

    fn touch_margin(&self, k: usize, x: &[f64]) -> f64 {
        let shaft = &self.system.train.shafts()[k];
        let twist = self.twist(k, x);
        let half = shaft.backlash / 2.0;
        let (spring, damper) = self.shaft_parts(k, x);
        match self.touch[k] {
            Touch::Gap => half - twist.abs(),
            Touch::On(side) => {
                let s = f64::from(side);
                let limit = if shaft.contact == Contact::Soft { (spring - damper) * s } else { f64::INFINITY };
                (twist * s - half).min((spring + damper) * s).min(limit)
            }
            Touch::Limited(side) => {
                let s = f64::from(side);
                (twist * s - half).min((damper - spring) * s)
            }
            Touch::Parting(side) => {
                let s = f64::from(side);
                (twist * s - half).min(-(spring + damper) * s)
            }
        }
    }

    /// Margins of a held group against breaking away forward and backward.
    fn hold_margins(&mut self, g: usize, t: f64, x: &[f64], map: &Map, out: &mut Vec<Margin>) {
        let capacity = self.capacity(g, true, t);
        if self.system.groups[g].elements.is_empty() {
            let (_, lead) = self.system.groups[g].lead;
            // What holds must not exceed what can be held against slip in either direction.
            let force = lead * map.held(g, &self.tau);
            let noise = NOISE * (map.held_size(g, &self.tau) + 1e-300);
            for (sign, most) in [(1, capacity.forward), (-1, capacity.backward)] {
                if most.is_finite() {
                    let value = most + f64::from(sign) * force;
                    let noise = self.slack * (noise + NOISE * most);
                    out.push(Margin { watch: Watch::Hold(g, sign), value, noise });
                }
            }
            return;
        }
        for (sign, most) in [(1, capacity.forward), (-1, capacity.backward)] {
            if most.is_finite() {
                let (value, noise) = self.breakaway(g, sign, t, x);
                out.push(Margin { watch: Watch::Hold(g, sign), value, noise: self.slack * noise });
            }
        }
    }

    /// Slip acceleration, against its direction, that a held group would have if it slid: positive if
    /// friction holds it. The sides of its elements are those that agree.
    fn breakaway(&mut self, g: usize, sign: i8, t: f64, x: &[f64]) -> (f64, f64) {
        let _ = x;
        let mut mode = self.mode.clone();
        mode.slip[g] = sign;
        let members = self.system.groups[g].elements.clone();
        let direction = usize::from(sign < 0);
        for (k, &j) in members.iter().enumerate() {
            mode.side[j] = self.away[g][direction][k];
        }
        let mut tau = std::mem::take(&mut self.spare);
        let mut answer = (f64::NAN, 0.0);
        let held = self.system.laws.as_ref().map(|laws| laws.found());
        // First from the sides of the last time, flipping what disagrees; then all.
        let tries = 6 + (1usize << members.len().min(10));
        for attempt in 0..tries {
            if attempt >= 6 {
                for (k, &j) in members.iter().enumerate() {
                    mode.side[j] = if (attempt - 6) >> k & 1 == 0 { Side::Drive } else { Side::Coast };
                }
            }
            tau.copy_from_slice(&self.tau);
            for &f in &self.system.groups[g].frictions {
                tau[self.system.frictions[f].port] += self.friction_torque(f, &mode, true, t);
            }
            for &j in &members {
                tau[self.system.elements[j].port] = self.constant_loss(j, &mode);
            }
            let Some(map) = self.agreed_map(&mode, t, &mut tau) else { continue };
            let group = &self.system.groups[g];
            let mut value = 0.0;
            let mut size = 0.0;
            for i in 0..self.system.free {
                value += group.row[i] * map.unknown(i, &tau);
                size += group.row[i].abs() * map.size(i, &tau);
            }
            for i in self.system.free..self.system.all() {
                value += group.row[i] * self.acceleration[i];
            }
            let mut agrees = true;
            for &j in &members {
                let a = self.system.elements[j].factors[0];
                let row = self.system.all() + j;
                let (torque, amount) = (a * map.unknown(row, &tau), a.abs() * map.size(row, &tau));
                let (margin, noise) = self.side_margin(j, &mode, torque, amount);
                if margin < -noise {
                    agrees = false;
                    if attempt < 5 {
                        mode.side[j] = mode.side[j].other();
                    }
                }
            }
            if agrees || answer.0.is_nan() {
                answer = (-f64::from(sign) * value, NOISE * size);
            }
            if agrees {
                for (k, &j) in members.iter().enumerate() {
                    self.away[g][direction][k] = mode.side[j];
                }
                break;
            }
        }
        self.spare = tau;
        if let (Some(laws), Some(held)) = (&mut self.system.laws, held) {
            laws.recall(held);
        }
        answer
    }
}

impl Smooth for Engine {
    fn states(&self) -> usize {
        self.integrals() + self.system.integrals
    }

    fn quadratures(&self) -> usize {
        self.energies()
    }

    fn rate(&mut self, t: f64, x: &[f64], rate: &mut [f64]) {
        self.solve(t, x);
        if !self.agrees {
            rate.fill(f64::NAN);
            return;
        }
        let (free, all) = (self.system.free, self.system.all());
        rate[..free].copy_from_slice(&self.acceleration[..free]);
        rate[free..free + all].copy_from_slice(&self.speed);
        let integrals = self.integrals();
        for (k, driver) in self.system.drivers.iter().enumerate() {
            if let (Some(i), SourceKind::Controller { setpoint, .. }) =
                (driver.integral, &self.system.scenario.sources[k].kind)
            {
                let set = setpoint.value(t, self.inside, &|m| self.member_speed(m));
                rate[integrals + i] = set - self.member_speed(driver.member);
            }
        }
        let states = self.states();
        self.powers(t, x, &mut rate[states..]);
    }

    fn scale(&self, state: usize) -> f64 {
        self.scales.get(state).copied().unwrap_or(self.energy_scale)
    }
}

impl Engine {
    /// What a friction element is; nothing of its own where it belongs to a source.
    pub fn kind(&self, f: usize) -> Option<EnergyLossKind> {
        match self.system.frictions[f].what {
            Rubs::Drag(_) => Some(EnergyLossKind::Drag),
            Rubs::Shift(_) => Some(EnergyLossKind::ShiftElement),
            Rubs::Rolling(_) => None,
            Rubs::Law(place) => self.system.laws.as_ref().map(|laws| laws.places[place].loss_kind()),
        }
    }
}
