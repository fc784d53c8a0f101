//! A frame of the studio says what the command line says, however it was made.

use serde_json::{Value, json};
use willis_web::Session;

/// Every example that names no tables, with its text.
fn examples() -> Vec<(String, String)> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples");
    let files = std::fs::read_dir(folder).expect("the folder of examples").flatten().map(|e| e.path());
    let trains = files.filter(|p| p.extension().is_some_and(|e| e == "toml"));
    let read = |p: std::path::PathBuf| {
        let text = std::fs::read_to_string(&p).ok()?;
        let name = p.file_name()?.to_string_lossy().into_owned();
        Some((name, text)).filter(|(_, text)| text.lines().any(|l| l.starts_with("members")))
    };
    trains.filter_map(read).collect()
}

fn sessions() -> Vec<(String, Session)> {
    let all = examples().into_iter();
    let sessions: Vec<_> =
        all.filter_map(|(name, text)| Some((name.clone(), Session::new(&name, &text, "{}").ok()?))).collect();
    assert!(sessions.len() > 25, "{}", sessions.len());
    sessions
}

/// What an operation says beyond the fields of a point.
fn more(operation: &Value) -> Value {
    const KNOWN: [&str; 6] = ["name", "state", "speeds", "torques", "powers", "fixed"];
    let all = operation.as_object().expect("a table").iter();
    all.filter(|(key, value)| !KNOWN.contains(&key.as_str()) && !value.is_null())
        .map(|(k, v)| (k.clone(), v.clone()))
        .collect()
}

/// An answer without the places of its remarks: a drag has no text.
fn without_places(answer: &str) -> Value {
    let mut answer: Value = serde_json::from_str(answer).expect("JSON");
    for one in answer["diagnostics"].as_array_mut().into_iter().flatten() {
        let one = one.as_object_mut().expect("a table");
        ["place", "span", "file"].iter().for_each(|key| drop(one.remove(*key)));
    }
    answer
}

/// The operations of a file as points of the page.
fn points(session: &Session) -> Vec<Value> {
    let facts: Value = serde_json::from_str(&session.facts()).expect("JSON");
    let point = |o: &Value| {
        let given = |key: &str| o.get(key).filter(|t| t.is_object()).cloned().unwrap_or(json!({}));
        json!({
            "state": o.get("state").cloned().unwrap_or(Value::Null),
            "speeds": given("speeds"), "torques": given("torques"), "powers": given("powers"),
            "fixed": o.get("fixed").cloned().unwrap_or(json!([])),
            "more": more(o),
        })
    };
    facts["operations"].as_array().expect("a list").iter().map(point).collect()
}

#[test]
fn a_drag_gives_the_answer_of_the_text() {
    let mut compared = 0;
    for (name, mut session) in sessions() {
        for point in points(&session) {
            let at = point.to_string();
            let rests = session.show(&at, r#"{"width":600}"#).expect("a frame").analysis;
            let moves = session.show(&at, r#"{"width":600,"scale":[0,300,100]}"#).expect("a frame").analysis;
            assert!(without_places(&rests) == without_places(&moves), "{name}: {at}");
            compared += usize::from(rests.contains("willis-analysis-1"));
        }
    }
    assert!(compared > 30, "{compared}");
}

/// An answer without what gears cost at the load of the file and what other laws make of an efficiency: a frame shows one
/// point by the laws in force and does not ask for that.
fn without_loads(answer: &str) -> Value {
    let mut answer: Value = serde_json::from_str(answer).expect("JSON");
    for (_, row) in answer["ratios"].as_object_mut().into_iter().flatten() {
        row.as_object_mut().expect("a row").shift_remove("at_load");
    }
    for operation in answer["operations"].as_array_mut().into_iter().flatten() {
        operation.as_object_mut().expect("an operation").shift_remove("band");
    }
    answer
}

#[test]
fn a_point_is_an_operation_of_the_text() {
    for (name, mut session) in sessions() {
        for point in points(&session) {
            let at = point.to_string();
            let shown = session.show(&at, r#"{"width":600}"#).expect("a frame");
            let Some(operation) = shown.operation else { continue };
            let text = session.text(&at).expect("a text");
            let mut other = Session::new(&name, &text, "{}").unwrap_or_else(|w| panic!("{name}: {w}\n{text}"));
            let asked = other.ask("analyze", &json!({ "operation": operation }).to_string(), "{}");
            assert!(without_loads(&asked.unwrap_or_else(|w| w)) == without_loads(&shown.analysis), "{name}: {at}");
        }
    }
}

#[test]
fn every_state_and_every_pair_of_closed_elements_is_shown() {
    for (name, mut session) in sessions() {
        let facts: Value = serde_json::from_str(&session.facts()).expect("JSON");
        let boxes = r#"{"width":600,"stick":240,"lever":240,"power":[500,240]}"#;
        for state in facts["states"].as_array().expect("a list") {
            let at = json!({ "state": state["name"] }).to_string();
            let shown = session.show(&at, boxes).expect("a frame");
            assert!(
                shown.stick.is_empty() || shown.stick.starts_with("<svg") || shown.stick.contains("willis-refusal-1"),
                "{name}"
            );
            assert!(shown.analysis.contains("willis-analysis-1"), "{name}: {}", shown.analysis);
        }
        let elements: Vec<&Value> = facts["elements"].as_array().expect("a list").iter().map(|e| &e["name"]).collect();
        for (k, one) in elements.iter().enumerate() {
            for other in &elements[k + 1..] {
                let at = json!({ "engaged": [one, other] }).to_string();
                let shown = session.show(&at, boxes).expect("a frame");
                assert!(shown.analysis.contains("willis-"), "{name}");
            }
        }
    }
}

/// Speeds of those that settle the others, torques of those that do not balance: the library takes them whatever is closed.
#[test]
fn whatever_is_closed_the_session_says_what_to_give() {
    let (mut unique, mut replaced) = (0, 0);
    for (name, mut session) in sessions() {
        let facts: Value = serde_json::from_str(&session.facts()).expect("JSON");
        let elements: Vec<&str> =
            facts["elements"].as_array().expect("a list").iter().filter_map(|e| e["name"].as_str()).collect();
        for bits in 0..1_u32 << elements.len() {
            let closed: Vec<String> =
                (0..elements.len()).filter(|k| bits >> k & 1 == 1).map(|k| elements[k].to_owned()).collect();
            let told: Value =
                serde_json::from_str(&session.closed(closed.clone(), vec![]).expect("elements of it")).expect("JSON");
            let list = |key: &str| told[key].as_array().expect("a list").clone();
            let engaged = if told["state"].is_null() { json!(closed) } else { Value::Null };
            // Speeds that no gear would give: what depends on others would contradict them.
            let of = |all: Vec<Value>, unit: &str, first: f64, step: f64| -> serde_json::Map<_, _> {
                let value = |(k, m): (usize, &Value)| {
                    (m.as_str().expect("a name").to_owned(), json!(format!("{} {unit}", first + step * k as f64)))
                };
                all.iter().enumerate().map(value).collect()
            };
            let (speeds, torques) = (list("speeds"), list("torques"));
            let point = json!({
                "state": told["state"], "engaged": engaged,
                "speeds": of(speeds.clone(), "rpm", 1013.7, -377.3), "torques": of(torques, "N m", 100.0, -40.0),
            });
            let shown = session.show(&point.to_string(), r#"{"width":600}"#).expect("a frame");
            let answer: Value = serde_json::from_str(&shown.analysis).expect("JSON");
            assert!(answer["format"] == "willis-analysis-1", "{name} {closed:?}: {point}\n{answer}");
            let Some(found) = answer["operations"].get(0) else {
                assert!(speeds.is_empty(), "{name} {closed:?}");
                continue;
            };
            assert_eq!(found["degrees_of_freedom"], speeds.len(), "{name} {closed:?}");
            unique += usize::from(found["verdict"] == "unique");
            // Others settle the same, if only theirs are known; as many as there are, else with one that is not.
            let Some(first) = speeds.first() else { continue };
            let known = facts["members"].as_array().expect("a list").iter().filter(|m| *m != first);
            let known: Vec<String> = known.filter_map(|m| m.as_str().map(str::to_owned)).collect();
            let others: Value = serde_json::from_str(&session.closed(closed, known).expect("elements")).expect("JSON");
            let others = others["speeds"].as_array().expect("a list");
            assert_eq!(others.len(), speeds.len(), "{name}");
            replaced += usize::from(!others.contains(first));
        }
    }
    assert!(unique > 100 && replaced > 100, "{unique} {replaced}");
}

#[test]
fn an_answer_that_is_not_there_is_the_last_one_in_every_panel() {
    let boxes =
        |answer: usize| json!({ "width": 600, "lever": 240, "power": [500, 240], "answer": answer }).to_string();
    let (mut several, mut others) = (0, 0);
    for (name, text) in examples() {
        for index in 0..Session::new(&name, &text, "{}").map_or(0, |s| points(&s).len()) {
            let show = |answer: usize| {
                let mut session = Session::new(&name, &text, "{}").expect("a train");
                let point = points(&session).swap_remove(index).to_string();
                session.show(&point, &boxes(answer)).expect("a frame")
            };
            let first = show(0);
            let answer: Value = serde_json::from_str(&first.analysis).expect("JSON");
            let count = answer["operations"][0]["solutions"].as_array().map_or(0, Vec::len);
            let (last, stale) = (show(count.saturating_sub(1)), show(count.max(1) + 4));
            assert!((&last.lever, &last.power) == (&stale.lever, &stale.power), "{name} {index}");
            several += usize::from(count > 1);
            others += usize::from(count > 1 && last.lever != first.lever && last.power != first.power);
        }
    }
    assert!(several > 0 && others == several, "{several} {others}");
}

#[test]
fn wrong_requests_are_refused_in_words() {
    let (name, text) = examples().swap_remove(0);
    let mut session = Session::new(&name, &text, "{}").expect("a train");
    for (point, boxes) in [("{", "{}"), (r#"{"gear": 3}"#, "{}"), ("{}", r#"{"width": "wide"}"#)] {
        let Err(refusal) = session.show(point, boxes) else { panic!("{point} {boxes}") };
        assert!(refusal.contains("willis-refusal-1"), "{refusal}");
    }
    for (speed, at) in [("fast", "no number"), ("12 kg", "no speed"), ("1e999 rpm", "too large")] {
        let point = json!({ "speeds": { "input": speed } }).to_string();
        let shown = session.show(&point, r#"{"width":600}"#).expect("a frame");
        assert!(shown.analysis.contains("willis-refusal-1"), "{at}: {}", shown.analysis);
    }
    assert!(session.closed(vec!["no such".into()], vec![]).is_err_and(|w| w.contains("willis-refusal-1")));
    assert!(session.ask("no such question", "{}", "{}").is_err_and(|w| w.contains("willis-refusal-1")));
    assert!(Session::new("x", "members = [", "{}").is_err_and(|w| w.contains("willis-refusal-1")));
}

#[test]
fn edits_keep_comments_and_give_trains() {
    let (name, text) = examples().into_iter().find(|(name, _)| name == "zf-8hp70.toml").expect("the example");
    let session = Session::new(&name, &text, "{}").expect("a train");
    let comments = |text: &str| text.lines().filter(|l| l.trim_start().starts_with('#')).count();
    let all = [
        session.rename("c3", "third carrier"),
        session.join("input", "c3"),
        session.add_set("P9", 30, 70),
        session.add_element("X", vec!["c3".into()]),
        session.add_element("Y", vec!["c3".into(), "s12".into()]),
        session.add_state("9", vec!["A".into(), "C".into(), "E".into()]),
        session.remove("state", "8"),
        session.set("P1.sun.teeth", "50"),
    ];
    for (k, edited) in all.into_iter().enumerate() {
        let edited = edited.unwrap_or_else(|w| panic!("{k}: {w}"));
        assert_ne!(edited, text, "{k}");
        // Those that stand above an entry go with it.
        assert!(comments(&edited) + 2 >= comments(&text), "{k}");
        assert!(Session::new(&name, &edited, "{}").is_ok(), "{k}: {edited}");
    }
    for refused in [
        session.rename("no such", "x"),
        session.rename("c3", "input"),
        session.join("input", "input"),
        session.add_element("A", vec!["c3".into()]),
        session.add_element("Z", vec![]),
        session.add_set("P1", 30, 70),
        session.remove("state", "99"),
        session.set("P1.sun.teeth", "many"),
    ] {
        assert!(refused.is_err_and(|w| w.contains("willis-refusal-1")));
    }
}

/// What an answer says of members by other names.
fn renamed(answer: &str, from: &str, to: &str) -> Value {
    fn walk(value: &mut Value, from: &str, to: &str) {
        match value {
            Value::String(s) if s == from => *s = to.to_owned(),
            Value::Array(all) => all.iter_mut().for_each(|v| walk(v, from, to)),
            Value::Object(all) => {
                // Sentences have names within; the data beside them are compared.
                let own =
                    std::mem::take(all).into_iter().filter(|(key, _)| !["reason", "no_ratio"].contains(&key.as_str()));
                for (key, mut value) in own {
                    walk(&mut value, from, to);
                    all.insert(if key == from { to.to_owned() } else { key }, value);
                }
            }
            _ => {}
        }
    }
    let mut answer: Value = serde_json::from_str(answer).expect("JSON");
    walk(&mut answer, from, to);
    answer
}

#[test]
fn a_member_may_have_another_name_in_every_example() {
    let mut compared = 0;
    for (name, mut session) in sessions() {
        let facts: Value = serde_json::from_str(&session.facts()).expect("JSON");
        let ask = |s: &mut Session| {
            let answer = s.ask("analyze", "{}", "{}").unwrap_or_else(|w| panic!("{name}: {w}"));
            without_loads(&answer).to_string()
        };
        let before = ask(&mut session);
        let listed = facts["members"].as_array().expect("a list").iter().filter_map(Value::as_str);
        for member in listed.filter(|m| !m.contains('.')) {
            let text = session.rename(member, "renamed").unwrap_or_else(|w| panic!("{name}, {member}: {w}"));
            let mut other = Session::new(&name, &text, "{}").unwrap_or_else(|w| panic!("{name}, {member}: {w}"));
            let after = ask(&mut other);
            let (before, after) = (renamed(&before, member, "renamed"), renamed(&after, member, "renamed"));
            for key in ["ratios", "degrees_of_freedom"] {
                assert!(before[key] == after[key], "{name}, {member}: {key}");
            }
            let all = before["operations"].as_array().into_iter().flatten();
            for (one, other) in all.zip(after["operations"].as_array().expect("as many")) {
                assert!(one["verdict"] == other["verdict"], "{name}, {member}");
                // Meshes without a name have one made of their members.
                let numbers = |o: &Value| {
                    let all = o["solutions"].as_array().expect("a list").iter();
                    all.map(|s| json!([s["efficiency"], s["loss_w"], s["members"]])).collect::<Vec<_>>()
                };
                assert_eq!(numbers(one), numbers(other), "{name}, {member}");
            }
            compared += 1;
        }
    }
    assert!(compared > 150, "{compared}");
}
