use super::{Law, MeshContact};
use crate::Real;
use crate::losses::{LawInfo, ValidityRange, Trust};

/// Mean friction of an oil-lubricated steel mesh after Höhn and Michaelis, with the roughness
/// factor of ISO/TS 6336-22.
///
/// # Formula
/// ```text
/// mu = 0.045 · (w / (v_ΣC · ρ_nC))^0.2 · η^(−0.05) · X_R · X_L,   X_R = 2.2 · (Ra / ρ_nC)^0.25
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
/// | X_L   | `lubricant_factor`  | −          | 1 for mineral oil                                    |
///
/// # Valid for
/// As Schlenk: case-hardened steel gears, oil of 40 to 120 °C, and the range in [`Law::META`]. Made
/// for the contact temperature of micropitting.
/// Towards zero speed the formula rises without bound; from 0.5 m/s down (our limit: the slowest gear tests)
/// it is flagged.
///
/// # Departs from the source
/// Nothing. Where no factor was measured for the oil, `X_L` is the one of its base; the factors of
/// bases other than mineral are to be confirmed in the source.
///
/// # Source
/// `[isots6336_22]`, mean coefficient of friction. The number of the equation there is not known to us. In
/// its forerunner `[isotr15144_1]` the coefficient is formula (86), the factor of roughness formula (87).
///
/// # Example
/// By hand: X_R = 2.2 · (0.5/8)^0.25 = 1.1; 0.045 · (200/(4 · 8))^0.2 · 30^(−0.05) · 1.1 = 0.060246.
/// ```
/// # use willis::losses::mesh_friction::{Law, MeshContact, Niemann};
/// let contact = MeshContact {
///     line_load: 200e3,
///     pitch_sum_speed: 4.0,
///     pitch_radius: 8e-3,
///     dynamic_viscosity: 30e-3,
///     roughness: 0.5e-6,
///     ..MeshContact::typical()
/// };
/// assert_eq!(format!("{:.6}", Niemann::DEFAULT.eval(&contact)), "0.060246");
/// assert!(Niemann::DEFAULT.outside(&contact).is_empty());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Niemann;

impl Niemann {
    /// As published.
    pub const DEFAULT: Self = Self;
}

/// Everything but the roughness factor: `0.045 · (w/(v_ΣC ρ_nC))^0.2 · η^(−0.05) · X_L`.
pub(super) fn smooth<D: Real>(s: &MeshContact<D>) -> D {
    let w_n_mm = s.line_load * 1e-3;
    let rho_mm = s.pitch_radius * 1e3;
    let eta_mpa_s = s.dynamic_viscosity * 1e3;
    let x_l = s.lubricant_factor.unwrap_or_else(|| s.base.lubricant_factor(s.pitch_sum_speed));
    (w_n_mm / (s.pitch_sum_speed * rho_mm)).powf(0.2) * eta_mpa_s.powf(-0.05) * x_l * 0.045
}

impl Law for Niemann {
    const META: LawInfo<MeshContact<f64>> = LawInfo {
        id: "niemann",
        by: "Niemann",
        title: "Höhn–Michaelis, roughness factor of ISO/TS 6336-22",
        source: ("isots6336_22", "mean coefficient of friction; formulae (86), (87) of ISO/TR 15144-1"),
        trust: Trust::Seen,
        tags: &[],
        valid: &[
            ValidityRange { symbol: "F_bt/b", unit: "N/m", min: 150e3, max: f64::INFINITY, get: |s| s.line_load },
            ValidityRange { symbol: "v_t", unit: "m/s", min: 0.5, max: 50.0, get: |s| s.pitch_line_speed },
            ValidityRange { symbol: "Ra", unit: "m", min: 0.2e-6, max: 1e-6, get: |s| s.roughness },
        ],
    };

    fn eval<D: Real>(&self, s: &MeshContact<D>) -> D {
        let ra_um = s.roughness * 1e6;
        let rho_mm = s.pitch_radius * 1e3;
        smooth(s) * (ra_um / rho_mm).powf(0.25) * 2.2
    }
}
