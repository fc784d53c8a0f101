//! The second path of a power split, as checked data: two electric machines, a hydrostatic pump and motor, a belt.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::exact::Rational;
use crate::real::{self, Real};
use crate::units::Quantity;

use super::{Efficiency, MemberId};

/// What a variator is made of; it gives words and pictures, the mechanics is the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum VariatorKind {
    /// Electric machines.
    #[default]
    Electric,
    /// Hydrostatic pumps and motors.
    Hydrostatic,
    /// A belt, a chain or a toroid: two shafts that rub on each other.
    Belt,
}

impl fmt::Display for VariatorKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Electric => "electric",
            Self::Hydrostatic => "hydrostatic",
            Self::Belt => "belt",
        })
    }
}

/// A way for power between shafts beside the gears, with any ratio.
#[derive(Clone, Debug, PartialEq)]
pub struct Variator {
    /// Its name.
    pub name: String,
    /// What it is made of.
    pub kind: VariatorKind,
    /// How it is described.
    pub path: VariatorPath,
    pub(crate) place: String,
}

/// How a variator is described.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum VariatorPath {
    /// Two members and what is lost between them.
    Direct {
        /// The two members.
        members: [MemberId; 2],
        /// Forward: the first member delivers power to the second.
        efficiency: Efficiency,
        /// Least and greatest `ω_first/ω_second`, where they are limited.
        ratio: [Option<f64>; 2],
    },
    /// Machines that exchange power on a bus.
    Bus {
        /// Two or more.
        machines: Vec<Machine>,
        /// Power out of a battery or an accumulator into the bus.
        store: Store,
        /// Power that is always taken from the bus and lost, W.
        standby: f64,
    },
}

/// What an operating point takes from the store of a bus.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Store {
    /// This power; zero where there is none.
    Power(Quantity),
    /// Whatever balances the bus.
    Free,
}

/// An electric machine, or a hydrostatic unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Machine {
    /// Its name.
    pub name: String,
    /// The member that it turns with.
    pub member: MemberId,
    /// What it loses.
    pub efficiency: MachineEfficiency,
    /// Most torque in either direction, N m.
    pub torque: Option<f64>,
    /// Most mechanical power in either direction, W.
    pub power: Option<f64>,
    /// Most speed in either direction, rad/s.
    pub speed: Option<f64>,
}

/// What a machine loses.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum MachineEfficiency {
    /// The same everywhere. Forward: it motors. Backward: it generates.
    Constant(Efficiency),
    /// By speed and torque.
    Map(EfficiencyMap),
}

/// Efficiency of a machine over the amount of its speed and its torque, on a grid; between its points it is bilinear.
///
/// Torque with a sign (that of its power) tells motoring from generating; a map with positive torques only holds for
/// both.
#[derive(Clone, Debug, PartialEq)]
pub struct EfficiencyMap {
    /// The table that it came from.
    pub(crate) file: String,
    /// rad/s, rising.
    pub(crate) speeds: Vec<f64>,
    /// N m, rising.
    pub(crate) torques: Vec<f64>,
    /// By speed, then torque.
    pub(crate) values: Vec<f64>,
}

impl EfficiencyMap {
    /// The efficiency at an amount of speed and a torque that is positive where the machine motors; and whether the
    /// point lies outside the map, where its edge is taken.
    pub(crate) fn at<R: Real>(&self, speed: R, torque: R) -> (R, bool) {
        let torque = if self.torques[0] >= 0.0 { real::abs(torque) } else { torque };
        let ((i, u), (j, v)) = (place(&self.speeds, speed), place(&self.torques, torque));
        let at = |i: usize, j: usize| {
            self.values[i.min(self.speeds.len() - 1) * self.torques.len() + j.min(self.torques.len() - 1)]
        };
        let along = |i: usize| v * (at(i, j + 1) - at(i, j)) + at(i, j);
        // Below the least torque or speed of a map little power is passed, and its edge is all that is known.
        let outside = speed.re() > self.speeds[self.speeds.len() - 1]
            || torque.re().abs() > self.torques[0].abs().max(self.torques[self.torques.len() - 1].abs());
        (along(i) + (along(i + 1) - along(i)) * u, outside)
    }

    /// The greatest efficiency of the map: where the search for the operating point begins.
    pub(crate) fn best(&self) -> f64 {
        self.values.iter().copied().fold(0.0, f64::max)
    }
}

/// The interval of rising points that holds `x`, and how far along it; the ends hold what lies beyond them.
fn place<R: Real>(points: &[f64], x: R) -> (usize, R) {
    let above = points.partition_point(|p| *p <= x.re());
    if above == 0 {
        return (0, R::from(0.0));
    }
    if above == points.len() {
        return (points.len() - 1, R::from(0.0));
    }
    let (a, b) = (points[above - 1], points[above]);
    (above - 1, (x + -a) * (1.0 / (b - a)))
}

impl Variator {
    /// The members that it acts on, in order.
    pub fn members(&self) -> Vec<MemberId> {
        match &self.path {
            VariatorPath::Direct { members, .. } => members.to_vec(),
            VariatorPath::Bus { machines, .. } => machines.iter().map(|m| m.member).collect(),
        }
    }

    /// Whether its machines meet on a bus.
    pub(crate) fn has_bus(&self) -> bool {
        matches!(self.path, VariatorPath::Bus { .. })
    }

    /// Its machines; none of one that is described as a whole.
    pub fn machines(&self) -> &[Machine] {
        match &self.path {
            VariatorPath::Direct { .. } => &[],
            VariatorPath::Bus { machines, .. } => machines,
        }
    }

    /// Whether what it loses depends on speed and load, or is there without load.
    pub(crate) fn is_computed(&self) -> bool {
        match &self.path {
            VariatorPath::Direct { .. } => false,
            VariatorPath::Bus { machines, standby, .. } => {
                *standby > 0.0 || machines.iter().any(|m| matches!(m.efficiency, MachineEfficiency::Map(_)))
            }
        }
    }
}

impl MachineEfficiency {
    /// The efficiency where a machine exerts a torque, N m, at a speed, rad/s; and whether that lies outside its map, whose
    /// edge is taken there.
    pub(crate) fn at(&self, torque: f64, speed: f64) -> (f64, bool) {
        match self {
            Self::Constant(e) => ((if torque * speed > 0.0 { &e.forward } else { &e.backward }).to_f64(), false),
            Self::Map(map) => map.at(speed.abs(), if torque * speed < 0.0 { -torque.abs() } else { torque.abs() }),
        }
    }

    /// The values from which an operating point starts.
    pub(crate) fn nominal(&self) -> Efficiency {
        match self {
            Self::Constant(e) => e.clone(),
            Self::Map(map) => {
                let best = Rational::from_f64(map.best()).unwrap_or(Rational::ONE);
                Efficiency { forward: best.clone(), backward: best }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_map_is_bilinear_within_and_its_edge_without() {
        let map = EfficiencyMap {
            file: "m.csv".into(),
            speeds: vec![0.0, 100.0],
            torques: vec![0.0, 10.0],
            values: vec![0.5, 0.7, 0.8, 0.9],
        };
        for (speed, torque, value, outside) in [
            (0.0, 0.0, 0.5, false),
            (50.0, 5.0, 0.725, false),
            (50.0, -5.0, 0.725, false),
            (100.0, 10.0, 0.9, false),
            (200.0, 10.0, 0.9, true),
            (50.0, 20.0, 0.8, true),
        ] {
            let (found, out) = map.at(speed, torque);
            assert!((found - value).abs() < 1e-12 && out == outside, "{speed} {torque}: {found} {out}");
        }
        let signed = EfficiencyMap { torques: vec![-10.0, 10.0], ..map };
        assert!((signed.at(0.0, -10.0).0 - 0.5).abs() < 1e-12 && (signed.at(0.0, 10.0).0 - 0.7).abs() < 1e-12);
    }
}
