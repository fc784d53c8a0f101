//! What a duty cycle or a load spectrum costs, as tables.

use willis::study::CycleReport;

use crate::table::Kind::{Integer, Number, Text};
use crate::table::{Cell, Table};

pub fn tables(r: &CycleReport) -> Vec<Table> {
    let mut all = vec![];
    let mut t = Table::new("cycle", [("quantity", Text), ("value", Number)]);
    let values: [(&str, Cell); 13] = [
        ("rows", (r.rows as f64).into()),
        ("conditions", (r.conditions as f64).into()),
        ("time_s", r.time_s.into()),
        ("covered_s", r.covered_s.into()),
        ("coverage", r.coverage.into()),
        ("energy_in_j", r.energy_in_j.into()),
        ("energy_out_j", r.energy_out_j.into()),
        ("energy_lost_j", r.energy_lost_j.into()),
        ("energy_residual_j", r.energy_residual_j.into()),
        ("power_residual_w", r.power_residual_w.into()),
        ("efficiency", r.efficiency.into()),
        ("time_mean_efficiency", r.time_mean_efficiency.into()),
        ("mean_loss_w", r.mean_loss_w.into()),
    ];
    for (name, value) in values {
        t.row([name.into(), value]);
    }
    all.push(t);
    for (title, parts) in [("directions", &r.ways), ("states", &r.states)] {
        let mut t = Table::new(
            title,
            [
                ("name", Text),
                ("rows", Integer),
                ("time_s", Number),
                ("energy_in_j", Number),
                ("energy_out_j", Number),
                ("energy_lost_j", Number),
                ("efficiency", Number),
            ],
        );
        for (name, e) in parts.iter() {
            t.row([
                name.into(),
                e.rows.into(),
                e.time_s.into(),
                e.energy_in_j.into(),
                e.energy_out_j.into(),
                e.energy_lost_j.into(),
                e.efficiency.into(),
            ]);
        }
        all.push(t);
    }
    let columns = [("source", Text), ("kind", Text), ("law", Text), ("energy_j", Number), ("share", Number)];
    let mut t = Table::new("sources", columns);
    for s in &r.sources {
        t.row([(&s.name).into(), s.kind.name().into(), s.law.to_string().into(), s.energy_j.into(), s.share.into()]);
    }
    all.push(t);
    let mut t = Table::new("terminals", [("member", Text), ("energy_in_j", Number), ("energy_out_j", Number)]);
    for (name, e) in r.terminals.iter() {
        t.row([name.into(), e.energy_in_j.into(), e.energy_out_j.into()]);
    }
    all.push(t);
    let columns =
        [("verdict", Text), ("rows", Integer), ("time_s", Number), ("share_of_time", Number), ("reason", Text)];
    let mut t = Table::new("verdicts", columns);
    for (name, v) in r.verdicts.iter() {
        let reason = v.reasons.first().map(|s| s.message.to_string());
        t.row([name.to_string().into(), v.rows.into(), v.time_s.into(), v.share_of_time.into(), reason.into()]);
    }
    all.push(t);
    let mut t = Table::new(
        "worst",
        [
            ("by", Text),
            ("line", Integer),
            ("rows", Integer),
            ("time_s", Number),
            ("condition", Text),
            ("efficiency", Number),
            ("loss_w", Number),
            ("energy_lost_j", Number),
        ],
    );
    for (by, worst) in [("loss", &r.worst.loss), ("efficiency", &r.worst.efficiency), ("energy", &r.worst.energy)] {
        for w in worst {
            t.row([
                by.into(),
                w.line.into(),
                w.rows.into(),
                w.time_s.into(),
                (&w.condition).into(),
                w.efficiency.into(),
                w.loss_w.into(),
                w.energy_lost_j.into(),
            ]);
        }
    }
    all.push(t);
    all
}
