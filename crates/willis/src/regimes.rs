//! Every way in which a train can run, and the closed formula for each.
//!
//! The speeds of a train with `d` freedoms are a `d`-dimensional space. The planes on which a
//! terminal is at rest, or a mesh has no relative motion, cut it into *regions*; within a region no
//! power changes its sign by speed and no relative speed does. In each region every choice of
//! drivers leaves a space of torques in equilibrium, cut in turn by the planes on which a tooth
//! force or a terminal torque is zero. A *regime* is one cell of both: its inputs, its outputs, its
//! drivers and so its efficiency formula are fixed throughout. The cells are enumerated exactly.
//!
//! Source: the method of Esmail 2018 (two freedoms, one set, his Table 1) made general and
//! completed by the cases between self-locking limits, where friction turns a torque round.

pub(crate) mod arrangement;
mod atlas;
mod cells;
mod closed;
mod emit;
mod family;
mod locate;
pub(crate) mod formula;
pub(crate) mod setup;

use serde::{Deserialize, Serialize};

use crate::analysis::{Named, Role};
use crate::contract::{Contract, Format};
use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::exact::Rational;
use crate::kinematics::Configuration;
use crate::train::{AS_DRAWN, FRAME, MemberId, State, Train};

use atlas::atlas;
use setup::{Pattern, Setup};

pub(crate) use atlas::arrow;
pub(crate) use cells::efficiency_at;
pub use closed::{Argument, ClosedFormula, Derivative, FormulaRequest, FormulaSheet, Outside, formulas};
pub use family::{Case, Family, FamilyRange, Group, Row, family};
pub use formula::{Efficiencies, Ratios, SymbolKind};
pub use locate::{Edge, LocateRequest, Located, Location, Prescribes, Range, locate};

/// Which part of a train, and from which terminals.
#[derive(Clone, Debug, Default)]
pub struct RegimeSelection {
    /// A state of the shift table, or `as drawn`; `None` for all that have regimes.
    pub state: Option<String>,
    /// Members on which torque may act; `None` for the train's terminals.
    pub terminals: Option<Vec<String>>,
    /// Two terminals whose powers add to zero, such as the two machines of a hybrid whose battery
    /// neither gives nor takes.
    pub balance: Option<[String; 2]>,
}

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
    pub symbols: Named<SymbolReport>,
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
    /// Elements without loss: it does not matter who drives them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub lossless: Vec<String>,
    /// What else a reader must know.
    pub notes: Vec<String>,
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
    /// In words.
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
    pub example: Named<f64>,
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
    pub torque_signs: Named<i8>,
    /// What each terminal does.
    pub roles: Named<Role>,
    /// Terminals where power enters.
    pub inputs: Vec<String>,
    /// Terminals where power leaves.
    pub outputs: Vec<String>,
    /// Which end drives each element, seen from its carrier; absent when it carries no load or has
    /// no relative motion or loss.
    pub drivers: Named<Option<String>>,
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
    pub speeds: Named<f64>,
    /// Torques by terminal, in any unit.
    pub torques: Named<f64>,
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
    pub torques: Named<String>,
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
    pub speeds: Named<f64>,
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
    /// Limit of the efficiency, coming from after.
    pub efficiency_after: Option<f64>,
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

/// Enumerates the regimes of a train.
///
/// # Errors
/// A state or terminal that the train does not have.
///
/// # Example
/// ```
/// use willis::regimes::{RegimeSelection, regimes};
/// use willis::train::{SetSpec, Train};
///
/// let train = Train::builder("power split")
///     .members(["engine", "generator", "wheels"])
///     .terminals(["engine", "generator", "wheels"])
///     .set(SetSpec::simple("P1", ("generator", 30), ("wheels", 78), "engine").planet(23, 4).mesh_efficiency(0.99))
///     .build()?;
/// let all = regimes(&train, &RegimeSelection::default())?;
/// assert_eq!(all.states[0].regimes.len(), 16);
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn regimes(train: &Train, selection: &RegimeSelection) -> Result<Regimes, Diagnostics> {
    let mut states = Vec::new();
    for Choice { state, configuration, terminals, balance } in selected(train, selection)? {
        states.push(atlas(state, configuration, &terminals, balance));
    }
    // Unasked for, a train as drawn without regimes is no news when its states have some.
    if selection.state.is_none() && states.iter().any(|a: &Atlas| a.reason.is_none()) {
        states.retain(|a| a.reason.is_none() || a.state != AS_DRAWN);
    }
    Ok(Regimes { format: Format::new(), train: train.name.clone(), states })
}

/// A configuration that a selection names, with its terminals.
pub(crate) struct Choice<'t> {
    pub state: String,
    pub configuration: Configuration<'t>,
    pub terminals: Vec<MemberId>,
    pub balance: Option<[MemberId; 2]>,
}

/// The configurations that a selection names.
pub(crate) fn selected<'t>(train: &'t Train, selection: &RegimeSelection) -> Result<Vec<Choice<'t>>, Diagnostics> {
    let mut errors = Diagnostics::default();
    let mut members = |names: &[String]| {
        let mut all: Vec<MemberId> = Vec::new();
        for name in names {
            match train.member(name) {
                Some(FRAME) => errors.push(
                    Diagnostic::new(Code::NotATerminal, "", "the frame is at rest and no terminal")
                        .hint("name members that turn"),
                ),
                Some(id) if all.contains(&id) => {
                    errors.push(Diagnostic::new(Code::DuplicateName, "", format!("terminal `{name}` is named twice")));
                }
                Some(id) => all.push(id),
                None => {
                    let known = train.members.iter().skip(1).map(|m| m.name.as_str());
                    errors.push(Diagnostic::missing(Code::UnknownName, "member", name, known));
                }
            }
        }
        all
    };
    let named: Option<Vec<MemberId>> = selection.terminals.as_ref().map(|names| members(names));
    let balance: Option<Vec<MemberId>> = selection.balance.as_ref().map(|pair| members(pair));
    let balance = balance.and_then(|pair| <[MemberId; 2]>::try_from(pair).ok());
    let mut chosen: Vec<Option<&State>> = vec![];
    match &selection.state {
        None => {
            chosen.push(None);
            chosen.extend(train.states.iter().map(Some));
        }
        Some(name) => match train.find_configuration(Some(name)) {
            Ok(state) => chosen.push(state),
            Err(d) => errors.push(*d),
        },
    }
    if errors.has_errors() {
        return Err(errors);
    }
    Ok(chosen
        .into_iter()
        .map(|state| {
            let engaged = state.map_or(&[][..], |s| &s.engaged);
            let members = named.clone().unwrap_or_else(|| {
                let own = state.map(|s| [s.input, s.output]).into_iter().flatten().flatten();
                let mut all = train.terminals.clone();
                all.extend(own.chain(train.input).chain(train.output));
                let mut distinct: Vec<MemberId> = Vec::new();
                all.into_iter().filter(|m| *m != FRAME).for_each(|m| {
                    if !distinct.contains(&m) {
                        distinct.push(m);
                    }
                });
                distinct
            });
            let configuration = Configuration::new(train, engaged, &[], &members);
            let state = state.map_or(AS_DRAWN.to_owned(), |s| s.name.clone());
            Choice { state, configuration, terminals: members, balance }
        })
        .collect())
}

/// The first state of a selection that has a wheel: two freedoms and one independent torque. `Err`
/// with diagnostics for unknown names, with words for a train of another kind.
pub(crate) fn choice_of_two<'t>(
    train: &'t Train,
    selection: &RegimeSelection,
) -> Result<(Atlas, Setup<'t>), Result<Diagnostics, String>> {
    let mut reason = None;
    for Choice { state, configuration, terminals, balance } in selected(train, selection).map_err(Ok)? {
        let label = state.clone();
        let own = atlas(state, configuration.clone(), &terminals, balance);
        match &own.reason {
            Some(why) => reason = reason.or(Some(format!("{label}: {why}"))),
            None if own.base_speeds.len() == 2 && own.independent_torques == 1 => {
                let setup = Setup::new(configuration, &terminals, balance).map_err(Err)?;
                return Ok((own, setup));
            }
            None => {
                reason = reason.or(Some(format!(
                    "{label}: independent speeds {}, independent torques {}",
                    own.base_speeds.len(),
                    own.independent_torques
                )));
            }
        }
    }
    Err(Err(reason.unwrap_or_else(|| "the train has no state".to_owned())))
}
