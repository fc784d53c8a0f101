//! The method of the paper, for comparison.

use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::train::Train;

use super::integrator::Smooth;
use super::report::{Options, Outcome, Recorder, RunReport};
use super::run::{Simulation, tell_row};
use super::window::Window;

/// The method of the paper: classical Runge–Kutta steps in which the side of each tooth force is that of
/// the step before, and Coulomb friction follows the sign of the speed without ever sticking. It is wrong for
/// one step after each reversal and chatters at rest; kept to show how much.
pub(super) fn lagged(
    train: &Train,
    scenario: &str,
    options: &Options,
    h: f64,
    recorder: &mut dyn Recorder,
) -> Result<RunReport, Diagnostics> {
    let mut run = Simulation::new(train, scenario, options)?;
    if recorder.columns(&run.columns).is_break() {
        return Ok(run.report());
    }
    if !(h > 0.0 && h.is_finite()) {
        return Err(Diagnostic::new(Code::Unfit, "", format!("a step of {h} s"))
            .hint("a step is longer than zero")
            .into());
    }
    let groups = run.engine.system.groups.len();
    let n = run.x.len();
    let mut x = run.x.clone();
    let mut mode = run.engine.mode.clone();
    run.engine.look(run.t, &x);
    for g in 0..groups {
        mode.slip[g] = if run.engine.group_slip(g) < 0.0 { -1 } else { 1 };
    }
    let recorder = &mut Window::new(run.from, recorder);
    let (start, end) = (run.t, run.engine.system.scenario.end);
    let steps = ((end - start) / h - 1e-9).ceil() as u64;
    let mut k = vec![vec![0.0; n]; 4];
    let mut at = vec![0.0; n];
    run.outcome = Some(Outcome::Finished);
    // The first step has no step before: the sides that agree with the start.
    let mut torques = vec![];
    for _ in 0..8 {
        run.engine.enter(&mode);
        run.engine.solve(run.t, &x);
        torques = run.engine.element_torques();
        run.engine.turn_sides(&mut mode, &torques);
    }
    for step in 0..=steps {
        let t = start + step as f64 * h;
        run.t = t;
        if run.is_row_due(t, h) && tell_row(&mut run.engine, t, &x, &mut run.row, recorder).is_break() {
            run.outcome = Some(Outcome::Interrupted);
        }
        if recorder.progress(t).is_break() {
            run.outcome = Some(Outcome::Interrupted);
        }
        if step == steps || run.outcome != Some(Outcome::Finished) {
            break;
        }
        run.engine.inside = t + 0.5 * h;
        for stage in 0..4 {
            let (part, from) = [(0.0, 0), (0.5, 0), (0.5, 1), (1.0, 2)][stage];
            for i in 0..n {
                at[i] = x[i] + if stage == 0 { 0.0 } else { part * h * k[from][i] };
            }
            run.engine.look(t + part * h, &at);
            for k in 0..run.engine.touch.len() {
                run.engine.touch[k] = run.engine.touch_now(k, &at);
            }
            for g in 0..groups {
                let slip = run.engine.group_slip(g);
                if slip != 0.0 {
                    mode.slip[g] = if slip < 0.0 { -1 } else { 1 };
                }
            }
            // Old forces, new speeds: where the speed reverses, so does the drive.
            run.engine.turn_sides(&mut mode, &torques);
            if mode != run.engine.mode {
                run.engine.enter(&mode);
            }
            let mut rate = std::mem::take(&mut k[stage]);
            run.engine.rate(t + part * h, &at, &mut rate);
            k[stage] = rate;
        }
        let states = run.engine.states();
        for i in 0..n {
            let change = h / 6.0 * (k[0][i] + 2.0 * k[1][i] + 2.0 * k[2][i] + k[3][i]);
            x[i] += change;
            if let Some(sum) = i.checked_sub(states).and_then(|i| run.came_in.get_mut(i)) {
                *sum += change.max(0.0);
            }
        }
        run.engine.solve(t + h, &x);
        torques = run.engine.element_torques();
        run.steps += 1;
        if x.iter().any(|x| !x.is_finite()) {
            let why = format!(
                "the motion is no longer finite at t = {} s: a formula leaves its domain, or the step is too long",
                t + h
            );
            run.outcome = Some(Outcome::NotConverged(why));
        }
    }
    run.engine.look(run.t, &x);
    run.x = x;
    run.notes.push(format!(
        "compatibility: steps of {h} s with the tooth forces' directions of the step before (Galvagno 2010); wrong after \
         each reversal, and nothing sticks"
    ));
    Ok(run.report())
}
