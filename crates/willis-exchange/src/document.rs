//! A REXS file as data: components with attributes, relations between them, load cases.

use willis::diagnostic::printable;

/// Files are at most so large, MiB, and so is what an archive unpacks to.
pub const MOST_MIB: usize = 64;
/// Components, relations and load cases are at most so many together.
pub const MOST_ENTRIES: usize = 100_000;
/// Attributes and references are at most so many together.
pub const MOST_ATTRIBUTES: usize = 1_000_000;
/// Messages of one kind that are kept; the others are counted.
pub const MOST_TOLD: usize = 500;
/// Values of a list: nothing that is used has more.
pub const MOST_LISTED: usize = 1000;
/// What stands for a list of more.
pub const LONG_LIST: &str = "a list of more than 1000 values";
/// Characters that are kept of a name, a type, a unit or a text.
const MOST_CHARACTERS: usize = 200;

/// A name, a type, a unit or a text, shortened: they are repeated in messages and in the account of attributes.
pub fn word(text: &str) -> String {
    match text.char_indices().nth(MOST_CHARACTERS) {
        Some((at, _)) => format!("{}…", &text[..at]),
        None => text.to_owned(),
    }
}

/// A value as it stands in the file.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    Number(f64),
    Flag(bool),
    Text(String),
    Numbers(Vec<f64>),
    Flags(Vec<bool>),
    /// A matrix, a coded array, a list of texts.
    Other(&'static str),
}

impl Value {
    /// For reports, shortened.
    pub fn shown(&self) -> String {
        const MOST: usize = 60;
        let whole = match self {
            Self::Number(x) => x.to_string(),
            Self::Flag(x) => x.to_string(),
            Self::Text(x) => printable(x).into_owned(),
            Self::Numbers(all) => all.iter().take(7).map(f64::to_string).collect::<Vec<_>>().join(", "),
            Self::Flags(all) => all.iter().take(7).map(bool::to_string).collect::<Vec<_>>().join(", "),
            Self::Other(what) => (*what).to_owned(),
        };
        match whole.char_indices().nth(MOST) {
            Some((at, _)) => format!("{}…", &whole[..at]),
            None => whole,
        }
    }

    /// A value from a text that says not what it is: numbers and truth values first.
    pub fn of_text(text: &str) -> Self {
        let text = text.trim();
        match (text, text.parse::<f64>()) {
            ("true", _) => Self::Flag(true),
            ("false", _) => Self::Flag(false),
            // Words that would be read as numbers.
            (_, Ok(x)) if text.bytes().any(|b| b.is_ascii_digit()) || !x.is_finite() => Self::Number(x),
            _ => Self::Text(word(text)),
        }
    }

    /// The same of a list.
    pub fn of_texts(all: &[&str]) -> Self {
        if all.len() > MOST_LISTED {
            return Self::Other(LONG_LIST);
        }
        let values: Vec<Self> = all.iter().map(|t| Self::of_text(t)).collect();
        let numbers = values.iter().map(|v| if let Self::Number(x) = v { Some(*x) } else { None });
        if let Some(numbers) = numbers.collect::<Option<Vec<_>>>() {
            return Self::Numbers(numbers);
        }
        let flags = values.iter().map(|v| if let Self::Flag(x) = v { Some(*x) } else { None });
        flags.collect::<Option<Vec<_>>>().map_or(Self::Other("a list of texts"), Self::Flags)
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct Attribute {
    pub id: String,
    pub unit: String,
    pub value: Value,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Component {
    pub id: i64,
    pub kind: String,
    pub name: String,
    pub attributes: Vec<Attribute>,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Relation {
    pub id: i64,
    pub kind: String,
    /// Roles with the components that have them.
    pub refs: Vec<(String, i64)>,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct LoadCase {
    pub id: i64,
    pub components: Vec<Component>,
}

/// What is odd about a file and does not stop its reading.
#[derive(Clone, Debug, PartialEq)]
pub struct Odd {
    pub place: String,
    pub message: String,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Document {
    pub version: String,
    /// The program that wrote it, with its version.
    pub application: String,
    pub date: String,
    pub components: Vec<Component>,
    pub relations: Vec<Relation>,
    pub cases: Vec<LoadCase>,
    pub odd: Vec<Odd>,
    /// What is odd beyond that.
    pub more_odd: usize,
}

impl Document {
    pub fn odd(&mut self, place: impl Into<String>, message: impl Into<String>) {
        if self.odd.len() < MOST_TOLD {
            self.odd.push(Odd { place: place.into(), message: message.into() });
        } else {
            self.more_odd += 1;
        }
    }
}

/// Counts what is read, against the bounds.
#[derive(Default)]
pub struct Budget {
    entries: usize,
    attributes: usize,
}

impl Budget {
    pub fn entry(&mut self) -> Result<(), String> {
        self.entries += 1;
        let told = || format!("it has more than {MOST_ENTRIES} components, relations and load cases");
        if self.entries > MOST_ENTRIES { Err(told()) } else { Ok(()) }
    }

    /// Counts an attribute, or a reference to a component.
    pub fn attribute(&mut self) -> Result<(), String> {
        self.attributes += 1;
        let told = || format!("it has more than {MOST_ATTRIBUTES} attributes and references");
        if self.attributes > MOST_ATTRIBUTES { Err(told()) } else { Ok(()) }
    }
}
