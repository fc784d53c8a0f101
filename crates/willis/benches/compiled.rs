//! Speed of the compiled train, and nothing else. `cargo xtask bench` runs this
//! beside the Python baselines of `benches/baselines/` and prints ratios.
//!
//! Checksums go to `target/willis-bench/checksums.jsonl` in the baselines' format, so that a ratio
//! is only printed between programs that agree.

use std::fs;
use std::hint::black_box;
use std::io::Write;
use std::path::Path;
use std::time::Instant;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use willis::compiled::{
    BatchInputs, CompileRequest, CompiledOutput, CompiledTrain, GridInputs, OutputSummary, PowerLoss, ShaftDrag,
};
use willis::train::{SetSpec, Train};

fn points(default: usize) -> usize {
    std::env::var("WILLIS_BENCH_POINTS").ok().and_then(|p| p.parse().ok()).unwrap_or(default)
}

/// xorshift64 of Marsaglia (2003), as in `benches/baselines/common.py`.
struct Xorshift(u64);

impl Xorshift {
    fn new() -> Self {
        Self(88172645463325252)
    }
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

fn record(task: &str, sums: &[(&str, f64)], points: usize) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target/willis-bench");
    fs::create_dir_all(&folder).unwrap();
    let mut file = fs::OpenOptions::new().create(true).append(true).open(folder.join("checksums.jsonl")).unwrap();
    let sums: Vec<String> = sums.iter().map(|(k, v)| format!("\"{k}\": {v:?}")).collect();
    writeln!(
        file,
        "{{\"task\": \"{task}\", \"peer\": \"willis\", \"points\": {points}, \"checksum\": {{{}}}}}",
        sums.join(", ")
    )
    .unwrap();
}

/// Pairwise, so that sums that nearly cancel can be compared.
fn sum(x: &[f64]) -> f64 {
    if x.len() <= 128 { x.iter().sum() } else { sum(&x[..x.len() / 2]) + sum(&x[x.len() / 2..]) }
}

fn power_split(outputs: &[CompiledOutput]) -> CompiledTrain {
    let train = Train::builder("power split")
        .members(["sun", "ring", "carrier"])
        .terminals(["sun", "ring", "carrier"])
        .set(SetSpec::simple("P1", ("sun", 30), ("ring", 70), "carrier").basic_efficiency(0.97515))
        .build()
        .unwrap();
    let mut duty = CompileRequest::new(["sun", "carrier"], ["sun"]);
    for (m, coulomb, viscous) in [("sun", 0.4, 1e-3), ("ring", 0.8, 2e-3), ("carrier", 0.6, 1.5e-3)] {
        duty = duty.drag(m, ShaftDrag { coulomb, viscous });
    }
    for o in outputs {
        duty = duty.output(o.clone());
    }
    train.compile(&duty).unwrap()
}

/// Points a second, from the shortest of several times, and how much longer the middle one took.
fn fastest(points: usize, mut work: impl FnMut()) -> (f64, f64) {
    let mut seconds = [0.0; 15].map(|_: f64| {
        let start = Instant::now();
        work();
        start.elapsed().as_secs_f64()
    });
    seconds.sort_by(f64::total_cmp);
    (points as f64 / seconds[0], seconds[seconds.len() / 2] / seconds[0] - 1.0)
}

/// Points whose inputs and results stay in the cache.
const FEW: usize = 4096;

/// What a task that reads three arrays comes to where the memory is not waited for: the same on few points.
fn in_the_cache(
    task: &str,
    input: &BatchInputs<'_>,
    out: &mut [&mut [f64]],
    mut run: impl FnMut(&BatchInputs<'_>, &mut [&mut [f64]]),
) {
    const ROUNDS: usize = 200;
    let n = input.torques[0].len().min(FEW);
    let (speeds, torques) = ([&input.speeds[0][..n], &input.speeds[1][..n]], [&input.torques[0][..n]]);
    let few = BatchInputs { speeds: &speeds, torques: &torques };
    let mut out: Vec<&mut [f64]> = out.iter_mut().map(|o| &mut o[..n]).collect();
    let (rate, spread) = fastest(ROUNDS * n, || (0..ROUNDS).for_each(|_| run(black_box(&few), &mut out)));
    record(&format!("{task}-cached"), &[("points_per_s", rate), ("spread", spread)], n);
}

fn map(c: &mut Criterion) {
    let n = points(10_000_000);
    let mut random = Xorshift::new();
    let (mut ws, mut wc, mut ts) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
    for i in 0..n {
        ws[i] = random.next() * 800.0 - 400.0;
        wc[i] = random.next() * 300.0 - 150.0;
        ts[i] = random.next() * 400.0 - 200.0;
    }
    let (speeds, torques): ([&[f64]; 2], [&[f64]; 1]) = ([&ws, &wc], [&ts]);
    let input = BatchInputs { speeds: &speeds, torques: &torques };
    let mut group = c.benchmark_group("map");
    group.throughput(Throughput::Elements(n as u64)).sample_size(10);

    let all = power_split(&[
        CompiledOutput::Torque("ring".into()),
        CompiledOutput::Torque("carrier".into()),
        CompiledOutput::Loss,
        CompiledOutput::Efficiency,
    ]);
    let mut work = all.workspace();
    let mut out = vec![vec![0.5; n]; 4];
    let mut slices: Vec<&mut [f64]> = out.iter_mut().map(|o| &mut o[..]).collect();
    group.bench_function("map-all", |b| b.iter(|| all.evaluate_batch(&input, &mut work, &mut slices)));
    let names = ["torque_ring", "torque_carrier", "loss", "efficiency"];
    record("map-all", &names.iter().zip(&slices).map(|(k, o)| (*k, sum(o))).collect::<Vec<_>>(), n);
    in_the_cache("map-all", &input, &mut slices, |few, out| {
        black_box(all.evaluate_batch(few, &mut work, out));
    });

    let efficiency = power_split(&[CompiledOutput::Efficiency]);
    let mut work = efficiency.workspace();
    let [e, ..] = &mut out[..] else { unreachable!() };
    group.bench_function("map-efficiency", |b| {
        b.iter(|| efficiency.evaluate_batch(&input, &mut work, &mut [&mut e[..]]));
    });
    record("map-efficiency", &[("efficiency", sum(e))], n);
    in_the_cache("map-efficiency", &input, &mut [&mut e[..]], |few, out| {
        black_box(efficiency.evaluate_batch(few, &mut work, out));
    });
    let mut single = vec![0.5f32; n];
    group.bench_function("map-efficiency-f32", |b| {
        b.iter(|| efficiency.evaluate_batch_f32(&input, &mut work, &mut [&mut single[..]]));
    });
    let mut sums = [0.0];
    group.bench_function("map-reduced", |b| b.iter(|| efficiency.sum_batch(&input, &mut work, black_box(&mut sums))));
    record("map-reduced", &[("efficiency", sums[0])], n);
    in_the_cache("map-reduced", &input, &mut [], |few, _| {
        black_box(efficiency.sum_batch(few, &mut work, &mut sums));
    });

    // From a grid: nothing is read, and where a sum is wanted nothing is written.
    let axis = |low: f64, high: f64, n: usize| -> Vec<f64> {
        (0..n).map(|k| low + (high - low) * k as f64 / (n - 1) as f64).collect()
    };
    let (ws, wc, ts) = (axis(-400.0, 400.0, n.div_ceil(50_000)), axis(-150.5, 150.0, 100), axis(-200.0, 200.0, 500));
    let (speeds, torques): ([&[f64]; 2], [&[f64]; 1]) = ([&ws, &wc], [&ts]);
    let grid = GridInputs::new(&speeds, &torques);
    let mut e = vec![0.5; grid.len()];
    group.throughput(Throughput::Elements(grid.len() as u64));
    group.bench_function("map-grid-efficiency", |b| {
        b.iter(|| efficiency.evaluate_grid(&grid, 0..grid.len(), &mut work, &mut [&mut e[..]]));
    });
    record("map-grid-efficiency", &[("efficiency", sum(&e))], grid.len());
    let mut all = [OutputSummary::default()];
    group.bench_function("map-grid-reduced", |b| {
        b.iter(|| efficiency.summarize_grid(&grid, 0..grid.len(), &mut work, black_box(&mut all)));
    });
    record("map-grid-reduced", &[("efficiency", all[0].sum)], grid.len());
    group.finish();
}

fn eight_speed() -> Train {
    let text = include_str!("../../../examples/zf-8hp70.toml")
        .replace("mesh_efficiency = { external = 0.98, internal = 0.99 }", "basic_efficiency = 0.97515");
    Train::from_toml(&text).unwrap()
}

fn automatic(c: &mut Criterion) {
    // As many as the baseline was measured with: results stay in the last-level cache.
    let n = points(100_000);
    let mut random = Xorshift::new();
    let (mut w, mut t) = (vec![0.0; n], vec![0.0; n]);
    for i in 0..n {
        w[i] = 80.0 + random.next() * 420.0;
        t[i] = -100.0 + random.next() * 450.0;
    }
    let (speeds, torques): ([&[f64]; 1], [&[f64]; 1]) = ([&w], [&t]);
    let input = BatchInputs { speeds: &speeds, torques: &torques };
    let train = eight_speed();
    let mut group = c.benchmark_group("automatic");
    group.sample_size(20);
    for (gear, elements) in [("1", "ABC"), ("3", "BCE"), ("5", "BCD")] {
        let mut duty = CompileRequest::new(["input"], ["input"]).state(gear);
        for m in ["input", "s12", "r1", "c1r4", "r2s3", "r3s4", "c3", "output"] {
            duty = duty.drag(m, ShaftDrag { coulomb: 0.2, viscous: 1e-3 });
        }
        for s in 1..=4 {
            duty = duty.output(CompiledOutput::MeshTorque(format!("P{s}.sun-planet")));
        }
        for e in elements.chars() {
            duty = duty.output(CompiledOutput::ShiftElementTorque(e.to_string()));
        }
        let duty = duty.output(CompiledOutput::Torque("output".into()));
        let law = PowerLoss { coefficient: 0.02, exponent: 0.2, torque: 1.0, speed: 1.0, ..PowerLoss::default() };
        let by_load = (1..=4).fold(duty.clone(), |d, s| d.mesh_loss(&format!("P{s}"), law));
        for (duty, name) in [(duty, "automatic"), (by_load, "automatic-load")] {
            let compiled = train.compile(&duty).unwrap();
            let mut work = compiled.workspace();
            let mut out = vec![vec![0.5; n]; 8];
            let mut slices: Vec<&mut [f64]> = out.iter_mut().map(|o| &mut o[..]).collect();
            let task = format!("{name}-gear-{gear}");
            group.throughput(Throughput::Elements(n as u64));
            group.bench_function(&task, |b| b.iter(|| compiled.evaluate_batch(&input, &mut work, &mut slices)));
            let all: f64 = out.iter().map(|o| sum(o)).sum();
            record(&task, &[("torque_out", sum(&out[7])), ("torque_all", all)], n);
            if gear == "3" {
                let mut one = [0.0; 8];
                let mut i = 0;
                group.throughput(Throughput::Elements(1));
                group.bench_function(format!("{name}-one-point"), |b| {
                    b.iter(|| {
                        i = (i + 1) % n;
                        compiled.evaluate(&[w[i]], &[t[i]], &mut work, &mut one)
                    });
                });
            }
        }
    }
    group.finish();
}

/// Every gear of two automatics with drag on the named shafts: torques of all first gears of meshes, of the engaged
/// elements and at the output. In the last-level cache, and beyond it. What the slowest gear reaches is recorded.
fn gears(_: &mut Criterion) {
    const SIZES: [(usize, &str); 2] = [(100_000, "1e5"), (1_000_000, "1e6")];
    for (name, text) in [
        ("8hp70", include_str!("../../../examples/zf-8hp70.toml")),
        ("10r80", include_str!("../../../examples/ford-10r80.toml")),
    ] {
        let train = Train::from_toml(text).unwrap();
        let [input, output] = [train.input(), train.output()].map(|m| train.member_name(m.unwrap()).to_owned());
        let mut slowest = SIZES.map(|_| (f64::INFINITY, 0.0, 0));
        for state in train.states() {
            let request = CompileRequest::new([input.as_str()], [input.as_str()]).state(&state.name);
            let mut request = request.output(CompiledOutput::Torque(output.clone()));
            // What this gear does not determine is left out.
            let compiles = |more: &CompileRequest| train.compile(more).is_ok();
            // The first member is the frame, on which no shaft turns.
            let turning = &train.members()[1..];
            for member in turning {
                let more = request.clone().drag(&member.name, ShaftDrag { coulomb: 0.2, viscous: 1e-3 });
                request = if compiles(&more) { more } else { request };
            }
            let meshes = train.meshes().iter().map(|m| CompiledOutput::MeshTorque(m.name.clone()));
            let engaged = state.engaged.iter().map(|e| train.shift_elements()[e.index()].name.clone());
            for output in meshes.chain(engaged.map(CompiledOutput::ShiftElementTorque)) {
                let more = request.clone().output(output);
                request = if compiles(&more) { more } else { request };
            }
            let compiled = train.compile(&request).unwrap();
            let mut work = compiled.workspace();
            for ((n, size), slowest) in SIZES.into_iter().zip(&mut slowest) {
                let mut random = Xorshift::new();
                let (w, t): (Vec<f64>, Vec<f64>) =
                    (0..n).map(|_| (80.0 + random.next() * 420.0, -100.0 + random.next() * 450.0)).unzip();
                let (speeds, torques): ([&[f64]; 1], [&[f64]; 1]) = ([&w], [&t]);
                let input = BatchInputs { speeds: &speeds, torques: &torques };
                let mut out = vec![vec![0.5; n]; compiled.outputs()];
                let mut slices: Vec<&mut [f64]> = out.iter_mut().map(|o| &mut o[..]).collect();
                let calls = 4_000_000 / n;
                let rate = fastest(calls * n, || {
                    for _ in 0..calls {
                        black_box(compiled.evaluate_batch(black_box(&input), &mut work, &mut slices));
                    }
                });
                println!("{name}, gear {}, {size} points: {:.3e} points/s", state.name, rate.0);
                if rate.0 < slowest.0 {
                    *slowest = (rate.0, rate.1, compiled.outputs());
                }
            }
        }
        for ((points, size), (rate, spread, results)) in SIZES.into_iter().zip(slowest) {
            let sums = [("points_per_s", rate), ("spread", spread), ("results", results as f64)];
            record(&format!("gears-{name}-{size}"), &sums, points);
        }
    }
}

criterion_group!(benches, map, automatic, gears);
criterion_main!(benches);
