//! The number that a law computes with: `f64`, or a dual number that carries derivatives along.

use num_dual::{Dual, Dual2, Dual3, DualNum, DualSVec, DualStruct, HyperDual, HyperHyperDual};

/// Numbers in which loss laws are written, so that every law also gives its derivatives.
///
/// Implemented for `f64` and for the dual numbers of the crate `num-dual`. Decisions are taken on
/// the value, [`re`](num_dual::DualStruct::re).
///
/// Closures take such numbers by reference. A closure that is called with a large one by value may change that of its caller: a
/// defect of the compiler (rust-lang/rust#155241), by which viscosities came out thousands of times too high.
///
/// # Example
/// ```
/// use num_dual::{Dual64, DualNum};
/// use willis::Real;
///
/// fn loss<D: Real>(load: D) -> D {
///     load.powf(1.2) * 0.05
/// }
/// let at = loss(Dual64::new(100.0, 1.0));
/// assert!((at.re - loss(100.0)).abs() < 1e-12);
/// assert!((at.eps - 0.06 * 100f64.powf(0.2)).abs() < 1e-12);
/// ```
pub trait Real: DualNum<Primitive = f64> + Copy + std::fmt::Debug + Send + Sync {
    /// The kind of number whose derivatives it carries; of `f64` itself.
    ///
    /// What is constant to a law's derivatives (the size of a bearing, while its load varies) is one of these.
    type Constant: Real;

    /// A constant as such a number.
    fn constant(value: Self::Constant) -> Self;

    /// Itself over a constant.
    fn over(self, constant: Self::Constant) -> Self {
        // A plain number divides each part, without the detour over its reciprocal.
        if Self::Constant::NDERIV == 0 { self / constant.re() } else { self / Self::constant(constant) }
    }
}

impl Real for f64 {
    type Constant = Self;

    fn constant(value: Self) -> Self {
        value
    }
}

macro_rules! dual {
    ($($name:ident),+) => {
        $(impl<T: Real> Real for $name<T> {
            type Constant = T;

            fn constant(value: T) -> Self {
                Self::from_re(value)
            }
        })+
    };
}

dual!(Dual, Dual2, Dual3, HyperDual, HyperHyperDual);

impl<T: Real, const N: usize> Real for DualSVec<T, N> {
    type Constant = T;

    fn constant(value: T) -> Self {
        Self::from_re(value)
    }
}

/// The kind of number whose derivatives a number carries.
pub type Inner<D> = <D as Real>::Constant;

/// The larger of two numbers, by value.
pub fn max<D: Real>(a: D, b: D) -> D {
    if a.re() >= b.re() { a } else { b }
}

/// The smaller of two numbers, by value.
pub fn min<D: Real>(a: D, b: D) -> D {
    if a.re() <= b.re() { a } else { b }
}

/// The absolute value.
pub fn abs<D: Real>(a: D) -> D {
    if a.re().is_sign_negative() { -a } else { a }
}

/// The number, or the bound that it passes.
pub fn clamp<D: Real>(a: D, low: D, high: D) -> D {
    min(max(a, low), high)
}

/// The arc cosine of a number that round-off or a bound may have put at the ends of −1 to 1: there it is the
/// constant that it tends to, without a slope.
pub fn acos<D: Real>(a: D) -> D {
    match a.re() {
        x if x >= 1.0 => D::from(0.0),
        x if x <= -1.0 => D::from(std::f64::consts::PI),
        _ => a.acos(),
    }
}

/// `a^p` for `p > 0`, with 0 and no slope at and below 0.
pub fn power<D: Real>(a: D, p: f64) -> D {
    if a.re() > 0.0 { a.powf(p) } else { D::from(0.0) }
}
