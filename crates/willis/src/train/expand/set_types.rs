//! The types of sets: which gears mesh in each, and the conditions under which they can be assembled.

use crate::diagnostic::{Code, Diagnostic};
use crate::exact::Rational;
use crate::train::described::{GivenGear, GivenPlanet};
use crate::train::specification::ToothSpec;
use crate::train::specification::field::Tabular;
use crate::train::words::clip;

use super::expansion::Expansion;
use super::pairs::{Pair, PairGear, SetPairs};

/// Planets between a sun and a ring.
pub(super) fn simple<'s>(
    e: &mut Expansion<'s, '_>,
    [sun, ring]: [&'s GivenGear; 2],
    planet: &GivenPlanet,
) -> Option<SetPairs<'s>> {
    let count = e.count(planet, "planet");
    let given = e.planet_teeth(planet, "planet");
    let (s, r) = (e.central(sun, "sun"), e.central(ring, "ring"));
    let (s, r) = (s?, r?);
    let teeth = e.planet_between((sun.z(), "sun"), ring.z(), given, "planet");
    if let Some(n) = count {
        e.equal_spacing(&Rational::from(sun.z() + ring.z()), n, "z_sun + z_ring");
        e.clearance(&Rational::from(sun.z()), &teeth, n);
    }
    let p = e.planet(0, teeth, planet);
    let pairs = vec![Pair::central("sun-planet", sun, s, p.clone()), Pair::central("planet-ring", ring, p, r)];
    Some(SetPairs { count, pairs })
}

/// Planets in meshing pairs between a sun and a ring, which turn in the same sense with the carrier held.
pub(super) fn double_planet<'s>(
    e: &mut Expansion<'s, '_>,
    [sun, ring]: [&'s GivenGear; 2],
    [inner, outer]: [&GivenPlanet; 2],
) -> Option<SetPairs<'s>> {
    let count = e.count_of_pairs((inner, "inner_planet"), (outer, "outer_planet"));
    let (z_i, z_o) = (e.planet_teeth(inner, "inner_planet"), e.planet_teeth(outer, "outer_planet"));
    let (s, r) = (e.central(sun, "sun"), e.central(ring, "ring"));
    let (s, r) = (s?, r?);
    if let (Some(n), Some(z)) = (count, &z_i) {
        e.clearance(&Rational::from(sun.z()), z, n);
    }
    if let Some(n) = count {
        let sum = Rational::from(ring.z() - sun.z());
        e.equal_spacing(&sum, n, "z_ring - z_sun");
    }
    // Any planets give the same ratio; a quarter of the difference is the inline arrangement.
    let mut or_nominal = |z: Option<Rational>, which: &str| {
        z.unwrap_or_else(|| {
            e.a.assume(
                &format!("{}.{which}_planet", e.set.name),
                "teeth not given, taken as (z_ring - z_sun)/4; its speed is nominal",
            );
            let z = Rational::new(ring.z() - sun.z(), 4);
            if z.sign() > 0 { z } else { Rational::from(sun.z()) }
        })
    };
    let (z_i, z_o) = (or_nominal(z_i, "inner"), or_nominal(z_o, "outer"));
    let (i, o) = (e.planet(0, z_i, inner), e.planet(1, z_o, outer));
    let pairs = vec![
        Pair::central("sun-inner_planet", sun, s, i.clone()),
        Pair::planets("inner_planet-outer_planet", i, o.clone()),
        Pair::central("outer_planet-ring", ring, o, r),
    ];
    Some(SetPairs { count, pairs })
}

/// Suns and rings that each mesh with a step of one planet.
pub(super) fn stepped<'s>(e: &mut Expansion<'s, '_>, gears: &'s [GivenGear], planet: &GivenPlanet) -> SetPairs<'s> {
    let count = e.count(planet, "planet");
    let mut pairs = Vec::new();
    let (mut suns, mut rings) = (0, 0);
    let mut steps = Vec::new();
    for g in gears {
        let k = if g.internal { &mut rings } else { &mut suns };
        let key = format!("{}s[{k}]", g.role());
        *k += 1;
        let step = e.a.teeth(g.planet_teeth.unwrap_or(1), &format_args!("{}.{key}.planet_teeth", e.place));
        let Some(c) = e.central(g, &key) else { continue };
        steps.push((if g.internal { -g.z() } else { g.z() }, step.clone()));
        let p = PairGear { member: e.planets[0], teeth: step, internal: false, tooth: g.planet_tooth.clone() };
        let many = gears.iter().filter(|o| o.internal == g.internal).count() > 1;
        let label = if many { g.member.as_str() } else { g.role() };
        pairs.push(match g.internal {
            false => Pair::central(format!("{label}-planet"), g, c, p),
            true => Pair::central(format!("planet-{label}"), g, p, c),
        });
    }
    if gears.len() < 2 {
        let name = clip(&e.set.name);
        let message = format!("a stepped set has two or more central gears, `{name}` has {}", gears.len());
        e.a.report(Diagnostic::new(Code::IncompleteSet, e.place.as_str(), message).hint("add `suns` or `rings`"));
    }
    e.stepped_conditions(&steps, count);
    SetPairs { count, pairs }
}

/// Short planets on a small sun mesh with long ones between a large sun and a ring; one of the three central gears may
/// be missing.
pub(super) fn ravigneaux<'s>(
    e: &mut Expansion<'s, '_>,
    central: [Option<&'s GivenGear>; 3],
    [short, long]: [&GivenPlanet; 2],
) -> Option<SetPairs<'s>> {
    let [small_sun, large_sun, ring] = central;
    let count = e.count_of_pairs((short, "short_planet"), (long, "long_planet"));
    let (z_short, z_long) = (e.planet_teeth(short, "short_planet"), e.planet_teeth(long, "long_planet"));
    if central.iter().flatten().count() < 2 {
        let message = format!("set `{}` needs two of small_sun, large_sun and ring", clip(&e.set.name));
        e.a.report(Diagnostic::new(Code::IncompleteSet, e.place.as_str(), message));
    }
    let z_long = match (z_long, large_sun, ring) {
        (given, Some(sun), Some(ring)) => e.planet_between((sun.z(), "large_sun"), ring.z(), given, "long_planet"),
        (Some(z), ..) => z,
        (None, ..) => {
            let message = format!("the long planet of set `{}` needs its tooth number", clip(&e.set.name));
            e.a.report(Diagnostic::new(Code::MissingKey, format!("{}.long_planet", e.place), message));
            Rational::ONE
        }
    };
    let z_short = z_short.unwrap_or_else(|| {
        e.a.assume(
            &format!("{}.short_planet", e.set.name),
            "teeth not given, taken as the long planet's; its speed is nominal",
        );
        z_long.clone()
    });
    let (short, long) = (e.planet(0, z_short, short), e.planet(1, z_long, long));
    let mut pairs = Vec::new();
    if let Some(g) = small_sun {
        let c = e.central(g, "small_sun")?;
        pairs.push(Pair::central("small_sun-short_planet", g, c, short.clone()));
    }
    // Planets alone are no set.
    if central.iter().all(Option::is_none) {
        return None;
    }
    pairs.push(Pair::planets("short_planet-long_planet", short, long.clone()));
    if let Some(g) = large_sun {
        let c = e.central(g, "large_sun")?;
        pairs.push(Pair::central("large_sun-long_planet", g, c, long.clone()));
    }
    if let Some(g) = ring {
        let c = e.central(g, "ring")?;
        pairs.push(Pair::central("long_planet-ring", g, long, c));
    }
    Some(SetPairs { count, pairs })
}

/// Side gears around the apex of bevel planets.
pub(super) fn bevel<'s>(e: &mut Expansion<'s, '_>, sides: &'s [GivenGear], planet: &GivenPlanet) -> SetPairs<'s> {
    let count = e.count(planet, "planet");
    let plain = e.planet_teeth(planet, "planet");
    if sides.len() < 2 {
        let name = clip(&e.set.name);
        let message = format!("a bevel set has two or more side gears, `{name}` has {}", sides.len());
        e.a.report(Diagnostic::new(Code::IncompleteSet, e.place.as_str(), message).hint("add them to `sides`"));
    }
    let mut pairs = Vec::new();
    for (k, g) in sides.iter().enumerate() {
        let key = format!("sides[{k}]");
        let own = g.planet_teeth.map(|t| e.a.teeth(t, &format_args!("{}.{key}.planet_teeth", e.place)));
        let step = own.or(plain.clone()).unwrap_or_else(|| {
            e.a.assume(
                &format!("{}.planet", e.set.name),
                "teeth not given, taken as those of the first side gear; its spin is nominal",
            );
            // All side gears on one plain planet: any planet gives the same ratios.
            Rational::from(sides[0].z())
        });
        let Some(c) = e.central(g, &key) else { continue };
        let right = g.right.unwrap_or(k > 0);
        let p = PairGear { member: e.planets[0], teeth: step, internal: false, tooth: ToothSpec::default().twin() };
        // On the right it is written planet first, as the mesh of a ring is.
        let pair = match right {
            false => Pair::central(format!("{}-planet", g.member), g, c, p),
            true => Pair::central(format!("planet-{}", g.member), g, p, c),
        };
        pairs.push(Pair { same_sense: right, bevel: true, ..pair });
    }
    SetPairs { count, pairs }
}
