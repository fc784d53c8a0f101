//! Small dense matrices, by rows: those of a mode are inverted and multiplied too often to be put together anew each time.

/// The inverse of a square matrix, by elimination with row pivots; none if a pivot is zero.
pub(super) fn inverse(matrix: &[f64], n: usize) -> Option<Vec<f64>> {
    let width = 2 * n;
    let mut rows = vec![0.0; n * width];
    for (i, row) in rows.chunks_exact_mut(width).enumerate() {
        row[..n].copy_from_slice(&matrix[i * n..(i + 1) * n]);
        row[n + i] = 1.0;
    }
    let mut top = vec![0.0; width];
    for c in 0..n {
        let size = |r: usize| rows[r * width + c].abs();
        let pivot = (c..n).max_by(|&a, &b| size(a).total_cmp(&size(b)))?;
        top.copy_from_slice(&rows[pivot * width..(pivot + 1) * width]);
        if top[c] == 0.0 {
            return None;
        }
        rows.copy_within(c * width..(c + 1) * width, pivot * width);
        let over = 1.0 / top[c];
        top[c..].iter_mut().for_each(|x| *x *= over);
        for (r, row) in rows.chunks_exact_mut(width).enumerate() {
            let factor = row[c];
            if r == c {
                row.copy_from_slice(&top);
            } else if factor != 0.0 {
                row[c..].iter_mut().zip(&top[c..]).for_each(|(x, t)| *x -= factor * t);
            }
        }
    }
    Some(rows.chunks_exact(width).flat_map(|row| &row[n..]).copied().collect())
}

/// Adds to `sum` the product of a matrix with `n` columns and one with `width` columns.
pub(super) fn add_product(sum: &mut [f64], a: &[f64], b: &[f64], [n, width]: [usize; 2]) {
    for (sum, a) in sum.chunks_exact_mut(width).zip(a.chunks_exact(n)) {
        for (a, b) in a.iter().zip(b.chunks_exact(width)).filter(|(a, _)| **a != 0.0) {
            sum.iter_mut().zip(b).for_each(|(sum, b)| *sum += a * b);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regress_an_inverse_is_one() {
        let m = [0.0, 2.0, 1.0, 1.0, -1.0, 0.5, 3.0, 0.0, 4.0];
        let inverse = inverse(&m, 3).expect("it is regular");
        let mut one = [0.0; 9];
        add_product(&mut one, &m, &inverse, [3, 3]);
        for (k, x) in one.iter().enumerate() {
            assert!((x - f64::from(u8::from(k % 4 == 0))).abs() < 1e-15, "{one:?}");
        }
        assert_eq!(super::inverse(&[1.0, 2.0, 2.0, 4.0], 2), None);
    }
}
