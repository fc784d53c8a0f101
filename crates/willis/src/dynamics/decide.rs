//! What happens at a state: its contacts and their loads, and the mode in which the motion found goes on.

use crate::exact::Rational;

use super::contacts::{Contacts, Joint};
use super::decision::{Amount, Body, Decision, Load, Motion, Verdict};
use super::element::Loss;
use super::engine::Engine;
use super::integrator::Smooth;
use super::mode::{Mode, Side};

/// A part of a long way: loads are derived by their change over it.
const SHORT: f64 = 1e-4;

/// Rounds, at most, in which what teeth at rest can hold is brought into agreement with what they carry.
const MOST_ROUNDS: usize = 100;

/// A constant friction that is the same whichever gear drives, and where the kink between the two is: force variable
/// and loss there.
pub(super) fn kink(loss: &Loss, factor: f64, sign: f64) -> [f64; 2] {
    let (spread, extra) = (loss.drive - loss.coast, loss.drive_torque - loss.coast_torque);
    if spread == 0.0 {
        return [0.0, sign * loss.drive_torque.max(loss.coast_torque)];
    }
    let torque = -sign * extra / spread;
    [torque / factor, loss.drive * torque + sign * loss.drive_torque]
}

/// What a mesh that begins to slip loses beside what it would lose without constant friction, if it carries this torque
/// along the slip: with that, which gear drives changes elsewhere.
pub(super) fn beside_load(loss: &Loss, torque: f64) -> f64 {
    let with = (loss.drive * torque + loss.drive_torque).max(loss.coast * torque + loss.coast_torque);
    with - (loss.drive * torque).max(loss.coast * torque)
}

impl Engine {
    /// The contacts of the present mode, and the loads on them, from the port torques found last.
    fn gather(&self, contacts: &mut Contacts, t: f64) {
        let s = &self.system;
        let Contacts { set, load, forces, tau, broken, .. } = contacts;
        forces.resize(s.elements.len(), 0.0);
        set.meshes.clear();
        set.joints.clear();
        load.torques.clear();
        load.torques.resize(s.bodies.count, [0.0; 2]);
        load.capacities.clear();
        load.accelerations.clear();
        load.slips.clear();
        tau.clear();
        tau.extend_from_slice(&self.tau[..s.port_of_prescribed]);
        for (k, f) in s.frictions.iter().enumerate() {
            let Some((g, _)) = f.group else { continue };
            if self.mode.slip[g] != 0 {
                continue;
            }
            let capacity = match (f.rigid && f.blocks.is_none(), self.engaged[k]) {
                (true, true) => [f64::INFINITY; 2],
                (true, false) => [0.0; 2],
                (false, _) => {
                    let peak = !broken.get(k).is_some_and(|broken| *broken);
                    [1, -1].map(|sign| self.sliding(k, 0.0, sign, peak, t).abs())
                }
            };
            if capacity != [0.0; 2] {
                set.joints.push((Joint::Friction(k), capacity.map(f64::is_finite)));
                load.capacities.push(capacity.map(|c| [if c.is_finite() { c } else { 0.0 }, 0.0]));
            }
        }
        for (j, e) in s.elements.iter().enumerate() {
            tau[e.port] = 0.0;
            let Some((g, _)) = e.group else {
                set.meshes.push((0, [0; 2]));
                continue;
            };
            let sign = self.mode.element_slip(s, j) * e.factors[0].signum() as i8;
            let rests = self.mode.slip[g] == 0;
            let loss = if rests && e.law.is_none() { self.loss_at(j, 0.0) } else { self.loss(j) };
            let bits = if e.varies() { [1.0 - loss.drive, 1.0 / (1.0 - loss.coast)].map(f64::to_bits) } else { [0; 2] };
            set.meshes.push((sign, bits));
            if loss.drive_torque == 0.0 && loss.coast_torque == 0.0 {
                continue;
            }
            if rests {
                // Forward and backward slip of gear 2.
                let factors = s.bodies.meshes[j].factors.each_ref().map(Rational::to_f64);
                let ratio = factors[1] / factors[0];
                let torque = forces[j] * e.factors[0];
                let against = |sign: f64| ratio.abs() * beside_load(&loss, sign * torque);
                set.joints.push((Joint::Teeth(j), [true; 2]));
                load.capacities.push([-ratio.signum(), ratio.signum()].map(|sign| [against(sign), 0.0]));
            } else {
                let [force, lost] = kink(&loss, e.factors[0], f64::from(self.mode.element_slip(s, j)));
                tau[e.port] = lost;
                s.add_force(j, -force, &mut load.torques);
            }
        }
        s.add_torques(tau, &mut load.torques);
        load.accelerations.resize(set.joints.len(), [0.0; 2]);
        for &a in &self.acceleration[s.free..] {
            load.capacities.push([[0.0; 2]; 2]);
            load.accelerations.push([a, 0.0]);
        }
    }

    /// Asks the decision of the contacts of the present mode, at the port torques found last; `rates`: the time after
    /// which loads are looked at once more, and the state then.
    fn ask_contacts<T>(&mut self, t: f64, rates: Option<(f64, &[f64])>, ask: impl Fn(&mut Decision, &Load) -> T) -> T {
        let mut contacts = std::mem::take(&mut self.contacts);
        self.gather(&mut contacts, t);
        let mut rounds = 0;
        let answer = loop {
            let capacities = contacts.load.capacities.clone();
            if let Some((later, x)) = rates {
                self.add_rates(&mut contacts, t, later, x);
            }
            let answer = contacts.ask(&self.system.bodies, &ask);
            // What teeth at rest can hold may depend on what they carry.
            self.gather(&mut contacts, t);
            let near = |a: &f64, b: &f64| (a - b).abs() <= 4.0 * f64::EPSILON * (a.abs() + b.abs());
            let before = capacities.iter().flatten().map(|of| &of[0]);
            let now = contacts.load.capacities.iter().flatten().map(|of| &of[0]);
            contacts.agrees = before.zip(now).all(|(a, b)| near(a, b));
            rounds += 1;
            if contacts.agrees || rounds == MOST_ROUNDS {
                break answer;
            }
        };
        self.contacts = contacts;
        answer
    }

    /// Rates of the loads, from those at a later state. What is within round-off is none.
    fn add_rates(&mut self, contacts: &mut Contacts, t: f64, later: f64, x: &[f64]) {
        let now = std::mem::take(&mut contacts.load);
        let set = contacts.set.clone();
        let (tau, speed, acceleration) = (self.tau.clone(), self.speed.clone(), self.acceleration.clone());
        let paths = self.path_states.clone();
        self.load(later, x);
        self.gather(contacts, later);
        (self.tau, self.speed, self.acceleration, self.path_states) = (tau, speed, acceleration, paths);
        let then = std::mem::replace(&mut contacts.load, now);
        if contacts.set.meshes.len() == set.meshes.len() && contacts.set.joints == set.joints {
            let rate = |a: f64, b: f64| {
                let change = b - a;
                if change.abs() <= 64.0 * f64::EPSILON * (a.abs() + b.abs()) { 0.0 } else { change / (later - t) }
            };
            let load = &mut contacts.load;
            load.torques.iter_mut().zip(&then.torques).for_each(|(a, b)| a[1] = rate(a[0], b[0]));
            load.accelerations.iter_mut().zip(&then.accelerations).for_each(|(a, b)| a[1] = rate(a[0], b[0]));
            for (a, b) in load.capacities.iter_mut().flatten().zip(then.capacities.iter().flatten()) {
                a[1] = rate(a[0], b[0]);
            }
        }
        contacts.set = set;
    }

    /// What happens at a state with these groups at rest, as `start` has the others.
    pub fn decide(&mut self, t: f64, x: &[f64], start: &Mode) -> (Verdict, Mode) {
        self.contacts.broken.clear();
        self.contacts.broken.resize(self.system.frictions.len(), false);
        let mut answer = self.decide_as_broken(t, x, start);
        // What breaks away falls from its peak to what it rubs with, which moves the forces of all the others; it may be
        // that more break away, never less.
        while matches!(answer.0, Verdict::One { .. }) && self.break_away() {
            answer = self.decide_as_broken(t, x, start);
        }
        self.contacts.broken.fill(false);
        answer
    }

    /// Notes what breaks away from a peak in the motion found last. False if that is nothing new.
    fn break_away(&mut self) -> bool {
        let contacts = &self.contacts;
        let slips = contacts.set.joints.iter().zip(&self.motion().elements);
        let new: Vec<usize> = slips
            .filter_map(|(&(joint, _), element)| match joint {
                Joint::Friction(k) if element.slip != 0 => Some(k),
                _ => None,
            })
            .filter(|&k| self.system.frictions[k].peak != 1.0 && !contacts.broken[k])
            .collect();
        new.iter().for_each(|&k| self.contacts.broken[k] = true);
        !new.is_empty()
    }

    fn decide_as_broken(&mut self, t: f64, x: &[f64], start: &Mode) -> (Verdict, Mode) {
        let mut mode = start.clone();
        let certified = self.certified;
        let mut verdict = Verdict::Undecided;
        // Losses under a law are those of the forces found.
        for _ in 0..8 {
            self.mode.clone_from(start);
            self.load(t, x);
            verdict = self.ask_contacts(t, None, |d, load| d.decide(load, certified));
            let mut found = self.mode_found(start);
            // Where something is at its limit, what comes next decides.
            let ahead = 2.0 * (self.inside - t);
            if matches!(verdict, Verdict::One { .. }) && ahead > 0.0 && self.enter(&found) {
                let step = ahead * SHORT;
                let mut rates = vec![0.0; x.len()];
                self.rate(t, x, &mut rates);
                if rates.iter().all(|r| r.is_finite()) {
                    let later: Vec<f64> = x.iter().zip(&rates).map(|(x, r)| x + step * r).collect();
                    self.mode.clone_from(start);
                    self.load(t, x);
                    verdict = self.ask_contacts(t, Some((t + step, &later)), |d, load| d.decide(load, certified));
                    found = self.mode_found(start);
                }
            }
            if !self.contacts.agrees {
                verdict = Verdict::Undecided;
            }
            let again = self.system.laws.is_some() && found != mode;
            mode = found;
            if !again || !matches!(verdict, Verdict::One { .. }) || !self.enter(&mode) {
                break;
            }
            self.solve(t, x);
        }
        (verdict, mode)
    }

    /// The mode in which the motion found last goes on.
    fn mode_found(&self, start: &Mode) -> Mode {
        let s = &self.system;
        let mut mode = start.clone();
        let contacts = &self.contacts;
        let motion = self.motion();
        let sign = |x: f64| x.signum() as i8;
        // What cannot hold slides, if only at no speed.
        let mut slips: Vec<Option<i8>> = vec![None; s.groups.len()];
        let mut note = |g: usize, slip: i8| {
            let known = slips[g].get_or_insert(0);
            if *known == 0 {
                *known = slip;
            }
        };
        for (&(joint, _), element) in contacts.set.joints.iter().zip(&motion.elements) {
            let (g, factor) = match joint {
                Joint::Friction(k) => s.frictions[k].group.expect("it rubs"),
                Joint::Teeth(j) => {
                    let (g, factor) = s.elements[j].group.expect("it rubs");
                    // Gear 2 turns as gear 1 does if their factors differ in sign.
                    let [z1, z2] = &s.bodies.meshes[j].factors;
                    (g, -factor * f64::from(z1.sign() * z2.sign()))
                }
            };
            note(g, element.slip * sign(factor));
        }
        for (j, e) in s.elements.iter().enumerate() {
            if let Some((g, factor)) = e.group
                && start.slip[g] == 0
            {
                note(g, motion.meshes[j].slip * sign(factor) * sign(e.factors[0]));
            }
        }
        for g in (0..s.groups.len()).filter(|&g| start.slip[g] == 0) {
            mode.slip[g] = slips[g].unwrap_or_else(|| if self.drift(g).sign() < 0 { -1 } else { 1 });
        }
        for (j, mesh) in motion.meshes.iter().enumerate() {
            if mode.element_slip(s, j) != 0 {
                mode.side[j] = if mesh.first_drives { Side::Drive } else { Side::Coast };
            }
        }
        mode
    }

    /// How fast a group that nothing holds begins to slip.
    fn drift(&self, g: usize) -> Amount {
        let s = &self.system;
        let &f = s.groups[g].frictions.first().expect("teeth hold");
        let (_, factor) = s.frictions[f].group.expect("of this group");
        let of = |b: Body| b.map_or(Amount::default(), |i| self.motion().accelerations[i]);
        let [a, b] = s.bodies.frictions[f].map(of);
        let along = factor.signum();
        Amount {
            value: along * (a.value - b.value),
            error: a.error + b.error,
            rate: along * (a.rate - b.rate),
            rate_error: a.rate_error + b.rate_error,
        }
    }

    fn motion(&self) -> &Motion {
        self.contacts.decision().motion()
    }

    /// The motions found last, of the coordinates, where there are two of them.
    pub fn two_motions(&self) -> [Vec<f64>; 2] {
        let decision = &self.contacts.decision();
        [decision.motion(), decision.second()].map(|m| {
            let of = |node: &Body| node.map_or(0.0, |i| m.accelerations[i].value);
            self.system.coordinate_bodies.iter().map(of).collect()
        })
    }

    /// Whether the present motion, at the state solved last, is the only one.
    pub fn is_single(&mut self, t: f64) -> bool {
        self.certified
            || self.ask_contacts(t, None, |d, load| {
                d.is_certified() || matches!(d.decide(load, false), Verdict::One { .. })
            })
    }

    /// How far what is held, at the state solved last, is from breaking away; where it does, less than 0: how fast,
    /// over the round-off of that.
    pub fn spare(&mut self, t: f64) -> f64 {
        let spare = self.ask_contacts(t, None, |d, load| d.spare(load));
        // What can hold nothing at this instant is no contact.
        let held = |g: usize| {
            let joints = &self.contacts.set.joints;
            joints.iter().any(|(joint, _)| matches!(joint, Joint::Friction(k) if self.system.frictions[*k].group.is_some_and(|(of, _)| of == g)))
        };
        (0..self.system.groups.len())
            .filter(|&g| self.mode.slip[g] == 0)
            .filter(|&g| !self.system.groups[g].driven && self.system.groups[g].elements.is_empty() && !held(g))
            .map(|g| self.drift(g))
            .map(|drift| drift.value.abs() / (drift.error + f64::MIN_POSITIVE))
            .filter(|drift| *drift > 1.0)
            .fold(spare, |spare, drift| spare.min(-drift))
    }
}
