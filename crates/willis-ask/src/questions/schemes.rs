//! `schemes`: every shift scheme, or every hybrid, that does what is wanted.

mod file;
#[cfg(feature = "pictures")]
mod picture;
mod plan;
mod tables;
mod text;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use willis::contract::Contract;
use willis::work::Work;
use willis_synthesis::schemes as library;
use willis_synthesis::schemes::{Harvest, HybridHarvest, Hybrids};

use crate::table::Table;
use crate::{Attachment, Extra, File, Form, Given, Holds, Of, Question, Refusal};

/// Find all shift schemes: who is joined to whom, which elements close in which gear.
///
/// All layouts of so many simple planetary sets are searched with all choices of clutches and brakes; with --layout only the
/// elements of one layout. In every gear as many elements are closed, from gear to gear one opens and one closes. The
/// answer is complete, and says so: how many choices there are, what each rule leaves of them, and that there are no others.
/// Where nothing is left it says which wish must give way, and how far. With --write a scheme becomes a train file that every
/// other command takes; with --format design-file too it becomes a design file, for which `willis design` finds the tooth numbers.
///
/// With --hybrid it finds trains of an engine, an output and two motors whose clutches make the modes that are needed.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct Schemes {
    /// How many simple planetary sets. Default: as many as there are tooth ratios.
    #[cfg_attr(feature = "clap", arg(long, value_name = "N"))]
    pub sets: Option<usize>,
    /// Tooth ratio of each set, ring over sun: 109/67,91/49,97/39. Fractions are the teeth of ring and sun. Default: those of
    /// a known transmission with as many sets (2: GM 440-T4, 3: Allison 2000, 4: ZF 8HP70).
    #[cfg_attr(feature = "clap", arg(long, value_name = "RATIO", value_delimiter = ','))]
    pub k: Vec<String>,
    /// Keep these permanent connections and search the elements: a train file, of which the tooth ratios are kept too, or
    /// the digits of a layout, as in 345360678751.
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE|DIGITS"))]
    pub layout: Option<Attachment>,
    /// How many clutches and brakes.
    #[cfg_attr(feature = "clap", arg(long, value_name = "N"))]
    pub elements: Option<usize>,
    /// How many of them are closed in every gear. Default, with a layout: as many as leave one freedom.
    #[cfg_attr(feature = "clap", arg(long, value_name = "N"))]
    pub closed: Option<usize>,
    /// How many forward gears.
    #[cfg_attr(feature = "clap", arg(long, value_name = "N"))]
    pub forward: Option<usize>,
    /// How many reverse gears. Default: 1.
    #[cfg_attr(feature = "clap", arg(long, value_name = "N"))]
    pub reverse: Option<usize>,
    /// The ratios of forward gears lie here: 0.5..6; an end may be left out.
    #[cfg_attr(feature = "clap", arg(long, value_name = "MIN..MAX"))]
    pub forward_range: Option<String>,
    /// The ratios of reverse gears, without their sign, lie here: 1.5..7.
    #[cfg_attr(feature = "clap", arg(long, value_name = "MIN..MAX"))]
    pub reverse_range: Option<String>,
    /// The steps, each a ratio over that of the next gear, lie here: 1.1..2.2.
    #[cfg_attr(feature = "clap", arg(long, value_name = "MIN..MAX"))]
    pub step: Option<String>,
    /// No step is larger than the one before it.
    #[cfg_attr(feature = "clap", arg(long))]
    pub progressive: bool,
    /// Schemes with an element that can be left out count too.
    #[cfg_attr(feature = "clap", arg(long))]
    pub not_minimal: bool,
    /// No shaft turns faster, per speed of the input: 3.5.
    #[cfg_attr(feature = "clap", arg(long, value_name = "FACTOR"))]
    pub max_speed: Option<String>,
    /// No element carries more, per torque of the input and without losses: 4.
    #[cfg_attr(feature = "clap", arg(long, value_name = "FACTOR"))]
    pub max_torque: Option<String>,
    /// No gear has a lower efficiency when the input drives, by tooth friction alone: 0.95.
    #[cfg_attr(feature = "clap", arg(long, value_name = "EFFICIENCY"))]
    pub min_efficiency: Option<String>,
    /// Efficiencies of the meshes of sun and planet, and of planet and ring, in every set. Default: 0.98,0.99.
    #[cfg_attr(feature = "clap", arg(long, value_name = "EFFICIENCY", value_delimiter = ','))]
    pub mesh_efficiency: Vec<String>,
    /// At most so many of the elements are brakes.
    #[cfg_attr(feature = "clap", arg(long, value_name = "N"))]
    pub max_brakes: Option<usize>,
    /// Only schemes that can be drawn with nested shafts and without a crossing.
    #[cfg_attr(feature = "clap", arg(long))]
    pub planar: bool,
    /// Which come first: found (the order of their names), spread (the largest), torque, speed, step (the smallest),
    /// efficiency (the largest of the worst gear). Default: found.
    #[cfg_attr(feature = "clap", arg(long, value_name = "ORDER"))]
    pub order: Option<String>,
    /// Show so many rows. Default: 10, or as many as --write names.
    #[cfg_attr(feature = "clap", arg(long, value_name = "ROWS"))]
    pub top: Option<usize>,
    /// Examine one of so many layouts: a sample, in which nothing is complete.
    #[cfg_attr(feature = "clap", arg(long, value_name = "N"))]
    pub sample: Option<usize>,
    /// Say whether this known transmission is among the schemes: gm-440-t4, allison-2000, zf-8hp70.
    #[cfg_attr(feature = "clap", arg(long, value_name = "NAME"))]
    pub rediscover: Option<String>,
    /// Search for hybrids.
    #[cfg_attr(feature = "clap", arg(long))]
    pub hybrid: bool,
    /// How many clutches and brakes a hybrid has.
    #[cfg_attr(feature = "clap", arg(long, value_name = "N"))]
    pub clutches: Option<usize>,
    /// Modes that a hybrid must have, with commas between: input-split, output-split, compound-split, electric, fixed, ...
    #[cfg_attr(feature = "clap", arg(long, value_name = "MODE", value_delimiter = ','))]
    pub need: Vec<String>,
    /// Freedoms of a hybrid with no clutch closed. Default: 3.
    #[cfg_attr(feature = "clap", arg(long, value_name = "N"))]
    pub mobility: Option<usize>,
    /// Write the train files of these rows: 3, or 1,2,5 into a folder.
    #[cfg_attr(feature = "clap", arg(long, value_name = "ROWS", value_delimiter = ','))]
    pub write: Vec<usize>,
    /// Only this part of the work: 3/16 is the third of sixteen.
    #[cfg_attr(feature = "clap", arg(long, value_name = "K/N"))]
    pub shard: Option<String>,
    /// Go on from what --progress kept; several times to put parts together.
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE.json"))]
    pub resume: Vec<Attachment>,
}

/// Shift schemes, or hybrids, with what a search can go on from.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum SchemesAnswer {
    /// `willis-schemes-1`.
    Schemes(Box<SchemeResult>),
    /// `willis-hybrids-1`.
    Hybrids(Box<HybridResult>),
}

impl<'de> Deserialize<'de> for SchemesAnswer {
    /// By its format, which says what it is. Tried one after the other, counts by number could not be read.
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let value = serde_json::Value::deserialize(deserializer)?;
        let format = value.get("format").and_then(serde_json::Value::as_str);
        let read = match format == Some(Hybrids::FORMAT) {
            true => serde_json::from_value(value).map(Self::Hybrids),
            false => serde_json::from_value(value).map(Self::Schemes),
        };
        read.map_err(serde::de::Error::custom)
    }
}

impl Contract for SchemesAnswer {
    const FORMAT: &'static str = library::Schemes::FORMAT;
}

/// Shift schemes with what a search can go on from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct SchemeResult {
    /// `willis-schemes-1`.
    pub all: library::Schemes,
    /// What the parts that are done have found; not in the contract.
    #[serde(skip)]
    pub harvest: Harvest,
}

/// Hybrids with what a search can go on from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct HybridResult {
    /// `willis-hybrids-1`.
    pub all: Hybrids,
    /// What the parts that are done have found; not in the contract.
    #[serde(skip)]
    pub harvest: HybridHarvest,
}

impl SchemesAnswer {
    /// How much of the space it covers.
    pub fn completeness(&self) -> &library::SchemeCompleteness {
        match self {
            Self::Schemes(found) => &found.all.completeness,
            Self::Hybrids(found) => &found.all.completeness,
        }
    }
}

impl Question for Schemes {
    const NAME: &'static str = "schemes";
    const OF: Of = Of::Nothing;
    const TABLES: &'static [&'static str] = &["schemes", "gears", "waterfall", "hybrids", "modes"];
    const FORMS: &'static [Form] = &[
        Form { name: "train", endings: &["toml"], about: "the rows to write as train files" },
        Form {
            name: file::DESIGN_FILE,
            endings: &[],
            about: "the rows to write as design files, with which `design` finds their teeth",
        },
    ];
    const EXTRAS: &'static [Extra] = &[
        #[cfg(feature = "pictures")]
        Extra { name: "plot", value: "FILE.svg", about: "Draw the first schemes side by side into this SVG file" },
        Extra { name: "progress", value: "FILE.json", about: "Keep what is finished in this file, to go on with it" },
    ];
    const IS_CUT: bool = true;
    type Answer = SchemesAnswer;

    fn ask(&self, _: &[Given], work: &dyn Work) -> Result<SchemesAnswer, Refusal> {
        self.plan()?.ask(&self.resume, work)
    }

    fn text(&self, answer: &SchemesAnswer, _: &[Given]) -> String {
        match answer {
            SchemesAnswer::Schemes(found) => text::schemes(&found.all),
            SchemesAnswer::Hybrids(found) => text::hybrids(&found.all),
        }
    }

    fn tables(&self, answer: &SchemesAnswer) -> Vec<Table> {
        match answer {
            SchemesAnswer::Schemes(found) => tables::schemes(&found.all),
            SchemesAnswer::Hybrids(found) => tables::hybrids(&found.all),
        }
    }

    fn is_partial(answer: &SchemesAnswer) -> bool {
        answer.completeness().done < answer.completeness().asked
    }

    fn natural_form(&self) -> &'static str {
        if self.write.is_empty() { "text" } else { "train" }
    }

    fn write(&self, answer: &SchemesAnswer, form: &str, _: &[Given]) -> Result<Vec<File>, Refusal> {
        file::rows(answer, form, if self.write.is_empty() { &[1] } else { &self.write })
    }

    fn extra(&self, answer: &SchemesAnswer, name: &str, _: &[Given]) -> Result<Vec<File>, Refusal> {
        Ok(vec![match (name, answer) {
            #[cfg(feature = "pictures")]
            ("plot", _) => File::text("schemes.svg", picture::draw(answer)?),
            (_, SchemesAnswer::Schemes(found)) => File::text("progress.json", found.harvest.to_json()),
            (_, SchemesAnswer::Hybrids(found)) => File::text("progress.json", found.harvest.to_json()),
        }])
    }

    fn attachments(&mut self) -> Vec<(&mut Attachment, Holds)> {
        let layout = self.layout.as_mut().filter(|l| !plan::is_digits(&l.name)).map(|l| (l, Holds::Train));
        layout.into_iter().chain(self.resume.iter_mut().map(|file| (file, Holds::Progress))).collect()
    }

    fn piece(&self, _: &[Given], k: usize, n: usize, work: &dyn Work) -> Result<Vec<u8>, Refusal> {
        self.plan()?.piece(&self.resume, k, n, work)
    }

    fn gather(&self, _: &[Given], pieces: &[Vec<u8>]) -> Result<SchemesAnswer, Refusal> {
        self.plan()?.gather(&self.resume, pieces)
    }
}
