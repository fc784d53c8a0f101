//! Changes of mode that were met before are not searched for again.
//!
//! The mode that followed on one before is looked at first. Its fused step says by how much each of its conditions holds.
//! Where all hold by far more than their round-off, and every state of the train has one motion, the search would find
//! the same mode; the step is solved as the search solves it, so that it ends in the same bits whether or not it was
//! foreseen. So it is with a mode that has no fused step, since teeth share in holding: its step is solved and looked at as
//! in the search. What is nearer to the edge is searched for.

use crate::dynamics::decision::Verdict;
use crate::dynamics::engine::Engine;
use crate::dynamics::fused::Exactly;

use super::FixedStep;
use super::groups::LEAST_UNBOUNDED;
use super::kept::Kept;

impl FixedStep {
    /// Whether modes may be foreseen at all: what breaks away at a peak holds or slides by what it did before, and a
    /// contact of a shaft by how it came there.
    pub(super) fn has_one_motion(engine: &Engine) -> bool {
        let s = &engine.system;
        engine.certificate == Some(true) && s.elastic.is_empty() && s.frictions.iter().all(|f| f.peak == 1.0)
    }

    /// Takes the step in the mode that followed on this one before, if that is certainly the one to be found; else
    /// nothing but the room for a fused step is touched.
    pub(super) fn foresee(&mut self, before: &Exactly) -> bool {
        let Some(&k) = self.followed.get(before) else { return false };
        let fused = &self.fused[k as usize];
        fused.settle(&self.v, &self.inputs, &self.varying, &mut self.base, &mut self.least);
        let settled = [&self.base[..], &self.least];
        if !fused.holds_by_far([&self.v, &self.inputs], &self.varying, settled, &mut self.ends) {
            return false;
        }
        let mode = fused.mode;
        // What is open, or locked, is so now as it was then.
        let differs = self.groups.iter().zip(&self.capacity).enumerate().any(|(g, (group, capacity))| {
            let is_open = *capacity == [0.0; 2] && group.elements.is_empty();
            let locks = |sign: i8| sign != 0 && capacity[usize::from(sign < 0)] >= LEAST_UNBOUNDED;
            let sign = sign(&mode, g);
            sign != 0 && is_open != (mode.idle >> g & 1 == 1) || !group.driven && locks(sign)
        });
        if differs {
            return false;
        }
        self.set_mode(&mode);
        self.solve_known();
        self.present = Some(k);
        true
    }

    /// Takes the step in the mode that was found after this one before, if it certainly is the one to be found; else the mode
    /// is the one there was.
    pub(super) fn suppose(&mut self, before: &Exactly) -> bool {
        let Some(mode) = self.supposed.get(before).copied() else { return false };
        self.keep();
        self.set_mode(&mode);
        self.solve_certain() || self.restore()
    }

    /// Decides the step. Where the mode found is so by far, the step is solved in it as one that supposes it is: both have
    /// the same numbers.
    #[cold]
    pub(super) fn decide_and_solve(&mut self) -> Result<(), Verdict> {
        self.decide()?;
        if self.is_certain {
            self.keep();
            self.is_decided = !(self.solve_certain() || self.restore());
        }
        Ok(())
    }

    /// Keeps the mode and the end of the step.
    fn keep(&mut self) {
        let Kept { sign, side, next, tau } = &mut self.kept;
        sign.clone_from(&self.sign);
        side.clone_from(&self.side);
        next.clone_from(&self.next);
        tau.clone_from(&self.tau);
    }

    /// Goes back to them; false.
    fn restore(&mut self) -> bool {
        let Kept { sign, side, next, tau } = &self.kept;
        self.sign.copy_from_slice(sign);
        self.side.copy_from_slice(side);
        self.next.copy_from_slice(next);
        self.tau.copy_from_slice(tau);
        false
    }

    fn set_mode(&mut self, mode: &Exactly) {
        for (g, _) in self.groups.iter().enumerate().filter(|(_, group)| !group.driven) {
            self.sign[g] = sign(mode, g);
        }
        self.set_coasting(mode.coast);
    }

    /// Remembers which mode followed on another: its fused step, or the mode alone.
    pub(super) fn remember(&mut self, before: Exactly) {
        if !self.is_certain || self.is_decided {
            return;
        }
        let has_still = self.last.is_some_and(|(_, map)| !self.maps[map as usize].still.is_empty());
        match self.present {
            Some(k) if !has_still => {
                self.followed.insert(before, k);
            }
            _ => {
                let mode = self.exactly();
                self.supposed.insert(before, mode);
            }
        }
    }
}

/// What a group does in a mode: 0 where it is held, else the sign of its slip.
fn sign(mode: &Exactly, g: usize) -> i8 {
    let is = |word: u64| word >> g & 1 == 1;
    if is(mode.held) { 0 } else { 2 * i8::from(is(mode.forward) || is(mode.idle)) - 1 }
}
