//! Paths of contact: what is drawn is what the loss was computed with.

use willis::analysis::{Selection, analyze};
use willis::train::Train;
use willis_figure::contact_path;

use crate::common::train as example;

const PHYSICAL: [&str; 3] = ["fva-planetary-stage", "nrel-5mw-stage-1", "wang-herringbone-physical"];
/// Every law of friction between teeth: two local ones among them.
const LAWS: [&str; 6] =
    ["schlenk", "niemann-winter", "matsumoto", "xu-kahraman", "benedict-kelley", "coulomb-by-regime"];

#[test]
fn the_local_loss_adds_up_to_the_loss_of_the_mesh() {
    let mut local = 0;
    for name in PHYSICAL {
        for law in LAWS {
            let Ok(train) = example(name).with_law("mesh_friction", law) else { continue };
            for operation in train.operations() {
                let path = contact_path(&train, Some(&operation.name), None).expect("paths");
                local += usize::from(path.local);
                for m in &path.meshes {
                    let own = m.integrated_loss_w.expect("a computed mesh");
                    let off = (own - m.sliding_loss_w).abs() / m.sliding_loss_w;
                    // The load of helical teeth bends between A to E where a contact line reaches a corner of the
                    // field; the loss factor is integrated from bend to bend, friction from A to E.
                    assert!(off < 2e-5, "{name} {law} {}: {own} against {}", m.name, m.sliding_loss_w);
                    assert!(m.adds_up());
                }
            }
        }
    }
    assert!(local > 0, "no law was local");
}

#[test]
fn the_points_are_those_of_the_contact_report() {
    for name in PHYSICAL {
        let train = example(name);
        let analysis = analyze(&train, &Selection::default()).expect("an analysis");
        for report in &analysis.operations {
            let path = contact_path(&train, Some(&report.name), None).expect("paths");
            for m in &path.meshes {
                let contact = report.solutions[0].contacts.get(&m.name).expect("a contact");
                let least = m.least_film_ratio().expect("an oil");
                let told = contact.film_ratio.expect("an oil");
                // The report looks at the ends of the parts only; points between can be no lower by much.
                assert!((least - told).abs() < 1e-6 * told || least <= told, "{name} {}: {least} {told}", m.name);
                let most = m.points.iter().map(|p| p.pressure_pa).fold(0.0, f64::max);
                assert!(most >= contact.pressure_pa * (1.0 - 1e-9), "{name} {}", m.name);
                let sliding = m.points.iter().map(|p| p.sliding_m_s).fold(0.0, f64::max);
                assert!((sliding - contact.sliding_speed_m_s).abs() < 1e-9 * sliding);
                let pitch = m.points.iter().min_by(|a, b| a.s_mm.abs().total_cmp(&b.s_mm.abs())).expect("points");
                assert!((pitch.sum_speed_m_s - contact.sum_speed_m_s).abs() < 1e-6 * contact.sum_speed_m_s);
                assert!(m.points.windows(2).all(|p| p[0].s_mm < p[1].s_mm));
                assert_eq!(m.friction, contact.friction);
            }
        }
    }
}

#[test]
fn film_by_hand_at_the_pitch_point() {
    // The pitch point of the FVA sun mesh by the law's own formula from the drawn load and speeds.
    let train = example("fva-planetary-stage");
    let path = contact_path(&train, Some("rated"), Some("P1.sun-planet")).expect("a path");
    let m = &path.meshes[0];
    let [a, b, c, d, e] = m.breakpoints_mm;
    assert!(c == 0.0 && a < b && b < d && d < e);
    assert!((m.contact_ratio * std::f64::consts::PI * 4.0 * 20f64.to_radians().cos() - (e - a)).abs() < 1e-9);
    // 1591.549 N m over 3 planets on r_b = 34 cos 20° mm and 50 mm of width; single contact between B and D.
    let single = 1591.549 / 3.0 / (34e-3 * 20f64.to_radians().cos()) / 50e-3;
    let shared = |from: f64, to: f64, share: f64| {
        for p in m.points.iter().filter(|p| p.s_mm > from + 1e-6 && p.s_mm < to - 1e-6) {
            assert!(
                (p.line_load_n_per_m / (single * share) - 1.0).abs() < 2e-3,
                "{} at {}",
                p.line_load_n_per_m,
                p.s_mm
            );
        }
    };
    shared(b, d, 1.0);
    shared(a, b, 0.5);
    shared(d, e, 0.5);
}

#[test]
fn what_is_missing_is_told() {
    let told = |name: &str, operation: Option<&str>, mesh: Option<&str>| {
        contact_path(&example(name), operation, mesh).expect_err("no path").to_string()
    };
    assert!(told("prius-p112", None, None).contains("geometry = { module"));
    assert!(told("fva-planetary-stage", Some("none"), None).contains("`none`"));
    assert!(told("fva-planetary-stage", None, Some("P1.sun")).contains("P1.sun-planet"));
    let text = std::fs::read_to_string(format!("{}/../../examples/nrel-5mw-stage-1.toml", env!("CARGO_MANIFEST_DIR")));
    let text = text.expect("an example");
    let start = text.find("[oil]").expect("an oil");
    let end = text.find("[[set]]").expect("a set");
    let dry = format!("{}[laws]\nmesh_friction = \"constant\"\n{}", &text[..start], &text[end..]);
    let why = contact_path(&Train::from_toml(&dry).expect("a dry train"), None, None).expect_err("no oil").to_string();
    assert!(why.contains("no oil") && why.contains("[oil]"), "{why}");
}
