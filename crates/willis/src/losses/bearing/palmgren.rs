use num_dual::DualNum;

use super::skf::{Mm, rpm};
use super::{BearingDuty, Law, Supply, pow};
use crate::catalogue::bearing::Kind;
use crate::losses::{LawInfo, Trust};
use crate::real::{self, Inner, Real};

/// Frictional torque of a rolling bearing after Palmgren: a part of the oil and a part of the load.
///
/// # Formula
/// ```text
/// M  = M_0 + M_1
/// M_0 = 1e-7 f_0 (ν n)^(2/3) d_m³  for ν n ≥ 2000, else 160e-7 f_0 d_m³
/// M_1 = f_1 (P_0/C_0)^y P_1 d_m
/// ```
/// P_1 by type: deep groove 3 F_a − 0.1 F_r, not below F_r; angular contact F_a − 0.1 F_r (two rows
/// 1.4 F_a − 0.1 F_r), not below F_r; tapered 2 Y F_a, not below F_r; spherical 1.35 Y F_a for F_r < Y F_a,
/// else F_r (1 + 0.35 (Y F_a/F_r)³); axial F_a; all others F_r.
///
/// # Symbols
/// | there    | here                  | unit there | meaning                                     |
/// |----------|-----------------------|------------|---------------------------------------------|
/// | M        | result                | N mm       | frictional torque                           |
/// | ν, n     | `kinematic_viscosity`, `speed` | mm²/s, r/min | oil and speed                    |
/// | d_m      | `bearing`             | mm         | mean diameter (d + D)/2                     |
/// | f_0      | `bearing.palmgren`    | −          | type, series and supply of oil              |
/// | f_1, y   | `bearing.palmgren`    | −          | type                                        |
/// | P_0, C_0 | `bearing`             | N          | static equivalent load and rating           |
/// | P_1      | loads                 | N          | load that makes the friction                |
///
/// # Valid for
/// Moderate loads and speeds, oil level at the middle of the lowest rolling element; rough for sealed
/// bearings (no part for seals). The law to use for needle bearings.
///
/// # Departs from the source
/// f_0 and f_1 are the middle of the printed ranges. f_0 is halved for mist and doubled for a jet (the
/// rule of the makers). C_0 unknown: P_0/C_0 = 0.1. Y unknown: 1.5 tapered, 2.5 spherical. P_0 is
/// 0.6 F_r + 0.5 F_a (deep groove), 0.5 F_r + 0.26 F_a (angular contact), not below F_r; F_a (axial);
/// F_r + Y F_a (spherical, toroidal); F_r (all others). Speed 0: M_0 is its value at low speed.
///
/// # Source
/// `[eschmann1985]`, frictional moment; the same form in ISO/TR 14179-2 and ISO 15312.
/// The number of the equation there is not known to us.
///
/// # Example
/// By hand, NU 308 (f_0 = 2, f_1 = 0.0003), 5 kN, 1500 r/min, 40 mm²/s:
/// 1e-7 · 2 · 60000^(2/3) · 65³ = 84.2; 0.0003 · 5000 · 65 = 97.5; sum 181.7 N mm.
/// ```
/// # use willis::losses::bearing::{BearingDuty, Law, Palmgren};
/// let torque = Palmgren::DEFAULT.eval(&BearingDuty::typical());
/// assert_eq!(format!("{torque:.4}"), "0.1817");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Palmgren {
    /// `f_0`, where it is not to follow from type, series and supply.
    pub f0: Option<f64>,
    /// `f_1`, where it is not to follow from type and series.
    pub f1: Option<f64>,
}

impl Palmgren {
    /// As published.
    pub const DEFAULT: Self = Self { f0: None, f1: None };
}

impl Law for Palmgren {
    const META: LawInfo<BearingDuty<f64>> = LawInfo {
        id: "palmgren",
        by: "Palmgren",
        title: "Palmgren (Eschmann, ISO/TR 14179-2, ISO 15312)",
        source: ("eschmann1985", "frictional moment"),
        trust: Trust::Confirm("tables of f0 and f1"),
        tags: &[],
        valid: &[],
    };

    fn eval<D: Real>(&self, s: &BearingDuty<D>) -> D {
        let k = s.bearing.palmgren;
        let dm = Mm::of(&s.bearing).dm;
        let (fr, fa) = (real::abs(s.radial_load), real::abs(s.axial_load));
        let zero = D::from(0.0);

        let supply = match s.supply {
            Supply::Mist => 0.5,
            Supply::Jet => 2.0,
            Supply::Bath { .. } | Supply::Grease => 1.0,
        };
        let f0 = self.f0.unwrap_or(k.f0 * supply);
        let nu_n = s.kinematic_viscosity * rpm(s) * 1e6;
        let m0 = if nu_n.re() >= 2000.0 { nu_n.powf(2.0 / 3.0) * 1e-7 } else { D::from(160e-7) } * D::constant(dm.powi(3) * f0);

        let y = s.bearing.axial_factor;
        let (p0, p1) = match s.bearing.kind {
            Kind::DeepGrooveBall => (fr * 0.6 + fa * 0.5, fa * 3.0 - fr * 0.1),
            Kind::AngularContactBall | Kind::FourPointContactBall => (fr * 0.5 + fa * 0.26, fa - fr * 0.1),
            Kind::DoubleRowAngularContactBall => (fr * 0.5 + fa * 0.26, fa * 1.4 - fr * 0.1),
            Kind::TaperedRoller => (fr, fa * D::constant(y.unwrap_or(Inner::<D>::from(1.5)) * 2.0)),
            Kind::SphericalRoller => {
                let axial = fa * D::constant(y.unwrap_or(Inner::<D>::from(2.5)));
                let p1 = if fr.re() > axial.re() { fr + (axial / fr).powi(3) * fr * 0.35 } else { axial * 1.35 };
                (fr + axial, p1)
            }
            Kind::AxialBall | Kind::AxialCylindricalRoller => (fa, fa),
            _ => (fr, fr),
        };
        let axial_only = matches!(s.bearing.kind, Kind::AxialBall | Kind::AxialCylindricalRoller);
        let (p0, p1) = if axial_only { (p0, p1) } else { (real::max(p0, fr), real::max(p1, fr)) };
        let utilisation = match (k.exponent > 0.0, s.bearing.static_rating) {
            (false, _) => D::from(1.0),
            (true, Some(c0)) => pow(p0.over(c0), k.exponent),
            (true, None) => D::from(0.1f64.powf(k.exponent)),
        };
        let m1 = utilisation * p1 * D::constant(dm * self.f1.unwrap_or(k.f1));
        real::max(m0 + m1, zero) * 1e-3
    }
}
