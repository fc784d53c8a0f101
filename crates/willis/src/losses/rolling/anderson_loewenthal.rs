use super::{Law, RollingContact};
use crate::Real;
use crate::losses::{LawInfo, ValidityRange, Trust};

/// Rolling loss of one line of contact after Anderson and Loewenthal (NASA TP-1622): proportional
/// to the film thickness.
///
/// # Formula
/// ```text
/// P = F_r · v_Σ,   F_r = 9.0e7 · φ_T · h · L,   h = 2.051e−7 · (v_Σ · η)^0.67 · F_n^(−0.067) · ρ^0.464
/// ```
///
/// # Symbols
/// | there | here                | unit there | meaning                                  |
/// |-------|---------------------|------------|------------------------------------------|
/// | v_Σ   | `sum_speed`         | m/s        | SUM of the surface speeds                |
/// | η     | `dynamic_viscosity` | mPa s      | dynamic viscosity of the oil             |
/// | F_n   | `normal_force`      | N          | normal force on the line                 |
/// | ρ     | `radius`            | m          | reduced radius of curvature              |
/// | L     | `length`            | m          | length of the line                       |
/// | φ_T   | `film_reduction`    | −          | thermal reduction of the film            |
///
/// # Valid for
/// Steel gears in mineral oil. Above a sum of the speeds of 100 m/s, and for films above 3 µm, it is an
/// extrapolation, flagged by the range in [`Law::META`]. Not to be added to a law of friction
/// that contains rolling (Schlenk, Fernandes).
///
/// # Departs from the source
/// Nothing known. The thermal reduction is the one in force; the source has its own.
///
/// # Source
/// `[anderson1980]`, rolling loss. The factor 9.0e7 N/m² is also Crook's, 1.3e4 lb/in².
/// The number of the equation there is not known to us.
///
/// # Example
/// By hand: h = 2.051e−7 · 300^0.67 · 5000^(−0.067) · 0.01^0.464 = 6.2489e−7 m;
/// F_r = 9e7 · 6.2489e−7 · 0.02 = 1.12481 N; P = 11.248 W.
/// ```
/// # use willis::losses::rolling::{AndersonLoewenthal, Law, RollingContact};
/// let contact = RollingContact {
///     sum_speed: 10.0,
///     dynamic_viscosity: 30e-3,
///     normal_force: 5000.0,
///     radius: 10e-3,
///     length: 20e-3,
///     film_reduction: 1.0,
///     ..RollingContact::typical()
/// };
/// assert_eq!(format!("{:.3}", AndersonLoewenthal::DEFAULT.eval(&contact)), "11.248");
/// assert!(AndersonLoewenthal::DEFAULT.outside(&contact).is_empty());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AndersonLoewenthal;

impl AndersonLoewenthal {
    /// As published.
    pub const DEFAULT: Self = Self;
}

/// Isothermal film thickness of the source, m.
fn film<D: Real>(s: &RollingContact<D>) -> D {
    let eta_mpa_s = s.dynamic_viscosity * 1e3;
    (s.sum_speed * eta_mpa_s).powf(0.67) * s.normal_force.powf(-0.067) * s.radius.powf(0.464) * 2.051e-7
}

impl Law for AndersonLoewenthal {
    const META: LawInfo<RollingContact<f64>> = LawInfo {
        id: "anderson-loewenthal",
        by: "Anderson–Loewenthal",
        title: "Anderson–Loewenthal (NASA TP-1622)",
        source: ("anderson1980", "rolling loss"),
        trust: Trust::Confirm("2.051e-7 and the exponents 0.67, −0.067, 0.464"),
        tags: &[],
        valid: &[
            ValidityRange { symbol: "v_Σ", unit: "m/s", min: 0.0, max: 100.0, get: |s| s.sum_speed },
            ValidityRange { symbol: "h", unit: "m", min: 0.0, max: 3e-6, get: film },
        ],
    };

    fn eval<D: Real>(&self, s: &RollingContact<D>) -> D {
        let force = s.film_reduction * film(s) * s.length * 9.0e7;
        force * s.sum_speed
    }
}
