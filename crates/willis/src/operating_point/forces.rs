//! Forces in space: where teeth press on gears, what that does to planets, carriers and shafts, and which bearing
//! carries it.
//!
//! Two gears press on each other with one force. Statics alone gives its part across the line of centres: the torques
//! on both gears, divided by the centre distance, whatever friction does. The pressure angle gives the part along the
//! line of centres, the helix the thrust. On a planet these forces and the centrifugal force add as vectors; the carrier
//! gets what the planets get, of several planets in a circle the thrust alone. Each shaft hands its loads to its
//! bearings as a rigid body.
//!
//! Directions are known relative to each other within a set, and between pairs of fixed axes whose `angle` is given.
//! Loads whose directions are not known relative to each other are added by amount at each bearing, the most that they
//! can do there. An outer planet may lead or trail its inner one; the larger load of the two counts.

use num_dual::{Dual, DualNum};
use serde::{Deserialize, Serialize};
use smallvec::{SmallVec, smallvec};

use crate::power_flow::MeshFlow;
use crate::real::{self, Real};
use crate::train::{FRAME, MemberId, Train};

use super::Physics;
use super::numbers::Numbers;
use super::support::Springs;

/// What the teeth and planets do to a shaft on bearings, and what of it the bearings of the train do not carry.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ShaftLoad {
    /// Radial force, N: sum of amounts where directions are not known relative to each other.
    pub radial_n: f64,
    /// Thrust along the axis, N; positive towards growing positions.
    pub thrust_n: f64,
    /// Tilting moment about the origin of the positions, N m.
    pub tilting_n_m: f64,
    /// Radial force that no bearing of the train carries, N.
    pub uncarried_radial_n: f64,
    /// Thrust that no bearing of the train carries, N.
    pub uncarried_thrust_n: f64,
    /// Tilting moment that no bearing of the train carries, N m: gears or other shafts must.
    pub uncarried_tilting_n_m: f64,
}

/// A vector in the plane of rotation.
type Plane<R> = [R; 2];

fn add<R: Real>(a: &mut Plane<R>, b: Plane<R>) {
    a[0] += b[0];
    a[1] += b[1];
}

fn times<R: Real>(v: Plane<R>, k: R) -> Plane<R> {
    [v[0] * k, v[1] * k]
}

fn length<R: Real>([x, y]: Plane<R>) -> R {
    let square = x * x + y * y;
    if square.re() > 0.0 { square.sqrt() } else { R::from(0.0) }
}

/// Forces in the plane of rotation, and the moment that tilts an axis in the direction of its vector: a force `f` at
/// the position `z` tilts by `z f`.
#[derive(Clone, Copy, Debug)]
struct Wrench<R> {
    force: Plane<R>,
    tilt: Plane<R>,
}

impl<R: Real> Wrench<R> {
    fn none() -> Self {
        let none = [R::from(0.0); 2];
        Self { force: none, tilt: none }
    }

    fn add(&mut self, other: &Self) {
        add(&mut self.force, other.force);
        add(&mut self.tilt, other.tilt);
    }
}

/// What a member is to the bearings.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Body {
    Frame,
    /// A planet, by its place among the planets of the train.
    Planet(usize),
    /// Anything on a fixed axis: a shaft and all that is joined to it for good.
    Shaft(usize),
}

/// Where the two gears of a mesh touch.
#[derive(Clone, Copy, Debug)]
struct Touch<R> {
    bodies: [Body; 2],
    /// From the axis of each gear towards the contact.
    toward: [Plane<R>; 2],
    /// Within which directions are known relative to each other.
    group: usize,
    /// Whether forces on shafts stand alone: of several planets in a circle they cancel.
    single: bool,
    /// Two planets whose places are not known relative to each other.
    unplaced: bool,
    /// Of the operating pressure angle: tangent and cosine.
    slope: R,
    cosine: R,
    /// Thrust over the force across the line of centres.
    helix: R,
}

/// The place of a planet.
#[derive(Clone, Copy, Debug)]
struct Seat<R> {
    carrier: Body,
    group: usize,
    /// From the axis of the carrier.
    toward: Plane<R>,
    /// How many there are.
    count: u32,
    single: bool,
    /// Position of its mass along the axis.
    position: R,
}

/// Bearings side by side.
#[derive(Clone, Copy, Debug)]
struct Place<R> {
    /// The planet, or the two shafts; `None` is the frame.
    on: On,
    count: u32,
    middle: R,
    span: R,
    /// Whether they carry radial loads.
    radial: bool,
    /// Whether the thrust of their shaft is theirs.
    locates: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum On {
    Planet(usize),
    Shafts([Option<usize>; 2]),
}

impl<R: Real> Place<R> {
    /// Positions of the bearings, or of eight that stand for more.
    fn positions(&self) -> impl Iterator<Item = R> + use<R> {
        let (middle, span) = (self.middle, self.span);
        let several = span.re() > 0.0 && self.count > 1;
        let n = if several { self.count.min(8) } else { 1 };
        (0..n).map(move |k| if n > 1 { middle + span * (f64::from(k) / f64::from(n - 1) - 0.5) } else { middle })
    }

    /// Number, sum of positions and of their squares.
    fn moments(&self) -> [R; 3] {
        if !self.radial {
            return [R::from(0.0); 3];
        }
        let n = f64::from(self.count);
        let spread = if self.count > 1 { n * (n + 1.0) / (12.0 * (n - 1.0)) } else { 0.0 };
        [R::from(n), self.middle * n, self.middle * self.middle * n + self.span * self.span * spread]
    }
}

/// Where everything stands that carries or presses: follows from the train alone. Empty where there are no bearings.
#[derive(Clone, Debug)]
pub(super) struct Forces<R> {
    touches: Vec<Option<Touch<R>>>,
    /// Of each mesh along the axis.
    positions: Vec<R>,
    seats: Vec<Seat<R>>,
    places: Vec<Place<R>>,
    /// By planet.
    beams: Vec<Beam<R>>,
    /// Families of planets whose mirror image is another train.
    mirrored: Vec<usize>,
    groups: usize,
    /// A member of each shaft, for its name.
    shafts: Vec<MemberId>,
    /// Of the shafts on bearings, those that hang together: radial springs (force and tilt of each), axial springs.
    systems: Vec<System<R>>,
}

#[derive(Clone, Debug)]
struct System<R> {
    shafts: Vec<usize>,
    radial: Springs<R>,
    axial: Springs<R>,
}

/// What the bearings of one place carry of the tooth forces and of the rest.
pub(super) struct Carried<R> {
    /// Radial load of each bearing, with its derivative by a factor on all tooth forces.
    pub radial: SmallVec<[Dual<R>; 2]>,
    /// Axial load on all of them, in the same form.
    pub axial: Dual<R>,
    /// The meshes that make the load, with the sizes of their forces.
    pub loading: SmallVec<[(usize, R); 4]>,
}

/// What all bearings carry.
pub(super) struct Reactions<R> {
    pub places: Vec<Carried<R>>,
    pub shafts: Vec<(MemberId, ShaftLoad)>,
}

/// Forces of one mesh on its gears.
struct Pressed<R> {
    wrench: [Wrench<R>; 2],
    thrust: [R; 2],
    /// Across the line of centres.
    size: R,
    /// In the plane of rotation.
    amount: R,
    /// Largest of the moments by which its thrust tilts a gear.
    tilt: R,
}

/// Which body each member belongs to, and a member of each shaft.
fn bodies(train: &Train) -> (Vec<Body>, Vec<MemberId>) {
    let mut root: Vec<usize> = (0..train.members.len()).collect();
    fn find(root: &[usize], mut k: usize) -> usize {
        while root[k] != k {
            k = root[k];
        }
        k
    }
    for [a, b] in &train.joints {
        let (a, b) = (find(&root, a.0), find(&root, b.0));
        // The frame stays the frame, and a member keeps its name before a terminal that is joined to it.
        root[a.max(b)] = a.min(b);
    }
    let mut shafts: Vec<MemberId> = Vec::new();
    let all = (0..train.members.len())
        .map(|m| {
            let m = MemberId(find(&root, m));
            if m == FRAME {
                return Body::Frame;
            }
            if let Some(p) = train.planets.iter().position(|p| p.member == m) {
                return Body::Planet(p);
            }
            Body::Shaft(shafts.iter().position(|s| *s == m).unwrap_or_else(|| {
                shafts.push(m);
                shafts.len() - 1
            }))
        })
        .collect();
    (all, shafts)
}

impl<R: Real> Forces<R> {
    pub fn new(train: &Train, numbers: &Numbers<R>) -> Self {
        if train.bearings.is_empty() {
            let (touches, positions, seats, places, beams) = Default::default();
            let (mirrored, shafts, systems) = Default::default();
            return Self { touches, positions, seats, places, beams, mirrored, groups: 0, shafts, systems };
        }
        let none = R::from(0.0);
        let (of, shafts) = bodies(train);
        let body = |m: MemberId| of[m.0];
        // Bevel gears press on axes that intersect: what that does to bearings is not worked out.
        let teeth = |j: usize| numbers.teeth[j].as_ref().filter(|t| t.cones.is_none());
        let positions: Vec<R> =
            (0..train.meshes.len()).map(|j| teeth(j).and_then(|t| t.position).unwrap_or(none)).collect();
        // Group 0 are the directions of the housing; each family of planets is one, each pair of unknown angle one.
        let mut groups = 1;
        let (seats, mirrored) = seats(train, numbers, &of, &positions, &mut groups);
        let touches: Vec<Option<Touch<R>>> = (0..train.meshes.len())
            .map(|j| {
                let mesh = &train.meshes[j];
                let pair = &teeth(j)?.pair;
                let internal = pair.internal();
                let both = [0, 1].map(|k| body(mesh.gears[k].member));
                // From the axis of the gear inside to that of the ring around it, or from the first to the second.
                let (direction, group, unplaced) = match both {
                    [Body::Planet(a), Body::Planet(b)] if seats[a].group == seats[b].group => {
                        let far = |p: usize| times(seats[p].toward, numbers.planets[p][0]);
                        let (from, to) = (far(a), far(b));
                        let line = [to[0] - from[0], to[1] - from[1]];
                        (times(line, length(line).recip()), seats[a].group, false)
                    }
                    [Body::Planet(a), Body::Planet(_)] => ([R::from(1.0), none], seats[a].group, true),
                    // A central gear stands inwards of its planet.
                    [Body::Planet(p), _] => (times(seats[p].toward, R::from(-1.0)), seats[p].group, false),
                    [_, Body::Planet(p)] => (seats[p].toward, seats[p].group, false),
                    _ => match mesh.angle {
                        Some(angle) => ([R::from(angle.cos()), R::from(angle.sin())], 0, false),
                        None => {
                            groups += 1;
                            ([R::from(1.0), none], groups - 1, false)
                        }
                    },
                };
                let back = times(direction, R::from(-1.0));
                let toward = match (internal, mesh.gears[0].internal) {
                    (false, _) => [direction, back],
                    // Both gears reach out to the same side, away from the axis of the ring.
                    (true, true) => [direction; 2],
                    (true, false) => [back; 2],
                };
                // A set whose number of planets is not told is taken as balanced.
                let single = mesh.count == 1 && mesh.set.is_none_or(|s| train.sets[s].planets.is_some());
                let (slope, cosine) = (pair.operating_pressure_angle.tan(), pair.operating_pressure_angle.cos());
                let helix = match pair.data.double_helical {
                    true => none,
                    false => real::abs(pair.operating_helix.tan()),
                };
                Some(Touch { bodies: both, toward, group, single, unplaced, slope, cosine, helix })
            })
            .collect();

        let on = |members: [MemberId; 2]| {
            let [a, b] = members.map(body);
            match (a, b) {
                (Body::Planet(p), _) | (_, Body::Planet(p)) => On::Planet(p),
                _ => On::Shafts([a, b].map(|x| if let Body::Shaft(s) = x { Some(s) } else { None })),
            }
        };
        let meshes_of = |on: On| {
            let touches = &touches;
            (0..train.meshes.len()).filter(move |j| {
                touches[*j].as_ref().is_some_and(|t| {
                    t.bodies.iter().any(|x| match (on, *x) {
                        (On::Planet(p), Body::Planet(q)) => p == q,
                        (On::Shafts(both), Body::Shaft(s)) => both.contains(&Some(s)),
                        _ => false,
                    })
                })
            })
        };
        let mean = |all: &mut dyn Iterator<Item = R>| {
            let (mut sum, mut n) = (none, 0.0);
            for x in all {
                sum += x;
                n += 1.0;
            }
            if n > 0.0 { Some(sum / n) } else { None }
        };
        let middle = |on: On| {
            mean(&mut meshes_of(on).map(|j| positions[j])).or_else(|| {
                let On::Shafts(both) = on else { return None };
                let carried = seats.iter().filter(|s| matches!(s.carrier, Body::Shaft(c) if both.contains(&Some(c))));
                mean(&mut carried.map(|s| s.position))
            })
        };
        let mut places: Vec<Place<R>> = (train.bearings.iter().zip(&numbers.bearings))
            .map(|(mount, own)| {
                let on = on(mount.members);
                let face = |j: usize| teeth(j).map_or(none, |t| t.pair.total_width());
                Place {
                    on,
                    count: mount.count,
                    middle: own.position.or_else(|| middle(on)).unwrap_or(none),
                    span: own.span.unwrap_or_else(|| meshes_of(on).map(face).fold(none, real::max)),
                    radial: mount.bearing.takes_radial_load(),
                    locates: false,
                }
            })
            .collect();
        locate(train, &mut places, shafts.len());
        let systems = systems(&places, shafts.len());
        let beams = (0..train.planets.len()).map(|p| Beam::of(p, &places)).collect();
        Self { touches, positions, seats, places, beams, mirrored, groups, shafts, systems }
    }
}

/// Where the planets stand on their carriers: each family of planets in mesh has directions of its own, those whose
/// places follow from three centre distances. The second list are the families whose mirror image differs.
fn seats<R: Real>(
    train: &Train,
    numbers: &Numbers<R>,
    of: &[Body],
    positions: &[R],
    groups: &mut usize,
) -> (Vec<Seat<R>>, Vec<usize>) {
    let (none, one) = (R::from(0.0), R::from(1.0));
    let mut seats: Vec<Option<Seat<R>>> = vec![None; train.planets.len()];
    let mut mirrored = Vec::new();
    let planet = |m: MemberId| train.planets.iter().position(|p| p.member == m);
    let blank = |p: usize, group: usize, toward: &Plane<R>| {
        let own = &train.planets[p];
        let mesh = &train.meshes[own.mesh.0];
        let at: Vec<R> = (0..train.meshes.len())
            .filter(|j| {
                train.meshes[*j].gears.iter().any(|g| g.member == own.member)
                    && numbers.teeth[*j].as_ref().is_some_and(|t| t.cones.is_none())
            })
            .map(|j| positions[j])
            .collect();
        Seat {
            carrier: of[own.carrier.0],
            group,
            toward: *toward,
            count: own.count,
            single: own.count == 1 && mesh.set.is_none_or(|s| train.sets[s].planets.is_some()),
            position: at.iter().fold(none, |sum, z| sum + *z) / (at.len().max(1) as f64),
        }
    };
    for first in 0..train.planets.len() {
        if seats[first].is_some() {
            continue;
        }
        let group = *groups;
        *groups += 1;
        seats[first] = Some(blank(first, group, &[one, none]));
        let mut open = vec![first];
        while let Some(p) = open.pop() {
            let here = seats[p].expect("it was placed");
            for (j, mesh) in train.meshes.iter().enumerate() {
                let both = [0, 1].map(|k| planet(mesh.gears[k].member));
                let [Some(a), Some(b)] = both else { continue };
                let other = if a == p { b } else { a };
                if (a != p && b != p) || seats[other].is_some() || mesh.carrier != train.planets[p].carrier {
                    continue;
                }
                let Some(teeth) = &numbers.teeth[j] else { continue };
                let (r, s, d) = (numbers.planets[p][0], numbers.planets[other][0], teeth.pair.centre_distance);
                let cosine = (r * r + s * s - d * d) / (r * s * 2.0);
                // Outside there is no such triangle: their places stay unknown.
                if cosine.re().abs() > 1.0 || !cosine.re().is_finite() {
                    continue;
                }
                let sine = (-(cosine * cosine) + 1.0).max_zero_sqrt();
                let [x, y] = here.toward;
                let toward = [x * cosine - y * sine, x * sine + y * cosine];
                seats[other] = Some(blank(other, group, &toward));
                open.push(other);
                if !mirrored.contains(&group) {
                    mirrored.push(group);
                }
            }
        }
    }
    (seats.into_iter().map(|s| s.expect("every planet was placed")).collect(), mirrored)
}

/// The root of what round-off may have put below zero.
trait Root {
    fn max_zero_sqrt(self) -> Self;
}

impl<R: Real> Root for R {
    fn max_zero_sqrt(self) -> Self {
        if self.re() > 0.0 { self.sqrt() } else { R::from(0.0) }
    }
}

/// Which bearings take the thrust: those of which it is said; then, in the order of the file, whatever can and ties a
/// shaft to something that it is not tied to yet; last, where nothing can, what cannot.
fn locate<R>(train: &Train, places: &mut [Place<R>], shafts: usize) {
    // Shafts, the frame behind them, the planets behind it: a planet is held by its carrier.
    let mut root: Vec<usize> = (0..shafts + 1 + train.planets.len()).collect();
    fn find(root: &[usize], mut k: usize) -> usize {
        while root[k] != k {
            k = root[k];
        }
        k
    }
    let ends = |on: On| match on {
        On::Planet(p) => [shafts + 1 + p, shafts],
        On::Shafts(both) => both.map(|s| s.unwrap_or(shafts)),
    };
    for pass in 0..3 {
        for (place, mount) in places.iter_mut().zip(&train.bearings) {
            let [a, b] = ends(place.on).map(|k| find(&root, k));
            let can = mount.bearing.takes_thrust();
            let wanted = match (pass, mount.locates) {
                (0, said) => said == Some(true),
                (_, Some(_)) => false,
                (1, None) => can && a != b,
                (_, None) => a != b,
            };
            if wanted {
                place.locates = true;
                root[a] = b;
            }
        }
    }
}

/// The shafts that hang together by bearings, the frame apart, with the springs between them.
fn systems<R: Real>(places: &[Place<R>], shafts: usize) -> Vec<System<R>> {
    let none = R::from(0.0);
    let mut seen = vec![false; shafts];
    let mut all = Vec::new();
    let joined = |s: usize| {
        places.iter().filter_map(move |p| match p.on {
            On::Shafts([Some(a), b]) if a == s => Some(b),
            On::Shafts([a, Some(b)]) if b == s => Some(a),
            _ => None,
        })
    };
    for first in 0..shafts {
        if seen[first] || joined(first).next().is_none() {
            continue;
        }
        seen[first] = true;
        let (mut own, mut next) = (vec![first], 0);
        while next < own.len() {
            for other in joined(own[next]).flatten() {
                if !std::mem::replace(&mut seen[other], true) {
                    own.push(other);
                }
            }
            next += 1;
        }
        let n = own.len();
        let mut radial = vec![vec![none; 2 * n]; 2 * n];
        let mut axial = vec![vec![none; n]; n];
        for place in places {
            let On::Shafts(both) = place.on else { continue };
            let at = both.map(|s| s.and_then(|s| own.iter().position(|o| *o == s)));
            if at == [None, None] {
                continue;
            }
            let [count, first, second] = place.moments();
            for (a, sa) in at.iter().zip([1.0, -1.0]).filter_map(|(a, s)| Some(((*a)?, s))) {
                for (b, sb) in at.iter().zip([1.0, -1.0]).filter_map(|(b, s)| Some(((*b)?, s))) {
                    let sign = sa * sb;
                    for (i, j, k) in [(0, 0, count), (0, 1, first), (1, 0, first), (1, 1, second)] {
                        radial[2 * a + i][2 * b + j] += k * sign;
                    }
                    if place.locates {
                        axial[a][b] += R::from(f64::from(place.count) * sign);
                    }
                }
            }
        }
        all.push(System { shafts: own, radial: Springs::new(radial), axial: Springs::new(axial) });
    }
    all
}

/// A force in proportion to the tooth forces.
fn proportional<R: Real>(x: R) -> Dual<R> {
    Dual::new(x, x)
}

/// Size of a force that has a part in proportion to the tooth forces.
fn size<R: Real>(teeth: Plane<R>, rest: Plane<R>) -> Dual<R> {
    let [x, y] = [0, 1].map(|k| proportional(teeth[k]) + Dual::from_re(rest[k]));
    let square = x * x + y * y;
    if square.re.re() > 0.0 { square.sqrt() } else { Dual::from_re(R::from(0.0)) }
}

impl<R: Real> Physics<'_, R> {
    /// The forces of one mesh on its two gears; of planets, on one of them. `side` is -1 for the mirror image.
    fn pressed(&self, m: &MeshFlow<R>, side: f64) -> Option<(Touch<R>, Pressed<R>)> {
        let mesh = &self.train.meshes[m.mesh.0];
        let mut touch = self.forces.touches[m.mesh.0]?;
        let teeth = self.numbers.teeth[m.mesh.0].as_ref()?;
        for toward in &mut touch.toward {
            toward[1] *= side;
        }
        let pair = &teeth.pair;
        let z = self.forces.positions[m.mesh.0];
        let moments = [0, 1].map(|k| -m.torques[k] / f64::from(mesh.count));
        let radius = [0, 1].map(|k| pair.gears[k].operating_radius);
        let sense = if pair.internal() { -1.0 } else { 1.0 };
        // On the first gear, along its own direction of rotation: friction moves it between the two radii, and their
        // sum is the centre distance.
        let across = (moments[0] + moments[1]) / (radius[0] + radius[1] * sense);
        let size = real::abs(across);
        let apart = size * touch.slope;
        let mut thrust = [R::from(0.0); 2];
        let mut tilt = R::from(0.0);
        let wrench = [0, 1].map(|k| {
            let e = touch.toward[k];
            let own = if k == 0 { across } else { across * sense };
            // Teeth press gears apart: a pinion towards its own axis, a ring outward.
            let outward = if mesh.gears[k].internal { apart } else { -apart };
            let force = [-e[1] * own + e[0] * outward, e[0] * own + e[1] * outward];
            // On a right-handed flank a force along the rotation pushes backward.
            thrust[k] = own * touch.helix * -teeth.hand_of(k);
            let lever = radius[k] * thrust[k];
            tilt = real::max(tilt, real::abs(lever));
            Wrench { force, tilt: [force[0] * z - e[0] * lever, force[1] * z - e[1] * lever] }
        });
        let amount = size / touch.cosine;
        Some((touch, Pressed { wrench, thrust, size, amount, tilt }))
    }

    /// What every bearing carries at these speeds and torques.
    pub(super) fn reactions(&self, speeds: &[R], meshes: &[MeshFlow<R>]) -> Reactions<R> {
        let forces = &self.forces;
        if forces.places.is_empty() {
            return Reactions { places: vec![], shafts: vec![] };
        }
        let planets = forces.seats.len();
        // The mirror image of a family counts where it loads the planets more.
        let mut flipped: SmallVec<[bool; 8]> = smallvec![false; forces.groups];
        if !forces.mirrored.is_empty() {
            let load = |side: f64| {
                let mut all = vec![Wrench::none(); planets];
                for m in meshes {
                    let Some((touch, pressed)) = self.pressed(m, side) else { continue };
                    for k in 0..2 {
                        if let (Body::Planet(p), false) = (touch.bodies[k], touch.unplaced) {
                            all[p].add(&pressed.wrench[k]);
                        }
                    }
                }
                all
            };
            let both = [load(1.0), load(-1.0)];
            for group in &forces.mirrored {
                let [here, there] = [0, 1].map(|k| {
                    let own = (0..planets).filter(|p| forces.seats[*p].group == *group);
                    own.map(|p| length(both[k][p].force).re()).fold(0.0, f64::max)
                });
                // Round-off does not choose.
                flipped[*group] = there > here * (1.0 + 1e-9);
            }
        }
        let side = |group: usize| if flipped[group] { -1.0 } else { 1.0 };

        let none = R::from(0.0);
        let fixed = Dual::<R>::from_re;
        let mut on_planets: SmallVec<[PlanetLoad<R>; 2]> = smallvec![PlanetLoad::none(); planets];
        let mut on_shafts = ShaftLoads::none(forces);
        let unloaded = |place: &Place<R>| Carried {
            radial: place.positions().map(|_| fixed(none)).collect(),
            axial: fixed(none),
            loading: SmallVec::new(),
        };
        let mut places: Vec<Carried<R>> = forces.places.iter().map(unloaded).collect();
        for (j, m) in meshes.iter().enumerate() {
            let Some(group) = forces.touches[m.mesh.0].map(|t| t.group) else { continue };
            let Some((touch, pressed)) = self.pressed(m, side(group)) else { continue };
            let count = f64::from(self.train.meshes[m.mesh.0].count);
            for k in 0..2 {
                match touch.bodies[k] {
                    Body::Frame => {}
                    Body::Planet(p) => {
                        let own = &mut on_planets[p];
                        own.thrust += pressed.thrust[k];
                        if touch.unplaced {
                            own.extra += pressed.amount;
                            own.extra_tilt += pressed.tilt;
                        } else {
                            own.wrench.add(&pressed.wrench[k]);
                        }
                    }
                    Body::Shaft(s) => {
                        on_shafts.thrust[s] += pressed.thrust[k] * count;
                        if touch.single {
                            on_shafts.teeth(touch.group, s).add(&pressed.wrench[k]);
                        }
                    }
                }
            }
            let thrusts = pressed.thrust.iter().any(|t| t.re() != 0.0);
            for (place, own) in forces.places.iter().zip(&mut places) {
                let here = touch.bodies.iter().any(|b| match (place.on, *b) {
                    (On::Planet(p), Body::Planet(q)) => p == q,
                    (On::Shafts(both), Body::Shaft(s)) => both.contains(&Some(s)) && (touch.single || thrusts),
                    _ => false,
                });
                if here {
                    own.loading.push((j, pressed.size));
                }
            }
        }
        for (p, seat) in forces.seats.iter().enumerate() {
            let [orbit, mass] = self.numbers.planets[p];
            let pull = mass * speeds[self.train.planets[p].carrier.0].powi(2) * orbit;
            let own = &mut on_planets[p];
            let [x, y] = seat.toward;
            let outward = times([x, y * side(seat.group)], pull);
            own.centrifugal = Wrench { force: outward, tilt: times(outward, seat.position) };
            if let Body::Shaft(carrier) = seat.carrier {
                on_shafts.thrust[carrier] += own.thrust * f64::from(seat.count);
                if seat.single {
                    on_shafts.teeth(seat.group, carrier).add(&own.wrench);
                    on_shafts.rest(seat.group, carrier).add(&own.centrifugal);
                }
            }
        }

        for (beam, load) in forces.beams.iter().zip(&on_planets) {
            for k in &beam.places {
                let (place, own) = (&forces.places[*k], &mut places[*k]);
                if place.locates {
                    own.axial = proportional(real::abs(load.thrust) * (f64::from(place.count) / beam.locating));
                }
                for (radial, z) in own.radial.iter_mut().zip(place.positions()).filter(|_| place.radial) {
                    let known = size(beam.at(&load.wrench, z), beam.at(&load.centrifugal, z));
                    *radial = known + proportional(beam.at_most(load.extra, load.extra_tilt, z));
                }
            }
        }
        let mut shafts = Vec::with_capacity(forces.shafts.len());
        for system in &forces.systems {
            self.share(system, &on_shafts, &mut places, &mut shafts);
        }
        Reactions { places, shafts }
    }

    /// The loads of shafts that hang together, on their bearings.
    fn share(
        &self,
        system: &System<R>,
        loads: &ShaftLoads<R>,
        carried: &mut [Carried<R>],
        shafts: &mut Vec<(MemberId, ShaftLoad)>,
    ) {
        let forces = &self.forces;
        let none = R::from(0.0);
        let n = system.shafts.len();
        let at = |s: Option<usize>| s.and_then(|s| system.shafts.iter().position(|o| *o == s));
        let mut sums: SmallVec<[ShaftLoad; 4]> = smallvec![
            ShaftLoad {
                radial_n: 0.0,
                thrust_n: 0.0,
                tilting_n_m: 0.0,
                uncarried_radial_n: 0.0,
                uncarried_thrust_n: 0.0,
                uncarried_tilting_n_m: 0.0
            };
            n
        ];
        for group in loads.groups.iter().filter(|g| system.shafts.iter().any(|s| g.touched[*s])) {
            // Teeth and rest, in both directions of the plane.
            let solved = [&group.teeth, &group.rest].map(|wrenches| {
                [0, 1].map(|k| {
                    let loads: SmallVec<[R; 8]> =
                        (system.shafts.iter()).flat_map(|s| [wrenches[*s].force[k], wrenches[*s].tilt[k]]).collect();
                    let moved = system.radial.solve(&loads);
                    (loads, moved)
                })
            });
            for (i, sum) in sums.iter_mut().enumerate() {
                let whole = |dof: usize| {
                    let [x, y] = [0, 1].map(|k| (solved[0][k].0[dof] + solved[1][k].0[dof]).re());
                    x.hypot(y)
                };
                let rest = |dof: usize| {
                    let one = |part: usize, k: usize| {
                        let (loads, moved) = &solved[part][k];
                        system.radial.rest(dof, loads, moved).re()
                    };
                    (one(0, 0) + one(1, 0)).hypot(one(0, 1) + one(1, 1))
                };
                sum.radial_n += whole(2 * i);
                sum.tilting_n_m += whole(2 * i + 1);
                sum.uncarried_radial_n += rest(2 * i);
                sum.uncarried_tilting_n_m += rest(2 * i + 1);
            }
            for (place, own) in forces.places.iter().zip(carried.iter_mut()) {
                let On::Shafts(both) = place.on else { continue };
                let ends = both.map(at);
                if ends == [None, None] || !place.radial {
                    continue;
                }
                for (radial, z) in own.radial.iter_mut().zip(place.positions()) {
                    let force = |part: usize| {
                        [0, 1].map(|k| {
                            let moved = &solved[part][k].1;
                            let one = |end: Option<usize>| end.map_or(none, |i| moved[2 * i] + moved[2 * i + 1] * z);
                            one(ends[0]) - one(ends[1])
                        })
                    };
                    *radial += size(force(0), force(1));
                }
            }
        }
        let thrusts: SmallVec<[R; 8]> = system.shafts.iter().map(|s| loads.thrust[*s]).collect();
        let moved = system.axial.solve(&thrusts);
        for (i, sum) in sums.iter_mut().enumerate() {
            sum.thrust_n = thrusts[i].re();
            sum.uncarried_thrust_n = system.axial.rest(i, &thrusts, &moved).re();
        }
        for (place, own) in forces.places.iter().zip(carried.iter_mut()) {
            let On::Shafts(both) = place.on else { continue };
            let ends = both.map(at);
            if ends == [None, None] || !place.locates {
                continue;
            }
            let one = |end: Option<usize>| end.map_or(none, |i| moved[i]);
            let thrust = real::abs(one(ends[0]) - one(ends[1])) * f64::from(place.count);
            own.axial = Dual::new(thrust, thrust);
        }
        shafts.extend(system.shafts.iter().map(|s| forces.shafts[*s]).zip(sums));
    }
}

/// The bearings of one kind of planet: its axis on them as a beam.
#[derive(Clone, Debug)]
struct Beam<R> {
    places: Vec<usize>,
    /// Bearings that carry radial loads.
    count: R,
    /// Their mean position, and the sum of squares of their distances from it; 0 where nothing keeps the axis from
    /// tilting.
    centre: R,
    spread: R,
    /// Bearings that share the thrust.
    locating: f64,
}

impl<R: Real> Beam<R> {
    fn of(planet: usize, places: &[Place<R>]) -> Self {
        let none = R::from(0.0);
        let own: Vec<usize> = (0..places.len()).filter(|k| places[*k].on == On::Planet(planet)).collect();
        let [count, first, second] = (own.iter().map(|k| places[*k].moments()))
            .fold([none; 3], |sum, m| [sum[0] + m[0], sum[1] + m[1], sum[2] + m[2]]);
        let centre = if count.re() > 0.0 { first / count } else { none };
        let spread = second - first * centre;
        let tilts = spread.re() > 1e-9 * second.re();
        let locating = own.iter().filter(|k| places[**k].locates).map(|k| f64::from(places[*k].count)).sum();
        Self { places: own, count, centre, spread: if tilts { spread } else { none }, locating }
    }

    /// What one bearing at a position carries.
    fn at(&self, load: &Wrench<R>, z: R) -> Plane<R> {
        [0, 1].map(|k| {
            let even = load.force[k] / self.count;
            match self.spread.re() > 0.0 {
                true => even + (load.tilt[k] - load.force[k] * self.centre) / self.spread * (z - self.centre),
                false => even,
            }
        })
    }

    /// The same of a force and a moment of unknown direction, by amount.
    fn at_most(&self, force: R, tilt: R, z: R) -> R {
        let even = force / self.count;
        if self.spread.re() > 0.0 { even + tilt / self.spread * real::abs(z - self.centre) } else { even }
    }
}

/// What one planet feels.
#[derive(Clone, Copy)]
struct PlanetLoad<R> {
    wrench: Wrench<R>,
    centrifugal: Wrench<R>,
    thrust: R,
    /// Forces whose direction is not known, by amount, and their tilting moments.
    extra: R,
    extra_tilt: R,
}

impl<R: Real> PlanetLoad<R> {
    fn none() -> Self {
        let none = R::from(0.0);
        Self { wrench: Wrench::none(), centrifugal: Wrench::none(), thrust: none, extra: none, extra_tilt: none }
    }
}

/// Loads on all shafts whose directions are known relative to each other.
struct Group<R> {
    number: usize,
    touched: SmallVec<[bool; 8]>,
    teeth: SmallVec<[Wrench<R>; 4]>,
    rest: SmallVec<[Wrench<R>; 4]>,
}

/// Loads on all shafts.
struct ShaftLoads<R> {
    groups: SmallVec<[Group<R>; 1]>,
    thrust: SmallVec<[R; 8]>,
}

impl<R: Real> ShaftLoads<R> {
    fn none(forces: &Forces<R>) -> Self {
        Self { groups: SmallVec::new(), thrust: smallvec![R::from(0.0); forces.shafts.len()] }
    }

    fn group(&mut self, number: usize, shaft: usize) -> &mut Group<R> {
        let n = self.thrust.len();
        let at = self.groups.iter().position(|g| g.number == number).unwrap_or_else(|| {
            let none: SmallVec<[Wrench<R>; 4]> = smallvec![Wrench::none(); n];
            self.groups.push(Group { number, touched: smallvec![false; n], teeth: none.clone(), rest: none });
            self.groups.len() - 1
        });
        self.groups[at].touched[shaft] = true;
        &mut self.groups[at]
    }

    fn teeth(&mut self, number: usize, shaft: usize) -> &mut Wrench<R> {
        &mut self.group(number, shaft).teeth[shaft]
    }

    fn rest(&mut self, number: usize, shaft: usize) -> &mut Wrench<R> {
        &mut self.group(number, shaft).rest[shaft]
    }
}
