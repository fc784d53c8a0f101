//! Front views: true involutes, conjugate contact, planets that fit.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use willis::geometry::{involute, least_mesh_angle, neighbour_clearance};
use willis::train::{GearSpec, GeometrySpec, MeshSpec, SetSpec, Train};
use willis_figure::{Front, FrontMesh, FrontWheel, front};

use crate::common::train as example;
use crate::trains::examples;

/// Every view that the examples give, with names.
fn all_views() -> Vec<(String, Train, Front)> {
    let mut all = Vec::new();
    for (name, train) in examples() {
        let sets: Vec<String> = train.sets().iter().map(|s| s.name.clone()).collect();
        for set in sets.iter().map(|s| Some(s.as_str())).chain(sets.is_empty().then_some(None)) {
            match front(&train, set, true) {
                Ok(view) => all.push((format!("{name} {}", view.set), train.clone(), view)),
                Err(why) => eprintln!("{name}: {why}"),
            }
        }
    }
    all
}

fn sense(w: &FrontWheel) -> f64 {
    if w.turns < 0.0 { -1.0 } else { 1.0 }
}

/// Distance of a point from the nearest flank of a body that faces the sense of turning (or the other), mm.
fn to_flank(w: &FrontWheel, body: usize, turned: f64, leading: f64, point: [f64; 2]) -> f64 {
    let b = w.bodies[body];
    let (x, y) = (point[0] - b.centre_mm[0], point[1] - b.centre_mm[1]);
    let radius = x.hypot(y);
    let pitch = TAU / f64::from(w.teeth);
    let half = if w.internal { pitch / 2.0 - w.half_angle(radius) } else { w.half_angle(radius) };
    let off = (y.atan2(x) - (b.phase + turned + leading * half)) / pitch;
    // Along the circle; the flank is nearer still.
    (off - off.round()).abs() * pitch * radius
}

#[test]
fn flanks_are_involutes_between_tip_and_form_circle() {
    for (name, _, view) in all_views() {
        for w in &view.wheels {
            let pitch = TAU / f64::from(w.teeth);
            let mut on_flank = 0;
            for p in &w.outline_mm {
                let (radius, angle) = (p[0].hypot(p[1]), p[1].atan2(p[0]).abs());
                let (low, high) = (w.tip_radius_mm.min(w.root_radius_mm), w.tip_radius_mm.max(w.root_radius_mm));
                assert!(radius > low - 1e-9 && radius < high + 1e-9, "{name} {}: {radius}", w.name);
                assert!(angle < pitch / 2.0 + 1e-12);
                if radius < w.base_radius_mm {
                    continue;
                }
                // The unwound string: its length is the arc of the base circle that it left.
                let string = (radius * radius - w.base_radius_mm.powi(2)).sqrt();
                let unwound = string / w.base_radius_mm - (string / w.base_radius_mm).atan();
                let half = if w.internal { pitch / 2.0 - angle } else { angle };
                if (w.base_half_angle - unwound - half).abs() * radius < 1e-9 {
                    on_flank += 1;
                }
            }
            assert!(on_flank >= 24, "{name} {}: {on_flank} points on involutes", w.name);
        }
    }
}

#[test]
fn thickness_at_the_reference_circle_is_the_textbooks() {
    for (_, train, view) in all_views().into_iter().filter(|v| !v.2.assumed) {
        let teeth = train.meshes()[0].teeth.as_ref().expect("teeth");
        let (alpha, beta) = (teeth.pair.data.pressure_angle, teeth.pair.data.helix);
        for w in &view.wheels {
            // s_t = m_t (π/2 + 2 x tan α_n); on a ring the width of its space.
            let module = w.module_mm / beta.cos();
            let textbook =
                w.module_mm / beta.cos() * FRAC_PI_2 + 2.0 * w.shift * w.module_mm * alpha.tan() / beta.cos();
            let drawn = 2.0 * w.half_angle(w.reference_radius_mm) * w.reference_radius_mm;
            assert!((drawn - textbook).abs() < 1e-9, "{drawn} {textbook}");
            assert!((w.reference_radius_mm - module * f64::from(w.teeth) / 2.0).abs() < 1e-9);
        }
    }
}

#[test]
fn radii_and_path_are_those_of_the_geometry() {
    for (name, train, view) in all_views().into_iter().filter(|v| !v.2.assumed) {
        for m in &view.meshes {
            let mesh = train.meshes().iter().find(|o| o.name == m.name).expect("the mesh");
            let pair = &mesh.teeth.as_ref().expect("teeth").pair;
            assert!((m.centre_distance_mm - pair.centre_distance * 1e3).abs() < 5e-3 * pair.data.module * 1e3);
            assert!((m.contact_ratio - pair.contact_ratio).abs() < 1e-3, "{name}");
            for (k, &w) in m.wheels.iter().enumerate() {
                // The first wheel drives; in these files that is the first gear.
                let gear = &pair.gears[k];
                let wheel = &view.wheels[w];
                for (a, b) in [
                    (wheel.tip_radius_mm, gear.tip_radius),
                    (wheel.root_radius_mm, gear.root_radius),
                    (wheel.base_radius_mm, gear.base_radius),
                ] {
                    assert!((a - b * 1e3).abs() < 1e-9, "{name}");
                }
                let ends = wheel.outline_mm.iter().map(|p| p[0].hypot(p[1]));
                let (low, high) = ends.fold((f64::INFINITY, 0.0f64), |(l, h), r| (l.min(r), h.max(r)));
                let (tip, root) = if wheel.internal { (low, high) } else { (high, low) };
                assert!((tip - wheel.tip_radius_mm).abs() < 1e-9 && (root - wheel.root_radius_mm).abs() < 1e-9);
            }
        }
    }
}

/// Points of contact of a mesh after the first wheel has turned: where its leading flank crosses the
/// line of action, distances from C.
fn contacts(view: &Front, m: &FrontMesh, turned: f64) -> Vec<f64> {
    let driver = &view.wheels[m.wheels[0]];
    // Along the line of action the flank travels as fast as the base circle turns.
    let start = m.path_mm[0];
    let travel = |s: f64| {
        let p = m.point(s);
        let (x, y) = (p[0] - driver.bodies[0].centre_mm[0], p[1] - driver.bodies[0].centre_mm[1]);
        let radius = x.hypot(y);
        let pitch = TAU / f64::from(driver.teeth);
        let half = if driver.internal { pitch / 2.0 - driver.half_angle(radius) } else { driver.half_angle(radius) };
        let flank = driver.bodies[0].phase + turned * driver.turns + sense(driver) * half;
        let behind = sense(driver) * (y.atan2(x) - flank);
        behind.rem_euclid(pitch) * driver.base_radius_mm
    };
    // From A the next flank is so far behind.
    let mut s = start - travel(start) + m.base_pitch_mm;
    let mut all = Vec::new();
    while s <= m.path_mm[4] {
        if s >= start {
            all.push(s);
        }
        s += m.base_pitch_mm;
    }
    all
}

#[test]
fn flanks_touch_on_the_line_of_action() {
    let mut seen = 0;
    for (name, _, view) in all_views() {
        if view.wheels[0].turns == 0.0 {
            continue;
        }
        for m in &view.meshes {
            for step in 0..40 {
                let turned = 0.0173 * f64::from(step);
                let all = contacts(&view, m, turned);
                assert!(m.contact_ratio < 1.0 || !all.is_empty(), "{name} {}: no contact", m.name);
                for s in all {
                    let p = m.point(s);
                    for &w in &m.wheels {
                        let wheel = &view.wheels[w];
                        // The driven wheel is pushed on its trailing flank.
                        let leading = if w == m.wheels[0] { sense(wheel) } else { -sense(wheel) };
                        let off = to_flank(wheel, 0, turned * wheel.turns, leading, p);
                        assert!(off < 1e-8, "{name} {} at {s}: {off} mm off {}", m.name, wheel.name);
                        seen += 1;
                    }
                }
            }
        }
    }
    assert!(seen > 2000, "{seen}");
}

/// Outline of a whole wheel in its place.
fn whole(w: &FrontWheel, body: usize, turned: f64) -> Vec<[f64; 2]> {
    let b = w.bodies[body];
    let pitch = TAU / f64::from(w.teeth);
    let mut all = Vec::new();
    for k in 0..w.teeth {
        let (sin, cos) = (b.phase + turned + f64::from(k) * pitch).sin_cos();
        for p in &w.outline_mm {
            all.push([b.centre_mm[0] + p[0] * cos - p[1] * sin, b.centre_mm[1] + p[0] * sin + p[1] * cos]);
        }
    }
    all
}

/// How deep a point lies in the material of a wheel, mm along the circle; negative outside.
fn depth(w: &FrontWheel, body: usize, turned: f64, p: [f64; 2]) -> f64 {
    let b = w.bodies[body];
    let (x, y) = (p[0] - b.centre_mm[0], p[1] - b.centre_mm[1]);
    let radius = x.hypot(y);
    let beyond = if w.internal { w.tip_radius_mm - radius } else { radius - w.tip_radius_mm };
    if beyond >= 0.0 {
        return -beyond;
    }
    let pitch = TAU / f64::from(w.teeth);
    let off = (y.atan2(x) - b.phase - turned) / pitch;
    let off = (off - off.round()).abs() * pitch;
    // The drawn tooth at this radius.
    let side: Vec<[f64; 2]> =
        w.outline_mm.iter().filter(|p| p[1] >= 0.0).map(|p| [p[0].hypot(p[1]), p[1].atan2(p[0])]).collect();
    let mut half: f64 = 0.0;
    for pair in side.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        let (low, high) = (a[0].min(b[0]), a[0].max(b[0]));
        if radius >= low && radius <= high && high > low {
            half = half.max(a[1] + (b[1] - a[1]) * (radius - a[0]) / (b[0] - a[0]));
        }
    }
    let below = if w.internal { radius > w.root_radius_mm } else { radius < w.root_radius_mm };
    if below { pitch * radius } else { (half - off) * radius }
}

#[test]
fn teeth_never_cut_into_each_other() {
    for (name, _, view) in all_views() {
        for m in &view.meshes {
            if m.backlash_mm < -1e-6 {
                continue;
            }
            let [a, b] = m.wheels.map(|w| &view.wheels[w]);
            let module = a.module_mm;
            // Some teeth are such that a tip reaches below the involute of its mate: the notes say so. Standard
            // teeth of undercut planets do the same with a ring.
            let told = view.notes.iter().any(|n| n.starts_with(&m.name));
            let most = if told || view.assumed { 0.03 } else { 4e-3 };
            for k in 0..a.bodies.len().max(b.bodies.len()) {
                for step in 0..7 {
                    let turned = 0.031 * f64::from(step);
                    let (i, j) = (k.min(a.bodies.len() - 1), k.min(b.bodies.len() - 1));
                    let mut worst = f64::NEG_INFINITY;
                    for p in whole(a, i, turned * a.turns) {
                        worst = worst.max(depth(b, j, turned * b.turns, p));
                    }
                    for p in whole(b, j, turned * b.turns) {
                        worst = worst.max(depth(a, i, turned * a.turns, p));
                    }
                    // Chords leave the flanks a little; contact itself is at zero.
                    assert!(worst < most * module, "{name} {} planet {k}: {worst} mm deep", m.name);
                    assert!(worst > -0.2 * module, "{name} {} planet {k}: gap {worst} mm", m.name);
                }
            }
        }
    }
}

#[test]
fn planets_stand_where_the_textbook_says() {
    let view = front(&example("fva-planetary-stage"), None, false).expect("a view");
    assert!(view.spacing.equal && view.spacing.given && view.spacing.planets == 3);
    let least = view.spacing.least_angle.expect("a lattice");
    assert!((least - least_mesh_angle(17.0, 61.0)).abs() < 1e-12);
    let tip = view.wheels[1].tip_radius_mm;
    let gap = neighbour_clearance(view.meshes[0].centre_distance_mm, 3, tip);
    assert!((view.spacing.clearance_mm.expect("neighbours") - gap).abs() < 1e-9);
    // 17 + 24 teeth and 67: four planets do not divide 84/4 = 21, five do not divide 84.
    for (n, equal) in [(3, true), (4, true), (5, false)] {
        let train = Train::builder("set")
            .members(["s", "r", "c"])
            .set(SetSpec::simple("P", ("s", 17), ("r", 67), "c").planet(24, n))
            .build()
            .expect("a train");
        let view = front(&train, Some("P"), true).expect("a view");
        assert_eq!(view.spacing.equal, equal, "{n} planets");
        let step = TAU / 84.0;
        for (k, angle) in view.spacing.angles.iter().enumerate() {
            assert!(((angle / step) - (angle / step).round()).abs() < 1e-9);
            assert!((angle - TAU * k as f64 / n as f64).abs() <= step / 2.0 + 1e-9);
        }
    }
    // 100/101 and 99/100: (100 · 100 − 99 · 101)/gcd = 1, so planets alike have one place only.
    let view = front(&example("esmail-10000"), None, true).expect("a view");
    assert_eq!(view.spacing.planets, 1);
    assert!((view.spacing.least_angle.expect("a lattice") - TAU).abs() < 1e-9);
    // A double planet: z_ring − z_sun.
    let train = Train::builder("set")
        .members(["s", "r", "c"])
        .set(SetSpec::double_planet("P", ("s", 38), ("r", 83), "c").planet(12, 3).second_planet(12))
        .build()
        .expect("a train");
    let view = front(&train, None, true).expect("a view");
    assert!((view.spacing.least_angle.expect("a lattice") - TAU / 45.0).abs() < 1e-12);
}

#[test]
fn a_bevel_set_and_missing_teeth_are_told() {
    let why = front(&example("bevel-differential"), None, true).expect_err("bevel").to_string();
    assert!(why.contains("bevel"), "{why}");
    let why = front(&example("prius-p112"), None, false).expect_err("no teeth").to_string();
    assert!(why.contains("geometry = { module") && why.contains("`nominal`"), "{why}");
    let why = front(&example("prius-p112"), Some("P9"), true).expect_err("no set").to_string();
    assert!(why.contains("P9"), "{why}");
}

#[test]
fn a_pair_of_gears_has_a_front_view() {
    let geometry = GeometrySpec::new(willis::units::Length::mm(4.5), willis::units::Length::mm(14.0));
    let train = Train::builder("pair")
        .members(["a", "b"])
        .mesh(MeshSpec::new(GearSpec::external("a", 16), GearSpec::external("b", 24)).named("ab").geometry(geometry))
        .build()
        .expect("a train");
    let view = front(&train, None, false).expect("a view");
    assert_eq!((view.wheels.len(), view.kind.as_str()), (2, "pair"));
    let m = &view.meshes[0];
    assert!((m.centre_distance_mm - 90.0).abs() < 1e-9);
    let inv = involute(m.pressure_angle);
    assert!((inv - (20f64.to_radians().tan() - 20.0 * PI / 180.0)).abs() < 1e-12);
}
