//! `calibrate`: factors on the losses of the laws, from tests.

mod tables;
mod text;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use willis::diagnostic::{Code, Diagnostic, Diagnostics};
use willis::study::{self, CalibrateRequest, Calibration};
use willis::units::Dimension;
use willis::work::Work;

use super::amount::of_members;
use crate::table::Table;
use crate::{Attachment, Extra, File, Given, Holds, Question, Refusal};

/// Fit the laws of a train to tests: factors on tooth friction, bearings, churning, with what is learnt and what is not.
///
/// Each row of the data, a CSV file, is one test: the measured `loss [W]`, perhaps `sigma [W]` (its standard deviation),
/// `group` (tests of one day or meter) and `note`; the other columns say how it ran, with the unit in the header:
/// `input.speed [rpm]`, `input.torque [N m]`, `oil.temperature [degC]`, state. The priors are how far the laws of each
/// kind of loss lie apart. The train file that results has the factors and what is left open of them, and every command
/// uses it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct Calibrate {
    /// The tests (CSV), or - for standard input.
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE.csv", required = true))]
    pub data: Attachment,
    /// Standard deviation of the measured loss where no column gives it, as a part of it. Default: 0.02.
    #[cfg_attr(feature = "clap", arg(long, value_name = "PART"))]
    pub sigma: Option<f64>,
    /// Look for the offset of a torque meter in each group, with its standard deviation before the tests: 'input=0.5 N m'.
    /// Several times for several meters.
    #[cfg_attr(feature = "clap", arg(long, value_name = "MEMBER=TORQUE"))]
    pub offset: Vec<String>,
    /// Only these kinds of loss may move: teeth, bearing_load, bearing_no_load, seal, churning, windage, rotor.
    #[cfg_attr(feature = "clap", arg(long, value_delimiter = ',', value_name = "KIND"))]
    pub parts: Vec<String>,
    /// The operation that gives what no column sets. Default: the file's first.
    #[cfg_attr(feature = "clap", arg(long, value_name = "OPERATION"))]
    pub operation: Option<String>,
    /// Take every reading as good: no outliers.
    #[cfg_attr(feature = "clap", arg(long))]
    pub trust_all: bool,
}

impl Question for Calibrate {
    const NAME: &'static str = "calibrate";
    const TABLES: &'static [&'static str] = &["factors", "tests", "predictions", "next"];
    const EXTRAS: &'static [Extra] =
        &[Extra { name: "train", value: "FILE.toml", about: "Write the train file with the factors into this file" }];
    type Answer = Calibration;

    fn ask(&self, of: &[Given], work: &dyn Work) -> Result<Calibration, Refusal> {
        let offsets = of_members("offset", &self.offset, Dimension::TORQUE)?;
        if self.data.text.is_empty() && self.data.name.is_empty() {
            let d = Diagnostic::new(Code::MissingKey, "", "no tests are given");
            return Err(Diagnostics::from(d.hint("give `data`, a table with `loss [W]` and how each test ran")).into());
        }
        let request = CalibrateRequest {
            data: self.data.text.clone(),
            name: self.data.name.clone(),
            sigma: self.sigma.unwrap_or(CalibrateRequest::default().sigma),
            offsets: offsets.into_iter().map(|(member, q)| (member, q.si())).collect(),
            parts: self.parts.clone(),
            operation: self.operation.clone(),
            trust_all: self.trust_all,
        };
        study::calibrate(&of[0].model, &request, work).map_err(|wrong| {
            // What is wrong with the tests stands in their table.
            match wrong.iter().any(|d| d.code == Code::BadTable) {
                true => Refusal::File(wrong, self.data.clone()),
                false => wrong.into(),
            }
        })
    }

    fn text(&self, answer: &Calibration, _: &[Given]) -> String {
        text::text(answer)
    }

    fn tables(&self, answer: &Calibration) -> Vec<Table> {
        tables::tables(answer)
    }

    fn extra(&self, answer: &Calibration, _: &str, _: &[Given]) -> Result<Vec<File>, Refusal> {
        Ok(vec![File::text("calibrated.toml", answer.train_file.clone())])
    }

    fn attachments(&mut self) -> Vec<(&mut Attachment, Holds)> {
        vec![(&mut self.data, Holds::Table)]
    }
}
