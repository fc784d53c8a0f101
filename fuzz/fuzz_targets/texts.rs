//! Every other text that a user writes or a program hands back. The first byte says which reader gets the rest: whatever it
//! is, nothing panics, and what is refused is refused with a reason that can be shown.

#![no_main]

use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use willis::diagnostic::Diagnostics;
use willis::model::{Model, Target};
use willis::study::{Axis, Profile, ProfileColumns, UncertaintyPlan, UncertaintyRequest};
use willis::train::{Document, Train};
use willis_ask::QUESTIONS;
use willis_figure::report::document::Document as Report;

const TRAIN: &str = include_str!("../../examples/fva-planetary-stage.toml");

static MODEL: LazyLock<Model> = LazyLock::new(|| Model::from_toml(TRAIN).expect("the example is right"));

/// A train with a scenario of one source, whose torque is this.
fn moving(torque: &str) -> String {
    format!(
        "format = 1\nname = \"wheel\"\nmembers = [\"a\"]\ninertias = {{ a = \"1 kg m^2\" }}\n[[scenario]]\nname = \"s\"\n\
         duration = \"1 s\"\n[[scenario.source]]\nmember = \"a\"\ntorque = {torque}\n"
    )
}

fn shown(wrong: impl Into<Diagnostics>, text: &str) {
    let wrong = wrong.into();
    assert!(wrong.has_errors(), "refused without a reason");
    let told = wrong.render("text", text, false);
    assert!(told.chars().all(|c| c == '\n' || willis::diagnostic::is_printable(c)), "a terminal would obey {told:?}");
}

type Reader = fn(&str);

const READERS: &[(u8, Reader)] = &[
    (b'a', |text| {
        if let Err(wrong) = Axis::parse(text, &MODEL) {
            shown(*wrong, "");
        }
    }),
    (b'u', |text| {
        let request = UncertaintyRequest { vary: text.lines().map(str::to_owned).collect(), samples: 128, ..Default::default() };
        if let Err(wrong) = UncertaintyPlan::new(&MODEL, &request) {
            shown(wrong, "");
        }
    }),
    (b'p', |text| {
        if let Err(wrong) = Profile::parse(text, &MODEL) {
            shown(wrong, text);
        }
        let only = ProfileColumns::Only(vec!["time".into(), "sun.speed".into()]);
        let _ = Profile::parse_columns(text, &MODEL, &only);
    }),
    (b's', |text| {
        let (path, value) = text.split_once('=').unwrap_or((text, ""));
        if let Err(wrong) = MODEL.with([(path, value)]) {
            shown(wrong, "");
        }
        let _ = Target::parse(path, &MODEL);
    }),
    (b'f', |text| {
        let formula = toml_string(text);
        let _ = Train::read_toml(&moving(&format!("{{ type = \"formula\", formula = {formula} }}")));
        let _ = Train::read_toml(&moving(&formula));
    }),
    // A signal as it stands in the file.
    (b'g', |text| {
        let text = moving(text);
        let reading = Train::read_toml(&text);
        if reading.train.is_none() {
            shown(reading.diagnostics, &text);
        }
    }),
    // The table that a train file names.
    (b't', |table| {
        let text = moving("{ type = \"csv\", file = \"a.csv\", time = \"t\", value = \"x\" }");
        if let Err(wrong) = Model::read(&text, &mut |_| Ok(table.to_owned())) {
            shown(wrong, &text);
        }
    }),
    (b'd', |text| {
        let Ok(mut document) = Document::parse(text) else { return };
        for path in document.paths().into_iter().take(64) {
            let Ok(key) = document.find(&path) else { continue };
            let before = document.value(&key);
            if let Some(value) = before {
                let _ = document.set(&key, &value);
            }
        }
        let _ = document.text();
    }),
    // Answers that come back, and reports that are shown again.
    (b'c', |text| {
        for question in QUESTIONS {
            let _ = question.reread(text);
        }
        let request: Result<serde_json::Value, _> = serde_json::from_str(text);
        if let Ok(request) = request {
            for question in QUESTIONS {
                let _ = question.request(request.clone());
            }
        }
    }),
    (b'r', |text| {
        if let Ok(report) = serde_json::from_str::<Report>(text) {
            let _ = willis_figure::html(&report);
        }
    }),
    // Pictures of small trains.
    (b'v', |text| {
        let Ok(model) = Model::from_toml(text) else { return };
        if model.train().meshes().len() > 8 || model.train().operations().len() > 4 {
            return;
        }
        for kind in ["stick", "lever", "sankey", "shift", "front", "path"] {
            let draw = willis_ask::question("draw").expect("there is one");
            let request = draw.request(serde_json::json!({ "kind": kind })).expect("a request");
            let given = [willis_ask::Given::new("fuzz.toml", model.clone())];
            if let Ok(answer) = request.ask(&given, &willis::work::Serial)
                && let Ok(files) = answer.write("svg")
            {
                for file in files {
                    let svg = std::str::from_utf8(&file.bytes).expect("text");
                    roxmltree::Document::parse(svg).unwrap_or_else(|e| panic!("{kind}: {e}"));
                }
            }
        }
    }),
];

fn toml_string(text: &str) -> String {
    let escaped: String = text.chars().flat_map(|c| if c.is_ascii_alphanumeric() { vec![c] } else { format!("\\U{:08X}", c as u32).chars().collect() }).collect();
    format!("\"{escaped}\"")
}

fuzz_target!(|bytes: &[u8]| {
    let Some((kind, rest)) = bytes.split_first() else { return };
    let Ok(text) = std::str::from_utf8(rest) else { return };
    if let Some((_, read)) = READERS.iter().find(|r| r.0 == *kind) {
        read(text);
    }
});
