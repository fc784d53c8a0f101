//! One operating point: speeds, torques, verdicts, power flow, computed losses; and many, compiled.

#[path = "../common/mod.rs"]
mod common;

mod compiled;
mod degenerate;
mod echo;
mod flow;
mod operating_point;
mod properties;
mod speeds;
mod theory;
mod variators;
