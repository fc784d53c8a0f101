use super::{Law, MeshContact};
use crate::Real;
use crate::losses::{LawInfo, ValidityRange, Tag, Trust};
use crate::real::min;

/// Mean coefficient that gives the loss estimate of ANSI/AGMA 6011 with the loss factor in force.
///
/// # Formula
/// ```text
/// mu = φ / H_V,   φ = 0.01 · (22 − 0.8 α_n) · (1/z1 ± 1/z2)   (+ external, − ring)
/// ```
///
/// # Symbols
/// | there  | here                    | unit there | meaning                                      |
/// |--------|-------------------------|------------|----------------------------------------------|
/// | φ      |                         | −          | loss of the mesh over its power              |
/// | α_n    | `normal_pressure_angle` | degree     | normal pressure angle                        |
/// | z1, z2 | `teeth`                 | −          | tooth counts                                 |
/// | H_V    | `loss_factor`           | −          | loss factor in force                         |
///
/// # Valid for
/// High-speed helical gear units, as an estimate by hand: the estimated fraction of the power is lost
/// whatever speed, load and oil.
///
/// # Departs from the source
/// The source is for external pairs; a ring takes the difference of the curvatures, `1/z1 − 1/z2`.
/// The estimate is turned into a coefficient of friction by the loss factor, so that loss and
/// torque of a mesh come from the same place. Above 25° (flagged by the range in [`Law::META`]) the
/// angle is taken as 25°, because the estimate falls to zero at 27.5°.
///
/// # Source
/// `[agma6011]`, mesh loss, as printed in `[wang2020]`, section 3.2.2, whose tables confirm it.
///
/// # Example
/// By hand: φ = 0.01 · (22 − 0.8 · 20) · (1/31 + 1/35) = 0.00364977; φ/0.1539 = 0.023715.
/// ```
/// # use willis::losses::mesh_friction::{Agma6011, Law, MeshContact};
/// let contact = MeshContact { teeth: [31.0, 35.0], loss_factor: 0.1539, ..MeshContact::typical() };
/// assert_eq!(format!("{:.6}", Agma6011::DEFAULT.eval(&contact)), "0.023715");
/// assert!(Agma6011::DEFAULT.outside(&contact).is_empty());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Agma6011;

impl Agma6011 {
    /// As published.
    pub const DEFAULT: Self = Self;
}

/// `0.01 · (22 − 0.8 α_n)`, with the angle not above 25°.
pub(super) fn angle_factor<D: Real>(normal_pressure_angle: D) -> D {
    // In the order in which `f64::to_degrees` computes.
    let degrees = normal_pressure_angle * (180.0f64 / std::f64::consts::PI);
    (-(min(degrees, D::from(25.0)) * 0.8) + 22.0) * 0.01
}

/// Where the estimate is used as it stands.
pub(super) const ANGLE: ValidityRange<MeshContact<f64>> = ValidityRange {
    symbol: "α_n",
    unit: "rad",
    min: 14.0 * std::f64::consts::PI / 180.0,
    max: 25.0 * std::f64::consts::PI / 180.0,
    get: |s| s.normal_pressure_angle,
};

impl Law for Agma6011 {
    const META: LawInfo<MeshContact<f64>> = LawInfo {
        id: "agma-6011",
        by: "AGMA 6011",
        title: "Estimate of ANSI/AGMA 6011",
        source: ("agma6011", "mesh loss, as printed in Wang 2020, section 3.2.2"),
        trust: Trust::Confirm("the range of the angle"),
        tags: &[Tag::Estimate, Tag::WithoutOil],
        valid: &[ANGLE],
    };

    fn eval<D: Real>(&self, s: &MeshContact<D>) -> D {
        let [z1, z2] = s.teeth;
        let curvature = if s.internal { 1.0 / z1 - 1.0 / z2 } else { 1.0 / z1 + 1.0 / z2 };
        s.loss_factor.recip() * (angle_factor(s.normal_pressure_angle) * curvature)
    }
}
