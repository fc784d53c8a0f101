//! The cells into which planes through the origin cut a space, exactly.
//!
//! Every plane is added in turn. The cells that it cuts are those that its own arrangement of
//! traces runs through, one dimension lower; a point in each trace, moved a little to both sides,
//! is a point in both halves. So every cell comes with a point inside, and no tolerance or linear
//! program is needed.

use std::collections::BTreeMap;

use crate::exact::Rational;

/// A cell: the sign of every form, and a point inside.
#[derive(Clone, Debug)]
pub(crate) struct Cell {
    pub signs: Vec<i8>,
    pub point: Vec<Rational>,
}

pub(crate) fn dot(a: &[Rational], b: &[Rational]) -> Rational {
    a.iter().zip(b).fold(Rational::ZERO, |sum, (x, y)| if x.is_zero() || y.is_zero() { sum } else { sum + x * y })
}

/// A form scaled so that its first coefficient is one, and the sign of the factor taken out;
/// `None` for the zero form.
pub(crate) fn normal(form: &[Rational]) -> Option<(Vec<Rational>, i8)> {
    let lead = form.iter().find(|x| !x.is_zero())?;
    Some((form.iter().map(|x| x / lead).collect(), lead.sign()))
}

/// Most cells that `n` planes can cut a space into.
pub(crate) fn most_cells(n: usize, dimension: usize) -> u128 {
    // 2 Σ_{i<d} C(n−1, i)
    if n == 0 {
        return 1;
    }
    let (mut sum, mut binomial) = (0u128, 1u128);
    for i in 0..dimension as u128 {
        sum = sum.saturating_add(binomial);
        binomial = binomial.saturating_mul((n as u128 - 1).saturating_sub(i)) / (i + 1);
    }
    sum.saturating_mul(2)
}

/// The cells of `forms` in a space of `dimension`. The forms are non-zero and no two proportional.
pub(crate) fn cells(forms: &[Vec<Rational>], dimension: usize) -> Vec<Cell> {
    cells_where(forms, &vec![0; forms.len()], dimension)
}

/// Those cells in which every form has the sign that is wanted of it; 0 for either.
pub(crate) fn cells_where(forms: &[Vec<Rational>], wanted: &[i8], dimension: usize) -> Vec<Cell> {
    let mut all = vec![Cell { signs: vec![], point: vec![Rational::ZERO; dimension] }];
    for (k, form) in forms.iter().enumerate() {
        let earlier = &forms[..k];
        let mut index: BTreeMap<Vec<i8>, usize> = BTreeMap::new();
        for (n, cell) in all.iter_mut().enumerate() {
            index.insert(cell.signs.clone(), n);
            cell.signs.push(dot(form, &cell.point).sign());
        }
        for on in traces(earlier, &wanted[..k], form, dimension) {
            let values: Vec<Rational> = earlier.iter().map(|g| dot(g, &on)).collect();
            let signs: Vec<i8> = values.iter().map(Rational::sign).collect();
            // Half of the way to the next plane along the normal.
            let mut step = Rational::ONE;
            for (g, v) in earlier.iter().zip(&values) {
                let slope = dot(g, form);
                if !slope.is_zero() {
                    step = step.min(v.abs() / slope.abs() * Rational::new(1, 2));
                }
            }
            let moved =
                |way: Rational| -> Vec<Rational> { on.iter().zip(form).map(|(x, n)| x + &(n * &way)).collect() };
            let mut with = |n: usize, sign: i8| {
                let way = if sign > 0 { step.clone() } else { -step.clone() };
                let mut signs = signs.clone();
                signs.push(sign);
                let cell = Cell { signs, point: moved(way) };
                if n < all.len() { all[n] = cell } else { all.push(cell) }
            };
            with(index[&signs], 1);
            with(usize::MAX, -1);
        }
        if wanted[k] != 0 {
            all.retain(|cell| cell.signs[k] == wanted[k]);
        }
    }
    all
}

/// A point in every cell that the other planes cut a plane into, as far as it is wanted.
fn traces(others: &[Vec<Rational>], wanted: &[i8], plane: &[Rational], dimension: usize) -> Vec<Vec<Rational>> {
    let pivot = plane.iter().position(|x| !x.is_zero()).expect("not zero");
    let mut reduced: Vec<Vec<Rational>> = Vec::new();
    let mut signs: Vec<i8> = Vec::new();
    for (g, sign) in others.iter().zip(wanted) {
        // On the plane the pivot's coordinate follows from the others.
        let factor = &g[pivot] / &plane[pivot];
        let row: Vec<Rational> =
            (0..dimension).filter(|&c| c != pivot).map(|c| &g[c] - &(&factor * &plane[c])).collect();
        let Some((row, way)) = normal(&row) else { continue };
        let sign = sign * way;
        match reduced.iter().position(|r| *r == row) {
            // Two of which opposite signs are wanted leave nothing.
            Some(n) if signs[n] * sign < 0 => return vec![],
            Some(n) => signs[n] = if sign == 0 { signs[n] } else { sign },
            None => {
                reduced.push(row);
                signs.push(sign);
            }
        }
    }
    cells_where(&reduced, &signs, dimension - 1)
        .into_iter()
        .map(|cell| {
            let mut point = cell.point;
            point.insert(pivot, Rational::ZERO);
            point[pivot] = -(dot(plane, &point) / &plane[pivot]);
            point
        })
        .collect()
}

/// Order of two directions in the plane, counterclockwise from the first axis.
pub(crate) fn by_angle(a: &[Rational], b: &[Rational]) -> std::cmp::Ordering {
    let half = |v: &[Rational]| u8::from(v[1].sign() < 0 || (v[1].is_zero() && v[0].sign() < 0));
    let cross = &(&a[0] * &b[1]) - &(&a[1] * &b[0]);
    half(a).cmp(&half(b)).then_with(|| Rational::ZERO.cmp(&cross))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn forms(rows: &[&[i64]]) -> Vec<Vec<Rational>> {
        rows.iter().map(|r| r.iter().map(|x| Rational::from(*x)).collect()).collect()
    }

    #[test]
    fn lines_cut_the_plane_into_twice_as_many_sectors() {
        let f = forms(&[&[1, 0], &[0, 1], &[1, 1], &[1, -2]]);
        let all = cells(&f, 2);
        assert_eq!(all.len(), 8);
        for c in &all {
            let signs: Vec<i8> = f.iter().map(|g| dot(g, &c.point).sign()).collect();
            assert_eq!(signs, c.signs);
            assert!(!signs.contains(&0));
        }
        let mut angles = all.clone();
        angles.sort_by(|a, b| by_angle(&a.point, &b.point));
        for pair in angles.windows(2) {
            let flips = pair[0].signs.iter().zip(&pair[1].signs).filter(|(a, b)| a != b).count();
            assert_eq!(flips, 1, "neighbours differ in one sign");
        }
    }

    #[test]
    fn braid_arrangement_has_as_many_cells_as_permutations() {
        // x_i = x_j in four dimensions: 4! orders.
        let mut rows = Vec::new();
        for i in 0..4 {
            for j in 0..i {
                let mut r = vec![Rational::ZERO; 4];
                (r[i], r[j]) = (Rational::ONE, -Rational::ONE);
                rows.push(normal(&r).unwrap().0);
            }
        }
        assert_eq!(cells(&rows, 4).len(), 24);
        assert!(most_cells(6, 4) >= 24);
    }

    #[test]
    fn general_position_reaches_the_bound() {
        let f = forms(&[&[1, 0, 0], &[0, 1, 0], &[0, 0, 1], &[1, 1, 1], &[1, 2, 4], &[1, -3, 9]]);
        assert_eq!(cells(&f, 3).len() as u128, most_cells(6, 3));
    }

    #[test]
    fn wanted_signs_select_cells() {
        let f = forms(&[&[1, 0, 0], &[0, 1, 0], &[0, 0, 1], &[1, 1, 1], &[1, 2, 4], &[1, -3, 9]]);
        let all = cells(&f, 3);
        for wanted in [[1, 0, 0, -1, 0, 0], [-1, 1, 1, 0, 0, -1], [1, 1, 1, -1, 0, 0], [0, 0, 0, 0, 1, 1]] {
            let fits = |c: &&Cell| c.signs.iter().zip(wanted).all(|(s, w)| w == 0 || *s == w);
            let mut expected: Vec<Vec<i8>> = all.iter().filter(fits).map(|c| c.signs.clone()).collect();
            let found = cells_where(&f, &wanted, 3);
            for c in &found {
                assert_eq!(c.signs, f.iter().map(|g| dot(g, &c.point).sign()).collect::<Vec<_>>());
            }
            let mut found: Vec<Vec<i8>> = found.into_iter().map(|c| c.signs).collect();
            expected.sort();
            found.sort();
            assert_eq!(found, expected);
        }
    }

    #[test]
    fn no_plane_one_cell() {
        assert_eq!(cells(&[], 3).len(), 1);
        assert_eq!(cells(&forms(&[&[2]]), 1).len(), 2);
    }
}
