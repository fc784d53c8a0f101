//! A compiled train gives the answers of the analysis, one point or many, and allocates nothing.

use allocation_counter::measure;
use willis::analysis::{Selection, Verdict, analyze};
use willis::compiled::{
    BatchInputs, CompileRequest, CompiledOutput, CompiledTrain, GridInputs, OutputSummary, PointVerdict, PowerLoss,
    ShaftDrag,
};
use willis::diagnostic::Code;
use willis::train::{OperationSpec, SetSpec, Specification, Train};
use willis::units::{AngularSpeed, Torque};

use crate::common::{self, Uniform};

fn power_split() -> Specification {
    Train::builder("power split")
        .members(["sun", "ring", "carrier"])
        .terminals(["sun", "ring", "carrier"])
        .set(SetSpec::simple("P1", ("sun", 30), ("ring", 70), "carrier").mesh_efficiency(0.985))
}

/// Two coupled sets with two freedoms and three terminals: sign patterns change with the speeds.
fn compound_split() -> Specification {
    Train::builder("compound split")
        .members(["a", "b", "c", "d"])
        .terminals(["a", "b", "d"])
        .set(SetSpec::simple("P1", ("a", 30), ("b", 78), "c").mesh_efficiency(0.98))
        .set(SetSpec::simple("P2", ("b", 31), ("c", 83), "d").mesh_efficiency(0.97))
}

#[test]
fn compiled_equals_analysis_with_two_freedoms() {
    let mut random = Uniform(1);
    for (builder, speeds, torque, open) in [
        (power_split(), ["sun", "carrier"], "sun", ["ring", "carrier"]),
        (power_split(), ["carrier", "ring"], "ring", ["sun", "carrier"]),
        (power_split(), ["sun", "ring"], "carrier", ["sun", "ring"]),
        (compound_split(), ["a", "d"], "a", ["b", "d"]),
    ] {
        let duty = CompileRequest::new(speeds, [torque])
            .output(CompiledOutput::Torque(open[0].into()))
            .output(CompiledOutput::Torque(open[1].into()))
            .output(CompiledOutput::Loss)
            .output(CompiledOutput::Efficiency)
            .output(CompiledOutput::Speed(open[0].into()));
        let compiled = builder.clone().build().unwrap().compile(&duty).unwrap();
        let mut work = compiled.workspace();
        for k in 0..300 {
            let w = match k % 10 {
                // At rest relative to each other, one at rest, all at rest but one.
                0 => [70.0, 70.0],
                1 => [0.0, random.between(-50.0, 50.0).round()],
                _ => [random.between(-400.0, 400.0).round(), random.between(-150.0, 150.0).round()],
            };
            let t = if k == 7 { 0.0 } else { random.between(-200.0, 200.0).round() };
            let train = builder
                .clone()
                .operation(
                    OperationSpec::new("x")
                        .speed(speeds[0], AngularSpeed::rad_s(w[0]))
                        .speed(speeds[1], AngularSpeed::rad_s(w[1]))
                        .torque(torque, Torque::n_m(t)),
                )
                .build()
                .unwrap();
            let a = analyze(&train, &Selection::default()).unwrap();
            let o = &a.operations[0];
            let mut out = [0.0; 5];
            let verdict = compiled.evaluate(&w, &[t], &mut work, &mut out);
            assert_eq!(verdict, PointVerdict::Unique);
            let s = &o.solutions[0];
            let member = |name: &str| s.members.get(name).unwrap();
            let close =
                |x: f64, y: f64, size: f64| assert!((x - y).abs() <= 1e-11 * size.max(1e-9), "{w:?} {t}: {x} {y}");
            close(out[0], member(open[0]).torque_n_m.unwrap(), 1e3);
            close(out[1], member(open[1]).torque_n_m.unwrap(), 1e3);
            close(out[2], s.loss_w, 1e5);
            // Balanced to nothing by round-off: no efficiency to compare.
            if s.input_power_w > 1e-6 {
                close(out[3], s.efficiency.unwrap(), 1.0);
            }
            close(out[4], member(open[0]).speed_rad_s.unwrap(), 1e3);
        }
    }
}

#[test]
fn compiled_equals_analysis_in_every_gear() {
    let mut random = Uniform(2);
    for name in ["zf-8hp70", "zf-6hp26", "ford-10r80", "mercedes-9g-tronic", "ford-aod", "simpson-ford-c4"] {
        let train = common::train(name);
        let input = train.member_name(train.input().unwrap()).to_owned();
        let output = train.member_name(train.output().unwrap()).to_owned();
        for state in train.states() {
            let mut duty = CompileRequest::new([input.as_str()], [input.as_str()])
                .state(&state.name)
                .output(CompiledOutput::Torque(output.clone()))
                .output(CompiledOutput::Efficiency);
            let elements: Vec<String> =
                state.engaged.iter().map(|e| train.shift_elements()[e.index()].name.clone()).collect();
            for e in &elements {
                duty = duty.output(CompiledOutput::ShiftElementTorque(e.clone()));
            }
            let compiled = train.compile(&duty).unwrap();
            assert!(compiled.is_certified());
            let mut work = compiled.workspace();
            let mut out = vec![0.0; compiled.outputs()];
            for _ in 0..4 {
                let (w, t) = (random.between(50.0, 500.0).round(), random.between(-200.0, 400.0).round());
                let text = common::example(name);
                let text = format!(
                    "{text}\n[[operation]]\nname = \"one more\"\nstate = \"{}\"\nspeeds = {{ {input} = \"{w} rad/s\" }}\ntorques = {{ {input} = \"{t} N m\" }}\n",
                    state.name
                );
                let selection = Selection { operation: Some("one more".into()), ..Selection::default() };
                let a = analyze(&Train::from_toml(&text).unwrap(), &selection).unwrap();
                let s = &a.operations[0].solutions[0];
                compiled.evaluate(&[w], &[t], &mut work, &mut out);
                let close = |x: f64, y: f64| {
                    assert!((x - y).abs() <= 1e-9 * y.abs().max(1.0), "{name} {}: {x} {y}", state.name)
                };
                close(out[0], s.members.get(&output).unwrap().torque_n_m.unwrap());
                close(out[1], s.efficiency.unwrap());
                for (k, e) in elements.iter().enumerate() {
                    if let Some(torque) = s.shift_elements.get(e).unwrap().torque_n_m {
                        close(out[2 + k], torque);
                    } else {
                        assert!(out[2 + k].is_nan());
                    }
                }
            }
        }
    }
}

fn with_drag(duty: CompileRequest, members: &[&str]) -> CompileRequest {
    members
        .iter()
        .enumerate()
        .fold(duty, |d, (k, m)| d.drag(m, ShaftDrag { coulomb: 0.2 + 0.1 * k as f64, viscous: 1e-3 * (k + 1) as f64 }))
}

#[test]
fn a_batch_equals_its_points() {
    let n = 5000;
    let mut random = Uniform(3);
    let column = |low: f64, high: f64, random: &mut Uniform| -> Vec<f64> {
        (0..n).map(|i| if i % 97 == 0 { 0.0 } else { random.between(low, high) }).collect()
    };
    let (w0, w1, t) =
        (column(-400.0, 400.0, &mut random), column(-150.0, 150.0, &mut random), column(-200.0, 200.0, &mut random));
    let eight = common::train("zf-8hp70");
    let shafts = ["input", "s12", "r1", "c1r4", "r2s3", "r3s4", "c3", "output"];
    let mut duties: Vec<(Train, CompileRequest, usize)> = Vec::new();
    for gear in ["1", "5", "8", "R"] {
        let duty = with_drag(CompileRequest::new(["input"], ["input"]).state(gear), &shafts)
            .output(CompiledOutput::Torque("output".into()))
            .output(CompiledOutput::MeshTorque("P4.sun-planet".into()))
            .output(CompiledOutput::Speed("output".into()))
            .output(CompiledOutput::Loss)
            .output(CompiledOutput::Efficiency);
        duties.push((eight.clone(), duty, 1));
    }
    for outputs in [
        vec![
            CompiledOutput::Torque("ring".into()),
            CompiledOutput::Torque("carrier".into()),
            CompiledOutput::Loss,
            CompiledOutput::Efficiency,
        ],
        vec![CompiledOutput::Efficiency],
        vec![
            CompiledOutput::Loss,
            CompiledOutput::Torque("carrier".into()),
            CompiledOutput::Loss,
            CompiledOutput::Torque("sun".into()),
        ],
        vec![CompiledOutput::Speed("ring".into()), CompiledOutput::Efficiency],
    ] {
        let mut duty = with_drag(CompileRequest::new(["sun", "carrier"], ["sun"]), &["sun", "ring", "carrier"]);
        for o in outputs {
            duty = duty.output(o);
        }
        duties.push((power_split().build().unwrap(), duty, 2));
    }
    let duty = with_drag(CompileRequest::new(["a", "d"], ["a"]), &["a", "c"])
        .output(CompiledOutput::Torque("b".into()))
        .output(CompiledOutput::Efficiency);
    duties.push((compound_split().build().unwrap(), duty, 2));
    for (train, duty, freedoms) in duties {
        let compiled = train.compile(&duty).unwrap();
        let mut work = compiled.workspace();
        let speeds: Vec<&[f64]> = [&w0[..], &w1[..]][..freedoms].to_vec();
        let torques = [&t[..]];
        let points = BatchInputs { speeds: &speeds, torques: &torques };
        let mut out = vec![vec![f64::NAN; n]; compiled.outputs()];
        let mut slices: Vec<&mut [f64]> = out.iter_mut().map(|o| &mut o[..]).collect();
        assert_eq!(compiled.evaluate_batch(&points, &mut work, &mut slices), 0);
        let mut one = vec![0.0; compiled.outputs()];
        for i in 0..n {
            let w: Vec<f64> = speeds.iter().map(|s| s[i]).collect();
            compiled.evaluate(&w, &[t[i]], &mut work, &mut one);
            for (k, o) in out.iter().enumerate() {
                let (x, y) = (o[i], one[k]);
                assert!((x - y).abs() <= 1e-10 * y.abs().max(1.0), "{duty:?} point {i} {w:?} {}: {x} {y}", t[i]);
            }
        }
        let mut sums = vec![0.0; compiled.outputs()];
        compiled.sum_batch(&points, &mut work, &mut sums);
        for (s, o) in sums.iter().zip(&out) {
            let size: f64 = o.iter().map(|x| x.abs()).sum();
            assert!((s - o.iter().sum::<f64>()).abs() <= 1e-11 * size);
        }
    }
}

/// In a gear whose input keeps its direction: the same bits for a point alone, in a batch, and wherever in the batch it
/// stands, whichever of many patterns of drivers it has.
#[test]
fn points_of_a_gear_are_the_same_alone_and_in_a_batch() {
    let n = 1300;
    let mut random = Uniform(5);
    for name in ["zf-8hp70", "ford-10r80"] {
        let train = common::train(name);
        let [input, output] = [train.input(), train.output()].map(|m| train.member_name(m.unwrap()).to_owned());
        for (k, state) in train.states().iter().enumerate() {
            let mut duty = CompileRequest::new([input.as_str()], [input.as_str()])
                .state(&state.name)
                .output(CompiledOutput::Torque(output.clone()))
                .output(CompiledOutput::Loss)
                .output(CompiledOutput::Efficiency);
            // Light loads beside drag: the pattern changes with speed.
            for m in ["input", "output", "c3", "r1"].iter().filter(|m| train.member(m).is_some()) {
                duty = duty.drag(m, ShaftDrag { coulomb: 0.3, viscous: 2e-3 });
            }
            for e in &state.engaged {
                let name = train.shift_elements()[e.index()].name.clone();
                let more = duty.clone().output(CompiledOutput::ShiftElementTorque(name));
                duty = if train.compile(&more).is_ok() { more } else { duty };
            }
            let compiled = train.compile(&duty).unwrap();
            let direction = if k % 2 == 0 { 1.0 } else { -1.0 };
            let w: Vec<f64> = (0..n).map(|_| direction * random.between(20.0, 500.0)).collect();
            let t: Vec<f64> = (0..n)
                .map(|i| match i % 5 {
                    0 => random.between(-3.0, 3.0),
                    1 if i % 77 == 1 => 0.0,
                    2 if i % 100 == 2 => f64::NAN,
                    _ => random.between(-100.0, 350.0),
                })
                .collect();
            let mut one = vec![0.0; compiled.outputs()];
            for from in [0, 1, 13, 1290] {
                let mut work = compiled.workspace();
                let mut out = vec![vec![0.5; n - from]; compiled.outputs()];
                let mut slices: Vec<&mut [f64]> = out.iter_mut().map(|o| &mut o[..]).collect();
                let points = BatchInputs { speeds: &[&w[from..]], torques: &[&t[from..]] };
                compiled.evaluate_batch(&points, &mut work, &mut slices);
                for i in 0..n - from {
                    compiled.evaluate(&[w[from + i]], &[t[from + i]], &mut work, &mut one);
                    for (o, own) in out.iter().zip(&one) {
                        let same = o[i] == *own || o[i].is_nan() && own.is_nan();
                        assert!(same, "{name} {}: {} {}: {} {own}", state.name, w[from + i], t[from + i], o[i]);
                    }
                }
            }
        }
    }
}

/// The arrays that a grid stands for: points in the order of `order`, slowest first.
fn expanded(values: &[&[f64]], order: &[usize]) -> Vec<Vec<f64>> {
    let points = values.iter().map(|v| v.len()).product();
    let mut arrays = vec![vec![0.0; points]; values.len()];
    for point in 0..points {
        let mut rest = point;
        for &k in order.iter().rev() {
            arrays[k][point] = values[k][rest % values[k].len()];
            rest /= values[k].len();
        }
    }
    arrays
}

/// Results of a grid and of its arrays have the same bits, and so have sums and extremes, whichever input is fastest and
/// from whichever point on.
#[test]
fn a_grid_is_its_arrays_to_the_last_bit() {
    let split = |outputs: &[CompiledOutput]| {
        let duty = with_drag(CompileRequest::new(["sun", "carrier"], ["sun"]), &["sun", "ring", "carrier"]);
        power_split().build().unwrap().compile(&outputs.iter().cloned().fold(duty, CompileRequest::output)).unwrap()
    };
    let [ring, carrier] = ["ring", "carrier"].map(|m| CompiledOutput::Torque(m.into()));
    let reversed =
        CompileRequest::new(["carrier", "ring"], ["ring"]).output(carrier.clone()).output(CompiledOutput::Efficiency);
    let third = CompileRequest::new(["sun", "ring"], ["carrier"]).output(CompiledOutput::Loss).output(ring.clone());
    let bare = |duty: &CompileRequest| power_split().build().unwrap().compile(duty).unwrap();
    let eight = with_drag(CompileRequest::new(["input"], ["input"]).state("5"), &SHAFTS);
    let eight = eight.output(CompiledOutput::Torque("output".into())).output(CompiledOutput::Torque("input".into()));
    let trains = [
        split(&[ring.clone(), carrier.clone(), CompiledOutput::Loss, CompiledOutput::Efficiency]),
        split(&[CompiledOutput::Efficiency]),
        split(&[
            CompiledOutput::Loss,
            CompiledOutput::Efficiency,
            CompiledOutput::Torque("sun".into()),
            CompiledOutput::Loss,
        ]),
        split(&[CompiledOutput::Speed("ring".into()), ring, CompiledOutput::Efficiency]),
        bare(&reversed),
        bare(&third),
        common::train("zf-8hp70").compile(&eight.clone().output(CompiledOutput::Efficiency)).unwrap(),
        eight_speed([1.0; 4]).compile(&with_laws(eight)).unwrap(),
    ];
    let nowhere = GridInputs::new(&[&[1.0, 2.0], &[]], &[&[1.0, 2.0]]);
    assert!(nowhere.is_empty());
    let mut none = [OutputSummary::default()];
    assert_eq!(trains[1].evaluate_grid(&nowhere, 0..0, &mut trains[1].workspace(), &mut [&mut []]), 0);
    assert_eq!(trains[1].summarize_grid(&nowhere, 0..0, &mut trains[1].workspace(), &mut none), 0);
    assert_eq!((none[0].sum, none[0].min, none[0].max), (0.0, None, None));
    let mut up: Vec<f64> = (0..700).map(|k| -200.0 + 0.57 * f64::from(k)).collect();
    up[351] = 0.0;
    let down: Vec<f64> = up.iter().rev().copied().collect();
    let mixed = vec![3.0, -1.0, 0.0, 250.0, f64::NAN, -0.0];
    let large = vec![-1e308, -1e300, -1e-300, 0.0, 1e-310, 0.4, 0.4 + 1e-16, 1e155, 1e304, f64::MAX];
    let slow = [-400.0, -0.0, 0.0, 30.0, 70.0, 1e-300];
    for (at, compiled) in trains.iter().enumerate() {
        let freedoms = if at < 6 { 2 } else { 1 };
        for fast in [&up, &down, &mixed, &large] {
            for order in [[0, 1, 2], [2, 1, 0], [1, 2, 0]] {
                // The law of losses is given for ordinary numbers.
                if at == 7 && (fast == &large || fast == &mixed) {
                    continue;
                }
                let speeds: Vec<&[f64]> = vec![&slow[..if at == 7 { 5 } else { 6 }], &[-20.0, 70.0, 5.0][..]];
                let speeds = &speeds[..freedoms];
                let order: Vec<usize> = order.into_iter().filter(|k| *k <= freedoms).collect();
                let values: Vec<&[f64]> = speeds.iter().copied().chain([&fast[..]]).collect();
                let torques = [&fast[..]];
                let grid = GridInputs::new(speeds, &torques);
                let grid = if order.is_sorted() { grid } else { grid.nested(&order) };
                let arrays = expanded(&values, &order);
                let slices: Vec<&[f64]> = arrays.iter().map(|a| &a[..]).collect();
                let n = arrays[0].len();
                assert_eq!(grid.len(), n);
                for range in [0..n, 1..n - 1, n / 3..n / 3 + 1, 5..5] {
                    let given: Vec<&[f64]> = slices.iter().map(|s| &s[range.clone()]).collect();
                    let points = BatchInputs { speeds: &given[..freedoms], torques: &given[freedoms..] };
                    let mut work = compiled.workspace();
                    let filled = |run: &mut dyn FnMut(&mut [&mut [f64]]) -> usize| {
                        let mut out = vec![vec![f64::NAN; range.len()]; compiled.outputs()];
                        let odd = run(&mut out.iter_mut().map(|o| &mut o[..]).collect::<Vec<_>>());
                        (out, odd)
                    };
                    let (arrays, odd) = filled(&mut |out| compiled.evaluate_batch(&points, &mut work, out));
                    let mut work = compiled.workspace();
                    let (own, own_odd) =
                        filled(&mut |out| compiled.evaluate_grid(&grid, range.clone(), &mut work, out));
                    assert_eq!(odd, own_odd);
                    for (k, (x, y)) in arrays.iter().zip(&own).enumerate() {
                        for i in 0..x.len() {
                            let same = x[i].to_bits() == y[i].to_bits() || x[i].is_nan() && y[i].is_nan();
                            let point: Vec<f64> = given.iter().map(|g| g[i]).collect();
                            assert!(same, "train {at} output {k} at {point:?}: {} {}", x[i], y[i]);
                        }
                    }
                    // In single precision, from arrays and from the grid.
                    for of_grid in [false, true] {
                        let mut rounded = vec![vec![f32::NAN; range.len()]; compiled.outputs()];
                        let mut out: Vec<&mut [f32]> = rounded.iter_mut().map(|o| &mut o[..]).collect();
                        let mut work = compiled.workspace();
                        let own_odd = match of_grid {
                            false => compiled.evaluate_batch_f32(&points, &mut work, &mut out),
                            true => compiled.evaluate_grid_f32(&grid, range.clone(), &mut work, &mut out),
                        };
                        assert_eq!(odd, own_odd);
                        for (x, y) in arrays.iter().flatten().zip(rounded.iter().flatten()) {
                            assert!((*x as f32).to_bits() == y.to_bits() || x.is_nan() && y.is_nan(), "{x} {y}");
                        }
                    }
                    // Sums of 32, 2048 points at a time.
                    let expected = |x: &[f64], offset: usize| {
                        let mut all = OutputSummary::default();
                        for block in x.chunks(2048) {
                            let mut sums = [0.0; 32];
                            block.iter().enumerate().for_each(|(i, x)| sums[i % 32] += x);
                            all.sum += sums.iter().sum::<f64>();
                        }
                        let least = x.iter().copied().fold(f64::INFINITY, f64::min);
                        let most = x.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                        let at = |value: f64| x.iter().position(|x| *x == value).map(|i| (value, i + offset));
                        (
                            all.sum,
                            at(least).filter(|m| m.0 < f64::INFINITY),
                            at(most).filter(|m| m.0 > f64::NEG_INFINITY),
                        )
                    };
                    for from_grid in [false, true] {
                        let mut out = vec![OutputSummary::default(); compiled.outputs()];
                        let mut work = compiled.workspace();
                        let own_odd = match from_grid {
                            true => compiled.summarize_grid(&grid, range.clone(), &mut work, &mut out),
                            false => compiled.summarize_batch(&points, &mut work, &mut out),
                        };
                        assert_eq!(odd, own_odd);
                        for (x, own) in arrays.iter().zip(&out) {
                            let (sum, least, most) = expected(x, if from_grid { range.start } else { 0 });
                            assert!(sum.to_bits() == own.sum.to_bits() || sum.is_nan() && own.sum.is_nan());
                            assert_eq!(own.min.map(|m| (m.value, m.point)), least);
                            assert_eq!(own.max.map(|m| (m.value, m.point)), most);
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn a_point_allocates_nothing() {
    let train = common::train("zf-8hp70");
    let duty = with_drag(CompileRequest::new(["input"], ["input"]).state("5"), &["input", "output", "c3"])
        .output(CompiledOutput::Torque("output".into()))
        .output(CompiledOutput::Efficiency);
    for duty in [duty.clone(), with_laws(duty)] {
        let compiled = train.compile(&duty).unwrap();
        let mut work = compiled.workspace();
        let mut out = [0.0; 2];
        let (w, t): (Vec<f64>, Vec<f64>) = (0..1000).map(|i| (i as f64 - 300.0, 500.0 - i as f64)).unzip();
        let (mut a, mut b) = (vec![0.0; 1000], vec![0.0; 1000]);
        let (speeds, torques) = ([&w[..]], [&t[..]]);
        let mut slices = [&mut a[..], &mut b[..]];
        let count = measure(|| {
            for i in 0..1000 {
                compiled.evaluate(&[w[i]], &[t[i]], &mut work, &mut out);
            }
            compiled.evaluate_batch(&BatchInputs { speeds: &speeds, torques: &torques }, &mut work, &mut slices);
        });
        assert_eq!(count.count_total, 0);
    }
}

/// Where the analysis finds two equilibria or none, the compiled train says so too.
#[test]
fn verdicts_of_points() {
    let train = common::train("two-efficiencies");
    let duty = CompileRequest::new(["input"], ["output"]).output(CompiledOutput::Efficiency);
    let compiled = train.compile(&duty).unwrap();
    assert!(!compiled.is_certified());
    let mut work = compiled.workspace();
    let mut out = [0.0];
    // A resisting load has two equilibria, seen with either sign of the speed.
    assert_eq!(compiled.evaluate(&[100.0], &[-10.0], &mut work, &mut out), PointVerdict::Multiple);
    assert_eq!(compiled.evaluate(&[-100.0], &[10.0], &mut work, &mut out), PointVerdict::Multiple);
    // Driven backwards it locks.
    assert_eq!(compiled.evaluate(&[100.0], &[10.0], &mut work, &mut out), PointVerdict::Locked);
    assert!(out[0].is_nan());
    let (w, t) = ([100.0; 7], [-10.0, 10.0, -1.0, 5.0, -5.0, 1.0, -3.0]);
    let mut column = [0.0; 7];
    let odd = compiled.evaluate_batch(&BatchInputs { speeds: &[&w], torques: &[&t] }, &mut work, &mut [&mut column]);
    assert_eq!(odd, 7);
    assert!(column[1].is_nan() && column[0] > 0.0);
    let a = analyze(&train, &Selection::default()).unwrap();
    assert_eq!(a.ratios.0[0].1.drive.verdict, Verdict::Multiple);
}

const SHAFTS: [&str; 8] = ["input", "s12", "r1", "c1r4", "r2s3", "r3s4", "c3", "output"];
/// Sun and carrier of the sets of the eight-speed train.
const SETS: [(&str, &str); 4] = [("s12", "c1r4"), ("s12", "input"), ("r2s3", "c3"), ("r3s4", "output")];
/// The law of `benches/baselines/automatic.py`.
const LAW: PowerLoss = PowerLoss { coefficient: 0.02, exponent: 0.2, torque: 1.0, speed: 1.0, most: 0.1 };

fn by_law(law: &PowerLoss, torque: f64, speed: f64) -> f64 {
    law.coefficient * ((torque.abs() + law.torque) / (speed.abs() + law.speed)).powf(law.exponent)
}

/// The eight-speed train with other basic efficiencies of its sets.
fn eight_speed(etas: [f64; 4]) -> Train {
    let mut text = common::example("zf-8hp70");
    for eta in etas {
        text = text.replacen(
            "mesh_efficiency = { external = 0.98, internal = 0.99 }",
            &format!("basic_efficiency = {eta:?}"),
            1,
        );
    }
    Train::from_toml(&text).unwrap()
}

fn eight_speed_duty(gear: &str) -> CompileRequest {
    let mut duty = CompileRequest::new(["input"], ["input"]).state(gear);
    for m in SHAFTS {
        duty = duty.drag(m, ShaftDrag { coulomb: 0.2, viscous: 1e-3 });
    }
    for s in 1..=4 {
        duty = duty.output(CompiledOutput::MeshTorque(format!("P{s}.sun-planet")));
    }
    for m in SHAFTS {
        duty = duty.output(CompiledOutput::Speed(m.into()));
    }
    duty.output(CompiledOutput::Torque("output".into())).output(CompiledOutput::Loss).output(CompiledOutput::Efficiency)
}

fn with_laws(duty: CompileRequest) -> CompileRequest {
    (1..=4).fold(duty, |d, s| d.mesh_loss(&format!("P{s}"), LAW))
}

fn relative_speeds(out: &[f64]) -> [f64; 4] {
    let speed = |m: &str| out[4 + SHAFTS.iter().position(|s| *s == m).unwrap()];
    SETS.map(|(sun, carrier)| speed(sun) - speed(carrier))
}

#[test]
fn load_dependent_losses_give_the_number_of_the_baseline() {
    let compiled = eight_speed([1.0; 4]).compile(&with_laws(eight_speed_duty("3"))).unwrap();
    assert!(compiled.is_certified());
    let mut out = [0.0; 15];
    let verdict = compiled.evaluate(&[200.0], &[150.0], &mut compiled.workspace(), &mut out);
    assert_eq!(verdict, PointVerdict::Unique);
    assert_eq!(format!("{:.9}", out[14]), "0.974316479");
}

/// The same equilibria as constant efficiencies, read off the torques again and again.
#[test]
fn load_dependent_losses_are_the_fixed_point_of_constant_ones() {
    let mut random = Uniform(11);
    for gear in ["1", "2", "3", "4", "5", "6", "7", "8", "R"] {
        let duty = eight_speed_duty(gear);
        let compiled = eight_speed([1.0; 4]).compile(&with_laws(duty.clone())).unwrap();
        assert!(compiled.is_certified(), "{gear}");
        let mut work = compiled.workspace();
        for k in 0..12 {
            let (w, t) = (random.between(-500.0, 500.0), if k == 0 { 0.0 } else { random.between(-100.0, 350.0) });
            let mut out = [0.0; 15];
            assert_eq!(compiled.evaluate(&[w], &[t], &mut work, &mut out), PointVerdict::Unique, "{gear} {w} {t}");
            let (mut etas, mut known) = ([1.0; 4], [0.0; 15]);
            for _ in 0..30 {
                let constant = eight_speed(etas).compile(&duty).unwrap();
                assert_eq!(constant.evaluate(&[w], &[t], &mut constant.workspace(), &mut known), PointVerdict::Unique);
                let v = relative_speeds(&known);
                let next: [f64; 4] = std::array::from_fn(|s| 1.0 - by_law(&LAW, known[s], v[s]));
                let settled = (0..4).all(|s| (next[s] - etas[s]).abs() < 1e-15);
                etas = next;
                if settled {
                    break;
                }
            }
            let drag: f64 = (0..8).map(|m| 0.2 * known[4 + m].abs() + 1e-3 * known[4 + m].powi(2)).sum();
            let loss = known[13] - drag;
            assert!(
                (out[13] - known[13]).abs() <= 1e-9 * loss + 1e-12 * (t * w).abs(),
                "{gear} {w} {t}: {} {}",
                out[13],
                known[13]
            );
            // Torques times speeds are powers.
            for s in [0, 1, 2, 3, 12] {
                let error = (out[s] - known[s]).abs() * w.abs();
                assert!(error <= 1e-8 * loss + 1e-12 * (t * w).abs(), "{gear} {w} {t} {s}: {} {}", out[s], known[s]);
            }
            // Power closes: what enters is lost in drag and in the meshes, each by its law.
            let v = relative_speeds(&out);
            let meshes: f64 = (0..4)
                .map(|s| {
                    let (power, loss) = (out[s] * v[s], by_law(&LAW, out[s], v[s]));
                    if power >= 0.0 { loss * power } else { -power * loss / (1.0 - loss) }
                })
                .sum();
            assert!((out[13] - drag - meshes).abs() <= 1e-9 * meshes + 1e-12 * (t * w).abs(), "{gear} {w} {t}");
        }
    }
}

/// A law for each mesh instead of each set, mixed with constant efficiencies, two freedoms, points at
/// rest: one point and many are the same bits.
#[test]
fn load_dependent_batches_are_their_points() {
    let n = 3000;
    let mut random = Uniform(12);
    let mut column = |low: f64, high: f64| -> Vec<f64> {
        (0..n).map(|i| if i % 89 == 0 { 0.0 } else { random.between(low, high) }).collect()
    };
    let (w0, w1, t) = (column(-400.0, 400.0), column(-150.0, 150.0), column(-200.0, 200.0));
    let mut duties = Vec::new();
    for gear in ["1", "3", "5", "R"] {
        duties.push((eight_speed([1.0; 4]), with_laws(eight_speed_duty(gear)), 1));
    }
    let steep = PowerLoss { exponent: 0.6, torque: 0.0, speed: 0.5, ..LAW };
    let duty = with_drag(CompileRequest::new(["a", "d"], ["a"]), &["a", "c"])
        .output(CompiledOutput::Torque("b".into()))
        .output(CompiledOutput::Efficiency);
    duties.push((compound_split().build().unwrap(), duty.clone().mesh_loss("P2", LAW), 2));
    let duty = duty.mesh_loss("P1.sun-planet", LAW).mesh_loss("P1.planet-ring", steep).mesh_loss("P2", steep);
    duties.push((compound_split().build().unwrap(), duty, 2));
    for (train, duty, freedoms) in duties {
        let compiled = train.compile(&duty).unwrap();
        assert!(compiled.is_certified());
        let mut work = compiled.workspace();
        let speeds: Vec<&[f64]> = [&w0[..], &w1[..]][..freedoms].to_vec();
        let torques = [&t[..]];
        let mut out = vec![vec![f64::NAN; n]; compiled.outputs()];
        let mut slices: Vec<&mut [f64]> = out.iter_mut().map(|o| &mut o[..]).collect();
        let odd = compiled.evaluate_batch(&BatchInputs { speeds: &speeds, torques: &torques }, &mut work, &mut slices);
        let mut one = vec![0.0; compiled.outputs()];
        let mut odd_points = 0;
        for i in 0..n {
            let w: Vec<f64> = speeds.iter().map(|s| s[i]).collect();
            let verdict = compiled.evaluate(&w, &[t[i]], &mut work, &mut one);
            assert!(matches!(verdict, PointVerdict::Unique | PointVerdict::OutOfRange), "{verdict:?} {w:?} {}", t[i]);
            odd_points += usize::from(verdict != PointVerdict::Unique);
            for (k, o) in out.iter().enumerate() {
                assert!(one[k] == o[i], "{duty:?} point {i} {w:?} {} output {k}: {} {}", t[i], o[i], one[k]);
            }
        }
        assert_eq!(odd, odd_points);
    }
}

/// Two equilibria, or none, also with losses that depend on load; and what cannot be decided says so.
#[test]
fn load_dependent_verdicts() {
    let train = common::train("two-efficiencies");
    let compiled = |exponent: f64, most: [f64; 2]| {
        let law = |coefficient, most| PowerLoss { coefficient, exponent, torque: 1.0, speed: 1.0, most };
        let duty = CompileRequest::new(["input"], ["output"]).output(CompiledOutput::Efficiency);
        train.compile(&duty.mesh_loss("A", law(0.02, most[0])).mesh_loss("B", law(0.08, most[1]))).unwrap()
    };
    let verdict = |compiled: &CompiledTrain, load: f64| {
        let mut out = [0.0];
        (compiled.evaluate(&[100.0], &[load], &mut compiled.workspace(), &mut out), out[0])
    };
    // Without load in it: what the analysis says of the same constant losses.
    let constant = compiled(0.0, [0.1; 2]);
    assert!(!constant.is_certified());
    let (multiple, efficiency) = verdict(&constant, -10.0);
    assert!(multiple == PointVerdict::Multiple && (efficiency - 0.0428961393).abs() < 1e-9);
    let (locked, efficiency) = verdict(&constant, 10.0);
    assert!(locked == PointVerdict::Locked && efficiency.is_nan());
    let (w, t) = ([100.0; 3], [-10.0, 10.0, -1.0]);
    let mut column = [0.0; 3];
    let points = BatchInputs { speeds: &[&w], torques: &[&t] };
    assert_eq!(constant.evaluate_batch(&points, &mut constant.workspace(), &mut [&mut column]), 3);
    assert!(column[1].is_nan() && column[0] > 0.0);
    assert_eq!(verdict(&compiled(0.002, [0.021, 0.083]), -10.0).0, PointVerdict::Multiple);
    assert_eq!(verdict(&compiled(0.05, [0.03, 0.1]), -10.0).0, PointVerdict::Undecided);

    // A law that reaches its ceiling.
    let duty = CompileRequest::new(["sun", "carrier"], ["sun"]).output(CompiledOutput::Torque("ring".into()));
    let split = power_split().build().unwrap().compile(&duty.mesh_loss("P1", PowerLoss { most: 0.03, ..LAW })).unwrap();
    let mut work = split.workspace();
    let mut out = [0.0];
    assert_eq!(split.evaluate(&[100.0, 0.0], &[50.0], &mut work, &mut out), PointVerdict::Unique);
    for t in [1e4, -1e4] {
        assert_eq!(split.evaluate(&[100.0, 0.0], &[t], &mut work, &mut out), PointVerdict::OutOfRange);
        let rho = if t > 0.0 { 0.97 } else { 1.0 / 0.97 };
        assert!((out[0] / (7.0 / 3.0 * rho * t) - 1.0).abs() < 1e-12);
    }
    assert_eq!(split.evaluate(&[f64::NAN, 0.0], &[50.0], &mut work, &mut out), PointVerdict::NotConverged);
}

#[test]
fn laws_that_cannot_be() {
    let code = |train: &Train, losses: &[(&str, PowerLoss)]| {
        let duty = CompileRequest::new(["sun", "carrier"], ["sun"]);
        let duty = losses.iter().fold(duty, |d, (name, law)| d.mesh_loss(name, *law));
        train.compile(&duty).unwrap_err().iter().next().unwrap().code
    };
    let train = power_split().build().unwrap();
    assert_eq!(code(&train, &[("P2", LAW)]), Code::UnknownName);
    assert_eq!(code(&train, &[("P1", LAW), ("P1", LAW)]), Code::DuplicateName);
    // A law for one mesh takes the set apart.
    assert_eq!(code(&train, &[("P1", LAW), ("P1.sun-planet", LAW)]), Code::Unfit);
    for law in [
        PowerLoss { coefficient: -0.01, ..LAW },
        PowerLoss { coefficient: f64::NAN, ..LAW },
        PowerLoss { exponent: 1.0, ..LAW },
        PowerLoss { torque: -1.0, ..LAW },
        PowerLoss { speed: f64::INFINITY, ..LAW },
        PowerLoss { most: 0.6, ..LAW },
        PowerLoss { most: 0.0, ..LAW },
    ] {
        assert_eq!(code(&train, &[("P1", law)]), Code::OutOfRange);
    }
}

/// Powers that floating point cannot hold give no efficiency, never an infinite one.
#[test]
fn powers_beyond_floating_point_have_no_efficiency() {
    for (ring, speeds) in [("frame", vec!["s"]), ("r", vec!["s", "c"])] {
        let train = Train::builder("set")
            .members(["s", "r", "c"])
            .terminals(if ring == "r" { vec!["s", "r", "c"] } else { vec!["s", "c"] })
            .set(SetSpec::simple("P1", ("s", 30), (ring, 70), "c").planet(20, 4).mesh_efficiency(0.99))
            .build()
            .expect("a train");
        let compiled = train
            .compile(&CompileRequest::new(speeds.clone(), ["s"]).output(CompiledOutput::Efficiency))
            .expect("a duty");
        let mut work = compiled.workspace();
        for torque in [1.0, 1e300, 5.5e307, 1e308, f64::MAX, -5.5e307] {
            for speed in [1.0, 1e-3, 1e3, -1.0] {
                let mut out = [0.0; 1];
                let at = [speed, 0.4 * speed];
                compiled.evaluate(&at[..speeds.len()], &[torque], &mut work, &mut out);
                assert!(out[0].is_nan() || (0.0..=1.0).contains(&out[0]), "{ring} {torque} {speed}: {}", out[0]);
                assert!(torque.abs() > 1e299 || out[0] > 0.0 || speed < 0.0);
                let (columns, torques) = (at.map(|w| [w; 3]), [[torque; 3]]);
                let given: Vec<&[f64]> = columns[..speeds.len()].iter().map(|c| &c[..]).collect();
                let mut batch = [0.0; 3];
                let points = BatchInputs { speeds: &given, torques: &[&torques[0]] };
                compiled.evaluate_batch(&points, &mut work, &mut [&mut batch]);
                for e in batch {
                    assert!(e.is_nan() || (0.0..=1.0).contains(&e), "{ring} {torque} {speed}: {batch:?}");
                    assert!(torque.abs() > 1e299 || (e - out[0]).abs() < 1e-12);
                }
            }
        }
    }
}

/// Numbers too small for all digits of floating point tell no efficiency above one: as inputs, in whatever company, and as
/// powers. Alone, in a batch and in a grid it is the same.
#[test]
fn numbers_below_floating_point_tell_no_efficiency_above_one() {
    let sizes: Vec<f64> = [-0.0, 0.0, 1.0, 5.00399959e15, 1e-200, 1e200, f64::MIN_POSITIVE]
        .into_iter()
        .chain((1..12).map(f64::from_bits))
        .chain((0..16).map(|k| f64::MIN_POSITIVE * 0.37f64.powi(k)))
        .flat_map(|x| [x, -x])
        .collect();
    let chain = Train::builder("reducer")
        .members(["sun", "carrier", "out"])
        .terminals(["sun", "out"])
        .set(SetSpec::simple("P1", ("sun", 30), ("frame", 70), "carrier").basic_efficiency(0.98))
        .set(SetSpec::simple("P2", ("carrier", 33), ("frame", 77), "out").basic_efficiency(0.97));
    for (train, speeds) in [(power_split(), vec!["sun", "carrier"]), (chain, vec!["sun"])] {
        let train = train.build().unwrap();
        let request = CompileRequest::new(speeds.iter().copied(), ["sun"]).output(CompiledOutput::Efficiency);
        let compiled = train.compile(&request).unwrap();
        let mut work = compiled.workspace();
        let grid = vec![&sizes[..]; speeds.len()];
        let (grid, torques) = (&grid[..], [&sizes[..]]);
        let grid = GridInputs::new(grid, &torques);
        let mut of_grid = vec![0.5; grid.len()];
        compiled.evaluate_grid(&grid, 0..grid.len(), &mut work, &mut [&mut of_grid]);
        let n = sizes.len();
        let input = |k: usize, point: usize| sizes[point / n.pow((speeds.len() - k) as u32) % n];
        let arrays: Vec<Vec<f64>> =
            (0..=speeds.len()).map(|k| (0..grid.len()).map(|point| input(k, point)).collect()).collect();
        let [torque, speed] = [&arrays[speeds.len()..], &arrays[..speeds.len()]]
            .map(|all| all.iter().map(|x| &x[..]).collect::<Vec<&[f64]>>());
        let mut of_batch = vec![0.5; grid.len()];
        let given = BatchInputs { speeds: &speed, torques: &torque };
        compiled.evaluate_batch(&given, &mut work, &mut [&mut of_batch]);
        let mut sum = [0.0];
        compiled.sum_batch(&given, &mut work, &mut sum);
        for point in 0..grid.len() {
            let (w, t): (Vec<f64>, Vec<f64>) =
                (speed.iter().map(|w| w[point]).collect(), torque.iter().map(|t| t[point]).collect());
            let mut one = [0.5];
            compiled.evaluate(&w, &t, &mut work, &mut one);
            let [one] = one;
            assert!(one.is_nan() || (-1e-12..=1.0 + 1e-12).contains(&one), "{w:?} rad/s, {t:?} N m: {one}");
            for other in [of_grid[point], of_batch[point]] {
                assert!(
                    (one - other).abs() <= 1e-12 || one.is_nan() && other.is_nan(),
                    "{w:?}, {t:?}: {one} and {other}"
                );
            }
        }
    }
}
