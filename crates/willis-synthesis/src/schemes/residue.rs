//! Arithmetic modulo the prime 2^61 - 1.
//!
//! An integer that is no multiple of the prime is not zero: that is a proof. One that is a multiple of it is taken for
//! zero. It could be another multiple; a determinant of small integers is one by chance with a probability of about
//! 4e-19, and everything that is shown to a user is computed again with rational numbers.

/// The prime, 2^61 - 1.
const PRIME: u64 = (1 << 61) - 1;

/// The class of an integer.
pub(crate) fn of(value: i128) -> u64 {
    match i64::try_from(value) {
        Ok(small) => small.rem_euclid(PRIME as i64) as u64,
        Err(_) => value.rem_euclid(i128::from(PRIME)) as u64,
    }
}

pub(crate) fn times(a: u64, b: u64) -> u64 {
    let product = u128::from(a) * u128::from(b);
    let sum = (product as u64 & PRIME) + (product >> 61) as u64;
    if sum >= PRIME { sum - PRIME } else { sum }
}

pub(crate) fn plus(a: u64, b: u64) -> u64 {
    let sum = a + b;
    if sum >= PRIME { sum - PRIME } else { sum }
}

pub(crate) fn minus(a: u64, b: u64) -> u64 {
    if a >= b { a - b } else { a + PRIME - b }
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
