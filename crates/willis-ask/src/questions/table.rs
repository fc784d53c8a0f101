//! `table`: speeds and torques of everything in every state.

mod tables;
mod text;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use willis::analysis::{self, ShaftTable};
use willis::diagnostic::{Diagnostic, Diagnostics};
use willis::units::{Dimension, Quantity};
use willis::work::Work;

use super::amount::values;
use crate::table::Table as Rows;
use crate::{Given, Question, Refusal};

/// Tabulate the speed of every shaft and planet, the slip of every open element and every torque, in all states.
///
/// Speeds are those over the speed of the input, or in rpm at a given one. Torques are those over the torque of the input,
/// which drives the output through the losses of the teeth.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct Table {
    /// Only this state of the shift table.
    #[cfg_attr(feature = "clap", arg(long, value_name = "STATE"))]
    pub state: Option<String>,
    /// Show speeds in rpm at this speed of the input: 2000rpm.
    #[cfg_attr(feature = "clap", arg(long, value_name = "SPEED"))]
    pub speed: Option<String>,
    /// Torques without losses.
    #[cfg_attr(feature = "clap", arg(long))]
    pub lossless: bool,
}

impl Table {
    /// The speed of the input, rad/s, if one is asked for.
    fn input_speed(&self) -> Result<Option<f64>, Diagnostics> {
        let given: Vec<String> = self.speed.iter().cloned().collect();
        Ok(values("speed", &given, Dimension::ANGULAR_SPEED)?.first().map(Quantity::si))
    }
}

impl Question for Table {
    const NAME: &'static str = "table";
    const TABLES: &'static [&'static str] = &["states", "members", "shift-elements", "sets"];
    type Answer = ShaftTable;

    fn check(&self) -> Result<(), Diagnostics> {
        self.input_speed().map(|_| ())
    }

    fn ask(&self, of: &[Given], _: &dyn Work) -> Result<ShaftTable, Refusal> {
        Ok(analysis::shaft_table(of[0].model.train(), self.state.as_deref(), self.lossless)?)
    }

    fn text(&self, answer: &ShaftTable, _: &[Given]) -> String {
        text::text(answer, self.input_speed().ok().flatten())
    }

    fn tables(&self, answer: &ShaftTable) -> Vec<Rows> {
        tables::tables(answer, self.input_speed().ok().flatten())
    }

    fn notes(answer: &ShaftTable) -> &[Diagnostic] {
        &answer.diagnostics
    }
}
