//! Trains that benchmarks and tests share.
#![allow(dead_code, reason = "each program uses its own")]

use willis::train::Train;

/// Scenario `pulses`, 20 s: a planetary set whose ring brake slips twice a period.
pub const SET: &str = r#"
format = 1
name = "planetary set with a slipping ring brake"
members = ["sun", "ring", "carrier"]
terminals = ["sun", "carrier"]
inertias = { sun = "0.05 kg m^2", ring = "0.2 kg m^2", carrier = "0.4 kg m^2" }

[[set]]
name = "P"
sun = { member = "sun", teeth = 30 }
planet = { teeth = 20, count = 4 }
ring = { member = "ring", teeth = 70 }
carrier = "carrier"
mesh_efficiency = { external = 0.985, internal = 0.99 }

[[shift_element]]
name = "brake"
kind = "brake"
members = ["ring"]
capacity = "400 N m"

[[drag]]
name = "bearing"
members = ["carrier"]
coulomb = "0.5 N m"
viscous = "3 N m s/rad"

[[scenario]]
name = "pulses"
duration = "20 s"
initial_speeds = { sun = "100 rad/s", carrier = "0 rad/s" }

[[scenario.source]]
name = "engine"
member = "sun"
torque = { type = "sine", offset = "60 N m", amplitude = "200 N m", frequency = "2 Hz" }

[[scenario.engagement]]
element = "brake"
value = 1
"#;

/// What the eight-speed automatic of the examples lacks to move: scenario `through the gears`, 16 s.
const INERTIAS: &str = r#"
[inertias]
s12 = "0.02 kg m^2"
r1 = "0.02 kg m^2"
c1r4 = "0.03 kg m^2"
input = "0.05 kg m^2"
r2s3 = "0.02 kg m^2"
r3s4 = "0.02 kg m^2"
c3 = "0.03 kg m^2"
output = "20 kg m^2"

[[set]]"#;

const SCENARIO: &str = r#"
[[scenario]]
name = "through the gears"
duration = "16 s"
gears = [["0 s", "1"], ["2 s", "2"], ["4 s", "3"], ["6 s", "4"], ["8 s", "5"], ["10 s", "6"], ["12 s", "7"], ["14 s", "8"]]

[[scenario.source]]
name = "engine"
member = "input"
torque = "150 N m"

[[scenario.source]]
name = "road"
member = "output"
quadratic = { torque = "-20 N m", factor = "0.02 N m s^2/rad^2" }
"#;

/// The set.
pub fn set() -> Train {
    Train::from_toml(SET).unwrap()
}

/// The text of the automatic.
pub fn automatic_text() -> String {
    let text = include_str!("../../../../examples/zf-8hp70.toml")
        .replacen("[[set]]", INERTIAS, 1)
        .replace("external = 0.98,", "external = 0.985,")
        .replace("kind = \"brake\"", "kind = \"brake\"\ncapacity = \"2000 N m\"")
        .replace("kind = \"clutch\"", "kind = \"clutch\"\ncapacity = \"2000 N m\"");
    text + SCENARIO
}

/// The automatic.
pub fn automatic() -> Train {
    Train::from_toml(&automatic_text()).unwrap()
}

/// The texts of nine automatics, each with two levels of loss.
pub fn automatics() -> Vec<String> {
    let texts = [
        include_str!("../../../../examples/simpson-ford-c4.toml"),
        include_str!("../../../../examples/zf-4hp22.toml"),
        include_str!("../../../../examples/zf-5hp24.toml"),
        include_str!("../../../../examples/mercedes-w5a580.toml"),
        include_str!("../../../../examples/zf-8hp-gen4.toml"),
        include_str!("../../../../examples/mercedes-9g-tronic.toml"),
        include_str!("../../../../examples/ford-10r80.toml"),
        include_str!("../../../../examples/aisin-tl-80sn.toml"),
        include_str!("../../../../examples/aisin-ab80.toml"),
    ];
    let more_loss = |text: &str| {
        text.replace("basic_efficiency = 0.98", "basic_efficiency = 0.97").replace("external = 0.98", "external = 0.97")
    };
    texts.iter().flat_map(|text| [text.to_string(), more_loss(text)]).collect()
}

/// A stage with teeth, bearings, seals and windage, and the axes of a map of it.
pub const STAGE: &str = include_str!("../../../../examples/fva-planetary-stage.toml");

/// The automatic with a drag on each shaft.
pub fn automatic_with_drags() -> String {
    let mut text = include_str!("../../../../examples/zf-8hp70.toml").to_owned();
    for m in ["input", "s12", "r1", "c1r4", "r2s3", "r3s4", "c3", "output"] {
        let values = "coulomb = \"0.2 N m\"\nviscous = \"1e-3 N m s/rad\"";
        text += &format!("\n[[drag]]\nname = \"drag of {m}\"\nmembers = [\"{m}\"]\n{values}\n");
    }
    text
}

/// So many sets in series: the ring on the frame, the carrier of one drives the sun of the next; with an operation, and a
/// scenario `run up` of one second.
pub fn chain(sets: usize) -> String {
    let name = |k: usize| format!("\"s{k}\"");
    let members: Vec<String> = (0..=sets).map(name).collect();
    let inertias: Vec<String> = (0..=sets).map(|k| format!("s{k} = \"{} kg m^2\"", 0.01 + 0.002 * k as f64)).collect();
    let mut text = format!(
        "format = 1\nname = \"sets in series\"\nmembers = [{}]\nterminals = [\"s0\", \"s{sets}\"]\ninput = \"s0\"\n\
         output = \"s{sets}\"\ninertias = {{ {} }}\n",
        members.join(", "),
        inertias.join(", ")
    );
    for k in 0..sets {
        // Ratios near two and three in turn, so that the figures of long chains stay in range.
        let (sun, ring) = if k % 2 == 0 { (40, 41 + k % 5) } else { (30, 61 + k % 7) };
        text += &format!(
            "\n[[set]]\nname = \"P{k}\"\nsun = {{ member = \"s{k}\", teeth = {sun} }}\n\
             ring = {{ member = \"frame\", teeth = {ring} }}\ncarrier = \"s{}\"\n\
             mesh_efficiency = {{ external = 0.985, internal = 0.99 }}\n",
            k + 1
        );
    }
    text + "\n[[operation]]\nname = \"driven\"\nspeeds = { s0 = \"3000 rpm\" }\ntorques = { s0 = \"10 N m\" }\n\
         \n[[scenario]]\nname = \"run up\"\nduration = \"1 s\"\ninitial_speeds = { s0 = \"100 rad/s\" }\n\
         \n[[scenario.source]]\nname = \"engine\"\nmember = \"s0\"\ntorque = \"10 N m\"\n"
}
