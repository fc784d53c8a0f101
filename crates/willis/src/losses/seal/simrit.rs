use super::{Law, SealContact};
use crate::losses::{LawInfo, Trust};
use crate::real::{Real, max};

/// Power lost by a lip seal after Simrit (ISO/TR 14179-2), with oil and temperature.
///
/// # Formula
/// ```text
/// P = (145 − 1.6 T + 350 log10(log10(ν_40 + 0.8))) d² n 1e-7
/// ```
///
/// # Symbols
/// | there | here           | unit there | meaning                        |
/// |-------|----------------|------------|--------------------------------|
/// | P     | result         | W          | power lost                     |
/// | T     | `temperature`  | °C         | oil temperature                |
/// | ν_40  | `viscosity_40` | mm²/s      | kinematic viscosity at 40 °C   |
/// | d     | `diameter`     | mm         | shaft diameter                 |
/// | n     | `speed`        | r/min      | shaft speed                    |
///
/// # Valid for
/// One lip; about twice the loss of the other formulas of this family.
///
/// # Departs from the source
/// A bracket below 0 (hot and thin oil) counts as 0; oils below 2 mm²/s as 2 mm²/s.
///
/// # Source
/// `[isotr14179_2]`, radial lip seals. The number of the equation there is not known to us.
///
/// # Example
/// By hand, 60 °C, 100 mm²/s, d = 50 mm, 1500 r/min: (145 − 96 + 350 · 0.301781) 2500 · 1500 · 1e-7 = 58.0 W.
/// ```
/// # use willis::losses::seal::{Simrit, Law, SealContact};
/// assert_eq!(format!("{:.1}", Simrit::DEFAULT.eval(&SealContact::typical())), "58.0");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Simrit;

impl Simrit {
    /// As published.
    pub const DEFAULT: Self = Self;
}

impl Law for Simrit {
    const META: LawInfo<SealContact<f64>> = LawInfo {
        id: "simrit",
        by: "Simrit",
        title: "Simrit (ISO/TR 14179-2)",
        source: ("isotr14179_2", "radial lip seals"),
        trust: Trust::Confirm("145, 1.6 and 350"),
        tags: &[],
        valid: &[],
    };

    fn eval<D: Real>(&self, s: &SealContact<D>) -> D {
        let d_mm = s.diameter * 1e3;
        let celsius = s.temperature - 273.15;
        let oil = (max(s.viscosity_40 * 1e6, D::from(2.0)) + 0.8).log10().log10();
        let bracket = -celsius * 1.6 + (oil * 350.0 + 145.0);
        if bracket.re() <= 0.0 {
            return D::from(0.0);
        }
        bracket * s.speed * (d_mm * d_mm * 1e-7 * 30.0 / std::f64::consts::PI)
    }
}
