//! Laws that were used outside their ranges.

use std::fmt;

use serde::{Deserialize, Serialize};

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
        let mut places: Vec<String> = Vec::new();
        for p in &self.places {
            let value = p.value.map_or("no finite value".to_owned(), |x| readable(x, unit));
            let text = format!("{} ({value})", p.name);
            // Values that differ beyond what is shown are told once.
            if !places.contains(&text) {
                places.push(text);
            }
        }
        write!(f, "{family} = {law} of {} is outside its range, {symbol} ", places.join(", "))?;
        match (self.low, self.high) {
            (Some(low), Some(high)) => write!(f, "from {} to {}", readable(low, unit), readable(high, unit)),
            (None, high) => write!(f, "up to {}", readable(high.unwrap_or(f64::INFINITY), unit)),
            (Some(low), None) => write!(f, "from {}", readable(low, unit)),
        }
    }
}

/// A value with a unit that people use, four digits.
fn readable(value: f64, unit: &str) -> String {
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
    let mut text = format!("{x:.digits$}");
    if text.contains('.') {
        text = text.trim_end_matches('0').trim_end_matches('.').to_owned();
    }
    if unit.is_empty() { text } else { format!("{text} {unit}") }
}
