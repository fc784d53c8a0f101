//! Rigid shafts on equally stiff bearings: what each bearing carries of the loads on all shafts.
//!
//! Where bearings hold a shaft in one way only (two along its length, one that locates it) the stiffness drops out, and
//! this is plain equilibrium. Where there are more, equal stiffness is the assumption.

use smallvec::SmallVec;

use crate::real::Real;

/// A pivot below this part of its own diagonal is none: nothing holds that movement.
const HELD: f64 = 1e-9;

/// Symmetric springs between movements, factored as `L D Lᵀ`. A movement that no spring holds stays at zero; what loads
/// it is carried by something else.
#[derive(Clone, Debug)]
pub(super) struct Springs<R> {
    matrix: Vec<Vec<R>>,
    /// Below the diagonal the factors, on it the pivots.
    factors: Vec<Vec<R>>,
    held: Vec<bool>,
}

impl<R: Real> Springs<R> {
    pub fn new(matrix: Vec<Vec<R>>) -> Self {
        let n = matrix.len();
        let mut a = matrix.clone();
        let mut held = vec![true; n];
        // Where each row begins: what is left of it stays empty. Exact zeros may carry derivatives.
        let empty = |x: &R| *x == R::from(0.0);
        let begin: Vec<usize> = (0..n).map(|k| matrix[k].iter().position(|x| !empty(x)).unwrap_or(k).min(k)).collect();
        for i in 0..n {
            held[i] = a[i][i].re() > HELD * matrix[i][i].re();
            let pivot = a[i][i];
            for k in i + 1..n {
                if !held[i] || i < begin[k] {
                    a[k][i] = R::from(0.0);
                    continue;
                }
                let factor = a[k][i] / pivot;
                for j in i + 1..=k {
                    // Symmetric: the entry of the column stands in the row.
                    let of_row = if j == k { a[k][i] } else { a[j][i] * pivot };
                    a[k][j] -= factor * of_row;
                }
                a[k][i] = factor;
            }
        }
        Self { matrix, factors: a, held }
    }

    /// Movements under loads.
    pub fn solve(&self, loads: &[R]) -> SmallVec<[R; 8]> {
        let (n, none) = (loads.len(), R::from(0.0));
        let mut x: SmallVec<[R; 8]> = loads.iter().copied().collect();
        for i in 0..n {
            if !self.held[i] {
                x[i] = none;
                continue;
            }
            for j in 0..i {
                x[i] = x[i] - self.factors[i][j] * x[j];
            }
        }
        for i in (0..n).rev().filter(|i| self.held[*i]) {
            x[i] /= self.factors[i][i];
            for k in i + 1..n {
                x[i] = x[i] - self.factors[k][i] * x[k];
            }
        }
        x
    }

    /// What the springs do not carry of loads under which they have moved so.
    pub fn rest(&self, i: usize, loads: &[R], moved: &[R]) -> R {
        if self.held[i] {
            return R::from(0.0);
        }
        self.matrix[i].iter().zip(moved).fold(loads[i], |rest, (k, x)| rest - *k * *x)
    }
}

#[cfg(test)]
mod tests {
    use super::Springs;

    /// Two shafts, one in the other, one on the frame; the third floats.
    #[test]
    fn what_is_not_held_is_carried_elsewhere() {
        let springs = Springs::new(vec![vec![3.0, -1.0, 0.0], vec![-1.0, 1.0, 0.0], vec![0.0, 0.0, 0.0]]);
        let loads = [1.0, 2.0, 5.0];
        let x = springs.solve(&loads);
        assert!((x[0] - 1.5).abs() < 1e-12 && (x[1] - 3.5).abs() < 1e-12 && x[2] == 0.0, "{x:?}");
        assert_eq!([0, 1, 2].map(|i| springs.rest(i, &loads, &x)), [0.0, 0.0, 5.0]);
        // Two that hold each other, and nothing holds both: the last one stands still.
        let loose = Springs::new(vec![vec![1.0, -1.0], vec![-1.0, 1.0]]);
        let x = loose.solve(&[4.0, 1.0]);
        assert_eq!((x[0], x[1], loose.rest(1, &[4.0, 1.0], &x)), (4.0, 0.0, 5.0));
    }

    #[test]
    fn many_springs_at_random_are_in_equilibrium() {
        let mut seed = 1u64;
        let mut next = || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 11) as f64 / (1u64 << 53) as f64
        };
        for n in 1..9 {
            let mut k = vec![vec![0.0; n]; n];
            for _ in 0..2 * n {
                let v: Vec<f64> = (0..n).map(|_| if next() < 0.5 { 0.0 } else { next() - 0.5 }).collect();
                for i in 0..n {
                    for j in 0..n {
                        k[i][j] += v[i] * v[j];
                    }
                }
            }
            let loads: Vec<f64> = (0..n).map(|_| next()).collect();
            let springs = Springs::new(k.clone());
            let x = springs.solve(&loads);
            for i in 0..n {
                let carried: f64 = k[i].iter().zip(&x).map(|(k, x)| k * x).sum();
                let rest = springs.rest(i, &loads, &x);
                assert!((carried + rest - loads[i]).abs() < 1e-7, "{n} {i}: {carried} {rest} {}", loads[i]);
            }
        }
    }
}
