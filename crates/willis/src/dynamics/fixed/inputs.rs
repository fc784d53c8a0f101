//! What enters a step: torques and end speeds of sources, what friction elements can hold, twists of shafts.

use crate::dynamics::mode::dot;
use crate::dynamics::source::{signals_of, source_torque};
use crate::train::{MemberId, Signal, SourceKind};

use super::groups::{LEAST_UNBOUNDED, UNBOUNDED};
use super::{FixedStep, jumps};

impl FixedStep {
    /// Sets what the signals that are level for a while are worth, and which inputs are not.
    #[cold]
    pub(in crate::dynamics) fn refresh(&mut self, t: f64) {
        let s = &self.engine.system;
        // A signal that has no break yet is as it was, unless another has taken its place.
        let afresh = self.until == f64::NEG_INFINITY;
        self.until = f64::INFINITY;
        for ((level, ends), signal) in self.level.iter_mut().zip(&mut self.level_ends).zip(s.signals()) {
            if afresh || t >= *ends {
                *ends = signal.next_break(t);
                *level = (!signal.moves(t)).then(|| signal.value(t, t, &|_| 0.0));
            }
            self.until = self.until.min(*ends);
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
            let level = self.governors[f].is_none_or(|at| self.level[at].is_some());
            let of_slip = self.flat[f].is_none() && !friction.rigid && friction.blocks.is_none();
            if friction.group.is_some() && (!level || of_slip) {
                self.varying.push(drivers + f);
            }
        }
        self.varying.extend((0..s.elastic.len()).map(|k| drivers + s.frictions.len() + k));
    }

    /// What enters a step: torque or end speed of each source, torque with which each friction element can
    /// oppose slip, twist of each shaft, one.
    #[inline]
    pub(in crate::dynamics) fn enters(&self, k: usize, middle: f64) -> f64 {
        let w = dot(self.row_of_input(k), &self.v);
        let sum = self.integral_of(k).map_or(0.0, |i| self.rest[i]);
        self.factors[k] * self.input_at(k, middle, w, sum)
    }

    /// The speed or slip that an input may follow, over the coordinates.
    #[inline]
    pub(in crate::dynamics) fn row_of_input(&self, k: usize) -> &[f64] {
        let s = &self.engine.system;
        match k.checked_sub(s.drivers.len()) {
            None => &s.speeds[s.drivers[k].member.index()],
            Some(f) => s.frictions.get(f).map_or(&[], |f| &f.row),
        }
    }

    /// Position of the integral of a controller.
    #[inline]
    pub(in crate::dynamics) fn integral_of(&self, k: usize) -> Option<usize> {
        let s = &self.engine.system;
        Some(s.all() + s.drivers.get(k)?.integral?)
    }

    /// Whether formulas of speeds, or twists of shafts, enter an input.
    pub(in crate::dynamics) fn needs_all_speeds(&self, k: usize) -> bool {
        let s = &self.engine.system;
        match k.checked_sub(s.drivers.len()) {
            None => signals_of(&s.scenario.sources[k].kind).any(|s| s.depends_on_speed()),
            Some(f) => match s.frictions.get(f) {
                Some(friction) => s.governor(friction).is_some_and(|(_, signal)| signal.depends_on_speed()),
                None => true,
            },
        }
    }

    /// An input, but for its factor, at the speed or slip that it follows.
    #[inline]
    pub(in crate::dynamics) fn input_at(&self, k: usize, middle: f64, w: f64, sum: f64) -> f64 {
        let s = &self.engine.system;
        let speed = |m: MemberId| dot(&s.speeds[m.index()], &self.v);
        let worth = |at: usize, signal: &Signal| self.level[at].unwrap_or_else(|| signal.value(middle, middle, &speed));
        let drivers = s.drivers.len();
        if k < drivers {
            let (kind, first) = (&s.scenario.sources[k].kind, self.signal_of[k]);
            if let SourceKind::Speed(signal) = kind {
                // At the end of the step.
                let value = || signal.value(middle + 0.5 * self.h, middle, &|_| 0.0);
                return self.level[first].unwrap_or_else(value);
            }
            let rate = |signal: &Signal| signal.rate(middle, middle, &speed);
            return source_torque(kind, w, sum, |at, signal| worth(first + at, signal), rate);
        }
        let f = k - drivers;
        let Some(friction) = s.frictions.get(f) else {
            let e = f - s.frictions.len();
            return if e < s.elastic.len() { self.twist(e) } else { 1.0 };
        };
        if friction.group.is_none() || friction.blocks.is_some() {
            return 0.0;
        }
        let engaged = s.engaged(friction, |signal| self.governors[f].map_or(0.0, |at| worth(at, signal)));
        match self.flat[f] {
            _ if friction.rigid => UNBOUNDED * f64::from(u8::from(engaged >= 0.5)),
            Some(torque) => torque * engaged.clamp(0.0, 1.0),
            None => friction.torque.at(w.abs()) * engaged.clamp(0.0, 1.0),
        }
    }

    /// Twist of a shaft.
    fn twist(&self, k: usize) -> f64 {
        let e = &self.engine.system.elastic[k];
        e.twist + dot(&e.row, &self.rest[..self.v.len()])
    }

    /// Torques of the ports in the middle of the step, friction and losses excluded, slips and capacities.
    pub(super) fn load(&mut self, middle: f64) {
        for k in 0..self.inputs.len() {
            self.inputs[k] = self.enters(k, middle);
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
        for (k, shaft) in self.shafts.iter_mut().enumerate() {
            shaft.begin(self.inputs[of_frictions + s.frictions.len() + k]);
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

    /// Counts prescribed speeds that jump, which takes an impact.
    pub(in crate::dynamics) fn count_jumps(&mut self, at: f64, middle: f64) {
        let s = &self.engine.system;
        for (driver, source) in s.drivers.iter().zip(&s.scenario.sources) {
            if let (Some(_), SourceKind::Speed(signal)) = (driver.prescribed, &source.kind)
                && at.is_finite()
            {
                let [before, after] = [middle - self.h, middle].map(|inside| signal.value(at, inside, &|_| 0.0));
                self.impacts += u64::from(jumps(before, after));
            }
        }
    }

    /// Whether what a run takes in follows from more than what a batch knows of it: twists of shafts, set points that
    /// follow speeds.
    pub(in crate::dynamics) fn needs_itself(&self) -> bool {
        let s = &self.engine.system;
        let follows =
            |kind: &SourceKind| matches!(kind, SourceKind::Controller { setpoint, .. } if setpoint.depends_on_speed());
        !s.elastic.is_empty() || s.scenario.sources.iter().any(|source| follows(&source.kind))
    }

    /// Whether an input that is not level depends on speeds, not on time alone.
    pub(in crate::dynamics) fn depends_on_speed(&self, k: usize) -> bool {
        let s = &self.engine.system;
        let drivers = s.drivers.len();
        let signal = match s.scenario.sources.get(k).map(|source| &source.kind) {
            Some(SourceKind::Torque(signal) | SourceKind::Speed(signal)) => signal,
            Some(_) => return true,
            None => match s.frictions.get(k - drivers) {
                Some(friction) if friction.rigid || self.flat[k - drivers].is_some() => match s.governor(friction) {
                    Some((_, signal)) => signal,
                    None => return false,
                },
                _ => return true,
            },
        };
        signal.depends_on_speed()
    }
}
