//! REXS as JSON (`.rexsj`).

use serde_json::Value as Json;

use crate::document::{Attribute, Budget, Component, Document, LoadCase, Relation, Value};

/// Reads the text of a file.
///
/// # Errors
/// Why it is no REXS file at all.
pub fn read(text: &str) -> Result<Document, String> {
    // The reader bounds how deep values are nested.
    let whole: Json = serde_json::from_str(text).map_err(|e| format!("it is no JSON: {e}"))?;
    let Some(model) = whole.get("model").filter(|m| m.is_object()) else {
        return Err("it has no object `model`".into());
    };
    let mut budget = Budget::default();
    let of = |name: &str| model.get(name).and_then(Json::as_str).unwrap_or_default().to_owned();
    let mut document = Document {
        version: of("version"),
        application: format!("{} {}", of("applicationId"), of("applicationVersion")).trim().to_owned(),
        date: of("date"),
        ..Document::default()
    };
    for (k, relation) in list(model, "relations").enumerate() {
        budget.entry()?;
        let mut read =
            Relation { id: number(relation, "id").unwrap_or_default(), kind: word(relation, "type"), refs: vec![] };
        for part in list(relation, "refs") {
            match number(part, "id") {
                Some(id) => read.refs.push((word(part, "role"), id)),
                None => {
                    let place = format!("model.relations[{k}]");
                    document.odd(place, "a reference has no number of a component (`id`)");
                }
            }
        }
        document.relations.push(read);
    }
    for (k, part) in list(model, "components").enumerate() {
        budget.entry()?;
        let place = || format!("model.components[{k}]");
        let component = component(part, &place, &mut budget, &mut document)?;
        document.components.extend(component);
    }
    // One spectrum, or a list of them.
    let spectra = match model.get("load_spectrum") {
        Some(Json::Array(all)) => all.iter().collect(),
        Some(one) => vec![one],
        None => vec![],
    };
    for (k, part) in spectra.into_iter().flat_map(|s| list(s, "load_cases")).enumerate() {
        budget.entry()?;
        let mut case = LoadCase { id: number(part, "id").unwrap_or_default(), components: vec![] };
        for (n, part) in list(part, "components").enumerate() {
            budget.entry()?;
            let place = || format!("load_cases[{k}].components[{n}]");
            case.components.extend(component(part, &place, &mut budget, &mut document)?);
        }
        document.cases.push(case);
    }
    Ok(document)
}

fn list<'j>(of: &'j Json, name: &str) -> impl Iterator<Item = &'j Json> {
    of.get(name).and_then(Json::as_array).into_iter().flatten()
}

fn word(of: &Json, name: &str) -> String {
    of.get(name).and_then(Json::as_str).unwrap_or_default().to_owned()
}

/// A whole number, also where it is written as `17.0` or `"17"`.
fn number(of: &Json, name: &str) -> Option<i64> {
    let value = of.get(name)?;
    let whole = |x: f64| (x.fract() == 0.0 && x.abs() < 9e15).then_some(x as i64);
    value.as_i64().or_else(|| whole(value.as_f64()?)).or_else(|| value.as_str()?.trim().parse().ok())
}

fn component(
    part: &Json,
    place: &dyn Fn() -> String,
    budget: &mut Budget,
    document: &mut Document,
) -> Result<Option<Component>, String> {
    let Some(id) = number(part, "id") else {
        document.odd(place(), "a component has no number (`id`) and is left out");
        return Ok(None);
    };
    let mut component = Component { id, kind: word(part, "type"), name: word(part, "name"), attributes: vec![] };
    for attribute in list(part, "attributes") {
        budget.attribute()?;
        let (id, unit) = (word(attribute, "id"), word(attribute, "unit"));
        let held = attribute.as_object().into_iter().flatten().find(|(key, _)| !["id", "unit"].contains(&key.as_str()));
        let value = held.map_or(Value::Text(String::new()), |(_, value)| self::value(value));
        component.attributes.push(Attribute { id, unit, value });
    }
    Ok(Some(component))
}

fn value(of: &Json) -> Value {
    match of {
        Json::Bool(x) => Value::Flag(*x),
        Json::Number(x) => Value::Number(x.as_f64().unwrap_or(f64::NAN)),
        Json::String(x) => Value::of_text(x),
        Json::Array(all) => {
            let numbers: Option<Vec<f64>> = all.iter().map(Json::as_f64).collect();
            let flags = || all.iter().map(Json::as_bool).collect::<Option<Vec<bool>>>();
            let or_flags = || flags().map_or(Value::Other("a list or a matrix"), Value::Flags);
            numbers.map_or_else(or_flags, Value::Numbers)
        }
        Json::Null => Value::Text(String::new()),
        Json::Object(_) => Value::Other("a coded array"),
    }
}
