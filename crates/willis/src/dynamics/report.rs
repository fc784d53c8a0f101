//! What a simulation is asked, and what it answers: the results contract `willis-simulation-1`.

use std::fmt;
use std::ops::ControlFlow;

use serde::{Deserialize, Serialize};

use crate::contract::{Contract, Format};
use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::named::NameMap;
use crate::power_flow::{BeyondLimit, LimitedQuantity};
use crate::train::Scenario;
use crate::units::without_unit;
use crate::work::{Serial, Work as _};

/// How to run a scenario.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// How to advance in time.
    pub method: Method,
    /// Relative tolerance of the adaptive methods, on every speed and angle.
    pub tolerance: f64,
    /// The most changes of mode within a thousandth of the scenario's length.
    pub most_events: usize,
    /// Go on with one of the solutions where the forces have several, instead of stopping there.
    pub continue_when_ambiguous: bool,
    /// The sign of each tooth force is that of the step before (Galvagno 2010, section 5): compatibility
    /// with the paper, to show its error. With [`Method::Fixed`] only.
    pub lagged_forces: bool,
    /// Whether to count where the energy goes. Without it the report has no energies, and the run is faster.
    pub energies: bool,
    /// How many rows; that of the scenario unless given.
    pub samples: Option<usize>,
    /// Rows and events from this time on, s; from the start unless given. The run begins at the start in any case, and
    /// its energies are those of the whole run.
    pub from_s: Option<f64>,
    /// Where the run ends, s, instead of at the end of the scenario.
    pub to_s: Option<f64>,
    /// Work of one core, s, that a run may take, by a count of its steps and changes of mode: one that would take longer at
    /// its pace ends with [`Outcome::TooLong`]. Infinite: however long it takes.
    pub patience_s: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            method: Method::Adaptive,
            tolerance: 1e-10,
            most_events: 1000,
            continue_when_ambiguous: false,
            lagged_forces: false,
            energies: true,
            samples: None,
            from_s: None,
            to_s: None,
            patience_s: Serial.patience(),
        }
    }
}

impl Options {
    /// All that is wrong with them, whoever asks.
    pub(super) fn check(&self) -> Result<(), Diagnostics> {
        let mut wrong = Diagnostics::default();
        let mut refuse = |message: String, hint: &str| {
            wrong.push(Diagnostic::new(Code::OutOfRange, "", message).hint(hint));
        };
        if !(1e-13..=1e-2).contains(&self.tolerance) {
            refuse(
                format!("a relative tolerance of {} cannot be kept", self.tolerance),
                "from 1e-13 to 1e-2, as in 1e-9",
            );
        }
        if let Some(n @ 0..2) = self.samples {
            refuse(format!("{n} rows do not reach from the start to the end"), "two rows or more");
        }
        if self.patience_s.is_nan() {
            refuse("how long a run may take is no number".into(), "seconds, as in 60, or infinity");
        }
        if self.most_events == 0 {
            refuse("no change of mode is allowed, not even the first".into(), "one or more");
        }
        match self.method {
            Method::Fixed { step_s } if !(step_s.is_finite() && step_s > 0.0) => {
                refuse(format!("a step of {step_s} s leads nowhere"), "a time above zero");
            }
            Method::Adaptive if self.lagged_forces => {
                let hint = "give the length of the step, as in 1 ms";
                refuse("forces lag by a step, and steps have no fixed length here".into(), hint);
            }
            _ => {}
        }
        if wrong.has_errors() { Err(wrong) } else { Ok(()) }
    }

    /// From when on there are rows, and where a run of the scenario ends.
    pub(super) fn window(&self, scenario: &Scenario) -> Result<[f64; 2], Diagnostics> {
        let (start, end) = (scenario.start, scenario.end);
        let mut wrong = Diagnostics::default();
        let mut refuse = |message: String| {
            let hint = format!("times from {start} s to {end} s, the first before the second");
            wrong.push(Diagnostic::new(Code::OutOfRange, "", message).hint(hint));
        };
        let [from, to] = [self.from_s.unwrap_or(start), self.to_s.unwrap_or(end)];
        if !(from >= start && from < end) {
            refuse(format!("`from` {from} s is not within scenario `{}`", scenario.name));
        }
        if !(to > start && to <= end) {
            refuse(format!("`to` {to} s is not within scenario `{}`", scenario.name));
        }
        if from >= to {
            refuse(format!("from {from} s to {to} s is no time"));
        }
        if wrong.has_errors() { Err(wrong) } else { Ok([from, to]) }
    }
}

/// How to advance in time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// Dormand–Prince 5(4) within a mode, changes of mode located; implicit where shafts are stiff.
    Adaptive,
    /// Steps of one length, each of bounded cost.
    Fixed {
        /// The length, s.
        step_s: f64,
    },
}

/// A column of the output.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Column {
    /// Its name, with the unit at its end: `time_s`, `sun.speed_rad_s`, `P1.sun-planet.torque_n_m`, …
    pub name: String,
    /// In what the values are; nothing for modes and efficiencies.
    pub unit: ColumnUnit,
    /// What the values are.
    pub kind: ColumnKind,
    /// The member, mesh, source, shaft or shift element, or `frame`; empty for the train as a whole.
    pub of: String,
}

impl Column {
    /// Its name without the unit: `sun.speed`.
    pub fn quantity(&self) -> &str {
        without_unit(&self.name, self.unit.symbol())
    }

    /// Whether that is its name, or its name without the unit: `sun.speed_rad_s`, `sun.speed`.
    pub fn is_called(&self, name: &str) -> bool {
        self.name == name || self.quantity() == name
    }
}

/// What the values of a column are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum ColumnKind {
    /// Time.
    Time,
    /// Speed of a member.
    Speed,
    /// Angle that a member has turned through since the start.
    Angle,
    /// Acceleration of a member.
    Acceleration,
    /// Torque of a source on its member, of friction or a shaft on its first member, of a mesh at its first gear, of a
    /// variator on a member.
    Torque,
    /// Torque with which the frame holds a member of `fixed`; that of `frame` is all that the frame gives, through
    /// such members and whatever else is borne by it.
    Reaction,
    /// Power of a source, out of the store of a variator, through a variator into its second member, or lost in all.
    Power,
    /// State of motion of an element: -1 backward, 0 stuck, 1 forward, 2 free ([`ModeLabel`]).
    Mode,
    /// Twist of a shaft.
    Twist,
    /// Power that goes out over power that comes in.
    Efficiency,
    /// Energy stored or lost.
    Energy,
    /// Ratio of a variator.
    Ratio,
    /// Temperature of a place of the thermal network.
    Temperature,
}

impl ColumnKind {
    /// As in the contract: `speed`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Time => "time",
            Self::Speed => "speed",
            Self::Angle => "angle",
            Self::Acceleration => "acceleration",
            Self::Torque => "torque",
            Self::Reaction => "reaction",
            Self::Power => "power",
            Self::Mode => "mode",
            Self::Twist => "twist",
            Self::Efficiency => "efficiency",
            Self::Energy => "energy",
            Self::Ratio => "ratio",
            Self::Temperature => "temperature",
        }
    }

    /// The unit of its values.
    pub fn unit(self) -> ColumnUnit {
        match self {
            Self::Time => ColumnUnit::Second,
            Self::Speed => ColumnUnit::RadianPerSecond,
            Self::Angle | Self::Twist => ColumnUnit::Radian,
            Self::Acceleration => ColumnUnit::RadianPerSecondSquared,
            Self::Torque | Self::Reaction => ColumnUnit::NewtonMetre,
            Self::Power => ColumnUnit::Watt,
            Self::Energy => ColumnUnit::Joule,
            Self::Temperature => ColumnUnit::Kelvin,
            Self::Mode | Self::Efficiency | Self::Ratio => ColumnUnit::None,
        }
    }
}

/// Unit of the values of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub enum ColumnUnit {
    /// A number without unit.
    #[serde(rename = "")]
    None,
    /// s
    #[serde(rename = "s")]
    Second,
    /// rad/s
    #[serde(rename = "rad/s")]
    RadianPerSecond,
    /// rad
    #[serde(rename = "rad")]
    Radian,
    /// rad/s²
    #[serde(rename = "rad/s^2")]
    RadianPerSecondSquared,
    /// N m
    #[serde(rename = "N m")]
    NewtonMetre,
    /// W
    #[serde(rename = "W")]
    Watt,
    /// J
    #[serde(rename = "J")]
    Joule,
    /// K
    #[serde(rename = "K")]
    Kelvin,
    /// °C: in figures
    #[serde(rename = "degC")]
    DegreeCelsius,
}

impl ColumnUnit {
    /// As in the contract: `rad/s`; empty for a number without unit.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::None => "",
            Self::Second => "s",
            Self::RadianPerSecond => "rad/s",
            Self::Radian => "rad",
            Self::RadianPerSecondSquared => "rad/s^2",
            Self::NewtonMetre => "N m",
            Self::Watt => "W",
            Self::Joule => "J",
            Self::Kelvin => "K",
            Self::DegreeCelsius => "degC",
        }
    }
}

/// A row of output: values in the order of the columns, SI. NaN where a value is not determined:
/// how locked teeth share the torque that holds them.
#[derive(Clone, Copy, Debug)]
pub struct Sample<'a> {
    /// Time, s.
    pub time_s: f64,
    /// In the order of the columns; the first is the time.
    pub values: &'a [f64],
}

/// The state of motion of an element.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum ModeLabel {
    /// Relative speed positive.
    Forward,
    /// Relative speed negative.
    Backward,
    /// Held by friction.
    Stuck,
    /// Not engaged, or within backlash.
    Free,
}

impl ModeLabel {
    /// As a number in the rows: -1 backward, 0 stuck, 1 forward, 2 free.
    pub fn value(self) -> f64 {
        match self {
            Self::Backward => -1.0,
            Self::Stuck => 0.0,
            Self::Forward => 1.0,
            Self::Free => 2.0,
        }
    }

    /// The label of such a number.
    pub fn of_value(value: f64) -> Option<Self> {
        [Self::Backward, Self::Stuck, Self::Forward, Self::Free].into_iter().find(|label| label.value() == value)
    }
}

/// A change of mode.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Event {
    /// When, s.
    pub time_s: f64,
    /// What happened, in words, some names left out where they are many: `start`; `B comes to rest`, `B and
    /// P1.sun-planet break away`, `bearing reverses`, `C engages, B opens`, `side shafts: contact`, `drive reverses
    /// in P1.sun-planet`.
    pub cause: String,
    /// What `cause` says, as data.
    #[serde(default)]
    pub happenings: Vec<Happening>,
    /// The modes after it that differ from those before, by element.
    pub modes: NameMap<ModeLabel>,
}

impl Event {
    /// Whether it is the start of the run, which changes nothing.
    pub fn is_start(&self) -> bool {
        self.happenings.iter().any(|h| h.kind == HappeningKind::Start)
    }
}

/// What happened to some elements at once.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Happening {
    /// What happens to the elements.
    pub kind: HappeningKind,
    /// The elements.
    pub of: Vec<String>,
}

/// What may happen to elements in a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum HappeningKind {
    /// The run begins.
    Start,
    /// Friction holds what was sliding.
    ComesToRest,
    /// What was held slides.
    BreaksAway,
    /// It slides in the other direction.
    TurnsRound,
    /// Its relative speed is zero for an instant, and it slides on as before.
    RestsForAnInstant,
    /// A shift element begins to be engaged.
    Engages,
    /// A shift element ceases to be engaged.
    Opens,
    /// A one-way clutch takes torque.
    Locks,
    /// A one-way clutch is overrun.
    Overruns,
    /// The other gear of a mesh drives.
    DriveReverses,
    /// A shaft has passed its backlash.
    Touches,
    /// A shaft is within its backlash.
    ContactLost,
    /// A shaft without contact is looked at again; it stays without.
    NoContact,
    /// The damper of a shaft acts in full.
    FullDamping,
    /// The damper of a shaft is limited to the torque of its spring.
    DampingLimited,
    /// A shaft is in contact, and its damper would pull.
    ContactWithoutForce,
    /// The ratio of a variator reaches a limit, and stays there.
    ReachesLimit,
    /// The ratio of a variator leaves its limit.
    LeavesLimit,
}

/// Takes the output as it comes; [`ControlFlow::Break`] ends the run there.
pub trait Recorder {
    /// The columns, once, before everything else.
    fn columns(&mut self, columns: &[Column]) -> ControlFlow<()> {
        let _ = columns;
        ControlFlow::Continue(())
    }

    /// Whether a row at that time, s, is of use. One that is not is not handed over, and not computed for it.
    fn wants_row(&self, time: f64) -> bool {
        let _ = time;
        true
    }

    /// A row, in rising time.
    fn sample(&mut self, sample: Sample<'_>) -> ControlFlow<()> {
        let _ = sample;
        ControlFlow::Continue(())
    }

    /// A change of mode. The rows before and after it follow each other at the same time.
    fn event(&mut self, event: &Event) -> ControlFlow<()> {
        let _ = event;
        ControlFlow::Continue(())
    }

    /// Time reached, s; called often.
    fn progress(&mut self, time: f64) -> ControlFlow<()> {
        let _ = time;
        ControlFlow::Continue(())
    }
}

/// Records nothing.
impl Recorder for () {
    fn wants_row(&self, _: f64) -> bool {
        false
    }
}

/// How a run ended.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", tag = "verdict", content = "why")]
#[non_exhaustive]
pub enum Outcome {
    /// The end of the scenario was reached.
    Finished,
    /// The recorder ended it.
    Interrupted,
    /// No tooth forces exist that fit the state: dynamic jamming.
    NoSolution(String),
    /// Several fit: which one nature chooses is not in the model.
    SeveralSolutions(String),
    /// More changes of mode than allowed within a short time.
    TooManyEvents(String),
    /// The integrator could not keep the tolerance, or no forces were found.
    NotConverged(String),
    /// A speed would have to change at once: members joined, or a prescribed speed that jumps.
    Impact(String),
    /// It would take longer than [allowed](Options::patience_s).
    TooLong(String),
}

impl Outcome {
    /// How the run ended, as in `the run …`; [`Outcome::why`] says more.
    pub fn words(&self) -> &'static str {
        match self {
            Self::Finished => "reached the end of the scenario",
            Self::Interrupted => "was interrupted",
            Self::NoSolution(_) => "jammed: no tooth forces fit the motion",
            Self::SeveralSolutions(_) => "stopped where several motions are possible",
            Self::TooManyEvents(_) => "stopped: modes change too often",
            Self::NotConverged(_) => "stopped: the equations could not be solved",
            Self::Impact(_) => "stopped at an impact: a speed would have to change at once",
            Self::TooLong(_) => "stopped: it would take too long",
        }
    }

    /// Why the run ended there, in words; empty where the outcome itself says it.
    pub fn why(&self) -> &str {
        match self {
            Self::Finished | Self::Interrupted => "",
            Self::NoSolution(why)
            | Self::SeveralSolutions(why)
            | Self::TooManyEvents(why)
            | Self::NotConverged(why)
            | Self::Impact(why)
            | Self::TooLong(why) => why,
        }
    }
}

/// Energy that went into one cause of loss.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct EnergyLoss {
    /// Mesh, drag, shift element, shaft; place of a loss that follows a law.
    pub name: String,
    /// What loses it.
    pub kind: EnergyLossKind,
    /// The energy, J.
    pub energy_j: f64,
}

/// What loses energy in a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum EnergyLossKind {
    /// Teeth: by a given efficiency, or sliding by a law.
    Mesh,
    /// A drag of the train.
    Drag,
    /// A shift element.
    ShiftElement,
    /// The damper of a shaft.
    Shaft,
    /// Teeth: rolling, by a law.
    Rolling,
    /// A bearing, by a law.
    Bearing,
    /// A gear or rotor in air or mist, by a law.
    Windage,
    /// A gear or rotor in oil, by a law.
    Churning,
    /// A seal, by a law.
    Seal,
    /// A variator.
    Variator,
}

impl fmt::Display for EnergyLossKind {
    /// For people: `shift element`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Mesh => "mesh",
            Self::Drag => "drag",
            Self::ShiftElement => "shift element",
            Self::Shaft => "shaft",
            Self::Rolling => "rolling",
            Self::Bearing => "bearing",
            Self::Variator => "variator",
            Self::Windage => "windage",
            Self::Churning => "churning",
            Self::Seal => "seal",
        })
    }
}

/// Energy that came in at one place (negative: that went out).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SourceEnergy {
    /// The source; `store of` a variator.
    pub name: String,
    /// The member, or the variator.
    pub member: String,
    /// Net, J.
    pub energy_j: f64,
    /// What came in, J.
    pub in_j: f64,
    /// What went out, J.
    pub out_j: f64,
}

/// Where the energy of a run went: in = stored + losses + residual.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct EnergyReport {
    /// By source from outside, stores of variators among them.
    pub sources: Vec<SourceEnergy>,
    /// What sources that are machines of variators gave to their members; it came from the buses.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub machines: Vec<SourceEnergy>,
    /// Kinetic energy and that of twisted shafts, end less start, J.
    pub stored_j: f64,
    /// By cause, largest first.
    pub losses: Vec<EnergyLoss>,
    /// All that came in or went out, J.
    pub turned_over_j: f64,
    /// What does not close, J.
    pub residual_j: f64,
    /// Out over in, where anything came in and nothing is stored beside it; else `None`.
    pub efficiency: Option<f64>,
}

/// A limit of a variator that a run exceeds, where it does so by most among the ends of its steps.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct LimitExceeded {
    /// The limit, and what exceeds it. A ratio does not: the variator stays at its limit, and the value is the one wanted.
    #[serde(flatten)]
    pub limit: BeyondLimit,
    /// When, s.
    pub time_s: f64,
    /// By what part of the limit.
    pub excess: f64,
}

impl fmt::Display for LimitExceeded {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let most = if self.limit.quantity == LimitedQuantity::Ratio { "stays at its limit, the most" } else { "most" };
        write!(f, "{}; {most} at t = {} s", self.limit, (self.time_s * 1e6).round() / 1e6)
    }
}

/// A run: the results contract `willis-simulation-1`. Fields are added, never renamed; units are SI and stand in the
/// names.
///
/// [`simulate`](super::simulate) hands rows and events to its recorder, which may keep them in [`RunReport::events`],
/// [`RunReport::columns`] and [`RunReport::rows`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct RunReport {
    /// `willis-simulation-1`
    pub format: Format<Self>,
    /// The train.
    pub train: String,
    /// The scenario.
    pub scenario: String,
    /// How it ended.
    pub outcome: Outcome,
    /// Where it began, s.
    pub start_s: f64,
    /// From when on there are rows and events, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from_s: Option<f64>,
    /// Where it ended, s.
    pub end_s: f64,
    /// Members whose speeds are the coordinates.
    pub coordinates: Vec<String>,
    /// Whether the tooth forces have exactly one solution in every rolling state.
    pub unique_for_every_load: bool,
    /// Steps taken.
    pub steps: usize,
    /// Changes of mode, where they were kept.
    pub events: Vec<Event>,
    /// Speeds of all members at the end, rad/s; without those that are no longer finite.
    pub final_speeds_rad_s: NameMap<f64>,
    /// Where the energy went; nothing where it was not counted, or is no longer finite.
    pub energy: Option<EnergyReport>,
    /// Temperatures, where the train says what carries its heat away and steps are adapted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub heat: Option<MotionHeat>,
    /// Limits of variators that the run exceeds.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub beyond_limits: Vec<LimitExceeded>,
    /// What stands in for data that were not given.
    pub assumptions: Vec<String>,
    /// What the reader must know.
    pub notes: Vec<String>,
    /// Where the scenario ends, or was [told to](Options::to_s), s.
    pub scenario_end_s: f64,
    /// Number of changes of mode, the start among them.
    pub event_count: usize,
    /// What is in the rows, where rows were kept.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub columns: Option<Vec<Column>>,
    /// Values in the order of the columns, SI; nothing where a value is not determined.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rows: Option<Vec<Vec<Option<f64>>>>,
}

/// Temperatures of a run, and where the heat went: `made = carried away + stored`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct MotionHeat {
    /// Temperature of each place at the start, K.
    pub start_k: NameMap<f64>,
    /// Temperature of each place at the end, K.
    pub end_k: NameMap<f64>,
    /// Highest oil temperature, K.
    pub highest_oil_k: f64,
    /// Highest oil temperature that the train allows, K.
    pub limit_k: f64,
    /// When the oil first went beyond it, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub beyond_limit_s: Option<f64>,
    /// Heat made by losses and by what the network has beside them, J.
    pub made_j: f64,
    /// Heat carried away, J.
    pub carried_j: f64,
    /// Heat stored in oil and parts, J.
    pub stored_j: f64,
    /// Lost outside the gearbox, in parts that are cooled elsewhere or belong to no mesh, shift element or terminal, J.
    pub elsewhere_j: f64,
    /// Heat made less what was carried away and stored, over the heat made.
    pub residual: f64,
}

impl Contract for RunReport {
    const FORMAT: &'static str = "willis-simulation-1";
}
