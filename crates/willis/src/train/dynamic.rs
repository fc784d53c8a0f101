//! The dynamic layer of a train: inertias, drags, shafts, friction of shift elements, loss tables,
//! and the scenarios in which it moves.

use super::formula::Formula;
use super::{MemberId, MeshId, ShiftElementId};

/// A moment of inertia.
///
/// Its kinetic energy is `½ J (ω − ω_reference)²`: cylindrical planets and central rotors are
/// measured against the frame, the spin of bevel planets against their carrier.
#[derive(Clone, Debug, PartialEq)]
pub struct Inertia {
    /// The rotor; of planets, all of them together.
    pub member: MemberId,
    /// What its speed is measured against.
    pub reference: MemberId,
    /// J, kg m².
    pub value: f64,
}

/// A line through points; straight between them and level beyond the last.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve(Vec<[f64; 2]>);

impl Curve {
    /// Through points of rising abscissa; `None` if there are none, if they do not rise, or if one
    /// is not finite.
    pub fn new(points: Vec<[f64; 2]>) -> Option<Self> {
        let rising = points.windows(2).all(|w| w[0][0] < w[1][0]);
        let finite = points.iter().flatten().all(|x| x.is_finite());
        (rising && finite && !points.is_empty()).then_some(Self(points))
    }

    /// The same value everywhere.
    pub fn constant(value: f64) -> Self {
        Self(vec![[0.0, value]])
    }

    /// The points.
    pub fn points(&self) -> &[[f64; 2]] {
        &self.0
    }

    /// Value at an abscissa.
    #[inline]
    pub fn at(&self, x: f64) -> f64 {
        if x.is_nan() {
            return x;
        }
        let p = &self.0;
        if p.len() == 1 || x <= p[0][0] {
            return p[0][1];
        }
        let last = p[p.len() - 1];
        if x >= last[0] {
            return last[1];
        }
        let k = p.partition_point(|q| q[0] <= x);
        let ([x0, y0], [x1, y1]) = (p[k - 1], p[k]);
        y0 + (y1 - y0) * (x - x0) / (x1 - x0)
    }

    /// Slope right of an abscissa.
    pub fn slope(&self, x: f64) -> f64 {
        let p = &self.0;
        let k = p.partition_point(|q| q[0] <= x);
        if k == 0 || k == p.len() { 0.0 } else { (p[k][1] - p[k - 1][1]) / (p[k][0] - p[k - 1][0]) }
    }
}

/// Friction between two members that does not depend on tooth loads: bearings, seals, dampers.
///
/// Against the relative speed `w` of the first member it exerts `c(|w|) + d |w|`; at rest it holds
/// up to `peak · c(0)`.
#[derive(Clone, Debug, PartialEq)]
pub struct DragMount {
    /// What it is called.
    pub name: String,
    /// The two members.
    pub members: [MemberId; 2],
    /// Torque c over the amount of relative speed, rad/s to N m, of all places together.
    pub torque: Curve,
    /// Viscous coefficient d, N m s/rad, of all places together.
    pub viscous: f64,
    /// Identical places: the number of planets, else one.
    pub places: u32,
    /// Torque at which it breaks away, over that at which it slides; at least 1.
    pub peak: f64,
}

/// What a shaft does between its backlash.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Contact {
    /// Damping never exceeds the spring and never pulls: the torque begins at zero.
    #[default]
    Soft,
    /// Spring and damper act from the first touch: the torque may jump.
    Hard,
}

/// An elastic shaft between two members: `k` times its twist and `d` times the rate of twist, which
/// is the first member's angle less the second's.
#[derive(Clone, Debug, PartialEq)]
pub struct Shaft {
    /// What it is called.
    pub name: String,
    /// The two members.
    pub members: [MemberId; 2],
    /// k, N m/rad.
    pub stiffness: f64,
    /// d, N m s/rad.
    pub damping: f64,
    /// Whole backlash, rad.
    pub backlash: f64,
    /// What happens at its ends.
    pub contact: Contact,
}

/// What a clutch, brake or one-way clutch can hold.
#[derive(Clone, Debug, PartialEq)]
pub struct Friction {
    /// Torque over the amount of slip when fully engaged, rad/s to N m.
    pub torque: Curve,
    /// Torque at which it breaks away, over that at which it slides; at least 1.
    pub peak: f64,
}

/// A row of a loss table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LossRow {
    /// Amount of the speed of the first gear relative to the carrier, rad/s.
    pub speed: f64,
    /// Efficiency when the first gear drives.
    pub forward: f64,
    /// Efficiency when the second gear drives.
    pub backward: f64,
    /// Bearing torque at the first gear when it drives, N m.
    pub forward_torque: f64,
    /// Bearing torque at the first gear when the second drives, N m.
    pub backward_torque: f64,
}

/// Efficiency and bearing torque of a mesh over its speed: straight between rows, and beyond the
/// last continued from the last two (Modelica's `lossTable`).
#[derive(Clone, Debug, PartialEq)]
pub struct LossTable {
    /// The mesh.
    pub mesh: MeshId,
    /// Rows of rising speed, at least one.
    pub rows: Vec<LossRow>,
}

/// A value over time, SI.
#[derive(Clone, Debug, PartialEq)]
pub enum Signal {
    /// Always the same.
    Constant(f64),
    /// `offset`, and `height` more from `at` on.
    Step {
        /// Before.
        offset: f64,
        /// The jump.
        height: f64,
        /// When, s.
        at: f64,
    },
    /// From `offset` at `at` in a straight line to `offset + height` after `duration`.
    Ramp {
        /// Before.
        offset: f64,
        /// The rise.
        height: f64,
        /// When it begins, s.
        at: f64,
        /// How long it takes, s.
        duration: f64,
    },
    /// `offset + amplitude e^{−decay (t − at)} sin(2π frequency (t − at) + phase)`; the offset alone before `at`.
    Sine {
        /// Mean.
        offset: f64,
        /// Amplitude.
        amplitude: f64,
        /// Hz.
        frequency: f64,
        /// rad
        phase: f64,
        /// When it begins, s.
        at: f64,
        /// 1/s
        decay: f64,
    },
    /// `offset`, and `amplitude` more during the first `width` of every period, from `at` on.
    Pulse {
        /// Between pulses.
        offset: f64,
        /// Height of a pulse.
        amplitude: f64,
        /// s
        period: f64,
        /// Part of the period, 0 to 1.
        width: f64,
        /// When the first one begins, s.
        at: f64,
    },
    /// Through points in time, s; level before the first and after the last. Two points of the same
    /// time are a jump. `hold`: level from each point to the next.
    Table {
        /// Time and value.
        points: Vec<[f64; 2]>,
        /// Steps instead of lines.
        hold: bool,
    },
    /// The product of two signals.
    Product(Box<[Signal; 2]>),
    /// A formula of the time `t` and of speeds `w_member`, rad/s.
    Expression {
        /// The formula.
        formula: Formula,
        /// The members whose speeds stand in it, in its order.
        speeds: Vec<MemberId>,
    },
}

/// What acts on members from outside in a scenario; `S` is what a value over time is told by, `C` a
/// curve.
#[derive(Clone, Debug, PartialEq)]
pub enum SourceKind<S = Signal, C = Curve> {
    /// An external torque, N m, over time.
    Torque(S),
    /// A prescribed speed, rad/s, over time; its torque is a result.
    Speed(S),
    /// A speed controller, `T = T_ff + k_p e + k_i ∫e dt + k_d de/dt` with `e = w_set − w` (Galvagno 2010,
    /// section 6.2).
    Controller {
        /// The speed wanted, rad/s.
        setpoint: S,
        /// T_ff, N m.
        feed_forward: S,
        /// k_p, N m s/rad.
        proportional: f64,
        /// k_i, N m/rad.
        integral: f64,
        /// k_d, N m s²/rad; acts as an added inertia.
        derivative: f64,
    },
    /// `T = T_0 − d (w − w_0)`.
    Linear {
        /// T_0, N m.
        torque: f64,
        /// w_0, rad/s.
        about: f64,
        /// d, N m s/rad.
        slope: f64,
    },
    /// `T = T_0 − k (w − w_0)² sgn(w − w_0)`; or without the sign if `even`.
    Quadratic {
        /// T_0, N m.
        torque: f64,
        /// w_0, rad/s.
        about: f64,
        /// k, N m s²/rad².
        factor: f64,
        /// Leave the sign out: the torque does not follow the direction of rotation.
        even: bool,
    },
    /// A vehicle on its wheels: `v = r w/i`; mass, rolling resistance, air and slope.
    Vehicle {
        /// kg
        mass: f64,
        /// Wheel radius, m.
        wheel_radius: f64,
        /// Turns of the member to one turn of the wheel.
        final_drive: f64,
        /// Rolling resistance coefficient; holds the vehicle at rest.
        rolling: f64,
        /// Drag coefficient times frontal area, m².
        drag_area: f64,
        /// kg/m³
        air_density: f64,
        /// Rise over run.
        grade: S,
    },
    /// A motor: between the torque it drags with and its full-load torque, by a throttle from 0 to 1.
    Motor {
        /// Full-load torque over speed, rad/s to N m.
        full_load: C,
        /// Torque at closed throttle over speed (negative for drag), rad/s to N m.
        closed: C,
        /// 0 to 1.
        throttle: S,
    },
}

/// Something that acts on a member; its torque is counted as power into the train, that of a machine as power from its
/// bus.
#[derive(Clone, Debug, PartialEq)]
pub struct Source {
    /// What it is called.
    pub name: String,
    /// The member.
    pub member: MemberId,
    /// The machine that does it, if one does: position of its variator, and of the machine there.
    pub machine: Option<[usize; 2]>,
    /// What acts.
    pub kind: SourceKind,
    pub(crate) place: String,
}

/// How far a shift element is engaged over time, 0 to 1 (negative counts as 0).
#[derive(Clone, Debug, PartialEq)]
pub struct Engagement {
    /// The element.
    pub element: ShiftElementId,
    /// 0 to 1.
    pub signal: Signal,
    pub(crate) place: String,
}

/// What a variator does in a scenario.
#[derive(Clone, Debug, PartialEq)]
pub struct Control {
    /// Position in [`Train::variators`](super::Train::variators).
    pub variator: usize,
    /// What is given.
    pub kind: ControlKind,
    pub(crate) place: String,
}

/// What of a variator is given over time.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ControlKind {
    /// Speed of its first member over that of its second; if `inverse`, of the second over the first.
    Ratio {
        /// The ratio.
        ratio: Signal,
        /// Which way round.
        inverse: bool,
    },
    /// The rate of that ratio, 1/s.
    Rate {
        /// The ratio at the start.
        initial: f64,
        /// 1/s
        rate: Signal,
        /// Which way round the ratio is.
        inverse: bool,
    },
    /// Torque that it exerts on its first member, N m.
    Torque(Signal),
    /// Power out of its store into the bus, W.
    Store(Signal),
}

impl ControlKind {
    /// The value over time.
    pub fn signal(&self) -> &Signal {
        match self {
            Self::Ratio { ratio, .. } => ratio,
            Self::Rate { rate, .. } => rate,
            Self::Torque(signal) | Self::Store(signal) => signal,
        }
    }
}

/// A motion to simulate.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// Its name.
    pub name: String,
    /// When it begins, s.
    pub start: f64,
    /// When it ends, s.
    pub end: f64,
    /// Speeds at the start, rad/s; those that the gears settle follow, what is left is at rest.
    pub initial_speeds: Vec<(MemberId, f64)>,
    /// Twist of shafts at the start, angle of the first member less that of the second, by position in [`Train::shafts`](super::Train::shafts), rad;
    /// zero unless given.
    pub initial_twists: Vec<(usize, f64)>,
    /// Members held at rest from outside.
    pub fixed: Vec<MemberId>,
    /// What acts from outside.
    pub sources: Vec<Source>,
    /// When shift elements are engaged; those that are not named here are open, one-way clutches
    /// are always in action.
    pub engagements: Vec<Engagement>,
    /// What variators do.
    pub controls: Vec<Control>,
    /// How many rows of output, evenly spaced in time.
    pub samples: usize,
    pub(crate) place: String,
}
