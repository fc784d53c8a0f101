//! Where the wheels stand, and how they are turned so that all teeth mesh.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use willis::geometry::{Pair, Remark};

use super::profile::Profile;
use super::{FrontBody, FrontMesh, FrontPlane, FrontSpacing, Link};

/// A wheel with its places.
pub struct Placed {
    pub member: usize,
    pub planet: bool,
    pub profile: Profile,
    /// Turns relative to the carrier for one of the first wheel: a fraction.
    pub turns: (i128, i128),
    pub bodies: Vec<FrontBody>,
}

/// Everything in its place.
pub struct Built {
    pub wheels: Vec<Placed>,
    pub meshes: Vec<FrontMesh>,
    pub planes: Vec<FrontPlane>,
    pub spacing: FrontSpacing,
    pub notes: Vec<String>,
}

/// Part of a pitch by which teeth may miss each other: rounding.
const FITS: f64 = 1e-6;
/// Angles that are tried for a planet, either side of the one wanted.
const TRIED: i64 = 60;
/// Planets drawn where the train does not say how many.
const USUAL: u32 = 3;

/// Two wheels in mesh, the driving one first.
struct Tie {
    link: usize,
    /// Positions in the list of wheels.
    wheels: [usize; 2],
    /// The gear of the pair that drives.
    driver: usize,
    pair: Pair,
    /// Turns of the driven wheel for one of the first, relative to the carrier.
    turns: (i128, i128),
}

/// The axes of planets: member, distance from the carrier's axis (mm), angle from the first.
type Orbits = Vec<(usize, f64, f64)>;

/// Puts a set together; the first planet stands above the carrier's axis.
pub fn build(links: &[Link], pairs: Vec<Pair>, count: Option<u32>) -> Result<Built, String> {
    let mut wheels: Vec<Placed> = Vec::new();
    let mut of_link: Vec<[usize; 2]> = Vec::new();
    for (link, pair) in links.iter().zip(&pairs) {
        of_link.push([0, 1].map(|k| {
            let profile = Profile::of(pair, k);
            let member = link.wheels[k].member;
            let known = wheels.iter().position(|w| w.member == member && w.profile.same(&profile));
            known.unwrap_or_else(|| {
                wheels.push(Placed { member, planet: link.wheels[k].planet, profile, turns: (0, 1), bodies: vec![] });
                wheels.len() - 1
            })
        }));
    }
    let orbits = orbits(&wheels, &of_link, &pairs)?;
    let place = |w: &Placed, arm: f64| -> [f64; 2] {
        match orbits.iter().find(|o| w.planet && o.0 == w.member) {
            Some(&(_, r, angle)) => [r * (arm + angle).cos(), r * (arm + angle).sin()],
            None => [0.0, 0.0],
        }
    };
    // The pairs at the distances at which their axes are drawn: those of the first mesh of each planet.
    let mut fitted = Vec::with_capacity(pairs.len());
    for (pair, &[a, b]) in pairs.into_iter().zip(&of_link) {
        let (p, q) = (place(&wheels[a], 0.0), place(&wheels[b], 0.0));
        let distance = (p[0] - q[0]).hypot(p[1] - q[1]) * 1e-3;
        fitted.push(match (distance - pair.centre_distance).abs() < 1e-10 {
            true => pair,
            false => {
                let mut data = pair.data.clone();
                data.centre_distance = Some(distance);
                Pair::new(&data).map_err(|f| f.first().map_or_else(String::new, ToString::to_string))?
            }
        });
    }
    let (ties, locked) = ties(&mut wheels, &of_link, fitted);
    let planes = planes(&wheels, &ties);
    let mut notes = Vec::new();
    for t in &ties {
        // What one sees when one looks closely.
        let seen = |r: &Remark| {
            use Remark::{BelowForm, NegativeBacklash, NoClearance, TipInterference};
            matches!(r, BelowForm { .. } | NegativeBacklash { .. } | NoClearance { .. } | TipInterference { .. })
        };
        for r in t.pair.remarks().iter().filter(|r| seen(r)) {
            // Wheels have other numbers in the picture than in their mesh.
            let wheel = r.wheel().map_or("", |w| ["first gear: ", "second gear: "][w.min(1)]);
            notes.push(format!("{}: {wheel}{}.", links[t.link].name, r.matter()));
        }
    }
    if locked {
        notes.push("These wheels cannot turn: two of them on one member would need different speeds.".to_owned());
    }

    let lattice = least_turn(&wheels, &ties);
    let given = count.is_some();
    let mut count = count.unwrap_or(USUAL).max(1);
    let arms = loop {
        let arms = arrange(&mut wheels, &ties, count, lattice, &place);
        let room = |arms: &Vec<f64>| clearance(&wheels, &ties, &planes, arms, &place).is_none_or(|c| c > 0.0);
        match arms {
            Some(arms) if given || count == 1 || room(&arms) => break arms,
            None if given || count == 1 => {
                return Err(format!("{count} planets alike fit at no angles around the axis"));
            }
            // Where the train does not say how many, as many as have room.
            _ => count -= 1,
        }
    };
    if lattice.is_some_and(|step| step > 0.99 * TAU) {
        notes.push("Planets alike fit at one angle only: on the others the steps stand otherwise.".to_owned());
    }
    let equal = arms.iter().zip(0..).all(|(arm, k)| (arm - wanted(k, count)).abs() < 1e-9);
    if !given {
        notes.push(format!("Number of planets not given, {count} drawn."));
    }
    let clearance_mm = clearance(&wheels, &ties, &planes, &arms, &place);
    let meshes = ties.iter().map(|t| mesh(links, &wheels, t)).collect();
    Ok(Built {
        meshes,
        planes,
        spacing: FrontSpacing { planets: count, given, angles: arms, equal, least_angle: lattice, clearance_mm },
        notes,
        wheels,
    })
}

/// Puts so many planets around the axis, each at the angle nearest to equal spacing at which it fits;
/// their angles, or nothing where one has no place of its own.
fn arrange(
    wheels: &mut [Placed],
    ties: &[Tie],
    count: u32,
    lattice: Option<f64>,
    place: &dyn Fn(&Placed, f64) -> [f64; 2],
) -> Option<Vec<f64>> {
    for w in wheels.iter_mut() {
        w.bodies.clear();
    }
    turn_first(wheels, ties, place);
    let mut arms = vec![0.0];
    for k in 1..count {
        let target = wanted(k, count);
        // Nearest first.
        let mut tried: Vec<f64> = match lattice {
            None => vec![target],
            Some(step) => {
                let middle = (target / step).round() as i64;
                (-TRIED..=TRIED).map(|j| (middle + j) as f64 * step).collect()
            }
        };
        tried.sort_by(|a, b| (a - target).abs().total_cmp(&(b - target).abs()));
        let taken = |arm: f64| {
            arms.iter().any(|other: &f64| {
                let turns = (arm - other) / TAU;
                (turns - turns.round()).abs() < 1e-6
            })
        };
        let (arm, bodies) = tried
            .into_iter()
            .filter(|arm| !taken(*arm))
            .find_map(|arm| Some((arm, turn_other(wheels, ties, arm, place)?)))?;
        for (w, body) in bodies {
            wheels[w].bodies.push(body);
        }
        arms.push(arm);
    }
    Some(arms)
}

/// The angle of a planet from the first where all are spaced equally.
fn wanted(k: u32, count: u32) -> f64 {
    TAU * f64::from(k) / f64::from(count)
}

/// The circles on which planets stand, and the angles within one family.
fn orbits(wheels: &[Placed], of_link: &[[usize; 2]], pairs: &[Pair]) -> Result<Orbits, String> {
    let mut all: Orbits = Vec::new();
    for (&[a, b], pair) in of_link.iter().zip(pairs) {
        let planet = match (wheels[a].planet, wheels[b].planet) {
            (true, false) => wheels[a].member,
            (false, true) => wheels[b].member,
            _ => continue,
        };
        if all.iter().all(|o| o.0 != planet) {
            all.push((planet, pair.centre_distance * 1e3, 0.0));
        }
    }
    // Planets that mesh with each other: a triangle with the carrier's axis.
    for (&[a, b], pair) in of_link.iter().zip(pairs) {
        if !(wheels[a].planet && wheels[b].planet) {
            continue;
        }
        let find = |m: usize| all.iter().position(|o| o.0 == m);
        let (Some(i), Some(j)) = (find(wheels[a].member), find(wheels[b].member)) else {
            return Err("a planet meshes with no central gear".to_owned());
        };
        let (p, q, d) = (all[i].1, all[j].1, pair.centre_distance * 1e3);
        let cosine = (p * p + q * q - d * d) / (2.0 * p * q);
        if cosine.abs() > 1.0 + 1e-12 {
            return Err(format!(
                "planets on circles of {p:.3} and {q:.3} mm cannot mesh at a centre distance of {d:.3} mm"
            ));
        }
        all[j].2 = all[i].2 + cosine.clamp(-1.0, 1.0).acos();
    }
    Ok(all)
}

/// Greatest common divisor of two amounts.
fn gcd(a: i128, b: i128) -> i128 {
    if b == 0 { a.abs() } else { gcd(b, a % b) }
}

fn reduced(a: i128, b: i128) -> (i128, i128) {
    let d = gcd(a, b).max(1) * b.signum();
    (a / d, b / d)
}

/// Who drives whom, starting from the first central gear, and the speeds of all; and whether two
/// wheels of one member would need different ones.
fn ties(wheels: &mut [Placed], of_link: &[[usize; 2]], pairs: Vec<Pair>) -> (Vec<Tie>, bool) {
    let root = wheels.iter().position(|w| !w.planet).unwrap_or(0);
    let mut known: Vec<(usize, (i128, i128))> = vec![(wheels[root].member, (1, 1))];
    let mut open: Vec<(usize, [usize; 2], Pair)> =
        of_link.iter().zip(pairs).enumerate().map(|(k, (w, p))| (k, *w, p)).collect();
    let (mut all, mut locked) = (Vec::new(), false);
    while !open.is_empty() {
        let speed = |m: usize| known.iter().find(|k| k.0 == m).map(|k| k.1);
        let next = open.iter().position(|(_, w, _)| w.iter().any(|&w| speed(wheels[w].member).is_some()));
        let (link, own, pair) = open.remove(next.unwrap_or(0));
        let driver = usize::from(speed(wheels[own[0]].member).is_none());
        let (from, to) = (&wheels[own[driver]], &wheels[own[1 - driver]]);
        let (n, d) = speed(from.member).unwrap_or((1, 1));
        let sign = if from.profile.internal || to.profile.internal { 1 } else { -1 };
        let turns = reduced(sign * n * i128::from(from.profile.teeth), d * i128::from(to.profile.teeth));
        match speed(to.member) {
            Some(other) => locked |= other != turns,
            None => known.push((to.member, turns)),
        }
        all.push(Tie { link, wheels: [own[driver], own[1 - driver]], driver, pair, turns });
    }
    for w in wheels.iter_mut() {
        let own = known.iter().find(|k| k.0 == w.member).map_or((0, 1), |k| k.1);
        w.turns = if locked { (0, 1) } else { own };
    }
    (all, locked)
}

/// Wheels side by side: at most one central gear of each kind and one step of each planet in a plane.
fn planes(wheels: &[Placed], ties: &[Tie]) -> Vec<FrontPlane> {
    let slot = |w: usize| match (wheels[w].planet, wheels[w].profile.internal) {
        (true, _) => 2 + wheels[w].member,
        (false, internal) => usize::from(internal),
    };
    let mut order: Vec<usize> = (0..ties.len()).collect();
    order.sort_by_key(|&t| ties[t].link);
    let mut planes: Vec<FrontPlane> = Vec::new();
    for t in order {
        let own = ties[t].wheels;
        let fits = |p: &FrontPlane| {
            own.iter().any(|w| p.wheels.contains(w))
                && own.iter().all(|&w| p.wheels.iter().all(|&o| o == w || slot(o) != slot(w)))
        };
        // The last that has room: in a Ravigneaux set the ring stands with the large sun.
        match planes.iter_mut().rev().find(|p| fits(p)) {
            Some(p) => {
                for w in own {
                    if !p.wheels.contains(&w) {
                        p.wheels.push(w);
                    }
                }
                p.meshes.push(t);
            }
            None => planes.push(FrontPlane { wheels: own.to_vec(), meshes: vec![t] }),
        }
    }
    planes
}

/// Smallest distance of the tips of planets that do not mesh with each other.
fn clearance(
    wheels: &[Placed],
    ties: &[Tie],
    planes: &[FrontPlane],
    arms: &[f64],
    place: &dyn Fn(&Placed, f64) -> [f64; 2],
) -> Option<f64> {
    let mut least: Option<f64> = None;
    for plane in planes {
        let planets: Vec<usize> = plane.wheels.iter().copied().filter(|&w| wheels[w].planet).collect();
        for (i, &a) in planets.iter().enumerate() {
            for &b in &planets[i..] {
                let meshing = ties.iter().any(|t| t.wheels == [a, b] || t.wheels == [b, a]);
                for (j, &arm) in arms.iter().enumerate() {
                    for (k, &other) in arms.iter().enumerate() {
                        if (a == b && k <= j) || (j == k && meshing) {
                            continue;
                        }
                        let (p, q) = (place(&wheels[a], arm), place(&wheels[b], other));
                        let gap = (p[0] - q[0]).hypot(p[1] - q[1]) - wheels[a].profile.tip - wheels[b].profile.tip;
                        least = Some(least.map_or(gap, |l| l.min(gap)));
                    }
                }
            }
        }
    }
    least
}

/// Every angle between planets is a multiple of this one, rad, as far as the first two central gears
/// tell; none where any angle fits.
///
/// The carrier turns by φ while the first gear stands: gear j turns by `φ (1 − i_j)`. Then the
/// first gear turns by n pitches, gear j by `n i_j/z_1`. Afterwards gear j looks as before when both
/// together are a multiple of its pitch, so φ is a multiple of `gcd(1/z_j, i_j/z_1)/(1 − i_j)` turns.
fn least_turn(wheels: &[Placed], ties: &[Tie]) -> Option<f64> {
    let central: Vec<&Placed> = wheels.iter().filter(|w| !w.planet).collect();
    let (first, second) = (central.first()?, central.get(1)?);
    let (p, q) = ties.iter().find(|t| std::ptr::eq(&wheels[t.wheels[1]], *second))?.turns;
    if p == q {
        return None;
    }
    let (z_1, z_j) = (i128::from(first.profile.teeth), i128::from(second.profile.teeth));
    // gcd(1/z_j, p/(q z_1)) over |1 − p/q|
    let top = gcd(q * z_1, p * z_j) * q;
    let bottom = z_j * q * z_1 * (q - p).abs();
    Some(TAU * top as f64 / bottom as f64)
}

/// Phase of the driven wheel when the driving one has this phase and the driven axis lies in this
/// direction: a tooth of one in a space of the other, and contact on the flank that is pushed.
fn driven(wheels: &[Placed], tie: &Tie, phase: f64, direction: f64) -> f64 {
    let [a, b] = tie.wheels.map(|w| &wheels[w]);
    let (p, q) = (a.profile.pitch(), b.profile.pitch());
    let sense = if a.turns.0 < 0 { -1.0 } else { 1.0 };
    let play = sense * tie.pair.backlash / (2.0 * tie.pair.gears[1 - tie.driver].operating_radius);
    if b.profile.internal || a.profile.internal {
        // Both axes lie on one side of the pitch point.
        let point = if b.profile.internal { direction + PI } else { direction };
        point + q * ((phase - point) / p + 0.5) - play
    } else {
        direction + PI - q * ((phase - direction) / p + 0.5) + play
    }
}

/// Direction from one axis to another.
fn direction(from: [f64; 2], to: [f64; 2]) -> f64 {
    (to[1] - from[1]).atan2(to[0] - from[0])
}

/// Turns the first family and the central gears.
fn turn_first(wheels: &mut [Placed], ties: &[Tie], place: &dyn Fn(&Placed, f64) -> [f64; 2]) {
    let mut phases: Vec<Option<f64>> = vec![None; wheels.len()];
    let centre: Vec<[f64; 2]> = wheels.iter().map(|w| place(w, FRAC_PI_2)).collect();
    if let Some(tie) = ties.first() {
        // Contact at the pitch point of the first mesh.
        let [a, b] = tie.wheels;
        let own = &wheels[a].profile;
        let point = match wheels[b].profile.internal {
            true => direction(centre[b], centre[a]),
            false => direction(centre[a], centre[b]),
        };
        phases[a] = Some(point - own.tooth(tie.pair.gears[tie.driver].operating_radius * 1e3));
    }
    for tie in ties {
        let [a, b] = tie.wheels;
        let from = phases[a].unwrap_or(0.0);
        phases[a] = Some(from);
        let at = driven(wheels, tie, from, direction(centre[a], centre[b]));
        phases[b] = Some(phases[b].unwrap_or(at));
        // Other steps of the same planet: one tooth of each in line.
        for k in 0..wheels.len() {
            if wheels[k].member == wheels[b].member && phases[k].is_none() {
                phases[k] = phases[b];
            }
        }
    }
    for (k, w) in wheels.iter_mut().enumerate() {
        w.bodies.push(FrontBody { centre_mm: centre[k], phase: phases[k].unwrap_or(0.0) });
    }
}

/// The planets of another family, which is like the first; nothing where they do not fit.
fn turn_other(
    wheels: &[Placed],
    ties: &[Tie],
    arm: f64,
    place: &dyn Fn(&Placed, f64) -> [f64; 2],
) -> Option<Vec<(usize, FrontBody)>> {
    let centre: Vec<[f64; 2]> = wheels.iter().map(|w| place(w, FRAC_PI_2 + arm)).collect();
    // Central gears stand already; a planet has turned by an angle that all its steps share.
    let first = |w: usize| wheels[w].bodies[0].phase;
    let mut turned: Vec<(usize, f64)> = Vec::new();
    let phase = |w: usize, turned: &[(usize, f64)]| match wheels[w].planet {
        false => Some(first(w)),
        true => turned.iter().find(|t| t.0 == wheels[w].member).map(|t| first(w) + t.1),
    };
    // Part of a pitch by which a tie misses.
    let miss = |tie: &Tie, turned: &[(usize, f64)]| -> Option<f64> {
        let [a, b] = tie.wheels;
        let at = driven(wheels, tie, phase(a, turned)?, direction(centre[a], centre[b]));
        let off = (phase(b, turned)? - at) / wheels[b].profile.pitch();
        Some((off - off.round()).abs())
    };
    for tie in ties {
        let [a, b] = tie.wheels;
        if !wheels[b].planet || turned.iter().any(|t| t.0 == wheels[b].member) {
            continue;
        }
        let at = driven(wheels, tie, phase(a, &turned)?, direction(centre[a], centre[b]));
        // Another tooth in the same space: a planet with steps is then another one.
        let member = wheels[b].member;
        let stepped = wheels.iter().filter(|w| w.member == member).count() > 1;
        let choices = if stepped { wheels[b].profile.teeth } else { 1 };
        let best = (0..choices)
            .map(|n| {
                let mut with = turned.clone();
                with.push((member, at - first(b) + f64::from(n) * wheels[b].profile.pitch()));
                let worst = ties.iter().filter_map(|t| miss(t, &with)).fold(0.0, f64::max);
                (worst, with)
            })
            .min_by(|a, b| a.0.total_cmp(&b.0))?;
        turned = best.1;
    }
    let worst = ties.iter().filter_map(|t| miss(t, &turned)).fold(0.0, f64::max);
    if worst > FITS {
        return None;
    }
    let planets = (0..wheels.len()).filter(|&w| wheels[w].planet);
    planets.map(|w| Some((w, FrontBody { centre_mm: centre[w], phase: phase(w, &turned)? }))).collect()
}

/// The path of contact of a mesh at the first planet.
fn mesh(links: &[Link], wheels: &[Placed], tie: &Tie) -> FrontMesh {
    let pair = &tie.pair;
    let [a, b] = tie.wheels.map(|w| &wheels[w]);
    let (p, q) = (a.bodies[0].centre_mm, b.bodies[0].centre_mm);
    let outward = if b.profile.internal { direction(q, p) } else { direction(p, q) };
    let alpha = pair.operating_pressure_angle;
    let radii = [tie.driver, 1 - tie.driver].map(|k| pair.gears[k].operating_radius * 1e3);
    let sense = if a.turns.0 < 0 { -1.0 } else { 1.0 };
    // The driving flank pushes along the motion of the pitch point and away from its own side.
    let away = if a.profile.internal { -1.0 } else { 1.0 };
    let (e, t) = ([outward.cos(), outward.sin()], [-outward.sin(), outward.cos()]);
    let along = |k: usize| away * alpha.sin() * e[k] + sense * alpha.cos() * t[k];
    let [b0, b1, _, d0, d1] = {
        let mut all = pair.breakpoints().map(|s| s * 1e3);
        if tie.driver == 1 {
            // Counted from the other end: A and E, B and D change places.
            all = [-all[4], -all[3], -all[2], -all[1], -all[0]];
        }
        all
    };
    let tan = alpha.tan();
    let base = [tie.driver, 1 - tie.driver].map(|k| pair.gears[k].base_radius * 1e3 * tan);
    let (c, n) = ([p[0] + radii[0] * e[0], p[1] + radii[0] * e[1]], [along(0), along(1)]);
    // How far the leading flank has run past A: on the line of action it travels as the base circle turns.
    let (x, y) = (c[0] + b0 * n[0] - p[0], c[1] + b0 * n[1] - p[1]);
    let flank = a.bodies[0].phase + sense * a.profile.tooth(x.hypot(y));
    let ahead = (sense * (flank - y.atan2(x))).rem_euclid(a.profile.pitch()) * a.profile.base;
    FrontMesh {
        name: links[tie.link].name.clone(),
        wheels: tie.wheels,
        centre_distance_mm: pair.centre_distance * 1e3,
        pressure_angle: alpha,
        backlash_mm: pair.backlash * 1e3,
        contact_ratio: pair.contact_ratio,
        pitch_radii_mm: radii,
        pitch_point_mm: c,
        direction: n,
        path_mm: [b0, b1, 0.0, d0, d1],
        base_points_mm: [-away * base[0], if b.profile.internal { -base[1] } else { base[1] }],
        base_pitch_mm: pair.base_pitch * 1e3,
        contact_mm: b0 + ahead,
    }
}
