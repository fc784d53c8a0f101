//! The equilibrium of a train in dual numbers, of several quantities at once: which ends drive is known, so forces solve linear
//! equations; losses and torques are repeated until derivatives too agree, those of each quantity for itself.

use std::borrow::Cow;

use num_dual::{Dual64, DualNum};

use crate::analysis::Point;
use crate::kinematics::Coupling;
use crate::operating_point::{LossKind, Numbers, Physics, Step, VariatorNumbers};
use crate::power_flow::{Drag, MeshFlow, rho};
use crate::real;
use crate::statics::SolvedColumn;
use crate::train::{FRAME, Load, MachineEfficiency, MemberId, Operation, Store, Train, Variator};

use super::lanes::{Asked, LANES, Moved, Moving, lane, moving};
use super::seeded;

/// Most rounds of laws and statics.
const MOST_ROUNDS: usize = 400;
/// The error that is left in a derivative, over its size.
const ACCURACY: f64 = 1e-11;

/// What loses, what kind of loss it is, its law, its power.
type Lost<N, R> = (N, LossKind, &'static str, R);

/// Powers with their derivative by one quantity, W.
pub(super) struct Powers {
    pub input: Dual64,
    pub output: Dual64,
    pub loss: Dual64,
    pub sources: Vec<Lost<String, Dual64>>,
    pub rounds: usize,
    /// Bound on the error of the derivatives that is left, over their size.
    pub error: f64,
}

impl Powers {
    pub fn efficiency(&self) -> Dual64 {
        if self.loss.re == 0.0 && self.loss.eps == 0.0 { Dual64::from(1.0) } else { self.output / self.input }
    }

    /// Whether every loss has a slope.
    pub fn is_finite(&self) -> bool {
        self.loss.eps.is_finite() && self.sources.iter().all(|s| s.3.eps.is_finite())
    }

    /// The largest derivative of a power.
    pub fn steepest(&self) -> f64 {
        self.input.eps.abs().max(self.output.eps.abs()).max(self.loss.eps.abs())
    }

    /// Derivative of input less output less losses over that of the largest of them: zero up to round-off, but where a quantity
    /// loads what carries nothing here. That loses whichever way it is loaded, so losses have a corner there, and no slope.
    pub fn residual(&self) -> f64 {
        let size = self.steepest();
        let left = self.input.eps - self.output.eps - self.loss.eps;
        if size == 0.0 { 0.0 } else { (left / size).abs() }
    }
}

/// A point in dual numbers.
struct State {
    meshes: Vec<MeshFlow<Moving>>,
    /// Of each element behind the meshes: what it asks of its two ends.
    passing: Vec<[Moving; 2]>,
    drags: Vec<Drag<Moving>>,
}

/// A machine whose torque is prescribed: torque on its member, power out of the bus.
struct Driven {
    at: [usize; 2],
    torque: Moving,
    draws: Moving,
}

/// What acts on a train from outside, and machines.
struct Loads {
    external: Vec<(MemberId, Moving)>,
    driven: Vec<Driven>,
}

impl Loads {
    /// Torques on members and buses.
    fn torques(&self, point: &Point<'_>, speeds: &[Moving]) -> Vec<(MemberId, Moving)> {
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
    meshes: &'a [[Moving; 2]],
    /// By element behind the meshes: its first end driving, its second end driving.
    passing: Vec<[Moving; 2]>,
}

/// Powers at a point with the derivative by each of up to [`LANES`] quantities; `None` where the equations have no solution. What is found
/// of one does not depend on those beside it.
pub(super) fn powers(
    train: &Train,
    operation: &Operation,
    point: &Point<'_>,
    asked: &[Asked<'_>],
) -> Vec<Option<Powers>> {
    let found = side_by_side(train, operation, point, asked);
    // Zero times the slope of a neighbour that has none is no number.
    if LANES == 1 || asked.len() == 1 || found.iter().all(|own| own.as_ref().is_some_and(Powers::is_finite)) {
        return found;
    }
    asked.iter().flat_map(|own| side_by_side(train, operation, point, std::slice::from_ref(own))).collect()
}

fn side_by_side(train: &Train, operation: &Operation, point: &Point<'_>, asked: &[Asked<'_>]) -> Vec<Option<Powers>> {
    let mut found: Vec<Option<Powers>> = asked.iter().map(|_| None).collect();
    if let Some(numbers) = seeded::numbers(train, operation.temperature, asked) {
        settle(train, operation, point, numbers, asked, &mut found);
    }
    found
}

/// Fills in each quantity in the round in which its derivatives agree; `None` where the equations have no solution.
fn settle(
    train: &Train,
    operation: &Operation,
    point: &Point<'_>,
    numbers: Numbers<Moving>,
    asked: &[Asked<'_>],
    found: &mut [Option<Powers>],
) -> Option<()> {
    let speeds = speeds(train, operation, point, asked);
    let loads = loads(operation, point, &speeds, &numbers, asked);
    let given = numbers.efficiencies.clone();
    let variators = numbers.variators.clone();
    let physics = train.depends_on_load().then(|| Physics::with_numbers(Cow::Borrowed(train), numbers));
    let known = |m: MemberId| point.motion.speeds[m.0].is_some();

    let Some(physics) = physics else {
        let eta = InForce { meshes: &given, passing: passing(point, &speeds, &variators, &[]) };
        let state = solve(point, &speeds, &loads, vec![], &eta)?;
        let total = Totals::of(point, &speeds, &loads, &state);
        let sources = state
            .meshes
            .iter()
            .map(|m| (train.meshes[m.mesh.index()].name.as_str(), LossKind::Sliding, "given", m.loss));
        let sources: Vec<_> = sources.chain(through_variators(point, &speeds, &loads, &state, &variators)).collect();
        for (k, own) in found.iter_mut().enumerate() {
            *own = Some(total.lane(k, &sources, 1, 0.0));
        }
        return Some(());
    };
    // The point itself is the start: what is missing are derivatives.
    let in_force: Vec<[Moving; 2]> = (point.c.efficiencies.iter())
        .map(|e| [Moving::from(e.forward.to_f64()), Moving::from(e.backward.to_f64())])
        .collect();
    let forces: Vec<Moving> = point.forces.iter().map(|f| Moving::from(*f)).collect();
    let mut meshes = walk(point, &speeds, &forces, &in_force);
    let eta = InForce { meshes: &in_force, passing: passing(point, &speeds, &variators, &[]) };
    let mut passed = through(point, &speeds, &forces, &eta);
    let mut trends = vec![Trend { last: f64::INFINITY, contraction: 0.0 }; asked.len()];
    let mut old: Option<Vec<Lost<&str, Moving>>> = None;
    let idle = physics.without_load(&speeds, &meshes, &known);
    for rounds in 1..=MOST_ROUNDS {
        let step: Step<Moving> = physics.evaluate_with(&speeds, &meshes, &known, &idle);
        let efficiencies = step.efficiencies(train, &given);
        let mut drags = step.drags.clone();
        for (k, v) in train.variators.iter().enumerate().filter(|(_, v)| v.has_bus()) {
            let bus = point.c.bus(k);
            if v.is_computed() {
                drags.push(Drag { members: [bus, FRAME], torque: -variators[k].standby / speeds[bus.0] });
            }
        }
        let eta = InForce { meshes: &efficiencies, passing: passing(point, &speeds, &variators, &passed) };
        let state = solve(point, &speeds, &loads, drags, &eta)?;
        let total = Totals::of(point, &speeds, &loads, &state);
        let drag_losses: Vec<Moving> = state.drags.iter().map(|d| drag_loss(d, &speeds)).collect();
        let mut sources = physics.parts(&step, &state.meshes, &drag_losses);
        sources.extend(through_variators(point, &speeds, &loads, &state, &variators));
        let comparable = old.as_ref().filter(|old| old.len() == sources.len());
        for (k, (own, trend)) in found.iter_mut().zip(&mut trends).enumerate().filter(|(_, (own, _))| own.is_none()) {
            let slope = |s: &Lost<&str, Moving>| lane(&s.3, k).eps;
            let size = sources.iter().fold(lane(&total.loss, k).eps.abs(), |a, s| a.max(slope(s).abs()));
            let change = comparable.map_or(f64::INFINITY, |old| {
                old.iter().zip(&sources).fold(0.0f64, |a, (x, y)| a.max((slope(x) - slope(y)).abs()))
            });
            let error = trend.error(change, size);
            if error <= ACCURACY || rounds == MOST_ROUNDS {
                *own = Some(total.lane(k, &sources, rounds, error));
            }
        }
        if found.iter().all(Option::is_some) {
            break;
        }
        old = Some(sources);
        (meshes, passed) = (state.meshes, state.passing);
    }
    Some(())
}

/// How the derivatives by one quantity change from round to round.
#[derive(Clone, Copy)]
struct Trend {
    last: f64,
    /// The factor by which changes shrink.
    contraction: f64,
}

impl Trend {
    /// The error that is left after one more change, over the size of the derivatives.
    fn error(&mut self, change: f64, size: f64) -> f64 {
        if self.last.is_finite() && self.last > 0.0 {
            self.contraction = (change / self.last).max(0.2 * self.contraction);
        }
        self.last = change;
        let relative = if size > 0.0 { change / size } else { change };
        if self.contraction < 1.0 { relative / (1.0 - self.contraction) } else { relative }
    }
}

/// Speeds of all members: linear in what is prescribed.
fn speeds(train: &Train, operation: &Operation, point: &Point<'_>, asked: &[Asked<'_>]) -> Vec<Moving> {
    // A bus turns as it does: a power is a torque on it, whatever its speed.
    let values = (0..point.c.node_of.len()).map(|m| point.motion.si(MemberId(m)).unwrap_or(0.0));
    let mut speeds: Vec<Moving> = values.map(Moving::from).collect();
    let prescribed = |own: &Asked<'_>| match own.moved {
        Moved::Speed(place) => Some(place),
        _ => None,
    };
    if asked.iter().any(|own| prescribed(own).is_some()) {
        let members: Vec<MemberId> = operation.speeds.iter().map(|(m, _)| *m).collect();
        for (speed, factors) in speeds.iter_mut().take(train.members.len()).zip(point.c.transfer(&members).speeds) {
            let Some(factors) = factors else { continue };
            let rates = asked.iter().enumerate().filter_map(|(k, own)| Some((k, factors[prescribed(own)?].to_f64())));
            *speed = moving(speed.re, rates);
        }
    }
    speeds
}

/// Prescribed torques, stores and machines.
fn loads(
    operation: &Operation,
    point: &Point<'_>,
    speeds: &[Moving],
    numbers: &Numbers<Moving>,
    asked: &[Asked<'_>],
) -> Loads {
    let (mut all, mut driven) = (Vec::new(), Vec::new());
    let train = point.c.train;
    for (k, v) in numbers.variators.iter().enumerate().filter(|(k, _)| train.variators[*k].has_bus()) {
        let power = match operation.stores.iter().find(|(of, _)| *of == k) {
            Some((_, Store::Power(own))) => Some(Moving::from(own.si())),
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
            Load::Torque(q) => Moving::from(q.si()),
            Load::Power(_) if w.re == 0.0 => Moving::from(0.0),
            Load::Power(p) => Moving::from(p.si()) / w,
        };
        let power = torque * w;
        let [motoring, generating] = match &machine.efficiency {
            MachineEfficiency::Map(map) => [map.at(real::abs(w), real::abs(torque) * power.re.signum()).0; 2],
            MachineEfficiency::Constant(_) => numbers.variators[at[0]].efficiencies[at[1]],
        };
        let draws = if power.re > 0.0 { power / motoring } else { power * generating };
        driven.push(Driven { at: *at, torque, draws });
    }
    for (place, (member, load)) in operation.loads.iter().enumerate() {
        let lanes = asked.iter().enumerate().filter(|(_, own)| own.moved == Moved::Load(place));
        let own = |value: f64| moving(value, lanes.clone().map(|(k, _)| (k, 1.0)));
        let torque = match load {
            Load::Torque(q) => own(q.si()),
            // No power at rest: no torque.
            Load::Power(_) if speeds[member.0].re == 0.0 => Moving::from(0.0),
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
    speeds: &[Moving],
    variators: &[VariatorNumbers<Moving>],
    asked: &[[Moving; 2]],
) -> Vec<[Moving; 2]> {
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
fn coefficients(point: &Point<'_>, speeds: &[Moving], k: usize) -> [Moving; 2] {
    let element = &point.c.elements[point.c.gears().len() + k];
    let [p, q] = [speeds[element.p.0], speeds[element.q.0]];
    match point.c.couplings[k].machine {
        Some(_) => [Moving::from(1.0), -p / q],
        None => {
            let most = p.re.abs().max(q.re.abs());
            [q / most, -p / most]
        }
    }
}

/// What elements behind the meshes ask of their ends.
fn through(point: &Point<'_>, speeds: &[Moving], forces: &[Moving], eta: &InForce<'_>) -> Vec<[Moving; 2]> {
    let gears = point.c.gears().len();
    let of = |k: usize| {
        let rho = passed(point.known().p_drives(gears + k), eta.passing[k]);
        let [a, b] = coefficients(point, speeds, k);
        [forces[gears + k] * a, forces[gears + k] * b * rho]
    };
    (0..point.c.couplings.len()).map(of).collect()
}

fn passed(p_drives: Option<bool>, [first, second]: [Moving; 2]) -> Moving {
    match p_drives {
        None => Moving::from(1.0),
        Some(true) => first,
        Some(false) => second.recip(),
    }
}

/// What variators lose, standby losses included.
fn through_variators<'t>(
    point: &Point<'t>,
    speeds: &[Moving],
    loads: &Loads,
    state: &State,
    numbers: &[VariatorNumbers<Moving>],
) -> Vec<Lost<&'t str, Moving>> {
    let gears = point.c.gears().len();
    let of = |(k, v): (usize, &'t Variator)| {
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
        (v.name.as_str(), LossKind::Variator, "given", loss)
    };
    point.c.train.variators.iter().enumerate().map(of).collect()
}

/// Forces that balance loads and drags with these efficiencies, followed through the meshes.
fn solve(
    point: &Point<'_>,
    speeds: &[Moving],
    loads: &Loads,
    drags: Vec<Drag<Moving>>,
    eta: &InForce<'_>,
) -> Option<State> {
    let gears = point.c.gears().len();
    let known = point.known();
    let entries = |column: &SolvedColumn, add: &mut dyn FnMut(usize, Moving)| {
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
    Some(State { meshes, passing: through(point, speeds, &forces, eta), drags })
}

fn walk(
    point: &Point<'_>,
    speeds: &[Moving],
    forces: &[Moving],
    efficiencies: &[[Moving; 2]],
) -> Vec<MeshFlow<Moving>> {
    // Idle elements have no driver.
    let acts = |e: usize| forces[e].re != 0.0 || (0..LANES).any(|k| lane(&forces[e], k).eps != 0.0);
    point.known().meshes(forces, speeds, efficiencies, |e| point.known().p_drives(e).filter(|_| acts(e)))
}

/// Torque times speed of the second member relative to the first.
fn drag_loss(d: &Drag<Moving>, speeds: &[Moving]) -> Moving {
    d.torque * (speeds[d.members[1].0] - speeds[d.members[0].0])
}

/// What enters and leaves, and all losses.
struct Totals {
    /// Powers of what acts from outside, by member.
    powers: Vec<Moving>,
    loss: Moving,
}

impl Totals {
    fn of(point: &Point<'_>, speeds: &[Moving], loads: &Loads, state: &State) -> Self {
        let train = point.c.train;
        let zero = Moving::from(0.0);
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
        let powers = external.iter().zip(speeds).map(|(t, w)| *t * *w).collect();
        let loss = state.meshes.iter().fold(passed, |sum, m| sum + m.loss);
        let loss = state.drags.iter().fold(loss, |sum, d| sum + drag_loss(d, speeds));
        Self { powers, loss }
    }

    /// With the derivatives of one lane.
    fn lane(&self, k: usize, sources: &[Lost<&str, Moving>], rounds: usize, error: f64) -> Powers {
        let largest = self.powers.iter().fold(0.0f64, |a, p| a.max(p.re.abs()));
        // What stands still takes or gives power as soon as it moves: on the side of a rising quantity.
        let side = |p: &Dual64| if p.re.abs() > 1e-12 * largest { p.re } else { p.eps };
        let sum = |sign: f64| {
            let wanted = self.powers.iter().map(|p| lane(p, k)).filter(|p| side(p) * sign > 0.0);
            wanted.fold(Dual64::from(0.0), |sum, p| sum + p * sign)
        };
        let sources =
            sources.iter().map(|(name, kind, law, loss)| ((*name).to_owned(), *kind, *law, lane(loss, k))).collect();
        Powers { input: sum(1.0), output: sum(-1.0), loss: lane(&self.loss, k), sources, rounds, error }
    }
}
