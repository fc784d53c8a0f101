//! The heat balance, warm-up and duty cycles, and calibration by tests.

#[path = "../common/mod.rs"]
mod common;

mod cases;
mod calibration;

mod trains;
