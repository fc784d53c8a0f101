//! Trains that were found, for eyes.

use willis_synthesis::teeth::{DesignAnswer, DesignRow, Objective, RankedBy, Recomputed};

use crate::style::{bold, dim, percent, right, set_header, show, significant, table, wrap};

/// Wider than this no table is.
const MOST_STATES: usize = 4;

/// A count with its digits in groups.
fn count(n: f64) -> String {
    if n >= 1e15 {
        return format!("{n:.2e}");
    }
    let digits = format!("{n:.0}");
    let groups: Vec<&str> =
        digits.as_bytes().rchunks(3).rev().map(|c| std::str::from_utf8(c).unwrap_or_default()).collect();
    groups.join(" ")
}

/// For eyes.
pub fn text(a: &DesignAnswer) -> String {
    let mut out = format!("{}\n{}\n\n", bold(&a.name), dim(&wrap(&a.wish, "  ")));
    let mut t = table();
    set_header(&mut t, &["condition", "trains left", "with every number of planets"]);
    t.add_row(["candidates".to_owned(), String::new(), count(a.space.candidates)]);
    for s in &a.waterfall {
        let by: Vec<String> = s.by_planets.iter().map(|(n, k)| format!("{n}: {}", count(*k as f64))).collect();
        let by = if by.len() > 1 { format!("   ({})", by.join(", ")) } else { String::new() };
        t.add_row([s.condition.clone(), count(s.trains as f64), format!("{}{by}", count(s.designs as f64))]);
    }
    right(&mut t, 1..2);
    out += &show(&t);
    if !a.rows.is_empty() || a.own.is_some() {
        out += "\n";
        out += &rows(a);
    }
    for r in &a.relaxations {
        out += &(wrap(&r.words, "  must give: ") + "\n");
    }
    if !a.relaxations.is_empty() {
        out += "\n";
    }
    if let Some(own) = &a.own {
        let fails = match &own.fails[..] {
            [] => "satisfies the wish".to_owned(),
            all => format!("does not satisfy: {}", all.join(", ")),
        };
        let better = match (own.better, a.front) {
            (0, 0) => String::new(),
            (0, _) => "; no train of the front is better in one objective without being worse in another".to_owned(),
            (n, _) => format!("; {n} of the front beat it: nowhere worse and somewhere better"),
        };
        out += &(wrap(&format!("{} {fails}{better}", own.name), "  yours: ") + "\n\n");
    }
    out += &(wrap(&a.completeness.statement, "  ") + "\n");
    out
}

fn rows(a: &DesignAnswer) -> String {
    let by_front = a.ranked_by.by == RankedBy::Laws && a.ranked_by.recomputed == Recomputed::Front;
    let shown = match (a.rows.len() as u64, a.of_all) {
        (0, _) => "no train".to_owned(),
        (n, true) => format!("the first {n} of all trains"),
        (n, false) if n < a.front => format!("{n} of the {} trains that no other one beats", a.front),
        (1, false) => "the one train that no other one beats".to_owned(),
        (n, false) => format!("the {n} trains that no other one beats"),
    };
    let objectives: Vec<String> = a
        .objectives
        .iter()
        .map(|o| format!("{} {}", if o.is_better_high() { "high" } else { "low" }, spoken(*o)))
        .collect();
    let by = match (by_front, a.ranked_by.by) {
        (true, _) => " by mesh efficiencies",
        (_, RankedBy::Laws) => " under the laws of friction",
        _ => "",
    };
    let under = if by_front && matches!(a.sorted_by, Objective::Forward | Objective::Backward) {
        " under the laws"
    } else {
        ""
    };
    let title = format!("{shown}{by} ({}), sorted by {}{under}", objectives.join(", "), spoken(a.sorted_by));
    let mut out = wrap(&title, "") + "\n";
    let own = a.own.as_ref().map(|o| &o.row);
    let all: Vec<&DesignRow> = a.rows.iter().chain(own).collect();
    let sample = all[0];
    let states = sample.states.iter().count();
    let has = |of: fn(&DesignRow) -> bool| all.iter().any(|r| of(r));
    let metric = has(|r| r.ring_diameter_m.is_some());
    let torque = has(|r| r.element_torque.is_some());
    let limited = states > MOST_STATES;
    let mut header = vec!["row".to_owned(), "teeth".into(), "planets".into()];
    let sets: Vec<&str> = sample.sets.iter().map(|(n, _)| n.as_str()).collect();
    if sets.len() > 1 {
        header[1] = format!("teeth {}", sets.join(" · "));
    }
    if metric && all.iter().flat_map(|r| r.sets.iter()).any(|(_, s)| s.module_m != first_module(sample)) {
        header.push("module mm".into());
    }
    let modules = header.len() == 4;
    if !limited {
        header.extend(sample.states.iter().map(|(n, _)| if states == 1 { "ratio".into() } else { format!("i {n}") }));
    }
    header.push("error".into());
    header.push(if metric { "ring mm" } else { "ring z" }.into());
    header.extend(["forward", "backward"].map(String::from));
    let laws = [!a.ranked_by.forward.is_empty(), !a.ranked_by.backward.is_empty()];
    header.extend(["by laws", "back by laws"].iter().zip(laws).filter(|h| h.1).map(|h| (*h.0).to_owned()));
    header.extend(["lock", "spin"].map(String::from));
    if torque {
        header.push("torque".into());
    }
    // More sets than that make a cell too wide to be read; the tables have it all.
    let has_phase = sets.len() <= 2;
    header.push("hunts".into());
    if has_phase {
        header.push("phase".into());
    }
    let numbers = header.len();
    let mut t = table();
    set_header(&mut t, &header.iter().map(String::as_str).collect::<Vec<_>>());
    for r in &all {
        let teeth: Vec<String> = r
            .sets
            .iter()
            .map(|(_, s)| s.teeth.iter().map(|(_, z)| z.to_string()).collect::<Vec<_>>().join("/"))
            .collect();
        let planets: Vec<String> = r.sets.iter().map(|(_, s)| s.chosen.to_string()).collect();
        let name = if r.number == 0 { "yours".to_owned() } else { r.number.to_string() };
        let mut cells = vec![name, teeth.join(" · "), planets.join(" · ")];
        if modules {
            let all: Vec<String> =
                r.sets.iter().map(|(_, s)| s.module_m.map_or("–".into(), |m| significant(1e3 * m, 3))).collect();
            cells.push(all.join(" · "));
        }
        if !limited {
            cells.extend(r.states.iter().map(|(_, s)| significant(s.value, 5)));
        }
        cells.push(percent(r.error));
        cells.push(r.ring_diameter_m.map_or(r.ring_teeth.to_string(), |d| significant(1e3 * d, 4)));
        let efficiency = |e: Option<f64>, locks: bool| match e {
            Some(e) => percent(e),
            None if locks => "locks".into(),
            None => "–".into(),
        };
        cells.push(efficiency(r.forward, false));
        cells.push(efficiency(r.backward, r.self_locking));
        let own = r.laws.as_ref();
        if laws[0] {
            cells.push(efficiency(own.and_then(|l| l.forward), false));
        }
        if laws[1] {
            cells.push(efficiency(own.and_then(|l| l.backward), own.is_some_and(|l| l.self_locking)));
        }
        cells.push(r.lock_margin.map_or("never".into(), |m| significant(m, 3)));
        cells.push(significant(r.planet_spin, 3));
        if torque {
            cells.push(r.element_torque.map_or("–".into(), |m| significant(m, 3)));
        }
        let hunts: Vec<&str> = r.sets.iter().map(|(_, s)| if s.hunting { "yes" } else { "no" }).collect();
        cells.push(together(&hunts));
        if has_phase {
            let phases: Vec<String> = r.sets.iter().map(|(_, s)| phase(s.phase)).collect();
            cells.push(together(&phases.iter().map(String::as_str).collect::<Vec<_>>()));
        }
        t.add_row(cells);
    }
    right(&mut t, 3..numbers);
    out += &show(&t);
    let gears: Vec<String> = sample
        .sets
        .iter()
        .map(|(_, s)| s.teeth.iter().map(|(g, _)| g.replace('_', " ")).collect::<Vec<_>>().join("/"))
        .collect();
    let same = gears.iter().all(|g| *g == gears[0]);
    let mut told = vec![format!("teeth: {}.", if same { gears[0].clone() } else { gears.join(" · ") })];
    told.push(format!("Efficiencies that rank: {}.", a.ranked_by.words));
    told.push("lock: the factor on all losses at which the output can no longer drive the input.".into());
    told.push(
        match (torque, states > 1) {
            (true, _) => {
                "spin: the fastest planet on its pin, per speed of the input; torque: of the most loaded element."
            }
            (false, true) => "spin: the fastest planet on its pin, per speed of the input, over all states.",
            (false, false) => "spin: the fastest planet on its pin, per speed of the input.",
        }
        .into(),
    );
    out += &(dim(&wrap(&told.join(" "), "  ")) + "\n\n");
    out + &operations(&all)
}

/// The operations of the file, with its laws.
fn operations(all: &[&DesignRow]) -> String {
    let names: Vec<&str> = all[0].operations.iter().map(|(n, _)| n.as_str()).collect();
    if names.is_empty() {
        return String::new();
    }
    let mut t = table();
    let mut header = vec!["row"];
    header.extend(&names);
    set_header(&mut t, &header);
    for r in all {
        let name = if r.number == 0 { "yours".to_owned() } else { r.number.to_string() };
        let cell = |n: &&str| match r.operations.get(n) {
            Some(o) => o.efficiency.map_or_else(|| crate::table::word(&o.verdict), percent),
            None => "–".to_owned(),
        };
        t.add_row(std::iter::once(name).chain(names.iter().map(cell)));
    }
    right(&mut t, 1..header.len());
    format!("efficiency in the operations of the file, with its laws\n{}\n", show(&t))
}

fn first_module(r: &DesignRow) -> Option<f64> {
    r.sets.iter().next().and_then(|(_, s)| s.module_m)
}

/// One word where all say the same.
fn together(all: &[&str]) -> String {
    match all {
        [first, rest @ ..] if rest.iter().all(|w| w == first) => (*first).to_owned(),
        _ => all.join(" · "),
    }
}

fn phase(phase: willis_synthesis::teeth::fit::Phase) -> String {
    crate::table::word(&phase).replace(['-', '_'], " ")
}

/// An objective in words.
fn spoken(o: Objective) -> &'static str {
    match o {
        Objective::Error => "ratio error",
        Objective::RingDiameter => "ring diameter",
        Objective::Forward => "forward efficiency",
        Objective::Backward => "backward efficiency",
        Objective::LockMargin => "margin to self-locking",
        Objective::PlanetSpin => "planet speed",
        Objective::MemberSpeed => "member speed",
        Objective::ElementTorque => "element torque",
        _ => "objective",
    }
}
