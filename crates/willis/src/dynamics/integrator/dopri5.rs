//! Dormand–Prince 5(4).

use super::{Attempt, Smooth, Stepper, Track};

/// Nodes of the stages 2 to 5; stages 6 and 7 stand at the end.
const C: [f64; 4] = [0.2, 0.3, 0.8, 8.0 / 9.0];
const A3: [f64; 2] = [3.0 / 40.0, 9.0 / 40.0];
const A4: [f64; 3] = [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0];
const A5: [f64; 4] = [19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0];
const A6: [f64; 5] = [9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0];
/// Weights of the stages 1 and 3 to 6.
const B: [f64; 5] = [35.0 / 384.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0];
/// Those less the weights of fourth order, of the stages 1 and 3 to 7.
const E: [f64; 6] = [71.0 / 57600.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339200.0, 22.0 / 525.0, -1.0 / 40.0];
/// The last coefficient of the dense output, of the stages 1 and 3 to 7.
const D: [f64; 6] = [
    -12715105075.0 / 11282082432.0,
    87487479700.0 / 32700410799.0,
    -10690763975.0 / 1880347072.0,
    701980252875.0 / 199316789632.0,
    -1453857185.0 / 822651844.0,
    69997945.0 / 29380423.0,
];

/// Explicit Runge–Kutta method of Dormand and Prince, fifth order with an error estimate of fourth,
/// dense output of fourth order (Hairer, Nørsett, Wanner I, sections II.5 and II.6), step control
/// by error and its last change (II.4, IV.2 with β = 0.04).
///
/// Quadratures use the same weights, and their errors count as those of states do.
#[derive(Clone, Debug)]
pub(crate) struct Dopri5 {
    track: Track,
    /// Stages 2 to 6; the first is the rate at the start.
    k: [Vec<f64>; 5],
    /// Rate at the end.
    last: Vec<f64>,
    /// State of a stage; of the sixth after a step.
    stage: Vec<f64>,
    /// State at the end.
    new: Vec<f64>,
    /// Dense output over θ: `c0 + θ(c1 + (1−θ)(c2 + θ(c3 + (1−θ) c4)))`, c0 the old state.
    dense: [Vec<f64>; 4],
    /// Length of the step that the dense output spans.
    span: f64,
    /// Error of the step before.
    error: f64,
    /// Steps that looked stiff, and that did not since then.
    stiff: usize,
    mild: usize,
}

impl Dopri5 {
    /// Whether many of the last steps were limited by stability and not by accuracy:
    /// `h |λ| > 3.25` in fifteen steps without six others in a row (Hairer, Wanner II, section IV.2).
    pub(crate) fn is_stiff(&self) -> bool {
        self.stiff >= 15
    }

    /// Counts whether a step was limited by stability; λ from the difference of the last two
    /// stages.
    fn watch_stiffness(&mut self, h: f64) {
        if self.is_stiff() {
            return;
        }
        let n = self.track.states;
        let (mut rates, mut states) = (0.0, 0.0);
        for i in 0..n {
            rates += (self.last[i] - self.k[4][i]).powi(2);
            states += (self.new[i] - self.stage[i]).powi(2);
        }
        if h * h * rates > 3.25 * 3.25 * states {
            self.stiff += 1;
            self.mild = 0;
        } else {
            self.mild += 1;
            if self.mild >= 6 {
                self.stiff = 0;
            }
        }
    }

    /// Stages, new state and rate there; the error in multiples of the tolerance.
    #[inline]
    fn try_step<S: Smooth>(&mut self, sys: &mut S, h: f64) -> f64 {
        let Track { states: n, tolerance, t, ref x, rate: ref k1, .. } = self.track;
        let all = x.len();
        let (x, k1) = (&x[..all], &k1[..all]);
        let [k2, k3, k4, k5, k6] = &mut self.k;
        let (k2, k3, k4, k5, k6) = (&mut k2[..all], &mut k3[..all], &mut k4[..all], &mut k5[..all], &mut k6[..all]);
        let (stage, new, last) = (&mut self.stage[..all], &mut self.new[..all], &mut self.last[..all]);
        for i in 0..n {
            stage[i] = x[i] + h * 0.2 * k1[i];
        }
        sys.rate(t + C[0] * h, stage, k2);
        for i in 0..n {
            stage[i] = x[i] + h * (A3[0] * k1[i] + A3[1] * k2[i]);
        }
        sys.rate(t + C[1] * h, stage, k3);
        for i in 0..n {
            stage[i] = x[i] + h * (A4[0] * k1[i] + A4[1] * k2[i] + A4[2] * k3[i]);
        }
        sys.rate(t + C[2] * h, stage, k4);
        for i in 0..n {
            stage[i] = x[i] + h * (A5[0] * k1[i] + A5[1] * k2[i] + A5[2] * k3[i] + A5[3] * k4[i]);
        }
        sys.rate(t + C[3] * h, stage, k5);
        for i in 0..n {
            stage[i] = x[i] + h * (A6[0] * k1[i] + A6[1] * k2[i] + A6[2] * k3[i] + A6[3] * k4[i] + A6[4] * k5[i]);
        }
        sys.rate(t + h, stage, k6);
        for i in 0..all {
            new[i] = x[i] + h * (B[0] * k1[i] + B[1] * k3[i] + B[2] * k4[i] + B[3] * k5[i] + B[4] * k6[i]);
        }
        sys.rate(t + h, new, last);
        self.track.counts.evaluations += 6;

        let mut sum = 0.0;
        for i in 0..n {
            let e = E[0] * k1[i] + E[1] * k3[i] + E[2] * k4[i] + E[3] * k5[i] + E[4] * k6[i] + E[5] * last[i];
            sum += (e / (x[i].abs().max(new[i].abs()) + sys.scale(i))).powi(2);
        }
        // The largest error of a quadrature; one that is not finite makes the error so, too.
        let (mut largest, mut finite) = (0.0f64, 0.0);
        for i in n..all {
            let e = E[0] * k1[i] + E[1] * k3[i] + E[2] * k4[i] + E[3] * k5[i] + E[4] * k6[i] + E[5] * last[i];
            largest = largest.max(e.abs() / (x[i].abs().max(new[i].abs()) + sys.scale(i)));
            finite += 0.0 * (new[i] + last[i]);
        }
        let states = (sum / n.max(1) as f64).sqrt();
        h / tolerance * if largest > states { largest } else { states } + finite
    }

    fn prepare_dense(&mut self, h: f64) {
        let Track { ref x_old, ref x, rate_old: ref k1, rate: ref k7, .. } = self.track;
        let all = x.len();
        let (x_old, x, k1, k7) = (&x_old[..all], &x[..all], &k1[..all], &k7[..all]);
        let [_, k3, k4, k5, k6] = &self.k;
        let (k3, k4, k5, k6) = (&k3[..all], &k4[..all], &k5[..all], &k6[..all]);
        let [c1, c2, c3, c4] = &mut self.dense;
        let (c1, c2, c3, c4) = (&mut c1[..all], &mut c2[..all], &mut c3[..all], &mut c4[..all]);
        for i in 0..all {
            c1[i] = x[i] - x_old[i];
            c2[i] = h * k1[i] - c1[i];
            c3[i] = c1[i] - h * k7[i] - c2[i];
            c4[i] = h * (D[0] * k1[i] + D[1] * k3[i] + D[2] * k4[i] + D[3] * k5[i] + D[4] * k6[i] + D[5] * k7[i]);
        }
        self.span = h;
    }
}

impl Stepper for Dopri5 {
    fn new(states: usize, quadratures: usize) -> Self {
        let zero = || vec![0.0; states + quadratures];
        Self {
            track: Track::new(states, quadratures),
            k: std::array::from_fn(|_| zero()),
            last: zero(),
            stage: zero(),
            new: zero(),
            dense: std::array::from_fn(|_| zero()),
            span: 0.0,
            error: 1e-4,
            stiff: 0,
            mild: 0,
        }
    }

    fn restart<S: Smooth>(&mut self, sys: &mut S, t: f64, x: &[f64], tolerance: f64, t_end: f64, first: Option<f64>) {
        let work = [&mut self.stage[..], &mut self.last[..]];
        self.track.restart(sys, t, x, tolerance, t_end, first, 5, work);
        self.stage.copy_from_slice(x);
        self.dense.iter_mut().for_each(|c| c.fill(0.0));
        (self.span, self.error, self.stiff, self.mild) = (0.0, 1e-4, 0, 0);
    }

    fn attempt<S: Smooth>(&mut self, sys: &mut S, h: f64, _: bool) -> Attempt {
        const SAFETY: f64 = 0.9;
        const BETA: f64 = 0.04;
        const EXPONENT: f64 = 0.2 - 0.75 * BETA;
        const SHRINK: f64 = 0.2;
        const GROW: f64 = 10.0;
        let error = self.try_step(sys, h);
        if error <= 1.0 {
            let now = error.powf(EXPONENT);
            let factor = (SAFETY * self.error.powf(BETA) / now).clamp(SHRINK, GROW);
            self.error = error.max(1e-4);
            return Attempt::Taken { factor };
        }
        let finite = error.is_finite();
        Attempt::Rejected { factor: if finite { (SAFETY / error.powf(EXPONENT)).max(SHRINK) } else { SHRINK }, finite }
    }

    fn accept(&mut self, h: f64, t_end: f64) {
        self.watch_stiffness(h);
        self.track.accept(h, t_end, &mut self.new, Some(&mut self.last));
        self.prepare_dense(h);
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
        let rest = 1.0 - theta;
        let [c1, c2, c3, c4] = &self.dense;
        x_old[k] + theta * (c1[k] + rest * (c2[k] + theta * (c3[k] + rest * c4[k])))
    }

    fn interpolate(&self, t: f64, out: &mut [f64]) {
        let Track { t_old, t: end, ref x_old, ref x, .. } = self.track;
        if t <= t_old || t >= end {
            out.copy_from_slice(if t <= t_old { x_old } else { x });
            return;
        }
        let theta = (t - t_old) / self.span;
        let rest = 1.0 - theta;
        let all = out.len();
        let [c1, c2, c3, c4] = self.dense.each_ref().map(|c| &c[..all]);
        for (k, x_old) in x_old[..all].iter().enumerate() {
            out[k] = x_old + theta * (c1[k] + rest * (c2[k] + theta * (c3[k] + rest * c4[k])));
        }
    }

    fn shorten<S: Smooth>(&mut self, sys: &mut S, t: f64) {
        if t >= self.track.t {
            return;
        }
        let h = (t - self.track.t_old).max(0.0);
        self.track.back();
        if h > 0.0 {
            // Shorter than a step that was within the tolerance: nothing to control.
            self.try_step(sys, h);
            self.track.accept(h, t, &mut self.new, Some(&mut self.last));
            self.track.t = t;
            self.prepare_dense(h);
        }
    }
}
