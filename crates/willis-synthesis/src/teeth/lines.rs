//! The Wolfrom drive by itself, line by line: for a sun, a first planet and a first ring, the second planets whose ratio
//! lies in a window are the whole numbers between two quotients.
//!
//! `i = (1 + r1/s)/(1 − r1 p2/(p1 r2))` with `r2 = A + p2`, `A = s + p1 + d2`. As a function of p2 it rises on both sides
//! of its pole `p2 = p1 A/(r1 − p1)`. `i = v` is at
//!
//! ```text
//! p2 = p1 A (v s − s − r1)/(p1 (s + r1) + v s (r1 − p1))
//! ```
//!
//! Quotients are taken in floating point; one that is within [`NEAR`] of a whole number is decided in whole numbers.

use willis::exact::Rational;

use super::form::{Form, Quotient};
use super::layout::fraction;
use super::space::SetSpace;

/// A closed window of the ratio as fractions with positive denominators.
pub(crate) type Bounds = [(i64, i64); 2];

/// The windows as fractions, where they are small enough for whole numbers.
pub(crate) fn bounds(windows: &[[Rational; 2]]) -> Option<Vec<Bounds>> {
    let small = |r: &Rational| fraction(r).filter(|(n, d)| n.abs() <= 1 << 40 && *d <= 1 << 30);
    windows.iter().map(|[a, b]| Some([small(a)?, small(b)?])).collect()
}

/// Whether a ratio is that of a Wolfrom drive with the sun as input, the first ring held, the second ring as output:
/// `(1 + y0) y1/(y1 − y0)`.
pub(crate) fn is_wolfrom(quotient: &Quotient) -> bool {
    let same =
        |k: i64| *quotient == Quotient { numerator: Form(vec![0, 0, k, k]), denominator: Form(vec![0, -k, k, 0]) };
    same(1) || same(-1)
}

/// `p2` at which the ratio is v: a fraction, as it comes.
fn crossing(s: i64, p1: i64, r1: i64, a: i64, (n, d): (i64, i64)) -> (i128, i128) {
    let [s, p1, r1, a, n, d] = [s, p1, r1, a, n, d].map(i128::from);
    (p1 * a * (n * s - d * (s + r1)), d * p1 * (s + r1) + n * s * (r1 - p1))
}

/// First planets that are looked at together.
const BLOCK: usize = 64;

/// How near to a whole number a quotient may be before whole numbers decide.
const NEAR: f64 = 1e-6;

/// Lines of one sun, one first mismatch and one second mismatch as numbers: what all of them share.
struct Lines {
    sun: f64,
    d1: f64,
    d2: f64,
    least_p2: f64,
    most_p2: f64,
    least_2: f64,
    most_2: f64,
}

impl Lines {
    /// Marks the lines, first planets from `first` on, whose windows may hold a whole number. Most do not: so this is
    /// arithmetic without branches, and what is marked is looked at again.
    fn mark(&self, first: i64, ends: [f64; 2], marks: &mut [u64]) {
        for (k, mark) in marks.iter_mut().enumerate() {
            let p1 = (first + k as i64) as f64;
            let (r1, a) = (self.sun + 2.0 * p1 + self.d1, self.sun + p1 + self.d2);
            let low = self.least_p2.max(self.least_2 - a);
            let high = self.most_p2.min(self.most_2 - a);
            let (above, below, slope) = (p1 * a, p1 * (self.sun + r1), self.sun * (r1 - p1));
            let at = |v: f64| above * (v * self.sun - self.sun - r1) / (below + v * slope);
            let [x, y] = ends.map(at);
            let pole = above / (r1 - p1);
            let is_plain = (x <= y) & (x.abs() <= f64::MAX) & (y.abs() <= f64::MAX) & ((x < pole) == (y < pole));
            // The largest whole number below the upper end, by what the sum with a large number keeps.
            const SHIFT: f64 = 6_755_399_441_055_744.0;
            let last = ((y.min(high + 1.0) + 2.0 * NEAR - 0.5) + SHIFT) - SHIFT;
            let holds = (last >= x - 2.0 * NEAR) & (x <= high + 0.5) & (y >= low - 0.5);
            *mark = u64::from((!is_plain | holds) & (low <= high) & (a > 0.0));
        }
    }
}

/// Calls `found` with the teeth of every Wolfrom drive whose ratio is in one of the windows, for one sun. The order is that
/// of the first mismatch, `p1`, the second mismatch, windows, `p2`.
pub(crate) fn lines(space: &SetSpace, sun: i64, windows: &[Bounds], found: &mut dyn FnMut([i64; 5])) {
    let [planet_1, ring_1, planet_2, ring_2] = [1, 2, 3, 4].map(|k| &space.gears[k]);
    let [most_1, most_p2, most_2] = [2, 3, 4].map(|k| space.most(k));
    let least_p2 = planet_2.least().unwrap_or(1).max(1);
    let least_2 = ring_2.least().unwrap_or(1);
    let whole = planet_2.is_gapless() && ring_2.is_gapless();
    let floats: Vec<[f64; 2]> = windows.iter().map(|w| w.map(|(n, d)| n as f64 / d as f64)).collect();
    let least_1 = planet_1.least().unwrap_or(1).max(1);
    let mut marks = vec![[0; BLOCK]; space.mismatch.len() * windows.len()];
    for d1 in &space.mismatch {
        let most = planet_1.most().unwrap_or(i64::MAX).min((most_1 - sun - d1) / 2);
        for block in (least_1..=most).step_by(BLOCK) {
            let size = (most - block + 1).min(BLOCK as i64) as usize;
            let all = space.mismatch.iter().flat_map(|d2| floats.iter().map(move |w| (*d2, *w)));
            for ((d2, ends), own) in all.zip(&mut marks) {
                let [sun, d1, d2, least_p2, most_p2, least_2, most_2] =
                    [sun, *d1, d2, least_p2, most_p2, least_2, most_2].map(|x| x as f64);
                Lines { sun, d1, d2, least_p2, most_p2, least_2, most_2 }.mark(block, ends, &mut own[..size]);
            }
            for k in 0..size {
                if marks.iter().all(|own| own[k] == 0) {
                    continue;
                }
                let p1 = block + k as i64;
                let r1 = sun + 2 * p1 + d1;
                if r1 <= p1 || !planet_1.contains(p1) || !ring_1.contains(r1) {
                    continue;
                }
                let all = space.mismatch.iter().flat_map(|d2| windows.iter().zip(&floats).map(move |w| (d2, w)));
                for ((d2, (window, ends)), _) in all.zip(&marks).filter(|(_, own)| own[k] != 0) {
                    let a = sun + p1 + d2;
                    let low = least_p2.max(least_2 - a);
                    let high = most_p2.min(most_2 - a);
                    let (s_f, p_f, r_f) = (sun as f64, p1 as f64, r1 as f64);
                    // Both branches rise, so that a window is an interval on each side of the pole.
                    let pole = p_f * a as f64 / (r_f - p_f);
                    let at =
                        |v: f64| p_f * a as f64 * (v * s_f - s_f - r_f) / (p_f * (s_f + r_f) + v * s_f * (r_f - p_f));
                    let [x, y] = [at(ends[0]), at(ends[1])];
                    // Beyond the pole the ratio tends to −p1 (s + r1)/(s (r1 − p1)); a window that contains this value or
                    // infinity opens the interval.
                    let delicate = x > y || !x.is_finite() || !y.is_finite() || (x < pole) != (y < pole);
                    if delicate || !whole {
                        for p2 in planet_2.within(low, high) {
                            if ring_2.contains(a + p2) && inside(sun, p1, r1, p2, a + p2, window) {
                                found([sun, p1, r1, p2, a + p2]);
                            }
                        }
                        continue;
                    }
                    let first = up(x, sun, p1, r1, a, window[0]).max(low);
                    let last = down(y, sun, p1, r1, a, window[1]).min(high);
                    for p2 in first..=last {
                        found([sun, p1, r1, p2, a + p2]);
                    }
                }
            }
        }
    }
}

/// The smallest whole number that is not below the crossing.
fn up(x: f64, s: i64, p1: i64, r1: i64, a: i64, v: (i64, i64)) -> i64 {
    // Towards zero, in one instruction; x is within the range of numbers that are asked for, or far below.
    let cut = x.clamp(-1e9, 1e9) as i64;
    let rest = x - cut as f64;
    if (NEAR..1.0 - NEAR).contains(&rest.abs()) {
        return cut + i64::from(rest > 0.0);
    }
    let (n, d) = crossing(s, p1, r1, a, v);
    let (n, d) = if d < 0 { (-n, -d) } else { (n, d) };
    -(-n).div_euclid(d) as i64
}

/// The largest whole number that is not above the crossing.
fn down(x: f64, s: i64, p1: i64, r1: i64, a: i64, v: (i64, i64)) -> i64 {
    let cut = x.clamp(-1e9, 1e9) as i64;
    let rest = x - cut as f64;
    if (NEAR..1.0 - NEAR).contains(&rest.abs()) {
        return cut - i64::from(rest < 0.0);
    }
    let (n, d) = crossing(s, p1, r1, a, v);
    let (n, d) = if d < 0 { (-n, -d) } else { (n, d) };
    n.div_euclid(d) as i64
}

/// Whether the ratio lies in a closed window, in whole numbers.
pub(crate) fn inside(s: i64, p1: i64, r1: i64, p2: i64, r2: i64, window: &Bounds) -> bool {
    let [s, p1, r1, p2, r2] = [s, p1, r1, p2, r2].map(i128::from);
    let (mut n, mut d) = ((s + r1) * p1 * r2, s * (p1 * r2 - r1 * p2));
    if d == 0 {
        return false;
    }
    if d < 0 {
        (n, d) = (-n, -d);
    }
    let [(a, b), (e, f)] = window.map(|(n, d)| (i128::from(n), i128::from(d)));
    a * d <= n * b && n * f <= e * d
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::teeth::{Counts, SetKind};
    use proptest::prelude::*;

    #[test]
    fn quotients_are_rounded_to_the_right_side() {
        for n in -20i64..20 {
            for d in [-7i64, -2, 1, 3, 5] {
                let exact = n as f64 / d as f64;
                // Only the final rounding is tested: a crossing that is n/d.
                let (ceil, floor) = (exact.ceil() as i64, exact.floor() as i64);
                let (n, d) = (i128::from(n), i128::from(d));
                let (pn, pd) = if d < 0 { (-n, -d) } else { (n, d) };
                assert_eq!((-(-pn).div_euclid(pd)) as i64, ceil);
                assert_eq!(pn.div_euclid(pd) as i64, floor);
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(60))]
        #[test]
        fn lines_find_what_brute_force_finds(
            s in 8i64..16, p in 8i64..14, span in 3i64..12, low in -300i64..300, width in 0i64..90, den in 1i64..12,
            most in 50i64..90, d in proptest::collection::btree_set(-4i64..=4, 1..4),
        ) {
            let gears = vec![
                Counts::range(s, s + span), Counts::range(p, p + span), Counts::range(1, most),
                Counts::range(p, p + span + 4), Counts::range(1, most),
            ];
            let space = SetSpace::new(SetKind::Wolfrom, gears, Counts::range(3, 3)).mismatch(d.clone());
            let window = [(low, den), (low + width, den)];
            let mut found = vec![];
            for sun in space.suns() {
                lines(&space, sun, &[window], &mut |t| found.push(t));
            }
            let mut brute = vec![];
            for s in s..=s + span { for p1 in p..=p + span { for p2 in p..=p + span + 4 { for d1 in &d { for d2 in &d {
                let (r1, r2) = (s + 2 * p1 + d1, s + p1 + p2 + d2);
                if r1 <= most && r2 <= most && inside(s, p1, r1, p2, r2, &window) {
                    brute.push([s, p1, r1, p2, r2]);
                }
            }}}}}
            found.sort();
            brute.sort();
            prop_assert_eq!(found, brute);
        }
    }
}
