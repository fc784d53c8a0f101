//! A run in steps of fixed length that is recorded.

use std::ops::ControlFlow;

use crate::diagnostic::Diagnostics;
use crate::dynamics::event::event;
use crate::dynamics::report::{Options, Outcome, Recorder, RunReport, Sample};
use crate::dynamics::run::Simulation;
use crate::dynamics::window::Window;
use crate::train::Train;
use crate::work::Effort;

use super::FixedStep;
use super::shafts::word;

/// Work of a step of a small train, s.
const FIXED_STEP: f64 = 2e-7;

/// Steps after which progress is told.
const TOLD: u64 = 256;

/// A run in steps of fixed length.
pub(in crate::dynamics) fn fixed(
    train: &Train,
    scenario: &str,
    options: &Options,
    h: f64,
    recorder: &mut dyn Recorder,
) -> Result<RunReport, Diagnostics> {
    let mut run = Simulation::new(train, scenario, options)?;
    let mut stepper = FixedStep::new(train, scenario, h)?;
    stepper.engine.counts = options.energies;
    if options.energies {
        stepper.with_energies();
    }
    if recorder.columns(&run.columns).is_break() {
        return Ok(run.report());
    }
    let end = run.engine.system.scenario.end;
    stepper.engine.system.scenario.end = end;
    let recorder = &mut Window::new(run.from, recorder);
    let mut x = Vec::new();
    let (mut key, mut settled) = (None, u64::MAX);
    let steps = stepper.steps();
    let nodes = stepper.engine.system.nodes as f64;
    let effort = Effort::new("steps", steps, FIXED_STEP * (1.0 + nodes * nodes / 100.0));
    let affordable = effort.seconds <= options.patience_s;
    run.outcome = Some(if affordable { Outcome::Finished } else { Outcome::TooLong(effort.to_string()) });
    loop {
        if !affordable {
            break;
        }
        let (step, t) = (stepper.count, stepper.time());
        let sampled = run.is_row_due(t, h);
        // A step that goes on in its mode changes nothing that labels depend on.
        let changed = settled != stepper.settled && key != Some(stepper.state_of_modes());
        settled = stepper.settled;
        // No step has chosen the mode of the start yet.
        if step == 0 {
            if let Err(outcome) = run.choose(recorder) {
                // Fixed steps go on after an impact, also after one at the start.
                if !matches!(outcome, Outcome::Impact(_)) {
                    run.outcome = Some(outcome);
                }
            } else {
                run.row();
                if tell(recorder, t, &run.row).is_break() {
                    run.outcome = Some(Outcome::Interrupted);
                }
            }
        } else if sampled || changed {
            key = Some(stepper.state_of_modes());
            stepper.copy_to_engine(&mut x);
            let labels = stepper.engine.labels();
            if run.labels != labels {
                let event = event(&stepper.engine, t, None, &run.labels, &labels);
                run.events += 1;
                if event.is_some_and(|e| recorder.event(&e).is_break()) {
                    run.outcome = Some(Outcome::Interrupted);
                }
            }
            run.labels = labels;
        }
        if sampled && step > 0 {
            stepper.engine.row(t, &x, &mut run.row);
            // The forces of a row are those at its time, not in the middle of a step.
            if stepper.engine.acceleration.iter().any(|a| !a.is_finite()) {
                let formula = stepper.engine.out_of_domain(t);
                stepper.stop(formula.as_deref().unwrap_or("accelerations are not finite"));
                run.outcome.clone_from(&stepper.verdict);
                break;
            }
            if tell(recorder, t, &run.row).is_break() {
                run.outcome = Some(Outcome::Interrupted);
            }
        }
        if step % TOLD == 0 && recorder.progress(t).is_break() {
            run.outcome = Some(Outcome::Interrupted);
        }
        if step == steps || run.outcome != Some(Outcome::Finished) {
            break;
        }
        let next = stepper.first_step_at(run.next_row(h)).min((step / TOLD + 1) * TOLD).min(steps);
        stepper.run_on(next - step);
        run.steps += (stepper.count - step) as usize;
        if let Some(verdict) = stepper.verdict() {
            run.outcome = Some(verdict.clone());
            break;
        }
    }
    stepper.copy_to_engine(&mut x);
    run.t = stepper.time();
    run.notes.push(format!("steps of {h} s: first order in the step"));
    if run.t > end + 1e-9 * h {
        run.notes.push(format!("the last step ends at t = {} s, past the end of the scenario", run.t));
    }
    let impacts = stepper.impacts();
    let in_steps = |n: u64| if n == 1 { "in one step".to_owned() } else { format!("in {n} steps") };
    if impacts > 0 {
        run.notes.push(format!(
            "{} parts of different speed were joined at once, as in an inelastic impact",
            in_steps(impacts)
        ));
    }
    run.x = x;
    run.came_in = stepper.came_in;
    run.engine = stepper.engine;
    Ok(run.report())
}

/// Hands a row to a recorder that wants it; the row was needed anyway, to see whether its forces are finite.
fn tell(recorder: &mut dyn Recorder, t: f64, row: &[f64]) -> ControlFlow<()> {
    if recorder.wants_row(t) { recorder.sample(Sample { time_s: t, values: row }) } else { ControlFlow::Continue(()) }
}

impl FixedStep {
    /// Takes steps up to so many, until one does not go on in the mode of the one before or the run ends.
    fn run_on(&mut self, steps: u64) {
        let (settled, end) = (self.settled, self.count + steps);
        while self.count < end && self.settled == settled && self.verdict.is_none() {
            self.step();
        }
    }

    /// The first of the steps to come that begins at a time or later.
    fn first_step_at(&self, t: f64) -> u64 {
        let about = ((t - self.start) / self.h).floor() - 1.0;
        let mut step = (self.count + 1).max(about as u64);
        while step < u64::MAX && self.start + step as f64 * self.h < t {
            step += 1;
        }
        step
    }

    /// What labels depend on.
    fn state_of_modes(&self) -> (u64, u64, u64, f64) {
        let held = self.sign.iter().enumerate().map(|(g, s)| u64::from(*s == 0) << g).sum();
        let forward = self.sign.iter().enumerate().map(|(g, s)| u64::from(*s > 0) << g).sum();
        let touch = word(&self.shafts);
        (held, forward, touch, self.until)
    }
}
