//! Frictional torque of a plain bearing.

/// State of a plain bearing.
#[derive(Clone, Copy, Debug)]
pub struct Journal<D> {
    /// Speed of the shaft relative to the bush, ≥ 0, rad/s.
    pub speed: D,
    /// Diameter of the shaft, m.
    pub diameter: D,
    /// Width of the bush, m.
    pub width: D,
    /// Difference of both diameters, m.
    pub clearance: D,
    /// Load, N.
    pub load: D,
    /// Dynamic viscosity of the oil, Pa s.
    pub viscosity: D,
    /// Coefficient of friction where there is no full film.
    pub friction: D,
}

family! {
    /// Frictional torque of a plain bearing.
    PlainBearing ("plain_bearing"): Journal => "M" ["N m"];
    ocvirk::Ocvirk,
    petroff::Petroff,
    boundary::Boundary,
}

impl Journal<f64> {
    /// A shaft of 30 mm in a bush of 20 mm width with 45 um of clearance, 2 kN, 1000 r/min, oil of 30 mPa s. For examples
    /// and tests.
    pub fn typical() -> Self {
        Self {
            speed: 1000.0 * std::f64::consts::PI / 30.0,
            diameter: 30e-3,
            width: 20e-3,
            clearance: 45e-6,
            load: 2000.0,
            viscosity: 30e-3,
            friction: 0.08,
        }
    }
}
