//! Modes beyond doubt, found by the maps of the run.
//!
//! The [decision](super::decision) of all contacts is exact, and takes as long as hundreds of evaluations. Where a
//! certificate says that every load has one motion, a mode in which every force and acceleration is on its right side is
//! that motion, however it was found. So some modes are tried, each made of what contradicted the one before; what is
//! near a limit, what the certificate or the maps do not cover, and what does not come to an end is left to the decision.
//!
//! Where holds share, one split of the torques that holds is enough: with one motion certain, all splits have its
//! accelerations. The one looked at is that of the maps, in which those that others hold bear nothing.

use super::element::Element;
use super::engine::Engine;
use super::mode::{Map, Mode, Side, dot};

/// How far, over the amounts of which it is the sum, something has to be from its limit to be beyond doubt: far more than
/// rounding does.
const CLEAR: f64 = 1e-9;

/// What a mode contradicts.
enum Contradiction {
    /// Nothing, and that is beyond doubt.
    None,
    /// Something: the mode is changed.
    Changed,
    /// It cannot be told.
    Doubt,
}

impl Element {
    /// Whether its loss is a constant part of its load.
    pub fn is_plain(&self) -> bool {
        self.law.is_none() && matches!(&self.rows[..], [row] if row.forward_torque == 0.0 && row.backward_torque == 0.0)
    }
}

impl Engine {
    /// The mode of a state, `start` but for the groups at rest in it and for the sides; none if there is any doubt.
    pub fn clear_mode(&mut self, t: f64, x: &[f64], start: &Mode) -> Option<Mode> {
        if !self.plain {
            return None;
        }
        let mut mode = start.clone();
        for _ in 0..4 + 2 * (mode.slip.len() + mode.side.len()) {
            if !self.enter(&mode) {
                return None;
            }
            self.solve(t, x);
            let map = self.map.clone()?;
            match self.contradiction(t, &map, start, &mut mode) {
                Contradiction::None => return Some(mode),
                Contradiction::Changed => {}
                Contradiction::Doubt => return None,
            }
        }
        None
    }

    /// Changes of a mode, the present one, what contradicts it first at the state solved last.
    fn contradiction(&self, t: f64, map: &Map, start: &Mode, mode: &mut Mode) -> Contradiction {
        let s = &self.system;
        let mut changed = false;
        for j in 0..s.elements.len() {
            let sign = mode.element_slip(s, j);
            let (torque, size) = self.element_torque(j);
            // Where no torque at all reaches a mesh, either side is the right one.
            if sign == 0 || size == 0.0 {
                continue;
            }
            if torque.is_nan() || torque.abs() <= CLEAR * size {
                return Contradiction::Doubt;
            }
            let side = if torque * f64::from(sign) > 0.0 { Side::Drive } else { Side::Coast };
            changed |= mode.side[j] != side;
            mode.side[j] = side;
        }
        if changed {
            return Contradiction::Changed;
        }
        // What is overloaded most breaks away.
        let (mut least, mut breaks) = (f64::INFINITY, (0, 0));
        for g in self.bearing(map) {
            for (sign, [spare, size]) in [1, -1].into_iter().zip(self.spare_of(g, t, map)) {
                let part = if spare == f64::INFINITY { spare } else { spare / size };
                if part.is_nan() {
                    return Contradiction::Doubt;
                }
                if part < least {
                    (least, breaks) = (part, (g, sign));
                }
            }
        }
        if least <= CLEAR {
            let (g, sign) = breaks;
            if least >= -CLEAR {
                return Contradiction::Doubt;
            }
            mode.slip[g] = sign;
            return Contradiction::Changed;
        }
        for (g, group) in s.groups.iter().enumerate().filter(|(g, _)| start.slip[*g] == 0) {
            if mode.slip[g] == 0 {
                // What is open is at rest by chance, and not held.
                let capacity = self.capacity(g, true, t);
                if map.carried[g] && group.elements.is_empty() && capacity.forward == 0.0 && capacity.backward == 0.0 {
                    return Contradiction::Doubt;
                }
                continue;
            }
            // What falls from a peak to what it rubs with needs more than one decision.
            if group.frictions.iter().any(|&f| s.frictions[f].peak != 1.0) {
                return Contradiction::Doubt;
            }
            let acceleration = dot(&group.row, &self.acceleration);
            let size: f64 = (0..s.free).map(|i| group.row[i].abs() * map.size(i, &self.tau)).sum();
            if acceleration.is_nan() || acceleration.abs() <= CLEAR * size {
                return Contradiction::Doubt;
            }
            if acceleration * f64::from(mode.slip[g]) < 0.0 {
                mode.slip[g] = 0;
                return Contradiction::Changed;
            }
        }
        Contradiction::None
    }

    /// Groups that are held in the present mode, and not by others.
    fn bearing<'a>(&'a self, map: &'a Map) -> impl Iterator<Item = usize> + 'a {
        let held = |&g: &usize| self.mode.slip[g] == 0 && !self.system.groups[g].driven && !map.carried[g];
        (0..self.system.groups.len()).filter(held)
    }

    /// What is left before a held group breaks away forward, and backward, and the amounts of which that is the sum.
    fn spare_of(&self, g: usize, t: f64, map: &Map) -> [[f64; 2]; 2] {
        let group = &self.system.groups[g];
        let (held, size) = (map.held(g, &self.tau), map.held_size(g, &self.tau));
        if group.frictions.is_empty() {
            // Teeth at rest hold at most what they would lose at their load if they slid.
            let (torque, of_torque) = self.element_torque(group.elements[0]);
            let loss = self.loss(group.elements[0]);
            let [a, b] = [loss.drive * torque, loss.coast * torque];
            let size = size + loss.drive.abs().max(loss.coast.abs()) * of_torque;
            return [[a.max(b) - held, size], [held - a.min(b), size]];
        }
        let capacity = self.capacity(g, true, t);
        let force = group.lead.1 * held;
        [[capacity.forward + force, capacity.forward + size], [capacity.backward - force, capacity.backward + size]]
    }

    /// The least of what is left before something that is held breaks away, at the state solved last; none if there is
    /// any doubt that all of it holds.
    pub fn clear_spare(&self, t: f64) -> Option<f64> {
        let map = self.map.as_deref().filter(|_| self.plain)?;
        let mut least = f64::INFINITY;
        for [spare, size] in self.bearing(map).flat_map(|g| self.spare_of(g, t, map)) {
            if spare.is_nan() || spare <= CLEAR * size && spare != f64::INFINITY {
                return None;
            }
            least = least.min(spare);
        }
        Some(least)
    }
}
