//! Efficiency maps.

use std::fmt::Write;

use contour::ContourBuilder;
use svg::Node as _;
use svg::node::element::{ClipPath, Definitions, Group, Path};
use willis::study::PointVerdict;

use crate::parts::chart::{Chart, Scale, title};
use crate::parts::style::{
    Anchor, BOLD, FAINT, INK, LINE, PAPER, badge, colour, digits, fit, halo, line, lines, number, page, rectangle,
    text, watts, wide,
};
use crate::{Drawing, EfficiencyMap, MapVerdict};

const WIDTH: f64 = 940.0;
const NARROWEST: f64 = 640.0;
const LEFT: f64 = 92.0;
/// The legend is so far from the chart, and so wide.
const BESIDE: f64 = 26.0;
const LEGEND: f64 = 224.0;
const HEIGHT: f64 = 400.0;

/// Losses in per cent at which colours change.
const LOSSES: [f64; 19] =
    [0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0, 10.0, 15.0, 20.0, 30.0, 50.0, 70.0];
/// Bands of colour at most.
const BANDS: usize = 9;

/// From little loss to much: lightness falls all the way, so that grey tells the same.
const RAMP: [[u8; 3]; 6] = [
    [0xfb, 0xf8, 0xcf],
    [0xd3, 0xec, 0xb4],
    [0x8f, 0xd3, 0xb9],
    [0x45, 0xb1, 0xc4],
    [0x2a, 0x86, 0xbb],
    [0x2b, 0x58, 0x9c],
];

fn ramp(part: f64) -> String {
    let place = part.clamp(0.0, 1.0) * (RAMP.len() - 1) as f64;
    let k = (place as usize).min(RAMP.len() - 2);
    let mix = |c: usize| {
        let (a, b) = (f64::from(RAMP[k][c]), f64::from(RAMP[k + 1][c]));
        (a + (place - k as f64) * (b - a)).round() as u8
    };
    format!("#{:02x}{:02x}{:02x}", mix(0), mix(1), mix(2))
}

/// An efficiency map: filled, labelled bands, lines of constant input power, hatching where there is no single answer,
/// the operations of the file as points; of an automatic transmission below it the state that is best at every point.
pub fn draw(map: &EfficiencyMap) -> String {
    draw_on(map, Drawing::default())
}

pub(super) fn draw_on(map: &EfficiencyMap, paper: Drawing) -> String {
    let width = paper.page(WIDTH, NARROWEST);
    // Lower on narrow paper, twice so where two stand below each other.
    let part = width / WIDTH;
    let tall = HEIGHT * if map.states.is_empty() { part } else { part * part };
    let mut top = 64.0;
    let mut body = Group::new().add(
        text(28.0, 38.0, 20.0, Anchor::Start, &fit(&map.title, (width - 56.0) / BOLD, 20.0)).set("font-weight", "bold"),
    );
    for l in lines(&map.basis, width - 56.0, 13.0) {
        body = body.add(text(28.0, top - 4.0, 13.0, Anchor::Start, &l).set("fill", FAINT));
        top += 17.0;
    }
    top += 22.0;
    let chart = |top: f64| Chart {
        left: LEFT,
        top,
        right: width - LEGEND - BESIDE,
        bottom: top + tall,
        x: Scale::of(map.x.values.iter().copied(), title(&map.x)),
        y: Scale::of(map.y.values.iter().copied(), title(&map.y)),
    };
    body = body.add(efficiency(map, &chart(top), 0));
    let mut bottom = top + tall + 60.0;
    if !map.states.is_empty() {
        body = body.add(states(map, &chart(bottom)));
        bottom += tall + 60.0;
    }
    page(width, bottom, &format!("Efficiency map of {}", map.title), &words(map)).add(body).to_string()
}

/// What the picture tells those who do not see it.
fn words(map: &EfficiencyMap) -> String {
    let known = || map.points.iter().filter_map(|p| p.efficiency);
    let (least, most) = known().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, m), e| (l.min(e), m.max(e)));
    let mut out = format!("Efficiency over {} and {}. {}. ", map.x.name, map.y.name, map.basis);
    match known().count() {
        0 => out += "No point has an efficiency. ",
        _ => {
            let _ = write!(out, "It lies between {} and {}. ", percent(least), percent(most));
        }
    }
    for (verdict, count) in verdicts(map) {
        let _ = write!(out, "{count} of {} points: {}. ", map.points.len(), says(verdict));
    }
    out.trim_end().to_owned()
}

fn percent(x: f64) -> String {
    let text = format!("{:.2}", 100.0 * x);
    format!("{} %", text.trim_end_matches('0').trim_end_matches('.'))
}

/// Verdicts other than `unique` that occur, and how often.
fn verdicts(map: &EfficiencyMap) -> Vec<(MapVerdict, usize)> {
    let mut all: Vec<(MapVerdict, usize)> = vec![];
    for p in map.points.iter().filter(|p| p.verdict != UNIQUE) {
        match all.iter_mut().find(|v| v.0 == p.verdict) {
            Some(v) => v.1 += 1,
            None => all.push((p.verdict, 1)),
        }
    }
    all
}

const UNIQUE: MapVerdict = MapVerdict::Point(PointVerdict::Unique);

fn says(verdict: MapVerdict) -> &'static str {
    match verdict {
        MapVerdict::Point(PointVerdict::Locked) => "locked",
        MapVerdict::Point(PointVerdict::Multiple) => "several solutions",
        MapVerdict::Point(PointVerdict::Unloaded) => "no load",
        MapVerdict::Point(PointVerdict::Undetermined) => "not determined",
        MapVerdict::Beyond => "beyond every state",
        MapVerdict::Point(_) => "no question there",
    }
}

/// Values on the points of the map, which lie between those of the library's cells.
fn builder(map: &EfficiencyMap) -> ContourBuilder {
    // Values stand in the middle of the library's cells, half a cell inside.
    ContourBuilder::new(map.x.values.len(), map.y.values.len(), true).x_origin(-0.5).y_origin(-0.5)
}

/// From positions among the values of an axis to its values.
fn value(values: &[f64], place: f64) -> f64 {
    let place = place.clamp(0.0, (values.len() - 1) as f64);
    let k = (place as usize).min(values.len() - 2);
    values[k] + (place - k as f64) * (values[k + 1] - values[k])
}

fn ring<'a>(map: &EfficiencyMap, chart: &Chart, points: impl Iterator<Item = (f64, f64)> + 'a) -> Vec<(f64, f64)> {
    points.map(|(a, b)| (chart.x(value(&map.x.values, a)), chart.y(value(&map.y.values, b)))).collect()
}

fn d(points: &[(f64, f64)], close: bool) -> String {
    let all: Vec<String> = points.iter().map(|p| format!("{} {}", number(p.0), number(p.1))).collect();
    format!("M{}{}", all.join(" L"), if close { " Z" } else { "" })
}

/// Losses that part the bands of this map, none of which is a mere sliver.
fn levels(losses: &[f64]) -> Vec<f64> {
    let mut sorted: Vec<f64> = losses.iter().copied().filter(|l| l.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    let below = |l: f64| sorted.partition_point(|x| *x < l);
    let sliver = sorted.len().div_ceil(60);
    let mut taken = 0;
    let within: Vec<f64> = (LOSSES.iter().map(|p| p / 100.0))
        .filter(|l| {
            let here = below(*l);
            let wide = here >= taken + sliver && here + sliver <= sorted.len();
            taken = if wide { here } else { taken };
            wide
        })
        .collect();
    let every = within.len().div_ceil(BANDS - 1).max(1);
    within.into_iter().step_by(every).collect()
}

fn efficiency(map: &EfficiencyMap, chart: &Chart, number_of: usize) -> Group {
    let losses: Vec<f64> = map.points.iter().map(|p| p.efficiency.map_or(f64::NAN, |e| 1.0 - e)).collect();
    let (least, most) = (losses.iter().filter(|l| l.is_finite()))
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), l| (a.min(*l), b.max(*l)));
    let clip = format!("map{number_of}");
    let frame = rectangle(chart.left, chart.top, chart.right - chart.left, chart.bottom - chart.top, "none");
    let mut g = Group::new().add(Definitions::new().add(ClipPath::new().set("id", clip.clone()).add(frame)));
    let mut fills = Group::new().set("clip-path", format!("url(#{clip})"));
    let between = levels(&losses);
    let shades = between.len() + 1;
    // What has no value takes that of its nearest neighbours, and is hatched over.
    let filled = without_gaps(map, &losses);
    // From one state to the next the efficiency jumps: nothing lies between.
    let steps = !map.states.is_empty();
    let shade = |k: usize| ramp(if shades > 1 { k as f64 / (shades - 1) as f64 } else { 0.0 });
    if steps {
        let band = |p: usize| losses[p].is_finite().then(|| between.partition_point(|l| *l <= losses[p]));
        runs(map, chart, &band, &mut |[x0, y0, x1, y1], k| {
            let (fill, stroke) = (shade(k), shade(k));
            let cell = rectangle(x0, y0, x1 - x0, y1 - y0, &fill);
            fills.append(cell.set("stroke", stroke).set("stroke-width", 0.6));
        });
    } else if least.is_finite() {
        let mut at = vec![-1e9];
        at.extend(&between);
        at.push(1e9);
        let bands = builder(map).isobands(&filled, &at).unwrap_or_default();
        for (k, band) in bands.iter().enumerate() {
            let fill = shade(k);
            let mut path = String::new();
            for polygon in band.geometry() {
                for r in std::iter::once(polygon.exterior()).chain(polygon.interiors()) {
                    path += &d(&ring(map, chart, r.coords().map(|c| (c.x, c.y))), true);
                }
            }
            if !path.is_empty() {
                let stroke = fill.clone();
                fills = fills.add(
                    Path::new()
                        .set("d", path)
                        .set("fill", fill)
                        .set("fill-rule", "evenodd")
                        .set("stroke", stroke)
                        .set("stroke-width", 0.7),
                );
            }
        }
    }
    // Lines between the bands with their efficiency.
    let marks = places(map, chart);
    let mut labels: Vec<[f64; 4]> = marks.iter().map(|p| [p.0 - 11.0, p.1 - 11.0, p.0 + 11.0, p.1 + 11.0]).collect();
    let mut said = Group::new();
    let parting = if steps { &[][..] } else { &between };
    for l in builder(map).lines(&filled, parting).unwrap_or_default() {
        let name = percent(1.0 - l.threshold());
        let mut longest: Vec<(f64, f64)> = vec![];
        for points in open_lines(map, chart, l.geometry().iter().map(|one| one.coords().map(|c| (c.x, c.y)))) {
            fills = fills.add(
                Path::new().set("d", d(&points, false)).set("fill", "none").set("stroke", INK).set("stroke-width", 0.6),
            );
            if points.len() > longest.len() {
                longest = points;
            }
        }
        if let Some(t) = label(&longest, &name, chart, &mut labels, INK) {
            said = said.add(t);
        }
    }
    // Constant power into the train.
    let power: Vec<f64> = map.points.iter().map(|p| p.input_power_w.unwrap_or(f64::NAN)).collect();
    let powers = powers(&power);
    for l in builder(map).lines(&without_gaps(map, &power), &powers).unwrap_or_default() {
        let mut longest: Vec<(f64, f64)> = vec![];
        for points in open_lines(map, chart, l.geometry().iter().map(|one| one.coords().map(|c| (c.x, c.y)))) {
            fills = fills.add(
                Path::new()
                    .set("d", d(&points, false))
                    .set("fill", "none")
                    .set("stroke", FAINT)
                    .set("stroke-width", 1)
                    .set("stroke-dasharray", "5 4"),
            );
            if points.len() > longest.len() {
                longest = points;
            }
        }
        if let Some(t) = label(&longest, &watts(l.threshold()), chart, &mut labels, FAINT) {
            said = said.add(t);
        }
    }
    if steps {
        fills = fills.add(steps_between(map, chart, 0.6));
    }
    fills = fills.add(hatching(map, chart));
    g = g.add(fills).add(said).add(chart.frame());
    for (k, (m, (x, y))) in map.marks.iter().zip(&marks).enumerate() {
        let at = (chart.x(m.at[0]), chart.y(m.at[1]));
        if at.0 != *x {
            g = g.add(line(at, (*x, *y), INK, 1.0));
        }
        g = g.add(badge(*x, *y, &(k + 1).to_string()));
    }
    g.add(legend(map, chart, &between, [least, most], !powers.is_empty()))
}

/// Where the numbers of the operations stand: side by side where operations share a place.
fn places(map: &EfficiencyMap, chart: &Chart) -> Vec<(f64, f64)> {
    let mut all: Vec<(f64, f64)> = vec![];
    for m in map.marks.iter().take(9) {
        let (mut x, y) = (chart.x(m.at[0]), chart.y(m.at[1]));
        while all.iter().any(|p| (p.0 - x).abs() < 21.0 && (p.1 - y).abs() < 21.0) {
            x += 21.0;
        }
        all.push((x, y));
    }
    all
}

/// The values with every gap closed by the nearest value in the map, so that lines end where a region without answers
/// begins and not before.
fn without_gaps(map: &EfficiencyMap, values: &[f64]) -> Vec<f64> {
    let width = map.x.values.len();
    let mut filled = values.to_vec();
    while filled.iter().any(|v| !v.is_finite()) {
        let before = filled.clone();
        for k in 0..filled.len() {
            if before[k].is_finite() {
                continue;
            }
            let (row, column) = (k / width, k % width);
            let near = [
                (row > 0).then(|| k - width),
                (column > 0).then(|| k - 1),
                (column + 1 < width).then(|| k + 1),
                (k + width < before.len()).then(|| k + width),
            ];
            let known = near.into_iter().flatten().map(|j| before[j]).filter(|v| v.is_finite());
            let (sum, count) = known.fold((0.0, 0), |(s, n), v| (s + v, n + 1));
            if count > 0 {
                filled[k] = sum / f64::from(count);
            }
        }
        if before.iter().all(|v| !v.is_finite()) {
            return vec![0.0; values.len()];
        }
    }
    filled
}

/// Powers of 1, 2, 5 that lie within the map, six at most.
fn powers(values: &[f64]) -> Vec<f64> {
    let (least, most) =
        (values.iter().filter(|v| **v > 0.0)).fold((f64::INFINITY, 0.0f64), |(a, b), v| (a.min(*v), b.max(*v)));
    if least >= most {
        return vec![];
    }
    let decades = (least.log10().floor() as i32)..=(most.log10().ceil() as i32);
    let all = decades.flat_map(|e| [1.0, 2.0, 5.0].map(|m| m * 10f64.powi(e)));
    let within: Vec<f64> = all.filter(|p| *p > least && *p < most).collect();
    within[within.len().saturating_sub(6)..].to_vec()
}

/// Words on a line, where there is room.
fn label(points: &[(f64, f64)], name: &str, chart: &Chart, taken: &mut Vec<[f64; 4]>, ink: &str) -> Option<Group> {
    if points.len() < 4 {
        return None;
    }
    let width = wide(name, 11.0) + 8.0;
    for part in [0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8, 0.12, 0.88] {
        let (x, y) = points[((points.len() - 1) as f64 * part) as usize];
        let own = [x - width / 2.0, y - 8.0, x + width / 2.0, y + 8.0];
        let inside = own[0] > chart.left + 4.0
            && own[2] < chart.right - 4.0
            && own[1] > chart.top + 4.0
            && own[3] < chart.bottom - 4.0;
        if inside && taken.iter().all(|t| own[0] > t[2] || own[2] < t[0] || own[1] > t[3] || own[3] < t[1]) {
            taken.push(own);
            return Some(halo(text(x, y + 3.5, 11.0, Anchor::Middle, name).set("fill", ink), PAPER, 3.0));
        }
    }
    None
}

/// Rectangles around neighbours in a row that share a value, row by row.
fn runs<T: Copy + PartialEq>(
    map: &EfficiencyMap,
    chart: &Chart,
    of: &dyn Fn(usize) -> Option<T>,
    tell: &mut dyn FnMut([f64; 4], T),
) {
    let width = map.x.values.len();
    let x = |k: f64| chart.x(value(&map.x.values, k));
    let y = |k: f64| chart.y(value(&map.y.values, k));
    for row in 0..map.y.values.len() {
        let mut from = 0;
        while from < width {
            let own = of(row * width + from);
            let run = (from..width).take_while(|k| of(row * width + k) == own).count();
            if let Some(own) = own {
                let (a, b, r) = (from as f64, (from + run) as f64, row as f64);
                tell([x(a - 0.5), y(r + 0.5), x(b - 0.5), y(r - 0.5)], own);
            }
            from += run;
        }
    }
}

/// Cells around points without a single answer.
fn hatching(map: &EfficiencyMap, chart: &Chart) -> Group {
    let (mut paper, mut hatch) = (Group::new(), Group::new());
    let verdict = |k: usize| Some(map.points[k].verdict).filter(|v| *v != UNIQUE);
    runs(map, chart, &verdict, &mut |[x0, y0, x1, y1], verdict| {
        paper.append(rectangle(x0, y0, x1 - x0, y1 - y0, PAPER).set("stroke", PAPER).set("stroke-width", 0.5));
        hatch.append(strokes([x0, y0, x1, y1], verdict));
    });
    Group::new().add(paper).add(hatch)
}

/// The lines without what of them runs along the frame.
fn open_lines(
    map: &EfficiencyMap,
    chart: &Chart,
    lines: impl Iterator<Item = impl Iterator<Item = (f64, f64)>>,
) -> Vec<Vec<(f64, f64)>> {
    let most = ((map.x.values.len() - 1) as f64, (map.y.values.len() - 1) as f64);
    let along = |a: (f64, f64), b: (f64, f64)| {
        (a.0 <= 0.0 && b.0 <= 0.0)
            || (a.1 <= 0.0 && b.1 <= 0.0)
            || (a.0 >= most.0 && b.0 >= most.0)
            || (a.1 >= most.1 && b.1 >= most.1)
    };
    let mut all = vec![];
    for one in lines {
        let points: Vec<(f64, f64)> = one.collect();
        for piece in points.chunk_by(|a, b| !along(*a, *b)).filter(|p| p.len() > 1) {
            all.push(ring(map, chart, piece.iter().copied()));
        }
    }
    all
}

/// Slanted lines through a rectangle, the same on the whole page; where there is nothing to ask, none.
fn strokes([x0, y0, x1, y1]: [f64; 4], verdict: MapVerdict) -> Path {
    let (gap, rising) = match verdict {
        MapVerdict::Point(PointVerdict::Locked) => (7.0, true),
        MapVerdict::Point(PointVerdict::Multiple) => (7.0, false),
        _ => (14.0, true),
    };
    let mut path = String::new();
    // Lines u = x ± y = const.
    let (low, high) = if rising { (x0 + y0, x1 + y1) } else { (x0 - y1, x1 - y0) };
    let mut u = (low / gap).ceil() * gap;
    while u < high {
        let (a, b) = if rising { (x0.max(u - y1), x1.min(u - y0)) } else { (x0.max(u + y0), x1.min(u + y1)) };
        if b > a {
            let y = |x: f64| if rising { u - x } else { x - u };
            let _ = write!(path, "M{} {} L{} {} ", number(a), number(y(a)), number(b), number(y(b)));
        }
        u += gap;
    }
    Path::new()
        .set(
            "d",
            if path.is_empty() { format!("M{} {} h0.5", number(x0), number(y0)) } else { path.trim_end().to_owned() },
        )
        .set("fill", "none")
        .set("stroke", if verdict == MapVerdict::Point(PointVerdict::Locked) { INK } else { LINE })
        .set("stroke-width", 0.9)
}

fn legend(map: &EfficiencyMap, chart: &Chart, between: &[f64], [least, most]: [f64; 2], power: bool) -> Group {
    let key = chart.right + BESIDE;
    let mut y = chart.top + 10.0;
    let mut g = Group::new().add(text(key, y, 13.0, Anchor::Start, "Efficiency").set("font-weight", "bold"));
    y += 12.0;
    if least.is_finite() {
        let shades = between.len() + 1;
        for k in 0..shades {
            let fill = ramp(if shades > 1 { k as f64 / (shades - 1) as f64 } else { 0.0 });
            let low = between.get(k).copied().unwrap_or(most);
            let high = if k == 0 { least } else { between[k - 1] };
            let label = match shades {
                1 if most - least < 1e-9 => format!("{} everywhere", percent(1.0 - most)),
                _ => format!("{} to {}", percent(1.0 - high), percent(1.0 - low)),
            };
            g = g.add(rectangle(key, y, 26.0, 15.0, &fill).set("stroke", LINE).set("stroke-width", 0.6)).add(text(
                key + 34.0,
                y + 12.0,
                11.0,
                Anchor::Start,
                &label,
            ));
            y += 18.0;
        }
    }
    y += 6.0;
    for (verdict, _) in verdicts(map) {
        g = g
            .add(rectangle(key, y, 26.0, 15.0, PAPER).set("stroke", LINE).set("stroke-width", 0.6))
            .add(strokes([key, y, key + 26.0, y + 15.0], verdict))
            .add(text(key + 34.0, y + 12.0, 11.0, Anchor::Start, says(verdict)));
        y += 20.0;
    }
    if power {
        let dash = line((key, y + 8.0), (key + 26.0, y + 8.0), FAINT, 1.0).set("stroke-dasharray", "5 4");
        g = g.add(dash).add(text(key + 34.0, y + 12.0, 11.0, Anchor::Start, "power into the train"));
        y += 22.0;
    }
    for (k, m) in map.marks.iter().enumerate().take(9) {
        let name = fit(&m.operation, LEGEND - 60.0, 11.0);
        g = g.add(badge(key + 13.0, y + 9.0, &(k + 1).to_string())).add(text(
            key + 34.0,
            y + 13.0,
            11.0,
            Anchor::Start,
            &name,
        ));
        y += 22.0;
    }
    g
}

/// Which state is best where.
fn states(map: &EfficiencyMap, chart: &Chart) -> Group {
    let width = map.x.values.len();
    let mut g = Group::new();
    let mut used: Vec<usize> = map.points.iter().filter_map(|p| p.best).collect();
    used.sort_unstable();
    used.dedup();
    let shade = |state: usize| colour(Some(state), 0.55);
    let mut middles: Vec<(usize, f64, f64, f64)> = vec![];
    let best = |k: usize| Some(map.points[k].best);
    runs(map, chart, &best, &mut |[x0, y0, x1, y1], best| match best {
        Some(state) => {
            let (fill, stroke) = (shade(state), shade(state));
            g.append(rectangle(x0, y0, x1 - x0, y1 - y0, &fill).set("stroke", stroke).set("stroke-width", 0.6));
        }
        None => g.append(strokes([x0, y0, x1, y1], MapVerdict::Beyond)),
    });
    // The middle of every region.
    for (k, p) in map.points.iter().enumerate() {
        let Some(state) = p.best else { continue };
        let (x, y) = (chart.x(map.x.values[k % width]), chart.y(map.y.values[k / width]));
        match middles.iter_mut().find(|m| m.0 == state) {
            Some(m) => *m = (state, m.1 + x, m.2 + y, m.3 + 1.0),
            None => middles.push((state, x, y, 1.0)),
        }
    }
    g = g.add(steps_between(map, chart, 0.9));
    g = g.add(chart.frame());
    // A region's name stands at a point of it near its middle.
    let mut taken: Vec<[f64; 4]> = vec![];
    for (state, x, y, count) in &middles {
        let middle = (x / count, y / count);
        let own = map.points.iter().enumerate().filter(|(_, p)| p.best == Some(*state));
        let places = own.map(|(k, _)| (chart.x(map.x.values[k % width]), chart.y(map.y.values[k / width])));
        let near = places.min_by(|a, b| {
            let far = |p: &(f64, f64)| (p.0 - middle.0).powi(2) + (p.1 - middle.1).powi(2);
            far(a).total_cmp(&far(b))
        });
        let Some((x, y)) = near else { continue };
        let name = fit(&map.states[*state], 80.0, 13.0);
        let half = wide(&name, 13.0) * BOLD / 2.0 + 2.0;
        let x = x.clamp(chart.left + half + 2.0, chart.right - half - 2.0);
        let y = y.clamp(chart.top + 10.0, chart.bottom - 8.0);
        let own = [x - half, y - 8.0, x + half, y + 8.0];
        if taken.iter().all(|t| own[0] > t[2] || own[2] < t[0] || own[1] > t[3] || own[3] < t[1]) {
            taken.push(own);
            g = g.add(halo(text(x, y + 4.5, 13.0, Anchor::Middle, &name).set("font-weight", "bold"), PAPER, 3.0));
        }
    }
    let mut y = chart.top + 10.0;
    let key = chart.right + BESIDE;
    g = g.add(text(key, y, 13.0, Anchor::Start, "Best state").set("font-weight", "bold"));
    y += 12.0;
    for state in used {
        let share = map.points.iter().filter(|p| p.best == Some(state)).count() as f64 / map.points.len() as f64;
        let label = format!("{} %", digits((1000.0 * share).round() / 10.0));
        g = g
            .add(rectangle(key, y, 26.0, 15.0, &shade(state)).set("stroke", LINE).set("stroke-width", 0.6))
            .add(text(key + 34.0, y + 12.0, 11.0, Anchor::Start, &fit(&map.states[state], 110.0, 11.0)))
            .add(text(key + LEGEND - 28.0, y + 12.0, 11.0, Anchor::End, &label).set("fill", FAINT));
        y += 19.0;
    }
    g.add(text(key, y + 14.0, 11.0, Anchor::Start, "share of the points of the map").set("fill", FAINT))
}

/// Lines between the regions of different states.
fn steps_between(map: &EfficiencyMap, chart: &Chart, weight: f64) -> Path {
    let width = map.x.values.len();
    let at = |row: usize, column: usize| map.points[row * width + column].best;
    let x = |k: f64| number(chart.x(value(&map.x.values, k)));
    let y = |k: f64| number(chart.y(value(&map.y.values, k)));
    let mut steps = String::new();
    for row in 0..map.y.values.len() {
        for column in 0..width {
            let (c, r) = (column as f64, row as f64);
            if column + 1 < width && at(row, column) != at(row, column + 1) {
                let _ = write!(steps, "M{} {} V{} ", x(c + 0.5), y(r - 0.5), y(r + 0.5));
            }
            if row + 1 < map.y.values.len() && at(row, column) != at(row + 1, column) {
                let _ = write!(steps, "M{} {} H{} ", x(c - 0.5), y(r + 0.5), x(c + 0.5));
            }
        }
    }
    Path::new().set("d", steps.trim_end().to_owned()).set("fill", "none").set("stroke", INK).set("stroke-width", weight)
}
