//! Every answer for machines reads back: the same value, and the same bytes when written again.

use std::fmt::Debug;
use std::fs;
use std::path::Path;

use serde::Serialize;
use serde::de::DeserializeOwned;
use willis::analysis::{Analysis, LossRequest, LossTable, Selection, analyze, losses};
use willis::contract::Contract;
use willis::hypergraph::{FlowReport, flows};
use willis::losses::{LawList, list};
use willis::model::Model;
use willis::regimes::{Family, LocateRequest, Location, RegimeSelection, Regimes, family, locate, regimes};
use willis::study::{
    CompareRequest, CycleRequest, SweepRequest, UncertaintyRequest, compare, cycle, sensitivity, sweep, uncertainty,
};
use willis::train::Train;
use willis::work::Serial;

/// Writes an answer, reads it back, writes it again; says how long the text is.
fn round<T: Contract + Serialize + DeserializeOwned + PartialEq + Debug>(what: &str, answer: &T) -> usize {
    let (back, length) = bytes(what, answer);
    assert_eq!(&back, answer, "{what}: {}", T::FORMAT);
    length
}

/// The same without comparing the values; gives the one read back. A list of regimes also holds exact numbers that
/// its pictures are made from and that it does not tell.
fn bytes<T: Contract + Serialize + DeserializeOwned>(what: &str, answer: &T) -> (T, usize) {
    let text = serde_json::to_string(answer).unwrap();
    assert!(text.starts_with(&format!("{{\"format\":\"{}\"", T::FORMAT)), "{what}");
    let back: T = serde_json::from_str(&text).unwrap_or_else(|e| panic!("{what}: {} reads not back: {e}", T::FORMAT));
    assert_eq!(serde_json::to_string(&back).unwrap(), text, "{what}: {}", T::FORMAT);
    (back, text.len())
}

fn examples() -> Vec<(String, Train)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let mut all: Vec<_> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .map(|path| {
            let text = fs::read_to_string(&path).unwrap();
            (path.file_stem().unwrap().to_str().unwrap().to_owned(), text)
        })
        .filter_map(|(name, text)| Some((name, Train::from_toml(&text).ok()?)))
        .collect();
    all.sort_by(|a, b| a.0.cmp(&b.0));
    assert!(all.len() > 20, "{}", all.len());
    all
}

#[test]
fn answers_about_every_example_read_back() {
    let mut answers = [0; 6];
    for (name, train) in examples() {
        let mut told = |k: usize, length: usize| answers[k] += usize::from(length > 0);
        if let Ok(a) = analyze(&train, &Selection::default()) {
            told(0, round::<Analysis>(&name, &a));
        }
        if let Ok(a) = flows(&train, &Selection::default()) {
            told(1, round::<FlowReport>(&name, &a));
        }
        if let Ok(a) = regimes(&train, &RegimeSelection::default()) {
            told(2, bytes::<Regimes>(&name, &a).1);
        }
        if let Ok(a) = family(&train, &RegimeSelection::default()) {
            told(3, round::<Family>(&name, &a));
        }
        if let Ok(a) = losses(&train, &LossRequest::default()) {
            told(4, round::<LossTable>(&name, &a));
        }
        for o in train.operations() {
            let request = LocateRequest { operation: Some(o.name.clone()), ..LocateRequest::default() };
            if let Ok(a) = locate(&train, &request) {
                told(5, round::<Location>(&name, &a));
            }
        }
    }
    assert!(answers.iter().all(|n| *n > 0), "each contract was met: {answers:?}");
}

#[test]
fn the_comparison_of_laws_and_their_list_read_back() {
    let (name, train) = examples().into_iter().find(|(_, t)| t.is_physical()).unwrap();
    let request = LossRequest { compare: Some("mesh_friction".into()), ..LossRequest::default() };
    round::<LossTable>(&name, &losses(&train, &request).unwrap());
    round::<LawList>("laws", &list(None));
    assert_eq!(list(None).laws.len(), willis::losses::entries().len());
}

#[test]
fn another_format_is_refused_by_name() {
    let text = serde_json::to_string(&list(Some("bearing"))).unwrap();
    let wrong = serde_json::from_str::<Analysis>(&text).unwrap_err().to_string();
    assert!(wrong.contains("willis-laws-1") && wrong.contains("willis-analysis-1"), "{wrong}");
}

#[test]
fn studies_read_back() {
    let text = |file: &str| {
        fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples").join(file)).unwrap()
    };
    let model = |file: &str| Model::from_toml(&text(file)).unwrap();
    let (zf, fva, wolfrom) =
        (model("zf-8hp70.toml"), model("fva-planetary-stage.toml"), model("wolfrom-498-self-locking.toml"));
    for (name, model, over) in [
        ("zf", &zf, "state=all"),
        ("fva", &fva, "oil.temperature=20 degC, 60 degC, 150 degC"),
        ("wolfrom", &wolfrom, "output.torque=-10 N m, 10 N m"),
    ] {
        let request = SweepRequest { over: vec![over.into()], ..SweepRequest::default() };
        round(name, &sweep(model, &request, &Serial).unwrap().report);
    }
    for (name, model) in [("fva", &fva), ("zf", &zf)] {
        round(name, &sensitivity(model.train(), &Selection::default()).unwrap());
    }
    let request = UncertaintyRequest { samples: 128, ..UncertaintyRequest::default() };
    round("wolfrom", &uncertainty(&wolfrom, &request, &Serial).unwrap().report);
    let other = Model::from_toml(&text("zf-8hp70.toml").replacen("0.99", "0.98", 1)).unwrap();
    let request = CompareRequest { over: vec!["state=all".into()], ..CompareRequest::default() };
    round("zf", &compare(&[("a", &zf), ("b", &other)], &request, &Serial).unwrap());
    let request = CycleRequest { profile: text("cycle-8hp70.csv"), ..CycleRequest::default() };
    round("zf", &cycle(&zf, &request, &Serial).unwrap().report);
}
