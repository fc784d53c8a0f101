//! Rules for the teeth of a set, each with a name under which it is switched on, and what it means.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};
use willis::diagnostic::{Code, Diagnostic};

/// A rule that the tooth numbers of every set must follow.
///
/// # Example
/// ```
/// use willis_synthesis::teeth::Rule;
///
/// assert_eq!("hunting".parse::<Rule>().unwrap(), Rule::Hunting);
/// assert!(Rule::Hunting.explanation().contains("common divisor"));
/// let wrong = "huntin".parse::<Rule>().unwrap_err();
/// assert_eq!(wrong.replacement.as_deref(), Some("hunting"));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Rule {
    /// Identical planets at equal angles can be put in.
    Assembly,
    /// Neighbouring planets do not touch.
    Clearance,
    /// Rings are large enough for their planets.
    Interference,
    /// Meshing tooth numbers have no common divisor.
    Hunting,
    /// All planets mesh alike.
    InPhase,
    /// Every planet meshes at its own time.
    InSequence,
    /// Profile shifts exist with which no tooth is undercut or pointed.
    Shifts,
}

impl Rule {
    /// All rules, in the order in which they are applied and counted.
    pub const ALL: [Self; 7] = [
        Self::Assembly,
        Self::Clearance,
        Self::Interference,
        Self::Hunting,
        Self::InPhase,
        Self::InSequence,
        Self::Shifts,
    ];

    /// Its name in files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Assembly => "assembly",
            Self::Clearance => "clearance",
            Self::Interference => "interference",
            Self::Hunting => "hunting",
            Self::InPhase => "in-phase",
            Self::InSequence => "in-sequence",
            Self::Shifts => "shifts",
        }
    }

    /// What it demands, by which formula, and why.
    pub fn explanation(self) -> &'static str {
        match self {
            Self::Assembly => {
                "Identical planets can be put in at equal angles. Simple set: N divides s + r. Stepped planets: N divides \
                 s + r1, and N gcd(p1, p2) divides r1 p2 - r2 p1. Ravigneaux: N divides s2 + r and r - s1."
            }
            Self::Clearance => {
                "The tips of neighbouring planets keep the gap: 2 a sin(pi/N) > z + 2 + gap in modules, decided exactly. \
                 The centre distance a is the mean of those that the meshes have without profile shift. A Ravigneaux set \
                 also needs short planets that fit between the long ones, inside the ring, and long planets that pass the \
                 small sun."
            }
            Self::Interference => {
                "Every ring has at least 8 teeth more than its planet, so that the tips pass each other without being \
                 shortened much."
            }
            Self::Hunting => {
                "Meshing gears have no common divisor: every tooth meets every tooth of the other gear, and wear spreads. \
                 Without profile shift, gcd(p, r) = gcd(p, s) in a simple set."
            }
            Self::InPhase => {
                "N divides the teeth of the suns and rings: all planets mesh alike, torsional excitation adds up."
            }
            Self::InSequence => {
                "The teeth of each sun have no common divisor with N: every planet meshes at its own time, and torsional \
                 excitation cancels."
            }
            Self::Shifts => {
                "Profile shifts exist that bring all gears of the set onto one axis, without undercut, with tips that are \
                 at least 0.2 modules wide. Pressure angle 20 degrees and the standard rack, unless the set has a geometry."
            }
        }
    }
}

impl fmt::Display for Rule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Rule {
    type Err = Box<Diagnostic>;

    fn from_str(name: &str) -> Result<Self, Box<Diagnostic>> {
        Self::ALL.into_iter().find(|r| r.name() == name).ok_or_else(|| {
            let names = Self::ALL.map(Self::name);
            Diagnostic::new(Code::UnknownName, "design.rules", format!("there is no rule `{name}`"))
                .suggest(name, names)
                .hint(format!("the rules are: {}", names.join(", ")))
                .into()
        })
    }
}
