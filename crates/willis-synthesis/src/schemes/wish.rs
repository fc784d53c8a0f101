//! What a shift scheme must do, as plain data, and what can be wrong with it.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};
use willis::diagnostic::{Code, Diagnostic, Diagnostics};
use willis::exact::Rational;

use super::choose::MAX_ELEMENTS;
use super::layout::{Layout, MAX_SETS};
use super::motion::{self, MAX_MOBILITY};
use super::table::binomial;

/// The tooth ratio of a simple set, ring over sun.
///
/// Written as a fraction of two whole numbers, these are the teeth, and train files are written with them.
///
/// # Example
/// ```
/// use willis_synthesis::schemes::SetRatio;
///
/// let set: SetRatio = "96/48".parse()?;
/// assert_eq!((set.ratio().to_string(), set.teeth()), ("2".into(), Some([48, 96])));
/// assert_eq!("1.7".parse::<SetRatio>()?.ratio().to_string(), "17/10");
/// assert!("3/4".parse::<SetRatio>().is_err());
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SetRatio {
    ratio: Rational,
    /// Sun, ring.
    teeth: Option<[u32; 2]>,
}

impl SetRatio {
    /// Ring over sun.
    pub fn ratio(&self) -> &Rational {
        &self.ratio
    }

    /// Teeth of sun and ring, where they were given.
    pub fn teeth(&self) -> Option<[u32; 2]> {
        self.teeth
    }
}

impl FromStr for SetRatio {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let ratio: Rational = text.trim().parse().map_err(|why| format!("the tooth ratio `{text}`: {why}"))?;
        if ratio <= Rational::ONE {
            return Err(format!("the tooth ratio {text} is not above 1: a ring has more teeth than its sun"));
        }
        let whole = |part: &str| part.trim().parse::<u32>().ok();
        let teeth = text.split_once('/').and_then(|(ring, sun)| Some([whole(sun)?, whole(ring)?]));
        Ok(Self { ratio, teeth })
    }
}

impl fmt::Display for SetRatio {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.teeth {
            Some([sun, ring]) => write!(f, "{ring}/{sun}"),
            None => self.ratio.fmt(f),
        }
    }
}

/// A closed range of positive numbers, exact; an end that is left out does not bound: `1.1..2.2`, `..3`, `1/2..`.
///
/// # Example
/// ```
/// use willis_synthesis::schemes::Bounds;
///
/// let step: Bounds = "1.1..2.2".parse()?;
/// assert_eq!(step.min.as_ref().map(ToString::to_string), Some("11/10".into()));
/// assert_eq!(step.to_string(), "11/10..11/5");
/// assert!("2..1".parse::<Bounds>().is_err());
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Bounds {
    /// The lower end.
    pub min: Option<Rational>,
    /// The upper end.
    pub max: Option<Rational>,
}

impl FromStr for Bounds {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let end = |part: &str| match part.trim() {
            "" => Ok(None),
            number => match number.parse::<Rational>() {
                Ok(value) if value.sign() > 0 => Ok(Some(value)),
                Ok(_) => Err(format!("the range `{text}` must be of positive numbers")),
                Err(why) => Err(format!("the range `{text}`: {why}")),
            },
        };
        let (min, max) = text.split_once("..").ok_or_else(|| format!("`{text}` is no range such as `1.1..2.2`"))?;
        let own = Self { min: end(min)?, max: end(max)? };
        match (&own.min, &own.max) {
            (Some(min), Some(max)) if min > max => Err(format!("the range `{text}` is empty")),
            _ => Ok(own),
        }
    }
}

impl fmt::Display for Bounds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let end = |end: &Option<Rational>| end.as_ref().map_or_else(String::new, ToString::to_string);
        write!(f, "{}..{}", end(&self.min), end(&self.max))
    }
}

macro_rules! as_text {
    ($($type:ident $example:literal),*) => { $(
        impl Serialize for $type {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.collect_str(self)
            }
        }

        impl<'de> Deserialize<'de> for $type {
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                String::deserialize(deserializer)?.parse().map_err(serde::de::Error::custom)
            }
        }

        #[cfg(feature = "schema")]
        impl schemars::JsonSchema for $type {
            fn inline_schema() -> bool {
                true
            }

            fn schema_name() -> std::borrow::Cow<'static, str> {
                stringify!($type).into()
            }

            fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
                schemars::json_schema!({ "type": "string", "examples": [$example] })
            }
        }
    )* };
}

as_text!(SetRatio "96/48", Bounds "1.1..2.2");

/// What is best among the schemes that do what is wanted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Order {
    /// None: the order of layouts and elements.
    #[default]
    Found,
    /// The largest spread, first gear over last.
    Spread,
    /// The smallest largest torque of an element, per torque of the input.
    Torque,
    /// The smallest largest speed of a shaft, per speed of the input.
    Speed,
    /// The smallest largest step.
    Step,
    /// The largest smallest efficiency of a gear, with the mesh efficiencies of the wish.
    Efficiency,
}

impl FromStr for Order {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let all = [("found", Self::Found), ("spread", Self::Spread), ("torque", Self::Torque), ("speed", Self::Speed)];
        let all = all.into_iter().chain([("step", Self::Step), ("efficiency", Self::Efficiency)]);
        let named = all.clone().find(|(name, _)| *name == text).map(|(_, order)| order);
        let names: Vec<&str> = all.map(|(name, _)| name).collect();
        named.ok_or_else(|| format!("`{text}` is no order; there are {}", names.join(", ")))
    }
}

impl fmt::Display for Order {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Found => "found",
            Self::Spread => "spread",
            Self::Torque => "torque",
            Self::Speed => "speed",
            Self::Step => "step",
            Self::Efficiency => "efficiency",
        })
    }
}

/// What a shift scheme must do.
///
/// A scheme is a [`Layout`] of simple planetary sets with clutches and brakes. In every gear `closed` of the `elements`
/// are closed, and exactly one freedom is left. The wish holds if
///
/// * there is a chain of `forward` gears whose ratios fall strictly, lie in `forward_range`, and whose successive
///   quotients lie in `step`; from gear to gear one element opens and one closes;
/// * there are `reverse` gears with different ratios, whose modulus lies in `reverse_range`;
/// * every shaft has at least two attachments (members, ends of elements, and one for input or output if it has a
///   member): none dangles;
/// * no two elements are kinematically the same;
/// * with `minimal`, no element can be left out;
/// * with `progressive`, no step is larger than the one before it;
/// * with `max_speed` and `max_torque`, in the gears of the chain and in reverse no shaft turns faster and no closed
///   element carries more, per speed and torque of the input, without losses;
/// * with `min_efficiency`, each of these gears has one efficiency when the input drives, not below it, with
///   `mesh_efficiencies` in every set;
/// * with `planar`, the scheme can be drawn with nested shafts without a crossing.
///
/// # Example
/// ```
/// use willis_synthesis::schemes::{Search, Wish};
/// use willis::work::Serial;
///
/// let wish = Wish {
///     reverse_range: "1.2..5".parse()?,
///     step: "1.15..2.2".parse()?,
///     forward_range: "1/2..5".parse()?,
///     ..Wish::new(&["62/26", "74/42"], 4, 2, 3)?
/// };
/// let answer = Search::new(&wish)?.run(&Serial)?;
/// assert_eq!((answer.found.schemes, answer.found.classes), (653, 361));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Wish {
    /// The tooth ratio of each set.
    pub sets: Vec<SetRatio>,
    /// Clutches and brakes.
    pub elements: usize,
    /// How many of them are closed in a gear. The mobility is one more.
    pub closed: usize,
    /// Forward gears.
    pub forward: usize,
    /// Reverse gears.
    #[serde(default = "one")]
    pub reverse: usize,
    /// Where the ratios of forward gears lie.
    #[serde(default)]
    pub forward_range: Bounds,
    /// Where the modulus of the ratio of a reverse gear lies.
    #[serde(default)]
    pub reverse_range: Bounds,
    /// Where the quotient of the ratios of successive gears lies.
    #[serde(default)]
    pub step: Bounds,
    /// Whether no step may be larger than the one before it.
    #[serde(default)]
    pub progressive: bool,
    /// Whether no element may be dispensable.
    #[serde(default = "yes")]
    pub minimal: bool,
    /// The largest speed of a shaft, per speed of the input.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max_speed: Option<Rational>,
    /// The largest torque of an element, per torque of the input.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max_torque: Option<Rational>,
    /// The least efficiency of a gear when the input drives.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub min_efficiency: Option<Rational>,
    /// Efficiencies of the meshes of sun and planet, and of planet and ring, in every set, from above 0 to 1.
    #[serde(default = "Wish::usual_meshes")]
    pub mesh_efficiencies: [Rational; 2],
    /// The most brakes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max_brakes: Option<usize>,
    /// Whether it must be possible to draw the scheme without a crossing.
    #[serde(default)]
    pub planar: bool,
    /// The only layout that is searched.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub layout: Option<Layout>,
    /// One of so many layouts is searched: a sample, in which nothing is complete.
    #[serde(default = "one")]
    pub sample: usize,
    /// Which schemes come first.
    #[serde(default)]
    pub order: Order,
    /// How many schemes are shown.
    #[serde(default = "ten")]
    pub top: usize,
}

fn one() -> usize {
    1
}

fn ten() -> usize {
    10
}

/// A number as a decimal that a train file takes.
pub(super) fn decimal(x: &Rational) -> String {
    x.to_f64().to_string()
}

fn yes() -> bool {
    true
}

impl Wish {
    /// Efficiencies of the meshes of sun and planet, and of planet and ring, where nothing is said of them: usual ones, those
    /// of the examples.
    pub fn usual_meshes() -> [Rational; 2] {
        [Rational::new(98, 100), Rational::new(99, 100)]
    }

    /// Schemes of sets with these tooth ratios, so many elements, closed elements and forward gears, and one reverse
    /// gear; everything else is left open.
    ///
    /// # Errors
    /// A tooth ratio that cannot be read or is not above 1.
    pub fn new(sets: &[&str], elements: usize, closed: usize, forward: usize) -> Result<Self, String> {
        Ok(Self {
            sets: sets.iter().map(|text| text.parse()).collect::<Result<_, String>>()?,
            elements,
            closed,
            forward,
            reverse: 1,
            forward_range: Bounds::default(),
            reverse_range: Bounds::default(),
            step: Bounds::default(),
            progressive: false,
            minimal: true,
            max_speed: None,
            max_torque: None,
            min_efficiency: None,
            mesh_efficiencies: Self::usual_meshes(),
            max_brakes: None,
            planar: false,
            layout: None,
            sample: 1,
            order: Order::Found,
            top: 10,
        })
    }

    /// Shafts of a layout besides the housing.
    pub(crate) fn shafts(&self) -> usize {
        self.sets.len().saturating_add(self.closed).saturating_add(1)
    }

    /// The tooth ratios.
    pub(crate) fn ratios(&self) -> Vec<Rational> {
        self.sets.iter().map(|s| s.ratio.clone()).collect()
    }

    /// Everything that is wrong with it, and that it contradicts itself.
    ///
    /// # Errors
    /// All of that.
    pub fn check(&self) -> Result<(), Diagnostics> {
        let mut wrong = Diagnostics::default();
        let mut say = |code: Code, place: &str, message: String, hint: String| {
            wrong.push(Diagnostic::new(code, place, message).hint(hint));
        };
        let sets = self.sets.len();
        if !(1..=MAX_SETS).contains(&sets) {
            let hint = format!("give the tooth ratios of 1 to {MAX_SETS} sets");
            say(Code::OutOfRange, "sets", format!("there are {sets} sets"), hint);
        } else if motion::teeth(&self.ratios()).is_none() {
            let hint = "give ratios of tooth numbers, or decimals with fewer digits".to_owned();
            say(Code::OutOfRange, "sets", "the tooth ratios have too many digits to be computed exactly".into(), hint);
        }
        if !(1..MAX_MOBILITY).contains(&self.closed) {
            let message = format!("{} closed elements in every gear", self.closed);
            say(Code::OutOfRange, "closed", message, format!("there can be 1 to {}", MAX_MOBILITY - 1));
        } else if (1..=MAX_SETS).contains(&sets) && self.closed + 1 > 2 * sets + 2 {
            let message = format!("{} closed elements in every gear, of a train with {sets} sets", self.closed);
            say(Code::OutOfRange, "closed", message, format!("such a train has no more than {} shafts", 3 * sets + 3));
        }
        if !(1..=MAX_ELEMENTS).contains(&self.elements) {
            let message = format!("there are {} elements", self.elements);
            say(Code::OutOfRange, "elements", message, format!("give 1 to {MAX_ELEMENTS}"));
        } else if self.elements < self.closed {
            let message = format!("{} of {} elements cannot be closed", self.closed, self.elements);
            say(Code::Conflict, "closed", message, "want more elements, or fewer closed".into());
        } else {
            let states = binomial(self.elements, self.closed);
            if self.forward.saturating_add(self.reverse) > states {
                let Self { elements, closed, forward, reverse, .. } = self;
                let message = format!(
                    "{closed} of {elements} elements can be closed in {states} ways, too few for {forward} forward \
                     and {reverse} reverse gears"
                );
                say(Code::Conflict, "forward", message, "want more elements or fewer gears".into());
            }
        }
        if self.forward == 0 {
            say(Code::OutOfRange, "forward", "no forward gear is wanted".into(), "want one at least".into());
        }
        if let (Some(min), Some(max), Some(low)) = (&self.forward_range.min, &self.forward_range.max, &self.step.min)
            && self.forward > 1
        {
            let least = (1..self.forward.min(100)).fold(min.clone(), |r, _| &r * low);
            if least > *max && *low > Rational::ONE {
                let message = format!(
                    "{} gears whose steps are {:.3} at least span {:.3}, more than the range from {:.3} to {:.3}",
                    self.forward,
                    low.to_f64(),
                    (&least / min).to_f64(),
                    min.to_f64(),
                    max.to_f64(),
                );
                let hint = "want smaller steps, fewer gears or a wider range".into();
                say(Code::Conflict, "step", message, hint);
            }
        }
        if self.forward > 1 && self.step.max.as_ref().is_some_and(|max| *max <= Rational::ONE) {
            let message = "no step may be above 1, but the ratios of gears fall".to_owned();
            say(Code::Conflict, "step", message, "a step is the ratio of a gear over that of the next".into());
        }
        if let Some(layout) = &self.layout {
            let (found, wanted) = ([layout.sets(), layout.shafts() - 1], [sets, self.shafts()]);
            if found[0] != wanted[0] {
                let message = format!("the layout {layout} has {} sets, and there are {sets} tooth ratios", found[0]);
                say(Code::Conflict, "layout", message, "give one tooth ratio for each set".into());
            } else if found[1] != wanted[1] {
                let closed = (found[1] as i64) - (sets as i64) - 1;
                let message = format!(
                    "the layout {layout} has {} shafts besides the housing, so one freedom is left with {closed} \
                     closed elements, not with {}",
                    found[1], self.closed
                );
                let hint = match closed > 0 {
                    true => format!("want {closed} closed elements"),
                    false => "such a layout leaves nothing to close".to_owned(),
                };
                say(Code::Conflict, "layout", message, hint);
            }
        }
        for (place, limit) in [("max_speed", &self.max_speed), ("max_torque", &self.max_torque)] {
            if limit.as_ref().is_some_and(|l| l.sign() <= 0) {
                say(Code::OutOfRange, place, "the limit is not positive".into(), "a limit is a modulus".into());
            }
        }
        let is_efficiency = |x: &Rational| x.sign() > 0 && *x <= Rational::ONE;
        // One that stands for both meshes is spoken of once.
        let [one, other] = &self.mesh_efficiencies;
        let meshes = [one].into_iter().chain(Some(other).filter(|x| *x != one));
        for (place, x) in
            (meshes.map(|x| ("mesh_efficiencies", x))).chain(self.min_efficiency.iter().map(|x| ("min_efficiency", x)))
        {
            if !is_efficiency(x) {
                let message = format!("an efficiency of {} is not above 0 and at most 1", decimal(x));
                say(Code::OutOfRange, place, message, "give a part of 1, as in 0.98".into());
            }
        }
        if self.sample == 0 {
            say(Code::OutOfRange, "sample", "one of 0 layouts".into(), "1 searches all of them".into());
        } else if self.sample > 1 && self.layout.is_some() {
            let message = format!("one of {} layouts, where only one is searched", self.sample);
            say(Code::Conflict, "sample", message, "leave out `sample` or `layout`".into());
        }
        if self.max_speed.as_ref().is_some_and(|l| l.sign() > 0 && *l < Rational::ONE) {
            let message = "no shaft may turn as fast as the input, which does".to_owned();
            say(Code::Conflict, "max_speed", message, "it is per speed of the input: 1 or more".into());
        }
        if wrong.is_empty() { Ok(()) } else { Err(wrong) }
    }
}
