//! Closed formulas and exact enumerations of others against the solver.
//!
//! A set (a, b, c; R; η0) obeys `ω_b − ω_c = R (ω_a − ω_c)` and loses `1 − η0` between a and b with c
//! held. Here it is a stepped set: two suns on planets of one step, `R = z_a/z_b`.

use serde_json::Value;
use willis::analysis::{Analysis, Direction, Selection, Verdict, analyze};
use willis::exact::Rational;
use willis::train::{EfficiencySpec, OperationSpec, SetSpec, ShiftElementSpec, Specification, StateSpec, Train};
use willis::units::{AngularSpeed, Torque};

use crate::common::Dice;

fn set(name: &str, [a, b, c]: [&str; 3], r: (i64, i64), eta: Rational) -> SetSpec {
    if r.0 < 0 {
        // A ring turns the sign.
        return SetSpec::simple(name, (a, -r.0), (b, r.1), c).basic_efficiency(EfficiencySpec::from(eta));
    }
    SetSpec::stepped(name, c).sun(a, r.0, 20).sun(b, r.1, 20).basic_efficiency(EfficiencySpec::from(eta))
}

fn analysis(builder: Specification) -> Analysis {
    analyze(&builder.build().unwrap(), &Selection::default()).unwrap()
}

/// The six inversions of one set: link 1 = a, link 4 = b, link 2 = carrier, as states with one
/// link held.
fn inversions(r: (i64, i64), eta: f64) -> Vec<Direction> {
    let eta = Rational::from_f64(eta).unwrap();
    let mut builder = Train::builder("set").members(["1", "4", "2"]).terminals(["1", "4", "2"]).set(set(
        "P",
        ["1", "4", "2"],
        r,
        eta,
    ));
    for (held, input, output) in [("2", "1", "4"), ("4", "1", "2"), ("1", "4", "2")] {
        builder = builder
            .shift_element(ShiftElementSpec::brake(held, held))
            .state(StateSpec::new(held, [held]).between(input, output));
    }
    let a = analysis(builder);
    a.ratios.iter().flat_map(|(_, s)| [s.drive.clone(), s.coast.clone()]).collect()
}

/// Closed forms of Macmillan, Radzimovsky, Pennestrì and Freudenstein, del Castillo for the six
/// drives 1→4, 4→1, 1→2, 2→1, 4→2, 2→4; with equal efficiency both ways. ≤ 0: locked.
fn closed_forms(r: f64, e: f64) -> [f64; 6] {
    let above = r > 1.0;
    let one_drives = [(e - r) / (1.0 - r), (e * r - 1.0) / (e * (r - 1.0))];
    [
        e,
        e,
        one_drives[usize::from(above)],
        if above { (r - 1.0) / (r - e) } else { e * (1.0 - r) / (1.0 - e * r) },
        if above {
            (e * r - 1.0) / (r - 1.0)
        } else if r < 0.0 {
            (1.0 - e * r) / (1.0 - r)
        } else {
            (e - r) / (e * (1.0 - r))
        },
        if above {
            e * (r - 1.0) / (r - e)
        } else if r < 0.0 {
            e * (1.0 - r) / (e - r)
        } else {
            (1.0 - r) / (1.0 - e * r)
        },
    ]
}

fn compare(found: &[Direction], expected: &[f64; 6], tolerance: f64, what: &str) {
    for (k, (d, e)) in found.iter().zip(expected).enumerate() {
        if *e > 0.0 {
            assert_eq!(d.verdict, Verdict::Unique, "{what}, drive {k}: {d:?}, expected {e}");
            assert!((d.efficiency.unwrap() - e).abs() < tolerance, "{what}, drive {k}: {d:?}, expected {e}");
        } else {
            assert_eq!(d.verdict, Verdict::Locked, "{what}, drive {k}: expected locked ({e})");
        }
    }
}

#[test]
fn val_table_of_six_inversions() {
    // Printed to six digits; "locked" as 0.
    for (r, eta, printed) in [
        ((-30, 78), 0.9702, [0.970200, 0.970200, 0.978478, 0.978298, 0.991722, 0.991540]),
        ((-30, 60), 0.95, [0.95, 0.95, 0.966667, 0.966102, 0.983333, 0.982759]),
        ((60, 20), 0.95, [0.95, 0.95, 0.973684, 0.975610, 0.925000, 0.926829]),
        ((20, 40), 0.95, [0.95, 0.95, 0.900000, 0.904762, 0.947368, 0.952381]),
        ((51, 50), 0.95, [0.95, 0.95, 0.0, 0.285714, 0.0, 0.271429]),
        ((21, 20), 0.95, [0.95, 0.95, 0.0, 0.500000, 0.0, 0.475000]),
    ] {
        compare(&inversions(r, eta), &printed, 0.5e-6 + 1e-12, &format!("R = {r:?}"));
    }
}

#[test]
fn val_closed_forms_on_a_thousand_sets() {
    let mut dice = Dice(1);
    let mut next = |n: u64| dice.below(n);
    let mut locked = 0;
    for _ in 0..1000 {
        let (a, b) = (15 + next(80) as i64, 15 + next(80) as i64);
        let ring = next(3) == 0;
        let r = if ring { (-a, a + b) } else { (a, b) };
        if a == b && !ring {
            continue;
        }
        let eta = (800 + next(199)) as f64 / 1000.0;
        let expected = closed_forms(r.0 as f64 / r.1 as f64, eta);
        // Exactly on a threshold the closed form is 0 up to round-off; the solver says locked.
        let expected = expected.map(|e| if e.abs() < 1e-12 { 0.0 } else { e });
        locked += expected.iter().filter(|e| **e <= 0.0).count();
        compare(&inversions(r, eta), &expected, 1e-11, &format!("R = {r:?}, η0 = {eta}"));
    }
    assert!(locked > 20, "{locked} locked drives were met");
}

fn reference(name: &str) -> Value {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../validation/reference/");
    serde_json::from_str(&std::fs::read_to_string(format!("{path}{name}")).unwrap()).unwrap()
}

fn fraction(v: &Value) -> Rational {
    v["frac"].as_str().unwrap().parse().unwrap()
}

#[test]
fn val_several_solutions_exactly() {
    let data = reference("several-solutions.json");
    let names = ["n0", "n1", "n2", "n3", "n4", "n5"];
    for example in data["examples"].as_array().unwrap() {
        let label = example["name"].as_str().unwrap();
        let node = |v: &Value| names[v.as_u64().unwrap() as usize];
        let (input, output, ground) = (node(&example["input"]), node(&example["output"]), node(&example["ground"]));
        let w_out: Rational = fraction(&example["speeds"][example["output"].as_u64().unwrap() as usize]);
        let mut builder = Train::builder(label).members(names).terminals([input, output]);
        for (k, s) in example["sets"].as_array().unwrap().iter().enumerate() {
            let r = s["R"]["frac"].as_str().unwrap().split_once('/').unwrap();
            let r = (r.0.parse().unwrap(), r.1.parse().unwrap());
            let parts = [node(&s["a"]), node(&s["b"]), node(&s["c"])];
            builder = builder.set(set(&format!("P{k}"), parts, r, fraction(&s["eta"])));
        }
        // A resisting load at the output, the input's torque open.
        let resisting = -f64::from(w_out.sign());
        let train = builder
            .shift_element(ShiftElementSpec::brake("G", ground))
            .state(StateSpec::new("on", ["G"]))
            .operation(
                OperationSpec::new("load")
                    .state("on")
                    .speed(input, AngularSpeed::rad_s(1.0))
                    .torque(output, Torque::n_m(resisting)),
            )
            .build()
            .unwrap();
        let a = analyze(&train, &Selection::default()).unwrap();
        let row = a.ratios.get("on").unwrap();
        let expected_ratio = fraction(&example["ratio"]);
        assert_eq!(row.exact.as_ref(), Some(&expected_ratio), "{label}");
        let mut expected: Vec<Rational> =
            example["load_solutions"].as_array().unwrap().iter().map(|s| fraction(&s["efficiency"])).collect();
        expected.sort();
        let operation = &a.operations[0];
        match expected.len() {
            0 => assert_eq!((row.drive.verdict, operation.verdict), (Verdict::Locked, Verdict::Locked), "{label}"),
            1 => assert_eq!((row.drive.verdict, operation.verdict), (Verdict::Unique, Verdict::Unique), "{label}"),
            _ => assert_eq!((row.drive.verdict, operation.verdict), (Verdict::Multiple, Verdict::Multiple), "{label}"),
        }
        assert_eq!(row.drive.efficiencies.len(), expected.len(), "{label}");
        for ((found, solution), e) in row.drive.efficiencies.iter().zip(&operation.solutions).zip(&expected) {
            assert!((found - e.to_f64()).abs() < 1e-14, "{label}: {found} {e}");
            if let Some(exact) = &solution.efficiency_exact {
                assert_eq!(exact, e, "{label}");
            } else {
                assert!((solution.efficiency.unwrap() - e.to_f64()).abs() < 1e-13, "{label}");
            }
            assert!(solution.power_residual_w.abs() <= 1e-12 * solution.input_power_w.abs());
        }
        let certified = operation.certificate.unwrap();
        assert_eq!(certified.unique_for_every_load, example["w_property"].as_bool().unwrap(), "{label}");
    }
    for example in data["gear_pair_level"].as_array().unwrap() {
        let z = |k: &str| example["teeth"][k].as_i64().unwrap();
        let eta = |k: usize| example["mesh_eta"][k].as_f64().unwrap();
        let a = analysis(
            Train::builder("gear pairs")
                .members(["O", "I", "X"])
                .terminals(["I", "O"])
                .set(
                    SetSpec::stepped("A", "X")
                        .sun("O", z("O"), z("pA"))
                        .sun("I", z("I"), z("pA"))
                        .mesh_efficiency(eta(0)),
                )
                .set(
                    SetSpec::stepped("B", "X")
                        .sun("frame", z("G"), z("pB"))
                        .sun("O", z("O2"), z("pB"))
                        .mesh_efficiency(eta(1)),
                ),
        );
        let row = &a.ratios.0[0].1;
        let mut forward: Vec<f64> =
            example["forward"].as_array().unwrap().iter().map(|v| fraction(v).to_f64()).collect();
        forward.sort_by(f64::total_cmp);
        assert_eq!(row.drive.verdict, Verdict::Multiple);
        assert_eq!(row.coast.verdict, Verdict::Locked);
        for (found, e) in row.drive.efficiencies.iter().zip(&forward) {
            assert!((found - e).abs() < 1e-14);
        }
    }
}

/// Wolfrom 3K: sun 12, planets 36/35, rings 84 (fixed)/83. With equal mesh efficiencies it locks below
/// 0.991935, where forward efficiency is 49.70 %; 12, 24/23, 60/59: 0.987206, 49.57 %.
#[test]
fn val_wolfrom_locks_at_the_threshold() {
    for (planets, rings, threshold, forward) in
        [((36, 35), (84, 83), 0.991935, 0.4970), ((24, 23), (60, 59), 0.987206, 0.4957)]
    {
        let at = |eta: f64| {
            let a = analysis(
                Train::builder("Wolfrom").members(["s", "r", "c"]).terminals(["s", "r"]).set(
                    SetSpec::stepped("P", "c")
                        .sun("s", 12, planets.0)
                        .ring("frame", rings.0, planets.0)
                        .ring("r", rings.1, planets.1)
                        .mesh_efficiency(eta),
                ),
            );
            a.ratios.0[0].1.clone()
        };
        let (below, above) = (at(threshold - 1e-6), at(threshold + 1e-6));
        assert_eq!(below.coast.verdict, Verdict::Locked);
        assert_eq!(above.coast.verdict, Verdict::Unique);
        assert!((above.drive.efficiency.unwrap() - forward).abs() < 0.5e-4 + 1e-5);
    }
}

/// Every regime of the reference enumeration (roles of the three terminals by speed order).
#[test]
fn val_regimes_of_the_reference() {
    let data = reference("regimes.json");
    let mut count = 0;
    for regime in data["regimes"].as_array().unwrap() {
        // One R per case; speeds in the printed order, with ω4 from R.
        let eta = 0.95;
        let r: (i64, i64) = match regime["case"].as_str().unwrap() {
            "R>1" => (60, 20),
            "0<R<1" => (20, 40),
            "R<0" => (-30, 60),
            "1<R<1/eta (band)" => (51, 50),
            "eta<R<1 (band)" => (50, 51),
            other => panic!("unknown case {other}"),
        };
        let ratio = r.0 as f64 / r.1 as f64;
        // ω1 − ω2 = ±1, ω4 − ω2 = ±R, all shifted above zero; the ranges used here end in "> 0".
        let order: Vec<&str> = regime["speeds"].as_str().unwrap().split(" > ").collect();
        assert_eq!(order[3], "0");
        let rank = |w: &str| order.iter().position(|o| *o == w).unwrap();
        let sign = if rank("w1") < rank("w2") { 1.0 } else { -1.0 };
        let relative = [sign, 0.0, sign * ratio];
        let lowest = relative.iter().copied().fold(f64::INFINITY, f64::min);
        let w: Vec<f64> = relative.iter().map(|x| x - lowest + 0.01).collect();
        let t1 = regime["torque_signs"]["T1"].as_f64().unwrap();
        let a = analysis(
            Train::builder("fig. 1")
                .members(["1", "2", "4"])
                .terminals(["1", "2", "4"])
                .set(set("P", ["1", "4", "2"], r, Rational::from_f64(eta).unwrap()))
                .operation(
                    OperationSpec::new("x")
                        .speed("1", AngularSpeed::rad_s(w[0]))
                        .speed("2", AngularSpeed::rad_s(w[1]))
                        .torque("1", Torque::n_m(t1)),
                ),
        );
        let o = &a.operations[0];
        assert_eq!(o.verdict, Verdict::Unique);
        let s = &o.solutions[0];
        for link in ["1", "2", "4"] {
            let m = s.members.get(link).unwrap();
            let torque = regime["torque_signs"][format!("T{link}")].as_f64().unwrap();
            let power = regime["power_signs"][format!("P{link}")].as_f64().unwrap();
            assert_eq!(m.torque_n_m.unwrap().signum(), torque, "{regime}: T{link} = {m:?}");
            assert_eq!(m.power_w.unwrap().signum(), power, "{regime}: P{link} = {m:?}");
        }
        let driver = regime["driver"].as_i64().unwrap().to_string();
        let drives = s.meshes.iter().any(|(_, m)| m.driver.as_deref() == Some(&driver));
        assert!(drives, "{regime}: {:?}", s.meshes);
        count += 1;
    }
    assert_eq!(count, data["regimes"].as_array().unwrap().len());
}

/// Rational thresholds are decided exactly: 255/256 against R = 256/255 gives determinant zero.
#[test]
fn val_lock_exactly_on_the_threshold() {
    // ω_b − ω_c = R (ω_a − ω_c), b held, a drives c: efficiency (ηR − 1)/(η(R − 1)) is 0 at η = 1/R.
    let r = (256, 255);
    for (eta, verdict) in [
        (Rational::new(255, 256), Verdict::Locked),
        (Rational::new(2_550_000_001, 2_560_000_000), Verdict::Unique),
        (Rational::new(2_549_999_999, 2_560_000_000), Verdict::Locked),
    ] {
        let a = analysis(Train::builder("threshold").members(["a", "c"]).terminals(["a", "c"]).set(set(
            "P",
            ["a", "frame", "c"],
            r,
            eta.clone(),
        )));
        let row = &a.ratios.0[0].1;
        assert_eq!(row.drive.verdict, verdict, "{eta}");
        assert_eq!(row.coast.verdict, Verdict::Unique);
    }
}

/// `forward` holds when the first central gear drives, whichever gear its mesh names first.
#[test]
fn directed_basic_efficiency_holds_from_the_first_gear() {
    let eta = || EfficiencySpec::directed(0.9, 0.99);
    let sets = [
        SetSpec::simple("P", ("a", 30), ("b", 70), "c").basic_efficiency(eta()),
        SetSpec::double_planet("P", ("a", 30), ("b", 78), "c").basic_efficiency(eta()),
        SetSpec::stepped("P", "c").ring("a", 70, 20).ring("b", 64, 18).basic_efficiency(eta()),
        SetSpec::stepped("P", "c").sun("a", 30, 20).ring("b", 64, 18).basic_efficiency(eta()),
        SetSpec::bevel("P", "c").side("a", 16, true).side("b", 18, false).planet(10, 2).basic_efficiency(eta()),
        SetSpec::bevel("P", "c").side("a", 16, false).side("b", 18, true).planet(10, 2).basic_efficiency(eta()),
    ];
    for set in sets {
        let a = analysis(
            Train::builder("directed")
                .members(["a", "b", "c"])
                .terminals(["a", "b"])
                .set(set.clone())
                .shift_element(ShiftElementSpec::brake("C", "c"))
                .state(StateSpec::new("on", ["C"])),
        );
        let row = &a.ratios.0[0].1;
        let near = |x: Option<f64>, y: f64| assert!((x.unwrap() - y).abs() < 1e-12, "{set:?}: {x:?}");
        near(row.drive.efficiency, 0.9);
        near(row.coast.efficiency, 0.99);
    }
}

/// A one-way clutch holds the carrier against turning backward: it carries drive and overruns in
/// coast, where no efficiency exists.
#[test]
fn a_one_way_clutch_carries_one_direction() {
    let a = analysis(
        Train::builder("one-way")
            .members(["s", "r", "c"])
            .terminals(["s", "r"])
            .set(SetSpec::simple("P", ("s", 30), ("r", 70), "c").mesh_efficiency(0.99))
            // Sun forward, ring backward: the carrier is pushed backward by both.
            .shift_element(ShiftElementSpec::one_way("F", "r", "frame"))
            .shift_element(ShiftElementSpec::brake("B", "r"))
            .state(StateSpec::new("free", ["F"]).between("s", "c"))
            .state(StateSpec::new("held", ["B"]).between("s", "c")),
    );
    let (free, held) = (a.ratios.get("free").unwrap(), a.ratios.get("held").unwrap());
    assert_eq!(free.drive.efficiency, held.drive.efficiency);
    assert_eq!(held.coast.verdict, Verdict::Unique);
    assert_eq!(free.coast.verdict, Verdict::Undetermined);
    assert!(free.coast.reason.as_ref().unwrap().contains("overruns"), "{free:?}");
}
