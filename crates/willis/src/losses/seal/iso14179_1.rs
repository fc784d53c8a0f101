use super::{Law, SealContact, Material};
use crate::losses::{LawInfo, Trust};
use crate::real::Real;

/// Power lost by a lip seal after ISO/TR 14179-1.
///
/// # Formula
/// ```text
/// T = 3.737e-3 d (FKM), 2.429e-3 d (NBR);  P = T ω
/// ```
///
/// # Symbols
/// | there | here       | unit there | meaning                   |
/// |-------|------------|------------|---------------------------|
/// | T     | −          | N m        | torque of the lip         |
/// | d     | `diameter` | mm         | shaft diameter            |
/// | ω     | `speed`    | rad/s      | shaft speed               |
/// | −     | `material` | −          | fluoro (FKM) or nitrile rubber (NBR) |
///
/// # Valid for
/// One lip.
///
/// # Departs from the source
/// P = T ω instead of T n/9549, a difference of 3e-5.
///
/// # Source
/// `[isotr14179_1]`, oil seal losses. The number of the equation there is not known to us.
///
/// # Example
/// By hand, FKM on d = 50 mm at 157.08 rad/s: 0.18685 · 157.08 = 29.35 W.
/// ```
/// # use willis::losses::seal::{Iso14179p1, Law, SealContact};
/// assert_eq!(format!("{:.2}", Iso14179p1::DEFAULT.eval(&SealContact::typical())), "29.35");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iso14179p1;

impl Iso14179p1 {
    /// As published.
    pub const DEFAULT: Self = Self;
}

impl Law for Iso14179p1 {
    const META: LawInfo<SealContact<f64>> = LawInfo {
        id: "iso-14179-1",
        by: "ISO/TR 14179-1",
        title: "ISO/TR 14179-1",
        source: ("isotr14179_1", "oil seal losses"),
        trust: Trust::Confirm("both constants"),
        tags: &[],
        valid: &[],
    };

    fn eval<D: Real>(&self, s: &SealContact<D>) -> D {
        let d_mm = s.diameter * 1e3;
        let per_mm = match s.material {
            Material::Fkm => 3.737e-3,
            Material::Nbr => 2.429e-3,
        };
        s.speed * (d_mm * per_mm)
    }
}
