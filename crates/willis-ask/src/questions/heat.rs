//! `heat`: how warm a gearbox gets.

mod tables;
mod text;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use willis::diagnostic::{Diagnostic, Diagnostics};
use willis::study::{self, HeatRequest, HeatStudy};
use willis::units::{Dimension, Quantity};
use willis::work::Work;

use super::amount::values;
use crate::table::Table;
use crate::{Attachment, Given, Holds, Question, Refusal};

pub(super) use text::of_report;

/// Compute how warm the gearbox gets: oil temperature, parts, warm-up, thermal rating, duty cycles.
///
/// The oil temperature is the one at which the losses and what `[heat]` carries away agree, with the reason why there is no
/// other, or all of them with their stability, or none below the limit. The thermal rating is the largest load at the
/// limit. With heat capacities the warm-up from a cold start follows, and with a profile the steady state of a duty cycle
/// that repeats itself.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct Heat {
    /// Only this operation.
    #[cfg_attr(feature = "clap", arg(long, value_name = "OPERATION"))]
    pub operation: Option<String>,
    /// Only operations that run in this state of the shift table.
    #[cfg_attr(feature = "clap", arg(long, value_name = "STATE"))]
    pub state: Option<String>,
    /// How long the warm-up takes: '2 h'. Default: five time constants.
    #[cfg_attr(feature = "clap", arg(long, value_name = "TIME"))]
    pub duration: Option<String>,
    /// Oil temperature at the start of the warm-up: '-20 degC'. Default: that of the file, or of the air.
    #[cfg_attr(feature = "clap", arg(long, value_name = "TEMPERATURE"))]
    pub start: Option<String>,
    /// A duty cycle (CSV, as for `willis cycle`), or - for standard input: its steady state when it repeats itself.
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE.csv"))]
    pub profile: Option<Attachment>,
}

impl Question for Heat {
    const NAME: &'static str = "heat";
    const TABLES: &'static [&'static str] = &["heat", "places", "paths", "curve", "warm_up", "duty"];
    type Answer = HeatStudy;

    fn ask(&self, of: &[Given], work: &dyn Work) -> Result<HeatStudy, Refusal> {
        let mut told = Diagnostics::default();
        let mut one = |field: &str, text: &Option<String>, dimension| {
            let given = text.clone().into_iter().collect::<Vec<_>>();
            match values(field, &given, dimension) {
                Ok(all) => all.first().map(Quantity::si),
                Err(wrong) => {
                    told.extend(wrong);
                    None
                }
            }
        };
        let request = HeatRequest {
            operation: self.operation.clone(),
            state: self.state.clone(),
            duration_s: one("duration", &self.duration, Dimension::TIME),
            start_k: one("start", &self.start, Dimension::TEMPERATURE),
            profile: self.profile.as_ref().map_or(String::new(), |p| p.text.clone()),
        };
        if told.has_errors() {
            return Err(told.into());
        }
        study::heat(&of[0].model, &request, work).map_err(|wrong| {
            match (&self.profile, wrong.iter().any(|d| d.span.is_some())) {
                (Some(profile), true) => Refusal::File(wrong, profile.clone()),
                _ => wrong.into(),
            }
        })
    }

    fn text(&self, answer: &HeatStudy, _: &[Given]) -> String {
        text::text(answer)
    }

    fn tables(&self, answer: &HeatStudy) -> Vec<Table> {
        tables::tables(answer)
    }

    fn notes(answer: &HeatStudy) -> &[Diagnostic] {
        &answer.diagnostics
    }

    fn attachments(&mut self) -> Vec<(&mut Attachment, Holds)> {
        self.profile.as_mut().map(|f| (f, Holds::Table)).into_iter().collect()
    }
}
