//! Sets become meshes; assembly conditions of the set are checked on the way.

mod conditions;
mod efficiency;
mod expansion;
mod pairs;
mod set_types;
mod teeth;

use crate::diagnostic::{Code, Diagnostic};

use super::assembler::Assembler;
use super::described::{GivenSet, Parts};
use super::words::clip;
use super::{Gear, MemberId, Mesh, Set};

use efficiency::{efficiencies, is_computed};
use expansion::Expansion;
use pairs::SetPairs;
use set_types::{bevel, double_planet, ravigneaux, simple, stepped};
use teeth::teeth;

/// Adds the planet rotors of a set, in the order in which [`expand`] uses them.
pub(super) fn planets(a: &mut Assembler<'_>, set: &GivenSet) -> Vec<MemberId> {
    set.planets().iter().map(|(role, _)| a.add_planet(format!("{}.{role}", set.name))).collect()
}

/// Adds the meshes of a set.
pub(super) fn expand(a: &mut Assembler<'_>, set: &GivenSet, planets: &[MemberId], index: usize) -> Option<Set> {
    let place = format!("set[{index}]");
    let carrier = a.resolve(&set.carrier, &format_args!("{place}.carrier"));
    if carrier.is_some_and(|carrier| planets.contains(&carrier)) {
        let message = format!("`{}` is a planet of set `{}`, and cannot be its carrier", set.carrier, clip(&set.name));
        a.report(
            Diagnostic::new(Code::ImpossibleMesh, format!("{place}.carrier"), message)
                .hint("the carrier is the member that carries the axes of the planets; name it in `members`"),
        );
    }
    let mut e = Expansion { a, set, place, carrier, planets };
    let SetPairs { count, pairs } = by_type(&mut e)?;
    let carrier = carrier?;
    let teeth = teeth(&mut e, &pairs);
    let efficiencies = efficiencies(&mut e, &pairs, &teeth);
    let name = &set.name;
    for (k, ((p, efficiency), teeth)) in pairs.into_iter().zip(efficiencies).zip(teeth).enumerate() {
        let [first, second] = p.gears.map(|g| Gear { member: g.member, teeth: g.teeth, internal: g.internal });
        if first.member == second.member {
            let message = format!("mesh {k} of set `{}` joins a member to itself", clip(name));
            e.a.report(Diagnostic::new(Code::ImpossibleMesh, e.place.as_str(), message));
        }
        let name = e.a.default_mesh_name(format!("{name}.{}", p.name));
        e.a.meshes.push(Mesh {
            name,
            gears: [first, second],
            carrier,
            efficiency,
            same_sense: p.same_sense,
            bevel: p.bevel,
            count: count.unwrap_or(1),
            angle: None,
            set: Some(index),
            computed: is_computed(set, &teeth),
            teeth: teeth.map(Box::new),
        });
    }
    if count.is_none() {
        e.a.assume(name, "number of planets not given: assembly not checked, torques and losses are totals");
    }
    Some(Set { name: name.clone(), kind: set.kind, planets: count })
}

/// What meshes in a set, by its type.
fn by_type<'s>(e: &mut Expansion<'s, '_>) -> Option<SetPairs<'s>> {
    match &e.set.parts {
        Parts::Simple { sun, ring, planet } => simple(e, [sun, ring], planet),
        Parts::DoublePlanet { sun, ring, inner, outer } => double_planet(e, [sun, ring], [inner, outer]),
        Parts::Stepped { central, planet } => Some(stepped(e, central, planet)),
        Parts::Ravigneaux { small_sun, large_sun, ring, short, long } => {
            ravigneaux(e, [small_sun, large_sun, ring].map(Option::as_ref), [short, long])
        }
        Parts::Bevel { sides, planet } => Some(bevel(e, sides, planet)),
    }
}
