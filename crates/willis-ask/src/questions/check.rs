//! `check`: everything that is wrong with a train file.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use willis::analysis::{self, Selection};
use willis::contract::{Contract, Format};
use willis::diagnostic::{Diagnostic, Diagnostics, Severity};
use willis::study;
use willis::work::{Effort, Work};

use crate::style::plural;
use crate::{Given, Question, Refusal};

/// Check a train file and say everything that is wrong with it.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct Check {}

/// A train file without errors.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct CheckAnswer {
    /// `willis-check-1`.
    pub format: Format<Self>,
    /// The file.
    pub file: String,
    /// Name of the train.
    pub train: String,
    /// How many members it has, planets included, without the frame.
    pub members: usize,
    /// How many meshes.
    pub meshes: usize,
    /// How many clutches, brakes and one-way clutches.
    pub shift_elements: usize,
    /// How many rows of the shift table.
    pub states: usize,
    /// How many operating points.
    pub operations: usize,
    /// How many motions to simulate.
    pub scenarios: usize,
    /// How many sweeps.
    pub studies: usize,
    /// Warnings and notes, each with its place in the file.
    pub diagnostics: Vec<Diagnostic>,
}

impl Contract for CheckAnswer {
    const FORMAT: &'static str = "willis-check-1";
}

impl Question for Check {
    const NAME: &'static str = "check";
    const NOTES_FIRST: bool = true;
    type Answer = CheckAnswer;

    fn ask(&self, of: &[Given], work: &dyn Work) -> Result<CheckAnswer, Refusal> {
        let given = &of[0];
        let train = given.model.train();
        work.afford(&Effort::of_analysis(train, &Selection::default()))?;
        let mut diagnostics: Diagnostics =
            analysis::analyze(train, &Selection::default())?.diagnostics.into_iter().collect();
        let mut wrong = Diagnostics::default();
        for study in train.studies() {
            wrong.extend(study::Sweep::of_file(&given.model, &study.name).err().unwrap_or_default());
        }
        if wrong.has_errors() {
            return Err(wrong.into());
        }
        given.model.locate(&mut diagnostics);
        Ok(CheckAnswer {
            format: Format::new(),
            file: given.name.clone(),
            train: train.name().to_owned(),
            members: train.members().len() - 1,
            meshes: train.meshes().len(),
            shift_elements: train.shift_elements().len(),
            states: train.states().len(),
            operations: train.operations().len(),
            scenarios: train.scenarios().len(),
            studies: train.studies().len(),
            diagnostics: diagnostics.into_iter().collect(),
        })
    }

    fn text(&self, answer: &CheckAnswer, _: &[Given]) -> String {
        let warnings = answer.diagnostics.iter().filter(|d| d.severity == Severity::Warning).count();
        format!(
            "{}: {}, {}, {}, {}, {}: no errors, {}\n",
            answer.file,
            plural(answer.members, "member", "members"),
            plural(answer.meshes, "mesh", "meshes"),
            plural(answer.shift_elements, "shift element", "shift elements"),
            plural(answer.states, "state", "states"),
            plural(answer.operations, "operation", "operations"),
            plural(warnings, "warning", "warnings"),
        )
    }

    fn notes(answer: &CheckAnswer) -> &[Diagnostic] {
        &answer.diagnostics
    }
}
