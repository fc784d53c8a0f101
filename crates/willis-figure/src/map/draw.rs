//! Efficiency maps.

mod mesh;

use std::fmt::Write;

use svg::node::element::{ClipPath, Definitions, Group, Path};
use willis::study::PointVerdict;

use crate::parts::alive::{Of, guide, of};
use crate::parts::chart::{Chart, Scale, title};
use crate::parts::style::{
    Anchor, BOLD, FAINT, INK, LINE, PAPER, badge, colour, digits, fit, halo, line, lines, number, page, rectangle,
    text, ticks, watts, wide,
};
use crate::parts::words;
use crate::{Drawing, EfficiencyMap, MapVerdict};
use mesh::{Height, Mesh, Place};

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

/// The losses at the ends of the colours, in every map the same: one colour means one loss.
const ENDS: [f64; 2] = [0.0005, 0.7];

/// From little loss to much: lightness falls all the way, so that grey tells the same.
const RAMP: [[u8; 3]; 6] = [
    [0xfb, 0xf8, 0xcf],
    [0xd3, 0xec, 0xb4],
    [0x8f, 0xd3, 0xb9],
    [0x45, 0xb1, 0xc4],
    [0x2a, 0x86, 0xbb],
    [0x2b, 0x58, 0x9c],
];

/// The colour of a band of losses.
fn shade([low, high]: [f64; 2]) -> String {
    let [first, last] = ENDS;
    let middle = (low.clamp(first, last) * high.clamp(first, last)).sqrt();
    let part = (middle / first).ln() / (last / first).ln();
    let place = part.clamp(0.0, 1.0) * (RAMP.len() - 1) as f64;
    let k = (place as usize).min(RAMP.len() - 2);
    let mix = |c: usize| {
        let (a, b) = (f64::from(RAMP[k][c]), f64::from(RAMP[k + 1][c]));
        (a + (place - k as f64) * (b - a)).round() as u8
    };
    format!("#{:02x}{:02x}{:02x}", mix(0), mix(1), mix(2))
}

/// An efficiency map: filled, labelled bands, lines of constant input power, hatching where there is no single answer,
/// the operations of the file as points; of an automatic transmission below it the state that is best at every point. A
/// map that is the same everywhere is a sentence.
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
    let head = format!("Efficiency map of {}", map.title);
    if let Some(said) = everywhere(map) {
        for l in lines(&said, width - 56.0, 15.0) {
            top += 21.0;
            body = body.add(text(28.0, top, 15.0, Anchor::Start, &l));
        }
        return page(width, top + 28.0, &head, &words(map)).add(body).to_string();
    }
    top += 22.0;
    let chart = |top: f64| Chart {
        left: LEFT,
        top,
        right: width - LEGEND - BESIDE,
        bottom: top + tall,
        x: outwards(Scale::of(map.x.values.iter().copied(), title(&map.x))),
        y: outwards(Scale::of(map.y.values.iter().copied(), title(&map.y))),
    };
    let own = chart(top);
    body = body.add(efficiency(map, &Mesh::new(map, &own), &own));
    let mut bottom = top + tall + 60.0;
    if !map.states.is_empty() {
        let own = chart(bottom);
        body = body.add(states(map, &Mesh::new(map, &own), &own));
        bottom += tall + 60.0;
    }
    page(width, bottom, &head, &words(map)).add(body).to_string()
}

/// What is negative grows away from the origin all the same, so that more load is always higher up.
fn outwards(scale: Scale) -> Scale {
    match scale.high <= 0.0 {
        true => Scale { low: scale.high, high: scale.low, ..scale },
        false => scale,
    }
}

/// The efficiency of a map on which it is one number everywhere, as far as numbers are printed.
fn constant(map: &EfficiencyMap) -> Option<f64> {
    let all: Option<Vec<f64>> = map.points.iter().map(|p| p.efficiency).collect();
    let all = all?;
    let (least, most) = all.iter().fold((f64::INFINITY, 0.0f64), |(l, m), e| (l.min(*e), m.max(*e)));
    (most - least < 5e-5 && map.states.is_empty()).then_some((least + most) / 2.0)
}

/// A map that is the same everywhere, in words.
fn everywhere(map: &EfficiencyMap) -> Option<String> {
    let range = |axis: &crate::ChartAxis| {
        let [first, .., last] = &axis.values[..] else { return axis.name.clone() };
        format!("{} from {} to {} {}", axis.name, digits(*first), digits(*last), axis.unit).trim_end().to_owned()
    };
    let place = format!("{} and {}", range(&map.x), range(&map.y));
    if let Some(efficiency) = constant(map) {
        return Some(format!(
            "The efficiency is {} everywhere: for {place}. The file gives efficiencies that depend on neither. Teeth with a \
             module and an oil, bearings, or drag torques would make a map of it.",
            percent(efficiency),
        ));
    }
    // Nothing to be seen: one answer, and no efficiency.
    let first = map.points.first()?.verdict;
    let is_one = first != UNIQUE && map.points.iter().all(|p| p.verdict == first);
    is_one.then(|| format!("There is no efficiency anywhere: for {place} every point is “{}”.", says(first)))
}

/// What the picture tells those who do not see it.
fn words(map: &EfficiencyMap) -> String {
    let known = || map.points.iter().filter_map(|p| p.efficiency);
    let (least, most) = known().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, m), e| (l.min(e), m.max(e)));
    let mut out =
        format!("Efficiency over {} and {}. {}. ", words::along(&map.x.name), words::along(&map.y.name), map.basis);
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
    // Nothing, whatever the sign of its round-off.
    let text = format!("{:.2}", if x.abs() < 5e-5 { 0.0 } else { 100.0 * x });
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

fn d(points: &[Place], close: bool) -> String {
    let all: Vec<String> = points.iter().map(|p| format!("{} {}", number(p.0), number(p.1))).collect();
    format!("M{}{}", all.join(" L"), if close { " Z" } else { "" })
}

/// A region as one path.
fn area(outlines: &[Vec<Place>]) -> Option<Path> {
    let all: Vec<String> = outlines.iter().map(|o| d(o, true)).collect();
    (!all.is_empty()).then(|| Path::new().set("d", all.concat()).set("fill-rule", "evenodd"))
}

/// Losses that part the bands of this map, none of which is a mere sliver: of the usual ones, or at even steps where
/// these are too far apart.
fn levels(losses: &[f64]) -> Vec<f64> {
    /// Fewer lines than that say too little.
    const FEW: usize = 3;
    let mut sorted: Vec<f64> = losses.iter().copied().filter(|l| l.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    let [least, .., most] = sorted[..] else { return vec![] };
    let below = |l: f64| sorted.partition_point(|x| *x < l);
    let sliver = sorted.len().div_ceil(60);
    let wide = |all: Vec<f64>| -> Vec<f64> {
        let mut taken = 0;
        let broad = |l: &f64| {
            let here = below(*l);
            let wide = here >= taken + sliver && here + sliver <= sorted.len();
            taken = if wide { here } else { taken };
            wide
        };
        all.into_iter().filter(broad).collect()
    };
    let usual = wide(LOSSES.iter().map(|p| p / 100.0).collect());
    let even = || wide(ticks(least, most, 6));
    let within = if usual.len() < FEW && most - least > 1e-4 { even() } else { usual };
    let every = within.len().div_ceil(BANDS - 1).max(1);
    within.into_iter().step_by(every).collect()
}

fn efficiency(map: &EfficiencyMap, mesh: &Mesh<'_>, chart: &Chart) -> Group {
    let losses: Vec<f64> = map.points.iter().map(|p| p.efficiency.map_or(f64::NAN, |e| 1.0 - e)).collect();
    let (least, most) = (losses.iter().filter(|l| l.is_finite()))
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), l| (a.min(*l), b.max(*l)));
    let between = levels(&losses);
    let bands: Vec<[f64; 2]> = (0..=between.len())
        .map(|k| [k.checked_sub(1).map_or(least, |k| between[k]), between.get(k).copied().unwrap_or(most)])
        .collect();
    let mut g = Group::new();
    // Each band lies on those of less loss, so that no paper shows between them.
    for (k, band) in bands.iter().enumerate() {
        let outlines = match k {
            0 => mesh.region(|p| p.efficiency.is_some()),
            _ => mesh.above(band[0]),
        };
        let Some(path) = area(&outlines) else { continue };
        let range = format!("efficiency {}", range(*band));
        g = g.add(of(path.set("fill", shade(*band)), "band", &[Of::Quantity(&range)]));
    }
    // Lines between the bands with their efficiency.
    let marks = places(map, chart);
    let mut labels: Vec<[f64; 4]> = marks.iter().map(|p| [p.0 - 11.0, p.1 - 11.0, p.0 + 11.0, p.1 + 11.0]).collect();
    let mut said = Group::new();
    for l in &between {
        let name = percent(1.0 - l);
        let all = mesh.lines(Height::Loss, *l);
        let Some(path) = contour(&all, INK) else { continue };
        let own = [Of::Quantity(&format!("efficiency {name}"))];
        g = g.add(of(path.set("stroke-width", 0.6), "contour", &own));
        said = said.add(label(&all, &name, chart, &mut labels, INK));
    }
    for k in 0..map.states.len() {
        g = g.add(edge(map, mesh, k, 0.6));
        said = said.add(level(map, mesh, k, &mut labels));
    }
    // Constant power into the train.
    let power: Vec<f64> = map.points.iter().map(|p| p.input_power_w.unwrap_or(f64::NAN)).collect();
    let powers = powers(&power);
    for w in &powers {
        let all = mesh.lines(Height::Power, *w);
        let Some(path) = contour(&all, FAINT) else { continue };
        let own = [Of::Quantity(&format!("input_power_w {}", watts(*w)))];
        g = g.add(of(path.set("stroke-width", 1).set("stroke-dasharray", "5 4"), "contour", &own));
        said = said.add(label(&all, &watts(*w), chart, &mut labels, FAINT));
    }
    for (verdict, _) in verdicts(map) {
        let word = match verdict {
            MapVerdict::Beyond => "beyond",
            MapVerdict::Point(v) => v.name(),
        };
        g = g.add(hatched(mesh, verdict, chart, &format!("map-{word}")));
    }
    g = g.add(said).add(chart.frame());
    for (k, (m, (x, y))) in map.marks.iter().zip(&marks).enumerate() {
        let at = (chart.x(m.at[0]), chart.y(m.at[1]));
        let mut mark = Group::new();
        if at.0 != *x {
            mark = mark.add(line(at, (*x, *y), INK, 1.0));
        }
        mark = mark.add(badge(*x, *y, &(k + 1).to_string()));
        g = g.add(of(mark, "operation", &[Of::State(&m.operation)]));
    }
    g.add(legend(map, chart, &bands, !powers.is_empty()))
}

/// Whether a rectangle touches none of others: left, top, right, bottom.
fn is_free(own: &[f64; 4], taken: &[[f64; 4]]) -> bool {
    taken.iter().all(|t| own[0] > t[2] || own[2] < t[0] || own[1] > t[3] || own[3] < t[1])
}

/// The efficiency of a state, where it is one number and has room.
fn level(map: &EfficiencyMap, mesh: &Mesh<'_>, state: usize, taken: &mut Vec<[f64; 4]>) -> Group {
    let own = map.points.iter().filter(|p| p.best == Some(state)).filter_map(|p| p.efficiency);
    let (least, most) = own.fold((f64::INFINITY, 0.0f64), |(l, m), e| (l.min(e), m.max(e)));
    let ((x, y), _) = mesh.middle(|p| p.best == Some(state));
    let name = percent((least + most) / 2.0);
    let half = wide(&name, 11.0) / 2.0 + 2.0;
    let place = [x - half, y - 8.0, x + half, y + 8.0];
    let inside = [(place[0], y), (place[2], y), (x, place[1]), (x, place[3])];
    let room = inside.iter().all(|p| mesh.holds(*p, |p| p.best == Some(state)));
    if !(most - least < 5e-5 && room && is_free(&place, taken)) {
        return Group::new();
    }
    taken.push(place);
    halo(text(x, y + 3.5, 11.0, Anchor::Middle, &name), PAPER, 3.0)
}

/// Lines of one level as one path.
fn contour(all: &[Vec<Place>], ink: &str) -> Option<Path> {
    let all: Vec<String> = all.iter().map(|l| d(l, false)).collect();
    let path =
        Path::new().set("d", all.join(" ")).set("fill", "none").set("stroke", ink).set("stroke-linejoin", "round");
    (!all.is_empty()).then_some(path)
}

/// The edge of where a state is best.
fn edge(map: &EfficiencyMap, mesh: &Mesh<'_>, state: usize, weight: f64) -> Group {
    let path = area(&mesh.region(|p| p.best == Some(state)));
    let own = path.map(|p| p.set("fill", "none").set("stroke", INK).set("stroke-width", weight));
    own.into_iter().fold(Group::new(), |g, p| g.add(of(p, "edge", &[Of::State(&map.states[state])])))
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

/// Words along the longest line on which there is room for them.
fn label(all: &[Vec<Place>], name: &str, chart: &Chart, taken: &mut Vec<[f64; 4]>, ink: &str) -> Group {
    let (width, height) = (wide(name, 11.0) + 8.0, 15.0);
    let mut ranked: Vec<&Vec<Place>> = all.iter().collect();
    ranked.sort_by(|a, b| length(b).total_cmp(&length(a)));
    for points in ranked.into_iter().take_while(|l| length(l) > 1.3 * width) {
        let long = length(points);
        for part in [0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8, 0.12, 0.88] {
            let (a, b) = (along(points, part * long - width / 2.0), along(points, part * long + width / 2.0));
            // Where the line bends, words do not follow it.
            if (b.0 - a.0).hypot(b.1 - a.1) < 0.95 * width {
                continue;
            }
            let (x, y) = along(points, part * long);
            let steep = ((b.1 - a.1) / (b.0 - a.0)).atan();
            let half = [
                (width * steep.cos() + height * steep.sin().abs()) / 2.0,
                (width * steep.sin().abs() + height * steep.cos()) / 2.0,
            ];
            let own = [x - half[0], y - half[1], x + half[0], y + half[1]];
            let inside = own[0] > chart.left + 2.0
                && own[2] < chart.right - 2.0
                && own[1] > chart.top + 2.0
                && own[3] < chart.bottom - 2.0;
            if inside && is_free(&own, taken) {
                taken.push(own);
                let turn = format!("rotate({} {} {})", number(steep.to_degrees()), number(x), number(y));
                let words = text(x, y + 3.5, 11.0, Anchor::Middle, name).set("fill", ink).set("transform", turn);
                return halo(words, PAPER, 3.0);
            }
        }
    }
    Group::new()
}

fn length(line: &[Place]) -> f64 {
    line.windows(2).map(|w| (w[1].0 - w[0].0).hypot(w[1].1 - w[0].1)).sum()
}

/// The place on a line at a distance from its start.
fn along(line: &[Place], distance: f64) -> Place {
    let mut rest = distance.max(0.0);
    for w in line.windows(2) {
        let step = (w[1].0 - w[0].0).hypot(w[1].1 - w[0].1);
        if rest <= step && step > 0.0 {
            let t = rest / step;
            return (w[0].0 + t * (w[1].0 - w[0].0), w[0].1 + t * (w[1].1 - w[0].1));
        }
        rest -= step;
    }
    line.last().copied().unwrap_or_default()
}

/// Where there is no single answer: hatched, on paper.
fn hatched(mesh: &Mesh<'_>, verdict: MapVerdict, chart: &Chart, name: &str) -> Group {
    let outlines = mesh.region(|p| p.verdict == verdict);
    let [Some(clip), Some(ground)] = [area(&outlines), area(&outlines)] else { return Group::new() };
    let hatch = strokes([chart.left, chart.top, chart.right, chart.bottom], verdict);
    let own = Group::new()
        .add(
            Definitions::new()
                .add(ClipPath::new().set("id", format!("{name}-clip")).add(clip.set("clip-rule", "evenodd"))),
        )
        .add(ground.set("fill", PAPER).set("stroke", INK).set("stroke-width", 0.6))
        .add(hatch.set("clip-path", format!("url(#{name}-clip)")));
    of(own, name, &[Of::Quantity("verdict")])
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

/// A band of losses as efficiencies.
fn range([low, high]: [f64; 2]) -> String {
    match high - low < 1e-9 {
        true => format!("{} everywhere", percent(1.0 - low)),
        false => format!("{} to {}", percent(1.0 - high), percent(1.0 - low)),
    }
}

fn legend(map: &EfficiencyMap, chart: &Chart, bands: &[[f64; 2]], power: bool) -> Group {
    let key = chart.right + BESIDE;
    let mut y = chart.top + 10.0;
    let mut g = Group::new().add(text(key, y, 13.0, Anchor::Start, "Efficiency").set("font-weight", "bold"));
    y += 12.0;
    for band in bands.iter().filter(|b| b[0].is_finite()) {
        let label = range(*band);
        let patch = rectangle(key, y, 26.0, 15.0, &shade(*band)).set("stroke", LINE).set("stroke-width", 0.6);
        let words = text(key + 34.0, y + 12.0, 11.0, Anchor::Start, &label);
        let own = Group::new().add(patch).add(words);
        g = g.add(of(own, "legend", &[Of::Quantity(&format!("efficiency {label}"))]));
        y += 18.0;
    }
    y += 6.0;
    for (verdict, _) in verdicts(map) {
        let patch = guide(Group::new())
            .add(rectangle(key, y, 26.0, 15.0, PAPER).set("stroke", LINE).set("stroke-width", 0.6))
            .add(strokes([key, y, key + 26.0, y + 15.0], verdict));
        g = g.add(patch).add(text(key + 34.0, y + 12.0, 11.0, Anchor::Start, says(verdict)));
        y += 20.0;
    }
    if power {
        let dash = line((key, y + 8.0), (key + 26.0, y + 8.0), FAINT, 1.0).set("stroke-dasharray", "5 4");
        g = g.add(guide(dash)).add(text(key + 34.0, y + 12.0, 11.0, Anchor::Start, "power into the train"));
        y += 22.0;
    }
    for (k, m) in map.marks.iter().enumerate().take(9) {
        let name = fit(&m.operation, LEGEND - 60.0, 11.0);
        let own = Group::new().add(badge(key + 13.0, y + 9.0, &(k + 1).to_string())).add(text(
            key + 34.0,
            y + 13.0,
            11.0,
            Anchor::Start,
            &name,
        ));
        g = g.add(of(own, "key", &[Of::State(&m.operation)]));
        y += 22.0;
    }
    g
}

/// Which state is best where.
fn states(map: &EfficiencyMap, mesh: &Mesh<'_>, chart: &Chart) -> Group {
    let width = map.x.values.len();
    let mut g = Group::new();
    let used: Vec<usize> = (0..map.states.len()).filter(|k| map.points.iter().any(|p| p.best == Some(*k))).collect();
    let shade = |state: usize| colour(Some(state), 0.55);
    for state in &used {
        if let Some(path) = area(&mesh.region(|p| p.best == Some(*state))) {
            let path = path.set("fill", shade(*state)).set("stroke", INK).set("stroke-width", 0.9);
            g = g.add(of(path, "best", &[Of::State(&map.states[*state])]));
        }
    }
    g = g.add(hatched(mesh, MapVerdict::Beyond, chart, "states-beyond")).add(chart.frame());
    // A region's name stands at a point of it near its middle.
    let mut taken: Vec<[f64; 4]> = vec![];
    for state in &used {
        let (middle, _) = mesh.middle(|p| p.best == Some(*state));
        let own = map.points.iter().enumerate().filter(|(_, p)| p.best == Some(*state));
        let places = own.map(|(k, _)| (chart.x(map.x.values[k % width]), chart.y(map.y.values[k / width])));
        let far = |p: &Place| (p.0 - middle.0).powi(2) + (p.1 - middle.1).powi(2);
        let inside = mesh.holds(middle, |p| p.best == Some(*state)).then_some(middle);
        let Some((x, y)) = inside.or_else(|| places.min_by(|a, b| far(a).total_cmp(&far(b)))) else { continue };
        let name = fit(&map.states[*state], 80.0, 13.0);
        let half = wide(&name, 13.0) * BOLD / 2.0 + 2.0;
        let x = x.clamp(chart.left + half + 2.0, chart.right - half - 2.0);
        let y = y.clamp(chart.top + 10.0, chart.bottom - 8.0);
        let own = [x - half, y - 8.0, x + half, y + 8.0];
        if is_free(&own, &taken) {
            taken.push(own);
            g = g.add(halo(text(x, y + 4.5, 13.0, Anchor::Middle, &name).set("font-weight", "bold"), PAPER, 3.0));
        }
    }
    let mut y = chart.top + 10.0;
    let key = chart.right + BESIDE;
    g = g.add(text(key, y, 13.0, Anchor::Start, "Best state").set("font-weight", "bold"));
    y += 12.0;
    for state in used {
        let share = mesh.middle(|p| p.best == Some(state)).1;
        let label = format!("{} %", digits((1000.0 * share).round() / 10.0));
        let own = Group::new()
            .add(rectangle(key, y, 26.0, 15.0, &shade(state)).set("stroke", LINE).set("stroke-width", 0.6))
            .add(text(key + 34.0, y + 12.0, 11.0, Anchor::Start, &fit(&map.states[state], 111.0, 11.0)))
            .add(text(key + LEGEND - 28.0, y + 12.0, 11.0, Anchor::End, &label).set("fill", FAINT));
        g = g.add(of(own, "legend", &[Of::State(&map.states[state])]));
        y += 19.0;
    }
    g.add(text(key, y + 14.0, 11.0, Anchor::Start, "share of the map").set("fill", FAINT))
}
