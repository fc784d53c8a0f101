//! Speeds and torques of a shift table, for eyes.

use willis::analysis::{AtLoad, Losses, ShaftState, ShaftTable};
use willis::exact::Rational;
use willis::operating_point::LossKind;

use crate::questions::analyze::{at_load_cell, load, starred};
use crate::style::{assumptions, bold, dim, percent, right, rpm, set_header, show, significant, table, wrap};

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
    out += &at_load(states);
    for (name, s) in states {
        if let Some(reason) = &s.reason {
            out += &wrap(&format!("{name}: {reason}"), "");
            out.push('\n');
        }
    }
    out + "\n" + &assumptions(&all.assumptions) + "\n"
}

/// Losses at a load and without one; nothing where they depend on neither.
fn at_load(states: &[(String, ShaftState)]) -> String {
    let all: Vec<(&str, &AtLoad)> =
        states.iter().filter_map(|(n, s)| Some((n.as_str(), &**s.at_load.as_ref()?))).collect();
    let Some((_, first)) = all.first() else { return String::new() };
    let one = all.iter().all(|(_, a)| (a.speed_rad_s, a.torque_n_m) == (first.speed_rad_s, first.torque_n_m));
    let watts = |x: Option<f64>| x.map_or(UNKNOWN.into(), |x| significant(x, 4));
    let limit = |a: &AtLoad| if a.beyond_limit { "> " } else { "" };
    let celsius = |a: &AtLoad| a.temperature_k.map(|t| format!("{}{:.1}", limit(a), t - 273.15));
    let warm = all.iter().any(|(_, a)| a.temperature_k.is_some());
    let kinds = |of: &dyn Fn(&AtLoad) -> Option<Losses>| -> Vec<usize> {
        let own = |k: &usize| all.iter().any(|(_, a)| of(a).is_some_and(|l| l.all()[*k] != 0.0));
        (0..Losses::NAMES.len()).filter(own).collect()
    };
    let matrix = |title: &str, loaded: bool, of: &dyn Fn(&AtLoad) -> Option<Losses>| {
        let kinds = kinds(of);
        let mut header = vec!["state".to_owned()];
        if loaded && !one {
            header.extend(["rpm".to_owned(), "N m".to_owned()]);
        }
        if loaded && warm {
            header.push("oil °C".into());
        }
        if loaded {
            header.push("η".into());
        }
        header.push("loss W".into());
        header.extend(kinds.iter().map(|k| Losses::NAMES[*k].to_owned()));
        let elements = if loaded { vec![] } else { open_elements(&all) };
        header.extend(elements.iter().cloned());
        let mut t = table();
        set_header(&mut t, &header.iter().map(String::as_str).collect::<Vec<_>>());
        for (name, a) in &all {
            let mut row = vec![(*name).to_owned()];
            if loaded && !one {
                row.extend([significant(rpm(a.speed_rad_s), 5), significant(a.torque_n_m, 4)]);
            }
            if loaded && warm {
                row.push(celsius(a).unwrap_or(UNKNOWN.into()));
            }
            if loaded {
                row.push(at_load_cell(a));
            }
            row.push(watts(if loaded { a.loss_w } else { a.spin_loss_w }));
            row.extend(kinds.iter().map(|k| watts(of(a).map(|l| l.all()[*k]))));
            row.extend(elements.iter().map(|e| drag(a, e).map_or(NOTHING.into(), |w| watts(Some(w)))));
            t.add_row(row);
        }
        right(&mut t, 1..header.len());
        format!("\n{}\n{}", bold(title), show(&t))
    };
    let at = if one { load(first) } else { "the load of each input".to_owned() };
    let mut out = matrix(&format!("Losses at {at}"), true, &|a| a.losses_w);
    out += &matrix("Spin losses: the same speed and oil, nothing at the output", false, &|a| a.spin_losses_w);
    out += &starred(&AtLoad::warnings_of(all.iter().map(|(_, a)| *a)));
    for (name, a) in &all {
        if let Some(reason) = a.without_output() {
            out += &wrap(&format!("{name}, at load: {reason}"), "");
            out.push('\n');
        }
    }
    out
}

/// Open shift elements whose drag is known, in any state.
fn open_elements(all: &[(&str, &AtLoad)]) -> Vec<String> {
    let mut names: Vec<String> = vec![];
    for source in all.iter().flat_map(|(_, a)| &a.spin_sources).filter(|s| s.kind == LossKind::ShiftElement) {
        if !names.contains(&source.name) {
            names.push(source.name.clone());
        }
    }
    names
}

/// What one of them takes without load, W.
fn drag(a: &AtLoad, element: &str) -> Option<f64> {
    let own = a.spin_sources.iter().find(|s| s.kind == LossKind::ShiftElement && s.name == element);
    own.map(|s| s.loss_w)
}
