//! The first table: ratio, speeds and torques of every gear.

use willis::analysis::{Analysis, ShaftState, ShaftTableRequest, shaft_table};
use willis::exact::Rational;
use willis::train::{AS_DRAWN, MemberKind, Train};

use super::results::{exact_percent, fixed, significant};
use crate::report::document::{Block, Column, Level};

/// Gears beside each other.
const BESIDE: usize = 10;
/// Shafts of a table.
const SHAFTS: usize = 24;

/// Ratio, efficiency, closed elements, speeds and torques of all gears: a column a gear. Nothing where the train has no input and
/// output to count from.
pub fn tables(train: &Train, analysis: &Analysis) -> Vec<Block> {
    let Ok(mut table) = shaft_table(train, &ShaftTableRequest::default()) else { return vec![] };
    for (name, s) in &mut table.states.0 {
        s.at_load = analysis.ratios.get(name).and_then(|row| row.at_load.clone());
    }
    let all = &table.states.0;
    let blocks = all.len().div_ceil(BESIDE).max(1);
    let tables = all.chunks(all.len().div_ceil(blocks).max(1)).map(|states| block(train, states));
    // What operating points do not say, which have their own warnings on this page.
    let warnings = analysis.warnings_at_load().into_iter();
    tables
        .chain(warnings.map(|text| Block::Notice { level: Level::Warning, text: format!("At load: {text}") }))
        .collect()
}

fn block(train: &Train, states: &[(String, ShaftState)]) -> Block {
    let mut rows: Vec<Vec<String>> = vec![];
    let mut row = |quantity: &str, of: &str, cell: &dyn Fn(&ShaftState) -> String| {
        let cells: Vec<String> = states.iter().map(|(_, s)| cell(s)).collect();
        if cells.iter().any(|c| !c.is_empty()) {
            rows.push([quantity.to_owned(), of.to_owned()].into_iter().chain(cells).collect());
        }
    };
    row("Ratio", "input to output", &|s| s.ratio.as_ref().map_or("–".into(), |i| significant(i.to_f64(), 5)));
    row("Efficiency", "nominal, driving", &|s| s.efficiency.map_or("–".into(), exact_percent));
    row("", "at load", &|s| {
        let Some(at) = &s.at_load else { return String::new() };
        let mark = if at.warnings.is_empty() { "" } else { " *" };
        at.efficiency.map_or(at.verdict.words().to_owned(), exact_percent) + mark
    });
    row("Spin loss", "W", &|s| {
        s.at_load.as_ref().and_then(|a| a.spin_loss_w).map_or(String::new(), |w| significant(w, 4))
    });
    row("Closed", "", &|s| s.engaged.join(" "));
    let inputs: Vec<&str> = states.iter().map(|(_, s)| s.input.as_str()).collect();
    let outputs: Vec<&str> = states.iter().map(|(_, s)| s.output.as_str()).collect();
    let one = |ends: &[&str]| ends.iter().all(|end| *end == ends[0]);
    let one_input = one(&inputs);
    if !one_input {
        row("From", "", &|s| s.input.clone());
    }
    if !one(&outputs) {
        row("To", "", &|s| s.output.clone());
    }
    let shafts: Vec<&str> = (train.members().iter())
        .filter(|m| m.kind == MemberKind::Shaft && !(one_input && m.name == inputs[0]))
        .map(|m| m.name.as_str())
        .take(SHAFTS)
        .collect();
    for (k, name) in shafts.iter().enumerate() {
        row(if k == 0 { "Speed" } else { "" }, name, &|s| {
            let speed = s.members.get(name).and_then(|m| m.speed.as_ref());
            speed.map_or("–".into(), |w: &Rational| fixed(w.to_f64(), 3))
        });
    }
    let mut first = true;
    let mut torque = |name: &str, cell: &dyn Fn(&ShaftState) -> String| {
        row(if std::mem::take(&mut first) { "Torque" } else { "" }, name, cell);
    };
    for name in shafts.iter().copied().filter(|name| inputs.contains(name) || outputs.contains(name)) {
        torque(name, &|s| match s.members.get(name).and_then(|m| m.torque) {
            Some(t) if t != 0.0 => fixed(t, 3),
            Some(_) => String::new(),
            None => "–".into(),
        });
    }
    for e in train.shift_elements() {
        torque(&format!("{} {}", e.kind, e.name), &|s| match s.shift_elements.get(&e.name) {
            Some(own) if own.engaged => own.torque.map_or("–".into(), |t| fixed(t, 3)),
            _ => String::new(),
        });
    }
    let gear = |name: &String| if name == AS_DRAWN { "Value".to_owned() } else { name.clone() };
    let columns = [Column::words("Quantity"), Column::words("Of")].into_iter();
    let columns = columns.chain(states.iter().map(|(name, _)| Column::numbers(gear(name)))).collect();
    let what =
        if train.states().is_empty() { "Ratio, speeds and torques" } else { "Ratio, speeds and torques of all gears" };
    let more = train.members().iter().filter(|m| m.kind == MemberKind::Shaft).count().saturating_sub(SHAFTS + 1);
    let left_out = if more > 0 { format!("; {more} more shafts are not shown") } else { String::new() };
    let mut loads: Vec<String> = vec![];
    for a in states.iter().filter_map(|(_, s)| s.at_load.as_deref()) {
        let load = a.point(|x| significant(x, 4), |operation| format!("“{operation}”"));
        if !loads.contains(&load) {
            loads.push(load);
        }
    }
    let warned = states.iter().any(|(_, s)| s.at_load.as_ref().is_some_and(|a| !a.warnings.is_empty()));
    let mark = if warned { "; * with a warning, below" } else { "" };
    let at_load = match loads.is_empty() {
        true => String::new(),
        false => format!(
            ". At load: {}; the spin loss is that at the same speed with nothing at the output{mark}",
            loads.join("; ")
        ),
    };
    let caption = format!(
        "{what}, the input driving. Speeds are over that of the input. Torques are over that of the input, with the nominal \
         efficiencies of the meshes: external torques of shafts, torques that closed elements exert on their first shaft{left_out}{at_load}"
    );
    Block::Table { caption, columns, rows }
}
