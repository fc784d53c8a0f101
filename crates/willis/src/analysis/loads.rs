//! The torques and powers of an operation, as the statics takes them.

use crate::exact::Rational;
use crate::kinematics::{Configuration, Motion, common};
use crate::power_flow::{Drag, External};
use crate::statics::{Equilibrium, Solution};
use crate::train::{Load, MemberId, Operation};
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
    /// Terminals that carry a torque, in order, with what is prescribed of it; none: whatever balances the train.
    pub terminals: Vec<(MemberId, Option<Rational>)>,
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
        let mut quantities: Vec<(MemberId, Quantity)> = Vec::new();
        for (member, load) in &operation.loads {
            match load {
                Load::Torque(q) => quantities.push((*member, q.clone())),
                Load::Power(p) => match &motion.speeds[member.0] {
                    Some(w) if w.is_zero() && !p.value.is_zero() => wrong.push(Refusal::PowerAtRest(*member, p.si())),
                    Some(w) if w.is_zero() => {
                        quantities.push((*member, Quantity { dimension: Dimension::TORQUE, ..p.clone() }));
                    }
                    Some(w) => quantities.push((
                        *member,
                        Quantity {
                            value: &p.value / w,
                            pi_power: p.pi_power - motion.pi_power,
                            dimension: Dimension::TORQUE,
                        },
                    )),
                    None => wrong.push(Refusal::PowerWithoutSpeed(*member)),
                },
            }
        }
        if !wrong.is_empty() {
            return Err(wrong);
        }
        let (values, pi_power) = common(quantities.iter().map(|(_, q)| q));
        let given: Vec<(MemberId, Rational)> = quantities.iter().map(|(m, _)| *m).zip(values).collect();

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
        for &terminal in &train.terminals {
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
        Ok(Self { given, pi_power, torques, open, loaded, terminals })
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
            External { member: x.0, torque: torque * self.scale(), power: sign * way }
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

    /// `n` loads are missing.
    pub fn missing(&self, c: &Configuration<'_>, n: usize) -> Vec<Refusal> {
        let open = self.balancing().collect();
        vec![Refusal::MissingLoads { freedoms: c.degrees_of_freedom(), open, more: n }]
    }

    /// There are `n` loads too many.
    pub fn too_many(&self, c: &Configuration<'_>, n: usize) -> Vec<Refusal> {
        let open = self.balancing().count();
        vec![Refusal::TooManyLoads { freedoms: c.degrees_of_freedom(), open, more: n }]
    }
}
