//! Instructions per point, counted by callgrind, against `benches/instructions.toml`: a regression
//! shows without a clock, the same on every run.
//!
//! Counts are those of the AVX2 (or narrower) code, since valgrind emulates no AVX-512.
//! `WILLIS_WRITE=1 cargo bench -p willis --bench gate` records new counts; say why in the commit.

mod trains;

use std::hint::black_box;
use std::path::Path;
use std::process::Command;

use willis::analysis::{Selection, analyze};
use willis::compiled::{
    BatchInputs, CompileRequest, CompiledOutput, CompiledTrain, GridInputs, OutputSummary, PowerLoss, ShaftDrag,
};
use willis::dynamics::{Batch, FixedStep, Options, Simulation, simulate};
use willis::model::Model;
use willis::regimes::{RegimeSelection, regimes};
use willis::study::{Axis, Hold, PointSetup, Sweep, UncertaintyRequest, sensitivity, uncertainty};
use willis::train::{SetSpec, Train};
use willis::work::Serial;

/// More than this above the recorded count fails.
const TOLERANCE: f64 = 0.05;

/// Name, points per repetition, and what is done so many times.
type Task = (&'static str, usize, fn(usize));

const TASKS: &[Task] = &[
    ("map-all", POINTS, map_all),
    ("map-efficiency", POINTS, map_efficiency),
    ("map-efficiency-f32", POINTS, map_efficiency_f32),
    ("map-reduced", POINTS, map_reduced),
    ("map-grid-efficiency", GRID, map_grid),
    ("map-grid-reduced", GRID, map_grid_reduced),
    ("study-map", STUDY, study_map),
    ("automatic-gear-1", POINTS, |n| automatic("1", false, n)),
    ("automatic-gear-3", POINTS, |n| automatic("3", false, n)),
    ("automatic-gear-5", POINTS, |n| automatic("5", false, n)),
    ("automatic-one-point", POINTS, |n| one_point(false, n)),
    ("automatic-load-gear-1", POINTS, |n| automatic("1", true, n)),
    ("automatic-load-gear-3", POINTS, |n| automatic("3", true, n)),
    ("automatic-load-gear-5", POINTS, |n| automatic("5", true, n)),
    ("automatic-load-one-point", POINTS, |n| one_point(true, n)),
    ("eight-speed-text-to-answer", 1, cold),
    ("nine-automatics-two-loss-levels", 1, nine_cold),
    ("eight-speed-compile-one-gear", 1, compile_one_gear),
    ("stage-one-point", 1, stage_one_point),
    ("physical-stage-sweep", SIDE * SIDE, physical_stage),
    ("physical-eight-speed-sweep", SIDE * SIDE, physical_eight_speed),
    ("stage-sensitivity", 1, stage_sensitivity),
    ("stage-uncertainty", SAMPLES, stage_uncertainty),
    ("regimes-longest", 1, regimes_longest),
    ("chain-analyze-4", 1, |n| chain_analyzed(4, n)),
    ("chain-analyze-64", 1, |n| chain_analyzed(64, n)),
    ("chain-regimes-4", 1, |n| chain_regimes(4, n)),
    ("chain-regimes-16", 1, |n| chain_regimes(16, n)),
    ("chain-simulate-4", 1, |n| chain_moved(4, n)),
    ("chain-simulate-64", 1, |n| chain_moved(64, n)),
    ("set-fixed-step", 20_000, |n| steps(&trains::set(), "pulses", 20_000, false, n)),
    ("set-fixed-step-audited", 20_000, |n| steps(&trains::set(), "pulses", 20_000, true, n)),
    ("automatic-fixed-step", 16_000, |n| steps(&trains::automatic(), "through the gears", 16_000, false, n)),
    ("automatic-fixed-step-audited", 16_000, |n| steps(&trains::automatic(), "through the gears", 16_000, true, n)),
    ("set-adaptive", 1, |n| adaptive(&trains::set(), "pulses", n)),
    ("automatic-adaptive", 1, |n| adaptive(&trains::automatic(), "through the gears", n)),
    ("set-adaptive-again", 1, |n| again(&trains::set(), "pulses", n)),
    ("automatic-adaptive-again", 1, |n| again(&trains::automatic(), "through the gears", n)),
    ("set-batch", RUNS * BATCH_STEPS, |n| batch(&trains::set(), "pulses", n)),
    ("automatic-batch", RUNS * BATCH_STEPS, |n| batch(&trains::automatic(), "through the gears", n)),
];

/// Points of one repetition.
const POINTS: usize = 4096;

/// Points of a grid of two speeds and 500 torques, and of the study of `benches/map.toml` with fewer speeds.
const GRID: usize = 4 * 2 * 500;
const STUDY: usize = 20 * 10 * 500;

/// Samples of what is uncertain.
const SAMPLES: usize = 128;

/// Values on each axis of a grid of points with computed losses.
const SIDE: usize = 32;

/// Runs of a batch, and their steps in one repetition: whole periods of the set, a gear of the automatic.
const RUNS: usize = 64;
const BATCH_STEPS: usize = 2000;

fn inputs(ranges: [(f64, f64); 3]) -> [Vec<f64>; 3] {
    let mut s = 88172645463325252u64;
    let mut next = || {
        s ^= s << 13;
        s ^= s >> 7;
        s ^= s << 17;
        (s >> 11) as f64 / (1u64 << 53) as f64
    };
    ranges.map(|(low, high)| (0..POINTS).map(|_| low + (high - low) * next()).collect())
}

fn power_split(outputs: &[CompiledOutput]) -> CompiledTrain {
    let train = Train::builder("power split")
        .members(["sun", "ring", "carrier"])
        .terminals(["sun", "ring", "carrier"])
        .set(SetSpec::simple("P1", ("sun", 30), ("ring", 70), "carrier").basic_efficiency(0.97515))
        .build()
        .unwrap();
    let drag = ShaftDrag { coulomb: 0.5, viscous: 1e-3 };
    let duty =
        CompileRequest::new(["sun", "carrier"], ["sun"]).drag("sun", drag).drag("ring", drag).drag("carrier", drag);
    train.compile(&outputs.iter().cloned().fold(duty, CompileRequest::output)).unwrap()
}

fn run(compiled: &CompiledTrain, speeds: &[&[f64]], torque: &[f64], times: usize) {
    let mut out = vec![vec![0.0; torque.len()]; compiled.outputs()];
    let mut slices: Vec<&mut [f64]> = out.iter_mut().map(|o| &mut o[..]).collect();
    let mut work = compiled.workspace();
    for _ in 0..times {
        compiled.evaluate_batch(&BatchInputs { speeds, torques: &[torque] }, &mut work, black_box(&mut slices));
    }
}

fn map_all(n: usize) {
    let [w0, w1, t] = inputs([(-400.0, 400.0), (-150.0, 150.0), (-200.0, 200.0)]);
    let outputs = [
        CompiledOutput::Torque("ring".into()),
        CompiledOutput::Torque("carrier".into()),
        CompiledOutput::Loss,
        CompiledOutput::Efficiency,
    ];
    run(&power_split(&outputs), &[&w0, &w1], &t, n);
}

fn map_reduced(n: usize) {
    let [w0, w1, t] = inputs([(-400.0, 400.0), (-150.0, 150.0), (-200.0, 200.0)]);
    let compiled = power_split(&[CompiledOutput::Efficiency]);
    let mut work = compiled.workspace();
    for _ in 0..n {
        let points = BatchInputs { speeds: &[&w0, &w1], torques: &[&t] };
        compiled.sum_batch(&points, &mut work, black_box(&mut [0.0]));
    }
}

/// The efficiency over a grid whose torques drive and coast; stored, or its sum and extremes.
fn over_grid(run: impl Fn(&CompiledTrain, &GridInputs<'_>)) {
    let torques: Vec<f64> = (0..500).map(|k| -100.0 + 0.8 * f64::from(k)).collect();
    let compiled = power_split(&[CompiledOutput::Efficiency]);
    let (sun, carrier) = ([-400.0, -100.0, 200.0, 300.0], [-150.0, 150.0]);
    run(&compiled, &GridInputs::new(&[&sun, &carrier], &[&torques]));
}

fn map_grid(n: usize) {
    over_grid(|compiled, grid| {
        let (mut work, mut out) = (compiled.workspace(), vec![0.0; GRID]);
        for _ in 0..n {
            compiled.evaluate_grid(grid, 0..GRID, &mut work, &mut [black_box(&mut out)]);
        }
    });
}

fn map_grid_reduced(n: usize) {
    over_grid(|compiled, grid| {
        let mut work = compiled.workspace();
        for _ in 0..n {
            compiled.summarize_grid(grid, 0..GRID, &mut work, black_box(&mut [OutputSummary::default()]));
        }
    });
}

/// The summary of a map as `sweep --fast` makes it.
fn study_map(n: usize) {
    let text = include_str!("../../../benches/map.toml");
    let model = Model::from_toml(text).unwrap();
    let over = ["sun.speed=-400..800 rad/s:20", "carrier.speed=-150.5..300 rad/s:10", "sun.torque=1..200 N m:500"];
    let setup = PointSetup::new(&model, None, None, Hold::AsGiven).unwrap();
    let axes = over.map(|axis| Axis::parse(axis, &model).unwrap()).to_vec();
    let sweep = Sweep::new(setup, axes, &[]).unwrap().compile().unwrap();
    for _ in 0..n {
        black_box(sweep.summary(0, STUDY as u64, &mut Default::default()));
    }
}

fn map_efficiency(n: usize) {
    let [w0, w1, t] = inputs([(-400.0, 400.0), (-150.0, 150.0), (-200.0, 200.0)]);
    run(&power_split(&[CompiledOutput::Efficiency]), &[&w0, &w1], &t, n);
}

fn map_efficiency_f32(n: usize) {
    let [w0, w1, t] = inputs([(-400.0, 400.0), (-150.0, 150.0), (-200.0, 200.0)]);
    let compiled = power_split(&[CompiledOutput::Efficiency]);
    let (mut work, mut out) = (compiled.workspace(), vec![0f32; t.len()]);
    for _ in 0..n {
        let points = BatchInputs { speeds: &[&w0, &w1], torques: &[&t] };
        compiled.evaluate_batch_f32(&points, &mut work, &mut [black_box(&mut out)]);
    }
}

fn eight_speed(gear: &str, by_load: bool) -> CompiledTrain {
    let train = Train::from_toml(include_str!("../../../examples/zf-8hp70.toml")).unwrap();
    let mut duty =
        CompileRequest::new(["input"], ["input"]).state(gear).output(CompiledOutput::Torque("output".into()));
    for m in ["input", "s12", "r1", "c1r4", "r2s3", "r3s4", "c3", "output"] {
        duty = duty.drag(m, ShaftDrag { coulomb: 0.2, viscous: 1e-3 });
    }
    let law = PowerLoss { coefficient: 0.02, exponent: 0.2, torque: 1.0, speed: 1.0, ..PowerLoss::default() };
    for s in 1..=4 {
        duty = duty.output(CompiledOutput::MeshTorque(format!("P{s}.sun-planet")));
        if by_load {
            duty = duty.mesh_loss(&format!("P{s}"), law);
        }
    }
    train.compile(&duty).unwrap()
}

fn automatic(gear: &str, by_load: bool, n: usize) {
    let [w, t, _] = inputs([(80.0, 500.0), (-100.0, 350.0), (0.0, 1.0)]);
    run(&eight_speed(gear, by_load), &[&w], &t, n);
}

fn one_point(by_load: bool, n: usize) {
    let [w, t, _] = inputs([(80.0, 500.0), (-100.0, 350.0), (0.0, 1.0)]);
    let compiled = eight_speed("3", by_load);
    let mut work = compiled.workspace();
    let mut out = vec![0.0; compiled.outputs()];
    for _ in 0..n {
        for (w, t) in w.iter().zip(&t) {
            compiled.evaluate(&[*w], &[*t], &mut work, black_box(&mut out));
        }
    }
}

fn cold(n: usize) {
    let text = include_str!("../../../examples/zf-8hp70.toml");
    for _ in 0..n {
        black_box(analyze(&Train::from_toml(black_box(text)).unwrap(), &Selection::default()).unwrap());
    }
}

fn nine_cold(n: usize) {
    let texts = trains::automatics();
    for text in (0..n).flat_map(|_| &texts) {
        black_box(analyze(&Train::from_toml(black_box(text)).unwrap(), &Selection::default()).unwrap());
    }
}

fn compile_one_gear(n: usize) {
    let train = Train::from_toml(include_str!("../../../examples/zf-8hp70.toml")).unwrap();
    let duty = CompileRequest::new(["input"], ["input"]).state("5").output(CompiledOutput::Efficiency);
    for _ in 0..n {
        black_box(train.compile(black_box(&duty)).unwrap());
    }
}

/// The rated point of the stage.
fn stage_one_point(n: usize) {
    let train = Train::from_toml(trains::STAGE).unwrap();
    let rated = Selection { operation: Some("rated".into()), ..Selection::default() };
    for _ in 0..n {
        black_box(analyze(black_box(&train), &rated).unwrap());
    }
}

/// A grid of speeds and torques as `sweep` answers it, losses by their laws.
fn physical(text: &str, over: [&str; 2], state: Option<&str>, n: usize) {
    let model = Model::from_toml(text).unwrap();
    for _ in 0..n {
        let question = PointSetup::new(&model, None, state, Hold::AsGiven).unwrap();
        let axes = over.map(|axis| Axis::parse(axis, &model).unwrap()).to_vec();
        let sweep = Sweep::new(question, axes, &[]).unwrap();
        black_box(sweep.rows(0, sweep.len(), &mut Default::default()));
    }
}

fn physical_stage(n: usize) {
    physical(trains::STAGE, ["sun.speed=100..3000 rpm:32", "sun.torque=50..1600 N m:32"], None, n);
}

/// An automatic with a drag on each shaft.
fn physical_eight_speed(n: usize) {
    let text = trains::automatic_with_drags();
    physical(&text, ["input.speed=1000..5000 rpm:32", "input.torque=50..700 N m:32"], Some("3"), n);
}

/// What the rated point of the stage is sensitive to.
fn stage_sensitivity(n: usize) {
    let train = Train::from_toml(trains::STAGE).unwrap();
    let rated = Selection { operation: Some("rated".into()), ..Selection::default() };
    for _ in 0..n {
        black_box(sensitivity(black_box(&train), &rated).unwrap());
    }
}

/// What is uncertain of the rated point of the stage.
fn stage_uncertainty(n: usize) {
    let model = Model::from_toml(trains::STAGE).unwrap();
    let request = UncertaintyRequest { operation: Some("rated".into()), samples: SAMPLES, ..Default::default() };
    for _ in 0..n {
        black_box(uncertainty(black_box(&model), &request, &Serial).unwrap());
    }
}

/// The regimes of the example that takes longest.
fn regimes_longest(n: usize) {
    let train = Train::from_toml(include_str!("../../../examples/voltec.toml")).unwrap();
    for _ in 0..n {
        black_box(regimes(black_box(&train), &RegimeSelection::default()).unwrap());
    }
}

/// Sets in series, from text to every answer of `analyze`.
fn chain_analyzed(sets: usize, n: usize) {
    let text = trains::chain(sets);
    for _ in 0..n {
        black_box(analyze(&Train::from_toml(black_box(&text)).unwrap(), &Selection::default()).unwrap());
    }
}

/// The regimes of sets in series, with their formulas.
fn chain_regimes(sets: usize, n: usize) {
    let train = Train::from_toml(&trains::chain(sets)).unwrap();
    for _ in 0..n {
        black_box(regimes(black_box(&train), &RegimeSelection::default()).unwrap());
    }
}

/// A second of sets in series, preparation included.
fn chain_moved(sets: usize, n: usize) {
    adaptive(&Train::from_toml(&trains::chain(sets)).unwrap(), "run up", n);
}

/// What is asked of so many sets, so many times.
type Chain = fn(usize, usize);

/// What is asked of sets in series.
const CHAINS: [(&str, Chain); 3] = [("analyze", chain_analyzed), ("regimes", chain_regimes), ("simulate", chain_moved)];

/// `chain-analyze-32` and the like.
fn chain(name: &str, times: usize) {
    let (what, sets) = name.strip_prefix("chain-").and_then(|rest| rest.split_once('-')).unwrap();
    let (_, run) = CHAINS.iter().find(|c| c.0 == what).unwrap();
    run(sets.parse().unwrap(), times);
}

/// Instructions over the number of sets in series, as CSV: `cargo bench -p willis --bench gate -- growth` records them in
/// `benches/growth.csv`, which the figure in the book shows.
fn growth() -> String {
    let mut text = format!("sets,{}\n", CHAINS.map(|c| c.0).join(","));
    for sets in [1, 2, 4, 8, 16, 32, 64] {
        let each = CHAINS.map(|(what, _)| {
            let of = |times| count(&format!("chain-{what}-{sets}"), times).expect("valgrind counts");
            format!("{:.0}", of(2) - of(1))
        });
        text += &format!("{sets},{}\n", each.join(","));
        println!("{sets}: {}", each.join(" "));
    }
    text
}

/// Whole runs in steps of 1 ms, modes known; with the energies counted or without.
fn steps(train: &Train, scenario: &str, steps: u64, audited: bool, n: usize) {
    let mut run = FixedStep::new(train, scenario, 1e-3).unwrap();
    run.without_angles();
    if audited {
        run.with_energies();
    }
    run.prepare_modes();
    for _ in 0..n {
        run.reset();
        run.run(black_box(steps));
    }
}

fn options() -> Options {
    Options { energies: false, tolerance: 1e-3, samples: Some(2), ..Options::default() }
}

/// By error control, from the train to the end of the run.
fn adaptive(train: &Train, scenario: &str, n: usize) {
    for _ in 0..n {
        black_box(simulate(black_box(train), scenario, &options(), &mut ()).unwrap());
    }
}

/// The run alone, modes known.
fn again(train: &Train, scenario: &str, n: usize) {
    let mut run = Simulation::new(train, scenario, &options()).unwrap();
    for _ in 0..n {
        run.advance(f64::INFINITY, &mut ());
        run = black_box(run.again().unwrap());
    }
}

fn batch(train: &Train, scenario: &str, n: usize) {
    let mut runs = Batch::new(train, scenario, 1e-3, RUNS).unwrap();
    for k in 0..RUNS {
        runs.scale(k, "engine", 1.0 + 0.0025 * k as f64).unwrap();
    }
    runs.run(black_box((n * BATCH_STEPS) as u64));
}

/// Instructions of this program running a task so many times.
fn count(task: &str, times: usize) -> Option<f64> {
    let own = std::env::current_exe().ok()?;
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(own)
        .args(["run", task, &times.to_string()])
        .output()
        .ok()?;
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    let line = text.lines().find(|l| l.contains("Collected :"))?;
    line.rsplit(':').next()?.trim().parse().ok()
}

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    if let Some(at) = arguments.iter().position(|a| a == "run") {
        let (name, times) = (&arguments[at + 1], arguments[at + 2].parse().unwrap());
        return match TASKS.iter().find(|t| t.0 == name) {
            Some(task) => (task.2)(times),
            None => chain(name, times),
        };
    }
    if !Command::new("valgrind").arg("--version").output().is_ok_and(|o| o.status.success()) {
        println!("skipped: valgrind is not installed");
        return;
    }
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../benches");
    if arguments.iter().any(|a| a == "growth") {
        return std::fs::write(folder.join("growth.csv"), growth()).unwrap();
    }
    let file = folder.join("instructions.toml");
    let recorded: toml::Table = std::fs::read_to_string(&file).unwrap_or_default().parse().unwrap();
    let write = std::env::var_os("WILLIS_WRITE").is_some();
    let mut text = String::from(
        "# Instructions per point (per train for text-to-answer, per step of motion), callgrind, no AVX-512.\n\
         # Written by `WILLIS_WRITE=1 cargo bench -p willis --bench gate`.\n",
    );
    let mut failed = false;
    for (name, points, _) in TASKS {
        let (Some(some), Some(more)) = (count(name, 2), count(name, 6)) else {
            println!("{name}: valgrind gave no count");
            failed = true;
            continue;
        };
        let each = (more - some) / (4 * points) as f64;
        text += &format!("{name} = {each:.1}\n");
        match recorded.get(*name).and_then(toml::Value::as_float) {
            _ if write => println!("{name:30} {each:12.1} recorded"),
            None => {
                println!("{name:30} {each:12.1} not recorded yet");
                failed = true;
            }
            Some(old) => {
                let change = each / old - 1.0;
                let bad = change > TOLERANCE;
                failed |= bad;
                let verdict = if bad { "MORE THAN RECORDED" } else { "ok" };
                println!("{name:30} {each:12.1} recorded {old:12.1} {:+6.1} % {verdict}", 100.0 * change);
            }
        }
    }
    if write {
        std::fs::write(file, text).unwrap();
    } else if failed {
        println!("if the growth is meant: WILLIS_WRITE=1 cargo bench -p willis --bench gate");
        std::process::exit(1);
    }
}
