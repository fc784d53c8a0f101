//! Trains made to be degenerate (basic ratios of one, efficiencies exactly on a self-locking threshold, equal sets, meshes
//! without losses or without motion, loads that vanish), beside an enumeration that owes the library nothing: gear pair by
//! gear pair, in fractions, every choice of drivers, and linear inequalities by Fourier and Motzkin.

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{One, Signed, ToPrimitive, Zero};
use willis::analysis::{OperationReport, Role, Selection, Verdict, Why, analyze};
use willis::train::Train;

type Q = BigRational;

fn q(n: i64, d: i64) -> Q {
    Q::new(BigInt::from(n), BigInt::from(d))
}

/// Numbers that look random and are the same in every run.
struct Dice(u64);

impl Dice {
    fn below(&mut self, n: usize) -> usize {
        // SplitMix64.
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % n as u64) as usize
    }

    fn one_of<T: Copy>(&mut self, all: &[T]) -> T {
        all[self.below(all.len())]
    }
}

/// Gear 1, gear 2, carrier; teeth, internal below 0; efficiency either way.
struct Pair {
    bodies: [usize; 3],
    teeth: [i64; 2],
    efficiency: [i64; 2],
}

struct Case {
    /// Members that are not planets.
    shafts: usize,
    /// Two for each set.
    pairs: Vec<Pair>,
    /// rad/s.
    speeds: [(usize, i64); 2],
    /// Torques, N m; none: it balances.
    torques: Vec<Option<i64>>,
    variator: Option<Path>,
    bus: Option<Bus>,
}

/// Two machines on a bus.
#[derive(Clone, Copy)]
struct Bus {
    members: [usize; 2],
    /// Of each, motoring and generating.
    efficiency: [[[i64; 2]; 2]; 2],
    /// What the store gives, W.
    store: i64,
}

/// A variator between two shafts; efficiency from the first to the second and back.
#[derive(Clone, Copy)]
struct Path {
    between: [usize; 2],
    efficiency: [[i64; 2]; 2],
}

/// Teeth that are near each other and efficiencies that are their fractions: thresholds are hit again and again.
fn case(dice: &mut Dice) -> Case {
    let sets = 1 + dice.below(3);
    let shafts = sets + 2;
    let mut pairs = vec![];
    for set in 0..sets {
        let mut of: Vec<usize> = vec![];
        while of.len() < 3 {
            // One of its own, so that the sets hang together.
            let next = if of.is_empty() { 2 + set } else { dice.below(2 + set) };
            if !of.contains(&next) {
                of.push(next);
            }
        }
        of.rotate_left(dice.below(3));
        let mut teeth = || dice.one_of(&[18, 19, 20, 20, 21, 22, 40]);
        let (first, planets, second) = (teeth(), [teeth(), teeth()], teeth());
        let efficiency =
            |dice: &mut Dice| dice.one_of(&[[1, 1], [19, 20], [9, 10], [20, 21], [18, 19], [97, 100], [1, 2]]);
        let ring = dice.below(3) == 0;
        let planet = shafts + set;
        pairs.push(Pair { bodies: [of[0], planet, of[2]], teeth: [first, planets[0]], efficiency: efficiency(dice) });
        let other = if ring { -(second + 2 * planets[1]) } else { second };
        let efficiency = if dice.below(2) == 0 { [1, 1] } else { efficiency(dice) };
        pairs.push(Pair { bodies: [planet, of[1], of[2]], teeth: [planets[1], other], efficiency });
    }
    let first = dice.below(shafts);
    let second = (first + 1 + dice.below(shafts - 1)) % shafts;
    let speeds = [(first, dice.below(4) as i64 - 1), (second, dice.below(4) as i64 - 1)];
    let open = dice.below(shafts);
    let also = (open + 1 + dice.below(shafts - 1)) % shafts;
    let torques = (0..shafts)
        .map(|m| (m != open && m != also).then(|| if dice.below(3) == 0 { 0 } else { dice.below(5) as i64 - 2 }))
        .collect();
    Case { shafts, pairs, speeds, torques, variator: None, bus: None }
}

/// Two shafts, and two efficiencies, forward and backward.
fn path(dice: &mut Dice, shafts: usize) -> ([usize; 2], [[i64; 2]; 2]) {
    let first = dice.below(shafts);
    let second = (first + 1 + dice.below(shafts - 1)) % shafts;
    let mut efficiency = || dice.one_of(&[[1, 1], [17, 20], [9, 10], [1, 2], [19, 20], [4, 5]]);
    let forward = efficiency();
    let backward = if efficiency() == forward { efficiency() } else { forward };
    ([first, second], [forward, backward])
}

/// The same with a variator, so that one member balances.
fn split(dice: &mut Dice) -> Case {
    let mut case = case(dice);
    let (between, efficiency) = path(dice, case.shafts);
    case.variator = Some(Path { between, efficiency });
    one_balances(&mut case, dice);
    case
}

/// The same with two machines on a bus.
fn hybrid(dice: &mut Dice) -> Case {
    let mut case = case(dice);
    let (members, first) = path(dice, case.shafts);
    let (_, second) = path(dice, case.shafts);
    let store = if dice.below(2) == 0 { 0 } else { dice.below(5) as i64 - 2 };
    case.bus = Some(Bus { members, efficiency: [first, second], store });
    one_balances(&mut case, dice);
    case
}

fn one_balances(case: &mut Case, dice: &mut Dice) {
    let also = case.torques.iter().rposition(Option::is_none).expect("two of them");
    case.torques[also] = Some(dice.below(5) as i64 - 2);
}

impl Case {
    fn text(&self) -> String {
        let name = |m: usize| if m < self.shafts { format!("s{m}") } else { format!("p{}", m - self.shafts) };
        let list =
            |of: &mut dyn Iterator<Item = usize>| of.map(|m| format!("{:?}", name(m))).collect::<Vec<_>>().join(", ");
        let sets = self.pairs.len() / 2;
        let mut text = format!(
            "format = 1\nname = \"degenerate\"\nmembers = [{}]\nterminals = [{}]\n",
            list(&mut (0..self.shafts + sets)),
            list(&mut (0..self.shafts))
        );
        for p in &self.pairs {
            let gear = |k: usize| {
                let internal = if p.teeth[k] < 0 { ", internal = true" } else { "" };
                format!("{{ member = {:?}, teeth = {}{internal} }}", name(p.bodies[k]), p.teeth[k].abs())
            };
            let [n, d] = p.efficiency;
            text += &format!(
                "[[mesh]]\ngears = [ {}, {} ]\ncarrier = {:?}\nefficiency = \"{n}/{d}\"\n",
                gear(0),
                gear(1),
                name(p.bodies[2])
            );
        }
        if let Some(Path { between: [a, b], efficiency: [[n, d], [bn, bd]] }) = self.variator {
            text += &format!(
                "[[variator]]\nname = \"v\"\nmembers = [{:?}, {:?}]\n\
                 efficiency = {{ forward = \"{n}/{d}\", backward = \"{bn}/{bd}\" }}\n",
                name(a),
                name(b)
            );
        }
        if let Some(Bus { members, efficiency, store }) = self.bus {
            let machine = |k: usize| {
                let [[n, d], [bn, bd]] = efficiency[k];
                format!(
                    "{{ name = \"M{k}\", member = {:?}, efficiency = {{ motoring = \"{n}/{d}\", generating = \"{bn}/{bd}\" }} }}",
                    name(members[k])
                )
            };
            let machines = [machine(0), machine(1)].join(", ");
            text += &format!("[[variator]]\nname = \"v\"\nmachines = [{machines}]\nstore = \"{store} W\"\n");
        }
        let speeds = self.speeds.map(|(m, w)| format!("{} = \"{w} rad/s\"", name(m))).join(", ");
        let given =
            self.torques.iter().enumerate().filter_map(|(m, t)| t.map(|t| format!("{} = \"{t} N m\"", name(m))));
        let torques = given.collect::<Vec<_>>().join(", ");
        text + &format!("[[operation]]\nname = \"o\"\nspeeds = {{ {speeds} }}\ntorques = {{ {torques} }}\n")
    }

    /// Speeds of all members, if the gears determine them.
    fn motion(&self) -> Option<Vec<Q>> {
        let n = self.shafts + self.pairs.len() / 2;
        let mut rows: Vec<Vec<Q>> = vec![];
        for p in &self.pairs {
            let mut row = vec![Q::zero(); n + 1];
            let [a, b] = p.teeth.map(|z| q(z, 1));
            row[p.bodies[0]] += &a;
            row[p.bodies[1]] += &b;
            row[p.bodies[2]] -= a + b;
            rows.push(row);
        }
        for (m, w) in self.speeds {
            let mut row = vec![Q::zero(); n + 1];
            row[m] = Q::one();
            row[n] = q(w, 1);
            rows.push(row);
        }
        let pivots = reduce(&mut rows, n);
        (pivots.len() == n).then(|| (0..n).map(|m| rows[m][n].clone()).collect())
    }
}

/// Gauss and Jordan; the pivot columns, of which row k has the k-th.
fn reduce(rows: &mut [Vec<Q>], columns: usize) -> Vec<usize> {
    let mut pivots = vec![];
    for c in 0..columns {
        let at = pivots.len();
        let Some(k) = (at..rows.len()).find(|&k| !rows[k][c].is_zero()) else { continue };
        rows.swap(at, k);
        let lead = rows[at][c].clone();
        rows[at].iter_mut().for_each(|x| *x /= &lead);
        let top = rows[at].clone();
        for (k, row) in rows.iter_mut().enumerate() {
            if k != at && !row[c].is_zero() {
                let factor = row[c].clone();
                row.iter_mut().zip(&top).for_each(|(x, t)| *x -= &factor * t);
            }
        }
        pivots.push(c);
    }
    pivots
}

/// The interval of `Σ c x + c₀` (the constant last) over the points with every `at_least_zero ≥ 0`; none if there are no
/// such points. Fourier and Motzkin: the unknowns are eliminated one by one.
fn interval(of: &[Q], at_least_zero: &[Vec<Q>]) -> Option<[Option<Q>; 2]> {
    let unknowns = of.len() - 1;
    // One more unknown z with z = of(x), as two inequalities; it is kept.
    let mut all: Vec<Vec<Q>> = vec![];
    for row in at_least_zero {
        all.push([&row[..unknowns], &[Q::zero()], &row[unknowns..]].concat());
    }
    let mut equal = [&of[..unknowns], &[-Q::one()], &of[unknowns..]].concat();
    all.push(equal.clone());
    equal.iter_mut().for_each(|x| *x = -x.clone());
    all.push(equal);
    for x in 0..unknowns {
        let (mut up, mut down, mut rest) = (vec![], vec![], vec![]);
        for row in all {
            if row[x].is_positive() {
                up.push(row);
            } else if row[x].is_negative() {
                down.push(row);
            } else {
                rest.push(row);
            }
        }
        for a in &up {
            for b in &down {
                let row: Vec<Q> = a.iter().zip(b).map(|(p, m)| p / &a[x] - m / &b[x]).collect();
                // The same again says nothing new.
                let scale = row.iter().find(|c| !c.is_zero()).map_or(Q::one(), |c| c.abs());
                let row: Vec<Q> = row.iter().map(|c| c / &scale).collect();
                if !rest.contains(&row) {
                    rest.push(row);
                }
            }
        }
        all = rest;
    }
    let (mut low, mut high): (Option<Q>, Option<Q>) = (None, None);
    for row in all {
        let (slope, constant) = (&row[unknowns], &row[unknowns + 1]);
        if slope.is_zero() {
            if constant.is_negative() {
                return None;
            }
        } else if slope.is_positive() {
            let bound = -constant / slope;
            low = Some(low.map_or(bound.clone(), |l| l.max(bound)));
        } else {
            let bound = -constant / slope;
            high = Some(high.map_or(bound.clone(), |h| h.min(bound)));
        }
    }
    match (&low, &high) {
        (Some(l), Some(h)) if l > h => None,
        _ => Some([low, high]),
    }
}

type Interval = [Option<Q>; 2];

/// What the enumeration finds: torques of the two balancing members, of single equilibria and of whole ranges.
#[derive(Default)]
struct Truth {
    points: Vec<[Q; 2]>,
    /// The forces at each of them: two may differ in these alone.
    forces: Vec<Vec<Q>>,
    ranges: Vec<[Interval; 2]>,
    /// No choice of drivers determines the forces.
    indeterminate: bool,
    speeds: Vec<Q>,
    open: Vec<usize>,
}

fn truth(case: &Case) -> Option<Truth> {
    let speeds = case.motion()?;
    let n = speeds.len();
    let pairs = case.pairs.len();
    // The unknown of a variator stands behind the tooth forces, as do the torques of machines.
    let k = pairs + usize::from(case.variator.is_some()) + 2 * usize::from(case.bus.is_some());
    let mut open: Vec<usize> = (0..case.shafts).filter(|&m| case.torques[m].is_none()).collect();
    let known: Vec<usize> = (0..n).filter(|m| !open.contains(m)).collect();
    assert_eq!(known.len() + usize::from(case.bus.is_some()), k);
    if open.len() == 1 {
        open.push(open[0]);
    }
    let mut sigma: Vec<Q> =
        case.pairs.iter().map(|p| (&speeds[p.bodies[0]] - &speeds[p.bodies[2]]) * q(p.teeth[0], 1)).collect();
    if let Some(Path { between: [a, b], .. }) = case.variator {
        if speeds[a].is_zero() && speeds[b].is_zero() {
            return None;
        }
        // Power v w_a w_b reaches b.
        sigma.push(&speeds[a] * &speeds[b]);
    }
    if let Some(Bus { members, .. }) = case.bus {
        let speeds = members.map(|m| speeds[m].clone());
        if speeds.iter().all(Zero::is_zero) {
            return None;
        }
        sigma.extend(speeds);
    }
    let mut truth = Truth { indeterminate: true, speeds: speeds.clone(), open, ..Truth::default() };
    for mask in 0..1usize << k {
        // Without motion or losses it does not matter which gear drives: one choice then.
        let lossy = |j: usize| match (case.pairs.get(j), case.variator, case.bus) {
            (Some(p), ..) => p.efficiency[0] != p.efficiency[1],
            (None, Some(v), _) => v.efficiency.iter().any(|[n, d]| n != d),
            (None, _, Some(bus)) => bus.efficiency[j - pairs].iter().any(|[n, d]| n != d),
            (None, None, None) => false,
        };
        let matters = |j: usize| !sigma[j].is_zero() && lossy(j);
        if (0..k).any(|j| mask >> j & 1 == 1 && !matters(j)) {
            continue;
        }
        let rho = |j: usize| {
            if let (true, Some(Path { efficiency: [[n, d], [bn, bd]], .. })) = (j == pairs, case.variator) {
                return match (matters(j), mask >> j & 1) {
                    (false, _) => Q::one(),
                    (_, 0) => q(d, n),
                    _ => q(bn, bd),
                };
            }
            let [a, b] = case.pairs[j].efficiency;
            match (matters(j), mask >> j & 1) {
                (false, _) => Q::one(),
                (_, 0) => q(a, b),
                _ => q(b, a),
            }
        };
        // Power that a machine takes from its bus, over that at its shaft.
        let taken =
            |machine: usize, efficiency: [[i64; 2]; 2]| match (matters(pairs + machine), mask >> (pairs + machine) & 1)
            {
                (false, _) => Q::one(),
                (_, 0) => q(efficiency[0][1], efficiency[0][0]),
                _ => q(efficiency[1][0], efficiency[1][1]),
            };
        let asks = |j: usize, m: usize| {
            if let (true, Some(bus)) = (j >= pairs, case.bus) {
                return if m == bus.members[j - pairs] { -Q::one() } else { Q::zero() };
            }
            if let (true, Some(Path { between: [a, b], .. })) = (j == pairs, case.variator) {
                // It exerts v w_a on b and −ρ v w_b on a.
                let on_a = if m == a { rho(j) * &speeds[b] } else { Q::zero() };
                return on_a - if m == b { speeds[a].clone() } else { Q::zero() };
            }
            let p = &case.pairs[j];
            let [a, b] = [q(p.teeth[0], 1), q(p.teeth[1], 1) * rho(j)];
            let mut sum = Q::zero();
            for (body, x) in [(p.bodies[0], a.clone()), (p.bodies[1], b.clone()), (p.bodies[2], -(a + b))] {
                if body == m {
                    sum += x;
                }
            }
            sum
        };
        let load = |m: usize| q(if m < case.shafts { case.torques[m].unwrap_or(0) } else { 0 }, 1);
        let mut rows: Vec<Vec<Q>> =
            known.iter().map(|&m| (0..k).map(|j| asks(j, m)).chain([load(m)]).collect()).collect();
        if let Some(bus) = case.bus {
            let mut row = vec![Q::zero(); k + 1];
            for machine in 0..2 {
                row[pairs + machine] = taken(machine, bus.efficiency[machine]) * &speeds[bus.members[machine]];
            }
            row[k] = q(bus.store, 1);
            rows.push(row);
        }
        let pivots = reduce(&mut rows, k);
        truth.indeterminate &= pivots.len() < k;
        if rows[pivots.len()..].iter().any(|row| !row[k].is_zero()) {
            continue;
        }
        // Forces over the free ones, the constant last.
        let free: Vec<usize> = (0..k).filter(|j| !pivots.contains(j)).collect();
        let forces: Vec<Vec<Q>> = (0..k)
            .map(|j| match pivots.iter().position(|&p| p == j) {
                Some(row) => free.iter().map(|&f| -rows[row][f].clone()).chain([rows[row][k].clone()]).collect(),
                None => free.iter().map(|&f| if f == j { Q::one() } else { Q::zero() }).chain([Q::zero()]).collect(),
            })
            .collect();
        let signs: Vec<Vec<Q>> = (0..k)
            .filter(|&j| matters(j))
            .map(|j| {
                let way = if mask >> j & 1 == 0 { sigma[j].signum() } else { -sigma[j].signum() };
                forces[j].iter().map(|x| x * &way).collect()
            })
            .collect();
        let torque = |m: usize| -> Vec<Q> {
            (0..=free.len()).map(|c| (0..k).map(|j| asks(j, m) * &forces[j][c]).sum()).collect()
        };
        let Some(_) = interval(&forces[0], &signs) else { continue };
        let fixed = |i: &Interval| i[0].is_some() && i[0] == i[1];
        let single = forces.iter().all(|f| fixed(&interval(f, &signs).expect("not empty")));
        let [a, b] = [truth.open[0], truth.open[1]].map(|m| interval(&torque(m), &signs).expect("not empty"));
        if single {
            let point = [a, b].map(|i| i[0].clone().expect("fixed"));
            let here =
                forces.iter().map(|f| interval(f, &signs).expect("not empty")[0].clone().expect("fixed")).collect();
            if !truth.forces.contains(&here) {
                truth.points.push(point);
                truth.forces.push(here);
            }
        } else {
            truth.ranges.push([a, b]);
        }
    }
    Some(truth)
}

/// The union of intervals, each with its ends, in order.
fn union(mut all: Vec<Interval>) -> Vec<Interval> {
    // The lowest first; none: without end.
    all.sort_by(|a, b| match (&a[0], &b[0]) {
        (None, None) => std::cmp::Ordering::Equal,
        (None, _) => std::cmp::Ordering::Less,
        (_, None) => std::cmp::Ordering::Greater,
        (Some(a), Some(b)) => a.cmp(b),
    });
    let mut merged: Vec<Interval> = vec![];
    for next in all {
        match merged.last_mut() {
            Some(last) if last[1].is_none() || next[0].as_ref() <= last[1].as_ref() => {
                let ends = last[1].is_some() && next[1].is_some();
                last[1] = if ends { last[1].clone().max(next[1].clone()) } else { None };
            }
            _ => merged.push(next),
        }
    }
    merged
}

fn near(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-9 * (a.abs() + b.abs()) + 1e-12
}

/// What is wrong with an answer; none if nothing is.
fn faults(case: &Case, truth: &Truth, o: &OperationReport) -> Option<String> {
    let acts = case.torques.iter().flatten().any(|t| *t != 0) || case.bus.is_some_and(|bus| bus.store != 0);
    if !acts {
        return (o.verdict != Verdict::Unloaded && o.verdict != Verdict::Undetermined)
            .then(|| format!("{:?}", o.verdict));
    }
    if truth.indeterminate {
        return (o.verdict != Verdict::Undetermined)
            .then(|| format!("{:?}, though forces are not determined", o.verdict));
    }
    let names: Vec<String> = truth.open.iter().map(|m| format!("s{m}")).collect();
    let found: Vec<_> = o.solutions.iter().chain(&o.dissipative_solutions).collect();
    let torques: Vec<[f64; 2]> = (found.iter())
        .map(|s| [0, 1].map(|k| s.members.get(&names[k]).and_then(|m| m.torque_n_m).unwrap_or(f64::NAN)))
        .collect();
    let same = |t: &[f64; 2], p: &[Q; 2]| (0..2).all(|k| near(t[k], p[k].to_f64().unwrap()));
    for point in &truth.points {
        if !torques.iter().any(|t| same(t, point)) {
            return Some(format!("{:?} is missing from {torques:?}", point.clone().map(|x| x.to_string())));
        }
    }
    let within = |t: f64, i: &Interval| {
        i[0].as_ref().is_none_or(|l| t >= l.to_f64().unwrap() - 1e-9)
            && i[1].as_ref().is_none_or(|h| t <= h.to_f64().unwrap() + 1e-9)
    };
    for t in &torques {
        let is_point = truth.points.iter().any(|p| same(t, p));
        let in_range = truth.ranges.iter().any(|r| within(t[0], &r[0]) && within(t[1], &r[1]));
        if !is_point && !in_range {
            return Some(format!("{t:?} is no equilibrium"));
        }
    }
    // Roles by exact signs.
    for (s, t) in found.iter().zip(&torques) {
        let Some(point) = truth.points.iter().find(|p| same(t, p)) else { continue };
        for k in 0..2 {
            let power = &point[k] * &truth.speeds[truth.open[k]];
            let role = s.members.get(&names[k]).unwrap().role;
            let fits = match (power.is_positive(), power.is_negative()) {
                (true, _) => role == Role::Input,
                (_, true) => role == Role::Output,
                _ => matches!(role, Role::Idle | Role::Fixed),
            };
            if !fits {
                return Some(format!("{} has power {power} and is {role:?}", names[k]));
            }
        }
    }
    for k in 0..2 {
        let wide = |i: &Interval| i[0].is_none() || i[0] != i[1];
        let expected = union(truth.ranges.iter().map(|r| r[k].clone()).filter(wide).collect());
        let told = match &o.why {
            Some(Why::Threshold { ranges }) => ranges.iter().filter(|r| r.member == names[k]).collect(),
            _ => vec![],
        };
        let exact = |t: Option<f64>| t.map(|t| Q::from_float(t).unwrap());
        let told = union(told.iter().map(|r| [exact(r.low_n_m), exact(r.high_n_m)]).collect());
        let close = |a: &Option<Q>, b: &Option<Q>| match (a, b) {
            (Some(a), Some(b)) => near(a.to_f64().unwrap(), b.to_f64().unwrap()),
            (a, b) => a.is_none() && b.is_none(),
        };
        if expected.len() != told.len() || !expected.iter().zip(&told).all(|(a, b)| (0..2).all(|e| close(&a[e], &b[e])))
        {
            let show = |all: &[Interval]| {
                format!("{:?}", all.iter().map(|i| i.clone().map(|x| x.map(|x| x.to_f64()))).collect::<Vec<_>>())
            };
            return Some(format!("{} has the ranges {}, told are {}", names[k], show(&expected), show(&told)));
        }
    }
    let several = truth.points.len() + truth.ranges.len();
    let verdict = match several {
        0 => o.verdict == Verdict::Locked,
        _ if !truth.ranges.is_empty() => o.verdict == Verdict::Multiple,
        1 => o.verdict == Verdict::Unique,
        _ => o.verdict == Verdict::Multiple,
    };
    (!verdict)
        .then(|| format!("{:?} with {} equilibria and {} ranges", o.verdict, truth.points.len(), truth.ranges.len()))
}

fn run(seeds: std::ops::Range<u64>, case: fn(&mut Dice) -> Case) {
    let (mut bad, mut compared, mut seen) = (vec![], 0, [0usize; 4]);
    for seed in seeds {
        let case = case(&mut Dice(seed));
        let Some(truth) = truth(&case) else { continue };
        let text = case.text();
        let train = Train::from_toml(&text).unwrap_or_else(|e| panic!("{seed}: {e}\n{text}"));
        let analysis = analyze(&train, &Selection::default()).unwrap_or_else(|e| panic!("{seed}: {e}\n{text}"));
        compared += 1;
        seen[0] += usize::from(truth.indeterminate);
        seen[1] += usize::from(!truth.ranges.is_empty());
        seen[2] += usize::from(truth.points.len() > 1);
        seen[3] += usize::from(!truth.indeterminate && truth.points.is_empty() && truth.ranges.is_empty());
        if let Some(fault) = faults(&case, &truth, &analysis.operations[0]) {
            bad.push(format!("{seed}: {fault}"));
        }
    }
    let [indeterminate, ranges, several, none] = seen;
    println!(
        "{compared} compared: {indeterminate} indeterminate, {ranges} with ranges, {several} with several points, {none} locked"
    );
    assert!(ranges > 0 && several > 0 && none > 0, "the trains are not degenerate enough");
    assert!(bad.is_empty(), "{} are wrong:\n{}", bad.len(), bad[..bad.len().min(40)].join("\n"));
}

#[test]
fn degenerate_trains_have_the_equilibria_of_an_exact_enumeration() {
    run(0..3000, case);
}

#[test]
fn splits_have_the_equilibria_of_an_exact_enumeration() {
    run(0..2000, split);
}

#[test]
fn machines_on_a_bus_have_the_equilibria_of_an_exact_enumeration() {
    run(0..2000, hybrid);
}

#[test]
#[ignore = "minutes; the first 2,000 of these trains are compared in every run"]
fn a_hundred_thousand_buses_have_the_equilibria_of_an_exact_enumeration() {
    run(0..100_000, hybrid);
}

#[test]
#[ignore = "minutes; the first 2,000 of these trains are compared in every run"]
fn a_hundred_thousand_splits_have_the_equilibria_of_an_exact_enumeration() {
    run(0..100_000, split);
}

#[test]
#[ignore = "three minutes; the first 3,000 of these trains are compared in every run"]
fn a_hundred_thousand_degenerate_trains_have_the_equilibria_of_an_exact_enumeration() {
    run(0..130_000, case);
}

/// Two suns on common planets, `first` and `second` teeth, or the second on the frame.
fn suns(first: i64, second: i64, held: bool, efficiency: &str, rest: &str) -> Train {
    let other = if held { "frame" } else { "b" };
    let members = if held { "\"a\", \"c\"" } else { "\"a\", \"b\", \"c\"" };
    Train::from_toml(&format!(
        "format = 1\nname = \"suns\"\nmembers = [{members}]\nterminals = [{members}]\n\
         [[set]]\nname = \"S\"\ntype = \"stepped\"\nsuns = [ {{ member = \"a\", teeth = {first}, planet_teeth = 20 }}, \
         {{ member = \"{other}\", teeth = {second}, planet_teeth = 20 }} ]\ncarrier = \"c\"\n\
         basic_efficiency = {efficiency}\n{rest}"
    ))
    .unwrap()
}

/// Basic ratio one: only friction balances the carrier, `T₂ = (ρ − 1) T₁` with ρ = η or 1/η.
#[test]
fn val_a_basic_ratio_of_one_has_two_equilibria() {
    let operation =
        "[[operation]]\nname = \"o\"\nspeeds = { a = \"1 rad/s\", c = \"2 rad/s\" }\ntorques = { c = \"1 N m\" }\n";
    let train = suns(20, 20, false, "0.9409", operation);
    let o = &analyze(&train, &Selection::default()).unwrap().operations[0];
    assert_eq!(o.verdict, Verdict::Multiple, "{:?}", o.reason);
    let eta = 0.9409;
    // Of a: −T₂/(1 − ρ) with the signs that agree.
    let mut expected = [1.0 / (eta - 1.0), 1.0 / (1.0 / eta - 1.0)];
    let mut torques: Vec<f64> = o.solutions.iter().map(|s| s.members.get("a").unwrap().torque_n_m.unwrap()).collect();
    torques.sort_by(f64::total_cmp);
    expected.sort_by(f64::total_cmp);
    assert_eq!(torques.len(), 2, "{torques:?}");
    assert!(torques.iter().zip(expected).all(|(t, e)| near(*t, e)), "{torques:?}, not {expected:?}");
}

/// Set A exactly on its threshold: an equilibrium with 10/19, and beside it every larger torque at the output.
#[test]
fn val_a_load_on_a_threshold_has_a_range() {
    let train = Train::from_toml(
        "format = 1\nname = \"threshold\"\nmembers = [\"input\", \"x\", \"output\"]\nterminals = [\"input\", \"output\"]\n\
         [[set]]\nname = \"A\"\ntype = \"stepped\"\nsuns = [ { member = \"output\", teeth = 20, planet_teeth = 20 }, \
         { member = \"input\", teeth = 19, planet_teeth = 20 } ]\ncarrier = \"x\"\nbasic_efficiency = 0.95\n\
         [[set]]\nname = \"B\"\ntype = \"stepped\"\nsuns = [ { member = \"frame\", teeth = 18, planet_teeth = 20 }, \
         { member = \"output\", teeth = 20, planet_teeth = 20 } ]\ncarrier = \"x\"\nbasic_efficiency = 0.9\n\
         [[operation]]\nname = \"o\"\nspeeds = { output = \"1 rad/s\" }\ntorques = { input = \"-1 N m\" }\n",
    )
    .unwrap();
    let o = &analyze(&train, &Selection::default()).unwrap().operations[0];
    assert_eq!(o.verdict, Verdict::Multiple, "{:?}", o.reason);
    let Some(Why::Threshold { ranges }) = &o.why else { panic!("{:?}", o.why) };
    let [range] = &ranges[..] else { panic!("{ranges:?}") };
    assert_eq!((range.member.as_str(), range.high_n_m), ("output", None));
    assert!(near(range.low_n_m.unwrap(), 1.0), "{range:?}");
    let first = o.solutions.iter().find(|s| near(s.members.get("output").unwrap().torque_n_m.unwrap(), 1.0));
    assert!(near(first.expect("the end of the range").efficiency.unwrap(), 10.0 / 19.0));
}

/// `η = (η₀ − R)/(1 − R)` with R = 99/100 and η₀ a hair above it: it drives, with next to nothing.
#[test]
fn val_next_to_a_threshold_table_and_operation_agree() {
    let operation = "[[operation]]\nname = \"o\"\nspeeds = { a = \"100 rad/s\" }\ntorques = { a = \"10 N m\" }\n";
    let train = suns(99, 100, true, "0.99000000000001", operation);
    let a = analyze(&train, &Selection::default()).unwrap();
    let (drive, o) = (&a.ratios.0[0].1.drive, &a.operations[0]);
    assert_eq!((drive.verdict, o.verdict), (Verdict::Unique, Verdict::Unique), "{:?}", o.reason);
    for efficiency in [drive.efficiency.unwrap(), o.solutions[0].efficiency.unwrap()] {
        assert!((efficiency - 1e-12).abs() < 1e-15, "{efficiency:e}");
    }
    assert_eq!(o.solutions[0].members.get("c").unwrap().role, Role::Output);
}
