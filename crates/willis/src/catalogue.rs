//! Oils and bearings by designation, each datum with its source (`data/`).

pub mod bearing;
pub mod oil;
