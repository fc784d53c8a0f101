//! How warm a gearbox gets, as tables.

use willis::study::HeatStudy;

use crate::table::Kind::{Flag, Number, Text};
use crate::table::{Table, word};

pub fn tables(all: &HeatStudy) -> Vec<Table> {
    let mut heat = Table::new(
        "heat",
        [
            ("operation", Text),
            ("oil_k", Number),
            ("basis", Text),
            ("verdict", Text),
            ("limit_k", Number),
            ("margin_k", Number),
            ("heat_w", Number),
            ("residual_w", Number),
            ("rating", Text),
            ("load_factor", Number),
            ("rated_input_power_w", Number),
        ],
    );
    let mut places = Table::new(
        "places",
        [
            ("operation", Text),
            ("place", Text),
            ("temperature_k", Number),
            ("heat_w", Number),
            ("share_to_oil", Number),
            ("given", Flag),
        ],
    );
    let mut paths = Table::new("paths", [("operation", Text), ("from", Text), ("to", Text), ("heat_w", Number)]);
    let mut curve =
        Table::new("curve", [("operation", Text), ("oil_k", Number), ("reaching_w", Number), ("carried_w", Number)]);
    let mut warm_up = Table::new(
        "warm_up",
        [("operation", Text), ("time_s", Number), ("place", Text), ("temperature_k", Number), ("heat_w", Number)],
    );
    for o in &all.operations {
        let Some(h) = &o.heat else { continue };
        let verdict = h.verdict.as_ref().map(word);
        heat.row([
            (&o.name).into(),
            h.oil_k.into(),
            word(&h.basis).into(),
            verdict.into(),
            h.limit_k.into(),
            h.margin_k.into(),
            h.heat_w.into(),
            h.residual_w.into(),
            o.rating.map(|r| word(&r.status)).into(),
            o.rating.and_then(|r| r.load_factor).into(),
            o.rating.and_then(|r| r.input_power_w).into(),
        ]);
        for (name, p) in h.places.iter() {
            places.row([
                (&o.name).into(),
                name.into(),
                p.temperature_k.into(),
                p.heat_w.into(),
                p.share_to_oil.into(),
                p.given.into(),
            ]);
        }
        for p in &h.paths {
            paths.row([(&o.name).into(), (&p.between[0]).into(), (&p.between[1]).into(), p.heat_w.into()]);
        }
        if let Some(q) = h.cooler_w {
            paths.row([(&o.name).into(), "oil".into(), "cooler".into(), q.into()]);
        }
        for p in &h.curve {
            curve.row([(&o.name).into(), p.oil_k.into(), p.reaching_w.into(), p.carried_w.into()]);
        }
        for (w, r) in o.warm_up.iter().flat_map(|w| w.rows.iter().map(move |r| (w, r))) {
            for (place, t) in w.places.iter().zip(&r.temperatures_k) {
                warm_up.row([(&o.name).into(), r.time_s.into(), place.into(), (*t).into(), r.heat_w.into()]);
            }
        }
    }
    let mut tables = vec![heat, places, paths, curve.aside(), warm_up.aside()];
    if let Some(d) = &all.duty {
        let mut duty =
            Table::new("duty", [("time_s", Number), ("place", Text), ("temperature_k", Number), ("heat_w", Number)]);
        for r in &d.rows {
            for (place, t) in d.places.iter().zip(&r.temperatures_k) {
                duty.row([r.time_s.into(), place.into(), (*t).into(), r.heat_w.into()]);
            }
        }
        tables.push(duty.aside());
    }
    tables
}
