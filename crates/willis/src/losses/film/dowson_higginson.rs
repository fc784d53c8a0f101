use super::{FilmContact, Law, groups};
use crate::Real;
use crate::losses::{LawInfo, ValidityRange, Trust};

/// Smallest film thickness of a line contact after Dowson and Higginson.
///
/// # Formula
/// ```text
/// h = 2.65 · R · U^0.7 · G^0.54 · W^(−0.13)
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
/// Nothing. Programs that insert the modulus E* of Hertz (half of E') or the sum of the speeds are off by
/// 2^0.29 and 2^0.7.
///
/// # Source
/// `[dowson1977]`, line contact, smallest film thickness.
/// The number of the equation there is not known to us.
///
/// # Example
/// By hand with U = 1e−11, G = 5000, W = 1e−4: 2.65 · 0.01 · 1.9953e−8 · 99.413 · 3.3113
/// = 1.7406e−7 m.
/// ```
/// # use willis::losses::film::{FilmContact, DowsonHigginson, Law};
/// let contact = FilmContact {
///     radius: 10e-3,
///     mean_speed: 1.0,
///     line_load: 200e3,
///     dynamic_viscosity: 20e-3,
///     pressure_viscosity: 25e-9,
///     reduced_modulus: 200e9,
/// };
/// assert_eq!(format!("{:.4e}", DowsonHigginson::DEFAULT.eval(&contact)), "1.7406e-7");
/// assert!(DowsonHigginson::DEFAULT.outside(&contact).is_empty());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DowsonHigginson;

impl DowsonHigginson {
    /// As published.
    pub const DEFAULT: Self = Self;
}

impl Law for DowsonHigginson {
    const META: LawInfo<FilmContact<f64>> = LawInfo {
        id: "dowson-higginson",
        by: "Dowson–Higginson",
        title: "Dowson–Higginson, smallest thickness",
        source: ("dowson1977", "line contact, smallest film thickness"),
        trust: Trust::Seen,
        tags: &[],
        valid: &[
            ValidityRange { symbol: "u", unit: "m/s", min: 0.0, max: 50.0, get: |s| s.mean_speed },
            ValidityRange { symbol: "h", unit: "m", min: 0.0, max: 3e-6, get: |s| DowsonHigginson.eval(s) },
        ],
    };

    fn eval<D: Real>(&self, s: &FilmContact<D>) -> D {
        let (u, g, w) = groups(s);
        s.radius * u.powf(0.7) * g.powf(0.54) * w.powf(-0.13) * 2.65
    }
}
