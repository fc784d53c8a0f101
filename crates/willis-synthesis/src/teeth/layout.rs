//! A layout without its tooth numbers: which ratio each state has as a function of the basic ratios of the sets.
//!
//! A layout comes from any train, with any tooth numbers; those of the sets that are designed become variables. Every
//! set has one basic ratio for each central gear beyond the first, all positive:
//!
//! | set | variables |
//! |---|---|
//! | sun, ring | `r/s` |
//! | sun, two rings on stepped planets (3K, Wolfrom) | `r1/s`, `p1 r2/(s p2)` |
//! | sun and ring on the two steps of the planets | `p1 r/(s p2)` |
//! | two rings on the two steps of the planets | `p1 r2/(r1 p2)` |
//! | Ravigneaux | `r/s2`, `r/s1` |

use willis::diagnostic::{Code, Diagnostic, Diagnostics};
use willis::exact::Rational;
use willis::train::{FRAME, MemberId, MemberKind, Train};

use super::form::{Quotient, Row, Structure, null_vector, structure};

/// A type of set whose teeth can be found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SetKind {
    /// Sun, planets, ring.
    Simple,
    /// A sun and a ring on the first step of the planets, another ring on the second: a 3K or Wolfrom drive.
    Wolfrom,
    /// A sun on the first step of the planets, a ring on the second.
    Stepped,
    /// A ring on each of two steps of the planets, and no sun.
    Rings,
    /// Small sun, large sun and ring with short and long planets.
    Ravigneaux,
}

impl SetKind {
    /// How many variables it has.
    pub fn variables(self) -> usize {
        match self {
            Self::Simple | Self::Stepped | Self::Rings => 1,
            Self::Wolfrom | Self::Ravigneaux => 2,
        }
    }
}

/// `ω_p − ω_c = ±x (ω_q − ω_c)`, as friction sees it: one force.
#[derive(Clone, Debug)]
pub(crate) struct Element {
    pub p: usize,
    pub q: usize,
    pub carrier: usize,
    /// 1 where both turn in the same sense relative to the carrier, otherwise −1.
    pub sense: f64,
    pub factor: Factor,
    /// Efficiency of each of its meshes when p drives and when q does.
    pub meshes: Vec<[f64; 2]>,
}

/// Where the factor of an element comes from.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Factor {
    /// A quotient of teeth of a set: number of the set, and of its gears.
    Teeth { set: usize, above: Gear, below: Gear },
    /// Given.
    Fixed(f64),
}

/// A position in the tooth numbers of a set; see [`SetKind::gears`].
pub(crate) type Gear = usize;

impl SetKind {
    /// What its gears are called, in the order of the tooth numbers of a design.
    pub fn gears(self) -> &'static [&'static str] {
        match self {
            Self::Simple => &["sun", "planet", "ring"],
            Self::Wolfrom => &["sun", "planet_1", "ring_1", "planet_2", "ring_2"],
            Self::Stepped => &["sun", "planet_1", "planet_2", "ring"],
            Self::Rings => &["ring_1", "planet_1", "planet_2", "ring_2"],
            Self::Ravigneaux => &["small_sun", "large_sun", "long_planet", "ring"],
        }
    }
}

/// A state of a layout.
#[derive(Clone, Debug)]
pub(crate) struct LayoutState {
    pub name: String,
    pub input: usize,
    pub output: usize,
    /// `ω_input/ω_output`.
    pub ratio: Quotient,
    /// Node of each member, none for those that rest; planets of the designed sets have nodes too.
    pub node_of: Vec<Option<usize>>,
    pub nodes: usize,
    /// Nodes whose speed nothing settles.
    pub pins: Vec<usize>,
    /// Shift elements that are closed, with the members on one side of each and the sign of the torque there; none where
    /// that cannot be told apart.
    pub closed: Vec<(String, Option<Vec<usize>>)>,
    /// Whether equations repeat each other: friction then has no single answer.
    pub redundant: bool,
}

/// A layout, compiled.
#[derive(Clone, Debug)]
pub(crate) struct Layout {
    pub kinds: Vec<Option<SetKind>>,
    pub sets: Vec<String>,
    /// First variable of each set.
    pub first: Vec<usize>,
    pub variables: usize,
    pub elements: Vec<Element>,
    /// Planets of designed sets: member, set, its gear, the sun that drives it and that gear, carrier.
    pub planets: Vec<PlanetOf>,
    pub states: Vec<LayoutState>,
    /// States for which no ratio can be asked, and why.
    pub unfit: Vec<(String, Diagnostic)>,
}

/// A planet of a set that is designed.
#[derive(Clone, Debug)]
pub(crate) struct PlanetOf {
    pub set: usize,
    pub central: usize,
    pub carrier: usize,
    pub central_gear: Gear,
    pub gear: Gear,
}

struct Tie {
    p: usize,
    q: usize,
    carrier: usize,
    same: bool,
    /// Number of the variable, or the fixed quotient.
    factor: Result<usize, (i64, i64)>,
}

impl Layout {
    /// Compiles a train; `kinds` says which of its sets are designed.
    ///
    /// # Errors
    /// No state has a ratio, and layouts that are too large.
    pub fn new(train: &Train, kinds: &[Option<SetKind>]) -> Result<Self, Diagnostics> {
        let mut first = Vec::new();
        let mut variables = 0;
        for kind in kinds {
            first.push(variables);
            variables += kind.map_or(0, SetKind::variables);
        }
        if variables > 10 {
            let message = format!("{variables} basic ratios are to be found at once; 10 are the most");
            return Err(one(Diagnostic::new(Code::TooLarge, "set", message).hint("give the teeth of some sets")));
        }
        let (mut ties, mut elements, mut planets, mut inner) = (vec![], vec![], vec![], vec![]);
        for (set, kind) in kinds.iter().enumerate() {
            let own: Vec<_> = train.meshes().iter().filter(|m| m.set == Some(set)).collect();
            let Some(kind) = kind else { continue };
            let c = own[0].carrier.index();
            let end = |mesh: usize, gear: usize| own[mesh].gears[gear].member.index();
            let eta = |mesh: usize| {
                let e = &own[mesh].efficiency;
                [e.forward.to_f64(), e.backward.to_f64()]
            };
            let mut tie = |p, q, same, v| ties.push(Tie { p, q, carrier: c, same, factor: Ok(first[set] + v) });
            let mut element = |p, q, sense, (above, below), meshes: &[usize]| {
                let factor = Factor::Teeth { set, above, below };
                let meshes = meshes.iter().map(|m| eta(*m)).collect();
                elements.push(Element { p, q, carrier: c, sense, factor, meshes });
            };
            let mut planet = |central, central_gear, gear| {
                planets.push(PlanetOf { set, central, carrier: c, central_gear, gear });
            };
            match kind {
                SetKind::Simple => {
                    let (s, r) = (end(0, 0), end(1, 1));
                    inner.push(end(0, 1));
                    tie(s, r, false, 0);
                    element(s, r, -1.0, (2, 0), &[0, 1]);
                    planet(s, 0, 1);
                }
                SetKind::Wolfrom => {
                    let (s, p, r1, r2) = (end(0, 0), end(0, 1), end(1, 1), end(2, 1));
                    inner.push(p);
                    tie(s, r1, false, 0);
                    tie(s, r2, false, 1);
                    element(s, p, -1.0, (1, 0), &[0]);
                    element(p, r1, 1.0, (2, 1), &[1]);
                    element(p, r2, 1.0, (4, 3), &[2]);
                    planet(s, 0, 1);
                }
                SetKind::Stepped => {
                    let (s, p, r) = (end(0, 0), end(0, 1), end(1, 1));
                    inner.push(p);
                    tie(s, r, false, 0);
                    element(s, p, -1.0, (1, 0), &[0]);
                    element(p, r, 1.0, (3, 2), &[1]);
                    planet(s, 0, 1);
                }
                SetKind::Rings => {
                    let (p, r1, r2) = (end(0, 0), end(0, 1), end(1, 1));
                    inner.push(p);
                    tie(r1, r2, true, 0);
                    element(p, r1, 1.0, (0, 1), &[0]);
                    element(p, r2, 1.0, (3, 2), &[1]);
                    planet(r1, 0, 1);
                }
                SetKind::Ravigneaux => {
                    let (s1, long, s2, r) = (end(0, 0), end(1, 1), end(2, 0), end(3, 1));
                    inner.extend([end(0, 1), long]);
                    tie(s2, r, false, 0);
                    tie(s1, r, true, 1);
                    element(s1, long, 1.0, (2, 0), &[0, 1]);
                    element(s2, long, -1.0, (2, 1), &[2]);
                    element(long, r, 1.0, (3, 2), &[3]);
                    planet(s2, 1, 2);
                }
            }
        }
        for mesh in train.meshes().iter().filter(|m| m.set.is_none_or(|s| kinds.get(s).is_none_or(Option::is_none))) {
            let [a, b] = &mesh.gears;
            let quotient = &b.teeth / &a.teeth;
            let parts = fraction(&quotient).ok_or_else(too_large)?;
            let (p, q, carrier) = (a.member.index(), b.member.index(), mesh.carrier.index());
            ties.push(Tie { p, q, carrier, same: mesh.same_sense, factor: Err(parts) });
            elements.push(Element {
                p,
                q,
                carrier,
                sense: if mesh.same_sense { 1.0 } else { -1.0 },
                factor: Factor::Fixed(quotient.to_f64()),
                meshes: vec![[mesh.efficiency.forward.to_f64(), mesh.efficiency.backward.to_f64()]],
            });
        }
        let mut layout = Self {
            kinds: kinds.to_vec(),
            sets: train.sets().iter().map(|s| s.name.clone()).collect(),
            first,
            variables,
            elements,
            planets,
            states: vec![],
            unfit: vec![],
        };
        let count = train.states().len();
        for state in if count == 0 { vec![None] } else { (0..count).map(Some).collect() } {
            match layout.state(train, state, &ties, &inner) {
                Ok(compiled) => layout.states.push(compiled),
                Err(d) => {
                    let name = state.map_or("as drawn".to_owned(), |k| train.states()[k].name.clone());
                    layout.unfit.push((name, *d));
                }
            }
        }
        if layout.states.is_empty() { Err(layout.unfit.into_iter().map(|u| u.1).collect()) } else { Ok(layout) }
    }

    fn state(
        &self,
        train: &Train,
        state: Option<usize>,
        ties: &[Tie],
        inner: &[usize],
    ) -> Result<LayoutState, Box<Diagnostic>> {
        let (name, engaged) = match state {
            Some(k) => (train.states()[k].name.clone(), train.states()[k].engaged.clone()),
            None => ("as drawn".to_owned(), vec![]),
        };
        let unfit = |what: &str| {
            let message = format!("state `{name}` {what}, so that it has no ratio to be designed for");
            Box::new(
                Diagnostic::new(Code::Unfit, "", message)
                    .hint("look at it with `willis analyze`, and correct or remove it"),
            )
        };
        let [Some(input), Some(output)] = train.ends(state) else {
            return Err(unfit("has no input and output"));
        };
        // Members that turn as one.
        let members = train.members().len();
        let mut group: Vec<usize> = (0..members).collect();
        let joined: Vec<[usize; 2]> =
            engaged.iter().map(|e| train.shift_elements()[e.index()].members.map(MemberId::index)).collect();
        for [a, b] in &joined {
            let (a, b) = (group[*a], group[*b]);
            for g in &mut group {
                if *g == b {
                    *g = a;
                }
            }
        }
        let frame = group[FRAME.index()];
        // Nodes without the planets of designed sets first: they are those of the kinematics.
        let used = |m: usize| {
            ties.iter().any(|t| [t.p, t.q, t.carrier].contains(&m))
                || [input.index(), output.index()].contains(&m)
                || joined.iter().flatten().any(|j| *j == m)
        };
        let mut number: Vec<Option<usize>> = vec![None; members];
        let mut nodes = 0;
        let mut node_of: Vec<Option<usize>> = vec![None; members];
        for m in (0..members).filter(|&m| group[m] != frame && !inner.contains(&m)) {
            let mates = (0..members).filter(|&o| group[o] == group[m]);
            if mates.clone().any(used) {
                let n = *number[group[m]].get_or_insert_with(|| {
                    nodes += 1;
                    nodes - 1
                });
                node_of[m] = Some(n);
            }
        }
        let rows: Vec<Row> = ties
            .iter()
            .map(|t| {
                let (mut base, mut slope) = (vec![0; nodes], vec![0; nodes]);
                let (num, den, variable) = match t.factor {
                    Ok(v) => (1, 1, Some(v)),
                    Err((n, d)) => (n, d, None),
                };
                let sign = if t.same { 1 } else { -1 };
                let mut add = |m: usize, b: i64, s: i64| {
                    if let Some(n) = node_of[m] {
                        base[n] += b;
                        slope[n] += s;
                    }
                };
                // den (ω_p − ω_c) = sign num y (ω_q − ω_c)
                add(t.p, den, 0);
                add(t.carrier, -den, 0);
                let (fixed, moving) = if variable.is_some() { (0, sign) } else { (sign * num, 0) };
                add(t.q, -fixed, -moving);
                add(t.carrier, fixed, moving);
                Row { base, slope, variable }
            })
            .filter(|r| r.base.iter().chain(&r.slope).any(|x| *x != 0))
            .collect();
        let (Some(i), Some(o)) = (node_of[input.index()], node_of[output.index()]) else {
            return Err(unfit("holds its input or output"));
        };
        let mut order: Vec<usize> = (0..nodes).filter(|n| *n != i && *n != o).collect();
        if o != i {
            order.push(o);
        }
        order.push(i);
        let Structure { rows: independent, pivots, free } = structure(&rows, &order);
        let redundant = independent.len() < rows.len();
        let pins: Vec<usize> = free.iter().copied().filter(|n| *n != i).collect();
        if !free.contains(&i) || pins.contains(&o) {
            return Err(unfit("does not settle its ratio"));
        }
        let mut columns = pivots;
        columns.push(i);
        columns.sort_unstable();
        let chosen: Vec<&Row> = independent.iter().map(|r| &rows[*r]).collect();
        let speeds =
            null_vector(&chosen, &columns, self.variables).ok_or_else(|| unfit("has numbers beyond measure"))?;
        let form = |node: usize| columns.iter().position(|c| *c == node).map(|k| speeds[k].clone());
        let ratio =
            form(i).zip(form(o)).and_then(|(n, d)| Quotient::new(n, d)).ok_or_else(|| unfit("holds its output"))?;
        // What stands on one side of each closed element, if it alone is opened.
        let closed = engaged
            .iter()
            .enumerate()
            .map(|(k, e)| {
                let mut side: Vec<usize> = (0..members).collect();
                for (_, [a, b]) in joined.iter().enumerate().filter(|(j, _)| *j != k) {
                    let (a, b) = (side[*a], side[*b]);
                    side.iter_mut().filter(|s| **s == b).for_each(|s| *s = a);
                }
                let [a, b] = joined[k];
                let of = |m: usize| (0..members).filter(|&o| side[o] == side[m]).collect::<Vec<_>>();
                let apart = side[a] != side[b];
                let free = [a, b].into_iter().find(|m| side[*m] != side[FRAME.index()]);
                (train.shift_elements()[e.index()].name.clone(), free.filter(|_| apart).map(of))
            })
            .collect();
        // Planets of designed sets are nodes of the statics.
        for m in inner.iter().copied().filter(|&m| self.elements.iter().any(|e| e.p == m || e.q == m)) {
            node_of[m] = Some(nodes);
            nodes += 1;
        }
        debug_assert!(train.members()[FRAME.index()].kind == MemberKind::Frame);
        Ok(LayoutState {
            name: name.clone(),
            input: input.index(),
            output: output.index(),
            ratio,
            node_of,
            nodes,
            pins,
            closed,
            redundant,
        })
    }
}

fn one(d: Diagnostic) -> Diagnostics {
    let mut all = Diagnostics::default();
    all.push(d);
    all
}

fn too_large() -> Diagnostics {
    one(Diagnostic::new(Code::TooLarge, "mesh", "tooth numbers are beyond measure"))
}

/// Numerator and denominator, where they are of an ordinary size.
pub(crate) fn fraction(value: &Rational) -> Option<(i64, i64)> {
    let text = value.to_fraction();
    let (n, d) = text.split_once('/')?;
    Some((n.parse().ok()?, d.parse().ok()?))
}
