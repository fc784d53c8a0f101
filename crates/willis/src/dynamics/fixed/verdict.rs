//! When a run cannot go on.

use crate::dynamics::decision::Verdict;
use crate::dynamics::mode::dot;
use crate::dynamics::report::Outcome;
use crate::dynamics::rounding::short;
use crate::dynamics::source::out_of_domain;
use crate::train::MemberId;

use super::FixedStep;

/// A point 1 mm off the axis would move as fast as light, rad/s.
const MOST_SPEED: f64 = 3e11;

/// Times in a row that speeds pass twice their largest so far and turn round at once: what moves within its steps
/// passes that while it goes on in one direction.
const MOST_TURNS: u32 = 8;

/// Coordinates that a verdict names, at most.
const MOST_NAMED: usize = 4;

impl FixedStep {
    /// Looks at speeds that are about to be larger than any before, or are no numbers. False: the run ends before them.
    #[cold]
    pub(super) fn may_grow(&mut self, square: f64) -> bool {
        self.turns = if dot(&self.next, &self.v) < 0.0 { self.turns + 1 } else { 0 };
        self.bound = 4.0 * square;
        let why = if !square.is_finite() {
            "the next speeds are not finite".to_owned()
        } else if square > MOST_SPEED * MOST_SPEED {
            "the speeds grow without bound".to_owned()
        } else if self.turns >= MOST_TURNS {
            format!(
                "speeds that reverse at each step grow without bound: a gain or a drag is too high for steps of {} s",
                self.h
            )
        } else {
            return true;
        };
        self.stop(&why);
        false
    }

    /// Whether all that enters the step is a number; else the run ends before it.
    pub(super) fn enters_finite(&mut self, middle: f64) -> bool {
        let Some(k) = self.inputs.iter().position(|u| !u.is_finite()) else { return true };
        let s = &self.engine.system;
        let drivers = s.drivers.len();
        let speed = |m: MemberId| dot(&s.speeds[m.index()], &self.v);
        // Speeds are prescribed for the end of a step.
        let formula = [middle, middle + 0.5 * self.h]
            .into_iter()
            .find_map(|t| out_of_domain(&s.train, &s.scenario, t, middle, &speed));
        if let Some(why) = formula {
            self.stop(&why);
            return false;
        }
        let what = match (s.scenario.sources.get(k), s.frictions.get(k.wrapping_sub(drivers))) {
            (Some(source), _) => format!("`{}`", source.name),
            (_, Some(friction)) => format!("the friction of `{}`", friction.name),
            _ => "the twist of a shaft".to_owned(),
        };
        let why = format!("{what} is not finite in the step around {middle} s: it grows without bound");
        self.stop(&why);
        false
    }

    /// Ends the run before a step that has no motion, or whose motion was not found.
    #[cold]
    pub(super) fn stop_without_motion(&mut self, verdict: Verdict) {
        let none = verdict != Verdict::Undecided;
        self.stop(if none {
            "no speeds at the end of the next step agree with its tooth forces and friction"
        } else {
            "the contacts of the next step are too many to decide"
        });
        if let (true, Some(Outcome::NotConverged(why))) = (none, &mut self.verdict) {
            self.verdict = Some(Outcome::NoSolution(std::mem::take(why)));
        }
    }

    /// Ends the run at the state reached.
    pub(super) fn stop(&mut self, why: &str) {
        let s = &self.engine.system;
        let named = s.coordinates.iter().zip(&self.v).take(MOST_NAMED);
        let state: Vec<String> =
            named.map(|(m, v)| format!("{} {} rad/s", s.train.member_name(*m), short(*v))).collect();
        let more = if s.coordinates.len() > MOST_NAMED { ", …" } else { "" };
        let why = format!("at t = {} s, with {}{more}: {why}", self.time(), state.join(", "));
        self.verdict = Some(Outcome::NotConverged(why));
    }
}
