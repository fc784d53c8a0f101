//! Maps: borders of zones are where they are said to be, and regions hang together.

use willis::study::PointVerdict;
use willis_figure::{EfficiencyMap, MapVerdict, draw_map, efficiency_map};

use crate::common::examples;
use crate::trains::model;

fn map(train: &str) -> EfficiencyMap {
    efficiency_map(&model(train), None, None, &[]).expect("it has a map")
}

/// Where a border lies, in the units of the axes.
fn place(map: &EfficiencyMap, k: usize) -> [f64; 2] {
    let width = map.x.values.len();
    let border = &map.borders[k];
    let at = |p: usize| [map.x.values[p % width], map.y.values[p / width]];
    let [a, b] = border.between.map(at);
    [0, 1].map(|c| a[c] + border.at * (b[c] - a[c]))
}

#[test]
fn neighbours_of_different_zones_have_a_border_and_only_they() {
    for (name, _) in examples() {
        let Ok(map) = efficiency_map(&model(&name), None, None, &[]) else { continue };
        let width = map.x.values.len();
        let differ = |a: usize, b: usize| map.points[a].zone != map.points[b].zone;
        let right = (0..map.points.len()).filter(|k| (k + 1) % width > 0 && differ(*k, k + 1)).count();
        let up = (0..map.points.len() - width).filter(|k| differ(*k, k + width)).count();
        assert_eq!(map.borders.len(), right + up, "{name}");
        for b in &map.borders {
            assert!((0.0..=1.0).contains(&b.at), "{name}: {b:?}");
            assert_eq!(b.between.map(|k| map.points[k].zone), [b.sides[0].zone, b.sides[1].zone], "{name}");
        }
    }
}

/// The Prius loses nothing where all turn together: its ridge is the line of equal speeds, and one region. Its other border is
/// where the sun with 30 teeth stops.
#[test]
fn a_ridge_lies_on_its_line_and_has_no_islands() {
    let map = map("prius-p112");
    assert!(!map.borders.is_empty());
    for k in 0..map.borders.len() {
        let [engine, ring] = place(&map, k);
        let step = (map.x.values[1] - map.x.values[0]).max(map.y.values[1] - map.y.values[0]);
        let away = (engine - ring).abs().min((108.0 / 78.0 * engine - ring).abs());
        assert!(away < 1e-3 * step, "{engine} {ring}");
    }
    let svg = draw_map(&map);
    let bands: Vec<&str> = svg.split("<path").filter(|p| p.contains("id=\"band-")).collect();
    assert!(bands.len() > 4);
    for band in bands {
        let outlines =
            band.split(" d=\"").nth(1).and_then(|d| d.split('"').next()).map_or(0, |d| d.matches('M').count());
        assert!((1..=2).contains(&outlines), "{band}");
    }
}

/// Where gears give way to each other, the input of one of them is at its limit; the map of the 8HP70 allows 2700 rpm and 600 N m.
#[test]
fn gears_change_where_a_limit_is_reached() {
    let map = map("zf-8hp70");
    let limit = |p: &willis_figure::MapPoint, [speed, torque]: [f64; 2]| {
        let (Some(power), Some(efficiency)) = (p.input_power_w, p.efficiency) else { return false };
        // Input torque and speed of the gear that is left, of which the map knows the power.
        let out = speed * std::f64::consts::PI / 30.0 * torque;
        assert!((out / power - efficiency).abs() < 1e-2, "{out} {power} {efficiency}");
        true
    };
    let mut seen = 0;
    for (k, b) in map.borders.iter().enumerate() {
        let at = place(&map, k);
        seen += usize::from(b.sides.iter().any(|p| limit(p, at)));
        assert!(b.sides.iter().any(|p| p.verdict == MapVerdict::Point(PointVerdict::Unique)));
    }
    assert_eq!(seen, map.borders.len());
}

#[test]
fn a_constant_map_is_a_sentence() {
    let svg = draw_map(&map("wolfrom-236"));
    assert!(svg.contains("everywhere") && !svg.contains("<path"), "{svg}");
}
