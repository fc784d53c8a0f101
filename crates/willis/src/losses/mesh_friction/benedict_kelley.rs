use super::{Law, MeshContact};
use crate::Real;
use crate::losses::{LawInfo, ValidityRange, Tag, Trust};
use crate::real::{max, min};

/// Friction at one point of an oil-lubricated rolling and sliding contact after Benedict and Kelley.
///
/// # Formula
/// ```text
/// mu = 0.0127 · 50/(50 − 39.37 S) · log10(29.66 w / (η · v_g · v_Σ²))
/// ```
///
/// # Symbols
/// | there | here                  | unit there | meaning                                      |
/// |-------|-----------------------|------------|----------------------------------------------|
/// | S     | `composite_roughness` | µm         | composite rms roughness (pole at 1.27 µm, 50 µin) |
/// | w     | `local_line_load`     | N/mm       | load per length of contact line at the point |
/// | η     | `dynamic_viscosity`   | Pa s       | dynamic viscosity of the oil                 |
/// | v_g   | `sliding_speed`       | m/s        | sliding speed at the point                   |
/// | v_Σ   | `sum_speed`           | m/s        | SUM of the surface speeds at the point       |
///
/// # Valid for
/// Twin discs in mineral oil, S up to 0.75 µm, and a logarithm above 1: at high speed and light
/// load it becomes negative and the formula says nothing (herringbone gears at 60 m/s: −0.006).
/// Rolling losses are not contained.
///
/// # Departs from the source
/// Written in SI: 29.66 follows from 3.17e8 with lb/in, cP and in/s. Three cuts, the first two flagged
/// by the range in [`Law::META`]: the logarithm is not taken below 1, so that the coefficient never
/// falls below 0.0127; S is not taken above 0.75 µm; and v_g not below a thousandth of v_Σ, because
/// the logarithm grows without bound at the pitch point, where the loss is zero. Others print
/// 1.13/(1.13 − S), which is the same pole for an arithmetic mean roughness.
///
/// # Source
/// `[benedict1961]`, closing formula. The number of the equation there is not known to us.
///
/// # Example
/// By hand: 29.66 · 200/(0.02 · 2 · 10²) = 1483, log10 3.17114; 50/(50 − 39.37 · 0.4) = 1.45977;
/// 0.0127 · 1.45977 · 3.17114 = 0.058790.
/// ```
/// # use willis::losses::mesh_friction::{BenedictKelley, Law, MeshContact};
/// let contact = MeshContact {
///     local_line_load: 200e3,
///     dynamic_viscosity: 20e-3,
///     sliding_speed: 2.0,
///     sum_speed: 10.0,
///     composite_roughness: 0.4e-6,
///     ..MeshContact::typical()
/// };
/// assert_eq!(format!("{:.6}", BenedictKelley::DEFAULT.eval(&contact)), "0.058790");
/// assert!(BenedictKelley::DEFAULT.outside(&contact).is_empty());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BenedictKelley;

impl BenedictKelley {
    /// As published.
    pub const DEFAULT: Self = Self;
}

/// Argument of the logarithm.
pub(super) fn argument<D: Real>(s: &MeshContact<D>) -> D {
    let w_n_mm = s.local_line_load * 1e-3;
    let v_g = max(s.sliding_speed, s.sum_speed * 1e-3);
    w_n_mm * 29.66 / (s.dynamic_viscosity * v_g * s.sum_speed * s.sum_speed)
}

/// The logarithm, not below 1.
pub(super) fn logarithm<D: Real>(s: &MeshContact<D>) -> D {
    max(argument(s), D::from(10.0)).log10()
}

impl Law for BenedictKelley {
    const META: LawInfo<MeshContact<f64>> = LawInfo {
        id: "benedict-kelley",
        by: "Benedict–Kelley",
        title: "Benedict–Kelley, twin discs in mineral oil",
        source: ("benedict1961", "closing formula"),
        trust: Trust::Confirm("0.0127, 3.17e8 and 50 µin in the imperial form, and the end of S"),
        tags: &[Tag::Local, Tag::SlidingOnly],
        valid: &[
            ValidityRange { symbol: "29.66 w/(η v_g v_Σ²)", unit: "-", min: 10.0, max: f64::INFINITY, get: argument },
            ValidityRange { symbol: "S", unit: "m", min: 0.0, max: 0.75e-6, get: |s| s.composite_roughness },
        ],
    };

    fn eval<D: Real>(&self, s: &MeshContact<D>) -> D {
        let s_um = min(s.composite_roughness * 1e6, D::from(0.75));
        let rough = (s_um * -39.37 + 50.0).recip() * 50.0;
        rough * logarithm(s) * 0.0127
    }
}
