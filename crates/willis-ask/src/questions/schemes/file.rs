//! Rows as train files.

use willis::diagnostic::{Code, Diagnostic};

use super::SchemesAnswer;
use crate::{File, Refusal};

/// The train files of these rows, counted from 1.
pub fn trains(answer: &SchemesAnswer, rows: &[usize]) -> Result<Vec<File>, Refusal> {
    let (name, shown) = match answer {
        SchemesAnswer::Schemes(found) => ("scheme", found.all.schemes.len()),
        SchemesAnswer::Hybrids(found) => ("hybrid", found.all.designs.len()),
    };
    if let Some(row) = rows.iter().find(|row| !(1..=shown).contains(*row)) {
        let message = match shown {
            0 => format!("there is no {name} to be written: none does what is wanted"),
            _ => format!("there is no row {row}: the answer has {shown}"),
        };
        let hint = match shown {
            0 => "without `write` the answer says which wish must give way",
            _ => "without `write` the answer lists them",
        };
        return Err(Diagnostic::new(Code::UnknownSelection, "", message).hint(hint).into());
    }
    let mut rows = rows.to_vec();
    rows.sort_unstable();
    rows.dedup();
    let one = |row: usize| match answer {
        SchemesAnswer::Schemes(found) => (found.all.schemes[row - 1].to_toml(), &found.all.schemes[row - 1].id),
        SchemesAnswer::Hybrids(found) => (found.all.designs[row - 1].to_toml(), &found.all.designs[row - 1].id),
    };
    let file = |row: usize| {
        let (text, id) = one(row);
        File { about: format!("{name} {row}, {id}"), ..File::text(format!("{name}-{row}.toml"), text) }
    };
    Ok(rows.into_iter().map(file).collect())
}
