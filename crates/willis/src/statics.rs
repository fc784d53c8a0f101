//! Torques with mesh losses: a complementarity problem, its certificate, its verdict.
//!
//! Element `j` (a mesh, or a chain of meshes) loads its ends and carrier with
//! `f_j b_j(ρ_j)`, `b(ρ) = a e_p + b ρ e_q − (a + b ρ) e_c`, where `ρ = η` when end p drives
//! (`f σ > 0`, with `σ` the speed of p relative to the carrier), `1/η` when q drives. Which end
//! drives is part of the solution: a horizontal linear complementarity problem
//! `B₊f₊ − B₋f₋ = t`, `f± ≥ 0`, `f₊·f₋ = 0`, `k` unknowns and `2^k` sign patterns.
//!
//! * **Certificate.** If `det B(ρ) ≠ 0` on the whole box `ρ_j ∈ [η_j, 1/η_j]`, exactly one solution
//!   exists for every load (W-property: Samelson, Thrall, Wesler; Sznajder and Gowda for the
//!   horizontal form). It is proved by a verified bound on the spectral radius, or by
//!   splitting the box until each part is regular, and comparing the exact determinants at one corner of each part.
//! * **Solution.** With a certificate: least-index pivoting from the lossless pattern, which ends
//!   under the W-property (Murty). Without: every pattern is tried, block by block, and every solution returned.
//! * **Decisions** that lie within the error bound of the floating point solution are made again
//!   in exact rationals. No tolerance decides a sign.
//!
//! An element at rest relative to its carrier transmits without loss (`ρ = 1`); its friction may
//! lie anywhere between, which is reported, not guessed. An element with zero force is idle: it
//! has no driver and no loss (the one deterministic rule for idle meshes).

mod enumeration;
mod linear;
mod problem;

use std::collections::HashSet;
use std::sync::OnceLock;

#[cfg(not(target_family = "wasm"))]
use nalgebra::Const;
use nalgebra::{DMatrix, DVector, Dyn};
use serde::{Deserialize, Serialize};

use crate::diagnostic::{Code, Diagnostic, through_diagnostic};
use crate::exact::blocks::{Block, blocks};
use crate::exact::{self, Matrix, Rational};
use crate::kinematics::{Configuration, Node};
use crate::train::MemberId;

pub(crate) use enumeration::Stretch;
pub use problem::{Balanced, Equilibria, Problem, Unposed};

/// How uniqueness was established.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Certificate {
    /// One solution for every load: verified bound on the spectral radius over the whole box.
    SpectralRadius,
    /// One solution for every load: the determinants of all sign patterns share one sign.
    Determinants,
    /// No certificate for every load (determinants of both signs or zero: for some load there is no
    /// or more than one solution; or too many boxes to look at). What is reported for the load at
    /// hand was found by trying every sign pattern, of one block of the equations after the other; where
    /// that takes too many for a load, the answer to it is undecided.
    Enumeration,
    /// Too many interacting elements to decide; a solution was found by pivoting.
    Undecided,
}

impl Certificate {
    /// Whether one solution exists whatever the loads.
    pub fn unique_for_every_load(self) -> bool {
        matches!(self, Self::SpectralRadius | Self::Determinants)
    }

    /// The name in the machine-readable results.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::SpectralRadius => "spectral-radius",
            Self::Determinants => "determinants",
            Self::Enumeration => "enumeration",
            Self::Undecided => "undecided",
        }
    }
}

/// Why no equilibrium problem can be set up.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Unsolvable {
    /// This many more terminals must be loaded, or fewer left open.
    MissingLoads(usize),
    /// This many loads too many.
    TooManyLoads(usize),
    /// The forces are not determined by equilibrium even without friction.
    Indeterminate,
    /// A loaded element's relative speed is not determined.
    UndeterminedSpeed,
}

impl std::fmt::Display for Unsolvable {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::MissingLoads(n) => write!(f, "{n} more loads must be given"),
            Self::TooManyLoads(n) => write!(f, "{n} loads too many: that many freedoms are left over"),
            Self::Indeterminate => f.write_str("statically indeterminate"),
            Self::UndeterminedSpeed => f.write_str("a loaded mesh has no determined relative speed"),
        }
    }
}

impl std::error::Error for Unsolvable {}

impl From<Unsolvable> for Diagnostic {
    fn from(why: Unsolvable) -> Self {
        let code = match why {
            Unsolvable::MissingLoads(_) => Code::MissingTorque,
            Unsolvable::TooManyLoads(_) => Code::TooManyTorques,
            Unsolvable::Indeterminate | Unsolvable::UndeterminedSpeed => Code::Unfit,
        };
        Self::new(code, "", why.to_string())
    }
}

through_diagnostic!(Unsolvable);

/// One element as the statics sees it.
#[derive(Clone, Debug)]
struct Column {
    /// Index of the element in the configuration.
    element: usize,
    /// Sign of the relative speed of end p times the sign of its coefficient; 0 at rest.
    sigma: i8,
    /// (row, constant part, part times ρ).
    entries: Vec<(usize, Rational, Rational)>,
    /// The same in floating point.
    floats: Vec<(usize, f64, f64)>,
    /// ρ when p drives, ρ when q drives.
    rho: [Rational; 2],
    rho_floats: [f64; 2],
}

/// An equilibrium of the train.
#[derive(Clone, Debug)]
pub(crate) struct Solution {
    /// Force variable of each element of the configuration; the torque on end p is `a f`.
    pub(crate) forces: Vec<f64>,
    /// ρ of each element.
    pub(crate) rho: Vec<f64>,
    /// How far each may be from the exact force.
    errors: Vec<f64>,
    /// Exact forces, where they were needed for a decision or asked for.
    pub(crate) exact: Option<Vec<Rational>>,
    /// For each element: p drives, q drives, or neither (idle or at rest).
    pub(crate) driver: Vec<Option<bool>>,
    pattern: Vec<bool>,
}

/// What the statics says for one load.
#[derive(Clone, Debug)]
pub(crate) struct Answer {
    /// Every solution found; none means that friction locks the train.
    pub solutions: Vec<Solution>,
    /// What is known about their number.
    pub certificate: Certificate,
    /// Whole ranges of solutions; their ends, as far as they have any, are among those listed.
    pub stretches: Vec<Stretch>,
}

/// The equilibrium problem of a configuration with given directions of motion: which torques are
/// known is fixed, their values are not.
#[derive(Clone, Debug)]
pub(crate) struct Equilibrium {
    columns: Vec<Column>,
    /// Node of each row.
    rows: Vec<usize>,
    elements: usize,
    /// Diagonal blocks of the equations, in the order in which they are solved.
    blocks: Vec<Block>,
    /// What is solved together in floating point, in this order: those blocks of a long train, else everything.
    groups: Vec<Block>,
    /// The diagonal blocks as problems of their own; none where all are certified, or one cannot be decided.
    parts: Vec<Equilibrium>,
    certificate: Certificate,
}

/// Most elements (with relative motion) of a block without certificate for which all sign patterns are tried.
const MOST_ENUMERATED: usize = 16;
/// Most boxes looked at for the determinant certificate.
const MOST_BOXES: usize = 1 << 13;
/// Bound on the number of boxes or pivots times the cube of the number of elements.
const WORK: usize = 1 << 28;

impl Equilibrium {
    /// Sets up the problem: `sigma` by element (see [`Configuration::sigma`]), `open` the nodes
    /// whose external torque is unknown, `loaded` the nodes whose torque may differ from zero.
    pub(crate) fn new(
        configuration: &Configuration<'_>,
        sigma: &[Option<i8>],
        open: &[usize],
        loaded: &[usize],
    ) -> Result<Self, Unsolvable> {
        let c = configuration;
        let (row_alive, alive) = carrying(c, open, loaded);
        let rows: Vec<usize> = (0..c.nodes).filter(|&n| row_alive[n]).collect();
        let active: Vec<usize> = (0..c.elements.len()).filter(|&j| alive[j]).collect();
        if rows.len() < active.len() {
            // Fewer equations than forces: a load is missing, unless the gears are redundant.
            return Err(match active.len() - rows.len() {
                n if !c.redundant().is_empty() && open.len() <= c.degrees_of_freedom() => {
                    let _ = n;
                    Unsolvable::Indeterminate
                }
                n => Unsolvable::MissingLoads(n),
            });
        }
        if rows.len() > active.len() {
            return Err(Unsolvable::TooManyLoads(rows.len() - active.len()));
        }
        let mut row_of = vec![None; c.nodes];
        rows.iter().enumerate().for_each(|(r, &n)| row_of[n] = Some(r));
        let mut columns = Vec::with_capacity(active.len());
        for &j in &active {
            let e = &c.elements[j];
            let sigma = sigma[j].ok_or(Unsolvable::UndeterminedSpeed)?;
            let mut entries: Vec<(usize, Rational, Rational)> = Vec::with_capacity(3);
            let parts = [
                (e.p, e.a.clone(), Rational::ZERO),
                (e.q, Rational::ZERO, e.b.clone()),
                (e.carrier, -e.a.clone(), -e.b.clone()),
            ];
            // A variator at a mechanical point has no lever on one side.
            for (member, constant, slope) in parts.into_iter().filter(|(_, a, b)| !(a.is_zero() && b.is_zero())) {
                let Some(r) = c.node(member).and_then(|n| row_of[n]) else { continue };
                match entries.iter_mut().find(|x| x.0 == r) {
                    Some(x) => {
                        x.1 += constant;
                        x.2 += slope;
                    }
                    None => entries.push((r, constant, slope)),
                }
            }
            let rho = if sigma == 0 { [Rational::ONE, Rational::ONE] } else { [e.forward.clone(), e.backward.recip()] };
            columns.push(Column {
                element: j,
                sigma,
                floats: entries.iter().map(|(r, a, b)| (*r, a.to_f64(), b.to_f64())).collect(),
                entries,
                rho_floats: [rho[0].to_f64(), rho[1].to_f64()],
                rho,
            });
        }
        let rows_of: Vec<Vec<usize>> = columns.iter().map(|c| c.entries.iter().map(|e| e.0).collect()).collect();
        let blocks = blocks(&rows_of).ok_or(Unsolvable::Indeterminate)?;
        let certificate = Certificate::Undecided;
        let groups = linear::groups(&blocks);
        let mut problem =
            Self { columns, rows, elements: c.elements.len(), blocks, groups, parts: vec![], certificate };
        let mut certificates = Vec::with_capacity(problem.blocks.len());
        for block in &problem.blocks {
            certificates.push(match problem.blocks.len() {
                _ if problem.is_certain(block) => Some(Certificate::SpectralRadius),
                // A single block is the whole.
                1 => problem.examined()?,
                _ => problem.part(block).examined()?,
            });
        }
        problem.certificate = match certificates.iter().copied().collect::<Option<Vec<_>>>() {
            Some(all) if all.contains(&Certificate::Determinants) => Certificate::Determinants,
            Some(_) => Certificate::SpectralRadius,
            None => {
                let part = |(block, certificate): (&Block, Option<Certificate>)| {
                    let n = block.rows.len();
                    let blocks = vec![Block { rows: (0..n).collect(), columns: (0..n).collect() }];
                    let certificate = certificate.unwrap_or(Certificate::Enumeration);
                    Self { groups: blocks.clone(), blocks, certificate, ..problem.part(block) }
                };
                let parts: Vec<Self> = problem.blocks.iter().zip(certificates).map(part).collect();
                let is_too_large = |p: &Self| p.certificate == Certificate::Enumeration && p.moving() > MOST_ENUMERATED;
                if parts.iter().any(is_too_large) {
                    Certificate::Undecided
                } else {
                    problem.parts = parts;
                    Certificate::Enumeration
                }
            }
        };
        Ok(problem)
    }

    /// Whether a block is a single equation whose coefficient is far from zero for every ρ between its bounds.
    fn is_certain(&self, block: &Block) -> bool {
        let (&[row], &[column]) = (&block.rows[..], &block.columns[..]) else { return false };
        let column = &self.columns[column];
        let Some(&(_, constant, slope)) = column.floats.iter().find(|e| e.0 == row) else { return false };
        let [low, high] = column.rho_floats;
        let (middle, half) = ((low + high) / 2.0, (high - low).abs() / 2.0);
        let least = (constant + slope * middle).abs() * 0.99 - (slope * half).abs();
        least > 1e-6 * (constant.abs() + (slope * middle).abs())
    }

    /// The certificate of a block; none where there is none. An error where no choice of drivers determines its forces.
    fn examined(&self) -> Result<Option<Certificate>, Unsolvable> {
        if self.determines_forces() { Ok(self.certify()) } else { Err(Unsolvable::Indeterminate) }
    }

    /// A diagonal block as a problem of its own, without blocks of its own.
    fn part(&self, block: &Block) -> Self {
        let place = |row: &usize| block.rows.iter().position(|r| r == row);
        let columns = block.columns.iter().map(|&j| {
            let c = &self.columns[j];
            let inside = c.entries.iter().filter_map(|(r, a, b)| Some((place(r)?, a.clone(), b.clone())));
            let floats = c.floats.iter().filter_map(|(r, a, b)| Some((place(r)?, *a, *b)));
            Column { entries: inside.collect(), floats: floats.collect(), rho: c.rho.clone(), ..*c }
        });
        Self {
            columns: columns.collect(),
            rows: block.rows.clone(),
            blocks: vec![],
            groups: vec![],
            parts: vec![],
            ..*self
        }
    }

    /// Whether some choice of drivers determines the forces. Without friction they may not be determined all the same:
    /// where a basic ratio is one, only friction balances the carrier.
    ///
    /// The determinant is affine in each ρ, so it vanishes for every choice only where it vanishes everywhere. It is
    /// looked at without friction, then, modulo a prime, at one point off the box that no relation among tooth numbers
    /// and efficiencies singles out.
    fn determines_forces(&self) -> bool {
        let somewhere = |j: usize| match &self.columns[j].rho {
            [low, high] if low != high => low + &((high - low) * Rational::from((j as i64 + 2) * 0x9e37_79b9 + 1)),
            [same, _] => same.clone(),
        };
        let regular = |rho: &dyn Fn(usize) -> Rational| {
            self.is_regular_modulo(rho) || !exact::determinant(&self.exact_matrix(rho)).is_zero()
        };
        regular(&|_| Rational::ONE) || regular(&somewhere)
    }

    /// Whether elimination modulo a prime shows that the matrix has an inverse; it nearly always does where there is one.
    fn is_regular_modulo(&self, rho: &dyn Fn(usize) -> Rational) -> bool {
        let n = self.columns.len();
        let mut residues = vec![0; n * n];
        for (j, column) in self.columns.iter().enumerate() {
            let rho = rho(j);
            for (r, constant, slope) in &column.entries {
                let Some(own) = (constant + &(slope * &rho)).modulo() else { return false };
                residues[*r * n + j] = own;
            }
        }
        exact::residue::rank(&mut residues, n) == n
    }

    /// What is known about the number of solutions, before any load is given.
    pub fn certificate(&self) -> Certificate {
        self.certificate
    }

    fn exact_matrix(&self, rho: &dyn Fn(usize) -> Rational) -> Matrix {
        let n = self.columns.len();
        let mut m = vec![vec![Rational::ZERO; n]; n];
        for (j, column) in self.columns.iter().enumerate() {
            let rho = rho(j);
            for (r, constant, slope) in &column.entries {
                m[*r][j] = constant + &(slope * &rho);
            }
        }
        m
    }

    /// Whether `B(ρ)` is regular on the whole box given by a centre and a radius for each column.
    ///
    /// With any matrix `R ≈ B_c⁻¹`, `R B(ρ)` differs from the identity by at most
    /// `M = |I − R B_c| + Σ |R d_j| r_j`; it is regular when some `x > 0` has `M x < x` (the spectral
    /// radius of the non-negative `M` is then below one). Rounding is covered by inflating `M`.
    fn regular(&self, centre: &[f64], radius: &[f64]) -> bool {
        let n = self.columns.len();
        let b = self.float_matrix(&|j| centre[j]);
        let Some(r) = b.clone().try_inverse() else { return false };
        let product = &r * &b;
        let bound = r.abs() * self.sizes(&|j| centre[j]);
        let mut m = DMatrix::from_fn(n, n, |i, j| {
            let unit = if i == j { 1.0 } else { 0.0 };
            (unit - product[(i, j)]).abs() + 4.0 * (n as f64) * f64::EPSILON * bound[(i, j)]
        });
        for (j, column) in self.columns.iter().enumerate() {
            if radius[j] == 0.0 {
                continue;
            }
            for i in 0..n {
                let mut sum = 0.0;
                let mut size = 0.0;
                for &(row, _, slope) in &column.floats {
                    sum += r[(i, row)] * slope;
                    size += (r[(i, row)] * slope).abs();
                }
                m[(i, j)] += (sum.abs() + 8.0 * f64::EPSILON * size) * radius[j] * (1.0 + 1e-12);
            }
        }
        if !m.iter().all(|x| x.is_finite()) {
            return false;
        }
        // (I − M)⁻¹ applied again and again turns any start into a witness, if there is one: chains
        // of sets need several steps, because their components differ by many orders.
        let system = (DMatrix::identity(n, n) - &m).lu();
        let mut x = DVector::from_element(n, 1.0);
        for _ in 0..n.min(40) + 2 {
            let Some(z) = system.solve(&x) else { return false };
            if !z.iter().all(|x| *x > 0.0 && x.is_finite()) {
                return false;
            }
            let y = &m * &z;
            if (0..n).all(|i| y[i] < z[i] * (1.0 - 1e-9)) {
                return true;
            }
            let largest = z.max();
            x = (z / largest).map(|x| x.max(1e-290));
        }
        false
    }

    /// The certificate of a block; none where it has no regular box, or too many boxes to look at.
    fn certify(&self) -> Option<Certificate> {
        let n = self.columns.len();
        let full: Vec<(f64, f64)> = self
            .columns
            .iter()
            .map(|c| {
                let [lo, hi] = c.rho_floats;
                // Outward, so that the rounded box contains the exact one.
                ((lo + hi) / 2.0, if lo == hi { 0.0 } else { (hi - lo) / 2.0 * (1.0 + 1e-12) })
            })
            .collect();
        let (centre, radius): (Vec<f64>, Vec<f64>) = full.iter().copied().unzip();
        if n == 0 || self.regular(&centre, &radius) {
            return Some(Certificate::SpectralRadius);
        }
        // Split the box, widest column first. det B is affine in each ρ_j, so the vertices decide.
        let mut sign = 0i8;
        let mut open: Vec<Vec<Option<bool>>> = vec![vec![None; n]];
        let mut looked_at = 0;
        while let Some(fixed) = open.pop() {
            looked_at += 1;
            if looked_at > MOST_BOXES.min(WORK / (n * n * n)) {
                return None;
            }
            let vertex = |j: usize, p: bool| self.columns[j].rho[usize::from(!p)].clone();
            let at = |j: usize| fixed[j].map_or(full[j].0, |p| self.columns[j].rho_floats[usize::from(!p)]);
            let centre: Vec<f64> = (0..n).map(at).collect();
            let radius: Vec<f64> = (0..n).map(|j| if fixed[j].is_some() { 0.0 } else { full[j].1 }).collect();
            let widest = (0..n)
                .filter(|&j| radius[j] > 0.0)
                .max_by(|&i, &j| (radius[i] / centre[i]).total_cmp(&(radius[j] / centre[j])));
            if widest.is_none() || self.regular(&centre, &radius) {
                let here = exact::determinant(&self.exact_matrix(&|j| vertex(j, fixed[j].unwrap_or(true)))).sign();
                if here == 0 || (sign != 0 && here != sign) {
                    return None;
                }
                sign = here;
            } else if let Some(j) = widest {
                for p in [true, false] {
                    let mut half = fixed.clone();
                    half[j] = Some(p);
                    open.push(half);
                }
            }
        }
        Some(Certificate::Determinants)
    }

    /// Whether it matters which end of a column's element drives.
    fn is_moving(&self, j: usize) -> bool {
        let [p_drives, q_drives] = &self.columns[j].rho;
        p_drives != q_drives
    }

    /// Most elements of a block without certificate for which all patterns of drivers are tried.
    pub(crate) fn most_tried(&self) -> usize {
        let tried = self.parts.iter().filter(|p| !p.certificate.unique_for_every_load());
        tried.map(Self::moving).max().unwrap_or(0)
    }

    /// Elements whose sign matters.
    fn moving(&self) -> usize {
        (0..self.columns.len()).filter(|&j| self.is_moving(j)).count()
    }

    /// Every equilibrium under the torques `loads` (by node, exact, in any common unit).
    pub(crate) fn solve(&self, loads: &[Rational]) -> Answer {
        let t: Vec<Rational> = self.rows.iter().map(|&n| loads[n].clone()).collect();
        let t_float: Vec<f64> = t.iter().map(Rational::to_f64).collect();
        match self.certificate {
            Certificate::SpectralRadius | Certificate::Determinants | Certificate::Undecided => {
                let found = self.pivot(&t, &t_float);
                // A search that ran out of steps has proved nothing.
                let certificate = if found.is_some() { self.certificate } else { Certificate::Undecided };
                Answer { solutions: found.into_iter().collect(), certificate, stretches: vec![] }
            }
            Certificate::Enumeration => {
                let answer = self.enumerate(&t);
                if answer.certificate != Certificate::Undecided {
                    return answer;
                }
                Answer { solutions: self.pivot(&t, &t_float).into_iter().collect(), ..answer }
            }
        }
    }

    /// Pivoting from the pattern of the lossless train: first all wrong signs at once, which is
    /// quick and nearly always ends, then only the one of least index, which ends for certain
    /// under the W-property. `None` when the steps go round in a circle, or ran out.
    fn pivot(&self, t: &[Rational], t_float: &[f64]) -> Option<Solution> {
        let n = self.columns.len();
        let lossless = self.attempt(&vec![None; n], t, t_float)?;
        let mut pattern: Vec<bool> = (0..n).map(|j| lossless.signs[j] * self.columns[j].sigma >= 0).collect();
        let at_once = 8;
        let most = at_once + (1usize << n.min(12)).min(WORK / (n * n * n).max(1));
        let mut seen = HashSet::new();
        for step in 0..most {
            if step >= at_once && !seen.insert(pattern.clone()) {
                return None;
            }
            let choice: Vec<_> = pattern.iter().map(|p| Some(*p)).collect();
            let trial = self.attempt(&choice, t, t_float)?;
            let Some(first) = self.wrong(&trial, &pattern, 0) else { return Some(self.solution(trial, pattern)) };
            let mut next = Some(first);
            while let Some(j) = next {
                pattern[j] = !pattern[j];
                next = if step < at_once { self.wrong(&trial, &pattern, j + 1) } else { None };
            }
        }
        None
    }

    /// The first element, from `start` on, whose force contradicts the pattern.
    fn wrong(&self, trial: &Trial, pattern: &[bool], start: usize) -> Option<usize> {
        (start..pattern.len()).find(|&j| {
            let c = &self.columns[j];
            let drives = trial.signs[j] * c.sigma;
            self.is_moving(j) && if pattern[j] { drives < 0 } else { drives > 0 }
        })
    }

    fn exact_forces(&self, choice: &[Option<bool>], t: &[Rational]) -> Option<Vec<Rational>> {
        let n = self.columns.len();
        // What the blocks that are solved leave of the loads.
        let mut left = t.to_vec();
        let (mut forces, mut row_in) = (vec![Rational::ZERO; n], vec![None; n]);
        for Block { rows, columns } in &self.blocks {
            rows.iter().enumerate().for_each(|(k, &row)| row_in[row] = Some(k));
            let coefficients = |j: usize| {
                let rho = self.rho_exact(j, choice[j]);
                self.columns[j].entries.iter().map(move |(row, a, b)| (*row, a + &(b * &rho)))
            };
            let mut matrix = vec![vec![Rational::ZERO; rows.len()]; rows.len()];
            for (k, &j) in columns.iter().enumerate() {
                for (row, coefficient) in coefficients(j) {
                    if let Some(row) = row_in[row] {
                        matrix[row][k] = coefficient;
                    }
                }
            }
            let right: Vec<Rational> = rows.iter().map(|&row| left[row].clone()).collect();
            for (&j, force) in columns.iter().zip(exact::solve(&matrix, &right)?) {
                if !force.is_zero() {
                    coefficients(j).for_each(|(row, coefficient)| left[row] -= &coefficient * &force);
                }
                forces[j] = force;
            }
            rows.iter().for_each(|&row| row_in[row] = None);
        }
        Some(forces)
    }

    fn rho_exact(&self, j: usize, choice: Option<bool>) -> Rational {
        match choice {
            None => Rational::ONE,
            Some(p) => self.columns[j].rho[usize::from(!p)].clone(),
        }
    }

    /// Solves one pattern (`None`: lossless); signs of the forces are certain, by error bound or
    /// by exact arithmetic. `None` when the pattern is exactly singular.
    fn attempt(&self, choice: &[Option<bool>], t: &[Rational], t_float: &[f64]) -> Option<Trial> {
        let rho = |j: usize| choice[j].map_or(1.0, |p| self.columns[j].rho_floats[usize::from(!p)]);
        let exact = || -> Option<Trial> {
            let f = self.exact_forces(choice, t)?;
            let signs = f.iter().map(Rational::sign).collect();
            let forces: Vec<f64> = f.iter().map(Rational::to_f64).collect();
            Some(Trial { bounds: rounding(&forces), forces, signs, exact: Some(f) })
        };
        let Some((forces, bounds)) = self.certain_forces(&rho, t_float) else { return exact() };
        let signs = forces.iter().map(|x| if *x > 0.0 { 1 } else { -1 }).collect();
        Some(Trial { forces, bounds, signs, exact: None })
    }

    fn solution(&self, trial: Trial, pattern: Vec<bool>) -> Solution {
        let mut s = Solution {
            forces: vec![0.0; self.elements],
            errors: vec![0.0; self.elements],
            rho: vec![1.0; self.elements],
            exact: trial.exact.as_ref().map(|_| vec![Rational::ZERO; self.elements]),
            driver: vec![None; self.elements],
            pattern: pattern.clone(),
        };
        for (j, c) in self.columns.iter().enumerate() {
            s.forces[c.element] = trial.forces[j];
            s.errors[c.element] = trial.bounds[j];
            s.rho[c.element] = c.rho_floats[usize::from(!pattern[j])];
            s.driver[c.element] = match trial.signs[j] * c.sigma {
                0 => None,
                sign => Some(sign > 0),
            };
            if let (Some(all), Some(own)) = (&mut s.exact, &trial.exact) {
                all[c.element] = own[j].clone();
            }
        }
        s
    }
}

/// What one unit of force in an element asks of a node: a constant, and what is multiplied by ρ.
fn asked(c: &Configuration<'_>, element: usize, node: usize) -> [Rational; 2] {
    let e = &c.elements[element];
    let is_at = |member: MemberId| c.node(member) == Some(node);
    [(e.p, &e.a), (e.q, &e.b)].map(|(end, x)| match (is_at(end), is_at(e.carrier)) {
        (true, false) => x.clone(),
        (false, true) => -x,
        _ => Rational::ZERO,
    })
}

/// What one unit of force in an element asks of a node, with ρ as given.
fn coefficient(c: &Configuration<'_>, element: usize, rho: &Rational, node: usize) -> Rational {
    let [constant, slope] = asked(c, element, node);
    constant + &slope * rho
}

/// Torque that the elements ask of a node, from their forces.
pub(crate) fn torque(c: &Configuration<'_>, s: &Solution, node: usize) -> f64 {
    estimate(c, s, node).0
}

/// The same, and how far it may be from the exact one.
fn estimate(c: &Configuration<'_>, s: &Solution, node: usize) -> (f64, f64) {
    let (mut sum, mut error) = (0.0, 0.0);
    for (j, e) in c.elements.iter().enumerate() {
        let (a, b) = (e.a.to_f64(), e.b.to_f64() * s.rho[j]);
        for (member, coefficient) in [(e.p, a), (e.q, b), (e.carrier, -(a + b))] {
            if c.node(member) == Some(node) {
                let size = if member == e.carrier { a.abs() + b.abs() } else { coefficient.abs() };
                sum += s.forces[j] * coefficient;
                error += s.errors[j] * coefficient.abs() + ROUNDING * s.forces[j].abs() * size;
            }
        }
    }
    (sum, error)
}

/// Most forces that are solved together in rationals where no sign hangs on it.
const MOST_TOGETHER: usize = 16;

/// Relative rounding of the terms of a short sum of products.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Torque that the elements ask of a node, in rationals.
pub(crate) fn torque_exact(
    c: &Configuration<'_>,
    equilibrium: &Equilibrium,
    s: &Solution,
    forces: &[Rational],
    node: usize,
) -> Rational {
    let of = |j: usize| &forces[j] * &coefficient(c, j, &equilibrium.rho_of(s, j), node);
    (0..c.elements.len()).filter(|&j| !forces[j].is_zero()).fold(Rational::ZERO, |sum, j| sum + of(j))
}

impl Equilibrium {
    /// External torque on a node in a solution under `loads`, with a sign that is certain: where rounding leaves it
    /// open, the torque is worked out in rationals.
    pub(crate) fn balancing_torque(
        &self,
        c: &Configuration<'_>,
        s: &Solution,
        loads: &[Rational],
        node: usize,
    ) -> (f64, i8) {
        let given = loads[node].to_f64();
        let (sum, error) = estimate(c, s, node);
        let torque = sum - given;
        if torque.abs() > error + ROUNDING * given.abs() {
            return (torque, if torque > 0.0 { 1 } else { -1 });
        }
        let exact = s.exact.clone().or_else(|| self.exact_of(s, loads));
        // What was solved in floating point alone has no exact forces: those of elements at rest that were moved.
        let Some(forces) = exact else { return (torque, if torque == 0.0 { 0 } else { torque.signum() as i8 }) };
        let torque = &torque_exact(c, self, s, &forces, node) - &loads[node];
        (torque.to_f64(), torque.sign())
    }

    /// External torque on a node in a solution under `loads`, exactly; `None` where that takes long.
    pub(crate) fn exact_torque(
        &self,
        c: &Configuration<'_>,
        s: &Solution,
        loads: &[Rational],
        node: usize,
    ) -> Option<Rational> {
        let forces = s.exact.clone().or_else(|| self.exact_forces_of(s, loads))?;
        Some(&torque_exact(c, self, s, &forces, node) - &loads[node])
    }

    /// Exact forces of a solution, by element; `None` where so many are solved together that they take long.
    pub(crate) fn exact_forces_of(&self, s: &Solution, loads: &[Rational]) -> Option<Vec<Rational>> {
        let together = self.blocks.iter().map(|b| b.columns.len()).max().unwrap_or(0);
        (together <= MOST_TOGETHER).then(|| self.exact_of(s, loads)).flatten()
    }

    /// Exact forces of a solution, by element.
    fn exact_of(&self, s: &Solution, loads: &[Rational]) -> Option<Vec<Rational>> {
        let t: Vec<Rational> = self.rows.iter().map(|&n| loads[n].clone()).collect();
        let choice: Vec<_> = s.pattern.iter().map(|p| Some(*p)).collect();
        let mut all = vec![Rational::ZERO; self.elements];
        for (column, force) in self.columns.iter().zip(self.exact_forces(&choice, &t)?) {
            all[column.element] = force;
        }
        Some(all)
    }
}

/// Which nodes have an equation and which elements can carry a force at all.
///
/// An unloaded node that a single gear end touches carries no force: the element is idle. A carrier
/// may balance a force at a displaced point (its coefficient can vanish inside the box), so it does
/// not count as such an end unless its coefficient keeps its sign.
pub(crate) fn carrying(c: &Configuration<'_>, open: &[usize], loaded: &[usize]) -> (Vec<bool>, Vec<bool>) {
    let mut row_alive: Vec<bool> = (0..c.nodes).map(|n| !open.contains(&n)).collect();
    let mut alive = vec![true; c.elements.len()];
    // How many elements touch each node, and the last of them.
    let mut touching = vec![(0usize, 0usize); c.nodes];
    loop {
        touching.fill((0, 0));
        for (j, e) in c.elements.iter().enumerate().filter(|(j, _)| alive[*j]) {
            let nodes: [Node; 3] = [c.node(e.p), c.node(e.q), c.node(e.carrier)];
            let is_first = |k: &usize| !nodes[..*k].contains(&nodes[*k]);
            (0..3).filter(is_first).filter_map(|k| nodes[k]).for_each(|n| touching[n] = (touching[n].0 + 1, j));
        }
        let mut changed = false;
        for n in 0..c.nodes {
            if !row_alive[n] || loaded.contains(&n) {
                continue;
            }
            match touching[n] {
                (0, _) => {
                    row_alive[n] = false;
                    changed = true;
                }
                (1, j) if alive[j] && keeps_sign(c, j, n) => {
                    alive[j] = false;
                    row_alive[n] = false;
                    changed = true;
                }
                _ => {}
            }
        }
        if !changed {
            break;
        }
    }
    (row_alive, alive)
}

/// Forces for one pattern.
struct Trial {
    forces: Vec<f64>,
    /// How far each may be from the exact one.
    bounds: Vec<f64>,
    signs: Vec<i8>,
    exact: Option<Vec<Rational>>,
}

/// By this part the bounds on ρ of neighbouring points may differ from those of the first.
const MORE: f64 = 0.02;

/// Rounding of exact numbers to floating point.
fn rounding(rounded: &[f64]) -> Vec<f64> {
    rounded.iter().map(|x| f64::EPSILON * x.abs()).collect()
}

/// Whether the coefficient of node `n` in element `j` is non-zero for every efficiency in the box.
fn keeps_sign(c: &Configuration<'_>, j: usize, n: usize) -> bool {
    let [constant, slope] = asked(c, j, n);
    // Terms of one sign have no zero between them, as ρ is positive.
    if constant.sign() * slope.sign() >= 0 {
        return !(constant.is_zero() && slope.is_zero());
    }
    let e = &c.elements[j];
    let at = |rho: &Rational| (&constant + &(&slope * rho)).sign();
    let (low, high) = (at(&e.forward), at(&e.backward.recip()));
    low != 0 && low == high
}

/// The equations in floating point, for the compiled train.
pub(crate) struct System {
    /// Node of each row.
    pub rows: Vec<usize>,
    pub columns: Vec<SystemColumn>,
}

/// One element: its index, ρ when p or q drives, and (row, constant part, part times ρ).
pub(crate) struct SystemColumn {
    pub element: usize,
    pub rho: [f64; 2],
    pub entries: Vec<(usize, f64, f64)>,
}

impl Equilibrium {
    /// Whether no system with each column's ρ between its bounds is singular, as far as one bound
    /// on the spectral radius shows.
    pub(crate) fn regular_between(&self, bounds: &[[f64; 2]]) -> bool {
        let (centre, radius): (Vec<f64>, Vec<f64>) =
            bounds.iter().map(|[lo, hi]| ((lo + hi) / 2.0, (hi - lo) / 2.0 * (1.0 + 1e-12))).unzip();
        self.regular(&centre, &radius)
    }

    /// The same where a larger box may be known to be so: the first that is found is kept for the next question.
    fn regular_within(&self, bounds: &[[f64; 2]], known: &OnceLock<Vec<[f64; 2]>>) -> bool {
        let inside =
            |wide: &Vec<[f64; 2]>| bounds.iter().zip(wide).all(|(own, wide)| wide[0] <= own[0] && own[1] <= wide[1]);
        match known.get() {
            Some(wide) if inside(wide) => true,
            Some(_) => self.regular_between(bounds),
            None => {
                let wide: Vec<[f64; 2]> =
                    bounds.iter().map(|[low, high]| [low * (1.0 - MORE), high * (1.0 + MORE)]).collect();
                if self.regular_between(&wide) {
                    // Another thread may have been first; either is one.
                    let _ = known.set(wide);
                    return true;
                }
                self.regular_between(bounds)
            }
        }
    }

    /// Whether rounding leaves no doubt that, with ρ between these bounds (first end driving, second end driving, by column)
    /// and these torques by row, one solution exists for every load, and that in that of this load the ends of `columns` drive.
    /// `regular` keeps what was proved of other bounds.
    pub(crate) fn is_only(
        &self,
        columns: &[SolvedColumn],
        rho: &[[f64; 2]],
        torques: &[f64],
        regular: &OnceLock<Vec<[f64; 2]>>,
    ) -> bool {
        let bounds: Vec<[f64; 2]> = rho.iter().map(|[p, q]| [p.min(*q), p.max(*q)]).collect();
        let own = |j: usize| rho[j][usize::from(columns[j].p_drives == Some(false))];
        let as_taken = |j: usize, force: f64| {
            let drives = force * f64::from(self.columns[j].sigma);
            rho[j][0] == rho[j][1] || columns[j].p_drives == Some(drives > 0.0)
        };
        self.regular_within(&bounds, regular)
            && match self.columns.len() {
                // The meshes of one set, and of two: they are many points of a study. What is loaded into a browser is small.
                #[cfg(not(target_family = "wasm"))]
                2 => self.are_certain(Const::<2>, &own, torques, as_taken),
                #[cfg(not(target_family = "wasm"))]
                4 => self.are_certain(Const::<4>, &own, torques, as_taken),
                n => self.are_certain(Dyn(n), &own, torques, as_taken),
            }
    }

    pub(crate) fn system(&self) -> System {
        let columns = self
            .columns
            .iter()
            .map(|c| SystemColumn { element: c.element, rho: c.rho_floats, entries: c.floats.clone() })
            .collect();
        System { rows: self.rows.clone(), columns }
    }
}

/// One element of a solved problem: which end drives (none at rest), and (row, constant part, part times ρ).
#[derive(Clone, Debug)]
pub(crate) struct SolvedColumn {
    pub element: usize,
    pub p_drives: Option<bool>,
    pub entries: Vec<(usize, f64, f64)>,
}

/// What a solution's pattern says beyond the solution itself.
impl Equilibrium {
    /// The linear equations that a solution obeys: the node of each row, and the columns.
    pub(crate) fn solved(&self, solution: &Solution) -> (Vec<usize>, Vec<SolvedColumn>) {
        let column = |(c, p): (&Column, &bool)| SolvedColumn {
            element: c.element,
            p_drives: (c.sigma != 0).then_some(*p),
            entries: c.floats.clone(),
        };
        (self.rows.clone(), self.columns.iter().zip(&solution.pattern).map(column).collect())
    }

    /// ρ of an element of the configuration in a solution, exactly.
    pub(crate) fn rho_of(&self, solution: &Solution, element: usize) -> Rational {
        let column = self.columns.iter().position(|c| c.element == element);
        column.map_or(Rational::ONE, |j| self.rho_exact(j, Some(solution.pattern[j])))
    }

    /// A solution of another problem on the same train, seen in this problem: same drivers. `None`
    /// when this problem has an element that is idle there.
    pub(crate) fn same_pattern(&self, other: &Solution) -> Option<Solution> {
        let pattern: Option<Vec<bool>> =
            self.columns.iter().map(|c| if c.sigma == 0 { Some(true) } else { other.driver[c.element] }).collect();
        Some(Solution { pattern: pattern?, ..other.clone() })
    }

    /// The solution with other values of ρ in some elements (those at rest), in floating point.
    pub(crate) fn with_rho(&self, s: &Solution, rho: &[(usize, f64)], loads: &[Rational]) -> Option<Solution> {
        let own = |j: usize| {
            let element = self.columns[j].element;
            let given = rho.iter().find(|(e, _)| *e == element).map(|(_, r)| *r);
            given.unwrap_or(self.columns[j].rho_floats[usize::from(!s.pattern[j])])
        };
        let t: Vec<f64> = self.rows.iter().map(|&n| loads[n].to_f64()).collect();
        let f = self.forces(&own, &t)?;
        let mut shifted = Solution { exact: None, ..s.clone() };
        for (j, c) in self.columns.iter().enumerate() {
            shifted.forces[c.element] = f[j];
            shifted.errors[c.element] = 0.0;
            shifted.rho[c.element] = own(j);
        }
        Some(shifted)
    }
}

/// How far a solution is from a change of its sign pattern, or from locking.
impl Equilibrium {
    /// `∂f_j/∂t_n` for the solution's pattern: by element, for each of `nodes`; zero where a node
    /// has no row.
    pub(crate) fn sensitivity(&self, solution: &Solution, nodes: &[usize]) -> Option<Vec<(usize, Vec<f64>)>> {
        let rho = |j: usize| self.columns[j].rho_floats[usize::from(!solution.pattern[j])];
        let row = |n: &usize| self.rows.iter().position(|r| r == n);
        let rows: Vec<Option<usize>> = nodes.iter().map(row).collect();
        let changes = self.changes(&rho, &rows)?;
        let of = |(j, c): (usize, &Column)| (c.element, changes.iter().map(|change| change[j]).collect());
        Some(self.columns.iter().enumerate().map(of).collect())
    }

    /// Efficiency of each moving element at which the pattern's determinant vanishes, all others
    /// unchanged: the train locks there. Only thresholds between 0 and the present efficiency.
    pub(crate) fn lock_thresholds(&self, solution: &Solution) -> Vec<(usize, f64)> {
        let rho = |j: usize| self.columns[j].rho_floats[usize::from(!solution.pattern[j])];
        let Some(slopes) = self.own_slopes(&rho) else { return vec![] };
        let mut all = Vec::new();
        for (j, c) in self.columns.iter().enumerate().filter(|(_, c)| c.sigma != 0) {
            // det B(ρ*)/det B(ρ) = 1 + (ρ* − ρ) (B⁻¹ d)_j vanishes.
            let slope = slopes[j];
            if slope == 0.0 || solution.driver[c.element].is_none() {
                continue;
            }
            let at = rho(j) - 1.0 / slope;
            let (eta, now) = if solution.pattern[j] { (at, rho(j)) } else { (1.0 / at, 1.0 / rho(j)) };
            // A threshold of zero (round-off) is no threshold.
            if eta > 1e-9 && eta < now {
                all.push((c.element, eta));
            }
        }
        all
    }

    /// The factor on all losses `1 − η` at which the pattern's determinant vanishes.
    pub(crate) fn lock_factor(&self, solution: &Solution) -> Option<f64> {
        let eta = |j: usize, factor: f64| {
            let r = self.columns[j].rho_floats[usize::from(!solution.pattern[j])];
            if solution.pattern[j] { 1.0 - factor * (1.0 - r) } else { 1.0 - factor * (1.0 - 1.0 / r) }
        };
        let n = self.columns.len();
        let determinant = |factor: f64| {
            self.determinant(&|j| {
                let e = eta(j, factor);
                if solution.pattern[j] { e } else { 1.0 / e }
            })
        };
        let start = determinant(1.0);
        let (mut low, mut high) = (1.0, 1.0);
        loop {
            high *= 1.1;
            if (0..n).any(|j| eta(j, high) <= 0.0) || high > 1e6 {
                return None;
            }
            if determinant(high) * start <= 0.0 {
                break;
            }
            low = high;
        }
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if determinant(middle) * start > 0.0 { low = middle } else { high = middle }
        }
        Some(low)
    }
}
