//! What is not worse than anything else in every respect: the Pareto front.
//!
//! Objectives come from floating point, and trains of equal ratios have equal efficiencies: what differs by rounding alone is
//! the same.

/// A front that grows point by point; all objectives are minimised.
///
/// A point stays if no other is at least as good in every objective and better in one. Points with equal objectives (up to
/// rounding, 10⁻¹² of one, and of themselves where they are larger) all stay, in the order of their keys. Memory is that of the
/// front, whatever goes through it.
///
/// # Example
/// ```
/// use willis_synthesis::teeth::Front;
///
/// let mut front = Front::default();
/// for (key, point) in [[1.0, 3.0], [2.0, 2.0], [2.0, 2.5], [3.0, 1.0], [1.0, 3.0]].into_iter().enumerate() {
///     front.offer(point.to_vec(), key);
/// }
/// let kept: Vec<usize> = front.into_sorted().into_iter().map(|(_, key)| key).collect();
/// assert_eq!(kept, [0, 4, 1, 3]);
/// ```
#[derive(Clone, Debug)]
pub struct Front<K> {
    points: Vec<(Vec<f64>, K)>,
}

/// What rounding may make of an objective: ratios are fractions of numbers of teeth, and differ by far more or not at all.
const SAME: f64 = 1e-12;

/// Whether one point is at least as good as another in every objective.
fn covers(a: &[f64], b: &[f64]) -> bool {
    // An objective may be without end.
    a.iter().zip(b).all(|(x, y)| x <= y || *x <= *y + SAME * y.abs().max(1.0))
}

/// Whether one point is at least as good as another in every objective, and better in one.
pub(crate) fn beats(a: &[f64], b: &[f64]) -> bool {
    covers(a, b) && !covers(b, a)
}

impl<K> Default for Front<K> {
    fn default() -> Self {
        Self { points: vec![] }
    }
}

impl<K: Ord> Front<K> {
    /// Takes a point in, and drops what it dominates. Points with a value that is no number are refused.
    pub fn offer(&mut self, point: Vec<f64>, key: K) -> bool {
        if point.iter().any(|x| x.is_nan()) {
            return false;
        }
        if self.refuses(&point) {
            return false;
        }
        self.points.retain(|(p, _)| !beats(&point, p));
        self.points.push((point, key));
        true
    }

    /// Whether a point would be refused.
    pub fn refuses(&self, point: &[f64]) -> bool {
        self.points.iter().any(|(p, _)| beats(p, point))
    }

    /// Takes in all points of another front: the result does not depend on how points were divided.
    pub fn merge(&mut self, other: Self) {
        for (point, key) in other.points {
            self.offer(point, key);
        }
    }

    /// How many points it has.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Whether it has none.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Its points, by the first objective, then the others, then by key.
    pub fn into_sorted(mut self) -> Vec<(Vec<f64>, K)> {
        // What is the same up to rounding is in the order of the keys.
        let rounded = |x: &f64| (x / SAME).round() + 0.0;
        self.points.sort_by(|(a, k), (b, l)| {
            let unequal = a.iter().zip(b).map(|(x, y)| rounded(x).total_cmp(&rounded(y))).find(|o| o.is_ne());
            unequal.unwrap_or(std::cmp::Ordering::Equal).then_with(|| k.cmp(l))
        });
        self.points
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_front_does_not_depend_on_the_order() {
        let mut state = 7u64;
        let mut random = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            ((state >> 40) % 12) as f64
        };
        let points: Vec<Vec<f64>> = (0..400).map(|_| vec![random(), random(), random()]).collect();
        let run = |order: &mut dyn Iterator<Item = usize>| {
            let mut front = Front::default();
            for k in order {
                front.offer(points[k].clone(), k);
            }
            front.into_sorted()
        };
        let forward = run(&mut (0..400));
        assert_eq!(forward, run(&mut (0..400).rev()));
        let dominated =
            |k: usize| points.iter().any(|p| p.iter().zip(&points[k]).all(|(x, y)| x <= y) && *p != points[k]);
        assert_eq!(forward.len(), (0..400).filter(|k| !dominated(*k)).count());
        let halves = [0, 200].map(|from| {
            let mut front = Front::default();
            (from..from + 200).for_each(|k| {
                front.offer(points[k].clone(), k);
            });
            front
        });
        let [mut left, right] = halves;
        left.merge(right);
        assert_eq!(forward, left.into_sorted());
    }

    /// Points that are equal but for rounding are beaten by, and beat, the same ones as without it.
    #[test]
    fn rounding_changes_no_front() {
        let mut state = 11u64;
        let mut random = |below: u64| {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 33) % below
        };
        let exact: Vec<Vec<f64>> = (0..300)
            .map(|_| (0..4).map(|_| if random(20) == 0 { f64::NEG_INFINITY } else { random(5) as f64 / 3.0 }).collect())
            .collect();
        let jitter: Vec<Vec<f64>> =
            exact.iter().map(|p| p.iter().map(|x| x + (random(9) as f64 - 4.0) * f64::EPSILON).collect()).collect();
        let keys = |points: &[Vec<f64>]| {
            let mut front = Front::default();
            for (k, p) in points.iter().enumerate() {
                front.offer(p.clone(), k);
            }
            front.into_sorted().into_iter().map(|(_, key)| key).collect::<Vec<usize>>()
        };
        assert_eq!(keys(&exact), keys(&jitter));
    }
}
