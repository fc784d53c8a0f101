//! `explain`: what a diagnostic code means.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use willis::contract::{Contract, Format};
use willis::diagnostic::{Code, Diagnostic, Severity};
use willis::work::Work;

use super::names;
#[cfg(feature = "clap")]
use super::names::Known;
use crate::{Given, Of, Question, Refusal};

/// Explain a diagnostic code or a rule for teeth, or list all of them.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct Explain {
    /// The code, such as E106, or a rule of `design`, such as hunting.
    #[cfg_attr(feature = "clap", arg(value_parser = Known(names::codes), hide_possible_values = true))]
    #[schemars(extend("enum" = names::or_none(names::codes())))]
    pub code: Option<String>,
}

/// Diagnostic codes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct ExplainAnswer {
    /// `willis-codes-1`.
    pub format: Format<Self>,
    /// The code that was asked for, or all.
    pub codes: Vec<Explained>,
    /// The rule for teeth that was asked for, or all.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub rules: Vec<ExplainedRule>,
}

impl Contract for ExplainAnswer {
    const FORMAT: &'static str = "willis-codes-1";
}

/// A rule that tooth numbers may have to follow.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct ExplainedRule {
    /// Its name in a design file.
    pub name: String,
    /// What it demands, by which formula, and why.
    pub explanation: String,
}

/// The rules there are.
fn rules() -> Vec<ExplainedRule> {
    #[cfg(feature = "design")]
    let all = willis_synthesis::teeth::Rule::ALL.iter();
    #[cfg(feature = "design")]
    return all.map(|r| ExplainedRule { name: r.name().into(), explanation: r.explanation().into() }).collect();
    #[cfg(not(feature = "design"))]
    vec![]
}

/// A diagnostic code.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct Explained {
    /// The code, `E106`.
    pub code: Code,
    /// How much it matters.
    pub severity: Severity,
    /// One line that names the matter.
    pub title: String,
    /// What it means, why it matters and what to do.
    pub explanation: String,
}

impl Question for Explain {
    const NAME: &'static str = "explain";
    const OF: Of = Of::Nothing;
    type Answer = ExplainAnswer;

    fn ask(&self, _: &[Given], _: &dyn Work) -> Result<ExplainAnswer, Refusal> {
        let mut rules = rules();
        let codes = match &self.code {
            None => Code::ALL.to_vec(),
            Some(text) => match Code::parse(text) {
                Some(code) => {
                    rules.clear();
                    vec![code]
                }
                None if rules.iter().any(|r| r.name == *text) => {
                    rules.retain(|r| r.name == *text);
                    vec![]
                }
                None => {
                    let known = Code::ALL.iter().map(|c| c.as_str()).chain(rules.iter().map(|r| r.name.as_str()));
                    let message = format!("there is no diagnostic and no rule `{text}`");
                    return Err(Diagnostic::new(Code::UnknownSelection, "", message)
                        .suggest(text, known)
                        .hint("`willis explain` lists all of them")
                        .into());
                }
            },
        };
        let explained = |code: Code| Explained {
            code,
            severity: code.severity(),
            title: code.title().to_owned(),
            explanation: code.explanation().lines().map(str::trim_start).collect::<Vec<_>>().join("\n").trim().into(),
        };
        Ok(ExplainAnswer { format: Format::new(), codes: codes.into_iter().map(explained).collect(), rules })
    }

    fn text(&self, answer: &ExplainAnswer, _: &[Given]) -> String {
        match (&self.code, answer.codes.as_slice()) {
            (Some(_), [one]) => format!("{}: {}\n\n{}\n", one.code, one.title, one.explanation),
            (Some(_), []) => {
                let rule =
                    |r: &ExplainedRule| format!("{}\n", crate::style::wrap(&r.explanation, &format!("{}: ", r.name)));
                answer.rules.iter().map(rule).collect()
            }
            (_, all) => {
                let codes = all.iter().map(|c| format!("{}  {}\n", c.code, c.title));
                let rules = answer.rules.iter().map(|r| {
                    let first = r.explanation.split_inclusive(['.', ':']).next().unwrap_or_default();
                    format!("{:<12}  {}\n", r.name, first.trim_end_matches([':', '.']))
                });
                codes.chain(rules).collect()
            }
        }
    }
}
