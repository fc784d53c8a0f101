//! Where the jumps of a formula are, before a run comes to them.
//!
//! The formula is evaluated over stretches of time instead of at times: each operator takes the least and the
//! greatest value of its operands to those of its result. Ends are rounded as the values themselves are, and rounding
//! keeps the order; so a stretch over which `floor` and its like stay at one value has no jump, and halving the
//! others finds the first one to the last digits of its time.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::expression::{Binary, Number, Unary};

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

impl Number for Span {
    fn constant(value: f64) -> Self {
        Self::new(value, value)
    }

    fn binary(self, operation: Binary, other: Self) -> Self {
        let (a, b) = (self, other);
        let of = match operation {
            Binary::Add => Self::new(a.low + b.low, a.high + b.high),
            Binary::Subtract => Self::new(a.low - b.high, a.high - b.low),
            Binary::Multiply => Self::corners(a, b, |a, b| a * b),
            Binary::Divide => return a.divided(b),
            Binary::Power => return a.raised(b),
            Binary::Atan2 => return a.angle(b),
            Binary::Min => Self::new(a.low.min(b.low), a.high.min(b.high)),
            Binary::Max => Self::new(a.low.max(b.low), a.high.max(b.high)),
        };
        of.after(a).after(b)
    }

    fn unary(self, function: Unary) -> Self {
        let a = self;
        let positive = |f: fn(f64) -> f64| a.clip(0.0, f64::INFINITY).monotonic(f);
        match function {
            Unary::Negative => Self { low: -a.high, high: -a.low, ..a },
            Unary::Abs => a.abs(),
            Unary::Signum => a.level(f64::signum),
            Unary::Floor => a.level(f64::floor),
            Unary::Round => a.level(f64::round),
            Unary::Ceil => a.level(f64::ceil),
            Unary::Trunc => a.level(f64::trunc),
            Unary::Fract => a.fract(),
            Unary::Sin => a.wave(f64::sin, FRAC_PI_2),
            Unary::Cos => a.wave(f64::cos, 0.0),
            Unary::Tan => a.tan(),
            Unary::Asin => a.clip(-1.0, 1.0).monotonic(f64::asin),
            Unary::Acos => a.clip(-1.0, 1.0).monotonic(f64::acos),
            Unary::Atan => a.monotonic(f64::atan),
            Unary::Sinh => a.monotonic(f64::sinh),
            Unary::Cosh => a.abs().monotonic(f64::cosh),
            Unary::Tanh => a.monotonic(f64::tanh),
            Unary::Asinh => a.monotonic(f64::asinh),
            Unary::Acosh => a.clip(1.0, f64::INFINITY).monotonic(f64::acosh),
            Unary::Atanh => a.clip(-1.0, 1.0).monotonic(f64::atanh),
            Unary::Exp => a.monotonic(f64::exp),
            Unary::Sqrt => positive(f64::sqrt),
            Unary::Cbrt => a.monotonic(f64::cbrt),
            Unary::Ln => positive(f64::ln),
            Unary::Log2 => positive(f64::log2),
            Unary::Log10 => positive(f64::log10),
        }
    }
}
