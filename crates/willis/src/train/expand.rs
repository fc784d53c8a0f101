//! Sets become meshes; assembly conditions of the set are checked on the way.

use crate::diagnostic::{Code, Diagnostic};
use crate::exact::Rational;

use super::assembler::Assembler;
use super::described::{GivenEfficiency, GivenGear, GivenPlanet, GivenSet, Parts};
use super::physical::Teeth;
use super::specification::field::Tabular;
use super::specification::{PlainTooth, SetEfficiencySpec, ToothSpec};
use super::words::clip;
use super::{Efficiency, Gear, MemberId, Mesh, Set};

/// Adds the planet rotors of a set, in the order in which [`expand`] uses them.
pub(super) fn planets(a: &mut Assembler<'_>, set: &GivenSet) -> Vec<MemberId> {
    set.planets().iter().map(|(role, _)| a.add_planet(format!("{}.{role}", set.name))).collect()
}

/// The two gears of a mesh to be, with the place of the first for messages.
struct Pair<'a> {
    name: String,
    central: Option<&'a GivenGear>,
    /// Members, tooth counts and teeth, first gear first.
    gears: [(MemberId, Rational, bool, PlainTooth); 2],
    same_sense: bool,
    bevel: bool,
}

/// Adds the meshes of a set.
pub(super) fn expand(a: &mut Assembler<'_>, set: &GivenSet, planets: &[MemberId], index: usize) -> Option<Set> {
    let place = format!("set[{index}]");
    let carrier = a.resolve(&set.carrier, &format!("{place}.carrier"));
    let name = &set.name;
    let central = |a: &mut Assembler<'_>, g: &GivenGear, key: &str| {
        let teeth = a.teeth(g.teeth, &format!("{place}.{key}.teeth"));
        let id = a.resolve(&g.member, &format!("{place}.{key}.member"))?;
        if Some(id) == carrier {
            let message = format!("`{}` is both the {} and the carrier of set `{}`", g.member, g.role(), clip(name));
            a.report(
                Diagnostic::new(Code::ImpossibleMesh, format!("{place}.{key}.member"), message)
                    .hint("a locked set is made with a clutch, not by naming one member twice"),
            );
        }
        Some((id, teeth, g.internal, g.tooth.clone()))
    };
    let number = |a: &mut Assembler<'_>, p: &GivenPlanet, key: &str| {
        p.count.map(|c| a.count(c, &format!("{place}.{key}.count")))
    };
    let in_pairs = |a: &mut Assembler<'_>, first: (&GivenPlanet, &str), second: (&GivenPlanet, &str)| {
        let counts = (number(a, first.0, first.1), number(a, second.0, second.1));
        if let (Some(n), Some(other)) = counts
            && n != other
        {
            let message = format!("set `{}`: its planets mesh in pairs, {n} with {other} do not", clip(name));
            let place = format!("{place}.{}.count", second.1);
            a.report(Diagnostic::new(Code::Conflict, place, message).hint("give one count, or twice the same"));
        }
        counts.0.or(counts.1)
    };
    let planet_teeth = |a: &mut Assembler<'_>, p: &GivenPlanet, key: &str| {
        p.teeth.map(|t| a.teeth(t, &format!("{place}.{key}.teeth")))
    };
    let mut pairs: Vec<Pair<'_>> = Vec::new();
    let count;
    match &set.parts {
        Parts::Simple { sun, ring, planet } => {
            count = number(a, planet, "planet");
            let given = planet_teeth(a, planet, "planet");
            let (s, r) = (central(a, sun, "sun"), central(a, ring, "ring"));
            let (Some(s), Some(r)) = (s, r) else { return None };
            let teeth = nominal(a, set, &place, given.clone(), sun.z(), ring.z(), "planet");
            if let Some(given) = given {
                coaxial(a, set, &place, (sun.z(), "sun"), (ring.z(), "ring"), &given, "planet");
            }
            if let Some(n) = count {
                equal_spacing(a, set, &place, &Rational::from(sun.z() + ring.z()), n, "z_sun + z_ring");
                clearance(a, set, &place, &Rational::from(sun.z()), &teeth, n);
            }
            let p = (planets[0], teeth, false, planet.tooth.clone());
            pairs.push(pair("sun-planet", sun, s, p.clone()));
            pairs.push(Pair { central: Some(ring), ..pair("planet-ring", ring, p, r) });
        }
        Parts::DoublePlanet { sun, ring, inner, outer } => {
            count = in_pairs(a, (inner, "inner_planet"), (outer, "outer_planet"));
            let (z_i, z_o) = (planet_teeth(a, inner, "inner_planet"), planet_teeth(a, outer, "outer_planet"));
            let (s, r) = (central(a, sun, "sun"), central(a, ring, "ring"));
            let (Some(s), Some(r)) = (s, r) else { return None };
            if let (Some(n), Some(z)) = (count, &z_i) {
                clearance(a, set, &place, &Rational::from(sun.z()), z, n);
            }
            if let Some(n) = count {
                let sum = Rational::from(ring.z() - sun.z());
                equal_spacing(a, set, &place, &sum, n, "z_ring - z_sun");
            }
            // Any planets give the same ratio; a quarter of the difference is the inline arrangement.
            let mut or_nominal = |z: Option<Rational>, which: &str| {
                z.unwrap_or_else(|| {
                    a.assume(
                        &format!("{name}.{which}_planet"),
                        "teeth not given, taken as (z_ring - z_sun)/4; its speed is nominal",
                    );
                    let z = Rational::new(ring.z() - sun.z(), 4);
                    if z.sign() > 0 { z } else { Rational::from(sun.z()) }
                })
            };
            let i = (planets[0], or_nominal(z_i, "inner"), false, inner.tooth.clone());
            let o = (planets[1], or_nominal(z_o, "outer"), false, outer.tooth.clone());
            pairs.push(pair("sun-inner_planet", sun, s, i.clone()));
            pairs.push(Pair { central: None, ..pair("inner_planet-outer_planet", sun, i, o.clone()) });
            pairs.push(pair("outer_planet-ring", ring, o, r));
        }
        Parts::Stepped { central: gears, planet } => {
            count = number(a, planet, "planet");
            let (mut suns, mut rings) = (0, 0);
            let mut steps = Vec::new();
            for g in gears {
                let k = if g.internal { &mut rings } else { &mut suns };
                let key = format!("{}s[{k}]", g.role());
                *k += 1;
                let step = a.teeth(g.planet_teeth.unwrap_or(1), &format!("{place}.{key}.planet_teeth"));
                let Some(c) = central(a, g, &key) else { continue };
                steps.push((if g.internal { -g.z() } else { g.z() }, step.clone()));
                let p = (planets[0], step, false, g.planet_tooth.clone());
                let many = gears.iter().filter(|o| o.internal == g.internal).count() > 1;
                let label = if many { g.member.as_str() } else { g.role() };
                pairs.push(match g.internal {
                    false => pair(&format!("{label}-planet"), g, c, p),
                    true => pair(&format!("planet-{label}"), g, p, c),
                });
            }
            if gears.len() < 2 {
                let message =
                    format!("a stepped set has two or more central gears, `{}` has {}", clip(name), gears.len());
                a.report(Diagnostic::new(Code::IncompleteSet, place.as_str(), message).hint("add `suns` or `rings`"));
            }
            stepped_conditions(a, set, &place, &steps, count);
        }
        Parts::Ravigneaux { small_sun, large_sun, ring, short, long } => {
            count = in_pairs(a, (short, "short_planet"), (long, "long_planet"));
            let (z_short, z_long) = (planet_teeth(a, short, "short_planet"), planet_teeth(a, long, "long_planet"));
            if [small_sun, large_sun, ring].iter().filter(|g| g.is_some()).count() < 2 {
                let message = format!("set `{}` needs two of small_sun, large_sun and ring", clip(name));
                a.report(Diagnostic::new(Code::IncompleteSet, place.as_str(), message));
            }
            let z_long = match (z_long, large_sun, ring) {
                (Some(z), Some(sun), Some(ring)) => {
                    coaxial(a, set, &place, (sun.z(), "large_sun"), (ring.z(), "ring"), &z, "long_planet");
                    z
                }
                (Some(z), ..) => z,
                (None, Some(sun), Some(ring)) => nominal(a, set, &place, None, sun.z(), ring.z(), "long_planet"),
                (None, ..) => {
                    let message = format!("the long planet of set `{}` needs its tooth number", clip(name));
                    a.report(Diagnostic::new(Code::MissingKey, format!("{place}.long_planet"), message));
                    Rational::ONE
                }
            };
            let z_short = z_short.unwrap_or_else(|| {
                a.assume(
                    &format!("{name}.short_planet"),
                    "teeth not given, taken as the long planet's; its speed is nominal",
                );
                z_long.clone()
            });
            let (short, long) =
                ((planets[0], z_short, false, short.tooth.clone()), (planets[1], z_long, false, long.tooth.clone()));
            if let Some(g) = small_sun {
                let c = central(a, g, "small_sun")?;
                pairs.push(pair("small_sun-short_planet", g, c, short.clone()));
            }
            let link = small_sun.as_ref().or(large_sun.as_ref()).or(ring.as_ref())?;
            pairs.push(Pair { central: None, ..pair("short_planet-long_planet", link, short, long.clone()) });
            if let Some(g) = large_sun {
                let c = central(a, g, "large_sun")?;
                pairs.push(pair("large_sun-long_planet", g, c, long.clone()));
            }
            if let Some(g) = ring {
                let c = central(a, g, "ring")?;
                pairs.push(pair("long_planet-ring", g, long, c));
            }
        }
        Parts::Bevel { sides, planet } => {
            count = number(a, planet, "planet");
            let plain = planet_teeth(a, planet, "planet");
            if sides.len() < 2 {
                let message = format!("a bevel set has two or more side gears, `{}` has {}", clip(name), sides.len());
                a.report(Diagnostic::new(Code::IncompleteSet, place.as_str(), message).hint("add them to `sides`"));
            }
            for (k, g) in sides.iter().enumerate() {
                let key = format!("sides[{k}]");
                let own = g.planet_teeth.map(|t| a.teeth(t, &format!("{place}.{key}.planet_teeth")));
                let step = own.or(plain.clone()).unwrap_or_else(|| {
                    a.assume(
                        &format!("{name}.planet"),
                        "teeth not given, taken as those of the first side gear; its spin is nominal",
                    );
                    // All side gears on one plain planet: any planet gives the same ratios.
                    Rational::from(sides[0].z())
                });
                let Some(c) = central(a, g, &key) else { continue };
                let right = g.right.unwrap_or(k > 0);
                let p = (planets[0], step, false, ToothSpec::default().twin());
                let mut new = pair(&format!("{}-planet", g.member), g, c, p);
                if right {
                    // Written planet first, as the mesh of a ring is.
                    new.gears.swap(0, 1);
                    new.name = format!("planet-{}", g.member);
                }
                new.same_sense = right;
                new.bevel = true;
                pairs.push(new);
            }
        }
    }
    let carrier = carrier?;
    let teeth = teeth(a, set, &place, &pairs);
    if set.efficiency.is_some() && teeth.iter().any(Option::is_some) {
        a.given_efficiency(name, &place);
    }
    // Each pair with teeth is computed, unless an efficiency is given.
    let computed = |t: &Option<Teeth>| set.efficiency.is_none() && t.is_some();
    let all: Vec<Efficiency> = match !teeth.is_empty() && teeth.iter().all(computed) {
        true => vec![Efficiency::lossless(); pairs.len()],
        false => efficiencies(a, set, &place, &pairs),
    };
    let own = |(t, e): (&Option<Teeth>, Efficiency)| match t.as_ref().filter(|_| computed(t)) {
        Some(t) => a.nominal_efficiency(t),
        None => e,
    };
    let efficiencies: Vec<Efficiency> = teeth.iter().zip(all).map(own).collect();
    for (k, ((p, efficiency), teeth)) in pairs.into_iter().zip(efficiencies).zip(teeth).enumerate() {
        let [first, second] = p.gears.map(|(member, teeth, internal, _)| Gear { member, teeth, internal });
        if first.member == second.member {
            let message = format!("mesh {k} of set `{}` joins a member to itself", clip(name));
            a.report(Diagnostic::new(Code::ImpossibleMesh, place.as_str(), message));
        }
        let name = a.default_mesh_name(format!("{name}.{}", p.name));
        a.meshes.push(Mesh {
            name,
            gears: [first, second],
            carrier,
            efficiency,
            same_sense: p.same_sense,
            bevel: p.bevel,
            count: count.unwrap_or(1),
            set: Some(index),
            computed: computed(&teeth),
            teeth: teeth.map(Box::new),
        });
    }
    if count.is_none() {
        a.assume(name, "number of planets not given: assembly not checked, torques and losses are totals");
    }
    Some(Set { name: name.clone(), kind: set.kind, planets: count })
}

fn pair<'a>(
    name: &str,
    central: &'a GivenGear,
    first: (MemberId, Rational, bool, PlainTooth),
    second: (MemberId, Rational, bool, PlainTooth),
) -> Pair<'a> {
    let same_sense = first.2 || second.2;
    Pair { name: name.into(), central: Some(central), gears: [first, second], same_sense, bevel: false }
}

/// The teeth of each mesh of the set, where its geometry is given, on one centre distance.
fn teeth(a: &mut Assembler<'_>, set: &GivenSet, place: &str, pairs: &[Pair<'_>]) -> Vec<Option<Teeth>> {
    let mut all = Vec::with_capacity(pairs.len());
    for p in pairs {
        let own = p.central.and_then(|c| c.geometry.as_ref());
        let geometry = if p.bevel { None } else { own.or(set.geometry.as_ref()) };
        let gears = [&p.gears[0], &p.gears[1]].map(|g| (g.1.to_f64(), g.2, &g.3));
        let title = format!("{}.{}", set.name, p.name);
        all.push(geometry.and_then(|g| a.tooth_pair(g, gears, &title, place)));
    }
    // Every central gear meshes with planets whose axes run on one circle.
    let central: Vec<(&Pair<'_>, &Teeth)> = pairs
        .iter()
        .zip(&all)
        .filter(|(p, _)| p.central.is_some())
        .filter_map(|(p, t)| Some((p, t.as_ref()?)))
        .collect();
    // In a set with two kinds of planets the circles differ.
    let on_planet = |p: &Pair<'_>| p.gears.iter().find(|g| Some(g.0) != a_central(p)).map(|g| g.0);
    for (k, (p, t)) in central.iter().enumerate() {
        for (q, u) in central.iter().take(k).filter(|(q, _)| on_planet(p) == on_planet(q)) {
            let (here, there) = (t.pair.centre_distance, u.pair.centre_distance);
            if (here - there).abs() > CONCENTRIC * t.pair.data.module {
                let message = format!(
                    "set `{}`: the planets' axes lie on one circle, but {} needs a centre distance of {:.4} mm and {} \
                     of {:.4} mm",
                    clip(&set.name),
                    q.name,
                    there * 1e3,
                    p.name,
                    here * 1e3
                );
                a.diagnostics.push(
                    Diagnostic::new(Code::ImpossibleGeometry, format!("{place}.geometry"), message).hint(
                        "give `centre_distance` (profile shift or backlash make up the rest), or shifts that agree",
                    ),
                );
            }
        }
    }
    all
}

/// How far two centre distances of one set may differ, in modules: the last digit of printed shifts.
const CONCENTRIC: f64 = 5e-3;

/// The member of the central gear: the one that is not the planet of a pair.
fn a_central(p: &Pair<'_>) -> Option<MemberId> {
    let internal = p.central?.internal;
    // A sun is written first, a ring second.
    Some(p.gears[usize::from(internal)].0)
}

/// The efficiency of each mesh of the set.
fn efficiencies(a: &mut Assembler<'_>, set: &GivenSet, place: &str, pairs: &[Pair<'_>]) -> Vec<Efficiency> {
    let name = &set.name;
    match &set.efficiency {
        None => {
            a.assume(name, "no efficiency given, taken as lossless");
            vec![Efficiency::lossless(); pairs.len()]
        }
        Some(GivenEfficiency::Meshes(given)) => {
            let (external, internal) = match given {
                SetEfficiencySpec::All(e) => (e, e),
                SetEfficiencySpec::ByKind { external, internal } => (external, internal),
            };
            let external = a.efficiency(external, &format!("{place}.mesh_efficiency"));
            let internal = a.efficiency(internal, &format!("{place}.mesh_efficiency"));
            pairs
                .iter()
                .map(|p| if p.gears.iter().any(|g| g.2) { internal.clone() } else { external.clone() })
                .collect()
        }
        Some(GivenEfficiency::Basic(spec)) => {
            let place = format!("{place}.basic_efficiency");
            let eta = a.efficiency(spec, &place);
            let sources = pairs.iter().filter(|p| p.central.is_some()).count();
            let mut all = vec![Efficiency::lossless(); pairs.len()];
            match &set.parts {
                // Each sun's stationary ratio to the ring has the basic efficiency.
                Parts::Ravigneaux { small_sun, large_sun, ring, .. } => {
                    let suns = if ring.is_some() { 2 } else { 1 };
                    let mut given = 0;
                    for (e, p) in all.iter_mut().zip(pairs) {
                        let is = |s: &Option<GivenGear>| {
                            s.as_ref().is_some_and(|s| p.central.is_some_and(|c| std::ptr::eq(c, s)))
                        };
                        if (is(small_sun) || is(large_sun)) && given < suns {
                            *e = eta.clone();
                            given += 1;
                        }
                    }
                    a.assume(
                        name,
                        "the basic efficiency holds from each sun to the ring and is booked on the sun's mesh",
                    );
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
    }
}

/// The planet that fits between unshifted sun and ring, `(z_r − z_s)/2`, where none is given.
fn nominal(
    a: &mut Assembler<'_>,
    set: &GivenSet,
    place: &str,
    given: Option<Rational>,
    sun: i64,
    ring: i64,
    key: &str,
) -> Rational {
    if let Some(given) = given {
        return given;
    }
    let z = Rational::new(ring.clamp(-100_000, 100_000) - sun.clamp(-100_000, 100_000), 2);
    let name = clip(&set.name);
    if z.sign() <= 0 {
        let message =
            format!("set `{name}`: a ring with {ring} teeth has no room for a planet around a sun with {sun}");
        a.report(
            Diagnostic::new(Code::NotCoaxial, format!("{place}.ring.teeth"), message)
                .hint("the ring has more teeth than the sun; are the two swapped?"),
        );
        return Rational::ONE;
    }
    if z.is_integer() {
        a.assume(&format!("{}.{key} ({z})", set.name), "teeth not given, taken as (z_ring - z_sun)/2");
    } else {
        let message = format!(
            "set `{name}`: the {key}'s teeth are not given and (z_ring - z_sun)/2 = ({ring} - {sun})/2 = {} is no integer",
            z.to_f64()
        );
        let whole = z.to_f64().floor();
        a.report(Diagnostic::new(Code::NominalPlanet, place, message).hint(format!(
            "profile shift closes it with {whole} or {} teeth; give the real number and planet speeds are exact \
             (ratios and efficiencies do not depend on it)",
            whole + 1.0
        )));
    }
    z
}

/// `z_ring = z_sun + 2 z_planet` (unshifted gears of one module). Where the teeth are given their
/// centre distances are compared instead.
fn coaxial(
    a: &mut Assembler<'_>,
    set: &GivenSet,
    place: &str,
    (sun, sun_key): (i64, &str),
    (ring, ring_key): (i64, &str),
    planet: &Rational,
    planet_key: &str,
) {
    let needed = &Rational::from(sun) + &(planet * &Rational::from(2));
    let off = &Rational::from(ring) - &needed;
    if off.is_zero() || set.geometry.is_some() {
        return;
    }
    let message = format!(
        "set `{}`: ring {ring}, {sun_key} {sun} and {planet_key} {planet} do not lie on one axis: \
         {sun} + 2·{planet} = {needed}, off by {}",
        clip(&set.name),
        off.abs()
    );
    let place = format!("{place}.{ring_key}.teeth");
    a.report(if off.abs() <= Rational::from(2) {
        Diagnostic::new(Code::NearlyCoaxial, place, message).hint("profile shift can close this")
    } else {
        Diagnostic::new(Code::NotCoaxial, place, message).hint(format!("use {needed} teeth, or another planet"))
    });
}

fn equal_spacing(a: &mut Assembler<'_>, set: &GivenSet, place: &str, sum: &Rational, n: u32, what: &str) {
    let each = sum / &Rational::from(n as i64);
    if !each.is_integer() {
        let message = format!(
            "set `{}`: {n} planets cannot be spaced equally: ({what})/{n} = {sum}/{n} = {:.4} is no integer",
            clip(&set.name),
            each.to_f64()
        );
        let fits: Vec<String> =
            (2..=8).filter(|k| (sum / &Rational::from(*k)).is_integer()).map(|k| k.to_string()).collect();
        let hint = match fits.is_empty() {
            true => "no number of planets from 2 to 8 does; change a tooth count, or space them unequally".into(),
            false => format!("{} planets would, or unequal angles", fits.join(" or ")),
        };
        a.report(Diagnostic::new(Code::UnequalSpacing, place, message).hint(hint));
    }
}

/// Tip circles of neighbouring planets: `(z_s + z_p) sin(π/n) > z_p + 2` in modules, addendum one.
fn clearance(a: &mut Assembler<'_>, set: &GivenSet, place: &str, sun: &Rational, planet: &Rational, n: u32) {
    if n < 2 {
        return;
    }
    let (z_s, z_p) = (sun.to_f64(), planet.to_f64());
    let gap = (z_s + z_p) * (std::f64::consts::PI / n as f64).sin() - (z_p + 2.0);
    if gap <= 0.0 {
        let message = format!(
            "set `{}`: neighbouring planets overlap by {:.2} modules at the tip (sun {z_s}, planet {z_p}, {n} planets)",
            clip(&set.name),
            -gap
        );
        let fit = (std::f64::consts::PI / ((z_p + 2.0) / (z_s + z_p)).min(1.0).asin()).ceil() as u32 - 1;
        a.report(Diagnostic::new(Code::PlanetsTouch, place, message).hint(format!("at most {fit} planets fit")));
    }
}

/// Centre distances and spacing of a stepped set; ring teeth negative.
fn stepped_conditions(a: &mut Assembler<'_>, set: &GivenSet, place: &str, steps: &[(i64, Rational)], n: Option<u32>) {
    let Some((first, rest)) = steps.split_first() else { return };
    // Twice the centre distance in modules: |z + y| for sun (z > 0) and ring (z < 0).
    let twice = |(z, y): &(i64, Rational)| (&Rational::from(*z) + y).abs();
    for other in rest {
        let off = (&twice(first) - &twice(other)).abs();
        if !off.is_zero() {
            let message = format!(
                "set `{}`: with one module the centre distances differ: {}/2 and {}/2 modules",
                clip(&set.name),
                twice(first),
                twice(other)
            );
            let hint = if off <= Rational::from(2) {
                "profile shift can close this"
            } else {
                "the steps have different modules or helix angles; the ratio does not depend on it"
            };
            a.report(Diagnostic::new(Code::NearlyCoaxial, place, message).hint(hint));
        }
        if let Some(n) = n {
            // Identical planets at equal angles: (z1 y2 - z2 y1)/(n gcd(y1, y2)) is an integer.
            let (y1, y2) = (first.1.to_f64() as i64, other.1.to_f64() as i64);
            let gcd = Rational::from(gcd(y1, y2));
            let sum = (&Rational::from(first.0) * &other.1 - &Rational::from(other.0) * &first.1).abs() / gcd;
            equal_spacing(a, set, place, &sum, n, "(z_1 y_2 - z_2 y_1)/gcd(y_1, y_2)");
        }
    }
    if let Some(n) = n
        && let Some((z, y)) = steps.iter().filter(|s| s.0 > 0).max_by(|p, q| p.1.cmp(&q.1))
    {
        clearance(a, set, place, &Rational::from(*z), y, n);
    }
}

fn gcd(a: i64, b: i64) -> i64 {
    if b == 0 { a } else { gcd(b, a % b) }
}
