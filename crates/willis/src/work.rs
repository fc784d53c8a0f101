//! What long computations ask of their surroundings: who runs the parts, who shows how far it is, and whether to
//! stop.
//!
//! The library starts no threads and reads no clock. A computation of many independent parts takes a [`Work`] and
//! gives it the parts; the terminal runs them on all cores with a bar, a browser one after the other ([`Serial`]), and
//! the answer is the same.

use std::sync::Mutex;

/// The surroundings of a long computation.
pub trait Work: Sync {
    /// A stage of `of` steps begins; a step is one of `what`, in the plural: `points`, `samples`.
    fn begin(&self, what: &'static str, of: u64) {
        let _ = (what, of);
    }

    /// So many more steps of the present stage are done.
    fn advance(&self, steps: u64) {
        let _ = steps;
    }

    /// Whether the computation should stop early. What is not done then is left out, and the caller is told.
    fn cancelled(&self) -> bool {
        false
    }

    /// Calls `job` with every number below `parts`, each once, in any order and perhaps at the same time; after
    /// [`Work::cancelled`] turned true no further part is begun.
    fn run(&self, parts: usize, job: &(dyn Fn(usize) + Sync)) {
        for part in 0..parts {
            if self.cancelled() {
                return;
            }
            job(part);
        }
    }
}

/// One part after the other, on the caller's thread, without a word.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Serial;

impl Work for Serial {}

/// A computation was told to stop before it had its answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cancelled;

impl std::fmt::Display for Cancelled {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("stopped before the answer was there")
    }
}

impl std::error::Error for Cancelled {}

/// The results of `parts` independent parts, in order.
///
/// # Errors
/// The work was cancelled before all parts were done.
///
/// # Example
/// ```
/// use willis::work::{Serial, map};
///
/// assert_eq!(map(&Serial, 4, |k| k * k), Ok(vec![0, 1, 4, 9]));
/// ```
pub fn map<T: Send>(work: &dyn Work, parts: usize, job: impl Fn(usize) -> T + Sync) -> Result<Vec<T>, Cancelled> {
    let done: Vec<Mutex<Option<T>>> = (0..parts).map(|_| Mutex::new(None)).collect();
    work.run(parts, &|part| {
        let result = job(part);
        *done[part].lock().unwrap_or_else(std::sync::PoisonError::into_inner) = Some(result);
    });
    let taken = done.into_iter().map(|cell| cell.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner));
    taken.collect::<Option<Vec<T>>>().ok_or(Cancelled)
}
