//! Joint actuator of Drake, as a transmission of a URDF.
//!
//! Sources: Drake, `multibody/parsing/parsing_doxygen.h` (custom elements need `xmlns:drake="http://drake.mit.edu"`;
//! `drake:gear_ratio` and `drake:rotor_inertia`, each with an attribute `value`, in the actuator of a transmission) and
//! its `multibody/parsing/test/detail_urdf_parser_test.cc`, class ReflectedInertiaTest; `multibody/tree/
//! joint_actuator.h`, section "Reflected Inertia": the ratio is `ρ = wR/wB`, rotor over output shaft, and the joint
//! gets the inertia `ρ² I_rotor` ("and any additional shafts/gears"). The ratio does nothing else: actuation is the
//! torque on the joint, and there is no efficiency. Both are told as comments.

use crate::diagnostic::Diagnostics;
use crate::train::Train;

use super::map::Gear;
use super::mujoco::both;
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
    let [forward, backward] = [(found.drive, &found.why[0]), (found.coast, &found.why[1])]
        .map(|(x, why)| x.map_or_else(|| format!("none: {why}"), number));
    own.push(format!("{}: efficiency_forward {forward}", gear.title()));
    own.push(format!("{}: efficiency_backward {backward}", gear.title()));
    own.push(format!(
        "{}: Drake's actuation is the torque on joint `{}`, behind the gear: motor torque t drives it with t*gear_ratio*\
         efficiency_forward, and holds t*gear_ratio/efficiency_backward where it is driven back",
        gear.title(),
        gear.output
    ));
    if let (Some(f), Some(b)) = (found.drive, found.coast) {
        own.push(format!(
            "{}: in Drake, by these efficiencies (one drive was run in 1.51 and agreed within 0.06 %): with \
             t*gear_ratio alone the joint gets {} too much torque where the motor drives, and {} too \
             little where it is driven back; with both efficiencies it gets that of Willis, except that the rotor's own torque \
             passes no teeth there",
            gear.title(),
            percent(1.0 / f - 1.0),
            percent(1.0 - b)
        ));
    }
    let inertia = gear.inertia_at_output().map(|j| j / (gear.ratio * gear.ratio));
    let rotor = inertia.as_ref().ok().copied();
    own.push(match &inertia {
        Ok(_) => format!(
            "{}: rotor_inertia holds every inertia of the file, reflected to {}; Drake multiplies by gear_ratio squared",
            gear.title(),
            gear.input
        ),
        Err(why) => format!("{}: no rotor_inertia: {why}", gear.title()),
    });
    let (name, joint) = (slug(train.name()), xml(&gear.output));
    let mut text = format!("<!-- {} -->\n", xml(&origin(train)));
    for note in &own {
        text += &format!("<!-- {} -->\n", xml(note));
    }
    text += &format!("<robot xmlns:drake=\"http://drake.mit.edu\" name=\"{name}\">\n");
    text += "  <!-- put the transmission into your robot: its joint must exist there -->\n  <transmission>\n";
    text += "    <type>transmission_interface/SimpleTransmission</type>\n";
    text += &format!(
        "    <joint name=\"{joint}\">\n      <hardwareInterface>EffortJointInterface</hardwareInterface>\n    </joint>\n"
    );
    text += &format!("    <actuator name=\"{name}\">\n");
    if let Some(j) = rotor {
        text += &format!("      <drake:rotor_inertia value=\"{}\"/>\n", number(j));
    }
    text += &format!("      <drake:gear_ratio value=\"{}\"/>\n", number(gear.ratio));
    text += "    </actuator>\n  </transmission>\n</robot>\n";
    notes.extend(own);
    let about = format!("{}, gear_ratio {}, {}", gear.title(), number(gear.ratio), both(found.drive, found.coast));
    Ok(ExportedFile { name: file(train.name(), gear.name.as_deref(), "urdf"), text, about })
}
