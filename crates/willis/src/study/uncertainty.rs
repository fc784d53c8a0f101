//! How sure a number is: the distribution of results when quantities are uncertain, and what dominates it.

mod assumed;
mod report;

use std::ops::Range;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::analysis::Losses;
use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::model::{Model, ShaftRef, Target};
use crate::train::{Load, Measure, Operation, Store, Train, VariatorPath};
use crate::units::{self, Quantity, with_unit};
use crate::work::{self, Cancelled, Effort, Work};

use super::answer::{Detail, LawChoice, PointAnswer, PointAnswers, PointVerdict};
use super::column::{Column, ColumnTable};
use super::design::Design;
use super::distribution::{Distribution, Reader, fault, plain, rounded};
use super::question::{Hold, PointSetup, TrainCache, speeds};
use super::summary::{self, Seen, WarningKind};
use super::{Axis, Statistics};

pub use report::{ChoiceResult, Influence, UncertainQuantity, UncertainResult, Uncertainty};

/// Most samples of a plan.
const MOST_SAMPLES: usize = 1 << 16;
/// A sampled number is a decimal of so many digits, which the train file can say too.
const DIGITS: usize = 9;

/// What an uncertainty is asked.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct UncertaintyRequest {
    /// The operation of the train file whose efficiency and losses are asked. Default: the first one that suits the
    /// state.
    pub operation: Option<String>,
    /// The state of the shift table. Default: that of the operation.
    pub state: Option<String>,
    /// What is uncertain, each a quantity and its distribution. `P1.mesh_efficiency=0.985..0.995`: everything between is
    /// equally likely; `oil.temperature=normal(70 degC, 5 K)`: mean and standard deviation;
    /// `P1.sun.roughness=triangular(0.2, 0.4, 0.8 um)`: least, most likely, greatest;
    /// `P1.sun.roughness=lognormal(0.4 um, 1.3)`: median and factor; `P1.geometry.width=+-5%`: about the value of the file;
    /// `state=3,4`: these values, each as likely as the others. Default, where no laws are named either: the given
    /// losses and roughnesses by ±20 %, the oil's temperature by ±5 K, and the friction laws.
    pub vary: Vec<String>,
    /// Families of loss laws whose laws are each as likely as the others, `mesh_friction`; `all` takes every family that
    /// matters for this train.
    pub laws: Vec<String>,
    /// How many samples are drawn, from 128 to 65536; made a power of two. Default: 1024.
    pub samples: usize,
    /// The seed: the same seed gives the same samples everywhere, another one gives others. Default: 1.
    pub seed: u64,
}

impl Default for UncertaintyRequest {
    fn default() -> Self {
        Self { operation: None, state: None, vary: vec![], laws: vec![], samples: 1024, seed: 1 }
    }
}

/// How an uncertain quantity is distributed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(untagged)]
pub enum UncertainValue {
    /// A number between others.
    Between(Distribution),
    /// Each of these is as likely as the others.
    Each(Vec<String>),
}

/// A quantity that is uncertain.
#[derive(Clone, Debug)]
pub struct Uncertain {
    /// Its name.
    pub name: String,
    /// Its unit; empty for plain numbers and texts.
    pub unit: String,
    /// How it is distributed.
    pub likely: UncertainValue,
    /// What the file has, as written.
    pub nominal: Option<String>,
    target: Target,
}

impl Uncertain {
    /// Its value at a coordinate from 0 to 1, as the train file writes it.
    pub fn setting(&self, p: f64) -> String {
        match &self.likely {
            UncertainValue::Between(d) => self.text(d.quantile(p)),
            UncertainValue::Each(all) => all[self.choice(p)].clone(),
        }
    }

    /// Its column in a table of samples.
    fn column(&self) -> Column {
        match self.likely {
            UncertainValue::Between(_) => Column::number(with_unit(&self.name, &self.unit), self.unit.clone()),
            UncertainValue::Each(_) => Column::text(self.name.clone()),
        }
    }

    /// The number of the choice at a coordinate; 0 for a number between others.
    fn choice(&self, p: f64) -> usize {
        match &self.likely {
            UncertainValue::Between(_) => 0,
            UncertainValue::Each(all) => ((p * all.len() as f64) as usize).min(all.len() - 1),
        }
    }

    fn text(&self, x: f64) -> String {
        // Rounded as it is evaluated.
        let number = plain(x, DIGITS);
        if self.unit.is_empty() { number } else { format!("{number} {}", self.unit) }
    }

    /// Its distribution in words.
    pub fn describe(&self) -> String {
        match &self.likely {
            UncertainValue::Between(d) => d.describe(&self.unit),
            UncertainValue::Each(all) => all.join(", "),
        }
    }
}

/// An uncertainty in memory.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct UncertaintyAnswer {
    /// The distributions, and what dominates them.
    pub report: Uncertainty,
    /// Every sample: the values of the uncertain quantities, the verdict and the results.
    pub samples: ColumnTable,
}

/// How sure the results of an operating point are.
///
/// The answer does not depend on how `work` shares the points out.
///
/// # Errors
/// What [`UncertaintyPlan::new`] refuses, and [`Code::Cancelled`].
///
/// # Example
/// ```
/// use willis::model::Model;
/// use willis::study::{UncertaintyRequest, uncertainty};
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
///     [[operation]]
///     name = "full load"
///     speeds = { s = "1000 rpm" }
///     torques = { s = "10 N m" }
/// "#)?;
/// let vary = vec!["P1.mesh_efficiency=0.98..1".into()];
/// let answer = uncertainty(&model, &UncertaintyRequest { vary, samples: 256, ..Default::default() }, &Serial)?;
/// assert_eq!(answer.samples.len(), 256);
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn uncertainty(
    model: &Model,
    request: &UncertaintyRequest,
    work: &dyn Work,
) -> Result<UncertaintyAnswer, Diagnostics> {
    let plan = UncertaintyPlan::new(model, request)?;
    work.afford(&plan.effort())?;
    let evaluated = plan.evaluate_all(work)?;
    Ok(plan.answered(&evaluated))
}

/// Uncertain quantities, an operating point, and the points at which it is evaluated.
///
/// Work comes in pieces, so that a caller can spread it over processors: every piece is a range of points, and pieces
/// [joined](SampleResult::join) in their order give the same result however they were cut.
///
/// # Example
/// ```
/// use willis::model::Model;
/// use willis::study::{UncertaintyPlan, UncertaintyRequest};
///
/// let text = r#"
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
///     [[operation]]
///     name = "full load"
///     speeds = { s = "1000 rpm" }
///     torques = { s = "10 N m" }
/// "#;
/// let model = Model::from_toml(text).unwrap();
/// let vary = vec!["P1.mesh_efficiency=0.98..1".into()];
/// let request = UncertaintyRequest { vary, samples: 256, ..Default::default() };
/// let plan = UncertaintyPlan::new(&model, &request)?;
/// let evaluated = plan.evaluate(0..plan.len(), &mut Default::default());
/// let found = plan.finish(&evaluated);
/// // (1 − i0 η²)/(1 − i0) with i0 = −7/3 is monotonous in η: its median is that of η.
/// let efficiency = found.output("efficiency").unwrap().statistics.unwrap();
/// assert!((efficiency.median - 0.98607).abs() < 2.0 * efficiency.sampling_error.median);
/// # Ok::<(), willis::diagnostic::Diagnostics>(())
/// ```
#[derive(Clone, Debug)]
pub struct UncertaintyPlan<'s> {
    question: PointSetup<'s>,
    quantities: Vec<Uncertain>,
    design: Design,
    assumptions: Vec<String>,
    warnings: Vec<String>,
    /// Of the values of a point.
    outputs: Vec<Column>,
    nominal: Vec<f64>,
    nominal_verdict: PointVerdict,
}

/// Values at some points. It can be sent to another machine and says the same there, bit for bit.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SampleResult {
    /// Of every point.
    verdicts: Vec<PointVerdict>,
    /// Of every point: one for each output; NaN where there is none.
    #[serde(with = "bits")]
    values: Vec<f64>,
    seen: Seen,
}

impl SampleResult {
    /// Adds what was found at the points that follow.
    pub fn join(&mut self, later: Self) {
        self.verdicts.extend(later.verdicts);
        self.values.extend(later.values);
        summary::join(&mut self.seen, &later.seen);
    }

    /// Counts what is to be said of a point.
    fn see(&mut self, point: u64, answer: &PointAnswer) {
        if !answer.reason.is_empty() {
            summary::see(&mut self.seen, WarningKind::Reason(answer.verdict), &answer.reason, None, point);
        }
        let mut told: Vec<WarningKind> = vec![];
        for warning in &answer.warnings {
            // Laws are counted one by one, places and numbers are not.
            let kind = WarningKind::Warning { code: warning.code, law: warning.law.clone() };
            if !told.contains(&kind) {
                summary::see(&mut self.seen, kind.clone(), &warning.message, warning.deviation, point);
                told.push(kind);
            }
        }
    }
}

/// Numbers by their bits: text has no NaN, and programs differ in the last digit.
mod bits {
    use serde::{Deserialize, Deserializer, Serializer};

    pub fn serialize<S: Serializer>(all: &[f64], to: S) -> Result<S::Ok, S::Error> {
        to.collect_seq(all.iter().map(|x| x.to_bits()))
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<f64>, D::Error> {
        Ok(Vec::<u64>::deserialize(from)?.into_iter().map(f64::from_bits).collect())
    }
}

/// `first, second and third`.
fn listed(all: &[String]) -> String {
    match all {
        [rest @ .., last] if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        _ => all.join(""),
    }
}

fn errors(wrong: Diagnostics) -> String {
    PointAnswer::refused(wrong).reason
}

impl<'s> UncertaintyPlan<'s> {
    /// Reads what is uncertain, and checks that the operating point has an answer to begin with.
    ///
    /// # Errors
    /// No operating point, unknown quantities, distributions that mean nothing, quantities named twice; a train that is
    /// refused with every quantity at the middle of its distribution.
    pub fn new(model: &'s Model, request: &UncertaintyRequest) -> Result<Self, Diagnostics> {
        let mut wrong = Diagnostics::default();
        let question = PointSetup::new(model, request.operation.as_deref(), request.state.as_deref(), Hold::AsGiven)?;
        if question.base().loads.is_empty() {
            let message = match &request.state {
                Some(state) => {
                    format!("uncertainty belongs to an operating point, and there is none in state `{state}`")
                }
                None => "uncertainty belongs to an operating point, and there is none".into(),
            };
            let d = Diagnostic::new(Code::UnknownSelection, "", message);
            return Err([d.hint("add an [[operation]] with speeds and torques or powers")].into_iter().collect());
        }
        let (mut quantities, mut assumptions): (Vec<Uncertain>, Vec<String>) = (vec![], vec![]);
        for text in &request.vary {
            match read(text, &question, &mut assumptions) {
                Ok(q) => quantities.push(q),
                Err(d) => wrong.push(*d),
            }
        }
        let before = quantities.len();
        for family in &request.laws {
            match assumed::laws(family, &question) {
                Ok(found) => {
                    let new = found.into_iter().filter(|(q, _)| {
                        !(family == "all" && quantities[..before].iter().any(|o| o.target == q.target))
                    });
                    let (more, told): (Vec<_>, Vec<_>) = new.unzip();
                    quantities.extend(more);
                    assumptions.extend(told);
                }
                Err(d) => wrong.push(*d),
            }
        }
        for (k, q) in quantities.iter().enumerate() {
            if quantities[..k].iter().any(|o| o.target == q.target) {
                wrong.push(fault(&q.name, "this quantity is named twice"));
            }
        }
        if !(128..=MOST_SAMPLES).contains(&request.samples) {
            let message = format!(
                "{} samples are too {}",
                request.samples,
                match request.samples {
                    0..128 => "few to tell a distribution",
                    _ => "many",
                }
            );
            let d = Diagnostic::new(Code::BadAxis, "", message);
            wrong.push(d.hint(format!("from 128 to {MOST_SAMPLES} are possible")));
        }
        if wrong.has_errors() {
            return Err(wrong);
        }
        if request.vary.is_empty() && request.laws.is_empty() {
            (quantities, assumptions) = assumed::quantities(&question);
            if quantities.is_empty() {
                let message = "nothing that the file gives is uncertain by itself: no efficiency below 1, no roughness, \
                               no oil, no computed friction";
                let d = Diagnostic::new(Code::BadAxis, "", message);
                let hint = "name what is uncertain in `vary`, such as \"P1.mesh_efficiency=0.985..0.995\"";
                return Err([d.hint(hint)].into_iter().collect());
            }
        }
        let samples = Design::possible(request.samples);
        if samples != request.samples {
            assumptions.push(format!("{samples} samples in place of {}: a power of two", request.samples));
        }
        if quantities.len() > 1 {
            assumptions.push("the uncertain quantities are independent of each other".into());
        }
        let cut = |q: &Uncertain| {
            matches!(&q.likely, UncertainValue::Between(Distribution::Normal { .. } | Distribution::Lognormal { .. }))
        };
        if quantities.iter().any(cut) {
            assumptions.push("normal and lognormal distributions are cut off at three standard deviations".into());
        }
        let design = Design::new(quantities.len(), samples, request.seed)?;
        let mut plan = Self {
            question,
            quantities,
            design,
            assumptions,
            warnings: vec![],
            outputs: vec![],
            nominal: vec![],
            nominal_verdict: PointVerdict::Refused,
        };
        plan.name_outputs();
        plan.check()?;
        Ok(plan)
    }

    fn name_outputs(&mut self) {
        let train = self.question.model().train();
        self.outputs = vec![Column::number("efficiency", ""), Column::number("loss_w", "W")];
        let kinds = Losses::of_train(self.question.model().train());
        self.outputs.extend(kinds.map(|k| Column::number(Losses::column(k), "W")));
        self.outputs.extend(sources(train).map(|name| Column::number(format!("{name}.total_loss_w"), "W")));
        let answer = PointAnswer::of(train, self.question.base());
        self.nominal = self.values(&answer);
        self.nominal_verdict = answer.verdict;
    }

    /// The middle must be possible; ends that are not are told.
    fn check(&mut self) -> Result<(), Diagnostics> {
        let middle: Vec<f64> = vec![0.5; self.quantities.len()];
        let ask = |p: &[f64]| self.question.at(&self.settings_at(p), &mut TrainCache::default()).map(drop);
        ask(&middle).map_err(|wrong| {
            let hint = "so it is with every quantity at the middle of its distribution";
            let told = wrong.into_iter().map(|d| d.hint(hint));
            told.collect::<Diagnostics>()
        })?;
        let mut warnings = vec![];
        for (k, q) in self.quantities.iter().enumerate() {
            let at: Vec<f64> = match &q.likely {
                UncertainValue::Between(_) => vec![1e-9, 1.0 - 1e-9],
                UncertainValue::Each(all) => (0..all.len()).map(|c| (c as f64 + 0.5) / all.len() as f64).collect(),
            };
            for p in at {
                let mut place = middle.clone();
                place[k] = p;
                if let Err(why) = ask(&place) {
                    // The end itself, not a number beside it.
                    let shown = match &q.likely {
                        UncertainValue::Between(d) => q.text(d.ends()[usize::from(p > 0.5)]),
                        UncertainValue::Each(_) => q.setting(p),
                    };
                    let message = format!(
                        "{} = {shown} is refused: {}; samples like it are counted, and have no result",
                        q.name,
                        errors(why)
                    );
                    warnings.push(message);
                }
            }
        }
        self.warnings = warnings;
        Ok(())
    }

    /// How many points there are; more than samples, for what dominates.
    pub fn len(&self) -> usize {
        self.design.len()
    }

    /// Whether there are none; never.
    pub fn is_empty(&self) -> bool {
        false
    }

    /// How much work all points are.
    pub fn effort(&self) -> Effort {
        self.question.effort(self.len() as u64, 1)
    }

    /// So many points belong together: pieces of whole groups read the train file less often.
    pub fn group(&self) -> usize {
        self.design.group()
    }

    /// Where it is evaluated.
    pub fn design(&self) -> &Design {
        &self.design
    }

    /// What is uncertain.
    pub fn quantities(&self) -> &[Uncertain] {
        &self.quantities
    }

    /// What is asked.
    pub fn question(&self) -> &PointSetup<'s> {
        &self.question
    }

    fn settings_at(&self, p: &[f64]) -> Vec<(&Target, String)> {
        self.quantities.iter().zip(p).map(|(q, p)| (&q.target, q.setting(*p))).collect()
    }

    /// The values of the quantities at a point, as the train file writes them.
    pub fn settings(&self, point: usize) -> Vec<String> {
        self.quantities.iter().zip(self.design.at(point)).map(|(q, p)| q.setting(p)).collect()
    }

    /// The answer at a point.
    pub fn answer(&self, point: usize, trains: &mut TrainCache) -> PointAnswer {
        match self.question.at(&self.settings_at(&self.design.at(point)), trains) {
            Ok((train, operation)) => PointAnswer::of(&train, &operation),
            Err(wrong) => PointAnswer::refused(wrong),
        }
    }

    /// The answer at a value of an axis: at a point, or with the file as written. A quantity that is itself the axis
    /// takes the axis' value.
    pub fn answer_along(&self, point: Option<usize>, axis: &Axis, k: usize, trains: &mut TrainCache) -> PointAnswer {
        match self.asked_along(point, axis, k, trains) {
            Ok((train, operation)) => PointAnswer::of(&train, &operation),
            Err(wrong) => PointAnswer::refused(wrong),
        }
    }

    /// What [`UncertaintyPlan::answer_along`] answers: the train and the operating point.
    ///
    /// # Errors
    /// They are not possible with these values.
    pub fn asked_along(
        &self,
        point: Option<usize>,
        axis: &Axis,
        k: usize,
        trains: &mut TrainCache,
    ) -> Result<(Arc<Train>, Operation), Diagnostics> {
        let mut settings = point.map_or_else(Vec::new, |p| self.settings_at(&self.design.at(p)));
        settings.retain(|s| *s.0 != axis.target);
        settings.push((&axis.target, axis.setting(k)));
        self.question.at(&settings, trains)
    }

    /// The values at every point.
    ///
    /// # Errors
    /// The work was cancelled.
    pub fn evaluate_all(&self, work: &dyn Work) -> Result<SampleResult, Cancelled> {
        self.evaluate_within(0..self.len(), work)
    }

    /// The values at a range of points, which `work` shares out.
    ///
    /// # Errors
    /// The work was cancelled.
    pub fn evaluate_within(&self, points: Range<usize>, work: &dyn Work) -> Result<SampleResult, Cancelled> {
        // Whole groups. The first point of a piece is answered the long way, so there are not too many pieces; and enough for
        // many processors.
        let piece = (points.len() / 64).clamp(64, 512);
        let piece = self.group() * (piece / self.group()).max(1);
        work.begin("points", points.len() as u64);
        let parts = work::map(work, points.len().div_ceil(piece), |k| {
            let from = points.start + k * piece;
            let own = from..(from + piece).min(points.end);
            let part = self.evaluate(own.clone(), &mut TrainCache::of_samples());
            work.advance(own.len() as u64);
            part
        })?;
        let mut all = SampleResult::default();
        parts.into_iter().for_each(|part| all.join(part));
        Ok(all)
    }

    /// The points of piece `k` of `n`, counted from 0: whole groups, as many in each piece as in any other or one more.
    ///
    /// # Panics
    /// If `n` is 0 or `k` is not below it.
    pub fn piece(&self, k: usize, n: usize) -> Range<usize> {
        assert!(k < n, "piece {k} of {n}");
        let groups = self.len().div_ceil(self.group());
        // Wide enough for as many groups and pieces as there may be.
        let at = |k: usize| (groups as u128 * k as u128 / n as u128) as usize * self.group();
        at(k).min(self.len())..at(k + 1).min(self.len())
    }

    /// The answer from the values at all points, in their order; nothing if they are not those of this plan.
    pub fn answer_of(&self, evaluated: &SampleResult) -> Option<UncertaintyAnswer> {
        let fits = evaluated.verdicts.len() == self.len() && evaluated.values.len() == self.len() * self.outputs.len();
        fits.then(|| self.answered(evaluated))
    }

    fn answered(&self, evaluated: &SampleResult) -> UncertaintyAnswer {
        UncertaintyAnswer { report: self.finish(evaluated), samples: self.table(evaluated) }
    }

    /// The values at a range of points.
    pub fn evaluate(&self, points: Range<usize>, trains: &mut TrainCache) -> SampleResult {
        let mut all = SampleResult::default();
        let mut place = points.clone();
        let asked = points.map(|point| self.question.at(&self.settings_at(&self.design.at(point)), trains));
        PointAnswers::each_with(asked, Detail::Sources, |answer, _| {
            let point = place.next().expect("as many answers as points");
            all.verdicts.push(answer.verdict);
            all.values.extend(self.values(&answer));
            if self.design.is_sample(point) {
                all.see(point as u64, &answer);
            }
        });
        all
    }

    fn values(&self, answer: &PointAnswer) -> Vec<f64> {
        let Some(n) = answer.numbers.as_ref().filter(|_| answer.is_unique()) else {
            return vec![f64::NAN; self.outputs.len()];
        };
        let mut values = vec![answer.efficiency(), n.loss_w];
        let losses = n.losses_w.all();
        values.extend(Losses::of_train(self.question.model().train()).map(|k| losses[k]));
        values.extend(sources(self.question.model().train()).map(|name| {
            let mut own = answer.sources().iter().filter(|x| x.name == name).map(|x| x.loss_w).peekable();
            match (own.peek(), &answer.solution) {
                (Some(_), _) => own.sum(),
                (None, None) => 0.0,
                (None, Some(s)) => match s.meshes.get(name) {
                    Some(mesh) => mesh.loss_w,
                    None => s.variators.get(name).map_or(0.0, |v| v.loss_w),
                },
            }
        }));
        values
    }
}

/// Names of what may lose power.
fn sources(train: &Train) -> impl Iterator<Item = &str> {
    (train.meshes().iter().map(|m| m.name.as_str()))
        .chain(train.bearings.iter().map(|b| b.name.as_str()))
        .chain(train.seals.iter().map(|s| s.name.as_str()))
        .chain(train.rotors.iter().map(|r| r.name.as_str()))
        .chain(train.drags.iter().map(|d| d.name.as_str()))
        .chain(train.pumps.iter().map(|p| p.name.as_str()))
        .chain(train.shift_elements.iter().filter(|e| e.open.is_some()).map(|e| e.name.as_str()))
        .chain(train.variators.iter().map(|v| v.name.as_str()))
}

/// Reads `QUANTITY=DISTRIBUTION`.
fn read(text: &str, question: &PointSetup<'_>, assumptions: &mut Vec<String>) -> Result<Uncertain, Box<Diagnostic>> {
    let model = question.model();
    let Some((name, values)) = text.split_once('=') else {
        return Err(Box::new(fault(text, "there is no `=` between a quantity and its distribution")));
    };
    let (name, values) = (name.trim(), values.trim());
    let target = Target::parse(name, model)?;
    if values.is_empty() {
        return Err(Box::new(fault(text, "there is no distribution")));
    }
    let measure = target.measure(model);
    let nominal = nominal(&target, question);
    let found = |unit: String, likely: UncertainValue| Uncertain {
        name: name.to_owned(),
        unit,
        likely,
        nominal: nominal.clone(),
        target: target.clone(),
    };
    let list = || values.split(',').map(|v| v.trim().to_owned()).collect::<Vec<_>>();
    if let Target::Law(family) = target
        && matches!(values, "all" | "inside")
    {
        let (laws, told) = assumed::laws_of(family, question, values == "inside");
        if laws.len() < 2 {
            return Err(Box::new(fault(text, "this train can use no two laws of the family")));
        }
        assumptions.push(told);
        return Ok(found(String::new(), UncertainValue::Each(laws)));
    }
    let base = nominal.as_deref().and_then(|b| Reader::base_of(b, measure));
    let reader = Reader { whole: text, measure, base };
    let all = match measure {
        Measure::Text | Measure::Flag => target.choices(model, &list()).unwrap_or_else(list),
        Measure::Integer if values.contains("..") => {
            let ends = values
                .split_once("..")
                .and_then(|(a, b)| Some((a.trim().parse::<i64>().ok()?, b.trim().parse().ok()?)));
            match ends {
                Some((a, b)) if a < b && b - a < 1000 => (a..=b).map(|n| n.to_string()).collect(),
                Some((a, b)) if a >= b => {
                    let message = format!("the interval runs backwards or is empty, from {a} to {b}");
                    return Err(Box::new(fault(text, message)));
                }
                _ => return Err(Box::new(fault(text, "whole numbers are written `3..6` or `3,4,6`"))),
            }
        }
        _ => match reader.read(values)? {
            Some(_) if measure == Measure::Integer => {
                return Err(Box::new(fault(text, "whole numbers are written `3..6` or `3,4,6`")));
            }
            Some(read) => {
                // What the file says of a number of this kind, before anything is computed.
                return Ok(found(read.unit, UncertainValue::Between(read.distribution)));
            }
            None => {
                let mut all = list();
                let unit = all.iter().filter_map(|v| Reader::base_of(v, measure)).map(|b| b.1).find(|u| !u.is_empty());
                if let Some(unit) = unit {
                    let bare = |v: &String| Reader::base_of(v, measure).is_some_and(|b| b.1.is_empty());
                    all.iter_mut().filter(|v| bare(v)).for_each(|v| *v = format!("{v} {unit}"));
                }
                all
            }
        },
    };
    target.check(model, &all).map_err(|what| {
        let mut d = *what;
        d.message = format!("`{name}`: {}", d.message);
        Box::new(d)
    })?;
    if let Some(k) = (1..all.len()).find(|&k| all[..k].contains(&all[k])) {
        return Err(Box::new(fault(text, format!("{} stands there twice", all[k]))));
    }
    if all.len() < 2 {
        return Err(Box::new(fault(text, format!("{} alone is certain", all.join("")))));
    }
    let what = if matches!(target, Target::Law(_)) { "laws are" } else { "values are" };
    assumptions.push(format!("{name}: the {what} equally likely"));
    Ok(found(String::new(), UncertainValue::Each(all)))
}

/// What the file has, as it writes it.
fn nominal(target: &Target, question: &PointSetup<'_>) -> Option<String> {
    let (model, base) = (question.model(), question.base());
    let train = model.train();
    // The unit in which people say it.
    let said = |q: &Quantity, unit: &str, turn: bool| {
        let one = units::parse(&format!("1 {unit}"), q.dimension).expect("a unit of it").si();
        let value = q.si() / one;
        format!("{} {unit}", plain(if turn { -value } else { value }, 12))
    };
    match target {
        Target::File(key) => model.document().value(key),
        Target::Law(family) => train.law_in_force(family).map(str::to_owned),
        Target::State => base.state.map(|k| train.states()[k].name.clone()),
        Target::Temperature => {
            let t = base.temperature.or(train.lubrication.as_ref().map(|l| l.temperature))?;
            Some(format!("{} degC", plain(t - 273.15, 12)))
        }
        Target::Ratio => {
            let [input, output] = [ShaftRef::Input, ShaftRef::Output].map(|who| question.role(train, base, who).ok());
            let speeds = speeds(train, base);
            let ratio = speeds(input?)?.si() / speeds(output?)?.si();
            ratio.is_finite().then(|| plain(ratio, 12))
        }
        Target::Store(k) => {
            let VariatorPath::Bus { store, .. } = &train.variators()[*k].path else { return None };
            match base.stores.iter().find(|(of, _)| of == k).map_or(store, |(_, own)| own) {
                Store::Power(q) => Some(said(q, "W", false)),
                Store::Free => None,
            }
        }
        Target::Speed(who) => {
            let member = question.role(train, base, *who).ok()?;
            let (_, speed) = base.speeds.iter().find(|s| s.0 == member)?;
            Some(said(speed, "rpm", false))
        }
        Target::Torque(who) | Target::Power(who) => {
            let member = question.role(train, base, *who).ok()?;
            let (_, load) = base.loads.iter().find(|l| l.0 == member)?;
            let backwards = || speeds(train, base)(member).is_some_and(|w| w.value.sign() < 0);
            match (target, load) {
                (Target::Torque(_), Load::Torque(q)) => {
                    let turn = match who {
                        ShaftRef::Member(_) => false,
                        ShaftRef::Input => backwards(),
                        ShaftRef::Output => !backwards(),
                    };
                    Some(said(q, "N m", turn))
                }
                (Target::Power(_), Load::Power(q)) => Some(said(q, "W", *who == ShaftRef::Output)),
                _ => None,
            }
        }
    }
}
