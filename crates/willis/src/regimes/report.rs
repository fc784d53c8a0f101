//! The results contract of the regimes, `willis-regimes-1`.

use serde::{Deserialize, Serialize};

use crate::analysis::{NameMap, Role};
use crate::contract::{Contract, Format};
use crate::exact::Rational;

use super::basis::EfficiencyBasis;
use super::setup::Pattern;

/// All regimes of a train.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Regimes {
    /// `willis-regimes-1`.
    pub format: Format<Self>,
    /// Name of the train.
    pub train: String,
    /// One for each state asked for.
    pub states: Vec<Atlas>,
}

impl Contract for Regimes {
    const FORMAT: &'static str = "willis-regimes-1";
}

/// The regimes of one state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Atlas {
    /// Name of the state, or `as drawn`.
    pub state: String,
    /// Degrees of freedom.
    pub degrees_of_freedom: usize,
    /// Members on which a torque acts.
    pub terminals: Vec<String>,
    /// Terminals that are held: they take torque, but no power.
    pub held: Vec<String>,
    /// Independent terminal torques.
    pub independent_torques: usize,
    /// Terminals whose speeds settle all others.
    pub base_speeds: Vec<String>,
    /// Why there is nothing to list.
    pub reason: Option<String>,
    /// What the formulas' symbols stand for.
    pub symbols: NameMap<SymbolReport>,
    /// The planes that cut the speed space.
    pub planes: Vec<PlaneReport>,
    /// The regions of speed, in order around the circle for two freedoms.
    pub regions: Vec<RegionReport>,
    /// The regimes.
    pub regimes: Vec<RegimeReport>,
    /// Their formulas, each once.
    pub formulas: Vec<FormulaReport>,
    /// The boundaries between neighbouring regions (two freedoms).
    pub boundaries: Vec<BoundaryReport>,
    /// Every assignment of inputs and outputs, and whether it can be reached.
    pub assignments: Vec<AssignmentReport>,
    /// Where mesh efficiencies come from whose losses laws compute; absent where all are given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub efficiency_basis: Option<EfficiencyBasis>,
    /// Elements without loss: it does not matter who drives them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub lossless: Vec<String>,
    /// Terminals through which power runs beside the gears: the sides of a variator, or two that were asked to balance.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub link: Option<LinkReport>,
    /// What else a reader must know.
    pub notes: Vec<String>,
}

/// A way for power beside the gears.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct LinkReport {
    /// The variator; absent where two terminals were asked to balance.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub variator: Option<String>,
    /// Its two ends, among the terminals; they are no inputs or outputs.
    pub ends: [String; 2],
    /// From the first end to the second, and back.
    pub efficiency: [f64; 2],
}

/// A symbol of the formulas.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SymbolReport {
    /// Value in this train, for ratios and efficiencies.
    pub value: Option<f64>,
    /// The same, exactly.
    pub exact: Option<Rational>,
    /// What it stands for, in words.
    pub meaning: String,
    /// In LaTeX.
    pub latex: String,
}

/// A plane through the origin of the speed space.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct PlaneReport {
    /// What is the case on it: `sun1 at rest`.
    pub label: String,
    /// Terminals at rest on it.
    pub at_rest: Vec<String>,
    /// Elements without relative motion on it.
    pub without_relative_motion: Vec<String>,
    /// Coefficients of the base speeds.
    pub form: Vec<f64>,
    #[serde(skip)]
    pub(crate) exact: Vec<Rational>,
}

/// A region of speeds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct RegionReport {
    /// Its number, from 1.
    pub number: usize,
    /// The order of the speeds, one chain for each element: `w_4 > w_1 > 0 > w_2`.
    pub order: Vec<String>,
    /// The side of each plane it lies on.
    pub signs: Vec<i8>,
    /// Speeds inside it, by terminal.
    pub example: NameMap<f64>,
    /// Two freedoms: the two directions (in base speeds) that bound it, counterclockwise.
    pub from: Option<[f64; 2]>,
    /// See `from`.
    pub to: Option<[f64; 2]>,
    /// Two freedoms, and no sign change of the first base speed inside: bounds of second over
    /// first base speed; absent means infinite.
    pub ratio: Option<RatioRange>,
    /// Planes that bound it.
    pub bounded_by: Vec<String>,
    /// The region of all opposite speeds.
    pub opposite: usize,
    /// One independent torque: which regimes answer a torque prescribed on each terminal.
    pub prescribed: Vec<Prescribed>,
    #[serde(skip)]
    pub(crate) point: Vec<Rational>,
    #[serde(skip)]
    pub(crate) rays: Option<[Vec<Rational>; 2]>,
}

/// An interval of a speed ratio.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct RatioRange {
    /// The quotient, such as `w_ring/w_engine`.
    pub of: String,
    /// Sign of the denominator.
    pub denominator_sign: i8,
    /// Lower bound.
    pub low: Option<f64>,
    /// Upper bound.
    pub high: Option<f64>,
}

/// What a torque prescribed on one terminal leads to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Prescribed {
    /// The terminal.
    pub terminal: String,
    /// Regimes with a positive torque on it.
    pub positive: Vec<String>,
    /// Regimes with a negative torque on it.
    pub negative: Vec<String>,
}

/// One regime.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct RegimeReport {
    /// Its name: number of the region, and the torque cell (`+` or `-` for the sign of the first
    /// torque that is not zero, else a number).
    pub id: String,
    /// Number of the region of speeds.
    pub region: usize,
    /// Sign of each terminal's torque.
    pub torque_signs: NameMap<i8>,
    /// What each terminal does.
    pub roles: NameMap<Role>,
    /// Terminals where power enters.
    pub inputs: Vec<String>,
    /// Terminals where power leaves.
    pub outputs: Vec<String>,
    /// Which end drives each element, seen from its carrier; absent when it carries no load or has
    /// no relative motion or loss.
    pub drivers: NameMap<Option<String>>,
    /// Name of its formula.
    pub formula: String,
    /// Efficiencies between which it lies: the limits on the two bounding directions (two
    /// freedoms), or twice the same number (one freedom).
    pub efficiency_range: Option<[f64; 2]>,
    /// An operating point inside.
    pub example: ExamplePoint,
    /// The regime with all speeds and torques reversed.
    pub mirror: String,
    /// Without friction no torques of these signs exist here: friction has turned one round.
    pub by_friction_only: bool,
    /// Every loaded terminal is an input.
    pub all_dissipated: bool,
    /// Regimes across each bounding plane whose torques have the same signs.
    pub neighbours: Vec<Neighbour>,
    #[serde(skip)]
    pub(crate) pattern: Pattern,
    #[serde(skip)]
    pub(crate) torques: Vec<Rational>,
    #[serde(skip)]
    pub(crate) power_signs: Vec<i8>,
}

/// An operating point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ExamplePoint {
    /// Speeds by terminal, in any unit.
    pub speeds: NameMap<f64>,
    /// Torques by terminal, in any unit.
    pub torques: NameMap<f64>,
    /// Efficiency there; zero when all is dissipated.
    pub efficiency: f64,
    /// The same, exactly.
    pub efficiency_exact: Rational,
}

/// A regime across a plane.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Neighbour {
    /// The plane between.
    pub plane: String,
    /// The regime there.
    pub regime: String,
}

/// A closed formula.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct FormulaReport {
    /// Its name, `F1`.
    pub id: String,
    /// Inputs and outputs it belongs to.
    pub roles: String,
    /// Drivers it belongs to.
    pub drivers: String,
    /// Output over input power.
    pub efficiency: String,
    /// The same by the losses over the power of the only input or output, where there is one.
    pub efficiency_by_loss: Option<String>,
    /// The first in LaTeX.
    pub efficiency_latex: String,
    /// Power lost, as a sum over the elements that drive.
    pub loss: String,
    /// Torques of the terminals.
    pub torques: NameMap<String>,
    /// Positive throughout the regimes, and nowhere else.
    pub conditions: Vec<ConditionReport>,
    /// Where basic ratios and efficiencies must lie for the torques to have these signs.
    pub holds_for: Vec<Threshold>,
    /// Regimes in which it holds.
    pub regimes: Vec<String>,
}

/// A condition of a formula.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ConditionReport {
    /// An expression that must be positive.
    pub positive: String,
    /// What it ensures.
    pub meaning: String,
}

/// The open interval of one ratio or efficiency in which the torque signs of a formula hold, all
/// others as they are.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Threshold {
    /// The symbol.
    pub symbol: String,
    /// Its value.
    pub value: f64,
    /// Lower bound; absent when there is none.
    pub low: Option<f64>,
    /// Upper bound; absent when there is none.
    pub high: Option<f64>,
}

/// The boundary between two neighbouring regions of a train with two freedoms.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct BoundaryReport {
    /// What is the case on it.
    pub label: String,
    /// Direction, in base speeds.
    pub direction: [f64; 2],
    /// Speeds on it, by terminal.
    pub speeds: NameMap<f64>,
    /// Regions on its two sides, counterclockwise.
    pub between: [usize; 2],
    /// What happens to each torque cell.
    pub crossings: Vec<Crossing>,
}

/// A regime's passage over a boundary.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Crossing {
    /// Regime before.
    pub from: String,
    /// Regime after.
    pub to: String,
    /// Limit of the efficiency, coming from before.
    pub efficiency_before: Option<f64>,
    /// The same, exactly.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub efficiency_before_exact: Option<Rational>,
    /// Limit of the efficiency, coming from after.
    pub efficiency_after: Option<f64>,
    /// The same, exactly.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub efficiency_after_exact: Option<Rational>,
    /// What changes, in words.
    pub changes: Vec<String>,
}

/// An assignment of inputs and outputs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct AssignmentReport {
    /// Terminals where power enters.
    pub inputs: Vec<String>,
    /// Terminals where power leaves.
    pub outputs: Vec<String>,
    /// Regimes that realise it; none when it cannot be reached.
    pub regimes: Vec<String>,
    /// How it is reached, or why not.
    pub reach: Reach,
}

/// Whether an assignment of inputs and outputs is reached; a sentence in answers for machines.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub enum Reach {
    /// It is reached.
    #[serde(rename = "reached")]
    Reached,
    /// Only where friction turns a torque round, although without friction it exists too.
    #[serde(rename = "reached where friction turns a torque round, and nowhere else")]
    WhereFrictionTurns,
    /// Only because friction turns a torque round.
    #[serde(rename = "only because friction turns a torque round")]
    ByFrictionOnly,
    /// All inputs, and reached.
    #[serde(rename = "reached: friction takes everything")]
    Dissipated,
    /// All inputs, and not reached.
    #[serde(rename = "cannot be reached: friction never takes everything")]
    NeverDissipated,
    /// Not reached, although without friction it exists.
    #[serde(rename = "cannot be reached: friction prevents it (without losses it exists)")]
    PreventedByFriction,
    /// Not reached, friction or not.
    #[serde(rename = "cannot be reached: speeds and torques never have these signs together")]
    Never,
}

impl std::fmt::Display for Reach {
    /// The sentence.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        // The names under which it is serialised are the sentences.
        self.serialize(f)
    }
}
