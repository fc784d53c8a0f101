use super::{Law, PathOfContact};
use crate::Real;
use crate::losses::{LawInfo, ValidityRange, Trust};
use crate::real::abs;

/// Loss factor in closed form for 50/50 sharing, for addendum contact ratios of any size.
///
/// # Formula
/// ```text
/// H_V = K/2 {e_1|e_1| + e_2|e_2| + (1 − e_1)|1 − e_1| + (1 − e_2)|1 − e_2|}
/// K = π (1/z_1 ± 1/z_2)/cos β_b
/// ```
///
/// # Symbols
/// | there    | here         | unit there | meaning                         |
/// |----------|--------------|------------|---------------------------------|
/// | z_1, z_2 | `teeth`      | −          | tooth counts; − in K for a ring |
/// | β_b      | `base_helix` | rad        | helix angle at the base circle  |
/// | e_1, e_2 | `e`          | −          | addendum contact ratios         |
///
/// # Valid for
/// Spur gears with a contact ratio of 1 to 2, half the load on each pair in double contact, one
/// coefficient of friction, no tip relief. It is the integral of [`Integrated`](super::Integrated)
/// there, also where one addendum contact ratio is above 1, as is usual with rings.
///
/// # Departs from the source
/// Ohlendorf's polynomial follows for e_1, e_2 of 0 to 1. The absolute values extend it.
///
/// # Source
/// `[ohlendorf1958]`; the extension is derived here. The number of the equation there is not known to us.
/// For external pairs the polynomial is also formula (91) of `[isotr15144_1]`.
///
/// # Example
/// Planet 22 in ring 61, e = 0.79035 and 1.16681, by hand: K = π (1/22 − 1/61) = 0.091298,
/// H = K/2 · (0.62465 + 1.36145 + 0.04395 − 0.02783) = 0.09140.
/// ```
/// # use willis::losses::loss_factor::{Law, PathOfContact, TwoPair};
/// let path = PathOfContact { teeth: [22.0, 61.0], internal: true, e: [0.79035, 1.16681], ..PathOfContact::typical() };
/// assert_eq!(format!("{:.5}", TwoPair::DEFAULT.eval(&path)), "0.09140");
/// assert!(TwoPair::DEFAULT.outside(&path).is_empty());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwoPair;

impl TwoPair {
    /// As derived.
    pub const DEFAULT: Self = Self;
}

impl Law for TwoPair {
    const META: LawInfo<PathOfContact<f64>> = LawInfo {
        id: "two-pair",
        by: "",
        title: "Closed form for 50/50, any addendum contact ratios",
        source: ("ohlendorf1958", "loss factor, extended; formula (91) of ISO/TR 15144-1"),
        trust: Trust::Derived,
        tags: &[],
        valid: &[
            ValidityRange { symbol: "e_a", unit: "-", min: 1.0, max: 2.0, get: |s| s.e[0] + s.e[1] },
            ValidityRange { symbol: "e_b", unit: "-", min: 0.0, max: 0.0, get: |s| s.overlap_ratio },
            ValidityRange { symbol: "c' C_a b/F_bt", unit: "-", min: 0.0, max: 0.0, get: |s| s.relief.largest() },
        ],
    };

    fn eval<D: Real>(&self, s: &PathOfContact<D>) -> D {
        let square = |d: &D| *d * abs(*d);
        let [e_1, e_2] = s.e;
        let sum = square(&e_1) + square(&e_2) + square(&(-e_1 + 1.0)) + square(&(-e_2 + 1.0));
        sum * (s.factor() / 2.0)
    }
}
