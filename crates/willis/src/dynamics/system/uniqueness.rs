//! Whether a scenario leaves anything open.

use crate::dynamics::decision::{Element, Problem, is_unique};
use crate::exact::Rational;
use crate::train::LossRow;

use super::System;

/// Choices of directions and holds up to which a run asks for a certificate of all its states.
const MOST_CHOICES: usize = 1 << 15;

impl System {
    /// Whether every state has one motion, whatever the loads; none if there are too many
    /// states to look at. A mesh whose loss varies may lose anything up to its most: the determinants are affine in each
    /// loss, so the ends decide for everything between.
    pub fn every_state_is_unique(&self) -> Option<bool> {
        let mut problem =
            Problem { members: self.bodies.count, inertias: self.bodies.inertias.clone(), ..Problem::default() };
        for (mesh, e) in self.bodies.meshes.iter().zip(&self.elements) {
            let mut mesh = mesh.clone();
            mesh.slip = 0;
            if e.group.is_some() && (e.varies() || e.rows.len() > 1) {
                let least = |of: fn(&LossRow) -> f64| {
                    Rational::from_f64(e.rows.iter().map(of).fold(1.0, f64::min)).unwrap_or(Rational::ONE)
                };
                mesh.efficiency = [least(|r| r.forward), least(|r| r.backward)];
            }
            problem.meshes.push(mesh);
        }
        for (f, &bodies) in self.frictions.iter().zip(&self.bodies.frictions) {
            if f.group.is_some_and(|(g, _)| !self.groups[g].driven) {
                problem.elements.push(Element { bodies, yields: [true; 2] });
            }
        }
        problem
            .elements
            .extend(self.bodies.prescribed.iter().map(|&b| Element { bodies: [b, None], yields: [false; 2] }));
        is_unique(&problem, MOST_CHOICES)
    }
}
