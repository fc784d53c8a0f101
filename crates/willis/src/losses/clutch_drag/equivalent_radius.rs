use super::{Law, OpenPack};
use crate::losses::{LawInfo, ValidityRange, Tag, Trust};
use crate::real::Real;

/// Drag of an open pack whose film reaches out to the radius that the supply can fill.
///
/// # Formula
/// ```text
/// (r*² − r_i²)/ln(r*/r_i) = 12 η Q/(π ρ K h³),  r* ≤ r_o;  T = N π η Δω (r*⁴ − r_i⁴)/(2 h)
/// K = (3 ω₁² + 4 ω₁ ω₂ + 3 ω₂²)/10;  no film where the right side is below 2 r_i²
/// ```
///
/// # Symbols
/// | there | here           | unit there | meaning                                |
/// |-------|----------------|------------|----------------------------------------|
/// | ω₁, ω₂, Δω | `speeds`  | rad/s      | absolute speeds of both kinds of plates, and their difference |
/// | N     | `surfaces`     | −          | friction surfaces                      |
/// | r_i, r_o | `inner_radius`, `outer_radius` | m | radii of the friction surfaces    |
/// | h     | `gap`          | m          | gap between two plates                 |
/// | Q     | `flow`         | m³/s       | oil through one gap                    |
/// | ρ, η  | `density`, `viscosity` | kg/m³, Pa s | oil                           |
///
/// # Valid for
/// As `rivulets`. It falls to nothing just beyond the peak: without surface tension the film has no other place to end.
///
/// # Departs from the source
/// Surface tension and turbulence are left out; the inertia factor is 0.3 for one plate at rest, from the film's own
/// profile, instead of 1/4 of the bulk flow. Both plates may turn.
///
/// # Source
/// `[yuan2007]`, equivalent radius of the film. The number of the equation there is not known to us.
///
/// # Example
/// The pack of [`OpenPack::typical`] at 470 r/min, solved by a change of sign: 0.2263 N m.
/// ```
/// # use willis::losses::clutch_drag::{EquivalentRadius, Law, OpenPack};
/// let at = OpenPack { speeds: [470.0 * std::f64::consts::PI / 30.0, 0.0], ..OpenPack::typical() };
/// assert_eq!(format!("{:.4}", EquivalentRadius::DEFAULT.eval(&at)), "0.2263");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EquivalentRadius;

impl EquivalentRadius {
    /// As derived.
    pub const DEFAULT: Self = Self;
}

impl Law for EquivalentRadius {
    const META: LawInfo<OpenPack<f64>> = LawInfo {
        id: "equivalent-radius",
        by: "Yuan",
        title: "film out to an equivalent radius",
        source: ("yuan2007", "equivalent radius, without surface tension"),
        trust: Trust::Confirm("the inertia factor of the source"),
        tags: &[Tag::Estimate],
        valid: &[
            ValidityRange { symbol: "Re", unit: "-", min: 0.0, max: 2000.0, get: super::rivulets::reynolds },
            ValidityRange { symbol: "v", unit: "m/s", min: 0.0, max: 40.0, get: super::rivulets::rim },
        ],
    };

    fn eval<D: Real>(&self, s: &OpenPack<D>) -> D {
        let per_area = s.passes() * s.throw();
        if per_area.re() <= 0.0 {
            return s.film(s.outer_radius);
        }
        // In x = (r/r_i)²: 2 (x − 1)/ln x = limit.
        let limit = s.flow / per_area / (s.inner_radius * s.inner_radius);
        let most = (s.outer_radius / s.inner_radius).powi(2);
        let value = |x: f64| 2.0 * (x - 1.0) / x.ln();
        if limit.re() <= 2.0 {
            return D::from(0.0);
        }
        if value(most.re()) <= limit.re() {
            return s.film(s.outer_radius);
        }
        let (mut low, mut high) = (1.0 + 1e-12, most.re());
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if value(middle) < limit.re() { low = middle } else { high = middle }
        }
        // One Newton step carries the derivatives.
        let x = 0.5 * (low + high);
        let slope = 2.0 * (x.ln() - (x - 1.0) / x) / x.ln().powi(2);
        let root = (limit - value(x)) / slope + x;
        s.film(s.inner_radius * root.sqrt())
    }
}
