//! What becomes of every attribute of a file, and what had to be assumed.

use std::collections::HashMap;

use serde::{Deserialize, Serialize};
use willis::diagnostic::printable;

use crate::document::{Component, Document, MOST_TOLD, Value};

/// Where an attribute stands: in the model, or in a load case (counted from 1); and the position of its component there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct At {
    pub scope: usize,
    pub component: usize,
}

impl At {
    /// A component of the model itself.
    pub fn model(component: usize) -> Self {
        Self { scope: 0, component }
    }
}

/// What a number is, and in which unit it is handed out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Is {
    /// No unit.
    Number,
    /// mm
    Length,
    /// um
    Roughness,
    /// deg
    Angle,
    /// rpm
    Speed,
    /// N m
    Torque,
    /// kW
    Power,
    /// mm^2/s
    Viscosity,
    /// kg/m^3
    Density,
    /// degC
    Temperature,
    /// N/mm^2
    Pressure,
    /// A part of one.
    Share,
}

impl Is {
    /// The unit of the numbers that are handed out.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Number | Self::Share => "",
            Self::Length => "mm",
            Self::Roughness => "um",
            Self::Angle => "deg",
            Self::Speed => "rpm",
            Self::Torque => "N m",
            Self::Power => "kW",
            Self::Viscosity => "mm^2/s",
            Self::Density => "kg/m^3",
            Self::Temperature => "degC",
            Self::Pressure => "MPa",
        }
    }

    /// Factor and offset from a unit of the file to that unit.
    fn from(self, unit: &str) -> Option<(f64, f64)> {
        let plain: String = unit.chars().filter(|c| !c.is_whitespace()).collect();
        let factor = match (self, plain.as_str()) {
            (Self::Temperature, "K") => return Some((1.0, -273.15)),
            (Self::Number, "none" | "-" | "" | "1") => 1.0,
            (Self::Share, "%") => 0.01,
            (Self::Share, "none" | "-" | "1") => 1.0,
            (Self::Length, "mm") | (Self::Roughness, "mum" | "um" | "µm" | "μm") => 1.0,
            (Self::Length, "m") | (Self::Roughness, "mm") => 1000.0,
            (Self::Length, "mum" | "um" | "µm" | "μm") => 1e-3,
            (Self::Length, "cm") => 10.0,
            (Self::Length, "in" | "inch") => 25.4,
            (Self::Angle, "deg" | "°") => 1.0,
            (Self::Angle, "rad") => 180.0 / std::f64::consts::PI,
            (Self::Speed, "1/min" | "min^-1" | "rpm") => 1.0,
            (Self::Speed, "1/s") => 60.0,
            (Self::Speed, "rad/s") => 30.0 / std::f64::consts::PI,
            (Self::Torque, "Nm") | (Self::Power, "kW") => 1.0,
            (Self::Torque, "kNm") | (Self::Power, "MW") => 1000.0,
            (Self::Torque, "Nmm") | (Self::Power, "W") => 1e-3,
            (Self::Viscosity, "mm^2/s" | "cSt") => 1.0,
            (Self::Viscosity, "m^2/s") => 1e6,
            (Self::Density, "kg/m^3") => 1.0,
            (Self::Density, "kg/dm^3" | "g/cm^3") => 1000.0,
            (Self::Temperature, "C" | "°C" | "degC") => 1.0,
            (Self::Pressure, "N/mm^2" | "MPa") => 1.0,
            (Self::Pressure, "GPa") => 1000.0,
            (Self::Pressure, "Pa" | "N/m^2") => 1e-6,
            _ => return None,
        };
        Some((factor, 0.0))
    }
}

/// What became of an attribute.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Fate {
    /// It is in the train file, or something in it follows from it.
    Used,
    /// The train file has no place for it.
    LeftOut,
    /// It would have been used, but its value cannot be.
    Unusable,
}

/// An attribute of the file and what became of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct AttributeReport {
    /// The load case that it stands in, by its number; none in the model itself.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub load_case: Option<i64>,
    /// Number of the component.
    pub component: i64,
    /// Its type: `cylindrical_gear`.
    #[serde(rename = "type")]
    pub kind: String,
    /// Name of the attribute: `normal_module`.
    pub attribute: String,
    /// Its value, shortened.
    pub value: String,
    /// Its unit, as it is written.
    pub unit: String,
    /// What became of it.
    pub fate: Fate,
    /// What it was used for; or why it cannot be used. Empty if it is left out.
    pub why: String,
}

/// Something that the file does not say and the train file does.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Guess {
    /// What it is about.
    pub of: String,
    /// What was taken.
    pub taken: String,
    /// Why.
    pub because: String,
}

/// Something that is wrong or odd about the file and did not stop its reading.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Problem {
    /// Where: a component, a relation, a line.
    pub place: String,
    /// What, and what was done.
    pub message: String,
}

/// The account of one file while it is read.
pub struct Account<'d> {
    pub document: &'d Document,
    fates: HashMap<(At, usize), (Fate, String)>,
    pub guesses: Vec<Guess>,
    pub problems: Vec<Problem>,
    /// Problems beyond those that are listed.
    pub more_problems: usize,
    /// Components of load cases by the number of the case, from 1, and their own.
    of_cases: HashMap<(usize, i64), usize>,
    /// The gearbox itself.
    pub unit: Option<usize>,
}

impl<'d> Account<'d> {
    pub fn new(document: &'d Document) -> Self {
        let odd = document.odd.iter().map(|o| Problem { place: o.place.clone(), message: o.message.clone() });
        let mut of_cases = HashMap::new();
        for (case, all) in document.cases.iter().enumerate() {
            for (k, c) in all.components.iter().enumerate() {
                of_cases.entry((case + 1, c.id)).or_insert(k);
            }
        }
        Self {
            document,
            fates: HashMap::new(),
            guesses: vec![],
            problems: odd.collect(),
            more_problems: document.more_odd,
            of_cases,
            unit: document.components.iter().position(|c| c.kind == "gear_unit"),
        }
    }

    /// A component in a load case (counted from 1), or in the model itself.
    pub fn in_case(&self, case: usize, component: usize) -> Option<At> {
        if case == 0 {
            return Some(At::model(component));
        }
        let found = self.of_cases.get(&(case, self.document.components[component].id))?;
        Some(At { scope: case, component: *found })
    }

    pub fn component(&self, at: At) -> &'d Component {
        match at.scope {
            0 => &self.document.components[at.component],
            case => &self.document.cases[case - 1].components[at.component],
        }
    }

    /// How a component is named in messages.
    pub fn called(&self, at: At) -> String {
        let c = self.component(at);
        let kind = c.kind.replace('_', " ");
        if c.name.is_empty() { format!("{kind} {}", c.id) } else { format!("{kind} {} `{}`", c.id, printable(&c.name)) }
    }

    pub fn problem(&mut self, place: impl Into<String>, message: impl Into<String>) {
        let problem = Problem { place: place.into(), message: message.into() };
        if self.problems.len() >= MOST_TOLD {
            self.more_problems += 1;
        } else if !self.problems.contains(&problem) {
            self.problems.push(problem);
        }
    }

    pub fn guess(&mut self, of: impl Into<String>, taken: impl Into<String>, because: impl Into<String>) {
        let guess = Guess { of: of.into(), taken: taken.into(), because: because.into() };
        if self.guesses.len() < MOST_TOLD && !self.guesses.contains(&guess) {
            self.guesses.push(guess);
        }
    }

    fn find(&self, at: At, id: &str) -> Option<(usize, &'d Value, &'d str)> {
        let attributes = &self.component(at).attributes;
        let k = attributes.iter().position(|a| a.id == id)?;
        Some((k, &attributes[k].value, &attributes[k].unit))
    }

    /// Whether there is such an attribute with any value.
    pub fn has(&self, at: At, id: &str) -> bool {
        self.find(at, id).is_some()
    }

    fn used(&mut self, at: At, k: usize, what: &str) {
        self.fates.insert((at, k), (Fate::Used, what.to_owned()));
    }

    fn unusable(&mut self, at: At, k: usize, why: String) {
        let id = printable(&self.component(at).attributes[k].id).into_owned();
        if self.fates.insert((at, k), (Fate::Unusable, why.clone())).is_none() {
            self.problem(self.called(at), format!("{id}: {why}"));
        }
    }

    /// Says that a value cannot be right.
    pub fn reject(&mut self, at: At, id: &str, why: impl Into<String>) {
        if let Some((k, ..)) = self.find(at, id) {
            self.fates.remove(&(at, k));
            self.unusable(at, k, why.into());
        }
    }

    /// Takes back that an attribute was used.
    pub fn forget(&mut self, at: At, id: &str) {
        if let Some((k, ..)) = self.find(at, id) {
            self.fates.remove(&(at, k));
        }
    }

    /// A finite number in the unit of `is`.
    pub fn number(&mut self, at: At, id: &str, is: Is, what: &str) -> Option<f64> {
        let (k, value, unit) = self.find(at, id)?;
        let x = match value {
            Value::Number(x) if x.is_finite() => *x,
            Value::Number(x) => {
                self.unusable(at, k, format!("{x} is no finite number"));
                return None;
            }
            Value::Numbers(all) if all.len() == 1 && all[0].is_finite() => all[0],
            Value::Text(text) if text.is_empty() => {
                self.unusable(at, k, "has no value".into());
                return None;
            }
            other => {
                self.unusable(at, k, format!("`{}` is no number", other.shown()));
                return None;
            }
        };
        if unit.trim().is_empty() && is != Is::Number {
            self.guess(format!("{id} of {}", self.called(at)), is.unit(), "the file gives no unit");
            self.used(at, k, what);
            return Some(x);
        }
        let Some((factor, offset)) = is.from(unit) else {
            let wanted = if is.unit().is_empty() { "none" } else { is.unit() };
            self.unusable(at, k, format!("`{}` is no unit for it; {wanted} would be", printable(unit)));
            return None;
        };
        self.used(at, k, what);
        Some(if factor == 1.0 && offset == 0.0 { x } else { rounded(x * factor + offset) })
    }

    /// A whole number, also written as `17.0`.
    pub fn integer(&mut self, at: At, id: &str, what: &str) -> Option<i64> {
        let x = self.number(at, id, Is::Number, what)?;
        if x.fract() == 0.0 && x.abs() <= 1e9 {
            return Some(x as i64);
        }
        self.reject(at, id, format!("{x} is no whole number"));
        None
    }

    pub fn flag(&mut self, at: At, id: &str, what: &str) -> Option<bool> {
        let (k, value, _) = self.find(at, id)?;
        match value {
            Value::Flag(x) => {
                self.used(at, k, what);
                Some(*x)
            }
            Value::Number(x) if *x == 0.0 || *x == 1.0 => {
                self.used(at, k, what);
                Some(*x == 1.0)
            }
            other => {
                self.unusable(at, k, format!("`{}` is neither true nor false", other.shown()));
                None
            }
        }
    }

    /// One truth value for each gear of a gearbox, or one for all.
    pub fn flags(&mut self, at: At, id: &str, what: &str) -> Option<Vec<bool>> {
        if let Some((k, Value::Flags(all), _)) = self.find(at, id) {
            self.used(at, k, what);
            return Some(all.clone());
        }
        self.flag(at, id, what).map(|x| vec![x])
    }

    /// A word. `false` where a text belongs is what a faulty writer makes of every text.
    pub fn text(&mut self, at: At, id: &str, what: &str) -> Option<String> {
        let (k, value, _) = self.find(at, id)?;
        let text = match value {
            Value::Text(text) if text.is_empty() => return None,
            Value::Text(text) => text.clone(),
            Value::Number(x) => x.to_string(),
            other => {
                self.unusable(at, k, format!("`{}` stands where a text belongs", other.shown()));
                return None;
            }
        };
        self.used(at, k, what);
        Some(text)
    }

    /// A point or a direction in space, in mm.
    pub fn vector(&mut self, at: At, id: &str, what: &str) -> Option<[f64; 3]> {
        let (k, value, unit) = self.find(at, id)?;
        let Some((factor, _)) = Is::Length.from(unit).or(unit.trim().is_empty().then_some((1.0, 0.0))) else {
            self.unusable(at, k, format!("`{}` is no unit of a length", printable(unit)));
            return None;
        };
        match value {
            Value::Numbers(all) if all.len() == 3 && all.iter().all(|x| x.is_finite()) => {
                self.used(at, k, what);
                Some([all[0] * factor, all[1] * factor, all[2] * factor])
            }
            other => {
                self.unusable(at, k, format!("`{}` stands where three numbers belong", other.shown()));
                None
            }
        }
    }

    /// Every attribute of the file, in its order.
    pub fn attributes(&self) -> Vec<AttributeReport> {
        let models = std::iter::once((None, &self.document.components));
        let scopes = models.chain(self.document.cases.iter().map(|c| (Some(c.id), &c.components)));
        let mut all = vec![];
        for (scope, (load_case, components)) in scopes.enumerate() {
            for (component, c) in components.iter().enumerate() {
                for (k, a) in c.attributes.iter().enumerate() {
                    let found = self.fates.get(&(At { scope, component }, k));
                    let (fate, why) = found.cloned().unwrap_or((Fate::LeftOut, String::new()));
                    all.push(AttributeReport {
                        load_case,
                        component: c.id,
                        kind: printable(&c.kind).into_owned(),
                        attribute: printable(&a.id).into_owned(),
                        value: a.value.shown(),
                        unit: printable(&a.unit).into_owned(),
                        fate,
                        why,
                    });
                }
            }
        }
        all
    }
}

/// Without the last digits, in which a change of units leaves its traces.
pub fn rounded(x: f64) -> f64 {
    format!("{x:.13e}").parse().unwrap_or(x)
}
