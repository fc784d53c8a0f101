//! Parts of a search: which one is asked for, and what they are together.

use serde::de::DeserializeOwned;
use willis::diagnostic::{Code, Diagnostic, Diagnostics};

use crate::Refusal;

/// The most parts into which a search is cut.
const MOST: u64 = 1_000_000;

/// `2/8` as the number of a part, from 1, and how many there are.
pub(super) fn part(text: &str) -> Result<(u64, u64), Box<Diagnostic>> {
    let whole = |t: &str| t.trim().parse::<u64>().ok();
    let wrong = |code, message: String, hint: String| Err(Diagnostic::new(code, "shard", message).hint(hint).into());
    let shown = willis::diagnostic::printable(text);
    match text.split_once('/').and_then(|(k, n)| Some((whole(k)?, whole(n)?))) {
        Some((_, n)) if n > MOST => {
            wrong(Code::OutOfRange, format!("`{shown}`: too many parts"), format!("there can be {MOST} at most"))
        }
        Some((k, n)) if (1..=n).contains(&k) => Ok((k, n)),
        Some((k, n)) => {
            let hint = "parts are counted from 1, as in 3/16";
            wrong(Code::OutOfRange, format!("there is no part {k} of {n}"), hint.into())
        }
        None => {
            let hint = "write 3/16: part 3 of 16";
            wrong(Code::WrongType, format!("`{shown}` is no part of a search"), hint.into())
        }
    }
}

/// All parts, as they were written, together; none where there are none.
pub(super) fn parts<T: DeserializeOwned>(
    pieces: &[Vec<u8>],
    join: impl Fn(T, T) -> Result<T, Diagnostics>,
) -> Result<Option<T>, Refusal> {
    let mut whole: Option<T> = None;
    for piece in pieces {
        let part: T = serde_json::from_slice(piece).map_err(|e| {
            Refusal::from(Diagnostic::new(Code::Syntax, "", format!("this is no part of a search: {e}")))
        })?;
        whole = Some(match whole {
            Some(before) => join(before, part)?,
            None => part,
        });
    }
    Ok(whole)
}
