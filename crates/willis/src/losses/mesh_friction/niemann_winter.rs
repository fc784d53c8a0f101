use super::{Law, MeshContact, niemann};
use crate::Real;
use crate::losses::{LawInfo, ValidityRange, Trust};

/// Mean friction of an oil-lubricated steel mesh after Niemann and Winter: the roughness factor
/// refers to the reference diameter of the pinion.
///
/// # Formula
/// ```text
/// mu = 0.045 · (w / (v_ΣC · ρ_nC))^0.2 · η^(−0.05) · X_R · X_L,   X_R = 3.8 · (Ra / d1)^0.25
/// ```
///
/// # Symbols
/// | there | here                | unit there | meaning                                              |
/// |-------|---------------------|------------|------------------------------------------------------|
/// | w     | `line_load`         | N/mm       | transverse load per face width, F_bt/b               |
/// | v_ΣC  | `pitch_sum_speed`   | m/s        | sum of the surface speeds at the pitch point         |
/// | ρ_nC  | `pitch_radius`      | mm         | reduced radius of curvature, pitch point, normal     |
/// | η     | `dynamic_viscosity` | mPa s      | dynamic viscosity at the oil temperature             |
/// | Ra    | `roughness`         | µm         | mean of both flanks                                  |
/// | d1    | `pinion_diameter`   | mm         | reference diameter of the smaller wheel              |
/// | X_L   | `lubricant_factor`  | −          | 1 for mineral oil                                    |
///
/// # Valid for
/// As Schlenk: case-hardened steel gears, oil of 40 to 120 °C, and the range in [`Law::META`].
/// Towards zero speed the formula rises without bound; from 0.5 m/s down (our limit: the slowest gear tests)
/// it is flagged.
///
/// # Departs from the source
/// Nothing known. The roughness factor stands as recalled, with 3.8 and the exponent 0.25.
///
/// # Source
/// `[niemann1989]`, mean coefficient of friction. The number of the equation there is not known to us.
///
/// # Example
/// By hand: X_R = 3.8 · (0.5/72)^0.25 = 1.09697;
/// 0.045 · (200/(4 · 8))^0.2 · 30^(−0.05) · 1.09697 = 0.060079.
/// ```
/// # use willis::losses::mesh_friction::{Law, MeshContact, NiemannWinter};
/// let contact = MeshContact {
///     line_load: 200e3,
///     pitch_sum_speed: 4.0,
///     pitch_radius: 8e-3,
///     pinion_diameter: 72e-3,
///     dynamic_viscosity: 30e-3,
///     roughness: 0.5e-6,
///     ..MeshContact::typical()
/// };
/// assert_eq!(format!("{:.6}", NiemannWinter::DEFAULT.eval(&contact)), "0.060079");
/// assert!(NiemannWinter::DEFAULT.outside(&contact).is_empty());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NiemannWinter;

impl NiemannWinter {
    /// As published.
    pub const DEFAULT: Self = Self;
}

impl Law for NiemannWinter {
    const META: LawInfo<MeshContact<f64>> = LawInfo {
        id: "niemann-winter",
        by: "Niemann–Winter",
        title: "Niemann–Winter",
        source: ("niemann1989", "mean coefficient of friction"),
        trust: Trust::Confirm("X_R = 3.8 (Ra/d1)^0.25"),
        tags: &[],
        valid: &[
            ValidityRange { symbol: "F_bt/b", unit: "N/m", min: 150e3, max: f64::INFINITY, get: |s| s.line_load },
            ValidityRange { symbol: "v_t", unit: "m/s", min: 0.5, max: 50.0, get: |s| s.pitch_line_speed },
            ValidityRange { symbol: "Ra", unit: "m", min: 0.2e-6, max: 1e-6, get: |s| s.roughness },
        ],
    };

    fn eval<D: Real>(&self, s: &MeshContact<D>) -> D {
        let ra_um = s.roughness * 1e6;
        let d1_mm = s.pinion_diameter * 1e3;
        niemann::smooth(s) * (ra_um / d1_mm).powf(0.25) * 3.8
    }
}
