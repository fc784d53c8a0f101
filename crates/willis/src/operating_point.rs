//! The operating point: torques depend on losses, and losses on torques; both are brought into
//! agreement.
//!
//! For given torques the [laws](crate::losses) give every loss. Losses in proportion to a mesh's
//! load (sliding of the teeth, the part of bearing friction that grows with the load) become that
//! mesh's efficiency and so enter the complementarity problem of the [statics](crate::statics)
//! itself: they can change which way power runs, and lock a train. The rest (rolling, the part of
//! bearing friction that is there without load, seals, gears in oil and air) become drag torques.
//! The statics solved with them gives new torques, and so on: a contraction, because a loss of a
//! few percent shifts torques by a few percent, and friction depends on them with a power of about
//! 0.2. It ends when the bound on the error that is left, the last change over `1 − q` with the
//! measured contraction `q`, is below 1e-9 of the loss.
//!
//! The part of a bearing's friction that grows with the load belongs to a mesh only where the
//! bearing runs between a gear of that mesh and its carrier, as planet bearings do: only there does
//! it act between the same two members as the loss of a mesh. On a central shaft of a set whose
//! carrier turns the bearing reacts on the frame, so all of its friction is a drag.
//!
//! A certificate of uniqueness holds for the friction found. Friction that depends on the load can
//! have a second agreement at much larger forces; the one reached from the forces without computed
//! losses is the one that is shown.

mod bearing;
mod body;
pub(crate) mod contact;
mod forces;
mod motion;
mod numbers;
mod support;

use std::borrow::Cow;
use std::sync::{Arc, OnceLock};

use num_dual::Dual;
use serde::{Deserialize, Serialize};
use smallvec::SmallVec;

use crate::exact::Rational;
use crate::kinematics::{Configuration, Coupling, Motion};
use crate::losses::{OutsideValidity, bearing::Turning, mesh_friction::MeshFriction, rolling::Rolling};
use crate::named::NameMap;
use crate::power_flow::{Drag, Flow, MeshFlow};
use crate::real::{self, Real};
use crate::train::{
    Efficiency, FRAME, Gear, LossPart, Lubrication, MachineEfficiency, MemberId, Operation, Train, VariatorPath,
};

pub use bearing::BearingReport;
pub(crate) use bearing::BearingState;
pub(crate) use contact::KnownPaths;
pub use contact::{ContactReport, LubricationRegime};
pub use forces::ShaftLoad;
pub(crate) use motion::{LEAST_SPEED, Place};
pub(crate) use numbers::{DragNumbers, MountNumbers, Numbers, OilState, PumpNumbers, RotorNumbers, VariatorNumbers};

/// The error that is left, over the loss.
const ACCURACY: f64 = 1e-9;
/// The same where losses of neighbouring points are compared.
const CLOSE: f64 = 1e-12;
/// Most rounds of statics and laws.
const MOST_ROUNDS: usize = 200;
/// Changes that grow by this factor in so many rounds on end will not come to rest.
const GROWTH: (f64, usize) = (1.5, 8);
/// A drag below this counts as none, N m: far below any, and still an exact number.
const LEAST_DRAG: f64 = 1e-50;
/// Most of a mesh's power that its computed losses take: the efficiency stays above zero.
const MOST_LOST: f64 = 0.95;
/// Efficiency of the sliding along hypoid teeth below which the driving gear is held.
const LEAST_LENGTHWISE: f64 = 1e-6;

/// What kind of loss it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum LossKind {
    /// Tooth friction: sliding.
    Sliding,
    /// Tooth friction: rolling.
    Rolling,
    /// Rolling bearings.
    Bearing,
    /// Gears and rotors in air and mist.
    Windage,
    /// Gears and rotors in oil.
    Churning,
    /// Lip seals.
    Seal,
    /// Drags that the train file gives as torques.
    Drag,
    /// Open clutches and brakes.
    #[serde(rename = "shift-element")]
    ShiftElement,
    /// Oil that is sprayed into a mesh.
    Injection,
    /// Oil pumps.
    Pump,
    /// Variators: electric machines, pumps and motors, belts.
    Variator,
}

impl LossKind {
    /// Its name in contracts and tables: `shift-element`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Sliding => "sliding",
            Self::Rolling => "rolling",
            Self::Bearing => "bearing",
            Self::Windage => "windage",
            Self::Churning => "churning",
            Self::Seal => "seal",
            Self::Drag => "drag",
            Self::ShiftElement => "shift-element",
            Self::Injection => "injection",
            Self::Pump => "pump",
            Self::Variator => "variator",
        }
    }

    /// Families of the laws that cause it; none where the train file gives it.
    pub const fn families(self) -> &'static [&'static str] {
        match self {
            Self::Sliding => &["mesh_friction"],
            Self::Rolling => &["rolling"],
            Self::Bearing => &["bearing", "plain_bearing"],
            Self::Windage => &["windage", "rotor_drag"],
            Self::Churning => &["churning", "rotor_drag"],
            Self::Seal => &["seal"],
            Self::ShiftElement => &["clutch_drag"],
            Self::Injection => &["injection"],
            Self::Pump => &["pump"],
            Self::Drag | Self::Variator => &[],
        }
    }

    /// For people: `tooth sliding`.
    pub fn words(self) -> &'static str {
        match self {
            Self::Sliding => "tooth sliding",
            Self::Rolling => "tooth rolling",
            Self::Bearing => "bearing",
            Self::Windage => "windage",
            Self::Churning => "churning",
            Self::Seal => "seal",
            Self::Drag => "drag",
            Self::ShiftElement => "open shift element",
            Self::Injection => "oil injection",
            Self::Pump => "oil pump",
            Self::Variator => "variator",
        }
    }
}

/// One place where power is lost.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct LossSource {
    /// What loses it.
    pub name: String,
    /// What kind of loss it is.
    pub kind: LossKind,
    /// Its name in the list of laws; `given` for a given efficiency.
    pub law: String,
    /// The power, W.
    pub loss_w: f64,
    /// The part of all losses.
    pub share: f64,
}

/// What exerts a drag torque between two members.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum DragSource {
    /// Rolling of the teeth of a mesh.
    Rolling,
    /// Rolling bearings.
    Bearing,
    /// Lip seals.
    Seal,
    /// A gear in oil or air.
    Gear,
    /// A carrier or drum in oil or air.
    Rotor,
    /// A drag that the train file gives.
    Drag,
    /// An open clutch or brake.
    #[serde(rename = "shift-element")]
    ShiftElement,
    /// Oil that is sprayed into a mesh.
    Injection,
    /// An oil pump.
    Pump,
}

/// A torque that two members exert on each other against their relative motion.
///
/// Of a bearing that the teeth load there are several: the part that is there without load, and one
/// for each mesh whose load it carries. The latter is contained in that mesh's efficiency, so the
/// mesh's torques include it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct DragReport {
    /// What exerts it: name of the bearing, seal, gear or rotor; of rolling, of the mesh.
    pub name: String,
    /// What that is.
    pub source: DragSource,
    /// The two members.
    pub members: [String; 2],
    /// Torque on the first member, N m; the second feels the opposite.
    pub torque_n_m: f64,
    /// Loss, W: torque times speed of the second relative to the first.
    pub loss_w: f64,
    /// The mesh whose torques contain it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contained_in: Option<String>,
}

/// How the agreement of losses and torques was reached.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Convergence {
    /// Whether it was reached.
    pub converged: bool,
    /// Rounds of statics and laws.
    pub rounds: usize,
    /// Bound on the error that is left, over the loss; the last change where nothing bounds it.
    pub error: f64,
    /// The factor by which the last rounds reduced it.
    pub contraction: f64,
}

/// Losses on their way to agree with the torques.
#[derive(Clone, Debug)]
pub(crate) struct Approach {
    step: Step,
    rounds: Trend,
    /// Where it is known already.
    idle: Option<Arc<Idle>>,
}

/// What of the losses of a motion no load changes.
#[derive(Clone, Debug)]
pub(crate) struct Idle<R: Real = f64> {
    drags: Vec<(Source, Drag<R>)>,
    /// Of the friction of each bearing; none without an oil.
    bearings: Vec<Option<Turning<Dual<R>>>>,
}

impl Approach {
    /// The losses to begin with.
    pub fn new(step: Step) -> Self {
        let rounds = Trend {
            accuracy: ACCURACY,
            count: 0,
            last: f64::INFINITY,
            contraction: 0.0,
            watts: f64::INFINITY,
            growing: 0,
        };
        Self { step, rounds, idle: None }
    }

    /// With what no load changes.
    pub fn with(self, idle: Arc<Idle>) -> Self {
        Self { idle: Some(idle), ..self }
    }

    /// The same for losses that are compared with others closely.
    pub fn closely(step: Step) -> Self {
        let mut own = Self::new(step);
        own.rounds.accuracy = CLOSE;
        own
    }
}

/// How the changes from round to round shrink.
#[derive(Clone, Copy, Debug)]
struct Trend {
    /// The error at which they end, over the loss.
    accuracy: f64,
    count: usize,
    /// The last change, over the loss.
    last: f64,
    contraction: f64,
    /// The last change, W, and for how many rounds it has been growing.
    watts: f64,
    growing: usize,
}

impl Trend {
    /// Takes the change of one more round; how they ended, if it was the last.
    fn ended(&mut self, watts: f64, loss: f64) -> Option<Convergence> {
        self.count += 1;
        self.growing = if watts > GROWTH.0 * self.watts { self.growing + 1 } else { 0 };
        self.watts = watts;
        let change = if watts == 0.0 { 0.0 } else { watts / loss.max(f64::MIN_POSITIVE) };
        // The first rounds leave the start behind; they say nothing of the contraction.
        let q = if self.last.is_finite() && self.last > 0.0 { (change / self.last).min(2.0) } else { 0.5 };
        self.contraction = if self.count > 2 { q.max(0.2 * self.contraction) } else { q };
        self.last = change;
        // The step that was solved is what is returned: all further changes are still missing in it.
        let error = if self.contraction < 1.0 { change / (1.0 - self.contraction) } else { f64::INFINITY };
        let converged = error <= self.accuracy || change <= 1e-15;
        (converged || self.count == MOST_ROUNDS || self.growing == GROWTH.1).then(|| Convergence {
            converged,
            rounds: self.count,
            error: if error.is_finite() { error } else { change.min(f64::MAX) },
            contraction: self.contraction,
        })
    }
}

/// A quantity outside the range of the law that used it.
#[derive(Clone, Debug, PartialEq)]
pub struct Extrapolation {
    /// Family of the law.
    pub family: &'static str,
    /// Name of the law.
    pub law: &'static str,
    /// Where it was used.
    pub at: String,
    /// The quantity.
    pub outside: OutsideValidity,
}

/// Where a drag comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Source {
    Rolling(usize),
    Bearing(usize),
    Seal(usize),
    Body(usize),
    Rotor(usize),
    /// A drag that the train gives.
    Drag(usize),
    /// A shift element that is open.
    Open(usize),
    Pump(usize),
    /// Oil that is sprayed at a mesh.
    Jet(usize),
    /// What a variator takes from its bus without load.
    Standby(usize),
}

/// All losses of a train that an operating point can compute.
#[derive(Clone, Debug)]
pub(crate) struct Physics<'t, R: Real = f64> {
    train: Cow<'t, Train>,
    numbers: Numbers<R>,
    oil: Option<(Lubrication, OilState<R>)>,
    friction: MeshFriction,
    rolling: Option<Rolling>,
    bodies: Vec<body::Body>,
    /// The given drags that count; none in motion, which has them as friction that can hold, and open elements, pumps and
    /// jets not at all.
    drags: Option<Vec<usize>>,
    forces: forces::Forces<R>,
    /// By mesh: what follows from its geometry alone.
    fixed: Vec<OnceLock<Arc<contact::Fixed<R>>>>,
    /// Amounts of relative speed below it count as this, rad/s.
    least_speed: f64,
}

/// All losses of a flow, W.
fn computed_loss(flow: &Flow) -> f64 {
    let passing = flow.variators.iter().map(|v| v.loss);
    flow.meshes.iter().map(|m| m.loss).chain(passing).chain(flow.drag_losses.iter().copied()).sum()
}

/// What laws say of a solved step beside its losses: what a reader must be warned of follows from it.
pub(crate) struct Strains {
    /// The largest Hertzian pressure in each mesh with teeth, Pa.
    pub pressures: Vec<(usize, f64)>,
    /// By place; none without an oil.
    pub bearings: Vec<BearingState>,
    /// Loads of the shafts on bearings.
    pub shafts: Vec<(MemberId, ShaftLoad)>,
    /// Where laws were used outside their ranges.
    pub extrapolations: Vec<Extrapolation>,
}

/// Losses of one mesh as parts of its potential power.
#[derive(Clone, Debug)]
struct MeshLoss<R = f64> {
    sliding: R,
    /// Efficiency of the sliding along hypoid teeth, first gear driving and second gear driving; above zero.
    lengthwise: Option<[R; 2]>,
    /// Bearing, and its part.
    bearings: SmallVec<[(usize, R); 2]>,
    /// Mean coefficient of friction of the teeth.
    friction: Option<R>,
}

impl<R: Real> MeshLoss<R> {
    fn none() -> Self {
        Self { sliding: R::from(0.0), lengthwise: None, bearings: SmallVec::new(), friction: None }
    }

    fn total(&self) -> R {
        self.sliding + self.bearings.iter().fold(R::from(0.0), |sum, b| sum + b.1)
    }

    /// The efficiency with a gear driving.
    fn efficiency(&self, driver: usize) -> R {
        let across = -self.total() + 1.0;
        self.lengthwise.map_or(across, |along| across * along[driver])
    }

    /// The part of the power that is lost with a gear driving.
    fn lost(&self, driver: usize) -> R {
        match self.lengthwise {
            Some(_) => -self.efficiency(driver) + 1.0,
            None => self.total(),
        }
    }
}

/// The losses of one round, in the form that the statics takes.
#[derive(Clone, Debug)]
pub(crate) struct Step<R = f64> {
    meshes: Vec<MeshLoss<R>>,
    sources: Vec<Source>,
    pub drags: Vec<Drag<R>>,
    /// Frictional torque of one bearing of each mount, N m.
    bearings: Vec<R>,
    /// Efficiency of machines that have a map: variator and machine.
    machines: Vec<([usize; 2], f64)>,
    /// Whether a gear that should drive is held by the friction along its teeth.
    locked: bool,
}

impl Step {
    /// The efficiencies of a train without any loss, and no drag.
    pub fn lossless(train: &Train) -> Self {
        Self::blank(train)
    }

    /// The configuration with the efficiencies of this round.
    pub fn configure<'t>(&self, c: &Configuration<'t>) -> Configuration<'t> {
        let efficiency = |eta: f64| Rational::from_f64(eta).unwrap_or(Rational::ONE);
        let all = self.meshes.iter().zip(&c.train.meshes).map(|(own, mesh)| {
            let mut given = if mesh.computed { Efficiency::lossless() } else { mesh.efficiency.clone() };
            if own.lengthwise.is_some() {
                let [first, second] = [0, 1].map(|driver| efficiency(own.efficiency(driver)));
                given = Efficiency { forward: given.forward * first, backward: given.backward * second };
            } else if own.total() > 0.0 {
                let own = efficiency(1.0 - own.total());
                given = Efficiency { forward: given.forward * own.clone(), backward: given.backward * own };
            }
            given
        });
        let mut c = c.with_efficiencies(all.collect());
        let gears = c.gears().len();
        for (at, eta) in &self.machines {
            let own = |k: &Coupling| k.variator == at[0] && k.machine == Some(at[1]);
            if let (Some(k), Some(eta)) = (c.couplings.iter().position(own), Rational::from_f64(*eta)) {
                (c.elements[gears + k].forward, c.elements[gears + k].backward) = (eta.clone(), eta);
            }
        }
        c
    }
}

impl Step {
    /// Whether friction along hypoid teeth holds a gear that should drive.
    pub fn is_locked(&self) -> bool {
        self.locked
    }

    /// The losses of the meshes alone.
    pub fn without_drags(&self) -> Self {
        let (sources, drags) = Default::default();
        Self { sources, drags, ..self.clone() }
    }
}

impl<R: Real> Step<R> {
    fn blank(train: &Train) -> Self {
        Self {
            meshes: vec![MeshLoss::none(); train.meshes.len()],
            sources: vec![],
            drags: vec![],
            bearings: vec![],
            machines: vec![],
            locked: false,
        }
    }

    /// The efficiency in force in each mesh, first gear driving and second gear driving.
    pub fn efficiencies(&self, train: &Train, given: &[[R; 2]]) -> SmallVec<[[R; 2]; 8]> {
        let all = self.meshes.iter().zip(&train.meshes).zip(given);
        all.map(|((own, mesh), given)| {
            let given = if mesh.computed { [R::from(1.0); 2] } else { *given };
            let total = own.total();
            match own.lengthwise {
                Some(_) => [given[0] * own.efficiency(0), given[1] * own.efficiency(1)],
                None if total.re() > 0.0 => given.map(|eta| eta * (-total + 1.0)),
                None => given,
            }
        })
        .collect()
    }
}

impl<'t> Physics<'t> {
    /// Everything that does not depend on the load.
    pub fn new(train: &'t Train, operation: &Operation) -> Self {
        Self::at(Cow::Borrowed(train), operation.temperature)
    }

    fn at(train: Cow<'t, Train>, temperature: Option<f64>) -> Self {
        let numbers = Numbers::of(&train, temperature);
        Self::with_numbers(train, numbers)
    }

    /// Temperature of the oil, K.
    pub fn temperature(&self) -> Option<f64> {
        self.oil.as_ref().map(|(_, state)| state.temperature)
    }

    /// Brings the oil to another temperature, K.
    pub fn warm_to(&mut self, temperature: f64) {
        if let (Some((lubrication, state)), Some(own)) = (&mut self.oil, &mut self.numbers.oil) {
            *state = OilState::of(lubrication, temperature);
            *own = *state;
        }
    }
}

impl<'t, R: Real> Physics<'t, R> {
    /// A train with numbers of its own.
    pub fn with_numbers(train: Cow<'t, Train>, numbers: Numbers<R>) -> Self {
        let oil = train.lubrication.clone().zip(numbers.oil);
        let friction = train.laws.mesh_friction(oil.is_some());
        let rolling = train.laws.rolling(&friction).filter(|_| oil.is_some());
        let bodies = body::bodies(&train);
        let forces = forces::Forces::new(&train, &numbers);
        let within = |k: &usize| train.drags[*k].members.iter().all(|m| train.is_within(*m));
        let drags = Some((0..train.drags.len()).filter(within).collect());
        let fixed = train.meshes.iter().map(|_| OnceLock::new()).collect();
        Self { train, numbers, oil, friction, rolling, bodies, drags, forces, fixed, least_speed: 0.0 }
    }

    /// Members on which a drag acts: the statics must see them, planets too.
    pub fn visible(&self) -> Vec<MemberId> {
        let mut all: Vec<MemberId> = Vec::new();
        all.extend(self.train.bearings.iter().flat_map(|b| b.members));
        all.extend(self.train.seals.iter().flat_map(|b| b.members));
        all.extend(self.train.rotors.iter().map(|r| r.member));
        if let Some(drags) = &self.drags {
            all.extend(drags.iter().flat_map(|k| self.train.drags[*k].members));
            let open = self.train.shift_elements.iter().filter(|e| e.open.is_some());
            all.extend(open.flat_map(|e| e.members));
            all.extend(self.train.pumps.iter().map(|p| p.member));
            let sprayed = self.train.meshes.iter().filter(|m| m.teeth.as_ref().is_some_and(|t| t.jet.is_some()));
            all.extend(sprayed.flat_map(|m| m.gears.iter().map(|g| g.member)));
        }
        all.extend(self.bodies.iter().map(|b| b.member));
        if self.rolling.is_some() {
            let rolling = self.train.meshes.iter().filter(|m| m.computed);
            all.extend(rolling.flat_map(|m| m.gears.iter().map(|g| g.member)));
        }
        all.sort_unstable();
        all.dedup();
        all
    }

    /// What tests say of a kind of loss.
    fn factor(&self, part: LossPart) -> R {
        self.numbers.loss_factors[part as usize]
    }

    /// Amount of the speed of two members relative to each other.
    fn slip(&self, speeds: &[R], [a, b]: [MemberId; 2]) -> R {
        real::max(real::abs(speeds[a.0] - speeds[b.0]), R::from(self.least_speed))
    }

    /// The losses that the laws give for torques and speeds; `known` are the members whose speed is settled.
    pub fn evaluate(&self, speeds: &[R], meshes: &[MeshFlow<R>], known: &dyn Fn(MemberId) -> bool) -> Step<R> {
        self.evaluate_with(speeds, meshes, known, &self.without_load(speeds, meshes, known))
    }

    /// What no load changes; of the meshes only the speeds count.
    pub fn without_load(&self, speeds: &[R], meshes: &[MeshFlow<R>], known: &dyn Fn(MemberId) -> bool) -> Idle<R> {
        let bearings = match self.oil {
            Some(_) => (0..self.train.bearings.len()).map(|k| self.turning(k, speeds)).collect(),
            None => vec![],
        };
        Idle { drags: self.drags_without_load(speeds, meshes, known), bearings }
    }

    /// Where a drag resists, if it does.
    fn drag_between(
        &self,
        speeds: &[R],
        known: &dyn Fn(MemberId) -> bool,
        members: [MemberId; 2],
        torque: R,
    ) -> Option<Drag<R>> {
        let relative = (speeds[members[0].0] - speeds[members[1].0]).re();
        let acts =
            torque.re() > LEAST_DRAG && self.slip(speeds, members).re() > 0.0 && members.iter().all(|m| known(*m));
        acts.then(|| Drag { members, torque: -torque * relative.signum() })
    }

    /// The drags that do not depend on the load; of the meshes only the speeds count.
    fn drags_without_load(
        &self,
        speeds: &[R],
        meshes: &[MeshFlow<R>],
        known: &dyn Fn(MemberId) -> bool,
    ) -> Vec<(Source, Drag<R>)> {
        let mut all = Vec::new();
        let mut drag = |source: Source, members: [MemberId; 2], torque: &R| {
            all.extend(self.drag_between(speeds, known, members, *torque).map(|drag| (source, drag)));
        };
        for (k, seal) in self.train.seals.iter().enumerate() {
            drag(Source::Seal(k), seal.members, &(self.seal(k, speeds) * self.factor(LossPart::Seal)));
        }
        for (k, body) in self.bodies.iter().enumerate() {
            let part = match body.kind(&self.train).0 {
                LossKind::Churning => LossPart::Churning,
                _ => LossPart::Windage,
            };
            drag(Source::Body(k), [body.member, body.against], &(self.body(body, speeds) * self.factor(part)));
        }
        for (k, rotor) in self.train.rotors.iter().enumerate() {
            let torque = self.rotor(k, speeds) * self.factor(LossPart::Rotor);
            drag(Source::Rotor(k), [rotor.member, crate::train::FRAME], &torque);
        }
        let Some(drags) = &self.drags else { return all };
        for k in drags {
            let members = self.train.drags[*k].members;
            drag(Source::Drag(*k), members, &self.drag(*k, self.slip(speeds, members)));
        }
        for (k, element) in self.train.shift_elements.iter().enumerate() {
            if let Some(torque) = self.open(k, speeds) {
                drag(Source::Open(k), element.members, &torque);
            }
        }
        for (k, pump) in self.train.pumps.iter().enumerate() {
            drag(Source::Pump(k), [pump.member, FRAME], &self.pump(k, speeds));
        }
        for m in meshes {
            let mesh = &self.train.meshes[m.mesh.0];
            // Both gears bring the oil to their speed; each takes half of the power.
            let Some(power) = self.jet(m) else { continue };
            for k in 0..2 {
                let speed = real::abs(m.relative_speeds[k]);
                if speed.re() > 0.0 {
                    drag(Source::Jet(m.mesh.0), [mesh.gears[k].member, mesh.carrier], &(power * 0.5 / speed));
                }
            }
        }
        all
    }

    /// The losses for torques and speeds, where it is known what [no load changes](Self::without_load).
    pub fn evaluate_with(
        &self,
        speeds: &[R],
        meshes: &[MeshFlow<R>],
        known: &dyn Fn(MemberId) -> bool,
        without_load: &Idle<R>,
    ) -> Step<R> {
        let most = 2 * meshes.len() + self.train.bearings.len() + without_load.drags.len();
        let (mut sources, mut drags) = (Vec::with_capacity(most), Vec::with_capacity(most));
        let none = R::from(0.0);
        let mut drag = |source: Source, members: [MemberId; 2], torque: &R| {
            if let Some(drag) = self.drag_between(speeds, known, members, *torque) {
                sources.push(source);
                drags.push(drag);
            }
        };
        let mut losses: Vec<MeshLoss<R>> = Vec::with_capacity(meshes.len());
        let mut locked = false;
        for m in meshes {
            let mesh = &self.train.meshes[m.mesh.0];
            let Some(teeth) = &self.numbers.teeth[m.mesh.0] else {
                losses.push(MeshLoss::none());
                continue;
            };
            let mut tooth = self.tooth(mesh, teeth, m);
            let factor = self.factor(LossPart::Teeth);
            tooth.friction = tooth.friction.map(|mu| mu * factor);
            tooth.rolling *= factor;
            // Rolling resists on both gears; each takes half of its power.
            for k in 0..2 {
                let speed = real::abs(m.relative_speeds[k]);
                if speed.re() > 0.0 && mesh.computed {
                    drag(
                        Source::Rolling(m.mesh.0),
                        [mesh.gears[k].member, mesh.carrier],
                        &(tooth.rolling * 0.5 / speed),
                    );
                }
            }
            let sliding = match (tooth.friction, mesh.computed, m.driver) {
                (Some(mu), true, Some(_)) => real::clamp(mu * tooth.loss_factor, none, R::from(MOST_LOST)),
                // Idle or at rest: nothing is lost, but friction may hold; the nominal value.
                (_, true, _) => -self.numbers.efficiencies[m.mesh.0][0] + 1.0,
                _ => none,
            };
            let mut own = MeshLoss { sliding, lengthwise: None, bearings: SmallVec::new(), friction: tooth.friction };
            if let Some(hypoid) = teeth.hypoid.as_ref().filter(|_| mesh.computed) {
                let along = match (tooth.friction, m.driver) {
                    (Some(mu), Some(driver)) => {
                        let along = hypoid.lengthwise_efficiency(teeth.pair.data.pressure_angle, mu);
                        locked |= along[driver].re() < LEAST_LENGTHWISE;
                        along
                    }
                    _ => {
                        own.sliding = none;
                        self.numbers.efficiencies[m.mesh.0]
                    }
                };
                own.lengthwise = Some(along.map(|eta| real::max(eta, R::from(LEAST_LENGTHWISE))));
            }
            losses.push(own);
        }
        let mut bearings = Vec::with_capacity(self.train.bearings.len());
        let reactions = self.oil.as_ref().map(|_| self.reactions(speeds, meshes));
        let carried = reactions.iter().flat_map(|r| &r.places);
        for ((k, mount), carried) in self.train.bearings.iter().enumerate().zip(carried) {
            let turning = without_load.bearings[k].as_ref();
            let bearing::Friction { speed, mut torque, mut proportional } = self.bearing(k, speeds, carried, turning);
            let loading = &carried.loading;
            let [by_load, idle] = [LossPart::BearingLoad, LossPart::BearingNoLoad].map(|part| self.factor(part));
            torque = torque * idle + proportional * (by_load - idle);
            proportional *= by_load;
            bearings.push(torque / f64::from(mount.count * mount.places));
            // The part that grows with the load belongs to the meshes that make the load.
            let weight = loading.iter().fold(none, |sum, l| sum + l.1);
            for &(at, w) in loading {
                let (m, own) = (&meshes[at], &mut losses[at]);
                let mesh = &self.train.meshes[m.mesh.0];
                let between =
                    |g: &Gear| mount.members == [g.member, mesh.carrier] || mount.members == [mesh.carrier, g.member];
                let loaded = weight.re() > 0.0 && speed.re() > 0.0 && m.potential_power.re() > 0.0;
                if loaded && mesh.gears.iter().any(between) {
                    let most = real::max(-own.total() + MOST_LOST, none) * m.potential_power / speed;
                    let part = real::min(real::min(proportional * w / weight, most), torque);
                    if part.re() > 0.0 {
                        own.bearings.push((k, part * speed / m.potential_power));
                        torque -= part;
                    }
                }
            }
            drag(Source::Bearing(k), mount.members, &torque);
        }
        sources.extend(without_load.drags.iter().map(|d| d.0));
        drags.extend(without_load.drags.iter().map(|d| d.1));
        Step { meshes: losses, sources, drags, bearings, machines: vec![], locked }
    }

    /// Every loss of a solved step: what loses it, what kind it is, its law, the power in W; what has one name, kind
    /// and law is one loss.
    pub fn parts<'s>(
        &'s self,
        step: &Step<R>,
        meshes: &[MeshFlow<R>],
        drag_losses: &[R],
    ) -> Vec<(&'s str, LossKind, &'static str, R)> {
        let mut all: Vec<(&'s str, LossKind, &'static str, R)> = Vec::new();
        self.each_loss(step, meshes, drag_losses, |name, kind, law, loss| {
            match all.iter_mut().find(|s| s.0 == name && s.1 == kind && s.2 == law) {
                Some(s) => s.3 += loss,
                None => all.push((name, kind, law, loss)),
            }
        });
        all
    }

    /// Tells every loss of a solved step, several of one source one after the other: what loses it, what kind it is, its
    /// law, the power in W.
    pub fn each_loss<'s>(
        &'s self,
        step: &Step<R>,
        meshes: &[MeshFlow<R>],
        drag_losses: &[R],
        mut add: impl FnMut(&'s str, LossKind, &'static str, R),
    ) {
        let train = &self.train;
        for (m, own) in meshes.iter().zip(&step.meshes) {
            let mesh = &train.meshes[m.mesh.0];
            let mut teeth = m.loss;
            for (bearing, part) in &own.bearings {
                let loss = m.potential_power * *part;
                teeth -= loss;
                let mount = &train.bearings[*bearing];
                add(&mount.name, LossKind::Bearing, self.bearing_law_name(mount), loss);
            }
            let law = if mesh.computed { self.friction.meta().id } else { "given" };
            add(&mesh.name, LossKind::Sliding, law, teeth);
        }
        for (source, loss) in step.sources.iter().zip(drag_losses) {
            let (name, kind, law) = match *source {
                Source::Rolling(k) => {
                    (&train.meshes[k].name, LossKind::Rolling, self.rolling.map_or("none", |r| r.meta().id))
                }
                Source::Bearing(k) => {
                    let mount = &train.bearings[k];
                    (&mount.name, LossKind::Bearing, self.bearing_law_name(mount))
                }
                Source::Seal(k) => (&train.seals[k].name, LossKind::Seal, train.laws.seal.meta().id),
                Source::Body(k) => {
                    let (kind, law) = self.bodies[k].kind(train);
                    (&self.bodies[k].name, kind, law)
                }
                Source::Rotor(k) => {
                    let kind = match train.rotors[k].fluid {
                        crate::train::Fluid::Oil => LossKind::Churning,
                        _ => LossKind::Windage,
                    };
                    (&train.rotors[k].name, kind, train.laws.rotor_drag.meta().id)
                }
                Source::Drag(k) => (&train.drags[k].name, LossKind::Drag, "given"),
                Source::Open(k) => (&train.shift_elements[k].name, LossKind::ShiftElement, self.open_law(k)),
                Source::Pump(k) => (&train.pumps[k].name, LossKind::Pump, train.laws.pump.meta().id),
                Source::Jet(k) => (&train.meshes[k].name, LossKind::Injection, train.laws.injection.meta().id),
                Source::Standby(k) => (&train.variators[k].name, LossKind::Variator, "given"),
            };
            add(name, kind, law, *loss);
        }
    }
}

impl Physics<'_> {
    /// What of the losses of a motion no load changes; any flow of it will do.
    pub fn idle(&self, flow: &Flow, motion: &Motion) -> Idle {
        self.without_load(&flow.speeds, &flow.meshes, &|m| motion.speeds[m.0].is_some())
    }

    /// The losses that the laws give for the torques and speeds of a flow.
    pub fn step(&self, flow: &Flow, motion: &Motion, idle: &Idle) -> Step {
        let known = |m: MemberId| motion.speeds[m.0].is_some();
        let mut step = self.evaluate_with(&flow.speeds, &flow.meshes, &known, idle);
        let mut bus = self.train.members.len();
        for v in &flow.variators {
            let VariatorPath::Bus { machines, standby, .. } = &self.train.variators[v.variator].path else { continue };
            for (k, (machine, side)) in machines.iter().zip(&v.sides).enumerate() {
                if let MachineEfficiency::Map(_) = machine.efficiency {
                    step.machines.push(([v.variator, k], machine.efficiency.at(side.torque, side.speed).0));
                }
            }
            // The bus turns, so a power is a torque on it.
            if *standby > 0.0 {
                let members = [MemberId(bus), FRAME];
                step.sources.push(Source::Standby(v.variator));
                step.drags.push(Drag { members, torque: -standby / flow.speeds[bus] });
            }
            bus += 1;
        }
        step
    }

    /// How far two rounds differ, in watts of this flow, and the loss.
    fn change(&self, flow: &Flow, old: &Step, new: &Step) -> (f64, f64) {
        let mut change = 0.0;
        for (m, (a, b)) in flow.meshes.iter().zip(old.meshes.iter().zip(&new.meshes)) {
            let driver = m.driver.unwrap_or(0);
            change += m.potential_power * (a.lost(driver) - b.lost(driver)).abs();
        }
        for (at, eta) in &new.machines {
            let before = old.machines.iter().find(|m| m.0 == *at).map_or(1.0, |m| m.1);
            let sides = flow.variators.iter().find(|v| v.variator == at[0]).map(|v| &v.sides);
            change += sides.map_or(0.0, |sides| sides[at[1]].power.abs()) * (eta - before).abs() / eta;
        }
        let relative = |d: &Drag| flow.speeds[d.members[0].0] - flow.speeds[d.members[1].0];
        let aligned = |(a, b): (&Drag, &Drag)| a.members == b.members;
        if old.sources == new.sources && old.drags.iter().zip(&new.drags).all(aligned) {
            let both = old.drags.iter().zip(&new.drags);
            both.for_each(|(d, theirs)| change += ((d.torque - theirs.torque) * relative(d)).abs());
            return (change, computed_loss(flow));
        }
        let mut theirs = new.drags.iter().zip(&new.sources).map(|(d, s)| (d, s, false)).collect::<Vec<_>>();
        for (d, s) in old.drags.iter().zip(&old.sources) {
            let same = theirs.iter_mut().find(|t| !t.2 && t.1 == s && t.0.members == d.members);
            let torque = same.map_or(0.0, |t| {
                t.2 = true;
                t.0.torque
            });
            change += ((d.torque - torque) * relative(d)).abs();
        }
        change += theirs.iter().filter(|t| !t.2).map(|t| (t.0.torque * relative(t.0)).abs()).sum::<f64>();
        (change, computed_loss(flow))
    }

    /// Repeats statics and laws until they agree. `solve` gives the flow for the losses of a step, or nothing where friction
    /// locks the train. Returns the last step that was solved, its flow, and how well it agrees.
    pub fn agree<F>(
        &self,
        motion: &Motion,
        from: Approach,
        mut solve: impl FnMut(&Step) -> Option<(F, Flow)>,
    ) -> Option<(Step, F, Flow, Convergence)> {
        let Approach { mut step, mut rounds, mut idle } = from;
        loop {
            let (own, flow) = solve(&step)?;
            let next = self.step(&flow, motion, idle.get_or_insert_with(|| Arc::new(self.idle(&flow, motion))));
            let (change, loss) = self.change(&flow, &step, &next);
            if let Some(convergence) = rounds.ended(change, loss) {
                return Some((step, own, flow, convergence));
            }
            step = next;
        }
    }

    /// The rounds of [`agree`](Self::agree) up to the last one, which is left to it, or to where `solve` gives up.
    pub fn approach(
        &self,
        motion: &Motion,
        mut from: Approach,
        mut solve: impl FnMut(&Step) -> Option<Flow>,
    ) -> Approach {
        while let Some(flow) = solve(&from.step) {
            let next = self.step(&flow, motion, from.idle.get_or_insert_with(|| Arc::new(self.idle(&flow, motion))));
            let (change, loss) = self.change(&flow, &from.step, &next);
            let mut rounds = from.rounds;
            if rounds.ended(change, loss).is_some() {
                break;
            }
            from = Approach { step: next, rounds, idle: from.idle };
        }
        from
    }

    /// Every loss of a solved step by its source, largest first; their sum is the flow's loss.
    pub fn sources(&self, step: &Step, flow: &Flow) -> Vec<LossSource> {
        let mut parts = self.parts(step, &flow.meshes, &flow.drag_losses);
        for v in &flow.variators {
            let name = self.train.variators[v.variator].name.as_str();
            match parts.iter_mut().find(|s| s.0 == name && s.1 == LossKind::Variator) {
                Some(standby) => standby.3 += v.loss,
                None => parts.push((name, LossKind::Variator, "given", v.loss)),
            }
        }
        let parts = parts.into_iter();
        let mut all: Vec<LossSource> = parts
            .map(|(name, kind, law, loss_w)| LossSource {
                name: name.to_owned(),
                kind,
                law: law.to_owned(),
                loss_w,
                share: 0.0,
            })
            .collect();
        let total: f64 = all.iter().map(|s| s.loss_w).sum();
        for s in &mut all {
            s.loss_w += 0.0;
            s.share = if total > 0.0 { s.loss_w / total } else { 0.0 };
        }
        all.sort_by(|a, b| b.loss_w.total_cmp(&a.loss_w));
        all
    }

    /// What the laws say of a solved step beside its losses.
    pub fn strains(&self, step: &Step, flow: &Flow) -> Strains {
        let mut extrapolations = vec![];
        let mut pressures = vec![];
        for m in &flow.meshes {
            let mesh = &self.train.meshes[m.mesh.0];
            let Some(teeth) = &mesh.teeth else { continue };
            pressures.push((m.mesh.0, self.largest_pressure(mesh, teeth, m)));
            self.contact_extrapolations(mesh, teeth, m, &mut extrapolations);
        }
        let (bearings, shafts) = self.bearings(step, flow, &mut extrapolations);
        self.wet_extrapolations(&flow.speeds, &mut extrapolations);
        Strains { pressures, bearings, shafts, extrapolations }
    }

    /// The bearings of a solved step for people.
    pub fn bearing_reports(&self, strains: &Strains) -> NameMap<BearingReport> {
        let own = |(k, state): (usize, &BearingState)| {
            (self.train.bearings[k].name.clone(), self.bearing_report(&self.train, k, state))
        };
        NameMap(strains.bearings.iter().enumerate().map(own).collect())
    }

    /// The contact of each mesh with teeth, with its losses in this flow.
    pub fn contacts(&self, step: &Step, flow: &Flow) -> NameMap<ContactReport> {
        let mut all = Vec::new();
        for (m, own) in flow.meshes.iter().zip(&step.meshes) {
            let mesh = &self.train.meshes[m.mesh.0];
            let Some(teeth) = &mesh.teeth else { continue };
            // Loads of this flow, with the friction it was solved with.
            let mut contact = self.contact(mesh, teeth, m);
            contact.friction = own.friction;
            let bearings: f64 = own.bearings.iter().map(|b| b.1).sum();
            contact.sliding_loss_w = (m.loss - m.potential_power * bearings).max(0.0);
            if let (Some(along), Some(driver), Some(_)) = (own.lengthwise, m.driver, own.friction) {
                contact.lengthwise_efficiency = Some(along[driver]);
                contact.lengthwise_loss_w =
                    Some((m.potential_power * (1.0 - along[driver])).min(contact.sliding_loss_w));
            }
            let rolling = step.sources.iter().zip(&flow.drag_losses);
            contact.rolling_loss_w =
                rolling.filter(|(s, _)| **s == Source::Rolling(m.mesh.0)).map(|(_, loss)| *loss).sum::<f64>() + 0.0;
            all.push((mesh.name.clone(), contact));
        }
        NameMap(all)
    }

    /// The bearings of a solved step, with their losses, and the loads of the shafts on them.
    fn bearings(
        &self,
        step: &Step,
        flow: &Flow,
        beyond: &mut Vec<Extrapolation>,
    ) -> (Vec<BearingState>, Vec<(MemberId, ShaftLoad)>) {
        if self.oil.is_none() {
            return (vec![], vec![]);
        }
        let mut all = Vec::with_capacity(step.bearings.len());
        let reactions = self.reactions(&flow.speeds, &flow.meshes);
        for ((k, torque), carried) in step.bearings.iter().enumerate().zip(&reactions.places) {
            let mut loss = 0.0;
            for (m, own) in flow.meshes.iter().zip(&step.meshes) {
                own.bearings.iter().filter(|b| b.0 == k).for_each(|b| loss += b.1 * m.potential_power);
            }
            let drags = step.sources.iter().zip(&flow.drag_losses);
            drags.filter(|(s, _)| **s == Source::Bearing(k)).for_each(|(_, own)| loss += own);
            // Loads of this flow, with the torque it was solved with.
            all.push(self.bearing_state(k, &flow.speeds, carried, [*torque, loss + 0.0], beyond));
        }
        (all, reactions.shafts)
    }

    /// Every torque between two members beside those of the teeth.
    pub fn drags(&self, step: &Step, flow: &Flow) -> Vec<DragReport> {
        let train = &self.train;
        let members = |m: [MemberId; 2]| m.map(|m| train.member_name(m).to_owned());
        let mut all = Vec::new();
        for ((source, drag), loss_w) in step.sources.iter().zip(&step.drags).zip(&flow.drag_losses) {
            let (source, name) = match *source {
                Source::Rolling(k) => (DragSource::Rolling, &train.meshes[k].name),
                Source::Bearing(k) => (DragSource::Bearing, &train.bearings[k].name),
                Source::Seal(k) => (DragSource::Seal, &train.seals[k].name),
                Source::Body(k) => (DragSource::Gear, &self.bodies[k].name),
                Source::Rotor(k) => (DragSource::Rotor, &train.rotors[k].name),
                Source::Drag(k) => (DragSource::Drag, &train.drags[k].name),
                Source::Open(k) => (DragSource::ShiftElement, &train.shift_elements[k].name),
                Source::Pump(k) => (DragSource::Pump, &train.pumps[k].name),
                Source::Jet(k) => (DragSource::Injection, &train.meshes[k].name),
                // It acts on a bus, between no members.
                Source::Standby(_) => continue,
            };
            all.push(DragReport {
                name: name.clone(),
                source,
                members: members(drag.members),
                torque_n_m: drag.torque,
                loss_w: *loss_w,
                contained_in: None,
            });
        }
        for (m, own) in flow.meshes.iter().zip(&step.meshes) {
            for (k, part) in &own.bearings {
                let mount = &train.bearings[*k];
                let relative = flow.speeds[mount.members[0].0] - flow.speeds[mount.members[1].0];
                let loss_w = m.potential_power * part;
                if relative != 0.0 && loss_w > 0.0 {
                    all.push(DragReport {
                        name: mount.name.clone(),
                        source: DragSource::Bearing,
                        members: members(mount.members),
                        torque_n_m: -loss_w / relative,
                        loss_w,
                        contained_in: Some(train.meshes[m.mesh.0].name.clone()),
                    });
                }
            }
        }
        all
    }

    /// Part of the potential power of each mesh that its teeth lose.
    pub fn tooth_loss(&self, step: &Step, mesh: usize, flow: &Flow) -> f64 {
        let m = &flow.meshes[mesh];
        let bearings: f64 = step.meshes[mesh].bearings.iter().map(|b| b.1).sum();
        (m.loss - m.potential_power * bearings).max(0.0)
    }
}
