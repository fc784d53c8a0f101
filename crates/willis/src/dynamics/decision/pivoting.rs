//! Complementary pivoting from a mode to that of a load.
//!
//! A covering unknown makes the start feasible; driven out again, it leads from mode to mode, each a neighbour of the
//! one before (Lemke). One rule is added. The friction of a mesh at rest ties `u`, `v` and the force together, so that
//! one of them is always slaved: it cannot leave before the others do, and would it leave, the basis would be singular.
//! With it a resting mesh runs round its six pieces (either sign of the force, slipping forward, at rest, slipping
//! backward). Ties are broken by the rates of the loads, then by powers of a small number in the order of the start.

use std::cmp::Ordering;
use std::collections::BTreeMap;

use crate::exact::Rational;
use crate::exact::residue::{PRIME, times};

use super::Decision;
use super::basis::{Basis, Vector, Work, add};
use super::equations::{Equations, exact_solution};

/// Whether an unknown follows from the friction of its mesh, with this one entering.
fn is_slaved(equations: &Equations, basis: &Basis, j: usize, entering: Option<usize>) -> bool {
    let Some([slips, spares]) = equations.rests[j].and_then(|m| equations.meshes[m].rest) else { return false };
    let inside = |j: usize| basis.position(j).is_some() || entering == Some(j);
    match spares.iter().position(|&s| s == j) {
        Some(side) => inside(slips[1 - side]),
        None => spares.iter().all(|&s| inside(s)) && !slips.iter().any(|&s| inside(s)),
    }
}

impl Decision {
    /// From the last basis to that of the loads. False if pivoting says nothing: no answer about motion.
    pub(super) fn pivot(&mut self) -> bool {
        if !self.basis.is_known() && !self.start() {
            return false;
        }
        // A tie within rounding may leave a trace: then once more from there.
        for _ in 0..4 {
            self.solve_loads();
            if self.is_feasible() {
                return true;
            }
            if !self.cover() {
                break;
            }
        }
        self.basis.forget();
        false
    }

    fn solve_loads(&mut self) {
        for (x, load) in self.unknowns.iter_mut().zip(&self.loads) {
            self.basis.solve(&self.equations, load, x);
        }
    }

    /// Whether an unknown of a position must not be negative, and is not slaved.
    fn is_bound(&self, position: usize, entering: Option<usize>) -> bool {
        let j = self.basis.columns()[position];
        self.equations.partner[j].is_some() && !is_slaved(&self.equations, &self.basis, j, entering)
    }

    fn is_feasible(&self) -> bool {
        (0..self.equations.rows).filter(|&i| self.is_bound(i, None)).all(|i| match self.unknowns[0].sign(i) {
            0 => self.unknowns[1].sign(i) >= 0,
            sign => sign > 0,
        })
    }

    /// The least of the spare forces.
    pub(super) fn least_spare(&self) -> f64 {
        let spare = |i: &usize| self.equations.is_spare[self.basis.columns()[*i]] && self.is_bound(*i, None);
        (0..self.equations.rows).filter(spare).map(|i| self.unknowns[0].value[i].max(0.0)).fold(f64::INFINITY, f64::min)
    }

    /// A first basis: all slips forward, forces as in the lossless train in which all is held. Where that is singular,
    /// as where something without inertia would be held by nothing, some of it is at rest.
    fn start(&mut self) -> bool {
        let (ideal, ideal_basis) = &mut *self.ideal;
        let known = ideal_basis.is_known() || {
            let free: Vec<usize> = ideal.free().collect();
            ideal_basis.set(ideal, free.into_iter())
        };
        let mut backward = vec![false; self.equations.meshes.len()];
        if known {
            let mut x = Vector::new(ideal.rows);
            for load in [1, 0] {
                let mut right = vec![0.0; ideal.rows];
                // The loads on the members are the first rows of both systems.
                ideal.copy_torques(&self.equations, &self.loads[load], &mut right);
                ideal_basis.solve(ideal, &right, &mut x);
                for (backward, mesh) in backward.iter_mut().zip(&ideal.meshes) {
                    let sign = x.sign(ideal_basis.position(mesh.forces[0]).expect("all are basic"));
                    *backward = if sign == 0 { *backward } else { sign < 0 };
                }
            }
        }
        let mut columns: Vec<usize> = self.equations.free().collect();
        for (mesh, backward) in self.equations.meshes.iter().zip(backward) {
            columns.extend(mesh.parts.map(|parts| parts[usize::from(backward)]));
            if let Some([[ahead, _], [_, v]]) = mesh.rest {
                columns.extend([ahead, v]);
            }
        }
        for e in &self.equations.elements {
            columns.extend(e.yields[0].map(|[slip, _]| slip));
            columns.extend(e.yields[1].map(|[_, spare]| spare));
        }
        self.basis.set(&self.equations, columns.iter().copied()) || {
            self.equations.mend(&mut columns);
            self.basis.set(&self.equations, columns.into_iter())
        }
    }

    /// The column that covers what is negative, as the friction of the meshes at rest allows.
    fn covering(&self) -> BTreeMap<usize, Rational> {
        let unit = |j: usize| Rational::from_f64(self.equations.column_scale[j]).unwrap_or(Rational::ONE);
        let mut sizes: BTreeMap<usize, Rational> = BTreeMap::new();
        let bound = self.basis.columns().iter().filter(|&&j| self.equations.partner[j].is_some());
        for &j in bound.clone() {
            if !is_slaved(&self.equations, &self.basis, j, None) {
                sizes.insert(j, unit(j));
            }
        }
        for &j in bound {
            if sizes.contains_key(&j) {
                continue;
            }
            let mesh = &self.equations.meshes[self.equations.rests[j].expect("slaved")];
            let of = |j: &usize| sizes.get(j).cloned().unwrap_or(Rational::ZERO);
            let (parts, [_, spares]) = (mesh.parts.expect("lossy"), mesh.rest.expect("at rest"));
            let size = if spares.contains(&j) {
                of(&parts[0]) * &mesh.lost + of(&parts[1]) * &mesh.lost
            } else {
                (of(&spares[0]) + of(&spares[1])) / &mesh.lost
            };
            sizes.insert(j, size);
        }
        let mut column: BTreeMap<usize, Rational> = BTreeMap::new();
        for (j, size) in sizes {
            for e in &self.equations.columns[j] {
                *column.entry(e.row).or_insert(Rational::ZERO) += -(&e.exact * &size);
            }
        }
        column
    }

    /// Brings the covering unknown in, and out again. False if that does not end: on a ray.
    fn cover(&mut self) -> bool {
        let column = self.covering();
        self.equations.set_cover(column);
        let cover = self.equations.cover();
        let mut work = std::mem::replace(&mut self.work, Work::new(0));
        let done = self.drive(cover, &mut work);
        self.work = work;
        done
    }

    fn drive(&mut self, cover: usize, work: &mut Work) -> bool {
        let rows = self.equations.rows;
        work.candidates.clear();
        work.candidates.extend((0..rows).filter(|&i| self.is_bound(i, None)));
        work.order.clear();
        work.order.extend(work.candidates.iter().map(|&i| self.basis.columns()[i]));
        self.basis.solve_column(&self.equations, cover, |_| false, &mut work.column);
        // The most negative for its size leaves first.
        work.column.value.iter_mut().for_each(|w| *w = -*w);
        let Some(mut at) = self.least(cover, work) else { return false };
        work.column.value.iter_mut().for_each(|w| *w = -*w);
        let mut entering = cover;
        // Pivoting ends by itself; where round-off keeps it from that, the search decides.
        for _ in 0..100 + 20 * rows {
            let leaving = self.basis.columns()[at];
            self.basis.exchange(&self.equations, at, entering, &work.column);
            if leaving == cover {
                return true;
            }
            self.solve_loads();
            entering = self.equations.partner[leaving].expect("only bound unknowns leave");
            work.candidates.clear();
            let may = |i: usize| self.basis.columns()[i] == cover || self.is_bound(i, Some(entering));
            work.candidates.extend((0..rows).filter(|&i| may(i)));
            let candidates = &work.candidates;
            self.basis.solve_column(&self.equations, entering, |i| candidates.contains(&i), &mut work.column);
            work.candidates.retain(|&i| work.column.value[i] > 0.0);
            match self.least(entering, work) {
                Some(next) => at = next,
                None => return false,
            }
        }
        false
    }

    /// The position that blocks first, `work.column` being the column of the entering unknown there.
    fn least(&mut self, entering: usize, work: &mut Work) -> Option<usize> {
        for x in &self.unknowns {
            keep_least(&mut work.candidates, x, &work.column, |_, _| Ordering::Equal);
        }
        let cover = self.basis.position(self.equations.cover());
        if let Some(at) = cover.filter(|at| work.candidates.contains(at)) {
            return Some(at);
        }
        for k in 0..work.order.len() {
            if work.candidates.len() < 2 {
                break;
            }
            let of = work.order[k];
            let candidates = &work.candidates;
            self.basis.solve_column(&self.equations, of, |i| candidates.contains(&i), &mut work.level);
            let (basis, equations) = (&mut self.basis, &self.equations);
            keep_least(&mut work.candidates, &work.level, &work.column, |i, k| {
                exact_order(basis, equations, [of, entering], [i, k])
            });
        }
        work.candidates.first().copied()
    }
}

/// Keeps the positions of least ratio `x / w`; `doubtful` decides between two where the bounds do not.
fn keep_least(candidates: &mut Vec<usize>, x: &Vector, w: &Vector, mut doubtful: impl FnMut(usize, usize) -> Ordering) {
    let mut order = |i: usize, k: usize| {
        let (a, b) = (x.value[i] * w.value[k], x.value[k] * w.value[i]);
        let error = x.error[i] * w.value[k].abs()
            + x.error[k] * w.value[i].abs()
            + (x.value[i].abs() + x.error[i]) * w.error[k]
            + (x.value[k].abs() + x.error[k]) * w.error[i]
            + 2.0 * f64::EPSILON * (a.abs() + b.abs());
        if (a - b).abs() > error { a.total_cmp(&b) } else { doubtful(i, k) }
    };
    let Some(mut best) = candidates.first().copied() else { return };
    for &i in candidates.iter() {
        if i != best && order(i, best) == Ordering::Less {
            best = i;
        }
    }
    candidates.retain(|&i| i == best || order(i, best) != Ordering::Greater);
}

/// Order of the ratios of two columns over the basis at two positions.
fn exact_order(basis: &mut Basis, equations: &Equations, [x, w]: [usize; 2], [i, k]: [usize; 2]) -> Ordering {
    let mut product =
        |x_at: usize, w_at: usize| times(basis.residue(equations, x, x_at), basis.residue(equations, w, w_at));
    let (a, b) = (product(i, k), product(k, i));
    if add(a, PRIME - b) == 0 {
        return Ordering::Equal;
    }
    let column = |of: usize| exact_solution(equations, basis.columns(), of);
    let (Some(x), Some(w)) = (column(x), column(w)) else { return Ordering::Equal };
    // Of the covering unknown the opposite is meant: there both numbers turn round.
    let turned = w[k].sign() < 0 && w[i].sign() < 0;
    let order = (&x[i] * &w[k]).cmp(&(&x[k] * &w[i]));
    if turned { order.reverse() } else { order }
}
