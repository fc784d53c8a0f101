//! Cases of an independent program, and properties of random trains.

use serde_json::Value;

use crate::exact::Rational;

use super::{Amount, Body, Decision, Element, Inertia, Load, Mesh, Motion, Problem, Verdict};

fn number(v: &Value) -> f64 {
    v.as_f64().expect("a number")
}

fn exact(v: &Value) -> Rational {
    Rational::from_f64(number(v)).expect("finite")
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
    let mut load = Load::of(&problem);
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
    let data: Value = serde_json::from_str(include_str!("../../../tests/motion/modes.json")).expect("cases");
    for case in data["cases"].as_array().expect("cases") {
        let (names, problem, load) = read(case);
        let mut decision = Decision::new(&problem);
        let verdict = decision.decide(&load);
        println!("{} {verdict:?}", case["name"]);
        match case["solutions"].as_array() {
            None => {
                assert_eq!(verdict, Verdict::One { proved: true }, "{}", case["name"]);
                compare(case, &names, &problem, decision.motion());
                // From this mode again.
                assert_eq!(decision.decide(&load), verdict);
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
