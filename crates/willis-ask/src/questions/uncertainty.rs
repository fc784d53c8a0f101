//! `uncertainty`: how sure a number is.

mod tables;
mod text;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use willis::contract::Contract;
use willis::diagnostic::{Code, Diagnostic};
use willis::study::{self, ColumnTable, SampleResult, UncertaintyPlan, UncertaintyRequest};
use willis::work::Work;

use crate::table::Table;
use crate::{Extra, File, Given, Question, Refusal};

/// Compute the uncertainty of efficiency and losses: their distribution, and which input dominates it.
///
/// Quantities are those of the train file and of the operation. Distributions: `0.98..0.99` (equally likely), `+-5%`
/// about the file's value, `normal(0.4 um, 0.05 um)` and `lognormal(0.4 um, 1.3)` (both cut off at three standard
/// deviations), `triangular(0.2, 0.4, 0.8 um)`; sets of equally likely values: `3,4`, laws: `all`, `inside` (their
/// range), or names.
///
/// Without --vary and --laws: given losses 1 - efficiency by 20 %, roughness by 20 %, the oil's temperature by 5 K each
/// way, and the laws of tooth friction inside their range; each is listed as an assumption.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct Uncertainty {
    /// The operation. Default: the first one in the state, else the file's first.
    #[cfg_attr(feature = "clap", arg(long, value_name = "OPERATION"))]
    pub operation: Option<String>,
    /// In this state of the shift table.
    #[cfg_attr(feature = "clap", arg(long, value_name = "STATE"))]
    pub state: Option<String>,
    /// An uncertain quantity: 'P1.mesh_efficiency=0.985..0.995'. Several times for several quantities.
    #[cfg_attr(feature = "clap", arg(long, value_name = "QUANTITY=DISTRIBUTION"))]
    pub vary: Vec<String>,
    /// Families whose laws are each as likely as the others, with commas between; or all.
    #[cfg_attr(feature = "clap", arg(long, value_delimiter = ',', value_name = "FAMILY|all"))]
    pub laws: Vec<String>,
    /// How many samples; made a power of two.
    #[cfg_attr(feature = "clap", arg(long, value_name = "N", default_value = "1024"))]
    pub samples: usize,
    /// Other seeds give other samples; the same seed the same, bit for bit.
    #[cfg_attr(feature = "clap", arg(long, value_name = "K", default_value = "1"))]
    pub seed: u64,
}

impl Default for Uncertainty {
    fn default() -> Self {
        Self { operation: None, state: None, vary: vec![], laws: vec![], samples: 1024, seed: 1 }
    }
}

/// How sure a number is, and the samples that say so.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct UncertaintyAnswer {
    /// `willis-uncertainty-1`.
    pub report: study::Uncertainty,
    /// Every sample; they are had as a table and not in the contract.
    #[serde(skip)]
    pub samples: ColumnTable,
}

impl From<study::UncertaintyAnswer> for UncertaintyAnswer {
    fn from(answer: study::UncertaintyAnswer) -> Self {
        Self { report: answer.report, samples: answer.samples }
    }
}

impl Uncertainty {
    fn request(&self) -> UncertaintyRequest {
        UncertaintyRequest {
            operation: self.operation.clone(),
            state: self.state.clone(),
            vary: self.vary.clone(),
            laws: self.laws.clone(),
            samples: self.samples,
            seed: self.seed,
        }
    }
}

impl Contract for UncertaintyAnswer {
    const FORMAT: &'static str = study::Uncertainty::FORMAT;
}

impl Question for Uncertainty {
    const NAME: &'static str = "uncertainty";
    const TABLES: &'static [&'static str] = &["results", "influences", "choices", "verdicts", "samples"];
    const EXTRAS: &'static [Extra] =
        &[Extra { name: "samples-out", value: "FILE.csv", about: "Write every sample into this file" }];
    type Answer = UncertaintyAnswer;

    const IS_CUT: bool = true;

    fn ask(&self, of: &[Given], work: &dyn Work) -> Result<UncertaintyAnswer, Refusal> {
        Ok(study::uncertainty(&of[0].model, &self.request(), work)?.into())
    }

    fn piece(&self, of: &[Given], k: usize, n: usize, work: &dyn Work) -> Result<Vec<u8>, Refusal> {
        let plan = UncertaintyPlan::new(&of[0].model, &self.request())?;
        let found = plan.evaluate_within(plan.piece(k, n), work)?;
        Ok(serde_json::to_vec(&found).expect("plain data"))
    }

    fn gather(&self, of: &[Given], pieces: &[Vec<u8>]) -> Result<UncertaintyAnswer, Refusal> {
        let plan = UncertaintyPlan::new(&of[0].model, &self.request())?;
        let read = pieces.iter().map(|bytes| serde_json::from_slice::<SampleResult>(bytes).ok());
        let all = read.reduce(|all, piece| {
            let mut all = all?;
            all.join(piece?);
            Some(all)
        });
        let answer = all.flatten().and_then(|all| plan.answer_of(&all));
        let wrong = || Diagnostic::new(Code::UnknownSelection, "", "these are not all pieces of this uncertainty");
        Ok(answer.ok_or_else(wrong)?.into())
    }

    fn text(&self, answer: &UncertaintyAnswer, _: &[Given]) -> String {
        text::text(&answer.report)
    }

    fn tables(&self, answer: &UncertaintyAnswer) -> Vec<Table> {
        let mut all = tables::tables(&answer.report);
        all.push(Table::of_columns("samples", &answer.samples).aside());
        all
    }

    fn extra(&self, answer: &UncertaintyAnswer, _: &str, _: &[Given]) -> Result<Vec<File>, Refusal> {
        Ok(vec![File::text("samples.csv", Table::of_columns("samples", &answer.samples).csv())])
    }
}
