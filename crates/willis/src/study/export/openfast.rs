//! `GBoxEff` and `GBRatio` of OpenFAST's ElastoDyn, section DRIVETRAIN of its input file.
//!
//! Sources: OpenFAST, `docs/source/user/elastodyn/input.rst` and the r-test files `*_ElastoDyn.dat` (lines `100
//! GBoxEff     - Gearbox efficiency (%)` and `97   GBRatio     - Gearbox ratio (-)`; no line may be added or
//! removed); `modules/elastodyn/src/ElastoDyn.f90`: `GBoxEffFac = GBoxEff**SgnPrvLSTQ` with the sign of the torque of
//! the low-speed shaft, and `HSShftTq = LSShftTq*GBoxEffFac/ABS(GBRatio)`. So the efficiency is taken off where the
//! rotor drives the generator, and its inverse acts where the generator motors: one number for both directions, at
//! any speed and load, and no loss without torque.
//!
//! The low-speed shaft is the slower end of the gear, whichever of the two is its input.

use crate::diagnostic::Diagnostics;
use crate::train::Train;

use super::map::Gear;
use super::names::{file, number, percent};
use super::single::single;
use super::{Asked, Export, ExportedFile, each, origin, told};

pub(super) fn write(train: &Train, request: &Asked) -> Result<Export, Diagnostics> {
    each(train, request, |gear, notes| one(train, gear, notes))
}

fn one(train: &Train, gear: &Gear, notes: &mut Vec<String>) -> Result<ExportedFile, Diagnostics> {
    let found = single(gear)?;
    // The slower end is the rotor's.
    let slow_input = gear.ratio.abs() <= 1.0;
    let (low, high) = if slow_input { (&gear.input, &gear.output) } else { (&gear.output, &gear.input) };
    let [from, back] = if slow_input { [0, 1] } else { [1, 0] };
    let both = [found.drive, found.coast];
    let (forward, motoring) = (both[from], both[back]);
    let (why, why_motoring) = (&found.why[from], &found.why[back]);
    let Some(forward) = forward else {
        return Err(gear.refuse(
            format!("{low} (low-speed shaft) cannot drive {high}: {why}; no efficiency is made up"),
            "`csv` tells every point with its verdict",
        ));
    };
    let ratio = if slow_input { 1.0 / gear.ratio } else { gear.ratio };
    let mut own = told(gear);
    own.extend(found.notes);
    own.push(format!("{}: GBoxEff is the efficiency from {low} (LSS, rotor) to {high} (HSS, generator)", gear.title()));
    own.push(match motoring {
        Some(m) => format!(
            "{}: ElastoDyn takes the same number where the generator motors; there the gear has {}, from {high} to {low}",
            gear.title(),
            percent(m)
        ),
        None => format!(
            "{}: ElastoDyn lets the generator motor with the same number; the gear does not: from {high} to {low} {}",
            gear.title(),
            why_motoring
        ),
    });
    if ratio < 0.0 {
        own.push(format!("{}: rotor and generator turn in opposite directions; GBRatio has the amount", gear.title()));
    }
    own.push("GBoxEff acts on the torque of the low-speed shaft: HSShftTq = LSShftTq*GBoxEff/GBRatio, motoring HSShftTq = LSShftTq/GBoxEff/GBRatio".into());
    let mut text = format!("! {}\n", origin(train));
    for note in &own {
        text += &format!("! {}\n", super::names::line(note));
    }
    text += "! ElastoDyn, DRIVETRAIN: put these two in place of the two lines of the same name\n";
    for (value, name, what) in
        [(100.0 * forward, "GBoxEff", "Gearbox efficiency (%)"), (ratio.abs(), "GBRatio", "Gearbox ratio (-)")]
    {
        text += &format!("{:>20}   {name:<11} - {what}\n", number(value));
    }
    notes.extend(own);
    let about = format!("{}, {} from {low} to {high}, ratio {}", gear.title(), percent(forward), number(ratio.abs()));
    Ok(ExportedFile { name: file(train.name(), gear.name.as_deref(), "dat"), text, about })
}
