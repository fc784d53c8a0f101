//! Every answer for every example reads back as the same text and is what its JSON Schema says.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use willis::analysis::Verdict;
use willis::model::Model;
use willis::work::{Serial, Work};
use willis_ask::questions::{Analyze, New, Simulate};
use willis_ask::table::{Kind, Table};
use willis_ask::{Entry, Given, Of, QUESTIONS, Question, Refusal, RefusalReport};

fn examples() -> Vec<Given> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let mut files: Vec<PathBuf> = fs::read_dir(&folder).unwrap().map(|f| f.unwrap().path()).collect();
    files.retain(|f| f.extension().is_some_and(|e| e == "toml"));
    files.sort();
    let read = |file: PathBuf| {
        let text = fs::read_to_string(&file).unwrap();
        let mut load = |name: &str| fs::read_to_string(folder.join(name)).map_err(|e| e.to_string());
        let model = Model::read(&text, &mut load).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
        Given::new(file.file_name().unwrap().to_string_lossy(), model)
    };
    files.into_iter().map(read).collect()
}

/// Requests of a question about Willis itself.
fn requests_without_train(entry: &Entry) -> Vec<Value> {
    match entry.name {
        "laws" => vec![json!({}), json!({ "oils": true }), json!({ "bearings": true })],
        "validate" => vec![json!({}), json!({ "case": "losses" })],
        "explain" => vec![json!({}), json!({ "code": "E101" }), json!({ "code": "hunting" })],
        "design" => {
            let file = |name: &str| {
                let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
                json!({ "name": name, "text": fs::read_to_string(folder.join(name)).unwrap() })
            };
            vec![
                json!({ "kind": "3k", "ratio": "100", "ring": "90 mm" }),
                json!({ "kind": "simple", "ratio": "4.2", "all": true, "sort": "planet_spin", "top": 3 }),
                json!({ "kind": "two-stage", "ratio": "20..20.1", "shard": "2/3" }),
                json!({ "kind": "3k", "ratio": "100", "ring": "20 mm", "module": ["0.5 mm"], "forward": "0.8" }),
                json!({ "like": file("simpson-ford-c4.toml") }),
                json!({ "like": file("fva-planetary-stage.toml"), "tolerance": "0.02" }),
            ]
        }
        "import" => {
            let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
            let text = fs::read_to_string(folder.join("fva-planetary-stage.toml")).unwrap();
            let given = [Given::read("fva.toml", &text).unwrap()];
            let export = willis_ask::question("export").unwrap().request(json!({ "kind": "rexs" })).unwrap();
            let files: Value = serde_json::from_str(&export.ask(&given, &Serial).unwrap().json()).unwrap();
            let file = |text: &Value| json!({ "name": "fva.rexs", "text": text });
            vec![
                json!({ "file": file(&files["files"][0]["text"]) }),
                json!({ "file": file(&files["files"][0]["text"]), "convention": "outward" }),
            ]
        }
        "schemes" => {
            let two =
                json!({ "sets": 2, "elements": 4, "closed": 2, "forward": 3, "rediscover": "gm", "order": "spread" });
            let none = json!({ "sets": 1, "elements": 2, "closed": 1, "forward": 2, "step": "9..10" });
            vec![
                json!({}),
                two,
                none,
                json!({ "hybrid": true, "sets": 2, "clutches": 3, "need": ["input-split", "fixed"] }),
            ]
        }
        _ => vec![json!({})],
    }
}

/// Requests of a question that suit any train.
fn requests(entry: &Entry, given: &Given) -> Vec<Value> {
    let train = given.model.train();
    match entry.name {
        // All at once is quicker: a kind that does not apply is answered with those that do.
        "draw" if given.name.starts_with("zf-") => {
            willis_figure::FigureKind::ALL.iter().map(|k| json!({ "kind": k.name() })).collect()
        }
        "draw" => vec![json!({ "kind": "all" })],
        "uncertainty" => vec![json!({ "samples": 128 })],
        "simulate" => train.scenarios().iter().map(|s| json!({ "scenario": s.name, "samples": 5 })).collect(),
        "sweep" if train.states().is_empty() => {
            vec![json!({ "over": ["oil.temperature=40 degC, 60 degC"], "columns": ["all"] })]
        }
        "sweep" => vec![json!({ "over": ["state=all"], "columns": ["all", "variators"] })],
        "compare" => vec![json!({}), json!({ "over": ["input.speed=500 rpm, 1000 rpm"] })],
        "regimes" => vec![json!({}), json!({ "family": true })],
        "locate" => train.operations().iter().map(|o| json!({ "operation": o.name })).collect(),
        "export" => willis::study::export::KINDS.iter().map(|k| json!({ "kind": k.id })).collect(),
        "table" => vec![json!({}), json!({ "lossless": true, "speed": "2000 rpm" })],
        "formula" => vec![json!({ "derivatives": true })],
        "heat" if train.heat().is_some() => {
            let text = "duration [min],input.speed [rpm]\n10,1500\n15,700\n";
            vec![json!({}), json!({ "profile": { "name": "profile.csv", "text": text } })]
        }
        "calibrate" => {
            let text = "oil.temperature [degC],loss [W]\n60,1000\n80,900\n";
            vec![json!({ "data": { "name": "tests.csv", "text": text } })]
        }
        "cycle" => {
            let states = train.states().iter().map(|s| s.name.as_str());
            let text: String = states.map(|s| format!("1,{s}\n")).collect();
            vec![json!({ "profile": { "name": "profile.csv", "text": format!("duration [s],state\n{text}") } })]
        }
        _ => vec![json!({})],
    }
}

/// What is wrong with a document by its schema.
struct Checker {
    schemas: boon::Schemas,
    indices: BTreeMap<&'static str, boon::SchemaIndex>,
}

impl Checker {
    fn new() -> Self {
        let (mut schemas, mut indices) = (boon::Schemas::new(), BTreeMap::new());
        let mut compiler = boon::Compiler::new();
        compiler.set_default_draft(boon::Draft::V2020_12);
        let refusal = ("refusal", RefusalReport::schema().to_value());
        for (name, schema) in QUESTIONS.iter().map(|q| (q.name, q.answer_schema().to_value())).chain([refusal]) {
            let place = format!("http://willis/{name}.json");
            compiler.add_resource(&place, schema).unwrap();
            indices.insert(name, compiler.compile(&place, &mut schemas).unwrap_or_else(|e| panic!("{name}: {e:#}")));
        }
        Self { schemas, indices }
    }

    fn check(&self, name: &str, document: &str, what: &str) {
        let value: Value = serde_json::from_str(document).unwrap();
        if let Err(e) = self.schemas.validate(&value, self.indices[name]) {
            panic!("{what}: {e:#}");
        }
    }
}

/// Units of columns, and what a name with that unit ends with.
const ENDINGS: [(&str, &str); 23] = [
    ("um", "_um"),
    ("rad/s^2", "_rad_s2"),
    ("rad/s", "_rad_s"),
    ("rpm", "_rpm"),
    ("rad", "_rad"),
    ("kg/m^3", "_kg_m3"),
    ("kg m^2", "_kg_m2"),
    ("m^2/s", "_m2_s"),
    ("mm^2/s", "_mm2_s"),
    ("N m", "_n_m"),
    ("N/m", "_n_per_m"),
    ("m/s", "_m_s"),
    ("degC", "_degc"),
    ("Pa", "_pa"),
    ("Hz", "_hz"),
    ("W", "_w"),
    ("J", "_j"),
    ("K", "_k"),
    ("N", "_n"),
    ("mm", "_mm"),
    ("m", "_m"),
    ("s", "_s"),
    ("1/s", "_1_s"),
];

/// Every column is called `[WHAT.]quantity[_unit]`: what it is of, the quantity, its unit.
fn check_names(what: &str, table: &Table, dimensions: &mut BTreeMap<String, (String, String)>) {
    let mut names = BTreeSet::new();
    for c in &table.columns {
        let (name, place) = (c.name.as_str(), format!("{what}, column `{}` in `{}`", c.name, c.unit));
        assert!(names.insert(name), "{place}: twice");
        let ending = ENDINGS.iter().find(|e| e.0 == c.unit).map(|e| e.1);
        assert!(c.unit.is_empty() || ending.is_some_and(|e| name.ends_with(e)), "{place}: its unit is not at its end");
        if c.kind != Kind::Number {
            assert!(c.unit.is_empty(), "{place}: a unit of no number");
            continue;
        }
        let end = ENDINGS.iter().find(|e| name.ends_with(e.1));
        assert!(!c.unit.is_empty() || end.is_none(), "{place}: has a unit by its name alone");
        // The quantity is one word of the contracts, and has one unit in all tables.
        let bare = name.strip_suffix(ending.unwrap_or("")).unwrap();
        let quantity = bare.rsplit('.').next().unwrap();
        let is_word = |q: &str| q.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_');
        assert!(is_word(quantity), "{place}: `{quantity}` is no quantity");
        let before = dimensions.entry(quantity.to_owned()).or_insert_with(|| (c.unit.clone(), place.clone()));
        // An axis has the unit that its user wrote.
        let written = [["rad/s", "rpm"], ["K", "degC"]];
        let is_same =
            before.0 == c.unit || written.iter().any(|w| [&*before.0, &*c.unit].iter().all(|u| w.contains(u)));
        assert!(is_same, "{place}: another unit than {}", before.1);
    }
    // What is written says the same.
    let csv = table.csv();
    let header = csv.lines().next().unwrap_or_default();
    assert_eq!(header.replace('"', ""), table.columns.iter().map(|c| &*c.name).collect::<Vec<_>>().join(","), "{what}");
    if let Some(row) = table.json_lines().lines().next() {
        let row: serde_json::Map<String, Value> = serde_json::from_str(row).unwrap();
        assert!(row.keys().eq(table.columns.iter().map(|c| &c.name)), "{what}");
    }
}

/// Questions in whose answers laws compute losses: they name every assumption that `analyze` names.
const COMPUTES: [&str; 12] = [
    "analyze",
    "table",
    "losses",
    "flow",
    "sensitivity",
    "uncertainty",
    "cycle",
    "sweep",
    "compare",
    "export",
    "heat",
    "calibrate",
];

/// The questions that take longest.
const LONG: [&str; 4] = ["draw", "formula", "report", "uncertainty"];

/// A test of each, so that they run side by side; one of all the others.
macro_rules! reads_back_and_is_what_its_schema_says {
    ($($test:ident: $chosen:expr;)+) => {
        $(
            #[test]
            fn $test() {
                examine($chosen);
            }
        )+
    };
}

reads_back_and_is_what_its_schema_says! {
    every_answer_of_draw_reads_back_and_is_what_its_schema_says: |name| name == "draw";
    every_answer_of_formula_reads_back_and_is_what_its_schema_says: |name| name == "formula";
    every_answer_of_report_reads_back_and_is_what_its_schema_says: |name| name == "report";
    every_answer_of_uncertainty_reads_back_and_is_what_its_schema_says: |name| name == "uncertainty";
    every_other_answer_reads_back_and_is_what_its_schema_says: |name| !LONG.contains(&name);
}

/// Kinds of export that are models in motion, and what they need not assume: inertias count, in some behind elastic shafts too.
const IN_MOTION: [(&str, &[&str]); 4] = [
    ("modelica", &["no inertia", "behind an elastic shaft"]),
    ("modelica-equations", &["no inertia", "behind an elastic shaft"]),
    ("mujoco", &["no inertia"]),
    ("drake", &["no inertia"]),
];

fn examine(chosen: fn(&str) -> bool) {
    let (checker, examples) = (Checker::new(), examples());
    let questions = || QUESTIONS.iter().filter(|q| chosen(q.name));
    // Tables that were promised and not yet seen.
    let mut promised: BTreeSet<(&str, &str)> =
        questions().flat_map(|q| q.tables.iter().map(|t| (q.name, *t))).collect();
    let mut dimensions = BTreeMap::new();
    let mut answered: BTreeMap<&str, usize> = questions().map(|q| (q.name, 0)).collect();
    for entry in questions() {
        let of: Vec<&[Given]> = match entry.of {
            Of::Nothing => vec![&[]],
            Of::Trains => examples.windows(2).collect(),
            _ => examples.chunks(1).collect(),
        };
        for of in of {
            for value in of.first().map_or_else(|| requests_without_train(entry), |given| requests(entry, given)) {
                let what = format!("{} {value} of {:?}", entry.name, of.first().map(|g| &g.name));
                let left_out = value["kind"].as_str().and_then(|kind| IN_MOTION.iter().find(|k| k.0 == kind));
                let left_out = left_out.map_or(&[][..], |k| k.1);
                let request = entry.request(value).unwrap_or_else(|e| panic!("{what}: {e}"));
                let answer = match request.ask(of, &Serial) {
                    Ok(answer) => answer,
                    // Not every question suits every train; a refusal is a contract too.
                    Err(refusal) => {
                        let report = serde_json::to_string_pretty(&refusal.report(of)).unwrap();
                        let back: RefusalReport = serde_json::from_str(&report).unwrap();
                        assert_eq!(serde_json::to_string_pretty(&back).unwrap(), report, "{what}");
                        checker.check("refusal", &report, &what);
                        continue;
                    }
                };
                let json = answer.json();
                if let Some(given) = of.first().filter(|_| COMPUTES.contains(&entry.name)) {
                    let train = given.model.train();
                    for line in willis::analysis::assumptions(train).into_iter().filter(|_| train.is_physical()) {
                        let said = !left_out.iter().any(|part| line.contains(part));
                        let line = serde_json::to_string(&line).unwrap();
                        assert_eq!(json.contains(&line), said, "{what}: {line}");
                    }
                }
                let back = entry.reread(&json).unwrap_or_else(|e| panic!("{what}: {e}\n{json}"));
                assert_eq!(back + "\n", json, "{what}");
                checker.check(entry.name, &json, &what);
                assert!(!answer.text().is_empty() || entry.name == "sweep", "{what}");
                for table in answer.tables() {
                    assert!(entry.tables.contains(&table.name.as_str()), "{what}: {}", table.name);
                    check_names(&format!("{what}: {}", table.name), &table, &mut dimensions);
                    promised.retain(|(question, name)| (*question, *name) != (entry.name, &*table.name));
                    assert!(!table.csv().contains("NaN") && !table.csv().contains("inf,"), "{what}");
                }
                *answered.get_mut(entry.name).unwrap() += 1;
            }
        }
    }
    let silent: Vec<_> = answered.iter().filter(|a| *a.1 == 0).collect();
    assert!(silent.is_empty(), "nothing was answered to {silent:?}");
    assert!(promised.is_empty(), "no answer has the tables {promised:?}");
}

/// Cancels everything from the first time it is asked.
struct Stopped;

impl Work for Stopped {
    fn cancelled(&self) -> bool {
        true
    }
}

#[test]
fn what_was_stopped_says_so() {
    let mut told = 0;
    // Those with very many parts.
    for entry in QUESTIONS.iter().filter(|q| ["simulate", "sweep", "cycle", "uncertainty"].contains(&q.name)) {
        for given in examples().chunks(1) {
            for value in requests(entry, &given[0]) {
                let request = entry.request(value).unwrap();
                match request.ask(given, &Stopped) {
                    Ok(answer) if entry.name == "simulate" => assert!(answer.is_partial()),
                    Ok(_) => panic!("`{}` of {} was answered", entry.name, given[0].name),
                    // Not every question suits every train.
                    Err(refusal) => {
                        told += usize::from(refusal == Refusal::Cancelled);
                    }
                }
            }
        }
    }
    assert!(told > 40, "{told}");
}

#[test]
fn fields_that_exclude_each_other_are_refused() {
    let examples = examples();
    for (name, fields) in [
        ("simulate", json!({ "fixed_step": "1 ms", "tolerance": 1e-6 })),
        ("simulate", json!({ "tolerance": 5.0 })),
        ("simulate", json!({ "samples": 1 })),
        ("simulate", json!({ "lagged_forces": true })),
        ("sweep", json!({ "study": "x", "over": ["input.speed=1 rpm"] })),
        ("losses", json!({ "powers": ["1 kW"], "torques": ["1 N m"] })),
        ("regimes", json!({ "family": true, "balance": ["a", "b"] })),
        ("export", json!({ "kind": "csv", "state": "1", "all_states": true })),
        ("draw", json!({ "scale": 100.0 })),
        ("design", json!({ "kind": "3k", "ratio": "100", "file": { "name": "x" } })),
        ("design", json!({ "kind": "3k", "ratio": "100", "all": true, "shard": "1/2" })),
        ("design", json!({ "kind": "3k" })),
        ("design", json!({ "ring": "90 mm" })),
    ] {
        let given = examples.iter().find(|g| !g.model.train().scenarios().is_empty()).unwrap();
        let request = willis_ask::question(name).unwrap().request(fields.clone()).unwrap();
        let of: &[Given] = if request.question().of == Of::Nothing { &[] } else { std::slice::from_ref(given) };
        let refused = request.ask(of, &Serial).err();
        assert!(matches!(refused, Some(Refusal::Wrong(_, 0))), "{name} {fields}: {refused:?}");
    }
}

#[test]
fn the_name_in_the_list_is_the_name_in_the_answer() {
    let mut seen = vec![];
    for entry in QUESTIONS {
        assert!(!seen.contains(&entry.name), "`{}` stands twice in the list", entry.name);
        seen.push(entry.name);
        assert!(entry.contract.starts_with("willis-") && entry.contract.ends_with("-1"), "{}", entry.contract);
        assert!(entry.about().len() > 20, "`{}` says nothing about itself", entry.name);
    }
}

#[test]
fn a_request_refuses_what_it_does_not_have() {
    for entry in QUESTIONS {
        let Err(Refusal::Wrong(wrong, _)) = entry.request(json!({ "no such field": 1 })) else {
            panic!("`{}` takes anything", entry.name)
        };
        assert!(wrong.to_string().contains("no such field"), "{wrong}");
        let request = entry.request(json!({})).unwrap_or_else(|e| panic!("`{}` has no defaults: {e}", entry.name));
        assert_eq!(entry.request(request.to_json()).unwrap().to_json(), request.to_json());
    }
}

#[test]
fn every_field_of_a_request_says_what_it_is() {
    for entry in QUESTIONS {
        let schema = entry.request_schema().to_value();
        for (name, field) in schema["properties"].as_object().into_iter().flatten() {
            let told = field["description"].as_str().is_some_and(|d| d.len() > 5);
            assert!(told, "`{name}` of `{}` is not described: {field}", entry.name);
        }
    }
}

#[test]
fn every_start_is_a_train_without_a_warning() {
    let starts = Question::ask(&New::default(), &[], &Serial).expect("all starts").starts;
    assert!(starts.len() > 3, "{}", starts.len());
    for start in starts {
        let kind = &start.kind;
        let model = Model::from_toml(&start.toml).unwrap_or_else(|e| panic!("{kind}: {e}"));
        let given = [Given::new(kind, model)];
        assert!(given[0].model.warnings().is_empty(), "{kind}: {:?}", given[0].model.warnings());
        let analysis = Question::ask(&Analyze::default(), &given, &Serial).unwrap();
        assert!(analysis.operations.iter().all(|o| o.verdict == Verdict::Unique), "{kind}");
        let runs = !given[0].model.train().scenarios().is_empty();
        assert!(!analysis.operations.is_empty() || runs, "{kind}");
        if runs {
            Question::ask(&Simulate::default(), &given, &Serial).unwrap();
        }
    }
}
