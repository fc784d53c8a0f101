use super::{Law, MeshContact};
use crate::Real;
use crate::losses::{LawInfo, ValidityRange, Tag, Trust};
use crate::real::max;

/// Friction at one point of a contact in gear oil 75W90 after Xu and Kahraman: a regression of
/// EHL calculations.
///
/// # Formula
/// ```text
/// mu = exp(f) · p^b2 · SR^b3 · V^b6 · η^b7 · R^b8
/// f  = b1 + b4 q + b5 exp(−q) + b9 exp(S),   q = SR · p · log10(η)
/// b1…b9 = −8.916465, 1.03303, 1.036077, −0.354068, 2.812084, −0.100601, 0.752755, −0.390958, 0.620305
/// ```
///
/// # Symbols
/// | there | here                  | unit there | meaning                                        |
/// |-------|-----------------------|------------|------------------------------------------------|
/// | p     | `hertz_pressure`      | GPa        | Hertzian pressure at the point                 |
/// | SR    | `sliding_speed`       | −          | slide-roll ratio, v_g/V                        |
/// | V     | `sum_speed`           | m/s        | MEAN surface speed, half of the sum            |
/// | η     | `dynamic_viscosity`   | mPa s      | dynamic viscosity at the oil temperature       |
/// | R     | `radius`              | m          | reduced radius of curvature at the point       |
/// | S     | `composite_roughness` | µm         | rms roughness of the surfaces                  |
///
/// # Valid for
/// Oil 75W90 and the range in [`Law::META`], whose ends stand as recalled. Rolling losses are not
/// contained.
///
/// # Departs from the source
/// SR is not taken below 1e−6, for the sake of derivatives: there the coefficient, which is zero
/// without sliding, is below 1e−6. A doctoral thesis that prints the formula gives the pressure in MPa;
/// only GPa yields numbers of friction.
///
/// # Source
/// `[xu2007]`, regression formula; its coefficients in two later documents.
/// The number of the equation there is not known to us.
///
/// # Example
/// By hand for p = 1, SR = 0.2, V = 10, η = 10, R = 0.01, S = 0.2: q = 0.2,
/// f = −8.916465 − 0.070814 + 2.302340 + 0.757642 = −5.927297;
/// exp(f) · 0.2^1.036077 · 10^(−0.100601 + 0.752755) · 0.01^(−0.390958)
/// = 0.00266567 · 0.188717 · 4.48906 · 6.05224 = 0.013668.
/// ```
/// # use willis::losses::mesh_friction::{Law, MeshContact, XuKahraman};
/// let contact = MeshContact {
///     hertz_pressure: 1e9,
///     sliding_speed: 2.0,
///     sum_speed: 20.0,
///     dynamic_viscosity: 10e-3,
///     radius: 10e-3,
///     composite_roughness: 0.2e-6,
///     ..MeshContact::typical()
/// };
/// assert_eq!(format!("{:.6}", XuKahraman::DEFAULT.eval(&contact)), "0.013668");
/// assert!(XuKahraman::DEFAULT.outside(&contact).is_empty());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct XuKahraman;

impl XuKahraman {
    /// As published.
    pub const DEFAULT: Self = Self;
}

impl Law for XuKahraman {
    const META: LawInfo<MeshContact<f64>> = LawInfo {
        id: "xu-kahraman",
        by: "Xu–Kahraman",
        title: "Xu–Kahraman, EHL regression for 75W90",
        source: ("xu2007", "regression formula"),
        trust: Trust::Seen,
        tags: &[Tag::Local, Tag::SlidingOnly],
        valid: &[
            ValidityRange { symbol: "p_H", unit: "Pa", min: 0.5e9, max: 2.5e9, get: |s| s.hertz_pressure },
            ValidityRange { symbol: "SR", unit: "-", min: 0.0, max: 1.0, get: |s| s.sliding_speed / (s.sum_speed * 0.5) },
            ValidityRange { symbol: "V", unit: "m/s", min: 1.0, max: 20.0, get: |s| s.sum_speed * 0.5 },
            ValidityRange { symbol: "R", unit: "m", min: 5e-3, max: 80e-3, get: |s| s.radius },
            ValidityRange { symbol: "S", unit: "m", min: 0.1e-6, max: 0.4e-6, get: |s| s.composite_roughness },
            ValidityRange { symbol: "η", unit: "Pa s", min: 5e-3, max: 20e-3, get: |s| s.dynamic_viscosity },
        ],
    };

    fn eval<D: Real>(&self, s: &MeshContact<D>) -> D {
        let p_gpa = s.hertz_pressure * 1e-9;
        let v = s.sum_speed * 0.5;
        let sr = max(s.sliding_speed / v, D::from(1e-6));
        let eta_mpa_s = s.dynamic_viscosity * 1e3;
        let s_um = s.composite_roughness * 1e6;

        let q = sr * p_gpa * eta_mpa_s.log10();
        let f = q * -0.354068 + (-q).exp() * 2.812084 + s_um.exp() * 0.620305 - 8.916465;
        f.exp()
            * p_gpa.powf(1.03303)
            * sr.powf(1.036077)
            * v.powf(-0.100601)
            * eta_mpa_s.powf(0.752755)
            * s.radius.powf(-0.390958)
    }
}
