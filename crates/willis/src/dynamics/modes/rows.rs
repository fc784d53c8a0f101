//! Rows over the coordinates, exact and rounded.

use nalgebra::DMatrix;

use crate::exact::{self, Matrix, Rational};

/// Rows over the coordinates.
pub(super) struct Rows {
    pub exact: Matrix,
    pub rounded: DMatrix<f64>,
}

impl Rows {
    pub fn new(exact: Matrix, columns: usize) -> Self {
        Self { rounded: floats(&exact, columns), exact }
    }
}

pub(super) fn floats(rows: &Matrix, columns: usize) -> DMatrix<f64> {
    DMatrix::from_fn(rows.len(), columns, |i, k| rows[i][k].to_f64())
}

/// Basis of the vectors that the rows take to zero.
pub(super) fn null_space(mut rows: Matrix, columns: usize) -> Matrix {
    let pivots = exact::reduce(&mut rows, columns);
    (0..columns)
        .filter(|k| !pivots.contains(k))
        .map(|free| {
            let mut vector = vec![Rational::ZERO; columns];
            vector[free] = Rational::ONE;
            for (row, &pivot) in rows.iter().zip(&pivots) {
                vector[pivot] = -row[free].clone();
            }
            vector
        })
        .collect()
}
