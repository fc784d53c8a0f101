use super::{FilmContact, Law, groups};
use crate::Real;
use crate::losses::{LawInfo, ValidityRange, Trust};

/// Smallest film thickness of a line contact after the first form of Dowson and Higginson, as Wang and
/// others (2020) use it for the regime of lubrication.
///
/// # Formula
/// ```text
/// h = 1.6 · R · U^0.7 · G^0.6 · W^(−0.13)
/// U = η u / (E' R),   G = α E',   W = w / (E' R)
/// ```
///
/// # Symbols
/// | there | here                 | unit there | meaning                                             |
/// |-------|----------------------|------------|-----------------------------------------------------|
/// | R     | `radius`             | m          | reduced radius of curvature                         |
/// | u     | `mean_speed`         | m/s        | MEAN surface speed, half of the sum                 |
/// | w     | `line_load`          | N/m        | load per length of contact line                     |
/// | η     | `dynamic_viscosity`  | Pa s       | viscosity at the inlet                              |
/// | α     | `pressure_viscosity` | 1/Pa       | pressure-viscosity coefficient                      |
/// | E'    | `reduced_modulus`    | Pa         | 2/((1 − ν1²)/E1 + (1 − ν2²)/E2), twice the E* of Hertz |
///
/// # Valid for
/// Line contact of steel, isothermal and fully flooded. Above 50 m/s, and for films above 3 µm, it is
/// an extrapolation, flagged by the range in [`Law::META`]; heating of the inlet is the family
/// [`film_reduction`](crate::losses::film_reduction).
///
/// # Departs from the source
/// The paper of 2020 prints `1.6 α^0.6 (η u)^0.7 E'^0.03 R^0.43 w^(−0.13)` with lost signs; the exponents 0.03
/// and −0.13 are forced by the dimensions.
///
/// # Source
/// `[dowson1966]`, as printed in `[wang2020]`, section 3.2.1.
///
/// # Example
/// By hand with U = 1e−11, G = 5000, W = 1e−4: 1.6 · 0.01 · 1.9953e−8 · 165.72 · 3.3113
/// = 1.7519e−7 m.
/// ```
/// # use willis::losses::film::{FilmContact, DowsonHigginson1966, Law};
/// let contact = FilmContact {
///     radius: 10e-3,
///     mean_speed: 1.0,
///     line_load: 200e3,
///     dynamic_viscosity: 20e-3,
///     pressure_viscosity: 25e-9,
///     reduced_modulus: 200e9,
/// };
/// assert_eq!(format!("{:.4e}", DowsonHigginson1966::DEFAULT.eval(&contact)), "1.7519e-7");
/// assert!(DowsonHigginson1966::DEFAULT.outside(&contact).is_empty());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DowsonHigginson1966;

impl DowsonHigginson1966 {
    /// As published.
    pub const DEFAULT: Self = Self;
}

impl Law for DowsonHigginson1966 {
    const META: LawInfo<FilmContact<f64>> = LawInfo {
        id: "dowson-higginson-1966",
        by: "Dowson–Higginson 1966",
        title: "Dowson–Higginson, smallest thickness, early form",
        source: ("dowson1966", "line contact, smallest film thickness, as printed in Wang 2020, section 3.2.1"),
        trust: Trust::Derived,
        tags: &[],
        valid: &[
            ValidityRange { symbol: "u", unit: "m/s", min: 0.0, max: 50.0, get: |s| s.mean_speed },
            ValidityRange { symbol: "h", unit: "m", min: 0.0, max: 3e-6, get: |s| DowsonHigginson1966.eval(s) },
        ],
    };

    fn eval<D: Real>(&self, s: &FilmContact<D>) -> D {
        let (u, g, w) = groups(s);
        s.radius * u.powf(0.7) * g.powf(0.6) * w.powf(-0.13) * 1.6
    }
}
