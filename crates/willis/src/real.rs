//! The number that a law computes with: `f64`, or a dual number that carries derivatives along.

use num_dual::DualNum;

/// Numbers in which loss laws are written, so that every law also gives its derivatives.
///
/// Implemented for `f64` and for the dual numbers of the crate `num-dual`. Decisions are taken on
/// the value, [`re`](num_dual::DualStruct::re).
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
pub trait Real: DualNum<Primitive = f64> + Copy + std::fmt::Debug + Send + Sync {}

impl<T: DualNum<Primitive = f64> + Copy + std::fmt::Debug + Send + Sync> Real for T {}

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
    if a.re() < 0.0 { -a } else { a }
}
