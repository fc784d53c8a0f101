//! Parameters from measurements: the estimate with its covariance, what was learnt and what is only prior, residuals,
//! and which measurement would teach most.
//!
//! `y_i = f_i(z) + noise σ_i`, prior `z ~ N(m, diag(s²))`. The estimate is the smallest
//!
//! ```text
//! F(z) = Σ ρ(r_i) + ½ Σ ((z_k − m_k)/s_k)²,   r_i = (y_i − f_i(z))/σ_i
//! ```
//!
//! with `ρ = r²/2`, or for outliers `ρ = (ν + 1)/2 ln(1 + r²/ν)` of Student's t with ν = 4: a reading weighs
//! `w = (ν + 1)/(ν + r²)`. Damped Gauss-Newton steps; in the linear case without outliers the first one is the answer.
//!
//! Where the residuals are larger than `σ` says, by more than chance, the noise is taken as `s σ` with the `s` that makes
//! `Σ w(r/s) (r/s)²` what it is for normal readings (Huber's second proposal), and the estimate is found again. So the data
//! weigh less and the prior does not: no parameter is known less than before.
//!
//! Sources: A. Tarantola, Inverse Problem Theory (2005), ch. 3; K. L. Lange, R. J. A. Little, J. M. G. Taylor, J. Am.
//! Stat. Assoc. 84 (1989) 881; P. J. Huber, Robust Statistics (1981), section 6.4, for the scale; D. V. Lindley, Ann.
//! Math. Stat. 27 (1956) 986, and V. V. Fedorov, Theory of Optimal Experiments (1972), for the next measurement.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// Degrees of freedom of Student's t.
const NU: f64 = 4.0;
/// `E[ψ′]²/E[ψ²]` over the mean weight of normal readings, with `ψ = w r`: variances of the estimate are the inverse.
const EFFICIENCY: f64 = 0.878_907_879_121_446_6;
/// `E[w r²]` of normal readings: 5 − 20 E[1/(4 + r²)].
const WEIGHTED_SQUARE: f64 = 0.786_307_707_119;
/// Standard deviations beyond which a reading is none of the others.
pub(super) const FAR: f64 = 5.0;
/// Most rounds of estimate and scale, and the change of the scale below which it is found.
const SCALE: (usize, f64) = (20, 1e-3);
/// Most steps.
const MOST_STEPS: usize = 60;
/// Gradient over its size at which the estimate is found.
const ACCURACY: f64 = 1e-10;

/// What is measured, as a function of the parameters.
pub trait Prediction {
    /// Why there is none.
    type Error;

    /// Value of each measurement and its derivatives by the parameters.
    ///
    /// # Errors
    /// There is no prediction for these parameters.
    fn predict(&self, z: &[f64]) -> Result<Vec<(f64, Vec<f64>)>, Self::Error>;
}

impl<E, F: Fn(&[f64]) -> Result<Vec<(f64, Vec<f64>)>, E>> Prediction for F {
    type Error = E;

    fn predict(&self, z: &[f64]) -> Result<Vec<(f64, Vec<f64>)>, E> {
        self(z)
    }
}

/// Measurements and what is known before them.
#[derive(Clone, Debug, PartialEq)]
pub struct Evidence<'a> {
    /// Measured values.
    pub measured: &'a [f64],
    /// Standard deviation of each.
    pub sigma: &'a [f64],
    /// Prior mean of each parameter.
    pub mean: &'a [f64],
    /// Prior standard deviation of each.
    pub prior: &'a [f64],
    /// Whether outliers are expected.
    pub robust: bool,
    /// Parameters stay within so much of their mean.
    pub bound: f64,
}

/// A combination of parameters, and how much the measurements tell of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Direction {
    /// Eigenvalue of the information, in units of the prior: above 1 the measurements tell more than the prior.
    pub information: f64,
    /// Change of each parameter over its prior standard deviation; the squares add to 1.
    pub whitened: Vec<f64>,
}

/// Parameters from measurements.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// The parameters.
    pub z: Vec<f64>,
    /// Their covariance.
    pub covariance: Vec<Vec<f64>>,
    /// `(J' W J/s² + S⁻²)⁻¹` with the weights as they are.
    fit: Vec<Vec<f64>>,
    /// Value of each measurement for them, with derivatives.
    pub predicted: Vec<(f64, Vec<f64>)>,
    /// Measured less predicted, over the standard deviation as it was stated.
    pub residuals: Vec<f64>,
    /// Weight of each measurement: 1 without outliers, else from 0 to 1.25.
    pub weights: Vec<f64>,
    /// Share of each measurement in its own prediction.
    pub leverage: Vec<f64>,
    /// Square of the scale of the residuals over what was stated, from the measurements that parameters do not use up: 1 is
    /// expected. Outliers have little say.
    pub misfit: f64,
    /// Factor on the variance of the noise where the misfit is more than chance (above the 95 % point of its distribution);
    /// else 1.
    pub inflation: f64,
    /// Combinations of parameters, the best known first.
    pub directions: Vec<Direction>,
    /// Whether the smallest sum of squares was found, and the scale of the noise, where that was looked for, has settled.
    pub converged: bool,
    /// Parameters at their bound.
    pub at_bound: Vec<usize>,
}

impl Estimate {
    /// Combinations of which the measurements tell more than the prior.
    pub fn learnt(&self) -> usize {
        self.directions.iter().filter(|d| d.information > 1.0).count()
    }

    /// Variance of a prediction with these derivatives.
    pub fn variance(&self, derivatives: &[f64]) -> f64 {
        quadratic(&self.covariance, derivatives, derivatives)
    }

    /// By how much a measurement with these derivatives and this standard deviation, as those were stated, would lower the logarithm of the
    /// volume of what is possible: `ln(1 + j C j/σ²)`.
    pub fn gain(&self, derivatives: &[f64], sigma: f64) -> f64 {
        (1.0 + self.variance(derivatives) / (self.inflation * sigma * sigma)).ln()
    }

    /// By how much it would lower the sum of the variances of predictions: `Σ (j_o C j)²/(σ² + j C j)`.
    pub fn gain_for(&self, derivatives: &[f64], sigma: f64, wanted: &[Vec<f64>]) -> f64 {
        let own = self.inflation * sigma * sigma + self.variance(derivatives);
        wanted.iter().map(|o| quadratic(&self.covariance, o, derivatives).powi(2)).sum::<f64>() / own
    }

    /// Residual of each measurement from a fit without it, over its stated standard deviation, and the standard deviation
    /// of that: `r/(1 − h)`, `s/√(1 − h)`. Exact in the linear case.
    pub fn left_out(&self) -> Vec<(f64, f64)> {
        let all = self.residuals.iter().zip(&self.leverage);
        all.map(|(r, h)| (r / (1.0 - h), (self.inflation / (1.0 - h)).sqrt())).collect()
    }

    /// Residuals of the measurements of a group (their positions) from a fit without the whole group, over the standard deviations
    /// `sigma` of all measurements as stated: `(1 − H_GG)⁻¹ r_G`. Exact in the linear case with the weights as they are.
    pub fn left_out_together(&self, group: &[usize], sigma: &[f64]) -> Vec<f64> {
        let n = group.len();
        let root = |i: usize| (self.weights[i] / self.inflation).sqrt() / sigma[i];
        let hat = DMatrix::from_fn(n, n, |a, b| {
            let (i, j) = (group[a], group[b]);
            let between = quadratic(&self.fit, &self.predicted[i].1, &self.predicted[j].1);
            f64::from(u8::from(a == b)) - root(i) * root(j) * between
        });
        let own = DVector::from_fn(n, |a, _| self.weights[group[a]].sqrt() * self.residuals[group[a]]);
        let found = hat.lu().solve(&own).unwrap_or(own);
        group.iter().zip(found.iter()).map(|(i, r)| r / self.weights[*i].sqrt().max(1e-12)).collect()
    }
}

fn quadratic(c: &[Vec<f64>], a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(c).map(|(x, row)| x * row.iter().zip(b).map(|(c, y)| c * y).sum::<f64>()).sum()
}

/// Weight of a residual.
fn weight(r: f64, robust: bool) -> f64 {
    if robust { (NU + 1.0) / (NU + r * r) } else { 1.0 }
}

/// Square of the scale of residuals, of so many that parameters do not use up: 1 for what was stated.
fn scale(residuals: &[f64], free: f64, robust: bool) -> f64 {
    if !robust {
        return residuals.iter().map(|r| r * r).sum::<f64>() / free;
    }
    // Five times the scale of the middle half is no noise: among few readings one such would make the scale its own.
    let far = FAR * deviation(residuals);
    let kept: Vec<f64> = residuals.iter().copied().filter(|r| r.abs() <= far).collect();
    let wanted = WEIGHTED_SQUARE * (free - (residuals.len() - kept.len()) as f64).max(0.5);
    let sum = |s2: f64| kept.iter().map(|r| r * r / s2).map(|x| weight(x.sqrt(), true) * x).sum::<f64>();
    // It falls as the scale grows.
    let (mut low, mut high) = (1e-12f64, 1e12f64);
    for _ in 0..100 {
        let middle = (low * high).sqrt();
        if sum(middle) > wanted { low = middle } else { high = middle }
    }
    (low * high).sqrt()
}

/// Standard deviation of normal numbers around zero of which these are most, by their median amount.
pub(super) fn deviation(all: &[f64]) -> f64 {
    let mut amounts: Vec<f64> = all.iter().map(|r| r.abs()).collect();
    amounts.sort_by(f64::total_cmp);
    amounts.get(amounts.len() / 2).map_or(0.0, |m| m / 0.674_489_750_196_081_7)
}

/// The measure that is made small.
fn objective(residuals: &[f64], z: &[f64], e: &Evidence<'_>) -> f64 {
    let rho = |r: f64| if e.robust { 0.5 * (NU + 1.0) * (r * r / NU).ln_1p() } else { 0.5 * r * r };
    let prior = z.iter().zip(e.mean.iter().zip(e.prior)).map(|(z, (m, s))| 0.5 * ((z - m) / s).powi(2));
    residuals.iter().map(|r| rho(*r)).sum::<f64>() + prior.sum::<f64>()
}

/// The parameters that measurements and prior make most likely.
///
/// # Errors
/// As of the prediction at the prior mean.
///
/// # Example
/// One factor, measured once: prior 1 ± 0.5, a loss of 100 W that reads 120 ± 10 W. The two agree at
/// `1 + 0.2 · 0.5²/(0.5² + 0.1²)`.
/// ```
/// use willis::study::calibration::{Evidence, estimate};
///
/// let model = |z: &[f64]| Ok::<_, ()>(vec![(100.0 * z[0], vec![100.0])]);
/// let evidence = Evidence {
///     measured: &[120.0],
///     sigma: &[10.0],
///     mean: &[1.0],
///     prior: &[0.5],
///     robust: false,
///     bound: f64::INFINITY,
/// };
/// let found = estimate(&model, &evidence)?;
/// assert!((found.z[0] - (1.0 + 0.2 * 0.25 / 0.26)).abs() < 1e-12);
/// assert_eq!(found.learnt(), 1);
/// # Ok::<(), ()>(())
/// ```
pub fn estimate<P: Prediction>(model: &P, e: &Evidence<'_>) -> Result<Estimate, P::Error> {
    let as_stated = with_noise(model, e, 1.0)?;
    let free = e.measured.len() as f64 - as_stated.leverage.iter().sum::<f64>();
    if free < 1.0 || as_stated.misfit <= chance(free) {
        return Ok(as_stated);
    }
    let mut found = as_stated.clone();
    for _ in 0..SCALE.0 {
        let (last, next) = (found.inflation, found.misfit);
        if (next / last - 1.0).abs() < SCALE.1 {
            return Ok(found);
        }
        // A scale below what was stated is none: the noise was not to blame.
        if next <= 1.0 {
            return Ok(as_stated);
        }
        found = with_noise(model, e, next)?;
    }
    found.converged = false;
    Ok(found)
}

/// The estimate if the noise has so many times the variance that was stated.
fn with_noise<P: Prediction>(model: &P, stated: &Evidence<'_>, inflation: f64) -> Result<Estimate, P::Error> {
    let sigma: Vec<f64> = stated.sigma.iter().map(|s| s * inflation.sqrt()).collect();
    let e = &Evidence { sigma: &sigma, ..stated.clone() };
    let (n, m) = (e.measured.len(), e.mean.len());
    let residuals =
        |all: &[(f64, Vec<f64>)]| -> Vec<f64> { (0..n).map(|i| (e.measured[i] - all[i].0) / e.sigma[i]).collect() };
    let clip = |k: usize, z: f64| z.clamp(e.mean[k] - e.bound, e.mean[k] + e.bound);
    let mut z = e.mean.to_vec();
    let mut predicted = model.predict(&z)?;
    let mut r = residuals(&predicted);
    let mut value = objective(&r, &z, e);
    let (mut converged, mut damping) = (false, 0.0f64);
    for _ in 0..MOST_STEPS {
        let w: Vec<f64> = r.iter().map(|r| weight(*r, e.robust)).collect();
        let mut gradient = DVector::from_fn(m, |k, _| -(z[k] - e.mean[k]) / (e.prior[k] * e.prior[k]));
        let mut size = gradient.map(f64::abs);
        for i in 0..n {
            for k in 0..m {
                let part = w[i] * r[i] * predicted[i].1[k] / e.sigma[i];
                gradient[k] += part;
                size[k] += part.abs();
            }
        }
        // What a bound holds has no say.
        let held = |k: usize, z: &[f64]| {
            (z[k] >= e.mean[k] + e.bound && gradient[k] > 0.0) || (z[k] <= e.mean[k] - e.bound && gradient[k] < 0.0)
        };
        converged = (0..m).all(|k| held(k, &z) || gradient[k].abs() <= ACCURACY * size[k].max(1.0));
        if converged {
            break;
        }
        let mut precision = precision(&predicted, &w, e);
        for k in 0..m {
            precision[(k, k)] *= 1.0 + damping;
            if held(k, &z) {
                precision[(k, k)] *= 1e12;
            }
        }
        let Some(step) = precision.cholesky().map(|c| c.solve(&gradient)) else { break };
        let next: Vec<f64> = (0..m).map(|k| clip(k, z[k] + step[k])).collect();
        let tried = model.predict(&next).ok().map(|p| {
            let r = residuals(&p);
            (objective(&r, &next, e), p, r)
        });
        match tried {
            Some((new, p, new_r)) if new <= value + 1e-12 * value.abs().max(1.0) => {
                let still = next == z;
                (z, predicted, r) = (next, p, new_r);
                value = new;
                damping = if damping < 1e-6 { 0.0 } else { damping * 0.1 };
                if still {
                    converged = true;
                    break;
                }
            }
            _ if damping < 1e8 => damping = (damping * 10.0).max(1e-3),
            _ => break,
        }
    }
    let weights: Vec<f64> = r.iter().map(|r| weight(*r, e.robust)).collect();
    let plain = precision(&predicted, &weights, e);
    // Among normal readings a robust estimate is a little less sure than the weights say.
    let sure = if e.robust { EFFICIENCY } else { 1.0 };
    let counted: Vec<f64> = weights.iter().map(|w| w * sure).collect();
    let inverse = precision(&predicted, &counted, e).cholesky().map(|c| c.inverse());
    let inverse =
        inverse.unwrap_or_else(|| DMatrix::from_fn(m, m, |i, j| if i == j { e.prior[i].powi(2) } else { 0.0 }));
    let fit = plain.cholesky().map_or_else(|| inverse.clone(), |c| c.inverse());
    let of = |c: &DMatrix<f64>| -> Vec<Vec<f64>> { (0..m).map(|i| (0..m).map(|j| c[(i, j)]).collect()).collect() };
    let hat = of(&fit);
    let leverage: Vec<f64> = (0..n)
        .map(|i| weights[i] * quadratic(&hat, &predicted[i].1, &predicted[i].1) / (e.sigma[i] * e.sigma[i]))
        .map(|h| h.min(1.0 - 1e-12))
        .collect();
    let free = n as f64 - leverage.iter().sum::<f64>();
    let r: Vec<f64> = r.iter().map(|r| r * inflation.sqrt()).collect();
    let misfit = if free > 0.0 { scale(&r, free, e.robust) } else { 0.0 };
    let whitened = DMatrix::from_fn(m, m, |a, b| {
        let info: f64 = (0..n).map(|i| weights[i] * predicted[i].1[a] * predicted[i].1[b] / e.sigma[i].powi(2)).sum();
        e.prior[a] * info * e.prior[b]
    });
    let eigen = SymmetricEigen::new(whitened);
    let mut directions: Vec<Direction> = (0..m)
        .map(|k| Direction {
            information: eigen.eigenvalues[k].max(0.0),
            whitened: eigen.eigenvectors.column(k).iter().copied().collect(),
        })
        .collect();
    directions.sort_by(|a, b| b.information.total_cmp(&a.information));
    let at_bound = (0..m).filter(|&k| (z[k] - e.mean[k]).abs() >= e.bound).collect();
    Ok(Estimate {
        covariance: of(&inverse),
        fit: hat,
        z,
        predicted,
        residuals: r,
        weights,
        leverage,
        misfit,
        inflation,
        directions,
        converged,
        at_bound,
    })
}

/// `J' W J + S⁻²`.
fn precision(predicted: &[(f64, Vec<f64>)], w: &[f64], e: &Evidence<'_>) -> DMatrix<f64> {
    let m = e.mean.len();
    let mut all = DMatrix::from_fn(m, m, |i, j| if i == j { e.prior[i].powi(-2) } else { 0.0 });
    for (i, (_, j)) in predicted.iter().enumerate() {
        for a in 0..m {
            for b in 0..m {
                all[(a, b)] += w[i] * j[a] * j[b] / (e.sigma[i] * e.sigma[i]);
            }
        }
    }
    all
}

/// The 95 % point of χ² over its degrees of freedom, after Wilson and Hilferty 1931.
fn chance(freedom: f64) -> f64 {
    let v = 2.0 / (9.0 * freedom);
    (1.0 - v + 1.644_853_626_951_472_7 * v.sqrt()).powi(3)
}
