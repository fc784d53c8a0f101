//! Lines on a grid: which member owns each step, and the cheapest way for another line.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::shapes::Point;

pub(super) const FREE: u16 = u16::MAX;
pub(super) const CLOSED: u16 = u16::MAX - 1;
pub(super) const GROUND: u16 = u16::MAX - 2;

const STEP: u32 = 2;
const BEND: u32 = 3;
const BRANCH: u32 = 1;
const CROSSING: u32 = 120;

/// East, north, west, south.
pub(super) const WAYS: [Point; 4] = [(1, 0), (0, 1), (-1, 0), (0, -1)];

/// Where a search ends.
pub(super) enum Goal<'a> {
    /// Another piece of the same member.
    Own,
    /// Any point of the other member, past the symbol of a joint.
    Net(u16),
    /// The frame, past the symbol of a joint; the cost of each place.
    Frame(&'a dyn Fn(Point, usize) -> u32),
    /// The border; the cost of each place.
    Border(&'a dyn Fn(Point) -> Option<u32>),
}

/// A way that was found.
pub(super) struct Path {
    pub points: Vec<Point>,
    /// Of a joint: the step (between points k and k + 1) that its symbol takes.
    pub symbol: Option<usize>,
}

#[derive(Clone)]
pub(super) struct Grid {
    pub width: i32,
    pub height: i32,
    /// Owner of the point itself: a port, a joint's end, or closed.
    pub point: Vec<u16>,
    /// Owners of the steps east and north of each point.
    pub east: Vec<u16>,
    pub north: Vec<u16>,
    /// Steps that are part of a block and stay.
    pub fixed_east: Vec<bool>,
    pub fixed_north: Vec<bool>,
}

/// Room for a search, used again and again.
#[derive(Default)]
pub(super) struct Search {
    cost: Vec<u32>,
    from: Vec<u32>,
    heap: BinaryHeap<Reverse<(u32, u32)>>,
    tree: Vec<bool>,
    stack: Vec<usize>,
}

impl Grid {
    pub fn new(width: i32, height: i32) -> Self {
        let n = (width * height) as usize;
        Self {
            width,
            height,
            point: vec![FREE; n],
            east: vec![FREE; n],
            north: vec![FREE; n],
            fixed_east: vec![false; n],
            fixed_north: vec![false; n],
        }
    }

    pub fn at(&self, p: Point) -> usize {
        (p.1 * self.width + p.0) as usize
    }

    pub fn place(&self, k: usize) -> Point {
        (k as i32 % self.width, k as i32 / self.width)
    }

    fn inside(&self, p: Point) -> bool {
        (0..self.width).contains(&p.0) && (0..self.height).contains(&p.1)
    }

    /// The step from a point in a way; closed at the border.
    pub fn step(&self, p: Point, way: usize) -> u16 {
        let q = (p.0 + WAYS[way].0, p.1 + WAYS[way].1);
        if !self.inside(q) {
            return CLOSED;
        }
        match way {
            0 => self.east[self.at(p)],
            1 => self.north[self.at(p)],
            2 => self.east[self.at(q)],
            _ => self.north[self.at(q)],
        }
    }

    fn step_fixed(&self, p: Point, way: usize) -> bool {
        let q = (p.0 + WAYS[way].0, p.1 + WAYS[way].1);
        self.inside(q)
            && match way {
                0 => self.fixed_east[self.at(p)],
                1 => self.fixed_north[self.at(p)],
                2 => self.fixed_east[self.at(q)],
                _ => self.fixed_north[self.at(q)],
            }
    }

    pub fn set(&mut self, a: Point, b: Point, owner: u16, fixed: bool) {
        let low = self.at((a.0.min(b.0), a.1.min(b.1)));
        if a.1 == b.1 {
            self.east[low] = owner;
            self.fixed_east[low] = fixed;
        } else {
            self.north[low] = owner;
            self.fixed_north[low] = fixed;
        }
    }

    /// Whether a point belongs to a member.
    pub fn owns(&self, p: Point, net: u16) -> bool {
        self.point[self.at(p)] == net || (0..4).any(|w| self.step(p, w) == net)
    }

    /// How a line may use a point: freely, straight across another one, or not at all.
    fn entry(&self, p: Point, way: usize, net: u16) -> Option<bool> {
        let owner = self.point[self.at(p)];
        if owner == net {
            return Some(false);
        }
        if owner != FREE {
            return None;
        }
        let foreign = |w: usize| Some(self.step(p, w)).filter(|s| *s != FREE && *s != net && self.inside_way(p, w));
        let ahead = foreign(way);
        let [left, right] = [foreign((way + 1) % 4), foreign((way + 3) % 4)];
        match (left, right) {
            (None, None) if ahead.is_none() => Some(false),
            (Some(a), Some(b)) if a == b && a < GROUND && ahead.is_none() => {
                let fixed = self.step_fixed(p, (way + 1) % 4) || self.step_fixed(p, (way + 3) % 4);
                let passable = !fixed && self.step(p, way) == FREE;
                passable.then_some(true)
            }
            _ => None,
        }
    }

    fn inside_way(&self, p: Point, way: usize) -> bool {
        self.inside((p.0 + WAYS[way].0, p.1 + WAYS[way].1))
    }

    /// Points of the piece of a member that holds a point.
    fn flood(&self, net: u16, start: Point, search: &mut Search) {
        search.tree.clear();
        search.tree.resize(self.point.len(), false);
        search.stack.clear();
        search.stack.push(self.at(start));
        search.tree[self.at(start)] = true;
        while let Some(k) = search.stack.pop() {
            let p = self.place(k);
            for (w, d) in WAYS.iter().enumerate() {
                if self.step(p, w) == net {
                    let q = self.at((p.0 + d.0, p.1 + d.1));
                    if !std::mem::replace(&mut search.tree[q], true) {
                        search.stack.push(q);
                    }
                }
            }
        }
    }

    /// Whether the lines of a member join all these points.
    pub fn joined(&self, net: u16, start: Point, all: &[Point], search: &mut Search) -> bool {
        self.flood(net, start, search);
        all.iter().all(|p| search.tree[self.at(*p)])
    }

    /// The cheapest way from the piece of a member at `start`.
    pub fn route(&self, net: u16, start: Point, goal: &Goal<'_>, search: &mut Search) -> Option<Path> {
        self.flood(net, start, search);
        // A state is a point, the way by which it was reached, and whether the joint lies behind.
        let states = self.point.len() * 8;
        search.cost.clear();
        search.cost.resize(states + 1, u32::MAX);
        search.from.clear();
        search.from.resize(states + 1, u32::MAX);
        search.heap.clear();
        for k in (0..self.point.len()).filter(|&k| search.tree[k] && self.point[k] != CLOSED) {
            let p = self.place(k);
            let branch = if (0..4).any(|w| self.step(p, w) == net) { BRANCH } else { 0 };
            for way in (0..4).filter(|&w| self.step(p, w) == FREE) {
                // On in the way of a line there is no branch.
                let cost = if self.step(p, (way + 2) % 4) == net { 0 } else { branch };
                let state = k * 4 + way;
                search.cost[state] = cost;
                search.heap.push(Reverse((cost, state as u32)));
            }
        }
        while let Some(Reverse((cost, state))) = search.heap.pop() {
            if cost > search.cost[state as usize] {
                continue;
            }
            if state as usize == states {
                return self.trace(search, matches!(goal, Goal::Net(_) | Goal::Frame(_)));
            }
            self.expand(net, goal, search, state, cost);
        }
        None
    }

    /// Goes one step on from a state.
    fn expand(&self, net: u16, goal: &Goal<'_>, search: &mut Search, state: u32, cost: u32) {
        let n = self.point.len();
        let end = (n * 8) as u32;
        let behind = state as usize >= n * 4;
        let (k, came) = (state as usize % (n * 4) / 4, state as usize % 4);
        let p = self.place(k);
        let owner = match goal {
            Goal::Net(b) if behind => *b,
            Goal::Frame(_) if behind => return,
            _ => net,
        };
        let root = search.from[state as usize] == u32::MAX;
        // Straight across another line there is no bend, no branch and no end.
        let side = self.step(p, (came + 1) % 4);
        let crossing = !root && side < GROUND && side != owner;
        // At the border only ends of members.
        let border = p.0 == 0 || p.0 == self.width - 1;
        if let (Goal::Border(price), false) = (goal, crossing)
            && let Some(extra) = price(p)
        {
            relax(search, state, end, cost + extra);
        }
        for way in 0..4 {
            let straight = way == came;
            let back = way == (came + 2) % 4;
            if self.step(p, way) != FREE || back || !straight && (root || crossing) || border && way % 2 == 1 {
                continue;
            }
            let q = (p.0 + WAYS[way].0, p.1 + WAYS[way].1);
            let to = self.at(q);
            let go = cost + STEP + if straight { 0 } else { BEND };
            let here = (usize::from(behind) * n * 4 + to * 4 + way) as u32;
            let beyond = (n * 4 + to * 4 + way) as u32;
            let found = match goal {
                Goal::Own => !search.tree[to] && self.point[to] != CLOSED && self.owns(q, net),
                Goal::Net(b) => behind && self.owns(q, *b) && self.entry(q, way, *b) == Some(false),
                Goal::Frame(_) | Goal::Border(_) => false,
            };
            if found {
                relax(search, state, here, go);
                relax(search, here, end, go);
                continue;
            }
            let other = behind && self.owns(q, owner);
            if let Some(crosses) = self.entry(q, way, owner)
                && !other
                && (behind || !search.tree[to])
            {
                relax(search, state, here, go + if crosses { CROSSING } else { 0 });
            }
            // The symbol of a joint on this step; at the border it would bar the only way from there.
            if behind || crossing || border || q.0 == 0 || q.0 == self.width - 1 {
                continue;
            }
            match goal {
                Goal::Net(b) if self.entry(q, way, *b) == Some(false) => {
                    relax(search, state, beyond, go);
                    if self.owns(q, *b) {
                        relax(search, beyond, end, go);
                    }
                }
                Goal::Frame(price) if self.empty(q) => {
                    relax(search, state, beyond, go);
                    relax(search, beyond, end, go + price(q, way));
                }
                _ => {}
            }
        }
    }

    /// Nothing is or leads here.
    fn empty(&self, p: Point) -> bool {
        let free = |w: usize| self.step(p, w) == FREE || !self.inside_way(p, w);
        self.point[self.at(p)] == FREE && (0..4).all(free)
    }

    fn trace(&self, search: &Search, joint: bool) -> Option<Path> {
        let n = self.point.len();
        let mut states = Vec::new();
        let mut at = search.from[n * 8];
        while at != u32::MAX {
            states.push(at as usize);
            at = search.from[at as usize];
        }
        states.reverse();
        let symbol = joint.then(|| states.iter().position(|s| *s >= n * 4).map_or(0, |k| k - 1));
        let points: Vec<Point> = states.iter().map(|s| self.place((s % (n * 4)) / 4)).collect();
        // Before and behind its symbol a joint belongs to two members: it may not meet itself.
        let twice = (0..points.len()).any(|k| points[..k].contains(&points[k]));
        (!twice).then_some(Path { points, symbol })
    }

    /// Numbers of crossings, steps and bends.
    pub fn measure(&self) -> (u32, u32, u32) {
        let (mut crossings, mut steps, mut bends) = (0, 0, 0);
        for k in 0..self.point.len() {
            let p = self.place(k);
            let real = |s: u16| s < GROUND;
            steps += u32::from(real(self.east[k])) + u32::from(real(self.north[k]));
            let s: [u16; 4] = std::array::from_fn(|w| self.step(p, w));
            if real(s[0]) && s[0] == s[2] && real(s[1]) && s[1] == s[3] && s[0] != s[1] {
                crossings += 1;
            }
            for w in 0..4 {
                let (a, b) = (s[w], s[(w + 1) % 4]);
                if real(a) && a == b && s[(w + 2) % 4] != a && s[(w + 3) % 4] != a {
                    bends += 1;
                }
            }
        }
        (crossings, steps, bends)
    }

    /// Takes away the lines of a member that are not part of a block.
    pub fn rip(&mut self, net: u16) {
        for k in 0..self.point.len() {
            if self.east[k] == net && !self.fixed_east[k] {
                self.east[k] = FREE;
            }
            if self.north[k] == net && !self.fixed_north[k] {
                self.north[k] = FREE;
            }
        }
    }

    /// Takes away the loose ends of a member's lines.
    pub fn prune(&mut self, net: u16) {
        loop {
            let mut changed = false;
            for k in 0..self.point.len() {
                let p = self.place(k);
                if self.point[k] == net {
                    continue;
                }
                let own: Vec<usize> = (0..4).filter(|w| self.step(p, *w) == net).collect();
                if let [way] = own[..]
                    && !self.step_fixed(p, way)
                {
                    let q = (p.0 + WAYS[way].0, p.1 + WAYS[way].1);
                    self.set(p, q, FREE, false);
                    changed = true;
                }
            }
            if !changed {
                return;
            }
        }
    }
}

fn relax(search: &mut Search, from: u32, to: u32, cost: u32) {
    if cost < search.cost[to as usize] {
        search.cost[to as usize] = cost;
        search.from[to as usize] = from;
        search.heap.push(Reverse((cost, to)));
    }
}
