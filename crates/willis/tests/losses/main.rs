//! Below the train: teeth, bearings, oils and every law of losses.

mod components;
mod geometry;
mod laws;
