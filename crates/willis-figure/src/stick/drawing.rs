//! From the grid to lines: rows and columns that nothing needs are dropped.

use willis::exact::Rational;
use willis::train::{MemberId, Train};

use super::blocks::Plan;
use super::grid::{CLOSED, FREE, GROUND, Grid, WAYS};
use super::layout::Layout;
use super::load::Load;
use super::members::Members;
use super::shapes::{Point, Shape};
use super::{
    GearRole, Place, Stick, StickBlock, StickGear, StickGround, StickJoint, StickMember, StickMesh, StickPiece,
    StickTerminal,
};

pub(super) struct Drawing<'a> {
    train: &'a Train,
    members: &'a Members,
    plan: &'a Plan,
    layout: Layout,
    load: &'a Load,
    /// New place of each column and row.
    columns: Vec<f64>,
    rows: Vec<f64>,
    /// Ends of pins to which nothing is joined: drawn half as long.
    stubs: Vec<(Point, Point)>,
    /// Where a member and what it passes power to or from are part of a circle.
    circling: Vec<(Knot, usize)>,
}

/// What passes power from member to member: a block of gears, or a joint.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Knot {
    Block(usize),
    Joint(usize),
}

/// Power that comes into the lines of a member.
struct Source {
    at: Point,
    /// Over that of the input; negative where it leaves.
    power: f64,
    circles: bool,
}

/// Power below this part of the input's is round-off.
const ROUND_OFF: f64 = 1e-9;

impl<'a> Drawing<'a> {
    pub fn new(train: &'a Train, members: &'a Members, plan: &'a Plan, layout: Layout, load: &'a Load) -> Self {
        let mut d =
            Self { train, members, plan, layout, load, columns: vec![], rows: vec![], stubs: vec![], circling: vec![] };
        d.stubs = d.find_stubs();
        d.circling = d.circles();
        d.compact();
        d
    }

    fn grid(&self) -> &Grid {
        &self.layout.grid
    }

    fn shape(&self, b: usize) -> &'a Shape {
        &self.plan.blocks[b].shapes[self.layout.stands[b].shape]
    }

    fn to_grid(&self, b: usize, p: Point) -> Point {
        let stand = self.layout.stands[b];
        (p.0 + stand.x, p.1 + stand.y)
    }

    /// Where power runs in circles from block to block: links between a member and a knot that a way in the direction of the
    /// power leads back to. What goes round within one set depends on the frame in which it is counted, and is left out.
    fn circles(&self) -> Vec<(Knot, usize)> {
        let mut links: Vec<(Knot, usize, f64)> = Vec::new();
        let mut add = |knot: Knot, member: MemberId, power: Option<f64>| {
            let (Some(n), Some(power)) = (self.members.net(member), power) else { return };
            match links.iter_mut().find(|l| l.0 == knot && l.1 == n) {
                Some(link) => link.2 += power,
                None => links.push((knot, n, power)),
            }
        };
        for b in 0..self.plan.blocks.len() {
            for c in &self.shape(b).contacts {
                let mesh = &self.train.meshes()[c.mesh.index()];
                let power = &self.load.from_meshes[c.mesh.index()];
                add(Knot::Block(b), mesh.gears[0].member, power[0]);
                add(Knot::Block(b), mesh.gears[1].member, power[1]);
                add(Knot::Block(b), mesh.carrier, power[2]);
            }
        }
        for j in &self.plan.joints {
            for (net, power) in j.members.iter().zip(&self.load.from_joints[j.number]) {
                if let Some(n) = net {
                    add(Knot::Joint(j.number), self.members.order[*n], *power);
                }
            }
        }
        links.retain(|l| l.2.abs() > ROUND_OFF);
        // From each link to those that its power reaches next.
        let leads = |from: &(Knot, usize, f64), to: &(Knot, usize, f64)| match from.2 > 0.0 {
            true => to.1 == from.1 && to.2 < 0.0,
            false => to.0 == from.0 && to.2 > 0.0,
        };
        let returns = |start: usize| {
            let mut reached = vec![false; links.len()];
            let mut queue = vec![start];
            while let Some(k) = queue.pop() {
                for (next, link) in links.iter().enumerate() {
                    if leads(&links[k], link) && !std::mem::replace(&mut reached[next], true) {
                        queue.push(next);
                    }
                }
            }
            reached[start]
        };
        (0..links.len()).filter(|&k| returns(k)).map(|k| (links[k].0, links[k].1)).collect()
    }

    /// Ends of a carrier's wires that lead nowhere, each with the point before it.
    fn find_stubs(&self) -> Vec<(Point, Point)> {
        let mut stubs = Vec::new();
        for b in 0..self.plan.blocks.len() {
            for (net, p) in &self.shape(b).ports {
                let p = self.to_grid(b, *p);
                let own: Vec<usize> = (0..4).filter(|w| self.grid().step(p, *w) == *net as u16).collect();
                let joint = self.layout.joints.iter().flatten().flatten().any(|e| *e == p);
                if let ([way], false) = (&own[..], joint) {
                    let q = (p.0 + WAYS[*way].0, p.1 + WAYS[*way].1);
                    if self.grid().point[self.grid().at(q)] == CLOSED {
                        stubs.push((p, q));
                    }
                }
            }
        }
        stubs
    }

    fn compact(&mut self) {
        let g = self.grid();
        let stub = |p: Point| self.stubs.iter().any(|s| s.0 == p);
        // Along a row or column the lines only pass straight through.
        let idle = |p: Point, along: [usize; 2], across: [usize; 2]| {
            if stub(p) {
                return true;
            }
            let [a, b] = along.map(|w| g.step(p, w));
            let [c, d] = across.map(|w| g.step(p, w));
            let free = |s: u16| s == FREE || s == CLOSED;
            g.point[g.at(p)] == FREE && free(a) && free(b) && c == d && c != CLOSED || {
                let border = c == CLOSED && d == FREE || c == FREE && d == CLOSED;
                g.point[g.at(p)] == FREE && free(a) && free(b) && border
            }
        };
        let mut rows: Vec<bool> = (0..g.height).map(|y| !(0..g.width).all(|x| idle((x, y), [0, 2], [1, 3]))).collect();
        self.layout.axes.iter().for_each(|y| rows[*y as usize] = true);
        let mut columns: Vec<bool> =
            (0..g.width).map(|x| !(0..g.height).all(|y| idle((x, y), [1, 3], [0, 2]))).collect();
        // Between the gears of two blocks one column stays.
        let mut order: Vec<usize> = (0..self.plan.blocks.len()).collect();
        order.sort_by_key(|&b| self.layout.stands[b].x);
        for pair in order.windows(2) {
            let gears = |b: usize| {
                let (x, width) = (self.layout.stands[b].x, self.shape(b).width);
                if width == 1 { (x, x) } else { (x + 1, x + width - 2) }
            };
            let (from, to) = (gears(pair[0]).1 + 1, gears(pair[1]).0);
            if !(from..to).any(|x| columns[x as usize]) {
                columns[from as usize] = true;
            }
        }
        let places = |kept: &[bool]| {
            let mut n = 0.0;
            let mut all = Vec::with_capacity(kept.len() + 1);
            for k in kept {
                all.push(n);
                n += if *k { 1.0 } else { 0.0 };
            }
            all.push(n);
            all
        };
        (self.columns, self.rows) = (places(&columns), places(&rows));
    }

    /// A place of the grid in the picture.
    fn place(&self, x: f64, y: f64) -> Place {
        let along = |x: f64, all: &[f64]| {
            let low = x.floor();
            let k = (low.max(0.0) as usize).min(all.len() - 2);
            all[k] + (x - low) * (all[k + 1] - all[k])
        };
        [along(x, &self.columns), along(y, &self.rows)]
    }

    fn point(&self, p: Point) -> Place {
        self.place(f64::from(p.0), f64::from(p.1))
    }

    /// A place of a block: around its points lengths stay what they are.
    fn in_block(&self, b: usize, [x, y]: [f64; 2]) -> Place {
        let stand = self.layout.stands[b];
        let near = [x.round(), if self.shape(b).bevel { y.round() } else { y.floor() }];
        let base = self.place(near[0] + f64::from(stand.x), near[1] + f64::from(stand.y));
        [base[0] + x - near[0], base[1] + y - near[1]]
    }

    pub fn stick(&self, state: Option<usize>) -> Stick {
        let train = self.train;
        let (gears, meshes) = self.gears();
        let mut crossings = Vec::new();
        let g = self.grid();
        for k in 0..g.point.len() {
            let p = g.place(k);
            let s: [u16; 4] = std::array::from_fn(|w| g.step(p, w));
            if s[0] < GROUND && s[0] == s[2] && s[1] < GROUND && s[1] == s[3] && s[0] != s[1] {
                crossings.push(self.point(p));
            }
        }
        let joints = self.plan.joints.iter().zip(&self.layout.joints);
        let joints = joints
            .filter_map(|(j, ends)| {
                Some(StickJoint {
                    name: j.name.clone(),
                    kind: j.kind,
                    members: j.members,
                    ends: ends.as_ref()?.map(|p| self.point(p)),
                    engaged: j.engaged,
                    loaded: self.load.joints[j.number].contains(&Some(true)),
                })
            })
            .collect();
        let exits = self.plan.exits.iter().zip(&self.layout.exits);
        let terminals = exits
            .filter_map(|(e, at)| {
                let at = (*at)?;
                Some(StickTerminal { member: e.net, at: self.point(at), left: at.0 == 0, way: e.way, open: e.open })
            })
            .collect();
        Stick {
            title: train.name().to_owned(),
            state: state.map(|k| train.states()[k].name.clone()),
            states: train.states().iter().map(|s| s.name.clone()).collect(),
            width: self.columns.last().map_or(0.0, |n| n - 1.0).max(1.0),
            height: self.rows.last().map_or(0.0, |n| n - 1.0).max(1.0),
            axes: self.layout.axes.iter().map(|y| self.rows[*y as usize]).collect(),
            blocks: (0..self.plan.blocks.len()).map(|b| self.block(b)).collect(),
            members: (0..self.plan.nets).map(|n| self.member(n)).collect(),
            gears,
            meshes,
            joints,
            grounds: self.grounds(),
            terminals,
            frame: self.pieces(GROUND, &[], None).0.into_iter().map(|p| p.points).collect(),
            crossings,
        }
    }

    fn block(&self, b: usize) -> StickBlock {
        let all = || self.shape(b).gears.iter().flat_map(|g| g.faces.iter().chain(&g.stems)).flatten();
        let all: Vec<Place> = all().map(|p| self.in_block(b, *p)).collect();
        let fold = |f: fn(f64, f64) -> f64, k: usize| all.iter().map(|p| p[k]).reduce(f).unwrap_or(0.0);
        StickBlock {
            name: self.plan.blocks[b].name.clone(),
            span: [fold(f64::min, 0), fold(f64::max, 0)],
            top: fold(f64::max, 1),
        }
    }

    fn gears(&self) -> (Vec<StickGear>, Vec<StickMesh>) {
        let (mut gears, mut meshes) = (Vec::new(), Vec::new());
        for b in 0..self.plan.blocks.len() {
            let shape = self.shape(b);
            let first = gears.len();
            for (k, g) in shape.gears.iter().enumerate() {
                let lines = |all: &[[f64; 2]; 2]| all.map(|p| self.in_block(b, p));
                let loaded = shape
                    .contacts
                    .iter()
                    .any(|c| (0..2).any(|end| c.gears[end] == k && self.gear_loaded(c.mesh.index(), end, g.role)));
                gears.push(StickGear {
                    member: self.members.net(g.member),
                    block: b,
                    // A planet of 45/4 teeth is a number of the calculation, none of a wheel.
                    teeth: if g.teeth.contains('/') { String::new() } else { g.teeth.clone() },
                    role: g.role,
                    stems: g.stems.iter().map(lines).collect(),
                    faces: g.faces.iter().map(lines).collect(),
                    loaded,
                });
            }
            for c in &shape.contacts {
                let mesh = &self.train.meshes()[c.mesh.index()];
                meshes.push(StickMesh {
                    name: mesh.name.clone(),
                    gears: c.gears.map(|g| first + g),
                    at: self.in_block(b, c.at),
                    bevel: mesh.bevel,
                });
            }
        }
        (gears, meshes)
    }

    /// A planet passes power on also while it only moves with its carrier.
    fn gear_loaded(&self, mesh: usize, end: usize, role: GearRole) -> bool {
        let power = &self.load.meshes[mesh];
        match role {
            GearRole::Planet => power.contains(&Some(true)),
            _ => power[end] == Some(true),
        }
    }

    fn grounds(&self) -> Vec<StickGround> {
        let mut all = Vec::new();
        for b in 0..self.plan.blocks.len() {
            for (at, into) in &self.shape(b).grounds {
                let at = self.point(self.to_grid(b, *at));
                all.push(StickGround { at, into: [into.0 as i8, into.1 as i8] });
            }
        }
        for (j, ends) in self.plan.joints.iter().zip(&self.layout.joints) {
            if let (None, Some([from, to])) = (j.members[1], ends) {
                let into = [(to.0 - from.0) as i8, (to.1 - from.1) as i8];
                all.push(StickGround { at: self.point(*to), into });
            }
        }
        all
    }

    fn member(&self, n: usize) -> StickMember {
        let id = self.members.order[n];
        let (mut pieces, dots) = self.pieces(n as u16, &self.loaded_points(n), self.sources(n).as_deref());
        pieces.extend(self.sleeve(id));
        let speed = self.load.speeds[id.index()].as_ref();
        StickMember {
            name: self.train.member_name(id).to_owned(),
            // The frame comes first and has none.
            colour: id.index() - 1,
            planet: self.members.is_planet(id),
            carries: (0..self.plan.blocks.len()).filter(|&b| self.carries(b, id)).collect(),
            pieces,
            dots,
            loaded: self.load.members[id.index()],
            speed_ratio: speed.map(Rational::to_f64),
            exact_speed_ratio: speed.map(|s| s.to_fraction()),
        }
    }

    /// What joins the steps of a planet, along its pin.
    fn sleeve(&self, id: MemberId) -> Option<StickPiece> {
        let mut hubs: Vec<Place> = Vec::new();
        for b in 0..self.plan.blocks.len() {
            let own = self.shape(b).gears.iter().filter(|g| g.member == id && g.role == GearRole::Planet);
            hubs.extend(own.flat_map(|g| &g.stems).map(|s| self.in_block(b, s[0])));
        }
        hubs.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        let (first, last) = (*hubs.first()?, *hubs.last()?);
        let loaded = self.load.members[id.index()] == Some(true);
        (first != last).then(|| StickPiece { points: vec![first, last], loaded, power: None, circulates: false })
    }

    fn carries(&self, b: usize, id: MemberId) -> bool {
        !self.plan.blocks[b].pair
            && self.shape(b).contacts.first().is_some_and(|c| self.train.meshes()[c.mesh.index()].carrier == id)
    }

    /// Where power enters or leaves the lines of a member.
    fn loaded_points(&self, n: usize) -> Vec<Point> {
        let id = self.members.order[n];
        let mut all = Vec::new();
        for b in 0..self.plan.blocks.len() {
            let shape = self.shape(b);
            let hub = |k: usize, at: [f64; 2]| {
                let stem = shape.gears[k].stems.iter().find(|s| s[1] == at)?;
                Some(self.to_grid(b, (stem[0][0].round() as i32, stem[0][1].round() as i32)))
            };
            for c in &shape.contacts {
                let mesh = &self.train.meshes()[c.mesh.index()];
                let power = &self.load.meshes[c.mesh.index()];
                for end in 0..2 {
                    let own = mesh.gears[end].member == id;
                    let planet = shape.gears[c.gears[end]].role == GearRole::Planet;
                    let carried = planet && mesh.carrier == id && power[2] == Some(true);
                    if own && power[end] == Some(true) || carried {
                        all.extend(hub(c.gears[end], c.at));
                    }
                }
            }
        }
        for (j, ends) in self.plan.joints.iter().zip(&self.layout.joints) {
            if let Some(ends) = ends
                && self.load.joints[j.number].contains(&Some(true))
            {
                all.extend((0..2).filter(|&k| j.members[k] == Some(n)).map(|k| ends[k]));
            }
        }
        if self.load.outside[id.index()] {
            let own = self.plan.exits.iter().zip(&self.layout.exits).filter(|(e, _)| e.net == n);
            all.extend(own.filter_map(|(_, at)| *at));
        }
        all
    }

    /// Where power comes into the lines of a member and how much, negative where it leaves, and whether it is part of a
    /// circle; nothing where statics leaves one of them open.
    fn sources(&self, n: usize) -> Option<Vec<Source>> {
        if !self.load.shown {
            return None;
        }
        let id = self.members.order[n];
        let mut all = Vec::new();
        for b in 0..self.plan.blocks.len() {
            let shape = self.shape(b);
            let circles = self.circling.contains(&(Knot::Block(b), n));
            let hub = |k: usize, at: [f64; 2]| {
                let stem = shape.gears[k].stems.iter().find(|s| s[1] == at)?;
                Some(self.to_grid(b, (stem[0][0].round() as i32, stem[0][1].round() as i32)))
            };
            for c in &shape.contacts {
                let mesh = &self.train.meshes()[c.mesh.index()];
                let power = &self.load.from_meshes[c.mesh.index()];
                let planets = (0..2).filter(|&end| shape.gears[c.gears[end]].role == GearRole::Planet).count();
                for end in 0..2 {
                    let planet = shape.gears[c.gears[end]].role == GearRole::Planet;
                    let mut own = 0.0;
                    if mesh.gears[end].member == id {
                        own += power[end]?;
                    }
                    if planet && mesh.carrier == id {
                        // Pins of two planets that mesh share what their carrier gets.
                        own += power[2]? / planets as f64;
                    }
                    if let (true, Some(at)) = (own != 0.0, hub(c.gears[end], c.at)) {
                        all.push(Source { at, power: own, circles });
                    }
                }
            }
        }
        for (j, ends) in self.plan.joints.iter().zip(&self.layout.joints) {
            for k in (0..2).filter(|&k| j.members[k] == Some(n)) {
                let own = self.load.from_joints[j.number][k].unwrap_or(0.0);
                if let (true, Some(ends)) = (own != 0.0, ends) {
                    let circles = self.circling.contains(&(Knot::Joint(j.number), n));
                    all.push(Source { at: ends[k], power: own, circles });
                }
            }
        }
        let outside = self.load.from_outside[id.index()]?;
        if outside != 0.0 {
            // A machine within the train has no end in the picture.
            let (_, at) = self.plan.exits.iter().zip(&self.layout.exits).find(|(e, _)| e.net == n)?;
            all.push(Source { at: (*at)?, power: outside, circles: false });
        }
        Some(all)
    }

    /// The lines of an owner from branch to branch, and where they branch.
    fn pieces(&self, owner: u16, loaded: &[Point], sources: Option<&[Source]>) -> (Vec<StickPiece>, Vec<Place>) {
        let g = self.grid();
        let ways = |p: Point| (0..4).filter(move |w| g.step(p, *w) == owner);
        let to = |p: Point, w: usize| (p.0 + WAYS[w].0, p.1 + WAYS[w].1);
        // Steps that lie between loaded points: loose ends fall off until none is left.
        let mut carrying: Vec<(Point, Point)> = Vec::new();
        for k in 0..g.point.len() {
            let p = g.place(k);
            carrying.extend(ways(p).filter(|w| *w < 2).map(|w| (p, to(p, w))));
        }
        loop {
            let ends = |p: Point| carrying.iter().filter(|s| s.0 == p || s.1 == p).count();
            let loose = |p: Point| ends(p) == 1 && !loaded.contains(&p);
            match carrying.iter().position(|s| loose(s.0) || loose(s.1)) {
                Some(k) => _ = carrying.swap_remove(k),
                None => break,
            }
        }
        if loaded.is_empty() {
            carrying.clear();
        }
        let carries = |p: Point, q: Point| carrying.iter().any(|s| *s == (p, q) || *s == (q, p));
        let joint_end = |p: Point| self.layout.joints.iter().flatten().flatten().any(|e| *e == p);
        let stop = |p: Point| ways(p).count() != 2 || g.point[g.at(p)] != FREE || joint_end(p) || loaded.contains(&p);
        let (mut pieces, mut dots) = (Vec::new(), Vec::new());
        let mut ends: Vec<[Point; 2]> = Vec::new();
        for k in 0..g.point.len() {
            let start = g.place(k);
            if !stop(start) {
                continue;
            }
            if ways(start).count() > 2 {
                dots.push(self.point(start));
            }
            for way in ways(start) {
                let mut points = vec![start];
                let (mut p, mut w) = (start, way);
                let on = carries(start, to(start, way));
                loop {
                    p = to(p, w);
                    points.push(p);
                    if stop(p) {
                        break;
                    }
                    w = ways(p).find(|x| *x != (w + 2) % 4).expect("a point between two steps");
                }
                // Each line is met from both ends.
                if (points[0], points[1]) < (p, points[points.len() - 2]) {
                    let points = self.corners(&points);
                    pieces.push(StickPiece { points, loaded: on, power: None, circulates: false });
                    ends.push([start, p]);
                }
            }
        }
        if let Some(sources) = sources {
            direct(&mut pieces, &ends, sources);
        }
        (pieces, dots)
    }

    /// A line by its corners.
    fn corners(&self, points: &[Point]) -> Vec<Place> {
        let last = points.len() - 1;
        let mut all: Vec<Place> = Vec::new();
        for (k, p) in points.iter().enumerate() {
            let straight = |a: Point, b: Point, c: Point| (b.0 - a.0, b.1 - a.1) == (c.0 - b.0, c.1 - b.1);
            if k == 0 || k == last || !straight(points[k - 1], *p, points[k + 1]) {
                all.push(self.point(*p));
            }
        }
        for (end, from) in &self.stubs {
            let half = |a: Point, b: Point| {
                let base = self.point(b);
                [base[0] + 0.5 * f64::from(a.0 - b.0), base[1] + 0.5 * f64::from(a.1 - b.1)]
            };
            if points[0] == *end && points[1] == *from {
                all[0] = half(*end, *from);
            }
            if points[last] == *end && points[last - 1] == *from {
                *all.last_mut().expect("two points") = half(*end, *from);
            }
        }
        all
    }
}

/// Gives the lines of a member their powers: each passes on what comes in behind its first end. Lines that close a ring are
/// left alone, for statics does not say how they share.
fn direct(pieces: &mut [StickPiece], ends: &[[Point; 2]], sources: &[Source]) {
    // Everything on the side of an end when that piece is cut; nothing where the cut parts nothing.
    let behind = |cut: usize, end: usize| -> Option<Vec<Point>> {
        let (from, to) = (ends[cut][end], ends[cut][1 - end]);
        let mut reached = vec![from];
        let mut next = 0;
        while next < reached.len() {
            let p = reached[next];
            next += 1;
            for (_, [a, b]) in ends.iter().enumerate().filter(|(k, _)| *k != cut) {
                for q in [(p == *a).then_some(*b), (p == *b).then_some(*a)].into_iter().flatten() {
                    if !reached.contains(&q) {
                        reached.push(q);
                    }
                }
            }
        }
        (!reached.contains(&to)).then_some(reached)
    };
    for k in 0..pieces.len() {
        let (Some(before), Some(after)) = (behind(k, 0), behind(k, 1)) else { continue };
        let on = |side: &[Point], s: &&Source| side.contains(&s.at);
        let power: f64 = sources.iter().filter(|s| on(&before, s)).map(|s| s.power).sum();
        pieces[k].power = Some(if power.abs() < ROUND_OFF { 0.0 } else { power });
        let circles = |side: &[Point]| sources.iter().filter(|s| on(side, s)).any(|s| s.circles);
        pieces[k].circulates = power.abs() >= ROUND_OFF && circles(&before) && circles(&after);
    }
}
