use super::{BuckinghamMerritt, Law, PathOfContact};
use crate::Real;
use crate::losses::{LawInfo, ValidityRange, Trust};

/// Loss factor of ISO/TR 14179-1, the thermal rating that came from AGMA: that of Buckingham and Merritt, with the
/// helix.
///
/// # Formula
/// ```text
/// P = f_m T_1 n_1 cos²β_w/(9549 M),   M = 2 cos α_w (H_s + H_t)/(H_s² + H_t²)
/// H_V = cos²β_w/M
/// ```
///
/// # Symbols
/// | there    | here              | unit there | meaning                                         |
/// |----------|-------------------|------------|-------------------------------------------------|
/// | β_w      | `operating_helix` | rad        | helix angle at the operating circles            |
/// | M        |                   | −          | mesh mechanical advantage                       |
/// | H_s, H_t | `teeth`, `e`      | −          | sliding ratios, see [`BuckinghamMerritt`]       |
/// | α_w      |                   | rad        | operating transverse pressure angle; drops out  |
///
/// # Valid for
/// External pairs. The load is taken as uniform along the path.
///
/// # Departs from the source
/// The sliding ratios are expressed by the addendum contact ratios, and a ring takes their difference, as in
/// [`BuckinghamMerritt`].
///
/// # Source
/// `[isotr14179_1]`, mesh power loss and mesh mechanical advantage. The numbers of the equations there are not known
/// to us.
///
/// # Example
/// 17/22 spur, by hand as [`BuckinghamMerritt`]: 0.25364. With β_w = 20°: 0.25364 · 0.88302 = 0.22397.
/// ```
/// # use willis::losses::loss_factor::{Iso14179Part1, Law, PathOfContact};
/// let path = PathOfContact { operating_helix: 20f64.to_radians(), ..PathOfContact::typical() };
/// assert_eq!(format!("{:.5}", Iso14179Part1::DEFAULT.eval(&path)), "0.22397");
/// assert!(Iso14179Part1::DEFAULT.outside(&path).is_empty());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iso14179Part1;

impl Iso14179Part1 {
    /// As published.
    pub const DEFAULT: Self = Self;
}

impl Law for Iso14179Part1 {
    const META: LawInfo<PathOfContact<f64>> = LawInfo {
        id: "iso-14179-1",
        by: "ISO/TR 14179-1",
        title: "ISO/TR 14179-1 (AGMA)",
        source: ("isotr14179_1", "mesh mechanical advantage"),
        trust: Trust::Confirm("the square of cos β_w"),
        tags: &[],
        valid: &[
            ValidityRange { symbol: "e_1", unit: "-", min: 0.0, max: f64::INFINITY, get: |s| s.e[0] },
            ValidityRange { symbol: "e_2", unit: "-", min: 0.0, max: f64::INFINITY, get: |s| s.e[1] },
            ValidityRange { symbol: "c' C_a b/F_bt", unit: "-", min: 0.0, max: 0.0, get: |s| s.relief.largest() },
        ],
    };

    fn eval<D: Real>(&self, s: &PathOfContact<D>) -> D {
        BuckinghamMerritt::DEFAULT.eval(s) * s.operating_helix.cos().powi(2)
    }
}
