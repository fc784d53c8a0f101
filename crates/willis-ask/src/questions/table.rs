//! `table`: speeds and torques of everything in every state.

mod tables;
mod text;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use willis::analysis::{self, AskedLoad, Selection, ShaftTable, ShaftTableRequest};
use willis::diagnostic::{Diagnostic, Diagnostics};
use willis::units::{Dimension, Quantity};
use willis::work::{Effort, Work};

use super::amount::values;
use crate::table::Table as Rows;
use crate::{Given, Question, Refusal};

/// Tabulate the speed of every shaft and planet, the slip of every open element and every torque, in all states.
///
/// Speeds are those over the speed of the input, or in rpm at a given one. Torques are those over the torque of the input,
/// which drives the output through the losses of the teeth. Where losses depend on load and speed, they are computed for every
/// state at one load, and at the same speed with nothing at the output: the spin loss, with the drag of every open element.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct Table {
    /// Only this state of the shift table.
    #[cfg_attr(feature = "clap", arg(long, value_name = "STATE"))]
    pub state: Option<String>,
    /// Show speeds in rpm at this speed of the input, and compute losses there: 2000rpm. Losses without it: at the speed of
    /// the file's first operation in which the input drives.
    #[cfg_attr(feature = "clap", arg(long, value_name = "SPEED"))]
    pub speed: Option<String>,
    /// Compute losses at this torque at the input: 150Nm. Without it: at the load of that operation.
    #[cfg_attr(feature = "clap", arg(long, value_name = "TORQUE"))]
    pub torque: Option<String>,
    /// Compute losses at this oil temperature: 80degC. Without it: at that of the operation, the heat balance, or the oil.
    #[cfg_attr(feature = "clap", arg(long, value_name = "TEMPERATURE"))]
    pub temperature: Option<String>,
    /// Torques without losses, and no losses at a load.
    #[cfg_attr(feature = "clap", arg(long))]
    pub lossless: bool,
}

impl Table {
    /// The speed of the input, rad/s, if one is asked for.
    fn input_speed(&self) -> Option<f64> {
        self.given().ok()?[0].as_ref().map(Quantity::si)
    }

    /// Speed, torque and temperature that are asked for; all that is wrong with them at once.
    fn given(&self) -> Result<[Option<Quantity>; 3], Diagnostics> {
        let mut told = Diagnostics::default();
        let fields = [
            ("speed", &self.speed, Dimension::ANGULAR_SPEED),
            ("torque", &self.torque, Dimension::TORQUE),
            ("temperature", &self.temperature, Dimension::TEMPERATURE),
        ];
        let all = fields.map(|(name, text, dimension)| {
            let text: Vec<String> = text.iter().cloned().collect();
            values(name, &text, dimension).unwrap_or_else(|wrong| {
                told.extend(wrong);
                vec![]
            })
        });
        if told.has_errors() { Err(told) } else { Ok(all.map(|v| v.into_iter().next())) }
    }
}

impl Question for Table {
    const NAME: &'static str = "table";
    const TABLES: &'static [&'static str] = &["states", "members", "shift-elements", "sets", "losses"];
    type Answer = ShaftTable;

    fn check(&self) -> Result<(), Diagnostics> {
        self.given().map(|_| ())
    }

    fn ask(&self, of: &[Given], work: &dyn Work) -> Result<ShaftTable, Refusal> {
        let train = of[0].model.train();
        work.afford(&Effort::of_analysis(train, &Selection { state: self.state.clone(), operation: None }))?;
        let [speed, torque, temperature] = self.given()?;
        let asked = AskedLoad { speed, torque, temperature: temperature.map(|t| t.si()) };
        let load = (!self.lossless).then_some(asked);
        let request = ShaftTableRequest { state: self.state.clone(), lossless: self.lossless, load };
        Ok(analysis::shaft_table(train, &request)?.with_bands(train))
    }

    fn text(&self, answer: &ShaftTable, _: &[Given]) -> String {
        text::text(answer, self.input_speed())
    }

    fn tables(&self, answer: &ShaftTable) -> Vec<Rows> {
        tables::tables(answer, self.input_speed())
    }

    fn notes(answer: &ShaftTable) -> &[Diagnostic] {
        &answer.diagnostics
    }
}
