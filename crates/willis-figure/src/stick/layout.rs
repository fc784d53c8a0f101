//! Order of the blocks, lines of the members, and the best of many tries.

use super::TerminalDirection;
use super::blocks::{Exit, Joint, Plan};
use super::grid::{CLOSED, FREE, GROUND, Goal, Grid, Search};
use super::shapes::{Point, Shape};

/// Orders that are routed, those of them that are improved once, and those that are improved further.
const ROUTED: usize = 20;
const IMPROVED: usize = 6;
const FINAL: usize = 2;
/// Rounds in which every line is laid anew.
const ROUNDS: usize = 4;
/// Blocks whose orders are all looked at.
const ALL_ORDERS: usize = 6;
/// Looks at longer orders.
const SWAPS: usize = 4000;

/// Where a block stands and which of its shapes it has.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stand {
    pub shape: usize,
    pub x: i32,
    pub y: i32,
}

#[derive(Clone)]
pub(super) struct Layout {
    pub grid: Grid,
    pub stands: Vec<Stand>,
    /// Rows of the axes.
    pub axes: Vec<i32>,
    /// Ends of each joint's symbol.
    pub joints: Vec<Option<[Point; 2]>>,
    /// Where each exit is.
    pub exits: Vec<Option<Point>>,
    /// Points that a block reserves.
    fixed: Vec<bool>,
    /// Highest gear row of each axis, and its row of suns.
    tops: Vec<i32>,
    suns: Vec<i32>,
    /// Members whose lines do not hang together.
    broken: Vec<bool>,
    /// What places cost beside lengths: brakes inside, exits on the wrong side.
    price: Vec<u32>,
}

/// Room around the blocks.
#[derive(Clone, Copy)]
struct Room {
    gap: i32,
    inner: i32,
    outer: i32,
}

/// The best layout found; `None` if some line finds no way.
pub(super) fn best(plan: &Plan) -> Option<Layout> {
    let mut search = Search::default();
    let mut room = Room { gap: 3, inner: 3, outer: 4 };
    for _ in 0..4 {
        let mut all: Vec<(u64, Vec<usize>, Vec<usize>, Layout)> = Vec::new();
        let first = vec![0; plan.blocks.len()];
        for order in orders(plan) {
            let l = Layout::new(plan, &order, &first, room, &mut search);
            all.push((l.cost(plan), order, first.clone(), l));
        }
        all.sort_by_key(|a| a.0);
        all.truncate(IMPROVED);
        for (cost, order, shapes, layout) in &mut all {
            // Other arrangements of a block's columns, one block after the other.
            for b in 0..plan.blocks.len() {
                for s in 1..plan.blocks[b].shapes.len() {
                    let mut other = shapes.clone();
                    other[b] = s;
                    let l = Layout::new(plan, order, &other, room, &mut search);
                    if l.cost(plan) < *cost {
                        (*cost, *shapes, *layout) = (l.cost(plan), other, l);
                    }
                }
            }
            layout.improve(plan, 1, &mut search);
            *cost = layout.cost(plan);
        }
        all.sort_by_key(|a| a.0);
        all.truncate(FINAL);
        for (cost, .., layout) in &mut all {
            layout.improve(plan, ROUNDS, &mut search);
            layout.cut_loose(plan);
            layout.improve(plan, 1, &mut search);
            *cost = layout.cost(plan);
        }
        all.sort_by_key(|a| a.0);
        let (.., layout) = all.into_iter().next()?;
        if layout.missing(plan) == 0 {
            return Some(layout);
        }
        room = Room { gap: room.gap + 3, inner: room.inner + 2, outer: room.outer + 3 };
    }
    None
}

/// The most promising orders of the blocks: those in which what belongs together stands together.
fn orders(plan: &Plan) -> Vec<Vec<usize>> {
    let n = plan.blocks.len();
    let on: Vec<Vec<usize>> = (0..plan.nets)
        .map(|net| (0..n).filter(|&b| plan.blocks[b].shapes[0].ports.iter().any(|p| p.0 == net)).collect())
        .collect();
    let cost = |order: &[usize]| {
        let mut at = vec![0i32; n];
        order.iter().enumerate().for_each(|(k, b)| at[*b] = k as i32);
        let range = |blocks: &[usize]| {
            let all = blocks.iter().map(|b| at[*b]);
            Some((all.clone().min()?, all.max()?))
        };
        let spans: Vec<Option<(i32, i32)>> = on.iter().map(|b| range(b)).collect();
        let mut sum = 0;
        for s in spans.iter().flatten() {
            sum += 4 * (s.1 - s.0);
        }
        for j in &plan.joints {
            if let [Some(a), Some(b)] = j.members
                && let (Some(a), Some(b)) = (spans[a], spans[b])
            {
                sum += 2 * (a.0 - b.1).max(b.0 - a.1).max(0);
            }
        }
        for e in &plan.exits {
            // A rotor without a gear is where its clutches lead.
            let reach = |n: usize| spans[n];
            let own = reach(e.net).map(|s| vec![s]).unwrap_or_else(|| {
                let other = |j: &Joint| match j.members {
                    [Some(a), Some(b)] if a == e.net => Some(b),
                    [Some(a), Some(b)] if b == e.net => Some(a),
                    _ => None,
                };
                plan.joints.iter().filter_map(other).filter_map(reach).collect()
            });
            for s in own {
                sum += 2 * match e.way {
                    Some(TerminalDirection::In) => s.0,
                    Some(TerminalDirection::Out) => n as i32 - 1 - s.1,
                    None => s.0.min(n as i32 - 1 - s.1),
                };
            }
        }
        sum
    };
    let mut best: Vec<(i32, Vec<usize>)> = Vec::new();
    let mut keep = |order: &[usize]| {
        let c = cost(order);
        if best.len() == ROUTED && best.last().is_some_and(|b| b.0 <= c) || best.iter().any(|b| b.1 == order) {
            return c;
        }
        let at = best.partition_point(|b| b.0 <= c);
        best.insert(at, (c, order.to_vec()));
        best.truncate(ROUTED);
        c
    };
    let mut order: Vec<usize> = (0..n).collect();
    if n <= ALL_ORDERS {
        loop {
            keep(&order);
            if !next(&mut order) {
                break;
            }
        }
    } else {
        // Swaps as long as they help.
        let mut now = keep(&order);
        let mut looks = 0;
        let mut better = true;
        while better && looks < SWAPS {
            better = false;
            for a in 0..n {
                for b in a + 1..n {
                    order.swap(a, b);
                    looks += 1;
                    let c = keep(&order);
                    if c < now {
                        now = c;
                        better = true;
                    } else {
                        order.swap(a, b);
                    }
                }
            }
        }
    }
    best.into_iter().map(|b| b.1).collect()
}

/// The next permutation in the order of the dictionary.
fn next(order: &mut [usize]) -> bool {
    let Some(k) = (1..order.len()).rev().find(|&k| order[k - 1] < order[k]) else { return false };
    let swap = (k..order.len()).rev().find(|&j| order[j] > order[k - 1]).expect("the one at k");
    order.swap(k - 1, swap);
    order[k..].reverse();
    true
}

impl Layout {
    fn new(plan: &Plan, order: &[usize], shapes: &[usize], room: Room, search: &mut Search) -> Self {
        let shape = |b: usize| &plan.blocks[b].shapes[shapes[b]];
        let mut stands = vec![Stand { shape: 0, x: 0, y: 0 }; plan.blocks.len()];
        let mut x = room.gap;
        for &b in order {
            stands[b] = Stand { shape: shapes[b], x, y: 0 };
            x += shape(b).width + room.gap;
        }
        let width = (x + 1).max(8);
        let (mut axes, mut suns, mut tops) = (vec![], vec![], vec![]);
        let mut y = 0;
        for axis in 0..plan.axes {
            let own = || (0..plan.blocks.len()).filter(|&b| plan.blocks[b].axis == axis);
            if own().any(|b| plan.blocks[b].pair) {
                y += 5;
            }
            axes.push(y);
            suns.push(y + room.inner);
            let sets = own().filter(|&b| !plan.blocks[b].pair).map(|b| shape(b).top).max();
            let top = match sets {
                Some(top) => y + room.inner + top,
                None => y + own().map(|b| shape(b).top).max().unwrap_or(0).max(0),
            };
            tops.push(top);
            y = top + room.outer + 1;
        }
        for (b, stand) in stands.iter_mut().enumerate() {
            let block = &plan.blocks[b];
            stand.y = if block.pair { axes[block.axis] } else { suns[block.axis] };
        }
        let grid = Grid::new(width, y);
        let count = grid.point.len();
        let mut l = Self {
            grid,
            stands,
            axes,
            joints: vec![None; plan.joints.len()],
            exits: vec![None; plan.exits.len()],
            fixed: vec![false; count],
            tops,
            suns,
            broken: vec![false; plan.nets],
            price: vec![0; plan.joints.len() + plan.exits.len()],
        };
        for b in 0..plan.blocks.len() {
            l.place(shape(b), l.stands[b]);
        }
        for net in l.short_first(plan) {
            l.lay(plan, net, search);
        }
        for j in 0..plan.joints.len() {
            l.join(plan, j, search);
        }
        l
    }

    fn place(&mut self, shape: &Shape, stand: Stand) {
        let to = |p: &Point| (p.0 + stand.x, p.1 + stand.y);
        for p in &shape.blocked {
            let k = self.grid.at(to(p));
            self.grid.point[k] = CLOSED;
        }
        for (net, p) in &shape.ports {
            let k = self.grid.at(to(p));
            self.grid.point[k] = *net as u16;
            self.fixed[k] = true;
        }
        for [a, b] in &shape.closed {
            self.grid.set(to(a), to(b), CLOSED, true);
        }
        for (net, [a, b]) in &shape.wires {
            self.grid.set(to(a), to(b), net.map_or(GROUND, |n| n as u16), true);
        }
    }

    /// Members in the order of the distance that their lines span.
    fn short_first(&self, plan: &Plan) -> Vec<usize> {
        let span = |net: usize| {
            let all = || self.ports(plan, net).map(|p| p.0);
            all().max().unwrap_or(0) - all().min().unwrap_or(0)
        };
        let mut nets: Vec<usize> = (0..plan.nets).collect();
        nets.sort_by_key(|n| span(*n));
        nets
    }

    fn ports<'a>(&'a self, plan: &'a Plan, net: usize) -> impl Iterator<Item = Point> + 'a {
        plan.blocks.iter().zip(&self.stands).flat_map(move |(b, s)| {
            let ports = b.shapes[s.shape].ports.iter().filter(move |p| p.0 == net);
            ports.map(|(_, p)| (p.0 + s.x, p.1 + s.y))
        })
    }

    /// Points that the lines of a member must reach.
    fn wanted(&self, plan: &Plan, net: usize) -> Vec<Point> {
        let mut all: Vec<Point> = self.ports(plan, net).collect();
        for (j, ends) in plan.joints.iter().zip(&self.joints) {
            if let Some(ends) = ends {
                all.extend((0..2).filter(|&k| j.members[k] == Some(net)).map(|k| ends[k]));
            }
        }
        let own = plan.exits.iter().zip(&self.exits).filter(|(e, _)| e.net == net);
        all.extend(own.filter_map(|(_, at)| *at));
        all
    }

    /// Lays the lines of a member: its pieces together, then out to the border.
    fn lay(&mut self, plan: &Plan, net: usize, search: &mut Search) {
        let owner = net as u16;
        self.broken[net] = false;
        let exit = plan.exits.iter().position(|e| e.net == net);
        let mut wanted = self.wanted(plan, net);
        if wanted.is_empty() {
            let Some(k) = exit else { return };
            let Some(p) = self.free_border(plan, &plan.exits[k]) else { return };
            let at = self.grid.at(p);
            self.grid.point[at] = owner;
            self.exits[k] = Some(p);
            return;
        }
        let start = wanted.remove(0);
        while !self.grid.joined(owner, start, &wanted, search) {
            let Some(path) = self.grid.route(owner, start, &Goal::Own, search) else {
                self.broken[net] = true;
                break;
            };
            for w in path.points.windows(2) {
                self.grid.set(w[0], w[1], owner, false);
            }
        }
        if let Some(k) = exit.filter(|k| self.exits[*k].is_none() && plan.exits[*k].open) {
            let e = &plan.exits[k];
            let axis = self.axes[plan.axis_of[net]];
            let right = self.grid.width - 1;
            let price = |p: Point| {
                let wrong = match (p.0, e.way) {
                    (0, Some(TerminalDirection::Out)) => 50,
                    (0, _) => 0,
                    (x, Some(TerminalDirection::In)) if x == right => 50,
                    (x, _) if x == right => 0,
                    _ => return None,
                };
                Some(wrong + 4 * p.1.abs_diff(axis))
            };
            if let Some(path) = self.grid.route(owner, start, &Goal::Border(&price), search) {
                for w in path.points.windows(2) {
                    self.grid.set(w[0], w[1], owner, false);
                }
                let p = *path.points.last().expect("a path has points");
                let at = self.grid.at(p);
                self.grid.point[at] = owner;
                self.exits[k] = Some(p);
                self.price[plan.joints.len() + k] = price(p).unwrap_or(0);
            }
        }
    }

    fn free_border(&self, plan: &Plan, e: &Exit) -> Option<Point> {
        let axis = self.axes[plan.axis_of[e.net]];
        let x = if e.way == Some(TerminalDirection::In) { 0 } else { self.grid.width - 1 };
        let mut rows: Vec<i32> = (0..self.grid.height).collect();
        rows.sort_by_key(|y| (y - axis).abs());
        let both = [x, self.grid.width - 1 - x];
        both.into_iter().flat_map(|x| rows.iter().map(move |y| (x, *y))).find(|p| {
            let way = if p.0 == 0 { 0 } else { 2 };
            self.grid.point[self.grid.at(*p)] == FREE && self.grid.step(*p, way) == FREE
        })
    }

    /// Finds a place for a joint, and the lines to it.
    fn join(&mut self, plan: &Plan, j: usize, search: &mut Search) {
        let joint = &plan.joints[j];
        let Some(a) = joint.members[0] else { return };
        let Some(start) = self.wanted(plan, a).first().copied() else { return };
        let axis = plan.axis_of[a];
        let enclosed = if joint.members[1].is_none() { self.enclosed() } else { vec![] };
        let frame = |p: Point, way: usize| self.frame_price(axis, p, way) + 30 * enclosed[self.grid.at(p)];
        let goal = match joint.members[1] {
            Some(b) => Goal::Net(b as u16),
            None => Goal::Frame(&frame),
        };
        let found = self.grid.route(a as u16, start, &goal, search);
        let Some((path, symbol)) = found.and_then(|p| p.symbol.map(|k| (p.points, k))) else {
            return;
        };
        // A symbol in the middle of a long straight way looks better than one at its end.
        let symbol = self.middle(&path, symbol, joint);
        for (k, w) in path.windows(2).enumerate() {
            let owner = match k.cmp(&symbol) {
                std::cmp::Ordering::Less => a as u16,
                std::cmp::Ordering::Equal => CLOSED,
                std::cmp::Ordering::Greater => joint.members[1].map_or(GROUND, |b| b as u16),
            };
            self.grid.set(w[0], w[1], owner, owner == CLOSED);
        }
        let ends = [path[symbol], path[symbol + 1]];
        for (k, p) in ends.into_iter().enumerate() {
            let at = self.grid.at(p);
            if self.grid.point[at] == FREE {
                self.grid.point[at] = joint.members[k].map_or(GROUND, |n| n as u16);
            }
        }
        self.joints[j] = Some(ends);
        if joint.members[1].is_none() {
            let way = super::grid::WAYS
                .iter()
                .position(|d| (ends[0].0 + d.0, ends[0].1 + d.1) == ends[1])
                .expect("a step of the grid");
            self.price[j] = self.frame_price(axis, ends[1], way) + 30 * enclosed[self.grid.at(ends[1])];
        }
    }

    /// What it costs to fix a brake of a member on that axis here: best outside, above the gears.
    fn frame_price(&self, axis: usize, p: Point, way: usize) -> u32 {
        let (top, sun, right) = (self.tops[axis], self.suns[axis], self.grid.width - 1);
        let turned = [5, 0, 5, 12][way];
        let inside = if p.1 <= sun { 8 } else { (top + 1 - p.1).max(0) as u32 };
        let beyond = 2 * (p.1 - top - 2).max(0) as u32;
        let border = if p.0 == 0 || p.0 == right { 1000 } else { 0 };
        turned + inside + beyond + border
    }

    /// Lines between each place and the housing: left, right or above, on the straight way with the fewest.
    fn enclosed(&self) -> Vec<u32> {
        let g = &self.grid;
        let taken = |p: Point, ways: [usize; 2]| {
            let line = |w: usize| !matches!(g.step(p, w), FREE | CLOSED);
            u32::from(ways.into_iter().any(line) || g.point[g.at(p)] != FREE)
        };
        let mut least = vec![u32::MAX; g.point.len()];
        let mut ray = |points: &mut dyn Iterator<Item = Point>, across: [usize; 2]| {
            let mut lines = 0;
            for p in points {
                let at = &mut least[g.at(p)];
                *at = (*at).min(lines);
                lines += taken(p, across);
            }
        };
        for y in 0..g.height {
            ray(&mut (0..g.width).map(|x| (x, y)), [1, 3]);
            ray(&mut (0..g.width).rev().map(|x| (x, y)), [1, 3]);
        }
        for x in 0..g.width {
            ray(&mut (0..g.height).rev().map(|y| (x, y)), [0, 2]);
        }
        least
    }

    /// The step of a path nearest its middle that touches no other line.
    fn middle(&self, path: &[Point], symbol: usize, joint: &Joint) -> usize {
        if joint.members[1].is_none() {
            return symbol;
        }
        let clear = |p: Point| (0..4).all(|w| self.grid.step(p, w) == FREE);
        let last = path.len() - 1;
        let good = |k: &usize| {
            let ends = [(*k, *k == 0), (*k + 1, *k + 1 == last)];
            let border = |p: Point| p.0 == 0 || p.0 == self.grid.width - 1;
            ends.into_iter().all(|(i, end)| (end || clear(path[i])) && !border(path[i]))
        };
        let middle = |k: &usize| (2 * k + 1).abs_diff(last);
        (0..last).filter(good).min_by_key(middle).unwrap_or(symbol)
    }

    /// Takes a joint away, and the lines that led to it.
    fn part(&mut self, plan: &Plan, j: usize) {
        let Some(ends) = self.joints[j].take() else { return };
        self.grid.set(ends[0], ends[1], FREE, false);
        self.price[j] = 0;
        for (k, p) in ends.into_iter().enumerate() {
            let others = plan.joints.iter().zip(&self.joints).any(|(o, e)| {
                e.is_some_and(|e| (0..2).any(|i| e[i] == p && o.members[i] == plan.joints[j].members[k]))
            });
            let at = self.grid.at(p);
            let exit = self.exits.contains(&Some(p));
            if !others && !self.fixed[at] && !exit {
                self.grid.point[at] = FREE;
            }
        }
        for net in plan.joints[j].members.into_iter().flatten() {
            self.grid.prune(net as u16);
        }
    }

    /// Lays every member and every joint anew, as long as it helps.
    fn improve(&mut self, plan: &Plan, rounds: usize, search: &mut Search) {
        for _ in 0..rounds {
            let before = self.cost(plan);
            for net in 0..plan.nets {
                let own: Vec<usize> =
                    (0..plan.joints.len()).filter(|&j| plan.joints[j].members.contains(&Some(net))).collect();
                self.attempt(plan, |l| {
                    own.iter().for_each(|&j| l.part(plan, j));
                    l.grid.rip(net as u16);
                    for (k, e) in plan.exits.iter().enumerate() {
                        if e.net == net
                            && let Some(p) = l.exits[k].take()
                        {
                            let at = l.grid.at(p);
                            l.grid.point[at] = FREE;
                        }
                    }
                    l.lay(plan, net, search);
                    own.iter().for_each(|&j| l.join(plan, j, search));
                });
                // The lines alone, with the joints where they are.
                self.attempt(plan, |l| {
                    l.grid.rip(net as u16);
                    l.lay(plan, net, search);
                });
            }
            for j in 0..plan.joints.len() {
                self.attempt(plan, |l| {
                    l.part(plan, j);
                    l.join(plan, j, search);
                });
            }
            if self.cost(plan) >= before {
                return;
            }
        }
    }

    /// A rotor between clutches ends where they are, not at the border where it was begun.
    fn cut_loose(&mut self, plan: &Plan) {
        for (k, e) in plan.exits.iter().enumerate().filter(|(_, e)| !e.open) {
            let joints = plan.joints.iter().zip(&self.joints);
            let joined = joints.filter(|(j, at)| j.members.contains(&Some(e.net)) && at.is_some()).count();
            if joined > 1
                && let Some(p) = self.exits[k].take()
            {
                let at = self.grid.at(p);
                self.grid.point[at] = FREE;
                self.grid.prune(e.net as u16);
            }
        }
    }

    fn attempt(&mut self, plan: &Plan, change: impl FnOnce(&mut Self)) {
        let before = self.clone();
        change(self);
        if self.cost(plan) >= before.cost(plan) {
            *self = before;
        }
    }

    /// What has found no way.
    fn missing(&self, plan: &Plan) -> usize {
        self.joints.iter().filter(|j| j.is_none()).count()
            + plan.exits.iter().zip(&self.exits).filter(|(e, at)| e.open && at.is_none()).count()
            + self.broken.iter().filter(|b| **b).count()
    }

    /// Crossings cost most, then length and bends.
    fn cost(&self, plan: &Plan) -> u64 {
        let (crossings, steps, bends) = self.grid.measure();
        let extra: u32 = self.price.iter().sum();
        self.missing(plan) as u64 * 100_000
            + u64::from(crossings) * 200
            + u64::from(steps) * 2
            + u64::from(bends) * 3
            + u64::from(extra)
    }
}
