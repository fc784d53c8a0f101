use super::{Law, ToothLoad};
use crate::Real;
use crate::losses::{Meta, Range, Trust};
use crate::real::max;

/// Equal load on every length of contact line: 50/50 in the double contact of spur gears.
///
/// # Formula
/// ```text
/// spur:     share = 1/n(x),  n = tooth pairs in contact = ⌊x⌋ + ⌊ε_α − x⌋ + 1
///           relieved tips: share = max(0, δ − g(x)),  Σ_k max(0, δ − g(x + k)) = 1
/// helical:  share = ∫_0^ε_β dy/l(x + y)
///           l(t) = ∫_0^ε_β [tooth pairs in contact in the section y at phase t] dy
/// ```
/// l is the total length of contact lines at the phase t of the mesh, in units of the line across
/// the whole width over ε_β. It is a trapezoid on a constant, so that the integral is a sum of
/// logarithms.
///
/// # Symbols
/// | there | here            | unit there | meaning                                      |
/// |-------|-----------------|------------|----------------------------------------------|
/// | x     | `position`      | −          | distance from A in base pitches              |
/// | ε_α   | `contact_ratio` | −          | transverse contact ratio                     |
/// | ε_β   | `overlap_ratio` | −          | overlap ratio                                |
/// | y, t  |                 | −          | place along the width; phase, in base pitches |
/// | g, δ  | `relief`        | −          | gap by tip relief; approach of the flanks, both over the deflection of one pair under the whole load |
///
/// # Valid for
/// Rigid teeth without misalignment; tip relief of spur gears, whose tooth pairs then are springs of one stiffness. With a contact ratio above 2
/// the pairs in contact share alike: 1/2 or 1/3. For ε_β → 0 the helical form becomes the one for
/// spur gears, for a whole ε_β it becomes 1/ε_α.
///
/// # Departs from the source
/// The field of contact is integrated in closed form instead of numerically. Tip relief is derived here: pairs as equal
/// springs side by side, less their gaps. A relief of depth 1 down to single contact hands the load over linearly, from 0
/// at A to all of it at B.
///
/// # Source
/// `[wimmer2006]`, load distribution on a rigid plane of action.
/// The number of the equation there is not known to us.
///
/// # Example
/// Spur, ε_α = 1.5: 1/2 at x = 0.25, where a second pair is in contact at 1.25.
/// Helical, ε_α = 1.5, ε_β = 1, by hand: l = 1.5 at every phase, share = 1/1.5.
/// ```
/// # use willis::losses::load_sharing::{Equal, Law, Relief, ToothLoad};
/// let relief = Relief::none();
/// let spur = ToothLoad { position: 0.25, contact_ratio: 1.5, overlap_ratio: 0.0, relief };
/// assert_eq!(Equal::DEFAULT.eval(&spur), 0.5);
/// assert!(Equal::DEFAULT.outside(&spur).is_empty());
/// let helical = ToothLoad { overlap_ratio: 1.0, ..spur };
/// assert_eq!(format!("{:.6}", Equal::DEFAULT.eval(&helical)), "0.666667");
/// // relieved by 1 over half a base pitch, by hand: 0.1/0.5 at 0.1 behind A
/// let relief = Relief { depth: [1.0; 2], length: [0.5; 2] };
/// assert!((Equal::DEFAULT.eval(&ToothLoad { position: 0.1, relief, ..spur }) - 0.2).abs() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Equal;

impl Equal {
    /// As published.
    pub const DEFAULT: Self = Self;
}

impl Law for Equal {
    const META: Meta<ToothLoad<f64>> = Meta {
        id: "equal",
        by: "",
        title: "Equal load per length of contact line (50/50)",
        source: ("wimmer2006", "rigid plane of action"),
        trust: Trust::Derived,
        tags: &[],
        valid: &[
            Range {
                symbol: "e_a + e_b",
                unit: "-",
                min: 1.0,
                max: f64::INFINITY,
                get: |s| s.contact_ratio + s.overlap_ratio,
            },
            Range {
                symbol: "e_b, relieved",
                unit: "-",
                min: 0.0,
                max: 0.0,
                get: |s| if s.relief.any() { s.overlap_ratio } else { 0.0 },
            },
        ],
    };

    fn eval<D: Real>(&self, s: &ToothLoad<D>) -> D {
        let (x, e_a, e_b) = (s.position, s.contact_ratio, s.overlap_ratio);
        if !s.on_path() {
            return D::zero();
        }
        if e_b.re() < 1e-9 && s.relief.any() {
            return s.relieved(|_| D::one());
        }
        if e_b.re() < 1e-9 {
            return D::from(1.0 / (x.re().floor() + (e_a.re() - x.re()).floor() + 1.0));
        }
        let lines = Lines::new(e_a, e_b);
        let whole = e_b.re().floor();
        let mut share = lines.walk(x, e_b - whole);
        if whole > 0.0 {
            share += lines.walk(D::zero(), D::one()) * whole;
        }
        share
    }
}

/// Total length of contact lines over one period of the phase: a constant plus a trapezoid.
struct Lines<D> {
    /// Phases 0 to 1 where the slope changes.
    knots: [D; 5],
    /// Length at the knots.
    lengths: [D; 5],
    /// Slope in between.
    slopes: [f64; 4],
}

impl<D: Real> Lines<D> {
    fn new(e_a: D, e_b: D) -> Self {
        let (whole_a, whole_b) = (e_a.re().floor(), e_b.re().floor());
        let (n_a, n_b) = (e_a - whole_a, e_b - whole_b);
        let (low, high) = if n_a.re() <= n_b.re() { (n_a, n_b) } else { (n_b, n_a) };
        let constant = e_b * whole_a + n_a * whole_b;
        let end = n_a + n_b;
        let (knots, bumps, slopes) = if end.re() <= 1.0 {
            ([D::zero(), low, high, end, D::one()], [D::zero(), low, low, D::zero(), D::zero()], [1.0, 0.0, -1.0, 0.0])
        } else {
            let wrap = end - 1.0;
            ([D::zero(), wrap, low, high, D::one()], [wrap, wrap, low, low, wrap], [0.0, 1.0, 0.0, -1.0])
        };
        // A gap in contact has length zero; the bound keeps the share finite there.
        let least = D::from(1e-12 * e_b.re());
        Self { knots, lengths: bumps.map(|b| max(constant + b, least)), slopes }
    }

    /// `∫ dt/l(t)` from the phase `from`, of period 1, over the distance `over`, 0 to 1.
    fn walk(&self, from: D, over: D) -> D {
        let mut t = from - from.re().floor();
        let mut left = over;
        let mut sum = D::zero();
        for _ in 0..2 {
            for k in 0..4 {
                if left.re() <= 0.0 {
                    return sum;
                }
                let room = self.knots[k + 1] - t;
                if room.re() <= 0.0 {
                    continue;
                }
                let step = if room.re() < left.re() { room } else { left };
                let start = max(self.lengths[k] + (t - self.knots[k]) * self.slopes[k], D::from(1e-300));
                sum += match self.slopes[k] {
                    0.0 => step / start,
                    slope => (step / start * slope).ln_1p() * slope,
                };
                left -= step;
                t += step;
            }
            t = D::zero();
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::losses::load_sharing::Relief;

    fn share(position: f64, contact_ratio: f64, overlap_ratio: f64) -> f64 {
        Equal::DEFAULT.eval(&ToothLoad { position, contact_ratio, overlap_ratio, relief: Relief::none() })
    }

    /// The share by counting contact lines in many sections.
    fn counted(x: f64, e_a: f64, e_b: f64) -> f64 {
        let n = 400;
        let section = |k: usize| (k as f64 + 0.5) / n as f64 * e_b;
        let length = |t: f64| {
            let pairs = |u: f64| (-20..20).filter(|k| (0.0..=e_a).contains(&(u + f64::from(*k)))).count() as f64;
            (0..n).map(|k| pairs(t - section(k))).sum::<f64>() / n as f64
        };
        (0..n).map(|k| 1.0 / length(x + section(k))).sum::<f64>() / n as f64
    }

    #[test]
    fn the_closed_form_is_the_count_of_contact_lines() {
        for (e_a, e_b) in [(1.4715, 0.5414), (1.3, 0.2), (1.3, 2.9), (2.2, 0.7), (0.8, 1.5), (1.9, 1.36)] {
            for k in 0..9 {
                let x = e_a * f64::from(k) / 8.0;
                let (ours, theirs) = (share(x, e_a, e_b), counted(x, e_a, e_b));
                assert!((ours - theirs).abs() < 0.02 * theirs, "{e_a} {e_b} {x}: {ours} {theirs}");
            }
        }
    }

    #[test]
    fn limits_of_the_overlap() {
        for x in [0.2, 0.7, 1.3] {
            assert!((share(x, 1.5, 1e-8) - share(x, 1.5, 0.0)).abs() < 1e-12);
            assert!((share(x, 1.5, 2.0) - 1.0 / 1.5).abs() < 1e-14);
        }
    }

    #[test]
    fn three_pairs() {
        assert_eq!(share(0.1, 2.4, 0.0), 1.0 / 3.0);
        assert_eq!(share(0.5, 2.4, 0.0), 0.5);
    }
}
