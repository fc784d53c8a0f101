//! Losses by source over a quantity.

use willis_figure::loss_chart;

use crate::trains::{examples, model};

/// What the sources of a chart lose is all that is lost, at the operating point and beside it, whoever gives or computes it.
#[test]
fn sources_of_losses_are_all_losses() {
    let mut seen = 0;
    for (name, train) in examples() {
        let model = model(&name);
        for operation in train.operations() {
            let Ok(chart) = loss_chart(&model, None, Some(&operation.name), &[]) else { continue };
            let Some(loss) = chart.loss_w else { continue };
            let sum: f64 = chart.series.iter().filter_map(|s| s.at_operation_w).sum();
            assert!((sum - loss).abs() <= 1e-9 * chart.input_power_w.unwrap().max(1.0), "{name}: {sum} W of {loss} W");
            seen += 1;
        }
    }
    assert!(seen > 40, "{seen}");
}
