use super::{JetAtMesh, Law};
use crate::losses::{LawInfo, Trust};
use crate::real::Real;

/// Power by which teeth accelerate the oil of a jet.
///
/// # Formula
/// ```text
/// P = C ρ Q v_t (v_t + v_jet);  C = 0.85 into the mesh, 1 where the teeth leave it
/// ```
///
/// # Symbols
/// | there | here          | unit there | meaning                               |
/// |-------|---------------|------------|---------------------------------------|
/// | v_t   | `pitch_speed` | m/s        | speed of the teeth                    |
/// | v_jet | `jet_speed`   | m/s        | speed of the jet against their motion |
/// | Q     | `flow`        | m³/s       | oil                                   |
/// | ρ     | `density`     | kg/m³      | oil                                   |
/// | −     | `into_mesh`   | −          | where it is sprayed                   |
///
/// # Valid for
/// Jets on cylindrical gears. What the teeth lose by squeezing trapped oil out of the mesh is not in it.
///
/// # Departs from the source
/// The torque times the speed of the wheel is written with the speed of the teeth.
///
/// # Source
/// `[ariura1973]`, power of accelerating the oil, as later programs print it. The number of the equation there is not
/// known to us.
///
/// # Example
/// By hand, the jet of [`JetAtMesh::typical`]: 0.85 · 860 · 3.3333e-5 · 30 · 50 = 36.55 W.
/// ```
/// # use willis::losses::injection::{Ariura, JetAtMesh, Law};
/// assert_eq!(format!("{:.2}", Ariura::DEFAULT.eval(&JetAtMesh::typical())), "36.55");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ariura;

impl Ariura {
    /// As published.
    pub const DEFAULT: Self = Self;
}

impl Law for Ariura {
    const META: LawInfo<JetAtMesh<f64>> = LawInfo {
        id: "ariura",
        by: "Ariura",
        title: "Ariura: accelerating the oil",
        source: ("ariura1973", "power of accelerating the oil"),
        trust: Trust::Confirm("the factor 0.85"),
        tags: &[],
        valid: &[],
    };

    fn eval<D: Real>(&self, s: &JetAtMesh<D>) -> D {
        let caught = if s.into_mesh { 0.85 } else { 1.0 };
        s.density * s.flow * s.pitch_speed * (s.pitch_speed + s.jet_speed) * caught
    }
}
