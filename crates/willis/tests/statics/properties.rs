//! What must hold on every train: random couplings of one to five sets.
//!
//! The brute force here is independent of the library's solver: it works gear pair by gear pair
//! (no merging of chains), in plain floating point, over every sign vector.

use std::sync::atomic::{AtomicUsize, Ordering};

use proptest::prelude::*;
use willis::analysis::{OperationReport, Role, Selection, SolutionReport, Verdict, analyze};
use willis::train::{OperationSpec, SetSpec, Specification, Train};
use willis::units::{AngularSpeed, Torque};

const NAMES: [&str; 8] = ["m0", "m1", "m2", "m3", "m4", "m5", "m6", "m7"];

/// A set between three members: two suns on stepped planets, or sun and ring.
#[derive(Clone, Debug)]
struct RandomSet {
    members: [usize; 3],
    teeth: [i64; 4],
    ring: bool,
    eta: [i64; 2],
}

#[derive(Clone, Debug)]
struct RandomTrain {
    sets: Vec<RandomSet>,
    torque: i64,
    speed: i64,
}

fn random_set(members: usize) -> impl Strategy<Value = RandomSet> {
    let three = proptest::sample::subsequence((0..members).collect::<Vec<_>>(), 3).prop_shuffle();
    (three, [12i64..90, 12i64..90, 12i64..60, 12i64..60], any::<bool>(), [700i64..1000, 700i64..1000])
        .prop_map(|(m, teeth, ring, eta)| RandomSet { members: [m[0], m[1], m[2]], teeth, ring, eta })
}

/// `k` sets on `k + 2` members have two freedoms; holding one member leaves one.
fn random_train(sizes: std::ops::RangeInclusive<usize>) -> impl Strategy<Value = RandomTrain> {
    sizes.prop_flat_map(|k| {
        (proptest::collection::vec(random_set(k + 2), k), 1i64..1000, 1i64..1000)
            .prop_map(|(sets, torque, speed)| RandomTrain { sets, torque, speed })
    })
}

impl RandomTrain {
    fn members(&self) -> usize {
        self.sets.len() + 2
    }

    /// With another order of members and other names, if asked for.
    fn builder(&self, name: &dyn Fn(usize) -> String, lossless: bool) -> Specification {
        let names: Vec<String> = (0..self.members()).map(name).collect();
        let mut sorted: Vec<&str> = names.iter().map(String::as_str).collect();
        sorted.sort_unstable();
        let mut b = Train::builder("random").members(sorted.iter().copied());
        for (k, s) in self.sets.iter().enumerate() {
            let [x, y, c] = s.members.map(|m| names[m].as_str());
            let [zx, zy, p, q] = s.teeth;
            let set = SetSpec::stepped(format!("P{k}"), c).sun(x, zx, p);
            let set = if s.ring { set.ring(y, zy + q, q) } else { set.sun(y, zy, q) };
            // The same efficiency for both meshes of the set; each set its own.
            let eta = if lossless { 1.0 } else { s.eta[0] as f64 / 1000.0 };
            b = b.set(set.mesh_efficiency(eta));
        }
        b
    }

    /// Member 0 is held, 1 drives, 2 carries a resisting or helping load.
    fn operation(&self, name: &dyn Fn(usize) -> String, scale: f64, reverse: bool, w_out: f64) -> OperationSpec {
        let sign = if reverse { -1.0 } else { 1.0 };
        let load = -w_out.signum() * self.torque as f64 * scale * sign;
        OperationSpec::new("load")
            .fixed(&name(0))
            .speed(&name(1), AngularSpeed::rad_s(self.speed as f64 * sign))
            .torque(&name(2), Torque::n_m(load))
    }

    fn run(
        &self,
        name: &dyn Fn(usize) -> String,
        lossless: bool,
        scale: f64,
        reverse: bool,
    ) -> Option<OperationReport> {
        let terminals = [name(1), name(2)];
        let bare = self.builder(name, lossless).terminals(terminals.iter().map(String::as_str));
        // The output's direction, to make the load a resisting one.
        let probe = OperationSpec::new("probe")
            .fixed(&name(0))
            .speed(&name(1), AngularSpeed::rad_s(self.speed as f64))
            .torque(&name(2), Torque::n_m(0.0));
        let first = analyze(&bare.clone().operation(probe).build().ok()?, &Selection::default()).ok()?;
        let o = &first.operations[0];
        let w_out = o.speeds_rad_s.get(&name(2)).copied().flatten()?;
        if o.degrees_of_freedom != 1 || o.speeds_rad_s.iter().any(|(_, w)| w.is_none()) || w_out == 0.0 {
            return None;
        }
        let train = bare.operation(self.operation(name, scale, reverse, w_out)).build().ok()?;
        let a = analyze(&train, &Selection::default()).ok()?;
        Some(a.operations[0].clone())
    }
}

fn plain(k: usize) -> String {
    NAMES[k].to_owned()
}

/// Everything that one solution must obey by itself.
fn check(s: &SolutionReport) -> Result<(), TestCaseError> {
    let size = s.input_power_w.abs().max(s.output_power_w.abs());
    // The largest power anywhere sets the round-off, not the power of the terminals.
    let inside = s.meshes.iter().fold(size, |a, (_, m)| a.max(m.potential_power_w));
    prop_assert!(s.power_residual_w.abs() <= 1e-12 * inside, "residual {} of {inside}", s.power_residual_w);
    let mut sum = 0.0;
    for (name, m) in s.meshes.iter() {
        prop_assert!(m.loss_w >= 0.0, "{name}: {m:?}");
        prop_assert!((m.loss_w - (1.0 - m.efficiency) * m.potential_power_w).abs() <= 1e-12 * inside);
        sum += m.loss_w;
    }
    prop_assert!((sum - s.loss_w).abs() <= 1e-12 * inside);
    if let Some(e) = s.efficiency {
        prop_assert!((0.0..=1.0).contains(&e));
    }
    prop_assert_eq!(s.all_dissipated, s.members.iter().all(|(_, m)| m.role != Role::Output) && size > 0.0);
    Ok(())
}

/// One gear pair on its carrier, for the brute force.
struct Pair {
    p: usize,
    q: usize,
    c: usize,
    a: f64,
    b: f64,
    eta: f64,
}

/// Torque at the input for every consistent sign vector; `None` when a case is too close to call
/// in floating point.
fn brute_force(t: &RandomTrain, o: &OperationReport, load: f64) -> Option<Vec<f64>> {
    let n = t.members();
    let total = n + t.sets.len();
    let speed = |m: usize| {
        let name = if m < n { plain(m) } else { format!("P{}.planet", m - n) };
        o.speeds_rad_s.get(&name).copied().flatten().unwrap()
    };
    let mut pairs = Vec::new();
    for (k, s) in t.sets.iter().enumerate() {
        let [x, y, c] = s.members;
        let [zx, zy, p, q] = s.teeth.map(|z| z as f64);
        let eta = s.eta[0] as f64 / 1000.0;
        pairs.push(Pair { p: x, q: n + k, c, a: zx, b: p, eta });
        let b = if s.ring { -(zy + q) } else { zy };
        pairs.push(Pair { p: n + k, q: y, c, a: q, b, eta });
    }
    let rows: Vec<usize> = (2..total).collect();
    let k = pairs.len();
    assert_eq!(rows.len(), k);
    let sigma: Vec<f64> = pairs.iter().map(|e| (speed(e.p) - speed(e.c)) * e.a).collect();
    let largest = sigma.iter().fold(0.0f64, |a, s| a.max(s.abs()));
    if sigma.iter().any(|s| s.abs() < 1e-9 * largest) {
        return None;
    }
    let mut found = Vec::new();
    for mask in 0..1u32 << k {
        let rho: Vec<f64> =
            pairs.iter().enumerate().map(|(j, e)| if mask >> j & 1 == 0 { e.eta } else { 1.0 / e.eta }).collect();
        let mut m = vec![vec![0.0; k + 1]; k];
        for (j, e) in pairs.iter().enumerate() {
            for (member, x) in [(e.p, e.a), (e.q, e.b * rho[j]), (e.c, -(e.a + e.b * rho[j]))] {
                if member >= 2 {
                    m[member - 2][j] += x;
                }
            }
        }
        m[0][k] = load;
        let f = gauss(m)?;
        let size = f.iter().fold(0.0f64, |a, x| a.max(x.abs()));
        let mut fits = true;
        for j in 0..k {
            if f[j].abs() < 1e-9 * size {
                return None;
            }
            fits &= (f[j] * sigma[j] > 0.0) == (mask >> j & 1 == 0);
        }
        if fits {
            found.push(
                pairs
                    .iter()
                    .enumerate()
                    .flat_map(|(j, e)| {
                        [(e.p, e.a * f[j]), (e.q, e.b * rho[j] * f[j]), (e.c, -(e.a + e.b * rho[j]) * f[j])]
                    })
                    .filter(|(m, _)| *m == 1)
                    .map(|(_, x)| x)
                    .sum(),
            );
        }
    }
    Some(found)
}

fn gauss(mut m: Vec<Vec<f64>>) -> Option<Vec<f64>> {
    let n = m.len();
    for c in 0..n {
        let pivot = (c..n).max_by(|&a, &b| m[a][c].abs().total_cmp(&m[b][c].abs()))?;
        m.swap(c, pivot);
        let row_size = m[c][..n].iter().fold(0.0f64, |a, x| a.max(x.abs()));
        if m[c][c].abs() < 1e-9 * row_size.max(1.0) {
            return None;
        }
        for r in c + 1..n {
            let factor = m[r][c] / m[c][c];
            for k in c..=n {
                m[r][k] -= factor * m[c][k];
            }
        }
    }
    let mut x = vec![0.0; n];
    for c in (0..n).rev() {
        x[c] = (m[c][n] - (c + 1..n).map(|k| m[c][k] * x[k]).sum::<f64>()) / m[c][c];
    }
    Some(x)
}

fn efficiencies(o: &OperationReport) -> Vec<f64> {
    o.solutions.iter().map(|s| s.efficiency.unwrap_or(-1.0)).collect()
}

static COMPARED: AtomicUsize = AtomicUsize::new(0);
static UNCERTIFIED: AtomicUsize = AtomicUsize::new(0);

#[test]
fn prop_answers_equal_brute_force() {
    answers_equal_brute_force();
    // The property is not vacuous.
    let (all, odd) = (COMPARED.load(Ordering::Relaxed), UNCERTIFIED.load(Ordering::Relaxed));
    assert!(all > 300 && odd > 10, "{all} trains were compared, {odd} of them without certificate");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, max_global_rejects: 100_000, ..ProptestConfig::default() })]

    #[test]
    fn prop_power_closes_and_losses_are_mesh_losses(t in random_train(1..=5)) {
        let Some(o) = t.run(&plain, false, 1.0, false) else { return Ok(()) };
        for s in o.solutions.iter().chain(&o.dissipative_solutions) {
            check(s)?;
        }
        match o.verdict {
            Verdict::Unique => prop_assert_eq!(o.solutions.len(), 1),
            Verdict::Multiple => prop_assert!(o.solutions.len() > 1),
            Verdict::Locked => prop_assert!(o.solutions.is_empty()),
            _ => {}
        }
        if o.certificate.is_some_and(|c| c.unique_for_every_load) {
            prop_assert!(o.verdict == Verdict::Unique || o.dissipative_solutions.len() == 1, "{:?}", o.verdict);
        }
    }

    #[test]
    fn prop_lossless_limit_is_virtual_work(t in random_train(1..=5)) {
        let Some(o) = t.run(&plain, true, 1.0, false) else { return Ok(()) };
        if o.verdict == Verdict::Undetermined {
            return Ok(());
        }
        prop_assert_eq!(o.verdict, Verdict::Unique);
        prop_assert!(o.certificate.unwrap().unique_for_every_load);
        let s = &o.solutions[0];
        prop_assert!((s.efficiency.unwrap() - 1.0).abs() < 1e-11, "{:?}", s.efficiency);
        let power = |m: usize| s.members.get(&plain(m)).unwrap().power_w.unwrap();
        // As in `check`: the largest power anywhere sets the round-off. Where power circulates it is
        // many thousand times the power of the terminals, which are then a small difference.
        let inside = s.meshes.iter().fold(power(1).abs(), |a, (_, m)| a.max(m.potential_power_w));
        prop_assert!((power(1) + power(2)).abs() <= 1e-12 * inside, "{} {} of {inside}", power(1), power(2));
    }

    #[test]
    fn prop_relabelling_reversal_and_scaling_change_nothing(t in random_train(1..=4)) {
        let Some(o) = t.run(&plain, false, 1.0, false) else { return Ok(()) };
        // Names that sort the other way round: members get other numbers inside.
        let other = |k: usize| format!("z{}", 9 - k);
        for again in [
            t.run(&other, false, 1.0, false),
            t.run(&plain, false, 8.0, false),
            t.run(&plain, false, 1.0, true),
        ] {
            let again = again.expect("the same train");
            prop_assert_eq!(again.verdict, o.verdict);
            prop_assert_eq!(again.certificate, o.certificate);
            for (a, b) in efficiencies(&again).iter().zip(efficiencies(&o)) {
                prop_assert!((a - b).abs() <= 1e-9 * b.abs().max(1e-3), "{a} {b}");
            }
        }
    }

    fn answers_equal_brute_force(t in random_train(1..=3)) {
        let Some(o) = t.run(&plain, false, 1.0, false) else { return Ok(()) };
        if o.verdict == Verdict::Undetermined {
            return Ok(());
        }
        let w_out = o.speeds_rad_s.get(&plain(2)).copied().flatten().unwrap();
        let load = -w_out.signum() * t.torque as f64;
        let Some(mut expected) = brute_force(&t, &o, load) else { return Ok(()) };
        let mut found: Vec<f64> = o
            .solutions
            .iter()
            .chain(&o.dissipative_solutions)
            .map(|s| s.members.get(&plain(1)).unwrap().torque_n_m.unwrap())
            .collect();
        expected.sort_by(f64::total_cmp);
        found.sort_by(f64::total_cmp);
        prop_assert_eq!(found.len(), expected.len(), "{:?}: {:?} {:?}", o.verdict, found, expected);
        COMPARED.fetch_add(1, Ordering::Relaxed);
        UNCERTIFIED.fetch_add(usize::from(!o.certificate.unwrap().unique_for_every_load), Ordering::Relaxed);
        for (a, b) in found.iter().zip(&expected) {
            prop_assert!((a - b).abs() <= 1e-6 * b.abs().max(1e-9), "{a} {b}");
        }
    }

    /// Adding one speed to every shaft changes no relative speed, so no tooth force and no loss.
    #[test]
    fn prop_a_rotating_frame_changes_no_loss(t in random_train(1..=3), shift in -500i64..500) {
        let terminals: Vec<String> = (0..3).map(plain).collect();
        let at = |w0: f64, w1: f64| {
            let train = t
                .builder(&plain, false)
                .terminals(terminals.iter().map(String::as_str))
                .operation(
                    OperationSpec::new("frame")
                        .speed("m0", AngularSpeed::rad_s(w0))
                        .speed("m1", AngularSpeed::rad_s(w1))
                        .torque("m1", Torque::n_m(t.torque as f64)),
                )
                .build()
                .ok()?;
            Some(analyze(&train, &Selection::default()).ok()?.operations[0].clone())
        };
        let shift = shift as f64;
        let (Some(a), Some(b)) = (at(17.0, 17.0 + t.speed as f64), at(17.0 + shift, 17.0 + shift + t.speed as f64)) else {
            return Ok(());
        };
        prop_assert_eq!(a.verdict, b.verdict);
        // Several solutions come sorted by efficiency, which depends on the frame; losses do not.
        let by_loss = |o: &OperationReport| {
            let mut all = o.solutions.clone();
            all.sort_by(|x, y| x.loss_w.total_cmp(&y.loss_w));
            all
        };
        for (x, y) in by_loss(&a).iter().zip(&by_loss(&b)) {
            for ((_, m), (_, n)) in x.meshes.iter().zip(y.meshes.iter()) {
                let size = m.potential_power_w.max(n.potential_power_w);
                prop_assert!((m.loss_w - n.loss_w).abs() <= 1e-9 * size, "{m:?} {n:?}");
            }
        }
    }
}
