//! Tooth numbers for a layout.
//!
//! A [`Design`] is read from a design file: a train file in which teeth are ranges, with a table of wishes. It is counted
//! ([`Design::count`]), searched ([`Design::search`], in parts if wanted) and answered ([`Design::answer`]); every row of
//! the answer becomes a train file ([`Design::train_file`]).
//!
//! | step | file |
//! |---|---|
//! | the wish | `document`, `range`, `rule`, `wish` |
//! | ratios as quotients of forms in the basic ratios of the sets | `layout`, `form` |
//! | the teeth of a set, by its basic ratios, and what its rules say | `space`, `fit`, `shift` |
//! | all teeth with the ratios | `nest`; one Wolfrom drive: `lines`; single gear pairs: `pairs` |
//! | efficiencies and speeds | `statics` |
//! | counts, front, parts of a search | `search`, `front` |
//! | which trains are the best under the laws of friction | `laws` |
//! | the answer; what must give; what contradicts itself | `report`, `answer`; `relax`; `contradiction` |

mod answer;
mod contradiction;
mod document;
pub mod fit;
mod form;
mod front;
mod laws;
mod layout;
mod lines;
mod nest;
mod own;
mod pairs;
mod range;
mod relax;
mod report;
mod rule;
mod search;
mod shift;
mod space;
mod start;
mod statics;
mod wish;

pub use answer::{
    Completeness, DesignAnswer, DesignRow, LawRow, OperationRow, OwnTrain, RankedBy, Ranking, Recomputed, Relaxation,
    SetRange, SetRow, Space, Stage, StateRow,
};
pub use document::Design;
pub use front::Front;
pub use layout::SetKind;
pub use pairs::{compound, fractions};
pub use range::{Counts, MOST_TEETH};
pub use report::Request;
pub use rule::Rule;
pub use search::{Found, Progress};
pub use space::{Item, SetSpace};
pub use start::{Around, Start, StartKind};
pub use wish::{Limits, Objective, Ratio, Requirements, Step, Target};
