//! Trains that were found, as tables.

use willis_synthesis::teeth::{DesignAnswer, DesignRow};

use crate::table::Kind::{Flag, Integer, Number, Text};
use crate::table::{Cell, Kind, Table, word};

pub fn tables(a: &DesignAnswer) -> Vec<Table> {
    let mut all = vec![trains(a), waterfall(a)];
    if !a.relaxations.is_empty() {
        let mut t = Table::new(
            "relaxations",
            [("wish", Text), ("now", Number), ("needed", Number), ("trains", Integer), ("words", Text)],
        );
        for r in &a.relaxations {
            t.row([(&r.wish).into(), r.now.into(), r.needed.into(), r.trains.into(), (&r.words).into()]);
        }
        all.push(t);
    }
    all
}

fn whole(z: i64) -> Cell {
    Cell::Integer(z)
}

/// Columns that every set has beside its gears.
fn of_set(name: &str) -> [(String, Kind); 4] {
    [("planets", Integer), ("module_m", Number), ("hunting", Flag), ("phase", Text)]
        .map(|(column, kind)| (format!("{name}.{column}"), kind))
}

fn trains(a: &DesignAnswer) -> Table {
    let sample: Option<&DesignRow> = a.rows.first().or(a.own.as_ref().map(|o| &o.row));
    let mut columns: Vec<(String, Kind)> = vec![("row".into(), Integer), ("train".into(), Text)];
    for (set, own) in sample.iter().flat_map(|r| r.sets.iter()) {
        columns.extend(own.teeth.iter().map(|(gear, _)| (format!("{set}.{gear}.teeth"), Integer)));
        columns.extend(of_set(set));
    }
    for (state, _) in sample.iter().flat_map(|r| r.states.iter()) {
        columns.extend(["ratio", "error", "forward", "backward"].map(|column| (format!("{state}.{column}"), Number)));
    }
    let last = [
        ("error", Number),
        ("ring_teeth", Integer),
        ("ring_diameter_m", Number),
        ("forward", Number),
        ("backward", Number),
        ("self_locking", Flag),
        ("lock_margin", Number),
        ("planet_spin", Number),
        ("member_speed", Number),
        ("element_torque", Number),
        ("certified", Flag),
        ("laws_forward", Number),
        ("laws_backward", Number),
        ("laws_self_locking", Flag),
    ];
    columns.extend(last.map(|(name, kind)| (name.to_owned(), kind)));
    for (operation, _) in sample.iter().flat_map(|r| r.operations.iter()) {
        columns.push((format!("{operation}.efficiency"), Number));
        columns.push((format!("{operation}.loss_w"), Number));
    }
    let mut t = Table::new("trains", columns.iter().map(|(name, kind)| (name.as_str(), *kind)));
    let own = a.own.iter().map(|o| (&o.row, o.name.as_str()));
    for (r, name) in a.rows.iter().map(|r| (r, "")).chain(own) {
        let mut cells: Vec<Cell> = vec![r.number.into(), if name.is_empty() { Cell::Empty } else { name.into() }];
        for (_, s) in r.sets.iter() {
            cells.extend(s.teeth.iter().map(|(_, z)| whole(*z)));
            cells.extend([whole(s.chosen), s.module_m.into(), s.hunting.into(), word(&s.phase).into()]);
        }
        for (_, s) in r.states.iter() {
            cells.extend([s.value.into(), s.error.into(), s.forward.into(), s.backward.into()]);
        }
        cells.extend([
            r.error.into(),
            whole(r.ring_teeth),
            r.ring_diameter_m.into(),
            r.forward.into(),
            r.backward.into(),
            r.self_locking.into(),
            r.lock_margin.into(),
            r.planet_spin.into(),
            r.member_speed.into(),
            r.element_torque.into(),
            r.certified.into(),
            r.laws.as_ref().and_then(|l| l.forward).into(),
            r.laws.as_ref().and_then(|l| l.backward).into(),
            r.laws.as_ref().map(|l| l.self_locking).into(),
        ]);
        // Of a train without an answer there the cells stay empty, as many as in the other rows.
        for (operation, _) in sample.iter().flat_map(|r| r.operations.iter()) {
            let own = r.operations.get(operation);
            cells.push(own.and_then(|o| o.efficiency).into());
            cells.push(own.and_then(|o| o.loss_w).into());
        }
        t.row(cells);
    }
    t
}

fn waterfall(a: &DesignAnswer) -> Table {
    let planets: Vec<&str> =
        a.waterfall.first().iter().flat_map(|s| s.by_planets.iter().map(|(n, _)| n.as_str())).collect();
    let by: Vec<String> = planets.iter().map(|n| format!("planets_{n}")).collect();
    let mut columns = vec![("condition", Text), ("trains", Integer), ("designs", Integer)];
    columns.extend(by.iter().map(|name| (name.as_str(), Integer)));
    let mut t = Table::new("waterfall", columns);
    for s in &a.waterfall {
        let first = [(&s.condition).into(), s.trains.into(), s.designs.into()];
        let rest = planets.iter().map(|n| s.by_planets.get(n).copied().into());
        t.row(first.into_iter().chain(rest));
    }
    t
}
