//! Losses, laws and catalogues for eyes and for tables.

use willis::analysis::{LossPoint, LossTable, Named, SolutionReport, Verdict};
use willis::catalogue::{bearing, oil};
use willis::losses::{Entry, Trust};
use willis::operating_point::{BearingReport, ContactReport, Regime};

use crate::csv::Writer;
use crate::text::{bold, dim, percent, right, rpm, set_header, show, significant, table, wrap};

/// Width of the longest bar.
const BAR: usize = 28;

/// The losses of a solution: where every watt goes, tooth contacts, bearings.
pub fn of_solution(s: &SolutionReport) -> String {
    let mut out = String::new();
    if !s.sources.is_empty() {
        let mut t = table();
        set_header(&mut t, &["loss", "kind", "law", "W", "share", ""]);
        let most = s.sources.iter().fold(0.0f64, |a, x| a.max(x.loss_w));
        // What is idle loses nothing and is not worth a line.
        for x in s.sources.iter().filter(|x| x.loss_w > 0.0 || most == 0.0) {
            t.add_row([
                x.name.clone(),
                x.kind.words().into(),
                x.law.clone(),
                significant(x.loss_w, 4),
                percent(x.share),
                bar(if most > 0.0 { x.loss_w / most } else { 0.0 }),
            ]);
        }
        right(&mut t, 3..5);
        out += &show(&t);
        if let Some(c) = &s.convergence {
            let text = match c.converged {
                true if c.rounds < 3 => format!(
                    "losses and torques agree within 10⁻⁹ of the loss: {}",
                    crate::text::plural(c.rounds, "round", "rounds")
                ),
                true => format!(
                    "losses and torques agree within 10⁻⁹ of the loss: {}, each error {} of the last",
                    crate::text::plural(c.rounds, "round", "rounds"),
                    significant(c.contraction, 2)
                ),
                false => format!("NOT CONVERGED after {} rounds: left {:.1e} of the loss", c.rounds, c.error),
            };
            out += &dim(&format!("  {text}"));
            out.push('\n');
        }
    }
    out + &contacts(&s.contacts) + &bearings(&s.bearings)
}

/// A bar of that part of the full length.
pub fn bar(part: f64) -> String {
    let eighths = (part * (BAR * 8) as f64).round() as usize;
    let rest = [' ', '▏', '▎', '▍', '▌', '▋', '▊', '▉'][eighths % 8];
    let mut text = "█".repeat(eighths / 8);
    if rest != ' ' {
        text.push(rest);
    }
    text
}

fn contacts(all: &Named<ContactReport>) -> String {
    if all.is_empty() {
        return String::new();
    }
    let mut t = table();
    set_header(
        &mut t,
        &["tooth contact", "µ", "H_V", "ε_α", "ε_β", "F_t N", "v_t m/s", "v_slide m/s", "p_H MPa", "h µm", "λ", "film"],
    );
    for (name, c) in all.iter() {
        let or_dash = |x: Option<f64>, digits| x.map_or("-".into(), |x| significant(x, digits));
        t.add_row([
            name.clone(),
            or_dash(c.friction, 3),
            significant(c.loss_factor, 4),
            significant(c.contact_ratio, 4),
            significant(c.overlap_ratio, 3),
            significant(c.tangential_force_n, 4),
            significant(c.pitch_line_speed_m_s, 4),
            significant(c.sliding_speed_m_s, 3),
            significant(c.pressure_pa / 1e6, 4),
            or_dash(c.film_m.map(|h| h * 1e6), 3),
            or_dash(c.film_ratio, 3),
            c.regime.map_or("-", Regime::words).into(),
        ]);
    }
    right(&mut t, 1..11);
    show(&t)
}

fn bearings(all: &Named<BearingReport>) -> String {
    if all.is_empty() {
        return String::new();
    }
    let mut t = table();
    set_header(
        &mut t,
        &["bearing", "designation", "joins", "number", "rel. speed rpm", "F_r N", "F_a N", "M N mm each", "loss W"],
    );
    for (name, b) in all.iter() {
        t.add_row([
            name.clone(),
            b.designation.clone(),
            format!("{} - {}", b.members[0], b.members[1]),
            b.bearings.to_string(),
            significant(rpm(b.speed_rad_s), 5),
            significant(b.radial_load_n, 4),
            significant(b.axial_load_n, 4),
            significant(b.torque_n_m * 1e3, 4),
            significant(b.loss_w, 4),
        ]);
    }
    right(&mut t, 3..9);
    show(&t)
}

/// A table of losses at several points.
pub fn points(all: &LossTable) -> String {
    let mut out = bold(&all.train) + "\n";
    let mut at = 0;
    let mut spreads = all.spreads.iter();
    while at < all.points.len() {
        let first = &all.points[at];
        let mut to = at + 1;
        while to < all.points.len() && all.points[to].operation == first.operation {
            to += 1;
        }
        let group = &all.points[at..to];
        out += &format!("\n{}\n", bold(&format!("Operation: {}", first.operation)));
        out += &group_table(all, group);
        if let Some(family) = &all.family {
            // As many spreads as there are runs through the laws.
            let runs = group.iter().filter(|p| p.law == group[0].law).count();
            for s in spreads.by_ref().take(runs) {
                if s.most_w.0 == s.least_w.0 {
                    let text = format!(
                        "no loss here depends on {family}: what it is about is not given, or given as a number"
                    );
                    out += &wrap(&text, "  ");
                    out.push('\n');
                    continue;
                }
                let text = format!(
                    "spread of {family}: from {} W ({}) to {} W ({}), a factor of {}; {} of {} laws inside their range",
                    significant(s.least_w.0, 4),
                    s.least_w.1,
                    significant(s.most_w.0, 4),
                    s.most_w.1,
                    significant(s.most_w.0 / s.least_w.0, 3),
                    s.inside,
                    s.laws
                );
                out += &wrap(&text, "  ");
                out.push('\n');
            }
        }
        out += &notes(group);
        at = to;
    }
    out
}

fn group_table(all: &LossTable, group: &[LossPoint]) -> String {
    let mut t = table();
    let oil = group.iter().any(|p| p.temperature_k.is_some());
    let speed = format!("{} rpm", group[0].speed_of.as_deref().unwrap_or("speed"));
    let torque = format!("{} N m", group[0].torque_of.as_deref().unwrap_or("torque"));
    let mut header = vec![speed.as_str()];
    if group[0].torque_of.is_some() {
        header.push(&torque);
    }
    if oil {
        header.push("oil °C");
    }
    if all.family.is_some() {
        header.insert(0, "law");
        if all.family.as_deref() == Some("mesh_friction") {
            header.push("µ");
        }
    }
    header.extend(["mesh W", "bearing W", "windage W", "churning W", "seal W", "loss W", "η", "verdict"]);
    set_header(&mut t, &header);
    for p in group {
        let mut row = vec![significant(rpm(p.speed_rad_s), 6)];
        if group[0].torque_of.is_some() {
            row.push(p.torque_n_m.map_or("-".into(), |t| significant(t, 5)));
        }
        if oil {
            row.push(p.temperature_k.map_or("-".into(), |t| significant(t - 273.15, 4)));
        }
        if all.family.is_some() {
            row.insert(0, p.law.as_deref().unwrap_or("-").into());
            if all.family.as_deref() == Some("mesh_friction") {
                let mu = p.friction.iter().filter_map(|f| f.1).collect::<Vec<_>>();
                let (low, high) = mu.iter().fold((f64::INFINITY, 0.0f64), |(low, high), m| (low.min(*m), high.max(*m)));
                row.push(match mu.len() {
                    0 => "-".into(),
                    1 => significant(low, 3),
                    _ => format!("{}..{}", significant(low, 2), significant(high, 2)),
                });
            }
        }
        let l = &p.losses_w;
        for x in [l.mesh, l.bearing, l.windage, l.churning, l.seal] {
            row.push(if x == 0.0 { "-".into() } else { significant(x, 4) });
        }
        row.push(significant(p.loss_w, 5));
        row.push(p.efficiency.map_or("-".into(), percent));
        row.push(verdict(p));
        t.add_row(row);
    }
    right(&mut t, usize::from(all.family.is_some())..header.len() - 1);
    show(&t)
}

fn verdict(p: &LossPoint) -> String {
    let word = match p.verdict {
        Verdict::Unique => "unique",
        Verdict::Multiple => "several solutions",
        Verdict::Locked => "locked",
        Verdict::Unloaded => "unloaded",
        _ => "undetermined",
    };
    if p.warnings.is_empty() { word.into() } else { format!("{word} *") }
}

/// Warnings under a table, each once; of a law outside its range, the first of a kind: numbers differ from point to
/// point, what is outside does not.
fn notes(group: &[LossPoint]) -> String {
    let mut told: Vec<&str> = Vec::new();
    let mut laws: Vec<(&str, &str, Option<f64>, Option<f64>)> = Vec::new();
    let mut out = String::new();
    for p in group {
        let mut outside = p.outside_laws.iter().map(|o| (o.to_string(), o)).collect::<Vec<_>>();
        for w in &p.warnings {
            let new = match outside.iter().position(|(text, _)| text == w) {
                Some(k) => {
                    let o = outside.remove(k).1;
                    let kind = (o.law.as_str(), o.symbol.as_str(), o.low, o.high);
                    !laws.contains(&kind) && {
                        laws.push(kind);
                        true
                    }
                }
                None => !told.contains(&w.as_str()),
            };
            if new {
                told.push(w);
                out += &dim(&wrap(w, "  * "));
                out.push('\n');
            }
        }
    }
    out
}

/// The same as CSV, one row a point.
pub fn points_csv(all: &LossTable) -> String {
    let mut out = Writer::default();
    out.row([
        "operation",
        "law",
        "speed_of",
        "speed_rad_s",
        "torque_of",
        "torque_n_m",
        "temperature_k",
        "verdict",
        "efficiency",
        "input_power_w",
        "loss_w",
        "mesh_loss_w",
        "bearing_loss_w",
        "windage_loss_w",
        "churning_loss_w",
        "seal_loss_w",
        "converged",
        "warnings",
    ]);
    let number = |x: Option<f64>| x.map_or(String::new(), |x| x.to_string());
    for p in &all.points {
        let l = &p.losses_w;
        out.row([
            p.operation.as_str(),
            p.law.as_deref().unwrap_or_default(),
            p.speed_of.as_deref().unwrap_or_default(),
            &p.speed_rad_s.to_string(),
            p.torque_of.as_deref().unwrap_or_default(),
            &number(p.torque_n_m),
            &number(p.temperature_k),
            crate::csv::verdict(p.verdict),
            &number(p.efficiency),
            &p.input_power_w.to_string(),
            &p.loss_w.to_string(),
            &l.mesh.to_string(),
            &l.bearing.to_string(),
            &l.windage.to_string(),
            &l.churning.to_string(),
            &l.seal.to_string(),
            &p.convergence.is_none_or(|c| c.converged).to_string(),
            &p.warnings.join("; "),
        ]);
    }
    out.0
}

/// What a law's trust means in a word.
fn trust(t: Trust) -> String {
    match t {
        Trust::Seen => "seen".into(),
        Trust::Derived => "derived".into(),
        Trust::Confirm(what) => format!("confirm: {what}"),
    }
}

fn range(e: &Entry) -> String {
    let all: Vec<String> = e
        .valid
        .iter()
        .map(|(symbol, unit, low, high)| {
            let value = |x: f64| significant(x, 3);
            let unit = if *unit == "-" { String::new() } else { format!(" {unit}") };
            match (*low > 0.0 && low.is_finite(), high.is_finite()) {
                (true, true) => format!("{} ≤ {symbol} ≤ {}{unit}", value(*low), value(*high)),
                (false, true) => format!("{symbol} ≤ {}{unit}", value(*high)),
                (true, false) => format!("{symbol} ≥ {}{unit}", value(*low)),
                (false, false) => format!("any {symbol}"),
            }
        })
        .collect();
    if all.is_empty() { "not limited".into() } else { all.join(", ") }
}

/// Every law, family by family.
pub fn laws(all: &[Entry]) -> String {
    let mut out = String::new();
    let mut family = "";
    for e in all {
        if e.family != family {
            if !family.is_empty() {
                out.push('\n');
            }
            family = e.family;
            let (symbol, unit) = e.gives;
            let unit = if unit == "-" { String::new() } else { format!(", {unit}") };
            out += &format!("{}   gives {symbol}{unit}\n", bold(family));
        }
        let mut marks = Vec::new();
        if e.default {
            marks.push("default".to_owned());
        }
        for t in e.tags {
            marks.push(t.words().to_owned());
        }
        let marks = if marks.is_empty() { String::new() } else { format!(" ({})", marks.join("; ")) };
        out += &format!("  {}{marks}\n", bold(e.id));
        for line in [
            e.title.to_owned(),
            format!("range: {}", range(e)),
            format!("source: [{}] {}; {}", e.source.0, e.source.1, trust(e.trust)),
        ] {
            out += &wrap(&line, "      ");
            out.push('\n');
        }
    }
    out
}

/// Every law as CSV.
pub fn laws_csv(all: &[Entry]) -> String {
    let mut out = Writer::default();
    out.row(["family", "law", "default", "title", "gives", "unit", "source", "place", "trust", "range"]);
    for e in all {
        out.row([
            e.family,
            e.id,
            &e.default.to_string(),
            e.title,
            e.gives.0,
            e.gives.1,
            e.source.0,
            e.source.1,
            &trust(e.trust),
            &range(e),
        ]);
    }
    out.0
}

/// The catalogue of oils.
pub fn oils() -> String {
    let mut t = table();
    set_header(&mut t, &["oil", "base", "ν 40 °C", "ν 100 °C", "ρ 15 °C", "trust"]);
    for o in oil::all() {
        let fixed = matches!(o.viscosity, oil::Viscosity::Fixed { .. });
        let nu = |t: f64| match o.covers(t) && !fixed {
            true => significant(o.kinematic_viscosity(t) * 1e6, 4),
            false => "-".into(),
        };
        t.add_row([
            o.name.clone(),
            format!("{:?}", o.base).to_lowercase(),
            nu(313.15),
            nu(373.15),
            significant(o.density_15, 4),
            trust_word(&format!("{:?}", o.trust)),
        ]);
    }
    right(&mut t, 2..5);
    show(&t) + &dim("  ν in mm²/s, ρ in kg/m³\n")
}

/// The catalogue of bearings.
pub fn bearings_catalogue() -> String {
    let mut t = table();
    set_header(&mut t, &["bearing", "kind", "d mm", "D mm", "B mm", "C0 kN", "SKF constants", "trust"]);
    for b in bearing::all() {
        t.add_row([
            b.designation.clone(),
            b.kind.to_string(),
            significant(b.bore * 1e3, 4),
            significant(b.outside_diameter * 1e3, 4),
            significant(b.width * 1e3, 4),
            b.static_rating.map_or("-".into(), |c| significant(c / 1e3, 4)),
            if b.skf.is_some() { "yes" } else { "no" }.into(),
            trust_word(&format!("{:?}", b.trust)),
        ]);
    }
    right(&mut t, 2..6);
    show(&t)
}

fn trust_word(debug: &str) -> String {
    debug.split(['(', ' ']).next().unwrap_or_default().to_lowercase()
}
