//! What is in contact at a state, as the problem that [`Decision`] decides.
//!
//! Contacts are the meshes, what holds or rubs at zero slip, and the speeds that are prescribed. What slides is a
//! torque among the loads. Each set of contacts has its own decision, which is kept: it knows its last mode, and
//! whether it is certain that there is one motion.

use std::collections::HashMap;

use crate::exact::Rational;

use super::bodies::Bodies;
use super::decision::{Decision, Element, Load, Problem};

/// Sets of contacts that are kept, at most: where losses follow speed or load, each state is a new one.
const MOST_KEPT: usize = 256;

/// What joins bodies at no relative speed, beside prescribed speeds.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) enum Joint {
    /// A friction element.
    Friction(usize),
    /// Friction of a mesh that does not follow its load.
    Teeth(usize),
}

/// A set of contacts.
#[derive(Clone, Default, PartialEq, Eq, Hash)]
pub(super) struct Set {
    /// The sign of the slip of each mesh element, and its efficiencies, bit by bit, where they vary.
    pub meshes: Vec<(i8, [u64; 2])>,
    /// Each joint, and whether it yields forward and backward.
    pub joints: Vec<(Joint, [bool; 2])>,
}

impl Set {
    fn problem(&self, bodies: &Bodies) -> Problem {
        let mut meshes = bodies.meshes.clone();
        for (mesh, (slip, bits)) in meshes.iter_mut().zip(&self.meshes) {
            mesh.slip = *slip;
            if *bits != [0; 2] {
                mesh.efficiency = bits.map(|b| Rational::from_f64(f64::from_bits(b)).unwrap_or(Rational::ONE));
            }
        }
        let joints = self.joints.iter().map(|&(joint, yields)| {
            let bodies = match joint {
                Joint::Friction(k) => bodies.frictions[k],
                // Behind what follows the load: at gear 2.
                Joint::Teeth(j) => [bodies.meshes[j].bodies[1], bodies.meshes[j].bodies[2]],
            };
            Element { bodies, yields }
        });
        let prescribed = bodies.prescribed.iter().map(|&b| Element { bodies: [b, None], yields: [false; 2] });
        let elements = joints.chain(prescribed).collect();
        Problem { members: bodies.count, inertias: bodies.inertias.clone(), meshes, elements }
    }
}

/// The decisions of a run, and room for the next.
#[derive(Clone, Default)]
pub(super) struct Contacts {
    known: HashMap<Set, Decision>,
    pub set: Set,
    pub load: Load,
    /// Force at gear 1 of each mesh as it was found last: on it the friction of teeth at rest may depend.
    pub forces: Vec<f64>,
    /// Whether that friction is the one of the forces that were found with it.
    pub agrees: bool,
    pub tau: Vec<f64>,
    /// Friction elements that have broken away: they oppose slip with what they do while they slide, not with their
    /// peak.
    pub broken: Vec<bool>,
}

impl Contacts {
    /// Asks the decision of the contacts that are set about the load that is set.
    pub fn ask<T>(&mut self, bodies: &Bodies, ask: impl FnOnce(&mut Decision, &Load) -> T) -> T {
        if self.known.len() >= MOST_KEPT && !self.known.contains_key(&self.set) {
            self.known.clear();
        }
        if !self.known.contains_key(&self.set) {
            self.known.insert(self.set.clone(), Decision::new(&self.set.problem(bodies)));
        }
        let decision = self.known.get_mut(&self.set).expect("just made");
        let answer = ask(decision, &self.load);
        self.forces.clear();
        self.forces.extend(decision.motion().meshes.iter().map(|mesh| mesh.forces[0].value));
        answer
    }

    /// The decision asked last.
    pub fn decision(&self) -> &Decision {
        &self.known[&self.set]
    }
}
