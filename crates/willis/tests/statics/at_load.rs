//! The shift table at a stated load.

use std::f64::consts::PI;

use willis::analysis::{
    AskedLoad, AtLoad, DrivingLoad, Selection, ShaftTableRequest, Verdict, analyze, operate, shaft_table,
};
use willis::operating_point::LossKind;
use willis::train::{Load, Operation, Train};
use willis::units::{AngularSpeed, Temperature, Torque};

use super::common::{example, examples};

fn train_of(file: &str) -> Train {
    Train::from_toml(&example(file)).expect("an example")
}

fn states(train: &Train) -> Vec<Option<usize>> {
    match train.states().len() {
        0 => vec![None],
        n => (0..n).map(Some).collect(),
    }
}

/// What stands beside a gear is the operation of the file that it names, number for number, where that runs in this gear.
#[test]
fn every_example_costs_at_its_load_what_its_operation_costs() {
    let (mut compared, mut gears) = (0, 0);
    for (name, text) in examples() {
        let Ok(train) = Train::from_toml(&text) else { continue };
        let Ok(all) = analyze(&train, &Selection::default()) else { continue };
        assert!(all.ratios.iter().all(|(_, row)| row.at_load.is_none()), "nobody asked");
        let all = all.with_loads(&train);
        for (state, row) in all.ratios.iter() {
            let Some(at) = &row.at_load else { continue };
            gears += 1;
            assert!(row.exact.is_some() && at.speed_rad_s * at.torque_n_m > 0.0, "{name} {state}");
            let of = at.operation.as_ref().unwrap_or_else(|| panic!("{name} {state}: whose load?"));
            let o = all.operations.iter().find(|o| o.name == *of).expect("it is in the file");
            if o.state.as_deref().unwrap_or("as drawn") != state || o.solutions.len() != 1 {
                continue;
            }
            let given = &train.operations().iter().find(|own| own.name == *of).expect("it is in the file").loads;
            if given.len() > 1 || !matches!(given[..], [(_, Load::Torque(_))]) {
                continue;
            }
            compared += 1;
            let efficiency = o.solutions[0].efficiency.expect("it drives");
            assert!((at.efficiency.expect("it drives") - efficiency).abs() < 1e-9, "{name} {state}: {at:?}");
        }
    }
    assert!(compared >= 4 && gears >= 6, "{compared} of {gears}");
}

/// Losses by kind are all of them; without load it loses no more than under it here; elements that are open take what the
/// kind says; and a state asked alone is that of the operation with nothing at its output.
#[test]
fn a_gear_without_load_is_an_operation_with_nothing_at_its_output() {
    let train = train_of("two-speed-wet-brake.toml");
    let input = train.member("sun").expect("a member");
    let load = DrivingLoad::of_file(&train, input).expect("it has a load");
    for state in states(&train) {
        let at = AtLoad::of(&train, state, &load).expect("a gear");
        assert_eq!(at.verdict, Verdict::Unique);
        let (all, spin) = (at.losses_w.expect("losses"), at.spin_losses_w.expect("losses"));
        let sum = |l: &willis::analysis::Losses| l.all().iter().sum::<f64>();
        assert!((sum(&all) / at.loss_w.expect("loss") - 1.0).abs() < 1e-9);
        assert!((sum(&spin) / at.spin_loss_w.expect("loss") - 1.0).abs() < 1e-9);
        assert!(at.spin_loss_w <= at.loss_w.map(|w| w * (1.0 + 1e-9)));
        let open = at.spin_sources.iter().filter(|s| s.kind == LossKind::ShiftElement).map(|s| s.loss_w).sum::<f64>();
        assert!((open - spin.shift_element).abs() < 1e-9 * open);
        let mut idle = Operation::new("idle").speed(input, AngularSpeed::rpm(3500.0));
        idle = idle.load(train.member("carrier").expect("a member"), Torque::n_m(0.0));
        idle.state = state;
        let idle = idle.temperature(Temperature::deg_c(at.temperature_k.expect("an oil") - 273.15));
        let (report, _) = operate(&train, &idle).expect("an answer");
        let found = report.solutions.first().or(report.dissipative_solutions.first()).expect("an equilibrium");
        let spin = at.spin_loss_w.expect("loss");
        assert!((found.loss_w / spin - 1.0).abs() < 1e-6, "{} {spin}", found.loss_w);
        // What turns the input is lost.
        let torque = found.members.get("sun").and_then(|m| m.torque_n_m).expect("a torque");
        assert!((torque * 3500.0 * PI / 30.0 / spin - 1.0).abs() < 1e-6);
    }
}

/// Asked loads go before those of the file; what is not asked for is the file's; a train of given efficiencies has none,
/// and says why.
#[test]
fn a_load_may_be_asked_for() {
    let train = train_of("fva-planetary-stage.toml");
    let ask = |train: &Train, speed: Option<f64>, torque: Option<f64>, celsius: Option<f64>| {
        let load = AskedLoad {
            speed: speed.map(|n| AngularSpeed::rpm(n).into()),
            torque: torque.map(|t| Torque::n_m(t).into()),
            temperature: celsius.map(|t| t + 273.15),
        };
        shaft_table(train, &ShaftTableRequest { load: Some(load), ..ShaftTableRequest::default() })
    };
    let one = |torque: Option<f64>, celsius: Option<f64>| {
        let table = ask(&train, None, torque, celsius).expect("a table");
        table.states.0[0].1.at_load.clone().expect("its losses depend on load")
    };
    let (whole, half, hot) = (one(None, None), one(Some(800.0), None), one(None, Some(90.0)));
    assert_eq!((half.torque_n_m, &half.operation), (800.0, &None));
    assert!((half.speed_rad_s - 1500.0 * PI / 30.0).abs() < 1e-9);
    assert!(half.loss_w < whole.loss_w && half.spin_loss_w == whole.spin_loss_w);
    assert_eq!((hot.temperature_k, &hot.operation), (Some(363.15), &whole.operation));
    assert!(hot.spin_loss_w < whole.spin_loss_w);
    // Nothing is driven; a brake is no drive; no gearbox is so hot; all that is wrong at once.
    for (speed, torque, celsius) in [
        (None, Some(0.0), None),
        (Some(0.0), None, None),
        (Some(1000.0), Some(-5.0), None),
        (Some(-1000.0), Some(-5.0), None),
        (None, Some(-5.0), None),
        (None, None, Some(900.0)),
    ] {
        assert!(ask(&train, speed, torque, celsius).is_err(), "{speed:?} {torque:?} {celsius:?}");
    }
    assert_eq!(ask(&train, Some(0.0), Some(0.0), Some(900.0)).unwrap_err().iter().count(), 3);
    // The other way round it drives as well: what is not asked for follows.
    for (speed, torque) in [(Some(-1000.0), None), (Some(-1000.0), Some(5.0))] {
        let table = ask(&train, speed, torque, None).expect("a table");
        let at = table.states.0[0].1.at_load.clone().expect("a load");
        assert!(at.speed_rad_s < 0.0 && at.torque_n_m < 0.0 && at.efficiency.expect("it drives") > 0.8, "{at:?}");
    }
    let plain = train_of("zf-8hp70.toml");
    // Nothing hangs on them: no reason to refuse the table.
    assert!(ask(&plain, Some(0.0), Some(0.0), None).is_ok());
    let told = ask(&plain, None, Some(10.0), None).expect("a table");
    assert!(told.states.iter().all(|(_, s)| s.at_load.is_none()) && told.diagnostics.len() == 1);
    assert_eq!(ask(&plain, None, None, Some(80.0)).expect("a table").diagnostics.len(), 1, "it has no oil to hang on");
    // Not asked for, not computed.
    let bare = shaft_table(&train, &ShaftTableRequest::default()).expect("a table");
    assert!(bare.states.iter().all(|(_, s)| s.at_load.is_none()));
}

/// By hand: a set of 0.99 a mesh, a pump, a seal given as a drag, an open clutch given as a torque. Nothing hangs on the
/// load but the teeth.
#[test]
fn a_gear_of_given_drags_by_hand() {
    let text = r#"
        format = 1
        name = "by hand"
        members = ["s", "r", "c"]
        terminals = ["s", "c"]
        [[set]]
        name = "P1"
        sun = { member = "s", teeth = 30 }
        planet = { teeth = 20, count = 4 }
        ring = { member = "r", teeth = 70 }
        carrier = "c"
        mesh_efficiency = 0.99
        [[shift_element]]
        name = "B"
        kind = "brake"
        members = ["r"]
        [[shift_element]]
        name = "C"
        kind = "clutch"
        members = ["s", "c"]
        open = { torque = "0.3 N m" }
        [[drag]]
        name = "seal"
        members = ["s", "frame"]
        coulomb = "0.2 N m"
        [[pump]]
        name = "pump"
        member = "s"
        displacement = "6 cm^3"
        pressure = "5 bar"
        efficiency = 0.8
        [[state]]
        name = "low"
        engaged = ["B"]
        [[operation]]
        name = "from the output"
        state = "low"
        speeds = { s = "1000 rpm" }
        torques = { c = "-100 N m" }
    "#;
    let train = Train::from_toml(text).expect("right");
    let row = analyze(&train, &Selection::default()).expect("an answer").with_loads(&train).ratios.0.remove(0).1;
    let at = row.at_load.expect("the file has a load");
    let (w, eta) = (1000.0 * PI / 30.0, (1.0 + 7.0 / 3.0 * 0.9801) / (10.0 / 3.0));
    let pump = 6e-6 * 5e5 / (2.0 * PI * 0.8);
    // The clutch drags the sun back and the carrier on, by 0.3 N m at 0.7 of the speed.
    let carrier = 100.0 - 0.3;
    let sun = carrier * 0.3 / eta + 0.3 + 0.2 + pump;
    assert!((at.torque_n_m / sun - 1.0).abs() < 1e-9, "{} {sun}", at.torque_n_m);
    let efficiency = 100.0 * 0.3 / sun;
    assert!((at.efficiency.expect("it drives") - efficiency).abs() < 1e-9);
    // Without load the carrier, dragged on, drives the set: the ring is held, its planets hand power back to the sun.
    let back = (10.0 / 3.0) / (1.0 + 7.0 / 3.0 / 0.9801);
    let idle = 0.3 + 0.2 + pump - 0.3 * 0.3 * back;
    assert!((at.spin_loss_w.expect("a loss") / (idle * w) - 1.0).abs() < 1e-9, "{:?} {}", at.spin_loss_w, idle * w);
    let of = |name: &str| at.spin_sources.iter().find(|s| s.name == name).expect("a source").loss_w;
    assert!((of("C") - 0.3 * 0.7 * w).abs() < 1e-9 && (of("pump") - pump * w).abs() < 1e-9);
    assert!((of("seal") - 0.2 * w).abs() < 1e-9);
}

/// What more than input and output does is another point than a speed and a torque: the first operation without that names the
/// load.
#[test]
fn an_operation_with_more_than_a_load_names_none() {
    let train = |first: &str| {
        let text = format!(
            r#"
            format = 1
            name = "three terminals"
            members = ["s", "r", "c", "x"]
            terminals = ["s", "c", "x"]
            input = "s"
            output = "c"
            [[set]]
            name = "P1"
            sun = {{ member = "s", teeth = 30 }}
            ring = {{ member = "r", teeth = 70 }}
            carrier = "c"
            mesh_efficiency = 0.99
            [[mesh]]
            gears = [{{ member = "s", teeth = 20 }}, {{ member = "x", teeth = 40 }}]
            efficiency = 0.99
            [[shift_element]]
            name = "B"
            kind = "brake"
            members = ["r"]
            [[drag]]
            name = "seal"
            members = ["s", "frame"]
            coulomb = "0.2 N m"
            [[state]]
            name = "low"
            engaged = ["B"]
            [[operation]]
            name = "first"
            {first}
            [[operation]]
            name = "second"
            state = "low"
            speeds = {{ s = "700 rpm" }}
            torques = {{ s = "7 N m", x = "0 N m" }}
            "#
        );
        Train::from_toml(&text).unwrap_or_else(|e| panic!("{e}"))
    };
    let named = |first: &str| {
        let train = train(first);
        let load = DrivingLoad::of_file(&train, train.member("s").expect("a member")).expect("a load");
        load.operation.expect("of the file")
    };
    let low = |torques: &str| format!("state = \"low\"\nspeeds = {{ s = \"500 rpm\" }}\ntorques = {{ {torques} }}");
    // Plain ones: given at the input, found from the output.
    assert_eq!(named(&low("s = \"5 N m\", x = \"0 N m\"")), "first");
    assert_eq!(named(&low("c = \"-50 N m\", x = \"0 N m\"")), "first");
    // An auxiliary that takes power; a member that is held from outside; an input that is driven.
    assert_eq!(named(&low("s = \"5 N m\", x = \"-1 N m\"")), "second");
    let held = "speeds = { s = \"500 rpm\" }\nfixed = [\"r\"]\ntorques = { s = \"5 N m\", x = \"0 N m\" }";
    assert_eq!(named(held), "second");
    assert_eq!(named(&low("s = \"-5 N m\", x = \"0 N m\"")), "second");
}

/// A gear in which the operation itself runs has the operation's warnings, which are not told twice.
#[test]
fn warnings_of_the_operation_are_told_once() {
    let train = train_of("wang-herringbone-physical.toml");
    let all = analyze(&train, &Selection::default()).expect("an answer").with_loads(&train);
    let at = all.ratios.0[0].1.at_load.as_ref().expect("a load");
    assert!(!at.warnings.is_empty() && all.warnings_at_load().is_empty());
    for text in &at.warnings {
        assert!(all.diagnostics.iter().any(|d| d.message.ends_with(text)), "{text}");
    }
}

/// A torque drives whichever way the input turns, as everywhere: without loss that depends on the direction the gears cost
/// the same both ways.
#[test]
fn a_positive_torque_drives_in_both_directions() {
    let mut compared = 0;
    for (name, text) in examples() {
        let Ok(train) = Train::from_toml(&text) else { continue };
        let at = |rpm: f64| {
            let (speed, torque) = (Some(AngularSpeed::rpm(rpm).into()), Some(Torque::n_m(50.0).into()));
            let load = Some(AskedLoad { speed, torque, temperature: None });
            shaft_table(&train, &ShaftTableRequest { load, ..Default::default() }).ok()
        };
        let (Some(forward), Some(backward)) = (at(900.0), at(-900.0)) else { continue };
        for ((state, a), (_, b)) in forward.states.iter().zip(backward.states.iter()) {
            let (Some(a), Some(b)) = (&a.at_load, &b.at_load) else { continue };
            compared += 1;
            assert_eq!([a.torque_n_m, b.torque_n_m], [50.0, -50.0], "{name} {state}");
            assert_eq!(a.speed_rad_s, -b.speed_rad_s, "{name} {state}");
        }
        let load = Some(AskedLoad { torque: Some(Torque::n_m(-50.0).into()), ..AskedLoad::default() });
        let wrong = shaft_table(&train, &ShaftTableRequest { load, ..Default::default() });
        let told = wrong.err().is_some_and(|wrong| wrong.to_string().contains("brakes it"));
        let some = forward.states.iter().any(|(_, s)| s.at_load.is_some());
        assert!(told || !some, "{name}");
    }
    assert!(compared >= 6, "{compared}");
}
