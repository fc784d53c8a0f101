//! The list of laws as an answer: the results contract `willis-laws-1`.

use std::borrow::Cow;
use std::fmt;

use serde::de::{Deserializer, Error, Unexpected};
use serde::ser::Serializer;
use serde::{Deserialize, Serialize};

use crate::contract::{Contract, Format};

use super::{LawSummary, Trust, entries};

/// Every law there is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct LawList {
    /// `willis-laws-1`.
    pub format: Format<Self>,
    /// The laws, family by family; the first of each is the default.
    pub laws: Vec<LawReport>,
}

impl Contract for LawList {
    const FORMAT: &'static str = "willis-laws-1";
}

/// A law: what it gives, where it comes from, where it holds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct LawReport {
    /// Name of the family, `mesh_friction`.
    pub family: String,
    /// Name of the law.
    pub law: String,
    /// Whether it is the one used when nothing is chosen.
    pub default: bool,
    /// Title for people.
    pub title: String,
    /// What the family gives.
    pub gives: Symbol,
    /// Key in the list of references.
    pub source: String,
    /// The place in that work.
    pub place: String,
    /// How far the formula was checked.
    pub trust: Checked,
    /// Where the source claims validity.
    pub valid: Vec<Bounds>,
}

/// A symbol and its SI unit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Symbol {
    /// The symbol.
    pub symbol: String,
    /// Its SI unit; `-` for a pure number.
    pub unit: String,
}

/// The range of a quantity within which a law holds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Bounds {
    /// Symbol of the quantity.
    pub symbol: String,
    /// Its SI unit; `-` for a pure number.
    pub unit: String,
    /// Lowest value, in that unit; absent where there is none.
    pub min: Option<f64>,
    /// Highest value, in that unit; absent where there is none.
    pub max: Option<f64>,
}

/// How far a formula and its constants were checked against their source; a text in answers for machines:
/// `seen`, `derived`, or `confirm: ` and what is to be confirmed.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Checked {
    /// Formula and constants were seen in a publication, manual or program.
    Seen,
    /// Derived, and checked numerically.
    Derived,
    /// These constants stand as recalled and are to be confirmed in the source.
    Confirm(String),
}

/// What stands before that which is to be confirmed.
const CONFIRM: &str = "confirm: ";

impl From<Trust> for Checked {
    fn from(trust: Trust) -> Self {
        match trust {
            Trust::Seen => Self::Seen,
            Trust::Derived => Self::Derived,
            Trust::Confirm(what) => Self::Confirm(what.to_owned()),
        }
    }
}

impl fmt::Display for Checked {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Seen => f.write_str("seen"),
            Self::Derived => f.write_str("derived"),
            Self::Confirm(what) => write!(f, "{CONFIRM}{what}"),
        }
    }
}

impl Serialize for Checked {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for Checked {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = Cow::<str>::deserialize(deserializer)?;
        match &*text {
            "seen" => Ok(Self::Seen),
            "derived" => Ok(Self::Derived),
            text => match text.strip_prefix(CONFIRM) {
                Some(what) => Ok(Self::Confirm(what.to_owned())),
                None => Err(D::Error::invalid_value(Unexpected::Str(text), &"`seen`, `derived` or `confirm: …`")),
            },
        }
    }
}

#[cfg(feature = "schema")]
impl schemars::JsonSchema for Checked {
    fn schema_name() -> Cow<'static, str> {
        "Checked".into()
    }

    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        schemars::json_schema!({
            "description": "How far a formula and its constants were checked against their source.",
            "type": "string",
            "pattern": "^(seen|derived|confirm: .+)$",
        })
    }
}

impl From<LawSummary> for LawReport {
    fn from(e: LawSummary) -> Self {
        let finite = |x: f64| x.is_finite().then_some(x);
        let bounds = |(symbol, unit, min, max): (&str, &str, f64, f64)| Bounds {
            symbol: symbol.to_owned(),
            unit: unit.to_owned(),
            min: finite(min),
            max: finite(max),
        };
        Self {
            family: e.family.to_owned(),
            law: e.id.to_owned(),
            default: e.default,
            title: e.title.to_owned(),
            gives: Symbol { symbol: e.gives.0.to_owned(), unit: e.gives.1.to_owned() },
            source: e.source.0.to_owned(),
            place: e.source.1.to_owned(),
            trust: e.trust.into(),
            valid: e.valid.into_iter().map(bounds).collect(),
        }
    }
}

/// The laws of all families, or of one.
///
/// # Example
/// ```
/// use willis::losses::list;
///
/// let all = list(Some("bearing"));
/// assert!(all.laws[0].default && all.laws.iter().all(|l| l.family == "bearing"));
/// ```
pub fn list(family: Option<&str>) -> LawList {
    let wanted = |e: &LawSummary| family.is_none_or(|f| e.family == f);
    LawList { format: Format::new(), laws: entries().into_iter().filter(wanted).map(LawReport::from).collect() }
}
