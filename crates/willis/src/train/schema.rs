//! JSON Schema (draft 2020-12) of the train file, from the same description that the reader uses.

use serde_json::{Map, Value, json};

use crate::units::{self, Dimension};

use super::format::keys::{FREE, Key, Kind, Measure, SignalKind, Table, TypedTable, about};
use super::specification::FILE;

/// Where the schema is known by, whatever place it is read from.
const ID: &str = "urn:willis:schema:willis-1";

/// The JSON Schema of the train file, format 1, for editors that complete and check TOML.
///
/// # Example
/// ```
/// let schema = willis::train::schema();
/// assert_eq!(schema["properties"]["format"]["const"], 1);
/// ```
pub fn schema() -> Value {
    let mut definitions = Definitions::default();
    let mut root = definitions.table(FILE);
    let head = json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "$id": ID,
        "title": "Willis gear train, format 1",
    });
    let body = root.as_object_mut().expect("a table is an object");
    let mut all = head.as_object().expect("an object").clone();
    all.append(body);
    all.insert("$defs".into(), definitions.0.into());
    Value::Object(all)
}

/// What is said once and referred to: quantities by their dimension, and signals, which contain signals.
#[derive(Default)]
struct Definitions(Map<String, Value>);

fn reference(name: &str) -> Value {
    json!({ "$ref": format!("#/$defs/{name}") })
}

/// A number before a unit.
const NUMBER: &str = r"\s*[-+\u2212]?[0-9][0-9_]*(?:\.[0-9_]*)?(?:[eE][-+]?[0-9]+)?(?:/[0-9][0-9_]*(?:\.[0-9_]*)?)?\s*";
/// Units with more than one symbol are left to the reader.
const COMPOUND: &str = r"[^\s0-9]*[\s0-9/^*·⋅.²³⁻-].+|.+[²³]|/.+";

/// A number with a unit of the dimension: of single symbols those that measure it.
fn pattern(dimension: Dimension) -> String {
    let fits = |unit: &&str| units::parse(&format!("1 {unit}"), dimension).is_ok();
    let single = |unit: &&str| unit.chars().all(|c| c.is_alphabetic() || c == '°');
    let symbols: Vec<&str> = units::symbols().filter(single).filter(fits).collect();
    let separator = if symbols.is_empty() { "" } else { "|" };
    format!("^{NUMBER}(?:{}{separator}{COMPOUND})\\s*$", symbols.join("|"))
}

fn pair_of(items: [Value; 2]) -> Value {
    json!({ "type": "array", "prefixItems": items, "minItems": 2, "maxItems": 2 })
}

impl Definitions {
    /// A number with a unit, or a plain one.
    fn measure(&mut self, m: Measure) -> Value {
        let Some(dimension) = m else { return json!({ "type": "number" }) };
        let (what, example) = dimension.describe();
        let name = what.split(' ').skip(1).collect::<Vec<_>>().join("_");
        self.0.entry(name.clone()).or_insert_with(|| {
            json!({
                "type": "string",
                "description": format!("{what} with its unit"),
                "pattern": pattern(dimension),
                "examples": [example],
            })
        });
        reference(&name)
    }

    fn points(&mut self, of: [Measure; 2]) -> Value {
        let items = of.map(|m| self.measure(m));
        json!({ "type": "array", "items": pair_of(items), "minItems": 1 })
    }

    fn signal(&mut self, s: &SignalKind) -> Value {
        let name = match s.of {
            Some(Dimension::TORQUE) => "torque_signal",
            Some(Dimension::ANGULAR_SPEED) => "speed_signal",
            _ => "number_signal",
        };
        if !self.0.contains_key(name) {
            // It may lead back to itself.
            self.0.insert(name.into(), Value::Null);
            let constant = self.measure(s.of);
            let tables = self.by_type(s.types, true);
            self.0.insert(name.into(), json!({ "if": { "type": "object" }, "then": tables, "else": constant }));
        }
        reference(name)
    }

    /// One table of several, by its `type`: what is said of a wrong key is said of the type that stands there.
    fn by_type(&mut self, types: &[TypedTable], required: bool) -> Value {
        let names: Vec<&str> = types.iter().map(|t| t.0).collect();
        let mut chosen = json!({});
        for (k, (name, table)) in types.iter().enumerate().rev() {
            let is = match k == 0 && !required {
                // The first is meant where no type is given.
                true => json!({ "properties": { "type": { "const": name } } }),
                false => json!({ "properties": { "type": { "const": name } }, "required": ["type"] }),
            };
            let mut then = self.table(table);
            then["properties"]["type"] = json!({ "const": name, "description": "Which of them it is." });
            chosen = json!({ "if": is, "then": then, "else": chosen });
        }
        let mut all = json!({
            "type": "object",
            "properties": { "type": { "enum": names } },
        });
        if required {
            all["required"] = json!(["type"]);
        }
        let parts = chosen.as_object().expect("an object").clone();
        all.as_object_mut().expect("an object").extend(parts);
        all
    }

    fn table(&mut self, t: &Table) -> Value {
        let properties: Map<String, Value> = t.keys().map(|k| (k.name.to_owned(), self.key(k))).collect();
        let required: Vec<_> = t.keys().filter(|k| k.required).map(|k| k.name).collect();
        json!({
            "description": about(t.doc),
            "type": "object",
            "properties": properties,
            "required": required,
            "additionalProperties": false,
        })
    }

    fn key(&mut self, k: &Key) -> Value {
        let mut schema = self.kind(&k.kind);
        schema.as_object_mut().expect("every kind is an object").insert("description".into(), about(k.doc).into());
        schema
    }

    fn kind(&mut self, k: &Kind) -> Value {
        let decimal = json!({ "type": "number", "exclusiveMinimum": 0, "maximum": 1 });
        let fraction =
            json!({ "type": "string", "pattern": "^\\s*[0-9_.]+\\s*/\\s*[0-9_.]+\\s*$", "examples": ["96/97"] });
        let number = json!({ "anyOf": [decimal, fraction] });
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
            Kind::Terminals => {
                let name = json!({ "type": "string", "minLength": 1, "maxLength": 64 });
                json!({ "type": "array", "items": { "anyOf": [name.clone(), pair(["name", "member"], &name)] } })
            }
            Kind::MachineEfficiency => {
                let map = json!({
                    "type": "object",
                    "properties": { "map": { "type": "string" } },
                    "required": ["map"],
                    "additionalProperties": false,
                });
                json!({ "anyOf": [number, pair(["motoring", "generating"], &number), map] })
            }
            Kind::Store => {
                let one = json!({ "anyOf": [self.measure(Some(Dimension::POWER)), { "const": FREE }] });
                json!({ "anyOf": [one, { "type": "object", "additionalProperties": one }] })
            }
            Kind::Integer => json!({ "type": "integer", "minimum": 1, "maximum": 100_000 }),
            Kind::Flag => json!({ "type": "boolean" }),
            Kind::Choice(choices) => json!({ "enum": choices }),
            Kind::Efficiency => efficiency,
            Kind::SetEfficiency => {
                json!({ "anyOf": [efficiency.clone(), pair(["external", "internal"], &efficiency)] })
            }
            Kind::Samples => json!({ "type": "integer", "minimum": 2, "maximum": 10_000_000 }),
            Kind::Number => self.measure(None),
            Kind::Quantity(dimension) => self.measure(Some(*dimension)),
            Kind::Quantities(dimension) => {
                json!({ "type": "object", "additionalProperties": self.measure(Some(*dimension)) })
            }
            Kind::Points(of) => self.points(*of),
            Kind::NumberOrPoints(over) => json!({ "anyOf": [self.measure(None), self.points([Some(*over), None])] }),
            Kind::Schedule => {
                let entry = pair_of([self.measure(Some(Dimension::TIME)), json!({ "type": "string" })]);
                json!({ "type": "array", "items": entry, "minItems": 1 })
            }
            Kind::Signal(s) => self.signal(s()),
            Kind::Product(of) => pair_of([self.signal(of[0]()), self.signal(of[1]())]),
            Kind::Table(t) => self.table(t),
            Kind::Tables(t, 0) => json!({ "type": "array", "items": self.table(t) }),
            Kind::Tables(t, n) => json!({ "type": "array", "items": self.table(t), "minItems": n, "maxItems": n }),
            Kind::Variants(variants) => json!({ "type": "array", "items": self.by_type(variants, false) }),
        }
    }
}
