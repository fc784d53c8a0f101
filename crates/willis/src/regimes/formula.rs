//! The closed formulas: torques, efficiency and loss of a regime as rational functions of basic
//! ratios, efficiencies and, with two or more freedoms, speeds and torques.
//!
//! With `x_j = i_j ρ_j` every terminal torque is a quotient of determinants that are linear in each
//! `x_j` (Cramer). The determinants do not depend on who drives, so they are computed once; a
//! regime puts `x = i η` where end p drives, `x = i/η` where end q drives and `x = i` where nothing
//! moves. For one degree of freedom this is the rule `η = i(x)/i` of virtual work.

use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::rc::Rc;

use crate::exact::Rational;
use crate::symbolic::{Determinants, Entries, Known, Notation, Polynomial, RationalFunction, Symbol};
use crate::train::{MemberId, MeshId};

use super::hub::Hubs;
use super::setup::{Pattern, Setup};

/// What a symbol stands for.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SymbolInfo {
    /// Identifier in text and code.
    pub name: String,
    pub latex: String,
    /// Its value in this train; speeds and torques have none.
    pub value: Option<Rational>,
    pub kind: SymbolKind,
    /// What it stands for, in words.
    pub meaning: String,
    /// Of a basic ratio the speeds that it is made of, as LaTeX.
    pub made_of: Option<String>,
}

/// What a quantity of a formula is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum SymbolKind {
    /// A basic ratio: any number but 0.
    Ratio,
    /// An efficiency: above 0 and at most 1.
    Efficiency,
    /// The torque on a terminal.
    Torque,
    /// The speed of a terminal.
    Speed,
    /// A number of teeth: above 0.
    Teeth,
}

/// The symbolic solution of a setup, for all of its regimes.
#[derive(Clone, Debug)]
pub(crate) struct Shape<'s, 't> {
    pub setup: &'s Setup<'t>,
    /// Terminals whose torques are free.
    pub reference: Vec<usize>,
    /// By terminal and reference: `T = Σ factor T_reference`, in `x`.
    pub torque: Vec<Vec<RationalFunction>>,
    /// By active element and reference, in `x`.
    pub force: Vec<Vec<RationalFunction>>,
    /// By terminal and base: `ω = Σ factor ω_base`, in `i`.
    pub speed: Vec<Vec<RationalFunction>>,
    /// By active element: `ω_p − ω_c` in the speeds of the terminals.
    pub sigma: Vec<RationalFunction>,
    pub names: Names,
    /// `torque` and `force` for drivers, once worked out.
    driven: RefCell<BTreeMap<Pattern, Rc<Driven>>>,
}

/// Torques and forces over the references when it is known who drives.
#[derive(Clone, Debug)]
struct Driven {
    torque: Vec<Vec<RationalFunction>>,
    force: Vec<Vec<RationalFunction>>,
}

/// Most terms of a determinant: longer formulas help nobody.
const MOST_TERMS: usize = 600;

/// Most terms of a sum before those that cancel are gone: two long products without a common factor have no short form.
const MOST_ADDED: usize = 1 << 11;

/// Sums that stay short.
#[derive(Default)]
struct Sums {
    is_too_long: Cell<bool>,
}

impl Sums {
    /// The sum; zero in the place of one that is too long, which [`Self::are_short`] tells before it is used.
    fn plus(&self, a: &RationalFunction, b: &RationalFunction) -> RationalFunction {
        a.plus_within(b, MOST_ADDED).unwrap_or_else(|| {
            self.is_too_long.set(true);
            RationalFunction::ZERO
        })
    }

    /// The sum of many.
    fn of(&self, all: impl Iterator<Item = RationalFunction>) -> RationalFunction {
        all.fold(RationalFunction::ZERO, |sum, f| self.plus(&sum, &f))
    }

    fn are_short(&self) -> Result<(), String> {
        match self.is_too_long.get() {
            true => Err(format!("a part, multiplied out, may have more than {MOST_ADDED} terms")),
            false => Ok(()),
        }
    }
}

/// The symbols of a setup, by number.
#[derive(Clone, Debug)]
pub(crate) struct Names {
    pub infos: Vec<SymbolInfo>,
    elements: usize,
    terminals: usize,
    /// What a basic ratio or efficiency is made of.
    details: BTreeMap<Symbol, RationalFunction>,
    /// By element whose two directions have efficiencies of their own: its symbol where end q drives. That where p drives
    /// has the number of the element's efficiency.
    backward: Vec<Option<SymbolInfo>>,
    /// By arm of a planet whose hub is lossy: one efficiency for both, where the drivers allow it.
    shared: Vec<Option<SymbolInfo>>,
    hubs: Hubs,
    /// Efficiency of the link, from its first end to its second and back; one symbol where they are the same.
    link: Option<[Symbol; 2]>,
}

impl Names {
    pub fn ratio(&self, j: usize) -> Symbol {
        Symbol(2 * j)
    }

    pub fn efficiency(&self, j: usize) -> Symbol {
        Symbol(2 * j + 1)
    }

    /// Placeholder `i ρ`; never printed.
    fn x(&self, j: usize) -> Symbol {
        Symbol(2 * self.elements + j)
    }

    pub fn torque(&self, t: usize) -> Symbol {
        Symbol(3 * self.elements + t)
    }

    pub fn speed(&self, t: usize) -> Symbol {
        Symbol(3 * self.elements + self.terminals + t)
    }

    pub fn info(&self, s: Symbol) -> &SymbolInfo {
        &self.infos[s.0]
    }

    /// All symbols, those of either direction beside each other.
    pub fn all(&self) -> impl Iterator<Item = &SymbolInfo> {
        self.infos.iter().enumerate().flat_map(|(n, info)| {
            let element = (n % 2 == 1).then_some(n / 2).filter(|j| *j < self.elements);
            let backward = element.and_then(|j| self.backward[j].as_ref());
            let shared = element.and_then(|j| self.shared[j].as_ref());
            [Some(info), backward, shared].into_iter().flatten()
        })
    }

    /// How a symbol is written.
    pub fn written(&self, notation: Notation, s: Symbol) -> String {
        match notation {
            Notation::Latex => self.info(s).latex.clone(),
            _ => self.info(s).name.clone(),
        }
    }

    pub fn show(&self, notation: Notation, f: &RationalFunction) -> String {
        self.writer(notation)(f)
    }

    /// What writes many functions, whose factors are mostly the same.
    pub fn writer(&self, notation: Notation) -> impl FnMut(&RationalFunction) -> String {
        let mut known = [Known::default(), Known::default()];
        move |f| {
            notation.function_of(f, &mut |p, flipped| {
                let write = |p: &Polynomial| notation.polynomial(p, &|s| self.written(notation, s), flipped);
                known[usize::from(flipped)].of(p, write).clone()
            })
        }
    }

    fn new(setup: &Setup<'_>) -> Self {
        let train = setup.c.train;
        let k = setup.active.len();
        let mut used: Vec<String> = Vec::new();
        let mut unique = |wanted: String| {
            let mut name = wanted.clone();
            let mut n = 2;
            while used.contains(&name) {
                name = format!("{wanted}_{n}");
                n += 1;
            }
            used.push(name.clone());
            name
        };
        let mut infos: Vec<SymbolInfo> = Vec::new();
        let mut backward: Vec<Option<SymbolInfo>> = Vec::new();
        let mut shared: Vec<Option<SymbolInfo>> = vec![None; k];
        let hubs = Hubs::of(setup);
        let blank = |kind| SymbolInfo {
            name: String::new(),
            latex: String::new(),
            value: Some(Rational::ONE),
            kind,
            meaning: String::new(),
            made_of: None,
        };
        for j in 0..k {
            let e = setup.element(j);
            if e.is_rigid() || hubs.is_hub(j) && !setup.lossy(j) {
                // It joins its ends, or what it measures has the ratio one, and stands in no formula.
                infos.extend([blank(SymbolKind::Ratio), blank(SymbolKind::Efficiency)]);
                backward.push(None);
                continue;
            }
            let label = symbol_label(setup, &hubs, j, true);
            let toothed = setup.c.elements.iter().filter(|e| !e.is_rigid()).count();
            let (suffix, index) = match train.sets.len().max(toothed) {
                1 => ("0".to_owned(), "_{0}".to_owned()),
                _ => (format!("_{}", identifier(&label)), format!("_{{{}}}", upright(&label))),
            };
            let [p, q, c] = ends(setup, &hubs, j, true);
            let [wp, wq, wc] = [p, q, c].map(|m| format!("\\omega_{{{}}}", upright(m)));
            let (seen, seen_latex) = match c {
                "frame" => (format!("w_{p} / w_{q}"), format!("{wp}/{wq}")),
                _ => (format!("(w_{p} - w_{c}) / (w_{q} - w_{c})"), format!("({wp} - {wc})/({wq} - {wc})")),
            };
            infos.push(match hubs.is_hub(j) {
                true => blank(SymbolKind::Ratio),
                false => SymbolInfo {
                    name: unique(format!("i{suffix}")),
                    latex: format!("i{index}"),
                    value: Some(hubs.ratio(setup, j)),
                    kind: SymbolKind::Ratio,
                    meaning: format!("basic ratio {seen}"),
                    made_of: Some(seen_latex),
                },
            });
            // Where the hub of its planet loses too, an arm has an efficiency of its own beside the one for both.
            let is_split = hubs.arm(j).is_some_and(|arm| setup.lossy(arm.hub));
            let own_label = symbol_label(setup, &hubs, j, !is_split);
            let (suffix, index) = match is_split {
                true => (format!("_{}", identifier(&own_label)), format!("_{{{}}}", upright(&own_label))),
                false => (suffix, index),
            };
            let [p, q, c] = ends(setup, &hubs, j, !is_split);
            let efficiency = |name: String, latex: String, value: &Rational, meaning: String| SymbolInfo {
                name,
                latex,
                value: Some(value.clone()),
                kind: SymbolKind::Efficiency,
                meaning,
                made_of: None,
            };
            if let Some(arm) = hubs.arm(j).filter(|_| hubs.shares(setup, j)) {
                let [p, q, c] = ends(setup, &hubs, j, true);
                let [own, of_hub] = [j, arm.hub].map(|j| symbol_label(setup, &hubs, j, false));
                let meaning = format!(
                    "basic efficiency between {p} and {q} seen from {c}: the product of those of {own} and {of_hub}"
                );
                let (name, index) = (format!("eta_{}", identifier(&label)), format!("_{{{}}}", upright(&label)));
                let value = &e.forward * &setup.element(arm.hub).forward;
                shared[j] = Some(efficiency(unique(name), format!("\\eta{index}"), &value, meaning));
            }
            if e.forward == e.backward {
                let meaning = format!("efficiency between {p} and {q} seen from {c}");
                infos.push(efficiency(unique(format!("eta{suffix}")), format!("\\eta{index}"), &e.forward, meaning));
                backward.push(None);
                continue;
            }
            // One symbol would stand for two numbers.
            let [of_p, of_q] = [(p, q, &e.forward), (q, p, &e.backward)].map(|(driver, driven, value)| {
                efficiency(
                    unique(format!("eta{suffix}_{}", identifier(driver))),
                    format!("\\eta{},{}}}", index.strip_suffix('}').expect("in braces"), upright(driver)),
                    value,
                    format!("efficiency seen from {c}, {driver} driving {driven}"),
                )
            });
            infos.push(of_p);
            backward.push(Some(of_q));
        }
        // Placeholders, so that positions and numbers agree.
        infos.extend((0..k).map(|j| SymbolInfo {
            name: format!("x{j}"),
            latex: format!("x_{{{j}}}"),
            value: None,
            kind: SymbolKind::Ratio,
            meaning: String::new(),
            made_of: None,
        }));
        for (letter, tex, kind, word) in
            [("T", "T", SymbolKind::Torque, "torque on"), ("w", "\\omega", SymbolKind::Speed, "speed of")]
        {
            for t in &setup.terminals {
                let member = t.name.as_str();
                infos.push(SymbolInfo {
                    name: unique(format!("{letter}_{}", identifier(member))),
                    latex: format!("{tex}_{{{}}}", upright(member)),
                    value: None,
                    kind,
                    meaning: format!("{word} {member}"),
                    made_of: None,
                });
            }
        }
        let link = setup.link.as_ref().filter(|link| link.variator.is_some()).map(|link| {
            let ends = link.ends.map(|t| setup.terminal_name(t));
            let variator = setup.link_name();
            let directed = link.efficiency[0] != link.efficiency[1];
            let mut of = |from: &str, to: &str, value: &Rational| {
                let (suffix, index) = match directed {
                    true => (format!("_{}", identifier(from)), format!(",{}", upright(from))),
                    false => (String::new(), String::new()),
                };
                let way = if directed { format!(", {from} to {to}") } else { String::new() };
                infos.push(SymbolInfo {
                    name: unique(format!("eta_v{suffix}")),
                    latex: format!("\\eta_{{v{index}}}"),
                    value: Some(value.clone()),
                    kind: SymbolKind::Efficiency,
                    meaning: format!("efficiency of {variator}{way}"),
                    made_of: None,
                });
                Symbol(infos.len() - 1)
            };
            let forward = of(ends[0], ends[1], &link.efficiency[0]);
            [forward, if directed { of(ends[1], ends[0], &link.efficiency[1]) } else { forward }]
        });
        let terminals = setup.terminals.len();
        let mut names = Self { infos, elements: k, terminals, details: BTreeMap::new(), backward, shared, hubs, link };
        names.detail(setup, &mut unique);
        names
    }

    /// Tooth numbers behind the ratios.
    fn detail(&mut self, setup: &Setup<'_>, unique: &mut dyn FnMut(String) -> String) {
        let train = setup.c.train;
        let mut teeth: Vec<(usize, usize, Symbol)> = Vec::new();
        for j in 0..self.elements {
            let mut ratio = RationalFunction::ONE;
            for link in &setup.element(j).links {
                let mesh = &train.meshes[link.mesh.0];
                let mut symbols = [0, 1].map(|g| {
                    let gear = &mesh.gears[g];
                    // One gear of a member may mesh with several others.
                    let known = teeth.iter().find(|(m, g, _)| {
                        let other = &train.meshes[*m].gears[*g];
                        other.member == gear.member
                            && other.teeth == gear.teeth
                            && other.internal == gear.internal
                            && train.meshes[*m].set == mesh.set
                    });
                    if let Some((_, _, s)) = known {
                        return *s;
                    }
                    let member = train.member_name(gear.member);
                    let s = Symbol(self.infos.len());
                    self.infos.push(SymbolInfo {
                        name: unique(format!("z_{}", identifier(member))),
                        latex: format!("z_{{{}}}", upright(member)),
                        value: Some(gear.teeth.clone()),
                        kind: SymbolKind::Teeth,
                        meaning: format!("teeth of {member} in {}", mesh.name),
                        made_of: None,
                    });
                    teeth.push((link.mesh.0, g, s));
                    s
                });
                if !link.along {
                    symbols.reverse();
                }
                // (ω_1 − ω_c)/(ω_2 − ω_c) = ∓ z_2/z_1
                let [from, to] = symbols.map(RationalFunction::symbol);
                let own = to.over(&from);
                ratio = ratio.times(&if mesh.same_sense { own } else { own.negated() });
            }
            self.details.insert(self.ratio(j), ratio);
        }
        // Between central gears the teeth of the planet cancel.
        let own = self.details.clone();
        for j in 0..self.elements {
            let Some(arm) = self.hubs.arm(j) else { continue };
            let (mine, hub) = (&own[&self.ratio(j)], &own[&self.ratio(arm.hub)]);
            let ratio = if arm.multiplies() { mine.times(hub) } else { mine.over(hub) };
            self.details.insert(self.ratio(j), ratio);
        }
    }

    /// A name that no symbol has, with a number if need be. The efficiency of an element gives way
    /// to that of its mesh.
    fn free(&mut self, wanted: String) -> String {
        let elements = 2 * self.elements;
        for info in self.infos[..elements].iter_mut().filter(|info| info.name == wanted) {
            info.name += "_basic";
        }
        let taken = |name: &String| self.infos.iter().any(|info| info.name == *name);
        let numbered = (2..).map(|n| format!("{wanted}_{n}"));
        std::iter::once(wanted.clone()).chain(numbered).find(|name| !taken(name)).expect("numbers do not end")
    }

    /// The symbols of the meshes' own efficiencies, for a pattern of drivers.
    fn mesh_efficiencies(&mut self, setup: &Setup<'_>, pattern: &Pattern) {
        let train = setup.c.train;
        for j in 0..self.elements {
            let mut product = RationalFunction::ONE;
            for link in &setup.element(j).links {
                let MeshId(m) = link.mesh;
                let mesh = &train.meshes[m];
                // Forward: the first gear drives.
                let forward = (pattern[j] == Some(true)) == link.along;
                let own = &setup.c.efficiencies[m];
                let value = if forward { &own.forward } else { &own.backward };
                // A loss given for the whole set is booked on its first mesh.
                if *value == Rational::ONE {
                    continue;
                }
                let [a, b] = if forward { [0, 1] } else { [1, 0] }.map(|g| train.member_name(mesh.gears[g].member));
                let s = Symbol(self.infos.len());
                let name = self.free(format!("eta_{}", identifier(&mesh.name)));
                self.infos.push(SymbolInfo {
                    name,
                    latex: format!("\\eta_{{{}}}", upright(&mesh.name)),
                    value: Some(value.clone()),
                    kind: SymbolKind::Efficiency,
                    meaning: format!("efficiency of {}, {a} driving {b}", mesh.name),
                    made_of: None,
                });
                product = product.times(&RationalFunction::symbol(s));
            }
            self.details.insert(self.efficiency(j), product);
        }
        // What stands for both is made of the meshes of both.
        let own = self.details.clone();
        for j in 0..self.elements {
            let Some(arm) = self.hubs.arm(j).filter(|arm| self.hubs.is_shared(setup, pattern, arm.hub)) else {
                continue;
            };
            let both = own[&self.efficiency(j)].times(&own[&self.efficiency(arm.hub)]);
            self.details.insert(self.efficiency(j), both);
        }
    }

    /// Ratio of an element in formulas: one where it only joins its ends, or measures a planet.
    fn ratio_of(&self, j: usize) -> RationalFunction {
        if self.hubs.is_hub(j) { RationalFunction::ONE } else { RationalFunction::symbol(self.ratio(j)) }
    }

    /// `ρ` of an element for a pattern of drivers.
    fn rho(&self, setup: &Setup<'_>, pattern: &Pattern, j: usize) -> RationalFunction {
        if self.hubs.is_hub(j) && self.hubs.is_shared(setup, pattern, j) {
            return RationalFunction::ONE;
        }
        let eta = RationalFunction::symbol(self.efficiency(j));
        match pattern[j] {
            Some(true) => eta,
            Some(false) => eta.recip(),
            None => RationalFunction::ONE,
        }
    }
}

/// Names of the ends of an element and of its carrier; `basic`: of an arm, between central gears.
fn ends<'s>(setup: &'s Setup<'_>, hubs: &Hubs, j: usize, basic: bool) -> [&'s str; 3] {
    let e = setup.element(j);
    let [mut p, mut q] = [e.p, e.q];
    if let Some(arm) = hubs.arm(j).filter(|_| basic) {
        let hub = setup.element(arm.hub);
        let central = if arm.hub_runs_out { hub.q } else { hub.p };
        *if arm.runs_in { &mut q } else { &mut p } = central;
    }
    [p, q, e.carrier].map(|m| setup.member_name(m))
}

/// What the symbols of an element are called by; `basic`: of an arm, by its set and central gear.
fn symbol_label(setup: &Setup<'_>, hubs: &Hubs, j: usize, basic: bool) -> String {
    let train = setup.c.train;
    let e = setup.element(j);
    let set = e.links.first().and_then(|l| train.meshes[l.mesh.index()].set);
    match (hubs.arm(j).filter(|_| basic), set) {
        (Some(arm), Some(set)) => {
            format!("{}.{}", train.sets[set].name, setup.member_name(if arm.runs_in { e.p } else { e.q }))
        }
        (Some(_), None) => ends(setup, hubs, j, true)[..2].join("-"),
        (None, _) => element_label(setup, j),
    }
}

/// What an element is called: its set where that says enough, else its ends.
pub(crate) fn element_label(setup: &Setup<'_>, j: usize) -> String {
    let train = setup.c.train;
    let set_of = |j: usize| {
        let mut sets = setup.element(j).links.iter().map(|l| train.meshes[l.mesh.0].set);
        let first = sets.next().flatten();
        sets.all(|s| s == first).then_some(first).flatten()
    };
    let own = set_of(j);
    let alone = (0..setup.active.len()).filter(|&other| set_of(other) == own).count() == 1;
    let e = setup.element(j);
    match own {
        Some(s) if alone => train.sets[s].name.clone(),
        _ if e.links.len() == 1 => train.meshes[e.links[0].mesh.0].name.clone(),
        Some(s) => format!("{}.{}-{}", train.sets[s].name, train.member_name(e.p), train.member_name(e.q)),
        None => format!("{}-{}", setup.member_name(e.p), setup.member_name(e.q)),
    }
}

/// Letters, digits and underscores only.
pub(crate) fn identifier(name: &str) -> String {
    let text: String = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    if text.is_empty() { "_".to_owned() } else { text }
}

/// A name as an upright index; single letters and numbers stay as they are.
pub(crate) fn upright(name: &str) -> String {
    if name.chars().count() == 1 || name.chars().all(|c| c.is_ascii_digit()) {
        return escape(name);
    }
    format!("\\mathrm{{{}}}", escape(name).replace('-', "\\text{-}").replace(' ', "\\ "))
}

/// Text that LaTeX sets as it stands.
pub(crate) fn escape(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars() {
        match c {
            '\\' => out.push_str("\\backslash{}"),
            '_' | '%' | '&' | '#' | '$' | '{' | '}' => {
                out.push('\\');
                out.push(c);
            }
            '^' => out.push_str("\\hat{}"),
            '~' => out.push_str("\\sim{}"),
            _ => out.push(c),
        }
    }
    out
}

/// A condition of a formula: a function that must be positive.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Condition {
    pub function: RationalFunction,
    /// What it ensures.
    pub meaning: String,
}

/// How far formulas are spelt out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Ratios {
    /// One symbol for the basic ratio of each element.
    #[default]
    Basic,
    /// Tooth numbers as symbols.
    Teeth,
    /// The numbers of this train.
    Numbers,
}

/// How efficiencies appear in formulas.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Efficiencies {
    /// One symbol for each element: the product over its meshes.
    #[default]
    Basic,
    /// One symbol for each mesh.
    Meshes,
    /// The numbers of this train.
    Numbers,
}

impl<'s, 't> Shape<'s, 't> {
    /// `Err` when the train is too large for symbols.
    pub fn new(setup: &'s Setup<'t>, prefer: &[usize]) -> Result<Self, String> {
        let k = setup.active.len();
        let nodes = setup.nodes();
        let too_long =
            || format!("with {k} elements and {} shafts they would have more than {MOST_TERMS} terms", nodes.len());
        let names = Names::new(setup);
        // What only joins its ends has the ratio one.
        let over = |symbol: &dyn Fn(usize) -> Symbol| -> Vec<Polynomial> {
            let of = |j: usize| {
                let is_one = setup.element(j).is_rigid() || names.hubs.is_hub(j);
                if is_one { Polynomial::from(1) } else { Polynomial::symbol(symbol(j)) }
            };
            (0..k).map(of).collect()
        };
        let (x, i) = (over(&|j| names.x(j)), over(&|j| names.ratio(j)));
        let row = |node: usize, x: &[Polynomial]| -> Vec<Polynomial> {
            (0..k).map(|j| coefficient(setup, j, node, &x[j])).collect()
        };

        // Torques: the free rows and one row for each reference torque make a square matrix.
        // Those of a link last: their quotient has a pole where one of the two stands still.
        let balanced = |t: usize| setup.is_end(t);
        let mut order: Vec<usize> = (0..setup.terminals.len()).collect();
        order.sort_by_key(|&t| (!prefer.contains(&t), balanced(t)));
        let mut rows: Vec<Vec<Polynomial>> = setup.free.iter().map(|&n| row(n, &x)).collect();
        let mut reference = Vec::new();
        // First those that are independent with the ratios of this train, then in general.
        for (actual, t) in [true, false].into_iter().flat_map(|actual| order.iter().map(move |t| (actual, *t))) {
            if reference.len() == setup.torques {
                break;
            }
            let mut trial = rows.clone();
            trial.push(row(setup.terminals[t].node, &x));
            if !reference.contains(&t) && independent(&trial, setup, &names, actual) {
                rows = trial;
                reference.push(t);
            }
        }
        let mut determinants = Determinants::new(MOST_TERMS);
        let mut determinant = |columns: &[Entries<'_>]| determinants.of(columns).ok_or_else(too_long);
        let columns = columns_of(&rows, k);
        let whole = determinant(&columns)?;
        if whole.is_zero() {
            return Err("the terminal torques are not determined by each other".to_owned());
        }
        let first = setup.free.len();
        // The row of a reference replaced by another one.
        let mut with_row = |r: usize, own: &[Polynomial]| {
            let mut changed = columns.clone();
            for (column, entry) in changed.iter_mut().zip(own) {
                column.retain(|(row, _)| *row != first + r);
                column.extend((!entry.is_zero()).then_some((first + r, entry)));
            }
            determinant(&changed).map(|d| d.over(&whole))
        };
        let d = setup.torques;
        let torque = (0..setup.terminals.len())
            .map(|t| -> Result<Vec<RationalFunction>, String> {
                (0..d)
                    .map(|r| match reference.iter().position(|&own| own == t) {
                        Some(own) if own == r => Ok(RationalFunction::ONE),
                        Some(_) => Ok(RationalFunction::ZERO),
                        None => with_row(r, &row(setup.terminals[t].node, &x)),
                    })
                    .collect()
            })
            .collect::<Result<_, _>>()?;
        let mut unit = vec![Polynomial::from(0); k];
        let mut force = Vec::with_capacity(k);
        for j in 0..k {
            unit[j] = Polynomial::from(1);
            force.push((0..d).map(|r| with_row(r, &unit)).collect::<Result<Vec<_>, _>>()?);
            unit[j] = Polynomial::from(0);
        }

        // Speeds: the elements' rows and one row for each base speed.
        let mut rows: Vec<Vec<Polynomial>> =
            (0..k).map(|j| nodes.iter().map(|&n| kinematic(setup, j, n, &i[j])).collect()).collect();
        rows.extend(setup.base.iter().map(|&b| {
            let own = setup.terminals[b].node;
            nodes.iter().map(|&n| Polynomial::from(i64::from(own == n))).collect()
        }));
        let mut columns = columns_of(&rows, nodes.len());
        let whole = determinant(&columns)?;
        if whole.is_zero() {
            return Err("the speeds are not determined by those of the terminals".to_owned());
        }
        let one = Polynomial::from(1);
        let mut node_speeds = Vec::with_capacity(nodes.len());
        for at in 0..nodes.len() {
            let own = std::mem::take(&mut columns[at]);
            let mut of_base = |b: usize| {
                // Cramer: the node's column replaced by the unit vector of base b's row.
                columns[at] = vec![(k + b, &one)];
                determinant(&columns).map(|d| d.over(&whole))
            };
            node_speeds.push((0..setup.base.len()).map(&mut of_base).collect::<Result<Vec<_>, String>>()?);
            columns[at] = own;
        }
        let node_speed = |node: usize, b: usize| -> RationalFunction {
            nodes.iter().position(|&n| n == node).map_or(RationalFunction::ZERO, |at| node_speeds[at][b].clone())
        };
        let speed = (0..setup.terminals.len())
            .map(|t| {
                (0..setup.base.len())
                    .map(|b| match setup.base.iter().position(|&own| own == t) {
                        Some(own) if own == b => RationalFunction::ONE,
                        Some(_) => RationalFunction::ZERO,
                        None => node_speed(setup.terminals[t].node, b),
                    })
                    .collect::<Vec<RationalFunction>>()
            })
            .collect();
        // With one freedom every speed is a product of ratios; the difference of such a product and of a symbol for it would
        // be multiplied out.
        let one = setup.base.len() == 1 && setup.independent_torques() == 1;
        let sums = Sums::default();
        let in_terminals = |node: Option<usize>| -> RationalFunction {
            let Some(node) = node else { return RationalFunction::ZERO };
            match setup.terminals.iter().position(|t| t.node == node) {
                Some(t) if !one => RationalFunction::symbol(names.speed(t)),
                _ => sums.of((0..setup.base.len())
                    .map(|b| node_speed(node, b).times(&RationalFunction::symbol(names.speed(setup.base[b]))))),
            }
        };
        let difference = |a: Option<usize>, b: Option<usize>| sums.plus(&in_terminals(a), &in_terminals(b).negated());
        let known = |node: Option<usize>| node.is_none_or(|n| setup.terminals.iter().any(|t| t.node == n));
        let sigma = (0..k)
            .map(|j| {
                let e = setup.element(j);
                let [p, q, c] = [e.p, e.q, e.carrier].map(|m| setup.c.node(m));
                // The end that the reader sees the speed of, where there is one.
                if known(c) && !known(p) && known(q) {
                    return names.ratio_of(j).times(&difference(q, c));
                }
                difference(p, c)
            })
            .collect();
        sums.are_short()?;
        Ok(Self { setup, reference, torque, force, speed, sigma, names, driven: RefCell::default() })
    }

    /// The value of `x = i ρ` that a driver makes.
    fn x_value(&self, pattern: &Pattern, s: Symbol) -> Option<RationalFunction> {
        let k = self.setup.active.len();
        let j = s.0.checked_sub(2 * k).filter(|j| *j < k)?;
        let rho = |j: usize| self.names.rho(self.setup, pattern, j);
        let own = self.names.ratio_of(j).times(&rho(j));
        Some(match self.names.hubs.arm(j) {
            Some(arm) if arm.multiplies() => own.times(&rho(arm.hub)),
            Some(arm) => own.over(&rho(arm.hub)),
            None => own,
        })
    }

    fn driven(&self, pattern: &Pattern) -> Rc<Driven> {
        let known = self.driven.borrow().get(pattern).cloned();
        known.unwrap_or_else(|| {
            // Many functions are made of the same few factors.
            let mut known = Known::default();
            let mut factor = |p: &Polynomial| known.of(p, |p| p.substituted(&|s| self.x_value(pattern, s))).clone();
            let mut here = |f: &RationalFunction| f.with_factors(&mut factor).expect("x has no poles of its own");
            let mut all =
                |rows: &[Vec<RationalFunction>]| rows.iter().map(|r| r.iter().map(&mut here).collect()).collect();
            let own = Rc::new(Driven { torque: all(&self.torque), force: all(&self.force) });
            self.driven.borrow_mut().insert(pattern.clone(), own.clone());
            own
        })
    }

    /// The formulas of a pattern of drivers. `roles`: the sign of the power at each terminal. `Err` when they are too long.
    pub fn formula(
        &self,
        pattern: &Pattern,
        roles: &[i8],
        ratios: Ratios,
        efficiencies: Efficiencies,
    ) -> Result<Formula, String> {
        let setup = self.setup;
        let (m, k) = (setup.terminals.len(), setup.active.len());
        let mut names = self.names.clone();
        for j in 0..k {
            let e = setup.element(j);
            if e.is_rigid() {
                continue;
            }
            let s = names.efficiency(j).0;
            let hub = names.hubs.arm(j).map(|arm| arm.hub);
            let is_shared = hub.is_some_and(|hub| names.hubs.is_shared(setup, pattern, hub));
            let basic = is_shared || hub.is_some_and(|hub| !setup.lossy(hub));
            let [p, q, c] = ends(setup, &names.hubs, j, basic);
            if names.infos[s].name.is_empty() {
                continue;
            }
            if let (true, Some(info)) = (is_shared, &names.shared[j]) {
                names.infos[s] = info.clone();
            }
            if let (Some(false), Some(info)) = (pattern[j], &names.backward[j]) {
                names.infos[s] = info.clone();
            }
            let (from, to) = if pattern[j] == Some(false) { (q, p) } else { (p, q) };
            names.infos[s].meaning = match c {
                "frame" => format!("efficiency, {from} driving {to}"),
                _ => format!("efficiency seen from {c}, {from} driving {to}"),
            };
        }
        if efficiencies == Efficiencies::Meshes {
            names.mesh_efficiencies(setup, pattern);
        }
        let spelt = |f: &RationalFunction| -> RationalFunction {
            let value = |s: Symbol| {
                let info = names.info(s);
                match info.kind {
                    SymbolKind::Ratio if ratios == Ratios::Teeth => names.details.get(&s).cloned(),
                    SymbolKind::Ratio if ratios == Ratios::Numbers => info.value.clone().map(RationalFunction::from),
                    SymbolKind::Efficiency if efficiencies == Efficiencies::Meshes => names.details.get(&s).cloned(),
                    SymbolKind::Efficiency if efficiencies == Efficiencies::Numbers => {
                        info.value.clone().map(RationalFunction::from)
                    }
                    _ => None,
                }
            };
            // Numbers may hit a pole that symbols do not have (basic ratio one); then symbols stay.
            f.substituted(&value).unwrap_or_else(|| f.clone())
        };
        let driven = self.driven(pattern);
        let torque = &driven.torque;
        let sums = Sums::default();
        let mut references: Vec<RationalFunction> =
            self.reference.iter().map(|&t| RationalFunction::symbol(names.torque(t))).collect();
        let through = setup.link.as_ref().map(|link| (link.ends, pattern[k]));
        if let Some(([a, b], forward)) = through {
            let rho = match (names.link, forward) {
                (Some([eta, _]), Some(true)) => RationalFunction::symbol(eta),
                (Some([_, eta]), Some(false)) => RationalFunction::symbol(eta).recip(),
                _ => RationalFunction::ONE,
            };
            // ρ T_a ω_a + T_b ω_b = 0 ties the second reference torque to the first.
            let factor = |r: usize| {
                let part = |t: usize| torque[t][r].times(&RationalFunction::symbol(names.speed(t)));
                sums.plus(&part(a).times(&rho), &part(b))
            };
            let factors = [factor(0), factor(1)];
            sums.are_short()?;
            references[1] = references[0].times(&factors[0]).over(&factors[1]).negated();
        }
        let d = setup.independent_torques();
        let sum_over_references =
            |factors: &[RationalFunction]| sums.of(factors.iter().zip(&references).map(|(f, t)| f.times(t)));
        let torques: Vec<RationalFunction> = torque.iter().map(|r| sum_over_references(r)).collect();
        sums.are_short()?;
        // With one freedom every speed is a multiple of the reference's.
        let one = setup.base.len() == 1 && d == 1;
        let speeds: Vec<RationalFunction> = (0..m)
            .map(|t| match one {
                true => self.speed[t][0].times(&RationalFunction::symbol(names.speed(setup.base[0]))),
                false => RationalFunction::symbol(names.speed(t)),
            })
            .collect();
        let unit = |f: &RationalFunction| -> RationalFunction {
            // Torques and, with one freedom, speeds cancel; a unit in their place shows it.
            let torque_symbol = names.torque(self.reference[0]);
            let speed_symbol = names.speed(setup.base[0]);
            let value = |s: Symbol| {
                ((d == 1 && s == torque_symbol) || (one && s == speed_symbol)).then_some(RationalFunction::ONE)
            };
            f.substituted(&value).expect("units are no poles")
        };
        let power = |t: usize| torques[t].times(&speeds[t]);
        let total = |sign: i8| sums.of((0..m).filter(|&t| roles[t] == sign).map(power));
        let output = total(-1);
        // Where nothing comes out it does not matter what goes in.
        let input = if output.is_zero() { RationalFunction::ZERO } else { total(1) };
        sums.are_short()?;
        let efficiency = if input.is_zero() { RationalFunction::ZERO } else { unit(&output.negated().over(&input)) };

        // What the link takes at one end and does not give at the other.
        let lost_on_the_way = through.and_then(|([a, b], forward)| {
            let (from, way) = if forward? { (a, 0) } else { (b, 1) };
            let eta = RationalFunction::symbol(names.link?[way]);
            Some(power(from).times(&RationalFunction::ONE.minus(&eta)).negated())
        });
        let mut conditions: Vec<Condition> = Vec::new();
        let sign = |f: RationalFunction, sign: i8| if sign > 0 { f } else { f.negated() };
        // The powers of the reference are positive by the roles.
        let reference_sign = roles[self.reference[0]];
        let normalised = |f: RationalFunction| if one { sign(unit(&f), reference_sign) } else { f };
        let mut losses: Vec<(usize, RationalFunction, RationalFunction)> = Vec::new();
        for j in 0..k {
            let Some(p_drives) = pattern[j] else { continue };
            let e = setup.element(j);
            let force = sum_over_references(&driven.force[j]);
            let sigma = match one {
                true => self.sigma[j]
                    .substituted(&|s| (0..m).find(|&t| names.speed(t) == s).map(|t| speeds[t].clone()))
                    .expect("speeds have no poles of their own"),
                false => self.sigma[j].clone(),
            };
            // f σ (1 − ρ), the force in front of the loss of a hub.
            let rho = names.rho(setup, pattern, j);
            let behind = force.times(&sigma);
            let potential = match names.hubs.in_front(j) {
                Some(hub) => behind.over(&names.rho(setup, pattern, hub)),
                None => behind,
            };
            let loss = potential.times(&RationalFunction::ONE.minus(&rho));
            // The loss of a hub may stand in the efficiencies of its arms.
            if rho != RationalFunction::ONE {
                losses.push((
                    j,
                    self.by_driver(&names, j, p_drives).filter(|_| !one && d == 1).unwrap_or(loss.clone()),
                    loss,
                ));
            }
            let driver = setup.member_name(if p_drives { e.p } else { e.q });
            conditions.push(Condition {
                function: normalised(sign(potential, if p_drives { 1 } else { -1 })),
                meaning: format!("{driver} drives in {}", element_label(setup, j)),
            });
        }
        for t in 0..m {
            if roles[t] == 0 {
                continue;
            }
            let word = if roles[t] > 0 { "input" } else { "output" };
            conditions.push(Condition {
                function: normalised(sign(power(t), roles[t])),
                meaning: format!("{} is {word}", setup.terminal_name(t)),
            });
        }
        if let Some(([a, b], Some(forward))) = through {
            let [from, to] = if forward { [a, b] } else { [b, a] };
            conditions.push(Condition {
                function: sign(power(from), -1),
                meaning: format!(
                    "power runs through {} from {} to {}",
                    setup.link_name(),
                    setup.terminal_name(from),
                    setup.terminal_name(to)
                ),
            });
        }
        for c in &mut conditions {
            c.function = bare(&spelt(&c.function), &names);
        }
        without_squares(&mut conditions);
        conditions.retain(|c| c.function.as_constant().is_none_or(|n| n.sign() <= 0));
        let mut distinct: Vec<Condition> = Vec::new();
        for c in conditions {
            match distinct.iter_mut().find(|d| d.function == c.function) {
                Some(d) => d.meaning += &format!("; {}", c.meaning),
                None => distinct.push(c),
            }
        }
        // With a single input, or a single output, the loss over its power is the shortest form.
        let lone = |sign: i8| {
            let own: Vec<usize> = (0..m).filter(|&t| roles[t] == sign).collect();
            if own.len() == 1 { Some(own[0]) } else { None }
        };
        let shares = |t: usize| -> Vec<RationalFunction> {
            let p = power(t);
            losses.iter().map(|(_, _, f)| spelt(&unit(&f.over(&p)))).collect()
        };
        let by_loss = match (lone(1), lone(-1)) {
            _ if one || setup.link.is_some() || losses.is_empty() || output.is_zero() => None,
            (Some(t), _) => Some((true, shares(t))),
            (None, Some(t)) => Some((false, shares(t).iter().map(RationalFunction::negated).collect())),
            _ => None,
        };
        let own = Formula {
            by_loss,
            efficiency: spelt(&efficiency),
            torques: torques.iter().map(&spelt).collect(),
            speeds: (0..m)
                .map(|t| {
                    let part = |b: usize| self.speed[t][b].times(&RationalFunction::symbol(names.speed(setup.base[b])));
                    spelt(&sums.of((0..setup.base.len()).map(part)))
                })
                .collect(),
            losses: (losses.iter().map(|(_, f, _)| f)).chain(&lost_on_the_way).map(spelt).collect(),
            conditions: distinct,
            names,
        };
        sums.are_short()?;
        Ok(own)
    }
}

impl Shape<'_, '_> {
    /// `(1 − η) T_driver (ω_driver − ω_c)`, where the driver is a terminal that only this element
    /// loads and the carrier's speed is a terminal's.
    fn by_driver(&self, names: &Names, j: usize, p_drives: bool) -> Option<RationalFunction> {
        let setup = self.setup;
        let e = setup.element(j);
        let driver = setup.c.node(if p_drives { e.p } else { e.q })?;
        let terminal = |node: usize| setup.terminals.iter().position(|t| t.node == node);
        let t = terminal(driver)?;
        let touched = |j: usize| {
            let e = setup.element(j);
            [e.p, e.q, e.carrier].iter().any(|m| setup.c.node(*m) == Some(driver))
        };
        if (0..setup.active.len()).any(|other| other != j && touched(other)) || setup.c.node(e.carrier) == Some(driver)
        {
            return None;
        }
        let carrier = match setup.c.node(e.carrier) {
            None => RationalFunction::ZERO,
            Some(node) => RationalFunction::symbol(names.speed(terminal(node)?)),
        };
        let relative = RationalFunction::symbol(names.speed(t)).minus(&carrier);
        let share = RationalFunction::ONE.minus(&RationalFunction::symbol(names.efficiency(j)));
        Some(share.times(&RationalFunction::symbol(names.torque(t))).times(&relative))
    }
}

impl Formula {
    /// The efficiency by its losses, `1 - (1 - eta0)*(w_1 - w_2)/w_1`, where there is such a form.
    pub fn by_loss(&self, notation: Notation) -> Option<String> {
        let (input, shares) = self.by_loss.as_ref()?;
        let mut sum = String::new();
        for f in shares {
            let text = self.names.show(notation, f);
            let (negative, text) = text.strip_prefix('-').map_or((false, text.as_str()), |rest| (true, rest));
            // 1 − Σ for an input, 1 + Σ for an output.
            sum += if negative == *input { " + " } else { " - " };
            // A share that is a bare sum needs brackets behind a minus.
            let bare = f.factors().len() == 1 && f.factors()[0].1 == 1 && f.factors()[0].0.len() > 1;
            sum += &if bare { format!("({text})") } else { text.to_owned() };
        }
        Some(match (input, notation) {
            (true, _) => format!("1{sum}"),
            (false, Notation::Latex) => format!("\\frac{{1}}{{1{sum}}}"),
            (false, _) => format!("1/(1{sum})"),
        })
    }
}

/// A condition without what is positive anyway: efficiencies, tooth numbers and squares of what is
/// not zero.
fn bare(f: &RationalFunction, names: &Names) -> RationalFunction {
    let only = |p: &Polynomial, kinds: &[SymbolKind]| p.symbols().iter().all(|s| kinds.contains(&names.info(*s).kind));
    let positive =
        |p: &Polynomial| p.terms().all(|(c, _)| c.sign() > 0) && only(p, &[SymbolKind::Efficiency, SymbolKind::Teeth]);
    let product_of_ratios = |p: &Polynomial| p.len() == 1 && only(p, &[SymbolKind::Ratio]);
    f.with_powers(Rational::from(i64::from(f.number().sign())), |p, e| match e % 2 {
        _ if positive(p) => 0,
        0 if product_of_ratios(p) => 0,
        0 => 2,
        // A denominator has the sign of its product.
        _ => 1,
    })
}

/// Conditions without squares of what other conditions keep from being zero.
fn without_squares(conditions: &mut [Condition]) {
    let nonzero: Vec<Polynomial> = conditions
        .iter()
        .flat_map(|c| c.function.factors().iter().filter(|(_, e)| *e == 1).map(|(p, _)| p.clone()))
        .collect();
    for c in conditions {
        for (p, e) in c.function.clone().factors() {
            if *e == 2 && nonzero.contains(p) {
                let own = p.to_function();
                c.function = c.function.over(&own).over(&own);
            }
        }
    }
}

/// What is not zero in each of the columns of some rows.
fn columns_of(rows: &[Vec<Polynomial>], columns: usize) -> Vec<Entries<'_>> {
    let of = |c: usize| rows.iter().enumerate().map(|(r, row)| (r, &row[c])).filter(|(_, p)| !p.is_zero()).collect();
    (0..columns).map(of).collect()
}

/// Whether rows of polynomials are independent: with the ratios of this train and without losses, or
/// judged at primes in the place of the symbols.
fn independent(rows: &[Vec<Polynomial>], setup: &Setup<'_>, names: &Names, actual: bool) -> bool {
    const PRIMES: [i64; 14] = [101, 103, 107, 109, 113, 127, 131, 137, 139, 149, 151, 157, 163, 167];
    let value = |s: Symbol| {
        let k = setup.active.len();
        let j = s.0 - names.x(0).0;
        if actual {
            names.hubs.ratio(setup, j)
        } else {
            Rational::from(PRIMES[j % PRIMES.len()] + (j / k.max(1)) as i64)
        }
    };
    let mut numbers: Vec<Vec<Rational>> = rows.iter().map(|r| r.iter().map(|p| p.evaluate(&value)).collect()).collect();
    crate::exact::reduce(&mut numbers, setup.active.len()).len() == rows.len()
}

/// Coefficient of the force of element `j` in the balance of a node, over a polynomial ratio.
fn coefficient(setup: &Setup<'_>, j: usize, node: usize, x: &Polynomial) -> Polynomial {
    let e = setup.element(j);
    let stands_here = |m: MemberId| setup.c.node(m) == Some(node);
    let mut sum = Polynomial::from(0);
    // Of a long train most elements do not touch a node.
    if ![e.p, e.q, e.carrier].into_iter().any(stands_here) {
        return sum;
    }
    let one = Polynomial::from(1);
    let minus = x.scaled(&Rational::from(-1));
    let carrier = x - &one;
    for (member, c) in [(e.p, &one), (e.q, &minus), (e.carrier, &carrier)] {
        if stands_here(member) {
            sum = &sum + c;
        }
    }
    sum
}

/// Coefficient of a node's speed in Willis' equation of an element: the same numbers.
fn kinematic(setup: &Setup<'_>, j: usize, node: usize, i: &Polynomial) -> Polynomial {
    coefficient(setup, j, node, i)
}

/// The closed formulas of one regime.
#[derive(Clone, Debug)]
pub(crate) struct Formula {
    /// Output over input power; zero when all is dissipated.
    pub efficiency: RationalFunction,
    /// Loss of each element over the power of the only input (`true`: `η = 1 − Σ`) or of the only
    /// output (`false`: `η = 1/(1 + Σ)`).
    pub by_loss: Option<(bool, Vec<RationalFunction>)>,
    /// Terminal torques over the reference torques.
    pub torques: Vec<RationalFunction>,
    /// Terminal speeds over the base speeds.
    pub speeds: Vec<RationalFunction>,
    /// Loss of each active element with a driver, and of the link.
    pub losses: Vec<RationalFunction>,
    /// Positive throughout the regime, and only there.
    pub conditions: Vec<Condition>,
    pub names: Names,
}

impl Setup<'_> {
    /// Nodes that the active elements touch.
    pub fn nodes(&self) -> Vec<usize> {
        let ends = (0..self.active.len()).flat_map(|j| {
            let e = self.element(j);
            [e.p, e.q, e.carrier].map(|m| self.c.node(m))
        });
        let mut all: Vec<usize> = ends.flatten().collect();
        all.sort_unstable();
        all.dedup();
        all
    }
}
