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

/// Pieces of the contours of a map: what each is a line of, its box on the page, and whether it is closed.
fn contours(svg: &str) -> Vec<(String, [f64; 4], bool)> {
    let document = roxmltree::Document::parse(svg).expect("well-formed");
    let mut all = vec![];
    for path in document.descendants().filter(|n| n.attribute("id").is_some_and(|id| id.starts_with("contour-"))) {
        let name = path.attribute("data-quantity").unwrap_or_default();
        for piece in path.attribute("d").unwrap_or_default().split('M').filter(|p| !p.trim().is_empty()) {
            let numbers: Vec<f64> =
                piece.split(|c: char| c == 'L' || c.is_whitespace()).filter_map(|n| n.parse().ok()).collect();
            let mut bounds = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
            for p in numbers.chunks_exact(2) {
                bounds = [bounds[0].min(p[0]), bounds[1].min(p[1]), bounds[2].max(p[0]), bounds[3].max(p[1])];
            }
            all.push((name.to_owned(), bounds, numbers.first_chunk::<2>() == numbers.last_chunk()));
        }
    }
    all
}

/// A closed line of a coarse map that is no longer than a few cells is one of a map with a grid four times as fine too.
#[test]
fn small_islands_are_there_on_a_finer_grid_too() {
    // The page of a map has about 600 by 400 units.
    const COARSE: [usize; 2] = [21, 16];
    let cell = 600.0 / (COARSE[0] - 1) as f64;
    let mut pieces = 0;
    for name in ["prius-hybrid", "prius-p112", "two-mode-split", "tractor-hydrostat", "belt-ivt", "compound-split"] {
        let usual = efficiency_map(&model(name), None, None, &[]).expect("it has a map");
        let drawn = |part: usize| {
            let axis = |a: &willis_figure::ChartAxis, count: usize| {
                let (first, last, unit) = (a.values[0], a.values[a.values.len() - 1], &a.unit);
                format!("{}={first} {unit}..{last} {unit}:{}", a.name, (count - 1) * part + 1)
            };
            let over = [axis(&usual.x, COARSE[0]), axis(&usual.y, COARSE[1])];
            contours(&draw_map(&efficiency_map(&model(name), None, None, &over).expect("it has a map")))
        };
        let (coarse, fine) = (drawn(1), drawn(4));
        for (line, [x0, y0, x1, y1], closed) in &coarse {
            pieces += 1;
            if !closed || x1 - x0 > 3.0 * cell || y1 - y0 > 3.0 * cell {
                continue;
            }
            let near = |other: &[f64; 4]| {
                let apart = (other[0] - x1).max(x0 - other[2]).max(other[1] - y1).max(y0 - other[3]);
                apart < 2.0 * cell && other[2] - other[0] < 6.0 * cell && other[3] - other[1] < 6.0 * cell
            };
            let known = fine.iter().any(|(own, other, _)| own == line && near(other));
            assert!(known, "{name}: {line} at {x0} {y0} {x1} {y1}");
        }
    }
    assert!(pieces > 20, "{pieces}");
}

/// Two borders of the Prius pass each other in narrow wedges: where a machine stands, and where all turn together. Along them
/// every line is whole, once on each side.
#[test]
fn lines_beside_a_ridge_are_whole() {
    let map = map("prius-hybrid");
    let all = contours(&draw_map(&map));
    let efficiencies = all.iter().filter(|c| c.0.starts_with("efficiency"));
    let mut pieces = std::collections::BTreeMap::new();
    efficiencies.for_each(|c| *pieces.entry(&c.0).or_insert(0) += 1);
    assert!(pieces.len() > 4 && pieces.values().all(|n| *n <= 2), "{pieces:?}");
    // No zone lies unseen between two neighbours: over a border efficiency has a kink, or the small step of a machine that turns
    // from motor to generator.
    for b in &map.borders {
        let [one, other] = [&b.sides[0], &b.sides[1]].map(|s| s.efficiency.unwrap_or(0.0));
        assert!((one - other).abs() < 0.01, "{b:?}");
    }
}

#[test]
fn a_constant_map_is_a_sentence() {
    let svg = draw_map(&map("wolfrom-236"));
    assert!(svg.contains("everywhere") && !svg.contains("<path"), "{svg}");
}

/// Most points are answered by a compiled train; the expected ones are those of the analysis, asked one at a time.
#[test]
fn points_are_those_of_the_analysis() {
    use willis::model::Target;
    use willis::study::{Hold, PointAnswer, PointSetup};
    let (mut points, mut verdicts) = (0, std::collections::BTreeSet::new());
    for (name, _) in examples() {
        let own = model(&name);
        let Ok(map) = efficiency_map(&own, None, None, &[]) else { continue };
        let first = own.train().states().first().filter(|_| own.train().operations().is_empty());
        let question =
            PointSetup::new(&own, None, first.map(|s| s.name.as_str()), Hold::AsGiven).expect("it has a map");
        let [x, y] = [&map.x, &map.y].map(|a| Target::parse(&a.name, &own).expect("a quantity"));
        let width = map.x.values.len();
        let mut trains = willis::study::TrainCache::default();
        let inner = |k: &usize| (1..width - 1).contains(&(k % width));
        for k in (0..map.points.len()).filter(inner).step_by(41) {
            let p = &map.points[k];
            let state = (!map.states.is_empty()).then(|| p.best.map(|k| map.states[k].clone()));
            if state == Some(None) {
                continue;
            }
            let mut ask = |x_at: f64, y_at: f64| {
                let mut settings = vec![(&x, format!("{x_at} {}", map.x.unit)), (&y, format!("{y_at} {}", map.y.unit))];
                settings.extend(state.clone().flatten().map(|s| (&Target::State, s)));
                let (train, operation) = question.at(&settings, &mut trains).expect("an operating point");
                PointAnswer::of(&train, &operation)
            };
            let same = |answer: &PointAnswer| {
                let s = answer.solution.as_ref().filter(|_| answer.is_unique());
                let close = |ours: Option<f64>, theirs: Option<f64>, size: Option<f64>| match (ours, theirs, size) {
                    (Some(a), Some(b), Some(size)) => (a - b).abs() <= 1e-11 * size.abs(),
                    (a, b, _) => a == b,
                };
                let power = s.map(|s| s.input_power_w);
                let efficiency = s.and_then(|s| s.efficiency);
                p.verdict == MapVerdict::Point(answer.verdict)
                    && close(p.efficiency, efficiency, efficiency)
                    && close(p.input_power_w, power, power)
                    // A difference of powers.
                    && close(p.loss_w, s.map(|s| s.loss_w), power)
            };
            let [u, v] = [map.x.values[k % width], map.y.values[k / width]];
            let answer = ask(u, v);
            // A point on a border is told as what lies a millionth of a step inwards of it.
            let inwards = |values: &[f64], k: usize| values[k] + 1e-6 * (values[k + 1] - values[k]);
            let beside = || [inwards(&map.x.values, k % width), inwards(&map.y.values, k / width)];
            if !same(&answer) {
                let [u, v] = beside();
                let answer = ask(u, v);
                assert!(same(&answer), "{name}, {u} and {v}: {p:?}, {:?}", answer.solution.map(|s| s.efficiency));
            }
            verdicts.insert(answer.verdict);
            points += 1;
        }
    }
    assert!(points > 500 && verdicts.len() >= 2, "{points} {verdicts:?}");
}
