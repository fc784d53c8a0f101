use super::{Law, RollingContact};
use crate::Real;
use crate::losses::{LawInfo, ValidityRange, Trust};

/// Rolling loss of one line of contact after Goksem and Hargreaves: rolling traction of the inlet.
///
/// # Formula
/// ```text
/// P = F_r · L · v_Σ,   F_r = 4.318 · φ_T · (G U)^0.658 · W^0.0126 · R/α
/// U = η u / (E' R),   G = α E',   W = w / (E' R),   u = v_Σ/2,   w = F_n/L
/// ```
///
/// # Symbols
/// | there | here                 | unit there | meaning                                  |
/// |-------|----------------------|------------|------------------------------------------|
/// | φ_T   | `film_reduction`     | −          | thermal reduction of the film            |
/// | v_Σ   | `sum_speed`          | m/s        | SUM of the surface speeds                |
/// | R     | `radius`             | m          | reduced radius of curvature              |
/// | F_n   | `normal_force`       | N          | normal force on the line                 |
/// | L     | `length`             | m          | length of the line                       |
/// | η     | `dynamic_viscosity`  | Pa s       | viscosity at the inlet                   |
/// | α     | `pressure_viscosity` | 1/Pa       | pressure-viscosity coefficient           |
/// | E'    | `reduced_modulus`    | Pa         | 2/((1 − ν1²)/E1 + (1 − ν2²)/E2)          |
///
/// # Valid for
/// Line contacts with a full film. Above a sum of the speeds of 100 m/s it is an extrapolation, flagged
/// by the range in [`Law::META`]. Not to be added to a law of friction that contains rolling (Schlenk,
/// Fernandes).
///
/// # Departs from the source
/// Nothing known; the constants are those that Aihara prints. The force acts on both surfaces, so that the
/// power is taken with the sum of their speeds.
///
/// # Source
/// `[goksem1978]`, rolling traction. The number of the equation there is not known to us. `[aihara1987]`
/// prints it without φ_T as Eq. (19).
///
/// # Example
/// By hand with U = 1e−11, G = 5000, W = 1e−4, R/α = 4e5:
/// F_r = 4.318 · (5e−8)^0.658 · 1e−4^0.0126 · 4e5 = 24.147 N/m; P = 24.147 · 0.02 · 2 = 0.96588 W.
/// ```
/// # use willis::losses::rolling::{GoksemHargreaves, Law, RollingContact};
/// let contact = RollingContact {
///     sum_speed: 2.0,
///     radius: 10e-3,
///     normal_force: 4000.0,
///     length: 20e-3,
///     dynamic_viscosity: 20e-3,
///     pressure_viscosity: 25e-9,
///     reduced_modulus: 200e9,
///     film_reduction: 1.0,
/// };
/// assert_eq!(format!("{:.5}", GoksemHargreaves::DEFAULT.eval(&contact)), "0.96588");
/// assert!(GoksemHargreaves::DEFAULT.outside(&contact).is_empty());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GoksemHargreaves;

impl GoksemHargreaves {
    /// As published.
    pub const DEFAULT: Self = Self;
}

impl Law for GoksemHargreaves {
    const META: LawInfo<RollingContact<f64>> = LawInfo {
        id: "goksem-hargreaves",
        by: "Goksem–Hargreaves",
        title: "Goksem–Hargreaves, rolling traction",
        source: ("goksem1978", "rolling traction; Eq. (19) of Aihara 1987"),
        trust: Trust::Confirm("4.318 and the exponents 0.658, 0.0126, and the sum of the speeds in the power"),
        tags: &[],
        valid: &[ValidityRange { symbol: "v_Σ", unit: "m/s", min: 0.0, max: 100.0, get: |s| s.sum_speed }],
    };

    fn eval<D: Real>(&self, s: &RollingContact<D>) -> D {
        let stiffness = s.radius * s.reduced_modulus;
        let u = s.dynamic_viscosity * s.sum_speed * 0.5 / stiffness;
        let g = s.pressure_viscosity * s.reduced_modulus;
        let w = s.normal_force / s.length / stiffness;
        let force =
            s.film_reduction * (g * u).powf(0.658) * w.powf(0.0126) * s.radius / s.pressure_viscosity * 4.318;
        force * s.length * s.sum_speed
    }
}
