//! The ratio of every state of a layout, computed once.
//!
//! A state closes `M - 1` elements with points `e`. Its ratio of input to output speed is the quotient of two
//! determinants, `det(v_in, e, ...) / det(v_out, e, ...)` (Cramer). If either is zero, the state is none: the closed
//! elements leave more than one freedom, or an end is at rest. States are numbered in colexicographic order: state
//! `{a < b < c}` is number `C(a,1) + C(b,2) + C(c,3)`, so determinants of all states with the same last point lie in a
//! row and are computed in loops without a branch.
//!
//! Determinants are floating point. Their error is below 1e-13 because all coordinates are at most 1; where that, or a
//! bound that is touched, leaves something open, it is decided by exact arithmetic.

use willis::exact::Rational;

use super::layout::Layout;
use super::motion::{self, MAX_MOBILITY};
use super::points::Points;
use willis::exact::residue;

/// Numbers that differ by less, as a fraction, may be equal.
pub(crate) const NEAR: f64 = 1e-8;

/// Room for numbers of ratios. Where it is used up, further ratios count as different: less is excluded, nothing wrong.
const SLOTS: usize = 1 << 13;

/// `C(n, k)` for small numbers.
pub(crate) fn binomial(n: usize, k: usize) -> usize {
    if k > n { 0 } else { (0..k).fold(1, |c, j| c * (n - j) / (j + 1)) }
}

/// A closed window, exact and as floating point; an end that is left out does not bound.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Window {
    /// Lower and upper end: exact, its class modulo the prime as numerator and denominator, floating point.
    pub(crate) low: Option<Bound>,
    pub(crate) high: Option<Bound>,
    min: f64,
    max: f64,
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Bound {
    value: Rational,
    /// None where the bound has so many digits that no ratio touches it.
    class: Option<[u64; 2]>,
}

impl Bound {
    fn new(value: &Rational) -> Self {
        let text = value.to_fraction();
        let class = |part: &str| Some(residue::of(part.parse().ok()?));
        let class = text.split_once('/').and_then(|(a, b)| Some([class(a)?, class(b)?]));
        Self { value: value.clone(), class }
    }
}

impl Window {
    pub(crate) fn new(low: Option<&Rational>, high: Option<&Rational>) -> Self {
        let (min, max) = (low.map_or(0.0, Rational::to_f64), high.map_or(f64::INFINITY, Rational::to_f64));
        Self { low: low.map(Bound::new), high: high.map(Bound::new), min, max }
    }

    /// Whether a positive quotient lies in it, where floating point decides.
    fn plainly(&self, value: f64) -> Option<bool> {
        if value > self.min * (1.0 + NEAR) && value < self.max * (1.0 - NEAR) {
            Some(true)
        } else if value < self.min * (1.0 - NEAR) || value > self.max * (1.0 + NEAR) {
            Some(false)
        } else {
            None
        }
    }

    /// Whether a quotient `top/bottom` known by its classes, or else by its exact value, lies in it.
    fn exactly(&self, top: u64, bottom: u64, exact: &dyn Fn() -> Option<Rational>) -> bool {
        let touches = |b: &Bound| b.class.is_some_and(|[p, q]| residue::times(top, q) == residue::times(bottom, p));
        if self.low.iter().chain(&self.high).any(touches) {
            return true;
        }
        let Some(value) = exact() else { return false };
        self.low.as_ref().is_none_or(|b| value >= b.value) && self.high.as_ref().is_none_or(|b| value <= b.value)
    }
}

/// What a state is good for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// It can be a forward gear.
    Forward,
    /// It can be a reverse gear.
    Reverse,
    /// It can be neither.
    Bad,
}

/// What the search over choices knows of a state: in the lowest 16 bits the number of its ratio if it is a forward gear,
/// else 0; above them, eight bits each, whether it is no forward gear and whether it is no gear at all.
pub(crate) type Info = u32;
/// A forward gear whose ratio has no number of its own.
pub(crate) const UNNUMBERED: Info = 1;
/// A reverse gear.
const REVERSE: Info = 1 << 16;
/// No gear.
const BAD: Info = 1 << 16 | 1 << 24;

/// What the ratios of a wish are compared with.
#[derive(Clone, Debug)]
pub(crate) struct Ranges {
    pub(crate) forward: Window,
    /// None where no reverse gear is wanted.
    pub(crate) reverse: Option<Window>,
    pub(crate) step: Window,
    /// Two ratios in a chain differ by so much that two that are nearly equal are never both in it.
    coarse: bool,
    /// The window of steps, a little too wide.
    pub(crate) about: [f64; 2],
}

impl Ranges {
    pub(crate) fn new(forward: Window, reverse: Option<Window>, step: Window) -> Self {
        let coarse = step.min > 1.0 + 1e-6;
        let about = [step.min.max(1.0) * (1.0 - 2.0 * NEAR), step.max * (1.0 + 2.0 * NEAR)];
        Self { forward, reverse, step, coarse, about }
    }
}

impl Ranges {
    /// Whether two ratios that are nearly equal are never both in a chain.
    pub(crate) fn is_coarse(&self) -> bool {
        self.coarse
    }
}

/// A part of a form: its coordinate in the form before, its coordinate in the point, whether it is subtracted.
type Term = (usize, usize, bool);

/// How forms of one degree come from forms of the degree below and a vector.
#[derive(Clone, Debug, Default)]
struct Step(Vec<Vec<Term>>);

fn steps(mobility: usize) -> Vec<Step> {
    let sets = |degree: usize| -> Vec<usize> {
        (1..1 << mobility).filter(|s: &usize| s.count_ones() as usize == degree).collect()
    };
    (2..=mobility)
        .map(|degree| {
            let before = sets(degree - 1);
            let terms = |set: usize| -> Vec<Term> {
                let bits = (0..mobility).filter(|i| set >> i & 1 == 1);
                bits.map(|i| {
                    let from = before.iter().position(|s| *s == set ^ 1 << i).unwrap_or(0);
                    (from, i, (set >> (i + 1)).count_ones() % 2 == 1)
                })
                .collect()
            };
            Step(sets(degree).into_iter().map(terms).collect())
        })
        .collect()
}

/// The ratios of a layout.
#[derive(Clone, Debug, Default)]
pub(crate) struct Table {
    steps: Vec<Step>,
    forms: [Vec<Vec<Vec<f64>>>; 2],
    /// `choose[j][c]` is `C(c, j)`.
    pub(crate) choose: Vec<Vec<usize>>,
    /// Ratio of every state; what it is where the state is bad is left open.
    pub(crate) ratio: Vec<f64>,
    /// What the search knows of every state.
    pub(crate) info: Vec<Info>,
    /// For every set of `M - 2` points, by its number: the points, as bits, with which it is no forward gear, and with
    /// which it is no gear.
    pub(crate) wasted: Vec<[u64; 2]>,
    /// Numbers of ratios are below this.
    pub(crate) numbers: usize,
    /// The numbers of ratios, found by their leading digits.
    slots: Vec<Slot>,
    /// Slots of an earlier layout are empty.
    round: u32,
}

/// A place for a ratio: when it was filled, the leading digits, the first state, the number.
type Slot = (u32, u64, u32, u16);

impl Table {
    /// A table for layouts of one mobility.
    pub(crate) fn new(mobility: usize) -> Self {
        let choose =
            (0..=MAX_MOBILITY).map(|j| (0..=2 * super::points::MAX_POINTS).map(|c| binomial(c, j)).collect()).collect();
        Self { steps: steps(mobility), choose, slots: vec![(0, 0, 0, 0); SLOTS], ..Self::default() }
    }

    /// The points of a state.
    pub(crate) fn members(&self, mut state: usize, closed: usize) -> [usize; MAX_MOBILITY] {
        let mut all = [0; MAX_MOBILITY];
        for j in (1..=closed).rev() {
            let mut c = j - 1;
            while self.choose[j][c + 1] <= state {
                c += 1;
            }
            state -= self.choose[j][c];
            all[j - 1] = c;
        }
        all
    }

    /// Computes the ratios of all states of a layout with these points.
    pub(crate) fn fill(&mut self, points: &Points, ranges: &Ranges, exact: &Exact<'_>) {
        let (mobility, count) = (points.mobility, points.len());
        let closed = mobility - 1;
        for end in 0..2 {
            let forms = &mut self.forms[end];
            forms.resize(closed + 1, vec![]);
            forms[0] = (0..mobility).map(|i| vec![points.ends[end].0[i]]).collect();
            for j in 1..=closed {
                let step = &self.steps[j - 1];
                let (below, here) = forms.split_at_mut(j);
                let (below, here) = (&below[j - 1], &mut here[0]);
                let size = self.choose[j][count];
                here.resize(step.0.len(), vec![]);
                for (terms, out) in step.0.iter().zip(here) {
                    out.resize(size, 0.0);
                    for c in j - 1..count {
                        let (base, length) = (self.choose[j][c], self.choose[j - 1][c]);
                        let out = &mut out[base..base + length];
                        for (n, (from, i, negative)) in terms.iter().enumerate() {
                            let factor = if *negative { -points.place[*i][c] } else { points.place[*i][c] };
                            let from = &below[*from][..length];
                            match n {
                                0 => out.iter_mut().zip(from).for_each(|(o, f)| *o = factor * f),
                                _ => out.iter_mut().zip(from).for_each(|(o, f)| *o += factor * f),
                            }
                        }
                    }
                }
            }
        }
        let weak = if mobility < 5 { 1e-4 } else { 1e-3 };
        let size = self.choose[closed][count];
        let [top, bottom] = [0, 1].map(|end| &self.forms[end][closed][0][..size]);
        self.ratio.clear();
        self.ratio.extend(top.iter().zip(bottom).map(|(t, b)| t / b * points.scale));
        self.info.clear();
        self.info.resize(size, BAD);
        self.numbers = 1 + UNNUMBERED as usize;
        self.round += 1;
        let scale = points.scale.abs();
        for state in 0..size {
            let (t, b, mut ratio) = (top[state].abs(), bottom[state].abs(), self.ratio[state]);
            if t < weak || b < weak {
                // Nearly no output speed, or nearly no input speed: outside every window, whatever the error is.
                let beyond = |w: &Window| {
                    (t >= weak && scale * 0.9 * t / (b + 1e-12) > w.max)
                        || (b >= weak && scale * 1.1 * (t + 1e-12) / b < w.min)
                };
                if beyond(&ranges.forward) && ranges.reverse.as_ref().is_none_or(&beyond) {
                    continue;
                }
                match exact.ratio(&self.members(state, closed)[..closed]) {
                    Some(value) => ratio = value,
                    None => continue,
                }
                self.ratio[state] = ratio;
            }
            let window = if ratio > 0.0 {
                &ranges.forward
            } else if let Some(reverse) = &ranges.reverse {
                reverse
            } else {
                continue;
            };
            let inside = match window.plainly(ratio.abs()) {
                Some(inside) => inside,
                None => exact.within(&self.members(state, closed)[..closed], window, ratio < 0.0),
            };
            if !inside {
                continue;
            }
            self.info[state] = if ratio < 0.0 { REVERSE } else { UNNUMBERED };
        }
        for state in 0..size {
            if self.info[state] == UNNUMBERED {
                self.info[state] = self.number(state, closed, ranges.coarse, exact);
            }
        }
        self.waste(closed, count);
    }

    /// The sets of points that are no gear with another point.
    fn waste(&mut self, closed: usize, count: usize) {
        self.wasted.clear();
        self.wasted.resize(self.choose[closed - 1][count], [0; 2]);
        // The points of each state, in the order of the states.
        let mut members: [usize; MAX_MOBILITY] = std::array::from_fn(|j| j);
        for info in &self.info {
            if info & 0xFFFF == 0 {
                let is_bad = (info >> 24) as u64;
                // The number of the state without one of its points: later points move down by one place.
                let mut without: usize = (1..closed).map(|j| self.choose[j][members[j]]).sum();
                for j in 0..closed {
                    let bit = 1_u64 << members[j];
                    let masks = &mut self.wasted[without];
                    masks[0] |= bit;
                    masks[1] |= bit * is_bad;
                    if j + 1 < closed {
                        without += self.choose[j + 1][members[j]];
                        without -= self.choose[j + 1][members[j + 1]];
                    }
                }
            }
            let mut at = 0;
            while at + 1 < closed && members[at] + 1 == members[at + 1] {
                members[at] = at;
                at += 1;
            }
            members[at] += 1;
        }
    }

    /// The number of a forward ratio. Two states have one number only if a chain never has both: their ratios are
    /// equal, or so near that there is no step between them.
    fn number(&mut self, state: usize, closed: usize, coarse: bool, exact: &Exact<'_>) -> Info {
        const DROPPED: u32 = 28;
        // 24 leading bits, rounded: differences of 1e-7 and less.
        let digits = (self.ratio[state].to_bits() + (1 << (DROPPED - 1))) >> DROPPED;
        let mut at = (digits.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 51) as usize;
        loop {
            let (round, known, first, number) = self.slots[at];
            if round != self.round {
                break;
            }
            if known == digits {
                let [one, other] = [first as usize, state].map(|s| self.members(s, closed));
                let is_same = coarse || exact.is_same(&one[..closed], &other[..closed]);
                return if is_same { Info::from(number) } else { UNNUMBERED };
            }
            at = (at + 1) % SLOTS;
        }
        if self.numbers >= SLOTS / 2 {
            return UNNUMBERED;
        }
        let fresh = self.numbers as u16;
        self.slots[at] = (self.round, digits, state as u32, fresh);
        self.numbers += 1;
        Info::from(fresh)
    }

    /// What a state is good for.
    pub(crate) fn kind(&self, state: usize) -> Kind {
        match self.info[state] {
            REVERSE => Kind::Reverse,
            BAD => Kind::Bad,
            _ => Kind::Forward,
        }
    }

    /// Whether the ratio of one state is below that of another.
    pub(crate) fn is_less(&self, one: usize, other: usize, closed: usize, ranges: &Ranges, exact: &Exact<'_>) -> bool {
        let (a, b) = (self.ratio[one], self.ratio[other]);
        if ranges.coarse || (a / b - 1.0).abs() > NEAR {
            return a < b;
        }
        let (one, other) = (self.members(one, closed), self.members(other, closed));
        exact.is_less(&one[..closed], &other[..closed])
    }

    /// Whether a chain can pass from one forward gear to another: the quotient of their ratios is above 1 and in the
    /// window of steps.
    pub(crate) fn is_step(&self, from: usize, to: usize, closed: usize, ranges: &Ranges, exact: &Exact<'_>) -> bool {
        let quotient = self.ratio[from] / self.ratio[to];
        if quotient <= 1.0 - NEAR {
            return false;
        }
        let falls = (quotient > 1.0 + NEAR).then_some(true);
        match (falls, ranges.step.plainly(quotient)) {
            (Some(true), Some(inside)) => inside,
            (_, Some(false)) => false,
            _ => {
                let (from, to) = (self.members(from, closed), self.members(to, closed));
                exact.is_step(&from[..closed], &to[..closed], ranges)
            }
        }
    }
}

/// Exact answers about the states of a layout.
pub(crate) struct Exact<'a> {
    pub(crate) layout: &'a Layout,
    pub(crate) ratios: &'a [Rational],
    pub(crate) points: &'a Points,
}

impl Exact<'_> {
    /// The ratio of a state as a rational number; none where the state is none.
    pub(crate) fn rational(&self, state: &[usize]) -> Option<Rational> {
        let closed: Vec<[u8; 2]> = state.iter().map(|p| self.points.at(*p)[0]).collect();
        Some(motion::speeds(self.layout, self.ratios, &closed)?[1].recip())
    }

    fn classes(&self, state: &[usize]) -> [u64; 2] {
        [0, 1].map(|end| self.points.determinant(end, state))
    }

    fn ratio(&self, state: &[usize]) -> Option<f64> {
        if self.classes(state).contains(&0) {
            return None;
        }
        Some(self.rational(state)?.to_f64())
    }

    fn is_same(&self, one: &[usize], other: &[usize]) -> bool {
        let ([a, b], [c, d]) = (self.classes(one), self.classes(other));
        residue::times(a, d) == residue::times(b, c)
    }

    fn within(&self, state: &[usize], window: &Window, negative: bool) -> bool {
        let [top, bottom] = self.classes(state);
        let top = if negative { residue::minus(0, top) } else { top };
        window.exactly(top, bottom, &|| Some(self.rational(state)?.abs()))
    }

    fn is_less(&self, one: &[usize], other: &[usize]) -> bool {
        let ([a, b], [c, d]) = (self.classes(one), self.classes(other));
        residue::times(a, d) != residue::times(b, c) && self.rational(one) < self.rational(other)
    }

    fn is_step(&self, from: &[usize], to: &[usize], ranges: &Ranges) -> bool {
        let ([a, b], [c, d]) = (self.classes(from), self.classes(to));
        let (top, bottom) = (residue::times(a, d), residue::times(b, c));
        if top == bottom {
            return false;
        }
        let value = || Some(&self.rational(from)? / &self.rational(to)?);
        value().is_some_and(|v| v > Rational::ONE) && ranges.step.exactly(top, bottom, &value)
    }
}
