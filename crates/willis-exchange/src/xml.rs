//! REXS as XML (`.rexs`).

use roxmltree::{Node, ParsingOptions};
use willis::diagnostic::printable;

use crate::document::{Attribute, Budget, Component, Document, LoadCase, MOST_LISTED, Relation, Value, word};

/// Nodes of a document at most: elements, texts and comments.
const MOST_NODES: usize = 4_000_000;
/// What elements say of themselves, `id="7"`, at most so often in a file.
const MOST_PAIRS: usize = 4_000_000;
/// The same of one element: the reader compares each with each.
const MOST_PAIRS_OF_ONE: usize = 64;
/// Declarations of namespaces: elements inside each other multiply them.
const MOST_NAMESPACES: usize = 64;
/// Sections of unparsed text beside each other: the reader joins them one by one.
const MOST_SECTIONS: usize = 64;

/// Reads the text of a file.
///
/// # Errors
/// Why it is no REXS file at all.
pub fn read(text: &str) -> Result<Document, String> {
    scan(text)?;
    // No document type: entities would be expanded.
    let options = ParsingOptions { nodes_limit: MOST_NODES as u32, ..ParsingOptions::default() };
    let tree = roxmltree::Document::parse_with_options(text, options).map_err(|e| format!("it is no XML: {e}"))?;
    let root = tree.root_element();
    if root.tag_name().name() != "model" {
        let name = printable(&word(root.tag_name().name())).into_owned();
        return Err(format!("its outermost element is `{name}`; in a REXS file it is `model`"));
    }
    let of = |name: &str| word(root.attribute(name).unwrap_or_default());
    let document = Document {
        version: of("version"),
        application: format!("{} {}", of("applicationId"), of("applicationVersion")).trim().to_owned(),
        date: of("date"),
        ..Document::default()
    };
    let mut reader = Reader { document, budget: Budget::default(), text, at: 0, line: 1 };
    for part in elements(root) {
        match part.tag_name().name() {
            "relations" => {
                for node in elements(part) {
                    reader.relation(node)?;
                }
            }
            "components" => {
                for node in elements(part) {
                    let component = reader.component(node)?;
                    reader.document.components.extend(component);
                }
            }
            "load_spectrum" => {
                for node in elements(part).filter(|n| n.tag_name().name() == "load_case") {
                    reader.budget.entry()?;
                    let mut case = LoadCase { id: id(node).unwrap_or_default(), components: vec![] };
                    for node in elements(node) {
                        case.components.extend(reader.component(node)?);
                    }
                    reader.document.cases.push(case);
                }
            }
            other => reader.odd(part, format!("`{}` is no part of a model", printable(&word(other)))),
        }
    }
    Ok(reader.document)
}

/// Refuses what the reader of XML would take more than linear time or memory for, in one pass over the text. What is no
/// XML may pass: the reader stops there.
fn scan(text: &str) -> Result<(), String> {
    let many = |byte: u8| text.bytes().filter(|b| *b == byte).count();
    if many(b'<') > MOST_NODES || many(b'=') > MOST_PAIRS {
        return Err(format!("it has more than {MOST_NODES} elements, or more than {MOST_PAIRS} values in them"));
    }
    let line = |at: usize| 1 + text[..at].bytes().filter(|b| *b == b'\n').count();
    let (mut at, mut namespaces, mut sections) = (0, 0, 0);
    while let Some(start) = text[at..].find('<').map(|k| at + k) {
        let rest = &text[start..];
        let end = if let Some(inner) = rest.strip_prefix("<!--") {
            inner.find("-->").map(|k| k + 7)
        } else if let Some(inner) = rest.strip_prefix("<![CDATA[") {
            sections += 1;
            if sections > MOST_SECTIONS {
                return Err(format!(
                    "line {}: one text has more than {MOST_SECTIONS} sections `<![CDATA[`; write it as one",
                    line(start)
                ));
            }
            inner.find("]]>").map(|k| k + 12)
        } else if rest.strip_prefix("<?xml").is_some_and(|rest| rest.starts_with([' ', '\t', '\n', '\r'])) {
            // Its values may hold the end of other instructions.
            outside_quotes(rest, "?>", &mut |_, _| Ok(()))?
        } else if let Some(inner) = rest.strip_prefix("<?") {
            inner.find("?>").map(|k| k + 4)
        } else if rest.starts_with("</") || rest.starts_with("<!") {
            sections = 0;
            Some(2)
        } else {
            sections = 0;
            let mut pairs = 0;
            outside_quotes(rest, ">", &mut |name, k| {
                pairs += 1;
                namespaces += usize::from(name.contains("xmlns"));
                if namespaces > MOST_NAMESPACES {
                    return Err(format!(
                        "line {}: it declares more than {MOST_NAMESPACES} namespaces (`xmlns`); REXS needs none: remove \
                         them",
                        line(start + k)
                    ));
                }
                if pairs > MOST_PAIRS_OF_ONE {
                    return Err(format!(
                        "line {}: an element has more than {MOST_PAIRS_OF_ONE} XML attributes; those of REXS have four \
                         at most: write each quantity as an element `attribute`",
                        line(start + k)
                    ));
                }
                Ok(())
            })?
        };
        let Some(end) = end else { break };
        at = start + end;
    }
    Ok(())
}

/// Where a mark that is in no quotes ends. Told is each quoted value: what stands before it, and where it begins.
fn outside_quotes(
    text: &str,
    mark: &str,
    told: &mut dyn FnMut(&str, usize) -> Result<(), String>,
) -> Result<Option<usize>, String> {
    let mut at = 0;
    loop {
        let is_met = |k: &usize| matches!(text.as_bytes()[*k], b'"' | b'\'') || text[*k..].starts_with(mark);
        let Some(k) = text[at..].char_indices().map(|(k, _)| at + k).find(is_met) else { return Ok(None) };
        if text[k..].starts_with(mark) {
            return Ok(Some(k + mark.len()));
        }
        told(&text[at..k], k)?;
        let quote = char::from(text.as_bytes()[k]);
        let Some(length) = text[k + 1..].find(quote) else { return Ok(None) };
        at = k + length + 2;
    }
}

fn elements<'a, 'd>(node: Node<'a, 'd>) -> impl Iterator<Item = Node<'a, 'd>> {
    node.children().filter(Node::is_element)
}

fn id(node: Node<'_, '_>) -> Option<i64> {
    node.attribute("id").and_then(|id| id.trim().parse().ok())
}

struct Reader<'t> {
    document: Document,
    budget: Budget,
    text: &'t str,
    /// How far lines are counted, and which line is there.
    at: usize,
    line: usize,
}

impl Reader<'_> {
    /// Tells what is odd about a node. Nodes come in the order of the file: its lines are counted once.
    fn odd(&mut self, node: Node<'_, '_>, message: impl Into<String>) {
        let to = node.range().start.max(self.at);
        self.line += self.text.as_bytes()[self.at..to].iter().filter(|b| **b == b'\n').count();
        self.at = to;
        self.document.odd(format!("line {}", self.line), message);
    }

    fn relation(&mut self, node: Node<'_, '_>) -> Result<(), String> {
        self.budget.entry()?;
        let kind = word(node.attribute("type").unwrap_or_default());
        let mut relation = Relation { id: id(node).unwrap_or_default(), kind, refs: vec![] };
        for part in elements(node).filter(|n| n.tag_name().name() == "ref") {
            self.budget.attribute()?;
            match id(part) {
                Some(id) => relation.refs.push((word(part.attribute("role").unwrap_or_default()), id)),
                None => self.odd(part, "a reference has no number of a component (`id`)"),
            }
        }
        self.document.relations.push(relation);
        Ok(())
    }

    fn component(&mut self, node: Node<'_, '_>) -> Result<Option<Component>, String> {
        self.budget.entry()?;
        let Some(id) = id(node) else {
            self.odd(node, "a component has no number (`id`) and is left out");
            return Ok(None);
        };
        let of = |node: Node<'_, '_>, name: &str| word(node.attribute(name).unwrap_or_default());
        let mut component = Component { id, kind: of(node, "type"), name: of(node, "name"), attributes: vec![] };
        for part in elements(node).filter(|n| n.tag_name().name() == "attribute") {
            self.budget.attribute()?;
            component.attributes.push(Attribute { id: of(part, "id"), unit: of(part, "unit"), value: value(part) });
        }
        Ok(Some(component))
    }
}

fn value(node: Node<'_, '_>) -> Value {
    let Some(inner) = elements(node).next() else { return Value::of_text(node.text().unwrap_or_default()) };
    match inner.tag_name().name() {
        "array" if inner.attribute("code").is_none() => {
            let all = elements(inner).take(MOST_LISTED + 1);
            let texts: Vec<&str> = all.map(|c| c.text().unwrap_or_default()).collect();
            Value::of_texts(&texts)
        }
        "array" => Value::Other("a coded array"),
        _ => Value::Other("a matrix"),
    }
}
