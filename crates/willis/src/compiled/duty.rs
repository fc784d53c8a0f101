//! What is prescribed at every point, what is wanted there, and how many equilibria it has.

use crate::train::MemberId;

/// Drag of a shaft against the housing: `−coulomb · sign(ω) − viscous · ω`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ShaftDrag {
    /// Part that does not depend on speed, N m.
    pub coulomb: f64,
    /// Part that grows with speed, N m s.
    pub viscous: f64,
}

/// Loss of a mesh, or of a set as a whole, that depends on its load and speed:
///
/// `1 − η = min(coefficient · ((|T| + torque)/(|ω| + speed))^exponent, most)`
///
/// with `T` the torque on the first gear (all planets together), N m, and `ω` the speed of that gear
/// relative to the carrier, rad/s. `1 − η` is the part of the power that enters, whichever gear
/// drives. The coefficient is the loss at a torque of 1 N m and a speed of 1 rad/s. At rest relative
/// to the carrier nothing is lost, as everywhere.
///
/// This is the form of mean coefficients of friction. With that of Schlenk (ISO/TR 14179-2), the loss
/// factor `H_V` of the mesh and `1 − η = H_V μ`, the exponent is 0.2 and for one oil at one
/// temperature
///
/// ```text
/// coefficient = H_V · 0.048 · X_L · Ra^0.25 · η_oil^−0.05 · (n · r_b · b · 2 r_w · sin α_wt · ρ_redC)^−0.2
/// ```
///
/// with `n` meshes in parallel, base and operating pitch radius of the first gear `r_b` and `r_w` in m,
/// face width `b` and reduced radius of curvature `ρ_redC` in mm, roughness `Ra` in µm and viscosity
/// `η_oil` in mPa s: line load `|T|/(n r_b b)`, sum speed `2 |ω| r_w sin α_wt`. `torque` and `speed`
/// are 0 then; where the law is to stay bounded near standstill, or to keep a loss at no load, they are
/// not. For meshes in a row that share torque and speed up to constant factors, coefficients
/// add to first order; a law for each mesh is exact.
///
/// # Example
/// ```
/// use willis::compiled::{CompileRequest, CompiledOutput, PowerLoss};
/// use willis::train::{SetSpec, Train};
///
/// let train = Train::builder("reducer")
///     .members(["sun", "ring", "carrier"])
///     .terminals(["sun", "carrier"])
///     .set(SetSpec::simple("P1", ("sun", 30), ("ring", 70), "carrier"))
///     .build()?;
/// let law = PowerLoss { coefficient: 0.02, exponent: 0.2, ..PowerLoss::default() };
/// let torque = CompiledOutput::Torque("carrier".into());
/// let request = CompileRequest::new(["sun"], ["sun"]).fixed("ring").mesh_loss("P1", law).output(torque);
/// let compiled = train.compile(&request)?;
/// let mut out = [0.0];
/// compiled.evaluate(&[100.0], &[50.0], &mut compiled.workspace(), &mut out);
/// // The carrier takes 3/10 of the sun's speed; relative to it the sun turns at 70 rad/s.
/// let eta = 1.0 - 0.02 * (50.0_f64 / 70.0).powf(0.2);
/// assert!((out[0] + 50.0 * (1.0 + 7.0 / 3.0 * eta)).abs() < 1e-10);
/// # Ok::<(), willis::diagnostic::Diagnostics>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PowerLoss {
    /// Loss where both brackets are equal in number, at least 0.
    pub coefficient: f64,
    /// At least 0, less than 1; 0 makes a constant loss.
    pub exponent: f64,
    /// Added to the torque, N m, at least 0.
    pub torque: f64,
    /// Added to the speed, rad/s, at least 0.
    pub speed: f64,
    /// Ceiling of the loss, above 0 and at most one half: beyond it the law is not claimed, and a point
    /// that reaches it says so ([`PointVerdict::OutOfRange`]). The lower, the more trains have a
    /// certificate. One tenth by default, several times what good gears lose.
    pub most: f64,
}

impl Default for PowerLoss {
    fn default() -> Self {
        Self { coefficient: 0.0, exponent: 0.0, torque: 0.0, speed: 0.0, most: 0.1 }
    }
}

impl PowerLoss {
    pub(super) fn is_sound(&self) -> bool {
        let Self { coefficient, exponent, torque, speed, most } = *self;
        [coefficient, torque, speed].iter().all(|x| x.is_finite() && *x >= 0.0)
            && (0.0..1.0).contains(&exponent)
            && most > 0.0
            && most <= 0.5
    }
}

/// A result to compute for every point.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum CompiledOutput {
    /// Speed of a member, rad/s.
    Speed(String),
    /// External torque on a terminal, N m.
    Torque(String),
    /// Torque that the first gear puts into a mesh, N m.
    MeshTorque(String),
    /// Torque that a shift element exerts on its first member, N m.
    ShiftElementTorque(String),
    /// Sum of the external powers: everything that is lost, drag included, W.
    Loss,
    /// Output power over input power of the terminals; 0 when no power enters.
    Efficiency,
}

/// What is prescribed at every point, and what is wanted.
///
/// # Example
/// See [`Train::compile`](crate::train::Train::compile).
#[derive(Clone, Debug, Default)]
pub struct CompileRequest {
    pub(super) state: Option<String>,
    pub(super) fixed: Vec<String>,
    pub(super) speeds: Vec<String>,
    pub(super) torques: Vec<String>,
    pub(super) drag: Vec<(String, ShaftDrag)>,
    pub(super) between: Vec<[MemberId; 2]>,
    pub(super) losses: Vec<(String, PowerLoss)>,
    pub(super) outputs: Vec<CompiledOutput>,
}

impl CompileRequest {
    /// Prescribed: the speeds of some members and the external torques on some terminals, in the
    /// order in which a point gives them.
    pub fn new<'a>(speeds: impl IntoIterator<Item = &'a str>, torques: impl IntoIterator<Item = &'a str>) -> Self {
        Self {
            speeds: speeds.into_iter().map(String::from).collect(),
            torques: torques.into_iter().map(String::from).collect(),
            ..Self::default()
        }
    }

    /// In a state of the shift table.
    #[must_use]
    pub fn state(mut self, name: &str) -> Self {
        self.state = Some(name.into());
        self
    }

    /// Holds a member from outside.
    #[must_use]
    pub fn fixed(mut self, member: &str) -> Self {
        self.fixed.push(member.into());
        self
    }

    /// Adds drag of a shaft against the housing.
    #[must_use]
    pub fn drag(mut self, member: &str, drag: ShaftDrag) -> Self {
        self.drag.push((member.into(), drag));
        self
    }

    /// Gives a mesh, or a set whose planets touch nothing else, a loss that depends on its load and
    /// speed, in place of its efficiencies.
    #[must_use]
    pub fn mesh_loss(mut self, mesh_or_set: &str, law: PowerLoss) -> Self {
        self.losses.push((mesh_or_set.into(), law));
        self
    }

    /// Asks for a result; results come in the order asked for.
    #[must_use]
    pub fn output(mut self, output: CompiledOutput) -> Self {
        self.outputs.push(output);
        self
    }
}

/// Inputs of a batch: one slice for each prescribed speed and torque, all of one length.
///
/// Where an efficiency is asked for, an input below [`f64::MIN_POSITIVE`] in size counts as zero: it has not the digits of
/// which a quotient of powers could be made.
#[derive(Clone, Copy, Debug)]
pub struct BatchInputs<'a> {
    /// Prescribed speeds, rad/s.
    pub speeds: &'a [&'a [f64]],
    /// Prescribed torques, N m.
    pub torques: &'a [&'a [f64]],
}

impl BatchInputs<'_> {
    pub(super) fn len(&self, speeds: usize, torques: usize) -> usize {
        assert_eq!((self.speeds.len(), self.torques.len()), (speeds, torques), "inputs as the request names them");
        let n = self.speeds.first().or(self.torques.first()).map_or(0, |s| s.len());
        assert!(self.speeds.iter().chain(self.torques).all(|s| s.len() == n), "inputs of one length");
        n
    }
}

/// How many equilibria a point has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum PointVerdict {
    /// One; the outputs are its.
    Unique,
    /// Several; the outputs are those of the pattern with the lowest number.
    Multiple,
    /// None: friction locks the train for this load. The outputs are NaN.
    Locked,
    /// One, with a loss at the ceiling of its law: outside the range for which the law is given.
    OutOfRange,
    /// At least one, whose outputs these are; whether losses that depend on load allow more is not
    /// decided.
    Undecided,
    /// The iteration for losses that depend on load found none, nor that there is none. The outputs
    /// are NaN.
    NotConverged,
}
