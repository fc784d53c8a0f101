//! Speeds and torques of a shift table, for eyes.

use willis::analysis::{ShaftState, ShaftTable};
use willis::exact::Rational;

use crate::style::{bold, dim, percent, right, rpm, set_header, show, significant, table, wrap};

/// A cell of what is not known.
const UNKNOWN: &str = "-";
/// A cell of what is closed, or carries nothing.
const NOTHING: &str = "·";

/// `speed`: of the input, rad/s.
pub fn text(all: &ShaftTable, speed: Option<f64>) -> String {
    let mut out = bold(&all.train) + "\n";
    if let Some(source) = &all.source {
        out += &dim(&wrap(&format!("Source: {source}"), ""));
        out.push('\n');
    }
    let of_input = match speed {
        Some(w) => format!("rpm, with the input at {} rpm", significant(rpm(w), 6)),
        None => "over the speed of the input".to_owned(),
    };
    let value = |x: &Option<Rational>| match x {
        Some(x) if x.is_zero() => "0".to_owned(),
        Some(x) => match speed {
            Some(w) => significant(rpm(w) * x.to_f64(), 6),
            None => significant(x.to_f64(), 5),
        },
        None => UNKNOWN.into(),
    };
    let factor = |x: Option<f64>| match x {
        Some(x) if x.abs() < 5e-12 => NOTHING.to_owned(),
        Some(x) => significant(x, 5),
        None => UNKNOWN.into(),
    };
    let states = &all.states.0;
    let names = |of: &dyn Fn(&ShaftState) -> Vec<String>| {
        let mut names: Vec<String> = Vec::new();
        for name in states.iter().flat_map(|(_, s)| of(s)) {
            if !names.contains(&name) {
                names.push(name);
            }
        }
        names
    };
    let planets = |planet: bool| {
        move |s: &ShaftState| {
            let of = s.members.iter().filter(move |(_, m)| m.carrier.is_some() == planet);
            of.map(|(name, _)| name.to_owned()).collect::<Vec<_>>()
        }
    };
    // A row a state, a column a name.
    let matrix = |head: &str, names: &[String], cell: &dyn Fn(&ShaftState, &str) -> String| {
        if names.is_empty() {
            return String::new();
        }
        let mut t = table();
        let header: Vec<&str> = std::iter::once("state").chain(names.iter().map(String::as_str)).collect();
        set_header(&mut t, &header);
        for (state, s) in states {
            t.add_row(std::iter::once(state.clone()).chain(names.iter().map(|name| cell(s, name))));
        }
        right(&mut t, 1..header.len());
        format!("\n{}\n{}", bold(head), show(&t))
    };

    let mut t = table();
    set_header(&mut t, &["state", "engaged", "input", "output", "ratio", "exact", "η driving"]);
    for (name, s) in states {
        t.add_row([
            name.clone(),
            s.engaged.join(" "),
            s.input.clone(),
            s.output.clone(),
            s.ratio.as_ref().map_or(UNKNOWN.into(), |r| significant(r.to_f64(), 5)),
            s.ratio.as_ref().map_or(UNKNOWN.into(), ToString::to_string),
            s.efficiency.map_or(UNKNOWN.into(), percent),
        ]);
    }
    right(&mut t, 4..5);
    right(&mut t, 6..7);
    out += &format!("\n{}", show(&t));

    out += &matrix(&format!("Speeds, {of_input}"), &names(&planets(false)), &|s, name| {
        s.members.get(name).map_or(UNKNOWN.into(), |m| value(&m.speed))
    });
    out += &matrix(&format!("Planets on their carriers, {of_input}"), &names(&planets(true)), &|s, name| {
        s.members.get(name).map_or(UNKNOWN.into(), |m| value(&m.relative_speed))
    });
    let elements = names(&|s| s.shift_elements.iter().map(|(name, _)| name.to_owned()).collect());
    out += &matrix(&format!("Slip of open shift elements, {of_input}"), &elements, &|s, name| {
        s.shift_elements.get(name).map_or(UNKNOWN.into(), |e| if e.engaged { NOTHING.into() } else { value(&e.slip) })
    });
    let losses = if all.lossless { "without losses" } else { "the input drives, with the losses of the teeth" };
    let ends = names(&|s| vec![s.input.clone(), s.output.clone()]);
    let external: Vec<String> = ends.iter().chain(&elements).cloned().collect();
    out += &matrix(&format!("Torques, over that of the input: {losses}"), &external, &|s, name| match s
        .shift_elements
        .get(name)
        .filter(|_| elements.iter().any(|e| e == name))
    {
        Some(e) => factor(e.torque),
        None => factor(s.members.get(name).and_then(|m| m.torque)),
    });
    let of_sets = names(&|s| {
        let of = s.sets.iter().flat_map(|(set, members)| members.iter().map(move |(m, _)| format!("{set}.{m}")));
        of.collect()
    });
    out += &matrix("Torques that members put into sets, over that of the input", &of_sets, &|s, name| {
        let found = s.sets.iter().find_map(|(set, members)| {
            members.iter().find(|(m, _)| format!("{set}.{m}") == name).map(|(_, torque)| *torque)
        });
        factor(found.or(if s.efficiency.is_some() { Some(0.0) } else { None }))
    });
    for (name, s) in states {
        if let Some(reason) = &s.reason {
            out += &wrap(&format!("{name}: {reason}"), "");
            out.push('\n');
        }
    }
    out + "\n"
}
