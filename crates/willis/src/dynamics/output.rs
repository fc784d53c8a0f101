//! Values of the columns at a state.

use crate::train::MemberId;

use super::engine::{Engine, Touch};
use super::integrator::Smooth;
use super::mode::{Side, dot};
use super::report::{Column, ModeLabel};
use super::shows::{Moves, Shows};
use super::system::Rubs;

fn label(slip: i8) -> ModeLabel {
    match slip {
        0 => ModeLabel::Stuck,
        s if s > 0 => ModeLabel::Forward,
        _ => ModeLabel::Backward,
    }
}

impl Engine {
    /// The modes of everything that has one, in the order of its [names](Engine::names).
    pub fn labels(&self) -> Vec<ModeLabel> {
        let label = |shows: &Shows| match shows {
            Shows::Mode(moves) => Some(self.label(*moves)),
            _ => None,
        };
        self.shows.iter().filter_map(label).collect()
    }

    fn label(&self, moves: Moves) -> ModeLabel {
        let s = &self.system;
        match moves {
            Moves::Friction(k) => {
                let f = &s.frictions[k];
                let shift = matches!(f.what, Rubs::Shift(_));
                match f.group {
                    Some((g, factor)) => {
                        let slip = self.mode.slip[g] * factor.signum() as i8;
                        let overruns = f.blocks.is_some() && slip != 0;
                        let free = shift && f.blocks.is_none() && !self.engaged[k] || overruns;
                        if free { ModeLabel::Free } else { label(slip) }
                    }
                    None if !f.open && f.row.iter().all(|x| *x == 0.0) => ModeLabel::Stuck,
                    None => ModeLabel::Free,
                }
            }
            Moves::Element(j) => label(self.mode.element_slip(s, j)),
            Moves::Shaft(k) => match self.touch[k] {
                Touch::Gap => ModeLabel::Free,
                Touch::On(side) | Touch::Limited(side) | Touch::Parting(side) => label(side),
            },
        }
    }

    /// The columns of a row.
    pub fn columns(&self) -> Vec<Column> {
        self.shows.iter().map(|shows| shows.column(&self.system)).collect()
    }

    /// Torque that the first gear of a mesh takes from its shaft, at the state solved last.
    fn mesh_torque(&self, mesh: usize, t: f64) -> f64 {
        let s = &self.system;
        for (j, e) in s.elements.iter().enumerate() {
            if e.passes.iter().all(|p| p.mesh != mesh) {
                continue;
            }
            if self.is_held_openly(j, t) {
                return f64::NAN;
            }
            let drive = self.mode.side[j] == Side::Drive;
            let at_rest = self.mode.element_slip(s, j) == 0;
            let mut entry = self.meshing(j).torque;
            for pass in &e.passes {
                let exit = pass.exit(entry, drive, at_rest);
                if pass.mesh == mesh {
                    // A single mesh written backwards cannot occur: its element starts at its first gear.
                    return if pass.along { entry } else { exit };
                }
                entry = -exit;
            }
        }
        f64::NAN
    }

    fn source_power(&self, k: usize, t: f64) -> f64 {
        self.applied_torque(k, t) * self.member_speed(self.system.drivers[k].member)
    }

    /// Everything that is lost, at the state solved last.
    fn lost_power(&self, t: f64, x: &[f64]) -> f64 {
        let s = &self.system;
        let mut loss = 0.0;
        for (k, f) in s.frictions.iter().enumerate() {
            if !matches!(f.what, Rubs::Rolling(_)) {
                loss += self.rubbing(k, t).loss;
            }
        }
        for k in 0..s.elastic.len() {
            loss += self.damper_power(k, x);
        }
        for k in 0..s.paths.len() {
            loss += self.path_powers(k, t)[1];
        }
        for j in 0..s.elements.len() {
            loss += self.meshing(j).loss;
        }
        loss
    }

    /// What a column shows at the state solved last; NaN where that is not determined.
    pub fn value(&self, shows: Shows, t: f64, x: &[f64]) -> f64 {
        let s = &self.system;
        match shows {
            Shows::Time => t,
            Shows::Speed(m) => self.member_speed(MemberId(m)),
            Shows::Angle(m) => dot(&s.speeds[m], &x[s.free..s.free + s.all()]),
            Shows::Acceleration(m) => dot(self.row_of(m), &self.acceleration),
            Shows::SourceTorque(k) => self.applied_torque(k, t),
            Shows::SourcePower(k) => self.source_power(k, t),
            Shows::FrictionTorque(k) => self.rubbing(k, t).torque,
            Shows::ShaftTorque(k) => self.tau[s.elastic[k].port],
            Shows::Twist(k) => self.twist(k, x),
            Shows::MeshTorque(k) => self.mesh_torque(k, t),
            Shows::Reaction(k) => self.reaction(k, t),
            Shows::Ratio(k) => self.path_states[k].ratio,
            Shows::SideTorque(k, side) => self.path_side(k, side, t).torque,
            Shows::SidePower(k, side) => {
                let of = self.path_side(k, side, t);
                of.torque * of.speed
            }
            Shows::Store(k) => self.path_powers(k, t)[0],
            Shows::Loss => self.lost_power(t, x),
            Shows::Stored => self.stored(x),
            Shows::Lost => {
                let sources = self.integrals() + s.integrals + s.accounts();
                x.get(sources..).filter(|_| self.counts).map_or(f64::NAN, |e| e.iter().sum())
            }
            Shows::Efficiency => {
                let outer = || (0..s.drivers.len()).filter(|&k| s.scenario.sources[k].machine.is_none());
                let stores = || (0..s.paths.len()).map(|k| self.path_powers(k, t)[0]);
                let powers = || outer().map(|k| self.source_power(k, t)).chain(stores());
                let came_in: f64 = powers().filter(|p| *p > 0.0).sum();
                let went_out: f64 = -powers().filter(|p| *p < 0.0).sum::<f64>();
                if came_in > 0.0 { went_out / came_in } else { f64::NAN }
            }
            Shows::Temperature(k) => self.warmth.get(k).copied().unwrap_or(f64::NAN),
            Shows::Mode(moves) => self.label(moves).value(),
        }
    }

    /// A row at a state, which is solved for.
    pub fn row(&mut self, t: f64, x: &[f64], out: &mut Vec<f64>) {
        self.solve(t, x);
        if let Some(warming) = &self.warming {
            self.warmth = warming.at(t, &x[self.states()..]);
        }
        out.clear();
        out.extend(self.shows.iter().map(|shows| self.value(*shows, t, x)));
    }
}
