//! What must hold before a scenario has equations of motion.

use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::dynamics::source::{MOST_PULSES, shortest_pulse, signals_of};
use crate::kinematics::Configuration;
use crate::train::{ControlKind, Scenario, Signal, SourceKind};

/// An error if meshes constrain each other, or if nothing can move.
pub(super) fn forces_and_freedom(c: &Configuration<'_>, scenario: &Scenario) -> Result<(), Diagnostics> {
    if let Some(meshes) = c.redundant().first() {
        let names: Vec<&str> = meshes.iter().map(|m| c.train.meshes()[m.index()].name.as_str()).collect();
        let message = format!(
            "the forces in {} are not determined: these meshes constrain what others already constrain",
            names.join(", ")
        );
        return Err(unfit(scenario, message, "leave out one of them"));
    }
    if c.degrees_of_freedom() == 0 {
        let message = "nothing can move: what is held in `fixed` holds all members".to_owned();
        return Err(unfit(scenario, message, "leave one of them out of `fixed`"));
    }
    Ok(())
}

/// An error if a signal pulses too often: each pulse stops the integrator.
pub(super) fn pulses(scenario: &Scenario) -> Result<(), Diagnostics> {
    for signal in (scenario.sources.iter().flat_map(|s| signals_of(&s.kind)))
        .chain(scenario.engagements.iter().map(|e| &e.signal))
        .chain(scenario.controls.iter().map(|c| c.kind.signal()))
    {
        if let Some(period) = shortest_pulse(signal)
            && (scenario.end - scenario.start) / period > MOST_PULSES
        {
            let message = format!(
                "a pulse of period {period} s comes {:.1e} times in this scenario, more than {MOST_PULSES:.0e}",
                (scenario.end - scenario.start) / period
            );
            return Err(unfit(scenario, message, "take its mean, or a shorter scenario"));
        }
        if let Some(t) = jumps_too_often(signal, scenario.start, scenario.end) {
            let message = format!(
                "a formula with jumps, as `floor` and `signum` have, jumps too often near t = {t} s, or its values do not \
                 tell when: more than {MOST_PULSES:.0e} times in this scenario"
            );
            return Err(unfit(scenario, message, "let `t` stand once in what is rounded, or take a table or a pulse"));
        }
    }
    Ok(())
}

/// A time near which the breaks of a formula with jumps stand so close that the run would not come past them.
fn jumps_too_often(signal: &Signal, start: f64, end: f64) -> Option<f64> {
    /// Times that are looked at, and breaks after each.
    const LOOKS: [u8; 2] = [4, 8];
    if signal.has_rate() {
        return None;
    }
    let least = f64::from(LOOKS[1]) * (end - start) / MOST_PULSES;
    (0..LOOKS[0]).find_map(|k| {
        // Not at round times, where several jumps may be by intent.
        let t = start + (f64::from(k) + 0.37) / f64::from(LOOKS[0]) * (end - start);
        let last = (0..LOOKS[1]).fold(t, |t, _| if t < end { signal.next_break(t) } else { t });
        (last < end && last - t < least).then_some(t)
    })
}

/// An error if the equations need the rate of a signal that has none.
pub(super) fn rates(scenario: &Scenario) -> Result<(), Diagnostics> {
    for source in &scenario.sources {
        // What is derived by the time.
        let (what, signal) = match &source.kind {
            SourceKind::Speed(signal) => ("a prescribed speed", signal),
            SourceKind::Controller { setpoint, derivative, .. } if *derivative != 0.0 => {
                ("the set point of a controller with a derivative part", setpoint)
            }
            _ => continue,
        };
        let (fault, hint) = if signal.depends_on_speed() {
            ("cannot follow the speeds of members", "let it follow the time, or use a torque")
        } else if !signal.has_rate() {
            ("cannot follow a formula with jumps, as `floor` and `signum` have", "use ramps or a table")
        } else {
            continue;
        };
        let message = format!("`{}`: {what} {fault}", source.name);
        return Err(unfit(scenario, message, hint));
    }
    for control in &scenario.controls {
        if let ControlKind::Ratio { ratio, .. } = &control.kind
            && !ratio.has_rate()
        {
            let message = "a ratio cannot follow a formula with jumps, as `floor` and `signum` have";
            let d = Diagnostic::new(Code::Unfit, control.place.clone(), message);
            return Err(d.hint("use ramps or a table").into());
        }
    }
    Ok(())
}

fn unfit(scenario: &Scenario, message: String, hint: &str) -> Diagnostics {
    Diagnostic::new(Code::Unfit, scenario.place.clone(), message).hint(hint).into()
}
