//! What a simulation tells.

use std::ops::ControlFlow;

use serde::Serialize;

use crate::named::Named;

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
    /// Whether to count where the energy goes. Without it the energies of the report are NaN, and the run is
    /// faster.
    pub energies: bool,
    /// How many rows; that of the scenario unless given.
    pub samples: Option<usize>,
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
        }
    }
}

/// How to advance in time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// Dormand–Prince 5(4) within a mode, changes of mode located; implicit where shafts are stiff.
    Adaptive,
    /// Steps of this length, s, each of bounded cost.
    Fixed(f64),
}

/// A column of the output.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Column {
    /// `time_s`, `speed.sun`, `torque.P1.sun-planet`, …
    pub name: String,
    /// Unit, empty for modes.
    pub unit: &'static str,
    /// What it is: `time`, `speed`, `angle`, `acceleration`, `torque`, `power`, `mode`, `twist`, `efficiency`, `energy`.
    pub kind: &'static str,
    /// The member, mesh, source, shaft or shift element; empty for the train as a whole.
    pub of: String,
}

/// A row of output: values in the order of the columns, SI. NaN where a value is not determined:
/// how locked teeth share the torque that holds them.
#[derive(Clone, Copy, Debug)]
pub struct Sample<'a> {
    /// s
    pub time: f64,
    /// In the order of the columns; the first is the time.
    pub values: &'a [f64],
}

/// The state of motion of an element.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
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

/// A change of mode.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Event {
    /// s
    pub time_s: f64,
    /// What happened: `start`; `B comes to rest`, `B and P1.sun-planet break away`, `bearing turns round`,
    /// `C engages, B opens`, `side shafts: contact`, `drive reverses in P1.sun-planet`.
    pub cause: String,
    /// The modes after it that differ from those before, by element.
    pub modes: Named<ModeLabel>,
}

/// Takes the output as it comes; [`ControlFlow::Break`] ends the run there.
pub trait Recorder {
    /// The columns, once, before everything else.
    fn columns(&mut self, columns: &[Column]) -> ControlFlow<()> {
        let _ = columns;
        ControlFlow::Continue(())
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

impl Recorder for () {}

/// How a run ended.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case", tag = "verdict", content = "why")]
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
}

impl Outcome {
    /// Why the run ended there, in words; empty where the outcome itself says it.
    pub fn why(&self) -> &str {
        match self {
            Self::Finished | Self::Interrupted => "",
            Self::NoSolution(why)
            | Self::SeveralSolutions(why)
            | Self::TooManyEvents(why)
            | Self::NotConverged(why)
            | Self::Impact(why) => why,
        }
    }
}

/// Energy that went into one cause of loss.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EnergyLoss {
    /// Mesh, drag, shift element, shaft; place of a loss that follows a law.
    pub name: String,
    /// `mesh`, `drag`, `shift-element`, `shaft`; by laws `rolling`, `bearing`, `windage`, `churning`, `seal`
    pub kind: &'static str,
    /// J
    pub energy_j: f64,
}

/// Energy that came in at one place (negative: that went out).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SourceEnergy {
    /// The source.
    pub name: String,
    /// The member.
    pub member: String,
    /// Net, J.
    pub energy_j: f64,
    /// What came in, J.
    pub in_j: f64,
    /// What went out, J.
    pub out_j: f64,
}

/// Where the energy of a run went: in = stored + losses + residual.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EnergyReport {
    /// By source.
    pub sources: Vec<SourceEnergy>,
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

/// The whole answer beside rows and events. Serialised it is the head of the results contract
/// `willis-simulation-1`: fields are added, never renamed; units are SI and stand in the names.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RunReport {
    /// `willis-simulation-1`
    pub format: &'static str,
    /// The train.
    pub train: String,
    /// The scenario.
    pub scenario: String,
    /// How it ended.
    pub outcome: Outcome,
    /// Where it began, s.
    pub start_s: f64,
    /// Where it ended, s.
    pub end_s: f64,
    /// Members whose speeds are the coordinates.
    pub coordinates: Vec<String>,
    /// Whether the tooth forces have exactly one solution in every rolling state.
    pub unique_for_every_load: bool,
    /// Steps taken.
    pub steps: usize,
    /// Changes of mode.
    pub events: usize,
    /// Speeds of all members at the end, rad/s.
    pub final_speeds_rad_s: Named<f64>,
    /// Where the energy went.
    pub energy: EnergyReport,
    /// What stands in for data that were not given.
    pub assumptions: Vec<String>,
    /// What the reader must know.
    pub notes: Vec<String>,
}
