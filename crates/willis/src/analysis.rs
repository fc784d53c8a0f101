//! The whole answer for a train: its shift table and its operating points, as one structure that
//! every front end shows.
//!
//! Serialised as JSON it is the results contract `willis-analysis-1`; fields are added, never
//! renamed. Units are SI and stand in the names.

mod at_load;
mod balance;
mod band;
mod doubts;
mod effort;
mod heat;
mod in_force;
mod loads;
mod losses;
mod margin;
mod operation;
mod outside;
mod rounds;
mod series;
mod shafts;
mod solution;
mod stiction;
mod table;
mod unit;
mod variators;
mod why;
mod words;

pub use at_load::{AskedLoad, AtLoad, DrivingLoad, idle};
pub use band::{BandEnd, FamilyBand, LawBand};
pub use doubts::{Doubt, DoubtKind};
pub use heat::{HeatBasis, HeatEquilibrium, HeatFlow, HeatPoint, HeatReport, PlaceReport};
pub(crate) use heat::{Losses as HeatOfLosses, NoHeat, placed as heat_placed};
pub use losses::{LossPoint, LossRequest, LossTable, Spread, losses};
pub use outside::{OutsideAt, OutsideLaw};
pub(crate) use series::{Ancestors, PointSeries, Told};
pub use series::{MemberNumbers, PointNumbers};
pub use shafts::{ShaftElement, ShaftMember, ShaftState, ShaftTable, ShaftTableRequest, shaft_table};
pub use variators::{MachineReport, VariatorReport};

pub use crate::power_flow::{BeyondLimit, LimitedQuantity};
pub use why::{TorqueRange, Why};

pub use crate::named::NameMap;
pub use in_force::frozen;
pub(crate) use in_force::in_force;
pub(crate) use operation::Point;
pub(crate) use unit::UnitPoint;
pub(crate) use words::named;

use serde::{Deserialize, Serialize};

use crate::contract::{Contract, Format};
use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::exact::Rational;
use crate::kinematics::Configuration;
use crate::operating_point::{BearingReport, ContactReport, Convergence, DragReport, LossKind, LossSource, ShaftLoad};
use crate::statics::Certificate;
use crate::train::{AS_DRAWN, Efficiency, MachineEfficiency, Operation, ShiftElementKind, Train};

/// What can be said of a load case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Verdict {
    /// Exactly one equilibrium.
    Unique,
    /// Several equilibria; the model cannot choose.
    Multiple,
    /// No equilibrium in which a load is driven: friction (or the kinematics) holds the train.
    Locked,
    /// Nothing is loaded.
    Unloaded,
    /// No determined answer: a speed is missing, constraints are redundant, uniqueness is undecided, or losses did not
    /// converge.
    Undetermined,
}

impl Verdict {
    /// For people: `several solutions`.
    pub fn words(self) -> &'static str {
        match self {
            Self::Unique => "unique",
            Self::Multiple => "several solutions",
            Self::Locked => "locked",
            Self::Unloaded => "unloaded",
            Self::Undetermined => "undetermined",
        }
    }
}

/// Whether the answer is the only one, and how that is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct CertificateReport {
    /// Whether exactly one solution exists whatever the loads (with these directions of motion).
    pub unique_for_every_load: bool,
    /// How that is known.
    pub method: Certificate,
}

impl From<Certificate> for CertificateReport {
    fn from(c: Certificate) -> Self {
        Self { unique_for_every_load: c.unique_for_every_load(), method: c }
    }
}

/// One direction of power through a state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Direction {
    /// What can be said of it.
    pub verdict: Verdict,
    /// Output over input power; absent unless the verdict is `unique`.
    pub efficiency: Option<f64>,
    /// The efficiency exactly, where the efficiencies of the meshes are given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub efficiency_exact: Option<Rational>,
    /// The efficiency of every equilibrium.
    pub efficiencies: Vec<f64>,
    /// Certificate, where a problem could be set up.
    pub certificate: Option<CertificateReport>,
    /// One sentence that explains a verdict other than `unique`.
    pub reason: Option<String>,
    /// What `reason` says, as data.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub why: Option<Why>,
}

/// A row of the shift table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct StateReport {
    /// Where power enters when driving.
    pub input: String,
    /// Where power leaves when driving.
    pub output: String,
    /// `ω_input/ω_output`, exactly; absent when there is no such number.
    pub exact: Option<Rational>,
    /// The same as a decimal.
    pub value: Option<f64>,
    /// Why there is no ratio.
    pub no_ratio: Option<String>,
    /// Ratio of this state over that of the next in the table, where both have the same sign.
    pub step: Option<f64>,
    /// Shift elements that are closed.
    pub engaged: Vec<String>,
    /// Degrees of freedom in this state.
    pub degrees_of_freedom: usize,
    /// Input drives output.
    pub drive: Direction,
    /// Output drives input.
    pub coast: Direction,
    /// Driving at the load that the file has for this input, where losses depend on load and [`Analysis::with_loads`] asked.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at_load: Option<Box<AtLoad>>,
}

/// What a member does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Role {
    /// External power enters.
    Input,
    /// External power leaves.
    Output,
    /// Held at rest.
    Fixed,
    /// No external power.
    Idle,
}

/// A member in an operating point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct MemberReport {
    /// Absolute speed (for a bevel planet: carrier speed plus spin), rad/s; absent when not
    /// determined.
    pub speed_rad_s: Option<f64>,
    /// The carrier it rides on, for a planet.
    pub carrier: Option<String>,
    /// Speed relative to that carrier, rad/s.
    pub relative_speed_rad_s: Option<f64>,
    /// External torque on it, N m; absent when statics cannot divide it.
    pub torque_n_m: Option<f64>,
    /// External power into it, W.
    pub power_w: Option<f64>,
    /// What it does.
    pub role: Role,
}

/// A mesh in an operating point; totals over its `count` pairs in parallel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct MeshReport {
    /// The member that drives, seen from the carrier; absent when idle or without relative motion.
    pub driver: Option<String>,
    /// Speed of the driver (else of the first gear) relative to the carrier, rad/s.
    pub relative_speed_rad_s: f64,
    /// Power of the driver seen from the carrier, W.
    pub potential_power_w: f64,
    /// Efficiency in force.
    pub efficiency: f64,
    /// Loss, W.
    pub loss_w: f64,
    /// Torque that the first gear puts into the mesh, N m.
    pub first_torque_n_m: f64,
    /// Torque that the second gear puts into the mesh, N m.
    pub second_torque_n_m: f64,
    /// Torque that the carrier puts into the mesh, N m.
    pub carrier_torque_n_m: f64,
    /// Identical pairs in parallel.
    pub count: u32,
}

/// An engaged shift element in an operating point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ShiftElementReport {
    /// What it is.
    pub kind: ShiftElementKind,
    /// The members it joins.
    pub members: [String; 2],
    /// Torque it exerts on its first member, N m; absent when statics cannot divide it.
    pub torque_n_m: Option<f64>,
}

/// Losses by kind, W.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Losses {
    /// Tooth friction.
    pub mesh: f64,
    /// Bearings.
    pub bearing: f64,
    /// Air and oil mist.
    pub windage: f64,
    /// Oil sump.
    pub churning: f64,
    /// Shaft seals.
    pub seal: f64,
    /// Drags that are given as torques.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub drag: f64,
    /// Open clutches and brakes.
    #[serde(default, skip_serializing_if = "is_zero", rename = "shift-element")]
    pub shift_element: f64,
    /// Oil that is sprayed into meshes.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub injection: f64,
    /// Oil pumps.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub pump: f64,
    /// Variators.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub variator: f64,
}

fn is_zero(x: &f64) -> bool {
    *x == 0.0
}

impl Losses {
    /// The names of the kinds, in the order of [`all`](Losses::all).
    pub const NAMES: [&'static str; 10] =
        ["mesh", "bearing", "windage", "churning", "seal", "drag", "shift-element", "injection", "pump", "variator"];

    /// The name of a kind as a column of tables: `shift_element_loss_w`.
    pub fn column(kind: usize) -> String {
        format!("{}_loss_w", Self::NAMES[kind].replace('-', "_"))
    }

    /// Which kinds a train can have: the first five always have a place.
    pub(crate) fn of_train(train: &Train) -> impl Iterator<Item = usize> + use<> {
        let has = [
            [true; 5].as_slice(),
            &[
                !train.drags.is_empty(),
                train.shift_elements.iter().any(|e| e.open.is_some()),
                train.meshes.iter().any(|m| m.teeth.as_ref().is_some_and(|t| t.jet.is_some())),
                !train.pumps.is_empty(),
                !train.variators.is_empty(),
            ],
        ]
        .concat();
        (0..has.len()).filter(move |k| has[*k])
    }

    /// Each of them, W.
    pub fn all(&self) -> [f64; 10] {
        let Self { mesh, bearing, windage, churning, seal, drag, shift_element, injection, pump, variator } = *self;
        [mesh, bearing, windage, churning, seal, drag, shift_element, injection, pump, variator]
    }

    fn add(&mut self, kind: LossKind, loss: f64) {
        *match kind {
            LossKind::Sliding | LossKind::Rolling => &mut self.mesh,
            LossKind::Bearing => &mut self.bearing,
            LossKind::Windage => &mut self.windage,
            LossKind::Churning => &mut self.churning,
            LossKind::Seal => &mut self.seal,
            LossKind::Drag => &mut self.drag,
            LossKind::ShiftElement => &mut self.shift_element,
            LossKind::Injection => &mut self.injection,
            LossKind::Pump => &mut self.pump,
            LossKind::Variator => &mut self.variator,
        } += loss;
    }
}

/// Power that goes round in circles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct CirculationReport {
    /// The power, W.
    pub power_w: f64,
    /// The power over the input power.
    pub share_of_input: f64,
    /// The shafts and sets it passes, in order.
    pub path: Vec<String>,
}

/// How far a solution is from a change.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Margin {
    /// The smallest change of a prescribed torque that unloads a mesh (and beyond which another
    /// loss formula holds).
    pub torque: Option<Boundary>,
    /// The smallest change of a prescribed speed that stops the relative motion in a mesh.
    pub speed: Option<Boundary>,
    /// The mesh (or set) whose efficiency is nearest to the value at which the train locks.
    pub lock: Option<LockMargin>,
    /// The factor on all losses `1 − η` of basic efficiencies, those of whole sets, at which the train locks.
    pub lock_loss_factor: Option<f64>,
}

/// A boundary of the region in which the present loss formula holds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Boundary {
    /// The member whose prescribed value moves.
    pub member: String,
    /// Its value now, SI.
    pub value: f64,
    /// Its value on the boundary, SI.
    pub boundary: f64,
    /// The mesh that is unloaded, or stops moving, there.
    pub mesh: String,
}

/// The nearest self-locking threshold of one efficiency.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct LockMargin {
    /// The mesh, or the meshes in a row that share one efficiency.
    pub meshes: Vec<String>,
    /// Their efficiency now.
    pub efficiency: f64,
    /// The efficiency at which the train locks.
    pub threshold: f64,
}

/// A torque range that friction in a mesh at rest leaves open.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct StictionRange {
    /// What varies, in words.
    pub what: String,
    /// What `what` says, as data.
    pub quantity: StictionQuantity,
    /// Smallest value; absent when too many meshes rest to bound it.
    pub low: Option<f64>,
    /// Largest value.
    pub high: Option<f64>,
}

/// What friction in a mesh at rest leaves open.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum StictionQuantity {
    /// The efficiency.
    Efficiency,
    /// The torque on a member, N m.
    Torque {
        /// The member.
        member: String,
    },
    /// Every torque behind loaded meshes at rest, too many to bound it.
    Unbounded {
        /// How many there are.
        meshes: usize,
    },
}

impl StictionRange {
    fn new(quantity: StictionQuantity, range: Option<(f64, f64)>) -> Self {
        Self { what: quantity.to_string(), quantity, low: range.map(|r| r.0), high: range.map(|r| r.1) }
    }
}

impl std::fmt::Display for StictionQuantity {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Efficiency => f.write_str("the efficiency"),
            Self::Torque { member } => write!(f, "the torque on {member} in N m"),
            Self::Unbounded { meshes } => {
                write!(f, "{meshes} loaded meshes at rest: too many to bound; any torque behind them")
            }
        }
    }
}

/// One equilibrium.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SolutionReport {
    /// Output over input power; 0 when everything is dissipated, absent when nothing is loaded.
    pub efficiency: Option<f64>,
    /// The efficiency exactly, where efficiencies, speeds and loads are known so: given efficiencies, speeds in one unit and
    /// torques or powers in one unit. Points of studies have it only where a sign hung on it.
    pub efficiency_exact: Option<Rational>,
    /// Whether every loaded member is an input.
    pub all_dissipated: bool,
    /// Power in, W.
    pub input_power_w: f64,
    /// Power out, W.
    pub output_power_w: f64,
    /// All losses, W.
    pub loss_w: f64,
    /// Input less output less losses, W.
    pub power_residual_w: f64,
    /// Every member but the frame.
    pub members: NameMap<MemberReport>,
    /// Every mesh.
    pub meshes: NameMap<MeshReport>,
    /// Every engaged shift element.
    pub shift_elements: NameMap<ShiftElementReport>,
    /// Every variator.
    #[serde(default, skip_serializing_if = "NameMap::is_empty")]
    pub variators: NameMap<VariatorReport>,
    /// Limits of variators that are exceeded.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub beyond_limits: Vec<BeyondLimit>,
    /// Losses by kind.
    pub losses_w: Losses,
    /// Losses by source, largest first, where they are computed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sources: Vec<LossSource>,
    /// Tooth contacts of the meshes whose teeth are given.
    #[serde(default, skip_serializing_if = "NameMap::is_empty")]
    pub contacts: NameMap<ContactReport>,
    /// Rolling bearings.
    #[serde(default, skip_serializing_if = "NameMap::is_empty")]
    pub bearings: NameMap<BearingReport>,
    /// Loads of the shafts that rest on these bearings.
    #[serde(default, skip_serializing_if = "NameMap::is_empty")]
    pub shaft_loads: NameMap<ShaftLoad>,
    /// Numbers that cannot be right, or for which something is missing.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub doubts: Vec<Doubt>,
    /// Drag torques between members, where losses are computed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub drags: Vec<DragReport>,
    /// How losses and torques were brought into agreement, where losses are computed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub convergence: Option<Convergence>,
    /// Recirculating powers.
    pub recirculation: Vec<CirculationReport>,
    /// Distance to the next change.
    pub margin: Margin,
    /// What friction in meshes at rest leaves open.
    pub stiction: Vec<StictionRange>,
}

impl SolutionReport {
    /// Every loss by its source, the largest first: [`sources`](Self::sources), and where efficiencies are given each mesh
    /// and variator with its own. Their sum is [`loss_w`](Self::loss_w).
    ///
    /// # Example
    /// ```
    /// use willis::analysis::{Selection, analyze};
    /// use willis::train::Train;
    ///
    /// let train = Train::from_toml(r#"
    ///     format = 1
    ///     name = "pair"
    ///     members = ["a", "b"]
    ///     terminals = ["a", "b"]
    ///     mesh = [{ name = "m", gears = [{ member = "a", teeth = 20 }, { member = "b", teeth = 30 }], efficiency = 0.99 }]
    ///     operation = [{ name = "o", speeds = { a = "100 rad/s" }, torques = { a = "10 N m" } }]
    /// "#)?;
    /// let all = analyze(&train, &Selection::default())?.operations[0].solutions[0].losses_by_source();
    /// assert_eq!((all.len(), all[0].name.as_str()), (1, "m"));
    /// assert!((all[0].loss_w - 10.0).abs() < 1e-9);
    /// # Ok::<(), willis::Diagnostics>(())
    /// ```
    pub fn losses_by_source(&self) -> Vec<LossSource> {
        if !self.sources.is_empty() {
            return self.sources.clone();
        }
        let meshes = self.meshes.iter().map(|(name, m)| (name, LossKind::Sliding, m.loss_w));
        let variators = self.variators.iter().map(|(name, v)| (name, LossKind::Variator, v.loss_w));
        let given = |(name, kind, loss_w): (&String, LossKind, f64)| LossSource {
            name: name.clone(),
            kind,
            law: "given".to_owned(),
            loss_w,
            share: if self.loss_w > 0.0 { loss_w / self.loss_w } else { 0.0 },
        };
        let mut all: Vec<LossSource> = meshes.chain(variators).filter(|x| x.2 != 0.0).map(given).collect();
        all.sort_by(|a, b| b.loss_w.total_cmp(&a.loss_w));
        all
    }
}

/// An operating point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct OperationReport {
    /// Its name.
    pub name: String,
    /// The state of the shift table.
    pub state: Option<String>,
    /// Degrees of freedom with its elements engaged and members held.
    pub degrees_of_freedom: usize,
    /// What can be said of it.
    pub verdict: Verdict,
    /// Certificate, where a problem could be set up.
    pub certificate: Option<CertificateReport>,
    /// One sentence that explains the verdict.
    pub reason: Option<String>,
    /// What `reason` says, as data.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub why: Option<Why>,
    /// Laws that were used outside their ranges.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub outside_laws: Vec<OutsideLaw>,
    /// Where prescribed speeds contradict the gears the most, within the tolerance that was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed_deviation: Option<SpeedDeviation>,
    /// Speeds, also when the torques have no answer; rad/s.
    pub speeds_rad_s: NameMap<Option<f64>>,
    /// Temperatures and heat, where the train says what carries heat away.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub heat: Option<Box<HeatReport>>,
    /// Between which values other laws put the efficiency, where [`Analysis::with_bands`] asked.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub band: Option<Box<LawBand>>,
    /// Every equilibrium that drives a load (or, with two or more freedoms, any equilibrium).
    pub solutions: Vec<SolutionReport>,
    /// Of a locked train: equilibria in which every loaded member must push.
    pub dissipative_solutions: Vec<SolutionReport>,
}

/// Prescribed speeds that contradict the gears within the tolerance that was asked for
/// ([`Train::with_speed_tolerance`]).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SpeedDeviation {
    /// The members that the gears tie together, in the order in which their speeds were given. The last one follows the
    /// others.
    pub members: Vec<String>,
    /// By which part of the largest of their speeds, as the gears tie them, they contradict each other.
    pub relative: f64,
}

impl OperationReport {
    /// Oil temperature that was in force, K: of the heat balance, else the one that was prescribed, else that of the oil.
    pub fn oil_k(&self, train: &Train, operation: &Operation) -> Option<f64> {
        let balance = self.heat.as_ref().map(|h| h.oil_k);
        balance.or_else(|| train.lubrication.as_ref().map(|l| operation.temperature.unwrap_or(l.temperature)))
    }

    /// The verdict for people. An equilibrium that is the only one but for the friction of loaded meshes at rest, which may
    /// be anything up to its limit, is called so; what that leaves open is in `stiction`.
    pub fn verdict_words(&self) -> &'static str {
        match self.verdict {
            Verdict::Unique if self.solutions.iter().any(|s| !s.stiction.is_empty()) => "unique up to friction at rest",
            verdict => verdict.words(),
        }
    }

    /// An operating point before anything but its speeds is known.
    fn new(train: &Train, operation: &Operation, freedoms: usize, speeds: NameMap<Option<f64>>) -> Self {
        Self {
            name: operation.name.clone(),
            state: operation.state.map(|k| train.states[k].name.clone()),
            degrees_of_freedom: freedoms,
            verdict: Verdict::Undetermined,
            certificate: None,
            reason: None,
            why: None,
            outside_laws: vec![],
            speed_deviation: None,
            speeds_rad_s: speeds,
            heat: None,
            band: None,
            solutions: vec![],
            dissipative_solutions: vec![],
        }
    }

    fn explain(&mut self, why: &Why) {
        self.reason = Some(why.to_string());
        self.why = Some(why.clone());
    }
}

/// Everything that is known about a train.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Analysis {
    /// `willis-analysis-1`.
    pub format: Format<Self>,
    /// Name of the train.
    pub train: String,
    /// Source of its data.
    pub source: Option<String>,
    /// Degrees of freedom as drawn, no shift element engaged.
    pub degrees_of_freedom: usize,
    /// The shift table, or one row `as drawn`.
    pub ratios: NameMap<StateReport>,
    /// The operating points.
    pub operations: Vec<OperationReport>,
    /// What stands in for data that were not given, and what the model leaves out.
    pub assumptions: Vec<String>,
    /// Warnings and notes.
    pub diagnostics: Vec<Diagnostic>,
}

impl Contract for Analysis {
    const FORMAT: &'static str = "willis-analysis-1";
}

impl Analysis {
    /// The same with what every gear costs at the load that the file has for its input, and with none: [`StateReport::at_load`],
    /// where losses depend on load. It takes two operating points a gear more.
    ///
    /// # Example
    /// ```
    /// use willis::analysis::{Selection, analyze};
    /// use willis::train::Train;
    ///
    /// let train = Train::from_toml(r#"
    ///     format = 1
    ///     name = "one set"
    ///     members = ["s", "c"]
    ///     terminals = ["s", "c"]
    ///     [[set]]
    ///     name = "P1"
    ///     sun = { member = "s", teeth = 30 }
    ///     ring = { member = "frame", teeth = 70 }
    ///     carrier = "c"
    ///     mesh_efficiency = 1.0
    ///     [[drag]]
    ///     name = "seal"
    ///     members = ["s", "frame"]
    ///     coulomb = "0.2 N m"
    ///     [[operation]]
    ///     name = "full load"
    ///     speeds = { s = "1000 rpm" }
    ///     torques = { s = "10 N m" }
    /// "#)?;
    /// let analysis = analyze(&train, &Selection::default())?.with_loads(&train);
    /// let gear = analysis.ratios.get("as drawn").unwrap().at_load.as_ref().unwrap();
    /// assert!((gear.efficiency.unwrap() - 0.98).abs() < 1e-9);
    /// # Ok::<(), willis::Diagnostics>(())
    /// ```
    pub fn with_loads(mut self, train: &Train) -> Self {
        let asked = AskedLoad::default();
        // Nothing is asked for, so nothing of it is wrong.
        if let Ok(mut loads) = at_load::Loads::new(train, &asked) {
            for (name, row) in &mut self.ratios.0 {
                row.at_load = loads.at(train.states.iter().position(|s| s.name == *name));
            }
        }
        self
    }

    /// The same with what other laws of loss make of every efficiency that laws compute: [`OperationReport::band`], and
    /// [`AtLoad::band`] of gears at a load. It takes some twenty operating points in floating point each.
    ///
    /// An example is at [`LawBand::decimals`].
    pub fn with_bands(mut self, train: &Train) -> Self {
        for report in &mut self.operations {
            let Ok(operation) = train.find_operation(&report.name) else { continue };
            let temperature = report.oil_k(train, operation);
            report.band = LawBand::of(train, &Operation { temperature, ..operation.clone() }).map(Box::new);
        }
        for (name, row) in &mut self.ratios.0 {
            let Some(at) = &mut row.at_load else { continue };
            // Where the operation whose load it is runs in this gear, it is the same point.
            let own = |o: &&OperationReport| {
                at.operation.as_ref() == Some(&o.name) && o.state.as_deref().unwrap_or(AS_DRAWN) == *name
            };
            at.band = match self.operations.iter().find(own) {
                Some(operation) => operation.band.clone(),
                None => at.law_band(train, train.states.iter().position(|s| s.name == *name)).map(Box::new),
            };
        }
        self
    }

    /// Warnings of gears at load, each once, but of those in which the operation itself runs: its warnings are among the
    /// [diagnostics](Self::diagnostics).
    pub fn warnings_at_load(&self) -> Vec<&str> {
        let runs = |state: &str, at: &AtLoad| {
            let own = |o: &OperationReport| {
                at.operation.as_ref() == Some(&o.name) && o.state.as_deref().unwrap_or(AS_DRAWN) == state
            };
            self.operations.iter().any(own)
        };
        let all = self.ratios.iter().filter_map(|(state, row)| Some((state, row.at_load.as_deref()?)));
        AtLoad::warnings_of(all.filter(|(state, at)| !runs(state, at)).map(|(_, at)| at))
    }
}

/// Which states and operations to analyse; `None` means all.
#[derive(Clone, Debug, Default)]
pub struct Selection {
    /// Only this state, and only operations in it.
    pub state: Option<String>,
    /// Only this operation.
    pub operation: Option<String>,
}

/// Analyses a train: every state of its shift table and every operation.
///
/// # Errors
/// Operations that cannot be answered because of what they prescribe (contradictory speeds, loads
/// missing or too many), and a selection that matches nothing. All of them at once.
///
/// # Example
/// ```
/// use willis::analysis::{analyze, Selection, Verdict};
/// use willis::exact::Rational;
/// use willis::train::Train;
///
/// let train = Train::from_toml(r#"
///     format = 1
///     name = "one set"
///     members = ["s", "c"]
///     terminals = ["s", "c"]
///     [[set]]
///     name = "P1"
///     sun = { member = "s", teeth = 30 }
///     planet = { teeth = 20, count = 4 }
///     ring = { member = "frame", teeth = 70 }
///     carrier = "c"
///     mesh_efficiency = 0.99
///     [[operation]]
///     name = "full load"
///     speeds = { s = "1000 rpm" }
///     torques = { s = "10 N m" }
/// "#)?;
/// let analysis = analyze(&train, &Selection::default())?;
/// let row = analysis.ratios.get("as drawn").unwrap();
/// assert_eq!(row.exact, Some(Rational::new(10, 3)));
/// let load = &analysis.operations[0];
/// assert_eq!(load.verdict, Verdict::Unique);
/// assert!(load.certificate.unwrap().unique_for_every_load);
/// // (1 − i0 η)/(1 − i0) with i0 = −7/3, η = 0.99²
/// assert!((load.solutions[0].efficiency.unwrap() - 0.98607).abs() < 1e-9);
/// # Ok::<(), willis::diagnostic::Diagnostics>(())
/// ```
pub fn analyze(train: &Train, selection: &Selection) -> Result<Analysis, Diagnostics> {
    selection.check(train)?;
    let mut errors = Diagnostics::default();
    let mut diagnostics: Diagnostics = Diagnostics::default();
    diagnostics.extend(train.warnings.iter().cloned());
    let mut ratios = NameMap::default();
    if train.states.is_empty()
        && let Some(row) = table::row(train, None, &[], AS_DRAWN, &mut diagnostics)
    {
        ratios.0.push((AS_DRAWN.to_owned(), row));
    }
    for (k, state) in train.states.iter().enumerate() {
        if selection.state.as_ref().is_some_and(|s| *s != state.name) {
            continue;
        }
        if let Some(row) = table::row(train, Some(k), &state.engaged, &state.name, &mut diagnostics) {
            ratios.0.push((state.name.clone(), row));
        }
    }
    table::steps(&mut ratios);
    let mut operations = Vec::new();
    for operation in &train.operations {
        if !selection.wants(train, operation) {
            continue;
        }
        match operate(train, operation) {
            Ok((report, notes)) => {
                operations.push(report);
                diagnostics.extend(notes);
            }
            Err(wrong) => errors.extend(wrong),
        }
    }
    if errors.has_errors() {
        return Err(errors);
    }
    if train.states.is_empty() && ratios.is_empty() {
        let text = match (train.input, train.output) {
            (Some(i), Some(o)) if i == o => format!("`{}` is both input and output: no ratio", train.member_name(i)),
            _ => "no terminals are named, so there is no input and output and no ratio".to_owned(),
        };
        let hint = "name two `terminals`, or `input` and `output`";
        diagnostics.push(Diagnostic::new(Code::NothingAsked, "", text).hint(hint));
    }
    let degrees_of_freedom = Configuration::new(train, &[], &[], &[]).degrees_of_freedom();
    Ok(Analysis {
        format: Format::new(),
        train: train.name.clone(),
        source: train.source.clone(),
        degrees_of_freedom,
        ratios,
        operations,
        assumptions: assumptions(train),
        diagnostics: diagnostics.into_iter().collect(),
    })
}

impl Selection {
    /// Whether the train has what is selected.
    pub(crate) fn check(&self, train: &Train) -> Result<(), Diagnostics> {
        let mut errors = Diagnostics::default();
        if let Some(Err(d)) = self.state.as_ref().map(|name| train.find_state(name)) {
            errors.push(*d);
        }
        if let Some(Err(d)) = self.operation.as_ref().map(|name| train.find_operation(name)) {
            errors.push(*d);
        }
        if let (Some(state), Some(name), false) = (&self.state, &self.operation, errors.has_errors()) {
            let operation = train.operations.iter().find(|o| o.name == *name);
            let own = operation.and_then(|o| o.state).map(|k| train.states[k].name.as_str());
            if own != Some(state) {
                let runs = own.map_or("the train as drawn".to_owned(), |own| format!("state `{own}`"));
                let text = format!("the operation `{name}` runs in {runs}, not in state `{state}`");
                errors.push(Diagnostic::new(Code::UnknownSelection, "", text).hint("leave out one of the two"));
            }
        }
        if errors.has_errors() { Err(errors) } else { Ok(()) }
    }

    /// Whether an operation is among what is selected.
    pub(crate) fn wants(&self, train: &Train, operation: &Operation) -> bool {
        let state = operation.state.map(|k| &train.states[k].name);
        self.operation.as_ref().is_none_or(|o| *o == operation.name)
            && self.state.as_ref().is_none_or(|s| Some(s) == state)
    }
}

/// An operation at the temperature that it prescribes, or else that of the heat balance, or else that of the oil.
fn at_its_temperature<'t>(
    train: &'t Train,
    operation: &Operation,
    exactly: bool,
) -> Result<operation::Settled<'t>, Vec<words::Refusal>> {
    match &train.heat {
        Some(network) => heat::settle(train, network, operation, exactly),
        None => operation::settle_at(train, operation, exactly),
    }
}

/// An operation with its equilibrium where there is exactly one.
pub(crate) fn settle<'t>(
    train: &'t Train,
    operation: &Operation,
) -> Result<(OperationReport, Option<Point<'t>>, Diagnostics), Diagnostics> {
    let settled = at_its_temperature(train, operation, true);
    let settled = settled.map_err(|wrong| words::named(operation, words::refused(train, operation, &wrong)))?;
    let notes = words::named(operation, words::found(train, operation, &settled.findings));
    Ok((settled.report, settled.point, notes))
}

/// Analyses one operating point that need not stand in the file; [`analyze`] says the same of one that does. Beside
/// the answer, its warnings and notes.
///
/// # Errors
/// What the operation prescribes makes no question: contradictory speeds, loads missing or too many.
pub fn operate(train: &Train, operation: &Operation) -> Result<(OperationReport, Diagnostics), Diagnostics> {
    settle(train, operation).map(|(report, _, notes)| (report, notes))
}

/// The same with warnings, notes and errors that do not name the operation, for one of many points that are told
/// apart otherwise.
///
/// # Errors
/// As [`operate`].
pub fn operate_unnamed(train: &Train, operation: &Operation) -> Result<(OperationReport, Diagnostics), Diagnostics> {
    let settled =
        at_its_temperature(train, operation, false).map_err(|wrong| words::refused(train, operation, &wrong))?;
    Ok((settled.report, words::found(train, operation, &settled.findings)))
}

/// Between which values other laws put the efficiency of an operating point; `None` where none changes it.
pub(crate) fn law_band(train: &Train, operation: &Operation) -> Option<LawBand> {
    if !train.depends_on_load() {
        return None;
    }
    let (report, _) = operate_unnamed(train, operation).ok()?;
    LawBand::of(train, &Operation { temperature: report.oil_k(train, operation), ..operation.clone() })
}

/// What the model leaves out, then what stands in for missing data.
pub fn assumptions(train: &Train) -> Vec<String> {
    let mut all = vec!["steady state: no inertia".to_owned()];
    all.extend(assumptions_in_motion(train, false));
    all
}

/// The same of a model in motion, in which inertias count; `elastic`: what lies behind elastic shafts too.
pub(crate) fn assumptions_in_motion(train: &Train, elastic: bool) -> Vec<String> {
    let mut all = vec![];
    if train.meshes.iter().any(|m| !m.computed && m.efficiency != Efficiency::lossless()) {
        all.push("given mesh efficiencies are constants: independent of load, speed and temperature".into());
    }
    if train.has_laws() {
        physical_assumptions(train, &mut all);
        all.extend(not_counted(train, None));
    } else {
        all.extend(not_counted(train, Some("no bearing, windage, churning or seal losses")));
    }
    if !train.drags.is_empty() {
        all.push("given drags act wherever their members turn against each other; at rest they may hold a load".into());
        let beyond = train.drags.iter().filter(|d| !elastic && d.members.iter().any(|m| !train.is_within(*m)));
        all.extend(beyond.map(|d| format!("{}: it acts behind an elastic shaft and does not count here", d.name)));
    }
    for v in &train.variators {
        let constant = !v.machines().iter().any(|m| matches!(m.efficiency, MachineEfficiency::Map(_)));
        if constant {
            all.push(format!("{}: its efficiency is the same at any speed, torque and ratio", v.name));
        }
    }
    if !train.variators.is_empty() {
        all.push("the table of ratios is that of the gears alone, without variators".into());
    }
    let factor = train.meshes.iter().map(crate::train::Mesh::sharing).fold(1.0, f64::max);
    if factor > 1.0 {
        all.push(format!(
            "of parallel planets one bears up to {factor} times the mean load: pressures, films and loads of planet bearings \
             are its own, losses follow the mean"
        ));
    } else if train.meshes.iter().any(|m| m.count > 1) {
        all.push("parallel planets share the load equally".into());
    }
    all.extend(train.assumptions.iter().cloned());
    all
}

/// What the losses rest on: what is not counted, and the laws in force.
fn physical_assumptions(train: &Train, all: &mut Vec<String>) {
    if train.meshes.iter().any(|m| m.computed) {
        let default = crate::losses::mesh_friction::Constant::DEFAULT.mu;
        let mu = train.laws.friction_coefficient.unwrap_or(default);
        all.push(format!(
            "tooth friction is computed in operations and at the load of the table of ratios; regimes and formulas hold it as it \
             is at one such load; nominal efficiencies use a coefficient of {mu}"
        ));
        let law = train.laws.mesh_friction(train.lubrication.is_some());
        all.push(format!(
            "tooth friction by `{}`, loss factor `{}`",
            law.meta().id,
            train.laws.loss_factor(&law).meta().id
        ));
    }
    if !train.bearings.is_empty() {
        let law = train.laws.bearing.meta().id;
        all.push(format!("bearing friction by `{law}`; equally spaced planets load central bearings only axially"));
    }
    let supply = train.lubrication.as_ref().and_then(|l| l.supply);
    use crate::train::OilSupply::{Bath, Grease, Jet, Mist};
    let shallow =
        |b: &crate::train::BearingMount| b.level.is_none() && matches!(b.supply.or(supply), None | Some(Bath));
    let skf = matches!(train.laws.bearing.meta().id, "skf" | "skf-6000");
    let without: Vec<&str> =
        train.bearings.iter().filter(|b| skf && b.bearing.skf.is_none()).map(|b| b.name.as_str()).collect();
    if !without.is_empty() {
        all.push(format!("{}: no constants of the SKF model, `palmgren` stands in", without.join(", ")));
    }
    // Teeth whose forces on bearings are not worked out.
    let silent = |m: &&crate::train::Mesh| m.teeth.as_ref().is_none_or(|t| t.cones.is_some());
    let beside = |b: &&crate::train::BearingMount| {
        let gear = |m: &crate::train::Mesh| {
            m.gears.iter().any(|g| b.members.contains(&g.member) && g.member != crate::train::FRAME)
        };
        b.radial_load == 0.0 && b.axial_load == 0.0 && train.meshes.iter().filter(silent).any(gear)
    };
    let unloaded: Vec<&str> = train.bearings.iter().filter(beside).map(|b| b.name.as_str()).collect();
    if !unloaded.is_empty() {
        all.push(format!(
            "{}: no load by bevel teeth, or by a mesh whose geometry is not given: give `radial_load`",
            unloaded.join(", ")
        ));
    }
    if train.bearings.iter().any(shallow) {
        all.push("bearings without an oil level: a low bath, no drag of oil".into());
    }
    let dips = |m: &crate::train::Mesh| {
        let planet = |k: usize| train.members[m.gears[k].member.0].kind == crate::train::MemberKind::Planet;
        m.teeth.as_ref().is_some_and(|t| (0..2).any(|k| t.immersion[k].is_some() && planet(k)))
    };
    if train.meshes.iter().any(dips) {
        all.push(
            "planets that dip run through a ring of oil that turns with their carrier: an estimate, good to ±50 %"
                .into(),
        );
    }
    let mut missing = Vec::new();
    if train.bearings.is_empty() {
        missing.push("bearings");
    }
    if train.seals.is_empty() {
        missing.push("seals");
    }
    if !missing.is_empty() {
        all.push(format!("no {} given: their losses are not counted", missing.join(" and ")));
    }
    all.push(match supply {
        None => "how the oil is supplied is not given: gears in air or oil lose nothing".into(),
        Some(Jet | Mist) => {
            let law = train.laws.windage.meta().id;
            let fluid = surroundings(train);
            format!("gears turn in {fluid}: windage by `{law}`, rings as discs, planets relative to their carrier")
        }
        Some(Bath) => format!("churning by `{}` of the gears whose immersion is given", train.laws.churning.meta().id),
        Some(Grease) => "grease: gears in air lose nothing".into(),
    });
    if !train.rotors.is_empty() {
        let law = train.laws.rotor_drag.meta().id;
        let misty = train.rotors.iter().any(|r| r.fluid == crate::train::Fluid::Mist);
        let fluid = if misty { format!(" in {}, as the gears", surroundings(train)) } else { String::new() };
        all.push(format!("drag of carriers and drums{fluid} by `{law}`: an estimate, good to ±50 %"));
    } else if train.sets.iter().any(|s| s.planets.is_some()) {
        all.push("no drag of carriers (give a [[rotor]])".into());
    }
}

/// What gears and rotors turn in, in words.
fn surroundings(train: &Train) -> String {
    let given = train.lubrication.as_ref().and_then(|l| l.mist);
    match (given, train.laws.windage.air_per_oil()) {
        (Some(parts), _) => format!("a mist of {parts} parts of air to one of oil"),
        (None, Some(parts)) => format!("a mist of {parts} parts of air to one of oil, as the law was measured"),
        (None, None) => "air, as no `mist` is given".to_owned(),
    }
}

/// What of the losses without load the train file does not describe, behind what else is said of that.
fn not_counted(train: &Train, before: Option<&str>) -> Option<String> {
    let (known, unknown): (Vec<_>, Vec<_>) = train.shift_elements.iter().partition(|e| e.open.is_some());
    let names: Vec<&str> = unknown.iter().map(|e| e.name.as_str()).collect();
    let elements = match (known.is_empty(), names.is_empty()) {
        (true, _) => Some("no drag of open shift elements".to_owned()),
        (false, false) => Some(format!("no drag of {} while open", names.join(", "))),
        (false, true) => None,
    };
    let pump = (train.has_laws() && train.pumps.is_empty()).then(|| "no oil pump".to_owned());
    let said: Vec<String> = before.map(str::to_owned).into_iter().chain(elements).chain(pump).collect();
    (!said.is_empty()).then(|| said.join(", "))
}
