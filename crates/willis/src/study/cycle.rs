//! What a duty cycle or a load spectrum costs: energies by source, state and direction, and the worst rows.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ops::Range;

use serde::{Deserialize, Serialize};

use crate::analysis::{self, Losses, SolutionReport};
use crate::contract::{Contract, Format};
use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::model::{Model, ShaftRef, Target};
use crate::named::NameMap;
use crate::operating_point::LossKind;
use crate::train::{Load, Operation, Train};
use crate::work::{self, Effort, Work};

use super::answer::{PointAnswer, PointVerdict};
use super::column::{Column, ColumnTable, ColumnValues};
use super::heat;
use super::profile::{Basis, Held, Profile, ProfileColumns, ProfileRow};
use super::question::{Hold, PointSetup, TrainCache};

/// How many of the worst are told.
const MOST_WORST: usize = 5;
/// How many reasons of a verdict, and warnings of a kind, are told.
const MOST_REASONS: usize = 5;

/// Which way power goes through the train.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum PowerDirection {
    /// Power enters at the input and leaves at the output.
    Driving,
    /// Power enters at the output and leaves at the input: the engine brakes, or power is recuperated.
    Coasting,
    /// Power enters and none leaves.
    Dissipating,
    /// No power goes through.
    Idle,
    /// Power goes otherwise, or the train names no input and output.
    Other,
}

impl PowerDirection {
    /// All, in the order of tables.
    pub const ALL: [Self; 5] = [Self::Driving, Self::Coasting, Self::Dissipating, Self::Idle, Self::Other];

    /// Its name in contracts and tables: `driving`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Driving => "driving",
            Self::Coasting => "coasting",
            Self::Dissipating => "dissipating",
            Self::Idle => "idle",
            Self::Other => "other",
        }
    }
}

/// The answer for one condition of a profile.
#[derive(Clone, Debug, PartialEq)]
struct CyclePoint {
    /// What can be said of it.
    pub verdict: PointVerdict,
    /// Why there is no answer; empty where there is one.
    pub reason: Box<str>,
    /// Which way power goes, where there is an answer.
    pub way: Option<PowerDirection>,
    /// The state of the shift table, by its position.
    pub state: Option<usize>,
    /// Output over input power; NaN where there is none.
    pub efficiency: f64,
    /// Power in, W; NaN without an answer.
    pub input_power_w: f64,
    /// Power out, W.
    pub output_power_w: f64,
    /// All losses, W.
    pub loss_w: f64,
    /// Input less output less losses, W.
    pub residual_w: f64,
}

/// The answers for some conditions, and what they say together.
#[derive(Clone, Debug, Default)]
struct CyclePart {
    /// One for each condition.
    points: Vec<CyclePoint>,
    /// By name and kind: law, energy.
    sources: BTreeMap<(String, EnergyKind), (String, f64)>,
    kinds: [f64; Losses::NAMES.len()],
    /// By member: energy in, energy out.
    terminals: BTreeMap<String, [f64; 2]>,
    warnings: BTreeMap<Code, Vec<Told>>,
}

#[derive(Clone, Debug)]
struct Told {
    message: String,
    rows: u64,
    time_s: f64,
    line: u32,
    /// How far, where that can be told.
    extent: Option<f64>,
}

/// Energies of some rows.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Energies {
    /// Rows with an answer.
    pub rows: u64,
    /// Their time, s.
    pub time_s: f64,
    /// Energy in, J.
    pub energy_in_j: f64,
    /// Energy out, J.
    pub energy_out_j: f64,
    /// Energy lost, J.
    pub energy_lost_j: f64,
    /// Energy out over energy in; absent where none goes in.
    pub efficiency: Option<f64>,
}

impl Energies {
    fn add(&mut self, held: Held, p: &CyclePoint) {
        self.rows += u64::from(held.rows);
        self.time_s += held.time_s;
        self.energy_in_j += p.input_power_w * held.time_s;
        self.energy_out_j += p.output_power_w * held.time_s;
        self.energy_lost_j += p.loss_w * held.time_s;
    }

    fn close(&mut self) {
        self.efficiency = (self.energy_in_j > 0.0).then(|| self.energy_out_j / self.energy_in_j);
    }
}

/// What kind of loss takes energy.
///
/// Ordered by name: of equal energies the first by name stands first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum EnergyKind {
    /// Friction of rolling bearings.
    Bearing,
    /// Gears that move oil.
    Churning,
    /// Drags that are given as torques.
    Drag,
    /// Oil that is sprayed into meshes.
    Injection,
    /// All losses of a mesh, where they are given as an efficiency.
    Mesh,
    /// Oil pumps.
    Pump,
    /// Rolling of teeth through the oil film.
    Rolling,
    /// Friction of seals.
    Seal,
    /// Open clutches and brakes.
    #[serde(rename = "shift-element")]
    ShiftElement,
    /// Sliding of teeth.
    Sliding,
    /// Variators.
    Variator,
    /// Gears that move air.
    Windage,
}

impl EnergyKind {
    /// Its name in contracts and tables: `sliding`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Bearing => "bearing",
            Self::Churning => "churning",
            Self::Drag => "drag",
            Self::Injection => "injection",
            Self::Mesh => "mesh",
            Self::Pump => "pump",
            Self::Rolling => "rolling",
            Self::Seal => "seal",
            Self::ShiftElement => "shift-element",
            Self::Sliding => "sliding",
            Self::Variator => "variator",
            Self::Windage => "windage",
        }
    }
}

impl From<LossKind> for EnergyKind {
    fn from(kind: LossKind) -> Self {
        match kind {
            LossKind::Sliding => Self::Sliding,
            LossKind::Rolling => Self::Rolling,
            LossKind::Bearing => Self::Bearing,
            LossKind::Windage => Self::Windage,
            LossKind::Churning => Self::Churning,
            LossKind::Seal => Self::Seal,
            LossKind::Drag => Self::Drag,
            LossKind::ShiftElement => Self::ShiftElement,
            LossKind::Injection => Self::Injection,
            LossKind::Pump => Self::Pump,
            LossKind::Variator => Self::Variator,
        }
    }
}

/// Energy lost by a source.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
// The schema keeps the name that is published.
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "SourceEnergy"))]
#[non_exhaustive]
pub struct LossBySource {
    /// What loses it; a mesh where losses are given by efficiencies.
    pub name: String,
    /// What kind of loss it is.
    pub kind: EnergyKind,
    /// The law that it was last computed by; `given` for a given efficiency.
    pub law: String,
    /// The energy, J.
    pub energy_j: f64,
    /// The part of all losses.
    pub share: f64,
}

/// Energy that crosses a member.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct TerminalEnergy {
    /// Energy that enters the train here, J.
    pub energy_in_j: f64,
    /// Energy that leaves it here, J.
    pub energy_out_j: f64,
}

/// Rows that say the same.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct RepeatedMessage {
    /// What they say, at the first of them; where it has an extent, at the worst.
    pub message: String,
    /// How many rows.
    pub rows: u64,
    /// Their time, s.
    pub time_s: f64,
    /// Line of the first of them; where it has an extent, of the worst.
    pub line: u32,
    /// How far, where that can be told: the part by which prescribed speeds contradict the gears.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub extent: Option<f64>,
}

/// Rows of a verdict.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct VerdictTime {
    /// How many rows.
    pub rows: u64,
    /// Their time, s.
    pub time_s: f64,
    /// The part of the whole time.
    pub share_of_time: f64,
    /// Why, longest first; the first few of them.
    pub reasons: Vec<RepeatedMessage>,
}

/// A condition that is among the worst.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct WorstRow {
    /// Line of its first row.
    pub line: u32,
    /// How many rows say the same.
    pub rows: u32,
    /// Their time, s.
    pub time_s: f64,
    /// What they prescribe.
    pub condition: String,
    /// Which way power goes.
    pub way: Option<PowerDirection>,
    /// Output over input power.
    pub efficiency: Option<f64>,
    /// Loss, W.
    pub loss_w: f64,
    /// Energy lost in all of these rows, J.
    pub energy_lost_j: f64,
}

/// The worst rows.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Worst {
    /// By loss power.
    pub loss: Vec<WorstRow>,
    /// By efficiency, of the rows in which power is meant to go through.
    pub efficiency: Vec<WorstRow>,
    /// By energy lost.
    pub energy: Vec<WorstRow>,
}

/// What a profile costs. Serialised it is the contract `willis-cycle-1`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct CycleReport {
    /// `willis-cycle-1`.
    pub format: Format<Self>,
    /// Name of the train.
    pub train: String,
    /// The operation from which the question starts, where the file has one.
    pub operation: Option<String>,
    /// What the operation prescribes and no column sets.
    pub held: Vec<String>,
    /// How rows weigh.
    pub basis: Basis,
    /// The same in a sentence.
    pub rule: String,
    /// Rows of the profile.
    pub rows: u64,
    /// Different conditions among them.
    pub conditions: u64,
    /// Time of the profile, s.
    pub time_s: f64,
    /// Time of the rows that have an answer, s; energies are those of these rows.
    pub covered_s: f64,
    /// The part of the time that they cover.
    pub coverage: f64,
    /// Energy in, J.
    pub energy_in_j: f64,
    /// Energy out, J.
    pub energy_out_j: f64,
    /// Energy lost, J.
    pub energy_lost_j: f64,
    /// Energy in less energy out less energy lost, J.
    pub energy_residual_j: f64,
    /// The largest power that does not balance in any row, W.
    pub power_residual_w: f64,
    /// Energy out over energy in.
    pub efficiency: Option<f64>,
    /// Mean over time of the efficiencies of the rows that have one; another number than `efficiency`, in which hours
    /// of high power count more.
    pub time_mean_efficiency: Option<f64>,
    /// Mean loss power over the covered time, W.
    pub mean_loss_w: Option<f64>,
    /// Energy lost by kind, J.
    pub losses_j: NameMap<f64>,
    /// Energy lost by source, largest first.
    pub sources: Vec<LossBySource>,
    /// By which way power goes.
    pub ways: NameMap<Energies>,
    /// By state of the shift table.
    pub states: NameMap<Energies>,
    /// By terminal through which power passes.
    pub terminals: NameMap<TerminalEnergy>,
    /// By verdict, with the reasons of those without an answer.
    pub verdicts: NameMap<VerdictTime>,
    /// The worst rows.
    pub worst: Worst,
    /// Warnings by their code.
    pub warnings: NameMap<Vec<RepeatedMessage>>,
    /// What is remarkable about the profile.
    pub notes: Vec<String>,
    /// The oil temperature, where it follows from the losses.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub oil: Option<CycleOil>,
    /// What the model leaves out, and what stands in for data that were not given.
    #[serde(default)]
    pub assumptions: Vec<String>,
}

impl Contract for CycleReport {
    const FORMAT: &'static str = "willis-cycle-1";
}

/// A profile put to a train.
#[derive(Clone, Debug)]
pub struct Cycle<'a> {
    question: PointSetup<'a>,
    profile: &'a Profile,
}

/// What a cycle is asked.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct CycleRequest {
    /// The duty cycle or load spectrum, the text of a CSV table: a header, then one operating condition a row. A column
    /// is a quantity with its unit, `input.speed [rpm]`, `output.torque [N m]`, or `state`. One column weighs the rows:
    /// `time [s]` (a trace: each row holds until the time of the next), `duration [min]` or `hours` (each row holds so
    /// long), or `share [%]` (each row holds for this part of one hour).
    pub profile: String,
    /// Columns of the profile that are left out, with or without their units.
    pub ignore_column: Vec<String>,
    /// The columns of the profile that are read, where not all of them are.
    pub only_column: Vec<String>,
    /// The operation of the train file that says what no column does. Default: the first one that suits the state.
    pub operation: Option<String>,
    /// The state of the shift table, where no column says it. Default: that of the operation.
    pub state: Option<String>,
}

/// A cycle in memory.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct CycleAnswer {
    /// The energies, and the worst rows.
    pub report: CycleReport,
    /// Every row of the profile with its answer.
    pub rows: ColumnTable,
}

/// What a duty cycle or a load spectrum costs.
///
/// The answer does not depend on how `work` shares the rows out.
///
/// # Errors
/// What is wrong with the profile, each with its place in the text of the profile; an operation or a state that there is
/// not; a profile of which no row makes a question; and [`Code::Cancelled`].
///
/// # Example
/// ```
/// use willis::model::Model;
/// use willis::study::{CycleRequest, cycle};
/// use willis::work::Serial;
///
/// let model = Model::from_toml(r#"
///     format = 1
///     name = "reducer"
///     members = ["s", "c"]
///     terminals = ["s", "c"]
///     [[set]]
///     name = "P1"
///     sun = { member = "s", teeth = 30 }
///     ring = { member = "frame", teeth = 70 }
///     carrier = "c"
///     mesh_efficiency = 0.99
/// "#)?;
/// let profile = "hours,input.speed [rad/s],input.torque [N m]\n1,100,50\n3,100,10\n".to_owned();
/// let answer = cycle(&model, &CycleRequest { profile, ..Default::default() }, &Serial)?;
/// assert!((answer.report.energy_in_j - (5000.0 + 3.0 * 1000.0) * 3600.0).abs() < 1e-6);
/// assert!((answer.report.efficiency.unwrap() - 0.98607).abs() < 1e-9);
/// assert_eq!(answer.rows.len(), 2);
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn cycle(model: &Model, request: &CycleRequest, work: &dyn Work) -> Result<CycleAnswer, Diagnostics> {
    let columns = match (&*request.only_column, &*request.ignore_column) {
        ([], []) => ProfileColumns::All,
        ([], without) => ProfileColumns::Without(without.to_vec()),
        (only, []) => ProfileColumns::Only(only.to_vec()),
        _ => {
            let message = "`only_column` and `ignore_column` both say which columns are read";
            return Err(Diagnostic::new(Code::Conflict, "", message).hint("give one of them").into());
        }
    };
    let profile = Profile::parse_columns(&request.profile, model, &columns)?;
    let mut question = PointSetup::new(model, request.operation.as_deref(), request.state.as_deref(), Hold::AsGiven)?;
    let oil = oil_of(&question, &profile, work)?;
    if let Some(CycleOil { mean_k: Some(t), .. }) = oil {
        question.warm(t);
    }
    let mut answer = Cycle::new(question, &profile).run(work)?;
    answer.report.oil = oil;
    Ok(answer)
}

/// The oil temperature of a cycle, where the train says what carries heat away and neither operation nor profile gives
/// it.
fn oil_of(question: &PointSetup<'_>, profile: &Profile, work: &dyn Work) -> Result<Option<CycleOil>, Diagnostics> {
    let train = question.model().train();
    let given = profile.conditions() > 0 && profile.settings(0).iter().any(|s| *s.0 == Target::Temperature);
    let Some(network) = train.heat().filter(|_| !given && question.base().temperature.is_none()) else {
        return Ok(None);
    };
    match heat::of_rows(question, profile, network, work) {
        Ok(found) => Ok(Some(CycleOil {
            mean_k: Some(found.mean_k),
            lowest_k: Some(found.lowest_k),
            highest_k: Some(found.highest_k),
            limit_k: network.limit,
            why_not: None,
        })),
        Err(wrong) if wrong.iter().any(|d| d.code == Code::Cancelled) => Err(wrong),
        Err(wrong) => Ok(Some(CycleOil {
            mean_k: None,
            lowest_k: None,
            highest_k: None,
            limit_k: network.limit,
            why_not: wrong.iter().next().map(|d| d.message.clone()),
        })),
    }
}

/// The oil temperature of a cycle that repeats itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct CycleOil {
    /// Mean over time, K, at which every row is computed; absent where each row has its own steady temperature.
    pub mean_k: Option<f64>,
    /// Lowest, K.
    pub lowest_k: Option<f64>,
    /// Highest, K.
    pub highest_k: Option<f64>,
    /// Highest that is allowed, K.
    pub limit_k: f64,
    /// Why each row has its own steady temperature instead.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub why_not: Option<String>,
}

impl<'a> Cycle<'a> {
    /// Conditions that are computed together.
    const AT_ONCE: usize = 64;

    /// The rows of a profile as questions.
    pub fn new(question: PointSetup<'a>, profile: &'a Profile) -> Self {
        Self { question, profile }
    }

    /// The profile.
    pub fn profile(&self) -> &'a Profile {
        self.profile
    }

    /// Computes every condition.
    ///
    /// # Errors
    /// No condition makes a question; the work was cancelled.
    pub fn run(&self, work: &dyn Work) -> Result<CycleAnswer, Diagnostics> {
        let n = self.profile.conditions();
        work.afford(&Effort::of_points(self.question.model().train(), n as u64))?;
        work.begin("conditions", n as u64);
        let parts = work::map(work, n.div_ceil(Self::AT_ONCE), |k| {
            let conditions = k * Self::AT_ONCE..((k + 1) * Self::AT_ONCE).min(n);
            let count = conditions.len() as u64;
            let part = self.part(conditions, &mut TrainCache::default());
            work.advance(count);
            part
        })?;
        let points: Vec<&CyclePoint> = parts.iter().flat_map(|p| &p.points).collect();
        if let Some(first) = points.first().filter(|_| points.iter().all(|p| p.verdict == PointVerdict::Refused)) {
            let message = format!("no row of the profile makes a question: {}", first.reason);
            return Err(Diagnostic::new(Code::Unfit, "", message).into());
        }
        Ok(CycleAnswer { report: self.report(&parts), rows: self.table(&points) })
    }

    /// Every row of the profile with its answer.
    fn table(&self, points: &[&CyclePoint]) -> ColumnTable {
        let (rows, states) = (self.profile.rows(), self.question.model().train().states());
        let of = |row: &ProfileRow| points[row.condition as usize];
        let mut table = ColumnTable::default();
        let lines = rows.iter().map(|r| i64::from(r.line)).collect();
        table.add(Column::integer("line"), ColumnValues::Integers(lines));
        let number = |table: &mut ColumnTable, name: &str, unit: &str, value: &dyn Fn(&ProfileRow) -> f64| {
            table.add(Column::number(name, unit), ColumnValues::Numbers(rows.iter().map(value).collect()));
        };
        if self.profile.basis() == Basis::Trace {
            number(&mut table, "time_s", "s", &|r| r.time_s);
        }
        number(&mut table, "duration_s", "s", &|r| r.duration_s);
        for (column, values) in self.profile.table_columns() {
            table.add(column, values);
        }
        let text = |table: &mut ColumnTable, name: &str, value: &dyn Fn(&CyclePoint) -> Cow<'static, str>| {
            let values = rows.iter().map(|r| value(of(r))).collect();
            table.add(Column::text(name), ColumnValues::Texts(values));
        };
        let state = |p: &CyclePoint| p.state.and_then(|k| states.get(k)).map_or(String::new(), |s| s.name.clone());
        text(&mut table, "in_state", &|p| state(p).into());
        text(&mut table, "verdict", &|p| p.verdict.name().into());
        text(&mut table, "direction", &|p| p.way.map_or("", PowerDirection::name).into());
        number(&mut table, "efficiency", "", &|r| of(r).efficiency);
        number(&mut table, "input_power_w", "W", &|r| of(r).input_power_w);
        number(&mut table, "output_power_w", "W", &|r| of(r).output_power_w);
        number(&mut table, "loss_w", "W", &|r| of(r).loss_w);
        number(&mut table, "energy_lost_j", "J", &|r| of(r).loss_w * r.duration_s);
        text(&mut table, "reason", &|p| p.reason.to_string().into());
        table
    }

    /// The answers for some conditions.
    fn part(&self, conditions: Range<usize>, trains: &mut TrainCache) -> CyclePart {
        let mut part = CyclePart::default();
        for condition in conditions {
            let point = self.point(condition, trains, &mut part);
            part.points.push(point);
        }
        part
    }

    fn point(&self, condition: usize, trains: &mut TrainCache, part: &mut CyclePart) -> CyclePoint {
        let held = self.profile.held(condition);
        let settings = self.profile.settings(condition);
        let states = self.question.model().train().states();
        let named = settings.iter().find(|s| *s.0 == Target::State);
        let state = match named {
            Some((_, name)) => states.iter().position(|s| s.name == *name),
            None => self.question.base().state,
        };
        let asked = self.question.at(&settings, trains);
        let (answer, way) = match &asked {
            Ok((train, operation)) => {
                let answer = PointAnswer::of(train, operation);
                let way = answer.solution.as_ref().map(|s| self.way(train, operation, s));
                (answer, way)
            }
            Err(wrong) => (PointAnswer::refused(wrong.clone()), None),
        };
        for warning in &answer.warnings {
            let told = part.warnings.entry(warning.code).or_default();
            tell(told, &warning.message, warning.deviation, held);
        }
        let mut point = CyclePoint {
            verdict: answer.verdict,
            reason: answer.reason.as_str().into(),
            way,
            state,
            efficiency: answer.efficiency(),
            input_power_w: f64::NAN,
            output_power_w: f64::NAN,
            loss_w: f64::NAN,
            residual_w: f64::NAN,
        };
        let Some(s) = &answer.solution else { return point };
        point.input_power_w = s.input_power_w;
        point.output_power_w = s.output_power_w;
        point.loss_w = s.loss_w;
        point.residual_w = s.power_residual_w;
        for (sum, power) in part.kinds.iter_mut().zip(s.losses_w.all()) {
            *sum += power * held.time_s;
        }
        let mut lose = |name: &str, kind, law: &str, power: f64| {
            let own = part.sources.entry((name.to_owned(), kind)).or_insert_with(|| (law.to_owned(), 0.0));
            own.1 += power * held.time_s;
        };
        match s.sources.is_empty() {
            true => {
                s.meshes.iter().for_each(|(name, m)| lose(name, EnergyKind::Mesh, "given", m.loss_w));
                s.variators.iter().for_each(|(name, v)| lose(name, EnergyKind::Variator, "given", v.loss_w));
            }
            false => s.sources.iter().for_each(|x| lose(&x.name, x.kind.into(), &x.law, x.loss_w)),
        }
        for (name, m) in s.members.iter() {
            let energy = m.power_w.unwrap_or(0.0) * held.time_s;
            if energy != 0.0 {
                let own = part.terminals.entry(name.clone()).or_default();
                own[usize::from(energy < 0.0)] += energy.abs();
            }
        }
        point
    }

    fn way(&self, train: &Train, operation: &Operation, s: &SolutionReport) -> PowerDirection {
        // What is round-off beside the power that enters is nothing.
        let least = 1e-12 * s.input_power_w.abs();
        if s.output_power_w <= least {
            return if s.input_power_w > 0.0 { PowerDirection::Dissipating } else { PowerDirection::Idle };
        }
        let power = |who| {
            let member = self.question.role(train, operation, who).ok()?;
            s.members.get(train.member_name(member))?.power_w
        };
        match (power(ShaftRef::Input), power(ShaftRef::Output)) {
            (Some(i), Some(o)) if i > least && o < -least => PowerDirection::Driving,
            (Some(i), Some(o)) if i < -least && o > least => PowerDirection::Coasting,
            _ => PowerDirection::Other,
        }
    }

    /// What the operation prescribes and the profile does not set.
    fn base(&self) -> Vec<String> {
        let settings = self.profile.settings(0);
        let Ok((train, operation)) = self.question.at(&settings, &mut TrainCache::default()) else { return vec![] };
        let set = |member, is_speed: bool| {
            settings.iter().any(|(target, _)| {
                let who = match target {
                    Target::Speed(who) if is_speed => who,
                    Target::Torque(who) | Target::Power(who) if !is_speed => who,
                    _ => return false,
                };
                self.question.role(&train, &operation, *who).ok() == Some(member)
            })
        };
        let mut all = vec![];
        if let (Some(k), false) = (operation.state, settings.iter().any(|s| *s.0 == Target::State)) {
            all.push(format!("state {}", train.states()[k].name));
        }
        for (member, speed) in operation.speeds.iter().filter(|s| !set(s.0, true)) {
            let rpm = speed.si() * 30.0 / std::f64::consts::PI;
            all.push(format!("speed of {} {} rpm", train.member_name(*member), short(rpm)));
        }
        for (member, load) in operation.loads.iter().filter(|l| !set(l.0, false)) {
            let name = train.member_name(*member);
            all.push(match load {
                Load::Torque(q) => format!("torque on {name} {} N m", short(q.si())),
                Load::Power(q) => format!("power at {name} {} W", short(q.si())),
            });
        }
        all
    }

    /// What all [parts](Self::part) say together.
    fn report(&self, parts: &[CyclePart]) -> CycleReport {
        let profile = self.profile;
        let points: Vec<&CyclePoint> = parts.iter().flat_map(|p| &p.points).collect();
        let train = self.question.model().train();
        let mut whole = Energies::default();
        let mut ways: BTreeMap<PowerDirection, Energies> = BTreeMap::new();
        let mut states: Vec<Energies> = vec![Energies::default(); train.states().len() + 1];
        let mut verdicts: BTreeMap<PointVerdict, (VerdictTime, Vec<Told>)> = BTreeMap::new();
        let (mut mean, mut mean_time, mut residual) = (0.0, 0.0, 0.0f64);
        // The condition in which a trace ends may have no row.
        let held = |k: usize| Some(profile.held(k)).filter(|h| h.rows > 0);
        for (k, p) in points.iter().enumerate() {
            let Some(held) = held(k) else { continue };
            let verdict = verdicts.entry(p.verdict).or_default();
            verdict.0.rows += u64::from(held.rows);
            verdict.0.time_s += held.time_s;
            let Some(way) = p.way else {
                tell(&mut verdict.1, &p.reason, None, held);
                continue;
            };
            if !p.reason.is_empty() {
                tell(&mut verdict.1, &p.reason, None, held);
            }
            whole.add(held, p);
            ways.entry(way).or_default().add(held, p);
            states[p.state.unwrap_or(train.states().len())].add(held, p);
            residual = residual.max(p.residual_w.abs());
            if !p.efficiency.is_nan() {
                mean += p.efficiency * held.time_s;
                mean_time += held.time_s;
            }
        }
        whole.close();
        let mut sources: BTreeMap<&(String, EnergyKind), (&String, f64)> = BTreeMap::new();
        let mut terminals: BTreeMap<&str, TerminalEnergy> = BTreeMap::new();
        let mut kinds = [0.0; Losses::NAMES.len()];
        let mut warnings: BTreeMap<Code, Vec<Told>> = BTreeMap::new();
        for part in parts {
            for (key, (law, energy)) in &part.sources {
                sources.entry(key).or_insert((law, 0.0)).1 += energy;
            }
            for (name, energy) in &part.terminals {
                let own = terminals.entry(name).or_default();
                own.energy_in_j += energy[0];
                own.energy_out_j += energy[1];
            }
            kinds.iter_mut().zip(part.kinds).for_each(|(sum, own)| *sum += own);
            for (code, all) in &part.warnings {
                join(warnings.entry(*code).or_default(), all);
            }
        }
        let mut sources: Vec<LossBySource> = sources
            .into_iter()
            .map(|((name, kind), (law, energy_j))| {
                let share = if whole.energy_lost_j > 0.0 { energy_j / whole.energy_lost_j } else { 0.0 };
                LossBySource { name: name.clone(), kind: *kind, law: law.clone(), energy_j, share }
            })
            .collect();
        sources.sort_by(|a, b| b.energy_j.total_cmp(&a.energy_j));
        let energies = |mut e: Energies| {
            e.close();
            e
        };
        let of_state = |k: usize| train.states().get(k).map_or("as drawn".to_owned(), |s| s.name.clone());
        let named: Vec<(String, Energies)> =
            states.into_iter().enumerate().map(|(k, e)| (of_state(k), energies(e))).filter(|s| s.1.rows > 0).collect();
        let time_s = profile.total_s();
        let verdicts = PointVerdict::ALL.iter().filter_map(|verdict| {
            let (mut own, told) = verdicts.remove(verdict)?;
            own.share_of_time = own.time_s / time_s;
            own.reasons = said(told);
            Some((verdict.name().to_owned(), own))
        });
        let base = self.question.base();
        let is_own = train.operations().iter().any(|o| o.name == base.name);
        CycleReport {
            format: Format::new(),
            assumptions: analysis::assumptions(train),
            train: train.name().to_owned(),
            operation: is_own.then(|| base.name.clone()),
            held: self.base(),
            basis: profile.basis(),
            rule: profile.basis().rule().to_owned(),
            rows: profile.rows().len() as u64,
            conditions: (0..points.len()).filter(|k| held(*k).is_some()).count() as u64,
            time_s,
            covered_s: whole.time_s,
            coverage: if points.iter().enumerate().all(|(k, p)| held(k).is_none() || p.way.is_some()) {
                1.0
            } else {
                whole.time_s / time_s
            },
            energy_in_j: whole.energy_in_j,
            energy_out_j: whole.energy_out_j,
            energy_lost_j: whole.energy_lost_j,
            energy_residual_j: whole.energy_in_j - whole.energy_out_j - whole.energy_lost_j,
            power_residual_w: residual,
            efficiency: whole.efficiency,
            time_mean_efficiency: (mean_time > 0.0).then(|| mean / mean_time),
            mean_loss_w: (whole.time_s > 0.0).then(|| whole.energy_lost_j / whole.time_s),
            losses_j: Losses::of_train(train).map(|k| (Losses::NAMES[k].to_owned(), kinds[k])).collect(),
            sources,
            ways: PowerDirection::ALL
                .iter()
                .filter_map(|w| Some((w.name().to_owned(), energies(ways.remove(w)?))))
                .collect(),
            states: named.into_iter().collect(),
            terminals: (train.members().iter())
                .filter_map(|m| Some((m.name.clone(), terminals.remove(m.name.as_str())?)))
                .collect(),
            verdicts: verdicts.collect(),
            worst: self.worst(&points),
            warnings: warnings.into_iter().map(|(code, told)| (code.as_str().to_owned(), said(told))).collect(),
            notes: profile.notes().to_vec(),
            oil: None,
        }
    }

    fn worst(&self, points: &[&CyclePoint]) -> Worst {
        let held = |k: usize| self.profile.held(k);
        let answered: Vec<usize> =
            (0..points.len()).filter(|k| points[*k].way.is_some() && held(*k).rows > 0).collect();
        let row = |k: usize| WorstRow {
            line: held(k).first_line,
            rows: held(k).rows,
            time_s: held(k).time_s,
            condition: self.profile.describe(k),
            way: points[k].way,
            efficiency: Some(points[k].efficiency).filter(|e| !e.is_nan()),
            loss_w: points[k].loss_w,
            energy_lost_j: points[k].loss_w * held(k).time_s,
        };
        let largest = |by: &dyn Fn(usize) -> f64| -> Vec<WorstRow> {
            let mut all: Vec<(usize, f64)> = answered.iter().map(|k| (*k, by(*k))).filter(|x| !x.1.is_nan()).collect();
            // Stable: of equal ones those that stand first.
            all.sort_by(|a, b| b.1.total_cmp(&a.1));
            all.into_iter().take(MOST_WORST).map(|x| row(x.0)).collect()
        };
        let is_some = |x: f64| if x > 0.0 { x } else { f64::NAN };
        Worst {
            loss: largest(&|k| is_some(points[k].loss_w)),
            efficiency: largest(&|k| -points[k].efficiency),
            energy: largest(&|k| is_some(points[k].loss_w * held(k).time_s)),
        }
    }
}

/// A number for a sentence.
fn short(x: f64) -> String {
    let rounded: f64 = format!("{x:.5e}").parse().unwrap_or(x);
    rounded.to_string()
}

/// A sentence without its numbers: what differs from row to row only in them is the same.
fn gist(message: &str) -> String {
    message.chars().filter(|c| !c.is_ascii_digit() && !matches!(c, '.' | '-')).collect()
}

fn tell(all: &mut Vec<Told>, message: &str, extent: Option<f64>, held: Held) {
    if held.rows == 0 {
        return;
    }
    let (message, line) = (message.to_owned(), held.first_line);
    join(all, &[Told { message, rows: held.rows.into(), time_s: held.time_s, line, extent }]);
}

fn join(all: &mut Vec<Told>, more: &[Told]) {
    /// Kinds of sentences that are kept apart; others count with the last.
    const MOST: usize = 50;
    for new in more {
        let key = gist(&new.message);
        let full = all.len() >= MOST;
        let same = match all.iter().position(|t| t.message == new.message || gist(&t.message) == key) {
            None if full => Some(all.len() - 1),
            same => same,
        };
        match same {
            Some(k) => {
                let (rows, time_s) = (all[k].rows + new.rows, all[k].time_s + new.time_s);
                if new.extent > all[k].extent {
                    all[k] = new.clone();
                }
                (all[k].rows, all[k].time_s) = (rows, time_s);
            }
            None => all.push(new.clone()),
        }
    }
}

fn said(mut all: Vec<Told>) -> Vec<RepeatedMessage> {
    all.sort_by(|a, b| b.time_s.total_cmp(&a.time_s));
    let all = all.into_iter().filter(|t| !t.message.is_empty()).take(MOST_REASONS);
    let told = |t: Told| RepeatedMessage {
        message: t.message,
        rows: t.rows,
        time_s: t.time_s,
        line: t.line,
        extent: t.extent,
    };
    all.map(told).collect()
}
