//! `import`: gearboxes of other programs.

mod tables;
mod text;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use willis::contract::{Contract, Format};
use willis::diagnostic::{Code, Diagnostic};
use willis::work::Work;
use willis_exchange::gearsets;
use willis_exchange::rexs::{self, Convention, Report};

use crate::style::wrap;
use crate::table::{Table, csv};
use crate::{Attachment, Extra, File, Form, Given, Holds, Of, Question, Refusal};

/// Read a gearbox of another program: a REXS file, or gearsets JSON, becomes a train file.
///
/// REXS 1.0 to 1.6, as XML (.rexs), JSON (.rexsj) or zip (.rexsz): cylindrical and planetary stages, gears with their
/// geometry, bearings, lubricant, shift elements and load cases. The train file begins with what was assumed and what is
/// missing; as text the answer is an account of every attribute: used, left out or unusable. A broken file is
/// read as far as it goes. Worm and bevel stages are refused.
///
/// Gearsets JSON describes an automatic transmission: sets with Ns and Nr, clutches, brakes, sprags; its shift schedule
/// stands in a file of its own.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct Import {
    /// The file of the other program, or - for standard input.
    #[cfg_attr(feature = "clap", arg(value_name = "FILE", required = true))]
    pub file: Option<Attachment>,
    /// Sign of the profile shifts of ring gears in the file: din (positive inward, as REXS says) or outward. Default:
    /// din.
    #[cfg_attr(feature = "clap", arg(long, value_name = "SIGN"))]
    pub convention: Option<String>,
    /// The shift schedule that belongs to a transmission spec of gearsets JSON.
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE"))]
    pub schedule: Option<Attachment>,
}

/// A train file, and what became of the file that it was made from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct ImportAnswer {
    /// `willis-import-1`.
    pub format: Format<Self>,
    /// The name of the file that was read.
    pub file: String,
    /// The train file.
    pub toml: String,
    /// What was read, what was assumed, what is missing.
    pub report: Report,
}

impl Contract for ImportAnswer {
    const FORMAT: &'static str = "willis-import-1";
}

impl Import {
    fn convention(&self) -> Result<Convention, Refusal> {
        match self.convention.as_deref() {
            None | Some("din") => Ok(Convention::Din),
            Some("outward") => Ok(Convention::Outward),
            Some(other) => {
                let d = Diagnostic::new(Code::UnknownSelection, "convention", format!("there is no sign `{other}`"));
                let hint = "write din or outward";
                Err(d.suggest(other, ["din", "outward"]).hint(hint).into())
            }
        }
    }
}

impl Question for Import {
    const NAME: &'static str = "import";
    const OF: Of = Of::Nothing;
    const TABLES: &'static [&'static str] = &["attributes", "assumptions", "problems", "bearings", "load_cases"];
    const FORMS: &'static [Form] = &[Form { name: "train", endings: &["toml"], about: "the train file" }];
    const EXTRAS: &'static [Extra] = &[Extra {
        name: "spectrum",
        value: "FILE.csv",
        about: "Write the load cases with their parts of the time into this file, as a load spectrum for `cycle`",
    }];
    type Answer = ImportAnswer;

    fn ask(&self, _: &[Given], _: &dyn Work) -> Result<ImportAnswer, Refusal> {
        let convention = self.convention()?;
        let Some(file) = &self.file else {
            let d = Diagnostic::new(Code::MissingKey, "file", "nothing says what is to be read");
            return Err(d.hint("name a file: gearbox.rexs, gearbox.rexsj or gearbox.rexsz").into());
        };
        // Places are those of the other program's file, which is not shown.
        let refused = |wrong| Refusal::File(wrong, Attachment::from(file.name.as_str()));
        let bytes = file.bytes().map_err(|why| {
            let d = Diagnostic::new(Code::Unreadable, "", format!("the file cannot be read: {why}"));
            refused(d.into())
        })?;
        let read = if gearsets::is_gearsets(&bytes) {
            if self.convention.is_some() {
                let d = Diagnostic::new(Code::Conflict, "convention", "gearsets JSON has no profile shifts");
                return Err(d.hint("leave out the sign of profile shifts").into());
            }
            let schedule = self.schedule.as_ref().map(|s| {
                s.bytes().map_err(|why| {
                    let d = Diagnostic::new(Code::Unreadable, "", format!("the schedule cannot be read: {why}"));
                    Refusal::File(d.into(), Attachment::from(s.name.as_str()))
                })
            });
            let schedule = schedule.transpose()?;
            gearsets::read(&file.name, &bytes, schedule.as_deref()).map_err(refused)?
        } else if self.schedule.is_some() {
            let d = Diagnostic::new(Code::Conflict, "schedule", "a shift schedule belongs to gearsets JSON only");
            return Err(d.hint("leave out the schedule, or name a transmission spec").into());
        } else {
            rexs::read_as(&file.name, &bytes, convention).map_err(refused)?
        };
        Ok(ImportAnswer { format: Format::new(), file: file.name.clone(), toml: read.toml, report: read.report })
    }

    fn text(&self, answer: &ImportAnswer, _: &[Given]) -> String {
        text::text(&answer.file, &answer.report)
    }

    fn tables(&self, answer: &ImportAnswer) -> Vec<Table> {
        tables::tables(&answer.report)
    }

    fn natural_form(&self) -> &'static str {
        "train"
    }

    fn write(&self, answer: &ImportAnswer, _: &str, _: &[Given]) -> Result<Vec<File>, Refusal> {
        let name = answer.file.rsplit(['/', '\\']).next().unwrap_or("train");
        let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
        Ok(vec![File::text(format!("{stem}.toml"), &*answer.toml)])
    }

    fn extra(&self, answer: &ImportAnswer, _: &str, _: &[Given]) -> Result<Vec<File>, Refusal> {
        match tables::spectrum(&answer.report) {
            Ok(table) => Ok(vec![File::text("spectrum.csv", csv(&[table]))]),
            Err(why) => Err(Diagnostic::new(Code::Unfit, "spectrum", why).into()),
        }
    }

    fn told(&self, answer: &ImportAnswer) -> Vec<String> {
        let r = &answer.report;
        let mut all = vec![wrap(&text::sums(r), "note: ")];
        all.extend(r.problems.iter().take(20).map(|p| wrap(&format!("{}: {}", p.place, p.message), "warning: ")));
        let more = r.problems.len().saturating_sub(20) + r.more_problems;
        if more > 0 {
            all.push(format!("warning: and {more} more"));
        }
        all
    }

    fn attachments(&mut self) -> Vec<(&mut Attachment, Holds)> {
        self.file.iter_mut().chain(&mut self.schedule).map(|f| (f, Holds::Exchange)).collect()
    }
}
