//! `validate`: published numbers beside ours.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use willis::contract::{Contract, Format};
use willis::diagnostic::{Code, Diagnostic};
use willis::work::Work;
use willis_casebook as casebook;

use super::names;
#[cfg(feature = "clap")]
use super::names::Known;
use crate::{Extra, File, Given, Of, Question, Refusal};

/// Compare published numbers with ours: what agrees, what does not, and why.
///
/// Without a case it lists the cases. A number that differs is an answer, and no error.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct Validate {
    /// The case, as listed.
    #[cfg_attr(feature = "clap", arg(value_parser = Known(names::cases)))]
    #[schemars(extend("enum" = names::or_none(names::cases())))]
    pub case: Option<String>,
}

/// A case, or the list of them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum ValidateAnswer {
    /// `willis-validation-1`.
    Case(casebook::Report),
    /// `willis-cases-1`.
    Cases(Cases),
}

/// The cases there are.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct Cases {
    /// `willis-cases-1`.
    pub format: Format<Self>,
    /// All of them.
    pub cases: Vec<OneCase>,
}

/// A case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct OneCase {
    /// Its name.
    pub name: String,
    /// What it compares.
    pub about: String,
}

impl Contract for Cases {
    const FORMAT: &'static str = "willis-cases-1";
}

impl Contract for ValidateAnswer {
    const FORMAT: &'static str = casebook::Report::FORMAT;
}

impl Question for Validate {
    const NAME: &'static str = "validate";
    const OF: Of = Of::Nothing;
    const EXTRAS: &'static [Extra] =
        &[Extra { name: "data", value: "FOLDER", about: "Write the curves of the case as CSV files into this folder" }];
    type Answer = ValidateAnswer;

    fn ask(&self, _: &[Given], _: &dyn Work) -> Result<ValidateAnswer, Refusal> {
        let Some(name) = &self.case else {
            let case = |c: &casebook::ValidationCase| OneCase { name: c.name.to_owned(), about: c.about.to_owned() };
            let cases = casebook::CASES.iter().map(case).collect();
            return Ok(ValidateAnswer::Cases(Cases { format: Format::new(), cases }));
        };
        match casebook::run(name) {
            Some(report) => Ok(ValidateAnswer::Case(report)),
            None => {
                let known = || casebook::CASES.iter().map(|c| c.name);
                let list = known().collect::<Vec<_>>().join(", ");
                Err(Diagnostic::new(Code::UnknownSelection, "", format!("there is no case `{name}`"))
                    .suggest(name, known())
                    .hint(format!("the cases are: {list}"))
                    .into())
            }
        }
    }

    fn text(&self, answer: &ValidateAnswer, _: &[Given]) -> String {
        match answer {
            ValidateAnswer::Case(report) => report.to_string(),
            ValidateAnswer::Cases(all) => all.cases.iter().map(|c| format!("{:<12}{}\n", c.name, c.about)).collect(),
        }
    }

    fn extra(&self, _: &ValidateAnswer, _: &str, _: &[Given]) -> Result<Vec<File>, Refusal> {
        let Some(name) = &self.case else {
            let d = Diagnostic::new(Code::UnknownSelection, "", "curves are those of a case, and none is named");
            return Err(d.hint("name the case, such as wang-2020").into());
        };
        let files = casebook::data(name).ok_or_else(|| {
            Refusal::from(Diagnostic::new(Code::Unfit, "", format!("the case `{name}` has no curves")))
        })?;
        Ok(files.into_iter().map(|(name, text)| File::text(name, text)).collect())
    }
}
