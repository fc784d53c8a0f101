//! What acts alike at all states of a stretch, found once for it.

use crate::train::SourceKind;

use super::element::Element;
use super::engine::Engine;
use super::stretch::{Affine, Steady};
use super::system::Rubs;

impl Element {
    /// Whether its constant loss is the same at every speed and load.
    fn loses_alike(&self) -> bool {
        self.law.is_none() && self.rows.len() == 1
    }
}

impl Engine {
    /// From now on the present mode and piece are those of all states, until a mode is entered; `segment` is the time at
    /// which the piece ends.
    pub fn settle_down(&mut self, segment: f64) {
        /// Stretches that are kept.
        const MOST: usize = 32;
        self.leave_stretch();
        if let Some(k) = self.stretches.iter().position(|of| of.segment == segment && of.mode == self.mode) {
            let mut steady = self.stretches.swap_remove(k);
            steady.inside = self.inside;
            self.steady = Some(steady);
            return;
        }
        if self.stretches.len() >= MOST {
            self.stretches.clear();
        }
        // Laws and variators move with everything.
        if self.map.is_none() || self.system.laws.is_some() || !self.system.paths.is_empty() {
            return;
        }
        let s = &self.system;
        let inside = self.inside;
        let mut tau = vec![0.0; s.ports];
        let (mut sources, mut viscous, mut sliding, mut elements) = (vec![], vec![], vec![], vec![]);
        for (k, driver) in s.drivers.iter().enumerate() {
            let Some(port) = driver.port else { continue };
            match &s.scenario.sources[k].kind {
                SourceKind::Torque(signal) if !signal.moves(inside) => {
                    tau[port] = signal.value(inside, inside, &|_| 0.0)
                }
                _ => sources.push((port, k)),
            }
        }
        for (k, f) in s.frictions.iter().enumerate() {
            if f.viscous != 0.0 {
                viscous.push(k);
            }
            if f.group.is_none_or(|(g, _)| self.mode.slip[g] == 0) {
                continue;
            }
            let flat = f.torque.points().len() == 1 && !matches!(f.what, Rubs::Law(_));
            if flat && s.governor(f).is_none_or(|(_, signal)| !signal.moves(inside)) {
                tau[f.port] = self.friction_torque(k, &self.mode, false, inside);
            } else {
                sliding.push(k);
            }
        }
        for (j, e) in s.elements.iter().enumerate() {
            if e.loses_alike() {
                tau[e.port] = self.constant_loss(j, &self.mode);
            } else {
                elements.push(j);
            }
        }
        let level = |f| s.governor(f).is_none_or(|(_, signal)| !signal.moves(inside));
        let engaged =
            s.frictions.iter().enumerate().map(|(k, f)| level(f).then(|| self.engagement(k, inside))).collect();
        let watches = self.watched();
        let mode = self.mode.clone();
        let mut steady =
            Steady { mode, segment, inside, tau, sources, viscous, sliding, elements, engaged, watches, affine: None };
        steady.affine = Affine::new(self, &steady);
        self.steady = Some(steady);
    }

    /// The present stretch is over; what it had in common may come again.
    pub fn leave_stretch(&mut self) {
        self.stretches.extend(self.steady.take());
    }

    /// What was common to stretches no longer is.
    pub fn forget_stretches(&mut self) {
        self.stretches.clear();
        self.steady = None;
    }

    /// What the present stretch has in common, if that is known.
    pub fn steady(&self) -> Option<&Steady> {
        self.steady.as_ref().filter(|steady| steady.inside == self.inside)
    }

    /// How far a friction element is engaged, if that does not change in the present stretch.
    #[inline]
    pub fn steadily_engaged(&self, f: usize) -> Option<f64> {
        self.steady()?.engaged[f]
    }

    /// Torques of the ports at the state looked at, to the last bit those of [`Engine::load`]; false where they are not known.
    pub fn load_steadily(&mut self, t: f64, x: &[f64]) -> bool {
        let mut tau = std::mem::take(&mut self.tau);
        let s = &self.system;
        let known = self.steady().is_some_and(|steady| {
            tau.copy_from_slice(&steady.tau);
            for &(port, k) in &steady.sources {
                tau[port] = self.source_torque(k, t, x);
            }
            for i in 0..s.prescribed {
                tau[s.port_of_prescribed + i] = self.acceleration[s.free + i];
            }
            for &k in &steady.viscous {
                tau[s.frictions[k].port] += self.viscous_torque(k);
            }
            for &k in &steady.sliding {
                tau[s.frictions[k].port] += self.friction_torque(k, &self.mode, false, t);
            }
            for (k, e) in s.elastic.iter().enumerate() {
                tau[e.port] = self.shaft_torque(k, x);
            }
            for &j in &steady.elements {
                tau[s.elements[j].port] = self.constant_loss(j, &self.mode);
            }
            true
        });
        self.tau = tau;
        known
    }
}
