use super::{ImmersedGear, Law};
use crate::losses::{LawInfo, Trust};
use crate::real::{Real, abs, clamp, max};

/// Churning of one gear in an oil sump after ISO/TR 14179-1.
///
/// # Formula
/// ```text
/// P = 1.474 f_g ν n³ D^5.7/(A_g 1e26) + 7.37 f_g ν n³ D^4.7 F R_f/(A_g 1e26 √tan β)
/// R_f = 7.93 − 4.648/m_t
/// ```
/// The first part is that of the sides, the second that of the teeth.
///
/// # Symbols
/// | there | here                  | unit there | meaning                                           |
/// |-------|-----------------------|------------|---------------------------------------------------|
/// | P     | result                | kW         | power lost                                        |
/// | f_g   | `immersion`           | −          | dip factor, 0 dry to 1 fully dipped               |
/// | ν     | `kinematic_viscosity` | mm²/s      | oil                                               |
/// | n     | `speed`               | r/min      | absolute speed                                    |
/// | D     | `tip_radius`          | mm         | outside diameter                                  |
/// | F     | `width`               | mm         | face width                                        |
/// | m_t   | `module`, `helix`     | mm         | transverse module                                 |
/// | β     | `helix`               | deg        | helix angle, 10° at least                         |
/// | A_g   | `arrangement`         | −          | arrangement constant, 0.2                         |
///
/// # Valid for
/// Typical enclosed drives. It grows with ν and n³ without bound and exceeds
/// [`Changenet2011`](super::Changenet2011) many times at high speed and with thick oil.
///
/// # Departs from the source
/// f_g is the immersed share of the outside diameter, linear, as the source interpolates. The part of
/// smooth shafts is left away. R_f is not below 0 (m_t < 0.586 mm).
///
/// # Source
/// `[isotr14179_1]`, oil churning loss. The number of the equation there is not known to us.
///
/// # Example
/// By hand, the gear of [`ImmersedGear::typical`]: f_g = 43/166 = 0.2590, ν n³ = 36.6e9, D^5.7 = 4.515e12,
/// D^4.7 = 2.720e10, R_f = 6.381, √tan 10° = 0.41991:
/// sides 1.474 · 0.2590 · 36.6e9 · 4.515e12/2e25 = 0.003155 kW, teeth
/// 7.37 · 0.2590 · 36.6e9 · 2.720e10 · 24 · 6.381/(2e25 · 0.41991) = 0.034657 kW, sum 37.8 W.
/// ```
/// # use willis::losses::churning::{ImmersedGear, Iso14179p1, Law};
/// assert_eq!(format!("{:.1}", Iso14179p1::DEFAULT.eval(&ImmersedGear::typical())), "37.8");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iso14179p1 {
    /// `A_g`
    pub arrangement: f64,
}

impl Iso14179p1 {
    /// As published.
    pub const DEFAULT: Self = Self { arrangement: 0.2 };
}

impl Law for Iso14179p1 {
    const META: LawInfo<ImmersedGear<f64>> = LawInfo {
        id: "iso-14179-1",
        by: "ISO/TR 14179-1",
        title: "ISO/TR 14179-1, oil churning",
        source: ("isotr14179_1", "oil churning loss"),
        trust: Trust::Confirm("R_f and A_g"),
        tags: &[],
        valid: &[],
    };

    fn eval<D: Real>(&self, s: &ImmersedGear<D>) -> D {
        let dip = s.immersion + s.tip_radius - s.radius;
        let f_g = clamp(dip / (s.tip_radius * 2.0), D::from(0.0), D::from(1.0));
        let n = s.speed * (30.0 / std::f64::consts::PI);
        let (d_mm, f_mm) = (s.tip_radius * 2e3, s.width * 1e3);
        let m_t_mm = s.module * 1e3 / s.helix.cos();
        let r_f = max(-(D::from(4.648) / m_t_mm) + 7.93, D::from(0.0));
        let helix = max(abs(s.helix), D::from(10f64.to_radians()));
        let sides = d_mm.powf(5.7) * 1.474;
        let teeth = d_mm.powf(4.7) * 7.37 * f_mm * r_f / helix.tan().sqrt();
        s.kinematic_viscosity * n.powi(3) * (f_g * (sides + teeth) * 1e6 / (self.arrangement * 1e26) * 1e3)
    }
}
