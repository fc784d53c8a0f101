//! `new`: a train file to start from.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use willis::contract::{Contract, Format};
use willis::diagnostic::{Code, Diagnostic};
use willis::work::Work;

use super::names;
#[cfg(feature = "clap")]
use super::names::Known;
use crate::{File, Form, Given, Of, Question, Refusal};

/// Write a commented train file to start from.
///
/// Without a kind it lists the kinds: `willis new automatic -o mine.toml`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct New {
    /// The kind, as listed.
    #[cfg_attr(feature = "clap", arg(value_parser = Known(kinds)))]
    #[schemars(extend("enum" = names::or_none(kinds())))]
    pub kind: Option<String>,
}

/// A start: its name, one line about it, its text.
const STARTS: &[(&str, &str, &str)] = &[
    ("set", "one planetary set, ring held: ratio, efficiency, torques", include_str!("new/set.toml")),
    ("automatic", "two sets, clutches and brakes: a shift table", include_str!("new/automatic.toml")),
    ("split", "two degrees of freedom: an engine and a machine on one set", include_str!("new/split.toml")),
    ("losses", "teeth, oil, bearings and seals: losses from geometry", include_str!("new/losses.toml")),
    ("motion", "inertias, a brake and a vehicle: a motion to simulate", include_str!("new/motion.toml")),
];

fn kinds() -> Vec<&'static str> {
    STARTS.iter().map(|s| s.0).collect()
}

/// A train file to start from, or the kinds there are.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct NewAnswer {
    /// `willis-new-1`.
    pub format: Format<Self>,
    /// The kind that was asked for, or all.
    pub starts: Vec<Start>,
}

impl Contract for NewAnswer {
    const FORMAT: &'static str = "willis-new-1";
}

/// A train file to start from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct Start {
    /// How it is asked for.
    pub kind: String,
    /// One line about it.
    pub about: String,
    /// The train file.
    pub toml: String,
}

impl Question for New {
    const NAME: &'static str = "new";
    const OF: Of = Of::Nothing;
    const FORMS: &'static [Form] = &[Form { name: "toml", endings: &["toml"], about: "the train file" }];
    type Answer = NewAnswer;

    fn ask(&self, _: &[Given], _: &dyn Work) -> Result<NewAnswer, Refusal> {
        let wanted = |name: &str| self.kind.as_deref().is_none_or(|k| k == name);
        let starts: Vec<Start> = (STARTS.iter())
            .filter(|s| wanted(s.0))
            .map(|(kind, about, toml)| Start { kind: (*kind).into(), about: (*about).into(), toml: (*toml).into() })
            .collect();
        match &self.kind {
            Some(kind) if starts.is_empty() => {
                let known = || STARTS.iter().map(|s| s.0);
                let list = known().collect::<Vec<_>>().join(", ");
                Err(Diagnostic::new(Code::UnknownSelection, "", format!("there is no start `{kind}`"))
                    .suggest(kind, known())
                    .hint(format!("the kinds are: {list}"))
                    .into())
            }
            _ => Ok(NewAnswer { format: Format::new(), starts }),
        }
    }

    fn text(&self, answer: &NewAnswer, _: &[Given]) -> String {
        match (&self.kind, answer.starts.as_slice()) {
            (Some(_), [one]) => one.toml.clone(),
            (_, all) => all.iter().map(|s| format!("{:<12}{}\n", s.kind, s.about)).collect(),
        }
    }

    fn natural_form(&self) -> &'static str {
        if self.kind.is_some() { "toml" } else { "text" }
    }

    fn write(&self, answer: &NewAnswer, _: &str, _: &[Given]) -> Result<Vec<File>, Refusal> {
        Ok(answer.starts.iter().map(|s| File::text(format!("{}.toml", s.kind), &*s.toml)).collect())
    }
}
