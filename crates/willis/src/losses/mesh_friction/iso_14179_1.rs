use super::{Law, MeshContact};
use crate::Real;
use crate::losses::{LawInfo, ValidityRange, Tag, Trust};

/// Mean friction of a mesh after ISO/TR 14179-1, the thermal rating that came from AGMA, with the tooth loss factor
/// of that report.
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
/// For a ring the contact load factor takes `z2 − z1`. The loss factor is `iso-14179-1`, whichever is chosen:
/// [`Tag::OwnLossFactor`]. The same coefficient with the loss factor that is chosen is `iso-14179-1-friction`.
///
/// # Source
/// `[isotr14179_1]`, mesh coefficient of friction. The number of the equation there is not known to us.
///
/// # Example
/// By hand: 100^(−0.223) · 5^(−0.40) / (3.239 · 10^0.70) = 0.35810 · 0.52531/16.2334 = 0.011588.
/// ```
/// # use willis::losses::mesh_friction::{Iso14179Part1, Law, MeshContact};
/// let contact = MeshContact {
///     kinematic_viscosity: 100e-6,
///     k_factor: 5e6,
///     pitch_line_speed: 10.0,
///     ..MeshContact::typical()
/// };
/// assert_eq!(format!("{:.6}", Iso14179Part1::DEFAULT.eval(&contact)), "0.011588");
/// assert!(Iso14179Part1::DEFAULT.outside(&contact).is_empty());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iso14179Part1;

impl Iso14179Part1 {
    /// As published.
    pub const DEFAULT: Self = Self;
}

/// How far the coefficient was checked.
pub(super) const TRUST: Trust = Trust::Confirm("the exponents 0.223, 0.40, 0.70, the divisor 3.239 and the range");

/// Where the report uses the coefficient.
pub(super) const VALID: &[ValidityRange<MeshContact<f64>>] = &[
    ValidityRange { symbol: "v", unit: "m/s", min: 2.0, max: 25.0, get: |s| s.pitch_line_speed },
    ValidityRange { symbol: "K", unit: "Pa", min: 1.4e6, max: 14e6, get: |s| s.k_factor },
];

/// The coefficient of the report.
pub(super) fn coefficient<D: Real>(s: &MeshContact<D>) -> D {
    let nu_mm2_s = s.kinematic_viscosity * 1e6;
    let k_n_mm2 = s.k_factor * 1e-6;
    let v_m_s = s.pitch_line_speed;
    nu_mm2_s.powf(-0.223) * k_n_mm2.powf(-0.40) / (v_m_s.powf(0.70) * 3.239)
}

impl Law for Iso14179Part1 {
    const META: LawInfo<MeshContact<f64>> = LawInfo {
        id: "iso-14179-1",
        by: "ISO/TR 14179-1",
        title: "ISO/TR 14179-1 (AGMA)",
        source: ("isotr14179_1", "mesh coefficient of friction"),
        trust: TRUST,
        tags: &[Tag::OwnLossFactor],
        valid: VALID,
    };

    fn eval<D: Real>(&self, s: &MeshContact<D>) -> D {
        coefficient(s)
    }
}
