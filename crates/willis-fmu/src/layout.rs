//! The variables of a train in a scenario. A variable's place in the list is its value reference.

use std::collections::HashSet;

use willis::diagnostic::Diagnostics;
use willis::dynamics::{ColumnKind, ColumnUnit, InputKind, Options, Outcome, Simulation};
use willis::model::Model;
use willis::train::Measure;
use willis::units::{self, Dimension};

/// How a host runs the unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interface {
    /// The unit advances itself; the host sets inputs in between.
    CoSimulation,
    /// The host integrates the states.
    ModelExchange,
    /// Either, as the host likes.
    Both,
}

impl Interface {
    /// Whether the unit advances itself.
    pub fn steps(self) -> bool {
        self != Self::ModelExchange
    }

    /// Whether the host may integrate the states.
    pub fn exchanges(self) -> bool {
        self != Self::CoSimulation
    }
}

/// A unit of values: its name, and the exponents of metre, kilogram, second, radian and kelvin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Unit {
    pub name: &'static str,
    pub exponents: [i8; 5],
}

impl Unit {
    /// The SI unit of a dimension, as the reader of train files takes it.
    pub fn of(dimension: Dimension) -> Option<Self> {
        let is_si = |name: &&&str| units::parse(&format!("1 {name}"), dimension).is_ok_and(|q| q.si() == 1.0);
        let name = dimension.units().iter().find(is_si)?;
        Some(Self { name, exponents: dimension.exponents() })
    }

    fn of_column(unit: ColumnUnit) -> Option<Self> {
        let exponents = match unit {
            ColumnUnit::None => return None,
            ColumnUnit::Second => [0, 0, 1, 0, 0],
            ColumnUnit::RadianPerSecond => [0, 0, -1, 1, 0],
            ColumnUnit::Radian => [0, 0, 0, 1, 0],
            ColumnUnit::RadianPerSecondSquared => [0, 0, -2, 1, 0],
            ColumnUnit::NewtonMetre | ColumnUnit::Joule => [2, 1, -2, 0, 0],
            ColumnUnit::Watt => [2, 1, -3, 0, 0],
            _ => return None,
        };
        Some(Self { name: unit.symbol(), exponents })
    }
}

/// What kind of value a variable has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Real(Option<Unit>),
    Integer,
    Mode,
    Verdict,
    Text,
}

/// A value.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Value {
    Real(f64),
    Integer(i64),
}

/// What a variable is. Numbers are places among those of its kind.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Role {
    Time,
    Input(usize),
    /// Rate of a prescribed speed, for hosts that integrate.
    InputRate(usize),
    /// A quantity of the train file: its path.
    Parameter(String),
    Tolerance,
    /// A column of the run.
    Output(usize),
    /// Power lost by one cause.
    Loss(usize),
    Verdict,
    Why,
    Events,
    LastEvent,
    State(usize),
    Rate(usize),
    Indicator(usize),
}

impl Role {
    pub fn is_parameter(&self) -> bool {
        matches!(self, Self::Parameter(_) | Self::Tolerance)
    }

    pub fn is_input(&self) -> bool {
        matches!(self, Self::Input(_) | Self::InputRate(_))
    }

    pub fn is_output(&self) -> bool {
        matches!(self, Self::Output(_) | Self::Loss(_) | Self::Verdict | Self::Why | Self::Events | Self::LastEvent)
    }
}

/// A variable.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Variable {
    pub name: String,
    pub about: String,
    pub role: Role,
    pub kind: Kind,
    /// Of inputs and parameters.
    pub start: Option<Value>,
}

/// How a run is told to have ended: a number and a name. The order is that of the numbers.
pub(crate) const VERDICTS: [&str; 8] = [
    "running",
    "finished",
    "no-solution",
    "several-solutions",
    "too-many-events",
    "not-converged",
    "impact",
    "too-long",
];

/// The number of a verdict.
pub(crate) fn verdict(outcome: Option<&Outcome>) -> i64 {
    match outcome {
        None => 0,
        Some(Outcome::Finished) => 1,
        Some(Outcome::NoSolution(_)) => 2,
        Some(Outcome::SeveralSolutions(_)) => 3,
        Some(Outcome::TooManyEvents(_)) => 4,
        Some(Outcome::Impact(_)) => 6,
        Some(Outcome::TooLong(_)) => 7,
        Some(_) => 5,
    }
}

/// States of motion: names and numbers, as in the rows of a simulation.
pub(crate) const MODES: [(&str, i64); 4] = [("backward", -1), ("stuck", 0), ("forward", 1), ("free", 2)];

/// All variables of a train in a scenario.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Layout {
    pub variables: Vec<Variable>,
    /// Names of inputs, whether each is a prescribed speed; of columns, states and losses.
    pub inputs: Vec<(String, bool)>,
    pub columns: Vec<String>,
    pub states: Vec<String>,
    pub losses: Vec<String>,
    pub indicators: usize,
    /// Start and end of the scenario, s.
    pub span: [f64; 2],
}

/// Relative tolerance of a run, unless told otherwise.
pub(crate) const TOLERANCE: f64 = 1e-10;

/// How a run in the hands of a host is made.
pub(crate) fn options(tolerance: f64, counts_energies: bool) -> Options {
    Options { tolerance, energies: counts_energies, patience_s: f64::INFINITY, ..Options::default() }
}

/// The variables of the inside of a run, which must not change with parameters.
#[derive(PartialEq)]
struct Inside {
    inputs: Vec<(String, bool)>,
    columns: Vec<String>,
    states: Vec<String>,
    losses: Vec<String>,
    indicators: usize,
}

impl Inside {
    fn of(run: &Simulation) -> Self {
        Self {
            inputs: run.inputs().into_iter().map(|i| (i.name, i.kind == InputKind::Speed)).collect(),
            columns: run.columns().iter().map(|c| c.quantity().to_owned()).collect(),
            states: run.states().into_iter().map(|s| s.name).collect(),
            losses: run.loss_causes().into_iter().map(|l| l.name).collect(),
            indicators: run.indicator_count(),
        }
    }
}

impl Layout {
    /// The variables of a scenario.
    ///
    /// # Errors
    /// What keeps the scenario from being run.
    pub fn of(model: &Model, scenario: &str, interface: Interface) -> Result<Self, Diagnostics> {
        let train = model.train();
        let of_scenario = train.find_scenario(scenario)?;
        let span = [of_scenario.start, of_scenario.end];
        let mut run = Simulation::new(train, scenario, &options(TOLERANCE, true))?;
        let Inside { inputs, columns, states, losses, indicators } = Inside::of(&run);
        let mut all = Names::default();
        let seconds = Kind::Real(Unit::of_column(ColumnUnit::Second));
        all.add("time", "Time", Role::Time, seconds, None);
        for (k, info) in run.inputs().into_iter().enumerate() {
            let start = Some(Value::Real(run.worth(info.input)));
            let kind = Kind::Real(Unit::of_column(info.unit));
            let what = match info.kind {
                InputKind::Torque => "Torque of this source on its member",
                InputKind::Speed => "Speed of a member, prescribed",
                InputKind::SetPoint => "Speed that a controller wants",
                InputKind::Throttle => "Throttle, from 0 closed to 1 full",
                InputKind::Grade => "Slope of the road, rise over distance",
                InputKind::Engagement => "How far a shift element is engaged, from 0 to 1",
                _ => "Input",
            };
            let about = format!("{what}. Until it is set it is as the scenario has it");
            all.add(&info.name, &about, Role::Input(k), kind, start);
            if info.kind == InputKind::Speed && interface.exchanges() {
                let kind = Kind::Real(Unit::of_column(ColumnUnit::RadianPerSecondSquared));
                let about = "Rate of the prescribed speed, for a host that integrates the states itself";
                all.add(&format!("{}.rate", info.name), about, Role::InputRate(k), kind, Some(Value::Real(0.0)));
            }
        }
        for (name, path, measure, start) in parameters(model, scenario) {
            let kind = match measure {
                Measure::Quantity(dimension) => Kind::Real(Unit::of(dimension)),
                Measure::Integer => Kind::Integer,
                _ => Kind::Real(None),
            };
            let about = "Quantity of the train file, by its path";
            all.add(&name, about, Role::Parameter(path), kind, Some(start));
        }
        let about = "Relative tolerance of every speed and angle in co-simulation";
        all.add("tolerance", about, Role::Tolerance, Kind::Real(None), Some(Value::Real(TOLERANCE)));
        for (k, column) in run.columns().iter().enumerate() {
            let kind = match column.kind {
                ColumnKind::Time => continue,
                ColumnKind::Mode => Kind::Mode,
                _ => Kind::Real(Unit::of_column(column.unit)),
            };
            all.add(column.quantity(), about_column(column.kind), Role::Output(k), kind, None);
        }
        let watts = Kind::Real(Unit::of_column(ColumnUnit::Watt));
        for (k, cause) in run.loss_causes().into_iter().enumerate() {
            let about = format!("Power that is lost here: {}", cause.kind);
            all.add(&format!("{}.loss", cause.name), &about, Role::Loss(k), watts, None);
        }
        all.add(
            "verdict",
            "0 the run goes on; 1 finished, 2 no solution, 3 several solutions, 4 too many events, 5 not converged, 6 impact, 7 too long",
            Role::Verdict,
            Kind::Verdict,
            None,
        );
        all.add("verdict.why", "The same in words", Role::Why, Kind::Text, None);
        all.add("event_count", "Changes of mode so far, the start among them", Role::Events, Kind::Integer, None);
        all.add("last_event", "The last change of mode, in words", Role::LastEvent, Kind::Text, None);
        if interface.exchanges() {
            for (k, state) in run.states().into_iter().enumerate() {
                let unit = Kind::Real(Unit::of_column(state.unit));
                all.add(&format!("state.{}", state.name), "Continuous state", Role::State(k), unit, None);
            }
            for (k, state) in run.states().into_iter().enumerate() {
                let unit = Kind::Real(Unit::of_column(state.rate_unit));
                all.add(&format!("der(state.{})", state.name), "Its rate", Role::Rate(k), unit, None);
            }
            for k in 0..indicators {
                let about = "The mode of the motion ends where this becomes negative";
                all.add(&format!("indicator.{k}"), about, Role::Indicator(k), Kind::Real(None), None);
            }
        }
        Ok(Self { variables: all.variables, inputs, columns, states, losses, indicators, span })
    }

    /// Whether a run has these inputs, outputs and states.
    pub fn fits(&self, run: &Simulation) -> bool {
        let inside = Inside::of(run);
        inside.inputs == self.inputs
            && inside.columns == self.columns
            && inside.states == self.states
            && inside.losses == self.losses
            && inside.indicators == self.indicators
    }

    /// Places of the variables of a role.
    pub fn places(&self, is: impl Fn(&Role) -> bool) -> Vec<usize> {
        (0..self.variables.len()).filter(|&k| is(&self.variables[k].role)).collect()
    }

    /// The place of the rate of a state.
    pub fn rate(&self, state: usize) -> Option<usize> {
        self.variables.iter().position(|v| v.role == Role::Rate(state))
    }

    /// The place of a state.
    pub fn state(&self, state: usize) -> Option<usize> {
        self.variables.iter().position(|v| v.role == Role::State(state))
    }
}

/// Variables with names of their own.
#[derive(Default)]
struct Names {
    variables: Vec<Variable>,
    taken: HashSet<String>,
}

impl Names {
    fn add(&mut self, name: &str, about: &str, role: Role, kind: Kind, start: Option<Value>) {
        let mut name = name.to_owned();
        if !self.taken.insert(name.clone()) {
            let of = if role.is_parameter() { "train" } else { "run" };
            let long = format!("{of}.{name}");
            let mut all = std::iter::once(long.clone()).chain((2..).map(|k| format!("{long} {k}")));
            name = all.find(|name| self.taken.insert(name.clone())).expect("there is always another number");
        }
        self.variables.push(Variable { name, about: about.to_owned(), role, kind, start });
    }
}

/// The numbers of the train file, without those that are asked of it: name, path, kind, value. Speeds at the start of the
/// scenario are among them.
fn parameters(model: &Model, scenario: &str) -> Vec<(String, String, Measure, Value)> {
    let (document, train) = (model.document(), model.train());
    let number = |name: String, path: String, key: willis::train::Key| {
        let text = document.value(&key)?;
        let value = match key.measure {
            Measure::Quantity(dimension) => Value::Real(units::parse(&text, dimension).ok()?.si()),
            Measure::Number => Value::Real(text.trim().parse().ok().filter(|x: &f64| x.is_finite())?),
            Measure::Integer if path != "format" => Value::Integer(text.trim().parse().ok()?),
            _ => return None,
        };
        Some((name, path, key.measure, value))
    };
    let of_operation = |path: &str| {
        let begins = |name: &str| path.strip_prefix(name).is_some_and(|rest| rest.starts_with('.'));
        begins("operation") || train.operations().iter().any(|o| begins(&o.name))
    };
    let all = document.quantities().into_iter().filter(|(path, _)| !of_operation(path));
    let mut numbers: Vec<_> = all.filter_map(|(path, key)| number(path.clone(), path, key)).collect();
    for &(member, _) in train.find_scenario(scenario).map_or(&[][..], |s| &s.initial_speeds) {
        let name = format!("initial_speeds.{}", train.member_name(member));
        let path = format!("scenario.{scenario}.{name}");
        if let Ok(key) = document.find(&path) {
            numbers.extend(number(name, path, key));
        }
    }
    numbers
}

/// A value as the train file takes it.
pub(crate) fn written(value: &Value, kind: Kind) -> String {
    match (value, kind) {
        (Value::Real(x), Kind::Real(Some(unit))) => format!("{x:?} {}", unit.name),
        (Value::Real(x), _) => format!("{x:?}"),
        (Value::Integer(x), _) => x.to_string(),
    }
}

fn about_column(kind: ColumnKind) -> &'static str {
    match kind {
        ColumnKind::Speed => "Speed of a member",
        ColumnKind::Angle => "Angle that a member has turned through since the start",
        ColumnKind::Acceleration => "Acceleration of a member",
        ColumnKind::Torque => {
            "Torque: of a source on its member, of friction or a shaft on its first member, of a mesh at its first gear, of a \
             variator on a member; no number where it is not determined"
        }
        ColumnKind::Reaction => "Torque with which the frame holds; no number where it is not determined",
        ColumnKind::Power => "Power: of a source, out of a store, through a variator, or lost in all",
        ColumnKind::Mode => "State of motion: -1 backward, 0 stuck, 1 forward, 2 free",
        ColumnKind::Twist => "Twist of a shaft",
        ColumnKind::Efficiency => "Power that goes out over power that comes in; no number where none comes in",
        ColumnKind::Energy => "Energy that is stored, or was lost so far (counted in co-simulation only)",
        ColumnKind::Ratio => "Ratio of a variator",
        _ => "Value of the run",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_dimension_has_its_si_unit() {
        for dimension in [
            Dimension::ANGULAR_SPEED,
            Dimension::TORQUE,
            Dimension::POWER,
            Dimension::LENGTH,
            Dimension::TEMPERATURE,
            Dimension::INERTIA,
            Dimension::STIFFNESS,
            Dimension::VISCOUS,
            Dimension::FLOW,
            Dimension::PRESSURE_COEFFICIENT,
            Dimension::SPECIFIC_HEAT,
            Dimension::TORQUE_PER_SPEED_SQUARED,
        ] {
            let unit = Unit::of(dimension).unwrap_or_else(|| panic!("{dimension:?}"));
            let text = written(&Value::Real(0.1), Kind::Real(Some(unit)));
            assert_eq!(units::parse(&text, dimension).unwrap().si(), 0.1, "{text}");
        }
    }
}
