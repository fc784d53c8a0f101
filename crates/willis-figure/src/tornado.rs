//! What moves the losses of an operating point most: one bar for each quantity, the longest above.

pub mod draw;

use serde::{Deserialize, Serialize};
use willis::diagnostic::{Code, Diagnostic, Diagnostics};
use willis::model::Model;
use willis::study::{Sensitivity, StepKind, sensitivity};

use crate::kind::{self, Ask, FigureRequest, Kind};
use crate::parts::point::pointed;

pub(crate) const KIND: Kind<Tornado> = Kind {
    title: "What matters most",
    takes: &[Ask::State, Ask::Operation],
    effort: kind::of_operations,
    applies: None,
    make: ranking,
    steps: None,
    draw: draw::draw_on,
};

/// Bars of a ranking.
const BARS: usize = 14;

/// The ranking of the operation that is named, or of the first that has derivatives; of a state without any its default.
fn ranking(model: &Model, r: &FigureRequest) -> Result<Tornado, Diagnostics> {
    let all = sensitivity(&pointed(model.train(), &r.selection()), &r.selection())?;
    let first = all.operations.iter().find(|o| !o.quantities.is_empty()).map(|o| o.name.clone());
    tornado(&all, r.operation.clone().or(first).as_deref(), BARS)
}

/// Quantities of an operating point, ranked by what a small step of each does.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Tornado {
    /// The train, the operation and its state.
    pub title: String,
    /// Output over input power at the point; absent where nothing comes in.
    pub efficiency: Option<f64>,
    /// All losses at the point, W.
    pub loss_w: f64,
    /// Power in at all inputs, W.
    pub input_power_w: f64,
    /// The quantities, the largest change of the loss first.
    pub bars: Vec<TornadoBar>,
    /// How many more quantities move the loss, less than those shown.
    pub left_out: usize,
}

/// What one quantity does. Small steps down do the opposite of steps up.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct TornadoBar {
    /// Its path, as the file has it.
    pub name: String,
    /// Its value, SI.
    pub value: f64,
    /// SI unit of the value.
    pub unit: String,
    /// Whether it is not given but taken.
    pub assumed: bool,
    /// The step up.
    pub step: StepKind,
    /// Change of all losses for it, W.
    pub loss_change_w: f64,
    /// Change of the efficiency for it.
    pub efficiency_change: Option<f64>,
    /// The loss that it changes most.
    pub moves: Option<String>,
}

/// The bars of an operation (the first one, if none is named) of a [sensitivity](willis::study::sensitivity), at most
/// `most` of them.
///
/// # Errors
/// An unknown operation, one without derivatives (a train that locks), or without losses.
///
/// # Example
/// ```
/// use willis::Selection;
/// use willis_figure::tornado;
/// use willis::study::sensitivity;
/// use willis::train::{OperationSpec, SetSpec, Train};
/// use willis::units::{AngularSpeed, Torque};
///
/// let train = Train::builder("reducer")
///     .members(["sun", "carrier"])
///     .terminals(["sun", "carrier"])
///     .set(SetSpec::simple("P1", ("sun", 30), ("frame", 70), "carrier").planet(20, 4).mesh_efficiency(0.99))
///     .operation(
///         OperationSpec::new("rated")
///             .speed("sun", AngularSpeed::rpm(1000.0))
///             .torque("sun", Torque::n_m(100.0)),
///     )
///     .build()?;
/// let all = sensitivity(&train, &Selection::default())?;
/// let tornado = tornado(&all, None, 10)?;
/// assert!(tornado.bars.iter().any(|b| b.name == "P1.mesh_efficiency" && b.loss_change_w < 0.0));
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn tornado(all: &Sensitivity, operation: Option<&str>, most: usize) -> Result<Tornado, Diagnostics> {
    let Some(operation) = all.operations.iter().find(|o| operation.is_none_or(|name| o.name == name)) else {
        let known = all.operations.iter().map(|o| o.name.as_str());
        let name = operation.unwrap_or_default();
        let d = Diagnostic::new(Code::UnknownSelection, "", format!("no sensitivity of an operation `{name}`"));
        return Err([d.suggest(name, known)].into_iter().collect());
    };
    let unfit = |why: &str, hint: &str| -> Diagnostics {
        let text = format!("no ranking of what moves the losses of `{}`: {why}", operation.name);
        [Diagnostic::new(Code::Unfit, "", text).hint(hint)].into_iter().collect()
    };
    if let Some(reason) = &operation.reason {
        return Err(unfit(reason, "it needs an operation with exactly one equilibrium"));
    }
    if operation.quantities.is_empty() {
        return Err(unfit("nothing that the file gives moves a loss", "give efficiencies or teeth, and a load"));
    }
    let mut ranked: Vec<_> = operation.quantities.iter().collect();
    ranked.sort_by(|a, b| b.loss_change_w.abs().total_cmp(&a.loss_change_w.abs()));
    let bars = ranked.iter().take(most.max(1)).map(|q| TornadoBar {
        name: q.name.clone(),
        value: q.value,
        unit: q.unit.clone(),
        assumed: q.assumed,
        step: q.step,
        loss_change_w: q.loss_change_w,
        efficiency_change: q.efficiency_change,
        moves: q.sources.first().map(|s| s.name.clone()),
    });
    let state = operation.state.as_ref().map_or(String::new(), |s| format!(" (state {s})"));
    Ok(Tornado {
        title: format!("{}: {}{state}", all.train, operation.name),
        efficiency: operation.efficiency,
        loss_w: operation.loss_w,
        input_power_w: operation.input_power_w,
        bars: bars.collect(),
        left_out: ranked.len().saturating_sub(most.max(1)),
    })
}
