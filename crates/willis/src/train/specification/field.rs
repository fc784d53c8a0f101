//! How a type of a specification is read from a train file and written into one.
//!
//! A key of the file stands in one line of [`specification!`]: its name, its type and what it means. The type tells the
//! kind of value that the reader accepts, and both ways between the file and the field.

use crate::exact::Rational;
use crate::train::format::keys::{Kind, Measure, Table};
use crate::train::format::{Amount, Datum, Fields, Node};
use crate::units::*;

use super::written::written;

/// A type of a key's value.
pub(crate) trait Field: Sized {
    /// What the file has for it.
    const KIND: Kind;
    /// The same for calculations: quantities as numbers in SI units.
    type Plain;
    /// The value that the reader found.
    fn read(node: &Node) -> Self;
    /// What stands for a required value that is missing; that was reported.
    fn blank() -> Self;
    /// What the file gets; nothing where there is nothing to say.
    fn write(&self) -> Option<Datum>;
    fn plain(&self) -> Self::Plain;
}

/// A type that is a table of keys.
pub(crate) trait Tabular: Sized {
    const KEYS: &'static [crate::train::format::keys::Key];
    const TABLE: &'static Table;
    type Twin;
    fn read_fields(fields: &Fields) -> Self;
    fn write_fields(&self, table: &mut Vec<(String, Datum)>);
    fn twin(&self) -> Self::Twin;
}

/// A number with a unit, or a plain one.
pub(crate) trait Measured: Clone + PartialEq {
    const MEASURE: Measure;
    fn of(amount: &Amount) -> Self;
    fn datum(&self) -> Datum;
    fn number(&self) -> f64;
}

impl Fields {
    /// The value of a key, as a type that reads its kind.
    pub fn get<T: Field>(&self, key: &str) -> T {
        self.0.get(key).map_or_else(T::blank, T::read)
    }

    /// The value of a key that is there.
    pub fn node(&self, key: &str) -> &Node {
        &self.0[key]
    }
}

fn other(node: &Node) -> ! {
    unreachable!("the reader keeps to the kind of a key, here is {node:?}")
}

impl Measured for f64 {
    const MEASURE: Measure = None;
    fn of(amount: &Amount) -> Self {
        match amount {
            Amount::Number(x) => x.to_f64(),
            Amount::Quantity(_) => unreachable!("the reader keeps to the measure of a key"),
        }
    }
    fn datum(&self) -> Datum {
        Datum::Number(*self)
    }
    fn number(&self) -> f64 {
        *self
    }
}

/// A large table that few entries have takes the room of a pointer in the others.
impl<T: Field> Field for Box<T> {
    const KIND: Kind = T::KIND;
    type Plain = T::Plain;
    fn read(node: &Node) -> Self {
        Self::new(T::read(node))
    }
    fn blank() -> Self {
        Self::new(T::blank())
    }
    fn write(&self) -> Option<Datum> {
        T::write(self)
    }
    fn plain(&self) -> Self::Plain {
        T::plain(self)
    }
}

macro_rules! measured {
    ($($name:ident $dimension:ident),* $(,)?) => {$(
        impl Measured for $name {
            const MEASURE: Measure = Some(Dimension::$dimension);
            fn of(amount: &Amount) -> Self {
                match amount {
                    Amount::Quantity(q) => Self(q.clone()),
                    Amount::Number(_) => unreachable!("the reader keeps to the measure of a key"),
                }
            }
            fn datum(&self) -> Datum {
                Datum::Text(written(&self.0))
            }
            fn number(&self) -> f64 {
                self.si()
            }
        }

        impl Field for $name {
            const KIND: Kind = Kind::Quantity(Dimension::$dimension);
            type Plain = f64;
            fn read(node: &Node) -> Self {
                match node {
                    Node::Amount(amount) => Self::of(amount),
                    node => other(node),
                }
            }
            fn blank() -> Self {
                Self::exact(Rational::ZERO)
            }
            fn write(&self) -> Option<Datum> {
                Some(self.datum())
            }
            fn plain(&self) -> f64 {
                self.si()
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.pad(&written(&self.0))
            }
        }
    )*};
}

measured!(
    AngularSpeed ANGULAR_SPEED,
    Torque TORQUE,
    Power POWER,
    Length LENGTH,
    Angle ANGLE,
    Temperature TEMPERATURE,
    Force FORCE,
    Mass MASS,
    Volume VOLUME,
    Density DENSITY,
    Pressure PRESSURE,
    PressureCoefficient PRESSURE_COEFFICIENT,
    KinematicViscosity KINEMATIC_VISCOSITY,
    DynamicViscosity DYNAMIC_VISCOSITY,
    Time TIME,
    Frequency FREQUENCY,
    Area AREA,
    MomentOfInertia INERTIA,
    Stiffness STIFFNESS,
    ViscousCoefficient VISCOUS,
    TorquePerAcceleration TORQUE_PER_ACCELERATION,
    TorquePerSpeedSquared TORQUE_PER_SPEED_SQUARED,
    Conductance CONDUCTANCE,
    HeatTransfer HEAT_TRANSFER,
    HeatCapacity HEAT_CAPACITY,
    SpecificHeat SPECIFIC_HEAT,
    VolumeFlow FLOW,
    Speed SPEED,
);

/// Fields whose value is one kind of node.
macro_rules! field {
    ({$($generic:ident: $bound:ident),*} $type:ty, $kind:expr, $pattern:pat => $read:expr, $blank:expr,
     $plain:ty, |$self:ident| $write:expr, $to_plain:expr) => {
        impl<$($generic: $bound),*> Field for $type {
            const KIND: Kind = $kind;
            type Plain = $plain;
            fn read(node: &Node) -> Self {
                match node {
                    $pattern => $read,
                    node => other(node),
                }
            }
            fn blank() -> Self {
                $blank
            }
            fn write(&self) -> Option<Datum> {
                let $self = self;
                $write
            }
            fn plain(&self) -> $plain {
                let $self = self;
                $to_plain
            }
        }
    };
}

fn names(all: &[String]) -> Datum {
    Datum::List(all.iter().cloned().map(Datum::Text).collect())
}

fn pair(first: Datum, second: Datum) -> Datum {
    Datum::List(vec![first, second])
}

/// Nothing for an empty list.
fn list(all: Vec<Datum>) -> Option<Datum> {
    (!all.is_empty()).then_some(Datum::List(all))
}

pub(super) fn table<T: Tabular>(value: &T) -> Datum {
    let mut all = vec![];
    value.write_fields(&mut all);
    Datum::Table(all)
}

field!({} String, Kind::Text, Node::Text(t) => t.clone(), String::new(), String,
       |s| Some(Datum::Text(s.clone())), s.clone());
field!({} i64, Kind::Integer, Node::Integer(i) => *i, 0, i64, |i| Some(Datum::Integer(*i)), *i);
field!({} f64, Kind::Number, Node::Amount(x) => f64::of(x), 0.0, f64, |x| Some(x.datum()), *x);
// What is not so need not be said.
field!({} bool, Kind::Flag, Node::Flag(b) => *b, false, bool, |b| b.then_some(Datum::Flag(true)), *b);
field!({} Vec<String>, Kind::Names, Node::Names(n) => n.clone(), vec![], Vec<String>, |n| (!n.is_empty()).then(|| names(n)), n.clone());
field!({T: Tabular} Vec<T>, Kind::Tables(T::TABLE, 0), Node::Tables(all) => all.iter().map(T::read_fields).collect(),
       vec![], Vec<T::Twin>, |all| list(all.iter().map(table).collect()), all.iter().map(T::twin).collect());
field!({Q: Measured} Vec<(String, Q)>, Kind::Quantities(dimension::<Q>()),
       Node::Quantities(all) => all.iter().map(|(name, q)| (name.clone(), Q::of(&Amount::Quantity(q.clone())))).collect(),
       vec![], Vec<(String, f64)>,
       |all| (!all.is_empty()).then(|| Datum::Table(all.iter().map(|(n, q)| (n.clone(), q.datum())).collect())),
       all.iter().map(|(name, q)| (name.clone(), q.number())).collect());
field!({A: Measured, B: Measured} Vec<(A, B)>, Kind::Points([A::MEASURE, B::MEASURE]),
       Node::Points(all) => all.iter().map(|[a, b]| (A::of(a), B::of(b))).collect(),
       vec![], Vec<[f64; 2]>,
       |all| Some(Datum::List(all.iter().map(|(a, b)| pair(a.datum(), b.datum())).collect())),
       all.iter().map(|(a, b)| [a.number(), b.number()]).collect());
field!({} Vec<(Time, String)>, Kind::Schedule, Node::Schedule(all) => {
           all.iter().map(|(t, s)| (Time::of(&Amount::Quantity(t.clone())), s.clone())).collect()
       },
       vec![], Vec<(f64, String)>,
       |all| Some(Datum::List(all.iter().map(|(t, s)| pair(t.datum(), Datum::Text(s.clone()))).collect())),
       all.iter().map(|(t, s)| (t.si(), s.clone())).collect());

const fn dimension<Q: Measured>() -> Dimension {
    match Q::MEASURE {
        Some(dimension) => dimension,
        None => panic!("only quantities stand in a table of names"),
    }
}

impl<T: Field> Field for Option<T> {
    const KIND: Kind = T::KIND;
    type Plain = Option<T::Plain>;
    fn read(node: &Node) -> Self {
        Some(T::read(node))
    }
    fn blank() -> Self {
        None
    }
    fn write(&self) -> Option<Datum> {
        // A table that is there and empty says so.
        self.as_ref().map(|value| value.write().unwrap_or(Datum::List(vec![])))
    }
    fn plain(&self) -> Self::Plain {
        self.as_ref().map(T::plain)
    }
}

/// Names of a few choices: `choice!(Type { Variant = "name", … })`.
macro_rules! choice {
    ($type:ty { $($variant:ident = $name:literal),+ $(,)? }) => {
        impl crate::train::specification::field::Field for $type {
            const KIND: crate::train::format::keys::Kind = crate::train::format::keys::Kind::Choice(&[$($name),+]);
            type Plain = Self;
            fn read(node: &crate::train::format::Node) -> Self {
                match node {
                    $(crate::train::format::Node::Text(t) if t == $name => Self::$variant,)+
                    node => unreachable!("the reader keeps to the choices of a key, here is {node:?}"),
                }
            }
            fn blank() -> Self {
                [$(Self::$variant),+][0]
            }
            fn write(&self) -> Option<crate::train::format::Datum> {
                let name = match self {
                    $(Self::$variant => $name,)+
                };
                Some(crate::train::format::Datum::Text(name.to_owned()))
            }
            fn plain(&self) -> Self {
                *self
            }
        }
    };
}
pub(super) use choice;

/// A table of the train file, with its keys, as a type: `must` or `may` be given, the field of that name, its type (and
/// its kind where the type has several), and what it means, in the file's schema as in the type's documentation. What
/// stands behind `..` are the keys of another table among its own.
macro_rules! specification {
    ($(
        $(#[doc = $doc:literal])+
        $name:ident => $twin:ident {
            $($(#[doc = $about:literal])+ $need:ident $field:ident: $type:ty $(as $kind:expr)?,)*
            $(..$flat:ident: $flat_type:ty,)*
        }
    )+) => {$(
        $(#[doc = $doc])+
        #[derive(Clone, Debug, PartialEq)]
        pub struct $name {
            $($(#[doc = $about])+ pub $field: $type,)*
            $(#[doc = concat!("The keys of [`", stringify!($flat_type), "`] among the others.")] pub $flat: $flat_type,)*
        }

        #[doc = concat!("[`", stringify!($name), "`] with all quantities as numbers in SI units.")]
        #[derive(Clone, Debug, PartialEq)]
        // What is checked as the specification has it is not read here.
        #[allow(dead_code)]
        pub(crate) struct $twin {
            $($(#[doc = $about])+ pub $field: <$type as crate::train::specification::field::Field>::Plain,)*
            $(#[doc = concat!("The keys of [`", stringify!($flat_type), "`] among the others.")] pub $flat: <$flat_type as crate::train::specification::field::Tabular>::Twin,)*
        }

        impl crate::train::specification::field::Tabular for $name {
            const KEYS: &'static [crate::train::format::keys::Key] = &[
                $(crate::train::format::keys::Key {
                    name: stringify!($field),
                    kind: crate::train::specification::field::specification!(
                        @kind $type $(, $kind)?
                    ),
                    required: crate::train::specification::field::specification!(@$need),
                    doc: concat!($($about, "\n"),+),
                },)*
            ];
            const TABLE: &'static crate::train::format::keys::Table = &crate::train::format::keys::Table {
                doc: concat!($($doc, "\n"),+),
                groups: &[
                    <Self as crate::train::specification::field::Tabular>::KEYS,
                    $(<$flat_type as crate::train::specification::field::Tabular>::KEYS,)*
                ],
            };
            type Twin = $twin;
            fn read_fields(fields: &crate::train::format::Fields) -> Self {
                Self {
                    $($field: fields.get(stringify!($field)),)*
                    $($flat: <$flat_type as crate::train::specification::field::Tabular>::read_fields(fields),)*
                }
            }
            fn write_fields(&self, table: &mut Vec<(String, crate::train::format::Datum)>) {
                $(
                    let written = crate::train::specification::field::Field::write(&self.$field);
                    let written = crate::train::specification::field::specification!(@written $need written);
                    table.extend(written.map(|w| (stringify!($field).to_owned(), w)));
                )*
                $(self.$flat.write_fields(table);)*
            }
            fn twin(&self) -> $twin {
                $twin {
                    $($field: crate::train::specification::field::Field::plain(&self.$field),)*
                    $($flat: self.$flat.twin(),)*
                }
            }
        }

        impl Default for $name {
            /// Nothing given: what must be is empty or zero.
            fn default() -> Self {
                Self {
                    $($field: <$type as crate::train::specification::field::Field>::blank(),)*
                    $($flat: <$flat_type>::default(),)*
                }
            }
        }

        crate::train::specification::field::in_tables!($name => $twin);
    )+};
    // What must be there says so where it is empty.
    (@written must $written:ident) => { Some($written.unwrap_or(crate::train::format::Datum::List(vec![]))) };
    (@written may $written:ident) => { $written };
    (@must) => { true };
    (@may) => { false };
    (@kind $type:ty) => { <$type as crate::train::specification::field::Field>::KIND };
    (@kind $type:ty, $kind:expr) => { $kind };
}
pub(super) use specification;

/// A table as a value of a key, and by serde.
macro_rules! in_tables {
    ($name:ty => $twin:ty) => {
        impl crate::train::specification::field::Field for $name {
            const KIND: crate::train::format::keys::Kind =
                crate::train::format::keys::Kind::Table(<Self as crate::train::specification::field::Tabular>::TABLE);
            type Plain = $twin;
            fn read(node: &crate::train::format::Node) -> Self {
                match node {
                    crate::train::format::Node::Table(fields) => {
                        <Self as crate::train::specification::field::Tabular>::read_fields(fields)
                    }
                    node => unreachable!("the reader keeps to the kind of a key, here is {node:?}"),
                }
            }
            fn blank() -> Self {
                Self::default()
            }
            fn write(&self) -> Option<crate::train::format::Datum> {
                Some(crate::train::specification::field::table(self))
            }
            fn plain(&self) -> $twin {
                crate::train::specification::field::Tabular::twin(self)
            }
        }

        impl serde::Serialize for $name {
            /// In the shape of the train file.
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                crate::train::specification::field::table(self).serialize(serializer)
            }
        }

        impl<'de> serde::Deserialize<'de> for $name {
            /// From the shape of the train file, with the checks of its reader.
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                let datum = crate::train::format::Datum::deserialize(deserializer)?;
                let fields =
                    crate::train::format::fields(&datum, <Self as crate::train::specification::field::Tabular>::TABLE);
                let fields = fields.map_err(serde::de::Error::custom)?;
                Ok(<Self as crate::train::specification::field::Tabular>::read_fields(&fields))
            }
        }
    };
}
pub(super) use in_tables;
