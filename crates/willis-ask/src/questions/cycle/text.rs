//! What a duty cycle or a load spectrum costs, for eyes.

use willis::study::{Basis, CycleReport, Energies, PointVerdict, RepeatedMessage, WorstRow};

use crate::style::{assumptions, bar, bold, dim, percent, plural, right, set_header, show, significant, table, wrap};

/// Units in which a report is easy to read.
struct Scale {
    time: (&'static str, f64),
    energy: (&'static str, f64),
}

impl Scale {
    fn of(r: &CycleReport) -> Self {
        let hours = r.time_s > 7200.0 || r.basis == Basis::Shares;
        let time = match r.time_s {
            _ if hours => ("h", 3600.0),
            t if t > 600.0 => ("min", 60.0),
            _ => ("s", 1.0),
        };
        let most = r.energy_in_j.max(r.energy_lost_j);
        let steps: &[(&str, f64)] = match hours {
            true => &[("GWh", 3.6e12), ("MWh", 3.6e9), ("kWh", 3.6e6), ("Wh", 3600.0)],
            false => &[("GJ", 1e9), ("MJ", 1e6), ("kJ", 1e3), ("J", 1.0)],
        };
        let energy = steps.iter().find(|s| most >= 5.0 * s.1).unwrap_or(&steps[3]);
        Self { time, energy: *energy }
    }

    fn time(&self, s: f64) -> String {
        significant(s / self.time.1, 4)
    }

    fn energy(&self, j: f64) -> String {
        if j == 0.0 { "-".into() } else { significant(j / self.energy.1, 5) }
    }
}

/// The report for eyes.
pub fn text(r: &CycleReport, profile: &str) -> String {
    let scale = Scale::of(r);
    let (hour, joule) = (scale.time.0, scale.energy.0);
    let mut out = format!("{} over {profile}\n", bold(&r.train));
    let mut facts = vec![plural(r.rows as usize, "row", "rows")];
    if r.conditions != r.rows {
        facts.push(format!("{} different", r.conditions));
    }
    facts.push(format!("{} {hour}", scale.time(r.time_s)));
    facts.push(r.rule.clone());
    out += &(wrap(&facts.join(" · "), "") + "\n");
    if let (Some(operation), false) = (&r.operation, r.held.is_empty()) {
        out += &(wrap(&format!("held from operation `{operation}`: {}", r.held.join(", ")), "") + "\n");
    } else if !r.held.is_empty() {
        out += &(wrap(&format!("held: {}", r.held.join(", ")), "") + "\n");
    }
    for note in &r.notes {
        out += &(wrap(note, "  ! ") + "\n");
    }
    if let Some(oil) = &r.oil {
        let celsius = |k: Option<f64>| k.map_or("-".to_owned(), |k| format!("{:.1}", k - 273.15));
        let text = match &oil.why_not {
            None => format!(
                "{} °C on average when the cycle repeats itself ({} to {} °C; limit {} °C), at which every row is computed",
                celsius(oil.mean_k),
                celsius(oil.lowest_k),
                celsius(oil.highest_k),
                celsius(Some(oil.limit_k))
            ),
            Some(why) => format!("each row at its own steady temperature, because {why}"),
        };
        out += &(wrap(&text, "oil: ") + "\n");
    }
    out.push('\n');
    let or_none = |e: Option<f64>| e.map_or("-".into(), percent);
    match r.efficiency {
        Some(e) => {
            let time = r.time_mean_efficiency.map_or(String::new(), |m| format!("; mean over time {}", percent(m)));
            out += &format!("  efficiency   {}, energy out over energy in{time}\n", bold(&percent(e)));
        }
        None => out += "  efficiency   none: no energy goes in\n",
    }
    out += &format!(
        "  energy       in {} {joule}, out {} {joule}, lost {} {joule}; every row's balance closes to {:.1e} W\n",
        scale.energy(r.energy_in_j),
        scale.energy(r.energy_out_j),
        scale.energy(r.energy_lost_j),
        r.power_residual_w
    );
    if let Some(w) = r.mean_loss_w {
        out += &format!("  mean loss    {} W\n", significant(w, 5));
    }
    if r.coverage < 1.0 {
        out += &format!(
            "  {}\n",
            bold(&format!("coverage     {} of the time has an answer; energies are those of it", percent(r.coverage)))
        );
    }

    let parts = |head: &str, all: &willis::analysis::NameMap<Energies>| {
        let mut t = table();
        let (time, energy) = (format!("time {hour}"), ["in", "out", "lost"].map(|w| format!("{w} {joule}")));
        set_header(&mut t, &[head, "rows", &time, "of the time", &energy[0], &energy[1], &energy[2], "lost", "η"]);
        for (name, e) in all.iter() {
            let lost = if r.energy_lost_j > 0.0 { percent(e.energy_lost_j / r.energy_lost_j) } else { "-".into() };
            t.add_row([
                name.clone(),
                e.rows.to_string(),
                scale.time(e.time_s),
                percent(e.time_s / r.time_s),
                scale.energy(e.energy_in_j),
                scale.energy(e.energy_out_j),
                scale.energy(e.energy_lost_j),
                lost,
                or_none(e.efficiency),
            ]);
        }
        right(&mut t, 1..9);
        format!("\n{}", show(&t))
    };
    if !r.ways.is_empty() {
        out += &parts("direction", &r.ways);
    }
    if r.states.iter().count() > 1 {
        out += &parts("state", &r.states);
    }
    if !r.terminals.is_empty() {
        let mut t = table();
        set_header(&mut t, &["at", &format!("into the train {joule}"), &format!("out of it {joule}")]);
        for (name, e) in r.terminals.iter() {
            t.add_row([name.clone(), scale.energy(e.energy_in_j), scale.energy(e.energy_out_j)]);
        }
        right(&mut t, 1..3);
        out += &format!("\n{}", show(&t));
    }
    let lossy: Vec<_> = r.sources.iter().filter(|s| s.energy_j > 0.0).collect();
    if let Some(first) = lossy.first() {
        let mut t = table();
        set_header(&mut t, &["lost in", "kind", "law", joule, "share", ""]);
        for s in &lossy {
            t.add_row([
                s.name.clone(),
                s.kind.name().to_owned(),
                s.law.clone(),
                significant(s.energy_j / scale.energy.1, 4),
                percent(s.share),
                bar(s.energy_j / first.energy_j),
            ]);
        }
        right(&mut t, 3..5);
        out += &format!("\n{}", show(&t));
    }
    out += &verdicts(r, &scale);
    for (title, all) in
        [("by loss", &r.worst.loss), ("by efficiency", &r.worst.efficiency), ("by energy lost", &r.worst.energy)]
    {
        out += &worst(title, all, &scale);
    }
    for (k, (code, all)) in r.warnings.iter().enumerate() {
        out += if k == 0 { "\n" } else { "" };
        for w in all {
            let head = format!("  {code} ");
            let text = format!("line {}{}: {}", w.line, more(w), w.message);
            out += &(dim(&wrap(&text, &head)) + "\n");
        }
    }
    out + "\n" + &assumptions(&r.assumptions)
}

fn more(s: &RepeatedMessage) -> String {
    if s.rows > 1 { format!(" and {}", plural(s.rows as usize - 1, "other row", "other rows")) } else { String::new() }
}

fn verdicts(r: &CycleReport, scale: &Scale) -> String {
    let mut t = table();
    set_header(&mut t, &["verdict", "rows", &format!("time {}", scale.time.0), "of the time"]);
    let mut reasons = String::new();
    for (name, v) in r.verdicts.iter() {
        let word = if name == PointVerdict::Multiple.name() { "several solutions" } else { name };
        t.add_row([word.to_owned(), v.rows.to_string(), scale.time(v.time_s), percent(v.share_of_time)]);
        for s in &v.reasons {
            reasons += &(wrap(&format!("line {}{}: {}", s.line, more(s), s.message), &format!("  {word}  ")) + "\n");
        }
    }
    right(&mut t, 1..4);
    format!("\n{}{reasons}", show(&t))
}

fn worst(title: &str, all: &[WorstRow], scale: &Scale) -> String {
    if all.is_empty() {
        return String::new();
    }
    let mut t = table();
    let lost = format!("lost {}", scale.energy.0);
    set_header(&mut t, &[&format!("worst {title}"), "line", "rows", "loss W", "η", &lost, "direction"]);
    for w in all {
        t.add_row([
            w.condition.clone(),
            w.line.to_string(),
            w.rows.to_string(),
            significant(w.loss_w, 5),
            w.efficiency.map_or("-".into(), percent),
            significant(w.energy_lost_j / scale.energy.1, 4),
            w.way.map_or("", |way| way.name()).to_owned(),
        ]);
    }
    right(&mut t, 1..6);
    format!("\n{}", show(&t))
}
