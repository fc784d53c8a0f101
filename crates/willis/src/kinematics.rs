//! Exact speeds: what turns how fast, what is locked, what is free, what is redundant.
//!
//! Every gear pair ties its members by Willis' equation,
//! `z_p (ω_p − ω_c) ± z_q (ω_q − ω_c) = 0` (+ for opposite senses), and every engaged shift element
//! makes two members one *node*. The rows are solved by exact elimination, so a ratio is a
//! fraction and a zero is a zero. Source: Willis 1841; `R^v_{w,u}` relations in Esmail 2018.

mod coupled;

use crate::exact::{self, Matrix, Rational};
use crate::train::{
    Efficiency, FRAME, MemberId, MemberKind, MeshId, ShiftElementId, Store, Train, Variator, VariatorPath,
};
use crate::units::Quantity;

pub(crate) use coupled::{Coupled, Coupling};

/// A chain of meshes that behaves as one: it ends at two members, and the rotors between them
/// touch nothing else, so one power passes through all of it.
///
/// With the ends `p`, `q` and the common carrier `c` it obeys
/// `a (ω_p − ω_c) + b (ω_q − ω_c) = 0`; its efficiency is the product over its meshes.
#[derive(Clone, Debug)]
pub(crate) struct Element {
    pub links: Vec<Link>,
    pub p: MemberId,
    pub q: MemberId,
    pub carrier: MemberId,
    pub a: Rational,
    pub b: Rational,
    /// Efficiency when p drives, and when q drives.
    pub forward: Rational,
    pub backward: Rational,
}

/// A mesh in a chain; `along` when the chain runs from its first gear to its second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Link {
    pub mesh: MeshId,
    pub along: bool,
}

impl Element {
    fn from_mesh(train: &Train, id: MeshId) -> Self {
        let mesh = &train.meshes[id.0];
        let [first, second] = &mesh.gears;
        let sign = Rational::from(if mesh.same_sense { -1 } else { 1 });
        Self {
            links: vec![Link { mesh: id, along: true }],
            p: first.member,
            q: second.member,
            carrier: mesh.carrier,
            a: first.teeth.clone(),
            b: &second.teeth * &sign,
            forward: mesh.efficiency.forward.clone(),
            backward: mesh.efficiency.backward.clone(),
        }
    }

    /// Two members that turn as one.
    fn rigid(p: MemberId, q: MemberId) -> Self {
        let (a, b) = (Rational::ONE, -Rational::ONE);
        Self { links: vec![], p, q, carrier: FRAME, a, b, forward: Rational::ONE, backward: Rational::ONE }
    }

    /// Whether it only joins its ends.
    pub(crate) fn is_rigid(&self) -> bool {
        self.links.is_empty()
    }

    pub(crate) fn reversed(mut self) -> Self {
        std::mem::swap(&mut self.p, &mut self.q);
        std::mem::swap(&mut self.a, &mut self.b);
        std::mem::swap(&mut self.forward, &mut self.backward);
        self.links.reverse();
        self.links.iter_mut().for_each(|l| l.along = !l.along);
        self
    }

    /// `self` ends where `next` begins.
    fn joined(mut self, next: Self) -> Self {
        self.b = -(&self.b * &next.b / &next.a);
        self.q = next.q;
        self.forward = self.forward * next.forward;
        self.backward = self.backward * next.backward;
        self.links.extend(next.links);
        self
    }
}

/// A group of members that turn as one, or `None` for the group of the frame.
pub(crate) type Node = Option<usize>;

/// A train with certain shift elements engaged and certain members held.
#[derive(Clone, Debug)]
pub struct Configuration<'t> {
    pub(crate) train: &'t Train,
    pub(crate) engaged: Vec<ShiftElementId>,
    pub(crate) held: Vec<MemberId>,
    /// Chains of meshes, then the [variators](Configuration::coupled) at a motion.
    pub(crate) elements: Vec<Element>,
    /// What each element behind the meshes is.
    pub(crate) couplings: Vec<Coupling>,
    /// Node of each member; meaningless for the inner rotors of chains.
    pub(crate) node_of: Vec<Node>,
    pub(crate) nodes: usize,
    /// How many of the nodes, the last ones, are buses of variators.
    pub(crate) buses: usize,
    /// Rotors inside a chain, that is, planets that touch nothing else.
    pub(crate) inner: Vec<bool>,
    /// Efficiency in force in each mesh: the given ones, unless the operating point computes them.
    pub(crate) efficiencies: Vec<Efficiency>,
    rank: usize,
}

/// All that the speeds and the equations of a [configuration](Configuration) without variators follow from, whatever its
/// efficiencies.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Layout {
    node_of: Vec<Node>,
    inner: Vec<bool>,
    elements: Vec<(Vec<Link>, [MemberId; 3], [Rational; 2])>,
}

/// Speeds of every member as combinations of prescribed ones.
#[derive(Clone, Debug)]
pub struct Transfer {
    /// For each member the factors of the prescribed speeds; `None` when they do not determine it.
    pub speeds: Vec<Option<Vec<Rational>>>,
    /// Combinations of the prescribed speeds that the gears force to be zero.
    pub conflicts: Vec<Vec<Rational>>,
}

impl Transfer {
    /// Ratio of the only prescribed speed to that of a member.
    pub(crate) fn ratio(&self, output: MemberId) -> Ratio {
        if !self.conflicts.is_empty() {
            return Ratio::InputLocked;
        }
        match &self.speeds[output.0] {
            None => Ratio::Undetermined,
            Some(w) if w[0].is_zero() => Ratio::OutputAtRest,
            Some(w) => Ratio::Exact(w[0].recip()),
        }
    }

    /// The same train with another speed prescribed, the ratio of the two being this: they settle the same speeds.
    pub(crate) fn seen_from_other(&self, ratio: &Rational) -> Self {
        let seen = |w: &Vec<Rational>| w.iter().map(|x| x * ratio).collect();
        Self { speeds: self.speeds.iter().map(|s| s.as_ref().map(seen)).collect(), conflicts: vec![] }
    }
}

/// The ratio between two members.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Ratio {
    /// `ω_input/ω_output`.
    Exact(Rational),
    /// The output stands still while the input turns.
    OutputAtRest,
    /// The input cannot turn.
    InputLocked,
    /// The input's speed does not settle the output's.
    Undetermined,
}

/// Exact speeds of every member, in multiples of `π^pi_power` rad/s.
#[derive(Clone, Debug)]
pub struct Motion {
    /// By member; `None` where the prescribed speeds do not settle it.
    pub speeds: Vec<Option<Rational>>,
    /// Power of π that all speeds share.
    pub pi_power: i8,
    /// Whether they follow exactly from what is prescribed: rpm and rad/s side by side share no exact form.
    pub is_exact: bool,
    /// Where prescribed speeds that the gears tie together contradict them the most, within the
    /// [tolerance](Train::speed_tolerance) and beyond what makes no difference.
    pub deviation: Option<Deviation>,
}

/// Speeds that contradict the gears a little.
#[derive(Clone, Debug, PartialEq)]
pub struct Deviation {
    /// The members, in the order in which their speeds were given: the last one yields.
    pub members: Vec<MemberId>,
    /// By which part of the largest of their speeds, as the gears tie them.
    pub relative: f64,
}

impl Motion {
    /// Speed in rad/s.
    pub fn si(&self, member: MemberId) -> Option<f64> {
        self.speeds[member.0].as_ref().map(|w| w.to_f64() * std::f64::consts::PI.powi(self.pi_power.into()))
    }
}

impl<'t> Configuration<'t> {
    /// The train with `engaged` shift elements closed and `held` members at rest. Members in
    /// `keep` stay visible to loads and prescribed speeds even if they are mere planets.
    pub fn new(train: &'t Train, engaged: &[ShiftElementId], held: &[MemberId], keep: &[MemberId]) -> Self {
        let count = train.members.len();
        let mut group: Vec<usize> = (0..count).collect();
        fn root(group: &mut [usize], mut m: usize) -> usize {
            while group[m] != m {
                group[m] = group[group[m]];
                m = group[m];
            }
            m
        }
        let ties = engaged.iter().map(|e| train.shift_elements[e.0].members).chain(train.joints.iter().copied());
        for [a, b] in ties.chain(held.iter().map(|m| [*m, FRAME])) {
            let (a, b) = (root(&mut group, a.0), root(&mut group, b.0));
            group[a.max(b)] = a.min(b);
        }

        let mut loaded = vec![false; count];
        loaded[FRAME.0] = true;
        let touched = train.terminals.iter().chain(keep).chain(held).copied();
        let shifting = train.shift_elements.iter().flat_map(|e| e.members);
        let shifting = shifting.chain(train.joints.iter().copied().flatten());
        let shifting = shifting.chain(train.variators.iter().flat_map(Variator::members));
        let carriers = train.meshes.iter().map(|m| m.carrier);
        touched.chain(shifting).chain(carriers).for_each(|m| loaded[m.0] = true);
        let (elements, inner) = chains(train, &loaded);

        // Inner rotors are in no group; the rest are numbered, the frame's group being `None`.
        let mut number = vec![None; count];
        let mut node_of = vec![None; count];
        let mut nodes = 0;
        let ground = root(&mut group, FRAME.0);
        for m in (0..count).filter(|&m| !inner[m]) {
            let r = root(&mut group, m);
            if r != ground {
                let n = *number[r].get_or_insert_with(|| {
                    nodes += 1;
                    nodes - 1
                });
                node_of[m] = Some(n);
            }
        }
        let (engaged, held) = (engaged.to_vec(), held.to_vec());
        let efficiencies = train.meshes.iter().map(|m| m.efficiency.clone()).collect();
        let mut c = Self {
            train,
            engaged,
            held,
            elements,
            couplings: vec![],
            node_of,
            nodes,
            buses: 0,
            inner,
            efficiencies,
            rank: 0,
        };
        c.rank = exact::rank(c.rows(0), nodes);
        c
    }

    /// What another configuration must have too to turn like this one.
    pub(crate) fn layout(&self) -> Layout {
        let element = |e: &Element| (e.links.clone(), [e.p, e.q, e.carrier], [e.a.clone(), e.b.clone()]);
        Layout {
            node_of: self.node_of.clone(),
            inner: self.inner.clone(),
            elements: self.elements.iter().map(element).collect(),
        }
    }

    /// The same with terminals that turn as one, but not all of them, kept apart: what couples them for good or in this
    /// state becomes a lossless element of its own, so that each has a torque of its own.
    pub(crate) fn with_terminals_apart(self, terminals: &[MemberId], keep: &[MemberId]) -> Self {
        let mut nodes: Vec<usize> = terminals.iter().filter_map(|m| self.node(*m)).collect();
        let live = nodes.len();
        nodes.sort_unstable();
        nodes.dedup();
        if nodes.len() < 2 || nodes.len() == live {
            return self;
        }
        let train = self.train;
        let ground = |m: MemberId| self.node(m).is_none();
        // Couplings between members that turn; the rest stays as it is.
        let pairs = self.engaged.iter().map(|e| train.shift_elements[e.0].members).chain(train.joints.iter().copied());
        let mut group: Vec<usize> = (0..train.members.len()).collect();
        let mut rigid: Vec<[MemberId; 2]> = Vec::new();
        // What is tied by elements already needs no second one.
        let mut tied: Vec<usize> = group.clone();
        let find = |group: &[usize], mut m: usize| {
            while group[m] != m {
                m = group[m];
            }
            m
        };
        for [a, b] in pairs.filter(|p| !p.iter().any(|m| ground(*m))) {
            let (x, y) = (find(&tied, a.0), find(&tied, b.0));
            if x == y {
                continue;
            }
            tied[x.max(y)] = x.min(y);
            let (x, y) = (find(&group, a.0), find(&group, b.0));
            let loaded = |root: usize| terminals.iter().any(|t| find(&group, t.0) == root);
            if loaded(x) && loaded(y) {
                rigid.push([a, b]);
            } else {
                group[x.max(y)] = x.min(y);
            }
        }
        let touched: Vec<MemberId> = keep.iter().chain(terminals).chain(rigid.iter().flatten()).copied().collect();
        let mut c = Self::new(train, &self.engaged, &self.held, &touched);
        let roots: Vec<Option<usize>> =
            (0..train.members.len()).map(|m| c.node_of[m].map(|_| find(&group, m))).collect();
        let mut number: Vec<Option<usize>> = vec![None; train.members.len()];
        c.nodes = 0;
        for (m, root) in roots.into_iter().enumerate().filter(|(m, _)| !c.inner[*m]) {
            c.node_of[m] = root.map(|root| {
                *number[root].get_or_insert_with(|| {
                    c.nodes += 1;
                    c.nodes - 1
                })
            });
        }
        rigid.into_iter().for_each(|[a, b]| c.elements.push(Element::rigid(a, b)));
        c.rank = exact::rank(c.rows(0), c.nodes);
        c
    }

    /// A shaft of its own, coupled for good with a member: its number, behind those of the train's members.
    pub(crate) fn add_shaft(&mut self, on: MemberId) -> MemberId {
        let own = MemberId(self.node_of.len());
        self.node_of.push(Some(self.nodes));
        self.inner.push(false);
        self.nodes += 1;
        self.rank += 1;
        self.elements.push(Element::rigid(own, on));
        own
    }

    /// The same configuration with other efficiencies of the meshes.
    pub(crate) fn with_efficiencies(&self, efficiencies: Vec<Efficiency>) -> Self {
        let mut c = Self { efficiencies, ..self.clone() };
        for e in c.elements.iter_mut().filter(|e| !e.links.is_empty()) {
            (e.forward, e.backward) = (Rational::ONE, Rational::ONE);
            for link in &e.links {
                let own = &c.efficiencies[link.mesh.0];
                let (along, against) =
                    if link.along { (&own.forward, &own.backward) } else { (&own.backward, &own.forward) };
                e.forward = &e.forward * along;
                e.backward = &e.backward * against;
            }
        }
        c
    }

    /// Whether the efficiencies in force are those that are given, and not made of coefficients of friction.
    pub(crate) fn is_exact(&self) -> bool {
        !self.train.meshes.iter().any(|m| m.computed)
    }

    /// The elements that are chains of meshes.
    pub(crate) fn gears(&self) -> &[Element] {
        &self.elements[..self.elements.len() - self.couplings.len()]
    }

    pub(crate) fn node(&self, member: MemberId) -> Node {
        self.node_of[member.0]
    }

    /// The Willis equation of an element over the nodes, padded with `extra` zero columns.
    fn row(&self, e: &Element, extra: usize) -> Vec<Rational> {
        let mut row = vec![Rational::ZERO; self.nodes + extra];
        let carrier = -(&e.a + &e.b);
        for (member, coefficient) in [(e.p, &e.a), (e.q, &e.b), (e.carrier, &carrier)] {
            if let Some(n) = self.node(member) {
                row[n] += coefficient.clone();
            }
        }
        row
    }

    fn rows(&self, extra: usize) -> Matrix {
        self.gears().iter().map(|e| self.row(e, extra)).collect()
    }

    /// Number of speeds that can be chosen freely.
    ///
    /// # Example
    /// ```
    /// # use willis::train::{SetSpec, Train};
    /// # use willis::kinematics::Configuration;
    /// let train = Train::builder("set")
    ///     .members(["s", "r", "c"])
    ///     .set(SetSpec::simple("P1", ("s", 30), ("r", 70), "c"))
    ///     .build()?;
    /// assert_eq!(Configuration::new(&train, &[], &[], &[]).degrees_of_freedom(), 2);
    /// # Ok::<(), willis::diagnostic::Diagnostics>(())
    /// ```
    pub fn degrees_of_freedom(&self) -> usize {
        self.nodes - self.buses - self.rank
    }

    /// Meshes that constrain what other meshes already constrain, one list for each independent
    /// self-stress (left null vector of the Willis equations).
    pub fn redundant(&self) -> Vec<Vec<MeshId>> {
        let n = self.gears().len();
        if self.rank == n {
            return vec![];
        }
        let mut rows = self.rows(n);
        for (k, row) in rows.iter_mut().enumerate() {
            row[self.nodes + k] = Rational::ONE;
        }
        let rank = exact::reduce(&mut rows, self.nodes).len();
        rows[rank..]
            .iter()
            .map(|row| {
                (0..n)
                    .filter(|&k| !row[self.nodes + k].is_zero())
                    .flat_map(|k| self.elements[k].links.iter().map(|l| l.mesh))
                    .collect()
            })
            .collect()
    }

    /// Members whose speeds are independent and settle those of all that `order` names: the first ones in that order.
    /// They settle the whole train where `order` names a member of every part of it.
    ///
    /// The equations are eliminated from the last member on; what is left free are the first.
    ///
    /// # Example
    /// ```
    /// # use willis::train::{SetSpec, Train};
    /// # use willis::kinematics::Configuration;
    /// let train = Train::builder("set")
    ///     .members(["s", "r", "c"])
    ///     .set(SetSpec::simple("P1", ("s", 30), ("r", 70), "c"))
    ///     .build()?;
    /// let [s, r, c] = ["s", "r", "c"].map(|m| train.member(m).unwrap());
    /// let free = Configuration::new(&train, &[], &[], &[]);
    /// assert_eq!(free.settling(&[c, s, r]), [c, s]);
    /// // What is held settles nothing.
    /// let held = Configuration::new(&train, &[], &[c], &[]);
    /// assert_eq!(held.settling(&[c, s, r]), [s]);
    /// # Ok::<(), willis::diagnostic::Diagnostics>(())
    /// ```
    pub fn settling(&self, order: &[MemberId]) -> Vec<MemberId> {
        let mut named: Vec<(usize, MemberId)> = vec![];
        for &m in order.iter().filter(|m| !self.inner[m.0]) {
            if let Some(n) = self.node(m).filter(|n| named.iter().all(|own| own.0 != *n)) {
                named.push((n, m));
            }
        }
        let mut columns: Vec<usize> = (0..self.nodes).filter(|n| named.iter().all(|own| own.0 != *n)).collect();
        columns.extend(named.iter().rev().map(|own| own.0));
        let ordered = |row: Vec<Rational>| columns.iter().map(|&n| row[n].clone()).collect();
        let mut rows: Matrix = self.rows(0).into_iter().map(ordered).collect();
        let tied: Vec<usize> = exact::reduce(&mut rows, self.nodes).into_iter().map(|k| columns[k]).collect();
        named.into_iter().filter(|(n, _)| !tied.contains(n)).map(|(_, m)| m).collect()
    }

    /// Terminals of which an operating point has to give a torque or power, while the others balance the train: the first
    /// ones in this order.
    ///
    /// Torques that balance belong to independent speeds, one for each freedom. A variator settles as many of them as it has
    /// turning sides beyond the first, and a free store is one of them. With all members of a variator at rest it couples
    /// nothing, and there is one torque more to give.
    ///
    /// # Example
    /// ```
    /// # use willis::train::{SetSpec, Train};
    /// # use willis::kinematics::Configuration;
    /// let train = Train::builder("set")
    ///     .members(["s", "r", "c"])
    ///     .terminals(["s", "r", "c"])
    ///     .set(SetSpec::simple("P1", ("s", 30), ("r", 70), "c"))
    ///     .build()?;
    /// let free = Configuration::new(&train, &[], &[], &[]);
    /// assert_eq!(free.loading(train.terminals()), [train.member("s").unwrap()]);
    /// # Ok::<(), willis::diagnostic::Diagnostics>(())
    /// ```
    pub fn loading(&self, order: &[MemberId]) -> Vec<MemberId> {
        let backward: Vec<MemberId> = order.iter().rev().copied().collect();
        let mut balancing = self.settling(&backward);
        let settled: usize = (self.train.variators.iter())
            .map(|v| {
                let sides = v.members().into_iter().filter(|m| self.node(*m).is_some()).count().saturating_sub(1);
                let free = matches!(v.path, VariatorPath::Bus { store: Store::Free, .. });
                sides + usize::from(free)
            })
            .sum();
        // Where terminals are fewer than freedoms all of them may have to balance.
        balancing.truncate(self.degrees_of_freedom().saturating_sub(settled));
        let turns = |m: &MemberId| !self.inner[m.0] && self.node(*m).is_some();
        order.iter().copied().filter(|m| turns(m) && !balancing.contains(m)).collect()
    }

    /// Speeds as combinations of the speeds of `prescribed`.
    pub fn transfer(&self, prescribed: &[MemberId]) -> Transfer {
        let extra = prescribed.len();
        let mut rows = self.rows(extra);
        let mut conflicts = Vec::new();
        for (k, &member) in prescribed.iter().enumerate() {
            let mut row = vec![Rational::ZERO; self.nodes + extra];
            if let Some(n) = self.node(member) {
                row[n] = Rational::ONE;
            }
            row[self.nodes + k] = Rational::ONE;
            rows.push(row);
        }
        let pivots = exact::reduce(&mut rows, self.nodes);
        let mut of_node: Vec<Option<Vec<Rational>>> = vec![None; self.nodes];
        for (row, &column) in rows.iter().zip(&pivots) {
            let free = (0..self.nodes).any(|n| n != column && !row[n].is_zero());
            if !free {
                of_node[column] = Some(row[self.nodes..].to_vec());
            }
        }
        for row in &rows[pivots.len()..] {
            if row[self.nodes..].iter().any(|x| !x.is_zero()) {
                conflicts.push(row[self.nodes..].to_vec());
            }
        }
        // Redundant meshes repeat a conflict; what is left are the independent ones.
        let rank = exact::reduce(&mut conflicts, extra).len();
        conflicts.truncate(rank);
        let mut speeds: Vec<_> = (0..self.node_of.len())
            .map(|m| match (self.inner[m], self.node_of[m]) {
                (true, _) => None,
                (false, None) => Some(vec![Rational::ZERO; extra]),
                (false, Some(n)) => of_node[n].clone(),
            })
            .collect();
        for e in self.gears() {
            self.inner_speeds(e, &mut speeds);
        }
        Transfer { speeds, conflicts }
    }

    /// Walks a chain from p and sets the speeds of the rotors in it:
    /// `ω_next − ω_c = −(z/z_next)(ω − ω_c)` for opposite senses.
    fn inner_speeds(&self, e: &Element, speeds: &mut [Option<Vec<Rational>>]) {
        let (Some(mut at), Some(carrier)) = (speeds[e.p.0].clone(), speeds[e.carrier.0].clone()) else { return };
        for link in e.links.iter().take(e.links.len().saturating_sub(1)) {
            let mesh = &self.train.meshes[link.mesh.0];
            let [first, second] = &mesh.gears;
            let (from, to) = if link.along { (first, second) } else { (second, first) };
            let ratio = &from.teeth / &to.teeth * Rational::from(if mesh.same_sense { 1 } else { -1 });
            for (x, c) in at.iter_mut().zip(&carrier) {
                *x = c + &(&ratio * &(&*x - c));
            }
            speeds[to.member.0] = Some(at.clone());
        }
    }

    /// Ratio `ω_input/ω_output` with nothing else prescribed.
    pub fn ratio(&self, input: MemberId, output: MemberId) -> Ratio {
        self.transfer(&[input]).ratio(output)
    }

    /// Exact speeds for prescribed ones. What contradicts the gears by less than [`Train::SAME_SPEED`], or within the
    /// [tolerance](Train::speed_tolerance) of the train, follows the speeds given before it. `Err` gives the
    /// contradictions: members that the gears tie together in a way that the prescribed values do not respect.
    pub fn motion(&self, prescribed: &[(MemberId, Quantity)]) -> Result<Motion, Vec<Deviation>> {
        let members: Vec<_> = prescribed.iter().map(|(m, _)| *m).collect();
        self.motion_by(&self.transfer(&members), prescribed)
    }

    /// The same where the [transfer](Self::transfer) of these members is known.
    pub(crate) fn motion_by(
        &self,
        transfer: &Transfer,
        prescribed: &[(MemberId, Quantity)],
    ) -> Result<Motion, Vec<Deviation>> {
        let members: Vec<_> = prescribed.iter().map(|(m, _)| *m).collect();
        let (values, pi_power) = common(prescribed.iter().map(|(_, q)| q));
        let dot = |factors: &[Rational]| {
            factors.iter().zip(&values).fold(Rational::ZERO, |sum, (f, v)| if f.is_zero() { sum } else { sum + f * v })
        };
        let tied = |c: &[Rational]| (0..members.len()).filter(|&k| !c[k].is_zero()).map(|k| members[k]).collect();
        let (mut broken, mut deviation, mut yields) = (vec![], None::<Deviation>, vec![]);
        for c in &transfer.conflicts {
            let excess = dot(c);
            if excess.is_zero() {
                continue;
            }
            let most = c.iter().zip(&values).map(|(f, v)| (f.to_f64() * v.to_f64()).abs()).fold(0.0, f64::max);
            let relative = excess.to_f64().abs() / most;
            // Beyond floating point nothing can be said to be small.
            if relative.is_nan() || relative > self.train.speed_tolerance {
                broken.push(Deviation { members: tied(c), relative });
            } else if relative > Train::SAME_SPEED && deviation.as_ref().is_none_or(|d| relative > d.relative) {
                deviation = Some(Deviation { members: tied(c), relative });
            }
            yields.extend((0..members.len()).rfind(|&k| !c[k].is_zero()));
        }
        if !broken.is_empty() {
            return Err(broken);
        }
        if !yields.is_empty() {
            // What was given last follows the others, whatever the elimination began with.
            let kept = prescribed.iter().enumerate().filter(|(k, _)| !yields.contains(k)).map(|(_, p)| p.clone());
            let others = self.motion(&kept.collect::<Vec<_>>())?;
            let deviation = [deviation, others.deviation].into_iter().flatten();
            let deviation = deviation.max_by(|a, b| a.relative.total_cmp(&b.relative));
            return Ok(Motion { deviation, ..others });
        }
        let speeds = transfer.speeds.iter().map(|s| s.as_ref().map(|f| dot(f))).collect();
        let is_exact = share_a_form(prescribed.iter().map(|(_, q)| q));
        Ok(Motion { speeds, pi_power, is_exact, deviation: None })
    }

    /// Rotors that cannot turn although no shift element or hold grips them directly.
    pub fn locked_members(&self) -> Vec<MemberId> {
        let transfer = self.transfer(&[]);
        (1..self.train.members.len())
            .filter(|&m| self.inner[m] || self.node_of[m].is_some())
            .filter(|&m| transfer.speeds[m].is_some())
            .map(MemberId)
            .collect()
    }

    /// Sign of the speed of end p relative to the carrier, times the sign of `a`: the sign with
    /// which a positive force variable makes p the driver.
    pub(crate) fn sigma(&self, e: &Element, motion: &Motion) -> Option<i8> {
        let p = motion.speeds[e.p.0].as_ref()?;
        let c = motion.speeds[e.carrier.0].as_ref()?;
        Some(p.cmp(c) as i8 * e.a.sign())
    }
}

/// Exact values of several quantities of one kind with one common power of π. Where units mix
/// (rpm with rad/s) no common exact form exists, and all go through floating point.
pub(crate) fn common<'q>(quantities: impl Iterator<Item = &'q Quantity> + Clone) -> (Vec<Rational>, i8) {
    if share_a_form(quantities.clone()) {
        let first = quantities.clone().find(|q| !q.value.is_zero()).map_or(0, |q| q.pi_power);
        return (quantities.map(|q| q.value.clone()).collect(), first);
    }
    (quantities.map(|q| Rational::from_f64(q.si()).unwrap_or(Rational::ZERO)).collect(), 0)
}

/// Whether quantities have a common exact form: the same power of π.
pub(crate) fn share_a_form<'q>(quantities: impl Iterator<Item = &'q Quantity>) -> bool {
    let mut powers = quantities.filter(|q| !q.value.is_zero()).map(|q| q.pi_power);
    powers.next().is_none_or(|first| powers.all(|p| p == first))
}

/// Joins meshes through rotors that carry nothing but those two meshes.
fn chains(train: &Train, loaded: &[bool]) -> (Vec<Element>, Vec<bool>) {
    let count = train.members.len();
    let mut elements: Vec<Option<Element>> =
        (0..train.meshes.len()).map(|k| Some(Element::from_mesh(train, MeshId(k)))).collect();
    let mut ends: Vec<Vec<usize>> = vec![vec![]; count];
    for (k, e) in elements.iter().enumerate() {
        let e = e.as_ref().expect("just made");
        ends[e.p.0].push(k);
        ends[e.q.0].push(k);
    }
    let mut inner = vec![false; count];
    for m in (0..count).filter(|&m| !loaded[m] && train.members[m].kind != MemberKind::Frame) {
        let [i, j] = ends[m][..] else { continue };
        let carrier = |k: usize| elements[k].as_ref().map(|e| e.carrier);
        if i == j || carrier(i) != carrier(j) {
            continue;
        }
        let (left, right) = (elements[i].take().expect("alive"), elements[j].take().expect("alive"));
        let left = if left.q.0 == m { left } else { left.reversed() };
        let right = if right.p.0 == m { right } else { right.reversed() };
        let whole = left.joined(right);
        for end in &mut ends[whole.q.0] {
            if *end == j {
                *end = i;
            }
        }
        // A loop back to the same rotor keeps both its ends in the list.
        elements[i] = Some(whole);
        inner[m] = true;
    }
    (elements.into_iter().flatten().collect(), inner)
}
