//! Where the energy of a step goes.

use crate::dynamics::mode::{Side, dot, slope};
use crate::dynamics::system::Rubs;
use crate::train::SourceKind;

use super::FixedStep;

impl FixedStep {
    /// Work of the step's torques at the mean of the speeds before and after it.
    pub(super) fn count_energies(&mut self) {
        let s = &self.engine.system;
        let (free, cols) = (s.free, self.tau.len());
        let Some((_, map)) = self.last else { return };
        let map = &self.maps[map as usize];
        // Holding torques join those of the ports.
        let mut tau = self.tau[..s.ports].to_vec();
        for (k, &g) in map.held.iter().enumerate().filter(|_| !self.is_decided) {
            let row = &map.rows[(free + k) * cols..(free + k + 1) * cols];
            tau[self.groups[usize::from(g)].lead.0] += dot(row, &self.tau);
        }
        let mean: Vec<f64> = self.v.iter().zip(&self.next).map(|(a, b)| 0.5 * (a + b)).collect();
        for (k, (driver, source)) in s.drivers.iter().zip(&s.scenario.sources).enumerate() {
            let row = &s.speeds[driver.member.index()];
            let mut torque = match driver.prescribed {
                Some(i) => {
                    if self.is_decided {
                        self.reactions[i]
                    } else {
                        dot(&map.reactions[i * cols..(i + 1) * cols], &self.tau)
                    }
                }
                None => tau[driver.port.expect("a torque")],
            };
            if let SourceKind::Controller { derivative, .. } = &source.kind {
                torque -= derivative * (dot(row, &self.next) - dot(row, &self.v)) / self.h;
            }
            if let Some(f) = driver.rolling {
                torque += tau[s.frictions[f].port];
            }
            let work = torque * dot(row, &mean) * self.h;
            self.energies[k] += work;
            self.came_in[k] += work.max(0.0);
        }
        let mut at = s.drivers.len();
        for (k, f) in s.frictions.iter().enumerate() {
            if !matches!(f.what, Rubs::Rolling(_)) {
                self.energies[at + k] -= tau[f.port] * dot(&f.row, &mean) * self.h;
            }
        }
        at += s.frictions.len();
        for (k, e) in s.elastic.iter().enumerate() {
            // What looking ahead takes from a spring is no loss that the shaft has: it stays in the residual.
            let damper = self.shafts[k].damper_torque(dot(&e.row, &self.next));
            self.energies[at + k] += damper * dot(&e.row, &mean) * self.h;
        }
        at += s.elastic.len();
        if self.is_decided {
            for (j, e) in s.elements.iter().enumerate() {
                let energy = self.losses[j] * dot(&e.row, &mean) * self.h;
                for &(mesh, part) in &e.shares[usize::from(self.side[j] == Side::Coast)] {
                    self.energies[at + mesh] += energy * part;
                }
            }
            return;
        }
        let moving = map.rows[(free + map.held.len()) * cols..].chunks_exact(cols);
        for (&j, row) in map.moving.iter().zip(moving) {
            let j = usize::from(j);
            let (_, _, loss) = self.teeth[j];
            let e = &s.elements[j];
            let torque = dot(row, &self.tau) * slope(loss, self.side[j]) + tau[e.port];
            let energy = torque * dot(&e.row, &mean) * self.h;
            for &(mesh, part) in &e.shares[usize::from(self.side[j] == Side::Coast)] {
                self.energies[at + mesh] += energy * part;
            }
        }
        // Teeth that hold, in the step in which they come to rest.
        for &g in &map.held {
            let (port, _) = self.groups[usize::from(g)].lead;
            for &j in &self.groups[usize::from(g)].elements {
                if s.elements[j].port == port {
                    let energy = tau[port] * dot(&s.elements[j].row, &mean) * self.h;
                    for &(mesh, part) in &s.elements[j].shares[usize::from(self.side[j] == Side::Coast)] {
                        self.energies[at + mesh] += energy * part;
                    }
                }
            }
        }
    }
}
