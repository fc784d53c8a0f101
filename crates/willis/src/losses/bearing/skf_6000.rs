use num_dual::DualNum;

use super::skf::{Mm, Turning, interpolate, rpm};
use super::{BearingDuty, Law, Parts, Supply};
use crate::losses::{LawInfo, Tag, Trust};
use crate::real::{Inner, Real, min};

/// Frictional torque of a rolling bearing after SKF's general catalogue 6000, with its old drag.
///
/// # Formula
/// ```text
/// M = φ_ish φ_rs M_rr + M_sl + M_seal + M_drag
/// M_drag = V_M K_ball d_m⁵ n²          (balls)
/// M_drag = 10 V_M K_roll B d_m⁴ n²     (rollers)
/// ```
/// Everything else as in [`Skf`](super::Skf), with μ_bl = 0.15.
///
/// # Symbols
/// | there   | here                   | unit there | meaning                                         |
/// |---------|------------------------|------------|-------------------------------------------------|
/// | V_M     | `drag_loss_factor`     | −          | drag loss factor; from the level where not given |
/// | K_rs    | `starvation`           | −          | from the supply where not given                 |
/// | the rest | as in [`Skf`](super::Skf) | −       |                                                 |
///
/// # Valid for
/// Superseded by the catalogues from 2013 on. It is kept to reproduce publications that used it,
/// among them `[wang2020]`, where it gives nine tenths of the torque as drag.
///
/// # Departs from the source
/// V_M is taken over H/d_m from the newer diagram. The formula for balls stands as recalled. Starting
/// torque and estimates of missing data as in [`Skf`](super::Skf); a jet doubles the drag of a bath
/// that reaches the middle of the lowest rolling element.
///
/// # Source
/// `[skf2008]`, friction: the model from page 89; rolling moment, sliding moment and seals on page 90,
/// heating of the inlet on 97, replenishment and drag on 98, mixed lubrication on 100. The pages are those
/// of a copy whose year is not known to us.
///
/// # Example
/// By hand, a cylindrical roller bearing 110 × 170 × 38 mm with V_M = 1.2e-4, 4920 r/min:
/// K_roll = 0.65 · 5.1 · 280/60 · 1e-12 = 1.547e-11,
/// M_drag = 10 · 1.2e-4 · 1.547e-11 · 38 · 140⁴ · 4920² = 6560 N mm.
/// ```
/// # use willis::catalogue::bearing::{Bearing, Kind};
/// # use willis::losses::bearing::{BearingDuty, Skf6000};
/// let bearing = Bearing::new("", Kind::CylindricalRoller, "23", 0.110, 0.170, 0.038).data();
/// let duty = BearingDuty { bearing, speed: 164.0 * std::f64::consts::PI, ..BearingDuty::typical() };
/// let law = Skf6000 { drag_loss_factor: Some(1.2e-4), ..Skf6000::DEFAULT };
/// assert_eq!(format!("{:.3}", law.parts(&duty).unwrap().drag), "6.560");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Skf6000 {
    /// `K_rs`, where it is not to follow from the supply.
    pub starvation: Option<f64>,
    /// `V_M`, where it is not to follow from the oil level.
    pub drag_loss_factor: Option<f64>,
}

impl Skf6000 {
    /// As published.
    pub const DEFAULT: Self = Self { starvation: None, drag_loss_factor: None };

    /// The parts of the torque; `None` for a bearing without constants.
    pub fn parts<D: Real>(&self, s: &BearingDuty<D>) -> Option<Parts<D>> {
        Some(self.turning(s)?.parts(s))
    }

    /// What of it no load changes; `None` for a bearing without constants.
    pub(super) fn turning<D: Real>(&self, s: &BearingDuty<D>) -> Option<Turning<D>> {
        let k = s.bearing.skf?;
        let Mm { d, big_d, b, dm } = Mm::of(&s.bearing);
        let (level, jets) = match s.supply {
            Supply::Bath { level } => (level * 1e3, 1.0),
            Supply::Jet => (s.bearing.element_diameter * 500.0, 2.0),
            Supply::Mist | Supply::Grease => (Inner::<D>::from(0.0), 1.0),
        };
        let v_m = self
            .drag_loss_factor
            .map_or_else(|| interpolate(k.drag, min(level, dm * 1.2) / dm), Inner::<D>::from);
        let ratio = (d + big_d) * k.k_z / (big_d - d) * 1e-12;
        let factor = if s.bearing.kind.is_ball() {
            ratio * f64::from(s.bearing.rows) * dm.powi(5)
        } else {
            ratio * (10.0 * k.k_l) * b * dm.powi(4)
        };
        let n = rpm(s);
        let drag = n * n * D::constant(v_m * factor * jets * 1e-3);
        Some(Turning::new(s, k, self.starvation, 0.15, drag))
    }
}

impl Law for Skf6000 {
    const META: LawInfo<BearingDuty<f64>> = LawInfo {
        id: "skf-6000",
        by: "SKF 6000",
        title: "SKF general catalogue 6000, superseded",
        source: ("skf2008", "friction, pages 89 to 100; drag on page 98"),
        trust: Trust::Confirm("drag of ball bearings"),
        tags: &[Tag::Compatibility],
        valid: &[],
    };

    fn eval<D: Real>(&self, s: &BearingDuty<D>) -> D {
        match self.parts(s) {
            Some(parts) => parts.total(),
            None => super::Palmgren::DEFAULT.eval(s),
        }
    }
}
