//! Speed of whole answers: from text to answer, points with computed losses, sensitivity, uncertainty, regimes, and how all
//! grow with the number of sets. With the allocator of the program; `cargo xtask bench` runs this.

mod trains;

use std::fs;
use std::hint::black_box;
use std::io::Write;
use std::path::Path;
use std::time::Instant;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use willis::analysis::{Selection, analyze, operate};
use willis::compiled::{CompileRequest, CompiledOutput};
use willis::dynamics::{Batch, FixedStep, Options, simulate};
use willis::model::Model;
use willis::regimes::{RegimeSelection, regimes};
use willis::study::{Axis, Hold, PointSetup, Sweep, UncertaintyRequest, sensitivity, uncertainty};
use willis::train::Train;
use willis::work::Serial;

#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

/// Values on each axis of a grid of points with computed losses.
const SIDE: usize = 64;

/// Runs of a large batch.
const RUNS: usize = 1000;

/// What was measured beside criterion, in the format of its results: a task, and seconds.
fn record(task: &str, sums: &[(&str, f64)]) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target/willis-bench");
    fs::create_dir_all(&folder).unwrap();
    let mut file = fs::OpenOptions::new().create(true).append(true).open(folder.join("checksums.jsonl")).unwrap();
    let sums: Vec<String> = sums.iter().map(|(k, v)| format!("\"{k}\": {v:?}")).collect();
    let sums = sums.join(", ");
    writeln!(file, "{{\"task\": \"{task}\", \"peer\": \"willis\", \"points\": 1, \"checksum\": {{{sums}}}}}").unwrap();
}

/// Seconds of the shortest of several calls, and how much longer the middle one took.
fn shortest(times: usize, mut run: impl FnMut()) -> (f64, f64) {
    run();
    let mut all: Vec<f64> = (0..times)
        .map(|_| {
            let start = Instant::now();
            run();
            start.elapsed().as_secs_f64()
        })
        .collect();
    all.sort_by(f64::total_cmp);
    (all[0], all[times / 2] / all[0] - 1.0)
}

/// Points whose losses follow from speeds and loads by their laws.
fn physical(c: &mut Criterion) {
    let mut group = c.benchmark_group("answers");
    group.sample_size(10).throughput(Throughput::Elements((SIDE * SIDE) as u64));
    let drags = trains::automatic_with_drags();
    let cases = [
        ("physical-stage", trains::STAGE, ["sun.speed=100..3000 rpm", "sun.torque=50..1600 N m"], None),
        ("physical-eight-speed", &drags, ["input.speed=1000..5000 rpm", "input.torque=50..700 N m"], Some("3")),
    ];
    for (name, text, over, state) in cases {
        let model = Model::from_toml(text).unwrap();
        let sweep = || {
            let question = PointSetup::new(&model, None, state, Hold::AsGiven).unwrap();
            let axes = over.map(|axis| Axis::parse(&format!("{axis}:{SIDE}"), &model).unwrap()).to_vec();
            Sweep::new(question, axes, &[]).unwrap()
        };
        group.bench_function(name, |b| {
            b.iter(|| {
                let sweep = sweep();
                black_box(sweep.rows(0, sweep.len(), &mut Default::default()))
            });
        });
    }
    group.finish();
}

/// One operating point of the stage, its sensitivity to everything given, and 4,096 samples of what is uncertain.
fn sure(c: &mut Criterion) {
    let mut group = c.benchmark_group("answers");
    let model = Model::from_toml(trains::STAGE).unwrap();
    let train = model.train().clone();
    let operation = train.operations().iter().find(|o| o.name == "rated").unwrap().clone();
    let rated = Selection { operation: Some("rated".into()), ..Selection::default() };
    group.bench_function("stage-analysis", |b| b.iter(|| analyze(black_box(&train), &rated).unwrap()));
    group.bench_function("stage-one-point", |b| b.iter(|| operate(black_box(&train), &operation).unwrap()));
    group.bench_function("stage-sensitivity", |b| b.iter(|| sensitivity(black_box(&train), &rated).unwrap()));
    let request = UncertaintyRequest { operation: Some("rated".into()), samples: 4096, ..Default::default() };
    group.sample_size(10);
    group.bench_function("stage-uncertainty", |b| b.iter(|| uncertainty(&model, &request, &Serial).unwrap()));
    group.finish();
}

/// The example whose regimes take longest.
fn all_regimes(_: &mut Criterion) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let mut longest = (0.0, 0.0, String::new());
    let mut files: Vec<_> = fs::read_dir(folder).unwrap().map(|f| f.unwrap().path()).collect();
    files.sort();
    for file in files.iter().filter(|f| f.extension().is_some_and(|e| e == "toml")) {
        let Ok(model) = Model::from_toml(&fs::read_to_string(file).unwrap()) else { continue };
        let train = model.train();
        if regimes(train, &RegimeSelection::default()).is_err() {
            continue;
        }
        let (seconds, spread) = shortest(5, || {
            black_box(regimes(train, &RegimeSelection::default()).unwrap());
        });
        if seconds > longest.0 {
            longest = (seconds, spread, file.file_stem().unwrap().to_string_lossy().into_owned());
        }
    }
    println!("regimes: longest {:.2} ms, {}", 1e3 * longest.0, longest.2);
    record("regimes-longest", &[("seconds", longest.0), ("spread", longest.1)]);
}

/// A thousand runs side by side, and one after the other.
fn batches(_: &mut Criterion) {
    for (name, train, scenario, steps) in
        [("set", trains::set(), "pulses", 2000u64), ("automatic", trains::automatic(), "through the gears", 2000)]
    {
        let mut one = FixedStep::new(&train, scenario, 1e-3).unwrap();
        one.without_angles();
        one.prepare_modes();
        let (alone, alone_spread) = shortest(15, || {
            one.reset();
            one.run(black_box(steps));
        });
        let new = || {
            let mut runs = Batch::new(&train, scenario, 1e-3, RUNS).unwrap();
            for k in 0..RUNS {
                runs.scale(k, "engine", 1.0 + 1e-4 * k as f64).unwrap();
            }
            runs
        };
        let mut all: Vec<f64> = (0..5)
            .map(|_| {
                let mut runs = new();
                let start = Instant::now();
                runs.run(black_box(steps));
                start.elapsed().as_secs_f64()
            })
            .collect();
        all.sort_by(f64::total_cmp);
        let spread = (all[2] / all[0] - 1.0).max(alone_spread);
        let times = alone * RUNS as f64 / all[0];
        println!("{name}: a batch of {RUNS} is {times:.1} times as fast as runs one after the other");
        record(&format!("{name}-thousand"), &[("ratio", times), ("spread", spread)]);
    }
}

/// Sets in series.
fn growth(_: &mut Criterion) {
    let options = Options { energies: false, samples: Some(2), ..Options::default() };
    for sets in [1, 2, 4, 8, 16, 32, 64] {
        let text = trains::chain(sets);
        let train = Train::from_toml(&text).unwrap();
        let analyzed = shortest(5, || {
            black_box(analyze(&Train::from_toml(&text).unwrap(), &Selection::default()).unwrap());
        });
        let listed = shortest(3, || {
            black_box(regimes(&train, &RegimeSelection::default()).unwrap());
        });
        let moved = shortest(3, || {
            black_box(simulate(&train, "run up", &options, &mut ()).unwrap());
        });
        println!("{sets} sets: {:.3e} {:.3e} {:.3e} s", analyzed.0, listed.0, moved.0);
        for (what, (seconds, spread)) in [("analyze", analyzed), ("regimes", listed), ("simulate", moved)] {
            record(&format!("chain-{what}-{sets}"), &[("seconds", seconds), ("spread", spread)]);
        }
    }
}

/// From text to every ratio and efficiency, driving and coasting, of every gear.
fn cold(c: &mut Criterion) {
    let mut group = c.benchmark_group("cold");
    let text = include_str!("../../../examples/zf-8hp70.toml");
    group.bench_function("eight-speed-text-to-answer", |b| {
        b.iter(|| analyze(&Train::from_toml(black_box(text)).unwrap(), &Selection::default()).unwrap());
    });
    let texts = trains::automatics();
    group.bench_function("nine-automatics-two-loss-levels", |b| {
        b.iter(|| {
            for text in &texts {
                black_box(analyze(&Train::from_toml(text).unwrap(), &Selection::default()).unwrap());
            }
        });
    });
    let duty = CompileRequest::new(["input"], ["input"]).state("5").output(CompiledOutput::Efficiency);
    let train = Train::from_toml(text).unwrap();
    group.bench_function("eight-speed-compile-one-gear", |b| b.iter(|| train.compile(black_box(&duty)).unwrap()));
    group.finish();
}

criterion_group!(benches, cold, physical, sure, all_regimes, batches, growth);
criterion_main!(benches);
