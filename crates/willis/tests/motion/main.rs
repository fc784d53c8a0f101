//! Motion: whole runs, steps of fixed length, losses on the way.

#[path = "../common/mod.rs"]
mod common;

mod again;
mod gearbox;
mod gears;
mod heat;
mod laws;
mod massless;
mod random;
mod reactions;
mod reference;
mod rows;
mod runs;
mod series;
mod steps;
mod variators;
