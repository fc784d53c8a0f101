//! Every equilibrium under one load where no certificate says that there is one.
//!
//! Blocks are solved in their order: what the forces of one leave of the load is the load of the next. A block that is
//! certified has one set of forces; in any other all choices of drivers are tried, and each equilibrium loads what follows
//! by itself. So the work grows with the largest block and with the number of equilibria, not with the length of the train.
//!
//! A choice whose equations are regular has one set of forces; it is an equilibrium if their signs are those of the
//! choice. One whose equations are singular (a load exactly on a self-locking threshold) has none, one, or a whole range:
//! its forces, and all that they load, are the polyhedron `B(ρ) f = t` with the signs of the choice, which is asked as such.
//! An idle element fits either choice, so solutions are told apart by their forces alone.

use crate::exact::blocks::Block;
use crate::exact::{Polyhedron, Rational};
use crate::kinematics::Configuration;

use super::{Answer, Certificate, Equilibrium, MOST_ENUMERATED, Solution, Trial};

/// Most choices of drivers that are tried for one load: those of [`MOST_ENUMERATED`] elements, with what leads to them.
const MOST_CHOICES: usize = 2 << MOST_ENUMERATED;
/// Most equilibria that are followed, times the square of the number of elements: each is told with all of them, and compared
/// with all others.
const MOST_FOLLOWED: usize = 1 << 20;
/// How many choices the exact forces of a block count for that has more than [`MOST_ENUMERATED`] equations; times the cube of how
/// many times as many it has.
const EXACT_FORCES: usize = 1024;

/// Equilibria that form a whole range.
#[derive(Clone, Debug)]
pub(crate) struct Stretch {
    /// One of them: its drivers are those of all, where a force is not zero.
    pub solution: Solution,
    /// Forces that are the same in all of them.
    settled: Vec<Option<Rational>>,
    others: Polyhedron,
    parts: Vec<Part>,
}

/// An unknown that is not negative, as a part of a force: the column, and its sign.
#[derive(Clone, Copy, Debug)]
struct Part {
    column: usize,
    sign: i8,
}

impl Stretch {
    /// Smallest and largest value of a sum over the forces of the columns; none where it grows without end.
    fn range(&self, of: &dyn Fn(usize) -> Rational) -> [Option<Rational>; 2] {
        let settled = self.settled.iter().enumerate().filter_map(|(column, force)| Some(of(column) * force.clone()?));
        let settled = settled.fold(Rational::ZERO, |sum, x| sum + x);
        let up: Vec<Rational> = self.parts.iter().map(|p| of(p.column) * Rational::from(i64::from(p.sign))).collect();
        let down: Vec<Rational> = up.iter().map(|x| -x).collect();
        let mut others = self.others.clone();
        [others.maximum(&down).map(|x| &settled - &x), others.maximum(&up).map(|x| &settled + &x)]
    }
}

/// What is decided of an equilibrium when some of the blocks are solved.
#[derive(Clone)]
struct Branch {
    /// Which end drives, by column; the first one where none does.
    pattern: Vec<bool>,
    /// Forces that follow from the load.
    settled: Vec<Option<Rational>>,
    /// What they leave of the load.
    left: Vec<Rational>,
    /// Rows and columns of the forces that do not, in the order of the blocks: they form a range.
    open: Block,
    /// Whether each row has one of them in it.
    touched: Vec<bool>,
    /// Whether there is a load at all.
    acts: bool,
}

impl Equilibrium {
    /// Goes through the blocks.
    pub(super) fn enumerate(&self, t: &[Rational]) -> Answer {
        let n = self.columns.len();
        let start = Branch {
            pattern: vec![true; n],
            settled: vec![None; n],
            left: t.to_vec(),
            open: Block::default(),
            touched: vec![false; n],
            acts: t.iter().any(|x| !x.is_zero()),
        };
        let (mut branches, mut choices) = (vec![start], MOST_CHOICES);
        for (block, part) in self.blocks.iter().zip(&self.parts) {
            let mut next = Vec::new();
            for branch in branches {
                let followed = self.follow(block, part, branch, &mut choices, &mut next);
                if followed.is_none() || next.len() * n * n > MOST_FOLLOWED {
                    // What was not looked at may have equilibria of its own.
                    return Answer { solutions: vec![], certificate: Certificate::Undecided, stretches: vec![] };
                }
            }
            branches = next;
        }
        // In the order in which all choices for the whole train would be counted.
        branches.sort_by_cached_key(|b| b.pattern.iter().rev().map(|p| !p).collect::<Vec<bool>>());
        let mut solutions: Vec<Solution> = Vec::new();
        let mut stretches: Vec<Stretch> = Vec::new();
        let add = |found: Solution, solutions: &mut Vec<Solution>| {
            if solutions.iter().all(|s| s.exact != found.exact) {
                solutions.push(found);
            }
        };
        for branch in branches {
            if branch.open.columns.is_empty() {
                let forces = branch.settled.into_iter().map(|force| force.expect("solved")).collect();
                add(self.of_forces(forces, branch.pattern), &mut solutions);
                continue;
            }
            let (others, parts) = self.polyhedron(&branch).expect("it was seen not to be empty");
            let (ends, _) = self.ends(&branch.settled, &others, &parts);
            let mut found = ends.into_iter().map(|end| self.of_forces(end, branch.pattern.clone()));
            let solution = found.next().expect("a point");
            add(solution.clone(), &mut solutions);
            found.for_each(|end| add(end, &mut solutions));
            stretches.push(Stretch { solution, settled: branch.settled, others, parts });
        }
        Answer { solutions, certificate: self.certificate, stretches }
    }

    /// Adds what becomes of a branch in one more block; `part` is that block as a problem of its own. `None` where that takes
    /// more `choices` than are left.
    fn follow(
        &self,
        block: &Block,
        part: &Self,
        branch: Branch,
        choices: &mut usize,
        next: &mut Vec<Branch>,
    ) -> Option<()> {
        let t: Vec<Rational> = block.rows.iter().map(|&row| branch.left[row].clone()).collect();
        let t_float: Vec<f64> = t.iter().map(Rational::to_f64).collect();
        let is_settled = !block.rows.iter().any(|&row| branch.touched[row]);
        let first = next.len();
        let exact_forces = EXACT_FORCES * (block.rows.len() / (MOST_ENUMERATED + 1)).pow(3);
        if is_settled && part.certificate.unique_for_every_load() {
            *choices = choices.checked_sub(1 + exact_forces)?;
            let mut pattern = part.pivot(&t, &t_float)?.pattern;
            (0..pattern.len()).filter(|&k| !part.is_moving(k)).for_each(|k| pattern[k] = true);
            next.push(self.settle(block, part, branch, pattern, &t));
            return Some(());
        }
        let moving: Vec<usize> = (0..block.columns.len()).filter(|&k| part.is_moving(k)).collect();
        let tried = (moving.len() <= MOST_ENUMERATED).then(|| 1usize << moving.len())?;
        *choices = choices.checked_sub(tried)?;
        // An idle element fits either choice.
        let add = |found: Branch, next: &mut Vec<Branch>| {
            let is_like = |b: &Branch| b.open.columns.is_empty() && b.settled == found.settled;
            if !found.open.columns.is_empty() || !next[first..].iter().any(is_like) {
                next.push(found);
            }
        };
        for mask in 0..tried {
            let mut pattern = vec![true; block.columns.len()];
            moving.iter().enumerate().for_each(|(bit, &k)| pattern[k] = mask >> bit & 1 == 0);
            let choice: Vec<_> = pattern.iter().map(|p| Some(*p)).collect();
            let trial = if is_settled { part.attempt(&choice, &t, &t_float) } else { None };
            match trial {
                Some(trial) if part.wrong(&trial, &pattern, 0).is_none() => {
                    *choices = choices.checked_sub(exact_forces)?;
                    add(self.settle(block, part, branch.clone(), pattern, &t), next);
                }
                Some(_) => {}
                // Where nothing acts the train may be wedged within itself; that is no answer to a load.
                None if branch.acts => {
                    let mut found = branch.clone();
                    found.open.rows.extend(&block.rows);
                    found.open.columns.extend(&block.columns);
                    for (&j, p) in block.columns.iter().zip(&pattern) {
                        found.pattern[j] = *p;
                        self.columns[j].entries.iter().for_each(|(row, ..)| found.touched[*row] = true);
                    }
                    // Many at once take long.
                    let many = if self.moving() > MOST_ENUMERATED { found.open.rows.len() / 4 } else { 0 };
                    *choices = choices.checked_sub(many.pow(3))?;
                    if let Some((others, parts)) = self.polyhedron(&found) {
                        let (ends, is_range) = self.ends(&found.settled, &others, &parts);
                        let found = if is_range { found } else { self.settle_open(found, &ends[0]) };
                        add(found, next);
                    }
                }
                None => {}
            }
        }
        Some(())
    }

    /// The branch that goes on with the forces of one choice of drivers in a block, which are certain.
    fn settle(&self, block: &Block, part: &Self, mut branch: Branch, pattern: Vec<bool>, t: &[Rational]) -> Branch {
        let choice: Vec<_> = pattern.iter().map(|p| Some(*p)).collect();
        let forces = part.exact_forces(&choice, t).expect("regular");
        for ((&j, force), p) in block.columns.iter().zip(forces).zip(pattern) {
            // Where it is certain that the equations are regular, an idle element fits either choice.
            branch.pattern[j] = p || (force.is_zero() && part.certificate.unique_for_every_load());
            self.load(&mut branch, j, force);
        }
        branch
    }

    /// The branch in which nothing is open, with the only forces that there are.
    fn settle_open(&self, mut branch: Branch, forces: &[Rational]) -> Branch {
        for j in std::mem::take(&mut branch.open).columns {
            self.load(&mut branch, j, forces[j].clone());
        }
        branch.touched.fill(false);
        branch
    }

    /// Settles a force, which loads what follows.
    fn load(&self, branch: &mut Branch, j: usize, force: Rational) {
        if !force.is_zero() {
            let rho = self.rho_exact(j, Some(branch.pattern[j]));
            for (row, constant, slope) in &self.columns[j].entries {
                branch.left[*row] -= &(constant + &(slope * &rho)) * &force;
            }
        }
        branch.settled[j] = Some(force);
    }

    /// The forces that are not settled; none if there are none.
    fn polyhedron(&self, branch: &Branch) -> Option<(Polyhedron, Vec<Part>)> {
        let mut parts = Vec::new();
        let mut columns = branch.open.columns.clone();
        columns.sort_unstable();
        for &column in &columns {
            let drives = self.columns[column].sigma * if branch.pattern[column] { 1 } else { -1 };
            let signs: &[i8] = if self.is_moving(column) { &[drives] } else { &[1, -1] };
            parts.extend(signs.iter().map(|&sign| Part { column, sign }));
        }
        let mut open = branch.open.rows.clone();
        open.sort_unstable();
        let mut row_in = vec![None; self.rows.len()];
        open.iter().enumerate().for_each(|(k, &row)| row_in[row] = Some(k));
        let mut rows = vec![vec![Rational::ZERO; parts.len() + 1]; open.len()];
        for (k, part) in parts.iter().enumerate() {
            let rho = self.rho_exact(part.column, Some(branch.pattern[part.column]));
            for (row, constant, slope) in &self.columns[part.column].entries {
                if let Some(row) = row_in[*row] {
                    let own = constant + &(slope * &rho);
                    rows[row][k] = if part.sign > 0 { own } else { -own };
                }
            }
        }
        for (row, &of) in rows.iter_mut().zip(&open) {
            row[parts.len()] = branch.left[of].clone();
        }
        Some((Polyhedron::new(rows, parts.len())?, parts))
    }

    /// A vertex, the vertices at which some force is least or largest, and whether there is more than one point.
    fn ends(&self, settled: &[Option<Rational>], others: &Polyhedron, parts: &[Part]) -> (Vec<Vec<Rational>>, bool) {
        let forces = |p: &Polyhedron| {
            let mut forces: Vec<Rational> =
                settled.iter().map(|force| force.clone().unwrap_or(Rational::ZERO)).collect();
            for (x, part) in p.point(parts.len()).iter().zip(parts) {
                if part.sign > 0 { forces[part.column] += x.clone() } else { forces[part.column] -= x.clone() }
            }
            forces
        };
        let first = forces(others);
        let (mut ends, mut is_range) = (vec![first.clone()], false);
        let open = (0..first.len()).filter(|&column| parts.iter().any(|part| part.column == column));
        for (column, way) in open.flat_map(|column| [(column, 1), (column, -1)]) {
            let one = |part: &Part| {
                if part.column == column { Rational::from(i64::from(part.sign) * way) } else { Rational::ZERO }
            };
            let of: Vec<Rational> = parts.iter().map(one).collect();
            let mut p = others.clone();
            match p.maximum(&of) {
                Some(most) if most == &first[column] * &Rational::from(way) => {}
                Some(_) => {
                    is_range = true;
                    let end = forces(&p);
                    if !ends.contains(&end) {
                        ends.push(end);
                    }
                }
                None => is_range = true,
            }
        }
        (ends, is_range)
    }

    fn of_forces(&self, exact: Vec<Rational>, pattern: Vec<bool>) -> Solution {
        let signs = exact.iter().map(Rational::sign).collect();
        let forces: Vec<f64> = exact.iter().map(Rational::to_f64).collect();
        self.solution(Trial { bounds: super::rounding(&forces), forces, signs, exact: Some(exact) }, pattern)
    }

    /// The range of an external torque over a stretch, in the unit of its load; none where it has no end.
    pub(crate) fn torque_range(&self, c: &Configuration<'_>, stretch: &Stretch, node: usize) -> [Option<Rational>; 2] {
        stretch.range(&|column| {
            let element = self.columns[column].element;
            super::coefficient(c, element, &self.rho_of(&stretch.solution, element), node)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::train::Train;
    use crate::units::AngularSpeed;

    /// Numbers by chance, the same in every run.
    struct Chance(u64);

    impl Chance {
        fn below(&mut self, n: usize) -> usize {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 33) as usize % n
        }
    }

    /// One stage between two shafts, by its kind. Those beyond the first may lock, or have several equilibria; with teeth and
    /// losses by chance they seldom stand on a threshold, with those of kinds 2 and 3 always.
    fn stage(k: usize, kind: usize, chance: &mut Chance) -> String {
        let [from, to, between] = [format!("s{k}"), format!("s{}", k + 1), format!("x{k}")];
        let simple = |name: &str, sun: &str, ring: &str, carrier: &str, chance: &mut Chance| {
            format!(
                "[[set]]\nname = \"{name}{k}\"\ntype = \"simple\"\nsun = {{ member = \"{sun}\", teeth = {} }}\n\
                 ring = {{ member = \"{ring}\", teeth = {} }}\ncarrier = \"{carrier}\"\nbasic_efficiency = {}\n",
                20 + chance.below(10),
                60 + chance.below(30),
                [0.99, 0.97, 0.9][chance.below(3)]
            )
        };
        let stepped = |suns: [(&str, usize, usize); 2], carrier: &str, efficiency: f64| {
            let [first, second] = suns.map(|(member, teeth, planet)| {
                format!("{{ member = \"{member}\", teeth = {teeth}, planet_teeth = {planet} }}")
            });
            format!(
                "[[set]]\nname = \"B{k}\"\ntype = \"stepped\"\nsuns = [ {first}, {second} ]\ncarrier = \"{carrier}\"\n\
                 basic_efficiency = {efficiency}\n"
            )
        };
        match kind {
            0 => simple("A", &from, "frame", &to, chance),
            1 => stepped([("frame", 50, 20), (&to, 51, 20 + chance.below(3))], &from, 0.9),
            2 => stepped([("frame", 18, 20), (&to, 20, 20)], &from, 0.9),
            3 => stepped([("frame", 20, 20), (&to, 18, 20)], &from, 0.9),
            _ => simple("C", &from, &to, &between, chance) + &simple("D", &from, &between, &to, chance),
        }
    }

    /// Stages in series, and the names of the shafts.
    fn series(kinds: &[usize], chance: &mut Chance) -> (Train, Vec<String>) {
        let shafts: Vec<String> = (0..=kinds.len()).map(|k| format!("s{k}")).collect();
        let inner = kinds.iter().enumerate().filter(|(_, kind)| **kind > 3).map(|(k, _)| format!("x{k}"));
        let quoted = |names: Vec<String>| format!("{names:?}");
        let stages: String = kinds.iter().enumerate().map(|(k, kind)| stage(k, *kind, chance)).collect();
        let text = format!(
            "format = 1\nname = \"series\"\nmembers = {}\nterminals = {}\n{stages}",
            quoted(shafts.iter().cloned().chain(inner).collect()),
            quoted(shafts.clone())
        );
        (Train::from_toml(&text).unwrap(), shafts)
    }

    /// The problem with every terminal loaded but one, which turns one way.
    fn problem(train: &Train, shafts: &[String], open: usize) -> Option<(Vec<usize>, usize, Equilibrium)> {
        let c = Configuration::new(train, &[], &[], &[]);
        let of = |name: &String| train.member(name).unwrap();
        let motion = c.motion(&[(of(&shafts[open]), AngularSpeed::rpm(1.0).0)]).unwrap();
        let sigma: Vec<_> = c.elements.iter().map(|e| c.sigma(e, &motion)).collect();
        let nodes: Vec<usize> = shafts.iter().map(|s| c.node(of(s)).unwrap()).collect();
        let loaded: Vec<usize> = nodes.iter().copied().filter(|n| *n != nodes[open]).collect();
        let equilibrium = Equilibrium::new(&c, &sigma, &[nodes[open]], &loaded).ok()?;
        Some((nodes, c.nodes, equilibrium))
    }

    #[test]
    fn block_by_block_finds_what_is_found_at_once() {
        let mut chance = Chance(5);
        let (mut compared, mut several, mut none, mut ranges) = (0, 0, 0, 0);
        for _ in 0..2000 {
            let kinds: Vec<usize> = (0..2 + chance.below(4)).map(|_| chance.below(6)).collect();
            let (train, shafts) = series(&kinds, &mut chance);
            let open = chance.below(shafts.len());
            let Some((nodes, count, blocks)) = problem(&train, &shafts, open) else { continue };
            if blocks.certificate != Certificate::Enumeration || blocks.blocks.len() < 2 {
                continue;
            }
            let n = blocks.columns.len();
            let all = Block { rows: (0..n).collect(), columns: (0..n).collect() };
            // One part, which is the whole.
            let certificate = Certificate::Enumeration;
            let whole = Equilibrium { blocks: vec![all.clone()], groups: vec![all], ..blocks.clone() };
            let whole = Equilibrium { parts: vec![Equilibrium { certificate, ..whole.clone() }], ..whole };
            let mut loads = vec![Rational::ZERO; count];
            for node in nodes {
                // Some have no load of their own.
                loads[node] = Rational::from([0, 0, 1, -1, 3][chance.below(5)]);
            }
            let [a, b] = [&blocks, &whole].map(|e| e.solve(&loads));
            let of = |answer: &Answer| -> Vec<(Option<Vec<Rational>>, Vec<bool>)> {
                answer.solutions.iter().map(|s| (s.exact.clone(), s.pattern.clone())).collect()
            };
            assert_eq!((a.certificate, b.certificate), (Certificate::Enumeration, Certificate::Enumeration));
            if b.stretches.is_empty() {
                assert_eq!(of(&a), of(&b), "{kinds:?} {open}");
            }
            // An idle element may make several of one stretch: each is compared with all.
            let c = Configuration::new(&train, &[], &[], &[]);
            let open = c.node(train.member(&shafts[open]).unwrap()).unwrap();
            let told = |e: &Equilibrium, answer: &Answer| {
                let mut all: Vec<_> = answer.stretches.iter().map(|s| e.torque_range(&c, s, open)).collect();
                all.sort();
                all.dedup();
                all
            };
            assert_eq!(told(&blocks, &a), told(&whole, &b), "{kinds:?}");
            assert!(
                a.solutions.iter().all(|s| b.solutions.iter().any(|o| o.exact == s.exact)) || !b.stretches.is_empty()
            );
            compared += 1;
            several += usize::from(a.solutions.len() > 1);
            none += usize::from(a.solutions.is_empty());
            ranges += usize::from(!a.stretches.is_empty());
        }
        assert!(compared > 1000 && several > 100 && none > 300 && ranges > 100, "{compared} {several} {none} {ranges}");
    }

    #[test]
    fn a_long_train_is_decided_by_its_stages() {
        let mut chance = Chance(7);
        // A stage with two equilibria, or none, among fifty that have one.
        let mut kinds = vec![0; 50];
        kinds[30] = 1;
        let (train, shafts) = series(&kinds, &mut chance);
        let (nodes, count, equilibrium) = problem(&train, &shafts, 50).unwrap();
        assert_eq!(equilibrium.certificate, Certificate::Enumeration);
        let mut numbers = Vec::new();
        for sign in [1, -1] {
            let mut loads = vec![Rational::ZERO; count];
            loads[nodes[0]] = Rational::from(sign);
            let answer = equilibrium.solve(&loads);
            assert_eq!(answer.certificate, Certificate::Enumeration);
            numbers.push(answer.solutions.len());
        }
        numbers.sort_unstable();
        assert_eq!(numbers, [0, 2]);
    }
}
