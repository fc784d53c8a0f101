//! Power lost by a radial lip seal.

/// Material of a seal lip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Material {
    /// Fluoro rubber, FKM.
    Fkm,
    /// Nitrile rubber, NBR.
    Nbr,
}

/// State of a lip seal.
#[derive(Clone, Copy, Debug)]
pub struct Lip<D> {
    /// Shaft diameter, m.
    pub diameter: f64,
    /// Speed of the shaft relative to the lip, ≥ 0, rad/s.
    pub speed: D,
    /// Oil temperature, K.
    pub temperature: D,
    /// Kinematic viscosity of the oil at 40 °C, m²/s.
    pub viscosity_40: f64,
    /// Material of the lip.
    pub material: Material,
}
