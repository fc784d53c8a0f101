//! Laws and catalogues for eyes.

use willis::losses::{self, LawList, LawReport};

use crate::style::{bold, dim, right, set_header, show, significant, table, wrap};

use super::{OneBearing, OneOil};

/// The range of a law: `0.1 ≤ v ≤ 50 m/s, Ra ≤ 1 µm`.
pub fn range(l: &LawReport) -> String {
    let one = |b: &losses::Bounds| {
        let value = |x: f64| significant(x, 3);
        let unit = if b.unit == "-" { String::new() } else { format!(" {}", b.unit) };
        let symbol = &b.symbol;
        match (b.min.filter(|x| *x > 0.0), b.max) {
            (Some(low), Some(high)) => format!("{} ≤ {symbol} ≤ {}{unit}", value(low), value(high)),
            (None, Some(high)) => format!("{symbol} ≤ {}{unit}", value(high)),
            (Some(low), None) => format!("{symbol} ≥ {}{unit}", value(low)),
            (None, None) => format!("any {symbol}"),
        }
    };
    let all: Vec<String> = l.valid.iter().map(one).collect();
    if all.is_empty() { "not limited".into() } else { all.join(", ") }
}

/// Every law, family by family.
pub fn laws(all: &LawList) -> String {
    let entries = losses::entries();
    let mut out = String::new();
    let mut family = "";
    for l in &all.laws {
        if l.family != family {
            if !family.is_empty() {
                out.push('\n');
            }
            family = &l.family;
            let unit = if l.gives.unit == "-" { String::new() } else { format!(", {}", l.gives.unit) };
            out += &format!("{}   gives {}{unit}\n", bold(family), l.gives.symbol);
        }
        let mut marks = Vec::new();
        if l.default {
            marks.push("default".to_owned());
        }
        let entry = entries.iter().find(|e| e.family == l.family && e.id == l.law);
        for t in entry.map_or(&[][..], |e| e.tags) {
            marks.push(t.words().to_owned());
        }
        let marks = if marks.is_empty() { String::new() } else { format!(" ({})", marks.join("; ")) };
        out += &format!("  {}{marks}\n", bold(&l.law));
        for line in [
            l.title.clone(),
            format!("range: {}", range(l)),
            format!("source: [{}] {}; {}", l.source, l.place, l.trust),
        ] {
            out += &wrap(&line, "      ");
            out.push('\n');
        }
    }
    out
}

/// The catalogue of oils.
pub fn oils(all: &[OneOil]) -> String {
    let mut t = table();
    set_header(&mut t, &["oil", "base", "ν 40 °C", "ν 100 °C", "ρ 15 °C", "trust"]);
    for o in all {
        let nu = |x: Option<f64>| x.map_or("-".into(), |x| significant(x * 1e6, 4));
        t.add_row([
            o.name.clone(),
            o.base.clone(),
            nu(o.viscosity_40_m2_s),
            nu(o.viscosity_100_m2_s),
            significant(o.density_15_kg_m3, 4),
            o.trust.clone(),
        ]);
    }
    right(&mut t, 2..5);
    show(&t) + &dim("  ν in mm²/s, ρ in kg/m³\n")
}

/// The catalogue of bearings.
pub fn bearings(all: &[OneBearing]) -> String {
    let mut t = table();
    set_header(&mut t, &["bearing", "kind", "d mm", "D mm", "B mm", "C0 kN", "SKF constants", "trust"]);
    for b in all {
        t.add_row([
            b.designation.clone(),
            b.kind.clone(),
            significant(b.bore_m * 1e3, 4),
            significant(b.outside_diameter_m * 1e3, 4),
            significant(b.width_m * 1e3, 4),
            b.static_rating_n.map_or("-".into(), |c| significant(c / 1e3, 4)),
            if b.skf { "yes" } else { "no" }.into(),
            b.trust.clone(),
        ]);
    }
    right(&mut t, 2..6);
    show(&t)
}
