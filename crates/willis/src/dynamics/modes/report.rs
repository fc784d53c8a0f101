//! What is told about the natural frequencies of a train.

use serde::{Deserialize, Serialize};

use crate::contract::{Contract, Format};

/// A number that belongs to a member, a shaft or a mesh.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Part {
    /// The member, shaft or mesh.
    pub name: String,
    /// Its number.
    pub value: f64,
}

/// A motion without strain, at 0 Hz.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct RigidMode {
    /// Angle of each member whose motion is settled; the largest is 1.
    pub shape: Vec<Part>,
    /// Share of the kinetic energy by member; 1 in all.
    pub kinetic_energy: Vec<Part>,
}

/// A vibration.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Mode {
    /// Undamped natural frequency f, Hz.
    pub frequency_hz: f64,
    /// ω = 2π f, rad/s.
    pub angular_frequency_rad_s: f64,
    /// ζ = −Re λ/|λ| of its eigenvalue λ with damping; above 1 (then `c/(2ω)` of its shape) where it no
    /// longer vibrates; `None` where nothing damps it.
    pub damping_ratio: Option<f64>,
    /// Frequency with damping, Im λ/(2π), Hz; `None` where it no longer vibrates.
    pub damped_frequency_hz: Option<f64>,
    /// Angle amplitude of each member whose motion is settled, relative to the largest, which is 1.
    /// Opposite signs swing in opposite directions.
    pub shape: Vec<Part>,
    /// Share of the kinetic energy by member; 1 in all.
    pub kinetic_energy: Vec<Part>,
    /// Share of the strain energy by shaft and elastic mesh; 1 in all.
    pub strain_energy: Vec<Part>,
}

/// Vibrations in which the planets of a set swing against each other, and nothing else moves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct PlanetMode {
    /// The set.
    pub set: String,
    /// How many such vibrations there are: one less than planets.
    pub multiplicity: u32,
    /// One of them; its shape is that of one planet.
    pub mode: Mode,
}

/// Natural frequencies of a train.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ModesReport {
    /// `willis-modes-1`
    pub format: Format<Self>,
    /// The train.
    pub train: String,
    /// The state of the shift table, or `as drawn`.
    pub state: String,
    /// Members held at rest beside it.
    pub fixed: Vec<String>,
    /// Members whose angles are the coordinates.
    pub coordinates: Vec<String>,
    /// Motions without strain; how many there are is certain, because they are found exactly.
    pub rigid_body_modes: Vec<RigidMode>,
    /// Vibrations, by rising frequency.
    pub modes: Vec<Mode>,
    /// Planets against each other, of sets with elastic meshes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub planet_modes: Vec<PlanetMode>,
    /// What stands in for data that were not given.
    pub assumptions: Vec<String>,
    /// What the reader must know.
    pub notes: Vec<String>,
}

impl Contract for ModesReport {
    const FORMAT: &'static str = "willis-modes-1";
}
