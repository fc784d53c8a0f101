//! The list of questions: one file and one line each.

mod amount;
mod analyze;
mod calibrate;
mod check;
mod compare;
mod cycle;
#[cfg(feature = "design")]
mod design;
#[cfg(feature = "pictures")]
mod draw;
mod explain;
mod export;
mod flow;
mod formula;
mod heat;
#[cfg(feature = "import")]
mod import;
mod laws;
mod locate;
mod losses;
mod modes;
mod names;
mod new;
#[cfg(any(feature = "design", feature = "schemes"))]
mod parts;
mod regimes;
#[cfg(feature = "pictures")]
mod report;
#[cfg(feature = "schemes")]
mod schemes;
mod sensitivity;
mod simulate;
mod sweep;
mod table;
mod uncertainty;
#[cfg(feature = "casebook")]
mod validate;

pub use analyze::Analyze;
pub use calibrate::Calibrate;
pub use check::Check;
pub use compare::Compare;
pub use cycle::{Cycle, CycleAnswer};
#[cfg(feature = "design")]
pub use design::{Design, DesignFound};
#[cfg(feature = "pictures")]
pub use draw::{Draw, DrawAnswer, Look};
pub use explain::Explain;
pub use export::{Export, FMU};
pub use flow::Flow;
pub use formula::{Formula, FormulaAnswer};
pub use heat::Heat;
#[cfg(feature = "import")]
pub use import::{Import, ImportAnswer};
pub use laws::Laws;
pub use locate::Locate;
pub use losses::Losses;
pub use modes::Modes;
pub use new::New;
pub use regimes::{Regimes, RegimesAnswer};
#[cfg(feature = "pictures")]
pub use report::Report;
#[cfg(feature = "schemes")]
pub use schemes::{HybridResult, SchemeResult, Schemes, SchemesAnswer};
pub use sensitivity::Sensitivity;
pub use simulate::{MOST_EVENTS, MOST_KEPT, Simulate, run_text as simulation_text, tell_of_events_left_out};
pub use sweep::{Sweep, SweepAnswer, bytes_in_words, duration_in_words, points_in_words, sweep_text};
pub use table::Table;
pub use uncertainty::{Uncertainty, UncertaintyAnswer};
#[cfg(feature = "casebook")]
pub use validate::Validate;

use crate::Entry;

/// All questions, in the order in which help lists them.
pub static QUESTIONS: &[Entry] = &[
    Entry::of::<Analyze>(),
    Entry::of::<Table>(),
    Entry::of::<New>(),
    Entry::of::<Check>(),
    Entry::of::<Flow>(),
    Entry::of::<Losses>(),
    Entry::of::<Heat>(),
    Entry::of::<Sensitivity>(),
    Entry::of::<Uncertainty>(),
    Entry::of::<Calibrate>(),
    Entry::of::<Sweep>(),
    Entry::of::<Cycle>(),
    Entry::of::<Compare>(),
    Entry::of::<Regimes>(),
    Entry::of::<Formula>(),
    Entry::of::<Locate>(),
    Entry::of::<Simulate>(),
    Entry::of::<Modes>(),
    #[cfg(feature = "design")]
    Entry::of::<Design>(),
    #[cfg(feature = "schemes")]
    Entry::of::<Schemes>(),
    #[cfg(feature = "pictures")]
    Entry::of::<Draw>(),
    #[cfg(feature = "pictures")]
    Entry::of::<Report>(),
    Entry::of::<Export>(),
    #[cfg(feature = "import")]
    Entry::of::<Import>(),
    Entry::of::<Laws>(),
    #[cfg(feature = "casebook")]
    Entry::of::<Validate>(),
    Entry::of::<Explain>(),
];

/// The question of that name.
pub fn question(name: &str) -> Option<&'static Entry> {
    QUESTIONS.iter().find(|q| q.name == name)
}
