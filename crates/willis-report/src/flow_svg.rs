//! Power flows as a hypergraph: components, contacts, and lines as wide as their power.
//!
//! The layout is layered, inputs at the left. Lines bend only in the gaps between columns, where
//! their labels stand too, so that they never cross a node.

use std::collections::HashMap;

use rust_sugiyama::configure::Config;
use rust_sugiyama::from_vertices_and_edges;
use svg::Node as _;
use svg::node::element::{Circle, Element, Group, Path, Polygon};
use willis::analysis::Verdict;
use willis::hypergraph::{FlowReport, Hypergraph, Node, NodeKind, watts};

use crate::style::{Anchor, FAINT, INK, LINE, PAPER, colour, fit, line, lines, number, page, rectangle, text, wide};

const MARGIN: f64 = 28.0;
/// Radius of a symbol.
const R: f64 = 8.0;
/// Size of labels.
const SMALL: f64 = 11.0;
/// Width of the line of the largest power.
const WIDEST: f64 = 11.0;
/// Narrowest page.
const NARROWEST: f64 = 760.0;
/// Least gap between columns.
const GAP: f64 = 84.0;
/// Room below the symbols of contacts that lean on the frame.
const GROUND: f64 = 13.0;

/// The power flows of a train: one figure for each equilibrium, below each other.
///
/// Solid circles are components, hollow circles bearings, hollow triangles tooth contacts, hollow
/// squares seals, diamonds gears and rotors in their fluid, double bars clutches and brakes. The
/// width of a line is in proportion to the power. What leans on the frame bears a ground mark.
/// Power that runs in a circle is orange.
///
/// # Example
/// ```
/// use willis::train::{OperationSpec, SetSpec, Train};
/// use willis::units::{AngularSpeed, Torque};
///
/// let train = Train::builder("one set")
///     .members(["s", "c"])
///     .terminals(["s", "c"])
///     .set(SetSpec::simple("P1", ("s", 30), ("frame", 70), "c").planet(20, 4).mesh_efficiency(0.99))
///     .operation(
///         OperationSpec::new("full load")
///             .speed("s", AngularSpeed::rpm(1000.0))
///             .torque("s", Torque::n_m(10.0)),
///     )
///     .build()?;
/// let figure = willis_report::flow_svg(&willis::hypergraph::flows(&train, &Default::default())?);
/// assert!(figure.starts_with("<svg"));
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn flow_svg(all: &FlowReport) -> String {
    let mut panels: Vec<(String, Vec<String>, Option<Drawing>)> = Vec::new();
    for o in &all.operations {
        let count = o.solutions.len();
        let state = o.state.as_ref().map(|s| format!(", state {s}")).unwrap_or_default();
        let title = format!("{}{state}", o.name);
        for (k, g) in o.solutions.iter().enumerate() {
            let number = if count > 1 { format!(", solution {} of {count}", k + 1) } else { String::new() };
            panels.push((format!("{title}{number}"), caption(g), Some(Drawing::new(g))));
        }
        for g in &o.dissipative_solutions {
            let mut words = vec!["Locked: this is what it would take if every loaded member pushed.".to_owned()];
            words.extend(caption(g));
            panels.push((title.clone(), words, Some(Drawing::new(g))));
        }
        if count == 0 && o.dissipative_solutions.is_empty() {
            let word = if o.verdict == Verdict::Locked { "The train is locked" } else { "Not determined" };
            let why = o.reason.clone().map_or(String::new(), |r| format!(": {r}"));
            panels.push((title, vec![format!("{word}, no power flows{why}.")], None));
        }
    }
    let widest = panels.iter().filter_map(|p| p.2.as_ref()).fold(0.0f64, |a, d| a.max(d.width));
    let width = (widest + 2.0 * MARGIN).max(NARROWEST).ceil();
    let mut body = Group::new().add(
        text(MARGIN, 40.0, 20.0, Anchor::Start, &fit(&all.train, width - 2.0 * MARGIN, 20.0))
            .set("font-weight", "bold"),
    );
    let mut y = 52.0;
    let mut words = Vec::new();
    let mut kinds: Vec<NodeKind> = Vec::new();
    let (mut round, mut within, mut ground, mut rest) = (false, false, false, false);
    for (title, caption, drawing) in &panels {
        y += 24.0;
        body = body.add(
            text(MARGIN, y, 14.0, Anchor::Start, &fit(title, width - 2.0 * MARGIN, 14.0)).set("font-weight", "bold"),
        );
        for sentence in caption {
            for l in lines(sentence, width - 2.0 * MARGIN, 12.0) {
                y += 17.0;
                body = body.add(text(MARGIN, y, 12.0, Anchor::Start, &l).set("fill", FAINT));
            }
        }
        words.push(format!("{title}. {}", caption.join(" ")));
        y += 14.0;
        if let Some(d) = drawing {
            let x = (width - d.width) / 2.0;
            let at = format!("translate({} {})", number(x), number(y));
            body = body.add(d.group.clone().set("transform", at));
            y += d.height;
            kinds.extend(&d.kinds);
            round |= d.round;
            within |= d.within;
            ground |= d.ground;
            rest |= d.rest;
        }
        y += 18.0;
    }
    kinds.sort_unstable();
    kinds.dedup();
    let (key, height) = legend(&kinds, [round, within, ground, rest], y, width);
    page(width, height, &format!("Power flow of {}", all.train), &words.join(" ")).add(body).add(key).to_string()
}

/// Every equilibrium with its title.
pub fn graphs(all: &FlowReport) -> Vec<(String, &Hypergraph)> {
    let mut list = Vec::new();
    for o in &all.operations {
        let both = o.solutions.len() + o.dissipative_solutions.len();
        for (k, g) in o.solutions.iter().chain(&o.dissipative_solutions).enumerate() {
            let title = match both {
                1 => o.name.clone(),
                _ => format!("{}, solution {} of {both}", o.name, k + 1),
            };
            list.push((title, g));
        }
    }
    list
}

fn caption(g: &Hypergraph) -> Vec<String> {
    let efficiency = match g.efficiency {
        Some(e) if g.output_power_w > 0.0 => format!("η {}", percent(e)),
        Some(_) => "no power leaves: all of it is lost".to_owned(),
        None => "no power enters".to_owned(),
    };
    let power = format!(
        "{efficiency}: in {}, out {}, lost {}.",
        watts(g.input_power_w),
        watts(g.output_power_w),
        watts(g.loss_w)
    );
    let sentence = |t: String| {
        let mut letters = t.chars();
        letters.next().map_or(String::new(), |c| c.to_uppercase().chain(letters).collect::<String>()) + "."
    };
    std::iter::once(power).chain(g.recirculation().into_iter().map(sentence)).collect()
}

fn percent(x: f64) -> String {
    let p = 100.0 * x;
    if (99.995..100.0).contains(&p) || (0.0 < p && p < 0.1) { format!("{p:.4} %") } else { format!("{p:.2} %") }
}

/// What stands below a symbol.
fn value(n: &Node) -> String {
    match n.kind {
        NodeKind::Input => watts(n.power_out_w),
        NodeKind::Output => watts(n.power_in_w),
        NodeKind::Member => match n.speed_rad_s {
            Some(0.0) => "at rest".to_owned(),
            Some(w) => format!("{} rpm", rpm(w * 30.0 / std::f64::consts::PI)),
            None => "any speed".to_owned(),
        },
        _ if n.loss_w == 0.0 => String::new(),
        _ if n.power_out_w == 0.0 => format!("−{}", watts(n.loss_w)),
        _ => format!("−{} · {}", watts(n.loss_w), percent(n.efficiency.unwrap_or(1.0))),
    }
}

fn rpm(x: f64) -> String {
    let decimals = if x.abs() >= 1000.0 { 0 } else { 1 };
    let t = format!("{x:.decimals$}");
    if t.contains('.') { t.trim_end_matches('0').trim_end_matches('.').to_owned() } else { t }.replace('-', "−")
}

/// What stands above a symbol.
fn name(n: &Node) -> String {
    let own = match n.kind {
        NodeKind::Input => "input".to_owned(),
        NodeKind::Output => "output".to_owned(),
        NodeKind::Gear => fit(&format!("{} in fluid", n.name), 30.0 * SMALL * 0.61, SMALL),
        _ => fit(&n.name, 30.0 * SMALL * 0.61, SMALL),
    };
    if n.count > 1 { format!("{own} ×{}", n.count) } else { own }
}

/// A place where a line passes a column: a node, or the empty space between nodes.
struct Place {
    /// The node, or none.
    node: Option<usize>,
    column: usize,
    y: f64,
    /// From its middle to its upper and lower bound.
    half: f64,
}

/// A line of the picture, from column to column.
struct Line {
    edge: usize,
    /// From left to right.
    places: Vec<usize>,
    /// Whether the power runs from right to left.
    backwards: bool,
    width: f64,
    /// Widths of what circulates between sets, and within one.
    round: [f64; 2],
    /// Distance from the middle where it leaves its left end and where it enters its right end.
    ports: [f64; 2],
    points: Vec<(f64, f64)>,
}

struct Drawing {
    group: Group,
    width: f64,
    height: f64,
    kinds: Vec<NodeKind>,
    round: bool,
    within: bool,
    ground: bool,
    rest: bool,
}

#[derive(Clone, Copy)]
struct Area {
    x: [f64; 2],
    y: [f64; 2],
}

impl Area {
    fn around(x: f64, y: f64, width: f64, height: f64) -> Self {
        Self { x: [x - width / 2.0, x + width / 2.0], y: [y - height / 2.0, y + height / 2.0] }
    }

    fn meets(&self, o: &Self) -> bool {
        self.x[0] < o.x[1] && o.x[0] < self.x[1] && self.y[0] < o.y[1] && o.y[0] < self.y[1]
    }

    fn holds(&self, p: (f64, f64)) -> bool {
        (self.x[0]..=self.x[1]).contains(&p.0) && (self.y[0]..=self.y[1]).contains(&p.1)
    }
}

/// Places of the nodes in columns: two rounds of the layered layout, the second with a vertex in
/// every column that a long line passes.
fn places(sizes: &[f64], pairs: &[(usize, usize)]) -> (Vec<Place>, Vec<Vec<usize>>) {
    let config = Config { vertex_spacing: 10.0, ..Config::default() };
    let solve = |sizes: &[f64], pairs: &[(usize, usize)]| -> Vec<(usize, f64)> {
        let vertices: Vec<(u32, (f64, f64))> =
            sizes.iter().enumerate().map(|(k, s)| (k as u32, (2.0 * s, 20.0))).collect();
        let edges: Vec<(u32, u32)> = pairs.iter().map(|e| (e.0 as u32, e.1 as u32)).collect();
        let mut all = vec![(0, 0.0); sizes.len()];
        let mut top = 0.0;
        for (own, ..) in from_vertices_and_edges(&vertices, &edges, &config) {
            let mut levels: Vec<f64> = own.iter().map(|v| v.1.1).collect();
            levels.sort_by(f64::total_cmp);
            levels.dedup_by(|a, b| (*a - *b).abs() < 1e-6);
            let column = |y: f64| levels.iter().position(|l| (l - y).abs() < 1e-6).unwrap_or(0);
            let size = |k: usize| sizes[k];
            let low = own.iter().map(|(k, v)| v.0 - size(*k)).fold(f64::INFINITY, f64::min);
            let high = own.iter().map(|(k, v)| v.0 + size(*k)).fold(f64::NEG_INFINITY, f64::max);
            for (k, (x, y)) in own {
                all[k] = (column(y), x - low + top);
            }
            top += high - low + 20.0;
        }
        all
    };
    let first = solve(sizes, pairs);
    let mut sizes = sizes.to_vec();
    let mut steps: Vec<(usize, usize)> = Vec::new();
    let mut routes: Vec<Vec<usize>> = Vec::new();
    let nodes = sizes.len();
    for &(a, b) in pairs {
        let mut route = vec![a];
        for _ in first[a].0 + 1..first[b].0 {
            sizes.push(9.0);
            route.push(sizes.len() - 1);
        }
        route.push(b);
        steps.extend(route.windows(2).map(|w| (w[0], w[1])));
        routes.push(route);
    }
    let second = solve(&sizes, &steps);
    let mut all: Vec<Place> = second
        .into_iter()
        .enumerate()
        .map(|(k, (column, y))| Place { node: (k < nodes).then_some(k), column, y, half: sizes[k] })
        .collect();
    // Whatever the layout does, nothing in one column may overlap.
    let columns = all.iter().map(|p| p.column + 1).max().unwrap_or(0);
    for c in 0..columns {
        let mut own: Vec<usize> = (0..all.len()).filter(|&k| all[k].column == c).collect();
        own.sort_by(|a, b| all[*a].y.total_cmp(&all[*b].y).then(a.cmp(b)));
        for w in own.windows(2) {
            let least = all[w[0]].y + all[w[0]].half + all[w[1]].half + 4.0;
            if all[w[1]].y < least {
                all[w[1]].y = least;
            }
        }
    }
    (all, routes)
}

impl Drawing {
    fn new(g: &Hypergraph) -> Self {
        // What takes part; the frame is drawn as a mark at what leans on it.
        let touched = |id: &str| g.edges.iter().any(|e| e.from == id || e.to == id);
        let shown: Vec<&Node> = g.nodes.iter().filter(|n| n.kind != NodeKind::Frame && touched(&n.id)).collect();
        let index: HashMap<&str, usize> = shown.iter().enumerate().map(|(k, n)| (n.id.as_str(), k)).collect();
        let leans: Vec<bool> = shown
            .iter()
            .map(|n| g.edges.iter().any(|e| e.from == n.id && e.to == "frame" || e.to == n.id && e.from == "frame"))
            .collect();
        let edges: Vec<usize> = (0..g.edges.len())
            .filter(|&k| [&g.edges[k].from, &g.edges[k].to].iter().all(|id| index.contains_key(id.as_str())))
            .collect();
        let ends = |k: usize| (index[g.edges[k].from.as_str()], index[g.edges[k].to.as_str()]);

        // Left to right as the power runs that does not circulate.
        let order = order(shown.len(), g, &edges, &ends);
        let pairs: Vec<(usize, usize)> = edges
            .iter()
            .map(|&k| {
                let (a, b) = ends(k);
                if order[a] < order[b] { (a, b) } else { (b, a) }
            })
            .collect();
        let largest = g.edges.iter().fold(f64::MIN_POSITIVE, |a, e| a.max(e.power_w));
        let width = |p: f64| if p > 0.0 { (WIDEST * p / largest).max(1.0) } else { 0.0 };
        // Lines side by side may be higher than the symbol.
        let stack = |k: usize, left: bool| -> f64 {
            let mine = |e: &(usize, usize)| if left { e.1 == k } else { e.0 == k };
            let own = pairs.iter().zip(&edges).filter(|(e, _)| mine(e));
            own.map(|(_, j)| width(g.edges[*j].power_w).max(1.0) + 1.5).sum()
        };
        let more: Vec<f64> =
            (0..shown.len()).map(|k| (stack(k, true).max(stack(k, false)) / 2.0 - R).max(0.0)).collect();
        let sizes: Vec<f64> =
            (0..shown.len()).map(|k| R + 17.0 + more[k] + if leans[k] { GROUND } else { 0.0 }).collect();
        let (mut all, routes) = places(&sizes, &pairs);

        let mut lines: Vec<Line> = Vec::new();
        for ((&edge, route), &(left, _)) in edges.iter().zip(&routes).zip(&pairs) {
            let e = &g.edges[edge];
            let passes = |l: &&willis::hypergraph::Loop| {
                (0..l.nodes.len()).any(|k| l.nodes[k] == e.from && l.nodes[(k + 1) % l.nodes.len()] == e.to)
            };
            let between: f64 = g.loops.iter().filter(passes).filter(|l| l.within.is_none()).map(|l| l.power_w).sum();
            let within: f64 = g.loops.iter().filter(passes).filter(|l| l.within.is_some()).map(|l| l.power_w).sum();
            let mut places = route.clone();
            // The second layout may turn a step round.
            places.sort_by_key(|p| all[*p].column);
            let first = all[places[0]].node.unwrap_or(left);
            lines.push(Line {
                edge,
                places,
                backwards: e.power_w > 0.0 && ends(edge).0 != first,
                width: width(e.power_w),
                round: [width(between), width(within)],
                ports: [0.0; 2],
                points: vec![],
            });
        }
        ports(&mut lines, &all);

        // Columns.
        let columns = all.iter().map(|p| p.column + 1).max().unwrap_or(0);
        let mut half = vec![6.0f64; columns];
        for p in &all {
            if let Some(k) = p.node {
                let texts = wide(&name(shown[k]), SMALL).max(wide(&value(shown[k]), SMALL)) / 2.0;
                half[p.column] = half[p.column].max(texts + 4.0).max(R + 14.0);
            }
        }
        let mut gaps = vec![GAP; columns];
        for l in &lines {
            for w in l.places.windows(2) {
                let column = all[w[0]].column;
                gaps[column] = gaps[column].max((0.4 * (all[w[0]].y - all[w[1]].y).abs()).min(150.0));
            }
        }
        let mut middle = vec![0.0; columns];
        let mut x = 0.0;
        for c in 0..columns {
            middle[c] = x + half[c];
            x += 2.0 * half[c] + if c + 1 < columns { gaps[c] } else { 0.0 };
        }
        let mut right = x;

        for l in &mut lines {
            l.points = path(l, &all, &middle, &half);
        }
        // Labels, the strongest first.
        let mut turns: Vec<usize> = (0..lines.len()).filter(|&k| g.edges[lines[k].edge].power_w > 0.0).collect();
        turns.sort_by(|a, b| {
            let power = |k: usize| g.edges[lines[k].edge].power_w;
            power(*b).total_cmp(&power(*a)).then(a.cmp(b))
        });
        let mut labels: Vec<(Area, String)> = Vec::new();
        for k in turns {
            let words = watts(g.edges[lines[k].edge].power_w);
            let place = label(k, wide(&words, SMALL) + 2.0, &lines, &all, &middle, &half, &labels);
            labels.push((place, words));
        }

        // The upper left corner is the origin.
        let mut top = f64::INFINITY;
        let mut bottom = f64::NEG_INFINITY;
        for p in &all {
            (top, bottom) = (top.min(p.y - p.half), bottom.max(p.y + p.half));
        }
        for (b, _) in &labels {
            (top, bottom) = (top.min(b.y[0]), bottom.max(b.y[1]));
        }
        for l in &lines {
            for p in &l.points {
                (top, bottom) = (top.min(p.1 - l.width), bottom.max(p.1 + l.width));
            }
        }
        if all.is_empty() {
            (top, bottom, right) = (0.0, 0.0, 0.0);
        }
        let shift = 4.0 - top;
        for p in &mut all {
            p.y += shift;
        }
        for l in &mut lines {
            l.points.iter_mut().for_each(|p| p.1 += shift);
        }
        let mut group = Group::new();
        for l in lines.iter().filter(|l| l.width == 0.0).chain(lines.iter().filter(|l| l.width > 0.0)) {
            group = group.add(draw(l, g));
        }
        for p in all.iter() {
            if let Some(k) = p.node {
                group = group.add(symbol(shown[k], middle[p.column], p.y, leans[k], more[k]));
            }
        }
        for (b, words) in &labels {
            let (x, y) = ((b.x[0] + b.x[1]) / 2.0, (b.y[0] + b.y[1]) / 2.0 + shift + 0.36 * SMALL);
            group = group.add(halo(text(x, y, SMALL, Anchor::Middle, words)).set("class", "power"));
        }
        Self {
            group,
            width: right,
            height: bottom - top + 8.0,
            kinds: shown.iter().map(|n| n.kind).collect(),
            round: lines.iter().any(|l| l.round[0] > 0.0),
            within: lines.iter().any(|l| l.round[1] > 0.0),
            ground: leans.contains(&true),
            rest: lines.iter().any(|l| l.width == 0.0),
        }
    }
}

/// The position of each node in an order in which power that does not circulate runs forward.
fn order(n: usize, g: &Hypergraph, edges: &[usize], ends: &impl Fn(usize) -> (usize, usize)) -> Vec<usize> {
    let largest = g.edges.iter().fold(0.0f64, |a, e| a.max(e.power_w));
    let forward: Vec<(usize, usize)> = edges
        .iter()
        .filter(|&&k| g.edges[k].power_w - g.edges[k].circulating_w > 1e-9 * largest)
        .map(|&k| ends(k))
        .collect();
    let mut position = vec![usize::MAX; n];
    for place in 0..n {
        // The first whose feeders all have their place; in a round that is round-off, the first.
        let free = |k: &usize| position[*k] == usize::MAX;
        let ready = |k: &usize| forward.iter().all(|(a, b)| b != k || position[*a] != usize::MAX || a == k);
        let fed = |k: &usize| forward.iter().any(|(_, b)| b == k);
        let next = (0..n)
            .filter(free)
            .find(|k| ready(k) && fed(k))
            .or_else(|| (0..n).filter(free).find(ready))
            .or_else(|| (0..n).find(free));
        if let Some(k) = next {
            position[k] = place;
        }
    }
    position
}

/// Stacks the lines at both sides of each node, in the order of their other ends.
fn ports(lines: &mut [Line], all: &[Place]) {
    for (k, place) in all.iter().enumerate() {
        if place.node.is_none() {
            continue;
        }
        for side in [0, 1] {
            let at = |l: &Line| if side == 0 { l.places[0] } else { *l.places.last().expect("two ends") };
            let next = |l: &Line| if side == 0 { l.places[1] } else { l.places[l.places.len() - 2] };
            let mut own: Vec<usize> = (0..lines.len()).filter(|&j| at(&lines[j]) == k).collect();
            own.sort_by(|a, b| all[next(&lines[*a])].y.total_cmp(&all[next(&lines[*b])].y).then(a.cmp(b)));
            let room = |j: &usize| lines[*j].width.max(1.0) + 1.5;
            let total: f64 = own.iter().map(room).sum();
            let mut y = -total / 2.0;
            let rooms: Vec<f64> = own.iter().map(room).collect();
            for (j, room) in own.into_iter().zip(rooms) {
                lines[j].ports[side] = y + room / 2.0;
                y += room;
            }
        }
    }
}

/// The points of a line: ends, and the corners of the columns that it passes.
fn path(l: &Line, all: &[Place], middle: &[f64], half: &[f64]) -> Vec<(f64, f64)> {
    let mut points = Vec::new();
    for (k, &p) in l.places.iter().enumerate() {
        let (c, y) = (all[p].column, all[p].y);
        if k == 0 {
            let y = y + l.ports[0];
            points.extend([(middle[c], y), (middle[c] + half[c], y)]);
        } else if k + 1 == l.places.len() {
            let y = y + l.ports[1];
            points.extend([(middle[c] - half[c], y), (middle[c], y)]);
        } else {
            points.extend([(middle[c] - half[c], y), (middle[c] + half[c], y)]);
        }
    }
    points
}

/// A point of the bend between two corners.
fn bend(a: (f64, f64), b: (f64, f64), t: f64) -> (f64, f64) {
    let m = (a.0 + b.0) / 2.0;
    let s = 1.0 - t;
    let mix = |p: [f64; 4]| s * s * s * p[0] + 3.0 * s * s * t * p[1] + 3.0 * s * t * t * p[2] + t * t * t * p[3];
    (mix([a.0, m, m, b.0]), mix([a.1, a.1, b.1, b.1]))
}

/// The place of a line's label: in a gap that it crosses, on no other label, on few other lines.
fn label(
    k: usize,
    width: f64,
    lines: &[Line],
    all: &[Place],
    middle: &[f64],
    half: &[f64],
    labels: &[(Area, String)],
) -> Area {
    let own = &lines[k];
    let mut best: Option<(f64, Area)> = None;
    for gap in 0..own.points.len() / 2 {
        let Some(&[a, b]) = own.points.get(2 * gap + 1..2 * gap + 3) else { continue };
        let column = all[own.places[gap]].column;
        let bounds = [middle[column] + half[column], middle[column + 1] - half[column + 1]];
        // Other lines in this gap.
        let mut others: Vec<(f64, f64)> = Vec::new();
        for (j, o) in lines.iter().enumerate().filter(|(j, o)| *j != k && o.width > 0.0) {
            for (n, w) in o.points.windows(2).enumerate() {
                if n % 2 == 1 && (w[0].0 - a.0).abs() < 1.0 {
                    others.extend((0..=24).map(|i| bend(w[0], w[1], f64::from(i) / 24.0)));
                }
            }
            let _ = j;
        }
        for t in [0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8] {
            let (x, y) = bend(a, b, t);
            let x = x.clamp(bounds[0] + width / 2.0, (bounds[1] - width / 2.0).max(bounds[0] + width / 2.0));
            let beside = own.width / 2.0 + 8.0;
            for step in 0..24 {
                let far = 7.0 * f64::from(step / 2);
                let dy = if step % 2 == 0 { -beside - far } else { beside + far };
                let place = Area::around(x, y + dy, width, SMALL + 2.0);
                if labels.iter().any(|(o, _)| o.meets(&place)) {
                    continue;
                }
                let crossed = others.iter().filter(|p| place.holds(**p)).count();
                let through = (0..=24).filter(|i| place.holds(bend(a, b, f64::from(*i) / 24.0))).count();
                let cost = far + 3.0 * crossed as f64 + 2.5 * through as f64 + 8.0 * (t - 0.5).abs() + gap as f64;
                if best.as_ref().is_none_or(|b| cost < b.0) {
                    best = Some((cost, place));
                }
            }
        }
    }
    match best {
        Some((_, place)) => place,
        None => {
            // Below everything.
            let low = labels.iter().map(|l| l.0.y[1]).chain(all.iter().map(|p| p.y + p.half)).fold(0.0, f64::max);
            let x = own.points.first().map_or(0.0, |p| p.0);
            Area::around(x.max(width / 2.0), low + SMALL, width, SMALL + 2.0)
        }
    }
}

fn halo(t: svg::node::element::Text) -> svg::node::element::Text {
    t.set("paint-order", "stroke").set("stroke", PAPER).set("stroke-width", 3).set("stroke-linejoin", "round")
}

/// A line with its arrow head, and its words for a pointer.
fn draw(l: &Line, g: &Hypergraph) -> Group {
    let e = &g.edges[l.edge];
    let p = &l.points;
    let mut words = Element::new("title");
    let name = |id: &str| g.node(id).map_or(String::new(), |n| n.name.clone());
    words.append(svg::node::Text::new(format!("{} to {}: {}", name(&e.from), name(&e.to), watts(e.power_w))));
    let mut group = Group::new().add(words);
    // Where a symbol's outline is met.
    let reach = |y: f64| (R * R - y * y).max(0.0).sqrt().max(R * 0.5);
    let last = p.len() - 1;
    let mut points = p.clone();
    let head = (3.0 + 0.75 * l.width).min(9.5);
    let long = if l.width > 0.0 { 1.5 * head } else { 0.0 };
    let (left, right) = (points[0].0 + reach(l.ports[0]), points[last].0 - reach(l.ports[1]));
    points[0].0 = left + if l.backwards { long } else { -2.0 };
    points[last].0 = right - if l.backwards { -2.0 } else { long };
    let n = |p: (f64, f64)| format!("{} {}", number(p.0), number(p.1));
    let mut d = format!("M{}", n(points[0]));
    for (k, w) in points.windows(2).enumerate() {
        if k % 2 == 0 {
            d += &format!(" L{}", n(w[1]));
        } else {
            let m = (w[0].0 + w[1].0) / 2.0;
            d += &format!(" C{} {} {}", n((m, w[0].1)), n((m, w[1].1)), n(w[1]));
        }
    }
    let stroke = |colour: &str, width: f64| {
        Path::new().set("d", d.clone()).set("fill", "none").set("stroke", colour).set("stroke-width", number(width))
    };
    if l.width == 0.0 {
        return group.add(stroke(LINE, 1.0).set("stroke-dasharray", "3 3"));
    }
    let blue = colour(Some(0), 0.8);
    let whole = e.circulating_w >= e.power_w * (1.0 - 1e-6);
    let main = match (whole, l.round[0] > 0.0) {
        (true, true) => colour(Some(1), 0.9),
        (true, false) => colour(Some(4), 1.0),
        _ => blue.clone(),
    };
    group = group.add(stroke(&main, l.width));
    if l.round[1] > 0.0 && !whole {
        group = group.add(stroke(&colour(Some(4), 1.0), l.round[0] + l.round[1]));
    }
    if l.round[0] > 0.0 && !whole {
        group = group.add(stroke(&colour(Some(1), 0.9), l.round[0]));
    }
    let head_colour = match e.circulating_w > 0.5 * e.power_w {
        true if l.round[0] >= l.round[1] => colour(Some(1), 0.9),
        true => colour(Some(4), 1.0),
        false => blue,
    };
    let (tip, base, y) = match l.backwards {
        true => (left, left + long, points[0].1),
        false => (right, right - long, points[last].1),
    };
    group.add(
        Polygon::new()
            .set(
                "points",
                format!(
                    "{},{} {},{} {},{}",
                    number(tip),
                    number(y),
                    number(base),
                    number(y - head),
                    number(base),
                    number(y + head)
                ),
            )
            .set("fill", head_colour),
    )
}

/// The shape of a kind of node.
fn shape(kind: NodeKind, x: f64, y: f64) -> Group {
    let ring = |fill: &str, r: f64| {
        Circle::new()
            .set("cx", number(x))
            .set("cy", number(y))
            .set("r", number(r))
            .set("fill", fill)
            .set("stroke", INK)
            .set("stroke-width", 1.6)
    };
    let polygon = |corners: &[(f64, f64)]| {
        let points: Vec<String> = corners.iter().map(|c| format!("{},{}", number(x + c.0), number(y + c.1))).collect();
        Polygon::new()
            .set("points", points.join(" "))
            .set("fill", PAPER)
            .set("stroke", INK)
            .set("stroke-width", 1.6)
            .set("stroke-linejoin", "round")
    };
    let s = R - 1.5;
    let g = Group::new();
    match kind {
        NodeKind::Member => g.add(ring(INK, R - 1.0)),
        NodeKind::Bearing => g.add(ring(PAPER, R - 1.0)),
        NodeKind::Teeth => g.add(polygon(&[(0.0, -R - 1.0), (R + 1.0, R - 2.0), (-R - 1.0, R - 2.0)])),
        NodeKind::Seal => g.add(polygon(&[(-s, -s), (s, -s), (s, s), (-s, s)])),
        NodeKind::Gear => g.add(polygon(&[(0.0, -R), (R, 0.0), (0.0, R), (-R, 0.0)])),
        NodeKind::Rotor => g.add(polygon(&[(0.0, -R), (R, 0.0), (0.0, R), (-R, 0.0)])).add(ring(INK, 1.4)),
        NodeKind::ShiftElement => g
            .add(rectangle(x - R, y - R, 2.0 * R, 2.0 * R, PAPER))
            .add(line((x - 3.5, y - R - 1.0), (x - 3.5, y + R + 1.0), INK, 3.0))
            .add(line((x + 3.5, y - R - 1.0), (x + 3.5, y + R + 1.0), INK, 3.0)),
        _ => g.add(
            rectangle(x - 7.0, y - R, 14.0, 2.0 * R, &colour(Some(0), 0.25))
                .set("rx", 4)
                .set("stroke", INK)
                .set("stroke-width", 1.2),
        ),
    }
}

/// The mark of the frame, hanging from a symbol.
fn ground(x: f64, y: f64) -> Group {
    let y = y + R - 1.0;
    let mut g = Group::new().add(line((x, y), (x, y + 5.0), INK, 1.2)).add(line(
        (x - 8.0, y + 5.0),
        (x + 8.0, y + 5.0),
        INK,
        1.4,
    ));
    for k in 0..4 {
        let at = x - 6.0 + 4.0 * f64::from(k);
        g = g.add(line((at, y + 5.0), (at - 3.0, y + 9.0), INK, 0.9));
    }
    g
}

fn symbol(n: &Node, x: f64, y: f64, leans: bool, more: f64) -> Group {
    let mut g = Group::new();
    if leans {
        g = g.add(ground(x, y));
    }
    let below = y + R + 12.0 + if leans { (GROUND - 2.0).max(more) } else { more };
    g = g.add(shape(n.kind, x, y));
    let bold = matches!(n.kind, NodeKind::Member | NodeKind::Input | NodeKind::Output);
    let mut title = halo(text(x, y - R - 6.0 - more, SMALL, Anchor::Middle, &name(n)));
    if bold {
        title = title.set("font-weight", "bold");
    }
    g = g.add(title);
    let value = value(n);
    if value.is_empty() { g } else { g.add(halo(text(x, below, SMALL, Anchor::Middle, &value).set("fill", FAINT))) }
}

/// What the symbols mean, in rows; and the height of the page.
fn legend(kinds: &[NodeKind], [round, within, ground_marks, rest]: [bool; 4], top: f64, width: f64) -> (Group, f64) {
    let mut entries: Vec<(Group, &str)> = Vec::new();
    let words = |k: NodeKind| match k {
        NodeKind::Member => "component",
        NodeKind::Teeth => "tooth contact",
        NodeKind::Bearing => "bearing",
        NodeKind::Seal => "seal",
        NodeKind::Gear => "gear in oil or air",
        NodeKind::Rotor => "rotor in oil or air",
        NodeKind::ShiftElement => "clutch or brake",
        NodeKind::Input => "input, output",
        _ => "",
    };
    for &k in kinds.iter().filter(|k| **k != NodeKind::Output) {
        entries.push((shape(k, 11.0, 0.0), words(k)));
    }
    let sample = |colour: String, width: f64| Group::new().add(line((0.0, 0.0), (22.0, 0.0), &colour, width));
    if !kinds.is_empty() {
        entries.push((sample(colour(Some(0), 0.8), 5.0), "power, the wider the more"));
    }
    if round {
        entries.push((sample(colour(Some(1), 0.9), 5.0), "runs in a circle"));
    }
    if within {
        entries.push((sample(colour(Some(4), 1.0), 5.0), "runs in a circle within one set"));
    }
    if rest {
        let dashed = line((0.0, 0.0), (22.0, 0.0), LINE, 1.0).set("stroke-dasharray", "3 3");
        entries.push((Group::new().add(dashed), "torque without power"));
    }
    if ground_marks {
        entries.push((ground(11.0, -11.0), "leans on the frame"));
    }
    if !kinds.is_empty() {
        entries.push((
            Group::new().add(text(11.0, 4.0, 12.0, Anchor::Middle, "−")),
            "loss · outgoing over incoming power",
        ));
    }
    let mut g = Group::new();
    let (mut x, mut y) = (MARGIN, top + 14.0);
    for (mark, words) in entries {
        let room = 30.0 + wide(words, SMALL) + 18.0;
        if x + room > width - MARGIN && x > MARGIN {
            x = MARGIN;
            y += 24.0;
        }
        let at = format!("translate({} {})", number(x), number(y));
        g = g.add(
            Group::new()
                .set("transform", at)
                .add(mark)
                .add(text(30.0, 4.0, SMALL, Anchor::Start, words).set("fill", FAINT)),
        );
        x += room;
    }
    (g, (y + 24.0).ceil())
}
