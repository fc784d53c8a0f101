//! Regimes for eyes.

use comfy_table::CellAlignment;
use willis::regimes::{Atlas, Family, Reach, RegimeReport, Regimes};

use crate::style::{bold, dim, percent, plural, set_header, show, significant, table, wrap};

pub fn text(all: &Regimes) -> String {
    let mut out = bold(&all.train) + "\n";
    let (simple, other): (Vec<&Atlas>, Vec<&Atlas>) =
        all.states.iter().partition(|a| a.reason.is_none() && a.base_speeds.len() == 1 && a.independent_torques == 1);
    for a in &other {
        out += "\n";
        out += &atlas(a);
    }
    if !simple.is_empty() {
        out += "\n";
        out += &one_freedom(&simple);
    }
    out
}

/// Where the efficiencies of meshes come from that laws compute: a line for all states of which the same is said.
fn efficiency_bases(all: &[&Atlas]) -> String {
    let mut told: Vec<(String, Vec<&str>)> = Vec::new();
    for a in all {
        let Some(words) = a.efficiency_basis.as_ref().map(ToString::to_string) else { continue };
        match told.iter_mut().find(|(own, _)| *own == words) {
            Some((_, states)) => states.push(&a.state),
            None => told.push((words, vec![&a.state])),
        }
    }
    told.into_iter().map(|(words, states)| wrap(&format!("{}: {words}", states.join(", ")), "  ") + "\n").collect()
}

/// States with one degree of freedom: a line for each way the power can go.
fn one_freedom(all: &[&Atlas]) -> String {
    let mut out = bold("One degree of freedom") + "\n";
    let mut t = table();
    set_header(&mut t, &["state", "inputs → outputs", "drives", "η", "closed formula"]);
    for a in all {
        let mut first = true;
        // Speeds and torques reversed are the same regime.
        for r in a.regimes.iter().filter(|r| r.region == 1) {
            let formula = a.formulas.iter().find(|f| f.id == r.formula);
            t.add_row([
                if first { a.state.clone() } else { String::new() },
                flow(r),
                driving(a, r),
                efficiency(r),
                formula.map_or(String::new(), |f| f.efficiency.clone()),
            ]);
            first = false;
        }
    }
    t.column_mut(3).expect("five columns").set_cell_alignment(CellAlignment::Right);
    out += &show(&t);
    let mut told: Vec<String> = Vec::new();
    for a in all {
        for assignment in a.assignments.iter().filter(|x| x.regimes.is_empty() && !x.outputs.is_empty()) {
            out += &wrap(
                &format!(
                    "{}: {} → {}: {}",
                    a.state,
                    assignment.inputs.join(", "),
                    assignment.outputs.join(", "),
                    assignment.reach
                ),
                "  ",
            );
            out += "\n";
        }
        for note in a.notes_beside_losses() {
            out += &wrap(&format!("{}: {note}", a.state), "  ");
            out += "\n";
        }
    }
    out += &efficiency_bases(all);
    out += &dim("the same with all speeds and torques reversed; `willis formula` gives conditions, ratios and code");
    out += "\n\n";
    out += &bold("Symbols");
    out += "\n";
    for a in all {
        for (name, s) in a.symbols.iter() {
            let (Some(value), false) = (s.value, told.contains(name)) else { continue };
            told.push(name.clone());
            let exact = s.exact.as_ref().map(ToString::to_string).unwrap_or_default();
            let value = significant(value, 6);
            let value = if exact == value { value } else { format!("{value} = {exact}") };
            out += &wrap(&format!("{name} = {value}   {}", s.meaning), "  ");
            out += "\n";
        }
    }
    out
}

fn flow(r: &RegimeReport) -> String {
    match r.outputs.is_empty() {
        true => format!("{} → heat", r.inputs.join(", ")),
        false => format!("{} → {}", r.inputs.join(", "), r.outputs.join(", ")),
    }
}

fn driving(a: &Atlas, r: &RegimeReport) -> String {
    let one = r.drivers.0.len() == 1;
    let all =
        r.drivers.iter().filter_map(|(e, d)| d.as_ref().map(|d| if one { d.clone() } else { format!("{d} in {e}") }));
    let text = all.collect::<Vec<_>>().join(", ");
    let _ = a;
    if text.is_empty() { "-".into() } else { text }
}

fn efficiency(r: &RegimeReport) -> String {
    if r.all_dissipated {
        return "0 %".into();
    }
    match r.efficiency_range {
        Some([low, high]) if percent(low) == percent(high) => percent(low),
        Some([low, high]) => format!("{} … {}", percent(low).trim_end_matches(" %"), percent(high)),
        None => format!("e.g. {}", percent(r.example.efficiency)),
    }
}

fn sign(s: i8) -> &'static str {
    match s {
        1 => "+",
        -1 => "−",
        _ => "0",
    }
}

/// One state with two or more freedoms.
fn atlas(a: &Atlas) -> String {
    let mut out = bold(&a.state) + "\n";
    let mut facts = vec![plural(a.degrees_of_freedom, "degree of freedom", "degrees of freedom")];
    facts.push(format!("terminals {}", a.terminals.join(", ")));
    if !a.held.is_empty() {
        facts.push(format!("held {}", a.held.join(", ")));
    }
    out += &wrap(&facts.join(" · "), "  ");
    out += "\n";
    if let Some(why) = &a.reason {
        out += &wrap(why, "  ");
        return out + "\n";
    }
    let facts = [
        plural(a.regions.len(), "region of speed", "regions of speed"),
        plural(a.independent_torques, "independent torque", "independent torques"),
        plural(a.regimes.len(), "regime", "regimes"),
        plural(a.formulas.len(), "formula", "formulas"),
    ];
    out += &format!("  {}\n\n", facts.join(" · "));

    // Every regime once: its mirror image has all speeds and torques reversed.
    let mut rows: Vec<&RegimeReport> = Vec::new();
    for r in &a.regimes {
        if !rows.iter().any(|other| other.id == r.mirror) {
            rows.push(r);
        }
    }
    let marks = rows.iter().any(|r| r.by_friction_only || r.all_dissipated);
    let mut t = table();
    let torque = format!("torques {}", a.terminals.join(", "));
    let mut header = vec!["regime", "mirror", "speeds", &torque, "inputs → outputs", "drives", "η", "formula"];
    if marks {
        header.push("");
    }
    set_header(&mut t, &header);
    for r in &rows {
        let region = &a.regions[r.region - 1];
        let mut row = vec![
            r.id.clone(),
            r.mirror.clone(),
            region.order.join("; "),
            r.torque_signs.iter().map(|(_, s)| sign(*s)).collect::<Vec<_>>().join(" "),
            flow(r),
            driving(a, r),
            efficiency(r),
            r.formula.clone(),
        ];
        if marks {
            row.push(match (r.all_dissipated, r.by_friction_only) {
                (true, _) => "no output".into(),
                (false, true) => "by friction only".into(),
                _ => String::new(),
            });
        }
        t.add_row(row);
    }
    t.column_mut(6).expect("eight columns").set_cell_alignment(CellAlignment::Right);
    out += &show(&t);
    out += &dim("mirror: all speeds and torques reversed. drives: the end that drives, seen from the carrier");
    out += "\n";

    let odd: Vec<String> = a
        .regions
        .iter()
        .flat_map(|region| {
            region.prescribed.iter().flat_map(move |p| {
                [("positive", &p.positive), ("negative", &p.negative)].into_iter().filter_map(move |(word, ids)| {
                    match ids.len() {
                        1 => None,
                        0 => Some(format!(
                            "region {}: a {word} torque prescribed on {} has no equilibrium",
                            region.number, p.terminal
                        )),
                        _ => Some(format!(
                            "region {}: a {word} torque prescribed on {} has several equilibria: {}",
                            region.number,
                            p.terminal,
                            ids.join(", ")
                        )),
                    }
                })
            })
        })
        .collect();
    if !odd.is_empty() {
        out += "\n";
        out += &bold("Not unique");
        out += "\n";
        for line in odd {
            out += &wrap(&line, "  ");
            out += "\n";
        }
    }

    if !a.formulas.is_empty() {
        out += "\n";
        out += &bold("Closed formulas");
        out += "\n";
    }
    for f in &a.formulas {
        out += &wrap(
            &format!("{}, drives: {}   (regimes {})", f.roles, f.drivers, f.regimes.join(", ")),
            &format!("  {:<4} ", f.id),
        );
        out += "\n";
        let line = |label: &str, text: &str| wrap(text, &format!("       {label:<3} = ")) + "\n";
        let long = f.efficiency.len() > 400;
        if f.regimes.iter().all(|id| a.regimes.iter().any(|r| r.id == *id && r.all_dissipated)) {
            out += "       no output: all power turns into heat\n";
        } else if long && f.efficiency_by_loss.is_none() {
            out += "       η   in `willis formula`: too long for a line\n";
        } else {
            out += &line("η", f.efficiency_by_loss.as_ref().unwrap_or(&f.efficiency));
        }
        if f.loss.len() < 400 {
            out += &line("L", &f.loss);
        }
        let torques: Vec<String> = f
            .torques
            .iter()
            .filter(|(name, t)| *t != format!("T_{name}") && t.len() < 200)
            .map(|(name, t)| format!("T_{name} = {t}"))
            .collect();
        if !torques.is_empty() {
            out += &wrap(&torques.join("; "), "       ");
            out += "\n";
        }
        let bounds: Vec<String> = f
            .holds_for
            .iter()
            .map(|b| {
                let (low, high) = (b.low.map(|x| significant(x, 5)), b.high.map(|x| significant(x, 5)));
                match (low, high) {
                    (Some(l), Some(h)) => format!("{l} < {} < {h}", b.symbol),
                    (Some(l), None) => format!("{} > {l}", b.symbol),
                    (None, Some(h)) => format!("{} < {h}", b.symbol),
                    _ => String::new(),
                }
            })
            .collect();
        if !bounds.is_empty() {
            out += &wrap(&format!("torque signs hold for {}, each alone", bounds.join(", ")), "       ");
            out += "\n";
        }
    }

    if !a.boundaries.is_empty() {
        out += "\n";
        out += &bold("Boundaries");
        out += &dim("   half of them; the others are their mirror images");
        out += "\n";
        let half = a.boundaries.len().div_ceil(2);
        for b in a.boundaries.iter().take(half) {
            let speeds: Vec<String> = b.speeds.iter().map(|(n, w)| format!("{n} {}", significant(*w, 5))).collect();
            out += &wrap(
                &format!(
                    "{} | {}: {}   (speeds in proportion: {})",
                    b.between[0],
                    b.between[1],
                    b.label,
                    speeds.join(", ")
                ),
                "  ",
            );
            out += "\n";
            for c in &b.crossings {
                let eta = match (c.efficiency_before, c.efficiency_after) {
                    (Some(x), Some(y)) if (x - y).abs() < 1e-9 => format!("η = {}", percent(x)),
                    (Some(x), Some(y)) => format!("η jumps from {} to {}", percent(x), percent(y)),
                    _ => String::new(),
                };
                let changes = if c.changes.is_empty() { "nothing changes".into() } else { c.changes.join(", ") };
                out += &wrap(&format!("{} → {}: {eta}; {changes}", c.from, c.to), "      ");
                out += "\n";
            }
        }
    }

    let unreached: Vec<_> = a.assignments.iter().filter(|x| x.regimes.is_empty()).collect();
    if !unreached.is_empty() || a.assignments.iter().any(|x| x.reach != Reach::Reached) {
        out += "\n";
        out += &bold("Assignments of inputs and outputs");
        out += "\n";
        let mut t = table();
        set_header(&mut t, &["inputs → outputs", "regimes", ""]);
        for x in &a.assignments {
            let to = if x.outputs.is_empty() { "heat".to_owned() } else { x.outputs.join(", ") };
            t.add_row([format!("{} → {to}", x.inputs.join(", ")), x.regimes.join(", "), x.reach.to_string()]);
        }
        out += &show(&t);
    }

    if !a.symbols.is_empty() {
        out += "\n";
        out += &bold("Symbols");
        out += "\n";
        for (name, s) in a.symbols.iter().filter(|(_, s)| s.value.is_some()) {
            let exact = s.exact.as_ref().map(ToString::to_string).unwrap_or_default();
            let value = significant(s.value.unwrap_or_default(), 6);
            let value = if exact == value { value } else { format!("{value} = {exact}") };
            out += &wrap(&format!("{name} = {value}   {}", s.meaning), "  ");
            out += "\n";
        }
        out += "  T_x torque on x, w_x speed of x, L power lost\n";
    }
    let basis = a.efficiency_basis.as_ref().map(ToString::to_string);
    let notes: Vec<&String> = a.notes.iter().chain(&basis).collect();
    if !notes.is_empty() {
        out += "\n";
        for note in notes {
            out += &wrap(note, "  · ");
            out += "\n";
        }
    }
    out
}

/// A set over all basic ratios, for eyes.
pub fn family(f: &Family) -> String {
    let mut out = bold(&f.train) + "\n";
    out += &format!("  {} = {} = {}\n", f.ratio, f.exact, significant(f.value, 6));
    let etas = if f.efficiencies[0] == f.efficiencies[1] {
        format!("eta = {}", f.efficiencies[0])
    } else {
        format!(
            "eta_f = {} ({} drives), eta_b = {} ({} drives)",
            f.efficiencies[0], f.ends[0], f.efficiencies[1], f.ends[1]
        )
    };
    out += &format!("  {etas} seen from {}\n", f.carrier);
    if let Some(basis) = &f.efficiency_basis {
        out += &wrap(&basis.to_string(), "  ");
        out += "\n";
    }
    out += &format!(
        "  {} regimes in {} ranges of R; one line holds a regime and its mirror image\n",
        f.regimes,
        f.cases.len()
    );
    for (k, case) in f.cases.iter().enumerate() {
        out += "\n";
        out += &bold(&case.label);
        if case.here {
            out += "   this train";
        }
        if case.band {
            out += "   between 1 and a self-locking limit: not in Esmail's table";
        }
        out += "\n";
        let mut t = table();
        set_header(&mut t, &["inputs → outputs", "drives", "torques", "speeds", "loss l = η − 1"]);
        for row in &f.rows {
            let to = if row.outputs.is_empty() { "heat".to_owned() } else { row.outputs.join(",") };
            let mut label = format!("{} → {to}", row.inputs.join(","));
            for group in &row.cells[k] {
                let mut loss = group.loss.clone();
                let mut driver = group.driver.clone();
                let mut done: Vec<usize> = Vec::new();
                for (n, range) in group.ranges.iter().enumerate() {
                    if done.contains(&n) {
                        continue;
                    }
                    let mirror: Vec<String> = range.order.iter().rev().cloned().collect();
                    done.extend(group.ranges.iter().position(|r| r.order == mirror));
                    let speeds = |order: &[String]| {
                        order
                            .iter()
                            .map(|n| if n == "0" { n.clone() } else { format!("w{n}") })
                            .collect::<Vec<_>>()
                            .join(" > ")
                    };
                    let signs =
                        |flip: i8| range.torque_signs.iter().map(|(_, s)| sign(s * flip)).collect::<Vec<_>>().join(" ");
                    t.add_row([
                        std::mem::take(&mut label),
                        std::mem::take(&mut driver),
                        format!("{} or {}", signs(1), signs(-1)),
                        format!("{} or {}", speeds(&range.order), speeds(&mirror)),
                        std::mem::take(&mut loss),
                    ]);
                }
            }
        }
        out += &show(&t);
    }
    out
}
