//! Power lost by a gear that turns in air or in a mist of air and oil.

/// State of a gear in air.
#[derive(Clone, Copy, Debug)]
pub struct Disc<D> {
    /// Absolute angular speed, ≥ 0, rad/s.
    pub speed: D,
    /// Pitch radius, m.
    pub radius: f64,
    /// Root radius, m.
    pub root_radius: f64,
    /// Face width, m.
    pub width: f64,
    /// Normal module, m.
    pub module: f64,
    /// Tooth count.
    pub teeth: f64,
    /// Density of the fluid around it, kg/m³.
    pub density: f64,
    /// Dynamic viscosity of the fluid around it, Pa s.
    pub viscosity: f64,
    /// Axial distance to a flange or wall on both sides, as far as it is nearer than the free
    /// side of the disc, m.
    pub axial_gaps: [f64; 2],
    /// Factor of the enclosure: 1 free, 0.6 to 0.7 in a large case, 0.5 in a fitting case.
    pub enclosure: f64,
}
