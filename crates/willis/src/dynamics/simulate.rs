//! A scenario from its start to its end, by any method.

use crate::diagnostic::Diagnostics;
use crate::train::Train;

use super::fixed::recorded::fixed;
use super::lagged::lagged;
use super::report::{Method, Options, Recorder, RunReport};
use super::run::Simulation;

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
    options.check()?;
    match options.method {
        Method::Fixed { step_s } if options.lagged_forces => lagged(train, scenario, options, step_s, recorder),
        Method::Fixed { step_s } => fixed(train, scenario, options, step_s, recorder),
        Method::Adaptive => {
            let mut run = Simulation::new(train, scenario, options)?;
            if recorder.columns(&run.columns).is_continue() {
                run.advance(f64::INFINITY, recorder);
            }
            Ok(run.report())
        }
    }
}
