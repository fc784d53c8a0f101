//! Limits of variators that are exceeded.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::train::{Machine, Variator, VariatorPath};

/// Part by which a limit may be exceeded: a value that was computed to be the limit is not beyond it.
const SAME: f64 = 1e-9;

/// A limit of a variator that an operating point exceeds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct BeyondLimit {
    /// The variator.
    pub variator: String,
    /// Its machine; absent where the limit is that of the ratio.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub machine: Option<String>,
    /// What is limited.
    pub quantity: LimitedQuantity,
    /// What it is, SI.
    pub value: f64,
    /// What it may be at most (or, of a ratio, at least), SI.
    pub limit: f64,
}

/// What of a variator has a limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum LimitedQuantity {
    /// Torque of a machine, N m.
    Torque,
    /// Mechanical power of a machine, W.
    Power,
    /// Speed of a machine, rad/s.
    Speed,
    /// Speed of the first side over that of the second.
    Ratio,
}

/// The limit that a ratio, first side over second, exceeds, and by what part of it.
pub(crate) fn ratio_beyond(v: &Variator, ratio: f64) -> Option<(BeyondLimit, f64)> {
    let VariatorPath::Direct { ratio: [least, most], .. } = &v.path else { return None };
    let slack = SAME * ratio.abs();
    let low = least.filter(|least| ratio.is_finite() && ratio < least - slack);
    let limit = low.or(most.filter(|most| ratio > most + slack))?;
    let beyond =
        BeyondLimit { variator: v.name.clone(), machine: None, quantity: LimitedQuantity::Ratio, value: ratio, limit };
    Some((beyond, (ratio - limit).abs() / limit.abs().max(SAME)))
}

/// The limits that a machine exceeds at a torque, N m, and a speed, rad/s, and by what part of them.
pub(crate) fn machine_beyond<'m>(
    v: &'m Variator,
    machine: &'m Machine,
    torque: f64,
    speed: f64,
) -> impl Iterator<Item = (BeyondLimit, f64)> + 'm {
    let all = [
        (LimitedQuantity::Torque, torque, machine.torque),
        (LimitedQuantity::Power, torque * speed, machine.power),
        (LimitedQuantity::Speed, speed, machine.speed),
    ];
    all.into_iter().filter_map(|(quantity, value, limit)| {
        let limit = limit.filter(|limit| value.abs() > limit * (1.0 + SAME))?;
        let machine = Some(machine.name.clone());
        let beyond = BeyondLimit { variator: v.name.clone(), machine, quantity, value, limit };
        Some((beyond, value.abs() / limit - 1.0))
    })
}

impl fmt::Display for BeyondLimit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (what, unit, factor) = match self.quantity {
            LimitedQuantity::Torque => ("torque", " N m", 1.0),
            LimitedQuantity::Power => ("power", " kW", 1e-3),
            LimitedQuantity::Speed => ("speed", " rpm", 30.0 / std::f64::consts::PI),
            LimitedQuantity::Ratio => ("ratio", "", 1.0),
        };
        let shown = |x: f64| format!("{}{unit}", short(x * factor));
        let (value, limit) = (self.value.abs(), self.limit);
        match (&self.machine, self.quantity) {
            (Some(machine), _) => {
                let excess = (value / limit - 1.0) * 100.0;
                write!(f, "{machine}: a {what} of {}, {excess:.1} % above its limit of {}", shown(value), shown(limit))
            }
            (None, _) if self.value < limit => {
                let (value, least) = (shown(self.value), shown(limit));
                write!(
                    f,
                    "{}: a {what} of {value}, {} below its least of {least}",
                    self.variator,
                    shown(limit - self.value)
                )
            }
            (None, _) => {
                let (value, most) = (shown(self.value), shown(limit));
                write!(
                    f,
                    "{}: a {what} of {value}, {} above its greatest of {most}",
                    self.variator,
                    shown(self.value - limit)
                )
            }
        }
    }
}

fn short(x: f64) -> String {
    let text = format!("{x:.4}");
    if text.parse::<f64>() == Ok(0.0) && x != 0.0 { format!("{x:.3e}") } else { text }
}
