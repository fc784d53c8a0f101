//! The search over the points of one layout: every choice of elements that can do what is wanted.
//!
//! A choice of n points has `T = C(n, M-1)` states. A chain of f gears needs f different forward ratios, and r reverse
//! gears need r more, so at most `T - f` states may be no forward gear and at most `T - f - r` may be no gear at all; of
//! the states with one ratio all but one are as good as none. Points are added one by one; each adds states and none goes
//! away, so a choice that exceeds a bound is left with everything that begins so. What is left out is excluded by proof.
//! Whole choices are looked at twice: in floating point with a window of steps that is a little too wide, and what
//! remains exactly.

use super::motion::MAX_MOBILITY;
use super::points::Points;
use super::table::{Exact, Info, Kind, Ranges, Table, UNNUMBERED, binomial};

/// Elements that a scheme may have.
pub const MAX_ELEMENTS: usize = 8;
/// States that so many elements have: `C(8, 4)`.
const MAX_STATES: usize = 70;

/// What is wanted of a choice of elements, made ready for the search.
#[derive(Clone, Debug)]
pub(crate) struct Goal {
    pub(crate) elements: usize,
    /// Elements that a state closes, `M - 1`.
    pub(crate) closed: usize,
    pub(crate) forward: usize,
    pub(crate) reverse: usize,
    pub(crate) progressive: bool,
    pub(crate) ranges: Ranges,
    /// Which elements, as bits, each state closes, in the order in which the search finds the states.
    masks: Vec<u32>,
    /// The states that differ from each by one element off and one on, as bits.
    neighbours: Vec<u128>,
}

impl Goal {
    pub(crate) fn new([elements, closed, forward, reverse]: [usize; 4], progressive: bool, ranges: Ranges) -> Self {
        // The search adds points from the first to the last; each brings the states that it ends.
        let mut masks: Vec<u32> = vec![];
        for last in 0..elements {
            let before = subsets(last, closed - 1);
            masks.extend(before.into_iter().map(|s| s | 1 << last));
        }
        let neighbours = masks.iter().map(|a| {
            let beside = |(_, b): &(usize, &u32)| (a ^ **b).count_ones() == 2;
            masks.iter().enumerate().filter(beside).fold(0, |all, (s, _)| all | 1_u128 << s)
        });
        let neighbours = neighbours.collect();
        Self { elements, closed, forward, reverse, progressive, ranges, masks, neighbours }
    }

    /// How many states a choice has.
    pub(crate) fn states(&self) -> usize {
        self.masks.len()
    }

    /// The elements that each state of a choice closes, as bits.
    pub(crate) fn masks(&self) -> &[u32] {
        &self.masks
    }
}

/// The sets of so many of the first `n` numbers, as bits, in colexicographic order.
fn subsets(n: usize, size: usize) -> Vec<u32> {
    (0..1_u32 << n).filter(|s| s.count_ones() as usize == size).collect()
}

/// A choice of points that does what is wanted.
pub(crate) struct Found<'a> {
    /// The points, growing.
    pub(crate) points: &'a [usize],
    /// Its states in the order of [`Goal::masks`].
    pub(crate) states: &'a [usize],
    /// The longest chain of forward gears, as positions in `states`, from the largest ratio on.
    pub(crate) chain: &'a [u8],
}

/// How many choices of points, and of elements at them, came how far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Passed {
    /// Not excluded by the count of their states.
    pub(crate) enough: u64,
    /// With a chain.
    pub(crate) chain: u64,
}

/// A forward gear whose ratio an earlier one has.
const AGAIN: u32 = 1 | 1 << 8;

/// For each point, as a bit of every word, how many states it would add that are wasted: a number of so many binary
/// digits.
#[derive(Clone, Copy)]
struct Counter<const DIGITS: usize>([u64; DIGITS]);

impl<const DIGITS: usize> Counter<DIGITS> {
    /// Counts one more at these points.
    fn add(&mut self, points: u64) {
        let mut carry = points;
        for digit in &mut self.0 {
            (*digit, carry) = (*digit ^ carry, *digit & carry);
        }
    }

    /// The points at which the number is not above this.
    fn at_most(&self, most: u32) -> u64 {
        if most >> DIGITS != 0 {
            return u64::MAX;
        }
        // From the highest digit on: equal so far, or already below.
        let (mut equal, mut below) = (u64::MAX, 0);
        for (k, digit) in self.0.iter().enumerate().rev() {
            let wanted = 0_u64.wrapping_sub(u64::from(most >> k & 1));
            below |= equal & !digit & wanted;
            equal &= !(digit ^ wanted);
        }
        equal | below
    }
}

/// What a further point would add.
#[derive(Clone, Copy)]
struct Counters<const DIGITS: usize> {
    /// States that are no forward gear.
    no_forward: Counter<DIGITS>,
    /// States that are no gear.
    no_gear: Counter<DIGITS>,
    /// The points that add a reverse gear.
    reverse: u64,
}

impl<const DIGITS: usize> Counters<DIGITS> {
    const NONE: Self = Self { no_forward: Counter([0; DIGITS]), no_gear: Counter([0; DIGITS]), reverse: 0 };

    fn add(&mut self, [no_forward, no_gear]: [u64; 2]) {
        self.no_forward.add(no_forward);
        self.no_gear.add(no_gear);
        self.reverse |= no_forward & !no_gear;
    }
}

/// The room that a search works in.
pub(crate) struct Chooser<'a> {
    pub(crate) goal: &'a Goal,
    pub(crate) points: &'a Points,
    pub(crate) table: &'a Table,
    pub(crate) exact: &'a Exact<'a>,
    pub(crate) passed: Passed,
    chosen: [usize; MAX_ELEMENTS],
    /// Numbers of the subsets of the chosen points, by their size.
    numbers: [Vec<usize>; MAX_MOBILITY + 1],
    /// How many of the states have each ratio, by its number.
    held: Vec<u8>,
    /// At most so many states may be no forward gear, and so many no gear.
    most: [u32; 2],
    /// The states of a whole choice.
    states: [usize; MAX_STATES],
    /// Its forward gears by falling ratio: ratio, position; and the longest chain that ends there.
    falling: [(f64, u8); MAX_STATES],
    length: [u8; MAX_STATES],
}

impl<'a> Chooser<'a> {
    pub(crate) fn new(goal: &'a Goal, points: &'a Points, table: &'a Table, exact: &'a Exact<'a>) -> Self {
        let mut numbers: [Vec<usize>; MAX_MOBILITY + 1] = Default::default();
        numbers[0].push(0);
        let total = goal.states();
        let spare = |needed: usize| total.saturating_sub(needed) as u32;
        let most = [spare(goal.forward), spare(goal.forward + goal.reverse)];
        Self {
            goal,
            points,
            table,
            exact,
            passed: Passed::default(),
            chosen: [0; MAX_ELEMENTS],
            numbers,
            held: vec![0; table.numbers],
            most,
            states: [0; MAX_STATES],
            falling: [(0.0, 0); MAX_STATES],
            length: [0; MAX_STATES],
        }
    }

    /// Calls `visit` with every choice that does what is wanted.
    pub(crate) fn run(&mut self, visit: &mut dyn FnMut(&Found<'_>)) {
        if self.goal.forward + self.goal.reverse <= self.goal.states() {
            // A point adds at most `C(n-1, M-2)` states.
            if binomial(self.goal.elements - 1, self.goal.closed - 1) < 8 {
                self.start::<3>(visit);
            } else {
                self.start::<6>(visit);
            }
        }
    }

    fn start<const DIGITS: usize>(&mut self, visit: &mut dyn FnMut(&Found<'_>)) {
        let mut counters = Counters::<DIGITS>::NONE;
        if self.goal.closed == 1 {
            counters.add(self.table.wasted[0]);
        }
        let all = u64::MAX.checked_shr(64 - self.points.len() as u32).unwrap_or(0);
        self.add(0, self.open(0, self.goal.elements, &counters) & all, 0, &counters, visit);
    }

    /// The points that can be added where so much is wasted already and so many are left to be chosen.
    fn open<const DIGITS: usize>(&self, waste: u32, left: usize, counters: &Counters<DIGITS>) -> u64 {
        let [most, most_bad] = self.most;
        let (no_forward, no_gear) = (waste & 0xFF, waste >> 8);
        let open = counters.no_forward.at_most(most - no_forward) & counters.no_gear.at_most(most_bad - no_gear);
        // Where no state is a reverse gear yet, the last point must bring one.
        let lacks_reverse = left == 1 && self.goal.reverse > 0 && self.goal.closed > 1 && no_forward == no_gear;
        if lacks_reverse { open & counters.reverse } else { open }
    }

    /// Adds one of the `open` points, which come after those that are chosen. `waste` is what the chosen ones waste:
    /// states that are no forward gear in the lowest eight bits, states that are no gear above them.
    fn add<const DIGITS: usize>(
        &mut self,
        depth: usize,
        mut open: u64,
        waste: u32,
        counters: &Counters<DIGITS>,
        visit: &mut dyn FnMut(&Found<'_>),
    ) {
        let closed = self.goal.closed;
        let left = self.goal.elements - depth;
        let [most, most_bad] = self.most;
        while open.count_ones() as usize >= left {
            let point = open.trailing_zeros() as usize;
            open &= open - 1;
            let base = self.table.choose[closed][point];
            let infos = &self.table.info[base..];
            let count = |waste: u32, below: &usize| {
                let info: Info = infos[*below];
                waste + (info >> 16) + AGAIN * u32::from(self.held[info as usize & 0xFFFF] != 0)
            };
            let with = self.numbers[closed - 1].iter().fold(waste, count);
            if with & 0xFF > most || with >> 8 > most_bad {
                continue;
            }
            self.chosen[depth] = point;
            if left == 1 {
                let before = self.numbers[closed].len();
                let total = before + self.numbers[closed - 1].len();
                self.states[..before].copy_from_slice(&self.numbers[closed]);
                for (state, below) in self.states[before..].iter_mut().zip(&self.numbers[closed - 1]) {
                    *state = base + below;
                }
                self.look(total, visit);
                continue;
            }
            let mut counters = *counters;
            if closed > 1 {
                let base = self.table.choose[closed - 1][point];
                self.numbers[closed - 2].iter().for_each(|below| counters.add(self.table.wasted[base + below]));
            }
            // What is open can only become less.
            let mut next = open & self.open(with, left - 1, &counters);
            if (next.count_ones() as usize) < left - 1 {
                continue;
            }
            let lengths: [usize; MAX_MOBILITY + 1] = std::array::from_fn(|j| self.numbers[j].len());
            for j in (1..=closed).rev() {
                let base = self.table.choose[j][point];
                let (below, here) = self.numbers.split_at_mut(j);
                here[0].extend(below[j - 1][..lengths[j - 1]].iter().map(|b| base + b));
            }
            // New states may have one ratio among themselves.
            let mut exactly = waste;
            for state in &self.numbers[closed][lengths[closed]..] {
                let info = self.table.info[*state];
                exactly += info >> 16;
                let number = info as usize & 0xFFFF;
                if number > UNNUMBERED as usize {
                    exactly += AGAIN * u32::from(self.held[number] != 0);
                    self.held[number] += 1;
                }
            }
            if exactly & 0xFF <= most && exactly >> 8 <= most_bad {
                if exactly != with {
                    next &= self.open(exactly, left - 1, &counters);
                }
                self.add(depth + 1, next, exactly, &counters, visit);
            }
            for state in &self.numbers[closed][lengths[closed]..] {
                let number = self.table.info[*state] as usize & 0xFFFF;
                self.held[number] = self.held[number].saturating_sub(1);
            }
            for (numbers, length) in self.numbers.iter_mut().zip(lengths) {
                numbers.truncate(length);
            }
        }
    }

    /// A whole choice, with so many states.
    fn look(&mut self, total: usize, visit: &mut dyn FnMut(&Found<'_>)) {
        let goal = self.goal;
        let hardware =
            || -> u64 { self.chosen[..goal.elements].iter().map(|p| self.points.at(*p).len() as u64).product() };
        self.passed.enough += hardware();
        let states = &self.states[..total];
        let [low, high] = goal.ranges.about;
        let mut count = 0;
        for (s, state) in states.iter().enumerate() {
            if self.table.info[*state] & 0xFFFF == 0 {
                continue;
            }
            let ratio = self.table.ratio[*state];
            let mut at = count;
            while at > 0 && self.falling[at - 1].0 < ratio {
                self.falling[at] = self.falling[at - 1];
                at -= 1;
            }
            self.falling[at] = (ratio, s as u8);
            count += 1;
        }
        // Of two ratios that are nearly equal either may come first; then only the exact look tells.
        let close = |w: &[(f64, u8)]| !goal.ranges.is_coarse() && w[0].0 < w[1].0 * (1.0 + super::table::NEAR);
        let unsure = self.falling[..count].windows(2).any(close);
        let mut longest = 0;
        for at in 0..count {
            let (ratio, here) = self.falling[at];
            let beside = goal.neighbours[usize::from(here)];
            let mut length = 0;
            for from in 0..at {
                let (above, other) = self.falling[from];
                let is_step = (beside >> other & 1 == 1) & (above >= ratio * low) & (above <= ratio * high);
                length = if is_step { length.max(self.length[from]) } else { length };
            }
            self.length[at] = length + 1;
            longest = longest.max(length + 1);
        }
        if usize::from(longest) < goal.forward && !unsure {
            return;
        }
        let mut chain = [0; MAX_STATES];
        let Some(length) = longest_chain(goal, states, u128::MAX, self.table, self.exact, &mut chain) else { return };
        let hardware = hardware();
        self.passed.chain += hardware;
        if !has_reverse(goal, states, u128::MAX, self.table) {
            return;
        }
        visit(&Found { points: &self.chosen[..goal.elements], states, chain: &chain[..length] });
    }
}

/// Whether the states in `among` have as many different reverse ratios as are wanted.
fn has_reverse(goal: &Goal, states: &[usize], among: u128, table: &Table) -> bool {
    if goal.reverse == 0 {
        return true;
    }
    let mut ratios = [0.0; MAX_STATES];
    let mut count = 0;
    for (s, state) in states.iter().enumerate() {
        if among >> s & 1 == 1 && table.kind(*state) == Kind::Reverse {
            let ratio = table.ratio[*state];
            if ratios[..count].iter().all(|r: &f64| (r / ratio - 1.0).abs() > super::table::NEAR) {
                ratios[count] = ratio;
                count += 1;
            }
        }
    }
    count >= goal.reverse
}

/// The longest chain of forward gears among some of the states of a choice, if it is as long as is wanted: its length,
/// and positions of states in `chain`.
fn longest_chain(
    goal: &Goal,
    states: &[usize],
    among: u128,
    table: &Table,
    exact: &Exact<'_>,
    chain: &mut [u8; MAX_STATES],
) -> Option<usize> {
    // Forward gears by falling ratio.
    let mut order = [0_u8; MAX_STATES];
    let mut count = 0;
    for (s, state) in states.iter().enumerate() {
        if among >> s & 1 == 0 || table.kind(*state) != Kind::Forward {
            continue;
        }
        let mut at = count;
        while at > 0 && table.is_less(states[usize::from(order[at - 1])], *state, goal.closed, &goal.ranges, exact) {
            order[at] = order[at - 1];
            at -= 1;
        }
        order[at] = s as u8;
        count += 1;
    }
    if count < goal.forward {
        return None;
    }
    let order = &order[..count];
    if goal.progressive {
        return progressive(goal, states, order, table, exact, chain);
    }
    // Length of the longest chain that ends at each, and the state before it there.
    let mut length = [1_u8; MAX_STATES];
    let mut before = [u8::MAX; MAX_STATES];
    let (mut best, mut end) = (0, 0);
    for at in 0..count {
        let here = order[at];
        let beside = goal.neighbours[usize::from(here)];
        for from in (0..at).rev() {
            let other = order[from];
            if beside >> other & 1 == 1
                && length[from] >= length[at]
                && table.is_step(
                    states[usize::from(other)],
                    states[usize::from(here)],
                    goal.closed,
                    &goal.ranges,
                    exact,
                )
            {
                length[at] = length[from] + 1;
                before[at] = from as u8;
            }
        }
        if length[at] > best {
            (best, end) = (length[at], at);
        }
    }
    let length = usize::from(best);
    if length < goal.forward {
        return None;
    }
    let mut at = end;
    for place in (0..length).rev() {
        chain[place] = order[at];
        at = usize::from(before[at]);
    }
    Some(length)
}

/// The same where no step may be larger than the one before it, depth first.
fn progressive(
    goal: &Goal,
    states: &[usize],
    order: &[u8],
    table: &Table,
    exact: &Exact<'_>,
    chain: &mut [u8; MAX_STATES],
) -> Option<usize> {
    struct Walk<'a> {
        goal: &'a Goal,
        states: &'a [usize],
        order: &'a [u8],
        table: &'a Table,
        exact: &'a Exact<'a>,
        path: Vec<u8>,
        best: Vec<u8>,
    }
    impl Walk<'_> {
        fn ratio(&self, s: u8) -> f64 {
            self.table.ratio[self.states[usize::from(s)]]
        }
        fn go(&mut self, from: usize) {
            if self.path.len() > self.best.len() {
                self.best.clone_from(&self.path);
            }
            for at in from..self.order.len() {
                let here = self.order[at];
                if let Some(last) = self.path.last().copied() {
                    let states = [last, here].map(|s| self.states[usize::from(s)]);
                    if self.goal.neighbours[usize::from(last)] >> here & 1 == 0
                        || !self.table.is_step(states[0], states[1], self.goal.closed, &self.goal.ranges, self.exact)
                    {
                        continue;
                    }
                    if let [.., first, _] = self.path[..] {
                        let (old, new) = (self.ratio(first) / self.ratio(last), self.ratio(last) / self.ratio(here));
                        let near = (old / new - 1.0).abs() <= super::table::NEAR;
                        if !near && new > old || near && !self.falls([first, last, here]) {
                            continue;
                        }
                    }
                }
                self.path.push(here);
                self.go(at + 1);
                self.path.pop();
            }
        }
        /// Whether the second step is not larger, exactly.
        fn falls(&self, three: [u8; 3]) -> bool {
            let closed = self.goal.closed;
            let exact = three.map(|s| {
                let members = self.table.members(self.states[usize::from(s)], closed);
                self.exact.rational(&members[..closed])
            });
            let [Some(a), Some(b), Some(c)] = exact else { return false };
            &b / &c <= &a / &b
        }
    }
    let mut walk = Walk { goal, states, order, table, exact, path: vec![], best: vec![] };
    walk.go(0);
    let length = walk.best.len();
    chain[..length].copy_from_slice(&walk.best);
    (length >= goal.forward).then_some(length)
}

/// Whether some element can be left out and the wish still holds.
pub(crate) fn has_spare(goal: &Goal, found: &Found<'_>, table: &Table, exact: &Exact<'_>) -> bool {
    if binomial(goal.elements - 1, goal.closed) < goal.forward + goal.reverse {
        return false;
    }
    (0..goal.elements).any(|element| {
        let without = goal.masks.iter().enumerate().filter(|(_, m)| *m >> element & 1 == 0);
        let among = without.fold(0, |all, (s, _)| all | 1_u128 << s);
        longest_chain(goal, found.states, among, table, exact, &mut [0; MAX_STATES]).is_some()
            && has_reverse(goal, found.states, among, table)
    })
}
