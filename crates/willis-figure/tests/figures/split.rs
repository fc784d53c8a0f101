//! Power splits over their ratio agree with the analysis, and know their mechanical points exactly.

use willis::Selection;
use willis::analysis::analyze;
use willis::model::Model;
use willis_figure::{FigureRequest, draw_split, split};

fn model(name: &str) -> Model {
    let path = format!("{}/../../examples/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    Model::from_toml(&std::fs::read_to_string(path).unwrap()).unwrap()
}

#[test]
fn two_modes_meet_at_a_mechanical_point() {
    let s = split(&model("two-mode-split"), &FigureRequest::default()).unwrap();
    let [low, high] = &s.modes[..] else { panic!("{:?}", s.modes.len()) };
    let points = |m: &willis_figure::SplitMode| -> Vec<String> {
        m.mechanical.iter().map(|p| format!("{} {}", p.side, p.exact)).collect()
    };
    assert_eq!(points(low), ["mg_a 3/2"]);
    assert_eq!(points(high), ["mg_b 3/4", "mg_a 3/2"]);
    // Below it the compound split is better, above it the input split.
    for (x, best) in s.x.values.iter().zip(&s.best) {
        if (x - 1.5).abs() > 0.05 && *x > 0.8 {
            assert_eq!(*best, Some(usize::from(*x < 1.5)), "{x}");
        }
    }
    // Where a side of it stands still nothing passes the variator.
    for (x, p) in s.x.values.iter().zip(&high.points) {
        assert_eq!(p.share.unwrap() < 0.0, *x > 0.75 && *x < 1.5, "{x}: {p:?}");
    }
}

#[test]
fn a_point_of_the_figure_is_the_operation() {
    let model = model("prius-hybrid");
    let request = FigureRequest { over: vec!["ratio=0.75,1,2".into()], ..Default::default() };
    let s = split(&model, &request).unwrap();
    let a = analyze(model.train(), &Selection::default()).unwrap();
    let own = &a.operations[0].solutions[0];
    let point = &s.modes[0].points[0];
    assert!((point.efficiencies[0] - own.efficiency.unwrap()).abs() < 1e-12);
    assert!((point.share.unwrap() - own.variators.get("electric path").unwrap().share).abs() < 1e-12);
    assert_eq!(s.modes[0].mechanical[0].exact.to_string(), "13/18");
}

#[test]
fn five_modes_have_two_curves_and_a_dot() {
    let s = split(&model("voltec"), &FigureRequest::default()).unwrap();
    let states: Vec<_> = s.modes.iter().filter_map(|m| m.state.as_deref()).collect();
    assert_eq!(states, ["low range", "high range"]);
    assert!(s.gears.iter().any(|g| g.state == "fixed ratio" && g.efficiency > 0.97), "{:?}", s.gears);
    let svg = draw_split(&s);
    assert!(svg.contains("low range") && svg.contains("MGA at rest"));
}

#[test]
fn a_train_without_a_variator_has_none() {
    let wrong = split(&model("prius-p112"), &FigureRequest::default()).unwrap_err().to_string();
    assert!(wrong.contains("no variator"), "{wrong}");
    let request = FigureRequest { over: vec!["engine.speed=1..2:5".into()], ..Default::default() };
    assert!(split(&model("prius-hybrid"), &request).is_err());
}
