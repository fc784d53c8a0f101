//! A run over time: stacked panels on one time axis.

use svg::node::element::{Circle, Group, Path};
use willis::dynamics::{ColumnUnit, ModeLabel, Outcome};

use crate::parts::alive::{Of, guide, of};
use crate::parts::style::{
    Anchor, BOLD, FAINT, INK, LINE, PAPER, colour, figures, fit, halo, line, number, page, rectangle, text, ticks,
};
use crate::{Drawing, ModeRow, TimeLine, TimePanel, TimePlot};

const WIDTH: f64 = 1060.0;
const NARROWEST: f64 = 640.0;
const LEFT: f64 = 84.0;
/// Right of the panels: the names of curves.
const NAMES: f64 = 210.0;
const TOP: f64 = 112.0;
const PANEL: f64 = 172.0;
const GAP: f64 = 42.0;
const ROW: f64 = 24.0;
/// Width of a column of events, at most.
const EVENTS: f64 = 510.0;
/// Between the labels of two curves.
const SPACING: f64 = 14.0;
/// Pixels by which a curve may be simplified.
const TOLERANCE: f64 = 0.08;
const GRID: &str = "#e4e4e4";
const ABSENT: &str = "#f4f4f4";

/// A run over time: speeds, torques and powers, what sticks and what slips, and when that changed.
///
/// Every curve is labelled at its end, and values that are not determined are gaps.
pub fn draw(plot: &TimePlot) -> String {
    draw_on(plot, Drawing::default())
}

pub(super) fn draw_on(plot: &TimePlot, paper: Drawing) -> String {
    let width = paper.page(WIDTH, NARROWEST);
    // Lower on narrow paper.
    let tall = PANEL * (width / WIDTH).powi(2);
    let time = TimeAxis::new(plot.axis, width - NAMES);
    let mut body = Group::new();
    let mut y = TOP;
    let mut frames = Vec::new();
    for p in &plot.panels {
        body = body.add(panel(plot, p, &time, [y, y + tall]));
        frames.push((y, y + tall));
        y += tall + GAP;
    }
    if !plot.modes.is_empty() {
        body = body.add(modes(plot, &time, y));
        let bottom = y + ROW * plot.modes.len() as f64;
        frames.push((y, bottom));
        y = bottom + GAP;
    }
    if frames.is_empty() {
        let none = "The run has no rows that could be drawn.";
        body = body.add(text(LEFT, y + 20.0, 13.0, Anchor::Start, none).set("fill", FAINT));
        y += 60.0;
    }
    let bottom = y - GAP;
    // Events lie under the curves.
    body = Group::new().add(events(plot, &time, &frames)).add(body);
    if !frames.is_empty() {
        body = body.add(time.labels(bottom));
    }
    let mut list_top = bottom + 74.0;
    if !plot.shifts.is_empty() {
        let (close, height) = shifts(plot, width, list_top);
        body = body.add(close);
        list_top = height + 34.0;
    }
    let (list, height) = told(plot, &time, list_top);
    let title = format!("{}: {}", plot.train, plot.scenario);
    let (one, two) = subtitle(plot, &time, width - 56.0);
    page(width, height, &format!("Motion of {title}"), &description(plot))
        .add(
            text(28.0, 38.0, 20.0, Anchor::Start, &fit(&title, (width - 56.0) / BOLD, 20.0)).set("font-weight", "bold"),
        )
        .add(text(28.0, 58.0, 13.0, Anchor::Start, &one).set("fill", FAINT))
        .add(text(28.0, 75.0, 13.0, Anchor::Start, &two).set("fill", FAINT))
        .add(body)
        .add(list)
        .to_string()
}

fn subtitle(plot: &TimePlot, time: &TimeAxis, room: f64) -> (String, String) {
    let [start, end] = plot.run;
    let whole = TimeAxis::new(plot.run, time.right);
    let mut one = format!("From {} to {}; the run {}", whole.moment(start), whole.moment(end), ending(plot));
    if plot.axis[0] > start || plot.axis[1] < end {
        one += &format!("; shown from {} to {}", time.moment(plot.axis[0]), time.moment(plot.axis[1]));
    }

    let changes = match plot.event_count {
        0 => "no change of mode".to_owned(),
        1 => "one change of mode: the thin upright line".to_owned(),
        n => format!("{n} changes of mode: thin upright lines"),
    };
    let mut two: Vec<String> = Some(plot.outcome.why().to_owned()).filter(|why| !why.is_empty()).into_iter().collect();
    two.push(changes);
    for p in plot.panels.iter().filter(|p| p.left_out > 0) {
        two.push(format!("{} with small {} left out", p.left_out, p.quantity.to_lowercase()));
    }
    if plot.modes_left_out > 0 {
        two.push(format!("{} rows of modes left out", plot.modes_left_out));
    }
    let shown = (time.from.max(start), time.to.min(end));
    let close = 1e-6 * (shown.1 - shown.0);
    let whole = |pieces: &[Vec<[f64; 2]>]| match pieces {
        [only] => {
            only.first().is_some_and(|p| p[0] <= shown.0 + close)
                && only.last().is_some_and(|p| p[0] >= shown.1 - close)
        }
        _ => false,
    };
    if plot.panels.iter().flat_map(|p| &p.lines).any(|l| !whole(&l.pieces)) {
        two.push("where a curve has a gap, rigid parts leave its value open".to_owned());
    }
    let mut two = two.join("; ");
    if let Some(first) = two.get(..1) {
        two = first.to_uppercase() + &two[1..];
    }
    (fit(&one, room, 13.0), fit(&two, room, 13.0))
}

/// How the run ended.
fn ending(plot: &TimePlot) -> &str {
    match plot.outcome {
        Outcome::Finished if plot.cut => "was ended there",
        _ => plot.outcome.words(),
    }
}

fn description(plot: &TimePlot) -> String {
    let mut words = vec![format!("The run {}", ending(plot))];
    for p in &plot.panels {
        // As drawn, but without prefixes.
        let (unit, scale) = unit(p.unit, 1.0);
        let ends = p.lines.iter().map(|l| {
            let last = l.pieces.last().and_then(|p| p.last()).map_or(f64::NAN, |p| p[1]);
            format!("{} {}", l.names.join(", "), short_number(last / scale))
        });
        words.push(format!("{} at the end, {unit}: {}", p.quantity, ends.collect::<Vec<_>>().join("; ")));
    }
    words.join(". ")
}

/// Where times stand.
struct TimeAxis {
    from: f64,
    to: f64,
    /// Where the panels begin.
    left: f64,
    /// Where the panels end.
    right: f64,
    unit: &'static str,
    scale: f64,
    ticks: Vec<f64>,
}

impl TimeAxis {
    fn new(axis: [f64; 2], right: f64) -> Self {
        Self::between(axis, LEFT, right)
    }

    /// For panels between two places.
    fn between(axis: [f64; 2], left: f64, right: f64) -> Self {
        let [from, mut to] = axis;
        if to <= from {
            to = from + 1.0;
        }
        let (unit, scale) = Self::unit(to - from);
        let about = (((right - left) / 90.0) as usize).max(3);
        Self { from, to, left, right, unit, scale, ticks: ticks(from / scale, to / scale, about) }
    }

    /// The unit of times within a span, s, and its seconds.
    fn unit(span: f64) -> (&'static str, f64) {
        match span {
            d if d < 0.4e-3 => ("µs", 1e-6),
            d if d < 0.4 => ("ms", 1e-3),
            _ => ("s", 1.0),
        }
    }

    fn x(&self, t: f64) -> f64 {
        self.left + (t - self.from) / (self.to - self.from) * (self.right - self.left)
    }

    /// A time with as many digits as tell it from its neighbours.
    fn moment(&self, t: f64) -> String {
        let span = (self.to - self.from) / self.scale;
        let decimals = (4 - span.log10().floor() as i32).clamp(0, 9) as usize;
        let text = format!("{:.decimals$}", t / self.scale);
        let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
        format!("{} {}", text.replace('-', "−"), self.unit)
    }

    fn grid(&self, top: f64, bottom: f64) -> Group {
        let at = self.ticks.iter().map(|t| self.x(t * self.scale));
        at.fold(guide(Group::new()), |g, x| g.add(line((x, top), (x, bottom), GRID, 1.0)))
    }

    fn frame(&self, top: f64, bottom: f64) -> svg::node::element::Rectangle {
        guide(
            rectangle(self.left, top, self.right - self.left, bottom - top, "none")
                .set("stroke", LINE)
                .set("stroke-width", 1),
        )
    }

    fn labels(&self, bottom: f64) -> Group {
        let names = tick_labels(&self.ticks);
        let mut g = Group::new();
        for (t, name) in self.ticks.iter().zip(names) {
            let x = self.x(t * self.scale);
            g = g.add(text(x, bottom + 16.0, 11.0, Anchor::Middle, &name).set("fill", FAINT));
        }
        let middle = (LEFT + self.right) / 2.0;
        g.add(text(middle, bottom + 36.0, 12.0, Anchor::Middle, &format!("Time, {}", self.unit)).set("fill", FAINT))
    }
}

/// The unit to draw in, and how much of SI it is.
fn unit(of: ColumnUnit, most: f64) -> (String, f64) {
    let unit = of.symbol();
    if of == ColumnUnit::RadianPerSecond {
        return ("rpm".to_owned(), std::f64::consts::TAU / 60.0);
    }
    if of == ColumnUnit::DegreeCelsius {
        return ("°C".to_owned(), 1.0);
    }
    let prefixes = match of {
        ColumnUnit::Watt | ColumnUnit::Joule | ColumnUnit::NewtonMetre => true,
        ColumnUnit::Radian => most < 0.1,
        _ => false,
    };
    if !prefixes || most == 0.0 {
        return (unit.to_owned(), 1.0);
    }
    let (prefix, scale) = match most {
        m if m >= 2e6 => ("M", 1e6),
        m if m >= 2e3 => ("k", 1e3),
        m if m >= 0.1 => ("", 1.0),
        m if m >= 1e-4 => ("m", 1e-3),
        _ => ("µ", 1e-6),
    };
    (format!("{prefix}{unit}"), scale)
}

/// The range of an axis: with zero, unless all values lie close together far from it.
fn range(lines: &[TimeLine], scale: f64) -> (f64, f64) {
    let values = lines.iter().flat_map(|l| l.pieces.iter().flatten()).map(|p| p[1] / scale);
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
    if low > high {
        return (-1.0, 1.0);
    }
    let size = low.abs().max(high.abs());
    let (mut low, mut high) = (low, high);
    // What varies by less than this is round-off.
    let constant = high - low <= 1e-7 * size;
    if constant || high - low > 0.2 * size || low * high < 0.0 {
        (low, high) = (low.min(0.0), high.max(0.0));
    }
    if high - low < f64::MIN_POSITIVE {
        return (-1.0, 1.0);
    }
    let room = 0.06 * (high - low);
    (if low == 0.0 { low } else { low - room }, if high == 0.0 { high } else { high + room })
}

fn panel(plot: &TimePlot, p: &TimePanel, time: &TimeAxis, [top, bottom]: [f64; 2]) -> Group {
    let most = p.lines.iter().flat_map(|l| l.pieces.iter().flatten()).fold(0.0f64, |m, v| m.max(v[1].abs()));
    let (unit, scale) = unit(p.unit, most);
    let (low, high) = range(&p.lines, scale);
    let y = |v: f64| bottom - (v / scale - low) / (high - low) * (bottom - top);
    let head = if unit.is_empty() { p.quantity.clone() } else { format!("{}, {unit}", p.quantity) };
    let mut g = Group::new()
        .add(text(28.0, top - 10.0, 13.0, Anchor::Start, &head).set("font-weight", "bold"))
        .add(absent(plot, time, top, bottom))
        .add(time.grid(top, bottom));
    let at = ticks(low, high, 5);
    for (t, name) in at.iter().zip(tick_labels(&at)) {
        let y = y(t * scale);
        g = g
            .add(guide(line((LEFT, y), (time.right, y), GRID, 1.0)))
            .add(text(LEFT - 6.0, y + 4.0, 11.0, Anchor::End, &name).set("fill", FAINT));
    }
    if low < 0.0 && high > 0.0 {
        g = g.add(guide(line((LEFT, y(0.0)), (time.right, y(0.0)), LINE, 1.0)));
    }
    g = g.add(time.frame(top, bottom));
    // The first curve last, on top of the others.
    for (k, l) in p.lines.iter().enumerate().rev() {
        g = g.add(of(curve(l, k, time, &y), &format!("curve{k}"), &whose(p, l)));
    }
    g.add(names(p, time, &y, top, bottom))
}

/// What a curve shows: speeds are of members, everything else of parts.
fn whose<'p>(p: &'p TimePanel, l: &'p TimeLine) -> [Of<'p>; 2] {
    let name = l.names.first().map_or("", String::as_str);
    let part = if p.unit == ColumnUnit::RadianPerSecond { Of::Member(name) } else { Of::Element(name) };
    [part, Of::Quantity(&p.quantity)]
}

/// Each shift by itself, side by side on the same scales: a row a panel.
fn shifts(plot: &TimePlot, width: f64, top: f64) -> (Group, f64) {
    const APART: f64 = 14.0;
    const TALL: f64 = 110.0;
    const LEAST: f64 = 116.0;
    let right = width - 28.0;
    let fits = (((right - LEFT + APART) / (LEAST + APART)) as usize).max(1);
    let count = plot.shifts.len();
    let rows = count.div_ceil(fits);
    let columns = count.div_ceil(rows);
    let cell = ((right - LEFT + APART) / columns as f64 - APART).min(260.0);
    let span = plot.shifts[0].window[1] - plot.shifts[0].window[0];
    let (unit_of_time, scale) = TimeAxis::unit(span);
    let head = format!(
        "Each shift closely: {count} windows of {} {unit_of_time}, on the same scales",
        figures(span / scale, 3)
    );
    let mut y = top;
    let mut g = Group::new().add(text(28.0, y, 13.0, Anchor::Start, &head).set("font-weight", "bold"));
    y += 30.0;
    for (r, shown) in plot.shifts.chunks(columns).enumerate() {
        let panels = shown.first().map_or(0, |s| s.panels.len());
        for k in 0..panels {
            // One scale for all shifts, of all rows.
            let lines: Vec<TimeLine> = plot.shifts.iter().flat_map(|s| s.panels[k].lines.clone()).collect();
            let most = lines.iter().flat_map(|l| l.pieces.iter().flatten()).fold(0.0f64, |m, v| m.max(v[1].abs()));
            let (unit, size) = unit(shown[0].panels[k].unit, most);
            let (low, high) = range(&lines, size);
            let [above, below] = [y, y + TALL];
            let level = |v: f64| below - (v / size - low) / (high - low) * TALL;
            let name = &shown[0].panels[k].quantity;
            let name = if unit.is_empty() { name.clone() } else { format!("{name}, {unit}") };
            g = g.add(text(28.0, above - 8.0, 11.0, Anchor::Start, &name).set("fill", FAINT));
            let at = ticks(low, high, 4);
            for (t, name) in at.iter().zip(tick_labels(&at)) {
                let y = level(t * size);
                g = g.add(text(LEFT - 6.0, y + 4.0, 11.0, Anchor::End, &name).set("fill", FAINT));
            }
            for (c, shift) in shown.iter().enumerate() {
                let left = LEFT + c as f64 * (cell + APART);
                let time = TimeAxis::between(shift.window, left, left + cell);
                let number_of = r * columns + c + 1;
                for t in &at {
                    let y = level(t * size);
                    g = g.add(guide(line((left, y), (left + cell, y), GRID, 1.0)));
                }
                let mut d = String::new();
                let mut last = f64::NEG_INFINITY;
                for t in plot.event_times.iter().filter(|t| (shift.window[0]..=shift.window[1]).contains(*t)) {
                    let x = time.x(*t);
                    if x - last >= 2.5 {
                        d += &format!("M{} {} V{} ", number(x), number(above), number(below));
                        last = x;
                    }
                }
                if !d.is_empty() {
                    let path = Path::new().set("d", d.trim_end()).set("fill", "none").set("stroke", INK);
                    let path = path.set("stroke-width", 0.6).set("stroke-opacity", 0.5);
                    g = g.add(of(path, &format!("events{number_of}-{k}"), &[Of::Quantity("event_times")]));
                }
                g = g.add(time.frame(above, below));
                for (n, l) in shift.panels[k].lines.iter().enumerate().rev().filter(|(_, l)| !l.pieces.is_empty()) {
                    let word = format!("shift{number_of}-{n}");
                    g = g.add(of(curve(l, n, &time, &level), &word, &whose(&shift.panels[k], l)));
                }
                if k + 1 == panels {
                    // Where it begins.
                    let from = format!("from {} s", figures(shift.window[0], 4));
                    g = g.add(text(left, below + 16.0, 11.0, Anchor::Start, &from).set("fill", FAINT));
                }
            }
            y = below + 26.0;
        }
        y += 18.0;
    }
    (g, y)
}

/// The time that the run did not reach.
fn absent(plot: &TimePlot, time: &TimeAxis, top: f64, bottom: f64) -> Group {
    let from = time.x(plot.run[1]).max(LEFT);
    let right = time.right;
    if right - from < 1.0 {
        return Group::new();
    }
    let g = guide(Group::new()).add(rectangle(from, top, right - from, bottom - top, ABSENT));
    // One word of it is enough, above the first panel.
    if top > TOP || right - from < 70.0 {
        return g;
    }
    let word = if plot.outcome == Outcome::Finished { "no rows" } else { "not reached" };
    g.add(text(right, top - 4.0, 11.0, Anchor::End, word).set("fill", FAINT))
}

fn dashes(k: usize) -> &'static str {
    ["none", "none", "none", "7 3", "2 3", "9 3 2 3", "4 2", "1 2"][k % 8]
}

fn curve(l: &TimeLine, k: usize, time: &TimeAxis, y: &impl Fn(f64) -> f64) -> Group {
    let mut g = Group::new();
    for piece in &l.pieces {
        let points: Vec<[f64; 2]> = piece.iter().map(|p| [time.x(p[0]), y(p[1])]).collect();
        let points = simplified(&points);
        if let [one] = points[..] {
            g = g.add(
                Circle::new()
                    .set("cx", number(one[0]))
                    .set("cy", number(one[1]))
                    .set("r", 2)
                    .set("fill", colour(l.colour.or(Some(k)), 1.0)),
            );
            continue;
        }
        let words: Vec<String> = points.iter().map(|p| format!("{} {}", number(p[0]), number(p[1]))).collect();
        let mut path = Path::new()
            .set("d", format!("M{}", words.join(" L")))
            .set("fill", "none")
            .set("stroke", colour(l.colour.or(Some(k)), 1.0))
            .set("stroke-width", 1.8)
            .set("stroke-linejoin", "round");
        if dashes(k) != "none" {
            path = path.set("stroke-dasharray", dashes(k));
        }
        g = g.add(path);
    }
    g
}

/// A line of fewer points that looks the same (Douglas and Peucker).
fn simplified(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    if points.len() < 3 {
        return points.to_vec();
    }
    let mut keep = vec![false; points.len()];
    keep[0] = true;
    keep[points.len() - 1] = true;
    let mut parts = vec![(0, points.len() - 1)];
    while let Some((a, b)) = parts.pop() {
        let ([ax, ay], [bx, by]) = (points[a], points[b]);
        let length = (bx - ax).hypot(by - ay);
        let away = |p: [f64; 2]| {
            if length < 1e-12 {
                return (p[0] - ax).hypot(p[1] - ay);
            }
            ((bx - ax) * (p[1] - ay) - (by - ay) * (p[0] - ax)).abs() / length
        };
        let most = (a + 1..b).map(|k| (k, away(points[k]))).max_by(|p, q| p.1.total_cmp(&q.1));
        if let Some((k, _)) = most.filter(|m| m.1 > TOLERANCE) {
            keep[k] = true;
            parts.extend([(a, k), (k, b)]);
        }
    }
    points.iter().zip(keep).filter(|(_, k)| *k).map(|(p, _)| *p).collect()
}

/// Names beside the ends of the curves, moved apart.
fn names(p: &TimePanel, time: &TimeAxis, y: &impl Fn(f64) -> f64, top: f64, bottom: f64) -> Group {
    let mut ends: Vec<(usize, f64, f64)> = p
        .lines
        .iter()
        .enumerate()
        .filter_map(|(k, l)| l.pieces.last()?.last().map(|e| (k, time.x(e[0]), y(e[1]))))
        .collect();
    ends.sort_by(|a, b| a.2.total_cmp(&b.2).then(a.0.cmp(&b.0)));
    let wanted: Vec<f64> = ends.iter().map(|e| e.2).collect();
    let placed = spread(&wanted, top + 4.0, bottom - 4.0, SPACING);
    let mut g = Group::new();
    let right = time.right;
    for ((k, x, end), at) in ends.iter().zip(placed) {
        let l = &p.lines[*k];
        let own = colour(l.colour.or(Some(*k)), 1.0);
        let mut row = Group::new();
        let from = if right - x > 3.0 { (*x, *end) } else { (right, *end) };
        // From the end of the curve, level to the margin, then to the name.
        if right - x > 3.0 {
            row = row.add(line(from, (right, *end), &own, 0.8).set("stroke-dasharray", "1 3"));
        }
        let mut key = Path::new()
            .set(
                "d",
                format!(
                    "M{} {} L{} {} L{} {}",
                    number(right + 1.0),
                    number(*end),
                    number(right + 12.0),
                    number(at),
                    number(right + 36.0),
                    number(at)
                ),
            )
            .set("fill", "none")
            .set("stroke", own)
            .set("stroke-width", 1.8);
        if dashes(*k) != "none" {
            key = key.set("stroke-dasharray", dashes(*k));
        }
        row = row.add(key).add(text(right + 41.0, at + 4.0, 12.0, Anchor::Start, &together(&l.names, 24)));
        g = g.add(of(row, &format!("name{k}"), &whose(p, l)));
    }
    g
}

/// Places as near as possible to those wanted, in their order and a spacing apart.
fn spread(wanted: &[f64], low: f64, high: f64, spacing: f64) -> Vec<f64> {
    // Blocks of touching labels: their sum of wanted places (each less its offset), and their number.
    let mut blocks: Vec<(f64, usize)> = Vec::new();
    let count = wanted.len();
    let last = (high - spacing * count.saturating_sub(1) as f64).max(low);
    let place = |b: &(f64, usize)| b.0 / b.1 as f64;
    for (k, w) in wanted.iter().enumerate() {
        blocks.push(((w - spacing * k as f64).clamp(low, last), 1));
        while let [.., a, b] = blocks[..] {
            if place(&a) <= place(&b) {
                break;
            }
            blocks.pop();
            *blocks.last_mut().expect("there were two") = (a.0 + b.0, a.1 + b.1);
        }
    }
    let bases = blocks.iter().flat_map(|b| std::iter::repeat_n(place(b), b.1));
    bases.enumerate().map(|(k, base)| base + spacing * k as f64).collect()
}

fn together(names: &[String], most: usize) -> String {
    let all = names.join(" = ");
    if all.chars().count() <= most {
        return all;
    }
    let (first, rest) = names.split_first().expect("a curve has a name");
    match rest.len() {
        0 => short(first, most),
        n => format!("{} = {n} more", short(first, most - 9)),
    }
}

/// Fill of a mode, and what stands in it.
fn look(mode: Option<ModeLabel>) -> (String, &'static str) {
    match mode {
        Some(ModeLabel::Forward) => (colour(Some(0), 0.4), "forward"),
        Some(ModeLabel::Backward) => (colour(Some(1), 0.4), "backward"),
        Some(ModeLabel::Stuck) => (colour(None, 0.85), "locked"),
        Some(ModeLabel::Free) => (PAPER.to_owned(), "free"),
        None => (colour(Some(3), 0.5), "changing"),
    }
}

/// A block of a mode: forward has its upper edge marked and backward its lower, so that they
/// differ in grey as well.
fn block(mode: Option<ModeLabel>, x: f64, y: f64, width: f64, height: f64) -> Group {
    let (fill, _) = look(mode);
    let g = Group::new();
    match mode {
        Some(ModeLabel::Free) => {
            let middle = y + height / 2.0;
            g.add(line((x, middle), (x + width, middle), LINE, 1.0).set("stroke-dasharray", "2 3"))
        }
        Some(ModeLabel::Forward) => {
            g.add(rectangle(x, y, width, height, &fill)).add(rectangle(x, y, width, 3.5, &colour(Some(0), 1.0)))
        }
        Some(ModeLabel::Backward) => g.add(rectangle(x, y, width, height, &fill)).add(rectangle(
            x,
            y + height - 3.5,
            width,
            3.5,
            &colour(Some(1), 1.0),
        )),
        _ => g.add(rectangle(x, y, width, height, &fill)),
    }
}

fn modes(plot: &TimePlot, time: &TimeAxis, top: f64) -> Group {
    let bottom = top + ROW * plot.modes.len() as f64;
    let mut g = Group::new()
        .add(text(28.0, top - 10.0, 13.0, Anchor::Start, "Mode").set("font-weight", "bold"))
        .add(absent(plot, time, top, bottom))
        .add(time.grid(top, bottom));
    // The key: only what occurs.
    let order =
        [Some(ModeLabel::Forward), Some(ModeLabel::Backward), Some(ModeLabel::Stuck), Some(ModeLabel::Free), None];
    let mut x = LEFT;
    for m in order.into_iter().filter(|m| plot.modes.iter().any(|r| r.segments.iter().any(|s| s.mode == *m))) {
        let word = match m {
            Some(ModeLabel::Stuck) => "locked: held by friction",
            None => "changing fast",
            _ => look(m).1,
        };
        g = g.add(guide(block(m, x, top - 21.0, 22.0, 13.0))).add(text(
            x + 28.0,
            top - 10.0,
            11.0,
            Anchor::Start,
            word,
        ));
        x += 50.0 + 6.2 * word.chars().count() as f64;
    }
    for (k, r) in plot.modes.iter().enumerate() {
        g = g.add(of(mode_row(r, time, top + ROW * k as f64), "mode", &[Of::Element(&r.element)]));
    }
    g.add(time.frame(top, bottom))
}

fn mode_row(r: &ModeRow, time: &TimeAxis, y: f64) -> Group {
    let mut g = Group::new();
    for s in &r.segments {
        let (from, to) = (time.x(s.from), time.x(s.to));
        let width = (to - from).max(0.75);
        g = g.add(block(s.mode, from, y + 4.0, width, ROW - 8.0));
        let word = look(s.mode).1;
        if width > 6.5 * word.chars().count() as f64 + 8.0 {
            let ink = if s.mode == Some(ModeLabel::Stuck) { PAPER } else { INK };
            // Away from the marked edge.
            let shift = match s.mode {
                Some(ModeLabel::Forward) => 5.5,
                Some(ModeLabel::Backward) => 2.5,
                _ => 4.0,
            };
            let label = text(from + width / 2.0, y + ROW / 2.0 + shift, 11.0, Anchor::Middle, word);
            g = g.add(match s.mode == Some(ModeLabel::Free) {
                true => halo(label.set("fill", FAINT), PAPER, 5.0),
                false => Group::new().add(label.set("fill", ink)),
            });
        }
    }
    g.add(text(time.right + 8.0, y + ROW / 2.0 + 4.0, 12.0, Anchor::Start, &short(&r.element, 29)))
}

/// Thin lines where modes changed; the first have numbers.
fn events(plot: &TimePlot, time: &TimeAxis, frames: &[(f64, f64)]) -> Group {
    let mut g = Group::new();
    let (Some(first), Some(_)) = (frames.first(), plot.event_times.first()) else { return g };
    let mut d = String::new();
    let mut last = f64::NEG_INFINITY;
    let mut drawn = 0;
    for t in &plot.event_times {
        let x = time.x(*t);
        // No more than one line where two could not be told apart.
        if x - last < 2.5 || !(LEFT..=time.right).contains(&x) {
            continue;
        }
        last = x;
        drawn += 1;
        for (top, bottom) in frames {
            d += &format!("M{} {} V{} ", number(x), number(*top), number(*bottom));
        }
    }
    let path = Path::new()
        .set("d", d.trim_end())
        .set("fill", "none")
        .set("stroke", INK)
        .set("stroke-width", 0.6)
        .set("stroke-opacity", if drawn > 60 { 0.15 } else { 0.5 });
    g = g.add(of(path, "events", &[Of::Quantity("event_times")]));
    // Beside the head of the first panel.
    let head = plot.panels.first().map_or("Mode", |p| p.quantity.as_str()).chars().count() + 8;
    let mut free = LEFT.max(28.0 + 7.0 * head as f64);
    for (k, m) in plot.marks.iter().enumerate() {
        let x = time.x(m.time);
        let name = (k + 1).to_string();
        let half = 3.7 * name.len() as f64;
        if x - half < free || !(LEFT..=time.right).contains(&x) {
            continue;
        }
        free = x + half + 3.0;
        g = g.add(text(x, first.0 - 4.0, 11.0, Anchor::Middle, &name).set("fill", FAINT));
    }
    g
}

/// The first events in words, in two columns; and where the page ends.
fn told(plot: &TimePlot, time: &TimeAxis, top: f64) -> (Group, f64) {
    if plot.marks.is_empty() {
        return (Group::new(), top - 10.0);
    }
    let mut g = Group::new().add(text(28.0, top, 13.0, Anchor::Start, "Changes of mode").set("font-weight", "bold"));
    let rows = plot.marks.len().div_ceil(2);
    let column = EVENTS.min((time.right + NAMES - 40.0) / 2.0);
    for (k, m) in plot.marks.iter().enumerate() {
        let x = 28.0 + (k / rows) as f64 * column;
        let y = top + 22.0 + 18.0 * (k % rows) as f64;
        g = g
            .add(text(x + 16.0, y, 12.0, Anchor::End, &(k + 1).to_string()).set("fill", FAINT))
            .add(text(x + 104.0, y, 12.0, Anchor::End, &time.moment(m.time)))
            .add(text(x + 116.0, y, 12.0, Anchor::Start, &fit(&m.cause, column - 124.0, 12.0)));
    }
    let mut height = top + 22.0 + 18.0 * rows as f64;
    let rest = plot.event_count.saturating_sub(plot.marks.len());
    if rest > 0 {
        g = g.add(text(28.0 + 116.0, height, 12.0, Anchor::Start, &format!("… and {rest} more")).set("fill", FAINT));
        height += 18.0;
    }
    (g, height + 6.0)
}

/// Labels of ticks, all with the decimals that the step needs.
fn tick_labels(ticks: &[f64]) -> Vec<String> {
    let step = ticks.windows(2).map(|w| w[1] - w[0]).fold(f64::INFINITY, f64::min);
    let step = if step.is_finite() { step } else { ticks.first().map_or(1.0, |t| t.abs().max(1e-9)) };
    let decimals = (-(step * 1.000_001).log10().floor()).clamp(0.0, 9.0) as usize;
    let most = ticks.iter().fold(0.0f64, |m, t| m.max(t.abs()));
    let one = |t: &f64| {
        let t = if t.abs() < 1e-9 * step { 0.0 } else { *t };
        let text = if most >= 1e7 || (most < 1e-6 && most > 0.0) { figures(t, 3) } else { format!("{t:.decimals$}") };
        text.replace('-', "−")
    };
    ticks.iter().map(one).collect()
}

fn short_number(x: f64) -> String {
    if x.is_nan() {
        return "not determined".to_owned();
    }
    let size = x.abs();
    if size != 0.0 && !(1e-3..1e6).contains(&size) {
        return figures(x, 3);
    }
    let decimals = if size == 0.0 { 0 } else { (3 - size.log10().floor() as i32).clamp(0, 6) as usize };
    format!("{x:.decimals$}")
}

/// A text that fits.
fn short(name: &str, most: usize) -> String {
    if name.chars().count() <= most {
        return name.to_owned();
    }
    name.chars().take(most - 1).chain(['…']).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_are_apart_in_order_and_inside() {
        let placed = spread(&[0.0, 1.0, 2.0, 50.0, 99.0, 100.0], 0.0, 100.0, 14.0);
        assert!(placed.windows(2).all(|w| w[1] - w[0] >= 14.0 - 1e-9), "{placed:?}");
        assert!(placed[0] >= 0.0 && placed[5] <= 100.0 + 1e-9, "{placed:?}");
        assert_eq!(spread(&[10.0, 60.0], 0.0, 100.0, 14.0), [10.0, 60.0]);
    }

    #[test]
    fn a_straight_line_is_two_points_and_a_spike_stays() {
        let mut points: Vec<[f64; 2]> = (0..1000).map(|k| [f64::from(k), 2.0 * f64::from(k)]).collect();
        assert_eq!(simplified(&points).len(), 2);
        points[500][1] += 40.0;
        assert!(simplified(&points).contains(&points[500]));
    }

    #[test]
    fn ticks_have_the_digits_they_need() {
        assert_eq!(tick_labels(&[0.0, 0.5, 1.0]), ["0.0", "0.5", "1.0"]);
        assert_eq!(tick_labels(&[-100.0, 0.0, 100.0]), ["−100", "0", "100"]);
    }
}
