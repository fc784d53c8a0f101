//! Parts of a search: which one is asked for, and what they are together.

use serde::de::DeserializeOwned;
use willis::diagnostic::{Code, Diagnostic, Diagnostics};

use crate::Refusal;

/// `2/8` as the number of a part, from 1, and how many there are.
pub(super) fn part(text: &str) -> Result<(u64, u64), Diagnostic> {
    let whole = |t: &str| t.trim().parse::<u64>().ok();
    let read = text.split_once('/').and_then(|(k, n)| Some((whole(k)?, whole(n)?)));
    read.filter(|(k, n)| (1..=*n).contains(k) && *n <= 1_000_000).ok_or_else(|| {
        let d = Diagnostic::new(Code::OutOfRange, "shard", format!("`{text}` is no part of a search"));
        d.hint("write the number of the part, from 1, and how many there are: 2/8")
    })
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
