//! Tooth numbers for a layout.

pub mod fit;
mod form;
mod front;
mod layout;
mod lines;
mod nest;
mod range;
mod rule;
mod shift;
mod space;
mod statics;

pub use front::Front;
pub use layout::SetKind;
pub use range::{Counts, MOST_TEETH};
pub use rule::Rule;
pub use space::{Item, SetSpace};
