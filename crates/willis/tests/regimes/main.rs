//! Every way a train can run: regimes, their limits, their formulas and the code written of them.

#[path = "../common/mod.rs"]
mod common;

mod at_load;
mod atlas;
mod emitted;
mod limits;
