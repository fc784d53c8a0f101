//! Table and ratio of `Modelica.Mechanics.Rotational.Components.LossyGear` for the whole gear, each state.
//!
//! Source: Modelica Standard Library 4.1.0, `Modelica/Mechanics/Rotational/Components/LossyGear.mo`. Rows are
//! `|w_a|, eta_mf1, eta_mf2, |tau_bf1|, |tau_bf2|` of `flange_a`, here the input. With `flange_b` the output and
//! `w_a > 0`,
//!
//! ```text
//! -flange_b.tau = ratio*(eta_mf1*flange_a.tau - tau_bf1)     flange_a drives: flange_a.tau >= tau_bf_a
//! -flange_b.tau = ratio*(flange_a.tau/eta_mf2 - tau_bf2)     flange_b drives
//! tau_bf_a = (tau_bf1 - tau_bf2)/(eta_mf1 - 1/eta_mf2)
//! ```
//!
//! so at every speed the output torque is two straight lines over the input torque. Constant efficiencies are that
//! exactly, in one row. Of computed losses, what is lost without torque is `tau_bf1 = tau_bf2`, and the efficiencies are
//! fitted by least squares, speed by speed; how far the two lines miss the map is told. Between rows LossyGear interpolates; beyond the last it goes on with the last two, and a row of speed
//! zero keeps it from doing that below the first.
//!
//! An efficiency of LossyGear is above 0: a gear that locks when driven back is not expressible and refused.

use crate::diagnostic::Diagnostics;
use crate::exact::Rational;
use crate::train::Train;
use crate::units::{Dimension, Quantity};

use super::map::{Gear, Map, gears};
use super::names::{file, identifier, identifiers, line, number, percent, short};
use super::{Asked, Export, ExportedFile, told};

/// A row of the table.
#[derive(Clone, Copy, Debug)]
struct Row {
    speed: f64,
    eta: [f64; 2],
    bearing: [f64; 2],
}

impl Row {
    /// Torque that LossyGear gives out at `flange_b`, over the ratio, turning forward.
    fn out(&self, torque: f64) -> f64 {
        let [eta1, eta2] = self.eta;
        let [b1, b2] = self.bearing;
        let switch = match eta1 == 1.0 && eta2 == 1.0 {
            true => b1 / 2.0,
            false => (b1 - b2) / (eta1 - 1.0 / eta2),
        };
        if torque - switch >= 0.0 { eta1 * torque - b1 } else { torque / eta2 - b2 }
    }
}

/// Words of the language, so no names.
pub(super) const RESERVED: &[&str] = &[
    "algorithm",
    "and",
    "annotation",
    "block",
    "break",
    "class",
    "connect",
    "connector",
    "constant",
    "constrainedby",
    "der",
    "discrete",
    "each",
    "else",
    "elseif",
    "elsewhen",
    "encapsulated",
    "end",
    "enumeration",
    "equation",
    "expandable",
    "extends",
    "external",
    "false",
    "final",
    "flow",
    "for",
    "function",
    "if",
    "import",
    "impure",
    "in",
    "initial",
    "inner",
    "input",
    "loop",
    "model",
    "not",
    "operator",
    "or",
    "outer",
    "output",
    "package",
    "parameter",
    "partial",
    "protected",
    "public",
    "pure",
    "record",
    "redeclare",
    "replaceable",
    "return",
    "stream",
    "then",
    "true",
    "type",
    "when",
    "while",
    "within",
    "time",
    "frame",
    "Modelica",
];

/// A string of Modelica.
pub(super) fn string(text: &str) -> String {
    format!("\"{}\"", line(text).replace('\\', "\\\\").replace('"', "\\\""))
}

/// A name of a class: `ZF 8HP70` becomes `Zf8hp70`.
pub(super) fn class(text: &str) -> String {
    let mut out = String::new();
    let mut up = true;
    for c in text.chars() {
        if c.is_ascii_alphanumeric() {
            out.push(if up { c.to_ascii_uppercase() } else { c });
            up = false;
        } else {
            up = true;
        }
    }
    out.truncate(40);
    identifier(&out, RESERVED)
}

pub(super) fn write(train: &Train, request: &Asked) -> Result<Export, Diagnostics> {
    let (gears, mut notes) = gears(train, request)?;
    let mut wrong = Diagnostics::default();
    let mut done: Vec<(&Gear, Vec<Row>, Vec<String>)> = Vec::new();
    for gear in &gears {
        let mut own = told(gear);
        match rows(gear, &mut own) {
            Ok(rows) => done.push((gear, rows, own)),
            Err(d) => {
                notes.extend(d.iter().map(|d| format!("left out: {}", d.message)));
                wrong.extend(d);
            }
        }
    }
    if done.is_empty() {
        return Err(wrong);
    }
    let name = class(train.name()) + "Losses";
    let ids = identifiers(done.iter().map(|(g, ..)| g.name.as_deref().unwrap_or("gear")), RESERVED);
    let mut text = format!("record {name} {}\n", string(&super::origin(train)));
    text += "  // for Modelica.Mechanics.Rotational.Components.LossyGear: flange_a is the input, flange_b the output\n";
    text += "  // columns of lossTable: |w_a| rad/s, eta_mf1, eta_mf2, |tau_bf1| N.m, |tau_bf2| N.m\n";
    for ((gear, rows, own), id) in done.iter().zip(&ids) {
        let suffix = if gear.name.is_some() { format!("_{}", id.trim_start_matches('x')) } else { String::new() };
        text.push('\n');
        for note in own {
            text += &format!("  // {}\n", line(note));
        }
        text += &format!(
            "  constant Real ratio{suffix} = {} {};\n",
            gear.exact.trim_end_matches("/1"),
            string(&format!("{}: w of {} over w of {}", gear.title(), gear.input, gear.output))
        );
        let table: Vec<String> = rows
            .iter()
            .map(|r| [r.speed, r.eta[0], r.eta[1], r.bearing[0], r.bearing[1]].map(number).join(", "))
            .collect();
        text += &format!("  constant Real lossTable{suffix}[:, 5] = [{}];\n", table.join(";\n    "));
        notes.extend(own.iter().cloned());
    }
    text += &format!("end {name};\n");
    let state = done[0].0.name.as_deref().filter(|_| done.len() == 1);
    let about = format!("{} loss table{}", done.len(), if done.len() == 1 { "" } else { "s" });
    Ok(Export::new(vec![ExportedFile { name: file(train.name(), state, "mo"), text, about }], notes))
}

fn rows(gear: &Gear, notes: &mut Vec<String>) -> Result<Vec<Row>, Diagnostics> {
    let hint = "`csv` tells every point with its verdict";
    for (way, direction) in [("driving", &gear.drive), ("coasting", &gear.coast)] {
        if direction.efficiency.is_none() && !gear.is_physical() {
            let why = direction.reason.as_deref().unwrap_or("no single answer");
            return Err(
                gear.refuse(format!("{way}: {why}; LossyGear needs an efficiency above 0, and none is made up"), hint)
            );
        }
    }
    let [temperature] = gear.temperatures[..] else {
        return Err(gear.refuse("a loss table is of one oil temperature", "give one"));
    };
    if gear.speeds.iter().any(|s| s.value.sign() < 0) {
        return Err(gear.refuse("LossyGear looks at the amount of the speed", "give speeds above zero"));
    }
    if gear.signs() != [true, true] {
        return Err(gear.refuse(
            "a loss table has an efficiency driving and one coasting",
            "give torques from below to above zero, as in '-500 N m..500 N m:21'",
        ));
    }
    if !gear.is_physical() {
        // What the shift table tells, which holds at every speed and torque.
        let eta = [&gear.drive, &gear.coast].map(|d| d.efficiency.unwrap_or(1.0));
        return Ok(vec![Row { speed: 0.0, eta, bearing: [0.0; 2] }]);
    }
    let mut moving = gear.clone();
    moving.speeds.retain(|s| !s.value.is_zero());
    if moving.speeds.is_empty() {
        return Err(gear.refuse("losses of a standing gear cannot be computed", "give a speed above zero"));
    }
    let map = moving.map(temperature)?;
    if let Some(p) = map.gap() {
        return Err(moving.gap(p, hint));
    }
    let nothing = Quantity { value: Rational::ZERO, pi_power: 0, dimension: Dimension::TORQUE };
    let mut rows = Vec::new();
    for (points, speed) in map.rows.iter().zip(&moving.speeds) {
        // What is lost without torque on the input is lost in both directions; the teeth do the rest.
        let idle = moving.point(speed, &nothing, temperature)?;
        let b = idle.loss_torque().unwrap_or(0.0);
        let slope = |sign: f64| {
            let [xy, xx] = line_of(points, gear.ratio, sign)
                .iter()
                .fold([0.0; 2], |[xy, xx], [x, y]| [xy + x * (y + b), xx + x * x]);
            (xx > 0.0).then_some(xy / xx)
        };
        let (Some(drive), Some(coast)) = (slope(1.0), slope(-1.0)) else {
            let at = format!("{} rpm", short(points[0].speed_rpm));
            return Err(gear.refuse(
                format!("at {at} no torque of the range drives a load both ways: the losses take all"),
                "give larger torques",
            ));
        };
        rows.push(Row { speed: points[0].speed_rad_s, eta: [drive.min(1.0), (1.0 / coast).min(1.0)], bearing: [b; 2] });
    }
    let (miss, at) = misfit(&map, &rows, gear.ratio);
    notes.push(format!(
        "{}: two lines a speed stand for the computed losses; the output torque differs by at most {} of its largest, \
         at {at}",
        gear.title(),
        percent(miss)
    ));
    notes.push(format!(
        "{}: the row of speed 0 repeats that of {} rpm, the lowest computed",
        gear.title(),
        short(map.rows[0][0].speed_rpm)
    ));
    rows.insert(0, Row { speed: 0.0, ..rows[0] });
    Ok(rows)
}

/// Input torque and output torque over the ratio, where one end drives the other.
fn line_of(points: &[super::Point], ratio: f64, sign: f64) -> Vec<[f64; 2]> {
    let drives = |p: &&super::Point| p.torque_n_m * sign > 0.0 && p.answer.is_some_and(|a| a.efficiency.is_some());
    let pair = |p: &super::Point| p.answer.map(|a| [p.torque_n_m, -a.output_torque_n_m / ratio]);
    points.iter().filter(drives).filter_map(pair).collect()
}

/// The largest difference of the output torque over the largest output torque, and where.
fn misfit(map: &Map, rows: &[Row], ratio: f64) -> (f64, String) {
    let mut worst = (0.0, String::from("no point"));
    let mut largest = 0.0f64;
    for (points, row) in map.rows.iter().zip(rows) {
        for p in points {
            let Some(a) = p.answer else { continue };
            let ours = -a.output_torque_n_m / ratio;
            largest = largest.max(ours.abs());
            let miss = (row.out(p.torque_n_m) - ours).abs();
            // Where the lines fit, rounding has no place.
            if miss > worst.0 + 1e-12 * ours.abs() {
                worst = (miss, format!("{} rpm and {} N m", short(p.speed_rpm), short(p.torque_n_m)));
            }
        }
    }
    (worst.0 / largest.max(f64::MIN_POSITIVE), worst.1)
}
