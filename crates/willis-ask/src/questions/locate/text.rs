//! Where an operating point lies, for eyes.

use willis::analysis::Role;
use willis::regimes::{Edge, Located, Location, Prescribes};

use crate::style::{bold, percent, rpm, set_header, show, significant, table, wrap};

/// Where an operating point lies, for eyes.
pub fn location(l: &Location) -> String {
    let mut out = bold(&l.train);
    if l.state != willis::train::AS_DRAWN {
        out += &format!("   state {}", l.state);
    }
    out += "\n";
    let speeds: Vec<String> =
        l.speeds_rad_s.iter().map(|(n, w)| format!("{n} {} rpm", significant(rpm(*w), 6))).collect();
    out += &wrap(&speeds.join(", "), "  speeds     ");
    out += "\n";
    out += &wrap(&l.order.join("; "), "  order      ");
    out += "\n";
    if !l.on.is_empty() {
        out += &wrap(&format!("on the boundary: {}", l.on.join("; ")), "  place      ");
        out += "\n";
    } else if let Some(region) = l.region {
        out += &format!("  place      inside region {region}\n");
    }
    if let Some(why) = &l.reason {
        out += &wrap(why, "  note       ");
        out += "\n";
    }
    if let Some(basis) = &l.efficiency_basis {
        out += &wrap(&basis.to_string(), "  losses     ");
        out += "\n";
    }
    if l.regimes.len() > 1 {
        out += &format!("  {} equilibria carry this load\n", l.regimes.len());
    }
    for r in &l.regimes {
        out += "\n";
        out += &located(r);
    }
    out
}

fn located(r: &Located) -> String {
    let mut out = match &r.regime {
        Some(id) => bold(&format!("Regime {id}")),
        None => bold("Equilibrium"),
    };
    let of =
        |role: Role| r.roles.iter().filter(|(_, x)| *x == role).map(|(n, _)| n.clone()).collect::<Vec<_>>().join(", ");
    let outputs = of(Role::Output);
    out += &format!("   {} → {}", of(Role::Input), if outputs.is_empty() { "heat" } else { &outputs });
    let driving: Vec<String> =
        r.drivers.iter().filter_map(|(e, d)| d.as_ref().map(|d| format!("{d} in {e}"))).collect();
    if !driving.is_empty() {
        out += &format!("   drives: {}", driving.join(", "));
    }
    out += "\n";
    let torques: Vec<String> = r.torques_n_m.iter().map(|(n, t)| format!("{n} {} N m", significant(*t, 6))).collect();
    out += &wrap(&torques.join(", "), "  torques    ");
    out += "\n";
    let powers: Vec<String> = r.powers_w.iter().map(|(n, p)| format!("{n} {} W", significant(*p, 6))).collect();
    out += &wrap(&powers.join(", "), "  powers     ");
    out += "\n";
    out += &format!("  efficiency {}\n", percent(r.efficiency));
    if !r.at_rest.is_empty() {
        let mut open = format!(
            "unique up to friction at rest: {} is loaded without relative motion; shown is the case in which it loses nothing",
            r.at_rest.join(", ")
        );
        for range in &r.stiction {
            if let (Some(low), Some(high)) = (range.low, range.high) {
                open += &format!("; {} from {} to {}", range.what, significant(low, 6), significant(high, 6));
            }
        }
        out += &wrap(&open, "  friction   ");
        out += "\n";
    }
    if let Some(formula) = r.formula.as_ref().filter(|f| f.len() < 400) {
        out += &wrap(&format!("η = {formula}"), "             ");
        out += "\n";
    }
    out += "\n";
    let mut t = table();
    set_header(&mut t, &["one value changes", "now", "regime lasts", "what is there", "what changes behind it"]);
    for range in &r.ranges {
        let show_value = |x: f64| match range.quantity {
            Prescribes::Speed => format!("{} rpm", significant(rpm(x), 6)),
            _ => format!("{} N m", significant(x, 6)),
        };
        let edges: [(&str, &Option<Edge>); 2] = [("down to", &range.below), ("up to", &range.above)];
        for (k, (word, edge)) in edges.into_iter().enumerate() {
            let (label, now) = match k {
                0 => (format!("{} of {}", range.quantity.words(), range.member), show_value(range.value)),
                _ => Default::default(),
            };
            match edge {
                Some(e) => t.add_row([label, now, format!("{word} {}", show_value(e.at)), e.label.clone(), behind(e)]),
                None => t.add_row([label, now, format!("{word} any value"), String::new(), String::new()]),
            };
        }
    }
    out += &show(&t);
    out
}

fn behind(e: &Edge) -> String {
    let mut parts = e.changes.clone();
    match e.efficiency_after[..] {
        [after] if (after - e.efficiency_before).abs() < 1e-4 => {
            parts.push(format!("η {}", percent(e.efficiency_before)))
        }
        [] => {}
        _ => {
            let after: Vec<String> = e.efficiency_after.iter().map(|x| percent(*x)).collect();
            parts.push(format!("η {} jumps to {}", percent(e.efficiency_before), after.join(" or ")));
        }
    }
    parts.join("; ")
}
