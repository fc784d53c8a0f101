use super::{Law, PumpDuty};
use crate::losses::{LawInfo, Trust};
use crate::real::Real;

/// Torque of a displacement pump by its efficiency.
///
/// # Formula
/// ```text
/// T = V p/(2π η_hm)
/// ```
///
/// # Symbols
/// | there | here           | unit there | meaning                       |
/// |-------|----------------|------------|-------------------------------|
/// | V     | `displacement` | m³         | oil of one turn               |
/// | p     | `pressure`     | Pa         | pressure                      |
/// | η_hm  | `efficiency`   | −          | hydromechanical efficiency; 0.85 where it is not given |
///
/// # Valid for
/// Any displacement pump. All of its power becomes heat of the oil: what it delivers is throttled.
///
/// # Departs from the source
/// Nothing.
///
/// # Source
/// `[wilson1950]`, torque of a positive displacement pump: the work of one turn is V p. The number of the equation there
/// is not known to us. 0.85 is an estimate (0.7 to 0.9 in use).
///
/// # Example
/// By hand, the pump of [`PumpDuty::typical`]: 18e-6 · 1e6/(2π · 0.85) = 3.370 N m.
/// ```
/// # use willis::losses::pump::{Displacement, Law, PumpDuty};
/// assert_eq!(format!("{:.3}", Displacement::DEFAULT.eval(&PumpDuty::typical())), "3.370");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Displacement;

impl Displacement {
    /// As derived.
    pub const DEFAULT: Self = Self;
}

impl Law for Displacement {
    const META: LawInfo<PumpDuty<f64>> = LawInfo {
        id: "displacement",
        by: "",
        title: "work of a turn over the efficiency",
        source: ("wilson1950", "torque of a positive displacement pump"),
        trust: Trust::Derived,
        tags: &[],
        valid: &[],
    };

    fn eval<D: Real>(&self, s: &PumpDuty<D>) -> D {
        s.displacement * s.pressure / s.efficiency.unwrap_or(D::from(0.85)) / std::f64::consts::TAU
    }
}
