//! Rows of output and labels of modes.

use super::engine::{Engine, Touch};
use super::mode::{Side, dot};
use super::report::{Column, ColumnKind, EnergyLossKind, ModeLabel};
use super::system::{Rubs, element_name};

fn label(slip: i8) -> ModeLabel {
    match slip {
        0 => ModeLabel::Stuck,
        s if s > 0 => ModeLabel::Forward,
        _ => ModeLabel::Backward,
    }
}

/// A label as a number in the rows.
fn number(label: ModeLabel) -> f64 {
    match label {
        ModeLabel::Backward => -1.0,
        ModeLabel::Stuck => 0.0,
        ModeLabel::Forward => 1.0,
        ModeLabel::Free => 2.0,
    }
}

impl Engine {
    /// Whether a law's friction element can hold, and its slip is not told of by another of its group.
    fn speaks(&self, k: usize) -> bool {
        let group = self.system.frictions[k].group.map(|(g, _)| &self.system.groups[g]);
        matches!(self.kind(k), Some(EnergyLossKind::Bearing | EnergyLossKind::Seal))
            && group.is_some_and(|g| g.elements.is_empty() && g.frictions[0] == k)
    }

    /// Everything that has a mode, and the mode.
    pub fn labels(&self) -> Vec<(String, ModeLabel)> {
        let s = &self.system;
        let mut all = Vec::new();
        for (k, f) in s.frictions.iter().enumerate() {
            let shift = matches!(f.what, Rubs::Shift(_));
            if matches!(f.what, Rubs::Law(_)) && !self.speaks(k) {
                continue;
            }
            match f.group {
                Some((g, factor)) => {
                    let slip = self.mode.slip[g] * factor.signum() as i8;
                    let overruns = f.blocks.is_some() && slip != 0;
                    let free = shift && f.blocks.is_none() && !self.engaged[k] || overruns;
                    all.push((f.name.clone(), if free { ModeLabel::Free } else { label(slip) }));
                }
                None if shift => {
                    let held = !f.open && f.row.iter().all(|x| *x == 0.0);
                    all.push((f.name.clone(), if held { ModeLabel::Stuck } else { ModeLabel::Free }));
                }
                None => {}
            }
        }
        for (j, e) in s.elements.iter().enumerate() {
            if e.group.is_some() {
                all.push((element_name(&s.train, &e.links), label(self.mode.element_slip(s, j))));
            }
        }
        for (k, shaft) in s.train.shafts().iter().enumerate() {
            if shaft.backlash > 0.0 {
                let l = match self.touch[k] {
                    Touch::Gap => ModeLabel::Free,
                    Touch::On(side) | Touch::Limited(side) | Touch::Parting(side) => label(side),
                };
                all.push((shaft.name.clone(), l));
            }
        }
        all
    }

    /// The columns of a row.
    pub fn columns(&self) -> Vec<Column> {
        let s = &self.system;
        let mut all = Vec::new();
        let mut column = |name: String, kind: ColumnKind, of: &str| {
            all.push(Column { name, unit: kind.unit(), kind, of: of.to_owned() })
        };
        column("time_s".to_owned(), ColumnKind::Time, "");
        let mut add = |kind: ColumnKind, of: &str| column(format!("{}.{of}", kind.name()), kind, of);
        let members = || s.train.members()[1..].iter().map(|m| m.name.as_str());
        members().for_each(|m| add(ColumnKind::Speed, m));
        members().for_each(|m| add(ColumnKind::Angle, m));
        members().for_each(|m| add(ColumnKind::Acceleration, m));
        for source in &s.scenario.sources {
            add(ColumnKind::Torque, &source.name);
        }
        for source in &s.scenario.sources {
            add(ColumnKind::Power, &source.name);
        }
        for f in s.frictions.iter().filter(|f| !f.open && !matches!(f.what, Rubs::Rolling(_))) {
            add(ColumnKind::Torque, &f.name);
        }
        for shaft in s.train.shafts() {
            add(ColumnKind::Torque, &shaft.name);
            add(ColumnKind::Twist, &shaft.name);
        }
        for mesh in s.train.meshes() {
            add(ColumnKind::Torque, &mesh.name);
        }
        let of_all = [
            ("loss", ColumnKind::Power),
            ("stored_energy", ColumnKind::Energy),
            ("lost_energy", ColumnKind::Energy),
            ("efficiency", ColumnKind::Efficiency),
        ];
        of_all.into_iter().for_each(|(name, kind)| column(name.to_owned(), kind, ""));
        for (name, _) in self.labels() {
            column(format!("mode.{name}"), ColumnKind::Mode, &name);
        }
        all
    }

    /// Torque that the first gear of every mesh takes from its shaft, at the state solved last.
    fn mesh_torques(&self, out: &mut [f64]) {
        let s = &self.system;
        for (j, e) in s.elements.iter().enumerate() {
            let meshing = self.meshing(j);
            let sign = self.mode.element_slip(s, j);
            let drive = self.mode.side[j] == Side::Drive;
            let mut entry = meshing.torque;
            for link in &e.links {
                let mesh = &s.train.meshes()[link.mesh.index()];
                let (from, to) = if link.along { (0, 1) } else { (1, 0) };
                let ratio = (&mesh.gears[to].teeth / &mesh.gears[from].teeth).to_f64();
                let ratio = if mesh.same_sense { -ratio } else { ratio };
                let efficiency = if link.along == drive { &mesh.efficiency.forward } else { &mesh.efficiency.backward };
                let efficiency = if e.links.len() == 1 || sign == 0 { 1.0 } else { efficiency.to_f64() };
                let exit = ratio * entry * if drive { efficiency } else { 1.0 / efficiency };
                out[link.mesh.index()] = if link.along { entry } else { exit };
                entry = -exit;
            }
            // A single mesh written backwards cannot occur: its element starts at its first gear.
        }
    }

    /// A row at a state, which is solved for.
    pub fn row(&mut self, t: f64, x: &[f64], out: &mut Vec<f64>) {
        self.solve(t, x);
        out.clear();
        out.push(t);
        let s = &self.system;
        let (free, all) = (s.free, s.all());
        let members = 1..s.speeds.len();
        out.extend(members.clone().map(|m| dot(&s.speeds[m], &self.speed)));
        out.extend(members.clone().map(|m| dot(&s.speeds[m], &x[free..free + all])));
        out.extend(members.map(|m| dot(&s.speeds[m], &self.acceleration)));
        let torques: Vec<f64> = (0..s.drivers.len()).map(|k| self.applied_torque(k, t)).collect();
        let powers: Vec<f64> =
            torques.iter().zip(&s.drivers).map(|(torque, d)| torque * self.member_speed(d.member)).collect();
        out.extend(&torques);
        out.extend(&powers);
        let mut loss = 0.0;
        for (k, f) in s.frictions.iter().enumerate() {
            if matches!(f.what, Rubs::Rolling(_)) {
                continue;
            }
            let rubbing = self.rubbing(k, t);
            loss += rubbing.loss;
            if !f.open {
                out.push(rubbing.torque);
            }
        }
        for (k, e) in s.elastic.iter().enumerate() {
            loss += self.damper_power(k, x);
            out.push(self.tau[e.port]);
            out.push(self.twist(k, x));
        }
        let mut meshes = vec![f64::NAN; s.train.meshes().len()];
        self.mesh_torques(&mut meshes);
        out.extend(&meshes);
        for j in 0..s.elements.len() {
            loss += self.meshing(j).loss;
        }
        out.push(loss);
        out.push(self.stored(x));
        let states = self.integrals() + s.integrals;
        out.push(x.get(states + s.drivers.len()..).filter(|_| self.counts).map_or(f64::NAN, |e| e.iter().sum()));
        let came_in: f64 = powers.iter().filter(|p| **p > 0.0).sum();
        let went_out: f64 = -powers.iter().filter(|p| **p < 0.0).sum::<f64>();
        out.push(if came_in > 0.0 { went_out / came_in } else { f64::NAN });
        out.extend(self.labels().iter().map(|(_, l)| number(*l)));
    }
}
