//! What of a train file a format carries over; everything else is told.
//!
//! Each format says which keys it carries. Whatever the file has beside them is listed among the notes, in the data of the
//! export and in the file itself: also a key that the format has never heard of.

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::model::Model;
use crate::train::{FRAME, Train};

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

/// Whether a format carries a key over; the last says whether what it wrote holds all that weighs.
pub(super) type Carries = fn(&[&str], &Train, bool) -> bool;

/// What tells nothing of the train: names, and what is to be asked of it.
const ABOUT: &[&str] = &["format", "name", "source", "notes", "operation", "scenario", "study"];

/// Of sets and meshes, what makes speeds and given efficiencies.
const TEETH: &[&str] = &[
    "type",
    "member",
    "carrier",
    "teeth",
    "planet_teeth",
    "internal",
    "side",
    "sense",
    "kind",
    "count",
    "efficiency",
    "mesh_efficiency",
    "basic_efficiency",
    "forward",
    "backward",
    "external",
];

/// Of sets and meshes, what makes computed losses: shape and surface of the teeth, mass and orbit of planets, whose pull
/// their bearings feel.
const SHAPE: &[&str] = &[
    "module",
    "width",
    "helix",
    "double_helical",
    "pressure_angle",
    "centre_distance",
    "youngs_modulus",
    "poisson_ratio",
    "roughness",
    "shift",
    "addendum",
    "dedendum",
    "tip_alteration",
    "tip_diameter",
    "immersion",
    "mass",
    "orbit_radius",
];

/// What an operating point depends on: ratios and losses.
pub(super) fn operating_point(key: &[&str], train: &Train, _: bool) -> bool {
    let last = key.last().copied().unwrap_or_default();
    match key {
        ["members" | "terminals" | "input" | "output"] | ["state", "engaged" | "input" | "output"] => true,
        ["laws" | "oil" | "housing" | "bearing" | "seal" | "rotor", ..] => train.is_physical(),
        // Its first row alone.
        ["mesh", "loss_table", ..] => false,
        ["set" | "mesh", ..] => TEETH.contains(&last) || SHAPE.contains(&last) && train.is_physical(),
        ["shift_element", "kind" | "members" | "blocks"] => true,
        _ => false,
    }
}

/// The same, and what weighs.
pub(super) fn with_inertia(key: &[&str], train: &Train, has_inertia: bool) -> bool {
    let last = key.last().copied().unwrap_or_default();
    let weighs = match key {
        ["inertias", ..] | ["set", .., "inertia"] => true,
        // How far from the axis a mass turns.
        ["set", .., "mass" | "orbit_radius" | "module" | "helix" | "centre_distance" | "pressure_angle"] => true,
        ["set", ..] => last == "shift",
        _ => false,
    };
    weighs && has_inertia || operating_point(key, train, has_inertia)
}

/// What a model of the drive line has: parts with given or nominal efficiencies, friction, inertia and stiffness.
pub(super) fn drive_line(key: &[&str], train: &Train, _: bool) -> bool {
    // A planet whose inertia counts its spin against its carrier has no part there.
    let spins = || train.inertias().iter().any(|i| i.reference != FRAME);
    match key {
        ["set", .., "inertia"] => !spins(),
        ["inertias", ..] | ["mesh", "loss_table", ..] => true,
        ["drag", "members" | "coulomb" | "viscous" | "table" | "peak"] => true,
        ["shaft", "members" | "stiffness" | "damping" | "backlash" | "contact"] => true,
        ["shift_element", "capacity" | "peak" | "friction" | "normal_force" | "effective_radius"] => true,
        ["laws" | "oil" | "housing" | "bearing" | "seal" | "rotor", ..] => false,
        // Of the surface of the teeth nothing is in their nominal efficiency.
        ["set" | "mesh", .., "roughness" | "width" | "youngs_modulus" | "poisson_ratio" | "immersion"] => false,
        ["set" | "mesh", .., "mass"] => train.unplaced_masses().is_empty(),
        _ => with_inertia(key, train, true),
    }
}

/// What the file has and a format does not carry, in the order of the file.
pub(super) fn left_out(model: &Model, carries: Carries, has_inertia: bool) -> Vec<NotCarried> {
    let written = serde_json::to_value(model.specification()).expect("plain data");
    let mut all = vec![];
    collect(&written, &mut vec![], None, &mut |key, of| {
        if ABOUT.contains(&key[0]) || key.last() == Some(&"name") || carries(key, model.train(), has_inertia) {
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
