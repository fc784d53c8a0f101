//! Formulas from LaTeX as trees, which the template builds up with typst's functions: no formula is
//! ever written as typst's source.
//!
//! A node is a list: its kind, then its parts.

use std::slice::Iter;

use pulldown_latex::event::{
    Content, EnvironmentFlow, Event, Font, Grouping, ScriptPosition, ScriptType, StateChange, Visual,
};
use pulldown_latex::{Parser, Storage};
use serde_json::{Value, json};

/// The tree of a formula; none where LaTeX is not understood, or is more than a report needs.
pub fn tree(latex: &str) -> Option<Value> {
    let storage = Storage::new();
    let events = Parser::new(latex, &storage).collect::<Result<Vec<_>, _>>().ok()?;
    let mut reader = Reader { events: events.iter() };
    let lines = reader.lines(false)?;
    reader.events.next().is_none().then_some(lines)
}

struct Reader<'r, 'l> {
    events: Iter<'r, Event<'l>>,
}

impl Reader<'_, '_> {
    /// What follows up to the end of a group.
    fn lines(&mut self, mut upright: bool) -> Option<Value> {
        let mut row = vec![json!("row")];
        while let Some(event) = self.events.next() {
            match event {
                Event::End => break,
                Event::StateChange(StateChange::Font(font)) => upright = matches!(font, Some(Font::UpRight)),
                Event::StateChange(StateChange::Style(_)) => {}
                Event::EnvironmentFlow(EnvironmentFlow::Alignment) => row.push(json!(["align"])),
                Event::EnvironmentFlow(EnvironmentFlow::NewLine { .. }) => row.push(json!(["line"])),
                event => row.push(self.element(event, upright)?),
            }
        }
        Some(Value::Array(row))
    }

    fn next(&mut self, upright: bool) -> Option<Value> {
        let event = self.events.next()?;
        self.element(event, upright)
    }

    fn element(&mut self, event: &Event<'_>, upright: bool) -> Option<Value> {
        Some(match event {
            Event::Content(content) => leaf(content, upright)?,
            Event::Begin(Grouping::Normal) => self.lines(upright)?,
            Event::Begin(
                Grouping::Aligned
                | Grouping::Gathered
                | Grouping::Split
                | Grouping::Align { .. }
                | Grouping::Gather { .. }
                | Grouping::Equation { .. },
            ) => self.stack(upright)?,
            Event::Begin(Grouping::LeftRight(open, close)) => {
                let side = |c: &Option<char>| c.map_or(String::new(), String::from);
                json!(["fence", side(open), self.lines(upright)?, side(close)])
            }
            Event::Begin(Grouping::Cases { left: true }) => json!(["cases", self.rows(upright)?]),
            Event::Visual(Visual::Fraction(None)) => json!(["fraction", self.next(upright)?, self.next(upright)?]),
            Event::Visual(Visual::SquareRoot) => json!(["root", self.next(upright)?]),
            Event::Visual(Visual::Root) => json!(["root", self.next(upright)?, self.next(upright)?]),
            Event::Script { ty, position } => {
                let mut base = self.next(upright)?;
                if *position == ScriptPosition::AboveBelow {
                    base = json!(["limits", base]);
                }
                let one = self.next(upright)?;
                match ty {
                    ScriptType::Subscript => json!(["index", base, one, null]),
                    ScriptType::Superscript => json!(["index", base, null, one]),
                    ScriptType::SubSuperscript => json!(["index", base, one, self.next(upright)?]),
                }
            }
            Event::Space { width, .. } => json!(["space", em(width.map(|w| w.to_string()))]),
            _ => return None,
        })
    }

    /// The lines of a group, each for itself.
    fn rows(&mut self, upright: bool) -> Option<Vec<Value>> {
        let Some(Value::Array(all)) = self.lines(upright) else { return None };
        let rows = all[1..].split(|node| *node == json!(["line"]));
        Some(rows.map(|row| Value::Array([&[json!("row")], row].concat())).collect())
    }

    /// Lines below each other. typst aligns over all of a formula, so that only lines aligned at
    /// their beginnings can stand within one, as a block of their own.
    fn stack(&mut self, upright: bool) -> Option<Value> {
        let mut rows = self.rows(upright)?;
        let align = json!(["align"]);
        // A row begins with its own name, and a mark at its beginning aligns nothing.
        let marked = |row: &Value| row.as_array().is_some_and(|r| r.iter().skip(2).any(|node| *node == align));
        if rows.iter().any(marked) {
            // No line is broken before the first row.
            let lines = rows.into_iter().flat_map(|row| [json!(["line"]), row]).skip(1);
            return Some([json!("row")].into_iter().chain(lines).collect());
        }
        for row in rows.iter_mut().filter_map(Value::as_array_mut) {
            row.retain(|node| *node != align);
        }
        Some(json!(["stack", rows]))
    }
}

fn leaf(content: &Content<'_>, upright: bool) -> Option<Value> {
    let symbol = |c: &char| json!(["symbol", c.to_string()]);
    Some(match content {
        Content::Text(text) | Content::Number(text) => json!(["text", text]),
        Content::Function(name) => json!(["function", name]),
        Content::Ordinary { content, .. } if upright => json!(["text", content.to_string()]),
        Content::Ordinary { content, .. } | Content::LargeOp { content, .. } | Content::Punctuation(content) => {
            symbol(content)
        }
        Content::BinaryOp { content: '-', .. } => symbol(&'−'),
        Content::BinaryOp { content, .. } | Content::Delimiter { content, .. } => symbol(content),
        Content::Relation { content, .. } => {
            let mut bytes = [0; 8];
            json!(["symbol", std::str::from_utf8(content.encode_utf8_to_buf(&mut bytes)).ok()?])
        }
    })
}

/// A width in the type's size.
fn em(width: Option<String>) -> f64 {
    let Some(text) = width else { return 0.0 };
    let digits = text.trim_end_matches(char::is_alphabetic);
    let value: f64 = digits.parse().unwrap_or(0.0);
    // Ten points to the em where it was said in points.
    if text.ends_with("em") || text.ends_with("mu") { value } else { value / 10.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_become_trees() {
        let eta = tree(r"\eta = -\frac{1 - i_{0}^{2}}{3}").expect("a formula");
        let i = json!(["index", ["symbol", "i"], ["row", ["text", "0"]], ["row", ["text", "2"]]]);
        let top = json!(["row", ["text", "1"], ["symbol", "−"], i]);
        let fraction = json!(["fraction", top, ["row", ["text", "3"]]]);
        assert_eq!(eta, json!(["row", ["symbol", "η"], ["symbol", "="], ["symbol", "−"], fraction]));
    }

    #[test]
    fn groups_become_rows() {
        let tree = tree(r"\left(\begin{cases} a & b \\ c \end{cases}\right)").expect("a formula");
        let rows = json!([["row", ["symbol", "a"], ["align"], ["symbol", "b"]], ["row", ["symbol", "c"]]]);
        assert_eq!(tree, json!(["row", ["fence", "(", ["row", ["cases", rows]], ")"]]));
        let [a, b] = ["a", "b"].map(|name| json!(["symbol", name]));
        let stack = json!(["row", ["stack", [["row", a], ["row", ["row"], b]]]]);
        assert_eq!(super::tree(r"\begin{aligned}&a \\ &{}b\end{aligned}"), Some(stack));
        let lines = json!(["row", ["row", ["row", a, ["align"], b], ["line"], ["row", b]]]);
        assert_eq!(super::tree(r"\begin{aligned}a&b \\ b\end{aligned}"), Some(lines));
    }

    #[test]
    fn what_is_not_understood_is_none() {
        for latex in [r"\nosuch", "{", r"\frac", "a & b", r"\begin{matrix}a\end{matrix}"] {
            assert_eq!(tree(latex), None, "{latex}");
        }
    }
}
