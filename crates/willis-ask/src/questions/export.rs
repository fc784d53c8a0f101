//! `export`: files for other programs.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use willis::contract::{Contract, Format};
use willis::diagnostic::{Code, Diagnostic, Diagnostics};
use willis::study::export::{ExportRequest, KINDS, NotCarried, effort, export};
use willis::work::Work;

use super::names;
#[cfg(feature = "clap")]
use super::names::Known;
use crate::style::wrap;
use crate::{File, Form, Given, Of, Question, Refusal};

/// Write loss maps, efficiency tables, models and actuator blocks for other programs.
///
/// Without a kind it lists the kinds. Numbers are those of `analyze`, at every point of the ranges. Without ranges
/// Willis takes them from the operating points of the file and prints them. What a format cannot say (a lock, several solutions, a dependence
/// on load) stands in the comments of the file and among the notes; a point without an answer gets no number.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct Export {
    /// The format: vecto, modelica-loss-table, ...; or list.
    #[cfg_attr(feature = "clap", arg(value_parser = Known(names::exports), hide_possible_values = true))]
    #[schemars(extend("enum" = names::or_none(names::exports())))]
    pub kind: Option<String>,
    /// This state of the shift table.
    #[cfg_attr(feature = "clap", arg(long, value_name = "STATE", conflicts_with = "all_states"))]
    pub state: Option<String>,
    /// Every state that can be exported.
    #[cfg_attr(feature = "clap", arg(long))]
    pub all_states: bool,
    /// Take state and ranges from this operation of the file.
    #[cfg_attr(feature = "clap", arg(long, value_name = "OPERATION", conflicts_with = "all_states"))]
    pub operation: Option<String>,
    /// Speeds of the input: 200rpm..2200rpm:11 are 11 values; or 500rpm,1000rpm.
    #[cfg_attr(feature = "clap", arg(long, value_name = "RANGE"))]
    pub speeds: Option<String>,
    /// Torques on the input, positive driving, negative coasting: '-500 N m..500 N m:21'.
    #[cfg_attr(feature = "clap", arg(long, value_name = "RANGE"))]
    pub torques: Option<String>,
    /// Oil temperatures: 40degC,90degC. Most formats take one.
    #[cfg_attr(feature = "clap", arg(long, value_delimiter = ',', value_name = "TEMPERATURE"))]
    pub temperature: Vec<String>,
}

/// Files for another program, or the kinds there are.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct ExportAnswer {
    /// `willis-export-1`.
    pub format: Format<Self>,
    /// The format of the files; none where the kinds are listed.
    pub kind: Option<String>,
    /// The files.
    pub files: Vec<OneFile>,
    /// What the format cannot say, and what was taken for ranges that nobody gave.
    pub notes: Vec<String>,
    /// What the train file says and the files do not.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub not_carried: Vec<NotCarried>,
    /// What the model leaves out, and what stands in for data that were not given.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub assumptions: Vec<String>,
    /// The kinds there are, where no kind was named.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub kinds: Vec<OneKind>,
}

impl Contract for ExportAnswer {
    const FORMAT: &'static str = "willis-export-1";
}

/// An exported file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct OneFile {
    /// Its name, without a folder.
    pub name: String,
    /// What it is, in one line.
    pub about: String,
    /// Its text.
    pub text: String,
}

/// A format to export to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct OneKind {
    /// How it is asked for.
    pub name: String,
    /// What it is, in one line.
    pub about: String,
    /// Whether only the program `willis` writes it, because the file holds more than text.
    #[serde(default)]
    pub program_only: bool,
}

/// The kind that the program alone writes, because it packs a library of the machine: its name and one line about it.
///
/// Every way to ask lists it; who asks for it here is told where it is had.
pub const FMU: (&str, &str) = ("fmu", "Functional Mock-up Unit of a scenario, FMI 2.0 or 3.0 (.fmu)");

/// Every kind that can be asked for, in the order of the list: name and one line about it.
pub(super) fn kinds() -> Vec<(&'static str, &'static str)> {
    let kinds = KINDS.iter().map(|k| (k.id, k.about));
    #[cfg(feature = "import")]
    let kinds = kinds.chain(willis_exchange::c::KINDS).chain([REXS]);
    kinds.chain([FMU]).collect()
}

/// The format that a crate of its own writes.
#[cfg(feature = "import")]
const REXS: (&str, &str) = ("rexs", "the gearbox for gear programs: REXS 1.6 (XML)");

/// The train as REXS: all of it, whatever its states and operations.
#[cfg(feature = "import")]
fn rexs(model: &willis::model::Model, request: &ExportRequest) -> Result<willis::study::export::Export, Diagnostics> {
    use willis::study::export::{ExportedFile, export_with};
    if *request != ExportRequest::default() {
        let message = "this format has the whole gearbox, with all of its states and operations";
        let d = Diagnostic::new(Code::Conflict, "", message);
        return Err(d.hint("leave out states, operations, ranges and temperatures").into());
    }
    export_with(model, ["<!-- ", " -->"], &|train, is_trial| {
        let done = willis_exchange::rexs::written(train, !is_trial)?;
        let plain = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' };
        let name: String = train.name().chars().take(60).map(plain).collect();
        let name = name.split('-').filter(|p| !p.is_empty()).collect::<Vec<_>>().join("-");
        let name = if name.is_empty() { "train".to_owned() } else { name };
        let about = "the gearbox as REXS 1.6";
        Ok((vec![ExportedFile::new(format!("{name}.rexs"), done.text, about)], done.notes))
    })
}

impl Question for Export {
    const NAME: &'static str = "export";
    const OF: Of = Of::AtMostOne;
    const FORMS: &'static [Form] = &[Form { name: "files", endings: &["*"], about: "the files themselves" }];
    type Answer = ExportAnswer;

    fn check(&self) -> Result<(), Diagnostics> {
        names::apart(&[
            [("all_states", self.all_states), ("state", self.state.is_some())],
            [("all_states", self.all_states), ("operation", self.operation.is_some())],
        ])
    }

    fn ask(&self, of: &[Given], work: &dyn Work) -> Result<ExportAnswer, Refusal> {
        let answer = |kind: Option<&str>| ExportAnswer {
            format: Format::new(),
            kind: kind.map(str::to_owned),
            files: vec![],
            notes: vec![],
            not_carried: vec![],
            assumptions: vec![],
            kinds: vec![],
        };
        let kinds = kinds();
        let kind = match (self.kind.as_deref().filter(|k| *k != "list"), of) {
            (Some(kind), [_]) => kind,
            (Some(kind), _) => {
                let message = format!("no train is named to export as `{kind}`");
                let d = Diagnostic::new(Code::UnknownSelection, "", message);
                return Err(d.hint("name a train file after the kind of export").into());
            }
            (None, _) => {
                let one = |(name, about): (&str, &str)| OneKind {
                    name: name.to_owned(),
                    about: about.to_owned(),
                    program_only: name == FMU.0,
                };
                return Ok(ExportAnswer { kinds: kinds.into_iter().map(one).collect(), ..answer(None) });
            }
        };
        if !kinds.iter().any(|(name, _)| *name == kind) {
            let names: Vec<&str> = kinds.iter().map(|k| k.0).collect();
            let d = Diagnostic::new(Code::UnknownName, "", format!("there is no export `{kind}`"));
            let hint = format!("the exports are: {}", names.join(", "));
            return Err(d.suggest(kind, names).hint(hint).into());
        }
        if kind == FMU.0 {
            let message =
                "an FMU holds a library of this machine beside the train, and only the program `willis` packs it";
            let d = Diagnostic::new(Code::Conflict, "", message);
            return Err(d.hint("run `willis export fmu FILE` and name the file to write").into());
        }
        let request = ExportRequest {
            state: self.state.clone(),
            all_states: self.all_states,
            operation: self.operation.clone(),
            speeds: self.speeds.clone(),
            torques: self.torques.clone(),
            temperatures: (!self.temperature.is_empty()).then(|| self.temperature.join(",")),
        };
        work.afford(&effort(&of[0].model))?;
        #[cfg(feature = "import")]
        let done = match kind {
            _ if kind == REXS.0 => rexs(&of[0].model, &request),
            _ if willis_exchange::c::KINDS.iter().any(|k| k.0 == kind) => {
                willis_exchange::c::write(&of[0].model, kind, &request)
            }
            _ => export(&of[0].model, kind, &request),
        }?;
        #[cfg(not(feature = "import"))]
        let done = export(&of[0].model, kind, &request)?;
        let file = |f: willis::study::export::ExportedFile| OneFile { name: f.name, about: f.about, text: f.text };
        Ok(ExportAnswer {
            files: done.files.into_iter().map(file).collect(),
            notes: done.notes,
            not_carried: done.not_carried,
            assumptions: done.assumptions,
            ..answer(Some(kind))
        })
    }

    fn text(&self, answer: &ExportAnswer, _: &[Given]) -> String {
        let kinds = answer.kinds.iter().map(|k| format!("{:<21}{}\n", k.name, k.about));
        let files = answer.files.iter().map(|f| format!("{}: {}\n", f.name, f.about));
        kinds.chain(files).collect()
    }

    fn natural_form(&self) -> &'static str {
        if self.kind.as_deref().is_none_or(|k| k == "list") { "text" } else { "files" }
    }

    fn write(&self, answer: &ExportAnswer, _: &str, _: &[Given]) -> Result<Vec<File>, Refusal> {
        let file = |f: &OneFile| File { about: f.about.clone(), ..File::text(&f.name, &*f.text) };
        Ok(answer.files.iter().map(file).collect())
    }

    fn told(&self, answer: &ExportAnswer) -> Vec<String> {
        let notes = answer.notes.iter().map(|n| wrap(n, "note: "));
        notes.chain(answer.assumptions.iter().map(|a| wrap(&format!("assumed: {a}"), "note: "))).collect()
    }
}
