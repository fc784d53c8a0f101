//! Factor on the film thickness for the heating of the oil at the inlet.

/// State of the inlet of a contact.
#[derive(Clone, Copy, Debug)]
pub struct Inlet<D> {
    /// Dynamic viscosity at the inlet temperature, Pa s.
    pub dynamic_viscosity: D,
    /// Slope of the viscosity `β = −(1/η) dη/dT`, 1/K.
    pub viscosity_slope: D,
    /// Mean surface speed, m/s.
    pub mean_speed: D,
    /// Slide-roll ratio `|u_1 − u_2|/mean speed`.
    pub slide_ratio: D,
    /// Thermal conductivity of the oil, W/(m K).
    pub conductivity: f64,
    /// Hertzian pressure, Pa.
    pub hertz_pressure: D,
    /// Reduced modulus `E'`, Pa.
    pub reduced_modulus: f64,
}
