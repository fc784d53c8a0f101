//! Transmission loss maps of VECTO, the simulation tool of Regulation (EU) 2017/2400; one file (.vtlm) a gear.
//!
//! Sources: VECTO User Manual, sections "Transmission Loss Map" (header `Input Speed [rpm], Input Torque [Nm], Torque
//! Loss [Nm]`, engine side, negative torque must be there, the loss is always positive, `T_output = (T_input −
//! T_loss) r_gear` in either direction of power) and "CSV" (comma, dot, one header line first, `#` begins a comment);
//! source `VectoCore/InputData/Reader/ComponentData/TransmissionLossMapReader.cs` (three columns, at least four rows)
//! and `…/Data/Gearbox/TransmissionLossMap.cs` (0 to 10000 rpm, ±100000 N m, loss 0 to 100000 N m; the map is
//! triangulated over speed and `T_input − T_loss`, which must therefore rise with `T_input` at every speed).
//! code.europa.eu/vecto.
//!
//! VECTO asks for losses from 0 rpm on: the row of 0 rpm repeats the lowest speed that is computed. With constant
//! efficiencies that is exact.

use crate::diagnostic::Diagnostics;
use crate::train::Train;

use super::map::{Gear, Point};
use super::names::{file, number, percent, short};
use super::{Asked, Export, ExportedFile, each, origin, told};

const HEADER: &str = "Input Speed [rpm],Input Torque [Nm],Torque Loss [Nm]";
const MOST_RPM: f64 = 10_000.0;
const MOST_TORQUE: f64 = 100_000.0;

pub(super) fn write(train: &Train, request: &Asked) -> Result<Export, Diagnostics> {
    each(train, request, |gear, notes| one(train, gear, notes))
}

fn one(train: &Train, gear: &Gear, notes: &mut Vec<String>) -> Result<ExportedFile, Diagnostics> {
    if gear.ratio < 0.0 {
        return Err(gear.refuse(
            format!("ratio {}: VECTO has forward gears only", gear.exact),
            "export the forward gears, or the state as csv",
        ));
    }
    let range = |ok: bool, what: &str, hint: &str| if ok { Ok(()) } else { Err(gear.refuse(what, hint)) };
    range(
        gear.speeds.iter().all(|s| s.value.sign() >= 0 && s.si() * 30.0 / std::f64::consts::PI <= MOST_RPM * 1.000_001),
        "VECTO takes input speeds from 0 to 10000 rpm",
        "give speeds in that range",
    )?;
    range(
        gear.torques.iter().all(|t| t.si().abs() <= MOST_TORQUE),
        "VECTO takes input torques from -100000 to 100000 N m",
        "give torques in that range",
    )?;
    range(
        gear.signs() == [true, true],
        "VECTO needs driving and coasting: positive and negative input torques",
        "give torques from below to above zero, as in '-500 N m..500 N m:21'",
    )?;
    let [temperature] = gear.temperatures[..] else {
        return Err(gear.refuse("a loss map is of one oil temperature", "give one"));
    };
    let mut moving = gear.clone();
    moving.speeds.retain(|s| !s.value.is_zero());
    range(
        !moving.speeds.is_empty(),
        "a standing gear loses nothing that could be computed",
        "give a speed above zero",
    )?;
    for (way, direction) in [("driving", &gear.drive), ("coasting", &gear.coast)] {
        if direction.efficiency.is_none() && !gear.is_physical() {
            let why = direction.reason.as_deref().unwrap_or("no single answer");
            return Err(gear.refuse(
                format!("{way}: {why}; VECTO needs a loss in both directions, and none is made up"),
                "`csv` tells every point with its verdict",
            ));
        }
    }
    let map = moving.map(temperature)?;
    if let Some(p) = map.gap() {
        return Err(moving.gap(p, "leave out the points that have no answer; `csv` tells every point with its verdict"));
    }
    let loss = |p: &Point| p.loss_torque().unwrap_or(0.0).max(0.0);
    for row in &map.rows {
        for w in row.windows(2) {
            let [a, b] = [&w[0], &w[1]].map(|p| p.torque_n_m - loss(p));
            if b <= a {
                return Err(gear.refuse(
                    format!(
                        "at {} rpm more input torque than {} N m gives no more output torque: VECTO cannot invert that",
                        short(w[0].speed_rpm),
                        short(w[0].torque_n_m)
                    ),
                    "give torques farther apart",
                ));
            }
        }
    }
    notes.extend(told(gear));
    notes.extend(gear.chosen.iter().cloned());
    let low = &map.rows[0][0];
    let constant = !gear.is_physical();
    notes.push(match constant {
        true => format!(
            "{}: the loss is a constant share of the torque: the map has no losses without load (bearings, oil, open \
             clutches)",
            gear.title()
        ),
        false => format!(
            "{}: the row of 0 rpm repeats that of {} rpm, the lowest computed",
            gear.title(),
            short(low.speed_rpm)
        ),
    });
    let mut text = format!("{HEADER}\n# {}\n", origin(train));
    let mut about = format!("{}, gear ratio {}", gear.title(), number(gear.ratio));
    text +=
        &format!("# {}: ratio {} = {} (input speed over output speed)\n", gear.title(), gear.exact, number(gear.ratio));
    text +=
        &format!("# input: {}, output: {}; output torque = (input torque - loss) * ratio\n", gear.input, gear.output);
    text += "# positive input torque drives, negative input torque coasts; the loss is never negative\n";
    if let (true, Some(oil)) = (gear.is_physical(), train.lubrication()) {
        text += &format!("# oil temperature {} degC\n", short(temperature.unwrap_or(oil.temperature) - 273.15));
    }
    if constant {
        let [drive, coast] = [&gear.drive, &gear.coast].map(|d| d.efficiency.map_or("-".into(), percent));
        text += &format!(
            "# efficiency driving {drive}, coasting {coast}, at every speed and torque; no losses without load\n"
        );
        about += &format!(", {drive} driving, {coast} coasting");
    } else {
        text += &format!("# the rows of 0 rpm repeat those of {} rpm\n", short(low.speed_rpm));
    }
    let zero = Some((0.0, &map.rows[0])).into_iter();
    for (speed, row) in zero.chain(map.rows.iter().map(|r| (r[0].speed_rpm, r))) {
        for p in row {
            text += &format!("{},{},{}\n", number(speed), number(p.torque_n_m), number(loss(p)));
        }
    }
    let name = file(train.name(), gear.name.as_deref(), "vtlm");
    Ok(ExportedFile { name, text, about })
}
