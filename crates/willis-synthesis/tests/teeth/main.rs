//! Tooth numbers: counts that an exhaustive search must reproduce exactly, each found in at least two ways.

mod counts;
mod files;
mod laws;
mod layouts;
mod own;
mod steps;
