use super::{Law, MeshContact};
use crate::Real;
use crate::losses::{LawInfo, Tag, Trust};
use crate::real::{max, min};

/// Friction at one point by the regime of lubrication: one coefficient for boundary lubrication,
/// one for full film, a straight line between them.
///
/// # Formula
/// ```text
/// mu = mu_BL                                           λ ≤ 1.4
/// mu = mu_BL + (mu_EHL − mu_BL) · (λ − 1.4)/(3 − 1.4)  1.4 < λ < 3
/// mu = mu_EHL                                          λ ≥ 3
/// ```
///
/// # Symbols
/// | there  | here         | unit there | meaning                                      |
/// |--------|--------------|------------|----------------------------------------------|
/// | mu_BL  | `boundary`   | −          | coefficient in boundary lubrication          |
/// | mu_EHL | `full_film`  | −          | coefficient of the film                      |
/// | λ      | `film_ratio` | −          | film thickness over composite rms roughness  |
///
/// # Valid for
/// A first look at where friction comes from; the limits 1.4 and 3 of the regimes are those of Wang
/// and others. Rolling losses are not contained.
///
/// # Departs from the source
/// The source names the regimes but not the coefficients, which are hand values, nor the way from one
/// to the other, which is a straight line here so that the coefficient has no jump.
///
/// # Source
/// `[wang2020]`, section 3.2.1: boundary below 1.4, full film above 3.
///
/// # Example
/// By hand: λ = 2.2 is half way, (0.1 + 0.02)/2 = 0.06.
/// ```
/// # use willis::losses::mesh_friction::{CoulombByRegime, Law, MeshContact};
/// let contact = MeshContact { film_ratio: 2.2, ..MeshContact::typical() };
/// assert_eq!(format!("{:.6}", CoulombByRegime::DEFAULT.eval(&contact)), "0.060000");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoulombByRegime {
    /// `mu_BL`, coefficient in boundary lubrication, −.
    pub boundary: f64,
    /// `mu_EHL`, coefficient of the film, −.
    pub full_film: f64,
}

impl CoulombByRegime {
    /// Hand values.
    pub const DEFAULT: Self = Self { boundary: 0.1, full_film: 0.02 };
}

impl Law for CoulombByRegime {
    const META: LawInfo<MeshContact<f64>> = LawInfo {
        id: "coulomb-by-regime",
        by: "Coulomb by film ratio",
        title: "Boundary, mixed or full film by film ratio",
        source: ("wang2020", "section 3.2.1, limits of the regimes of lubrication"),
        trust: Trust::Confirm("both coefficients"),
        tags: &[Tag::Local, Tag::SlidingOnly, Tag::Film],
        valid: &[],
    };

    fn eval<D: Real>(&self, s: &MeshContact<D>) -> D {
        let way = (s.film_ratio - 1.4) / 1.6;
        let way = min(max(way, D::from(0.0)), D::from(1.0));
        way * (self.full_film - self.boundary) + self.boundary
    }
}
