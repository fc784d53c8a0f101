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
    let (mut from, mut line, mut column) = (0, 1, 1);
    let found: Vec<(usize, usize)> = (wanted.iter())
        .map(|&at| {
            // A byte inside a character belongs to that character.
            let at = text.floor_char_boundary(at);
            let part = &text[from..at];
            from = at;
            match part.rsplit_once('\n') {
                Some((before, last)) => {
                    line += 1 + before.bytes().filter(|b| *b == b'\n').count();
                    column = 1 + last.chars().count();
                }
                None => column += part.chars().count(),
            }
            (line, column)
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

    /// All at once as each alone by its characters, in lines long and short.
    #[test]
    fn many_spans_of_a_text_stand_where_each_does() {
        for text in ["ab\n\ncµd\n𝛼\n\n\nxyz", "one long line of äöü µ and no end", "\n", "\r\n\r\nz\n"] {
            let all = (0..=text.len()).flat_map(|a| (a..=text.len()).map(move |b| a..b));
            let mut spans: Vec<Span> = all.map(Span::from).collect();
            count_lines(spans.iter_mut(), text);
            let place = |at: usize| {
                let before: Vec<char> =
                    text.char_indices().filter(|(k, c)| k + c.len_utf8() <= at).map(|x| x.1).collect();
                let line = 1 + before.iter().filter(|c| **c == '\n').count();
                [line, 1 + before.iter().rev().take_while(|c| **c != '\n').count()]
            };
            for span in spans {
                let l = span.lines.unwrap();
                let found = [[l.line, l.column], [l.end_line, l.end_column]];
                assert_eq!(found, [span.start, span.end].map(place), "{text:?} {}..{}", span.start, span.end);
            }
        }
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
