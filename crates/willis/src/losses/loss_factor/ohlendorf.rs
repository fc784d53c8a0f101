use super::{Law, PathOfContact};
use crate::Real;
use crate::losses::{LawInfo, ValidityRange, Trust};

/// Loss factor after Ohlendorf, as ISO/TR 14179-2 and the FZG literature use it.
///
/// # Formula
/// ```text
/// H_V = K (1 − ε_α + e_1² + e_2²)        K = π (1/z_1 ± 1/z_2)/cos β_b
/// ```
///
/// # Symbols
/// | there    | here         | unit there | meaning                         |
/// |----------|--------------|------------|---------------------------------|
/// | z_1, z_2 | `teeth`      | −          | tooth counts; − in K for a ring |
/// | β_b      | `base_helix` | rad        | helix angle at the base circle  |
/// | e_1, e_2 | `e`          | −          | addendum contact ratios         |
/// | ε_α      |              | −          | e_1 + e_2                       |
///
/// # Valid for
/// Spur gears, contact ratio 1 to 2, both addendum contact ratios 0 to 1, 50/50 sharing, no tip
/// relief. Outside it errs to the safe side: a planet in a ring often has e_2 > 1, and the
/// polynomial is then too high, by 2.8 % for 22/61. Used for helical gears in practice, where it
/// is too low: by 12.5 % for 20/30 with helix 15° and an overlap ratio of 0.54.
///
/// # Departs from the source
/// Nothing.
///
/// # Source
/// `[ohlendorf1958]` and `[isotr14179_2]`, tooth loss factor.
/// The number of the equation there is not known to us. For external pairs it is also formula (91) of
/// `[isotr15144_1]`.
///
/// # Example
/// 16/24, e = 0.7341, 0.7283, by hand: 0.32725 · (1 − 1.4624 + 0.5389 + 0.5305) = 0.1986.
/// ```
/// # use willis::losses::loss_factor::{Law, Ohlendorf, PathOfContact};
/// let path = PathOfContact { teeth: [16.0, 24.0], e: [0.7341, 0.728331], ..PathOfContact::typical() };
/// assert_eq!(format!("{:.4}", Ohlendorf::DEFAULT.eval(&path)), "0.1986");
/// assert!(Ohlendorf::DEFAULT.outside(&path).is_empty());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ohlendorf;

impl Ohlendorf {
    /// As published.
    pub const DEFAULT: Self = Self;
}

impl Law for Ohlendorf {
    const META: LawInfo<PathOfContact<f64>> = LawInfo {
        id: "ohlendorf",
        by: "Ohlendorf",
        title: "Ohlendorf (ISO/TR 14179-2)",
        source: ("ohlendorf1958", "loss factor; formula (91) of ISO/TR 15144-1"),
        trust: Trust::Seen,
        tags: &[],
        valid: &[
            ValidityRange { symbol: "e_a", unit: "-", min: 1.0, max: 2.0, get: |s| s.e[0] + s.e[1] },
            ValidityRange { symbol: "e_1", unit: "-", min: 0.0, max: 1.0, get: |s| s.e[0] },
            ValidityRange { symbol: "e_2", unit: "-", min: 0.0, max: 1.0, get: |s| s.e[1] },
            ValidityRange { symbol: "e_b", unit: "-", min: 0.0, max: 0.0, get: |s| s.overlap_ratio },
            ValidityRange { symbol: "c' C_a b/F_bt", unit: "-", min: 0.0, max: 0.0, get: |s| s.relief.largest() },
        ],
    };

    fn eval<D: Real>(&self, s: &PathOfContact<D>) -> D {
        let [e_1, e_2] = s.e;
        (-s.contact_ratio() + 1.0 + e_1 * e_1 + e_2 * e_2) * s.factor()
    }
}
