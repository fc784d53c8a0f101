//! The answer at one point of a study.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::analysis::{self, OperationReport, SolutionReport, Verdict};
use crate::diagnostic::{Code, Diagnostics, Severity};
use crate::exact::Rational;
use crate::kinematics::{Configuration, Ratio};
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
    /// The one equilibrium, where there is one.
    pub solution: Option<SolutionReport>,
    /// Warnings of this point, those of a code side by side.
    pub warnings: Vec<PointWarning>,
    /// Speed of the input over that of the output: as they turn here, else as the gears tie them.
    pub ratio: Option<f64>,
    /// Speeds that are prescribed, in rpm: as they are written, where they are written so.
    pub(super) prescribed_rpm: Vec<(String, f64)>,
}

impl PointAnswer {
    /// What [`analyze`](crate::analyze) says of an operation.
    pub fn of(train: &Train, operation: &Operation) -> Self {
        let (report, notes) = match analysis::operate_unnamed(train, operation) {
            Ok(answer) => answer,
            Err(wrong) => return Self::refused(wrong),
        };
        let oil = train.lubrication.iter().filter_map(|l| l.beyond(operation.temperature.unwrap_or(l.temperature)));
        let oil = oil.map(|beyond| PointWarning {
            code: Code::OutsideLaw,
            law: None,
            message: beyond.to_string(),
            deviation: None,
        });
        let ratio = ratio(train, operation, &report);
        // The notes tell of the laws outside their ranges in the order of these.
        let mut outside = report.outside_laws.into_iter();
        let deviation = report.speed_deviation.as_ref().map(|d| d.relative);
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
            (w.pi_power == 1).then(|| (train.member_name(*m).to_owned(), rpm(w)))
        };
        // A speed that contradicts the others follows them.
        let prescribed_rpm = match report.speed_deviation {
            None => operation.speeds.iter().filter_map(in_rpm).collect(),
            Some(_) => vec![],
        };
        let is_one = matches!(report.verdict, Verdict::Unique | Verdict::Unloaded);
        Self {
            ratio,
            prescribed_rpm,
            verdict: report.verdict.into(),
            reason: report.reason.unwrap_or_default(),
            solution: report.solutions.into_iter().next().filter(|_| is_one),
            warnings,
        }
    }

    /// Of a point that makes no question.
    pub fn refused(wrong: Diagnostics) -> Self {
        let errors: Vec<String> =
            wrong.into_iter().filter(|d| d.severity == Severity::Error).map(|d| d.message).collect();
        Self {
            verdict: PointVerdict::Refused,
            reason: errors.join("; "),
            solution: None,
            warnings: vec![],
            ratio: None,
            prescribed_rpm: vec![],
        }
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
        self.solution.as_ref().and_then(|s| s.efficiency).unwrap_or(f64::NAN)
    }

    /// All losses, W; NaN where there is no answer.
    pub fn loss(&self) -> f64 {
        self.solution.as_ref().map_or(f64::NAN, |s| s.loss_w)
    }
}

/// Where power enters and leaves when driving.
fn ends(train: &Train, operation: &Operation) -> Option<[MemberId; 2]> {
    let [input, output] = train.ends(operation.state);
    Some([input?, output?])
}

/// Speed of the input over that of the output, where both are known and the output turns.
fn ratio(train: &Train, operation: &Operation, report: &OperationReport) -> Option<f64> {
    let [input, output] = ends(train, operation)?.map(|m| train.member_name(m));
    let [input, output] = [input, output].map(|name| report.speeds_rad_s.get(name).copied().flatten());
    output.filter(|w| *w != 0.0).and_then(|w| Some(input? / w)).filter(|r| r.is_finite() && *r != 0.0)
}
