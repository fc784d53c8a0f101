use super::{FilmContact, Law, groups};
use crate::Real;
use crate::losses::{LawInfo, ValidityRange, Trust};

/// Central film thickness of a line contact after Grubin.
///
/// # Formula
/// ```text
/// h = 1.95 · R · (U · G)^(8/11) · W^(−1/11)
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
/// Nothing. It is the CENTRAL thickness, and known to be somewhat too thick.
///
/// # Source
/// `[grubin1949]`, as coded in `[gearpie]`. The number of the equation there is not known to us.
///
/// # Example
/// By hand with U = 1e−11, G = 5000, W = 1e−4: 1.95 · 0.01 · 4.8996e−6 · 2.3101
/// = 2.2071e−7 m.
/// ```
/// # use willis::losses::film::{FilmContact, Grubin, Law};
/// let contact = FilmContact {
///     radius: 10e-3,
///     mean_speed: 1.0,
///     line_load: 200e3,
///     dynamic_viscosity: 20e-3,
///     pressure_viscosity: 25e-9,
///     reduced_modulus: 200e9,
/// };
/// assert_eq!(format!("{:.4e}", Grubin::DEFAULT.eval(&contact)), "2.2071e-7");
/// assert!(Grubin::DEFAULT.outside(&contact).is_empty());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grubin;

impl Grubin {
    /// As published.
    pub const DEFAULT: Self = Self;
}

impl Law for Grubin {
    const META: LawInfo<FilmContact<f64>> = LawInfo {
        id: "grubin",
        by: "Grubin",
        title: "Grubin, central thickness",
        source: ("grubin1949", "central film thickness, as coded in GEARpie"),
        trust: Trust::Seen,
        tags: &[],
        valid: &[
            ValidityRange { symbol: "u", unit: "m/s", min: 0.0, max: 50.0, get: |s| s.mean_speed },
            ValidityRange { symbol: "h", unit: "m", min: 0.0, max: 3e-6, get: |s| Grubin.eval(s) },
        ],
    };

    fn eval<D: Real>(&self, s: &FilmContact<D>) -> D {
        let (u, g, w) = groups(s);
        s.radius * (u * g).powf(8.0 / 11.0) * w.powf(-1.0 / 11.0) * 1.95
    }
}
