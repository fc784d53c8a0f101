//! Every equilibrium under one load where no certificate says that there is one: all choices of drivers are tried.
//!
//! A choice whose equations are regular has one set of forces; it is an equilibrium if their signs are those of the
//! choice. One whose equations are singular (a load exactly on a self-locking threshold) has none, one, or a whole range:
//! its forces are the polyhedron `B(ρ) f = t` with the signs of the choice, which is asked as such. An idle
//! element fits either choice, so solutions are told apart by their forces alone.

use crate::exact::{Polyhedron, Rational};
use crate::kinematics::Configuration;

use super::{Answer, Equilibrium, Solution, Trial};

/// Equilibria that form a whole range.
#[derive(Clone, Debug)]
pub(crate) struct Stretch {
    /// One of them: its drivers are those of all, where a force is not zero.
    pub solution: Solution,
    forces: Polyhedron,
    parts: Vec<Part>,
}

/// An unknown that is not negative, as a part of a force: the column, and its sign.
#[derive(Clone, Copy, Debug)]
struct Part {
    column: usize,
    sign: i8,
}

impl Stretch {
    /// Smallest and largest value of a sum over the forces of the columns; none where it grows without end.
    fn range(&self, of: &dyn Fn(usize) -> Rational) -> [Option<Rational>; 2] {
        let up: Vec<Rational> = self.parts.iter().map(|p| of(p.column) * Rational::from(i64::from(p.sign))).collect();
        let down: Vec<Rational> = up.iter().map(|x| -x).collect();
        let mut forces = self.forces.clone();
        [forces.maximum(&down).map(|x| -x), forces.maximum(&up)]
    }
}

impl Equilibrium {
    /// Tries every choice of drivers.
    pub(super) fn enumerate(&self, t: &[Rational], t_float: &[f64]) -> Answer {
        let n = self.columns.len();
        let moving: Vec<usize> = (0..n).filter(|&j| self.is_moving(j)).collect();
        let mut solutions: Vec<Solution> = Vec::new();
        let mut stretches: Vec<Stretch> = Vec::new();
        let acts = t.iter().any(|x| !x.is_zero());
        let add = |found: Solution, solutions: &mut Vec<Solution>| {
            if solutions.iter().all(|s| s.exact != found.exact) {
                solutions.push(found);
            }
        };
        for mask in 0u32..1 << moving.len() {
            let mut pattern = vec![true; n];
            moving.iter().enumerate().for_each(|(bit, &j)| pattern[j] = mask >> bit & 1 == 0);
            let choice: Vec<_> = pattern.iter().map(|p| Some(*p)).collect();
            match self.attempt(&choice, t, t_float) {
                Some(trial) if self.wrong(&trial, &pattern, 0).is_none() => {
                    let exact = trial.exact.or_else(|| self.exact_forces(&choice, t)).expect("regular");
                    add(self.of_forces(exact, pattern), &mut solutions);
                }
                Some(_) => {}
                // Where nothing acts the train may be wedged within itself; that is no answer to a load.
                None if acts => {
                    let Some((forces, parts)) = self.polyhedron(&pattern, t) else { continue };
                    let (ends, is_range) = self.ends(&forces, &parts);
                    let mut found = ends.into_iter().map(|end| self.of_forces(end, pattern.clone()));
                    let solution = found.next().expect("a point");
                    add(solution.clone(), &mut solutions);
                    found.for_each(|end| add(end, &mut solutions));
                    if is_range {
                        stretches.push(Stretch { solution, forces, parts });
                    }
                }
                None => {}
            }
        }
        Answer { solutions, certificate: self.certificate, stretches }
    }

    /// The forces that balance a load with given drivers; none if there are none.
    fn polyhedron(&self, pattern: &[bool], t: &[Rational]) -> Option<(Polyhedron, Vec<Part>)> {
        let mut parts = Vec::new();
        for (column, c) in self.columns.iter().enumerate() {
            let drives = c.sigma * if pattern[column] { 1 } else { -1 };
            let signs: &[i8] = if self.is_moving(column) { &[drives] } else { &[1, -1] };
            parts.extend(signs.iter().map(|&sign| Part { column, sign }));
        }
        let matrix = self.exact_matrix(&|j| self.columns[j].rho[usize::from(!pattern[j])].clone());
        let rows = matrix.iter().zip(t).map(|(row, right)| {
            let of = parts.iter().map(|p| if p.sign > 0 { row[p.column].clone() } else { -&row[p.column] });
            of.chain([right.clone()]).collect()
        });
        Some((Polyhedron::new(rows.collect(), parts.len())?, parts))
    }

    /// A vertex, the vertices at which some force is least or largest, and whether there is more than one point.
    fn ends(&self, polyhedron: &Polyhedron, parts: &[Part]) -> (Vec<Vec<Rational>>, bool) {
        let forces = |p: &Polyhedron| {
            let mut forces = vec![Rational::ZERO; self.columns.len()];
            for (x, part) in p.point(parts.len()).iter().zip(parts) {
                if part.sign > 0 { forces[part.column] += x.clone() } else { forces[part.column] -= x.clone() }
            }
            forces
        };
        let first = forces(polyhedron);
        let (mut ends, mut is_range) = (vec![first.clone()], false);
        for (column, way) in (0..first.len()).flat_map(|column| [(column, 1), (column, -1)]) {
            let one = |part: &Part| {
                if part.column == column { Rational::from(i64::from(part.sign) * way) } else { Rational::ZERO }
            };
            let of: Vec<Rational> = parts.iter().map(one).collect();
            let mut p = polyhedron.clone();
            match p.maximum(&of) {
                Some(most) if most == &first[column] * &Rational::from(way) => {}
                Some(_) => {
                    is_range = true;
                    let end = forces(&p);
                    if !ends.contains(&end) {
                        ends.push(end);
                    }
                }
                None => is_range = true,
            }
        }
        (ends, is_range)
    }

    fn of_forces(&self, exact: Vec<Rational>, pattern: Vec<bool>) -> Solution {
        let signs = exact.iter().map(Rational::sign).collect();
        let forces: Vec<f64> = exact.iter().map(Rational::to_f64).collect();
        self.solution(Trial { bounds: super::rounding(&forces), forces, signs, exact: Some(exact) }, pattern)
    }

    /// The range of an external torque over a stretch, in the unit of its load; none where it has no end.
    pub(crate) fn torque_range(&self, c: &Configuration<'_>, stretch: &Stretch, node: usize) -> [Option<Rational>; 2] {
        stretch.range(&|column| {
            let element = self.columns[column].element;
            super::coefficient(c, element, &self.rho_of(&stretch.solution, element), node)
        })
    }
}
