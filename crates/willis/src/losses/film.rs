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
    pub reduced_modulus: D,
}

family! {
    /// Thickness of the oil film.
    Film ("film"): FilmContact => "h" ["m"];
    dowson_higginson::DowsonHigginson,
    dowson_toyoda::DowsonToyoda,
    grubin::Grubin,
    dowson_higginson_1966::DowsonHigginson1966,
}

/// Groups of Dowson and Higginson: speed `U`, material `G`, load `W`.
fn groups<D: crate::Real>(s: &FilmContact<D>) -> (D, D, D) {
    let stiffness = s.radius * s.reduced_modulus;
    (s.dynamic_viscosity * s.mean_speed / stiffness, s.pressure_viscosity * s.reduced_modulus, s.line_load / stiffness)
}

impl FilmContact<f64> {
    /// The pitch point of [`MeshContact::typical`](super::mesh_friction::MeshContact::typical).
    pub fn typical() -> Self {
        Self {
            radius: 8.38e-3,
            mean_speed: 3.05,
            line_load: 390e3,
            dynamic_viscosity: 33e-3,
            pressure_viscosity: 16.5e-9,
            reduced_modulus: 226.4e9,
        }
    }
}
