//! Quantities in requests: texts with a unit, as in a train file.

use willis::diagnostic::{Code, Diagnostic, Diagnostics};
use willis::units::{self, Dimension, Quantity};

/// What is wrong with a value of a field.
fn wrong(field: &str, text: &str, dimension: Dimension, why: &dyn std::fmt::Display) -> Diagnostic {
    let (kind, example) = dimension.describe();
    Diagnostic::new(Code::Quantity, "", format!("{field} {text}: {why}"))
        .hint(format!("give {kind}, as in '{example}'"))
}

/// Values of a field; all that is wrong with them at once.
pub fn values(field: &str, given: &[String], dimension: Dimension) -> Result<Vec<Quantity>, Diagnostics> {
    let mut all = vec![];
    let mut told = Diagnostics::default();
    for text in given {
        match units::parse(text, dimension) {
            Ok(q) => all.push(q),
            Err(why) => told.push(wrong(field, text, dimension, &why)),
        }
    }
    if told.is_empty() { Ok(all) } else { Err(told) }
}

/// `member=value` pairs of a field; all that is wrong with them at once.
pub fn of_members(field: &str, given: &[String], dimension: Dimension) -> Result<Vec<(String, Quantity)>, Diagnostics> {
    let (_, example) = dimension.describe();
    let mut all = vec![];
    let mut told = Diagnostics::default();
    for text in given {
        match text.split_once('=') {
            None => told.push(
                Diagnostic::new(Code::Quantity, "", format!("{field} {text}: no member is named"))
                    .hint(format!("write member=value, as in 'sun={example}'")),
            ),
            Some((name, value)) => match units::parse(value, dimension) {
                Ok(q) => all.push((name.trim().to_owned(), q)),
                Err(why) => told.push(
                    Diagnostic::new(Code::Quantity, "", format!("{field} {text}: {why}"))
                        .hint(format!("give {}, as in '{name}={example}'", dimension.describe().0)),
                ),
            },
        }
    }
    if told.is_empty() { Ok(all) } else { Err(told) }
}

/// The two terminals of a field `balance`.
pub fn pair(names: Option<&[String]>) -> Result<Option<[String; 2]>, Diagnostics> {
    match names {
        None => Ok(None),
        Some([a, b]) => Ok(Some([a.clone(), b.clone()])),
        Some(other) => {
            let message = format!("balance names two terminals, here are {}", other.len());
            Err(Diagnostic::new(Code::UnknownSelection, "", message).hint("as in mg1,mg2").into())
        }
    }
}
