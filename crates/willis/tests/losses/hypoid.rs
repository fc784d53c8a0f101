//! Hypoid teeth: sliding along them, and across them as the virtual cylindrical pair.

use willis::analysis::{OperationReport, Selection, SolutionReport, Verdict, analyze};
use willis::geometry::hypoid::Hypoid;
use willis::losses::entries;
use willis::study::sensitivity;
use willis::train::{Document, Train};

fn angle(degrees: f64) -> f64 {
    degrees.to_radians()
}

/// A pair 11/41 with these spiral angles; `drives` names the member with the torque.
fn text(spiral: [f64; 2], laws: &str, drives: &str, more: &str) -> String {
    format!(
        r#"
        format = 1
        name = "an axle"
        members = ["pinion", "wheel"]
        terminals = ["pinion", "wheel"]
        {laws}

        [oil]
        name = "oil"
        viscosity_40 = "150 mm^2/s"
        viscosity_100 = "15 mm^2/s"
        temperature = "70 degC"

        [[mesh]]
        name = "m"
        kind = "bevel"
        gears = [
          {{ member = "pinion", teeth = 11, shift = 0.3, spiral_angle = "{} deg" }},
          {{ member = "wheel", teeth = 41, shift = -0.3, spiral_angle = "{} deg" }},
        ]
        geometry = {{ module = "4 mm", width = "30 mm", roughness = "0.5 um"{more} }}

        [[operation]]
        name = "at work"
        speeds = {{ pinion = "100 rad/s" }}
        torques = {{ {drives} }}
        "#,
        spiral[0], spiral[1]
    )
}

const PINION: &str = "pinion = \"200 N m\"";
/// The wheel turns backwards, so this puts power in.
const WHEEL: &str = "wheel = \"-700 N m\"";

fn report(text: &str) -> OperationReport {
    let train = Train::from_toml(text).unwrap_or_else(|wrong| panic!("{wrong}"));
    analyze(&train, &Selection::default()).expect("an answer").operations[0].clone()
}

fn solution(text: &str) -> SolutionReport {
    let report = report(text);
    assert_eq!(report.verdict, Verdict::Unique, "{:?}", report.reason);
    report.solutions[0].clone()
}

fn constant(mu: f64) -> String {
    format!("laws = {{ mesh_friction = \"constant\", friction_coefficient = {mu} }}")
}

/// Spiral angles of 50 and 30 degrees at 20 degrees and a coefficient of 0.06: efficiency forward and backward, and the coefficient
/// that locks, from `cos α_n/tan ψ_1`.
#[test]
fn val_lengthwise_sliding_by_hand() {
    let pair =
        |first: f64, second: f64| Hypoid { spiral: [angle(first), angle(second)], cones: [0.3, 1.2], offset: 0.03 };
    let own = pair(50.0, 30.0);
    let [forward, backward] = own.lengthwise_efficiency(angle(20.0), 0.06);
    assert!((forward / 0.963_544_028_597_166_5 - 1.0).abs() < 1e-12, "{forward}");
    assert!((backward / 0.959_268_400_591_189_2 - 1.0).abs() < 1e-12, "{backward}");
    let locks = 0.788_495_731_521_467_3;
    let at = |mu: f64| own.lengthwise_efficiency(angle(20.0), mu)[1];
    assert!(at(locks * (1.0 - 1e-9)) > 0.0 && at(locks * (1.0 + 1e-9)) < 0.0);
    // The gear with the larger angle loses the same wherever it stands, and equal angles lose nothing.
    assert_eq!(pair(30.0, 50.0).lengthwise_efficiency(angle(20.0), 0.06), [backward, forward]);
    assert_eq!(pair(40.0, 40.0).lengthwise_efficiency(angle(20.0), 0.3), [1.0, 1.0]);
}

/// Both axes, put up in space from the cones and the angle between their generators in the pitch plane, enclose the angle and have
/// the distance that the pair says; without an offset the cones are those of bevel gears.
#[test]
fn val_axes_in_space() {
    let (dot, cross) = (
        |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2],
        |a: [f64; 3], b: [f64; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]],
    );
    for (teeth, spiral, shafts) in
        [([11.0, 41.0], [50.0, 30.0], 90.0), ([9.0, 47.0], [45.0, 28.0], 90.0), ([20.0, 30.0], [25.0, 40.0], 75.0)]
    {
        let pair = Hypoid::new(4e-3, teeth, spiral.map(angle), angle(shafts)).expect("a pair");
        let radius = [0, 1].map(|k| 4e-3 * teeth[k] / (2.0 * pair.spiral[k].cos()));
        let turn = pair.spiral[0] - pair.spiral[1];
        let [first, second] = pair.cones;
        // The pitch plane is x y, and its normal z.
        let axes =
            [[first.cos(), 0.0, first.sin()], [second.cos() * turn.cos(), second.cos() * turn.sin(), -second.sin()]];
        assert!((dot(axes[0], axes[1]) - angle(shafts).cos()).abs() < 1e-12);
        // The normal at the pitch point meets each axis at r/cos δ.
        let apart = [0.0, 0.0, radius[0] / first.cos() + radius[1] / second.cos()];
        let normal = cross(axes[0], axes[1]);
        let distance = (dot(apart, normal) / dot(normal, normal).sqrt()).abs();
        assert!((distance / pair.offset - 1.0).abs() < 1e-12, "{distance} and {}", pair.offset);
    }
    let nearly = Hypoid::new(4e-3, [11.0, 41.0], [angle(35.0 + 1e-5), angle(35.0)], angle(90.0)).expect("a pair");
    assert!((nearly.cones[0].tan() - 11.0 / 41.0).abs() < 1e-6, "{:?}", nearly.cones);
}

/// The whole efficiency is that of the sliding along the teeth times that across them; each direction has its own.
#[test]
fn val_both_slidings_multiply() {
    let along = Hypoid::new(4e-3, [11.0, 41.0], [angle(50.0), angle(30.0)], angle(90.0))
        .expect("a pair")
        .lengthwise_efficiency(angle(20.0), 0.06);
    for (drives, along) in [(PINION, along[0]), (WHEEL, along[1])] {
        let found = solution(&text([50.0, 30.0], &constant(0.06), drives, ""));
        let contact = found.contacts.get("m").expect("a contact");
        let whole = along * (1.0 - 0.06 * contact.loss_factor);
        assert!((found.efficiency.expect("one") - whole).abs() < 1e-9, "{:?} and {whole}", found.efficiency);
        assert!((contact.lengthwise_efficiency.expect("one") - along).abs() < 1e-12);
        let input = found.input_power_w;
        assert!((contact.lengthwise_loss_w.expect("one") - input * (1.0 - along)).abs() < 1e-6 * input);
        assert!((contact.sliding_loss_w - input * (1.0 - whole)).abs() < 1e-6 * input);
        assert!(found.power_residual_w.abs() < 1e-9 * input);
        let sources: f64 = found.sources.iter().map(|s| s.loss_w).sum();
        assert!((sources - found.loss_w).abs() < 1e-9 * input);
        // A hypoid tooth slides at the pitch point.
        assert!(contact.sliding_speed_m_s > 1.0, "{}", contact.sliding_speed_m_s);
    }
}

/// Spiral bevel gears are the limit of hypoid gears, under every law of friction, rolling and loss factors; and a hypoid pair
/// loses more under each.
#[test]
fn val_without_an_offset_it_is_a_spiral_bevel_pair() {
    let [bevel, nearly, hypoid] = [[35.0, 35.0], [35.0 + 1e-7, 35.0], [45.0, 25.0]]
        .map(|spiral| Train::from_toml(&text(spiral, "", PINION, "")).expect("a train"));
    let given = text([35.0; 2], "", PINION, ", helix = \"35 deg\"").replace(", spiral_angle = \"35 deg\"", "");
    let given = Train::from_toml(&given).expect("a train");
    for entry in entries().iter().filter(|e| ["mesh_friction", "rolling", "loss_factor"].contains(&e.family)) {
        let loss = |t: &Train| {
            let own = t.clone().with_law(entry.family, entry.id).expect("a law");
            let all = analyze(&own, &Selection::default()).expect("an answer");
            let found = all.operations[0].solutions.first().expect("an equilibrium").clone();
            let mu = found.contacts.get("m").expect("a contact").friction.expect("a coefficient");
            assert!(mu > 0.0 && mu < 0.3, "{} {}: {mu}", entry.family, entry.id);
            1.0 - found.efficiency.expect("one")
        };
        let [a, b, c, d] = [&bevel, &nearly, &hypoid, &given].map(loss);
        assert!((a - b).abs() < 1e-6 * a, "{} {}: {a} and {b}", entry.family, entry.id);
        assert!((a - d).abs() < 1e-12, "{} {}: {a} and {d}", entry.family, entry.id);
        assert!(c > 1.3 * a, "{} {}: {c} against {a}", entry.family, entry.id);
    }
}

/// Beyond `μ = cos α_n/tan ψ_1` the wheel cannot drive: the train is locked that way, and runs the other way.
#[test]
fn val_it_locks_at_its_limit() {
    let limit = angle(20.0).cos() / angle(75.0).tan();
    for (mu, locks) in [(0.98 * limit, false), (1.02 * limit, true)] {
        let spiral = [75.0, 40.0];
        let back = report(&text(spiral, &constant(mu), WHEEL, ""));
        assert_eq!(back.verdict == Verdict::Locked, locks, "{mu}: {:?} {:?}", back.verdict, back.reason);
        // The nominal efficiency cannot say so; a warning does.
        let train = Train::from_toml(&text(spiral, &constant(mu), WHEEL, "")).expect("a train");
        assert_eq!(train.warnings().iter().any(|d| d.code == willis::diagnostic::Code::SelfLocking), locks, "{mu}");
        let forward = solution(&text(spiral, &constant(mu), PINION, ""));
        assert!(forward.efficiency.expect("one") > 0.3, "{:?}", forward.efficiency);
    }
}

/// Derivatives against differences of whole analyses, with tips that are given and tips that are not.
#[test]
fn val_derivatives_by_differences() {
    for more in ["", ", tip_diameter"] {
        let mut base = text([48.0, 30.0], "", PINION, ", pressure_angle = \"19 deg\"");
        if !more.is_empty() {
            base = base.replace("shift = 0.3,", "shift = 0.3, tip_diameter = \"77 mm\",");
        }
        let train = Train::from_toml(&base).unwrap_or_else(|wrong| panic!("{wrong}"));
        let all = sensitivity(&train, &Selection::default()).expect("an answer");
        let mut seen = 0;
        for q in &all.operations[0].quantities {
            let key = q.name.rsplit('.').next().expect("a key");
            // A module moves with the tips that are given, a shift with the other one.
            let moves = ["width", "pressure_angle", "tip_diameter", "roughness"].contains(&key);
            if !(moves || key == "module" && more.is_empty()) {
                continue;
            }
            let at = |x: f64| {
                let mut document = Document::parse(&base).expect("TOML");
                let path = document.find(&q.name).expect("a key");
                document.set(&path, &format!("{x} {}", q.unit)).expect("a value");
                solution(&document.text()).loss_w
            };
            let slope = |h: f64| (at(q.value + h) - at(q.value - h)) / (2.0 * h);
            let h = 1e-3 * q.value;
            let slope = (4.0 * slope(h / 2.0) - slope(h)) / 3.0;
            assert!(
                (q.loss_derivative_w / slope - 1.0).abs() < 1e-5,
                "{}: {} and {slope}",
                q.name,
                q.loss_derivative_w
            );
            seen += 1;
        }
        assert!(seen >= 3, "{seen} quantities");
    }
}

/// What cannot be is said with its numbers.
#[test]
fn bad_hypoid_teeth_are_told() {
    let good = text([50.0, 30.0], "", PINION, ", offset = \"35 mm\"");
    let found = Train::from_toml(&good).expect("a train");
    assert!(found.assumptions().iter().any(|a| a.contains("axes 34.7 mm apart")), "{:?}", found.assumptions());
    let wrong = |from: &str, to: &str| {
        assert!(good.contains(from), "{from}");
        Train::from_toml(&good.replacen(from, to, 1)).expect_err("no train").to_string()
    };
    let told = wrong("shift = 0.3, spiral_angle = \"50 deg\"", "shift = 0.3");
    assert!(told.contains("a spiral angle on one gear of the pair only"), "{told}");
    let told = wrong("spiral_angle = \"50 deg\"", "spiral_angle = \"30 deg\"");
    assert!(told.contains("an offset, but both gears have one spiral angle"), "{told}");
    let told = wrong("spiral_angle = \"50 deg\"", "spiral_angle = \"95 deg\"");
    assert!(told.contains("a spiral angle of 95.00°: it is 0 to 80°"), "{told}");
    let told = wrong("module = \"4 mm\"", "module = \"4 mm\", helix = \"30 deg\"");
    assert!(told.contains("`helix` beside the spiral angles"), "{told}");
    let told = wrong("kind = \"bevel\"", "");
    assert!(told.contains("a spiral angle, but the gears are cylindrical"), "{told}");
    let told = wrong("width = \"30 mm\"", "width = \"30 mm\", shaft_angle = \"170 deg\"");
    assert!(told.contains("no pitch cones below 87° touch so"), "{told}");
    // An offset that does not belong to the angles is a warning, with the one that does.
    let doubtful = good.replace("offset = \"35 mm\"", "offset = \"45 mm\"");
    let doubtful = Train::from_toml(&doubtful).expect("a train");
    let told = doubtful.warnings().iter().map(|d| d.message.clone()).collect::<String>();
    assert!(told.contains("belong to one of 34.66 mm"), "{told}");
}
