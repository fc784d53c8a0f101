//! Rows of a study, column by column.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use crate::units::without_unit;

use super::summary::Summary;

/// What the values of a column are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum ColumnKind {
    /// Real numbers; there may be none in a row.
    Number,
    /// Whole numbers.
    Integer,
    /// Texts; empty where there is none.
    Text,
}

/// A column of the rows of a study.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Column {
    /// Its name, with the unit at its end: `sun.torque_n_m`.
    pub name: String,
    /// Its unit, `N m`; empty where it has none.
    pub unit: String,
    /// What its values are.
    pub kind: ColumnKind,
}

impl Column {
    /// Whether that is its name, or its name without the unit: `sun.torque_n_m`, `sun.torque`.
    pub fn is_called(&self, name: &str) -> bool {
        self.name == name || without_unit(&self.name, &self.unit) == name
    }

    pub(super) fn number(name: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { name: name.into(), unit: unit.into(), kind: ColumnKind::Number }
    }

    pub(super) fn integer(name: impl Into<String>) -> Self {
        Self { name: name.into(), unit: String::new(), kind: ColumnKind::Integer }
    }

    pub(super) fn text(name: impl Into<String>) -> Self {
        Self { name: name.into(), unit: String::new(), kind: ColumnKind::Text }
    }
}

/// The values of a column, one a row.
#[derive(Clone, Debug, PartialEq)]
pub enum ColumnValues {
    /// Real numbers; NaN where there is none.
    Numbers(Vec<f64>),
    /// Whole numbers.
    Integers(Vec<i64>),
    /// Texts; empty where there is none.
    Texts(Vec<Cow<'static, str>>),
}

impl ColumnValues {
    /// None yet, with room for so many.
    pub(super) fn with_capacity(kind: ColumnKind, rows: usize) -> Self {
        match kind {
            ColumnKind::Number => Self::Numbers(Vec::with_capacity(rows)),
            ColumnKind::Integer => Self::Integers(Vec::with_capacity(rows)),
            ColumnKind::Text => Self::Texts(Vec::with_capacity(rows)),
        }
    }

    /// What the values are.
    pub fn kind(&self) -> ColumnKind {
        match self {
            Self::Numbers(_) => ColumnKind::Number,
            Self::Integers(_) => ColumnKind::Integer,
            Self::Texts(_) => ColumnKind::Text,
        }
    }

    /// How many rows there are.
    pub fn len(&self) -> usize {
        match self {
            Self::Numbers(all) => all.len(),
            Self::Integers(all) => all.len(),
            Self::Texts(all) => all.len(),
        }
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Adds the rows that follow.
    fn append(&mut self, mut later: Self) {
        match (self, &mut later) {
            (Self::Numbers(all), Self::Numbers(more)) => all.append(more),
            (Self::Integers(all), Self::Integers(more)) => all.append(more),
            (Self::Texts(all), Self::Texts(more)) => all.append(more),
            _ => unreachable!("rows of one study have the same columns"),
        }
    }
}

/// A table of a study, column by column.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct ColumnTable {
    /// What the columns are.
    pub columns: Vec<Column>,
    /// The values of each column; all have as many rows.
    pub values: Vec<ColumnValues>,
}

impl ColumnTable {
    /// How many rows there are.
    pub fn len(&self) -> usize {
        self.values.first().map_or(0, ColumnValues::len)
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Adds a column.
    pub(super) fn add(&mut self, column: Column, values: ColumnValues) {
        self.columns.push(column);
        self.values.push(values);
    }

    /// The values of the column of that name.
    pub fn get(&self, name: &str) -> Option<&ColumnValues> {
        let k = self.columns.iter().position(|c| c.name == name)?;
        self.values.get(k)
    }
}

/// Some rows of a study, column by column.
#[derive(Clone, Debug, PartialEq)]
pub struct Rows {
    /// One for each column.
    pub columns: Vec<ColumnValues>,
    /// What they say together.
    pub summary: Summary,
}

impl Rows {
    /// None yet, with room for so many.
    pub(super) fn with_capacity<'a>(columns: impl Iterator<Item = &'a Column>, rows: usize) -> Self {
        Self {
            columns: columns.map(|c| ColumnValues::with_capacity(c.kind, rows)).collect(),
            summary: Summary::default(),
        }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.columns.first().map_or(0, ColumnValues::len)
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Adds the rows that follow, of the same study.
    ///
    /// # Panics
    /// If they have other columns.
    pub fn append(&mut self, later: Self) {
        assert_eq!(self.columns.len(), later.columns.len(), "rows of one study have the same columns");
        self.columns.iter_mut().zip(later.columns).for_each(|(all, more)| all.append(more));
        self.summary.join(&later.summary);
    }
}
