//! Smooth motion between changes of mode.
//!
//! Two one-step methods with error control and dense output: [`Dopri5`] explicit, [`Implicit`] for
//! stiff systems. Both are restarted after every change of mode. Source: Hairer, Nørsett, Wanner,
//! Solving Ordinary Differential Equations I, 2nd ed. 1993, section II.4 to II.6; Hairer, Wanner, II,
//! 2nd ed. 1996, section IV.8.

mod dopri5;
mod implicit;
#[cfg(test)]
mod tests;

pub(crate) use dopri5::Dopri5;
pub(crate) use implicit::Implicit;

/// A smooth system of ordinary differential equations with quadratures beside it.
///
/// The state is `x[..states()]`; after it stand `quadratures()` integrals whose rates depend on the
/// state but on which nothing depends (energies). Their error
/// controls the step where the method is explicit.
pub(crate) trait Smooth {
    /// Number of states, whose error is controlled.
    fn states(&self) -> usize;
    /// Number of quadratures after them.
    fn quadratures(&self) -> usize;
    /// `rate = dx/dt`, of both.
    fn rate(&mut self, t: f64, x: &[f64], rate: &mut [f64]);
    /// Size of each state with which its error is compared: `tolerance (|x| + scale)`.
    fn scale(&self, state: usize) -> f64;
}

/// Why a step could not be taken. The solution stays where it was.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum StepError {
    /// A rate is infinite or NaN, however short the step.
    NotFinite,
    /// The tolerance cannot be kept with steps that still change the time.
    StepTooSmall,
}

/// What came of a step that was tried.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Attempt {
    /// Its error is within the tolerance; the next one may be longer by `factor`.
    Taken { factor: f64 },
    /// It is to be tried again, shorter by `factor`; `finite` unless what failed it is no number.
    Rejected { factor: f64, finite: bool },
}

/// A one-step method: `restart`, then `step` again and again. Time rises. Nothing is allocated
/// after `new`.
///
/// The last stage of a step stands at its end: a system whose rates jump at `t_end` must still
/// give those before the jump there, and those after it from the restart on.
pub(crate) trait Stepper {
    /// For systems of that size.
    fn new(states: usize, quadratures: usize) -> Self;

    /// Begins at `t` with the state `x` (quadratures included) on the way to `t_end`. The first
    /// step tried is `first`, else the one that would have come next before, else an estimate.
    fn restart<S: Smooth>(&mut self, sys: &mut S, t: f64, x: &[f64], tolerance: f64, t_end: f64, first: Option<f64>);

    /// Tries a step of length `h` from where it stands; `again` after another one was rejected.
    fn attempt<S: Smooth>(&mut self, sys: &mut S, h: f64, again: bool) -> Attempt;

    /// Moves on to the end of the step of length `h` that was tried last, which was taken.
    fn accept(&mut self, h: f64, t_end: f64);

    /// Where it stands.
    fn track(&self) -> &Track;

    /// The same, to be changed.
    fn track_mut(&mut self) -> &mut Track;

    /// Takes one step within the tolerance, not beyond `t_end`.
    fn step<S: Smooth>(&mut self, sys: &mut S, t_end: f64) -> Result<(), StepError> {
        let track = self.track();
        debug_assert!(t_end > track.t);
        if !track.rate.iter().all(|r| r.is_finite()) {
            return Err(StepError::NotFinite);
        }
        let (mut wanted, mut finite, mut again) = (track.next, true, false);
        while !self.track().is_too_short(wanted, t_end) {
            let h = self.track().length(wanted, t_end);
            match self.attempt(sys, h, again) {
                Attempt::Taken { factor } => {
                    let next = h * if again { factor.min(1.0) } else { factor };
                    // A step that was cut short says nothing against the length that was wanted.
                    self.track_mut().next = if h < wanted { next.max(wanted) } else { next };
                    self.accept(h, t_end);
                    return Ok(());
                }
                Attempt::Rejected { factor, finite: is_finite } => {
                    self.track_mut().counts.rejected += 1;
                    (wanted, finite, again) = (h * factor, is_finite, true);
                }
            }
        }
        Err(if finite { StepError::StepTooSmall } else { StepError::NotFinite })
    }

    /// Value of a component within the last step.
    fn interpolate_component(&self, t: f64, k: usize) -> f64;

    /// Goes back to `t` within the last step, which then ends there: nothing that lies beyond has a part in it.
    fn shorten<S: Smooth>(&mut self, sys: &mut S, t: f64);

    /// State within the last step.
    fn interpolate(&self, t: f64, out: &mut [f64]) {
        out.iter_mut().enumerate().for_each(|(k, x)| *x = self.interpolate_component(t, k));
    }

    /// Start of the last step.
    fn t_old(&self) -> f64 {
        self.track().t_old
    }

    /// Its end.
    fn t(&self) -> f64 {
        self.track().t
    }

    /// State at the start of the last step, with quadratures.
    fn x_old(&self) -> &[f64] {
        &self.track().x_old
    }

    /// State at its end.
    fn x(&self) -> &[f64] {
        &self.track().x
    }

    /// Rate at the start of the last step.
    fn rate_old(&self) -> &[f64] {
        &self.track().rate_old
    }

    /// Rate at its end.
    fn rate(&self) -> &[f64] {
        &self.track().rate
    }

    /// What it took so far.
    #[cfg(test)]
    fn counts(&self) -> Counts {
        self.track().counts
    }
}

/// Work done since `new`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Counts {
    /// Steps accepted.
    pub steps: usize,
    /// Steps rejected.
    pub rejected: usize,
    /// Evaluations of the rate.
    pub evaluations: usize,
}

/// The two ends of the last step, and what comes next.
#[derive(Clone, Debug)]
pub(crate) struct Track {
    states: usize,
    tolerance: f64,
    t_old: f64,
    t: f64,
    x_old: Vec<f64>,
    x: Vec<f64>,
    rate_old: Vec<f64>,
    rate: Vec<f64>,
    /// Next step; zero before the first one.
    next: f64,
    counts: Counts,
}

impl Track {
    fn new(states: usize, quadratures: usize) -> Self {
        let zero = vec![0.0; states + quadratures];
        Self {
            states,
            tolerance: 0.0,
            t_old: 0.0,
            t: 0.0,
            x_old: zero.clone(),
            x: zero.clone(),
            rate_old: zero.clone(),
            rate: zero,
            next: 0.0,
            counts: Counts::default(),
        }
    }

    /// `order` is that of the error estimate; `work` two vectors to write on.
    #[allow(clippy::too_many_arguments)]
    fn restart<S: Smooth>(
        &mut self,
        sys: &mut S,
        t: f64,
        x: &[f64],
        tolerance: f64,
        t_end: f64,
        first: Option<f64>,
        order: i32,
        work: [&mut [f64]; 2],
    ) {
        debug_assert_eq!((sys.states(), x.len()), (self.states, self.x.len()));
        (self.t_old, self.t, self.tolerance) = (t, t, tolerance);
        self.x.copy_from_slice(x);
        self.x_old.copy_from_slice(x);
        self.evaluate(sys);
        self.rate_old.copy_from_slice(&self.rate);
        match first {
            // One that was cut short says little.
            Some(h) => self.next = h.max(1e-12 * t.abs()),
            None if self.next > 0.0 => {}
            None => self.next = self.first_step(sys, t_end - t, order, work),
        }
    }

    fn evaluate<S: Smooth>(&mut self, sys: &mut S) {
        sys.rate(self.t, &self.x, &mut self.rate);
        self.counts.evaluations += 1;
    }

    /// What an error of a state is compared with at the start of a step.
    #[inline]
    fn weight<S: Smooth>(&self, sys: &S, i: usize) -> f64 {
        self.tolerance * (self.x[i].abs() + sys.scale(i))
    }

    /// A first step from the sizes of state, rate and second derivative; Hairer, Nørsett, Wanner I,
    /// section II.4, "starting step size".
    fn first_step<S: Smooth>(&mut self, sys: &mut S, longest: f64, order: i32, [x, rate]: [&mut [f64]; 2]) -> f64 {
        let n = self.states;
        let square = |v: f64, weight: f64| (v / weight).powi(2);
        let (mut size, mut slope) = (0.0, 0.0);
        for i in 0..n {
            let weight = self.weight(sys, i);
            size += square(self.x[i], weight);
            slope += square(self.rate[i], weight);
        }
        let tiny = |v: f64| v <= 1e-10;
        let h = if tiny(size) || tiny(slope) { 1e-6 } else { 0.01 * f64::sqrt(size / slope) };
        let h = h.min(longest);
        x.copy_from_slice(&self.x);
        for i in 0..n {
            x[i] += h * self.rate[i];
        }
        sys.rate(self.t + h, x, rate);
        self.counts.evaluations += 1;
        let bend: f64 = (0..n).map(|i| square(rate[i] - self.rate[i], self.weight(sys, i))).sum();
        let larger = (bend.sqrt() / h).max(slope.sqrt());
        let second =
            if larger <= 1e-15 { 1e-6_f64.max(h * 1e-3) } else { (0.01 / larger).powf(1.0 / f64::from(order)) };
        let first = (100.0 * h).min(second).min(longest);
        if first > 0.0 { first } else { h }
    }

    /// The next step on the way to `t_end`: a last step is not tiny.
    fn length(&self, wanted: f64, t_end: f64) -> f64 {
        let left = t_end - self.t;
        if wanted >= 0.99 * left {
            left
        } else if wanted > 0.5 * left {
            0.5 * left
        } else {
            wanted
        }
    }

    /// Whether steps of that length no longer make sense.
    fn is_too_short(&self, wanted: f64, t_end: f64) -> bool {
        let left = t_end - self.t;
        wanted < left && wanted < (1e-14 * self.t.abs()).max(1e-100)
    }

    /// Takes the last step back.
    fn back(&mut self) {
        self.t = self.t_old;
        std::mem::swap(&mut self.x, &mut self.x_old);
        std::mem::swap(&mut self.rate, &mut self.rate_old);
    }

    /// Takes the step of length `h`: `x` and `rate`, if given, are those at its end and are exchanged
    /// for those of its start.
    fn accept(&mut self, h: f64, t_end: f64, x: &mut Vec<f64>, rate: Option<&mut Vec<f64>>) {
        use std::mem::swap;
        self.t_old = self.t;
        self.t = if h == t_end - self.t { t_end } else { self.t + h };
        swap(&mut self.x_old, &mut self.x);
        swap(&mut self.x, x);
        swap(&mut self.rate_old, &mut self.rate);
        if let Some(rate) = rate {
            swap(&mut self.rate, rate);
        }
        self.counts.steps += 1;
    }
}
