//! Tables: what CSV, JSON lines and Parquet are written from.

use std::fmt::Write as _;

use willis::study::{ColumnKind, ColumnTable, ColumnValues};

/// What the cells of a column are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Words.
    Text,
    /// Real numbers.
    Number,
    /// Whole numbers.
    Integer,
    /// True or false.
    Flag,
}

/// A column: its name, which ends with the unit where there is one, and what its cells are.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// As in the header, `torque_n_m`.
    pub name: String,
    /// The unit, `N m`; empty where the column has none.
    pub unit: String,
    /// What its cells are.
    pub kind: Kind,
}

/// A cell; a cell of any kind may be empty.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// There is no value.
    Empty,
    /// Words.
    Text(String),
    /// A real number, finite.
    Number(f64),
    /// A whole number.
    Integer(i64),
    /// True or false.
    Flag(bool),
}

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<String> for Cell {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

impl From<&String> for Cell {
    fn from(text: &String) -> Self {
        Self::Text(text.clone())
    }
}

impl From<f64> for Cell {
    fn from(x: f64) -> Self {
        if x.is_finite() { Self::Number(x) } else { Self::Empty }
    }
}

impl From<bool> for Cell {
    fn from(x: bool) -> Self {
        Self::Flag(x)
    }
}

macro_rules! integers {
    ($($type:ty),*) => {
        $(impl From<$type> for Cell {
            fn from(x: $type) -> Self {
                i64::try_from(x).map_or(Self::Empty, Self::Integer)
            }
        })*
    };
}

integers!(i8, u32, u64, usize);

impl<T: Into<Cell>> From<Option<T>> for Cell {
    fn from(x: Option<T>) -> Self {
        x.map_or(Self::Empty, Into::into)
    }
}

/// The word that the results contract uses.
pub(crate) fn word(x: &impl serde::Serialize) -> String {
    serde_json::to_value(x).ok().and_then(|v| v.as_str().map(str::to_owned)).unwrap_or_default()
}

/// Units by the end of a column's name, the longest ends first.
const UNITS: &[(&str, &str)] = &[
    ("_rad_s2", "rad/s^2"),
    ("_n_per_m", "N/m"),
    ("_rad_s", "rad/s"),
    ("_kg_m3", "kg/m^3"),
    ("_kg_m2", "kg m^2"),
    ("_m2_s", "m^2/s"),
    ("_n_m", "N m"),
    ("_m_s", "m/s"),
    ("_rad", "rad"),
    ("_pa", "Pa"),
    ("_hz", "Hz"),
    ("_w", "W"),
    ("_j", "J"),
    ("_k", "K"),
    ("_n", "N"),
    ("_m", "m"),
    ("_s", "s"),
];

/// A table of an answer: SI units, one row a thing.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// What it is called among the tables of its answer: `members`.
    pub name: String,
    /// The columns.
    pub columns: Vec<Column>,
    /// The rows, each with as many cells as there are columns.
    pub rows: Vec<Vec<Cell>>,
    /// Whether it is had only by its name, not among all tables of its answer: thousands of rows beside a few.
    pub is_aside: bool,
}

impl Table {
    /// An empty table.
    ///
    /// # Example
    /// ```
    /// use willis_ask::table::{Kind::{Number, Text}, Table};
    ///
    /// let mut table = Table::new("members", [("member", Text), ("torque_n_m", Number)]);
    /// table.row(["sun".into(), (-10.5).into()]);
    /// assert_eq!(table.columns[1].unit, "N m");
    /// assert_eq!(table.csv(), "member,torque_n_m\nsun,-10.5\n");
    /// ```
    pub fn new<'a>(name: &str, columns: impl IntoIterator<Item = (&'a str, Kind)>) -> Self {
        let columns = columns.into_iter().map(|(name, kind)| {
            let unit = UNITS.iter().find(|u| kind == Kind::Number && name.ends_with(u.0)).map_or("", |u| u.1);
            Column { name: name.to_owned(), unit: unit.to_owned(), kind }
        });
        Self { name: name.to_owned(), columns: columns.collect(), rows: vec![], is_aside: false }
    }

    /// The rows of a study.
    pub fn of_columns(name: &str, all: &ColumnTable) -> Self {
        let columns = all.columns.iter().map(|c| {
            let kind = match c.kind {
                ColumnKind::Number => Kind::Number,
                ColumnKind::Integer => Kind::Integer,
                _ => Kind::Text,
            };
            Column { name: c.name.clone(), unit: c.unit.clone(), kind }
        });
        let cell = |values: &ColumnValues, k: usize| match values {
            ColumnValues::Numbers(all) => all[k].into(),
            ColumnValues::Integers(all) => Cell::Integer(all[k]),
            ColumnValues::Texts(all) => Cell::Text(all[k].to_string()),
        };
        let row = |k: usize| all.values.iter().map(|v| cell(v, k)).collect();
        let rows = (0..all.len()).map(row).collect();
        Self { name: name.to_owned(), columns: columns.collect(), rows, is_aside: false }
    }

    /// The same, had only by its name.
    pub fn aside(self) -> Self {
        Self { is_aside: true, ..self }
    }

    /// Adds a row.
    ///
    /// # Panics
    /// If it has another number of cells than the table has columns.
    pub fn row(&mut self, cells: impl IntoIterator<Item = Cell>) {
        let cells: Vec<Cell> = cells.into_iter().collect();
        assert_eq!(cells.len(), self.columns.len(), "cells of a row of `{}`", self.name);
        self.rows.push(cells);
    }

    /// As CSV with a header, RFC 4180 with line feeds. An empty cell is an empty field.
    pub fn csv(&self) -> String {
        let mut out = String::new();
        line(&mut out, self.columns.iter(), |out, c| field(out, &c.name));
        for row in &self.rows {
            line(&mut out, row.iter(), |out, cell| match cell {
                Cell::Empty => {}
                Cell::Text(text) => field(out, text),
                Cell::Number(x) => number(out, *x),
                Cell::Integer(x) => drop(write!(out, "{x}")),
                Cell::Flag(x) => drop(write!(out, "{x}")),
            });
        }
        out
    }

    /// As JSON lines, an object a row. An empty cell is `null`.
    pub fn json_lines(&self) -> String {
        let text = |t: &str| serde_json::to_string(t).expect("a text");
        let mut out = String::new();
        for row in &self.rows {
            for (k, (column, cell)) in self.columns.iter().zip(row).enumerate() {
                out.push(if k == 0 { '{' } else { ',' });
                out += &text(&column.name);
                out.push(':');
                match cell {
                    Cell::Empty => out += "null",
                    Cell::Text(words) => out += &text(words),
                    Cell::Number(x) => number(&mut out, *x),
                    Cell::Integer(x) => drop(write!(out, "{x}")),
                    Cell::Flag(x) => drop(write!(out, "{x}")),
                }
            }
            out += "}\n";
        }
        out
    }
}

/// Several tables as one CSV text: one alone as it is, more under `# name` lines with an empty line between.
pub fn csv(tables: &[Table]) -> String {
    match tables {
        [one] => one.csv(),
        all => all.iter().map(|t| format!("# {}\n{}", t.name, t.csv())).collect::<Vec<_>>().join("\n"),
    }
}

fn line<T>(out: &mut String, items: impl Iterator<Item = T>, write: impl Fn(&mut String, T)) {
    for (k, item) in items.enumerate() {
        if k > 0 {
            out.push(',');
        }
        write(out, item);
    }
    out.push('\n');
}

/// The shortest text that reads back as the same number; nothing where there is none.
pub fn number(out: &mut String, x: f64) {
    if !x.is_finite() {
        return;
    }
    // Adding zero turns -0.0 into 0.0.
    let _ = write!(out, "{:?}", x + 0.0);
    if out.ends_with(".0") {
        out.truncate(out.len() - 2);
    }
}

/// A field of CSV, in quotes where it needs them.
pub fn field(out: &mut String, text: &str) {
    if text.contains([',', '"', '\n', '\r']) {
        out.push('"');
        *out += &text.replace('"', "\"\"");
        out.push('"');
    } else {
        *out += text;
    }
}
