//! Speeds and torques of a gear, without losses.
//!
//! The speeds of a gear are `v_X . q`, where q is the common zero of the closed elements with `v_in . q = 1`. Its torques
//! are the coefficients of `v_in + T_out v_out + sum T_e e = 0`: no motion of the open train does work (virtual work).

use willis::exact::Rational;

use super::layout::{GROUND, Layout, MAX_SHAFTS};
use super::motion::{MAX_MOBILITY, Motion};

type Square = [[f64; MAX_MOBILITY]; MAX_MOBILITY];

/// Solves a small linear system; none where it has no unique solution, its pivots being no larger than `zero`.
pub(super) fn solve<const N: usize>(size: usize, mut a: [[f64; N]; N], mut b: [f64; N], zero: f64) -> Option<[f64; N]> {
    for column in 0..size {
        let pivot = (column..size).max_by(|x, y| a[*x][column].abs().total_cmp(&a[*y][column].abs()))?;
        if a[pivot][column].abs() <= zero {
            return None;
        }
        a.swap(column, pivot);
        b.swap(column, pivot);
        for row in column + 1..size {
            let factor = a[row][column] / a[column][column];
            for c in column..size {
                a[row][c] -= factor * a[column][c];
            }
            b[row] -= factor * b[column];
        }
    }
    for row in (0..size).rev() {
        for c in row + 1..size {
            b[row] -= a[row][c] * b[c];
        }
        b[row] /= a[row][row];
    }
    Some(b)
}

/// The speeds of all shafts, and the largest modulus of a closed element's torque, per unit at the input.
pub(crate) fn speeds_and_torque(motion: &Motion, closed: &[[u8; 2]]) -> Option<([f64; MAX_SHAFTS], f64)> {
    let size = motion.mobility;
    // One scale for all, so that numbers stay near 1.
    let scale =
        (0..motion.shafts as u8).flat_map(|s| motion.shaft(s)).map(|x| x.unsigned_abs()).max().filter(|s| *s > 0)?
            as f64;
    let float = |v: &[i128]| -> [f64; MAX_MOBILITY] {
        let mut own = [0.0; MAX_MOBILITY];
        for (o, x) in own.iter_mut().zip(v) {
            *o = *x as f64 / scale;
        }
        own
    };
    let mut rows = [[0.0; MAX_MOBILITY]; MAX_MOBILITY];
    rows[0] = float(motion.shaft(0));
    for (row, pair) in rows[1..].iter_mut().zip(closed) {
        *row = float(&motion.element(*pair));
    }
    let mut one = [0.0; MAX_MOBILITY];
    one[0] = 1.0;
    let q = solve(size, rows, one, 0.0)?;
    let mut moving = [0.0; MAX_SHAFTS];
    for s in (0..motion.shafts).filter(|s| *s != usize::from(GROUND)) {
        moving[s] = float(motion.shaft(s as u8)).iter().zip(q).map(|(v, q)| v * q).sum();
    }
    let input = rows[0];
    rows[0] = float(motion.shaft(1));
    let columns: Square = std::array::from_fn(|i| std::array::from_fn(|j| rows[j][i]));
    let torques = solve(size, columns, input.map(|x| -x), 0.0)?;
    let torque = torques[1..size].iter().fold(0.0_f64, |m, t| m.max(t.abs()));
    Some((moving, torque))
}

/// The torques in a gear for torque 1 at the input, exactly: that of the output first, then those of the closed
/// elements, each as it acts on the first shaft of its pair. By elimination from the torques on the members of every
/// set (sun 1, ring k, carrier -(1 + k) times one unknown), with nothing taken from [`Motion`].
pub(crate) fn torques(layout: &Layout, ratios: &[Rational], closed: &[[u8; 2]]) -> Option<Vec<Rational>> {
    let (shafts, sets) = (layout.shafts(), layout.sets());
    let unknowns = sets + 1 + closed.len();
    // The balance of every shaft but the housing: unknowns, then the constant.
    let mut rows = vec![vec![Rational::ZERO; unknowns + 1]; shafts];
    for (set, (k, three)) in ratios.iter().zip(layout.blocks().chunks(3)).enumerate() {
        for (block, factor) in three.iter().zip([Rational::ONE, k.clone(), -(k + &Rational::ONE)]) {
            rows[usize::from(*block)][set] = factor;
        }
    }
    rows[1][sets] = Rational::ONE;
    for (e, [x, y]) in closed.iter().enumerate() {
        rows[usize::from(*x)][sets + 1 + e] = Rational::ONE;
        rows[usize::from(*y)][sets + 1 + e] = Rational::from(-1);
    }
    rows[0][unknowns] = Rational::from(-1);
    rows.remove(usize::from(GROUND));
    let mut done = 0;
    for column in 0..unknowns {
        let found = (done..rows.len()).find(|r| !rows[*r][column].is_zero())?;
        rows.swap(done, found);
        let scale = rows[done][column].recip();
        let pivot: Vec<Rational> = rows[done].iter().map(|x| x * &scale).collect();
        for (r, row) in rows.iter_mut().enumerate() {
            if r != done && !row[column].is_zero() {
                let factor = row[column].clone();
                for (x, p) in row.iter_mut().zip(&pivot) {
                    *x = &*x - &(&factor * p);
                }
            }
        }
        rows[done] = pivot;
        done += 1;
    }
    if rows[done..].iter().any(|row| !row[unknowns].is_zero()) {
        return None;
    }
    Some(rows[sets..unknowns].iter().map(|row| row[unknowns].clone()).collect())
}
