//! The equations as columns, exact and scaled by powers of two, and what their unknowns mean.

use std::collections::BTreeMap;

use crate::exact::{self, Matrix, Rational};

use super::motion::{Amount, Motion};
use super::problem::{Body, Load, Problem};

/// An entry of a column.
#[derive(Clone, Debug)]
pub(super) struct Entry {
    pub row: usize,
    /// Scaled and rounded.
    pub value: f64,
    pub exact: Rational,
    /// The exact value modulo the prime.
    pub residue: u64,
}

/// Unknowns of a mesh.
#[derive(Clone, Debug)]
pub(super) struct MeshPlaces {
    /// `f` and `e`.
    pub forces: [usize; 2],
    /// `h₊` and `h₋`; none where nothing is lost.
    pub parts: Option<[usize; 2]>,
    /// `[α₊, α₋]` and `[u, v]` of a lossy mesh at rest.
    pub rest: Option<[[usize; 2]; 2]>,
    slip_row: usize,
    /// What is lost each way and back, `1 − P`.
    pub lost: Rational,
    pub slip: i8,
}

/// Unknowns of an element: its torque, and for each direction in which it yields `α` and the spare torque.
#[derive(Clone, Debug)]
pub(super) struct ElementPlaces {
    pub torque: usize,
    pub yields: [Option<[usize; 2]>; 2],
    motion_row: usize,
    yield_rows: [usize; 2],
}

/// The equations: as many rows as free unknowns and pairs together.
#[derive(Clone, Debug)]
pub(super) struct Equations {
    pub rows: usize,
    members: usize,
    /// The entries of each, in ascending order of rows.
    pub columns: Vec<Vec<Entry>>,
    /// The other unknown of the pair of each; none for those free of sign, which are always basic.
    pub partner: Vec<Option<usize>>,
    /// The mesh at rest that each unknown belongs to, if its equation of friction can slave it.
    pub rests: Vec<Option<usize>>,
    /// What is left of a force before something slips.
    pub is_spare: Vec<bool>,
    pub meshes: Vec<MeshPlaces>,
    pub elements: Vec<ElementPlaces>,
    /// Powers of two by which rows and unknowns are multiplied.
    row_scale: Vec<f64>,
    pub column_scale: Vec<f64>,
    /// Combinations of prescribed accelerations that must vanish.
    agreements: Vec<Vec<(usize, f64)>>,
    /// Rows of motion that a redundancy has taken, which prescribe nothing.
    replaced: Vec<bool>,
}

/// Columns while they are collected.
#[derive(Default)]
struct Builder {
    columns: Vec<BTreeMap<usize, Rational>>,
    partner: Vec<Option<usize>>,
    rests: Vec<Option<usize>>,
    rows: usize,
}

impl Builder {
    fn unknown(&mut self) -> usize {
        self.columns.push(BTreeMap::new());
        self.partner.push(None);
        self.rests.push(None);
        self.columns.len() - 1
    }

    fn pair(&mut self) -> [usize; 2] {
        let [a, b] = [self.unknown(), self.unknown()];
        (self.partner[a], self.partner[b]) = (Some(b), Some(a));
        [a, b]
    }

    fn row(&mut self) -> usize {
        self.rows += 1;
        self.rows - 1
    }

    fn add(&mut self, row: usize, unknown: usize, value: &Rational) {
        *self.columns[unknown].entry(row).or_insert(Rational::ZERO) += value.clone();
    }

    /// In the row of a body, or the column of its acceleration: both are numbered as the members are.
    fn add_force(&mut self, body: Body, unknown: usize, value: &Rational) {
        if let Some(body) = body {
            self.add(body, unknown, value);
        }
    }

    fn add_acceleration(&mut self, row: usize, body: Body, value: &Rational) {
        if let Some(body) = body {
            self.add(row, body, value);
        }
    }
}

impl Equations {
    pub fn new(problem: &Problem) -> Self {
        let n = problem.members;
        let (one, minus) = (Rational::ONE, -Rational::ONE);
        let mut b = Builder::default();
        for _ in 0..n {
            b.unknown();
            b.row();
        }
        for inertia in &problem.inertias {
            let value = Rational::from_f64(inertia.value).unwrap_or(Rational::ZERO);
            b.add(inertia.member, inertia.member, &value);
            if let Some(reference) = inertia.reference {
                b.add(reference, reference, &value);
                b.add(inertia.member, reference, &-&value);
                b.add(reference, inertia.member, &-&value);
            }
        }
        // Rows of motion, the exact coefficients of the accelerations in them, and the unknown that turns with each.
        let mut motion: Vec<(usize, Vec<Rational>, usize, Rational)> = Vec::new();
        let mut meshes = Vec::new();
        for mesh in &problem.meshes {
            let [first, second, carrier] = mesh.bodies;
            let [z1, z2] = &mesh.factors;
            let row = b.row();
            let forces = [b.unknown(), b.unknown()];
            for (k, body) in [first, second].into_iter().enumerate() {
                let z = &mesh.factors[k];
                b.add_force(body, forces[k], z);
                b.add_force(carrier, forces[k], &-z);
            }
            let mut form = vec![Rational::ZERO; n];
            for (body, value) in [(first, z1.clone()), (second, z2.clone()), (carrier, -(z1 + z2))] {
                if let Some(body) = body {
                    form[body] += value;
                }
            }
            motion.push((row, form, forces[0], one.clone()));
            let product = &mesh.efficiency[0] * &mesh.efficiency[1];
            if product == one {
                let equal = b.row();
                b.add(equal, forces[0], &one);
                b.add(equal, forces[1], &minus);
                meshes.push(MeshPlaces {
                    forces,
                    parts: None,
                    rest: None,
                    slip_row: 0,
                    lost: Rational::ZERO,
                    slip: mesh.slip,
                });
                continue;
            }
            let parts = b.pair();
            let [f_row, e_row] = [b.row(), b.row()];
            b.add(f_row, forces[0], &one);
            b.add(f_row, parts[0], &-&mesh.efficiency[1]);
            b.add(f_row, parts[1], &mesh.efficiency[1]);
            b.add(e_row, forces[1], &one);
            let (drive, coast) = if mesh.slip < 0 { (&one, &product) } else { (&product, &one) };
            b.add(e_row, parts[0], &-drive);
            b.add(e_row, parts[1], coast);
            let lost = &one - &product;
            let (mut rest, mut its_slip) = (None, 0);
            if mesh.slip == 0 {
                let ([ahead, u], [back, v]) = (b.pair(), b.pair());
                let [slip_row, friction] = [b.row(), b.row()];
                b.add(e_row, u, &minus);
                b.add(slip_row, ahead, &one);
                b.add(slip_row, back, &minus);
                b.add_acceleration(slip_row, first, &-z1);
                b.add_acceleration(slip_row, carrier, z1);
                b.add(friction, u, &one);
                b.add(friction, v, &one);
                b.add(friction, parts[0], &-&lost);
                b.add(friction, parts[1], &-&lost);
                for x in [parts[0], parts[1], u, v] {
                    b.rests[x] = Some(meshes.len());
                }
                rest = Some([[ahead, back], [u, v]]);
                its_slip = slip_row;
            }
            meshes.push(MeshPlaces { forces, parts: Some(parts), rest, slip_row: its_slip, lost, slip: mesh.slip });
        }
        let mut elements = Vec::new();
        for element in &problem.elements {
            let [first, second] = element.bodies;
            let row = b.row();
            let torque = b.unknown();
            b.add_force(first, torque, &minus);
            b.add_force(second, torque, &one);
            let mut form = vec![Rational::ZERO; n];
            for (body, value) in [(first, &one), (second, &minus)] {
                if let Some(body) = body {
                    form[body] += value.clone();
                }
            }
            let mut places = ElementPlaces { torque, yields: [None; 2], motion_row: row, yield_rows: [0; 2] };
            if element.yields == [false; 2] {
                motion.push((row, form, torque, minus.clone()));
            } else {
                for (body, value) in form.iter().enumerate().filter(|(_, v)| !v.is_zero()) {
                    b.add(row, body, value);
                }
            }
            for k in (0..2).filter(|&k| element.yields[k]) {
                let [slip, spare] = b.pair();
                let [along, against] = if k == 0 { [&minus, &minus] } else { [&one, &one] };
                b.add(row, slip, along);
                let spare_row = b.row();
                b.add(spare_row, spare, &one);
                b.add(spare_row, torque, against);
                places.yields[k] = Some([slip, spare]);
                places.yield_rows[k] = spare_row;
            }
            elements.push(places);
        }
        let mut replaced = vec![false; b.rows];
        let mut agreements = Vec::new();
        for y in dependencies(&motion) {
            let (last, _) = y.last().expect("not empty").clone();
            agreements.push(y.iter().map(|(k, y)| (motion[*k].0, y.to_f64())).collect());
            let row = motion[last].0;
            replaced[row] = true;
            for (k, y) in y {
                let (_, _, unknown, sign) = &motion[k];
                b.add(row, *unknown, &(&y * sign));
            }
        }
        for (row, form, ..) in &motion {
            for (body, value) in form.iter().enumerate().filter(|(_, v)| !replaced[*row] && !v.is_zero()) {
                b.add(*row, body, value);
            }
        }
        let mut is_spare = vec![false; b.columns.len() + 1];
        let rests = meshes.iter().filter_map(|m: &MeshPlaces| m.rest).flat_map(|[_, spares]| spares);
        let yields = elements.iter().flat_map(|e: &ElementPlaces| e.yields).flatten().map(|[_, spare]| spare);
        rests.chain(yields).for_each(|j| is_spare[j] = true);
        let mut equations = Self {
            rows: b.rows,
            is_spare,
            members: n,
            columns: b.columns.into_iter().map(entries).collect(),
            partner: b.partner,
            rests: b.rests,
            meshes,
            elements,
            row_scale: vec![1.0; b.rows],
            column_scale: Vec::new(),
            agreements,
            replaced,
        };
        equations.scale();
        // Room for the covering column, which pivoting adds.
        equations.columns.push(Vec::with_capacity(equations.rows));
        equations.partner.push(None);
        equations.rests.push(None);
        equations.column_scale.push(1.0);
        equations
    }

    /// The covering unknown of the pivoting.
    pub fn cover(&self) -> usize {
        self.columns.len() - 1
    }

    /// Unknowns free of sign.
    pub fn free(&self) -> impl Iterator<Item = usize> {
        (0..self.cover()).filter(|&j| self.partner[j].is_none())
    }

    /// Multiplies rows and columns by powers of two until their entries are about one.
    fn scale(&mut self) {
        self.column_scale = vec![1.0; self.columns.len()];
        let given: Vec<f64> = self.columns.iter().flatten().map(|e| e.value).collect();
        for _ in 0..4 {
            let mut range = vec![[f64::INFINITY, 0.0f64]; self.rows];
            let widen = |r: &mut [f64; 2], x: f64| *r = [r[0].min(x.abs()), r[1].max(x.abs())];
            let factor = |[least, most]: [f64; 2]| {
                if most > 0.0 { (-0.5 * (least.log2() + most.log2())).round().clamp(-300.0, 300.0).exp2() } else { 1.0 }
            };
            self.columns.iter().flatten().for_each(|e| widen(&mut range[e.row], e.value));
            for (row, range) in range.into_iter().enumerate() {
                self.row_scale[row] *= factor(range);
            }
            let mut given = given.iter();
            for (j, column) in self.columns.iter_mut().enumerate() {
                let mut range = [f64::INFINITY, 0.0];
                for (e, given) in column.iter_mut().zip(&mut given) {
                    e.value = given * self.row_scale[e.row] * self.column_scale[j];
                    widen(&mut range, e.value);
                }
                let factor = factor(range);
                self.column_scale[j] *= factor;
                column.iter_mut().for_each(|e| e.value *= factor);
            }
        }
    }

    /// Puts in the place of each column that depends on those before it the other one of its pair.
    pub fn mend(&self, columns: &mut [usize]) {
        // Reduced columns so far, each with the row of its pivot.
        let mut reduced: Vec<(usize, Vec<f64>)> = Vec::new();
        for j in columns {
            for candidate in [Some(*j), self.partner[*j]].into_iter().flatten() {
                let mut column = vec![0.0; self.rows];
                self.columns[candidate].iter().for_each(|e| column[e.row] = e.value);
                for (pivot, other) in &reduced {
                    let factor = column[*pivot];
                    if factor != 0.0 {
                        column.iter_mut().zip(other).for_each(|(x, y)| *x -= factor * y);
                    }
                }
                let size = |r: &usize| column[*r].abs();
                let pivot = (0..self.rows).max_by(|p, q| size(p).total_cmp(&size(q))).expect("not empty");
                let value = column[pivot];
                if value.abs() > 1e-10 {
                    column.iter_mut().for_each(|x| *x /= value);
                    reduced.push((pivot, column));
                    *j = candidate;
                    break;
                }
            }
        }
    }

    /// Makes a column that of the covering unknown.
    pub fn set_cover(&mut self, column: BTreeMap<usize, Rational>) {
        let cover = self.cover();
        self.columns[cover] = entries(column);
        for e in &mut self.columns[cover] {
            e.value *= self.row_scale[e.row];
        }
    }

    /// Right sides of a load, exactly as it is given.
    pub fn right(&self, load: &Load, of: usize, mut set: impl FnMut(usize, f64)) {
        for (i, t) in load.torques.iter().enumerate() {
            set(i, t[of]);
        }
        for (m, slip) in self.meshes.iter().zip(&load.slips).filter(|(m, _)| m.rest.is_some()) {
            set(m.slip_row, -slip[of]);
        }
        for (k, e) in self.elements.iter().enumerate() {
            if !self.replaced[e.motion_row] {
                set(e.motion_row, load.accelerations[k][of]);
            }
            for side in (0..2).filter(|&side| e.yields[side].is_some()) {
                set(e.yield_rows[side], load.capacities[k][side][of]);
            }
        }
    }

    /// Takes over a load. False if what is prescribed contradicts itself.
    pub fn load(&self, load: &Load, loads: &mut [Vec<f64>; 2]) -> bool {
        (0..2).all(|of| {
            loads[of].fill(0.0);
            self.right(load, of, |row, value| loads[of][row] = value * self.row_scale[row]);
            self.agreements.iter().all(|y| {
                let (mut sum, mut size) = (0.0, 0.0);
                for (k, e) in self.elements.iter().enumerate() {
                    for (_, y) in y.iter().filter(|(row, _)| *row == e.motion_row) {
                        let term = y * load.accelerations[k][of];
                        sum += term;
                        size += term.abs();
                    }
                }
                sum.abs() <= 1e-12 * size
            })
        })
    }

    /// Right sides of the members from those of another system of the same members.
    pub fn copy_torques(&self, other: &Self, from: &[f64], to: &mut [f64]) {
        for i in 0..self.members {
            to[i] = from[i] / other.row_scale[i] * self.row_scale[i];
        }
    }

    /// A motion of the right size.
    pub fn motionless(&self) -> Motion {
        Motion {
            accelerations: vec![Amount::default(); self.members],
            meshes: vec![Default::default(); self.meshes.len()],
            elements: vec![Default::default(); self.elements.len()],
        }
    }

    /// What unknowns say; `basic` where a sign alone does not tell which of a pair is meant.
    pub fn read_from(&self, amount: impl Fn(usize) -> Amount, basic: impl Fn(usize) -> bool, motion: &mut Motion) {
        for (i, a) in motion.accelerations.iter_mut().enumerate() {
            *a = amount(i);
        }
        let leaves = |[ahead, back]: [Option<usize>; 2]| {
            let positive = |j: Option<usize>| j.is_some_and(|j| amount(j).sign() > 0);
            i8::from(positive(ahead)) - i8::from(positive(back))
        };
        for (places, m) in self.meshes.iter().zip(&mut motion.meshes) {
            m.forces = places.forces.map(&amount);
            m.slip = match places.rest {
                Some([[ahead, back], _]) => leaves([Some(ahead), Some(back)]),
                None => places.slip,
            };
            let positive = places.parts.map_or(m.forces[0].sign() >= 0, |[ahead, _]| basic(ahead));
            m.first_drives = positive == (m.slip >= 0);
        }
        for (places, m) in self.elements.iter().zip(&mut motion.elements) {
            m.torque = amount(places.torque);
            m.slip = leaves(places.yields.map(|y| y.map(|[slip, _]| slip)));
        }
    }
}

/// A column, rounded, with its residues.
fn entries(column: BTreeMap<usize, Rational>) -> Vec<Entry> {
    (column.into_iter().filter(|(_, exact)| !exact.is_zero()))
        .map(|(row, exact)| Entry {
            row,
            value: exact.to_f64(),
            // A multiple of the prime below a fraction line: no decimal that anybody writes. Nothing then counts as zero.
            residue: exact.modulo().unwrap_or(1),
            exact,
        })
        .collect()
}

/// Combinations of rows of motion that vanish: for each row that depends on those before it, the parts, its own last.
fn dependencies(motion: &[(usize, Vec<Rational>, usize, Rational)]) -> Vec<Vec<(usize, Rational)>> {
    // Rows reduced so far: pivot, coefficients, combination of the given rows.
    let mut reduced: Vec<(usize, Vec<Rational>, Vec<Rational>)> = Vec::new();
    let mut found = Vec::new();
    for (k, (_, form, ..)) in motion.iter().enumerate() {
        let mut form = form.clone();
        let mut parts = vec![Rational::ZERO; motion.len()];
        parts[k] = Rational::ONE;
        for (pivot, row, of) in &reduced {
            if form[*pivot].is_zero() {
                continue;
            }
            let factor = -&form[*pivot] / &row[*pivot];
            for (x, y) in form.iter_mut().zip(row).chain(parts.iter_mut().zip(of)) {
                *x += &factor * y;
            }
        }
        match form.iter().position(|x| !x.is_zero()) {
            Some(pivot) => reduced.push((pivot, form, parts)),
            None => found.push(parts.into_iter().enumerate().filter(|(_, y)| !y.is_zero()).collect()),
        }
    }
    found
}

/// The exact matrix of some columns.
pub(super) fn exact_matrix(equations: &Equations, columns: &[usize]) -> Matrix {
    let mut matrix = vec![vec![Rational::ZERO; columns.len()]; equations.rows];
    for (i, &j) in columns.iter().enumerate() {
        for e in &equations.columns[j] {
            matrix[e.row][i] = e.exact.clone();
        }
    }
    matrix
}

/// The exact solution over a basis; none if it is singular.
pub(super) fn exact_solution(equations: &Equations, columns: &[usize], of: usize) -> Option<Vec<Rational>> {
    let mut right = vec![Rational::ZERO; equations.rows];
    for e in &equations.columns[of] {
        right[e.row] = e.exact.clone();
    }
    exact::solve(&exact_matrix(equations, columns), &right)
}
