//! Schemes and hybrids for eyes.

use willis_synthesis::schemes::{Hybrids, Scheme, SchemeCompleteness, SchemeGear, Schemes, Wish};

use super::tables::{largest_step, lowest_efficiency};
use crate::style::{bold, dim, plural, right, set_header, show, significant, table, wrap};

/// Rows of a table that are shown.
const MOST: usize = 50;

/// A label of a line of facts, and what it says.
fn fact(label: &str, said: &str) -> String {
    wrap(said, &format!("  {label:<13}")) + "\n"
}

fn ratio(x: f64) -> String {
    format!("{x:.3}")
}

fn efficiency(x: Option<f64>) -> String {
    x.map_or("-".into(), |e| format!("{:.2} %", 100.0 * e))
}

fn flag(is: bool) -> &'static str {
    if is { "yes" } else { "no" }
}

/// Shift schemes.
pub fn schemes(all: &Schemes) -> String {
    let mut out = format!("{}   {}\n", bold("Shift schemes"), wished(&all.wish));
    out += &limits(&all.wish);
    out.push('\n');
    out += &counts(all);
    out += &rules(all);
    if all.schemes.is_empty() {
        out += &relaxations(all);
    } else {
        out += &list(all);
        out += &elements(all);
        out += &steps(all);
        out += &best(all, 0);
    }
    if let Some(known) = &all.rediscovered {
        let said = match (known.found, known.row) {
            (false, _) => format!("{} does not do what is wanted with these tooth ratios", known.name),
            (true, Some(row)) => format!("{} is row {row}", known.name),
            (true, None) if all.completeness.complete => format!("{} is among them, not in the rows shown", known.name),
            (true, None) => format!("{} does what is wanted, in this part of the space or another", known.name),
        };
        out += &format!("\n{}\n", bold("Known transmission"));
        out += &wrap(&format!("{said}: {}", known.source), "  · ");
        out.push('\n');
        if let Some(scheme) = known.scheme.as_ref().filter(|_| known.row.is_none()) {
            let gears = scheme.gears.iter().chain(&scheme.reverse).map(|g| ratio(g.value));
            let gears: Vec<String> = gears.collect();
            out += &wrap(&format!("{}: {}", scheme.id, gears.join("  ")), "  · ");
            out.push('\n');
        }
    }
    out + &ending(&all.completeness, &all.assumptions)
}

fn wished(wish: &Wish) -> String {
    let ratios: Vec<String> = wish.sets.iter().map(ToString::to_string).collect();
    let of = match &wish.layout {
        Some(layout) => format!("on the layout {layout}"),
        None => format!("of {}", plural(wish.sets.len(), "set", "sets")),
    };
    format!(
        "{of}, {}; {} of {} closed; {} forward, {} reverse",
        ratios.join(", "),
        wish.closed,
        plural(wish.elements, "element", "elements"),
        wish.forward,
        wish.reverse
    )
}

/// What else the wish says.
fn limits(wish: &Wish) -> String {
    let range = |name: &str, bounds: &willis_synthesis::schemes::Bounds| {
        let end = |end: &Option<willis::exact::Rational>| {
            end.as_ref().map_or_else(String::new, |x| significant(x.to_f64(), 5))
        };
        let is_open = bounds.min.is_none() && bounds.max.is_none();
        (!is_open).then(|| format!("{name} {}..{}", end(&bounds.min), end(&bounds.max)))
    };
    let said = [
        range("forward ratios", &wish.forward_range),
        range("reverse ratios", &wish.reverse_range),
        range("steps", &wish.step),
        wish.progressive.then(|| "no step larger than the one before".to_owned()),
        (!wish.minimal).then(|| "elements that can be left out allowed".to_owned()),
        wish.max_speed.as_ref().map(|x| format!("speeds up to {} of the input", significant(x.to_f64(), 5))),
        wish.max_torque.as_ref().map(|x| format!("torques up to {} of the input", significant(x.to_f64(), 5))),
        wish.min_efficiency.as_ref().map(|x| format!("efficiencies of {} and more", significant(x.to_f64(), 5))),
        wish.max_brakes.map(|n| format!("at most {}", plural(n, "brake", "brakes"))),
        wish.planar.then(|| "drawn without a crossing".to_owned()),
    ];
    let said: Vec<String> = said.into_iter().flatten().collect();
    if said.is_empty() { String::new() } else { wrap(&said.join("; "), "  ") + "\n" }
}

fn counts(all: &Schemes) -> String {
    let (space, found) = (&all.space, &all.found);
    let mut out =
        fact("layouts", &format!("{} examined of {}, {} with a scheme", space.examined, space.layouts, found.layouts));
    out += &fact("choices", &format!("{} of elements that differ in what they do", space.choices));
    let classes = "by what the elements do, wherever they stand";
    out += &fact("schemes", &format!("{} in {} classes {classes}", found.schemes, found.classes));
    if !found.by_brakes.is_empty() {
        let by: Vec<String> = found.by_brakes.iter().map(|(brakes, n)| format!("{n} with {brakes}")).collect();
        out += &fact("by brakes", &by.join(", "));
    }
    out
}

fn rules(all: &Schemes) -> String {
    let mut t = table();
    set_header(&mut t, &["rule", "left", "what it asks"]);
    for stage in &all.waterfall {
        t.add_row([stage.rule.clone(), stage.left.to_string(), stage.about.clone()]);
    }
    right(&mut t, 1..2);
    format!("\n{}\n{}", bold("What each rule leaves"), show(&t))
}

fn relaxations(all: &Schemes) -> String {
    if all.relaxations.is_empty() {
        return String::new();
    }
    let mut t = table();
    set_header(&mut t, &["with", "schemes", "the first at"]);
    for r in &all.relaxations {
        let schemes = r.schemes.map_or_else(|| "?".to_owned(), |n| n.to_string());
        let until = r.until.filter(|_| r.schemes.is_some_and(|n| n > 0)).map(|x| significant(x, 5));
        t.add_row([r.change.clone(), schemes, until.or_else(|| r.reason.clone()).unwrap_or_default()]);
    }
    right(&mut t, 1..2);
    let mut out = format!("\n{}\n{}", bold("Nothing is left. What there is if one wish gives way"), show(&t));
    if all.relaxations.iter().all(|r| r.schemes == Some(0)) {
        out += &(wrap("No single wish is to blame: two or more of them must give way.", "  ") + "\n");
    }
    out
}

fn list(all: &Schemes) -> String {
    let shown = &all.schemes[..all.schemes.len().min(MOST)];
    let gears = shown.iter().map(|s| s.gears.len()).max().unwrap_or(0);
    let reverse = shown.iter().map(|s| s.reverse.len()).max().unwrap_or(0);
    let names: Vec<String> = (1..=gears).map(|n| n.to_string()).collect();
    let back: Vec<String> = match reverse {
        1 => vec!["R".into()],
        n => (1..=n).map(|n| format!("R{n}")).collect(),
    };
    let mut header = vec!["row", "scheme"];
    header.extend(names.iter().chain(&back).map(String::as_str));
    let from = header.len();
    header.extend(["spread", "step ≤", "torque ≤", "speed ≤", "η ≥", "brakes", "planar", "known"]);
    let mut t = table();
    set_header(&mut t, &header);
    for (k, s) in shown.iter().enumerate() {
        let cells = |all: &[SchemeGear], width: usize| -> Vec<String> {
            (0..width).map(|g| all.get(g).map_or(String::new(), |g| ratio(g.value))).collect()
        };
        let mut row = vec![(k + 1).to_string(), s.id.clone()];
        row.extend(cells(&s.gears, gears));
        row.extend(cells(&s.reverse, reverse));
        row.extend([
            ratio(s.spread),
            largest_step(s).map_or("-".into(), ratio),
            ratio(s.max_torque),
            ratio(s.max_speed),
            efficiency(lowest_efficiency(s)),
            s.brakes.to_string(),
            flag(s.planar).into(),
            s.known.clone().unwrap_or_default(),
        ]);
        t.add_row(row);
    }
    right(&mut t, 0..1);
    right(&mut t, 2..from + 6);
    let by = format!("in the order {}; torques and speeds per those of the input", all.wish.order);
    let mut out = format!("\n{}   {}\n{}", bold("Ratios"), dim(&by), show(&t));
    out += &more(shown.len(), all.schemes.len());
    out
}

/// How many rows are left out on the screen.
fn more(shown: usize, of: usize) -> String {
    match of > shown {
        true => format!("  … and {} more rows, in the tables and the JSON answer\n", of - shown),
        false => String::new(),
    }
}

fn elements(all: &Schemes) -> String {
    let shown = &all.schemes[..all.schemes.len().min(MOST)];
    let names: Vec<String> = shown[0].elements.iter().map(|e| e.name.clone()).collect();
    let mut header = vec!["row"];
    header.extend(names.iter().map(String::as_str));
    let mut t = table();
    set_header(&mut t, &header);
    for (k, s) in shown.iter().enumerate() {
        let joins = s.elements.iter().map(|e| match e.joins.iter().position(|s| s == "housing") {
            Some(at) => format!("brakes {}", e.joins[1 - at]),
            None => e.joins.join(" - "),
        });
        t.add_row(std::iter::once((k + 1).to_string()).chain(joins));
    }
    right(&mut t, 0..1);
    let what = "s, r, c: sun, ring, carrier of a set; a shaft is named after what it carries";
    format!("\n{}   {}\n{}", bold("Elements"), dim(what), show(&t))
}

fn steps(all: &Schemes) -> String {
    let shown = &all.schemes[..all.schemes.len().min(MOST)];
    let most = shown.iter().map(|s| s.gears.len()).max().unwrap_or(0);
    if most < 2 {
        return String::new();
    }
    let names: Vec<String> = (1..most).map(|n| format!("{n}-{}", n + 1)).collect();
    let mut header = vec!["row"];
    header.extend(names.iter().map(String::as_str));
    let mut t = table();
    set_header(&mut t, &header);
    for (k, s) in shown.iter().enumerate() {
        let step = |g: usize| s.gears.get(g).and_then(|g| g.step).map_or(String::new(), ratio);
        t.add_row(std::iter::once((k + 1).to_string()).chain((0..most - 1).map(step)));
    }
    right(&mut t, 0..most);
    format!("\n{}\n{}", bold("Steps"), show(&t))
}

/// The shift table of a row.
fn best(all: &Schemes, row: usize) -> String {
    let s: &Scheme = &all.schemes[row];
    let mut header = vec!["gear", "ratio", "exact", "step", "η"];
    header.extend(s.elements.iter().map(|e| e.name.as_str()));
    let mut t = table();
    set_header(&mut t, &header);
    for g in s.gears.iter().chain(&s.reverse) {
        let mut cells = vec![
            g.name.clone(),
            ratio(g.value),
            g.ratio.to_string(),
            g.step.map_or(String::new(), ratio),
            efficiency(g.efficiency),
        ];
        cells.extend(s.elements.iter().map(|e| match (g.torques.get(&e.name), g.slips.get(&e.name)) {
            (Some(torque), _) => format!("● {torque:.3}"),
            (None, Some(slip)) => format!("({slip:.3})"),
            _ => String::new(),
        }));
        t.add_row(cells);
    }
    right(&mut t, 1..header.len());
    let what = "●: closed, its torque per that of the input; in brackets: open, its slip per speed of the input";
    let name = s.known.as_ref().map_or(String::new(), |known| format!(", the {known}"));
    let mut out = format!("\n{}   {}\n{}", bold(&format!("Shift table of row {}{name}", row + 1)), dim(what), show(&t));
    for e in s.elements.iter().filter(|e| !e.same.is_empty()) {
        let places: Vec<String> = e.same.iter().map(|p| p.join(" - ")).collect();
        out += &(wrap(&format!("{} does the same between {}", e.name, places.join(" or ")), "  · ") + "\n");
    }
    for g in s.gears.iter().chain(&s.reverse) {
        if let Some(why) = &g.no_efficiency {
            out += &(wrap(&format!("gear {}: {why}", g.name), "  · ") + "\n");
        }
    }
    out
}

/// What was taken for granted, and what the answer covers.
fn ending(covers: &SchemeCompleteness, assumptions: &[String]) -> String {
    let mut out = String::new();
    if !assumptions.is_empty() {
        out += &format!("\n{}\n", bold("Assumptions in force"));
        for line in assumptions {
            out += &(wrap(line, "  · ") + "\n");
        }
    }
    out += &format!("\n{}\n", bold(if covers.complete { "Complete" } else { "Not complete" }));
    out + &wrap(&covers.statement, "  ") + "\n"
}

/// Hybrids.
pub fn hybrids(all: &Hybrids) -> String {
    let wish = &all.wish;
    let ratios: Vec<String> = wish.sets.iter().map(ToString::to_string).collect();
    let need: Vec<String> = wish.need.iter().map(ToString::to_string).collect();
    let mut out = format!(
        "{}   of {}, {}; {}, mobility {}\n",
        bold("Hybrids"),
        plural(wish.sets.len(), "set", "sets"),
        ratios.join(", "),
        plural(wish.clutches, "clutch or brake", "clutches and brakes"),
        wish.mobility
    );
    out += &(wrap(&format!("needed: {}", need.join(", ")), "  ") + "\n\n");
    out += &fact("layouts", &format!("{}, with the motors exchanged counted once", all.layouts));
    out += &fact("choices", &format!("{} of clutches that differ in what they do", all.choices));
    let places = format!("have these modes, with {} places for their clutches", all.designs_found);
    out += &fact("designs", &format!("{} {places}", all.kinematic));
    let modes: Vec<String> = all.modes.iter().map(|(kind, n)| format!("{n} {kind}")).collect();
    out += &fact("modes", &modes.join(", "));
    if all.designs.is_empty() {
        let missing: Vec<String> =
            wish.need.iter().filter(|kind| !all.modes.contains_key(kind)).map(ToString::to_string).collect();
        let why = match missing.is_empty() {
            true => "Each mode exists, but no choice of so many clutches has all of them.".to_owned(),
            false => format!("No layout has a mode {}.", missing.join(", ")),
        };
        out += &format!("\n{}\n{}\n", bold("Nothing is left"), wrap(&why, "  "));
        return out + &ending(&all.completeness, &all.assumptions);
    }
    let shown = &all.designs[..all.designs.len().min(MOST)];
    let mut t = table();
    let names: Vec<String> = (1..=wish.clutches).map(|n| format!("C{n}")).collect();
    let mut header = vec!["row", "hybrid", "engine", "output", "A", "B"];
    header.extend(names.iter().map(String::as_str));
    header.push("same");
    set_header(&mut t, &header);
    let parts = |layout: &str, digit: char| -> String {
        let own = layout.chars().enumerate().filter(|(_, d)| *d == digit);
        own.map(|(m, _)| format!("{}{}", ['s', 'r', 'c'][m % 3], m / 3 + 1)).collect()
    };
    for (k, d) in shown.iter().enumerate() {
        let mut row = vec![(k + 1).to_string(), d.id.clone()];
        row.extend(['0', '1', '3', '4'].map(|digit| parts(&d.layout, digit)));
        row.extend(d.clutches.iter().map(|joins| match joins.iter().position(|s| s == "housing") {
            Some(at) => format!("brakes {}", joins[1 - at]),
            None => joins.join(" - "),
        }));
        row.push(d.same.to_string());
        t.add_row(row);
    }
    right(&mut t, 0..1);
    let what =
        "engine, output and motors A, B stand on these suns, rings, carriers; same: other places of the clutches";
    out += &format!("\n{}   {}\n{}", bold("Designs"), dim(what), show(&t));
    out += &more(shown.len(), all.designs.len());
    let first = &all.designs[0];
    let mut t = table();
    set_header(&mut t, &["mode", "closed", "turning", "ratio", "mechanical points"]);
    for m in &first.modes {
        let points: Vec<String> =
            m.mechanical_points.iter().map(|p| format!("{} = {}", p, significant(p.to_f64(), 4))).collect();
        t.add_row([
            m.kind.to_string(),
            m.closed.join(" "),
            m.turning.join(" "),
            m.ratio.as_ref().map_or("-".into(), |r| format!("{r} = {}", significant(r.to_f64(), 4))),
            points.join("   "),
        ]);
    }
    let what = "ratio: engine over output speed; mechanical point: such a ratio at which a motor is at rest";
    out += &format!("\n{}   {}\n{}", bold("Modes of row 1"), dim(what), show(&t));
    out + &ending(&all.completeness, &all.assumptions)
}
