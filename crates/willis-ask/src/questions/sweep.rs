//! `sweep`: many points.

mod text;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use willis::diagnostic::{Diagnostic, Diagnostics};
use willis::study::{self, ColumnTable, Hold, SweepMethod, SweepReport, SweepRequest};
use willis::work::Work;

use super::names;
use crate::table::Table;
use crate::{Given, Question, Refusal};

/// Evaluate a train at many points: maps, trends, every gear at once.
///
/// Any quantity of the train file or of the operating point can vary, along any number of axes:
///
///   --over "input.speed=500 rpm..12000 rpm:100"   --over "output.torque=10..400 N m:80"
///
///   --over state=all   --over P1.planet.count=3,4,6   --over "oil.temperature=20..100 degC:9"
///
/// `500..12000 rpm:100` is 100 evenly spaced values, both ends included; `:31:log` is 31 values with a constant ratio; `:step
/// 500 rpm` is a value every 500 rpm. Torque and power of `input` and `output` are positive driving and negative coasting; of a
/// member called by its name they are those on it, as in the train file. Every point is that of `analyze`; a point that
/// is locked or has several solutions is a row that says so.
///
/// On the command line the rows are written into the file of --output, without which there is only a summary; an
/// interrupted sweep goes on when the same command is given again.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct Sweep {
    /// An axis, QUANTITY=VALUES; several times for several axes, the last runs fastest.
    #[cfg_attr(feature = "clap", arg(long, value_name = "AXIS"))]
    pub over: Vec<String>,
    /// A [[study]] of the train file, instead of axes and what belongs to them.
    #[cfg_attr(feature = "clap", arg(long, value_name = "NAME", conflicts_with_all = ["over", "operation", "state", "hold", "columns"]))]
    pub study: Option<String>,
    /// The operation from which the sweep starts. Default: the first one in the state, else the file's first.
    #[cfg_attr(feature = "clap", arg(long, value_name = "OPERATION"))]
    pub operation: Option<String>,
    /// The state of the shift table.
    #[cfg_attr(feature = "clap", arg(long, value_name = "STATE"))]
    pub state: Option<String>,
    /// What stays the same while other quantities vary.
    #[cfg_attr(feature = "clap", arg(long, value_enum, default_value_t = Held::AsGiven))]
    pub hold: Held,
    /// More columns: members, meshes, elements, sources, all, or single ones such as carrier.torque_n_m.
    #[cfg_attr(feature = "clap", arg(long, value_delimiter = ',', value_name = "COLUMN"))]
    pub columns: Vec<String>,
    /// Compile the train, for maps of millions of points: given efficiencies; axes of speed, torque, state, and a few
    /// values of the file; no columns of powers and warnings. Numbers agree with `analyze` to a part in 10^12.
    #[cfg_attr(feature = "clap", arg(long))]
    pub fast: bool,
    /// Only the summary, no rows: the same memory for any number of points.
    #[cfg_attr(feature = "clap", arg(skip))]
    pub summary_only: bool,
}

/// What stays the same while other quantities vary.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[serde(rename_all = "kebab-case")]
pub enum Held {
    /// The loads as the operation gives them.
    #[default]
    AsGiven,
    /// The torques of the loads.
    Torque,
    /// The powers of the loads.
    Power,
    /// The torque at the output.
    Output,
}

impl From<Held> for Hold {
    fn from(h: Held) -> Self {
        match h {
            Held::AsGiven => Self::AsGiven,
            Held::Torque => Self::Torque,
            Held::Power => Self::Power,
            Held::Output => Self::Output,
        }
    }
}

/// A sweep: what its points say together, and the points themselves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct SweepAnswer {
    /// `willis-sweep-1`.
    pub report: SweepReport,
    /// One row a point; they are had as a table and not in the contract.
    #[serde(skip)]
    pub points: ColumnTable,
    /// Warnings about the train itself.
    #[serde(skip)]
    pub notes: Vec<Diagnostic>,
}

impl willis::contract::Contract for SweepAnswer {
    const FORMAT: &'static str = SweepReport::FORMAT;
}

impl Sweep {
    /// The same for the library.
    pub fn request(&self) -> SweepRequest {
        SweepRequest {
            study: self.study.clone(),
            over: self.over.clone(),
            operation: self.operation.clone(),
            state: self.state.clone(),
            hold: self.hold.into(),
            columns: self.columns.clone(),
            method: if self.fast { SweepMethod::Compiled } else { SweepMethod::Analyze },
            summary_only: self.summary_only,
        }
    }
}

/// The report for eyes.
pub fn sweep_text(report: &SweepReport) -> String {
    text::text(report)
}

pub use text::{bytes as bytes_in_words, duration as duration_in_words, points as points_in_words};

impl Question for Sweep {
    const NAME: &'static str = "sweep";
    const TABLES: &'static [&'static str] = &["points"];
    type Answer = SweepAnswer;

    fn check(&self) -> Result<(), Diagnostics> {
        names::apart(&[
            [("study", self.study.is_some()), ("over", !self.over.is_empty())],
            [("study", self.study.is_some()), ("operation", self.operation.is_some())],
            [("study", self.study.is_some()), ("state", self.state.is_some())],
            [("study", self.study.is_some()), ("hold", self.hold != Held::AsGiven)],
            [("study", self.study.is_some()), ("columns", !self.columns.is_empty())],
        ])
    }

    fn ask(&self, of: &[Given], work: &dyn Work) -> Result<SweepAnswer, Refusal> {
        let model = &of[0].model;
        let answer = study::sweep(model, &self.request(), work)?;
        Ok(SweepAnswer { report: answer.report, points: answer.table, notes: model.warnings().to_vec() })
    }

    fn text(&self, answer: &SweepAnswer, _: &[Given]) -> String {
        text::text(&answer.report)
    }

    fn tables(&self, answer: &SweepAnswer) -> Vec<Table> {
        vec![Table::of_columns("points", &answer.points)]
    }

    fn notes(answer: &SweepAnswer) -> &[Diagnostic] {
        &answer.notes
    }
}
