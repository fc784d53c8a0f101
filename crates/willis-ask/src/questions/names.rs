//! Names that a field of a request takes, which schema and completions list; fields that exclude each other.

use willis::diagnostic::{Code, Diagnostic, Diagnostics};

#[cfg(feature = "pictures")]
use willis_figure::FigureKind;

/// Kinds of figures; `all` draws whatever applies.
#[cfg(feature = "pictures")]
pub fn figures() -> Vec<&'static str> {
    FigureKind::ALL.iter().map(|k| k.name()).chain(["all"]).collect()
}

/// Kinds of exports; `list` lists them.
pub fn exports() -> Vec<&'static str> {
    super::export::kinds().into_iter().map(|k| k.0).chain(["list"]).collect()
}

/// Cases of published numbers.
#[cfg(feature = "casebook")]
pub fn cases() -> Vec<&'static str> {
    willis_casebook::CASES.iter().map(|c| c.name).collect()
}

/// Families of loss laws.
pub fn families() -> Vec<&'static str> {
    willis::losses::FAMILIES.to_vec()
}

/// Codes of diagnostics, and rules for teeth.
pub fn codes() -> Vec<&'static str> {
    let codes = willis::diagnostic::Code::ALL.iter().map(|c| c.as_str());
    #[cfg(feature = "design")]
    let codes = codes.chain(willis_synthesis::teeth::Rule::ALL.iter().map(|r| r.name()));
    codes.collect()
}

/// The same names, or nothing: what the schema of a field that may be left out allows.
pub fn or_none(names: Vec<&'static str>) -> Vec<Option<&'static str>> {
    names.into_iter().map(Some).chain([None]).collect()
}

/// An error for each pair of fields that are both given.
///
/// # Errors
/// All of them.
pub fn apart(pairs: &[[(&str, bool); 2]]) -> Result<(), Diagnostics> {
    let both = pairs.iter().filter(|pair| pair.iter().all(|(_, given)| *given));
    let wrong: Diagnostics = both
        .map(|[(a, _), (b, _)]| {
            let message = format!("`{a}` and `{b}` exclude each other");
            Diagnostic::new(Code::Conflict, "", message).hint("leave out one of the two")
        })
        .collect();
    if wrong.has_errors() { Err(wrong) } else { Ok(()) }
}

/// Reads any text: completions know the names, and the question itself refuses another one, with the nearest of them.
#[cfg(feature = "clap")]
#[derive(Clone)]
pub struct Known(pub fn() -> Vec<&'static str>);

#[cfg(feature = "clap")]
impl clap::builder::TypedValueParser for Known {
    type Value = String;

    fn parse_ref(
        &self,
        command: &clap::Command,
        of: Option<&clap::Arg>,
        value: &std::ffi::OsStr,
    ) -> Result<String, clap::Error> {
        clap::builder::StringValueParser::new().parse_ref(command, of, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = clap::builder::PossibleValue> + '_>> {
        Some(Box::new((self.0)().into_iter().map(clap::builder::PossibleValue::new)))
    }
}
