//! Exact numbers: rationals that never overflow, and the integer elimination that kinematics and
//! borderline decisions stand on.
//!
//! Speeds, ratios and the signs that decide a verdict must not depend on a tolerance (a gear train
//! with ratio 10000/9999 is a real thing), so they are computed here. A [`Rational`] is a pair of
//! `i128` until it no longer fits, then a big integer; no operation can overflow or round.

pub(crate) mod blocks;
mod long;
mod polyhedron;
pub mod residue;

use std::borrow::Cow;
use std::cmp::Ordering;
use std::fmt;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};
use std::str::FromStr;

use num_bigint::BigInt;
use num_rational::{BigRational, Ratio};
use num_traits::{CheckedAdd, CheckedDiv, CheckedMul, CheckedSub, Signed, ToPrimitive, Zero};
use serde::de::{Deserialize, Deserializer, Error, Unexpected};
use serde::ser::{Serialize, Serializer};

pub(crate) use polyhedron::Polyhedron;
use residue::PRIME;

/// An exact rational number, as small as it can be and as large as it must be.
///
/// # Example
/// ```
/// use willis::exact::Rational;
/// let eta: Rational = "0.985".parse().unwrap();
/// assert_eq!(eta.to_string(), "197/200");
/// assert_eq!((Rational::from(1) / Rational::from(3) * Rational::from(3)), Rational::from(1));
/// // In answers for machines it is a text.
/// assert_eq!(serde_json::to_string(&eta)?, "\"197/200\"");
/// assert_eq!(serde_json::from_str::<Rational>("\"197/200\"")?, eta);
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Rational(Repr);

#[derive(Clone, Debug)]
enum Repr {
    Small(Ratio<i128>),
    Big(Box<BigRational>),
}

impl Rational {
    /// Zero.
    pub const ZERO: Self = Self(Repr::Small(Ratio::new_raw(0, 1)));
    /// One.
    pub const ONE: Self = Self(Repr::Small(Ratio::new_raw(1, 1)));

    /// `numerator / denominator`, reduced. The denominator must not be zero.
    ///
    /// # Panics
    /// If `denominator` is zero.
    pub fn new(numerator: i64, denominator: i64) -> Self {
        Self(Repr::Small(Ratio::new(numerator as i128, denominator as i128)))
    }

    /// The class modulo [`PRIME`]; none where that has none.
    pub(crate) fn modulo(&self) -> Option<u64> {
        let big = |n: &BigInt| {
            let class: BigInt = ((n % PRIME) + PRIME) % PRIME;
            class.to_u64().expect("below the prime")
        };
        let [numerator, denominator] = match &self.0 {
            Repr::Small(r) => [residue::of(*r.numer()), residue::of(*r.denom())],
            Repr::Big(r) => [big(r.numer()), big(r.denom())],
        };
        (denominator != 0).then(|| {
            if denominator == 1 { numerator } else { residue::times(numerator, residue::inverse(denominator)) }
        })
    }

    /// The exact value of the shortest decimal that reads back as `value`: `0.98` becomes 49/50,
    /// as its writer meant, not the binary fraction next to it. `None` for NaN and infinities.
    pub fn from_f64(value: f64) -> Option<Self> {
        value.is_finite().then(|| format!("{value:?}").parse().ok()).flatten()
    }

    fn big(&self) -> BigRational {
        match &self.0 {
            Repr::Small(r) => BigRational::new_raw((*r.numer()).into(), (*r.denom()).into()),
            Repr::Big(r) => (**r).clone(),
        }
    }

    /// Numerator and denominator.
    fn long(&self) -> long::Long<'_> {
        match &self.0 {
            Repr::Small(r) => (Cow::Owned((*r.numer()).into()), Cow::Owned((*r.denom()).into())),
            Repr::Big(r) => (Cow::Borrowed(r.numer()), Cow::Borrowed(r.denom())),
        }
    }

    fn from_big(value: BigRational) -> Self {
        match (value.numer().to_i128(), value.denom().to_i128()) {
            (Some(n), Some(d)) => Self(Repr::Small(Ratio::new_raw(n, d))),
            _ => Self(Repr::Big(Box::new(value))),
        }
    }

    /// Whether this is zero, exactly.
    pub fn is_zero(&self) -> bool {
        match &self.0 {
            Repr::Small(r) => r.is_zero(),
            Repr::Big(r) => r.is_zero(),
        }
    }

    /// −1, 0 or 1.
    pub fn sign(&self) -> i8 {
        match &self.0 {
            Repr::Small(r) => r.numer().signum() as i8,
            Repr::Big(r) => {
                if r.is_zero() {
                    0
                } else if r.is_negative() {
                    -1
                } else {
                    1
                }
            }
        }
    }

    /// Whether the denominator is one.
    pub fn is_integer(&self) -> bool {
        match &self.0 {
            Repr::Small(r) => r.is_integer(),
            Repr::Big(r) => r.is_integer(),
        }
    }

    /// Absolute value.
    pub fn abs(&self) -> Self {
        if self.sign() < 0 { -self.clone() } else { self.clone() }
    }

    /// The largest whole number that is not larger.
    pub fn floor(&self) -> Self {
        match &self.0 {
            Repr::Small(r) => Self(Repr::Small(r.floor())),
            Repr::Big(r) => Self::from_big(r.floor()),
        }
    }

    /// Numerator and denominator modulo `modulus`.
    pub(crate) fn residues(&self, modulus: u64) -> [u64; 2] {
        match &self.0 {
            Repr::Small(r) => [r.numer(), r.denom()].map(|x| x.rem_euclid(i128::from(modulus)) as u64),
            Repr::Big(r) => {
                let m = BigInt::from(modulus);
                [r.numer(), r.denom()].map(|x| ((x % &m + &m) % &m).to_u64().expect("below the modulus"))
            }
        }
    }

    /// `1 / self`.
    ///
    /// # Panics
    /// If this is zero.
    pub fn recip(&self) -> Self {
        Self::ONE / self
    }

    /// The nearest floating point number (to one unit in the last place).
    pub fn to_f64(&self) -> f64 {
        match &self.0 {
            Repr::Small(r) => {
                let (n, d) = (*r.numer(), *r.denom());
                if n.unsigned_abs() < 1 << 53 && d < 1 << 53 {
                    // Of 64 bits processors have a conversion, of 128 they have none.
                    n as i64 as f64 / d as i64 as f64
                } else {
                    self.big().to_f64().unwrap_or(f64::NAN)
                }
            }
            Repr::Big(r) => r.to_f64().unwrap_or(f64::NAN),
        }
    }

    /// `p/q`, also for integers (`3/1`): the form of the machine-readable results.
    pub fn to_fraction(&self) -> String {
        match &self.0 {
            Repr::Small(r) => format!("{}/{}", r.numer(), r.denom()),
            Repr::Big(r) => format!("{}/{}", r.numer(), r.denom()),
        }
    }
}

impl From<i64> for Rational {
    fn from(value: i64) -> Self {
        Self(Repr::Small(Ratio::from_integer(value as i128)))
    }
}

impl fmt::Display for Rational {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.0 {
            Repr::Small(r) => r.fmt(f),
            Repr::Big(r) => r.fmt(f),
        }
    }
}

/// Text that is neither a decimal number nor a fraction `p/q`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotANumber;

impl fmt::Display for NotANumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("not a finite decimal number or fraction")
    }
}

impl std::error::Error for NotANumber {}

impl FromStr for Rational {
    type Err = NotANumber;

    /// Reads `12`, `-0.985`, `1.5e-3`, `1_000` and `97/35`, exactly. Exponents beyond ±60 and more
    /// than 100 characters are refused, so that no text can demand unbounded work.
    fn from_str(text: &str) -> Result<Self, NotANumber> {
        if text.len() > 100 {
            return Err(NotANumber);
        }
        match text.split_once('/') {
            Some((n, d)) => {
                let (n, d) = (Self::from_decimal(n.trim())?, Self::from_decimal(d.trim())?);
                if d.is_zero() { Err(NotANumber) } else { Ok(n / d) }
            }
            None => Self::from_decimal(text),
        }
    }
}

/// Digits that a word holds.
const MOST_DIGITS: usize = 18;

impl Rational {
    fn from_decimal(text: &str) -> Result<Self, NotANumber> {
        let (mantissa, exponent) = match text.split_once(['e', 'E']) {
            Some((m, e)) => (m, e.parse::<i32>().map_err(|_| NotANumber)?),
            None => (text, 0),
        };
        let (negative, digits) = match mantissa.as_bytes().first() {
            Some(b'-') => (true, &mantissa[1..]),
            Some(b'+') => (false, &mantissa[1..]),
            _ => (false, mantissa),
        };
        let (whole, fraction) = digits.split_once('.').unwrap_or((digits, ""));
        let places = fraction.chars().filter(|c| *c != '_').count() as i32;
        let power = exponent.checked_sub(places).ok_or(NotANumber)?;
        // Nearly all are short: a word holds them.
        if whole.len() + fraction.len() <= MOST_DIGITS && power.unsigned_abs() as usize <= MOST_DIGITS {
            let mut value = 0;
            for c in whole.bytes().chain(fraction.bytes()).filter(|c| *c != b'_') {
                value = 10 * value + i64::from(char::from(c).to_digit(10).ok_or(NotANumber)?);
            }
            if whole.bytes().chain(fraction.bytes()).all(|c| c == b'_') {
                return Err(NotANumber);
            }
            let (value, ten) = (if negative { -value } else { value }, 10i64.pow(power.unsigned_abs()));
            return Ok(Self(Repr::Small(if power < 0 {
                word::fraction(value, ten)
            } else {
                Ratio::from_integer(i128::from(value) * i128::from(ten))
            })));
        }
        let mut value = BigInt::zero();
        let mut count = 0;
        for c in whole.chars().chain(fraction.chars()).filter(|c| *c != '_') {
            value = value * 10 + c.to_digit(10).ok_or(NotANumber)?;
            count += 1;
        }
        if count == 0 || exponent.abs() > 60 {
            return Err(NotANumber);
        }
        let ten = BigInt::from(10).pow(power.unsigned_abs());
        let value = if negative { -value } else { value };
        Ok(Self::from_big(if power < 0 {
            BigRational::new(value, ten)
        } else {
            BigRational::from_integer(value * ten)
        }))
    }
}

/// Operations of fractions of single words, which nearly all are: in double words they cannot overflow, and common
/// divisors are those of single words (Knuth, The Art of Computer Programming 2, 4.5.1).
mod word {
    use std::cmp::Ordering;

    use num_integer::Integer;
    use num_rational::Ratio;

    type Word = (i64, i64);

    pub fn of(r: &Ratio<i128>) -> Option<Word> {
        Some((i64::try_from(*r.numer()).ok()?, i64::try_from(*r.denom()).ok()?))
    }

    /// Both of the double words of a product.
    fn wide(a: i64, b: i64) -> i128 {
        i128::from(a) * i128::from(b)
    }

    /// The largest common divisor of a number and a denominator, which is mostly one.
    fn common(a: i64, denominator: i64) -> i64 {
        if denominator == 1 { 1 } else { a.gcd(&denominator) }
    }

    /// `numerator / denominator`, reduced; the denominator is positive.
    pub fn fraction(numerator: i64, denominator: i64) -> Ratio<i128> {
        let g = numerator.gcd(&denominator);
        Ratio::new_raw((numerator / g).into(), (denominator / g).into())
    }

    pub fn add((a, b): Word, (c, d): Word) -> Option<Ratio<i128>> {
        if b == 1 && d == 1 {
            return Some(Ratio::new_raw(i128::from(a) + i128::from(c), 1));
        }
        let g = if b == 1 { 1 } else { common(b, d) };
        let sum = wide(a, d / g) + wide(c, b / g);
        // What is common to the sum and the denominator is a part of `g`.
        let common = if g == 1 { 1 } else { ((sum % i128::from(g)) as i64).gcd(&g) };
        Some(Ratio::new_raw(if common == 1 { sum } else { sum / i128::from(common) }, wide(b / g, d / common)))
    }

    pub fn cmp((a, b): Word, (c, d): Word) -> Ordering {
        if b == d { a.cmp(&c) } else { wide(a, d).cmp(&wide(c, b)) }
    }

    pub fn sub(x: Word, (c, d): Word) -> Option<Ratio<i128>> {
        add(x, (c.checked_neg()?, d))
    }

    pub fn mul((a, b): Word, (c, d): Word) -> Option<Ratio<i128>> {
        if a == 0 || c == 0 {
            return Some(Ratio::new_raw(0, 1));
        }
        // The divisor of the least number has no absolute value.
        if a == i64::MIN || c == i64::MIN {
            return None;
        }
        let (g, h) = (common(a, d), common(c, b));
        if g == 1 && h == 1 {
            return Some(Ratio::new_raw(wide(a, c), wide(b, d)));
        }
        Some(Ratio::new_raw(wide(a / g, c / h), wide(b / h, d / g)))
    }

    pub fn div(x: Word, (c, d): Word) -> Option<Ratio<i128>> {
        match c {
            0 | i64::MIN => None,
            _ => mul(x, (d * c.signum(), c.abs())),
        }
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident, $checked:ident) => {
        impl $trait<&Rational> for &Rational {
            type Output = Rational;
            fn $method(self, other: &Rational) -> Rational {
                if let (Repr::Small(a), Repr::Small(b)) = (&self.0, &other.0) {
                    let quick = word::of(a).zip(word::of(b)).and_then(|(a, b)| word::$method(a, b));
                    if let Some(r) = quick.or_else(|| a.$checked(b)) {
                        return Rational(Repr::Small(r));
                    }
                }
                Rational::from_big(long::$method(self.long(), other.long()))
            }
        }
        impl $trait<Rational> for Rational {
            type Output = Rational;
            fn $method(self, other: Rational) -> Rational {
                (&self).$method(&other)
            }
        }
        impl $trait<&Rational> for Rational {
            type Output = Rational;
            fn $method(self, other: &Rational) -> Rational {
                (&self).$method(other)
            }
        }
        impl $trait<Rational> for &Rational {
            type Output = Rational;
            fn $method(self, other: Rational) -> Rational {
                self.$method(&other)
            }
        }
    };
}
operator!(Add, add, checked_add);
operator!(Sub, sub, checked_sub);
operator!(Mul, mul, checked_mul);
operator!(Div, div, checked_div);

impl AddAssign<Rational> for Rational {
    fn add_assign(&mut self, other: Rational) {
        *self = &*self + &other;
    }
}

impl SubAssign<Rational> for Rational {
    fn sub_assign(&mut self, other: Rational) {
        *self = &*self - &other;
    }
}

impl Neg for Rational {
    type Output = Rational;
    fn neg(self) -> Rational {
        -&self
    }
}

impl Neg for &Rational {
    type Output = Rational;
    fn neg(self) -> Rational {
        match &self.0 {
            Repr::Small(r) if *r.numer() != i128::MIN => Rational(Repr::Small(Ratio::new_raw(-r.numer(), *r.denom()))),
            _ => &Rational::ZERO - self,
        }
    }
}

impl PartialEq for Rational {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}
impl Eq for Rational {}
impl PartialOrd for Rational {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Rational {
    fn cmp(&self, other: &Self) -> Ordering {
        if let (Repr::Small(a), Repr::Small(b)) = (&self.0, &other.0) {
            return word::of(a).zip(word::of(b)).map_or_else(|| a.cmp(b), |(a, b)| word::cmp(a, b));
        }
        long::cmp(self.long(), other.long())
    }
}

/// Longest fraction that is read back: what an answer can hold, and no text that keeps a reader busy.
const LONGEST: usize = 100_000;

impl Rational {
    /// Reads what [`Rational::to_fraction`] writes, however long.
    fn from_fraction(text: &str) -> Option<Self> {
        let (n, d) = text.split_once('/').filter(|_| text.len() <= LONGEST)?;
        let (n, d): (BigInt, BigInt) = (n.parse().ok()?, d.parse().ok()?);
        d.is_positive().then(|| Self::from_big(BigRational::new(n, d)))
    }
}

/// As text, `p/q`: no format for machines has a number that would hold it.
impl Serialize for Rational {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.to_fraction())
    }
}

impl<'de> Deserialize<'de> for Rational {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = Cow::<str>::deserialize(deserializer)?;
        let wrong = || D::Error::invalid_value(Unexpected::Str(&text), &"a fraction `p/q`");
        Self::from_fraction(&text).ok_or_else(wrong)
    }
}

#[cfg(feature = "schema")]
impl schemars::JsonSchema for Rational {
    fn schema_name() -> Cow<'static, str> {
        "Fraction".into()
    }

    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        schemars::json_schema!({
            "description": "An exact number as a fraction `p/q` in lowest terms, also a whole one: `3/1`.",
            "type": "string",
            "pattern": "^-?[0-9]+/[1-9][0-9]*$",
        })
    }
}

/// A dense matrix of rationals, rows of equal length.
pub(crate) type Matrix = Vec<Vec<Rational>>;

/// Reduced row echelon form in place, pivoting only in the first `columns` columns; returns the
/// pivot column of each of the leading rows. The rows after them are zero in those columns.
///
/// First down, then up: a row is cleared only with rows that are cleared themselves, so that the work on a chain, whose
/// rows have few entries, grows with its length.
pub(crate) fn reduce(matrix: &mut Matrix, columns: usize) -> Vec<usize> {
    let mut pivots = Vec::new();
    for column in 0..columns {
        let top = pivots.len();
        // The shortest row keeps fractions small.
        let found = (top..matrix.len())
            .filter(|&r| !matrix[r][column].is_zero())
            .min_by_key(|&r| matrix[r].iter().filter(|x| !x.is_zero()).count());
        let Some(found) = found else { continue };
        matrix.swap(top, found);
        let inverse = matrix[top][column].recip();
        for x in matrix[top].iter_mut().filter(|x| !x.is_zero()) {
            *x = &*x * &inverse;
        }
        let (done, rest) = matrix.split_at_mut(top + 1);
        rest.iter_mut().for_each(|row| clear(row, &done[top], column));
        pivots.push(column);
    }
    for (top, &column) in pivots.iter().enumerate().rev() {
        let (above, rest) = matrix.split_at_mut(top);
        above.iter_mut().for_each(|row| clear(row, &rest[0], column));
    }
    pivots
}

/// Takes from a row as much of another, which has a one in this column, as leaves a zero there.
fn clear(row: &mut [Rational], by: &[Rational], column: usize) {
    if row[column].is_zero() {
        return;
    }
    let factor = row[column].clone();
    for (x, p) in row.iter_mut().zip(by).filter(|(_, p)| !p.is_zero()) {
        *x = &*x - &(&factor * p);
    }
}

/// Basis of the vectors that the rows take to zero. Each has an entry 1, its last that is not zero, where the others
/// have 0.
pub(crate) fn null_space(mut rows: Matrix, columns: usize) -> Matrix {
    let pivots = reduce(&mut rows, columns);
    (0..columns)
        .filter(|k| !pivots.contains(k))
        .map(|free| {
            let mut vector = vec![Rational::ZERO; columns];
            vector[free] = Rational::ONE;
            for (row, &pivot) in rows.iter().zip(&pivots) {
                vector[pivot] = -row[free].clone();
            }
            vector
        })
        .collect()
}

/// Solution of a square system, or `None` when it is singular.
pub(crate) fn solve(matrix: &Matrix, right: &[Rational]) -> Option<Vec<Rational>> {
    let n = right.len();
    let mut rows: Matrix = matrix.iter().zip(right).map(|(row, b)| row.iter().chain([b]).cloned().collect()).collect();
    (reduce(&mut rows, n).len() == n).then(|| rows.into_iter().map(|mut r| r.pop().unwrap()).collect())
}

/// Rank of a matrix.
///
/// Independent rows are the rule: elimination modulo a prime shows it, for what is not zero modulo a prime is not zero. Only
/// what seems dependent there is looked at exactly.
pub(crate) fn rank(mut matrix: Matrix, columns: usize) -> usize {
    match rank_modulo(&matrix, columns) == Some(matrix.len()) {
        true => matrix.len(),
        false => reduce(&mut matrix, columns).len(),
    }
}

/// The rank modulo a large prime, of which a denominator may be a multiple: then there is none.
fn rank_modulo(matrix: &Matrix, columns: usize) -> Option<usize> {
    let entries = matrix.iter().flat_map(|row| &row[..columns]);
    let mut residues = Vec::with_capacity(matrix.len() * columns);
    for x in entries {
        residues.push(x.modulo()?);
    }
    Some(residue::rank(&mut residues, columns))
}

/// Determinant of a square matrix.
pub(crate) fn determinant(matrix: &Matrix) -> Rational {
    let mut m = matrix.clone();
    let n = m.len();
    let mut det = Rational::ONE;
    for c in 0..n {
        let Some(p) = (c..n).find(|&r| !m[r][c].is_zero()) else { return Rational::ZERO };
        if p != c {
            m.swap(p, c);
            det = -det;
        }
        det = &det * &m[c][c];
        let (done, rest) = m.split_at_mut(c + 1);
        let pivot = &done[c];
        for row in rest.iter_mut().filter(|row| !row[c].is_zero()) {
            let factor = &row[c] / &pivot[c];
            for k in c..n {
                if !pivot[k].is_zero() {
                    row[k] = &row[k] - &(&factor * &pivot[k]);
                }
            }
        }
    }
    det
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regular_matrices_are_told_from_singular_ones() {
        let prime = Rational::new(PRIME as i64, 1);
        let huge = (0..9).fold(Rational::ONE, |x, _| x * Rational::new(i64::MAX, 3));
        let rows = |m: [[Rational; 2]; 2]| -> Matrix { m.into_iter().map(|r| r.into_iter().collect()).collect() };
        let [one, two, four] = [1, 2, 4].map(|k| Rational::new(k, 7));
        // Regular, though zero modulo the prime; with numbers that have no class; with large ones.
        assert_eq!(rank(rows([[prime.clone(), Rational::ZERO], [Rational::ZERO, Rational::ONE]]), 2), 2);
        assert_eq!(rank(rows([[prime.recip(), Rational::ZERO], [Rational::ZERO, Rational::ONE]]), 2), 2);
        assert_eq!(rank(rows([[huge.clone(), one.clone()], [one.clone(), -huge.clone()]]), 2), 2);
        assert_eq!(rank(rows([[Rational::ZERO, one.clone()], [two.clone(), one.clone()]]), 2), 2);
        for singular in [
            rows([[one.clone(), two.clone()], [two, four]]),
            rows([[huge.clone(), one.clone()], [&huge * &huge, &huge * &one]]),
            rows([[Rational::ZERO, one.clone()], [Rational::ZERO, one]]),
        ] {
            assert_eq!(rank(singular, 2), 1);
        }
    }

    #[test]
    fn reads_decimals_exactly() {
        let read = |s: &str| s.parse::<Rational>().map(|r| r.to_string());
        assert_eq!(read("0.985").unwrap(), "197/200");
        assert_eq!(read("-1.5e-3").unwrap(), "-3/2000");
        assert_eq!(read("2e3").unwrap(), "2000");
        assert_eq!(read("97/35").unwrap(), "97/35");
        for bad in ["", "-", ".", "nan", "inf", "1/0", "1/2/3", "1e400", "0x10", "1 2", "--1"] {
            assert_eq!(read(bad), Err(NotANumber), "{bad}");
        }
        assert_eq!(Rational::from_f64(0.98).unwrap().to_string(), "49/50");
        assert_eq!(Rational::from_f64(f64::NAN), None);
    }

    /// Every operation of any two of these, beside that of the library of long fractions.
    fn are_those_of_the_library(parts: &[Rational]) {
        for a in parts {
            for b in parts {
                let all = [(a + b, a.big() + b.big()), (a - b, a.big() - b.big()), (a * b, a.big() * b.big())];
                assert_eq!(a.cmp(b), a.big().cmp(&b.big()), "{a} and {b}");
                let quotient = (!b.is_zero()).then(|| (a / b, a.big() / b.big()));
                for (found, exact) in all.into_iter().chain(quotient) {
                    let found = found.big();
                    assert_eq!((found.numer(), found.denom()), (exact.numer(), exact.denom()), "{a} and {b}");
                }
            }
        }
    }

    #[test]
    fn fractions_of_words_are_those_of_any_length() {
        let words = [0, 1, -1, 2, 3, 6, -12, 35, 1 << 31, (1 << 62) - 1, i64::MAX, i64::MIN + 1, i64::MIN];
        let parts: Vec<Rational> =
            (words.iter()).flat_map(|&n| words.iter().filter(|d| **d > 0).map(move |&d| Rational::new(n, d))).collect();
        are_those_of_the_library(&parts);
    }

    /// Of lengths that differ and that do not, with divisors in common and without.
    #[test]
    fn long_fractions_are_those_of_the_library() {
        let power = |n: i64, k: usize| (0..k).fold(Rational::ONE, |x, _| x * Rational::from(n));
        let mut parts: Vec<Rational> = vec![Rational::ZERO, Rational::ONE, Rational::new(-7, 3), Rational::new(35, 6)];
        for (k, [n, d]) in [[7, 3], [35, 6], [2, 5], [101, 97]].into_iter().enumerate() {
            for length in [20, 45, 46, 90] {
                parts.push(&power(n, length + k) / &power(d, length));
                parts.push(-(&power(d, length) / &(&power(n, length) + &Rational::ONE)));
                parts.push(&power(n, length) / &Rational::from(d));
            }
        }
        are_those_of_the_library(&parts);
    }

    #[test]
    fn grows_past_128_bits_and_comes_back() {
        let third = Rational::new(1, 3);
        let mut x = Rational::ONE;
        for _ in 0..120 {
            x = &x * &third;
        }
        assert!(matches!(x.0, Repr::Big(_)));
        for _ in 0..120 {
            x = &x / &third;
        }
        assert!(matches!(x.0, Repr::Small(_)));
        assert_eq!(x, Rational::ONE);
    }

    /// Of random rows, many of them dependent: the one reduced form that spans the same.
    #[test]
    fn rows_are_reduced() {
        let mut seed = 5u64;
        let mut random = |below: usize| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 33) as usize % below
        };
        let mut dependent = 0;
        for _ in 0..500 {
            let (count, columns, extra) = (1 + random(7), 1 + random(7), random(3));
            let entry = |k: usize| if k > 7 { Rational::ZERO } else { Rational::new(k as i64 - 3, 1 + k as i64 % 3) };
            let rows: Matrix = (0..count).map(|_| (0..columns + extra).map(|_| entry(random(14))).collect()).collect();
            let mut reduced = rows.clone();
            let pivots = reduce(&mut reduced, columns);
            assert!(pivots.is_sorted_by(|a, b| a < b));
            for (top, &pivot) in pivots.iter().enumerate() {
                assert!(reduced[top][..pivot].iter().all(Rational::is_zero), "{rows:?}");
                assert!((0..count).all(|r| reduced[r][pivot] == Rational::from(i64::from(r == top))), "{rows:?}");
            }
            assert!(reduced[pivots.len()..].iter().all(|row| row[..columns].iter().all(Rational::is_zero)));
            // Each row of either is a sum of rows of the other.
            let both: Matrix = rows.iter().chain(&reduced).cloned().collect();
            let of = |m: &Matrix| rank(m.clone(), columns + extra);
            assert_eq!([of(&rows), of(&reduced)], [of(&both); 2], "{rows:?}");
            dependent += usize::from(pivots.len() < count);
        }
        assert!(dependent > 100, "{dependent}");
    }

    #[test]
    fn solves_and_finds_singular() {
        let m = |v: [[i64; 2]; 2]| v.map(|r| r.map(Rational::from).to_vec()).to_vec();
        let x = solve(&m([[2, 1], [1, 3]]), &[5.into(), 10.into()]).unwrap();
        assert_eq!(x, [1.into(), 3.into()]);
        assert_eq!(solve(&m([[1, 2], [2, 4]]), &[1.into(), 2.into()]), None);
        assert_eq!(determinant(&m([[0, 1], [1, 3]])), Rational::from(-1));
    }
}
