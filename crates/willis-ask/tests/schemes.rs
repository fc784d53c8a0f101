//! The question about shift schemes and hybrids: counts that must come out, rows as train files, parts of a search that
//! are put together, and what is refused.

#![cfg(feature = "schemes")]

use std::fs;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicIsize, Ordering};

use serde_json::{Value, json};
use willis::exact::Rational;
use willis::work::{Serial, Work};
use willis::{Selection, Train, analyze};
use willis_ask::{Answer, Refusal, Request, question};

fn example(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples").join(name);
    fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

fn request(value: Value) -> Box<dyn Request> {
    question("schemes").unwrap().request(value.clone()).unwrap_or_else(|e| panic!("{value}: {e}"))
}

fn with(value: &Value, more: Value) -> Value {
    let mut all = value.clone();
    all.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
    all
}

/// An answer that is kept, with its JSON.
fn answered(value: Value, work: &dyn Work) -> (Box<dyn Answer + Send + Sync>, Value) {
    let answer = request(value.clone()).ask_for_good(Arc::new([]), work).unwrap_or_else(|e| panic!("{value}: {e}"));
    let json = serde_json::from_str(&answer.json()).unwrap();
    (answer, json)
}

fn refused(value: Value) -> String {
    match request(value.clone()).ask_for_good(Arc::new([]), &Serial) {
        Ok(_) => panic!("{value} was answered"),
        Err(refusal) => refusal.render(&[], false),
    }
}

fn two_sets(elements: usize, forward: usize) -> Value {
    json!({
        "k": ["62/26", "74/42"], "elements": elements, "closed": 2, "forward": forward,
        "forward_range": "1/2..5", "step": "1.15..2.2", "reverse_range": "1.2..5",
    })
}

fn zf() -> Value {
    json!({
        "layout": { "name": "zf-8hp70.toml", "text": example("zf-8hp70.toml") }, "elements": 5, "closed": 3, "forward": 8,
        "forward_range": "1/2..6", "step": "1.1..1.8", "reverse_range": "1.5..6",
    })
}

fn hybrid() -> Value {
    let need = ["input-split", "compound-split", "electric", "fixed"];
    json!({ "hybrid": true, "k": ["1.7", "2.3"], "clutches": 3, "need": need })
}

fn counts(json: &Value) -> [u64; 2] {
    ["schemes", "classes"].map(|count| json["found"][count].as_u64().unwrap())
}

/// Counts from an enumeration of everything by other programs.
#[test]
fn val_counts_are_those_of_other_programs() {
    let (_, three) = answered(two_sets(4, 3), &Serial);
    let (_, four) = answered(two_sets(5, 4), &Serial);
    assert_eq!([counts(&three), counts(&four)], [[653, 361], [350, 146]]);
    let (answer, eight) = answered(zf(), &Serial);
    assert_eq!(counts(&eight), [6, 2]);
    assert_eq!(eight["schemes"][0]["known"], "ZF 8HP70");
    assert!(eight["completeness"]["complete"].as_bool().unwrap() && !answer.is_partial());
    assert!(answer.text().contains("nothing else exists in this space"));
    // The digits of the layout with the same teeth are the same request; so many closed elements are what is left.
    let teeth = ["96/48", "96/48", "111/69", "85/23"];
    let digits = with(&zf(), json!({ "layout": { "name": "345360678751" }, "k": teeth, "closed": null }));
    assert_eq!(answered(digits, &Serial).1, eight);
    let (_, hybrids) = answered(hybrid(), &Serial);
    assert_eq!(["layouts", "kinematic", "designs_found"].map(|n| hybrids[n].as_u64().unwrap()), [900, 2088, 3240]);
    assert_eq!(hybrids["format"], "willis-hybrids-1");
}

/// The mesh efficiencies of a scheme's file are those of the example, so its gears have the example's efficiencies.
#[test]
fn gears_have_the_efficiencies_of_the_example() {
    let train = Train::from_toml(&example("zf-8hp70.toml")).unwrap();
    let analysis = analyze(&train, &Selection::default()).unwrap();
    let (_, json) = answered(zf(), &Serial);
    let scheme = &json["schemes"][0];
    let gears = [&scheme["gears"], &scheme["reverse"]].into_iter().flat_map(|g| g.as_array().unwrap());
    let mut compared = 0;
    for gear in gears {
        let row = analysis.ratios.get(gear["name"].as_str().unwrap()).unwrap();
        assert_eq!(row.exact.as_ref().unwrap().to_fraction(), gear["ratio"].as_str().unwrap());
        let [own, expected] = [gear["efficiency"].as_f64(), row.drive.efficiency].map(Option::unwrap);
        assert!((own - expected).abs() < 1e-12, "{own} {expected}");
        compared += 1;
    }
    assert_eq!(compared, 9);
    let assumed = json["assumptions"].to_string();
    assert!(assumed.contains("0.98 of sun and planet and 0.99 of planet and ring"), "{assumed}");
}

/// A wish for efficiency orders and limits, with the mesh efficiencies that it states.
#[test]
fn efficiencies_rank_and_limit() {
    let lowest = |scheme: &Value| {
        let gears = scheme["gears"].as_array().unwrap().iter().chain(scheme["reverse"].as_array().unwrap());
        gears.map(|g| g["efficiency"].as_f64().unwrap()).fold(1.0, f64::min)
    };
    let wish = with(&two_sets(5, 4), json!({ "order": "efficiency", "mesh_efficiency": ["0.97"], "top": 400 }));
    let (_, all) = answered(wish.clone(), &Serial);
    let own: Vec<f64> = all["schemes"].as_array().unwrap().iter().map(lowest).collect();
    assert!(own.len() == 350 && own.windows(2).all(|w| w[0] >= w[1] - 1e-9));
    assert!(all["assumptions"].to_string().contains("0.97 of sun and planet and 0.97 of planet and ring"));
    let (_, some) = answered(with(&wish, json!({ "min_efficiency": "0.85" })), &Serial);
    assert_eq!(counts(&some)[0] as usize, own.iter().filter(|e| **e >= 0.85).count());
    assert!(counts(&some)[0] > 0 && counts(&some)[0] < 350);
    for (wrong, why) in [
        (json!({ "mesh_efficiency": ["1.2"] }), "is not above 0 and at most 1"),
        (json!({ "mesh_efficiency": ["0.9", "0.9", "0.9"] }), "more than two entries"),
        (json!({ "min_efficiency": "high" }), "give a part of 1"),
    ] {
        let said = refused(with(&wish, wrong));
        assert!(said.contains(why), "{said}");
    }
}

#[test]
fn rows_are_train_files_with_the_ratios_shown() {
    let rows: Vec<usize> = (1..=25).collect();
    let mut gears = 0;
    for (value, rows) in [(two_sets(4, 3), rows), (zf(), vec![6, 1, 1])] {
        let (answer, json) = answered(with(&value, json!({ "write": rows })), &Serial);
        let files = answer.write("train").unwrap();
        let mut wanted = rows.clone();
        wanted.sort_unstable();
        wanted.dedup();
        assert_eq!(files.len(), wanted.len());
        for (file, row) in files.iter().zip(wanted) {
            assert_eq!(file.name, format!("scheme-{row}.toml"));
            let train = Train::from_toml(std::str::from_utf8(&file.bytes).unwrap()).unwrap();
            assert!(train.warnings().is_empty(), "{:?}", train.warnings());
            let analysis = analyze(&train, &Selection::default()).unwrap();
            let scheme = &json["schemes"][row - 1];
            for gear in scheme["gears"].as_array().unwrap().iter().chain(scheme["reverse"].as_array().unwrap()) {
                let ratio = analysis.ratios.get(gear["name"].as_str().unwrap()).unwrap().exact.as_ref().unwrap();
                assert_eq!(ratio.to_fraction(), gear["ratio"].as_str().unwrap());
                gears += 1;
            }
            // A row read again as a layout is its own layout.
            let (layout, _) = willis_synthesis::schemes::Layout::of_train(&train).unwrap();
            assert_eq!(scheme["layout"], layout.to_string());
        }
    }
    assert_eq!(gears, 25 * 4 + 2 * 9);
    let missing =
        request(with(&zf(), json!({ "write": [7] }))).ask_for_good(Arc::new([]), &Serial).unwrap().write("train");
    assert!(missing.unwrap_err().to_string().contains("there is no row 7: the answer has 6"));
}

/// From a wish to teeth in two questions: what one writes, the other takes as it is.
#[test]
fn rows_are_design_files_whose_teeth_are_found() {
    // No teeth are given, only basic ratios; an end of each range cuts the tolerance of a gear.
    let wish = json!({
        "k": ["2.38", "1.76"], "elements": 5, "closed": 2, "forward": 4, "forward_range": "0.5..3",
        "step": "1.15..2.2", "reverse_range": "1.2..5", "max_speed": "4", "max_torque": "6", "write": [1, 2],
    });
    let (answer, json) = answered(wish, &Serial);
    let files = answer.write("design-file").unwrap();
    assert_eq!(
        files.iter().map(|f| f.name.as_str()).collect::<Vec<_>>(),
        ["scheme-1-design.toml", "scheme-2-design.toml"]
    );
    for (file, scheme) in files.iter().zip(json["schemes"].as_array().unwrap()) {
        let text = String::from_utf8(file.bytes.clone()).unwrap();
        let design = question("design").unwrap();
        let design = design.request(json!({ "file": { "name": file.name, "text": text } })).unwrap();
        let found = design.ask_for_good(Arc::new([]), &Serial).unwrap_or_else(|e| panic!("{e}\n{text}"));
        let report: Value = serde_json::from_str(&found.json()).unwrap();
        assert!(report["completeness"]["complete"].as_bool().unwrap());
        let row = &report["rows"][0];
        assert!(row["element_torque"].as_f64().unwrap() <= 6.0 && row["member_speed"].as_f64().unwrap() <= 4.0);
        for gear in scheme["gears"].as_array().unwrap().iter().chain(scheme["reverse"].as_array().unwrap()) {
            let state = &row["states"][gear["name"].as_str().unwrap()];
            let [own, teeth] = [&gear["value"], &state["value"]].map(|v| v.as_f64().unwrap());
            assert!((teeth / own - 1.0).abs() <= 0.005 && teeth <= 3.0, "{own} {teeth}");
        }
    }
    let hybrid = request(hybrid()).ask_for_good(Arc::new([]), &Serial).unwrap().write("design-file").unwrap_err();
    assert!(hybrid.to_string().contains("the modes of a hybrid are no gears"), "{hybrid}");
}

#[test]
fn hybrids_are_train_files_with_the_ratios_of_their_fixed_gears() {
    let rows: Vec<usize> = (1..=40).collect();
    let (answer, json) = answered(with(&hybrid(), json!({ "write": rows })), &Serial);
    let (mut fixed, mut points) = (0, 0);
    for (file, design) in answer.write("train").unwrap().iter().zip(json["designs"].as_array().unwrap()) {
        let text = std::str::from_utf8(&file.bytes).unwrap();
        let train = Train::from_toml(text).unwrap_or_else(|e| panic!("{e}\n{text}"));
        assert!(train.warnings().is_empty(), "{:?}\n{text}", train.warnings());
        let analysis = analyze(&train, &Selection::default()).unwrap_or_else(|e| panic!("{e}\n{text}"));
        points += analysis.operations.iter().filter(|o| o.verdict == willis::analysis::Verdict::Unique).count();
        for mode in design["modes"].as_array().unwrap().iter().filter(|m| !m["ratio"].is_null()) {
            let closed: Vec<&str> = mode["closed"].as_array().unwrap().iter().filter_map(Value::as_str).collect();
            let name = format!("{}, {}", mode["kind"].as_str().unwrap(), closed.join(" "));
            let state = analysis.ratios.get(&name).unwrap_or_else(|| panic!("{name}\n{text}"));
            assert_eq!(
                state.exact.as_ref().map(Rational::to_fraction).as_deref(),
                mode["ratio"].as_str(),
                "{name}\n{text}"
            );
            fixed += 1;
        }
    }
    assert!(fixed > 40 && points > 40, "{fixed} {points}");
}

/// Stops after so many steps.
struct Stopping(AtomicIsize);

impl Work for Stopping {
    fn advance(&self, steps: u64) {
        self.0.fetch_sub(steps as isize, Ordering::Relaxed);
    }

    fn cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed) <= 0
    }
}

fn progress(answer: &dyn Answer, name: &str) -> Value {
    let files = answer.extra("progress").unwrap();
    json!({ "name": name, "text": String::from_utf8(files[0].bytes.clone()).unwrap() })
}

#[test]
fn parts_put_together_give_the_bytes_of_the_whole() {
    for value in [with(&two_sets(5, 4), json!({ "order": "torque", "rediscover": "gm" })), hybrid()] {
        let (whole, _) = answered(value.clone(), &Serial);
        // Three machines, and one that puts together what they keep.
        let parts: Vec<Value> = (1..=3)
            .map(|k| {
                let (part, json) = answered(with(&value, json!({ "shard": format!("{k}/3") })), &Serial);
                assert!(!part.is_partial() && !json["completeness"]["complete"].as_bool().unwrap());
                assert!(part.text().contains("% of the parts of the space are finished"), "{}", part.text());
                progress(&*part, &format!("part-{k}.json"))
            })
            .collect();
        let (together, _) = answered(with(&value, json!({ "resume": parts })), &Serial);
        assert_eq!(together.json(), whole.json());
        // One that was interrupted, and goes on; what is kept of it is what is kept of the whole.
        let stopping = Stopping(5.into());
        let (stopped, json) = answered(value.clone(), &stopping);
        assert!(stopped.is_partial());
        assert_eq!(json["completeness"]["done"], 5);
        let kept = progress(&*stopped, "kept.json");
        let (on, _) = answered(with(&value, json!({ "resume": [kept] })), &Serial);
        assert_eq!(on.json(), whole.json());
        assert_eq!(on.extra("progress").unwrap(), whole.extra("progress").unwrap());
        // A part that another has, too.
        let twice = refused(with(&value, json!({ "resume": [kept, parts[0]] })));
        assert!(twice.contains("part-1.json") && twice.contains("is in both results"), "{twice}");
        // Pieces of the work.
        let cut = request(value.clone());
        let pieces: Vec<Vec<u8>> = (0..4).map(|k| cut.piece(&[], k, 4, &Serial).unwrap()).collect();
        assert_eq!(cut.gather(Arc::new([]), &pieces).unwrap().json(), whole.json());
        assert!(cut.gather(Arc::new([]), &pieces[1..]).err().unwrap().to_string().contains("in none of the pieces"));
        assert_eq!(cut.piece(&[], 0, 1, &Stopping(3.into())).unwrap_err(), Refusal::Cancelled);
        // Progress of something else.
        let kept = parts[0]["text"].as_str().unwrap();
        let spoil = |from: &str, to: &str| {
            assert!(kept.contains(from), "{from}\n{kept}");
            let text = kept.replacen(from, to, 1);
            refused(with(&value, json!({ "resume": [{ "name": "x.json", "text": text }] })))
        };
        assert!(spoil("\"done\":[0", "\"done\":[1,0").contains("one twice"));
        assert!(spoil("\"done\":[", "\"done\":[\"").contains("this is no progress"));
        assert!(spoil("\"choices\":", "\"choices\":0,\"choicer\":").contains("this is no progress"));
        assert!(spoil("progress-1", "progress-2").contains("this is `willis-"));
        let other = refused(with(&value, json!({ "top": 11, "resume": [parts[0]] })));
        assert!(other.contains("another wish") && other.contains("top differs"), "{other}");
        for text in ["", "{}", "[1,2", "null", "{\"format\":\"willis-sweep-1\"}"] {
            let said = refused(with(&value, json!({ "resume": [{ "name": "x.json", "text": text }] })));
            assert!(said.contains("this is no progress of such a search"), "{said}");
        }
    }
    // Counts that contradict each other.
    let (part, _) = answered(with(&two_sets(5, 4), json!({ "shard": "1/2" })), &Serial);
    let mut kept: Value = serde_json::from_str(progress(&*part, "")["text"].as_str().unwrap()).unwrap();
    kept["tally"]["schemes"] = json!(u64::MAX);
    let said = refused(with(&two_sets(5, 4), json!({ "resume": [{ "name": "x.json", "text": kept.to_string() }] })));
    assert!(said.contains("contradict each other"), "{said}");
}

#[test]
fn a_known_transmission_is_found_again() {
    let gm = with(&two_sets(5, 4), json!({ "rediscover": "gm-440", "top": 400 }));
    let (answer, json) = answered(gm, &Serial);
    let row = json["rediscovered"]["row"].as_u64().unwrap() as usize;
    assert_eq!(json["schemes"][row - 1]["id"], json["rediscovered"]["scheme"]["id"]);
    assert!(answer.text().contains(&format!("GM 440-T4 (4T60) is row {row}")));
    let (answer, _) = answered(with(&two_sets(4, 3), json!({ "rediscover": "gm" })), &Serial);
    assert!(answer.text().contains("does not do what is wanted"));
}

#[test]
fn an_empty_answer_says_what_must_give_way() {
    let (answer, json) = answered(with(&two_sets(4, 3), json!({ "max_speed": "1.05", "step": "1.9..2" })), &Serial);
    assert_eq!(json["found"]["schemes"], 0);
    let relaxations = json["relaxations"].as_array().unwrap();
    let upward = relaxations.iter().find(|r| r["change"].as_str().unwrap().contains("without an upper end")).unwrap();
    assert!(relaxations.len() >= 6 && relaxations.iter().all(|r| r["schemes"].is_u64()), "{relaxations:?}");
    let text = answer.text();
    assert!(text.contains("Nothing is left. What there is if one wish gives way"), "{text}");
    // How far: with that end the search finds the first of them.
    let until = upward["until"].as_f64().unwrap();
    let step = format!("1.9..{}", until + 1e-9);
    let (_, wider) = answered(with(&two_sets(4, 3), json!({ "max_speed": "1.05", "step": step })), &Serial);
    assert!(wider["found"]["schemes"].as_u64().unwrap() > 0);
    // A hybrid that cannot be.
    let (answer, _) =
        answered(json!({ "hybrid": true, "sets": 2, "clutches": 1, "need": ["compound-split", "electric"] }), &Serial);
    assert!(answer.text().contains("Nothing is left"), "{}", answer.text());
}

#[test]
fn where_nothing_is_said_the_teeth_are_told() {
    let (answer, json) = answered(json!({ "sets": 2, "elements": 4, "closed": 2, "forward": 3 }), &Serial);
    assert_eq!(json["wish"]["sets"], json!(["62/26", "74/42"]));
    assert!(answer.text().contains("those of the GM 440-T4 (4T60): no `k` is given"));
}

#[test]
fn tables_and_pictures_have_what_the_answer_has() {
    let (answer, json) = answered(with(&two_sets(5, 4), json!({ "top": 30 })), &Serial);
    let tables = answer.tables();
    let rows: Vec<(&str, usize)> = tables.iter().map(|t| (t.name.as_str(), t.rows.len())).collect();
    assert_eq!(rows[0], ("schemes", 30));
    assert_eq!(rows[2].1, json["waterfall"].as_array().unwrap().len());
    let gears: usize = json["schemes"]
        .as_array()
        .unwrap()
        .iter()
        .map(|s| s["gears"].as_array().unwrap().len() + s["reverse"].as_array().unwrap().len())
        .sum();
    assert_eq!(rows[1], ("gears", gears));
    #[cfg(feature = "pictures")]
    for (value, title) in [(two_sets(5, 4), "6 of 350 shift schemes"), (hybrid(), "6 of 2088 hybrids")] {
        let (answer, _) = answered(value, &Serial);
        let svg = String::from_utf8(answer.extra("plot").unwrap().remove(0).bytes).unwrap();
        assert!(svg.contains(title) && svg.contains("Row 6"), "{title}");
    }
}

/// Every example is a layout, or it is said why it is none.
#[test]
fn every_example_is_a_layout_or_is_refused_with_the_reason() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let mut layouts = vec![];
    for file in fs::read_dir(folder).unwrap() {
        let name = file.unwrap().file_name().into_string().unwrap();
        let Some(stem) = name.strip_suffix(".toml") else { continue };
        let text = example(&name);
        let value = json!({ "layout": { "name": name, "text": text }, "elements": 5, "forward": 2, "step": "1..9" });
        match request(value).ask_for_good(Arc::new([]), &Serial) {
            Ok(_) => layouts.push(stem.to_owned()),
            Err(refusal) => assert!(!refusal.to_string().is_empty(), "{name}"),
        }
    }
    layouts.sort();
    for known in ["zf-8hp70", "zf-8hp-gen4", "mercedes-9g-tronic"] {
        assert!(layouts.iter().any(|l| l == known), "{known}: {layouts:?}");
    }
    for (name, why) in
        [("zf-6hp26", "of type ravigneaux"), ("voltec", "has the variator"), ("ford-10r80", "`middle` carries no sun")]
    {
        let value = json!({ "layout": { "name": name, "text": example(&format!("{name}.toml")) }, "elements": 5, "forward": 2 });
        let said = refused(value);
        assert!(said.contains(why), "{said}");
    }
}

#[test]
fn bad_requests_are_refused_in_words() {
    let good = two_sets(5, 4);
    for (change, said) in [
        (json!({ "sets": 3 }), "`sets` says 3 sets, `k` 2"),
        (json!({ "k": ["0.5", "2"] }), "is not above 1"),
        (json!({ "k": ["a", "2"] }), "not a finite decimal number"),
        (json!({ "k": ["-62/26", "74/42"] }), "is not above 1"),
        (json!({ "k": ["1e60", "2"] }), "too many digits"),
        (json!({ "k": [] }), "it is not said how many sets"),
        (json!({ "k": [], "sets": 0 }), "there are 0 sets"),
        (json!({ "k": [], "sets": 1_000_000 }), "there are 1000000 sets"),
        (json!({ "k": vec!["2"; 1001] }), "has 1001 entries"),
        (json!({ "elements": null }), "`elements` is not given"),
        (json!({ "closed": null }), "`closed` is not given"),
        (json!({ "forward": null }), "`forward` is not given"),
        (json!({ "elements": u64::MAX }), "elements"),
        (json!({ "closed": u64::MAX }), "closed elements in every gear"),
        (json!({ "closed": 0 }), "0 closed elements"),
        (json!({ "forward": u64::MAX, "reverse": u64::MAX }), "too few for"),
        (json!({ "forward": 0 }), "no forward gear is wanted"),
        (json!({ "elements": 1 }), "2 of 1 elements cannot be closed"),
        (json!({ "step": "2..1" }), "is empty"),
        (json!({ "step": "1.1" }), "is no range"),
        (json!({ "step": "-1..2" }), "must be of positive numbers"),
        (json!({ "step": "0.5..1" }), "no step may be above 1"),
        (json!({ "step": "3..4" }), "more than the range"),
        (json!({ "forward_range": "a..b" }), "not a finite decimal number"),
        (json!({ "reverse_range": "0..2" }), "must be of positive numbers"),
        (json!({ "reverse": 0 }), "no reverse gear is wanted"),
        (json!({ "max_speed": "-3" }), "is not positive"),
        (json!({ "max_speed": "0.5" }), "no shaft may turn as fast as the input"),
        (json!({ "max_torque": "much" }), "not a finite decimal number"),
        (json!({ "order": "best" }), "is no order; there are found, spread, torque, speed, step"),
        (json!({ "rediscover": "alison" }), "did you mean `allison`"),
        (json!({ "rediscover": "" }), "there are gm-440-t4, allison-2000, zf-8hp70"),
        (json!({ "sample": 0 }), "one of 0 layouts"),
        (json!({ "shard": "0/4" }), "no part 0 of 4"),
        (json!({ "shard": "5/4" }), "no part 5 of 4"),
        (json!({ "shard": "1/0" }), "no part 1 of 0"),
        (json!({ "shard": "one" }), "write 3/16"),
        (json!({ "shard": "1/100000000" }), "too many parts"),
        (json!({ "write": [0] }), "there is no row 0"),
        (json!({ "write": [30], "top": 20 }), "row 30 is to be written and 20 are to be shown"),
        (json!({ "top": 10_000_000 }), "more than are shown at once"),
        (json!({ "clutches": 3, "mobility": 3 }), "`clutches`, `mobility` belong to the search for hybrids"),
        (json!({ "layout": { "name": "3453" } }), "three members for each of 1 to 5 sets"),
        (json!({ "layout": { "name": "333" } }), "two members of set 1 are in one shaft"),
        (json!({ "layout": { "name": "314541" }, "closed": 3 }), "not with 3"),
        (json!({ "layout": { "name": "345360678751" } }), "`k` says 2 sets, `layout` 4"),
        (json!({ "layout": { "name": "314541" }, "sample": 2 }), "where only one is searched"),
        (json!({ "layout": { "name": "x.toml", "text": "format = 1" } }), "x.toml"),
        (json!({ "layout": { "name": "", "text": "" } }), "`layout` is empty"),
    ] {
        let value = with(&good, change.clone());
        let message = refused(value);
        assert!(message.contains(said), "{change}: {message}");
    }
    for (change, said) in [
        (json!({ "clutches": null }), "`clutches` is not given"),
        (json!({ "clutches": 0 }), "there are 0 clutches"),
        (json!({ "need": [] }), "no mode is wanted"),
        (json!({ "need": ["split"] }), "no kind of mode; there are input-split"),
        (json!({ "mobility": 9 }), "a mobility of 9"),
        (json!({ "mobility": u64::MAX }), "a mobility of"),
        (json!({ "elements": 3 }), "`elements` belongs to the search for shift schemes"),
        (json!({ "k": ["2", "2", "2", "2"] }), "there are 4 sets"),
    ] {
        let message = refused(with(&hybrid(), change.clone()));
        assert!(message.contains(said), "{change}: {message}");
    }
    // All of it at once.
    let many = json!({ "k": ["0.5", "x"], "step": "2..1", "order": "best", "shard": "9", "rediscover": "none", "clutches": 3 });
    let message = refused(with(&good, many));
    for said in ["0.5", "`x`", "is empty", "is no order", "is no part", "`none`", "belongs to the search for hybrids"] {
        assert!(message.contains(said), "{said}: {message}");
    }
    // A space that takes hours: its size, its time, how to narrow it.
    let four = json!({ "sets": 4, "elements": 5, "closed": 3, "forward": 8 });
    let message = refused(four.clone());
    assert!(message.contains("18428400 layouts") && message.contains("5.1e12 choices"), "{message}");
    assert!(message.contains("`layout`") && message.contains("`yes`") && message.contains("`shard`"), "{message}");
}
