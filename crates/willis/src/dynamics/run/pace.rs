//! How long a run will take, told by its first part.

use crate::work::Effort;

/// Work of one core, s, after which a run has a pace: before that it is over soon, or begins more slowly than it goes on.
const FIRST: f64 = 3.0;

/// Seconds in eighty years.
const LIFETIME: f64 = 2.5e9;

/// Work in arithmetic operations per second.
const OPERATIONS: f64 = 1e9;

/// Work done, counted and not measured: a run that is stopped here is stopped everywhere.
#[derive(Clone, Debug)]
pub(in crate::dynamics) struct Pace {
    /// Of a step, and of a choice of the mode, s.
    step: f64,
    choice: f64,
    steps: u64,
    /// s.
    done: f64,
    /// Work and time at which the pace was looked at last.
    looked: [f64; 2],
    patience: f64,
}

impl Pace {
    /// For a system of so many coordinates and nodes, from a time on.
    pub fn new([coordinates, nodes]: [usize; 2], start: f64, patience: f64) -> Self {
        // Seven stages of a step, each a map from torques; a mode is found by pivots over all nodes.
        let size = (coordinates + nodes) as f64;
        let operations = [7.0 * (300.0 + 40.0 * size), 2e4 + 200.0 * size * size];
        let [step, choice] = operations.map(|x| x / OPERATIONS);
        Self { step, choice, steps: 0, done: 0.0, looked: [0.0, start], patience }
    }

    /// One more step.
    pub fn step(&mut self) {
        self.steps += 1;
        self.done += self.step;
    }

    /// One more choice of the mode.
    pub fn choice(&mut self) {
        self.done += self.choice;
    }

    /// Why the run is not gone on with, if it would take longer than patience lasts: by what is done and, for the rest, by
    /// the pace since the last look or that of all so far, whichever is quicker.
    pub fn is_too_long(&mut self, [start, t, end]: [f64; 3]) -> Option<String> {
        let [done, since] = self.looked;
        if self.done < FIRST || self.done - done < FIRST || !self.patience.is_finite() {
            return None;
        }
        self.looked = [self.done, t];
        let rate = |work: f64, time: f64| if time > 0.0 { work / time } else { f64::INFINITY };
        let rest = (end - t) * rate(self.done - done, t - since).min(rate(self.done, t - start));
        // What is nearly done is finished.
        if self.done + rest <= self.patience || self.done >= self.patience && rest <= self.done {
            return None;
        }
        let whole = self.steps as f64 * (self.done + rest) / self.done;
        let rest = if self.done + rest > LIFETIME {
            "it does not end in a lifetime".to_owned()
        } else {
            let effort = Effort { what: "steps", count: whole as u64, seconds: self.done + rest };
            format!("the whole run is {effort}")
        };
        Some(format!("after {} steps; at this pace {rest}", self.steps))
    }
}
