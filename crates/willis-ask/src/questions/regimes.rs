//! `regimes`: every way a train can run.

mod latex;
mod tables;
mod text;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use willis::contract::Contract;
use willis::diagnostic::Diagnostics;
use willis::regimes::{self, Family, RegimeSelection};
use willis::work::Work;

use super::amount::pair;
use super::names;
#[cfg(feature = "pictures")]
use crate::Extra;
use crate::table::Table;
use crate::{File, Form, Given, Question, Refusal};

/// List every regime of a train: who drives whom, in which speeds, with which formula.
///
/// For two and more degrees of freedom: the regions of speed, the signs of the torques, inputs and outputs, the driving
/// gears, the closed formula of efficiency and loss, the boundaries and what changes across them, and which assignments of
/// inputs and outputs cannot be reached. For one degree of freedom: driving and coasting of every state with its formula.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct Regimes {
    /// Only this state of the shift table, or "as drawn".
    #[cfg_attr(feature = "clap", arg(long, value_name = "STATE"))]
    pub state: Option<String>,
    /// Members on which torque may act, with commas between; else the train's terminals.
    #[cfg_attr(feature = "clap", arg(long, value_delimiter = ','))]
    pub terminals: Option<Vec<String>>,
    /// Two terminals whose powers add to zero: the machines of a hybrid with an idle battery.
    #[cfg_attr(feature = "clap", arg(long, value_delimiter = ',', value_name = "A,B"))]
    pub balance: Option<Vec<String>>,
    /// One set with three terminals: for every basic ratio it can have (Esmail's Table 1).
    #[cfg_attr(feature = "clap", arg(long, conflicts_with = "balance"))]
    pub family: bool,
}

/// Regimes of a train, or of one set over all its basic ratios.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum RegimesAnswer {
    /// `willis-regimes-1`.
    Train(Box<regimes::Regimes>),
    /// `willis-family-1`.
    Family(Box<Family>),
}

impl Contract for RegimesAnswer {
    const FORMAT: &'static str = regimes::Regimes::FORMAT;
}

impl Regimes {
    fn selection(&self) -> Result<RegimeSelection, Refusal> {
        let (state, terminals) = (self.state.clone(), self.terminals.clone());
        Ok(RegimeSelection { state, terminals, balance: pair(self.balance.as_deref())? })
    }

    /// The regime map.
    #[cfg(feature = "pictures")]
    fn map(&self, of: &[Given]) -> Result<willis_figure::RegimeMap, Refusal> {
        Ok(willis_figure::regime_map(of[0].model.train(), &self.selection()?)?)
    }
}

impl Question for Regimes {
    const NAME: &'static str = "regimes";
    const TABLES: &'static [&'static str] = &["regimes", "family"];
    const FORMS: &'static [Form] = &[
        Form { name: "latex", endings: &["tex"], about: "a table for typesetting" },
        #[cfg(feature = "pictures")]
        Form { name: "map-json", endings: &[], about: "the regime map as data (two degrees of freedom)" },
    ];
    #[cfg(feature = "pictures")]
    const EXTRAS: &'static [Extra] = &[Extra {
        name: "map",
        value: "FILE.svg",
        about: "Draw the regime map (two degrees of freedom) into this SVG file",
    }];
    type Answer = RegimesAnswer;

    fn check(&self) -> Result<(), Diagnostics> {
        names::apart(&[[("family", self.family), ("balance", self.balance.is_some())]])
    }

    fn ask(&self, of: &[Given], _: &dyn Work) -> Result<RegimesAnswer, Refusal> {
        let (train, selection) = (of[0].model.train(), self.selection()?);
        Ok(match self.family {
            true => RegimesAnswer::Family(Box::new(regimes::family(train, &selection)?)),
            false => RegimesAnswer::Train(Box::new(regimes::regimes(train, &selection)?)),
        })
    }

    fn text(&self, answer: &RegimesAnswer, _: &[Given]) -> String {
        match answer {
            RegimesAnswer::Train(all) => text::text(all),
            RegimesAnswer::Family(all) => text::family(all),
        }
    }

    fn tables(&self, answer: &RegimesAnswer) -> Vec<Table> {
        vec![match answer {
            RegimesAnswer::Train(all) => tables::regimes(all),
            RegimesAnswer::Family(all) => tables::family(all),
        }]
    }

    fn write(&self, answer: &RegimesAnswer, form: &str, of: &[Given]) -> Result<Vec<File>, Refusal> {
        // Only a map needs the train again.
        let _ = of;
        Ok(vec![match (form, answer) {
            #[cfg(feature = "pictures")]
            ("map-json", _) => File::text("regimes.json", crate::json(&self.map(of)?)),
            (_, RegimesAnswer::Train(all)) => File::text("regimes.tex", latex::latex(all)),
            (_, RegimesAnswer::Family(all)) => File::text("family.tex", latex::family_latex(all)),
        }])
    }

    #[cfg(feature = "pictures")]
    fn extra(&self, _: &RegimesAnswer, _: &str, of: &[Given]) -> Result<Vec<File>, Refusal> {
        Ok(vec![File::text("regimes.svg", willis_figure::draw_regimes(&self.map(of)?))])
    }
}
