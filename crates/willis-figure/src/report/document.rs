//! A report before it is typeset: sections of text, tables, figures and formulas.
//!
//! One document, several typesetters: a web page here, a PDF in a crate of its
//! own, which reads the document as JSON, so that nobody else pays for its build.

use serde::{Deserialize, Serialize};

// Of the root of the crate: this file is also part of the typesetter, which takes the source and not the crate.
use crate::contract::{Contract, Format};

/// A report, ready to be typeset. Written as JSON it is the contract `willis-report-1`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Document {
    /// `willis-report-1`.
    pub format: Format<Self>,
    /// The train.
    pub title: String,
    /// What kind of document it is, in a few words.
    pub subtitle: String,
    /// Who made it for what, as they said.
    #[serde(default)]
    pub title_block: TitleBlock,
    /// What a reader looks for on the first page: a word and what it is.
    pub facts: Vec<[String; 2]>,
    /// The sections in their order.
    pub sections: Vec<Section>,
}

/// What a title block says; empty where nothing was given. Nothing of it comes from a clock.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default)]
pub struct TitleBlock {
    /// The project or customer.
    pub project: String,
    /// Who answers for the report.
    pub author: String,
    /// The date, in the words of the author.
    pub date: String,
    /// Which revision of the report it is.
    pub revision: String,
}

/// A part of a report with a heading.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Section {
    /// Its heading.
    pub title: String,
    /// What stands in it.
    pub blocks: Vec<Block>,
}

/// A piece of a section.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", tag = "block")]
#[non_exhaustive]
pub enum Block {
    /// A heading within a section.
    Heading {
        /// Its words.
        text: String,
    },
    /// A paragraph.
    Text {
        /// Plain words.
        text: String,
    },
    /// Items below each other.
    List {
        /// The items.
        items: Vec<String>,
    },
    /// What must not be overlooked.
    Notice {
        /// How serious it is.
        level: Level,
        /// What is the case.
        text: String,
    },
    /// A table.
    Table {
        /// What it shows.
        caption: String,
        /// Its columns.
        columns: Vec<Column>,
        /// Its rows, as many cells as columns each.
        rows: Vec<Vec<String>>,
    },
    /// A picture.
    Figure {
        /// What it shows.
        caption: String,
        /// The picture as SVG in its light form, text as text.
        svg: String,
    },
    /// A formula on a line of its own.
    Formula {
        /// LaTeX, without dollars.
        latex: String,
        /// When it holds, or what it is.
        note: String,
    },
    /// Short formulas below each other, each with what it is: symbols, conditions.
    Terms {
        /// What they are.
        head: String,
        /// The formulas.
        items: Vec<Term>,
    },
    /// Text to be typed as it stands: commands, a train file.
    Code {
        /// The lines.
        text: String,
    },
}

/// A short formula and what it is.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Term {
    /// LaTeX, without dollars.
    pub latex: String,
    /// What it is, in words.
    pub text: String,
}

/// A figure alone, ready to be set as a page of its own size: the contract `willis-plate-1`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Plate {
    /// `willis-plate-1`.
    pub format: Format<Self>,
    /// The picture as SVG in its light form, text as text.
    pub svg: String,
    /// How wide the page is, in mm; absent for three quarters of a point to a unit of the figure.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub width_mm: Option<f64>,
}

/// How serious a notice is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Level {
    /// The solution is the only one. Nothing is said of how exact its values are.
    Good,
    /// Worth knowing.
    Note,
    /// May be wrong, or out of a validity range.
    Warning,
    /// No answer: locked, several solutions, not determined.
    Stop,
}

/// A column of a table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Column {
    /// Its head, with the unit where there is one.
    pub head: String,
    /// Whether it holds numbers, which are set flush right.
    pub number: bool,
}

impl Contract for Document {
    const FORMAT: &'static str = "willis-report-1";
}

impl Contract for Plate {
    const FORMAT: &'static str = "willis-plate-1";
}

impl TitleBlock {
    /// What was given, each with its word.
    pub fn entries(&self) -> impl Iterator<Item = [&str; 2]> {
        let all =
            [("Project", &self.project), ("Author", &self.author), ("Date", &self.date), ("Revision", &self.revision)];
        all.into_iter().filter(|(_, given)| !given.is_empty()).map(|(word, given)| [word, given.as_str()])
    }
}

impl Column {
    /// A column of words.
    pub fn words(head: impl Into<String>) -> Self {
        Self { head: head.into(), number: false }
    }

    /// A column of numbers.
    pub fn numbers(head: impl Into<String>) -> Self {
        Self { head: head.into(), number: true }
    }
}
