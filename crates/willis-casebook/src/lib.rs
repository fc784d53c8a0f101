//! The case book of [`willis`]: published numbers beside ours, with what agrees, what does not, and why.
//!
//! Every number called *Willis* comes from running a train (or one law, where the case is one law)
//! through the library. Numbers that follow from an error of a publication are computed in the
//! module of that case, in functions that are named after the error, and nowhere else.
//!
//! ```
//! let report = willis_casebook::run("wang-2020").unwrap();
//! assert!(report.gates.iter().all(|g| g.holds || g.cause.is_some()));
//! ```

mod design;
mod galvagno;
mod losses;
mod wang_2020;

use std::fmt;

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use willis::analysis::{Analysis, Selection, SolutionReport, analyze};
use willis::contract::{Contract, Format};
use willis::train::Train;

/// Name and text.
type File = (&'static str, String);

/// A case.
#[derive(Clone, Copy, Debug)]
pub struct ValidationCase {
    /// Its name.
    pub name: &'static str,
    /// What it compares.
    pub about: &'static str,
    run: fn() -> Report,
    data: Option<fn() -> Vec<File>>,
}

/// Every case.
pub const CASES: &[ValidationCase] = &[
    ValidationCase {
        name: "wang-2020",
        about: "herringbone planetary gearbox, Wang and others 2020: every table of the paper",
        run: wang_2020::report,
        data: Some(wang_2020::data),
    },
    ValidationCase {
        name: "losses",
        about: "losses: measurements, other programs, worked examples, with gates and misses",
        run: losses::report,
        data: None,
    },
    ValidationCase {
        name: "galvagno",
        about: "motion of a lossy planetary set, Galvagno 2010: fourteen power flows, transients, offsets, jamming",
        run: galvagno::report,
        data: None,
    },
    ValidationCase {
        name: "design",
        about: "designs: counts of whole spaces, production tooth numbers, published optima, what published counts leave open",
        run: design::report,
        data: None,
    },
];

/// The report of a case; `None` if there is no case of that name.
pub fn run(name: &str) -> Option<Report> {
    CASES.iter().find(|c| c.name == name).map(|c| (c.run)())
}

/// The curves of a case as CSV files, name and text; `None` if there is no such case or it has none.
///
/// ```
/// let files = willis_casebook::data("wang-2020").unwrap();
/// assert!(files.iter().any(|f| f.0 == "planets.csv"));
/// ```
pub fn data(name: &str) -> Option<Vec<(&'static str, String)>> {
    CASES.iter().find(|c| c.name == name)?.data.map(|d| d())
}

/// A case beside our numbers: the contract `willis-validation-1`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Report {
    /// `willis-validation-1`.
    pub format: Format<Self>,
    /// Name of the case.
    pub case: String,
    /// Title.
    pub title: String,
    /// Where the printed numbers come from.
    pub source: String,
    /// In the order to be read.
    pub sections: Vec<Section>,
    /// What must hold.
    pub gates: Vec<AcceptanceBound>,
}

impl Contract for Report {
    const FORMAT: &'static str = "willis-validation-1";
}

/// A part of a report.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Section {
    /// Title.
    pub title: String,
    /// Sentences before the table.
    pub text: Vec<String>,
    /// Names of the columns.
    pub columns: Vec<String>,
    /// Rows of the table.
    pub rows: Vec<Vec<Cell>>,
    /// Points after the table.
    pub points: Vec<String>,
}

/// A cell of a table; as JSON a text, a number or `null`.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Cell {
    /// Words.
    Text(String),
    /// A number and the decimals it is shown with. JSON has the number alone: one that was read back is shown with as
    /// many decimals as it has.
    Number(f64, usize),
    /// No value.
    Empty,
}

/// A comparison with a bound.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
// The schema keeps the name that is published.
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "Gate"))]
#[non_exhaustive]
pub struct AcceptanceBound {
    /// What is compared.
    pub what: String,
    /// As printed or measured.
    pub printed: String,
    /// Ours; `null` where there is no number to compare, which no bound lets pass.
    pub ours: Option<f64>,
    /// Lowest value that passes.
    pub low: f64,
    /// Highest value that passes.
    pub high: f64,
    /// Whether it passes.
    pub holds: bool,
    /// Why it does not, where that is known.
    pub cause: Option<String>,
}

/// What is told is the same; with how many decimals it is shown does not matter.
impl PartialEq for Cell {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Text(a), Self::Text(b)) => a == b,
            (Self::Number(a, _), Self::Number(b, _)) => a == b,
            (Self::Empty, Self::Empty) => true,
            _ => false,
        }
    }
}

impl<'de> Deserialize<'de> for Cell {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Ok(match Plain::deserialize(deserializer)? {
            Plain::Text(t) => Self::Text(t),
            Plain::Number(x) => Self::Number(x, x.to_string().split_once('.').map_or(0, |(_, rest)| rest.len())),
            Plain::Empty => Self::Empty,
        })
    }
}

/// A cell as it stands in JSON.
#[derive(Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(untagged)]
enum Plain {
    /// Words.
    Text(String),
    /// A number.
    Number(f64),
    /// No value.
    Empty,
}

#[cfg(feature = "schema")]
impl schemars::JsonSchema for Cell {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Cell".into()
    }

    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        Plain::json_schema(generator)
    }
}

impl Serialize for Cell {
    fn serialize<S: Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Text(t) => s.serialize_str(t),
            Self::Number(x, _) => s.serialize_f64(*x),
            Self::Empty => s.serialize_none(),
        }
    }
}

impl fmt::Display for Cell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Text(t) => f.write_str(t),
            Self::Number(x, decimals) => f.write_str(&decimal(*x, *decimals)),
            Self::Empty => f.write_str("-"),
        }
    }
}

/// A number with so many decimals, never `-0.00`.
fn decimal(x: f64, decimals: usize) -> String {
    let text = format!("{x:.decimals$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.chars().all(|c| c == '0' || c == '.') => rest.to_owned(),
        _ => text,
    }
}

impl From<&str> for Cell {
    fn from(t: &str) -> Self {
        Self::Text(t.to_owned())
    }
}

impl From<String> for Cell {
    fn from(t: String) -> Self {
        Self::Text(t)
    }
}

impl From<(f64, usize)> for Cell {
    /// A number that is none leaves the cell empty.
    fn from((x, decimals): (f64, usize)) -> Self {
        if x.is_finite() { Self::Number(x, decimals) } else { Self::Empty }
    }
}

impl Section {
    /// Without rows yet.
    pub fn new(title: impl Into<String>, text: &[&str], columns: &[&str]) -> Self {
        Self {
            title: title.into(),
            text: text.iter().map(|t| (*t).to_owned()).collect(),
            columns: columns.iter().map(|c| (*c).to_owned()).collect(),
            ..Self::default()
        }
    }

    fn row<const N: usize>(&mut self, cells: [Cell; N]) {
        debug_assert_eq!(N, self.columns.len());
        self.rows.push(cells.into());
    }
}

impl AcceptanceBound {
    fn new(what: impl Into<String>, printed: impl Into<String>, ours: f64, [low, high]: [f64; 2]) -> Self {
        let holds = (low..=high).contains(&ours);
        let ours = Some(ours).filter(|x| x.is_finite());
        Self { what: what.into(), printed: printed.into(), ours, low, high, holds, cause: None }
    }

    /// Says why it does not hold.
    fn because(mut self, cause: &str) -> Self {
        self.cause = Some(cause.to_owned());
        self
    }

    /// `holds`, `misses` or, where it holds against what was known, `holds after all`.
    pub fn verdict(&self) -> &'static str {
        match (self.holds, &self.cause) {
            (true, None) => "holds",
            (true, Some(_)) => "holds after all",
            (false, _) => "**misses**",
        }
    }
}

/// Markdown, the columns aligned for reading as it stands.
impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "# {}\n\n{}", self.title, self.source)?;
        for s in &self.sections {
            s.fmt(f)?;
        }
        if self.gates.is_empty() {
            return Ok(());
        }
        let missed = self.gates.iter().filter(|g| !g.holds).count();
        let mut gates = Section::new(
            "Gates",
            &["Some bounds were set with the other number known. A miss stays a miss, with its cause."],
            &["what", "expected", "Willis", "from", "to", "verdict"],
        );
        let size = |g: &AcceptanceBound| g.low.abs().max(g.high.abs()).max(1e-12);
        for g in &self.gates {
            // Four digits of the bound.
            let decimals = (4 - size(g).log10().floor() as i32).clamp(0, 9) as usize;
            let number = |x: f64| Cell::from((x, decimals));
            let row = [
                g.what.as_str().into(),
                g.printed.as_str().into(),
                g.ours.map_or(Cell::Empty, number),
                number(g.low),
                number(g.high),
                g.verdict().into(),
            ];
            gates.row(row);
        }
        gates.points.push(format!("{} gates, {} hold, {missed} miss.", self.gates.len(), self.gates.len() - missed));
        for g in self.gates.iter().filter(|g| !g.holds) {
            gates.points.push(format!("{} misses: {}.", g.what, g.cause.as_deref().unwrap_or("cause not known")));
        }
        gates.fmt(f)
    }
}

impl fmt::Display for Section {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "\n## {}", self.title)?;
        for t in &self.text {
            writeln!(f, "\n{t}")?;
        }
        if !self.columns.is_empty() {
            let rows: Vec<Vec<String>> = self.rows.iter().map(|r| r.iter().map(Cell::to_string).collect()).collect();
            let width = |k: usize| {
                rows.iter().map(|r| &r[k]).chain([&self.columns[k]]).map(|t| t.chars().count()).max().unwrap_or(0)
            };
            let widths: Vec<usize> = (0..self.columns.len()).map(width).collect();
            let number = |k: usize| self.rows.iter().all(|r| !matches!(r[k], Cell::Text(_)));
            let line = |f: &mut fmt::Formatter<'_>, cells: &[String]| {
                for (k, (cell, w)) in cells.iter().zip(&widths).enumerate() {
                    if number(k) { write!(f, "| {cell:>w$} ")? } else { write!(f, "| {cell:<w$} ")? }
                }
                writeln!(f, "|")
            };
            writeln!(f)?;
            line(f, &self.columns)?;
            for (k, w) in widths.iter().enumerate() {
                let dashes = "-".repeat(w + 1);
                if number(k) { write!(f, "|{dashes}:")? } else { write!(f, "|{dashes}-")? }
            }
            writeln!(f, "|")?;
            for r in &rows {
                line(f, r)?;
            }
        }
        if !self.points.is_empty() {
            writeln!(f)?;
        }
        for p in &self.points {
            writeln!(f, "- {p}")?;
        }
        Ok(())
    }
}

/// A train of this crate.
fn train(text: &str) -> Train {
    Train::from_toml(text).unwrap_or_else(|e| panic!("a train of the case book is good: {e}"))
}

fn answer(train: &Train) -> Analysis {
    analyze(train, &Selection::default()).unwrap_or_else(|e| panic!("a train of the case book has an answer: {e}"))
}

/// The only equilibrium of an operation.
fn solution<'a>(analysis: &'a Analysis, operation: &str) -> &'a SolutionReport {
    let found = analysis.operations.iter().find(|o| o.name == operation).and_then(|o| o.solutions.first());
    found.expect("an operation of the case book has a solution")
}

/// The text with one thing replaced; it must be there.
fn with(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "the train of the case has no `{from}`");
    text.replace(from, to)
}

/// The code of the page of this crate runs as a doctest.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
