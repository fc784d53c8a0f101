//! The mode of a step by the decision of all contacts together, where flipping one after another does not settle.
//!
//! A step asks the same as an instant does, of the speeds at its end: what slides there rubs against its slip, and
//! what would have to turn round to slide on is held. With the mean acceleration `a = (ω⁺ − ω)/h` as the unknown that is the
//! problem of [`Decision`](crate::dynamics::decision), in which a contact with the slip `s` prescribes `−s/h` where it
//! holds. Shafts that look ahead resist as an inertia between their ends does.

use crate::dynamics::contacts::{Contacts, Joint};
use crate::dynamics::decide::{beside_load, kink};
use crate::dynamics::decision::{Inertia, Verdict};
use crate::dynamics::mode::{Side, dot, dot_size};
use crate::exact::Rational;

use super::FixedStep;
use super::decided::Decided;
use super::groups::LEAST_UNBOUNDED;

/// Rounds, at most, in which contacts that turn round, shafts that touch and what breaks away are taken in.
const MOST_ROUNDS: usize = 64;

/// Sets of resisting shafts that are kept, at most.
const MOST_KEPT: usize = 64;

/// What a round found.
enum Round {
    /// A motion that agrees with all that was assumed.
    Agrees,
    /// Something was not as it was assumed: once more.
    Again,
    /// There is no motion, or it was not found.
    None(Verdict),
}

impl FixedStep {
    /// Decides the step. An error if there is no motion, or if it was not found.
    #[cold]
    pub(super) fn decide(&mut self) -> Result<(), Verdict> {
        self.is_decided = true;
        // Groups whose meshes may come to rest, and those that have broken away from their peak.
        let (mut stops, mut broken) = (0u64, 0u64);
        for (g, group) in self.groups.iter().enumerate() {
            let still = self.slip[g].abs() <= 1e-9 * dot_size(&group.row, &self.v);
            stops |= u64::from(still && !group.driven) << g;
        }
        for _ in 0..MOST_ROUNDS {
            match self.decide_once(&mut stops, &mut broken) {
                Round::Agrees => return Ok(()),
                Round::Again => {}
                Round::None(verdict) => return Err(verdict),
            }
        }
        Err(Verdict::Undecided)
    }

    fn decide_once(&mut self, stops: &mut u64, broken: &mut u64) -> Round {
        self.twist_shafts();
        let k = self.decided();
        let Decided { bodies, mut contacts, resists, mut before } = self.decided.swap_remove(k);
        let near = |[a, b]: [&f64; 2]| (a - b).abs() <= 4.0 * f64::EPSILON * (a.abs() + b.abs());
        let (mut found, mut agrees) = (None, false);
        // What teeth at rest can hold may depend on what they carry.
        for _ in 0..MOST_ROUNDS {
            before.clone_from(&contacts.load.capacities);
            self.gather(&mut contacts, *stops, *broken);
            let now = contacts.load.capacities.iter().flatten().flatten();
            agrees = found.is_some() && before.iter().flatten().flatten().zip(now).all(|(a, b)| near([a, b]));
            if agrees {
                break;
            }
            found = Some(contacts.ask(&bodies, |decision, load| decision.decide(load, false)));
            if !matches!(found, Some(Verdict::One { .. } | Verdict::Two)) {
                break;
            }
        }
        let round = match found {
            // Of two motions the first: steps of fixed length do not ask whether there is another.
            Some(Verdict::One { .. } | Verdict::Two) if agrees => self.take(&contacts, stops, broken),
            Some(none @ (Verdict::None | Verdict::Contradiction)) => Round::None(none),
            _ => Round::None(Verdict::Undecided),
        };
        self.decided.push(Decided { resists, bodies, contacts, before });
        round
    }

    /// The decisions for the present resistance of the shafts.
    fn decided(&mut self) -> usize {
        if let Some(k) = self.decided.iter().position(|d| d.resists == self.resists) {
            return k;
        }
        if self.decided.len() >= MOST_KEPT {
            self.decided.clear();
        }
        let s = &self.engine.system;
        let mut bodies = s.bodies.clone();
        for (e, &value) in s.elastic.iter().zip(&self.resists).filter(|(_, d)| **d != 0.0) {
            match e.bodies {
                [Some(member), reference] | [reference, Some(member)] => {
                    bodies.inertias.push(Inertia { member, reference, value });
                }
                [None, None] => {}
            }
        }
        let resists = self.resists.clone();
        self.decided.push(Decided { resists, bodies, contacts: Contacts::default(), before: vec![] });
        self.decided.len() - 1
    }

    /// The contacts of the step and the loads on them.
    fn gather(&mut self, contacts: &mut Contacts, stops: u64, broken: u64) {
        let s = &self.engine.system;
        let Contacts { set, load, forces, .. } = contacts;
        forces.resize(s.elements.len(), 0.0);
        set.meshes.clear();
        set.joints.clear();
        load.torques.clear();
        load.torques.resize(s.bodies.count, [0.0; 2]);
        load.capacities.clear();
        load.accelerations.clear();
        load.slips.clear();
        load.slips.resize(s.elements.len(), [0.0; 2]);
        // What a slip becomes in the step where it comes to rest.
        let offset = |g: usize| -> f64 {
            let group = &self.groups[g];
            let slip = dot(&group.row, &self.v);
            if slip.abs() <= 1e-14 * dot_size(&group.row, &self.v) { 0.0 } else { -slip / self.h }
        };
        for (g, group) in self.groups.iter().enumerate() {
            for rub in &group.rubs {
                self.tau[rub.port] = rub.viscous;
                let peak = if stops >> g & 1 == 1 && broken >> g & 1 == 0 { rub.peak } else { 1.0 };
                let [low, high] = rub.range(peak);
                let capacity = [-low, high];
                if capacity == [0.0; 2] || group.driven {
                    // What only prescribed speeds move rubs against them.
                    self.tau[rub.port] += match self.slip[g] * rub.factor {
                        slip if slip > 0.0 => low,
                        slip if slip < 0.0 => high,
                        _ => 0.0,
                    };
                    continue;
                }
                let yields = capacity.map(|c| c < LEAST_UNBOUNDED);
                set.joints.push((Joint::Friction(rub.friction), yields));
                load.capacities.push(capacity.map(|c| [if c < LEAST_UNBOUNDED { c } else { 0.0 }, 0.0]));
                load.accelerations.push([rub.factor * offset(g), 0.0]);
            }
        }
        for (j, e) in s.elements.iter().enumerate() {
            self.tau[e.port] = 0.0;
            let Some((g, factor)) = e.group else {
                set.meshes.push((0, [0; 2]));
                continue;
            };
            let (_, _, loss) = self.teeth[j];
            let rests = stops >> g & 1 == 1;
            let along = if rests { 0 } else { (self.slip[g] * factor).signum() as i8 };
            set.meshes.push((along * e.factors[0].signum() as i8, [0; 2]));
            load.slips[j] = [e.factors[0] * factor * offset(g), 0.0];
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
                load.accelerations.push([-factor * offset(g) / ratio, 0.0]);
            } else {
                let [force, lost] = kink(&loss, e.factors[0], f64::from(along));
                self.tau[e.port] = lost;
                s.add_force(j, -force, &mut load.torques);
            }
        }
        s.add_torques(&self.tau[..s.port_of_prescribed], &mut load.torques);
        for i in 0..s.prescribed {
            load.capacities.push([[0.0; 2]; 2]);
            load.accelerations.push([self.tau[s.port_of_prescribed + i], 0.0]);
        }
    }

    /// Takes over the motion found.
    fn take(&mut self, contacts: &Contacts, stops: &mut u64, broken: &mut u64) -> Round {
        let s = &self.engine.system;
        let motion = contacts.decision().motion();
        for (k, body) in s.coordinate_bodies[..s.free].iter().enumerate() {
            self.next[k] = self.v[k] + self.h * body.map_or(0.0, |b| motion.accelerations[b].value);
        }
        // Where a contact held that was at its peak, what breaks away falls from it.
        let mut again = false;
        let mut slides = 0u64;
        for (&(joint, _), element) in contacts.set.joints.iter().zip(&motion.elements) {
            let (g, peak) = match joint {
                Joint::Friction(k) => (s.frictions[k].group.expect("it rubs").0, s.frictions[k].peak),
                Joint::Teeth(j) => (s.elements[j].group.expect("it rubs").0, 1.0),
            };
            if element.slip != 0 {
                slides |= 1 << g;
                if peak != 1.0 && *stops >> g & 1 == 1 && *broken >> g & 1 == 0 {
                    *broken |= 1 << g;
                    again = true;
                }
            }
        }
        for (j, mesh) in motion.meshes.iter().enumerate() {
            if let Some((g, _)) = s.elements[j].group
                && *stops >> g & 1 == 1
                && mesh.slip != 0
            {
                slides |= 1 << g;
            }
        }
        for (g, group) in self.groups.iter().enumerate() {
            let end = dot(&group.row, &self.next);
            let joined = group.rubs.iter().any(|rub| rub.opposes != [0.0; 2]);
            let rests =
                !group.driven && slides >> g & 1 == 0 && (*stops >> g & 1 == 1 && !group.elements.is_empty() || joined);
            self.sign[g] = match end {
                _ if rests => 0,
                end if end < 0.0 => -1,
                _ => 1,
            };
            // Teeth that were taken to go on the way they went.
            let turns = end * self.slip[g] < 0.0 && end.abs() > self.round_off(g);
            if !group.elements.is_empty() && *stops >> g & 1 == 0 && (rests || turns) && !group.driven {
                *stops |= 1 << g;
                again = true;
            }
        }
        if again {
            return Round::Again;
        }
        if let Some((k, touch)) = self.turned() {
            self.shafts[k].turn(touch);
            return Round::Again;
        }
        // Forces, for the count of energies.
        let s = &self.engine.system;
        for (j, (e, mesh)) in s.elements.iter().zip(&motion.meshes).enumerate() {
            let [f, back] = mesh.forces;
            self.losses[j] = e.factors[0] * (f.value - back.value) + self.tau[e.port];
            self.side[j] = if mesh.first_drives { Side::Drive } else { Side::Coast };
        }
        for (&(joint, _), element) in contacts.set.joints.iter().zip(&motion.elements) {
            match joint {
                Joint::Friction(k) => self.tau[s.frictions[k].port] += element.torque.value,
                Joint::Teeth(j) => {
                    let [first, second] = s.bodies.meshes[j].factors.each_ref().map(Rational::to_f64);
                    self.losses[j] += element.torque.value * first / second;
                }
            }
        }
        for (reaction, element) in self.reactions.iter_mut().zip(&motion.elements[contacts.set.joints.len()..]) {
            *reaction = element.torque.value;
        }
        Round::Agrees
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::train::{MemberKind, Train};

    /// The automatics of the examples, with inertias and elements of a capacity, or rigid ones, through all their gears.
    fn through_the_gears(text: &str, capacity: &str) -> Train {
        let bare = Train::from_toml(text).expect("an example");
        let own = |m: &&crate::train::Member| m.kind != MemberKind::Planet && m.name != "frame";
        let members = bare.members().iter().filter(own);
        let inertias: Vec<String> = members.map(|m| format!("{} = \"0.03 kg m^2\"", m.name)).collect();
        let gears: Vec<String> = (bare.states().iter().enumerate())
            .map(|(k, state)| format!("[\"{} s\", {:?}]", 0.2 * k as f64, state.name))
            .collect();
        let name = |m: Option<crate::train::MemberId>| bare.member_name(m.expect("an automatic")).to_owned();
        let (input, output) = (name(bare.input()), name(bare.output()));
        let text = text
            .replacen("[[set]]", &format!("[inertias]\n{}\n\n[[set]]", inertias.join("\n")), 1)
            .replace("kind = \"brake\"", &format!("kind = \"brake\"\n{capacity}"))
            .replace("kind = \"clutch\"", &format!("kind = \"clutch\"\n{capacity}"));
        let scenario = format!(
            "\n[[scenario]]\nname = \"run\"\nduration = \"{} s\"\ngears = [{}]\nshift_time = \"0.1 s\"\n\
             [[scenario.source]]\nname = \"engine\"\nmember = {input:?}\n\
             torque = {{ type = \"sine\", offset = \"20 N m\", amplitude = \"150 N m\", frequency = \"4 Hz\" }}\n\
             [[scenario.source]]\nname = \"road\"\nmember = {output:?}\nquadratic = {{ torque = \"-20 N m\", factor = \"0.02 N m s^2/rad^2\" }}\n",
            0.2 * gears.len() as f64,
            gears.join(", "),
        );
        Train::from_toml(&(text + &scenario)).unwrap_or_else(|e| panic!("{e}"))
    }

    /// Where flipping one contact after another settles, the decision of all together finds the same end of the step.
    #[test]
    fn a_step_that_settles_is_decided_alike() {
        let examples = [
            include_str!("examples/zf-8hp70.toml"),
            include_str!("examples/simpson-ford-c4.toml"),
            include_str!("examples/zf-6hp26.toml"),
        ];
        let (mut steps, mut settled) = (0, 0);
        for train in examples.map(|text| through_the_gears(text, "capacity = \"900 N m\"")) {
            let mut run = FixedStep::new(&train, "run", 1e-3).expect("a run");
            for _ in 0..run.steps() {
                let mut other = run.clone();
                run.step();
                assert_eq!(run.verdict, None);
                steps += 1;
                if run.is_decided {
                    continue;
                }
                settled += 1;
                let middle = other.middle();
                if other.is_over(middle) {
                    other.refresh(middle);
                }
                other.load(middle);
                other.decide().expect("a motion");
                let size = dot(&run.v, &run.v).sqrt() + 1e-3;
                for (k, (settled, decided)) in run.v.iter().zip(&other.next).enumerate() {
                    assert!((settled - decided).abs() < 1e-9 * size, "step {steps}, {k}: {settled} and {decided}");
                }
                for (g, signs) in run.sign.iter().zip(&other.sign).enumerate() {
                    // What has no friction has no mode.
                    let rubs = run.capacity[g] != [0.0; 2] || !run.groups[g].elements.is_empty();
                    let slides = rubs && dot(&run.groups[g].row, &run.v).abs() > 1e-9 * size;
                    assert!(!slides || signs.0 == signs.1, "step {steps}: {signs:?}");
                }
            }
        }
        assert!(settled < steps, "some are decided at once");
    }
}
