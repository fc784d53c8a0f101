//! Variators while they move: torques of their sides, what their stores give, what they lose.

use crate::power_flow::{BeyondLimit, machine_beyond, ratio_beyond};
use crate::train::{ControlKind, Machine, MemberId};

use super::engine::{Engine, PathState};
use super::margins::NOISE;
use super::mode::dot;
use super::report::LimitExceeded;
use super::rounding::short;
use super::system::{BusMachine, Geared, GivenStore, MachineDoes, Path, PathKind};

/// Change of a torque, relative to it, below which the map of a machine agrees with it.
const AGREEMENT: f64 = 1e-13;

/// Rounds, at most, in which they are brought into agreement.
const MOST_ROUNDS: usize = 60;

/// Rounds, at most, in which the torques at the start are found.
const MOST_STARTS: usize = 200;

/// A side of a variator at the state solved last.
#[derive(Clone, Copy, Debug)]
pub(super) struct PathSide {
    /// rad/s
    pub speed: f64,
    /// Torque that it exerts on its member, N m; NaN where what holds the member is not determined.
    pub torque: f64,
}

/// Power that a machine takes from its bus while it exerts a torque.
fn from_bus(machine: &Machine, torque: f64, speed: f64) -> f64 {
    let power = torque * speed;
    let (efficiency, _) = machine.efficiency.at(torque, speed);
    if power > 0.0 { power / efficiency } else { power * efficiency }
}

/// The torque of a machine that takes this power from its bus.
///
/// At standstill no torque passes a power: where its limit would be exceeded it falls in a straight line with the speed,
/// and the store takes the rest.
fn balancing(machine: &Machine, power: f64, speed: f64) -> f64 {
    if power == 0.0 {
        return 0.0;
    }
    let mut torque = 0.0;
    let mut guess = power / speed;
    for _ in 0..MOST_ROUNDS {
        let (e, _) = machine.efficiency.at(guess, speed);
        torque = if power > 0.0 { power * e / speed } else { power / (e * speed) };
        if (torque - guess).abs() <= AGREEMENT * torque.abs() {
            break;
        }
        guess = torque;
    }
    match machine.torque {
        Some(most) if torque.abs() > most || torque.is_nan() => {
            most * (speed / (power.abs() / most)).clamp(-1.0, 1.0) * power.signum()
        }
        _ => torque,
    }
}

impl Engine {
    /// The control of a variator with two members.
    fn control(&self, path: &Path) -> &ControlKind {
        &self.system.scenario.controls[path.control.expect("it is controlled")].kind
    }

    /// What the store of a bus is to give, W, where a machine balances it.
    fn given_store(&self, path: &Path, store: &GivenStore, t: f64) -> f64 {
        match store {
            GivenStore::Signal => self.control(path).signal().value(t, self.inside, &|m| self.member_speed(m)),
            GivenStore::Power(power) => *power,
            GivenStore::Free => 0.0,
        }
    }

    /// What a ratio would be at a state without its limits.
    fn wanted_ratio(&self, path: &Path, geared: &Geared, t: f64, x: &[f64]) -> f64 {
        match geared.ratio {
            Some(i) => x[self.integrals() + i],
            None => self.control(path).signal().value(t, self.inside, &|m| self.member_speed(m)),
        }
    }

    /// What it is: at a limit that, elsewhere what is wanted.
    fn ratio(&self, k: usize, geared: &Geared, t: f64, x: &[f64]) -> f64 {
        match self.path_ends[k] {
            -1 => geared.limits[0],
            1 => geared.limits[1],
            _ => self.wanted_ratio(&self.system.paths[k], geared, t, x),
        }
    }

    /// How far a ratio is beyond its least, and beyond its greatest; and the round-off of that.
    fn beyond_ends(&self, k: usize, geared: &Geared, t: f64, x: &[f64]) -> ([f64; 2], f64) {
        let wanted = self.wanted_ratio(&self.system.paths[k], geared, t, x);
        let [least, most] = geared.limits;
        let size = geared.limits.iter().filter(|l| l.is_finite()).fold(wanted.abs(), |a, l| a.max(l.abs()));
        ([least - wanted, wanted - most], NOISE * size)
    }

    /// The rate at which a ratio is to change where that is what is given.
    fn wanted_rate(&self, k: usize, t: f64) -> f64 {
        self.control(&self.system.paths[k]).signal().value(t, self.inside, &|m| self.member_speed(m))
    }

    /// Finds which limits ratios are at from now on; the state has been looked at.
    pub(super) fn look_at_ends(&mut self, t: f64, x: &[f64]) {
        for k in 0..self.path_ends.len() {
            self.path_ends[k] = self.path_end_now(k, t, x);
        }
        self.look_at_paths(t, x);
    }

    fn path_end_now(&self, k: usize, t: f64, x: &[f64]) -> i8 {
        let PathKind::Geared(geared) = &self.system.paths[k].kind else { return 0 };
        let ([below, above], noise) = self.beyond_ends(k, geared, t, x);
        match geared.ratio {
            // A ratio that changes at a rate stays at its limit while the rate leads out of it.
            Some(_) if below >= -noise && self.wanted_rate(k, t) < 0.0 => -1,
            Some(_) if above >= -noise && self.wanted_rate(k, t) > 0.0 => 1,
            None if below > 0.0 => -1,
            None if above > 0.0 => 1,
            _ => 0,
        }
    }

    /// By how much a ratio stays at its limit, or between them, and the round-off of that.
    pub(super) fn path_end_margin(&self, k: usize, t: f64, x: &[f64]) -> (f64, f64) {
        let PathKind::Geared(geared) = &self.system.paths[k].kind else { return (f64::INFINITY, 0.0) };
        let ([below, above], noise) = self.beyond_ends(k, geared, t, x);
        match (self.path_ends[k], geared.ratio) {
            (0, None) => (-below.max(above), noise),
            // Held back at a limit it goes nowhere.
            (0, Some(_)) => {
                let rate = self.wanted_rate(k, t);
                (if rate < 0.0 { -below } else { -above }, noise)
            }
            (end, None) => (if end < 0 { below } else { above }, noise),
            (end, Some(_)) => (f64::from(end) * self.wanted_rate(k, t), 0.0),
        }
    }

    /// `ω_p − r ω_q`.
    fn path_slip(&self, geared: &Geared, ratio: f64) -> f64 {
        let [p, q] = geared.members.map(|m| self.member_speed(m));
        p - ratio * q
    }

    /// Writes the ratios that change at a rate, as they are at the start, into a state.
    pub(super) fn first_ratios(&self, x: &mut [f64]) {
        for path in &self.system.paths {
            if let PathKind::Geared(Geared { ratio: Some(i), .. }) = &path.kind
                && let ControlKind::Rate { initial, .. } = self.control(path)
            {
                x[self.integrals() + i] = *initial;
            }
        }
    }

    /// Variators whose ratio is known before the speeds are, at the start: members p and q, and r.
    pub(super) fn known_ratios(&self, t: f64, x: &[f64]) -> Vec<(usize, [MemberId; 2], f64)> {
        let known = |(k, path): (usize, &Path)| {
            let PathKind::Geared(geared) = &path.kind else { return None };
            let follows_speed = geared.ratio.is_none() && self.control(path).signal().depends_on_speed();
            (!follows_speed).then(|| {
                let [least, most] = geared.limits;
                (k, geared.members, self.wanted_ratio(path, geared, t, x).max(least).min(most))
            })
        };
        self.system.paths.iter().enumerate().filter_map(known).collect()
    }

    /// Takes over the ratios and torques of a state.
    pub fn look_at_paths(&mut self, t: f64, x: &[f64]) {
        for k in 0..self.system.paths.len() {
            let path = &self.system.paths[k];
            if let PathKind::Geared(geared) = &path.kind {
                let ratio = self.ratio(k, geared, t, x);
                let slip = self.path_slip(geared, ratio);
                let torque = geared.stiffness * x[self.integrals() + geared.slip] + geared.damping * slip;
                self.path_states[k] = PathState { ratio, torque };
            }
        }
    }

    /// Torques of the ports of variators at the state looked at, after those of the sources.
    pub(super) fn load_paths(&self, t: f64, tau: &mut [f64]) {
        for (k, path) in self.system.paths.iter().enumerate() {
            match &path.kind {
                PathKind::Geared(geared) => {
                    let PathState { ratio, torque } = self.path_states[k];
                    tau[geared.ports[0]] = -torque;
                    tau[geared.ports[1]] = ratio * torque;
                }
                PathKind::Pushed { members, ports, efficiency } => {
                    let [first, second] = members.map(|m| self.member_speed(m));
                    let torque = self.control(path).signal().value(t, self.inside, &|m| self.member_speed(m));
                    let power = -torque * first;
                    let passed = if power > 0.0 { power * efficiency[0] } else { power / efficiency[1] };
                    tau[ports[0]] = torque;
                    tau[ports[1]] = if power == 0.0 { 0.0 } else { passed / second };
                }
                PathKind::Bus { machines, store, standby } => {
                    let of_train = self.system.train.variators[path.variator].machines();
                    let Some((balances, port)) = machines.iter().enumerate().find_map(|(k, m)| match m.does {
                        MachineDoes::Balances(port) => Some((k, port)),
                        MachineDoes::Driven(_) => None,
                    }) else {
                        continue;
                    };
                    let given = self.given_store(path, store, t);
                    let taken: f64 = (machines.iter().zip(of_train))
                        .filter_map(|(m, of)| match m.does {
                            MachineDoes::Driven(source) => {
                                let torque = self.system.drivers[source].port.map_or(0.0, |p| tau[p]);
                                Some(from_bus(of, torque, self.member_speed(m.member)))
                            }
                            MachineDoes::Balances(_) => None,
                        })
                        .sum();
                    let speed = self.member_speed(machines[balances].member);
                    tau[port] = balancing(&of_train[balances], given - standby - taken, speed);
                }
            }
        }
    }

    /// The ratio that is another one than before, in words: it would take an infinite torque.
    pub(super) fn ratio_that_jumps(&self, before: &[f64]) -> Option<String> {
        let jumps = |(_, (was, now)): &(usize, (&f64, &PathState))| {
            (*was - now.ratio).abs() > 1e-9 * (was.abs() + now.ratio.abs())
        };
        let (k, (from, to)) = before.iter().zip(&self.path_states).enumerate().find(jumps)?;
        let name = &self.system.train.variators[self.system.paths[k].variator].name;
        Some(format!(
            "the ratio of {name} jumps from {} to {}, which takes an infinite torque; use a ramp",
            short(*from),
            short(to.ratio)
        ))
    }

    /// A variator that passes power to a member that stands still, in words.
    pub(super) fn path_without_lever(&self, t: f64) -> Option<String> {
        let mut tau = vec![0.0; self.tau.len()];
        for (k, driver) in self.system.drivers.iter().enumerate() {
            if let Some(port) = driver.port.filter(|_| driver.integral.is_none()) {
                tau[port] = self.source_torque(k, t, &[]);
            }
        }
        self.load_paths(t, &mut tau);
        let lost = |path: &&Path| path.ports().iter().any(|(_, port)| !tau[*port].is_finite());
        let path = self.system.paths.iter().find(lost)?;
        let (member, _) = path.ports().into_iter().find(|(_, port)| !tau[*port].is_finite())?;
        Some(format!(
            "`{}` has to pass power to `{}`, which stands still at t = {t} s: no torque does that; give its ratio, or a \
             machine that has a limit of torque",
            self.system.train.variators[path.variator].name,
            self.system.train.member_name(member)
        ))
    }

    /// What a variator loses at q while q slides in direction `sign`.
    pub(super) fn path_friction(&self, path: usize, sign: i8) -> f64 {
        let PathKind::Geared(geared) = &self.system.paths[path].kind else { unreachable!("it has a ratio") };
        let PathState { ratio, torque } = self.path_states[path];
        let lever = ratio * torque;
        let into_q = lever * f64::from(sign) > 0.0;
        -f64::from(sign)
            * lever.abs()
            * if into_q { 1.0 - geared.efficiency[0] } else { 1.0 / geared.efficiency[1] - 1.0 }
    }

    /// Rates of the states of variators at the state solved last.
    pub(super) fn path_rates(&self, t: f64, rate: &mut [f64]) {
        for (k, path) in self.system.paths.iter().enumerate() {
            let PathKind::Geared(geared) = &path.kind else { continue };
            rate[geared.slip] = self.path_slip(geared, self.path_states[k].ratio);
            if let Some(i) = geared.ratio {
                rate[i] = if self.path_ends[k] == 0 { self.wanted_rate(k, t) } else { 0.0 };
            }
        }
    }

    /// The sides of a variator with two members in the order of the train file, or its machines.
    pub(super) fn path_side(&self, k: usize, side: usize, t: f64) -> PathSide {
        let path = &self.system.paths[k];
        match &path.kind {
            PathKind::Geared(geared) => {
                let turned = self.system.train.variators[path.variator].members()[0] != geared.members[0];
                let at = if turned { 1 - side } else { side };
                let rubs = geared.friction.filter(|_| at == 1).map_or(0.0, |f| self.rubbing(f, t).torque);
                PathSide { speed: self.member_speed(geared.members[at]), torque: self.tau[geared.ports[at]] + rubs }
            }
            PathKind::Pushed { members, ports, .. } => {
                PathSide { speed: self.member_speed(members[side]), torque: self.tau[ports[side]] }
            }
            PathKind::Bus { machines, .. } => self.machine_side(&machines[side], t),
        }
    }

    fn machine_side(&self, machine: &BusMachine, t: f64) -> PathSide {
        let torque = match machine.does {
            MachineDoes::Driven(source) => self.applied_torque(source, t),
            MachineDoes::Balances(port) => self.tau[port],
        };
        PathSide { speed: self.member_speed(machine.member), torque }
    }

    /// What the store of a variator gives, and what the variator loses beside what rubs by its loss, W, at the state
    /// solved last.
    pub(super) fn path_powers(&self, k: usize, t: f64) -> [f64; 2] {
        let path = &self.system.paths[k];
        match &path.kind {
            PathKind::Geared(geared) => {
                let slip = self.path_slip(geared, self.path_states[k].ratio);
                [0.0, geared.damping * slip * slip]
            }
            PathKind::Pushed { .. } => {
                [0.0, -(0..2).map(|side| self.path_side(k, side, t)).map(|s| s.torque * s.speed).sum::<f64>()]
            }
            PathKind::Bus { machines, standby, .. } => {
                let (mut store, mut loss) = (*standby, *standby);
                for (m, of) in machines.iter().zip(self.system.train.variators[path.variator].machines()) {
                    let PathSide { speed, torque } = self.machine_side(m, t);
                    let taken = from_bus(of, torque, speed);
                    store += taken;
                    loss += taken - torque * speed;
                }
                [store, loss]
            }
        }
    }

    /// Whether the machine that balances a bus does not, as it is at its limit of torque: the store gives something else than
    /// it is to.
    fn falls_short(&self, k: usize, store: &GivenStore, t: f64) -> bool {
        let path = &self.system.paths[k];
        let PathKind::Bus { machines, .. } = &path.kind else { return false };
        let [wanted, gives] = [self.given_store(path, store, t), self.path_powers(k, t)[0]];
        let sides = machines.iter().map(|m| self.machine_side(m, t));
        let passed = sides.fold(wanted.abs(), |sum, s| sum + (s.torque * s.speed).abs());
        // Far more than rounding, and far less than anybody would miss.
        (gives - wanted).abs() > 1e-6 * passed
    }

    /// Notes which limits of variators the state solved last exceeds, where that is more than before, and machines that
    /// leave their maps.
    pub(super) fn note_limits(&mut self, t: f64, x: &[f64]) {
        let mut beyond = std::mem::take(&mut self.beyond);
        let mut note = |(limit, excess): (BeyondLimit, f64)| {
            let found = LimitExceeded { limit, time_s: t, excess };
            let same = |b: &&mut LimitExceeded| {
                let ([a, b], quantities) = ([&b.limit, &found.limit], b.limit.quantity == found.limit.quantity);
                quantities && a.variator == b.variator && a.machine == b.machine
            };
            match beyond.iter_mut().find(same) {
                Some(known) if known.excess < excess => *known = found,
                Some(_) => {}
                None => beyond.push(found),
            }
        };
        let mut left = std::mem::take(&mut self.left_maps);
        let mut fell = std::mem::take(&mut self.fell_short);
        for (k, path) in self.system.paths.iter().enumerate() {
            let v = &self.system.train.variators[path.variator];
            match &path.kind {
                PathKind::Geared(geared) => {
                    let wanted = self.wanted_ratio(path, geared, t, x);
                    let turned = v.members()[0] != geared.members[0];
                    ratio_beyond(v, if turned { 1.0 / wanted } else { wanted }).into_iter().for_each(&mut note);
                }
                PathKind::Pushed { .. } => {}
                PathKind::Bus { machines, store, .. } => {
                    for (m, of) in machines.iter().zip(v.machines()) {
                        let PathSide { speed, torque } = self.machine_side(m, t);
                        if matches!(m.does, MachineDoes::Balances(_))
                            && fell.iter().all(|(name, _)| *name != of.name)
                            && self.falls_short(k, store, t)
                        {
                            fell.push((of.name.clone(), t));
                        }
                        machine_beyond(v, of, torque, speed).for_each(&mut note);
                        if of.efficiency.at(torque, speed).1 && left.iter().all(|(name, _)| *name != of.name) {
                            left.push((of.name.clone(), t));
                        }
                    }
                }
            }
        }
        (self.beyond, self.left_maps, self.fell_short) = (beyond, left, fell);
    }

    /// Energy in what gives way in variators, J.
    pub(super) fn path_energy(&self, x: &[f64]) -> f64 {
        let of = |path: &Path| match &path.kind {
            PathKind::Geared(geared) => 0.5 * geared.stiffness * x[self.integrals() + geared.slip].powi(2),
            _ => 0.0,
        };
        self.system.paths.iter().map(of).sum()
    }

    /// The states of variators at the start, with which their torques agree with the accelerations that they cause, so
    /// that a run does not begin with a jolt.
    pub(super) fn settle_paths(&mut self, t: f64, x: &mut [f64], at_rest: &[bool]) {
        let integrals = self.integrals();
        if !self.system.paths.iter().any(|p| matches!(p.kind, PathKind::Geared(_))) {
            return;
        }
        let guess = self.mode.clone();
        for _ in 0..MOST_STARTS {
            let Ok(mode) = self.choose(t, x, at_rest, &guess) else { return };
            if !self.enter(&mode) {
                return;
            }
            self.solve(t, x);
            let mut change = 0.0;
            for k in 0..self.system.paths.len() {
                let path = &self.system.paths[k];
                let PathKind::Geared(geared) = &path.kind else { continue };
                let of = |m: MemberId| dot(self.row_of(m.index()), &self.acceleration);
                let [p, q] = geared.members.map(of);
                let PathState { ratio, torque } = self.path_states[k];
                let signal = self.control(path).signal();
                let rate = match geared.ratio {
                    _ if self.path_ends[k] != 0 => 0.0,
                    Some(_) => signal.value(t, self.inside, &|m| self.member_speed(m)),
                    None => signal.rate(t, self.inside, &|m| self.member_speed(m)),
                };
                let missing = geared.inertia * (p - ratio * q - rate * self.member_speed(geared.members[1]));
                if !missing.is_finite() {
                    return;
                }
                x[integrals + geared.slip] += missing / geared.stiffness;
                change = f64::max(change, missing.abs() / (torque.abs() + 1e-9));
            }
            if change <= 1e-10 {
                return;
            }
        }
    }
}
