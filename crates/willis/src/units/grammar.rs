//! Products and quotients of unit symbols: `N m`, `N·m`, `ft-lb`, `rad/s`, `kg m^2`, `N m s²/rad`, `min⁻¹`, `/min`.

use crate::exact::Rational;

use super::symbols::{TOGETHER, UNITS};

/// What a unit amounts to: factor, power of π, exponents of m, kg, s, rad, K.
pub(super) struct Scale {
    pub factor: Rational,
    pub pi_power: i8,
    pub exponents: [i8; 5],
}

/// The part of a unit that is not known.
pub(super) struct Unknown(pub String);

/// Symbols that are a mass, and a force where the quantity asked for leaves no other reading (`ft-lb`).
const MASS_OR_FORCE: [&str; 3] = ["lb", "lbs", "oz"];
/// A kilogram is a mass only; as a force it is guessed at in suggestions, and never read.
const MASS_TAKEN_FOR_FORCE: [&str; 2] = ["kg", "g"];

/// How units of mass are read.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum MassAs {
    /// As masses.
    Mass,
    /// Pounds and ounces as the forces of that name.
    PoundForce,
    /// Kilograms too.
    KilogramForce,
}

/// The unit of one symbol, or of symbols written together.
fn symbols(name: &str) -> Option<&'static [&'static str]> {
    if let Some(row) = UNITS.iter().find_map(|u| u.0.iter().position(|s| *s == name).map(|k| &u.0[k..=k])) {
        return Some(row);
    }
    TOGETHER.iter().find(|t| t.0 == name).map(|t| t.1)
}

/// The unit of one symbol.
fn one(name: &str) -> Option<(Rational, i8, [i8; 5])> {
    let unit = UNITS.iter().find(|u| u.0.contains(&name))?;
    Some((unit.1.parse().expect("the table holds numbers"), unit.2, unit.3))
}

/// Reads a unit.
pub(super) fn read(text: &str, mass: MassAs) -> Result<Scale, Unknown> {
    let unknown = || Unknown(text.chars().take(40).collect());
    if text.len() > 60 {
        return Err(unknown());
    }
    let plain: Vec<char> = text.replace("**", "^").chars().map(plain).collect();
    let mut reader =
        Reader { rest: &plain, mass, scale: Scale { factor: Rational::ONE, pi_power: 0, exponents: [0; 5] } };
    reader.quotient(1, 0)?;
    if reader.rest.is_empty() { Ok(reader.scale) } else { Err(unknown()) }
}

/// One spelling for signs that look the same.
fn plain(c: char) -> char {
    match c {
        '\u{2212}' | '\u{2010}' | '\u{2011}' | '\u{2013}' => '-',
        '·' | '⋅' | '∙' | '•' | '×' | '*' | '.' => '·',
        c if c.is_whitespace() => '·',
        c => c,
    }
}

/// The digit that a raised one stands for.
fn raised(c: char) -> Option<char> {
    const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    match c {
        '⁻' => Some('-'),
        c => RAISED.iter().position(|r| *r == c).and_then(|d| char::from_digit(d as u32, 10)),
    }
}

struct Reader<'t> {
    rest: &'t [char],
    mass: MassAs,
    scale: Scale,
}

impl Reader<'_> {
    fn unknown(&self, part: &[char]) -> Unknown {
        Unknown(part.iter().take(40).collect())
    }

    fn next_is(&self, c: char) -> bool {
        self.rest.first() == Some(&c)
    }

    /// A product, or one product over another; `sign` -1 below the line. Nothing above the line is 1: `/min`.
    fn quotient(&mut self, sign: i8, depth: u8) -> Result<(), Unknown> {
        let start = self.rest;
        let above = self.product(sign, depth)?;
        if !self.next_is('/') {
            return if above > 0 { Ok(()) } else { Err(self.unknown(start)) };
        }
        self.rest = &self.rest[1..];
        // After a second line it is unclear what is divided: `N m/s/s`.
        if self.product(-sign, depth)? == 0 || self.next_is('/') {
            return Err(self.unknown(start));
        }
        Ok(())
    }

    /// Factors up to a line, a closing bracket or the end; how many they are.
    fn product(&mut self, sign: i8, depth: u8) -> Result<u32, Unknown> {
        let mut count = 0;
        loop {
            while self.next_is('·') || (count > 0 && self.next_is('-')) {
                self.rest = &self.rest[1..];
            }
            match self.rest.first() {
                None | Some('/' | ')') => return Ok(count),
                Some('(') if depth < 2 => {
                    let start = self.rest;
                    self.rest = &self.rest[1..];
                    self.quotient(sign, depth + 1)?;
                    if !self.next_is(')') {
                        return Err(self.unknown(start));
                    }
                    self.rest = &self.rest[1..];
                }
                Some('1') if self.rest.get(1).is_none_or(|c| matches!(c, '·' | '/' | ')')) => {
                    self.rest = &self.rest[1..];
                }
                _ => self.factor(sign)?,
            }
            count += 1;
        }
    }

    /// A symbol with its power: `m^2`, `m2`, `m²`, `min^-1`, `min-1`.
    fn factor(&mut self, sign: i8) -> Result<(), Unknown> {
        let start = self.rest;
        let ends =
            |&c: &char| matches!(c, '·' | '/' | '(' | ')' | '^' | '-') || c.is_ascii_digit() || raised(c).is_some();
        let end = start.iter().position(ends).unwrap_or(start.len());
        let name: String = start[..end].iter().collect();
        self.rest = &start[end..];
        let whole = |rest: &[char]| &start[..start.len() - rest.len()];
        let parts = symbols(&name).ok_or_else(|| {
            let shown = if name.is_empty() { start } else { &start[..end] };
            self.unknown(shown)
        })?;
        let power = self.power();
        let power = power.filter(|p| (1..=4).contains(&p.abs())).ok_or_else(|| self.unknown(whole(self.rest)))?;
        let (last, others) = parts.split_last().expect("no entry is empty");
        for symbol in others {
            self.put(symbol, sign);
        }
        self.put(last, sign * power);
        Ok(())
    }

    /// The power behind a symbol; 1 where none is written, `None` where it cannot be read.
    fn power(&mut self) -> Option<i8> {
        let start = self.rest;
        let mut at = usize::from(self.next_is('^'));
        let digit = |c: &char| c.is_ascii_digit() || raised(*c).is_some_and(|d| d != '-');
        let minus = |c: &char| matches!(c, '-' | '⁻');
        // A hyphen before a letter joins two symbols: `ft-lb`.
        if start.get(at).is_some_and(|c| minus(c) || (at == 1 && *c == '+')) && start.get(at + 1).is_some_and(digit) {
            at += 1;
        }
        let end = at + start[at..].iter().take_while(|c| digit(c)).count();
        if end == 0 {
            return Some(1);
        }
        self.rest = &start[end..];
        let text: String = start[..end].iter().filter(|c| **c != '^').map(|&c| raised(c).unwrap_or(c)).collect();
        text.parse().ok()
    }

    /// Multiplies by a power of a symbol.
    fn put(&mut self, symbol: &str, power: i8) {
        let (mut factor, pi_power, mut exponents) = one(symbol).expect("the tables agree");
        let force = match self.mass {
            MassAs::Mass => false,
            MassAs::PoundForce => MASS_OR_FORCE.contains(&symbol),
            MassAs::KilogramForce => MASS_OR_FORCE.contains(&symbol) || MASS_TAKEN_FOR_FORCE.contains(&symbol),
        };
        if force {
            // The standard acceleration of free fall, 9.80665 m/s².
            factor = factor * Rational::new(980_665, 100_000);
            exponents[0] += 1;
            exponents[2] -= 2;
        }
        for _ in 0..power.unsigned_abs() {
            let value = &self.scale.factor;
            self.scale.factor = if power > 0 { value * &factor } else { value / &factor };
        }
        // A text of 60 letters cannot go further than this, and units that do are refused.
        self.scale.pi_power = self.scale.pi_power.saturating_add(pi_power * power).clamp(-9, 9);
        for (d, u) in self.scale.exponents.iter_mut().zip(exponents) {
            *d = d.saturating_add(u * power).clamp(-99, 99);
        }
    }
}
