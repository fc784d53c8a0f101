//! Power lost by a gear that dips into the oil sump.

/// State of a gear in the sump.
#[derive(Clone, Copy, Debug)]
pub struct Dip<D> {
    /// Absolute angular speed, ≥ 0, rad/s.
    pub speed: D,
    /// Pitch radius, m.
    pub radius: f64,
    /// Tip radius, m.
    pub tip_radius: f64,
    /// Root radius, m.
    pub root_radius: f64,
    /// Face width, m.
    pub width: f64,
    /// Normal module, m.
    pub module: f64,
    /// Tooth count.
    pub teeth: f64,
    /// Reference helix angle, rad.
    pub helix: f64,
    /// Transverse pressure angle, rad.
    pub pressure_angle: f64,
    /// Depth of immersion of the pitch circle, m.
    pub immersion: f64,
    /// Volume of oil, m³.
    pub oil_volume: f64,
    /// Kinematic viscosity, m²/s.
    pub kinematic_viscosity: D,
    /// Density of the oil, kg/m³.
    pub density: D,
    /// Acceleration that holds the oil down (gravity, or ω_c² a in a planetary oil ring), m/s².
    pub gravity: f64,
}
