use super::{Inlet, Law, slide, thermal_load};
use crate::Real;
use crate::losses::{LawInfo, ValidityRange, Trust};
use crate::real::max;

/// Thinning of the film by shear heating of the inlet after Gupta, Cheng and others.
///
/// # Formula
/// ```text
/// φ_T = (1 − 13.2 · (p_H/E') · L^0.42) / (1 + 0.213 · (1 + 2.23 · SRR^0.83) · L^0.64),   L = η β u²/k
/// ```
///
/// # Symbols
/// | there | here                | unit there | meaning                                  |
/// |-------|---------------------|------------|------------------------------------------|
/// | p_H   | `hertz_pressure`    | Pa         | Hertzian pressure                        |
/// | E'    | `reduced_modulus`   | Pa         | 2/((1 − ν1²)/E1 + (1 − ν2²)/E2)          |
/// | SRR   | `slide_ratio`       | −          | sliding speed over mean surface speed    |
/// | η     | `dynamic_viscosity` | Pa s       | viscosity at the inlet                   |
/// | β     | `viscosity_slope`   | 1/K        | −(1/η) dη/dT                             |
/// | u     | `mean_speed`        | m/s        | MEAN surface speed                       |
/// | k     | `conductivity`      | W/(m K)    | thermal conductivity of the oil          |
///
/// # Valid for
/// Line contacts with a numerator well above zero, see [`Law::META`]; its users state no numeric range.
///
/// # Departs from the source
/// The numerator becomes negative at high speed and pressure; it is not taken below 0.1, and the
/// range in [`Law::META`] flags it. The ratio is not taken below 1e−9, for the sake of derivatives.
///
/// # Source
/// `[gupta1992]`, as printed in `[arana2019]`, Eq. (24).
///
/// # Example
/// By hand: L = 0.05 · 0.028 · 10²/0.14 = 1; 0.3^0.83 = 0.36814;
/// (1 − 13.2 · 1/226.3736)/(1 + 0.213 · (1 + 2.23 · 0.36814)) = 0.941689/1.387861 = 0.67852.
/// ```
/// # use willis::losses::film_reduction::{GuptaCheng, Inlet, Law};
/// let inlet = Inlet {
///     dynamic_viscosity: 0.05,
///     viscosity_slope: 0.028,
///     mean_speed: 10.0,
///     conductivity: 0.14,
///     slide_ratio: 0.3,
///     hertz_pressure: 1e9,
///     reduced_modulus: 226.3736e9,
/// };
/// assert_eq!(format!("{:.5}", GuptaCheng::DEFAULT.eval(&inlet)), "0.67852");
/// assert!(GuptaCheng::DEFAULT.outside(&inlet).is_empty());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GuptaCheng;

impl GuptaCheng {
    /// As published.
    pub const DEFAULT: Self = Self;
}

/// `13.2 · (p_H/E') · L^0.42`.
fn pressed<D: Real>(s: &Inlet<D>) -> D {
    s.hertz_pressure / s.reduced_modulus * thermal_load(s).powf(0.42) * 13.2
}

impl Law for GuptaCheng {
    const META: LawInfo<Inlet<f64>> = LawInfo {
        id: "gupta-cheng",
        by: "Gupta–Cheng",
        title: "Gupta–Cheng, shear heating of the inlet",
        source: ("gupta1992", "thermal reduction, as printed in Arana 2019, Eq. (24)"),
        trust: Trust::Seen,
        tags: &[],
        valid: &[ValidityRange { symbol: "13.2 p_H/E' L^0.42", unit: "-", min: 0.0, max: 0.9, get: pressed }],
    };

    fn eval<D: Real>(&self, s: &Inlet<D>) -> D {
        let numerator = max(-pressed(s) + 1.0, D::from(0.1));
        let sliding = slide(s).powf(0.83) * 2.23 + 1.0;
        numerator / (sliding * thermal_load(s).powf(0.64) * 0.213 + 1.0)
    }
}
