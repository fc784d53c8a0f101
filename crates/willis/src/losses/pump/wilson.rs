use super::{Law, PumpDuty};
use crate::losses::{LawInfo, Tag, Trust};
use crate::real::Real;

/// Torque of a displacement pump with dry and viscous friction.
///
/// # Formula
/// ```text
/// T = d p (1 + C_f) + C_v d η ω,  d = V/(2π);  C_f = 0.03, C_v = 2e5
/// ```
///
/// # Symbols
/// | there | here           | unit there | meaning                       |
/// |-------|----------------|------------|-------------------------------|
/// | V     | `displacement` | m³         | oil of one turn               |
/// | p     | `pressure`     | Pa         | pressure                      |
/// | η     | `viscosity`    | Pa s       | dynamic viscosity             |
/// | ω     | `speed`        | rad/s      | speed of its shaft            |
/// | −     | `efficiency`   | −          | not read                      |
///
/// # Valid for
/// Gear, vane and piston pumps. The two coefficients are those of a usual pump (C_f 0.01 to 0.05, C_v 1e5 to 5e5), an
/// estimate.
///
/// # Departs from the source
/// The constant torque of seals is left out; give it as a drag.
///
/// # Source
/// `[wilson1950]`, torque with coefficients of dry and viscous friction. The number of the equation there is not known to
/// us.
///
/// # Example
/// By hand, the pump of [`PumpDuty::typical`]: d = 2.8648e-6; 2.8648 · 1.03 + 2e5 · 2.8648e-6 · 0.0065 · 209.44
/// = 2.951 + 0.780 = 3.731 N m.
/// ```
/// # use willis::losses::pump::{Law, PumpDuty, Wilson};
/// assert_eq!(format!("{:.3}", Wilson::DEFAULT.eval(&PumpDuty::typical())), "3.731");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wilson {
    /// Coefficient of dry friction `C_f`.
    pub dry: f64,
    /// Coefficient of viscous friction `C_v`.
    pub viscous: f64,
}

impl Wilson {
    /// A usual pump.
    pub const DEFAULT: Self = Self { dry: 0.03, viscous: 2e5 };
}

impl Law for Wilson {
    const META: LawInfo<PumpDuty<f64>> = LawInfo {
        id: "wilson",
        by: "Wilson",
        title: "Wilson: dry and viscous friction",
        source: ("wilson1950", "torque with coefficients of friction"),
        trust: Trust::Confirm("both coefficients"),
        tags: &[Tag::Estimate],
        valid: &[],
    };

    fn eval<D: Real>(&self, s: &PumpDuty<D>) -> D {
        let d = s.displacement / std::f64::consts::TAU;
        d * s.pressure * (1.0 + self.dry) + d * s.viscosity * s.speed * self.viscous
    }
}
