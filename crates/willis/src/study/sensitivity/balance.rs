//! The equilibrium of a train in dual numbers: which ends drive is known, so forces solve linear equations; losses and
//! torques are repeated until derivatives too agree.

use std::borrow::Cow;

use num_dual::{Dual64, DualNum};

use crate::analysis::Point;
use crate::kinematics::Coupling;
use crate::operating_point::{LossKind, Numbers, Physics, Step, VariatorNumbers};
use crate::power_flow::{Drag, MeshFlow, rho};
use crate::real;
use crate::statics::SolvedColumn;
use crate::train::{FRAME, Load, MachineEfficiency, MemberId, Operation, Store, Train, Variator};

/// Most rounds of laws and statics.
const MOST_ROUNDS: usize = 400;
/// The error that is left in a derivative, over its size.
const ACCURACY: f64 = 1e-11;

/// What moves beside the numbers of the train.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Moved {
    /// Nothing that the operation prescribes.
    Train,
    /// Its prescribed speed of this place.
    Speed(usize),
    /// Its prescribed torque or power of this place.
    Load(usize),
}

/// Powers with their derivative by one quantity, W.
pub(super) struct Powers {
    pub input: Dual64,
    pub output: Dual64,
    pub loss: Dual64,
    /// Name, kind, law, power of each loss.
    pub sources: Vec<(String, LossKind, &'static str, Dual64)>,
    pub rounds: usize,
    /// Bound on the error of the derivatives that is left, over their size.
    pub error: f64,
}

impl Powers {
    pub fn efficiency(&self) -> Dual64 {
        if self.loss.re == 0.0 && self.loss.eps == 0.0 { Dual64::from(1.0) } else { self.output / self.input }
    }

    /// Derivative of input less output less losses over that of the largest of them: zero up to round-off.
    pub fn residual(&self) -> f64 {
        let size = self.input.eps.abs().max(self.output.eps.abs()).max(self.loss.eps.abs());
        let left = self.input.eps - self.output.eps - self.loss.eps;
        if size == 0.0 { 0.0 } else { (left / size).abs() }
    }
}

/// A point in dual numbers.
struct State {
    meshes: Vec<MeshFlow<Dual64>>,
    /// Of each element behind the meshes: what it asks of its two ends.
    passing: Vec<[Dual64; 2]>,
    drags: Vec<Drag<Dual64>>,
}

/// A machine whose torque is prescribed: torque on its member, power out of the bus.
struct Driven {
    at: [usize; 2],
    torque: Dual64,
    draws: Dual64,
}

/// What acts on a train from outside, and machines.
struct Loads {
    external: Vec<(MemberId, Dual64)>,
    driven: Vec<Driven>,
}

impl Loads {
    /// Torques on members and buses.
    fn torques(&self, point: &Point<'_>, speeds: &[Dual64]) -> Vec<(MemberId, Dual64)> {
        let mut all = self.external.clone();
        for d in &self.driven {
            let bus = point.c.bus(d.at[0]);
            let member = point.c.train.variators[d.at[0]].machines()[d.at[1]].member;
            all.extend([(member, d.torque), (bus, -d.draws / speeds[bus.0])]);
        }
        all
    }
}

/// What is lost on the way.
struct InForce<'a> {
    meshes: &'a [[Dual64; 2]],
    /// By element behind the meshes: its first end driving, its second end driving.
    passing: Vec<[Dual64; 2]>,
}

/// Powers at a point with the derivative by what moves; `None` where the equations have no solution.
pub(super) fn powers(
    train: &Train,
    operation: &Operation,
    point: &Point<'_>,
    numbers: Numbers<Dual64>,
    moved: Moved,
) -> Option<Powers> {
    let speeds = speeds(train, operation, point, moved);
    let loads = loads(operation, point, &speeds, &numbers, moved);
    let given = numbers.efficiencies.clone();
    let variators = numbers.variators.clone();
    let physics = train.depends_on_load().then(|| Physics::with_numbers(Cow::Borrowed(train), numbers));
    let known = |m: MemberId| point.motion.speeds[m.0].is_some();

    let Some(physics) = physics else {
        let eta = InForce { meshes: &given, passing: passing(point, &speeds, &variators, &[]) };
        let state = solve(point, &speeds, &loads, vec![], &eta)?;
        let total = totals(point, &speeds, &loads, &state);
        let sources = state
            .meshes
            .iter()
            .map(|m| (train.meshes[m.mesh.index()].name.clone(), LossKind::Sliding, "given", m.loss));
        let sources = sources.chain(through_variators(point, &speeds, &loads, &state, &variators));
        return Some(Powers { sources: sources.collect(), rounds: 1, error: 0.0, ..total });
    };
    // The point itself is the start: what is missing are derivatives.
    let in_force: Vec<[Dual64; 2]> = (point.c.efficiencies.iter())
        .map(|e| [Dual64::from(e.forward.to_f64()), Dual64::from(e.backward.to_f64())])
        .collect();
    let forces: Vec<Dual64> = point.forces.iter().map(|f| Dual64::from(*f)).collect();
    let mut meshes = walk(point, &speeds, &forces, &in_force);
    let eta = InForce { meshes: &in_force, passing: passing(point, &speeds, &variators, &[]) };
    let mut asked = asked(point, &speeds, &forces, &eta);
    let (mut last, mut q) = (f64::INFINITY, 0.0f64);
    let mut old: Option<Vec<f64>> = None;
    let idle = physics.without_load(&speeds, &meshes, &known);
    for rounds in 1..=MOST_ROUNDS {
        let step: Step<Dual64> = physics.evaluate_with(&speeds, &meshes, &known, &idle);
        let efficiencies = step.efficiencies(train, &given);
        let mut drags = step.drags.clone();
        for (k, v) in train.variators.iter().enumerate().filter(|(_, v)| v.has_bus()) {
            let bus = point.c.bus(k);
            if v.is_computed() {
                drags.push(Drag { members: [bus, FRAME], torque: -variators[k].standby / speeds[bus.0] });
            }
        }
        let eta = InForce { meshes: &efficiencies, passing: passing(point, &speeds, &variators, &asked) };
        let state = solve(point, &speeds, &loads, drags, &eta)?;
        let mut total = totals(point, &speeds, &loads, &state);
        let drag_losses: Vec<Dual64> = state.drags.iter().map(|d| drag_loss(d, &speeds)).collect();
        total.sources = physics.parts(&step, &state.meshes, &drag_losses);
        total.sources.extend(through_variators(point, &speeds, &loads, &state, &variators));
        // Change of the derivatives since the last round, and the factor by which changes shrink.
        let new: Vec<f64> = total.sources.iter().map(|s| s.3.eps).collect();
        let size = new.iter().fold(total.loss.eps.abs(), |a, x| a.max(x.abs()));
        let change = match &old {
            Some(old) if old.len() == new.len() => old.iter().zip(&new).fold(0.0f64, |a, (x, y)| a.max((x - y).abs())),
            _ => f64::INFINITY,
        };
        if last.is_finite() && last > 0.0 {
            q = (change / last).max(0.2 * q);
        }
        last = change;
        let relative = if size > 0.0 { change / size } else { change };
        let error = if q < 1.0 { relative / (1.0 - q) } else { relative };
        if error <= ACCURACY || rounds == MOST_ROUNDS {
            return Some(Powers { rounds, error, ..total });
        }
        old = Some(new);
        (meshes, asked) = (state.meshes, state.passing);
    }
    None
}

/// Speeds of all members: linear in what is prescribed.
fn speeds(train: &Train, operation: &Operation, point: &Point<'_>, moved: Moved) -> Vec<Dual64> {
    // A bus turns as it does: a power is a torque on it, whatever its speed.
    let values = (0..point.c.node_of.len()).map(|m| point.motion.si(MemberId(m)).unwrap_or(0.0));
    let mut speeds: Vec<Dual64> = values.map(Dual64::from).collect();
    if let Moved::Speed(k) = moved {
        let prescribed: Vec<MemberId> = operation.speeds.iter().map(|(m, _)| *m).collect();
        for (speed, factors) in speeds.iter_mut().take(train.members.len()).zip(point.c.transfer(&prescribed).speeds) {
            speed.eps = factors.map_or(0.0, |f| f[k].to_f64());
        }
    }
    speeds
}

/// Prescribed torques, stores and machines.
fn loads(
    operation: &Operation,
    point: &Point<'_>,
    speeds: &[Dual64],
    numbers: &Numbers<Dual64>,
    moved: Moved,
) -> Loads {
    let (mut all, mut driven) = (Vec::new(), Vec::new());
    let train = point.c.train;
    for (k, v) in numbers.variators.iter().enumerate().filter(|(k, _)| train.variators[*k].has_bus()) {
        let power = match operation.stores.iter().find(|(of, _)| *of == k) {
            Some((_, Store::Power(own))) => Some(Dual64::from(own.si())),
            Some((_, Store::Free)) => None,
            None => v.store,
        };
        let bus = point.c.bus(k);
        all.extend(power.map(|p| (bus, p / speeds[bus.0])));
    }
    for (at, load) in &operation.machines {
        let machine = &train.variators[at[0]].machines()[at[1]];
        let w = speeds[machine.member.0];
        let torque = match load {
            Load::Torque(q) => Dual64::from(q.si()),
            Load::Power(_) if w.re == 0.0 => Dual64::from(0.0),
            Load::Power(p) => Dual64::from(p.si()) / w,
        };
        let power = torque * w;
        let [motoring, generating] = match &machine.efficiency {
            MachineEfficiency::Map(map) => [map.at(real::abs(w), real::abs(torque) * power.re.signum()).0; 2],
            MachineEfficiency::Constant(_) => numbers.variators[at[0]].efficiencies[at[1]],
        };
        let draws = if power.re > 0.0 { power / motoring } else { power * generating };
        driven.push(Driven { at: *at, torque, draws });
    }
    for (k, (member, load)) in operation.loads.iter().enumerate() {
        let own = |value: f64| Dual64::new(value, if moved == Moved::Load(k) { 1.0 } else { 0.0 });
        let torque = match load {
            Load::Torque(q) => own(q.si()),
            // No power at rest: no torque.
            Load::Power(_) if speeds[member.0].re == 0.0 => Dual64::from(0.0),
            Load::Power(p) => own(p.si()) / speeds[member.0],
        };
        all.push((*member, torque));
    }
    Loads { external: all, driven }
}

/// Efficiencies of the elements behind the meshes, first end driving and second end driving; those of a map where the
/// machine runs, by what the elements asked of their ends in the round before.
fn passing(
    point: &Point<'_>,
    speeds: &[Dual64],
    variators: &[VariatorNumbers<Dual64>],
    asked: &[[Dual64; 2]],
) -> Vec<[Dual64; 2]> {
    let of = |(k, coupling): (usize, &Coupling)| {
        let own = &variators[coupling.variator].efficiencies;
        let Some(machine) = coupling.machine else { return own[0] };
        // The member drives where the machine generates.
        let [motoring, generating] = own[machine];
        let described = &point.c.train.variators[coupling.variator].machines()[machine];
        if let (MachineEfficiency::Map(map), Some([asks, _])) = (&described.efficiency, asked.get(k)) {
            let w = speeds[described.member.0];
            let generates = (*asks * w).re > 0.0;
            let torque = real::abs(*asks) * if generates { -1.0 } else { 1.0 };
            return [map.at(real::abs(w), torque).0; 2];
        }
        [generating, motoring]
    };
    point.c.couplings.iter().enumerate().map(of).collect()
}

/// The coefficients of the ends of an element behind the meshes, as the speeds make them.
fn coefficients(point: &Point<'_>, speeds: &[Dual64], k: usize) -> [Dual64; 2] {
    let element = &point.c.elements[point.c.gears().len() + k];
    let [p, q] = [speeds[element.p.0], speeds[element.q.0]];
    match point.c.couplings[k].machine {
        Some(_) => [Dual64::from(1.0), -p / q],
        None => {
            let most = p.re.abs().max(q.re.abs());
            [q / most, -p / most]
        }
    }
}

/// What elements behind the meshes ask of their ends.
fn asked(point: &Point<'_>, speeds: &[Dual64], forces: &[Dual64], eta: &InForce<'_>) -> Vec<[Dual64; 2]> {
    let gears = point.c.gears().len();
    let of = |k: usize| {
        let rho = passed(point.known().p_drives(gears + k), eta.passing[k]);
        let [a, b] = coefficients(point, speeds, k);
        [forces[gears + k] * a, forces[gears + k] * b * rho]
    };
    (0..point.c.couplings.len()).map(of).collect()
}

fn passed(p_drives: Option<bool>, [first, second]: [Dual64; 2]) -> Dual64 {
    match p_drives {
        None => Dual64::from(1.0),
        Some(true) => first,
        Some(false) => second.recip(),
    }
}

/// What variators lose, standby losses included.
fn through_variators(
    point: &Point<'_>,
    speeds: &[Dual64],
    loads: &Loads,
    state: &State,
    numbers: &[VariatorNumbers<Dual64>],
) -> Vec<(String, LossKind, &'static str, Dual64)> {
    let gears = point.c.gears().len();
    let of = |(k, v): (usize, &Variator)| {
        let mut loss = numbers[k].standby;
        for (j, coupling) in point.c.couplings.iter().enumerate().filter(|(_, c)| c.variator == k) {
            let _ = coupling;
            let element = &point.c.elements[gears + j];
            let [p, q] = state.passing[j];
            loss += p * speeds[element.p.0] + q * speeds[element.q.0];
        }
        for d in loads.driven.iter().filter(|d| d.at[0] == k) {
            let member = v.machines()[d.at[1]].member;
            loss += d.draws - d.torque * speeds[member.0];
        }
        (v.name.clone(), LossKind::Variator, "given", loss)
    };
    point.c.train.variators.iter().enumerate().map(of).collect()
}

/// Forces that balance loads and drags with these efficiencies, followed through the meshes.
fn solve(
    point: &Point<'_>,
    speeds: &[Dual64],
    loads: &Loads,
    drags: Vec<Drag<Dual64>>,
    eta: &InForce<'_>,
) -> Option<State> {
    let gears = point.c.gears().len();
    let known = point.known();
    let entries = |column: &SolvedColumn, add: &mut dyn FnMut(usize, Dual64)| {
        let element = &point.c.elements[column.element];
        if let Some(k) = column.element.checked_sub(gears) {
            let [a, b] = coefficients(point, speeds, k);
            for (member, x) in [(element.p, a), (element.q, b * passed(column.p_drives, eta.passing[k]))] {
                known.row(point.c.node(member)).into_iter().for_each(|row| add(row, x));
            }
            return;
        }
        let rho = rho(element, column.p_drives, eta.meshes);
        column.entries.iter().for_each(|&(row, constant, slope)| add(row, rho * slope + constant));
    };
    let torques = loads.torques(point, speeds).into_iter();
    let torques = torques.chain(drags.iter().flat_map(|d| [(d.members[0], d.torque), (d.members[1], -d.torque)]));
    let forces = known.forces(entries, torques.map(|(member, torque)| (point.c.node(member), torque)))?;
    let meshes = walk(point, speeds, &forces, eta.meshes);
    Some(State { meshes, passing: asked(point, speeds, &forces, eta), drags })
}

fn walk(
    point: &Point<'_>,
    speeds: &[Dual64],
    forces: &[Dual64],
    efficiencies: &[[Dual64; 2]],
) -> Vec<MeshFlow<Dual64>> {
    // Idle elements have no driver.
    let acts = |e: usize| forces[e].re != 0.0 || forces[e].eps != 0.0;
    point.known().meshes(forces, speeds, efficiencies, |e| point.known().p_drives(e).filter(|_| acts(e)))
}

/// Torque times speed of the second member relative to the first.
fn drag_loss(d: &Drag<Dual64>, speeds: &[Dual64]) -> Dual64 {
    d.torque * (speeds[d.members[1].0] - speeds[d.members[0].0])
}

/// Input, output and loss.
fn totals(point: &Point<'_>, speeds: &[Dual64], loads: &Loads, state: &State) -> Powers {
    let train = point.c.train;
    let zero = Dual64::from(0.0);
    // What the meshes ask of each member, less what drags exert on it.
    let mut demand = vec![zero; speeds.len()];
    let mut passed = zero;
    for ([p, q], element) in state.passing.iter().zip(&point.c.elements[point.c.gears().len()..]) {
        demand[element.p.0] += *p;
        demand[element.q.0] += *q;
        passed += *p * speeds[element.p.0] + *q * speeds[element.q.0];
    }
    for d in &loads.driven {
        let member = train.variators[d.at[0]].machines()[d.at[1]].member;
        let bus = point.c.bus(d.at[0]);
        demand[member.0] -= d.torque;
        demand[bus.0] += d.draws / speeds[bus.0];
        passed += d.draws - d.torque * speeds[member.0];
    }
    for m in &state.meshes {
        let mesh = &train.meshes[m.mesh.index()];
        let members = [mesh.gears[0].member, mesh.gears[1].member, mesh.carrier];
        members.into_iter().zip(m.torques).for_each(|(member, torque)| demand[member.0] += torque);
    }
    for d in &state.drags {
        demand[d.members[0].0] -= d.torque;
        demand[d.members[1].0] += d.torque;
    }
    let mut external = vec![zero; speeds.len()];
    for (member, torque) in &loads.external {
        external[member.0] = *torque;
    }
    for member in &point.open {
        let Some(node) = point.c.node(*member) else { continue };
        let own = |m: &usize| !point.c.inner[*m] && point.c.node_of[*m] == Some(node);
        external[member.0] = (1..demand.len()).filter(own).fold(zero, |sum, m| sum + demand[m] - external[m]);
    }
    let powers: Vec<Dual64> = external.iter().zip(speeds).map(|(t, w)| *t * *w).collect();
    let largest = powers.iter().fold(0.0f64, |a, p| a.max(p.re.abs()));
    // What stands still takes or gives power as soon as it moves: on the side of a rising quantity.
    let side = |p: &Dual64| if p.re.abs() > 1e-12 * largest { p.re } else { p.eps };
    let sum = |sign: f64| {
        let wanted = powers.iter().filter(|p| side(p) * sign > 0.0);
        wanted.fold(zero, |sum, p| sum + *p * sign)
    };
    let loss = state.meshes.iter().fold(passed, |sum, m| sum + m.loss);
    let loss = state.drags.iter().fold(loss, |sum, d| sum + drag_loss(d, speeds));
    Powers { input: sum(1.0), output: sum(-1.0), loss, sources: vec![], rounds: 0, error: 0.0 }
}
