use super::agma_6011::{ANGLE, angle_factor};
use super::{Law, MeshContact};
use crate::Real;
use crate::losses::{LawInfo, Tag, Trust};

/// The estimate of ANSI/AGMA 6011 as Wang and others (2020) applied it: the whole power charged to
/// every planet, the external factor also for the ring.
///
/// # Formula
/// ```text
/// mu = φ / H_V,   φ = n_p · 0.01 · (22 − 0.8 α_n) · (1/z1 + 1/z2)
/// ```
///
/// # Symbols
/// | there  | here                    | unit there | meaning                                        |
/// |--------|-------------------------|------------|------------------------------------------------|
/// | φ      |                         | −          | loss of all planets' meshes over their power   |
/// | n_p    | `parallel`              | −          | planets                                        |
/// | α_n    | `normal_pressure_angle` | degree     | normal pressure angle                          |
/// | z1, z2 | `teeth`                 | −          | tooth counts                                   |
/// | H_V    | `loss_factor`           | −          | loss factor in force                           |
///
/// # Valid for
/// Reproducing that paper. It is wrong as physics: a mesh carries the n_p-th part of the power, and a
/// ring slides less than a pinion. It errs upwards, n_p times for the sun and more for the ring.
///
/// # Departs from the source
/// The paper does not say that it did so; its table of mesh losses is met without a fitted number,
/// to 0.02 of a percent of the power where windage is negligible. The cut of the angle is that of
/// [`Agma6011`](super::Agma6011).
///
/// # Source
/// `[wang2020]`: the formula in section 3.2.2, the numbers in Table 4.
///
/// # Example
/// By hand: φ = 3 · 0.06 · (1/31 + 1/97) = 0.00766212; φ/0.0626 = 0.122398.
/// ```
/// # use willis::losses::mesh_friction::{Agma6011PerPlanet, Law, MeshContact};
/// let contact = MeshContact {
///     teeth: [31.0, 97.0],
///     internal: true,
///     parallel: 3.0,
///     loss_factor: 0.0626,
///     ..MeshContact::typical()
/// };
/// assert_eq!(format!("{:.6}", Agma6011PerPlanet::DEFAULT.eval(&contact)), "0.122398");
/// assert!(Agma6011PerPlanet::DEFAULT.outside(&contact).is_empty());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Agma6011PerPlanet;

impl Agma6011PerPlanet {
    /// As in the paper.
    pub const DEFAULT: Self = Self;
}

impl Law for Agma6011PerPlanet {
    const META: LawInfo<MeshContact<f64>> = LawInfo {
        id: "agma-6011-per-planet",
        by: "AGMA 6011 for every planet",
        title: "AGMA 6011 with the whole power at every planet (Wang 2020)",
        source: ("wang2020", "section 3.2.2 and Table 4"),
        trust: Trust::Derived,
        tags: &[Tag::Estimate, Tag::Compatibility, Tag::WithoutOil],
        valid: &[ANGLE],
    };

    fn eval<D: Real>(&self, s: &MeshContact<D>) -> D {
        let [z1, z2] = s.teeth;
        let fraction = angle_factor(s.normal_pressure_angle) * s.parallel * (1.0 / z1 + 1.0 / z2);
        s.loss_factor.recip() * fraction
    }
}
