//! The efficiency of each mesh of a set: computed from its teeth, or given for the meshes or for the whole set.

use crate::diagnostic::{Code, Diagnostic};
use crate::train::described::{GivenEfficiency, GivenGear, GivenSet, Parts};
use crate::train::specification::{EfficiencySpec, SetEfficiencySpec};
use crate::train::words::clip;
use crate::train::{Efficiency, Teeth};

use super::expansion::Expansion;
use super::pairs::Pair;

/// Each pair with teeth is computed, unless an efficiency is given.
pub(super) fn is_computed(set: &GivenSet, teeth: &Option<Teeth>) -> bool {
    set.efficiency.is_none() && teeth.is_some()
}

/// The efficiency of each mesh of the set; where the teeth give it, a nominal one.
pub(super) fn efficiencies(e: &mut Expansion<'_, '_>, pairs: &[Pair<'_>], teeth: &[Option<Teeth>]) -> Vec<Efficiency> {
    let set = e.set;
    if set.efficiency.is_some() && teeth.iter().any(Option::is_some) {
        e.a.given_efficiency(&set.name, &e.place);
    }
    let computed = |t: &Option<Teeth>| is_computed(set, t);
    let all: Vec<Efficiency> = match !teeth.is_empty() && teeth.iter().all(computed) {
        true => vec![Efficiency::lossless(); pairs.len()],
        false => described(e, pairs),
    };
    let own = |(t, given): (&Option<Teeth>, Efficiency)| match t.as_ref().filter(|_| computed(t)) {
        Some(t) => e.a.nominal_efficiency(t),
        None => given,
    };
    teeth.iter().zip(all).map(own).collect()
}

/// The efficiency of each mesh as the set's description gives it.
fn described(e: &mut Expansion<'_, '_>, pairs: &[Pair<'_>]) -> Vec<Efficiency> {
    let set = e.set;
    match &set.efficiency {
        None => {
            e.a.assume(&set.name, "no efficiency given, taken as lossless");
            vec![Efficiency::lossless(); pairs.len()]
        }
        Some(GivenEfficiency::Meshes(given)) => {
            let (external, internal) = match given {
                SetEfficiencySpec::All(e) => (e, e),
                SetEfficiencySpec::ByKind { external, internal } => (external, internal),
            };
            let place = format!("{}.mesh_efficiency", e.place);
            let external = e.a.efficiency(external, &place);
            let internal = e.a.efficiency(internal, &place);
            pairs
                .iter()
                .map(|p| if p.gears.iter().any(|g| g.internal) { internal.clone() } else { external.clone() })
                .collect()
        }
        Some(GivenEfficiency::Basic(spec)) => basic(e, spec, pairs),
    }
}

/// A basic efficiency, booked on some of the meshes; the others are then without loss.
fn basic(e: &mut Expansion<'_, '_>, spec: &EfficiencySpec, pairs: &[Pair<'_>]) -> Vec<Efficiency> {
    let (a, name) = (&mut *e.a, &e.set.name);
    let place = format!("{}.basic_efficiency", e.place);
    let eta = a.efficiency(spec, &place);
    let sources = pairs.iter().filter(|p| p.central.is_some()).count();
    let mut all = vec![Efficiency::lossless(); pairs.len()];
    match &e.set.parts {
        // Each sun's stationary ratio to the ring has the basic efficiency.
        Parts::Ravigneaux { small_sun, large_sun, ring, .. } => {
            let suns = if ring.is_some() { 2 } else { 1 };
            let mut given = 0;
            for (e, p) in all.iter_mut().zip(pairs) {
                let is =
                    |s: &Option<GivenGear>| s.as_ref().is_some_and(|s| p.central.is_some_and(|c| std::ptr::eq(c, s)));
                if (is(small_sun) || is(large_sun)) && given < suns {
                    *e = eta.clone();
                    given += 1;
                }
            }
            a.assume(name, "the basic efficiency holds from each sun to the ring and is booked on the sun's mesh");
        }
        _ if sources == 2 => {
            // Forward means from the first central gear, which may be the mesh's second.
            let planet_first = pairs[0].central.is_some_and(|c| c.internal) || pairs[0].same_sense;
            all[0] = match planet_first {
                true => Efficiency { forward: eta.backward, backward: eta.forward },
                false => eta,
            };
            a.assume(name, "only the basic efficiency is known; its loss is booked on the set's first mesh");
        }
        _ => {
            let message = format!(
                "set `{}` has {sources} central gears: a basic efficiency belongs to a set with two",
                clip(name)
            );
            a.report(Diagnostic::new(Code::Conflict, place, message).hint("give `mesh_efficiency` instead"));
        }
    }
    all
}
