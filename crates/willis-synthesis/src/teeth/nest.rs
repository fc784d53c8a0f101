//! Coupled sets: nested loops over distinct basic ratios, each a window that some target closes.
//!
//! Every ratio of a train is a quotient of forms that are linear in each basic ratio. So, with the other basic ratios
//! chosen, it is monotone between its poles, and a window of the ratio is at most two intervals of the next basic ratio.
//! The order of the loops is the one in which the targets close the windows soonest. Where no target is complete, the
//! range is halved again and again, and halves are left out in which some ratio cannot come into its window: the extremes
//! of such a quotient over a box are at its corners.
//!
//! Windows are found in floating point; whatever is within 10⁻⁹ of an end is decided by rational numbers.

use std::sync::Arc;

use willis::exact::Rational;
use willis::work::Work;

use super::form::{Form, Quotient};
use super::space::{Group, SetSpace};

/// What the ratio of a state must be: in one of some closed windows.
#[derive(Clone, Debug)]
pub(crate) struct Target {
    pub quotient: Quotient,
    pub windows: Vec<[Rational; 2]>,
}

/// A set of a coupled train: its space, and its basic ratios in order.
#[derive(Clone)]
pub(crate) struct Unit<'s> {
    pub space: &'s SetSpace,
    pub groups: Arc<Vec<Group>>,
    pub every_stage: bool,
}

impl<'s> Unit<'s> {
    pub fn new(space: &'s SetSpace, every_stage: bool) -> Self {
        Self { space, groups: Arc::new(space.groups(every_stage)), every_stage }
    }
}

/// A loop: the unit, and whether it runs over its first or its second variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Level {
    unit: usize,
    second: bool,
}

/// A target in the order of the loops.
struct Window {
    quotient: Quotient,
    floats: [Vec<f64>; 2],
    /// Ends of the windows.
    ends: Vec<[f64; 2]>,
    exact: Vec<[Rational; 2]>,
    /// The last loop that it depends on; none where it is the same for all teeth.
    last: Option<usize>,
}

/// Nested loops, planned.
pub(crate) struct Nest<'u, 's> {
    units: &'u [Unit<'s>],
    levels: Vec<Level>,
    targets: Vec<Window>,
    /// Bounds of the variable of each loop.
    bounds: Vec<[f64; 2]>,
}

/// What is done with groups that satisfy all targets: those of the outer loops, and neighbouring ones of the last.
pub(crate) trait Sink {
    fn found(&mut self, chosen: &Chosen<'_, '_>, last: &[Group]);
}

/// The groups of the outer loops.
pub(crate) struct Chosen<'a, 'g> {
    levels: &'a [Level],
    groups: &'a [&'g Group],
}

impl<'g> Chosen<'_, 'g> {
    /// The unit of the innermost loop.
    pub fn innermost(&self) -> usize {
        self.levels.last().map_or(0, |l| l.unit)
    }

    /// For each unit the group that has its items, when the last loop is at `last`.
    pub fn units<'l>(&self, last: &'l Group, units: usize) -> Vec<&'l Group>
    where
        'g: 'l,
    {
        let mut found: Vec<&'l Group> = vec![last; units];
        for (level, group) in self.levels.iter().zip(self.groups.iter().copied().chain([last])) {
            // Of two loops of a unit the inner one comes later.
            found[level.unit] = group;
        }
        found
    }
}

/// Relative distance within which floating point does not decide.
const NEAR: f64 = 1e-9;

impl<'u, 's> Nest<'u, 's> {
    /// Plans the loops.
    pub fn new(units: &'u [Unit<'s>], targets: &[Target]) -> Self {
        let mut all = vec![];
        for (unit, u) in units.iter().enumerate() {
            all.push(Level { unit, second: false });
            if u.space.kind.variables() == 2 {
                all.push(Level { unit, second: true });
            }
        }
        let depends: Vec<Vec<bool>> =
            targets.iter().map(|t| (0..all.len()).map(|v| t.quotient.depends_on(v)).collect()).collect();
        let order = best_order(units, &all, &depends);
        // Variables are numbered as the levels were listed.
        let mut to = vec![0; all.len()];
        for (position, v) in order.iter().enumerate() {
            to[*v] = position;
        }
        let levels: Vec<Level> = order.iter().map(|v| all[*v]).collect();
        let targets = targets
            .iter()
            .map(|t| {
                let moved = |f: &Form| f.reordered(&to);
                let quotient =
                    Quotient { numerator: moved(&t.quotient.numerator), denominator: moved(&t.quotient.denominator) };
                let floats = |f: &Form| f.0.iter().map(|c| *c as f64).collect();
                Window {
                    floats: [floats(&quotient.numerator), floats(&quotient.denominator)],
                    ends: t.windows.iter().map(|w| [w[0].to_f64(), w[1].to_f64()]).collect(),
                    exact: t.windows.clone(),
                    last: (0..levels.len()).rev().find(|l| quotient.depends_on(*l)),
                    quotient,
                }
            })
            .collect();
        let bounds = levels
            .iter()
            .map(|l| match (l.second, &units[l.unit].groups[..]) {
                (true, _) => units[l.unit].space.second_bounds(),
                (false, [first, .., last]) => [first.value, last.value],
                (false, [only]) => [only.value; 2],
                (false, []) => [1.0, 1.0],
            })
            .collect();
        Self { units, levels, targets, bounds }
    }

    /// How many steps the outermost loop has.
    pub fn outer(&self) -> usize {
        self.levels.first().map_or(0, |l| self.units[l.unit].groups.len())
    }

    /// Targets that no tooth numbers can change and that are not met.
    pub fn impossible(&self) -> Vec<usize> {
        let constant = |t: &Window| t.last.is_none() && !t.holds(&[]);
        (0..self.targets.len()).filter(|t| constant(&self.targets[*t])).collect()
    }

    /// Walks through steps `range` of the outermost loop.
    pub fn walk(&self, range: std::ops::Range<usize>, work: &dyn Work, sink: &mut dyn Sink) {
        if !self.impossible().is_empty() || self.units.iter().any(|u| u.groups.is_empty()) {
            return;
        }
        let mut walk = Walk {
            nest: self,
            work,
            chosen: Vec::with_capacity(self.levels.len()),
            folded: vec![self.targets.iter().map(|t| t.floats.clone()).collect(); self.levels.len() + 1],
            sink,
        };
        walk.visit(0, Some(range));
    }
}

/// The order in which windows close soonest: every order is tried for up to six loops, else each loop is the best next.
fn best_order(units: &[Unit<'_>], levels: &[Level], depends: &[Vec<bool>]) -> Vec<usize> {
    let size = |l: &Level| match l.second {
        false => units[l.unit].groups.len().max(1) as f64,
        true => 100.0,
    };
    // What is left of a loop when so many targets close it.
    let left = |closed: usize| [1.0, 0.03, 0.01, 0.006][closed.min(3)];
    let closed_by = |order: &[usize], l: usize| {
        let complete = |d: &Vec<bool>| d[l] && (0..levels.len()).all(|v| !d[v] || v == l || order.contains(&v));
        depends.iter().filter(|d| complete(d)).count()
    };
    let may_follow = |order: &[usize], l: usize| {
        !order.contains(&l)
            && (!levels[l].second || order.iter().any(|o| levels[*o].unit == levels[l].unit && !levels[*o].second))
    };
    let mut best = (f64::INFINITY, vec![]);
    if levels.len() <= 6 {
        let mut stack = vec![(vec![], 1.0, 0.0)];
        while let Some((order, nodes, cost)) = stack.pop() {
            let order: Vec<usize> = order;
            if order.len() == levels.len() {
                if cost < best.0 {
                    best = (cost, order);
                }
                continue;
            }
            for l in (0..levels.len()).rev().filter(|l| may_follow(&order, *l)) {
                let nodes: f64 = (nodes * size(&levels[l]) * left(closed_by(&order, l))).max(1.0);
                let next = [&order[..], &[l]].concat();
                stack.push((next, nodes, cost + nodes));
            }
        }
        return best.1;
    }
    let mut order = vec![];
    while order.len() < levels.len() {
        let cost = |l: &usize| size(&levels[*l]) * left(closed_by(&order, *l));
        let next = (0..levels.len()).filter(|l| may_follow(&order, *l)).min_by(|a, b| cost(a).total_cmp(&cost(b)));
        let Some(next) = next else { break };
        order.push(next);
    }
    order
}

impl Window {
    fn inside(&self, ratio: f64) -> bool {
        self.ends.iter().any(|[a, b]| *a <= ratio && ratio <= *b)
    }

    /// Exactly, for the first groups of the loops.
    fn holds(&self, y: &[(i64, i64)]) -> bool {
        let value = |form: &Form| {
            let mut fold: Vec<Rational> = form.0.iter().map(|c| Rational::from(*c)).collect();
            for (a, b) in y {
                let y = Rational::new(*a, *b);
                fold =
                    fold.chunks(2).map(|c| if c[1].is_zero() { c[0].clone() } else { &c[0] + &(&y * &c[1]) }).collect();
            }
            // It depends on no further variable.
            fold.swap_remove(0)
        };
        let (n, d) = (value(&self.quotient.numerator), value(&self.quotient.denominator));
        if d.is_zero() {
            return false;
        }
        let ratio = n / d;
        self.exact.iter().any(|[a, b]| *a <= ratio && ratio <= *b)
    }
}

struct Walk<'w, 'u, 's> {
    nest: &'w Nest<'u, 's>,
    work: &'w dyn Work,
    chosen: Vec<&'w Group>,
    /// At each depth the forms of every target with the outer variables put in.
    folded: Vec<Vec<[Vec<f64>; 2]>>,
    sink: &'w mut dyn Sink,
}

impl<'w> Walk<'w, '_, '_> {
    fn visit(&mut self, depth: usize, only: Option<std::ops::Range<usize>>) {
        let nest = self.nest;
        let level = nest.levels[depth];
        let unit = &nest.units[level.unit];
        let slice: &'w [Group] = if level.second {
            let at = nest.levels[..depth].iter().position(|l| l.unit == level.unit).unwrap_or(0);
            self.chosen[at].children(unit.space, unit.every_stage)
        } else {
            &unit.groups
        };
        let whole = only.unwrap_or(0..slice.len());
        let mut ranges: Vec<(usize, usize)> = vec![(whole.start, whole.end.min(slice.len()))];
        let mut closed = false;
        for t in 0..nest.targets.len() {
            if nest.targets[t].last == Some(depth) {
                closed = true;
                ranges = self.narrow(t, depth, slice, &ranges);
                if ranges.is_empty() {
                    return;
                }
            }
        }
        if !closed {
            let mut kept = vec![];
            for (from, to) in ranges {
                self.halve(depth, slice, from, to, &mut kept);
            }
            ranges = kept;
        }
        let innermost = depth + 1 == nest.levels.len();
        for (from, to) in ranges {
            if innermost {
                let chosen = Chosen { levels: &nest.levels, groups: &self.chosen };
                self.sink.found(&chosen, &slice[from..to]);
                continue;
            }
            for group in &slice[from..to] {
                if depth <= 1 && self.work.cancelled() {
                    return;
                }
                self.fold(depth, group.value);
                // A target that closes the next loop is looked at there.
                let possible = (0..nest.targets.len()).all(|t| {
                    nest.targets[t].last.is_none_or(|last| last < depth + 2) || self.may_hold(t, depth + 1, None)
                });
                if possible {
                    self.chosen.push(group);
                    self.visit(depth + 1, None);
                    self.chosen.pop();
                }
            }
        }
    }

    /// Puts the value of the loop at `depth` into every target that goes on.
    fn fold(&mut self, depth: usize, y: f64) {
        let (outer, inner) = self.folded.split_at_mut(depth + 1);
        for (t, target) in self.nest.targets.iter().enumerate() {
            if target.last.is_some_and(|last| last > depth) {
                for part in 0..2 {
                    let (from, to) = (&outer[depth][t][part], &mut inner[0][t][part]);
                    to.clear();
                    to.extend(from.chunks_exact(2).map(|c| c[0] + y * c[1]));
                }
            }
        }
    }

    /// Whether a target can come into its window anywhere in the box of the variables from `depth` on; `own` are other
    /// bounds of the variable at `depth`.
    fn may_hold(&self, t: usize, depth: usize, own: Option<[f64; 2]>) -> bool {
        let target = &self.nest.targets[t];
        let Some(last) = target.last else { return true };
        let [n, d] = &self.folded[depth][t];
        let free = last + 1 - depth;
        let (mut low, mut high, mut sign) = (f64::INFINITY, f64::NEG_INFINITY, 0.0);
        for corner in 0..1usize << free {
            let value = |form: &Vec<f64>| {
                let mut sum = 0.0;
                for mask in 0..1usize << free {
                    let mut term = form[mask];
                    if term != 0.0 {
                        for v in 0..free {
                            if mask >> v & 1 == 1 {
                                let bounds = own.filter(|_| v == 0).unwrap_or(self.nest.bounds[depth + v]);
                                term *= bounds[corner >> v & 1];
                            }
                        }
                        sum += term;
                    }
                }
                sum
            };
            let (n, d) = (value(n), value(d));
            if d == 0.0 || d * sign < 0.0 || !d.is_finite() || !n.is_finite() {
                return true;
            }
            sign = d;
            low = low.min(n / d);
            high = high.max(n / d);
        }
        let slack = NEAR * (1.0 + low.abs().max(high.abs()));
        target.ends.iter().any(|[a, b]| *a <= high + slack && low - slack <= *b)
    }

    /// Leaves out halves of a range in which some target cannot hold.
    fn halve(&self, depth: usize, slice: &[Group], from: usize, to: usize, kept: &mut Vec<(usize, usize)>) {
        if from >= to {
            return;
        }
        let own = Some([slice[from].value, slice[to - 1].value]);
        let open =
            |t: usize| self.nest.targets[t].last.is_none_or(|last| last <= depth) || self.may_hold(t, depth, own);
        if !(0..self.nest.targets.len()).all(open) {
            return;
        }
        if to - from <= 4 {
            match kept.last_mut().filter(|k| k.1 == from) {
                Some(before) => before.1 = to,
                None => kept.push((from, to)),
            }
            return;
        }
        let middle = (from + to) / 2;
        self.halve(depth, slice, from, middle, kept);
        self.halve(depth, slice, middle, to, kept);
    }

    /// Whether a target that the loop at `depth` completes holds for a group.
    fn passes(&self, t: usize, depth: usize, group: &Group) -> bool {
        let target = &self.nest.targets[t];
        let [n, d] = &self.folded[depth][t];
        let y = group.value;
        let (top, bottom) = (n[0] + y * n[1], d[0] + y * d[1]);
        let ratio = top / bottom;
        // Not much may have been lost by cancellation.
        let sound =
            bottom.abs() > 1e-5 * (d[0].abs() + y * d[1].abs()) && top.abs() > 1e-5 * (n[0].abs() + y * n[1].abs());
        let near = target.ends.iter().flatten().any(|e| (ratio - e).abs() <= NEAR * e.abs().max(1e-3));
        if sound && !near {
            return target.inside(ratio);
        }
        let y: Vec<(i64, i64)> = self.chosen.iter().map(|g| g.exact).chain([group.exact]).collect();
        target.holds(&y)
    }

    /// The parts of ranges in which a target holds.
    fn narrow(&self, t: usize, depth: usize, slice: &[Group], ranges: &[(usize, usize)]) -> Vec<(usize, usize)> {
        let target = &self.nest.targets[t];
        let [n, d] = &self.folded[depth][t];
        let (n0, n1, d0, d1) = (n[0], n[1], d[0], d[1]);
        let mut breaks: Vec<f64> = vec![];
        let mut delicate = false;
        if d1 != 0.0 {
            breaks.push(-d0 / d1);
        }
        for end in target.ends.iter().flatten() {
            let slope = n1 - end * d1;
            delicate |= slope.abs() < 1e-6 * (n1.abs() + (end * d1).abs());
            breaks.push((end * d0 - n0) / slope);
        }
        let mut found: Vec<(usize, usize)> = vec![];
        let mut add = |from: usize, to: usize| {
            if from < to {
                match found.last_mut().filter(|f| f.1 >= from) {
                    Some(f) => f.1 = f.1.max(to),
                    None => found.push((from, to)),
                }
            }
        };
        for &(from, to) in ranges {
            let part = &slice[from..to];
            let (Some(first), Some(last)) = (part.first(), part.last()) else { continue };
            if delicate {
                for k in from..to {
                    if self.passes(t, depth, &slice[k]) {
                        add(k, k + 1);
                    }
                }
                continue;
            }
            let (low, high) = (first.value * (1.0 - 1e-6), last.value * (1.0 + 1e-6));
            let mut cuts: Vec<f64> = breaks.iter().copied().filter(|y| *y > low && *y < high).collect();
            cuts.push(low);
            cuts.push(high);
            cuts.sort_by(f64::total_cmp);
            let at = |y: f64| from + part.partition_point(|g| g.value < y);
            // Whatever is near a cut is asked by itself; between cuts nothing changes.
            let mut open_from = from;
            for pair in cuts.windows(2) {
                let [a, b] = [pair[0], pair[1]];
                let (start, end) = (at(a * (1.0 + NEAR)).max(open_from), at(b * (1.0 - NEAR)).max(open_from));
                for e in open_from..start.min(to) {
                    if self.passes(t, depth, &slice[e]) {
                        add(e, e + 1);
                    }
                }
                let middle = 0.5 * (a + b);
                if start < end && target.inside((n0 + middle * n1) / (d0 + middle * d1)) {
                    add(start, end);
                }
                open_from = end.max(start).max(open_from);
            }
            for e in open_from..to {
                if self.passes(t, depth, &slice[e]) {
                    add(e, e + 1);
                }
            }
        }
        found
    }
}
