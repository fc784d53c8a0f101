//! Gear pairs for a ratio: fractions in the order of Stern and Brocot, so that the smallest gears come first.

use super::fit::gcd;
use willis::exact::Rational;

/// All fractions `p/q` in lowest terms in a closed window of positive numbers with `p` and `q` up to `most`, by `p + q`,
/// then by `p`: of a ratio of one pair of gears those with the fewest teeth first. Nothing smaller exists.
///
/// # Method
/// The tree of Stern and Brocot holds every fraction once, every one has a smaller numerator and denominator than those
/// below it, and the fractions below a node lie between its two ancestors: branches outside the window are never entered.
///
/// # Example
/// Two gears for π/2 within 0.1 %:
/// ```
/// use willis::exact::Rational;
/// use willis_synthesis::teeth::fractions;
///
/// let window = ["1.5692".parse().unwrap(), "1.5724".parse().unwrap()];
/// assert_eq!(fractions(&window, 60), [(11, 7)]);
/// ```
pub fn fractions(window: &[Rational; 2], most: i64) -> Vec<(i64, i64)> {
    let mut found = vec![];
    // Left and right ancestors; the path is as deep as the largest number.
    let mut stack = vec![((0i64, 1i64), (1i64, 0i64))];
    while let Some((left, right)) = stack.pop() {
        let middle = (left.0 + right.0, left.1 + right.1);
        if middle.0 > most || middle.1 > most {
            continue;
        }
        let value = Rational::new(middle.0, middle.1);
        if value >= window[0] && value <= window[1] {
            found.push(middle);
        }
        if value > window[0] {
            stack.push((left, middle));
        }
        if value < window[1] {
            stack.push((middle, right));
        }
    }
    found.sort_by_key(|(p, q)| (p + q, *p));
    found
}

/// Two pairs of gears in a row, `(a b)/(c d)` with every number in a closed range and the ratio in a closed window, by the
/// sum of teeth. Each is listed once: `a ≤ b` and `c ≤ d`.
///
/// One quotient is tried, the other one is a walk through the tree of [`fractions`], and multiples of its fractions are the
/// gears.
///
/// # Example
/// ```
/// use willis::exact::Rational;
/// use willis_synthesis::teeth::compound;
///
/// let pi = [Rational::new(31415, 10000), Rational::new(31417, 10000)];
/// let best = compound(&pi, [12, 40]);
/// let (a, b, c, d) = best[0];
/// assert!((a as f64 * b as f64 / (c as f64 * d as f64) - std::f64::consts::PI).abs() < 1.1e-4);
/// ```
pub fn compound(window: &[Rational; 2], [least, most]: [i64; 2]) -> Vec<(i64, i64, i64, i64)> {
    let mut found = vec![];
    if least < 1 || window[0].sign() <= 0 {
        return found;
    }
    for a in least..=most {
        for c in least..=most {
            // b/d must lie in the window divided by a/c.
            let by = Rational::new(c, a);
            for (p, q) in fractions(&[&window[0] * &by, &window[1] * &by], most) {
                debug_assert_eq!(gcd(p, q), 1);
                let factors = (least + p.min(q) - 1) / p.min(q)..=most / p.max(q);
                found.extend(factors.map(|k| (a, k * p, c, k * q)).filter(|(a, b, c, d)| a <= b && c <= d));
            }
        }
    }
    found.sort_by_key(|&(a, b, c, d)| (a + b + c + d, a, b, c, d));
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn trees_find_what_brute_force_finds() {
        for (low, high) in [((1, 3), (1, 2)), ((7, 5), (7, 5)), ((99, 100), (101, 100)), ((5, 1), (6, 1))] {
            let window = [Rational::new(low.0, low.1), Rational::new(high.0, high.1)];
            let mut brute = vec![];
            for p in 1..=40 {
                for q in 1..=40 {
                    let value = Rational::new(p, q);
                    if gcd(p, q) == 1 && value >= window[0] && value <= window[1] {
                        brute.push((p, q));
                    }
                }
            }
            brute.sort_by_key(|(p, q)| (p + q, *p));
            assert_eq!(fractions(&window, 40), brute);
            let mut brute = vec![];
            for a in 10..=18 {
                for b in a..=18 {
                    for c in 10..=18 {
                        for d in c..=18 {
                            let value = Rational::new(a * b, c * d);
                            if value >= window[0] && value <= window[1] {
                                brute.push((a, b, c, d));
                            }
                        }
                    }
                }
            }
            brute.sort_by_key(|&(a, b, c, d)| (a + b + c + d, a, b, c, d));
            assert_eq!(compound(&window, [10, 18]), brute);
        }
    }
}
