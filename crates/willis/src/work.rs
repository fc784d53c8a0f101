//! What long computations ask of their surroundings: who runs the parts, who shows how far it is, and whether to
//! stop.
//!
//! How long a computation takes is told before it begins: [`Effort`], counted and not measured, so that the same question
//! is refused on every machine or on none.
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

    /// How many seconds of one core a computation may take by its own [`Effort`] before somebody must have allowed it.
    /// Infinite where that has happened.
    fn patience(&self) -> f64 {
        60.0
    }

    /// Refuses what would take too long.
    ///
    /// # Errors
    /// The effort is above the [patience](Work::patience).
    fn afford(&self, effort: &Effort) -> Result<(), TooLong> {
        if effort.seconds <= self.patience() { Ok(()) } else { Err(TooLong(*effort)) }
    }

    /// Seconds since some moment, where what fits a time is wanted rather than the same everywhere; only what is shown until
    /// the whole answer is there asks for it.
    fn clock(&self) -> Option<f64> {
        None
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

/// How much work a computation is, told before it begins. It is counted and not measured: the same everywhere, and right
/// within a factor of about three on an ordinary computer of 2026.
///
/// # Example
/// ```
/// use willis::work::{Effort, Serial, Work};
///
/// let effort = Effort::new("points", 1_000_000, 2e-4);
/// assert_eq!(effort.to_string(), "1000000 points, about 4 minutes of one core");
/// assert!(Serial.afford(&effort).is_err());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// What there is of it, in the plural: `points`.
    pub what: &'static str,
    /// How many of them.
    pub count: u64,
    /// Time for all of them on one core, s.
    pub seconds: f64,
}

impl Effort {
    /// So many things that take so many seconds each.
    pub fn new(what: &'static str, count: u64, each: f64) -> Self {
        Self { what, count, seconds: count as f64 * each }
    }
}

impl std::fmt::Display for Effort {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (amount, unit) = match self.seconds {
            s if s < 100.0 => (s, "second"),
            s if s < 6000.0 => (s / 60.0, "minute"),
            s if s < 200_000.0 => (s / 3600.0, "hour"),
            s => (s / 86_400.0, "day"),
        };
        let amount = amount.ceil();
        let ending = if amount == 1.0 { "" } else { "s" };
        write!(f, "{} {}, about {amount:.0} {unit}{ending} of one core", self.count, self.what)
    }
}

/// A computation would take longer than is done without having been allowed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TooLong(pub Effort);

impl std::fmt::Display for TooLong {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "this takes long: {}", self.0)
    }
}

impl std::error::Error for TooLong {}

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
