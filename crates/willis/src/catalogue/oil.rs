//! Oils: viscosity and density over temperature, pressure-viscosity coefficient.

use serde::Serialize;

use crate::Real;

/// Base of a lubricating oil.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Base {
    /// Mineral oil.
    Mineral,
    /// Poly-α-olefin.
    Pao,
    /// Ester.
    Ester,
    /// Polyglycol.
    Pag,
    /// Phosphate ester.
    PhosphateEster,
    /// Traction fluid.
    Traction,
}

impl Base {
    /// Factor `X_L` of the lubricant in the friction of ISO/TR 14179-2 at the sum of the surface
    /// speeds `v_ΣC` (m/s). Mineral oil 1; the others are to be confirmed in the standard.
    pub fn lubricant_factor<D: Real>(self, pitch_sum_speed: D) -> D {
        match self {
            Self::Mineral => D::from(1.0),
            Self::Pao | Self::Ester => D::from(0.8),
            Self::Pag => (pitch_sum_speed / 6.0).powf(-0.2) * 0.75,
            Self::PhosphateEster => D::from(1.3),
            Self::Traction => D::from(1.5),
        }
    }
}
