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
    /// What a reader looks for on the first page: a word and what it is.
    pub facts: Vec<[String; 2]>,
    /// The sections in their order.
    pub sections: Vec<Section>,
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
    /// Text to be typed as it stands: commands, a train file.
    Code {
        /// The lines.
        text: String,
    },
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
