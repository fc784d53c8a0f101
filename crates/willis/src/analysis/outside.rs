//! Laws that were used outside their ranges.

use std::fmt::{self, Write as _};
use std::ops::Range;

use serde::{Deserialize, Serialize};
use smallvec::SmallVec;

use crate::operating_point::Extrapolation;

/// A quantity outside the range of a law, wherever it was.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct OutsideLaw {
    /// Family of the law.
    pub family: String,
    /// Name of the law.
    pub law: String,
    /// Symbol of the quantity.
    pub symbol: String,
    /// Its SI unit; `-` for a pure number.
    pub unit: String,
    /// Lowest value of the range, in that unit; absent where there is none.
    pub low: Option<f64>,
    /// Highest value of the range, in that unit; absent where there is none.
    pub high: Option<f64>,
    /// Where the law was used so.
    pub places: Vec<OutsideAt>,
}

/// A place where a law was used outside its range.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct OutsideAt {
    /// The mesh, bearing, seal, gear or rotor.
    pub name: String,
    /// The value there, in the unit of the quantity; absent where it is not finite.
    pub value: Option<f64>,
}

impl OutsideLaw {
    /// One for each quantity of a law.
    pub(super) fn of(all: &[Extrapolation]) -> Vec<Self> {
        let mut told: Vec<Self> = Vec::new();
        let finite = |x: f64| x.is_finite().then_some(x);
        for x in all {
            let same = |o: &Self| (&*o.family, &*o.law, &*o.symbol) == (x.family, x.law, x.outside.symbol);
            let k = told.iter().position(same).unwrap_or_else(|| {
                told.push(Self {
                    family: x.family.to_owned(),
                    law: x.law.to_owned(),
                    symbol: x.outside.symbol.to_owned(),
                    unit: x.outside.unit.to_owned(),
                    low: finite(x.outside.range.0).filter(|low| *low > 0.0),
                    high: finite(x.outside.range.1),
                    places: vec![],
                });
                told.len() - 1
            });
            let at = OutsideAt { name: x.at.clone(), value: finite(x.outside.value) };
            if !told[k].places.contains(&at) {
                told[k].places.push(at);
            }
        }
        told
    }
}

impl fmt::Display for OutsideLaw {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { family, law, symbol, unit, .. } = self;
        // One text, since a study says it of many points.
        let mut text = format!("{family} = {law} of ");
        let mut told: SmallVec<[Range<usize>; 8]> = SmallVec::new();
        for p in &self.places {
            let before = text.len();
            text += if told.is_empty() { "" } else { ", " };
            let start = text.len();
            text.extend([&*p.name, " ("]);
            match p.value {
                Some(x) => add_readable(&mut text, x, unit),
                None => text += "no finite value",
            }
            text += ")";
            let own = start..text.len();
            // Values that differ beyond what is shown are told once.
            match told.iter().any(|other| text[other.clone()] == text[own.clone()]) {
                true => text.truncate(before),
                false => told.push(own),
            }
        }
        text.extend([" is outside its range, ", symbol, " "]);
        let mut add = |word: &str, x: f64| {
            text += word;
            add_readable(&mut text, x, unit);
        };
        match (self.low, self.high) {
            (Some(low), Some(high)) => {
                add("from ", low);
                add(" to ", high);
            }
            (None, high) => add("up to ", high.unwrap_or(f64::INFINITY)),
            (Some(low), None) => add("from ", low),
        }
        f.write_str(&text)
    }
}

/// Adds a value with a unit that people use, four digits.
fn add_readable(text: &mut String, value: f64, unit: &str) {
    let (factor, unit) = match unit {
        "m" if value.abs() < 1e-3 => (1e6, "µm"),
        "m" => (1e3, "mm"),
        "N/m" => (1e-3, "N/mm"),
        "Pa" if value.abs() >= 1e5 => (1e-6, "MPa"),
        "Pa s" => (1e3, "mPa s"),
        "m^2/s" | "m²/s" => (1e6, "mm²/s"),
        "rad/s" => (30.0 / std::f64::consts::PI, "rpm"),
        "-" => (1.0, ""),
        other => (1.0, other),
    };
    let x = value * factor;
    let digits = if x == 0.0 || !x.is_finite() { 0 } else { (3 - x.abs().log10().floor() as i32).clamp(0, 9) as usize };
    let start = text.len();
    write!(text, "{x:.digits$}").expect("a text takes all");
    if digits > 0 && x.is_finite() {
        let zeros = |part: &str| part.trim_end_matches('0').trim_end_matches('.').len();
        text.truncate(start + zeros(&text[start..]));
    }
    if !unit.is_empty() {
        text.extend([" ", unit]);
    }
}
