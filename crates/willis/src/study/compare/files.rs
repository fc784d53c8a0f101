//! The keys in which the files of variants differ.

use toml::{Table, Value};

use crate::model::Model;

use super::TextDifference;

/// The keys in which files differ.
pub(super) fn differences<'a>(variants: impl Iterator<Item = &'a Model>) -> Vec<TextDifference> {
    let documents: Vec<Value> = variants.map(read).collect();
    let mut all = vec![];
    differ("", &documents.iter().map(Some).collect::<Vec<_>>(), &mut all);
    // What only describes comes last.
    all.sort_by_key(|d| matches!(d.path.as_str(), "name" | "source" | "notes"));
    all
}

fn read(model: &Model) -> Value {
    let table: Table = model.to_toml().parse().expect("the text was read as TOML");
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
