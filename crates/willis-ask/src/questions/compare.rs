//! `compare`: variants side by side.

mod tables;
mod text;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use willis::study::{self, CompareRequest, Comparison};
use willis::work::Work;

use crate::table::Table;
use crate::{Given, Of, Question, Refusal};

/// Lay variants of a train side by side: what the files differ in, and what that changes.
///
/// Keys that differ come first, then states and operations by the size of their differences, then in a line what is
/// equal. Operations of one name that prescribe different things are compared and marked. With --over the same axes are
/// applied to every variant: which is better where, and by how much.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct Compare {
    /// Only this operation.
    #[cfg_attr(feature = "clap", arg(long, value_name = "OPERATION"))]
    pub operation: Option<String>,
    /// Only this state, and operations in it.
    #[cfg_attr(feature = "clap", arg(long, value_name = "STATE"))]
    pub state: Option<String>,
    /// A quantity and its values: 'input.speed=500 rpm..6000 rpm:12'. Several times for a grid.
    #[cfg_attr(feature = "clap", arg(long, value_name = "QUANTITY=VALUES"))]
    pub over: Vec<String>,
}

impl Question for Compare {
    const NAME: &'static str = "compare";
    const OF: Of = Of::Trains;
    const TABLES: &'static [&'static str] = &["variants", "files", "states", "operations", "map"];
    type Answer = Comparison;

    fn ask(&self, of: &[Given], work: &dyn Work) -> Result<Comparison, Refusal> {
        let request =
            CompareRequest { operation: self.operation.clone(), state: self.state.clone(), over: self.over.clone() };
        let all: Vec<_> = of.iter().map(|g| (g.name.as_str(), &g.model)).collect();
        // A message names its file, or concerns all.
        study::compare(&all, &request, work).map_err(|wrong| match Refusal::from(wrong) {
            Refusal::Wrong(wrong, _) => Refusal::Wrong(wrong, usize::MAX),
            other => other,
        })
    }

    fn text(&self, answer: &Comparison, _: &[Given]) -> String {
        text::text(answer)
    }

    fn tables(&self, answer: &Comparison) -> Vec<Table> {
        tables::tables(answer)
    }
}
