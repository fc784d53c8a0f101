//! Where to sample: scrambled Sobol points, and what follows from the values there.

use serde::{Deserialize, Serialize};
use sobol_burley::parts::{hash, owen_scramble_rev, sobol_rev};

use crate::diagnostic::{Code, Diagnostic, Diagnostics};

/// Independent scramblings of the same points; their disagreement is the sampling error.
pub const REPLICATES: usize = 8;
/// Student's t with `REPLICATES − 1` degrees of freedom: 95 % lie within ± this.
const STUDENT: f64 = 2.364_624_251_592_785;
/// So many points of one scrambling are offered.
const MOST_POINTS: usize = 1 << 16;
/// So many coordinates the direction numbers have.
const MOST_COORDINATES: usize = 256;
/// Fewer values of one scrambling than this have no quantiles.
const FEWEST_VALUES: usize = 4;

/// Points in the unit cube at which a function is to be evaluated, so that the distribution of its values and its Sobol
/// indices can be told.
///
/// # Method
/// Quasi-Monte Carlo: a Sobol sequence (direction numbers of Joe and Kuo, 2008) with Owen's nested scrambling (Owen,
/// 1995; by hashing after Burley, 2020), in [`REPLICATES`] independent scramblings. Each has two sets of points, A and
/// B, from the first and the last half of its coordinates, and for every coordinate i the set AB_i, which is A with
/// coordinate i from B (Saltelli et al., 2010). A and B together are the *samples*; with one coordinate there is no
/// AB_i. Nothing is drawn from a clock: the same seed gives the same points everywhere.
///
/// # Example
/// ```
/// use willis::study::Design;
///
/// // x + y, both between 0 and 1: mean 1, standard deviation 1/√6, 5 % below √0.1.
/// let design = Design::new(2, 1024, 1)?;
/// let values: Vec<f64> = (0..design.len()).map(|k| design.at(k).iter().sum()).collect();
/// let found = design.statistics(&values).unwrap();
/// assert!((found.mean - 1.0).abs() < 1e-3);
/// assert!((found.p05 - 0.1f64.sqrt()).abs() < 0.01);
/// let indices = design.indices(&values).unwrap();
/// assert!((indices[0].first - 0.5).abs() < 0.02 && (indices[0].total - 0.5).abs() < 0.02);
/// # Ok::<(), willis::Diagnostics>(())
/// ```
#[derive(Clone, Debug)]
pub struct Design {
    coordinates: usize,
    /// Of one scrambling.
    points: usize,
    seed: u64,
    /// Of every replicate, for every coordinate of A and of B.
    scrambles: Vec<u32>,
}

/// What can be said of the values of one quantity.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Statistics {
    /// Samples that have a value.
    pub answered: usize,
    /// Mean.
    pub mean: f64,
    /// Standard deviation.
    pub standard_deviation: f64,
    /// Half of the values are below.
    pub median: f64,
    /// 2.5 % of the values are below.
    pub p025: f64,
    /// 5 % of the values are below.
    pub p05: f64,
    /// 95 % of the values are below.
    pub p95: f64,
    /// 97.5 % of the values are below.
    pub p975: f64,
    /// The smallest value.
    pub least: f64,
    /// The largest value.
    pub most: f64,
    /// Half the width of the 95 % confidence interval of each, from the replicates.
    pub sampling_error: SamplingError,
}

impl Statistics {
    /// Values that differ by no more than this part are the same: an operating point is no more exact.
    pub const SAME: f64 = 1e-9;
}

/// How far a statistic may be off because the samples are finitely many: half the width of its 95 % confidence interval,
/// `t s/√R` with the standard deviation s of the statistic over the R replicates (L'Ecuyer et al., 2023).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SamplingError {
    /// Of the mean.
    pub mean: f64,
    /// Of the median.
    pub median: f64,
    /// Of the 2.5 % quantile.
    pub p025: f64,
    /// Of the 5 % quantile.
    pub p05: f64,
    /// Of the 95 % quantile.
    pub p95: f64,
    /// Of the 97.5 % quantile.
    pub p975: f64,
}

/// The share of the variance for which one coordinate answers: its Sobol indices.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SobolIndices {
    /// First-order Sobol index `V[E(y|x_i)]/V(y)`: by itself.
    pub first: f64,
    /// Half the width of its 95 % confidence interval.
    pub first_error: f64,
    /// Total Sobol index `E[V(y|x_~i)]/V(y)`: with all interactions.
    pub total: f64,
    /// Half the width of its 95 % confidence interval.
    pub total_error: f64,
}

fn wrong(message: String) -> Diagnostics {
    Diagnostic::new(Code::BadAxis, "", message).into()
}

/// One step of SplitMix64 (Steele, Lea and Flood, 2014): well mixed bits of any number.
fn mix(n: u64) -> u64 {
    let n = n.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let n = (n ^ (n >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let n = (n ^ (n >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    n ^ (n >> 31)
}

impl Design {
    /// Points for so many coordinates; `samples` is the size of A and B in all replicates together.
    ///
    /// # Errors
    /// No coordinate or more than 128; `samples` that are no power of two from 128 to 1 048 576.
    pub fn new(coordinates: usize, samples: usize, seed: u64) -> Result<Self, Diagnostics> {
        if !(1..=MOST_COORDINATES / 2).contains(&coordinates) {
            let most = MOST_COORDINATES / 2;
            return Err(wrong(format!("{coordinates} uncertain quantities are not possible; from 1 to {most} are")));
        }
        let points = samples / (2 * REPLICATES);
        if !samples.is_power_of_two() || !(8..=MOST_POINTS).contains(&points) {
            let most = 2 * REPLICATES * MOST_POINTS;
            return Err(wrong(format!("{samples} samples are not possible; powers of two from 128 to {most} are")));
        }
        let scrambles = (0..REPLICATES as u64)
            .flat_map(|r| (0..2 * coordinates as u64).map(move |c| (r, c)))
            .map(|(r, c)| hash((mix(mix(mix(seed) ^ r) ^ c) >> 32) as u32))
            .collect();
        Ok(Self { coordinates, points, seed, scrambles })
    }

    /// The smallest possible number of samples that is not below this one.
    pub fn possible(samples: usize) -> usize {
        samples.clamp(128, 2 * REPLICATES * MOST_POINTS).next_power_of_two()
    }

    /// How many coordinates the points have.
    pub fn coordinates(&self) -> usize {
        self.coordinates
    }

    /// The seed.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// How many points are evaluated in all.
    pub fn len(&self) -> usize {
        REPLICATES * self.points * self.group()
    }

    /// Whether there are none; never.
    pub fn is_empty(&self) -> bool {
        false
    }

    /// How many of them are samples.
    pub fn samples(&self) -> usize {
        2 * REPLICATES * self.points
    }

    /// So many points belong together: one of A, one of B, those of AB_i.
    pub fn group(&self) -> usize {
        if self.coordinates > 1 { self.coordinates + 2 } else { 2 }
    }

    /// Whether a point is a sample: of A or of B.
    pub fn is_sample(&self, k: usize) -> bool {
        k % self.group() < 2
    }

    /// The replicate of a point.
    pub fn replicate(&self, k: usize) -> usize {
        k / (self.group() * self.points)
    }

    /// The coordinates of a point, each above 0 and below 1.
    pub fn at(&self, k: usize) -> Vec<f64> {
        let (group, part) = (k / self.group(), k % self.group());
        let (replicate, number) = (group / self.points, group % self.points);
        let d = self.coordinates;
        let coordinate = |i: usize| {
            let is_of_b = part == 1 || part == i + 2;
            let c = if is_of_b { d + i } else { i };
            let sobol = sobol_rev((number as u32).reverse_bits(), c as u32);
            let bits = owen_scramble_rev(sobol, self.scrambles[replicate * 2 * d + c]).reverse_bits();
            // In the middle of its cell of 2^-32.
            (f64::from(bits) + 0.5) / 4_294_967_296.0
        };
        (0..d).map(coordinate).collect()
    }

    /// The distribution of values, one of each point; of NaN there is no value. Quantiles are those of Hazen (1914),
    /// between the k-th value at (k − 1/2)/n. None where there are too few values.
    pub fn statistics(&self, values: &[f64]) -> Option<Statistics> {
        let mut parts: Vec<Vec<f64>> = vec![vec![]; REPLICATES];
        for (k, value) in values.iter().enumerate() {
            if self.is_sample(k) && !value.is_nan() {
                parts[self.replicate(k)].push(*value);
            }
        }
        parts.iter_mut().for_each(|p| p.sort_by(f64::total_cmp));
        if parts.iter().any(|p| p.len() < FEWEST_VALUES) {
            return None;
        }
        let mut all = parts.concat();
        all.sort_by(f64::total_cmp);
        let of_mean = parts.iter().map(|p| mean(p));
        let error = |p: f64| half_width(parts.iter().map(|part| quantile(part, p)));
        let (least, most, center) = (all[0], all[all.len() - 1], mean(&all));
        let variance = all.iter().map(|v| (v - center) * (v - center)).sum::<f64>() / all.len() as f64;
        Some(Statistics {
            answered: all.len(),
            mean: center,
            standard_deviation: variance.sqrt(),
            median: quantile(&all, 0.5),
            p025: quantile(&all, 0.025),
            p05: quantile(&all, 0.05),
            p95: quantile(&all, 0.95),
            p975: quantile(&all, 0.975),
            least,
            most,
            sampling_error: SamplingError {
                mean: half_width(of_mean),
                median: error(0.5),
                p025: error(0.025),
                p05: error(0.05),
                p95: error(0.95),
                p975: error(0.975),
            },
        })
    }

    /// First-order and total Sobol indices of every coordinate; a NaN leaves its group of points out. None with a single
    /// coordinate, where values do not vary, or where there are too few.
    ///
    /// # Formula
    /// ```text
    /// S_i = 1 − Σ (f(B) − f(AB_i))² / Σ (f(A) − f(B))²
    /// T_i = Σ (f(A) − f(AB_i))² / Σ (f(A) − f(B))²
    /// ```
    /// the numerators of Jansen (1999) on the points of Saltelli et al. (2010). For the variance stands half the mean
    /// square of f(A) − f(B) (compare Azzini, Mara and Rosati, 2021): what A and B have in common by chance is in both
    /// sums, so that a quantity that does nothing has exactly 0, and one that does everything exactly 1. Errors are those
    /// of a jackknife that leaves out one replicate after the other.
    pub fn indices(&self, values: &[f64]) -> Option<Vec<SobolIndices>> {
        let d = self.coordinates;
        if d < 2 {
            return None;
        }
        // Of every replicate: number, sums of squared differences A − B, B − AB_i, A − AB_i.
        let mut sums = vec![vec![0.0; 2 + 2 * d]; REPLICATES];
        let mut size: f64 = 0.0;
        for (group, y) in values.chunks_exact(d + 2).enumerate() {
            if y.iter().any(|v| v.is_nan()) {
                continue;
            }
            let own = &mut sums[group / self.points];
            let square = |a: f64, b: f64| (a - b) * (a - b);
            size = size.max(y[0].abs()).max(y[1].abs());
            own[0] += 1.0;
            own[1] += square(y[0], y[1]);
            for i in 0..d {
                own[2 + i] += square(y[1], y[2 + i]);
                own[2 + d + i] += square(y[0], y[2 + i]);
            }
        }
        if sums.iter().any(|s| s[0] < FEWEST_VALUES as f64) {
            return None;
        }
        let estimate = |without: Option<usize>| -> Option<Vec<(f64, f64)>> {
            let mut all = vec![0.0; 2 + 2 * d];
            for (_, own) in sums.iter().enumerate().filter(|(r, _)| Some(*r) != without) {
                all.iter_mut().zip(own).for_each(|(a, x)| *a += x);
            }
            // What rounding leaves of a constant is no variance.
            (all[1] > 1e-22 * all[0] * size * size)
                .then(|| (0..d).map(|i| (1.0 - all[2 + i] / all[1], all[2 + d + i] / all[1])).collect())
        };
        let all = estimate(None)?;
        let without: Vec<_> = (0..REPLICATES).map(|r| estimate(Some(r))).collect::<Option<_>>()?;
        // Deleted groups: the standard error is (R − 1)/√R times the scatter of what is left.
        let scatter = |i: usize, of: fn(&(f64, f64)) -> f64| {
            half_width(without.iter().map(|w| of(&w[i]))) * (REPLICATES - 1) as f64
        };
        let index = |i: usize| SobolIndices {
            first: all[i].0,
            first_error: scatter(i, |e| e.0),
            total: all[i].1,
            total_error: scatter(i, |e| e.1),
        };
        Some((0..d).map(index).collect())
    }
}

fn mean(values: &[f64]) -> f64 {
    // About the first: means of equal numbers are that number.
    let first = values[0];
    first + values.iter().map(|v| v - first).sum::<f64>() / values.len() as f64
}

/// Of sorted values.
pub(crate) fn quantile(sorted: &[f64], p: f64) -> f64 {
    let place = (p * sorted.len() as f64 - 0.5).clamp(0.0, (sorted.len() - 1) as f64);
    let k = place as usize;
    let next = sorted[(k + 1).min(sorted.len() - 1)];
    sorted[k] + (place - k as f64) * (next - sorted[k])
}

/// `t s/√R` of a statistic over the replicates.
fn half_width(of_replicates: impl Iterator<Item = f64>) -> f64 {
    let all: Vec<f64> = of_replicates.collect();
    let center = mean(&all);
    let variance = all.iter().map(|v| (v - center) * (v - center)).sum::<f64>() / (all.len() - 1) as f64;
    STUDENT * (variance / all.len() as f64).sqrt()
}
