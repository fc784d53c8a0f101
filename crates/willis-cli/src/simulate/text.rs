//! A run for eyes.

use willis::dynamics::{ModeLabel, Outcome};
use willis::figure::outcome_in_words;
use willis::hypergraph::watts;

use super::Run;
use crate::text::{bold, dim, percent, plural, right, rpm, set_header, show, significant, table, wrap};

/// Rows of the table of events.
pub const MOST_EVENTS: usize = 40;

pub fn text(run: &Run) -> String {
    let r = &run.report;
    let mut out = bold(&r.train) + "\n";
    let [start, reached, end] = [r.start_s, r.end_s, run.scenario_end_s].map(seconds);
    out += &format!("{}   {start} to {end} s\n", bold(&format!("Scenario: {}", r.scenario)));
    let words = match &r.outcome {
        Outcome::Finished => outcome_in_words(&r.outcome),
        other => format!("{}, at t = {reached} s of {end} s", outcome_in_words(other)),
    };
    out += &wrap(&format!("the run {words}"), "  outcome      ");
    out.push('\n');
    out += &format!(
        "  took         {}, {}\n",
        plural(r.steps, "step", "steps"),
        plural(r.events, "change of mode", "changes of mode")
    );
    out += &wrap(&r.coordinates.join(", "), "  coordinates  ");
    out.push('\n');
    let proved = match r.unique_for_every_load {
        true => "proved: in every rolling state the tooth forces have exactly one solution",
        false => "not proved unique for every load; each state was checked on its way",
    };
    out += &format!("  tooth forces {proved}\n");
    out += &events(run);
    out += &speeds(run);
    out += &energy(run);
    for (head, lines) in [("Assumptions in force", &r.assumptions), ("Notes", &r.notes)] {
        if lines.is_empty() {
            continue;
        }
        out += &format!("\n{}\n", bold(head));
        for line in lines {
            out += &wrap(line, "  · ");
            out.push('\n');
        }
    }
    out + "\n"
}

/// A time with the digits that a table can show.
fn seconds(t: f64) -> String {
    significant(t, 7)
}

fn events(run: &Run) -> String {
    if run.events.is_empty() {
        return String::new();
    }
    let mut out = format!("\n{}\n", bold("Changes of mode"));
    let mut t = table();
    set_header(&mut t, &["t s", "cause", "modes after it"]);
    for e in run.events.iter().take(MOST_EVENTS) {
        let modes: Vec<String> = e.modes.iter().map(|(name, m)| format!("{name} {}", mode(*m))).collect();
        t.add_row([seconds(e.time_s), clean(&e.cause), several(&modes)]);
    }
    right(&mut t, 0..1);
    out += &show(&t);
    let rest = run.report.events.max(run.events.len()).saturating_sub(MOST_EVENTS);
    if rest > 0 {
        out += &dim(&format!("  … and {rest} more, all in --format json"));
        out.push('\n');
    }
    out
}

fn several(modes: &[String]) -> String {
    match modes.len() {
        0..=4 => modes.join(", "),
        n => format!("{}, … {} more", modes[..3].join(", "), n - 3),
    }
}

/// Without control characters, which a terminal would obey.
fn clean(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

fn mode(m: ModeLabel) -> &'static str {
    match m {
        ModeLabel::Forward => "forward",
        ModeLabel::Backward => "backward",
        ModeLabel::Stuck => "stuck",
        ModeLabel::Free => "free",
    }
}

fn speeds(run: &Run) -> String {
    if run.report.final_speeds_rad_s.is_empty() {
        return String::new();
    }
    let at = seconds(run.report.end_s);
    let mut t = table();
    set_header(&mut t, &["member", "rpm", "rad/s"]);
    for (name, w) in &run.report.final_speeds_rad_s {
        // Round-off is not a speed.
        let w = if w.abs() < 1e-9 { 0.0 } else { *w };
        t.add_row([name.clone(), significant(rpm(w), 6), significant(w, 6)]);
    }
    right(&mut t, 1..3);
    format!("\n{}\n{}", bold(&format!("Speeds at t = {at} s")), show(&t))
}

/// Energy in a unit that reads well.
fn joules(e: f64) -> String {
    watts(e).replace('W', "J")
}

fn energy(run: &Run) -> String {
    let e = &run.report.energy;
    let mut out = format!("\n{}\n", bold("Where the energy went"));
    let mut rows: Vec<(f64, [String; 4])> = Vec::new();
    let flow = |x: f64| if x == 0.0 { "-".to_owned() } else { joules(x) };
    for s in &e.sources {
        let name = if s.name == s.member { s.name.clone() } else { format!("{} at {}", s.name, s.member) };
        rows.push((s.in_j.abs().max(s.out_j.abs()), [name, "source".into(), flow(s.in_j), flow(s.out_j.abs())]));
    }
    let (more, less) = (e.stored_j.max(0.0), (-e.stored_j).max(0.0));
    rows.push((e.stored_j.abs(), ["stored in motion and twist".into(), "stored".into(), flow(less), flow(more)]));
    for l in &e.losses {
        let kind = if l.kind == "shift-element" { "shift element" } else { l.kind };
        rows.push((l.energy_j.abs(), [l.name.clone(), format!("loss, {kind}"), String::new(), flow(l.energy_j)]));
    }
    rows.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut t = table();
    set_header(&mut t, &["", "is", "in", "out"]);
    for (_, row) in rows {
        t.add_row(row);
    }
    right(&mut t, 2..4);
    out += &show(&t);
    let closes = match e.turned_over_j > 0.0 {
        true => format!(
            "closes to {:.1e} of the {} turned over",
            e.residual_j.abs() / e.turned_over_j,
            joules(e.turned_over_j)
        ),
        false => format!("residual {:.1e} J", e.residual_j),
    };
    out += &format!("  balance      {closes}\n");
    let efficiency =
        e.efficiency.map_or("none: it takes energy that enters and leaves, with none left stored".into(), percent);
    out += &format!("  efficiency   {efficiency}\n");
    out
}
