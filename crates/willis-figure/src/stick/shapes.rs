//! Blocks on the grid: planets on one carrier with their gears, bevel sets, ordinary pairs.

use willis::train::{Gear, MemberId, MeshId, Train};

use super::GearRole;
use super::members::{Members, Net};

pub(super) type Point = (i32, i32);

/// A gear in its block: a rotor with one tooth count.
#[derive(Clone, Debug)]
pub(super) struct Toothed {
    pub member: MemberId,
    pub teeth: String,
    pub role: GearRole,
    /// Of each station: hub, and the middle of the teeth.
    pub stems: Vec<[[f64; 2]; 2]>,
    pub faces: Vec<[[f64; 2]; 2]>,
}

#[derive(Clone, Debug)]
pub(super) struct Contact {
    pub mesh: MeshId,
    pub gears: [usize; 2],
    pub at: [f64; 2],
}

/// A block in one arrangement of its columns. y = 0 is the row of the lowest suns; of an ordinary pair, the
/// row of the upper axis.
#[derive(Clone, Debug, Default)]
pub(super) struct Shape {
    pub width: i32,
    pub gears: Vec<Toothed>,
    pub contacts: Vec<Contact>,
    /// Points at which a member's line may begin.
    pub ports: Vec<(usize, Point)>,
    /// Steps of the grid that belong to a member: pins and webs.
    pub wires: Vec<(Net, [Point; 2])>,
    /// Points where nothing may pass.
    pub blocked: Vec<Point>,
    /// Steps where nothing may pass.
    pub closed: Vec<[Point; 2]>,
    /// Fixed to the frame: where, and which way it lies.
    pub grounds: Vec<(Point, Point)>,
    /// Highest row.
    pub top: i32,
    /// Its contacts lie left and right of the planets.
    pub bevel: bool,
    /// Two gears stand in one place: a last resort.
    pub crowded: bool,
}

/// Half the width of a gear; how far half a bevel gear's teeth lean.
const HALF: f64 = 0.38;
const LEAN: f64 = 0.14;

impl Shape {
    fn block(&mut self, p: Point) {
        if !self.blocked.contains(&p) {
            self.blocked.push(p);
        }
    }

    /// A member's line may begin here; the frame ends here.
    fn open(&mut self, net: Net, at: Point, into: Point) {
        match net {
            Some(n) => self.ports.push((n, at)),
            None => {
                self.block(at);
                self.grounds.push((at, into));
            }
        }
    }

    /// The gear of a rotor with that tooth count, made when first met.
    fn gear(&mut self, gear: &Gear, role: GearRole) -> usize {
        let teeth = teeth(gear);
        let known = self
            .gears
            .iter()
            .position(|g| role == GearRole::Planet && g.role == role && g.member == gear.member && g.teeth == teeth);
        known.unwrap_or_else(|| {
            self.gears.push(Toothed { member: gear.member, teeth, role, stems: vec![], faces: vec![] });
            self.gears.len() - 1
        })
    }

    fn touch(&mut self, k: usize, hub: [f64; 2], at: [f64; 2]) {
        let g = &mut self.gears[k];
        if hub != at {
            g.stems.push([hub, at]);
        }
        let upright = hub[1] == at[1];
        let face = match upright {
            // Cones meet where the axes do.
            true => {
                let lean = if at[0] < 1.0 { LEAN } else { -LEAN };
                [[at[0] + lean, at[1] - HALF], [at[0] - lean, at[1] + HALF]]
            }
            false => [[at[0] - HALF, at[1]], [at[0] + HALF, at[1]]],
        };
        // Teeth of one gear at two neighbouring stations are one face.
        match g.faces.last_mut().filter(|f| !upright && f[0][1] == at[1] && f[1][1] == at[1] && at[0] - f[1][0] < 2.0) {
            Some(f) => {
                f[0][0] = f[0][0].min(face[0][0]);
                f[1][0] = f[1][0].max(face[1][0]);
            }
            None => g.faces.push(face),
        }
    }
}

/// Tooth count in words.
fn teeth(gear: &Gear) -> String {
    gear.teeth.to_fraction().trim_end_matches("/1").to_owned()
}

/// One contact of a block of cylindrical gears: rows of its lower and upper gear.
#[derive(Clone, Debug)]
struct Step {
    mesh: MeshId,
    /// Which gear of the mesh is the lower one.
    lower: usize,
    rows: [i32; 2],
    role: [GearRole; 2],
}

/// The arrangements of a family of planets on one carrier.
pub(super) fn family(train: &Train, members: &Members, meshes: &[MeshId]) -> Vec<Shape> {
    let mesh = |m: MeshId| &train.meshes()[m.index()];
    let carrier = mesh(meshes[0]).carrier;
    let is_planet = |g: &Gear| members.is_planet_of(g.member, carrier);
    let bevel = meshes.iter().all(|m| mesh(*m).bevel);
    let mut planets: Vec<MemberId> = Vec::new();
    for g in meshes.iter().flat_map(|m| &mesh(*m).gears).filter(|g| is_planet(g)) {
        if !planets.contains(&g.member) {
            planets.push(g.member);
        }
    }
    if bevel && planets.len() == 1 {
        return vec![bevel_set(train, members, meshes, planets[0])];
    }
    let levels = levels(train, meshes, &planets);
    let level = |m: MemberId| planets.iter().position(|p| *p == m).map_or(1, |k| levels[k]);
    let mut steps: Vec<Step> = meshes
        .iter()
        .map(|&id| {
            let [a, b] = &mesh(id).gears;
            use GearRole::{Planet, Ring, Sun};
            match (is_planet(a), is_planet(b)) {
                (true, true) => {
                    let (la, lb) = (level(a.member), level(b.member));
                    let lower = usize::from(la > lb);
                    Step { mesh: id, lower, rows: [la.min(lb), la.max(lb)], role: [Planet, Planet] }
                }
                (first, _) => {
                    let (planet, central, lower) = if first { (a, b, 1) } else { (b, a, 0) };
                    let l = level(planet.member);
                    match central.internal {
                        true => Step { mesh: id, lower: 1 - lower, rows: [l, l + 1], role: [Planet, Ring] },
                        false => Step { mesh: id, lower, rows: [l - 1, l], role: [Sun, Planet] },
                    }
                }
            }
        })
        .collect();
    // Planet to planet first: the others stand beside.
    let rank = |s: &Step| match s.role {
        [GearRole::Planet, GearRole::Planet] => 0,
        [GearRole::Sun, _] => 1,
        _ => 2,
    };
    steps.sort_by_key(rank);

    let mut shapes: Vec<Shape> = Vec::new();
    let mut seen: Vec<Vec<usize>> = Vec::new();
    for last in [false, true] {
        let columns = columns(train, &steps, last);
        let count = columns.iter().max().map_or(0, |c| c + 1);
        for order in orders(count) {
            let placed: Vec<usize> = columns.iter().map(|c| order[*c]).collect();
            if seen.contains(&placed) {
                continue;
            }
            shapes.push(cylindrical(train, members, &steps, &placed, count, carrier));
            seen.push(placed);
        }
    }
    if shapes.iter().any(|s| !s.crowded) {
        shapes.retain(|s| !s.crowded);
    }
    shapes.truncate(8);
    shapes
}

/// Orders of a few columns; of many only both directions.
fn orders(count: usize) -> Vec<Vec<usize>> {
    let straight: Vec<usize> = (0..count).collect();
    if count > 3 {
        return vec![straight.clone(), straight.into_iter().rev().collect()];
    }
    let mut all = vec![vec![]];
    for _ in 0..count {
        all = all
            .into_iter()
            .flat_map(|o: Vec<usize>| {
                let more: Vec<Vec<usize>> =
                    (0..count).filter(|k| !o.contains(k)).map(|k| o.iter().copied().chain([k]).collect()).collect();
                more
            })
            .collect();
    }
    all
}

/// Rows of planets: those that mesh with a sun and no ring lie inside.
fn levels(train: &Train, meshes: &[MeshId], planets: &[MemberId]) -> Vec<i32> {
    let mesh = |m: &MeshId| &train.meshes()[m.index()];
    let place = |m: MemberId| planets.iter().position(|p| *p == m);
    let touches = |p: MemberId, internal: bool| {
        meshes.iter().map(mesh).any(|m| {
            let [a, b] = &m.gears;
            let other = if a.member == p { b } else { a };
            (a.member == p || b.member == p) && place(other.member).is_none() && other.internal == internal
        })
    };
    let mut level = vec![0; planets.len()];
    loop {
        // The start of each connected group.
        let open = (0..planets.len()).filter(|&k| level[k] == 0);
        let Some(start) = open.min_by_key(|&k| match (touches(planets[k], false), touches(planets[k], true)) {
            (true, false) => 0,
            (true, true) => 1,
            (false, false) => 2,
            (false, true) => 3,
        }) else {
            return level;
        };
        level[start] = 1;
        let mut queue = vec![start];
        let mut next = 0;
        while next < queue.len() {
            let k = queue[next];
            next += 1;
            for m in meshes.iter().map(mesh) {
                let [a, b] = [place(m.gears[0].member), place(m.gears[1].member)];
                let (Some(a), Some(b)) = (a, b) else { continue };
                let other = if a == k {
                    b
                } else if b == k {
                    a
                } else {
                    continue;
                };
                if level[other] == 0 {
                    level[other] = level[k] + 1;
                    queue.push(other);
                }
            }
        }
        // Two planets of one row that mesh: the later one moves out.
        for m in meshes.iter().map(mesh) {
            if let (Some(a), Some(b)) = (place(m.gears[0].member), place(m.gears[1].member))
                && level[a] == level[b]
                && level[a] > 0
            {
                level[a.max(b)] += 1;
            }
        }
    }
}

/// Each contact in the first (or last) column where it touches nothing but its own gears.
fn columns(train: &Train, steps: &[Step], last: bool) -> Vec<usize> {
    let gear =
        |s: &Step, end: usize| &train.meshes()[s.mesh.index()].gears[if end == 0 { s.lower } else { 1 - s.lower }];
    let same = |a: &Gear, b: &Gear| a.member == b.member && a.teeth == b.teeth;
    let mut columns: Vec<Vec<usize>> = Vec::new();
    let mut of = vec![0; steps.len()];
    for (k, s) in steps.iter().enumerate() {
        let fits = |column: &Vec<usize>| {
            let joined = column.iter().any(|&o| {
                let t = &steps[o];
                (s.rows[0] == t.rows[1] && same(gear(s, 0), gear(t, 1)))
                    || (s.rows[1] == t.rows[0] && same(gear(s, 1), gear(t, 0)))
            });
            joined && column.iter().all(|&o| s.rows[0] >= steps[o].rows[1] || s.rows[1] <= steps[o].rows[0])
        };
        let found = if last { columns.iter().rposition(fits) } else { columns.iter().position(fits) };
        of[k] = found.unwrap_or_else(|| {
            columns.push(vec![]);
            columns.len() - 1
        });
        columns[of[k]].push(k);
    }
    of
}

fn cylindrical(
    train: &Train,
    members: &Members,
    steps: &[Step],
    placed: &[usize],
    count: usize,
    carrier: MemberId,
) -> Shape {
    let mut s = Shape { width: 2 * count as i32 + 1, ..Shape::default() };
    let own = members.net(carrier);
    let mut order: Vec<usize> = (0..steps.len()).collect();
    order.sort_by_key(|&k| placed[k]);
    // Stations of each planet: rotor, row, first and last column.
    let mut pins: Vec<(MemberId, i32, i32, i32)> = Vec::new();
    for &k in &order {
        let step = &steps[k];
        let mesh = &train.meshes()[step.mesh.index()];
        let x = 2 * placed[k] as i32 + 1;
        let [low, high] = step.rows;
        // The upper gear is the smaller one where a gear has to reach past a row.
        let at = [f64::from(x), f64::from(high) - 0.5 + offset(mesh, step)];
        let mut ends = [0; 2];
        for end in [0, 1] {
            let gear = &mesh.gears[if end == 0 { step.lower } else { 1 - step.lower }];
            let role = step.role[end];
            let row = step.rows[end];
            let g = s.gear(gear, role);
            s.touch(g, [f64::from(x), f64::from(row)], at);
            ends[if end == 0 { step.lower } else { 1 - step.lower }] = g;
            if role == GearRole::Planet {
                s.block((x, row));
                match pins.iter_mut().find(|p| p.0 == gear.member) {
                    Some(p) => (p.2, p.3) = (p.2.min(x), p.3.max(x)),
                    None => pins.push((gear.member, row, x, x)),
                }
            } else {
                let away = if role == GearRole::Sun { -1 } else { 1 };
                s.open(members.net(gear.member), (x, row), (0, away));
            }
        }
        s.contacts.push(Contact { mesh: step.mesh, gears: ends, at });
        for y in low..high {
            s.closed.push([(x, y), (x, y + 1)]);
            if y > low {
                s.block((x, y));
            }
        }
        s.top = s.top.max(high);
    }
    // Pins, with the carrier at both ends unless the planet itself is led out at one.
    for &(planet, y, first, last) in &pins {
        let out = members.led_out(planet);
        for x in first - 1..last + i32::from(!out) {
            s.wires.push((own, [(x, y), (x + 1, y)]));
        }
        for x in first + 1..last {
            s.block((x, y));
        }
        if out {
            s.wires.push((members.net(planet), [(last, y), (last + 1, y)]));
        }
        for (end, x) in [(0, first - 1), (1, last + 1)] {
            match (end, out) {
                (1, true) => s.open(members.net(planet), (x, y), (1, 0)),
                _ => match own {
                    Some(n) => s.ports.push((n, (x, y))),
                    None => s.block((x, y)),
                },
            }
        }
    }
    // Webs where planets mesh with each other.
    let mut tied: Vec<usize> = (0..pins.len()).collect();
    for &k in &order {
        let step = &steps[k];
        if step.role != [GearRole::Planet; 2] {
            continue;
        }
        let mesh = &train.meshes()[step.mesh.index()];
        let pin = |m: MemberId| pins.iter().position(|p| p.0 == m).expect("every planet has a pin");
        let [a, b] = [pin(mesh.gears[0].member), pin(mesh.gears[1].member)];
        if tied[a] == tied[b] {
            continue;
        }
        let x = 2 * placed[k] as i32 + 1;
        let led = [a, b].iter().any(|&p| members.led_out(pins[p].0));
        let side = if placed[k] == 0 || led { x - 1 } else { x + 1 };
        for y in step.rows[0]..step.rows[1] {
            s.wires.push((own, [(side, y), (side, y + 1)]));
        }
        let (from, to) = (tied[a], tied[b]);
        tied.iter_mut().filter(|t| **t == from).for_each(|t| *t = to);
    }
    if own.is_none() {
        // One mark for the pins that hang together.
        let mut done: Vec<usize> = Vec::new();
        for (k, p) in pins.iter().enumerate() {
            if !done.contains(&tied[k]) {
                done.push(tied[k]);
                s.grounds.push(((p.2 - 1, p.1), (-1, 0)));
            }
        }
    }
    let mut all: Vec<Point> = s.ports.iter().map(|p| p.1).chain(s.blocked.iter().copied()).collect();
    all.sort_unstable();
    s.crowded = all.windows(2).any(|w| w[0] == w[1]) && crowded(&s);
    s
}

/// Whether two rotors want one point.
fn crowded(s: &Shape) -> bool {
    s.ports
        .iter()
        .enumerate()
        .any(|(k, (net, at))| s.blocked.contains(at) || s.ports[..k].iter().any(|(other, p)| p == at && other != net))
}

/// How far a contact lies from the middle: larger gears reach farther.
fn offset(mesh: &willis::train::Mesh, step: &Step) -> f64 {
    let z = |k: usize| mesh.gears[k].teeth.to_f64();
    let (low, high) = (z(step.lower), z(1 - step.lower));
    match step.role {
        [GearRole::Sun, _] if step.rows[1] == 1 => 0.3 * ((low / (low + high)) - 0.5),
        _ => 0.0,
    }
}

/// A bevel planet on its radial pin between side gears.
fn bevel_set(train: &Train, members: &Members, meshes: &[MeshId], planet: MemberId) -> Shape {
    let mesh = |m: &MeshId| &train.meshes()[m.index()];
    let carrier = mesh(&meshes[0]).carrier;
    let at = |m: &MeshId| usize::from(mesh(m).gears[1].member == planet);
    // A row for each step of the planet; one more where a side is taken.
    let mut rows: Vec<(String, [Option<MeshId>; 2])> = Vec::new();
    for m in meshes {
        let side = usize::from(mesh(m).same_sense);
        let step = teeth(&mesh(m).gears[at(m)]);
        match rows.iter_mut().find(|(t, taken)| *t == step && taken[side].is_none()) {
            Some((_, taken)) => taken[side] = Some(*m),
            None => {
                let mut taken = [None; 2];
                taken[side] = Some(*m);
                rows.push((step, taken));
            }
        }
    }
    // The smaller side gears lie inside.
    let largest = |taken: &[Option<MeshId>; 2]| {
        let z = |m: &MeshId| mesh(m).gears[1 - at(m)].teeth.to_f64();
        taken.iter().flatten().map(z).fold(0.0, f64::max)
    };
    rows.sort_by(|a, b| largest(&a.1).total_cmp(&largest(&b.1)));
    let mut s = Shape { width: 3, top: rows.len() as i32 + 1, bevel: true, ..Shape::default() };
    for (r, (_, taken)) in rows.iter().enumerate() {
        let y = r as i32 + 1;
        s.block((1, y));
        for (side, m) in taken.iter().enumerate() {
            let x = 2 * side as i32;
            let Some(m) = m else { continue };
            let mesh = mesh(m);
            let [p, c] = [&mesh.gears[at(m)], &mesh.gears[1 - at(m)]];
            let touch = [if side == 0 { 0.5 } else { 1.5 }, f64::from(y)];
            let (planet, central) = (s.gear(p, GearRole::Planet), s.gear(c, GearRole::Side));
            s.touch(planet, [1.0, f64::from(y)], touch);
            s.touch(central, [f64::from(x), f64::from(y)], touch);
            let mut gears = [planet, central];
            if at(m) == 1 {
                gears.swap(0, 1);
            }
            s.contacts.push(Contact { mesh: *m, gears, at: touch });
            s.open(members.net(c.member), (x, y), (x - 1, 0));
            s.closed.push([(0.min(x), y), (1, y)]);
            s.closed.push([(1, y), (2, y)]);
        }
    }
    // The pin, with the carrier at its outer end; at the inner one too, or the planet itself. The carrier of a plain
    // differential is the cage around its gears.
    let own = members.net(carrier);
    let top = s.top;
    let cage = rows.len() == 1 && rows[0].1.iter().all(Option::is_some) && !members.led_out(planet);
    for y in i32::from(cage)..top {
        let net = if y == 0 && members.led_out(planet) { members.net(planet) } else { own };
        s.wires.push((net, [(1, y), (1, y + 1)]));
    }
    s.open(own, (1, top), (0, 1));
    match (members.led_out(planet), own) {
        (true, _) => s.open(members.net(planet), (1, 0), (0, -1)),
        (_, Some(n)) if !cage => s.ports.push((n, (1, 0))),
        _ => s.block((1, 0)),
    }
    s
}

/// An ordinary pair: the first of `order` turns on the lower axis.
pub(super) fn pair(train: &Train, members: &Members, id: MeshId, lower: usize) -> Shape {
    let mesh = &train.meshes()[id.index()];
    let role = |g: &Gear| if g.internal { GearRole::Ring } else { GearRole::Wheel };
    let (low, high) = (&mesh.gears[lower], &mesh.gears[1 - lower]);
    // Rows of the hubs and of the contact: a ring lies beyond its pinion.
    let (y_low, y_high, at) = match (low.internal, high.internal) {
        (true, _) => (1, 0, 0.5),
        (_, true) => (-2, -3, -2.5),
        // Radii as the teeth are; a very small gear keeps room for its number.
        _ => {
            let [low, high] = [low, high].map(|g| g.teeth.to_f64());
            (-2, 0, -2.0 + 2.0 * (low / (low + high)).clamp(0.22, 0.78))
        }
    };
    let mut s = Shape { width: 1, top: y_low.max(y_high), ..Shape::default() };
    let touch = [0.0, at];
    let mut gears = [0; 2];
    for (gear, y, k) in [(low, y_low, lower), (high, y_high, 1 - lower)] {
        gears[k] = s.gear(gear, role(gear));
        s.touch(gears[k], [0.0, f64::from(y)], touch);
        s.open(members.net(gear.member), (0, y), (0, if f64::from(y) < at { -1 } else { 1 }));
    }
    s.contacts.push(Contact { mesh: id, gears, at: touch });
    for y in y_low.min(y_high)..y_low.max(y_high) {
        s.closed.push([(0, y), (0, y + 1)]);
        if y > y_low.min(y_high) {
            s.block((0, y));
        }
    }
    s
}
