//! Motion: trains that accelerate, stick, slip and shift.
//!
//! The equations of motion hold the mesh forces by their exact loop, in which the direction of each
//! tooth force decides the efficiency; Coulomb friction that holds is a state, not a steep curve; within
//! a mode the right-hand side is smooth, and changes of mode are located as events. Source:
//! Galvagno 2010 with corrected signs and its loop solved.

mod integrator;
mod modes;
mod report;

use crate::diagnostic::Diagnostics;
use crate::train::Train;

pub use modes::{Mode, ModesReport, Part, RigidMode, modes};
pub use report::{
    Column, EnergyLoss, EnergyReport, Event, Method, ModeLabel, Options, Outcome, Recorder, RunReport, Sample,
    SourceEnergy,
};

/// Runs a scenario from its start to its end and hands rows and events to a recorder as they come.
///
/// # Errors
/// What is wrong with the scenario: inertia that is missing, speeds that contradict each other.
pub fn simulate(
    train: &Train,
    scenario: &str,
    options: &Options,
    recorder: &mut dyn Recorder,
) -> Result<RunReport, Diagnostics> {
    let _ = (train, scenario, options, recorder);
    unimplemented!("under construction")
}
