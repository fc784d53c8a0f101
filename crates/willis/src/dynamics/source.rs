//! Sources: their signals, and the torque that follows from what those are worth.

use crate::train::{MemberId, Scenario, Signal, SourceKind, Train};

/// Standard acceleration of free fall, m/s² (ISO 80000-3).
pub(super) const GRAVITY: f64 = 9.80665;

/// Pulses of one signal in a scenario; each of them stops the integrator twice.
pub(super) const MOST_PULSES: f64 = 1e6;

pub(super) fn shortest_pulse(signal: &Signal) -> Option<f64> {
    match signal {
        Signal::Pulse { period, .. } => Some(*period),
        Signal::Product(of) => of.iter().filter_map(shortest_pulse).min_by(f64::total_cmp),
        _ => None,
    }
}

/// The first formula that has no finite value at a time, in words: whose it is, its text, the time and the value.
pub(super) fn out_of_domain(
    train: &Train,
    scenario: &Scenario,
    t: f64,
    inside: f64,
    speed: &dyn Fn(MemberId) -> f64,
) -> Option<String> {
    let of_sources = scenario.sources.iter().flat_map(|s| signals_of(&s.kind).map(|signal| (s.name.as_str(), signal)));
    let of_elements =
        (scenario.engagements.iter()).map(|e| (train.shift_elements()[e.element.index()].name.as_str(), &e.signal));
    let of_variators = (scenario.controls.iter()).map(|c| (train.variators[c.variator].name.as_str(), c.kind.signal()));
    of_sources.chain(of_elements).chain(of_variators).find_map(|(name, signal)| {
        let (text, value) = signal.not_finite(t, inside, speed)?;
        let value = if value.is_nan() { "not a number".to_owned() } else { value.to_string() };
        Some(format!("`{name}`: the formula \"{text}\" is {value} at t = {t} s"))
    })
}

pub(super) fn signals_of(kind: &SourceKind) -> impl Iterator<Item = &Signal> {
    let [first, second] = match kind {
        SourceKind::Torque(s) | SourceKind::Speed(s) => [Some(s), None],
        SourceKind::Controller { setpoint, feed_forward, .. } => [Some(setpoint), Some(feed_forward)],
        SourceKind::Vehicle { grade, .. } => [Some(grade), None],
        SourceKind::Motor { throttle, .. } => [Some(throttle), None],
        SourceKind::Linear { .. } | SourceKind::Quadratic { .. } => [None, None],
    };
    first.into_iter().chain(second)
}

/// Torque of a source whose member turns at `w` and whose error has the integral `sum`. `value` tells what its first or
/// second signal is worth, `rate` how fast one changes. A prescribed speed has no torque of its own: 0. The derivative of
/// a controller's speed is not in it: it acts through the acceleration.
#[inline]
pub(super) fn source_torque(
    kind: &SourceKind,
    w: f64,
    sum: f64,
    value: impl Fn(usize, &Signal) -> f64,
    rate: impl Fn(&Signal) -> f64,
) -> f64 {
    match kind {
        SourceKind::Torque(signal) => value(0, signal),
        SourceKind::Speed(_) => 0.0,
        SourceKind::Controller { setpoint, feed_forward, proportional, integral, derivative } => {
            let rate = if *derivative == 0.0 { 0.0 } else { rate(setpoint) };
            value(1, feed_forward) + proportional * (value(0, setpoint) - w) + integral * sum + derivative * rate
        }
        SourceKind::Linear { torque, about, slope } => torque - slope * (w - about),
        SourceKind::Quadratic { torque, about, factor, even } => {
            let d = w - about;
            torque - factor * if *even { d * d } else { d * d.abs() }
        }
        SourceKind::Vehicle { mass, wheel_radius, final_drive, drag_area, air_density, grade, .. } => {
            let arm = wheel_radius / final_drive;
            let v = w * arm;
            let grade = value(0, grade);
            let weight = mass * GRAVITY * grade * upright(grade);
            -(0.5 * air_density * drag_area * v * v.abs() + weight) * arm
        }
        SourceKind::Motor { full_load, closed, throttle } => {
            let (low, high) = (closed.at(w), full_load.at(w));
            low + value(0, throttle).clamp(0.0, 1.0) * (high - low)
        }
    }
}

/// Cosine of a slope whose tangent is `grade`: the part of a weight that presses on it.
pub(super) fn upright(grade: f64) -> f64 {
    1.0 / grade.hypot(1.0)
}
