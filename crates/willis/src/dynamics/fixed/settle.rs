//! The mode of a step: one that agrees with the speeds at its end.

use std::sync::Arc;

use crate::dynamics::engine::Touch;
use crate::dynamics::fused::FAR;
use crate::dynamics::mode::{Side, dot, dot_size};
use crate::dynamics::rounding::NOISE;

use super::FixedStep;
use super::groups::LEAST_UNBOUNDED;
use super::map::{Key, StepMap, step_map};
use super::shafts::word;

impl FixedStep {
    /// The map of a mode, made if it was not met before: the only place that takes more than bounded time.
    #[inline]
    pub(super) fn map(&mut self, key: Key) -> Option<u32> {
        if let Some((k, map)) = self.last
            && k == key
        {
            return Some(map);
        }
        let found = match self.by_key.get(&key) {
            Some(&k) => (k != u32::MAX).then_some(k),
            None => self.make(key),
        };
        if let Some(map) = found {
            self.last = Some((key, map));
        }
        found
    }

    fn make(&mut self, key: Key) -> Option<u32> {
        let s = &self.engine.system;
        let mode = key.mode(s);
        let resists = &self.resists;
        let made = self.engine.maps.pattern_with(s, &mode, resists).and_then(|pattern| step_map(s, &mode, pattern));
        let k = match made {
            Some(map) => {
                self.maps.push(Arc::new(map));
                self.maps.len() as u32 - 1
            }
            None => u32::MAX,
        };
        self.by_key.insert(key, k);
        (k != u32::MAX).then_some(k)
    }

    /// Which groups are held and which sides drive: the key of the present mode.
    #[inline]
    fn key(&self) -> Key {
        let mut key = Key { held: 0, coast: 0, touch: word(&self.shafts) };
        for (g, group) in self.groups.iter().enumerate() {
            if self.sign[g] == 0 && !group.driven {
                key.held |= 1 << g;
            } else {
                for &j in &group.elements {
                    key.coast |= u64::from(self.side[j] == Side::Coast) << j;
                }
            }
        }
        key
    }

    /// Torques of what slides, and the losses of teeth that do not depend on load, in the present mode; at their
    /// peak in the group that is breaking away.
    #[inline(always)]
    fn rub(&mut self, breaking: Option<usize>) {
        for (g, group) in self.groups.iter().enumerate() {
            let sign = self.sign[g];
            for rub in &group.rubs {
                let opposes = match sign {
                    0 => 0.0,
                    1 => -rub.opposes[0],
                    _ => rub.opposes[1],
                };
                let opposes = if opposes.abs() >= LEAST_UNBOUNDED { 0.0 } else { opposes };
                let opposes = if breaking == Some(g) { opposes * rub.peak } else { opposes };
                self.tau[rub.port] = rub.viscous + if rub.factor < 0.0 { -opposes } else { opposes };
            }
            for &(j, port, [drive, coast]) in &group.constants {
                let (_, factor) = self.engine.system.elements[j].group.expect("of this group");
                let torque = if self.side[j] == Side::Drive { drive } else { coast };
                self.tau[port] = f64::from(sign) * factor.signum() * torque;
            }
        }
    }

    /// Torques of the shafts in their present contacts, without what follows from the accelerations.
    pub(super) fn twist_shafts(&mut self) {
        for (k, e) in self.engine.system.elastic.iter().enumerate() {
            let [spring, damper, constant] = self.shafts[k].resists();
            self.tau[e.port] = -(spring * self.shafts[k].twist + damper * dot(&e.row, &self.v) + constant);
            self.resists[k] = damper * self.h;
        }
    }

    /// The first shaft whose contact and the end of the step disagree, and what it turns to.
    pub(super) fn turned(&self) -> Option<(usize, Touch)> {
        let elastic = &self.engine.system.elastic;
        (self.shafts.iter().zip(elastic).enumerate())
            .find_map(|(k, (shaft, e))| Some((k, shaft.turns_to(dot(&e.row, &self.next))?)))
    }

    /// Round-off of the slip of a group at the end of the step.
    pub(super) fn round_off(&self, g: usize) -> f64 {
        NOISE * (dot_size(&self.groups[g].row, &self.next) + self.slip[g].abs())
    }

    /// The first thing in which the mode and the end of the step disagree. Groups in `kept` came to rest at once after
    /// they were released: those that others hold as well go on sliding without moving, the rest is not released again. With
    /// `far`, what agrees by less than so many times its round-off disagrees, too.
    #[inline(always)]
    fn disagreement(&self, map: &StepMap, free: usize, cols: usize, kept: u64, far: Option<f64>) -> Option<Flip> {
        let least = |noise: f64| far.map_or(-noise, |far| far * noise);
        let mut rows = map.rows[free * cols..].chunks_exact(cols);
        let mut stuck = None;
        let mut teeth = map.still.iter();
        for (g, group) in self.groups.iter().enumerate().filter(|(_, group)| !group.driven) {
            if self.sign[g] != 0 {
                let end = dot(&group.row, &self.next) * f64::from(self.sign[g]);
                let may_hold = self.capacity[g] != [0.0; 2] || !group.elements.is_empty();
                let noise = self.round_off(g);
                // What others hold as well has no slip whatever it does: it is held with them.
                let stays = end <= noise && self.slip[g].abs() <= noise;
                let slides_at_its_limit = kept >> g & 1 == 1 && end >= -noise;
                let nears = far.is_some_and(|far| end < far * noise);
                if (end < 0.0 || stays || nears) && may_hold && !slides_at_its_limit {
                    return Some(Flip::Group(g, 0));
                }
                continue;
            }
            let force = group.lead.1 * dot(rows.next().expect("a row for each"), &self.tau);
            if group.shares && !map.is_redundant {
                // What teeth hold follows from the torque in them once they slide: that is tried.
                teeth.by_ref().nth(group.elements.len() - 1);
                continue;
            }
            let [mut forward, mut backward] = self.capacity[g];
            // Teeth at rest hold by the forces in them.
            for &j in &group.elements {
                let (_, row) = teeth.next().expect("a row for each");
                let (_, factor, loss) = self.teeth[j];
                let torque = dot(row, &self.tau);
                let upper = (loss.drive * torque + loss.drive_torque).max(loss.coast * torque + loss.coast_torque);
                let lower = (loss.drive * torque - loss.drive_torque).min(loss.coast * torque - loss.coast_torque);
                let (along, against) = if factor > 0.0 { (upper, -lower) } else { (lower, -upper) };
                forward += factor * along;
                backward += factor * against;
            }
            let noise = 1e-12 * (force.abs() + 1e-300);
            let sign = match (forward + force < least(noise), backward - force < least(noise)) {
                (true, _) => 1,
                (_, true) => -1,
                _ => continue,
            };
            // Where several hold together, some other split of the torques among them may do.
            if map.is_redundant {
                return Some(Flip::Stuck);
            }
            if kept >> g & 1 == 0 {
                return Some(Flip::Group(g, sign));
            }
            stuck = Some(Flip::Stuck);
        }
        for (&j, row) in map.moving.iter().zip(rows) {
            let j = usize::from(j);
            let (g, factor, loss) = self.teeth[j];
            if self.sign[g] == 0 {
                continue;
            }
            let sign = f64::from(self.sign[g]) * factor.signum();
            let torque = dot(row, &self.tau);
            let value = sign * (loss.drive - loss.coast) * torque + loss.drive_torque - loss.coast_torque;
            let value = if self.side[j] == Side::Drive { value } else { -value };
            let noise = NOISE * (loss.drive - loss.coast) * dot_size(row, &self.tau);
            // A mesh that carries nothing keeps its side.
            if far.map_or(value < 0.0 && value < -noise, |far| value <= far * noise) {
                return Some(Flip::Side(j));
            }
        }
        stuck
    }

    /// Whether a held group whose parts share in holding would slide off, or is so many times the round-off from it: tried in
    /// both directions.
    fn breaks_away(&mut self, g: usize, far: Option<f64>) -> Option<i8> {
        const ROUND_OFF: f64 = 1e-11;
        let least = far.map_or(ROUND_OFF, |far| -far * ROUND_OFF);
        let sides: u64 = self.coasting();
        let p = self.engine.system.ports;
        let (free, cols) = (self.engine.system.free, p + self.groups.len());
        for sign in [1i8, -1] {
            if self.capacity[g][usize::from(sign < 0)] >= LEAST_UNBOUNDED {
                continue;
            }
            self.sign[g] = sign;
            // Sides that agree: the last ones, else each turned once.
            for _ in 0..=self.groups[g].elements.len() {
                let Some(map) = self.map(self.key()) else { break };
                self.rub(Some(g));
                let map = &self.maps[map as usize];
                let rows = &map.rows;
                let turned = (map.moving.iter().zip(rows[(free + map.held.len()) * cols..].chunks_exact(cols)))
                    .filter(|(j, _)| self.teeth[usize::from(**j)].0 == g)
                    .find_map(|(&j, row)| {
                        let j = usize::from(j);
                        let (_, factor, loss) = self.teeth[j];
                        let along = f64::from(sign) * factor.signum();
                        let value = along * (loss.drive - loss.coast) * dot(row, &self.tau) + loss.drive_torque
                            - loss.coast_torque;
                        let side = if value >= 0.0 { Side::Drive } else { Side::Coast };
                        (side != self.side[j]).then_some((j, side))
                    });
                let Some((j, side)) = turned else { break };
                self.side[j] = side;
            }
            let Some(map) = self.map(self.key()) else { continue };
            self.rub(Some(g));
            let rows = &self.maps[map as usize].rows;
            let rate: f64 =
                (0..free).map(|i| self.groups[g].row[i] * dot(&rows[i * cols..(i + 1) * cols], &self.tau)).sum();
            let end = self.slip[g] + self.h * rate;
            // Others may hold it as well: then nothing but round-off is left.
            let size = dot_size(&self.groups[g].row, &self.v) + self.slip[g].abs();
            if end * f64::from(sign) > least * size {
                return Some(sign);
            }
        }
        self.sign[g] = 0;
        self.set_coasting(sides);
        None
    }

    pub(super) fn coasting(&self) -> u64 {
        self.side.iter().enumerate().map(|(j, s)| u64::from(*s == Side::Coast) << j).sum()
    }

    pub(super) fn set_coasting(&mut self, coasting: u64) {
        for (j, side) in self.side.iter_mut().enumerate() {
            *side = if coasting >> j & 1 == 1 { Side::Coast } else { Side::Drive };
        }
    }

    /// Solves the step in the present mode.
    #[inline(always)]
    fn solve(&mut self, free: usize, cols: usize) -> Option<u32> {
        self.twist_shafts();
        let map = self.map(self.key())?;
        self.rub(None);
        let rows = &self.maps[map as usize].rows;
        for (i, row) in rows[..free * cols].chunks_exact(cols).enumerate() {
            self.next[i] = self.v[i] + self.h * dot(row, &self.tau);
        }
        Some(map)
    }

    /// Solves the step in the present mode; false if that is not the mode of the step by far.
    #[inline(always)]
    fn solve_if_far(&mut self, free: usize, cols: usize) -> bool {
        let Some(map) = self.solve(free, cols) else { return false };
        let map = &self.maps[map as usize];
        // Of several that hold together, others than these may be taken to slide without moving.
        if map.is_redundant || self.disagreement(map, free, cols, 0, Some(FAR)).is_some() {
            return false;
        }
        if !self.shares {
            return true;
        }
        for g in 0..self.groups.len() {
            if self.sign[g] == 0 && self.groups[g].shares && self.breaks_away(g, Some(FAR)).is_some() {
                return false;
            }
        }
        self.solve(free, cols).is_some()
    }

    /// Finds the mode of the step and its end.
    #[inline(always)]
    fn search(&mut self, free: usize, cols: usize) -> bool {
        let trials = 4 * (self.groups.len() + self.side.len() + self.shafts.len()) + 4;
        // The group released last, and those that came to rest again at once.
        let (mut released, mut kept) = (None, 0u64);
        for _ in 0..trials {
            let Some(map) = self.solve(free, cols) else { return false };
            let mut flip = self.disagreement(&self.maps[map as usize], free, cols, kept, None);
            flip = self.turned().map(|(k, touch)| Flip::Shaft(k, touch)).or(flip);
            if flip.is_none() && self.shares && !self.maps[map as usize].is_redundant {
                for g in 0..self.groups.len() {
                    if self.sign[g] == 0
                        && self.groups[g].shares
                        && let Some(sign) = self.breaks_away(g, None)
                    {
                        flip = Some(Flip::Group(g, sign));
                        break;
                    }
                }
                if flip.is_none() {
                    self.solve(free, cols);
                }
            }
            match flip {
                None => return true,
                Some(Flip::Group(g, sign)) => {
                    let again = sign == 0 && released == Some(g) && kept >> g & 1 == 0;
                    if again {
                        kept |= 1 << g;
                    }
                    released = (sign != 0).then_some(g);
                    if !again || dot(&self.groups[g].row, &self.next).abs() > self.round_off(g) {
                        self.sign[g] = sign;
                    }
                }
                Some(Flip::Shaft(k, touch)) => self.shafts[k].turn(touch),
                Some(Flip::Side(j)) => self.side[j] = self.side[j].other(),
                Some(Flip::Stuck) => return false,
            }
        }
        false
    }
}

impl FixedStep {
    /// Solves the step in a mode that is known to be that of it.
    pub(super) fn solve_known(&mut self) {
        let is_solved = self.widely(Task::Solve);
        debug_assert!(is_solved, "a mode with a fused step has a map");
    }

    /// Solves the step in the present mode; false if that is not its mode, or not by far more than rounding.
    pub(super) fn solve_certain(&mut self) -> bool {
        self.widely(Task::SolveIfFar)
    }

    /// Finds the mode of the step, from the present one on, and the end of the step; false if it was not found so.
    pub(super) fn settle(&mut self) -> bool {
        self.widely(Task::Search)
    }

    /// Does a task with the widest registers there are; false if it found no end of the step.
    fn widely(&mut self, task: Task) -> bool {
        self.arch.dispatch(Widely { step: self, task })
    }
}

/// What is done with the widest registers there are.
enum Task {
    Solve,
    SolveIfFar,
    Search,
}

struct Widely<'a> {
    step: &'a mut FixedStep,
    task: Task,
}

impl pulp::WithSimd for Widely<'_> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> bool {
        let Self { step, task } = self;
        let (free, cols) = (step.engine.system.free, step.tau.len());
        match task {
            Task::Solve => step.solve(free, cols).is_some(),
            Task::SolveIfFar => step.solve_if_far(free, cols),
            Task::Search => step.search(free, cols),
        }
    }
}

enum Flip {
    Group(usize, i8),
    Side(usize),
    Shaft(usize, Touch),
    /// Only groups that are kept would have to be released, or some of several that hold together.
    Stuck,
}
