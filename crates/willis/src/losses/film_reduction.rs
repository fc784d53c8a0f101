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
    pub conductivity: D,
    /// Hertzian pressure, Pa.
    pub hertz_pressure: D,
    /// Reduced modulus `E'`, Pa.
    pub reduced_modulus: D,
}

family! {
    /// Factor on the film thickness.
    FilmReduction ("film_reduction"): Inlet => "phi_T" ["-"];
    murch_wilson::MurchWilson,
    gupta_cheng::GuptaCheng,
    no_reduction::NoReduction,
}

/// Thermal load `L = η β u²/k`.
fn thermal_load<D: crate::Real>(s: &Inlet<D>) -> D {
    s.dynamic_viscosity * s.viscosity_slope * s.mean_speed * s.mean_speed / s.conductivity
}

/// Slide-roll ratio, not below 1e−9: its power 0.83 has no derivative at zero.
fn slide<D: crate::Real>(s: &Inlet<D>) -> D {
    crate::real::max(s.slide_ratio, D::from(1e-9))
}

impl Inlet<f64> {
    /// A point near the pitch point of
    /// [`MeshContact::typical`](super::mesh_friction::MeshContact::typical).
    pub fn typical() -> Self {
        Self {
            dynamic_viscosity: 33e-3,
            viscosity_slope: 0.038,
            mean_speed: 3.05,
            slide_ratio: 0.39,
            conductivity: 0.135,
            hertz_pressure: 1.25e9,
            reduced_modulus: 226.4e9,
        }
    }
}
