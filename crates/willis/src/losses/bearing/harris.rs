use super::{BearingDuty, Law, Palmgren};
use crate::catalogue::bearing::Kind;
use crate::losses::{LawInfo, Trust};
use crate::real::{self, Inner, Real};

/// Palmgren's torque with Harris' part for the flanges of axially loaded cylindrical rollers.
///
/// # Formula
/// ```text
/// M = M_0 + M_1 + M_f,  M_f = f_f F_a d_m
/// ```
/// M_0 and M_1 as in [`Palmgren`]; M_f for cylindrical and needle rollers only.
///
/// # Symbols
/// | there | here              | unit there | meaning                       |
/// |-------|-------------------|------------|-------------------------------|
/// | f_f   | `flange_friction` | −          | 0.002 to 0.009                |
/// | F_a   | `axial_load`      | N          | axial load                    |
/// | d_m   | `bearing`         | mm         | mean diameter (d + D)/2       |
///
/// # Valid for
/// Cylindrical roller bearings with flanges, axial load below 0.4 of the radial load.
///
/// # Departs from the source
/// f_f is the middle of its range where not given. The tables f_0, f_1 are those of [`Palmgren`].
///
/// # Source
/// `[harris2001]`, bearing friction torque. The number of the equation there is not known to us.
///
/// # Example
/// By hand, NJ 308 as in [`Palmgren`] and 1 kN axial: 181.7 + 0.0055 · 1000 · 65 = 539.2 N mm.
/// ```
/// # use willis::losses::bearing::{BearingDuty, Harris, Law};
/// let duty = BearingDuty { axial_load: 1000.0, ..BearingDuty::typical() };
/// assert_eq!(format!("{:.4}", Harris::DEFAULT.eval(&duty)), "0.5392");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Harris {
    /// `f_f`
    pub flange_friction: f64,
}

impl Harris {
    /// Middle of the printed range.
    pub const DEFAULT: Self = Self { flange_friction: 0.0055 };
}

impl Law for Harris {
    const META: LawInfo<BearingDuty<f64>> = LawInfo {
        id: "harris",
        by: "Harris",
        title: "Harris, Palmgren with flange friction",
        source: ("harris2001", "bearing friction torque"),
        trust: Trust::Confirm("f_f, tables of f0 and f1"),
        tags: &[],
        valid: &[],
    };

    fn eval<D: Real>(&self, s: &BearingDuty<D>) -> D {
        let rollers = matches!(
            s.bearing.kind,
            Kind::CylindricalRoller | Kind::FullComplementCylindricalRoller | Kind::NeedleRoller
        );
        let flanges = if rollers { s.bearing.mean_diameter() * self.flange_friction } else { Inner::<D>::from(0.0) };
        Palmgren::DEFAULT.eval(s) + real::abs(s.axial_load) * D::constant(flanges)
    }
}
