//! Bearings and the lubricant.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use willis::catalogue::bearing::{Kind, find, kind_of};

use crate::account::{Account, At, Is};
use crate::text::{self, Taken, quantity, quoted};

use super::bodies::{Bodies, without_number};
use super::gears::{Frame, place};
use super::sets::Written;

/// A rolling bearing of the file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct BearingReport {
    /// What it is called in the train file.
    pub name: String,
    /// Its designation, where the file gives one.
    pub designation: Option<String>,
    /// How many of them are alike, at each planet on planets.
    pub count: usize,
    /// Whether it is in the train file; if not, its dimensions are missing there and it stands in a comment.
    pub carried: bool,
}

/// What kind of bearing a type of the file is.
const KINDS: &[(&str, &str)] = &[
    ("radial_grooved_ball_bearing", "deep-groove-ball"),
    ("radial_deep_groove_ball_bearing", "deep-groove-ball"),
    ("radial_angular_contact_ball_bearing", "angular-contact-ball"),
    ("radial_four_point_contact_ball_bearing", "four-point-contact-ball"),
    ("radial_self_aligning_ball_bearing", "self-aligning-ball"),
    ("radial_cylindrical_roller_bearing", "cylindrical-roller"),
    ("radial_needle_roller_bearing", "needle-roller"),
    ("radial_tapered_roller_bearing", "tapered-roller"),
    ("radial_spherical_roller_bearing", "spherical-roller"),
    ("radial_toroidal_roller_bearing", "toroidal-roller"),
    ("axial_ball_bearing", "axial-ball"),
    ("axial_cylindrical_roller_bearing", "axial-cylindrical-roller"),
];

/// The type of the file for a kind.
pub fn type_of(kind: Kind) -> Option<&'static str> {
    KINDS.iter().find(|(_, own)| Kind::named(own) == Some(kind)).map(|(theirs, _)| *theirs)
}

/// Members, designation, position and component: what bearings that are alike have in common.
type Likeness = (Vec<String>, Option<String>, Option<u64>, usize);

/// Bearings that are alike.
struct Group {
    component: usize,
    members: Vec<String>,
    designation: Option<String>,
    lines: Vec<String>,
    /// Position along the axis of each, and the planet that it sits in.
    places: Vec<(Option<f64>, usize)>,
    locates: Option<bool>,
    carried: bool,
}

/// The bearings of the file in the text of the train file, and how many ideal supports it has.
pub fn bearings(
    account: &mut Account<'_>,
    bodies: &mut Bodies,
    written: &Written,
    frame: &Frame,
) -> (String, Vec<BearingReport>, usize) {
    let document = account.document;
    let mut groups: BTreeMap<Likeness, Group> = BTreeMap::new();
    let mut ideal = 0;
    let mut seen = vec![false; document.components.len()];
    for relation in document.relations.iter().filter(|r| r.kind == "side") {
        let Some(component) = bodies.of(relation, "assembly") else { continue };
        let kind = document.components[component].kind.as_str();
        if std::mem::replace(&mut seen[component], true) {
            continue;
        }
        if kind == "concept_bearing" {
            ideal += 1;
            continue;
        }
        if !kind.starts_with("rolling_bearing") && kind != "rolling_bearing" {
            continue;
        }
        let at = At::model(component);
        let Some((inner, outer)) = bodies.of(relation, "inner_part").zip(bodies.of(relation, "outer_part")) else {
            account.problem(account.called(at), "it has not two sides (inner_part, outer_part) and is left out");
            continue;
        };
        let roots = [inner, outer].map(|k| bodies.root(k));
        let rotor = |root: usize| match bodies.is_frame(root) {
            true => Some("frame".to_owned()),
            false => written.rotors.get(&root).cloned(),
        };
        let (Some(a), Some(b)) = (rotor(roots[0]), rotor(roots[1])) else {
            account.problem(account.called(at), "it holds a part that no gear turns and is left out");
            continue;
        };
        if a == b {
            continue;
        }
        let planet = roots.iter().copied().find(|r| written.planets.contains_key(r));
        let mut members: Vec<String> = [a, b].into_iter().filter(|m| m != "frame").collect();
        // Planets first, as people write it.
        members.sort_by_key(|m| !m.contains(".planet") && !m.contains("_planet"));
        let designation = account.text(at, "catalogue_designation", "bearing.designation");
        let known = designation.as_deref().and_then(find);
        let mut lines = vec![];
        let mut carried = known.is_some();
        if known.is_none() {
            let theirs = account.text(at, "bearing_type", "bearing.kind");
            let own = theirs.as_deref().and_then(|t| KINDS.iter().find(|k| k.0 == t)).map(|k| k.1);
            let read = designation.as_deref().and_then(kind_of);
            let own =
                own.or(read.as_ref().and_then(|(kind, _)| Kind::NAMES.iter().find(|n| n.1 == *kind).map(|n| n.0)));
            lines.extend(own.map(|kind| format!("kind = {}", quoted(kind))));
            lines.extend(read.filter(|r| !r.1.is_empty()).map(|r| format!("series = {}", quoted(&r.1))));
            let mut sizes = 0;
            for (theirs, own) in
                [("inner_diameter", "bore"), ("outer_diameter", "outside_diameter"), ("width", "width")]
            {
                let x = account.number(at, theirs, Is::Length, &format!("bearing.{own}")).filter(|x| *x > 0.0);
                match x {
                    Some(x) => {
                        sizes += 1;
                        lines.push(format!("{own} = {}", quantity(x, "mm")));
                    }
                    None => lines.push(format!("{own} = \"\"  # not in the file")),
                }
            }
            carried = own.is_some() && sizes == 3;
            if !carried {
                let message = match &designation {
                    Some(name) => format!(
                        "the catalogue has no `{}` and the file does not give its dimensions: it stands in a comment of \
                         the train file, to be completed",
                        text::comment(name).trim_start_matches("# ").trim_end()
                    ),
                    None => {
                        "it has neither a designation nor dimensions: it stands in a comment of the train file".into()
                    }
                };
                account.problem(account.called(at), message);
            }
        }
        let absorbs = account.text(at, "axial_force_absorption", "bearing.locates");
        let locates = match absorbs.as_deref() {
            Some("both_directions") => Some(true),
            _ => None,
        };
        let position = place(account, component, frame).map(|p| p.0);
        // On planets, those of all planets are one entry; elsewhere those at the same place.
        let beside = if planet.is_some() { None } else { position.map(f64::to_bits) };
        let unnamed = if designation.is_some() { usize::MAX } else { component };
        let key = (members.clone(), designation.clone(), beside, unnamed);
        let group = groups.entry(key).or_insert(Group {
            component,
            members,
            designation,
            lines,
            places: vec![],
            locates,
            carried,
        });
        group.places.push((position, planet.unwrap_or(usize::MAX)));
    }
    for k in (0..document.components.len()).filter(|&k| !seen[k]) {
        let kind = document.components[k].kind.as_str();
        if kind == "concept_bearing" || kind.starts_with("rolling_bearing_with") {
            account.problem(account.called(At::model(k)), "no relation `side` says what it joins; it is left out");
        }
    }
    let mut out = String::new();
    let mut reports = vec![];
    let mut taken = Taken::default();
    let mut groups: Vec<Group> = groups.into_values().collect();
    groups.sort_by_key(|g| g.component);
    for group in groups {
        let c = &document.components[group.component];
        let name = text::name(without_number(&c.name), &format!("bearing {}", c.id), &mut taken);
        // At each planet.
        let first = group.places.first().map(|p| p.1);
        let own: Vec<Option<f64>> = group.places.iter().filter(|p| Some(p.1) == first).map(|p| p.0).collect();
        let on_planets = first != Some(usize::MAX);
        let members: Vec<String> = group.members.iter().map(|m| quoted(m)).collect();
        let mut lines = vec![format!("name = {}", quoted(&name)), format!("members = [{}]", members.join(", "))];
        lines.extend(group.designation.as_ref().map(|d| format!("designation = {}", quoted(d))));
        lines.extend(group.lines);
        if own.len() > 1 {
            lines.push(format!("count = {}", own.len()));
            let places: Option<Vec<f64>> = own.iter().copied().collect();
            if let (Some(p), false) = (own[0], on_planets) {
                lines.push(format!("position = {}", quantity(p, "mm")));
            }
            if let Some(places) = places {
                let span =
                    places.iter().copied().fold(f64::MIN, f64::max) - places.iter().copied().fold(f64::MAX, f64::min);
                if span > 1e-6 {
                    lines.push(format!("span = {}", quantity(span, "mm")));
                }
            }
        } else if let (Some(Some(p)), false) = (own.first(), on_planets) {
            lines.push(format!("position = {}", quantity(*p, "mm")));
        }
        if let Some(true) = group.locates.filter(|_| group.carried && !on_planets) {
            lines.push("locates = true".into());
        }
        let mark = if group.carried { "" } else { "# " };
        out.push_str(&format!("\n{mark}[[bearing]]\n"));
        lines.iter().for_each(|line| out.push_str(&format!("{mark}{line}\n")));
        reports.push(BearingReport { name, designation: group.designation, count: own.len(), carried: group.carried });
    }
    (out, reports, ideal)
}

/// The lubricant of the housing, or the only one there is.
pub fn oil(account: &mut Account<'_>, bodies: &Bodies) -> Option<Vec<String>> {
    let document = account.document;
    let is_oil = |k: &usize| document.components[*k].kind == "lubricant";
    let mut referenced = vec![];
    for relation in document.relations.iter().filter(|r| r.kind == "reference") {
        let Some(oil) = bodies.of(relation, "referenced").filter(is_oil) else { continue };
        let of_housing = bodies.of(relation, "origin").is_some_and(|k| document.components[k].kind == "gear_casing");
        if of_housing {
            referenced.insert(0, oil);
        } else {
            referenced.push(oil);
        }
    }
    let all: Vec<usize> = (0..document.components.len()).filter(is_oil).collect();
    let chosen = referenced.first().or(all.first()).copied()?;
    let at = At::model(chosen);
    if all.len() > 1 {
        let message = format!("the file has {} lubricants; this one is taken for all of the gearbox", all.len());
        account.problem(account.called(at), message);
    }
    let nu_40 = account.number(at, "viscosity_at_40_degree_celsius", Is::Viscosity, "oil.viscosity_40");
    let nu_100 = account.number(at, "viscosity_at_100_degree_celsius", Is::Viscosity, "oil.viscosity_100");
    let (Some(nu_40), Some(nu_100)) = (nu_40.filter(|x| *x > 0.0), nu_100.filter(|x| *x > 0.0)) else {
        let message = "it has not both viscosities (at 40 and 100 degrees Celsius); without them there is no oil";
        account.problem(account.called(at), message);
        return None;
    };
    if nu_100 >= nu_40 {
        let message = format!(
            "a viscosity of {nu_100} mm^2/s at 100 degrees is not below that at 40, {nu_40}; without it there is no oil"
        );
        account.problem(account.called(at), message);
        return None;
    }
    let c = &document.components[chosen];
    let name = account.text(at, "name", "oil.name");
    let name = name.unwrap_or_else(|| without_number(&c.name).to_owned());
    let name = text::name(&name, "lubricant of the file", &mut Taken::default());
    let mut lines = vec![
        format!("name = {}", quoted(&name)),
        format!("viscosity_40 = {}", quantity(nu_40, "mm^2/s")),
        format!("viscosity_100 = {}", quantity(nu_100, "mm^2/s")),
    ];
    let density = account.number(at, "density_at_15_degree_celsius", Is::Density, "oil.density_15");
    if let Some(rho) = density.filter(|x| *x > 0.0) {
        lines.push(format!("density_15 = {}", quantity(rho, "kg/m^3")));
    }
    account.guess("base of the oil", "mineral", "the file does not say it in a way that is read");
    Some(lines)
}
