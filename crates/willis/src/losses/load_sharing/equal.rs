use super::{Law, ToothLoad};
use crate::Real;
use crate::losses::{LawInfo, ValidityRange, Trust};
use crate::losses::load_sharing::Relief;
use crate::real::{abs, max, min};

/// Equal load on every length of contact line: 50/50 in the double contact of spur gears.
///
/// # Formula
/// ```text
/// spur:     share = 1/n(x),  n = tooth pairs in contact = ⌊x⌋ + ⌊ε_α − x⌋ + 1
///           relieved tips: share = max(0, δ − g(x)),  Σ_k max(0, δ − g(x + k)) = 1
/// helical:  share = ∫_0^ε_β dy/l(x + y)
///           l(t) = ∫_0^ε_β [tooth pairs in contact in the section y at phase t] dy
///           relieved tips: share = 1/ε_β ∫_0^ε_β max(0, δ(x + y) − g(x)) dy
///           1/ε_β ∫_0^ε_β Σ_k max(0, δ(t) − g(t − y + k)) dy = 1
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
/// Rigid teeth without misalignment; with tip relief tooth pairs are springs of one stiffness, those of helical gears in slices that do not
/// support each other, all approached by as much. With a contact ratio above 2
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
    const META: LawInfo<ToothLoad<f64>> = LawInfo {
        id: "equal",
        by: "",
        title: "Equal load per length of contact line (50/50)",
        source: ("wimmer2006", "rigid plane of action"),
        trust: Trust::Derived,
        tags: &[],
        valid: &[
            ValidityRange {
                symbol: "e_a + e_b",
                unit: "-",
                min: 1.0,
                max: f64::INFINITY,
                get: |s| s.contact_ratio + s.overlap_ratio,
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
        if s.relief.any() {
            return Slices { contact_ratio: e_a, overlap_ratio: e_b, relief: s.relief }.share(x);
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

/// Nodes and weights of Gauss and Legendre, 4 points on −1 to 1, one half.
const GAUSS: [(f64, f64); 2] = [(0.339_981_043_584_856_3, 0.652_145_154_862_546_1), (0.861_136_311_594_052_6, 0.347_854_845_137_453_8)];

/// Longest part of a period of the phase over which the approach is integrated at once, in base pitches: for the share at one place,
/// and for the moment of all, once for each load, where places at which slices lose contact make kinks.
const PARTS: [f64; 2] = [1.0 / 4.0, 1.0 / 64.0];

/// Slices across a helical gear with relieved tips: springs side by side, each at its own place of the path, all approached by as much.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slices<D> {
    /// Transverse contact ratio.
    pub contact_ratio: D,
    /// Overlap ratio of one helix, above 0.
    pub overlap_ratio: D,
    pub relief: Relief<D>,
}

/// What the slices on a part of the path do at one approach.
struct Sum<D> {
    load: D,
    spring: D,
    /// Load times distance from a place.
    moment: D,
}

impl<D: Real> Slices<D> {
    /// Sums over the part of the path from `from` to `to` whose slices touch at an approach; all of them where there is none yet.
    fn sum(&self, [from, to]: [D; 2], approach: Option<D>, about: D, sum: &mut Sum<D>) {
        let (none, e_a) = (D::zero(), self.contact_ratio);
        let [start, end] = self.relief.length;
        // Between these places the gap and the distance are linear.
        let mut knots = [from, to, start, e_a - end, about];
        knots.iter_mut().for_each(|k| *k = min(max(*k, from), to));
        knots.sort_by(|a, b| a.re().total_cmp(&b.re()));
        for [mut a, mut b] in knots.array_windows().copied() {
            let width = b - a;
            if width.re() <= 1e-15 {
                continue;
            }
            // Just inside, where lengths end at the same place.
            let [ga, gb] = [a, b].map(|x| self.relief.gap(x, e_a));
            let Some(approach) = approach else {
                sum.load += (ga + gb) * width / 2.0;
                sum.spring += width;
                continue;
            };
            let [mut ha, mut hb] = [approach - ga, approach - gb];
            if ha.re() <= 0.0 && hb.re() <= 0.0 {
                continue;
            }
            // Where one end stands open the slices touch from the place on at which the gap is the approach.
            let place = a + width * (ha / (ha - hb));
            if ha.re() < 0.0 {
                (a, ha) = (place, none);
            } else if hb.re() < 0.0 {
                (b, hb) = (place, none);
            }
            let width = b - a;
            let [qa, qb] = [a, b].map(|x| abs(x - about));
            sum.load += (ha + hb) * width / 2.0;
            sum.spring += width;
            sum.moment += (ha * qa * 2.0 + ha * qb + hb * qa + hb * qb * 2.0) * width / 6.0;
        }
    }

    /// The same over all slices at a phase, 0 to 1.
    fn at(&self, phase: D, approach: Option<D>, about: D) -> Sum<D> {
        let mut sum = Sum { load: D::zero(), spring: D::zero(), moment: D::zero() };
        let most = (self.contact_ratio + self.overlap_ratio).re().ceil().clamp(0.0, 1000.0) as usize;
        for k in 0..=most {
            let upper = phase + k as f64;
            let window = [max(upper - self.overlap_ratio, D::zero()), min(upper, self.contact_ratio)];
            if window[1].re() > window[0].re() {
                self.sum(window, approach, about, &mut sum);
            }
        }
        sum
    }

    /// The approach at a phase, over the deflection of one pair under the whole load.
    ///
    /// The load is convex in the approach and taken over all slices first, so that Newton's method comes from above. Its last step
    /// carries the derivatives.
    fn approach(&self, phase: D) -> D {
        let all = self.at(phase, None, D::zero());
        // A gap in contact has no slice; the bound keeps the approach finite there.
        let spring = |s: &Sum<D>| max(s.spring, D::from(1e-9 * self.overlap_ratio.re()));
        let mut approach = (self.overlap_ratio + all.load) / spring(&all);
        for _ in 0..60 {
            let now = self.at(phase, Some(approach), D::zero());
            let next = approach - (now.load - self.overlap_ratio) / spring(&now);
            let done = (approach.re() - next.re()).abs() <= 1e-13 * approach.re().abs();
            approach = next;
            if done {
                break;
            }
        }
        approach
    }

    /// Parts of a stretch of phases within which the number of slices at either end changes steadily.
    fn parts(&self, longest: f64, from: D, over: D, mut each: impl FnMut(D, D)) {
        let (e_a, e_b, [start, end]) = (self.contact_ratio, self.overlap_ratio, self.relief.length);
        let kinks = [D::zero(), e_a, start, e_a - end].map(|x| [x, x + e_b]);
        let (mut at, to) = (from, from + over);
        for _ in 0..10_000 {
            if at.re() >= to.re() {
                return;
            }
            let mut next = min(to, at + longest);
            for kink in kinks.as_flattened() {
                let place = *kink + (at.re() - kink.re()).floor() + 1.0;
                if place.re() > at.re() + 1e-12 && place.re() < next.re() {
                    next = place;
                }
            }
            let (middle, half) = ((at + next) / 2.0, (next - at) / 2.0);
            for (node, weight) in GAUSS {
                each(middle + half * node, half * weight);
                each(middle - half * node, half * weight);
            }
            at = next;
        }
    }

    /// The share of a tooth pair at a place of its path, averaged over the face width.
    pub fn share(&self, x: D) -> D {
        let gap = self.relief.gap(x, self.contact_ratio);
        let mut share = D::zero();
        let mut over = |from: &D, over: &D, times: f64| {
            self.parts(PARTS[0], *from, *over, |phase, weight| {
                let own = self.approach(phase - phase.re().floor()) - gap;
                if own.re() > 0.0 {
                    share += own * weight * times;
                }
            });
        };
        let whole = self.overlap_ratio.re().floor();
        over(&x, &(self.overlap_ratio - whole), 1.0);
        if whole > 0.0 {
            over(&D::zero(), &D::one(), whole);
        }
        share / self.overlap_ratio
    }

    /// The integral of the share times the distance from a place along the path, in base pitches: at each phase in closed form.
    pub fn moment(&self, about: D) -> D {
        let mut moment = D::zero();
        self.parts(PARTS[1], D::zero(), D::one(), |phase, weight| {
            let own = self.approach(phase);
            moment += self.at(phase, Some(own), about).moment * weight;
        });
        moment / self.overlap_ratio
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

    fn relieved(position: f64, contact_ratio: f64, overlap_ratio: f64, relief: Relief<f64>) -> f64 {
        Equal::DEFAULT.eval(&ToothLoad { position, contact_ratio, overlap_ratio, relief })
    }

    /// The share by springs in many slices, the approach found by halving.
    fn springs(x: f64, e_a: f64, e_b: f64, relief: Relief<f64>) -> f64 {
        let n = 300;
        let section = |k: usize| (k as f64 + 0.5) / n as f64 * e_b;
        let touch = |u: f64, d: f64| if (0.0..=e_a).contains(&u) { (d - relief.gap(u, e_a)).max(0.0) } else { 0.0 };
        let load = |t: f64, d: f64| {
            let pairs = |u: f64| (-9..9).map(|k| touch(u + f64::from(k), d)).sum::<f64>();
            (0..n).map(|k| pairs(t - section(k))).sum::<f64>() / n as f64
        };
        let approach = |t: f64| {
            let (mut low, mut high) = (0.0, 50.0);
            for _ in 0..40 {
                let d = f64::midpoint(low, high);
                if load(t, d) > 1.0 { high = d } else { low = d }
            }
            low
        };
        (0..n).map(|k| touch(x, approach(x + section(k)))).sum::<f64>() / n as f64
    }

    #[test]
    fn relieved_slices_are_springs_side_by_side() {
        for (e_a, e_b, depth, length) in [
            (1.47, 0.54, [1.0, 0.5], [0.4, 0.3]),
            (1.3, 1.2, [2.0, 2.0], [0.3, 0.3]),
            (1.9, 0.15, [0.3, 0.0], [0.9, 0.0]),
        ] {
            let relief = Relief { depth, length };
            for k in 0..4 {
                let x = e_a * (f64::from(k) + 0.3) / 4.0;
                let (ours, theirs) = (relieved(x, e_a, e_b, relief), springs(x, e_a, e_b, relief));
                assert!((ours - theirs).abs() < 0.01, "{e_a} {e_b} {x}: {ours} {theirs}");
            }
        }
    }

    #[test]
    fn limits_of_relieved_slices() {
        let (e_a, relief) = (1.55, Relief { depth: [1.0, 0.6], length: [0.5, 0.4] });
        for x in [0.05, 0.2, 0.7, 1.3] {
            // Spur teeth without an overlap; teeth without relief where it is none.
            let (slices, spur) = (relieved(x, e_a, 1e-6, relief), relieved(x, e_a, 0.0, relief));
            assert!((slices - spur).abs() < 1e-5, "{x}: {slices} {spur}");
            let least = Relief { depth: [1e-9; 2], ..relief };
            let (slices, none) = (relieved(x, e_a, 0.7, least), share(x, e_a, 0.7));
            assert!((slices - none).abs() < 2e-5, "{x}: {slices} {none}");
        }
        // The load of the mesh is always carried; its moment is that of the shares.
        for e_b in [0.3, 1.0, 1.7] {
            let n = 2000;
            let at = |k: usize| (k as f64 + 0.5) / n as f64 * e_a;
            let sums = (0..n).map(|k| relieved(at(k), e_a, e_b, relief) * e_a / n as f64);
            let (mut load, mut moment) = (0.0, 0.0);
            for (k, own) in sums.enumerate() {
                load += own;
                moment += own * (at(k) - 0.8).abs();
            }
            assert!((load - 1.0).abs() < 1e-3, "{e_b}: {load}");
            let whole = Slices { contact_ratio: e_a, overlap_ratio: e_b, relief }.moment(0.8);
            assert!((moment / whole - 1.0).abs() < 1e-3, "{e_b}: {moment} {whole}");
        }
    }

    #[test]
    fn three_pairs() {
        assert_eq!(share(0.1, 2.4, 0.0), 1.0 / 3.0);
        assert_eq!(share(0.5, 2.4, 0.0), 0.5);
    }
}
