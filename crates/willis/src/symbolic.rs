//! Exact rational functions of many symbols: what the closed formulas are made of.
//!
//! A [`Polynomial`] has rational coefficients; a [`RationalFunction`] is a product of polynomials with
//! positive and negative powers, always in lowest terms and factored, because that is the form in
//! which a person recognises a formula. The determinants of gear trains are *multilinear* (each
//! element's ratio occurs in one column), and for multilinear polynomials splitting off contents
//! finds every factor: two factors never share a symbol. Higher powers arise only in derivatives
//! and sums; there, square factors are found and the rest is left as it is.

use std::cmp::Ordering;
use std::collections::{BTreeMap, HashMap};
use std::hash::{Hash, Hasher};
use std::sync::Arc;

use smallvec::SmallVec;

use crate::exact::Rational;
use crate::exact::blocks::{blocks, is_odd};
use crate::exact::residue::{PRIME, inverse, plus, times};

/// A symbol's number; what it is called is the printer's affair.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Symbol(pub usize);

/// The symbols that occur, in order, with their exponents, which are not zero. Of many symbols few occur in one term.
/// Ordered as people write: by degree, then by symbol.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
struct Monomial(SmallVec<[(Symbol, u32); 3]>);

impl Monomial {
    fn degree(&self) -> u32 {
        self.0.iter().map(|(_, e)| e).sum()
    }

    fn of(&self, s: Symbol) -> u32 {
        self.0.iter().find(|own| own.0 == s).map_or(0, |own| own.1)
    }

    fn with(&self, s: Symbol, exponent: u32) -> Self {
        let mut all = self.clone();
        match (all.0.binary_search_by_key(&s, |own| own.0), exponent) {
            (Ok(at), 0) => drop(all.0.remove(at)),
            (Ok(at), _) => all.0[at].1 = exponent,
            (Err(_), 0) => {}
            (Err(at), _) => all.0.insert(at, (s, exponent)),
        }
        all
    }

    fn times(&self, other: &Self) -> Self {
        let mut product = SmallVec::with_capacity(self.0.len() + other.0.len());
        let (mut a, mut b) = (self.0.iter().copied().peekable(), other.0.iter().copied().peekable());
        loop {
            product.push(match (a.peek(), b.peek()) {
                (None, None) => return Self(product),
                (Some(x), Some(y)) if x.0 == y.0 => {
                    let both = (x.0, x.1 + y.1);
                    a.next();
                    b.next();
                    both
                }
                (Some(x), y) if y.is_none_or(|y| x.0 < y.0) => a.next().expect("seen"),
                _ => b.next().expect("seen"),
            });
        }
    }

    fn over(&self, other: &Self) -> Option<Self> {
        let mut quotient = self.clone();
        for &(s, exponent) in &other.0 {
            quotient = quotient.with(s, self.of(s).checked_sub(exponent)?);
        }
        Some(quotient)
    }
}

impl Ord for Monomial {
    fn cmp(&self, other: &Self) -> Ordering {
        // Of one degree, the one with more of the first symbol in which they differ comes first.
        let by_symbol = || {
            let first = self.0.iter().zip(&other.0).find(|(a, b)| a != b);
            first.map_or(Ordering::Equal, |(a, b)| a.0.cmp(&b.0).then(b.1.cmp(&a.1)))
        };
        self.degree().cmp(&other.degree()).then_with(by_symbol)
    }
}

impl PartialOrd for Monomial {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// A polynomial with rational coefficients.
///
/// # Example
/// ```
/// use willis::symbolic::{Polynomial, Symbol};
/// let (x, y) = (Polynomial::symbol(Symbol(0)), Polynomial::symbol(Symbol(1)));
/// let one = Polynomial::from(1);
/// let p = &(&one - &x) * &(&one + &y);
/// assert_eq!(p.to_function().factors().len(), 2);
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Polynomial(Arc<Terms>);

/// Monomials with their coefficients, which are not zero, in order.
type Terms = Vec<(Monomial, Rational)>;

impl Ord for Polynomial {
    fn cmp(&self, other: &Self) -> Ordering {
        // Formulas share their factors.
        if Arc::ptr_eq(&self.0, &other.0) { Ordering::Equal } else { self.0.cmp(&other.0) }
    }
}

impl PartialOrd for Polynomial {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Hash for Polynomial {
    fn hash<H: Hasher>(&self, state: &mut H) {
        // Of equal ones the monomials are equal, and few differ in their coefficients alone.
        self.monomials().for_each(|m| m.hash(state));
    }
}

impl FromIterator<(Monomial, Rational)> for Polynomial {
    fn from_iter<I: IntoIterator<Item = (Monomial, Rational)>>(terms: I) -> Self {
        let mut all = Terms::new();
        terms.into_iter().for_each(|(m, c)| add_term(&mut all, m, c));
        Self(Arc::new(all))
    }
}

/// Adds a term in its place; many come in order.
fn add_term(terms: &mut Terms, m: Monomial, c: Rational) {
    if c.is_zero() {
        return;
    }
    if terms.last().is_none_or(|last| last.0 < m) {
        return terms.push((m, c));
    }
    match terms.binary_search_by(|own| own.0.cmp(&m)) {
        Err(at) => terms.insert(at, (m, c)),
        Ok(at) => {
            terms[at].1 = &terms[at].1 + &c;
            if terms[at].1.is_zero() {
                terms.remove(at);
            }
        }
    }
}

impl From<i64> for Polynomial {
    fn from(value: i64) -> Self {
        Self::constant(value.into())
    }
}

impl Polynomial {
    /// A number.
    pub fn constant(value: Rational) -> Self {
        Self::from_iter([(Monomial::default(), value)])
    }

    /// One symbol.
    pub fn symbol(s: Symbol) -> Self {
        Self::from_iter([(Monomial::default().with(s, 1), Rational::ONE)])
    }

    fn monomials(&self) -> impl Iterator<Item = &Monomial> {
        self.0.iter().map(|own| &own.0)
    }

    fn numbers(&self) -> impl Iterator<Item = &Rational> {
        self.0.iter().map(|own| &own.1)
    }

    /// Whether this is zero.
    pub fn is_zero(&self) -> bool {
        self.0.is_empty()
    }

    /// Its value, when no symbol occurs in it.
    pub fn as_constant(&self) -> Option<Rational> {
        match self.0.first() {
            None => Some(Rational::ZERO),
            Some((m, c)) => (self.0.len() == 1 && m.0.is_empty()).then(|| c.clone()),
        }
    }

    /// Number of terms.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether there is no term.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Terms in the order in which people write them: each a coefficient and the powers of symbols.
    pub fn terms(&self) -> impl Iterator<Item = (&Rational, Vec<(Symbol, u32)>)> {
        self.0.iter().map(|(m, c)| (c, m.0.to_vec()))
    }

    /// Symbols that occur.
    pub fn symbols(&self) -> Vec<Symbol> {
        let mut all: Vec<Symbol> = self.monomials().flat_map(|m| m.0.iter().map(|own| own.0)).collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    /// Whether no power of a symbol is above the first.
    fn is_multilinear(&self) -> bool {
        self.monomials().all(|m| m.0.iter().all(|own| own.1 <= 1))
    }

    /// Highest power of a symbol.
    pub fn degree(&self, s: Symbol) -> u32 {
        self.monomials().map(|m| m.of(s)).max().unwrap_or(0)
    }

    /// Coefficients of the powers of `s`, from the zeroth.
    fn coefficients(&self, s: Symbol) -> Vec<Self> {
        let mut all = vec![Terms::new(); self.degree(s) as usize + 1];
        for (m, c) in self.0.iter() {
            all[m.of(s) as usize].push((m.with(s, 0), c.clone()));
        }
        all.into_iter().map(Self::from_iter).collect()
    }

    fn from_coefficients(all: &[Self], s: Symbol) -> Self {
        let raised = |k| move |(m, c): &(Monomial, Rational)| (m.with(s, k as u32), c.clone());
        all.iter().enumerate().flat_map(|(k, part)| part.0.iter().map(raised(k))).collect()
    }

    /// The product with a number.
    pub fn scaled(&self, factor: &Rational) -> Self {
        if factor.is_zero() {
            return Self::default();
        }
        self.0.iter().map(|(m, c)| (m.clone(), c * factor)).collect()
    }

    /// The derivative with respect to a symbol.
    pub fn derivative(&self, s: Symbol) -> Self {
        let lowered = |(m, c): &(Monomial, Rational)| (m.with(s, m.of(s) - 1), c * &Rational::from(i64::from(m.of(s))));
        self.0.iter().filter(|(m, _)| m.of(s) > 0).map(lowered).collect()
    }

    /// The value for given values of the symbols.
    pub fn evaluate(&self, value: &dyn Fn(Symbol) -> Rational) -> Rational {
        self.0.iter().fold(Rational::ZERO, |sum, (m, c)| {
            let mut term = c.clone();
            for (s, e) in &m.0 {
                let v = value(*s);
                (0..*e).for_each(|_| term = &term * &v);
            }
            sum + term
        })
    }

    /// The leading number that is split off so that coefficients are whole, without a common
    /// divisor, and the first term is positive.
    fn numeric_content(&self) -> Rational {
        let Some(first) = self.numbers().next() else { return Rational::ONE };
        let content = self.numbers().fold(None, |g: Option<Rational>, c| {
            Some(match g {
                None => c.abs(),
                Some(g) => common_divisor(&g, &c.abs()),
            })
        });
        let content = content.unwrap_or(Rational::ONE);
        if first.sign() < 0 { -content } else { content }
    }

    /// Divided by its numeric content.
    fn primitive(&self) -> Self {
        self.scaled(&self.numeric_content().recip())
    }

    /// The quotient, when the division leaves no remainder.
    fn divided(&self, by: &Self) -> Option<Self> {
        let (lead, lead_c) = by.0.last()?;
        let mut rest = Terms::clone(&self.0);
        // The greatest term comes first.
        let mut quotient = Terms::new();
        while let Some((m, c)) = rest.last() {
            let (m, c) = (m.over(lead)?, c / lead_c);
            for (bm, bc) in by.0.iter() {
                add_term(&mut rest, m.times(bm), -(&c * bc));
            }
            quotient.push((m, c));
        }
        quotient.reverse();
        Some(Self(Arc::new(quotient)))
    }

    /// The content with respect to a symbol: the greatest common divisor of its coefficients.
    fn content(&self, s: Symbol) -> Self {
        let mut g = Self::default();
        for c in self.coefficients(s) {
            g = g.gcd(&c);
            if g.as_constant().is_some_and(|c| !c.is_zero()) {
                break;
            }
        }
        g
    }

    /// The greatest common divisor, numerically primitive, by primitive remainder sequences; one when
    /// it is out of reach.
    fn gcd(&self, other: &Self) -> Self {
        if self.is_zero() || other.is_zero() {
            let p = if self.is_zero() { other } else { self };
            return if p.is_zero() { p.clone() } else { p.primitive() };
        }
        let Some(&s) = self.symbols().first() else { return Self::from(1) };
        if seem_coprime(self, other) {
            return Self::from(1);
        }
        if other.degree(s) == 0 {
            return self.content(s).gcd(other);
        }
        let found = self.remainder_sequence(other, s);
        // A divisor that was not found in full may have left what does not divide.
        let divides = |p: &Self| p.divided(&found).is_some();
        if divides(self) && divides(other) { found } else { Self::from(1) }
    }

    fn remainder_sequence(&self, other: &Self, s: Symbol) -> Self {
        let (ca, cb) = (self.content(s), other.content(s));
        let mut a = self.divided(&ca).expect("content divides");
        let mut b = other.divided(&cb).expect("content divides");
        if a.degree(s) < b.degree(s) {
            std::mem::swap(&mut a, &mut b);
        }
        loop {
            if a.len() * b.len() > MOST_PRODUCTS {
                return Self::from(1);
            }
            let r = a.pseudo_remainder(&b, s);
            if r.is_zero() {
                break;
            }
            if r.degree(s) == 0 {
                b = Self::from(1);
                break;
            }
            let content = r.content(s);
            (a, b) = (b, r.divided(&content).expect("content divides"));
        }
        (&ca.gcd(&cb) * &b).primitive()
    }

    fn pseudo_remainder(&self, by: &Self, s: Symbol) -> Self {
        let b = by.coefficients(s);
        let lead = b.last().expect("not zero");
        let mut rest = self.clone();
        while !rest.is_zero() && rest.degree(s) as usize >= b.len() - 1 {
            let a = rest.coefficients(s);
            let (top, shift) = (a.last().expect("not zero").clone(), a.len() - b.len());
            let mut shifted = vec![Self::default(); shift];
            shifted.extend(b.iter().map(|c| c * &top));
            rest = &(&rest * lead) - &Self::from_coefficients(&shifted, s);
        }
        rest
    }

    /// Products of powers in the place of symbols; `None` when a value is a sum.
    fn with_monomials(&self, values: &BTreeMap<Symbol, RationalFunction>) -> Option<RationalFunction> {
        let sum = |f: &RationalFunction| f.factors.iter().any(|(p, _)| p.len() > 1);
        if values.values().any(sum) {
            return None;
        }
        let mut terms: Vec<(Rational, BTreeMap<Symbol, i32>)> = Vec::new();
        for (c, powers) in self.terms() {
            let (mut c, mut exponents) = (c.clone(), BTreeMap::new());
            for (s, e) in powers {
                let value = &values[&s];
                (0..e).for_each(|_| c = &c * &value.number);
                for (p, own) in &value.factors {
                    let symbol = p.symbols()[0];
                    *exponents.entry(symbol).or_insert(0) += own * e as i32;
                }
            }
            if !c.is_zero() {
                terms.push((c, exponents));
            }
        }
        // Negative powers go below the line.
        let mut lowest: BTreeMap<Symbol, i32> = BTreeMap::new();
        for (_, exponents) in &terms {
            for (s, e) in exponents.iter().filter(|(_, e)| **e < 0) {
                let low = lowest.entry(*s).or_insert(0);
                *low = (*low).min(*e);
            }
        }
        let raised = |(c, exponents): (Rational, BTreeMap<Symbol, i32>)| {
            let mut m = Monomial::default();
            for s in exponents.keys().chain(lowest.keys()) {
                let e = exponents.get(s).copied().unwrap_or(0) - lowest.get(s).copied().unwrap_or(0);
                m = m.with(*s, e as u32);
            }
            (m, c)
        };
        let p: Self = terms.into_iter().map(raised).collect();
        let below = lowest.into_iter().map(|(s, e)| (Self::symbol(s), e));
        Some(p.to_function().times(&RationalFunction::collect(Rational::ONE, below)))
    }

    /// This with functions in the place of symbols, of which `None` leaves one as it is; `None` where all are left.
    pub(crate) fn substituted(&self, value: &dyn Fn(Symbol) -> Option<RationalFunction>) -> Option<RationalFunction> {
        // Most factors have none of the symbols.
        self.monomials().flat_map(|m| &m.0).find(|own| value(own.0).is_some())?;
        let of = |s| (s, value(s).unwrap_or_else(|| RationalFunction::symbol(s)));
        let values: BTreeMap<Symbol, RationalFunction> = self.symbols().into_iter().map(of).collect();
        Some(self.with_monomials(&values).unwrap_or_else(|| {
            self.terms().fold(RationalFunction::ZERO, |sum, (c, powers)| {
                let mut term = RationalFunction::from(c.clone());
                for (s, e) in powers {
                    (0..e).for_each(|_| term = term.times(&values[&s]));
                }
                sum.plus(&term)
            })
        }))
    }

    /// This polynomial as a product of its factors.
    pub fn to_function(&self) -> RationalFunction {
        if self.is_zero() {
            return RationalFunction::ZERO;
        }
        let number = self.numeric_content();
        let mut factors = Vec::new();
        split(self.scaled(&number.recip()), &mut factors);
        RationalFunction::collect(number, factors.into_iter().map(|p| (p, 1)))
    }
}

/// Splits a primitive polynomial by monomials, contents and squares.
fn split(p: Polynomial, factors: &mut Vec<Polynomial>) {
    if p.as_constant().is_some() {
        return;
    }
    for s in p.symbols() {
        let lowest = p.monomials().map(|m| m.of(s)).min().unwrap_or(0);
        if lowest > 0 {
            let (x, one) = (Polynomial::symbol(s), p.0.iter());
            factors.extend((0..lowest).map(|_| x.clone()));
            let rest = one.map(|(m, c)| (m.with(s, m.of(s) - lowest), c.clone())).collect();
            return split(rest, factors);
        }
    }
    if let Some(all) = multilinear_factors(&p) {
        factors.extend(all);
        return;
    }
    for s in p.symbols() {
        let mut parts = vec![p.content(s)];
        if p.degree(s) > 1 {
            parts.push(p.gcd(&p.derivative(s)));
        }
        for part in parts {
            if part.as_constant().is_none() {
                let rest = p.divided(&part).expect("it divides");
                split(part.primitive(), factors);
                return split(rest.primitive(), factors);
            }
        }
    }
    factors.push(p.primitive());
}

/// Products of terms in a step towards a common divisor beyond which it is not looked for.
const MOST_PRODUCTS: usize = 20_000;

/// An arbitrary but fixed value for a symbol.
fn probe(s: Symbol) -> u64 {
    (s.0 as u64 * 7919 + 104_729) % 9973 + 2
}

/// The irreducible factors of a primitive polynomial that is linear in every symbol; `None` when it
/// is not, or when the probe met an unlucky point.
///
/// Two symbols are in one factor exactly when `p p_xy ≠ p_x p_y`. At the probe point an inequality
/// is certain, and an equality is confirmed by multiplying the factors that it leads to.
fn multilinear_factors(p: &Polynomial) -> Option<Vec<Polynomial>> {
    let symbols = p.symbols();
    if symbols.iter().any(|s| p.degree(*s) > 1) {
        return None;
    }
    let n = symbols.len();
    // Values of p, its first and its mixed second derivatives.
    let (mut value, mut first, mut second) = (0u64, vec![0u64; n], vec![0u64; n * n]);
    let inverse: Vec<u64> = symbols.iter().map(|s| inverse(probe(*s))).collect();
    for (m, c) in p.0.iter() {
        let mut term = residue(c);
        let present: Vec<usize> = (0..n).filter(|&k| m.of(symbols[k]) == 1).collect();
        for &k in &present {
            term = times(term, probe(symbols[k]));
        }
        value = plus(value, term);
        for (at, &x) in present.iter().enumerate() {
            let without = times(term, inverse[x]);
            first[x] = plus(first[x], without);
            for &y in &present[..at] {
                let slot = &mut second[y * n + x];
                *slot = plus(*slot, times(without, inverse[y]));
            }
        }
    }
    let mut group: Vec<usize> = (0..n).collect();
    for x in 0..n {
        for y in 0..x {
            if group[x] != group[y] && times(value, second[y * n + x]) != times(first[x], first[y]) {
                let (keep, drop) = (group[x].min(group[y]), group[x].max(group[y]));
                group.iter_mut().filter(|g| **g == drop).for_each(|g| *g = keep);
            }
        }
    }
    let mut parts: Vec<usize> = group.clone();
    parts.sort_unstable();
    parts.dedup();
    if parts.len() == 1 {
        return Some(vec![p.clone()]);
    }
    // A factor is what remains when the symbols of the others are numbers.
    let factors: Vec<Polynomial> = parts
        .iter()
        .map(|part| {
            let of = |(m, c): &(Monomial, Rational)| {
                let (mut rest, mut c) = (m.clone(), c.clone());
                for k in (0..n).filter(|&k| group[k] != *part && m.of(symbols[k]) == 1) {
                    rest = rest.with(symbols[k], 0);
                    c = c * Rational::from(probe(symbols[k]) as i64);
                }
                (rest, c)
            };
            let factor: Polynomial = p.0.iter().map(of).collect();
            if factor.is_zero() { factor } else { factor.primitive() }
        })
        .collect();
    let product = factors.iter().fold(Polynomial::from(1), |product, f| &product * f);
    (product == *p).then_some(factors)
}

/// A number modulo the prime.
fn residue(c: &Rational) -> u64 {
    let [n, d] = c.residues(PRIME);
    if d == 1 { n } else { times(n, inverse(d)) }
}

/// The coefficients of the powers of `s`, all other symbols at the probe point.
fn image(p: &Polynomial, s: Symbol) -> Vec<u64> {
    let mut all = vec![0u64; p.degree(s) as usize + 1];
    for (m, c) in p.0.iter() {
        let mut term = residue(c);
        for (other, e) in m.0.iter().filter(|own| own.0 != s) {
            (0..*e).for_each(|_| term = times(term, probe(*other)));
        }
        let slot = &mut all[m.of(s) as usize];
        *slot = (*slot + term) % PRIME;
    }
    while all.last() == Some(&0) {
        all.pop();
    }
    all
}

/// Whether no symbol occurs in a common divisor, as far as the probe point tells. A wrong yes, for
/// which the point would have to be most unlucky, leaves a formula longer than need be, not wrong.
fn seem_coprime(a: &Polynomial, b: &Polynomial) -> bool {
    let other = b.symbols();
    a.symbols().into_iter().filter(|s| other.contains(s)).all(|s| {
        let (mut a, mut b) = (image(a, s), image(b, s));
        while !b.is_empty() {
            // a modulo b
            let lead = inverse(*b.last().expect("not empty"));
            while a.len() >= b.len() {
                let factor = times(*a.last().expect("longer than b"), lead);
                let shift = a.len() - b.len();
                for (k, c) in b.iter().enumerate() {
                    a[shift + k] = (a[shift + k] + PRIME - times(factor, *c)) % PRIME;
                }
                while a.last() == Some(&0) {
                    a.pop();
                }
            }
            std::mem::swap(&mut a, &mut b);
        }
        a.len() <= 1
    })
}

/// The greatest number of which both are whole multiples.
fn common_divisor(a: &Rational, b: &Rational) -> Rational {
    let (mut a, mut b) = (a.clone(), b.clone());
    while !b.is_zero() {
        let r = &a - &(&b * &(&a / &b).floor());
        (a, b) = (b, r);
    }
    a
}

macro_rules! polynomial_operator {
    ($trait:ident, $method:ident, |$a:ident, $b:ident| $body:expr) => {
        impl std::ops::$trait<&Polynomial> for &Polynomial {
            type Output = Polynomial;
            fn $method(self, other: &Polynomial) -> Polynomial {
                let ($a, $b) = (self, other);
                $body
            }
        }
    };
}
polynomial_operator!(Add, add, |a, b| a.0.iter().chain(b.0.iter()).cloned().collect());
polynomial_operator!(Sub, sub, |a, b| {
    a.0.iter().cloned().chain(b.0.iter().map(|(m, c)| (m.clone(), -c.clone()))).collect()
});
polynomial_operator!(Mul, mul, |a, b| {
    a.0.iter().flat_map(|(ma, ca)| b.0.iter().map(move |(mb, cb)| (ma.times(mb), ca * cb))).collect()
});

/// The entries of a column of a matrix that are not zero, with their rows.
pub(crate) type Entries<'p> = Vec<(usize, &'p Polynomial)>;

/// What was made of polynomials, each once.
#[derive(Debug)]
pub(crate) struct Known<T> {
    places: HashMap<Polynomial, usize>,
    values: Vec<T>,
}

impl<T> Default for Known<T> {
    fn default() -> Self {
        Self { places: HashMap::new(), values: vec![] }
    }
}

impl<T> Known<T> {
    /// What is made of a polynomial.
    pub fn of(&mut self, p: &Polynomial, make: impl FnOnce(&Polynomial) -> T) -> &T {
        let place = self.places.get(p).copied().unwrap_or_else(|| {
            self.values.push(make(p));
            self.places.insert(p.clone(), self.values.len() - 1);
            self.values.len() - 1
        });
        &self.values[place]
    }
}

/// Determinants of square matrices of polynomials as products. Matrices that differ in a row or column share most of their
/// blocks, whose factors are found once.
#[derive(Debug)]
pub(crate) struct Determinants {
    /// Most terms of a minor.
    most: usize,
    factored: Known<RationalFunction>,
}

impl Determinants {
    pub fn new(most: usize) -> Self {
        Self { most, factored: Known::default() }
    }

    /// The determinant of a matrix: in block triangular form it is the product of those of the diagonal blocks. `None` when
    /// one of them has a minor of too many terms, or more rows than are expanded.
    pub fn of(&mut self, columns: &[Entries<'_>]) -> Option<RationalFunction> {
        let rows_of: Vec<Vec<usize>> = columns.iter().map(|c| c.iter().map(|own| own.0).collect()).collect();
        let Some(blocks) = blocks(&rows_of) else { return Some(RationalFunction::ZERO) };
        let sign = RationalFunction::from(Rational::from(if is_odd(&blocks) { -1 } else { 1 }));
        let (mut own, mut row_in) = (vec![sign], vec![None; columns.len()]);
        for block in &blocks {
            block.rows.iter().enumerate().for_each(|(k, &row)| row_in[row] = Some(k));
            let inside = |c: &usize| columns[*c].iter().filter_map(|(r, p)| Some((row_in[*r]?, *p))).collect();
            let columns: Vec<Entries<'_>> = block.columns.iter().map(inside).collect();
            let expanded = expanded(&columns, self.most)?;
            own.push(self.factored.of(&expanded, Polynomial::to_function).clone());
            block.rows.iter().for_each(|&row| row_in[row] = None);
        }
        Some(RationalFunction::product(own))
    }
}

/// The determinant of a square matrix of polynomials, by expansion along columns with every minor
/// computed once; `None` when a minor has more than `most` terms, or there are more than 60 rows.
fn expanded(columns: &[Entries<'_>], most: usize) -> Option<Polynomial> {
    // A minor is known by its rows, a bit each.
    if columns.len() > 60 {
        return None;
    }
    if let [column] = columns {
        return column.first().map(|own| own.1.clone()).filter(|p| p.len() <= most);
    }
    let mut minors: BTreeMap<u64, Polynomial> = BTreeMap::from([(0, Polynomial::from(1))]);
    for column in columns {
        let mut next: BTreeMap<u64, Polynomial> = BTreeMap::new();
        for (rows, minor) in &minors {
            for (r, entry) in column.iter().filter(|(r, _)| rows >> r & 1 == 0) {
                let above = (rows >> r).count_ones();
                let sign = Rational::from(if above % 2 == 0 { 1 } else { -1 });
                let term = (minor * *entry).scaled(&sign);
                let sum = next.entry(rows | 1 << r).or_insert_with(|| Polynomial::from(0));
                *sum = &*sum + &term;
            }
        }
        next.retain(|_, p| !p.is_zero());
        if next.len() > 64 * most || next.values().any(|p| p.len() > most) {
            return None;
        }
        minors = next;
    }
    Some(minors.into_iter().next().map_or(Polynomial::from(0), |(_, p)| p))
}

/// A rational function: a number times powers of distinct, numerically primitive polynomials, in their order.
///
/// # Example
/// ```
/// use willis::symbolic::{Polynomial, RationalFunction, Symbol};
/// let (x, one) = (Polynomial::symbol(Symbol(0)), Polynomial::from(1));
/// let squares = &one - &(&x * &x);
/// // (1 − x²)/(1 − x) = 1 + x
/// let f = squares.to_function().over(&(&one - &x).to_function());
/// assert_eq!(f, (&one + &x).to_function());
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct RationalFunction {
    number: Rational,
    factors: Vec<(Polynomial, i32)>,
}

impl From<Rational> for RationalFunction {
    fn from(number: Rational) -> Self {
        Self { number, factors: vec![] }
    }
}

impl RationalFunction {
    /// Zero.
    pub const ZERO: Self = Self { number: Rational::ZERO, factors: vec![] };
    /// One.
    pub const ONE: Self = Self { number: Rational::ONE, factors: vec![] };

    /// One symbol.
    pub fn symbol(s: Symbol) -> Self {
        Self { number: Rational::ONE, factors: vec![(Polynomial::symbol(s), 1)] }
    }

    /// Sorts the factors, joins equal ones and cancels what is common to two that are not.
    fn collect(number: Rational, factors: impl IntoIterator<Item = (Polynomial, i32)>) -> Self {
        let mut all: Vec<(Polynomial, i32)> = factors.into_iter().collect();
        // They mostly come in sorted stretches, which this finds.
        all.sort_by(|a, b| a.0.cmp(&b.0));
        all.dedup_by(|next, kept| {
            let same = next.0 == kept.0;
            kept.1 += if same { next.1 } else { 0 };
            same
        });
        Self::reduced(number, all)
    }

    /// Cancels what is common to two of the factors, which are sorted and distinct.
    fn reduced(number: Rational, mut factors: Vec<(Polynomial, i32)>) -> Self {
        if number.is_zero() {
            return Self::ZERO;
        }
        factors.retain(|(_, e)| *e != 0);
        // Factors are irreducible unless a square occurs in them; only then can two share a part.
        let coarse: Vec<bool> = factors.iter().map(|(p, _)| !p.is_multilinear()).collect();
        if !coarse.contains(&true) {
            return Self { number, factors };
        }
        let pair = (0..factors.len()).flat_map(|i| (0..i).map(move |j| (i, j))).find_map(|(i, j)| {
            let ((p, _), (q, _)) = (&factors[i], &factors[j]);
            if !coarse[i] && !coarse[j] {
                return None;
            }
            let g = p.gcd(q);
            g.as_constant().is_none().then_some((i, j, g))
        });
        if let Some((i, j, g)) = pair {
            let mut number = number;
            let (a, b) = (factors[i].1, factors[j].1);
            for k in [i, j] {
                let rest = factors[k].0.divided(&g).expect("a common divisor");
                let content = rest.numeric_content();
                for _ in 0..factors[k].1.unsigned_abs() {
                    number = if factors[k].1 > 0 { &number * &content } else { &number / &content };
                }
                factors[k].0 = rest.primitive();
            }
            factors.push((g, a + b));
            factors.retain(|(p, _)| p.as_constant().is_none());
            return Self::collect(number, factors);
        }
        Self { number, factors }
    }

    /// The number in front.
    pub fn number(&self) -> &Rational {
        &self.number
    }

    /// The factors with their powers.
    pub fn factors(&self) -> &[(Polynomial, i32)] {
        &self.factors
    }

    /// Whether this is zero.
    pub fn is_zero(&self) -> bool {
        self.number.is_zero()
    }

    /// Its value, when no symbol occurs in it.
    pub fn as_constant(&self) -> Option<&Rational> {
        self.factors.is_empty().then_some(&self.number)
    }

    /// Symbols that occur.
    pub fn symbols(&self) -> Vec<Symbol> {
        let mut all: Vec<_> = self.factors.iter().flat_map(|(p, _)| p.symbols()).collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    /// The product.
    pub fn times(&self, other: &Self) -> Self {
        let factors = self.beside(other).into_iter().map(|(p, [a, b])| (p.clone(), a + b)).collect();
        Self::reduced(&self.number * &other.number, factors)
    }

    /// The factors of both, sorted, with their powers in each.
    fn beside<'f>(&'f self, other: &'f Self) -> Vec<(&'f Polynomial, [i32; 2])> {
        let mut all = Vec::with_capacity(self.factors.len() + other.factors.len());
        let mut mine = self.factors.iter().peekable();
        for (p, e) in &other.factors {
            let mut order = Ordering::Less;
            while let Some(own) = mine.next_if(|own| {
                order = own.0.cmp(p);
                order == Ordering::Less
            }) {
                all.push((&own.0, [own.1, 0]));
            }
            let same = mine.next_if(|_| order == Ordering::Equal).map_or(0, |own| own.1);
            all.push((p, [same, *e]));
        }
        all.extend(mine.map(|(p, e)| (p, [*e, 0])));
        all
    }

    /// The product of many, whose factors are joined once.
    pub(crate) fn product(all: impl IntoIterator<Item = Self>) -> Self {
        let (mut number, mut factors) = (Rational::ONE, Vec::new());
        for f in all {
            number = &number * &f.number;
            factors.extend(f.factors);
        }
        Self::collect(number, factors)
    }

    /// The same factors with other powers, and another number.
    pub(crate) fn with_powers(&self, number: Rational, power: impl Fn(&Polynomial, i32) -> i32) -> Self {
        Self::reduced(number, self.factors.iter().map(|(p, e)| (p.clone(), power(p, *e))).collect())
    }

    /// The quotient.
    ///
    /// # Panics
    /// If `other` is zero.
    pub fn over(&self, other: &Self) -> Self {
        self.times(&other.recip())
    }

    /// One over this.
    ///
    /// # Panics
    /// If this is zero.
    pub fn recip(&self) -> Self {
        let factors = self.factors.iter().map(|(p, e)| (p.clone(), -e)).collect();
        Self { number: self.number.recip(), factors }
    }

    /// This with the other sign.
    pub fn negated(&self) -> Self {
        Self { number: -self.number.clone(), factors: self.factors.clone() }
    }

    /// The sum.
    pub fn plus(&self, other: &Self) -> Self {
        self.plus_within(other, usize::MAX).expect("there is no limit")
    }

    /// The sum; none where what the two do not share has more than `most` terms when it is multiplied out.
    pub(crate) fn plus_within(&self, other: &Self, most: usize) -> Option<Self> {
        if self.is_zero() || other.is_zero() {
            return Some(if self.is_zero() { other.clone() } else { self.clone() });
        }
        // What both share stays factored; the rest is multiplied out over a common denominator.
        let least = self.beside(other).into_iter().map(|(p, [a, b])| (p.clone(), a.min(b))).collect();
        let shared = Self::reduced(Rational::ONE, least);
        let rest = |f: &Self| {
            let left = f.over(&shared);
            let each = || left.factors.iter().flat_map(|(p, e)| (0..*e).map(move |_| p));
            let terms = each().fold(1usize, |terms, p| terms.saturating_mul(p.len()));
            (terms <= most).then(|| each().fold(Polynomial::constant(left.number.clone()), |product, p| &product * p))
        };
        Some((&rest(self)? + &rest(other)?).to_function().times(&shared))
    }

    /// The difference.
    pub fn minus(&self, other: &Self) -> Self {
        self.plus(&other.negated())
    }

    /// The derivative with respect to a symbol.
    pub fn derivative(&self, s: Symbol) -> Self {
        // (Π p^e)' = Π p^e Σ e p'/p
        let sum = self.factors.iter().fold(Self::ZERO, |sum, (p, e)| {
            let slope = p.derivative(s).scaled(&Rational::from(i64::from(*e))).to_function();
            if slope.is_zero() { sum } else { sum.plus(&slope.over(&p.to_function())) }
        });
        if sum.is_zero() { sum } else { self.times(&sum) }
    }

    /// Other functions in the place of symbols; `None` leaves a symbol as it is. `None` when a
    /// denominator vanishes.
    pub fn substituted(&self, value: &dyn Fn(Symbol) -> Option<Self>) -> Option<Self> {
        self.with_factors(&mut |p| p.substituted(value))
    }

    /// Other functions in the place of factors; `None` leaves a factor as it is. `None` when a denominator vanishes.
    pub(crate) fn with_factors(&self, value: &mut dyn FnMut(&Polynomial) -> Option<Self>) -> Option<Self> {
        // Factors are joined once, at the end.
        let mut number = self.number.clone();
        let mut factors: Vec<(Polynomial, i32)> = Vec::with_capacity(self.factors.len());
        let mut is_same = true;
        for (p, e) in &self.factors {
            let Some(sum) = value(p) else {
                factors.push((p.clone(), *e));
                continue;
            };
            is_same = false;
            if sum.is_zero() && *e < 0 {
                return None;
            }
            for _ in 0..e.unsigned_abs() {
                number = if *e > 0 { &number * &sum.number } else { &number / &sum.number };
            }
            factors.extend(sum.factors.into_iter().map(|(p, own)| (p, own * e)));
        }
        Some(if is_same { Self { number, factors } } else { Self::collect(number, factors) })
    }

    /// The value for given values of the symbols; `None` on a pole.
    pub fn evaluate(&self, value: &dyn Fn(Symbol) -> Rational) -> Option<Rational> {
        let mut product = self.number.clone();
        for (p, e) in &self.factors {
            let v = p.evaluate(value);
            if v.is_zero() && *e < 0 {
                return None;
            }
            for _ in 0..e.unsigned_abs() {
                product = if *e > 0 { &product * &v } else { &product / &v };
            }
        }
        Some(product)
    }
}

/// How a formula is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Notation {
    /// For eyes: `(1 - i0*eta0)/(1 - i0)`.
    Text,
    /// For typesetting.
    Latex,
    /// Python 3.
    Python,
    /// Rust, `f64`.
    Rust,
    /// C99, `double`.
    C,
    /// Modelica.
    Modelica,
}

impl Notation {
    fn times(self) -> &'static str {
        match self {
            Self::Latex => " ",
            _ => "*",
        }
    }

    /// A whole number.
    fn whole(self, n: &str) -> String {
        match self {
            Self::Rust | Self::C => format!("{n}.0"),
            // Whole numbers may have only 32 bits there.
            Self::Modelica if n.len() > 9 => format!("{n}.0"),
            _ => n.to_owned(),
        }
    }

    fn power(self, base: &str, exponent: u32) -> String {
        if exponent == 1 {
            return base.to_owned();
        }
        match self {
            Self::Text | Self::Modelica => format!("{base}^{exponent}"),
            Self::Latex => format!("{base}^{{{exponent}}}"),
            Self::Python => format!("{base}**{exponent}"),
            Self::Rust => format!("{base}.powi({exponent})"),
            Self::C => vec![base; exponent as usize].join("*"),
        }
    }

    fn parentheses(self, inner: &str) -> String {
        match self {
            Self::Latex => format!("\\left({inner}\\right)"),
            _ => format!("({inner})"),
        }
    }

    /// A polynomial as a sum; `flipped` writes its negative.
    pub fn polynomial(self, p: &Polynomial, name: &dyn Fn(Symbol) -> String, flipped: bool) -> String {
        let mut terms: Vec<(Rational, Vec<(Symbol, u32)>)> =
            p.terms().map(|(c, m)| (if flipped { -c.clone() } else { c.clone() }, m)).collect();
        // A positive term first, where there is one.
        if let Some(k) = terms.iter().position(|(c, _)| c.sign() > 0) {
            terms[..=k].rotate_right(1);
        }
        let mut written: Vec<String> = Vec::new();
        for (k, (c, powers)) in terms.iter().enumerate() {
            let sign = match (k, c.sign() < 0) {
                (0, false) => "",
                (0, true) => "-",
                (_, false) => "+ ",
                (_, true) => "- ",
            };
            let size = c.abs();
            let mut parts: Vec<String> = Vec::new();
            if size != Rational::ONE || powers.is_empty() {
                parts.push(self.rational(&size));
            }
            parts.extend(powers.iter().map(|(s, e)| self.power(&name(*s), *e)));
            written.push(sign.to_owned() + &parts.join(self.times()));
        }
        if written.is_empty() { self.whole("0") } else { self.filled(&written, " ", "") }
    }

    /// Terms or factors one after the other; in LaTeX on several lines where one is too short, each
    /// new line with a mark.
    fn filled(self, parts: &[String], between: &str, mark: &str) -> String {
        // Fits a text 16 cm wide, 10 pt, with a left-hand side and a number.
        const LINE: f64 = 54.0;
        if self != Self::Latex || width(&parts.join(between)) <= LINE {
            return parts.join(between);
        }
        let mut lines: Vec<String> = Vec::new();
        let mut parts = parts.to_vec();
        if !mark.is_empty() {
            // Factors: short ones share a line.
            parts.sort_by(|a, b| width(a).total_cmp(&width(b)));
        }
        for part in &parts {
            match lines.last_mut() {
                Some(line) if width(line) + width(part) <= LINE => *line += &format!("{between}{part}"),
                _ => lines.push(part.clone()),
            }
        }
        match &lines[..] {
            [line] => line.clone(),
            _ => format!("\\begin{{aligned}}&{}\\end{{aligned}}", lines.join(&format!(" \\\\ &{{}}{mark}"))),
        }
    }

    /// A positive number.
    fn rational(self, r: &Rational) -> String {
        let text = r.to_fraction();
        let (n, d) = text.split_once('/').expect("a fraction");
        match (d, self) {
            ("1", _) => self.whole(n),
            (_, Self::Latex) => format!("\\frac{{{n}}}{{{d}}}"),
            _ => format!("{}/{}", self.whole(n), self.whole(d)),
        }
    }

    /// A rational function.
    pub fn function(self, f: &RationalFunction, name: &dyn Fn(Symbol) -> String) -> String {
        self.function_of(f, &mut |p, flipped| self.polynomial(p, name, flipped))
    }

    /// A rational function whose factors, or their negatives, are written as told.
    pub(crate) fn function_of(
        self,
        f: &RationalFunction,
        factor: &mut dyn FnMut(&Polynomial, bool) -> String,
    ) -> String {
        if f.is_zero() {
            return self.whole("0");
        }
        let mut negative = f.number.sign() < 0;
        let fraction = f.number.abs().to_fraction();
        let (top, bottom) = fraction.split_once('/').expect("a fraction");
        // A minus in front of a difference turns the difference round.
        let minuses = |p: &Polynomial| p.terms().filter(|(c, _)| c.sign() < 0).count();
        let turned = match negative {
            true => f
                .factors
                .iter()
                .rposition(|(p, e)| *e > 0 && *e % 2 != 0 && p.len() > 1 && minuses(p) > 0)
                // Below the line only where that saves minuses.
                .or_else(|| f.factors.iter().rposition(|(p, e)| *e < 0 && *e % 2 != 0 && 2 * minuses(p) > p.len())),
            false => None,
        };
        negative &= turned.is_none();
        let mut side = |sign: i32, number: &str| -> (String, usize) {
            let chosen: Vec<(usize, &(Polynomial, i32))> =
                f.factors.iter().enumerate().filter(|(_, (_, e))| e.signum() == sign).collect();
            let mut parts: Vec<String> = Vec::new();
            if number != "1" {
                parts.push(self.whole(number));
            }
            let alone = chosen.len() + parts.len() == 1;
            for (k, (p, e)) in chosen {
                let text = factor(p, turned == Some(k));
                let simple = p.len() == 1 || (alone && e.abs() == 1);
                let base = if simple { text } else { self.parentheses(&text) };
                parts.push(self.power(&base, e.unsigned_abs()));
            }
            let sum = alone && f.factors.iter().any(|(p, e)| *e == sign && p.len() > 1);
            let count = if sum { 0 } else { parts.len() };
            (self.filled(&parts, self.times(), "\\times "), count)
        };
        // `count` is 0 for a bare sum, else the number of factors.
        let (mut above, mut above_count) = side(1, top);
        let (below, below_count) = side(-1, bottom);
        if above.is_empty() {
            (above, above_count) = (self.whole("1"), 1);
        }
        if below.is_empty() {
            return match (negative, above_count) {
                (false, _) => above,
                (true, 0) => format!("-{}", self.parentheses(&above)),
                (true, _) => format!("-{above}"),
            };
        }
        let minus = if negative { "-" } else { "" };
        if self == Self::Latex {
            return format!("{minus}\\frac{{{above}}}{{{below}}}");
        }
        let above = if above_count == 0 && above != self.whole("1") { self.parentheses(&above) } else { above };
        let single = below_count == 1 && (self != Self::C || !below.contains('*'));
        let below = if single { below } else { self.parentheses(&below) };
        format!("{minus}{above}/{below}")
    }
}

/// About how wide LaTeX sets a formula, in letters; of several lines the widest.
fn width(latex: &str) -> f64 {
    latex.replace("{aligned}", "").split("\\\\").map(width_of_line).fold(0.0, f64::max)
}

fn width_of_line(line: &str) -> f64 {
    let mut sum = 0.0;
    let (mut depth, mut small) = (0, None);
    let mut rest = line.chars().peekable();
    while let Some(c) = rest.next() {
        let own = match c {
            '\\' => {
                let mut word = String::new();
                while let Some(letter) = rest.next_if(char::is_ascii_alphabetic) {
                    word.push(letter);
                }
                match word.as_str() {
                    "left" | "right" | "mathrm" | "text" | "begin" | "end" => 0.0,
                    _ => 1.0,
                }
            }
            '{' => {
                depth += 1;
                0.0
            }
            '}' => {
                depth -= 1;
                if small == Some(depth) {
                    small = None;
                }
                0.0
            }
            '_' | '^' => {
                small = small.or(Some(depth));
                0.0
            }
            ' ' | '&' => 0.0,
            '+' | '-' => 2.0,
            _ => 1.0,
        };
        sum += if small.is_some() { 0.65 * own } else { own };
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    const X: Symbol = Symbol(0);
    const Y: Symbol = Symbol(1);
    const Z: Symbol = Symbol(2);

    fn s(x: Symbol) -> Polynomial {
        Polynomial::symbol(x)
    }

    fn n(x: i64) -> Polynomial {
        Polynomial::from(x)
    }

    fn show(f: &RationalFunction) -> String {
        Notation::Text.function(f, &|s| ["x", "y", "z"][s.0].to_owned())
    }

    #[test]
    fn splits_multilinear_products_completely() {
        let p = &(&(&n(1) - &(&s(X) * &s(Y))) * &(&n(2) + &s(Z).scaled(&4.into()))) * &n(-3);
        let f = p.to_function();
        assert_eq!(show(&f), "6*(1 + 2*z)*(x*y - 1)");
        assert_eq!(f.factors().len(), 2);
    }

    #[test]
    fn finds_squares_and_cancels() {
        let a = &n(1) - &s(X);
        let square = (&a * &a).to_function();
        assert_eq!(show(&square), "(1 - x)^2");
        assert_eq!(show(&square.over(&a.to_function())), "1 - x");
        // 1 − x² is not split, but what it shares with 1 − x cancels.
        let f = (&n(1) - &(&s(X) * &s(X))).to_function().over(&a.to_function());
        assert_eq!(show(&f), "1 + x");
        let g = a.to_function().over(&(&n(1) - &(&s(X) * &s(X))).to_function());
        assert_eq!(show(&g), "1/(1 + x)");
    }

    #[test]
    fn adds_over_common_denominators() {
        let (x, y) = (RationalFunction::symbol(X), RationalFunction::symbol(Y));
        let f = RationalFunction::ONE.over(&x).plus(&RationalFunction::ONE.over(&y));
        assert_eq!(show(&f), "(x + y)/(x*y)");
        assert_eq!(show(&f.minus(&f)), "0");
        assert_eq!(show(&x.over(&y).minus(&RationalFunction::ONE)), "(x - y)/y");
        assert_eq!(show(&RationalFunction::ONE.negated()), "-1");
    }

    #[test]
    fn derives_as_by_hand() {
        // ((1 − xy)/(1 − x))' by x: (1 − y)/(1 − x)²
        let f = (&n(1) - &(&s(X) * &s(Y))).to_function().over(&(&n(1) - &s(X)).to_function());
        assert_eq!(show(&f), "(1 - x*y)/(1 - x)");
        assert_eq!(show(&f.derivative(X)), "(1 - y)/(1 - x)^2");
        assert_eq!(show(&f.derivative(Y)), "-x/(1 - x)");
    }

    #[test]
    fn substitutes() {
        let f = (&n(1) - &(&s(X) * &s(Y))).to_function().over(&(&n(1) - &s(X)).to_function());
        // x = −z: the planetary set with a positive tooth ratio
        let g = f.substituted(&|s| (s == X).then(|| RationalFunction::symbol(Z).negated())).unwrap();
        assert_eq!(show(&g), "(1 + y*z)/(1 + z)");
        assert_eq!(f.substituted(&|s| (s == X).then_some(RationalFunction::ONE)), None, "a pole");
    }

    /// As of lists of all exponents, of which most are zero.
    #[test]
    fn products_of_powers_are_those_of_all_exponents() {
        let dense: Vec<[u32; 4]> = (0..81).map(|k: u32| [k % 3, k / 3 % 3, k / 9 % 3, k / 27]).collect();
        let of = |exponents: &[u32; 4]| {
            (0..4).fold(Monomial::default(), |m, k| m.with(Symbol(k * 3), 7).with(Symbol(k * 3), exponents[k]))
        };
        let degree = |e: &[u32; 4]| e.iter().sum::<u32>();
        for a in &dense {
            for b in &dense {
                assert_eq!(of(a).cmp(&of(b)), degree(a).cmp(&degree(b)).then_with(|| b.cmp(a)), "{a:?} {b:?}");
                let sum: [u32; 4] = std::array::from_fn(|k| a[k] + b[k]);
                assert_eq!(of(a).times(&of(b)), of(&sum));
                assert_eq!(of(&sum).over(&of(b)), Some(of(a)));
                let divides = (0..4).all(|k| b[k] <= a[k]);
                assert_eq!(of(a).over(&of(b)).is_some(), divides);
            }
        }
    }

    #[test]
    fn products_of_many_are_those_of_two_after_the_other() {
        let sum = |x: Symbol, c: i64| (&s(x) + &n(c)).to_function();
        let square = (&(&s(X) * &s(X)) - &n(1)).to_function();
        let all = [
            sum(Y, 2),
            square,
            sum(X, 1).recip(),
            sum(Z, 3),
            sum(Y, 2),
            sum(X, -1),
            RationalFunction::symbol(Z).recip(),
        ];
        let folded = all.iter().fold(RationalFunction::ONE, |product, f| product.times(f));
        assert_eq!(RationalFunction::product(all.clone()), folded);
        assert!(folded.factors().is_sorted_by(|a, b| a.0 < b.0));
        assert_eq!(show(&folded), "(1 - x)^2*(2 + y)^2*(3 + z)/z");
    }

    fn entries(column: &[Polynomial]) -> Entries<'_> {
        column.iter().enumerate().filter(|(_, p)| !p.is_zero()).collect()
    }

    #[test]
    fn determinants_of_three() {
        let m = [[n(1), s(X), n(0)], [n(0), n(1), s(Y)], [s(Z), n(0), n(1)]].map(|c| c.to_vec());
        let columns: Vec<Entries<'_>> = m.iter().map(|c| entries(c)).collect();
        assert_eq!(Determinants::new(1).of(&columns), None);
        assert_eq!(Determinants::new(9).of(&columns).unwrap(), (&n(1) + &(&(&s(X) * &s(Y)) * &s(Z))).to_function());
    }

    /// Of random matrices, many of which fall into blocks or are singular by their zeros alone: at numbers for the
    /// symbols it is the determinant of the numbers.
    #[test]
    fn determinants_by_blocks_are_those_of_the_numbers() {
        let mut seed = 7u64;
        let mut random = |below: usize| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 33) as usize % below
        };
        let value = |s: Symbol| Rational::from([3, -5, 7][s.0]);
        let (mut blocked, mut determinants) = (0, Determinants::new(1000));
        for _ in 0..400 {
            let size = 1 + random(7);
            let columns: Vec<Vec<Polynomial>> = (0..size)
                .map(|_| {
                    let mut entry = |_| match random(7) {
                        0 => n(random(5) as i64 - 2),
                        1 => s([X, Y, Z][random(3)]),
                        2 => &s([X, Y, Z][random(3)]) - &n(random(3) as i64),
                        _ => n(0),
                    };
                    (0..size).map(&mut entry).collect()
                })
                .collect();
            let rows: Vec<Vec<Rational>> =
                (0..size).map(|r| columns.iter().map(|c| c[r].evaluate(&value)).collect()).collect();
            let sparse: Vec<Entries<'_>> = columns.iter().map(|c| entries(c)).collect();
            let own = determinants.of(&sparse).unwrap();
            blocked += usize::from(own.factors().len() > 1);
            assert_eq!(own.evaluate(&value).unwrap(), crate::exact::determinant(&rows), "{columns:?}");
        }
        assert!(blocked > 50, "{blocked}");
    }

    #[test]
    fn long_sums_take_several_lines_in_latex() {
        let name = |s: Symbol| format!("\\omega_{{\\mathrm{{{}}}}}", ["carrier", "planet", "ring"][s.0]);
        let sum = &(&s(X) + &s(Y)) - &s(Z);
        assert!(width(&Notation::Latex.polynomial(&sum, &name, false)) < 20.0);
        let square = &(&sum * &sum) * &(&n(1) - &(&s(X) * &s(Y)));
        let text = Notation::Latex.polynomial(&square, &name, false);
        assert!(text.starts_with("\\begin{aligned}&\\omega") && text.ends_with("\\end{aligned}"), "{text}");
        assert!(text.contains(" \\\\ &{}+ ") || text.contains(" \\\\ &{}- "), "{text}");
        assert!(width(&text) < 56.0);
    }

    #[test]
    fn writes_every_language() {
        let f = (&n(3) - &s(X).scaled(&Rational::new(2, 1))).to_function().over(&(&s(Y) * &s(Y)).to_function());
        let show = |l: Notation| l.function(&f, &|s| ["x", "y"][s.0].to_owned());
        assert_eq!(show(Notation::Text), "(3 - 2*x)/y^2");
        assert_eq!(show(Notation::Latex), "\\frac{3 - 2 x}{y^{2}}");
        assert_eq!(show(Notation::Python), "(3 - 2*x)/y**2");
        assert_eq!(show(Notation::Rust), "(3.0 - 2.0*x)/y.powi(2)");
        assert_eq!(show(Notation::C), "(3.0 - 2.0*x)/(y*y)");
        assert_eq!(show(Notation::Modelica), "(3 - 2*x)/y^2");
    }
}
