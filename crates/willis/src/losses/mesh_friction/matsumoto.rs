use super::{Law, MeshContact};
use crate::Real;
use crate::losses::{LawInfo, ValidityRange, Tag, Trust};
use crate::real::{max, min};

/// Friction at one point in mixed lubrication after Matsumoto: a share of the load is carried by
/// the asperities, the rest by the film.
///
/// # Formula
/// ```text
/// mu = ξ · mu_BL + (1 − ξ) · mu_EHL,   ξ = 0.5 · log10(D),   D = (Rz1 + Rz2) / h_min,   0 ≤ ξ ≤ 1
/// ```
///
/// # Symbols
/// | there     | here             | unit there | meaning                                            |
/// |-----------|------------------|------------|----------------------------------------------------|
/// | mu_BL     | `boundary`       | −          | coefficient in boundary lubrication                |
/// | mu_EHL    | `film`           | −          | coefficient of the film                            |
/// | Rz1 + Rz2 | `peak_roughness` | µm         | sum of the peak-to-valley heights of both flanks   |
/// | h_min     | `film`           | µm         | smallest film thickness at the point               |
///
/// # Valid for
/// Mixed lubrication, 1 ≤ D ≤ 100, and an oil whose two coefficients were measured. The defaults,
/// 0.1 and 0.02, are those of a public program for every oil; they are not of an oil.
///
/// # Departs from the source
/// Nothing: the share is limited to 0…1, as the source has it (0.01 ≤ 1/D ≤ 1). A program that leaves
/// out the limit gives less than `mu_EHL` in full film.
///
/// # Source
/// `[matsumoto2014]`, share of the asperities as tabulated in `[arana2019]`, Table 1; coefficients of `[gearpie]`.
///
/// # Example
/// By hand: D = 5/0.5 = 10, ξ = 0.5; 0.5 · 0.1 + 0.5 · 0.02 = 0.06.
/// ```
/// # use willis::losses::mesh_friction::{Law, Matsumoto, MeshContact};
/// let contact = MeshContact { peak_roughness: 5e-6, film: 0.5e-6, ..MeshContact::typical() };
/// assert_eq!(format!("{:.6}", Matsumoto::DEFAULT.eval(&contact)), "0.060000");
/// assert!(Matsumoto::DEFAULT.outside(&contact).is_empty());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Matsumoto {
    /// `mu_BL`, coefficient in boundary lubrication, −.
    pub boundary: f64,
    /// `mu_EHL`, coefficient of the film, −.
    pub film: f64,
}

impl Matsumoto {
    /// One pair of coefficients for every oil.
    pub const DEFAULT: Self = Self { boundary: 0.1, film: 0.02 };
}

impl Law for Matsumoto {
    const META: LawInfo<MeshContact<f64>> = LawInfo {
        id: "matsumoto",
        by: "Matsumoto",
        title: "Matsumoto, mixed lubrication",
        source: ("matsumoto2014", "share of the asperities, as printed in Arana 2019, Table 1 and Eq. (5)"),
        trust: Trust::Seen,
        tags: &[Tag::Local, Tag::SlidingOnly, Tag::Film],
        valid: &[ValidityRange { symbol: "D", unit: "-", min: 1.0, max: 100.0, get: |s| s.peak_roughness / s.film }],
    };

    fn eval<D: Real>(&self, s: &MeshContact<D>) -> D {
        let d = min(max(s.peak_roughness / s.film, D::from(1.0)), D::from(100.0));
        let xi = d.log10() * 0.5;
        xi * (self.boundary - self.film) + self.film
    }
}
