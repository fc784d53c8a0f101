//! Which mode a state is in: decided by accelerations and forces, never by the sign of a small speed.
//!
//! At a change of mode some groups are at zero slip. Each may be held or slide off either way, and the tooth
//! forces may turn round; what happens is [decided](super::decision) for all of them at once, and several solutions,
//! or none, are found and said (the gear form of Painlevé's paradox).

use std::sync::Arc;

use crate::train::SourceKind;

use super::decision::Verdict;
use super::engine::Engine;
use super::halt::Halt;
use super::mode::{Mode, dot, dot_size};
use super::rounding::short;

/// Why there is no one mode.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Trouble {
    /// Elements that join members of different speed at once.
    Impact(String),
    /// No mode agrees with itself.
    None(String),
    /// None was found, and there are too many to try them all.
    NotFound(String),
    /// Several do; the first of them.
    Several(String, Mode),
}

impl Engine {
    /// Speeds in the state made exactly those of groups at rest, with the least change in kinetic energy. Groups whose slip
    /// is then zero because that of others is are added to them.
    pub fn bring_to_rest(&mut self, x: &mut [f64], at_rest: &mut [bool]) {
        let known = self.halts.iter().find(|halt| halt.given == *at_rest).cloned();
        let halt = known.unwrap_or_else(|| {
            let halt = Arc::new(Halt::of(&self.system, at_rest));
            self.halts.push(halt.clone());
            halt
        });
        halt.apply(&self.system, &self.speed, x);
        at_rest.copy_from_slice(&halt.at_rest);
    }

    /// Groups whose slip is zero but for a part of their speeds.
    pub fn at_rest(&self, within: f64) -> Vec<bool> {
        (0..self.system.groups.len())
            .map(|g| {
                let row = &self.system.groups[g].row;
                self.group_slip(g).abs() <= within * dot_size(row, &self.speed)
            })
            .collect()
    }

    /// Finds out which friction elements are engaged at the state looked at.
    pub fn engage(&mut self, t: f64) {
        for k in 0..self.engaged.len() {
            let threshold = if self.system.frictions[k].rigid { 0.5 } else { 0.0 };
            let above = self.engagement(k, t) - threshold;
            // Just at the threshold the direction decides.
            let rate = self.engagement_rate(k, t);
            let locks = self.system.frictions[k].rigid && rate == 0.0 && above >= 0.0;
            self.engaged[k] = if above.abs() <= 1e-12 { rate > 0.0 || locks } else { above > 0.0 };
        }
    }

    /// Whether something engaged holds against the slip that a group has, whatever that takes.
    fn stops(&self, g: usize, t: f64) -> bool {
        let capacity = self.capacity(g, false, t);
        let against = if self.group_slip(g) > 0.0 { capacity.forward } else { capacity.backward };
        against.is_infinite()
    }

    /// Adds the groups that something engaged holds rigidly and whose slip is zero but for a part of their speeds: both
    /// sides are known to that part only, so that they turn alike as far as anybody can tell.
    pub fn rest_where_joined(&mut self, t: f64, within: f64, at_rest: &mut [bool]) {
        self.engage(t);
        for (g, alike) in self.at_rest(within).into_iter().enumerate() {
            at_rest[g] |= alike && self.stops(g, t);
        }
    }

    /// The mode of a state. `at_rest`: groups at zero slip; `guess`: the mode before.
    pub fn choose(&mut self, t: f64, x: &[f64], at_rest: &[bool], guess: &Mode) -> Result<Mode, Trouble> {
        self.look(t, x);
        self.engage(t);
        for k in 0..self.touch.len() {
            self.touch[k] = self.touch_now(k, x);
        }
        if !self.path_ends.is_empty() {
            self.look_at_ends(t, x);
        }
        let mut start = guess.clone();
        for g in 0..at_rest.len() {
            let slip = self.group_slip(g);
            if !at_rest[g] {
                start.slip[g] = if slip > 0.0 { 1 } else { -1 };
                if self.stops(g, t) {
                    return Err(Trouble::Impact(format!(
                        "{} would stop a relative speed of {} rad/s at once; give the shift element a capacity, or \
                         engage it when its sides turn alike",
                        self.system.groups[g].names.join(", "),
                        short(slip)
                    )));
                }
            } else if self.system.groups[g].driven {
                start.slip[g] = self.departure(g);
            }
        }
        for g in 0..at_rest.len() {
            if at_rest[g] && !self.system.groups[g].driven {
                start.slip[g] = 0;
            }
        }
        if let Some(mode) = self.clear_mode(t, x, &start) {
            return Ok(mode);
        }
        let (verdict, mode) = self.decide(t, x, &start);
        match verdict {
            Verdict::One { proved } => {
                self.unproved += usize::from(!proved);
                Ok(mode)
            }
            Verdict::Two => {
                let [first, second] = self.two_motions().map(|a| self.accelerations(&a));
                let why = format!(
                    "2 sets of tooth forces and accelerations agree with this state; the first gives {first}, the second {second}"
                );
                Err(Trouble::Several(why, mode))
            }
            Verdict::None | Verdict::Contradiction => Err(Trouble::None(self.no_solution(at_rest))),
            Verdict::Undecided => Err(Trouble::NotFound(
                "no accelerations and tooth forces were found that agree with each other; there are too many combinations of \
                 sticking and driving to look through them all"
                    .to_owned(),
            )),
        }
    }

    /// Direction in which prescribed speeds move a group at rest off, by their rates or, where those are zero too,
    /// by where they are in the middle of the smooth piece; 0 if they leave it at rest.
    fn departure(&self, g: usize) -> i8 {
        let s = &self.system;
        let row = &s.groups[g].row[s.free..];
        let mut ahead = vec![0.0; s.prescribed];
        for (driver, source) in s.drivers.iter().zip(&s.scenario.sources) {
            if let (Some(i), SourceKind::Speed(signal)) = (driver.prescribed, &source.kind) {
                ahead[i] = signal.value(self.inside, self.inside, &|_| 0.0);
            }
        }
        let moves = [&self.acceleration[s.free..], &ahead[..]].into_iter().map(|rates| (dot(row, rates), rates));
        let first = moves.into_iter().find(|(slip, rates)| slip.abs() > 1e-11 * dot_size(row, rates));
        first.map_or(0, |(slip, _)| if slip > 0.0 { 1 } else { -1 })
    }

    fn accelerations(&self, of: &[f64]) -> String {
        let name = |k: usize| self.system.train.member_name(self.system.coordinates[k]);
        let list: Vec<String> =
            (0..self.system.free).map(|k| format!("{}: {} rad/s²", name(k), short(of[k]))).collect();
        list.join(", ")
    }

    fn no_solution(&self, at_rest: &[bool]) -> String {
        let still: Vec<String> = (at_rest.iter().enumerate())
            .filter(|(_, r)| **r)
            .map(|(g, _)| self.system.groups[g].names.join(", "))
            .collect();
        let still = if still.is_empty() { String::new() } else { format!(" with {} at rest", still.join("; ")) };
        format!(
            "no accelerations and tooth forces agree with each other{still}: friction grows with the force it causes"
        )
    }
}
