//! `losses`: where every watt goes.

mod text;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use willis::analysis::{self, LossRequest, LossTable};
use willis::diagnostic::Diagnostics;
use willis::units::{Dimension, Quantity};
use willis::work::{Effort, Work};

use super::amount::values;
use super::names;
use crate::table::Table;
use crate::{Given, Question, Refusal};

pub(super) use text::of_solution;

/// List losses by source at a few speeds, loads and temperatures, or compare loss laws.
///
/// Starts from the operations of the file. Loads stay as the file gives them (a torque stays that torque, a power that
/// power) unless powers or torques vary them.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct Losses {
    /// Only this operation.
    #[cfg_attr(feature = "clap", arg(long, value_name = "OPERATION"))]
    pub operation: Option<String>,
    /// Speeds of the operation's first prescribed speed: 500rpm,1000rpm,2000rpm.
    #[cfg_attr(feature = "clap", arg(long, value_delimiter = ',', value_name = "SPEED"))]
    pub speeds: Vec<String>,
    /// Powers at the operation's first load: 100kW,200kW.
    #[cfg_attr(feature = "clap", arg(long, value_delimiter = ',', value_name = "POWER", conflicts_with = "torques"))]
    pub powers: Vec<String>,
    /// Torques at the operation's first load: '100 N m,200 N m'.
    #[cfg_attr(feature = "clap", arg(long, value_delimiter = ',', value_name = "TORQUE"))]
    pub torques: Vec<String>,
    /// Oil temperatures: 40degC,60degC,90degC.
    #[cfg_attr(feature = "clap", arg(long, value_delimiter = ',', value_name = "TEMPERATURE"))]
    pub temperature: Vec<String>,
    /// Compare all laws of this family: mesh_friction, bearing, windage, ...
    #[cfg_attr(feature = "clap", arg(long, value_name = "FAMILY"))]
    pub compare: Option<String>,
}

impl Question for Losses {
    const NAME: &'static str = "losses";
    const TABLES: &'static [&'static str] = &["points"];
    type Answer = LossTable;

    fn check(&self) -> Result<(), Diagnostics> {
        names::apart(&[[("powers", !self.powers.is_empty()), ("torques", !self.torques.is_empty())]])
    }

    fn ask(&self, of: &[Given], work: &dyn Work) -> Result<LossTable, Refusal> {
        let request = LossRequest {
            operation: self.operation.clone(),
            speeds: values("speeds", &self.speeds, Dimension::ANGULAR_SPEED)?,
            powers: values("powers", &self.powers, Dimension::POWER)?,
            torques: values("torques", &self.torques, Dimension::TORQUE)?,
            temperatures: values("temperature", &self.temperature, Dimension::TEMPERATURE)?
                .iter()
                .map(Quantity::si)
                .collect(),
            compare: self.compare.clone(),
            // Of a few points, not of a map.
            bands: self.compare.is_none()
                && [&self.speeds, &self.powers, &self.torques, &self.temperature].iter().all(|v| v.is_empty()),
        };
        let train = of[0].model.train();
        work.afford(&Effort::of_points(train, request.points(train)))?;
        Ok(analysis::losses(train, &request)?)
    }

    fn text(&self, answer: &LossTable, _: &[Given]) -> String {
        text::points(answer)
    }

    fn tables(&self, answer: &LossTable) -> Vec<Table> {
        vec![text::table_of(answer)]
    }
}
