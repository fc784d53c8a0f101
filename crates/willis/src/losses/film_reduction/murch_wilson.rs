use super::{Inlet, Law, slide, thermal_load};
use crate::Real;
use crate::losses::{LawInfo, Trust};

/// Thinning of the film by shear heating of the inlet: Murch and Wilson's, with sliding after Wilson and Sheu.
///
/// # Formula
/// ```text
/// φ_T = 1 / (1 + 0.1 · (1 + 14.8 · SRR^0.83) · L^0.64),   L = η β u²/k
/// ```
///
/// # Symbols
/// | there | here                | unit there | meaning                                  |
/// |-------|---------------------|------------|------------------------------------------|
/// | SRR   | `slide_ratio`       | −          | sliding speed over mean surface speed    |
/// | η     | `dynamic_viscosity` | Pa s       | viscosity at the inlet                   |
/// | β     | `viscosity_slope`   | 1/K        | −(1/η) dη/dT                             |
/// | u     | `mean_speed`        | m/s        | MEAN surface speed                       |
/// | k     | `conductivity`      | W/(m K)    | thermal conductivity of the oil          |
///
/// # Valid for
/// Line contacts; its users state no numeric range. The factor stays between 0 and 1 everywhere.
///
/// # Departs from the source
/// Written as its users write it. Wilson and Sheu print 0.241 in place of 0.1 with the mean speed in L, and the
/// sliding over the SUM of the speeds, half of SRR, in the power 0.83; for pure rolling theirs is close to
/// `1/(1 + 0.254 L^0.62)` of Murch and Wilson (their Eq. 9). 0.1 would go with the sum of the speeds in L
/// (4^0.64 · 0.1 = 0.243). So this law thins the film less than theirs.
/// A public program puts the sliding speed in m/s where the slide-roll ratio belongs.
/// The ratio is not taken below 1e−9, for the sake of derivatives.
///
/// # Source
/// `[wilsonsheu1983]`, Eq. (7), which extends `[murch1975]` to sliding; with the factor 0.1 as coded in `[gearpie]`.
///
/// # Example
/// By hand: L = 0.05 · 0.028 · 10²/0.14 = 1; 0.3^0.83 = 0.36814; 1/(1 + 0.1 · (1 + 14.8 · 0.36814))
/// = 0.60796.
/// ```
/// # use willis::losses::film_reduction::{Inlet, Law, MurchWilson};
/// let inlet = Inlet {
///     dynamic_viscosity: 0.05,
///     viscosity_slope: 0.028,
///     mean_speed: 10.0,
///     conductivity: 0.14,
///     slide_ratio: 0.3,
///     ..Inlet::typical()
/// };
/// assert_eq!(format!("{:.5}", MurchWilson::DEFAULT.eval(&inlet)), "0.60796");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MurchWilson;

impl MurchWilson {
    /// As published.
    pub const DEFAULT: Self = Self;
}

impl Law for MurchWilson {
    const META: LawInfo<Inlet<f64>> = LawInfo {
        id: "murch-wilson",
        by: "Murch–Wilson",
        title: "Murch–Wilson, shear heating of the inlet",
        source: ("wilsonsheu1983", "Eq. (7), with 0.1 for its 0.241"),
        trust: Trust::Confirm("the factor 0.1 with the mean speed, and SRR over the mean speed"),
        tags: &[],
        valid: &[],
    };

    fn eval<D: Real>(&self, s: &Inlet<D>) -> D {
        let sliding = slide(s).powf(0.83) * 14.8 + 1.0;
        (sliding * thermal_load(s).powf(0.64) * 0.1 + 1.0).recip()
    }
}
