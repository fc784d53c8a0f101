use super::{Law, ToothLoad};
use crate::Real;
use crate::losses::{LawInfo, ValidityRange, Trust};

/// The same load at every place of the path: what the face of a helical gear sees on average.
///
/// # Formula
/// ```text
/// share = 1/ε_α
/// ```
///
/// # Symbols
/// | there | here            | unit there | meaning                  |
/// |-------|-----------------|------------|--------------------------|
/// | ε_α   | `contact_ratio` | −          | transverse contact ratio |
///
/// # Valid for
/// Helical gears with a whole overlap ratio, rigid and unmodified, where it is exact: the total
/// length of contact lines is then constant. For spur gears it carries the force only in the mean.
///
/// # Departs from the source
/// Nothing.
///
/// # Source
/// `[niemann_winter2003]`, mean losses of helical gears; derived.
/// The number of the equation there is not known to us.
///
/// # Example
/// By hand, ε_α = 1.6: 1/1.6 = 0.625 everywhere.
/// ```
/// # use willis::losses::load_sharing::{Law, Relief, ToothLoad, Uniform};
/// let place = ToothLoad { position: 0.3, contact_ratio: 1.6, overlap_ratio: 1.0, relief: Relief::none() };
/// assert_eq!(Uniform::DEFAULT.eval(&place), 0.625);
/// assert!(Uniform::DEFAULT.outside(&place).is_empty());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Uniform;

impl Uniform {
    /// As derived.
    pub const DEFAULT: Self = Self;
}

impl Law for Uniform {
    const META: LawInfo<ToothLoad<f64>> = LawInfo {
        id: "uniform",
        by: "",
        title: "Uniform along the path",
        source: ("niemann_winter2003", "helical gears"),
        trust: Trust::Derived,
        tags: &[],
        valid: &[
            ValidityRange { symbol: "e_b", unit: "-", min: 1.0, max: f64::INFINITY, get: |s| s.overlap_ratio },
            ValidityRange { symbol: "c' C_a b/F_bt", unit: "-", min: 0.0, max: 0.0, get: |s| s.relief.largest() },
        ],
    };

    fn eval<D: Real>(&self, s: &ToothLoad<D>) -> D {
        if s.on_path() && s.contact_ratio.re() > 0.0 { s.contact_ratio.recip() } else { D::zero() }
    }
}
