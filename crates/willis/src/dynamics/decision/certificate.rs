//! Whether every load has one motion.
//!
//! Each lossy mesh passes power in one of two directions or stays at rest; each element slips or holds. If no two of
//! the determinants of all these choices have opposite signs, and one is not zero, then every load that was ever
//! tried had exactly one motion. (The determinants of all bases say nothing: half of them vanish. That equal signs
//! suffice where some vanish is not proved, and redundant holds were not tried.) They are walked as a tree, the
//! elimination of what several share done once. A sign that rounding leaves open counts against the certificate.
//!
//! Over the columns of the choice in which all slides forward, every other choice is a principal minor: it keeps the
//! columns of some places and exchanges those of the others. What is kept then costs nothing, so these minors are looked
//! at first, and the tree is walked where they leave a sign open. Where the matrix of which they are minors is dominated by
//! its diagonal, under some scale of its columns, all of them are positive (an H-matrix with a positive diagonal is a
//! P-matrix; Berman and Plemmons 1994, chapter 6): rolling contacts with small losses need no walk, however many they are.

use std::collections::BTreeMap;
use std::ops::Neg;

use crate::exact::residue::{PRIME, power, times};

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

    /// Value and bound of `self − factor · other`.
    fn difference(self, factor: Self, other: Self) -> [f64; 2] {
        let product = factor.value * other.value;
        let value = self.value - product;
        let error = self.error
            + factor.error * (other.value.abs() + other.error)
            + other.error * factor.value.abs()
            + f64::EPSILON * (product.abs() + value.abs());
        [value, error]
    }

    /// `self − factor · other`
    fn less(self, factor: Self, other: Self) -> Self {
        if factor.residue == 0 || other.residue == 0 {
            return self;
        }
        let [value, error] = self.difference(factor, other);
        Self::new(value, error, add(self.residue, PRIME - times(factor.residue, other.residue)))
    }

    /// The same, but for a common factor of all residues, which are those times `pivot`: with it no inverse is needed to
    /// tell what is zero. The residue of `factor` is not yet divided by that of the pivot.
    fn less_times(self, factor: Self, other: Self, pivot: u64) -> Self {
        let residue = times(self.residue, pivot);
        if factor.residue == 0 || other.residue == 0 {
            return Self { residue, ..self };
        }
        let [value, error] = self.difference(factor, other);
        Self::new(value, error, add(residue, PRIME - times(factor.residue, other.residue)))
    }

    /// `self / pivot`, whose sign is known; `inverse` is the inverse of its residue.
    fn over(self, pivot: Self, inverse: u64) -> Self {
        let value = self.value / pivot.value;
        let error =
            (self.error + value.abs() * pivot.error) / (pivot.value.abs() - pivot.error) + f64::EPSILON * value.abs();
        Self::new(value, error, times(self.residue, inverse))
    }

    fn inverse(self) -> u64 {
        power(self.residue, PRIME - 2)
    }
}

impl Neg for Tracked {
    type Output = Self;
    fn neg(self) -> Self {
        Self::new(-self.value, self.error, (PRIME - self.residue) % PRIME)
    }
}

/// The entries of a column that are not zero, in ascending order of rows. Most columns of a train meet few rows.
type Column = Vec<(usize, Tracked)>;

/// The last of the largest entries whose sign is known, in these rows.
fn pivot_of(column: &[(usize, Tracked)], is_open: impl Fn(usize) -> bool) -> Option<(usize, Tracked)> {
    let known = column.iter().filter(|(row, x)| is_open(*row) && x.sign().is_some());
    known.max_by(|(_, p), (_, q)| p.value.abs().total_cmp(&q.value.abs())).copied()
}

/// Takes `amount` of a column from another. `room` is for the result.
fn subtract(from: &mut Column, amount: Tracked, column: &[(usize, Tracked)], room: &mut Column) {
    room.clear();
    let mut rest = from.iter().copied().peekable();
    for &(row, factor) in column {
        while let Some(entry) = rest.next_if(|(before, _)| *before < row) {
            room.push(entry);
        }
        let x = rest.next_if(|(same, _)| *same == row).map_or_else(Tracked::default, |(_, x)| x);
        let x = x.less(factor, amount);
        if x.residue != 0 {
            room.push((row, x));
        }
    }
    room.extend(rest);
    std::mem::swap(from, room);
}

/// Where a column has an entry in a row.
fn find(column: &Column, row: usize) -> Option<usize> {
    column.binary_search_by_key(&row, |(r, _)| *r).ok()
}

/// What is still to be chosen: for each place the alternatives, each of as many columns.
#[derive(Clone)]
struct Tree {
    places: Vec<Vec<Vec<Column>>>,
    /// The rows without a pivot, in order.
    rows: Vec<usize>,
    /// Sign of the pivots so far.
    sign: i8,
}

/// Why the walk ended before its end.
struct Refused;

/// Up to so many choices are walked without looking for a scale.
const LEAST_DOMINATED: usize = 1 << 8;

/// None if there are more choices to look at than these.
pub(super) fn is_unique(equations: &Equations, most: usize) -> Option<bool> {
    let mut tree = Tree::of(equations);
    let open = tree.places.iter().map(Vec::len).filter(|n| *n > 1);
    let choices = open.clone().fold(1, usize::saturating_mul);
    let two_ways = open.into_iter().all(|n| n == 2);
    if choices > most && !two_ways {
        return None;
    }
    if tree.eliminate_shared().is_err() {
        return Some(false);
    }
    if let Some(matrix) = Exchanges::of(&tree) {
        if choices > LEAST_DOMINATED && matrix.is_dominated() {
            return Some(true);
        }
        if choices > most {
            return None;
        }
        if let Some(positive) = Minors::of(matrix).and_then(Minors::all) {
            return Some(positive);
        }
    } else if choices > most {
        return None;
    }
    Some(tree.agrees())
}

impl Tree {
    /// All choices, what they share first.
    fn of(equations: &Equations) -> Self {
        let column = |j: usize| -> Column {
            let entries = equations.columns[j].iter().filter(|e| e.residue != 0);
            let tracked = |e: &Entry| (e.row, Tracked::new(e.value, f64::EPSILON * e.value.abs(), e.residue));
            entries.map(tracked).collect()
        };
        let minus = |j: usize| -> Column { column(j).into_iter().map(|(row, x)| (row, -x)).collect() };
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
        places.extend(open);
        Self { places, rows: (0..equations.rows).collect(), sign: 1 }
    }

    /// Whether no two determinants have opposite signs, none is left open, and one is not zero.
    fn agrees(self) -> bool {
        let mut seen = None;
        self.walk(&mut seen).is_ok() && seen.is_some()
    }

    /// Eliminates what all choices share. Refused where that leaves no determinant, or one that is open.
    fn eliminate_shared(&mut self) -> Result<(), Refused> {
        while self.places.first().is_some_and(|place| place.len() == 1) {
            let mut columns = self.places.remove(0).remove(0);
            if !self.eliminate(&mut columns)? {
                return Err(Refused);
            }
        }
        Ok(())
    }

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
        let mut room = vec![];
        while !columns.is_empty() {
            let mut column = columns.remove(0);
            let Some((row, pivot)) = pivot_of(&column, |_| true) else {
                return if column.is_empty() { Ok(false) } else { Err(Refused) };
            };
            column.retain(|(r, _)| *r != row);
            let place = self.rows.binary_search(&row).expect("entries are in rows that are left");
            self.rows.remove(place);
            let moved = if place % 2 == 0 { 1 } else { -1 };
            self.sign *= moved * pivot.sign().expect("known");
            let inverse = pivot.inverse();
            for other in self.places.iter_mut().flatten().flatten().chain(columns.iter_mut()) {
                if let Some(at) = find(other, row) {
                    let (_, entry) = other.remove(at);
                    subtract(other, entry.over(pivot, inverse), &column, &mut room);
                }
            }
        }
        Ok(true)
    }
}

/// The columns that choices exchange, over those of the choice in which all slides forward.
struct Exchanges {
    n: usize,
    /// By rows.
    matrix: Vec<Tracked>,
    /// The place of each column.
    places: Vec<usize>,
}

/// The choices as principal minors of one matrix. Positions in it are bits of a word.
struct Minors {
    /// For each column that may be exchanged, those that may not be exchanged with it: of a place one at a time.
    beside: Vec<u64>,
    n: usize,
    /// Matrices by depth, by rows.
    levels: Vec<Vec<Tracked>>,
}

/// The positions of a word.
fn positions(mut word: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let k = word.trailing_zeros() as usize;
        (word != 0).then(|| {
            word &= word - 1;
            k
        })
    })
}

impl Exchanges {
    /// None where not all can slide forward at once. The columns that all choices share are eliminated already.
    fn of(tree: &Tree) -> Option<Self> {
        let mut basis: Vec<Column> = vec![];
        let mut exchanged: Vec<Column> = vec![];
        let mut places = vec![];
        for (place, alternatives) in tree.places.iter().enumerate() {
            let first = alternatives.first()?;
            for (k, column) in first.iter().enumerate() {
                // The alternative that differs in this column and in no other of its place.
                let other = match (first.len(), k, &alternatives[1..]) {
                    (1, 0, [other]) | (2, 0, [other, _]) | (2, 1, [_, other]) => other,
                    _ => return None,
                };
                basis.push(column.clone());
                exchanged.push(other[k].clone());
                places.push(place);
            }
        }
        let n = basis.len();
        if tree.rows.len() != n {
            return None;
        }
        // The exchanged columns over the basis: its columns are eliminated one by one below their pivots, then above them.
        // `pivots` leads from rows to columns.
        let mut pivots: BTreeMap<usize, usize> = BTreeMap::new();
        let mut above: Vec<(usize, Column)> = vec![];
        let mut room = vec![];
        for at in 0..n {
            let mut column = std::mem::take(&mut basis[at]);
            let (row, pivot) = pivot_of(&column, |row| !pivots.contains_key(&row))?;
            column.retain(|(r, _)| *r != row);
            let (done, below): (Column, Column) = column.into_iter().partition(|(r, _)| pivots.contains_key(r));
            pivots.insert(row, at);
            above.push((row, done));
            let inverse = pivot.inverse();
            for other in basis[at + 1..].iter_mut().chain(&mut exchanged) {
                if let Some(place) = find(other, row) {
                    let top = other[place].1.over(pivot, inverse);
                    other[place].1 = top;
                    subtract(other, top, &below, &mut room);
                }
            }
        }
        for (row, above) in above.iter().rev() {
            for other in &mut exchanged {
                if let Some(place) = find(other, *row) {
                    subtract(other, other[place].1, above, &mut room);
                }
            }
        }
        let mut matrix = vec![Tracked::default(); n * n];
        for (k, column) in exchanged.into_iter().enumerate() {
            for (row, x) in column {
                matrix[pivots[&row] * n + k] = x;
            }
        }
        Some(Self { n, matrix, places })
    }

    /// Whether a scale `x > 0` of the columns makes each entry of the diagonal larger than all others in its row together.
    fn is_dominated(&self) -> bool {
        let n = self.n;
        let at = |r: usize, c: usize| self.matrix[r * n + c];
        // Largest beside the diagonal, least on it, whatever the rounding was.
        let least = |r: usize, c: usize| match r == c {
            true => at(r, c).value - at(r, c).error,
            false => -(at(r, c).value.abs() + at(r, c).error),
        };
        let comparison = nalgebra::DMatrix::from_fn(n, n, least);
        let Some(scale) = comparison.clone().lu().solve(&nalgebra::DVector::from_element(n, 1.0)) else { return false };
        // However the scale was found: it shows it, or not.
        (0..n).all(|r| {
            let beside: f64 = (0..n).filter(|&c| c != r).map(|c| -comparison[(r, c)] * scale[c]).sum();
            scale[r] > 0.0 && scale[r].is_finite() && comparison[(r, r)] * scale[r] > beside * (1.0 + 1e-9)
        })
    }
}

impl Minors {
    /// None where there are more columns than a word has bits.
    fn of(Exchanges { n, matrix, places }: Exchanges) -> Option<Self> {
        if n >= u64::BITS as usize {
            return None;
        }
        let of = |place: usize| places.iter().enumerate().filter(move |(_, p)| **p == place);
        let beside = places.iter().map(|&place| of(place).fold(0, |word, (k, _)| word | 1 << k)).collect();
        let mut levels = vec![vec![Tracked::default(); n * n]; n + 1];
        levels[0] = matrix;
        Some(Self { beside, n, levels })
    }

    /// Whether none of them is negative; none where that is left open.
    fn all(mut self) -> Option<bool> {
        let open = (1 << self.n) - 1;
        self.are_positive(0, open, 0).ok()
    }

    /// Whether no minor is negative that exchanges all of `forced`, whose own entries vanish so far, and any of `open`.
    fn are_positive(&mut self, depth: usize, open: u64, forced: u64) -> Result<bool, Refused> {
        // What was forced at a zero and no longer is zero comes first.
        if let Some(i) = positions(forced).find(|&i| !self.is_zero(depth, i, i)) {
            return self.exchange(depth, i, open, forced & !(1 << i));
        }
        if open == 0 {
            // Nothing but zeros on the diagonal: the minor is zero if a whole row is, as that of one alone.
            let zero = |i: usize| positions(forced).all(|j| self.is_zero(depth, i, j));
            return if forced == 0 || positions(forced).any(zero) { Ok(true) } else { Err(Refused) };
        }
        let i = open.trailing_zeros() as usize;
        let rest = open & !(1 << i);
        if !self.are_positive(depth, rest, forced)? {
            return Ok(false);
        }
        let apart = rest & !self.beside[i];
        let others = apart | forced;
        let alone = positions(others).all(|j| self.is_zero(depth, i, j))
            || positions(others).all(|j| self.is_zero(depth, j, i));
        let own = self.levels[depth][i * self.n + i];
        // Its row or column has nothing but its own entry, which is then a factor of every minor.
        if alone && (own.residue == 0 || forced == 0) {
            return own.sign().map(|sign| sign >= 0).ok_or(Refused);
        }
        if own.residue == 0 {
            return self.are_positive(depth, apart, forced | 1 << i);
        }
        self.exchange(depth, i, apart, forced)
    }

    #[inline]
    fn is_zero(&self, depth: usize, row: usize, column: usize) -> bool {
        self.levels[depth][row * self.n + column].residue == 0
    }

    /// The same with one that does not vanish exchanged.
    fn exchange(&mut self, depth: usize, i: usize, open: u64, forced: u64) -> Result<bool, Refused> {
        let n = self.n;
        let (before, after) = self.levels.split_at_mut(depth + 1);
        let (from, to) = (&before[depth], &mut after[0]);
        let pivot = from[i * n + i];
        match pivot.sign() {
            None => return Err(Refused),
            Some(-1) => return Ok(false),
            Some(_) => {}
        }
        let left = open | forced;
        for r in positions(left) {
            let factor = from[r * n + i].over(pivot, 1);
            for c in positions(left) {
                to[r * n + c] = from[r * n + c].less_times(factor, from[i * n + c], pivot.residue);
            }
        }
        self.are_positive(depth + 1, open, forced)
    }
}

/// Whether the minors say that there is one motion, whether the determinants one by one do, and whether the matrix is
/// dominated by its diagonal; none where there is nothing to choose, or no minors decide.
#[cfg(test)]
pub(super) fn ways(equations: &Equations) -> Option<(bool, bool, bool)> {
    let mut tree = Tree::of(equations);
    tree.eliminate_shared().ok()?;
    let matrix = Exchanges::of(&tree).filter(|matrix| matrix.n > 0)?;
    let is_dominated = matrix.is_dominated();
    let minors = Minors::of(matrix).and_then(Minors::all)?;
    Some((minors, tree.agrees(), is_dominated))
}
