//! What of a train file an export does not hold; it is told.
//!
//! A key is carried where another value of it makes another file. That is tried, key by key, on the train as it is and
//! in the format that was asked for: no list says what a format or a law looks at, so none can be wrong or forget a key.
//! What the train consists of (names, tooth counts, efficiencies as given) is in every format and not tried: that a set
//! runs idle in the state that is exported is no loss.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use crate::catalogue::{bearing, oil};
use crate::exact::Rational;
use crate::losses;
use crate::model::Model;
use crate::train::{KeyKind, Specification, Train, kind_of};

/// A key of the train file that is not in the export.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct NotCarried {
    /// The key, without the positions of lists: `drag.coulomb`, `shift_element.capacity`.
    pub key: String,
    /// The entries that have it, by their names, where they have some.
    pub of: Vec<String>,
    /// What is missing, with its unit: a text for each of `of`, or one where nothing has a name.
    #[serde(default)]
    pub values: Vec<String>,
    /// Whether other values of the same entries are carried, as the first row of a table.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub in_part: bool,
}

/// What tells nothing of the train: what the file is, and what is to be asked of the train.
const ABOUT: &[&str] = &["format", "name", "source", "notes", "operation", "scenario", "study"];

/// What the train consists of, who is joined to whom, and the efficiencies as given.
fn is_train(key: &[&str], kind: KeyKind) -> bool {
    match key {
        // A name of the catalogue stands for data.
        ["oil", "name"] => false,
        [.., "name"] => true,
        ["set", .., part, "teeth"] => !part.ends_with("planet"),
        ["set", .., "type" | "side" | "planet_teeth"] => true,
        ["set" | "mesh", "efficiency" | "mesh_efficiency" | "basic_efficiency", ..] => true,
        ["mesh", "gears", "teeth" | "internal"] | ["mesh", "sense" | "kind"] => true,
        ["shift_element", "kind" | "blocks"] => true,
        // Where heat is made joins no shafts.
        ["heat", "node", "parts"] => false,
        _ => matches!(kind, KeyKind::Name | KeyKind::Names),
    }
}

/// A value of the file.
struct Leaf {
    /// Keys from the outside in, without the positions of lists.
    key: Vec<String>,
    /// Where it stands in the specification.
    pointer: String,
    /// The name of the entry that it is in.
    of: Option<String>,
    /// What it could be as well.
    others: Vec<Value>,
    /// Whether it is a word and no number.
    is_text: bool,
}

/// What the files of an export say of a train; none where it cannot be exported.
type Texts<'w> = &'w dyn Fn(&Train) -> Option<Vec<String>>;

/// What the file has and an export does not hold, in the order of the file.
pub(super) fn left_out(model: &Model, write: Texts<'_>) -> Vec<NotCarried> {
    let mut written = serde_json::to_value(model.specification()).expect("plain data");
    if let Some(table) = written.as_object_mut() {
        // Laws in force over those of the text are as if they stood there.
        if !model.laws().is_empty()
            && let Some(laws) = table.entry("laws").or_insert(Value::Object(Map::new())).as_object_mut()
        {
            laws.extend(model.laws().iter().map(|(family, law)| (family.clone(), Value::from(law.as_str()))));
        }
        table.retain(|key, _| !ABOUT.contains(&key.as_str()) || ["format", "name"].contains(&key.as_str()));
    }
    let mut leaves = vec![];
    collect(&written, &mut vec![], String::new(), None, &mut leaves);
    // Beside viscosities the name of an oil is a label.
    let has_data = written["oil"].as_object().is_some_and(|oil| oil.keys().any(|key| key.starts_with("viscosity")));
    leaves.retain(|l| !(has_data && l.key == ["oil", "name"]));
    let trial = Trial::new(written, write);
    let mut keys: Vec<&[String]> = vec![];
    for leaf in &leaves {
        if !keys.contains(&&leaf.key[..]) {
            keys.push(&leaf.key);
        }
    }
    keys.iter().filter_map(|key| trial.left(&leaves.iter().filter(|l| l.key == *key).collect::<Vec<_>>())).collect()
}

/// How many operating points [`left_out`] needs, at most about.
pub(super) fn trials(model: &Model) -> u64 {
    /// Points of a map at the ends of its ranges, for two other values of each.
    const EACH: u64 = 8;
    let written = serde_json::to_value(model.specification()).expect("plain data");
    let mut leaves = vec![];
    collect(&written, &mut vec![], String::new(), None, &mut leaves);
    EACH * leaves.len() as u64
}

/// Exports of the same train with other values.
struct Trial<'w> {
    written: Value,
    write: Texts<'w>,
    /// What the files say of the train as it is.
    texts: Option<Vec<String>>,
}

impl<'w> Trial<'w> {
    fn new(written: Value, write: Texts<'w>) -> Self {
        let mut trial = Self { written, write, texts: None };
        trial.texts = trial.texts_of(&trial.written).flatten();
        trial
    }

    /// What the files say of a train; none where there is no such train.
    fn texts_of(&self, written: &Value) -> Option<Option<Vec<String>>> {
        let train = Specification::deserialize(written).ok()?.build().ok()?;
        Some((self.write)(&train))
    }

    /// Whether other values of these make another file.
    fn moves(&self, leaves: &[&Leaf]) -> bool {
        /// That many other numbers or words that change nothing are enough.
        const ENOUGH: [usize; 2] = [2, 4];
        let most = leaves.iter().map(|l| l.others.len()).max().unwrap_or(0);
        let with = |k: Option<usize>| {
            let mut written = self.written.clone();
            for leaf in leaves {
                let (table, key) = leaf.pointer.rsplit_once('/').expect("it begins with one");
                let table = written.pointer_mut(table).and_then(Value::as_object_mut).expect("it was found there");
                let key = unescaped(key);
                match k.and_then(|k| leaf.others.get(k).or(leaf.others.last())) {
                    Some(other) => table.insert(key, other.clone()),
                    None => table.remove(&key),
                };
            }
            self.texts_of(&written)
        };
        let is_text = leaves.iter().all(|l| l.is_text);
        let mut tried = 0;
        for texts in (0..most).filter_map(|k| with(Some(k))) {
            if differ(&texts, &self.texts) {
                return true;
            }
            tried += 1;
            if tried >= ENOUGH[usize::from(is_text)] {
                break;
            }
        }
        match tried {
            0 if is_text => with(None).is_some_and(|texts| differ(&texts, &self.texts)),
            // A number that can be no other follows from the rest, as the teeth of a planet between sun and ring.
            tried => tried == 0,
        }
    }

    /// What is left out of one key.
    fn left(&self, leaves: &[&Leaf]) -> Option<NotCarried> {
        let carried: Vec<bool> = match self.moves(leaves) {
            true if leaves.len() > 1 => leaves.iter().map(|l| self.moves(&[l])).collect(),
            all => vec![all; leaves.len()],
        };
        let mut values: BTreeMap<Option<&str>, Vec<String>> = BTreeMap::new();
        let mut of: Vec<Option<&str>> = vec![];
        for (leaf, _) in leaves.iter().zip(&carried).filter(|(_, carried)| !**carried) {
            let own = leaf.of.as_deref();
            if !of.contains(&own) {
                of.push(own);
            }
            values.entry(own).or_default().push(in_words(&self.written, leaf));
        }
        // Names first, and what has none behind them.
        of.sort_by_key(Option::is_none);
        let in_part = leaves.iter().zip(&carried).any(|(l, carried)| *carried && of.contains(&l.of.as_deref()));
        (!of.is_empty()).then(|| NotCarried {
            key: leaves[0].key.join("."),
            values: of.iter().map(|o| values[o].join(", ")).collect(),
            of: of.into_iter().flatten().map(str::to_owned).collect(),
            in_part,
        })
    }
}

/// Whether files differ by more than rounding.
fn differ(a: &Option<Vec<String>>, b: &Option<Vec<String>>) -> bool {
    /// Of a number, and of the largest beside it: what is lost is a small difference of large numbers.
    const ROUNDING: [f64; 2] = [1e-11, 1e-13];
    let words = |line: &str| -> Vec<String> {
        let parts = line.split(|c: char| !(c.is_alphanumeric() || matches!(c, '.' | '-' | '+')));
        parts.filter(|w| !w.is_empty()).map(str::to_owned).collect()
    };
    let same_line = |(a, b): (&str, &str)| {
        if a == b {
            return true;
        }
        let [a, b] = [a, b].map(words);
        let number = |w: &String| w.parse::<f64>().ok();
        let largest = a.iter().filter_map(number).fold(0.0f64, |most, x| most.max(x.abs()));
        a.len() == b.len()
            && a.iter().zip(&b).all(|(a, b)| match (number(a), number(b)) {
                (Some(x), Some(y)) => (x - y).abs() <= (ROUNDING[0] * x.abs().max(y.abs())).max(ROUNDING[1] * largest),
                _ => a == b,
            })
    };
    let (Some(a), Some(b)) = (a, b) else { return a.is_some() != b.is_some() };
    let same =
        |(a, b): (&String, &String)| a.lines().count() == b.lines().count() && a.lines().zip(b.lines()).all(same_line);
    a.len() != b.len() || !a.iter().zip(b).all(same)
}

/// A key in a pointer of JSON.
fn escaped(key: &str) -> String {
    key.replace('~', "~0").replace('/', "~1")
}

fn unescaped(key: &str) -> String {
    key.replace("~1", "/").replace("~0", "~")
}

/// Every value of the file that is tried.
fn collect(value: &Value, key: &mut Vec<String>, pointer: String, of: Option<&str>, all: &mut Vec<Leaf>) {
    match value {
        Value::Null => {}
        Value::Object(table) => {
            // The innermost name that there is.
            let of = table.get("name").and_then(Value::as_str).filter(|_| !key.is_empty()).or(of);
            for (name, value) in table {
                key.push(name.clone());
                collect(value, key, format!("{pointer}/{}", escaped(name)), of, all);
                key.pop();
            }
        }
        Value::Array(entries) if entries.iter().any(Value::is_object) => {
            for (k, value) in entries.iter().enumerate() {
                collect(value, key, format!("{pointer}/{k}"), of, all);
            }
        }
        _ => {
            let steps: Vec<&str> = key.iter().map(String::as_str).collect();
            let Some(kind) = kind_of(&steps).filter(|kind| !is_train(&steps, *kind)) else { return };
            if ABOUT.contains(&steps[0]) {
                return;
            }
            let of = of.filter(|_| steps != ["oil", "name"]).map(str::to_owned);
            let is_text = value.as_str().is_some_and(|text| measured(text).is_none());
            all.push(Leaf { key: key.clone(), pointer, of, others: others(&steps, kind, value), is_text });
        }
    }
}

/// Other values of a key, the likeliest to be possible first.
fn others(key: &[&str], kind: KeyKind, value: &Value) -> Vec<Value> {
    let texts = |all: Vec<&str>| -> Vec<Value> {
        all.into_iter().filter(|other| Some(*other) != value.as_str()).map(Value::from).collect()
    };
    match (key, kind, value) {
        (["laws", family], KeyKind::Text, _) => {
            texts(losses::entries().iter().filter(|e| e.family == *family).map(|e| e.id).collect())
        }
        (["oil", "name"], ..) => texts(oil::all().iter().map(|o| &*o.name).collect()),
        (["bearing", "designation"], ..) => {
            let own = value.as_str().and_then(bearing::find);
            let mut like: Vec<_> = bearing::all().iter().collect();
            // Another one on the same shaft.
            like.sort_by_key(|b| own.as_ref().is_some_and(|o| o.bore != b.bore));
            texts(like.iter().take(8).map(|b| &*b.designation).collect())
        }
        (["bearing", "series"], ..) => {
            let mut all: Vec<&str> = bearing::all().iter().map(|b| &*b.series).collect();
            all.sort_unstable();
            all.dedup();
            texts(all)
        }
        (["heat", "node", "parts"], ..) => vec![Value::Array(vec![])],
        (_, KeyKind::Choice(all), _) => texts(all.to_vec()),
        (_, _, Value::Bool(is)) => vec![Value::from(!is)],
        (_, KeyKind::Integer, Value::Number(n)) => {
            let n = n.as_i64().unwrap_or(1);
            [1, -1, n].map(|more| Value::from(n.saturating_add(more))).to_vec()
        }
        // Large enough to be seen behind rounding; smaller where the parts must fit.
        _ => [1.1, 0.9, 1.01, 0.99, 1.0001, 0.9999].iter().filter_map(|factor| scaled(value, *factor)).collect(),
    }
}

/// A number with or without a unit, or the second one of each pair, times a factor.
fn scaled(value: &Value, factor: f64) -> Option<Value> {
    // What is zero becomes a little more.
    let times = |x: f64| if x == 0.0 { (factor - 1.0).abs() } else { x * factor };
    match value {
        Value::Number(n) => Some(Value::from(times(n.as_f64()?))),
        Value::String(text) => {
            let (number, unit) = measured(text)?;
            Some(Value::from(format!("{:?} {unit}", times(number))))
        }
        Value::Array(pairs) => pairs
            .iter()
            .map(|pair| match pair.as_array()?.as_slice() {
                [first, second] => Some(Value::from(vec![first.clone(), scaled(second, factor)?])),
                _ => None,
            })
            .collect::<Option<Vec<_>>>()
            .map(Value::from),
        _ => None,
    }
}

/// `12 mm`: number and unit.
fn measured(text: &str) -> Option<(f64, &str)> {
    let (number, unit) = text.split_once(' ')?;
    Some((number.parse::<Rational>().ok()?.to_f64(), unit))
}

/// The value of a key in a sentence.
fn in_words(written: &Value, leaf: &Leaf) -> String {
    match written.pointer(&leaf.pointer) {
        Some(Value::String(text)) => text.clone(),
        Some(Value::Array(points)) => format!("{} points", points.len()),
        Some(value) => value.to_string(),
        None => String::new(),
    }
}

/// All of it in a sentence; none where everything is carried over.
pub(super) fn sentence(all: &[NotCarried]) -> Option<String> {
    /// Keys, and entries of a key.
    const MOST: [usize; 2] = [12, 4];
    let one = |n: &NotCarried| {
        let entry = |(k, value): (usize, &String)| match n.of.get(k) {
            Some(name) => format!("{name}: {value}"),
            None => value.clone(),
        };
        let mut entries: Vec<String> = n.values.iter().enumerate().take(MOST[1]).map(entry).collect();
        let more = n.values.len().saturating_sub(MOST[1]);
        if more > 0 {
            entries.push(format!("{more} more"));
        }
        let part = if n.in_part { " in part" } else { "" };
        format!("{}{part} ({})", n.key, entries.join("; "))
    };
    let told = all.iter().take(MOST[0]).map(one).collect::<Vec<_>>().join(", ");
    let more = all.len().saturating_sub(MOST[0]);
    let more = if more > 0 { format!(" and {more} keys more") } else { String::new() };
    (!all.is_empty()).then(|| format!("not carried over from the file: {told}{more}"))
}
