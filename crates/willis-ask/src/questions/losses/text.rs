//! Losses for eyes and as a table.

use willis::analysis::{LossPoint, LossTable, Losses, NameMap, SolutionReport, Verdict};
use willis::operating_point::{BearingReport, ContactReport, LubricationRegime};

use crate::style::{
    assumptions, band_ends, bar, bold, dim, efficiency_cell, percent, plural, right, rpm, set_header, show,
    significant, table, wrap,
};
use crate::table::Kind::{Flag, Number, Text};
use crate::table::{Table, word};

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
                true if c.rounds < 3 => {
                    format!("losses and torques agree within 10⁻⁹ of the loss: {}", plural(c.rounds, "round", "rounds"))
                }
                true => format!(
                    "losses and torques agree within 10⁻⁹ of the loss: {}, each error {} of the last",
                    plural(c.rounds, "round", "rounds"),
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

fn contacts(all: &NameMap<ContactReport>) -> String {
    if all.is_empty() {
        return String::new();
    }
    let mut t = table();
    set_header(
        &mut t,
        &[
            "tooth contact",
            "µ",
            "H_V",
            "ε_α",
            "ε_β",
            "F_t N",
            "v_t m/s",
            "v_slide m/s",
            "p_H MPa",
            "h µm",
            "λ",
            "film",
            "backlash µm",
        ],
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
            c.regime.map_or("-", LubricationRegime::words).into(),
            if c.backlash_m == 0.0 { "0".into() } else { significant(c.backlash_m * 1e6, 3) },
        ]);
    }
    right(&mut t, 1..11);
    right(&mut t, 12..13);
    let mut out = show(&t);
    for (name, c) in all.iter() {
        if let (Some(loss), Some(eta)) = (c.lengthwise_loss_w, c.lengthwise_efficiency) {
            let text = format!(
                "{name}: hypoid teeth, {} of {} W by sliding along them (efficiency of that alone {})",
                significant(loss, 4),
                significant(c.sliding_loss_w, 4),
                significant(eta, 5)
            );
            out += &dim(&format!("  {text}"));
            out.push('\n');
        }
    }
    out
}

fn bearings(all: &NameMap<BearingReport>) -> String {
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
        for p in group {
            if let Some(band) = &p.band {
                out += &(wrap(&format!("η with other laws: {}", band_ends(band)), "  ") + "\n");
            }
        }
        out += &notes(group);
        at = to;
    }
    out + "\n" + &assumptions(&all.assumptions)
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
    // The first five have a column in any case.
    let shown: Vec<usize> =
        (0..Losses::NAMES.len()).filter(|k| *k < 5 || group.iter().any(|p| p.losses_w.all()[*k] != 0.0)).collect();
    let titles: Vec<String> = shown.iter().map(|k| format!("{} W", Losses::NAMES[*k].replace('-', " "))).collect();
    header.extend(titles.iter().map(String::as_str));
    header.extend(["loss W", "η", "verdict"]);
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
        let losses = p.losses_w.all();
        for x in shown.iter().map(|k| losses[*k]) {
            row.push(if x == 0.0 { "-".into() } else { significant(x, 4) });
        }
        row.push(significant(p.loss_w, 5));
        row.push(p.efficiency.map_or("-".into(), |e| efficiency_cell(e, p.band.as_deref())));
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

/// One row a point; SI.
pub fn table_of(all: &LossTable) -> Table {
    let mut t = Table::new(
        "points",
        [
            ("operation", Text),
            ("law", Text),
            ("speed_of", Text),
            ("speed_rad_s", Number),
            ("torque_of", Text),
            ("torque_n_m", Number),
            ("temperature_k", Number),
            ("verdict", Text),
            ("efficiency", Number),
            ("input_power_w", Number),
            ("loss_w", Number),
            ("mesh_loss_w", Number),
            ("bearing_loss_w", Number),
            ("windage_loss_w", Number),
            ("churning_loss_w", Number),
            ("seal_loss_w", Number),
            ("drag_loss_w", Number),
            ("shift_element_loss_w", Number),
            ("injection_loss_w", Number),
            ("pump_loss_w", Number),
            ("variator_loss_w", Number),
            ("converged", Flag),
            ("warnings", Text),
        ],
    );
    for p in &all.points {
        let l = &p.losses_w;
        let warnings: Vec<String> = p.warnings.iter().map(ToString::to_string).collect();
        t.row([
            (&p.operation).into(),
            p.law.as_ref().map(ToString::to_string).into(),
            p.speed_of.clone().into(),
            p.speed_rad_s.into(),
            p.torque_of.clone().into(),
            p.torque_n_m.into(),
            p.temperature_k.into(),
            word(&p.verdict).into(),
            p.efficiency.into(),
            p.input_power_w.into(),
            p.loss_w.into(),
            l.mesh.into(),
            l.bearing.into(),
            l.windage.into(),
            l.churning.into(),
            l.seal.into(),
            l.drag.into(),
            l.shift_element.into(),
            l.injection.into(),
            l.pump.into(),
            l.variator.into(),
            p.convergence.is_none_or(|c| c.converged).into(),
            warnings.join("; ").into(),
        ]);
    }
    t
}
