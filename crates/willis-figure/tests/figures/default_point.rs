//! Every gear can be pictured, also where the file has no operating point in it.

use willis::diagnostic::Code;
use willis::model::Model;
use willis_figure::{Figure, FigureKind, FigureRequest, shift};

use crate::common::examples;
use crate::trains::{hard, model};

fn all() -> impl Iterator<Item = (String, Model)> {
    let own = examples().into_iter().map(|(name, _)| (name.clone(), model(&name)));
    own.chain(hard().into_iter().map(|(name, model)| (name.to_owned(), model)))
}

#[test]
fn every_gear_has_a_power_flow_and_a_ranking() {
    let (mut drawn, mut compared) = (0, 0);
    for (name, model) in all() {
        let train = model.train();
        let Ok(table) = shift(train) else { continue };
        for (k, row) in table.rows.iter().enumerate() {
            let request = FigureRequest { state: Some(row.state.clone()), ..Default::default() };
            let turns = row.ratio.is_some() && row.drive.value.is_some_and(|e| e > 0.0);
            let figure = match FigureKind::Sankey.make(&model, &request) {
                Ok(figure) => figure,
                Err(why) => {
                    assert!(!turns, "{name} {}: {why}", row.state);
                    continue;
                }
            };
            let Figure::Sankey(flow) = figure else { panic!("another kind") };
            assert!(FigureKind::Flow.make(&model, &request).is_ok(), "{name} {}", row.state);
            drawn += 1;
            // The default is a point of the same train: without laws its efficiency is the one of the shift table.
            let of_file = train.operations().iter().any(|o| o.state == Some(k));
            let given = train.meshes().iter().all(|m| !m.computed);
            if let (false, true, Some(expected), Some(_)) = (of_file, given, row.drive.value, &flow.panels[0].flow) {
                // Where friction allows several equilibria, it is one of them.
                let found: Vec<f64> = flow.panels.iter().filter_map(|p| p.flow.as_ref()?.efficiency).collect();
                let place = format!("{name} {}: {found:?}, not {expected}", row.state);
                assert!(found.iter().any(|e| (e - expected).abs() < 1e-9), "{place}");
                assert!(flow_name_says_so(&figure_title(&model, &request)), "{name} {}", row.state);
                compared += 1;
            }
            // A gear without losses has nothing to rank; every other one has.
            if turns
                && row.drive.value.is_some_and(|e| e < 1.0 - 1e-9)
                && let Err(why) = FigureKind::Tornado.make(&model, &request)
            {
                let told = |code| why.iter().any(|d| d.code == code);
                assert!(!told(Code::UnknownSelection), "{name} {}: {why}", row.state);
            }
        }
    }
    assert!(drawn > 120 && compared > 60, "{drawn} drawn, {compared} compared");
}

fn figure_title(model: &Model, request: &FigureRequest) -> String {
    match FigureKind::Sankey.make(model, request) {
        Ok(Figure::Sankey(s)) => s.panels[0].title.clone(),
        _ => String::new(),
    }
}

fn flow_name_says_so(title: &str) -> bool {
    title.contains("default point") && title.contains("rpm")
}

#[test]
fn a_train_without_operations_has_one_too() {
    let text = r#"
        format = 1
        name = "one set"
        members = ["s", "c"]
        terminals = ["s", "c"]
        [[set]]
        name = "P1"
        sun = { member = "s", teeth = 30 }
        ring = { member = "frame", teeth = 70 }
        carrier = "c"
        mesh_efficiency = 0.99
    "#;
    let model = Model::from_toml(text).unwrap();
    for kind in [FigureKind::Sankey, FigureKind::Flow, FigureKind::Tornado] {
        assert!(kind.make(&model, &FigureRequest::default()).is_ok(), "{}", kind.name());
    }
    // A state that does not exist is still refused.
    let request = FigureRequest { state: Some("7".into()), ..Default::default() };
    assert!(FigureKind::Sankey.make(&model, &request).is_err());
}
