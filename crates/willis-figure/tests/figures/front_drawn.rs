//! Front views, films and paths as pictures.

use willis::train::{SetSpec, Train};
use willis_figure::{contact_path, front};

use crate::common::train as example;

/// A picture in which nothing is undefined, and no text is finer than 10 px.
fn sound(svg: &str) {
    assert!(!svg.contains("NaN") && !svg.contains("inf\""), "undefined numbers");
    // What stands before the first size is none.
    for size in svg.split("font-size=\"").skip(1) {
        let size: f64 = size.split('"').next().and_then(|s| s.parse().ok()).expect("a size");
        assert!(size >= 10.0, "{size}");
    }
}

#[test]
fn large_rings_and_many_planets_are_drawn() {
    let long = "太阳轮 с очень длинным именем <&\" и ещё длиннее, до конца";
    let train = Train::builder("Großes Getriebe <&\"")
        .members([long, "ring", "carrier"])
        .set(SetSpec::simple("P", (long, 412), ("ring", 500), "carrier").planet(44, 12))
        .build()
        .expect("a train");
    let view = front(&train, None, true).expect("a view");
    assert_eq!(view.spacing.planets, 12);
    let svg = willis_figure::draw_front(&view, false);
    sound(&svg);
    assert!(svg.contains("&lt;&amp;") && svg.len() < 1_000_000, "{} bytes", svg.len());
}

#[test]
fn the_moving_picture_turns_by_the_exact_ratios() {
    let view = front(&example("fva-planetary-stage"), None, false).expect("a view");
    let svg = willis_figure::draw_front(&view, true);
    sound(&svg);
    let periods: Vec<f64> = svg
        .split("animation: turn ")
        // What stands before the first period is none.
        .skip(1)
        .map(|t| t.split('s').next().and_then(|s| s.parse().ok()).expect("a period"))
        .collect();
    // Ring, sun, three planets: one tooth of each passes in the same time.
    assert_eq!(periods.len(), 5);
    for (period, teeth) in periods.iter().zip([61.0, 17.0, 22.0, 22.0, 22.0]) {
        assert!((period / teeth - periods[0] / 61.0).abs() < 1e-6, "{period} s for {teeth} teeth");
    }
    // Who wants no motion gets none.
    assert!(svg.contains("prefers-reduced-motion: reduce") && !svg.contains("<animate"));
    // Without the motion it is the still picture.
    let mut still = svg;
    let cuts = [("<style>", "</style>", ""), (" style=\"", "\"", "transform-origin"), (" class=\"turns", "\"", "")];
    for (open, close, with) in cuts {
        while let Some(from) = still.find(&format!("{open}{with}")) {
            let inside = from + open.len();
            let to = inside + still[inside..].find(close).expect("an end") + close.len();
            still.replace_range(from..to, "");
        }
    }
    let plain = |s: &str| s.chars().filter(|c| !c.is_whitespace()).collect::<String>();
    assert_eq!(plain(&still), plain(&willis_figure::draw_front(&view, false)));
}

#[test]
fn films_and_paths_are_drawn_for_every_law_and_operating_point() {
    for name in ["fva-planetary-stage", "nrel-5mw-stage-1", "wang-herringbone-physical"] {
        for law in ["schlenk", "xu-kahraman"] {
            let train = example(name).with_law("mesh_friction", law).expect("a law");
            for operation in train.operations() {
                let path = contact_path(&train, Some(&operation.name), None).expect("a path");
                for svg in [willis_figure::draw_film(&path), willis_figure::draw_path(&path)] {
                    sound(&svg);
                    for m in &path.meshes {
                        assert!(svg.contains(&m.name));
                    }
                }
            }
        }
    }
}

/// What a program that draws parts gets is the geometry itself.
#[test]
fn every_dxf_has_all_teeth_between_root_and_tip() {
    let mut seen = 0;
    for (name, train) in crate::trains::examples() {
        let Ok(view) = front(&train, None, true) else { continue };
        seen += 1;
        let dxf = willis_figure::front_dxf(&view);
        let lines: Vec<&str> = dxf.lines().collect();
        assert!(dxf.is_ascii() && lines.len().is_multiple_of(2), "{name}: pairs of code and value");
        let pairs: Vec<(u16, &str)> = lines.chunks(2).map(|p| (p[0].parse().expect("a group code"), p[1])).collect();
        assert_eq!(pairs.last(), Some(&(0, "EOF")), "{name}");
        let entities: Vec<&[(u16, &str)]> = pairs.chunk_by(|_, next| next.0 != 0).collect();
        let of = |e: &[(u16, &str)], code: u16| e.iter().find(|p| p.0 == code).map_or("", |p| p.1).to_owned();
        for (k, w) in view.wheels.iter().enumerate() {
            let layer = format!("WHEEL_{}", k + 1);
            let own = || entities.iter().filter(|e| of(e, 8) == layer);
            assert_eq!(own().filter(|e| of(e, 0) == "POLYLINE").count(), w.bodies.len(), "{name}");
            let points: Vec<[f64; 2]> = own()
                .filter(|e| of(e, 0) == "VERTEX")
                .map(|e| [10, 20].map(|c| of(e, c).parse().expect("a coordinate")))
                .collect();
            assert!(points.len() >= 4 * w.teeth as usize * w.bodies.len(), "{name}");
            let (low, high) = (w.tip_radius_mm.min(w.root_radius_mm), w.tip_radius_mm.max(w.root_radius_mm));
            for (body, all) in w.bodies.iter().zip(points.chunks(points.len() / w.bodies.len())) {
                for p in all {
                    let r = (p[0] - body.centre_mm[0]).hypot(p[1] - body.centre_mm[1]);
                    assert!(r > low - 0.01 * w.module_mm && r < high + 0.01 * w.module_mm, "{name}: {low} {r} {high}");
                }
            }
        }
        let numbers = || entities.iter().filter(|e| of(e, 8) == "NUMBERS");
        assert_eq!(numbers().count(), view.wheels.len(), "{name}");
        // They stand in a column of their own, beside all wheels.
        let x = |e: &[(u16, &str)]| of(e, 10).parse::<f64>().expect("a coordinate");
        let teeth = entities.iter().filter(|e| of(e, 0) == "VERTEX").map(|e| x(e)).fold(f64::MIN, f64::max);
        let columns: Vec<f64> = numbers().map(|e| x(e)).collect();
        assert!(columns.iter().all(|c| *c == columns[0] && *c > teeth), "{name}: {columns:?} {teeth}");
    }
    assert!(seen > 5, "{seen}");
}
