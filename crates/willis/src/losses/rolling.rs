//! Power lost by rolling (pumping oil through the contact) in one tooth contact line.

/// State of a rolling tooth contact.
#[derive(Clone, Copy, Debug)]
pub struct RollingContact<D> {
    /// Sum of the surface speeds `u_1 + u_2`, m/s.
    pub sum_speed: D,
    /// Reduced radius of curvature in the normal section, m.
    pub radius: D,
    /// Normal force on the contact line, N.
    pub normal_force: D,
    /// Length of the contact line, m.
    pub length: D,
    /// Dynamic viscosity, Pa s.
    pub dynamic_viscosity: D,
    /// Pressure-viscosity coefficient, 1/Pa.
    pub pressure_viscosity: D,
    /// Reduced modulus `E'`, Pa.
    pub reduced_modulus: D,
    /// Factor of the thermal reduction of the film, 0 to 1.
    pub film_reduction: D,
}

family! {
    /// Power lost by rolling in one line of contact.
    Rolling ("rolling"): RollingContact => "P" ["W"];
    anderson_loewenthal::AndersonLoewenthal,
    goksem_hargreaves::GoksemHargreaves,
    no_rolling::NoRolling,
}

impl RollingContact<f64> {
    /// The pitch point of [`MeshContact::typical`](super::mesh_friction::MeshContact::typical).
    pub fn typical() -> Self {
        Self {
            sum_speed: 6.1,
            radius: 8.38e-3,
            normal_force: 5460.0,
            length: 14e-3,
            dynamic_viscosity: 33e-3,
            pressure_viscosity: 16.5e-9,
            reduced_modulus: 226.4e9,
            film_reduction: 0.9,
        }
    }
}
