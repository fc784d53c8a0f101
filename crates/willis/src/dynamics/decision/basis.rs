//! A basis: its inverse, solutions with bounds of their rounding errors, and exact signs.
//!
//! The bound of each component is its own: |B⁻¹| times what the solution leaves over in the equations, which are kept
//! as they were given. So neither the largest torque nor how the inverse came about is in it.

use std::ops::Range;

use crate::exact::Rational;
use crate::exact::residue::{PRIME, power, times};

use super::equations::{Equations, exact_solution};
use super::motion::{Amount, Motion};

/// Half a unit in the last place of one.
const ROUNDING: f64 = f64::EPSILON;

/// Numbers with bounds of their errors.
#[derive(Clone, Debug, Default)]
pub(super) struct Vector {
    pub value: Vec<f64>,
    pub error: Vec<f64>,
}

impl Vector {
    pub fn new(n: usize) -> Self {
        Self { value: vec![0.0; n], error: vec![0.0; n] }
    }

    /// Sign as far as the bound tells; 0 if it does not.
    pub fn sign(&self, i: usize) -> i8 {
        let (x, error) = (self.value[i], self.error[i]);
        if x > error { 1 } else { -i8::from(x < -error) }
    }
}

/// More rows are cleared first down, then up.
const LONG: usize = 64;

/// From the first entry of a row that is not zero to the last.
fn span(row: &[f64]) -> Range<usize> {
    let is_met = |x: &f64| *x != 0.0;
    let first = row.iter().position(is_met).unwrap_or(row.len());
    first..row.iter().rposition(is_met).map_or(first, |last| last + 1)
}

/// Takes row `c` from the `rows` of a matrix and its inverse, as often as clears column `c`, where row `c` has a one.
fn take_from(rows: Range<usize>, c: usize, matrix: &mut [f64], inverse: &mut [f64], n: usize) {
    let spans = [&*matrix, &*inverse].map(|m| span(&m[c * n..(c + 1) * n]));
    for r in rows.filter(|&r| r != c) {
        let factor = matrix[r * n + c];
        if factor == 0.0 {
            continue;
        }
        for (m, span) in [&mut *matrix, &mut *inverse].into_iter().zip(&spans) {
            let (head, tail) = m.split_at_mut(r.max(c) * n);
            let (row, top) = if r < c { (&mut head[r * n..], &tail[..n]) } else { (&mut tail[..n], &head[c * n..]) };
            row[span.clone()].iter_mut().zip(&top[span.clone()]).for_each(|(x, y)| *x -= factor * y);
        }
    }
}

/// As many columns as there are rows, and their inverse.
#[derive(Clone, Debug)]
pub(super) struct Basis {
    n: usize,
    /// The unknown at each position, and the position of each unknown.
    columns: Vec<usize>,
    positions: Vec<Option<usize>>,
    /// By columns: what is added to a component waits for nothing but its own last sum.
    inverse: Vec<f64>,
    /// The same modulo the prime, once it was asked for.
    residues: Vec<u64>,
    residues_known: bool,
    /// Whether there is an inverse.
    regular: bool,
    left: Vec<f64>,
    change: Vec<f64>,
    bound: Vec<f64>,
    modular: Vec<u64>,
    right: Vec<f64>,
    wide: Vec<f64>,
}

impl Basis {
    pub fn new(equations: &Equations) -> Self {
        let n = equations.rows;
        Self {
            n,
            columns: Vec::with_capacity(n),
            positions: vec![None; equations.columns.len()],
            inverse: vec![0.0; n * n],
            residues: vec![0; n * n],
            residues_known: false,
            regular: false,
            left: vec![0.0; n],
            change: vec![0.0; n],
            bound: vec![0.0; n],
            modular: vec![0; n],
            right: vec![0.0; n],
            wide: vec![0.0; n * n],
        }
    }

    /// Whether there is one.
    pub fn is_known(&self) -> bool {
        self.regular
    }

    pub fn forget(&mut self) {
        self.regular = false;
    }

    pub fn columns(&self) -> &[usize] {
        &self.columns
    }

    pub fn position(&self, unknown: usize) -> Option<usize> {
        self.positions[unknown]
    }

    /// Takes these columns. False if they have no inverse.
    pub fn set(&mut self, equations: &Equations, columns: impl Iterator<Item = usize>) -> bool {
        self.columns.clear();
        self.columns.extend(columns);
        self.positions.fill(None);
        for (i, &j) in self.columns.iter().enumerate() {
            self.positions[j] = Some(i);
        }
        self.regular = self.columns.len() == self.n && self.invert(equations);
        self.residues_known = false;
        self.regular
    }

    /// The inverse, by elimination with row pivots.
    fn invert(&mut self, equations: &Equations) -> bool {
        let n = self.n;
        self.wide.fill(0.0);
        self.inverse.fill(0.0);
        for (i, &j) in self.columns.iter().enumerate() {
            for e in &equations.columns[j] {
                self.wide[e.row * n + i] = e.value;
            }
        }
        let (b, inv) = (&mut self.wide, &mut self.inverse);
        // By rows, until it is done.
        (0..n).for_each(|i| inv[i * n + i] = 1.0);
        let is_long = n > LONG;
        for c in 0..n {
            let pivot = (c..n).max_by(|&p, &q| b[p * n + c].abs().total_cmp(&b[q * n + c].abs())).expect("not empty");
            let value = b[pivot * n + c];
            // Scaled entries are about one: what is far below is round-off of zero, or so close to it that the answer is
            // left to exact arithmetic.
            if value.is_nan() || value.abs() < 1e-13 {
                return false;
            }
            for m in [&mut *b, &mut *inv] {
                if pivot != c {
                    let (head, tail) = m.split_at_mut(pivot * n);
                    head[c * n..(c + 1) * n].swap_with_slice(&mut tail[..n]);
                }
                m[c * n..(c + 1) * n].iter_mut().for_each(|x| *x /= value);
            }
            take_from(if is_long { c + 1 } else { 0 }..n, c, b, inv, n);
        }
        // From below up, a row is cleared with rows that are cleared: of a chain few have anything to clear.
        for c in (0..n).rev().filter(|_| is_long) {
            take_from(0..c, c, b, inv, n);
        }
        for i in 0..n {
            (0..i).for_each(|k| inv.swap(i * n + k, k * n + i));
        }
        true
    }

    /// What the basis makes of a right side, each entry of which is known but for its own rounding.
    pub fn solve(&mut self, equations: &Equations, right: &[f64], x: &mut Vector) {
        x.value.fill(0.0);
        self.add_product(right, &mut x.value);
        for _ in 0..2 {
            self.remainder(equations, right, &x.value);
            let mut change = std::mem::take(&mut self.change);
            change.fill(0.0);
            self.add_product(&self.left, &mut change);
            x.value.iter_mut().zip(&change).for_each(|(x, change)| *x += change);
            self.change = change;
        }
        self.remainder(equations, right, &x.value);
        x.error.fill(0.0);
        for (column, b) in self.inverse.chunks_exact(self.n.max(1)).zip(&self.bound) {
            x.error.iter_mut().zip(column).for_each(|(sum, a)| *sum += (a * b).abs());
        }
        x.error.iter_mut().for_each(|error| *error *= 2.0);
    }

    /// Adds the product of the inverse with a vector.
    fn add_product(&self, of: &[f64], to: &mut [f64]) {
        let columns = self.inverse.chunks_exact(self.n.max(1)).zip(of);
        for (column, factor) in columns.filter(|(_, factor)| **factor != 0.0) {
            to.iter_mut().zip(column).for_each(|(sum, a)| *sum += a * factor);
        }
    }

    /// What is left of a right side, and a bound of that with all rounding.
    fn remainder(&mut self, equations: &Equations, right: &[f64], x: &[f64]) {
        self.left.copy_from_slice(right);
        self.bound.iter_mut().zip(right).for_each(|(b, r)| *b = r.abs());
        for (&j, x) in self.columns.iter().zip(x) {
            if *x != 0.0 {
                for e in &equations.columns[j] {
                    self.left[e.row] -= e.value * x;
                    self.bound[e.row] += (e.value * x).abs();
                }
            }
        }
        // Few entries meet in a row: each adds its rounding, that of its product and that of the sum.
        self.bound.iter_mut().zip(&self.left).for_each(|(b, l)| *b = 4.0 * ROUNDING * *b + l.abs());
    }

    /// A column over the basis; the signs at the `wanted` positions are exact.
    pub fn solve_column(&mut self, equations: &Equations, of: usize, wanted: impl Fn(usize) -> bool, x: &mut Vector) {
        let mut right = std::mem::take(&mut self.right);
        right.fill(0.0);
        equations.columns[of].iter().for_each(|e| right[e.row] = e.value);
        self.solve(equations, &right, x);
        self.right = right;
        let mut exact: Option<Vec<Rational>> = None;
        for i in 0..self.n {
            if !wanted(i) || x.sign(i) != 0 {
                continue;
            }
            if self.residue(equations, of, i) == 0 {
                (x.value[i], x.error[i]) = (0.0, 0.0);
                continue;
            }
            let solution = exact.get_or_insert_with(|| {
                exact_solution(equations, &self.columns, of).unwrap_or_else(|| vec![Rational::ZERO; self.n])
            });
            let scale = equations.column_scale[of] / equations.column_scale[self.columns[i]];
            x.value[i] = solution[i].to_f64() * scale;
            x.error[i] = x.value[i].abs() * ROUNDING;
        }
    }

    /// A component of a column over the basis, modulo the prime.
    pub fn residue(&mut self, equations: &Equations, of: usize, i: usize) -> u64 {
        if !self.residues_known {
            self.invert_residues(equations);
        }
        let row = &self.residues[i * self.n..(i + 1) * self.n];
        equations.columns[of].iter().fold(0, |sum, e| add(sum, times(row[e.row], e.residue)))
    }

    fn invert_residues(&mut self, equations: &Equations) {
        let n = self.n;
        let mut b = vec![0; n * n];
        for (i, &j) in self.columns.iter().enumerate() {
            for e in &equations.columns[j] {
                b[e.row * n + i] = e.residue;
            }
        }
        let inv = &mut self.residues;
        inv.fill(0);
        (0..n).for_each(|i| inv[i * n + i] = 1);
        self.residues_known = true;
        for c in 0..n {
            // There is none only if the determinant is a multiple of the prime.
            let Some(pivot) = (c..n).find(|&r| b[r * n + c] != 0) else { continue };
            let factor = power(b[pivot * n + c], PRIME - 2);
            for m in [&mut b, &mut *inv] {
                (0..n).for_each(|k| m.swap(c * n + k, pivot * n + k));
                m[c * n..(c + 1) * n].iter_mut().filter(|x| **x != 0).for_each(|x| *x = times(*x, factor));
            }
            for r in (0..n).filter(|&r| r != c) {
                let factor = b[r * n + c];
                if factor != 0 {
                    for m in [&mut b, &mut *inv] {
                        for k in 0..n {
                            if m[c * n + k] != 0 {
                                m[r * n + k] = add(m[r * n + k], PRIME - times(factor, m[c * n + k]));
                            }
                        }
                    }
                }
            }
        }
    }

    /// Puts an unknown at the position of another; `x` is its column over the basis.
    pub fn exchange(&mut self, equations: &Equations, at: usize, unknown: usize, x: &Vector) {
        let n = self.n;
        if self.residues_known {
            for i in 0..n {
                self.modular[i] = self.residue(equations, unknown, i);
            }
            let factor = power(self.modular[at], PRIME - 2);
            for k in 0..n {
                let top = times(self.residues[at * n + k], factor);
                self.residues[at * n + k] = top;
                for i in (0..n).filter(|&i| i != at && top != 0) {
                    let change = times(self.modular[i], top);
                    self.residues[i * n + k] = add(self.residues[i * n + k], PRIME - change);
                }
            }
        }
        let pivot = x.value[at];
        for column in self.inverse.chunks_exact_mut(n) {
            let top = column[at] / pivot;
            if top != 0.0 {
                column.iter_mut().zip(&x.value).for_each(|(y, x)| *y -= x * top);
            }
            column[at] = top;
        }
        self.positions[self.columns[at]] = None;
        self.columns[at] = unknown;
        self.positions[unknown] = Some(at);
    }

    /// What its unknowns say.
    pub fn read(&self, equations: &Equations, x: &[Vector; 2], motion: &mut Motion) {
        let amount = |j: usize| match self.position(j) {
            None => Amount::default(),
            Some(i) => {
                let scale = equations.column_scale[j];
                Amount {
                    value: x[0].value[i] * scale,
                    error: x[0].error[i] * scale,
                    rate: x[1].value[i] * scale,
                    rate_error: x[1].error[i] * scale,
                }
            }
        };
        equations.read_from(amount, |j| self.position(j).is_some(), motion);
    }
}

/// Sum of two classes.
pub(super) fn add(a: u64, b: u64) -> u64 {
    let sum = a + b;
    if sum >= PRIME { sum - PRIME } else { sum }
}

/// Room for pivoting.
#[derive(Clone)]
pub(super) struct Work {
    pub column: Vector,
    pub level: Vector,
    pub candidates: Vec<usize>,
    /// Unknowns whose columns break the last ties.
    pub order: Vec<usize>,
}

impl Work {
    pub fn new(rows: usize) -> Self {
        Self {
            column: Vector::new(rows),
            level: Vector::new(rows),
            candidates: Vec::with_capacity(rows),
            order: Vec::with_capacity(rows),
        }
    }
}
