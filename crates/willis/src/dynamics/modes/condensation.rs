//! Static condensation: what has no inertia follows the rest without delay.

use nalgebra::{DMatrix, DVector};

use crate::exact;

use super::coordinates::Felt;
use super::oscillator::Oscillator;
use super::rows::floats;

/// The coordinates x over as many coordinates a as feel inertia.
pub(super) struct Condensed {
    /// `x = T a`.
    pub to_all: DMatrix<f64>,
    /// `a` of a motion x.
    pub inertial: DMatrix<f64>,
    /// Positions of the coordinates that only follow.
    pub followers: Vec<usize>,
}

impl Condensed {
    /// `None` if the stiffnesses differ too much.
    pub fn of(felt: &Felt, oscillator: &Oscillator<'_>) -> Option<Self> {
        let n = felt.turns.rounded.ncols();
        let mut reduced = felt.turns.exact.clone();
        let pivots = exact::reduce(&mut reduced, n);
        reduced.truncate(pivots.len());
        let massless = exact::null_space(felt.turns.exact.clone(), n);
        let mut to_all = DMatrix::zeros(n, pivots.len());
        pivots.iter().enumerate().for_each(|(k, &p)| to_all[(p, k)] = 1.0);
        if !massless.is_empty() {
            let springs = &oscillator.springs;
            let stiffness = DVector::from_iterator(springs.len(), springs.iter().map(|s| s.stiffness));
            let k_rows = &felt.twists.rounded;
            let u = DMatrix::from_fn(n, massless.len(), |i, k| massless[k][i].to_f64());
            let own = k_rows * &u;
            let weighted = DMatrix::from_diagonal(&stiffness) * &own;
            let factor = (own.transpose() * &weighted).cholesky()?;
            let follow = factor.solve(&(weighted.transpose() * (k_rows * &to_all)));
            to_all -= u * follow;
        }
        let followers = (0..n).filter(|k| !pivots.contains(k)).collect();
        Some(Self { to_all, inertial: floats(&reduced, n), followers })
    }
}
