//! What of a train file a format carries over; everything else is told.
//!
//! Each format says which keys it carries. Whatever the file has beside them is listed among the notes, in the data of the
//! export and in the file itself: also a key that the format has never heard of.

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::model::Model;
use crate::train::Train;

/// A key of the train file that is not in the export.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct NotCarried {
    /// The key, without the positions of lists: `drag.coulomb`, `shift_element.capacity`.
    pub key: String,
    /// The entries that have it, by their names, where they have some.
    pub of: Vec<String>,
}

/// Whether a format carries a key over.
pub(super) type Carries = fn(&[&str], &Train) -> bool;

/// What tells nothing of the train: names, and what is to be asked of it.
const ABOUT: &[&str] = &["format", "name", "source", "notes", "operation", "scenario", "study"];

/// The keys of what weighs.
const WEIGHS: &[&str] = &["mass", "inertia", "orbit_radius"];

/// What an operating point depends on: ratios and losses.
pub(super) fn operating_point(key: &[&str], train: &Train) -> bool {
    let last = key.last().copied().unwrap_or_default();
    match key {
        ["members" | "terminals" | "input" | "output" | "state", ..] => true,
        ["laws" | "oil" | "housing" | "bearing" | "seal" | "rotor", ..] => train.is_physical(),
        // Its first row alone.
        ["mesh", "loss_table", ..] => false,
        ["mesh", ..] => true,
        // The pull of planets on their bearings.
        ["set", ..] if WEIGHS.contains(&last) => last != "inertia" && train.is_physical(),
        ["set", ..] => true,
        ["shift_element", "kind" | "members" | "blocks"] => true,
        _ => false,
    }
}

/// The same, and what weighs.
pub(super) fn with_inertia(key: &[&str], train: &Train) -> bool {
    let last = key.last().copied().unwrap_or_default();
    match key {
        ["inertias", ..] => true,
        ["set", ..] if WEIGHS.contains(&last) => last == "inertia" || train.unplaced_masses().is_empty(),
        _ => operating_point(key, train),
    }
}

/// What a model of the drive line has: parts with given or nominal efficiencies, friction, inertia and stiffness.
pub(super) fn drive_line(key: &[&str], train: &Train) -> bool {
    match key {
        ["drag" | "shaft" | "inertias" | "shift_element", ..] | ["mesh", "loss_table", ..] => true,
        ["laws" | "oil" | "housing" | "bearing" | "seal" | "rotor", ..] => false,
        _ => with_inertia(key, train),
    }
}

/// What the file has and a format does not carry, in the order of the file.
pub(super) fn left_out(model: &Model, carries: Carries) -> Vec<NotCarried> {
    let written = serde_json::to_value(model.specification()).expect("plain data");
    let mut all = vec![];
    collect(&written, &mut vec![], None, &mut |key, of| {
        if ABOUT.contains(&key[0]) || key.last() == Some(&"name") || carries(key, model.train()) {
            return;
        }
        let key = key.join(".");
        let of = of.map(str::to_owned);
        match all.iter_mut().find(|n: &&mut NotCarried| n.key == key) {
            Some(known) => known.of.extend(of.filter(|o| !known.of.contains(o))),
            None => all.push(NotCarried { key, of: of.into_iter().collect() }),
        }
    });
    all
}

/// Calls back with every value: the keys that lead to it, and the name of the entry that it is in.
fn collect<'v>(
    value: &'v Value,
    path: &mut Vec<&'v str>,
    of: Option<&'v str>,
    tell: &mut impl FnMut(&[&str], Option<&str>),
) {
    match value {
        Value::Null => {}
        Value::Object(table) => {
            // The innermost name that there is.
            let of = table.get("name").and_then(Value::as_str).filter(|_| !path.is_empty()).or(of);
            for (key, value) in table {
                path.push(key);
                collect(value, path, of, tell);
                path.pop();
            }
        }
        Value::Array(all) if all.iter().any(Value::is_object) => {
            all.iter().for_each(|value| collect(value, path, of, tell));
        }
        _ => tell(path, of),
    }
}

/// All of it in a sentence; none where everything is carried over.
pub(super) fn sentence(all: &[NotCarried]) -> Option<String> {
    /// Keys, and entries of a key.
    const MOST: [usize; 2] = [12, 4];
    let one = |n: &NotCarried| {
        let names = n.of.iter().take(MOST[1]).map(String::as_str).collect::<Vec<_>>().join(", ");
        let more = n.of.len().saturating_sub(MOST[1]);
        match (n.of.is_empty(), more) {
            (true, _) => n.key.clone(),
            (false, 0) => format!("{} ({names})", n.key),
            (false, more) => format!("{} ({names} and {more} more)", n.key),
        }
    };
    let told = all.iter().take(MOST[0]).map(one).collect::<Vec<_>>().join(", ");
    let more = all.len().saturating_sub(MOST[0]);
    let more = if more > 0 { format!(" and {more} keys more") } else { String::new() };
    (!all.is_empty()).then(|| format!("not carried over from the file: {told}{more}"))
}
