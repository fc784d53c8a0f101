//! Power that oil sprayed into a mesh takes: the teeth bring it to their own speed.

/// State of a jet at a mesh.
#[derive(Clone, Copy, Debug)]
pub struct JetAtMesh<D> {
    /// Speed of the teeth on their pitch circles, ≥ 0, m/s.
    pub pitch_speed: D,
    /// Speed of the jet towards the teeth, against their motion, m/s.
    pub jet_speed: D,
    /// Oil of the jet, m³/s.
    pub flow: D,
    /// Density of the oil, kg/m³.
    pub density: D,
    /// Whether it is sprayed where the teeth come into mesh, else where they leave it.
    pub into_mesh: bool,
}

family! {
    /// Power that oil sprayed into a mesh takes.
    InjectionLoss ("injection"): JetAtMesh => "P" ["W"];
    ariura::Ariura,
}

impl JetAtMesh<f64> {
    /// 2 l/min of oil of 860 kg/m³ at 20 m/s where teeth of 30 m/s come into mesh. For examples and tests.
    pub fn typical() -> Self {
        Self { pitch_speed: 30.0, jet_speed: 20.0, flow: 2e-3 / 60.0, density: 860.0, into_mesh: true }
    }
}
