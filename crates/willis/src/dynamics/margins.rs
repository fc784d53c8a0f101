//! What is watched within a mode, and by how much it still holds.

use crate::train::Contact;

use super::engine::{Engine, Touch};
use super::mode::{Map, Mode, Side};

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

/// Round-off of a sum, relative to the sum of amounts.
pub(super) const NOISE: f64 = 1e-12;

impl Engine {
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
