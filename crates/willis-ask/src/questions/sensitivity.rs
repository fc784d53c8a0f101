//! `sensitivity`: which loss to attack first.

mod text;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use willis::analysis::Selection;
use willis::diagnostic::Diagnostic;
use willis::work::{Effort, Work};

use crate::table::Table;
use crate::{Given, Question, Refusal};

/// Rank the inputs by their effect on efficiency and losses: what to change first.
///
/// Derivatives by automatic differentiation of efficiency, of all losses and of each loss by every continuous
/// quantity of the file and of the operation, for a step of one percent (1 K, 1 degree, 0.01 of a profile shift); and how
/// far the point is from a change of the driving gear and from locking.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct Sensitivity {
    /// Only this operation.
    #[cfg_attr(feature = "clap", arg(long, value_name = "OPERATION"))]
    pub operation: Option<String>,
    /// Only operations that run in this state of the shift table.
    #[cfg_attr(feature = "clap", arg(long, value_name = "STATE"))]
    pub state: Option<String>,
}

impl Question for Sensitivity {
    const NAME: &'static str = "sensitivity";
    const TABLES: &'static [&'static str] = &["quantities"];
    type Answer = willis::study::Sensitivity;

    fn ask(&self, of: &[Given], work: &dyn Work) -> Result<Self::Answer, Refusal> {
        let selection = Selection { state: self.state.clone(), operation: self.operation.clone() };
        work.afford(&Effort::of_analysis(of[0].model.train(), &selection))?;
        Ok(willis::study::sensitivity(of[0].model.train(), &selection)?)
    }

    fn text(&self, answer: &Self::Answer, _: &[Given]) -> String {
        text::text(answer)
    }

    fn tables(&self, answer: &Self::Answer) -> Vec<Table> {
        vec![text::table_of(answer)]
    }

    fn notes(answer: &Self::Answer) -> &[Diagnostic] {
        &answer.diagnostics
    }
}
