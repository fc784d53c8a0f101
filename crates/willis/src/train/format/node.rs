//! Checked values of a train file on their way in, and values on their way out.

use std::collections::BTreeMap;

use serde::de::{MapAccess, SeqAccess, Visitor};
use serde::ser::{SerializeMap, SerializeSeq};

use crate::exact::Rational;
use crate::units::Quantity;

/// A number with a unit, or a plain one; exact.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Amount {
    Number(Rational),
    Quantity(Quantity),
}

/// An efficiency: of both directions, or one each.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Directed {
    pub forward: Rational,
    pub backward: Option<Rational>,
}

/// A value that the reader found sound.
#[derive(Clone, Debug)]
pub(crate) enum Node {
    /// The format number.
    Format,
    Text(String),
    Integer(i64),
    Flag(bool),
    Names(Vec<String>),
    /// By name, and the member that each sits on where that is another.
    Terminals(Vec<(String, Option<String>)>),
    Efficiency(Directed),
    /// Of all meshes, or of external and of internal ones.
    SetEfficiency(Directed, Option<Directed>),
    Quantities(Vec<(String, Quantity)>),
    /// Of each variator, by name: a power, or none for whatever balances it.
    Stores(Vec<(String, Option<Quantity>)>),
    Amount(Amount),
    Points(Vec<[Amount; 2]>),
    Schedule(Vec<(Quantity, String)>),
    Table(Fields),
    Tables(Vec<Fields>),
}

/// The checked keys of a table. What was absent or wrong is not there; it was reported.
#[derive(Clone, Debug, Default)]
pub(crate) struct Fields(pub(crate) BTreeMap<&'static str, Node>);

/// A value on its way out, in the shape of the train file.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Datum {
    Text(String),
    Integer(i64),
    Number(f64),
    Flag(bool),
    List(Vec<Datum>),
    Table(Vec<(String, Datum)>),
}

impl Datum {
    /// A plain number that reads back exactly; a text where no decimal number does.
    pub fn exact(value: &Rational) -> Self {
        let decimal = value.to_f64();
        match Rational::from_f64(decimal) {
            Some(same) if same == *value => Self::Number(decimal),
            _ => Self::Text(value.to_string()),
        }
    }

    pub fn get(&self, key: &str) -> Option<&Self> {
        match self {
            Self::Table(all) => all.iter().find(|(k, _)| k == key).map(|(_, d)| d),
            _ => None,
        }
    }

    pub fn as_text(&self) -> Option<&str> {
        match self {
            Self::Text(text) => Some(text),
            _ => None,
        }
    }

    /// As TOML on one line.
    pub fn inline(&self) -> String {
        match self {
            Self::Text(text) => quoted(text),
            Self::Integer(i) => i.to_string(),
            Self::Number(x) => number(*x),
            Self::Flag(b) => b.to_string(),
            Self::List(all) => {
                format!("[{}]", all.iter().map(Self::inline).collect::<Vec<_>>().join(", "))
            }
            Self::Table(all) if all.is_empty() => "{}".into(),
            Self::Table(all) => {
                let all: Vec<String> = all.iter().map(|(k, d)| format!("{} = {}", key(k), d.inline())).collect();
                format!("{{ {} }}", all.join(", "))
            }
        }
    }

    fn is_tables(&self) -> bool {
        matches!(self, Self::List(all) if !all.is_empty() && all.iter().all(|d| matches!(d, Self::Table(_))))
    }
}

fn number(x: f64) -> String {
    match x {
        x if x.is_nan() => "nan".into(),
        x if x.is_infinite() => if x > 0.0 { "inf" } else { "-inf" }.into(),
        // What is whole stays whole: 1, not 1.0; both are read alike.
        x if x.fract() == 0.0 && x.abs() < 1e15 => format!("{x:.0}"),
        x => format!("{x:?}"),
    }
}

fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' => out += "\\\"",
            '\\' => out += "\\\\",
            '\n' => out += "\\n",
            '\r' => out += "\\r",
            '\t' => out += "\\t",
            c if c.is_control() => out += &format!("\\u{:04X}", c as u32),
            c => out.push(c),
        }
    }
    out + "\""
}

fn key(name: &str) -> String {
    let bare = !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, '_' | '-'));
    if bare { name.to_owned() } else { quoted(name) }
}

/// Longest line on which a table or a list stays.
const WIDTH: usize = 116;

/// A table as a TOML document: plain values first, then tables under headers.
pub(crate) fn document(keys: &[(String, Datum)]) -> String {
    let mut out = String::new();
    block(keys, "", &mut out);
    out
}

fn block(keys: &[(String, Datum)], path: &str, out: &mut String) {
    // At the top every table has a header of its own; further in only those too long for a line.
    let apart = |name: &str, datum: &Datum| match datum {
        Datum::Table(all) => {
            path.is_empty() && all.iter().all(|(_, d)| !matches!(d, Datum::Table(_)))
                || name.len() + 3 + datum.inline().len() > WIDTH
        }
        datum if datum.is_tables() => path.is_empty() || name.len() + 3 + datum.inline().len() > WIDTH,
        _ => false,
    };
    for (name, datum) in keys.iter().filter(|(name, datum)| !apart(name, datum)) {
        let line = format!("{} = {}", key(name), datum.inline());
        match datum {
            Datum::List(all) if line.chars().count() > WIDTH => {
                *out += &format!("{} = [\n", key(name));
                all.iter().for_each(|d| *out += &format!("    {},\n", d.inline()));
                *out += "]\n";
            }
            _ => *out += &format!("{line}\n"),
        }
    }
    for (name, datum) in keys.iter().filter(|(name, datum)| apart(name, datum)) {
        let path = if path.is_empty() { key(name) } else { format!("{path}.{}", key(name)) };
        match datum {
            Datum::Table(all) => {
                *out += &format!("\n[{path}]\n");
                block(all, &path, out);
            }
            Datum::List(entries) => {
                for entry in entries {
                    let Datum::Table(all) = entry else { continue };
                    *out += &format!("\n[[{path}]]\n");
                    block(all, &path, out);
                }
            }
            _ => {}
        }
    }
}

impl serde::Serialize for Datum {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Text(text) => serializer.serialize_str(text),
            Self::Integer(i) => serializer.serialize_i64(*i),
            Self::Number(x) => serializer.serialize_f64(*x),
            Self::Flag(b) => serializer.serialize_bool(*b),
            Self::List(all) => {
                let mut list = serializer.serialize_seq(Some(all.len()))?;
                all.iter().try_for_each(|d| list.serialize_element(d))?;
                list.end()
            }
            Self::Table(all) => {
                let mut map = serializer.serialize_map(Some(all.len()))?;
                all.iter().try_for_each(|(k, d)| map.serialize_entry(k, d))?;
                map.end()
            }
        }
    }
}

impl<'de> serde::Deserialize<'de> for Datum {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Any;

        impl<'de> Visitor<'de> for Any {
            type Value = Datum;

            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("a value of a train file")
            }

            fn visit_str<E>(self, text: &str) -> Result<Datum, E> {
                Ok(Datum::Text(text.to_owned()))
            }

            fn visit_i64<E>(self, value: i64) -> Result<Datum, E> {
                Ok(Datum::Integer(value))
            }

            fn visit_u64<E>(self, value: u64) -> Result<Datum, E> {
                // What is too large for a count is no count; its reader says so.
                Ok(i64::try_from(value).map_or(Datum::Number(value as f64), Datum::Integer))
            }

            fn visit_f64<E>(self, value: f64) -> Result<Datum, E> {
                Ok(Datum::Number(value))
            }

            fn visit_bool<E>(self, value: bool) -> Result<Datum, E> {
                Ok(Datum::Flag(value))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Datum, A::Error> {
                let mut all = vec![];
                while let Some(d) = seq.next_element()? {
                    all.push(d);
                }
                Ok(Datum::List(all))
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Datum, A::Error> {
                let mut all = vec![];
                while let Some((name, d)) = map.next_entry::<String, Option<Datum>>()? {
                    // `null` is what other languages write for what is not given.
                    all.extend(d.map(|d| (name, d)));
                }
                Ok(Datum::Table(all))
            }
        }

        deserializer.deserialize_any(Any)
    }
}
