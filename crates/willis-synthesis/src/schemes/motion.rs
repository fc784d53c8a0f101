//! How the shafts of a layout can turn: every shaft is a vector.
//!
//! A simple set with ring/sun tooth ratio `k = a/b` obeys `b w_sun + a w_ring = (a + b) w_carrier` (Willis). With the
//! housing at rest and independent equations, the speeds of a layout of `F` shafts and `m` sets are a space of dimension
//! `M = F - m`, its mobility. The speed of a shaft is a linear function on that space: the shaft is a vector of `M`
//! integers, all shafts with one common factor, and the housing is zero. A clutch or brake forces two speeds to be
//! equal; it is the difference of two such vectors, and only its direction matters: a point of projective space.

use willis::exact::Rational;

use super::layout::{GROUND, Layout, MAX_SETS, MAX_SHAFTS};

/// The largest mobility that is searched.
pub(crate) const MAX_MOBILITY: usize = 5;

/// The shafts of a layout as vectors of integers.
#[derive(Clone, Debug)]
pub(crate) struct Motion {
    pub(crate) mobility: usize,
    pub(crate) shafts: usize,
    vectors: [[i128; MAX_MOBILITY]; MAX_SHAFTS],
}

/// Numerator and denominator of the tooth ratio ring/sun of every set.
pub(crate) type Teeth = [[i128; 2]];

/// The tooth ratios as integers, if elimination with them cannot overflow: every number in it is a determinant of the
/// equations, at most the product of the `2 (a + b)`, and products of two of these are formed.
pub(crate) fn teeth(ratios: &[Rational]) -> Option<Vec<[i128; 2]>> {
    let mut room = 1_i128 << 60;
    ratios
        .iter()
        .map(|k| {
            let text = k.to_fraction();
            let (a, b) = text.split_once('/')?;
            let [a, b] = [a.parse::<i128>().ok()?, b.parse::<i128>().ok()?];
            room /= a.checked_add(b)?.checked_mul(2).filter(|s| *s > 0)?;
            (room > 0).then_some([a, b])
        })
        .collect()
}

impl Motion {
    /// The shafts of a layout with these tooth ratios; none where the equations of the sets depend on each other, or
    /// the mobility is none that is searched.
    pub(crate) fn of(layout: &Layout, teeth: &Teeth) -> Option<Self> {
        let (shafts, sets) = (layout.shafts(), layout.sets());
        let mobility = (shafts - 1).checked_sub(sets).filter(|m| (1..=MAX_MOBILITY).contains(m))?;
        // One equation a set, without the housing.
        let mut rows = [[0_i128; MAX_SHAFTS]; MAX_SETS];
        for (set, three) in layout.blocks().chunks(3).enumerate() {
            let [a, b] = teeth[set];
            for (block, factor) in three.iter().zip([b, a, -(a + b)]) {
                rows[set][usize::from(*block)] = factor;
            }
            rows[set][usize::from(GROUND)] = 0;
        }
        // Elimination without fractions (Bareiss): all divisions are exact, all pivots end as one number.
        let mut pivots = [usize::MAX; MAX_SETS];
        let mut last = 1_i128;
        for step in 0..sets {
            let column = (0..shafts).rev().find(|c| rows[step][*c] != 0)?;
            let pivot = rows[step];
            for row in (0..sets).filter(|r| *r != step) {
                let factor = rows[row][column];
                for c in 0..shafts {
                    if rows[row][c] != 0 || pivot[c] != 0 {
                        let value = pivot[column] * rows[row][c] - factor * pivot[c];
                        rows[row][c] = if last == 1 { value } else { value / last };
                    }
                }
            }
            last = pivot[column];
            pivots[step] = column;
        }
        let mut vectors = [[0; MAX_MOBILITY]; MAX_SHAFTS];
        let mut free = 0;
        for shaft in (0..shafts).filter(|s| *s != usize::from(GROUND)) {
            if pivots[..sets].contains(&shaft) {
                continue;
            }
            vectors[shaft][free] = last;
            for (row, pivot) in pivots[..sets].iter().enumerate() {
                vectors[*pivot][free] = -rows[row][shaft];
            }
            free += 1;
        }
        Some(Self { mobility, shafts, vectors })
    }

    /// The vector of a shaft.
    pub(crate) fn shaft(&self, shaft: u8) -> &[i128] {
        &self.vectors[usize::from(shaft)][..self.mobility]
    }

    /// The vector of the element that joins two shafts.
    pub(crate) fn element(&self, [x, y]: [u8; 2]) -> [i128; MAX_MOBILITY] {
        let (x, y) = (&self.vectors[usize::from(x)], &self.vectors[usize::from(y)]);
        std::array::from_fn(|i| x[i] - y[i])
    }
}

/// The speeds of all shafts for input speed 1, if elements that join these pairs leave one freedom in which input and
/// output turn. By elimination over rational numbers from the equations of the sets, with nothing taken from
/// [`Motion`]: it confirms what is found there.
pub(crate) fn speeds(layout: &Layout, ratios: &[Rational], closed: &[[u8; 2]]) -> Option<Vec<Rational>> {
    let shafts = layout.shafts();
    let mut rows: Vec<Vec<Rational>> = vec![];
    for (k, three) in ratios.iter().zip(layout.blocks().chunks(3)) {
        let mut row = vec![Rational::ZERO; shafts];
        for (block, factor) in three.iter().zip([Rational::ONE, k.clone(), -(k + &Rational::ONE)]) {
            row[usize::from(*block)] = factor;
        }
        rows.push(row);
    }
    for [x, y] in closed {
        let mut row = vec![Rational::ZERO; shafts];
        (row[usize::from(*x)], row[usize::from(*y)]) = (Rational::ONE, Rational::from(-1));
        rows.push(row);
    }
    let ground = usize::from(GROUND);
    for row in &mut rows {
        row[ground] = Rational::ZERO;
    }
    // Reduced row echelon form; the input comes last, so that it is the free one.
    let order: Vec<usize> = (0..shafts).rev().filter(|s| *s != ground).collect();
    let mut pivots = vec![];
    for column in order {
        let from = pivots.len();
        let Some(found) = (from..rows.len()).find(|r| !rows[*r][column].is_zero()) else { continue };
        rows.swap(from, found);
        let scale = rows[from][column].recip();
        let pivot: Vec<Rational> = rows[from].iter().map(|x| x * &scale).collect();
        for (r, row) in rows.iter_mut().enumerate() {
            if r == from || row[column].is_zero() {
                continue;
            }
            let factor = row[column].clone();
            for (x, p) in row.iter_mut().zip(&pivot).filter(|(_, p)| !p.is_zero()) {
                *x = &*x - &(&factor * p);
            }
        }
        rows[from] = pivot;
        pivots.push(column);
    }
    let one_freedom = pivots.len() + 2 == shafts && !pivots.contains(&0);
    one_freedom.then_some(())?;
    let mut speeds = vec![Rational::ZERO; shafts];
    speeds[0] = Rational::ONE;
    for (row, pivot) in rows.iter().zip(&pivots) {
        speeds[*pivot] = -row[0].clone();
    }
    (!speeds[1].is_zero()).then_some(speeds)
}
