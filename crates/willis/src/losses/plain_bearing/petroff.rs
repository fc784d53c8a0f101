use super::{Journal, Law};
use crate::losses::{LawInfo, Trust};
use crate::real::Real;

/// Torque of a plain bearing whose shaft runs in its middle: the film alone.
///
/// # Formula
/// ```text
/// M = π η ω d³ b/(2 s)
/// ```
///
/// # Symbols
/// | there | here        | unit there | meaning                          |
/// |-------|-------------|------------|----------------------------------|
/// | ω     | `speed`     | rad/s      | relative speed                   |
/// | d     | `diameter`  | m          | shaft diameter                   |
/// | b     | `width`     | m          | width                            |
/// | s     | `clearance` | m          | difference of the two diameters  |
/// | η     | `viscosity` | Pa s       | dynamic viscosity                |
/// | −     | `load`, `friction` | −   | not read                         |
///
/// # Valid for
/// No load, or a light one.
///
/// # Departs from the source
/// Nothing.
///
/// # Source
/// Derived: plane shear around a shaft, `[petroff1883]`. The number of the equation there is not known to us.
///
/// # Example
/// By hand, the bearing of [`Journal::typical`]: π · 0.03 · 104.72 · 2.7e-5 · 0.02/(2 · 45e-6) = 0.0592 N m.
/// ```
/// # use willis::losses::plain_bearing::{Journal, Law, Petroff};
/// assert_eq!(format!("{:.4}", Petroff::DEFAULT.eval(&Journal::typical())), "0.0592");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Petroff;

impl Petroff {
    /// As derived.
    pub const DEFAULT: Self = Self;
}

/// The torque of a shaft in the middle.
pub(super) fn centred<D: Real>(s: &Journal<D>) -> D {
    s.viscosity * s.speed * s.diameter.powi(3) * s.width / s.clearance * (0.5 * std::f64::consts::PI)
}

impl Law for Petroff {
    const META: LawInfo<Journal<f64>> = LawInfo {
        id: "petroff",
        by: "Petroff",
        title: "Petroff: no load",
        source: ("petroff1883", "friction of a shaft in the middle of its bush"),
        trust: Trust::Derived,
        tags: &[],
        valid: &[],
    };

    fn eval<D: Real>(&self, s: &Journal<D>) -> D {
        centred(s)
    }
}
