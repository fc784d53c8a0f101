//! Viscous damping, and what it makes of the vibrations.

use nalgebra::{Complex, DMatrix, DVector, Schur};

use crate::exact::Matrix;

use super::coordinates::Coordinates;
use super::normal::{Normal, Vibration};
use super::oscillator::Oscillator;
use super::rows::floats;

/// The dampers whose slip the coordinates settle.
pub(super) struct Damping<'t> {
    /// Their slips over the coordinates.
    rows: DMatrix<f64>,
    coefficients: Vec<f64>,
    /// Names of the others.
    pub left_out: Vec<&'t str>,
}

impl<'t> Damping<'t> {
    pub fn of(oscillator: &Oscillator<'t>, coordinates: &Coordinates) -> Self {
        let mut rows = Matrix::new();
        let (mut coefficients, mut left_out) = (Vec::new(), Vec::new());
        for damper in &oscillator.dampers {
            match coordinates.slip(damper.members) {
                Some(row) => {
                    rows.push(row);
                    coefficients.push(damper.coefficient);
                }
                None => left_out.push(damper.name),
            }
        }
        Self { rows: floats(&rows, coordinates.count()), coefficients, left_out }
    }

    pub fn is_empty(&self) -> bool {
        self.coefficients.is_empty()
    }

    /// The vibrations with damping; `rigid` is the basis of the motions without strain, which it couples them with.
    /// `None` if no eigenvalues are found.
    pub fn of_vibrations(
        &self,
        normal: &Normal<'_>,
        vibrations: &[Vibration],
        rigid: &[DVector<f64>],
    ) -> Option<Vec<Damped>> {
        let r = vibrations.len() + rigid.len();
        let mut shapes = DMatrix::zeros(r, r);
        let columns = vibrations.iter().map(|v| &v.shape).chain(rigid);
        columns.enumerate().for_each(|(k, u)| shapes.set_column(k, u));
        let mut rates = normal.over_shapes(&self.rows, shapes);
        rates.row_iter_mut().zip(&self.coefficients).for_each(|(mut row, c)| row *= c.sqrt());
        let frequencies: Vec<f64> = vibrations.iter().map(|v| v.frequency).collect();
        damp(&frequencies, &(rates.transpose() * &rates))
    }
}

/// What damping makes of a mode.
#[derive(Clone, Copy, Debug)]
pub(super) enum Damped {
    None,
    Vibrates { ratio: f64, frequency: f64 },
    Over(f64),
}

/// The vibrations with damping, for undamped frequencies and a damping matrix over the undamped
/// shapes (those at 0 Hz last). `None` if no eigenvalues are found.
fn damp(frequencies: &[f64], damping: &DMatrix<f64>) -> Option<Vec<Damped>> {
    let (elastic, all) = (frequencies.len(), damping.nrows());
    // Over (ω q, q'), which are of one size.
    let mut matrix = DMatrix::zeros(elastic + all, elastic + all);
    for (k, w) in frequencies.iter().enumerate() {
        matrix[(k, elastic + k)] = *w;
        matrix[(elastic + k, k)] = -w;
    }
    matrix.view_mut((elastic, elastic), (all, all)).copy_from(&-damping);
    let eigenvalues = Schur::try_new(matrix, f64::EPSILON, 10_000)?.complex_eigenvalues();
    let mut left: Vec<Complex<f64>> = eigenvalues.iter().copied().filter(|l| l.im > 1e-9 * l.norm()).collect();
    let ratio = |k: usize| damping[(k, k)] / (2.0 * frequencies[k]);
    // Each mode takes the eigenvalue nearest to its own without coupling, the nearest pair first.
    let mut damped: Vec<_> = (0..elastic).map(|k| Damped::Over(ratio(k).max(1.0))).collect();
    let mut open: Vec<usize> = (0..elastic).collect();
    while !left.is_empty() && !open.is_empty() {
        let distance = |k: usize, l: Complex<f64>| {
            let zeta = ratio(k);
            let own = Complex::new(-zeta, (1.0 - zeta * zeta).max(0.0).sqrt()) * frequencies[k];
            (l - own).norm() / frequencies[k]
        };
        let pairs = (0..open.len()).flat_map(|a| (0..left.len()).map(move |b| (a, b)));
        let near = |&(a, b): &(usize, usize)| distance(open[a], left[b]);
        let (a, b) = pairs.min_by(|p, q| near(p).total_cmp(&near(q)))?;
        let (k, l) = (open.remove(a), left.remove(b));
        // Without any damping of its own a mode keeps its eigenvalue but for round-off.
        damped[k] = if -l.re > 1e-13 * l.norm() {
            Damped::Vibrates { ratio: -l.re / l.norm(), frequency: l.im }
        } else {
            Damped::None
        };
    }
    Some(damped)
}
