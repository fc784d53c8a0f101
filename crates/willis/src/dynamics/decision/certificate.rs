//! Whether every load has one motion.
//!
//! Each lossy mesh passes power in one of two directions or stays at rest; each element slips or holds. If no two of
//! the determinants of all these choices have opposite signs, and one is not zero, then every load that was ever
//! tried had exactly one motion. (The determinants of all bases say nothing: half of them vanish. That equal signs
//! suffice where some vanish is not proved, and redundant holds were not tried.) They are walked as a tree, the
//! elimination of what several share done once. A sign that rounding leaves open counts against the certificate.

use std::ops::Neg;

use crate::exact::{PRIME, power, times};

use super::basis::add;
use super::equations::{Entry, Equations};

/// A number with the bound of its error and its residue; exactly zero where the residue is.
#[derive(Clone, Copy, Debug, Default)]
struct Tracked {
    value: f64,
    error: f64,
    residue: u64,
}

impl Tracked {
    fn new(value: f64, error: f64, residue: u64) -> Self {
        if residue == 0 { Self::default() } else { Self { value, error, residue } }
    }

    fn sign(self) -> Option<i8> {
        if self.residue == 0 {
            Some(0)
        } else {
            (self.value.abs() > self.error).then_some(if self.value > 0.0 { 1 } else { -1 })
        }
    }

    /// `self − factor · other`
    fn less(self, factor: Self, other: Self) -> Self {
        if factor.residue == 0 || other.residue == 0 {
            return self;
        }
        let product = factor.value * other.value;
        let value = self.value - product;
        let error = self.error
            + factor.error * (other.value.abs() + other.error)
            + other.error * factor.value.abs()
            + f64::EPSILON * (product.abs() + value.abs());
        Self::new(value, error, add(self.residue, PRIME - times(factor.residue, other.residue)))
    }

    /// `self / pivot`, whose sign is known.
    fn over(self, pivot: Self) -> Self {
        let value = self.value / pivot.value;
        let error =
            (self.error + value.abs() * pivot.error) / (pivot.value.abs() - pivot.error) + f64::EPSILON * value.abs();
        Self::new(value, error, times(self.residue, power(pivot.residue, PRIME - 2)))
    }
}

impl Neg for Tracked {
    type Output = Self;
    fn neg(self) -> Self {
        Self::new(-self.value, self.error, (PRIME - self.residue) % PRIME)
    }
}

/// A column of all rows that are left.
type Column = Vec<Tracked>;

/// What is still to be chosen: for each place the alternatives, each of as many columns.
#[derive(Clone)]
struct Tree {
    places: Vec<Vec<Vec<Column>>>,
    /// Sign of the pivots so far.
    sign: i8,
}

/// Why the walk ended before its end.
struct Refused;

/// None if there are more choices to look at than these.
pub(super) fn is_unique(equations: &Equations, most: usize) -> Option<bool> {
    let column = |j: usize| -> Column {
        let mut column = vec![Tracked::default(); equations.rows];
        for Entry { row, value, residue, .. } in &equations.columns[j] {
            column[*row] = Tracked::new(*value, f64::EPSILON * value.abs(), *residue);
        }
        column
    };
    let minus = |j: usize| -> Column { column(j).into_iter().map(Neg::neg).collect() };
    let mut places: Vec<Vec<Vec<Column>>> = equations.free().map(|j| vec![vec![column(j)]]).collect();
    let mut open: Vec<Vec<Vec<Column>>> = Vec::new();
    for mesh in &equations.meshes {
        let Some([ahead, back]) = mesh.parts else { continue };
        match mesh.rest {
            None => open.push(vec![vec![column(ahead)], vec![minus(back)]]),
            Some([[slip, _], [u, v]]) => {
                places.push(vec![vec![column(v)]]);
                open.push(vec![
                    vec![column(ahead), column(slip)],
                    vec![minus(back), column(slip)],
                    vec![column(ahead), minus(u)],
                ]);
            }
        }
    }
    for e in &equations.elements {
        match e.yields {
            [Some([slip, spare]), other] => {
                places.extend(other.map(|[_, spare]| vec![vec![column(spare)]]));
                open.push(vec![vec![column(slip)], vec![minus(spare)]]);
            }
            [None, Some([slip, spare])] => open.push(vec![vec![column(slip)], vec![minus(spare)]]),
            [None, None] => {}
        }
    }
    let choices = open.iter().fold(1usize, |n, place| n.saturating_mul(place.len()));
    places.extend(open);
    let mut seen = None;
    (choices <= most).then(|| Tree { places, sign: 1 }.walk(&mut seen).is_ok() && seen.is_some())
}

impl Tree {
    /// Signs of all determinants from here. Refused at two of opposite sign, or one that is open.
    fn walk(mut self, seen: &mut Option<i8>) -> Result<(), Refused> {
        if self.places.is_empty() {
            return if *seen.get_or_insert(self.sign) == self.sign { Ok(()) } else { Err(Refused) };
        }
        // Where there is nothing to choose first: the one that all share.
        let alternatives = self.places.remove(0);
        let last = alternatives.len() - 1;
        let mut this = Some(self);
        for (k, mut columns) in alternatives.into_iter().enumerate() {
            let rest = if k == last { this.take() } else { this.clone() };
            let mut rest = rest.expect("taken last");
            if rest.eliminate(&mut columns)? {
                rest.walk(seen)?;
            }
        }
        Ok(())
    }

    /// Eliminates columns from those that are left. False if they depend on those before.
    fn eliminate(&mut self, columns: &mut Vec<Column>) -> Result<bool, Refused> {
        while !columns.is_empty() {
            let column = columns.remove(0);
            let known = |r: &usize| column[*r].sign().is_some_and(|s| s != 0);
            let size = |r: usize| column[r].value.abs();
            let Some(pivot) = (0..column.len()).filter(known).max_by(|&p, &q| size(p).total_cmp(&size(q))) else {
                return if column.iter().all(|x| x.residue == 0) { Ok(false) } else { Err(Refused) };
            };
            let moved = if pivot % 2 == 0 { 1 } else { -1 };
            self.sign *= moved * column[pivot].sign().expect("known");
            let rest = self.places.iter_mut().flatten().flatten();
            for other in rest.chain(columns.iter_mut()) {
                let top = other.remove(pivot);
                if top.residue == 0 {
                    continue;
                }
                let top = top.over(column[pivot]);
                let rows = column.iter().enumerate().filter(|(r, _)| *r != pivot).map(|(_, x)| x);
                other.iter_mut().zip(rows).for_each(|(x, factor)| *x = x.less(*factor, top));
            }
        }
        Ok(true)
    }
}
