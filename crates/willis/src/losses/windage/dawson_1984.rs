use super::{Disc, Law};
use crate::losses::{LawInfo, ValidityRange, Trust};
use crate::real::Real;

/// Windage of a large gear in air after Dawson (1984).
///
/// # Formula
/// ```text
/// P = n^2.9 (0.16 D^3.9 + D^2.9 F^0.75 m^1.15) 1e-20 Φ λ
/// ```
///
/// # Symbols
/// | there | here          | unit there | meaning                                                  |
/// |-------|---------------|------------|----------------------------------------------------------|
/// | P     | result        | kW         | power lost                                               |
/// | n     | `speed`       | r/min      | absolute speed                                           |
/// | D     | `root_radius` | mm         | root diameter                                            |
/// | F     | `width`       | mm         | face width                                               |
/// | m     | `module`      | mm         | module                                                   |
/// | Φ     | `mist_factor` | −          | 1 for air free of oil                                    |
/// | λ     | `enclosure`   | −          | 1 free, 0.6 to 0.7 in a large case, 0.5 in a fitting one |
///
/// # Valid for
/// Gears of 300 to 1160 mm diameter, in air.
///
/// # Departs from the source
/// Nothing. `density` and `viscosity` are not used; the constant holds for air. One stored program
/// carries the factor 1e-20 ten times too large.
///
/// # Source
/// `[dawson1984]`, windage formula. The number of the equation there is not known to us.
///
/// # Example
/// By hand, root diameter 400 mm, 50 mm wide, module 5 mm, 10 000 r/min: D^3.9 = 1.4062e10, D^2.9 =
/// 3.5154e7, F^0.75 = 18.803, m^1.15 = 6.3653; 10^11.6 (2.2499e9 + 4.2074e9) 1e-20 = 25.707 kW.
/// ```
/// # use willis::losses::windage::{Dawson1984, Disc, Law};
/// let disc = Disc { root_radius: 0.2, ..Disc::typical() };
/// assert_eq!(format!("{:.0}", Dawson1984::DEFAULT.eval(&disc)), "25707");
/// assert!(Dawson1984::DEFAULT.outside(&disc).is_empty());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dawson1984 {
    /// `Φ`
    pub mist_factor: f64,
}

impl Dawson1984 {
    /// Air free of oil.
    pub const DEFAULT: Self = Self { mist_factor: 1.0 };
}

impl Law for Dawson1984 {
    const META: LawInfo<Disc<f64>> = LawInfo {
        id: "dawson-1984",
        by: "Dawson 1984",
        title: "Dawson 1984, large gears in air",
        source: ("dawson1984", "windage formula"),
        trust: Trust::Seen,
        tags: &[],
        valid: &[ValidityRange { symbol: "D", unit: "m", min: 0.3, max: 1.16, get: |s| 2.0 * s.root_radius }],
    };

    fn eval<D: Real>(&self, s: &Disc<D>) -> D {
        if s.speed.re() <= 0.0 {
            return D::from(0.0);
        }
        let n = s.speed * (30.0 / std::f64::consts::PI);
        let (d_mm, f_mm, m_mm) = (s.root_radius * 2e3, s.width * 1e3, s.module * 1e3);
        let size = d_mm.powf(3.9) * 0.16 + d_mm.powf(2.9) * f_mm.powf(0.75) * m_mm.powf(1.15);
        n.powf(2.9) * (size * 1e-20 * self.mist_factor * s.enclosure * 1e3)
    }
}
