//! Steps from a state to the next.

use willis::Model;
use willis::analysis::{Selection, analyze};
use willis::exact::Rational;
use willis::work::Serial;
use willis_synthesis::teeth::{Around, Design, Request};

const FORD: &str = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/simpson-ford-c4.toml"));

/// The design around the Ford C4 with other targets.
fn around(targets: &str) -> String {
    let text = Around::new("0.04").to_toml(FORD).unwrap();
    let from = text.find("target = [").unwrap();
    let to = from + text[from..].find("]\n").unwrap();
    format!("{}target = [{targets}{}", &text[..from], &text[to..])
}

fn read(targets: &str) -> Design {
    let text = around(targets);
    Design::from_toml(&text).unwrap_or_else(|e| panic!("{}", e.render("design", &text, false)))
}

/// The ratios of a state and the next, exactly, of every train of a design.
fn quotients(design: &Design) -> Vec<Rational> {
    let answer = design.answer(&Request { top: Some(1_000_000), all: true, ..Request::default() }, &Serial).unwrap();
    let quotient = |row| {
        let model = Model::from_toml(&design.train_file(row)).unwrap();
        let ratios = analyze(model.train(), &Selection::default()).unwrap().ratios;
        let of = |state: &str| ratios.get(state).unwrap().exact.clone().unwrap();
        &of("1") / &of("2")
    };
    answer.rows.iter().map(quotient).collect()
}

#[test]
fn steps_leave_what_their_windows_hold_and_both_ends() {
    let first = "{ state = \"1\", ratio = [2.4, 2.5], STEP }, { state = \"R\", ratio = [-2.22, -2.16] }";
    let free = read(&first.replace(", STEP", ""));
    let mut all = quotients(&free);
    all.sort();
    assert!(all.len() > 20, "{}", all.len());
    // Ends that trains have exactly, and a window between them.
    let (low, high) = (&all[all.len() / 4], &all[all.len() * 3 / 4]);
    let middle = |a: &Rational, b: &Rational| &(a + b) / &Rational::from(2);
    for window in [[low.clone(), high.clone()], [low.clone(), low.clone()], [middle(low, high), high.clone()]] {
        let step = format!("step = [\"{}\", \"{}\"]", window[0].to_fraction(), window[1].to_fraction());
        let design = read(&first.replace("STEP", &step));
        let answer = design.answer(&Request::default(), &Serial).unwrap();
        let brute = all.iter().filter(|q| window[0] <= **q && **q <= window[1]).count() as u64;
        assert_eq!(answer.waterfall.last().unwrap().trains, brute, "{step}");
        assert!(answer.waterfall.iter().any(|s| s.condition == "step") && brute > 0);
        assert!(answer.wish.contains("step from 1 to 2: "), "{}", answer.wish);
        // The next state has no ratio of its own to reach.
        let row = &answer.rows[0];
        assert!(row.states.get("2").unwrap().target.is_none() && row.states.get("1").unwrap().target.is_some());
    }
}

#[test]
fn a_step_alone_is_a_target_and_may_be_what_must_give() {
    let impossible = "{ state = \"1\", ratio = [2.4, 2.5], step = [3, 4] }";
    let answer = read(impossible).answer(&Request::default(), &Serial).unwrap();
    assert_eq!(answer.waterfall.last().unwrap().trains, 0);
    assert!(answer.relaxations.iter().any(|r| r.wish == "step" && r.trains > 0), "{:?}", answer.relaxations);
    let alone = read("{ state = \"1\", step = 1.7, tolerance = 0.001 }");
    let answer = alone.answer(&Request { top: Some(3), ..Request::default() }, &Serial).unwrap();
    assert!(answer.completeness.complete && !answer.rows.is_empty());
    for row in &answer.rows {
        let of = |state: &str| row.states.get(state).unwrap().value;
        assert!((of("1") / of("2") / 1.7 - 1.0).abs() <= 0.001 + 1e-12);
    }
}

#[test]
fn steps_that_cannot_be_are_refused() {
    for (target, says) in [
        ("{ state = \"R\", step = 1.5 }", "no state follows `R`"),
        ("{ state = \"1\", step = [2, 1] }", "the window from 2 to 1 is empty"),
        ("{ state = \"1\", step = -1.5 }", "is not above 0"),
        ("{ state = \"1\", step = [0, 1] }", "is not above 0"),
        ("{ state = \"1\", step = [1, 2, 3] }", "a number, or a list of two"),
        ("{ state = \"1\", step = \"x\" }", "a number such as"),
        ("{ state = \"1\" }", "needs a `ratio` or a `step`"),
    ] {
        let wrong = Design::from_toml(&around(target)).unwrap_err();
        assert!(wrong.to_string().contains(says), "{target}: {wrong}");
    }
}
