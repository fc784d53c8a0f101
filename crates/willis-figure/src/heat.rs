//! How warm an operating point gets: its places and the heat between them, the balance as two curves, the warm-up.

pub mod draw;

use serde::{Deserialize, Serialize};
use willis::analysis::HeatReport;
use willis::diagnostic::{Code, Diagnostic, Diagnostics};
use willis::model::Model;
use willis::study::{HeatRequest, HeatStudy, WarmUp};
use willis::work::Serial;

use crate::kind::{self, Ask, FigureRequest, Kind};

pub(crate) const KIND: Kind<HeatPicture> = Kind {
    title: "How warm it gets",
    takes: &[Ask::State, Ask::Operation],
    effort: kind::of_operations,
    applies: Some(|model| model.train().heat().is_some() && !model.train().operations().is_empty()),
    make: of_request,
    steps: None,
    draw: draw::draw_on,
};

/// The heat of an operating point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct HeatPicture {
    /// The train, the operation and its state.
    pub title: String,
    /// Temperatures, and where the heat goes.
    pub heat: HeatReport,
    /// Largest power in at the limit of the oil temperature, W.
    pub rating_w: Option<f64>,
    /// From a cold start on.
    pub warm_up: Option<WarmUp>,
}

fn of_request(model: &Model, r: &FigureRequest) -> Result<HeatPicture, Diagnostics> {
    let request = HeatRequest { operation: r.operation.clone(), state: r.state.clone(), ..HeatRequest::default() };
    heat_picture(&willis::study::heat(model, &request, &Serial)?, r.operation.as_deref())
}

/// The picture of an operation (the first one that has an oil temperature, if none is named) of a
/// [study of heat](willis::study::heat).
///
/// # Errors
/// An unknown operation, or one without an oil temperature.
pub fn heat_picture(all: &HeatStudy, operation: Option<&str>) -> Result<HeatPicture, Diagnostics> {
    let named = |name: &str| all.operations.iter().find(|o| o.name == name);
    let found = match operation {
        Some(name) => named(name),
        None => all.operations.iter().find(|o| o.heat.is_some()).or(all.operations.first()),
    };
    let Some(o) = found else {
        let name = operation.unwrap_or_default();
        let d = Diagnostic::new(Code::UnknownSelection, "", format!("no heat of an operation `{name}`"));
        return Err(d.suggest(name, all.operations.iter().map(|o| o.name.as_str())).into());
    };
    let Some(heat) = &o.heat else {
        let message = format!("no oil temperature of `{}`: the operating point is {}", o.name, o.verdict.words());
        let d = Diagnostic::new(Code::Unfit, "", message);
        return Err(d.hint("it needs an operation with exactly one equilibrium").into());
    };
    let state = o.state.as_ref().map_or(String::new(), |s| format!(" (state {s})"));
    Ok(HeatPicture {
        title: format!("{}: {}{state}", all.train, o.name),
        heat: (**heat).clone(),
        rating_w: o.rating.and_then(|r| r.input_power_w),
        warm_up: o.warm_up.clone(),
    })
}
