//! What can be read of a run: the columns of its rows.

use crate::units::with_unit;

use super::element::element_name;
use super::report::{Column, ColumnKind, EnergyLossKind};
use super::system::{MachineDoes, PathKind, Rubs, System};

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
    Reaction(usize),
    /// Ratio of a variator.
    Ratio(usize),
    /// Torque of a side of a variator, and power into its member.
    SideTorque(usize, usize),
    SidePower(usize, usize),
    /// Power out of the store of a variator.
    Store(usize),
    Loss,
    Stored,
    Lost,
    Efficiency,
    /// Temperature of a place of the thermal network.
    Temperature(usize),
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
        let rubs = (0..s.frictions.len()).filter(|&k| {
            !s.frictions[k].open && !matches!(s.frictions[k].what, Rubs::Rolling(_) | Rubs::Variator(_) | Rubs::Trace)
        });
        std::iter::once(Self::Time)
            .chain(members.clone().map(Self::Speed))
            .chain(members.clone().map(Self::Angle))
            .chain(members.map(Self::Acceleration))
            .chain(sources.clone().map(Self::SourceTorque))
            .chain(sources.map(Self::SourcePower))
            .chain(rubs.map(Self::FrictionTorque))
            .chain(shafts.flat_map(|k| [Self::ShaftTorque(k), Self::Twist(k)]))
            .chain((0..s.paths.len()).flat_map(|k| Self::of_path(s, k)))
            .chain((0..s.train.meshes().len()).map(Self::MeshTorque))
            .chain((0..s.reactions.len()).map(Self::Reaction))
            .chain([Self::Loss, Self::Stored, Self::Lost, Self::Efficiency])
            .chain(Moves::all(s).into_iter().map(Self::Mode))
            .collect()
    }

    /// What there is to read of a variator: machines that are sources are read there.
    fn of_path(s: &System, k: usize) -> Vec<Self> {
        match &s.paths[k].kind {
            PathKind::Geared(_) => {
                vec![Self::Ratio(k), Self::SideTorque(k, 0), Self::SideTorque(k, 1), Self::SidePower(k, 1)]
            }
            PathKind::Pushed { .. } => vec![Self::SideTorque(k, 0), Self::SideTorque(k, 1), Self::SidePower(k, 1)],
            PathKind::Bus { machines, .. } => {
                let balances =
                    (machines.iter().enumerate()).filter(|(_, m)| matches!(m.does, MachineDoes::Balances(_)));
                let of = balances.flat_map(|(side, _)| [Self::SideTorque(k, side), Self::SidePower(k, side)]);
                of.chain([Self::Store(k)]).collect()
            }
        }
    }

    /// Its column.
    pub fn column(self, s: &System) -> Column {
        let member = |m: usize| s.train.members()[m].name.clone();
        let source = |k: usize| s.scenario.sources[k].name.clone();
        let variator = |k: usize| &s.train.variators[s.paths[k].variator];
        let side = |k: usize, side: usize| match variator(k).machines().get(side) {
            Some(machine) => machine.name.clone(),
            None => format!("{}.{}", variator(k).name, s.train.member_name(variator(k).members()[side])),
        };
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
            Self::Reaction(k) => (ColumnKind::Reaction, member(s.reactions[k].member.index())),
            Self::Ratio(k) => (ColumnKind::Ratio, variator(k).name.clone()),
            Self::SideTorque(k, at) => (ColumnKind::Torque, side(k, at)),
            Self::SidePower(k, at) => (ColumnKind::Power, side(k, at)),
            Self::Store(k) => (ColumnKind::Power, format!("store of {}", variator(k).name)),
            Self::Loss => (ColumnKind::Power, String::new()),
            Self::Stored | Self::Lost => (ColumnKind::Energy, String::new()),
            Self::Efficiency => (ColumnKind::Efficiency, String::new()),
            Self::Temperature(k) => {
                (ColumnKind::Temperature, s.train.heat().map_or(String::new(), |h| h.nodes[k].name.clone()))
            }
            Self::Mode(moves) => (ColumnKind::Mode, moves.name(s)),
        };
        let quantity = match self {
            Self::Time => "time".to_owned(),
            Self::Loss => "loss".to_owned(),
            Self::Stored => "stored_energy".to_owned(),
            Self::Lost => "lost_energy".to_owned(),
            Self::Efficiency => "efficiency".to_owned(),
            Self::Store(k) => format!("{}.store", variator(k).name),
            _ => format!("{of}.{}", kind.name()),
        };
        let name = with_unit(&quantity, kind.unit().symbol());
        Column { name, unit: kind.unit(), kind, of }
    }
}

impl Moves {
    pub fn all(s: &System) -> Vec<Self> {
        let of_friction = |&k: &usize| {
            let f = &s.frictions[k];
            match f.what {
                Rubs::Law(_) => {
                    // It can hold, and its slip is not told of by another of its group.
                    let kind = s.loss_kind(k);
                    let group = f.group.map(|(g, _)| &s.groups[g]);
                    matches!(kind, Some(EnergyLossKind::Bearing | EnergyLossKind::Seal))
                        && group.is_some_and(|g| g.elements.is_empty() && g.frictions[0] == k)
                }
                Rubs::Shift(_) => true,
                Rubs::Variator(_) => false,
                Rubs::Drag(_) | Rubs::Rolling(_) | Rubs::Trace => f.group.is_some(),
            }
        };
        let elements = (0..s.elements.len()).filter(|&j| s.elements[j].group.is_some());
        let shafts = (0..s.elastic.len()).filter(|&k| s.train.shafts()[k].backlash > 0.0);
        let frictions = (0..s.frictions.len()).filter(of_friction);
        (frictions.map(Self::Friction)).chain(elements.map(Self::Element)).chain(shafts.map(Self::Shaft)).collect()
    }

    pub fn name(self, s: &System) -> String {
        match self {
            Self::Friction(k) => s.frictions[k].name.clone(),
            Self::Element(j) => element_name(&s.train, &s.elements[j].links),
            Self::Shaft(k) => s.train.shafts()[k].name.clone(),
        }
    }
}
