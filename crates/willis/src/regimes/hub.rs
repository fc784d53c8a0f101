//! Sets whose planets mesh with three or more central gears, as those of Ravigneaux do: their formulas are written in the
//! basic ratios between central gears, not in ratios to the planet.
//!
//! The planet P turns on one carrier and carries no torque of its own, so that its speed and the scale of its forces are
//! free: what it is measured in cancels. One of its elements, the *hub*, to the ring where there is one, is given the ratio
//! one, which measures P by that gear. With `x = i ρ` of each element, the others, its *arms*, become
//!
//! ```text
//! x_a x_h  (a gear that drives P, over the hub's),  x_a / x_h  (P drives the gear, or the hub runs to P too)
//! ```
//!
//! Forces of what leaves P are then measured behind the hub's loss: each power seen there is `ρ_h` times that in front.

use crate::exact::Rational;
use crate::train::MemberKind;

use super::setup::{Pattern, Setup};

/// An element between a central gear and a planet that has a hub.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Arm {
    /// The hub of its planet, among the active elements.
    pub hub: usize,
    /// Whether the planet is the element's second end.
    pub runs_in: bool,
    /// Whether the planet is the hub's first end.
    pub hub_runs_out: bool,
}

impl Arm {
    /// Whether the ratios of arm and hub are multiplied, and not divided.
    pub fn multiplies(self) -> bool {
        self.runs_in && self.hub_runs_out
    }
}

/// What each active element is.
#[derive(Clone, Debug, Default)]
pub(super) struct Hubs {
    arms: Vec<Option<Arm>>,
    hubs: Vec<bool>,
}

impl Hubs {
    pub fn of(setup: &Setup<'_>) -> Self {
        let k = setup.active.len();
        let mut all = Self { arms: vec![None; k], hubs: vec![false; k] };
        let train = setup.c.train;
        for &node in &setup.free {
            let touches = |j: &usize| {
                let e = setup.element(*j);
                [e.p, e.q, e.carrier].iter().any(|m| setup.c.node(*m) == Some(node))
            };
            let touching: Vec<usize> = (0..k).filter(touches).collect();
            let Some(&first) = touching.first() else { continue };
            let carrier = setup.element(first).carrier;
            let is_planet = |j: usize, member| {
                setup.c.node(member) == Some(node)
                    && train.members.get(member.index()).is_some_and(|m| m.kind == MemberKind::Planet)
                    && setup.element(j).carrier == carrier
                    && setup.c.node(carrier) != Some(node)
            };
            // By its first or its second end, never both.
            let runs_out = |j: usize| is_planet(j, setup.element(j).p);
            let runs_in = |j: usize| is_planet(j, setup.element(j).q);
            let plain = |j: &usize| !setup.element(*j).is_rigid() && runs_out(*j) != runs_in(*j);
            if touching.len() < 2 || !touching.iter().all(plain) {
                continue;
            }
            let to_ring = |j: &usize| {
                let link = setup.element(*j).links.last();
                link.is_some_and(|l| train.meshes[l.mesh.index()].gears[usize::from(l.along)].internal)
            };
            let out = || touching.iter().copied().filter(|j| runs_out(*j));
            let hub = out().find(to_ring).or_else(|| out().next()).unwrap_or(touching[touching.len() - 1]);
            all.hubs[hub] = true;
            for j in touching.into_iter().filter(|j| *j != hub) {
                all.arms[j] = Some(Arm { hub, runs_in: runs_in(j), hub_runs_out: runs_out(hub) });
            }
        }
        all
    }

    pub fn is_hub(&self, j: usize) -> bool {
        self.hubs[j]
    }

    pub fn arm(&self, j: usize) -> Option<Arm> {
        self.arms[j]
    }

    /// The ratio of an element, between central gears where it is an arm.
    pub fn ratio(&self, setup: &Setup<'_>, j: usize) -> Rational {
        match self.arms[j] {
            Some(arm) if arm.multiplies() => setup.ratio(j) * setup.ratio(arm.hub),
            Some(arm) => setup.ratio(j) / setup.ratio(arm.hub),
            None if self.hubs[j] => Rational::ONE,
            None => setup.ratio(j),
        }
    }

    /// The hub whose loss stands in front of the force of an element.
    pub fn in_front(&self, j: usize) -> Option<usize> {
        match self.arms[j] {
            Some(arm) => (arm.hub_runs_out && !arm.runs_in).then_some(arm.hub),
            None => {
                let runs_out = self.arms.iter().flatten().any(|arm| arm.hub == j && arm.hub_runs_out);
                (self.hubs[j] && runs_out).then_some(j)
            }
        }
    }

    /// Whether an arm and its hub can share one efficiency, the product of theirs: it is the same either way, and all arms
    /// run in.
    pub fn shares(&self, setup: &Setup<'_>, j: usize) -> bool {
        let one = |j: usize| setup.element(j).forward == setup.element(j).backward;
        let Some(own) = self.arms[j] else { return false };
        let beside = (0..self.arms.len()).filter(|other| self.arms[*other].is_some_and(|a| a.hub == own.hub));
        setup.lossy(own.hub)
            && one(own.hub)
            && beside.into_iter().all(|a| self.arms[a].expect("an arm").multiplies() && one(a))
    }

    /// Whether they do for these drivers: power passes the hub the same way as every arm.
    pub fn is_shared(&self, setup: &Setup<'_>, pattern: &Pattern, hub: usize) -> bool {
        let mut arms = (0..self.arms.len()).filter(|j| self.arms[*j].is_some_and(|a| a.hub == hub));
        pattern[hub].is_some() && arms.all(|j| self.shares(setup, j) && pattern[j] == pattern[hub])
    }
}
