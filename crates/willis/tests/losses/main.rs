//! Below the train: teeth, bearings, oils and every law of losses.

#[path = "../common/mod.rs"]
mod common;

mod bevel;
mod components;
mod geometry;
mod hypoid;
mod large_bearings;
mod laws;
