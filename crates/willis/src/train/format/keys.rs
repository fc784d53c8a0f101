//! What the keys of a train file are made of; the keys themselves are declared with the
//! [specification](crate::train::specification).

use crate::units::Dimension;

/// What kind of value a key takes.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Kind {
    /// The format number.
    Format,
    Text,
    /// A member, shift element or state, by name.
    Name,
    Names,
    /// A list of names, or of `{ name, member }`.
    Terminals,
    Integer,
    /// A number of rows.
    Samples,
    Flag,
    Choice(&'static [&'static str]),
    /// A number, or `{ forward, backward }`.
    Efficiency,
    /// A number, `{ forward, backward }`, or `{ external, internal }` with either of those.
    SetEfficiency,
    /// Of a machine: a number, `{ motoring, generating }`, or `{ map }` with the name of a file.
    MachineEfficiency,
    /// A power or the word "free", or these by the names of variators.
    Store,
    /// A plain number.
    Number,
    /// A number with a unit.
    Quantity(Dimension),
    /// Member name to quantity.
    Quantities(Dimension),
    /// A list of pairs.
    Points([Measure; 2]),
    /// A plain number, or points of it over a quantity.
    NumberOrPoints(Dimension),
    /// A list of times and names.
    Schedule,
    /// A value over time. Signals contain signals, so they are named by what makes their description.
    Signal(fn() -> &'static SignalKind),
    /// Two signals.
    Product([fn() -> &'static SignalKind; 2]),
    Table(&'static Table),
    /// `[[key]]`, or a list of inline tables; with the least number of entries.
    Tables(&'static Table, usize),
    /// Like `Tables`, the table depending on the entry's `type` (the first is the default).
    Variants(&'static [TypedTable]),
}

/// The word for a store that gives whatever balances its bus.
pub(crate) const FREE: &str = "free";

/// The dimension of a quantity; `None` for a plain number.
pub(crate) type Measure = Option<Dimension>;

/// A table and the `type` that means it.
pub(crate) type TypedTable = (&'static str, &'static Table);

/// What a value over time may be: a constant, or a table by its `type`.
#[derive(Debug)]
pub(crate) struct SignalKind {
    pub of: Measure,
    pub types: &'static [TypedTable],
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Key {
    pub name: &'static str,
    pub kind: Kind,
    pub required: bool,
    pub doc: &'static str,
}

#[derive(Debug)]
pub(crate) struct Table {
    pub doc: &'static str,
    /// Its keys, those that several tables share in groups of their own.
    pub groups: &'static [&'static [Key]],
}

impl Table {
    pub fn keys(&self) -> impl Iterator<Item = &'static Key> + Clone + use<> {
        self.groups.iter().copied().flatten()
    }

    pub fn key(&self, name: &str) -> Option<&'static Key> {
        self.keys().find(|k| k.name == name)
    }
}

/// What a doc comment says first, on one line.
pub(crate) fn about(doc: &str) -> String {
    let first = doc.lines().map(str::trim).take_while(|l| !l.is_empty());
    first.collect::<Vec<_>>().join(" ")
}
