//! Variants of a train side by side: what their files differ in, and what that changes.

use serde::Serialize;
use toml::{Table, Value};

use crate::analysis::{self, Direction, Losses, Selection, SolutionReport, StateReport};
use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::train::{Load, Operation, Train};

use super::axis::Axis;
use super::question::{Hold, Question, Trains};
use super::sweep::{Answer, Sweep};
use crate::model::Model;

/// Points of a map beyond which a comparison is a study of its own.
const MOST_POINTS: u64 = 1_000_000;
/// Bands into which a long axis is cut to tell where a variant is better.
const BANDS: usize = 5;
/// Differences below this part of a value are round-off.
const ROUND_OFF: f64 = 1e-9;

/// What is compared.
#[derive(Clone, Debug, Default)]
pub struct CompareRequest {
    /// Only this operation.
    pub operation: Option<String>,
    /// Only this state, and operations in it.
    pub state: Option<String>,
    /// The same axes applied to every variant; see [`Axis`].
    pub over: Vec<String>,
}

/// A variant.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Variant {
    /// `A`, `B`, …
    pub label: String,
    /// What it is called, a file.
    pub file: String,
    /// Name of its train.
    pub train: String,
}

/// A value of a variant.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Datum {
    /// It has none.
    None,
    /// A number.
    Number(f64),
    /// A word: a verdict.
    Word(String),
}

impl Datum {
    fn number(&self) -> Option<f64> {
        match self {
            Self::Number(x) => Some(*x),
            _ => None,
        }
    }
}

/// A key in which files differ, or a prescription in which operations do.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TextDifference {
    /// The path of the key, or what is prescribed.
    pub path: String,
    /// The values as written, one for each variant; absent where it has none.
    pub values: Vec<Option<String>>,
}

/// A result in which variants differ.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Difference {
    /// What it is.
    pub quantity: String,
    /// Its unit; `efficiency` for efficiencies, empty for plain numbers and words.
    pub unit: &'static str,
    /// One value for each variant.
    pub values: Vec<Datum>,
    /// Value less that of the first variant.
    pub differences: Vec<Option<f64>>,
    /// The difference over the first variant's value; of an efficiency over what it lacks to 1.
    pub relative: Vec<Option<f64>>,
    /// How large the difference is, 0 to 1: largest over the larger value, efficiencies measured by what they lack to 1;
    /// 2 where words differ or a value is missing.
    pub size: f64,
}

/// A state or an operation in all variants that have it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Compared {
    /// Its name.
    pub name: String,
    /// Labels of the variants that do not have it.
    pub missing_in: Vec<String>,
    /// What the variants prescribe differently: results are then those of different points.
    pub prescribed: Vec<TextDifference>,
    /// Results that differ, largest first.
    pub differences: Vec<Difference>,
    /// How many results are equal.
    pub equal: usize,
    /// Why a variant has no answer: label and reason.
    pub reasons: Vec<(String, String)>,
}

impl Compared {
    /// Whether there is nothing to tell.
    pub fn is_equal(&self) -> bool {
        self.missing_in.is_empty() && self.prescribed.is_empty() && self.differences.is_empty()
    }

    fn size(&self) -> f64 {
        self.differences.first().map_or(0.0, |d| d.size)
    }
}

/// A place on a map.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MapPlace {
    /// Value less that of the first variant.
    pub difference: f64,
    /// Value of the first variant.
    pub first: f64,
    /// Value of the other.
    pub other: f64,
    /// The point in words.
    pub place: String,
}

/// A difference over many points.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct MapDifference {
    /// Points at which the other variant is better.
    pub better: u64,
    /// Points at which it is worse.
    pub worse: u64,
    /// Points at which both are equal.
    pub equal: u64,
    /// Mean of its value less that of the first.
    pub mean: Option<f64>,
    /// Where it is better by most.
    pub most_better: Option<MapPlace>,
    /// Where it is worse by most.
    pub most_worse: Option<MapPlace>,
}

impl MapDifference {
    fn add(&mut self, first: f64, other: f64, more_is_better: bool, place: impl Fn() -> String) {
        let difference = other - first;
        let gain = if more_is_better { difference } else { -difference };
        let n = (self.better + self.worse + self.equal) as f64;
        self.mean = Some((self.mean.unwrap_or(0.0) * n + difference) / (n + 1.0));
        if same(first, other) {
            self.equal += 1;
            return;
        }
        let (count, most) = match gain > 0.0 {
            true => (&mut self.better, &mut self.most_better),
            false => (&mut self.worse, &mut self.most_worse),
        };
        *count += 1;
        if most.as_ref().is_none_or(|m| difference.abs() > m.difference.abs()) {
            *most = Some(MapPlace { difference, first, other, place: place() });
        }
    }
}

/// Efficiency along a part of an axis.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Band {
    /// The axis.
    pub axis: String,
    /// First value.
    pub from: String,
    /// Last value.
    pub to: String,
    /// Points at which the other variant is the more efficient.
    pub better: u64,
    /// Points at which it is the less efficient.
    pub worse: u64,
    /// Points at which both are equal.
    pub equal: u64,
    /// Mean of its efficiency less that of the first.
    pub mean: Option<f64>,
}

/// The first variant and another over the same axes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MapPair {
    /// Label of the first.
    pub first: String,
    /// Label of the other.
    pub other: String,
    /// Points at which both have one answer.
    pub compared: u64,
    /// Points at which only the first has one.
    pub only_first: u64,
    /// Points at which only the other has one.
    pub only_other: u64,
    /// Points at which neither has one.
    pub neither: u64,
    /// Of the efficiency.
    pub efficiency: MapDifference,
    /// Of the loss, W.
    pub loss_w: MapDifference,
    /// Efficiency along each axis.
    pub bands: Vec<Band>,
}

/// Variants over the same axes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MapComparison {
    /// The axes as they were written.
    pub over: Vec<String>,
    /// How many points.
    pub points: u64,
    /// The operation from which each variant starts.
    pub operations: Vec<String>,
    /// What these prescribe differently, where no axis sets it.
    pub prescribed: Vec<TextDifference>,
    /// The first variant with each other.
    pub pairs: Vec<MapPair>,
}

/// Variants side by side. Serialised it is the contract `willis-compare-1`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// `willis-compare-1`.
    pub format: &'static str,
    /// The variants.
    pub variants: Vec<Variant>,
    /// Whether all files say the same.
    pub identical: bool,
    /// Keys in which the files differ.
    pub files: Vec<TextDifference>,
    /// The shift tables, state by state, largest difference first.
    pub states: Vec<Compared>,
    /// The operations by their names, largest difference first.
    pub operations: Vec<Compared>,
    /// Over axes, where asked for.
    pub map: Option<MapComparison>,
}

/// Compares variants, each with what it is called.
///
/// # Errors
/// Fewer than two variants, a state or an operation that none of them has, axes that do not fit all of them.
///
/// # Example
/// ```
/// use willis::model::Model;
/// use willis::study::{CompareRequest, compare};
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
///     mesh_efficiency = 0.99
/// "#;
/// let subject = |text: &str| Model::from_toml(text).unwrap();
/// let (a, b) = (subject(text), subject(&text.replace("0.99", "0.98")));
/// let all = compare(&[("a", &a), ("b", &b)], &CompareRequest::default())?;
/// assert_eq!(all.files[0].path, "P1.mesh_efficiency");
/// assert!(all.states[0].differences.iter().any(|d| d.quantity == "efficiency driving"));
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn compare(variants: &[(&str, &Model)], request: &CompareRequest) -> Result<Comparison, Diagnostics> {
    if variants.len() < 2 {
        let d = Diagnostic::new(Code::Unfit, "", "one train cannot be compared");
        return Err(d.hint("name two files or more").into());
    }
    let trains: Vec<&Train> = variants.iter().map(|v| v.1.train()).collect();
    selected(&trains, request)?;
    let labels: Vec<String> = (0..variants.len()).map(label).collect();
    let documents: Vec<Value> = variants.iter().map(|v| read(v.1)).collect();
    let mut files = vec![];
    differ("", &documents.iter().map(Some).collect::<Vec<_>>(), &mut files);
    // What only describes comes last.
    files.sort_by_key(|d| matches!(d.path.as_str(), "name" | "source" | "notes"));
    let map = match request.over.is_empty() {
        true => None,
        false => Some(map(variants, &labels, request)?),
    };
    Ok(Comparison {
        format: "willis-compare-1",
        variants: (variants.iter().zip(&labels))
            .map(|((file, subject), label)| Variant {
                label: label.clone(),
                file: (*file).to_owned(),
                train: subject.train().name().to_owned(),
            })
            .collect(),
        identical: files.is_empty(),
        files,
        states: states(&trains, &labels, request),
        operations: operations(&trains, &labels, request),
        map,
    })
}

/// `A` to `Z`, then numbers.
fn label(k: usize) -> String {
    if k < 26 { char::from(b'A' + k as u8).to_string() } else { (k + 1).to_string() }
}

/// Whether some variant has what is asked for.
fn selected(trains: &[&Train], request: &CompareRequest) -> Result<(), Diagnostics> {
    let mut wrong = Diagnostics::default();
    let mut look = |what: &str, name: &Option<String>, known: Vec<&str>| {
        if let Some(name) = name.as_ref().filter(|n| !known.contains(&n.as_str())) {
            let d = Diagnostic::new(Code::UnknownSelection, "", format!("no variant has the {what} `{name}`"));
            wrong.push(d.suggest(name, known));
        }
    };
    look("state", &request.state, trains.iter().flat_map(|t| t.states()).map(|s| s.name.as_str()).collect());
    look(
        "operation",
        &request.operation,
        trains.iter().flat_map(|t| t.operations()).map(|o| o.name.as_str()).collect(),
    );
    if wrong.has_errors() { Err(wrong) } else { Ok(()) }
}

// ---- files ---------------------------------------------------------------------------------

fn read(subject: &Model) -> Value {
    let table: Table = subject.document().text().parse().expect("the text was read as TOML");
    Value::Table(table)
}

fn name_of(entry: &Value) -> Option<&str> {
    entry.get("name")?.as_str()
}

fn tables(value: &Value) -> Option<&Vec<Value>> {
    value.as_array().filter(|all| !all.is_empty() && all.iter().all(Value::is_table))
}

/// The keys in which values differ.
fn differ(path: &str, values: &[Option<&Value>], out: &mut Vec<TextDifference>) {
    let below = |name: &str| if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") };
    let all: Vec<&Value> = values.iter().flatten().copied().collect();
    let everywhere = all.len() == values.len();
    if everywhere && all.iter().all(|v| v.is_table()) {
        let mut names: Vec<&String> = vec![];
        for name in all.iter().filter_map(|v| v.as_table()).flat_map(Table::keys) {
            if !names.contains(&name) {
                names.push(name);
            }
        }
        for name in names {
            let inner: Vec<Option<&Value>> = all.iter().map(|v| v.get(name)).collect();
            differ(&below(name), &inner, out);
        }
        return;
    }
    // A list of named tables may be missing as a whole: its entries are then.
    if all.iter().all(|v| tables(v).is_some()) && (everywhere || all.iter().all(|v| name_of(&v[0]).is_some())) {
        let list = |v: &Option<&'_ Value>| -> Vec<(String, Value)> {
            let all = v.and_then(tables).map_or(&[][..], Vec::as_slice);
            all.iter().enumerate().map(|(k, e)| (name_of(e).map_or(k.to_string(), str::to_owned), e.clone())).collect()
        };
        let lists: Vec<Vec<(String, Value)>> = values.iter().map(list).collect();
        let mut names: Vec<&String> = vec![];
        for (name, _) in lists.iter().flatten() {
            if !names.contains(&name) {
                names.push(name);
            }
        }
        for name in names {
            let inner: Vec<Option<&Value>> =
                lists.iter().map(|l| l.iter().find(|e| e.0 == *name).map(|e| &e.1)).collect();
            // Sets are called by their names alone.
            let called = if path == "set" { name.clone() } else { below(name) };
            differ(&called, &inner, out);
        }
        return;
    }
    if everywhere && all.iter().all(|v| equal(v, all[0])) {
        return;
    }
    let values = values.iter().map(|v| v.map(written)).collect();
    out.push(TextDifference { path: path.to_owned(), values });
}

fn equal(a: &Value, b: &Value) -> bool {
    let number = |v: &Value| v.as_float().or(v.as_integer().map(|k| k as f64));
    a == b || number(a).is_some_and(|x| number(b) == Some(x))
}

/// A value as the file has it, on one line.
fn written(value: &Value) -> String {
    match value {
        Value::String(s) => s.clone(),
        Value::Integer(k) => k.to_string(),
        Value::Float(x) => x.to_string(),
        Value::Boolean(b) => b.to_string(),
        Value::Datetime(d) => d.to_string(),
        Value::Array(all) => format!("[{}]", all.iter().map(written).collect::<Vec<_>>().join(", ")),
        Value::Table(t) => {
            let all: Vec<String> = t.iter().map(|(name, v)| format!("{name} = {}", written(v))).collect();
            format!("{{ {} }}", all.join(", "))
        }
    }
}

// ---- results -------------------------------------------------------------------------------

/// A result of one variant.
struct Fact {
    quantity: String,
    unit: &'static str,
    value: Datum,
}

fn fact(quantity: impl Into<String>, unit: &'static str, value: Option<f64>) -> Fact {
    let value = value.filter(|x| x.is_finite()).map_or(Datum::None, Datum::Number);
    Fact { quantity: quantity.into(), unit, value }
}

fn word(quantity: &str, value: impl Into<String>) -> Fact {
    Fact { quantity: quantity.into(), unit: "", value: Datum::Word(value.into()) }
}

fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= ROUND_OFF * a.abs().max(b.abs()) || (a - b).abs() < 1e-12
}

/// Facts that differ between those variants that have any, and how many do not.
fn differences(all: &[Option<Vec<Fact>>]) -> (Vec<Difference>, usize) {
    let mut names: Vec<(&str, &'static str)> = vec![];
    for f in all.iter().flatten().flatten() {
        if !names.iter().any(|n| n.0 == f.quantity) {
            names.push((&f.quantity, f.unit));
        }
    }
    let (mut out, mut equal) = (vec![], 0);
    if all.iter().flatten().count() < 2 {
        return (out, equal);
    }
    for (quantity, unit) in names {
        let values: Vec<Datum> = all
            .iter()
            .map(|facts| {
                let own = facts.as_ref().and_then(|f| f.iter().find(|f| f.quantity == quantity));
                own.map_or(Datum::None, |f| f.value.clone())
            })
            .collect();
        // A variant without the state or operation at all is told once, elsewhere.
        let present: Vec<&Datum> = values.iter().zip(all).filter(|(_, f)| f.is_some()).map(|(v, _)| v).collect();
        let is_same = present.windows(2).all(|w| match (w[0], w[1]) {
            (Datum::Number(a), Datum::Number(b)) => same(*a, *b),
            (a, b) => a == b,
        });
        if is_same {
            equal += 1;
            continue;
        }
        // An efficiency is as large as what it lacks to 1.
        let weigh = |x: f64| if unit == "efficiency" { 1.0 - x } else { x };
        let first = values[0].number();
        let against = |v: &Datum| Some((first?, v.number()?));
        let size = present
            .iter()
            .flat_map(|a| present.iter().map(move |b| (a, b)))
            .map(|(a, b)| match (a, b) {
                (Datum::Number(a), Datum::Number(b)) => {
                    let most = weigh(*a).abs().max(weigh(*b).abs());
                    if most > 0.0 { ((a - b).abs() / most).min(2.0) } else { 0.0 }
                }
                (a, b) if a == b => 0.0,
                _ => 2.0,
            })
            .fold(0.0, f64::max);
        out.push(Difference {
            quantity: quantity.to_owned(),
            unit,
            differences: values.iter().map(|v| against(v).map(|(a, b)| b - a)).collect(),
            relative: values
                .iter()
                .map(|v| against(v).map(|(a, b)| (b - a) / weigh(a).abs()).filter(|r| r.is_finite()))
                .collect(),
            values,
            size,
        });
    }
    // Stable: of equal ones in the order in which they are usually read.
    // What is asked first stands first, however large the rest.
    let is_headline = |d: &Difference| matches!(d.quantity.as_str(), "efficiency" | "loss");
    out.sort_by(|a, b| is_headline(b).cmp(&is_headline(a)).then(b.size.total_cmp(&a.size)));
    (out, equal)
}

/// Names in the order in which variants have them.
fn union<'a>(all: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut names = vec![];
    for name in all {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names
}

fn missing(present: impl Iterator<Item = bool>, labels: &[String]) -> Vec<String> {
    present.zip(labels).filter(|(is, _)| !is).map(|(_, l)| l.clone()).collect()
}

fn states(trains: &[&Train], labels: &[String], request: &CompareRequest) -> Vec<Compared> {
    // Of operations that make no question the table knows nothing.
    let tables: Vec<_> = (trains.iter())
        .map(|t| {
            let mut bare = (*t).clone();
            bare.operations.clear();
            analysis::analyze(&bare, &Selection::default()).map(|a| a.ratios).unwrap_or_default()
        })
        .collect();
    let names = union(tables.iter().flat_map(|t| t.iter()).map(|(name, _)| name.as_str()));
    let mut all: Vec<Compared> = names
        .into_iter()
        .filter(|n| request.state.as_ref().is_none_or(|s| s == n))
        .map(|name| {
            let own: Vec<Option<&StateReport>> = tables.iter().map(|t| t.get(name)).collect();
            let facts: Vec<_> = own.iter().map(|s| s.map(state_facts)).collect();
            let (differences, equal) = differences(&facts);
            let reason = |s: &StateReport| -> Option<String> {
                s.no_ratio.clone().or(s.drive.reason.clone()).or(s.coast.reason.clone())
            };
            let reasons = own.iter().zip(labels).filter_map(|(s, l)| Some((l.clone(), reason((*s)?)?))).collect();
            let missing_in = missing(own.iter().map(Option::is_some), labels);
            let reasons = if differences.is_empty() { vec![] } else { reasons };
            Compared { name: name.to_owned(), missing_in, prescribed: vec![], differences, equal, reasons }
        })
        .collect();
    all.sort_by(|a, b| b.size().total_cmp(&a.size()));
    all
}

fn state_facts(s: &StateReport) -> Vec<Fact> {
    let verdict = |d: &Direction| serde_json::to_value(d.verdict).ok().and_then(|v| v.as_str().map(str::to_owned));
    vec![
        fact("ratio", "", s.value),
        fact("step", "", s.step),
        fact("efficiency driving", "efficiency", s.drive.efficiency),
        fact("efficiency coasting", "efficiency", s.coast.efficiency),
        word("verdict driving", verdict(&s.drive).unwrap_or_default()),
        word("verdict coasting", verdict(&s.coast).unwrap_or_default()),
    ]
}

fn operations(trains: &[&Train], labels: &[String], request: &CompareRequest) -> Vec<Compared> {
    let state = |t: &Train, o: &Operation| o.state.map(|k| t.states()[k].name.clone());
    let names = union(trains.iter().flat_map(|t| t.operations()).map(|o| o.name.as_str()));
    let mut all: Vec<Compared> = names
        .into_iter()
        .filter(|n| request.operation.as_ref().is_none_or(|o| o == n))
        .filter_map(|name| {
            let own: Vec<Option<&Operation>> =
                trains.iter().map(|t| t.operations().iter().find(|o| o.name == name)).collect();
            let in_state = |(t, o): (&&Train, &Option<&Operation>)| o.is_some_and(|o| state(t, o) == request.state);
            if request.state.is_some() && !trains.iter().zip(&own).any(in_state) {
                return None;
            }
            let answers: Vec<Option<Answer>> =
                trains.iter().zip(&own).map(|(t, o)| o.map(|o| Answer::of(t, o))).collect();
            let facts: Vec<_> = answers.iter().map(|a| a.as_ref().map(operation_facts)).collect();
            let (differences, equal) = differences(&facts);
            let reasons: Vec<(String, String)> = (answers.iter().zip(labels))
                .filter_map(|(a, l)| Some((l.clone(), a.as_ref()?.reason.clone())))
                .filter(|r| !r.1.is_empty())
                .collect();
            let points: Vec<_> = trains.iter().zip(&own).map(|(t, o)| o.map(|o| point(t, o))).collect();
            Some(Compared {
                name: name.to_owned(),
                missing_in: missing(own.iter().map(Option::is_some), labels),
                prescribed: prescribed(&points),
                differences,
                equal,
                reasons,
            })
        })
        .collect();
    all.sort_by(|a, b| b.size().total_cmp(&a.size()));
    all
}

/// What an operation prescribes, in words.
fn point(train: &Train, o: &Operation) -> Vec<(String, String)> {
    let mut all = vec![];
    if let Some(k) = o.state {
        all.push(("state".to_owned(), train.states()[k].name.clone()));
    }
    let name = |m| train.member_name(m);
    let short = |x: f64| format!("{:.6e}", x).parse::<f64>().unwrap_or(x).to_string();
    for (m, w) in &o.speeds {
        all.push((format!("speed of {}", name(*m)), format!("{} rpm", short(w.si() * 30.0 / std::f64::consts::PI))));
    }
    for (m, load) in &o.loads {
        let text = match load {
            Load::Torque(q) => format!("torque {} N m", short(q.si())),
            Load::Power(q) => format!("power {} W", short(q.si())),
        };
        all.push((format!("load at {}", name(*m)), text));
    }
    if !o.fixed.is_empty() {
        all.push(("held".into(), o.fixed.iter().map(|m| name(*m)).collect::<Vec<_>>().join(", ")));
    }
    if let Some(t) = o.temperature.or(train.lubrication.as_ref().map(|l| l.temperature)) {
        all.push(("oil".into(), format!("{} degC", short(t - 273.15))));
    }
    all
}

/// In what operations of one name differ.
fn prescribed(points: &[Option<Vec<(String, String)>>]) -> Vec<TextDifference> {
    let names = union(points.iter().flatten().flatten().map(|p| p.0.as_str()));
    let value = |p: &Option<Vec<(String, String)>>, name: &str| {
        p.as_ref().and_then(|p| p.iter().find(|x| x.0 == name)).map(|x| x.1.clone())
    };
    let all = names
        .into_iter()
        .map(|name| TextDifference { path: name.to_owned(), values: points.iter().map(|p| value(p, name)).collect() });
    all.filter(|d| {
        let mut present = d.values.iter().zip(points).filter(|(_, p)| p.is_some()).map(|(v, _)| v);
        let first = present.next();
        present.any(|v| Some(v) != first)
    })
    .collect()
}

fn operation_facts(answer: &Answer) -> Vec<Fact> {
    let mut all = vec![word("verdict", answer.verdict)];
    if let Some(s) = &answer.solution {
        solution_facts(s, &mut all);
    }
    all
}

fn solution_facts(s: &SolutionReport, all: &mut Vec<Fact>) {
    all.push(fact("efficiency", "efficiency", s.efficiency));
    all.push(fact("input power", "W", Some(s.input_power_w)));
    all.push(fact("output power", "W", Some(s.output_power_w)));
    all.push(fact("loss", "W", Some(s.loss_w)));
    if s.sources.is_empty() {
        all.extend(s.meshes.iter().map(|(name, m)| fact(format!("loss in {name}"), "W", Some(m.loss_w))));
    } else {
        let Losses { mesh, bearing, windage, churning, seal } = s.losses_w;
        for (name, loss) in
            [("meshes", mesh), ("bearings", bearing), ("windage", windage), ("churning", churning), ("seals", seal)]
        {
            all.push(fact(format!("loss in all {name}"), "W", Some(loss)));
        }
        for x in &s.sources {
            let kind = serde_json::to_value(x.kind).ok().and_then(|v| v.as_str().map(str::to_owned));
            let kind = kind.unwrap_or_default();
            all.push(fact(format!("loss in {} ({kind})", x.name), "W", Some(x.loss_w)));
        }
    }
    for (name, m) in s.members.iter() {
        all.push(fact(format!("torque on {name}"), "N m", m.torque_n_m));
    }
    for (name, m) in s.members.iter() {
        all.push(fact(format!("speed of {name}"), "rad/s", m.speed_rad_s));
    }
    for (name, e) in s.shift_elements.iter() {
        all.push(fact(format!("torque of {} {name}", e.kind), "N m", e.torque_n_m));
    }
    for (name, c) in s.contacts.iter() {
        all.push(fact(format!("contact pressure in {name}"), "Pa", Some(c.pressure_pa)));
        all.push(fact(format!("film ratio in {name}"), "", c.film_ratio));
    }
    all.push(fact("circulating power", "W", Some(s.recirculation.iter().map(|r| r.power_w).fold(0.0, f64::max))));
    all.push(fact("factor on all losses that locks", "", s.margin.lock_loss_factor));
    if let Some(b) = &s.margin.torque {
        all.push(fact(format!("torque on {} that unloads {}", b.member, b.mesh), "N m", Some(b.boundary)));
    }
}

// ---- maps ----------------------------------------------------------------------------------

fn map(variants: &[(&str, &Model)], labels: &[String], request: &CompareRequest) -> Result<MapComparison, Diagnostics> {
    let mut sweeps = vec![];
    for (file, subject) in variants {
        let called = |wrong: Diagnostics| -> Diagnostics {
            let own = wrong.into_iter().map(|mut d| {
                d.message = format!("{file}: {}", d.message);
                d.span = None;
                d
            });
            own.collect()
        };
        let axes: Result<Vec<Axis>, _> = request.over.iter().map(|text| Axis::parse(text, subject)).collect();
        let axes = axes.map_err(|d| called((*d).into()))?;
        let question = Question::new(subject, request.operation.as_deref(), request.state.as_deref(), Hold::AsGiven);
        sweeps.push(question.and_then(|q| Sweep::new(q, axes, &[])).map_err(called)?);
    }
    let first = &sweeps[0];
    // Each against the first.
    for (k, other) in sweeps.iter().enumerate().skip(1) {
        for (a, b) in first.axes().iter().zip(other.axes()) {
            let is_same = a.len() == b.len() && (0..a.len().min(1000)).all(|k| a.setting(k) == b.setting(k));
            if !is_same {
                let message = format!("`{}` takes other values in {} than in {}", a.name, labels[k], labels[0]);
                let d = Diagnostic::new(Code::BadAxis, "", message);
                return Err(d.hint("list those that all variants have").into());
            }
        }
    }
    let points = first.len();
    if points > MOST_POINTS {
        let message = format!("{points} points are too many to compare; at most {MOST_POINTS} are");
        return Err(Diagnostic::new(Code::BadAxis, "", message)
            .hint("fewer values tell where a variant is better")
            .into());
    }
    let mut pairs: Vec<MapPair> = (1..sweeps.len())
        .map(|k| MapPair {
            first: labels[0].clone(),
            other: labels[k].clone(),
            compared: 0,
            only_first: 0,
            only_other: 0,
            neither: 0,
            efficiency: MapDifference::default(),
            loss_w: MapDifference::default(),
            bands: bands(first),
        })
        .collect();
    let mut trains: Vec<Trains> = sweeps.iter().map(|_| Trains::default()).collect();
    for point in 0..points {
        let answers: Vec<Option<(f64, f64)>> = (sweeps.iter().zip(&mut trains))
            .map(|(s, t)| {
                let answer = s.answer(point, t);
                let one = answer.verdict == "unique" && !answer.efficiency().is_nan();
                one.then(|| (answer.efficiency(), answer.loss()))
            })
            .collect();
        let place = first.place(point);
        for (pair, other) in pairs.iter_mut().zip(&answers[1..]) {
            let ((a, lost_a), (b, lost_b)) = match (answers[0], *other) {
                (Some(a), Some(b)) => (a, b),
                (Some(_), None) => {
                    pair.only_first += 1;
                    continue;
                }
                (None, Some(_)) => {
                    pair.only_other += 1;
                    continue;
                }
                (None, None) => {
                    pair.neither += 1;
                    continue;
                }
            };
            pair.compared += 1;
            pair.efficiency.add(a, b, true, || first.describe(point));
            pair.loss_w.add(lost_a, lost_b, false, || first.describe(point));
            let mut at = 0;
            for (axis, k) in first.axes().iter().zip(&place) {
                let count = axis.len().min(BANDS.max(if axis.is_text() { axis.len() } else { 0 }));
                let band = &mut pair.bands[at + k * count / axis.len()];
                at += count;
                let n = (band.better + band.worse + band.equal) as f64;
                band.mean = Some((band.mean.unwrap_or(0.0) * n + (b - a)) / (n + 1.0));
                *match (same(a, b), b > a) {
                    (true, _) => &mut band.equal,
                    (false, true) => &mut band.better,
                    (false, false) => &mut band.worse,
                } += 1;
            }
        }
    }
    let base: Vec<&Operation> = sweeps.iter().map(|s| s.question().base()).collect();
    // At the first point, so that what an axis sets is the same.
    let begun = sweeps.iter().zip(&mut trains).zip(variants).map(|((s, trains), v)| match s.ask(0, trains) {
        Ok((train, operation)) => Some(point(&train, &operation)),
        Err(_) => Some(point(v.1.train(), s.question().base())),
    });
    let bases: Vec<_> = begun.collect();
    Ok(MapComparison {
        over: request.over.clone(),
        points,
        operations: base.iter().map(|o| o.name.clone()).collect(),
        prescribed: prescribed(&bases),
        pairs,
    })
}

/// Parts of every axis, still empty.
fn bands(sweep: &Sweep<'_>) -> Vec<Band> {
    let of_axis = |axis: &Axis| -> Vec<Band> {
        let n = axis.len();
        let count = n.min(BANDS.max(if axis.is_text() { n } else { 0 }));
        let band = |b: usize| {
            let inside: Vec<usize> = (0..n).filter(|k| k * count / n == b).collect();
            let (from, to) = (inside.first().copied().unwrap_or(0), inside.last().copied().unwrap_or(0));
            let (from, to) = (axis.setting(from), axis.setting(to));
            Band { axis: axis.name.clone(), from, to, better: 0, worse: 0, equal: 0, mean: None }
        };
        (0..count).map(band).collect()
    };
    sweep.axes().iter().flat_map(of_axis).collect()
}
