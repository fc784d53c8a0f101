//! What tests say of the laws, as tables.

use willis::study::Calibration;

use crate::table::Kind::{Flag, Integer, Number, Text};
use crate::table::Table;

pub fn tables(c: &Calibration) -> Vec<Table> {
    let mut factors = Table::new(
        "factors",
        [
            ("key", Text),
            ("factor", Number),
            ("factor_band_low", Number),
            ("factor_band_high", Number),
            ("factor_spread", Number),
            ("prior", Number),
            ("learnt", Number),
            ("at_bound", Flag),
        ],
    );
    for p in &c.parts {
        factors.row([
            (&p.key).into(),
            p.factor.into(),
            p.band[0].into(),
            p.band[1].into(),
            p.spread.into(),
            p.prior.into(),
            p.learnt.into(),
            p.at_bound.into(),
        ]);
    }
    let mut tests = Table::new(
        "tests",
        [
            ("line", Integer),
            ("group", Text),
            ("condition", Text),
            ("measured_w", Number),
            ("sigma_w", Number),
            ("before_w", Number),
            ("predicted_w", Number),
            ("standard_residual", Number),
            ("left_out", Number),
            ("weight", Number),
            ("outlier", Flag),
        ],
    );
    for r in &c.residuals {
        tests.row([
            r.line.into(),
            (&r.group).into(),
            (&r.condition).into(),
            r.measured_w.into(),
            r.sigma_w.into(),
            r.before_w.into(),
            r.predicted_w.into(),
            r.residual.into(),
            r.left_out.into(),
            r.weight.into(),
            r.outlier.into(),
        ]);
    }
    let mut predictions = Table::new(
        "predictions",
        [
            ("operation", Text),
            ("before_w", Number),
            ("loss_w", Number),
            ("spread_w", Number),
            ("band_low_w", Number),
            ("band_high_w", Number),
        ],
    );
    for p in &c.predictions {
        predictions.row([
            (&p.operation).into(),
            p.before_w.into(),
            p.loss_w.into(),
            p.spread_w.into(),
            p.band_w[0].into(),
            p.band_w[1].into(),
        ]);
    }
    let mut next = Table::new("next", [("condition", Text), ("gain", Number), ("lowers_variance", Number)]);
    for n in &c.next {
        next.row([(&n.condition).into(), n.gain.into(), n.lowers_variance.into()]);
    }
    vec![factors, tests, predictions, next]
}
