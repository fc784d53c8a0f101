//! What is asked: members, what is between them, and the loads.

use crate::exact::Rational;

/// A member; none is the frame.
pub(in crate::dynamics) type Body = Option<usize>;

/// Inertia of a member, measured against another one or the frame.
#[derive(Clone, Debug)]
pub(in crate::dynamics) struct Inertia {
    pub member: usize,
    pub reference: Body,
    pub value: f64,
}

/// A gear mesh, or a chain of them that carries nothing else.
#[derive(Clone, Debug)]
pub(in crate::dynamics) struct Mesh {
    /// Gear 1, gear 2, carrier.
    pub bodies: [Body; 3],
    /// Factors of the Willis equation: the teeth, those of gear 2 negative if it is internal.
    pub factors: [Rational; 2],
    /// Efficiency if gear 1 drives, and if gear 2 does: above 0, at most 1.
    pub efficiency: [Rational; 2],
    /// Sign of the speed of gear 1 relative to the carrier, times its factor; 0: at rest.
    pub slip: i8,
}

/// What joins two members at no relative speed, by friction, freewheel or form.
#[derive(Clone, Debug)]
pub(in crate::dynamics) struct Element {
    pub bodies: [Body; 2],
    /// Whether the first may begin to turn forward of the second, and backward. Neither: a rigid hold, or a
    /// prescribed motion.
    pub yields: [bool; 2],
}

/// What does not change with the loads.
#[derive(Clone, Debug, Default)]
pub(in crate::dynamics) struct Problem {
    pub members: usize,
    pub inertias: Vec<Inertia>,
    pub meshes: Vec<Mesh>,
    pub elements: Vec<Element>,
}

impl Problem {
    /// The same without losses, and with all that touches held.
    pub fn ideal(&self) -> Self {
        let mut ideal = self.clone();
        ideal.meshes.iter_mut().for_each(|m| m.efficiency = [Rational::ONE; 2]);
        ideal.elements.iter_mut().for_each(|e| e.yields = [false; 2]);
        ideal
    }
}

/// What acts at an instant, and the rate of each: the rates decide where a force is just at its limit.
#[derive(Clone, Debug, Default)]
pub(in crate::dynamics) struct Load {
    /// On each member, with the torques of what slides.
    pub torques: Vec<[f64; 2]>,
    /// For each element, the torque with which it can oppose slip forward and backward; read where it yields.
    pub capacities: Vec<[[f64; 2]; 2]>,
    /// For each element, the relative acceleration that it prescribes; 0 where it only holds.
    pub accelerations: Vec<[f64; 2]>,
    /// For each mesh at rest, the acceleration of its slip, times the factor of gear 1, at which it counts as at rest; none:
    /// all at 0.
    pub slips: Vec<[f64; 2]>,
}
