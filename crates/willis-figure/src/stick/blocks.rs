//! The train as blocks on axes, and what joins them.

use willis::train::{FRAME, MemberId, MeshId, ShiftElementKind, State, Train};

use super::members::{Members, Net};
use super::shapes::{self, Shape};
use super::{JointKind, TerminalDirection};

/// Planets on one carrier with their gears, or one ordinary pair, in every arrangement.
#[derive(Clone)]
pub(super) struct Block {
    pub name: String,
    /// The axis that it stands on; of an ordinary pair the upper one.
    pub axis: usize,
    pub pair: bool,
    pub shapes: Vec<Shape>,
}

/// A shift element or elastic shaft.
#[derive(Clone)]
pub(super) struct Joint {
    /// Its place among the shift elements, then shafts, of the train.
    pub number: usize,
    pub name: String,
    pub kind: JointKind,
    pub members: [Net; 2],
    pub engaged: bool,
}

/// A member that leaves the picture.
#[derive(Clone)]
pub(super) struct Exit {
    pub net: usize,
    pub way: Option<TerminalDirection>,
    pub open: bool,
}

#[derive(Clone)]
pub(super) struct Plan {
    pub nets: usize,
    pub blocks: Vec<Block>,
    pub joints: Vec<Joint>,
    pub exits: Vec<Exit>,
    /// Number of axes, the lowest first.
    pub axes: usize,
    pub axis_of: Vec<usize>,
}

impl Plan {
    /// No shift element is closed, and power enters and leaves where it does in all states.
    pub fn new(train: &Train, members: &Members) -> Self {
        let net = |m: MemberId| members.net(m);
        let mut joints: Vec<Joint> = train
            .shift_elements()
            .iter()
            .enumerate()
            .map(|(k, e)| Joint {
                number: k,
                name: e.name.clone(),
                kind: match e.kind {
                    ShiftElementKind::Clutch => JointKind::Clutch,
                    ShiftElementKind::Brake => JointKind::Brake,
                    ShiftElementKind::OneWay => JointKind::OneWay,
                },
                members: e.members.map(net),
                engaged: false,
            })
            .collect();
        let first = joints.len();
        joints.extend(train.shafts().iter().enumerate().map(|(k, s)| Joint {
            number: first + k,
            name: s.name.clone(),
            kind: JointKind::Shaft,
            members: s.members.map(net),
            engaged: true,
        }));
        // A joint begins at a rotor.
        joints.iter_mut().filter(|j| j.members[0].is_none()).for_each(|j| j.members.swap(0, 1));
        joints.retain(|j| j.members[0] != j.members[1]);

        let (families, pairs) = families(train, members);
        let (axes, axis_of) = axes(train, members, &joints);
        let mut blocks = Vec::new();
        for meshes in &families {
            let first = &train.meshes()[meshes[0].index()];
            let name = first.set.map_or(first.name.clone(), |k| train.sets()[k].name.clone());
            let on = [first.carrier, first.gears[0].member, first.gears[1].member];
            let axis = on
                .iter()
                .filter(|m| !members.is_planet(**m) || members.led_out(**m))
                .find_map(|m| net(*m).map(|n| axis_of[n]))
                .or_else(|| {
                    let all = meshes.iter().flat_map(|m| &train.meshes()[m.index()].gears);
                    let mut central = all.filter(|g| !members.is_planet(g.member));
                    central.find_map(|g| net(g.member).map(|n| axis_of[n]))
                })
                .unwrap_or(0);
            blocks.push(Block { name, axis, pair: false, shapes: shapes::family(train, members, meshes) });
        }
        for id in pairs {
            let mesh = &train.meshes()[id.index()];
            let of = |k: usize| net(mesh.gears[k].member).map_or(0, |n| axis_of[n]);
            let lower = usize::from(of(0) > of(1));
            let axis = of(0).max(of(1));
            let shapes = vec![shapes::pair(train, members, id, lower)];
            blocks.push(Block { name: mesh.name.clone(), axis, pair: true, shapes });
        }

        let ends = ends(train, None).map(|m| m.and_then(net));
        let mut exits: Vec<Exit> = Vec::new();
        for &m in train.terminals().iter().filter(|m| **m != FRAME) {
            exits.extend(net(m).map(|net| Exit { net, way: way(ends, net), open: true }));
        }
        // Input first, then output: they choose their side.
        exits.sort_by_key(|e| match e.way {
            Some(TerminalDirection::In) => 0,
            Some(TerminalDirection::Out) => 1,
            None => 2,
        });
        // A rotor without a gear stands at the border, so that its joints have somewhere to begin.
        for n in 0..members.order.len() {
            let placed = blocks.iter().any(|b| b.shapes[0].ports.iter().any(|p| p.0 == n));
            let planet = members.is_planet(members.order[n]);
            if !placed && !planet && exits.iter().all(|e| e.net != n) {
                exits.push(Exit { net: n, way: None, open: false });
            }
        }
        Self { nets: members.order.len(), blocks, joints, exits, axes, axis_of }
    }

    /// The same parts in a state: what is closed, and where power enters and leaves. Nothing moves.
    pub fn in_state(&self, train: &Train, members: &Members, state: Option<usize>) -> Self {
        let mut own = self.clone();
        let engaged = state.map_or(&[][..], |k| &train.states()[k].engaged);
        for j in own.joints.iter_mut().filter(|j| j.kind != JointKind::Shaft) {
            j.engaged = engaged.iter().any(|id| id.index() == j.number);
        }
        let ends = ends(train, state).map(|m| m.and_then(|m| members.net(m)));
        own.exits.iter_mut().filter(|e| e.open).for_each(|e| e.way = way(ends, e.net));
        own
    }
}

/// What an end of the train does with power, where these are its input and its output.
fn way(ends: [Option<usize>; 2], net: usize) -> Option<TerminalDirection> {
    match ends {
        [Some(input), _] if input == net => Some(TerminalDirection::In),
        [_, Some(output)] if output == net => Some(TerminalDirection::Out),
        _ => None,
    }
}

/// Where power enters and leaves, driving: as the state says, or as all states say where none is chosen. States that
/// disagree leave it open, because an arrow would be wrong in one of them.
fn ends(train: &Train, state: Option<usize>) -> [Option<MemberId>; 2] {
    let all = train.terminals();
    let of_train = [train.input(), train.output()];
    // The first and the last of many terminals are input and output by nothing but their place.
    let by_place = all.len() > 2 && of_train == [all.first().copied(), all.last().copied()];
    let of_train = if by_place { [None, None] } else { of_train };
    let of_state = |s: &State| [s.input.or(of_train[0]), s.output.or(of_train[1])];
    match state {
        Some(k) => of_state(&train.states()[k]),
        None => {
            let mut own = train.states().iter().map(of_state);
            let first = own.next().unwrap_or(of_train);
            if own.all(|e| e == first) { first } else { [None, None] }
        }
    }
}

/// Meshes of planets that hang together on one carrier, and the ordinary pairs.
fn families(train: &Train, members: &Members) -> (Vec<Vec<MeshId>>, Vec<MeshId>) {
    let mut families: Vec<(MemberId, Vec<MemberId>, Vec<MeshId>)> = Vec::new();
    let mut pairs = Vec::new();
    for m in train.meshes() {
        let id = train.mesh(&m.name).expect("its own mesh");
        let planets: Vec<MemberId> =
            m.gears.iter().map(|g| g.member).filter(|g| members.is_planet_of(*g, m.carrier)).collect();
        if planets.is_empty() {
            pairs.push(id);
            continue;
        }
        let mut own = (m.carrier, planets, vec![]);
        let mut at = families.len();
        // All families that this mesh joins become one, in the place of the first.
        let mut k = 0;
        while k < families.len() {
            if families[k].0 == m.carrier && families[k].1.iter().any(|p| own.1.contains(p)) {
                let (_, planets, meshes) = families.remove(k);
                at = at.min(k);
                own.1.extend(planets);
                own.2.extend(meshes);
            } else {
                k += 1;
            }
        }
        own.2.push(id);
        families.insert(at.min(families.len()), own);
    }
    (families.into_iter().map(|f| f.2).collect(), pairs)
}

/// Which members turn about one line, and in which order the lines lie: the input's lowest.
fn axes(train: &Train, members: &Members, joints: &[Joint]) -> (usize, Vec<usize>) {
    let count = members.order.len();
    let mut group: Vec<usize> = (0..count).collect();
    fn root(group: &[usize], mut k: usize) -> usize {
        while group[k] != k {
            k = group[k];
        }
        k
    }
    let mut unite = |a: Net, b: Net| {
        if let (Some(a), Some(b)) = (a, b) {
            let (a, b) = (root(&group, a), root(&group, b));
            group[a.max(b)] = a.min(b);
        }
    };
    // Central gears of a set whose carrier is the frame have no other link.
    let mut of_frame: Vec<(usize, Net)> = Vec::new();
    for m in train.meshes() {
        for (k, g) in m.gears.iter().enumerate() {
            let other = &m.gears[1 - k];
            if !members.is_planet_of(other.member, m.carrier) || members.is_planet_of(g.member, m.carrier) {
                continue;
            }
            unite(members.net(g.member), members.net(m.carrier));
            if let (true, Some(set)) = (m.carrier == FRAME, m.set) {
                match of_frame.iter().find(|(s, _)| *s == set) {
                    Some((_, first)) => unite(*first, members.net(g.member)),
                    None => of_frame.push((set, members.net(g.member))),
                }
            }
        }
        for g in &m.gears {
            if members.is_planet_of(g.member, m.carrier) {
                unite(members.net(g.member), members.net(m.carrier));
            }
        }
    }
    joints.iter().for_each(|j| unite(j.members[0], j.members[1]));
    let of: Vec<usize> = (0..count).map(|k| root(&group, k)).collect();
    let mut links: Vec<[usize; 2]> = Vec::new();
    for m in train.meshes() {
        let planet = m.gears.iter().any(|g| members.is_planet_of(g.member, m.carrier));
        if let ([Some(a), Some(b)], false) = ([members.net(m.gears[0].member), members.net(m.gears[1].member)], planet)
        {
            links.push([of[a], of[b]]);
        }
    }
    let [input, _] = ends(train, None);
    let input = input.or(train.input());
    let start = input.and_then(|m| members.net(m)).map_or(0, |n| of[n]);
    let mut level: Vec<Option<usize>> = vec![None; count];
    let mut next = 0;
    let mut queue: Vec<usize> = vec![start];
    let linked = |g: usize| links.iter().any(|l| l.contains(&g));
    loop {
        while let Some(g) = (!queue.is_empty()).then(|| queue.remove(0)) {
            if level[g].is_some() {
                continue;
            }
            level[g] = Some(next);
            next += 1;
            queue.extend(links.iter().filter(|l| l.contains(&g)).map(|l| if l[0] == g { l[1] } else { l[0] }));
        }
        let has_gear = |g: usize| {
            train.meshes().iter().any(|m| {
                let all = [m.gears[0].member, m.gears[1].member, m.carrier];
                let central = |x: &MemberId| !members.is_planet(*x) || members.led_out(*x);
                all.iter().any(|x| central(x) && members.net(*x).is_some_and(|n| of[n] == g))
            })
        };
        match (0..count).map(|k| of[k]).find(|&g| level[g].is_none() && (linked(g) || has_gear(g))) {
            Some(g) => queue.push(g),
            None => break,
        }
    }
    // Members without any gear lie on the first axis.
    (next.max(1), (0..count).map(|k| level[of[k]].unwrap_or(0)).collect())
}
