//! Cases of an independent program, and properties of random trains.

use serde_json::Value;

use crate::exact::Rational;

use super::certificate::ways;
use super::equations::Equations;
use super::motion::Amount;
use super::{Body, Decision, Element, Inertia, Load, Mesh, Motion, Problem, Verdict};

fn number(v: &Value) -> f64 {
    v.as_f64().expect("a number")
}

fn exact(v: &Value) -> Rational {
    Rational::from_f64(number(v)).expect("finite")
}

fn no_load(problem: &Problem) -> Load {
    let (n, k) = (problem.members, problem.elements.len());
    Load {
        torques: vec![[0.0; 2]; n],
        capacities: vec![[[0.0; 2]; 2]; k],
        accelerations: vec![[0.0; 2]; k],
        slips: vec![],
    }
}

/// A case: members by name, the problem and the load.
fn read(case: &Value) -> (Vec<String>, Problem, Load) {
    let names: Vec<String> = case["inertias"].as_object().expect("members").keys().cloned().collect();
    let body = |v: &Value| -> Body {
        let name = v.as_str().expect("a name");
        (name != "frame").then(|| names.iter().position(|n| n == name).expect("known"))
    };
    let speed = |b: Body| b.map_or(0.0, |i| case["speeds"].get(&names[i]).map_or(0.0, number));
    let mut problem = Problem { members: names.len(), ..Problem::default() };
    for (i, name) in names.iter().enumerate() {
        problem.inertias.push(Inertia { member: i, reference: None, value: number(&case["inertias"][name]) });
    }
    for m in case["meshes"].as_array().expect("meshes") {
        let bodies = ["gear_1", "gear_2", "carrier"].map(|k| body(&m[k]));
        let slip = speed(bodies[0]) - speed(bodies[2]);
        problem.meshes.push(Mesh {
            bodies,
            factors: [exact(&m["z_1"]), exact(&m["s_z_2"])],
            efficiency: [exact(&m["eta_12"]), exact(&m["eta_21"])],
            slip: if slip == 0.0 { 0 } else { slip.signum() as i8 },
        });
    }
    let mut capacities = Vec::new();
    let mut loads: Vec<(Body, f64, f64)> = Vec::new();
    for e in case["elements"].as_array().expect("elements") {
        let bodies = ["first", "second"].map(|k| body(&e[k]));
        let rate = case["capacity_rates"].get(e["name"].as_str().expect("a name")).map_or(0.0, number);
        let slip = speed(bodies[0]) - speed(bodies[1]);
        match e["capacity"].as_f64() {
            Some(c) if slip != 0.0 => {
                for (body, sign) in [(bodies[0], -slip.signum()), (bodies[1], slip.signum())] {
                    loads.push((body, sign * c, sign * rate));
                }
            }
            c => {
                problem.elements.push(Element { bodies, yields: [c.is_some(); 2] });
                capacities.push([[c.unwrap_or(0.0), rate]; 2]);
            }
        }
    }
    let mut load = no_load(&problem);
    load.capacities = capacities;
    for (which, key) in ["torques", "torque_rates"].into_iter().enumerate() {
        for (name, t) in case[key].as_object().into_iter().flatten() {
            load.torques[names.iter().position(|n| n == name).expect("known")][which] += number(t);
        }
    }
    for (body, torque, rate) in loads {
        if let Some(b) = body {
            load.torques[b][0] += torque;
            load.torques[b][1] += rate;
        }
    }
    (names, problem, load)
}

/// Within the digits of the case and the rounding that the answer says it has.
fn close(a: f64, b: f64, error: f64) -> bool {
    (a - b).abs() <= 1e-13 * b.abs() + error
}

fn compare(case: &Value, names: &[String], problem: &Problem, motion: &Motion) {
    let name = &case["name"];
    for (i, member) in names.iter().enumerate() {
        let want = number(&case["accelerations"][member]);
        let got = motion.accelerations[i];
        assert!(close(got.value, want, got.error), "{name}: {member} {got:?} {want}");
        if let Some(want) = case["acceleration_rates"].get(member).map(number) {
            assert!(close(got.rate, want, got.rate_error), "{name}: rate of {member} {got:?} {want}");
        }
    }
    let sign = |mode: &str| if mode.ends_with('+') { 1 } else { -i8::from(mode.ends_with('-')) };
    for (k, want) in case["mesh_answers"].as_array().expect("meshes").iter().enumerate() {
        let (got, mesh) = (motion.meshes[k], &problem.meshes[k]);
        assert_eq!(got.slip, sign(want["mode"].as_str().expect("a mode")), "{name}: mesh {k} {got:?}");
        for (side, key) in ["t_1", "t_2"].into_iter().enumerate() {
            if let Some(t) = want[key].as_f64() {
                let is = got.forces[side].value * mesh.factors[side].to_f64();
                let error = got.forces[side].error * mesh.factors[side].to_f64().abs();
                assert!(close(is, t, error), "{name}: {key} of mesh {k} {is} {t}");
            }
        }
        if let Some(driver) = want["driver"].as_u64() {
            assert_eq!(got.first_drives, driver == 1, "{name}: mesh {k} {got:?}");
        }
    }
    let joined = case["elements"].as_array().expect("elements").iter();
    let joined = joined.filter(|e| case["element_answers"][e["name"].as_str().expect("a name")]["mode"] != "slides");
    for (e, got) in joined.zip(&motion.elements) {
        let want = &case["element_answers"][e["name"].as_str().expect("a name")];
        assert_eq!(got.slip, sign(want["mode"].as_str().expect("a mode")), "{name}: {} {got:?}", e["name"]);
        if let Some(t) = want["torque_on_first"].as_f64() {
            assert!(close(got.torque.value, t, got.torque.error), "{name}: {} {got:?} {t}", e["name"]);
        }
    }
}

#[test]
fn val_modes_of_an_independent_program() {
    let data: Value = serde_json::from_str(include_str!("modes.json")).expect("cases");
    for case in data["cases"].as_array().expect("cases") {
        let (names, problem, load) = read(case);
        let mut decision = Decision::new(&problem);
        let verdict = decision.decide(&load, false);
        match case["solutions"].as_array() {
            None => {
                assert_eq!(verdict, Verdict::One { proved: true }, "{}", case["name"]);
                compare(case, &names, &problem, decision.motion());
                // From this mode again.
                assert_eq!(decision.decide(&load, false), verdict);
                compare(case, &names, &problem, decision.motion());
            }
            Some(solutions) => {
                assert_eq!(verdict, Verdict::Two, "{}", case["name"]);
                let of = |m: &Motion| m.accelerations.clone();
                let found = [of(decision.motion()), of(decision.second())];
                for want in solutions {
                    let agrees =
                        |f: &Vec<Amount>| names.iter().zip(f).all(|(n, a)| close(a.value, number(&want[n]), a.error));
                    assert!(found.iter().any(agrees), "{}: {found:?} {want}", case["name"]);
                }
            }
        }
    }
}

/// Numbers that look random and are the same in every run.
struct Dice(u64);

impl Dice {
    fn below(&mut self, n: usize) -> usize {
        // SplitMix64.
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % n as u64) as usize
    }

    fn one_in(&mut self, n: usize) -> bool {
        self.below(n) == 0
    }

    fn between(&mut self, least: i64, most: i64) -> f64 {
        (least + self.below((most - least + 1) as usize) as i64) as f64
    }
}

/// Sets of which each has two shafts with others in common, elements between them, some of them redundant; massless
/// planets, and shafts that only touch others.
fn random_problem(dice: &mut Dice, sets: usize) -> Problem {
    let shafts = 2 + sets;
    let mut problem = Problem { members: shafts + sets, ..Problem::default() };
    let resting = dice.one_in(2);
    for set in 0..sets {
        let mut of = vec![dice.below(2 + set), 2 + set];
        while of.len() < 3 {
            let next = dice.below(2 + set);
            if !of.contains(&next) {
                of.push(next);
            }
        }
        of.rotate_left(dice.below(3));
        let [sun, ring, carrier, planet] = [of[0], of[1], of[2], shafts + set].map(Some);
        let (z, p) = (20 + dice.below(30) as i64, 15 + dice.below(20) as i64);
        let slip = if resting || dice.one_in(4) { 0 } else { [-1, 1][dice.below(2)] };
        let lossless = dice.one_in(8);
        let mut efficiency = || if lossless { Rational::ONE } else { Rational::new(960 + dice.below(36) as i64, 1000) };
        let [outer, inner] = [[efficiency(), efficiency()], [efficiency(), efficiency()]];
        let factors = |a: i64, b: i64| [a, b].map(Rational::from);
        let (a, b) = ([sun, planet, carrier], [planet, ring, carrier]);
        problem.meshes.push(Mesh { bodies: a, factors: factors(z, p), efficiency: outer, slip });
        problem.meshes.push(Mesh { bodies: b, factors: factors(p, -(z + 2 * p)), efficiency: inner, slip: -slip });
    }
    for member in 0..shafts {
        let value = if dice.one_in(8) { 0.0 } else { dice.between(1, 40) / 100.0 };
        problem.inertias.push(Inertia { member, reference: None, value });
    }
    for _ in 0..1 + dice.below(2 + sets) {
        let first = dice.below(shafts);
        let second = Some(dice.below(shafts)).filter(|&s| s != first && !dice.one_in(2));
        let yields = [[true; 2], [true; 2], [false; 2], [true, false], [false, true]][dice.below(5)];
        problem.elements.push(Element { bodies: [Some(first), second], yields });
    }
    problem
}

fn random_load(dice: &mut Dice, problem: &Problem) -> Load {
    let mut load = no_load(problem);
    let shafts = problem.inertias.len();
    for t in &mut load.torques[..shafts] {
        if !dice.one_in(3) {
            *t = [dice.between(-300, 300) / 7.0, dice.between(-300, 300)];
        }
    }
    for c in &mut load.capacities {
        *c = [[dice.between(1, 300), dice.between(-9, 9)]; 2];
    }
    load
}

/// Every equation and every complementarity, from the problem itself, within the bounds that the answer states.
fn assert_motion(problem: &Problem, load: &Load, motion: &Motion) {
    let a = |b: Body| b.map_or((0.0, 0.0), |i| (motion.accelerations[i].value, motion.accelerations[i].error));
    let mut sums: Vec<(f64, f64)> = load.torques.iter().map(|t| (t[0], t[0].abs() * 1e-15)).collect();
    let mut add = |b: Body, factor: f64, (value, error): (f64, f64)| {
        if let Some(i) = b {
            sums[i].0 += factor * value;
            sums[i].1 += factor.abs() * (error + 1e-15 * value.abs());
        }
    };
    let vanishes = |terms: &[(f64, (f64, f64))], what: &str| {
        let sum: f64 = terms.iter().map(|(k, (x, _))| k * x).sum();
        let bound: f64 = terms.iter().map(|(k, (x, e))| k.abs() * (e + 1e-15 * x.abs())).sum();
        assert!(sum.abs() <= bound, "{what}: {sum} {bound} {problem:?} {load:?} {motion:?}");
        bound
    };
    for inertia in &problem.inertias {
        add(Some(inertia.member), -inertia.value, a(Some(inertia.member)));
    }
    for (mesh, m) in problem.meshes.iter().zip(&motion.meshes) {
        let [first, second, carrier] = mesh.bodies;
        let [z1, z2] = mesh.factors.clone().map(|z| z.to_f64());
        let [f, e] = m.forces.map(|f| (f.value, f.error));
        add(first, -z1, f);
        add(second, -z2, e);
        add(carrier, z1, f);
        add(carrier, z2, e);
        vanishes(&[(z1, a(first)), (z2, a(second)), (-z1 - z2, a(carrier))], "Willis");
        let [along, back] = [mesh.efficiency[0].to_f64(), 1.0 / mesh.efficiency[1].to_f64()];
        let slip_bound = z1 * (a(first).1 + a(carrier).1) + 1e-15 * z1 * (a(first).0.abs() + a(carrier).0.abs());
        let slip = z1 * (a(first).0 - a(carrier).0);
        let bound = 4.0 * (f.1 + e.1) + 1e-14 * (f.0.abs() + e.0.abs());
        let [drives, is_driven] = [f.0 * along, f.0 * back];
        let sign = if mesh.slip != 0 {
            f64::from(mesh.slip)
        } else if slip.abs() > slip_bound {
            slip.signum()
        } else {
            0.0
        };
        // What the mesh gives back is the less of the two when it turns on, the more when it turns back.
        let [least, most] = [drives.min(is_driven), drives.max(is_driven)];
        let agrees = if sign > 0.0 {
            (e.0 - least).abs() <= bound
        } else if sign < 0.0 {
            (e.0 - most).abs() <= bound
        } else {
            least - bound <= e.0 && e.0 <= most + bound
        };
        assert!(agrees, "friction {f:?} {e:?} {mesh:?} {m:?} {slip} {problem:?} {load:?}");
    }
    for ((element, m), capacity) in problem.elements.iter().zip(&motion.elements).zip(&load.capacities) {
        let t = (m.torque.value, m.torque.error);
        add(element.bodies[0], 1.0, t);
        add(element.bodies[1], -1.0, t);
        let [first, second] = element.bodies.map(a);
        let slip = first.0 - second.0;
        let bound = first.1 + second.1 + 1e-15 * (first.0.abs() + second.0.abs());
        let limit = 2.0 * t.1 + 1e-14 * t.0.abs();
        for (side, sign) in [(0, 1.0), (1, -1.0)] {
            assert!(element.yields[side] || sign * slip <= bound, "a hold slips {slip} {bound} {problem:?} {load:?}");
            assert!(!element.yields[side] || capacity[side][0] + sign * t.0 >= -limit, "beyond its capacity");
            let opposed = sign * slip <= bound || (sign * t.0 + capacity[side][0]).abs() <= limit;
            assert!(opposed, "slips with {t:?} of {capacity:?} {slip} {bound}");
        }
    }
    for (sum, bound) in sums {
        assert!(sum.abs() <= bound, "torques: {sum} {bound} {problem:?} {load:?}");
    }
}

fn same(a: &Motion, b: &Motion) -> bool {
    a.accelerations.iter().zip(&b.accelerations).all(|(x, y)| (x.value - y.value).abs() <= x.error + y.error)
}

/// What is decided about a load, with all that must hold of it.
fn decided(decision: &mut Decision, problem: &Problem, load: &Load) -> Verdict {
    let verdict = decision.decide(load, false);
    match verdict {
        Verdict::One { .. } => assert_motion(problem, load, decision.motion()),
        Verdict::Two => {
            assert_motion(problem, load, decision.motion());
            assert_motion(problem, load, decision.second());
            assert!(!same(decision.motion(), decision.second()), "one motion twice {problem:?} {load:?}");
        }
        Verdict::None | Verdict::Contradiction | Verdict::Undecided => {}
    }
    verdict
}

/// Forces and accelerations times a power of two, as floating-point numbers have it.
fn scaled(load: &Load, by: f64) -> Load {
    let mut load = load.clone();
    load.torques.iter_mut().flatten().for_each(|x| *x *= by);
    load.capacities.iter_mut().flatten().flatten().for_each(|x| *x *= by);
    load
}

/// Whether verdicts agree but for what there was no time to prove.
fn alike(a: Verdict, b: Verdict) -> bool {
    a == b || [a, b].iter().all(|v| matches!(v, Verdict::One { .. }))
}

#[test]
fn random_trains_satisfy_their_equations() {
    let (mut one, mut other) = (0, 0);
    for seed in 0..70 {
        let dice = &mut Dice(seed);
        let sets = 1 + dice.below(4);
        let problem = random_problem(dice, sets);
        let mut warm = Decision::new(&problem);
        let certified = warm.is_certified();
        for _ in 0..4 {
            let load = random_load(dice, &problem);
            let verdict = decided(&mut warm, &problem, &load);
            assert_ne!(verdict, Verdict::Undecided, "{seed}");
            if certified {
                // A load on what has no inertia and is held by nothing has no motion.
                let massive = problem.inertias.iter().all(|i| i.value > 0.0);
                assert!(verdict == Verdict::One { proved: true } || verdict == Verdict::None && !massive, "{seed}");
            }
            *if matches!(verdict, Verdict::One { .. }) { &mut one } else { &mut other } += 1;
            // The mode of the last time is only where it starts from.
            let mut cold = Decision::new(&problem);
            assert!(alike(decided(&mut cold, &problem, &load), verdict), "{seed}");
            if matches!(verdict, Verdict::One { .. }) {
                assert!(same(warm.motion(), cold.motion()), "{seed}: {problem:?} {load:?}");
                // No threshold has a unit.
                for by in [2f64.powi(-40), 2f64.powi(30)] {
                    let mut again = Decision::new(&problem);
                    assert!(alike(again.decide(&scaled(&load, by), false), verdict), "{seed}");
                    let (of, times) = (&cold.motion().accelerations, &again.motion().accelerations);
                    assert!(of.iter().zip(times).all(|(a, b)| a.value * by == b.value), "{seed}: {of:?} {times:?}");
                }
            }
        }
    }
    assert!(one > 4 * other, "{one} of one motion, {other} of none or two");
}

#[test]
fn the_complete_search_finds_what_is_certain() {
    let mut searched = 0;
    for seed in 1000..1200 {
        let dice = &mut Dice(seed);
        let sets = 1 + dice.below(2);
        let problem = random_problem(dice, sets);
        let mut decision = Decision::new(&problem);
        if !decision.is_certified() {
            continue;
        }
        let load = random_load(dice, &problem);
        let known = decision.follow(&load).expect("nothing is prescribed");
        assert!(known, "{seed}");
        for found in [true, false] {
            let motion = decision.motion().clone();
            let verdict = decision.search(&load, found);
            assert!(alike(verdict, Verdict::One { proved: true }), "{seed}: {verdict:?} {problem:?} {load:?}");
            assert!(same(&motion, decision.motion()), "{seed}");
            searched += 1;
        }
    }
    assert!(searched > 100, "{searched}");
}

/// The certificate looks at principal minors over a basis, or at the diagonal; here beside all determinants one by one.
#[test]
fn minors_say_what_determinants_say() {
    let (mut yes, mut no, mut dominated) = (0, 0, 0);
    for seed in 0..600 {
        let dice = &mut Dice(seed);
        let sets = 1 + dice.below(3);
        let mut problem = random_problem(dice, sets);
        // With large losses a train may lock.
        for mesh in problem.meshes.iter_mut().filter(|_| seed % 2 == 1) {
            mesh.efficiency = [0, 1].map(|_| Rational::new(300 + dice.below(600) as i64, 1000));
        }
        let Some((minors, determinants, is_dominated)) = ways(&Equations::new(&problem)) else { continue };
        assert_eq!(minors, determinants, "{seed}");
        assert!(minors || !is_dominated, "{seed}");
        *if minors { &mut yes } else { &mut no } += 1;
        dominated += u32::from(is_dominated);
    }
    assert!(yes > 500 && no > 20 && dominated > 50, "{yes} with one motion, {no} without, {dominated} dominated");
}
