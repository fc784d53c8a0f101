use super::{Drum, Law};
use crate::losses::{LawInfo, Tag, Trust};
use crate::real::{self, Real};

/// Drag of a smooth drum in a housing: its rim after Bilgen and Boulos, its faces after Daily and Nece.
///
/// # Formula
/// ```text
/// P = P_rim + P_faces
/// P_rim = 0.5 π C_f ρ ω³ R⁴ L,  Re_t = ρ ω R t/μ
/// C_f = 5 (t/R)^0.3 Re_t^−1 (Re_t < 64),  (t/R)^0.3 Re_t^−0.6 (< 500),
///       0.515 (t/R)^0.3 Re_t^−0.5 (< 1e4),  0.0325 (t/R)^0.3 Re_t^−0.2 (above)
/// P_faces = 0.5 C_m ρ ω³ R⁵,  Re = ρ ω R²/μ,  G = s/R
/// C_m = max(2π/(G Re), 3.70 G^0.1 Re^−0.5, 0.08 G^(−1/6) Re^−0.25, 0.102 G^0.1 Re^−0.2)
/// ```
///
/// # Symbols
/// | there | here         | unit there | meaning                                       |
/// |-------|--------------|------------|-----------------------------------------------|
/// | ω     | `speed`      | rad/s      | angular speed relative to the surroundings    |
/// | R     | `radius`     | m          | outer radius                                  |
/// | L     | `length`     | m          | axial length of the rim                       |
/// | t     | `radial_gap` | m          | radial gap between rim and wall               |
/// | s     | `axial_gap`  | m          | axial gap between each face and the wall      |
/// | ρ, μ  | `density`, `viscosity` | kg/m³, Pa s | fluid, air or mist                |
///
/// # Valid for
/// Smooth bodies without through flow. For a planet carrier, whose windows and pins are not smooth,
/// an estimate good to about half its value, probably too low.
///
/// # Departs from the source
/// Daily and Nece draw the borders of their four regimes in a chart; the largest of the four values
/// is taken, which meets those borders and is continuous. C_m counts both faces. The two rim formulas
/// below Re_t = 500 stand as recalled. Gaps below 1e-4 R count as 1e-4 R. Speed 0 gives 0.
///
/// # Source
/// `[bilgenboulos1973]`, coaxial cylinders; `[dailynece1960]`, enclosed rotating disks. The numbers of the
/// equations there are not known to us. `[harmand2013]`, section 2.4.1, prints Daily and Nece's four, for
/// one face, as (38) to (41).
///
/// # Example
/// By hand, the drum of [`Drum::typical`]: Re_t = 1.2 · 104.72 · 0.15 · 0.015/18e-6 = 15 708,
/// C_f = 0.0325 · 0.1^0.3 · 15708^−0.2 = 0.0023579, P_rim = 0.26 W; Re = 157 080, G = 0.1,
/// C_m = max(4.0e-4, 0.007416, 0.005899, 0.007406) = 0.007416, P_faces = 0.39 W; sum 0.65 W.
/// ```
/// # use willis::losses::rotor_drag::{BilgenBoulosDailyNece, Drum, Law};
/// assert_eq!(format!("{:.2}", BilgenBoulosDailyNece::DEFAULT.eval(&Drum::typical())), "0.65");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BilgenBoulosDailyNece;

impl BilgenBoulosDailyNece {
    /// As published.
    pub const DEFAULT: Self = Self;
}

impl Law for BilgenBoulosDailyNece {
    const META: LawInfo<Drum<f64>> = LawInfo {
        id: "bilgen-boulos-daily-nece",
        by: "Bilgen–Boulos and Daily–Nece",
        title: "Bilgen and Boulos (rim), Daily and Nece (faces)",
        source: ("bilgenboulos1973", "torque coefficients; faces: dailynece1960, as (38) to (41) of Harmand 2013"),
        trust: Trust::Confirm("Daily and Nece's constants; rim below Re_t = 500"),
        tags: &[Tag::Estimate],
        valid: &[],
    };

    fn eval<D: Real>(&self, s: &Drum<D>) -> D {
        if s.speed.re() <= 0.0 {
            return D::from(0.0);
        }
        let r = s.radius;
        let per_area = s.speed * (s.density / s.viscosity);

        let gap = real::max(s.radial_gap / r, D::from(1e-4));
        let re_t = per_area * (r * r * gap);
        let (factor, power) = match re_t.re() {
            x if x < 64.0 => (5.0, -1.0),
            x if x < 500.0 => (1.0, -0.6),
            x if x < 1e4 => (0.515, -0.5),
            _ => (0.0325, -0.2),
        };
        let rim = re_t.powf(power) * (gap.powf(0.3) * (0.5 * std::f64::consts::PI * factor) * r.powi(4) * s.length);

        let g = real::max(s.axial_gap / r, D::from(1e-4));
        let re = per_area * (r * r);
        let laminar = real::max(re.recip() * (D::from(std::f64::consts::TAU) / g), re.powf(-0.5) * (g.powf(0.1) * 3.70));
        let turbulent =
            real::max(re.powf(-0.25) * (g.powf(-1.0 / 6.0) * 0.08), re.powf(-0.2) * (g.powf(0.1) * 0.102));
        let faces = real::max(laminar, turbulent) * (r.powi(5) * 0.5);

        (rim + faces) * s.speed.powi(3) * s.density
    }
}
