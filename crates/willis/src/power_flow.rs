//! Where the power runs: torque and power of every member, mesh and shift element for one
//! equilibrium, the balance, and the power that goes round in circles.

mod known;
mod limits;

use std::collections::BTreeMap;

use crate::kinematics::{Configuration, Element, Motion};
use crate::real::{self, Real};
use crate::statics::Solution;
use crate::train::{FRAME, MemberId, MemberKind, MeshId, ShiftElementId, Train, Variator};

pub(crate) use known::{Known, rho};
pub use limits::{BeyondLimit, LimitedQuantity};
pub(crate) use limits::{machine_beyond, ratio_beyond};

/// Torques and powers at one mesh (all `count` of them together).
#[derive(Clone, Debug)]
pub struct MeshFlow<R = f64> {
    /// The mesh.
    pub mesh: MeshId,
    /// Torques that first gear, second gear and carrier put into the mesh, N m.
    pub torques: [R; 3],
    /// Speeds of first and second gear relative to the carrier, rad/s.
    pub relative_speeds: [R; 2],
    /// Which gear drives (0 or 1), seen from the carrier; none when idle or at rest.
    pub driver: Option<usize>,
    /// Power that the driving gear puts in, seen from the carrier, W (potential power).
    pub potential_power: R,
    /// Efficiency in force, 1 when nothing drives.
    pub efficiency: R,
    /// Loss, W.
    pub loss: R,
}

/// What a variator does.
#[derive(Clone, Debug, PartialEq)]
pub struct VariatorFlow {
    /// Position in [`Train::variators`](crate::train::Train::variators).
    pub variator: usize,
    /// Its two sides, or its machines.
    pub sides: Vec<SideFlow>,
    /// Power out of its store, W.
    pub store: f64,
    /// Loss on the way, W; standby losses are drags.
    pub loss: f64,
}

/// What a side of a variator, or a machine, does to its member.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SideFlow {
    /// The member.
    pub member: MemberId,
    /// Torque that it exerts on the member, N m.
    pub torque: f64,
    /// Speed of the member, rad/s.
    pub speed: f64,
    /// Power that it delivers to the member, W.
    pub power: f64,
}

/// A machine whose torque is prescribed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Driven {
    /// Variator and machine.
    pub at: [usize; 2],
    /// Torque on its member, N m.
    pub torque: f64,
    /// Power that it delivers to its member, W, where that is what is prescribed.
    pub power: Option<f64>,
    /// Power out of the bus, W.
    pub draws: f64,
}

/// Torque in an engaged shift element.
#[derive(Clone, Debug)]
pub struct ShiftElementFlow {
    /// The element.
    pub element: ShiftElementId,
    /// Torque it exerts on its first member, N m; `None` when several elements share a load in a
    /// way that statics cannot divide.
    pub torque: Option<f64>,
}

/// Power that circulates: it passes every station of the path and comes back.
#[derive(Clone, Debug)]
pub struct Circulation {
    /// The power that goes round, W.
    pub power: f64,
    /// Sets and shafts in the order in which it passes them.
    pub path: Vec<String>,
}

/// The power flow of one equilibrium.
#[derive(Clone, Debug, Default)]
pub struct Flow<R = f64> {
    /// External torque on each member, N m, reactions of brakes and holds included; `None` where
    /// brakes share a load indeterminately.
    pub torques: Vec<Option<R>>,
    /// Speed of each member, rad/s; then of each bus of a variator.
    pub speeds: Vec<R>,
    /// Where external power enters (1) and leaves (−1) the train, by member, then by bus of a variator; by exact signs of
    /// torque and speed.
    pub roles: Vec<i8>,
    /// External power into each member, W, then into the bus of each variator; what is prescribed as a power is that number,
    /// to the last bit.
    pub powers: Vec<R>,
    /// Every mesh.
    pub meshes: Vec<MeshFlow<R>>,
    /// Every engaged shift element.
    pub ties: Vec<ShiftElementFlow>,
    /// Every variator.
    pub variators: Vec<VariatorFlow>,
    /// Power in at all inputs, W.
    pub input_power: R,
    /// Power out at all outputs, W, positive.
    pub output_power: R,
    /// Sum of all losses, W.
    pub loss: R,
    /// Loss of each drag, W, in the order in which they were given.
    pub drag_losses: Vec<R>,
    /// Input less output less losses, W: zero up to round-off.
    pub residual: R,
}

/// What acts on a terminal.
#[derive(Clone, Copy, Debug)]
pub(crate) struct External {
    pub member: MemberId,
    /// N m.
    pub torque: f64,
    /// W, where that is what is prescribed: torque times speed would round it.
    pub prescribed_power: Option<f64>,
    /// The sign of its power, exactly.
    pub power: i8,
}

/// A torque that two members exert on each other against their relative motion: a bearing, a seal,
/// a gear in oil.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drag<R = f64> {
    /// The two members.
    pub members: [MemberId; 2],
    /// Torque on the first, N m; the second feels the opposite.
    pub torque: R,
}

impl Flow {
    /// Works out the flow of a solution. `scale` turns its forces into SI.
    pub(crate) fn new(
        c: &Configuration<'_>,
        motion: &Motion,
        solution: &Solution,
        scale: f64,
        externals: &[External],
        drags: &[Drag],
        driven: &[Driven],
    ) -> Self {
        let train = c.train;
        // Idle parts may have no determined speed; nothing flows there.
        let members = c.node_of.len();
        let speeds: Vec<f64> = (0..members).map(|m| motion.si(MemberId(m)).unwrap_or(0.0)).collect();
        let mut meshes = Vec::with_capacity(train.meshes.len());
        for (j, e) in c.gears().iter().enumerate() {
            let own = |mesh: MeshId, forward: bool| {
                let own = &c.efficiencies[mesh.0];
                if forward { own.forward.to_f64() } else { own.backward.to_f64() }
            };
            walk(train, e, solution.forces[j] * scale, solution.driver[j], &speeds, &own, &mut meshes);
        }
        meshes.sort_by_key(|m: &MeshFlow| m.mesh);
        let variators = variators(c, solution, scale, &speeds, externals, driven);
        Self::assemble(c, speeds, meshes, variators, externals, drags)
    }

    /// The flow through meshes and variators whose torques are known.
    pub(crate) fn assemble(
        c: &Configuration<'_>,
        speeds: Vec<f64>,
        meshes: Vec<MeshFlow>,
        variators: Vec<VariatorFlow>,
        externals: &[External],
        drags: &[Drag],
    ) -> Self {
        let train = c.train;
        let members = c.node_of.len();
        let mut demand = vec![0.0; members];
        for m in &meshes {
            let mesh = &train.meshes[m.mesh.0];
            for (member, torque) in
                [mesh.gears[0].member, mesh.gears[1].member, mesh.carrier].into_iter().zip(m.torques)
            {
                demand[member.0] += torque;
            }
        }
        for side in variators.iter().flat_map(|v| &v.sides) {
            demand[side.member.0] -= side.torque;
        }
        let mut dragged = vec![0.0; members];
        for d in drags {
            dragged[d.members[0].0] += d.torque;
            dragged[d.members[1].0] -= d.torque;
        }
        let mut external: Vec<f64> = vec![0.0; members];
        let mut roles: Vec<i8> = vec![0; members];
        let mut powers: Vec<f64> = vec![0.0; members];
        for x in externals {
            external[x.member.0] = x.torque;
            roles[x.member.0] = x.power;
            powers[x.member.0] = x.prescribed_power.unwrap_or(x.torque * speeds[x.member.0]);
        }
        let applied: Vec<f64> = external.iter().zip(&dragged).map(|(x, d)| x + d).collect();
        let (ties, reactions) = self::ties(c, &demand, &applied);
        let torques: Vec<Option<f64>> =
            (0..train.members.len()).map(|m| reactions[m].map(|r| external[m] + r)).collect();

        let sum = |role: i8| powers.iter().zip(&roles).filter(|(_, r)| **r == role).map(|(p, _)| p.abs()).sum();
        let (input_power, output_power) = (sum(1), sum(-1));
        let drag_losses: Vec<f64> =
            drags.iter().map(|d| d.torque * (speeds[d.members[1].0] - speeds[d.members[0].0])).collect();
        let passing = variators.iter().map(|v| v.loss);
        let loss = meshes.iter().map(|m| m.loss).chain(drag_losses.iter().copied()).chain(passing).sum::<f64>();
        let residual = powers.iter().sum::<f64>() - loss;
        Self {
            torques,
            speeds,
            roles,
            powers,
            meshes,
            ties,
            variators,
            input_power,
            output_power,
            loss,
            drag_losses,
            residual,
        }
    }

    /// Recirculating powers, largest first.
    pub(crate) fn circulations(&self, c: &Configuration<'_>) -> Vec<Circulation> {
        circulations(c, &self.meshes, &self.variators, &self.speeds, self.input_power)
    }
}

/// What each variator does in a solution.
fn variators(
    c: &Configuration<'_>,
    solution: &Solution,
    scale: f64,
    speeds: &[f64],
    externals: &[External],
    driven: &[Driven],
) -> Vec<VariatorFlow> {
    let side = |member: MemberId, torque: f64| SideFlow {
        member,
        torque,
        speed: speeds[member.0],
        power: torque * speeds[member.0],
    };
    let flow = |(variator, v): (usize, &Variator)| {
        let mut sides: Vec<SideFlow> = v.members().into_iter().map(|m| side(m, 0.0)).collect();
        let mut loss = 0.0;
        for (coupling, j) in c.couplings.iter().zip(c.gears().len()..).filter(|(own, _)| own.variator == variator) {
            let e = &c.elements[j];
            let [p, q] = [e.a.to_f64(), e.b.to_f64() * solution.rho[j]].map(|x| -solution.forces[j] * scale * x);
            loss -= p * speeds[e.p.0] + q * speeds[e.q.0];
            match coupling.machine {
                Some(machine) => sides[machine] = side(e.p, p),
                None => sides = vec![side(e.p, p), side(e.q, q)],
            }
        }
        for d in driven.iter().filter(|d| d.at[0] == variator) {
            let own = side(sides[d.at[1]].member, d.torque);
            sides[d.at[1]] = SideFlow { power: d.power.unwrap_or(own.power), ..own };
            loss += d.draws - sides[d.at[1]].power;
        }
        let bus = v.has_bus().then(|| c.bus(variator));
        let stores = externals.iter().filter(|x| Some(x.member) == bus);
        let store = stores.map(|x| x.prescribed_power.unwrap_or(x.torque * speeds[x.member.0])).sum::<f64>();
        VariatorFlow { variator, sides, store, loss }
    };
    c.train.variators.iter().enumerate().map(flow).collect()
}

/// Torque that the elements ask of each member, straight from their forces (chains as a whole).
pub(crate) fn demand(c: &Configuration<'_>, forces: &[f64], rho: &[f64]) -> Vec<f64> {
    let mut demand = vec![0.0; c.node_of.len()];
    for (j, e) in c.elements.iter().enumerate() {
        let (a, b) = (e.a.to_f64(), e.b.to_f64() * rho[j]);
        for (member, x) in [(e.p, a), (e.q, b), (e.carrier, -(a + b))] {
            demand[member.0] += forces[j] * x;
        }
    }
    demand
}

/// Follows the force through a chain, mesh by mesh. `efficiency` gives that of a mesh when its first gear drives
/// (`true`), or its second.
pub(crate) fn walk<R: Real>(
    train: &Train,
    e: &Element,
    force: R,
    p_drives: Option<bool>,
    speeds: &[R],
    efficiency: &dyn Fn(MeshId, bool) -> R,
    out: &mut Vec<MeshFlow<R>>,
) {
    let mut torque = force * e.a.to_f64();
    for link in &e.links {
        let mesh = &train.meshes[link.mesh.0];
        let (enter, leave) = if link.along { (0, 1) } else { (1, 0) };
        // Power runs along the chain, or against it.
        let efficiency = p_drives.map_or(R::from(1.0), |p| efficiency(link.mesh, p == link.along));
        let rho = if p_drives == Some(false) { R::from(1.0) / efficiency } else { efficiency };
        let ratio = mesh.gears[leave].teeth.to_f64() / mesh.gears[enter].teeth.to_f64();
        let left = torque * ratio * if mesh.same_sense { -1.0 } else { 1.0 } * rho;
        let mut torques = [R::from(0.0), R::from(0.0), -(torque + left)];
        torques[enter] = torque;
        torques[leave] = left;
        let relative_speeds = [0, 1].map(|g: usize| speeds[mesh.gears[g].member.0] - speeds[mesh.carrier.0]);
        let driver = p_drives.map(|p| if p { enter } else { leave });
        let none = R::from(0.0);
        let potential_power = driver.map_or(none, |d| real::max(torques[d] * relative_speeds[d], none));
        out.push(MeshFlow {
            mesh: link.mesh,
            torques,
            relative_speeds,
            driver,
            potential_power,
            efficiency,
            loss: potential_power * (-efficiency + 1.0),
        });
        torque = -left;
    }
}

/// Torques in shift elements and holds: leaf by leaf, as far as equilibrium determines them.
/// Returns also the reaction of the frame on each member.
pub(crate) fn ties(
    c: &Configuration<'_>,
    demand: &[f64],
    external: &[f64],
) -> (Vec<ShiftElementFlow>, Vec<Option<f64>>) {
    let train = c.train;
    let mut edges: Vec<([MemberId; 2], Option<ShiftElementId>, Option<f64>)> = c
        .engaged
        .iter()
        .map(|e| (train.shift_elements[e.0].members, Some(*e), None))
        .chain(train.joints.iter().map(|members| (*members, None, None)))
        .chain(c.held.iter().map(|m| ([*m, FRAME], None, None)))
        .collect();
    let mut need: Vec<f64> = demand.iter().zip(external).map(|(d, x)| d - x).collect();
    let mut open = vec![0; need.len()];
    for (m, ..) in &edges {
        m.iter().for_each(|m| open[m.0] += 1);
    }
    loop {
        let leaf = (0..edges.len()).find_map(|k| {
            let (members, _, done) = &edges[k];
            let at = (0..2).find(|&s| members[s] != FRAME && open[members[s].0] == 1)?;
            done.is_none().then_some((k, at))
        });
        let Some((k, at)) = leaf else { break };
        let [leaf, other] = [edges[k].0[at], edges[k].0[1 - at]];
        let on_leaf = need[leaf.0];
        need[other.0] += on_leaf;
        need[leaf.0] = 0.0;
        open[leaf.0] -= 1;
        open[other.0] -= 1;
        edges[k].2 = Some(if at == 0 { on_leaf } else { -on_leaf });
    }
    let mut reactions = vec![Some(0.0); need.len()];
    for (members, _, torque) in &edges {
        for (side, m) in members.iter().enumerate() {
            if members[1 - side] == FRAME {
                reactions[m.0] = match (reactions[m.0], torque) {
                    (Some(r), Some(t)) => Some(r + if side == 0 { *t } else { -*t }),
                    _ => None,
                };
            }
        }
    }
    // Several brakes on one member: their shares are open, their sum is not.
    for m in (1..need.len()).filter(|&m| open[m] > 1) {
        let grips = |members: &[MemberId; 2]| members.contains(&MemberId(m));
        let alone =
            edges.iter().filter(|(e, _, torque)| torque.is_none() && grips(e)).all(|(e, ..)| e.contains(&FRAME));
        if alone {
            let side = |e: &[MemberId; 2]| if e[0] == MemberId(m) { 1.0 } else { -1.0 };
            let known = edges.iter().filter(|(e, ..)| grips(e) && e.contains(&FRAME));
            let known: f64 = known.filter_map(|(e, _, torque)| torque.map(|t| side(e) * t)).sum();
            reactions[m] = Some(known + need[m]);
        }
    }
    let ties = edges
        .iter()
        .filter_map(|(_, id, torque)| id.map(|element| ShiftElementFlow { element, torque: *torque }))
        .collect();
    (ties, reactions)
}

/// Sets, and meshes that share a planet, count as one station of the power flow.
pub(crate) fn families(train: &Train) -> Vec<usize> {
    let mut family: Vec<usize> = (0..train.meshes.len()).collect();
    let planet = |m: MemberId| {
        m != FRAME
            && (train.members[m.0].kind == MemberKind::Planet
                || !train.terminals.contains(&m)
                    && !train.shift_elements.iter().any(|e| e.members.contains(&m))
                    && train.meshes.iter().all(|x| x.carrier != m))
    };
    for i in 0..family.len() {
        for j in 0..i {
            let (a, b) = (&train.meshes[i], &train.meshes[j]);
            let shared = a.gears.iter().any(|g| b.gears.iter().any(|h| g.member == h.member && planet(g.member)));
            let same_set = a.set.is_some() && a.set == b.set;
            if same_set || (a.carrier == b.carrier && a.carrier != FRAME && shared) {
                let (from, to) = (family[i], family[j]);
                family.iter_mut().filter(|f| **f == from).for_each(|f| *f = to);
            }
        }
    }
    family
}

/// Cycles in the directed graph of powers between shafts and sets, taken out one by one with the
/// smallest power on them.
fn circulations(
    c: &Configuration<'_>,
    meshes: &[MeshFlow],
    variators: &[VariatorFlow],
    speeds: &[f64],
    input: f64,
) -> Vec<Circulation> {
    let train = c.train;
    if meshes.len() + variators.len() < 2 || input <= 0.0 {
        return vec![];
    }
    // A variator is a station of its own, behind those of the meshes.
    let family = families(train);
    let station = |variator: usize| train.meshes.len() + variator;
    // Power from node n into family f.
    let mut power: BTreeMap<(usize, usize), f64> = BTreeMap::new();
    for m in meshes {
        let mesh = &train.meshes[m.mesh.0];
        for (member, torque) in [mesh.gears[0].member, mesh.gears[1].member, mesh.carrier].into_iter().zip(m.torques) {
            if c.inner[member.0] {
                continue;
            }
            if let Some(n) = c.node(member) {
                *power.entry((n, family[m.mesh.0])).or_default() += torque * speeds[member.0];
            }
        }
    }
    for v in variators {
        for side in &v.sides {
            if let Some(n) = c.node(side.member) {
                *power.entry((n, station(v.variator))).or_default() -= side.power;
            }
        }
    }
    let smallest = 1e-9 * input;
    // Directed edges between vertices: nodes first, families after them.
    let mut edges: Vec<(usize, usize, f64)> = power
        .iter()
        .filter(|(_, p)| p.abs() > smallest)
        .map(|(&(n, f), &p)| if p > 0.0 { (n, c.nodes + f, p) } else { (c.nodes + f, n, -p) })
        .collect();
    edges.sort_by_key(|e| (e.0, e.1));
    let label = |v: usize| -> String {
        if v >= c.nodes + train.meshes.len() {
            return train.variators[v - c.nodes - train.meshes.len()].name.clone();
        }
        if v >= c.nodes {
            let k = (0..train.meshes.len()).find(|&k| family[k] == v - c.nodes).expect("a family has a mesh");
            return match train.meshes[k].set {
                Some(s) => train.sets[s].name.clone(),
                None => train.meshes[k].name.clone(),
            };
        }
        let names: Vec<_> = (1..train.members.len())
            .filter(|&m| !c.inner[m] && c.node_of[m] == Some(v))
            .map(|m| train.members[m].name.as_str())
            .collect();
        names.join("=")
    };
    let taken = take_out_cycles(&mut edges, smallest);
    let mut found: Vec<Circulation> = taken
        .into_iter()
        .map(|(power, cycle)| Circulation { power, path: cycle.iter().map(|e| label(e.0)).collect() })
        .collect();
    found.sort_by(|a, b| b.power.total_cmp(&a.power));
    found
}

/// Takes the directed cycles out of a graph of powers, one by one, each with the smallest power on
/// it. Edges `(from, to, power)` that are left with no more than `smallest` are dropped. Returns
/// the power and the edges of each cycle.
pub(crate) fn take_out_cycles(edges: &mut Vec<(usize, usize, f64)>, smallest: f64) -> Vec<(f64, Vec<(usize, usize)>)> {
    let mut found = Vec::new();
    while let Some(cycle) = find_cycle(edges) {
        let least = cycle.iter().map(|&k| edges[k].2).fold(f64::INFINITY, f64::min);
        found.push((least, cycle.iter().map(|&k| (edges[k].0, edges[k].1)).collect()));
        cycle.iter().for_each(|&k| edges[k].2 -= least);
        edges.retain(|e| e.2 > smallest);
    }
    found
}

/// Edges of a directed cycle, if there is one: walk forward from each vertex, never twice along
/// one edge.
fn find_cycle(edges: &[(usize, usize, f64)]) -> Option<Vec<usize>> {
    let mut dead = vec![false; edges.len()];
    for start in 0..edges.len() {
        if dead[start] {
            continue;
        }
        let mut path = vec![start];
        while let Some(&last) = path.last() {
            let head = edges[last].1;
            if let Some(k) = path.iter().position(|&e| edges[e].0 == head) {
                return Some(path[k..].to_vec());
            }
            match (0..edges.len()).find(|&e| edges[e].0 == head && !dead[e] && !path.contains(&e)) {
                Some(next) => path.push(next),
                None => {
                    dead[last] = true;
                    path.pop();
                }
            }
        }
    }
    None
}
