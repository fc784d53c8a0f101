use super::{Journal, Law};
use crate::losses::{LawInfo, Tag, Trust};
use crate::real::Real;

/// Torque of a plain bearing without a full film: a coefficient of friction.
///
/// # Formula
/// ```text
/// M = µ F d/2
/// ```
///
/// # Symbols
/// | there | here        | unit there | meaning                          |
/// |-------|-------------|------------|----------------------------------|
/// | µ     | `friction`  | −          | coefficient of friction          |
/// | F     | `load`      | N          | load                             |
/// | d     | `diameter`  | m          | shaft diameter                   |
/// | −     | `speed`, `width`, `clearance`, `viscosity` | − | not read      |
///
/// # Valid for
/// Slow bushes, planets on plain pins of differentials: µ 0.05 to 0.1.
///
/// # Departs from the source
/// Nothing.
///
/// # Source
/// Coulomb's friction on the radius of a pin, `[niemann_winter2003]`. The number of the equation there is not known to us.
///
/// # Example
/// By hand, the bearing of [`Journal::typical`]: 0.08 · 2000 · 0.015 = 2.4 N m.
/// ```
/// # use willis::losses::plain_bearing::{Journal, Law, Boundary};
/// assert_eq!(format!("{:.2}", Boundary::DEFAULT.eval(&Journal::typical())), "2.40");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Boundary;

impl Boundary {
    /// As derived.
    pub const DEFAULT: Self = Self;
}

impl Law for Boundary {
    const META: LawInfo<Journal<f64>> = LawInfo {
        id: "boundary-friction",
        by: "",
        title: "coefficient of friction",
        source: ("niemann_winter2003", "friction of pins"),
        trust: Trust::Derived,
        tags: &[Tag::Estimate],
        valid: &[],
    };

    fn eval<D: Real>(&self, s: &Journal<D>) -> D {
        s.friction * s.load * s.diameter * 0.5
    }
}
