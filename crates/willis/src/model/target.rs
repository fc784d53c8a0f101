//! What a study varies: a quantity of the operating point, the state, a law, or any quantity of the train file.

use crate::diagnostic::{Code, Diagnostic};
use crate::exact::Rational;
use crate::losses::{self, FAMILIES};
use crate::train::{Document, Key, Measure, MemberId, Train};
use crate::units::{self, Dimension, Quantity};

use super::Model;

/// Whose speed or load it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ShaftRef {
    /// Where power enters when driving, in the state at hand.
    Input,
    /// Where power leaves when driving.
    Output,
    /// A member, by its name.
    Member(MemberId),
}

/// A quantity that can be set.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Target {
    /// A prescribed speed.
    Speed(ShaftRef),
    /// A torque. Of the input and the output: positive drives, so that power enters at the input and leaves at the
    /// output; of a member: the external torque on it, as in the train file.
    Torque(ShaftRef),
    /// A power, with the same signs.
    Power(ShaftRef),
    /// Speed of the input over that of the output: the input turns as the operation says, and the output follows.
    Ratio,
    /// Power out of the store of the variator with that place in the train.
    Store(usize),
    /// Temperature of the oil in the operating point.
    Temperature,
    /// The state of the shift table.
    State,
    /// The law of a family.
    Law(&'static str),
    /// A key of the train file.
    File(Key),
}

/// The shaft of a name in `asked`: a role where it is one, else a member.
///
/// # Errors
/// A name that is a role and that of another member: their signs differ, so neither is taken.
pub(crate) fn shaft(train: &Train, who: &str, asked: &str) -> Result<Option<ShaftRef>, Box<Diagnostic>> {
    let member = train.member(who);
    let (role, end) = match who {
        "input" => (ShaftRef::Input, train.input),
        "output" => (ShaftRef::Output, train.output),
        _ => return Ok(member.map(ShaftRef::Member)),
    };
    match (member, end) {
        (Some(member), None) => Ok(Some(ShaftRef::Member(member))),
        (Some(member), Some(end)) if member != end => {
            let message = format!(
                "`{asked}` has two meanings: the member called `{who}`, and the {who} of the train, which is `{}`",
                train.member_name(end)
            );
            let d = Diagnostic::new(Code::DuplicateName, "", message);
            Err(Box::new(d.hint(format!("call the member `{who}` something else"))))
        }
        _ => Ok(Some(role)),
    }
}

impl Target {
    /// The quantity of a name: `input.speed`, `carrier.torque`, `oil.temperature`, `state`, `law.mesh_friction`, or a
    /// path of the train file.
    ///
    /// # Errors
    /// No such quantity; with the nearest.
    pub fn parse(name: &str, model: &Model) -> Result<Self, Box<Diagnostic>> {
        let train = model.train();
        if name == "state" {
            return match train.states().is_empty() {
                false => Ok(Self::State),
                true => Err(Box::new(Diagnostic::new(
                    Code::UnknownName,
                    "",
                    "`state` cannot be varied: the train has no shift table",
                ))),
            };
        }
        if name == "ratio" {
            return match (train.input, train.output) {
                (Some(input), Some(output)) if input != output => Ok(Self::Ratio),
                _ => Err(Box::new(
                    Diagnostic::new(
                        Code::NothingAsked,
                        "",
                        "`ratio` cannot be varied: the train has no input and output",
                    )
                    .hint("name two `terminals`, or `input` and `output`"),
                )),
            };
        }
        let buses = || (0..train.variators.len()).filter(|&k| train.variators[k].has_bus());
        let store = match name {
            "store" => buses().next().filter(|_| buses().count() == 1),
            _ => buses().find(|&k| name.strip_suffix(".store") == Some(train.variators[k].name.as_str())),
        };
        if let Some(k) = store {
            return Ok(Self::Store(k));
        }
        if matches!(name, "oil.temperature" | "temperature") {
            return match &train.lubrication {
                Some(_) => Ok(Self::Temperature),
                None => Err(Box::new(
                    Diagnostic::new(Code::MissingKey, "oil", "the oil's temperature is to vary, and there is no oil")
                        .hint("add [oil] with a name of the catalogue, or its viscosities"),
                )),
            };
        }
        if let Some(family) = name.strip_prefix("law.").or(name.strip_prefix("laws."))
            && let Some(family) = FAMILIES.iter().find(|f| **f == family)
        {
            return Ok(Self::Law(family));
        }
        if let Some((who, what)) = name.rsplit_once('.')
            && matches!(what, "speed" | "torque" | "power")
            && let Some(who) = shaft(train, who, name)?
        {
            return Ok(match what {
                "speed" => Self::Speed(who),
                "torque" => Self::Torque(who),
                _ => Self::Power(who),
            });
        }
        model.document().find(name).map(Self::File).map_err(|mut d| {
            // All but the frame, whose speed nobody sets.
            let shafts = ["input", "output"].into_iter().chain(train.members().iter().skip(1).map(|m| m.name.as_str()));
            let mut own: Vec<String> =
                shafts.flat_map(|m| ["speed", "torque", "power"].map(|what| format!("{m}.{what}"))).collect();
            own.extend(["state".into(), "oil.temperature".into()]);
            own.extend(FAMILIES.iter().map(|f| format!("law.{f}")));
            let nearer = Diagnostic::new(Code::UnknownName, "", "").suggest(name, own.iter().map(String::as_str));
            let distance = |d: &Diagnostic| d.replacement.as_ref().map_or(usize::MAX, |r| strsim::levenshtein(r, name));
            if distance(&nearer) < distance(&d) {
                d.hints = nearer.hints;
                d.replacement = nearer.replacement;
            }
            d.message = format!("there is no quantity `{name}` to vary");
            d
        })
    }

    /// What its values are.
    pub(crate) fn measure(&self, _: &Model) -> Measure {
        match self {
            Self::Speed(_) => Measure::Quantity(Dimension::ANGULAR_SPEED),
            Self::Torque(_) => Measure::Quantity(Dimension::TORQUE),
            Self::Power(_) | Self::Store(_) => Measure::Quantity(Dimension::POWER),
            Self::Ratio => Measure::Number,
            Self::Temperature => Measure::Quantity(Dimension::TEMPERATURE),
            Self::State | Self::Law(_) => Measure::Text,
            Self::File(key) => key.measure,
        }
    }

    /// Whether the train itself changes with it, not only the operating point.
    pub fn is_of_train(&self) -> bool {
        matches!(self, Self::Law(_) | Self::File(_))
    }

    /// `all` written out.
    pub(crate) fn choices(&self, model: &Model, given: &[String]) -> Option<Vec<String>> {
        if given != ["all"] {
            return None;
        }
        match self {
            Self::State => Some(model.train().states().iter().map(|s| s.name.clone()).collect()),
            Self::Law(family) => {
                let laws = losses::entries().into_iter().filter(|e| e.family == *family);
                // A law that needs what this train does not give is left out.
                let fits = |id: &str| model.train().clone().with_law(family, id).is_ok();
                Some(laws.filter(|e| fits(e.id)).map(|e| e.id.to_owned()).collect())
            }
            _ => None,
        }
    }

    /// Whether values can be set.
    pub(crate) fn check(&self, model: &Model, values: &[String]) -> Result<(), Box<Diagnostic>> {
        let fault = |message: String| Box::new(Diagnostic::new(Code::BadAxis, "", message));
        for value in values {
            match self {
                Self::State => {
                    model.train().find_state(value)?;
                }
                Self::Law(family) => {
                    model.train().clone().with_law(family, value).map_err(|wrong| {
                        let first = wrong.into_iter().next();
                        Box::new(first.expect("a law that is refused is refused for a reason"))
                    })?;
                }
                Self::File(key) => {
                    let mut document: Document = model.document().clone();
                    document.set(key, value).map_err(fault)?;
                }
                Self::Ratio => {
                    let zero = value.parse::<Rational>().ok().filter(|r| !r.is_zero());
                    zero.ok_or_else(|| {
                        fault(format!("a ratio of {value}: it is the input's speed over the output's"))
                    })?;
                }
                _ => {
                    let Measure::Quantity(dimension) = self.measure(model) else { continue };
                    let given = quantity(value, dimension).map_err(fault)?;
                    if *self == Self::Temperature {
                        oil_temperature(given.si())?;
                    }
                }
            }
        }
        Ok(())
    }
}

/// Whether oil can be that warm, K: what the train file says of it too.
pub(crate) fn oil_temperature(kelvin: f64) -> Result<f64, Box<Diagnostic>> {
    if (200.0..=600.0).contains(&kelvin) {
        return Ok(kelvin);
    }
    let message = format!("an oil temperature of {:.1} °C is none that a gearbox has", kelvin - 273.15);
    Err(Box::new(Diagnostic::new(Code::OutOfRange, "", message).hint("from -73 to 327 °C is computed")))
}

/// A value with a unit.
pub(crate) fn quantity(text: &str, dimension: Dimension) -> Result<Quantity, String> {
    units::parse(text, dimension)
        .map_err(|e| format!("\"{text}\" is not {}: {e}; {}", dimension.describe().0, e.hint()))
}
