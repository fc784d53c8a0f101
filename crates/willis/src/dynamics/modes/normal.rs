//! Undamped motion in coordinates u in which the inertia is the unit matrix: vibrations, and motions without strain.

use nalgebra::{DMatrix, DVector, SVD};

use super::condensation::Condensed;
use super::coordinates::Felt;
use super::oscillator::Oscillator;

/// An undamped vibration.
pub(super) struct Vibration {
    /// ω, rad/s.
    pub frequency: f64,
    /// Its shape over u, of unit length.
    pub shape: DVector<f64>,
}

/// Coordinates in which the inertia is the unit matrix: a = L⁻ᵀ u.
pub(super) struct Normal<'c> {
    condensed: &'c Condensed,
    /// L of the inertia L Lᵀ over a.
    lower: DMatrix<f64>,
    to_u: DMatrix<f64>,
    /// Twist of each shaft over u, times the square root of its stiffness.
    pub strain: DMatrix<f64>,
}

impl<'c> Normal<'c> {
    /// `None` if the inertias differ too much.
    pub fn of(condensed: &'c Condensed, felt: &Felt, oscillator: &Oscillator<'_>) -> Option<Self> {
        let to_all = &condensed.to_all;
        let mut weighted = &felt.turns.rounded * to_all;
        weighted.row_iter_mut().zip(&oscillator.rotors).for_each(|(mut row, j)| row *= j.value.sqrt());
        let lower = (weighted.transpose() * weighted).cholesky()?.l();
        let r = to_all.ncols();
        let to_u = lower.transpose().solve_upper_triangular(&DMatrix::identity(r, r))?;
        let mut strain = &felt.twists.rounded * to_all * &to_u;
        strain.row_iter_mut().zip(&oscillator.springs).for_each(|(mut row, s)| row *= s.stiffness.sqrt());
        Some(Self { condensed, lower, to_u, strain })
    }

    /// The coordinates x of a motion u.
    pub fn coordinates(&self, u: &DVector<f64>) -> DVector<f64> {
        &self.condensed.to_all * (&self.to_u * u)
    }

    /// What rows over the coordinates x are for shapes over u.
    pub fn over_shapes(&self, rows: &DMatrix<f64>, shapes: DMatrix<f64>) -> DMatrix<f64> {
        rows * &self.condensed.to_all * &self.to_u * shapes
    }

    /// Orthonormal basis over u of motions x without strain.
    pub fn rigid_basis(&self, rigid: &[DVector<f64>]) -> Vec<DVector<f64>> {
        let mut basis: Vec<DVector<f64>> = Vec::new();
        for x in rigid {
            let mut u = self.lower.transpose() * (&self.condensed.inertial * x);
            u.normalize_mut();
            for _ in 0..2 {
                basis.iter().for_each(|b| u -= b * b.dot(&u));
                u.normalize_mut();
            }
            basis.push(u);
        }
        basis
    }

    /// The vibrations beside so many motions without strain, by rising frequency.
    pub fn vibrations(&self, rigid: usize) -> Vec<Vibration> {
        let elastic = self.to_u.ncols() - rigid;
        if elastic == 0 {
            return vec![];
        }
        // Singular values keep low frequencies beside high ones more exactly than eigenvalues of K do.
        let svd = SVD::new(self.strain.clone(), false, true);
        let rows = svd.v_t.as_ref().expect("asked for");
        let mut vibrations: Vec<Vibration> = (svd.singular_values.iter().zip(rows.row_iter()))
            .map(|(w, v)| Vibration { frequency: *w, shape: v.transpose() })
            .collect();
        vibrations.sort_by(|a, b| b.frequency.total_cmp(&a.frequency));
        vibrations.truncate(elastic);
        vibrations.reverse();
        vibrations
    }
}
