use super::{Disc, Law};
use crate::losses::{LawInfo, ValidityRange, Trust};
use crate::real::{Real, power};

/// Windage of a spur gear after Diab, Ville and Velex, by dimensional analysis.
///
/// # Formula
/// ```text
/// P  = 0.5 C_t ρ ω³ R⁵,  Re = ρ ω R²/μ
/// C_t = 60 Re^(−0.25) (b/R)^0.8 Z^(−0.4) ((h_1/R)^0.56 + (h_2/R)^0.56)
/// ```
///
/// # Symbols
/// | there    | here         | unit there | meaning                                            |
/// |----------|--------------|------------|----------------------------------------------------|
/// | ω        | `speed`      | rad/s      | absolute angular speed                             |
/// | R        | `radius`     | m          | pitch radius                                       |
/// | b        | `width`      | m          | face width                                         |
/// | Z        | `teeth`      | −          | tooth count                                        |
/// | h_1, h_2 | `axial_gaps` | m          | axial distance to a flange, not above R − hub radius |
/// | ρ, μ     | `density`, `viscosity` | kg/m³, Pa s | of air, or of a mist ([`mist`](super::mist)) |
///
/// # Valid for
/// Free gears of 0.3 m class up to 12 000 r/min in air. On a 200 mm gear it agrees with
/// [`Dawson1984`](super::Dawson1984) within 12 %.
///
/// # Departs from the source
/// Nothing. For a mist its density and viscosity stand for those of air. `enclosure` is not used: walls
/// enter by their distance. Speed 0 gives 0.
///
/// # Source
/// `[diab2004]`, first of the two models. The number of the equation there is not known to us.
///
/// # Example
/// By hand, the gear of [`Disc::typical`]: Re = 1.2 · 1047.2 · 0.01/18e-6 = 698 132,
/// C_t = 60 · 0.034595 · 0.574349 · 0.228653 · 1.765053 = 0.48115,
/// P = 0.5 · 0.48115 · 1.2 · 1047.2³ · 1e-5 = 3315 W.
/// ```
/// # use willis::losses::windage::{Diab, Disc, Law};
/// assert_eq!(format!("{:.0}", Diab::DEFAULT.eval(&Disc::typical())), "3315");
/// assert!(Diab::DEFAULT.outside(&Disc::typical()).is_empty());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Diab;

impl Diab {
    /// As published.
    pub const DEFAULT: Self = Self;
}

impl Law for Diab {
    const META: LawInfo<Disc<f64>> = LawInfo {
        id: "diab",
        by: "Diab",
        title: "Diab, Ville and Velex 2004",
        source: ("diab2004", "dimensional analysis"),
        trust: Trust::Confirm("all constants and exponents"),
        tags: &[],
        valid: &[ValidityRange { symbol: "omega", unit: "rad/s", min: 0.0, max: 1256.7, get: |s| s.speed }],
    };

    fn eval<D: Real>(&self, s: &Disc<D>) -> D {
        if s.speed.re() <= 0.0 {
            return D::from(0.0);
        }
        let r = s.radius;
        let re = s.speed * (s.density * r * r / s.viscosity);
        let [first, second] = s.axial_gaps.map(|h| power(h / r, 0.56));
        let walls = first + second;
        let c_t = re.powf(-0.25) * ((s.width / r).powf(0.8) * 60.0 * s.teeth.powf(-0.4) * walls);
        c_t * s.speed.powi(3) * (s.density * 0.5 * r.powi(5))
    }
}
