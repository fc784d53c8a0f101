//! Events within a step.

use crate::dynamics::margins::{Margin, NOISE, Watch};

use super::Simulation;

/// The lowest point of the parabola through three points; none if it opens downward.
fn vertex(t: [f64; 3], y: [f64; 3]) -> Option<f64> {
    let first = (y[1] - y[0]) / (t[1] - t[0]);
    let second = ((y[2] - y[1]) / (t[2] - t[1]) - first) / (t[2] - t[0]);
    (second > 0.0).then(|| 0.5 * (t[0] + t[1]) - 0.5 * first / second)
}

impl Simulation {
    /// Margins at a time within the last step.
    fn margins_at(&mut self, t: f64) {
        self.interpolate(t);
        let x = std::mem::take(&mut self.state);
        self.engine.solve(t, &x);
        let mut margins = std::mem::take(&mut self.margins);
        self.engine.margins(t, &x, &mut margins);
        self.margins = margins;
        self.state = x;
    }

    /// The first event of the last step: just after it, and what it was.
    pub(super) fn find_event(&mut self, t_old: f64, t_new: f64) -> Option<(f64, Watch)> {
        let half = 0.5 * (t_old + t_new);
        self.margins_at(half);
        if self.margins.iter().any(Margin::is_broken) {
            return Some(self.bracket(t_old, half));
        }
        let mut middle = std::mem::take(&mut self.at_middle);
        middle.clone_from(&self.margins);
        self.margins_at(t_new);
        let broken = self.margins.iter().any(Margin::is_broken);
        let mut at_end = std::mem::take(&mut self.at_end);
        at_end.clone_from(&self.margins);
        // What leaves its limit and comes back within the step: near the lowest point of a parabola.
        let dip = match broken {
            true => None,
            false => self.dip(t_old, t_new, &middle, &at_end),
        };
        (self.at_middle, self.at_end) = (middle, at_end);
        match dip {
            _ if broken => {
                self.margins_at(t_new);
                Some(self.bracket(half, t_new))
            }
            Some(t) if t > half => Some(self.bracket(half, t)),
            Some(t) => Some(self.bracket(t_old, t)),
            None => None,
        }
    }

    /// A time within the step at which some margin is broken, though none is in its middle nor at its end. The
    /// margins are then those of that time.
    fn dip(&mut self, t_old: f64, t_new: f64, middle: &[Margin], end: &[Margin]) -> Option<f64> {
        let reaches =
            |m: &Margin, e: &Margin| m.watch == e.watch && m.value.min(e.value) < 8.0 * (m.value - e.value).abs();
        if !middle.iter().zip(end).any(|(m, e)| reaches(m, e)) {
            return None;
        }
        self.margins_at(t_old);
        let start = std::mem::take(&mut self.margins);
        let mut found = None;
        let candidates: Vec<(Watch, [f64; 3])> = (start.iter().zip(middle).zip(end))
            .filter(|((s, m), e)| s.watch == m.watch && m.watch == e.watch)
            .map(|((s, m), e)| (s.watch, [s.value, m.value, e.value]))
            .collect();
        self.margins = start;
        for (watch, values) in candidates {
            let (mut t, mut y) = ([t_old, 0.5 * (t_old + t_new), t_new], values);
            // Below this a value within the step is round-off of the interpolation, as where a group has just left
            // rest.
            let unseen = NOISE * values.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
            for _ in 0..4 {
                let Some(lowest) = vertex(t, y).filter(|v| *v > t[0] && *v < t[2] && *v != t[1]) else { break };
                self.margins_at(lowest);
                let Some(m) = self.margins.iter().find(|m| m.watch == watch) else { break };
                if m.is_broken() && m.value < -unseen {
                    found = Some(lowest);
                    break;
                }
                // Round the lowest of the points so far.
                let (value, k) = (m.value, usize::from(lowest > t[1]));
                if value >= y[1] {
                    break;
                }
                if k == 1 {
                    (t[0], y[0]) = (t[1], y[1]);
                } else {
                    (t[2], y[2]) = (t[1], y[1]);
                }
                (t[1], y[1]) = (lowest, value);
            }
            if found.is_some() {
                break;
            }
        }
        found
    }

    /// The first time at which a margin is broken, between one at which none is and one at which some is.
    fn bracket(&mut self, mut low: f64, mut high: f64) -> (f64, Watch) {
        let broken =
            |margins: &[Margin]| -> Vec<Margin> { margins.iter().copied().filter(Margin::is_broken).collect() };
        let mut at_high = broken(&self.margins);
        let mut at_low: Vec<Margin> = vec![];
        let mut halve = false;
        let mut first = true;
        let step = high - low;
        loop {
            let width = high - low;
            // A later change of mode matters as much as an error of the step.
            let least = (4.0 * f64::EPSILON * high.abs().max(low.abs())).max(1e-3 * self.options.tolerance * step);
            if width <= least {
                break;
            }
            if first {
                self.margins_at(low);
                at_low.clone_from(&self.margins);
                first = false;
            }
            // The earliest root by the secants of those broken at the end, a little past it; every other time
            // that does not halve the interval, its middle.
            let guess = if halve {
                0.5 * (low + high)
            } else {
                let mut t = high;
                for m in &at_high {
                    let before = at_low.iter().find(|l| l.watch == m.watch).map_or(0.0, |l| l.value.max(0.0));
                    t = t.min(low + width * (before / (before - m.value)));
                }
                t + (1e-3 * width * ((t - low).min(high - t) / width)).max(least)
            };
            let guess = guess.clamp(low + 0.5 * least, high - 0.5 * least);
            if guess <= low || guess >= high {
                break;
            }
            self.margins_at(guess);
            let found = broken(&self.margins);
            if found.is_empty() {
                low = guess;
                at_low.clone_from(&self.margins);
            } else {
                high = guess;
                at_high = found;
            }
            halve = !halve && high - low > 0.5 * width;
        }
        let first =
            at_high.iter().min_by(|a, b| (a.value / a.noise.max(1e-300)).total_cmp(&(b.value / b.noise.max(1e-300))));
        (high, first.expect("broken at the end").watch)
    }
}
