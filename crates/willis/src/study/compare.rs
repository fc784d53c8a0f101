//! Variants of a train side by side: what their files differ in, and what that changes.

mod files;
mod map;
mod results;

use serde::{Deserialize, Serialize};

use crate::analysis::assumptions;
use crate::contract::{Contract, Format};
use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::model::Model;
use crate::train::Train;
use crate::work::Work;

pub use map::{Band, MapComparison, MapDifference, MapPair, MapPlace};

/// Differences below this part of a value are round-off.
const ROUND_OFF: f64 = 1e-9;

/// What a comparison is asked.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct CompareRequest {
    /// Compare this operation alone. Default: all operations of the same name.
    pub operation: Option<String>,
    /// Compare this state of the shift table alone, and the operations in it. Default: all states of the same name.
    pub state: Option<String>,
    /// Compare the efficiency over these axes too, up to a million points in all. Each is a quantity and its values,
    /// `input.speed=500 rpm..6000 rpm:50` for 50 evenly spaced ones, both ends included, as in a sweep; every variant
    /// must have the quantities. Default: none.
    pub over: Vec<String>,
}

/// A variant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Variant {
    /// `A`, `B`, …
    pub label: String,
    /// What it is called, a file.
    pub file: String,
    /// Name of its train.
    pub train: String,
    /// What the model leaves out, and what stands in for data that were not given.
    #[serde(default)]
    pub assumptions: Vec<String>,
}

/// A value of a variant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(untagged)]
pub enum ComparedValue {
    /// It has none.
    None,
    /// A number.
    Number(f64),
    /// A word: a verdict.
    Word(String),
}

impl ComparedValue {
    fn number(&self) -> Option<f64> {
        match self {
            Self::Number(x) => Some(*x),
            _ => None,
        }
    }
}

/// A key in which files differ, or a prescription in which operations do.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct TextDifference {
    /// The path of the key, or what is prescribed.
    pub path: String,
    /// The values as written, one for each variant; absent where it has none.
    pub values: Vec<Option<String>>,
}

/// The unit of a result that is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub enum ComparedUnit {
    /// None: plain numbers and words.
    #[serde(rename = "")]
    None,
    /// An efficiency, measured by what it lacks to 1.
    #[serde(rename = "efficiency")]
    Efficiency,
    /// W.
    #[serde(rename = "W")]
    Watt,
    /// N m.
    #[serde(rename = "N m")]
    NewtonMetre,
    /// rad/s.
    #[serde(rename = "rad/s")]
    RadianPerSecond,
    /// Pa.
    #[serde(rename = "Pa")]
    Pascal,
}

impl ComparedUnit {
    /// As contracts and tables write it; empty where there is none.
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "",
            Self::Efficiency => "efficiency",
            Self::Watt => "W",
            Self::NewtonMetre => "N m",
            Self::RadianPerSecond => "rad/s",
            Self::Pascal => "Pa",
        }
    }
}

/// A result in which variants differ.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Difference {
    /// What it is.
    pub quantity: String,
    /// Its unit.
    pub unit: ComparedUnit,
    /// One value for each variant.
    pub values: Vec<ComparedValue>,
    /// Value less that of the first variant.
    pub differences: Vec<Option<f64>>,
    /// The difference over the first variant's value; of an efficiency over what it lacks to 1.
    pub relative: Vec<Option<f64>>,
    /// How large the difference is, 0 to 1: largest over the larger value, efficiencies measured by what they lack to 1;
    /// 2 where words differ or a value is missing.
    pub size: f64,
}

/// A state or an operation in all variants that have it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Compared {
    /// Its name.
    pub name: String,
    /// Labels of the variants that do not have it.
    pub missing_in: Vec<String>,
    /// What the variants prescribe differently: results are then those of different points.
    pub prescribed: Vec<TextDifference>,
    /// Results that differ, largest first.
    pub differences: Vec<Difference>,
    /// How many results are equal.
    pub equal: usize,
    /// Why a variant has no answer: label and reason.
    pub reasons: Vec<(String, String)>,
}

impl Compared {
    /// Whether there is nothing to tell.
    pub fn is_equal(&self) -> bool {
        self.missing_in.is_empty() && self.prescribed.is_empty() && self.differences.is_empty()
    }

    fn size(&self) -> f64 {
        self.differences.first().map_or(0.0, |d| d.size)
    }
}

/// Variants side by side. Serialised it is the contract `willis-compare-1`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Comparison {
    /// `willis-compare-1`.
    pub format: Format<Self>,
    /// The variants.
    pub variants: Vec<Variant>,
    /// Whether all files say the same.
    pub identical: bool,
    /// Keys in which the files differ.
    pub files: Vec<TextDifference>,
    /// The shift tables, state by state, largest difference first.
    pub states: Vec<Compared>,
    /// The operations by their names, largest difference first.
    pub operations: Vec<Compared>,
    /// Over axes, where asked for.
    pub map: Option<MapComparison>,
}

impl Contract for Comparison {
    const FORMAT: &'static str = "willis-compare-1";
}

/// Compares variants, each with what it is called.
///
/// The answer does not depend on how `work` shares the points of axes out.
///
/// # Errors
/// Fewer than two variants, a state or an operation that none of them has, axes that do not fit all of them, and
/// [`Code::Cancelled`].
///
/// # Example
/// ```
/// use willis::model::Model;
/// use willis::study::{CompareRequest, compare};
/// use willis::work::Serial;
///
/// let text = r#"
///     format = 1
///     name = "reducer"
///     members = ["s", "c"]
///     terminals = ["s", "c"]
///     [[set]]
///     name = "P1"
///     sun = { member = "s", teeth = 30 }
///     ring = { member = "frame", teeth = 70 }
///     carrier = "c"
///     mesh_efficiency = 0.99
/// "#;
/// let model = |text: &str| Model::from_toml(text).unwrap();
/// let (a, b) = (model(text), model(&text.replace("0.99", "0.98")));
/// let all = compare(&[("a", &a), ("b", &b)], &CompareRequest::default(), &Serial)?;
/// assert_eq!(all.files[0].path, "P1.mesh_efficiency");
/// assert!(all.states[0].differences.iter().any(|d| d.quantity == "efficiency driving"));
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn compare(
    variants: &[(&str, &Model)],
    request: &CompareRequest,
    work: &dyn Work,
) -> Result<Comparison, Diagnostics> {
    if variants.len() < 2 {
        let d = Diagnostic::new(Code::Unfit, "", "one train cannot be compared");
        return Err(d.hint("name two files or more").into());
    }
    let trains: Vec<&Train> = variants.iter().map(|v| v.1.train()).collect();
    selected(&trains, request)?;
    let labels: Vec<String> = (0..variants.len()).map(label).collect();
    let files = files::differences(variants.iter().map(|v| v.1));
    let map = match request.over.is_empty() {
        true => None,
        false => Some(map::compare(variants, &labels, request, work)?),
    };
    Ok(Comparison {
        format: Format::new(),
        variants: (variants.iter().zip(&labels))
            .map(|((file, model), label)| Variant {
                label: label.clone(),
                file: (*file).to_owned(),
                train: model.train().name().to_owned(),
                assumptions: assumptions(model.train()),
            })
            .collect(),
        identical: files.is_empty(),
        files,
        states: results::states(&trains, &labels, request),
        operations: results::operations(&trains, &labels, request),
        map,
    })
}

/// `A` to `Z`, then numbers.
fn label(k: usize) -> String {
    if k < 26 { char::from(b'A' + k as u8).to_string() } else { (k + 1).to_string() }
}

/// Whether some variant has what is asked for.
fn selected(trains: &[&Train], request: &CompareRequest) -> Result<(), Diagnostics> {
    let mut wrong = Diagnostics::default();
    let mut look = |what: &str, name: &Option<String>, known: Vec<&str>| {
        if let Some(name) = name.as_ref().filter(|n| !known.contains(&n.as_str())) {
            let d = Diagnostic::new(Code::UnknownSelection, "", format!("no variant has the {what} `{name}`"));
            wrong.push(d.suggest(name, known));
        }
    };
    look("state", &request.state, trains.iter().flat_map(|t| t.states()).map(|s| s.name.as_str()).collect());
    look(
        "operation",
        &request.operation,
        trains.iter().flat_map(|t| t.operations()).map(|o| o.name.as_str()).collect(),
    );
    if wrong.has_errors() { Err(wrong) } else { Ok(()) }
}
