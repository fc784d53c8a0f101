use super::{FilmContact, Law, groups};
use crate::Real;
use crate::losses::{LawInfo, ValidityRange, Trust};

/// Central film thickness of a line contact after Dowson and Toyoda.
///
/// # Formula
/// ```text
/// h = 3.06 · R · U^0.69 · G^0.56 · W^(−0.10)
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
/// Nothing known; the constants stand as recalled. It is the CENTRAL thickness, larger than the smallest one.
///
/// # Source
/// `[dowson_toyoda1979]`, central film thickness. The number of the equation there is not known to us.
///
/// # Example
/// By hand with U = 1e−11, G = 5000, W = 1e−4: 3.06 · 0.01 · 2.5704e−8 · 117.88 · 2.5119
/// = 2.3289e−7 m.
/// ```
/// # use willis::losses::film::{FilmContact, DowsonToyoda, Law};
/// let contact = FilmContact {
///     radius: 10e-3,
///     mean_speed: 1.0,
///     line_load: 200e3,
///     dynamic_viscosity: 20e-3,
///     pressure_viscosity: 25e-9,
///     reduced_modulus: 200e9,
/// };
/// assert_eq!(format!("{:.4e}", DowsonToyoda::DEFAULT.eval(&contact)), "2.3289e-7");
/// assert!(DowsonToyoda::DEFAULT.outside(&contact).is_empty());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DowsonToyoda;

impl DowsonToyoda {
    /// As published.
    pub const DEFAULT: Self = Self;
}

impl Law for DowsonToyoda {
    const META: LawInfo<FilmContact<f64>> = LawInfo {
        id: "dowson-toyoda",
        by: "Dowson–Toyoda",
        title: "Dowson–Toyoda, central thickness",
        source: ("dowson_toyoda1979", "central film thickness"),
        trust: Trust::Confirm("3.06 and the exponents 0.69, 0.56, −0.10"),
        tags: &[],
        valid: &[
            ValidityRange { symbol: "u", unit: "m/s", min: 0.0, max: 50.0, get: |s| s.mean_speed },
            ValidityRange { symbol: "h", unit: "m", min: 0.0, max: 3e-6, get: |s| DowsonToyoda.eval(s) },
        ],
    };

    fn eval<D: Real>(&self, s: &FilmContact<D>) -> D {
        let (u, g, w) = groups(s);
        s.radius * u.powf(0.69) * g.powf(0.56) * w.powf(-0.10) * 3.06
    }
}
