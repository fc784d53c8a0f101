//! Whether planets can be put in, exactly: assembly, clearance between neighbours, hunting and phase of the meshes.
//!
//! Lengths are in modules. Nothing here depends on a tolerance, but for the two distances of a Ravigneaux set that are
//! no rational multiple of a root: there a gap below 10⁻⁹ modules counts as none.

use std::cmp::Ordering;
use std::ops::{Neg, Rem};

use serde::{Deserialize, Serialize};
use willis::exact::Rational;

/// The largest common divisor; of two zeros it is zero.
///
/// ```
/// assert_eq!(willis_synthesis::teeth::fit::gcd(84, -36), 12);
/// ```
pub fn gcd<T: Copy + Default + PartialOrd + Neg<Output = T> + Rem<Output = T>>(mut a: T, mut b: T) -> T {
    let zero = T::default();
    while b != zero {
        (a, b) = (b, a % b);
    }
    if a < zero { -a } else { a }
}

/// Whether `length · sin(π/planets) > needed`, exactly: whole numbers of any common unit, such as half modules. For one
/// planet it always holds.
///
/// # Formula
/// ```text
/// N = 2: u > v           N = 3: 3 u² > 4 v²      N = 4: u² > 2 v²       N = 6: u > 2 v
/// N = 5: sin² 36° = (5 − √5)/8: with w = 5 u² − 8 v², w > 0 and w² > 5 u⁴
/// ```
/// For every other N the sine is enclosed between rationals that are 10⁻²⁸ apart; it is irrational for N > 6 (Niven), so
/// that there are no ties.
///
/// # Example
/// Six planets at `s + p = 2 (p + 2)` touch exactly:
/// ```
/// use willis_synthesis::teeth::fit::clears;
///
/// assert!(!clears(44, 6, 22));
/// assert!(clears(440, 6, 219));
/// ```
pub fn clears(length: i64, planets: i64, needed: i64) -> bool {
    if planets <= 1 {
        return true;
    }
    if length <= 0 {
        return false;
    }
    if needed < 0 {
        return true;
    }
    let (u, v) = (i128::from(length), i128::from(needed));
    match planets {
        2 => u > v,
        3 => 3 * u * u > 4 * v * v,
        4 => u * u > 2 * v * v,
        5 if u < 1 << 30 && v < 1 << 30 => {
            let w = 5 * u * u - 8 * v * v;
            w > 0 && w * w > 5 * u * u * u * u
        }
        6 => u > 2 * v,
        n => {
            let (a, b) = (length as f64 * (std::f64::consts::PI / n as f64).sin(), needed as f64);
            if (a - b).abs() > 1e-9 * (a + b) {
                return a > b;
            }
            // Between the two bounds no quotient of such whole numbers can lie.
            enclosed_sine(n)[0].clone() * Rational::from(length) > Rational::from(needed)
        }
    }
}

/// Rational bounds of `sin(π/n)`: Taylor's series, which alternates, with π cut and rounded up.
fn enclosed_sine(n: i64) -> [Rational; 2] {
    [8_462_643_383_279, 8_462_643_383_280].map(|last| {
        let whole = |n: i64| Rational::from(n);
        let pi = (&(&whole(314_159_265_358_979_323) * &whole(10_i64.pow(13))) + &whole(last))
            / (&whole(10_i64.pow(15)) * &whole(10_i64.pow(15)));
        let x = pi / whole(n);
        let square = &x * &x;
        let (mut sum, mut term) = (Rational::ZERO, x);
        for k in 0..14 {
            sum += term.clone();
            term = -(&(&term * &square) / &whole((2 * k + 2) * (2 * k + 3)));
        }
        sum
    })
}

/// A length in modules, such as a gap: a fraction with a positive denominator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Length {
    /// Numerator, and the positive denominator.
    parts: (i64, i64),
}

impl Length {
    /// None at all.
    pub const ZERO: Self = Self { parts: (0, 1) };

    /// `numerator/denominator` modules; none for a denominator below one, and beyond a million.
    ///
    /// ```
    /// use willis_synthesis::teeth::fit::Length;
    /// assert_eq!(Length::new(1, 2), Length::new(2, 4));
    /// assert_eq!(Length::new(1, 0), None);
    /// ```
    pub fn new(numerator: i64, denominator: i64) -> Option<Self> {
        let fits = (1..=1_000_000).contains(&denominator) && numerator.abs() <= 1_000_000;
        fits.then(|| Self { parts: reduced(numerator, denominator) })
    }

    /// Exactly so many modules; none where [`Length::new`] gives none for the fraction in lowest terms.
    pub(crate) fn of(modules: &Rational) -> Option<Self> {
        let (n, d) = super::layout::fraction(modules)?;
        Self::new(n, d)
    }

    /// In modules.
    pub fn modules(self) -> f64 {
        self.parts.0 as f64 / self.parts.1 as f64
    }
}

/// Whether planets on a circle of twice the radius `twice/parts`, in modules, with `teeth` clear their neighbours by more
/// than a gap: `2 a sin(π/N) > z + 2 + gap`.
///
/// ```
/// use willis_synthesis::teeth::fit::{Length, planets_clear};
/// // Sun 30, planet 20, ring 70, four planets: 50 sin 45° = 35.4 > 22.
/// assert!(planets_clear((50, 1), 4, 20, Length::ZERO));
/// ```
pub fn planets_clear(twice: (i64, i64), planets: i64, teeth: i64, gap: Length) -> bool {
    let (g, d) = gap.parts;
    clears(twice.0 * d, planets, ((teeth + 2) * d + g) * twice.1)
}

/// The number of planets of a simple set is possible at equal angles: `N | s + r`.
///
/// ```
/// use willis_synthesis::teeth::fit::assembles_simple;
/// assert!(assembles_simple(30, 72, 3) && !assembles_simple(30, 72, 4));
/// ```
pub fn assembles_simple(sun: i64, ring: i64, planets: i64) -> bool {
    planets > 0 && (sun + ring) % planets == 0
}

/// Two central gears on different steps of identical planets at equal angles: `N gcd(p_a, p_b) | z_a p_b − z_b p_a`, the
/// teeth of a ring taken as negative.
///
/// # Derivation
/// At the angle t the planet must be turned by `t (1 + z_a/p_a)` modulo `2π/p_a`, and the same with b. The differences
/// `i/p_a − j/p_b` are the multiples of `1/lcm(p_a, p_b)`.
///
/// # Example
/// Rings of 120 and 110 teeth on steps of 54 and 44, three planets: `(120·44 − 110·54)/(3·2) = −110`.
/// ```
/// use willis_synthesis::teeth::fit::assembles_across;
/// assert!(assembles_across((-120, 54), (-110, 44), 3));
/// assert!(!assembles_across((-120, 54), (-110, 44), 4));
/// ```
pub fn assembles_across(a: (i64, i64), b: (i64, i64), planets: i64) -> bool {
    let module = planets * gcd(a.1, b.1);
    module > 0 && (a.0 * b.1 - b.0 * a.1) % module == 0
}

/// How the meshes of the planets follow each other at a sun: the phases are the fractional parts of `j z/N`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Phase {
    /// All planets mesh alike: what excites torsion adds up.
    InPhase,
    /// Every planet meshes at its own time: `gcd(z, N) = 1`, and excitation of torsion cancels.
    InSequence,
    /// Groups of planets mesh alike.
    Mixed,
}

/// The phase of the meshes of a gear with `teeth` in the middle.
///
/// ```
/// use willis_synthesis::teeth::fit::{Phase, phase};
/// assert_eq!([phase(30, 3), phase(31, 3), phase(30, 4)], [Phase::InPhase, Phase::InSequence, Phase::Mixed]);
/// ```
pub fn phase(teeth: i64, planets: i64) -> Phase {
    match gcd(teeth, planets) {
        g if g == planets => Phase::InPhase,
        1 => Phase::InSequence,
        _ => Phase::Mixed,
    }
}

/// Central gears and planets of a Ravigneaux set.
///
/// # Example
/// The Ford AOD: short planets of 12 to 20 teeth fit between three long ones with a gap of half a module.
/// ```
/// use willis_synthesis::teeth::fit::{Length, Ravigneaux};
///
/// let set = Ravigneaux { small_sun: 30, large_sun: 36, long: 18, ring: 72 };
/// assert!(set.assembles(3));
/// let half = Length::new(1, 2).unwrap();
/// let fits: Vec<i64> = (12..=30).filter(|&short| set.short_fits(short, 3, half)).collect();
/// assert_eq!(fits, (12..=20).collect::<Vec<_>>());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ravigneaux {
    /// Teeth of the sun on the short planets.
    pub small_sun: i64,
    /// Teeth of the sun on the long planets.
    pub large_sun: i64,
    /// Teeth of the long planets.
    pub long: i64,
    /// Teeth of the ring.
    pub ring: i64,
}

impl Ravigneaux {
    /// Identical pairs of planets at equal angles: `N | s_2 + r` and `N | r − s_1`.
    pub fn assembles(&self, planets: i64) -> bool {
        planets > 0 && (self.large_sun + self.ring) % planets == 0 && (self.ring - self.small_sun) % planets == 0
    }

    /// Whether neighbouring long planets clear, and the long planets clear the small sun. They turn on the mean of what
    /// both meshes ask for, `A = (s_2 + r)/2`: `A sin(π/N) > p_L + 2 + gap` and `A > s_1 + p_L + 4 + gap`.
    pub fn long_clears(&self, planets: i64, gap: Length) -> bool {
        let twice = (self.large_sun + self.ring, 2);
        let (g, d) = gap.parts;
        planets_clear(twice, planets, self.long, gap) && twice.0 * d > 2 * ((self.small_sun + self.long + 4) * d + g)
    }

    /// Whether short planets of so many teeth fit: inside the ring, in a triangle with the long ones, clear of their
    /// neighbours of both kinds. `A = (s_2 + r)/2`, `B = s_1 + p_S`, `C = p_L + p_S`, `cos β = (A² + B² − C²)/(2 A B)`;
    /// neighbour of the other kind: `√(A² + B² − 2 A B cos(2π/N − β)) > p_S + p_L + 4 + gap`. As `A`, `B` and `C` are twice
    /// the distances of axes, half of the gap is kept between planets of different kinds, and between a long planet and the
    /// small sun ([`Self::long_clears`]); between planets of one kind it is kept whole.
    pub fn short_fits(&self, short: i64, planets: i64, gap: Length) -> bool {
        let b = self.small_sun + short;
        if b + short + 2 > self.ring || !self.long_clears(planets, gap) || !planets_clear((b, 1), planets, short, gap) {
            return false;
        }
        let [a, b, c] = [(self.large_sun + self.ring) as f64 / 2.0, b as f64, (self.long + short) as f64];
        if !(a < b + c && b < a + c && c < a + b) {
            return false;
        }
        let cosine = ((a * a + b * b - c * c) / (2.0 * a * b)).clamp(-1.0, 1.0);
        let angle = std::f64::consts::TAU / planets as f64 - cosine.acos();
        let distance = (a * a + b * b - 2.0 * a * b * angle.cos()).max(0.0).sqrt();
        distance > (short + self.long + 4) as f64 + gap.modules() + 1e-9
    }
}

/// Compares fractions with positive denominators.
pub(crate) fn compare((a, b): (i64, i64), (c, d): (i64, i64)) -> Ordering {
    (i128::from(a) * i128::from(d)).cmp(&(i128::from(c) * i128::from(b)))
}

/// A fraction in lowest terms.
pub(crate) fn reduced(numerator: i64, denominator: i64) -> (i64, i64) {
    let g = gcd(numerator, denominator).max(1);
    (numerator / g, denominator / g)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sines_are_enclosed() {
        for n in [7, 8, 11, 24, 59] {
            let [low, high] = enclosed_sine(n);
            assert!(low < high);
            let sine = (std::f64::consts::PI / n as f64).sin();
            assert!((low.to_f64() - sine).abs() < 1e-15 && (high.to_f64() - sine).abs() < 1e-15, "{n}");
        }
    }

    #[test]
    fn exact_tests_agree_with_floating_point_away_from_ties() {
        for n in 2..12 {
            for u in 10..200 {
                for v in 1..60 {
                    let margin = u as f64 * (std::f64::consts::PI / n as f64).sin() - v as f64;
                    if margin.abs() > 1e-9 {
                        assert_eq!(clears(u, n, v), margin > 0.0, "{n} {u} {v}");
                    }
                }
            }
        }
    }

    #[test]
    fn ties_do_not_clear() {
        assert!(!clears(9, 2, 9));
        assert!(!clears(10, 6, 5));
        assert!(clears(-3, 1, 5));
    }

    /// Two central gears alone on two steps, a sun and a ring or two rings: by putting planets in.
    #[test]
    fn two_gears_across_by_enumeration() {
        for n in 2..=5 {
            for (a, p1, b, p2) in
                [(20, 40, -80, 20), (19, 35, -75, 21), (-80, 30, -76, 26), (-81, 27, -72, 18), (24, 16, -60, 20)]
            {
                for more in 0..4 {
                    let b = b - more;
                    let wanted = |z: i64, p: i64, k: i64| Rational::new(k * (z + p), n * p);
                    let fits = (0..n).all(|k| {
                        (0..p1).any(|j| {
                            let body = &wanted(a, p1, k) + &Rational::new(j, p1);
                            (&(&body - &wanted(b, p2, k)) * &Rational::from(p2)).is_integer()
                        })
                    });
                    assert_eq!(fits, assembles_across((a, p1), (b, p2), n), "{n} {a}/{p1} {b}/{p2}");
                }
            }
        }
    }

    /// By putting planets in: the body angles at which a planet fits, compared with the rule.
    #[test]
    fn stepped_assembly_by_enumeration() {
        for n in 2..=5 {
            for (s, p1, p2) in [(12, 15, 18), (13, 16, 12), (15, 20, 14), (14, 21, 15)] {
                for d in [-1, 0, 1] {
                    let (r1, r2) = (s + 2 * p1 + d, s + p1 + p2);
                    // In units of a turn: planets k at the angle k/n; fits if one body angle suits all three meshes.
                    let fits = (0..n).all(|k| {
                        let wanted = |z: i64, p: i64| Rational::new(k * (z + p), n * p);
                        (0..p1).any(|j| {
                            let body = &wanted(s, p1) + &Rational::new(j, p1);
                            let suits = |z: i64, p: i64| (&(&body - &wanted(z, p)) * &Rational::from(p)).is_integer();
                            suits(-r1, p1) && suits(-r2, p2)
                        })
                    });
                    let rule = assembles_simple(s, r1, n) && assembles_across((-r1, p1), (-r2, p2), n);
                    assert_eq!(fits, rule, "{n} {s} {p1} {p2} {d}");
                }
            }
        }
    }
}
