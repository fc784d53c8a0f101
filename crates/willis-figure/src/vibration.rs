//! Natural modes of vibration on the stick diagram: how far each member swings, and which way.

pub mod draw;

use serde::{Deserialize, Serialize};
use willis::diagnostic::Diagnostics;
use willis::dynamics::{self, Part};
use willis::train::Train;

use crate::kind::{self, Ask, Kind};
use crate::stick::{Stick, stick};

pub(crate) const KIND: Kind<Vibration> = Kind {
    title: "Modes of vibration",
    takes: &[Ask::State],
    effort: kind::of_file,
    applies: None,
    make: |s, r| vibration(s.train(), r.state.as_deref()),
    steps: None,
    draw: draw::draw_on,
};

/// Modes that find room: more than these are counted.
const MOST: usize = 8;

/// The stick diagram of a train, and the modes that are drawn on it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Vibration {
    /// The train.
    pub title: String,
    /// The state of the shift table, or `as drawn`.
    pub state: String,
    /// The schematic, the same under all modes.
    pub stick: Stick,
    /// Motions without strain first, then vibrations by rising frequency.
    pub modes: Vec<VibrationMode>,
    /// How many more vibrations there are.
    pub left_out: usize,
}

/// One mode, as the question `modes` has it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct VibrationMode {
    /// Its number among the vibrations, from 1 on; absent for a motion without strain.
    pub number: Option<usize>,
    /// Undamped natural frequency, Hz; 0 for a motion without strain.
    pub frequency_hz: f64,
    /// Damping ratio; absent where nothing damps it.
    pub damping_ratio: Option<f64>,
    /// Angle amplitude of each member whose motion is settled, relative to the largest, which is 1. Opposite signs swing in
    /// opposite directions.
    pub shape: Vec<Part>,
    /// Share of the strain energy by shaft and elastic mesh; 1 in all, empty for a motion without strain.
    pub strain_energy: Vec<Part>,
}

/// The natural modes of a train in a state of its shift table, or as drawn, with its stick diagram.
///
/// # Errors
/// An unknown state; no moments of inertia, or what else [`dynamics::modes`] lacks; no stick diagram.
///
/// # Example
/// ```
/// use willis::model::Model;
/// use willis_figure::vibration;
///
/// let text = r#"
///     format = 1
///     name = "two discs"
///     members = ["a", "b"]
///     terminals = ["a", "b"]
///     [inertias]
///     a = "2 kg m^2"
///     b = "2 kg m^2"
///     [[shaft]]
///     name = "shaft"
///     members = ["a", "b"]
///     stiffness = "100 N m/rad"
/// "#;
/// let model = Model::from_toml(text).unwrap();
/// let all = vibration(model.train(), None)?;
/// // They turn together, or against each other at ω² = 100/2 + 100/2.
/// assert_eq!(all.modes.len(), 2);
/// assert!((all.modes[1].frequency_hz - 10.0 / std::f64::consts::TAU).abs() < 1e-9);
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn vibration(train: &Train, state: Option<&str>) -> Result<Vibration, Diagnostics> {
    let report = dynamics::modes(train, state, &[])?;
    let stick = stick(train, state)?;
    let rigid = report.rigid_body_modes.into_iter().map(|m| VibrationMode {
        number: None,
        frequency_hz: 0.0,
        damping_ratio: None,
        shape: m.shape,
        strain_energy: vec![],
    });
    let elastic = report.modes.into_iter().enumerate().map(|(k, m)| VibrationMode {
        number: Some(k + 1),
        frequency_hz: m.frequency_hz,
        damping_ratio: m.damping_ratio,
        shape: m.shape,
        strain_energy: m.strain_energy,
    });
    let mut modes: Vec<VibrationMode> = rigid.chain(elastic).collect();
    let left_out = modes.len().saturating_sub(MOST);
    modes.truncate(MOST);
    Ok(Vibration { title: train.name().to_owned(), state: report.state, stick, modes, left_out })
}
