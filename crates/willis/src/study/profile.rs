//! Operating conditions over time, read from a table: a duty cycle or a load spectrum.

use std::collections::HashMap;
use std::ops::Range;

use serde::{Deserialize, Serialize};

use crate::diagnostic::{Code, Diagnostic, Diagnostics, printable};
use crate::model::{Model, Target};
use crate::train::Measure;
use crate::train::csv::{self, Cell, Row};
use crate::units::{self, Dimension};

use super::column::{Column, ColumnValues};

/// More errors than these are counted, not kept; one more says how many.
const MOST_ERRORS: usize = 49;

/// Which columns of a profile are read; names as they stand in the header, with or without the unit.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum ProfileColumns {
    /// All of them.
    #[default]
    All,
    /// These.
    Only(Vec<String>),
    /// All but these.
    Without(Vec<String>),
}

impl ProfileColumns {
    fn names(&self) -> &[String] {
        match self {
            Self::All => &[],
            Self::Only(names) | Self::Without(names) => names,
        }
    }

    fn takes(&self, header: &str) -> bool {
        let named = || self.names().iter().any(|n| is_called(header, n));
        match self {
            Self::All => true,
            Self::Only(_) => named(),
            Self::Without(_) => !named(),
        }
    }
}

/// Whether a name is that of a column.
fn is_called(header: &str, name: &str) -> bool {
    header == name || bracketed(header).is_some_and(|(own, _)| own == name)
}

/// How rows of a profile weigh in time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Basis {
    /// A recorded trace: each row holds from its time until that of the next; the last row only ends it.
    Trace,
    /// A load spectrum: each row has a duration.
    Durations,
    /// A load spectrum in parts of the whole; the whole is taken as one hour.
    Shares,
}

impl Basis {
    /// The rule in a sentence.
    pub fn rule(self) -> &'static str {
        match self {
            Self::Trace => "each row holds from its time until that of the next row; the last row ends the trace",
            Self::Durations => "each row holds for the duration that it gives",
            Self::Shares => "each row holds for its share of the whole; energies are those of one hour",
        }
    }
}

/// A row of a profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProfileRow {
    /// Its line in the text, counted from 1.
    pub line: u32,
    /// Its time in a trace, s; NaN in a spectrum.
    pub time_s: f64,
    /// How long it holds, s.
    pub duration_s: f64,
    /// The number of its condition.
    pub condition: u32,
}

/// A column that sets a quantity.
#[derive(Clone, Debug)]
struct Setting {
    /// The header as it stands in the text.
    header: String,
    target: Target,
    unit: String,
    /// Whether its values are texts, not numbers.
    is_text: bool,
    /// Values, each once.
    values: Vec<String>,
}

/// Rows that say the same.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Held {
    pub rows: u32,
    pub first_line: u32,
    pub time_s: f64,
}

/// A duty cycle or a load spectrum: each row one operating condition, with a weight in time.
///
/// # Format
/// Commas, semicolons or tabs between columns, whichever the header has; with semicolons or tabs decimal commas are read
/// too. Empty lines and lines that begin with `#` are skipped; the first line left is the header, of at most 4,096 columns.
/// A column is a quantity with its unit, `input.speed [rpm]`, `output.torque [N m]`,
/// `carrier.speed_rpm`, or a text, `state`; names are those of [`Target::parse`]. One column weighs the rows:
///
/// | header | row |
/// |---|---|
/// | `time [s]` | of a trace: holds until the time of the next row; times rise; the last row ends the trace |
/// | `duration [min]`, `hours` | holds so long |
/// | `share`, `share [%]` | holds for this part of the whole, which is taken as one hour |
///
/// # Example
/// ```
/// use willis::model::Model;
/// use willis::study::{Basis, Profile};
///
/// let text = r#"
///     format = 1
///     name = "reducer"
///     members = ["s", "c"]
///     terminals = ["s", "c"]
///     [[set]]
///     name = "P1"
///     sun = { member = "s", teeth = 30 }
///     ring = { member = "frame", teeth = 70 }
///     carrier = "c"
/// "#;
/// let model = Model::from_toml(text).unwrap();
/// let profile = Profile::parse("time [s],input.speed [rpm]\n0,900\n2,1000\n3,0\n", &model)?;
/// assert_eq!((profile.basis(), profile.rows().len(), profile.total_s()), (Basis::Trace, 2, 3.0));
/// assert_eq!(profile.describe(1), "input.speed = 1000 rpm");
/// let wrong = Profile::parse("time [s],input.sped [rpm]\n0,900\n2,1000\n", &model).unwrap_err();
/// assert!(wrong.to_string().contains("did you mean `input.speed`"));
/// # Ok::<(), willis::Diagnostics>(())
/// ```
#[derive(Clone, Debug)]
pub struct Profile {
    basis: Basis,
    settings: Vec<Setting>,
    rows: Vec<ProfileRow>,
    /// For each condition the position of each setting's value.
    conditions: Vec<Box<[u32]>>,
    held: Vec<Held>,
    total_s: f64,
    notes: Vec<String>,
}

/// What a column is for.
enum Purpose {
    Weight(Basis, f64),
    Setting(Setting),
}

/// Errors with their places.
struct Wrong {
    all: Diagnostics,
    more: usize,
}

impl Wrong {
    fn at(&mut self, place: String, span: Range<usize>, message: String, hint: &str) {
        self.push(Diagnostic::new(Code::BadTable, place, message), span, hint);
    }

    fn push(&mut self, mut d: Diagnostic, span: Range<usize>, hint: &str) {
        if self.all.len() >= MOST_ERRORS {
            self.more += 1;
            return;
        }
        // What is underlined is replaced by hints only where that is the whole cell.
        d.replacement = None;
        d.span = Some(span.into());
        self.all.push(if hint.is_empty() { d } else { d.hint(hint) });
    }
}

/// Name and unit of a header: `input.speed [rpm]`, `input.speed (rpm)`.
fn bracketed(header: &str) -> Option<(&str, &str)> {
    let (open, close) = if header.ends_with(']') { ('[', ']') } else { ('(', ')') };
    let (name, unit) = header.strip_suffix(close)?.rsplit_once(open)?;
    Some((name.trim(), unit.trim()))
}

/// The unit that the end of a name stands for: `rpm`, `rad_s`, `n_m`.
fn spelt(suffix: &str, dimension: Dimension) -> Option<String> {
    const SMALL: [(&str, &str); 7] =
        [("nm", "N m"), ("n_m", "N m"), ("kn_m", "kN m"), ("w", "W"), ("kw", "kW"), ("degc", "degC"), ("k", "K")];
    let small = SMALL.iter().find(|s| s.0 == suffix).map(|s| s.1.to_owned());
    let tries = [suffix.to_owned(), suffix.replace('_', "/"), suffix.replace('_', " ")];
    tries.into_iter().chain(small).find(|unit| units::parse(&format!("1 {unit}"), dimension).is_ok())
}

fn weight(name: &str) -> Option<Basis> {
    match name.to_ascii_lowercase().as_str() {
        "time" | "t" => Some(Basis::Trace),
        "duration" | "hours" => Some(Basis::Durations),
        "share" => Some(Basis::Shares),
        _ => None,
    }
}

/// Seconds (or the whole) in one of a weight's unit.
fn weight_unit(name: &str, basis: Basis, unit: Option<&str>) -> Result<f64, String> {
    if basis == Basis::Shares {
        return match unit {
            None | Some("" | "-" | "1") => Ok(1.0),
            Some("%" | "percent") => Ok(0.01),
            Some(other) => Err(format!("`{other}` is no unit of a share; write `share` or `share [%]`")),
        };
    }
    let unit = match (unit, name.eq_ignore_ascii_case("hours")) {
        (None, true) => "h",
        (None, false) => return Err(format!("`{name}` has no unit; write `{name} [s]`")),
        (Some(unit), _) => unit,
    };
    match units::parse(&format!("1 {unit}"), Dimension::TIME) {
        Ok(one) => Ok(one.si()),
        Err(_) => Err(format!("`{unit}` is no unit of time; write `{name} [s]`, `[min]` or `[h]`")),
    }
}

fn purpose(header: &str, model: &Model) -> Result<Purpose, Box<Diagnostic>> {
    let fault = |message: String| Box::new(Diagnostic::new(Code::BadTable, "", message));
    let hinted = |message: String, hint: String| Box::new(fault(message).hint(hint));
    let (name, unit) = bracketed(header).map_or((header, None), |(n, u)| (n, Some(u)));
    let cut = |name: &'_ str| name.split_once('_').map(|(n, u)| (n.to_owned(), u.to_owned()));
    let weighed = match (weight(name), unit, cut(name)) {
        (Some(basis), ..) => Some((name.to_owned(), basis, unit.map(str::to_owned))),
        (None, None, Some((n, u))) => weight(&n).map(|basis| (n, basis, Some(u))),
        _ => None,
    };
    if let Some((name, basis, unit)) = weighed {
        return weight_unit(&name, basis, unit.as_deref()).map(|f| Purpose::Weight(basis, f)).map_err(fault);
    }
    let setting = |target: Target, unit: String| {
        let is_text = matches!(target.measure(model), Measure::Text | Measure::Flag);
        Purpose::Setting(Setting { header: header.to_owned(), target, unit, is_text, values: vec![] })
    };
    match Target::parse(name, model) {
        Ok(target) => match (target.measure(model), unit) {
            (Measure::Quantity(dimension), Some(unit)) => match units::parse(&format!("1 {unit}"), dimension) {
                Ok(_) => Ok(setting(target, unit.to_owned())),
                Err(why) => {
                    let (kind, example) = dimension.describe();
                    // The unit that may be meant, or the usual one.
                    let good = why.instead.first().map_or(example, String::as_str).split_once(' ').map_or("", |e| e.1);
                    Err(hinted(
                        format!("the unit `{unit}` is not that of {kind}: {why}"),
                        format!("write `{name} [{good}]`"),
                    ))
                }
            },
            (Measure::Quantity(dimension), None) => {
                let example = dimension.describe().1;
                let unit = example.split_once(' ').map_or("", |e| e.1);
                Err(hinted(format!("`{name}` has no unit"), format!("write it in the header: `{name} [{unit}]`")))
            }
            (_, None | Some("" | "-")) => Ok(setting(target, String::new())),
            (_, Some(unit)) => Err(fault(format!("`{name}` has no unit, and here stands `{unit}`"))),
        },
        Err(unknown) => {
            // The unit may be a part of the name.
            for (at, _) in name.match_indices('_').filter(|_| unit.is_none()) {
                let Ok(target) = Target::parse(&name[..at], model) else { continue };
                let Measure::Quantity(dimension) = target.measure(model) else { continue };
                let suffix = &name[at + 1..];
                return match spelt(suffix, dimension) {
                    Some(unit) => Ok(setting(target, unit)),
                    None => {
                        let (kind, example) = dimension.describe();
                        let good = example.split_once(' ').map_or("", |e| e.1);
                        Err(hinted(
                            format!("`{suffix}` is not the unit of {kind}"),
                            format!("write `{} [{good}]`", &name[..at]),
                        ))
                    }
                };
            }
            let mut d = unknown;
            // What the train lacks for these is told already.
            if !matches!(name, "state" | "oil.temperature" | "temperature") && !name.starts_with("law.") {
                d.message = format!("there is no quantity `{name}` to set");
            }
            Err(d)
        }
    }
}

/// What the columns are for.
struct Header<'t> {
    cells: Vec<Cell<'t>>,
    /// The column that weighs the rows, and the factor to seconds or to the whole.
    weighing: Option<(usize, f64)>,
    /// For each column the position of its setting.
    settings: Vec<Option<usize>>,
}

/// What was read so far.
#[derive(Default)]
struct Progress<'t> {
    /// For each setting what its cells say, each once.
    known: Vec<HashMap<&'t str, Result<u32, Box<Diagnostic>>>>,
    conditions: HashMap<Box<[u32]>, u32>,
    /// Time and line of the last row of a trace.
    last: Option<(f64, usize)>,
    /// The weights together.
    sum: f64,
}

impl Profile {
    /// Reads a profile.
    ///
    /// # Errors
    /// All that is wrong with it, each with its line and column, 50 at most: no column that weighs the rows or several,
    /// unknown quantities (with the nearest) and states, units of another kind, empty cells and such that are no finite
    /// number, times that do not rise, a profile without rows or that lasts no time.
    pub fn parse(text: &str, model: &Model) -> Result<Self, Diagnostics> {
        Self::parse_columns(text, model, &ProfileColumns::All)
    }

    /// Reads some of the columns of a profile; [`Profile::notes`] tell which were left out.
    ///
    /// # Errors
    /// Those of [`Profile::parse`], and names that no column has.
    ///
    /// # Example
    /// ```
    /// use willis::model::Model;
    /// use willis::study::{Profile, ProfileColumns};
    ///
    /// let text = willis::train::Train::builder("reducer")
    ///     .members(["s", "c"])
    ///     .terminals(["s", "c"])
    ///     .set(willis::train::SetSpec::simple("P1", ("s", 30), ("frame", 70), "c"));
    /// let model = Model::new(text)?;
    /// let measured = "time [s];s.speed [rpm];vibration\n0;900,5;3\n2;1000;4\n";
    /// assert!(Profile::parse(measured, &model).is_err());
    /// let without = ProfileColumns::Without(vec!["vibration".into()]);
    /// let profile = Profile::parse_columns(measured, &model, &without)?;
    /// assert_eq!(profile.describe(0), "s.speed = 900.5 rpm");
    /// assert_eq!(profile.notes(), ["columns left out: vibration"]);
    /// # Ok::<(), willis::Diagnostics>(())
    /// ```
    pub fn parse_columns(text: &str, model: &Model, columns: &ProfileColumns) -> Result<Self, Diagnostics> {
        let mut wrong = Wrong { all: Diagnostics::default(), more: 0 };
        let mut rows = csv::rows(text);
        let Some(header) = rows.next() else {
            let d = Diagnostic::new(Code::BadTable, "", "the profile is empty");
            return Err(d.hint("a header row comes first: `time [s],input.speed [rpm],output.torque [N m]`").into());
        };
        let whole = header.span.clone();
        if header.count > csv::MOST_COLUMNS {
            let line = format!("line {}", header.line);
            // The line is too long to be shown.
            wrong.at(line, whole.start..whole.start, csv::too_many(header.count), "");
            wrong.all.stand_in(None, text);
            return Err(wrong.all);
        }
        let (mut profile, header) = Self::headed(header, model, columns, &mut wrong);
        let mut progress = Progress { known: vec![HashMap::new(); profile.settings.len()], ..Progress::default() };
        for row in rows {
            profile.take(&row, &header, &mut progress, model, &mut wrong);
        }
        if wrong.all.is_empty() {
            profile.weigh(progress.sum, &mut wrong, whole);
        }
        if wrong.more > 0 {
            let message = format!("{} more errors of these kinds", wrong.more);
            wrong.all.push(Diagnostic::new(Code::BadTable, "", message));
        }
        if wrong.all.has_errors() {
            wrong.all.stand_in(None, text);
            return Err(wrong.all);
        }
        let mut numbered: Vec<(Box<[u32]>, u32)> = progress.conditions.into_iter().collect();
        numbered.sort_by_key(|c| c.1);
        profile.conditions = numbered.into_iter().map(|c| c.0).collect();
        profile.gather();
        Ok(profile)
    }

    /// A profile without rows, from its header.
    fn headed<'t>(row: Row<'t>, model: &Model, columns: &ProfileColumns, wrong: &mut Wrong) -> (Self, Header<'t>) {
        let mut profile = Self {
            basis: Basis::Trace,
            settings: vec![],
            rows: vec![],
            conditions: vec![],
            held: vec![],
            total_s: 0.0,
            notes: vec![],
        };
        let Row { line, span: whole, cells, .. } = row;
        for name in columns.names().iter().filter(|n| !cells.iter().any(|c| is_called(c.text, n))) {
            let d = Diagnostic::new(Code::BadTable, "", format!("there is no column `{name}`"));
            let d = d.suggest(name, cells.iter().map(|c| c.text));
            wrong.push(d, whole.clone(), "");
        }
        let left: Vec<&str> = cells.iter().map(|c| c.text).filter(|name| !columns.takes(name)).collect();
        if !left.is_empty() {
            const MOST: usize = 12;
            let more = if left.len() > MOST { format!(" and {} more", left.len() - MOST) } else { String::new() };
            let shown: Vec<_> = left.iter().take(MOST).map(|name| printable(name)).collect();
            profile.notes.push(format!("columns left out: {}{more}", shown.join(", ")));
        }
        let mut weighing: Option<(usize, f64)> = None;
        let mut settings = vec![None; cells.len()];
        let mut told = false;
        for (k, Cell { text: name, span }) in cells.iter().enumerate() {
            let place = format!("line {line}, column {}", k + 1);
            if !columns.takes(name) {
                continue;
            }
            // The nearest names of what is unknown take their time to find.
            if wrong.all.len() >= MOST_ERRORS {
                wrong.more += cells.len() - k;
                break;
            }
            match purpose(name, model) {
                _ if name.is_empty() => wrong.at(place, whole.clone(), "the column has no name".into(), ""),
                Ok(Purpose::Weight(basis, factor)) => match weighing {
                    Some((other, _)) => {
                        let message = format!("`{}` and `{name}` both weigh the rows", cells[other].text);
                        wrong.at(place, span.clone(), message, "keep one of the two columns");
                    }
                    None => {
                        weighing = Some((k, factor));
                        profile.basis = basis;
                    }
                },
                Ok(Purpose::Setting(setting)) => match profile.settings.iter().find(|s| s.target == setting.target) {
                    Some(other) => {
                        let message = format!("`{}` and `{name}` set the same quantity", other.header);
                        wrong.at(place, span.clone(), message, "");
                    }
                    None => {
                        settings[k] = Some(profile.settings.len());
                        profile.settings.push(setting);
                    }
                },
                Err(mut d) => {
                    d.place = place;
                    let hint = match d.code {
                        Code::UnknownName if !told => {
                            "or leave the column out; `cycle` does where it stands in `ignore_column`"
                        }
                        _ => "",
                    };
                    told |= !hint.is_empty();
                    wrong.push(*d, span.clone(), hint);
                }
            }
        }
        if weighing.is_none() {
            let message = "no column weighs the rows in time".to_owned();
            let hint = "add `time [s]` (a trace), or `duration [s]`, `hours` or `share` (a load spectrum)";
            wrong.at(format!("line {line}"), whole.clone(), message, hint);
        }
        if profile.settings.is_empty() && wrong.all.is_empty() {
            let message = "no column sets a quantity".to_owned();
            wrong.at(format!("line {line}"), whole, message, "add one: `input.speed [rpm]`");
        }
        (profile, Header { cells, weighing, settings })
    }

    /// Takes a row, or says what is wrong with it.
    fn take<'t>(
        &mut self,
        row: &Row<'t>,
        header: &Header<'_>,
        progress: &mut Progress<'t>,
        model: &Model,
        wrong: &mut Wrong,
    ) {
        let line = row.line;
        if row.count != header.cells.len() {
            let message = format!("line {line} has {} cells, the header has {}", row.count, header.cells.len());
            return wrong.at(format!("line {line}"), row.span.clone(), message, "");
        }
        let mut weight = None;
        let mut condition = vec![0u32; self.settings.len()].into_boxed_slice();
        let mut is_good = true;
        for (k, Cell { text: cell, span }) in row.cells.iter().enumerate() {
            // An empty cell is underlined where it would stand.
            let span = if span.is_empty() { row.span.clone() } else { span.clone() };
            let place = || format!("line {line}, column `{}`", header.cells[k].text);
            let fault = |message: String| Box::new(Diagnostic::new(Code::BadTable, "", message));
            let read = match (header.weighing, header.settings[k]) {
                (Some((column, factor)), _) if column == k => {
                    self.weight(row, cell, factor, progress).map(|w| weight = Some(w)).map_err(fault)
                }
                (_, Some(_)) if cell.is_empty() => Err(fault("the cell is empty".into())),
                (_, Some(at)) => {
                    let setting = &mut self.settings[at];
                    let value = progress.known[at].entry(cell).or_insert_with(|| setting.read(row, cell, model));
                    value.clone().map(|value| condition[at] = value)
                }
                _ => continue,
            };
            if let Err(mut d) = read {
                d.place = place();
                wrong.push(*d, span, "");
                is_good = false;
            }
        }
        let (Some(weight), true) = (weight, is_good) else { return };
        let next = progress.conditions.len() as u32;
        let condition = *progress.conditions.entry(condition).or_insert(next);
        progress.sum += weight;
        let (time_s, duration_s) = match self.basis {
            Basis::Trace => (weight, 0.0),
            _ => (f64::NAN, weight),
        };
        self.rows.push(ProfileRow { line: line as u32, time_s, duration_s, condition });
    }

    /// What a cell of the weighing column says, in seconds or parts of the whole.
    fn weight(&self, row: &Row<'_>, cell: &str, factor: f64, progress: &mut Progress<'_>) -> Result<f64, String> {
        let x = row.value(cell).map_err(|why| why.of(cell))?;
        if self.basis == Basis::Trace {
            if let Some((before, other)) = progress.last.filter(|l| x * factor <= l.0) {
                let word = if x * factor < before { "falls" } else { "does not rise" };
                return Err(format!("the time {word}: {} s here, {} s in line {other}", x * factor, before));
            }
            progress.last = Some((x * factor, row.line));
        } else if x < 0.0 {
            return Err(format!("`{cell}` is below zero, and this weighs a row"));
        }
        Ok(x * factor)
    }

    /// Durations of the rows, and what is remarkable about them.
    fn weigh(&mut self, sum: f64, wrong: &mut Wrong, header: Range<usize>) {
        let none = |message: &str, hint: &str| {
            let d = Diagnostic::new(Code::BadTable, "", message);
            if hint.is_empty() { d } else { d.hint(hint) }
        };
        if self.rows.is_empty() {
            return wrong.push(none("there is no row below the header", ""), header, "");
        }
        match self.basis {
            Basis::Trace => {
                for k in 1..self.rows.len() {
                    self.rows[k - 1].duration_s = self.rows[k].time_s - self.rows[k - 1].time_s;
                }
                // Its quantities were checked; it lasts no time.
                self.rows.pop();
                self.total_s = self.rows.iter().map(|r| r.duration_s).sum();
                let mut lengths: Vec<f64> = self.rows.iter().map(|r| r.duration_s).collect();
                lengths.sort_by(f64::total_cmp);
                if let (Some(usual), Some(most)) = (lengths.get(lengths.len() / 2), lengths.last())
                    && lengths.len() >= 10
                    && *most > 20.0 * usual
                {
                    let row = self.rows.iter().find(|r| r.duration_s == *most).expect("it is one of them");
                    self.notes.push(format!(
                        "line {} holds for {most} s, where the usual step is {usual} s: the trace may have a gap there",
                        row.line
                    ));
                }
            }
            Basis::Durations => self.total_s = sum,
            Basis::Shares => {
                const WHOLE: f64 = 3600.0;
                if (sum - 1.0).abs() > 1e-6 && (sum - 100.0).abs() > 1e-4 {
                    self.notes.push(format!("the shares add to {sum}; they are taken as parts of that"));
                }
                if sum > 0.0 {
                    self.rows.iter_mut().for_each(|r| r.duration_s *= WHOLE / sum);
                    self.total_s = WHOLE;
                }
            }
        }
        if self.total_s.is_nan() || self.total_s <= 0.0 {
            let hint = if self.basis == Basis::Trace { "a trace has a second row, at which it ends" } else { "" };
            wrong.push(none("the profile lasts no time", hint), header, "");
        } else if !self.total_s.is_finite() {
            wrong.push(none("the profile lasts longer than can be counted", ""), header, "");
        }
    }

    fn gather(&mut self) {
        self.held = vec![Held::default(); self.conditions.len()];
        for row in &self.rows {
            let held = &mut self.held[row.condition as usize];
            if held.rows == 0 {
                held.first_line = row.line;
            }
            held.rows += 1;
            held.time_s += row.duration_s;
        }
    }

    /// How its rows weigh.
    pub fn basis(&self) -> Basis {
        self.basis
    }

    /// Its rows in order, without the one that ends a trace.
    pub fn rows(&self) -> &[ProfileRow] {
        &self.rows
    }

    /// How long it lasts, s; one hour where rows have shares.
    pub fn total_s(&self) -> f64 {
        self.total_s
    }

    /// What is remarkable about it: a gap in a trace, shares that do not add to 1.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// How many conditions there are, each once.
    pub fn conditions(&self) -> usize {
        self.conditions.len()
    }

    /// The headers of its columns, without that of the weight.
    pub fn columns(&self) -> impl ExactSizeIterator<Item = &str> {
        self.settings.iter().map(|s| s.header.as_str())
    }

    /// Its columns without that of the weight, with the values of every row.
    pub(super) fn table_columns(&self) -> impl Iterator<Item = (Column, ColumnValues)> + '_ {
        self.settings.iter().enumerate().map(move |(k, s)| {
            let cells = self.rows.iter().map(move |row| {
                let value = self.conditions[row.condition as usize][k];
                s.values[value as usize].as_str()
            });
            match s.is_text {
                true => {
                    (Column::text(s.header.clone()), ColumnValues::Texts(cells.map(|c| c.to_owned().into()).collect()))
                }
                // Every cell was read as a number before.
                false => (
                    Column::number(s.header.clone(), s.unit.clone()),
                    ColumnValues::Numbers(cells.map(|c| c.parse().unwrap_or(f64::NAN)).collect()),
                ),
            }
        })
    }

    /// The cells of a condition as they stand in the text.
    pub fn cells(&self, condition: usize) -> impl ExactSizeIterator<Item = &str> {
        let values = &self.conditions[condition];
        self.settings.iter().zip(values).map(|(s, v)| s.values[*v as usize].as_str())
    }

    /// What a condition sets, for [`PointSetup::at`](super::PointSetup::at).
    pub fn settings(&self, condition: usize) -> Vec<(&Target, String)> {
        let value = |s: &Setting, v: &str| if s.unit.is_empty() { v.to_owned() } else { format!("{v} {}", s.unit) };
        self.settings.iter().zip(self.cells(condition)).map(|(s, v)| (&s.target, value(s, v))).collect()
    }

    /// A condition in words: `input.speed = 1000 rpm, state = 3`.
    pub fn describe(&self, condition: usize) -> String {
        let name = |s: &Setting| match (bracketed(&s.header), s.unit.is_empty()) {
            (Some((name, _)), _) => name.to_owned(),
            (None, true) => s.header.clone(),
            // The unit is the end of the name.
            (None, false) => {
                let parts = s.unit.matches(['/', ' ']).count() + 1;
                s.header.rsplitn(parts + 1, '_').last().unwrap_or(&s.header).to_owned()
            }
        };
        let all = self.settings.iter().zip(self.settings(condition));
        all.map(|(s, (_, value))| format!("{} = {value}", name(s))).collect::<Vec<_>>().join(", ")
    }

    pub(super) fn held(&self, condition: usize) -> Held {
        self.held[condition]
    }
}

impl Setting {
    /// The position of a cell's value among those known, checked where it is new.
    fn read(&mut self, row: &Row<'_>, cell: &str, model: &Model) -> Result<u32, Box<Diagnostic>> {
        let fault = |message: String| Box::new(Diagnostic::new(Code::BadTable, "", message));
        let value = match self.target.measure(model) {
            Measure::Text | Measure::Flag => cell.to_owned(),
            measure => {
                let plain = row.number(cell).map_err(|why| fault(why.of(cell)))?;
                if measure == Measure::Integer && plain.parse().is_ok_and(|x: f64| x.fract() != 0.0) {
                    return Err(fault(format!("`{cell}` is not a whole number, and this quantity is one")));
                }
                plain
            }
        };
        let text = if self.unit.is_empty() { value.clone() } else { format!("{value} {}", self.unit) };
        self.target.check(model, std::slice::from_ref(&text))?;
        self.values.push(value);
        Ok(self.values.len() as u32 - 1)
    }
}
