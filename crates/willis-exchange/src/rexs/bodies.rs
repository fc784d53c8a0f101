//! What turns together: shafts with all that sits on them, joined by couplings that are always closed.

use std::collections::HashMap;

use crate::account::{Account, At};
use crate::document::Relation;
use crate::text::{self, Taken};

/// A coupling that is closed in some gears of the gearbox and open in others.
pub struct Coupling {
    pub name: String,
    pub bodies: [usize; 2],
    /// Whether it is closed, by gear.
    pub engaged: Vec<bool>,
}

/// Components that a body is named and directed by.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kind {
    Carrier,
    Shaft,
}

/// Components that are one rigid body have one root.
pub struct Bodies {
    parent: Vec<usize>,
    /// How many components a root stands for: the smaller body joins the larger, which keeps paths short.
    size: Vec<usize>,
    by_id: HashMap<i64, usize>,
    frame: Option<usize>,
    /// Gears of the gearbox.
    pub gears: usize,
    pub couplings: Vec<Coupling>,
    /// Couplings that are closed in some gears; more than [`MOST_COUPLINGS`] are not read.
    pub switched: usize,
    names: HashMap<usize, String>,
    taken: Taken,
    /// First carrier and first shaft of each body, until another part joins.
    firsts: Option<HashMap<(usize, Kind), usize>>,
}

/// Assemblies that are no bodies themselves.
const LOOSE: &[&str] = &["gear_unit", "planetary_stage", "assembly_group"];
/// Couplings that are closed in some gears, at most.
pub const MOST_COUPLINGS: usize = 200;
/// Gears of a gearbox at most.
const MOST_GEARS: i64 = 200;

impl Bodies {
    pub fn new(account: &mut Account<'_>) -> Self {
        let components = &account.document.components;
        let mut by_id = HashMap::new();
        for (k, c) in components.iter().enumerate() {
            if *by_id.entry(c.id).or_insert(k) != k {
                let message = "another component has this number; references mean the first";
                account.problem(account.called(At::model(k)), message);
            }
        }
        let parent = (0..components.len()).collect();
        let mut bodies = Self {
            parent,
            size: vec![1; components.len()],
            by_id,
            frame: None,
            gears: 1,
            couplings: vec![],
            names: HashMap::new(),
            taken: Taken::with("frame"),
            firsts: None,
            switched: 0,
        };
        bodies.join(account);
        bodies
    }

    fn join(&mut self, account: &mut Account<'_>) {
        let components = &account.document.components;
        for relation in &account.document.relations {
            for (role, id) in &relation.refs {
                if !self.by_id.contains_key(id) {
                    let place = format!("relation {} ({})", relation.id, relation.kind);
                    account.problem(place, format!("component {id} ({role}) is not in the file"));
                }
            }
        }
        let casings = |k: &usize| components[*k].kind == "gear_casing";
        let mut housing = (0..components.len()).filter(casings);
        self.frame = housing.next();
        if let Some(first) = self.frame {
            housing.for_each(|other| self.unite(first, other));
        }
        for relation in &account.document.relations {
            if relation.kind == "assembly"
                && let (Some(whole), Some(part)) = (self.of(relation, "assembly"), self.of(relation, "part"))
            {
                let kind = components[whole].kind.as_str();
                if !LOOSE.contains(&kind) && !kind.ends_with("_stage") {
                    self.unite(whole, part);
                }
            }
        }
        let gears = account
            .unit
            .map(At::model)
            .and_then(|at| account.integer(at, "number_of_gears", "states of the shift table"));
        self.gears = gears.unwrap_or(1).clamp(1, MOST_GEARS) as usize;
        let mut switched = vec![];
        for relation in &account.document.relations {
            let Some(coupling) = self.of(relation, "assembly").filter(|_| relation.kind == "side") else { continue };
            let kind = components[coupling].kind.as_str();
            if !["coupling", "switchable_coupling"].contains(&kind) {
                continue;
            }
            let ends = self.of(relation, "inner_part").zip(self.of(relation, "outer_part"));
            let Some((inner, outer)) = ends else {
                account.problem(account.called(At::model(coupling)), "it joins only one part and is left out");
                continue;
            };
            if kind == "coupling" {
                self.unite(inner, outer);
                continue;
            }
            let what = "whether the coupling is closed";
            let closed = account.flags(At::model(coupling), "is_engaged", what);
            let closed = match closed {
                Some(all) if all.len() == self.gears => all,
                Some(all) if all.len() == 1 => vec![all[0]; self.gears],
                Some(all) => {
                    let message =
                        format!("is_engaged has {} values for {} gears; it is left out", all.len(), self.gears);
                    account.problem(account.called(At::model(coupling)), message);
                    continue;
                }
                None => {
                    account.guess(account.called(At::model(coupling)), "closed", "the file does not say whether it is");
                    vec![true; self.gears]
                }
            };
            if closed.iter().all(|c| *c) {
                self.unite(inner, outer);
            } else if closed.iter().any(|c| *c) {
                switched.push((coupling, [inner, outer], closed));
            }
        }
        self.switched = switched.len();
        let mut taken = Taken::default();
        for (coupling, [a, b], engaged) in switched.into_iter().take(MOST_COUPLINGS) {
            let bodies = [self.root(a), self.root(b)];
            if bodies[0] == bodies[1] {
                let message = "it joins parts that are joined anyway and is left out";
                account.problem(account.called(At::model(coupling)), message);
                continue;
            }
            let c = &components[coupling];
            let name = text::name(without_number(&c.name), &format!("coupling {}", c.id), &mut taken);
            self.couplings.push(Coupling { name, bodies, engaged });
        }
    }

    fn unite(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        if a == b {
            return;
        }
        let (large, small) = if self.size[a] >= self.size[b] { (a, b) } else { (b, a) };
        self.firsts = None;
        self.parent[small] = large;
        self.size[large] += self.size[small];
    }

    /// The body of a component.
    pub fn root(&self, mut k: usize) -> usize {
        while self.parent[k] != k {
            k = self.parent[k];
        }
        k
    }

    pub fn is_frame(&self, root: usize) -> bool {
        self.frame.is_some_and(|f| self.root(f) == root)
    }

    /// Joins what a file forgets to join.
    pub fn join_also(&mut self, a: usize, b: usize) {
        self.unite(a, b);
        for k in 0..self.couplings.len() {
            self.couplings[k].bodies = self.couplings[k].bodies.map(|b| self.root(b));
        }
    }

    /// The component that has a role in a relation.
    pub fn of(&self, relation: &Relation, role: &str) -> Option<usize> {
        let (_, id) = relation.refs.iter().find(|(r, _)| r == role)?;
        self.by_id.get(id).copied()
    }

    /// The first component of that type in a body.
    pub fn first(&mut self, account: &Account<'_>, root: usize, kind: Kind) -> Option<usize> {
        let firsts = self.firsts.take().unwrap_or_else(|| {
            let mut firsts = HashMap::new();
            for (k, c) in account.document.components.iter().enumerate() {
                let kind = match c.kind.as_str() {
                    "planet_carrier" => Kind::Carrier,
                    "shaft" => Kind::Shaft,
                    _ => continue,
                };
                firsts.entry((self.root(k), kind)).or_insert(k);
            }
            firsts
        });
        let found = firsts.get(&(root, kind)).copied();
        self.firsts = Some(firsts);
        found
    }

    /// The name of the member that a body becomes.
    pub fn name(&mut self, account: &Account<'_>, root: usize) -> String {
        if self.is_frame(root) {
            return "frame".into();
        }
        if let Some(name) = self.names.get(&root) {
            return name.clone();
        }
        let best = [Kind::Carrier, Kind::Shaft].into_iter().find_map(|kind| self.first(account, root, kind));
        let c = &account.document.components[best.unwrap_or(root)];
        let name = text::name(without_number(&c.name), &format!("{} {}", c.kind, c.id), &mut self.taken);
        self.names.insert(root, name.clone());
        name
    }
}

/// A name without the number in brackets that some programs write behind it.
pub fn without_number(name: &str) -> &str {
    let name = name.trim();
    let number = name.strip_suffix(']').and_then(|rest| rest.rsplit_once('['));
    match number {
        Some((before, n)) if !before.trim().is_empty() && !n.is_empty() && n.bytes().all(|b| b.is_ascii_digit()) => {
            before.trim()
        }
        _ => name,
    }
}
