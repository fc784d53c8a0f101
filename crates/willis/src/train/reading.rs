//! From the text of a train file to a train.

use crate::diagnostic::{Code, Diagnostic, Diagnostics, Severity, Span};

use super::Train;
use super::assemble::assemble;
use super::assembler::Load;
use super::format;
use super::specification::field::Tabular;
use super::specification::{FILE, Specification};

/// What reading a train file gave.
#[derive(Clone, Debug)]
pub struct Reading {
    /// The train, unless there were errors.
    pub train: Option<Train>,
    /// What the text says, unless there were errors.
    pub specification: Option<Specification>,
    /// Errors and warnings, with their places in the text.
    pub diagnostics: Diagnostics,
    spans: format::Spans,
}

impl Reading {
    /// Gives later diagnostics (of an analysis) their places in `text`, the text that was read.
    pub fn locate(&self, text: &str, diagnostics: &mut Diagnostics) {
        locate(&self.spans, text, diagnostics);
    }
}

fn locate(spans: &format::Spans, text: &str, diagnostics: &mut Diagnostics) {
    let mut sought = diagnostics.iter_mut().filter(|d| d.span.is_none()).peekable();
    let index = sought.peek().map(|_| spans.index());
    for d in sought {
        d.span = index.as_ref().and_then(|index| index.nearest(&d.place)).map(Span::from);
        // A suggestion replaces a name; inside quotes, if that is what stands there.
        if let (Some(span), Some(new)) = (&d.span, &mut d.replacement)
            && let Some(quote) = text[span.range()].chars().next().filter(|c| matches!(c, '"' | '\''))
        {
            *new = format!("{quote}{new}{quote}");
        }
    }
    diagnostics.stand_in(None, text);
    diagnostics.sort();
}

pub(super) fn read(text: &str, load: &mut Load<'_>) -> Reading {
    let mut diagnostics = Diagnostics::default();
    if text.trim().is_empty() {
        diagnostics.push(
            Diagnostic::new(Code::MissingKey, "", "the file is empty")
                .hint("a train file begins with `format = 1` and names its `members`; see the examples for a start"),
        );
        return Reading { train: None, specification: None, diagnostics, spans: format::Spans::default() };
    }
    let (root, spans) = format::read(text, FILE, &mut diagnostics);
    let specification = Specification::read_fields(&root);
    // Tables of points may be large.
    drop(root);
    let mut train = None;
    if !diagnostics.has_errors() {
        train = assemble(&specification, load, &mut diagnostics);
    } else if diagnostics.len() < 100 && !diagnostics.iter().any(|d| d.code == Code::Syntax) {
        // Names can be checked too where the shape is sound; what is missing was already reported.
        let mut more = Diagnostics::default();
        assemble(&specification, load, &mut more);
        let reported: Vec<String> = diagnostics.iter().map(|d| d.place.clone()).collect();
        let doubtful = |d: &Diagnostic| {
            matches!(d.code, Code::MissingKey | Code::IncompleteSet | Code::Unconnected)
                || d.severity != Severity::Error
                || reported.iter().any(|r| !r.is_empty() && (d.place.starts_with(r) || r.starts_with(&d.place)))
        };
        diagnostics.extend(more.into_iter().filter(|d| !doubtful(d)));
    }
    locate(&spans, text, &mut diagnostics);
    if let Some(train) = &mut train {
        train.warnings = diagnostics.iter().cloned().collect();
    }
    let specification = Some(specification).filter(|_| train.is_some());
    Reading { train, specification, diagnostics, spans }
}

impl Specification {
    /// Checks everything and makes the train.
    ///
    /// # Errors
    /// Everything that is wrong, not only the first.
    pub fn build(&self) -> Result<Train, Diagnostics> {
        self.build_with(&mut |file| Err(format!("`{file}`: files are not read here")))
    }

    /// Like [`Specification::build`]; `load` gives the text of a table that a signal names, or says why it cannot.
    ///
    /// # Errors
    /// Everything that is wrong, not only the first.
    pub fn build_with(&self, load: &mut dyn FnMut(&str) -> Result<String, String>) -> Result<Train, Diagnostics> {
        let mut diagnostics = Diagnostics::default();
        assemble(self, load, &mut diagnostics).ok_or(diagnostics)
    }
}
