//! What the studio shows of a train: a gear, or elements that are closed by hand, and an operating point. It becomes an entry of
//! the train file, so that the command line gives the same answer to the same text.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use serde_json::Value;
use willis::model::Model;
use willis::train::{Load, Train};
use willis::units::{self, Dimension};
use willis::unstable;

/// What is shown, as the page has it.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Point {
    /// A state of the shift table.
    pub state: Option<String>,
    /// Elements that are closed instead of those of a state.
    pub engaged: Option<Vec<String>>,
    /// Speeds of members, each with its unit.
    pub speeds: BTreeMap<String, String>,
    /// Torques on members, each with its unit.
    pub torques: BTreeMap<String, String>,
    /// Powers at members, each with its unit.
    pub powers: BTreeMap<String, String>,
    /// Members that are held.
    pub fixed: Vec<String>,
    /// What else an operation of the file says, such as the power of a store.
    pub more: BTreeMap<String, Value>,
}

/// The entries of a train file that a point stands for, and what they are called.
pub struct Entries {
    /// The text that follows the train file.
    pub text: String,
    /// The operation, where there is one.
    pub operation: Option<String>,
    /// The state.
    pub state: Option<String>,
}

/// A name that none of the others is.
fn unused<'a>(wanted: &str, others: impl Iterator<Item = &'a str>) -> String {
    let others: Vec<&str> = others.collect();
    let numbered = (2..).map(|k| format!("{wanted} {k}"));
    std::iter::once(wanted.to_owned())
        .chain(numbered)
        .find(|n| !others.contains(&n.as_str()))
        .expect("numbers do not end")
}

/// JSON's quotes are TOML's.
fn quoted(text: &str) -> String {
    Value::from(text).to_string()
}

fn list(all: &[String]) -> String {
    all.iter().map(|s| quoted(s)).collect::<Vec<_>>().join(", ")
}

fn table(all: &BTreeMap<String, String>) -> String {
    let one = |(name, value): (&String, &String)| format!("{} = {}", quoted(name), quoted(value));
    all.iter().map(one).collect::<Vec<_>>().join(", ")
}

/// A value of JSON as one of TOML.
fn inline(value: &Value) -> String {
    match value {
        Value::Array(all) => format!("[{}]", all.iter().map(inline).collect::<Vec<_>>().join(", ")),
        Value::Object(all) => {
            let one = |(key, value): (&String, &Value)| format!("{} = {}", quoted(key), inline(value));
            format!("{{ {} }}", all.iter().map(one).collect::<Vec<_>>().join(", "))
        }
        other => other.to_string(),
    }
}

impl Point {
    /// The entries that it stands for in the file of a train.
    pub fn entries(&self, model: &Model) -> Entries {
        let train = model.train();
        let mut text = String::new();
        let mut state = self.state.clone();
        if let Some(engaged) = &self.engaged {
            let name = unused("tried", train.states().iter().map(|s| s.name.as_str()));
            text += &format!("\n[[state]]\nname = {}\nengaged = [{}]\n", quoted(&name), list(engaged));
            state = Some(name);
        }
        let mut operation = None;
        let given = [&self.speeds, &self.torques, &self.powers].iter().any(|all| !all.is_empty());
        if given || !self.fixed.is_empty() {
            let name = unused("point", train.operations().iter().map(|o| o.name.as_str()));
            text += &format!("\n[[operation]]\nname = {}\n", quoted(&name));
            if let Some(state) = &state {
                text += &format!("state = {}\n", quoted(state));
            }
            text += &format!("speeds = {{ {} }}\n", table(&self.speeds));
            if !self.fixed.is_empty() {
                text += &format!("fixed = [{}]\n", list(&self.fixed));
            }
            for (key, all) in [("torques", &self.torques), ("powers", &self.powers)] {
                if !all.is_empty() {
                    text += &format!("{key} = {{ {} }}\n", table(all));
                }
            }
            for (key, value) in &self.more {
                text += &format!("{key} = {}\n", inline(value));
            }
            operation = Some(name);
        }
        Entries { text, operation, state }
    }

    /// The train with an operation that has these numbers, and what it is called: the same as from [`Point::entries`], without
    /// reading a text. None where the point is more than numbers, or something about it is wrong.
    pub fn moved(&self, train: &Train) -> Option<(Train, String)> {
        if self.engaged.is_some() || !self.fixed.is_empty() || !self.more.is_empty() || self.speeds.is_empty() {
            return None;
        }
        let state = self.state.as_deref().map(|name| train.find_state(name)).transpose().ok()?;
        let member = |name: &str| train.member(name);
        let quantity = |text: &str, of: Dimension| units::parse(text, of).ok();
        let mut speeds = vec![];
        for (name, text) in &self.speeds {
            speeds.push((member(name)?, quantity(text, Dimension::ANGULAR_SPEED)?));
        }
        let mut loads = vec![];
        for (name, text) in &self.torques {
            loads.push((member(name)?, Load::Torque(quantity(text, Dimension::TORQUE)?)));
        }
        for (name, text) in &self.powers {
            loads.push((member(name)?, Load::Power(quantity(text, Dimension::POWER)?)));
        }
        let name = unused("point", train.operations().iter().map(|o| o.name.as_str()));
        let operation = unstable::operation(name.clone(), state, speeds, loads);
        Some((unstable::with_operation(train, operation), name))
    }
}
