//! Why there is no answer.

use std::fmt;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use willis::contract::{Contract, Format};
use willis::diagnostic::{Diagnostic, Diagnostics, printable};
use willis::work::{Cancelled, TooLong};

use crate::{Attachment, Given};

/// Why there is no answer.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Refusal {
    /// Something is wrong with the request, or with the train at that position, from 0; places are those of its file.
    Wrong(Diagnostics, usize),
    /// Something is wrong with a file that the request names; places are those of its text.
    File(Diagnostics, Attachment),
    /// It was told to stop.
    Cancelled,
}

/// A refusal for machines.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct RefusalReport {
    /// `willis-refusal-1`.
    pub format: Format<Self>,
    /// The file in which the places are; none where the request alone is wrong.
    pub file: Option<String>,
    /// What is wrong, the first 50 at most.
    pub diagnostics: Vec<Diagnostic>,
    /// How much more is wrong.
    #[serde(default, skip_serializing_if = "is_none")]
    pub more: usize,
}

fn is_none(more: &usize) -> bool {
    *more == 0
}

impl Contract for RefusalReport {
    const FORMAT: &'static str = "willis-refusal-1";
}

impl RefusalReport {
    /// Its JSON Schema.
    #[cfg(feature = "schemas")]
    pub fn schema() -> schemars::Schema {
        crate::question::generator().root_schema_for::<Self>()
    }

    /// What is wrong with a file.
    pub fn new(file: Option<&str>, wrong: &Diagnostics) -> Self {
        let diagnostics: Vec<Diagnostic> = wrong.iter().take(Diagnostics::MOST_SHOWN).cloned().collect();
        let more = wrong.len() - diagnostics.len();
        Self { format: Format::new(), file: file.map(str::to_owned), diagnostics, more }
    }
}

impl Refusal {
    /// The diagnostics with their places in the file that they are about, the name of that file and its text.
    pub fn located<'a>(&'a self, of: &'a [Given]) -> (Diagnostics, Option<(&'a str, &'a str)>) {
        match self {
            Self::Wrong(wrong, k) => {
                let mut wrong = wrong.clone();
                let Some(given) = of.get(*k) else { return (wrong, None) };
                given.model.locate(&mut wrong);
                wrong.stand_in(Some(&given.name), given.model.to_toml());
                (wrong, Some((&given.name, given.model.to_toml())))
            }
            Self::File(wrong, file) => {
                let mut wrong = wrong.clone();
                wrong.stand_in(Some(&file.name), &file.text);
                (wrong, Some((&file.name, &file.text)))
            }
            Self::Cancelled => (Cancelled.into(), None),
        }
    }

    /// For eyes, each place underlined, the count at the end.
    pub fn render(&self, of: &[Given], color: bool) -> String {
        // Longer texts are not shown in part.
        const MOST: usize = 1 << 22;
        let (wrong, file) = self.located(of);
        match file {
            _ if *self == Self::Cancelled => format!("{self}\n"),
            Some((name, text)) => report(&wrong, name, if text.len() > MOST { "" } else { text }, color),
            None => wrong.render("", "", color),
        }
    }

    /// For machines.
    pub fn report(&self, of: &[Given]) -> RefusalReport {
        let (wrong, file) = self.located(of);
        RefusalReport::new(file.map(|f| f.0), &wrong)
    }
}

/// Diagnostics of a file for eyes, with their count.
pub fn report(wrong: &Diagnostics, name: &str, text: &str, color: bool) -> String {
    let errors = wrong.iter().filter(|d| d.severity == willis::diagnostic::Severity::Error).count();
    let s = if errors == 1 { "" } else { "s" };
    format!("{}{}: {errors} error{s}\n", wrong.render(name, text, color), printable(name))
}

impl From<Diagnostics> for Refusal {
    fn from(wrong: Diagnostics) -> Self {
        if wrong.is_cancelled() { Self::Cancelled } else { Self::Wrong(wrong, 0) }
    }
}

impl From<Diagnostic> for Refusal {
    fn from(wrong: Diagnostic) -> Self {
        Self::Wrong(wrong.into(), 0)
    }
}

impl From<TooLong> for Refusal {
    fn from(why: TooLong) -> Self {
        Diagnostics::from(why).into()
    }
}

impl From<Cancelled> for Refusal {
    fn from(_: Cancelled) -> Self {
        Self::Cancelled
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Wrong(wrong, _) | Self::File(wrong, _) => wrong.fmt(f),
            Self::Cancelled => Cancelled.fmt(f),
        }
    }
}

impl std::error::Error for Refusal {}
