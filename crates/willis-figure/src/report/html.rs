//! A report as one web page that needs nothing else: no network, no scripts.
//!
//! Its markup is also well-formed XML, so that any tool reads it.

use std::collections::BTreeSet;
use std::fmt::Write;

use minijinja::{Environment, Value, context};

use crate::Drawing;
use crate::parts::markup::{attribute, prefixed};
use crate::parts::style::{self, FAINT, INK, LINE, PAPER, wide};
use crate::parts::theme::{colours, dark, rules};
use crate::report::document::{Block, Column, Document, Level, Section, Term};
use crate::report::formula::{Display, mathml};
use crate::report::paper::{self, FigureSize, MM, Place};

/// Colours of the page by the names that its style sheet uses.
const PAGE: [(&str, &str); 10] = [
    ("ink", INK),
    ("faint", FAINT),
    ("line", LINE),
    ("rule", "#dedede"),
    ("well", "#f5f5f5"),
    ("paper", PAPER),
    ("good", "#117733"),
    ("note", "#0072b2"),
    ("warning", "#a34700"),
    ("stop", "#aa1122"),
];

/// What a page has room for whether it is A4 or US Letter, in points.
const PAPER_SIZE: [f64; 2] = [210.0 * MM, 279.4 * MM];
/// A page between its margins, in points.
const PRINTED: f64 = 174.0 * MM;

/// A report as a web page in one file: light or dark as the screen is set, light in print.
///
/// Figures are taken over as they are: a document must come from Willis. All other words are
/// escaped.
///
/// # Example
/// ```
/// use willis_figure::report::document::{Block, Document, Section};
///
/// let page = willis_figure::html(&Document {
///     format: Default::default(),
///     title: "P1 <ring & sun>".into(),
///     subtitle: "Engineering report".into(),
///     title_block: Default::default(),
///     facts: vec![],
///     sections: vec![Section {
///         title: "Efficiency".into(),
///         blocks: vec![Block::Formula { latex: r"\eta = \frac{1 - i_{0} \eta_{0}}{1 - i_{0}}".into(), note: "".into() }],
///     }],
/// });
/// assert!(page.contains("<h1>P1 &lt;ring &amp; sun&gt;</h1>"));
/// assert!(page.contains("<mfrac>"));
/// ```
pub fn html(document: &Document) -> String {
    let mut environment = Environment::new();
    environment.add_template("report.html", include_str!("html/report.html")).expect("the template is well-formed");
    let mut page = Page::default();
    let sections: Value = document.sections.iter().enumerate().map(|(k, s)| page.section(k + 1, s)).collect();
    let facts: Value = document.facts.iter().map(|[word, value]| context! { word, value }).collect();
    let told: Value = document.title_block.entries().map(|[word, value]| context! { word, value }).collect();
    let template = environment.get_template("report.html").expect("just added");
    template
        .render(context! {
            title => &document.title,
            subtitle => &document.subtitle,
            author => &document.title_block.author,
            told,
            contents => document.sections.len() > 2,
            style => Value::from_safe_string(page.style()),
            facts,
            sections,
        })
        .expect("the template uses only what it is given")
}

/// What is counted over the sections.
#[derive(Default)]
struct Page {
    figures: usize,
    tables: usize,
    /// Pages of their own that figures take, in mm.
    pages: Vec<[u32; 2]>,
    /// Attribute and colour of all marks in figures.
    colours: BTreeSet<(String, String)>,
}

impl Page {
    fn section(&mut self, number: usize, section: &Section) -> Value {
        let blocks: Value = section.blocks.iter().map(|b| self.block(b)).collect();
        context! { number, id => format!("section-{number}"), title => &section.title, blocks }
    }

    fn block(&mut self, block: &Block) -> Value {
        match block {
            Block::Heading { text } => context! { kind => "heading", text },
            Block::Text { text } => context! { kind => "text", text },
            Block::List { items } => context! { kind => "list", items },
            Block::Notice { level, text } => {
                let (level, sign, word) = match level {
                    Level::Good => ("good", "✓", "Only solution"),
                    Level::Note => ("note", "i", "Note"),
                    Level::Warning => ("warning", "!", "Warning"),
                    Level::Stop => ("stop", "×", "Stop"),
                };
                context! { kind => "notice", level, sign, word, text }
            }
            Block::Table { caption, columns, rows } => {
                self.tables += 1;
                let (id, name) = (format!("table-{}", self.tables), format!("Table {}", self.tables));
                let fit = print_size(columns, rows);
                let (tight, fit) = (fit < paper::SMALLEST, style::number(fit));
                let cells = |row: &Vec<String>| -> Value {
                    row.iter().zip(columns).map(|(text, c)| context! { text, number => c.number }).collect()
                };
                let rows: Value = rows.iter().map(cells).collect();
                let columns: Value = columns.iter().map(|c| context! { head => &c.head, number => c.number }).collect();
                context! { kind => "table", id, name, caption, fit, tight, columns, rows }
            }
            Block::Figure { caption, svg } => {
                self.figures += 1;
                let (id, name) = (format!("figure-{}", self.figures), format!("Figure {}", self.figures));
                // Without what only a file of its own begins with.
                let svg = &svg[svg.find("<svg").unwrap_or(0)..];
                self.colours.append(&mut colours(svg));
                let (wide, page) = self.printed(svg);
                let svg = Value::from_safe_string(prefixed(svg, &format!("{id}-")));
                context! { kind => "figure", id, name, caption, svg, wide, page }
            }
            Block::Formula { latex, note } => {
                let Some((mathml, width)) = mathml(latex, Display::Line) else {
                    return context! { kind => "formula", latex, note };
                };
                let fit = style::number(PRINTED / width.max(1.0));
                context! { kind => "formula", mathml => Value::from_safe_string(mathml), fit, note }
            }
            Block::Terms { head, items } => {
                let item = |t: &Term| {
                    let mathml = mathml(&t.latex, Display::Text).map(|(mathml, _)| Value::from_safe_string(mathml));
                    context! { mathml, latex => &t.latex, text => &t.text }
                };
                context! { kind => "terms", head, items => items.iter().map(item).collect::<Value>() }
            }
            Block::Code { text } => context! { kind => "code", text },
        }
    }

    /// How wide a figure is printed, in points, and the class of the page where it takes one of its own.
    fn printed(&mut self, svg: &str) -> (String, Option<String>) {
        match place(svg) {
            None => (style::number(PRINTED), None),
            Some(Place::Text(wide)) => (style::number(wide), None),
            Some(Place::Page(page, wide)) => {
                let page = page.map(|x| (x / MM).ceil() as u32);
                let known = self.pages.iter().position(|p| *p == page);
                let k = known.unwrap_or_else(|| {
                    self.pages.push(page);
                    self.pages.len() - 1
                });
                (style::number(wide), Some(format!("plate-{}", k + 1)))
            }
        }
    }

    /// The style sheet with the colours of the page and of its figures.
    fn style(&self) -> String {
        let variables = |shown: &dyn Fn(&str) -> String| {
            PAGE.iter().fold(String::new(), |mut all, (name, colour)| {
                let _ = write!(all, " --{name}: {};", shown(colour));
                all
            })
        };
        let pages = self.pages.iter().enumerate().fold(String::new(), |mut all, (k, [width, height])| {
            let name = format!("plate-{}", k + 1);
            let _ = writeln!(all, "@page {name} {{ size: {width}mm {height}mm; margin: 16mm 9mm 15mm; }}");
            let _ = writeln!(all, ".{name} {{ page: {name}; }}");
            all
        });
        format!(
            ":root {{ color-scheme: light dark;{} }}\n{}{pages}@media screen and (prefers-color-scheme: dark) {{\n\
             :root {{{} }}\n{}}}\n",
            variables(&str::to_owned),
            include_str!("html/report.css"),
            variables(&dark),
            rules(&self.colours, ".picture "),
        )
    }
}

/// Whether a figure is small enough for the text of a page.
pub(super) fn fits_text(svg: &str) -> bool {
    !matches!(place(svg), Some(Place::Page(..)))
}

/// Where a figure goes on paper; nothing is known of one without a size.
fn place(svg: &str) -> Option<Place> {
    let number = |name: &str| attribute(svg, name)?.parse::<f64>().ok().filter(|x| *x > 0.0);
    let extent = FigureSize { size: [number("width")?, number("height")?], smallest: Some(Drawing::SMALLEST_TEXT) };
    Some(extent.place(PAPER_SIZE))
}

/// The size in points at which a table fits the width of a printed page.
fn print_size(columns: &[Column], rows: &[Vec<String>]) -> f64 {
    let text = |text: &str, breaks: bool| match breaks {
        // Words may break over lines, but not into slivers.
        true => text.split_whitespace().map(|w| wide(w, 1.0)).fold(wide(text, 1.0).min(16.0), f64::max),
        false => wide(text, 1.0),
    };
    let column = |(k, c): (usize, &Column)| {
        let cells = rows.iter().filter_map(|r| r.get(k)).map(|cell| text(cell, !c.number));
        cells.fold(c.head.split_whitespace().map(|w| wide(w, 1.0)).fold(0.0, f64::max), f64::max) + 1.4
    };
    PRINTED / columns.iter().enumerate().map(column).sum::<f64>().max(1.0)
}
