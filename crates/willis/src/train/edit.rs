//! Quantities of a train file by their path, and other values for them.

mod parts;
mod ramps;

pub use ramps::Ramp;

use toml_edit::{Array, DocumentMut, Formatted, InlineTable, Item, TableLike, Value};

use crate::diagnostic::{Code, Diagnostic};
use crate::exact::Rational;
use crate::units::{self, Dimension};

use super::format::keys::{FREE, Kind, Table};
use super::specification::FILE;
use super::words::clip;

/// What the value of a key is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Measure {
    /// A number with a unit.
    Quantity(Dimension),
    /// A plain number.
    Number,
    /// A whole number.
    Integer,
    /// A text: a name, or one of a few.
    Text,
    /// True or false.
    Flag,
}

/// Lists of what is asked of a train.
const QUESTIONS: [&str; 3] = ["operation", "scenario", "study"];

/// One step from a table to what is in it.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
enum Step {
    Key(String),
    Entry(usize),
}

/// A key of a train file that was found by its path.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Key {
    steps: Vec<Step>,
    /// What its value is.
    pub measure: Measure,
}

impl Key {
    /// Whether it is in a table of the file.
    pub(crate) fn is_in(&self, table: &str) -> bool {
        matches!(self.steps.first(), Some(Step::Key(name)) if name == table)
    }

    /// Whether it is in an operation, scenario or study.
    pub(crate) fn is_of_a_question(&self) -> bool {
        matches!(self.steps.first(), Some(Step::Key(name)) if QUESTIONS.contains(&name.as_str()))
    }
}

/// The text of a train file, any value of which can be set anew; all the rest stays as written.
///
/// # Paths
/// A path names keys from the outside in, `oil.viscosity_40`. Entries of lists that have a name are called by it, and
/// the list need not be named: `P1.planet.count` is `set.P1.planet.count`. Entries without a name have their number,
/// counted from 0: `mesh.0.gears.1.teeth`.
///
/// # Example
/// ```
/// use willis::train::{Document, Train};
///
/// let mut document = Document::parse(r#"
///     format = 1
///     name = "one set"
///     members = ["s", "r", "c"]
///     [[set]]
///     name = "P1"
///     sun = { member = "s", teeth = 30 }
///     ring = { member = "r", teeth = 70 }
///     carrier = "c"
/// "#)?;
/// let key = document.find("P1.mesh_efficiency").unwrap();
/// document.set(&key, "0.98").unwrap();
/// let train = Train::from_toml(&document.text()).unwrap();
/// assert_eq!(train.meshes()[0].efficiency.forward.to_f64(), 0.98);
/// let wrong = document.find("P1.mesh_eficiency").unwrap_err();
/// assert!(wrong.hints[0].contains("P1.mesh_efficiency"));
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Debug)]
pub struct Document(DocumentMut);

/// What stands at a place: a table and the keys that it may have, a list of such, or a value.
enum Place<'a> {
    Table(Option<&'a dyn TableLike>, &'static Table),
    List(Vec<(Option<String>, &'a dyn TableLike, &'static Table)>),
    Value(Measure),
    /// A table of names and quantities.
    Named(Option<&'a dyn TableLike>, Measure),
    /// An efficiency, or a table of them.
    Efficiency(Option<&'a dyn TableLike>, &'static [&'static str]),
    /// A signal, or anything else that has no single value.
    Other,
}

fn place<'a>(item: Option<&'a Item>, kind: &'static Kind) -> Place<'a> {
    let table = || item.and_then(Item::as_table_like);
    match kind {
        Kind::Format
        | Kind::Names
        | Kind::Terminals
        | Kind::Points(_)
        | Kind::Schedule
        | Kind::Product(_)
        | Kind::NumberOrPoints(_) => Place::Other,
        Kind::Text | Kind::Name | Kind::Choice(_) => Place::Value(Measure::Text),
        Kind::Integer | Kind::Samples => Place::Value(Measure::Integer),
        Kind::Flag => Place::Value(Measure::Flag),
        Kind::Number => Place::Value(Measure::Number),
        Kind::Quantity(dimension) => Place::Value(Measure::Quantity(*dimension)),
        Kind::Signal(signal) => match (table(), signal().of) {
            (Some(_), _) => Place::Other,
            (None, Some(dimension)) => Place::Value(Measure::Quantity(dimension)),
            (None, None) => Place::Value(Measure::Number),
        },
        Kind::Efficiency => Place::Efficiency(table(), &["forward", "backward"]),
        Kind::MachineEfficiency => match table() {
            Some(map) if map.get("map").is_some() => Place::Other,
            directed => Place::Efficiency(directed, &["motoring", "generating"]),
        },
        Kind::Store => match table() {
            None if item.and_then(Item::as_str) == Some(FREE) => Place::Value(Measure::Text),
            None => Place::Value(Measure::Quantity(Dimension::POWER)),
            named => Place::Named(named, Measure::Quantity(Dimension::POWER)),
        },
        Kind::SetEfficiency => Place::Efficiency(table(), &["external", "internal", "forward", "backward"]),
        Kind::Quantities(dimension) => Place::Named(table(), Measure::Quantity(*dimension)),
        Kind::Table(of) => Place::Table(table(), of),
        Kind::Tables(of, _) => Place::List(entries(item, |_| of)),
        Kind::Variants(variants) => Place::List(entries(item, |t| {
            let name = t.get("type").and_then(Item::as_str);
            variants.iter().find(|v| Some(v.0) == name).unwrap_or(&variants[0]).1
        })),
    }
}

fn entries(
    item: Option<&Item>,
    table_of: impl Fn(&dyn TableLike) -> &'static Table,
) -> Vec<(Option<String>, &dyn TableLike, &'static Table)> {
    let tables: Vec<&dyn TableLike> = match item {
        Some(Item::ArrayOfTables(all)) => all.iter().map(|t| t as &dyn TableLike).collect(),
        Some(Item::Value(Value::Array(all))) => {
            all.iter().filter_map(Value::as_inline_table).map(|t| t as &dyn TableLike).collect()
        }
        _ => vec![],
    };
    let name = |t: &dyn TableLike| t.get("name").and_then(Item::as_str).map(str::to_owned);
    tables.into_iter().map(|t| (name(t), t, table_of(t))).collect()
}

/// The rest of a path after a name at its beginning.
fn after<'p>(path: &'p str, name: &str) -> Option<&'p str> {
    let rest = path.strip_prefix(name)?;
    if rest.is_empty() { Some("") } else { rest.strip_prefix('.') }
}

impl Document {
    /// Reads a text.
    ///
    /// # Errors
    /// Why it is no TOML.
    pub fn parse(text: &str) -> Result<Self, String> {
        text.parse().map(Self).map_err(|e: toml_edit::TomlError| e.message().to_owned())
    }

    /// The text as it is now.
    pub fn text(&self) -> String {
        self.0.to_string()
    }

    /// The key of a path; it need not be in the text, but the format must have it.
    ///
    /// # Errors
    /// There is no such key: which are near, or where the path stops to lead anywhere.
    pub fn find(&self, path: &str) -> Result<Key, Box<Diagnostic>> {
        let mut steps = vec![];
        if let Some(measure) = walk(Some(self.0.as_table()), FILE, path, &mut steps) {
            return Ok(Key { steps, measure });
        }
        // A name alone, without that of its list.
        for key in FILE.keys() {
            let Place::List(entries) = place(self.0.get(key.name), &key.kind) else { continue };
            for (k, (name, table, of)) in entries.into_iter().enumerate() {
                let Some(rest) = name.and_then(|name| after(path, &name)).filter(|rest| !rest.is_empty()) else {
                    continue;
                };
                let mut steps = vec![Step::Key(key.name.to_owned()), Step::Entry(k)];
                if let Some(measure) = walk(Some(table), of, rest, &mut steps) {
                    return Ok(Key { steps, measure });
                }
            }
        }
        let message = format!("the train file has no quantity `{}`", clip(path));
        let all: Vec<String> = self.quantities().into_iter().map(|q| q.0).collect();
        let d = Diagnostic::new(Code::UnknownName, "", message).suggest(path, all.iter().map(String::as_str));
        let first = path.split('.').next().unwrap_or(path);
        let near: Vec<&String> = all.iter().filter(|p| after(p, first).is_some()).collect();
        Err(Box::new(match (d.hints.is_empty(), near.is_empty()) {
            (false, _) => d,
            (true, false) => d.hint(format!("under `{first}` there are: {}", shown(&near))),
            (true, true) => d.hint(
                "write keys from the outside in, sets and bearings by their names: `P1.planet.count`, \
                 `oil.viscosity_40`, `P1.geometry.module`",
            ),
        }))
    }

    /// All quantities that the format has for what is in this file, given or not: their paths and keys.
    pub fn quantities(&self) -> Vec<(String, Key)> {
        let mut all = vec![];
        collect(Some(self.0.as_table()), FILE, "", &mut vec![], &mut all);
        all
    }

    /// The train alone, without what is asked of it: operations, scenarios and studies.
    pub(crate) fn without_questions(&self) -> Self {
        let mut table = self.0.clone();
        QUESTIONS.iter().for_each(|list| drop(table.remove(list)));
        Self(table)
    }

    /// What stands at a key, as written; none where the file does not have it.
    pub fn value(&self, key: &Key) -> Option<String> {
        let mut at: &Item = self.0.as_item();
        for step in &key.steps {
            at = match step {
                Step::Key(name) => at.get(name)?,
                Step::Entry(k) => return self.entry_value(key, at, *k),
            };
        }
        scalar(at.as_value()?)
    }

    /// Below an entry of a list items are tables or values.
    fn entry_value(&self, key: &Key, list: &Item, k: usize) -> Option<String> {
        let from = key.steps.iter().position(|s| matches!(s, Step::Entry(_)))?;
        fn descend(table: &dyn TableLike, steps: &[Step]) -> Option<String> {
            let Some((Step::Key(name), rest)) = steps.split_first() else { return None };
            let item = table.get(name)?;
            match rest {
                [] => scalar(item.as_value()?),
                [Step::Entry(k), rest @ ..] => descend(nth(item, *k)?, rest),
                rest => descend(item.as_table_like()?, rest),
            }
        }
        descend(nth(list, k)?, &key.steps[from + 1..])
    }

    /// Sets the value of a key: `0.98`, `12 mm`, `mineral`.
    ///
    /// # Errors
    /// The text is no such value: no number, no unit or one of another kind.
    pub fn set(&mut self, key: &Key, text: &str) -> Result<(), String> {
        let value = literal(key.measure, text)?;
        put(self.0.as_table_mut(), &key.steps, value)
    }
}

fn shown(all: &[&String]) -> String {
    const MOST: usize = 12;
    let list: Vec<&str> = all.iter().take(MOST).map(|s| s.as_str()).collect();
    let more = all.len().saturating_sub(MOST);
    if more > 0 { format!("{} and {more} more", list.join(", ")) } else { list.join(", ") }
}

fn nth(item: &Item, k: usize) -> Option<&dyn TableLike> {
    match item {
        Item::ArrayOfTables(all) => all.get(k).map(|t| t as &dyn TableLike),
        Item::Value(Value::Array(all)) => all.get(k).and_then(Value::as_inline_table).map(|t| t as &dyn TableLike),
        _ => None,
    }
}

fn scalar(value: &Value) -> Option<String> {
    match value {
        Value::String(s) => Some(s.value().clone()),
        Value::Integer(_) | Value::Float(_) | Value::Boolean(_) => {
            let mut plain = value.clone();
            plain.decor_mut().clear();
            Some(plain.to_string())
        }
        _ => None,
    }
}

/// The measure of what a path leads to.
fn walk(table: Option<&dyn TableLike>, of: &'static Table, path: &str, steps: &mut Vec<Step>) -> Option<Measure> {
    let key = of.keys().find(|k| after(path, k.name).is_some())?;
    let rest = after(path, key.name)?;
    let item = table.and_then(|t| t.get(key.name));
    steps.push(Step::Key(key.name.to_owned()));
    match place(item, &key.kind) {
        Place::Value(measure) => rest.is_empty().then_some(measure),
        Place::Table(inner, of) => walk(inner, of, rest, steps),
        Place::Named(inner, measure) => {
            inner?.get(rest)?;
            steps.push(Step::Key(rest.to_owned()));
            Some(measure)
        }
        Place::Efficiency(inner, names) => {
            if rest.is_empty() {
                return Some(Measure::Number);
            }
            let mut inner = inner;
            for name in rest.split('.') {
                let item = inner?.get(name).filter(|_| names.contains(&name))?;
                inner = item.as_table_like();
                steps.push(Step::Key(name.to_owned()));
            }
            inner.is_none().then_some(Measure::Number)
        }
        Place::List(entries) => {
            for (k, (name, table, of)) in entries.into_iter().enumerate() {
                let number = k.to_string();
                let inside = name.and_then(|n| after(rest, &n)).or(after(rest, &number));
                if let Some(inside) = inside.filter(|r| !r.is_empty()) {
                    let from = steps.len();
                    steps.push(Step::Entry(k));
                    if let Some(measure) = walk(Some(table), of, inside, steps) {
                        return Some(measure);
                    }
                    steps.truncate(from);
                }
            }
            None
        }
        Place::Other => None,
    }
}

fn collect(
    table: Option<&dyn TableLike>,
    of: &'static Table,
    before: &str,
    steps: &mut Vec<Step>,
    all: &mut Vec<(String, Key)>,
) {
    // Motions have studies of their own.
    let keys = of.keys().filter(|k| !(before.is_empty() && matches!(k.name, "scenario" | "study" | "state")));
    for key in keys {
        let item = table.and_then(|t| t.get(key.name));
        let path = format!("{before}{}", key.name);
        steps.push(Step::Key(key.name.to_owned()));
        let mut add = |path: String, more: &[&str], measure| {
            let steps = steps.iter().cloned().chain(more.iter().map(|name| Step::Key((*name).to_owned())));
            all.push((path, Key { steps: steps.collect(), measure }));
        };
        match place(item, &key.kind) {
            Place::Value(Measure::Text) if matches!(key.name, "name" | "source" | "notes") => {}
            Place::Value(measure) => add(path, &[], measure),
            Place::Table(inner, of) => collect(inner, of, &format!("{path}."), steps, all),
            Place::Named(inner, measure) => {
                inner.into_iter().flat_map(|t| t.iter()).for_each(|(n, _)| add(format!("{path}.{n}"), &[n], measure));
            }
            Place::Efficiency(inner, _) => {
                // One number may take the place of several.
                add(path.clone(), &[], Measure::Number);
                for (name, item) in inner.into_iter().flat_map(|t| t.iter()) {
                    match item.as_table_like() {
                        Some(t) => t.iter().for_each(|(deep, _)| {
                            add(format!("{path}.{name}.{deep}"), &[name, deep], Measure::Number);
                        }),
                        None => add(format!("{path}.{name}"), &[name], Measure::Number),
                    }
                }
            }
            Place::List(entries) => {
                for (k, (name, table, of)) in entries.into_iter().enumerate() {
                    let called = match name {
                        Some(name) if before.is_empty() => format!("{name}."),
                        Some(name) => format!("{path}.{name}."),
                        None => format!("{path}.{k}."),
                    };
                    steps.push(Step::Entry(k));
                    collect(Some(table), of, &called, steps, all);
                    steps.pop();
                }
            }
            Place::Other => {}
        }
        steps.pop();
    }
}

/// A value as the file writes it.
fn literal(measure: Measure, text: &str) -> Result<Value, String> {
    let text = text.trim();
    let number = |whole: bool| -> Result<Value, String> {
        let value: Rational = text.parse().map_err(|_| match units::decimal_point(text) {
            Some(number) => format!("`{}` is not a number; with a decimal point it is {number}", clip(text)),
            None => format!("`{}` is not a number", clip(text)),
        })?;
        if whole {
            let wrong = || format!("`{}` is not a whole number", clip(text));
            return value.to_string().parse::<i64>().map(Value::from).map_err(|_| wrong());
        }
        // As written: decimals are read exactly.
        let as_written = text.parse::<Value>().ok().filter(|v| v.is_float() || v.is_integer());
        Ok(as_written.unwrap_or_else(|| Value::from(value.to_f64())))
    };
    match measure {
        Measure::Number => number(false),
        Measure::Integer => number(true),
        Measure::Quantity(dimension) => match units::parse(text, dimension) {
            Ok(_) => Ok(Value::String(Formatted::new(text.to_owned()))),
            Err(e) => Err(format!("\"{}\" is not {}: {e}; {}", clip(text), dimension.describe().0, e.hint())),
        },
        Measure::Text => Ok(Value::String(Formatted::new(text.to_owned()))),
        Measure::Flag => text.parse::<bool>().map(Value::from).map_err(|_| format!("`{text}` is not true or false")),
    }
}

fn put(table: &mut dyn TableLike, steps: &[Step], value: Value) -> Result<(), String> {
    let lost = || "the place is no longer there".to_owned();
    let Some((Step::Key(name), rest)) = steps.split_first() else { return Err(lost()) };
    match rest {
        [] => {
            table.insert(name, Item::Value(value));
            Ok(())
        }
        [Step::Entry(k), rest @ ..] => match table.get_mut(name) {
            Some(Item::ArrayOfTables(all)) => put(all.get_mut(*k).ok_or_else(lost)?, rest, value),
            Some(Item::Value(Value::Array(all))) => put(entry(all, *k).ok_or_else(lost)?, rest, value),
            _ => Err(lost()),
        },
        rest => {
            let is_table = table.get(name).is_some_and(Item::is_table_like);
            if !is_table {
                table.insert(name, Item::Value(Value::InlineTable(InlineTable::new())));
            }
            let inner = table.get_mut(name).and_then(Item::as_table_like_mut).ok_or_else(lost)?;
            put(inner, rest, value)
        }
    }
}

fn entry(all: &mut Array, k: usize) -> Option<&mut InlineTable> {
    all.get_mut(k).and_then(Value::as_inline_table_mut)
}
