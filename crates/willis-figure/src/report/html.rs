//! A report as one web page that needs nothing else: no network, no scripts.
//!
//! Its markup is also well-formed XML, so that any tool reads it.

use std::collections::BTreeSet;
use std::fmt::Write;

use minijinja::{Environment, Value, context};

use crate::parts::markup::prefixed;
use crate::parts::style::{self, FAINT, INK, LINE, PAPER, wide};
use crate::parts::theme::{colours, dark, rules};
use crate::report::document::{Block, Column, Document, Level, Section};
use crate::report::formula::mathml;

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

/// A4 between its margins, in points.
const PRINTED: f64 = 490.0;
/// Tables with smaller type than this, in points, break their words.
const SMALLEST: f64 = 5.5;

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
    let template = environment.get_template("report.html").expect("just added");
    template
        .render(context! {
            title => &document.title,
            subtitle => &document.subtitle,
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
                let (tight, fit) = (fit < SMALLEST, style::number(fit));
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
                let svg = Value::from_safe_string(prefixed(svg, &format!("{id}-")));
                context! { kind => "figure", id, name, caption, svg }
            }
            Block::Formula { latex, note } => {
                let Some((mathml, width)) = mathml(latex) else {
                    return context! { kind => "formula", latex, note };
                };
                let fit = style::number(PRINTED / width.max(1.0));
                context! { kind => "formula", mathml => Value::from_safe_string(mathml), fit, note }
            }
            Block::Code { text } => context! { kind => "code", text },
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
        format!(
            ":root {{ color-scheme: light dark;{} }}\n{}@media screen and (prefers-color-scheme: dark) {{\n\
             :root {{{} }}\n{}}}\n",
            variables(&str::to_owned),
            include_str!("html/report.css"),
            variables(&dark),
            rules(&self.colours, ".picture "),
        )
    }
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
