use super::{Law, OpenPack};
use crate::losses::{LawInfo, ValidityRange, Tag, Trust};
use crate::real::Real;

/// Drag of an open pack whose film breaks into rivulets where the plates throw out more oil than is supplied.
///
/// # Formula
/// ```text
/// T = T_full min(1, Q/Q_need),  T_full = N π η Δω (r_o⁴ − r_i⁴)/(2 h)
/// Q_need = π ρ K h³ (r_o² − r_i²)/(12 η ln(r_o/r_i)),  K = (3 ω₁² + 4 ω₁ ω₂ + 3 ω₂²)/10
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
/// Grooves of the area share f and the depth t take `1 − f + f h/(h + t)` of the shear, and let
/// `1 − f + f (1 + t/h)³` times the oil through.
///
/// # Valid for
/// Laminar films, `ρ |ω|_max r_o h/η` up to 2000, and rims slower than 40 m/s, where plates begin to flutter. An estimate:
/// the torque beyond its peak goes with the fourth power of the gap, which nobody knows to 20 %.
///
/// # Departs from the source
/// The film breaks along the circumference instead of at a radius: beyond the peak the covered share is Q/Q_need. Both
/// plates may turn.
///
/// # Source
/// Derived from the radial flow between two plates with the inertia of the circumferential motion; the idea that the
/// film ends where the plates throw out more than is supplied is that of `[kitabayashi2003]`.
///
/// # Example
/// By hand, the pack of [`OpenPack::typical`]: K = 0.3 · 104.72² = 3289.9, Q_need = 8.133e-6 m³/s,
/// T = 0.9016 · 1.6667e-6/8.133e-6 = 0.1848 N m.
/// ```
/// # use willis::losses::clutch_drag::{Law, OpenPack, Rivulets};
/// assert_eq!(format!("{:.4}", Rivulets::DEFAULT.eval(&OpenPack::typical())), "0.1848");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rivulets;

impl Rivulets {
    /// As derived.
    pub const DEFAULT: Self = Self;
}

/// Oil that would just fill a gap over the oil that is supplied.
pub(super) fn need(s: &OpenPack<f64>) -> f64 {
    needed(s) / s.flow
}

/// Oil that just fills a gap, m³/s.
fn needed<D: Real>(s: &OpenPack<D>) -> D {
    let [ri, ro] = [s.inner_radius, s.outer_radius];
    s.passes() * s.throw() * (ro * ro - ri * ri) / (ro / ri).ln()
}

/// Reynolds number of the gap at the outer radius of the faster plate.
pub(super) fn reynolds(s: &OpenPack<f64>) -> f64 {
    s.density * s.speeds[0].abs().max(s.speeds[1].abs()) * s.outer_radius * s.gap / s.viscosity
}

/// Speed of the faster rim, m/s.
pub(super) fn rim(s: &OpenPack<f64>) -> f64 {
    s.speeds[0].abs().max(s.speeds[1].abs()) * s.outer_radius
}

impl Law for Rivulets {
    const META: LawInfo<OpenPack<f64>> = LawInfo {
        id: "rivulets",
        by: "",
        title: "film that breaks up outwards",
        source: ("kitabayashi2003", "the idea; derived for two turning plates"),
        trust: Trust::Derived,
        tags: &[Tag::Estimate],
        valid: &[
            ValidityRange { symbol: "Re", unit: "-", min: 0.0, max: 2000.0, get: reynolds },
            ValidityRange { symbol: "v", unit: "m/s", min: 0.0, max: 40.0, get: rim },
        ],
    };

    fn eval<D: Real>(&self, s: &OpenPack<D>) -> D {
        let (full, need) = (s.film(s.outer_radius), needed(s));
        if need.re() > s.flow.re() { full * s.flow / need } else { full }
    }
}
