//! What a sweep was and what came of it: the results contract `willis-sweep-1`.

use std::collections::BTreeMap;
use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::analysis;
use crate::contract::{Contract, Format};
use crate::study::Hold;
use crate::study::axis::Axis;
use crate::study::column::{Column, ColumnKind};
use crate::study::summary::{Extreme, Summary, WarningKind};

use super::Sweep;

/// How the points of a sweep are computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum SweepMethod {
    /// Every point is exactly that of `analyze`. Fits every train.
    #[default]
    Analyze,
    /// Some thousand times faster, and within a part in 10¹² of `analyze`; fits trains whose efficiencies are given, and
    /// axes of speeds, torques, states and a few values of the train file.
    Compiled,
}

/// An axis of a sweep.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SweepAxis {
    /// The quantity that varies.
    pub quantity: String,
    /// The unit of its values; empty for plain numbers and for texts.
    pub unit: String,
    /// How many values it takes.
    pub count: u64,
    /// The first value, with its unit.
    pub first: String,
    /// The last value, with its unit.
    pub last: String,
}

impl From<&Axis> for SweepAxis {
    fn from(axis: &Axis) -> Self {
        Self {
            quantity: axis.name.clone(),
            unit: axis.unit.clone(),
            count: axis.len() as u64,
            first: axis.setting(0),
            last: axis.setting(axis.len() - 1),
        }
    }
}

/// A column of the table of a sweep.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SweepColumn {
    /// Its name, with the unit at its end.
    pub name: String,
    /// Whether it holds texts, not numbers.
    pub is_text: bool,
}

impl From<&Column> for SweepColumn {
    fn from(column: &Column) -> Self {
        Self { name: column.name.clone(), is_text: column.kind == ColumnKind::Text }
    }
}

/// A part of a sweep that is computed by itself; in contracts `3/16`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(into = "String", try_from = "String")]
#[non_exhaustive]
pub struct Shard {
    /// Its number, from 1.
    pub number: u64,
    /// How many shards there are.
    pub of: u64,
}

impl Shard {
    /// The shard of this number, from 1 up to `of`; none otherwise.
    pub fn new(number: u64, of: u64) -> Option<Self> {
        (1..=of).contains(&number).then_some(Self { number, of })
    }

    /// Its share of so many pieces.
    pub fn pieces(self, pieces: u64) -> std::ops::Range<u64> {
        // Wide enough for any product.
        let at = |k: u64| (u128::from(pieces) * u128::from(k) / u128::from(self.of)) as u64;
        at(self.number - 1)..at(self.number)
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parsed = text.split_once('/').and_then(|(k, n)| Self::new(k.trim().parse().ok()?, n.trim().parse().ok()?));
        parsed.ok_or_else(|| format!("`{text}` is no shard; write `3/16` for the third of sixteen"))
    }
}

impl From<Shard> for String {
    fn from(shard: Shard) -> Self {
        shard.to_string()
    }
}

impl TryFrom<String> for Shard {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

/// A point of a sweep that its report describes. In contracts it is a text: `least_efficiency`, `W316`,
/// `reason: locked`.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(into = "String", try_from = "String")]
#[non_exhaustive]
pub enum SweepPlace {
    /// Where the efficiency is lowest.
    LeastEfficiency,
    /// Where the efficiency is highest.
    MostEfficiency,
    /// Where the loss is smallest.
    LeastLoss,
    /// Where the loss is largest.
    MostLoss,
    /// Where this was first said.
    First(WarningKind),
}

impl fmt::Display for SweepPlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::LeastEfficiency => f.write_str("least_efficiency"),
            Self::MostEfficiency => f.write_str("most_efficiency"),
            Self::LeastLoss => f.write_str("least_loss_w"),
            Self::MostLoss => f.write_str("most_loss_w"),
            Self::First(kind) => kind.fmt(f),
        }
    }
}

impl From<SweepPlace> for String {
    fn from(place: SweepPlace) -> Self {
        place.to_string()
    }
}

impl TryFrom<String> for SweepPlace {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        Ok(match text.as_str() {
            "least_efficiency" => Self::LeastEfficiency,
            "most_efficiency" => Self::MostEfficiency,
            "least_loss_w" => Self::LeastLoss,
            "most_loss_w" => Self::MostLoss,
            _ => Self::First(text.parse()?),
        })
    }
}

/// In the order of their texts, as contracts list them.
impl Ord for SweepPlace {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.to_string().cmp(&other.to_string())
    }
}

impl PartialOrd for SweepPlace {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

/// What a sweep is: the same for all its shards, and for every run of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SweepStudy {
    /// `willis-sweep-1`.
    pub format: Format<SweepReport>,
    /// The version of Willis.
    pub version: String,
    /// Name of the train.
    pub train: String,
    /// Of the train file, of the tables that it names, and of all that was asked.
    pub sha256: String,
    /// The operation from which the sweep starts.
    pub operation: String,
    /// The state of the shift table from which it starts, where there is one.
    pub state: Option<String>,
    /// What stays the same while the axes vary.
    pub held: Hold,
    /// How points are computed.
    pub method: SweepMethod,
    /// The axes, the last one running fastest.
    pub axes: Vec<SweepAxis>,
    /// How many points there are.
    pub points: u64,
    /// The columns of the table.
    pub columns: Vec<SweepColumn>,
    /// Points of a piece, as they are computed and kept.
    pub piece: u64,
    /// What was assumed about the train.
    pub assumptions: Vec<String>,
}

/// A sweep that was run. Serialised it is the contract `willis-sweep-1`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SweepReport {
    /// What was asked.
    #[serde(flatten)]
    pub study: SweepStudy,
    /// Which part of the sweep it is, where it is not the whole.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shard: Option<Shard>,
    /// How many points were computed.
    pub rows: u64,
    /// Of the table, where one was written.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub table_sha256: Option<String>,
    /// What the points say together.
    pub summary: Summary,
    /// The points of the extremes and of what was said first, in words.
    pub places: BTreeMap<SweepPlace, String>,
}

impl Contract for SweepReport {
    const FORMAT: &'static str = "willis-sweep-1";
}

impl SweepStudy {
    /// `over` tells the axes as they were asked for: one a line, or the name of a study of the train file.
    pub(super) fn new(sweep: &Sweep<'_>, method: SweepMethod, columns: &[Column], over: &str, piece: u64) -> Self {
        let model = sweep.question().model();
        let train = model.train();
        let base = sweep.question().base();
        let held = sweep.question().hold();
        let state = base.state.map(|k| train.states()[k].name.clone());
        let version = env!("CARGO_PKG_VERSION");
        let files: Vec<String> = model.files().map(|(name, text)| format!("{name}\n{text}")).collect();
        let laws: Vec<String> = model.laws().iter().map(|(family, law)| format!("{family}={law}")).collect();
        let names: Vec<&str> = columns.iter().map(|c| c.name.as_str()).collect();
        let sha256 = sha256(&[
            version,
            model.to_toml(),
            &files.join("\n"),
            &laws.join("\n"),
            over,
            &base.name,
            state.as_deref().unwrap_or_default(),
            held.name(),
            match method {
                SweepMethod::Analyze => "analyze",
                SweepMethod::Compiled => "compiled",
            },
            &names.join("\n"),
        ]);
        Self {
            format: Format::new(),
            version: version.into(),
            train: train.name().into(),
            sha256,
            operation: base.name.clone(),
            state,
            held,
            method,
            axes: sweep.axes().iter().map(SweepAxis::from).collect(),
            points: sweep.len(),
            columns: columns.iter().map(SweepColumn::from).collect(),
            piece,
            assumptions: analysis::assumptions(train),
        }
    }
}

fn sha256(parts: &[&str]) -> String {
    let mut hash = Sha256::new();
    for part in parts {
        // With its length, so that no two lists mean the same bytes.
        hash.update((part.len() as u64).to_le_bytes());
        hash.update(part.as_bytes());
    }
    hash.finalize().iter().map(|b| format!("{b:02x}")).collect()
}

impl SweepReport {
    pub(super) fn new(sweep: &Sweep<'_>, study: SweepStudy, shard: Option<Shard>, summary: Summary) -> Self {
        let mut places = BTreeMap::new();
        let mut tell = |place: SweepPlace, extreme: Option<Extreme>| {
            if let Some(e) = extreme {
                places.insert(place, sweep.describe(e.point));
            }
        };
        tell(SweepPlace::LeastEfficiency, summary.efficiency.least);
        tell(SweepPlace::MostEfficiency, summary.efficiency.most);
        tell(SweepPlace::LeastLoss, summary.loss_w.least);
        tell(SweepPlace::MostLoss, summary.loss_w.most);
        for (kind, seen) in &summary.seen {
            places.insert(SweepPlace::First(kind.clone()), sweep.describe(seen.point));
        }
        Self { study, shard, rows: summary.points, table_sha256: None, summary, places }
    }

    /// The whole sweep from the reports of its shards, in their order: each tells the extremes and the warnings that
    /// it has first.
    pub fn merged(shards: &[Self]) -> Option<Self> {
        let mut all = Self {
            shard: None,
            rows: 0,
            table_sha256: None,
            summary: Summary::default(),
            places: BTreeMap::new(),
            ..shards.first()?.clone()
        };
        for own in shards {
            let before = all.summary.clone();
            all.rows += own.rows;
            all.summary.join(&own.summary);
            for (place, words) in &own.places {
                let is_new = match place {
                    SweepPlace::LeastEfficiency => all.summary.efficiency.least != before.efficiency.least,
                    SweepPlace::MostEfficiency => all.summary.efficiency.most != before.efficiency.most,
                    SweepPlace::LeastLoss => all.summary.loss_w.least != before.loss_w.least,
                    SweepPlace::MostLoss => all.summary.loss_w.most != before.loss_w.most,
                    SweepPlace::First(kind) => {
                        let point = |s: &Summary| s.seen.get(kind).map(|seen| seen.point);
                        point(&all.summary) != point(&before)
                    }
                };
                if is_new {
                    all.places.insert(place.clone(), words.clone());
                }
            }
        }
        Some(all)
    }
}
