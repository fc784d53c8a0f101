//! Coefficient of friction between teeth.
//!
//! Mean laws give one value for the mesh from the state at the pitch point; local laws
//! (tagged [`Tag::Local`](super::Tag)) give the value at one point of the path of contact and are averaged along it,
//! weighted with load and sliding.

use super::Tag;
use crate::catalogue::oil::Base;

/// State of a tooth contact. The fields of the pitch point describe the mesh as a whole (all tooth
/// pairs); those of the point belong to one pair at one place of the path of contact (for a mean
/// law they are those at the pitch point).
#[derive(Clone, Copy, Debug)]
pub struct MeshContact<D> {
    /// Transverse load per face width at the base circle, `F_bt/b`, N/m.
    pub line_load: D,
    /// Normal force of the mesh, `F_bn = F_bt/cos β_b`, N.
    pub normal_force: D,
    /// Sum of the surface speeds at the pitch point, `v_ΣC = 2 v_t sin α_wt`, m/s.
    pub pitch_sum_speed: D,
    /// Pitch line speed relative to the carrier, `v_t`, m/s.
    pub pitch_line_speed: D,
    /// Reduced radius of curvature in the transverse section at the pitch point, `ρ_redC`, m.
    pub pitch_radius_transverse: D,
    /// The same in the normal section, `ρ_nC = ρ_redC/cos β_b`, m.
    pub pitch_radius: D,
    /// Normal load per length of contact line at this point, `w`, N/m.
    pub local_line_load: D,
    /// Sliding speed at this point, `|v_g|`, m/s.
    pub sliding_speed: D,
    /// Sum of the surface speeds at this point, `u_1 + u_2`, m/s.
    pub sum_speed: D,
    /// Reduced radius of curvature at this point, normal section, m.
    pub radius: D,
    /// Hertzian pressure at this point, Pa.
    pub hertz_pressure: D,
    /// Smallest film thickness at this point, thermal reduction included, m. An operating point gives it, and the ratio, to
    /// laws tagged [`Tag::Film`] alone: zero to others, which read neither.
    pub film: D,
    /// Film thickness over the composite rms roughness, `λ`.
    pub film_ratio: D,
    /// Dynamic viscosity of the oil at its temperature, Pa s.
    pub dynamic_viscosity: D,
    /// Kinematic viscosity of the oil at its temperature, m²/s.
    pub kinematic_viscosity: D,
    /// Pressure-viscosity coefficient, 1/Pa.
    pub pressure_viscosity: D,
    /// Mean of the arithmetic mean roughnesses of both flanks, `Ra`, m.
    pub roughness: D,
    /// Composite rms roughness `√(Rq1² + Rq2²)`, m.
    pub composite_roughness: D,
    /// Sum of the peak-to-valley heights of both flanks, `Rz1 + Rz2`, m.
    pub peak_roughness: D,
    /// Base of the oil.
    pub base: Base,
    /// Factor of the lubricant `X_L`, where it was measured for this oil; otherwise by [`Self::base`].
    pub lubricant_factor: Option<D>,
    /// Contact load factor `K` of ISO/TR 14179-1: `F_t/(b d_w1) · (z_2 ± z_1)/z_2`, Pa.
    pub k_factor: D,
    /// Tooth counts; first the smaller wheel.
    pub teeth: [f64; 2],
    /// Whether the second wheel is a ring gear.
    pub internal: bool,
    /// Normal pressure angle of the basic rack, rad.
    pub normal_pressure_angle: D,
    /// Operating helix angle, rad.
    pub helix: D,
    /// Reference diameter of the smaller wheel, m.
    pub pinion_diameter: D,
    /// Face width, m.
    pub width: D,
    /// Shortest total length of contact lines over the face width.
    pub contact_length_ratio: D,
    /// Loss factor of the mesh in force, `H_V`.
    pub loss_factor: D,
    /// Identical meshes in parallel (planets).
    pub parallel: f64,
}

family! {
    /// Coefficient of friction of a mesh.
    MeshFriction ("mesh_friction"): MeshContact => "mu" ["-"];
    schlenk::Schlenk,
    niemann::Niemann,
    niemann_winter::NiemannWinter,
    iso_14179_1::Iso14179Part1,
    iso_14179_1_friction::Iso14179Part1Friction,
    fernandes::Fernandes,
    matsumoto::Matsumoto,
    xu_kahraman::XuKahraman,
    benedict_kelley::BenedictKelley,
    anderson_loewenthal::AndersonLoewenthal,
    coulomb_by_regime::CoulombByRegime,
    constant::Constant,
    agma_6011::Agma6011,
    agma_6011_per_planet::Agma6011PerPlanet,
}

impl MeshFriction {
    /// Whether it reads the oil, its film or its base: such a law has no value without an oil.
    pub fn needs_oil(&self) -> bool {
        !self.meta().tags.contains(&Tag::WithoutOil)
    }
}

impl MeshContact<f64> {
    /// A case-hardened pair of module 4.5 mm at 8 m/s under FZG load stage 7 in mineral oil
    /// ISO VG 100 at 60 °C: a state inside the range of most laws, for examples and tests.
    pub fn typical() -> Self {
        Self {
            line_load: 390e3,
            normal_force: 5460.0,
            pitch_sum_speed: 6.1,
            pitch_line_speed: 8.0,
            pitch_radius_transverse: 8.38e-3,
            pitch_radius: 8.38e-3,
            local_line_load: 390e3,
            sliding_speed: 1.2,
            sum_speed: 6.1,
            radius: 8.38e-3,
            hertz_pressure: 1.25e9,
            film: 0.35e-6,
            film_ratio: 0.9,
            dynamic_viscosity: 33e-3,
            kinematic_viscosity: 39e-6,
            pressure_viscosity: 16.5e-9,
            roughness: 0.4e-6,
            composite_roughness: 0.7e-6,
            peak_roughness: 5e-6,
            base: Base::Mineral,
            lubricant_factor: None,
            k_factor: 8e6,
            teeth: [16.0, 24.0],
            internal: false,
            normal_pressure_angle: 20f64.to_radians(),
            helix: 0.0,
            pinion_diameter: 72e-3,
            width: 14e-3,
            contact_length_ratio: 1.0,
            loss_factor: 0.19,
            parallel: 1.0,
        }
    }
}
