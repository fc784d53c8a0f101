//! Torque of an oil pump that the train drives.

/// State of a pump.
#[derive(Clone, Copy, Debug)]
pub struct PumpDuty<D> {
    /// Speed of its shaft, ≥ 0, rad/s.
    pub speed: D,
    /// Oil that it delivers in one turn, m³.
    pub displacement: D,
    /// Pressure that it delivers against, Pa.
    pub pressure: D,
    /// Hydromechanical efficiency where it is given, above 0 to 1.
    pub efficiency: Option<D>,
    /// Dynamic viscosity of the oil, Pa s.
    pub viscosity: D,
}

family! {
    /// Torque of an oil pump that the train drives.
    PumpTorque ("pump"): PumpDuty => "T" ["N m"];
    displacement::Displacement,
    wilson::Wilson,
}

impl PumpDuty<f64> {
    /// The pump of an automatic transmission: 18 cm³ a turn against 10 bar at 2000 r/min, efficiency 0.85, oil of
    /// 6.5 mPa s. For examples and tests.
    pub fn typical() -> Self {
        Self {
            speed: 2000.0 * std::f64::consts::PI / 30.0,
            displacement: 18e-6,
            pressure: 10e5,
            efficiency: Some(0.85),
            viscosity: 6.5e-3,
        }
    }
}
