//! How sure a number is, as tables.

use willis::study::Uncertainty;

use crate::table::Kind::{Flag, Integer, Number, Text};
use crate::table::{Cell, Table};

pub fn tables(u: &Uncertainty) -> Vec<Table> {
    let head = [("result", Text), ("unit", Text), ("nominal", Number), ("below_nominal", Number)];
    let numbers = [
        "mean",
        "standard_deviation",
        "median",
        "p025",
        "p05",
        "p95",
        "p975",
        "least",
        "most",
        "mean_error",
        "median_error",
        "p025_error",
        "p05_error",
        "p95_error",
        "p975_error",
    ];
    let columns = head.into_iter().chain([("answered", Integer)]).chain(numbers.map(|n| (n, Number)));
    let mut results = Table::new("results", columns);
    let mut influences = Table::new(
        "influences",
        [
            ("result", Text),
            ("quantity", Text),
            ("first", Number),
            ("first_error", Number),
            ("total", Number),
            ("total_error", Number),
        ],
    );
    for o in &u.outputs {
        let mut row: Vec<Cell> =
            vec![(&o.name).into(), o.unit.to_string().into(), o.nominal.into(), o.below_nominal.into()];
        if let Some(s) = &o.statistics {
            let e = &s.sampling_error;
            row.push(s.answered.into());
            let all = [
                s.mean,
                s.standard_deviation,
                s.median,
                s.p025,
                s.p05,
                s.p95,
                s.p975,
                s.least,
                s.most,
                e.mean,
                e.median,
                e.p025,
                e.p05,
                e.p95,
                e.p975,
            ];
            row.extend(all.map(Cell::from));
        }
        row.resize(results.columns.len(), Cell::Empty);
        results.row(row);
        for i in &o.influences {
            let x = &i.index;
            let numbers = [x.first, x.first_error, x.total, x.total_error].map(Cell::from);
            influences.row([(&o.name).into(), (&i.quantity).into()].into_iter().chain(numbers));
        }
    }
    let mut choices = Table::new(
        "choices",
        [
            ("quantity", Text),
            ("value", Text),
            ("is_nominal", Flag),
            ("samples", Integer),
            ("answered", Integer),
            ("efficiency_median", Number),
            ("loss_median_w", Number),
            ("loss_p05_w", Number),
            ("loss_p95_w", Number),
        ],
    );
    for c in &u.choices {
        choices.row([
            (&c.quantity).into(),
            (&c.value).into(),
            c.is_nominal.into(),
            c.samples.into(),
            c.answered.into(),
            c.efficiency_median.into(),
            c.loss_median_w.into(),
            c.loss_p05_w.into(),
            c.loss_p95_w.into(),
        ]);
    }
    let mut verdicts = Table::new("verdicts", [("verdict", Text), ("samples", Integer)]);
    for (verdict, count) in &u.verdicts {
        verdicts.row([verdict.to_string().into(), (*count).into()]);
    }
    vec![results, influences, choices, verdicts]
}
