//! The arithmetic of a compiled train, point by point and in chunks.
//!
//! Chunks are worked off in passes over arrays that the compiler vectorises; [`pulp`] picks the
//! vector width at run time. No fused multiply-add: the same input gives the same bits at every
//! width.

use std::ops::Range;

use crate::arch::Arch;

use super::duty::PointVerdict;
use super::iterated::{Iterated, Lanes};
use super::pairs::{Fill, Line, Pair, Shared};
use super::parts::{CHUNK, MOST_FEATURES, MOST_LINEAR, MOST_MOVING, Parts, Target, TorqueFrom};
use super::passes::{combine, dot, lane};

/// Most elements.
const MOST_ELEMENTS: usize = 64;
/// Patterns tried on whole chunks; other lanes go one by one.
const RECENT: usize = 4;
/// So few points are cheaper one by one.
const FEW: usize = 4;
/// A multiple of the points that are worked on side by side, whatever the width.
const VECTORS: usize = 32;

/// Least power in, W, of which an efficiency is told: below it floating point has no digits to tell it with.
pub(super) const LEAST_POWER: f64 = f64::MIN_POSITIVE;

/// A pattern number that means: not found yet.
const NONE: u64 = u64::MAX;
/// A pattern number that means: an element is at rest at this point.
const AT_REST: u64 = u64::MAX - 1;

/// Any train.
#[derive(Clone, Debug)]
pub(super) struct General {
    p: Parts,
    features: usize,
    /// Columns with two values of ρ and relative motion.
    moving: Vec<usize>,
    /// For each of them the one prescribed speed that its relative speed follows, and its factor.
    axis: Vec<Option<(usize, f64)>>,
    /// By pattern: forces of the moving elements over the features; `None` where singular.
    forces: Vec<Option<Vec<Vec<f64>>>>,
    /// By pattern: linear outputs over the features.
    table: Vec<Vec<Vec<f64>>>,
    /// Instead of the patterns, when losses depend on load.
    iterated: Option<Iterated>,
}

/// Work arrays of a chunk.
#[derive(Clone, Debug)]
pub(super) struct Chunk {
    pub speeds: Vec<[f64; CHUNK]>,
    pub linear: Vec<[f64; CHUNK]>,
    pub loss: [f64; CHUNK],
    pub efficiency: [f64; CHUNK],
    signs: Vec<[f64; CHUNK]>,
    lanes: Lanes,
    sigma: Vec<[f64; CHUNK]>,
    worst: [f64; CHUNK],
    which: [u64; CHUNK],
    power_in: [f64; CHUNK],
    speed: [f64; CHUNK],
    recent: [usize; RECENT],
    /// Inputs and linear outputs of points put side by side.
    given: Vec<[f64; CHUNK]>,
    compact: Vec<[f64; CHUNK]>,
}

impl Chunk {
    pub fn new(g: &General) -> Self {
        let many = |n: usize| vec![[0.0; CHUNK]; n];
        let last = g.forces.len().saturating_sub(1);
        Self {
            speeds: many(g.p.speed_rows.len()),
            linear: many(g.p.linear),
            loss: [0.0; CHUNK],
            efficiency: [0.0; CHUNK],
            signs: many(g.p.signs.len()),
            lanes: Lanes::new(g.iterated.as_ref()),
            sigma: many(g.moving.len()),
            worst: [0.0; CHUNK],
            which: [0; CHUNK],
            power_in: [0.0; CHUNK],
            speed: [0.0; CHUNK],
            recent: [0, last, last, last],
            given: many(g.p.torques + g.p.speeds),
            compact: many(g.p.linear),
        }
    }
}

fn sign(x: f64) -> f64 {
    if x > 0.0 {
        1.0
    } else if x < 0.0 {
        -1.0
    } else {
        0.0
    }
}

impl General {
    /// `regular`: whether a pattern (driver of each column) holds no singular system. Asked only
    /// where losses depend on load and there is no certificate.
    pub fn new(p: Parts, regular: &dyn Fn(&[[f64; 2]]) -> bool) -> Self {
        let k = p.columns.len();
        assert!(k <= MOST_ELEMENTS && p.linear <= MOST_LINEAR, "bounded by the limits of a train");
        let features = p.right.len();
        let moving: Vec<usize> = (0..k)
            .filter(|&j| p.columns[j].rho[0] != p.columns[j].rho[1] && p.columns[j].relative.iter().any(|x| *x != 0.0))
            .collect();
        let axis = moving.iter().map(|&j| {
            let relative = &p.columns[j].relative;
            let mut used = (0..p.speeds).filter(|&i| relative[i] != 0.0);
            used.next().filter(|_| used.next().is_none()).map(|i| (i, relative[i]))
        });
        let axis = axis.collect();
        let mut g = Self { features, moving, axis, forces: vec![], table: vec![], iterated: None, p };
        if g.p.columns.iter().any(|c| c.law.is_some()) {
            g.iterated = Some(Iterated::new(&g.p, &g.moving, features, regular));
            return g;
        }
        for pattern in 0..1usize << g.moving.len() {
            let rho: Vec<f64> = (0..k).map(|j| g.rho(j, pattern)).collect();
            let matrix = nalgebra::DMatrix::from_fn(k, k, |r, j| {
                g.p.columns[j].entries.iter().filter(|e| e.0 == r).map(|e| e.1 + e.2 * rho[j]).sum()
            });
            let right = nalgebra::DMatrix::from_fn(k, features, |r, i| g.p.right[i][r]);
            let solved = if k == 0 {
                // Everything turns as one: there is nothing to solve, and the library has no systems without unknowns.
                Some(right)
            } else {
                let lu = matrix.clone().lu();
                lu.solve(&right).and_then(|x| {
                    // One step of refinement: the table serves millions of points.
                    let correction = lu.solve(&(&right - &matrix * &x))?;
                    Some(x + correction)
                })
            };
            let Some(all) = solved else {
                g.forces.push(None);
                g.table.push(vec![vec![f64::NAN; features]; g.p.linear]);
                continue;
            };
            g.forces.push(Some(g.moving.iter().map(|&j| all.row(j).iter().copied().collect()).collect()));
            let table = (0..g.p.linear).map(|o| {
                (0..features)
                    .map(|i| {
                        let through: f64 = (0..k)
                            .map(|j| all[(j, i)] * (g.p.per_force[j][0][o] + rho[j] * g.p.per_force[j][1][o]))
                            .sum();
                        g.p.direct[i][o] + through
                    })
                    .collect()
            });
            let table = table.collect();
            g.table.push(table);
        }
        g
    }

    /// What it was made of.
    pub fn parts(&self) -> &Parts {
        &self.p
    }

    /// How many elements have two values of ρ and relative motion.
    pub fn moving(&self) -> usize {
        self.moving.len()
    }

    pub fn certified(&self) -> bool {
        self.p.certified
    }

    pub fn linear(&self) -> usize {
        self.p.linear
    }

    pub fn speed(&self, row: usize, speeds: &[f64]) -> f64 {
        dot(&self.p.speed_rows[row], speeds)
    }

    /// ρ of a column in a pattern: bit clear, p drives; bit set, q drives.
    fn rho(&self, j: usize, pattern: usize) -> f64 {
        let bit = self.moving.iter().position(|m| *m == j);
        self.p.columns[j].rho[bit.map_or(0, |b| pattern >> b & 1)]
    }

    /// Power in and balance of the external powers.
    pub fn powers(&self, speeds: &[f64], torques: &[f64], linear: &[f64]) -> (f64, f64) {
        let (mut power_in, mut sum) = (0.0, 0.0);
        for t in &self.p.terminals {
            let torque = match t.torque {
                TorqueFrom::Input(i) => torques[i],
                TorqueFrom::Linear(i) => linear[i],
            };
            let power = torque * dot(&t.speed, speeds);
            power_in += if power > 0.0 { power } else { 0.0 };
            sum += power;
        }
        // NaN (a locked point) must not vanish in the comparison above.
        (if sum.is_nan() { f64::NAN } else { power_in }, sum)
    }

    /// One point: its linear outputs and how many solutions it has.
    pub fn point(&self, speeds: &[f64], torques: &[f64], hint: &mut usize, out: &mut [f64]) -> PointVerdict {
        let mut x = [0.0; MOST_FEATURES];
        let x = &mut x[..self.features];
        x[..torques.len()].copy_from_slice(torques);
        x[torques.len()..torques.len() + speeds.len()].copy_from_slice(speeds);
        for (slot, row) in x[torques.len() + speeds.len()..].iter_mut().zip(&self.p.signs) {
            *slot = sign(dot(row, speeds));
        }
        let mut sigma = [0.0; MOST_MOVING];
        let sigma = &mut sigma[..self.moving.len()];
        for (s, &j) in sigma.iter_mut().zip(&self.moving) {
            *s = dot(&self.p.columns[j].relative, speeds);
        }
        if let Some(iterated) = &self.iterated {
            return iterated.point(x, sigma, out);
        }
        if sigma.contains(&0.0) {
            return self.at_rest(x, sigma, out);
        }
        let (verdict, pattern) = self.find(x, sigma, *hint);
        match pattern {
            Some(pattern) => {
                *hint = pattern;
                out.iter_mut().zip(&self.table[pattern]).for_each(|(o, row)| *o = dot(row, x));
            }
            None => out.fill(f64::NAN),
        }
        verdict
    }

    /// The first moving element that contradicts a pattern, and whether one is idle with bit set.
    fn wrong(&self, pattern: usize, x: &[f64], sigma: &[f64]) -> Option<(Option<usize>, bool)> {
        let forces = self.forces[pattern].as_ref()?;
        let mut doubled = false;
        for (bit, (row, s)) in forces.iter().zip(sigma).enumerate() {
            let drive = dot(row, x) * s;
            let q = pattern >> bit & 1 == 1;
            if if q { drive > 0.0 } else { drive < 0.0 } {
                return Some((Some(bit), false));
            }
            doubled |= q && drive == 0.0;
        }
        Some((None, doubled))
    }

    fn find(&self, x: &[f64], sigma: &[f64], hint: usize) -> (PointVerdict, Option<usize>) {
        if self.p.certified {
            // Least-index pivoting ends under the W-property from any start.
            let mut pattern = hint;
            for _ in 0..=self.forces.len() {
                match self.wrong(pattern, x, sigma) {
                    Some((Some(bit), _)) => pattern ^= 1 << bit,
                    Some((None, _)) => return (PointVerdict::Unique, Some(pattern)),
                    None => break,
                }
            }
        }
        let mut found = None;
        for pattern in 0..self.forces.len() {
            if self.wrong(pattern, x, sigma) == Some((None, false)) {
                if found.is_some() {
                    return (PointVerdict::Multiple, found);
                }
                found = Some(pattern);
            }
        }
        (if found.is_some() { PointVerdict::Unique } else { PointVerdict::Locked }, found)
    }

    /// A point at which some element has no relative motion: it transmits without loss, so its
    /// pattern is in no table and is solved here.
    fn at_rest(&self, x: &[f64], sigma: &[f64], out: &mut [f64]) -> PointVerdict {
        let k = self.p.columns.len();
        let mut found = 0;
        for pattern in 0..self.forces.len() {
            if (0..sigma.len()).any(|b| sigma[b] == 0.0 && pattern >> b & 1 == 1) {
                continue;
            }
            let mut rho = [1.0; MOST_ELEMENTS];
            for j in 0..k {
                let bit = self.moving.iter().position(|m| *m == j);
                let rests = bit.is_some_and(|b| sigma[b] == 0.0);
                rho[j] = if rests { 1.0 } else { self.rho(j, pattern) };
            }
            let mut f = [0.0; MOST_ELEMENTS];
            if !self.solve(&rho[..k], x, &mut f[..k]) {
                continue;
            }
            let fits = self.moving.iter().enumerate().all(|(b, &j)| {
                let drive = f[j] * sigma[b];
                if pattern >> b & 1 == 1 { drive < 0.0 } else { drive >= 0.0 }
            });
            if !fits {
                continue;
            }
            found += 1;
            if found > 1 {
                return PointVerdict::Multiple;
            }
            for (o, slot) in out.iter_mut().enumerate() {
                let through: f64 =
                    (0..k).map(|j| f[j] * (self.p.per_force[j][0][o] + rho[j] * self.p.per_force[j][1][o])).sum();
                *slot = through + (0..self.features).map(|i| self.p.direct[i][o] * x[i]).sum::<f64>();
            }
        }
        if found == 0 {
            out.fill(f64::NAN);
            return PointVerdict::Locked;
        }
        PointVerdict::Unique
    }

    /// Gaussian elimination with row exchange, on the stack.
    fn solve(&self, rho: &[f64], x: &[f64], f: &mut [f64]) -> bool {
        let k = rho.len();
        let mut m = [[0.0; MOST_MOVING_SQUARE]; MOST_MOVING_SQUARE];
        if k > MOST_MOVING_SQUARE {
            return false;
        }
        for (j, column) in self.p.columns.iter().enumerate() {
            for &(r, constant, slope) in &column.entries {
                m[r][j] = constant + slope * rho[j];
            }
        }
        for r in 0..k {
            f[r] = (0..self.features).map(|i| self.p.right[i][r] * x[i]).sum();
        }
        for c in 0..k {
            let Some(pivot) = (c..k).max_by(|&a, &b| m[a][c].abs().total_cmp(&m[b][c].abs())) else { return false };
            if m[pivot][c] == 0.0 {
                return false;
            }
            m.swap(pivot, c);
            f.swap(pivot, c);
            for r in c + 1..k {
                let factor = m[r][c] / m[c][c];
                if factor != 0.0 {
                    for n in c..k {
                        m[r][n] -= factor * m[c][n];
                    }
                    f[r] -= factor * f[c];
                }
            }
        }
        for c in (0..k).rev() {
            let sum: f64 = (c + 1..k).map(|n| m[c][n] * f[n]).sum();
            f[c] = (f[c] - sum) / m[c][c];
        }
        true
    }

    /// A chunk of points, whose torques and speeds are `given`; returns how many are not unique. Linear outputs go where
    /// `to` says, the rest into the chunk's arrays.
    pub fn chunk(
        &self,
        arch: Arch,
        given: &[&[f64]],
        range: Range<usize>,
        w: &mut Chunk,
        hint: &mut usize,
        mut to: Target<'_, '_>,
    ) -> usize {
        let n = range.len();
        let (l, d) = (self.p.torques, self.p.speeds);
        let mut inputs: [&[f64]; MOST_FEATURES] = [&[]; MOST_FEATURES];
        inputs[..given.len()].copy_from_slice(given);
        // Out of `w` while the features point into it.
        let mut signs = std::mem::take(&mut w.signs);
        for (out, row) in signs.iter_mut().zip(&self.p.signs) {
            combine(arch, &inputs[l..l + d], row, &mut out[..n]);
            arch.dispatch(Signs { x: &mut out[..n] });
        }
        for (out, row) in w.speeds.iter_mut().zip(&self.p.speed_rows) {
            combine(arch, &inputs[l..l + d], row, &mut out[..n]);
        }
        for (slot, s) in inputs[l + d..].iter_mut().zip(&signs) {
            *slot = &s[..n];
        }
        let x = &inputs[..self.features];
        let odd = match &self.iterated {
            Some(iterated) => iterated.chunk(arch, x, l..l + d, range.clone(), &mut w.lanes, &mut w.linear, &mut to),
            None => match self.in_pairs(arch, x, range.clone(), w, hint, &mut to) {
                Some(odd) => odd,
                None => self.patterns(arch, x, range.clone(), w, hint, &mut to),
            },
        };
        if to.powers {
            w.loss[..n].fill(0.0);
            w.power_in[..n].fill(0.0);
            for t in &self.p.terminals {
                combine(arch, &x[l..l + d], &t.speed, &mut w.speed[..n]);
                let torque: &[f64] = match t.torque {
                    TorqueFrom::Input(i) => x[i],
                    TorqueFrom::Linear(i) => to.slice(i, &mut w.linear, range.clone()),
                };
                let speed = &w.speed[..n];
                arch.dispatch(AddPower { torque, speed, loss: &mut w.loss[..n], power_in: &mut w.power_in[..n] });
            }
            let (loss, power_in) = (&w.loss[..n], &w.power_in[..n]);
            arch.dispatch(Efficiency { loss, power_in, out: &mut w.efficiency[..n] });
        }
        w.signs = signs;
        odd
    }

    /// Linear outputs of a chunk of a train whose only speed keeps its sign, most points by two patterns at a time.
    /// Nothing where the chunk is not of that kind.
    fn in_pairs(
        &self,
        arch: Arch,
        x: &[&[f64]],
        range: Range<usize>,
        w: &mut Chunk,
        hint: &mut usize,
        to: &mut Target<'_, '_>,
    ) -> Option<usize> {
        let inputs = self.p.torques + 1;
        let plain = self.p.certified && self.p.speeds == 1 && self.p.signs.len() <= 1;
        if !plain || self.features != inputs + self.p.signs.len() || !self.axis.iter().all(Option::is_some) {
            return None;
        }
        let speed = x[self.p.torques];
        let direction = if speed[0] > 0.0 { 1.0 } else { -1.0 };
        if !arch.dispatch(KeepsSign { x: speed, direction }) {
            return None;
        }
        match inputs {
            1 => Some(self.pairs::<1>(arch, x, direction, range, w, hint, to)),
            2 => Some(self.pairs::<2>(arch, x, direction, range, w, hint, to)),
            3 => Some(self.pairs::<3>(arch, x, direction, range, w, hint, to)),
            _ => None,
        }
    }

    /// The rows of two patterns, where the speed has this direction.
    fn pair<const F: usize>(&self, patterns: [usize; 2], direction: f64) -> Option<Pair<F>> {
        let sign = match self.p.signs.first() {
            Some(row) => sign(row[0]) * direction,
            None => 1.0,
        };
        let [a, b] = patterns.map(|p| self.forces[p].as_ref());
        let (a, b) = (a?, b?);
        let mut pair = Pair {
            fits: [[Line::NONE; 2]; MOST_MOVING],
            moving: self.moving.len(),
            outputs: [[Line::NONE; 2]; MOST_LINEAR],
            linear: self.p.linear,
        };
        for bit in 0..self.moving.len() {
            let factor = self.axis[bit].map_or(1.0, |a| a.1) * direction;
            for (p, (pattern, row)) in patterns.iter().zip([&a[bit], &b[bit]]).enumerate() {
                let side = if pattern >> bit & 1 == 1 { -factor } else { factor };
                let line = Line::new(row, sign);
                pair.fits[bit][p] = if side < 0.0 { line.negative() } else { line };
            }
        }
        for (o, slot) in pair.outputs[..self.p.linear].iter_mut().enumerate() {
            *slot = patterns.map(|p| Line::new(&self.table[p][o], sign));
        }
        Some(pair)
    }

    #[expect(clippy::too_many_arguments, reason = "those of a chunk, taken apart")]
    fn pairs<const F: usize>(
        &self,
        arch: Arch,
        x: &[&[f64]],
        direction: f64,
        range: Range<usize>,
        w: &mut Chunk,
        hint: &mut usize,
        to: &mut Target<'_, '_>,
    ) -> usize {
        let n = range.len();
        let Chunk { linear, recent, given, compact, .. } = w;
        let mut own = [0usize; RECENT];
        // All outputs at once: in the caller's slices where there are any, else in the chunk's own.
        let mut slots: [&mut [f64]; MOST_LINEAR] = std::array::from_fn(|_| Default::default());
        for (o, array) in linear.iter_mut().enumerate() {
            if to.out.is_empty() || to.column[o].is_none() {
                slots[o] = &mut array[..n];
            }
        }
        for (k, out) in to.out.iter_mut().enumerate() {
            if let Some(o) = to.column.iter().position(|c| *c == Some(k)) {
                slots[o] = &mut out[range.clone()];
            }
        }
        let inputs: [&[f64]; F] = std::array::from_fn(|k| x[k]);
        let mut shared = Shared { taken: [0; 2], left: [0; CHUNK], open: 0 };
        let known = |shared: &mut Shared, inputs, out: &mut [&mut [f64]], patterns| {
            let pair = self.pair::<F>(patterns, direction)?;
            arch.dispatch(Fill { x: inputs, pair: &pair, out, shared });
            Some(shared.taken)
        };
        match known(&mut shared, inputs, &mut slots, [recent[0], recent[1]]) {
            Some(taken) => own[..2].copy_from_slice(&taken),
            None => {
                shared.open = n;
                shared.left.iter_mut().enumerate().for_each(|(i, lane)| *lane = i as u16);
            }
        }
        // Points that are left are put side by side and tried with two more patterns.
        let mut rest = shared.open;
        let mut lanes = shared.left;
        if rest > FEW {
            let wide = rest.next_multiple_of(VECTORS).min(CHUNK);
            for (given, x) in given.iter_mut().zip(inputs) {
                given.iter_mut().zip(&lanes[..rest]).for_each(|(g, lane)| *g = x[usize::from(*lane)]);
                let last = given[rest - 1];
                given[rest..wide].fill(last);
            }
            let inputs = std::array::from_fn(|k| &given[k][..wide]);
            let mut again = Shared { taken: [0; 2], left: [0; CHUNK], open: 0 };
            let mut side: [&mut [f64]; MOST_LINEAR] = std::array::from_fn(|_| Default::default());
            side.iter_mut().zip(compact.iter_mut()).for_each(|(slot, array)| *slot = &mut array[..wide]);
            if known(&mut again, inputs, &mut side, [recent[2], recent[3]]).is_some() {
                for (slot, values) in slots[..self.p.linear].iter_mut().zip(compact.iter()) {
                    lanes[..rest].iter().zip(values).for_each(|(lane, x)| slot[usize::from(*lane)] = *x);
                }
                // What was filled up is counted too; it only decides which patterns come first.
                own[2..].copy_from_slice(&again.taken);
                let still = again.left[..again.open].iter().filter(|i| usize::from(**i) < rest);
                let mut open = 0;
                for i in still {
                    shared.left[open] = lanes[usize::from(*i)];
                    open += 1;
                }
                (rest, lanes) = (open, shared.left);
            }
        }
        // What none of them fits goes one by one, and may bring a new pattern in.
        let mut odd = 0;
        let mut one = [0.0; MOST_FEATURES];
        let mut relative = [0.0; MOST_MOVING];
        for i in lanes[..rest].iter().map(|i| usize::from(*i)) {
            one.iter_mut().zip(x).for_each(|(s, x)| *s = x[i]);
            let speed = x[F - 1][i];
            relative.iter_mut().zip(&self.axis).for_each(|(s, a)| *s = a.map_or(0.0, |a| speed * a.1));
            let (verdict, pattern) = self.find(&one[..self.features], &relative[..self.moving.len()], *hint);
            odd += usize::from(verdict != PointVerdict::Unique);
            if let Some(p) = pattern {
                *hint = p;
                if let Some(k) = recent.iter().position(|r| *r == p) {
                    own[k] += 1;
                }
            }
            for (o, slot) in slots[..self.p.linear].iter_mut().enumerate() {
                slot[i] = pattern.map_or(f64::NAN, |p| dot(&self.table[p][o], &one[..self.features]));
            }
        }
        let mut common: [(usize, usize); RECENT] = std::array::from_fn(|k| (own[k], recent[k]));
        common.sort_unstable_by(|a, b| b.cmp(a));
        *recent = common.map(|(_, pattern)| pattern);
        if rest > FEW && !recent.contains(hint) {
            recent[RECENT - 1] = *hint;
        }
        odd
    }

    /// Linear outputs of a chunk with constant efficiencies: which pattern holds where, then its
    /// rows. `x` are the features; returns how many points are not unique.
    fn patterns(
        &self,
        arch: Arch,
        x: &[&[f64]],
        range: Range<usize>,
        w: &mut Chunk,
        hint: &mut usize,
        to: &mut Target<'_, '_>,
    ) -> usize {
        let n = range.len();
        let (l, d) = (self.p.torques, self.p.speeds);
        // Relative speeds. Those that follow one prescribed speed need no array of their own.
        w.which[..n].fill(NONE);
        let mut rested = [false; MOST_FEATURES];
        for (bit, &j) in self.moving.iter().enumerate() {
            let sigma = match self.axis[bit] {
                Some((axis, _)) if std::mem::replace(&mut rested[axis], true) => continue,
                Some((axis, _)) => x[l + axis],
                None => {
                    combine(arch, &x[l..l + d], &self.p.columns[j].relative, &mut w.sigma[bit][..n]);
                    &w.sigma[bit][..n]
                }
            };
            arch.dispatch(Rest { sigma, which: &mut w.which[..n] });
        }
        let sigma: [(&[f64], f64); MOST_MOVING] = std::array::from_fn(|bit| match self.axis.get(bit) {
            Some(Some((axis, factor))) => (x[l + axis], *factor),
            Some(None) => (&w.sigma[bit][..n], 1.0),
            None => (&[][..], 0.0),
        });

        // Which pattern holds where: the recent ones by whole chunks.
        let mut own = [0usize; RECENT];
        let mut left = n;
        if self.p.certified {
            for (slot, &pattern) in own.iter_mut().zip(&w.recent) {
                let Some(forces) = &self.forces[pattern] else { continue };
                for (bit, row) in forces.iter().enumerate() {
                    let (sigma, factor) = sigma[bit];
                    let side = if pattern >> bit & 1 == 1 { -factor } else { factor };
                    fit(arch, x, row, sigma, side, bit == 0, &mut w.worst[..n]);
                }
                if forces.is_empty() {
                    w.worst[..n].fill(0.0);
                }
                let (taken, open) =
                    arch.dispatch(Assign { worst: &w.worst[..n], pattern: pattern as u64, which: &mut w.which[..n] });
                (*slot, left) = (taken as usize, open as usize);
                // A few points are cheaper one by one than in another pass over all.
                if left < n / 32 {
                    break;
                }
            }
        }
        // What no recent pattern fits goes one by one, and may bring a new pattern in.
        let mut odd = 0;
        let mut one = [0.0; MOST_FEATURES];
        let mut relative = [0.0; MOST_MOVING];
        let (lanes, searched) = select(&w.which[..if left == 0 { 0 } else { n }], |k| k == NONE);
        for i in lanes[..searched].iter().map(|i| usize::from(*i)) {
            one.iter_mut().zip(x).for_each(|(s, x)| *s = x[i]);
            relative.iter_mut().zip(&sigma[..self.moving.len()]).for_each(|(s, (a, f))| *s = a[i] * f);
            let (verdict, pattern) = self.find(&one[..self.features], &relative[..self.moving.len()], *hint);
            odd += usize::from(verdict != PointVerdict::Unique);
            if let Some(p) = pattern {
                *hint = p;
                w.which[i] = p as u64;
                if let Some(k) = w.recent.iter().position(|r| *r == p) {
                    own[k] += 1;
                }
            }
        }

        // Outputs: the two commonest patterns in one pass over the chunk, other frequent ones where
        // they hold, what is left lane by lane.
        let mut common: [(usize, usize); RECENT] = std::array::from_fn(|k| (own[k], w.recent[k]));
        common.sort_unstable_by(|a, b| b.cmp(a));
        let [(most, first), (second_most, second), ..] = common;
        let mut covered = most + second_most;
        for o in 0..self.p.linear {
            let (a, b) = (&self.table[first][o], &self.table[second][o]);
            let out = to.slice(o, &mut w.linear, range.clone());
            if second_most == 0 {
                combine(arch, x, a, out);
            } else {
                combine_two(arch, x, a, b, &w.which[..n], first as u64, out);
            }
        }
        let frequent = 2 + common[2..].iter().filter(|(own, _)| *own > n / 32).count();
        for &(own, pattern) in &common[2..frequent] {
            covered += own;
            for (o, row) in self.table[pattern].iter().enumerate() {
                let out = to.slice(o, &mut w.linear, range.clone());
                combine_where(arch, x, row, &w.which[..n], pattern as u64, out);
            }
        }
        let mut linear = [0.0; MOST_LINEAR];
        let linear = &mut linear[..self.p.linear];
        let [p, q, r, s] = [0, 1, 2, 3].map(|k| match k < frequent && common[k].0 > 0 {
            true => common[k].1 as u64,
            false => UNUSED,
        });
        let (lanes, found) =
            select(&w.which[..if covered < n { n } else { 0 }], |k| (k != p) & (k != q) & (k != r) & (k != s));
        for i in lanes[..found].iter().map(|i| usize::from(*i)) {
            one.iter_mut().zip(x).for_each(|(s, x)| *s = x[i]);
            match w.which[i] {
                NONE => linear.fill(f64::NAN),
                AT_REST => {
                    relative.iter_mut().zip(&sigma[..self.moving.len()]).for_each(|(s, (a, f))| *s = a[i] * f);
                    let verdict = self.at_rest(&one[..self.features], &relative[..self.moving.len()], linear);
                    odd += usize::from(verdict != PointVerdict::Unique);
                }
                pattern => {
                    let table = &self.table[pattern as usize];
                    linear.iter_mut().zip(table).for_each(|(o, row)| *o = dot(row, &one[..self.features]));
                }
            }
            for (o, value) in linear.iter().enumerate() {
                to.slice(o, &mut w.linear, range.clone())[i] = *value;
            }
        }
        // The next chunk tries the commonest patterns first; one that was often searched for comes in.
        w.recent = common.map(|(_, pattern)| pattern);
        if searched > n / 16 && !w.recent.contains(hint) {
            w.recent[RECENT - 1] = *hint;
        }
        odd
    }
}

/// A pattern number that no pattern has.
const UNUSED: u64 = u64::MAX - 2;

/// The lanes that are wanted, and how many: looked for sixteen at a time, because they are rare.
fn select(which: &[u64], wanted: impl Fn(u64) -> bool) -> ([u16; CHUNK], usize) {
    let mut lanes = [0; CHUNK];
    let mut found = 0;
    for (block, k) in which.chunks(16).enumerate() {
        if k.iter().fold(false, |any, k| any | wanted(*k)) {
            for (i, _) in k.iter().enumerate().filter(|(_, k)| wanted(**k)) {
                lanes[found] = (16 * block + i) as u16;
                found += 1;
            }
        }
    }
    (lanes, found)
}

/// Largest system solved on the stack, at rest.
const MOST_MOVING_SQUARE: usize = 24;

lanes! {
    /// One row where `which` is `pattern`, another elsewhere.
    CombineTwo<'a, const F> {
        x: [&'a [f64]; F], a: [f64; F], b: [f64; F], which: &'a [u64], pattern: u64, out: &'a mut [f64],
    } -> () {
        let n = out.len();
        let x = x.map(|x| &x[..n]);
        let which = &which[..n];
        for i in 0..n {
            let (first, second) = (lane::<F>(&x, &a, i), lane::<F>(&x, &b, i));
            out[i] = if which[i] == pattern { first } else { second };
        }
    }
    /// A row where `which` is `pattern`, nothing elsewhere.
    CombineWhere<'a, const F> {
        x: [&'a [f64]; F], row: [f64; F], which: &'a [u64], pattern: u64, out: &'a mut [f64],
    } -> () {
        let n = out.len();
        let x = x.map(|x| &x[..n]);
        let which = &which[..n];
        for i in 0..n {
            let value = lane::<F>(&x, &row, i);
            out[i] = if which[i] == pattern { value } else { out[i] };
        }
    }
    /// `worst = min(worst, side · sigma · Σ row_k x_k)`; without the old `worst` for the first.
    Fit<'a, const F> {
        x: [&'a [f64]; F], row: [f64; F], sigma: &'a [f64], side: f64, first: bool, worst: &'a mut [f64],
    } -> () {
        let n = worst.len();
        let x = x.map(|x| &x[..n]);
        let sigma = &sigma[..n];
        for i in 0..n {
            let g = side * sigma[i] * lane::<F>(&x, &row, i);
            worst[i] = if first || g < worst[i] { g } else { worst[i] };
        }
    }
    /// Whether all are on one side of zero, and not so near it that a product with them could vanish.
    KeepsSign<'a> { x: &'a [f64], direction: f64 } -> bool {
        const CLEAR: f64 = 1e-100;
        let mut all = true;
        for x in x {
            all &= *x * direction > CLEAR;
        }
        all
    }
    /// Speeds become their signs.
    Signs<'a> { x: &'a mut [f64] } -> () {
        for x in x {
            *x = sign(*x);
        }
    }
    /// Marks points at which an element rests.
    Rest<'a> { sigma: &'a [f64], which: &'a mut [u64] } -> () {
        for (k, s) in which.iter_mut().zip(sigma) {
            *k = if *s == 0.0 { AT_REST } else { *k };
        }
    }
    /// Gives the pattern to the points that it fits; returns how many those are, and how many are
    /// left without one.
    Assign<'a> { worst: &'a [f64], pattern: u64, which: &'a mut [u64] } -> (u64, u64) {
        let (mut taken, mut left) = (0u64, 0u64);
        for (k, worst) in which.iter_mut().zip(worst) {
            let fits = *k == NONE && *worst >= 0.0;
            *k = if fits { pattern } else { *k };
            taken += u64::from(fits);
            left += u64::from(*k == NONE);
        }
        (taken, left)
    }
    /// Adds the power of a terminal to the balance and, where positive, to the input.
    AddPower<'a> { torque: &'a [f64], speed: &'a [f64], loss: &'a mut [f64], power_in: &'a mut [f64] } -> () {
        let n = loss.len();
        let (torque, speed, power_in) = (&torque[..n], &speed[..n], &mut power_in[..n]);
        for i in 0..n {
            let p = torque[i] * speed[i];
            loss[i] += p;
            power_in[i] += if p > 0.0 { p } else { 0.0 };
        }
    }
    /// Output over input power; 0 without input, NaN where the point has no solution.
    Efficiency<'a> { loss: &'a [f64], power_in: &'a [f64], out: &'a mut [f64] } -> () {
        let n = out.len();
        let (loss, power_in) = (&loss[..n], &power_in[..n]);
        for i in 0..n {
            // Powers beyond floating point have no efficiency: nothing times infinity is no number.
            let none = loss[i] * 0.0;
            let e = (power_in[i] - loss[i]) / power_in[i] + none;
            out[i] = if power_in[i] >= LEAST_POWER { e } else { none };
        }
    }
    /// To single precision.
    Round<'a> { x: &'a [f64], out: &'a mut [f32] } -> () {
        let n = out.len();
        let x = &x[..n];
        for i in 0..n {
            out[i] = x[i] as f32;
        }
    }
    /// Sum in 32 partial sums.
    Sum<'a> { x: &'a [f64] } -> f64 {
        let (chunks, rest) = x.as_chunks::<32>();
        let mut partial = [0.0; 32];
        for c in chunks {
            for k in 0..32 {
                partial[k] += c[k];
            }
        }
        partial.iter().sum::<f64>() + rest.iter().sum::<f64>()
    }
    /// Adds to partial sums; the extremes of `least`, `most` and the values, if they are other than `least` and `most`.
    /// NaN is in the sums alone.
    Add<'a> { x: &'a [f64], sum: &'a mut [f64; SUMS], least: f64, most: f64 } -> Option<[f64; 2]> {
        let (chunks, rest) = x.as_chunks::<SUMS>();
        let (mut own, mut below, mut above) = (*sum, [least; SUMS], [most; SUMS]);
        for c in chunks {
            add_one(&mut own, &mut below, &mut above, c, c);
        }
        if !rest.is_empty() {
            // An index that the compiler does not know would keep the sums out of registers. What is left is filled up
            // with what changes no sum, -0, and no extreme, NaN.
            let (mut last, mut extremes) = ([-0.0; SUMS], [f64::NAN; SUMS]);
            last[..rest.len()].copy_from_slice(rest);
            extremes[..rest.len()].copy_from_slice(rest);
            add_one(&mut own, &mut below, &mut above, &last, &extremes);
        }
        *sum = own;
        let mut found = 0u64;
        for k in 0..SUMS {
            found |= u64::from(below[k] != least) | u64::from(above[k] != most);
        }
        (found != 0).then(|| {
            let least = below.iter().fold(least, |m, x| if *x < m { *x } else { m });
            [least, above.iter().fold(most, |m, x| if *x > m { *x } else { m })]
        })
    }
}

/// `out = Σ a_k x_k` where `which` is `pattern`, `Σ b_k x_k` elsewhere.
fn combine_two(arch: Arch, x: &[&[f64]], a: &[f64], b: &[f64], which: &[u64], pattern: u64, out: &mut [f64]) {
    fn go<const F: usize>(arch: Arch, x: &[&[f64]], rows: [&[f64]; 2], which: &[u64], pattern: u64, out: &mut [f64]) {
        match (<[&[f64]; F]>::try_from(x), rows.map(<[f64; F]>::try_from)) {
            (Ok(x), [Ok(a), Ok(b)]) => arch.dispatch(CombineTwo { x, a, b, which, pattern, out }),
            _ => {
                for i in 0..out.len() {
                    let row = rows[usize::from(which[i] != pattern)];
                    out[i] = x.iter().zip(row).map(|(x, r)| r * x[i]).sum();
                }
            }
        }
    }
    by_count!(x.len(), go(arch, x, [a, b], which, pattern, out));
}

/// The same, only where `which` is `pattern`.
fn combine_where(arch: Arch, x: &[&[f64]], row: &[f64], which: &[u64], pattern: u64, out: &mut [f64]) {
    fn go<const F: usize>(arch: Arch, x: &[&[f64]], row: &[f64], which: &[u64], pattern: u64, out: &mut [f64]) {
        match (<[&[f64]; F]>::try_from(x), <[f64; F]>::try_from(row)) {
            (Ok(x), Ok(row)) => arch.dispatch(CombineWhere { x, row, which, pattern, out }),
            _ => {
                for i in (0..out.len()).filter(|&i| which[i] == pattern) {
                    out[i] = x.iter().zip(row).map(|(x, r)| r * x[i]).sum();
                }
            }
        }
    }
    by_count!(x.len(), go(arch, x, row, which, pattern, out));
}

/// `worst = min(worst, side · sigma · Σ row_k x_k)`, or that product alone for the first.
fn fit(arch: Arch, x: &[&[f64]], row: &[f64], sigma: &[f64], side: f64, first: bool, worst: &mut [f64]) {
    #[rustfmt::skip]
    fn go<const F: usize>(
        arch: Arch, x: &[&[f64]], row: &[f64], sigma: &[f64], side: f64, first: bool, worst: &mut [f64],
    ) {
        match (<[&[f64]; F]>::try_from(x), <[f64; F]>::try_from(row)) {
            (Ok(x), Ok(row)) => arch.dispatch(Fit { x, row, sigma, side, first, worst }),
            _ => {
                for i in 0..worst.len() {
                    let force: f64 = x.iter().zip(row).map(|(x, r)| r * x[i]).sum();
                    let g = side * sigma[i] * force;
                    worst[i] = if first || g < worst[i] { g } else { worst[i] };
                }
            }
        }
    }
    by_count!(x.len(), go(arch, x, row, sigma, side, first, worst));
}

/// One value for each partial sum, and one for the extremes.
#[inline(always)]
fn add_one(
    sum: &mut [f64; SUMS],
    below: &mut [f64; SUMS],
    above: &mut [f64; SUMS],
    x: &[f64; SUMS],
    extremes: &[f64; SUMS],
) {
    for k in 0..SUMS {
        sum[k] += x[k];
        below[k] = if extremes[k] < below[k] { extremes[k] } else { below[k] };
        above[k] = if extremes[k] > above[k] { extremes[k] } else { above[k] };
    }
}

/// Partial sums of many points.
pub(super) const SUMS: usize = 32;

/// Adds to partial sums; the extremes of all, if a value is below `least` or above `most`.
pub(super) fn add(arch: Arch, x: &[f64], sum: &mut [f64; SUMS], [least, most]: [f64; 2]) -> Option<[f64; 2]> {
    arch.dispatch(Add { x, sum, least, most })
}

/// Sum of a slice.
pub(super) fn sum(arch: Arch, x: &[f64]) -> f64 {
    arch.dispatch(Sum { x })
}

/// To single precision.
pub(super) fn round(arch: Arch, x: &[f64], out: &mut [f32]) {
    arch.dispatch(Round { x, out });
}
