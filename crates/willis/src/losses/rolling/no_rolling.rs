use super::{Law, RollingContact};
use crate::Real;
use crate::losses::{LawInfo, Trust};

/// No rolling loss: for laws of friction that contain it.
///
/// # Formula
/// ```text
/// P = 0
/// ```
///
/// # Symbols
/// | there | here | unit there | meaning                  |
/// |-------|------|------------|--------------------------|
/// | P     |      | W          | power lost by rolling    |
///
/// # Valid for
/// Meshes whose law of friction contains rolling, which is every one that does not say otherwise.
///
/// # Departs from the source
/// Nothing.
///
/// # Source
/// `[practice]`, no rolling loss on top.
///
/// # Example
/// By hand: 0.
/// ```
/// # use willis::losses::rolling::{Law, NoRolling, RollingContact};
/// assert_eq!(NoRolling::DEFAULT.eval(&RollingContact::typical()), 0.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoRolling;

impl NoRolling {
    /// The only one.
    pub const DEFAULT: Self = Self;
}

impl Law for NoRolling {
    const META: LawInfo<RollingContact<f64>> = LawInfo {
        id: "none",
        by: "",
        title: "No rolling loss",
        source: ("practice", "no rolling loss on top"),
        trust: Trust::Derived,
        tags: &[],
        valid: &[],
    };

    fn eval<D: Real>(&self, _: &RollingContact<D>) -> D {
        D::from(0.0)
    }
}
