//! `modes`: torsional natural frequencies.

mod tables;
mod text;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use willis::dynamics::{self, ModesReport};
use willis::work::Work;

use crate::table::Table;
#[cfg(feature = "pictures")]
use crate::{Extra, File, Form};
use crate::{Given, Question, Refusal};

/// List torsional natural frequencies: shapes, damping, where the energy is.
///
/// Small vibrations of the moments of inertia on the elastic shafts; the gears tie them together.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct Modes {
    /// State of the shift table; else the train as drawn.
    #[cfg_attr(feature = "clap", arg(long, value_name = "STATE"))]
    pub state: Option<String>,
    /// Members held at rest, with commas between.
    #[cfg_attr(feature = "clap", arg(long, value_delimiter = ',', value_name = "MEMBER"))]
    pub fixed: Vec<String>,
}

impl Question for Modes {
    const NAME: &'static str = "modes";
    const TABLES: &'static [&'static str] = &["modes"];
    #[cfg(feature = "pictures")]
    const FORMS: &'static [Form] = &[Form { name: "svg", endings: &["svg"], about: "the shapes as a figure" }];
    #[cfg(feature = "pictures")]
    const EXTRAS: &'static [Extra] =
        &[Extra { name: "plot", value: "FILE.svg", about: "Draw the shapes into this SVG file" }];
    type Answer = ModesReport;

    fn ask(&self, of: &[Given], _: &dyn Work) -> Result<ModesReport, Refusal> {
        let held: Vec<&str> = self.fixed.iter().map(String::as_str).collect();
        Ok(dynamics::modes(of[0].model.train(), self.state.as_deref(), &held)?)
    }

    fn text(&self, answer: &ModesReport, _: &[Given]) -> String {
        text::text(answer)
    }

    fn tables(&self, answer: &ModesReport) -> Vec<Table> {
        vec![tables::table_of(answer)]
    }

    #[cfg(feature = "pictures")]
    fn write(&self, answer: &ModesReport, _: &str, _: &[Given]) -> Result<Vec<File>, Refusal> {
        Ok(vec![File::text("modes.svg", willis_figure::draw_modes(answer) + "\n")])
    }

    #[cfg(feature = "pictures")]
    fn extra(&self, answer: &ModesReport, _: &str, of: &[Given]) -> Result<Vec<File>, Refusal> {
        self.write(answer, "svg", of)
    }
}
