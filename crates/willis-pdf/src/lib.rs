//! Reports of Willis as PDF, set by typst.
//!
//! All words of a report reach the template as data: none is ever read as typst's markup.

mod maths;
mod world;

use serde_json::{Value, json};
use typst_layout::PagedDocument;
use typst_pdf::PdfOptions;

use crate::contract::Contract;
use crate::document::{Block, Document};
use crate::world::Desk;

// The source itself, not its crate: the physics would have to be built with it.
#[path = "../../willis/src/contract.rs"]
mod contract;
#[path = "../../willis-figure/src/report/document.rs"]
pub mod document;

/// The size of the pages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Paper {
    /// 210 mm × 297 mm.
    A4,
    /// 8.5 in × 11 in.
    UsLetter,
}

impl Paper {
    /// The paper of a name: `a4` or `us-letter`.
    pub fn named(name: &str) -> Option<Self> {
        [Self::A4, Self::UsLetter].into_iter().find(|p| p.name() == name)
    }

    /// As typst names it.
    pub fn name(self) -> &'static str {
        match self {
            Self::A4 => "a4",
            Self::UsLetter => "us-letter",
        }
    }
}

/// Reads a document written as JSON.
///
/// # Errors
/// What is not JSON, not a report, or a report of another format.
pub fn read(json: &str) -> Result<Document, String> {
    let value: Value = serde_json::from_str(json).map_err(|e| format!("not JSON: {e}"))?;
    match value.get("format").and_then(Value::as_str) {
        Some(Document::FORMAT) => {}
        Some(other) => return Err(format!("format {other:?}: this program reads {:?}", Document::FORMAT)),
        None => return Err(format!("no report: the field `format` must be {:?}", Document::FORMAT)),
    }
    serde_json::from_value(value).map_err(|e| format!("not a complete {}: {e}", Document::FORMAT))
}

/// The bytes of a report as tagged PDF. The same document gives the same bytes, on every machine as
/// long as the fonts carried along have all of its letters.
///
/// # Errors
/// Figures that are no SVG.
pub fn pdf(document: &Document, paper: Paper) -> Result<Vec<u8>, String> {
    typst_pdf::pdf(&pages(document, paper)?, &PdfOptions::default()).map_err(|all| world::words(&all))
}

/// The pages of a report.
///
/// # Errors
/// Figures that are no SVG.
pub fn pages(document: &Document, paper: Paper) -> Result<PagedDocument, String> {
    let data = prepared(document)?.to_string();
    typst::compile(&Desk::new(data, paper.name())).output.map_err(|all| world::words(&all))
}

/// A document with what the template cannot work out: formulas as trees, figures in words.
fn prepared(document: &Document) -> Result<Value, String> {
    let mut value = serde_json::to_value(document).map_err(|e| e.to_string())?;
    let mut figures = 0;
    for (s, section) in document.sections.iter().enumerate() {
        for (b, block) in section.blocks.iter().enumerate() {
            let more = &mut value["sections"][s]["blocks"][b];
            match block {
                Block::Formula { latex, .. } => more["maths"] = maths::tree(latex).unwrap_or(Value::Null),
                Block::Figure { svg, .. } => {
                    figures += 1;
                    more["alt"] = json!(alternative(svg).map_err(|e| format!("figure {figures} is no SVG: {e}"))?);
                }
                _ => {}
            }
        }
    }
    Ok(value)
}

/// What a figure shows, in its own words.
fn alternative(svg: &str) -> Result<String, String> {
    let xml = roxmltree::Document::parse(svg).map_err(|e| e.to_string())?;
    let says = |name: &str| xml.root_element().children().find(|n| n.has_tag_name(name) || n.tag_name().name() == name);
    let words: Vec<&str> =
        ["title", "desc"].into_iter().filter_map(says).filter_map(|n| n.text()).map(str::trim).collect();
    Ok(words.join(". "))
}
