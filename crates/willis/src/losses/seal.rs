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
pub struct SealContact<D> {
    /// Shaft diameter, m.
    pub diameter: D,
    /// Speed of the shaft relative to the lip, ≥ 0, rad/s.
    pub speed: D,
    /// Oil temperature, K.
    pub temperature: D,
    /// Kinematic viscosity of the oil at 40 °C, m²/s.
    pub viscosity_40: D,
    /// Material of the lip.
    pub material: Material,
}

family! {
    /// Power lost by a radial lip seal.
    SealLoss ("seal"): SealContact => "P" ["W"];
    iso14179_2::Iso14179p2,
    simrit::Simrit,
    iso14179_1::Iso14179p1,
}

impl SealContact<f64> {
    /// A fluoro rubber seal on a shaft of 50 mm at 1500 r/min in oil ISO VG 100 at 60 °C, for examples
    /// and tests.
    pub fn typical() -> Self {
        Self {
            diameter: 0.05,
            speed: 50.0 * std::f64::consts::PI,
            temperature: 333.15,
            viscosity_40: 100e-6,
            material: Material::Fkm,
        }
    }
}
