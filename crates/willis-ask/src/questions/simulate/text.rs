//! A run for eyes.

use willis::diagnostic::is_printable;
use willis::dynamics::{Event, ModeLabel, Outcome, RunReport};
use willis::hypergraph::watts;

use crate::style::{bold, dim, percent, plural, right, rpm, set_header, show, significant, table, wrap};

/// Rows of the table of events.
pub const MOST_EVENTS: usize = 40;
/// A part of the energy that is round-off.
const NOTHING: f64 = 1e-12;

pub fn text(r: &RunReport) -> String {
    let mut out = bold(&r.train) + "\n";
    let [start, reached, end] = [r.start_s, r.end_s, r.scenario_end_s].map(seconds);
    out += &format!("{}   {start} to {end} s\n", bold(&format!("Scenario: {}", r.scenario)));
    let words = r.outcome.words();
    let mut line = |name: &str, words: &str| {
        out += &wrap(words, &format!("  {name:<13}"));
        out.push('\n');
    };
    match r.outcome {
        Outcome::Finished => line("outcome", &format!("the run {words}")),
        _ => line("outcome", &format!("the run {words}, at t = {reached} s of {end} s")),
    }
    if !r.outcome.why().is_empty() {
        line("why", r.outcome.why());
    }
    if let Some(advice) = advice(&r.outcome) {
        line("what to do", advice);
    }
    // The start is an event too, but no change.
    let changes = r.event_count.saturating_sub(1);
    let took = [plural(r.steps, "step", "steps"), plural(changes, "change of mode", "changes of mode")];
    line("took", &took.join(", "));
    line("coordinates", &r.coordinates.join(", "));
    line(
        "tooth forces",
        match r.unique_for_every_load {
            true => "proved: in every rolling state the tooth forces have exactly one solution",
            false => "not proved unique for every load; see the notes",
        },
    );
    if let Some(start) = r.events.first().filter(|e| e.is_start() && !e.modes.is_empty()) {
        line("at the start", &modes(start, usize::MAX));
    }
    out += &events(r);
    out += &speeds(r);
    out += &energy(r);
    out += &heat(r);
    let beyond: Vec<String> = r.beyond_limits.iter().map(ToString::to_string).collect();
    for (head, lines) in [("Limits exceeded", &beyond), ("Assumptions in force", &r.assumptions), ("Notes", &r.notes)] {
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

/// What can be done where a run ends early.
fn advice(outcome: &Outcome) -> Option<&'static str> {
    Some(match outcome {
        Outcome::NoSolution(_) => "rigid parts cannot tell what follows; an elastic [[shaft]] in the jammed path can",
        Outcome::SeveralSolutions(_) => {
            "what decides between them is not in the model; `continue-when-ambiguous` goes on with the first"
        }
        Outcome::TooManyEvents(_) => {
            "allow more (`most-events`), or pass over them with steps of fixed length (`fixed-step`), at first order in the step"
        }
        Outcome::NotConverged(_) => "try a coarser `tolerance`, or `fixed-step`",
        Outcome::TooLong(_) => {
            "`yes` goes on, however long it takes; a coarser `tolerance` or slower signals take less"
        }
        Outcome::Impact(_) => "`fixed-step` goes on as after an inelastic impact",
        _ => return None,
    })
}

/// A time with the digits that a table can show.
fn seconds(t: f64) -> String {
    significant(t, 7)
}

fn events(run: &RunReport) -> String {
    let told: Vec<&Event> = run.events.iter().filter(|e| !e.is_start()).take(MOST_EVENTS - 1).collect();
    if told.is_empty() {
        return String::new();
    }
    let mut out = format!("\n{}\n", bold("Changes of mode"));
    let mut t = table();
    set_header(&mut t, &["t s", "what happens", "modes after it"]);
    for e in &told {
        t.add_row([seconds(e.time_s), clean(&e.cause), modes(e, 3)]);
    }
    right(&mut t, 0..1);
    out += &show(&t);
    let rest = run.event_count.saturating_sub(1 + told.len());
    if rest > 0 {
        out += &dim(&format!("  … and {rest} more, all in the JSON answer"));
        out.push('\n');
    }
    out
}

/// The elements in each mode, the first few of them.
fn modes(event: &Event, most: usize) -> String {
    let in_mode = |label: ModeLabel| {
        let names: Vec<&str> = event.modes.iter().filter(|(_, l)| *l == label).map(|(n, _)| n.as_str()).collect();
        match names.len() {
            0 => None,
            n if n > most => Some(format!("{} {}, … {} more", mode(label), names[..most - 1].join(", "), n + 1 - most)),
            _ => Some(format!("{} {}", mode(label), names.join(", "))),
        }
    };
    let all = [ModeLabel::Forward, ModeLabel::Backward, ModeLabel::Stuck, ModeLabel::Free];
    all.into_iter().filter_map(in_mode).collect::<Vec<_>>().join("; ")
}

/// Without control characters, which a terminal would obey.
fn clean(text: &str) -> String {
    text.chars().map(|c| if is_printable(c) { c } else { ' ' }).collect()
}

fn mode(m: ModeLabel) -> &'static str {
    match m {
        ModeLabel::Forward => "forward:",
        ModeLabel::Backward => "backward:",
        ModeLabel::Stuck => "stuck:",
        ModeLabel::Free => "free:",
    }
}

fn speeds(run: &RunReport) -> String {
    if run.final_speeds_rad_s.is_empty() {
        return String::new();
    }
    let at = seconds(run.end_s);
    let mut t = table();
    set_header(&mut t, &["member", "rpm", "rad/s"]);
    for (name, w) in &run.final_speeds_rad_s {
        // Round-off is not a speed.
        let w = if w.abs() < 1e-9 { 0.0 } else { *w };
        t.add_row([name.clone(), significant(rpm(w), 6), significant(w, 6)]);
    }
    right(&mut t, 1..3);
    format!("\n{}\n{}", bold(&format!("Speeds at t = {at} s")), show(&t))
}

/// Temperatures at both ends, and where the heat went.
fn heat(run: &RunReport) -> String {
    let Some(heat) = &run.heat else { return String::new() };
    let celsius = |k: f64| format!("{:.2}", k - 273.15);
    let mut t = table();
    set_header(&mut t, &["place", "start °C", "end °C"]);
    for ((name, start), (_, end)) in heat.start_k.iter().zip(&heat.end_k) {
        t.add_row([name.clone(), celsius(*start), celsius(*end)]);
    }
    right(&mut t, 1..3);
    let mut out = format!("\n{}\n{}", bold("Temperatures"), show(&t));
    let limit = match heat.beyond_limit_s {
        Some(t) => format!("beyond its limit of {} °C from t = {} s on", celsius(heat.limit_k), seconds(t)),
        None => format!("within its limit of {} °C", celsius(heat.limit_k)),
    };
    out += &format!("  highest oil  {} °C, {limit}\n", celsius(heat.highest_oil_k));
    let [made, carried, stored] = [heat.made_j, heat.carried_j, heat.stored_j].map(joules);
    out += &format!("  heat         {made} made, {carried} carried away, {stored} stored\n");
    if heat.elsewhere_j > 0.0 {
        out += &format!("  elsewhere    {} lost where it warms nothing in the gearbox\n", joules(heat.elsewhere_j));
    }
    out + &format!("  balance      closes to {:.1e} of the heat\n", heat.residual.abs())
}

/// Energy in a unit that reads well.
fn joules(e: f64) -> String {
    watts(e).replace('W', "J")
}

fn energy(run: &RunReport) -> String {
    let Some(e) = &run.energy else { return String::new() };
    let mut out = format!("\n{}\n", bold("Where the energy went"));
    let mut rows: Vec<(f64, [String; 5])> = Vec::new();
    let flow = |x: f64| if x == 0.0 { "-".to_owned() } else { joules(x) };
    let (more, less) = (e.stored_j.max(0.0), (-e.stored_j).max(0.0));
    let came_in = e.sources.iter().map(|s| s.in_j).sum::<f64>() + less;
    // What became of what came in: what went out, all together 100 %.
    let share = |out: f64| if came_in > 0.0 && out != 0.0 { percent(out / came_in) } else { "-".to_owned() };
    let nothing = NOTHING * came_in.max(e.turned_over_j);
    for s in &e.sources {
        let name = if s.name == s.member { s.name.clone() } else { format!("{} at {}", s.name, s.member) };
        let out = s.out_j.abs();
        rows.push((s.in_j.max(out), [name, "source".into(), flow(s.in_j), flow(out), share(out)]));
    }
    let stored = e.stored_j.abs();
    if stored > nothing {
        let name = "stored in motion and twist";
        rows.push((stored, [name.into(), "stored".into(), flow(less), flow(more), share(more)]));
    }
    let mut idle = 0;
    for l in &e.losses {
        if l.energy_j.abs() <= nothing {
            idle += 1;
            continue;
        }
        let row = [l.name.clone(), format!("loss, {}", l.kind), "-".into(), flow(l.energy_j), share(l.energy_j)];
        rows.push((l.energy_j.abs(), row));
    }
    rows.sort_by(|a, b| b.0.total_cmp(&a.0));
    if !rows.is_empty() {
        let mut t = table();
        set_header(&mut t, &["", "is", "in", "out", "share"]);
        for (_, row) in rows {
            t.add_row(row);
        }
        right(&mut t, 2..5);
        out += &show(&t);
    }
    if idle > 0 {
        out += &dim(&format!(
            "  nothing is lost in {}",
            if idle == 1 { "one more".to_owned() } else { format!("{idle} more") }
        ));
        out.push('\n');
    }
    if came_in == 0.0 {
        return out + "  balance      no energy came in\n";
    }
    for s in &e.machines {
        let (verb, x) = if s.energy_j < 0.0 { ("took", -s.energy_j) } else { ("gave", s.energy_j) };
        out += &format!("  {:<12} {verb} {} at {}, through its bus\n", s.name, joules(x), s.member);
    }
    // A sum of nothing is -0.0.
    let lost = e.losses.iter().map(|l| l.energy_j).filter(|l| l.abs() > nothing).sum::<f64>() + 0.0;
    out += &format!("  lost         {}, {} of what came in\n", joules(lost), percent(lost / came_in));
    if let Some(efficiency) = e.efficiency {
        out += &format!("  efficiency   {}\n", percent(efficiency));
    }
    let part = e.residual_j.abs() / came_in;
    out + &format!("  balance      closes to {part:.1e} of the {} that came in\n", joules(came_in))
}
