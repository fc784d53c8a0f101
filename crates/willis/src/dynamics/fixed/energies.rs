//! Where the energy of a step goes.

use crate::dynamics::mode::{Side, dot, slope};
use crate::dynamics::system::Rubs;
use crate::train::SourceKind;

use super::FixedStep;

impl FixedStep {
    /// Work of the step's torques at the mean of the speeds before and after it, in a step that was settled.
    pub(super) fn count_energies(&mut self) {
        let Some((_, map)) = self.last else { return };
        let [mut tau, mut mean] = std::mem::take(&mut self.room);
        tau.clear();
        tau.extend_from_slice(&self.tau[..self.engine.system.ports]);
        mean.clear();
        mean.extend(self.v.iter().zip(&self.next).map(|(a, b)| 0.5 * (a + b)));
        self.count_at(map, &mut tau, &mean);
        self.room = [tau, mean];
    }

    /// The same at these torques of the ports and mean speeds.
    fn count_at(&mut self, map: u32, tau: &mut [f64], mean: &[f64]) {
        let s = &self.engine.system;
        let (free, cols) = (s.free, self.tau.len());
        let map = &self.maps[map as usize];
        // Holding torques join those of the ports.
        for (k, &g) in map.held.iter().enumerate().filter(|_| !self.is_decided) {
            let row = &map.rows[(free + k) * cols..(free + k + 1) * cols];
            tau[self.groups[usize::from(g)].lead.0] += dot(row, &self.tau);
        }
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
            let work = torque * dot(row, mean) * self.h;
            self.energies[k] += work;
            self.came_in[k] += work.max(0.0);
        }
        let mut at = s.drivers.len();
        for (k, f) in s.frictions.iter().enumerate() {
            if !matches!(f.what, Rubs::Rolling(_)) {
                self.energies[at + k] -= tau[f.port] * dot(&f.row, mean) * self.h;
            }
        }
        at += s.frictions.len();
        for (k, e) in s.elastic.iter().enumerate() {
            // What looking ahead takes from a spring is no loss that the shaft has: it stays in the residual.
            let damper = dot(&self.shafts[k].damper(), &[self.shafts[k].twist, dot(&e.row, &self.next), 1.0]);
            self.energies[at + k] += damper * dot(&e.row, mean) * self.h;
        }
        at += s.elastic.len();
        if self.is_decided {
            for (j, e) in s.elements.iter().enumerate() {
                let energy = self.losses[j] * dot(&e.row, mean) * self.h;
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
            let energy = torque * dot(&e.row, mean) * self.h;
            for &(mesh, part) in &e.shares[usize::from(self.side[j] == Side::Coast)] {
                self.energies[at + mesh] += energy * part;
            }
        }
        // Teeth that hold, in the step in which they come to rest.
        for &g in &map.held {
            let (port, _) = self.groups[usize::from(g)].lead;
            for &j in &self.groups[usize::from(g)].elements {
                if s.elements[j].port == port {
                    let energy = tau[port] * dot(&s.elements[j].row, mean) * self.h;
                    for &(mesh, part) in &s.elements[j].shares[usize::from(self.side[j] == Side::Coast)] {
                        self.energies[at + mesh] += energy * part;
                    }
                }
            }
        }
    }
}
