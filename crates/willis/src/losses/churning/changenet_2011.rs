use super::{ImmersedGear, Law};
use crate::losses::{LawInfo, ValidityRange, Trust};
use crate::real::{Real, acos, min};

/// Churning of one gear in an oil sump after Changenet, Leprince, Ville and Velex (2011).
///
/// # Formula
/// ```text
/// P = T ω,  T = 0.5 ρ ω² R³ S_m C_m
/// Fr = ω² R/g,  Re = ω R b/ν,  γ = ω² (R b m)^(1/3)
/// γ < 750 m/s²:  C_m = a (h/D)^0.45 (V_0/D³)^0.1 Fr^−0.6 (b/D)^0.21,
///                a = 1.366 Re^−0.21 for Re < 4000, else 0.239
/// γ > 1250 m/s²: C_m = a (h/D)^0.1 (V_0/D³)^−0.35 Fr^−0.88 (b/D)^0.85,
///                a = 20.797 Re^−0.21 for Re < 4000, else 3.644
/// between:       linear in γ
/// S_m = R² (2θ − sin 2θ) + D b θ + 2 z θ H_t b/(π cos α cos β),  cos θ = 1 − h/R
/// ```
///
/// # Symbols
/// | there | here                  | unit there | meaning                                    |
/// |-------|-----------------------|------------|--------------------------------------------|
/// | ω     | `speed`               | rad/s      | absolute angular speed                     |
/// | R, D  | `radius`              | m          | pitch radius, diameter                     |
/// | b     | `width`               | m          | face width                                 |
/// | m, z  | `module`, `teeth`     | m, −       | module, tooth count                        |
/// | H_t   | `tip_radius − root_radius` | m     | tooth height                               |
/// | α, β  | `pressure_angle`, `helix` | rad    | pressure and helix angle                   |
/// | h     | `immersion`           | m          | depth of immersion of the pitch circle     |
/// | V_0   | `oil_volume`          | m³         | volume of oil                              |
/// | ν, ρ  | `kinematic_viscosity`, `density` | m²/s, kg/m³ | oil                            |
/// | g     | `gravity`             | m/s²       | acceleration that holds the oil down       |
///
/// # Valid for
/// One gear in a box, h/D from 0.1 to 0.5. Continuous at Re = 4000 to the printed digits (0.2 %).
///
/// # Departs from the source
/// Nothing for a gear in a box. For a planet in an oil ring `gravity` takes the centrifugal
/// acceleration: an estimate without experiment, good to half its value. A gear that does not dip
/// (h ≤ 0), or stands still, loses nothing; one that is drowned has θ = π.
/// Under another acceleration than gravity γ is scaled with it, so that the regimes keep their places.
///
/// # Source
/// `[changenet2011]`, drag torque coefficients in the four regimes.
/// The number of the equation there is not known to us.
///
/// # Example
/// By hand, the gear of [`ImmersedGear::typical`]: ω = 104.72, Re = 5493, Fr = 89.43, γ = 196.6, θ = 60°,
/// S_m = 0.017974 m², C_m = 0.239 · 0.53589 · 0.84932 · 0.067471 · 0.67139 = 0.0049276,
/// T = 0.5 · 850 · 104.72² · 0.08³ · 0.017974 · 0.0049276 = 0.21135 N m, P = 22.13 W.
/// ```
/// # use willis::losses::churning::{Changenet2011, ImmersedGear, Law};
/// assert_eq!(format!("{:.2}", Changenet2011::DEFAULT.eval(&ImmersedGear::typical())), "22.13");
/// assert!(Changenet2011::DEFAULT.outside(&ImmersedGear::typical()).is_empty());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Changenet2011;

impl Changenet2011 {
    /// As published.
    pub const DEFAULT: Self = Self;
}

impl Law for Changenet2011 {
    const META: LawInfo<ImmersedGear<f64>> = LawInfo {
        id: "changenet-2011",
        by: "Changenet 2011",
        title: "Changenet and others 2011, four regimes",
        source: ("changenet2011", "four regimes"),
        trust: Trust::Seen,
        tags: &[],
        valid: &[ValidityRange {
            symbol: "h/D",
            unit: "-",
            min: 0.1,
            max: 0.5,
            get: |s| s.immersion / (2.0 * s.radius),
        }],
    };

    fn eval<D: Real>(&self, s: &ImmersedGear<D>) -> D {
        let (w, r, b, h) = (s.speed, s.radius, s.width, s.immersion);
        if w.re() <= 0.0 || h.re() <= 0.0 {
            return D::from(0.0);
        }
        let d = r * 2.0;
        let theta = acos(-(h / r) + 1.0);
        let h_t = s.tip_radius - s.root_radius;
        let teeth = theta * (2.0 * s.teeth) * h_t * b
            / (s.pressure_angle.cos() * std::f64::consts::PI * s.helix.cos());
        let s_m = r * r * (theta * 2.0 - (theta * 2.0).sin()) + d * b * theta + teeth;

        let fr = w * w * (r / s.gravity);
        let re = w / s.kinematic_viscosity * (r * b);
        // The limits of the regimes were found under gravity.
        let gamma = w * w * ((r * b * s.module).cbrt() * 9.806_65 / s.gravity);
        let viscous = re.re() < 4000.0;
        let (depth, volume, slim) = (min(h / d, D::from(1.0)), s.oil_volume / d.powi(3), b / d);
        let regime = |laminar: f64, turbulent: f64, powers: [f64; 3], froude: f64| {
            let a = if viscous { re.powf(-0.21) * laminar } else { D::from(turbulent) };
            let shape = depth.powf(powers[0]) * volume.powf(powers[1]) * slim.powf(powers[2]);
            a * fr.powf(froude) * shape
        };
        let slow = regime(1.366, 0.239, [0.45, 0.1, 0.21], -0.6);
        let fast = regime(20.797, 3.644, [0.1, -0.35, 0.85], -0.88);
        let c_m = if gamma.re() <= 750.0 {
            slow
        } else if gamma.re() >= 1250.0 {
            fast
        } else {
            slow + (fast - slow) * (gamma - 750.0) / 500.0
        };
        w.powi(3) * s.density * c_m * (r.powi(3) * 0.5 * s_m)
    }
}
