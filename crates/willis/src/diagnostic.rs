//! What is wrong, where, with which numbers, and what to do about it.
//!
//! The user's mistakes are [`Diagnostics`]: all of them at once, each with a stable [`Code`], the
//! place in the train (`set[1].ring.teeth`) and, when the train came from text, the bytes, lines and
//! columns it stands on. [`Diagnostics`] is the error of every function here that takes a train or a file; the errors of
//! single values and problems ([`QuantityError`](crate::units::QuantityError), [`Fault`](crate::geometry::Fault),
//! [`Unposed`](crate::statics::Unposed), …) become diagnostics by `?`.
//!
//! Diagnostics serialise and read back: a front end in another process or language shows the same list.
//!
//! ```
//! use willis::{Diagnostics, Train};
//!
//! let wrong = Train::from_toml("format = 1\nname = \"one\"\nmembers = [\"s\"]\nterminels = [\"s\"]\n").unwrap_err();
//! let json = serde_json::to_value(&wrong)?;
//! assert_eq!(json[0]["code"], "E004");
//! assert_eq!(json[0]["span"]["line"], 4);
//! assert_eq!(json[0]["replacement"], "terminals");
//! assert_eq!(serde_json::from_value::<Diagnostics>(json)?, wrong);
//! # Ok::<(), serde_json::Error>(())
//! ```
//!
//! An unusual answer of the physics (locked, several solutions) is no error: it is a
//! verdict in the result, with a diagnostic of severity [`Severity::Warning`] or
//! [`Severity::Note`] beside it.

mod codes;
mod conversions;
mod numbers;
mod printable;
mod span;

use std::fmt;

use annotate_snippets::{AnnotationKind, Group, Level, Patch, Renderer, Snippet};
use serde::{Deserialize, Serialize};

use crate::work::{Cancelled, TooLong};

pub use codes::Code;
pub(crate) use conversions::through_diagnostic;
pub(crate) use numbers::apart;
pub use printable::{is_printable, printable};
pub use span::{Lines, Span};

/// How much a diagnostic matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// The input cannot be answered.
    Error,
    /// The answer holds, and there is something its reader must know.
    Warning,
    /// A fact that explains the answer.
    Note,
}

/// One thing to tell the user.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Diagnostic {
    /// Stable code; `willis explain CODE` tells more.
    pub code: Code,
    /// How much it matters.
    pub severity: Severity,
    /// The place in the train, such as `set[1].ring.teeth`; empty for the train as a whole.
    pub place: String,
    /// What is the case, with the numbers and names in it.
    pub message: String,
    /// What to do; may name a value that works.
    pub hints: Vec<String>,
    /// The file whose text it stands on, as the caller names it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// The part of the source text it stands on, when there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub span: Option<Span>,
    /// What to put in place of the spanned text, when that is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub replacement: Option<String>,
}

impl Diagnostic {
    /// A diagnostic of the severity that its code carries.
    pub fn new(code: Code, place: impl Into<String>, message: impl Into<String>) -> Self {
        Self {
            code,
            severity: code.severity(),
            place: place.into(),
            message: message.into(),
            hints: Vec::new(),
            file: None,
            span: None,
            replacement: None,
        }
    }

    /// That the train has no such thing: with the nearest name, and a hint that lists all.
    pub fn missing<'a>(code: Code, what: &str, name: &str, known: impl Iterator<Item = &'a str> + Clone) -> Self {
        let all = known.clone().collect::<Vec<_>>().join(", ");
        let several = match (what.strip_suffix('y'), what.ends_with("sh")) {
            (Some(stem), _) => format!("{stem}ies"),
            (None, true) => format!("{what}es"),
            (None, false) => format!("{what}s"),
        };
        let hint = if all.is_empty() { format!("it has no {several}") } else { format!("its {several} are: {all}") };
        Self::new(code, "", format!("the train has no {what} `{name}`")).suggest(name, known).hint(hint)
    }

    /// Adds a hint.
    #[must_use]
    pub fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hints.push(hint.into());
        self
    }

    /// Adds the hint "did you mean …" when one of `known` is near `found`.
    #[must_use]
    pub fn suggest<'a>(mut self, found: &str, known: impl IntoIterator<Item = &'a str>) -> Self {
        if let Some(near) = nearest(found, known) {
            self.hints.push(format!("did you mean `{near}`?"));
            self.replacement = Some(near.to_owned());
        }
        self
    }
}

/// The known word that a misspelt one most likely stands for.
fn nearest<'a>(found: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    if found.len() > 64 {
        return None;
    }
    known
        .into_iter()
        .map(|k| (strsim::damerau_levenshtein(&found.to_lowercase(), &k.to_lowercase()), k))
        .filter(|(distance, k)| {
            let longer = k.chars().count().max(found.chars().count());
            // One letter for another is no misspelling of a one-letter name.
            *distance <= (longer / 3).max(1) && *distance < longer
        })
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, k)| k)
        .filter(|k| *k != found)
}

/// Everything there is to say about one input.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(transparent)]
pub struct Diagnostics(Vec<Diagnostic>);

impl Diagnostics {
    /// So many are shown to a person, or handed to a machine; of the others it is said how many they are.
    pub const MOST_SHOWN: usize = 50;

    /// Adds one.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        self.0.push(diagnostic);
    }

    /// Adds many.
    pub fn extend(&mut self, other: impl IntoIterator<Item = Diagnostic>) {
        self.0.extend(other);
    }

    /// All, in the order found.
    pub fn iter(&self) -> std::slice::Iter<'_, Diagnostic> {
        self.0.iter()
    }

    /// Whether there is an error among those that came after the first so many.
    pub(crate) fn has_errors_since(&self, before: usize) -> bool {
        self.0[before..].iter().any(|d| d.severity == Severity::Error)
    }

    /// Whether an error is among them.
    pub fn has_errors(&self) -> bool {
        self.0.iter().any(|d| d.severity == Severity::Error)
    }

    /// Whether nothing is wrong but that the computation was [stopped](Code::Cancelled).
    pub fn is_cancelled(&self) -> bool {
        self.0.iter().any(|d| d.code == Code::Cancelled)
    }

    /// Whether there is nothing to say.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    pub(crate) fn iter_mut(&mut self) -> std::slice::IterMut<'_, Diagnostic> {
        self.0.iter_mut()
    }

    /// Puts them in the order in which they stand in the text.
    pub(crate) fn sort(&mut self) {
        self.0.sort_by_key(|d| d.span.map(|s| s.start));
    }

    /// Counts lines and columns of every span in `text`, the text it was found in, and says which `file` that is.
    ///
    /// What has its lines, or a file, keeps them.
    pub fn stand_in(&mut self, file: Option<&str>, text: &str) {
        span::count_lines(self.0.iter_mut().filter_map(|d| d.span.as_mut()), text);
        for d in self.0.iter_mut().filter(|d| d.span.is_some() && d.file.is_none()) {
            d.file = file.map(str::to_owned);
        }
    }

    /// The text for people, each place underlined in `source` where there is one. `file` is what
    /// the source is called; `color` adds ANSI styles. Long lists are cut after 50 with a count.
    pub fn render(&self, file: &str, source: &str, color: bool) -> String {
        let renderer = if color { Renderer::styled() } else { Renderer::plain() };
        let mut out = String::new();
        // A terminal must not obey what a file says, or how it is called.
        let shown = |text: &str| printable(text).into_owned();
        let file = &*shown(file);
        for d in self.0.iter().take(Self::MOST_SHOWN) {
            let (message, place) = (shown(&d.message), shown(&d.place));
            let hints: Vec<String> = d.hints.iter().map(|h| shown(h)).collect();
            let level = match d.severity {
                Severity::Error => Level::ERROR,
                Severity::Warning => Level::WARNING,
                Severity::Note => Level::NOTE,
            };
            let title = level.primary_title(message.as_str()).id(d.code.as_str());
            let mut group = Group::with_title(title);
            let span = d.span.map(|s| s.range()).filter(|s| source.get(s.clone()).is_some());
            if let Some(span) = &span {
                let (text, span) = printable::excerpt(source, span.clone());
                let label = AnnotationKind::Primary.span(span).label(place.as_str());
                group = group.element(Snippet::source(text).path(file).annotation(label));
            } else if !d.place.is_empty() {
                group = group.element(Level::NOTE.message(format!("at {place}")));
            }
            for hint in &hints {
                group = group.element(Level::HELP.message(hint.as_str()));
            }
            let mut report = vec![group];
            if let (Some(span), Some(new)) = (span, &d.replacement) {
                let (text, span) = printable::excerpt(source, span);
                report.push(
                    Level::HELP
                        .secondary_title("with that change")
                        .element(Snippet::source(text).path(file).patch(Patch::new(span, shown(new)))),
                );
            }
            out += &renderer.render(&report);
            out.push_str("\n\n");
        }
        if self.0.len() > Self::MOST_SHOWN {
            out += &format!("… and {} more of the kind\n\n", self.0.len() - Self::MOST_SHOWN);
        }
        out
    }
}

/// What would take too long has the code [`Code::TooLong`].
impl From<TooLong> for Diagnostics {
    fn from(why: TooLong) -> Self {
        let hint = "ask for fewer, or say `yes` to let it go on";
        Diagnostic::new(Code::TooLong, "", why.to_string()).hint(hint).into()
    }
}

/// A computation that was stopped has the code [`Code::Cancelled`].
impl From<Cancelled> for Diagnostics {
    fn from(cancelled: Cancelled) -> Self {
        Diagnostic::new(Code::Cancelled, "", cancelled.to_string()).into()
    }
}

impl FromIterator<Diagnostic> for Diagnostics {
    fn from_iter<I: IntoIterator<Item = Diagnostic>>(all: I) -> Self {
        Self(all.into_iter().collect())
    }
}

impl IntoIterator for Diagnostics {
    type Item = Diagnostic;
    type IntoIter = std::vec::IntoIter<Diagnostic>;
    fn into_iter(self) -> Self::IntoIter {
        self.0.into_iter()
    }
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (k, d) in self.0.iter().enumerate() {
            if k > 0 {
                writeln!(f)?;
            }
            write!(f, "{}[{}]: {}", format!("{:?}", d.severity).to_lowercase(), d.code, d.message)?;
            if !d.place.is_empty() {
                write!(f, " (at {})", d.place)?;
            }
            for hint in &d.hints {
                write!(f, "; {hint}")?;
            }
        }
        Ok(())
    }
}

impl std::error::Error for Diagnostics {}
