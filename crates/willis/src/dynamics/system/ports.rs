//! Ports: the patterns of torque on the nodes that the equations of motion are linear in.

use nalgebra::{DMatrix, DVector};

use crate::kinematics::Configuration;
use crate::train::{FRAME, MemberId};

use super::coordinates::Coordinates;

/// Torques on members, as torques on the nodes; the frame takes any.
pub(super) fn on_nodes<const N: usize>(c: &Configuration<'_>, torques: [(MemberId, f64); N]) -> DVector<f64> {
    let mut column = DVector::zeros(c.nodes);
    for (member, x) in torques {
        if let Some(n) = c.node(member) {
            column[n] += x;
        }
    }
    column
}

/// Two members that act on each other.
pub(super) struct Between {
    pub members: [MemberId; 2],
    /// Slip of the first against the second over the coordinates.
    pub row: Vec<f64>,
    /// Port of a torque on the first, with its reaction on the second.
    pub port: usize,
}

/// The ports found so far, one column over the nodes each.
pub(super) struct Ports<'c> {
    configuration: &'c Configuration<'c>,
    coordinates: &'c Coordinates,
    columns: Vec<DVector<f64>>,
}

impl<'c> Ports<'c> {
    pub fn new(configuration: &'c Configuration<'c>, coordinates: &'c Coordinates) -> Self {
        Self { configuration, coordinates, columns: Vec::new() }
    }

    /// Adds a port; its position.
    pub fn add(&mut self, column: DVector<f64>) -> usize {
        self.columns.push(column);
        self.columns.len() - 1
    }

    /// A sum of ports, each with its part.
    pub fn sum(&self, parts: impl Iterator<Item = (usize, f64)>) -> DVector<f64> {
        let mut sum = DVector::zeros(self.configuration.nodes);
        parts.for_each(|(port, part)| sum.axpy(part, &self.columns[port], 1.0));
        sum
    }

    /// Adds that of a torque between two members.
    pub fn between(&mut self, members: [MemberId; 2]) -> Between {
        let [a, b] = members;
        let port = self.add(on_nodes(self.configuration, [(a, 1.0), (b, -1.0)]));
        Between { members, row: self.coordinates.slip(members), port }
    }

    /// Adds that of a torque on a member.
    pub fn on(&mut self, member: MemberId) -> usize {
        self.add(on_nodes(self.configuration, [(member, 1.0), (FRAME, -1.0)]))
    }

    /// Adds one without torque where there is none, so that rotors that nothing acts on are no special case.
    pub fn at_least_one(&mut self) {
        if self.columns.is_empty() {
            self.add(DVector::zeros(self.configuration.nodes));
        }
    }

    pub fn count(&self) -> usize {
        self.columns.len()
    }

    /// All columns: nodes × ports.
    pub fn matrix(&self) -> DMatrix<f64> {
        DMatrix::from_columns(&self.columns)
    }
}
