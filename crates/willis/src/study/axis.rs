//! The values that one quantity takes in a study.

use std::collections::HashSet;

use crate::diagnostic::{Code, Diagnostic};
use crate::exact::Rational;
use crate::model::{Model, ShaftRef, Target, quantity};
use crate::train::Measure;
use crate::units::{Dimension, Quantity, with_unit};

/// Most values of an axis.
const MOST: u64 = 1_000_000_000_000_000;
/// Values up to so many are made once.
const MOST_KEPT: usize = 1 << 20;
/// Values up to so many are written once.
const MOST_WRITTEN: usize = 4096;

/// One quantity and the values it takes.
///
/// # Grammar
/// `QUANTITY=VALUES`, where the values are
///
/// | text | values |
/// |---|---|
/// | `500 rpm..12000 rpm:100` | 100 values, evenly spaced, both ends included |
/// | `1 N m..1000 N m:31:log` | 31 values with a constant ratio |
/// | `500 rpm..12000 rpm:step 500 rpm` | every 500 rpm, from the first on, up to the second |
/// | `3..6` | of whole numbers: 3, 4, 5, 6 |
/// | `3,4,6`, `20 degC, 60 degC` | these |
///
/// A unit at one end holds for the other too. Every value is a decimal number, so that a train file can say the same:
/// the double nearest to it, written with the fewest digits that mean that double.
#[derive(Clone, Debug)]
pub struct Axis {
    /// The quantity as it was written.
    pub name: String,
    pub(super) target: Target,
    /// The unit of its values; empty for plain numbers and for texts.
    pub unit: String,
    values: Values,
    /// The numbers, where they are few.
    numbers: Vec<f64>,
    /// The values as the train file writes them, where they are fewer still.
    written: Vec<String>,
}

#[derive(Clone, Debug)]
enum Values {
    Even { from: Rational, step: Rational, count: usize },
    Ratio { from: f64, to: f64, count: usize },
    Numbers(Vec<Rational>),
    Texts(Vec<String>),
}

fn fault(text: &str, what: impl std::fmt::Display) -> Box<Diagnostic> {
    let message = format!("`{}`: {what}", text.chars().take(120).collect::<String>());
    Box::new(Diagnostic::new(Code::BadAxis, "", message))
}

const GRAMMAR: &str = "values are written `500 rpm..12000 rpm:100` (so many, ends included), `…:31:log`, \
                       `…:step 500 rpm`, or `3,4,6`";

impl Axis {
    /// Reads `QUANTITY=VALUES`.
    ///
    /// # Errors
    /// No quantity of that name (with the nearest), and what is wrong with the values.
    pub fn parse(text: &str, model: &Model) -> Result<Self, Box<Diagnostic>> {
        let Some((name, values)) = text.split_once('=') else {
            return Err(Box::new(fault(text, "there is no `=` between a quantity and its values").hint(GRAMMAR)));
        };
        let (name, values) = (name.trim(), values.trim());
        let target = Target::parse(name, model)?;
        if values.is_empty() {
            return Err(Box::new(fault(text, "there are no values").hint(GRAMMAR)));
        }
        let axis = match target.measure(model) {
            Measure::Text | Measure::Flag => {
                let all: Vec<String> = values.split(',').map(|v| v.trim().to_owned()).collect();
                let all = target.choices(model, &all).unwrap_or(all);
                Self {
                    name: name.to_owned(),
                    target,
                    unit: String::new(),
                    values: Values::Texts(all),
                    numbers: vec![],
                    written: vec![],
                }
            }
            measure => {
                let (values, unit) = numbers(text, values, measure)?;
                let mut axis = Self { name: name.to_owned(), target, unit, values, numbers: vec![], written: vec![] };
                if axis.len() <= MOST_KEPT {
                    axis.numbers = (0..axis.len()).map(|k| axis.make(k)).collect();
                }
                if axis.len() <= MOST_WRITTEN {
                    axis.written = (0..axis.len()).map(|k| axis.write(k)).collect();
                }
                axis
            }
        };
        axis.target.check(model, &axis.first_and_last()).map_err(|what| {
            let mut d = *what;
            d.message = format!("`{name}`: {}", d.message);
            if let (Target::State, Some(states)) = (&axis.target, d.hints.last_mut()) {
                states.push_str("; `all` takes them all");
            }
            Box::new(d)
        })?;
        if let Values::Texts(_) | Values::Numbers(_) = &axis.values {
            let mut seen = HashSet::new();
            if let Some(twice) = (0..axis.len()).map(|k| axis.setting(k)).find(|s| !seen.insert(s.clone())) {
                return Err(fault(text, format!("{twice} stands there twice")));
            }
        }
        Ok(axis)
    }

    /// How many values it takes.
    pub fn len(&self) -> usize {
        match &self.values {
            Values::Even { count, .. } | Values::Ratio { count, .. } => *count,
            Values::Numbers(all) => all.len(),
            Values::Texts(all) => all.len(),
        }
    }

    /// Whether it takes none; never.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether its values are texts: states, laws, kinds.
    pub fn is_text(&self) -> bool {
        matches!(self.values, Values::Texts(_))
    }

    /// Whether it takes the states of the shift table.
    pub fn is_state(&self) -> bool {
        self.target == Target::State
    }

    /// A value as a number in its [unit](Self::unit); NaN of a text.
    pub fn number(&self, k: usize) -> f64 {
        self.numbers.get(k).copied().unwrap_or_else(|| self.make(k))
    }

    fn make(&self, k: usize) -> f64 {
        match &self.values {
            Values::Even { from, step, .. } => (from + &(step * &Rational::from(k as i64))).to_f64(),
            Values::Ratio { from, to, count } => {
                let part = k as f64 / (count - 1).max(1) as f64;
                // The ends are what was written.
                if k + 1 == *count { *to } else { from * (to / from).powf(part) }
            }
            Values::Numbers(all) => all[k].to_f64(),
            Values::Texts(_) => f64::NAN,
        }
    }

    /// A value as the train file writes it.
    pub fn setting(&self, k: usize) -> String {
        self.written.get(k).cloned().unwrap_or_else(|| self.write(k))
    }

    fn write(&self, k: usize) -> String {
        match (&self.values, self.unit.is_empty()) {
            (Values::Texts(all), _) => all[k].clone(),
            (_, true) => self.number(k).to_string(),
            (_, false) => format!("{} {}", self.number(k), self.unit),
        }
    }

    /// Name of its column in a table, its unit included: `sun.speed_rpm`. What is the input's or the output's by its role
    /// is `output_torque_n_m`: a member may be called `output`, and the torque on it has the other sign.
    pub fn column(&self) -> String {
        let by_role = matches!(
            self.target,
            Target::Speed(ShaftRef::Input | ShaftRef::Output)
                | Target::Torque(ShaftRef::Input | ShaftRef::Output)
                | Target::Power(ShaftRef::Input | ShaftRef::Output)
        );
        let name = if by_role { self.name.replace('.', "_") } else { self.name.clone() };
        with_unit(&name, &self.unit)
    }

    fn first_and_last(&self) -> Vec<String> {
        match &self.values {
            Values::Texts(all) => all.clone(),
            Values::Numbers(all) if all.len() <= 1000 => (0..all.len()).map(|k| self.setting(k)).collect(),
            _ => vec![self.setting(0), self.setting(self.len() - 1)],
        }
    }
}

/// Number and unit of a text.
fn split(text: &str) -> (&str, &str) {
    let text = text.trim();
    let end = text
        .char_indices()
        .find(|&(at, c)| {
            let exponent = matches!(c, 'e' | 'E')
                && at > 0
                && text[at + 1..].trim_start_matches(['+', '-']).starts_with(|d: char| d.is_ascii_digit());
            !(c.is_ascii_digit() || matches!(c, '.' | '+' | '-' | '_' | '\u{2212}') || exponent)
        })
        .map_or(text.len(), |(at, _)| at);
    (text[..end].trim(), text[end..].trim())
}

/// Reads values alone, `500 rpm..12000 rpm:100` or `10 N m, 20 N m`.
///
/// # Errors
/// What is wrong with them.
///
/// # Example
/// ```
/// use willis::units::Dimension;
///
/// let speeds = willis::study::values("500..1500 rpm:3", Dimension::ANGULAR_SPEED)?;
/// assert_eq!(speeds[1].si(), willis::units::parse("1000 rpm", Dimension::ANGULAR_SPEED).unwrap().si());
/// # Ok::<(), Box<willis::diagnostic::Diagnostic>>(())
/// ```
pub fn values(text: &str, dimension: Dimension) -> Result<Vec<Quantity>, Box<Diagnostic>> {
    let (values, unit) = numbers(text, text, Measure::Quantity(dimension))?;
    let axis =
        Axis { name: String::new(), target: Target::Temperature, unit, values, numbers: vec![], written: vec![] };
    if axis.len() > MOST_KEPT {
        return Err(fault(text, format!("{} values are too many", axis.len())));
    }
    (0..axis.len()).map(|k| quantity(&axis.setting(k), dimension).map_err(|what| fault(text, what))).collect()
}

fn numbers(whole: &str, values: &str, measure: Measure) -> Result<(Values, String), Box<Diagnostic>> {
    let read = |text: &str| -> Result<Rational, Box<Diagnostic>> {
        let plain = text.replace(['\u{2212}'], "-");
        let number: Option<Rational> = plain.parse().ok();
        let number = number.filter(|x| x.to_f64().is_finite());
        number.ok_or_else(|| Box::new(fault(whole, format!("`{text}` is no number")).hint(GRAMMAR)))
    };
    let is_integer = measure == Measure::Integer;
    let integer = |x: &Rational| -> Result<(), Box<Diagnostic>> {
        if !is_integer || x.is_integer() {
            return Ok(());
        }
        Err(fault(whole, format!("{} is not a whole number, and this quantity is one", x.to_f64())))
    };
    let Some((from, rest)) = values.split_once("..") else {
        let parts: Vec<(&str, &str)> = values.split(',').map(split).collect();
        let units: Vec<&str> = parts.iter().map(|p| p.1).filter(|u| !u.is_empty()).collect();
        let unit = *units.last().unwrap_or(&"");
        if let Some(other) = units.iter().find(|u| **u != unit) {
            return Err(fault(whole, format!("two units, `{other}` and `{unit}`: write all values in one")));
        }
        let all: Vec<Rational> = parts.iter().map(|p| read(p.0)).collect::<Result<_, _>>()?;
        all.iter().try_for_each(integer)?;
        return Ok((Values::Numbers(all), unit.to_owned()));
    };
    let (to, how) = match rest.split_once(':') {
        Some((to, how)) => (to, how.trim()),
        None => (rest, ""),
    };
    let ((a, first), (b, second)) = (split(from), split(to));
    // `nan rpm` has no number either.
    let (from, to) =
        (read(if a.is_empty() { from.trim() } else { a })?, read(if b.is_empty() { to.trim() } else { b })?);
    if !first.is_empty() && !second.is_empty() && first != second {
        return Err(fault(whole, format!("two units, `{first}` and `{second}`: write both ends in one")));
    }
    let unit = if first.is_empty() { second } else { first };
    integer(&from)?;
    integer(&to)?;
    if from == to {
        let hint = format!("a single value is written `…={}`", from.to_f64());
        return Err(Box::new(fault(whole, "the range is empty: both ends are the same").hint(hint)));
    }
    if from > to {
        let message = format!("the range runs backwards, from {} down to {}", from.to_f64(), to.to_f64());
        return Err(Box::new(fault(whole, message).hint("write the smaller value first")));
    }
    let width = &to - &from;
    let even = |step: Rational| -> Result<Values, Box<Diagnostic>> {
        let count = (&width / &step).floor().to_f64() + 1.0;
        if count > MOST as f64 || count > usize::MAX as f64 {
            return Err(fault(whole, format!("{count:.0e} values are beyond all measure")));
        }
        Ok(Values::Even { from: from.clone(), step, count: count as usize })
    };
    if let Some(step) = how.strip_prefix("step") {
        let (step, own) = split(step.trim_start_matches(['=', ' ']));
        if !own.is_empty() && own != unit {
            return Err(fault(whole, format!("the step is in `{own}`, the range in `{unit}`")));
        }
        let step = read(step)?;
        if step.sign() <= 0 {
            return Err(fault(whole, "a step is above zero"));
        }
        integer(&step)?;
        return Ok((even(step)?, unit.to_owned()));
    }
    if how.is_empty() {
        if is_integer {
            return Ok((even(Rational::ONE)?, unit.to_owned()));
        }
        let hint = format!("write `{values}:50` for 50 values, ends included");
        return Err(Box::new(fault(whole, "it does not say how many values").hint(hint)));
    }
    let (count, log) = match how.split_once(':') {
        Some((count, log)) if log.trim() == "log" => (count.trim(), true),
        Some((_, other)) => {
            return Err(Box::new(fault(whole, format!("`{}` is no way to space values", other.trim())).hint(GRAMMAR)));
        }
        None => (how, false),
    };
    let count: usize = match count.parse::<u64>() {
        // As many as can be counted here; a browser counts less far.
        Ok(count) if (2..=MOST).contains(&count) && usize::try_from(count).is_ok() => count as usize,
        Ok(1) => return Err(fault(whole, "a range has at least 2 values")),
        _ => return Err(Box::new(fault(whole, format!("`{count}` is no number of values")).hint(GRAMMAR))),
    };
    if log {
        if is_integer {
            return Err(fault(whole, "whole numbers are spaced evenly, or listed"));
        }
        let (from, to) = (from.to_f64(), to.to_f64());
        if from <= 0.0 {
            let message = format!("values with a constant ratio are above zero, and it begins at {from}");
            return Err(fault(whole, message));
        }
        return Ok((Values::Ratio { from, to, count }, unit.to_owned()));
    }
    let step = width / Rational::from(count as i64 - 1);
    if is_integer && !step.is_integer() {
        let message = format!("{count} values from {} to {} are not whole numbers", from.to_f64(), to.to_f64());
        return Err(Box::new(fault(whole, message).hint("leave out how many, or list them")));
    }
    Ok((Values::Even { from, step, count }, unit.to_owned()))
}
