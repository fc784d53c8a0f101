//! Reports and figures of Willis as PDF, set by typst.
//!
//! All words of a report reach the template as data: none is ever read as typst's markup.

mod maths;
mod measure;
mod pictures;
mod world;

use serde_json::{Value, json};
use typst_layout::PagedDocument;
use typst_pdf::PdfOptions;

use crate::contract::Contract;
pub use crate::measure::Measured;

use crate::document::{Block, Document, Plate};
use crate::paper::{FigureSize, MM, Place};
use crate::pictures::Picture;
use crate::world::{Desk, Template};

// The source itself, not its crate: the physics would have to be built with it.
#[path = "../../willis/src/contract.rs"]
mod contract;
#[path = "../../willis-figure/src/report/document.rs"]
pub mod document;
#[path = "../../willis-figure/src/report/paper.rs"]
mod paper;

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

    /// Width and height in points.
    pub fn size(self) -> [f64; 2] {
        match self {
            Self::A4 => [210.0, 297.0].map(|mm| mm * MM),
            Self::UsLetter => [8.5, 11.0].map(|inch| inch * 72.0),
        }
    }
}

/// What this program sets.
#[derive(Clone, Debug, PartialEq)]
pub enum Work {
    /// A report, on as many pages as it takes.
    Report(Box<Document>),
    /// A figure alone, on a page of its own size.
    Plate(Plate),
}

/// Reads a report or a figure written as JSON.
///
/// # Errors
/// What is not JSON, neither report nor figure, or one of another format.
pub fn read(json: &str) -> Result<Work, String> {
    let value: Value = serde_json::from_str(json).map_err(|e| format!("not JSON: {e}"))?;
    let incomplete = |format: &'static str| move |e: serde_json::Error| format!("not a complete {format}: {e}");
    match value.get("format").and_then(Value::as_str) {
        Some(Document::FORMAT) => serde_json::from_value(value).map(Work::Report).map_err(incomplete(Document::FORMAT)),
        Some(Plate::FORMAT) => serde_json::from_value(value).map(Work::Plate).map_err(incomplete(Plate::FORMAT)),
        Some(other) => {
            Err(format!("format {other:?}: this program reads {:?} and {:?}", Document::FORMAT, Plate::FORMAT))
        }
        None => Err(format!("no report: the field `format` must be {:?} or {:?}", Document::FORMAT, Plate::FORMAT)),
    }
}

/// The bytes of a report or a figure as tagged PDF. The same JSON gives the same bytes, on every machine as long as the fonts
/// carried along have all of its letters.
///
/// # Errors
/// Figures that are no SVG.
pub fn pdf(work: &Work, paper: Paper) -> Result<Vec<u8>, String> {
    typst_pdf::pdf(&pages(work, paper)?, &PdfOptions::default()).map_err(|all| world::words(&all))
}

/// The pages of a report or a figure.
///
/// # Errors
/// Figures that are no SVG.
pub fn pages(work: &Work, paper: Paper) -> Result<PagedDocument, String> {
    let desk = match work {
        Work::Report(document) => Desk::new(Template::Report, prepared(document, paper)?.to_string(), paper.name()),
        Work::Plate(plate) => Desk::new(Template::Plate, alone(plate)?.to_string(), paper.name()),
    };
    typst::compile(&desk).output.map_err(|all| world::words(&all))
}

/// A document with what the template cannot work out: formulas as trees; of figures the words, the size and the page.
fn prepared(document: &Document, paper: Paper) -> Result<Value, String> {
    let mut value = serde_json::to_value(document).map_err(|e| e.to_string())?;
    let mut figures = 0;
    // By size of the page.
    let mut plates: Vec<([f64; 2], Vec<Value>)> = vec![];
    for (s, section) in document.sections.iter().enumerate() {
        for (b, block) in section.blocks.iter().enumerate() {
            let more = &mut value["sections"][s]["blocks"][b];
            match block {
                Block::Formula { latex, .. } => more["maths"] = maths::tree(latex).unwrap_or(Value::Null),
                Block::Terms { items, .. } => {
                    for (k, item) in items.iter().enumerate() {
                        more["items"][k]["maths"] = maths::tree(&item.latex).unwrap_or(Value::Null);
                    }
                }
                Block::Figure { svg, .. } => {
                    figures += 1;
                    let picture = Picture::of(svg).map_err(|e| format!("figure {figures} is no SVG: {e}"))?;
                    more["alt"] = json!(picture.alternative);
                    match picture.extent.place(paper.size()) {
                        Place::Text(wide) => (more["plate"], more["width"]) = (Value::Null, json!(wide)),
                        Place::Page(page, wide) => {
                            more["plate"] = json!(format!("plate-{figures}"));
                            more["width"] = json!(wide);
                            let own = more.clone();
                            more["svg"] = Value::Null;
                            match plates.iter_mut().find(|p| p.0 == page) {
                                Some(same) => same.1.push(own),
                                None => plates.push((page, vec![own])),
                            }
                        }
                    }
                }
                _ => {}
            }
        }
    }
    let group = |(k, ([width, height], figures)): (usize, ([f64; 2], Vec<Value>))| json!({ "first": k == 0, "width": width, "height": height, "figures": figures });
    value["plates"] = plates.into_iter().enumerate().map(group).collect();
    Ok(value)
}

/// A figure with the size of its page.
fn alone(plate: &Plate) -> Result<Value, String> {
    /// Points to a unit of a figure: a pixel.
    const PIXEL: f64 = 0.75;
    let picture = Picture::of(&plate.svg).map_err(|e| format!("the figure is no SVG: {e}"))?;
    let paper = plate.width_mm.filter(|w| w.is_finite() && *w > 0.0).map(|w| w * MM);
    let FigureSize { size, .. } = picture.extent;
    let least = picture.extent.least();
    let natural = PIXEL.max(least);
    // On paper that is too narrow the page grows, and text keeps its size.
    let factor = paper.map_or(natural, |w| (w / size[0]).clamp(least, natural));
    let [width, height] = size.map(|x| x * factor);
    let page = [paper.unwrap_or(width).max(width), height];
    let title = picture.alternative.split(". ").next().unwrap_or_default();
    Ok(json!({ "title": title, "alt": picture.alternative, "svg": plate.svg, "width": width, "page": page }))
}
