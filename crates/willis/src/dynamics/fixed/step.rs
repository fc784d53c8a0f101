//! One step: on in the present mode if that still holds, else the mode is settled anew.

use std::sync::Arc;

use crate::dynamics::fused::{Exactly, Fused};
use crate::dynamics::mode::{Side, dot};
use crate::train::{MemberId, SourceKind};

use super::FixedStep;
use super::groups::UNBOUNDED;
use super::shafts::word;

impl FixedStep {
    /// Takes steps; none after a [verdict](Self::verdict).
    pub fn run(&mut self, steps: u64) {
        self.arch.dispatch(Steps { of: self, steps });
    }

    /// The mode in every detail.
    pub(super) fn exactly(&self) -> Exactly {
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
        key.touch = word(&self.shafts);
        key
    }

    /// The fused step of a mode with this map, made if it was not met before.
    pub(super) fn fused_of(&mut self, map: u32, mode: Exactly) -> u32 {
        if let Some(&k) = self.by_exact_key.get(&mode) {
            return k;
        }
        let (s, map) = (&self.engine.system, &self.maps[map as usize]);
        let fused = Fused::new(s, &self.groups, &self.teeth, &self.shafts, map, &mode, self.h);
        self.fused.push(Arc::new(fused));
        let k = self.fused.len() as u32 - 1;
        self.by_exact_key.insert(mode, k);
        k
    }

    /// Makes the fused step of the mode just settled the present one.
    fn fuse(&mut self) {
        self.present = None;
        let Some((_, map_of)) = self.last else { return };
        let map = &self.maps[map_of as usize];
        let held_shares = self.groups.iter().zip(&self.sign).any(|(group, sign)| *sign == 0 && group.shares);
        if self.is_decided || held_shares && !map.is_redundant {
            return;
        }
        for (j, row) in &map.still {
            let torque = dot(row, &self.tau);
            self.side[usize::from(*j)] = if torque >= 0.0 { Side::Drive } else { Side::Coast };
        }
        let key = self.exactly();
        let k = self.fused_of(map_of, key);
        let fused = &self.fused[k as usize];
        fused.settle(&self.v, &self.inputs, &self.varying, &mut self.base, &mut self.least);
        self.ends.resize(fused.rows, 0.0);
        self.present = Some(k);
    }

    /// Takes the step in the mode of the last one; false, and nothing done, if that does not go on.
    #[inline(always)]
    fn glide(&mut self, middle: f64) -> bool {
        let Some(k) = self.present else { return false };
        let s = &self.engine.system;
        let (drivers, frictions) = (s.drivers.len(), s.frictions.len());
        for &k in &self.varying {
            let u = self.enters(k, middle);
            // What opens, closes or locks is more than a change of torque.
            if k >= drivers && k < drivers + frictions {
                let was = self.inputs[k];
                if (u == 0.0) != (was == 0.0) || (u == UNBOUNDED) != (was == UNBOUNDED) {
                    return false;
                }
            }
            self.inputs[k] = u;
        }
        let fused = &self.fused[k as usize];
        let settled = [&self.base[..], &self.least];
        if !fused.ends([&self.v, &self.inputs], &self.varying, settled, &mut self.ends) {
            return false;
        }
        self.next[..s.free].iter_mut().zip(&self.ends).for_each(|(next, end)| *next = *end);
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
    pub(in crate::dynamics) fn middle(&self) -> f64 {
        self.time() + 0.5 * self.h
    }

    /// Whether what was level is no longer.
    pub(in crate::dynamics) fn is_over(&self, middle: f64) -> bool {
        middle >= self.until || self.until == f64::NEG_INFINITY
    }

    /// Whether the speeds at the end of the step may be those of a motion.
    #[inline(always)]
    fn stays_bounded(&mut self) -> bool {
        let square = dot(&self.next, &self.next);
        square <= self.bound || self.may_grow(square)
    }

    /// Finds the mode of the step and its end; false if the run ends before it.
    #[cold]
    #[inline(never)]
    fn settle_anew(&mut self, middle: f64) -> bool {
        self.settled += 1;
        self.end_trail();
        self.load(middle);
        if !self.enters_finite(middle) {
            return false;
        }
        (self.is_decided, self.present) = (false, None);
        let before = self.exactly();
        let foreseen = self.is_certain && self.foresee(&before);
        let is_known = foreseen || self.is_certain && self.suppose(&before);
        if !is_known
            && !self.settle()
            && let Err(verdict) = self.decide_and_solve()
        {
            self.stop_without_motion(verdict);
            return false;
        }
        if !self.stays_bounded() {
            return false;
        }
        if !self.energies.is_empty() {
            self.count_energies();
        }
        if !foreseen {
            self.fuse();
            self.remember(before);
        }
        true
    }

    /// Takes one step; none after a [verdict](Self::verdict).
    pub fn step(&mut self) {
        self.run(1);
    }

    #[inline(always)]
    fn take_step(&mut self) {
        if self.verdict.is_some() {
            return;
        }
        let middle = self.middle();
        if self.is_over(middle) {
            self.end_trail();
            let ended = self.until;
            self.refresh(middle);
            self.count_jumps(ended, middle);
            self.present = None;
        }
        if !self.glide(middle) {
            if !self.settle_anew(middle) {
                return;
            }
        } else if !self.stays_bounded() {
            return;
        } else if !self.energies.is_empty() {
            self.leave();
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
}

struct Steps<'a> {
    of: &'a mut FixedStep,
    steps: u64,
}

impl pulp::WithSimd for Steps<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        for _ in 0..self.steps {
            self.of.take_step();
        }
    }
}
