//! Formulas as MathML.

use std::slice::Iter;

use pulldown_latex::config::{DisplayMode, RenderConfig};
use pulldown_latex::event::{Content, EnvironmentFlow, Event, Grouping, ScriptType, Visual};
use pulldown_latex::{Parser, Storage, push_mathml};

use crate::parts::style::wide;

/// Where a formula stands.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Display {
    /// On a line of its own.
    Line,
    /// Among words.
    Text,
}

/// A formula, and how wide it is in its own type sizes; none where LaTeX is not understood.
pub(crate) fn mathml(latex: &str, display: Display) -> Option<(String, f64)> {
    let storage = Storage::new();
    // Whole first: the writer would put the words of an error into the formula.
    let events = Parser::new(latex, &storage).collect::<Result<Vec<_>, _>>().ok()?;
    // The names of functions are written as they are.
    let markup = |e: &Event<'_>| matches!(e, Event::Content(Content::Function(name)) if name.contains(['<', '&', '>']));
    if events.iter().any(markup) {
        return None;
    }
    let width = row(&mut events.iter(), 1.0);
    let display_mode = if display == Display::Line { DisplayMode::Block } else { DisplayMode::Inline };
    let config = RenderConfig { display_mode, xml: true, ..RenderConfig::default() };
    let mut out = String::new();
    push_mathml(&mut out, events.into_iter().map(Ok::<_, std::fmt::Error>), config).ok()?;
    Some((escaped(&out), width))
}

/// The writer escapes words, but no single signs: what begins no tag and no reference is one.
fn escaped(markup: &str) -> String {
    let mut out = String::with_capacity(markup.len());
    let mut rest = markup;
    while let Some(at) = rest.find(['<', '&']) {
        out.push_str(&rest[..at]);
        let (sign, behind) = rest[at..].split_at(1);
        let word = |words: &[&str]| words.iter().any(|w| behind.starts_with(w));
        if sign == "<" && !behind.starts_with(|c: char| c == '/' || c.is_ascii_alphabetic()) {
            out.push_str("&lt;");
        } else if sign == "&" && word(&["nbsp;"]) {
            // The one name that only HTML knows.
            out.push_str("&#160;");
            rest = &behind["nbsp;".len()..];
            continue;
        } else if sign == "&" && !word(&["amp;", "lt;", "gt;"]) {
            out.push_str("&amp;");
        } else {
            out.push_str(sign);
        }
        rest = behind;
    }
    out + rest
}

/// About the width of what follows up to the end of a group; of several lines the widest.
fn row(events: &mut Iter<'_, Event<'_>>, size: f64) -> f64 {
    let (mut widest, mut line) = (0.0_f64, 0.0);
    while let Some(event) = events.next() {
        match event {
            Event::End => break,
            Event::EnvironmentFlow(EnvironmentFlow::NewLine { .. }) => {
                widest = widest.max(line);
                line = 0.0;
            }
            event => line += element(event, events, size),
        }
    }
    widest.max(line)
}

fn next(events: &mut Iter<'_, Event<'_>>, size: f64) -> f64 {
    events.next().map_or(0.0, |event| element(event, events, size))
}

fn element(event: &Event<'_>, events: &mut Iter<'_, Event<'_>>, size: f64) -> f64 {
    /// How much smaller indices are.
    const SMALL: f64 = 0.71;
    match event {
        Event::Content(content) => {
            size * match content {
                Content::Text(text) | Content::Function(text) | Content::Number(text) => wide(text, 0.9),
                Content::Ordinary { content, .. } => wide(content.encode_utf8(&mut [0; 4]), 0.95),
                Content::LargeOp { .. } | Content::BinaryOp { .. } => 1.2,
                Content::Relation { .. } => 1.4,
                Content::Delimiter { .. } | Content::Punctuation(_) => 0.5,
            }
        }
        Event::Begin(Grouping::LeftRight(..) | Grouping::Cases { .. }) => size + row(events, size),
        Event::Begin(_) => row(events, size),
        Event::Visual(Visual::SquareRoot | Visual::Root) => size + next(events, size),
        Event::Visual(Visual::Fraction(_)) => next(events, size).max(next(events, size)) + 0.3 * size,
        Event::Script { ty, .. } => {
            let base = next(events, size);
            let index = next(events, SMALL * size);
            let other = if *ty == ScriptType::SubSuperscript { next(events, SMALL * size) } else { 0.0 };
            base + index.max(other) + 0.1 * size
        }
        Event::Space { .. } => size,
        Event::Visual(Visual::Negation) | Event::StateChange(_) | Event::EnvironmentFlow(_) | Event::End => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn widths_are_those_of_the_widest_line() {
        let width = |latex| mathml(latex, Display::Line).expect("a formula").1;
        assert!((width(r"\frac{a + b}{c}") - width("a + b")).abs() < 0.5);
        assert_eq!(width(r"\begin{aligned}&a + b + c \\ &d\end{aligned}"), width("a + b + c"));
        assert!(width("x^{2}") < width("x 2"));
        assert!((5.0..15.0).contains(&width(r"\eta = \left(1 - i_{0} \eta_{0}\right)")));
    }

    #[test]
    fn signs_of_markup_are_escaped() {
        let text = |latex| mathml(latex, Display::Text).expect("a formula").0;
        assert!(text("a < b").contains("<mo>&lt;</mo>"));
        assert!(text(r"a \not< b").contains("&lt;"));
        assert!(text(r"\mathrm{<b\&lt;}").contains(">&amp;</mi>"));
        assert!(text(r"\text{ <b>&nbsp; }").contains(">&#160;&lt;b&gt;&amp;nbsp;&#160;<"));
    }

    #[test]
    fn what_is_no_formula_is_none() {
        for latex in [r"\nosuch", r"\operatorname{<b>}", "{", r"\frac", r"a & b", r"\left( a", "x^"] {
            assert_eq!(mathml(latex, Display::Line), None, "{latex}");
        }
    }
}
