//! What a train must do: targets, limits, and what is better or worse.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};
use willis::diagnostic::{Code, Diagnostic};
use willis::exact::Rational;

/// What is minimised or maximised; also what rows are sorted by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Objective {
    /// The largest relative deviation of a ratio from its target.
    Error,
    /// The reference diameter of the largest ring, in modules, or in metres where all modules are given.
    RingDiameter,
    /// The least efficiency from input to output over all targets.
    Forward,
    /// The least efficiency from output to input; 0 where friction locks.
    Backward,
    /// The factor on all mesh losses at which the output can no longer drive the input.
    LockMargin,
    /// The largest speed of a planet on its pin, as a multiple of the input's.
    PlanetSpin,
    /// The largest speed of a member, as a multiple of the input's.
    MemberSpeed,
    /// The largest torque of a closed shift element without losses, as a multiple of the input's.
    ElementTorque,
}

impl Objective {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::Error,
        Self::RingDiameter,
        Self::Forward,
        Self::Backward,
        Self::LockMargin,
        Self::PlanetSpin,
        Self::MemberSpeed,
        Self::ElementTorque,
    ];

    /// Its name in files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Error => "error",
            Self::RingDiameter => "ring_diameter",
            Self::Forward => "forward",
            Self::Backward => "backward",
            Self::LockMargin => "lock_margin",
            Self::PlanetSpin => "planet_spin",
            Self::MemberSpeed => "member_speed",
            Self::ElementTorque => "element_torque",
        }
    }

    /// Whether more of it is better.
    pub fn is_better_high(self) -> bool {
        matches!(self, Self::Forward | Self::Backward | Self::LockMargin)
    }
}

impl fmt::Display for Objective {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Objective {
    type Err = Box<Diagnostic>;

    fn from_str(name: &str) -> Result<Self, Box<Diagnostic>> {
        Self::ALL.into_iter().find(|o| o.name() == name).ok_or_else(|| {
            let names = Self::ALL.map(Self::name);
            Diagnostic::new(Code::UnknownName, "", format!("`{name}` is nothing that a design is judged by"))
                .suggest(name, names)
                .hint(format!("designs are judged by: {}", names.join(", ")))
                .into()
        })
    }
}

/// What the ratio of a state must be.
#[derive(Clone, Debug, PartialEq)]
pub struct Ratio {
    /// What is aimed at.
    pub aim: Rational,
    /// Closed windows, ascending; the ratio must be in one of them. None: it may be anything.
    pub windows: Vec<[Rational; 2]>,
}

impl Ratio {
    /// A ratio within a relative tolerance of `aim`; of either sign where `any_sign`.
    ///
    /// # Example
    /// ```
    /// use willis::exact::Rational;
    /// use willis_synthesis::teeth::Ratio;
    ///
    /// let ratio = Ratio::near(Rational::from(-2), &Rational::new(1, 100), false);
    /// assert_eq!(ratio.windows, [[Rational::new(-202, 100), Rational::new(-198, 100)]]);
    /// ```
    pub fn near(aim: Rational, tolerance: &Rational, any_sign: bool) -> Self {
        let width = &aim.abs() * tolerance;
        Self::within([&aim - &width, &aim + &width], any_sign).aimed(aim)
    }

    /// A ratio in a closed window; of either sign where `any_sign`. The middle is aimed at.
    pub fn within([low, high]: [Rational; 2], any_sign: bool) -> Self {
        let aim = &(&low + &high) / &Rational::from(2);
        let mut windows = vec![[low, high]];
        if any_sign {
            let mirrored = [-windows[0][1].clone(), -windows[0][0].clone()];
            if mirrored[1] < windows[0][0] {
                windows.insert(0, mirrored);
            } else if windows[0][1] < mirrored[0] {
                windows.push(mirrored);
            }
        }
        Self { aim, windows }
    }

    /// Any ratio.
    pub fn any() -> Self {
        Self { aim: Rational::ZERO, windows: vec![] }
    }

    /// Whether it may be anything.
    pub fn is_any(&self) -> bool {
        self.windows.is_empty()
    }

    fn aimed(self, aim: Rational) -> Self {
        Self { aim, ..self }
    }

    /// How far a ratio is from what is aimed at, relative to that; of either sign where both are wanted.
    pub fn deviation(&self, ratio: f64) -> f64 {
        if self.is_any() {
            return 0.0;
        }
        let aim = self.aim.to_f64();
        let off = |r: f64| if aim == 0.0 { r.abs() } else { (r / aim - 1.0).abs() };
        let off = if self.windows.len() > 1 { off(ratio).min(off(-ratio)) } else { off(ratio) };
        // A ratio of teeth that is met is met exactly.
        if off < 1e-14 { 0.0 } else { off }
    }
}

/// A target: a ratio for a state.
#[derive(Clone, Debug, PartialEq)]
pub struct Target {
    /// The state; `as drawn` where the train has none.
    pub state: String,
    /// Its ratio.
    pub ratio: Ratio,
}

/// How many times the ratio of the next state the ratio of a state must be.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// The state.
    pub state: String,
    /// The next one of the file.
    pub next: String,
    /// A closed window.
    pub window: [Rational; 2],
}

/// What may not be exceeded; none means no limit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Limits {
    /// Reference diameter of the largest ring, m; in modules where no module is given.
    pub ring_diameter: Option<f64>,
    /// Speed of planets on their pins, as a multiple of the input's.
    pub planet_spin: Option<f64>,
    /// Speed of members, as a multiple of the input's.
    pub member_speed: Option<f64>,
    /// Torque of closed shift elements, as a multiple of the input's.
    pub element_torque: Option<f64>,
}

/// What must be reached; none means no demand.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Requirements {
    /// Efficiency from input to output, in every target.
    pub forward: Option<f64>,
    /// Efficiency from output to input, in every target.
    pub backward: Option<f64>,
    /// Margin to self-locking, in every target.
    pub lock_margin: Option<f64>,
}
