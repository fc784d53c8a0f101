//! Efficiencies for gear blocks of Simscape Driveline, as a MATLAB script that fills a structure.
//!
//! Sources: MathWorks, Simscape Driveline reference pages "Simple Gear" (base B, follower F, `g_FB = N_F/N_B`; meshing
//! losses constant, load-dependent or temperature-dependent), "Planetary Gear", "Sun-Planet", "Ring-Planet" (ratio
//! `N_R/N_S`; ordinary efficiencies of sun-planet and ring-planet, seen with the carrier held, one number for both
//! directions), "Model Gears with Losses", "Simple Gear with Variable Efficiency" (efficiency as a signal);
//! MATLAB Answers 478236 for the load-dependent law, `η = T_F/(g_FB T_idle + (k + 1) T_F)`, which is `T_B = T_idle +
//! (k + 1) T_F/g_FB`; Powertrain Blockset "Gearbox" for a table over torque, speed and temperature.
//!
//! A field without an answer (a lock) is not written: a script that needs it stops there.

use crate::diagnostic::Diagnostics;
use crate::train::{Mesh, Train};

use super::map::{Gear, Map, Point};
use super::names::{file, identifier, identifiers, line, number, percent, short, slug};
use super::single::single;
use super::{Asked, Export, ExportedFile, map, origin, told};

const RESERVED: &[&str] = &[
    "break",
    "case",
    "catch",
    "classdef",
    "continue",
    "else",
    "elseif",
    "end",
    "for",
    "function",
    "global",
    "if",
    "otherwise",
    "parfor",
    "persistent",
    "return",
    "spmd",
    "switch",
    "try",
    "while",
];

pub(super) fn write(train: &Train, request: &Asked) -> Result<Export, Diagnostics> {
    let (gears, mut notes) = map::gears(train, request)?;
    let root = identifier(&slug(train.name()), RESERVED);
    let ids = identifiers(gears.iter().map(|g| g.name.as_deref().unwrap_or("gear")), RESERVED);
    let mut text = format!("% {}\n", origin(train));
    text += "% Simple Gear: base B is the input, follower F the output; torques N m, speeds rad/s, temperatures K\n";
    text += &format!("{root} = struct();\n");
    for (gear, id) in gears.iter().zip(&ids) {
        let own =
            if gear.name.is_some() { format!("{root}.state_{}", id.trim_start_matches('x')) } else { root.clone() };
        let mut told = told(gear);
        let body = one(gear, &own, &mut told)?;
        text.push('\n');
        for note in &told {
            text += &format!("% {}\n", line(note));
        }
        text += &body;
        notes.extend(told);
    }
    let state = request.state.as_deref().filter(|_| gears.len() == 1);
    let s = if gears.len() == 1 { "" } else { "s" };
    let about = format!("{} gear{s} in {root}", gears.len());
    // A script is called by its name, which must be one.
    let name = file(train.name(), state, "m").replace('-', "_");
    Ok(Export::new(vec![ExportedFile { name, text, about }], notes))
}

/// A row vector.
fn vector(all: impl IntoIterator<Item = f64>) -> String {
    format!("[{}]", all.into_iter().map(number).collect::<Vec<_>>().join(" "))
}

fn one(gear: &Gear, own: &str, told: &mut Vec<String>) -> Result<String, Diagnostics> {
    let mut text = String::new();
    let mut set = |field: &str, value: String, about: &str| text += &format!("{own}.{field} = {value}; % {about}\n");
    set("ratio", number(gear.ratio), "input over output speed");
    set("follower_base_ratio", number(gear.ratio.abs()), "Follower (F) to base (B) teeth ratio (NF/NB)");
    let same = gear.ratio > 0.0;
    set("same_direction", same.to_string(), "Output shaft rotates in the same direction as input shaft");
    if !gear.is_physical() {
        let found = single(gear)?;
        for (field, x, why, about) in [
            ("efficiency_base_follower", found.drive, &found.why[0], "Simple Gear, constant efficiency, B drives F"),
            ("efficiency_follower_base", found.coast, &found.why[1], "F drives B"),
        ] {
            match x {
                Some(x) => set(field, number(x), about),
                None => told.push(format!("{}: no {field}: {why}", gear.title())),
            }
        }
        return Ok(text + &sets(gear, own, None, told));
    }
    let mut moving = gear.clone();
    moving.speeds.retain(|s| s.value.sign() > 0);
    let (Some((speed, torque)), false) = (moving.rated(false), moving.speeds.is_empty()) else {
        let hint = "give speeds and torques above zero";
        return Err(gear.refuse("efficiencies need a driving torque at a speed", hint));
    };
    let mut maps = Vec::new();
    let mut nominal = Vec::new();
    for t in &moving.temperatures {
        maps.push(moving.map(*t)?);
        let driving = moving.point(&speed, &torque, *t)?;
        let coasting = match moving.rated(true) {
            Some((w, torque)) => Some(moving.point(&w, &torque, *t)?),
            None => None,
        };
        nominal.push([Some(driving), coasting]);
    }
    let temperature =
        |t: Option<f64>| t.or_else(|| gear.train().lubrication().map(|l| l.temperature)).unwrap_or(293.15);
    let temperatures: Vec<f64> = moving.temperatures.iter().map(|t| temperature(*t)).collect();
    let eta = |p: &Option<Point>| p.as_ref().and_then(|p| p.answer?.efficiency);
    set("temperature", vector(temperatures.iter().copied()), "of the oil; the block's is that of its thermal port");
    for (k, field, about) in [
        (0, "efficiency_base_follower", "temperature-dependent efficiency, B drives F, at the nominal point"),
        (1, "efficiency_follower_base", "temperature-dependent efficiency, F drives B"),
    ] {
        match nominal.iter().map(|n| eta(&n[k])).collect::<Option<Vec<f64>>>() {
            Some(all) => set(field, vector(all), about),
            None => {
                let why = nominal[0][k].as_ref().and_then(|p| p.reason.clone()).unwrap_or("no such torque".into());
                told.push(format!("{}: no {field}: {why}", gear.title()));
            }
        }
    }
    let at = format!("{} rpm and {} N m at {}", short(map::rpm(&speed)), short(torque.si()), gear.input);
    told.push(format!(
        "{}: nominal point: {at}; constant and temperature-dependent efficiencies hold there only",
        gear.title()
    ));
    match idle(&maps[0], gear.ratio.abs()) {
        Some((nominal, eta, idle, miss)) => {
            set("nominal_output_torque", number(nominal), "load-dependent efficiency: Nominal output torque");
            set("efficiency_nominal", number(eta), "Efficiency at nominal output torque");
            set("no_load_torque", number(idle), "Input shaft torque at no load");
            told.push(format!(
                "{}: load-dependent efficiency is fitted at the largest speed; the input torque differs by at most {}",
                gear.title(),
                percent(miss)
            ));
        }
        None => told.push(format!("{}: no load-dependent efficiency: too few driving torques", gear.title())),
    }
    // The table takes torques that have an efficiency at every speed and temperature.
    let columns = maps[0].rows[0].len();
    let whole: Vec<usize> = (0..columns)
        .filter(|&k| maps.iter().all(|m| m.rows.iter().all(|r| r[k].answer.is_some_and(|a| a.efficiency.is_some()))))
        .collect();
    if whole.len() < columns {
        let gone: Vec<String> =
            (0..columns).filter(|k| !whole.contains(k)).map(|k| short(maps[0].rows[0][k].torque_n_m)).collect();
        told.push(format!(
            "{}: left out of the table, having no efficiency at some speed (nothing arrives, or no answer): {} N m",
            gear.title(),
            gone.join(", ")
        ));
    }
    if !whole.is_empty() {
        set(
            "table.torque",
            vector(whole.iter().map(|&k| maps[0].rows[0][k].torque_n_m)),
            "of B, negative where F drives",
        );
        set("table.speed", vector(maps[0].rows.iter().map(|r| r[0].speed_rad_s)), "of B");
        for (n, m) in maps.iter().enumerate() {
            let rows: Vec<String> = whole
                .iter()
                .map(|&k| {
                    let row =
                        m.rows.iter().map(|r| r[k].answer.and_then(|a| a.efficiency).map_or("NaN".into(), number));
                    row.collect::<Vec<_>>().join(" ")
                })
                .collect();
            let about = "torque by speed; a lookup table for Simple Gear with Variable Efficiency";
            set(&format!("table.efficiency(:,:,{})", n + 1), format!("[{}]", rows.join("; ")), about);
        }
    }
    let point = nominal[0][0].as_ref();
    Ok(text + &sets(gear, own, point, told))
}

/// Nominal output torque, efficiency there, torque without load, and the largest relative difference of input torque.
fn idle(map: &Map, g: f64) -> Option<(f64, f64, f64, f64)> {
    let row = map.rows.last()?;
    let points: Vec<[f64; 2]> = row
        .iter()
        .filter(|p| p.torque_n_m > 0.0 && p.answer.is_some_and(|a| a.efficiency.is_some()))
        .filter_map(|p| Some([p.answer?.output_torque_n_m.abs() / g, p.torque_n_m]))
        .collect();
    if points.len() < 2 {
        return None;
    }
    let n = points.len() as f64;
    let [mx, my] = points.iter().fold([0.0; 2], |[a, b], [x, y]| [a + x / n, b + y / n]);
    let [xy, xx] = points.iter().fold([0.0; 2], |[xy, xx], [x, y]| [xy + (x - mx) * (y - my), xx + (x - mx).powi(2)]);
    let mut slope = xy / xx;
    let mut idle = my - slope * mx;
    if idle < 0.0 || slope < 1.0 {
        let [xy, xx] = points.iter().fold([0.0; 2], |[xy, xx], [x, y]| [xy + x * y, xx + x * x]);
        (slope, idle) = (xy / xx, 0.0);
    }
    let [x, _] = points[points.len() - 1];
    let miss = points.iter().fold(0.0f64, |m, [x, y]| m.max(((idle + slope * x) / y - 1.0).abs()));
    Some((x * g, x / (idle + slope * x), idle, miss))
}

/// Efficiencies of the meshes of every set: given ones, or those in force at a point.
fn sets(gear: &Gear, own: &str, point: Option<&Point>, told: &mut Vec<String>) -> String {
    let train = gear.train();
    let solution = point.and_then(|p| p.solution.as_ref());
    let mut text = String::new();
    let names = identifiers(train.sets().iter().map(|s| s.name.as_str()), RESERVED);
    let eta = |m: &Mesh| -> Option<[f64; 2]> {
        if m.computed {
            let here = solution?.meshes.get(&m.name)?.efficiency;
            return Some([here; 2]);
        }
        Some([m.efficiency.forward.to_f64(), m.efficiency.backward.to_f64()])
    };
    for (k, (s, id)) in train.sets().iter().zip(&names).enumerate() {
        let meshes: Vec<&Mesh> = train.meshes().iter().filter(|m| m.set == Some(k)).collect();
        let field = format!("{own}.sets.{id}");
        if let ("simple", [sun, ring]) = (s.kind, meshes.as_slice()) {
            let (Some(sp), Some(rp)) = (eta(sun), eta(ring)) else { continue };
            let ratio = (&ring.gears[1].teeth / &sun.gears[0].teeth).to_f64();
            text += &format!(
                "{field}.ring_sun_ratio = {}; % Planetary Gear: Ring (R) to sun (S) teeth ratio\n",
                number(ratio)
            );
            text += &format!(
                "{field}.efficiency = {}; % sun-planet and ring-planet ordinary efficiencies\n",
                vector([sp[0], rp[0]])
            );
            if [sp, rp].iter().any(|e| e[0] != e[1]) {
                told.push(format!(
                    "set {}: the block takes one efficiency for both directions; here are those of the sun driving; back \
                     they are {}",
                    s.name,
                    vector([sp[1], rp[1]])
                ));
            }
            continue;
        }
        let ids = identifiers(meshes.iter().map(|m| m.name.as_str()), RESERVED);
        for (m, id) in meshes.iter().zip(&ids) {
            let Some(e) = eta(m) else { continue };
            text +=
                &format!("{field}.{id} = {}; % {}: first gear drives, second gear drives\n", vector(e), line(&m.name));
        }
    }
    if solution.is_some() && train.meshes().iter().any(|m| m.computed) {
        told.push(format!("{}: efficiencies of sets are those of the nominal point", gear.title()));
    }
    text
}
