//! Shift schemes: all layouts of planetary sets with all choices of clutches and brakes that have the gears wanted.
//!
//! A [`Wish`] says what is wanted, a [`Search`] is the search for it, its answer is [`Schemes`]. The spaces are finite and
//! small enough to finish, so the answer says how many schemes there are and that there are no others.
//!
//! # Method
//!
//! * Layouts ([`Layouts`]) are walked as restricted-growth strings, so none comes twice.
//! * In a layout every shaft is a vector and every clutch or brake a point of projective space; a gear is the common zero
//!   of its closed elements, its ratio a quotient of two determinants. Elements at one point do the same to all speeds.
//! * The search chooses points, leaves a branch as soon as too many of its states can be no gear, and multiplies out the
//!   elements at the points only for what is found.
//! * What is equal is decided modulo a prime of 61 bits: an integer that is not zero there is not zero. One that is zero
//!   there is taken for zero, which is wrong only for multiples of that prime. Ratios are sorted out in floating point,
//!   with a margin for rounding within which exact numbers decide. What is shown is computed again with rational numbers
//!   from the equations of the sets, and the answer says so where that does not confirm a scheme.
//!
//! Literature: Willis, *Principles of Mechanism* (1841), for the equation of a set; the lever analogy of Benford and
//! Leising, SAE 810102 (1981), for shafts as points; Demoucron, Malgrange and Pertuiset (1964) for drawings without a
//! crossing.

mod choose;
mod design_file;
mod efficiency;
mod harvest;
mod hybrid;
mod hybrid_file;
mod known;
mod layout;
mod measure;
mod motion;
mod planar;
mod points;
mod rate;
mod read;
mod report;
mod scheme;
mod search;
mod table;
mod train_file;
mod wish;

pub use choose::MAX_ELEMENTS;
pub use harvest::Harvest;
pub use hybrid::{HybridDesign, HybridHarvest, HybridMode, HybridSearch, HybridWish, Hybrids, ModeKind, hybrids};
pub use known::{KNOWN, Known, Rediscovered, usual_ratios};
pub use layout::{GROUND, INPUT, Layout, Layouts, MAX_SETS, NoLayout, OUTPUT, Prefix, count_layouts};
pub use report::{FoundSchemes, SchemeCompleteness, SchemeRelaxation, SchemeSpace, SchemeStage, Schemes};
pub use scheme::{Scheme, SchemeElement, SchemeGear, SchemeShaft};
pub use search::Search;
pub use wish::{Bounds, Order, SetRatio, Wish};
