use crate::real::Real;

/// The involute function `inv α = tan α − α` of a pressure angle, rad, 0 ≤ α < π/2.
///
/// # Source
/// `[iso21771]`, involute function.
///
/// # Example
/// ```
/// let inv = willis::geometry::involute(20f64.to_radians());
/// assert_eq!(format!("{inv:.6}"), "0.014904");
/// ```
pub fn involute<R: Real>(angle: R) -> R {
    angle.tan() - angle
}

/// The angle α, rad, of which `tan α − α` is the number given; `None` below zero or not finite.
///
/// With t = tan α, Newton's method on t − atan t, which is convex and rises: after one step it
/// closes in from above.
///
/// # Example
/// ```
/// use willis::geometry::{inverse_involute, involute};
///
/// let angle = inverse_involute(involute(0.4)).unwrap();
/// assert!((angle - 0.4).abs() < 1e-14);
/// assert_eq!(inverse_involute(-0.001), None);
/// ```
pub fn inverse_involute<R: Real>(value: R) -> Option<R> {
    let (exact, value) = (value, value.re());
    if !value.is_finite() || value < 0.0 {
        return None;
    }
    if value == 0.0 {
        return Some(R::from(0.0));
    }
    let cube = (3.0 * value).cbrt();
    let mut t = (cube * (1.0 + 0.2 * cube * cube)).min(value + std::f64::consts::FRAC_PI_2);
    for _ in 0..100 {
        let step = (t - t.atan() - value) * (1.0 + t * t) / (t * t);
        t -= step;
        if step.abs() <= 1e-16 * t {
            break;
        }
    }
    // The derivative of the inverse: (1 + t²)/t² of the value's.
    let t = (exact - value) * ((1.0 + t * t) / (t * t)) + t;
    Some(t.atan())
}
