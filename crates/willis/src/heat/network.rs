//! The temperatures of a thermal network, some of them given.

use num_dual::Dual64;

use crate::real::Real;
use crate::train::heat::{Cooler, Heat, OIL, OilHeat};

/// Most steps of Newton's method.
const MOST_STEPS: usize = 100;
/// What is left of the heats, over the largest.
const ACCURACY: f64 = 1e-13;

/// The network has no solution with finite temperatures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unsolved;

impl std::fmt::Display for Unsolved {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("the thermal network has no finite temperatures")
    }
}

impl std::error::Error for Unsolved {}

/// A network around one oil temperature.
#[derive(Clone, Debug, PartialEq)]
pub struct Linearised {
    /// Temperature of each place, K.
    pub temperatures: Vec<f64>,
    /// Heat that leaves the oil less what is made in it, W: zero in a balance.
    pub residual: f64,
    /// `∂residual/∂θ` with the heats as they are, W/K: above zero. In a linear network the Schur complement of the oil.
    pub slope: f64,
    /// Of the heat made at each place, the part that reaches the oil: from 0 to 1; of the oil itself 1.
    pub shares: Vec<f64>,
}

impl Heat {
    /// Heat that leaves oil of a temperature if nothing is made anywhere, W.
    ///
    /// # Errors
    /// The network has no temperatures.
    pub fn carried(&self, oil: f64) -> Result<f64, Unsolved> {
        Ok(self.at(oil, &vec![0.0; self.nodes.len()])?.residual + self.extra_heat)
    }

    /// The coldest that anything can become from a start, K.
    pub(crate) fn coldest(&self, start: f64) -> f64 {
        let fixed = self.nodes.iter().filter_map(|n| n.fixed);
        fixed.chain(self.cooler.map(|c| c.inlet)).fold(start, f64::min)
    }

    /// Temperatures of all places where some are known (`None` is unknown), with the heat made at each, W.
    ///
    /// `Σ flow out of a place = heat made there`; Newton's method with steps that never let the largest imbalance grow.
    /// The equations are the gradient of a convex potential, so that the solution is the only one.
    ///
    /// # Errors
    /// A heat that is no finite number, or heat that nothing carries away.
    pub fn temperatures(&self, known: &[Option<f64>], made: &[f64]) -> Result<Vec<f64>, Unsolved> {
        let given = known.iter().flatten().copied();
        let mean = given.clone().sum::<f64>() / given.count().max(1) as f64;
        self.temperatures_near(known, made, &vec![mean; known.len()])
    }

    /// The same, looked for from temperatures near them.
    fn temperatures_near(&self, known: &[Option<f64>], made: &[f64], near: &[f64]) -> Result<Vec<f64>, Unsolved> {
        let unknown: Vec<usize> = (0..self.nodes.len()).filter(|k| known[*k].is_none()).collect();
        let mut t: Vec<f64> = known.iter().zip(near).map(|(k, near)| k.unwrap_or(*near)).collect();
        if unknown.is_empty() {
            return Ok(t);
        }
        let size = made.iter().fold(1e-9f64, |a, p| a.max(p.abs()));
        let worst = |t: &[f64]| {
            let left = imbalance(self, t, made);
            unknown.iter().fold(0.0f64, |a, k| a.max(left[*k].abs()))
        };
        let mut left = worst(&t);
        for _ in 0..MOST_STEPS {
            if !left.is_finite() {
                return Err(Unsolved);
            }
            let (matrix, imbalance) = self.slopes(&t, made);
            // Heat passing through decides how small a rest can be.
            let passing = unknown.iter().map(|&k| matrix[k][k] * t[k]).fold(size, f64::max);
            if left <= ACCURACY * 1e-2 * passing.max(size) {
                break;
            }
            let step = solve(
                unknown.iter().map(|&a| unknown.iter().map(|&b| matrix[a][b]).collect()).collect(),
                unknown.iter().map(|&a| -imbalance[a]).collect(),
            )
            .ok_or(Unsolved)?;
            let mut scale = 1.0;
            let better = loop {
                let mut next = t.clone();
                unknown.iter().zip(&step).for_each(|(&k, d)| next[k] += scale * d);
                let new = worst(&next);
                if next.iter().all(|t| *t > 0.0) && new < left {
                    break Some((next, new));
                }
                scale *= 0.5;
                if scale < 1e-12 {
                    break None;
                }
            };
            // No step makes it smaller: this is all that these numbers hold.
            let Some((next, new)) = better else { break };
            (t, left) = (next, new);
        }
        if left <= 1e-7 * size + 1e-9 { Ok(t) } else { Err(Unsolved) }
    }

    /// The slopes of the imbalance by the temperatures, and the imbalance.
    pub(super) fn slopes(&self, t: &[f64], made: &[f64]) -> (Vec<Vec<f64>>, Vec<f64>) {
        let n = self.nodes.len();
        let mut matrix = vec![vec![0.0; n]; n];
        for path in &self.paths {
            let [a, b] = path.between;
            let factor = if path.between.iter().any(|k| self.nodes[*k].fixed.is_some()) { self.factor } else { 1.0 };
            let law = path.law.map(Dual64::from);
            // A temperature that is given stays as it is.
            let moves = |k: usize| self.nodes[k].fixed.is_none() || self.nodes[k].capacity > 0.0;
            let seeds = [([1.0, 0.0], a), ([0.0, 1.0], b)].into_iter().filter(|(_, k)| moves(*k));
            for (seed, column) in seeds {
                let flow = law.flow(Dual64::new(t[a], seed[0]), Dual64::new(t[b], seed[1])) * factor;
                // Free convection between equal temperatures has no slope at all; it never blocks a step.
                let slope = match flow.eps == 0.0 {
                    true => (seed[0] - seed[1]) * 1e-9,
                    false => flow.eps,
                };
                matrix[a][column] += slope;
                matrix[b][column] -= slope;
            }
        }
        let cooled = |cooler: &Cooler| {
            let oil = OilHeat {
                density_15: Dual64::from(self.oil.density_15),
                expansion: self.oil.expansion,
                specific_heat: Dual64::from(self.oil.specific_heat),
            };
            (cooler.map(Dual64::from).cooled(&oil, Dual64::new(t[OIL], 1.0)) * self.factor).eps
        };
        matrix[OIL][OIL] += self.cooler.as_ref().map_or(0.0, cooled);
        (matrix, imbalance(self, t, made))
    }

    /// The network at an oil temperature, K, with the heat made at each place, W.
    ///
    /// # Errors
    /// As of [`Heat::temperatures`].
    ///
    /// # Example
    /// Oil and housing: of the heat made in the housing, `80/(80 + 20)` of what the housing would pass back.
    /// ```
    /// use willis::Train;
    ///
    /// let train = Train::from_toml(r#"
    ///     format = 1
    ///     name = "oil and housing"
    ///     members = ["a", "b"]
    ///     terminals = ["a", "b"]
    ///     mesh = [{ gears = [{ member = "a", teeth = 20 }, { member = "b", teeth = 30 }], efficiency = 0.99 }]
    ///     [heat]
    ///     ambient = "20 degC"
    ///     node = [{ name = "housing" }]
    ///     path = [{ between = ["oil", "housing"], conductance = "80 W/K" },
    ///             { between = ["housing", "ambient"], conductance = "20 W/K" }]
    /// "#)?;
    /// let heat = train.heat().unwrap();
    /// let at = heat.at(353.15, &[960.0, 0.0, 0.0]).unwrap();
    /// assert!((at.slope - 16.0).abs() < 1e-9);             // 80 and 20 W/K in a row
    /// assert!((at.shares[2] - 0.8).abs() < 1e-12);
    /// assert!(at.residual.abs() < 1e-9);                   // 60 K over 16 W/K
    /// # Ok::<(), willis::Diagnostics>(())
    /// ```
    pub fn at(&self, oil: f64, made: &[f64]) -> Result<Linearised, Unsolved> {
        self.at_near(oil, made, None)
    }

    /// The same, looked for from other temperatures.
    pub(super) fn at_near(&self, oil: f64, made: &[f64], near: Option<&[f64]>) -> Result<Linearised, Unsolved> {
        let known: Vec<Option<f64>> =
            self.nodes.iter().enumerate().map(|(k, n)| if k == OIL { Some(oil) } else { n.fixed }).collect();
        // What is not found from there may be found from the middle of what is given.
        let found = near.and_then(|near| self.temperatures_near(&known, made, near).ok());
        let temperatures = found.map_or_else(|| self.temperatures(&known, made), Ok)?;
        let (matrix, imbalance) = self.slopes(&temperatures, made);
        let free: Vec<usize> = (0..self.nodes.len()).filter(|k| known[*k].is_none()).collect();
        let inner: Vec<Vec<f64>> = free.iter().map(|&a| free.iter().map(|&b| matrix[a][b]).collect()).collect();
        let mut shares = vec![0.0; self.nodes.len()];
        shares[OIL] = 1.0;
        let mut slope = matrix[OIL][OIL];
        if !free.is_empty() {
            let transposed = (0..free.len()).map(|j| inner.iter().map(|row| row[j]).collect()).collect();
            let toward_oil = free.iter().map(|&k| -matrix[OIL][k]).collect();
            let found = solve(transposed, toward_oil).ok_or(Unsolved)?;
            for (&k, share) in free.iter().zip(&found) {
                shares[k] = *share;
                slope += share * matrix[k][OIL];
            }
        }
        Ok(Linearised { residual: imbalance[OIL], temperatures, slope, shares })
    }

    /// The oil temperature without any loss, K: that of the air, or between those of air and coolant.
    pub(crate) fn cold(&self) -> Result<f64, Unsolved> {
        let fixed = self.nodes.iter().filter_map(|n| n.fixed).chain(self.cooler.map(|c| c.inlet));
        let (mut low, mut high) = fixed.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), t| (a.min(t), b.max(t)));
        let nothing = vec![0.0; self.nodes.len()];
        let without = Heat { extra_heat: 0.0, ..self.clone() };
        if low == high || without.at(low, &nothing)?.residual >= 0.0 {
            return Ok(low);
        }
        while let middle = 0.5 * (low + high)
            && middle > low
            && middle < high
        {
            match without.at(middle, &nothing)?.residual < 0.0 {
                true => low = middle,
                false => high = middle,
            }
        }
        Ok(high)
    }
}

/// Heat that leaves each place less what is made there, W.
pub(crate) fn imbalance<R: Real>(heat: &Heat<R>, t: &[R], made: &[f64]) -> Vec<R> {
    let mut left: Vec<R> = made.iter().map(|p| R::from(-p)).collect();
    for (k, path) in heat.paths.iter().enumerate() {
        let [a, b] = path.between;
        let flow = heat.flow(k, t[a], t[b]);
        left[a] += flow;
        left[b] -= flow;
    }
    left[OIL] += heat.cooled(t[OIL]) * heat.factor - heat.extra_heat;
    left
}

/// Solves linear equations with row exchanges; `None` where they are singular.
pub(crate) fn solve(mut m: Vec<Vec<f64>>, mut b: Vec<f64>) -> Option<Vec<f64>> {
    let n = b.len();
    for k in 0..n {
        let best = (k..n).max_by(|&i, &j| m[i][k].abs().total_cmp(&m[j][k].abs()))?;
        if m[best][k] == 0.0 || !m[best][k].is_finite() {
            return None;
        }
        m.swap(k, best);
        b.swap(k, best);
        for i in k + 1..n {
            let factor = m[i][k] / m[k][k];
            if factor != 0.0 {
                for j in k..n {
                    let above = m[k][j];
                    m[i][j] -= factor * above;
                }
                b[i] -= factor * b[k];
            }
        }
    }
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|j| m[k][j] * b[j]).sum();
        b[k] = (b[k] - known) / m[k][k];
    }
    Some(b)
}
