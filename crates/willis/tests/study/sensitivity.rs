//! Derivatives against differences of whole analyses, taken by editing the text of the train file at the path that
//! the quantity is named by; and against closed formulas.

use proptest::prelude::*;

use willis::study::{OperationSensitivity, QuantitySensitivity, Sensitivity, StepKind, sensitivity};
use willis::train::Document;
use willis::{Selection, Train, analyze};

use crate::common::{example, examples};

fn all_of(text: &str) -> Sensitivity {
    let train = Train::from_toml(text).unwrap_or_else(|wrong| panic!("{wrong}"));
    sensitivity(&train, &Selection::default()).unwrap_or_else(|wrong| panic!("{wrong}"))
}

/// The text of a train file with another value of a quantity.
fn edited(text: &str, operation: &str, name: &str, value: f64, unit: &str) -> String {
    let mut document = Document::parse(text).expect("TOML");
    let of_operation = |key: &str| format!("operation.{operation}.{key}");
    let path = match name.rsplit_once('.') {
        Some((member, "speed")) => of_operation(&format!("speeds.{member}")),
        Some((member, "torque")) => of_operation(&format!("torques.{member}")),
        Some((member, "power")) => of_operation(&format!("powers.{member}")),
        // The operation's own goes before that of the oil.
        Some(("oil", "temperature")) => {
            let own = document.find(&of_operation("temperature")).expect("a key of every operation");
            document.value(&own).map_or_else(|| name.to_owned(), |_| of_operation("temperature"))
        }
        _ => name.to_owned(),
    };
    let key = document.find(&path).unwrap_or_else(|d| panic!("{path}: {}", d.message));
    let new = if unit == "-" { value.to_string() } else { format!("{value} {unit}") };
    document.set(&key, &new).unwrap_or_else(|e| panic!("{path} = {new}: {e}"));
    document.text()
}

/// The same, and what moves with the quantity in proportion.
fn moved(text: &str, operation: &str, q: &QuantitySensitivity, value: f64) -> String {
    let mut text = edited(text, operation, &q.name, value, &q.unit);
    if q.name.ends_with(".shift") {
        for (others, way) in [(&q.together, 1.0), (&q.opposite, -1.0)] {
            for other in others {
                let document = Document::parse(&text).expect("TOML");
                let key = document.find(other).unwrap_or_else(|d| panic!("{other}: {}", d.message));
                let own = document.value(&key).map_or(0.0, |x| x.parse::<f64>().expect("a number"));
                text = edited(&text, operation, other, own + way * (value - q.value), "-");
            }
        }
        return text;
    }
    for other in &q.together {
        let document = Document::parse(&text).expect("TOML");
        let key = document.find(other).unwrap_or_else(|d| panic!("{other}: {}", d.message));
        let own = document.value(&key).expect("what moves along is given");
        let own = willis::units::Length::parse(&own).expect("a length").si();
        text = edited(&text, operation, other, own * value / q.value, "m");
    }
    text
}

/// Efficiency and total loss, and each loss, of an operation.
fn analysed(text: &str, operation: &str) -> (f64, f64, Vec<(String, f64)>) {
    let train = Train::from_toml(text).unwrap_or_else(|wrong| panic!("{wrong}\n{text}"));
    let selection = Selection { operation: Some(operation.into()), ..Selection::default() };
    let analysis = analyze(&train, &selection).unwrap_or_else(|wrong| panic!("{wrong}"));
    let s = &analysis.operations[0].solutions[0];
    let sources = match s.sources.is_empty() {
        true => s.meshes.iter().map(|(name, m)| (name.clone(), m.loss_w)).collect(),
        false => s.sources.iter().map(|x| (format!("{} {:?} {}", x.name, x.kind, x.law), x.loss_w)).collect(),
    };
    (s.efficiency.unwrap_or(0.0), s.loss_w, sources)
}

/// Derivatives by differences: central, extrapolated to step zero after Richardson.
fn differences(text: &str, operation: &str, q: &QuantitySensitivity) -> (f64, f64, Vec<(String, f64)>) {
    let mut h = match q.unit.as_str() {
        "K" => 0.5,
        "rad" => 2e-4,
        "-" if q.step_size == 0.01 && q.name.ends_with(".shift") => 1e-3,
        _ if q.value == 0.0 => 1e-2,
        _ => 1e-3 * q.value.abs(),
    };
    if q.name.contains("efficiency") {
        h = h.min(0.4 * (1.0 - q.value));
    }
    let at = |x: f64| analysed(&moved(text, operation, q, x), operation);
    let slope = |h: f64| {
        let (above, below) = (at(q.value + h), at(q.value - h));
        let of = |name: &str, list: &[(String, f64)]| list.iter().find(|s| s.0 == name).map_or(0.0, |s| s.1);
        let parts = above.2.iter().map(|(name, x)| (name.clone(), (x - of(name, &below.2)) / (2.0 * h)));
        ((above.0 - below.0) / (2.0 * h), (above.1 - below.1) / (2.0 * h), parts.collect::<Vec<_>>())
    };
    let (coarse, fine) = (slope(h), slope(h / 2.0));
    let better = |c: f64, f: f64| (4.0 * f - c) / 3.0;
    let parts = fine.2.iter().map(|(name, f)| {
        let c = coarse.2.iter().find(|s| s.0 == *name).map_or(0.0, |s| s.1);
        (name.clone(), better(c, *f))
    });
    (better(coarse.0, fine.0), better(coarse.1, fine.1), parts.collect())
}

/// Largest difference between a derivative and differences: changes for a step, over the loss (the part of it that one
/// percent is, so that 1 is a change of one percent of the loss).
fn worst(text: &str, o: &OperationSensitivity) -> (f64, String) {
    let mut worst = (0.0, String::new());
    for q in &o.quantities {
        let (efficiency, loss, parts) = differences(text, &o.name, q);
        let size = 0.01 * o.loss_w.max(1e-6 * o.input_power_w) / q.step_size.abs();
        let mut note = |what: &str, ours: f64, theirs: f64, size: f64| {
            let off = (ours - theirs).abs() / (size + theirs.abs());
            if off.is_nan() || off > worst.0 {
                worst = (off, format!("{} {what}: {ours} against {theirs}", q.name));
            }
        };
        note("loss", q.loss_derivative_w, loss, size);
        // A power of zero is input on one side and output on the other.
        let kink = q.value == 0.0;
        note(
            "efficiency",
            if kink { efficiency } else { q.efficiency_derivative.unwrap_or(0.0) },
            efficiency,
            size / o.input_power_w,
        );
        for s in &q.sources {
            let name = format!("{} {:?} {}", s.name, s.kind, s.law);
            let theirs = parts.iter().find(|p| p.0 == name || p.0 == s.name && s.law == "given");
            let theirs = theirs.unwrap_or_else(|| panic!("no loss {name}")).1;
            note(&name, s.change_w / q.step_size, theirs, size);
        }
    }
    worst
}

fn agrees(name: &str, least: usize) {
    let text = example(name);
    let all = all_of(&text);
    let mut told = 0;
    for o in all.operations.iter().filter(|o| o.reason.is_none()) {
        let (off, what) = worst(&text, o);
        println!("{name}, {}: {} quantities, at most {off:.1e} off ({what})", o.name, o.quantities.len());
        assert!(off < 1e-5, "{name}, {}: {off:.1e}: {what}", o.name);
        let checks = o.checks.unwrap();
        assert!(checks.balance_residual < 1e-9 && checks.error < 1e-10, "{name}, {}: {checks:?}", o.name);
        assert!(o.without_derivative.iter().all(|w| w.1.contains("at rest")), "{name}: {:?}", o.without_derivative);
        told = told.max(o.quantities.len());
    }
    assert!(told >= least, "{name}: {told} quantities");
}

#[test]
fn val_fva_planetary_stage_by_differences() {
    agrees("fva-planetary-stage", 20);
}

#[test]
fn val_wang_herringbone_by_differences() {
    agrees("wang-herringbone-physical", 20);
}

#[test]
fn val_nrel_stage_by_differences() {
    agrees("nrel-5mw-stage-1", 15);
}

/// Every step that is told can be taken: with what moves along, the file is still that of a train. Not of efficiencies, whose
/// step back may lead past one, and of profile shifts without a centre distance, which other gears of the set must share.
#[test]
fn every_step_can_be_taken() {
    let (mut steps, mut along) = (0, 0);
    for (name, text) in crate::common::examples() {
        let Ok(train) = Train::from_toml(&text) else { continue };
        let Ok(all) = sensitivity(&train, &Selection::default()) else { continue };
        for o in all.operations.iter().take(1) {
            let fits = |q: &&QuantitySensitivity| {
                let alone = q.name.ends_with(".shift") && !text.contains("centre_distance");
                !(alone || q.assumed || q.name.contains("efficiency") || q.name.contains("eta"))
            };
            for q in o.quantities.iter().filter(fits) {
                let whole = ["teeth", "count", "planets", "number"].iter().any(|w| q.name.ends_with(w));
                assert!(!whole, "{name}: {} is a whole number", q.name);
                // What is zero may have no other side.
                let back = if q.value == 0.0 { q.step_size } else { -q.step_size };
                for step in [q.step_size, back] {
                    let text = moved(&text, &o.name, q, q.value + step);
                    let read = Train::from_toml(&text);
                    assert!(read.is_ok(), "{name}: {} by {step}: {}", q.name, read.unwrap_err());
                    steps += 1;
                }
                along += q.together.len();
            }
        }
    }
    assert!(steps > 100 && along > 2, "{steps} steps, {along} along");
}

#[test]
fn val_given_efficiencies_by_differences() {
    agrees("uts-60-1161", 3);
    agrees("zf-8hp70", 3);
    agrees("prius-p112", 3);
}

/// A train with everything that can be given: helical teeth on a given centre distance, tips, immersed gears, bearings
/// with own sizes and loads, an oil of one viscosity, laws that are not the default ones.
const EVERYTHING: &str = r#"
    format = 1
    name = "everything that can be given"
    members = ["sun", "carrier", "out"]
    terminals = ["sun", "out"]

    [oil]
    viscosity = "30 mPa s"
    density_15 = "870 kg/m^3"
    pressure_viscosity = "18 1/GPa"
    lubricant_factor = 0.9
    temperature = "70 degC"
    supply = "bath"
    volume = "3 l"

    [housing]
    enclosure = 0.7

    [[set]]
    name = "P1"
    sun = { member = "sun", teeth = 17, shift = 0.2, roughness = "0.5 um", immersion = "5 mm" }
    planet = { teeth = 22, count = 3, shift = 0.1, tip_alteration = "-0.1 mm", immersion = "12 mm", mass = "1.5 kg" }
    ring = { member = "frame", teeth = 61, shift = 0.4, dedendum = 1.2 }
    carrier = "carrier"
    geometry = { module = "4 mm", width = "50 mm", helix = "12 deg", centre_distance = "81 mm", youngs_modulus = "210 GPa", poisson_ratio = 0.29, roughness = "0.6 um" }

    [[mesh]]
    name = "final"
    gears = [
      { member = "carrier", teeth = 25, shift = 0.1, tip_diameter = "109 mm", tip_relief = "30 um", tip_relief_length = "5 mm" },
      { member = "out", teeth = 60, addendum = 0.95 },
    ]
    geometry = { module = "4 mm", width = "60 mm" }

    [[mesh]]
    name = "pump"
    gears = [{ member = "sun", teeth = 20 }, { member = "pump", teeth = 30 }]
    efficiency = { forward = 0.97, backward = 0.95 }

    [[bearing]]
    name = "planets"
    members = ["P1.planet", "carrier"]
    kind = "cylindrical-roller"
    series = "2"
    bore = "31 mm"
    outside_diameter = "61 mm"
    width = "17 mm"
    count = 2
    span = "30 mm"

    [[bearing]]
    name = "input"
    members = ["sun"]
    kind = "deep-groove-ball"
    series = "62"
    bore = "51 mm"
    outside_diameter = "93 mm"
    width = "21 mm"
    static_rating = "23 kN"
    radial_load = "400 N"
    axial_load = "300 N"
    level = "8 mm"

    [[bearing]]
    name = "output"
    members = ["out"]
    kind = "tapered-roller"
    series = "302"
    bore = "61 mm"
    outside_diameter = "108 mm"
    width = "23 mm"
    axial_factor = 1.4
    radial_load = "1 kN"
    axial_load = "500 N"

    [[seal]]
    name = "front"
    members = ["sun"]
    diameter = "50 mm"

    [[rotor]]
    name = "drum"
    member = "carrier"
    radius = "130 mm"
    length = "110 mm"
    radial_gap = "12 mm"
    fluid = "oil"

    [[operation]]
    name = "rated"
    speeds = { sun = "1500 rpm" }
    powers = { sun = "100 kW", pump = "-2 kW" }
"#;

/// The gears with tip relief have unlike shifts: the stiffness of ISO 6336-1 jumps where they are alike.
#[test]
fn val_everything_that_can_be_given_by_differences() {
    let text = EVERYTHING
        .replace("members = [\"sun\", \"carrier\", \"out\"]", "members = [\"sun\", \"carrier\", \"out\", \"pump\"]");
    let text = text.replace("terminals = [\"sun\", \"out\"]", "terminals = [\"sun\", \"out\", \"pump\"]");
    let laws = [
        "",
        "[laws]\nmesh_friction = \"matsumoto\"\nbearing = \"palmgren\"\nchurning = \"iso-14179-1\"\nseal = \"simrit\"",
        "[laws]\nmesh_friction = \"constant\"\nfriction_coefficient = 0.06\nload_sharing = \"stiffness\"\nbearing = \"harris\"",
        "[laws]\nmesh_friction = \"iso-14179-1-friction\"\nloss_factor = \"uniform\"",
        "[laws]\nmesh_friction = \"xu-kahraman\"\nfilm_reduction = \"gupta-cheng\"",
        "[laws]\nwindage = \"dawson-1984\"",
    ];
    let mut never: Option<Vec<String>> = None;
    for chosen in laws {
        let text = format!("{text}\n{chosen}\n");
        // Windage is that of gears in a jet.
        let text = if chosen.contains("windage") { text.replace("\"bath\"", "\"jet\"") } else { text };
        let all = all_of(&text);
        let o = &all.operations[0];
        assert!(o.reason.is_none(), "{:?}", o.reason);
        let (off, what) = worst(&text, o);
        println!("{chosen:?}: {} quantities, at most {off:.1e} off ({what}), {:?}", o.quantities.len(), o.checks);
        assert!(off < 1e-5, "{chosen}: {off:.1e}: {what}");
        assert!(o.without_derivative.is_empty(), "{:?}", o.without_derivative);
        assert!(o.quantities.len() >= 40, "{}", o.quantities.len());
        let silent = |name: &String| o.without_effect.contains(name);
        never = Some(match never {
            None => o.without_effect.clone(),
            Some(all) => all.into_iter().filter(silent).collect(),
        });
    }
    // The pump is driven, the ring does not turn, no law reads the width of a ball bearing; everything else is read by
    // one of the choices.
    assert_eq!(never.unwrap(), ["pump.efficiency.backward", "P1.ring.dedendum", "input.width"]);
}

/// dη/dη_0 of one set in its six inversions, by hand, with I = z_r/z_s.
#[test]
fn val_six_inversions_in_closed_form() {
    let (i, e) = (70.0 / 30.0, 0.97);
    let cases: [(&str, &str, &str, f64, f64); 6] = [
        ("sun", "ring", "carrier", e, 1.0),
        ("ring", "sun", "carrier", e, 1.0),
        ("sun", "carrier", "ring", (1.0 + i * e) / (1.0 + i), i / (1.0 + i)),
        ("carrier", "sun", "ring", (1.0 + i) / (1.0 + i / e), (1.0 + i) * i / (e + i).powi(2)),
        ("ring", "carrier", "sun", (i + e) / (i + 1.0), 1.0 / (i + 1.0)),
        ("carrier", "ring", "sun", (1.0 + i) / (i + 1.0 / e), (1.0 + i) / (i * e + 1.0).powi(2)),
    ];
    for (input, output, fixed, eta, slope) in cases {
        let text = format!(
            r#"
            format = 1
            name = "set"
            members = ["sun", "ring", "carrier"]
            terminals = ["{input}", "{output}"]
            [[set]]
            name = "P1"
            sun = {{ member = "sun", teeth = 30 }}
            planet = {{ teeth = 20, count = 4 }}
            ring = {{ member = "ring", teeth = 70 }}
            carrier = "carrier"
            basic_efficiency = {e}
            [[operation]]
            name = "rated"
            fixed = ["{fixed}"]
            speeds = {{ {input} = "1000 rpm" }}
            torques = {{ {input} = "100 N m" }}
            "#
        );
        let all = all_of(&text);
        let o = &all.operations[0];
        assert!((o.efficiency.unwrap() - eta).abs() < 1e-14, "{input} to {output}");
        let q = o.quantities.iter().find(|q| q.name == "P1.basic_efficiency").unwrap();
        assert!((q.efficiency_derivative.unwrap() - slope).abs() < 1e-13, "{input} to {output}: {q:?}");
        // Loss is in proportion to torque and to speed.
        for name in [format!("{input}.torque"), format!("{input}.speed")] {
            let q = o.quantities.iter().find(|q| q.name == name).unwrap();
            assert!((q.loss_elasticity.unwrap() - 1.0).abs() < 1e-12, "{name}: {q:?}");
            assert!(q.efficiency_derivative.unwrap().abs() < 1e-16, "{name}: {q:?}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Two coupled sets with given efficiencies, one freedom (the second carrier held) or two.
    #[test]
    fn val_coupled_sets_by_differences(
        suns in [20i64..40, 20i64..40], planets in [14i64..30, 14i64..30],
        eta in [0.90f64..0.995, 0.90f64..0.995, 0.90f64..0.995], free in any::<bool>(), backwards in any::<bool>(),
        second in -2000.0f64..2000.0,
    ) {
        let [s1, s2] = suns;
        let [r1, r2] = [0, 1].map(|k| suns[k] + 2 * planets[k]);
        let [p1, p2] = planets;
        let [a, b, c] = eta;
        let more = if free { ", \"c\"" } else { "" };
        let carrier = if free { "c" } else { "frame" };
        let speed = if free { format!(", c = \"{second} rpm\"") } else { String::new() };
        let torque = if backwards { -150.0 } else { 150.0 };
        let text = format!(
            r#"
            format = 1
            name = "coupled"
            members = ["s", "x", "y"{more}]
            terminals = ["x", "y"{more}]
            [[set]]
            name = "P1"
            sun = {{ member = "s", teeth = {s1} }}
            planet = {{ teeth = {p1} }}
            ring = {{ member = "x", teeth = {r1} }}
            carrier = "y"
            mesh_efficiency = {{ external = {a}, internal = {b} }}
            [[set]]
            name = "P2"
            sun = {{ member = "s", teeth = {s2} }}
            planet = {{ teeth = {p2} }}
            ring = {{ member = "y", teeth = {r2} }}
            carrier = "{carrier}"
            basic_efficiency = {c}
            [[operation]]
            name = "rated"
            speeds = {{ x = "1000 rpm"{speed} }}
            torques = {{ x = "{torque} N m" }}
            "#
        );
        let all = all_of(&text);
        let o = &all.operations[0];
        if o.reason.is_none() && o.loss_w > 0.0 {
            prop_assert!(o.checks.unwrap().balance_residual < 1e-10, "{:?}", o.checks);
            // Not at the edge of another regime.
            let near = |b: &Option<willis::analysis::Boundary>| {
                b.as_ref().is_some_and(|b| (b.value - b.boundary).abs() < 0.01 * b.value.abs())
            };
            let margin = o.margin.as_ref().unwrap();
            if !near(&margin.torque) && !near(&margin.speed) {
                let (off, what) = worst(&text, o);
                prop_assert!(off < 1e-6, "{off:.1e}: {what}\n{text}");
            }
        }
    }
}

#[test]
fn regress_no_numbers_without_one_equilibrium() {
    let all = all_of(&example("two-efficiencies"));
    let o = &all.operations[0];
    assert!(o.reason.as_ref().unwrap().contains("2 equilibria"), "{:?}", o.reason);
    assert!(o.quantities.is_empty() && o.efficiency.is_none());
    let locked = all_of(&example("wolfrom-498-self-locking"));
    assert!(locked.operations.iter().any(|o| o.reason.as_ref().is_some_and(|r| r.contains("locks"))));
}

#[test]
fn regress_a_lossless_train_has_no_effects() {
    let text = r#"
        format = 1
        name = "lossless"
        members = ["sun", "carrier"]
        terminals = ["sun", "carrier"]
        [[set]]
        name = "P1"
        sun = { member = "sun", teeth = 30 }
        planet = { teeth = 20 }
        ring = { member = "frame", teeth = 70 }
        carrier = "carrier"
        [[operation]]
        name = "rated"
        speeds = { sun = "1000 rpm" }
        torques = { sun = "100 N m" }
    "#;
    let all = all_of(text);
    assert!(all.operations[0].quantities.is_empty(), "{:?}", all.operations[0].quantities);
    assert_eq!(all.operations[0].without_effect, ["sun.speed", "sun.torque"]);

    // One side only: an efficiency of 1 can fall.
    let text = text.replace("carrier = \"carrier\"", "carrier = \"carrier\"\nmesh_efficiency = 1.0");
    let all = all_of(&text);
    let q = &all.operations[0].quantities[0];
    assert!((q.efficiency_derivative.unwrap() - 1.4).abs() < 1e-12, "{q:?}");
}

#[test]
fn regress_wrong_selections_are_told() {
    let text = example("fva-planetary-stage");
    let train = Train::from_toml(&text).unwrap();
    let ask = |operation: Option<&str>, state: Option<&str>| {
        let selection = Selection { operation: operation.map(Into::into), state: state.map(Into::into) };
        sensitivity(&train, &selection).unwrap_err().to_string()
    };
    assert!(ask(Some("ratde"), None).contains("did you mean `rated`?"));
    assert!(ask(None, Some("1")).contains("the train has no state `1`"));
    let none = Train::from_toml(&text[..text.find("[[operation]]").unwrap()]).unwrap();
    let wrong = sensitivity(&none, &Selection::default()).unwrap_err().to_string();
    assert!(wrong.contains("there is none"), "{wrong}");
}

/// Bearings side by side that carry the same have derivatives of their own: moved along the axis one gains what the other loses.
#[test]
fn bearings_that_carry_the_same_have_derivatives_of_their_own() {
    let at = |mm: f64| {
        let text = example("fva-planetary-stage");
        let text = text.replace("width = \"50 mm\"", "width = \"50 mm\", position = \"0 mm\"");
        text.replace(
            "count = 2\n\n[[bearing]]\nname = \"sun",
            &format!("count = 2\nposition = \"{mm} mm\"\nspan = \"40 mm\"\n\n[[bearing]]\nname = \"sun"),
        )
    };
    let rated = Selection { operation: Some("rated".into()), ..Selection::default() };
    let loss = |mm: f64| {
        let train = Train::from_toml(&at(mm)).unwrap_or_else(|e| panic!("{e}"));
        analyze(&train, &rated).unwrap().operations[0].solutions[0].loss_w
    };
    for mm in [0.0, 3.0] {
        let train = Train::from_toml(&at(mm)).unwrap();
        let all = sensitivity(&train, &rated).unwrap();
        // What moves no loss is not told.
        let own = all.operations[0].quantities.iter().find(|q| q.name == "planet bearings.position");
        let derivative = own.map_or(0.0, |q| q.loss_derivative_w);
        let difference = (loss(mm + 0.1) - loss(mm - 0.1)) / 0.2e-3;
        assert!((derivative - difference).abs() < 0.02 * difference.abs() + 0.1, "{mm}: {derivative} {difference}");
    }
}

#[test]
fn no_step_of_an_efficiency_passes_one() {
    let mut less = 0;
    for (name, text) in examples() {
        let train = Train::from_toml(&text).unwrap();
        let Ok(all) = sensitivity(&train, &Selection::default()) else { continue };
        for q in all.operations.iter().flat_map(|o| &o.quantities).filter(|q| q.name.contains("efficiency")) {
            assert!(q.value + q.step_size <= 1.0, "{name}, {}: {} by {}", q.name, q.value, q.step_size);
            // One percent to the side that is possible, and the change goes with it.
            assert!((q.step_size.abs() / q.value - 0.01).abs() < 1e-12);
            assert!((q.loss_change_w - q.loss_derivative_w * q.step_size).abs() <= 1e-12 * q.loss_change_w.abs());
            assert_eq!(q.step == StepKind::PercentLess, 1.01 * q.value > 1.0, "{name}, {}", q.name);
            assert_eq!(q.step.label() == "−1 %", q.step_size < 0.0);
            less += usize::from(q.step == StepKind::PercentLess);
        }
    }
    assert!(less > 10, "{less}");
}

/// In a given centre distance a shift moves with those of the gears around it: sun and planet the other way, planet and ring the
/// same way. Where the centre distance follows from the shifts, it moves alone.
#[test]
fn shifts_move_so_that_a_given_centre_distance_holds() {
    let text = |centre: &str| {
        format!(
            r#"
            format = 1
            name = "shifted"
            members = ["sun", "carrier"]
            terminals = ["sun", "carrier"]
            [[set]]
            name = "P1"
            sun = {{ member = "sun", teeth = 17, shift = 0.2 }}
            planet = {{ teeth = 22, count = 3, shift = 0.1 }}
            ring = {{ member = "frame", teeth = 61, shift = 0.4 }}
            carrier = "carrier"
            geometry = {{ module = "4 mm", width = "50 mm"{centre} }}
            [[operation]]
            name = "rated"
            speeds = {{ sun = "1000 rpm" }}
            torques = {{ sun = "1000 N m" }}
            "#
        )
    };
    let given = text(", centre_distance = \"79.15 mm\"");
    let all = all_of(&given);
    let of = |name: &str| all.operations[0].quantities.iter().find(|q| q.name.ends_with(name)).expect("a shift");
    let [sun, planet, ring] = ["sun.shift", "planet.shift", "ring.shift"].map(of);
    assert_eq!([sun.opposite.len(), sun.together.len()], [2, 0], "{:?}", sun);
    assert_eq!([planet.opposite.len(), planet.together.len()], [1, 1]);
    assert_eq!(ring.opposite, planet.opposite);
    // One movement, told from three gears.
    assert!((sun.loss_derivative_w + planet.loss_derivative_w).abs() < 1e-9 * planet.loss_derivative_w.abs());
    assert!((ring.loss_derivative_w - planet.loss_derivative_w).abs() < 1e-9 * planet.loss_derivative_w.abs());
    let (off, what) = worst(&given, &all.operations[0]);
    assert!(off < 1e-5, "{off:.1e}: {what}");

    let pair = r#"
        format = 1
        name = "a pair"
        members = ["a", "b"]
        terminals = ["a", "b"]
        [[mesh]]
        gears = [{ member = "a", teeth = 20, shift = 0.2 }, { member = "b", teeth = 40, shift = 0.1 }]
        geometry = { module = "4 mm", width = "50 mm" }
        [[operation]]
        name = "rated"
        speeds = { a = "1000 rpm" }
        torques = { a = "100 N m" }
    "#;
    let all = all_of(pair);
    let shifts: Vec<_> = all.operations[0].quantities.iter().filter(|q| q.name.ends_with("shift")).collect();
    assert_eq!(shifts.len(), 2);
    assert!(shifts.iter().all(|q| q.opposite.is_empty() && q.together.is_empty()));
}

/// Where a mesh carries nothing, whatever loads it loses either way: such a quantity has no derivative, and all others have
/// the same one from both sides. Of every train of the examples with nothing at its terminals but drags.
#[test]
fn no_derivative_where_both_sides_differ() {
    let text = r#"
        format = 1
        name = "spin"
        members = ["sun", "carrier", "out"]
        terminals = ["sun", "out"]
        set = [{ name = "P1", sun = { member = "sun", teeth = 30 }, planet = { teeth = 20, count = 4 },
                 ring = { member = "frame", teeth = 70 }, carrier = "carrier", mesh_efficiency = 0.9 }]
        mesh = [{ name = "m", gears = [{ member = "carrier", teeth = 20 }, { member = "out", teeth = 30 }], efficiency = 0.97 }]
        drag = [{ name = "v", members = ["AT"], coulomb = "2 N m" }]
        operation = [{ name = "spin", speeds = { sun = "500 rpm" }, torques = { out = "0 N m" } }]
    "#;
    // Up to the drag all is loaded, behind it nothing.
    for (at, corners) in [("sun", vec!["out.torque"]), ("carrier", vec!["out.torque"]), ("out", vec![])] {
        let text = text.replace("AT", at);
        let all = all_of(&text);
        let o = &all.operations[0];
        let without: Vec<&str> = o.without_derivative.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(without, corners, "{at}: {o:?}");
        assert!(o.checks.is_some_and(|c| c.balance_residual < 1e-9), "{o:?}");
        let loss = |torque: f64| analysed(&edited(&text, "spin", "out.torque", torque, "N m"), "spin").1;
        let [down, here, up] = [-1e-3, 0.0, 1e-3].map(loss);
        let sides = [(here - down) / 1e-3, (up - here) / 1e-3];
        let own = o.quantities.iter().find(|q| q.name == "out.torque").map(|q| q.loss_derivative_w);
        match own {
            Some(slope) => {
                assert!(sides.iter().all(|side| (side - slope).abs() < 1e-5 * slope.abs()), "{at}: {sides:?}")
            }
            None => assert!((sides[0] - sides[1]).abs() > 0.1, "{at}: {sides:?}"),
        }
        assert_eq!(own.is_none(), !corners.is_empty());
    }
}

/// Derivatives of every operation close the balance of powers, with nothing at the terminals too.
#[test]
fn every_derivative_closes_the_balance() {
    let mut closed = 0;
    for (name, text) in examples() {
        let Ok(train) = Train::from_toml(&text) else { continue };
        for unloaded in [false, true] {
            let mut text = text.clone();
            for o in train.operations().iter().filter(|_| unloaded) {
                for (member, _) in &o.loads {
                    let path = format!("{}.torque", train.member_name(*member));
                    if Document::parse(&text).is_ok_and(|d| {
                        d.find(&format!("operation.{}.torques.{}", o.name, train.member_name(*member))).is_ok()
                    }) {
                        text = edited(&text, &o.name, &path, 0.0, "N m");
                    }
                }
            }
            let Ok(train) = Train::from_toml(&text) else { continue };
            let Ok(all) = sensitivity(&train, &Selection::default()) else { continue };
            for o in all.operations.iter().filter(|o| !o.quantities.is_empty()) {
                closed += 1;
                let checks = o.checks.expect("there are derivatives");
                assert!(checks.balance_residual < 1e-6, "{name} {}, unloaded {unloaded}: {checks:?}", o.name);
            }
        }
    }
    assert!(closed > 20, "{closed}");
}
