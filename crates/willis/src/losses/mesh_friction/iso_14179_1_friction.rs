use super::iso_14179_1::{TRUST, VALID, coefficient};
use super::{Law, MeshContact};
use crate::Real;
use crate::losses::LawInfo;

/// The coefficient of friction of ISO/TR 14179-1 alone, with the tooth loss factor that is chosen: a mix that no standard
/// has, to compare the coefficient with those of other laws.
///
/// # Formula
/// ```text
/// mu = ν^(−0.223) · K^(−0.40) / (3.239 · v^0.70)
/// ```
///
/// # Symbols
/// | there | here                  | unit there | meaning                                       |
/// |-------|-----------------------|------------|-----------------------------------------------|
/// | ν     | `kinematic_viscosity` | mm²/s      | kinematic viscosity at the oil temperature    |
/// | K     | `k_factor`            | N/mm²      | contact load factor, F_t/(b d_w1) (z2 ± z1)/z2 |
/// | v     | `pitch_line_speed`    | m/s        | pitch line speed, relative to the carrier     |
///
/// # Valid for
/// The range in [`Law::META`].
///
/// # Departs from the source
/// The technical report has its own loss factor (`cos²β_w/M`, the law `iso-14179-1`); here the coefficient is used with
/// the one in force. For a ring the contact load factor takes `z2 − z1`.
///
/// # Source
/// `[isotr14179_1]`, mesh coefficient of friction. The number of the equation there is not known to us.
///
/// # Example
/// By hand: 100^(−0.223) · 5^(−0.40) / (3.239 · 10^0.70) = 0.35810 · 0.52531/16.2334 = 0.011588.
/// ```
/// # use willis::losses::mesh_friction::{Iso14179Part1Friction, Law, MeshContact};
/// let contact = MeshContact {
///     kinematic_viscosity: 100e-6,
///     k_factor: 5e6,
///     pitch_line_speed: 10.0,
///     ..MeshContact::typical()
/// };
/// assert_eq!(format!("{:.6}", Iso14179Part1Friction::DEFAULT.eval(&contact)), "0.011588");
/// assert!(Iso14179Part1Friction::DEFAULT.outside(&contact).is_empty());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iso14179Part1Friction;

impl Iso14179Part1Friction {
    /// As published.
    pub const DEFAULT: Self = Self;
}

impl Law for Iso14179Part1Friction {
    const META: LawInfo<MeshContact<f64>> = LawInfo {
        id: "iso-14179-1-friction",
        by: "ISO/TR 14179-1, friction only",
        title: "ISO/TR 14179-1 (AGMA), coefficient only",
        source: ("isotr14179_1", "mesh coefficient of friction"),
        trust: TRUST,
        tags: &[],
        valid: VALID,
    };

    fn eval<D: Real>(&self, s: &MeshContact<D>) -> D {
        coefficient(s)
    }
}
