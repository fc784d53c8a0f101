//! What is watched within a mode, and by how much it still holds.

use crate::train::Contact;

use super::engine::{Engine, Touch};
use super::mode::{Map, Mode, Side, dot_size};
use super::stretch::Watch;

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

    /// What changes its sign where it breaks.
    pub fn spare(&self) -> f64 {
        self.value + self.noise
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

    /// What is watched in the present mode, in the order of its margins. What holds a group alone is what would be lost if it
    /// slid; teeth, and what shares, are looked at together.
    pub fn watched(&self) -> Vec<Watch> {
        let s = &self.system;
        let rests = |g: usize| self.mode.slip[g] == 0 && !s.groups[g].driven;
        let with_teeth = (0..s.groups.len()).any(|g| rests(g) && !s.groups[g].elements.is_empty());
        let together = with_teeth || self.map.as_ref().is_some_and(|map| map.is_redundant());
        let group = |g: usize| match self.mode.slip[g] {
            0 => (rests(g) && !together).then_some(Watch::Hold(g, 0)),
            _ => Some(Watch::Slip(g)),
        };
        let engages = |k: &usize| {
            let f = &s.frictions[*k];
            f.group.is_some() && f.engagement.is_some_and(|e| s.scenario.engagements[e].signal.crosses_unannounced())
        };
        let watches = (0..s.groups.len())
            .filter_map(group)
            .chain(together.then_some(Watch::Rest))
            .chain((0..s.elements.len()).filter(|&j| self.mode.element_slip(s, j) != 0).map(Watch::Side))
            .chain((0..s.elastic.len()).filter(|&k| s.train.shafts()[k].backlash > 0.0).map(Watch::Touch))
            .chain((0..s.paths.len()).filter(|&k| s.paths[k].has_ends()).map(Watch::End))
            .chain((0..s.frictions.len()).filter(engages).map(Watch::Engage));
        watches.collect()
    }

    /// Margins of the present mode at a state.
    pub fn margins(&mut self, t: f64, x: &[f64], out: &mut Vec<Margin>) {
        if !self.margins_affinely(t, x, out) {
            self.solve(t, x);
            self.margins_by_ports(t, x, out);
        } else if cfg!(debug_assertions) {
            self.assert_by_ports(t, x, out);
        }
    }

    /// The ports tell the same margins, but for rounding. Leaves no trace, so that a run is the same without assertions.
    fn assert_by_ports(&mut self, t: f64, x: &[f64], margins: &[Margin]) {
        let kept = (self.tau.clone(), self.acceleration.clone());
        let mut by_ports = vec![];
        self.solve(t, x);
        self.margins_by_ports(t, x, &mut by_ports);
        (self.tau, self.acceleration) = kept;
        // What the integrator leaves open is no rounding.
        let rounding = |m: &Margin| if let Watch::Slip(_) = m.watch { m.noise } else { m.noise / self.slack };
        let near = |(a, b): (&Margin, &Margin)| {
            a.watch == b.watch && (a.value - b.value).abs() <= 2.0 * (rounding(a) + rounding(b))
        };
        let alike = margins.len() == by_ports.len() && margins.iter().zip(&by_ports).all(near);
        assert!(alike, "at {t} s: {margins:?}, not {by_ports:?}");
    }

    /// The same at the state whose rate was asked for last.
    pub fn margins_after_rate(&mut self, t: f64, x: &[f64], out: &mut Vec<Margin>) {
        if self.rates_by_ports() {
            self.margins_by_ports(t, x, out);
        } else {
            self.margins(t, x, out);
        }
    }

    /// Margins at the state solved last.
    fn margins_by_ports(&mut self, t: f64, x: &[f64], out: &mut Vec<Margin>) {
        out.clear();
        let Some(map) = self.map.clone() else { return };
        let watches = match self.steady.as_mut().map(|steady| std::mem::take(&mut steady.watches)) {
            Some(watches) => watches,
            None => self.watched(),
        };
        for &watch in &watches {
            match watch {
                Watch::Slip(g) => {
                    let noise = NOISE * 1e-3 * dot_size(&self.system.groups[g].row, &self.speed);
                    let value = f64::from(self.mode.slip[g]) * self.group_slip(g);
                    out.push(Margin { watch, value, noise });
                }
                Watch::Hold(g, _) => self.hold_margins(g, t, &map, out),
                Watch::Rest => {
                    // What slips is as many times its bound of rounding as what slips elsewhere is of its own.
                    let value = self.clear_spare(t).unwrap_or_else(|| self.spare(t));
                    out.push(Margin { watch, value, noise: self.slack * NOISE / (16.0 * f64::EPSILON) });
                }
                Watch::Side(j) => {
                    let (torque, size) = self.element_torque(j);
                    let (value, noise) = self.side_margin(j, &self.mode, torque, size);
                    out.push(Margin { watch, value, noise: self.slack * noise });
                }
                Watch::Touch(k) => out.push(Margin { watch, value: self.touch_margin(k, x), noise: 0.0 }),
                Watch::End(k) => {
                    let (value, noise) = self.path_end_margin(k, t, x);
                    out.push(Margin { watch, value, noise });
                }
                Watch::Engage(k) => {
                    let threshold = if self.system.frictions[k].rigid { 0.5 } else { 0.0 };
                    let value = self.engagement(k, t) - threshold;
                    out.push(Margin { watch, value: if self.engaged[k] { value } else { -value }, noise: NOISE });
                }
            }
        }
        if let Some(steady) = &mut self.steady {
            steady.watches = watches;
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

    /// Margins of a held group of friction elements alone against breaking away forward and backward.
    fn hold_margins(&mut self, g: usize, t: f64, map: &Map, out: &mut Vec<Margin>) {
        let capacity = self.capacity(g, true, t);
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
    }
}
