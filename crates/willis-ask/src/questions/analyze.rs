//! `analyze`: the shift table and the operating points.

mod tables;
mod text;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use willis::analysis::{self, Analysis, Selection};
use willis::diagnostic::Diagnostic;
use willis::work::{Effort, Work};

use crate::table::Table;
use crate::{Given, Question, Refusal};

pub(super) use text::{at_load_cell, load, margins, starred};

/// Analyse a train: its shift table and its operating points.
///
/// Gives for every state the exact ratio and the efficiency driving and coasting; for every operation speeds, torques,
/// powers, losses, the verdict and its certificate. A train that locks is an answer, and no error.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct Analyze {
    /// Only this state of the shift table.
    #[cfg_attr(feature = "clap", arg(long, value_name = "STATE"))]
    pub state: Option<String>,
    /// Only this operation.
    #[cfg_attr(feature = "clap", arg(long, value_name = "OPERATION"))]
    pub operation: Option<String>,
}

impl Question for Analyze {
    const NAME: &'static str = "analyze";
    const TABLES: &'static [&'static str] = &[
        "states",
        "operations",
        "members",
        "meshes",
        "shift-elements",
        "losses",
        "variators",
        "contacts",
        "bearings",
        "diagnostics",
    ];
    type Answer = Analysis;

    fn ask(&self, of: &[Given], work: &dyn Work) -> Result<Analysis, Refusal> {
        let selection = Selection { state: self.state.clone(), operation: self.operation.clone() };
        work.afford(&Effort::of_analysis(of[0].model.train(), &selection))?;
        let train = of[0].model.train();
        Ok(analysis::analyze(train, &selection)?.with_loads(train).with_bands(train))
    }

    fn text(&self, answer: &Analysis, of: &[Given]) -> String {
        text::analysis(of[0].model.train(), answer)
    }

    fn tables(&self, answer: &Analysis) -> Vec<Table> {
        tables::tables(answer)
    }

    fn notes(answer: &Analysis) -> &[Diagnostic] {
        &answer.diagnostics
    }
}
