//! The complete search over all modes, exact.
//!
//! What is not yet decided is a polyhedron: both unknowns of a pair may be positive. One that is empty ends the
//! branch; so does one in which all accelerations are those of the motion that is known. Otherwise a pair is
//! divided. What remains at the end is a mode.

use crate::exact::{Polyhedron, Rational, reduce};

use super::Decision;
use super::motion::{Amount, Motion, Verdict};
use super::problem::Load;

/// Polyhedra of moderate [`SIZE`] that are looked at, at most, to find a motion: a search that is longer says so.
const MOST: usize = 20_000;

/// The same where a motion is known and others are looked for: a run waits for that at every change of mode.
const MOST_PROOF: usize = 500;

/// Numbers of a polyhedron that counts as one. In a larger one there are more pivots, each of more and longer numbers.
const SIZE: usize = 1000;

/// One over the part of the sizes of an acceleration's terms by which rounding of the loads may change it.
const NOISE: i64 = 1 << 36;

/// The search.
struct Search<'d> {
    pairs: &'d [[usize; 2]],
    /// Each acceleration as constant and coefficients of the unknowns in pairs: as many as there are bounds.
    accelerations: &'d [(Rational, Vec<Rational>)],
    /// How far accelerations of one motion may differ, and beside that how much of what they are the sum of.
    bounds: Vec<Rational>,
    noise: Rational,
    /// Motions found: values of the unknowns in pairs.
    found: Vec<Vec<Rational>>,
    /// Polyhedra that may still be looked at.
    left: usize,
}

impl<'d> Search<'d> {
    /// Motions count as different beyond these bounds; none: all are the same.
    fn new(reduced: &'d Reduced, bounds: Vec<Rational>, left: usize) -> Self {
        Self {
            pairs: &reduced.pairs,
            accelerations: &reduced.given[..bounds.len()],
            bounds,
            noise: Rational::new(1, NOISE),
            found: Vec::new(),
            left,
        }
    }

    /// Takes a polyhedron to a point whose accelerations are not those of the first motion. False if it has none.
    fn leaves(&self, p: &mut Polyhedron, first: &[Rational]) -> bool {
        (0..self.accelerations.len()).any(|i| {
            let (constant, of) = &self.accelerations[i];
            let known = of.iter().zip(first).fold(Rational::ZERO, |sum, (a, x)| sum + a * x);
            // What rounding has made of the loads is no other motion.
            let parts = of.iter().zip(first).fold(constant.abs(), |sum, (a, x)| sum + (a * x).abs());
            let bound = &self.bounds[i] + &(&parts * &self.noise);
            let opposite: Vec<Rational> = of.iter().map(|x| -x).collect();
            p.exceeds(of, &(&known + &bound)) || p.exceeds(&opposite, &(&bound - &known))
        })
    }

    /// All modes within a polyhedron. False if that was too long.
    fn explore(&mut self, mut p: Polyhedron) -> bool {
        let times = p.size() / SIZE;
        let Some(left) = self.left.checked_sub((times * times).max(1)) else { return false };
        self.left = left;
        if let Some(first) = self.found.first()
            && !self.leaves(&mut p, first)
        {
            return true;
        }
        let unknowns = 2 * self.pairs.len();
        let x = p.point(unknowns);
        let open = |&&[a, b]: &&[usize; 2]| !p.banned[a] && !p.banned[b];
        let broken = self.pairs.iter().filter(open).find(|[a, b]| !x[*a].is_zero() && !x[*b].is_zero());
        match broken.or_else(|| self.pairs.iter().find(open)).copied() {
            None => {
                self.found.push(x);
                // Again, for others of the same mode.
                self.found.len() > 1 || self.explore(p)
            }
            Some(pair) => pair.into_iter().all(|zero| {
                let mut part = p.clone();
                self.found.len() > 1 || !part.ban(zero) || self.explore(part)
            }),
        }
    }
}

/// The equations of a load, solved for the unknowns free of sign.
struct Reduced {
    free: Vec<usize>,
    /// Unknowns in pairs: all that follow are numbered by their places here.
    paired: Vec<usize>,
    /// Each free one as constant and coefficients of the others.
    given: Vec<(Rational, Vec<Rational>)>,
    /// What the others must fulfil, right sides last.
    rest: Vec<Vec<Rational>>,
    pairs: Vec<[usize; 2]>,
}

impl Reduced {
    fn place(&self, j: usize) -> usize {
        self.paired.iter().position(|&k| k == j).expect("in a pair")
    }
}

impl Decision {
    /// None if a load is not finite, or the equations are not independent.
    fn reduced(&self, load: &Load) -> Option<Reduced> {
        let equations = &self.equations;
        let free: Vec<usize> = equations.free().collect();
        let paired: Vec<usize> = (0..equations.cover()).filter(|&j| equations.partner[j].is_some()).collect();
        // Equations over the free unknowns, the others, and the right side.
        let mut rows = vec![vec![Rational::ZERO; free.len() + paired.len() + 1]; equations.rows];
        for (place, &j) in free.iter().chain(&paired).enumerate() {
            for e in &equations.columns[j] {
                rows[e.row][place] = e.exact.clone();
            }
        }
        let mut finite = true;
        equations.right(load, 0, |row, value| {
            let exact = Rational::from_f64(value);
            finite &= exact.is_some();
            *rows[row].last_mut().expect("a right side") = exact.unwrap_or(Rational::ZERO);
        });
        if !finite || reduce(&mut rows, free.len()).len() < free.len() {
            return None;
        }
        let affine = |row: &Vec<Rational>| {
            let of: Vec<Rational> = row[free.len()..free.len() + paired.len()].iter().map(|x| -x).collect();
            (row.last().expect("a right side").clone(), of)
        };
        let given = rows[..free.len()].iter().map(affine).collect();
        let rest = rows[free.len()..].iter().map(|row| row[free.len()..].to_vec()).collect();
        let mut reduced = Reduced { free, paired, given, rest, pairs: vec![] };
        let both = |&j: &usize| equations.partner[j].filter(|&k| k > j).map(|k| [reduced.place(j), reduced.place(k)]);
        reduced.pairs = reduced.paired.iter().filter_map(both).collect();
        Some(reduced)
    }

    /// Whether all that is at rest can remain so. False too if that would take too long to find out.
    pub(super) fn can_rest(&self, load: &Load) -> bool {
        let Some(reduced) = self.reduced(load) else { return false };
        let of_meshes = self.equations.meshes.iter().filter_map(|m| m.rest).flat_map(|[slips, _]| slips);
        let of_elements = self.equations.elements.iter().flat_map(|e| e.yields).flatten().map(|[slip, _]| slip);
        let Some(mut p) = Polyhedron::new(reduced.rest.clone(), reduced.paired.len()) else { return false };
        let mut search = Search::new(&reduced, vec![], MOST_PROOF);
        let stays = of_meshes.chain(of_elements).all(|slip| p.ban(reduced.place(slip)));
        stays && search.explore(p) && !search.found.is_empty()
    }

    /// Looks through all modes; `found` if a motion is known already.
    pub(super) fn search(&mut self, load: &Load, found: bool) -> Verdict {
        let Some(reduced) = self.reduced(load) else {
            return if found { Verdict::One { proved: false } } else { Verdict::Undecided };
        };
        let bound = |a: &Amount| Rational::from_f64(if found { a.error } else { 0.0 }).unwrap_or(Rational::ZERO);
        let bounds = self.motion.accelerations.iter().map(bound).collect();
        let mut search = Search::new(&reduced, bounds, if found { MOST_PROOF } else { MOST });
        let complete = match Polyhedron::new(reduced.rest.clone(), reduced.paired.len()) {
            None => true,
            Some(p) => search.explore(p),
        };
        let equations = &self.equations;
        let read = |x: &[Rational], motion: &mut Motion| {
            let value = |j: usize| match reduced.free.iter().position(|&k| k == j) {
                Some(i) => {
                    let (constant, of) = &reduced.given[i];
                    of.iter().zip(x).fold(constant.clone(), |sum, (a, x)| sum + a * x)
                }
                None => x[reduced.place(j)].clone(),
            };
            let amount = |j: usize| {
                let value = value(j).to_f64();
                Amount { value, error: f64::EPSILON * value.abs(), ..Amount::default() }
            };
            let basic = |j: usize| value(j).sign() > 0;
            equations.read_from(amount, basic, motion);
        };
        match (&search.found[..], complete) {
            ([first, second, ..], _) => {
                read(first, &mut self.motion);
                read(second, &mut self.second);
                Verdict::Two
            }
            (_, false) if found => Verdict::One { proved: false },
            (_, false) => Verdict::Undecided,
            ([first], true) => {
                if !found {
                    read(first, &mut self.motion);
                }
                Verdict::One { proved: true }
            }
            // A load at its limit within rounding, and exactly just beyond it.
            ([], true) if found => Verdict::One { proved: false },
            ([], true) => Verdict::None,
        }
    }
}
