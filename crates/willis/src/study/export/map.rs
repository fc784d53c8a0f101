//! A gear (a state with its input and output) over speed and torque of its input.

use crate::analysis::{
    Direction, OperationReport, Selection, SolutionReport, StateReport, Verdict, analyze, operate, operate_unnamed,
};
use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::exact::Rational;
use crate::kinematics::Configuration;
use crate::train::{AS_DRAWN, Load, MemberId, Operation, Train};
use crate::units::{Dimension, Quantity};

use super::Asked;
use super::names::{short, verdict};

/// The most points of one map.
const MOST_POINTS: usize = 1_000_000;
/// Steps of a speed axis that is chosen here, and of the torque axis on either side of zero.
const STEPS: i64 = 10;

/// A state of a train with one ratio, and the axes on which it is asked.
#[derive(Clone, Debug)]
pub struct Gear {
    /// The train, with nothing but input and output as places where torque may act.
    train: Train,
    /// Position among its states; `None` as drawn.
    state: Option<usize>,
    /// Name of the state; `None` as drawn.
    pub name: Option<String>,
    /// Where power enters when driving.
    pub input: String,
    /// Where power leaves when driving.
    pub output: String,
    ends: [MemberId; 2],
    /// Input over output speed, as a fraction.
    pub exact: String,
    /// The same as a number.
    pub ratio: f64,
    /// Driving, with the efficiencies of the shift table (nominal ones where losses are computed).
    pub drive: Direction,
    /// Coasting, likewise.
    pub coast: Direction,
    /// Speeds of the input.
    pub speeds: Vec<Quantity>,
    /// External torques on the input.
    pub torques: Vec<Quantity>,
    /// Oil temperatures, K; `None` is that of the file.
    pub temperatures: Vec<Option<f64>>,
    /// What is told of axes that were chosen here.
    pub(super) chosen: Vec<String>,
    /// Speed and amount of torque for which one number is told.
    rated: [Quantity; 2],
}

/// An equilibrium of a [`Point`] that can be told as one number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapAnswer {
    /// External torque on the output, N m: negative where it drives a load against a positive speed.
    pub output_torque_n_m: f64,
    /// Loss, W.
    pub loss_w: f64,
    /// Output over input power; absent where nothing is loaded or all is dissipated.
    pub efficiency: Option<f64>,
}

/// A point of a map.
#[derive(Clone, Debug)]
pub struct Point {
    /// Speed of the input, rad/s.
    pub speed_rad_s: f64,
    /// The same, rpm.
    pub speed_rpm: f64,
    /// External torque on the input, N m.
    pub torque_n_m: f64,
    /// What can be said of it.
    pub verdict: Verdict,
    /// Why it has no answer, or what stands beside its answer.
    pub reason: Option<String>,
    /// The equilibrium, where there is one that delivers power, or only one.
    pub answer: Option<MapAnswer>,
    /// Everything about the equilibrium.
    pub solution: Option<Box<SolutionReport>>,
}

impl Point {
    /// Loss over input speed, N m: the torque that is lost, seen at the input.
    pub fn loss_torque(&self) -> Option<f64> {
        self.answer.map(|a| a.loss_w / self.speed_rad_s.abs())
    }
}

/// A gear over speed and torque, speed by speed.
#[derive(Clone, Debug)]
pub struct Map {
    /// Points of one speed and rising torque each.
    pub rows: Vec<Vec<Point>>,
}

impl Map {
    /// The first point without an answer.
    pub fn gap(&self) -> Option<&Point> {
        self.rows.iter().flatten().find(|p| p.answer.is_none())
    }
}

impl Gear {
    /// `state 1`, or `as drawn`.
    pub fn title(&self) -> String {
        self.name.as_ref().map_or_else(|| AS_DRAWN.to_owned(), |n| format!("state {n}"))
    }

    /// Whether losses are computed: they then depend on speed and load.
    pub fn is_physical(&self) -> bool {
        self.train.is_physical()
    }

    /// The error that this gear cannot be written, and why.
    pub(super) fn refuse(&self, why: impl AsRef<str>, hint: &str) -> Diagnostics {
        let d = Diagnostic::new(Code::Unfit, "", format!("{}: {}", self.title(), why.as_ref()));
        if hint.is_empty() { d.into() } else { d.hint(hint).into() }
    }

    /// The map at a temperature.
    ///
    /// # Errors
    /// What an operating point prescribes wrongly.
    pub fn map(&self, temperature: Option<f64>) -> Result<Map, Diagnostics> {
        let row = |speed: &Quantity| self.torques.iter().map(|torque| self.point(speed, torque, temperature)).collect();
        Ok(Map { rows: self.speeds.iter().map(row).collect::<Result<_, Diagnostics>>()? })
    }

    /// One point.
    ///
    /// # Errors
    /// What the operating point prescribes wrongly.
    pub fn point(&self, speed: &Quantity, torque: &Quantity, temperature: Option<f64>) -> Result<Point, Diagnostics> {
        let [input, output] = self.ends;
        let engaged = self.state.map_or(&[][..], |k| &self.train.states[k].engaged);
        let c = Configuration::new(&self.train, engaged, &[], &[]);
        let mut point = Point {
            speed_rad_s: speed.si(),
            speed_rpm: rpm(speed),
            torque_n_m: torque.si(),
            verdict: Verdict::Undetermined,
            reason: None,
            answer: None,
            solution: None,
        };
        if c.node(input) == c.node(output) && !self.train.is_physical() {
            // One piece: the torque goes through.
            point.verdict = if torque.value.is_zero() { Verdict::Unloaded } else { Verdict::Unique };
            let efficiency = (!torque.value.is_zero()).then_some(1.0);
            point.answer = Some(MapAnswer { output_torque_n_m: -point.torque_n_m, loss_w: 0.0, efficiency });
            return Ok(point);
        }
        let operation = Operation {
            name: format!("{} at {} rpm and {} N m", self.title(), short(point.speed_rpm), short(point.torque_n_m)),
            state: self.state,
            speeds: vec![(input, speed.clone())],
            fixed: vec![],
            loads: vec![(input, Load::Torque(torque.clone()))],
            stores: vec![],
            machines: vec![],
            temperature,
            place: String::new(),
        };
        let (report, _) =
            operate_unnamed(&self.train, &operation).map_err(|wrong| crate::analysis::named(&operation, wrong))?;
        self.read(report, &mut point);
        Ok(point)
    }

    /// Takes the answer from a report: the only equilibrium, or the only one in which a load is driven.
    fn read(&self, report: OperationReport, point: &mut Point) {
        point.verdict = report.verdict;
        point.reason = report.reason;
        let several = report.solutions.len();
        let delivers = |s: &&SolutionReport| !s.all_dissipated && s.output_power_w > 0.0;
        let chosen = match report.verdict {
            Verdict::Unique | Verdict::Unloaded => report.solutions.first(),
            Verdict::Multiple => {
                let mut driving = report.solutions.iter().filter(delivers);
                driving.next().filter(|_| driving.next().is_none())
            }
            _ => None,
        };
        if let (Some(_), Verdict::Multiple) = (chosen, report.verdict) {
            point.reason = Some(format!(
                "of {several} equilibria this is the one that drives a load; in the others everything is dissipated"
            ));
        }
        let Some(solution) = chosen else { return };
        let torque = solution.members.get(&self.output).and_then(|m| m.torque_n_m);
        let Some(output_torque_n_m) = torque else {
            point.reason = Some(format!("statics cannot tell the torque on {}", self.output));
            return;
        };
        let efficiency = solution.efficiency.filter(|_| !solution.all_dissipated && solution.output_power_w > 0.0);
        point.answer = Some(MapAnswer { output_torque_n_m, loss_w: solution.loss_w, efficiency });
        point.solution = Some(Box::new(solution.clone()));
    }

    /// The error about a point without an answer.
    pub(super) fn gap(&self, point: &Point, hint: &str) -> Diagnostics {
        let why = point.reason.as_deref().unwrap_or("no single equilibrium");
        let at = format!("{} rpm and {} N m at {}", short(point.speed_rpm), short(point.torque_n_m), self.input);
        self.refuse(format!("{} at {at}: {why}; no number is made up for it", verdict(point.verdict)), hint)
    }

    /// Whether some torque of the axis is positive, and some negative.
    pub(super) fn signs(&self) -> [bool; 2] {
        [1, -1].map(|s| self.torques.iter().any(|t| t.value.sign() == s))
    }

    /// The speed and the driving (or coasting) torque for which one number is told: that of the operations, else the
    /// largest of the axes.
    pub(super) fn rated(&self, coasting: bool) -> Option<(Quantity, Quantity)> {
        let [speed, torque] = &self.rated;
        let sign = if coasting { -1 } else { 1 };
        let within = self.torques.iter().any(|t| t.value.sign() == sign);
        let value = &torque.value * &Rational::from(i64::from(sign));
        (within && speed.value.sign() > 0).then(|| (speed.clone(), Quantity { value, ..torque.clone() }))
    }

    /// All inertias as one at the output, kg m²; or why that is not known. A part of it would be taken for the whole.
    pub(super) fn inertia_at_output(&self) -> Result<f64, String> {
        let train = &self.train;
        if !train.unplaced_masses().is_empty() {
            return Err(format!(
                "the planets {} have a mass, and how far from the axis they turn is not known (give `orbit_radius`, or \
                 the module of the teeth)",
                train.unplaced_masses().join(", ")
            ));
        }
        let given: Vec<_> = train.inertias.iter().filter(|i| i.value > 0.0).collect();
        if given.is_empty() {
            return Err("no inertias are given in the file".into());
        }
        let keep: Vec<MemberId> = given.iter().flat_map(|i| [i.member, i.reference]).collect();
        let engaged = self.state.map_or(&[][..], |k| &train.states[k].engaged);
        let transfer = Configuration::new(train, engaged, &[], &keep).transfer(&[self.ends[0]]);
        let speed = |m: MemberId| {
            let speed = transfer.speeds[m.0].as_ref().map(|w| w[0].clone());
            speed.ok_or_else(|| {
                format!(
                    "the speed of `{}`, which has an inertia, does not follow from the input's",
                    train.member_name(m)
                )
            })
        };
        let output = speed(self.ends[1])?;
        given.iter().try_fold(0.0, |sum, i| {
            let relative = ((speed(i.member)? - speed(i.reference)?) / output.clone()).to_f64();
            Ok(sum + i.value * relative * relative)
        })
    }

    /// The sets of the train and their meshes, by position.
    pub(super) fn train(&self) -> &Train {
        &self.train
    }
}

/// Revolutions a minute; exact where they were given so.
pub(super) fn rpm(q: &Quantity) -> f64 {
    match q.pi_power {
        1 => (&q.value * &Rational::from(30)).to_f64(),
        _ => q.si() * 30.0 / std::f64::consts::PI,
    }
}

fn wrong(code: Code, message: impl Into<String>, hint: impl Into<String>) -> Diagnostics {
    Diagnostic::new(code, "", message).hint(hint).into()
}

/// The states that are asked for; `None` for the train as drawn.
pub(super) fn chosen(train: &Train, request: &Asked) -> Result<Vec<Option<usize>>, Diagnostics> {
    let names: Vec<&str> = train.states.iter().map(|s| s.name.as_str()).collect();
    Ok(match (&request.state, request.at.as_ref().and_then(|o| o.state)) {
        (Some(name), own) => {
            let k = train.find_state(name)?;
            if let (Some(o), true) = (&request.at, own != Some(k)) {
                let message = format!("the operation `{}` does not run in state `{name}`", o.name);
                return Err(wrong(Code::UnknownSelection, message, "leave out one of the two"));
            }
            vec![Some(k)]
        }
        _ if names.is_empty() => vec![None],
        _ if request.all_states => (0..names.len()).map(Some).collect(),
        (None, Some(k)) => vec![Some(k)],
        (None, None) if names.len() == 1 => vec![Some(0)],
        (None, None) => {
            let message = format!("the train has {} states, and none is chosen", names.len());
            let hint = format!("name one of {}; or take all of them", names.join(", "));
            return Err(wrong(Code::UnknownSelection, message, hint));
        }
    })
}

/// The gears that are asked for, with their axes, and what must be told of the choice.
pub(super) fn gears(train: &Train, request: &Asked) -> Result<(Vec<Gear>, Vec<String>), Diagnostics> {
    let operation = match &request.operation {
        None => None,
        Some(name) => Some(train.find_operation(name)?),
    };
    check(train, request)?;
    let names: Vec<&str> = train.states.iter().map(|s| s.name.as_str()).collect();
    let chosen = chosen(train, &Asked { at: operation.cloned(), ..request.clone() })?;
    // The shift table alone: operations have no part in it.
    let bare = Train { operations: vec![], ..train.clone() };
    let table = analyze(&bare, &Selection::default())?;
    let mut gears = Vec::new();
    let mut notes = Vec::new();
    let mut errors = Diagnostics::default();
    let row_of = |k: Option<usize>| table.ratios.get(k.map_or(AS_DRAWN, |k| names[k]));
    let can = |r: &StateReport| r.exact.is_some() && r.value.is_some();
    let exportable: Vec<&str> = table.ratios.iter().filter(|(_, r)| can(r)).map(|(n, _)| n.as_str()).collect();
    for k in chosen {
        let title = k.map_or_else(|| AS_DRAWN.to_owned(), |k| format!("state {}", names[k]));
        let Some(row) = row_of(k).filter(|r| can(r)) else {
            let why = match row_of(k) {
                None => "it has no input and output".to_owned(),
                Some(r) => r.no_ratio.clone().unwrap_or_else(|| "its ratio is beyond floating point".into()),
            };
            let d = Diagnostic::new(Code::Unfit, "", format!("{title} has no single ratio to export: {why}"));
            let hint = match (exportable.as_slice(), train.states.is_empty()) {
                ([], true) => "give the train a state in which one freedom is left".to_owned(),
                ([], false) => "close one more shift element in a state, so that one freedom is left".to_owned(),
                (states, _) => format!("states that can be exported: {}", states.join(", ")),
            };
            if request.all_states {
                notes.push(format!("left out: {}", d.message));
            }
            errors.push(d.hint(hint));
            continue;
        };
        match gear(train, k, row, request, operation) {
            Ok(gear) => gears.push(gear),
            Err(d) => errors.extend(d),
        }
    }
    let only_left_out = request.all_states && !gears.is_empty();
    if errors.has_errors() && !only_left_out {
        return Err(errors);
    }
    Ok((gears, notes))
}

/// A request for the ends of the ranges alone: enough to see what a number depends on.
pub(super) fn ends(train: &Train, asked: &Asked) -> Asked {
    let Ok((gears, _)) = gears(train, asked) else { return asked.clone() };
    let Some(gear) = gears.first() else { return asked.clone() };
    let of = |all: &[Quantity]| {
        let mut ends: Vec<_> = all.first().into_iter().chain(all.last().filter(|_| all.len() > 1)).cloned().collect();
        ends.dedup_by(|a, b| a.si() == b.si());
        ends
    };
    let moving: Vec<_> = gear.speeds.iter().filter(|s| s.value.sign() > 0).cloned().collect();
    Asked {
        state: if asked.all_states { None } else { gear.name.clone() },
        operation: None,
        speeds: of(if moving.is_empty() { &gear.speeds } else { &moving }),
        torques: of(&gear.torques),
        ..asked.clone()
    }
}

/// What can be wrong with a request before anything is computed.
fn check(train: &Train, request: &Asked) -> Result<(), Diagnostics> {
    let rising = |q: &[Quantity]| q.windows(2).all(|w| w[0].si() < w[1].si());
    for (what, axis) in [("speeds", &request.speeds), ("torques", &request.torques)] {
        if !rising(axis) {
            return Err(wrong(Code::OutOfRange, format!("the {what} do not rise"), "give each once, smallest first"));
        }
    }
    if request.temperatures.windows(2).any(|w| w[0] >= w[1]) {
        return Err(wrong(Code::OutOfRange, "the temperatures do not rise", "give each once, smallest first"));
    }
    if !request.temperatures.is_empty() && train.lubrication.is_none() {
        let message = "a temperature is given, but the train has no oil";
        return Err(wrong(Code::MissingKey, message, "add [oil] with a name of the catalogue, or its viscosities"));
    }
    if let Some(t) = request.temperatures.iter().find(|t| !(200.0..=600.0).contains(*t)) {
        let message = format!("an oil temperature of {:.1} °C is none that a gearbox has", t - 273.15);
        return Err(wrong(Code::OutOfRange, message, "from -73 to 327 °C is computed"));
    }
    let points = request.speeds.len().max(1) * request.torques.len().max(1) * request.temperatures.len().max(1);
    if points > MOST_POINTS {
        let message = format!("{points} points are more than a map of {MOST_POINTS} holds");
        return Err(wrong(Code::TooLarge, message, "take fewer"));
    }
    Ok(())
}

fn gear(
    train: &Train,
    state: Option<usize>,
    row: &StateReport,
    request: &Asked,
    operation: Option<&Operation>,
) -> Result<Gear, Diagnostics> {
    let member = |name: &str| train.member(name).expect("a member of the train");
    let ends = [member(&row.input), member(&row.output)];
    let mut own = train.clone();
    own.terminals = ends.to_vec();
    let temperatures = match request.temperatures.as_slice() {
        [] => vec![None],
        all => all.iter().copied().map(Some).collect(),
    };
    let last = |axis: &[Quantity], dimension| {
        let zero = Quantity { value: Rational::ZERO, pi_power: 0, dimension };
        axis.last().cloned().unwrap_or(zero)
    };
    let most = request.torques.iter().max_by(|a, b| a.si().abs().total_cmp(&b.si().abs()));
    let torque = most.map(|q| Quantity { value: q.value.abs(), ..q.clone() });
    let rated = [
        last(&request.speeds, Dimension::ANGULAR_SPEED),
        torque.unwrap_or(Quantity { value: Rational::ZERO, pi_power: 0, dimension: Dimension::TORQUE }),
    ];
    let mut gear = Gear {
        train: own,
        state,
        name: state.map(|k| train.states[k].name.clone()),
        input: row.input.clone(),
        output: row.output.clone(),
        ends,
        exact: row.exact.as_ref().expect("a ratio").to_fraction(),
        ratio: row.value.expect("a ratio"),
        drive: row.drive.clone(),
        coast: row.coast.clone(),
        speeds: request.speeds.clone(),
        torques: request.torques.clone(),
        temperatures,
        chosen: vec![],
        rated,
    };
    if gear.speeds.is_empty() || gear.torques.is_empty() {
        let ([speed, torque], from) = reach(train, &gear, operation);
        let title = gear.title();
        let value = |top: &Rational, k: i64| top * &Rational::new(k, STEPS);
        if gear.speeds.is_empty() {
            let of = |rpm: Rational| Quantity {
                value: rpm / Rational::from(30),
                pi_power: 1,
                dimension: Dimension::ANGULAR_SPEED,
            };
            let top = round_up(speed);
            gear.speeds = (1..=STEPS).map(|k| of(value(&top, k))).collect();
            gear.rated[0] = of(twelve_digits(speed));
            let [low, high] = [1, STEPS].map(|k| short(value(&top, k).to_f64()));
            gear.chosen
                .push(format!("{title}: speeds of {}: {low} to {high} rpm in {STEPS} steps, {from}", gear.input));
        }
        if gear.torques.is_empty() {
            let of = |value: Rational| Quantity { value, pi_power: 0, dimension: Dimension::TORQUE };
            let top = round_up(torque);
            gear.torques = (-STEPS..=STEPS).map(|k| of(value(&top, k))).collect();
            gear.rated[1] = of(twelve_digits(torque));
            let most = short(top.to_f64());
            gear.chosen.push(format!(
                "{title}: torques on {}: -{most} to {most} N m in {} steps, {from}",
                gear.input,
                2 * STEPS
            ));
        }
    }
    Ok(gear)
}

/// A number that was computed, to twelve digits.
fn twelve_digits(x: f64) -> Rational {
    format!("{x:.11e}").parse().ok().and_then(Rational::from_f64).unwrap_or(Rational::ZERO)
}

/// The largest speed (rpm) and torque at the input in the operations, and where they come from.
fn reach(train: &Train, gear: &Gear, operation: Option<&Operation>) -> ([f64; 2], String) {
    let mut most = [0.0f64; 2];
    let take = |most: &mut [f64; 2], o: &Operation| {
        let Ok((report, _)) = operate(train, o) else { return };
        if let Some(w) = report.speeds_rad_s.get(&gear.input).copied().flatten() {
            most[0] = most[0].max(w.abs() * 30.0 / std::f64::consts::PI);
        }
        let solutions = report.solutions.iter().chain(&report.dissipative_solutions);
        for torque in solutions.filter_map(|s| s.members.get(&gear.input)?.torque_n_m) {
            most[1] = most[1].max(torque.abs());
        }
    };
    let own: Vec<&Operation> = match operation {
        Some(o) => vec![o],
        None => train.operations.iter().filter(|o| o.state == gear.state).collect(),
    };
    own.iter().for_each(|o| take(&mut most, o));
    if most.iter().all(|x| *x > 0.0) {
        let what = match own.as_slice() {
            [o] => format!("from the operation `{}`", o.name),
            _ => "from the operations of this state".to_owned(),
        };
        return (most, what);
    }
    if operation.is_none() {
        train.operations.iter().for_each(|o| take(&mut most, o));
    }
    let from = match most.iter().all(|x| *x > 0.0) {
        true => "from the operations of the file".to_owned(),
        false => "chosen here: no operation of the file tells both".to_owned(),
    };
    let otherwise = [3000.0, 100.0];
    ([0, 1].map(|k| if most[k] > 0.0 { most[k] } else { otherwise[k] }), from)
}

/// The next larger number of two digits.
fn round_up(x: f64) -> Rational {
    let exponent = x.log10().floor() as i32 - 1;
    let unit = |e: i32| (0..e.unsigned_abs()).fold(Rational::ONE, |u, _| u * Rational::from(10));
    let digits = (x / 10f64.powi(exponent) - 1e-6).ceil() as i64;
    let digits = Rational::from(digits);
    if exponent >= 0 { digits * unit(exponent) } else { digits / unit(exponent) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_digits_upward() {
        for (x, up) in [(500.0, "500"), (1591.549, "1600"), (0.0321, "33/1000"), (9.99, "10"), (2200.0, "2200")] {
            assert_eq!(round_up(x).to_string(), up, "{x}");
        }
    }
}
