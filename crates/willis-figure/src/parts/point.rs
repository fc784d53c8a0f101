//! A default operating point for a state in which the file has none, so that every gear can be pictured.

use std::borrow::Cow;

use willis::analysis::Selection;
use willis::exact::Rational;
use willis::kinematics::Configuration;
use willis::train::{Load, MemberId, Train};
use willis::units::{Dimension, Quantity};
use willis::unstable;

use crate::parts::style::{digits, watts};

const RPM: f64 = 30.0 / std::f64::consts::PI;

/// The train, with an operating point where the selection has none: the state's input drives at the speed and load that it
/// has in the file's first operation that drives it, else at 1000 rpm and 100 N m. The point's name says so. A state whose
/// output does not follow its input has no such point.
pub fn pointed<'t>(train: &'t Train, selection: &Selection) -> Cow<'t, Train> {
    let state = match selection.state.as_deref() {
        _ if selection.operation.is_some() => return Cow::Borrowed(train),
        Some(name) => train.find_state(name).ok(),
        None => (!train.states().is_empty()).then_some(0),
    };
    let known = match selection.state {
        Some(_) => train.operations().iter().any(|o| o.state == state),
        None => !train.operations().is_empty(),
    };
    match known {
        true => Cow::Borrowed(train),
        false => driven(train, state).map_or(Cow::Borrowed(train), Cow::Owned),
    }
}

/// Where power enters and leaves in a state, driving.
pub fn ends(train: &Train, state: Option<usize>) -> Option<(MemberId, MemberId)> {
    let [input, output] = train.ends(state);
    Some((input?, output?)).filter(|(input, output)| input != output)
}

fn driven(train: &Train, state: Option<usize>) -> Option<Train> {
    let (input, output) = ends(train, state)?;
    let engaged = state.map_or(&[][..], |k| &train.states()[k].engaged);
    let transfer = Configuration::new(train, engaged, &[], &[]).transfer(&[input]);
    let turns = transfer.speeds[output.index()].as_ref().is_some_and(|w| !w[0].is_zero());
    if !turns || !transfer.conflicts.is_empty() {
        return None;
    }
    let of_file = train.operations().iter().find_map(|o| {
        let speed = &o.speeds.iter().find(|s| s.0 == input)?.1;
        let load = &o.loads.iter().find(|l| l.0 == input)?.1;
        let power = match load {
            Load::Torque(t) => t.si() * speed.si(),
            Load::Power(p) => p.si(),
        };
        (power > 0.0).then(|| (speed.clone(), load.clone()))
    });
    let (speed, load) = of_file.unwrap_or_else(|| {
        let torque = Quantity { value: Rational::from(100), pi_power: 0, dimension: Dimension::TORQUE };
        // 1000 rpm are 1000 π/30 rad/s.
        let speed = Quantity { value: Rational::new(100, 3), pi_power: 1, dimension: Dimension::ANGULAR_SPEED };
        (speed, Load::Torque(torque))
    });
    let driving = match &load {
        Load::Torque(t) => format!("{} N m", digits(t.si())),
        Load::Power(p) => watts(p.si()),
    };
    let name = format!("default point, {} rpm and {driving} at {}", digits(speed.si() * RPM), train.member_name(input));
    let none = Quantity { value: Rational::ZERO, pi_power: 0, dimension: Dimension::TORQUE };
    let idle = train.terminals().iter().filter(|m| **m != input && **m != output);
    let loads = std::iter::once((input, load)).chain(idle.map(|m| (*m, Load::Torque(none.clone())))).collect();
    Some(unstable::with_operation(train, unstable::operation(name, state, vec![(input, speed)], loads)))
}
