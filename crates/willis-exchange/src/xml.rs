//! REXS as XML (`.rexs`).

use roxmltree::{Node, ParsingOptions};
use willis::diagnostic::printable;

use crate::document::{Attribute, Budget, Component, Document, LoadCase, Relation, Value};

/// Nodes of a document at most: elements, texts and comments.
const MOST_NODES: u32 = 4_000_000;

/// Reads the text of a file.
///
/// # Errors
/// Why it is no REXS file at all.
pub fn read(text: &str) -> Result<Document, String> {
    // No document type: entities would be expanded.
    let options = ParsingOptions { nodes_limit: MOST_NODES, ..ParsingOptions::default() };
    let tree = roxmltree::Document::parse_with_options(text, options).map_err(|e| format!("it is no XML: {e}"))?;
    let root = tree.root_element();
    if root.tag_name().name() != "model" {
        let name = printable(root.tag_name().name()).into_owned();
        return Err(format!("its outermost element is `{name}`; in a REXS file it is `model`"));
    }
    let mut budget = Budget::default();
    let of = |name: &str| root.attribute(name).unwrap_or_default().to_owned();
    let mut document = Document {
        version: of("version"),
        application: format!("{} {}", of("applicationId"), of("applicationVersion")).trim().to_owned(),
        date: of("date"),
        ..Document::default()
    };
    for part in elements(root) {
        match part.tag_name().name() {
            "relations" => {
                for node in elements(part) {
                    budget.entry()?;
                    relation(node, &mut document);
                }
            }
            "components" => {
                for node in elements(part) {
                    budget.entry()?;
                    let component = component(node, &mut budget, &mut document)?;
                    document.components.extend(component);
                }
            }
            "load_spectrum" => {
                for node in elements(part).filter(|n| n.tag_name().name() == "load_case") {
                    budget.entry()?;
                    let mut case = LoadCase { id: id(node).unwrap_or_default(), components: vec![] };
                    for node in elements(node) {
                        budget.entry()?;
                        case.components.extend(component(node, &mut budget, &mut document)?);
                    }
                    document.cases.push(case);
                }
            }
            other => {
                let place = line(part);
                document.odd(place, format!("`{}` is no part of a model", printable(other)));
            }
        }
    }
    Ok(document)
}

fn elements<'a, 'd>(node: Node<'a, 'd>) -> impl Iterator<Item = Node<'a, 'd>> {
    node.children().filter(Node::is_element)
}

fn id(node: Node<'_, '_>) -> Option<i64> {
    node.attribute("id").and_then(|id| id.trim().parse().ok())
}

/// Where it stands. Lines are counted only for what is told.
fn line(node: Node<'_, '_>) -> String {
    format!("line {}", node.document().text_pos_at(node.range().start).row)
}

fn relation(node: Node<'_, '_>, document: &mut Document) {
    let kind = node.attribute("type").unwrap_or_default().to_owned();
    let mut relation = Relation { id: id(node).unwrap_or_default(), kind, refs: vec![] };
    for part in elements(node).filter(|n| n.tag_name().name() == "ref") {
        match id(part) {
            Some(id) => relation.refs.push((part.attribute("role").unwrap_or_default().to_owned(), id)),
            None => document.odd(line(part), "a reference has no number of a component (`id`)"),
        }
    }
    document.relations.push(relation);
}

fn component(node: Node<'_, '_>, budget: &mut Budget, document: &mut Document) -> Result<Option<Component>, String> {
    let Some(id) = id(node) else {
        document.odd(line(node), "a component has no number (`id`) and is left out");
        return Ok(None);
    };
    let of = |name: &str| node.attribute(name).unwrap_or_default().to_owned();
    let mut component = Component { id, kind: of("type"), name: of("name"), attributes: vec![] };
    for part in elements(node).filter(|n| n.tag_name().name() == "attribute") {
        budget.attribute()?;
        component.attributes.push(Attribute {
            id: part.attribute("id").unwrap_or_default().to_owned(),
            unit: part.attribute("unit").unwrap_or_default().to_owned(),
            value: value(part),
        });
    }
    Ok(Some(component))
}

fn value(node: Node<'_, '_>) -> Value {
    let Some(inner) = elements(node).next() else { return Value::of_text(node.text().unwrap_or_default()) };
    match inner.tag_name().name() {
        "array" if inner.attribute("code").is_none() => {
            let texts: Vec<&str> = elements(inner).map(|c| c.text().unwrap_or_default()).collect();
            Value::of_texts(&texts)
        }
        "array" => Value::Other("a coded array"),
        _ => Value::Other("a matrix"),
    }
}
