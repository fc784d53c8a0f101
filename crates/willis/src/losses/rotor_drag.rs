//! Power lost by a smooth body of revolution (a carrier, a drum) in oil, air or mist.

/// State of a body of revolution.
#[derive(Clone, Copy, Debug)]
pub struct Drum<D> {
    /// Angular speed relative to its surroundings, ≥ 0, rad/s.
    pub speed: D,
    /// Outer radius, m.
    pub radius: f64,
    /// Axial length of the rim, m.
    pub length: f64,
    /// Radial gap between rim and wall, m.
    pub radial_gap: f64,
    /// Axial gap between each face and the wall, m.
    pub axial_gap: f64,
    /// Density of the fluid, kg/m³.
    pub density: f64,
    /// Dynamic viscosity of the fluid, Pa s.
    pub viscosity: f64,
}
