//! Where the symbols, lines and labels of a power flow stand.

use std::collections::HashMap;

use rust_sugiyama::configure::Config;
use rust_sugiyama::from_vertices_and_edges;
use svg::node::element::Group;
use willis::hypergraph::{Hypergraph, Loop, Node, NodeKind};

use super::marks::{Line, draw, symbol};
use super::words::{GROUND, R, ROW, SMALL, name, values};
use crate::parts::style::{Anchor, BOLD, PAPER, halo, text, watts, wide};

/// Width of the line of the largest power.
const WIDEST: f64 = 11.0;
/// Least gap between columns.
const GAP: f64 = 60.0;
/// Height of a label.
const TALL: f64 = 14.5;

/// A place where a line passes a column: a node, or the empty space between nodes.
pub struct Place {
    /// The node, or none.
    node: Option<usize>,
    column: usize,
    y: f64,
    /// From its middle to its upper and lower bound.
    half: f64,
}

pub struct Drawing {
    pub group: Group,
    pub width: f64,
    pub height: f64,
    pub kinds: Vec<NodeKind>,
    pub round: bool,
    pub within: bool,
    pub ground: bool,
    pub rest: bool,
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

    fn grown(&self, by: f64) -> Self {
        Self { y: [self.y[0] - by, self.y[1] + by], ..*self }
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
    pub fn new(g: &Hypergraph, panel: &str) -> Self {
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
        let sizes: Vec<f64> = (0..shown.len())
            .map(|k| {
                let rows = values(shown[k]).len().saturating_sub(1) as f64;
                R + 17.0 + more[k] + if leans[k] { GROUND } else { 0.0 } + ROW * rows
            })
            .collect();
        let (mut all, routes) = places(&sizes, &pairs);

        let mut lines: Vec<Line> = Vec::new();
        for ((&edge, route), &(left, _)) in edges.iter().zip(&routes).zip(&pairs) {
            let e = &g.edges[edge];
            let passes = |l: &&Loop| {
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
                let rows = values(shown[k]);
                let texts = rows.iter().fold(wide(&name(shown[k]), SMALL) * BOLD, |a, t| a.max(wide(t, SMALL))) / 2.0;
                half[p.column] = half[p.column].max(texts + 4.0).max(R + 14.0);
            }
        }
        let mut gaps = vec![GAP; columns];
        for l in &lines {
            let words = wide(&watts(g.edges[l.edge].power_w), SMALL) + 8.0;
            for w in l.places.windows(2) {
                let column = all[w[0]].column;
                gaps[column] = gaps[column].max(words);
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
            // A node has more below than above.
            let above = p.node.map_or(p.half, |k| R + 17.0 + more[k]);
            (top, bottom) = (top.min(p.y - above), bottom.max(p.y + p.half));
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
            group = group.add(draw(l, g, panel));
        }
        for p in all.iter() {
            if let Some(k) = p.node {
                group = group.add(symbol(shown[k], (middle[p.column], p.y), leans[k], more[k], panel));
            }
        }
        for (b, words) in &labels {
            let (x, y) = ((b.x[0] + b.x[1]) / 2.0, (b.y[0] + b.y[1]) / 2.0 + shift + 0.36 * SMALL);
            group = group.add(halo(text(x, y, SMALL, Anchor::Middle, words).set("class", "power"), PAPER, 3.0));
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
        let mut others: Vec<((f64, f64), f64)> = Vec::new();
        for (_, o) in lines.iter().enumerate().filter(|(j, o)| *j != k && o.width > 0.0) {
            for (n, w) in o.points.windows(2).enumerate() {
                if n % 2 == 1 && (w[0].0 - a.0).abs() < 1.0 {
                    others.extend((0..=24).map(|i| (bend(w[0], w[1], f64::from(i) / 24.0), o.width / 2.0)));
                }
            }
        }
        for t in [0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8] {
            let (x, y) = bend(a, b, t);
            let x = x.clamp(bounds[0] + width / 2.0, (bounds[1] - width / 2.0).max(bounds[0] + width / 2.0));
            let beside = own.width / 2.0 + TALL / 2.0 + 0.5;
            for step in 0..24 {
                let far = 7.0 * f64::from(step / 2);
                let dy = if step % 2 == 0 { -beside - far } else { beside + far };
                let place = Area::around(x, y + dy, width, TALL);
                if labels.iter().any(|(o, _)| o.meets(&place)) {
                    continue;
                }
                let crossed = others.iter().filter(|(p, half)| place.grown(*half).holds(*p)).count();
                let own_area = place.grown(own.width / 2.0);
                let through = (0..=24).filter(|i| own_area.holds(bend(a, b, f64::from(*i) / 24.0))).count();
                // A label beyond another line would seem to be that line's.
                let [low, high] = [y.min(y + dy), y.max(y + dy)];
                let beyond = |p: (f64, f64)| place.x[0] <= p.0 && p.0 <= place.x[1] && low < p.1 && p.1 < high;
                let behind = others.iter().filter(|(p, _)| beyond(*p)).count();
                let cost = far
                    + 3.0 * crossed as f64
                    + 2.0 * behind as f64
                    + 2.5 * through as f64
                    + 8.0 * (t - 0.5).abs()
                    + gap as f64;
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
            Area::around(x.max(width / 2.0), low + SMALL, width, TALL)
        }
    }
}
