//! Every answer for every example reads back as the same text and is what its JSON Schema says.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use willis::model::Model;
use willis::work::Serial;
use willis_ask::{Entry, Given, Of, QUESTIONS, Refusal, RefusalReport};

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
        "explain" => vec![json!({}), json!({ "code": "E101" })],
        _ => vec![json!({})],
    }
}

/// Requests of a question that suit any train.
fn requests(entry: &Entry, given: &Given) -> Vec<Value> {
    let train = given.model.train();
    match entry.name {
        "draw" => willis_figure::FigureKind::ALL.iter().map(|k| json!({ "kind": k.name() })).collect(),
        "uncertainty" => vec![json!({ "samples": 128 })],
        "simulate" => (train.scenarios().iter())
            .map(|s| json!({ "scenario": s.name, "samples": 5, "columns": ["speed", "mode"] }))
            .collect(),
        "sweep" if train.states().is_empty() => vec![json!({ "over": ["oil.temperature=40 degC, 60 degC"] })],
        "sweep" => vec![json!({ "over": ["state=all"], "columns": ["members"] })],
        "compare" => vec![json!({}), json!({ "over": ["input.speed=500 rpm, 1000 rpm"] })],
        "regimes" => vec![json!({}), json!({ "family": true })],
        "locate" => train.operations().iter().map(|o| json!({ "operation": o.name })).collect(),
        "export" => {
            let kinds = ["vecto", "modelica", "modelica-loss-table", "mujoco"];
            kinds.iter().map(|k| json!({ "kind": k })).collect()
        }
        "formula" => vec![json!({ "derivatives": true })],
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

#[test]
fn every_answer_reads_back_and_is_what_its_schema_says() {
    let (checker, examples) = (Checker::new(), examples());
    // Tables that were promised and not yet seen.
    let mut promised: BTreeSet<(&str, &str)> =
        QUESTIONS.iter().flat_map(|q| q.tables.iter().map(|t| (q.name, *t))).collect();
    let mut answered: BTreeMap<&str, usize> = QUESTIONS.iter().map(|q| (q.name, 0)).collect();
    for entry in QUESTIONS {
        let of: Vec<&[Given]> = match entry.of {
            Of::Nothing => vec![&[]],
            Of::Trains => examples.windows(2).take(6).collect(),
            // These take long; every fifth train has all that is in their answers.
            _ if ["draw", "report", "uncertainty", "formula"].contains(&entry.name) => {
                examples.chunks(1).step_by(5).collect()
            }
            _ => examples.chunks(1).collect(),
        };
        for of in of {
            for value in of.first().map_or_else(|| requests_without_train(entry), |given| requests(entry, given)) {
                let what = format!("{} {value} of {:?}", entry.name, of.first().map(|g| &g.name));
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
                let back = entry.reread(&json).unwrap_or_else(|e| panic!("{what}: {e}\n{json}"));
                assert_eq!(back + "\n", json, "{what}");
                checker.check(entry.name, &json, &what);
                assert!(!answer.text().is_empty() || entry.name == "sweep", "{what}");
                for table in answer.tables() {
                    assert!(entry.tables.contains(&table.name.as_str()), "{what}: {}", table.name);
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
