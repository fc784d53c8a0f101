//! What can be read of a run: columns, and their values at a state.

use crate::train::MemberId;

use super::engine::{Engine, Touch};
use super::mode::{Side, dot};
use super::report::{Column, ColumnKind, EnergyLossKind, ModeLabel};
use super::system::{Rubs, System, element_name};

fn label(slip: i8) -> ModeLabel {
    match slip {
        0 => ModeLabel::Stuck,
        s if s > 0 => ModeLabel::Forward,
        _ => ModeLabel::Backward,
    }
}

/// What a column shows; positions are those in the system.
#[derive(Clone, Copy, Debug)]
pub(super) enum Shows {
    Time,
    Speed(usize),
    Angle(usize),
    Acceleration(usize),
    SourceTorque(usize),
    SourcePower(usize),
    FrictionTorque(usize),
    ShaftTorque(usize),
    Twist(usize),
    MeshTorque(usize),
    Loss,
    Stored,
    Lost,
    Efficiency,
    Mode(Moves),
}

/// What has a mode.
#[derive(Clone, Copy, Debug)]
pub(super) enum Moves {
    Friction(usize),
    Element(usize),
    Shaft(usize),
}

impl Shows {
    /// Whether its value follows from speeds and angles alone.
    pub fn is_motion(self) -> bool {
        matches!(self, Self::Time | Self::Speed(_) | Self::Angle(_))
    }

    /// Everything that can be read of a system, in the order of the columns.
    pub fn all(s: &System) -> Vec<Self> {
        let (members, sources, shafts) = (1..s.speeds.len(), 0..s.drivers.len(), 0..s.elastic.len());
        let rubs = (0..s.frictions.len())
            .filter(|&k| !s.frictions[k].open && !matches!(s.frictions[k].what, Rubs::Rolling(_)));
        std::iter::once(Self::Time)
            .chain(members.clone().map(Self::Speed))
            .chain(members.clone().map(Self::Angle))
            .chain(members.map(Self::Acceleration))
            .chain(sources.clone().map(Self::SourceTorque))
            .chain(sources.map(Self::SourcePower))
            .chain(rubs.map(Self::FrictionTorque))
            .chain(shafts.flat_map(|k| [Self::ShaftTorque(k), Self::Twist(k)]))
            .chain((0..s.train.meshes().len()).map(Self::MeshTorque))
            .chain([Self::Loss, Self::Stored, Self::Lost, Self::Efficiency])
            .chain(Moves::all(s).into_iter().map(Self::Mode))
            .collect()
    }

    /// Its column.
    pub fn column(self, s: &System) -> Column {
        let member = |m: usize| s.train.members()[m].name.clone();
        let source = |k: usize| s.scenario.sources[k].name.clone();
        let (kind, of) = match self {
            Self::Time => (ColumnKind::Time, String::new()),
            Self::Speed(m) => (ColumnKind::Speed, member(m)),
            Self::Angle(m) => (ColumnKind::Angle, member(m)),
            Self::Acceleration(m) => (ColumnKind::Acceleration, member(m)),
            Self::SourceTorque(k) => (ColumnKind::Torque, source(k)),
            Self::SourcePower(k) => (ColumnKind::Power, source(k)),
            Self::FrictionTorque(k) => (ColumnKind::Torque, s.frictions[k].name.clone()),
            Self::ShaftTorque(k) => (ColumnKind::Torque, s.train.shafts()[k].name.clone()),
            Self::Twist(k) => (ColumnKind::Twist, s.train.shafts()[k].name.clone()),
            Self::MeshTorque(k) => (ColumnKind::Torque, s.train.meshes()[k].name.clone()),
            Self::Loss => (ColumnKind::Power, String::new()),
            Self::Stored | Self::Lost => (ColumnKind::Energy, String::new()),
            Self::Efficiency => (ColumnKind::Efficiency, String::new()),
            Self::Mode(moves) => (ColumnKind::Mode, moves.name(s)),
        };
        let name = match self {
            Self::Time => "time_s".to_owned(),
            Self::Loss => "loss".to_owned(),
            Self::Stored => "stored_energy".to_owned(),
            Self::Lost => "lost_energy".to_owned(),
            Self::Efficiency => "efficiency".to_owned(),
            _ => format!("{}.{of}", kind.name()),
        };
        Column { name, unit: kind.unit(), kind, of }
    }
}

impl Moves {
    fn all(s: &System) -> Vec<Self> {
        let of_friction = |&k: &usize| {
            let f = &s.frictions[k];
            match f.what {
                Rubs::Law(place) => {
                    // It can hold, and its slip is not told of by another of its group.
                    let kind = s.laws.as_ref().map(|laws| laws.places[place].loss_kind());
                    let group = f.group.map(|(g, _)| &s.groups[g]);
                    matches!(kind, Some(EnergyLossKind::Bearing | EnergyLossKind::Seal))
                        && group.is_some_and(|g| g.elements.is_empty() && g.frictions[0] == k)
                }
                Rubs::Shift(_) => true,
                Rubs::Drag(_) | Rubs::Rolling(_) => f.group.is_some(),
            }
        };
        let elements = (0..s.elements.len()).filter(|&j| s.elements[j].group.is_some());
        let shafts = (0..s.elastic.len()).filter(|&k| s.train.shafts()[k].backlash > 0.0);
        let frictions = (0..s.frictions.len()).filter(of_friction);
        (frictions.map(Self::Friction)).chain(elements.map(Self::Element)).chain(shafts.map(Self::Shaft)).collect()
    }

    fn name(self, s: &System) -> String {
        match self {
            Self::Friction(k) => s.frictions[k].name.clone(),
            Self::Element(j) => element_name(&s.train, &s.elements[j].links),
            Self::Shaft(k) => s.train.shafts()[k].name.clone(),
        }
    }
}

impl Engine {
    /// Everything that has a mode, and the mode.
    pub fn labels(&self) -> Vec<(String, ModeLabel)> {
        let moves = self.shows.iter().filter_map(|shows| match shows {
            Shows::Mode(moves) => Some((moves.name(&self.system), self.label(*moves))),
            _ => None,
        });
        moves.collect()
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
    fn mesh_torque(&self, mesh: usize) -> f64 {
        let s = &self.system;
        for (j, e) in s.elements.iter().enumerate() {
            if e.passes.iter().all(|p| p.mesh != mesh) {
                continue;
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
            Shows::Acceleration(m) => dot(&s.speeds[m], &self.acceleration),
            Shows::SourceTorque(k) => self.applied_torque(k, t),
            Shows::SourcePower(k) => self.source_power(k, t),
            Shows::FrictionTorque(k) => self.rubbing(k, t).torque,
            Shows::ShaftTorque(k) => self.tau[s.elastic[k].port],
            Shows::Twist(k) => self.twist(k, x),
            Shows::MeshTorque(k) => self.mesh_torque(k),
            Shows::Loss => self.lost_power(t, x),
            Shows::Stored => self.stored(x),
            Shows::Lost => {
                let sources = self.integrals() + s.integrals + s.drivers.len();
                x.get(sources..).filter(|_| self.counts).map_or(f64::NAN, |e| e.iter().sum())
            }
            Shows::Efficiency => {
                let powers = || (0..s.drivers.len()).map(|k| self.source_power(k, t));
                let came_in: f64 = powers().filter(|p| *p > 0.0).sum();
                let went_out: f64 = -powers().filter(|p| *p < 0.0).sum::<f64>();
                if came_in > 0.0 { went_out / came_in } else { f64::NAN }
            }
            Shows::Mode(moves) => self.label(moves).value(),
        }
    }

    /// A row at a state, which is solved for.
    pub fn row(&mut self, t: f64, x: &[f64], out: &mut Vec<f64>) {
        self.solve(t, x);
        out.clear();
        out.extend(self.shows.iter().map(|shows| self.value(*shows, t, x)));
    }
}
