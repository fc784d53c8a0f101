//! Where a diagnostic stands in a text.

use std::ops::Range;

use serde::{Deserialize, Serialize};

/// A part of a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Span {
    /// The first byte, counted from 0.
    pub start: usize,
    /// The byte after the last.
    pub end: usize,
    /// The same for people; absent until the text is at hand ([`Diagnostics::stand_in`](super::Diagnostics::stand_in)).
    #[serde(flatten)]
    pub lines: Option<Lines>,
}

/// Lines and columns of a part of a text, counted from 1 as editors show them. A column is a character of Unicode.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Lines {
    /// The line of the first character.
    pub line: usize,
    /// The column of the first character.
    pub column: usize,
    /// The line of the character after the last.
    pub end_line: usize,
    /// The column of the character after the last.
    pub end_column: usize,
}

impl Span {
    /// The bytes.
    pub fn range(self) -> Range<usize> {
        self.start..self.end
    }
}

impl From<Range<usize>> for Span {
    fn from(bytes: Range<usize>) -> Self {
        Self { start: bytes.start, end: bytes.end, lines: None }
    }
}

/// Counts the lines of those spans that lack them, in one walk through the text: there may be thousands.
pub(super) fn count_lines<'a>(spans: impl Iterator<Item = &'a mut Span>, text: &str) {
    let mut spans: Vec<&mut Span> = spans.filter(|s| s.lines.is_none() && s.end <= text.len()).collect();
    let mut wanted: Vec<usize> = spans.iter().flat_map(|s| [s.start, s.end]).collect();
    wanted.sort_unstable();
    wanted.dedup();
    let (mut from, mut line, mut start) = (0, 1, 0);
    let found: Vec<(usize, usize)> = (wanted.iter())
        .map(|&at| {
            let part = &text.as_bytes()[from..at];
            line += part.iter().filter(|b| **b == b'\n').count();
            start = part.iter().rposition(|b| *b == b'\n').map_or(start, |k| from + k + 1);
            from = at;
            // A byte inside a character belongs to that character.
            (line, text[start..text.floor_char_boundary(at)].chars().count() + 1)
        })
        .collect();
    let place = |at: usize| found[wanted.binary_search(&at).expect("one of them")];
    for span in &mut spans {
        let ((line, column), (end_line, end_column)) = (place(span.start), place(span.end));
        span.lines = Some(Lines { line, column, end_line, end_column });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(text: &str, range: Range<usize>) -> [usize; 4] {
        let mut span = Span::from(range);
        count_lines([&mut span].into_iter(), text);
        let l = span.lines.unwrap();
        [l.line, l.column, l.end_line, l.end_column]
    }

    #[test]
    fn lines_and_columns_are_those_of_an_editor() {
        let text = "a = 1\nµ = \"ä\"\n";
        assert_eq!(lines(text, 0..1), [1, 1, 1, 2]);
        assert_eq!(lines(text, 6..8), [2, 1, 2, 2]);
        assert_eq!(lines(text, 11..15), [2, 5, 2, 8]);
        assert_eq!(lines(text, text.len()..text.len()), [3, 1, 3, 1]);
        assert_eq!(lines(text, 4..12), [1, 5, 2, 6]);
        assert_eq!(lines("", 0..0), [1, 1, 1, 1]);
    }

    #[test]
    fn a_span_without_its_text_has_no_lines() {
        let mut span = Span::from(3..9);
        count_lines([&mut span].into_iter(), "short");
        assert_eq!(span.lines, None);
        let json = serde_json::to_string(&span).unwrap();
        assert_eq!(json, r#"{"start":3,"end":9}"#);
        assert_eq!(serde_json::from_str::<Span>(&json).unwrap(), span);
    }
}
