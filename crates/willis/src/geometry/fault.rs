use std::fmt;

use crate::diagnostic::{Code, Diagnostic, Diagnostics, through_diagnostic};

/// Why there is no such pair of gears. The numbers are SI; the text shows mm and degrees.
///
/// Wheels are counted from zero here and from one in the text.
///
/// # Example
/// ```
/// use willis::geometry::Fault;
///
/// let fault = Fault::TipInsideBase { wheel: 0, tip: 71.2e-3, base: 73.1e-3 };
/// assert_eq!(
///     fault.to_string(),
///     "wheel 1: the tip circle, radius 71.2 mm, lies inside the base circle, radius 73.1 mm: \
///      there is no involute flank; enlarge the addendum or the profile shift"
/// );
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Fault {
    /// A quantity is not a number, or outside what can be a gear.
    OutOfRange {
        /// Its name.
        quantity: Quantity,
        /// The wheel it belongs to; none for the pair.
        wheel: Option<usize>,
        /// Its value, SI.
        value: f64,
    },
    /// Both wheels are ring gears.
    BothInternal,
    /// The ring has no more teeth than its pinion.
    RingNotLarger {
        /// Teeth of the pinion.
        pinion: f64,
        /// Teeth of the ring.
        ring: f64,
    },
    /// The centre distance is smaller than the base circles allow.
    CentreDistanceTooSmall {
        /// Given, m.
        centre_distance: f64,
        /// Sum or difference of the base radii, m.
        least: f64,
    },
    /// The shifts draw the wheels so close that no operating angle remains.
    NoOperatingAngle {
        /// Sum of the shifts; with a ring, ring less pinion.
        shifts: f64,
        /// Its lowest value.
        least: f64,
    },
    /// The root circle has no positive radius.
    NoRoot {
        /// The wheel.
        wheel: usize,
        /// Root radius, m.
        root: f64,
    },
    /// The tip circle of an external wheel lies inside its base circle.
    TipInsideBase {
        /// The wheel.
        wheel: usize,
        /// Tip radius, m.
        tip: f64,
        /// Base radius, m.
        base: f64,
    },
    /// Tip and root circle are the wrong way round: the tooth has no height.
    NoHeight {
        /// The wheel.
        wheel: usize,
        /// Tip radius, m.
        tip: f64,
        /// Root radius, m.
        root: f64,
    },
    /// The flanks meet before the tip circle.
    Pointed {
        /// The wheel.
        wheel: usize,
        /// Transverse tooth thickness at the tip circle, m, negative.
        thickness: f64,
    },
    /// The path of contact is empty: the tip circles do not reach each other on the line of action.
    NoContact {
        /// What the tip circles would give.
        contact_ratio: f64,
    },
    /// A tooth pair leaves before the next one enters: `ε_α + ε_β < 1`.
    Gap {
        /// Transverse contact ratio.
        contact_ratio: f64,
        /// Overlap ratio.
        overlap_ratio: f64,
    },
}

/// A quantity of a pair that has a range of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Normal module, above 0 to 10 m.
    Module,
    /// Normal pressure angle, 5° to 45°.
    PressureAngle,
    /// Helix angle at the reference circle, 0° to 60°.
    Helix,
    /// Face width, above 0 to 100 m.
    Width,
    /// Centre distance, above 0 to 1 000 000 m.
    CentreDistance,
    /// Tooth count, 1 to 100 000.
    Teeth,
    /// Profile shift coefficient, −1000 to 1000.
    Shift,
    /// Addendum coefficient, −1000 to 1000.
    Addendum,
    /// Tip alteration, −1000 to 1000 m.
    TipAlteration,
    /// Tip radius, above 0 to 1 000 000 m.
    TipRadius,
    /// Dedendum coefficient, −1000 to 1000.
    Dedendum,
}

impl Quantity {
    /// Name, unit of the text, factor from SI to it, lowest and highest value in SI.
    fn about(self) -> (&'static str, &'static str, f64, f64, f64) {
        let degrees = f64::to_degrees(1.0);
        let tiny = 1e-9;
        match self {
            Self::Module => ("module", " mm", 1e3, tiny, 10.0),
            Self::PressureAngle => ("pressure angle", "°", degrees, 5f64.to_radians(), 45f64.to_radians()),
            Self::Helix => ("helix angle", "°", degrees, 0.0, 60f64.to_radians()),
            Self::Width => ("face width", " mm", 1e3, tiny, 100.0),
            Self::CentreDistance => ("centre distance", " mm", 1e3, tiny, 1e6),
            Self::Teeth => ("tooth count", "", 1.0, 1.0, 1e5),
            Self::Shift => ("profile shift", "", 1.0, -1e3, 1e3),
            Self::Addendum => ("addendum coefficient", "", 1.0, -1e3, 1e3),
            Self::TipAlteration => ("tip alteration", " mm", 1e3, -1e3, 1e3),
            Self::TipRadius => ("tip radius", " mm", 1e3, tiny, 1e6),
            Self::Dedendum => ("dedendum coefficient", "", 1.0, -1e3, 1e3),
        }
    }

    /// The fault of a value outside the range.
    pub(super) fn check(self, wheel: Option<usize>, value: f64) -> Option<Fault> {
        let (.., min, max) = self.about();
        (!(min..=max).contains(&value)).then_some(Fault::OutOfRange { quantity: self, wheel, value })
    }
}

/// What is unusual about a pair that exists. The numbers are SI; the text shows mm and degrees.
///
/// # Example
/// ```
/// use willis::geometry::Remark;
///
/// let remark = Remark::ThinTip { wheel: 1, thickness: 0.5e-3, module: 4e-3 };
/// assert_eq!(
///     remark.to_string(),
///     "wheel 2: the tooth tip is 0.5 mm thick, less than 0.2 modules (0.8 mm): shorten the tip or lower the shift"
/// );
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Remark {
    /// A rack of the dedendum given, with a tip radius of 0.38 modules, cuts into the flank.
    Undercut {
        /// The wheel.
        wheel: usize,
        /// Its shift.
        shift: f64,
        /// Lowest shift without undercut.
        least: f64,
    },
    /// The tip circle of the ring lies inside its base circle: there is no involute at the tip.
    RingTipInsideBase {
        /// The ring.
        wheel: usize,
        /// Tip radius, m.
        tip: f64,
        /// Base radius, m.
        base: f64,
    },
    /// The tip reaches beyond the involute of the mating flank; the path of contact ends there.
    PathShortened {
        /// The wheel with the long tip.
        wheel: usize,
        /// Addendum contact ratio of the tip circle; infinite where the tip circle has none.
        tip: f64,
        /// Addendum contact ratio in force.
        used: f64,
    },
    /// The tip touches the mating flank below the form circle of a rack with a tip radius of 0.38
    /// modules. The path of contact is not shortened for it.
    BelowForm {
        /// The wheel with the long tip.
        wheel: usize,
        /// Radius of curvature of the mating flank at the end of the path, m.
        contact: f64,
        /// Radius of curvature at its form circle, m.
        form: f64,
    },
    /// Thin tooth tip, below 0.2 modules in the normal section.
    ThinTip {
        /// The wheel.
        wheel: usize,
        /// Normal tooth thickness at the tip circle, m.
        thickness: f64,
        /// Normal module, m.
        module: f64,
    },
    /// Transverse contact ratio below 1.2, and no full overlap.
    LowContactRatio {
        /// Transverse contact ratio.
        contact_ratio: f64,
        /// Overlap ratio.
        overlap_ratio: f64,
    },
    /// The tips of pinion and ring collide outside the path of contact.
    TipInterference {
        /// Angle of the ring by which they overlap, rad.
        overlap: f64,
    },
    /// The tip touches the root circle of the mating wheel.
    NoClearance {
        /// The wheel of the tip.
        wheel: usize,
        /// Radial clearance, m, negative or zero.
        clearance: f64,
    },
    /// The teeth are too thick for the centre distance.
    NegativeBacklash {
        /// Transverse circumferential backlash at the operating circles, m, negative.
        backlash: f64,
    },
}

/// At most six digits, without trailing zeros.
fn short(x: f64) -> String {
    if !x.is_finite() || x == 0.0 {
        return format!("{x}");
    }
    let digits = (5 - x.abs().log10().floor() as i64).clamp(0, 12) as usize;
    let text = format!("{x:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

fn mm(x: f64) -> String {
    format!("{} mm", short(x * 1e3))
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OutOfRange { quantity, wheel, value } => {
                let (name, unit, factor, min, max) = quantity.about();
                if let Some(wheel) = wheel {
                    write!(f, "wheel {}: ", wheel + 1)?;
                }
                let [value, min, max] = [value, &min, &max].map(|v| short(v * factor));
                write!(f, "{name} {value}{unit}: give a number from {min} to {max}{unit}")
            }
            Self::BothInternal => {
                write!(f, "both wheels are ring gears: two internal toothings cannot mesh; make one of them external")
            }
            Self::RingNotLarger { pinion, ring } => {
                write!(
                    f,
                    "the ring has {} teeth and the pinion inside it {}: the ring needs more teeth than its pinion",
                    short(*ring),
                    short(*pinion)
                )
            }
            Self::CentreDistanceTooSmall { centre_distance, least } => write!(
                f,
                "centre distance {}: the base circles need at least {}; enlarge the centre distance, or lower module or teeth",
                mm(*centre_distance),
                mm(*least)
            ),
            Self::NoOperatingAngle { shifts, least } => write!(
                f,
                "the profile shifts add up to {} (with a ring: ring less pinion), below {}: there is no operating pressure angle; raise the shifts or give a centre distance",
                short(*shifts),
                short(*least)
            ),
            Self::NoRoot { wheel, root } => write!(
                f,
                "wheel {}: the root circle has radius {}: raise teeth or profile shift, or lower the dedendum",
                wheel + 1,
                mm(*root)
            ),
            Self::TipInsideBase { wheel, tip, base } => write!(
                f,
                "wheel {}: the tip circle, radius {}, lies inside the base circle, radius {}: there is no involute flank; enlarge the addendum or the profile shift",
                wheel + 1,
                mm(*tip),
                mm(*base)
            ),
            Self::NoHeight { wheel, tip, root } => write!(
                f,
                "wheel {}: the tooth has no height between tip radius {} and root radius {}: check addendum, dedendum and tip alteration",
                wheel + 1,
                mm(*tip),
                mm(*root)
            ),
            Self::Pointed { wheel, thickness } => write!(
                f,
                "wheel {}: the tooth is pointed, its thickness at the tip circle would be {}: shorten the tip or lower the profile shift",
                wheel + 1,
                mm(*thickness)
            ),
            Self::NoContact { contact_ratio } => write!(
                f,
                "the teeth do not reach each other, the contact ratio would be {}: enlarge the addenda or bring the wheels closer",
                short(*contact_ratio)
            ),
            Self::Gap { contact_ratio, overlap_ratio } => write!(
                f,
                "contact ratio {} and overlap ratio {} add up to less than 1: a tooth pair leaves before the next one enters; enlarge the addenda or the overlap",
                short(*contact_ratio),
                short(*overlap_ratio)
            ),
        }
    }
}

impl std::error::Error for Fault {}

impl From<Fault> for Diagnostic {
    fn from(fault: Fault) -> Self {
        Self::new(Code::ImpossibleGeometry, "", fault.to_string())
    }
}

through_diagnostic!(Fault);

impl From<Vec<Fault>> for Diagnostics {
    fn from(faults: Vec<Fault>) -> Self {
        faults.into_iter().map(Diagnostic::from).collect()
    }
}

impl Remark {
    /// The wheel that it is about; none where it is about the pair.
    pub fn wheel(&self) -> Option<usize> {
        match self {
            Self::Undercut { wheel, .. }
            | Self::RingTipInsideBase { wheel, .. }
            | Self::PathShortened { wheel, .. }
            | Self::BelowForm { wheel, .. }
            | Self::ThinTip { wheel, .. }
            | Self::NoClearance { wheel, .. } => Some(*wheel),
            Self::LowContactRatio { .. } | Self::TipInterference { .. } | Self::NegativeBacklash { .. } => None,
        }
    }

    /// What is unusual, without the wheel's number: for readers who know it by a name.
    pub fn matter(&self) -> String {
        match self {
            Self::Undercut { shift, least, .. } => format!(
                "profile shift {} is below {}: a rack with a tip radius of 0.38 modules undercuts the flank; raise the shift or the tooth count",
                short(*shift),
                short(*least)
            ),
            Self::RingTipInsideBase { tip, base, .. } => format!(
                "the tip circle of the ring, radius {}, lies inside its base circle, radius {}: there is no involute at the tip; enlarge the tip circle",
                mm(*tip),
                mm(*base)
            ),
            Self::PathShortened { tip, used, .. } => {
                let limit = match tip.is_finite() {
                    true => format!("of its addendum contact ratio {} only {} is counted", short(*tip), short(*used)),
                    false => format!("its addendum contact ratio is limited to {}", short(*used)),
                };
                format!("its tip passes the end of the mating involute; {limit}: shorten the tip")
            }
            Self::BelowForm { contact, form, .. } => format!(
                "its tip touches the mating flank at a radius of curvature of {}, below the form circle ({}) of a rack with a tip radius of 0.38 modules: shorten the tip, or check the tool",
                // Nothing is curved less than not at all.
                mm(contact.max(0.0)),
                mm(*form)
            ),
            Self::ThinTip { thickness, module, .. } => format!(
                "the tooth tip is {} thick, less than 0.2 modules ({}): shorten the tip or lower the shift",
                mm(*thickness),
                mm(0.2 * module)
            ),
            Self::LowContactRatio { contact_ratio, overlap_ratio } => format!(
                "transverse contact ratio {} is below 1.2 and overlap ratio {} below 1: enlarge the addenda",
                short(*contact_ratio),
                short(*overlap_ratio)
            ),
            Self::TipInterference { overlap } => format!(
                "the tips of pinion and ring overlap by {}° of the ring outside the path of contact: enlarge the difference of teeth or shorten the tips",
                short(overlap.to_degrees())
            ),
            Self::NoClearance { clearance, .. } => format!(
                "its tip circle has a clearance of {} to the root of the mating wheel: shorten the tip or enlarge the mating dedendum",
                mm(*clearance)
            ),
            Self::NegativeBacklash { backlash } => format!(
                "the teeth are too thick for the centre distance by {} at the operating circles: lower the profile shifts or enlarge the centre distance",
                mm(-backlash)
            ),
        }
    }
}

impl fmt::Display for Remark {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(wheel) = self.wheel() {
            write!(f, "wheel {}: ", wheel + 1)?;
        }
        f.write_str(&self.matter())
    }
}
