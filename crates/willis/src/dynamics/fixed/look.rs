//! The state reached, as the engine knows it: for rows, modes in words, and outputs.

use crate::dynamics::mode::Mode;

use super::FixedStep;

impl FixedStep {
    /// Brings the engine to the state and mode reached.
    pub(super) fn copy_to_engine(&mut self, x: &mut Vec<f64>) {
        let free = self.engine.system.free;
        self.audit();
        x.clear();
        x.extend_from_slice(&self.v[..free]);
        x.extend_from_slice(&self.rest);
        x.extend_from_slice(&self.energies);
        let t = self.time();
        self.engine.inside = t;
        self.engine.look(t, x);
        self.engine.touch.iter_mut().zip(&self.shafts).for_each(|(touch, shaft)| *touch = shaft.touch);
        let mut mode = std::mem::replace(&mut self.seen_mode, Mode { slip: vec![], side: vec![] });
        for (g, slip) in mode.slip.iter_mut().enumerate() {
            *slip = if self.groups[g].driven && self.slip[g] == 0.0 { 0 } else { self.sign[g] };
        }
        mode.side.copy_from_slice(&self.side);
        for k in 0..self.engine.engaged.len() {
            let engaged = self.engine.engagement(k, t);
            let is_rigid = self.engine.system.frictions[k].rigid;
            self.engine.engaged[k] = if is_rigid { engaged >= 0.5 } else { engaged > 0.0 };
        }
        self.engine.enter(&mode);
        self.seen_mode = mode;
    }

    fn exchange_mode(&mut self, other: &mut Self) {
        std::mem::swap(&mut self.sign, &mut other.sign);
        std::mem::swap(&mut self.side, &mut other.side);
        std::mem::swap(&mut self.slip, &mut other.slip);
        std::mem::swap(&mut self.shafts, &mut other.shafts);
    }

    /// Forces at the time reached, in the mode of the last step; before the first one, in that which it will choose.
    pub(super) fn look_at_forces(&mut self) {
        if self.seen_at == Some(self.count) {
            return;
        }
        let mut x = std::mem::take(&mut self.seen);
        if self.count == 0 {
            let mut ahead = self.clone();
            ahead.step();
            self.exchange_mode(&mut ahead);
            self.copy_to_engine(&mut x);
            self.exchange_mode(&mut ahead);
        } else {
            self.copy_to_engine(&mut x);
        }
        let t = self.time();
        self.engine.solve(t, &x);
        (self.seen, self.seen_at) = (x, Some(self.count));
    }
}
