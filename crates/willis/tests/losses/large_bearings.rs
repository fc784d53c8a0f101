//! Bearings beyond the catalogue: own dimensions up to a bore of 500 mm, in every kind and under every law.

use willis::analysis::{Selection, analyze};
use willis::catalogue::bearing::Kind;
use willis::losses::entries;
use willis::train::Train;

/// Dimensions of the train file's own: a friction that is finite, above zero, and grows with the bearing.
#[test]
fn own_dimensions_up_to_500_mm_have_a_friction_under_every_law() {
    for (name, kind) in Kind::NAMES.iter().filter(|k| k.1 != Kind::Plain) {
        let axial = matches!(kind, Kind::AxialBall | Kind::AxialCylindricalRoller);
        let loads = if axial { r#"axial_load = "60 kN""# } else { r#"radial_load = "60 kN""# };
        let train = |[bore, outside, width]: [u32; 3]| {
            let text = format!(
                r#"
                format = 1
                name = "a shaft"
                members = ["a", "b"]
                terminals = ["a", "b"]
                [oil]
                name = "ISO VG 320"
                [[mesh]]
                gears = [{{ member = "a", teeth = 30 }}, {{ member = "b", teeth = 60 }}]
                efficiency = 0.99
                [[bearing]]
                name = "main"
                members = ["a"]
                kind = "{name}"
                bore = "{bore} mm"
                outside_diameter = "{outside} mm"
                width = "{width} mm"
                static_rating = "2000 kN"
                {loads}
                [[operation]]
                name = "rated"
                speeds = {{ a = "100 rpm" }}
                torques = {{ a = "10 kN m" }}
                "#
            );
            Train::from_toml(&text).unwrap_or_else(|wrong| panic!("{name} {bore}: {wrong}"))
        };
        let [large, small] = [[500, 720, 100], [300, 460, 74]].map(train);
        for law in entries().iter().filter(|e| e.family == "bearing") {
            let torque = |t: &Train| {
                let all = analyze(&t.clone().with_law("bearing", law.id).expect("a law"), &Selection::default());
                let all = all.expect("an answer");
                let found = all.operations[0].solutions.first().expect("an equilibrium").clone();
                found.bearings.get("main").expect("a bearing").torque_n_m
            };
            let [large, small] = [&large, &small].map(torque);
            assert!(small > 0.0 && large.is_finite() && large > small, "{name}, {}: {small} and {large}", law.id);
        }
    }
}
