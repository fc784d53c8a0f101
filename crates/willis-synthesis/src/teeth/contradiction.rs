//! Whether ratios contradict each other, whatever the teeth are.

use super::form::Quotient;
use super::wish::Ratio;

/// More boxes than this are not looked at.
const MOST_BOXES: usize = 40_000;

/// Whether no basic ratios in a box give every quotient a value in its windows: the box is halved until each part is
/// excluded by some quotient, whose extremes over a box are at its corners. They are found in floating point, with a
/// margin for rounding.
pub(crate) fn excluded(targets: &[(&Quotient, &Ratio)], bounds: &[[f64; 2]]) -> bool {
    let mut stack = vec![bounds.to_vec()];
    let mut looked = 0;
    while let Some(part) = stack.pop() {
        looked += 1;
        if looked > MOST_BOXES {
            return false;
        }
        if targets.iter().any(|(q, r)| misses(q, r, &part)) {
            continue;
        }
        // The widest variable on which something depends, relative to its size.
        let width = |v: usize| (part[v][1] / part[v][0]).ln();
        let used = (0..part.len()).filter(|v| targets.iter().any(|(q, _)| q.depends_on(*v)));
        let Some(widest) = used.max_by(|a, b| width(*a).total_cmp(&width(*b))) else { return false };
        if width(widest) < 1e-6 {
            return false;
        }
        let [low, high] = part[widest];
        let middle = (low * high).sqrt();
        for half in [[low, middle], [middle, high]] {
            let mut next = part.clone();
            next[widest] = half;
            stack.push(next);
        }
    }
    true
}

/// Whether a quotient misses its windows everywhere in a box.
fn misses(quotient: &Quotient, ratio: &Ratio, part: &[[f64; 2]]) -> bool {
    let (mut low, mut high, mut sign) = (f64::INFINITY, f64::NEG_INFINITY, 0.0);
    for corner in 0..1usize << part.len() {
        let y: Vec<f64> = part.iter().enumerate().map(|(v, b)| b[corner >> v & 1]).collect();
        let (n, d) = (quotient.numerator.at(&y), quotient.denominator.at(&y));
        if d == 0.0 || d * sign < 0.0 || !(n / d).is_finite() {
            return false;
        }
        sign = d;
        low = low.min(n / d);
        high = high.max(n / d);
    }
    let slack = 1e-9 * (low.abs() + high.abs());
    ratio.windows.iter().all(|[a, b]| a.to_f64() > high + slack || low - slack > b.to_f64())
}
