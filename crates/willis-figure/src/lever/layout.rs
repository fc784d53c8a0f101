//! Where the points of the levers stand.
//!
//! A lever may be drawn at any scale and place. Its points are level with those of the other levers
//! for every member if the heights obey the same equations as speeds do: the heights are a motion
//! of the train, with the frame free to move. Of all such motions one is taken that shows every
//! lever long. A train in which two speeds settle all others has but one, and all its sets lie on
//! one line: the classical lever of four and more points.

use willis::exact::Rational;
use willis::train::MemberId;
use willis::unstable;

use super::family::Family;
use super::role::LeverRole;

/// Levers shorter than this part of the picture are drawn at their own scale.
const SHORTEST: f64 = 0.12;
/// Trials for the heights.
const TRIALS: usize = 600;
/// Most levers whose best order is sought.
const MOST_ORDERED: usize = 7;

pub(super) struct Placed {
    /// Families on each lever, from left to right.
    pub bars: Vec<Vec<usize>>,
    /// Whether a member stands equally high on all levers.
    pub level: bool,
    /// Height of the carrier and scale of each family.
    scales: Vec<[f64; 2]>,
}

impl Placed {
    pub fn height(&self, family: usize, number: f64) -> f64 {
        self.scales[family][0] + self.scales[family][1] * number
    }
}

pub(super) fn place(families: &[Family]) -> Placed {
    let shared = level(families);
    let level = shared.is_some();
    let scales = shared.unwrap_or_else(|| families.iter().map(alone).collect());
    let bars: Vec<Vec<usize>> = match level {
        true => combined(families, &scales),
        false => (0..families.len()).map(|f| vec![f]).collect(),
    };
    let bars = ordered(families, bars);
    Placed { bars, level, scales }
}

/// Points that stand for members outside the set: all but planets, and the carrier.
fn outside(family: &Family) -> impl Iterator<Item = (MemberId, &Rational)> + '_ {
    family.points.iter().filter(|p| p.role != LeverRole::Planet).map(|p| (p.member, &p.number))
}

/// From 0 to 1, suns above.
fn alone(family: &Family) -> [f64; 2] {
    let numbers: Vec<f64> = outside(family).map(|(_, n)| n.to_f64()).chain([0.0]).collect();
    let (low, high) = range(&numbers);
    let scale = upright(family, 1.0) / (high - low);
    [if scale > 0.0 { -low * scale } else { -high * scale }, scale]
}

fn range(all: &[f64]) -> (f64, f64) {
    all.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(*x), h.max(*x)))
}

/// The sign that brings suns above rings.
fn upright(family: &Family, scale: f64) -> f64 {
    let mean = |role| {
        let own = family.points.iter().filter(|p| p.role == role).map(|p| p.number.to_f64());
        let (n, sum) = own.fold((0, 0.0), |(n, sum), x| (n + 1, sum + x));
        if n == 0 { 0.0 } else { sum / f64::from(n) }
    };
    if (mean(LeverRole::Sun) - mean(LeverRole::Ring)) * scale < 0.0 { -1.0 } else { 1.0 }
}

/// Heights that every member has on all of its levers; none where some lever would be too short.
fn level(families: &[Family]) -> Option<Vec<[f64; 2]>> {
    let mut members: Vec<MemberId> = families.iter().flat_map(|f| outside(f).map(|p| p.0).chain([f.carrier])).collect();
    members.sort();
    members.dedup();
    let column = |m: MemberId| members.binary_search(&m).expect("every point is listed");
    let mut rows: Vec<Vec<Rational>> = Vec::new();
    for f in families {
        let (base, n) = outside(f).next()?;
        // The first is what all others are compared with.
        for (m, number) in outside(f).skip(1) {
            let mut row = vec![Rational::ZERO; members.len()];
            row[column(m)] += n.clone();
            row[column(base)] += -number.clone();
            row[column(f.carrier)] += number - n;
            rows.push(row);
        }
    }
    let pivots = unstable::reduce(&mut rows, members.len());
    let free: Vec<usize> = (0..members.len()).filter(|c| !pivots.contains(c)).collect();
    if free.len() < 2 {
        return None;
    }
    let basis: Vec<Vec<f64>> = free
        .iter()
        .map(|&k| {
            let mut v = vec![0.0; members.len()];
            v[k] = 1.0;
            pivots.iter().zip(&rows).for_each(|(&p, row)| v[p] = -row[k].to_f64());
            v
        })
        .collect();
    let own: Vec<Vec<usize>> =
        families.iter().map(|f| outside(f).map(|p| column(p.0)).chain([column(f.carrier)]).collect()).collect();
    let heights = |weights: &[f64]| -> Vec<f64> {
        (0..members.len()).map(|m| basis.iter().zip(weights).map(|(b, w)| b[m] * w).sum()).collect()
    };
    let worth = |h: &[f64]| -> f64 {
        let (low, high) = range(h);
        let size = (high - low).max(1e-300);
        let lengths: f64 = own
            .iter()
            .map(|o| {
                let (l, h) = range(&o.iter().map(|&m| h[m]).collect::<Vec<_>>());
                ((h - l) / size + 1e-9).ln()
            })
            .sum();
        // Different members at different heights, so that links are told apart.
        let mut sorted = h.to_vec();
        sorted.sort_by(f64::total_cmp);
        let gaps: f64 = sorted.windows(2).map(|w| ((w[1] - w[0]) / size + 0.02).ln()).sum();
        lengths / own.len() as f64 + 0.5 * gaps / members.len() as f64
    };
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let mut best = vec![0.0; free.len()];
    let mut most = f64::NEG_INFINITY;
    for trial in 0..TRIALS {
        // Anywhere first, then near the best.
        let step = 0.8 * (1.0 - trial as f64 / TRIALS as f64);
        let trial: Vec<f64> = match trial < TRIALS / 3 {
            true => (0..free.len()).map(|_| random.next()).collect(),
            false => best.iter().map(|b| b + step * random.next()).collect(),
        };
        let now = worth(&heights(&trial));
        if now > most {
            (best, most) = (trial, now);
        }
    }
    let mut h = heights(&best);
    let (low, high) = range(&h);
    let size = high - low;
    if size.is_nan() || size <= 0.0 {
        return None;
    }
    let turned: f64 = families
        .iter()
        .map(|f| {
            let (m, n) = outside(f).next().expect("as above");
            upright(f, (h[column(m)] - h[column(f.carrier)]) / n.to_f64())
        })
        .sum();
    h.iter_mut().for_each(|x| *x = if turned < 0.0 { (high - *x) / size } else { (*x - low) / size });
    let mut scales = Vec::new();
    for (f, own) in families.iter().zip(&own) {
        let (l, u) = range(&own.iter().map(|&m| h[m]).collect::<Vec<_>>());
        if u - l < SHORTEST {
            return None;
        }
        // From the point farthest from the carrier, for its round-off.
        let (m, n) = outside(f).max_by(|a, b| a.1.abs().cmp(&b.1.abs()))?;
        let base = h[column(f.carrier)];
        scales.push([base, (h[column(m)] - base) / n.to_f64()]);
    }
    Some(scales)
}

/// Sets that share two members at different heights lie on one line.
fn combined(families: &[Family], scales: &[[f64; 2]]) -> Vec<Vec<usize>> {
    let points = |f: usize| -> Vec<(MemberId, f64)> {
        let own = outside(&families[f]).map(move |(m, n)| (m, scales[f][0] + scales[f][1] * n.to_f64()));
        own.chain([(families[f].carrier, scales[f][0])]).collect()
    };
    let mut bars: Vec<Vec<usize>> = (0..families.len()).map(|f| vec![f]).collect();
    let fit = |a: &[usize], b: &[usize]| {
        let a: Vec<_> = a.iter().flat_map(|f| points(*f)).collect();
        let b: Vec<_> = b.iter().flat_map(|f| points(*f)).collect();
        let common: Vec<f64> = a.iter().filter(|(m, _)| b.iter().any(|(o, _)| o == m)).map(|p| p.1).collect();
        let (low, high) = range(&common);
        high - low > 1e-6
    };
    loop {
        let pair = (0..bars.len()).find_map(|i| (i + 1..bars.len()).find(|&j| fit(&bars[i], &bars[j])).map(|j| (i, j)));
        let Some((i, j)) = pair else { return bars };
        let more = bars.remove(j);
        bars[i].extend(more);
    }
}

/// The order in which links are shortest.
fn ordered(families: &[Family], bars: Vec<Vec<usize>>) -> Vec<Vec<usize>> {
    let n = bars.len();
    if !(3..=MOST_ORDERED).contains(&n) {
        return bars;
    }
    let members: Vec<Vec<MemberId>> = bars
        .iter()
        .map(|b| b.iter().flat_map(|f| outside(&families[*f]).map(|p| p.0).chain([families[*f].carrier])).collect())
        .collect();
    let mut all: Vec<MemberId> = members.iter().flatten().copied().collect();
    all.sort();
    all.dedup();
    let length = |order: &[usize]| -> usize {
        let span = |m: &MemberId| {
            let at: Vec<usize> = (0..n).filter(|k| members[order[*k]].contains(m)).collect();
            at.last().zip(at.first()).map_or(0, |(l, f)| l - f)
        };
        all.iter().map(span).sum()
    };
    let mut best: Vec<usize> = (0..n).collect();
    let mut least = length(&best);
    let mut order = best.clone();
    while next(&mut order) {
        let now = length(&order);
        if now < least {
            (best, least) = (order.clone(), now);
        }
    }
    best.into_iter().map(|k| bars[k].clone()).collect()
}

/// The next permutation in lexicographic order.
fn next(order: &mut [usize]) -> bool {
    let Some(i) = (1..order.len()).rev().find(|&i| order[i - 1] < order[i]) else { return false };
    let j = (i..order.len()).rev().find(|&j| order[j] > order[i - 1]).expect("the one at i is larger");
    order.swap(i - 1, j);
    order[i..].reverse();
    true
}

/// Numbers in −1 … 1, the same ones every time.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}
