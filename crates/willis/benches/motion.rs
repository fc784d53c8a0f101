//! Speed of motion: whole runs, steps of fixed length, batches, and the longest single step. `cargo xtask bench`
//! runs this beside `benches/baselines/motion.py`.
//!
//! A run that ends at another speed than the true one fails.

mod trains;

use std::fs;
use std::hint::black_box;
use std::io::Write;
use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use willis::dynamics::{Batch, FixedStep, Options, Recorder, Sample, Simulation, simulate};
use willis::train::Train;

/// Speeds at the end, rad/s: runs at tolerance 1e-12.
const SET_END: f64 = 13.158790432;
const AUTOMATIC_END: f64 = 81.486039;

/// Runs of a batch.
const RUNS: usize = 64;

fn record(task: &str, points: f64, sums: &[(&str, f64)]) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target/willis-bench");
    fs::create_dir_all(&folder).unwrap();
    let mut file = fs::OpenOptions::new().create(true).append(true).open(folder.join("checksums.jsonl")).unwrap();
    let sums: Vec<String> = sums.iter().map(|(k, v)| format!("\"{k}\": {v:?}")).collect();
    let sums = sums.join(", ");
    writeln!(file, "{{\"task\": \"{task}\", \"peer\": \"willis\", \"points\": {points}, \"checksum\": {{{sums}}}}}")
        .unwrap();
}

fn close(task: &str, value: f64, exact: f64, tolerance: f64) {
    let error = value / exact - 1.0;
    assert!(error.abs() <= tolerance, "{task}: ends at {value} rad/s, not at {exact} rad/s: {error:.1e}");
}

/// Keeps the last value of a column, whose name comes first.
struct Last(&'static str, usize, f64);

impl Recorder for Last {
    fn columns(&mut self, columns: &[willis::dynamics::Column]) -> ControlFlow<()> {
        self.1 = columns.iter().position(|c| c.name == self.0).unwrap();
        ControlFlow::Continue(())
    }
    fn sample(&mut self, sample: Sample<'_>) -> ControlFlow<()> {
        self.2 = sample.values[self.1];
        ControlFlow::Continue(())
    }
}

/// The whole call, preparation included, and the run alone when the modes are known; a point is a second of the scenario.
fn adaptive(c: &mut Criterion) {
    let options = Options { energies: false, tolerance: 1e-3, samples: Some(2), ..Options::default() };
    let mut group = c.benchmark_group("motion");
    let mut measure = |name: &str, train: &Train, scenario: &str, column: &'static str, duration: f64, exact: f64| {
        let task = format!("{name}-adaptive");
        let run = || {
            let mut last = Last(column, 0, f64::NAN);
            simulate(black_box(train), scenario, &options, &mut last).unwrap();
            last.2
        };
        let end = run();
        close(&task, end, exact, 1e-5);
        record(&task, duration, &[(column.trim_end_matches(".speed_rad_s"), end)]);
        group.sample_size(50).bench_function(&task, |b| b.iter(run));
        let task = format!("{task}-again");
        let member = column.trim_end_matches(".speed_rad_s");
        let mut prepared = Some(Simulation::new(train, scenario, &options).unwrap());
        let mut again = || {
            let mut run = prepared.take().expect("put back").again().unwrap();
            run.advance(f64::INFINITY, &mut ());
            let end = run.speed(member).unwrap();
            prepared = Some(run);
            end
        };
        again();
        let end = again();
        close(&task, end, exact, 1e-5);
        record(&task, duration, &[(member, end)]);
        group.bench_function(&task, |b| b.iter(&mut again));
    };
    measure("set", &trains::set(), "pulses", "carrier.speed_rad_s", 20.0, SET_END);
    measure("automatic", &trains::automatic(), "through the gears", "output.speed_rad_s", 16.0, AUTOMATIC_END);
    group.finish();
}

/// Step length, name, and how near the end of the automatic and of the set is to the true one.
const STEPS: [(f64, &str, [f64; 2]); 2] = [(1e-3, "1e-3", [1e-5, 1e-2]), (1e-4, "1e-4", [1e-6, 1e-3])];

/// A run in steps, modes known; speeds only, as in a batch, and with the energies counted.
fn fixed(c: &mut Criterion) {
    let mut group = c.benchmark_group("motion");
    group.sample_size(20);
    let mut measure = |name: &str, train: &Train, scenario: &str, member: &str, duration: f64, exact: f64, k: usize| {
        for (h, label, near) in STEPS {
            let steps = (duration / h).round();
            let task = format!("{name}-fixed-{label}");
            let mut run = FixedStep::new(train, scenario, h).unwrap();
            run.without_angles();
            run.prepare_modes();
            run.run(steps as u64);
            let end = run.speed(member).unwrap();
            println!("{task}: ends at {end} rad/s, relative error {:.1e}", end / exact - 1.0);
            close(&task, end, exact, near[k]);
            record(&task, steps, &[(member, end)]);
            group.throughput(Throughput::Elements(steps as u64));
            group.bench_function(&task, |b| {
                b.iter(|| {
                    run.reset();
                    run.run(black_box(steps as u64));
                });
            });
            run.with_energies();
            group.bench_function(format!("{task}-audited"), |b| {
                b.iter(|| {
                    run.reset();
                    run.run(black_box(steps as u64));
                });
            });
        }
    };
    measure("automatic", &trains::automatic(), "through the gears", "output", 16.0, AUTOMATIC_END, 0);
    measure("set", &trains::set(), "pulses", "carrier", 20.0, SET_END, 1);
    group.finish();
}

/// Runs side by side that differ in a torque; a point is a step of a run. Modes are met on the way.
fn batch(c: &mut Criterion) {
    let mut group = c.benchmark_group("motion");
    group.sample_size(20);
    let mut measure = |name: &str, train: &Train, scenario: &str, member: &str, steps: u64| {
        let new = || {
            let mut runs = Batch::new(train, scenario, 1e-3, RUNS).unwrap();
            for k in 0..RUNS {
                runs.scale(k, "engine", 1.0 + 0.0025 * k as f64).unwrap();
            }
            runs
        };
        let task = format!("{name}-batch");
        let mut runs = new();
        runs.run(steps);
        let each = |k: usize| runs.speed(k, member).unwrap();
        let sum: f64 = (0..RUNS).map(each).sum();
        let points = RUNS as u64 * steps;
        record(&task, points as f64, &[(member, sum)]);
        group.throughput(Throughput::Elements(points));
        group.bench_function(&task, |b| {
            b.iter_batched_ref(new, |runs| runs.run(black_box(steps)), criterion::BatchSize::PerIteration);
        });
    };
    measure("set", &trains::set(), "pulses", "carrier", 20_000);
    measure("automatic", &trains::automatic(), "through the gears", "output", 16_000);
    group.finish();
}

/// Seconds of each step of the automatic: the least of several runs, since a longer one was interrupted.
fn each_step(runs: usize, mut run: impl FnMut(&mut dyn FnMut(&mut FixedStep))) -> Vec<f64> {
    const STEPS: usize = 16_000;
    let mut least = vec![f64::INFINITY; STEPS];
    for _ in 0..runs {
        run(&mut |run: &mut FixedStep| {
            for least in &mut least {
                let start = Instant::now();
                run.step();
                *least = least.min(start.elapsed().as_secs_f64());
            }
        });
    }
    least
}

/// The longest step of the automatic, and the longest that meets a mode for the first time.
fn longest(_: &mut Criterion) {
    let timer = (0..100_000).map(|_| Instant::now().elapsed().as_secs_f64()).fold(f64::INFINITY, f64::min);
    let train = trains::automatic();
    let new = || FixedStep::new(&train, "through the gears", 1e-3).unwrap();
    let mut rehearsed = new();
    rehearsed.prepare_modes();
    let known = each_step(20, |all| {
        rehearsed.reset();
        all(&mut rehearsed);
    });
    let first = each_step(20, |all| all(&mut new()));
    let ns = |x: f64| 1e9 * (x - timer);
    let median = |x: &[f64]| {
        let mut x = x.to_vec();
        x.sort_by(f64::total_cmp);
        x[x.len() / 2]
    };
    let worst = |x: &[f64]| x.iter().copied().fold(0.0, f64::max);
    let at = |x: &[f64]| x.iter().position(|t| *t == worst(x)).unwrap_or(0);
    println!("the longest steps begin at {} ms, first {} ms", at(&known), at(&first));
    let mut order: Vec<usize> = (0..known.len()).collect();
    order.sort_by(|a, b| known[*b].total_cmp(&known[*a]));
    let longest: Vec<String> = order[..8].iter().map(|k| format!("{k} ms {:.0} ns", ns(known[*k]))).collect();
    println!("the longest of known modes: {}", longest.join(", "));
    let sums = [
        ("longest_ns", ns(worst(&known))),
        ("median_ns", ns(median(&known))),
        ("first_ns", ns(worst(&first))),
        ("timer_ns", 1e9 * timer),
        ("seconds", worst(&known) - timer),
        // The least of twenty runs, step by step.
        ("spread", 0.0),
    ];
    record("automatic-longest-step", 16_000.0, &sums);
    println!("automatic-longest-step: {sums:.0?}");
}

criterion_group!(benches, adaptive, fixed, batch, longest);
criterion_main!(benches);
