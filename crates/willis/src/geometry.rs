//! Involute geometry of a cylindrical pair of gears, external or with a ring; and what a
//! planetary set needs for its planets to fit.
//!
//! No loads, no train: teeth, shifts, radii, the path of contact and the motion along it. All
//! quantities are SI, all speeds relative to the carrier of the pair.
//!
//! Tooth counts are positive. A shift x > 0 moves the tooth outward, away from the axis, also on
//! a ring. Standards (DIN 3960, ISO 21771) and the programs that follow them write a ring with
//! z_2 < 0 and a shift of the other sign: their x_2 = −0.5013 is +0.5013 here.
//!
//! The **line of action** is measured by `s`, m, from the pitch point C, s > 0 towards the
//! addendum of wheel 0. Wheel 0 driving, a tooth pair enters at A (tip of wheel 1) and leaves at
//! E (tip of wheel 0).

mod fault;
pub mod hypoid;
mod involute;
mod planetary;
mod stiffness;

pub use fault::{Fault, Quantity, Remark};
pub use involute::{inverse_involute, involute};
pub use planetary::{SimpleSetGeometry, conjugate_shifts, least_mesh_angle, neighbour_clearance};

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::real::{self, Real};

/// What is known of one wheel of a cylindrical pair.
///
/// # Example
/// A ring of 56 teeth that a German drawing calls z = −56, x = −0.5013.
/// ```
/// use willis::geometry::{Tip, Wheel};
///
/// let ring = Wheel {
///     teeth: 56.0,
///     internal: true,
///     shift: 0.5013,
///     tip: Tip::Addendum { coefficient: 1.0, alteration: 0.0 },
///     dedendum: 1.25,
/// };
/// assert!(ring.internal);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Wheel<R = f64> {
    /// Tooth count, positive.
    pub teeth: f64,
    /// Whether it is a ring gear.
    pub internal: bool,
    /// Profile shift coefficient x, −. Positive moves the tooth outward, also on a ring; where
    /// z_2 is written negative (DIN 3960, ISO 21771, KISSsoft) the shift of a ring has the other
    /// sign.
    pub shift: R,
    /// Where the tooth ends.
    pub tip: Tip<R>,
    /// Dedendum coefficient of the basic rack, −; 1.25 is usual.
    pub dedendum: R,
}

/// Where a tooth ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tip<R = f64> {
    /// By the basic rack: `r_a = r + (h_aP* + x) m_n + k m_n`, on a ring
    /// `r_a = r − (h_aP* − x) m_n − k m_n`.
    Addendum {
        /// Addendum coefficient `h_aP*`, −; 1 is usual.
        coefficient: R,
        /// Tip alteration `k m_n`, m. Negative shortens the tooth, also on a ring.
        alteration: R,
    },
    /// Tip radius, m.
    Radius(R),
}

/// What is known of a cylindrical pair.
#[derive(Clone, Debug, PartialEq)]
pub struct PairData<R = f64> {
    /// Normal module `m_n`, m.
    pub module: R,
    /// Normal pressure angle of the basic rack `α_n`, rad.
    pub pressure_angle: R,
    /// Helix angle at the reference circle `β`, rad, ≥ 0.
    pub helix: R,
    /// Whether the pair has two helices of opposite hand.
    pub double_helical: bool,
    /// Common face width `b`, m; of a double helical pair that of **one** helix.
    pub width: R,
    /// Operating centre distance `a`, m. When not given it follows from the shifts, without
    /// backlash.
    pub centre_distance: Option<R>,
    /// The two wheels. Either one may be the ring.
    pub wheels: [Wheel<R>; 2],
}

impl PairData {
    /// The same with another kind of numbers.
    pub fn lift<R: Real>(&self) -> PairData<R> {
        let wheel = |w: &Wheel| Wheel {
            teeth: w.teeth,
            internal: w.internal,
            shift: R::from(w.shift),
            tip: match w.tip {
                Tip::Addendum { coefficient, alteration } => {
                    Tip::Addendum { coefficient: R::from(coefficient), alteration: R::from(alteration) }
                }
                Tip::Radius(radius) => Tip::Radius(R::from(radius)),
            },
            dedendum: R::from(w.dedendum),
        };
        PairData {
            module: R::from(self.module),
            pressure_angle: R::from(self.pressure_angle),
            helix: R::from(self.helix),
            double_helical: self.double_helical,
            width: R::from(self.width),
            centre_distance: self.centre_distance.map(R::from),
            wheels: [wheel(&self.wheels[0]), wheel(&self.wheels[1])],
        }
    }
}

/// One wheel of a pair, worked out.
#[derive(Clone, Debug, PartialEq)]
pub struct GearGeometry<R = f64> {
    /// Reference radius `r = z m_t/2`, m.
    pub reference_radius: R,
    /// Base radius `r_b = r cos α_t`, m.
    pub base_radius: R,
    /// Operating radius `r_w = r_b/cos α_wt`, m.
    pub operating_radius: R,
    /// Tip radius `r_a`, m.
    pub tip_radius: R,
    /// Root radius `r_f = r − (h_fP* − x) m_n`, on a ring `r + (h_fP* + x) m_n`, m.
    pub root_radius: R,
    /// Tooth thickness at the tip circle in the normal section `s_an`, m, of a tooth without
    /// backlash allowance.
    pub tip_thickness: R,
}

/// A cylindrical pair, worked out.
///
/// # Formula
/// ```text
/// tan α_t = tan α_n/cos β        sin β_b = sin β cos α_n        m_t = m_n/cos β
/// inv α_wt = inv α_t + 2 tan α_n (x_1 + x_2)/(z_1 + z_2)         ring: (x_2 − x_1)/(z_2 − z_1)
/// cos α_wt = (z_1 + z_2) m_t cos α_t/(2 a)                       ring: z_2 − z_1
/// e = (√(r_a² − r_b²) − r_b tan α_wt)/p_bt                       ring: with the other sign
/// ε_α = e_1 + e_2    ε_β = b sin β/(π m_n)    p_bt = π m_t cos α_t
/// ```
///
/// # Source
/// `[iso21771]`.
///
/// # Example
/// FZG type C gears, 16/24 teeth of 4.5 mm. By hand: r_b = 36 cos 20° = 33.829 mm,
/// inv α_wt = 0.014904 + 2 · 0.36397 · 0.3532/40 = 0.021332, α_wt = 22.439°,
/// a = 90 cos 20°/cos 22.439° = 91.500 mm.
/// ```
/// use willis::geometry::{Pair, PairData, Tip, Wheel};
///
/// let wheel = |teeth, shift| Wheel {
///     teeth,
///     internal: false,
///     shift,
///     tip: Tip::Addendum { coefficient: 1.0, alteration: 0.0 },
///     dedendum: 1.25,
/// };
/// let pair = Pair::new(&PairData {
///     module: 4.5e-3,
///     pressure_angle: 20f64.to_radians(),
///     helix: 0.0,
///     double_helical: false,
///     width: 14e-3,
///     centre_distance: None,
///     wheels: [wheel(16.0, 0.1817), wheel(24.0, 0.1715)],
/// })
/// .unwrap();
/// assert_eq!(format!("{:.3}", pair.operating_pressure_angle.to_degrees()), "22.439");
/// assert_eq!(format!("{:.3}", pair.centre_distance * 1e3), "91.500");
/// assert_eq!(format!("{:.4}", pair.contact_ratio), "1.4624");
/// assert!(pair.remarks().is_empty());
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Pair<R = f64> {
    /// What it was made from.
    pub data: PairData<R>,
    /// Transverse module `m_t`, m.
    pub transverse_module: R,
    /// Transverse pressure angle `α_t`, rad.
    pub transverse_pressure_angle: R,
    /// Helix angle at the base circle `β_b`, rad.
    pub base_helix: R,
    /// Operating transverse pressure angle `α_wt`, rad.
    pub operating_pressure_angle: R,
    /// Helix angle at the operating circles `β_w`, rad.
    pub operating_helix: R,
    /// Operating centre distance `a`, m.
    pub centre_distance: R,
    /// Transverse base pitch `p_bt`, m.
    pub base_pitch: R,
    /// Transverse circumferential backlash at the operating circles, m: 0 when the centre distance
    /// follows from the shifts.
    pub backlash: R,
    /// The wheels, in the order of the data.
    pub gears: [GearGeometry<R>; 2],
    /// Addendum contact ratios `e_1`, `e_2`: the part of the path, in base pitches, from C to the
    /// end of this wheel's addendum. Negative when the tip does not reach C.
    pub addendum_contact_ratios: [R; 2],
    /// Transverse contact ratio `ε_α = e_1 + e_2`.
    pub contact_ratio: R,
    /// Overlap ratio `ε_β` of **one** helix.
    pub overlap_ratio: R,
    /// Radii of curvature of both flanks at C in the transverse section, and the cosine of the helix angle at the base
    /// circle: every point of the path needs them.
    curvature_at_pitch: [R; 2],
    cos_base_helix: R,
    remarks: Vec<Remark>,
}

/// Transverse quantities of the basic rack.
struct Basis<R> {
    module: R,
    transverse_angle: R,
    base_helix: R,
}

impl<R: Real> Basis<R> {
    fn new(normal_module: R, pressure_angle: R, helix: R) -> Self {
        Self {
            module: normal_module / helix.cos(),
            transverse_angle: (pressure_angle.tan() / helix.cos()).atan(),
            base_helix: (helix.sin() * pressure_angle.cos()).asin(),
        }
    }
    /// Sum or difference of the base radii.
    fn base_distance(&self, teeth: f64) -> R {
        self.module * teeth * self.transverse_angle.cos() / 2.0
    }
}

/// Tip radius of the cutting rack over the module, profile A of ISO 53; decides undercut and form
/// circle only.
const RACK_TIP_RADIUS: f64 = 0.38;
/// Undercut by less than this much shift is passed over: 17 teeth at 20° are made everywhere.
const UNDERCUT_IGNORED: f64 = 0.02;
/// Excess of tooth thickness over the module that rounded shifts explain.
const BACKLASH_IGNORED: f64 = 1e-3;

impl<R: Real> Pair<R> {
    /// Works a pair out.
    ///
    /// # Errors
    /// Every [`Fault`] that could be found: first those of single quantities, and if there is
    /// none, those of the geometry. A contact ratio below 1 is a fault only when the overlap does
    /// not close the gap, `ε_α + ε_β < 1`. What is unusual but possible is in [`Self::remarks`].
    ///
    /// # Example
    /// ```
    /// use willis::geometry::{Pair, PairData, Tip, Wheel};
    ///
    /// let wheel = Wheel {
    ///     teeth: 20.0,
    ///     internal: true,
    ///     shift: f64::NAN,
    ///     tip: Tip::Radius(0.1),
    ///     dedendum: 1.25,
    /// };
    /// let faults = Pair::new(&PairData {
    ///     module: -2e-3,
    ///     pressure_angle: 20f64.to_radians(),
    ///     helix: 0.0,
    ///     double_helical: false,
    ///     width: 0.02,
    ///     centre_distance: None,
    ///     wheels: [wheel.clone(), wheel],
    /// })
    /// .unwrap_err();
    /// assert_eq!(faults.len(), 4);
    /// assert_eq!(faults[0].to_string(), "module -2 mm: give a number from 0.000001 to 10000 mm");
    /// ```
    pub fn new(data: &PairData<R>) -> Result<Self, Vec<Fault>> {
        let mut faults = scalar_faults(data);
        if !faults.is_empty() {
            return Err(faults);
        }
        let wheels = &data.wheels;
        let ring = wheels.iter().position(|w| w.internal);
        let basis = Basis::new(data.module, data.pressure_angle, data.helix);
        let m_n = data.module;
        let alpha_t = basis.transverse_angle;
        let tan_n = data.pressure_angle.tan();

        let (teeth, shifts) = match ring {
            Some(r) => (wheels[r].teeth - wheels[1 - r].teeth, wheels[r].shift - wheels[1 - r].shift),
            None => (wheels[0].teeth + wheels[1].teeth, wheels[0].shift + wheels[1].shift),
        };
        let closest = basis.base_distance(teeth);
        let (alpha_wt, centre_distance) = match data.centre_distance {
            Some(a) if a.re() >= closest.re() => (real::acos(closest / a), a),
            Some(a) => {
                return Err(vec![Fault::CentreDistanceTooSmall { centre_distance: a.re(), least: closest.re() }]);
            }
            None => match inverse_involute(involute(alpha_t) + tan_n * 2.0 * shifts / teeth) {
                Some(angle) => (angle, closest / angle.cos()),
                None => {
                    let least = -involute(alpha_t.re()) * teeth / (2.0 * tan_n.re());
                    return Err(vec![Fault::NoOperatingAngle { shifts: shifts.re(), least }]);
                }
            },
        };
        let tan_w = alpha_wt.tan();
        let base_pitch = basis.module * PI * alpha_t.cos();
        let operating_module = centre_distance * 2.0 / teeth;
        let play =
            centre_distance * 2.0 * (involute(alpha_wt) - involute(alpha_t)) - operating_module * 2.0 * shifts * tan_n;
        let backlash = match (data.centre_distance, ring) {
            (None, _) => R::from(0.0),
            (_, None) => play,
            (_, Some(_)) => -play,
        };

        let mut remarks = Vec::new();
        let gears = [0, 1].map(|k| gear(data, &basis, alpha_wt, k, &mut faults, &mut remarks));

        // Parts of the path beyond C, and what the mating involute leaves of them.
        let mut e = [R::from(0.0); 2];
        for k in 0..2 {
            let g = &gears[k];
            let end = g.tip_radius * g.tip_radius - g.base_radius * g.base_radius;
            let infinite = R::from(f64::INFINITY);
            let tip = match (wheels[k].internal, end.re() > 0.0) {
                (false, true) => (end.sqrt() - g.base_radius * tan_w) / base_pitch,
                (false, false) => (R::from(0.0) - g.base_radius * tan_w) / base_pitch,
                (true, true) => (g.base_radius * tan_w - end.sqrt()) / base_pitch,
                (true, false) => infinite,
            };
            let mate = &wheels[1 - k];
            let limit = if mate.internal { infinite } else { gears[1 - k].base_radius * tan_w / base_pitch };
            e[k] = real::min(tip, limit);
            if tip.re() > limit.re() * (1.0 + 1e-12) {
                remarks.push(Remark::PathShortened { wheel: k, tip: tip.re(), used: limit.re() });
            }
            if !mate.internal {
                let sin_t = alpha_t.re().sin();
                let height = form_height(data, mate.dedendum.re()) - mate.shift.re();
                let form = gears[1 - k].reference_radius.re() * sin_t - height * m_n.re() / sin_t;
                let contact = (gears[1 - k].base_radius * tan_w - e[k] * base_pitch).re();
                if contact < form - 1e-9 * m_n.re() {
                    remarks.push(Remark::BelowForm { wheel: k, contact, form });
                }
            }
            let clearance = match ring {
                None => centre_distance - g.tip_radius - gears[1 - k].root_radius,
                Some(r) if r == k => g.tip_radius - centre_distance - gears[1 - k].root_radius,
                Some(_) => gears[1 - k].root_radius - centre_distance - g.tip_radius,
            };
            if clearance.re() <= 0.0 {
                remarks.push(Remark::NoClearance { wheel: k, clearance: clearance.re() });
            }
        }
        let contact_ratio = e[0] + e[1];
        let overlap_ratio = data.width * data.helix.sin() / (m_n * PI);
        let ratios = (contact_ratio.re(), overlap_ratio.re());
        if faults.is_empty() {
            if ratios.0 <= 0.0 {
                faults.push(Fault::NoContact { contact_ratio: ratios.0 });
            } else if ratios.0 + ratios.1 < 1.0 {
                faults.push(Fault::Gap { contact_ratio: ratios.0, overlap_ratio: ratios.1 });
            }
        }
        if !faults.is_empty() {
            return Err(faults);
        }
        if ratios.0 < 1.2 && ratios.1 < 1.0 {
            remarks.push(Remark::LowContactRatio { contact_ratio: ratios.0, overlap_ratio: ratios.1 });
        }
        if backlash.re() < -BACKLASH_IGNORED * m_n.re() {
            remarks.push(Remark::NegativeBacklash { backlash: backlash.re() });
        }
        if let Some(overlap) = ring.and_then(|r| {
            tip_overlap(
                &gears[1 - r],
                &gears[r],
                wheels[1 - r].teeth / wheels[r].teeth,
                centre_distance.re(),
                alpha_wt.re(),
            )
        }) {
            remarks.push(Remark::TipInterference { overlap });
        }
        let tan = alpha_wt.tan();
        Ok(Self {
            data: data.clone(),
            curvature_at_pitch: [0, 1].map(|k: usize| gears[k].base_radius * tan),
            cos_base_helix: basis.base_helix.cos(),
            transverse_module: basis.module,
            transverse_pressure_angle: alpha_t,
            base_helix: basis.base_helix,
            operating_pressure_angle: alpha_wt,
            operating_helix: (basis.base_helix.tan() / alpha_wt.cos()).atan(),
            centre_distance,
            base_pitch,
            backlash,
            gears,
            addendum_contact_ratios: e,
            contact_ratio,
            overlap_ratio,
            remarks,
        })
    }

    /// What is unusual: undercut, a ring tip inside the base circle, a shortened path, thin tips,
    /// a low contact ratio, tips that collide, no clearance, teeth too thick.
    ///
    /// # Example
    /// A pinion of 10 teeth without shift is undercut; by hand
    /// x ≥ 1.25 − 0.38 (1 − sin 20°) − 10 sin² 20°/2 = 0.415.
    /// ```
    /// # use willis::geometry::{Pair, PairData, Remark, Tip, Wheel};
    /// # let tip = Tip::Addendum { coefficient: 1.0, alteration: 0.0 };
    /// # let wheel = |teeth| Wheel { teeth, internal: false, shift: 0.0, tip, dedendum: 1.25 };
    /// # let data = PairData {
    /// #     module: 2e-3, pressure_angle: 20f64.to_radians(), helix: 0.0, double_helical: false,
    /// #     width: 0.02, centre_distance: None, wheels: [wheel(10.0), wheel(40.0)],
    /// # };
    /// let pair = Pair::new(&data).unwrap();
    /// let Remark::Undercut { wheel: 0, least, .. } = pair.remarks()[0] else { panic!() };
    /// assert_eq!(format!("{least:.3}"), "0.415");
    /// ```
    pub fn remarks(&self) -> Vec<Remark> {
        self.remarks.clone()
    }

    /// Whether one of the wheels is a ring.
    pub fn internal(&self) -> bool {
        self.data.wheels.iter().any(|w| w.internal)
    }

    /// Width that carries, m: both helices of a double helical pair.
    pub fn total_width(&self) -> R {
        self.data.width * if self.data.double_helical { 2.0 } else { 1.0 }
    }

    /// Cosine of the helix angle at the base circle.
    pub(crate) fn cos_base_helix(&self) -> R {
        self.cos_base_helix
    }

    /// `K = π (1/z_1 ± 1/z_2)/cos β_b`, −, with − for a ring: mean sliding over rolling is this
    /// times a number of the path of contact.
    ///
    /// # Source
    /// `[ohlendorf1958]`; derived.
    ///
    /// # Example
    /// 16/24 spur: by hand π (1/16 + 1/24) = 0.32725. The pair is that of [`Pair`].
    /// ```
    /// # use willis::geometry::{Pair, PairData, Tip, Wheel};
    /// # let tip = Tip::Addendum { coefficient: 1.0, alteration: 0.0 };
    /// # let wheel = |teeth, shift| Wheel { teeth, internal: false, shift, tip, dedendum: 1.25 };
    /// # let pair = Pair::new(&PairData {
    /// #     module: 4.5e-3, pressure_angle: 20f64.to_radians(), helix: 0.0, double_helical: false,
    /// #     width: 14e-3, centre_distance: None, wheels: [wheel(16.0, 0.1817), wheel(24.0, 0.1715)],
    /// # }).unwrap();
    /// assert_eq!(format!("{:.5}", pair.factor()), "0.32725");
    /// ```
    pub fn factor(&self) -> R {
        let [first, second] = [0, 1].map(|k| 1.0 / self.data.wheels[k].teeth);
        let relative = if self.internal() { (first - second).abs() } else { first + second };
        R::from(PI * relative) / self.base_helix.cos()
    }

    /// The path of contact, m from C along the line of action: from the tip of wheel 1,
    /// `−e_2 p_bt` (A), to the tip of wheel 0, `+e_1 p_bt` (E).
    ///
    /// # Example
    /// The pair of [`Pair`]: A is 9.676 mm before C, E 9.752 mm behind.
    /// ```
    /// # use willis::geometry::{Pair, PairData, Tip, Wheel};
    /// # let tip = Tip::Addendum { coefficient: 1.0, alteration: 0.0 };
    /// # let wheel = |teeth, shift| Wheel { teeth, internal: false, shift, tip, dedendum: 1.25 };
    /// # let pair = Pair::new(&PairData {
    /// #     module: 4.5e-3, pressure_angle: 20f64.to_radians(), helix: 0.0, double_helical: false,
    /// #     width: 14e-3, centre_distance: None, wheels: [wheel(16.0, 0.1817), wheel(24.0, 0.1715)],
    /// # }).unwrap();
    /// let [a, e] = pair.path();
    /// assert_eq!(format!("{:.3} {:.3}", a * 1e3, e * 1e3), "-9.676 9.752");
    /// ```
    pub fn path(&self) -> [R; 2] {
        let [e_0, e_1] = self.addendum_contact_ratios;
        [-e_1 * self.base_pitch, e_0 * self.base_pitch]
    }

    /// Place on the path counted from A in base pitches, `x = (s − s_A)/p_bt`, −, as the laws of
    /// load sharing want it.
    pub fn position(&self, s: R) -> R {
        s / self.base_pitch + self.addendum_contact_ratios[1]
    }

    /// Radii of curvature of both flanks in the transverse section, m, at the distance s from C,
    /// m: `r_b tan α_wt ± s`. They are ≥ 0 on the path of contact.
    ///
    /// # Source
    /// `[iso21771]`, radius of curvature of the involute.
    pub fn curvature_radii(&self, s: R) -> [R; 2] {
        let [own, other] = self.curvature_at_pitch;
        let first = if self.data.wheels[0].internal { -s } else { s };
        // on a ring both centres of curvature lie on one side
        let second = if self.internal() { first } else { -s };
        // with the ring first, s > 0 is the addendum of the ring, the dedendum of the pinion
        [own + first, other + second]
    }

    /// Reduced radius of curvature in the transverse section, m, at the distance s from C, m:
    /// `ρ_1 ρ_2/(ρ_1 + ρ_2)`, for a ring `ρ_1 ρ_2/|ρ_1 − ρ_2|`.
    pub fn reduced_radius_transverse(&self, s: R) -> R {
        let [first, second] = self.curvature_radii(s);
        let sum = if self.internal() { real::abs(first - second) } else { first + second };
        first * second / sum
    }

    /// Reduced radius of curvature in the normal section, m: the transverse one over `cos β_b`.
    ///
    /// # Example
    /// The herringbone pair 35/31 of module 7 mm and helix 22°: 22.676 mm transverse,
    /// 24.227 mm normal at C.
    /// ```
    /// use willis::geometry::{Pair, PairData, Tip, Wheel};
    ///
    /// let tip = Tip::Addendum { coefficient: 1.0, alteration: 0.0 };
    /// let wheel = |teeth| Wheel { teeth, internal: false, shift: 0.0, tip, dedendum: 1.25 };
    /// let pair = Pair::new(&PairData {
    ///     module: 7e-3,
    ///     pressure_angle: 20f64.to_radians(),
    ///     helix: 22f64.to_radians(),
    ///     double_helical: true,
    ///     width: 80e-3,
    ///     centre_distance: None,
    ///     wheels: [wheel(35.0), wheel(31.0)],
    /// })
    /// .unwrap();
    /// assert_eq!(format!("{:.3}", pair.reduced_radius_transverse(0.0) * 1e3), "22.676");
    /// assert_eq!(format!("{:.3}", pair.reduced_radius(0.0) * 1e3), "24.227");
    /// assert_eq!(pair.total_width(), 0.16);
    /// ```
    pub fn reduced_radius(&self, s: R) -> R {
        self.reduced_radius_transverse(s) / self.cos_base_helix
    }

    /// Sliding speed over the speed of wheel 0 relative to the carrier, m: `|v_g|/|ω_1| =
    /// |s| (1 ± z_1/z_2)`, − for a ring. Zero at C.
    pub fn sliding_per_speed(&self, s: R) -> R {
        let ratio = self.data.wheels[0].teeth / self.data.wheels[1].teeth;
        real::abs(s) * if self.internal() { (1.0 - ratio).abs() } else { 1.0 + ratio }
    }

    /// Sum of the surface speeds of both flanks over the speed of wheel 0 relative to the carrier,
    /// m: `(u_1 + u_2)/|ω_1| = ρ_1 + ρ_2 z_1/z_2`, transverse section. At C it is
    /// `2 r_w1 sin α_wt`.
    pub fn sum_speed_per_speed(&self, s: R) -> R {
        let [first, second] = self.curvature_radii(s);
        first + second * self.data.wheels[0].teeth / self.data.wheels[1].teeth
    }

    /// The points A, B, C, D, E of the path, m from C: ends A and E, start B and end D of single
    /// contact when `1 ≤ ε_α ≤ 2`, `B = E − p_bt`, `D = A + p_bt`. In this order by name: for other
    /// contact ratios, and where an addendum contact ratio is above 1 or negative, not by place.
    pub fn breakpoints(&self) -> [R; 5] {
        let [a, e] = self.path();
        [a, e - self.base_pitch, R::from(0.0), a + self.base_pitch, e]
    }

    /// Shortest total length of contact lines over the face width, −; the same for both helices
    /// together.
    ///
    /// # Formula
    /// ```text
    /// l_min/b = (ε_α ε_β − n_α n_β)/(ε_β cos β_b)              for n_α + n_β ≤ 1
    /// l_min/b = (ε_α ε_β − (1 − n_α)(1 − n_β))/(ε_β cos β_b)   for n_α + n_β > 1
    /// l_min/b = ⌊ε_α⌋                                          for ε_β = 0
    /// ```
    /// with the fractions n_α, n_β of both ratios.
    ///
    /// # Source
    /// `[agma908]`, minimum length of the lines of contact; derived here again for every overlap
    /// ratio.
    ///
    /// # Example
    /// ε_α = 1.4715, ε_β = 0.5414, β_b = 14.076°: by hand
    /// (1.4715 · 0.5414 − 0.5285 · 0.4586)/(0.5414 · 0.96997) = 1.0555.
    /// ```
    /// use willis::geometry::{Pair, PairData, Tip, Wheel};
    ///
    /// let tip = Tip::Addendum { coefficient: 1.0, alteration: 0.0 };
    /// let wheel = |teeth, shift| Wheel { teeth, internal: false, shift, tip, dedendum: 1.25 };
    /// let pair = Pair::new(&PairData {
    ///     module: 3.5e-3,
    ///     pressure_angle: 20f64.to_radians(),
    ///     helix: 15f64.to_radians(),
    ///     double_helical: false,
    ///     width: 23e-3,
    ///     centre_distance: None,
    ///     wheels: [wheel(20.0, 0.1809), wheel(30.0, 0.0891)],
    /// })
    /// .unwrap();
    /// assert_eq!(format!("{:.4}", pair.shortest_contact_length_ratio()), "1.0555");
    /// ```
    pub fn shortest_contact_length_ratio(&self) -> R {
        let (alpha, beta) = (self.contact_ratio, self.overlap_ratio);
        let [floor_a, floor_b] = [alpha, beta].map(|ratio| ratio.re().floor());
        let (n_alpha, n_beta) = (alpha - floor_a, beta - floor_b);
        // ε_α ε_β less the products, written without the difference that ε_β → 0 would magnify
        let shared = real::max(n_alpha + n_beta - 1.0, R::from(0.0));
        let least = if beta.re() == 0.0 { R::from(floor_a) } else { (n_alpha * floor_b + shared) / beta + floor_a };
        least / self.cos_base_helix
    }
}

/// Faults of single quantities.
fn scalar_faults<R: Real>(data: &PairData<R>) -> Vec<Fault> {
    let mut faults = Vec::new();
    let mut check = |quantity: Quantity, wheel, value: &R| faults.extend(quantity.check(wheel, value.re()));
    check(Quantity::Module, None, &data.module);
    check(Quantity::PressureAngle, None, &data.pressure_angle);
    check(Quantity::Helix, None, &data.helix);
    check(Quantity::Width, None, &data.width);
    if let Some(a) = data.centre_distance {
        check(Quantity::CentreDistance, None, &a);
    }
    for (k, w) in data.wheels.iter().enumerate() {
        check(Quantity::Teeth, Some(k), &R::from(w.teeth));
        check(Quantity::Shift, Some(k), &w.shift);
        check(Quantity::Dedendum, Some(k), &w.dedendum);
        match w.tip {
            Tip::Addendum { coefficient, alteration } => {
                check(Quantity::Addendum, Some(k), &coefficient);
                check(Quantity::TipAlteration, Some(k), &alteration);
            }
            Tip::Radius(radius) => check(Quantity::TipRadius, Some(k), &radius),
        }
    }
    match &data.wheels {
        [a, b] if a.internal && b.internal => faults.push(Fault::BothInternal),
        [pinion, ring] | [ring, pinion] if ring.internal && !pinion.internal && ring.teeth <= pinion.teeth => {
            faults.push(Fault::RingNotLarger { pinion: pinion.teeth, ring: ring.teeth });
        }
        _ => {}
    }
    faults
}

/// Height of the straight flank of the rack below its reference line, over the module.
fn form_height<R: Real>(data: &PairData<R>, dedendum: f64) -> f64 {
    dedendum - RACK_TIP_RADIUS * (1.0 - data.pressure_angle.re().sin())
}

/// Radii of one wheel; its faults and remarks are added.
fn gear<R: Real>(
    data: &PairData<R>,
    basis: &Basis<R>,
    alpha_wt: R,
    k: usize,
    faults: &mut Vec<Fault>,
    remarks: &mut Vec<Remark>,
) -> GearGeometry<R> {
    let wheel = &data.wheels[k];
    let m_n = data.module;
    let alpha_t = basis.transverse_angle;
    let side = if wheel.internal { -1.0 } else { 1.0 };
    let reference = basis.module * wheel.teeth / 2.0;
    let base = reference * alpha_t.cos();
    let tip = match wheel.tip {
        Tip::Addendum { coefficient, alteration } => {
            reference + wheel.shift * m_n + (coefficient * m_n + alteration) * side
        }
        Tip::Radius(radius) => radius,
    };
    let root = reference + wheel.shift * m_n - wheel.dedendum * side * m_n;

    if root.re() <= 0.0 {
        faults.push(Fault::NoRoot { wheel: k, root: root.re() });
    }
    if tip.re() <= 0.0 || side * (tip - root).re() <= 0.0 {
        faults.push(Fault::NoHeight { wheel: k, tip: tip.re(), root: root.re() });
    }
    let inside_base = tip.re() <= base.re();
    match (inside_base, wheel.internal) {
        (true, false) => faults.push(Fault::TipInsideBase { wheel: k, tip: tip.re(), base: base.re() }),
        (true, true) => remarks.push(Remark::RingTipInsideBase { wheel: k, tip: tip.re(), base: base.re() }),
        _ => {}
    }
    // Angle of an external tooth, and of the space of a ring, at the tip circle.
    let at_tip = if inside_base { R::from(0.0) } else { involute((base / tip).acos()) };
    let half = (wheel.shift * 2.0 * data.pressure_angle.tan() + FRAC_PI_2) / wheel.teeth + involute(alpha_t) - at_tip;
    let angle = half * 2.0;
    let thickness = tip * if wheel.internal { -angle + TAU / wheel.teeth } else { angle };
    let tip_thickness = thickness * (data.helix.tan() * tip / reference).atan().cos();
    if thickness.re() <= 0.0 && (wheel.internal || !inside_base) {
        faults.push(Fault::Pointed { wheel: k, thickness: thickness.re() });
    } else if tip_thickness.re() < 0.2 * m_n.re() {
        remarks.push(Remark::ThinTip { wheel: k, thickness: tip_thickness.re(), module: m_n.re() });
    }
    if !wheel.internal {
        let sin_t = alpha_t.re().sin();
        let least = form_height(data, wheel.dedendum.re()) - reference.re() * sin_t * sin_t / m_n.re();
        if wheel.shift.re() < least - UNDERCUT_IGNORED {
            remarks.push(Remark::Undercut { wheel: k, shift: wheel.shift.re(), least });
        }
    }
    GearGeometry {
        reference_radius: reference,
        base_radius: base,
        operating_radius: base / alpha_wt.cos(),
        tip_radius: tip,
        root_radius: root,
        tip_thickness,
    }
}

/// Angle of the ring by which the tips of pinion and ring overlap where the tip circles cross;
/// none when they pass each other. `ratio` is pinion over ring teeth.
///
/// While the pinion's tip turns from the flank contact to the crossing by θ_1, the ring's tip turns
/// by θ_1 z_1/z_2 and must have left the place of the crossing, θ_2.
fn tip_overlap<R: Real>(
    pinion: &GearGeometry<R>,
    ring: &GearGeometry<R>,
    ratio: f64,
    a: f64,
    alpha_wt: f64,
) -> Option<f64> {
    let (r1, r2) = (pinion.tip_radius.re(), ring.tip_radius.re());
    let involute_at = |g: &GearGeometry<R>| {
        let cosine = g.base_radius.re() / g.tip_radius.re();
        if cosine < 1.0 { involute(cosine.acos()) } else { 0.0 }
    };
    let at_pinion = (r2 * r2 - r1 * r1 - a * a) / (2.0 * a * r1);
    let at_ring = (a * a + r2 * r2 - r1 * r1) / (2.0 * a * r2);
    if !(at_pinion.abs() <= 1.0 && at_ring.abs() <= 1.0) {
        return None;
    }
    let theta_1 = at_pinion.acos() + involute_at(pinion) - involute(alpha_wt);
    let overlap = at_ring.acos() - (theta_1 * ratio + involute(alpha_wt) - involute_at(ring));
    (overlap > 0.0).then_some(overlap)
}
