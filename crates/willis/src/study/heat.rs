//! How warm a gearbox gets: the oil temperature of each operating point, its warm-up, its thermal rating, and what a duty
//! cycle makes of it.

use serde::{Deserialize, Serialize};

use crate::analysis::{self, HeatOfLosses, HeatReport, NoHeat, Selection, SolutionReport, Verdict, assumptions};
use crate::contract::{Contract, Format};
use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::exact::Rational;
use crate::heat::{Limits, Run, Segment, Source, balance, duty, warm_up};
use crate::model::{Model, Target};
use crate::operating_point::LossSource;
use crate::train::heat::{Heat, OIL};
use crate::train::{Load, Operation, Store, Train};
use crate::work::{self, Effort, Work};

use super::profile::{Basis, Profile};
use super::question::{Hold, PointSetup, TrainCache};

/// Rows of a warm-up.
const ROWS: usize = 120;
/// Temperatures at which the losses of a warm-up are tabulated; of the conditions of a duty cycle together.
const NODES: usize = 33;
const MOST_NODES: usize = 3000;
/// Error of a temperature that a step leaves, over the rise.
const TOLERANCE: f64 = 1e-8;
/// Time constants after which a warm-up ends.
const CONSTANTS: f64 = 5.0;
/// Largest factor on a load that is looked at for the rating.
const MOST_LOAD: f64 = 1024.0;

/// What is asked about heat.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct HeatRequest {
    /// Only this operation.
    pub operation: Option<String>,
    /// Only operations in this state.
    pub state: Option<String>,
    /// How long the warm-up takes, s. Default: five time constants.
    pub duration_s: Option<f64>,
    /// Oil temperature at the start, K. Default: that of the file.
    pub start_k: Option<f64>,
    /// A duty cycle or a load spectrum, the text of a CSV table as of [`CycleRequest`](super::CycleRequest); none: no duty
    /// cycle.
    pub profile: String,
}

/// How warm a gearbox gets: the results contract `willis-heat-1`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct HeatStudy {
    /// `willis-heat-1`.
    pub format: Format<Self>,
    /// Name of the train.
    pub train: String,
    /// Every operation asked for.
    pub operations: Vec<OperationHeat>,
    /// What a duty cycle makes of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub duty: Option<DutyHeat>,
    /// What stands in for data that were not given, and what the model leaves out.
    pub assumptions: Vec<String>,
    /// Warnings and notes.
    pub diagnostics: Vec<Diagnostic>,
}

impl Contract for HeatStudy {
    const FORMAT: &'static str = "willis-heat-1";
}

/// Heat of one operating point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct OperationHeat {
    /// Its name.
    pub name: String,
    /// The state of the shift table.
    pub state: Option<String>,
    /// What can be said of the operating point at the oil temperature in force.
    pub verdict: Verdict,
    /// Why there is no answer.
    pub reason: Option<String>,
    /// Power in, W.
    pub input_power_w: Option<f64>,
    /// Output over input power at that temperature.
    pub efficiency: Option<f64>,
    /// All losses there, W.
    pub loss_w: Option<f64>,
    /// Losses by source there, largest first.
    pub sources: Vec<LossSource>,
    /// Temperatures, and where the heat goes.
    pub heat: Option<Box<HeatReport>>,
    /// Largest load at which the oil stays at its limit.
    pub rating: Option<ThermalRating>,
    /// From a cold start on; none without heat capacities.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub warm_up: Option<WarmUp>,
    /// Why there is no warm-up, where there is heat to tell of.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub no_warm_up: Option<NoWarmUp>,
}

/// Why a warm-up cannot be told.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum NoWarmUp {
    /// The file gives the oil no heat capacity.
    NoCapacity,
    /// Some oil temperature on the way has no answer.
    NoAnswer,
    /// A place follows the others so fast that the run would take too many steps.
    TooFast,
}

impl NoWarmUp {
    /// For people.
    pub fn words(self) -> &'static str {
        match self {
            Self::NoCapacity => "the oil has no heat capacity; give `heat_capacity` or `mass`",
            Self::NoAnswer => "at some oil temperature on the way the losses have no single value",
            Self::TooFast => "a place has so little heat capacity that it follows at once; leave its capacity out",
        }
    }
}

/// The largest load that the limit of the oil temperature allows, all torques and powers scaled together.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ThermalRating {
    /// What can be said.
    pub status: RatingStatus,
    /// Factor on the load of the operating point at which the oil has its limit.
    pub load_factor: Option<f64>,
    /// Power in there, W: the thermal rating.
    pub input_power_w: Option<f64>,
    /// Heat in the gearbox there, W.
    pub heat_w: Option<f64>,
    /// Heat that is carried away at the limit, W.
    pub carried_w: f64,
}

/// What can be said of a thermal rating.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum RatingStatus {
    /// It is the load factor.
    Found,
    /// Without any load it is too hot.
    TooHotWithoutLoad,
    /// Heat is no limit up to 1024 times the load.
    NoLimit,
    /// The operating point has no single answer at some load.
    NoAnswer,
}

/// Temperatures from a start on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct WarmUp {
    /// Oil temperature at the start, K.
    pub start_k: f64,
    /// Places, in the order of the temperatures of a row.
    pub places: Vec<String>,
    /// Rows, evenly spaced in time.
    pub rows: Vec<HeatRow>,
    /// When the oil is within 1 K of where it tends to, s; absent where it is not in the time shown.
    pub settled_s: Option<f64>,
    /// When the oil passes its limit, s; rows end there.
    pub limit_after_s: Option<f64>,
    /// Heat made, J.
    pub made_j: f64,
    /// Heat carried away, J.
    pub carried_j: f64,
    /// Heat stored, J.
    pub stored_j: f64,
    /// Heat made less carried less stored, over the largest of them: round-off.
    pub audit: f64,
    /// Largest difference of the losses from those between which they were interpolated, over them.
    pub interpolation: f64,
    /// Steps of the integration.
    pub steps: u64,
}

/// Temperatures at a time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct HeatRow {
    /// Time, s.
    pub time_s: f64,
    /// Temperature of each place, K.
    pub temperatures_k: Vec<f64>,
    /// Heat made, W.
    pub heat_w: f64,
}

/// A duty cycle that repeats itself, in its steady state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct DutyHeat {
    /// How rows weigh. The order of shares is not known: they are taken together, as one mean heat.
    pub basis: Basis,
    /// Rows of the profile.
    pub rows_of_profile: u64,
    /// One period, s.
    pub period_s: f64,
    /// Time of rows without an answer, s; they make no heat here.
    pub without_answer_s: f64,
    /// Highest oil temperature, K.
    pub highest_k: f64,
    /// Lowest oil temperature, K.
    pub lowest_k: f64,
    /// Mean oil temperature over time, K.
    pub mean_k: f64,
    /// Limit less highest oil temperature, K.
    pub margin_k: f64,
    /// Mean heat, W.
    pub mean_heat_w: f64,
    /// Passes until the end was the start; 0 where rows have no order.
    pub passes: u64,
    /// Difference of start and end that is left, K.
    pub left_k: f64,
    /// Heat made less carried less stored, over the largest of them: the worst of all rows.
    pub audit: f64,
    /// Places, in the order of the temperatures of a row.
    pub places: Vec<String>,
    /// Temperatures at the end of each row of the profile, the start before them.
    pub rows: Vec<HeatRow>,
}

/// Heats of a source at evenly spaced oil temperatures, with cubics between them.
struct Tabulated {
    from: f64,
    step: f64,
    made: Vec<Vec<f64>>,
}

impl Tabulated {
    fn of<S: Source>(source: &S, from: f64, to: f64, nodes: usize) -> Result<Self, S::Error> {
        let step = (to - from) / (nodes - 1) as f64;
        let made = (0..nodes).map(|k| source.heat(from + step * k as f64)).collect::<Result<_, _>>()?;
        Ok(Self { from, step, made })
    }

    /// Largest difference of the total from the source in the middle of some intervals, over it.
    fn error<S: Source>(&self, source: &S) -> Result<f64, S::Error> {
        let n = self.made.len();
        let mut worst = 0.0f64;
        for k in [0, n / 4, n / 2, 3 * n / 4, n - 2] {
            let t = self.from + self.step * (k as f64 + 0.5);
            let (is, between) = (source.heat(t)?.iter().sum::<f64>(), self.at(t).iter().sum::<f64>());
            worst = worst.max((is - between).abs() / is.abs().max(f64::MIN_POSITIVE));
        }
        Ok(worst)
    }

    fn at(&self, oil: f64) -> Vec<f64> {
        let n = self.made.len();
        let x = ((oil - self.from) / self.step).clamp(0.0, (n - 1) as f64);
        let degree = 3.min(n - 1);
        let first = (x.floor() as usize).saturating_sub(1).min(n - 1 - degree);
        let mut all = vec![0.0; self.made[0].len()];
        for j in first..=first + degree {
            let others = (first..=first + degree).filter(|k| *k != j);
            let weight: f64 = others.map(|k| (x - k as f64) / (j as f64 - k as f64)).product();
            all.iter_mut().zip(&self.made[j]).for_each(|(sum, p)| *sum += weight * p);
        }
        all
    }
}

impl Source for Tabulated {
    type Error = NoHeat;

    fn heat(&self, oil: f64) -> Result<Vec<f64>, NoHeat> {
        Ok(self.at(oil))
    }
}

/// How warm a gearbox gets.
///
/// # Errors
/// A train without `[heat]`, an operation or state that there is not, an operation that makes no question, what is wrong
/// with the profile; and [`Code::Cancelled`].
///
/// # Example
/// A loss of 1 % of 20 kW and 10 W/K: 20 K above the air. At the limit of 95 °C the gearbox would carry 3.75 times that.
/// ```
/// use willis::Model;
/// use willis::study::{HeatRequest, heat};
/// use willis::work::Serial;
///
/// let model = Model::from_toml(r#"
///     format = 1
///     name = "one stage"
///     members = ["a", "b"]
///     terminals = ["a", "b"]
///     mesh = [{ gears = [{ member = "a", teeth = 20 }, { member = "b", teeth = 30 }], efficiency = 0.99 }]
///     heat = { ambient = "20 degC", conductance = "10 W/K", limit = "95 degC" }
///     [[operation]]
///     name = "rated"
///     speeds = { a = "1000 rad/s" }
///     torques = { a = "20 N m" }
/// "#)?;
/// let all = heat(&model, &HeatRequest::default(), &Serial)?;
/// let rated = &all.operations[0];
/// assert!((rated.heat.as_ref().unwrap().oil_k - 313.15).abs() < 1e-6);
/// assert!((rated.rating.unwrap().load_factor.unwrap() - 3.75).abs() < 1e-6);
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn heat(model: &Model, request: &HeatRequest, work: &dyn Work) -> Result<HeatStudy, Diagnostics> {
    let train = model.train();
    let Some(network) = train.heat() else {
        let d = Diagnostic::new(Code::MissingKey, "heat", "nothing says what carries the heat away");
        return Err(d.hint("add [heat] with `ambient` and `conductance`, or `area` and `height`").into());
    };
    let selection = Selection { state: request.state.clone(), operation: request.operation.clone() };
    selection.check(train)?;
    let mut network = network.clone();
    if let Some(t) = request.start_k {
        if !(200.0..network.limit).contains(&t) {
            let message = format!(
                "a start at {:.1} °C: it lies from -73 °C to below the limit of {:.1} °C",
                t - 273.15,
                network.limit - 273.15
            );
            return Err(Diagnostic::new(Code::OutOfRange, "", message).into());
        }
        network.start = t;
    }
    if let Some(t) = request.duration_s.filter(|t| !(t.is_finite() && *t > 0.0)) {
        let message = format!("a warm-up of {t} s: it takes some time");
        return Err(Diagnostic::new(Code::OutOfRange, "", message).into());
    }
    let chosen: Vec<&Operation> = train.operations().iter().filter(|o| selection.wants(train, o)).collect();
    if chosen.is_empty() && request.profile.is_empty() {
        let d = Diagnostic::new(Code::UnknownSelection, "", "heat belongs to an operating point, and there is none");
        return Err(d.hint("add an [[operation]] with speeds and torques or powers").into());
    }
    let (mut wrong, mut notes) = (Diagnostics::default(), Diagnostics::default());
    notes.extend(train.warnings().iter().cloned());
    let mut operations = Vec::new();
    work.begin("operations", chosen.len() as u64);
    for operation in chosen {
        if work.cancelled() {
            return Err(work::Cancelled.into());
        }
        match of_operation(train, &network, operation, request) {
            Ok((found, more)) => {
                operations.push(found);
                notes.extend(more);
            }
            Err(more) => wrong.extend(more),
        }
        work.advance(1);
    }
    let duty = match request.profile.is_empty() {
        true => None,
        false => Some(of_profile(model, &network, request, work)?),
    };
    if wrong.has_errors() {
        return Err(wrong);
    }
    Ok(HeatStudy {
        format: Format::new(),
        train: train.name().to_owned(),
        operations,
        duty,
        assumptions: assumptions(train),
        diagnostics: notes.into_iter().collect(),
    })
}

fn of_operation(
    train: &Train,
    network: &Heat,
    operation: &Operation,
    request: &HeatRequest,
) -> Result<(OperationHeat, Diagnostics), Diagnostics> {
    let (report, notes) = analysis::operate(train, operation)?;
    let solution: Option<&SolutionReport> = match &report.solutions[..] {
        [one] => Some(one),
        _ => None,
    };
    let losses = HeatOfLosses::new(train, network, operation);
    let heat = report.heat.clone();
    let rating = heat.as_ref().map(|_| rating(train, network, operation));
    let (warm_up, no_warm_up) = match heat.as_ref().map(|h| warming(network, &losses, h, request)) {
        None => (None, None),
        Some(Ok(run)) => (Some(run), None),
        Some(Err(why)) => (None, Some(why)),
    };
    let found = OperationHeat {
        name: report.name,
        state: report.state,
        verdict: report.verdict,
        reason: report.reason,
        input_power_w: solution.map(|s| s.input_power_w),
        efficiency: solution.and_then(|s| s.efficiency),
        loss_w: solution.map(|s| s.loss_w),
        sources: solution.map(|s| s.sources.clone()).unwrap_or_default(),
        heat,
        rating,
        warm_up,
        no_warm_up,
    };
    Ok((found, notes))
}

/// An operation with all its torques and powers scaled.
fn scaled(operation: &Operation, factor: f64) -> Operation {
    let factor = Rational::from_f64(factor).unwrap_or(Rational::ONE);
    let mut all = operation.clone();
    let quantities = all.loads.iter_mut().map(|l| &mut l.1).chain(all.machines.iter_mut().map(|m| &mut m.1));
    for load in quantities {
        let (Load::Torque(q) | Load::Power(q)) = load;
        q.value = &q.value * &factor;
    }
    for (_, store) in &mut all.stores {
        if let Store::Power(q) = store {
            q.value = &q.value * &factor;
        }
    }
    all
}

/// The largest load at the limit of the oil temperature. Losses rise with the load.
fn rating(train: &Train, network: &Heat, operation: &Operation) -> ThermalRating {
    let limit = network.limit;
    let carried = network.carried(limit).unwrap_or(f64::NAN);
    let mut all = ThermalRating {
        status: RatingStatus::NoAnswer,
        load_factor: None,
        input_power_w: None,
        heat_w: None,
        carried_w: carried,
    };
    // Heat that leaves the oil less what reaches it, W.
    let left = |factor: f64| {
        let made = HeatOfLosses::new(train, network, &scaled(operation, factor)).heat(limit).ok()?;
        network.at(limit, &made).ok().map(|at| at.residual)
    };
    // No load at all may be no question; a hundred-thousandth is none in effect.
    let Some(mut low) = left(0.0).or_else(|| left(1e-5)).map(|r| (0.0, r)) else { return all };
    if low.1 <= 0.0 {
        all.status = RatingStatus::TooHotWithoutLoad;
        return all;
    }
    let mut high = 1.0;
    let mut high = loop {
        let Some(r) = left(high) else { return all };
        if r <= 0.0 {
            break (high, r);
        }
        low = (high, r);
        high *= 2.0;
        if high > MOST_LOAD {
            all.status = RatingStatus::NoLimit;
            return all;
        }
    };
    // Illinois.
    let (mut a, mut b) = (low.1, high.1);
    for round in 1..100 {
        if high.0 - low.0 <= 1e-9 * high.0 || high.1 == 0.0 {
            break;
        }
        let secant = high.0 - b * (high.0 - low.0) / (b - a);
        let middle = 0.5 * (low.0 + high.0);
        let next = if round % 4 == 0 || !(low.0..high.0).contains(&secant) { middle } else { secant };
        let Some(r) = left(next) else { return all };
        if r > 0.0 {
            low = (next, r);
            (a, b) = (r, 0.5 * b);
        } else {
            high = (next, r);
            (a, b) = (0.5 * a, r);
        }
        if (r / carried).abs() < 1e-12 {
            break;
        }
    }
    // The end that is nearer.
    let factor = if low.1.abs() < high.1.abs() { low.0 } else { high.0 };
    let at = Operation { temperature: Some(limit), ..scaled(operation, factor) };
    let Ok((report, _)) = analysis::operate_unnamed(train, &at) else { return all };
    all.status = RatingStatus::Found;
    all.load_factor = Some(factor);
    all.input_power_w = report.solutions.first().map(|s| s.input_power_w);
    all.heat_w = report.heat.map(|h| h.heat_w);
    all
}

/// Temperatures from the start on.
fn warming(
    network: &Heat,
    losses: &HeatOfLosses<'_>,
    report: &HeatReport,
    request: &HeatRequest,
) -> Result<WarmUp, NoWarmUp> {
    if network.nodes[OIL].capacity <= 0.0 {
        return Err(NoWarmUp::NoCapacity);
    }
    let table = Tabulated::of(losses, network.coldest(network.start), network.limit, NODES);
    let table = table.map_err(|_| NoWarmUp::NoAnswer)?;
    let interpolation = table.error(losses).map_err(|_| NoWarmUp::NoAnswer)?;
    // A given temperature is no state that a warm-up leads to: what the losses alone do is shown.
    let limits = Limits { highest: network.limit, tolerance: 1e-6 };
    let found = balance(network, &table, limits).map_err(|_| NoWarmUp::NoAnswer)?;
    let tends = found.from(network.start).map(|e| e.at.oil);
    let capacity: f64 = network.nodes.iter().map(|n| n.capacity).sum();
    let slowest = report.time_constants_s.first().copied().filter(|t| *t > 0.0);
    let nothing = vec![0.0; network.nodes.len()];
    let slope = network.at(network.limit, &nothing).map_err(|_| NoWarmUp::NoAnswer)?.slope;
    let duration = request.duration_s.unwrap_or_else(|| CONSTANTS * slowest.unwrap_or(capacity / slope));
    let mut times: Vec<f64> = (0..=ROWS).map(|k| duration * k as f64 / ROWS as f64).collect();
    let start: Vec<f64> = network.nodes.iter().map(|n| n.fixed.unwrap_or(network.start)).collect();
    let until = |times: &[f64]| warm_up(network, &table, &start, times, TOLERANCE).map_err(|_| NoWarmUp::TooFast);
    let mut run: Run = until(&times)?;
    let passed = (1..run.rows.len()).find(|&k| run.rows[k].temperatures[OIL] > network.limit);
    let limit_after_s = passed.map(|k| {
        let [a, b] = [k - 1, k].map(|k| run.rows[k].temperatures[OIL]);
        times[k - 1] + (network.limit - a) / (b - a) * (times[k] - times[k - 1])
    });
    if let (Some(k), Some(end)) = (passed, limit_after_s) {
        // Losses are not known beyond: the run ends there, and what it says of heat ends with it.
        times.truncate(k);
        times.push(end);
        run = until(&times)?;
    }
    let oil = |k: usize| run.rows[k].temperatures[OIL];
    let settled = tends.filter(|_| passed.is_none()).and_then(|goal| {
        let last = (0..run.rows.len()).rfind(|&k| (oil(k) - goal).abs() > 1.0);
        match last {
            None => Some(0.0),
            Some(k) if k + 1 < run.rows.len() => {
                let [a, b] = [k, k + 1].map(|k| (oil(k) - goal).abs());
                Some(times[k] + (a - 1.0) / (a - b) * (times[k + 1] - times[k]))
            }
            Some(_) => None,
        }
    });
    Ok(WarmUp {
        start_k: network.start,
        places: network.nodes.iter().map(|n| n.name.clone()).collect(),
        rows: run.rows.iter().map(row).collect(),
        settled_s: settled,
        limit_after_s,
        made_j: run.made,
        carried_j: run.carried,
        stored_j: run.stored,
        audit: run.audit(),
        interpolation,
        steps: run.steps as u64,
    })
}

fn row(r: &crate::heat::Row) -> HeatRow {
    HeatRow { time_s: r.time, temperatures_k: r.temperatures.clone(), heat_w: r.made }
}

/// The steady state of a duty cycle.
pub(super) fn of_profile(
    model: &Model,
    network: &Heat,
    request: &HeatRequest,
    work: &dyn Work,
) -> Result<DutyHeat, Diagnostics> {
    let profile = Profile::parse(&request.profile, model)?;
    let given = |k: usize| profile.settings(k).iter().any(|s| *s.0 == Target::Temperature);
    if profile.conditions() > 0 && given(0) {
        let message = "the profile gives the oil temperature, and a duty cycle finds it";
        return Err(Diagnostic::new(Code::Conflict, "", message).hint("leave that column out").into());
    }
    let question = PointSetup::new(model, request.operation.as_deref(), request.state.as_deref(), Hold::AsGiven)?;
    of_rows(&question, &profile, network, work)
}

/// The same for a profile that was read.
pub(super) fn of_rows(
    question: &PointSetup<'_>,
    profile: &Profile,
    network: &Heat,
    work: &dyn Work,
) -> Result<DutyHeat, Diagnostics> {
    let n = profile.conditions();
    let surroundings =
        |k: usize| profile.settings(k).iter().any(|s| matches!(s.0, Target::File(key) if key.is_in("heat")));
    if n > 0 && surroundings(0) {
        let message = "the profile changes a key of [heat]; what surrounds a duty cycle stays as it is";
        return Err(Diagnostic::new(Code::Unfit, "", message)
            .hint("leave that column out, or ask for a sweep over it")
            .into());
    }
    let nodes = (MOST_NODES / n.max(1)).clamp(4, NODES);
    let train = question.model().train();
    work.afford(&Effort::of_points(train, (n * nodes) as u64))?;
    work.begin("conditions", n as u64);
    let from = network.coldest(network.start);
    let tables = work::map(work, n, |k| {
        let settings = profile.settings(k);
        let asked = question.at(&settings, &mut TrainCache::default());
        let table = asked.ok().and_then(|(own, mut operation)| {
            operation.temperature = None;
            Tabulated::of(&HeatOfLosses::new(&own, network, &operation), from, network.limit, nodes).ok()
        });
        work.advance(1);
        table.map(|t| t.made)
    })?;
    let step = (network.limit - from) / (nodes - 1) as f64;
    let nothing = vec![vec![0.0; network.nodes.len()]; nodes];
    let all: Vec<Tabulated> = (tables.iter())
        .map(|made| Tabulated { from, step, made: made.clone().unwrap_or_else(|| nothing.clone()) })
        .collect();
    let unanswered = profile.rows().iter().filter(|r| tables[r.condition as usize].is_none());
    let without_answer_s: f64 = unanswered.map(|r| r.duration_s).sum();
    if without_answer_s >= profile.total_s() {
        let message = "no row of the profile has an answer at every oil temperature up to the limit";
        return Err(Diagnostic::new(Code::Unfit, "", message).into());
    }
    let no_heat = |_| {
        let message = "the oil has no heat capacity, or the thermal network no finite temperatures";
        let d = Diagnostic::new(Code::MissingKey, "heat.heat_capacity", message);
        Diagnostics::from(d.hint("give `heat_capacity` or `mass` of the oil and what warms with it"))
    };
    let mut found = DutyHeat {
        basis: profile.basis(),
        rows_of_profile: profile.rows().len() as u64,
        period_s: profile.total_s(),
        without_answer_s,
        highest_k: f64::NAN,
        lowest_k: f64::NAN,
        mean_k: f64::NAN,
        margin_k: f64::NAN,
        mean_heat_w: f64::NAN,
        passes: 0,
        left_k: 0.0,
        audit: 0.0,
        places: network.nodes.iter().map(|n| n.name.clone()).collect(),
        rows: vec![],
    };
    if profile.basis() == Basis::Shares {
        let mut mean = nothing;
        for r in profile.rows() {
            let weight = r.duration_s / profile.total_s();
            for (sum, made) in mean.iter_mut().zip(&all[r.condition as usize].made) {
                sum.iter_mut().zip(made).for_each(|(s, p)| *s += weight * p);
            }
        }
        let mean = Tabulated { from, step, made: mean };
        let steady = balance(network, &mean, Limits { highest: network.limit, tolerance: 1e-7 }).map_err(no_heat)?;
        let (at, heat) = match steady.from(network.start) {
            Some(e) => (e.at.oil, &e.at.made),
            None => (network.limit, &steady.at_limit().made),
        };
        (found.highest_k, found.lowest_k, found.mean_k) = (at, at, at);
        found.mean_heat_w = heat.iter().sum();
        // Beyond the limit nothing is told but that.
        found.margin_k = if steady.from(network.start).is_some() { network.limit - at } else { f64::NEG_INFINITY };
    } else {
        let rows = profile.rows().iter().filter(|r| r.duration_s > 0.0);
        let segments: Vec<Segment<'_, Tabulated>> =
            rows.map(|r| Segment { duration: r.duration_s, source: &all[r.condition as usize] }).collect();
        let periodic = duty(network, &segments, TOLERANCE).map_err(no_heat)?;
        (found.highest_k, found.lowest_k, found.mean_k) = (periodic.highest, periodic.lowest, periodic.mean);
        found.margin_k = network.limit - periodic.highest;
        found.mean_heat_w = periodic.runs.iter().map(|r| r.made).sum::<f64>() / profile.total_s();
        found.passes = periodic.passes as u64;
        found.left_k = periodic.left;
        found.audit = periodic.runs.iter().map(Run::audit).fold(0.0, f64::max);
        let mut time = 0.0;
        for (k, (run, segment)) in periodic.runs.iter().zip(&segments).enumerate() {
            if k == 0 {
                found.rows.push(row(&run.rows[0]));
            }
            time += segment.duration;
            let last = run.rows.last().expect("a run has its ends");
            found.rows.push(HeatRow { time_s: time, ..row(last) });
        }
    }
    if found.highest_k > network.limit || !found.margin_k.is_finite() {
        let message = format!(
            "in this duty cycle the oil passes its limit of {:.1} °C; losses are not computed beyond it",
            network.limit - 273.15
        );
        let d = Diagnostic::new(Code::NoHeatBalance, "heat.limit", message);
        return Err(d.hint("less load, a larger area, moving air or a cooler helps; or allow more").into());
    }
    Ok(found)
}
