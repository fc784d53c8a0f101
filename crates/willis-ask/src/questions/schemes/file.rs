//! Rows as train files.

use willis::diagnostic::{Code, Diagnostic};

use super::SchemesAnswer;
use crate::{File, Refusal};

/// The form in which rows of schemes are design files.
pub const DESIGN_FILE: &str = "design-file";

/// The train files of these rows, counted from 1; or their design files.
pub fn rows(answer: &SchemesAnswer, form: &str, rows: &[usize]) -> Result<Vec<File>, Refusal> {
    let is_design = form == DESIGN_FILE;
    if is_design && matches!(answer, SchemesAnswer::Hybrids(_)) {
        let message = "the modes of a hybrid are no gears with ratios, for which teeth could be found";
        let hint = "write the hybrid as a train, and design it with the ratios that its gears shall have";
        return Err(Diagnostic::new(Code::Conflict, "", message).hint(hint).into());
    }
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
    let file = |row: usize| match answer {
        SchemesAnswer::Schemes(found) if is_design => {
            let scheme = &found.all.schemes[row - 1];
            let about = format!("the search for the teeth of scheme {row}, {}", scheme.id);
            File { about, ..File::text(format!("{name}-{row}-design.toml"), scheme.to_design(&found.all.wish)) }
        }
        _ => {
            let (text, id) = one(row);
            File { about: format!("{name} {row}, {id}"), ..File::text(format!("{name}-{row}.toml"), text) }
        }
    };
    Ok(rows.into_iter().map(file).collect())
}
