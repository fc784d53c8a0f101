//! Motion: whole runs, steps of fixed length, losses on the way.

mod laws;
mod runs;
mod steps;
