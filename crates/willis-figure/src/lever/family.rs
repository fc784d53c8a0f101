//! From meshes to levers: which gears share one, and where they stand on it.

use willis::exact::Rational;
use willis::train::{FRAME, Gear, MemberId, MemberKind, Train};

use super::role::LeverRole;

/// Gears that mesh with each other's planets on one carrier: a lever before it is placed.
pub(crate) struct Family {
    pub name: String,
    pub carrier: MemberId,
    /// Every point but the carrier, with its number N; the reference first.
    pub points: Vec<Point>,
    /// Every mesh, from its outer to its inner point (the one nearer to the reference planet).
    pub meshes: Vec<Contact>,
}

pub(crate) struct Point {
    pub member: MemberId,
    pub number: Rational,
    pub role: LeverRole,
    /// The mesh that leads to the reference planet.
    pub way: Option<usize>,
}

pub(crate) struct Contact {
    /// Position among the train's meshes.
    pub mesh: usize,
    /// Positions in [`Family::points`].
    pub outer: usize,
    pub inner: usize,
    /// Whether the outer gear is the first of the mesh.
    pub first: bool,
}

/// Whether a rotor is a planet: one that a set brought along, or one of gear pairs on one carrier that touches
/// nothing else.
fn is_planet(train: &Train, m: MemberId) -> bool {
    if train.members()[m.index()].kind != MemberKind::Shaft {
        return m != FRAME;
    }
    let loaded = train.terminals().contains(&m)
        || train.shift_elements().iter().any(|e| e.members.contains(&m))
        || train.meshes().iter().any(|x| x.carrier == m);
    let own: Vec<_> = train.meshes().iter().filter(|x| x.gears.iter().any(|g| g.member == m)).collect();
    let [first, _, ..] = own[..] else { return false };
    !loaded && first.carrier != FRAME && own.iter().all(|x| x.set.is_none() && x.carrier == first.carrier)
}

/// Follows the meshes of one carrier from planet to planet.
pub(crate) fn families(train: &Train) -> Vec<Family> {
    let mut taken = vec![false; train.meshes().len()];
    let mut all = Vec::new();
    while let Some(start) = taken.iter().position(|t| !t) {
        let mesh = &train.meshes()[start];
        let planet = mesh.gears.iter().find(|g| is_planet(train, g.member));
        let planets = planet.is_some();
        let reference = planet.unwrap_or(&mesh.gears[0]);
        let role = |gear: &Gear| match (is_planet(train, gear.member), planets, gear.internal) {
            (true, ..) => LeverRole::Planet,
            (_, _, true) => LeverRole::Ring,
            (_, true, false) => LeverRole::Sun,
            _ => LeverRole::Gear,
        };
        let mut points =
            vec![Point { member: reference.member, number: Rational::ONE, role: role(reference), way: None }];
        let mut meshes: Vec<Contact> = Vec::new();
        let mut at = 0;
        while at < points.len() {
            let here = points[at].member;
            if at > 0 && points[at].role != LeverRole::Planet {
                at += 1;
                continue;
            }
            for k in 0..train.meshes().len() {
                let m = &train.meshes()[k];
                let Some(side) = m.gears.iter().position(|g| g.member == here) else { continue };
                if taken[k] || m.carrier != mesh.carrier {
                    continue;
                }
                taken[k] = true;
                let (from, to) = (&m.gears[side], &m.gears[1 - side]);
                let turn = Rational::from(if m.same_sense { 1 } else { -1 });
                let number = &points[at].number * &(&from.teeth / &to.teeth * turn);
                let known = points.iter().position(|p| p.member == to.member && p.number == number);
                let outer = known.unwrap_or_else(|| {
                    points.push(Point { member: to.member, number, role: role(to), way: Some(meshes.len()) });
                    points.len() - 1
                });
                meshes.push(Contact { mesh: k, outer, inner: at, first: side == 1 });
            }
            at += 1;
        }
        let set = mesh.set.filter(|s| meshes.iter().all(|c| train.meshes()[c.mesh].set == Some(*s)));
        let name = set.map_or_else(
            || meshes.iter().map(|c| train.meshes()[c.mesh].name.as_str()).collect::<Vec<_>>().join(", "),
            |s| train.sets()[s].name.clone(),
        );
        all.push(Family { name, carrier: mesh.carrier, points, meshes });
    }
    all
}
