//! Frictional torque of a rolling bearing.
//!
//! A law reads the numbers of a bearing from [`BearingData`], looked up beforehand
//! ([`Bearing::data`](crate::catalogue::bearing::Bearing::data)).

use crate::catalogue::bearing::BearingData;
use crate::catalogue::oil::Base;
use crate::real::{Inner, Real};

/// How a bearing gets its oil.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Supply<R = f64> {
    /// Oil bath, with the oil level `H` above the lowest point of the outer raceway contact, m.
    Bath {
        /// Oil level over the lowest rolling element contact, m.
        level: R,
    },
    /// Oil jet or circulating oil.
    Jet,
    /// Oil-air or oil mist.
    Mist,
    /// Grease.
    Grease,
}

/// State of a rolling bearing.
///
/// Loads and speed are numbers `D`; the sizes of the bearing are constants to their derivatives, `C`.
#[derive(Clone, Copy, Debug)]
pub struct BearingDuty<D: Real, C = Inner<D>> {
    /// The numbers of the bearing.
    pub bearing: BearingData<C>,
    /// Speed of one ring relative to the other, ≥ 0, rad/s.
    pub speed: D,
    /// Radial load, N.
    pub radial_load: D,
    /// Axial load, N.
    pub axial_load: D,
    /// Kinematic viscosity at the operating temperature, m²/s.
    pub kinematic_viscosity: D,
    /// Base of the oil.
    pub base: Base,
    /// Boundary and full-film coefficient of friction of the sliding part, where they were
    /// measured for the oil.
    pub sliding_friction: Option<[f64; 2]>,
    /// How it gets its oil.
    pub supply: Supply<C>,
}

family! {
    /// Frictional torque of a rolling bearing.
    BearingTorque ("bearing"): BearingDuty => "M" ["N m"];
    skf::Skf,
    skf_6000::Skf6000,
    palmgren::Palmgren,
    harris::Harris,
}

pub use skf::Parts;
pub(crate) use skf::Turning;

impl BearingTorque {
    /// What of the torque no load changes, for laws that have much of that; else `None`.
    pub(crate) fn turning<D: Real>(&self, duty: &BearingDuty<D>) -> Option<Turning<D>> {
        match self {
            Self::Skf(law) => law.turning(duty),
            Self::Skf6000(law) => law.turning(duty),
            _ => None,
        }
    }

    /// [`eval`](Self::eval), to the last bit, where what no load changes is known.
    pub(crate) fn eval_turning<D: Real>(&self, duty: &BearingDuty<D>, turning: Option<&Turning<D>>) -> D {
        turning.map_or_else(|| self.eval(duty), |turning| turning.parts(duty).total())
    }
}

impl BearingDuty<f64> {
    /// A cylindrical roller bearing NU 308 (40 × 90 × 23 mm) under 5 kN at 1500 r/min in an oil bath
    /// of 40 mm²/s up to the middle of its lowest roller, for examples and tests.
    pub fn typical() -> Self {
        use crate::catalogue::bearing::{Bearing, Kind};
        let nu308 = Bearing::new("NU 308", Kind::CylindricalRoller, "3", 40e-3, 90e-3, 23e-3);
        Self {
            bearing: nu308.data(),
            speed: 50.0 * std::f64::consts::PI,
            radial_load: 5000.0,
            axial_load: 0.0,
            kinematic_viscosity: 40e-6,
            base: Base::Mineral,
            sliding_friction: None,
            supply: Supply::Bath { level: 6.5e-3 },
        }
    }
}

use crate::real::power as pow;
