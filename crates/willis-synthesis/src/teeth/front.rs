//! What is not worse than anything else in every respect: the Pareto front, exactly.

/// A front that grows point by point; all objectives are minimised.
///
/// A point stays if no other is at least as good in every objective and better in one. Points with equal objectives all
/// stay, in the order of their keys. Memory is that of the front, whatever goes through it.
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

/// Whether one point is at least as good as another in every objective.
pub(crate) fn covers(a: &[f64], b: &[f64]) -> bool {
    a.iter().zip(b).all(|(x, y)| x <= y)
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
        if self.points.iter().any(|(p, _)| covers(p, &point) && *p != point) {
            return false;
        }
        self.points.retain(|(p, _)| !covers(&point, p) || *p == point);
        self.points.push((point, key));
        true
    }

    /// Whether a point would be refused.
    pub fn refuses(&self, point: &[f64]) -> bool {
        self.points.iter().any(|(p, _)| covers(p, point) && p != point)
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
        self.points.sort_by(|(a, k), (b, l)| {
            let unequal = a.iter().zip(b).map(|(x, y)| x.total_cmp(y)).find(|o| o.is_ne());
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
}
