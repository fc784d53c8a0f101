//! JSON Schema (draft 2020-12) of the train file, from the same description that the reader uses.

use serde_json::{Map, Value, json};

use crate::units::Dimension;

use super::keys::{FILE, Key, Kind, Measure, NUMBER_SIGNAL, SPEED_SIGNAL, SignalKind, TORQUE_SIGNAL, Table};

/// The JSON Schema of the train file, format 1, for editors that complete and check TOML.
///
/// # Example
/// ```
/// let schema = willis::train::schema();
/// assert_eq!(schema["properties"]["format"]["const"], 1);
/// ```
pub fn schema() -> Value {
    let mut root = table(&FILE);
    let head = json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Willis gear train, format 1",
    });
    let body = root.as_object_mut().expect("a table is an object");
    let mut all = head.as_object().expect("an object").clone();
    all.append(body);
    let signals = [&TORQUE_SIGNAL, &SPEED_SIGNAL, &NUMBER_SIGNAL];
    let definitions: Map<String, Value> = signals.iter().map(|s| (s.name.to_owned(), signal(s))).collect();
    all.insert("$defs".into(), definitions.into());
    Value::Object(all)
}

/// Signals contain signals, so they are defined once and referred to.
fn signal(s: &SignalKind) -> Value {
    let mut all = vec![measure(s.of)];
    all.extend(s.types.iter().map(|(name, t)| {
        let mut schema = table(t);
        schema["properties"]["type"] = json!({ "const": name });
        schema
    }));
    json!({ "anyOf": all })
}

fn reference(s: &SignalKind) -> Value {
    json!({ "$ref": format!("#/$defs/{}", s.name) })
}

/// A number with a unit, or a plain one.
fn measure(m: Measure) -> Value {
    let Some(dimension) = m else { return json!({ "type": "number" }) };
    let (what, example) = dimension.describe();
    json!({ "type": "string", "description": format!("{what} with its unit"), "examples": [example] })
}

fn pair_of(items: [Value; 2]) -> Value {
    json!({ "type": "array", "prefixItems": items, "minItems": 2, "maxItems": 2 })
}

fn points(of: [Measure; 2]) -> Value {
    json!({ "type": "array", "items": pair_of(of.map(measure)), "minItems": 1 })
}

fn table(t: &Table) -> Value {
    let properties: Map<String, Value> = t.keys.iter().map(|k| (k.name.to_owned(), key(k))).collect();
    let required: Vec<_> = t.keys.iter().filter(|k| k.required).map(|k| k.name).collect();
    json!({
        "description": t.doc,
        "type": "object",
        "properties": properties,
        "required": required,
        "additionalProperties": false,
    })
}

fn key(k: &Key) -> Value {
    let mut schema = kind(&k.kind);
    schema.as_object_mut().expect("every kind is an object").insert("description".into(), k.doc.into());
    schema
}

fn kind(k: &Kind) -> Value {
    let number = json!({ "type": "number", "exclusiveMinimum": 0, "maximum": 1 });
    let pair = |names: [&str; 2], of: &Value| {
        json!({
            "type": "object",
            "properties": { names[0]: of, names[1]: of },
            "required": names,
            "additionalProperties": false,
        })
    };
    let efficiency = json!({ "anyOf": [number, pair(["forward", "backward"], &number)] });
    match k {
        Kind::Format => json!({ "const": 1 }),
        Kind::Text => json!({ "type": "string" }),
        Kind::Name => json!({ "type": "string", "minLength": 1, "maxLength": 64 }),
        Kind::Names => json!({ "type": "array", "items": { "type": "string", "minLength": 1, "maxLength": 64 } }),
        Kind::Integer => json!({ "type": "integer", "minimum": 1, "maximum": 100_000 }),
        Kind::Flag => json!({ "type": "boolean" }),
        Kind::Choice(choices) => json!({ "enum": choices }),
        Kind::Efficiency => efficiency,
        Kind::SetEfficiency => {
            json!({ "anyOf": [efficiency.clone(), pair(["external", "internal"], &efficiency)] })
        }
        Kind::Samples => json!({ "type": "integer", "minimum": 2, "maximum": 10_000_000 }),
        Kind::Number => measure(None),
        Kind::Quantity(dimension) => measure(Some(*dimension)),
        Kind::Quantities(dimension) => {
            json!({ "type": "object", "additionalProperties": measure(Some(*dimension)) })
        }
        Kind::Points(of) => points(*of),
        Kind::NumberOrPoints(over) => json!({ "anyOf": [measure(None), points([Some(*over), None])] }),
        Kind::Schedule => {
            let entry = pair_of([measure(Some(Dimension::TIME)), json!({ "type": "string" })]);
            json!({ "type": "array", "items": entry, "minItems": 1 })
        }
        Kind::Signal(s) => reference(s),
        Kind::Product(s) => pair_of([reference(s), reference(&NUMBER_SIGNAL)]),
        Kind::Table(t) => table(t),
        Kind::Tables(t, 0) => json!({ "type": "array", "items": table(t) }),
        Kind::Tables(t, n) => json!({ "type": "array", "items": table(t), "minItems": n, "maxItems": n }),
        Kind::Variants(variants) => {
            let one_of: Vec<Value> = variants
                .iter()
                .enumerate()
                .map(|(i, (name, t))| {
                    let mut schema = table(t);
                    schema["properties"]["type"] = json!({ "const": name });
                    if i > 0 {
                        schema["required"].as_array_mut().expect("a list").push("type".into());
                    }
                    schema
                })
                .collect();
            json!({ "type": "array", "items": { "oneOf": one_of } })
        }
    }
}
