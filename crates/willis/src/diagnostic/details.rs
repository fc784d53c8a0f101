//! What a diagnostic is about, as data: a reader of it acts on this, and never on the sentence.

use std::fmt;

use serde::{Deserialize, Serialize};

/// What a diagnostic is about.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(tag = "kind", rename_all = "snake_case")]
#[non_exhaustive]
pub enum Details {
    /// A law was used outside the range of its source.
    OutsideLaw(OutsideLaw),
}

/// A law that was used outside the range of its source.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct OutsideLaw {
    /// Family of the law, `mesh_friction`.
    pub family: String,
    /// Name of the law, `schlenk`.
    pub law: String,
    /// Symbol of the quantity that leaves its range, as in the law's table of symbols.
    pub quantity: String,
    /// SI unit of the quantity and its limits; `-` for a plain number.
    pub unit: String,
    /// Lowest value of the range, SI; absent where there is none.
    pub min: Option<f64>,
    /// Highest value of the range, SI; absent where there is none.
    pub max: Option<f64>,
    /// Where the law was used outside.
    pub at: Vec<OutsideAt>,
}

/// One part of a train at which a law left its range.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct OutsideAt {
    /// The mesh, bearing, seal or body.
    pub part: String,
    /// The value of the quantity there, SI; absent where it is not finite.
    pub value: Option<f64>,
}

impl OutsideLaw {
    /// A law whose quantity has left its range, with no place yet.
    pub fn new(family: &str, law: &str, quantity: &str, unit: &str, range: (f64, f64)) -> Self {
        let finite = |x: f64| Some(x).filter(|x| x.is_finite());
        Self {
            family: family.into(),
            law: law.into(),
            quantity: quantity.into(),
            unit: unit.into(),
            min: finite(range.0),
            max: finite(range.1),
            at: Vec::new(),
        }
    }

    /// Adds a part at which it was so; twice the same in words is said once.
    pub fn push(&mut self, part: &str, value: f64) {
        let value = Some(value).filter(|x| x.is_finite());
        let new = OutsideAt { part: part.into(), value };
        let said = |at: &OutsideAt| (at.part.clone(), at.value.map(|x| readable(x, &self.unit)));
        if !self.at.iter().any(|at| said(at) == said(&new)) {
            self.at.push(new);
        }
    }
}

impl fmt::Display for OutsideLaw {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} = {} of ", self.family, self.law)?;
        for (k, at) in self.at.iter().enumerate() {
            let value = readable(at.value.unwrap_or(f64::INFINITY), &self.unit);
            write!(f, "{}{} ({value})", if k > 0 { ", " } else { "" }, at.part)?;
        }
        write!(f, " is outside its range, {} ", self.quantity)?;
        // A lowest value of 0 goes without saying.
        match (self.min.filter(|low| *low > 0.0), self.max) {
            (Some(low), Some(high)) => {
                write!(f, "from {} to {}", readable(low, &self.unit), readable(high, &self.unit))
            }
            (Some(low), None) => write!(f, "from {}", readable(low, &self.unit)),
            (None, high) => write!(f, "up to {}", readable(high.unwrap_or(f64::INFINITY), &self.unit)),
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
