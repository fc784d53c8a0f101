//! Every equilibrium of an operating point; where laws compute losses, brought into agreement with its torques.

use crate::exact::Rational;
use crate::kinematics::{Configuration, Motion};
use crate::operating_point::{Approach, Convergence, Physics, Step};
use crate::power_flow::{Drag, Flow, Known};
use crate::statics::{Answer, Certificate, Equilibrium, Solution, Stretch, Unsolvable};
use crate::train::{MemberId, Operation};

use super::TorqueRange;
use super::loads::Loads;
use super::rounds::{Agreed, Rounds};
use super::words::{Refusal, name_of};

/// What all rounds of an operating point have in common.
pub(super) struct Setting<'a> {
    pub c: &'a Configuration<'a>,
    pub motion: &'a Motion,
    pub operation: &'a Operation,
    pub sigma: &'a [Option<i8>],
}

/// One equilibrium with everything it was solved from.
pub(super) struct Branch<'a> {
    pub c: Configuration<'a>,
    pub problem: Loads,
    pub equilibrium: Equilibrium,
    pub solution: Solution,
    pub drags: Vec<Drag>,
    pub computed: Option<(Step, Convergence)>,
    /// Its numbers, where they were found in floating point: exact ones only decide.
    pub agreed: Option<Agreed>,
}

/// Every equilibrium of an operating point.
pub(super) struct Balance<'a> {
    pub branches: Vec<Branch<'a>>,
    pub certificate: Certificate,
    pub continuum: bool,
    /// Over which torques on the terminals that balance it goes, as far as that is known.
    pub ranges: Vec<TorqueRange>,
    /// Where drags act: whether a load is driven without them.
    pub driven: Option<bool>,
}

/// A train with the losses of one step, solved.
struct Solved<'a> {
    c: Configuration<'a>,
    problem: Loads,
    equilibrium: Equilibrium,
    answer: Answer,
}

/// Losses in agreement with the torques of an equilibrium: the losses, the train with them, the equilibrium's position, how
/// well they agree, and the numbers that were found in floating point.
type Agreement<'a> = (Step, Solved<'a>, usize, Convergence, Option<Agreed>);

impl<'a> Setting<'a> {
    /// Solves with the losses of a step; `Err` where the loads make no question.
    fn solve(&self, step: &Step, drags: &[Drag]) -> Result<Option<Solved<'a>>, Vec<Refusal>> {
        let c = step.configure(self.c);
        let problem = Loads::new(&c, self.operation, self.motion, drags)?;
        let equilibrium = match Equilibrium::new(&c, self.sigma, &problem.open, &problem.loaded) {
            Ok(equilibrium) => equilibrium,
            // A drag acts on a part that no torque held or balanced before.
            Err(Unsolvable::MissingLoads(n)) => return Err(problem.missing(&c, n)),
            Err(Unsolvable::TooManyLoads(n)) => return Err(problem.too_many(&c, n)),
            Err(_) => return Ok(None),
        };
        let mut answer = equilibrium.solve(&problem.torques);
        if step.is_locked() {
            // Whatever the torques are: the gear that drives here cannot.
            answer.solutions.clear();
            answer.stretches.clear();
        }
        Ok(Some(Solved { c, problem, equilibrium, answer }))
    }

    fn flow(&self, s: &Solved<'_>, solution: &Solution, drags: &[Drag]) -> Flow {
        let acting = s.problem.acting(&s.c, self.motion, &s.equilibrium, solution);
        Flow::new(&s.c, self.motion, solution, s.problem.scale(), &acting, drags, &s.problem.driven)
    }

    /// Every equilibrium: with the efficiencies of the train, or with losses that laws compute.
    pub fn balance(
        &self,
        problem: &Loads,
        equilibrium: Equilibrium,
        physics: Option<&Physics<'_>>,
    ) -> Result<Balance<'a>, Vec<Refusal>> {
        if let Some(physics) = physics {
            return self.agreed(physics, problem);
        }
        let answer = equilibrium.solve(&problem.torques);
        let ranges = answer.stretches.iter().flat_map(|stretch| self.ranges(problem, &equilibrium, stretch)).collect();
        let branch = |solution| Branch {
            c: self.c.clone(),
            problem: problem.clone(),
            equilibrium: equilibrium.clone(),
            solution,
            drags: vec![],
            computed: None,
            agreed: None,
        };
        Ok(Balance {
            branches: answer.solutions.into_iter().map(branch).collect(),
            certificate: answer.certificate,
            continuum: !answer.stretches.is_empty(),
            ranges,
            driven: None,
        })
    }

    /// The torques of the terminals that balance a load over a whole range of equilibria.
    fn ranges(&self, problem: &Loads, equilibrium: &Equilibrium, stretch: &Stretch) -> Vec<TorqueRange> {
        let range = |m: MemberId| {
            let node = self.c.node(m)?;
            let [low, high] = equilibrium.torque_range(self.c, stretch, node);
            let n_m = |t: Option<Rational>| t.map(|t| (&t - &problem.torques[node]).to_f64() * problem.scale());
            let (low_n_m, high_n_m) = (n_m(low), n_m(high));
            let member = name_of(self.c.train, m);
            (low_n_m.is_none() || low_n_m != high_n_m).then_some(TorqueRange { member, low_n_m, high_n_m })
        };
        problem.balancing().filter_map(range).collect()
    }

    /// Brings torques and losses into agreement from one equilibrium of `second`, where losses are those of `start`; `None`
    /// where friction locks the train on the way.
    ///
    /// As long as the same ends drive, every round is one of floating point; the losses that it comes to are solved exactly,
    /// which decides whether the same ends drive there. Where they do not, every round is exact.
    fn agreement(
        &self,
        physics: &Physics<'_>,
        problem: &Loads,
        start: &Step,
        second: &Solved<'a>,
        solution: usize,
    ) -> Result<Option<Agreement<'a>>, Vec<Refusal>> {
        let (rows, columns) = second.equilibrium.solved(&second.answer.solutions[solution]);
        let known = Known { c: self.c, rows: &rows, columns: &columns };
        let rounds = Rounds::new(known, self.motion, self.operation, self.sigma, problem);
        if let Some(agreed) = rounds.as_ref().and_then(|rounds| rounds.agree(physics, self.motion))
            && let Some(solved) = self.solve(&agreed.step, &agreed.step.drags)?
        {
            let drivers = |flow: &Flow| flow.meshes.iter().map(|m| m.driver).collect::<Vec<_>>();
            let same = |s: &Solution| drivers(&self.flow(&solved, s, &agreed.step.drags)) == drivers(&agreed.flow);
            if let Some(at) = solved.answer.solutions.iter().position(same) {
                return Ok(Some((agreed.step.clone(), solved, at, agreed.convergence, Some(agreed))));
            }
        }
        let from = Approach::new(start.clone());
        let from = match &rounds {
            Some(rounds) => physics.approach(self.motion, from, |step| rounds.flow(step)),
            None => from,
        };
        let mut drivers = second.answer.solutions[solution].driver.clone();
        let mut failed = None;
        let agreed = physics.agree(self.motion, from, |step| {
            let solved = match self.solve(step, &step.drags) {
                Ok(solved) => solved?,
                Err(wrong) => {
                    failed = Some(wrong);
                    return None;
                }
            };
            let all = &solved.answer.solutions;
            // The equilibrium in which the same ends drive, or most of them; none where it locks.
            let alike = |s: &Solution| s.driver.iter().zip(&drivers).filter(|(a, b)| a == b).count();
            let at = (0..all.len()).max_by_key(|&k| (alike(&all[k]), std::cmp::Reverse(k)))?;
            drivers = all[at].driver.clone();
            let flow = self.flow(&solved, &all[at], &step.drags);
            Some(((solved, at), flow))
        });
        match failed {
            Some(wrong) => Err(wrong),
            None => Ok(agreed.map(|(step, (solved, at), _, convergence)| (step, solved, at, convergence, None))),
        }
    }

    /// Brings torques and computed losses into agreement, for every equilibrium.
    fn agreed(&self, physics: &Physics<'_>, problem: &Loads) -> Result<Balance<'a>, Vec<Refusal>> {
        let nothing = |certificate| Balance {
            branches: vec![],
            certificate,
            continuum: false,
            ranges: vec![],
            driven: Some(false),
        };
        // The forces of the train without computed losses are the start.
        let lossless = Step::lossless(self.c.train);
        let Some(first) = self.solve(&lossless, &[])? else { return Ok(nothing(Certificate::Undecided)) };
        let start = match first.answer.solutions.first() {
            Some(solution) => {
                let flow = self.flow(&first, solution, &[]);
                physics.step(&flow, self.motion, &physics.idle(&flow, self.motion))
            }
            None => lossless,
        };
        let Some(second) = self.solve(&start, &start.drags)? else { return Ok(nothing(Certificate::Undecided)) };
        let mut certificate = second.answer.certificate;
        let mut branches: Vec<Branch<'a>> = Vec::new();
        let mut continuum = false;
        let mut driven = None;
        for k in 0..second.answer.solutions.len() {
            let Some((step, solved, at, convergence, agreed)) = self.agreement(physics, problem, &start, &second, k)?
            else {
                continue;
            };
            let Solved { c, problem, equilibrium, answer } = solved;
            if answer.certificate != certificate && !answer.certificate.unique_for_every_load() {
                certificate = answer.certificate;
            }
            continuum |= !answer.stretches.is_empty();
            let solution = answer.solutions[at].clone();
            if branches.iter().any(|b| b.solution.driver == solution.driver) {
                continue;
            }
            // Whether a load would be driven without the drags: only then do the teeth not lock it.
            let free = self.solve(&step, &[])?;
            let drives = free.is_some_and(|s| {
                s.problem.are_none()
                    || s.answer.solutions.iter().any(|x| {
                        let flow = self.flow(&s, x, &[]);
                        // At rest no power runs at all.
                        flow.output_power > 0.0 || flow.input_power <= 0.0
                    })
            });
            driven = Some(driven.unwrap_or(false) || drives);
            let drags = step.drags.clone();
            let computed = Some((step, convergence));
            branches.push(Branch { c, problem, equilibrium, solution, drags, computed, agreed });
        }
        if branches.is_empty() {
            return Ok(nothing(certificate));
        }
        // Along a range of torques the losses would change with them.
        Ok(Balance { branches, certificate, continuum, ranges: vec![], driven })
    }
}
