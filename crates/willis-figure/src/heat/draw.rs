//! Heat as a network of places, two curves over the oil temperature, and temperatures over time.

use svg::node::element::{Circle, Group, Path};

use super::HeatPicture;
use crate::kind::Drawing;
use crate::parts::alive::{Of, guide, of};
use crate::parts::chart::{Chart, Scale};
use crate::parts::style::{
    Anchor, BOLD, FAINT, INK, LINE, PAPER, colour, digits, figures, fit, halo, line, lines, number, page, power_unit,
    rectangle, text, wide,
};

const WIDTH: f64 = 1080.0;
const NARROWEST: f64 = 640.0;
const MARGIN: f64 = 28.0;
const TOP: f64 = 92.0;
/// A place's box.
const BOX: (f64, f64) = (128.0, 60.0);
const ROW: f64 = 90.0;
/// Widest line of heat.
const WIDEST: f64 = 14.0;

/// Places with the heat between them; losses and heat flow over the oil temperature; temperatures from a cold start on.
///
/// # Example
/// ```
/// # use willis::{Model, work::Serial};
/// # let model = Model::from_toml(r#"
/// #     format = 1
/// #     name = "one stage"
/// #     members = ["a", "b"]
/// #     terminals = ["a", "b"]
/// #     mesh = [{ gears = [{ member = "a", teeth = 20 }, { member = "b", teeth = 30 }], efficiency = 0.99 }]
/// #     heat = { ambient = "20 degC", conductance = "10 W/K", limit = "95 degC" }
/// #     [[operation]]
/// #     name = "rated"
/// #     speeds = { a = "1000 rad/s" }
/// #     torques = { a = "20 N m" }
/// # "#)?;
/// let all = willis::study::heat(&model, &Default::default(), &Serial)?;
/// let svg = willis_figure::draw_heat(&willis_figure::heat_picture(&all, None)?);
/// assert!(svg.contains("40.0 °C"));
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn draw(picture: &HeatPicture) -> String {
    draw_on(picture, Drawing::default())
}

pub(crate) fn draw_on(p: &HeatPicture, paper: Drawing) -> String {
    let width = paper.page(WIDTH, NARROWEST);
    let h = &p.heat;
    let (network, bottom) = network(p, width);
    let mut g = Group::new().add(heading(p, width)).add(network);
    // The charts beside each other where there is room.
    let charts: Vec<fn(&HeatPicture, [f64; 4]) -> Group> = match (h.curve.len() > 1, p.warm_up.is_some()) {
        (true, true) => vec![curves, warming],
        (true, false) => vec![curves],
        (false, true) => vec![warming],
        (false, false) => vec![],
    };
    let beside = width >= 900.0 && charts.len() == 2;
    let mut top = bottom + 40.0;
    let each = if beside { (width - 2.0 * MARGIN) / 2.0 } else { width - 2.0 * MARGIN };
    for (k, chart) in charts.iter().enumerate() {
        let left = MARGIN + if beside { each * k as f64 } else { 0.0 };
        g = g.add(chart(p, [left + 62.0, top + 22.0, left + each - 20.0, top + 300.0]));
        if !beside || k + 1 == charts.len() {
            top += 360.0;
        }
    }
    page(width, top + 4.0, &format!("Heat of {}", p.title), &description(p)).add(g).to_string()
}

fn celsius(kelvin: f64) -> String {
    format!("{:.1} °C", kelvin - 273.15)
}

/// A heat with its unit.
fn heat(w: f64) -> String {
    let (scale, unit) = power_unit(w.abs());
    format!("{} {unit}", figures(w / scale, 3))
}

fn heading(p: &HeatPicture, width: f64) -> Group {
    let h = &p.heat;
    let rating = p.rating_w.map_or(String::new(), |w| format!("; thermal rating {}", heat(w)));
    let caption = format!("oil {}, limit {}{rating}", celsius(h.oil_k), celsius(h.limit_k));
    Group::new()
        .add(
            text(MARGIN, 38.0, 20.0, Anchor::Start, &fit(&p.title, (width - 2.0 * MARGIN) / BOLD, 20.0))
                .set("font-weight", "bold"),
        )
        .add(text(MARGIN, 60.0, 13.0, Anchor::Start, &fit(&caption, width - 2.0 * MARGIN, 13.0)).set("fill", FAINT))
}

fn description(p: &HeatPicture) -> String {
    let all: Vec<String> =
        p.heat.places.iter().map(|(name, place)| format!("{name} {}", celsius(place.temperature_k))).collect();
    format!("Temperatures of an operating point and the heat between its places: {}.", all.join(", "))
}

/// The places: the oil left, those whose temperature follows in the middle, those with a given one right.
fn network(p: &HeatPicture, width: f64) -> (Group, f64) {
    let h = &p.heat;
    let names: Vec<&str> = h.places.iter().map(|(name, _)| name.as_str()).collect();
    let given = |k: usize| h.places.0[k].1.given;
    let inner: Vec<usize> = (1..names.len()).filter(|k| !given(*k)).collect();
    let mut outer: Vec<usize> = (1..names.len()).filter(|k| given(*k)).collect();
    // The cooler is a place of the picture alone.
    let cooler = names.len();
    if h.cooler_w.is_some() {
        outer.push(cooler);
    }
    let used = |k: usize| k == cooler || h.paths.iter().any(|f| f.between.iter().any(|n| n == names[k]));
    outer.retain(|k| used(*k));
    let rows = inner.len().max(outer.len()).max(1) as f64;
    let height = rows * ROW;
    let columns = [MARGIN, (width - BOX.0) / 2.0, width - MARGIN - BOX.0];
    let row = |k: usize, of: usize| TOP + height * (k as f64 + 0.5) / of as f64 - BOX.1 / 2.0;
    let place = |k: usize| -> (f64, f64) {
        if k == 0 {
            return (columns[0], TOP + height / 2.0 - BOX.1 / 2.0);
        }
        match inner.iter().position(|i| *i == k) {
            Some(j) => (columns[1], row(j, inner.len())),
            None => (columns[2], row(outer.iter().position(|i| *i == k).unwrap_or(0), outer.len())),
        }
    };
    let mut ways: Vec<(usize, usize, f64)> = vec![];
    for f in &h.paths {
        let [a, b] = [0, 1].map(|e| names.iter().position(|n| *n == f.between[e]).unwrap_or(0));
        // From where the heat comes; ways between the same places are drawn as one.
        let (from, to, q) = if f.heat_w >= 0.0 { (a, b, f.heat_w) } else { (b, a, -f.heat_w) };
        match ways.iter_mut().find(|w| (w.0, w.1) == (from, to)) {
            Some(w) => w.2 += q,
            None => ways.push((from, to, q)),
        }
    }
    ways.extend(h.cooler_w.map(|q| if q >= 0.0 { (0, cooler, q) } else { (cooler, 0, -q) }));
    let most = ways.iter().fold(0.0f64, |a, w| a.max(w.2));
    let mut marks = Group::new();
    let mut labels = Group::new();
    let doors = doors(&ways, &place);
    for ((from, to, q), door) in ways.iter().zip(&doors) {
        let (a, b) = (place(*from), place(*to));
        let thick = if most > 0.0 { (q / most * WIDEST).max(1.0) } else { 1.0 };
        let (end, middle, d) = if (a.0 - b.0).abs() < 1.0 {
            // Within a column: around its left side.
            let side = a.0 - 34.0 - 10.0 * ((a.1 - b.1).abs() / ROW - 1.0).max(0.0);
            let (s, e) = ((a.0, door[0]), (b.0, door[1]));
            let middle = (0.25 * s.0 + 0.75 * side, (s.1 + e.1) / 2.0);
            let d = format!(
                "M{} {} C{} {} {} {} {} {}",
                number(s.0),
                number(s.1),
                number(side),
                number(s.1),
                number(side),
                number(e.1),
                number(e.0),
                number(e.1)
            );
            (e, middle, d)
        } else {
            let right = a.0 < b.0;
            let s = (a.0 + if right { BOX.0 } else { 0.0 }, door[0]);
            let e = (b.0 + if right { 0.0 } else { BOX.0 }, door[1]);
            let bend = (s.0 + e.0) / 2.0;
            // Past a column in between, below it.
            let over = (a.0 - b.0).abs() > 1.5 * (columns[1] - columns[0]) && !inner.is_empty();
            let drop = if over { TOP + height + 14.0 } else { f64::NAN };
            let d = match over {
                false => format!(
                    "M{} {} C{} {} {} {} {} {}",
                    number(s.0),
                    number(s.1),
                    number(bend),
                    number(s.1),
                    number(bend),
                    number(e.1),
                    number(e.0),
                    number(e.1)
                ),
                true => format!(
                    "M{} {} C{} {} {} {} {} {} S{} {} {} {}",
                    number(s.0),
                    number(s.1),
                    number(s.0 + 90.0),
                    number(s.1),
                    number(s.0 + 40.0),
                    number(drop),
                    number(bend),
                    number(drop),
                    number(e.0 - 90.0),
                    number(e.1),
                    number(e.0),
                    number(e.1)
                ),
            };
            // Half way where it comes back: beside its box stand the labels of that column.
            let middle = match (over, right) {
                (true, _) => (bend, drop),
                (false, true) => (s.0 + 0.36 * (e.0 - s.0), s.1 + 0.28 * (e.1 - s.1)),
                (false, false) => (bend, (s.1 + e.1) / 2.0),
            };
            (e, middle, d)
        };
        // Heat comes in from the left, but where it comes back from the right.
        let tip = if a.0 > b.0 + 1.0 { -1.0 } else { 1.0 };
        let half = (thick / 2.0 + 3.0).max(4.0);
        let arrow = format!(
            "M{} {} L{} {} L{} {} Z",
            number(end.0),
            number(end.1),
            number(end.0 - tip * 10.0),
            number(end.1 - half),
            number(end.0 - tip * 10.0),
            number(end.1 + half)
        );
        let name = |k: usize| if k == cooler { "cooler" } else { names[k] };
        let path = Path::new()
            .set("d", d)
            .set("fill", "none")
            .set("stroke", colour(Some(1), 0.75))
            .set("stroke-width", number(thick));
        let told = format!("heat {} to {}", name(*from), name(*to));
        let head = Path::new().set("d", arrow).set("fill", colour(Some(1), 1.0));
        marks = marks.add(of(Group::new().add(path).add(head), "way", &[Of::Quantity(&told)]));
        labels = labels.add(halo(text(middle.0, middle.1 + 4.0, 11.0, Anchor::Middle, &heat(*q)), PAPER, 3.0));
    }
    let mut boxes = Group::new();
    for k in
        (0..names.len()).filter(|k| *k == 0 || inner.contains(k) || outer.contains(k)).chain(h.cooler_w.map(|_| cooler))
    {
        let (x, y) = place(k);
        let (name, temperature, made) = match k == cooler {
            true => ("cooler", String::new(), 0.0),
            false => (names[k], celsius(h.places.0[k].1.temperature_k), h.places.0[k].1.heat_w),
        };
        let makes = if made > 0.0 { format!("makes {}", heat(made)) } else { String::new() };
        let fill = if k == 0 { colour(Some(1), 0.25) } else { PAPER.to_owned() };
        let frame = rectangle(x, y, BOX.0, BOX.1, &fill).set("stroke", LINE).set("stroke-width", 1.2).set("rx", 5);
        let own = Group::new()
            .add(frame)
            .add(
                text(x + BOX.0 / 2.0, y + 18.0, 13.0, Anchor::Middle, &fit(name, (BOX.0 - 12.0) / BOLD, 13.0))
                    .set("font-weight", "bold"),
            )
            .add(text(x + BOX.0 / 2.0, y + 36.0, 12.0, Anchor::Middle, &temperature))
            .add(
                text(x + BOX.0 / 2.0, y + 52.0, 11.0, Anchor::Middle, &fit(&makes, BOX.0 - 8.0, 11.0))
                    .set("fill", FAINT),
            );
        boxes = boxes.add(of(own, "place", &[Of::Quantity(&format!("temperature {name}"))]));
    }
    (Group::new().add(marks).add(boxes).add(labels), TOP + height + if inner.is_empty() { 0.0 } else { 24.0 })
}

/// Heights at which each way leaves its first place and enters its second: those at one side of a box stand one below the
/// other, in the order of the places that they lead to. A way around the left side of a column starts towards its end, that to
/// the next box inside those to boxes further on.
fn doors(ways: &[(usize, usize, f64)], place: &dyn Fn(usize) -> (f64, f64)) -> Vec<[f64; 2]> {
    // Way, end, place, whether at its right side, where it leads.
    let mut ends: Vec<(usize, usize, usize, bool, f64)> = vec![];
    for (k, &(from, to, _)) in ways.iter().enumerate() {
        let (a, b) = (place(from), place(to));
        let leads = |own: (f64, f64), other: (f64, f64)| match (own.0 - other.0).abs() < 1.0 {
            true => (1e6 - (other.1 - own.1).abs()) * (other.1 - own.1).signum(),
            false => other.1,
        };
        ends.push((k, 0, from, a.0 < b.0 - 1.0, leads(a, b)));
        ends.push((k, 1, to, b.0 < a.0 - 1.0, leads(b, a)));
    }
    let mut doors = vec![[0.0; 2]; ways.len()];
    for &(k, end, own, right, leads) in &ends {
        let beside = || ends.iter().filter(|x| (x.2, x.3) == (own, right));
        let above = beside().filter(|x| (x.4, x.0) < (leads, k)).count();
        let part = (above as f64 + 1.0) / (beside().count() as f64 + 1.0);
        doors[k][end] = place(own).1 + BOX.1 * part;
    }
    doors
}

/// Heat that reaches the oil and what it gives off, over its temperature.
fn curves(p: &HeatPicture, [left, top, right, bottom]: [f64; 4]) -> Group {
    let h = &p.heat;
    let most = h.curve.iter().map(|c| c.reaching_w.max(c.carried_w)).fold(0.0f64, f64::max);
    let (scale, unit) = power_unit(most);
    let x = Scale::of(h.curve.iter().map(|c| c.oil_k - 273.15), "oil temperature, °C");
    let y = Scale::of(
        h.curve.iter().flat_map(|c| [c.reaching_w, c.carried_w, 0.0]).map(|w| w / scale),
        format!("heat, {unit}"),
    );
    let chart = Chart { left, top, right, bottom, x, y: y.rounded() };
    let mut g = Group::new()
        .add(text(left, top - 10.0, 13.0, Anchor::Start, "Losses and heat flow").set("font-weight", "bold"))
        .add(chart.grid());
    type Value = fn(&willis::analysis::HeatPoint) -> f64;
    let both: [(&str, usize, &str, Value); 2] =
        [("losses", 1, "none", |c| c.reaching_w), ("carried away", 0, "8 3", |c| c.carried_w)];
    for (name, category, dash, value) in both {
        let points = h.curve.iter().map(|c| (c.oil_k - 273.15, Some(value(c) / scale)));
        if let Some(path) = chart.path(points) {
            let path =
                path.set("stroke", colour(Some(category), 1.0)).set("stroke-width", 2.4).set("stroke-dasharray", dash);
            g = g.add(of(path, "curve", &[Of::Quantity(&format!("heat {name}"))]));
        }
    }
    // The losses at the left end; what is carried away beside the right one, where it is above most else.
    let near = &h.curve[h.curve.len() / 8];
    let at = chart.x(near.oil_k - 273.15);
    let over = chart.y(near.reaching_w / scale) - 8.0;
    g = g.add(halo(text(at + 4.0, over, 12.0, Anchor::Start, "losses that reach the oil"), PAPER, 3.0));
    if let Some(last) = h.curve.last() {
        let place = (chart.y(last.carried_w / scale) + 4.0).clamp(top + 14.0, bottom - 8.0);
        g = g.add(halo(text(right - 16.0, place, 12.0, Anchor::End, "carried away"), PAPER, 3.0));
    }
    for e in &h.equilibria {
        let y = h.curve.iter().min_by(|a, b| (a.oil_k - e.oil_k).abs().total_cmp(&(b.oil_k - e.oil_k).abs()));
        let Some(c) = y else { continue };
        let dot = Circle::new()
            .set("cx", number(chart.x(e.oil_k - 273.15)))
            .set("cy", number(chart.y(c.carried_w / scale)))
            .set("r", 5)
            .set("fill", if e.stable { INK } else { PAPER })
            .set("stroke", INK)
            .set("stroke-width", 1.6);
        g = g.add(of(dot, "equilibrium", &[Of::Quantity(&format!("oil {}", celsius(e.oil_k)))]));
        let label = format!("{}{}", celsius(e.oil_k), if e.stable { "" } else { ", not stable" });
        let (cx, cy) = (chart.x(e.oil_k - 273.15), chart.y(c.carried_w / scale));
        let anchor = if cx + wide(&label, 12.0) + 10.0 > right { Anchor::End } else { Anchor::Start };
        let dx = if matches!(anchor, Anchor::End) { -9.0 } else { 9.0 };
        g = g.add(halo(text(cx + dx, cy + 18.0, 12.0, anchor, &label).set("font-weight", "bold"), PAPER, 3.0));
    }
    g.add(chart.frame())
}

/// Temperatures from a cold start on.
fn warming(p: &HeatPicture, [left, top, right, bottom]: [f64; 4]) -> Group {
    let Some(w) = &p.warm_up else { return Group::new() };
    let end = w.rows.last().map_or(1.0, |r| r.time_s);
    let (scale, unit) = match end {
        s if s >= 7200.0 => (3600.0, "h"),
        s if s >= 120.0 => (60.0, "min"),
        _ => (1.0, "s"),
    };
    let moving: Vec<usize> =
        (0..w.places.len()).filter(|&k| !p.heat.places.get(&w.places[k]).is_some_and(|p| p.given)).collect();
    // Names stand in a column on the right.
    let right = right - 96.0;
    let all = w.rows.iter().flat_map(|r| moving.iter().map(|k| r.temperatures_k[*k] - 273.15).collect::<Vec<_>>());
    let x = Scale::of(w.rows.iter().map(|r| r.time_s / scale), format!("time from the start, {unit}"));
    let y = Scale::of(all, "temperature, °C").rounded();
    let chart = Chart { left, top, right, bottom, x, y };
    let mut g = Group::new()
        .add(text(left, top - 10.0, 13.0, Anchor::Start, "Warm-up").set("font-weight", "bold"))
        .add(chart.grid());
    let limit = p.heat.limit_k - 273.15;
    if (chart.y.low..=chart.y.high).contains(&limit) {
        let at = chart.y(limit);
        g = g.add(guide(line((left, at), (right, at), INK, 1.0).set("stroke-dasharray", "3 3"))).add(halo(
            text(right - 8.0, at + 14.0, 11.0, Anchor::End, "limit of the oil").set("fill", FAINT),
            PAPER,
            3.0,
        ));
    }
    let mut ends: Vec<(f64, usize, String)> = vec![];
    for (j, k) in moving.iter().enumerate() {
        let points = w.rows.iter().map(|r| (r.time_s / scale, Some(r.temperatures_k[*k] - 273.15)));
        if let Some(path) = chart.path(points) {
            let dash = crate::contact_path::film::DASHES[j % 4];
            let path = path
                .set("stroke", colour(Some((j + 1) % 14), 1.0))
                .set("stroke-width", 2.0)
                .set("stroke-dasharray", dash);
            g = g.add(of(path, "warm-up", &[Of::Quantity(&format!("temperature {}", w.places[*k]))]));
        }
        if let Some(r) = w.rows.last() {
            ends.push((chart.y(r.temperatures_k[*k] - 273.15), j, w.places[*k].clone()));
        }
    }
    ends.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut last = f64::NEG_INFINITY;
    for (at, j, name) in ends {
        let place = at.max(last + 15.0);
        last = place;
        let label = text(right + 12.0, place + 4.0, 11.0, Anchor::Start, &fit(&name, 88.0, 11.0));
        g = g.add(guide(line((right, at), (right + 10.0, place), &colour(Some((j + 1) % 14), 1.0), 1.4))).add(label);
    }
    let mut said = match (w.settled_s, w.limit_after_s) {
        (_, Some(t)) => format!("passes the limit after {} {unit}", digits(t / scale)),
        (Some(t), None) => format!("within 1 K of its end after {} {unit}", figures(t / scale, 2)),
        _ => String::new(),
    };
    if !said.is_empty() {
        said = lines(&said, right - left - 12.0, 12.0).first().cloned().unwrap_or_default();
        g = g.add(halo(text(right - 8.0, bottom - 8.0, 12.0, Anchor::End, &said).set("fill", FAINT), PAPER, 3.0));
    }
    g.add(chart.frame())
}
