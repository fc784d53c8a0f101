//! The account of an import, as tables.

use willis_exchange::rexs::Report;

use crate::table::Kind::{Flag, Integer, Number, Text};
use crate::table::{Cell, Table, word};

pub fn tables(r: &Report) -> Vec<Table> {
    let whole = |x: Option<i64>| x.map_or(Cell::Empty, Cell::Integer);
    let mut attributes = Table::new(
        "attributes",
        [
            ("load_case", Integer),
            ("component", Integer),
            ("type", Text),
            ("attribute", Text),
            ("value", Text),
            ("value_unit", Text),
            ("fate", Text),
            ("why", Text),
        ],
    );
    for a in &r.attributes {
        let fate: Cell = word(&a.fate).into();
        let of: [Cell; 4] = [whole(a.load_case), Cell::Integer(a.component), (&a.kind).into(), (&a.attribute).into()];
        let [case, component, kind, attribute] = of;
        attributes.row([case, component, kind, attribute, (&a.value).into(), (&a.unit).into(), fate, (&a.why).into()]);
    }
    let mut assumptions = Table::new("assumptions", [("of", Text), ("taken", Text), ("because", Text)]);
    for g in &r.guessed {
        assumptions.row([(&g.of).into(), (&g.taken).into(), (&g.because).into()]);
    }
    let mut problems = Table::new("problems", [("place", Text), ("message", Text)]);
    for p in &r.problems {
        problems.row([(&p.place).into(), (&p.message).into()]);
    }
    let mut bearings =
        Table::new("bearings", [("bearing", Text), ("designation", Text), ("count", Integer), ("carried", Flag)]);
    for b in &r.bearings {
        bearings.row([(&b.name).into(), b.designation.as_ref().into(), b.count.into(), b.carried.into()]);
    }
    let mut cases = Table::new("load_cases", [("load_case", Integer), ("operation", Text), ("share", Number)]);
    for c in &r.load_cases {
        cases.row([whole(c.load_case), c.operation.as_ref().into(), c.share.into()]);
    }
    vec![attributes, assumptions, problems, bearings, cases]
}

/// The load cases as a load spectrum.
pub fn spectrum(r: &Report) -> Result<Table, String> {
    let Some(first) = r.load_cases.first().filter(|_| r.load_cases.len() > 1) else {
        return Err("the file has no load cases, of which a load spectrum could be made".into());
    };
    let names: Vec<&String> = first.columns.iter().map(|c| &c.name).collect();
    let columns = std::iter::once("share").chain(names.iter().map(|n| n.as_str()));
    let mut table = Table::new("spectrum", columns.map(|c| (c, Number)));
    for case in &r.load_cases {
        let id = case.load_case.unwrap_or_default();
        let Some(share) = case.share.filter(|_| case.operation.is_some()) else {
            return Err(format!("load case {id} has no part of the time, or no speeds and torques"));
        };
        if case.columns.iter().map(|c| &c.name).ne(names.iter().copied()) {
            return Err(format!("load case {id} prescribes something else than the first one"));
        }
        let values = std::iter::once(share).chain(case.columns.iter().map(|c| c.value));
        table.row(values.map(Cell::from).collect::<Vec<_>>());
    }
    Ok(table)
}
