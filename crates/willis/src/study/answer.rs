//! The answer at one point of a study.

use std::fmt;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::analysis::{Ancestors, OperationReport, PointNumbers, PointSeries, SolutionReport, Told, Verdict};
use crate::diagnostic::{Code, Diagnostics, Severity};
use crate::exact::Rational;
use crate::kinematics::{Configuration, Ratio};
use crate::operating_point::LossSource;
use crate::train::{MemberId, Operation, Train};
use crate::units::Quantity;

/// What can be said of a point of a study: the [verdict](Verdict) on its operating point, or that it makes none.
///
/// Ordered by name, as tables by verdict are written; [`PointVerdict::ALL`] has the order for people.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum PointVerdict {
    /// There is no equilibrium in which a load is driven: friction or the kinematics holds the train.
    Locked,
    /// There are several equilibria; the model cannot choose.
    Multiple,
    /// No train or no operating point is possible with these values.
    Refused,
    /// No determined answer: a speed is missing, constraints are redundant, uniqueness is undecided, or losses did not
    /// converge.
    Undetermined,
    /// There is exactly one equilibrium.
    Unique,
    /// Nothing is loaded.
    Unloaded,
}

impl PointVerdict {
    /// All, the answered ones first.
    pub const ALL: [Self; 6] =
        [Self::Unique, Self::Multiple, Self::Locked, Self::Unloaded, Self::Undetermined, Self::Refused];

    /// Its name in contracts and tables: `unique`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Unique => "unique",
            Self::Multiple => "multiple",
            Self::Locked => "locked",
            Self::Unloaded => "unloaded",
            Self::Undetermined => "undetermined",
            Self::Refused => "refused",
        }
    }
}

impl From<Verdict> for PointVerdict {
    fn from(verdict: Verdict) -> Self {
        match verdict {
            Verdict::Unique => Self::Unique,
            Verdict::Multiple => Self::Multiple,
            Verdict::Locked => Self::Locked,
            Verdict::Unloaded => Self::Unloaded,
            Verdict::Undetermined => Self::Undetermined,
        }
    }
}

impl fmt::Display for PointVerdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A law of a family of laws: `mesh_friction = niemann`.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct LawChoice {
    /// The family, `mesh_friction`.
    pub family: String,
    /// The law, `niemann`.
    pub law: String,
}

impl fmt::Display for LawChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} = {}", self.family, self.law)
    }
}

/// A warning at one point.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct PointWarning {
    /// Its code.
    pub code: Code,
    /// The law that it is about.
    pub law: Option<LawChoice>,
    /// What it says.
    pub message: String,
    /// By which part prescribed speeds contradict the gears, where it is about that.
    pub deviation: Option<f64>,
}

/// The answer at one point.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct PointAnswer {
    /// What can be said of it.
    pub verdict: PointVerdict,
    /// One sentence that explains a verdict other than `unique`.
    pub reason: String,
    /// The one equilibrium, where there is one; where only numbers were asked for it may be left out.
    pub solution: Option<SolutionReport>,
    /// The numbers of the one equilibrium, where there is one.
    pub numbers: Option<PointNumbers>,
    /// Warnings of this point, those of a code side by side.
    pub warnings: Vec<PointWarning>,
    /// Speed of the input over that of the output: as they turn here, else as the gears tie them.
    pub ratio: Option<f64>,
    /// Speeds that are prescribed, in rpm: as they are written, where they are written so.
    pub(super) prescribed_rpm: Vec<(MemberId, f64)>,
    /// Losses by source, where they were asked for without the whole solution.
    sources: Vec<LossSource>,
}

/// How much is asked of each of many points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Detail {
    /// Its numbers.
    Numbers,
    /// Its numbers, and its losses by source.
    Sources,
    /// All that is known of it.
    Whole,
}

impl PointAnswer {
    /// What [`analyze`](crate::analyze) says of an operation.
    pub fn of(train: &Train, operation: &Operation) -> Self {
        PointAnswers::new(train).whole(operation)
    }

    fn told(train: &Train, operation: &Operation, told: Result<Told, Diagnostics>) -> Self {
        let (answer, deviation, notes, outside) = match told {
            Ok(Told::Whole(report, notes)) => {
                let speed = |m| report.speeds_rad_s.get(train.member_name(m)).copied().flatten();
                let ratio = ratio(train, operation, speed);
                let OperationReport { verdict, reason, solutions, outside_laws, speed_deviation, .. } = *report;
                let is_one = matches!(verdict, Verdict::Unique | Verdict::Unloaded);
                let solution = solutions.into_iter().next().filter(|_| is_one);
                let numbers = solution.as_ref().map(|s| PointNumbers::of(train, s));
                let reason = reason.unwrap_or_default();
                let answer = Self { reason, solution, numbers, ratio, ..Self::blank(verdict.into()) };
                (answer, speed_deviation.map(|d| d.relative), notes, outside_laws)
            }
            Ok(Told::Numbers { numbers, sources, why, notes, outside }) => {
                let ratio = ratio(train, operation, |m| numbers.member(m)?.speed_rad_s);
                let reason = why.map_or_else(String::new, |why| why.to_string());
                let numbers = Some(numbers);
                (Self { reason, numbers, sources, ratio, ..Self::blank(PointVerdict::Unique) }, None, notes, outside)
            }
            Err(wrong) => return Self::refused(wrong),
        };
        let oil = train.lubrication.iter().filter_map(|l| l.beyond(operation.temperature.unwrap_or(l.temperature)));
        let oil = oil.map(|beyond| PointWarning {
            code: Code::OutsideLaw,
            law: None,
            message: beyond.to_string(),
            deviation: None,
        });
        // The notes tell of the laws outside their ranges in the order of these.
        let mut outside = outside.into_iter();
        let own = notes.into_iter().filter(|d| d.severity == Severity::Warning && d.code != Code::SelfLocking);
        let own = own.map(|d| {
            let law = if d.code == Code::OutsideLaw { outside.next() } else { None };
            let law = law.map(|o| LawChoice { family: o.family, law: o.law });
            let deviation = deviation.filter(|_| d.code == Code::SpeedsYield);
            PointWarning { code: d.code, law, message: d.message, deviation }
        });
        let warnings = oil.chain(own).collect();
        let in_rpm = |(m, w): &(MemberId, Quantity)| {
            let rpm = |q: &Quantity| (&q.value * &Rational::from(30)).to_f64();
            (w.pi_power == 1).then(|| (*m, rpm(w)))
        };
        // A speed that contradicts the others follows them.
        let prescribed_rpm = match deviation {
            None => operation.speeds.iter().filter_map(in_rpm).collect(),
            Some(_) => vec![],
        };
        Self { warnings, prescribed_rpm, ..answer }
    }

    fn blank(verdict: PointVerdict) -> Self {
        let (reason, solution, numbers, warnings, ratio, prescribed_rpm, sources) = Default::default();
        Self { verdict, reason, solution, numbers, warnings, ratio, prescribed_rpm, sources }
    }

    /// Of a point that makes no question.
    pub fn refused(wrong: Diagnostics) -> Self {
        let errors: Vec<String> =
            wrong.into_iter().filter(|d| d.severity == Severity::Error).map(|d| d.message).collect();
        Self { reason: errors.join("; "), ..Self::blank(PointVerdict::Refused) }
    }

    /// The same with the ratio of a train in which nothing but the gears says it.
    pub(super) fn with_ratio(mut self, train: &Train, operation: &Operation) -> Self {
        if self.ratio.is_none()
            && let Some([input, output]) = ends(train, operation)
        {
            let engaged = operation.state.map_or(&[][..], |k| &train.states[k].engaged);
            let tied = Configuration::new(train, engaged, &operation.fixed, &[input, output]).ratio(input, output);
            if let Ratio::Exact(ratio) = tied {
                self.ratio = Some(ratio.to_f64());
            }
        }
        self
    }

    /// Whether there is exactly one equilibrium.
    pub fn is_unique(&self) -> bool {
        self.verdict == PointVerdict::Unique
    }

    /// Output over input power, NaN where there is none.
    pub fn efficiency(&self) -> f64 {
        self.numbers.as_ref().and_then(|s| s.efficiency).unwrap_or(f64::NAN)
    }

    /// Losses by source, largest first, where all was asked for, or [these](Detail::Sources).
    pub(super) fn sources(&self) -> &[LossSource] {
        self.solution.as_ref().map_or(&self.sources, |s| &s.sources)
    }

    /// All losses, W; NaN where there is no answer.
    pub fn loss(&self) -> f64 {
        self.numbers.as_ref().map_or(f64::NAN, |s| s.loss_w)
    }
}

/// Where power enters and leaves when driving.
fn ends(train: &Train, operation: &Operation) -> Option<[MemberId; 2]> {
    let [input, output] = train.ends(operation.state);
    Some([input?, output?])
}

/// Speed of the input over that of the output, where both are known and the output turns.
fn ratio(train: &Train, operation: &Operation, speed: impl Fn(MemberId) -> Option<f64>) -> Option<f64> {
    let [input, output] = ends(train, operation)?.map(speed);
    output.filter(|w| *w != 0.0).and_then(|w| Some(input? / w)).filter(|r| r.is_finite() && *r != 0.0)
}

/// Answers at many operating points of one train, one after the other: what they have in common is worked out once, and
/// a point costs a fraction of what it costs alone. No answer depends on those before it, to the last bit.
///
/// # Example
/// ```
/// use willis::study::{PointAnswer, PointAnswers};
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
///     mesh_efficiency = 0.99
///     [[operation]]
///     name = "full load"
///     speeds = { s = "1000 rpm" }
///     torques = { s = "10 N m" }
/// "#)?;
/// let operation = &train.operations()[0];
/// let answer = PointAnswers::new(&train).numbers(operation);
/// assert_eq!(answer.numbers, PointAnswer::of(&train, operation).numbers);
/// assert!((answer.efficiency() - 0.98607).abs() < 1e-9);
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub struct PointAnswers<'t> {
    train: &'t Train,
    series: PointSeries<'t>,
}

impl fmt::Debug for PointAnswers<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PointAnswers").field("train", &self.train.name()).finish_non_exhaustive()
    }
}

impl<'t> PointAnswers<'t> {
    /// Of a train.
    pub fn new(train: &'t Train) -> Self {
        Self { train, series: PointSeries::new(train) }
    }

    /// All that is known of a point.
    pub fn whole(&self, operation: &Operation) -> PointAnswer {
        let told = self.series.whole(operation);
        PointAnswer::told(self.train, operation, told)
    }

    /// The numbers of a point, its verdict and its warnings; the [solution](PointAnswer::solution) may be left out.
    pub fn numbers(&mut self, operation: &Operation) -> PointAnswer {
        self.at(operation, Detail::Numbers)
    }

    fn at(&mut self, operation: &Operation, detail: Detail) -> PointAnswer {
        let told = match detail {
            Detail::Whole => self.series.whole(operation),
            Detail::Numbers | Detail::Sources => self.series.numbers(operation, detail == Detail::Sources),
        };
        PointAnswer::told(self.train, operation, told)
    }

    /// The answers to points of studies, in their order, with the train of each where there is one; what those of one train,
    /// and of trains that turn like it, have in common is worked out once. `whole` asks for all that is known of each.
    pub fn each(
        points: impl IntoIterator<Item = Result<(Arc<Train>, Operation), Diagnostics>>,
        whole: bool,
        take: impl FnMut(PointAnswer, Option<(&Arc<Train>, &Operation)>),
    ) {
        Self::each_with(points, if whole { Detail::Whole } else { Detail::Numbers }, take);
    }

    pub(super) fn each_with(
        points: impl IntoIterator<Item = Result<(Arc<Train>, Operation), Diagnostics>>,
        detail: Detail,
        mut take: impl FnMut(PointAnswer, Option<(&Arc<Train>, &Operation)>),
    ) {
        let mut points = points.into_iter();
        let mut next = points.next();
        let mut before = Ancestors::default();
        while let Some(asked) = next.take() {
            let (train, mut operation) = match asked {
                Ok(asked) => asked,
                Err(wrong) => {
                    take(PointAnswer::refused(wrong), None);
                    next = points.next();
                    continue;
                }
            };
            let mut own = PointAnswers { train: &train, series: PointSeries::after(&train, before) };
            loop {
                take(own.at(&operation, detail), Some((&train, &operation)));
                match points.next() {
                    Some(Ok((same, following))) if Arc::ptr_eq(&same, &train) => operation = following,
                    other => {
                        next = other;
                        break;
                    }
                }
            }
            before = own.series.into_ancestors();
        }
    }
}
