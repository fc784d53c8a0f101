//! Power lost by a smooth body of revolution (a carrier, a drum) in oil, air or mist.

/// State of a body of revolution.
#[derive(Clone, Copy, Debug)]
pub struct Drum<D> {
    /// Angular speed relative to its surroundings, ≥ 0, rad/s.
    pub speed: D,
    /// Outer radius, m.
    pub radius: D,
    /// Axial length of the rim, m.
    pub length: D,
    /// Radial gap between rim and wall, m.
    pub radial_gap: D,
    /// Axial gap between each face and the wall, m.
    pub axial_gap: D,
    /// Density of the fluid, kg/m³.
    pub density: D,
    /// Dynamic viscosity of the fluid, Pa s.
    pub viscosity: D,
}

family! {
    /// Power lost by a smooth body of revolution.
    RotorDrag ("rotor_drag"): Drum => "P" ["W"];
    bilgen_boulos_daily_nece::BilgenBoulosDailyNece,
}

impl Drum<f64> {
    /// A carrier of 300 mm diameter and 100 mm length at 1000 r/min in air at 20 °C, 15 mm from the
    /// wall all around, for examples and tests.
    pub fn typical() -> Self {
        Self {
            speed: 1000.0 * std::f64::consts::PI / 30.0,
            radius: 0.15,
            length: 0.1,
            radial_gap: 0.015,
            axial_gap: 0.015,
            density: 1.2,
            viscosity: 18e-6,
        }
    }
}
