//! A default operating point for a state in which the file has none, so that every gear can be pictured.

use std::borrow::Cow;

use willis::analysis::{DrivingLoad, Selection};
use willis::train::{Load, MemberId, Train};
use willis::units::{AngularSpeed, Torque};
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
    let (input, _) = ends(train, state)?;
    let load = DrivingLoad::of_file(train, input);
    let load = load.unwrap_or_else(|| DrivingLoad::new(AngularSpeed::rpm(1000.0), Torque::n_m(100.0)));
    let driving = match &load.load {
        Load::Torque(t) => format!("{} N m", digits(t.si())),
        Load::Power(p) => watts(p.si()),
    };
    let rpm = digits(load.speed.si() * RPM);
    let name = format!("default point, {rpm} rpm and {driving} at {}", train.member_name(input));
    Some(unstable::with_operation(train, load.point(train, state, name)?))
}
