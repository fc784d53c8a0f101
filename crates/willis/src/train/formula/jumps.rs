//! Where the jumps of a formula are, before a run comes to them.
//!
//! The formula is evaluated over stretches of time instead of at times: each operator takes the least and the
//! greatest value of its operands to those of its result. Ends are rounded as the values themselves are, and rounding
//! keeps the order; so a stretch over which `floor` and its like stay at one value has no jump, and halving the
//! others finds the first one to the last digits of its time.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::num::ParseFloatError;
use std::str::FromStr;

use exmex::{BinOp, Operator};

/// Jumps closer to each other than this part of their time, or of a millisecond, count as one: several functions of a
/// formula that jump at once do so to their own rounding, and a run takes steps between jumps.
const CLOSE: f64 = 1e-12;
/// A jump is found to this part of its time, or of a millisecond.
const FOUND: f64 = 8.0 * f64::EPSILON;
/// The first stretch that is looked at, s.
const FIRST: f64 = 1e-3;
/// No jump is looked for farther ahead, s: what is found there ends a stretch at which nothing jumps.
const FAR: f64 = 1e9;
/// Most stretches that are looked at for one jump.
const LOOKS: usize = 2000;

/// A time after `t`, s, before which there is no jump: that of the first one wherever the bounds tell.
pub(super) fn next(t: f64, jumps_within: impl Fn(f64, f64) -> bool) -> f64 {
    let part = |t: f64, part: f64| part * t.abs().max(FIRST);
    let mut from = t + part(t, CLOSE);
    let mut width = FIRST;
    // The end of a stretch that may hold a jump.
    let mut within: Option<f64> = None;
    for _ in 0..LOOKS {
        let Some(to) = within else {
            let to = from + width;
            if to - t > FAR {
                return if jumps_within(from, f64::INFINITY) { to } else { f64::INFINITY };
            }
            if jumps_within(from, to) {
                within = Some(to);
            } else {
                (from, width) = (to, 2.0 * width);
            }
            continue;
        };
        width = 0.5 * (to - from);
        if to - from <= part(from, FOUND) {
            return to;
        }
        let middle = from + width;
        if jumps_within(from, middle) {
            within = Some(middle);
        } else if jumps_within(middle, to) {
            from = middle;
        } else {
            (from, within) = (to, None);
        }
    }
    from
}

/// The values of a formula over a stretch of time.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Span {
    low: f64,
    high: f64,
    /// Whether a function may jump in it.
    pub jumps: bool,
    /// Through how many periods a function that repeats itself goes, at most.
    pub turns: f64,
}

impl Span {
    pub const ALL: Self = Self { low: f64::NEG_INFINITY, high: f64::INFINITY, jumps: false, turns: 0.0 };

    /// An end that cannot be told is far out; both are not numbers outside the domain of a function.
    pub fn new(low: f64, high: f64) -> Self {
        let (low, high) = match (low.is_nan(), high.is_nan()) {
            (true, false) => (f64::NEG_INFINITY, high),
            (false, true) => (low, f64::INFINITY),
            _ => (low, high),
        };
        Self { low, high, ..Self::default() }
    }

    /// The least that holds these values.
    fn hull(values: &[f64]) -> Self {
        let (low, high) = values.iter().fold((f64::NAN, f64::NAN), |(a, b), x| (a.min(*x), b.max(*x)));
        Self::new(low, high)
    }

    fn after(self, a: Self) -> Self {
        Self { jumps: self.jumps || a.jumps, turns: self.turns.max(a.turns), ..self }
    }

    fn corners(a: Self, b: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        Self::hull(&[f(a.low, b.low), f(a.low, b.high), f(a.high, b.low), f(a.high, b.high)])
    }

    fn straddles_zero(self) -> bool {
        self.low < 0.0 && self.high > 0.0
    }

    /// What of it lies in the domain of a function.
    fn clip(self, low: f64, high: f64) -> Self {
        // Not so where it is not a number.
        let some = self.high >= low && self.low <= high;
        let (low, high) = if some { (self.low.max(low), self.high.min(high)) } else { (f64::NAN, f64::NAN) };
        Self { low, high, ..self }
    }

    fn monotonic(self, f: fn(f64) -> f64) -> Self {
        Self::hull(&[f(self.low), f(self.high)]).after(self)
    }

    /// A function that stays at one value between its jumps.
    fn level(self, f: fn(f64) -> f64) -> Self {
        let (low, high) = (f(self.low), f(self.high));
        Self { low, high, jumps: self.jumps || (low != high && !self.low.is_nan()), ..self }
    }

    fn fract(self) -> Self {
        let whole = self.level(f64::trunc);
        let of = if whole.jumps { Self::new(-1.0, 1.0) } else { Self::new(self.low.fract(), self.high.fract()) };
        of.after(whole)
    }

    fn abs(self) -> Self {
        let ends = self.monotonic(f64::abs);
        if self.straddles_zero() { Self { low: 0.0, ..ends } } else { ends }
    }

    /// Whether it holds `at`, or a place any number of periods away.
    fn holds(self, at: f64, period: f64) -> bool {
        let first = at + ((self.low - at) / period).ceil() * period;
        // Of an end that is infinite it cannot be told.
        first <= self.high || first.is_nan()
    }

    /// A function that repeats itself after `period`, of this argument.
    fn turning(self, argument: Self, period: f64) -> Self {
        let turns = (argument.high - argument.low) / period;
        Self { turns: self.turns.max(if turns.is_nan() { 0.0 } else { turns }), ..self }
    }

    /// A wave that has its greatest value, one, at `top`.
    fn wave(self, f: fn(f64) -> f64, top: f64) -> Self {
        let ends = self.monotonic(f);
        if self.low.is_nan() {
            return ends;
        }
        let low = if self.holds(top + PI, TAU) { -1.0 } else { ends.low };
        let high = if self.holds(top, TAU) { 1.0 } else { ends.high };
        Self { low, high, ..ends }.turning(self, TAU)
    }

    fn tan(self) -> Self {
        let of = if self.holds(FRAC_PI_2, PI) { Self::ALL.after(self) } else { self.monotonic(f64::tan) };
        of.turning(self, PI)
    }

    fn divided(self, by: Self) -> Self {
        let of = if by.straddles_zero() {
            Self::ALL
        } else {
            // The sign of a zero is that of the side it is approached from.
            let (low, high) = (if by.low == 0.0 { 0.0 } else { by.low }, if by.high == 0.0 { -0.0 } else { by.high });
            Self::corners(self, Self { low, high, ..by }, |a, b| a / b)
        };
        of.after(self).after(by)
    }

    fn raised(self, to: Self) -> Self {
        let power = |base: Self| Self::corners(base, to, f64::powf);
        let whole = to.low == to.high && to.low.fract() == 0.0;
        let of = if whole && to.low % 2.0 == 0.0 {
            power(self.abs())
        } else if whole && to.low > 0.0 {
            power(self)
        } else if whole {
            if self.straddles_zero() { Self::ALL } else { power(self) }
        } else {
            power(self.clip(0.0, f64::INFINITY))
        };
        of.after(self).after(to)
    }

    fn angle(self, x: Self) -> Self {
        let cut = x.low <= 0.0 && self.low <= 0.0 && self.high >= 0.0;
        let of = if cut && self.low < self.high { Self::new(-PI, PI) } else { Self::corners(self, x, f64::atan2) };
        of.after(self).after(x)
    }
}

impl FromStr for Span {
    type Err = ParseFloatError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        text.parse().map(|x: f64| Self::new(x, x))
    }
}

/// The operators of the library for [`f64`], over stretches.
#[derive(Clone, Debug)]
pub(super) struct SpanOperators;

impl exmex::MakeOperators<Span> for SpanOperators {
    fn make<'a>() -> Vec<Operator<'a, Span>> {
        let binary = |apply, prio, is_commutative| BinOp { apply, prio, is_commutative };
        let unary = Operator::make_unary;
        let constant = |name, value: f64| Operator::make_constant(name, Span::new(value, value));
        fn positive(a: Span, f: fn(f64) -> f64) -> Span {
            a.clip(0.0, f64::INFINITY).monotonic(f)
        }
        vec![
            Operator::make_bin("^", binary(Span::raised, 4, false)),
            Operator::make_bin("*", binary(|a, b| Span::corners(a, b, |a, b| a * b).after(a).after(b), 2, true)),
            Operator::make_bin("/", binary(Span::divided, 3, false)),
            Operator::make_bin_unary(
                "+",
                binary(|a, b| Span::new(a.low + b.low, a.high + b.high).after(a).after(b), 0, true),
                |a| a,
            ),
            Operator::make_bin_unary(
                "-",
                binary(|a, b| Span::new(a.low - b.high, a.high - b.low).after(a).after(b), 1, false),
                |a| Span { low: -a.high, high: -a.low, ..a },
            ),
            Operator::make_bin("atan2", binary(Span::angle, 0, false)),
            Operator::make_bin(
                "min",
                binary(|a, b| Span::new(a.low.min(b.low), a.high.min(b.high)).after(a).after(b), 0, true),
            ),
            Operator::make_bin(
                "max",
                binary(|a, b| Span::new(a.low.max(b.low), a.high.max(b.high)).after(a).after(b), 0, true),
            ),
            unary("abs", Span::abs),
            unary("signum", |a| a.level(f64::signum)),
            unary("floor", |a| a.level(f64::floor)),
            unary("round", |a| a.level(f64::round)),
            unary("ceil", |a| a.level(f64::ceil)),
            unary("trunc", |a| a.level(f64::trunc)),
            unary("fract", Span::fract),
            unary("sin", |a| a.wave(f64::sin, FRAC_PI_2)),
            unary("cos", |a| a.wave(f64::cos, 0.0)),
            unary("tan", Span::tan),
            unary("asin", |a| a.clip(-1.0, 1.0).monotonic(f64::asin)),
            unary("acos", |a| a.clip(-1.0, 1.0).monotonic(f64::acos)),
            unary("atan", |a| a.monotonic(f64::atan)),
            unary("sinh", |a| a.monotonic(f64::sinh)),
            unary("cosh", |a| a.abs().monotonic(f64::cosh)),
            unary("tanh", |a| a.monotonic(f64::tanh)),
            unary("asinh", |a| a.monotonic(f64::asinh)),
            unary("acosh", |a| a.clip(1.0, f64::INFINITY).monotonic(f64::acosh)),
            unary("atanh", |a| a.clip(-1.0, 1.0).monotonic(f64::atanh)),
            unary("exp", |a| a.monotonic(f64::exp)),
            unary("sqrt", |a| positive(a, f64::sqrt)),
            unary("cbrt", |a| a.monotonic(f64::cbrt)),
            unary("ln", |a| positive(a, f64::ln)),
            unary("log", |a| positive(a, f64::ln)),
            unary("log2", |a| positive(a, f64::log2)),
            unary("log10", |a| positive(a, f64::log10)),
            constant("PI", PI),
            constant("π", PI),
            constant("E", std::f64::consts::E),
            constant("e", std::f64::consts::E),
            constant("TAU", TAU),
            constant("τ", TAU),
        ]
    }
}
