use super::{Law, PathOfContact};
use crate::Real;
use crate::losses::{LawInfo, ValidityRange, Trust};

/// Loss factor after Buckingham and Merritt, as American practice (AGMA, UTS) uses it.
///
/// # Formula
/// ```text
/// loss in percent = 50 μ/cos α_w · (H_s² + H_t²)/(H_s + H_t)
/// H_s = (u ± 1) (√(r_a2²/r_w2² − cos² α_w) − sin α_w)        ring: (u − 1)(sin α_w − √…)
/// H_t = (u ± 1)/u (√(r_a1²/r_w1² − cos² α_w) − sin α_w)
/// with e r_w: H_s = 2π cos α_w (u ± 1) e_2/z_2,  H_t = 2π cos α_w (u ± 1)/u · e_1/z_1
/// H_V = 1/(2 cos α_w) · (H_s² + H_t²)/(H_s + H_t) = π (1/z_1 ± 1/z_2)(e_1² + e_2²)/ε_α
/// ```
///
/// # Symbols
/// | there    | here    | unit there | meaning                              |
/// |----------|---------|------------|--------------------------------------|
/// | u        |         | −          | z_2/z_1 ≥ 1, ± is − for a ring       |
/// | z_1, z_2 | `teeth` | −          | tooth counts                         |
/// | e_1, e_2 | `e`     | −          | addendum contact ratios              |
/// | H_s, H_t |         | −          | sliding ratios at start and end of approach and recess |
/// | α_w      |         | rad        | operating pressure angle; drops out  |
///
/// # Valid for
/// Spur gears. The load is taken as uniform along the path, which is too high by about a fifth
/// against half the load on each pair in double contact.
///
/// # Departs from the source
/// Radii and operating angle are expressed by the addendum contact ratios; the helix is left out
/// as there.
///
/// # Source
/// `[buckingham1949]` and `[uts_60_1165]`, mesh losses. The number of the equation there is not known to us.
///
/// # Example
/// 17/22, e = 0.7574, 0.7903, by hand: 0.32760 · (0.57365 + 0.62465)/1.54775 = 0.25364.
/// ```
/// # use willis::losses::loss_factor::{BuckinghamMerritt, Law, PathOfContact};
/// assert_eq!(format!("{:.5}", BuckinghamMerritt::DEFAULT.eval(&PathOfContact::typical())), "0.25364");
/// assert!(BuckinghamMerritt::DEFAULT.outside(&PathOfContact::typical()).is_empty());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BuckinghamMerritt;

impl BuckinghamMerritt {
    /// As published.
    pub const DEFAULT: Self = Self;
}

impl Law for BuckinghamMerritt {
    const META: LawInfo<PathOfContact<f64>> = LawInfo {
        id: "buckingham-merritt",
        by: "Buckingham and Merritt",
        title: "Buckingham and Merritt (AGMA, UTS)",
        source: ("buckingham1949", "efficiency of gears"),
        trust: Trust::Seen,
        tags: &[],
        valid: &[
            ValidityRange { symbol: "beta_b", unit: "rad", min: 0.0, max: 0.0, get: |s| s.base_helix },
            ValidityRange { symbol: "e_1", unit: "-", min: 0.0, max: f64::INFINITY, get: |s| s.e[0] },
            ValidityRange { symbol: "e_2", unit: "-", min: 0.0, max: f64::INFINITY, get: |s| s.e[1] },
            ValidityRange { symbol: "c' C_a b/F_bt", unit: "-", min: 0.0, max: 0.0, get: |s| s.relief.largest() },
        ],
    };

    fn eval<D: Real>(&self, s: &PathOfContact<D>) -> D {
        let [z_1, z_2] = s.teeth;
        let [e_1, e_2] = s.e;
        let u = z_2 / z_1;
        let relative = if s.internal { (u - 1.0).abs() } else { u + 1.0 };
        let turn = std::f64::consts::TAU * relative;
        // both over cos α_w
        let h_s = e_2 * (turn / z_2);
        let h_t = e_1 * (turn / u / z_1);
        if (h_s + h_t).re() <= 0.0 {
            return D::zero();
        }
        (h_s * h_s + h_t * h_t) / (h_s + h_t) / 2.0
    }
}
