//! Actuator of MuJoCo, as a file to include.
//!
//! Sources: MuJoCo documentation, "XML Reference" 3.x: `include` (one top-level element, which is dropped),
//! `actuator/motor` with `gear` ("only the first element" counts for a joint; length and velocity of the actuator are
//! those of the joint times `gear`, and the torque on the joint is `gear` times the force), `joint/armature` (inertia
//! added to that of the joint, already reflected; actuators can carry it since 3.7.0, scaled by `gear` squared),
//! `custom/numeric` and `custom/text`
//! (user data). No attribute holds an efficiency: google-deepmind/mujoco issue 3528 ("Torque-proportional loss in
//! dcmotor") is open, and discusses a friction `mu_avg |tau| z + mu_dif tau z^2` with the torque `tau` of the motor
//! and `z` following the sign of its speed. Both efficiencies, and these two coefficients, are written as user data:
//!
//! ```text
//! mu_avg + mu_dif = 1 - efficiency_forward         the motor drives the joint
//! mu_avg - mu_dif = 1/efficiency_backward - 1      the joint drives the motor
//! ```

use crate::diagnostic::Diagnostics;
use crate::train::Train;

use super::map::Gear;
use super::names::{file, number, percent, slug, xml};
use super::single::single;
use super::{Asked, Export, ExportedFile, each, origin, told};

pub(super) fn write(train: &Train, request: &Asked) -> Result<Export, Diagnostics> {
    each(train, request, |gear, notes| one(train, gear, notes))
}

fn one(train: &Train, gear: &Gear, notes: &mut Vec<String>) -> Result<ExportedFile, Diagnostics> {
    let found = single(gear)?;
    let mut own = told(gear);
    own.extend(found.notes);
    let joint = xml(&gear.output);
    let name = slug(train.name());
    own.push(format!(
        "{}: the torque on joint `{}` is gear times the actuator's force, without loss: MuJoCo has no efficiency, it \
         stands here as user data",
        gear.title(),
        gear.output
    ));
    let mut data = Vec::new();
    let mut words = Vec::new();
    let mut direction = |key: &str, value: Option<f64>, why: &str| match value {
        Some(x) => data.push((format!("{name}/efficiency_{key}"), x)),
        None => words.push((format!("{name}/efficiency_{key}"), why.to_owned())),
    };
    direction("forward", found.drive, &found.why[0]);
    direction("backward", found.coast, &found.why[1]);
    if let (Some(f), Some(b)) = (found.drive, found.coast) {
        let [drive, coast] = [1.0 - f, 1.0 / b - 1.0];
        data.push((format!("{name}/mu_avg"), (drive + coast) / 2.0));
        data.push((format!("{name}/mu_dif"), (drive - coast) / 2.0));
        own.push(format!(
            "{}: in MuJoCo, by these efficiencies (one drive was run in 4.0.0 and agreed within 0.06 %): without the user \
             data the joint gets {} too much torque where the motor drives, and {} too \
             little where it is driven back; with force - mu_avg*|force|*z - mu_dif*force as the control, z = 1 or -1 with the \
             sign of the actuator's velocity, it gets that of Willis, except that the armature's own torque passes no teeth there",
            gear.title(),
            percent(1.0 / f - 1.0),
            percent(1.0 - b)
        ));
    } else if found.drive.is_some() {
        own.push(format!(
            "{}: {} cannot drive {}, but MuJoCo's joint would drive the motor",
            gear.title(),
            gear.output,
            gear.input
        ));
    }
    let inertia = gear.inertia_at_output();
    let armature = inertia.as_ref().ok().copied();
    match &inertia {
        Ok(_) => own.push(format!(
            "{}: armature holds every inertia of the file, reflected to {}; give joint `{}` the class `{name}`",
            gear.title(),
            gear.output,
            gear.output
        )),
        Err(why) => own.push(format!("{}: no armature: {why}", gear.title())),
    }
    let mut text = format!("<!-- {} -->\n", xml(&origin(train)));
    for note in &own {
        text += &format!("<!-- {} -->\n", xml(note));
    }
    text += "<mujocoinclude>\n";
    if let Some(j) = armature {
        text += &format!(
            "  <default>\n    <default class=\"{name}\">\n      <joint armature=\"{}\"/>\n    </default>\n  </default>\n",
            number(j)
        );
    }
    text += "  <custom>\n";
    for (key, x) in &data {
        text += &format!("    <numeric name=\"{}\" data=\"{}\"/>\n", xml(key), number(*x));
    }
    for (key, why) in &words {
        text += &format!("    <text name=\"{}\" data=\"none: {}\"/>\n", xml(key), xml(why));
    }
    text += "  </custom>\n  <actuator>\n";
    text += &format!("    <motor name=\"{name}\" joint=\"{joint}\" gear=\"{}\"/>\n", number(gear.ratio));
    text += "  </actuator>\n</mujocoinclude>\n";
    notes.extend(own);
    let about = format!("{}, gear {}, {}", gear.title(), number(gear.ratio), both(found.drive, found.coast));
    Ok(ExportedFile { name: file(train.name(), gear.name.as_deref(), "xml"), text, about })
}

/// Both efficiencies in words.
pub(super) fn both(drive: Option<f64>, coast: Option<f64>) -> String {
    let [drive, coast] = [drive, coast].map(|x| x.map_or("none".into(), percent));
    format!("{drive} forward, {coast} backward")
}
