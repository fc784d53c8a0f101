//! Bevel teeth: the virtual cylindrical pair at the middle of the face width.

use willis::analysis::{Selection, SolutionReport, analyze};
use willis::losses::entries;
use willis::train::Train;

fn solution(train: &Train) -> SolutionReport {
    let all = analyze(train, &Selection::default()).expect("an answer");
    all.operations[0].solutions.first().expect("an equilibrium").clone()
}

/// A pair under 300 N m at 100 rad/s of its first gear, both over what is given.
fn pair(kind: &str, teeth: [u32; 2], width: f64, slower: f64, more: &str) -> Train {
    let [a, b] = teeth;
    Train::from_toml(&format!(
        r#"
        format = 1
        name = "a pair"
        members = ["a", "b"]
        terminals = ["a", "b"]

        [oil]
        name = "oil"
        viscosity_40 = "150 mm^2/s"
        viscosity_100 = "15 mm^2/s"
        temperature = "70 degC"

        [[mesh]]
        name = "m"
        {kind}
        gears = [{{ member = "a", teeth = {a}, shift = 0.1 }}, {{ member = "b", teeth = {b}, shift = -0.1 }}]
        geometry = {{ module = "3 mm", width = "{width} mm", {more} roughness = "0.5 um" }}

        [[operation]]
        name = "at work"
        speeds = {{ a = "{} rad/s" }}
        torques = {{ a = "{} N m" }}
        "#,
        100.0 * slower,
        300.0 / slower
    ))
    .expect("a train")
}

/// Cones of 3:4 have cosines of 0.8 and 0.6: 36 and 48 teeth are virtual gears of 45 and 80, that turn 0.8 times as fast. Under every
/// law of friction and rolling both lose the same.
#[test]
fn val_a_bevel_pair_loses_what_its_virtual_pair_does() {
    for more in ["", r#"helix = "35 deg","#] {
        let bevel = pair(r#"kind = "bevel""#, [36, 48], 20.0 / 0.85, 1.0, more);
        let cylindrical = pair("", [45, 80], 20.0, 0.8, more);
        for entry in entries().iter().filter(|e| ["mesh_friction", "rolling", "loss_factor"].contains(&e.family)) {
            let [one, other] = [&bevel, &cylindrical].map(|t| {
                let own = t.clone().with_law(entry.family, entry.id).expect("a law");
                solution(&own)
            });
            let [a, b] = [&one, &other].map(|s| 1.0 - s.efficiency.expect("one"));
            assert!((a - b).abs() < 1e-11, "{} {}: {a} and {b}", entry.family, entry.id);
            let [a, b] = [&one, &other].map(|s| s.contacts.get("m").expect("a contact").clone());
            assert!((a.pitch_line_speed_m_s / b.pitch_line_speed_m_s - 1.0).abs() < 1e-12);
            assert!((a.tangential_force_n / b.tangential_force_n - 1.0).abs() < 1e-12);
            assert!((a.pressure_pa / b.pressure_pa - 1.0).abs() < 1e-9);
        }
    }
}

/// Straight teeth 20/40 at 90°: loss factor 0.13377 of the virtual pair, 0.67 % at a coefficient of 0.05. By hand, from
/// `H_V = π (u_v + 1)/(z_v1 u_v) (1 − ε_α + ε_1² + ε_2²)` with the virtual teeth 22.36 and 89.44.
#[test]
fn val_a_straight_pair_by_hand() {
    let text = r#"
        format = 1
        name = "20 and 40 teeth"
        members = ["a", "b"]
        terminals = ["a", "b"]
        laws = { mesh_friction = "constant", friction_coefficient = 0.05, loss_factor = "ohlendorf" }

        [[mesh]]
        name = "m"
        kind = "bevel"
        gears = [{ member = "a", teeth = 20 }, { member = "b", teeth = 40 }]
        geometry = { module = "4 mm", width = "25 mm" }

        [[operation]]
        name = "at work"
        speeds = { a = "100 rad/s" }
        torques = { a = "100 N m" }
    "#;
    let found = solution(&Train::from_toml(text).expect("a train"));
    let factor = found.contacts.get("m").expect("a contact").loss_factor;
    assert!((factor / 0.133_774_452_561_360_22 - 1.0).abs() < 1e-9, "{factor}");
    assert!((1.0 - found.efficiency.expect("one") - 0.006_688_722_628_068_012).abs() < 1e-9);
    // Tangential force at the middle of the width: 100 N m over 40 mm.
    let force = found.contacts.get("m").expect("a contact").tangential_force_n;
    assert!((force - 2500.0).abs() < 1e-6, "{force}");
}

/// A differential whose housing drives: nothing rolls straight on, and in a bend only the teeth that roll lose.
#[test]
fn a_differential_loses_where_it_rolls() {
    let train = |left: f64, right: f64| {
        Train::from_toml(&format!(
            r#"
            format = 1
            name = "differential"
            members = ["cage", "left", "right"]
            terminals = ["cage", "left", "right"]

            [[set]]
            name = "D"
            type = "bevel"
            sides = [{{ member = "left", teeth = 16 }}, {{ member = "right", teeth = 16 }}]
            planet = {{ teeth = 10, count = 2 }}
            carrier = "cage"
            geometry = {{ module = "4 mm", width = "15 mm" }}

            [[operation]]
            name = "drives"
            speeds = {{ left = "{left} rad/s", right = "{right} rad/s" }}
            torques = {{ cage = "1000 N m" }}
            "#
        ))
        .expect("a train")
    };
    let loss = |t: Train| solution(&t).meshes.iter().map(|(_, m)| m.loss_w).sum::<f64>();
    assert!(loss(train(50.0, 50.0)).abs() < 1e-9);
    let bend = loss(train(55.0, 45.0));
    // Rolling power of one side: about 500 N m times 5 rad/s; both lose about a percent of it.
    assert!((10.0..100.0).contains(&bend), "{bend}");
}

/// What cannot be is said with its numbers.
#[test]
fn bad_bevel_teeth_are_told() {
    let wrong = |gears: &str, more: &str| {
        let text = format!(
            r#"
            format = 1
            name = "bad"
            members = ["a", "b"]
            terminals = ["a", "b"]
            [[mesh]]
            {gears}
            geometry = {{ module = "3 mm", width = "20 mm", {more} }}
            "#
        );
        Train::from_toml(&text).expect_err("no train").to_string()
    };
    let plain = r#"kind = "bevel"
            gears = [{ member = "a", teeth = 20 }, { member = "b", teeth = 40 }]"#;
    let told = wrong(plain, r#"centre_distance = "90 mm", mesh_stiffness = "iso-6336""#);
    assert!(told.contains("`centre_distance` is of cylindrical gears") && told.contains("`mesh_stiffness`"), "{told}");
    let told = wrong(plain, r#"shaft_angle = "175 deg""#);
    assert!(told.contains("pitch cones of"), "{told}");
    let shifted = plain.replacen("20 }", "20, shift = 0.3 }", 1);
    let told = wrong(&shifted, "");
    assert!(told.contains("those of bevel gears are opposite"), "{told}");
    let parallel = plain.replace("kind = \"bevel\"", "");
    let told = wrong(&parallel, r#"shaft_angle = "90 deg""#);
    assert!(told.contains("parallel"), "{told}");
}
