//! A plain map, one row a point: `state,input_speed_rpm,torque_on_input_n_m,torque_on_output_n_m,loss_w,efficiency,verdict,
//! reason`, and `temperature_c` before the verdict where several are asked for.
//!
//! RFC 4180: comma, quotes doubled. Torques are external ones on the members, so the output's is negative where it
//! drives a load in its direction of motion. What has no answer has empty fields, and its verdict and reason.

use crate::diagnostic::Diagnostics;
use crate::train::Train;

use super::map::gears;
use super::names::{file, number, short, verdict};
use super::{Asked, Export, ExportedFile, told};

pub(super) fn write(train: &Train, request: &Asked) -> Result<Export, Diagnostics> {
    let (gears, mut notes) = gears(train, request)?;
    let several = request.temperatures.len() > 1;
    let mut text = String::from("state,input_speed_rpm,torque_on_input_n_m,torque_on_output_n_m,loss_w,efficiency,");
    text += if several { "temperature_c,verdict,reason\n" } else { "verdict,reason\n" };
    let (mut points, mut empty) = (0, 0);
    for gear in &gears {
        notes.extend(told(gear));
        notes.extend(gear.chosen.iter().cloned());
        for t in &gear.temperatures {
            for p in gear.map(*t)?.rows.iter().flatten() {
                let field = |x: Option<f64>| x.map_or(String::new(), number);
                let mut row = vec![
                    quoted(gear.name.as_deref().unwrap_or(crate::train::AS_DRAWN)),
                    number(p.speed_rpm),
                    number(p.torque_n_m),
                    field(p.answer.map(|a| a.output_torque_n_m)),
                    field(p.answer.map(|a| a.loss_w)),
                    field(p.answer.and_then(|a| a.efficiency)),
                ];
                row.extend(t.filter(|_| several).map(|t| short(t - 273.15)));
                row.extend([verdict(p.verdict).to_owned(), quoted(p.reason.as_deref().unwrap_or_default())]);
                text += &row.join(",");
                text.push('\n');
                points += 1;
                empty += usize::from(p.answer.is_none());
            }
        }
    }
    if empty > 0 {
        notes.push(format!("{empty} of {points} points have no single answer: their numbers are left empty"));
    }
    let state = request.state.as_deref().filter(|_| gears.len() == 1);
    let about = format!("{points} points");
    Ok(Export::new(vec![ExportedFile { name: file(train.name(), state, "csv"), text, about }], notes))
}

fn quoted(text: &str) -> String {
    match text.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", text.replace('"', "\"\"")),
        false => text.to_owned(),
    }
}
