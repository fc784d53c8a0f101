//! The tooth numbers that one set may have, ordered by its basic ratios.

use std::sync::OnceLock;

use super::fit::{self, Length, Ravigneaux, assembles_across, assembles_simple, compare, gcd, planets_clear, reduced};
use super::layout::SetKind;
use super::range::{Counts, MOST_TEETH};
use super::rule::Rule;

/// The least teeth that a ring must have more than its planet.
const RING_OVER_PLANET: i64 = 8;
/// So many numbers of planets are tried at most.
pub(crate) const MOST_PLANETS: usize = 16;

/// What the tooth numbers of a set may be, and what they must satisfy.
///
/// The ranges stand in the order of [`SetKind::gears`]; a Ravigneaux set has one more, for its short planets.
///
/// # Example
/// Every train of three to five planets with a ratio k = r/s from 2.9 to 3.1:
/// ```
/// use willis_synthesis::teeth::{Counts, SetKind, SetSpace, Rule};
///
/// let gears = ["12..40", "12..40", "..120"].map(|t| t.parse::<Counts>().unwrap());
/// let space = SetSpace::new(SetKind::Simple, gears.to_vec(), Counts::range(3, 5)).rules([Rule::Assembly, Rule::Clearance]);
/// let found = space.all().filter(|t| (29 * t[0]..=31 * t[0]).contains(&(10 * t[2]))).count();
/// assert_eq!(found, 47);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct SetSpace {
    /// Its type.
    pub kind: SetKind,
    /// Ranges of its gears.
    pub gears: Vec<Counts>,
    /// Numbers of planets to choose from, ascending.
    pub planets: Vec<i64>,
    /// Differences from the teeth that gears without profile shift would need: `r − s − 2 p` and the like.
    pub mismatch: Vec<i64>,
    /// Least gap between the tips of neighbouring planets, modules; of a Ravigneaux set half of it between planets of
    /// different kinds, and between a long planet and the small sun.
    pub gap: Length,
    /// Rules in force, in the order of [`Rule::ALL`].
    pub rules: Vec<Rule>,
    /// Whether profile shifts are found for teeth: pressure angle and rack of the set.
    pub(crate) rack: super::shift::Rack,
    /// The largest ring.
    pub(crate) ring_limit: Option<i64>,
}

/// Tooth numbers of one set, with what the rules say about each number of planets.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Item {
    /// In the order of [`SetKind::gears`].
    pub teeth: Vec<i64>,
    /// For every stage (none, the first rule, the first two, …) the numbers of planets that pass, as bits.
    pub(crate) passed: Vec<u16>,
    /// For every stage and number of planets so many short planets, one before they are looked for; nothing for sets
    /// without.
    embodiments: Vec<Vec<u32>>,
}

/// Items of one basic ratio.
#[derive(Debug)]
pub(crate) struct Group {
    pub value: f64,
    pub exact: (i64, i64),
    /// How many items pass each stage, and how many designs they are, with planets and short planets counted.
    pub trains: Vec<u64>,
    pub designs: Vec<u64>,
    pub items: Vec<Item>,
    /// For sets of two variables: the groups of the second one.
    children: OnceLock<Vec<Group>>,
    /// What the first gears of the items are, for making the children.
    seeds: Vec<[i64; 3]>,
}

impl SetSpace {
    /// A set with ranges, no rules, no mismatch and no gap.
    pub fn new(kind: SetKind, gears: Vec<Counts>, planets: Counts) -> Self {
        let planets = planets.within(1, 64).take(MOST_PLANETS).collect();
        Self {
            kind,
            gears,
            planets,
            mismatch: vec![0],
            gap: Length::ZERO,
            rules: vec![],
            rack: Default::default(),
            ring_limit: None,
        }
    }

    /// The same with these rules.
    #[must_use]
    pub fn rules(mut self, rules: impl IntoIterator<Item = Rule>) -> Self {
        self.rules = rules.into_iter().collect();
        self.rules.sort_unstable();
        self.rules.dedup();
        self
    }

    /// The same with these differences from the teeth that unshifted gears would need.
    #[must_use]
    pub fn mismatch(mut self, mismatch: impl IntoIterator<Item = i64>) -> Self {
        self.mismatch = mismatch.into_iter().collect();
        self.mismatch.sort_unstable();
        self.mismatch.dedup();
        self
    }

    /// The same with a gap between planets.
    #[must_use]
    pub fn gap(mut self, gap: Length) -> Self {
        self.gap = gap;
        self
    }

    /// How many stages there are: one for no rule, one for each.
    pub(crate) fn stages(&self) -> usize {
        self.rules.len() + 1 + usize::from(self.ring_limit.is_some())
    }

    fn gear(&self, k: usize) -> &Counts {
        &self.gears[k]
    }

    /// All tooth numbers that follow every rule with some number of planets, set by set of first gears.
    pub fn all(&self) -> impl Iterator<Item = Vec<i64>> + '_ {
        let seeds = self.seeds();
        let simple = self.kind == SetKind::Simple;
        let grown = seeds.into_iter().flat_map(
            move |seed| {
                if simple { vec![self.item(seed.to_vec())] } else { self.second(seed) }
            },
        );
        let stepped = self.stepped().map(|z| self.item(z.to_vec()));
        grown.chain(stepped).filter(Item::is_admissible).map(|i| i.teeth)
    }

    /// Two central gears on two steps of the planets on one axis: `z1, p1, p2, z2`. Nothing for other sets.
    fn stepped(&self) -> impl Iterator<Item = [i64; 4]> + '_ {
        let first_is_ring = self.kind == SetKind::Rings;
        let mismatch: &[i64] = match self.kind {
            SetKind::Stepped | SetKind::Rings => &self.mismatch,
            _ => &[],
        };
        let most = if mismatch.is_empty() { 0 } else { self.most(3) };
        let first = if first_is_ring { self.most(0) } else { most };
        mismatch.iter().flat_map(move |d| {
            self.gear(0).within(1, first).flat_map(move |z1| {
                // Twice the distance, less the mismatch: z1 + p1 or z1 − p1; the second ring has p2 more.
                self.gear(1).within(1, if first_is_ring { z1 - 1 } else { most - z1 - d - 1 }).flat_map(move |p1| {
                    let twice = if first_is_ring { z1 - p1 } else { z1 + p1 } + d;
                    let last = if twice > 0 { most - twice } else { 0 };
                    let of = move |p2| [z1, p1, p2, twice + p2];
                    self.gear(2).within(1, last).map(of).filter(|z| self.gear(3).contains(z[3]))
                })
            })
        })
    }

    /// The gears that the first variable is made of: `s, p, r`; `s, p1, r1`; `s2, pL, r`.
    fn seeds(&self) -> Vec<[i64; 3]> {
        let [sun, planet, ring] = match self.kind {
            SetKind::Simple | SetKind::Wolfrom => [0, 1, 2],
            SetKind::Ravigneaux => [1, 2, 3],
            SetKind::Stepped | SetKind::Rings => return vec![],
        };
        let most = self.most(ring);
        let mut all = vec![];
        for d in &self.mismatch {
            // The ring has s + 2 p + d teeth.
            for s in self.gear(sun).within(1, most - 2 - d) {
                for p in self.gear(planet).within(1, (most - s - d) / 2) {
                    let r = s + 2 * p + d;
                    if r > p && self.gear(ring).contains(r) {
                        all.push([s, p, r]);
                    }
                }
            }
        }
        all
    }

    /// The most teeth of a gear.
    pub(crate) fn most(&self, gear: usize) -> i64 {
        self.gear(gear).most().unwrap_or(MOST_TEETH).min(MOST_TEETH)
    }

    /// The least mismatch.
    fn least_mismatch(&self) -> i64 {
        self.mismatch.iter().copied().min().unwrap_or(0)
    }

    /// The suns of a Wolfrom drive for which the first ring has teeth enough.
    pub(crate) fn suns(&self) -> impl Iterator<Item = i64> + '_ {
        self.gear(0).within(1, self.most(2) - 2 - self.least_mismatch())
    }

    /// Items that grow from the first gears of a set with two variables.
    fn second(&self, [s, p, r]: [i64; 3]) -> Vec<Item> {
        let mut items = vec![];
        match self.kind {
            SetKind::Simple | SetKind::Stepped | SetKind::Rings => {}
            SetKind::Wolfrom => {
                for d in &self.mismatch {
                    for p2 in self.gear(3).within(1, self.most(4) - s - p - d) {
                        let r2 = s + p + p2 + d;
                        if r2 > p2 && self.gear(4).contains(r2) {
                            items.push(self.item(vec![s, p, r, p2, r2]));
                        }
                    }
                }
            }
            SetKind::Ravigneaux => {
                items.extend(self.gear(0).within(1, r - 1).map(|s1| self.item(vec![s1, s, p, r])));
            }
        }
        items
    }

    /// Judges tooth numbers.
    pub(crate) fn item(&self, teeth: Vec<i64>) -> Item {
        let all: u16 = ((1u32 << self.planets.len()) - 1) as u16;
        let mut passed = vec![all];
        let has_shorts = self.kind == SetKind::Ravigneaux;
        let mut counts = vec![1; self.planets.len()];
        let mut embodiments = if has_shorts { vec![counts.clone()] } else { vec![] };
        let mut now = all;
        for (r, rule) in self.rules.iter().enumerate() {
            if now != 0 {
                now = self.judge(*rule, &teeth, now);
                if has_shorts && matches!(rule, Rule::Clearance | Rule::Hunting) {
                    let so_far = &self.rules[..=r];
                    for (k, n) in self.planets.iter().enumerate() {
                        let mut shorts = self.shorts_by(so_far, &teeth, *n);
                        // What does not have to fit is not counted: one of them is enough.
                        let is_counted = so_far.contains(&Rule::Clearance);
                        let some = now >> k & 1 == 1 && shorts.next().is_some();
                        counts[k] = u32::from(some) + if some && is_counted { shorts.count() as u32 } else { 0 };
                        now &= !(u16::from(!some) << k);
                    }
                }
            }
            passed.push(now);
            if has_shorts {
                embodiments.push(counts.clone());
            }
        }
        if let Some(limit) = self.ring_limit {
            passed.push(if self.ring(&teeth) <= limit { now } else { 0 });
            if has_shorts {
                embodiments.push(counts);
            }
        }
        Item { teeth, passed, embodiments }
    }

    /// The numbers of planets, as bits, with which teeth of a set without short planets follow all rules.
    pub(crate) fn admitted(&self, teeth: &[i64]) -> u16 {
        let all = ((1u32 << self.planets.len()) - 1) as u16;
        if self.ring_limit.is_some_and(|limit| self.ring(teeth) > limit) {
            return 0;
        }
        self.rules.iter().fold(all, |now, rule| if now == 0 { 0 } else { self.judge(*rule, teeth, now) })
    }

    /// Teeth of the largest ring.
    pub(crate) fn ring(&self, teeth: &[i64]) -> i64 {
        match self.kind {
            SetKind::Simple => teeth[2],
            SetKind::Wolfrom => teeth[2].max(teeth[4]),
            SetKind::Stepped => teeth[3],
            SetKind::Rings => teeth[0].max(teeth[3]),
            SetKind::Ravigneaux => teeth[3],
        }
    }

    /// Short planets with which a Ravigneaux set with so many planets follows these rules: clearance and hunting.
    fn shorts_by<'a>(&'a self, rules: &[Rule], teeth: &[i64], planets: i64) -> impl Iterator<Item = i64> + 'a {
        let set = Ravigneaux::of(teeth);
        let [fit, hunt] = [Rule::Clearance, Rule::Hunting].map(|r| rules.contains(&r));
        let range = self.gears.get(4).map(|c| c.within(1, set.ring));
        range.into_iter().flatten().filter(move |&p| {
            (!hunt || SetKind::Ravigneaux.hunts(&[set.small_sun, set.large_sun, set.long, set.ring, p]))
                && (!fit || set.short_fits(p, planets, self.gap))
        })
    }

    /// The short planet that a Ravigneaux set gets: the first that fits and follows the rules, else, where it need not
    /// fit, the first that hunts where it must, or one like the long planet. None for other sets.
    pub(crate) fn short(&self, teeth: &[i64], planets: i64) -> Option<i64> {
        (self.kind == SetKind::Ravigneaux).then(|| {
            let mut fit = self.rules.clone();
            fit.push(Rule::Clearance);
            let first = |rules: &[Rule]| self.shorts_by(rules, teeth, planets).next();
            let must_hunt = self.rules.contains(&Rule::Hunting);
            first(&fit).or_else(|| must_hunt.then(|| first(&self.rules)).flatten()).unwrap_or(teeth[2])
        })
    }

    /// What sets the speeds of the planets, where the basic ratios are given: planets over suns, or over the first ring.
    pub(crate) fn planet_class(&self, z: &[i64]) -> [(i64, i64); 2] {
        match self.kind {
            SetKind::Simple | SetKind::Stepped | SetKind::Rings => [reduced(z[1], z[0]), (0, 1)],
            SetKind::Wolfrom => [reduced(z[1], z[0]), reduced(z[3], z[0])],
            SetKind::Ravigneaux => [reduced(z[2], z[0]), reduced(z[2], z[1])],
        }
    }

    /// How many coaxial tooth numbers there are, without short planets.
    pub(crate) fn size(&self) -> f64 {
        let seeds = self.seeds();
        match self.kind {
            SetKind::Simple => seeds.len() as f64,
            SetKind::Stepped | SetKind::Rings => self.stepped().count() as f64,
            SetKind::Ravigneaux => seeds.iter().map(|s| self.gear(0).within(1, s[2] - 1).count() as f64).sum(),
            SetKind::Wolfrom => {
                let (planet, ring) = (self.gear(3), self.gear(4));
                let most = self.most(4);
                let of = |[s, p, _]: &[i64; 3]| -> f64 {
                    let fits = |d: &i64| {
                        let a = s + p + d;
                        if a <= 0 {
                            return 0;
                        }
                        let low = (ring.least().unwrap_or(1) - a).max(1);
                        if ring.is_gapless() {
                            planet.within(low, most - a).count()
                        } else {
                            planet.within(low, most - a).filter(|p2| ring.contains(a + p2)).count()
                        }
                    };
                    self.mismatch.iter().map(fits).sum::<usize>() as f64
                };
                seeds.iter().map(of).sum()
            }
        }
    }

    /// The numbers of planets that pass a rule.
    fn judge(&self, rule: Rule, z: &[i64], now: u16) -> u16 {
        let each = |test: &dyn Fn(i64) -> bool| {
            let passes = |(k, n): (usize, &i64)| u16::from(now >> k & 1 == 1 && test(*n)) << k;
            self.planets.iter().enumerate().map(passes).sum()
        };
        let whole = |test: bool| if test { now } else { 0 };
        let prime = |a: i64, b: i64| gcd(a, b) == 1;
        match (self.kind, rule) {
            (SetKind::Simple, Rule::Assembly) => each(&|n| assembles_simple(z[0], z[2], n)),
            (SetKind::Wolfrom, Rule::Assembly) => {
                // As `assembles_across`, with the common divisor found once.
                let sum = z[0] + z[2];
                if self.planets.iter().all(|n| sum % n != 0) {
                    return 0;
                }
                let across = (z[2] * z[3] - z[4] * z[1]) / gcd(z[1], z[3]);
                each(&|n| sum % n == 0 && across % n == 0)
            }
            (SetKind::Stepped, Rule::Assembly) => each(&|n| assembles_across((z[0], z[1]), (-z[3], z[2]), n)),
            (SetKind::Rings, Rule::Assembly) => each(&|n| assembles_across((-z[0], z[1]), (-z[3], z[2]), n)),
            (SetKind::Ravigneaux, Rule::Assembly) => each(&|n| Ravigneaux::of(z).assembles(n)),
            (SetKind::Simple, Rule::Clearance) => each(&|n| planets_clear((z[0] + z[2], 2), n, z[1], self.gap)),
            (SetKind::Wolfrom, Rule::Clearance) => {
                let sum = z[0] + z[1] + z[2] - z[1] + z[4] - z[3];
                each(&|n| planets_clear((sum, 3), n, z[1].max(z[3]), self.gap))
            }
            (SetKind::Stepped | SetKind::Rings, Rule::Clearance) => {
                let first = if self.kind == SetKind::Rings { z[0] - z[1] } else { z[0] + z[1] };
                each(&|n| planets_clear((first + z[3] - z[2], 2), n, z[1].max(z[2]), self.gap))
            }
            (SetKind::Ravigneaux, Rule::Clearance) => each(&|n| Ravigneaux::of(z).long_clears(n, self.gap)),
            (SetKind::Simple, Rule::Interference) => whole(z[2] - z[1] >= RING_OVER_PLANET),
            (SetKind::Wolfrom, Rule::Interference) => {
                whole(z[2] - z[1] >= RING_OVER_PLANET && z[4] - z[3] >= RING_OVER_PLANET)
            }
            (SetKind::Stepped, Rule::Interference) => whole(z[3] - z[2] >= RING_OVER_PLANET),
            (SetKind::Rings, Rule::Interference) => {
                whole(z[0] - z[1] >= RING_OVER_PLANET && z[3] - z[2] >= RING_OVER_PLANET)
            }
            (SetKind::Ravigneaux, Rule::Interference) => whole(z[3] - z[2] >= RING_OVER_PLANET),
            (_, Rule::Hunting) => whole(self.kind.hunts(z)),
            (SetKind::Simple, Rule::InPhase) => each(&|n| z[0] % n == 0 && z[2] % n == 0),
            (SetKind::Wolfrom, Rule::InPhase) => each(&|n| z[0] % n == 0 && z[2] % n == 0 && z[4] % n == 0),
            (SetKind::Stepped | SetKind::Rings, Rule::InPhase) => each(&|n| z[0] % n == 0 && z[3] % n == 0),
            (SetKind::Ravigneaux, Rule::InPhase) => each(&|n| z[0] % n == 0 && z[1] % n == 0 && z[3] % n == 0),
            (SetKind::Rings, Rule::InSequence) => each(&|n| prime(z[0], n) && prime(z[3], n)),
            (SetKind::Simple | SetKind::Wolfrom | SetKind::Stepped, Rule::InSequence) => each(&|n| prime(z[0], n)),
            (SetKind::Ravigneaux, Rule::InSequence) => each(&|n| prime(z[0], n) && prime(z[1], n)),
            (_, Rule::Shifts) => whole(super::shift::shifts(self.kind, z, self.rack).is_some()),
        }
    }

    /// The groups of the first variable, ascending. Without `every_stage` only what follows all rules.
    pub(crate) fn groups(&self, every_stage: bool) -> Vec<Group> {
        let mut seeds = self.seeds();
        let key = |z: &[i64; 3]| reduced(z[2], z[0]);
        seeds.sort_by(|a, b| compare((a[2], a[0]), (b[2], b[0])).then_with(|| a.cmp(b)));
        let mut groups: Vec<Group> = vec![];
        for seed in seeds {
            let mut items = vec![];
            if self.kind == SetKind::Simple {
                if every_stage || self.admitted(&seed) != 0 {
                    items.push(self.item(seed.to_vec()));
                }
                if items.is_empty() {
                    continue;
                }
            }
            let exact = key(&seed);
            match groups.last_mut().filter(|g| g.exact == exact) {
                Some(g) => {
                    g.items.extend(items);
                    g.seeds.push(seed);
                }
                None => groups.push(Group::new(exact, items, vec![seed])),
            }
        }
        let mut stepped: Vec<((i64, i64), [i64; 4])> = self
            .stepped()
            .filter(|z| every_stage || self.admitted(z) != 0)
            .map(|z| (reduced(z[3] * z[1], z[0] * z[2]), z))
            .collect();
        stepped.sort_by(|a, b| compare(a.0, b.0).then_with(|| a.1.cmp(&b.1)));
        for (exact, z) in stepped {
            let item = self.item(z.to_vec());
            match groups.last_mut().filter(|g| g.exact == exact) {
                Some(g) => g.items.push(item),
                None => groups.push(Group::new(exact, vec![item], vec![])),
            }
        }
        for g in &mut groups {
            g.count(self.stages());
        }
        groups
    }

    /// Bounds of its variables; none where it has no teeth.
    pub(crate) fn bounds(&self) -> Option<Vec<[f64; 2]>> {
        let of = |z: &[i64; 3]| z[2] as f64 / z[0] as f64;
        let across = |z: [i64; 4]| (z[3] * z[1]) as f64 / (z[0] * z[2]) as f64;
        let values: Vec<f64> = self.seeds().iter().map(of).chain(self.stepped().map(across)).collect();
        let first = values.iter().fold([f64::INFINITY, 0.0], |b: [f64; 2], y| [b[0].min(*y), b[1].max(*y)]);
        let is_empty = values.is_empty();
        let all = if self.kind.variables() == 1 { vec![first] } else { vec![first, self.second_bounds()] };
        (!is_empty && all.iter().all(|b| b[0] > 0.0 && b[1].is_finite())).then_some(all)
    }

    /// Bounds of the second variable.
    pub(crate) fn second_bounds(&self) -> [f64; 2] {
        let least = |k: usize| self.gear(k).least().unwrap_or(1).max(1) as f64;
        let most = |k: usize| self.most(k) as f64;
        match self.kind {
            SetKind::Simple | SetKind::Stepped | SetKind::Rings => [0.0, f64::INFINITY],
            SetKind::Wolfrom => {
                // It is p1 r2/(s p2) with r2 > p2 and s + 2 p1 + d = r1.
                let rest = most(2) - self.least_mismatch() as f64;
                let (s, p1) = (most(0).min(rest - 2.0), most(1).min((rest - least(0)) / 2.0));
                [least(1) / s, p1 * most(4) / (least(0) * least(3))]
            }
            SetKind::Ravigneaux => [1.0, most(3) / least(0)],
        }
    }
}

impl SetKind {
    /// Whether no gears that mesh have a common divisor; the last of five gears of a Ravigneaux set is the short planet.
    pub(crate) fn hunts(self, teeth: &[i64]) -> bool {
        let meshes: &[[usize; 2]] = match self {
            Self::Simple => &[[0, 1], [1, 2]],
            Self::Wolfrom => &[[0, 1], [1, 2], [3, 4]],
            Self::Stepped | Self::Rings => &[[0, 1], [2, 3]],
            Self::Ravigneaux => &[[1, 2], [2, 3], [0, 4], [4, 2]],
        };
        let given = meshes.iter().filter(|m| m[0].max(m[1]) < teeth.len());
        given.into_iter().all(|[a, b]| gcd(teeth[*a], teeth[*b]) == 1)
    }
}

impl Ravigneaux {
    fn of(z: &[i64]) -> Self {
        Self { small_sun: z[0], large_sun: z[1], long: z[2], ring: z[3] }
    }
}

impl Group {
    fn new(exact: (i64, i64), items: Vec<Item>, seeds: Vec<[i64; 3]>) -> Self {
        Self {
            value: exact.0 as f64 / exact.1 as f64,
            exact,
            trains: vec![],
            designs: vec![],
            items,
            children: OnceLock::new(),
            seeds,
        }
    }

    fn count(&mut self, stages: usize) {
        self.trains = (0..stages).map(|s| self.items.iter().filter(|i| i.passed[s] != 0).count() as u64).collect();
        self.designs = (0..stages).map(|s| self.items.iter().map(|i| i.designs(s)).sum()).collect();
    }

    /// The groups of the second variable.
    pub fn children(&self, space: &SetSpace, every_stage: bool) -> &[Self] {
        self.children.get_or_init(|| {
            let mut items: Vec<((i64, i64), Item)> = vec![];
            for seed in &self.seeds {
                for item in space.second(*seed) {
                    if every_stage || item.is_admissible() {
                        let z = &item.teeth;
                        let y = match space.kind {
                            SetKind::Wolfrom => reduced(z[1] * z[4], z[0] * z[3]),
                            // Only sets of two variables have children.
                            _ => reduced(z[3], z[0]),
                        };
                        items.push((y, item));
                    }
                }
            }
            items.sort_by(|a, b| compare(a.0, b.0).then_with(|| a.1.teeth.cmp(&b.1.teeth)));
            let mut groups: Vec<Self> = vec![];
            for (exact, item) in items {
                match groups.last_mut().filter(|g| g.exact == exact) {
                    Some(g) => g.items.push(item),
                    None => groups.push(Self::new(exact, vec![item], vec![])),
                }
            }
            for g in &mut groups {
                g.count(space.stages());
            }
            groups
        })
    }
}

impl Item {
    /// How many designs it is at a stage: numbers of planets, with the short planets of each.
    pub(crate) fn designs(&self, stage: usize) -> u64 {
        self.by_planets(stage).sum()
    }

    /// The same for every number of planets; noughts follow.
    pub(crate) fn by_planets(&self, stage: usize) -> impl Iterator<Item = u64> + '_ {
        let (bits, shorts) = (self.passed[stage], self.embodiments.get(stage));
        (0..MOST_PLANETS).map(move |k| match bits >> k & 1 {
            0 => 0,
            _ => shorts.map_or(1, |s| u64::from(s[k])),
        })
    }

    /// Whether it follows all rules with some number of planets.
    pub(crate) fn is_admissible(&self) -> bool {
        self.passed.last().is_some_and(|p| *p != 0)
    }

    /// The phase of its meshes at the sun.
    pub(crate) fn phase(&self, sun: usize, planets: i64) -> fit::Phase {
        fit::phase(self.teeth[sun], planets)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn items(space: &SetSpace) -> Vec<Vec<i64>> {
        let mut all = vec![];
        let bounds = space.bounds();
        for group in space.groups(true) {
            let second = space.kind.variables() == 2;
            let children = if second { group.children(space, true) } else { std::slice::from_ref(&group) };
            for child in children {
                let [first, last] = [group.value, child.value].map(|y| y * (1.0 + 1e-12));
                for (y, b) in [first, last].iter().zip(bounds.as_ref().unwrap()) {
                    assert!(b[0] <= *y && *y <= b[1] * (1.0 + 1e-9), "{y} {b:?}");
                }
                all.extend(child.items.iter().map(|i| i.teeth.clone()));
            }
        }
        all.sort();
        all
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(80))]
        /// Every way through a space finds the teeth that trying all numbers finds.
        #[test]
        fn groups_find_what_brute_force_finds(
            s in 1i64..14, p in 1i64..14, spans in [1i64..6, 1..6, 1..6], most in 10i64..60, kind in 0usize..5,
            mismatch in proptest::collection::btree_set(-4i64..=4, 1..4), second in 10i64..60,
        ) {
            let all_kinds =
                [SetKind::Simple, SetKind::Wolfrom, SetKind::Ravigneaux, SetKind::Stepped, SetKind::Rings];
            let kind = all_kinds[kind];
            let [sun, planet, other] =
                [Counts::range(s, s + spans[0]), Counts::range(p, p + spans[1]), Counts::range(p, p + spans[2])];
            let (ring, ring_2) = (Counts::range(1, most), Counts::range(1, second));
            let all = |c: &Counts| c.within(1, 100).collect::<Vec<i64>>();
            let mut brute = vec![];
            if matches!(kind, SetKind::Stepped | SetKind::Rings) {
                let first = if kind == SetKind::Rings { &ring } else { &sun };
                for z1 in all(first) { for p1 in all(&planet) { for p2 in all(&other) { for z2 in all(&ring_2) {
                    let distance = if kind == SetKind::Rings { z1 - p1 } else { z1 + p1 };
                    let fits = distance > 0 && z2 > p2 && mismatch.contains(&(z2 - p2 - distance));
                    if fits {
                        brute.push(vec![z1, p1, p2, z2]);
                    }
                }}}}
            }
            for s in all(&sun) { for p in all(&planet) { for d in &mismatch {
                let r = s + 2 * p + d;
                if r <= p || !ring.contains(r) {
                    continue;
                }
                match kind {
                    SetKind::Stepped | SetKind::Rings => {}
                    SetKind::Simple => brute.push(vec![s, p, r]),
                    SetKind::Ravigneaux => {
                        brute.extend(all(&other).into_iter().filter(|z| *z < r).map(|z| vec![z, s, p, r]));
                    }
                    SetKind::Wolfrom => for p2 in all(&other) { for d in &mismatch {
                        let r2 = s + p + p2 + d;
                        if r2 > p2 && ring_2.contains(r2) {
                            brute.push(vec![s, p, r, p2, r2]);
                        }
                    }},
                }
            }}}
            let gears = match kind {
                SetKind::Simple => vec![sun, planet, ring],
                SetKind::Wolfrom => vec![sun, planet, ring, other, ring_2],
                SetKind::Ravigneaux => vec![other, sun, planet, ring],
                SetKind::Stepped => vec![sun, planet, other, ring_2],
                SetKind::Rings => vec![ring, planet, other, ring_2],
            };
            let space = SetSpace::new(kind, gears, Counts::range(3, 3)).mismatch(mismatch);
            brute.sort();
            prop_assert_eq!(space.size(), brute.len() as f64);
            let mut listed: Vec<Vec<i64>> = space.all().collect();
            listed.sort();
            prop_assert_eq!(&listed, &brute);
            prop_assert_eq!(items(&space), brute);
        }
    }

    /// Short planets of Ravigneaux sets: what each rule leaves, by trying every one.
    #[test]
    fn short_planets_are_counted_when_they_are_looked_for() {
        use Rule::{Assembly, Clearance, Hunting, Interference};
        let gears = ["28..32", "35..38", "17..19", "70..74", "12..30"].map(|t| t.parse::<Counts>().unwrap());
        let (mut counted, mut none_hunts) = (0, 0);
        for rules in [&[][..], &[Assembly, Clearance, Interference, Hunting], &[Clearance], &[Hunting]] {
            let mut space = SetSpace::new(SetKind::Ravigneaux, gears.to_vec(), Counts::range(3, 4))
                .mismatch(-1..=1)
                .rules(rules.iter().copied());
            space.ring_limit = Some(73);
            let plain = SetSpace { rules: vec![], ring_limit: None, ..space.clone() };
            for z in plain.all() {
                let item = space.item(z.clone());
                let set = Ravigneaux::of(&z);
                let [s1, s2, long, ring] = [z[0], z[1], z[2], z[3]];
                for stage in 0..space.stages() {
                    let so_far = &space.rules[..stage.min(rules.len())];
                    let has = |r: Rule| so_far.contains(&r);
                    let expected = [3, 4].map(|n| {
                        let shorts = (12..=30).filter(|p| {
                            (!has(Clearance) || set.short_fits(*p, n, space.gap))
                                && (!has(Hunting) || gcd(s1, *p) == 1 && gcd(*p, long) == 1)
                        });
                        let sound = (!has(Assembly) || set.assembles(n))
                            && (!has(Interference) || ring - long >= RING_OVER_PLANET)
                            && (!has(Hunting) || gcd(s2, long) == 1 && gcd(long, ring) == 1)
                            && (stage <= rules.len() || ring <= 73);
                        let count = shorts.count() as u64;
                        if !sound {
                            0
                        } else if has(Clearance) {
                            count
                        } else {
                            count.min(1)
                        }
                    });
                    let own: Vec<u64> = item.by_planets(stage).take(2).collect();
                    assert_eq!(own, expected, "{z:?} {so_far:?}");
                    assert_eq!(item.designs(stage), expected.iter().sum::<u64>());
                    assert_eq!(item.passed[stage] != 0, expected.iter().any(|e| *e > 0));
                    counted += expected[0];
                }
                // The short planet that is shown follows the rule too.
                if item.is_admissible() && space.rules.contains(&Hunting) {
                    let n = if item.passed[item.passed.len() - 1] >> 1 & 1 == 1 { 4 } else { 3 };
                    assert!(SetKind::Ravigneaux.hunts(&[s1, s2, long, ring, space.short(&z, n).unwrap()]));
                }
                none_hunts += u64::from(space.rules.contains(&Hunting) && !item.is_admissible());
            }
        }
        assert!(counted > 1000 && none_hunts > 0);
    }
}
