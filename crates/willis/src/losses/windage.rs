//! Power lost by a gear that turns in air or in a mist of air and oil.

/// State of a gear in air.
#[derive(Clone, Copy, Debug)]
pub struct Disc<D> {
    /// Absolute angular speed, ≥ 0, rad/s.
    pub speed: D,
    /// Pitch radius, m.
    pub radius: D,
    /// Root radius, m.
    pub root_radius: D,
    /// Face width, m.
    pub width: D,
    /// Normal module, m.
    pub module: D,
    /// Tooth count.
    pub teeth: f64,
    /// Density of the fluid around it, kg/m³.
    pub density: D,
    /// Dynamic viscosity of the fluid around it, Pa s.
    pub viscosity: D,
    /// Axial distance to a flange or wall on both sides, as far as it is nearer than the free
    /// side of the disc, m.
    pub axial_gaps: [D; 2],
    /// Factor of the enclosure: 1 free, 0.6 to 0.7 in a large case, 0.5 in a fitting case.
    pub enclosure: D,
}

family! {
    /// Power lost by a gear in air or mist.
    Windage ("windage"): Disc => "P" ["W"];
    diab::Diab,
    dawson_1984::Dawson1984,
    anderson_loewenthal::AndersonLoewenthal,
}

/// Parts of air to one part of oil, by volume, in the mist around jet-lubricated gears (NASA TP-1622).
pub const AIR_PER_OIL: f64 = 34.25;

impl Windage {
    /// Parts of air to one part of oil, by volume, in which the law was measured; `None` if in air alone.
    ///
    /// ```
    /// use willis::losses::windage::Windage;
    ///
    /// assert_eq!(Windage::default().air_per_oil(), None);
    /// assert_eq!(Windage::named("anderson-loewenthal").unwrap().air_per_oil(), Some(34.25));
    /// ```
    pub fn air_per_oil(&self) -> Option<f64> {
        matches!(self, Self::AndersonLoewenthal(_)).then_some(AIR_PER_OIL)
    }
}

/// Density or dynamic viscosity of a mist, from that of oil and of air: `(oil + r air)/(1 + r)` with r
/// parts of air to one of oil by volume ([`AIR_PER_OIL`]).
///
/// ```
/// use willis::losses::windage::{AIR_PER_OIL, mist};
///
/// assert_eq!(format!("{:.4}", mist(870.0, 1.2, AIR_PER_OIL)), "25.8468");
/// ```
pub fn mist<D: crate::real::Real>(oil: D, air: f64, air_per_oil: D) -> D {
    (oil + air_per_oil * air) / (air_per_oil + 1.0)
}

impl Disc<f64> {
    /// A gear of module 5 mm, 200 mm in diameter and 50 mm wide, at 10 000 r/min free in air at
    /// 20 °C, for examples and tests.
    pub fn typical() -> Self {
        Self {
            speed: 10_000.0 * std::f64::consts::PI / 30.0,
            radius: 0.1,
            root_radius: 0.09375,
            width: 0.05,
            module: 5e-3,
            teeth: 40.0,
            density: 1.2,
            viscosity: 18e-6,
            axial_gaps: [0.08, 0.08],
            enclosure: 1.0,
        }
    }
}
