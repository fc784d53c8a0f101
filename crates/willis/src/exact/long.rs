//! Operations of fractions of any length (Knuth, The Art of Computer Programming 2, 4.5.1).
//!
//! Where trains are chained, long numbers meet short ones: a ratio of many sets and the teeth of the next. So common divisors
//! are looked for with a remainder first, which takes the long number down to the length of the short one at once.

use std::borrow::Cow;
use std::cmp::Ordering;

use num_bigint::{BigInt, BigUint};
use num_integer::Integer;
use num_rational::BigRational;
use num_traits::{One, Signed, ToPrimitive, Zero};

/// Numerator, and denominator, which is positive.
pub(super) type Long<'a> = (Cow<'a, BigInt>, Cow<'a, BigInt>);

/// Of numbers of the same length to so many bits, halving finds the common divisor faster than remainders do.
const ALIKE: u64 = 16;

/// So many remainders are looked at all the same: they end at once where a number is nearly a multiple of the other, as the
/// denominators of neighbours in a chain.
const FEW: usize = 6;

/// The largest common divisor of two numbers, not both zero.
fn common(a: &BigInt, b: &BigInt) -> BigInt {
    if b.is_one() || a.is_one() {
        return BigInt::one();
    }
    let (a, b) = (a.magnitude(), b.magnitude());
    let (a, b) = if a < b { (b, a) } else { (a, b) };
    let (mut long, mut short) = (Cow::Borrowed(a), Cow::Borrowed(b));
    let mut remainders = 0;
    let found = loop {
        if short.is_zero() {
            break long.into_owned();
        }
        if let Some(word) = short.to_u64() {
            let rest = (&*long % word).to_u64().expect("less than a word");
            break BigUint::from(word.gcd(&rest));
        }
        if remainders >= FEW && long.bits() <= short.bits() + ALIKE {
            break long.gcd(&short);
        }
        remainders += 1;
        let rest = &*long % &*short;
        (long, short) = (short, Cow::Owned(rest));
    };
    found.into()
}

/// A number over what divides it, mostly one.
fn over<'n>(a: &'n BigInt, divisor: &BigInt) -> Cow<'n, BigInt> {
    if divisor.is_one() { Cow::Borrowed(a) } else { Cow::Owned(a / divisor) }
}

pub(super) fn add((a, b): Long<'_>, (c, d): Long<'_>) -> BigRational {
    let g = common(&b, &d);
    let (b_over, d_over) = (over(&b, &g), over(&d, &g));
    let sum = &*a * &*d_over + &*c * &*b_over;
    if sum.is_zero() {
        return BigRational::zero();
    }
    // What is common to the sum and the denominator is a part of `g`.
    let common = if g.is_one() { BigInt::one() } else { common(&sum, &g) };
    BigRational::new_raw(over(&sum, &common).into_owned(), &*b_over * &*over(&d, &common))
}

pub(super) fn sub(x: Long<'_>, (c, d): Long<'_>) -> BigRational {
    add(x, (Cow::Owned(-c.into_owned()), d))
}

pub(super) fn mul((a, b): Long<'_>, (c, d): Long<'_>) -> BigRational {
    if a.is_zero() || c.is_zero() {
        return BigRational::zero();
    }
    let (g, h) = (common(&a, &d), common(&c, &b));
    BigRational::new_raw(&*over(&a, &g) * &*over(&c, &h), &*over(&b, &h) * &*over(&d, &g))
}

/// Order by the products with the other denominator: no common divisors are looked for.
pub(super) fn cmp((a, b): Long<'_>, (c, d): Long<'_>) -> Ordering {
    a.sign().cmp(&c.sign()).then_with(|| if b == d { a.cmp(&c) } else { (&*a * &*d).cmp(&(&*c * &*b)) })
}

/// # Panics
/// If the divisor is zero.
pub(super) fn div(x: Long<'_>, (c, d): Long<'_>) -> BigRational {
    assert!(!c.is_zero(), "division by zero");
    let turned = if c.is_negative() { (Cow::Owned(-d.into_owned()), Cow::Owned(-c.into_owned())) } else { (d, c) };
    mul(x, turned)
}
