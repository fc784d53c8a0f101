//! `flow`: where the power runs.

mod text;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use willis::analysis::Selection;
use willis::diagnostic::Diagnostic;
use willis::hypergraph::{FlowReport, flows_seen_from};
use willis::work::{Effort, Work};

#[cfg(feature = "pictures")]
use crate::{File, Form};
use crate::{Given, Question, Refusal};

/// Show where the power runs in an operating point: components, contacts, paths, losses.
///
/// The graph has every component and every contact between components (teeth, bearings, seals, clutches), the power
/// between them, the balance of each, the efficiency of each contact and of every path from input to output, and power
/// that runs in circles.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct Flow {
    /// Only this operation.
    #[cfg_attr(feature = "clap", arg(long, value_name = "OPERATION"))]
    pub operation: Option<String>,
    /// Only operations that run in this state of the shift table.
    #[cfg_attr(feature = "clap", arg(long, value_name = "STATE"))]
    pub state: Option<String>,
    /// Count speeds and powers as they are seen from this member, such as a carrier; else from the housing.
    #[cfg_attr(feature = "clap", arg(long, value_name = "MEMBER"))]
    pub seen_from: Option<String>,
}

impl Question for Flow {
    const NAME: &'static str = "flow";
    #[cfg(feature = "pictures")]
    const FORMS: &'static [Form] = &[
        Form { name: "dot", endings: &["dot", "gv"], about: "Graphviz" },
        Form { name: "svg", endings: &["svg"], about: "a figure" },
    ];
    type Answer = FlowReport;

    fn ask(&self, of: &[Given], work: &dyn Work) -> Result<FlowReport, Refusal> {
        let selection = Selection { state: self.state.clone(), operation: self.operation.clone() };
        work.afford(&Effort::of_analysis(of[0].model.train(), &selection))?;
        let train = of[0].model.train();
        Ok(flows_seen_from(train, &selection, self.seen_from.as_deref())?.with_bands(train))
    }

    fn text(&self, answer: &FlowReport, _: &[Given]) -> String {
        text::text(answer)
    }

    fn notes(answer: &FlowReport) -> &[Diagnostic] {
        &answer.diagnostics
    }

    #[cfg(feature = "pictures")]
    fn write(&self, answer: &FlowReport, form: &str, _: &[Given]) -> Result<Vec<File>, Refusal> {
        Ok(vec![match form {
            "dot" => File::text("flow.dot", willis_figure::flow_dot(answer)),
            _ => File::text("flow.svg", willis_figure::draw_flow(answer) + "\n"),
        }])
    }
}
