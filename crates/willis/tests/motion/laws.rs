//! A physical train in motion follows the laws of its operating points.

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use willis::analysis::{Selection, SolutionReport, analyze};

use willis::dynamics::{FixedStep, Options, Outcome, Recorder, RunReport, Sample, simulate};
use willis::losses::entries;
use willis::train::Train;

use crate::common;

/// An example with moments of inertia and motions.
fn example(name: &str, more: &str) -> Train {
    Train::from_toml(&(common::example(name) + more)).expect("a train")
}

/// A stage with everything that costs power.
fn train(scenarios: &str) -> Train {
    let inertias = "\n[inertias]\nsun = \"0.02 kg m^2\"\ncarrier = \"0.4 kg m^2\"\n";
    example("fva-planetary-stage", &(inertias.to_owned() + scenarios))
}

/// The equilibrium of an operation, by default the first.
fn solution(train: &Train, operation: &str) -> SolutionReport {
    let all = analyze(train, &Selection::default()).expect("operating points");
    let mut points = all.operations.iter();
    let point = points.find(|o| operation.is_empty() || o.name == operation).expect("the operation");
    point.solutions[0].clone()
}

/// The last row of a run.
#[derive(Default)]
struct Last(Vec<f64>);

impl Recorder for Last {
    fn sample(&mut self, sample: Sample<'_>) -> ControlFlow<()> {
        self.0 = sample.values.to_vec();
        ControlFlow::Continue(())
    }
}

fn run(train: &Train, scenario: &str) -> (RunReport, Vec<f64>) {
    let mut last = Last::default();
    let report = simulate(train, scenario, &Options::default(), &mut last).expect("a run");
    assert_eq!(report.outcome, Outcome::Finished);
    let energy = report.energy.as_ref().expect("counted");
    let residual = energy.residual_j.abs() / energy.turned_over_j;
    assert!(residual < 1e-9, "{scenario}: the energy closes to {residual:e}");
    (report, last.0)
}

/// Losses of an operating point in the words of motion, W.
fn by_source(solution: &SolutionReport) -> BTreeMap<String, f64> {
    let mut all = BTreeMap::new();
    for s in &solution.sources {
        let kind = format!("{:?}", s.kind).to_lowercase();
        let kind = if kind == "sliding" { "mesh".into() } else { kind };
        *all.entry(format!("{kind} {}", s.name)).or_insert(0.0) += s.loss_w;
    }
    all
}

/// Losses of a run, J.
fn by_cause(report: &RunReport) -> BTreeMap<String, f64> {
    let mut all = BTreeMap::new();
    for l in &report.energy.as_ref().expect("counted").losses {
        let name = l.name.split(" rolling on ").next().expect("a name");
        let name = name.trim_end_matches(" windage").trim_end_matches(" churning");
        *all.entry(format!("{} {name}", l.kind)).or_insert(0.0) += l.energy_j;
    }
    all
}

fn close(what: &str, ours: f64, theirs: f64, tolerance: f64) {
    let error = (ours - theirs).abs() / theirs.abs();
    assert!(error < tolerance, "{what}: {ours}, not {theirs}: {error:e}");
}

fn held(load: f64) -> String {
    format!(
        "
[[scenario]]
name = \"held\"
duration = \"1 s\"

[[scenario.source]]
name = \"motor\"
member = \"sun\"
speed = \"1500 rpm\"

[[scenario.source]]
name = \"load\"
member = \"carrier\"
torque = \"{load} N m\"
"
    )
}

/// Every loss of a run of one second is that of an operating point.
fn compare(what: &str, point: &SolutionReport, report: &RunReport) {
    let (theirs, ours) = (by_source(point), by_cause(report));
    for (name, loss) in &theirs {
        close(&format!("{what}, {name}"), ours[name], *loss, 1e-8);
    }
    let all = |of: &BTreeMap<String, f64>| of.values().sum::<f64>();
    close(&format!("{what}, loss"), all(&ours), all(&theirs), 1e-8);
    close(
        what,
        report.energy.as_ref().and_then(|e| e.efficiency).expect("steady"),
        point.efficiency.expect("one"),
        1e-9,
    );
}

/// At steady speed every loss of motion is that of the operating point: the laws are the same and nothing is left out.
#[test]
fn val_steady_motion_is_the_operating_point() {
    for operation in ["rated", "a tenth of the torque", "coasting"] {
        let point = solution(&train(""), operation);
        let load = point.members.get("carrier").and_then(|m| m.torque_n_m).expect("a torque");
        let (report, _) = run(&train(&held(load)), "held");
        compare(operation, &point, &report);
    }
}

/// The same under every law of tooth friction, rolling and bearings.
#[test]
fn val_every_law_is_followed() {
    for entry in entries().iter().filter(|e| ["mesh_friction", "rolling", "bearing"].contains(&e.family)) {
        let with = |train: Train| train.with_law(entry.family, entry.id).expect("a law");
        let point = solution(&with(train("")), "rated");
        let load = point.members.get("carrier").and_then(|m| m.torque_n_m).expect("a torque");
        let (report, _) = run(&with(train(&held(load))), "held");
        compare(entry.id, &point, &report);
    }
}

/// The same for other trains: two stages with a closed path of power, and a slow stage with a carrier that drives.
#[test]
fn val_other_trains_are_followed() {
    for (name, input, output) in
        [("wang-herringbone-physical", "sun2", "output"), ("nrel-5mw-stage-1", "carrier", "sun")]
    {
        let inertias = format!("\n[inertias]\n{input} = \"1 kg m^2\"\n{output} = \"1 kg m^2\"\n");
        let point = solution(&example(name, &inertias), "");
        let speed = point.members.get(input).and_then(|m| m.speed_rad_s).expect("a speed");
        let load = point.members.get(output).and_then(|m| m.torque_n_m).expect("a torque");
        let scenario = format!(
            "
[[scenario]]
name = \"held\"
duration = \"1 s\"

[[scenario.source]]
name = \"motor\"
member = \"{input}\"
speed = \"{speed:.17} rad/s\"

[[scenario.source]]
name = \"load\"
member = \"{output}\"
torque = \"{load:.17} N m\"
"
        );
        let (report, _) = run(&example(name, &(inertias + &scenario)), "held");
        compare(name, &point, &report);
    }
}

/// At a small load drags take their part, at a large one tooth friction grows with it.
#[test]
fn efficiency_depends_on_load() {
    let efficiency = |load: f64| run(&train(&held(load)), "held").0.energy.and_then(|e| e.efficiency).expect("steady");
    let [low, middle, high] = [-100.0, -1000.0, -7000.0].map(efficiency);
    assert!(low + 0.01 < middle && high + 0.001 < middle, "{low} {middle} {high}");
}

/// Between torques alone the train runs up to the operating point that has them.
#[test]
fn val_motion_settles_at_the_operating_point() {
    let point = solution(&train(""), "rated");
    let carrier = point.members.get("carrier").expect("a member");
    let (load, about) = (carrier.torque_n_m.expect("a torque"), carrier.speed_rad_s.expect("a speed"));
    let scenario = format!(
        "
[[scenario]]
name = \"settles\"
duration = \"2 s\"

[[scenario.source]]
member = \"sun\"
torque = \"1591.549 N m\"

[[scenario.source]]
member = \"carrier\"
linear = {{ torque = \"{load} N m\", slope = \"100 N m s/rad\", about = \"{about} rad/s\" }}
"
    );
    let (report, _) = run(&train(&scenario), "settles");
    let sun = report.final_speeds_rad_s.get("sun").copied().expect("a speed");
    close("speed", sun, 1500.0 * std::f64::consts::PI / 30.0, 1e-9);
}

/// Driven up from rest by a prescribed speed the losses begin with the motion.
#[test]
fn a_prescribed_speed_moves_off_from_rest() {
    let scenario = "
[[scenario]]
name = \"up\"
duration = \"2 s\"

[[scenario.source]]
member = \"sun\"
speed = { type = \"ramp\", height = \"1500 rpm\", at = \"0.5 s\", duration = \"1 s\" }

[[scenario.source]]
name = \"load\"
member = \"carrier\"
torque = \"-5000 N m\"
";
    let (report, last) = run(&train(scenario), "up");
    let (_, steady) = run(&train(&held(-5000.0)), "held");
    let lost: f64 = report.energy.as_ref().expect("counted").losses.iter().map(|l| l.energy_j).sum();
    assert!(lost > 1000.0, "{lost} J");
    // Speed, acceleration and torque of the end are those of steady motion; angles and energies are not.
    for k in [1, 2, 3, 7, 8, 9, 10, 11] {
        assert!((last[k] - steady[k]).abs() <= 1e-9 * steady[k].abs().max(1e-3), "{k}: {} {}", last[k], steady[k]);
    }
}

/// Run down from speed the train comes to rest under the torque of its seals and bearings, and stays.
#[test]
fn coasting_down_ends_at_rest() {
    let scenario = "
[[scenario]]
name = \"down\"
duration = \"60 s\"
initial_speeds = { sun = \"1500 rpm\" }
";
    let (report, _) = run(&train(scenario), "down");
    assert!(report.final_speeds_rad_s.iter().all(|(_, w)| *w == 0.0), "{:?}", report.final_speeds_rad_s);
    assert!(report.assumptions.iter().any(|a| a.contains("with oil of constant 80 °C")), "{:?}", report.assumptions);
}

#[test]
fn fixed_steps_refuse_laws() {
    let wrong = FixedStep::new(&train(&held(-5000.0)), "held", 1e-4).err().expect("refused");
    assert!(wrong.to_string().contains("follow laws"), "{wrong}");
}
