//! Variators of a specification: members and an efficiency, or machines on a bus.

use crate::exact::Rational;
use crate::train::format::keys::{FREE, Kind};
use crate::train::format::{Datum, Node};
use crate::train::variator::VariatorKind;
use crate::units::{AngularSpeed, Power, Torque};

use super::EfficiencySpec;
use super::field::{Field, Measured, choice, specification};

choice!(VariatorKind { Electric = "electric", Hydrostatic = "hydrostatic", Belt = "belt" });

/// What a machine loses: one efficiency, one for motoring and one for generating, or a table over speed and torque.
#[derive(Clone, Debug, PartialEq)]
pub enum MachineEfficiencySpec {
    /// Forward: it motors. Backward: it generates.
    Constant(EfficiencySpec),
    /// A CSV file with the columns `speed [unit]`, `torque [unit]` and `efficiency`, a row for each point of a grid.
    Map(String),
}

impl From<f64> for MachineEfficiencySpec {
    fn from(value: f64) -> Self {
        Self::Constant(value.into())
    }
}

impl Field for MachineEfficiencySpec {
    const KIND: Kind = Kind::MachineEfficiency;
    type Plain = Self;
    fn read(node: &Node) -> Self {
        match node {
            Node::Text(file) => Self::Map(file.clone()),
            node => Self::Constant(EfficiencySpec::read(node)),
        }
    }
    fn blank() -> Self {
        Self::Constant(EfficiencySpec::blank())
    }
    fn write(&self) -> Option<Datum> {
        let number = |x: Option<&Rational>| x.map_or(Datum::Number(f64::NAN), Datum::exact);
        Some(match self {
            Self::Map(file) => Datum::Table(vec![("map".into(), Datum::Text(file.clone()))]),
            Self::Constant(e) if e.is_directed() => Datum::Table(vec![
                ("motoring".into(), number(e.forward())),
                ("generating".into(), number(e.backward())),
            ]),
            Self::Constant(e) => number(e.forward()),
        })
    }
    fn plain(&self) -> Self {
        self.clone()
    }
}

/// Powers out of stores, by the variator's name; an empty name is that of the only one. Without a power: whatever
/// balances the bus.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StoreSpec(pub Vec<(String, Option<Power>)>);

impl From<Power> for StoreSpec {
    fn from(power: Power) -> Self {
        Self(vec![(String::new(), Some(power))])
    }
}

impl StoreSpec {
    /// Whatever balances the bus of the only variator.
    pub fn free() -> Self {
        Self(vec![(String::new(), None)])
    }
}

impl Field for StoreSpec {
    const KIND: Kind = Kind::Store;
    type Plain = Self;
    fn read(node: &Node) -> Self {
        match node {
            Node::Stores(all) => {
                Self(all.iter().map(|(name, power)| (name.clone(), power.clone().map(Power))).collect())
            }
            node => unreachable!("the reader keeps to the kind of a key, here is {node:?}"),
        }
    }
    fn blank() -> Self {
        Self::default()
    }
    fn write(&self) -> Option<Datum> {
        let one = |power: &Option<Power>| power.as_ref().map_or(Datum::Text(FREE.into()), Measured::datum);
        match &self.0[..] {
            [] => None,
            [(name, power)] if name.is_empty() => Some(one(power)),
            all => Some(Datum::Table(all.iter().map(|(name, power)| (name.clone(), one(power))).collect())),
        }
    }
    fn plain(&self) -> Self {
        self.clone()
    }
}

specification! {
    /// Least and greatest ratio.
    RatioSpec => PlainRatio {
        /// Least speed of the first member over that of the second.
        may min: Option<f64>,
        /// Greatest speed of the first member over that of the second.
        may max: Option<f64>,
    }

    /// An electric machine or a hydrostatic unit on a bus.
    MachineSpec => PlainMachine {
        /// What it is called.
        must name: String,
        /// The member that it turns with. Default: the member of its name.
        may member: Option<String> as Kind::Name,
        /// One value, { motoring, generating }, or { map = "file.csv" } with columns `speed [rpm]`, `torque [N m]` and
        /// `efficiency`. Default: lossless, listed as an assumption.
        may efficiency: Option<MachineEfficiencySpec>,
        /// Most torque in either direction.
        may torque: Option<Torque>,
        /// Most mechanical power in either direction.
        may power: Option<Power>,
        /// Most speed in either direction.
        may speed: Option<AngularSpeed>,
    }

    /// A way for power between shafts beside the gears, at any ratio: `members` with an `efficiency`, or `machines` on a
    /// bus.
    VariatorSpec => PlainVariator {
        /// What it is called.
        must name: String,
        /// Gives words and pictures. Default: electric.
        may kind: Option<VariatorKind>,
        /// The two members that it joins.
        may members: Vec<String>,
        /// Power out over power in; or { forward, backward }: forward = the first member delivers power to the second.
        /// Default: lossless, listed as an assumption.
        may efficiency: Option<EfficiencySpec>,
        /// Limits of the speed of the first member over that of the second, of a belt for example.
        may ratio: Option<RatioSpec>,
        /// Machines on a bus, instead of `members`.
        may machines: Vec<MachineSpec>,
        /// Power out of the battery or accumulator into the bus, or "free" for whatever balances it; an operation may say
        /// its own. Default: none.
        may store: StoreSpec,
        /// Power that is always taken from the bus and lost.
        may standby: Option<Power>,
    }
}
