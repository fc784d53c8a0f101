use super::{Law, MeshContact};
use crate::Real;
use crate::losses::{LawInfo, ValidityRange, Trust};

/// Mean friction of an oil-lubricated steel mesh after Schlenk (ISO/TR 14179-2).
///
/// # Formula
/// ```text
/// mu = 0.048 · (w / (v_ΣC · ρ_redC))^0.2 · η^(−0.05) · Ra^0.25 · X_L
/// ```
///
/// # Symbols
/// | there  | here                      | unit there | meaning                                      |
/// |--------|---------------------------|------------|----------------------------------------------|
/// | w      | `line_load`               | N/mm       | transverse load per face width, F_bt/b       |
/// | v_ΣC   | `pitch_sum_speed`         | m/s        | sum of the surface speeds at the pitch point |
/// | ρ_redC | `pitch_radius_transverse` | mm         | reduced radius of curvature, pitch point     |
/// | η      | `dynamic_viscosity`       | mPa s      | dynamic viscosity at the oil temperature     |
/// | Ra     | `roughness`               | µm         | mean of both flanks                          |
/// | X_L    | `lubricant_factor`        | −          | 1 for mineral oil                            |
///
/// # Valid for
/// Case-hardened steel gears (FZG twin disc and C gears), oil of 40 to 120 °C, and the range in
/// [`Law::META`].
/// Towards zero speed the formula rises without bound; from 0.5 m/s down (our limit: the slowest gear tests)
/// it is flagged.
///
/// # Departs from the source
/// Nothing. Where no factor was measured for the oil, `X_L` is the one of its base; the factors of
/// bases other than mineral are to be confirmed in the source.
///
/// # Source
/// `[isotr14179_2]`, mean coefficient of friction of the mesh.
/// The number of the equation there is not known to us.
///
/// # Example
/// By hand: (200/(4 · 8))^0.2 = 1.44270, 30^(−0.05) = 0.84361, 0.5^0.25 = 0.84090;
/// 0.048 · 1.44270 · 0.84361 · 0.84090 = 0.049125.
/// ```
/// # use willis::losses::mesh_friction::{Law, MeshContact, Schlenk};
/// let contact = MeshContact {
///     line_load: 200e3,
///     pitch_sum_speed: 4.0,
///     pitch_radius_transverse: 8e-3,
///     dynamic_viscosity: 30e-3,
///     roughness: 0.5e-6,
///     ..MeshContact::typical()
/// };
/// assert_eq!(format!("{:.6}", Schlenk::DEFAULT.eval(&contact)), "0.049125");
/// assert!(Schlenk::DEFAULT.outside(&contact).is_empty());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Schlenk;

impl Schlenk {
    /// As published.
    pub const DEFAULT: Self = Self;
}

impl Law for Schlenk {
    const META: LawInfo<MeshContact<f64>> = LawInfo {
        id: "schlenk",
        by: "Schlenk",
        title: "Schlenk, oil-lubricated steel (ISO/TR 14179-2)",
        source: ("isotr14179_2", "mean coefficient of friction"),
        trust: Trust::Seen,
        tags: &[],
        valid: &[
            ValidityRange { symbol: "F_bt/b", unit: "N/m", min: 150e3, max: f64::INFINITY, get: |s| s.line_load },
            ValidityRange { symbol: "v_t", unit: "m/s", min: 0.5, max: 50.0, get: |s| s.pitch_line_speed },
            ValidityRange { symbol: "Ra", unit: "m", min: 0.2e-6, max: 1e-6, get: |s| s.roughness },
        ],
    };

    fn eval<D: Real>(&self, s: &MeshContact<D>) -> D {
        let w_n_mm = s.line_load * 1e-3;
        let rho_mm = s.pitch_radius_transverse * 1e3;
        let eta_mpa_s = s.dynamic_viscosity * 1e3;
        let ra_um = s.roughness * 1e6;
        let x_l = s.lubricant_factor.unwrap_or_else(|| s.base.lubricant_factor(s.pitch_sum_speed));
        (w_n_mm / (s.pitch_sum_speed * rho_mm)).powf(0.2) * eta_mpa_s.powf(-0.05) * ra_um.powf(0.25) * x_l * 0.048
    }
}
