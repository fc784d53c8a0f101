//! Power lost by a gear that dips into the oil sump.

/// State of a gear in the sump.
#[derive(Clone, Copy, Debug)]
pub struct ImmersedGear<D> {
    /// Absolute angular speed, ≥ 0, rad/s.
    pub speed: D,
    /// Pitch radius, m.
    pub radius: D,
    /// Tip radius, m.
    pub tip_radius: D,
    /// Root radius, m.
    pub root_radius: D,
    /// Face width, m.
    pub width: D,
    /// Normal module, m.
    pub module: D,
    /// Tooth count.
    pub teeth: f64,
    /// Reference helix angle, rad.
    pub helix: D,
    /// Transverse pressure angle, rad.
    pub pressure_angle: D,
    /// Depth of immersion of the pitch circle, m.
    pub immersion: D,
    /// Volume of oil, m³.
    pub oil_volume: D,
    /// Kinematic viscosity, m²/s.
    pub kinematic_viscosity: D,
    /// Density of the oil, kg/m³.
    pub density: D,
    /// Acceleration that holds the oil down (gravity, or ω_c² a in a planetary oil ring), m/s².
    pub gravity: D,
}

family! {
    /// Power lost by a gear that dips into the sump.
    Churning ("churning"): ImmersedGear => "P" ["W"];
    changenet_2011::Changenet2011,
    iso14179_1::Iso14179p1,
}

impl ImmersedGear<f64> {
    /// A gear of module 3 mm and 160 mm diameter that dips 40 mm into 0.8 l of oil at 1000 r/min, for
    /// examples and tests.
    pub fn typical() -> Self {
        Self {
            speed: 1000.0 * std::f64::consts::PI / 30.0,
            radius: 0.08,
            tip_radius: 0.083,
            root_radius: 0.07625,
            width: 0.024,
            module: 3e-3,
            teeth: 53.0,
            helix: 0.0,
            pressure_angle: 20f64.to_radians(),
            immersion: 0.04,
            oil_volume: 0.8e-3,
            kinematic_viscosity: 36.6e-6,
            density: 850.0,
            gravity: 9.81,
        }
    }
}
