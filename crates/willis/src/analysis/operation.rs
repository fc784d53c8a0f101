//! One operating point, from what is prescribed to the answer: speeds, loads, equilibria, verdict.

use std::sync::OnceLock;

use crate::kinematics::{Configuration, Coupled, Deviation, Motion};
use crate::operating_point::{Physics, Step};
use crate::power_flow::Known;
use crate::statics::{Certificate, Equilibrium, SolvedColumn, Unsolvable};
use crate::train::{MemberId, MeshId, Operation, ShiftElement, ShiftElementId, ShiftElementKind, Train};

use super::balance::{Balance, Branch, Setting};
use super::loads::Loads;
use super::rounds::{Agreed, Rounds};
use super::solution::Frame;
use super::words::{Finding, Refusal, names};
use super::{
    Boundary, OperationReport, OutsideLaw, Role, SolutionReport, SpeedDeviation, TorqueRange, Verdict, Why, variators,
};

/// A unique equilibrium with what its numbers are computed from.
#[derive(Clone, Debug)]
pub(crate) struct Point<'t> {
    /// With the efficiencies in force.
    pub c: Configuration<'t>,
    pub motion: Motion,
    /// Node of each equation.
    pub rows: Vec<usize>,
    pub columns: Vec<SolvedColumn>,
    /// Force of each element of the configuration, SI.
    pub forces: Vec<f64>,
    /// Terminals that balance the train.
    pub open: Vec<MemberId>,
}

impl Point<'_> {
    /// Its linear equations.
    pub fn known(&self) -> Known<'_> {
        Known { c: &self.c, rows: &self.rows, columns: &self.columns }
    }
}

/// Which ends drive in an equilibrium with computed losses: others with the same drivers are looked for from here.
pub(super) struct Pattern {
    equilibrium: Equilibrium,
    /// Node of each equation.
    rows: Vec<usize>,
    columns: Vec<SolvedColumn>,
    sigma: Vec<Option<i8>>,
    /// Nodes whose torque is left to be found.
    open: Vec<usize>,
    /// Bounds on ρ by column between which there is one solution for every load, once some are known.
    regular: OnceLock<Vec<[f64; 2]>>,
}

impl Pattern {
    /// Whether it can be that of a point with these directions of motion and loads.
    pub fn suits(&self, sigma: &[Option<i8>], problem: &Loads) -> bool {
        let has_equation = |n: &usize| self.rows.contains(n) || self.open.contains(n);
        self.sigma == sigma && self.open == problem.open && problem.loaded.iter().all(has_equation)
    }

    /// Whether both say the same of a point.
    pub fn is_like(&self, other: &Self) -> bool {
        let drivers = |p: &Self| p.columns.iter().map(|c| (c.element, c.p_drives)).collect::<Vec<_>>();
        self.sigma == other.sigma
            && self.open == other.open
            && self.rows == other.rows
            && drivers(self) == drivers(other)
    }

    pub fn rounds<'a>(
        &'a self,
        c: &'a Configuration<'a>,
        motion: &Motion,
        operation: &Operation,
        problem: &'a Loads,
    ) -> Option<Rounds<'a>> {
        let known = Known { c, rows: &self.rows, columns: &self.columns };
        Rounds::new(known, motion, operation, &self.sigma, problem)
    }

    /// Whether an agreement of its [rounds](Self::rounds) is beyond doubt the only equilibrium.
    pub fn is_only(&self, rounds: &Rounds<'_>, agreed: &Agreed) -> bool {
        rounds.is_only(&self.equilibrium, agreed, &self.regular)
    }
}

/// What a unique equilibrium with computed losses was solved from: that with other losses is looked for from here.
pub(super) struct Origin {
    pub pattern: Pattern,
    /// The loads without drags.
    problem: Loads,
}

impl Origin {
    /// The losses that other physics give at a point, in floating point, looked for from those that are `near`; `None` where
    /// they are not found so, or where it is not beyond doubt that they are the only ones.
    pub fn follow(
        &self,
        point: &Point<'_>,
        operation: &Operation,
        physics: &Physics<'_>,
        near: Option<&Step>,
    ) -> Option<Agreed> {
        let rounds = self.pattern.rounds(&point.c, &point.motion, operation, &self.problem)?;
        let agreed = rounds.agree_closely(physics, &point.motion, near)?;
        self.pattern.is_only(&rounds, &agreed).then_some(agreed)
    }

    /// The same as an analysis with these physics finds it, to the last bit where the same ends drive.
    pub fn again(&self, point: &Point<'_>, operation: &Operation, physics: &Physics<'_>) -> Option<Agreed> {
        let rounds = self.pattern.rounds(&point.c, &point.motion, operation, &self.problem)?;
        let agreed = rounds.agree(physics, &point.motion)?;
        self.pattern.is_only(&rounds, &agreed).then_some(agreed)
    }
}

/// An operating point, answered.
pub(super) struct Settled<'t> {
    pub report: OperationReport,
    /// The equilibrium where there is exactly one.
    pub point: Option<Point<'t>>,
    /// What it was solved from, where laws compute losses.
    pub origin: Option<Origin>,
    /// What else a reader must know.
    pub findings: Vec<Finding>,
}

/// Analyses an operation at one temperature; `Err` when what it prescribes makes no question. `exactly` also works
/// efficiencies out as fractions.
pub(super) fn settle_at<'t>(
    train: &'t Train,
    operation: &Operation,
    exactly: bool,
) -> Result<Settled<'t>, Vec<Refusal>> {
    let engaged = operation.state.map_or(&[][..], |k| &train.states[k].engaged);
    let physics = train.depends_on_load().then(|| Physics::new(train, operation));
    let prescribed: Vec<MemberId> = operation.speeds.iter().map(|(m, _)| *m).collect();
    let dragged = physics.as_ref().map(Physics::visible).unwrap_or_default();
    let keep: Vec<MemberId> = prescribed.iter().chain(&dragged).copied().collect();
    let c = Configuration::new(train, engaged, &operation.fixed, &keep);

    let contradicts = |broken| contradiction(&c, operation, broken);
    let motion =
        c.motion(&operation.speeds).map_err(|broken| broken.into_iter().map(contradicts).collect::<Vec<_>>())?;
    if (1..train.members.len()).any(|m| motion.si(MemberId(m)).is_some_and(|w| !w.is_finite())) {
        return Err(vec![Refusal::SpeedTooLarge]);
    }
    let speeds = (1..train.members.len()).map(|m| (train.members[m].name.clone(), motion.si(MemberId(m))));
    let mut report = OperationReport::new(train, operation, c.degrees_of_freedom(), speeds.collect());
    report.speed_deviation = motion
        .deviation
        .as_ref()
        .map(|d| SpeedDeviation { members: names(train, d.members.iter().copied()), relative: d.relative });
    if c.degrees_of_freedom() == 0 {
        return Ok(Settled::without(report, Verdict::Locked, Why::NoFreedom));
    }

    let gears = c;
    let driven: Vec<[usize; 2]> = operation.machines.iter().map(|(at, _)| *at).collect();
    let Coupled { c, motion, at_rest, open } = gears.coupled(&motion, &driven);
    let problem = Loads::new(&c, operation, &motion, &[])?;
    let turned = turned_back(&c, &motion);
    let loose: Vec<_> =
        (1..train.members.len()).map(MemberId).filter(|m| motion.speeds[m.0].is_none() && !c.inner[m.0]).collect();
    let sigma: Vec<_> = c.elements.iter().map(|e| c.sigma(e, &motion)).collect();
    let resting = at_rest.into_iter().map(Finding::VariatorAtRest);
    // Shafts that push against each other in a clutch balance at any speed, and so at any power.
    let posed = match open || problem.given.iter().any(|(m, t)| !t.is_zero() && loose.contains(m)) {
        true => Err(Unsolvable::UndeterminedSpeed),
        false => Equilibrium::new(&c, &sigma, &problem.open, &problem.loaded),
    };
    let equilibrium = match posed {
        Ok(equilibrium) => equilibrium,
        Err(why) => {
            let why = obstacle(&c, &problem, &motion, &prescribed, &loose, why)?;
            let mut settled = Settled::without(report, Verdict::Undetermined, why);
            settled.findings.extend(turned.into_iter().map(Finding::Why));
            return Ok(settled);
        }
    };
    let setting = Setting { c: &c, motion: &motion, operation, sigma: &sigma };
    let nothing_acts = problem.are_none();
    let Balance { branches, certificate, continuum, ranges, driven } =
        setting.balance(&problem, equilibrium, physics.as_ref())?;
    let frames: Vec<Frame<'_>> = branches
        .iter()
        .map(|branch| Frame {
            c: &branch.c,
            motion: &motion,
            sigma: &sigma,
            problem: &branch.problem,
            undragged: &problem,
            equilibrium: &branch.equilibrium,
            operation,
            drags: &branch.drags,
            exactly,
            physics: physics.as_ref().zip(branch.computed.as_ref()),
            agreed: branch.agreed.as_ref(),
        })
        .collect();
    let (mut all, extrapolations): (Vec<SolutionReport>, Vec<_>) =
        frames.iter().zip(&branches).map(|(f, b)| f.solution(&b.solution)).unzip();
    all.sort_by(|a, b| a.efficiency.partial_cmp(&b.efficiency).unwrap_or(std::cmp::Ordering::Equal));
    if !all.iter().all(finite) {
        return Err(vec![Refusal::TorqueTooLarge]);
    }

    let mut findings: Vec<Finding> = report.speed_deviation.clone().map(Finding::Yield).into_iter().collect();
    findings.extend(resting);
    if !loose.is_empty() {
        findings.push(Finding::MaySpin(loose));
    }
    if certificate == Certificate::Undecided {
        findings.push(Finding::Why(Why::TooManyMeshes));
    }
    let resting = all.iter().filter(|s| !s.stiction.is_empty());
    findings.extend(resting.map(|s| Finding::Stiction(s.stiction.clone())));
    let case = Case {
        unloaded: branches.first().map_or(nothing_acts, |b| b.problem.are_none()),
        undecided: certificate == Certificate::Undecided,
        threshold: continuum.then_some(ranges),
        computed: physics.is_some(),
        // Drag may eat a small load up; only tooth friction locks.
        locks: c.degrees_of_freedom() == 1 && !driven.unwrap_or_else(|| all.iter().any(|s| !s.all_dissipated)),
    };
    let (mut verdict, mut whys) = case.verdict(&all);
    // What a one-way clutch does not allow is no answer, however well it balances. Where all are allowed but some equilibria,
    // that is told beside the reason.
    if verdict == Verdict::Locked {
        whys.extend(turned);
    } else {
        let held: Vec<Vec<Why>> = all.iter().map(|s| held_back(train, s)).collect();
        let none_left = !held.is_empty() && held.iter().all(|own| !own.is_empty());
        let impossible = !turned.is_empty() || none_left;
        let against = turned.into_iter().chain(held.into_iter().flatten());
        if impossible {
            verdict = Verdict::Undetermined;
            whys.splice(..0, against);
        } else {
            whys.extend(against);
        }
    }
    let mut report = OperationReport { verdict, certificate: Some(certificate.into()), ..report };
    whys.first().into_iter().for_each(|why| report.explain(why));
    findings.extend(whys.into_iter().map(Finding::Why));
    report.outside_laws = extrapolations.iter().flat_map(|own| OutsideLaw::of(own)).collect();
    findings.extend(report.outside_laws.iter().cloned().map(Finding::Outside));
    match verdict {
        Verdict::Locked => report.dissipative_solutions = all,
        _ => report.solutions = all,
    }
    for s in &report.solutions {
        findings.extend(near_boundary(s));
        findings.extend(s.beyond_limits.iter().cloned().map(Finding::Beyond));
        findings.extend(s.doubts.iter().cloned().map(Finding::Doubt));
        findings.extend(variators::outside_maps(train, s).into_iter().map(Finding::OutsideMap));
    }
    let point = match (verdict, &branches[..]) {
        (Verdict::Unique, [branch]) => Some(point(&c, &motion, branch)),
        _ => None,
    };
    let solved = branches.into_iter().next().filter(|branch| point.is_some() && branch.computed.is_some());
    let solved = solved.map(|Branch { equilibrium, solution, .. }| (equilibrium.solved(&solution), equilibrium));
    let origin = solved.map(|((rows, columns), equilibrium)| {
        let open = problem.open.clone();
        Origin { pattern: Pattern { equilibrium, rows, columns, sigma, open, regular: OnceLock::new() }, problem }
    });
    Ok(Settled { report, point, origin, findings })
}

impl Settled<'_> {
    /// Without an equilibrium, and why.
    fn without(mut report: OperationReport, verdict: Verdict, why: Why) -> Self {
        report.verdict = verdict;
        report.explain(&why);
        let mut findings: Vec<Finding> = report.speed_deviation.clone().map(Finding::Yield).into_iter().collect();
        findings.push(Finding::Why(why));
        Self { report, point: None, origin: None, findings }
    }
}

/// Prescribed speeds that the gears do not allow.
fn contradiction(c: &Configuration<'_>, operation: &Operation, Deviation { members, relative }: Deviation) -> Refusal {
    let rpm = |w: f64| w * 30.0 / std::f64::consts::PI;
    let last = *members.last().expect("a conflict names members");
    let given = operation.speeds.iter().find(|(m, _)| *m == last).map_or(0.0, |(_, q)| q.si());
    // What the gears make of the others.
    let others: Vec<_> = operation.speeds.iter().filter(|(m, _)| *m != last).cloned().collect();
    let follows = c.motion(&others).ok().and_then(|m| m.si(last)).map(rpm);
    let freedoms = c.degrees_of_freedom();
    Refusal::Contradiction { freedoms, members, relative, follows_rpm: follows, given_rpm: rpm(given) }
}

/// Rank of the prescribed speeds.
fn independent(c: &Configuration<'_>, prescribed: &[MemberId]) -> usize {
    // A redundant train lists a conflict more than once.
    prescribed.len().saturating_sub(c.transfer(prescribed).conflicts.len())
}

/// What stands in the way of an equilibrium problem; `Err` where the loads are to blame.
fn obstacle(
    c: &Configuration<'_>,
    problem: &Loads,
    motion: &Motion,
    prescribed: &[MemberId],
    loose: &[MemberId],
    unsolvable: Unsolvable,
) -> Result<Why, Vec<Refusal>> {
    let train = c.train;
    if !loose.is_empty() {
        let freedoms = c.degrees_of_freedom();
        let settled = independent(c, prescribed).min(freedoms);
        return Ok(Why::TooFewSpeeds { freedoms, settled, open: names(train, loose.iter().copied()) });
    }
    let redundant = c.redundant();
    match unsolvable {
        Unsolvable::Indeterminate if redundant.is_empty() && problem.rest(motion) => {
            Ok(Why::BalancerAtRest { members: names(train, problem.balancing()) })
        }
        Unsolvable::Indeterminate if redundant.is_empty() => Ok(Why::ForcesNotFixed),
        Unsolvable::Indeterminate => {
            let group = |g: &Vec<MeshId>| g.iter().map(|m| train.meshes[m.0].name.clone()).collect();
            Ok(Why::RedundantMeshes { groups: redundant.iter().map(group).collect() })
        }
        Unsolvable::MissingLoads(n) => Err(problem.missing(c, n)),
        Unsolvable::TooManyLoads(n) => Err(problem.too_many(c, n)),
        Unsolvable::UndeterminedSpeed => Ok(Why::RelativeSpeedNotDetermined),
    }
}

/// What the verdict on a load case depends on, beside its equilibria.
struct Case {
    /// Nothing acts.
    unloaded: bool,
    /// The number of equilibria is not known.
    undecided: bool,
    /// The torques of which a whole range balances the load, if one does.
    threshold: Option<Vec<TorqueRange>>,
    /// Laws compute the losses.
    computed: bool,
    /// No equilibrium of a train with one freedom drives a load.
    locks: bool,
}

impl Case {
    /// The verdict on the equilibria that were found, and what explains it, the first thing first.
    fn verdict(&self, all: &[SolutionReport]) -> (Verdict, Vec<Why>) {
        if self.unloaded {
            return (Verdict::Unloaded, vec![Why::Unloaded]);
        }
        if all.iter().any(|s| s.convergence.is_some_and(|c| !c.converged)) {
            return (Verdict::Undetermined, vec![Why::NotConverged]);
        }
        if self.undecided {
            // Found or not, nothing is proved: neither "unique" nor "locked" may be said.
            return (Verdict::Undetermined, vec![if all.is_empty() { Why::NoneFound } else { Why::PerhapsMore }]);
        }
        // What moves under a range of torques is not locked, whatever some of them dissipate.
        if let Some(ranges) = &self.threshold {
            return (Verdict::Multiple, vec![Why::Threshold { ranges: ranges.clone() }]);
        }
        if all.is_empty() {
            return (Verdict::Locked, vec![Why::NoEquilibrium]);
        }
        if self.locks {
            return (Verdict::Locked, vec![Why::OnlyDissipates]);
        }
        let mut whys = Vec::new();
        if all.len() > 1 {
            let efficiency = |s: &SolutionReport| if s.all_dissipated { Some(0.0) } else { s.efficiency };
            whys.push(Why::Equilibria { efficiencies: all.iter().map(efficiency).collect() });
        }
        let verdict = if whys.is_empty() { Verdict::Unique } else { Verdict::Multiple };
        if self.computed && all.iter().all(|s| s.all_dissipated) {
            whys.push(Why::LossesTakeAll);
        } else if let Some(s) = all.iter().find(|s| s.all_dissipated) {
            let inputs = s.members.iter().filter(|(_, m)| m.role == Role::Input).map(|(name, _)| name.clone());
            whys.push(Why::AllPutIn { inputs: inputs.collect() });
        }
        (verdict, whys)
    }
}

/// Whether every number of a solution is one.
fn finite(s: &SolutionReport) -> bool {
    let finite = |x: Option<f64>| x.is_none_or(f64::is_finite);
    s.members.iter().all(|(_, m)| finite(m.torque_n_m) && finite(m.power_w)) && s.loss_w.is_finite()
}

/// What the numbers of the only equilibrium are computed from.
fn point<'t>(c: &Configuration<'t>, motion: &Motion, branch: &Branch<'_>) -> Point<'t> {
    let scale = branch.problem.scale();
    let (rows, columns) = branch.equilibrium.solved(&branch.solution);
    Point {
        c: c.with_efficiencies(branch.c.efficiencies.clone()),
        rows,
        columns,
        forces: branch.solution.forces.iter().map(|f| f * scale).collect(),
        open: branch.problem.balancing().collect(),
        motion: motion.clone(),
    }
}

/// One-way clutches that would have to hold against their free direction.
fn held_back(train: &Train, s: &SolutionReport) -> Vec<Why> {
    let one_way = s.shift_elements.iter().filter(|(_, e)| e.kind == ShiftElementKind::OneWay);
    // What is left of the torques beside it, which agree to 1e-9, is none.
    let meshes = s.meshes.iter().flat_map(|(_, m)| [m.first_torque_n_m, m.second_torque_n_m, m.carrier_torque_n_m]);
    let most = s.members.iter().filter_map(|(_, m)| m.torque_n_m).chain(meshes).fold(0.0, |a: f64, t| a.max(t.abs()));
    one_way
        .filter_map(|(name, e)| {
            let element = train.shift_elements.iter().find(|x| x.name == *name)?;
            let torque_n_m = e.torque_n_m.filter(|t| t * f64::from(element.blocks) > 1e-9 * most)?;
            Some(Why::CannotHold { clutch: name.clone(), member: e.members[0].clone(), torque_n_m })
        })
        .collect()
}

/// One-way clutches that are open and turn the way they block.
pub(super) fn turned_back(c: &Configuration<'_>, motion: &Motion) -> Vec<Why> {
    let train = c.train;
    let one_way = train.shift_elements.iter().enumerate().filter(|(_, e)| e.kind == ShiftElementKind::OneWay);
    let open = one_way.filter(|(k, _)| !c.engaged.contains(&ShiftElementId(*k)));
    let turns = |(_, element): (usize, &ShiftElement)| {
        let [Some(a), Some(b)] = element.members.map(|m| motion.si(m)) else { return None };
        let blocked = (a - b) * f64::from(element.blocks);
        // What is prescribed in few digits may leave a trace of a speed that is zero.
        let is_some = blocked > train.speed_tolerance * a.abs().max(b.abs());
        is_some.then(|| Why::WouldLock {
            clutch: element.name.clone(),
            members: element.members.map(|m| train.member_name(m).to_owned()),
            speed_rad_s: a - b,
        })
    };
    open.filter_map(turns).collect()
}

/// Prescribed values within a percent of a boundary.
fn near_boundary(s: &SolutionReport) -> Vec<Finding> {
    let near = |b: &&Boundary| (b.boundary - b.value).abs() <= 0.01 * b.value.abs().max(b.boundary.abs());
    let both = [(true, &s.margin.torque), (false, &s.margin.speed)];
    both.into_iter()
        .filter_map(|(torque, b)| b.as_ref().filter(near).map(|b| Finding::Near { torque, boundary: b.clone() }))
        .collect()
}
