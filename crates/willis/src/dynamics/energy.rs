//! Where the energy goes: every source and every named loss is integrated along with the motion.

use crate::train::SourceKind;

use super::engine::Engine;
use super::mode::{Side, dot, slope};
use super::report::{EnergyLoss, EnergyLossKind, EnergyReport, SourceEnergy};
use super::system::{PathKind, Rubs};

/// What a friction element does to its first member, and what it costs.
#[derive(Clone, Copy)]
pub(super) struct Rubbing {
    /// N m on the first member; NaN where it is held together with others.
    pub torque: f64,
    /// W
    pub loss: f64,
}

/// What an element takes at its first gear, and what it costs.
#[derive(Clone, Copy)]
pub(super) struct Meshing {
    /// N m; one of several where it is [open](Engine::is_held_openly).
    pub torque: f64,
    /// The loss as a torque at the first gear, N m.
    pub lost: f64,
    /// W
    pub loss: f64,
}

impl Engine {
    /// Number of energies that are integrated: of sources and stores, frictions, shafts, meshes, variators.
    pub fn energies(&self) -> usize {
        if self.counts { self.powers_count() } else { 0 }
    }

    /// Number of powers that are told apart, whether their energies are counted or not.
    pub fn powers_count(&self) -> usize {
        let s = &self.system;
        s.accounts() + s.frictions.len() + s.elastic.len() + s.train.meshes().len() + s.paths.len()
    }

    /// The whole torque of a source, at the state solved last.
    pub fn applied_torque(&self, k: usize, t: f64) -> f64 {
        let driver = &self.system.drivers[k];
        if let Some(i) = driver.prescribed {
            return self.map.as_ref().map_or(f64::NAN, |m| m.unknown(self.system.free + i, &self.tau));
        }
        let mut torque = driver.port.map_or(0.0, |p| self.tau[p]);
        if let SourceKind::Controller { derivative, .. } = &self.system.scenario.sources[k].kind {
            torque -= derivative * dot(&self.system.speeds[driver.member.index()], &self.acceleration);
        }
        if let Some(f) = driver.rolling {
            let rolling = self.rubbing(f, t).torque;
            torque += if rolling.is_nan() { 0.0 } else { rolling };
        }
        torque
    }

    /// A friction element at the state solved last.
    pub fn rubbing(&self, k: usize, t: f64) -> Rubbing {
        let f = &self.system.frictions[k];
        let w = dot(&f.row, &self.speed);
        let viscous = -f.viscous * w;
        let Some((g, factor)) = f.group else {
            return Rubbing { torque: viscous, loss: -viscous * w };
        };
        let sign = self.mode.slip[g] * factor.signum() as i8;
        let group = &self.system.groups[g];
        if sign != 0 {
            let sliding = self.sliding(k, w, sign, false, t);
            let sliding = if sliding.is_finite() { sliding } else { 0.0 };
            return Rubbing { torque: viscous + sliding, loss: -(viscous + sliding) * w };
        }
        // Held: the torque is determined where nothing else shares in it.
        let alone = group.elements.is_empty() && group.frictions.iter().filter(|&&f| self.can_hold(f, t)).count() == 1;
        let torque = match (&self.map, self.can_hold(k, t)) {
            (_, false) => viscous,
            (Some(map), _) if alone && !map.open_groups[g] && !group.driven => {
                group.lead.1 * map.held(g, &self.tau) / factor + viscous
            }
            _ => f64::NAN,
        };
        Rubbing { torque, loss: 0.0 }
    }

    /// An element at the state solved last.
    pub fn meshing(&self, j: usize) -> Meshing {
        let e = &self.system.elements[j];
        let (torque, _) = self.element_torque(j);
        let sign = self.mode.element_slip(&self.system, j);
        if sign == 0 {
            return Meshing { torque, lost: 0.0, loss: 0.0 };
        }
        let loss = self.loss(j);
        let side = self.mode.side[j];
        let constant = match side {
            Side::Drive => loss.drive_torque,
            Side::Coast => loss.coast_torque,
        };
        let lost = slope(loss, side) * torque + f64::from(sign) * constant;
        Meshing { torque, lost, loss: lost * dot(&e.row, &self.speed) }
    }

    /// Whether an element does not slide, and its torque depends on how what is held shares the torque that holds it.
    pub fn is_held_openly(&self, j: usize, t: f64) -> bool {
        self.mode.element_slip(&self.system, j) == 0 && self.is_open(self.system.all() + j, t)
    }

    /// Whether an unknown of the equations depends on how what is held shares the torque that holds it, which is open.
    fn is_open(&self, unknown: usize, t: f64) -> bool {
        let Some(map) = &self.map else { return true };
        if map.open_unknowns[unknown] {
            return true;
        }
        let s = &self.system;
        // What is passed from one holder of a group to another changes no acceleration, but what lies between them.
        let changes = |port: usize| map.response[unknown * map.ports + port] != 0.0;
        s.groups.iter().enumerate().filter(|(g, _)| self.mode.slip[*g] == 0).any(|(_, group)| {
            let rubbing = group.frictions.iter().filter(|&&f| self.can_hold(f, t)).map(|&f| s.frictions[f].port);
            let ports = || rubbing.clone().chain(group.elements.iter().map(|&j| s.elements[j].port));
            ports().count() + usize::from(group.driven) > 1 && ports().any(changes)
        })
    }

    /// Whether a friction element takes torque while it does not slide.
    fn can_hold(&self, f: usize, t: f64) -> bool {
        [1, -1].iter().any(|&sign| self.sliding(f, 0.0, sign, true, t) != 0.0)
    }

    /// The torque with which the frame holds a member, or all, at the state solved last; NaN where what holds it
    /// is not determined.
    pub fn reaction(&self, k: usize, t: f64) -> f64 {
        let s = &self.system;
        let of = &s.reactions[k];
        let elements = of.elements.iter().map(|&(j, force, loss)| {
            let Meshing { torque, lost, .. } = self.meshing(j);
            if force != 0.0 && self.is_held_openly(j, t) { f64::NAN } else { force * torque + loss * lost }
        });
        let frictions = of.frictions.iter().map(|&(f, side)| -side * self.rubbing(f, t).torque);
        let shafts = of.shafts.iter().map(|&(k, side)| -side * self.tau[s.elastic[k].port]);
        let sources = of.sources.iter().map(|&k| {
            let driver = &s.drivers[k];
            let behind_speed = driver.prescribed.is_some_and(|i| self.is_open(s.free + i, t));
            let rolls = driver.rolling.is_some_and(|f| self.rubbing(f, t).torque.is_nan());
            if behind_speed || rolls { f64::NAN } else { -self.applied_torque(k, t) }
        });
        let variators = of.variators.iter().map(|&port| -self.tau[port]);
        // Idle elements give a negative zero, which a sum that begins with zero does not show.
        let others: f64 =
            elements.chain(frictions).chain(shafts).chain(sources).chain(variators).fold(0.0, |sum, x| sum + x);
        dot(&of.momentum, &self.acceleration) + others
    }

    /// How the loss of an element divides among its meshes at present: mesh and part.
    pub fn shares(&self, j: usize) -> &[(usize, f64)] {
        &self.system.elements[j].shares[usize::from(self.mode.side[j] == Side::Coast)]
    }

    /// Rates of the energies at the state solved last, W.
    pub fn powers(&mut self, t: f64, x: &[f64], out: &mut [f64]) {
        if out.is_empty() {
            return;
        }
        out.iter_mut().for_each(|p| *p = 0.0);
        let s = &self.system;
        let (sources, variators) = (s.accounts(), out.len() - s.paths.len());
        for k in 0..s.paths.len() {
            [out[s.drivers.len() + k], out[variators + k]] = self.path_powers(k, t);
        }
        for k in 0..s.drivers.len() {
            out[k] = self.applied_torque(k, t) * self.member_speed(s.drivers[k].member);
        }
        let mut at = sources;
        for k in 0..s.frictions.len() {
            match s.frictions[k].what {
                Rubs::Rolling(_) => {}
                Rubs::Variator(path) => out[variators + path] += self.rubbing(k, t).loss,
                _ => out[at + k] = self.rubbing(k, t).loss,
            }
        }
        at += s.frictions.len();
        for k in 0..s.elastic.len() {
            // What the damper takes; the spring gives back what it took.
            out[at + k] = self.damper_power(k, x);
        }
        at += s.elastic.len();
        for j in 0..s.elements.len() {
            if s.elements[j].group.is_none() {
                continue;
            }
            let mut loss = self.meshing(j).loss;
            if let (Some(mesh), Some(laws)) = (s.elements[j].law, &s.laws) {
                let mut teeth = loss;
                for (friction, part) in laws.bearing_parts(mesh) {
                    out[sources + friction] += loss * part;
                    teeth -= loss * part;
                }
                loss = teeth;
            }
            for &(mesh, part) in self.shares(j) {
                out[at + mesh] += loss * part;
            }
        }
    }

    /// Kinetic energy and that of twisted shafts.
    pub fn stored(&self, x: &[f64]) -> f64 {
        let w = nalgebra::DVector::from_column_slice(&self.speed);
        let kinetic = 0.5 * (w.transpose() * &self.system.energy * &w)[(0, 0)];
        let twisted: f64 = (0..self.system.elastic.len()).map(|k| self.spring_energy(k, x)).sum();
        kinetic + twisted + self.path_energy(x)
    }

    /// The same up to round-off, without room of its own.
    pub fn stored_now(&self, x: &[f64]) -> f64 {
        let w = &self.speed;
        let of_row = |(i, w_i): (usize, &f64)| {
            w_i * w.iter().enumerate().map(|(j, w_j)| self.system.energy[(i, j)] * w_j).sum::<f64>()
        };
        let kinetic: f64 = w.iter().enumerate().map(of_row).sum();
        let twisted: f64 = (0..self.system.elastic.len()).map(|k| self.spring_energy(k, x)).sum();
        0.5 * kinetic + twisted + self.path_energy(x)
    }

    /// What loses, by cause: name, kind, and which of the energies are its own.
    pub fn causes(&self) -> Vec<(String, EnergyLossKind, Vec<usize>)> {
        let s = &self.system;
        let mut causes: Vec<(String, EnergyLossKind, Vec<usize>)> = Vec::new();
        let mut at = s.accounts();
        for (k, f) in s.frictions.iter().enumerate() {
            let Some(kind) = s.loss_kind(k).filter(|_| !f.open) else { continue };
            match causes.last_mut().filter(|_| f.what == Rubs::Trace && s.frictions[k - 1].what == Rubs::Trace) {
                // They are told together.
                Some((_, _, energies)) => energies.push(at + k),
                None => causes.push((f.name.clone(), kind, vec![at + k])),
            }
        }
        at += s.frictions.len();
        for (k, shaft) in s.train.shafts().iter().enumerate() {
            if shaft.damping > 0.0 || shaft.backlash > 0.0 {
                causes.push((shaft.name.clone(), EnergyLossKind::Shaft, vec![at + k]));
            }
        }
        at += s.elastic.len();
        for (k, mesh) in s.train.meshes().iter().enumerate() {
            causes.push((mesh.name.clone(), EnergyLossKind::Mesh, vec![at + k]));
        }
        at += s.train.meshes().len();
        for (k, path) in s.paths.iter().enumerate() {
            causes.push((s.train.variators[path.variator].name.clone(), EnergyLossKind::Variator, vec![at + k]));
        }
        causes
    }

    /// The report at the end of a run: `stored` at the start and at the end, the energies, and of those of the
    /// sources what came in. None if they were not counted or are no longer finite.
    pub fn energy_report(&self, stored: [f64; 2], energies: &[f64], came_in: &[f64]) -> Option<EnergyReport> {
        if !self.counts || energies.iter().chain(&stored).chain(came_in).any(|e| !e.is_finite()) {
            return None;
        }
        let s = &self.system;
        let account = |k: usize, name: &str, of: &str| SourceEnergy {
            name: name.to_owned(),
            member: of.to_owned(),
            energy_j: energies[k],
            in_j: came_in[k],
            out_j: (came_in[k] - energies[k]).max(0.0),
        };
        let of_source = |k: usize| account(k, &s.scenario.sources[k].name, s.train.member_name(s.drivers[k].member));
        let is_machine = |k: &usize| s.scenario.sources[*k].machine.is_some();
        let (machines, outer): (Vec<usize>, Vec<usize>) = (0..s.drivers.len()).partition(is_machine);
        let machines: Vec<SourceEnergy> = machines.into_iter().map(of_source).collect();
        let mut sources: Vec<SourceEnergy> = outer.into_iter().map(of_source).collect();
        for (k, path) in s.paths.iter().enumerate().filter(|(_, p)| matches!(p.kind, PathKind::Bus { .. })) {
            let name = &s.train.variators[path.variator].name;
            sources.push(account(s.drivers.len() + k, &format!("store of {name}"), name));
        }
        let summed = |(name, kind, of): (String, EnergyLossKind, Vec<usize>)| EnergyLoss {
            name,
            kind,
            energy_j: of.iter().map(|&k| energies[k]).sum(),
        };
        let mut losses: Vec<EnergyLoss> = self.causes().into_iter().map(summed).collect();
        losses.sort_by(|a, b| b.energy_j.total_cmp(&a.energy_j));
        let stored_j = stored[1] - stored[0];
        let lost: f64 = losses.iter().map(|l| l.energy_j).sum();
        let net: f64 = sources.iter().map(|s| s.energy_j).sum();
        let came_in: f64 = sources.iter().map(|s| s.in_j).sum();
        let went_out: f64 = sources.iter().map(|s| s.out_j).sum();
        let turned_over_j = came_in + (-stored_j).max(0.0);
        Some(EnergyReport {
            stored_j,
            residual_j: net - stored_j - lost,
            turned_over_j,
            efficiency: (came_in > 0.0 && stored_j.abs() <= 1e-9 * came_in).then(|| went_out / came_in),
            sources,
            machines,
            losses,
        })
    }
}
