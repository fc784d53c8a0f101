//! Arithmetic of integers modulo the prime 2⁶¹ − 1: what cannot be zero is known at once.
//!
//! An integer that is no multiple of the prime is not zero: that is a proof. One that is a multiple may be zero or not; a
//! determinant of small integers is one by chance with a probability of about 4e-19, so it is looked at exactly where
//! something hangs on it.
//!
//! A class is a number below [`PRIME`]; all functions take classes and give them.

/// 2⁶¹ − 1, a Mersenne prime.
pub const PRIME: u64 = (1 << 61) - 1;

/// The class of an integer.
///
/// ```
/// use willis::exact::residue::{PRIME, of};
/// assert_eq!([of(-1), of(i128::from(PRIME) + 2)], [PRIME - 1, 2]);
/// ```
pub fn of(value: i128) -> u64 {
    // A division of single words is much shorter than one of double words.
    match i64::try_from(value) {
        Ok(small) => small.rem_euclid(PRIME as i64) as u64,
        Err(_) => value.rem_euclid(i128::from(PRIME)) as u64,
    }
}

/// Product of two classes. As 2⁶¹ is one there, the upper bits of the product are added to the lower: no division.
#[inline]
pub fn times(a: u64, b: u64) -> u64 {
    let product = u128::from(a) * u128::from(b);
    let sum = (product as u64 & PRIME) + (product >> 61) as u64;
    if sum >= PRIME { sum - PRIME } else { sum }
}

/// Sum of two classes.
#[inline]
pub fn plus(a: u64, b: u64) -> u64 {
    let sum = a + b;
    if sum >= PRIME { sum - PRIME } else { sum }
}

/// Difference of two classes.
#[inline]
pub fn minus(a: u64, b: u64) -> u64 {
    if a >= b { a - b } else { a + PRIME - b }
}

/// Power of a class.
pub fn power(mut base: u64, mut exponent: u64) -> u64 {
    let mut result = 1;
    while exponent > 0 {
        if exponent & 1 == 1 {
            result = times(result, base);
        }
        base = times(base, base);
        exponent >>= 1;
    }
    result
}

/// What gives one with a class, by Fermat's little theorem; zero has none, and zero is returned.
///
/// ```
/// use willis::exact::residue::{inverse, times};
/// assert_eq!(times(7, inverse(7)), 1);
/// ```
pub fn inverse(a: u64) -> u64 {
    power(a, PRIME - 2)
}

/// Rank of a matrix of residues, row after row, which is eliminated on the way.
pub fn rank(matrix: &mut [u64], columns: usize) -> usize {
    let mut rows: Vec<&mut [u64]> = matrix.chunks_mut(columns.max(1)).collect();
    let mut rank = 0;
    for c in 0..columns {
        let Some(p) = (rank..rows.len()).find(|&r| rows[r][c] != 0) else { continue };
        rows.swap(p, rank);
        let (done, rest) = rows.split_at_mut(rank + 1);
        let pivot = &done[rank];
        let inverse = if rest.iter().any(|row| row[c] != 0) { inverse(pivot[c]) } else { 0 };
        for row in rest.iter_mut().filter(|row| row[c] != 0) {
            let factor = times(row[c], inverse);
            for k in c..columns {
                if pivot[k] != 0 {
                    row[k] = minus(row[k], times(factor, pivot[k]));
                }
            }
        }
        rank += 1;
    }
    rank
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn classes_are_those_of_integers() {
        for (a, b) in [(3_i128, -5_i128), (1 << 61, 7), (-(1 << 100), 1 << 99), ((1 << 61) - 1, 9)] {
            assert_eq!(times(of(a), of(b)), of((a % i128::from(PRIME)) * (b % i128::from(PRIME))));
            assert_eq!(plus(of(a), of(b)), of(a + b));
            assert_eq!(minus(of(a), of(b)), of(a - b));
        }
    }
}
