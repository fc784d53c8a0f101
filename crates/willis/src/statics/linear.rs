//! The linear equations of one pattern of drivers, in floating point, with bounds of what rounding may do.
//!
//! Few equations are solved together. Of a long train they are solved block by block: what the forces of one block leave of
//! the loads is the load of the next, so that the work grows with the length of the train and not with its cube.

use nalgebra::allocator::Allocator;
use nalgebra::{Const, DMatrix, DVector, DefaultAllocator, Dim, Dyn, OMatrix, OVector};

use crate::exact::blocks::Block;

use super::{Equilibrium, MOST_TOGETHER};

/// Rounding of a coefficient with its product, relative to the terms that it is made of.
const UNIT: f64 = 4.0 * f64::EPSILON;

/// Which equations are solved together for which unknowns, in this order.
pub(super) fn groups(blocks: &[Block]) -> Vec<Block> {
    let n = blocks.iter().map(|b| b.rows.len()).sum();
    match n <= MOST_TOGETHER {
        true => vec![Block { rows: (0..n).collect(), columns: (0..n).collect() }],
        false => blocks.to_vec(),
    }
}

/// What stands in the equations: a constant part and one with ρ; and the size of both, by which rounding is measured.
fn coefficient(constant: f64, changing: f64) -> f64 {
    constant + changing
}

fn size(constant: f64, changing: f64) -> f64 {
    constant.abs() + changing.abs()
}

impl Equilibrium {
    pub(super) fn float_matrix(&self, rho: &dyn Fn(usize) -> f64) -> DMatrix<f64> {
        self.matrix_of(Dyn(self.columns.len()), rho, coefficient)
    }

    /// The sizes of the terms that the entries of that matrix are sums of: what rounding is measured by. Where a basic ratio
    /// is near one the terms of a carrier nearly cancel, and an entry may be all round-off.
    pub(super) fn sizes(&self, rho: &dyn Fn(usize) -> f64) -> DMatrix<f64> {
        self.matrix_of(Dyn(self.columns.len()), rho, size)
    }

    /// A matrix whose entries are made of constant and changing parts; of a size that may be known beforehand: it is kept
    /// where it is made then.
    fn matrix_of<D: Dim>(&self, n: D, rho: &dyn Fn(usize) -> f64, entry: impl Fn(f64, f64) -> f64) -> OMatrix<f64, D, D>
    where
        DefaultAllocator: Allocator<D, D>,
    {
        let mut m = OMatrix::zeros_generic(n, n);
        for (j, column) in self.columns.iter().enumerate() {
            let rho = rho(j);
            for &(r, constant, slope) in &column.floats {
                m[(r, j)] = entry(constant, slope * rho);
            }
        }
        m
    }

    /// Each group, with the place of each of its rows.
    fn each_group(&self, mut see: impl FnMut(&Block, &[Option<usize>]) -> Option<()>) -> Option<()> {
        let mut row_in = vec![None; self.rows.len()];
        for block in &self.groups {
            block.rows.iter().enumerate().for_each(|(k, &row)| row_in[row] = Some(k));
            see(block, &row_in)?;
            block.rows.iter().for_each(|&row| row_in[row] = None);
        }
        Some(())
    }

    /// A matrix of a group, whose entries are made of constant and changing parts.
    fn of_group(
        &self,
        block: &Block,
        row_in: &[Option<usize>],
        rho: &dyn Fn(usize) -> f64,
        entry: fn(f64, f64) -> f64,
    ) -> DMatrix<f64> {
        let mut m = DMatrix::zeros(block.rows.len(), block.rows.len());
        for (k, &j) in block.columns.iter().enumerate() {
            let rho = rho(j);
            for &(r, constant, slope) in &self.columns[j].floats {
                if let Some(r) = row_in[r] {
                    m[(r, k)] = entry(constant, slope * rho);
                }
            }
        }
        m
    }

    /// The matrices of all groups.
    fn group_matrices(&self, rho: &dyn Fn(usize) -> f64) -> Vec<DMatrix<f64>> {
        let mut all = Vec::with_capacity(self.groups.len());
        self.each_group(|block, row_in| {
            all.push(self.of_group(block, row_in, rho, coefficient));
            Some(())
        });
        all
    }

    /// Forces under the loads `t` where rounding leaves no doubt about any sign, and how far each may be from the exact one.
    pub(super) fn certain_forces(&self, rho: &dyn Fn(usize) -> f64, t: &[f64]) -> Option<(Vec<f64>, Vec<f64>)> {
        let n = self.columns.len();
        let (mut forces, mut bounds) = (vec![0.0; n], vec![0.0; n]);
        // What is left of the loads, and how far that may be off.
        let (mut left, mut off) = (t.to_vec(), vec![0.0; n]);
        self.each_group(|block, row_in| {
            let [matrix, sizes] = [coefficient, size].map(|entry| self.of_group(block, row_in, rho, entry));
            let of = |all: &[f64]| DVector::from_iterator(block.rows.len(), block.rows.iter().map(|&row| all[row]));
            let (own, own_bounds) = certain(&matrix, &sizes, &of(&left), Some(&of(&off)))?;
            for (k, &j) in block.columns.iter().enumerate() {
                let (f, rho) = (own[k], rho(j));
                (forces[j], bounds[j]) = (f, own_bounds[k]);
                for &(row, constant, slope) in &self.columns[j].floats {
                    let (coefficient, size) = (coefficient(constant, slope * rho), size(constant, slope * rho));
                    off[row] +=
                        UNIT * (size * f.abs() + left[row].abs()) + coefficient.abs() * bounds[j] * (1.0 + 1e-9);
                    left[row] -= coefficient * f;
                }
            }
            Some(())
        })?;
        Some((forces, bounds))
    }

    /// Forces under the loads `t`, as far as floating point goes; `None` where the equations are singular.
    pub(super) fn forces(&self, rho: &dyn Fn(usize) -> f64, t: &[f64]) -> Option<Vec<f64>> {
        let matrices = self.group_matrices(rho);
        self.substitute(rho, t, |k, right| matrices[k].clone().lu().solve(right))
    }

    /// By how much the forces change with the load of each of these rows; by nothing where there is none.
    pub(super) fn changes(&self, rho: &dyn Fn(usize) -> f64, rows: &[Option<usize>]) -> Option<Vec<Vec<f64>>> {
        let inverses = self.group_matrices(rho).into_iter().map(DMatrix::try_inverse).collect::<Option<Vec<_>>>()?;
        let n = self.columns.len();
        let change = |row: &Option<usize>| {
            let Some(row) = *row else { return Some(vec![0.0; n]) };
            let mut t = vec![0.0; n];
            t[row] = 1.0;
            self.substitute(rho, &t, |k, right| Some(&inverses[k] * right))
        };
        rows.iter().map(change).collect()
    }

    /// Solves group after group, each by `solve` with what those before it leave of the loads `t`.
    fn substitute(
        &self,
        rho: &dyn Fn(usize) -> f64,
        t: &[f64],
        solve: impl Fn(usize, &DVector<f64>) -> Option<DVector<f64>>,
    ) -> Option<Vec<f64>> {
        let (mut forces, mut left) = (vec![0.0; t.len()], t.to_vec());
        for (k, block) in self.groups.iter().enumerate() {
            let right = DVector::from_iterator(block.rows.len(), block.rows.iter().map(|&row| left[row]));
            let own = solve(k, &right)?;
            for (&j, &f) in block.columns.iter().zip(&own) {
                forces[j] = f;
                let rho = rho(j);
                self.columns[j].floats.iter().for_each(|&(r, a, b)| left[r] -= coefficient(a, b * rho) * f);
            }
        }
        Some(forces)
    }

    /// `(B⁻¹ ∂B/∂ρ_j)_j` of each column. No force depends on the loads of a group that is solved later, so its own group is
    /// enough. `None` where the equations are singular.
    pub(super) fn own_slopes(&self, rho: &dyn Fn(usize) -> f64) -> Option<Vec<f64>> {
        let mut slopes = vec![0.0; self.columns.len()];
        self.each_group(|block, row_in| {
            let inverse = self.of_group(block, row_in, rho, coefficient).try_inverse()?;
            for (k, &j) in block.columns.iter().enumerate() {
                let inside = self.columns[j].floats.iter().filter_map(|&(r, _, slope)| Some((row_in[r]?, slope)));
                slopes[j] = inside.map(|(r, slope)| inverse[(k, r)] * slope).sum();
            }
            Some(())
        })?;
        Some(slopes)
    }

    /// The determinant but for a sign that does not depend on ρ: the product of those of the groups.
    pub(super) fn determinant(&self, rho: &dyn Fn(usize) -> f64) -> f64 {
        let mut product = 1.0;
        self.each_group(|block, row_in| {
            product *= self.of_group(block, row_in, rho, coefficient).determinant();
            Some(())
        });
        product
    }

    /// Whether the forces with these ρ are certain, each of them as is asked.
    pub(super) fn are_certain<D: Dim>(
        &self,
        n: D,
        rho: &dyn Fn(usize) -> f64,
        torques: &[f64],
        asked: impl Fn(usize, f64) -> bool,
    ) -> bool
    where
        DefaultAllocator: Allocator<D, D> + Allocator<D>,
    {
        let torques = OVector::from_column_slice_generic(n, Const::<1>, torques);
        certain(&self.matrix_of(n, rho, coefficient), &self.matrix_of(n, rho, size), &torques, None)
            .is_some_and(|(forces, _)| forces.iter().enumerate().all(|(j, force)| asked(j, *force)))
    }
}

/// Solves `b f = t` where rounding leaves no doubt about any sign: the forces, and how far each may be from the exact one.
/// `sizes` are those of the terms that the entries of `b` are sums of; `t` may be `off` by so much beside its rounding.
fn certain<D: Dim>(
    b: &OMatrix<f64, D, D>,
    sizes: &OMatrix<f64, D, D>,
    t: &OVector<f64, D>,
    off: Option<&OVector<f64, D>>,
) -> Option<(OVector<f64, D>, OVector<f64, D>)>
where
    DefaultAllocator: Allocator<D, D> + Allocator<D>,
{
    let n = t.len();
    let inverse = b.clone().try_inverse()?;
    let mut f = &inverse * t;
    f += &inverse * (t - b * &f);
    // With D = I − R B and v = |R| |residual|: |f − f*| ≤ v + |D| v + |D|² v + …, rounding of the residual and of the
    // entries of B included.
    let unit = 4.0 * (n as f64 + 2.0) * f64::EPSILON;
    let mut residual = (t - b * &f).abs() + (sizes * f.abs() + t.abs()) * unit;
    if let Some(off) = off {
        residual += off;
    }
    let defects = (OMatrix::identity_generic(b.shape_generic().0, b.shape_generic().1) - &inverse * b).abs()
        + inverse.abs() * sizes * unit;
    let defect = defects.column_sum().max() + 1e-12;
    let v = inverse.abs() * residual;
    let bound = v.add_scalar(v.max() * defect / (1.0 - defect).max(1e-300)) * (1.0 + 1e-9);
    // NaN fails both comparisons.
    let certain = defect < 0.1 && (0..n).all(|j| f[j].abs() > bound[j]);
    certain.then_some((f, bound))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::Rational;
    use crate::kinematics::Configuration;
    use crate::train::{MemberId, SetSpec, Train};
    use crate::units::AngularSpeed;

    /// Sets in series, with teeth, losses and directions by chance; every third set leaves a shaft to a load.
    fn chain(sets: usize, random: &mut dyn FnMut(usize) -> usize) -> Train {
        let shafts: Vec<String> = (0..=sets).map(|k| format!("s{k}")).collect();
        let mut free = vec![true; sets + 1];
        let mut train = Train::builder("chain").members(shafts.iter().map(String::as_str));
        for k in 0..sets {
            let from = if k % 3 == 2 { k - 1 } else { k };
            free[from] = false;
            let sun = (shafts[from].as_str(), 20 + random(20) as i64);
            let ring = ("frame", 60 + random(40) as i64);
            let set = SetSpec::simple(format!("P{k}"), sun, ring, &shafts[k + 1]);
            train = train.set(set.basic_efficiency(0.9 + 0.1 * random(1000) as f64 / 1000.0));
        }
        let ends = (0..=sets).filter(|&k| k == 0 || free[k]).map(|k| shafts[k].as_str());
        train.terminals(ends).build().unwrap()
    }

    #[test]
    fn block_by_block_is_as_all_at_once_and_within_the_bounds() {
        let mut seed = 3u64;
        let mut random = |below: usize| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 33) as usize % below
        };
        for sets in [17, 20, 25, 40] {
            let train = chain(sets, &mut random);
            let c = Configuration::new(&train, &[], &[], &[]);
            let [input, others @ ..] = train.terminals() else { panic!("terminals") };
            let motion = c.motion(&[(*input, AngularSpeed::rpm(1.0).0)]).unwrap();
            let sigma: Vec<_> = c.elements.iter().map(|e| c.sigma(e, &motion)).collect();
            let node = |m: &MemberId| c.node(*m).unwrap();
            let loaded: Vec<usize> = others.iter().map(node).collect();
            let equilibrium = Equilibrium::new(&c, &sigma, &[node(input)], &loaded).unwrap();
            assert!(equilibrium.groups.len() > 1);
            let n = equilibrium.columns.len();
            let all = Block { rows: (0..n).collect(), columns: (0..n).collect() };
            let whole = Equilibrium { groups: vec![all], ..equilibrium.clone() };
            let mut loads = vec![Rational::ZERO; c.nodes];
            loaded.iter().for_each(|&n| loads[n] = Rational::new(random(200) as i64 - 100, 7));
            let [solution] = &equilibrium.solve(&loads).solutions[..] else { panic!("one equilibrium") };
            let exact = equilibrium.exact_of(solution, &loads).unwrap();
            let rho = |j: usize| equilibrium.columns[j].rho_floats[usize::from(!solution.pattern[j])];
            let t: Vec<f64> = equilibrium.rows.iter().map(|&n| loads[n].to_f64()).collect();
            for way in [&equilibrium, &whole] {
                let Some((forces, bounds)) = way.certain_forces(&rho, &t) else { continue };
                for (j, column) in way.columns.iter().enumerate() {
                    let own = exact[column.element].to_f64();
                    let within = bounds[j] + f64::EPSILON * own.abs();
                    assert!((forces[j] - own).abs() <= within, "{} {own} {within}", forces[j]);
                    assert!(bounds[j] <= 1e-6 * own.abs(), "{} {own}", bounds[j]);
                }
            }
            let near = |a: f64, b: f64| (a - b).abs() <= 1e-9 * (a.abs() + b.abs());
            let all_near = |a: Vec<f64>, b: Vec<f64>| a.into_iter().zip(b).all(|(a, b)| near(a, b));
            assert!(all_near(equilibrium.forces(&rho, &t).unwrap(), whole.forces(&rho, &t).unwrap()));
            assert!(all_near(equilibrium.own_slopes(&rho).unwrap(), whole.own_slopes(&rho).unwrap()));
            let rows = [None, Some(0), Some(sets / 2)];
            let changes = [&equilibrium, &whole].map(|e| e.changes(&rho, &rows).unwrap().concat());
            let [blocks, at_once] = changes;
            assert!(all_near(blocks, at_once));
            assert!(near(equilibrium.determinant(&rho).abs(), whole.determinant(&rho).abs()));
        }
    }
}
