//! Gearsets JSON: a small transmission of our own, sound and broken.

use willis::analysis::{Selection, analyze};
use willis::train::ShiftElementKind;
use willis_exchange::gearsets::{is_gearsets, read};
use willis_exchange::rexs::Fate;

/// A Simpson train with the teeth of Willis's own example, written as the format has it.
const SPEC: &str = r#"{
  "name": "Simpson", "input_member": "input", "output_member": "front_carrier", "strict_geometry": false,
  "members": ["input", "front_ring", "sun", "front_carrier", "rear_ring", "rear_carrier", "nobody"],
  "gearsets": [
    { "name": "front", "Ns": 33, "Nr": 72, "sun": "sun", "ring": "front_ring", "carrier": "front_carrier" },
    { "name": "rear", "Ns": 33, "Nr": 72, "sun": "sun", "ring": "rear_ring", "carrier": "rear_carrier" }
  ],
  "clutches": [{ "name": "forward", "a": "input", "b": "front_ring" }, { "name": "high", "a": "input", "b": "sun" }],
  "brakes": [{ "name": "band", "member": "sun" }, { "name": "low", "member": "rear_carrier" }],
  "sprags": [{ "name": "sprag", "member": "rear_carrier", "hold_direction": "negative", "locked_when_engaged": true }],
  "permanent_ties": [["front_carrier", "rear_ring"]],
  "presets": { "other": {} }
}"#;

const SCHEDULE: &str = r#"{
  "states": {
    "Rev": { "active_constraints": ["high", "low"], "notes": "x" },
    "1st": ["forward", "sprag"], "2nd": ["forward", "band"], "3rd": ["forward", "high"],
    "odd": ["forward", "nowhere"]
  },
  "display_order": ["1st", "2nd", "3rd", "Rev"]
}"#;

#[test]
fn ratios_follow_from_the_teeth() {
    assert!(is_gearsets(SPEC.as_bytes()) && !is_gearsets(b"{\"model\": 1}") && !is_gearsets(b"<model/>"));
    let done = read("in/simpson.json", SPEC.as_bytes(), Some(SCHEDULE.as_bytes())).unwrap_or_else(|e| panic!("{e}"));
    let train = done.model.train();
    let sprag = train.shift_elements().iter().find(|e| e.name == "sprag").unwrap();
    assert_eq!((sprag.kind, sprag.blocks), (ShiftElementKind::OneWay, -1));
    let names: Vec<&str> = train.states().iter().map(|s| s.name.as_str()).collect();
    assert_eq!(names, ["1st", "2nd", "3rd", "Rev"]);
    let table = analyze(train, &Selection::default()).unwrap().ratios;
    let ratio = |name: &str| table.get(name).unwrap().exact.clone().unwrap().to_fraction();
    // 1st: 2 + Ns/Nr; 2nd: 1 + Ns/Nr; reverse: -Nr/Ns (Simpson's train).
    assert_eq!(["1st", "2nd", "3rd", "Rev"].map(ratio), ["59/24", "35/24", "1/1", "-24/11"].map(String::from));
    let r = &done.report;
    assert!(r.problems.iter().any(|p| p.message.contains("`nowhere`")), "{:?}", r.problems);
    assert!(r.problems.iter().any(|p| p.place == "member nobody"), "{:?}", r.problems);
    assert!(r.problems.iter().any(|p| p.message.contains("19.5 teeth")), "{:?}", r.problems);
    assert!(r.attributes.iter().any(|a| a.attribute == "presets" && a.fate == Fate::LeftOut));
    assert!(r.missing.iter().any(|m| m.what.contains("efficiencies")));
}

#[test]
fn without_a_schedule_it_has_no_states() {
    let done = read("simpson.json", SPEC.as_bytes(), None).unwrap();
    assert!(done.model.train().states().is_empty());
    assert!(done.report.missing.iter().any(|m| m.what == "the shift schedule"));
}

#[test]
fn broken_files_are_refused_or_read_as_far_as_they_go() {
    let fails = |spec: &str, schedule: Option<&str>, part: &str| {
        let wrong = read("x.json", spec.as_bytes(), schedule.map(str::as_bytes)).unwrap_err().to_string();
        assert!(wrong.contains(part), "{wrong}");
    };
    fails("[]", None, "no JSON object");
    fails("{", None, "no JSON");
    fails(r#"{ "gearsets": [] }"#, None, "input_member");
    fails(r#"{ "input_member": "a", "output_member": "b", "gearsets": [{ "Ns": "x" }] }"#, None, "no gear set");
    fails(SPEC, Some("3"), "no shift schedule");
    // Every value of the file replaced by something else: an answer or words, never a panic.
    let whole: serde_json::Value = serde_json::from_str(SPEC).unwrap();
    for key in whole.as_object().unwrap().keys() {
        for other in ["null", "3", "\"\"", "[]", "{}", "[1, [2], {\"name\": 3}]", "[[\"sun\", \"sun\"]]"] {
            let mut changed = whole.clone();
            changed[key] = serde_json::from_str(other).unwrap();
            let text = changed.to_string();
            if let Err(wrong) = read("x.json", text.as_bytes(), Some(SCHEDULE.as_bytes())) {
                assert!(!wrong.to_string().is_empty());
            }
        }
    }
}
