//! Powers through components and contacts. The data are [`willis::hypergraph::FlowReport`].

pub mod dot;
pub mod draw;

use willis::diagnostic::{Code, Diagnostic, Diagnostics};
use willis::hypergraph::{FlowReport, flows_seen_from};
use willis::model::Model;

use crate::kind::{self, Ask, FigureRequest, Kind};
use crate::parts::point::pointed;

pub(crate) const KIND: Kind<FlowReport> = Kind {
    title: "Power flow",
    takes: &[Ask::State, Ask::Operation, Ask::SeenFrom],
    effort: kind::of_operations,
    applies: None,
    make: powers,
    steps: None,
    draw: |data, _| draw::draw(data),
};

/// The powers of the operations asked for, one at least: of a state without any its [default](pointed).
///
/// # Errors
/// What [`flows_seen_from`] says; there is no operation.
pub(crate) fn powers(model: &Model, r: &FigureRequest) -> Result<FlowReport, Diagnostics> {
    let train = model.train();
    let report = flows_seen_from(&pointed(train, &r.selection()), &r.selection(), r.seen_from.as_deref())?;
    if report.operations.is_empty() {
        let d = Diagnostic::new(Code::Unfit, "", "power flows in operations, and there is none");
        return Err(d
            .hint("add an [[operation]] with speeds and torques or powers; `stick` and `lever` need none")
            .into());
    }
    Ok(report)
}
