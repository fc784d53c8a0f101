//! The torques and powers of an operation, as the statics takes them.

use crate::exact::Rational;
use crate::kinematics::{Configuration, Motion, common, share_a_form};
use crate::power_flow::{Drag, Driven, External};
use crate::statics::{Equilibrium, Solution};
use crate::train::{Efficiency, Load, Machine, MachineEfficiency, MemberId, Operation, Store, Variator, VariatorPath};
use crate::units::{Dimension, Quantity};

use super::words::Refusal;

/// External torques as the statics takes them.
#[derive(Clone)]
pub(super) struct Loads {
    /// Prescribed torques by member, in units of `π^pi_power`.
    pub given: Vec<(MemberId, Rational)>,
    pub pi_power: i8,
    /// By node.
    pub torques: Vec<Rational>,
    /// Nodes whose torque is left to be found.
    pub open: Vec<usize>,
    /// Nodes whose torque may differ from zero.
    pub loaded: Vec<usize>,
    /// Machines whose torque is prescribed.
    pub driven: Vec<Driven>,
    /// Terminals that carry a torque, in order, with what is prescribed of it; none: whatever balances the train. A store
    /// is a torque on the bus of its variator.
    pub terminals: Vec<(MemberId, Option<Rational>)>,
    /// What is prescribed as a power, W: of terminals and of the buses of stores.
    pub powers: Vec<(MemberId, f64)>,
    /// Whether the torques are those that are prescribed, exactly: units that share no power of π, drags and maps make
    /// floating point of them.
    pub is_exact: bool,
}

impl Loads {
    /// The loads of an operation, and these drags.
    pub fn new(
        c: &Configuration<'_>,
        operation: &Operation,
        motion: &Motion,
        drags: &[Drag],
    ) -> Result<Self, Vec<Refusal>> {
        let train = c.train;
        let mut wrong = Vec::new();
        let torque = |member: MemberId, load: &Load| match load {
            Load::Torque(q) => Ok(q.clone()),
            Load::Power(p) => match &motion.speeds[member.0] {
                Some(w) if w.is_zero() && !p.value.is_zero() => Err(Refusal::PowerAtRest(member, p.si())),
                Some(w) if w.is_zero() => Ok(Quantity { dimension: Dimension::TORQUE, ..p.clone() }),
                Some(w) => Ok(Quantity {
                    value: &p.value / w,
                    pi_power: p.pi_power - motion.pi_power,
                    dimension: Dimension::TORQUE,
                }),
                None => Err(Refusal::PowerWithoutSpeed(member)),
            },
        };
        // Terminals first, then the stores on their buses, then machines.
        let (mut quantities, mut free): (Vec<(MemberId, Quantity)>, Vec<MemberId>) = (vec![], vec![]);
        let mut powers = Vec::new();
        for (member, load) in &operation.loads {
            powers.extend(load.power().map(|p| (*member, p.si())));
            match torque(*member, load) {
                Ok(q) => quantities.push((*member, q)),
                Err(refusal) => wrong.push(refusal),
            }
        }
        for (k, variator) in train.variators.iter().enumerate() {
            let VariatorPath::Bus { store, .. } = &variator.path else { continue };
            let own = operation.stores.iter().find(|(of, _)| *of == k).map_or(store, |(_, own)| own);
            match own {
                Store::Free => free.push(c.bus(k)),
                Store::Power(p) => match torque(c.bus(k), &Load::Power(p.clone())) {
                    Ok(q) => {
                        powers.push((c.bus(k), p.si()));
                        quantities.push((c.bus(k), q));
                    }
                    Err(refusal) => wrong.push(refusal),
                },
            }
        }
        let terminals_end = quantities.len();
        for (at, load) in &operation.machines {
            let member = train.variators[at[0]].machines()[at[1]].member;
            match torque(member, load) {
                Ok(q) => quantities.push((member, q)),
                Err(refusal) => wrong.push(refusal),
            }
        }
        if !wrong.is_empty() {
            return Err(wrong);
        }
        let (values, pi_power) = common(quantities.iter().map(|(_, q)| q));
        let mapped = |m: &Machine| matches!(m.efficiency, MachineEfficiency::Map(_));
        let is_exact = motion.is_exact
            && share_a_form(quantities.iter().map(|(_, q)| q))
            && drags.is_empty()
            && !train.variators.iter().flat_map(Variator::machines).any(mapped);
        let mut given: Vec<(MemberId, Rational)> = quantities.iter().map(|(m, _)| *m).zip(values).collect();
        let machines = given.split_off(terminals_end);

        let si = std::f64::consts::PI.powi(pi_power.into());
        let mut torques = vec![Rational::ZERO; c.nodes];
        let mut terminals = Vec::new();
        let mut loaded = Vec::new();
        for (member, torque) in &given {
            terminals.push((*member, Some(torque.clone())));
            if let Some(n) = c.node(*member) {
                torques[n] += torque.clone();
                if !torque.is_zero() && !loaded.contains(&n) {
                    loaded.push(n);
                }
            }
        }
        let mut driven = Vec::new();
        for ((at, load), (member, torque)) in operation.machines.iter().zip(machines) {
            let machine = &train.variators[at[0]].machines()[at[1]];
            let bus = c.bus(at[0]);
            let (w, bus_speed) = (&motion.speeds[member.0], &motion.speeds[bus.0]);
            let (Some(w), Some(bus_speed)) = (w, bus_speed) else { continue };
            let power = &torque * w;
            let eta = match &machine.efficiency {
                MachineEfficiency::Constant(e) => e.clone(),
                MachineEfficiency::Map(map) => {
                    let speed = motion.si(member).unwrap_or(0.0).abs();
                    let amount = torque.to_f64().abs() * si;
                    let (eta, _) = map.at(speed, if power.sign() < 0 { -amount } else { amount });
                    let eta = Rational::from_f64(eta).unwrap_or(Rational::ONE);
                    Efficiency { forward: eta.clone(), backward: eta }
                }
            };
            let draws = if power.sign() > 0 { &power / &eta.forward } else { &power * &eta.backward };
            for (member, torque) in [(member, torque.clone()), (bus, -(&draws / bus_speed))] {
                let Some(n) = c.node(member) else { continue };
                torques[n] += torque.clone();
                if !torque.is_zero() && !loaded.contains(&n) {
                    loaded.push(n);
                }
            }
            let scale = si * std::f64::consts::PI.powi(motion.pi_power.into());
            let power = load.power().map(Quantity::si);
            driven.push(Driven { at: *at, torque: torque.to_f64() * si, power, draws: draws.to_f64() * scale });
        }
        for drag in drags {
            for (member, torque) in [(drag.members[0], drag.torque), (drag.members[1], -drag.torque)] {
                let Some(n) = c.node(member) else { continue };
                let Some(t) = Rational::from_f64(torque / si) else {
                    wrong.push(Refusal::DragTooLarge(member));
                    continue;
                };
                torques[n] += t;
                if !loaded.contains(&n) {
                    loaded.push(n);
                }
            }
        }
        // Terminals on the frame's node carry only the reaction of their brake or hold.
        let mut open = Vec::new();
        for &terminal in train.terminals.iter().chain(&free) {
            let Some(n) = c.node(terminal) else { continue };
            if given.iter().any(|(m, _)| *m == terminal) || operation.fixed.contains(&terminal) {
                continue;
            }
            if open.contains(&n) {
                let same = |(m, torque): &&(MemberId, Option<Rational>)| torque.is_none() && c.node(*m) == Some(n);
                let other = terminals.iter().find(same).map_or(terminal, |(m, _)| *m);
                wrong.push(Refusal::Together([other, terminal]));
                continue;
            }
            open.push(n);
            terminals.push((terminal, None));
        }
        if !wrong.is_empty() {
            return Err(wrong);
        }
        Ok(Self { given, pi_power, torques, open, loaded, driven, terminals, powers, is_exact })
    }

    /// Terminals that were left to balance the train.
    pub fn balancing(&self) -> impl Iterator<Item = MemberId> {
        self.terminals.iter().filter(|(_, torque)| torque.is_none()).map(|(m, _)| *m)
    }

    /// What acts on each terminal in a solution, SI.
    pub fn acting(
        &self,
        c: &Configuration<'_>,
        motion: &Motion,
        equilibrium: &Equilibrium,
        solution: &Solution,
    ) -> Vec<External> {
        let torque = |(member, prescribed): &(MemberId, Option<Rational>)| match (prescribed, c.node(*member)) {
            (Some(torque), _) => (torque.to_f64(), torque.sign()),
            (None, Some(n)) => equilibrium.balancing_torque(c, solution, &self.torques, n),
            (None, None) => (0.0, 0),
        };
        let acts = |x: &(MemberId, Option<Rational>)| {
            let (torque, sign) = torque(x);
            let way = motion.speeds[x.0.0].as_ref().map_or(0, Rational::sign);
            let prescribed_power = self.powers.iter().find(|(m, _)| *m == x.0).map(|(_, p)| *p);
            External { member: x.0, torque: torque * self.scale(), prescribed_power, power: sign * way }
        };
        self.terminals.iter().map(acts).collect()
    }

    /// Whether all of those are at rest.
    pub fn rest(&self, motion: &Motion) -> bool {
        self.balancing().all(|m| motion.speeds[m.0].as_ref().is_some_and(Rational::is_zero))
    }

    /// Whether no torque acts.
    pub fn are_none(&self) -> bool {
        self.torques.iter().all(Rational::is_zero)
    }

    /// What turns the forces of a solution into SI.
    pub fn scale(&self) -> f64 {
        std::f64::consts::PI.powi(self.pi_power.into())
    }

    /// Variators that couple nothing.
    fn at_rest(&self, c: &Configuration<'_>) -> Vec<usize> {
        let acts =
            |k: &usize| c.couplings.iter().any(|own| own.variator == *k) || self.driven.iter().any(|d| d.at[0] == *k);
        (0..c.train.variators.len()).filter(|k| !acts(k)).collect()
    }

    /// `n` loads are missing.
    pub fn missing(&self, c: &Configuration<'_>, n: usize) -> Vec<Refusal> {
        let open = self.balancing().collect();
        vec![Refusal::MissingLoads {
            freedoms: c.degrees_of_freedom(),
            coupled: coupled(c),
            at_rest: self.at_rest(c),
            open,
            more: n,
        }]
    }

    /// There are `n` loads too many.
    pub fn too_many(&self, c: &Configuration<'_>, n: usize) -> Vec<Refusal> {
        let open = self.balancing().count();
        vec![Refusal::TooManyLoads {
            freedoms: c.degrees_of_freedom(),
            coupled: coupled(c),
            at_rest: self.at_rest(c),
            open,
            more: n,
        }]
    }
}

/// Torques of terminals that variators settle, beside those that the gears leave open.
fn coupled(c: &Configuration<'_>) -> usize {
    c.couplings.len().saturating_sub(c.buses)
}
