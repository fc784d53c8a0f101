//! Frictional torque of a rolling bearing.

use crate::catalogue::bearing::Bearing;

/// How a bearing gets its oil.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Supply {
    /// Oil bath, with the oil level `H` above the lowest point of the outer raceway contact, m.
    Bath {
        /// Oil level over the lowest rolling element contact, m.
        level: f64,
    },
    /// Oil jet or circulating oil.
    Jet,
    /// Oil-air or oil mist.
    Mist,
    /// Grease.
    Grease,
}

/// State of a rolling bearing.
#[derive(Clone, Copy, Debug)]
pub struct BearingDuty<'b, D> {
    /// The bearing.
    pub bearing: &'b Bearing,
    /// Speed of one ring relative to the other, ≥ 0, rad/s.
    pub speed: D,
    /// Radial load, N.
    pub radial_load: D,
    /// Axial load, N.
    pub axial_load: D,
    /// Kinematic viscosity at the operating temperature, m²/s.
    pub kinematic_viscosity: D,
    /// Base of the oil.
    pub base: crate::catalogue::oil::Base,
    /// Boundary and full-film coefficient of friction of the sliding part, where they were
    /// measured for the oil.
    pub sliding_friction: Option<[f64; 2]>,
    /// How it gets its oil.
    pub supply: Supply,
}
