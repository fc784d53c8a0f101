//! A train as the regimes see it: terminals, the speeds that are free, the elements that carry
//! load, and the forms whose signs matter.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::rc::Rc;

use crate::exact::{self, Matrix, Rational, null_space};
use crate::kinematics::{Configuration, Element};
use crate::named::NameMap;
use crate::statics::{self, Equilibrium, Unsolvable};
use crate::train::{MachineEfficiency, MemberId, Store, VariatorPath};

use super::arrangement::{self, Cell};

/// A member on which an external torque may act.
#[derive(Clone, Debug)]
pub(crate) struct Terminal {
    /// Of a side of a variator perhaps a shaft that only the setup has.
    pub member: MemberId,
    pub node: usize,
    pub name: String,
}

/// Two terminals through which power runs beside the gears: what enters the gears at one has left them at the other, less
/// what is lost on the way. They are no inputs or outputs.
#[derive(Clone, Debug)]
pub(crate) struct Link {
    pub ends: [usize; 2],
    /// From the first to the second, and back.
    pub efficiency: [Rational; 2],
    /// The variator that it is; none of powers that balance each other.
    pub variator: Option<usize>,
}

/// Which terminals are linked beside the gears.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Linked {
    /// None.
    Nothing,
    /// These two, without loss.
    Balance([MemberId; 2]),
    /// The sides of the train's variator, if it has one.
    Variator,
}

impl Linked {
    /// Two terminals that were asked to balance, else the train's variator.
    pub fn of(balance: Option<[MemberId; 2]>) -> Self {
        balance.map_or(Self::Variator, Self::Balance)
    }
}

/// A configuration with its terminals, in the exact form in which regimes are enumerated.
///
/// An element is written with the coefficient of its end p scaled to one:
/// `(ω_p − ω_c) − i (ω_q − ω_c) = 0`, forces `f (e_p − iρ e_q − (1 − iρ) e_c)`.
#[derive(Clone, Debug)]
pub(crate) struct Setup<'t> {
    pub c: Configuration<'t>,
    pub terminals: Vec<Terminal>,
    /// Terminals whose speeds are independent and settle all others.
    pub base: Vec<usize>,
    /// Elements that can carry a force.
    pub active: Vec<usize>,
    /// Nodes without external torque that these elements touch.
    pub free: Vec<usize>,
    /// Independent terminal torques, were it not for the link.
    pub torques: usize,
    /// A way for power beside the gears.
    pub link: Option<Link>,
    /// Speed of each node over the base speeds; `None` where it is not determined.
    pub node_speed: Vec<Option<Vec<Rational>>>,
    /// By active element: `ω_p − ω_c` over the base speeds.
    pub sigma: Vec<Vec<Rational>>,
    /// Of patterns that were asked for.
    through: Through,
}

/// Terminal torques with power through the link, by pattern of drivers; a copy of a setup, whose losses may be made others,
/// knows none.
#[derive(Debug, Default)]
struct Through(RefCell<BTreeMap<Pattern, Rc<Vec<Vec<Rational>>>>>);

impl Clone for Through {
    fn clone(&self) -> Self {
        Self::default()
    }
}

/// The signs of the drivers, for one direction of motion: `true` when end p drives, `None` without
/// relative motion, without loss, or without load. With a link it has one entry more: `true` when power runs through it
/// from its first end to its second.
pub(crate) type Pattern = Vec<Option<bool>>;

/// An open cone of terminal torques in which the same members drive and every torque keeps its
/// sign.
#[derive(Clone, Debug)]
pub(crate) struct TorqueCell {
    pub pattern: Pattern,
    /// Sign of each terminal's torque.
    pub signs: Vec<i8>,
    /// A choice of terminal torques inside.
    pub torques: Vec<Rational>,
}

impl<'t> Setup<'t> {
    /// `Err` says in words why nothing can be enumerated.
    pub fn new(mut c: Configuration<'t>, members: &[MemberId], linked: Linked) -> Result<Self, String> {
        let train = c.train;
        let name = |m: MemberId| train.member_name(m).to_owned();
        if c.degrees_of_freedom() == 0 {
            return Err("nothing can turn".to_owned());
        }
        if !c.redundant().is_empty() {
            return Err("gear pairs constrain each other: statically indeterminate".to_owned());
        }
        let mut terminals: Vec<Terminal> = Vec::new();
        for &member in members {
            // Held members take a reaction without power; clutched ones are one terminal.
            if let Some(node) = c.node(member)
                && terminals.iter().all(|t| t.node != node)
            {
                terminals.push(Terminal { member, node, name: name(member) });
            }
        }
        let sides = match linked {
            Linked::Variator => sides(&c)?,
            _ => None,
        };
        let mut ports: Vec<usize> = Vec::new();
        for side in sides.iter().flat_map(|s| &s.ports) {
            // A torque that is no terminal's stays apart from those that are.
            let node = c.node(side.member).expect("a side turns");
            let taken = terminals.iter().any(|t| t.node == node);
            let member = if taken { c.add_shaft(side.member) } else { side.member };
            let unique = |wanted: &String| terminals.iter().all(|t| t.name != *wanted);
            let name = [&side.name, &side.apart].into_iter().find(|n| unique(n)).unwrap_or(&side.apart).clone();
            ports.push(terminals.len());
            terminals.push(Terminal { member, node: c.node(member).expect("it turns"), name });
        }
        let nodes: Vec<usize> = terminals.iter().map(|t| t.node).collect();
        let (row_alive, alive) = statics::carrying(&c, &nodes, &[]);
        let active: Vec<usize> = (0..c.elements.len()).filter(|&j| alive[j]).collect();
        // A terminal that no loaded gear touches never feels a torque.
        let touches = |n: usize| {
            active.iter().map(|&j| &c.elements[j]).any(|e| [e.p, e.q, e.carrier].iter().any(|m| c.node(*m) == Some(n)))
        };
        let kept: Vec<bool> = terminals.iter().map(|t| touches(t.node)).collect();
        let link = match (&sides, &ports[..]) {
            (Some(s), &[a, b]) if kept[a] && kept[b] => {
                let at = |port: usize| kept[..port].iter().filter(|k| **k).count();
                Some(Link { ends: [at(a), at(b)], efficiency: s.efficiency.clone(), variator: Some(s.variator) })
            }
            _ => None,
        };
        let mut keep = kept.iter();
        terminals.retain(|_| *keep.next().expect("one for each"));
        let free: Vec<usize> = (0..c.nodes).filter(|&n| row_alive[n]).collect();

        let mut base: Vec<usize> = Vec::new();
        for (k, t) in terminals.iter().enumerate() {
            let known: Vec<MemberId> = base.iter().map(|&b: &usize| terminals[b].member).collect();
            if c.transfer(&known).speeds[t.member.0].is_none() {
                base.push(k);
            }
        }
        if base.is_empty() && !terminals.is_empty() {
            return Err("nothing can turn that carries a load".to_owned());
        }
        let known: Vec<MemberId> = base.iter().map(|&b| terminals[b].member).collect();
        let transfer = c.transfer(&known);
        let mut node_speed = vec![None; c.nodes];
        for m in 0..c.node_of.len() {
            if let (Some(n), Some(w)) = (c.node(MemberId(m)), &transfer.speeds[m]) {
                node_speed[n] = Some(w.clone());
            }
        }
        let (sigma, through) = Default::default();
        let mut setup = Self { c, terminals, base, active, free, torques: 0, link, node_speed, sigma, through };
        for &j in &setup.active {
            let e = &setup.c.elements[j];
            let (Some(p), Some(carrier)) = (setup.speed(e.p), setup.speed(e.carrier)) else {
                let meshes: Vec<_> = e.links.iter().map(|l| setup.c.train.meshes[l.mesh.0].name.as_str()).collect();
                return Err(format!(
                    "the speeds of the terminals do not settle the relative speed in {}; name more terminals, or \
                     engage a shift element",
                    meshes.join(", ")
                ));
            };
            setup.sigma.push(p.iter().zip(&carrier).map(|(p, c)| p - c).collect());
        }
        let mut rows = setup.rows(&vec![None; setup.active.len()]);
        let rank = exact::reduce(&mut rows, setup.active.len()).len();
        setup.torques = setup.active.len() - rank;
        if setup.torques == 0 {
            let named: Vec<_> = members.iter().filter(|m| setup.c.node(**m).is_some()).map(|m| name(*m)).collect();
            let own = match named.len() {
                0 => "no terminal can turn".to_owned(),
                1 => format!("{} is the only terminal that can turn", named[0]),
                n => format!("{n} terminals can turn ({})", named.join(", ")),
            };
            let freedoms = match setup.c.degrees_of_freedom() {
                1 => "one degree of freedom".to_owned(),
                n => format!("{n} degrees of freedom"),
            };
            return Err(format!(
                "{own} and the train has {freedoms}: no terminal torques other than zero are in equilibrium through \
                 the gears"
            ));
        }
        if let Linked::Balance(pair) = linked {
            let at = pair.map(|m| setup.terminals.iter().position(|t| setup.c.node(m) == Some(t.node)));
            let [Some(a), Some(b)] = at else {
                return Err(format!(
                    "{} and {} cannot balance each other's power: one of them is held or carries no torque",
                    name(pair[0]),
                    name(pair[1])
                ));
            };
            if a == b || setup.torques < 2 {
                return Err(format!(
                    "balancing {} and {} leaves no torque free: only {} of the terminal torques is independent",
                    name(pair[0]),
                    name(pair[1]),
                    if setup.torques == 1 { "one" } else { "none" }
                ));
            }
            setup.link = Some(Link { ends: [a, b], efficiency: [Rational::ONE, Rational::ONE], variator: None });
        }
        if let Some(Link { variator: Some(v), .. }) = setup.link
            && setup.torques < 2
        {
            return Err(format!(
                "{} leaves no torque free: no terminal torques other than zero are in equilibrium with it",
                train.variators[v].name
            ));
        }
        if setup.link.is_some() && setup.torques > 2 {
            return Err(format!(
                "beside {} there are {} independent torques, and regimes are enumerated with one; name fewer terminals",
                setup.link_name(),
                setup.torques - 1
            ));
        }
        Ok(setup)
    }

    /// Which of the members asked for are no terminals, and why.
    pub fn idle(&self, members: &[MemberId]) -> Option<String> {
        let idle: Vec<&str> = members
            .iter()
            .filter(|m| self.c.node(**m).is_some_and(|n| self.terminals.iter().all(|t| t.node != n)))
            .map(|m| self.c.train.member_name(*m))
            .collect();
        (!idle.is_empty()).then(|| format!("no loaded gear touches {}: it never carries a torque", idle.join(", ")))
    }

    /// Speed of a member over the base speeds.
    pub fn speed(&self, member: MemberId) -> Option<Vec<Rational>> {
        match self.c.node(member) {
            Some(n) => self.node_speed[n].clone(),
            None if self.c.inner[member.0] => None,
            None => Some(vec![Rational::ZERO; self.base.len()]),
        }
    }

    pub fn terminal_name(&self, t: usize) -> &str {
        &self.terminals[t].name
    }

    /// The name of an end of an element.
    pub fn member_name(&self, member: MemberId) -> &str {
        match self.c.train.members.get(member.0) {
            Some(own) => &own.name,
            None => self.terminals.iter().find(|t| t.member == member).map_or("", |t| &t.name),
        }
    }

    /// Whether a terminal is an end of the link.
    pub fn is_end(&self, t: usize) -> bool {
        self.link.as_ref().is_some_and(|link| link.ends.contains(&t))
    }

    /// What the link is called.
    pub fn link_name(&self) -> String {
        let Some(Link { ends, variator, .. }) = &self.link else { return String::new() };
        match variator {
            Some(v) => self.c.train.variators[*v].name.clone(),
            None => ends.map(|t| self.terminal_name(t)).join(" and "),
        }
    }

    /// How a pattern is as long as there are drivers, of the link too.
    fn no_drivers(&self) -> Pattern {
        vec![None; self.active.len() + usize::from(self.link.is_some())]
    }

    /// A value for each terminal, by its name.
    pub fn by_terminal<T>(&self, mut value: impl FnMut(usize) -> T) -> NameMap<T> {
        (0..self.terminals.len()).map(|t| (self.terminal_name(t).to_owned(), value(t))).collect()
    }

    /// Speed of a terminal over the base speeds.
    pub fn terminal_speed(&self, t: usize) -> &[Rational] {
        self.node_speed[self.terminals[t].node].as_ref().expect("terminals settle each other")
    }

    pub fn element(&self, j: usize) -> &Element {
        &self.c.elements[self.active[j]]
    }

    /// The basic ratio `i = (ω_p − ω_c)/(ω_q − ω_c)` of an active element.
    pub fn ratio(&self, j: usize) -> Rational {
        let e = self.element(j);
        -(&e.b / &e.a)
    }

    /// Whether it matters which end of an active element drives.
    pub fn lossy(&self, j: usize) -> bool {
        let e = self.element(j);
        e.forward != Rational::ONE || e.backward != Rational::ONE
    }

    pub fn rho(&self, j: usize, p_drives: Option<bool>) -> Rational {
        let e = self.element(j);
        match p_drives {
            None => Rational::ONE,
            Some(true) => e.forward.clone(),
            Some(false) => e.backward.recip(),
        }
    }

    /// Coefficient of the force of active element `j` in the balance of a node.
    pub fn coefficient(&self, j: usize, node: usize, ratio: &Rational) -> Rational {
        let e = self.element(j);
        let mut sum = Rational::ZERO;
        for (member, x) in [(e.p, Rational::ONE), (e.q, -ratio.clone()), (e.carrier, ratio - &Rational::ONE)] {
            if self.c.node(member) == Some(node) {
                sum += x;
            }
        }
        sum
    }

    /// Balance of the free nodes: a row a node, a column an active element.
    fn rows(&self, pattern: &Pattern) -> Matrix {
        let ratios: Vec<Rational> = (0..self.active.len()).map(|j| self.ratio(j) * self.rho(j, pattern[j])).collect();
        self.free.iter().map(|&n| ratios.iter().enumerate().map(|(j, x)| self.coefficient(j, n, x)).collect()).collect()
    }

    /// Independent terminal torques.
    pub fn independent_torques(&self) -> usize {
        self.torques - usize::from(self.link.is_some())
    }

    /// The planes of the speed space, no two alike: see [`super::PlaneReport`].
    pub fn planes(&self) -> Vec<Vec<Rational>> {
        let mut all: Vec<Vec<Rational>> = Vec::new();
        let terminals = (0..self.terminals.len()).map(|t| self.terminal_speed(t).to_vec());
        let relative = (0..self.active.len()).filter(|&j| self.lossy(j)).map(|j| self.sigma[j].clone());
        for form in terminals.chain(relative) {
            if let Some((form, _)) = arrangement::normal(&form)
                && !all.contains(&form)
            {
                all.push(form);
            }
        }
        if self.link.is_some() && self.torques == 2 {
            for line in self.unloading(&all) {
                if !all.contains(&line) {
                    all.push(line);
                }
            }
        }
        all
    }

    /// With power through a link the ratio of the torques follows the speeds, and a force or torque
    /// can vanish within a region. All of them are linear in the speeds: the planes on which one
    /// does, as far as they bound an equilibrium.
    fn unloading(&self, planes: &[Vec<Rational>]) -> Vec<Vec<Rational>> {
        let k = self.active.len();
        let d = self.base.len();
        let mut all = Vec::new();
        for region in arrangement::cells(planes, d) {
            let sigma = self.sigma_signs(&region.point);
            let moving: Vec<usize> = (0..k).filter(|&j| sigma[j] != 0 && self.lossy(j)).collect();
            for mask in 0u64..2 << moving.len() {
                let mut pattern = self.no_drivers();
                moving.iter().enumerate().for_each(|(bit, &j)| pattern[j] = Some(mask >> bit & 1 == 0));
                pattern[k] = Some(mask >> moving.len() & 1 == 0);
                let basis = null_space(self.rows(&pattern), k);
                if basis.len() != self.torques {
                    continue;
                }
                let torque_forms = self.torque_forms(&pattern, &basis);
                // One coefficient of the basis for each base speed.
                let axes = self.axes(&pattern, &torque_forms);
                let over_speeds = |form: &[Rational]| -> Option<Vec<Rational>> {
                    let line: Vec<Rational> = axes.iter().map(|c| arrangement::dot(form, c)).collect();
                    arrangement::normal(&line).map(|(line, _)| line)
                };
                let force = |j: usize| -> Vec<Rational> { basis.iter().map(|b| b[j].clone()).collect() };
                let mut lines: Vec<Vec<Rational>> = planes.to_vec();
                for line in moving.iter().map(|&j| force(j)).chain(torque_forms.iter().cloned()) {
                    if let Some(line) = over_speeds(&line)
                        && !lines.contains(&line)
                    {
                        lines.push(line);
                    }
                }
                let wanted = region.signs.iter().copied().chain(std::iter::repeat(0)).take(lines.len());
                let parts: Vec<Cell> = arrangement::cells_where(&lines, &wanted.collect::<Vec<i8>>(), d);
                for part in &parts {
                    let c = self.balanced(&pattern, &torque_forms, &part.point);
                    // Either direction of the load may fit; a force that vanishes fits both.
                    let fits = |way: i8| {
                        moving.iter().all(|&j| {
                            let drives = arrangement::dot(&force(j), &c).sign() * sigma[j] * way;
                            drives == 0 || (drives > 0) == (pattern[j] == Some(true))
                        }) && self.runs(&part.point, &torque_forms, &c) * way * runs(pattern[k]) >= 0
                    };
                    if !fits(1) && !fits(-1) {
                        continue;
                    }
                    for n in planes.len()..lines.len() {
                        let mut across = part.signs.clone();
                        across[n] = -across[n];
                        if parts.iter().any(|p| p.signs == across) && !all.contains(&lines[n]) {
                            all.push(lines[n].clone());
                        }
                    }
                }
            }
        }
        all
    }

    /// Terminal torques with power through the link over the base speeds, in which they are linear, of some size.
    fn through(&self, pattern: &Pattern) -> Rc<Vec<Vec<Rational>>> {
        let known = self.through.0.borrow().get(pattern).cloned();
        known.unwrap_or_else(|| {
            let basis = null_space(self.rows(pattern), self.active.len());
            let forms = self.torque_forms(pattern, &basis);
            let axes = self.axes(pattern, &forms);
            let over = |f: &Vec<Rational>| axes.iter().map(|c| arrangement::dot(f, c)).collect();
            let through: Rc<Vec<Vec<Rational>>> = Rc::new(forms.iter().map(over).collect());
            self.through.0.borrow_mut().insert(pattern.clone(), through.clone());
            through
        })
    }

    /// The [balanced](Self::balanced) combination at each base speed alone.
    fn axes(&self, pattern: &Pattern, torque_forms: &[Vec<Rational>]) -> Vec<Vec<Rational>> {
        let d = self.base.len();
        let axis = |b: usize| -> Vec<Rational> { (0..d).map(|x| Rational::from(i64::from(x == b))).collect() };
        (0..d).map(|b| self.balanced(pattern, torque_forms, &axis(b))).collect()
    }

    /// Terminal torques over a basis of force vectors.
    fn torque_forms(&self, pattern: &Pattern, basis: &[Vec<Rational>]) -> Vec<Vec<Rational>> {
        (0..self.terminals.len())
            .map(|t| {
                let row = self.torque_row(pattern, t);
                basis.iter().map(|b| arrangement::dot(&row, b)).collect()
            })
            .collect()
    }

    /// The combination of two basis vectors for which what the link takes and gives agree; linear in the speeds.
    ///
    /// With ρ = η where power runs from a to b and 1/η where it runs back, `ρ T_a ω_a + T_b ω_b = 0`.
    fn balanced(&self, pattern: &Pattern, torque_forms: &[Vec<Rational>], base: &[Rational]) -> Vec<Rational> {
        let Link { ends: [a, b], efficiency: [forward, backward], .. } = self.link.as_ref().expect("there is a link");
        let [wa, wb] = [*a, *b].map(|t| arrangement::dot(self.terminal_speed(t), base));
        let wa = match pattern[self.active.len()] {
            None => wa,
            Some(true) => wa * forward.clone(),
            Some(false) => wa / backward.clone(),
        };
        let factor = |r: usize| &(&torque_forms[*a][r] * &wa) + &(&torque_forms[*b][r] * &wb);
        vec![-factor(1), factor(0)]
    }

    /// Which way power runs through the link: 1 from its first end to its second.
    fn runs(&self, base: &[Rational], torque_forms: &[Vec<Rational>], c: &[Rational]) -> i8 {
        let [a, b] = self.link.as_ref().expect("there is a link").ends;
        let power = |t: usize| {
            arrangement::dot(&torque_forms[t], c).sign() * arrangement::dot(self.terminal_speed(t), base).sign()
        };
        // What enters the gears at one end has left them at the other.
        if power(a) == 0 { power(b) } else { -power(a) }
    }

    /// Terminal torques with power through the link, of some size; linear in the speeds.
    pub fn torques_through(&self, pattern: &Pattern, base: &[Rational]) -> Vec<Rational> {
        self.through(pattern).iter().map(|row| arrangement::dot(row, base)).collect()
    }

    /// Terminal torques of a regime at other speeds: the same, unless there is a link.
    pub fn torques_at(
        &self,
        pattern: &Pattern,
        from: &[Rational],
        torques: &[Rational],
        to: &[Rational],
    ) -> Vec<Rational> {
        if self.link.is_none() {
            return torques.to_vec();
        }
        let here = self.torques_through(pattern, from);
        let same = here.iter().zip(torques).all(|(a, b)| a.sign() == b.sign());
        self.torques_through(pattern, to).into_iter().map(|x| if same { x } else { -x }).collect()
    }

    /// Sectors of the speed space, in order around the circle for two freedoms.
    pub fn speed_cells(&self, planes: &[Vec<Rational>]) -> Vec<Cell> {
        let mut cells = arrangement::cells(planes, self.base.len());
        match self.base.len() {
            1 => cells.sort_by(|a, b| b.point.cmp(&a.point)),
            2 => cells.sort_by(|a, b| arrangement::by_angle(&a.point, &b.point)),
            _ => cells.sort_by(|a, b| b.signs.cmp(&a.signs)),
        }
        cells
    }

    /// Sign of `ω_p − ω_c` of each active element at given base speeds.
    pub fn sigma_signs(&self, base: &[Rational]) -> Vec<i8> {
        self.sigma.iter().map(|s| arrangement::dot(s, base).sign()).collect()
    }

    /// The equilibrium problem at given base speeds, with these terminals loaded and the others open.
    pub fn equilibrium(&self, base: &[Rational], loaded: &[usize]) -> Result<Equilibrium, Unsolvable> {
        let signs = self.sigma_signs(base);
        let mut sigma: Vec<Option<i8>> = vec![Some(0); self.c.elements.len()];
        for (j, &element) in self.active.iter().enumerate() {
            sigma[element] = Some(signs[j] * self.c.elements[element].a.sign());
        }
        let node = |t: usize| self.terminals[t].node;
        let loaded: Vec<usize> = loaded.iter().map(|&t| node(t)).collect();
        let open: Vec<usize> = self.terminals.iter().map(|t| t.node).filter(|n| !loaded.contains(n)).collect();
        Equilibrium::new(&self.c, &sigma, &open, &loaded)
    }

    /// Forces of a pattern under given terminal torques, by active element.
    pub fn forces_for(&self, pattern: &Pattern, loads: &[(usize, Rational)]) -> Option<Vec<Rational>> {
        let mut rows = self.rows(pattern);
        let mut right = vec![Rational::ZERO; rows.len()];
        for (t, x) in loads {
            rows.push(self.torque_row(pattern, *t));
            right.push(x.clone());
        }
        exact::solve(&rows, &right)
    }

    /// All terminal torques of a pattern under given ones.
    pub fn torques_for(&self, pattern: &Pattern, loads: &[(usize, Rational)]) -> Option<Vec<Rational>> {
        let forces = self.forces_for(pattern, loads)?;
        Some((0..self.terminals.len()).map(|t| arrangement::dot(&self.torque_row(pattern, t), &forces)).collect())
    }

    /// Coefficients of the forces in a terminal's torque.
    fn torque_row(&self, pattern: &Pattern, t: usize) -> Vec<Rational> {
        (0..self.active.len())
            .map(|j| self.coefficient(j, self.terminals[t].node, &(self.ratio(j) * self.rho(j, pattern[j]))))
            .collect()
    }

    /// The drivers of a solution of [`Self::equilibrium`].
    pub fn pattern_of(&self, base: &[Rational], solution: &statics::Solution) -> Pattern {
        let signs = self.sigma_signs(base);
        (0..self.active.len())
            .map(|j| solution.driver[self.active[j]].filter(|_| signs[j] != 0 && self.lossy(j)))
            .collect()
    }

    /// With one independent torque: if some terminal's torque certainly settles everything, there are
    /// two cells, one for each of its signs, and no pattern needs to be tried.
    fn certified_cells(&self, base: &[Rational]) -> Option<Vec<TorqueCell>> {
        if self.torques != 1 {
            return None;
        }
        (0..self.terminals.len()).find_map(|t| {
            let problem = self.equilibrium(base, &[t]).ok()?;
            if !problem.certificate().unique_for_every_load() {
                return None;
            }
            [1, -1]
                .into_iter()
                .map(|sign| {
                    let mut loads = vec![Rational::ZERO; self.c.nodes];
                    loads[self.terminals[t].node] = Rational::from(sign);
                    let answer = problem.solve(&loads);
                    let pattern = self.pattern_of(base, answer.solutions.first()?);
                    let torques = self.torques_for(&pattern, &[(t, Rational::from(sign))])?;
                    Some(TorqueCell { pattern, signs: torques.iter().map(Rational::sign).collect(), torques })
                })
                .collect()
        })
    }

    /// With one independent torque and many elements the statics finds the equilibria under a torque of each sign on each
    /// terminal, block by block: those with a torque at all. The second value tells of singular patterns. None where the
    /// statics does not decide either.
    fn cells_under_load(&self, base: &[Rational]) -> Option<(Vec<TorqueCell>, bool)> {
        if self.torques != 1 || self.link.is_some() {
            return None;
        }
        let (mut all, mut singular) = (Vec::<TorqueCell>::new(), false);
        for t in 0..self.terminals.len() {
            // Where they do not settle the others, torques on this terminal are none, whatever drives.
            let Ok(problem) = self.equilibrium(base, &[t]) else { continue };
            if problem.most_tried() > MOST_TRIED as usize {
                return None;
            }
            for sign in [1, -1] {
                let mut loads = vec![Rational::ZERO; self.c.nodes];
                loads[self.terminals[t].node] = Rational::from(sign);
                let answer = problem.solve(&loads);
                if answer.certificate == statics::Certificate::Undecided {
                    return None;
                }
                singular |= !answer.stretches.is_empty();
                for solution in &answer.solutions {
                    let pattern = self.pattern_of(base, solution);
                    let torque = |u: usize| match u == t {
                        true => Some(Rational::from(sign)),
                        false => problem.exact_torque(&self.c, solution, &loads, self.terminals[u].node),
                    };
                    let torques: Vec<Rational> = (0..self.terminals.len()).map(torque).collect::<Option<_>>()?;
                    let signs: Vec<i8> = torques.iter().map(Rational::sign).collect();
                    if all.iter().all(|c| c.pattern != pattern || c.signs != signs) {
                        all.push(TorqueCell { pattern, signs, torques });
                    }
                }
            }
        }
        Some((all, singular))
    }

    /// Every cone of terminal torques that is in equilibrium at given base speeds, or how many
    /// patterns of drivers would have to be tried. The second value tells that some pattern is
    /// singular: the train lies exactly on a self-locking threshold.
    pub fn torque_cells(&self, base: &[Rational]) -> Result<(Vec<TorqueCell>, bool), u32> {
        if let Some(cells) = self.certified_cells(base) {
            return Ok((cells, false));
        }
        let k = self.active.len();
        let sigma = self.sigma_signs(base);
        let moving: Vec<usize> = (0..k).filter(|&j| sigma[j] != 0 && self.lossy(j)).collect();
        if moving.len() as u32 > MOST_TRIED {
            return self.cells_under_load(base).ok_or(moving.len() as u32);
        }
        let mut all = Vec::new();
        let mut singular = false;
        let linked = usize::from(self.link.is_some());
        for mask in 0u64..1 << (moving.len() + linked) {
            let mut pattern = self.no_drivers();
            moving.iter().enumerate().for_each(|(bit, &j)| pattern[j] = Some(mask >> bit & 1 == 0));
            let mut basis = null_space(self.rows(&pattern), k);
            if basis.len() != self.torques {
                singular = true;
                continue;
            }
            if self.link.is_some() {
                pattern[k] = Some(mask >> moving.len() & 1 == 0);
                let c = self.balanced(&pattern, &self.torque_forms(&pattern, &basis), base);
                let force = |j: usize| arrangement::dot(&basis.iter().map(|b| b[j].clone()).collect::<Vec<_>>(), &c);
                basis = vec![(0..k).map(force).collect()];
                if basis[0].iter().all(Rational::is_zero) {
                    singular = true;
                    continue;
                }
            }
            self.cones((&pattern, base), &moving, &sigma, &basis, &mut all);
        }
        Ok((all, singular))
    }

    /// The cones within one pattern's space of equilibria.
    fn cones(
        &self,
        (pattern, base): (&Pattern, &[Rational]),
        moving: &[usize],
        sigma: &[i8],
        basis: &[Vec<Rational>],
        all: &mut Vec<TorqueCell>,
    ) {
        let k = self.active.len();
        let force = |j: usize| -> Vec<Rational> { basis.iter().map(|b| b[j].clone()).collect() };
        let torque_forms = self.torque_forms(pattern, basis);
        // An element that is idle throughout fits both drivers; it is counted once.
        if moving.iter().any(|&j| pattern[j] == Some(false) && force(j).iter().all(Rational::is_zero)) {
            return;
        }
        // The force of each element that moves has the sign of its driver; torques have any.
        let mut forms: Vec<Vec<Rational>> = Vec::new();
        let mut wanted: Vec<i8> = Vec::new();
        let forces = moving.iter().map(|&j| (force(j), if pattern[j] == Some(true) { sigma[j] } else { -sigma[j] }));
        for (form, sign) in forces.chain(torque_forms.iter().map(|t| (t.clone(), 0))) {
            let Some((form, way)) = arrangement::normal(&form) else { continue };
            let sign = sign * way;
            match forms.iter().position(|f| *f == form) {
                Some(n) if wanted[n] * sign < 0 => return,
                Some(_) => {}
                None => {
                    forms.push(form);
                    wanted.push(sign);
                }
            }
        }
        for cell in arrangement::cells_where(&forms, &wanted, basis.len()) {
            let forces: Vec<Rational> = (0..k).map(|j| arrangement::dot(&force(j), &cell.point)).collect();
            let torques: Vec<Rational> = torque_forms.iter().map(|t| arrangement::dot(t, &cell.point)).collect();
            let mut own = pattern.clone();
            if self.link.is_some() {
                match self.runs(base, &torque_forms, &cell.point) * runs(pattern[k]) {
                    -1 => continue,
                    // Without power either way fits; it is counted once.
                    0 if pattern[k] == Some(false) => continue,
                    0 => own[k] = None,
                    _ => {}
                }
            }
            moving.iter().filter(|&&j| forces[j].is_zero()).for_each(|&j| own[j] = None);
            all.push(TorqueCell { pattern: own, signs: torques.iter().map(Rational::sign).collect(), torques });
        }
    }
}

/// Which way that is: 1 from the first end to the second.
fn runs(forward: Option<bool>) -> i8 {
    if forward == Some(false) { -1 } else { 1 }
}

/// The two sides of a variator.
struct Sides {
    variator: usize,
    ports: [Port; 2],
    efficiency: [Rational; 2],
}

struct Port {
    member: MemberId,
    name: String,
    /// What it is called where that is another's name.
    apart: String,
}

/// The sides of the train's variator in a state; none where it passes nothing on. `Err` says why its regimes are not
/// enumerated.
fn sides(c: &Configuration<'_>) -> Result<Option<Sides>, String> {
    let train = c.train;
    // With one freedom its ratio is fixed; machines may push against each other, and that is no regime.
    if train.variators.is_empty() || c.degrees_of_freedom() < 2 {
        return Ok(None);
    }
    let [v] = &train.variators[..] else {
        let names: Vec<&str> = train.variators.iter().map(|v| v.name.as_str()).collect();
        return Err(format!(
            "regimes are enumerated with one variator, and this train has {}: {}; a sweep over `ratio` answers",
            names.len(),
            names.join(", ")
        ));
    };
    let unfit =
        |why: &str| Err(format!("regimes are not enumerated for {}: {why}; a sweep over `ratio` answers", v.name));
    let (names, efficiency) = match &v.path {
        VariatorPath::Direct { members, efficiency, .. } => (
            members.map(|m| train.member_name(m).to_owned()),
            [efficiency.forward.clone(), efficiency.backward.clone()],
        ),
        VariatorPath::Bus { machines, store, standby } => {
            let [a, b] = &machines[..] else { return unfit("its bus has more or fewer than two machines") };
            if !matches!(store, Store::Power(p) if p.value.is_zero()) {
                return unfit("its store gives power of its own");
            }
            if *standby > 0.0 {
                return unfit("it has standby losses");
            }
            let (MachineEfficiency::Constant(x), MachineEfficiency::Constant(y)) = (&a.efficiency, &b.efficiency)
            else {
                return unfit("the efficiency of its machines depends on speed and torque");
            };
            let both = [&x.backward * &y.forward, &y.backward * &x.forward];
            ([a.name.clone(), b.name.clone()], both)
        }
    };
    let members = v.members();
    let nodes = [members[0], members[1]].map(|m| c.node(m));
    // A side that is held takes no power, and then neither does the other.
    if nodes[0] == nodes[1] || nodes.contains(&None) {
        return Ok(None);
    }
    let [first, second] = names;
    let port = |member: MemberId, name: String| {
        let apart = format!("{} at {}", v.name, train.member_name(member));
        Port { member, name, apart }
    };
    Ok(Some(Sides { variator: 0, ports: [port(members[0], first), port(members[1], second)], efficiency }))
}

/// Most elements with relative motion and loss for which every pattern of drivers is tried.
pub(crate) const MOST_TRIED: u32 = 12;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::train::Train;

    /// Two rows of stages, by their kinds, that a differential joins; two of three shafts are free.
    fn joined(rows: [&[usize]; 2]) -> Train {
        let (mut members, mut sets) = (vec!["out".to_owned()], String::new());
        for (kinds, row) in rows.into_iter().zip(["a", "b"]) {
            members.extend((0..=kinds.len()).map(|k| format!("{row}{k}")));
            for (k, kind) in kinds.iter().enumerate() {
                let (from, to) = (format!("{row}{k}"), format!("{row}{}", k + 1));
                let suns = |frame: usize, [carrier, sun]: [&String; 2]| {
                    format!(
                        "type = \"stepped\"\ncarrier = \"{carrier}\"\nsuns = [ {{ member = \"frame\", teeth = {frame}, \
                         planet_teeth = 20 }}, {{ member = \"{sun}\", teeth = 20, planet_teeth = 20 }} ]\n"
                    )
                };
                let own = match kind {
                    0 => format!(
                        "type = \"simple\"\nsun = {{ member = \"{from}\", teeth = {} }}\n\
                         ring = {{ member = \"frame\", teeth = {} }}\ncarrier = \"{to}\"\n",
                        20 + k,
                        60 + 3 * k
                    ),
                    1 => suns(19, [&from, &to]),
                    // Exactly on the threshold.
                    2 => suns(18, [&from, &to]),
                    3 => suns(21, [&to, &from]),
                    _ => suns(18, [&to, &from]),
                };
                sets += &format!("[[set]]\nname = \"{row}{k}\"\nbasic_efficiency = 0.9\n{own}");
            }
        }
        let ends = rows.map(<[usize]>::len);
        let text = format!(
            "format = 1\nname = \"joined\"\nmembers = {members:?}\nterminals = [\"a0\", \"b0\", \"out\"]\n{sets}\
             [[set]]\nname = \"D\"\ntype = \"simple\"\nsun = {{ member = \"a{}\", teeth = 30 }}\n\
             ring = {{ member = \"b{}\", teeth = 61 }}\ncarrier = \"out\"\nbasic_efficiency = 0.97\n",
            ends[0], ends[1]
        );
        Train::from_toml(&text).unwrap()
    }

    #[test]
    fn the_statics_finds_the_cells_of_all_patterns() {
        let (mut compared, mut uncertified, mut on_thresholds) = (0, 0, 0);
        let rows: [[&[usize]; 2]; 11] = [
            [&[1, 3], &[]],
            [&[1], &[3]],
            [&[0, 1, 0, 3], &[]],
            [&[1, 3], &[1, 0]],
            [&[1, 1, 3], &[0]],
            [&[0, 3], &[1, 3, 3]],
            [&[2, 3], &[]],
            [&[0, 2], &[4]],
            [&[1, 4, 0], &[2]],
            [&[0, 2, 4, 0], &[]],
            [&[2, 4], &[2, 4]],
        ];
        for own in rows {
            let train = joined(own);
            let c = Configuration::new(&train, &[], &[], &[]);
            let setup = Setup::new(c, train.terminals(), Linked::Nothing).unwrap();
            for region in setup.speed_cells(&setup.planes()) {
                let (all, singular) = setup.torque_cells(&region.point).unwrap();
                let (found, on_threshold) = setup.cells_under_load(&region.point).unwrap();
                let of = |cells: &[TorqueCell]| -> std::collections::BTreeSet<(Pattern, Vec<i8>)> {
                    cells.iter().map(|c| (c.pattern.clone(), c.signs.clone())).collect()
                };
                let [found, all] = [of(&found), of(&all)];
                // Patterns on a threshold are not listed; the ends of what they allow are equilibria all the same.
                assert!(found.is_superset(&all) && (singular || found == all), "{own:?} {:?}", region.point);
                assert!(singular || !on_threshold, "{own:?}");
                compared += 1;
                uncertified += usize::from(setup.certified_cells(&region.point).is_none());
                on_thresholds += usize::from(singular);
            }
        }
        assert!(compared > 80 && uncertified > 70 && on_thresholds > 0, "{compared} {uncertified} {on_thresholds}");
    }
}
