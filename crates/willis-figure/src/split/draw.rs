//! A power split over its ratio: three charts on one axis.

use svg::node::element::{Circle, Group};

use crate::parts::alive::{Of, guide, of};
use crate::parts::chart::{Chart, Scale};
use crate::parts::style::{
    Anchor, BOLD, FAINT, INK, LINE, PAPER, colour, digits, fit, line, lines, number, page, rectangle, text, wide,
};
use crate::{Drawing, Split, SplitMode, SplitPoint};

const WIDTH: f64 = 1000.0;
const NARROWEST: f64 = 640.0;
const LEFT: f64 = 92.0;
/// Right of the charts: the names of curves.
const NAMES: f64 = 200.0;
const TOP: f64 = 118.0;
const GAP: f64 = 46.0;
const HEIGHTS: [f64; 3] = [230.0, 150.0, 190.0];

/// Efficiency, share of the variator and powers of its machines over the ratio. Upright dashed lines are mechanical
/// points; dots are equilibria beside the best.
pub fn draw(split: &Split) -> String {
    draw_on(split, Drawing::default())
}

pub(super) fn draw_on(split: &Split, paper: Drawing) -> String {
    let width = paper.page(WIDTH, NARROWEST);
    let right = width - NAMES;
    let x = &split.x.values;
    let mut body = Group::new();
    let mut top = TOP;
    let several = split.modes.len() > 1;
    let (unit, scale) = power_unit(split);
    for (k, height) in HEIGHTS.into_iter().enumerate() {
        let curves = match k {
            0 => efficiencies(split),
            1 => shares(split),
            _ => powers(split, scale),
        };
        let values = curves.iter().flat_map(|c| c.points.iter().copied().flatten());
        let y = match k {
            0 => Scale::efficiency(values.chain(split.gears.iter().map(|g| 100.0 * g.efficiency))),
            1 => Scale::of(values.chain([0.0]), "Through the variator, %").rounded(),
            _ => Scale::of(values.chain([0.0]), format!("Power to its member, {unit}")).rounded(),
        };
        let title = if k == 2 { "Ratio: speed of the input over that of the output" } else { "" };
        let scale = Scale { low: x[0], high: x[x.len() - 1], title: title.into() };
        let chart = Chart { left: LEFT, top, right, bottom: top + height, x: scale, y };
        body = body.add(chart.grid());
        if k > 0 && chart.y.low < 0.0 && chart.y.high > 0.0 {
            body = body.add(guide(line((LEFT, chart.y(0.0)), (right, chart.y(0.0)), LINE, 1.2)));
        }
        if k == 0 && several {
            body = body.add(best(split, &chart));
        }
        body = body.add(mechanical(split, &chart, k == 0));
        let what = ["efficiency", "share", "power_w"][k];
        for (n, c) in curves.iter().enumerate() {
            if let Some(path) = chart.path(x.iter().copied().zip(c.points.iter().copied())) {
                let path = path.set("stroke", c.colour.as_str()).set("stroke-width", 2);
                let path = if c.dashed { path.set("stroke-dasharray", "6 3") } else { path };
                body = body.add(of(path, &format!("curve{n}"), &[Of::Element(&c.name), Of::Quantity(what)]));
            }
        }
        if k == 0 {
            body = body.add(others(split, &chart)).add(gears(split, &chart));
        }
        body = body.add(chart.frame()).add(names(&curves, &chart, what));
        top += height + GAP;
    }
    let (notes, bottom) = notes(split, top + 20.0, width);
    let describe = describe(split);
    page(width, bottom, &format!("Power split of {}", split.title), &describe)
        .add(
            text(28.0, 38.0, 20.0, Anchor::Start, &fit(&split.title, (width - 80.0) / BOLD, 20.0))
                .set("font-weight", "bold"),
        )
        .add(text(28.0, 60.0, 13.0, Anchor::Start, &fit(&split.basis, width - 80.0, 13.0)).set("fill", FAINT))
        .add(body)
        .add(notes)
        .to_string()
}

/// A line of a chart, and what it is called.
struct Curve {
    name: String,
    colour: String,
    dashed: bool,
    points: Vec<Option<f64>>,
}

fn mode_name(split: &Split, k: usize) -> String {
    match (&split.modes[k].state, split.modes.len()) {
        (Some(state), 2..) => state.clone(),
        _ => String::new(),
    }
}

fn over(mode: &SplitMode, value: impl Fn(&SplitPoint) -> Option<f64>) -> Vec<Option<f64>> {
    mode.points.iter().map(value).collect()
}

fn efficiencies(split: &Split) -> Vec<Curve> {
    let one = |(k, mode): (usize, &SplitMode)| Curve {
        name: mode_name(split, k),
        colour: colour(Some(k), 1.0),
        dashed: false,
        points: over(mode, |p| p.efficiencies.first().map(|e| 100.0 * e)),
    };
    split.modes.iter().enumerate().map(one).collect()
}

fn shares(split: &Split) -> Vec<Curve> {
    let one = |(k, mode): (usize, &SplitMode)| Curve {
        name: mode_name(split, k),
        colour: colour(Some(k), 1.0),
        dashed: false,
        points: over(mode, |p| p.share.map(|s| 100.0 * s)),
    };
    split.modes.iter().enumerate().map(one).collect()
}

/// The machines of a mode, in the order in which the train has them.
fn machines(mode: &SplitMode) -> Vec<String> {
    let first = mode.points.iter().find(|p| !p.powers_w.is_empty());
    first.map_or(vec![], |p| p.powers_w.iter().map(|(name, _)| name.clone()).collect())
}

fn powers(split: &Split, scale: f64) -> Vec<Curve> {
    let several = split.modes.len() > 1;
    let mut all = Vec::new();
    for (k, mode) in split.modes.iter().enumerate() {
        for (n, machine) in machines(mode).into_iter().enumerate() {
            let of = |p: &SplitPoint| p.powers_w.iter().find(|(name, _)| *name == machine).map(|(_, w)| w / scale);
            let points = over(mode, of);
            let state = mode_name(split, k);
            let name = if several { format!("{machine}, {state}") } else { machine.clone() };
            // One mode has a colour for each machine, several have one for each mode.
            let (own, dashed) = if several { (k, n % 2 == 1) } else { (n + 1, false) };
            all.push(Curve { name, colour: colour(Some(own), 1.0), dashed, points });
        }
    }
    all
}

fn power_unit(split: &Split) -> (&'static str, f64) {
    let all = split.modes.iter().flat_map(|m| &m.points).flat_map(|p| &p.powers_w);
    match all.fold(0.0f64, |a, (_, p)| a.max(p.abs())) {
        m if m >= 2e6 => ("MW", 1e6),
        m if m >= 2e3 => ("kW", 1e3),
        _ => ("W", 1.0),
    }
}

/// Which mode is best where, as a band at the bottom.
fn best(split: &Split, chart: &Chart) -> Group {
    let x = &split.x.values;
    let mut g = Group::new();
    let edge = |k: usize| match k {
        0 => x[0],
        k if k == x.len() => x[k - 1],
        k => 0.5 * (x[k - 1] + x[k]),
    };
    let mut from = 0;
    while from < x.len() {
        let to = (from..x.len()).find(|&k| split.best[k] != split.best[from]).unwrap_or(x.len());
        if let Some(mode) = split.best[from] {
            let (left, right) = (chart.x(edge(from)), chart.x(edge(to)));
            let own = rectangle(left, chart.bottom - 6.0, right - left, 6.0, &colour(Some(mode), 0.6));
            g = g.add(of(own, &format!("best{from}"), &[Of::State(&mode_name(split, mode))]));
        }
        from = to;
    }
    g
}

fn mechanical(split: &Split, chart: &Chart, named: bool) -> Group {
    let mut g = Group::new();
    // Modes may share a point.
    let mut told: Vec<(f64, Vec<String>)> = Vec::new();
    for m in split.modes.iter().flat_map(|m| &m.mechanical) {
        let inside = m.ratio >= chart.x.low && m.ratio <= chart.x.high;
        match told.iter_mut().find(|t| t.0 == m.ratio) {
            Some(t) if !t.1.contains(&m.side) => t.1.push(m.side.clone()),
            Some(_) => {}
            None if inside => told.push((m.ratio, vec![m.side.clone()])),
            None => {}
        }
    }
    told.sort_by(|a, b| a.0.total_cmp(&b.0));
    // Labels that would run into each other stand on lines of their own.
    let mut ends = [f64::NEG_INFINITY; 2];
    for (ratio, sides) in told {
        let x = chart.x(ratio);
        let own = line((x, chart.top), (x, chart.bottom), INK, 1.0).set("stroke-dasharray", "3 3");
        let word = format!("rest{}", number(chart.top));
        g = g.add(of(own, &word, &[Of::Element(&sides.join(", ")), Of::Quantity(&format!("ratio {ratio}"))]));
        if named {
            let label = format!("{} at rest, {}", sides.join(", "), digits(ratio));
            let half = wide(&label, 11.0) / 2.0;
            let middle = x.clamp(LEFT + half, chart.right + NAMES - 20.0 - half);
            let row = usize::from(ends[0] > middle - half - 6.0);
            ends[row] = middle + half;
            g = g.add(text(middle, chart.top - 8.0 - 14.0 * row as f64, 11.0, Anchor::Middle, &label));
        }
    }
    g
}

/// Equilibria beside the best.
fn others(split: &Split, chart: &Chart) -> Group {
    let mut g = Group::new();
    for (k, mode) in split.modes.iter().enumerate() {
        let name = mode_name(split, k);
        let mut own = of(Group::new(), &format!("others{k}"), &[Of::State(&name), Of::Quantity("efficiency")]);
        for (x, p) in split.x.values.iter().zip(&mode.points) {
            for e in p.efficiencies.iter().skip(1).filter(|e| 100.0 * **e >= chart.y.low) {
                let dot =
                    Circle::new().set("cx", number(chart.x(*x))).set("cy", number(chart.y(100.0 * e))).set("r", 1.6);
                own = own.add(dot.set("fill", colour(Some(k), 0.8)));
            }
        }
        g = g.add(own);
    }
    g
}

fn gears(split: &Split, chart: &Chart) -> Group {
    let inside = split.gears.iter().filter(|g| g.ratio >= chart.x.low && g.ratio <= chart.x.high);
    inside.fold(Group::new(), |g, gear| {
        let (x, y) = (chart.x(gear.ratio), chart.y(100.0 * gear.efficiency));
        let dot = Circle::new().set("cx", number(x)).set("cy", number(y)).set("r", 4);
        let dot =
            of(dot.set("fill", PAPER).set("stroke", INK).set("stroke-width", 1.6), "gear", &[Of::State(&gear.state)]);
        g.add(dot).add(text(
            x + 8.0,
            // Clear of the curves, which are beside and above it.
            y + 18.0,
            11.0,
            Anchor::Start,
            &gear.state,
        ))
    })
}

/// Names of the curves at their right ends, none over another.
fn names(curves: &[Curve], chart: &Chart, what: &str) -> Group {
    const SPACING: f64 = 15.0;
    let end = |c: &Curve| c.points.iter().rev().flatten().next().map(|y| chart.y(*y));
    let mut labels: Vec<(f64, &Curve)> =
        curves.iter().filter(|c| !c.name.is_empty()).filter_map(|c| Some((end(c)?, c))).collect();
    labels.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut last = f64::NEG_INFINITY;
    for l in &mut labels {
        l.0 = l.0.max(last + SPACING).max(chart.top + 6.0);
        last = l.0;
    }
    labels.into_iter().fold(Group::new(), |g, (y, c)| {
        let name = fit(&c.name, NAMES - 48.0, 12.0);
        let mark = line((chart.right + 8.0, y), (chart.right + 26.0, y), &c.colour, 2.0);
        let mark = if c.dashed { mark.set("stroke-dasharray", "6 3") } else { mark };
        let own = Group::new().add(mark).add(text(chart.right + 32.0, y + 4.0, 12.0, Anchor::Start, &name));
        g.add(of(own, "name", &[Of::Element(&c.name), Of::Quantity(what)]))
    })
}

fn notes(split: &Split, top: f64, width: f64) -> (Group, f64) {
    let mut all = vec!["A positive share runs from the first side of the variator to the second.".to_owned()];
    if split.modes.len() > 1 {
        all.push("The band at the foot of the first chart has the colour of the most efficient mode.".into());
    }
    if split.modes.iter().flat_map(|m| &m.points).any(|p| p.efficiencies.len() > 1) {
        all.push("Dots: where several equilibria exist, those beside the best one; 0 % dissipates everything.".into());
    }
    let beyond: Vec<f64> = (split.modes.iter())
        .flat_map(|m| split.x.values.iter().zip(&m.points).filter(|(_, p)| p.beyond_limits).map(|(x, _)| *x))
        .collect();
    if !beyond.is_empty() {
        let (low, high) = beyond.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(*x), h.max(*x)));
        let from_to = format!("between the ratios {} and {}", digits(low), digits(high));
        all.push(format!("A limit of the variator is exceeded at {} of the points, {from_to}.", beyond.len()));
    }
    let mut g = Group::new();
    let all: Vec<String> = all.iter().flat_map(|words| lines(words, width - 56.0, 12.0)).collect();
    for (k, words) in all.iter().enumerate() {
        let y = top + 16.0 * k as f64;
        g = g.add(text(28.0, y, 12.0, Anchor::Start, words).set("fill", FAINT));
    }
    (g, top + 16.0 * all.len() as f64 + 6.0)
}

fn describe(split: &Split) -> String {
    let mode = |(k, m): (usize, &SplitMode)| {
        let efficiencies: Vec<f64> = m.points.iter().filter_map(|p| p.efficiencies.first()).copied().collect();
        let best = efficiencies.iter().copied().fold(0.0, f64::max);
        let points: Vec<String> = m.mechanical.iter().map(|p| format!("{} at rest at {}", p.side, p.exact)).collect();
        format!("{}: at best {} %; {}", mode_name(split, k), digits(100.0 * best), points.join(", "))
    };
    split.modes.iter().enumerate().map(mode).collect::<Vec<_>>().join(". ")
}
