//! What came of a design: the results contract `willis-design-1`.

use serde::{Deserialize, Serialize};
use willis::analysis::Verdict;
use willis::contract::{Contract, Format};
use willis::diagnostic::Diagnostic;
use willis::exact::Rational;
use willis::named::NameMap;

use super::fit::Phase;
use super::wish::Objective;

/// All trains that satisfy a wish, counted, and the best of them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct DesignAnswer {
    /// Name and version of this contract.
    pub format: Format<Self>,
    /// The name in the file.
    pub name: String,
    /// What was wished, in words: it is repeated in the notes of every train.
    pub wish: String,
    /// What was searched.
    pub space: Space,
    /// What is known about completeness.
    pub completeness: Completeness,
    /// How many are left after each condition, in the order of the conditions.
    pub waterfall: Vec<Stage>,
    /// What rows are judged by; the first one is that by which they are sorted unless another was asked for.
    pub objectives: Vec<Objective>,
    /// With which losses the efficiencies were computed that ranked the trains.
    pub ranked_by: Ranking,
    /// How many trains no other one beats in every objective; where laws ranked all trains, under the laws.
    pub front: u64,
    /// What the rows are sorted by.
    pub sorted_by: Objective,
    /// Whether rows are of all trains that satisfy the wish; else they are of the front.
    #[serde(default)]
    pub of_all: bool,
    /// The trains shown, as many as were asked for.
    pub rows: Vec<DesignRow>,
    /// The train of the user, judged like the others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub own: Option<OwnTrain>,
    /// For an empty result: the wishes that alone keep it empty.
    pub relaxations: Vec<Relaxation>,
    /// Warnings and notes.
    pub diagnostics: Vec<Diagnostic>,
}

impl Contract for DesignAnswer {
    const FORMAT: &'static str = "willis-design-1";
}

/// The space of tooth numbers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Space {
    /// By set, what its tooth numbers may be.
    pub sets: NameMap<SetRange>,
    /// How many choices of coaxial tooth numbers and numbers of planets there are.
    pub candidates: f64,
}

/// The ranges of a set.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SetRange {
    /// By gear, its range as written.
    pub teeth: NameMap<String>,
    /// Numbers of planets.
    pub planets: Vec<i64>,
    /// Mismatches allowed.
    pub mismatch: Vec<i64>,
    /// Coaxial tooth numbers.
    pub trains: f64,
}

/// Whether that is all.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Completeness {
    /// Whether the whole space was examined, or excluded by bounds with a margin for rounding.
    pub complete: bool,
    /// The share that was: steps of the outermost loop done, of all.
    pub done: u64,
    /// All steps of the outermost loop.
    pub of: u64,
    /// The same in words.
    pub statement: String,
}

/// How many are left after a condition.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Stage {
    /// The condition: `ratio`, a rule, a limit.
    pub condition: String,
    /// Tooth numbers left, with some number of planets; short planets of Ravigneaux sets are not counted apart.
    pub trains: u64,
    /// The same with every number of planets and every short planet counted.
    pub designs: u64,
    /// Designs by number of planets, where only one set is designed.
    #[serde(default, skip_serializing_if = "NameMap::is_empty")]
    pub by_planets: NameMap<u64>,
}

impl Stage {
    /// Whether it is a demand on efficiency, which laws may judge.
    pub(crate) fn is_demand(&self) -> bool {
        ["forward", "backward"].contains(&self.condition.as_str())
    }
}

/// A train.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct DesignRow {
    /// Its number in the list, from 1.
    pub number: u64,
    /// Designed sets.
    pub sets: NameMap<SetRow>,
    /// States with a target.
    pub states: NameMap<StateRow>,
    /// Largest relative deviation from a target.
    pub error: f64,
    /// Reference diameter of the largest ring, m; absent where no module is given.
    pub ring_diameter_m: Option<f64>,
    /// Teeth of the largest ring.
    pub ring_teeth: i64,
    /// Least efficiency from input to output over the targets; absent where friction locks or it is not known.
    pub forward: Option<f64>,
    /// Least efficiency from output to input.
    pub backward: Option<f64>,
    /// Whether friction locks the output in some target: power cannot flow from it to the input.
    pub self_locking: bool,
    /// The factor on all mesh losses at which the output can no longer drive the input, least of the targets; 1 is at the
    /// limit, below 1 locks. Absent where no loss locks.
    pub lock_margin: Option<f64>,
    /// Largest speed of a planet on its pin, as a multiple of the input's.
    pub planet_spin: f64,
    /// Largest speed of a member, as a multiple of the input's.
    pub member_speed: f64,
    /// Largest torque of a closed shift element without losses, as a multiple of the input's.
    pub element_torque: Option<f64>,
    /// Whether all its efficiencies come from the certified solver and are proved unique.
    pub certified: bool,
    /// What the laws of friction of the file make of its efficiencies, where it has any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub laws: Option<LawRow>,
    /// The operations of the file, with its laws of friction; shown rows only.
    #[serde(default, skip_serializing_if = "NameMap::is_empty")]
    pub operations: NameMap<OperationRow>,
}

/// The losses that ranked trains.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum RankedBy {
    /// Mesh efficiencies, which are the same at every load and speed.
    MeshEfficiencies,
    /// Laws of friction in the operations of the file.
    Laws,
}

/// Which trains were computed with the laws of friction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Recomputed {
    /// None: the file has no laws with an operation of a state that has a target, or none were asked for.
    None,
    /// Those that are shown; the laws rank nothing.
    Shown,
    /// Those that no other one beats by mesh efficiencies. Others may be better under the laws.
    Front,
    /// All that satisfy every wish that does not depend on the laws.
    All,
}

/// What ranked the trains of an answer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Ranking {
    /// With which losses.
    pub by: RankedBy,
    /// Operations whose least efficiency stands for `forward`; where there are none, that of the meshes does.
    pub forward: Vec<String>,
    /// Operations whose least efficiency stands for `backward`.
    pub backward: Vec<String>,
    /// Which trains were computed with the laws.
    pub recomputed: Recomputed,
    /// How many these are.
    pub trains: u64,
    /// How many of them satisfy the demands on efficiency under the laws; absent where the laws rank nothing.
    pub satisfy: Option<u64>,
    /// How many of them have no single answer under the laws, and are not ranked or come last.
    pub open: u64,
    /// How many trains no other one beats by mesh efficiencies.
    pub front_before: u64,
    /// The same in words.
    pub words: String,
}

/// A train under the laws of friction of its file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct LawRow {
    /// Least efficiency of the operations that send power from input to output; absent where there is none, or friction
    /// locks, or nothing comes out.
    pub forward: Option<f64>,
    /// Least efficiency of the operations that send power back.
    pub backward: Option<f64>,
    /// Whether friction locks one of the operations that send power back.
    pub self_locking: bool,
    /// Demands on efficiency that it misses under the laws.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub fails: Vec<String>,
}

/// A train that exists, among those that were found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct OwnTrain {
    /// The name of its file.
    pub name: String,
    /// The conditions of the wish that it does not meet; empty where it is one of the trains of the space.
    pub fails: Vec<String>,
    /// How many trains of the front are at least as good in every objective and better in one.
    pub better: u64,
    /// The train, with the mesh efficiencies of the design; its number is 0.
    pub row: DesignRow,
}

/// An operation of a train that was found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct OperationRow {
    /// What can be said of it.
    pub verdict: Verdict,
    /// Output over input power with the laws of the file, where it is unique.
    pub efficiency: Option<f64>,
    /// All losses, W.
    pub loss_w: Option<f64>,
}

/// A set of a train.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SetRow {
    /// Tooth numbers by gear.
    pub teeth: NameMap<i64>,
    /// Numbers of planets that follow all rules.
    pub planets: Vec<i64>,
    /// The one of them that the train file has.
    pub chosen: i64,
    /// Whether meshing gears have no common divisor.
    pub hunting: bool,
    /// The phase of the meshes at the sun, with the chosen number of planets.
    pub phase: Phase,
    /// The module: of those allowed the largest with which the ring is within its limit, or the smallest where the ring
    /// shall be small, m; absent where none is given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub module_m: Option<f64>,
    /// Profile shifts by gear, positive outward; absent where there are none that suit.
    pub shifts: Option<NameMap<f64>>,
}

/// A state of a train.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct StateRow {
    /// Its ratio, exactly.
    pub ratio: Option<Rational>,
    /// The same as a decimal.
    pub value: f64,
    /// What was aimed at; absent where the ratio may be anything.
    pub target: Option<Rational>,
    /// Relative deviation.
    pub error: f64,
    /// Efficiency from input to output, where it is unique.
    pub forward: Option<f64>,
    /// The same exactly, where the efficiencies of the meshes are given.
    pub forward_exact: Option<Rational>,
    /// What can be said about that direction.
    pub forward_verdict: Verdict,
    /// Efficiency from output to input, where it is unique.
    pub backward: Option<f64>,
    /// The same exactly.
    pub backward_exact: Option<Rational>,
    /// What can be said about that direction; `locked` is self-locking.
    pub backward_verdict: Verdict,
}

/// A wish without which something would be found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Relaxation {
    /// The wish: a rule, a limit, a demand, or `ratio of state 1`.
    pub wish: String,
    /// What it is now, where it is a number.
    pub now: Option<f64>,
    /// What it must become for the first train, everything else unchanged; absent where it must be dropped.
    pub needed: Option<f64>,
    /// How many trains satisfy all the other wishes.
    pub trains: u64,
    /// The same in words.
    pub words: String,
}
