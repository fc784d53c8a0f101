use super::{Law, PathOfContact};
use crate::Real;
use crate::losses::{LawInfo, ValidityRange, Trust};
use crate::real::abs;

/// Loss factor of helical gears with the load spread evenly over the path of contact.
///
/// # Formula
/// ```text
/// H_V = K (e_1|e_1| + e_2|e_2|)/ε_α        K = π (1/z_1 ± 1/z_2)/cos β_b
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
/// Helical gears with an overlap ratio of 1 or more, exact for a whole one; 0.6 % too high at an
/// overlap ratio of 1.36. For spur gears it is too high by about a fifth against 50/50.
///
/// # Departs from the source
/// Written with e|e|, so that it also holds when a tip does not reach the pitch point.
///
/// # Source
/// `[niemann_winter2003]`, helical gears; derived. The number of the equation there is not known to us.
///
/// # Example
/// 35/31 with helix 22°, e = 0.75896, 0.74886, by hand: K = π (1/35 + 1/31)/cos 20.6106° = 0.20417,
/// H = 0.20417 · 1.13680/1.50781 = 0.15393.
/// ```
/// # use willis::losses::loss_factor::{Law, PathOfContact, Uniform};
/// let path = PathOfContact {
///     teeth: [35.0, 31.0],
///     internal: false,
///     base_helix: 20.61061429628295f64.to_radians(),
///     e: [0.7589558, 0.7488578],
///     overlap_ratio: 1.3628,
///     operating_helix: 22f64.to_radians(),
///     ..PathOfContact::typical()
/// };
/// assert_eq!(format!("{:.5}", Uniform::DEFAULT.eval(&path)), "0.15393");
/// assert!(Uniform::DEFAULT.outside(&path).is_empty());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Uniform;

impl Uniform {
    /// As derived.
    pub const DEFAULT: Self = Self;
}

impl Law for Uniform {
    const META: LawInfo<PathOfContact<f64>> = LawInfo {
        id: "uniform",
        by: "",
        title: "Uniform load along the path, helical gears",
        source: ("niemann_winter2003", "helical gears"),
        trust: Trust::Derived,
        tags: &[],
        valid: &[
            ValidityRange { symbol: "e_b", unit: "-", min: 1.0, max: f64::INFINITY, get: |s| s.overlap_ratio },
            ValidityRange { symbol: "e_a", unit: "-", min: 0.0, max: f64::INFINITY, get: |s| s.e[0] + s.e[1] },
            ValidityRange { symbol: "c' C_a b/F_bt", unit: "-", min: 0.0, max: 0.0, get: |s| s.relief.largest() },
        ],
    };

    fn eval<D: Real>(&self, s: &PathOfContact<D>) -> D {
        let [e_1, e_2] = s.e;
        if s.contact_ratio().re() <= 0.0 {
            return D::zero();
        }
        (e_1 * abs(e_1) + e_2 * abs(e_2)) / s.contact_ratio() * s.factor()
    }
}
