//! Variators of a train in a given motion. Their ratio is free, so they tie no speeds; but once the speeds are known, a
//! variator passes torques as a gear pair on the frame of that very ratio would.
//!
//! Between the members a and b it puts `f w_b` into a and `−f ρ w_a` into b: `a = w_b`, `b = −w_a` of an
//! [`Element`], with ρ from the efficiency of the direction in which power runs. A bus is a shaft of its own that turns at
//! one speed for all its machines; a machine is such a pair between its member and the bus, and the power of a store is a
//! torque on the bus. So the statics needs to know nothing of variators.
//!
//! At a mechanical point, one of the speeds zero, the torque behind it has no lever and no loss (ρ = 1). With all speeds
//! zero there is nothing left: the variator is left out, and [`Coupled::at_rest`] names it.

use crate::exact::Rational;
use crate::train::{FRAME, MemberId, VariatorPath};

use super::{Configuration, Element, Motion};

/// What an element behind the meshes stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Coupling {
    /// Position in [`Train::variators`](crate::train::Train::variators).
    pub variator: usize,
    /// Position of the machine, of a variator with a bus.
    pub machine: Option<usize>,
}

/// A configuration with its variators, and the motion with the speeds of their buses.
#[derive(Clone, Debug)]
pub(crate) struct Coupled<'t> {
    pub c: Configuration<'t>,
    pub motion: Motion,
    /// Variators of which all members stand still.
    pub at_rest: Vec<usize>,
    /// Whether some variator has a member whose speed is not known.
    pub open: bool,
}

impl<'t> Configuration<'t> {
    /// The configuration with its variators in a motion. Machines whose torque is prescribed, `driven`, are left to the
    /// loads.
    pub(crate) fn coupled(&self, motion: &Motion, driven: &[[usize; 2]]) -> Coupled<'t> {
        let (mut c, mut at_rest, mut open, mut buses) = (self.clone(), vec![], false, vec![]);
        for (variator, v) in self.train.variators.iter().enumerate() {
            let speeds: Option<Vec<Rational>> = v.members().iter().map(|m| motion.speeds[m.0].clone()).collect();
            let most = speeds.iter().flatten().map(Rational::abs).max().filter(|most| !most.is_zero());
            open |= speeds.is_none();
            if speeds.is_some() && most.is_none() {
                at_rest.push(variator);
            }
            let turning = speeds.zip(most);
            let add = |c: &mut Self, machine, [p, q]: [MemberId; 2], [a, b]: [Rational; 2], eta: [&Rational; 2]| {
                // What acts on a held member alone leans on what holds it.
                let lever = |m: MemberId, x: &Rational| c.node(m).is_some() && !x.is_zero();
                if !lever(p, &a) && !lever(q, &b) {
                    return;
                }
                let [forward, backward] = eta.map(Clone::clone);
                c.elements.push(Element { links: vec![], p, q, carrier: FRAME, a, b, forward, backward });
                c.couplings.push(Coupling { variator, machine });
            };
            match (&v.path, turning) {
                (VariatorPath::Direct { members, efficiency, .. }, Some((w, most))) => {
                    let pair = [&w[1] / &most, -(&w[0] / &most)];
                    add(&mut c, None, *members, pair, [&efficiency.forward, &efficiency.backward]);
                }
                (VariatorPath::Direct { .. }, None) => {}
                (VariatorPath::Bus { machines, .. }, turning) => {
                    let bus = MemberId(c.node_of.len());
                    c.node_of.push(Some(c.nodes));
                    c.inner.push(false);
                    (c.nodes, c.buses) = (c.nodes + 1, c.buses + 1);
                    buses.push(Some(turning.as_ref().map_or(Rational::ONE, |t| t.1.clone())));
                    let Some((w, most)) = turning else { continue };
                    for (k, machine) in machines.iter().enumerate().filter(|(k, _)| !driven.contains(&[variator, *k])) {
                        // The member drives where the machine generates.
                        let e = machine.efficiency.nominal();
                        let pair = [Rational::ONE, -(&w[k] / &most)];
                        add(&mut c, Some(k), [machine.member, bus], pair, [&e.backward, &e.forward]);
                    }
                }
            }
        }
        let mut motion = motion.clone();
        motion.speeds.extend(buses);
        Coupled { c, motion, at_rest, open }
    }

    /// The bus of a variator, as a member behind those of the train.
    pub(crate) fn bus(&self, variator: usize) -> MemberId {
        let before = self.train.variators[..variator].iter().filter(|v| v.has_bus()).count();
        MemberId(self.train.members.len() + before)
    }
}
