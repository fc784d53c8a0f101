//! What cannot be right in an answer, though its formulas hold: pressures that no steel bears, bearings far beyond their
//! ratings, thrust on a bearing that takes none. Each has the number and the limit it passes.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::catalogue::bearing::{Bearing, Kind};
use crate::operating_point::{BearingState, Strains};
use crate::train::Train;

/// Largest Hertzian pressure of hardened steel teeth, Pa: flanks yield beyond it (ISO 6336-5: endurance 1.2 to 1.65 GPa,
/// static strength up to 1.6 times that).
const PRESSURE: f64 = 2.5e9;
/// Speed times mean diameter that bearings of normal make reach with oil, mm/min; those for spindles reach twice that.
const SPEED: f64 = 1.5e6;
/// Part of the power that goes in which one place of bearings can sensibly lose.
const LOSS: f64 = 0.2;
/// A bearing loss below this is never doubted, W.
const LEAST_LOSS: f64 = 10.0;
/// Part of a shaft's load that may be without a bearing and not be told.
const UNCARRIED: f64 = 0.02;

/// What is doubted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum DoubtKind {
    /// Hertzian pressure in a tooth contact, Pa.
    ContactPressure,
    /// Equivalent static load of a bearing over its static rating.
    BearingLoad,
    /// Speed times mean diameter of a bearing, mm/min.
    BearingSpeed,
    /// Loss of a bearing over the power that goes in.
    BearingLoss,
    /// Thrust on a bearing whose kind carries none, N.
    ThrustOnFloating,
    /// Thrust of a shaft that no bearing of the train carries, N.
    UncarriedThrust,
    /// Radial force on a shaft that no bearing of the train carries, N.
    UncarriedForce,
    /// Tilting moment of a shaft that no bearing of the train carries, N m.
    UncarriedMoment,
}

/// A number that cannot be right, or that something must be missing for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Doubt {
    /// What it is.
    pub kind: DoubtKind,
    /// The mesh, bearing or member.
    pub at: String,
    /// The number, in the unit of its kind.
    pub value: f64,
    /// What it passes, in the same unit.
    pub limit: f64,
}

/// Equivalent static load, N: what ISO 76 gives for balls, what loads the rollers for the others.
fn static_load(bearing: &Bearing, b: &BearingState) -> f64 {
    let (radial, axial) = (b.radial_load, b.axial_load);
    match (bearing.takes_radial_load(), bearing.kind.is_ball()) {
        (false, _) => axial,
        (true, true) => radial.max(0.6 * radial + 0.5 * axial),
        (true, false) if bearing.takes_thrust() => {
            let factor = bearing.axial_factor.unwrap_or(1.5);
            radial.max(0.5 * radial + 0.6 * factor * axial)
        }
        (true, false) => radial,
    }
}

/// What is doubted in a solution with this power into the train.
pub(super) fn doubts(train: &Train, input_power_w: f64, strains: &Strains) -> Vec<Doubt> {
    let mut all = Vec::new();
    let mut doubt = |kind: DoubtKind, at: &str, value: f64, limit: f64| {
        if value > limit && value.is_finite() {
            all.push(Doubt { kind, at: at.to_owned(), value, limit });
        }
    };
    for (mesh, pressure) in &strains.pressures {
        doubt(DoubtKind::ContactPressure, &train.meshes[*mesh].name, *pressure, PRESSURE);
    }
    for (b, mount) in strains.bearings.iter().zip(&train.bearings) {
        let (name, bearing) = (&mount.name, &mount.bearing);
        if let Some(rating) = bearing.static_rating {
            doubt(DoubtKind::BearingLoad, name, static_load(bearing, b) / rating, 1.0);
        }
        if bearing.kind != Kind::Plain {
            let mean = (bearing.bore + bearing.outside_diameter) / 2.0;
            let times = |speed: f64| speed * 30.0 / std::f64::consts::PI * mean * 1e3;
            let limit = bearing.limiting_speed.map_or(SPEED, times);
            doubt(DoubtKind::BearingSpeed, name, times(b.speed), limit);
        }
        if input_power_w > 0.0 && b.loss > LEAST_LOSS {
            doubt(DoubtKind::BearingLoss, name, b.loss / input_power_w, LOSS);
        }
        if !bearing.takes_thrust() {
            doubt(DoubtKind::ThrustOnFloating, name, b.axial_load, UNCARRIED * b.radial_load.max(1.0));
        }
    }
    // Without positions every force acts in one plane, and what tilts a shaft is not known.
    let placed = train.bearings.iter().any(|b| b.position.is_some())
        || train.meshes.iter().any(|m| m.teeth.as_ref().is_some_and(|t| t.position.is_some()));
    for (member, load) in &strains.shafts {
        let member = train.member_name(*member);
        let [force, thrust, tilting] = [load.radial_n, load.thrust_n.abs(), load.tilting_n_m];
        let size = force.max(thrust);
        doubt(DoubtKind::UncarriedThrust, member, load.uncarried_thrust_n.abs(), (UNCARRIED * size).max(1.0));
        doubt(DoubtKind::UncarriedForce, member, load.uncarried_radial_n, (UNCARRIED * size).max(1.0));
        let tilting = if placed { tilting } else { f64::INFINITY };
        doubt(DoubtKind::UncarriedMoment, member, load.uncarried_tilting_n_m, (UNCARRIED * tilting).max(0.1));
    }
    all
}

impl fmt::Display for Doubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { at, value, limit, .. } = self;
        match self.kind {
            DoubtKind::ContactPressure => write!(
                f,
                "{at}: a pressure of {:.0} MPa between the teeth; hardened steel yields beyond {:.0} MPa",
                value * 1e-6,
                limit * 1e-6
            ),
            DoubtKind::BearingLoad => {
                write!(f, "{at}: {value:.3} times the load that the bearing bears at rest (its static rating)")
            }
            DoubtKind::BearingSpeed => write!(
                f,
                "{at}: speed times mean diameter is {value:.3e} mm/min; bearings like it reach about {limit:.1e} with oil"
            ),
            DoubtKind::BearingLoss => {
                write!(f, "{at}: these bearings lose {:.0} % of the power that goes in", value * 100.0)
            }
            DoubtKind::ThrustOnFloating => write!(
                f,
                "{at}: a thrust of {value:.0} N, and a bearing of this kind holds no shaft along its axis; nothing else \
                 of the file does"
            ),
            DoubtKind::UncarriedThrust => {
                write!(f, "{at}: a thrust of {value:.0} N, and no bearing of the file carries it to the frame")
            }
            DoubtKind::UncarriedForce => {
                write!(f, "{at}: a radial force of {value:.0} N, and no bearing of the file carries it to the frame")
            }
            DoubtKind::UncarriedMoment => write!(
                f,
                "{at}: a tilting moment of {value:.1} N m, and its bearings cannot hold it: they stand in one place"
            ),
        }
    }
}
