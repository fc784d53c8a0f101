//! Radau IIA of fifth order.

use std::ops::{Div, Mul, Sub};

use nalgebra::Complex;

use super::{Attempt, Smooth, Stepper, Track};

/// Nodes `(4 ∓ √6)/10` of the stages 1 and 2; the third stands at the end.
const C: [f64; 2] = [0.1550510257216822, 0.6449489742783178];
/// Weights of the stages.
const A: [[f64; 3]; 3] = [
    [0.1968154772236604, -0.06553542585019839, 0.02377097434822015],
    [0.3944243147390873, 0.2920734116652285, -0.04154875212599793],
    [0.37640306270046725, 0.5124858261884216, 1.0 / 9.0],
];
/// The real eigenvalue of A⁻¹, and the complex one `ALPHA + i BETA`.
const GAMMA: f64 = 3.637834252744496;
const ALPHA: f64 = 2.6810828736277523;
const BETA: f64 = 3.0504301992474105;
/// `A⁻¹ T = T diag(γ, [α −β; β α])`.
const T: [[f64; 3]; 3] = [
    [0.09443876248897524, -0.1412552950209542, -0.030029194105147424],
    [0.2502131229653333, 0.20412935229379994, 0.3829421127572619],
    [1.0, 1.0, 0.0],
];
const T_INVERSE: [[f64; 3]; 3] = [
    [4.178718591551905, 0.32768282076106237, 0.5233764454994495],
    [-4.178718591551905, -0.32768282076106237, 0.47662355450055044],
    [-0.5028726349457868, 2.571926949855605, -0.5960392048282249],
];
/// Of the error estimate: `−(13 ± 7√6)/3`, `−1/3`.
const E: [f64; 3] = [-10.048809399827416, 1.382142733160749, -1.0 / 3.0];

/// Most Newton iterations in a step.
const ITERATIONS: usize = 7;
/// Of the step control: what is aimed at of the step that would just do, and how fast a step changes.
const SAFETY: f64 = 0.9;
const SHRINK: f64 = 0.2;
const GROW: f64 = 8.0;

/// Radau IIA with three stages: fifth order, stiffly accurate, L-stable (Hairer, Wanner II, section
/// IV.5 and IV.8): simplified Newton iteration on one real and one complex system, error estimate
/// of third order, the collocation polynomial as dense output, predictive step control.
///
/// The Jacobian comes from forward differences and stays while the iteration converges well.
/// Quadratures follow from the rates in the stages, with the order of the method.
#[derive(Clone, Debug)]
pub(crate) struct Implicit {
    track: Track,
    /// Stages less the old state, and transformed by T⁻¹.
    z: [Vec<f64>; 3],
    w: [Vec<f64>; 3],
    /// Rates in the stages, then corrections of `w`.
    f: [Vec<f64>; 3],
    complex: Vec<Complex<f64>>,
    work: Vec<f64>,
    error: Vec<f64>,
    /// State at the end of the step.
    new: Vec<f64>,
    /// ∂rate/∂state, by rows, and the time at which it was taken.
    jacobian: Vec<f64>,
    jacobian_at: Option<f64>,
    real_lu: Lu<f64>,
    complex_lu: Lu<Complex<f64>>,
    /// Step for which the matrices are factored; zero when they are not.
    factored: f64,
    /// Dense output over θ: the old state and `θ(c0 + (θ−c₁)(c1 + (θ−c₂) c2))`.
    dense: [Vec<f64>; 3],
    span: f64,
    /// Whether the dense output belongs to the step before this one.
    follows: bool,
    /// Step and error of the step before.
    before: Option<[f64; 2]>,
    /// θ/(1−θ) of the Newton iterations before; θ is their rate of convergence.
    convergence: f64,
    theta: f64,
}

impl Implicit {
    fn differentiate<S: Smooth>(&mut self, sys: &mut S) {
        let Track { states: n, t, ref x, ref rate, ref mut counts, .. } = self.track;
        self.new.copy_from_slice(x);
        for j in 0..n {
            let size = x[j].abs().max(sys.scale(j)).max(1e-12);
            self.new[j] = x[j] + f64::EPSILON.sqrt() * size;
            let step = self.new[j] - x[j];
            sys.rate(t, &self.new, &mut self.work);
            for i in 0..n {
                self.jacobian[i * n + j] = (self.work[i] - rate[i]) / step;
            }
            self.new[j] = x[j];
        }
        counts.evaluations += n;
        self.jacobian_at = Some(t);
        self.factored = 0.0;
    }

    /// Factors `γ/h − J` and `(α + iβ)/h − J`; whether they are regular.
    fn factor(&mut self, h: f64) -> bool {
        let n = self.track.states;
        for ((r, c), j) in self.real_lu.entries.iter_mut().zip(&mut self.complex_lu.entries).zip(&self.jacobian) {
            (*r, *c) = (-j, Complex::new(-j, 0.0));
        }
        for i in 0..n {
            self.real_lu.entries[i * n + i] += GAMMA / h;
            self.complex_lu.entries[i * n + i] += Complex::new(ALPHA / h, BETA / h);
        }
        let regular = self.real_lu.factor() && self.complex_lu.factor();
        self.factored = if regular { h } else { 0.0 };
        regular
    }

    /// First guess of the stages: the polynomial of the last step goes on, where there is one.
    fn guess(&mut self, h: f64) {
        let n = self.track.states;
        if !self.follows {
            self.z.iter_mut().chain(&mut self.w).for_each(|v| v[..n].fill(0.0));
            return;
        }
        let ratio = h / self.span;
        let [c0, c1, c2] = &self.dense;
        for i in 0..n {
            let at = |theta: f64| theta * (c0[i] + (theta - C[0]) * (c1[i] + (theta - C[1]) * c2[i]));
            let end = at(1.0);
            let z = [C[0], C[1], 1.0].map(|c| at(1.0 + c * ratio) - end);
            for s in 0..3 {
                self.z[s][i] = z[s];
                self.w[s][i] = dot3(T_INVERSE[s], z);
            }
        }
    }

    /// Rates in the stages.
    fn stages<S: Smooth>(&mut self, sys: &mut S, h: f64, which: std::ops::Range<usize>) {
        let Track { states: n, t, ref x, ref mut counts, .. } = self.track;
        for s in which.clone() {
            for i in 0..n {
                self.new[i] = x[i] + self.z[s][i];
            }
            let c = if s < 2 { C[s] } else { 1.0 };
            sys.rate(t + c * h, &self.new, &mut self.f[s]);
        }
        counts.evaluations += which.len();
    }

    /// Solves for the stages. The iterations it took, or why the step is rejected.
    fn newton<S: Smooth>(&mut self, sys: &mut S, h: f64) -> Result<usize, Attempt> {
        let fails = |factor| Err(Attempt::Rejected { factor, finite: true });
        let n = self.track.states;
        let tolerance = self.track.tolerance;
        let enough = (10.0 * f64::EPSILON / tolerance).max(tolerance.cbrt().min(0.03));
        let (mut last, mut last_ratio) = (0.0, 0.0);
        self.convergence = self.convergence.max(f64::EPSILON).powf(0.8).max(1e-3);
        self.theta = 1e-3;
        self.guess(h);
        self.new.copy_from_slice(&self.track.x);
        for iteration in 1..=ITERATIONS {
            self.stages(sys, h, 0..3);
            let [f1, f2, f3] = &mut self.f;
            for i in 0..n {
                let f = [f1[i], f2[i], f3[i]];
                let w = [self.w[0][i], self.w[1][i], self.w[2][i]];
                f1[i] = dot3(T_INVERSE[0], f) - GAMMA / h * w[0];
                self.complex[i] = Complex::new(
                    dot3(T_INVERSE[1], f) - (ALPHA * w[1] - BETA * w[2]) / h,
                    dot3(T_INVERSE[2], f) - (ALPHA * w[2] + BETA * w[1]) / h,
                );
            }
            self.real_lu.solve(&mut f1[..n]);
            self.complex_lu.solve(&mut self.complex);
            let mut sum = 0.0;
            for i in 0..n {
                let weight = self.track.weight(sys, i);
                sum += (f1[i] / weight).powi(2) + self.complex[i].norm_sqr() / (weight * weight);
            }
            let size = (sum / (3 * n.max(1)) as f64).sqrt();
            if !size.is_finite() {
                return Err(Attempt::Rejected { factor: 0.25, finite: false });
            }
            if iteration > 1 {
                let ratio = size / last;
                self.theta = if iteration == 2 { ratio } else { f64::sqrt(ratio * last_ratio) };
                last_ratio = ratio;
                if self.theta >= 0.99 {
                    return fails(0.5);
                }
                self.convergence = self.theta / (1.0 - self.theta);
                let left = ITERATIONS - iteration;
                let expected = self.convergence * size * self.theta.powi(left as i32) / enough;
                if expected >= 1.0 {
                    return fails(0.8 * expected.clamp(1e-4, 20.0).powf(-1.0 / (4 + left) as f64));
                }
            }
            last = size.max(f64::EPSILON);
            for i in 0..n {
                self.w[0][i] += f1[i];
                self.w[1][i] += self.complex[i].re;
                self.w[2][i] += self.complex[i].im;
                let w = [self.w[0][i], self.w[1][i], self.w[2][i]];
                for s in 0..3 {
                    self.z[s][i] = dot3(T[s], w);
                }
            }
            if self.convergence * size <= enough {
                return Ok(iteration);
            }
        }
        fails(0.5)
    }

    /// Error of the step in multiples of the tolerance. `again`: filter once more where it is large.
    fn estimate<S: Smooth>(&mut self, sys: &mut S, h: f64, again: bool) -> f64 {
        let n = self.track.states;
        for i in 0..n {
            self.work[i] = dot3(E, [self.z[0][i], self.z[1][i], self.z[2][i]]) / h;
            self.error[i] = self.track.rate[i] + self.work[i];
        }
        self.real_lu.solve(&mut self.error);
        let first = self.norm(sys);
        if first < 1.0 || !again || first.is_nan() {
            return first;
        }
        for i in 0..n {
            self.new[i] = self.track.x[i] + self.error[i];
        }
        sys.rate(self.track.t, &self.new, &mut self.f[0]);
        self.track.counts.evaluations += 1;
        for i in 0..n {
            self.error[i] = self.f[0][i] + self.work[i];
        }
        self.real_lu.solve(&mut self.error);
        self.norm(sys)
    }

    fn norm<S: Smooth>(&self, sys: &S) -> f64 {
        let Track { states: n, tolerance, ref x, .. } = self.track;
        let mut sum = 0.0;
        for i in 0..n {
            let size = x[i].abs().max((x[i] + self.z[2][i]).abs()) + sys.scale(i);
            sum += (self.error[i] / (tolerance * size)).powi(2);
        }
        (sum / n.max(1) as f64).sqrt()
    }

    /// New state, quadratures and rate at the end of the step; whether they are finite.
    fn finish<S: Smooth>(&mut self, sys: &mut S, h: f64) -> bool {
        let (n, all) = (self.track.states, self.track.x.len());
        // The rates of the last iteration belong to the stages before its correction.
        if all > n {
            self.stages(sys, h, 0..2);
        }
        self.stages(sys, h, 2..3);
        for i in n..all {
            let f = [self.f[0][i], self.f[1][i], self.f[2][i]];
            for s in 0..3 {
                self.z[s][i] = h * dot3(A[s], f);
            }
            self.new[i] = self.track.x[i] + self.z[2][i];
        }
        self.new.iter().chain(&self.f[2]).all(|v| v.is_finite())
    }

    fn prepare_dense(&mut self, h: f64) {
        let [c0, c1, c2] = &mut self.dense;
        let [z1, z2, z3] = &self.z;
        for i in 0..z1.len() {
            // Newton's divided differences through 0, c₁, c₂, 1.
            let [first, second, third] =
                [z1[i] / C[0], (z2[i] - z1[i]) / (C[1] - C[0]), (z3[i] - z2[i]) / (1.0 - C[1])];
            let [early, late] = [(second - first) / C[1], (third - second) / (1.0 - C[0])];
            (c0[i], c1[i], c2[i]) = (first, early, late - early);
        }
        self.span = h;
    }
}

impl Stepper for Implicit {
    fn new(states: usize, quadratures: usize) -> Self {
        let zero = || vec![0.0; states + quadratures];
        let three = || std::array::from_fn(|_| zero());
        Self {
            track: Track::new(states, quadratures),
            z: three(),
            w: three(),
            f: three(),
            complex: vec![Complex::default(); states],
            work: zero(),
            error: vec![0.0; states],
            new: zero(),
            jacobian: vec![0.0; states * states],
            jacobian_at: None,
            real_lu: Lu::new(states),
            complex_lu: Lu::new(states),
            factored: 0.0,
            dense: three(),
            span: 0.0,
            follows: false,
            before: None,
            convergence: 1.0,
            theta: 0.0,
        }
    }

    fn restart<S: Smooth>(&mut self, sys: &mut S, t: f64, x: &[f64], tolerance: f64, t_end: f64, first: Option<f64>) {
        let work = [&mut self.new[..], &mut self.work[..]];
        self.track.restart(sys, t, x, tolerance, t_end, first, 4, work);
        self.dense.iter_mut().for_each(|c| c.fill(0.0));
        (self.jacobian_at, self.follows, self.before, self.convergence) = (None, false, None, 1.0);
    }

    fn attempt<S: Smooth>(&mut self, sys: &mut S, h: f64, again: bool) -> Attempt {
        let iterations = loop {
            if self.jacobian_at.is_none() {
                self.differentiate(sys);
            }
            let fresh = self.jacobian_at == Some(self.track.t);
            let solved = match self.factored == h || self.factor(h) {
                true => self.newton(sys, h),
                false => Err(Attempt::Rejected { factor: 0.5, finite: true }),
            };
            match solved {
                Ok(iterations) => break iterations,
                Err(_) if !fresh => self.jacobian_at = None,
                Err(rejected) => return rejected,
            }
        };
        let error = self.estimate(sys, h, again || self.before.is_none());
        let most = (2 * ITERATIONS) as f64;
        let safety = SAFETY.min(SAFETY * (1.0 + most) / (iterations as f64 + most));
        let usual = safety / error.max(1e-10).powf(0.25);
        if error < 1.0 && self.finish(sys, h) {
            return Attempt::Taken { factor: self.control(h, error, usual.clamp(SHRINK, GROW)) };
        }
        let finite = error.is_finite() && error >= 1.0;
        Attempt::Rejected { factor: if finite { usual.max(SHRINK) } else { 0.25 }, finite }
    }

    fn accept(&mut self, h: f64, t_end: f64) {
        self.prepare_dense(h);
        self.track.accept(h, t_end, &mut self.new, Some(&mut self.f[2]));
        self.follows = true;
        if self.theta > 1e-3 {
            self.jacobian_at = None;
        }
    }

    fn track(&self) -> &Track {
        &self.track
    }

    fn track_mut(&mut self) -> &mut Track {
        &mut self.track
    }

    #[inline]
    fn interpolate_component(&self, t: f64, k: usize) -> f64 {
        let Track { t_old, t: end, ref x_old, ref x, .. } = self.track;
        if t <= t_old {
            return x_old[k];
        }
        if t >= end {
            return x[k];
        }
        let theta = (t - t_old) / self.span;
        let [c0, c1, c2] = &self.dense;
        x_old[k] + theta * (c0[k] + (theta - C[0]) * (c1[k] + (theta - C[1]) * c2[k]))
    }

    fn shorten<S: Smooth>(&mut self, sys: &mut S, t: f64) {
        if t >= self.track.t {
            return;
        }
        let t_old = self.track.t_old;
        let h = (t - t_old).max(0.0);
        // Quadratures over the part that stays, along the polynomial.
        for (s, c) in [C[0], C[1], 1.0].into_iter().enumerate() {
            self.interpolate_into(t_old + c * h);
            sys.rate(t_old + c * h, &self.new, &mut self.f[s]);
        }
        for k in self.track.states..self.track.x.len() {
            self.new[k] = self.track.x_old[k] + h * dot3(A[2], [self.f[0][k], self.f[1][k], self.f[2][k]]);
        }
        self.track.counts.evaluations += 3;
        self.track.x.copy_from_slice(&self.new);
        self.track.rate.copy_from_slice(&self.f[2]);
        self.track.t = t.max(t_old);
        self.follows = false;
        self.jacobian_at = None;
    }
}

impl Implicit {
    fn interpolate_into(&mut self, t: f64) {
        for k in 0..self.new.len() {
            self.new[k] = self.interpolate_component(t, k);
        }
    }

    /// How much longer the next step may be; `factor` is what the error of this step alone asks for.
    fn control(&mut self, h: f64, error: f64, mut factor: f64) -> f64 {
        if let Some([span, before]) = self.before {
            // Gustafsson's predictive controller: the error goes on as it changed.
            let predicted = SAFETY * h / span * (before / error.powi(2).max(1e-20)).powf(0.25);
            factor = factor.min(predicted.clamp(SHRINK, GROW));
        }
        self.before = Some([h, error.max(1e-2)]);
        // Another step length costs a factorization.
        if self.theta <= 1e-3 && (1.0..=1.2).contains(&factor) { 1.0 } else { factor }
    }
}

fn dot3(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// What a matrix to factor consists of.
trait Number: Copy + Default + Mul<Output = Self> + Sub<Output = Self> + Div<Output = Self> {
    fn size(self) -> f64;
}

impl Number for f64 {
    fn size(self) -> f64 {
        self.abs()
    }
}

impl Number for Complex<f64> {
    fn size(self) -> f64 {
        self.re.abs() + self.im.abs()
    }
}

/// LU factors with row pivoting, in memory that stays.
#[derive(Clone, Debug)]
struct Lu<N> {
    /// By rows.
    entries: Vec<N>,
    pivots: Vec<usize>,
}

impl<N: Number> Lu<N> {
    fn new(size: usize) -> Self {
        Self { entries: vec![N::default(); size * size], pivots: vec![0; size] }
    }

    /// Factors the entries in place; whether they are regular.
    fn factor(&mut self) -> bool {
        let n = self.pivots.len();
        let a = &mut self.entries;
        for k in 0..n {
            let mut pivot = k;
            for i in k + 1..n {
                if a[i * n + k].size() > a[pivot * n + k].size() {
                    pivot = i;
                }
            }
            self.pivots[k] = pivot;
            if a[pivot * n + k].size() == 0.0 {
                return false;
            }
            if pivot != k {
                for j in 0..n {
                    a.swap(k * n + j, pivot * n + j);
                }
            }
            let (upper, lower) = a.split_at_mut((k + 1) * n);
            let head = &upper[k * n..];
            for row in lower.chunks_exact_mut(n) {
                let factor = row[k] / head[k];
                row[k] = factor;
                for j in k + 1..n {
                    row[j] = row[j] - factor * head[j];
                }
            }
        }
        true
    }

    /// Solves for a right-hand side, in place.
    fn solve(&self, b: &mut [N]) {
        let n = self.pivots.len();
        for k in 0..n {
            b.swap(k, self.pivots[k]);
        }
        for i in 0..n {
            let row = &self.entries[i * n..(i + 1) * n];
            let mut sum = b[i];
            for j in 0..i {
                sum = sum - row[j] * b[j];
            }
            b[i] = sum;
        }
        for i in (0..n).rev() {
            let row = &self.entries[i * n..(i + 1) * n];
            let mut sum = b[i];
            for j in i + 1..n {
                sum = sum - row[j] * b[j];
            }
            b[i] = sum / row[i];
        }
    }
}
