//! Tooth numbers for a layout.

mod answer;
mod document;
pub mod fit;
mod form;
mod front;
mod layout;
mod lines;
mod nest;
mod range;
mod relax;
mod report;
mod rule;
mod search;
mod shift;
mod space;
mod statics;
mod wish;

pub use answer::{Completeness, DesignAnswer, DesignRow, Relaxation, SetRange, SetRow, Space, Stage, StateRow};
pub use document::Design;
pub use front::Front;
pub use layout::SetKind;
pub use range::{Counts, MOST_TEETH};
pub use report::Request;
pub use rule::Rule;
pub use search::{Found, Progress};
pub use space::{Item, SetSpace};
pub use wish::{Limits, Objective, Ratio, Requirements, Target};
