//! Variants side by side: what the files differ in, and what that changes.

use willis::model::Model;
use willis::study::{CompareRequest, Compared, ComparedUnit, ComparedValue, Comparison, compare};
use willis::work::Serial;

use crate::common::example;

const REDUCER: &str = r#"
    format = 1
    name = "reducer"
    members = ["s", "c"]
    terminals = ["s", "c"]
    [[set]]
    name = "P1"
    sun = { member = "s", teeth = 30 }
    planet = { teeth = 20, count = 4 }
    ring = { member = "frame", teeth = 70 }
    carrier = "c"
    mesh_efficiency = 0.99
    [[operation]]
    name = "load"
    speeds = { s = "1000 rpm" }
    torques = { s = "10 N m" }
"#;

const MORE: &str = r#"
    [[operation]]
    name = "coast"
    speeds = { s = "1000 rpm" }
    torques = { s = "-10 N m" }
"#;

fn all(texts: &[&str], request: &CompareRequest) -> Comparison {
    let subjects: Vec<Model> = texts.iter().map(|t| Model::from_toml(t).unwrap()).collect();
    let names = ["first.toml", "second.toml", "third.toml"];
    let variants: Vec<(&str, &Model)> = names.into_iter().zip(&subjects).collect();
    compare(&variants, request, &Serial).unwrap_or_else(|e| panic!("{e}"))
}

fn quantity<'a>(c: &'a Compared, name: &str) -> &'a willis::study::Difference {
    c.differences.iter().find(|d| d.quantity == name).unwrap_or_else(|| panic!("{name} does not differ: {c:?}"))
}

#[test]
fn another_efficiency_changes_what_it_should() {
    let c = all(&[REDUCER, &REDUCER.replace("0.99", "0.98")], &CompareRequest::default());
    assert!(!c.identical);
    assert_eq!(c.files.len(), 1);
    assert_eq!(c.files[0].path, "P1.mesh_efficiency");
    assert_eq!(c.files[0].values, [Some("0.99".into()), Some("0.98".into())]);
    // (1 − i0 η0)/(1 − i0) with i0 = −7/3
    let eta = |mesh: f64| (1.0 + 7.0 / 3.0 * mesh * mesh) / (1.0 + 7.0 / 3.0);
    let state = &c.states[0];
    assert_eq!(state.name, "as drawn");
    assert!(!state.differences.iter().any(|d| d.quantity == "ratio"), "the ratio is the same");
    let driving = quantity(state, "efficiency driving");
    assert!((driving.differences[1].unwrap() - (eta(0.98) - eta(0.99))).abs() < 1e-14);
    let load = &c.operations[0];
    assert!(load.prescribed.is_empty() && load.missing_in.is_empty());
    let power = 10.0 * 1000.0 * std::f64::consts::PI / 30.0;
    let loss = quantity(load, "loss");
    assert!((loss.differences[1].unwrap() - power * (eta(0.99) - eta(0.98))).abs() < 1e-9);
    assert!((loss.relative[1].unwrap() - (eta(0.99) - eta(0.98)) / (1.0 - eta(0.99))).abs() < 1e-9);
    // Speeds and the input are what they were; the loss is twice as large, the output a little smaller.
    assert!(load.equal > 0 && !load.differences.iter().any(|d| d.unit == ComparedUnit::RadianPerSecond));
    // What is asked first stands first, then the largest.
    let headline = load.differences.iter().take_while(|d| matches!(d.quantity.as_str(), "efficiency" | "loss")).count();
    assert!(headline > 0 && load.differences[headline..].windows(2).all(|w| w[0].size >= w[1].size));
}

#[test]
fn the_number_of_planets_changes_the_file_and_no_result() {
    let c = all(&[REDUCER, &REDUCER.replace("count = 4", "count = 5")], &CompareRequest::default());
    assert_eq!(c.files.iter().map(|d| d.path.as_str()).collect::<Vec<_>>(), ["P1.planet.count"]);
    assert!(c.states.iter().chain(&c.operations).all(Compared::is_equal), "{c:?}");
}

#[test]
fn files_that_say_the_same_are_equal_whatever_their_comments_and_order() {
    let other = format!("# a comment\n{}", REDUCER.replace("0.99", "0.990"));
    let c = all(&[REDUCER, &other, REDUCER], &CompareRequest::default());
    assert!(c.identical && c.files.is_empty());
    assert!(c.states.iter().chain(&c.operations).all(Compared::is_equal));
}

#[test]
fn what_only_some_files_have_is_named() {
    let c = all(&[&format!("{REDUCER}{MORE}"), REDUCER], &CompareRequest::default());
    let coast = c.operations.iter().find(|o| o.name == "coast").unwrap();
    assert_eq!(coast.missing_in, ["B"]);
    assert!(!coast.is_equal());
    let key = c.files.iter().find(|d| d.path == "operation.coast").unwrap();
    assert!(key.values[0].as_ref().unwrap().contains("-10 N m") && key.values[1].is_none());
    // A table that only one has.
    let oil = format!("{REDUCER}\n[oil]\nname = \"ISO VG 220\"\ntemperature = \"70 degC\"\n");
    let c = all(&[REDUCER, &oil], &CompareRequest::default());
    assert_eq!((c.files[0].path.as_str(), c.files[0].values[0].as_deref()), ("oil", None));
}

#[test]
fn operations_of_one_name_that_prescribe_different_things_are_marked() {
    let c = all(&[REDUCER, &REDUCER.replace("10 N m", "20 N m").replace("1000 rpm", "900 rpm")], &Default::default());
    let load = &c.operations[0];
    assert_eq!(load.prescribed.len(), 2);
    assert_eq!(load.prescribed[0].path, "speed of s");
    assert_eq!(load.prescribed[1].values, [Some("torque 10 N m".into()), Some("torque 20 N m".into())]);
}

#[test]
fn a_changed_verdict_comes_first_with_its_reason() {
    let wolfrom = |efficiency: &str| {
        example("wolfrom-498-self-locking").replace("{ external = 0.98, internal = 0.99 }", efficiency)
    };
    let c = all(&[&wolfrom("{ external = 0.98, internal = 0.99 }"), &wolfrom("0.9999")], &Default::default());
    let state = &c.states[0];
    assert_eq!(state.differences[0].size, 2.0);
    let verdict = quantity(state, "verdict coasting");
    assert_eq!(verdict.values, [ComparedValue::Word("locked".into()), ComparedValue::Word("unique".into())]);
    assert!(state.reasons.iter().any(|r| r.0 == "A"), "{state:?}");
}

#[test]
fn over_axes_it_tells_where_which_is_better() {
    // One loses more when driving, the other when coasting: the efficiencies of the meshes depend on who drives.
    let two = |forward: &str, backward: &str| {
        let efficiency = format!("mesh_efficiency = {{ forward = {forward}, backward = {backward} }}");
        REDUCER.replace("mesh_efficiency = 0.99", &efficiency)
    };
    let request = CompareRequest {
        over: vec!["input.speed=500 rpm..1500 rpm:3".into(), "input.torque=-20 N m..20 N m:6".into()],
        ..Default::default()
    };
    let c = all(&[&two("0.99", "0.98"), &two("0.98", "0.99")], &request);
    let map = c.map.unwrap();
    assert_eq!((map.points, map.operations.as_slice()), (18, &["load".to_owned(), "load".to_owned()][..]));
    let pair = &map.pairs[0];
    assert_eq!((pair.compared, pair.efficiency.better, pair.efficiency.worse), (18, 9, 9));
    let driving: Vec<_> = pair.bands.iter().filter(|b| b.axis == "input.torque").collect();
    assert_eq!(driving.len(), 5);
    assert!(driving[0].better > 0 && driving[0].worse == 0, "{driving:?}");
    assert!(driving[4].better == 0 && driving[4].worse > 0, "{driving:?}");
    let worst = pair.loss_w.most_worse.as_ref().unwrap();
    assert_eq!(worst.place, "input.speed = 1500 rpm, input.torque = 20 N m");
    assert!(worst.difference > 0.0);
}

#[test]
fn wrong_questions_are_refused() {
    let subject = Model::from_toml(REDUCER).unwrap();
    let two = [("a.toml", &subject), ("b.toml", &subject)];
    let told = |request: CompareRequest| compare(&two, &request, &Serial).unwrap_err().to_string();
    let operation = told(CompareRequest { operation: Some("lod".into()), ..Default::default() });
    assert!(operation.contains("no variant has the operation `lod`; did you mean `load`?"), "{operation}");
    let axis = told(CompareRequest { over: vec!["input.sped=1 rpm..2 rpm:3".into()], ..Default::default() });
    assert!(axis.contains("a.toml: there is no quantity `input.sped`"), "{axis}");
    let many = told(CompareRequest {
        over: vec!["input.speed=1 rpm..2 rpm:1001".into(), "input.torque=1 N m..2 N m:1001".into()],
        ..Default::default()
    });
    assert!(many.contains("1002001 points are too many to compare"), "{many}");
    assert!(compare(&two[..1], &Default::default(), &Serial).is_err());
}
