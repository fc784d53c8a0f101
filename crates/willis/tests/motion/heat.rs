//! Temperatures follow what is lost in motion.

use std::ops::ControlFlow;

use willis::dynamics::{
    Column, ColumnKind, MotionHeat, Options, Outcome, Recorder, RunReport, Sample, Simulation, simulate,
};
use willis::model::Model;
use willis::study::{HeatRequest, heat};
use willis::train::Train;
use willis::work::Serial;

use crate::common;

/// Temperatures of the oil over time.
#[derive(Default)]
struct Oil {
    column: usize,
    rows: Vec<[f64; 2]>,
}

impl Recorder for Oil {
    fn columns(&mut self, columns: &[Column]) -> ControlFlow<()> {
        let oil = |c: &Column| c.kind == ColumnKind::Temperature && c.of == "oil";
        self.column = columns.iter().position(oil).expect("a temperature of the oil");
        ControlFlow::Continue(())
    }

    fn sample(&mut self, sample: Sample<'_>) -> ControlFlow<()> {
        self.rows.push([sample.time_s, sample.values[self.column]]);
        ControlFlow::Continue(())
    }
}

fn run(train: &Train, scenario: &str) -> (RunReport, MotionHeat, Vec<[f64; 2]>) {
    let mut oil = Oil::default();
    let report = simulate(train, scenario, &Options::default(), &mut oil).expect("a run");
    assert_eq!(report.outcome, Outcome::Finished);
    let heat = report.heat.clone().expect("temperatures");
    audit(&report, &heat);
    (report, heat, oil.rows)
}

/// What is lost is the heat that is made, and that is carried away or stored.
fn audit(report: &RunReport, heat: &MotionHeat) {
    let energy = report.energy.as_ref().expect("counted");
    assert!(energy.residual_j.abs() < 1e-9 * energy.turned_over_j, "{}", energy.residual_j);
    let lost: f64 = energy.losses.iter().map(|l| l.energy_j).sum();
    let made = heat.made_j + heat.elsewhere_j;
    assert!((made - lost).abs() <= 1e-9 * lost, "{made} J made of {lost} J lost");
    assert!(heat.residual.abs() < 1e-9, "{}", heat.residual);
}

/// A pair with a given efficiency: 1 kW of 10 kW is lost, whatever the temperature.
fn pair(more: &str) -> Train {
    Train::from_toml(&format!(
        r#"
        format = 1
        name = "a pair"
        members = ["a", "b", "wheel"]
        terminals = ["a", "b"]
        inertias = {{ a = "0.1 kg m^2", b = "0.1 kg m^2", wheel = "2 kg m^2" }}
        mesh = [{{ gears = [{{ member = "a", teeth = 20 }}, {{ member = "b", teeth = 20 }}], efficiency = 0.9 }}]
        heat = {{ ambient = "20 degC", conductance = "25 W/K", heat_capacity = "30 kJ/K", limit = "50 degC" }}
        {more}

        [[scenario]]
        name = "held"
        duration = "1 h"
        initial_speeds = {{ a = "100 rad/s", wheel = "100 rad/s" }}

        [[scenario.source]]
        member = "a"
        torque = "100 N m"

        [[scenario.source]]
        member = "b"
        speed = "-100 rad/s"
        "#
    ))
    .expect("a train")
}

/// One place with a constant loss: `T = T_air + P/UA (1 − exp(−t UA/C))`.
#[test]
fn val_one_place_warms_as_an_exponential() {
    let (_, heat, rows) = run(&pair(""), "held");
    for [t, oil] in &rows {
        let exact = 293.15 + 1000.0 / 25.0 * (1.0 - (-t * 25.0 / 30e3).exp());
        assert!((oil - exact).abs() < 1e-4, "{oil} K at {t} s, not {exact}");
    }
    assert_eq!((*heat.start_k.get("oil").unwrap(), *heat.end_k.get("ambient").unwrap()), (293.15, 293.15));
    assert_eq!(heat.highest_oil_k, *heat.end_k.get("oil").unwrap());
    // 50 °C after 1200 s ln 4.
    let beyond = heat.beyond_limit_s.expect("passed");
    assert!((beyond - 1200.0 * 4.0f64.ln()).abs() < 0.1, "{beyond}");
}

/// What rubs outside the gearbox warms nothing in it.
#[test]
fn a_drag_on_the_road_is_no_heat_of_the_gearbox() {
    let road = r#"drag = [{ name = "air", members = ["wheel"], coulomb = "5 N m" }]"#;
    let (report, heat, _) = run(&pair(road), "held");
    let air = report.energy.as_ref().unwrap().losses.iter().find(|l| l.name == "air").expect("lost").energy_j;
    assert!(air > 1000.0 && (heat.elsewhere_j - air).abs() < 1e-9 * air, "{} of {air}", heat.elsewhere_j);
}

/// A gearbox with laws at constant speed and load, from cold oil on.
fn gearbox(start: f64) -> Model {
    let oil = "temperature = \"80 degC\"";
    let text =
        common::example("industrial-planetary-heat").replacen(oil, &format!("temperature = \"{start} degC\""), 1);
    Model::from_toml(
        &(text
            + r#"
            [inertias]
            sun = "0.02 kg m^2"
            carrier = "0.4 kg m^2"

            [[scenario]]
            name = "warms"
            duration = "1 h"

            [[scenario.source]]
            member = "sun"
            speed = "1500 rpm"

            [[scenario.source]]
            member = "carrier"
            torque = "-3590 N m"

            [[scenario]]
            name = "idles"
            duration = "1 h"

            [[scenario.source]]
            member = "sun"
            speed = "1500 rpm"

            [[operation]]
            name = "the same"
            speeds = { sun = "1500 rpm" }
            torques = { carrier = "-3590 N m" }
            "#),
    )
    .expect("a train")
}

/// The warm-up of an operating point, which knows no motion, is that of the motion; and it ends in its balance.
#[test]
fn val_motion_warms_up_as_its_operating_point() {
    let model = gearbox(20.0);
    let train = model.train();
    let (report, ends, rows) = run(train, "warms");
    let request = HeatRequest {
        operation: Some("the same".into()),
        duration_s: Some(3600.0),
        start_k: Some(293.15),
        ..HeatRequest::default()
    };
    let study = heat(&model, &request, &Serial).expect("an answer");
    let theirs = &study.operations[0];
    let warm_up = theirs.warm_up.as_ref().expect("a warm-up");
    let mut worst = 0.0f64;
    for row in &warm_up.rows {
        let after = rows.iter().position(|r| r[0] >= row.time_s).expect("a row");
        let ours = match after {
            0 => rows[0][1],
            k => {
                let ([t0, a], [t1, b]) = (rows[k - 1], rows[k]);
                a + (b - a) * (row.time_s - t0) / (t1 - t0)
            }
        };
        worst = worst.max((ours - row.temperatures_k[0]).abs());
    }
    // The laws of the motion are one step of the temperature behind, and rows are joined by straight lines.
    assert!(worst < 0.1, "{worst} K apart");
    assert!(
        *ends.end_k.get("oil").unwrap() > 320.0
            && *ends.end_k.get("planets").unwrap() > *ends.end_k.get("oil").unwrap()
    );
    assert!(report.assumptions.iter().any(|a| a.contains("20 °C at the start")), "{:?}", report.assumptions);
    let last = warm_up.rows.last().unwrap();
    assert!((ends.made_j - warm_up.made_j).abs() < 1e-3 * ends.made_j, "{} {}", ends.made_j, last.heat_w);
}

/// A warm gearbox loses less than a cold one that starts alike: the laws see the oil that the run has.
#[test]
fn losses_follow_the_oil_as_it_warms() {
    let model = gearbox(20.0);
    let train = model.train();
    let mut run = Simulation::new(train, "idles", &Options::default()).expect("a run");
    let loss = run.output("loss").expect("a column");
    run.advance(1.0, &mut ());
    let cold = run.read(loss);
    run.advance(3000.0, &mut ());
    let warm = run.read(loss);
    assert!(warm < 0.9 * cold, "{warm} W warm, {cold} W cold");
    // Once more from the start: it is cold again.
    let mut again = run.again().expect("a run");
    again.advance(1.0, &mut ());
    assert_eq!(again.read(loss), cold);
}

/// A run that goes on from a saved state goes on as warm as it was, in steps of another program too.
#[test]
fn a_saved_run_is_as_warm_as_it_was() {
    let model = gearbox(20.0);
    let mut run = Simulation::new(model.train(), "warms", &Options::default()).expect("a run");
    for k in 1..=60 {
        run.go_on(f64::from(k));
    }
    let bytes = run.save();
    let mut other = Simulation::new(model.train(), "warms", &Options::default()).expect("a run");
    other.restore(&bytes).expect("its own state");
    let oil = run.output("oil.temperature").expect("a column");
    let warm = run.read(oil);
    assert!(warm > 294.0, "{warm}");
    for r in [&mut run, &mut other] {
        r.go_on(300.0);
    }
    let (a, b) = (run.read(oil), other.read(oil));
    assert!((a - b).abs() < 1e-9 && a > warm + 0.5, "{a} {b}");
    // In one piece it is the same, to the step of the temperature.
    let mut whole = Simulation::new(model.train(), "warms", &Options::default()).expect("a run");
    whole.go_on(300.0);
    assert!((whole.read(oil) - a).abs() < 0.02, "{} {a}", whole.read(oil));
}

/// Rows do not move the run, and a run in pieces is the run.
#[test]
fn temperatures_do_not_depend_on_who_looks() {
    let model = gearbox(60.0);
    let train = model.train();
    let (_, whole, _) = run(train, "warms");
    let few = Options { samples: Some(2), ..Options::default() };
    let report = simulate(train, "warms", &few, &mut ()).expect("a run");
    assert_eq!(report.heat.expect("temperatures").end_k, whole.end_k);
}
