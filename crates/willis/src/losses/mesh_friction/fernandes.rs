use super::{Law, MeshContact};
use crate::Real;
use crate::catalogue::oil::Base;
use crate::losses::{LawInfo, Trust};

/// Mean friction of an oil-lubricated steel mesh after Fernandes and others, from the Stribeck and
/// roughness parameters of the contact.
///
/// # Formula
/// ```text
/// mu = 0.014 · S_p^(−0.25) · S_g^0.25 · X_L
/// S_p = v_ΣC · η · √(α/F_bn),   S_g = Ra / √(b · l · ρ_C)
/// ```
///
/// # Symbols
/// | there | here                      | unit there | meaning                                          |
/// |-------|---------------------------|------------|--------------------------------------------------|
/// | v_ΣC  | `pitch_sum_speed`         | m/s        | sum of the surface speeds at the pitch point     |
/// | η     | `dynamic_viscosity`       | Pa s       | dynamic viscosity at the oil temperature         |
/// | α     | `pressure_viscosity`      | 1/Pa       | pressure-viscosity coefficient                   |
/// | F_bn  | `normal_force`            | N          | normal force of the mesh                         |
/// | Ra    | `roughness`               | m          | mean of both flanks                              |
/// | b     | `width`                   | m          | face width                                       |
/// | l     | `contact_length_ratio`    | −          | shortest length of contact lines over face width |
/// | ρ_C   | `pitch_radius_transverse` | m          | reduced radius of curvature, pitch point         |
/// | X_L   | `lubricant_factor`        | −          | fitted: mineral 0.846, PAO and ester 0.65, PAG 0.585 |
///
/// # Valid for
/// The wind turbine oils ISO VG 320 and the gears it was fitted to; its authors state no numeric
/// range. Rolling is contained.
///
/// # Departs from the source
/// `X_L` of phosphate esters and traction fluids, which were not fitted, is the one of ISO/TR 14179-2.
///
/// # Source
/// `[fernandes2015]`, and the program of the same group.
/// The number of the equation there is not known to us.
///
/// # Example
/// By hand: S_p = 5 · 0.04 · √(16e−9/5000) = 3.57771e−7, S_g = 0.4e−6/√(0.02 · 1 · 0.008) = 3.16228e−5;
/// 0.014 · (S_g/S_p)^0.25 · 0.846 = 0.014 · 88.388^0.25 · 0.846 = 0.036316.
/// ```
/// # use willis::losses::mesh_friction::{Fernandes, Law, MeshContact};
/// let contact = MeshContact {
///     pitch_sum_speed: 5.0,
///     dynamic_viscosity: 40e-3,
///     pressure_viscosity: 16e-9,
///     normal_force: 5000.0,
///     roughness: 0.4e-6,
///     width: 20e-3,
///     contact_length_ratio: 1.0,
///     pitch_radius_transverse: 8e-3,
///     ..MeshContact::typical()
/// };
/// assert_eq!(format!("{:.6}", Fernandes::DEFAULT.eval(&contact)), "0.036316");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fernandes;

impl Fernandes {
    /// As published.
    pub const DEFAULT: Self = Self;
}

impl Law for Fernandes {
    const META: LawInfo<MeshContact<f64>> = LawInfo {
        id: "fernandes",
        by: "Fernandes",
        title: "Fernandes, Stribeck and roughness parameters",
        source: ("fernandes2015", "friction losses in gears"),
        trust: Trust::Seen,
        tags: &[],
        valid: &[],
    };

    fn eval<D: Real>(&self, s: &MeshContact<D>) -> D {
        let x_l = s.lubricant_factor.unwrap_or_else(|| match s.base {
            Base::Mineral => D::from(0.846),
            Base::Pao | Base::Ester => D::from(0.65),
            Base::Pag => D::from(0.585),
            other => other.lubricant_factor(s.pitch_sum_speed),
        });
        let s_p = s.pitch_sum_speed * s.dynamic_viscosity * (s.pressure_viscosity / s.normal_force).sqrt();
        let s_g = s.roughness / (s.width * s.contact_length_ratio * s.pitch_radius_transverse).sqrt();
        (s_g / s_p).powf(0.25) * x_l * 0.014
    }
}
