//! Trains of which figures are made.

use willis::losses::entries;
use willis::model::Model;
use willis::train::{OperationSpec, SetSpec, Train};
use willis::units::{AngularSpeed, Torque};

use crate::common::{Dice, example, folder};

/// An example with the files that it names.
pub fn model(name: &str) -> Model {
    let mut load = |file: &str| std::fs::read_to_string(folder().join(file)).map_err(|e| e.to_string());
    Model::read(&example(name), &mut load).unwrap_or_else(|wrong| panic!("{name}: {wrong}"))
}

/// Name and train of every example, with the files that it names.
pub fn examples() -> Vec<(String, Train)> {
    let all = crate::common::examples().into_iter().map(|(name, _)| name);
    all.map(|name| (name.clone(), model(&name).train().clone())).collect()
}

/// Every name that the file of a train gives to something.
pub fn names(train: &Train) -> Vec<&str> {
    (train.members().iter().map(|m| m.name.as_str()))
        .chain(train.meshes().iter().map(|m| m.name.as_str()))
        .chain(train.sets().iter().map(|s| s.name.as_str()))
        .chain(train.shift_elements().iter().map(|e| e.name.as_str()))
        .chain(train.variators().iter().map(|v| v.name.as_str()))
        .chain(train.states().iter().map(|s| s.name.as_str()))
        .chain(train.operations().iter().map(|o| o.name.as_str()))
        .chain(train.scenarios().iter().map(|s| s.name.as_str()))
        .chain([train.name()])
        .collect()
}

/// What of a text for readers is a key of files or answers, or a mark of code.
pub fn code_in(text: &str, names: &[&str]) -> Option<String> {
    if text.contains('`') {
        return Some("`".to_owned());
    }
    let apart = |c: char| !(c.is_alphanumeric() || c == '_' || c == '-');
    // Names of laws in files are those of people, written small; but for some that are plain words.
    const WORDS: [&str; 7] = ["constant", "none", "stiffness", "equal", "uniform", "integrated", "displacement"];
    let law = |w: &str| !WORDS.contains(&w) && entries().iter().any(|e| e.id == w);
    let key = |w: &&str| {
        let mut parts = w.trim_matches('_').split('_');
        law(w)
            || parts.clone().count() > 1 && parts.all(|p| !p.is_empty() && p.chars().all(|c| c.is_ascii_alphanumeric()))
    };
    let named = |w: &&str| names.iter().any(|n| n.split(apart).any(|own| own == *w));
    text.split(apart).filter(key).find(|w| !named(w)).map(str::to_owned)
}

/// Up to four stepped sets on a few shafts under one load, the same for the same seed; many of them recirculate. None
/// where chance puts together what is no train.
pub fn stepped(seed: u64) -> Option<Train> {
    let mut dice = Dice(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(1));
    let k = 1 + dice.below(4) as usize;
    let all: Vec<String> = (0..k + 2).map(|m| format!("shaft {m}")).collect();
    let mut b = Train::builder("random").members(all.iter().map(String::as_str)).terminals([&*all[0], &*all[1]]);
    for j in 0..k {
        let mut own: Vec<usize> = (0..k + 2).collect();
        let [x, y, c] = [0; 3].map(|_| own.remove(dice.below(own.len() as u64) as usize));
        let [zx, zy, p, q] = [90, 90, 60, 60].map(|high| dice.whole(12, high - 1));
        let set = SetSpec::stepped(format!("P{j}"), &all[c]).sun(&all[x], zx, p);
        let set = if dice.below(2) == 0 { set.ring(&all[y], zy + q, q) } else { set.sun(&all[y], zy, q) };
        b = b.set(set.mesh_efficiency(0.9 + dice.below(100) as f64 / 1000.0));
    }
    let load = OperationSpec::new("load").speed(&all[0], AngularSpeed::rpm(1000.0)).torque(&all[0], Torque::n_m(100.0));
    b.operation(load.fixed(&all[k + 1])).build().ok()
}

/// Trains that the examples lack and that have spoilt pictures: many levers, many states, large and small numbers, ordinary
/// pairs, states that disagree about the input.
pub fn hard() -> Vec<(&'static str, Model)> {
    let all = [
        ("five sets", five_sets()),
        ("wind gearbox", WIND.to_owned()),
        ("twelve planets", TWELVE.to_owned()),
        ("wilson", WILSON.to_owned()),
        ("heavy", heavy("12345678 N m")),
        ("tiny", heavy("0.00001234 N m")),
        ("pairs", PAIRS.to_owned()),
        ("two inputs", TWO_INPUTS.to_owned()),
    ];
    all.map(|(name, text)| (name, Model::from_toml(&text).unwrap_or_else(|wrong| panic!("{name}: {wrong}")))).into()
}

/// Two sets under a load that no gearbox has.
fn heavy(torque: &str) -> String {
    format!(
        r#"
        format = 1
        name = "Two sets under {torque}"
        members = ["in", "mid", "out"]
        terminals = ["in", "out"]
        [[set]]
        name = "P1"
        sun = {{ member = "in", teeth = 19 }}
        planet = {{ teeth = 31, count = 3 }}
        ring = {{ member = "frame", teeth = 83 }}
        carrier = "mid"
        mesh_efficiency = 0.987
        [[set]]
        name = "P2"
        sun = {{ member = "mid", teeth = 23 }}
        planet = {{ teeth = 31, count = 3 }}
        ring = {{ member = "frame", teeth = 85 }}
        carrier = "out"
        mesh_efficiency = 0.987
        [[operation]]
        name = "load"
        speeds = {{ in = "98765 rpm" }}
        torques = {{ in = "{torque}" }}
        "#
    )
}

/// Five sets in a row, each with a brake on its ring, and a clutch that bridges each: ten states of fifteen members.
fn five_sets() -> String {
    let mut text = String::from("format = 1\nname = \"Five sets, ten gears\"\nmembers = [\"n0\"");
    for k in 1..=5 {
        text += &format!(", \"n{k}\", \"r{k}\"");
    }
    text += "]\nterminals = [\"n0\", \"n5\"]\n";
    for k in 1..=5 {
        let (sun, ring) = (28 + k, 70 + k);
        let before = k - 1;
        text += &format!(
            "[[set]]\nname = \"P{k}\"\nsun = {{ member = \"n{before}\", teeth = {sun} }}\nplanet = {{ teeth = 21, count = 4 }}\n\
             ring = {{ member = \"r{k}\", teeth = {ring} }}\ncarrier = \"n{k}\"\nmesh_efficiency = 0.985\n\
             [[shift_element]]\nname = \"B{k}\"\nkind = \"brake\"\nmembers = [\"r{k}\"]\n\
             [[shift_element]]\nname = \"K{k}\"\nkind = \"clutch\"\nmembers = [\"r{k}\", \"n{k}\"]\n"
        );
    }
    for (k, held) in [31, 30, 28, 24, 16, 27, 9, 5, 1, 0].into_iter().enumerate() {
        let engaged: Vec<String> =
            (1..=5).map(|s| format!("\"{}{s}\"", if held >> (s - 1) & 1 == 1 { "B" } else { "K" })).collect();
        text += &format!("[[state]]\nname = \"{}\"\nengaged = [{}]\n", k + 1, engaged.join(", "));
    }
    text
}

/// Two planetary stages and a pair, megawatts.
const WIND: &str = r#"
format = 1
name = "Wind turbine gearbox, two planetary stages and a pair"
members = ["rotor", "shaft-1", "shaft-2", "generator"]
terminals = ["rotor", "generator"]
[[set]]
name = "stage 1"
sun = { member = "shaft-1", teeth = 21 }
planet = { teeth = 39, count = 3 }
ring = { member = "frame", teeth = 99 }
carrier = "rotor"
mesh_efficiency = 0.995
[[set]]
name = "stage 2"
sun = { member = "shaft-2", teeth = 23 }
planet = { teeth = 46, count = 3 }
ring = { member = "frame", teeth = 115 }
carrier = "shaft-1"
mesh_efficiency = 0.995
[[mesh]]
name = "stage 3"
gears = [{ member = "shaft-2", teeth = 103 }, { member = "generator", teeth = 29 }]
efficiency = 0.99
[[operation]]
name = "rated"
speeds = { rotor = "10 rpm" }
powers = { rotor = "6 MW" }
"#;

const TWELVE: &str = r#"
format = 1
name = "Twelve planets"
members = ["sun", "ring", "carrier"]
terminals = ["sun", "carrier"]
[[set]]
name = "P1"
sun = { member = "sun", teeth = 96 }
planet = { teeth = 20, count = 12 }
ring = { member = "ring", teeth = 136 }
carrier = "carrier"
mesh_efficiency = 0.99
geometry = { module = "2 mm", width = "30 mm" }
[[shift_element]]
name = "hold"
kind = "brake"
members = ["ring"]
[[state]]
name = "held"
engaged = ["hold"]
[[operation]]
name = "load"
state = "held"
speeds = { sun = "2000 rpm" }
torques = { sun = "100 N m" }
"#;

/// A preselector: every brake holds what drives the set before.
const WILSON: &str = r#"
format = 1
name = "Wilson preselector, three gears of it"
members = ["input", "r1", "r2", "s3", "output"]
terminals = ["input", "output"]
[[set]]
name = "first"
sun = { member = "input", teeth = 24 }
planet = { teeth = 24, count = 3 }
ring = { member = "r1", teeth = 72 }
carrier = "output"
mesh_efficiency = 0.985
[[set]]
name = "second"
sun = { member = "input", teeth = 30 }
planet = { teeth = 21, count = 3 }
ring = { member = "r2", teeth = 72 }
carrier = "r1"
mesh_efficiency = 0.985
[[set]]
name = "third"
sun = { member = "s3", teeth = 26 }
planet = { teeth = 22, count = 3 }
ring = { member = "r1", teeth = 70 }
carrier = "r2"
mesh_efficiency = 0.985
[[shift_element]]
name = "B1"
kind = "brake"
members = ["r1"]
[[shift_element]]
name = "B2"
kind = "brake"
members = ["r2"]
[[shift_element]]
name = "B3"
kind = "brake"
members = ["s3"]
[[shift_element]]
name = "K"
kind = "clutch"
members = ["s3", "input"]
[[state]]
name = "1"
engaged = ["B1"]
[[state]]
name = "2"
engaged = ["B2"]
[[state]]
name = "3"
engaged = ["B3"]
[[state]]
name = "direct"
engaged = ["K"]
"#;

/// Ordinary pairs of very different sizes, in a row and side by side.
const PAIRS: &str = r#"
format = 1
name = "Countershaft"
members = ["input", "counter", "g1", "g2", "output"]
terminals = ["input", "output"]
[[mesh]]
name = "constant"
gears = [{ member = "input", teeth = 17 }, { member = "counter", teeth = 41 }]
efficiency = 0.99
[[mesh]]
name = "low"
gears = [{ member = "counter", teeth = 11 }, { member = "g1", teeth = 38 }]
efficiency = 0.99
[[mesh]]
name = "high"
gears = [{ member = "counter", teeth = 33 }, { member = "g2", teeth = 16 }]
efficiency = 0.99
[[shift_element]]
name = "L"
kind = "clutch"
members = ["g1", "output"]
[[shift_element]]
name = "H"
kind = "clutch"
members = ["g2", "output"]
[[state]]
name = "low"
engaged = ["L"]
[[state]]
name = "high"
engaged = ["H"]
[[operation]]
name = "load"
state = "low"
speeds = { input = "1500 rpm" }
torques = { input = "80 N m" }
"#;

/// The second state is driven from the other end.
const TWO_INPUTS: &str = r#"
format = 1
name = "Engine or starter drives"
members = ["engine", "starter", "wheels", "ring"]
terminals = ["starter", "engine", "wheels"]
input = "engine"
output = "wheels"
[[set]]
name = "P1"
sun = { member = "starter", teeth = 30 }
planet = { teeth = 20, count = 4 }
ring = { member = "ring", teeth = 70 }
carrier = "wheels"
mesh_efficiency = 0.985
[[shift_element]]
name = "B"
kind = "brake"
members = ["ring"]
[[shift_element]]
name = "E"
kind = "clutch"
members = ["engine", "ring"]
[[shift_element]]
name = "S"
kind = "brake"
members = ["starter"]
[[state]]
name = "start"
engaged = ["B"]
input = "starter"
output = "wheels"
[[state]]
name = "drive"
engaged = ["E", "S"]
input = "engine"
output = "wheels"
"#;
