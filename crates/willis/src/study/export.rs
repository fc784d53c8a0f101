//! What an engineer pastes into the next program: loss maps, efficiency tables, models, actuator blocks.
//!
//! Every number comes from [`operate`](crate::analysis::operate), point by point, as `analyze` tells it. What a format
//! cannot say (a lock, several solutions, a change of regime, an efficiency that depends on load where one number
//! fits) is told as comments in the file, where the format has any, and among the notes of the [`Export`]. A point
//! that has no answer gets no number: the export is refused, or the point left out and named.
//!
//! Text in memory; who calls writes it into files.

mod carried;
mod csv;
mod drake;
mod equations;
mod loss_table;
mod map;
mod modelica;
mod mujoco;
mod names;
mod openfast;
mod simscape;
mod single;
mod vecto;

use serde::{Deserialize, Serialize};

use crate::analysis;
use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::model::Model;
use crate::train::{Operation, Train};
use crate::units::{Dimension, Quantity};
use crate::work::Effort;

use super::axis::values;

pub use carried::NotCarried;
use carried::{left_out, sentence};
pub use map::{Gear, Map, MapAnswer, Point};

/// What an export is asked.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct ExportRequest {
    /// The state of the shift table to export. Default: that of the operation, or the only one.
    pub state: Option<String>,
    /// Export every state of the shift table that can be exported.
    pub all_states: bool,
    /// The operation of the train file from which state and ranges are taken.
    pub operation: Option<String>,
    /// Speeds of the input, rising: `500 rpm..12000 rpm:24` for 24 evenly spaced ones, both ends included, or
    /// `500 rpm, 1000 rpm`. Default: chosen from the operations of the file; a note says which.
    pub speeds: Option<String>,
    /// External torques on the input, rising, positive driving and negative coasting: `-100 N m..350 N m:10`, or
    /// `100 N m, 200 N m`. Default: chosen from the operations of the file; a note says which.
    pub torques: Option<String>,
    /// Temperatures of the oil, rising: `20 degC, 60 degC`. Default: that of the file.
    pub temperatures: Option<String>,
}

/// The same, read. Empty lists are filled from the operations of the file, and a note tells with what.
#[derive(Clone, Debug, Default)]
struct Asked {
    state: Option<String>,
    all_states: bool,
    operation: Option<String>,
    /// That operation: trains with other values, which are tried, have none of their own.
    at: Option<Operation>,
    /// Speeds of the input, rising.
    speeds: Vec<Quantity>,
    /// External torques on the input, rising: positive drives, negative coasts.
    torques: Vec<Quantity>,
    /// Oil temperatures, K, rising.
    temperatures: Vec<f64>,
}

impl Asked {
    fn read(request: &ExportRequest) -> Result<Self, Diagnostics> {
        let mut wrong = Diagnostics::default();
        let mut read = |what: &str, text: &Option<String>, dimension: Dimension| {
            let found = text.as_deref().map_or(Ok(vec![]), |text| values(text, dimension));
            found.unwrap_or_else(|mut d| {
                d.message = format!("{what}: {}", d.message);
                wrong.push(*d);
                vec![]
            })
        };
        let speeds = read("speeds", &request.speeds, Dimension::ANGULAR_SPEED);
        let torques = read("torques", &request.torques, Dimension::TORQUE);
        let temperatures = read("temperatures", &request.temperatures, Dimension::TEMPERATURE);
        if wrong.has_errors() {
            return Err(wrong);
        }
        Ok(Self {
            state: request.state.clone(),
            all_states: request.all_states,
            operation: request.operation.clone(),
            at: None,
            speeds,
            torques,
            temperatures: temperatures.iter().map(Quantity::si).collect(),
        })
    }
}

/// A file to be.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ExportedFile {
    /// A name for it, without a folder.
    pub name: String,
    /// Its text.
    pub text: String,
    /// One line that tells what it holds.
    pub about: String,
}

impl ExportedFile {
    /// A file by its name without a folder, its text and one line about it.
    pub fn new(name: impl Into<String>, text: impl Into<String>, about: impl Into<String>) -> Self {
        Self { name: name.into(), text: text.into(), about: about.into() }
    }
}

/// What came out.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Export {
    /// One file, or one a state.
    pub files: Vec<ExportedFile>,
    /// What the reader must know, and what the format cannot say.
    pub notes: Vec<String>,
    /// What the train file says and the files do not.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub not_carried: Vec<NotCarried>,
    /// What the model leaves out, and what stands in for data that were not given.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub assumptions: Vec<String>,
}

impl Export {
    fn new(files: Vec<ExportedFile>, notes: Vec<String>) -> Self {
        Self { files, notes, not_carried: vec![], assumptions: vec![] }
    }
}

/// A format.
#[derive(Clone, Copy, Debug)]
pub struct Kind {
    /// How it is asked for.
    pub id: &'static str,
    /// What it is, in one line.
    pub about: &'static str,
    write: fn(&Train, &Asked) -> Result<Export, Diagnostics>,
    /// What begins and ends a comment; empty where the format has none.
    comment: [&'static str; 2],
    /// What of a motion it has.
    motion: Moved,
}

/// What of a motion a format has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Moved {
    /// Nothing: it is a table of steady points.
    Nothing,
    /// Inertias, as far as they are joined without an elastic shaft.
    Rigid,
    /// Inertias, and elastic shafts with what lies behind them.
    Elastic,
}

/// Every format there is.
pub const KINDS: &[Kind] = &[
    Kind {
        id: "csv",
        about: "plain map: torque, loss, efficiency and verdict of every point",
        write: csv::write,
        comment: ["", ""],
        motion: Moved::Nothing,
    },
    Kind {
        id: "vecto",
        about: "VECTO transmission loss maps (.vtlm), one a gear",
        write: vecto::write,
        comment: ["# ", ""],
        motion: Moved::Nothing,
    },
    Kind {
        id: "modelica-loss-table",
        about: "lossTable and ratio of Modelica's LossyGear, whole gear, each state",
        write: loss_table::write,
        comment: ["  // ", ""],
        motion: Moved::Nothing,
    },
    Kind {
        id: "modelica",
        about: "the train as a model of Modelica's Rotational library (.mo)",
        write: modelica::write,
        comment: ["  // ", ""],
        motion: Moved::Elastic,
    },
    Kind {
        id: "modelica-equations",
        about: "a gear in motion as equations of Modelica, without any library (.mo)",
        write: equations::write,
        comment: ["  // ", ""],
        motion: Moved::Elastic,
    },
    Kind {
        id: "simscape",
        about: "efficiencies for Simscape Driveline gears (MATLAB script)",
        write: simscape::write,
        comment: ["% ", ""],
        motion: Moved::Nothing,
    },
    Kind {
        id: "mujoco",
        about: "actuator with gear, armature and both efficiencies (MJCF)",
        write: mujoco::write,
        comment: ["<!-- ", " -->"],
        motion: Moved::Rigid,
    },
    Kind {
        id: "drake",
        about: "joint actuator with gear ratio and rotor inertia (URDF)",
        write: drake::write,
        comment: ["<!-- ", " -->"],
        motion: Moved::Rigid,
    },
    Kind {
        id: "openfast",
        about: "GBoxEff and GBRatio of ElastoDyn, side and sign told",
        write: openfast::write,
        comment: ["! ", ""],
        motion: Moved::Nothing,
    },
];

/// How much work an export is: its map, and the trials that show what is not in it.
pub fn effort(model: &Model) -> Effort {
    /// Points of a usual map.
    const MAP: u64 = 500;
    Effort::of_points(model.train(), MAP + carried::trials(model))
}

/// Exports a train in the format of that name.
///
/// # Errors
/// An unknown format, state or operation; a state without a single ratio; ranges that do not rise or do not suit the
/// format; points without an answer where the format needs one.
///
/// # Example
/// ```
/// use willis::study::export::{ExportRequest, export};
/// use willis::model::Model;
/// use willis::train::{SetSpec, Train};
///
/// let model = Model::new(
///     Train::builder("reducer")
///         .members(["sun", "carrier"])
///         .terminals(["sun", "carrier"])
///         .set(SetSpec::simple("P1", ("sun", 30), ("frame", 70), "carrier").planet(20, 4).mesh_efficiency(0.99)),
/// )?;
/// let table = export(&model, "modelica-loss-table", &ExportRequest::default())?;
/// assert!(table.files[0].text.contains("ratio = 10/3 "));
/// assert_eq!(table.not_carried[0].key, "set.planet.teeth");
/// assert_eq!(table.not_carried[0].values, ["20"]);
/// assert!(export(&model, "vekto", &ExportRequest::default()).unwrap_err().to_string().contains("did you mean `vecto`?"));
/// # Ok::<(), willis::diagnostic::Diagnostics>(())
/// ```
pub fn export(model: &Model, kind: &str, request: &ExportRequest) -> Result<Export, Diagnostics> {
    let Some(found) = KINDS.iter().find(|k| k.id == kind) else {
        let known = KINDS.iter().map(|k| k.id);
        let d = Diagnostic::new(Code::UnknownName, "", format!("there is no export `{kind}`"));
        let all: Vec<_> = known.clone().collect();
        return Err(d.suggest(kind, known).hint(format!("the exports are: {}", all.join(", "))).into());
    };
    let mut asked = Asked::read(request)?;
    if let Some(name) = &asked.operation {
        asked.at = Some(model.train().find_operation(name)?.clone());
    }
    let done = (found.write)(model.train(), &asked)?;
    let ends = Asked { at: asked.at.clone(), ..map::ends(model.train(), &asked) };
    let trial = |train: &Train| {
        let done = (found.write)(train, &ends).ok()?;
        Some(done.files.into_iter().map(|f| f.text).collect())
    };
    let done = complete(model, done, found.comment, &trial);
    let assumptions = match found.motion {
        Moved::Nothing => done.assumptions,
        moved => analysis::assumptions_in_motion(model.train(), moved == Moved::Elastic),
    };
    Ok(Export { assumptions, ..done })
}

/// Files, and what a reader must know of them.
pub type FilesAndNotes = (Vec<ExportedFile>, Vec<String>);

/// Exports a train in a format that stands elsewhere. `write` gives the files and notes of a train, and is also asked for
/// trains with other values, which shows what is not carried over: whether it is such a trial is its second argument.
/// `comment` is what begins and ends a comment in the format.
///
/// # Errors
/// What `write` says.
///
/// # Example
/// ```
/// use willis::model::Model;
/// use willis::study::export::{ExportedFile, export_with};
/// use willis::train::{SetSpec, Train};
///
/// let model = Model::new(
///     Train::builder("reducer")
///         .members(["sun", "carrier"])
///         .terminals(["sun", "carrier"])
///         .set(SetSpec::simple("P1", ("sun", 30), ("frame", 70), "carrier").planet(20, 4)),
/// )?;
/// let done = export_with(&model, ["# ", ""], &|train, _| {
///     let text = format!("meshes\n{}\n", train.meshes().len());
///     Ok((vec![ExportedFile::new("x.txt", text, "how many meshes")], vec![]))
/// })?;
/// assert!(done.not_carried.iter().any(|n| n.key == "set.planet.teeth"));
/// assert!(done.files[0].text.starts_with("meshes\n# "));
/// # Ok::<(), willis::diagnostic::Diagnostics>(())
/// ```
pub fn export_with(
    model: &Model,
    comment: [&str; 2],
    write: &dyn Fn(&Train, bool) -> Result<FilesAndNotes, Diagnostics>,
) -> Result<Export, Diagnostics> {
    let (files, notes) = write(model.train(), false)?;
    let trial = |train: &Train| Some(write(train, true).ok()?.0.into_iter().map(|f| f.text).collect());
    Ok(complete(model, Export::new(files, notes), comment, &trial))
}

/// Tells what an export does not carry over, in the files and beside them.
fn complete(
    model: &Model,
    mut done: Export,
    comment: [&str; 2],
    trial: &dyn Fn(&Train) -> Option<Vec<String>>,
) -> Export {
    done.not_carried = left_out(model, trial);
    if let Some(told) = sentence(&done.not_carried) {
        let [begin, end] = comment;
        for file in done.files.iter_mut().filter(|_| !begin.is_empty()) {
            // Below the first line: some formats want a header there, the others say whose file it is.
            let at = file.text.find('\n').map_or(file.text.len(), |k| k + 1);
            let comment = if end.is_empty() { names::line(&told) } else { names::xml(&told) };
            file.text.insert_str(at, &format!("{begin}{comment}{end}\n"));
        }
        done.notes.push(told);
    }
    let mut told: Vec<String> = Vec::new();
    for note in std::mem::take(&mut done.notes) {
        if !told.contains(&note) {
            told.push(note);
        }
    }
    done.notes = told;
    done.assumptions = analysis::assumptions(model.train());
    done
}

/// Who wrote it, for the first comment of a file.
fn origin(train: &Train) -> String {
    format!("{}: exported by Willis {}", names::line(train.name()), env!("CARGO_PKG_VERSION"))
}

/// One file a gear, written by `one`, which adds notes. A gear of several that cannot be exported is left out and
/// named; the only one, or all of them, is an error.
fn each(
    train: &Train,
    request: &Asked,
    one: impl Fn(&Gear, &mut Vec<String>) -> Result<ExportedFile, Diagnostics>,
) -> Result<Export, Diagnostics> {
    let (gears, mut notes) = map::gears(train, request)?;
    let mut files = Vec::new();
    let mut wrong = Diagnostics::default();
    for gear in &gears {
        let mut own = Vec::new();
        match one(gear, &mut own) {
            Ok(file) => {
                files.push(file);
                notes.extend(own);
            }
            Err(d) => {
                notes.extend(d.iter().map(|d| format!("left out: {}", d.message)));
                wrong.extend(d);
            }
        }
    }
    if files.is_empty() { Err(wrong) } else { Ok(Export::new(files, notes)) }
}

/// What every gear says of itself: numbers rest on assumptions, and one-way clutches overrun.
fn told(gear: &Gear) -> Vec<String> {
    let mut all = vec![format!("{}: {} drives {}, ratio {}", gear.title(), gear.input, gear.output, gear.exact)];
    if gear.is_physical() {
        all.extend(gear.chosen.iter().cloned());
    }
    for (way, direction) in [("driving", &gear.drive), ("coasting", &gear.coast)] {
        if direction.efficiency.is_none() {
            let why = direction.reason.as_deref().unwrap_or("there is no single answer");
            all.push(format!("{}, {way}: {}: {why}", gear.title(), names::verdict(direction.verdict)));
        }
    }
    all
}
