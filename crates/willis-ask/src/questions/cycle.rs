//! `cycle`: what a duty cycle costs.

mod tables;
mod text;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use willis::contract::Contract;
use willis::diagnostic::Diagnostics;
use willis::study::{self, ColumnTable, CycleReport, CycleRequest};
use willis::work::Work;

use super::names;
use crate::table::Table;
use crate::{Attachment, Extra, File, Given, Holds, Question, Refusal};

/// Compute the energy lost over a duty cycle or load spectrum: by source, state and direction, the worst rows.
///
/// Each row of the profile, a CSV file, is one operating condition. A column weighs the rows in time: `time [s]` of a
/// trace (each row holds until the next), or `duration [s]`, `hours` or `share` of a spectrum. The other columns set
/// quantities, with the unit in the header: `input.speed [rpm]`, `output.torque [N m]`, `oil.temperature [degC]`, state, or any
/// quantity of the train file. Rows without an answer are listed with their reason, and *coverage* is the part of the
/// time that the energies hold for.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct Cycle {
    /// The profile (CSV), or - for standard input.
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE.csv", required = true))]
    pub profile: Attachment,
    /// Leave this column of the profile out; its name, with or without the unit. Several times for several columns.
    #[cfg_attr(feature = "clap", arg(long, value_name = "NAME", conflicts_with = "only_column"))]
    pub ignore_column: Vec<String>,
    /// Read this column of the profile and no others than are named so. Several times for several columns.
    #[cfg_attr(feature = "clap", arg(long, value_name = "NAME"))]
    pub only_column: Vec<String>,
    /// The operation that gives what no column sets. Default: the first one in the state, else the file's first.
    #[cfg_attr(feature = "clap", arg(long, value_name = "OPERATION"))]
    pub operation: Option<String>,
    /// State of the shift table, where no column gives it.
    #[cfg_attr(feature = "clap", arg(long, value_name = "STATE"))]
    pub state: Option<String>,
}

/// A duty cycle: its energies, and its rows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct CycleAnswer {
    /// `willis-cycle-1`.
    pub report: CycleReport,
    /// Every row of the profile with its answer; they are had as a table and not in the contract.
    #[serde(skip)]
    pub rows: ColumnTable,
}

impl Contract for CycleAnswer {
    const FORMAT: &'static str = CycleReport::FORMAT;
}

impl Question for Cycle {
    const NAME: &'static str = "cycle";
    const TABLES: &'static [&'static str] =
        &["cycle", "directions", "states", "sources", "terminals", "verdicts", "worst", "rows"];
    const EXTRAS: &'static [Extra] =
        &[Extra { name: "rows", value: "FILE.csv", about: "Write every row with its answer into this CSV file" }];
    type Answer = CycleAnswer;

    fn check(&self) -> Result<(), Diagnostics> {
        let named = |columns: &[String]| !columns.is_empty();
        names::apart(&[[("only_column", named(&self.only_column)), ("ignore_column", named(&self.ignore_column))]])
    }

    fn ask(&self, of: &[Given], work: &dyn Work) -> Result<CycleAnswer, Refusal> {
        let request = CycleRequest {
            profile: self.profile.text.clone(),
            ignore_column: self.ignore_column.clone(),
            only_column: self.only_column.clone(),
            operation: self.operation.clone(),
            state: self.state.clone(),
        };
        // What is wrong with the profile stands in the profile.
        let answer = study::cycle(&of[0].model, &request, work).map_err(|wrong| {
            match wrong.iter().any(|d| d.span.is_some()) {
                true => Refusal::File(wrong, self.profile.clone()),
                false => wrong.into(),
            }
        })?;
        Ok(CycleAnswer { report: answer.report, rows: answer.rows })
    }

    fn text(&self, answer: &CycleAnswer, _: &[Given]) -> String {
        text::text(&answer.report, &self.profile.name)
    }

    fn tables(&self, answer: &CycleAnswer) -> Vec<Table> {
        let mut all = tables::tables(&answer.report);
        all.push(Table::of_columns("rows", &answer.rows).aside());
        all
    }

    fn extra(&self, answer: &CycleAnswer, _: &str, _: &[Given]) -> Result<Vec<File>, Refusal> {
        Ok(vec![File::text("rows.csv", Table::of_columns("rows", &answer.rows).csv())])
    }

    fn attachments(&mut self) -> Vec<(&mut Attachment, Holds)> {
        vec![(&mut self.profile, Holds::Table)]
    }
}
