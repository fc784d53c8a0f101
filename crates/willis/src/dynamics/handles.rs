//! Handles of a run: inputs that can be set and outputs that can be read while it goes on, found once by name.
//!
//! A co-simulation, a control loop in real time or an optimisation looks its variables up before the run and then
//! uses positions only: setting and reading allocate nothing where steps have a fixed length.

use std::fmt;

use crate::diagnostic::{Code, Diagnostic, Diagnostics, through_diagnostic};
use crate::train::{Signal, SourceKind};

use super::report::{Column, ColumnUnit};
use super::shows::Shows;
use super::system::System;

/// An input of a run. It belongs to runs of one scenario of one train.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct InputHandle(Sets);

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Sets {
    Source(usize),
    Engagement(usize),
}

/// An output of a run. It belongs to runs of one scenario of one train.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct OutputHandle(usize);

/// What an input of a run is called and means.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct InputInfo {
    /// The name of the source; `engagement.` and the name of the shift element.
    pub name: String,
    /// What its value means.
    pub kind: InputKind,
    /// In what its value is.
    pub unit: ColumnUnit,
    /// The handle.
    pub input: InputHandle,
}

/// What the value of an input means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum InputKind {
    /// Torque of a source on its member, N m.
    Torque,
    /// Speed of a member, prescribed, rad/s.
    Speed,
    /// Speed that a controller wants, rad/s.
    SetPoint,
    /// Throttle of a motor, from 0 closed to 1 full.
    Throttle,
    /// Slope of the road under a vehicle, rise over distance.
    Grade,
    /// How far a shift element is engaged, from 0 to 1.
    Engagement,
}

impl InputKind {
    /// The unit of its value.
    pub fn unit(self) -> ColumnUnit {
        match self {
            Self::Torque => ColumnUnit::NewtonMetre,
            Self::Speed | Self::SetPoint => ColumnUnit::RadianPerSecond,
            Self::Throttle | Self::Grade | Self::Engagement => ColumnUnit::None,
        }
    }
}

/// Why an input does not take a value.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum InputRefused {
    /// It is infinite or no number.
    NotFinite,
    /// A prescribed speed would jump, which takes an infinite torque.
    Jump {
        /// The present speed, rad/s.
        from_rad_s: f64,
        /// The speed wanted, rad/s.
        to_rad_s: f64,
    },
}

impl fmt::Display for InputRefused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite => f.write_str("an input takes a finite number"),
            Self::Jump { from_rad_s, to_rad_s } => write!(
                f,
                "a prescribed speed of {from_rad_s} rad/s cannot jump to {to_rad_s} rad/s; use a torque or a controller"
            ),
        }
    }
}

impl std::error::Error for InputRefused {}

impl From<InputRefused> for Diagnostic {
    fn from(refused: InputRefused) -> Self {
        Self::new(Code::OutOfRange, "", refused.to_string())
    }
}

through_diagnostic!(InputRefused);

/// The signal of a source that an input replaces, and what it means; none for a load that follows the speed.
fn signal(kind: &mut SourceKind) -> Option<(InputKind, &mut Signal)> {
    match kind {
        SourceKind::Torque(signal) => Some((InputKind::Torque, signal)),
        SourceKind::Speed(signal) => Some((InputKind::Speed, signal)),
        SourceKind::Controller { setpoint, .. } => Some((InputKind::SetPoint, setpoint)),
        SourceKind::Motor { throttle, .. } => Some((InputKind::Throttle, throttle)),
        SourceKind::Vehicle { grade, .. } => Some((InputKind::Grade, grade)),
        SourceKind::Linear { .. } | SourceKind::Quadratic { .. } => None,
    }
}

impl System {
    /// All inputs of the scenario.
    pub fn inputs(&self) -> Vec<InputInfo> {
        let info =
            |name: String, kind: InputKind, sets| InputInfo { name, kind, unit: kind.unit(), input: InputHandle(sets) };
        let sources = (self.scenario.sources.iter().enumerate()).filter_map(|(k, source)| {
            let (kind, _) = signal(&mut source.kind.clone())?;
            Some(info(source.name.clone(), kind, Sets::Source(k)))
        });
        let engagements = self.scenario.engagements.iter().enumerate().map(|(k, engagement)| {
            let element = &self.train.shift_elements()[engagement.element.index()].name;
            info(format!("engagement.{element}"), InputKind::Engagement, Sets::Engagement(k))
        });
        sources.chain(engagements).collect()
    }

    /// The input of that name.
    pub fn input(&self, name: &str) -> Result<InputHandle, Diagnostics> {
        let all = self.inputs();
        if let Some(known) = all.iter().find(|i| i.name == name) {
            return Ok(known.input);
        }
        let follows = self.scenario.sources.iter().any(|s| s.name == name);
        let message = match follows {
            true => format!("`{name}` is a load that follows the speed; it takes no value"),
            false => format!("the scenario `{}` has no input `{name}`", self.scenario.name),
        };
        Err(unknown(message, name, all.iter().map(|i| i.name.as_str()), "inputs"))
    }

    /// What an input is worth from now on.
    pub fn set(&mut self, input: InputHandle, value: f64) -> Result<(), InputRefused> {
        if !value.is_finite() {
            return Err(InputRefused::NotFinite);
        }
        *self.signal_of(input) = Signal::Constant(value);
        Ok(())
    }

    /// The signal that an input replaces.
    pub fn signal_of(&mut self, input: InputHandle) -> &mut Signal {
        let signal = match input.0 {
            Sets::Source(k) => signal(&mut self.scenario.sources[k].kind).map(|(_, signal)| signal),
            Sets::Engagement(k) => Some(&mut self.scenario.engagements[k].signal),
        };
        signal.expect("an input has a signal")
    }

    /// The speed that an input prescribes, as a position among the prescribed ones.
    pub fn prescribed_by(&self, input: InputHandle) -> Option<usize> {
        match input.0 {
            Sets::Source(k) => self.drivers[k].prescribed,
            Sets::Engagement(_) => None,
        }
    }
}

impl OutputHandle {
    /// The output of that name among columns.
    pub(super) fn of(columns: &[Column], name: &str) -> Result<Self, Diagnostics> {
        let known = || columns.iter().map(Column::quantity);
        let wrong = || unknown(format!("the run has no output `{name}`"), name, known(), "outputs");
        columns.iter().position(|c| c.is_called(name)).map(Self).ok_or_else(wrong)
    }

    /// What it shows.
    pub(super) fn shows(self, all: &[Shows]) -> Shows {
        all[self.0]
    }

    /// Its value in a row.
    pub(super) fn in_row(self, row: &[f64]) -> f64 {
        row[self.0]
    }
}

fn unknown<'a>(message: String, name: &str, known: impl Iterator<Item = &'a str> + Clone, what: &str) -> Diagnostics {
    let mut d = Diagnostic::new(Code::UnknownName, "", message).suggest(name, known.clone());
    if d.hints.is_empty() {
        let list = known.collect::<Vec<_>>().join(", ");
        d = d.hint(format!("its {what} are: {}", if list.is_empty() { "none" } else { &list }));
    }
    d.into()
}
