//! The search: every tooth number of a design file, counted and judged.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Mutex;

use serde::{Deserialize, Serialize};
use willis::diagnostic::{Code, Diagnostic, Diagnostics};
use willis::work::{Effort, Work};

use super::answer::Stage;
use super::document::{Design, DesignedSet};
use super::front::Front;
use super::layout::SetKind;
use super::lines::{self, Bounds};
use super::nest::{self, Chosen, Nest, Unit};
use super::range::MOST_TEETH;
use super::space::{Group, Item, SetSpace};
use super::statics::{Point, Way};
use super::wish::Objective;

/// How many there are.
///
/// Example: [`Design`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Found {
    /// Tooth numbers that follow every rule with some number of planets.
    pub trains: u64,
    /// The same with every number of planets and every short planet counted.
    pub designs: u64,
}

/// Tooth numbers of all designed sets.
pub(crate) type Teeth = Vec<Vec<i64>>;

/// A search that is under way, or done: what was counted, and the front so far. It serialises, so that a search can be
/// stopped and resumed, and divided and put together again.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Progress {
    /// What it belongs to: the text of the design file; empty before the search has begun.
    #[serde(default)]
    pub design: String,
    /// Steps of the outermost loop that are done, as ranges `[from, to)`, ascending.
    pub done: Vec<[u64; 2]>,
    /// All steps of the outermost loop.
    pub of: u64,
    /// What is left after each condition.
    pub waterfall: Vec<Stage>,
    /// The front: tooth numbers of every designed set.
    pub front: Vec<Teeth>,
}

impl Progress {
    /// How many steps are done.
    pub fn steps_done(&self) -> u64 {
        self.done.iter().map(|d| d[1].saturating_sub(d[0])).sum()
    }

    /// Whether all steps are done. A search that has not begun does not know how many there are.
    pub fn is_complete(&self) -> bool {
        !self.design.is_empty() && self.steps_done() == self.of
    }
}

/// What is known of tooth numbers without a certificate.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Judged {
    pub error: f64,
    /// Whether all steps are met.
    pub steps: bool,
    pub forward: f64,
    pub backward: f64,
    pub self_locking: bool,
    pub lock_margin: f64,
    pub member_speed: f64,
    pub planet_spin: f64,
    pub element_torque: Option<f64>,
}

/// What must be computed of tooth numbers beside ratios.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Needs {
    pub speeds: bool,
    pub ways: bool,
    pub margin: bool,
}

impl Needs {
    /// Everything.
    pub const ALL: Self = Self { speeds: true, ways: true, margin: true };
}

/// How the space is walked through.
enum Walked<'d> {
    /// A Wolfrom drive by itself: suns, and windows.
    Lines(Vec<i64>, Vec<Bounds>, &'d SetSpace),
    /// Nested windows.
    Nest,
}

/// A result of a part of the search.
struct Part {
    tally: Vec<Stage>,
    front: Front<Teeth>,
}

/// Walks through some steps of the outermost loop.
type Steps<'s> = dyn Fn(std::ops::Range<usize>, &mut dyn Receive) + Sync + 's;

/// A number with the total order of floating point.
#[derive(Clone, Copy, Debug)]
struct Order(f64);

impl PartialEq for Order {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Order {}

impl PartialOrd for Order {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Order {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}

/// Receives what the loops find.
trait Receive {
    /// Tooth numbers of the only set.
    fn single(&mut self, item: &Item);
    /// Groups of items of several sets.
    fn coupled(&mut self, groups: &[&Group]);
}

impl Design {
    /// Counts what satisfies targets, rules and the largest ring, without looking at efficiencies and speeds.
    ///
    /// Example: [`Design`].
    pub fn count(&self) -> Found {
        let mut found = Found::default();
        let mut add = |trains: u64, designs: u64| {
            found.trains += trains;
            found.designs += designs;
        };
        match self.way() {
            Walked::Lines(suns, windows, space) => {
                for s in suns {
                    lines::lines(space, s, &windows, &mut |teeth| {
                        let designs = u64::from(space.admitted(&teeth).count_ones());
                        if designs > 0 {
                            add(1, designs);
                        }
                    });
                }
            }
            Walked::Nest => {
                struct Count<'a>(&'a mut dyn FnMut(u64, u64), usize);
                impl nest::Sink for Count<'_> {
                    fn found(&mut self, chosen: &Chosen<'_, '_>, last: &[Group]) {
                        let Some(first) = last.first() else { return };
                        // Only the innermost loop changes: its sums are multiplied by those of the others.
                        let units = chosen.units(first, self.1);
                        let moving = chosen.innermost();
                        let of = |g: &Group| [last_of(&g.trains), last_of(&g.designs)];
                        let mut outer = [1, 1];
                        for (_, g) in units.iter().enumerate().filter(|(u, _)| *u != moving) {
                            let [t, d] = of(g);
                            outer = [outer[0] * t, outer[1] * d];
                        }
                        let sums = last.iter().map(of).fold([0, 0], |s, g| [s[0] + g[0], s[1] + g[1]]);
                        (self.0)(outer[0] * sums[0], outer[1] * sums[1]);
                    }
                }
                let units = self.units(false);
                let nest = Nest::new(&units, &self.nest_targets());
                let outer = nest.outer();
                nest.walk(0..outer, &willis::work::Serial, &mut Count(&mut add, self.sets.len()));
            }
        }
        found
    }

    /// Calls `found` with the tooth numbers of everything that [`Design::count`] counts as a train, set by set, in a fixed
    /// order.
    pub fn for_each(&self, mut found: impl FnMut(&[&[i64]])) {
        struct All<'a>(&'a mut dyn FnMut(&[&[i64]]));
        impl Receive for All<'_> {
            fn single(&mut self, item: &Item) {
                if item.is_admissible() {
                    (self.0)(&[&item.teeth]);
                }
            }
            fn coupled(&mut self, groups: &[&Group]) {
                let lists: Vec<Vec<&Item>> =
                    groups.iter().map(|g| g.items.iter().filter(|i| i.is_admissible()).collect()).collect();
                let mut teeth: Vec<&[i64]> = vec![];
                product(&lists, &mut teeth, self.0);
            }
        }
        fn product<'i>(lists: &[Vec<&'i Item>], teeth: &mut Vec<&'i [i64]>, found: &mut dyn FnMut(&[&[i64]])) {
            match lists.split_first() {
                None => found(teeth),
                Some((list, rest)) => {
                    for item in list {
                        teeth.push(&item.teeth);
                        product(rest, teeth, found);
                        teeth.pop();
                    }
                }
            }
        }
        self.walk(false, &mut |outer, walk| {
            walk(0..outer, &mut All(&mut found));
        });
    }

    /// Calls `found` with tooth numbers of every combination of basic ratios that [`Design::count`] counts. False where
    /// the work was cancelled before all of them.
    pub(crate) fn for_each_ratio(&self, work: &dyn Work, found: &mut dyn FnMut(&Teeth)) -> bool {
        struct Ratios<'a>(&'a mut dyn FnMut(&Teeth));
        impl Receive for Ratios<'_> {
            fn single(&mut self, item: &Item) {
                if item.is_admissible() {
                    (self.0)(&vec![item.teeth.clone()]);
                }
            }
            fn coupled(&mut self, groups: &[&Group]) {
                let first = |g: &&Group| g.items.iter().find(|i| i.is_admissible()).map(|i| i.teeth.clone());
                if let Some(teeth) = groups.iter().map(first).collect() {
                    (self.0)(&teeth);
                }
            }
        }
        let mut whole = true;
        self.walk(false, &mut |outer, walk| {
            for step in 0..outer {
                if work.cancelled() {
                    whole = false;
                    return;
                }
                walk(step..step + 1, &mut Ratios(&mut *found));
            }
        });
        whole
    }

    /// Calls `found` with every train that satisfies the wish. False where the work was cancelled before all of them were
    /// seen.
    pub(crate) fn for_each_that_meets(
        &self,
        needs: Needs,
        work: &dyn Work,
        found: &mut dyn FnMut(Teeth, Judged),
    ) -> bool {
        struct Meeting<'d> {
            design: &'d Design,
            needs: Needs,
            found: &'d mut dyn FnMut(Teeth, Judged),
        }
        impl Meeting<'_> {
            fn take(&mut self, teeth: Teeth) {
                let Some(judged) = self.design.judge(&teeth, self.needs) else { return };
                if self.design.meets(&judged).all(|m| m) {
                    (self.found)(teeth, judged);
                }
            }
            fn choose(&mut self, lists: &[Vec<&Item>], teeth: &mut Teeth) {
                let Some((first, rest)) = lists.split_first() else { return self.take(teeth.clone()) };
                for item in first {
                    teeth.push(item.teeth.clone());
                    self.choose(rest, teeth);
                    teeth.pop();
                }
            }
        }
        impl Receive for Meeting<'_> {
            fn single(&mut self, item: &Item) {
                if item.is_admissible() {
                    self.take(vec![item.teeth.clone()]);
                }
            }
            fn coupled(&mut self, groups: &[&Group]) {
                let lists: Vec<Vec<&Item>> =
                    groups.iter().map(|g| g.items.iter().filter(|i| i.is_admissible()).collect()).collect();
                self.choose(&lists, &mut vec![]);
            }
        }
        let mut meeting = Meeting { design: self, needs, found };
        let mut whole = true;
        self.walk(false, &mut |outer, walk| {
            work.begin("steps", outer as u64);
            for step in 0..outer {
                if work.cancelled() {
                    whole = false;
                    return;
                }
                walk(step..step + 1, &mut meeting);
                work.advance(1);
            }
        });
        whole
    }

    /// The best of all trains that satisfy the wish, whether others beat them or not: so many, by one objective, ties by the
    /// fewest teeth. None where the work was cancelled before all of them were seen.
    pub(crate) fn best(&self, sort: Objective, most: usize, work: &dyn Work) -> Option<Vec<Teeth>> {
        let needs = Self { objectives: vec![sort], ..self.clone() }.needs();
        // The worst is the last.
        let mut rows: BTreeSet<(Order, Teeth)> = BTreeSet::new();
        let whole = self.for_each_that_meets(needs, work, &mut |teeth, judged| {
            let value = self.value(sort, &judged, &teeth);
            rows.insert((Order(if sort.is_better_high() { -value } else { value }), teeth));
            if rows.len() > most {
                rows.pop_last();
            }
        });
        whole.then(|| rows.into_iter().map(|(_, teeth)| teeth).collect())
    }

    /// The spaces of the sets, in order; sets with the same space share it.
    fn units(&self, every_stage: bool) -> Vec<Unit<'_>> {
        let mut units: Vec<Unit<'_>> = vec![];
        for s in &self.sets {
            let unit = match units.iter().find(|u| *u.space == s.space) {
                Some(same) => same.clone(),
                None => Unit::new(&s.space, every_stage),
            };
            units.push(unit);
        }
        units
    }

    fn nest_targets(&self) -> Vec<nest::Target> {
        let of = |(state, t): &(usize, super::wish::Target)| nest::Target {
            quotient: self.layout.states[*state].ratio.clone(),
            windows: t.ratio.windows.clone(),
        };
        self.targets.iter().filter(|t| !t.1.ratio.is_any()).map(of).collect()
    }

    fn way(&self) -> Walked<'_> {
        if let ([set], [(state, target)]) = (&self.sets[..], &self.targets[..])
            && set.space.kind == SetKind::Wolfrom
            && lines::is_wolfrom(&self.layout.states[*state].ratio)
            && let Some(windows) = lines::bounds(&target.ratio.windows)
        {
            return Walked::Lines(set.space.suns().collect(), windows, &set.space);
        }
        Walked::Nest
    }

    /// Prepares the loops, and hands over how many steps the outermost has and how to walk through some of them.
    fn walk(&self, every_stage: bool, then: &mut dyn FnMut(usize, &Steps<'_>)) {
        struct Each<'a>(&'a mut dyn Receive, usize);
        impl nest::Sink for Each<'_> {
            fn found(&mut self, chosen: &Chosen<'_, '_>, last: &[Group]) {
                for group in last {
                    if self.1 == 1 {
                        group.items.iter().for_each(|i| self.0.single(i));
                    } else {
                        self.0.coupled(&chosen.units(group, self.1));
                    }
                }
            }
        }
        match self.way() {
            Walked::Lines(suns, windows, space) => then(suns.len(), &|range, receive| {
                for s in &suns[range] {
                    lines::lines(space, *s, &windows, &mut |teeth| {
                        let item = space.item(teeth.to_vec());
                        if every_stage || item.is_admissible() {
                            receive.single(&item);
                        }
                    });
                }
            }),
            Walked::Nest => {
                let units = self.units(every_stage);
                let nest = Nest::new(&units, &self.nest_targets());
                then(nest.outer(), &|range, receive| {
                    nest.walk(range, &willis::work::Serial, &mut Each(receive, self.sets.len()));
                });
            }
        }
    }

    /// Targets that no tooth numbers can change and that are not met.
    pub(crate) fn impossible(&self) -> Vec<usize> {
        let misses = |(state, t): &(usize, super::wish::Target)| {
            let q = &self.layout.states[*state].ratio;
            !t.ratio.is_any() && (0..self.layout.variables).all(|v| !q.depends_on(v)) && {
                let ratio = willis::exact::Rational::new(q.numerator.0[0], q.denominator.0[0]);
                !t.ratio.windows.iter().any(|[a, b]| *a <= ratio && ratio <= *b)
            }
        };
        (0..self.targets.len()).filter(|k| misses(&self.targets[*k])).collect()
    }

    /// Names of the conditions, in their order.
    pub(crate) fn conditions(&self) -> Vec<String> {
        let mut all = vec!["ratio".to_owned()];
        all.extend(self.rules.iter().map(|r| r.name().to_owned()));
        if self.limits.ring_diameter.is_some() {
            all.push("ring_diameter".into());
        }
        all.extend(self.conditions_of_motion());
        all
    }

    /// Names of the conditions beyond teeth, in their order.
    pub(crate) fn conditions_of_motion(&self) -> Vec<String> {
        let steps = (!self.steps.is_empty()).then(|| "step".to_owned());
        let later = [
            ("planet_spin", self.limits.planet_spin),
            ("member_speed", self.limits.member_speed),
            ("element_torque", self.limits.element_torque),
            ("forward", self.require.forward),
            ("backward", self.require.backward),
            ("lock_margin", self.require.lock_margin),
        ];
        steps.into_iter().chain(later.into_iter().filter(|l| l.1.is_some()).map(|l| l.0.to_owned())).collect()
    }

    /// Which conditions beyond teeth are met, in the order of [`Design::conditions`].
    pub(crate) fn meets(&self, j: &Judged) -> impl Iterator<Item = bool> {
        let most = |limit: Option<f64>, value: f64| limit.map(|l| value <= l);
        let least = |limit: Option<f64>, value: f64| limit.map(|l| value >= l);
        [
            (!self.steps.is_empty()).then_some(j.steps),
            most(self.limits.planet_spin, j.planet_spin),
            most(self.limits.member_speed, j.member_speed),
            most(self.limits.element_torque, j.element_torque.unwrap_or(0.0)),
            least(self.require.forward, j.forward),
            least(self.require.backward, j.backward),
            least(self.require.lock_margin, j.lock_margin),
        ]
        .into_iter()
        .flatten()
    }

    /// How much work it is, before it begins: an estimate from the sizes of the loops.
    ///
    /// # Errors
    /// Spaces so large that not even their lists could be made.
    pub fn effort(&self) -> Result<Effort, Diagnostics> {
        let size = |c: &super::range::Counts| c.within(1, MOST_TEETH).count() as f64;
        let mut lists = 0.0;
        let mut product = 1.0;
        for s in &self.sets {
            let [sun, planet, _] = seeds(s.space.kind);
            let mut own =
                size(&s.space.gears[sun]) * self.planets_between(&s.space, planet) * s.space.mismatch.len() as f64;
            if matches!(s.space.kind, SetKind::Stepped | SetKind::Rings) {
                own *= self.planets_between(&s.space, 2);
            }
            if own > 3e7 {
                let message =
                    format!("set `{}` has {own:.0} choices of its first gears; 30 million are the most", s.name);
                return Err(Diagnostic::new(Code::TooLong, format!("set[{}]", s.index), message)
                    .hint("give the ring an upper end, or narrow the ranges")
                    .into());
            }
            lists += own;
            product *= s.space.size();
        }
        // A window leaves of a loop about the share that it is of a doubling of the ratio; the outermost stays whole.
        let wide = |(_, t): &(usize, super::wish::Target)| {
            let width = |[a, b]: &[willis::exact::Rational; 2]| {
                let (a, b) = (a.to_f64().abs(), b.to_f64().abs());
                2.0 * (a - b).abs() / (a + b).max(1e-300)
            };
            if t.ratio.is_any() { 1.0 } else { t.ratio.windows.iter().map(width).sum::<f64>().clamp(1e-3, 1.0) }
        };
        let mut shares: Vec<f64> = self.targets.iter().map(wide).collect();
        shares.sort_by(f64::total_cmp);
        shares.truncate(self.layout.variables);
        let nodes = match self.way() {
            Walked::Lines(..) => lists * self.targets[0].1.ratio.windows.len() as f64,
            Walked::Nest => lists + product * shares.iter().product::<f64>(),
        };
        Ok(Effort::new("candidates", product.min(1.8e19) as u64, 3e-7 * nodes / product.max(1.0)))
    }

    fn planets_between(&self, space: &SetSpace, gear: usize) -> f64 {
        let ring = space.gears.iter().filter_map(super::range::Counts::most).max().unwrap_or(MOST_TEETH);
        space.gears[gear].within(1, ring.min(MOST_TEETH) / if gear == 3 { 1 } else { 2 } + 2).count() as f64
    }

    /// Searches what is not done yet, in as many parts as there are steps of the outermost loop, and stops between parts
    /// when the work is cancelled. The result of parts does not depend on their order.
    ///
    /// # Errors
    /// The space is too large, takes longer than the work's patience, or the progress is that of another design.
    pub fn search(
        &self,
        mut progress: Progress,
        shard: Option<(u64, u64)>,
        work: &dyn Work,
    ) -> Result<Progress, Diagnostics> {
        self.owns(&progress)?;
        work.afford(&self.effort()?).map_err(Diagnostics::from)?;
        self.walk(true, &mut |outer, walk| {
            progress.design.clone_from(&self.text);
            progress.of = outer as u64;
            if progress.waterfall.is_empty() {
                progress.waterfall = self.empty_tally();
            }
            let (from, to) = match shard {
                Some((number, of)) if of > 0 => {
                    let cut = |k: u64| (u128::from(k) * outer as u128 / u128::from(of)) as usize;
                    (cut(number.saturating_sub(1)), cut(number.min(of)))
                }
                _ => (0, outer),
            };
            let is_done = |k: usize| progress.done.iter().any(|d| (d[0]..d[1]).contains(&(k as u64)));
            let steps: Vec<usize> = (from..to).filter(|k| !is_done(*k)).collect();
            // Enough parts for progress, few enough to be cheap.
            let size = (steps.len() / 256).max(1);
            let parts: Vec<&[usize]> = steps.chunks(size).collect();
            let results: Vec<Mutex<Option<Part>>> = parts.iter().map(|_| Mutex::new(None)).collect();
            work.begin("steps", steps.len() as u64);
            work.run(parts.len(), &|k| {
                let mut judge = Judge {
                    design: self,
                    part: Part { tally: self.empty_tally(), front: Front::default() },
                    single: self.sets.len() == 1,
                    needs: self.needs(),
                };
                for run in runs(parts[k]) {
                    walk(run, &mut judge);
                }
                *results[k].lock().unwrap_or_else(std::sync::PoisonError::into_inner) = Some(judge.part);
                work.advance(parts[k].len() as u64);
            });
            let needs = self.needs();
            let mut front = Front::default();
            for teeth in std::mem::take(&mut progress.front) {
                if let Some(judged) = self.judge(&teeth, needs) {
                    front.offer(self.point(&judged, &teeth), teeth);
                }
            }
            for (k, result) in results.into_iter().enumerate() {
                if let Some(part) = result.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner) {
                    add(&mut progress.waterfall, &part.tally);
                    front.merge(part.front);
                    progress.done.extend(runs(parts[k]).map(|r| [r.start as u64, r.end as u64]));
                }
            }
            progress.done = joined(std::mem::take(&mut progress.done));
            progress.front = front.into_sorted().into_iter().map(|(_, teeth)| teeth).collect();
        });
        Ok(progress)
    }

    /// Refuses the progress of another design, and one that no search has written.
    pub(crate) fn owns(&self, progress: &Progress) -> Result<(), Diagnostics> {
        if *progress == Progress::default() {
            return Ok(());
        }
        let refused = |message: &str, hint: &str| Err(Diagnostic::new(Code::Unfit, "", message).hint(hint).into());
        if progress.design != self.text {
            let message = "the progress of a search for another design cannot be used for this one";
            return refused(message, "give the design file with which it was begun");
        }
        let are_teeth = |teeth: &Teeth| {
            let fits = |(z, s): (&Vec<i64>, &DesignedSet)| {
                z.len() == s.space.kind.gears().len() && z.iter().all(|z| (1..=MOST_TEETH).contains(z))
            };
            teeth.len() == self.sets.len() && teeth.iter().zip(&self.sets).all(fits)
        };
        let conditions = self.conditions();
        let is_own = progress.done.iter().all(|d| d[0] < d[1] && d[1] <= progress.of)
            && progress.done.windows(2).all(|w| w[0][1] <= w[1][0])
            && progress.waterfall.iter().map(|s| &s.condition).eq(&conditions)
            && progress.front.iter().all(are_teeth);
        if is_own {
            return Ok(());
        }
        refused("this progress was not written by a search for this design", "begin the search anew")
    }

    /// Two parts of one search as one.
    ///
    /// # Errors
    /// They are of different searches, or overlap.
    pub fn merge(&self, a: Progress, b: Progress) -> Result<Progress, Diagnostics> {
        self.owns(&a)?;
        self.owns(&b)?;
        if a == Progress::default() {
            return Ok(b);
        }
        let overlap = a.done.iter().any(|x| b.done.iter().any(|y| x[0] < y[1] && y[0] < x[1]));
        if a.of != b.of || overlap || a.waterfall.len() != b.waterfall.len() {
            let message =
                if overlap { "these parts of a search overlap" } else { "these are parts of different searches" };
            return Err(Diagnostic::new(Code::Conflict, "", message).into());
        }
        let mut whole = a;
        add(&mut whole.waterfall, &b.waterfall);
        whole.done = joined(whole.done.into_iter().chain(b.done).collect());
        let needs = self.needs();
        let mut front = Front::default();
        for teeth in whole.front.into_iter().chain(b.front) {
            if let Some(judged) = self.judge(&teeth, needs) {
                front.offer(self.point(&judged, &teeth), teeth);
            }
        }
        whole.front = front.into_sorted().into_iter().map(|(_, teeth)| teeth).collect();
        Ok(whole)
    }

    fn empty_tally(&self) -> Vec<Stage> {
        let planets: Vec<i64> = if self.sets.len() == 1 { self.sets[0].space.planets.clone() } else { vec![] };
        let stage = |condition: String| Stage {
            condition,
            trains: 0,
            designs: 0,
            by_planets: planets.iter().map(|n| (n.to_string(), 0)).collect(),
        };
        self.conditions().into_iter().map(stage).collect()
    }

    /// What tooth numbers amount to; none where the train is singular.
    pub(crate) fn judge(&self, teeth: &Teeth, what: Needs) -> Option<Judged> {
        // Bands of several equilibria are those of Wolfrom drives; the others are certified when they are shown.
        let quick = self.sets.len() > 1;
        let numbers: Vec<Option<&[i64]>> = (0..self.layout.kinds.len())
            .map(|k| {
                let name = &self.layout.sets[k];
                self.sets.iter().position(|s| s.name == *name).map(|p| teeth[p].as_slice())
            })
            .collect();
        let of = |set: usize| numbers[set].unwrap_or(&[]);
        let mut judged = Judged {
            error: 0.0,
            steps: self.steps.iter().all(|s| self.step_is_met(s, teeth)),
            forward: 1.0,
            backward: 1.0,
            self_locking: false,
            lock_margin: f64::INFINITY,
            member_speed: 0.0,
            planet_spin: 0.0,
            element_torque: None,
        };
        let y = self.variables(teeth);
        for (state, target) in &self.targets {
            let state = &self.layout.states[*state];
            judged.error = judged.error.max(target.ratio.deviation(state.ratio.at(&y)));
            if what == Needs::default() {
                continue;
            }
            let Some(point) = Point::new(&self.layout, state, &of) else {
                // Equations repeat each other: the certified solver says what it can.
                self.certified_ways(teeth, &target.state, &mut judged);
                continue;
            };
            if what.speeds {
                judged.member_speed = judged.member_speed.max(point.largest_speed());
                judged.planet_spin = judged.planet_spin.max(point.planet_spin(&of));
                judged.element_torque = match (judged.element_torque, point.largest_element_torque()) {
                    (Some(a), Some(b)) => Some(a.max(b)),
                    (a, b) => a.or(b),
                };
            }
            if !what.ways && !what.margin {
                continue;
            }
            let (forward, backward) = (point.efficiency(true, 1.0, quick), point.efficiency(false, 1.0, quick));
            if forward == Way::Unclear || backward == Way::Unclear {
                self.certified_ways(teeth, &target.state, &mut judged);
            } else {
                let value = |w: &Way| match w {
                    Way::One(e) => e.min(1.0),
                    // The worst that may happen.
                    Way::Several(_, [low, _]) => low.clamp(0.0, 1.0),
                    Way::Locks | Way::Unclear => 0.0,
                };
                judged.forward = judged.forward.min(value(&forward));
                judged.backward = judged.backward.min(value(&backward));
                judged.self_locking |= backward == Way::Locks;
            }
            if what.margin {
                judged.lock_margin = judged.lock_margin.min(point.lock_margin().unwrap_or(f64::INFINITY));
            }
        }
        Some(judged)
    }

    /// Whether the step from a state to the next lies in its window; at the ends exact numbers decide.
    fn step_is_met(&self, (ends, step): &([usize; 2], super::wish::Step), teeth: &Teeth) -> bool {
        let y = self.variables(teeth);
        let [a, b] = ends.map(|k| self.layout.states[self.targets[k].0].ratio.at(&y));
        let [low, high] = [step.window[0].to_f64(), step.window[1].to_f64()];
        let found = a / b;
        let at_an_end = |end: f64| (found - end).abs() <= 1e-9 * end;
        if at_an_end(low) || at_an_end(high) {
            let states = self.certified(teeth);
            let exact = |name: &str| states.as_ref()?.get(name)?.exact.clone();
            if let Some((a, b)) = exact(&step.state).zip(exact(&step.next)).filter(|(_, b)| !b.is_zero()) {
                let exact = &a / &b;
                return step.window[0] <= exact && exact <= step.window[1];
            }
        }
        low <= found && found <= high
    }

    /// What objectives, limits and demands need to know.
    pub(crate) fn needs(&self) -> Needs {
        let has = |all: &[Objective]| all.iter().any(|o| self.objectives.contains(o));
        let (l, r) = (&self.limits, &self.require);
        Needs {
            speeds: has(&[Objective::PlanetSpin, Objective::MemberSpeed, Objective::ElementTorque])
                || [l.planet_spin, l.member_speed, l.element_torque].iter().any(Option::is_some),
            ways: has(&[Objective::Forward, Objective::Backward]) || r.forward.is_some() || r.backward.is_some(),
            margin: has(&[Objective::LockMargin]) || r.lock_margin.is_some(),
        }
    }

    /// The basic ratios at tooth numbers.
    pub(crate) fn variables(&self, teeth: &Teeth) -> Vec<f64> {
        let mut y = vec![0.0; self.layout.variables];
        for (k, name) in self.layout.sets.iter().enumerate() {
            let Some(p) = self.sets.iter().position(|s| s.name == *name) else { continue };
            let z: Vec<f64> = teeth[p].iter().map(|z| *z as f64).collect();
            let own = match self.sets[p].space.kind {
                SetKind::Simple => vec![z[2] / z[0]],
                SetKind::Wolfrom => vec![z[2] / z[0], z[1] * z[4] / (z[0] * z[3])],
                SetKind::Stepped | SetKind::Rings => vec![z[3] * z[1] / (z[0] * z[2])],
                SetKind::Ravigneaux => vec![z[3] / z[1], z[3] / z[0]],
            };
            y[self.layout.first[k]..][..own.len()].copy_from_slice(&own);
        }
        y
    }

    /// The largest ring: reference diameter in metres, or in modules where none is given.
    pub(crate) fn ring(&self, teeth: &Teeth) -> f64 {
        let of = |(s, z): (&super::document::DesignedSet, &Vec<i64>)| {
            let teeth = s.space.ring(z);
            teeth as f64 * self.module(s, teeth).unwrap_or(1.0)
        };
        self.sets.iter().zip(teeth).map(of).fold(0.0, f64::max)
    }

    /// The module that a set with such a ring has, m; none where diameters are in modules.
    pub(crate) fn module(&self, set: &DesignedSet, ring: i64) -> Option<f64> {
        let small = self.objectives.contains(&Objective::RingDiameter);
        set.module(ring, self.limits.ring_diameter, small).filter(|_| self.metric)
    }

    /// The value of an objective.
    pub(crate) fn value(&self, objective: Objective, judged: &Judged, teeth: &Teeth) -> f64 {
        match objective {
            Objective::Error => judged.error,
            Objective::RingDiameter => self.ring(teeth),
            Objective::Forward => judged.forward,
            Objective::Backward => judged.backward,
            Objective::LockMargin => judged.lock_margin,
            Objective::PlanetSpin => judged.planet_spin,
            Objective::MemberSpeed => judged.member_speed,
            Objective::ElementTorque => judged.element_torque.unwrap_or(0.0),
        }
    }

    /// Objectives, all to be minimised.
    pub(crate) fn point(&self, judged: &Judged, teeth: &Teeth) -> Vec<f64> {
        let of = |o: &Objective| {
            let value = self.value(*o, judged, teeth);
            if o.is_better_high() { -value } else { value }
        };
        self.objectives.iter().map(of).collect()
    }
}

/// The gears that the first variable of a set is made of.
fn seeds(kind: SetKind) -> [usize; 3] {
    match kind {
        SetKind::Simple | SetKind::Wolfrom | SetKind::Stepped | SetKind::Rings => [0, 1, 2],
        SetKind::Ravigneaux => [1, 2, 3],
    }
}

fn last_of(counts: &[u64]) -> u64 {
    counts.last().copied().unwrap_or(0)
}

fn add(to: &mut [Stage], from: &[Stage]) {
    for (a, b) in to.iter_mut().zip(from) {
        a.trains += b.trains;
        a.designs += b.designs;
        for (x, y) in a.by_planets.0.iter_mut().zip(&b.by_planets.0) {
            x.1 += y.1;
        }
    }
}

/// Numbers in a row as ranges.
fn runs(steps: &[usize]) -> impl Iterator<Item = std::ops::Range<usize>> + '_ {
    steps.chunk_by(|a, b| a + 1 == *b).map(|c| c[0]..c[c.len() - 1] + 1)
}

/// Ranges in order, neighbours joined.
fn joined(mut ranges: Vec<[u64; 2]>) -> Vec<[u64; 2]> {
    ranges.sort_unstable();
    let mut all: Vec<[u64; 2]> = vec![];
    for r in ranges {
        match all.last_mut().filter(|l| l[1] >= r[0]) {
            Some(last) => last[1] = last[1].max(r[1]),
            None => all.push(r),
        }
    }
    all
}

/// Counts and judges what the loops find.
struct Judge<'d> {
    design: &'d Design,
    part: Part,
    single: bool,
    needs: Needs,
}

impl Judge<'_> {
    /// Takes one class of each set in turn.
    fn choose(&mut self, from: usize, classes: &[Vec<Class<'_>>], teeth: &mut Teeth, [trains, designs]: [u64; 2]) {
        let Some((first, rest)) = classes.split_first() else {
            return self.further(from, teeth.clone(), trains, designs, &[]);
        };
        for class in first {
            teeth.push(class.smallest.to_vec());
            let counts = [trains.saturating_mul(class.counts[0]), designs.saturating_mul(class.counts[1])];
            self.choose(from, rest, teeth, counts);
            teeth.pop();
        }
    }

    /// Beyond the stages of teeth: judges, counts, and offers to the front.
    fn further(&mut self, from: usize, teeth: Teeth, trains: u64, designs: u64, by_planets: &[u64]) {
        let design = self.design;
        let Some(judged) = design.judge(&teeth, self.needs) else { return };
        for (stage, meets) in self.part.tally[from..].iter_mut().zip(design.meets(&judged)) {
            if !meets {
                return;
            }
            stage.trains += trains;
            stage.designs += designs;
            for (x, n) in stage.by_planets.0.iter_mut().zip(by_planets) {
                x.1 += n;
            }
        }
        let point = design.point(&judged, &teeth);
        if !self.part.front.refuses(&point) {
            self.part.front.offer(point, teeth);
        }
    }
}

impl Receive for Judge<'_> {
    fn single(&mut self, item: &Item) {
        let stages = item.passed.len();
        for (s, stage) in self.part.tally.iter_mut().enumerate().take(stages) {
            stage.trains += u64::from(item.passed[s] != 0);
            stage.designs += item.designs(s);
            for (x, n) in stage.by_planets.0.iter_mut().zip(item.by_planets(s)) {
                x.1 += n;
            }
        }
        if item.is_admissible() {
            let by: Vec<u64> = item.by_planets(stages - 1).collect();
            self.further(stages, vec![item.teeth.clone()], 1, by.iter().sum(), &by);
        }
        debug_assert!(self.single);
    }

    fn coupled(&mut self, groups: &[&Group]) {
        let stages = groups[0].trains.len();
        let all = |of: &dyn Fn(&Group) -> u64| groups.iter().map(|g| of(g)).fold(1u64, u64::saturating_mul);
        for (s, stage) in self.part.tally.iter_mut().enumerate().take(stages) {
            stage.trains += all(&|g| g.trains[s]);
            stage.designs += all(&|g| g.designs[s]);
        }
        if all(&|g| last_of(&g.trains)) > 0 {
            let sets = groups.iter().zip(&self.design.sets);
            let classes: Vec<Vec<Class<'_>>> = sets.map(|(g, s)| classes(g, &s.space, self.needs.speeds)).collect();
            self.choose(stages, &classes, &mut vec![], [1, 1]);
        }
    }
}

/// Items of a group that move alike: the smallest stands for them, trains and designs are counted.
struct Class<'g> {
    smallest: &'g [i64],
    counts: [u64; 2],
}

/// The admissible items of a group by how they move. Members move alike in all of them, planets where also what sets their
/// speed is the same.
fn classes<'g>(group: &'g Group, space: &SetSpace, with_planets: bool) -> Vec<Class<'g>> {
    let mut all: BTreeMap<_, Class<'g>> = BTreeMap::new();
    for item in group.items.iter().filter(|i| i.is_admissible()) {
        let teeth = &item.teeth[..];
        let key = with_planets.then(|| space.planet_class(teeth));
        let class = all.entry(key).or_insert(Class { smallest: teeth, counts: [0, 0] });
        class.counts[0] += 1;
        class.counts[1] += item.designs(item.passed.len() - 1);
        let size = |z: &'g [i64]| (space.ring(z), z);
        class.smallest = [class.smallest, teeth].into_iter().min_by_key(|z| size(z)).unwrap_or(teeth);
    }
    all.into_values().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use willis::Model;
    use willis::analysis::{Selection, Verdict, analyze};

    /// A train of the repository, which is no part of the package.
    macro_rules! example {
        ($name:literal) => {
            include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/", $name))
        };
    }

    /// A sun on one step of the planets, a held ring on the other.
    const STEPPED: &str = r#"
format = 1
name = "stepped"
members = ["sun", "carrier"]
terminals = ["sun", "carrier"]
[[set]]
name = "P1"
type = "stepped"
suns = [{ member = "sun", teeth = 20, planet_teeth = 40 }]
rings = [{ member = "frame", teeth = 80, planet_teeth = 20 }]
carrier = "carrier"
mesh_efficiency = { external = 0.98, internal = 0.99 }
"#;

    /// Two rings on two steps, driven by the carrier.
    const RINGS: &str = r#"
format = 1
name = "two rings, stepped"
members = ["carrier", "ring"]
terminals = ["carrier", "ring"]
[[set]]
name = "P1"
type = "stepped"
rings = [{ member = "frame", teeth = 80, planet_teeth = 30 }, { member = "ring", teeth = 76, planet_teeth = 26 }]
carrier = "carrier"
mesh_efficiency = { external = 0.98, internal = 0.99 }
"#;

    /// Trains of the repository: the text, and for each designed set its gears as ranges.
    fn cases() -> Vec<(&'static str, Vec<(&'static str, &'static str)>)> {
        vec![
            (
                STEPPED,
                vec![
                    ("P1.suns.0.teeth", "18..22"),
                    ("P1.suns.0.planet_teeth", "38..42"),
                    ("P1.rings.0.planet_teeth", "18..22"),
                    ("P1.rings.0.teeth", "70..90"),
                ],
            ),
            (
                RINGS,
                vec![
                    ("P1.rings.0.teeth", "76..84"),
                    ("P1.rings.0.planet_teeth", "28..32"),
                    ("P1.rings.1.planet_teeth", "24..30"),
                    ("P1.rings.1.teeth", "60..90"),
                ],
            ),
            (
                example!("zf-8hp70.toml"),
                vec![
                    ("P1.sun.teeth", "40, 48"),
                    ("P1.ring.teeth", "96"),
                    ("P2.sun.teeth", "45, 48"),
                    ("P2.ring.teeth", "95, 96"),
                    ("P3.sun.teeth", "69, 71"),
                    ("P4.sun.teeth", "23, 25"),
                ],
            ),
            (
                example!("zf-6hp26.toml"),
                vec![("front.sun.teeth", "35..38"), ("rear.small_sun.teeth", "29..33"), ("rear.large_sun.teeth", "38")],
            ),
            (
                example!("wolfrom-498-self-locking.toml"),
                vec![
                    ("P1.suns.0.teeth", "12..14"),
                    ("P1.suns.0.planet_teeth", "33..36"),
                    ("P1.rings.0.planet_teeth", "33..36"),
                    ("P1.rings.0.teeth", "..90"),
                    ("P1.rings.1.planet_teeth", "30..38"),
                    ("P1.rings.1.teeth", "..90"),
                ],
            ),
            (
                example!("simpson-ford-c4.toml"),
                vec![("front.sun.teeth", "32..35"), ("rear.sun.teeth", "33"), ("rear.ring.teeth", "69..75")],
            ),
        ]
    }

    fn design(text: &str, ranges: &[(&str, &str)], rules: &str) -> Design {
        let mut document: toml_edit::DocumentMut = text.parse().unwrap();
        let model = Model::from_toml(text).unwrap();
        for (path, range) in ranges {
            let parts: Vec<&str> = path.split('.').collect();
            let sets = document["set"].as_array_of_tables_mut().unwrap();
            let mut item = &mut toml_edit::Item::None;
            for t in sets.iter_mut() {
                if t["name"].as_str() == Some(parts[0]) {
                    item = t.get_mut(parts[1]).unwrap();
                    break;
                }
            }
            if let Ok(k) = parts[2].parse::<usize>() {
                let table = item.as_array_mut().unwrap().get_mut(k).unwrap().as_inline_table_mut().unwrap();
                table.insert(parts[3], (*range).into());
            } else {
                item[parts[2]] = toml_edit::value(*range);
            }
        }
        let ratios = analyze(model.train(), &Selection::default()).unwrap().ratios;
        let targets: Vec<String> = ratios
            .iter()
            .filter(|(_, r)| r.value.is_some_and(|v| v != 1.0))
            .map(|(n, r)| {
                let state = if n == "as drawn" { String::new() } else { format!("state = \"{n}\", ") };
                format!("{{ {state}ratio = {:.4}, tolerance = 0.5, any_sign = true }}", r.value.unwrap())
            })
            .collect();
        let wishes = format!("[design]\nmismatch = \"-1..1\"\nrules = {rules}\ntarget = [{}]", targets.join(", "));
        let wishes: toml_edit::DocumentMut = wishes.parse().unwrap();
        document["design"] = wishes["design"].clone();
        let text = document.to_string();
        Design::from_toml(&text).unwrap_or_else(|e| panic!("{}", e.render("design", &text, false)))
    }

    /// Every train of small spaces: ratios, efficiencies and verdicts are those of the certified solver.
    #[test]
    fn what_is_judged_is_what_is_certified() {
        for (text, ranges) in cases() {
            let design = design(text, &ranges, "[]");
            let mut all: Vec<Teeth> = vec![];
            design.for_each(|t| all.push(t.iter().map(|z| z.to_vec()).collect()));
            assert!(all.len() > 3, "{}: {}", design.name, all.len());
            for teeth in all.iter().step_by((all.len() / 12).max(1)) {
                let states = design.certified(teeth).unwrap();
                let y = design.variables(teeth);
                for (k, target) in &design.targets {
                    let row = states.get(&target.state).unwrap();
                    let value = design.layout.states[*k].ratio.at(&y);
                    assert!(
                        (value / row.value.unwrap() - 1.0).abs() < 1e-9,
                        "{} {teeth:?} {}",
                        design.name,
                        target.state
                    );
                    let mut one = design.clone();
                    one.targets.retain(|t| t.0 == *k);
                    let judged = one.judge(teeth, Needs { ways: true, ..Needs::default() }).unwrap();
                    for (direction, mine) in [(&row.drive, judged.forward), (&row.coast, judged.backward)] {
                        let expected = match direction.verdict {
                            Verdict::Unique => direction.efficiency.unwrap(),
                            Verdict::Locked => 0.0,
                            other => panic!("{} {teeth:?} {}: {other:?}", design.name, target.state),
                        };
                        assert!(
                            (mine - expected).abs() < 1e-9,
                            "{} {teeth:?} {}: {mine} {expected}",
                            design.name,
                            target.state
                        );
                    }
                    assert_eq!(judged.self_locking, row.coast.verdict == Verdict::Locked);
                }
            }
        }
    }

    /// Windows find what trying every tooth number finds, with the ratios of the certified solver.
    #[test]
    fn windows_find_what_brute_force_finds() {
        for (text, ranges) in cases() {
            let wide = design(text, &ranges, "[]");
            let mut all: Vec<Teeth> = vec![];
            wide.for_each(|t| all.push(t.iter().map(|z| z.to_vec()).collect()));
            let mut product = 1;
            for s in &wide.sets {
                product *= s.space.all().count();
            }
            for percent in [2, 5, 12] {
                let mut narrow = wide.clone();
                let tolerance = willis::exact::Rational::new(percent, 100);
                for (_, t) in &mut narrow.targets {
                    t.ratio = super::super::wish::Ratio::near(t.ratio.aim.clone(), &tolerance, false);
                }
                // The brute way: every combination of teeth, each ratio by elimination in rationals.
                let lists: Vec<Vec<Vec<i64>>> = narrow.sets.iter().map(|s| s.space.all().collect()).collect();
                let mut brute = 0;
                for k in 0..product {
                    let mut rest = k;
                    let teeth: Teeth = lists
                        .iter()
                        .map(|l| {
                            let item = l[rest % l.len()].clone();
                            rest /= l.len();
                            item
                        })
                        .collect();
                    // Floating point first: most are far away.
                    let y = narrow.variables(&teeth);
                    let off = |f: f64| {
                        narrow.targets.iter().all(|(s, t)| {
                            t.ratio.deviation(narrow.layout.states[*s].ratio.at(&y)) <= f * percent as f64 / 100.0
                        })
                    };
                    if !off(1.05) {
                        continue;
                    }
                    let states = narrow.certified(&teeth).unwrap();
                    brute += u64::from(narrow.targets.iter().all(|(_, t)| {
                        let ratio = states.get(&t.state).and_then(|r| r.exact.clone());
                        ratio.is_some_and(|r| t.ratio.windows.iter().any(|[a, b]| *a <= r && r <= *b))
                    }));
                }
                assert_eq!(narrow.count().trains, brute, "{} {percent} %", narrow.name);
            }
        }
    }

    /// A designed set with a second one behind it, both with these tables.
    fn two_sets(first: &str, second: &str, wish: &str) -> Design {
        let text = format!(
            r#"
            format = 1
            name = "two"
            members = ["a", "c1", "b", "c2"]
            terminals = ["a", "c2"]
            [design]
            {wish}
            [[set]]
            name = "P1"
            mesh_efficiency = 0.99
            carrier = "c1"
            {first}
            [[set]]
            name = "P2"
            mesh_efficiency = 0.99
            carrier = "c2"
            {second}
            "#
        );
        Design::from_toml(&text).unwrap_or_else(|e| panic!("{}", e.render("design", &text, false)))
    }

    /// Coupled sets under limits, and the front: what every train by itself gives.
    #[test]
    fn coupled_sets_are_judged_like_every_train_by_itself() {
        struct Patient;
        impl Work for Patient {
            fn patience(&self) -> f64 {
                f64::INFINITY
            }
        }
        let fixed = |sun: &str| {
            format!(
                "sun = {{ member = \"{sun}\", teeth = \"30\" }}\nring = {{ member = \"frame\", teeth = \"70\" }}\n\
                 planet = {{ teeth = \"20\", count = 4 }}"
            )
        };
        let simple = "sun = { member = \"a\", teeth = \"30, 35\" }\nplanet = { teeth = \"12..40\", count = \"2, 3\" }\n\
                      ring = { member = \"frame\", teeth = \"72, 84\" }";
        let wolfrom = "type = \"stepped\"\nsuns = [{ member = \"a\", teeth = \"12..24\", planet_teeth = \"15..30\" }]\n\
                       rings = [{ member = \"frame\", teeth = \"40..80\", planet_teeth = \"15..30\" }, \
                       { member = \"b\", teeth = \"40..80\", planet_teeth = \"15..30\" }]";
        let mut all = vec![
            two_sets(simple, &fixed("c1"), "mismatch = [-2, 0, 2]\ntarget = [{ ratio = [9, 14] }]"),
            two_sets(wolfrom, &fixed("b"), "mismatch = [-2, 0, 2]\ntarget = [{ ratio = [150, 155] }]"),
        ];
        all.extend(cases().iter().filter(|c| !c.0.contains("stepped")).map(|(t, r)| design(t, r, "[]")));
        for mut design in all {
            assert!(design.sets.len() > 1);
            design.objectives = vec![Objective::PlanetSpin, Objective::RingDiameter];
            let mut brute: Vec<(Teeth, Judged)> = vec![];
            design.for_each(|t| {
                let teeth: Teeth = t.iter().map(|z| z.to_vec()).collect();
                let judged = design.judge(&teeth, Needs { speeds: true, ..Needs::default() }).unwrap();
                brute.push((teeth, judged));
            });
            let mut spins: Vec<f64> = brute.iter().map(|b| b.1.planet_spin).collect();
            spins.sort_by(f64::total_cmp);
            assert!(spins.len() > 3, "{}", design.name);
            for limit in [None, Some(spins[0]), Some(spins[spins.len() / 3]), Some(spins[spins.len() * 3 / 4])] {
                // Away from ties of rounding.
                design.limits.planet_spin = limit.map(|l| l * (1.0 + 1e-9));
                let found = design.search(Progress::default(), None, &Patient).unwrap();
                let (mut trains, mut designs, mut front) = (0, 0, Front::default());
                for (teeth, judged) in brute.iter().filter(|b| design.meets(&b.1).all(|m| m)) {
                    let items = teeth.iter().zip(&design.sets).map(|(z, s)| s.space.item(z.clone()));
                    trains += 1;
                    designs += items.map(|i| i.designs(i.passed.len() - 1)).product::<u64>();
                    front.offer(design.point(judged, teeth), teeth.clone());
                }
                let last = found.waterfall.last().unwrap();
                assert_eq!((last.trains, last.designs), (trains, designs), "{} {limit:?}", design.name);
                let rounded = |p: Vec<f64>| p.iter().map(|x| (x * 1e6).round() as i64).collect::<Vec<_>>();
                let mut points: Vec<_> = front.into_sorted().into_iter().map(|p| rounded(p.0)).collect();
                points.dedup();
                let mut own: Vec<_> = found
                    .front
                    .iter()
                    .map(|t| rounded(design.point(&design.judge(t, Needs::ALL).unwrap(), t)))
                    .collect();
                own.dedup();
                assert_eq!(own, points, "{} {limit:?}", design.name);
            }
        }
    }

    #[test]
    fn a_fixed_second_set_takes_no_train_away() {
        let first = "sun = { member = \"a\", teeth = 30 }\nplanet = { teeth = \"12..40\" }\n\
                     ring = { member = \"frame\", teeth = 72 }";
        let second = "sun = { member = \"c1\", teeth = \"30\" }\nplanet = { teeth = \"20\", count = 4 }\n\
                      ring = { member = \"frame\", teeth = \"70\" }";
        let wish = "mismatch = [-2, 0, 2]\nlimits = { planet_spin = 1.0 }\ntarget = [{ ratio = [9, 14] }]";
        let design = two_sets(first, second, wish);
        let found = design.search(Progress::default(), None, &willis::work::Serial).unwrap();
        assert_eq!(found.waterfall.last().unwrap().trains, 1);
    }

    #[test]
    fn a_search_knows_what_it_is_of() {
        use super::super::report::Request;
        let serial = &willis::work::Serial;
        let wish = |ratio: &str| {
            let second = "sun = { member = \"c1\", teeth = \"30\" }\nplanet = { teeth = \"20\", count = 4 }\n\
                          ring = { member = \"frame\", teeth = \"70\" }";
            two_sets(
                "sun = { member = \"a\", teeth = \"20..30\" }\nplanet = { teeth = \"12..40\" }\n\
                 ring = { member = \"frame\", teeth = 72 }",
                second,
                &format!("target = [{{ ratio = {ratio} }}]"),
            )
        };
        let (one, other) = (wish("12"), wish("14"));
        // Not begun: it claims nothing.
        let answer = one.answer_of(Progress::default(), &Request::default(), serial).unwrap();
        assert!(!answer.completeness.complete && answer.relaxations.is_empty());
        assert!(answer.completeness.statement.contains("There may be more"));
        // Begun for another design, or for none that is known.
        let [a, b] = [1, 2].map(|k| one.search(Progress::default(), Some((k, 2)), serial).unwrap());
        assert!(other.search(a.clone(), None, serial).is_err());
        assert!(other.merge(a.clone(), b.clone()).is_err());
        assert!(other.answer_of(a.clone(), &Request::default(), serial).is_err());
        let nameless = Progress { design: String::new(), ..a.clone() };
        assert!(one.search(nameless, None, serial).is_err());
        assert!(one.merge(a, b).unwrap().is_complete());
    }

    #[test]
    fn parts_of_a_search_make_the_whole() {
        let (text, ranges) = &cases()[4];
        let design = design(text, ranges, r#"["assembly"]"#);
        let serial = &willis::work::Serial;
        let whole = design.search(Progress::default(), None, serial).unwrap();
        let [a, b] = [1, 2].map(|k| design.search(Progress::default(), Some((k, 2)), serial).unwrap());
        assert_ne!(a, whole);
        assert!(design.merge(a.clone(), a.clone()).is_err());
        assert_eq!(design.merge(a.clone(), b).unwrap(), whole);
        // Interrupted, kept as text, and resumed.
        let kept = serde_json::to_string(&a).unwrap();
        let resumed = design.search(serde_json::from_str(&kept).unwrap(), None, serial).unwrap();
        assert_eq!(resumed, whole);
    }

    #[test]
    fn a_cancelled_search_says_what_is_done() {
        struct Stops;
        impl Work for Stops {
            fn cancelled(&self) -> bool {
                true
            }
        }
        let (text, ranges) = &cases()[4];
        let answer = design(text, ranges, "[]").answer(&super::super::report::Request::default(), &Stops).unwrap();
        assert!(!answer.completeness.complete && answer.completeness.done == 0);
        assert!(answer.completeness.statement.contains("0.0 % of the space is done"));
    }
}
