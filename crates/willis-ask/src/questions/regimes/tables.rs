//! Regimes as tables.

use willis::regimes::{Family, Regimes};

use crate::table::Kind::{Flag, Integer, Number, Text};
use crate::table::{Cell, Table};

/// One row a regime; a state without an atlas has a row with the reason.
pub fn regimes(all: &Regimes) -> Table {
    let mut t = Table::new(
        "regimes",
        [
            ("state", Text),
            ("regime", Text),
            ("mirror", Text),
            ("region", Integer),
            ("speeds", Text),
            ("torque_signs", Text),
            ("inputs", Text),
            ("outputs", Text),
            ("drivers", Text),
            ("efficiency_low", Number),
            ("efficiency_high", Number),
            ("efficiency_example", Number),
            ("formula", Text),
            ("efficiency_formula", Text),
            ("by_friction_only", Flag),
            ("all_dissipated", Flag),
            ("reason", Text),
        ],
    );
    let width = t.columns.len();
    for a in &all.states {
        if let Some(why) = &a.reason {
            let mut row: Vec<Cell> = vec![(&a.state).into()];
            row.resize(width - 1, Cell::Empty);
            row.push(why.to_string().into());
            t.row(row);
        }
        for r in &a.regimes {
            let formula = a.formulas.iter().find(|f| f.id == r.formula);
            let signs: Vec<String> = r.torque_signs.iter().map(|(n, s)| format!("{n} {s}")).collect();
            let drivers: Vec<String> =
                r.drivers.iter().filter_map(|(e, d)| d.as_ref().map(|d| format!("{d} in {e}"))).collect();
            t.row([
                (&a.state).into(),
                (&r.id).into(),
                (&r.mirror).into(),
                r.region.into(),
                a.regions[r.region - 1].order.join("; ").into(),
                signs.join("; ").into(),
                r.inputs.join("; ").into(),
                r.outputs.join("; ").into(),
                drivers.join("; ").into(),
                r.efficiency_range.map(|e| e[0]).into(),
                r.efficiency_range.map(|e| e[1]).into(),
                r.example.efficiency.into(),
                (&r.formula).into(),
                formula.map(|f| f.efficiency.clone()).into(),
                r.by_friction_only.into(),
                r.all_dissipated.into(),
                Cell::Empty,
            ]);
        }
    }
    t
}

/// One row a range of speeds and torques of a family.
pub fn family(f: &Family) -> Table {
    let mut t = Table::new(
        "family",
        [
            ("ratio_range", Text),
            ("in_the_paper", Flag),
            ("inputs", Text),
            ("outputs", Text),
            ("driver", Text),
            ("torque_signs", Text),
            ("speeds", Text),
            ("loss", Text),
            ("efficiency_example", Number),
        ],
    );
    for (k, case) in f.cases.iter().enumerate() {
        for row in &f.rows {
            for group in &row.cells[k] {
                for range in &group.ranges {
                    let signs: Vec<String> = range.torque_signs.iter().map(|(n, s)| format!("{n} {s}")).collect();
                    t.row([
                        (&case.label).into(),
                        (!case.band && case.low.is_some()).into(),
                        row.inputs.join("; ").into(),
                        row.outputs.join("; ").into(),
                        (&group.driver).into(),
                        signs.join("; ").into(),
                        range.order.join(" > ").into(),
                        (&group.loss).into(),
                        range.efficiency.into(),
                    ]);
                }
            }
        }
    }
    t
}
