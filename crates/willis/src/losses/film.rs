//! Thickness of the oil film between teeth (isothermal).

/// State of an elastohydrodynamic line contact.
#[derive(Clone, Copy, Debug)]
pub struct FilmContact<D> {
    /// Reduced radius of curvature in the normal section, m.
    pub radius: D,
    /// MEAN surface speed `(u_1 + u_2)/2`, m/s.
    pub mean_speed: D,
    /// Normal load per length of contact line, N/m.
    pub line_load: D,
    /// Dynamic viscosity at the inlet, Pa s.
    pub dynamic_viscosity: D,
    /// Pressure-viscosity coefficient, 1/Pa.
    pub pressure_viscosity: D,
    /// Reduced modulus `E' = 2/((1 - ν1²)/E1 + (1 - ν2²)/E2)`, Pa.
    pub reduced_modulus: f64,
}
