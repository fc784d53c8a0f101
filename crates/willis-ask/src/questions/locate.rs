//! `locate`: the regime of one operating point.

mod text;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use willis::regimes::{self, LocateRequest, Location};
use willis::units::Dimension;
use willis::work::Work;

use super::amount::{of_members, pair};
use crate::{Given, Question, Refusal};

/// Find the regime of an operating point, how far each boundary is and what changes there.
///
/// Works for trains of any size: it looks at this one point.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct Locate {
    /// State of the shift table; else the train as drawn.
    #[cfg_attr(feature = "clap", arg(long, value_name = "STATE"))]
    pub state: Option<String>,
    /// Speeds of as many members as there are degrees of freedom: engine=2000rpm,ring=1000rpm.
    #[cfg_attr(feature = "clap", arg(long, value_delimiter = ',', value_name = "MEMBER=SPEED"))]
    pub speeds: Vec<String>,
    /// Torques of as many terminals as are independent: 'engine=100 N m'.
    #[cfg_attr(feature = "clap", arg(long, value_delimiter = ',', value_name = "MEMBER=TORQUE"))]
    pub torques: Vec<String>,
    /// Powers into the train, in place of torques: 'engine=40 kW'.
    #[cfg_attr(feature = "clap", arg(long, value_delimiter = ',', value_name = "MEMBER=POWER"))]
    pub powers: Vec<String>,
    /// Take speeds, torques and powers from this operation of the file.
    #[cfg_attr(feature = "clap", arg(long, value_name = "OPERATION"))]
    pub operation: Option<String>,
    /// Members on which torque may act, with commas between; else the train's terminals.
    #[cfg_attr(feature = "clap", arg(long, value_delimiter = ','))]
    pub terminals: Option<Vec<String>>,
    /// Two terminals whose powers add to zero.
    #[cfg_attr(feature = "clap", arg(long, value_delimiter = ',', value_name = "A,B"))]
    pub balance: Option<Vec<String>>,
}

impl Question for Locate {
    const NAME: &'static str = "locate";
    type Answer = Location;

    fn ask(&self, of: &[Given], _: &dyn Work) -> Result<Location, Refusal> {
        let request = LocateRequest {
            state: self.state.clone(),
            terminals: self.terminals.clone(),
            balance: pair(self.balance.as_deref())?,
            operation: self.operation.clone(),
            speeds: of_members("speeds", &self.speeds, Dimension::ANGULAR_SPEED)?,
            torques: of_members("torques", &self.torques, Dimension::TORQUE)?,
            powers: of_members("powers", &self.powers, Dimension::POWER)?,
        };
        Ok(regimes::locate(of[0].model.train(), &request)?)
    }

    fn text(&self, answer: &Location, _: &[Given]) -> String {
        text::location(answer)
    }
}
