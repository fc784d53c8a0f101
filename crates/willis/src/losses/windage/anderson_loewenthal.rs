use super::{Disc, Law};
use crate::losses::{LawInfo, Trust};
use crate::real::Real;

/// Windage of a spur gear after Anderson and Loewenthal, as drag of a rotating disc.
///
/// # Formula
/// ```text
/// P = T ω,  T = 0.5 ρ ω² R⁵ (1 + 2.3 b/R) 0.09 Re^(−0.2),  Re = ρ ω R²/μ
/// ```
///
/// # Symbols
/// | there | here        | unit there | meaning                                       |
/// |-------|-------------|------------|-----------------------------------------------|
/// | ω     | `speed`     | rad/s      | absolute angular speed                        |
/// | R     | `radius`    | m          | pitch radius                                  |
/// | b     | `width`     | m          | face width                                    |
/// | ρ     | `density`   | kg/m³      | of the mist around the gear ([`mist`](super::mist)) |
/// | μ     | `viscosity` | Pa s       | of that mist                                  |
///
/// # Valid for
/// Spur gears under an oil jet in an open case. A disc formula: for a ring gear, and for a planet
/// between two walls, it is an extrapolation.
///
/// # Departs from the source
/// Written in SI. In m, r/min, kg/m³ and mPa s it is
/// `P = 2.04e-8 (1 + 2.3 b/R) ρ^0.8 n^2.8 R^4.6 μ^0.2` kW; with 34.25 parts of air (1.2 kg/m³) to one of
/// oil (900 kg/m³) that is the printed `2.82e-7 (1 + 2.3 b/R) n^2.8 R^4.6 (0.028 μ_oil + 0.019)^0.2`. The
/// mist is an input, not built in. Speed 0 gives 0.
///
/// # Source
/// `[anderson1980]`, windage loss, as printed in `[wang2020]`, section 3.2.3: torque with 0.09, the power with
/// 2.04e-8, the mist of 34.25 parts of air.
///
/// # Example
/// By hand, R = 132.12 mm, b = 80 mm, ρ = 25.85 kg/m³, μ = 2.288 mPa s, 4920 r/min:
/// Re = 25.85 · 515.22 · 0.017456/0.002288 = 101 610, T = 0.5 · 25.85 · 515.22² · 4.0257e-5 · 2.3927 ·
/// 0.09 · 0.09968 = 2.965 N m, P = 1528 W.
/// ```
/// # use willis::losses::windage::{AndersonLoewenthal, Disc, Law};
/// let disc = Disc {
///     speed: 164.0 * std::f64::consts::PI,
///     radius: 0.13212,
///     width: 0.08,
///     density: 25.85,
///     viscosity: 2.288e-3,
///     ..Disc::typical()
/// };
/// assert_eq!(format!("{:.0}", AndersonLoewenthal::DEFAULT.eval(&disc)), "1528");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AndersonLoewenthal;

impl AndersonLoewenthal {
    /// As published.
    pub const DEFAULT: Self = Self;
}

impl Law for AndersonLoewenthal {
    const META: LawInfo<Disc<f64>> = LawInfo {
        id: "anderson-loewenthal",
        by: "Anderson–Loewenthal",
        title: "Anderson and Loewenthal 1980",
        source: ("anderson1980", "windage loss, as printed in Wang 2020, section 3.2.3"),
        trust: Trust::Seen,
        tags: &[],
        valid: &[],
    };

    fn eval<D: Real>(&self, s: &Disc<D>) -> D {
        if s.speed.re() <= 0.0 {
            return D::from(0.0);
        }
        let r = s.radius;
        let re = s.speed * (s.density * r * r / s.viscosity);
        let torque = s.speed.powi(2) * re.powf(-0.2) * (s.density * 0.045 * r.powi(5) * (s.width * 2.3 / r + 1.0));
        torque * s.speed
    }
}
