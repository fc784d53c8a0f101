//! Events within a step.

use crate::dynamics::integrator::Stepper;
use crate::dynamics::margins::{Margin, NOISE};
use crate::dynamics::stretch::Watch;

use super::Simulation;

/// The lowest point of the parabola through three points, and its value there; none if it opens downward.
fn vertex(t: [f64; 3], y: [f64; 3]) -> Option<(f64, f64)> {
    let first = (y[1] - y[0]) / (t[1] - t[0]);
    let second = ((y[2] - y[1]) / (t[2] - t[1]) - first) / (t[2] - t[0]);
    let lowest = 0.5 * (t[0] + t[1]) - 0.5 * first / second;
    (second > 0.0).then(|| (lowest, y[0] + (lowest - t[0]) * (first + second * (lowest - t[1]))))
}

impl Simulation {
    /// Margins at a time within the last step.
    fn margins_at(&mut self, t: f64) {
        self.interpolate(t);
        self.engine.margins(t, &self.state, &mut self.margins);
    }

    /// Margins at the end of the last step.
    fn margins_at_end(&mut self, t_new: f64) {
        if self.stiff {
            return self.margins_at(t_new);
        }
        self.engine.margins_after_rate(t_new, self.explicit.x(), &mut self.margins);
    }

    /// The first event of the last step: just after it, and what it was.
    pub(super) fn find_event(&mut self, t_old: f64, t_new: f64) -> Option<(f64, Watch)> {
        let half = 0.5 * (t_old + t_new);
        // Where no mode was chosen in between, the last step ended as this one starts.
        let mut start = std::mem::take(&mut self.at_start);
        if !std::mem::take(&mut self.start_is_known) {
            start.clear();
        }
        self.margins_at_end(t_new);
        let mut end = std::mem::take(&mut self.at_end);
        std::mem::swap(&mut end, &mut self.margins);
        self.margins_at(half);
        let found = if self.margins.iter().any(Margin::is_broken) {
            self.at_end = end;
            Some(self.bracket(t_old, half, &start, None))
        } else {
            let mut middle = std::mem::take(&mut self.at_middle);
            std::mem::swap(&mut middle, &mut self.margins);
            let found = if end.iter().any(Margin::is_broken) {
                self.margins.clone_from(&end);
                self.at_end = end;
                Some(self.bracket(half, t_new, &middle, Some((t_old, &start))))
            } else {
                // What leaves its limit and comes back within the step: near the lowest point of a parabola.
                let dip = self.dip(t_old, t_new, &mut start, &middle, &end);
                self.at_end = end;
                match dip {
                    Some(t) if t > half => Some(self.bracket(half, t, &middle, None)),
                    Some(t) => Some(self.bracket(t_old, t, &start, None)),
                    None => None,
                }
            };
            self.at_middle = middle;
            found
        };
        self.at_start = start;
        if found.is_none() {
            std::mem::swap(&mut self.at_start, &mut self.at_end);
            self.start_is_known = true;
        }
        found
    }

    /// A time within the step at which some margin is broken, though none is in its middle nor at its end. The
    /// margins are then those of that time.
    fn dip(
        &mut self,
        t_old: f64,
        t_new: f64,
        start: &mut Vec<Margin>,
        middle: &[Margin],
        end: &[Margin],
    ) -> Option<f64> {
        let reaches =
            |m: &Margin, e: &Margin| m.watch == e.watch && m.value.min(e.value) < 8.0 * (m.value - e.value).abs();
        if !middle.iter().zip(end).any(|(m, e)| reaches(m, e)) {
            return None;
        }
        if start.is_empty() {
            self.margins_at(t_old);
            start.clone_from(&self.margins);
        }
        let mut found = None;
        for ((s, m), e) in start.iter().zip(middle).zip(end) {
            if s.watch != m.watch || m.watch != e.watch {
                continue;
            }
            let (watch, values) = (s.watch, [s.value, m.value, e.value]);
            let (mut t, mut y) = ([t_old, 0.5 * (t_old + t_new), t_new], values);
            // Below this a value within the step is round-off of the interpolation, as where a group has just left
            // rest.
            let unseen = NOISE * values.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
            for _ in 0..4 {
                let inside = |v: &f64| *v > t[0] && *v < t[2] && *v != t[1];
                let Some((lowest, value)) = vertex(t, y).filter(|(v, _)| inside(v)) else { break };
                // One that stays as far from its limit as those that do not reach it.
                if value >= 8.0 * (y[0].min(y[1]).min(y[2]) - value) {
                    break;
                }
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

    /// The first time at which a margin is broken, between one at which none is and one at which some is, whose margins
    /// are those found last. `at_low`: the margins of the first, empty where they are not known; `beyond`: those of a third
    /// time, likewise.
    fn bracket(
        &mut self,
        mut low: f64,
        mut high: f64,
        at_low: &[Margin],
        beyond: Option<(f64, &[Margin])>,
    ) -> (f64, Watch) {
        let mut at_high = self.margins.clone();
        let mut at_low = at_low.to_vec();
        // The end that was replaced last: a parabola goes through it and both ends.
        let mut third = beyond.map(|(t, margins)| (t, margins.to_vec()));
        let mut slow = 0;
        let step = high - low;
        loop {
            let width = high - low;
            // A later change of mode matters as much as an error of the step.
            let least = (4.0 * f64::EPSILON * high.abs().max(low.abs())).max(1e-3 * self.options.tolerance * step);
            if width <= least {
                break;
            }
            if at_low.is_empty() {
                self.margins_at(low);
                at_low.clone_from(&self.margins);
            }
            let guess = if slow > 1 {
                slow = 0;
                0.5 * (low + high)
            } else {
                let [t, open] = earliest([low, high], [&at_low, &at_high], third.as_ref());
                // A little past it, as seen from the nearer end: what is found there closes the interval from the other side.
                let past = 0.5 * least + 0.1 * open;
                if t - low < high - t { t + past } else { t - past }
            };
            let guess = guess.clamp(low + 0.5 * least, high - 0.5 * least);
            if guess <= low || guess >= high {
                break;
            }
            self.margins_at(guess);
            let (t, end) = if self.margins.iter().any(Margin::is_broken) {
                (&mut high, &mut at_high)
            } else {
                (&mut low, &mut at_low)
            };
            let before = std::mem::replace(t, guess);
            let margins = third.get_or_insert_with(Default::default);
            margins.0 = before;
            std::mem::swap(&mut margins.1, end);
            end.clone_from(&self.margins);
            slow = if high - low > 0.5 * width { slow + 1 } else { 0 };
        }
        let part = |m: &Margin| m.value / m.noise.max(1e-300);
        let first = at_high.iter().filter(|m| m.is_broken()).min_by(|a, b| part(a).total_cmp(&part(b)));
        (high, first.expect("broken at the end").watch)
    }
}

/// Where the earliest of the margins that are broken at the end of an interval breaks: by a parabola through both ends and
/// a third time, and how far the secant is from that.
fn earliest([low, high]: [f64; 2], [at_low, at_high]: [&[Margin]; 2], third: Option<&(f64, Vec<Margin>)>) -> [f64; 2] {
    let mut first = [high, 0.0];
    for (k, m) in at_high.iter().enumerate().filter(|(_, m)| m.is_broken()) {
        // Margins of a mode come in the same order at all times.
        let of = |margins: &[Margin]| margins.get(k).filter(|other| other.watch == m.watch).map(Margin::spare);
        let (a, b) = (of(at_low).unwrap_or(0.0).max(0.0), m.spare());
        let secant = low + (high - low) * (a / (a - b));
        let parabola = third.and_then(|(t, margins)| {
            let slope = (b - a) / (high - low);
            let bend = ((of(margins)? - a) / (t - low) - slope) / (t - high);
            // Of the polynomial in Newton's form, a + (x − low)(slope + bend (x − high)), one step from the secant's root
            // after another: near it is the only root in the interval.
            let mut x = secant;
            for _ in 0..4 {
                let value = a + (x - low) * (slope + bend * (x - high));
                x -= value / (slope + bend * (2.0 * x - low - high));
            }
            (x > low && x < high).then_some(x)
        });
        let t = parabola.unwrap_or(secant);
        if t < first[0] {
            first = [t, parabola.map_or(0.0, |t| (t - secant).abs())];
        }
    }
    first
}
