//! Losses without load, gear by gear: what turning alone takes.

pub mod draw;

use serde::{Deserialize, Serialize};
use willis::analysis::{DrivingLoad, idle, operate_unnamed};
use willis::diagnostic::{Code, Diagnostic, Diagnostics};
use willis::model::Model;
use willis::operating_point::LossKind;
use willis::study::{PointAnswer, PointVerdict};
use willis::train::{MemberId, Train};
use willis::units::AngularSpeed;
use willis::work::Effort;

use crate::kind::{Ask, FigureRequest, Kind};
use crate::parts::axes::RPM;
use crate::parts::point::ends;

pub(crate) const KIND: Kind<SpinLosses> = Kind {
    title: "Losses without load",
    takes: &[Ask::State, Ask::Operation],
    effort,
    applies: Some(|model| !gears(model.train(), None).is_empty()),
    make: |m, r| spin_losses(m.train(), r.state.as_deref(), r.operation.as_deref()),
    steps: None,
    draw: draw::draw_on,
};

fn effort(model: &Model, _: &FigureRequest) -> Effort {
    // Under load, for the temperature of the oil, and without.
    Effort::of_points(model.train(), 2 * model.train().states().len().max(1) as u64)
}

/// What each gear loses while its output is free of torque.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SpinLosses {
    /// The train.
    pub title: String,
    /// Speed of the input in all gears, rpm.
    pub speed_rpm: f64,
    /// The operating point of the file that has this speed; absent where it was chosen here.
    pub of_operation: Option<String>,
    /// The gears, in the order of the file; one named `as drawn` of a train without states.
    pub gears: Vec<SpinGear>,
}

/// A gear without load.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SpinGear {
    /// The state.
    pub state: String,
    /// The member that is driven.
    pub input: String,
    /// Oil temperature, K: that under the load of the operating point; absent without such a load, or without an oil.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub oil_k: Option<f64>,
    /// What can be said of it: `unloaded` where nothing is lost.
    pub verdict: PointVerdict,
    /// Torque that turns the input, N m; absent where there is no single answer.
    pub torque_n_m: Option<f64>,
    /// All losses, W; absent where there is no single answer.
    pub loss_w: Option<f64>,
    /// The losses by source, the largest first.
    pub sources: Vec<SpinSource>,
}

/// A loss of a gear without load.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SpinSource {
    /// What loses it.
    pub name: String,
    /// What kind of loss it is.
    pub kind: LossKind,
    /// W.
    pub loss_w: f64,
}

/// The states with an input and an output; a train without states is one.
fn gears(train: &Train, state: Option<&str>) -> Vec<(Option<usize>, MemberId, MemberId)> {
    let all: Vec<Option<usize>> = match train.states().len() {
        0 => vec![None],
        n => (0..n).map(Some).collect(),
    };
    let wanted = |k: &Option<usize>| state.is_none_or(|name| k.is_some_and(|k| train.states()[k].name == name));
    all.into_iter().filter(wanted).filter_map(|k| ends(train, k).map(|(input, output)| (k, input, output))).collect()
}

/// Losses without load: the input of every gear turns at the speed of the operating point (of the file's first in which it
/// drives, or that prescribes it; without one at 1000 rpm) in oil as warm as under the load of that point, and no torque acts on
/// any other terminal. What is lost then is what bearings, seals, open shift elements, an oil pump, and gears and rotors in air or
/// oil take, and what their drag makes the teeth lose.
///
/// # Errors
/// No such state or operation; no input and output.
///
/// # Example
/// ```
/// use willis::model::Model;
/// use willis_figure::spin_losses;
///
/// let text = r#"
///     format = 1
///     name = "one set"
///     members = ["s", "c"]
///     terminals = ["s", "c"]
///     [[set]]
///     name = "P1"
///     sun = { member = "s", teeth = 30 }
///     planet = { teeth = 20, count = 4 }
///     ring = { member = "frame", teeth = 70 }
///     carrier = "c"
///     mesh_efficiency = 0.99
///     [oil]
///     viscosity_40 = "100 mm^2/s"
///     viscosity_100 = "11 mm^2/s"
///     temperature = "60 degC"
///     [[seal]]
///     name = "input seal"
///     members = ["s"]
///     diameter = "50 mm"
/// "#;
/// let model = Model::from_toml(text).unwrap();
/// let spin = spin_losses(model.train(), None, None)?;
/// assert_eq!(spin.gears[0].sources[0].name, "input seal");
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn spin_losses(train: &Train, state: Option<&str>, operation: Option<&str>) -> Result<SpinLosses, Diagnostics> {
    state.map(|name| train.find_state(name)).transpose()?;
    let asked = operation.map(|name| train.find_operation(name)).transpose()?;
    let all = gears(train, state);
    let Some(first) = all.first() else {
        let d = Diagnostic::new(Code::Unfit, "", "losses without load need an input and an output, and there are none");
        return Err(d.hint("name them with `input` and `output`, or give two `terminals`").into());
    };
    let mut loads: Vec<(MemberId, Option<DrivingLoad>)> = vec![];
    for (_, input, _) in &all {
        if loads.iter().all(|(known, _)| known != input) {
            let load = match asked {
                Some(operation) => DrivingLoad::of_operation(train, operation, *input),
                None => DrivingLoad::of_file(train, *input),
            };
            loads.push((*input, load));
        }
    }
    let load_of = |input: MemberId| loads.iter().find(|(known, _)| *known == input).and_then(|(_, load)| load.clone());
    // Of an operation that says how fast the input turns, though it does not drive.
    let turns = || {
        let operations = train.operations().iter().filter(|o| asked.is_none_or(|asked| asked.name == o.name));
        let mut speeds = operations.filter_map(|o| Some((o, o.speeds.iter().find(|s| s.0 == first.1)?.1.clone())));
        speeds.next().filter(|(_, speed)| speed.si() != 0.0)
    };
    let (of_operation, speed) = match (load_of(first.1), turns()) {
        (Some(load), _) => (load.operation, load.speed),
        (None, Some((o, speed))) => (Some(o.name.clone()), speed),
        (None, None) => (None, AngularSpeed::rpm(1000.0).into()),
    };
    let gear = |(state, input, _): &(Option<usize>, MemberId, MemberId)| {
        // As warm as under load, as in the table of all gears.
        let loaded = load_of(*input)
            .and_then(|load| DrivingLoad { speed: speed.clone(), ..load }.point(train, *state, "at load"));
        let oil_k = loaded.and_then(|point| operate_unnamed(train, &point).ok()?.0.oil_k(train, &point));
        let answer = idle(train, *state, &speed, oil_k).map(|point| PointAnswer::of(train, &point));
        let verdict = answer.as_ref().map_or(PointVerdict::Undetermined, |a| a.verdict);
        let name = train.member_name(*input);
        let known = matches!(verdict, PointVerdict::Unique | PointVerdict::Unloaded);
        let solution = answer.as_ref().and_then(|a| a.solution.as_ref()).filter(|_| known);
        let mut sources: Vec<SpinSource> = solution
            .map(|s| s.sources.iter())
            .into_iter()
            .flatten()
            .filter(|x| x.loss_w > 0.0)
            .map(|x| SpinSource { name: x.name.clone(), kind: x.kind, loss_w: x.loss_w })
            .collect();
        sources.sort_by(|a, b| b.loss_w.total_cmp(&a.loss_w));
        SpinGear {
            state: state.map_or("as drawn".to_owned(), |k| train.states()[k].name.clone()),
            input: name.to_owned(),
            oil_k,
            verdict,
            torque_n_m: solution.and_then(|s| s.members.get(name)?.torque_n_m),
            loss_w: solution.map(|s| s.loss_w),
            sources,
        }
    };
    Ok(SpinLosses {
        title: train.name().to_owned(),
        speed_rpm: speed.si() / RPM,
        of_operation,
        gears: all.iter().map(gear).collect(),
    })
}
