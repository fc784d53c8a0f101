use super::{Law, SealContact};
use crate::losses::{LawInfo, Trust};
use crate::real::Real;

/// Power lost by a lip seal after Linke (ISO/TR 14179-2).
///
/// # Formula
/// ```text
/// P = 7.69e-6 d² n
/// ```
///
/// # Symbols
/// | there | here       | unit there | meaning        |
/// |-------|------------|------------|----------------|
/// | P     | result     | W          | power lost     |
/// | d     | `diameter` | mm         | shaft diameter |
/// | n     | `speed`    | r/min      | shaft speed    |
///
/// # Valid for
/// One lip. The formulas of this family differ by a factor of 2 for the same seal; that is the
/// uncertainty of any of them.
///
/// # Departs from the source
/// Nothing.
///
/// # Source
/// `[isotr14179_2]`, radial lip seals. The number of the equation there is not known to us.
///
/// # Example
/// By hand, d = 50 mm, n = 1500 r/min: 7.69e-6 · 2500 · 1500 = 28.84 W.
/// ```
/// # use willis::losses::seal::{Iso14179p2, Law, SealContact};
/// assert_eq!(format!("{:.2}", Iso14179p2::DEFAULT.eval(&SealContact::typical())), "28.84");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iso14179p2;

impl Iso14179p2 {
    /// As published.
    pub const DEFAULT: Self = Self;
}

impl Law for Iso14179p2 {
    const META: LawInfo<SealContact<f64>> = LawInfo {
        id: "iso-14179-2",
        by: "ISO/TR 14179-2",
        title: "Linke (ISO/TR 14179-2)",
        source: ("isotr14179_2", "radial lip seals"),
        trust: Trust::Seen,
        tags: &[],
        valid: &[],
    };

    fn eval<D: Real>(&self, s: &SealContact<D>) -> D {
        let d_mm = s.diameter * 1e3;
        s.speed * (d_mm * 7.69e-6 * d_mm * 30.0 / std::f64::consts::PI)
    }
}
