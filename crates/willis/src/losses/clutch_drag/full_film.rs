use super::{Law, OpenPack};
use crate::losses::{LawInfo, ValidityRange, Trust};
use crate::real::Real;

/// Drag of an open pack whose gaps are full of oil: plane shear.
///
/// # Formula
/// ```text
/// T = N π η Δω (r_o⁴ − r_i⁴)/(2 h)
/// ```
///
/// # Symbols
/// | there | here           | unit there | meaning                                |
/// |-------|----------------|------------|----------------------------------------|
/// | Δω    | `speeds`       | rad/s      | difference of both                     |
/// | N     | `surfaces`     | −          | friction surfaces                      |
/// | r_i, r_o | `inner_radius`, `outer_radius` | m | radii of the friction surfaces    |
/// | h     | `gap`          | m          | gap between two plates                 |
/// | η     | `viscosity`    | Pa s       | dynamic viscosity                      |
///
/// Grooves of the area share f and the depth t count with h/(h + t) there.
///
/// # Valid for
/// Speeds at which the supply fills the gaps; beyond, far too much.
///
/// # Departs from the source
/// Nothing.
///
/// # Source
/// Derived: plane Couette flow in a ring, as in `[iqbal2013]`, section 2. The number of the equation there is not known
/// to us.
///
/// # Example
/// By hand, the pack of [`OpenPack::typical`]: 10 π · 0.0065 · 104.72 · (0.075⁴ − 0.062⁴)/(2 · 0.0002) = 0.9016 N m.
/// ```
/// # use willis::losses::clutch_drag::{FullFilm, Law, OpenPack};
/// assert_eq!(format!("{:.4}", FullFilm::DEFAULT.eval(&OpenPack::typical())), "0.9016");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FullFilm;

impl FullFilm {
    /// As derived.
    pub const DEFAULT: Self = Self;
}

impl Law for FullFilm {
    const META: LawInfo<OpenPack<f64>> = LawInfo {
        id: "full-film",
        by: "",
        title: "gaps full of oil",
        source: ("iqbal2013", "plane shear, section 2"),
        trust: Trust::Derived,
        tags: &[],
        valid: &[ValidityRange {
            symbol: "Q_need/Q",
            unit: "-",
            min: 0.0,
            max: 1.0,
            get: super::rivulets::need,
        }],
    };

    fn eval<D: Real>(&self, s: &OpenPack<D>) -> D {
        s.film(s.outer_radius)
    }
}
