//! Motion: whole runs, steps of fixed length, losses on the way.

#[path = "../common/mod.rs"]
mod common;

mod laws;
mod runs;
mod steps;
