//! The search over all layouts: parts of work, counts, the best rows.

use std::sync::Mutex;

use willis::diagnostic::{Code, Diagnostic, Diagnostics};
use willis::exact::Rational;
use willis::work::{Effort, Work};

use super::choose::{Chooser, Found, Goal, has_spare};
use super::efficiency::efficiency;
use super::harvest::{Harvest, Row, Tally, apart, fits, missing, parse, spoilt};
use super::layout::{GROUND, INPUT, Layout, Layouts, MAX_SHAFTS, OUTPUT, Prefix, count_layouts};
use super::measure;
use super::motion::{self, Motion};
use super::planar;
use super::points::{Points, may_join};
use super::table::{Exact, Kind, NEAR, Ranges, Table, Window, binomial};
use super::wish::{Order, Wish};

/// A search for shift schemes, checked and cut into parts.
///
/// The parts are stretches of the space of layouts in the order of their names. They are independent: they may run on
/// any machine in any order, their [`Harvest`]s are merged, and the answer is the same.
///
/// # Example
/// ```
/// use willis_synthesis::schemes::{Harvest, Search, Wish};
/// use willis::work::Serial;
///
/// let wish = Wish {
///     forward_range: "1/2..5".parse()?,
///     step: "1.15..2.2".parse()?,
///     reverse_range: "1.2..5".parse()?,
///     ..Wish::new(&["62/26", "74/42"], 5, 2, 4)?
/// };
/// let search = Search::new(&wish)?;
/// // Two machines, one after the other; what they send is JSON.
/// let mut whole = Harvest::default();
/// for machine in 0..2 {
///     let mut own = Harvest::default();
///     search.harvest(&Serial, (0..search.parts()).filter(|part| part % 2 == machine), &mut own);
///     whole.merge(&search, serde_json::from_str(&serde_json::to_string(&own)?)?)?;
/// }
/// let answer = search.answer(&whole);
/// assert!(answer.completeness.complete);
/// assert_eq!(answer.found.schemes, 350);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Search {
    pub(crate) wish: Wish,
    pub(crate) ratios: Vec<Rational>,
    teeth: Vec<[i128; 2]>,
    goal: Goal,
    space: Layouts,
    parts: Vec<Prefix>,
    /// Other orders of the sets, in which those with one tooth ratio are exchanged.
    orders: Vec<Vec<usize>>,
    /// The tooth ratios, and the efficiency of the meshes of a set in a row.
    losses: (Vec<f64>, f64),
}

impl Harvest {
    /// Reads what was kept of a search.
    ///
    /// # Errors
    /// It is none, it is spoilt, or it is that of another search.
    pub fn read(text: &str, search: &Search) -> Result<Self, Diagnostics> {
        let own: Self = parse(text)?;
        fits(&own.wish, &search.name(), &own.done, search.parts())?;
        own.sound(search).then_some(()).ok_or_else(spoilt)?;
        Ok(own)
    }

    /// Whether its numbers can come from a search.
    fn sound(&self, search: &Search) -> bool {
        let Tally { choices, enough, chain, reverse, attached, minimal, limits, schemes, .. } = self.tally;
        let stages = [choices, enough, chain, reverse];
        let rules = [attached, minimal, limits, schemes];
        let wish = search.wish();
        let brakes = self.tally.by_brakes.iter().try_fold(0_u64, |sum, (_, n)| sum.checked_add(*n));
        let row = |row: &Row| {
            let own = [row.layout.sets(), row.layout.shafts(), row.elements.len()];
            let is_last = |e: &[u8; 2]| e[0] < e[1] && usize::from(e[1]) < row.layout.shafts();
            own == [wish.sets.len(), wish.shafts() + 1, wish.elements]
                && row.elements.iter().all(is_last)
                && row.elements.is_sorted()
                && row.key.is_finite()
                && wish.layout.is_none_or(|layout| layout == row.layout)
        };
        stages.is_sorted_by(|a, b| a >= b)
            && rules.is_sorted_by(|a, b| a >= b)
            && brakes == Some(schemes)
            && self.tally.classes <= schemes
            && self.rows.len() as u64 == schemes.min(wish.top as u64)
            && self.rows.iter().all(row)
    }

    /// Adds what other parts of the same search have found.
    ///
    /// # Errors
    /// It belongs to another wish, or a part is in both.
    pub fn merge(&mut self, search: &Search, other: Self) -> Result<(), Diagnostics> {
        apart(&self.done, &other.done)?;
        for one in [&*self, &other] {
            fits(&one.wish, &search.name(), &one.done, search.parts())?;
        }
        self.wish = search.name();
        self.done.extend(other.done);
        self.done.sort_unstable();
        self.tally.add(&other.tally);
        self.rows.extend(other.rows);
        search.keep_best(&mut self.rows);
        Ok(())
    }
}

impl Search {
    /// Checks a wish and makes it ready.
    ///
    /// # Errors
    /// What [`Wish::check`] says.
    pub fn new(wish: &Wish) -> Result<Self, Diagnostics> {
        wish.check()?;
        let ratios = wish.ratios();
        let teeth = motion::teeth(&ratios).unwrap_or_default();
        let window = |b: &super::wish::Bounds| Window::new(b.min.as_ref(), b.max.as_ref());
        let reverse = (wish.reverse > 0).then(|| window(&wish.reverse_range));
        let ranges = Ranges::new(window(&wish.forward_range), reverse, window(&wish.step));
        let counts = [wish.elements, wish.closed, wish.forward, wish.reverse];
        let goal = Goal::new(counts, wish.progressive, ranges);
        let space = Layouts::new(wish.sets.len(), wish.shafts());
        let given = (3 * (wish.sets.len() - 1)).min(6);
        let mut parts = space.prefixes(given);
        if let Some(layout) = &wish.layout {
            parts.retain(|p| p.holds(layout));
        }
        let orders = orders(&ratios);
        let eta = wish.mesh_efficiencies.iter().map(Rational::to_f64).product();
        let losses = (ratios.iter().map(Rational::to_f64).collect(), eta);
        Ok(Self { wish: wish.clone(), ratios, teeth, goal, space, parts, orders, losses })
    }

    /// The wish.
    pub fn wish(&self) -> &Wish {
        &self.wish
    }

    /// Into how many parts the work is cut.
    pub fn parts(&self) -> usize {
        self.parts.len()
    }

    /// The parts of share `k` of `n` shares of about the same work, counted from 0.
    pub fn shard(&self, k: usize, n: usize) -> impl Iterator<Item = usize> + use<> {
        (k..self.parts()).step_by(n.max(1))
    }

    /// Layouts of the space.
    pub fn layouts(&self) -> u64 {
        if self.wish.layout.is_some() {
            return 1;
        }
        let counts = count_layouts(self.wish.sets.len());
        counts.get(&self.wish.shafts()).map_or(0, |n| u64::try_from(*n).unwrap_or(u64::MAX))
    }

    /// Choices of elements of the space, if no two elements of a layout were the same.
    pub fn most_choices(&self) -> f64 {
        let shafts = self.wish.shafts();
        let elements = shafts * (shafts + 1) / 2 - 2;
        let choices = (0..self.wish.elements).fold(1.0, |c, j| c * elements.saturating_sub(j) as f64 / (j + 1) as f64);
        self.layouts() as f64 * choices
    }

    /// How long the search takes.
    pub fn effort(&self) -> Effort {
        self.effort_of(self.parts())
    }

    /// How long so many of its parts take.
    pub fn effort_of(&self, parts: usize) -> Effort {
        let shafts = self.wish.shafts();
        let states = binomial(shafts * (shafts + 1) / 2 - 2, self.wish.closed);
        let share = parts as f64 / self.parts().max(1) as f64;
        let layouts = (self.layouts().div_ceil(self.wish.sample.max(1) as u64) as f64 * share).ceil() as u64;
        Effort::new("layouts", layouts, 5e-6 + 5e-8 * states as f64)
    }

    /// What tells this search from others.
    pub(crate) fn name(&self) -> String {
        serde_json::to_string(&self.wish).unwrap_or_default()
    }

    /// Whether the search may take as long as it does.
    ///
    /// # Errors
    /// It may not.
    pub fn afford(&self, work: &dyn Work) -> Result<(), Diagnostics> {
        self.afford_parts(work, self.parts())
    }

    /// Whether so many parts of it may take as long as they do.
    ///
    /// # Errors
    /// They may not.
    pub fn afford_parts(&self, work: &dyn Work, parts: usize) -> Result<(), Diagnostics> {
        let Err(too_long) = work.afford(&self.effort_of(parts)) else { return Ok(()) };
        let most = self.most_choices();
        let message = format!("{too_long}; up to {most:.1e} choices of {} elements", self.wish.elements);
        let hint = "keep the connections of one `layout`, give fewer sets or elements, search a `sample` (1 of 100 \
                    layouts) or a `shard` (1/100), or say `yes` to let it go on";
        Err(Diagnostic::new(Code::TooLong, "", message).hint(hint).into())
    }

    /// Searches some of the parts and adds what they find to a harvest; parts that it has already are left out.
    ///
    /// If the work is cancelled, the parts that were not begun are missing; the rest of the harvest holds.
    pub fn harvest(&self, work: &dyn Work, parts: impl IntoIterator<Item = usize>, into: &mut Harvest) {
        let parts = missing(parts, self.parts(), &into.done);
        work.begin("parts", parts.len() as u64);
        let whole = Mutex::new(std::mem::take(into));
        // Every thread that comes takes a room or makes one.
        let rooms: Mutex<Vec<Room>> = Mutex::default();
        work.run(parts.len(), &|k| {
            let kept = rooms.lock().unwrap_or_else(std::sync::PoisonError::into_inner).pop();
            let mut room = kept.unwrap_or_else(|| self.room());
            let own = self.part(parts[k], &mut room, work);
            rooms.lock().unwrap_or_else(std::sync::PoisonError::into_inner).push(room);
            let Some(own) = own else { return };
            let mut whole = whole.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
            whole.done.push(parts[k]);
            whole.tally.add(&own.tally);
            whole.rows.extend(own.rows);
            self.keep_best(&mut whole.rows);
            drop(whole);
            work.advance(1);
        });
        *into = whole.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
        into.done.sort_unstable();
        into.wish = self.name();
    }

    fn room(&self) -> Room {
        Room { points: Points::default(), table: Table::new(self.wish.closed + 1) }
    }

    pub(crate) fn keep_best(&self, rows: &mut Vec<Row>) {
        rows.sort_by(Row::order);
        rows.truncate(self.wish.top);
    }

    /// One part; none where the work was cancelled within it.
    fn part(&self, part: usize, room: &mut Room, work: &dyn Work) -> Option<Harvest> {
        let mut harvest = Harvest::default();
        // Parts are not all as long as the distance of samples: where the first lies in them differs.
        let mut number = part.wrapping_mul(7919) % self.wish.sample;
        if let Some(layout) = &self.wish.layout {
            self.layout(layout, room, &mut harvest);
            return Some(harvest);
        }
        let whole = self.space.walk(&self.parts[part], &mut |layout| {
            number += 1;
            if number.is_multiple_of(self.wish.sample) {
                self.layout(layout, room, &mut harvest);
            }
            !number.is_multiple_of(64) || !work.cancelled()
        });
        whole.then_some(harvest)
    }

    /// Whether a layout with elements, which are sorted, is one of the schemes that are searched for. It is searched for
    /// in its layout, by all rules of the wish.
    pub(crate) fn is_scheme(&self, layout: &Layout, elements: &[[u8; 2]]) -> bool {
        let wish = Wish { layout: Some(*layout), top: usize::MAX, ..self.wish.clone() };
        let Ok(search) = Self::new(&wish) else { return false };
        if self.wish.layout.is_some_and(|own| own != *layout) {
            return false;
        }
        let mut harvest = Harvest::default();
        search.layout(layout, &mut search.room(), &mut harvest);
        harvest.rows.iter().any(|row| row.elements == elements)
    }

    /// One layout.
    fn layout(&self, layout: &Layout, room: &mut Room, harvest: &mut Harvest) {
        let tally = &mut harvest.tally;
        tally.layouts += 1;
        let mut same: Vec<[u8; MAX_SHAFTS]> = vec![];
        for order in &self.orders {
            let (other, renamed) = layout.reordered(order);
            match other.cmp(layout) {
                std::cmp::Ordering::Less if self.wish.layout.is_none() => {
                    tally.exchanged += 1;
                    return;
                }
                std::cmp::Ordering::Equal => same.push(renamed),
                _ => {}
            }
        }
        let Some(motion) = Motion::of(layout, &self.teeth) else {
            tally.dependent += 1;
            return;
        };
        let turns = room.points.fill_from(&motion, may_join);
        let points = &room.points;
        tally.choices += points.choices(self.wish.elements);
        if !turns {
            tally.dependent += 1;
            return;
        }
        let exact = Exact { layout, ratios: &self.ratios, points };
        room.table.fill(points, &self.goal.ranges, &exact);
        let table = &room.table;
        let mut chooser = Chooser::new(&self.goal, points, table, &exact);
        let (schemes, rows) = (tally.schemes, &mut harvest.rows);
        let mut attachments = [0_u8; MAX_SHAFTS];
        layout.blocks().iter().for_each(|b| attachments[usize::from(*b)] += 1);
        for end in [INPUT, OUTPUT].map(usize::from) {
            attachments[end] += u8::from(attachments[end] > 0);
        }
        attachments[usize::from(GROUND)] = 2;
        chooser.run(&mut |found| {
            let hardware: u64 = found.points.iter().map(|p| points.at(*p).len() as u64).product();
            tally.reverse += hardware;
            // The same for all elements at these points, and computed when a first scheme needs it.
            let spare = std::cell::OnceCell::new();
            let mut some = false;
            self.multiply(found, points, &attachments, layout.shafts(), &mut |elements, own| {
                if same.iter().any(|renamed| renamed_is_less(own, renamed)) {
                    return;
                }
                tally.attached += 1;
                if self.wish.minimal && *spare.get_or_init(|| has_spare(&self.goal, found, table, &exact)) {
                    return;
                }
                tally.minimal += 1;
                let brakes = elements.iter().filter(|e| e.contains(&GROUND)).count();
                let Some(key) = self.judge(layout, &motion, found, table, elements, brakes) else { return };
                tally.limits += 1;
                if self.wish.planar && !planar::is_planar(layout, elements) {
                    return;
                }
                tally.schemes += 1;
                some = true;
                *tally.by_brakes.entry(brakes).or_default() += 1;
                rows.push(Row { key, layout: *layout, elements: own.to_vec() });
                if rows.len() >= self.wish.top.saturating_mul(2).saturating_add(1000) {
                    self.keep_best(rows);
                }
            });
            tally.classes += u64::from(some);
        });
        tally.enough += chooser.passed.enough;
        tally.chain += chooser.passed.chain;
        tally.layouts_with_scheme += u64::from(tally.schemes > schemes);
    }

    /// Calls `visit` with every choice of elements at the points by which no shaft dangles: in the order of the points,
    /// and sorted.
    fn multiply(
        &self,
        found: &Found<'_>,
        points: &Points,
        attachments: &[u8; MAX_SHAFTS],
        shafts: usize,
        visit: &mut Visit<'_>,
    ) {
        let count = found.points.len();
        let mut digits = [0; super::choose::MAX_ELEMENTS];
        let mut elements = [[0_u8; 2]; super::choose::MAX_ELEMENTS];
        loop {
            let mut ends = *attachments;
            for (n, point) in found.points.iter().enumerate() {
                elements[n] = points.at(*point)[digits[n]];
                ends[usize::from(elements[n][0])] += 1;
                ends[usize::from(elements[n][1])] += 1;
            }
            if ends[..shafts].iter().all(|n| *n >= 2) {
                let mut sorted = elements;
                sorted[..count].sort_unstable();
                visit(&elements[..count], &sorted[..count]);
            }
            let mut at = 0;
            while at < count {
                digits[at] += 1;
                if digits[at] < points.at(found.points[at]).len() {
                    break;
                }
                digits[at] = 0;
                at += 1;
            }
            if at == count {
                return;
            }
        }
    }

    /// Whether speeds, torques and the number of brakes are within their limits, and what the scheme is ordered by.
    fn judge(
        &self,
        layout: &Layout,
        motion: &Motion,
        found: &Found<'_>,
        table: &Table,
        elements: &[[u8; 2]],
        brakes: usize,
    ) -> Option<f64> {
        let wish = &self.wish;
        if wish.max_brakes.is_some_and(|most| brakes > most) {
            return None;
        }
        let ratio = |s: &u8| table.ratio[found.states[usize::from(*s)]];
        let key = match wish.order {
            Order::Spread => -ratio(found.chain.first()?) / ratio(found.chain.last()?),
            Order::Step => found.chain.windows(2).map(|w| ratio(&w[0]) / ratio(&w[1])).fold(1.0, f64::max),
            _ => 0.0,
        };
        let with_losses = wish.min_efficiency.is_some() || wish.order == Order::Efficiency;
        let with_limits = wish.max_speed.is_some() || wish.max_torque.is_some();
        if !with_losses && !with_limits && !matches!(wish.order, Order::Speed | Order::Torque) {
            return Some(key);
        }
        let reverse = (0..found.states.len()).filter(|s| table.kind(found.states[*s]) == Kind::Reverse);
        let gears = found.chain.iter().map(|s| usize::from(*s)).chain(reverse.take(self.goal.reverse));
        let mut worst = [0.0_f64; 2];
        let (k, eta) = (&self.losses.0, self.losses.1);
        let mut least = 1.0_f64;
        for gear in gears {
            let mask = self.goal.masks()[gear];
            let closed: Vec<[u8; 2]> =
                (0..elements.len()).filter(|e| mask >> e & 1 == 1).map(|e| elements[e]).collect();
            let (speeds, torque) = measure::speeds_and_torque(motion, &closed)?;
            let own = [speeds.iter().fold(0.0_f64, |m, w| m.max(w.abs())), torque];
            for (kind, limit) in [&wish.max_speed, &wish.max_torque].into_iter().enumerate() {
                worst[kind] = worst[kind].max(own[kind]);
                let Some(limit) = limit else { continue };
                let near = (own[kind] / limit.to_f64() - 1.0).abs() < NEAR;
                let above = match (near, kind) {
                    (false, _) => own[kind] > limit.to_f64(),
                    (true, 0) => motion::speeds(layout, &self.ratios, &closed)?.iter().any(|w| w.abs() > *limit),
                    _ => measure::torques(layout, &self.ratios, &closed)?[1..].iter().any(|t| t.abs() > *limit),
                };
                if above {
                    return None;
                }
            }
            if with_losses {
                // A gear without an efficiency of its own is the worst of all; a wish for one excludes it.
                least = least.min(efficiency(layout, k, eta, &speeds, &closed).unwrap_or(0.0));
                if wish.min_efficiency.as_ref().is_some_and(|min| least < min.to_f64() - ROUNDING) {
                    return None;
                }
            }
        }
        Some(match wish.order {
            Order::Speed => worst[0],
            Order::Torque => worst[1],
            Order::Efficiency => -least,
            _ => key,
        })
    }
}

/// Rounding of an efficiency: one on the limit is not below it.
const ROUNDING: f64 = 1e-12;

/// What is called with elements in the order of their points, and with the same, sorted.
type Visit<'a> = dyn FnMut(&[[u8; 2]], &[[u8; 2]]) + 'a;

/// What one thread works in.
struct Room {
    points: Points,
    table: Table,
}

/// Whether elements, with their shafts renamed, come before themselves.
fn renamed_is_less(elements: &[[u8; 2]], renamed: &[u8; MAX_SHAFTS]) -> bool {
    // A shaft without members keeps its number: only elements join it, and the renaming does not touch it.
    let name = |s: u8| match renamed[usize::from(s)] {
        u8::MAX => s,
        other => other,
    };
    let mut other: Vec<[u8; 2]> = elements.iter().map(|[x, y]| [name(*x), name(*y)]).collect();
    for pair in &mut other {
        pair.sort_unstable();
    }
    other.sort_unstable();
    other.as_slice() < elements
}

/// All orders of sets, but the given one, in which sets of equal ratio are exchanged.
fn orders(ratios: &[Rational]) -> Vec<Vec<usize>> {
    fn go(ratios: &[Rational], order: &mut Vec<usize>, all: &mut Vec<Vec<usize>>) {
        let at = order.len();
        if at == ratios.len() {
            all.push(order.clone());
            return;
        }
        for set in 0..ratios.len() {
            if ratios[set] == ratios[at] && !order.contains(&set) {
                order.push(set);
                go(ratios, order, all);
                order.pop();
            }
        }
    }
    let mut all = vec![];
    go(ratios, &mut vec![], &mut all);
    all.retain(|order| !order.is_sorted());
    all
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use willis::work::Serial;

    use super::*;
    use crate::schemes::scheme::{State, chain, reverse};

    /// Rank by elimination over rational numbers.
    fn rank(mut rows: Vec<Vec<Rational>>) -> usize {
        let mut rank = 0;
        for column in 0..rows[0].len() {
            let Some(found) = (rank..rows.len()).find(|r| !rows[*r][column].is_zero()) else { continue };
            rows.swap(rank, found);
            let pivot = rows[rank].clone();
            for row in &mut rows[rank + 1..] {
                let factor = &row[column] / &pivot[column];
                for (x, p) in row.iter_mut().zip(&pivot) {
                    *x = &*x - &(&factor * p);
                }
            }
            rank += 1;
        }
        rank
    }

    /// The schemes of one layout, every choice of elements tested from the equations of the sets.
    fn every_choice(wish: &Wish, layout: &Layout) -> Vec<Vec<[u8; 2]>> {
        let ratios = wish.ratios();
        let shafts = layout.shafts();
        let row = |entries: &[(u8, Rational)]| {
            let mut row = vec![Rational::ZERO; shafts];
            entries.iter().filter(|(s, _)| *s != GROUND).for_each(|(s, x)| row[usize::from(*s)] = x.clone());
            row
        };
        let sets: Vec<Vec<Rational>> = layout
            .blocks()
            .chunks(3)
            .zip(&ratios)
            .map(|(b, k)| row(&[(b[0], Rational::ONE), (b[1], k.clone()), (b[2], -(k + &Rational::ONE))]))
            .collect();
        let with = |elements: &[[u8; 2]]| {
            let more = elements.iter().map(|[x, y]| row(&[(*x, Rational::ONE), (*y, Rational::from(-1))]));
            rank(sets.iter().cloned().chain(more).collect())
        };
        let free = with(&[]);
        if free < ratios.len() {
            return vec![];
        }
        let pairs = (0..shafts as u8).flat_map(|x| (x + 1..shafts as u8).map(move |y| [x, y]));
        let pairs: Vec<[u8; 2]> = pairs.filter(|p| may_join(p[0], p[1]) && with(&[*p]) > free).collect();
        let mut same = vec![vec![false; pairs.len()]; pairs.len()];
        let mut speeds = BTreeMap::new();
        for i in 0..pairs.len() {
            for j in i + 1..pairs.len() {
                same[i][j] = with(&[pairs[i], pairs[j]]) == free + 1;
                speeds.insert([i, j], motion::speeds(layout, &ratios, &[pairs[i], pairs[j]]));
            }
        }
        let mut found = vec![];
        for bits in (0..1_u32 << pairs.len()).filter(|b| b.count_ones() as usize == wish.elements) {
            let own: Vec<usize> = (0..pairs.len()).filter(|e| bits >> e & 1 == 1).collect();
            let pair = |k: usize, l: usize| [own[k], own[l]];
            let twos: Vec<[usize; 2]> = (0..own.len()).flat_map(|l| (0..l).map(move |k| [k, l])).collect();
            if twos.iter().any(|[k, l]| same[own[*k]][own[*l]]) {
                continue;
            }
            let mut ends = vec![0; shafts];
            layout.blocks().iter().for_each(|b| ends[usize::from(*b)] += 1);
            for end in [INPUT, OUTPUT] {
                let own = &mut ends[usize::from(end)];
                *own += usize::from(*own > 0);
            }
            own.iter().for_each(|e| pairs[*e].iter().for_each(|s| ends[usize::from(*s)] += 1));
            if (0..shafts).any(|s| s != usize::from(GROUND) && ends[s] < 2) {
                continue;
            }
            let states: Vec<State> = twos
                .iter()
                .filter_map(|[k, l]| {
                    let speeds = speeds[&pair(*k, *l)].clone()?;
                    Some(State { mask: 1 << k | 1 << l, ratio: speeds[1].recip(), speeds })
                })
                .collect();
            if chain(wish, &states).len() >= wish.forward && reverse(wish, &states).len() >= wish.reverse {
                found.push(own.iter().map(|e| pairs[*e]).collect());
            }
        }
        found.sort();
        found
    }

    fn pruned(wish: &Wish, layout: &Layout) -> Vec<Vec<[u8; 2]>> {
        let search = Search::new(&Wish { layout: Some(*layout), top: usize::MAX, ..wish.clone() }).unwrap();
        let mut harvest = Harvest::default();
        search.harvest(&Serial, 0..search.parts(), &mut harvest);
        assert_eq!(harvest.rows.len() as u64, harvest.tally.schemes);
        harvest.rows.into_iter().map(|row| row.elements).collect()
    }

    /// The second way: no points, no pruning, no floating point. Tooth ratios of small numbers and windows that end
    /// where ratios lie, so that ends are touched and ratios are equal.
    #[test]
    fn the_pruned_search_finds_what_testing_everything_finds() {
        let cases = [
            (["62/26", "74/42"], [4, 2, 3], ["1/2..5", "1.15..2.2", "1.2..5"], false),
            (["2", "3"], [4, 2, 3], ["1/3..4", "4/3..2", "2..4"], false),
            (["2", "3"], [4, 2, 3], ["..4", "..2", ".."], false),
            (["2", "3"], [4, 2, 3], ["1/3..", "..", "2.."], true),
        ];
        let mut touched = 0;
        for (n, (sets, [elements, closed, forward], ranges, progressive)) in cases.into_iter().enumerate() {
            let mut wish = Wish { progressive, minimal: false, ..Wish::new(&sets, elements, closed, forward).unwrap() };
            [wish.forward_range, wish.step, wish.reverse_range] = ranges.map(|r| r.parse().unwrap());
            let space = Layouts::new(2, 5);
            let mut number = 0;
            for prefix in space.prefixes(0) {
                space.walk(&prefix, &mut |layout| {
                    number += 1;
                    if number % 7 == n {
                        let found = pruned(&wish, layout);
                        assert_eq!(found, every_choice(&wish, layout), "{layout} for case {n}");
                        touched += found.len();
                    }
                    true
                });
            }
        }
        assert!(touched > 100, "{touched}");
    }

    #[test]
    fn alike_sets_are_exchanged_without_losing_a_scheme() {
        // The same space with one ratio twice: every layout is there as it is and exchanged.
        let mut wish = Wish { top: usize::MAX, ..Wish::new(&["2", "2"], 4, 2, 3).unwrap() };
        [wish.forward_range, wish.step] = ["1/3..4", "1.2..2.5"].map(|r| r.parse().unwrap());
        let mut once = Harvest::default();
        let search = Search::new(&wish).unwrap();
        search.harvest(&Serial, 0..search.parts(), &mut once);
        let mut all = std::collections::BTreeSet::new();
        for row in &once.rows {
            let own = (row.layout, row.elements.clone());
            let (layout, renamed) = row.layout.reordered(&[1, 0]);
            let mut elements: Vec<[u8; 2]> = row.elements.iter().map(|e| e.map(|s| renamed[usize::from(s)])).collect();
            elements.iter_mut().for_each(|e| e.sort_unstable());
            elements.sort_unstable();
            assert!(own <= (layout, elements.clone()));
            assert!(all.insert(own.clone()));
            assert!((layout, elements.clone()) == own || all.insert((layout, elements)));
        }
        let mut plain = search.clone();
        plain.orders.clear();
        let mut every = Harvest::default();
        plain.harvest(&Serial, 0..plain.parts(), &mut every);
        assert_eq!(every.tally.schemes, all.len() as u64);
        assert!(every.rows.iter().all(|row| all.contains(&(row.layout, row.elements.clone()))));
    }

    #[test]
    fn torques_and_speeds_agree_with_those_of_rational_numbers() {
        let ratios: Vec<Rational> = ["96/48", "96/48", "111/69", "85/23"].map(|t| t.parse().unwrap()).into();
        let layout: Layout = "345360678751".parse().unwrap();
        let motion = Motion::of(&layout, &motion::teeth(&ratios).unwrap()).unwrap();
        for closed in [[[2, 3], [2, 4], [0, 7]], [[2, 4], [1, 8], [6, 7]], [[2, 3], [2, 4], [1, 8]]] {
            let speeds = motion::speeds(&layout, &ratios, &closed).unwrap();
            let torques = measure::torques(&layout, &ratios, &closed).unwrap();
            // Power in and power out are equal.
            assert_eq!(&torques[0] * &speeds[1], Rational::from(-1));
            let most = |all: &[Rational]| all.iter().map(|x| x.to_f64().abs()).fold(0.0, f64::max);
            let (moving, torque) = measure::speeds_and_torque(&motion, &closed).unwrap();
            let speed = moving.iter().fold(0.0_f64, |m, w| m.max(w.abs()));
            assert!((speed - most(&speeds)).abs() < 1e-12 && (torque - most(&torques[1..])).abs() < 1e-12);
        }
    }
}
