//! Equilibria of a train whose mesh losses depend on load and speed.
//!
//! With the force `f_j` of an element and the part `h_j(f_j)` of it that friction takes, the torques
//! balance when
//!
//! ```text
//! f = f⁰ + C h(f)
//! ```
//!
//! `f⁰` are the forces without any loss, linear in what is prescribed, and `C` is a constant matrix
//! over the elements that move: all others, clutches, brakes and outputs are gone (virtual work).
//! `h = λ f` where end p drives, `−λ f/(1 − λ)` where q drives. Every result is linear in what is
//! prescribed and in `h`.
//!
//! Newton's method on this starts at `f⁰`; two rounds are the rule, each one system as large as there
//! are moving elements. What is returned solves the last *linearised* system: torques balance to
//! round-off whatever the tolerance, and the tolerance bounds how far the losses in them are from
//! their law. Taylor's remainder gives that bound without another evaluation of the law.
//!
//! One function does a round at one point. The loop over the points of a chunk is vectorised by the
//! compiler, and one point alone goes through the same arithmetic: same bits.

use std::ops::Range;

use crate::arch::Arch;

use super::duty::PointVerdict;
use super::parts::{CHUNK, Law, MOST_FEATURES, MOST_MOVING, Parts, Target};
use super::passes::{combine, dot};

/// The losses in the result differ from their laws by less than this part of all mesh losses.
const TOLERANCE: f64 = 1e-10;
/// Round-off of the losses, as a part of the power that the meshes transmit.
const ROUND_OFF: f64 = 1e-15;
/// Largest relative change of a load over which the remainder's bound holds.
const REACH: f64 = 1.0 / 64.0;
/// Factor on the leading term of the remainder that covers the others for losses up to one half.
const REMAINDER: f64 = 2.5;
/// Smallest pivot that is trusted without row exchange.
const SOUND: f64 = 1.0 / 16.0;
/// Rounds without row exchange, and with it.
const ROUNDS: usize = 8;
const MORE_ROUNDS: usize = 64;

/// States of a point.
const OPEN: f64 = 0.0;
const SETTLED: f64 = 1.0;
/// Settled, with a loss at its ceiling.
const FULL: f64 = 2.0;

/// What the rounds need, for `K` moving elements.
#[derive(Clone, Copy)]
struct System<const K: usize> {
    /// `C`.
    couple: [[f64; K]; K],
    law: [Law; K],
    /// Torque on end p per force.
    arm: [f64; K],
    /// Most that friction takes, per force.
    share: [f64; K],
}

/// A train with at least one law.
#[derive(Clone, Debug)]
pub(super) struct Iterated {
    moving: usize,
    /// Moving elements, filled up with idle ones to a number that has its own code.
    size: usize,
    couple: Vec<Vec<f64>>,
    law: Vec<Law>,
    arm: Vec<f64>,
    share: Vec<f64>,
    /// Relative speeds over the prescribed ones.
    slide: Vec<Vec<f64>>,
    /// `f⁰` over the features.
    free: Vec<Vec<f64>>,
    /// Linear outputs over the features and, after them, over `h`; zeros left out.
    table: Vec<Vec<(usize, f64)>>,
    features: usize,
    /// Whether every load has one solution; if not, for which patterns that holds where all elements
    /// slide, and where some are at rest.
    certified: bool,
    regular: Vec<[bool; 2]>,
}

/// Work arrays of a chunk, one slot for each element: side by side in memory, or the compiler would
/// have to prove too many arrays apart to vectorise.
#[derive(Clone, Debug)]
pub(super) struct Lanes(Vec<Slot>);

#[derive(Clone, Debug)]
struct Slot {
    free: [f64; CHUNK],
    slide: [f64; CHUNK],
    force: [f64; CHUNK],
    lost: [f64; CHUNK],
    /// Of the point; the first slot's counts.
    state: [f64; CHUNK],
}

impl Lanes {
    pub fn new(iterated: Option<&Iterated>) -> Self {
        let zero = [0.0; CHUNK];
        let slot = Slot { free: zero, slide: zero, force: zero, lost: zero, state: zero };
        Self(vec![slot; iterated.map_or(0, |i| i.size)])
    }
}

/// Calls a method that is generic over the number of moving elements with that number.
macro_rules! by_size {
    ($size:expr, $self:ident . $call:ident ( $($argument:expr),* )) => {
        match $size {
            1 => $self.$call::<1>($($argument),*),
            2 => $self.$call::<2>($($argument),*),
            3 => $self.$call::<3>($($argument),*),
            4 => $self.$call::<4>($($argument),*),
            6 => $self.$call::<6>($($argument),*),
            8 => $self.$call::<8>($($argument),*),
            _ => $self.$call::<12>($($argument),*),
        }
    };
}

impl Iterated {
    pub fn new(p: &Parts, moving: &[usize], features: usize, regular: &dyn Fn(&[[f64; 2]]) -> bool) -> Self {
        let (k, m) = (p.columns.len(), moving.len());
        // Without loss in what moves; the rest has one ρ.
        let rho = |j: usize| if moving.contains(&j) { 1.0 } else { p.columns[j].rho[0] };
        let matrix = nalgebra::DMatrix::from_fn(k, k, |r, j| {
            p.columns[j].entries.iter().filter(|e| e.0 == r).map(|e| e.1 + e.2 * rho(j)).sum()
        });
        // Right-hand sides: the features, then the slope of each moving column.
        let right = nalgebra::DMatrix::from_fn(k, features + m, |r, i| match i.checked_sub(features) {
            None => p.right[i][r],
            Some(i) => p.columns[moving[i]].entries.iter().filter(|e| e.0 == r).map(|e| e.2).sum(),
        });
        let lu = matrix.clone().lu();
        let solve = |b: &nalgebra::DMatrix<f64>| lu.solve(b).expect("regular without losses: checked by the statics");
        let x = solve(&right);
        let x = &x + solve(&(&right - &matrix * &x));

        let size =
            [1, 2, 3, 4, 6, 8, 12].into_iter().find(|s| *s >= m).expect("bounded by the limit on moving elements");
        let pad = |mut v: Vec<f64>, n: usize| {
            v.resize(n, 0.0);
            v
        };
        let row = |j: &usize, range: Range<usize>| x.row(*j).columns_range(range).iter().copied().collect::<Vec<f64>>();
        let mut couple: Vec<_> = moving.iter().map(|j| pad(row(j, features..features + m), size)).collect();
        couple.resize(size, vec![0.0; size]);
        let mut law: Vec<Law> =
            moving.iter().map(|&j| p.columns[j].law.unwrap_or_else(|| Law::constant(p.columns[j].rho))).collect();
        law.resize(size, Law::default());
        let share = law.iter().map(|l| {
            let most = if l.most.is_finite() { l.most } else { l.c[0].max(l.c[1]) };
            most / (1.0 - most)
        });
        let share = share.collect();
        let table = (0..p.linear).map(|o| {
            let column = (0..features + m).map(|i| {
                let own = match i.checked_sub(features) {
                    None => p.direct[i][o],
                    Some(i) => -p.per_force[moving[i]][1][o],
                };
                let terms = (0..k).map(|j| x[(j, i)] * (p.per_force[j][0][o] + rho(j) * p.per_force[j][1][o]));
                let (sum, sizes) = terms.chain([own]).fold((0.0, 0.0), |(s, n), t| (s + t, n + f64::abs(t)));
                // What cancels is no dependence.
                (i, if sum.abs() <= 16.0 * f64::EPSILON * sizes { 0.0 } else { sum })
            });
            column.filter(|(_, c)| *c != 0.0).collect()
        });
        let regular = match p.certified {
            true => vec![],
            false => (0..1usize << m)
                .map(|pattern| {
                    [false, true].map(|rests| {
                        let mut bounds: Vec<[f64; 2]> = p.columns.iter().map(|c| [c.rho[0]; 2]).collect();
                        for (bit, &j) in moving.iter().enumerate() {
                            let [low, high] = p.columns[j].rho;
                            let steady = !rests && p.columns[j].law.is_none_or(|l| l.exponent == 0.0);
                            bounds[j] = match pattern >> bit & 1 == 1 {
                                true => [if steady { high } else { 1.0 }, high],
                                false => [low, if steady { low } else { 1.0 }],
                            };
                        }
                        regular(&bounds)
                    })
                })
                .collect(),
        };
        Self {
            moving: m,
            size,
            couple,
            law,
            arm: pad(moving.iter().map(|&j| p.columns[j].arm).collect(), size),
            share,
            slide: moving.iter().map(|&j| p.columns[j].relative.clone()).collect(),
            free: moving.iter().map(|j| row(j, 0..features)).collect(),
            table: table.collect(),
            features,
            certified: p.certified,
            regular,
        }
    }

    fn system<const K: usize>(&self) -> System<K> {
        System {
            couple: std::array::from_fn(|i| std::array::from_fn(|j| self.couple[i][j])),
            law: std::array::from_fn(|j| self.law[j]),
            arm: std::array::from_fn(|j| self.arm[j]),
            share: std::array::from_fn(|j| self.share[j]),
        }
    }

    /// One point: features, relative speeds of the moving elements.
    pub fn point(&self, x: &[f64], slide: &[f64], out: &mut [f64]) -> PointVerdict {
        by_size!(self.size, self.one(x, slide, out))
    }

    fn one<const K: usize>(&self, x: &[f64], slide: &[f64], out: &mut [f64]) -> PointVerdict {
        let slide: [f64; K] = std::array::from_fn(|j| if j < self.moving { slide[j] } else { 0.0 });
        let free = std::array::from_fn(|j| if j < self.moving { dot(&self.free[j], x) } else { 0.0 });
        match self.finish(&self.system::<K>(), 0, &free, &slide, free) {
            (verdict, Some(lost)) => {
                for (o, row) in out.iter_mut().zip(&self.table) {
                    let value = |i: usize| if i < self.features { x[i] } else { lost[i - self.features] };
                    *o = row.iter().fold(0.0, |s, &(i, c)| s + c * value(i));
                }
                verdict
            }
            (verdict, None) => {
                out.fill(f64::NAN);
                verdict
            }
        }
    }

    /// A chunk of points, `x` being the features and those in `speeds` the prescribed speeds;
    /// returns how many points are not unique.
    #[expect(clippy::too_many_arguments, reason = "the parts of a workspace, borrowed apart")]
    pub fn chunk(
        &self,
        arch: Arch,
        x: &[&[f64]],
        speeds: Range<usize>,
        range: Range<usize>,
        w: &mut Lanes,
        linear: &mut [[f64; CHUNK]],
        to: &mut Target<'_, '_>,
    ) -> usize {
        let n = range.len();
        for (j, slot) in w.0.iter_mut().enumerate().take(self.moving) {
            combine(arch, x, &self.free[j], &mut slot.free[..n]);
            combine(arch, &x[speeds.clone()], &self.slide[j], &mut slot.slide[..n]);
            slot.force[..n].copy_from_slice(&slot.free[..n]);
        }
        w.0[0].state[..n].fill(OPEN);
        let odd = by_size!(self.size, self.settle(arch, n, w));
        for (o, row) in self.table.iter().enumerate() {
            let mut inputs: [&[f64]; MOST_TERMS] = [&[]; MOST_TERMS];
            let mut factors = [0.0; MOST_TERMS];
            for ((slot, factor), &(i, c)) in inputs.iter_mut().zip(&mut factors).zip(row) {
                (*slot, *factor) = (if i < self.features { x[i] } else { &w.0[i - self.features].lost[..n] }, c);
            }
            let out = to.slice(o, linear, range.clone());
            combine(arch, &inputs[..row.len()], &factors[..row.len()], out);
            if odd > 0 {
                out.iter_mut().zip(&w.0[0].state).filter(|(_, s)| **s == OPEN).for_each(|(o, _)| *o = f64::NAN);
            }
        }
        odd
    }

    /// Settles the points of a chunk; returns how many are not unique.
    fn settle<const K: usize>(&self, arch: Arch, n: usize, w: &mut Lanes) -> usize {
        let slots: &mut [Slot; K] = (&mut w.0[..]).try_into().expect("as many slots as elements");
        let system = &self.system::<K>();
        let (mut open, mut odd, mut round) = (n, 0, 0);
        if self.certified {
            // A few points are cheaper one by one than in another pass over all.
            while open > n / 8 && round < ROUNDS {
                let (left, full) = arch.dispatch(Pass::<K> { system, slots, n });
                (open, odd, round) = (left, full, round + 1);
            }
        }
        if open == 0 {
            return odd;
        }
        for i in 0..n {
            if slots[0].state[i] != OPEN {
                continue;
            }
            let [free, slide, force] = [0, 1, 2]
                .map(|what| std::array::from_fn(|j| [&slots[j].free, &slots[j].slide, &slots[j].force][what][i]));
            let (verdict, found) = self.finish(system, round, &free, &slide, force);
            odd += usize::from(verdict != PointVerdict::Unique);
            if let Some(found) = found {
                slots[0].state[i] = SETTLED;
                (0..K).for_each(|j| slots[j].lost[i] = found[j]);
            }
        }
        odd
    }

    /// What is left to do at a point after some rounds: verdict, and what friction takes.
    #[inline(never)]
    fn finish<const K: usize>(
        &self,
        system: &System<K>,
        rounds: usize,
        free: &[f64; K],
        slide: &[f64; K],
        mut force: [f64; K],
    ) -> (PointVerdict, Option<[f64; K]>) {
        let unique = |full: bool| if full { PointVerdict::OutOfRange } else { PointVerdict::Unique };
        if self.certified {
            for _ in rounds..ROUNDS {
                let r = system.round::<false>(free, slide, &force, natural);
                if r.settled {
                    return (unique(r.full), Some(r.lost));
                }
                force = r.force;
            }
            if let Some(r) = system.newton(free, slide, natural) {
                return (unique(r.full), Some(r.lost));
            }
        }
        // Every pattern, with losses that keep its drivers: smooth, so that a pattern without singular
        // systems has one candidate, which is a solution if it has those drivers.
        let mut solution: Option<Round<K>> = None;
        let mut decided = true;
        let rests = usize::from(slide[..self.moving].contains(&0.0));
        for pattern in 0..1usize << self.moving {
            if (0..self.moving).any(|b| slide[b] == 0.0 && pattern >> b & 1 == 1) {
                continue;
            }
            decided &= self.certified || self.regular[pattern][rests];
            let Some(r) = system.newton(free, slide, |j, _| pattern >> j & 1 == 0) else {
                decided = false;
                continue;
            };
            let fits = (0..self.moving).all(|j| {
                let drive = r.force[j] * slide[j];
                if pattern >> j & 1 == 0 { drive >= 0.0 } else { drive < 0.0 }
            });
            if fits && self.certified {
                return (unique(r.full), Some(r.lost));
            }
            if fits && let Some(first) = solution {
                return (PointVerdict::Multiple, Some(first.lost));
            }
            if fits {
                solution = Some(r);
            }
        }
        match solution {
            Some(r) if decided => (unique(r.full), Some(r.lost)),
            Some(r) => (PointVerdict::Undecided, Some(r.lost)),
            None if decided && !self.certified => (PointVerdict::Locked, None),
            None => (PointVerdict::NotConverged, None),
        }
    }
}

/// Most quantities in an output.
const MOST_TERMS: usize = MOST_FEATURES + MOST_MOVING;

/// p drives where power goes into it.
#[inline(always)]
fn natural(_: usize, drive: f64) -> bool {
    drive >= 0.0
}

/// Forces and what friction takes of them after a round.
#[derive(Clone, Copy)]
struct Round<const K: usize> {
    force: [f64; K],
    lost: [f64; K],
    settled: bool,
    /// Whether a law is at its ceiling.
    full: bool,
}

/// A loop over elements that is certainly unrolled, as it must be to be vectorised over points.
macro_rules! each {
    ($count:ident, $j:ident, $body:block) => {
        each!($count, $j, $body, 0 1 2 3 4 5 6 7 8 9 10 11)
    };
    ($count:ident, $j:ident, $body:block, $($at:literal)+) => {
        $(if $at < $count {
            let $j = $at;
            $body
        })+
    };
}

impl<const K: usize> System<K> {
    /// One round of Newton's method from `force`. `forward` says from the power into end p whether p
    /// drives.
    #[inline(always)]
    fn round<const EXCHANGE: bool>(
        &self,
        free: &[f64; K],
        slide: &[f64; K],
        force: &[f64; K],
        forward: impl Fn(usize, f64) -> bool,
    ) -> Round<K> {
        let (mut lost, mut slope, mut bound, mut per_size) = ([0.0; K], [0.0; K], [0.0; K], [0.0; K]);
        let (mut laws, mut full) = ([0.0; K], false);
        each!(K, j, {
            let (law, speed) = (&self.law[j], slide[j].abs());
            let torque = self.arm[j] * force[j].abs();
            let size = torque + law.torque;
            let size = if size > TINY { size } else { TINY };
            let ahead = forward(j, force[j] * slide[j]);
            let c = if ahead { law.c[0] } else { law.c[1] };
            let by_law = c * power(size / (speed + law.speed), law.exponent);
            let over = by_law > law.most && speed > 0.0;
            let loss = if over { law.most } else { by_law };
            let loss = if speed > 0.0 { loss } else { 0.0 };
            let exponent = if over { 0.0 } else { law.exponent };
            full |= over;
            // Of the force on p: λ when p drives, −λ/(1 − λ) when q does.
            let m = if ahead { 1.0 } else { 1.0 / (1.0 - loss) };
            let part = if ahead { loss } else { -loss * m };
            per_size[j] = 1.0 / size;
            lost[j] = part * force[j];
            slope[j] = part * (1.0 + exponent * (torque * per_size[j]) * m);
            bound[j] = REMAINDER * law.exponent * loss * (m * m) * size * speed;
            laws[j] = by_law;
        });
        let mut matrix = self.couple;
        let mut right = *free;
        for i in 0..K {
            for j in 0..K {
                right[i] += matrix[i][j] * (lost[j] - slope[j] * force[j]);
                matrix[i][j] = if i == j { 1.0 } else { 0.0 } - matrix[i][j] * slope[j];
            }
        }
        let sound =
            if EXCHANGE { eliminate_exchanging(&mut matrix, &mut right) } else { eliminate(&mut matrix, &mut right) };
        // How far what was taken as linear is from the laws, in power.
        let (mut error, mut all_lost, mut through, mut near) = (0.0, 0.0, 0.0, true);
        for j in 0..K {
            let change = right[j] - force[j];
            lost[j] += slope[j] * change;
            let step = change.abs() * self.arm[j] * per_size[j];
            near &= step <= REACH || bound[j] == 0.0;
            // A kink at the ceiling on the way: first order.
            let order = if laws[j] * (1.0 + 2.0 * step) > self.law[j].most { 1.0 } else { step };
            error += bound[j] * step * order;
            let unit = self.arm[j] * slide[j].abs();
            let crossed = forward(j, right[j] * slide[j]) != forward(j, force[j] * slide[j]);
            let kink = (lost[j].abs() + self.share[j] * right[j].abs()) * unit;
            error += if crossed { kink } else { 0.0 };
            all_lost += lost[j].abs() * unit;
            through += right[j].abs() * unit;
        }
        let settled = sound & near & (error <= TOLERANCE * all_lost + ROUND_OFF * through);
        Round { force: right, lost, settled, full }
    }

    /// Rounds with row exchange until they settle.
    fn newton(
        &self,
        free: &[f64; K],
        slide: &[f64; K],
        forward: impl Fn(usize, f64) -> bool + Copy,
    ) -> Option<Round<K>> {
        let mut force = *free;
        for _ in 0..MORE_ROUNDS {
            let r = self.round::<true>(free, slide, &force, forward);
            if r.settled {
                return Some(r);
            }
            force = r.force;
        }
        None
    }
}

/// Smallest number that is raised to a power.
const TINY: f64 = 1e-300;

/// Solves a system whose matrix is near the identity; false where a pivot is small.
#[inline(always)]
fn eliminate<const K: usize>(m: &mut [[f64; K]; K], x: &mut [f64; K]) -> bool {
    let mut sound = true;
    for c in 0..K {
        sound &= m[c][c] > SOUND;
        let pivot = 1.0 / m[c][c];
        for r in c + 1..K {
            let factor = m[r][c] * pivot;
            for n in c + 1..K {
                m[r][n] -= factor * m[c][n];
            }
            x[r] -= factor * x[c];
        }
        m[c][c] = pivot;
    }
    for c in (0..K).rev() {
        for n in c + 1..K {
            x[c] -= m[c][n] * x[n];
        }
        x[c] *= m[c][c];
    }
    sound
}

/// The same with row exchange; false where the matrix is singular.
fn eliminate_exchanging<const K: usize>(m: &mut [[f64; K]; K], x: &mut [f64; K]) -> bool {
    for c in 0..K {
        let pivot = (c..K).max_by(|&a, &b| m[a][c].abs().total_cmp(&m[b][c].abs())).unwrap_or(c);
        if m[pivot][c] == 0.0 {
            return false;
        }
        m.swap(pivot, c);
        x.swap(pivot, c);
        for r in c + 1..K {
            let factor = m[r][c] / m[c][c];
            for n in c + 1..K {
                m[r][n] -= factor * m[c][n];
            }
            x[r] -= factor * x[c];
        }
    }
    for c in (0..K).rev() {
        let sum: f64 = (c + 1..K).map(|n| m[c][n] * x[n]).sum();
        x[c] = (x[c] - sum) / m[c][c];
    }
    true
}

/// `x^p` for `0 ≤ p ≤ 1`, to a relative 1e-13 where 1e-100 < x < 1e100; `x` is taken between 1e-300
/// and 1e300, NaN as the former. Polynomials by Chebyshev interpolation: `log₂ m = s P(s²)`,
/// `s = (m − 1)/(m + 1)` for `√½ ≤ m < √2`; `2^r = 1 + r Q(r)` for `|r| ≤ ½`.
#[inline(always)]
fn power(x: f64, p: f64) -> f64 {
    const P: [f64; 6] = [
        2.885390081777851,
        0.9617966941122649,
        0.5770779426603044,
        0.41220922406110433,
        0.31990680380701336,
        0.28288502340748234,
    ];
    const Q: [f64; 9] = [
        std::f64::consts::LN_2,
        0.2402265069581299,
        0.055504108664760424,
        0.009618129159402558,
        0.0013333558179043112,
        0.00015403455852453838,
        1.525268684626772e-5,
        1.3255224878668817e-6,
        1.0203121063391729e-7,
    ];
    /// Bits of 1 less those of √½.
    const SHIFT: u64 = 1.0_f64.to_bits() - std::f64::consts::FRAC_1_SQRT_2.to_bits();
    /// Numbers so large that their last bits are an integer: 2⁵², and 1.5 · 2⁵².
    const WHOLE: f64 = 4503599627370496.0;
    const ROUND: f64 = 6755399441055744.0;
    #[inline(always)]
    fn horner<const N: usize>(c: &[f64; N], x: f64) -> f64 {
        let mut y = c[N - 1];
        for k in (0..N - 1).rev() {
            y = y * x + c[k];
        }
        y
    }
    let x = if x > TINY { x } else { TINY };
    let x = if x < 1e300 { x } else { 1e300 };
    let bits = x.to_bits();
    // x = 2^n m; n with the bias of floating point numbers.
    let n = bits.wrapping_add(SHIFT) >> 52;
    let m = f64::from_bits(bits.wrapping_sub(n << 52).wrapping_add(1.0_f64.to_bits()));
    let n = f64::from_bits(n | WHOLE.to_bits()) - (WHOLE + 1023.0);
    let s = (m - 1.0) / (m + 1.0);
    let y = p * (n + s * horner(&P, s * s));
    let whole = y + ROUND;
    let r = y - (whole - ROUND);
    f64::from_bits((1.0 + r * horner(&Q, r)).to_bits().wrapping_add(whole.to_bits() << 52))
}

lanes! {
    /// One round at every open point of a chunk; returns how many stay open, and how many have a law
    /// at its ceiling.
    Pass<'a, const K> { system: &'a System<K>, slots: &'a mut [Slot; K], n: usize } -> (usize, usize) {
        let system = *system;
        let n = n.min(CHUNK);
        let (mut open, mut full) = (0.0, 0.0);
        let (mut a, mut v, mut f) = ([0.0; K], [0.0; K], [0.0; K]);
        for i in 0..n {
            for j in 0..K {
                (a[j], v[j], f[j]) = (slots[j].free[i], slots[j].slide[i], slots[j].force[i]);
            }
            let r = system.round::<false>(&a, &v, &f, natural);
            let was = slots[0].state[i];
            for j in 0..K {
                slots[j].force[i] = if was == OPEN { r.force[j] } else { f[j] };
                slots[j].lost[i] = if was == OPEN { r.lost[j] } else { slots[j].lost[i] };
            }
            let found = if r.full { FULL } else { SETTLED };
            let now = if r.settled { found } else { OPEN };
            slots[0].state[i] = if was == OPEN { now } else { was };
        }
        for state in &slots[0].state[..n] {
            open += if *state == OPEN { 1.0 } else { 0.0 };
            full += if *state == FULL { 1.0 } else { 0.0 };
        }
        (open as usize, full as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::power;

    #[test]
    fn powers_are_those_of_the_library() {
        let mut worst: f64 = 0.0;
        for p in [0.0, 0.05, 0.2, 0.25, 0.5, 0.999] {
            assert_eq!(power(3.7, p * 0.0), 1.0);
            for k in -40_000..40_000 {
                let x = (f64::from(k) * 0.00575).exp();
                worst = worst.max((power(x, p) / x.powf(p) - 1.0).abs());
            }
        }
        assert!(worst < 1e-13, "{worst:e}");
        assert_eq!((power(0.0, 0.0), power(f64::NAN, 0.0), power(f64::INFINITY, 0.0)), (1.0, 1.0, 1.0));
        assert!(power(0.0, 0.2) < 1e-59 && power(f64::INFINITY, 0.2) < 1.01e60);
    }
}
