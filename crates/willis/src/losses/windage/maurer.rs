use super::{Disc, Law};
use crate::losses::{Meta, Trust};
use crate::real::Real;

/// Ventilation loss of a gear in the air of a closed case after Maurer.
///
/// # Formula
/// ```text
/// P = 1.37e-9 v_t^1.9 d^1.6 b^0.52 m_n^0.69 ω
/// ```
///
/// # Symbols
/// | there | here     | unit there | meaning                               |
/// |-------|----------|------------|---------------------------------------|
/// | P     | result   | W          | power lost; P/ω is the torque in N m  |
/// | v_t   |          | m/s        | speed on the pitch circle, ω d/2      |
/// | d     | `radius` | mm         | pitch diameter                        |
/// | b     | `width`  | mm         | face width                            |
/// | m_n   | `module` | mm         | normal module                         |
/// | ω     | `speed`  | rad/s      | angular speed                         |
///
/// # Valid for
/// Cylindrical gears under a jet in a closed case; the range of the tests is not known to us.
///
/// # Departs from the source
/// `density` and `viscosity` are not used; the constant holds for air. The case is in the constant: `enclosure` is not used
/// either.
///
/// # Source
/// `[maurer1994]`, as the public program of a research group prints it (its function `Getrieberechnung_Einstufig`,
/// ventilation losses, which it leaves out, after the method that FVA's programs name after Maurer). The work itself was
/// not read.
///
/// # Example
/// By hand, the gear of [`Disc::typical`]: v_t = 104.72 m/s; 1.37e-9 · 6887.4 · 4804.5 · 7.6465 · 3.0359 = 1.0524 N m,
/// times 1047.2 rad/s = 1102 W.
/// ```
/// # use willis::losses::windage::{Disc, Law, Maurer};
/// assert_eq!(format!("{:.0}", Maurer::DEFAULT.eval(&Disc::typical())), "1102");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Maurer;

impl Maurer {
    /// As published.
    pub const DEFAULT: Self = Self;
}

impl Law for Maurer {
    const META: Meta<Disc<f64>> = Meta {
        id: "maurer",
        by: "Maurer",
        title: "Maurer, gears in the air of a closed case",
        source: ("maurer1994", "ventilation loss, as printed by a program"),
        trust: Trust::Confirm("1.37e-9 and the exponents, read in one program; that they are of one gear; the range"),
        tags: &[],
        valid: &[],
    };

    fn eval<D: Real>(&self, s: &Disc<D>) -> D {
        if s.speed.re() <= 0.0 {
            return D::from(0.0);
        }
        let v_m_s = s.speed * s.radius;
        let (d_mm, b_mm, m_mm) = (s.radius * 2e3, s.width * 1e3, s.module * 1e3);
        v_m_s.powf(1.9) * d_mm.powf(1.6) * b_mm.powf(0.52) * m_mm.powf(0.69) * 1.37e-9 * s.speed
    }
}
