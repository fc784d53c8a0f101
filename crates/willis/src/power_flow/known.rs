//! Forces where it is known which end of each element drives: linear equations, in any kind of number.

use smallvec::{SmallVec, smallvec};

use crate::kinematics::{Configuration, Element, Node};
use crate::real::Real;
use crate::statics::SolvedColumn;
use crate::train::MeshId;

use super::{MeshFlow, walk};

/// Which ends drive, and which forces and torques are in question.
#[derive(Clone, Copy)]
pub(crate) struct Known<'a> {
    pub c: &'a Configuration<'a>,
    /// Node of each equation.
    pub rows: &'a [usize],
    pub columns: &'a [SolvedColumn],
}

impl Known<'_> {
    /// The equation in which a torque on a node stands.
    pub fn row(&self, node: Node) -> Option<usize> {
        let node = node?;
        self.rows.iter().position(|row| *row == node)
    }

    fn column(&self, element: usize) -> Option<&SolvedColumn> {
        self.columns.iter().find(|column| column.element == element)
    }

    /// Which end of an element drives; none at rest and where it carries nothing.
    pub fn p_drives(&self, element: usize) -> Option<bool> {
        self.column(element)?.p_drives
    }

    /// The force in each element. `entries` tells what one unit of force in a column's element asks of each row, `torques`
    /// what acts on nodes. None where the equations have no solution.
    pub fn forces<R: Real>(
        &self,
        entries: impl Fn(&SolvedColumn, &mut dyn FnMut(usize, R)),
        torques: impl Iterator<Item = (Node, R)>,
    ) -> Option<SmallVec<[R; 8]>> {
        let n = self.columns.len();
        let mut matrix: SmallVec<[R; 32]> = smallvec![R::from(0.0); n * (n + 1)];
        for (j, column) in self.columns.iter().enumerate() {
            entries(column, &mut |row, x| matrix[row * (n + 1) + j] += x);
        }
        for (node, torque) in torques {
            if let Some(row) = self.row(node) {
                matrix[row * (n + 1) + n] += torque;
            }
        }
        eliminate(&mut matrix, n)?;
        let mut forces: SmallVec<[R; 8]> = smallvec![R::from(0.0); self.c.elements.len()];
        for (row, column) in self.columns.iter().enumerate() {
            forces[column.element] = matrix[row * (n + 1) + n];
        }
        Some(forces)
    }

    /// Torques and powers of every mesh, by mesh, with these forces and efficiencies of the meshes (first gear driving, second
    /// gear driving); `p_drives` by element.
    pub fn meshes<R: Real>(
        &self,
        forces: &[R],
        speeds: &[R],
        efficiencies: &[[R; 2]],
        p_drives: impl Fn(usize) -> Option<bool>,
    ) -> Vec<MeshFlow<R>> {
        let own = |mesh: MeshId, forward: bool| efficiencies[mesh.index()][usize::from(!forward)];
        let mut meshes = Vec::with_capacity(self.c.train.meshes.len());
        for (k, element) in self.c.gears().iter().enumerate() {
            walk(self.c.train, element, forces[k], p_drives(k), speeds, &own, &mut meshes);
        }
        meshes.sort_by_key(|m: &MeshFlow<R>| m.mesh);
        meshes
    }
}

/// What of the torque on its first end a chain of meshes asks of its last one, over the same without losses.
pub(crate) fn rho<R: Real>(element: &Element, p_drives: Option<bool>, efficiencies: &[[R; 2]]) -> R {
    let along = |p_drives: bool| {
        element.links.iter().fold(R::from(1.0), |product, link| {
            product * efficiencies[link.mesh.index()][usize::from(p_drives != link.along)]
        })
    };
    match p_drives {
        None => R::from(1.0),
        Some(true) => along(true),
        Some(false) => along(false).recip(),
    }
}

/// Solves `n` linear equations, row by row with the right side behind each, which becomes the solution; pivots are chosen by
/// value.
fn eliminate<R: Real>(m: &mut [R], n: usize) -> Option<()> {
    let width = n + 1;
    for k in 0..n {
        let size = |row: usize| m[row * width + k].re().abs();
        let best = (k..n).max_by(|&a, &b| size(a).total_cmp(&size(b)))?;
        if size(best) == 0.0 {
            return None;
        }
        for j in k..width {
            m.swap(k * width + j, best * width + j);
        }
        let (above, below) = m.split_at_mut((k + 1) * width);
        let pivot = &above[k * width..];
        for row in below.chunks_exact_mut(width) {
            let factor = row[k] / pivot[k];
            // A derivative counts where the value vanishes.
            if R::NDERIV == 0 && factor.re() == 0.0 {
                continue;
            }
            for j in k..width {
                row[j] -= factor * pivot[j];
            }
        }
    }
    for k in (0..n).rev() {
        let known = (k + 1..n).fold(m[k * width + n], |sum, j| sum - m[k * width + j] * m[j * width + n]);
        m[k * width + n] = known / m[k * width + k];
    }
    Some(())
}
