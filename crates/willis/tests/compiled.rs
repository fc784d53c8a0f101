//! A compiled train gives the answers of the analysis, one point or many, and allocates nothing.

use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};
use std::alloc::System;
use std::sync::Mutex;

use willis::analysis::{Selection, Verdict, analyze};
use willis::compiled::{Duty, Output, PointVerdict, Points, ShaftDrag};
use willis::train::{OperationSpec, SetSpec, Train, TrainBuilder};
use willis::units::{AngularSpeed, Torque};

#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;
/// The allocator counts for the whole process, so the tests of this file take turns.
static TURN: Mutex<()> = Mutex::new(());

fn turn() -> std::sync::MutexGuard<'static, ()> {
    TURN.lock().unwrap_or_else(|e| e.into_inner())
}

struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + self.next() * (high - low)
    }
}

fn example(name: &str) -> Train {
    let path = format!("{}/../../examples/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    Train::from_toml(&std::fs::read_to_string(path).unwrap()).unwrap()
}

fn power_split() -> TrainBuilder {
    Train::builder("power split")
        .members(["sun", "ring", "carrier"])
        .terminals(["sun", "ring", "carrier"])
        .set(SetSpec::simple("P1", ("sun", 30), ("ring", 70), "carrier").mesh_efficiency(0.985))
}

/// Two coupled sets with two freedoms and three terminals: sign patterns change with the speeds.
fn compound_split() -> TrainBuilder {
    Train::builder("compound split")
        .members(["a", "b", "c", "d"])
        .terminals(["a", "b", "d"])
        .set(SetSpec::simple("P1", ("a", 30), ("b", 78), "c").mesh_efficiency(0.98))
        .set(SetSpec::simple("P2", ("b", 31), ("c", 83), "d").mesh_efficiency(0.97))
}

#[test]
fn compiled_equals_analysis_with_two_freedoms() {
    let _turn = turn();
    let mut random = Random(1);
    for (builder, speeds, torque, open) in [
        (power_split(), ["sun", "carrier"], "sun", ["ring", "carrier"]),
        (power_split(), ["carrier", "ring"], "ring", ["sun", "carrier"]),
        (power_split(), ["sun", "ring"], "carrier", ["sun", "ring"]),
        (compound_split(), ["a", "d"], "a", ["b", "d"]),
    ] {
        let duty = Duty::new(speeds, [torque])
            .output(Output::Torque(open[0].into()))
            .output(Output::Torque(open[1].into()))
            .output(Output::Loss)
            .output(Output::Efficiency)
            .output(Output::Speed(open[0].into()));
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
    let _turn = turn();
    let mut random = Random(2);
    for name in ["zf-8hp70", "zf-6hp26", "ford-10r80", "mercedes-9g-tronic", "ford-aod", "simpson-ford-c4"] {
        let train = example(name);
        let input = train.member_name(train.input().unwrap()).to_owned();
        let output = train.member_name(train.output().unwrap()).to_owned();
        for state in train.states() {
            let mut duty = Duty::new([input.as_str()], [input.as_str()])
                .state(&state.name)
                .output(Output::Torque(output.clone()))
                .output(Output::Efficiency);
            let elements: Vec<String> =
                state.engaged.iter().map(|e| train.shift_elements()[e.index()].name.clone()).collect();
            for e in &elements {
                duty = duty.output(Output::ShiftElementTorque(e.clone()));
            }
            let compiled = train.compile(&duty).unwrap();
            assert!(compiled.is_certified());
            let mut work = compiled.workspace();
            let mut out = vec![0.0; compiled.outputs()];
            for _ in 0..4 {
                let (w, t) = (random.between(50.0, 500.0).round(), random.between(-200.0, 400.0).round());
                let text =
                    std::fs::read_to_string(format!("{}/../../examples/{name}.toml", env!("CARGO_MANIFEST_DIR")))
                        .unwrap();
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

fn with_drag(duty: Duty, members: &[&str]) -> Duty {
    members
        .iter()
        .enumerate()
        .fold(duty, |d, (k, m)| d.drag(m, ShaftDrag { coulomb: 0.2 + 0.1 * k as f64, viscous: 1e-3 * (k + 1) as f64 }))
}

#[test]
fn a_batch_equals_its_points() {
    let _turn = turn();
    let n = 5000;
    let mut random = Random(3);
    let column = |low: f64, high: f64, random: &mut Random| -> Vec<f64> {
        (0..n).map(|i| if i % 97 == 0 { 0.0 } else { random.between(low, high) }).collect()
    };
    let (w0, w1, t) =
        (column(-400.0, 400.0, &mut random), column(-150.0, 150.0, &mut random), column(-200.0, 200.0, &mut random));
    let eight = example("zf-8hp70");
    let shafts = ["input", "s12", "r1", "c1r4", "r2s3", "r3s4", "c3", "output"];
    let mut duties: Vec<(Train, Duty, usize)> = Vec::new();
    for gear in ["1", "5", "8", "R"] {
        let duty = with_drag(Duty::new(["input"], ["input"]).state(gear), &shafts)
            .output(Output::Torque("output".into()))
            .output(Output::MeshTorque("P4.sun-planet".into()))
            .output(Output::Speed("output".into()))
            .output(Output::Loss)
            .output(Output::Efficiency);
        duties.push((eight.clone(), duty, 1));
    }
    for outputs in [
        vec![Output::Torque("ring".into()), Output::Torque("carrier".into()), Output::Loss, Output::Efficiency],
        vec![Output::Efficiency],
        vec![Output::Loss, Output::Torque("carrier".into()), Output::Loss, Output::Torque("sun".into())],
        vec![Output::Speed("ring".into()), Output::Efficiency],
    ] {
        let mut duty = with_drag(Duty::new(["sun", "carrier"], ["sun"]), &["sun", "ring", "carrier"]);
        for o in outputs {
            duty = duty.output(o);
        }
        duties.push((power_split().build().unwrap(), duty, 2));
    }
    let duty = with_drag(Duty::new(["a", "d"], ["a"]), &["a", "c"])
        .output(Output::Torque("b".into()))
        .output(Output::Efficiency);
    duties.push((compound_split().build().unwrap(), duty, 2));
    for (train, duty, freedoms) in duties {
        let compiled = train.compile(&duty).unwrap();
        let mut work = compiled.workspace();
        let speeds: Vec<&[f64]> = [&w0[..], &w1[..]][..freedoms].to_vec();
        let torques = [&t[..]];
        let points = Points { speeds: &speeds, torques: &torques };
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

#[test]
fn a_point_allocates_nothing() {
    let _turn = turn();
    let train = example("zf-8hp70");
    let duty = with_drag(Duty::new(["input"], ["input"]).state("5"), &["input", "output", "c3"])
        .output(Output::Torque("output".into()))
        .output(Output::Efficiency);
    let compiled = train.compile(&duty).unwrap();
    let mut work = compiled.workspace();
    let mut out = [0.0; 2];
    let (w, t): (Vec<f64>, Vec<f64>) = (0..1000).map(|i| (i as f64 - 300.0, 500.0 - i as f64)).unzip();
    let (mut a, mut b) = (vec![0.0; 1000], vec![0.0; 1000]);
    let (speeds, torques) = ([&w[..]], [&t[..]]);
    let mut slices = [&mut a[..], &mut b[..]];
    let region = Region::new(ALLOCATOR);
    for i in 0..1000 {
        compiled.evaluate(&[w[i]], &[t[i]], &mut work, &mut out);
    }
    compiled.evaluate_batch(&Points { speeds: &speeds, torques: &torques }, &mut work, &mut slices);
    assert_eq!(region.change().allocations, 0);
}

/// Where the analysis finds two equilibria or none, the compiled train says so too.
#[test]
fn verdicts_of_points() {
    let _turn = turn();
    let train = example("two-efficiencies");
    let duty = Duty::new(["input"], ["output"]).output(Output::Efficiency);
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
    let odd = compiled.evaluate_batch(&Points { speeds: &[&w], torques: &[&t] }, &mut work, &mut [&mut column]);
    assert_eq!(odd, 7);
    assert!(column[1].is_nan() && column[0] > 0.0);
    let a = analyze(&train, &Selection::default()).unwrap();
    assert_eq!(a.ratios.0[0].1.drive.verdict, Verdict::Multiple);
}
