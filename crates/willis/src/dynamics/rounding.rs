//! Zeros that rounding hides, and numbers without its traces.

/// Round-off of a margin of a step of fixed length, relative to the sum of amounts.
pub(super) const NOISE: f64 = 1e-11;

/// A sum, or zero if that is no more than round-off of the amounts added up.
///
/// In a linear map a zero is a fact of the train: what is idle bears no force and what is held has no acceleration. Noise
/// in its place has a sign, which would be taken for a direction of power.
#[inline]
pub(super) fn unless_rounding(sum: f64, amounts: f64) -> f64 {
    if sum.abs() <= 64.0 * f64::EPSILON * amounts { 0.0 } else { sum }
}

/// A number for a sentence: six decimals at most, or seven digits where it is small.
pub(super) fn short(x: f64) -> f64 {
    if x.abs() >= 0.01 { (x * 1e6).round() / 1e6 } else { format!("{x:.6e}").parse().unwrap_or(x) }
}
