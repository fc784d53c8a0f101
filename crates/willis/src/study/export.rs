//! What an engineer pastes into the next program: loss maps, efficiency tables, models, actuator blocks.
//!
//! Every number comes from [`operate`](crate::analysis::operate), point by point, as `analyze` tells it. What a format
//! cannot say (a lock, several solutions, a change of regime, an efficiency that depends on load where one number
//! fits) is told as comments in the file, where the format has any, and among the notes of the [`Export`]. A point
//! that has no answer gets no number: the export is refused, or the point left out and named.
//!
//! Text in memory; who calls writes it into files.

mod csv;
mod drake;
mod loss_table;
mod map;
mod modelica;
mod mujoco;
mod names;
mod openfast;
mod simscape;
mod single;
mod vecto;

use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::train::Train;
use crate::units::Quantity;

pub use map::{Answer, Gear, Map, Point};

/// What to export. Empty lists are filled from the operations of the file, and a note tells with what.
#[derive(Clone, Debug, Default)]
pub struct ExportRequest {
    /// This state of the shift table.
    pub state: Option<String>,
    /// Every state of the shift table that can be exported.
    pub all_states: bool,
    /// The operation from which state and ranges are taken.
    pub operation: Option<String>,
    /// Speeds of the input, rising.
    pub speeds: Vec<Quantity>,
    /// External torques on the input, rising: positive drives, negative coasts.
    pub torques: Vec<Quantity>,
    /// Oil temperatures, K, rising.
    pub temperatures: Vec<f64>,
}

/// A file to be.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExportedFile {
    /// A name for it, without a folder.
    pub name: String,
    /// Its text.
    pub text: String,
    /// One line that tells what it holds.
    pub about: String,
}

/// What came out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Export {
    /// One file, or one a state.
    pub files: Vec<ExportedFile>,
    /// What the reader must know, and what the format cannot say.
    pub notes: Vec<String>,
}

/// A format.
#[derive(Clone, Copy, Debug)]
pub struct Kind {
    /// How it is asked for.
    pub id: &'static str,
    /// What it is, in one line.
    pub about: &'static str,
    write: fn(&Train, &ExportRequest) -> Result<Export, Diagnostics>,
}

/// Every format there is.
pub const KINDS: &[Kind] = &[
    Kind { id: "csv", about: "plain map: torque, loss, efficiency and verdict of every point", write: csv::write },
    Kind { id: "vecto", about: "VECTO transmission loss maps (.vtlm), one a gear", write: vecto::write },
    Kind {
        id: "modelica-loss-table",
        about: "lossTable and ratio of Modelica's LossyGear, whole gear, each state",
        write: loss_table::write,
    },
    Kind {
        id: "modelica",
        about: "the train as a model of Modelica's Rotational library (.mo)",
        write: modelica::write,
    },
    Kind { id: "simscape", about: "efficiencies for Simscape Driveline gears (MATLAB script)", write: simscape::write },
    Kind { id: "mujoco", about: "actuator with gear, armature and both efficiencies (MJCF)", write: mujoco::write },
    Kind { id: "drake", about: "joint actuator with gear ratio and rotor inertia (URDF)", write: drake::write },
    Kind { id: "openfast", about: "GBoxEff and GBRatio of ElastoDyn, side and sign told", write: openfast::write },
];

/// Exports a train in the format of that name.
///
/// # Errors
/// An unknown format, state or operation; a state without a single ratio; ranges that do not rise or do not suit the
/// format; points without an answer where the format needs one.
///
/// # Example
/// ```
/// use willis::study::export::{ExportRequest, export};
/// use willis::train::{SetSpec, Train};
///
/// let train = Train::builder("reducer")
///     .members(["sun", "carrier"])
///     .terminals(["sun", "carrier"])
///     .set(SetSpec::simple("P1", ("sun", 30), ("frame", 70), "carrier").planet(20, 4).mesh_efficiency(0.99))
///     .build()?;
/// let table = export(&train, "modelica-loss-table", &ExportRequest::default())?;
/// assert!(table.files[0].text.contains("ratio = 10/3 "));
/// assert!(export(&train, "vekto", &ExportRequest::default()).unwrap_err().to_string().contains("did you mean `vecto`?"));
/// # Ok::<(), willis::diagnostic::Diagnostics>(())
/// ```
pub fn export(train: &Train, kind: &str, request: &ExportRequest) -> Result<Export, Diagnostics> {
    let Some(found) = KINDS.iter().find(|k| k.id == kind) else {
        let known = KINDS.iter().map(|k| k.id);
        let d = Diagnostic::new(Code::UnknownName, "", format!("there is no export `{kind}`"));
        let all: Vec<_> = known.clone().collect();
        return Err(d.suggest(kind, known).hint(format!("the exports are: {}", all.join(", "))).into());
    };
    let mut done = (found.write)(train, request)?;
    let mut told: Vec<String> = Vec::new();
    for note in std::mem::take(&mut done.notes) {
        if !told.contains(&note) {
            told.push(note);
        }
    }
    done.notes = told;
    Ok(done)
}

/// Who wrote it, for the first comment of a file.
fn origin(train: &Train) -> String {
    format!("{}: exported by Willis {}", names::line(train.name()), env!("CARGO_PKG_VERSION"))
}

/// One file a gear, written by `one`, which adds notes. A gear of several that cannot be exported is left out and
/// named; the only one, or all of them, is an error.
fn each(
    train: &Train,
    request: &ExportRequest,
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
    if files.is_empty() { Err(wrong) } else { Ok(Export { files, notes }) }
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
