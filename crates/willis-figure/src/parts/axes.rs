//! Which quantities a chart of an operating point runs over.

use serde::{Deserialize, Serialize};
use willis::diagnostic::{Code, Diagnostic, Diagnostics};
use willis::model::Model;
use willis::study::{Axis, PointSetup};
use willis::train::{Load, MemberId};
use willis::units::Quantity;

use super::words::along;

/// A quantity along an axis of a chart.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ChartAxis {
    /// Its name, as `sweep --over` takes it: `sun.speed`.
    pub name: String,
    /// The unit of its values; empty for plain numbers.
    pub unit: String,
    /// Its values, ascending.
    pub values: Vec<f64>,
}

impl ChartAxis {
    /// The axis with its values.
    pub fn of(axis: &Axis) -> Self {
        Self {
            name: axis.name.clone(),
            unit: axis.unit.clone(),
            values: (0..axis.len()).map(|k| axis.number(k)).collect(),
        }
    }
}

/// How many points axes have together; 0 where they cannot be read, which is told when the figure is made.
pub fn points(over: &[String], model: &Model) -> usize {
    over.iter().map(|text| Axis::parse(text, model).map_or(0, |a| a.len())).fold(1, usize::saturating_mul)
}

/// Axes as the caller writes them; each must be one of ascending numbers.
pub fn parse(over: &[String], model: &Model) -> Result<Vec<Axis>, Diagnostics> {
    let mut wrong = Diagnostics::default();
    let mut axes = vec![];
    for text in over {
        let refused = |what: &str| Diagnostic::new(Code::BadAxis, "", format!("`{text}`: {what}"));
        match Axis::parse(text, model) {
            Err(d) => wrong.push(*d),
            Ok(a) if a.is_text() => wrong.push(refused("an axis of a chart takes numbers, not words")),
            Ok(a) if a.len() < 2 => wrong.push(refused("an axis of a chart takes two values at least")),
            Ok(a) if a.len() > 400 => wrong.push(refused("an axis of a chart takes 400 values at most")),
            Ok(a) if (1..a.len()).any(|k| a.number(k) <= a.number(k - 1)) => {
                wrong.push(refused("the values of a chart's axis must ascend"));
            }
            Ok(a) => axes.push(a),
        }
    }
    if wrong.has_errors() { Err(wrong) } else { Ok(axes) }
}

/// The largest size of a quantity among the operations, rounded up to two digits; of none, `otherwise`.
fn largest(values: impl Iterator<Item = f64>, otherwise: f64) -> f64 {
    let most = values.fold(0.0f64, |a, v| a.max(v.abs()));
    if most == 0.0 || !most.is_finite() {
        return otherwise;
    }
    let most = 1.2 * most;
    let unit = 10f64.powf(most.log10().floor() - 1.0);
    (most / unit).ceil() * unit
}

/// `from..to` from a twentieth of the largest value on, in the direction that the operating point has.
fn range(name: &str, most: f64, negative: bool, unit: &str, steps: usize) -> String {
    // Twelve digits: no noise of the rounding above.
    let n = |x: f64| format!("{x:.12e}").parse::<f64>().unwrap_or(x);
    match negative {
        false => format!("{name}={} {unit}..{} {unit}:{steps}", n(most / 20.0), n(most)),
        true => format!("{name}={} {unit}..{} {unit}:{steps}", n(-most), n(-most / 20.0)),
    }
}

/// rad/s to a rpm.
pub const RPM: f64 = std::f64::consts::PI / 30.0;

/// Speeds of a member in all operations, rpm.
pub fn most_speed(question: &PointSetup<'_>, member: MemberId) -> f64 {
    let all = question.model().train().operations().iter().flat_map(|o| &o.speeds);
    largest(all.filter(|s| s.0 == member).map(|s| s.1.si() / RPM), 6000.0)
}

/// Torques on a member in all operations, N m.
pub fn most_torque(question: &PointSetup<'_>, member: MemberId) -> f64 {
    let all = question.model().train().operations().iter().flat_map(|o| &o.loads);
    let torques = all.filter(|l| l.0 == member).filter_map(|l| match &l.1 {
        Load::Torque(t) => Some(t.si()),
        Load::Power(_) => None,
    });
    largest(torques, 400.0)
}

fn si(q: &Quantity) -> f64 {
    q.si()
}

/// The speed that a chart of this operating point runs over, where nothing else is asked for.
pub fn usual_speed(question: &PointSetup<'_>, steps: usize) -> String {
    let train = question.model().train();
    match question.base().speeds.first() {
        None => range("input.speed", 6000.0, false, "rpm", steps),
        Some((member, speed)) => {
            let name = format!("{}.speed", train.member_name(*member));
            range(&name, most_speed(question, *member), si(speed) < 0.0, "rpm", steps)
        }
    }
}

/// The load (of a train with several freedoms: the second speed) that a map of this operating point runs over.
pub fn usual_load(question: &PointSetup<'_>, steps: usize) -> String {
    let (train, base) = (question.model().train(), question.base());
    if let [_, (member, speed), ..] = &base.speeds[..] {
        let name = format!("{}.speed", train.member_name(*member));
        return range(&name, most_speed(question, *member), si(speed) < 0.0, "rpm", steps);
    }
    match base.loads.first() {
        None => range("input.torque", 400.0, false, "N m", steps),
        Some((member, Load::Torque(t))) => {
            let name = format!("{}.torque", train.member_name(*member));
            range(&name, most_torque(question, *member), si(t) < 0.0, "N m", steps)
        }
        Some((member, Load::Power(p))) => {
            let name = format!("{}.power", train.member_name(*member));
            let all = train.operations().iter().flat_map(|o| &o.loads).filter(|l| l.0 == *member);
            let powers = all.filter_map(|l| match &l.1 {
                Load::Power(p) => Some(si(p) / 1e3),
                Load::Torque(_) => None,
            });
            range(&name, largest(powers, 100.0), si(p) < 0.0, "kW", steps)
        }
    }
}

/// The operating point in words, and what of it was chosen here.
pub fn basis(question: &PointSetup<'_>, over: &[&Axis]) -> String {
    let train = question.model().train();
    let base = question.base();
    let state = base.state.map(|k| format!(", state {}", train.states()[k].name)).unwrap_or_default();
    let varies: Vec<String> = over.iter().map(|a| along(&a.name)).collect();
    match train.operations().is_empty() {
        false => {
            let verb = if varies.len() == 1 { "varies" } else { "vary" };
            format!("Operation {}{state}; {} {verb}", base.name, varies.join(" and "))
        }
        true => format!("No operation in the file{state}: the range of {} was chosen here", varies.join(" and ")),
    }
}
