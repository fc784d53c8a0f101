//! Rows over the coordinates, exact and rounded.

use nalgebra::DMatrix;

use crate::exact::Matrix;

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
