//! Schemes and hybrids as tables.

use willis_synthesis::schemes::{Hybrids, Scheme, SchemeGear, Schemes};

use crate::table::Kind::{Flag, Integer, Number, Text};
use crate::table::{Cell, Kind, Table};

/// Tables of shift schemes: a row a scheme, a row a gear, a row a rule.
pub fn schemes(all: &Schemes) -> Vec<Table> {
    vec![rows(all), gears(all), waterfall(all)]
}

/// The largest step of a scheme.
pub fn largest_step(scheme: &Scheme) -> Option<f64> {
    scheme.gears.iter().filter_map(|g| g.step).reduce(f64::max)
}

/// The lowest efficiency of its gears; none where a gear has none.
pub fn lowest_efficiency(scheme: &Scheme) -> Option<f64> {
    let all: Option<Vec<f64>> = scheme.gears.iter().chain(&scheme.reverse).map(|g| g.efficiency).collect();
    all?.into_iter().reduce(f64::min)
}

fn rows(all: &Schemes) -> Table {
    let mut t = Table::new(
        "schemes",
        [
            ("row", Integer),
            ("scheme", Text),
            ("layout", Text),
            ("known", Text),
            ("elements", Text),
            ("brakes", Integer),
            ("ratios", Text),
            ("ratio_spread", Number),
            ("largest_step", Number),
            ("lowest_efficiency", Number),
            ("largest_torque_factor", Number),
            ("largest_speed_factor", Number),
            ("planar", Flag),
        ],
    );
    for (k, s) in all.schemes.iter().enumerate() {
        let elements: Vec<String> = s.elements.iter().map(|e| format!("{}: {}", e.name, e.joins.join(" - "))).collect();
        let ratios: Vec<String> = s.gears.iter().chain(&s.reverse).map(|g| g.ratio.to_string()).collect();
        t.row([
            (k + 1).into(),
            (&s.id).into(),
            s.layout.to_string().into(),
            s.known.clone().into(),
            elements.join("; ").into(),
            s.brakes.into(),
            ratios.join("; ").into(),
            s.spread.into(),
            largest_step(s).into(),
            lowest_efficiency(s).into(),
            s.max_torque.into(),
            s.max_speed.into(),
            s.planar.into(),
        ]);
    }
    t
}

fn gears(all: &Schemes) -> Table {
    let elements: Vec<String> = (0..all.wish.elements as u8).map(|e| char::from(b'A' + e).to_string()).collect();
    let factors: Vec<(String, Kind)> = (elements.iter())
        .flat_map(|e| [(format!("{e}.torque_factor"), Number), (format!("{e}.slip_factor"), Number)])
        .collect();
    let fixed = [
        ("row", Integer),
        ("scheme", Text),
        ("gear", Text),
        ("closed", Text),
        ("ratio_exact", Text),
        ("ratio", Number),
        ("step", Number),
        ("efficiency", Number),
        ("no_efficiency", Text),
    ];
    let mut t = Table::new("gears", fixed.into_iter().chain(factors.iter().map(|(name, kind)| (name.as_str(), *kind))));
    for (k, s) in all.schemes.iter().enumerate() {
        for g in s.gears.iter().chain(&s.reverse) {
            let factors = elements
                .iter()
                .flat_map(|e| -> [Cell; 2] { [g.torques.get(e).copied().into(), g.slips.get(e).copied().into()] });
            let SchemeGear { name, closed, ratio, value, step, efficiency, no_efficiency, .. } = g;
            let fixed: [Cell; 9] = [
                (k + 1).into(),
                (&s.id).into(),
                name.into(),
                closed.join(" ").into(),
                ratio.to_string().into(),
                (*value).into(),
                (*step).into(),
                (*efficiency).into(),
                no_efficiency.clone().into(),
            ];
            t.row(fixed.into_iter().chain(factors));
        }
    }
    t
}

fn waterfall(all: &Schemes) -> Table {
    let mut t = Table::new("waterfall", [("rule", Text), ("left", Integer), ("about", Text)]);
    for stage in &all.waterfall {
        t.row([(&stage.rule).into(), stage.left.into(), (&stage.about).into()]);
    }
    t
}

/// Tables of hybrids: a row a design, a row a mode.
pub fn hybrids(all: &Hybrids) -> Vec<Table> {
    let mut designs = Table::new(
        "hybrids",
        [("row", Integer), ("hybrid", Text), ("layout", Text), ("clutches", Text), ("same", Integer), ("modes", Text)],
    );
    let mut modes = Table::new(
        "modes",
        [
            ("row", Integer),
            ("hybrid", Text),
            ("mode", Text),
            ("closed", Text),
            ("turning", Text),
            ("ratio_exact", Text),
            ("ratio", Number),
            ("mechanical_points", Text),
        ],
    );
    for (k, d) in all.designs.iter().enumerate() {
        let clutches = d.clutches.iter().enumerate().map(|(n, joins)| format!("C{}: {}", n + 1, joins.join(" - ")));
        let kinds: Vec<String> = d.modes.iter().map(|m| m.kind.to_string()).collect();
        designs.row([
            (k + 1).into(),
            (&d.id).into(),
            (&d.layout).into(),
            clutches.collect::<Vec<_>>().join("; ").into(),
            d.same.into(),
            kinds.join("; ").into(),
        ]);
        for m in &d.modes {
            let points: Vec<String> = m.mechanical_points.iter().map(ToString::to_string).collect();
            modes.row([
                (k + 1).into(),
                (&d.id).into(),
                m.kind.to_string().into(),
                m.closed.join(" ").into(),
                m.turning.join(" ").into(),
                m.ratio.as_ref().map(ToString::to_string).into(),
                m.ratio.as_ref().map(willis::exact::Rational::to_f64).into(),
                points.join("; ").into(),
            ]);
        }
    }
    vec![designs, modes]
}
