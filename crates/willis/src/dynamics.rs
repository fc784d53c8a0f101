//! Motion: trains that accelerate, stick, slip and shift.
//!
//! The equations of motion hold the mesh forces by their exact loop, in which the direction of each
//! tooth force decides the efficiency; Coulomb friction that holds is a state, not a steep curve; within
//! a mode the right-hand side is smooth, and changes of mode are located as events. Source:
//! Galvagno 2010 with corrected signs and its loop solved.

mod affine;
mod batch;
mod bodies;
mod choose;
mod clear;
mod contacts;
mod decide;
mod decision;
mod dense;
mod element;
mod energy;
mod engine;
mod event;
mod fixed;
mod fused;
mod halt;
mod handles;
mod heated;
mod integrator;
mod lagged;
mod laws;
mod margins;
mod mode;
mod modes;
pub mod offset;
mod output;
mod paths;
mod rate;
mod report;
mod rounding;
mod run;
mod shows;
mod signal;
mod simulate;
mod source;
mod start;
mod steady;
mod still;
mod stretch;
mod system;
mod warming;
mod window;

pub use batch::Batch;
pub use fixed::FixedStep;
pub use handles::{InputHandle, InputInfo, InputKind, InputRefused, OutputHandle};
pub use modes::{Mode, ModesReport, Part, PlanetMode, RigidMode, modes};
pub use report::{
    Column, ColumnKind, ColumnUnit, EnergyLoss, EnergyLossKind, EnergyReport, Event, Happening, HappeningKind,
    LimitExceeded, Method, ModeLabel, MotionHeat, Options, Outcome, Recorder, RunReport, Sample, SourceEnergy,
};
pub use run::{LossCause, NotSaved, Simulation, StateInfo};
pub use simulate::simulate;
