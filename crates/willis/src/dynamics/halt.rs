//! How speeds become exactly those of groups at rest, with the least change in kinetic energy.

use std::sync::OnceLock;

use nalgebra::{DMatrix, DVector};

use super::mode::{dot, dot_size};
use super::system::System;

/// The way to rest of certain groups.
#[derive(Debug)]
pub(super) struct Halt {
    /// Which groups are at rest, and which are then because those are: the last of several that stop together.
    pub given: Vec<bool>,
    pub at_rest: Vec<bool>,
    /// Those of them that are not driven.
    groups: Vec<usize>,
    /// Changes of the free speeds for impulses between them, and those impulses for slips; made when they are needed.
    matrices: OnceLock<Option<[DMatrix<f64>; 2]>>,
    /// Coordinates that are the slip of one of them: exactly zero.
    zero: Vec<usize>,
}

impl Halt {
    pub fn of(system: &System, given: &[bool]) -> Self {
        let at_rest = with_others(system, given);
        let free = system.free;
        let groups: Vec<usize> = (0..at_rest.len()).filter(|&g| at_rest[g] && !system.groups[g].driven).collect();
        let is_slip = |k: &usize| {
            groups.iter().any(|&g| system.groups[g].row.iter().enumerate().all(|(i, r)| (i == *k) == (*r != 0.0)))
        };
        let zero = (0..free).filter(is_slip).collect();
        Self { given: given.to_vec(), at_rest, groups, matrices: OnceLock::new(), zero }
    }

    fn matrices(system: &System, groups: &[usize]) -> Option<[DMatrix<f64>; 2]> {
        let d = DMatrix::from_fn(groups.len(), system.free, |i, k| system.groups[groups[i]].row[k]);
        let minv_dt = system.mass.clone().cholesky()?.solve(&d.transpose());
        let w = &d * &minv_dt;
        let least = 1e-12 * d.norm().max(1e-300).powi(2) / system.mass.norm();
        Some([minv_dt, w.pseudo_inverse(least).ok()?])
    }

    /// Changes the free speeds of a state; `speed` has those that are prescribed.
    pub fn apply(&self, system: &System, speed: &[f64], x: &mut [f64]) {
        let free = system.free;
        let parts = |g: usize| system.groups[g].row.split_at(free);
        for _ in 0..2 {
            let slip = self.groups.iter().map(|&g| dot(parts(g).0, &x[..free]) + dot(parts(g).1, &speed[free..]));
            let slip = DVector::from_iterator(self.groups.len(), slip);
            let size = |g: usize| dot_size(parts(g).0, &x[..free]) + dot_size(parts(g).1, &speed[free..]);
            // What is at rest already, as most of it is, stays as it is.
            if slip.iter().zip(&self.groups).all(|(slip, &g)| slip.abs() <= 4.0 * f64::EPSILON * size(g)) {
                break;
            }
            let matrices = self.matrices.get_or_init(|| Self::matrices(system, &self.groups));
            let Some([minv_dt, inverse]) = matrices else { return };
            let change = minv_dt * (inverse * slip);
            x.iter_mut().zip(&change).for_each(|(x, change)| *x -= change);
        }
        // What is left is round-off of a coordinate at rest.
        self.zero.iter().for_each(|&k| x[k] = 0.0);
    }
}

/// Adds the groups whose slip is zero because that of others is.
fn with_others(system: &System, given: &[bool]) -> Vec<bool> {
    let groups = &system.groups;
    let mut basis: Vec<Vec<f64>> = Vec::new();
    // What is left of a row beside those at rest; none if it is made of them.
    let beyond = |g: usize, basis: &[Vec<f64>]| -> Option<Vec<f64>> {
        let mut row = groups[g].row.clone();
        let size = dot(&row, &row).sqrt();
        for b in basis.iter().chain(basis) {
            let along = dot(&row, b);
            row.iter_mut().zip(b).for_each(|(x, y)| *x -= along * y);
        }
        let left = dot(&row, &row).sqrt();
        row.iter_mut().for_each(|x| *x /= left);
        (left > 1e-10 * size).then_some(row)
    };
    for g in (0..given.len()).filter(|&g| given[g]) {
        basis.extend(beyond(g, &basis));
    }
    (0..given.len()).map(|g| given[g] || beyond(g, &basis).is_none()).collect()
}
