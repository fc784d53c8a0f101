//! One operating point: speeds, torques, verdicts, power flow, computed losses; and many, compiled.

#[path = "../common/mod.rs"]
mod common;

mod at_load;
mod band;
mod compiled;
mod degenerate;
mod echo;
mod flow;
mod loads;
mod one_way;
mod operating_point;
mod properties;
mod speeds;
mod theory;
mod variators;
