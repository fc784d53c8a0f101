//! One operating point: speeds, torques, power flow, margins.

use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::exact::Rational;
use crate::kinematics::{Configuration, Motion, common};
use crate::operating_point::{Convergence, Extrapolation, Physics, Step};
use crate::power_flow::{Drag, External, Flow};
use crate::statics::{Answer, Certificate, Equilibrium, Solution, SolvedColumn, Unsolvable};
use crate::train::{FRAME, Load, MemberId, MemberKind, Operation, ShiftElementKind, Train};
use crate::units::{Dimension, Quantity};

use super::table::{torque, torque_exact, unsolvable};
use super::{
    Boundary, CirculationReport, LockMargin, Losses, Margin, MemberReport, MeshReport, Named, OperationReport, Role,
    ShiftElementReport, SolutionReport, StictionRange, Verdict, names,
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

/// Analyses an operation; `Err` when what it prescribes makes no question.
pub(super) fn report(
    train: &Train,
    operation: &Operation,
    diagnostics: &mut Diagnostics,
) -> Result<OperationReport, Diagnostics> {
    settle(train, operation, diagnostics).map(|(report, _)| report)
}

/// The same, with the equilibrium where there is exactly one.
pub(super) fn settle<'t>(
    train: &'t Train,
    operation: &Operation,
    diagnostics: &mut Diagnostics,
) -> Result<(OperationReport, Option<Point<'t>>), Diagnostics> {
    let engaged = operation.state.map_or(&[][..], |k| &train.states[k].engaged);
    let physics = train.is_physical().then(|| Physics::new(train, operation));
    let prescribed: Vec<MemberId> = operation.speeds.iter().map(|(m, _)| *m).collect();
    let dragged = physics.as_ref().map(Physics::visible).unwrap_or_default();
    let keep: Vec<MemberId> = prescribed.iter().chain(&dragged).copied().collect();
    let c = Configuration::new(train, engaged, &operation.fixed, &keep);
    let place = operation.place.as_str();
    let title = format!("operation `{}`", operation.name);
    let mut report = OperationReport {
        name: operation.name.clone(),
        state: operation.state.map(|k| train.states[k].name.clone()),
        degrees_of_freedom: c.degrees_of_freedom(),
        verdict: Verdict::Undetermined,
        certificate: None,
        reason: None,
        speeds_rad_s: Named::default(),
        solutions: vec![],
        dissipative_solutions: vec![],
    };

    let motion = c.motion(&operation.speeds).map_err(|broken| contradiction(&c, operation, &broken))?;
    if (1..train.members.len()).any(|m| motion.si(MemberId(m)).is_some_and(|w| !w.is_finite())) {
        let mut wrong = Diagnostics::default();
        wrong.push(Diagnostic::new(Code::TooLarge, place, format!("{title}: a speed is beyond 1e308 rad/s")));
        return Err(wrong);
    }
    report.speeds_rad_s =
        Named((1..train.members.len()).map(|m| (train.members[m].name.clone(), motion.si(MemberId(m)))).collect());
    if c.degrees_of_freedom() == 0 {
        let text = "nothing can turn: every freedom is taken by brakes, clutches and held members".to_owned();
        diagnostics.push(
            Diagnostic::new(Code::KinematicallyLocked, place, format!("{title}: {text}")).hint("release one of them"),
        );
        report.verdict = Verdict::Locked;
        report.reason = Some(text);
        return Ok((report, None));
    }

    let problem = Loads::new(&c, operation, &motion, &[])?;
    let loose: Vec<_> =
        (1..train.members.len()).map(MemberId).filter(|m| motion.speeds[m.0].is_none() && !c.inner[m.0]).collect();
    let missing_speeds = c.degrees_of_freedom().saturating_sub(independent(&c, &prescribed));
    let sigma: Vec<_> = c.elements.iter().map(|e| c.sigma(e, &motion)).collect();
    let undetermined = |text: String, hint: String, code: Code| {
        let d = Diagnostic::new(code, place, format!("{title}: {text}"));
        (text, if hint.is_empty() { d } else { d.hint(hint) })
    };
    // Shafts that push against each other in a clutch balance at any speed, and so at any power.
    let equilibrium = match problem.given.iter().any(|(m, t)| !t.is_zero() && loose.contains(m)) {
        true => Err(Unsolvable::UndeterminedSpeed),
        false => Equilibrium::new(&c, &sigma, &problem.open, &problem.loaded),
    };
    let equilibrium = match equilibrium {
        Ok(equilibrium) => equilibrium,
        Err(why) => {
            let redundant = c.redundant();
            let (text, d) = if !loose.is_empty() {
                let text = format!(
                    "{}, {} settled by the prescribed speeds: no determined speed for {}",
                    freedoms(&c),
                    c.degrees_of_freedom() - missing_speeds,
                    names(train, loose)
                );
                let hint = match missing_speeds {
                    1 => "give one more speed, or hold one member".to_owned(),
                    n => format!("give {n} more speeds, or hold {n} members"),
                };
                undetermined(text, hint, Code::Undetermined)
            } else if why == Unsolvable::Indeterminate && redundant.is_empty() && still(&problem, &motion) {
                let open = problem.externals.iter().filter(|x| x.torque.is_none()).map(|x| x.member);
                let text = format!(
                    "{} stands still in this motion and can take no power, so nothing balances the load",
                    names(train, open)
                );
                undetermined(text, "leave open a terminal that turns".into(), Code::Undetermined)
            } else if why == Unsolvable::Indeterminate {
                let meshes: Vec<String> = redundant
                    .iter()
                    .map(|g| g.iter().map(|m| train.meshes[m.0].name.clone()).collect::<Vec<_>>().join(", "))
                    .collect();
                let text = match meshes.is_empty() {
                    true => "statically indeterminate: equilibrium does not fix the tooth forces".to_owned(),
                    false => format!("statically indeterminate: the meshes {} constrain each other", meshes.join("; ")),
                };
                undetermined(text, "remove a mesh, or release a held member".into(), Code::Indeterminate)
            } else if let Unsolvable::MissingLoads(n) | Unsolvable::TooManyLoads(n) = why {
                return Err(wrong_loads(&c, operation, &problem, matches!(why, Unsolvable::MissingLoads(_)), n));
            } else {
                undetermined(unsolvable(&why).to_owned(), String::new(), Code::Undetermined)
            };
            diagnostics.push(d);
            report.reason = Some(text);
            return Ok((report, None));
        }
    };
    if !loose.is_empty() {
        diagnostics.push(Diagnostic::new(
            Code::Undetermined,
            place,
            format!("{title}: {} may spin at any speed; nothing is transmitted there", names(train, loose)),
        ));
    }

    let setting = Setting { c: &c, motion: &motion, operation, sigma: &sigma };
    let Balance { branches, certificate, continuum, driven } = match &physics {
        None => {
            let answer = equilibrium.solve(&problem.torques);
            let branch = |solution| Branch {
                c: c.clone(),
                problem: problem.clone(),
                equilibrium: equilibrium.clone(),
                solution,
                drags: vec![],
                computed: None,
            };
            Balance {
                branches: answer.solutions.into_iter().map(branch).collect(),
                certificate: answer.certificate,
                continuum: answer.continuum,
                driven: None,
            }
        }
        Some(physics) => setting.balance(physics)?,
    };
    report.certificate = Some(certificate.into());
    if certificate == Certificate::Undecided {
        diagnostics.push(Diagnostic::new(
            Code::NotEnumerated,
            place,
            format!("{title}: too many interacting meshes to decide how many equilibria there are"),
        ));
    }
    let unloaded = match branches.first() {
        Some(b) => b.problem.torques.iter().all(Rational::is_zero),
        None => problem.torques.iter().all(Rational::is_zero),
    };
    let frames: Vec<Frame<'_>> = branches
        .iter()
        .map(|branch| Frame {
            c: &branch.c,
            motion: &motion,
            problem: &branch.problem,
            equilibrium: &branch.equilibrium,
            operation,
            drags: &branch.drags,
            physics: physics.as_ref().zip(branch.computed.as_ref()),
        })
        .collect();
    let mut all: Vec<SolutionReport> = frames.iter().zip(&branches).map(|(f, b)| f.solution(&b.solution)).collect();
    all.sort_by(|a, b| a.efficiency.partial_cmp(&b.efficiency).unwrap_or(std::cmp::Ordering::Equal));
    let unsettled = all.iter().any(|s| s.convergence.is_some_and(|c| !c.converged));
    let finite = |x: Option<f64>| x.is_none_or(f64::is_finite);
    if all
        .iter()
        .any(|s| s.members.iter().any(|(_, m)| !finite(m.torque_n_m) || !finite(m.power_w)) || !s.loss_w.is_finite())
    {
        let mut wrong = Diagnostics::default();
        wrong.push(Diagnostic::new(Code::TooLarge, place, format!("{title}: a torque or power is beyond 1e308")));
        return Err(wrong);
    }
    for solution in all.iter().filter(|s| !s.stiction.is_empty()) {
        let ranges: Vec<_> = solution
            .stiction
            .iter()
            .map(|r| match (r.low, r.high) {
                (Some(low), Some(high)) => format!("{} between {} and {}", r.what, short(low), short(high)),
                _ => format!("{} open", r.what),
            })
            .collect();
        diagnostics.push(Diagnostic::new(
            Code::Stiction,
            place,
            format!(
                "{title}: a loaded mesh is at rest relative to its carrier; its friction leaves {}",
                ranges.join(", ")
            ),
        ));
    }
    // Drag may eat a small load up; only tooth friction locks.
    let driving = driven.unwrap_or_else(|| all.iter().any(|s| !s.all_dissipated));
    let one_freedom = c.degrees_of_freedom() == 1;
    if unloaded {
        report.verdict = Verdict::Unloaded;
        report.reason = Some("no torque or power acts on any terminal".into());
        report.solutions = all;
    } else if unsettled {
        let text = "losses and torques were not brought into agreement: what is shown is the last step".to_owned();
        diagnostics.push(
            Diagnostic::new(Code::NotConverged, place, format!("{title}: {text}"))
                .hint("the train is close to locking, or a law is far outside its range"),
        );
        report.reason = Some(text);
        report.solutions = all;
    } else if certificate == Certificate::Undecided {
        // Found or not, nothing is proved: neither "unique" nor "locked" may be said.
        report.reason = Some(match all.is_empty() {
            true => "too many interacting meshes: no equilibrium was found, and none is excluded".into(),
            false => "too many interacting meshes: the equilibrium shown may not be the only one".into(),
        });
        report.solutions = all;
    } else if all.is_empty() || (one_freedom && !driving) {
        report.verdict = Verdict::Locked;
        let text = if all.is_empty() {
            "friction locks the train: no equilibrium exists for this load in this motion".to_owned()
        } else {
            "friction locks the train: it moves this way only when every loaded member is driven, and all of that \
             power is dissipated"
                .to_owned()
        };
        diagnostics.push(
            Diagnostic::new(Code::SelfLocking, place, format!("{title}: {text}"))
                .hint("higher mesh efficiency, or a basic ratio farther from 1, frees it"),
        );
        report.reason = Some(text);
        report.dissipative_solutions = all;
    } else {
        report.verdict = if all.len() > 1 || continuum { Verdict::Multiple } else { Verdict::Unique };
        if report.verdict == Verdict::Multiple {
            let list: Vec<_> = all
                .iter()
                .map(|s| match (s.all_dissipated, s.efficiency) {
                    (true, _) => "all dissipated".to_owned(),
                    (_, Some(e)) => format!("{e:.4}"),
                    _ => "unloaded".to_owned(),
                })
                .collect();
            let text = match continuum {
                true => "the load lies on a self-locking threshold: a whole range of torques balances it".to_owned(),
                false => {
                    format!("{} equilibria carry the same load, with efficiencies {}", list.len(), list.join(" and "))
                }
            };
            diagnostics.push(
                Diagnostic::new(Code::SeveralSolutions, place, format!("{title}: {text}")).hint(
                    "a rigid quasi-static model cannot choose between them; better mesh efficiency makes it unique",
                ),
            );
            report.reason = Some(text);
        }
        if physics.is_some() && all.iter().all(|s| s.all_dissipated) {
            let text = "no power leaves: the losses take all that enters".to_owned();
            diagnostics.push(Diagnostic::new(Code::AllDissipated, place, format!("{title}: {text}")));
            report.reason.get_or_insert(text);
        } else if all.iter().any(|s| s.all_dissipated) {
            let inputs = all.iter().find(|s| s.all_dissipated).map(inputs).unwrap_or_default();
            let text = format!("{inputs} all put power in and none takes power out: everything is dissipated");
            diagnostics.push(Diagnostic::new(Code::AllDissipated, place, format!("{title}: {text}")));
            report.reason.get_or_insert(text);
        }
        report.solutions = all;
    }
    if let Some(physics) = &physics {
        for (branch, frame) in branches.iter().zip(&frames) {
            let flow = frame.flow(&branch.solution);
            outside_laws(physics.extrapolations(&flow), place, &title, diagnostics);
        }
    }
    for s in report.solutions.iter() {
        one_way_torques(train, s, place, &title, diagnostics);
        near_boundary(s, place, &title, diagnostics);
    }
    let point = match (report.verdict, &branches[..]) {
        (Verdict::Unique, [branch]) => {
            let scale = std::f64::consts::PI.powi(branch.problem.pi_power.into());
            let (rows, columns) = branch.equilibrium.solved(&branch.solution);
            let open = branch.problem.externals.iter().filter(|x| x.torque.is_none());
            Some(Point {
                c: c.with_efficiencies(branch.c.efficiencies.clone()),
                rows,
                columns,
                forces: branch.solution.forces.iter().map(|f| f * scale).collect(),
                open: open.map(|x| x.member).collect(),
                motion: motion.clone(),
            })
        }
        _ => None,
    };
    Ok((report, point))
}

/// Whether every terminal that is left to balance the train is at rest.
fn still(loads: &Loads, motion: &Motion) -> bool {
    let mut open = loads.externals.iter().filter(|x| x.torque.is_none());
    open.all(|x| motion.speeds[x.member.0].as_ref().is_some_and(Rational::is_zero))
}

fn inputs(s: &SolutionReport) -> String {
    let all: Vec<_> = s.members.iter().filter(|(_, m)| m.role == Role::Input).map(|(n, _)| n.as_str()).collect();
    all.join(", ")
}

/// `a + b`, zero where they cancel up to round-off.
fn sum(a: f64, b: f64) -> f64 {
    if (a + b).abs() <= 1e-12 * a.abs() { 0.0 } else { a + b }
}

/// A number for a sentence.
fn short(x: f64) -> String {
    let text = format!("{x:.4}");
    if text.parse::<f64>() == Ok(0.0) && x != 0.0 { format!("{x:.3e}") } else { text }
}

fn freedoms(c: &Configuration<'_>) -> String {
    let n = c.degrees_of_freedom();
    format!("{n} degree{} of freedom", if n == 1 { "" } else { "s" })
}

/// Rank of the prescribed speeds.
fn independent(c: &Configuration<'_>, prescribed: &[MemberId]) -> usize {
    // A redundant train lists a conflict more than once.
    prescribed.len().saturating_sub(c.transfer(prescribed).conflicts.len())
}

fn contradiction(c: &Configuration<'_>, operation: &Operation, broken: &[Vec<MemberId>]) -> Diagnostics {
    let train = c.train;
    let mut all = Diagnostics::default();
    for members in broken {
        let value = |m: MemberId| {
            operation.speeds.iter().find(|(n, _)| *n == m).map_or(0.0, |(_, q)| q.si()) * 30.0 / std::f64::consts::PI
        };
        let place = format!("{}.speeds", operation.place);
        let (last, others) = members.split_last().expect("a conflict names members");
        // What the gears make of the others.
        let given: Vec<_> = operation.speeds.iter().filter(|(m, _)| m != last).cloned().collect();
        let follows = c.motion(&given).ok().and_then(|m| m.si(*last)).map(|w| w * 30.0 / std::f64::consts::PI);
        let message = match others {
            [] => format!(
                "operation `{}`: `{}` cannot turn, but {} rpm is prescribed",
                operation.name,
                train.member_name(*last),
                short(value(*last))
            ),
            _ => format!(
                "operation `{}`: the gears tie {} together; with the other speeds `{}` turns at {} rpm, not at {} rpm",
                operation.name,
                names(train, members.iter().copied()),
                train.member_name(*last),
                follows.map_or("another number of".into(), short),
                short(value(*last))
            ),
        };
        all.push(Diagnostic::new(Code::ContradictorySpeeds, place, message).hint(match c.degrees_of_freedom() {
            0 => "nothing can turn here: release a shift element or a held member".to_owned(),
            1 => "prescribe one speed in this configuration".to_owned(),
            n => format!("prescribe {n} independent speeds in this configuration"),
        }));
    }
    all
}

/// External torques as the statics takes them.
#[derive(Clone)]
struct Loads {
    /// Prescribed torques by member, in units of `π^pi_power`.
    given: Vec<(MemberId, Rational)>,
    pi_power: i8,
    /// By node.
    torques: Vec<Rational>,
    open: Vec<usize>,
    loaded: Vec<usize>,
    externals: Vec<External>,
}

impl Loads {
    fn new(c: &Configuration<'_>, operation: &Operation, motion: &Motion, drags: &[Drag]) -> Result<Self, Diagnostics> {
        let train = c.train;
        let mut wrong = Diagnostics::default();
        let mut quantities: Vec<(MemberId, Quantity)> = Vec::new();
        for (member, load) in &operation.loads {
            let name = train.member_name(*member);
            match load {
                Load::Torque(q) => quantities.push((*member, q.clone())),
                Load::Power(p) => match &motion.speeds[member.0] {
                    Some(w) if w.is_zero() && !p.value.is_zero() => wrong.push(
                        Diagnostic::new(
                            Code::PowerAtRest,
                            format!("{}.powers.{name}", operation.place),
                            format!(
                                "operation `{}`: {} W at `{name}`, which stands still here",
                                operation.name,
                                short(p.si())
                            ),
                        )
                        .hint("give its torque instead"),
                    ),
                    Some(w) if w.is_zero() => {
                        quantities.push((*member, Quantity { dimension: Dimension::TORQUE, ..p.clone() }));
                    }
                    Some(w) => quantities.push((
                        *member,
                        Quantity {
                            value: &p.value / w,
                            pi_power: p.pi_power - motion.pi_power,
                            dimension: Dimension::TORQUE,
                        },
                    )),
                    None => wrong.push(
                        Diagnostic::new(
                            Code::PowerAtRest,
                            format!("{}.powers.{name}", operation.place),
                            format!("operation `{}`: `{name}` has no determined speed here", operation.name),
                        )
                        .hint("give its torque instead, or prescribe another speed"),
                    ),
                },
            }
        }
        if wrong.has_errors() {
            return Err(wrong);
        }
        let (values, pi_power) = common(quantities.iter().map(|(_, q)| q));
        let given: Vec<(MemberId, Rational)> = quantities.iter().map(|(m, _)| *m).zip(values).collect();

        let si = std::f64::consts::PI.powi(pi_power.into());
        let mut torques = vec![Rational::ZERO; c.nodes];
        let mut externals = Vec::new();
        let mut loaded = Vec::new();
        for (member, torque) in &given {
            externals.push(External { member: *member, torque: Some(torque.to_f64() * si) });
            if let Some(n) = c.node(*member) {
                torques[n] += torque.clone();
                if !torque.is_zero() && !loaded.contains(&n) {
                    loaded.push(n);
                }
            }
        }
        for drag in drags {
            for (member, torque) in [(drag.members[0], drag.torque), (drag.members[1], -drag.torque)] {
                let Some(n) = c.node(member) else { continue };
                let Some(t) = Rational::from_f64(torque / si) else {
                    let name = train.member_name(member);
                    let message = format!("operation `{}`: the drag on `{name}` is beyond 1e50 N m", operation.name);
                    wrong.push(Diagnostic::new(Code::TooLarge, operation.place.as_str(), message));
                    continue;
                };
                torques[n] += t;
                if !loaded.contains(&n) {
                    loaded.push(n);
                }
            }
        }
        // Terminals on the frame's node carry only the reaction of their brake or hold.
        let mut open = Vec::new();
        for &terminal in &train.terminals {
            let Some(n) = c.node(terminal) else { continue };
            if given.iter().any(|(m, _)| *m == terminal) || operation.fixed.contains(&terminal) {
                continue;
            }
            if open.contains(&n) {
                let other = externals
                    .iter()
                    .find(|x| x.torque.is_none() && c.node(x.member) == Some(n))
                    .map_or("another terminal", |x| train.member_name(x.member));
                wrong.push(
                    Diagnostic::new(
                        Code::MissingTorque,
                        format!("{}.torques", operation.place),
                        format!(
                            "operation `{}`: `{other}` and `{}` turn as one here, and neither has a torque: only \
                             their sum can be found",
                            operation.name,
                            train.member_name(terminal)
                        ),
                    )
                    .hint("give the torque or power of one of them"),
                );
                continue;
            }
            open.push(n);
            externals.push(External { member: terminal, torque: None });
        }
        if wrong.has_errors() {
            return Err(wrong);
        }
        Ok(Self { given, pi_power, torques, open, loaded, externals })
    }
}

fn wrong_loads(c: &Configuration<'_>, operation: &Operation, loads: &Loads, missing: bool, n: usize) -> Diagnostics {
    let train = c.train;
    let open: Vec<MemberId> = loads.externals.iter().filter(|x| x.torque.is_none()).map(|x| x.member).collect();
    let mut all = Diagnostics::default();
    let place = format!("{}.torques", operation.place);
    let freedoms = freedoms(c);
    all.push(if missing {
        Diagnostic::new(
            Code::MissingTorque,
            place,
            format!(
                "operation `{}`: with {freedoms} as many terminals can be left without a torque or power, but {} have none: {}",
                operation.name,
                open.len(),
                names(train, open)
            ),
        )
        .hint(format!("give {n} more, \"0 N m\" where nothing acts"))
    } else {
        Diagnostic::new(
            Code::TooManyTorques,
            place,
            format!(
                "operation `{}`: with {freedoms} as many terminals must be left without a prescribed torque to balance \
                 the train; here {} left",
                operation.name,
                if open.len() == 1 { "1 is".to_owned() } else { format!("{} are", open.len()) },
            ),
        )
        .hint(match train.terminals.is_empty() {
            true => "name the members that take part in `terminals`".to_owned(),
            false => format!("leave out {n} of the torques, or list another member in `terminals`"),
        })
    });
    all
}

/// Everything a solution is seen against.
struct Frame<'a> {
    c: &'a Configuration<'a>,
    motion: &'a Motion,
    problem: &'a Loads,
    equilibrium: &'a Equilibrium,
    operation: &'a Operation,
    drags: &'a [Drag],
    /// Where losses are computed: the laws, and the step in force.
    physics: Option<(&'a Physics<'a>, &'a (Step, Convergence))>,
}

/// What all rounds of an operating point have in common.
struct Setting<'a> {
    c: &'a Configuration<'a>,
    motion: &'a Motion,
    operation: &'a Operation,
    sigma: &'a [Option<i8>],
}

/// One equilibrium with everything it was solved from.
struct Branch<'a> {
    c: Configuration<'a>,
    problem: Loads,
    equilibrium: Equilibrium,
    solution: Solution,
    drags: Vec<Drag>,
    computed: Option<(Step, Convergence)>,
}

/// Every equilibrium of an operating point.
struct Balance<'a> {
    branches: Vec<Branch<'a>>,
    certificate: Certificate,
    continuum: bool,
    /// Where drags act: whether a load is driven without them.
    driven: Option<bool>,
}

/// A train with the losses of one step, solved.
struct Solved<'a> {
    c: Configuration<'a>,
    problem: Loads,
    equilibrium: Equilibrium,
    answer: Answer,
}

impl<'a> Setting<'a> {
    /// Solves with the losses of a step; `Err` where the loads make no question.
    fn solve(&self, step: &Step, drags: &[Drag]) -> Result<Option<Solved<'a>>, Diagnostics> {
        let c = step.configure(self.c);
        let problem = Loads::new(&c, self.operation, self.motion, drags)?;
        let equilibrium = match Equilibrium::new(&c, self.sigma, &problem.open, &problem.loaded) {
            Ok(equilibrium) => equilibrium,
            // A drag acts on a part that no torque held or balanced before.
            Err(Unsolvable::MissingLoads(n)) => return Err(wrong_loads(&c, self.operation, &problem, true, n)),
            Err(Unsolvable::TooManyLoads(n)) => return Err(wrong_loads(&c, self.operation, &problem, false, n)),
            Err(_) => return Ok(None),
        };
        let answer = equilibrium.solve(&problem.torques);
        Ok(Some(Solved { c, problem, equilibrium, answer }))
    }

    fn flow(&self, s: &Solved<'_>, solution: &Solution, drags: &[Drag]) -> Flow {
        let scale = std::f64::consts::PI.powi(s.problem.pi_power.into());
        Flow::new(&s.c, self.motion, solution, scale, &s.problem.externals, drags)
    }

    /// Brings torques and computed losses into agreement, for every equilibrium.
    fn balance(&self, physics: &Physics<'_>) -> Result<Balance<'a>, Diagnostics> {
        let nothing = |certificate| Balance { branches: vec![], certificate, continuum: false, driven: Some(false) };
        // The forces of the train without computed losses are the start.
        let lossless = Step::lossless(self.c.train);
        let Some(first) = self.solve(&lossless, &[])? else { return Ok(nothing(Certificate::Undecided)) };
        let start = match first.answer.solutions.first() {
            Some(solution) => physics.step(&self.flow(&first, solution, &[]), self.motion),
            None => lossless,
        };
        let Some(second) = self.solve(&start, &start.drags)? else { return Ok(nothing(Certificate::Undecided)) };
        let mut certificate = second.answer.certificate;
        let mut branches: Vec<Branch<'a>> = Vec::new();
        let mut continuum = false;
        let mut driven = None;
        for k in 0..second.answer.solutions.len() {
            let mut drivers = second.answer.solutions[k].driver.clone();
            let mut failed = None;
            let agreed = physics.agree(self.motion, start.clone(), |step| {
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
            if let Some(wrong) = failed {
                return Err(wrong);
            }
            let Some((step, (solved, at), _, convergence)) = agreed else { continue };
            let Solved { c, problem, equilibrium, answer } = solved;
            if answer.certificate != certificate && !answer.certificate.unique_for_every_load() {
                certificate = answer.certificate;
            }
            continuum |= answer.continuum;
            let solution = answer.solutions[at].clone();
            if branches.iter().any(|b| b.solution.driver == solution.driver) {
                continue;
            }
            // Whether a load would be driven without the drags: only then do the teeth not lock it.
            let free = self.solve(&step, &[])?;
            let drives = free.is_some_and(|s| {
                s.problem.torques.iter().all(Rational::is_zero)
                    || s.answer.solutions.iter().any(|x| {
                        let flow = self.flow(&s, x, &[]);
                        // At rest no power runs at all.
                        flow.output_power > 0.0 || flow.input_power <= 0.0
                    })
            });
            driven = Some(driven.unwrap_or(false) || drives);
            let drags = step.drags.clone();
            branches.push(Branch { c, problem, equilibrium, solution, drags, computed: Some((step, convergence)) });
        }
        if branches.is_empty() {
            return Ok(nothing(certificate));
        }
        Ok(Balance { branches, certificate, continuum, driven })
    }
}

/// Warnings where laws were used outside their ranges: one for each quantity of a law.
fn outside_laws(all: Vec<Extrapolation>, place: &str, title: &str, diagnostics: &mut Diagnostics) {
    let mut told: Vec<(&str, &str, &str)> = Vec::new();
    for x in &all {
        let key = (x.family, x.law, x.outside.symbol);
        if told.contains(&key) {
            continue;
        }
        told.push(key);
        let same = |y: &&Extrapolation| (y.family, y.law, y.outside.symbol) == key;
        let mut at: Vec<String> = Vec::new();
        for y in all.iter().filter(same) {
            let text = format!("{} ({})", y.at, readable(y.outside.value, y.outside.unit));
            if !at.contains(&text) {
                at.push(text);
            }
        }
        let (low, high) = x.outside.range;
        let range = match (low.is_finite() && low > 0.0, high.is_finite()) {
            (true, true) => format!("from {} to {}", readable(low, x.outside.unit), readable(high, x.outside.unit)),
            (false, _) => format!("up to {}", readable(high, x.outside.unit)),
            (true, false) => format!("from {}", readable(low, x.outside.unit)),
        };
        let message = format!(
            "{title}: {} = {} of {} is outside its range, {} {range}",
            x.family,
            x.law,
            at.join(", "),
            x.outside.symbol,
        );
        diagnostics.push(Diagnostic::new(Code::OutsideLaw, place, message));
    }
}

/// A value with a unit that people use, four digits.
fn readable(value: f64, unit: &str) -> String {
    let (factor, unit) = match unit {
        "m" if value.abs() < 1e-3 => (1e6, "µm"),
        "m" => (1e3, "mm"),
        "N/m" => (1e-3, "N/mm"),
        "Pa" if value.abs() >= 1e5 => (1e-6, "MPa"),
        "Pa s" => (1e3, "mPa s"),
        "m^2/s" | "m²/s" => (1e6, "mm²/s"),
        "rad/s" => (30.0 / std::f64::consts::PI, "rpm"),
        "-" => (1.0, ""),
        other => (1.0, other),
    };
    let x = value * factor;
    let digits = if x == 0.0 || !x.is_finite() { 0 } else { (3 - x.abs().log10().floor() as i32).clamp(0, 9) as usize };
    let mut text = format!("{x:.digits$}");
    if text.contains('.') {
        text = text.trim_end_matches('0').trim_end_matches('.').to_owned();
    }
    if unit.is_empty() { text } else { format!("{text} {unit}") }
}

impl Frame<'_> {
    fn scale(&self) -> f64 {
        std::f64::consts::PI.powi(self.problem.pi_power.into())
    }

    fn flow(&self, s: &Solution) -> Flow {
        Flow::new(self.c, self.motion, s, self.scale(), &self.problem.externals, self.drags)
    }

    fn solution(&self, s: &Solution) -> SolutionReport {
        let flow = self.flow(s);
        let train = self.c.train;
        let held: Vec<MemberId> = self.held();
        let members = (1..train.members.len()).map(|m| {
            let id = MemberId(m);
            let speed = self.motion.si(id);
            let torque = flow.torques[m];
            let power = match (torque, speed) {
                (Some(t), Some(w)) => Some(t * w),
                (None, Some(0.0)) | (Some(0.0), None) => Some(0.0),
                _ => None,
            };
            let real = power.is_some_and(|p| p.abs() > 1e-12 * flow.input_power.max(flow.output_power));
            let at_rest = self.motion.speeds[m].as_ref().is_some_and(Rational::is_zero);
            let role = match power {
                _ if held.contains(&id) => Role::Fixed,
                Some(p) if real && p > 0.0 => Role::Input,
                Some(p) if real && p < 0.0 => Role::Output,
                _ if at_rest && torque.is_none_or(|t| t != 0.0) => Role::Fixed,
                _ => Role::Idle,
            };
            let carrier = (train.members[m].kind == MemberKind::Planet || self.c.inner[m])
                .then(|| train.meshes.iter().find(|x| x.gears.iter().any(|g| g.member == id)).map(|x| x.carrier))
                .flatten();
            let report = MemberReport {
                speed_rad_s: speed,
                carrier: carrier.filter(|c| *c != FRAME).map(|c| train.member_name(c).to_owned()),
                relative_speed_rad_s: carrier.and_then(|c| {
                    let (w, c) = (self.motion.speeds[m].as_ref()?, self.motion.speeds[c.0].as_ref()?);
                    Some((w - c).to_f64() * std::f64::consts::PI.powi(self.motion.pi_power.into()))
                }),
                torque_n_m: torque.map(|t| t + 0.0),
                power_w: power.map(|p| p + 0.0),
                role,
            };
            (train.members[m].name.clone(), report)
        });
        let members = Named(members.collect());
        let meshes = flow.meshes.iter().map(|f| {
            let mesh = &train.meshes[f.mesh.0];
            let report = MeshReport {
                driver: f.driver.map(|d| train.member_name(mesh.gears[d].member).to_owned()),
                relative_speed_rad_s: f.relative_speeds[f.driver.unwrap_or(0)],
                potential_power_w: f.potential_power,
                efficiency: match self.physics {
                    Some((physics, (step, _))) if f.potential_power > 0.0 => {
                        1.0 - physics.tooth_loss(step, f.mesh.index(), &flow) / f.potential_power
                    }
                    _ => f.efficiency,
                },
                loss_w: match self.physics {
                    Some((physics, (step, _))) => physics.tooth_loss(step, f.mesh.index(), &flow),
                    None => f.loss,
                },
                first_torque_n_m: f.torques[0] + 0.0,
                second_torque_n_m: f.torques[1] + 0.0,
                carrier_torque_n_m: f.torques[2] + 0.0,
                count: mesh.count,
            };
            (mesh.name.clone(), report)
        });
        let meshes = Named(meshes.collect());
        let shift_elements = flow.ties.iter().map(|t| {
            let e = &train.shift_elements[t.element.0];
            let members = e.members.map(|m| train.member_name(m).to_owned());
            (e.name.clone(), ShiftElementReport { kind: e.kind, members, torque_n_m: t.torque.map(|t| t + 0.0) })
        });
        let all_dissipated = flow.input_power > 0.0 && flow.output_power <= 0.0;
        let exact = s.exact.as_ref().filter(|_| self.physics.is_none()).and_then(|f| self.exact_efficiency(s, f));
        let sources = self.physics.map(|(p, (step, _))| p.sources(step, &flow)).unwrap_or_default();
        let losses_w = match self.physics {
            Some(_) => Losses::of(&sources),
            None => Losses { mesh: flow.loss, ..Losses::default() },
        };
        let efficiency = if flow.input_power <= 0.0 {
            None
        } else if let Some(e) = &exact {
            Some(e.to_f64())
        } else if flow.loss == 0.0 {
            Some(1.0)
        } else {
            Some((flow.output_power / flow.input_power).clamp(0.0, 1.0))
        };
        SolutionReport {
            efficiency,
            efficiency_exact: exact,
            all_dissipated,
            input_power_w: flow.input_power,
            output_power_w: flow.output_power,
            loss_w: flow.loss,
            power_residual_w: flow.residual,
            members,
            meshes,
            shift_elements: Named(shift_elements.collect()),
            losses_w,
            sources,
            contacts: Named(self.physics.map(|(p, (step, _))| p.contacts(step, &flow)).unwrap_or_default()),
            bearings: Named(self.physics.map(|(p, (step, _))| p.bearings(step, &flow)).unwrap_or_default()),
            drags: self.physics.map(|(p, (step, _))| p.drags(step, &flow)).unwrap_or_default(),
            convergence: self.physics.map(|(_, (_, convergence))| *convergence),
            recirculation: flow
                .circulations
                .iter()
                .map(|r| CirculationReport {
                    power_w: r.power,
                    share_of_input: r.power / flow.input_power,
                    path: r.path.clone(),
                })
                .collect(),
            margin: self.margin(s, &flow),
            stiction: self.stiction(s, &flow),
        }
    }

    /// Members held by a brake, by the operation, or tied to something that is.
    fn held(&self) -> Vec<MemberId> {
        let train = self.c.train;
        let brakes = self.c.engaged.iter().flat_map(|e| {
            let m = train.shift_elements[e.0].members;
            if m.contains(&FRAME) { m.to_vec() } else { vec![] }
        });
        brakes.chain(self.operation.fixed.iter().copied()).filter(|m| *m != FRAME).collect()
    }

    /// Output over input power in rationals.
    fn exact_efficiency(&self, s: &Solution, forces: &[Rational]) -> Option<Rational> {
        let (mut power_in, mut power_out) = (Rational::ZERO, Rational::ZERO);
        let mut add = |power: Rational| match power.sign() {
            1 => power_in += power,
            -1 => power_out += -power,
            _ => {}
        };
        for x in &self.problem.externals {
            let speed = self.motion.speeds[x.member.0].as_ref()?;
            let torque = match (self.problem.given.iter().find(|(m, _)| *m == x.member), self.c.node(x.member)) {
                (Some((_, t)), _) => t.clone(),
                (None, Some(n)) => &torque_exact(self.c, self.equilibrium, s, forces, n) - &self.problem.torques[n],
                (None, None) => continue,
            };
            add(speed * &torque);
        }
        (power_in.sign() > 0).then(|| power_out / power_in)
    }

    fn margin(&self, s: &Solution, flow: &Flow) -> Margin {
        let (c, train) = (self.c, self.c.train);
        let meshes_of = |e: usize| -> Vec<String> {
            c.elements[e].links.iter().map(|l| train.meshes[l.mesh.0].name.clone()).collect()
        };
        let mut margin = Margin::default();

        // Torques: with one load all forces scale with it, so only two or more have a boundary.
        let given: Vec<(MemberId, usize, f64)> =
            self.problem.given.iter().filter_map(|(m, t)| c.node(*m).map(|n| (*m, n, t.to_f64()))).collect();
        let largest = given.iter().fold(0.0f64, |a, g| a.max(g.2.abs()));
        if given.len() > 1 && largest > 0.0 {
            let nodes: Vec<usize> = given.iter().map(|g| g.1).collect();
            let mut best: Option<(f64, Boundary)> = None;
            for (e, row) in self.equilibrium.sensitivity(s, &nodes).unwrap_or_default() {
                if s.driver[e].is_none() {
                    continue;
                }
                for (k, &(member, _, value)) in given.iter().enumerate().filter(|(k, _)| row[*k] != 0.0) {
                    let change = -s.forces[e] / row[k];
                    if best.as_ref().is_none_or(|b| change.abs() < b.0) {
                        let boundary = Boundary {
                            member: train.member_name(member).to_owned(),
                            value: value * self.scale(),
                            boundary: sum(value, change) * self.scale(),
                            mesh: meshes_of(e).join(", "),
                        };
                        best = Some((change.abs(), boundary));
                    }
                }
            }
            margin.torque = best.map(|b| b.1);
        }

        // Speeds: likewise only with two freedoms or more.
        let prescribed: Vec<MemberId> = self.operation.speeds.iter().map(|(m, _)| *m).collect();
        if prescribed.len() > 1 {
            let transfer = c.transfer(&prescribed);
            let mut best: Option<(f64, Boundary)> = None;
            for (j, e) in c.elements.iter().enumerate().filter(|(j, _)| s.driver[*j].is_some()) {
                let (Some(p), Some(q)) = (&transfer.speeds[e.p.0], &transfer.speeds[e.carrier.0]) else { continue };
                let relative = flow.speeds[e.p.0] - flow.speeds[e.carrier.0];
                for (k, &member) in prescribed.iter().enumerate() {
                    let factor = (&p[k] - &q[k]).to_f64();
                    if factor == 0.0 {
                        continue;
                    }
                    let change = -relative / factor;
                    if best.as_ref().is_none_or(|b| change.abs() < b.0) {
                        let value = flow.speeds[member.0];
                        let boundary = Boundary {
                            member: train.member_name(member).to_owned(),
                            value,
                            boundary: sum(value, change),
                            mesh: meshes_of(j).join(", "),
                        };
                        best = Some((change.abs(), boundary));
                    }
                }
            }
            margin.speed = best.map(|b| b.1);
        }

        // Locking: with the loads at the outputs given, the input's torque grows without bound.
        if c.degrees_of_freedom() == 1 && flow.output_power > 0.0 {
            let inputs: Vec<usize> = self
                .problem
                .externals
                .iter()
                .filter(|x| flow.torques[x.member.0].is_some_and(|t| t * flow.speeds[x.member.0] > 0.0))
                .filter_map(|x| c.node(x.member))
                .collect();
            let outputs: Vec<usize> = self
                .problem
                .externals
                .iter()
                .filter(|x| flow.torques[x.member.0].is_some_and(|t| t * flow.speeds[x.member.0] < 0.0))
                .filter_map(|x| c.node(x.member))
                .collect();
            let sigma: Vec<_> = c.elements.iter().map(|e| c.sigma(e, self.motion)).collect();
            if let ([input], false) = (&inputs[..], outputs.iter().any(|o| inputs.contains(o)))
                && let Ok(resisting) = Equilibrium::new(c, &sigma, &[*input], &outputs)
                && let Some(s) = resisting.same_pattern(s)
            {
                margin.lock = resisting
                    .lock_thresholds(&s)
                    .into_iter()
                    .map(|(e, threshold)| LockMargin {
                        meshes: meshes_of(e),
                        efficiency: match s.driver[e] {
                            Some(false) => c.elements[e].backward.to_f64(),
                            _ => c.elements[e].forward.to_f64(),
                        },
                        threshold,
                    })
                    .min_by(|a, b| (a.efficiency - a.threshold).total_cmp(&(b.efficiency - b.threshold)));
                margin.lock_loss_factor = resisting.lock_factor(&s);
            }
        }
        margin
    }

    /// Ranges that friction in loaded meshes at rest leaves open: every vertex of their ρ-box.
    fn stiction(&self, s: &Solution, flow: &Flow) -> Vec<StictionRange> {
        let c = self.c;
        let stuck: Vec<usize> = (0..c.elements.len())
            .filter(|&j| {
                let e = &c.elements[j];
                let lossy = e.forward != Rational::ONE || e.backward != Rational::ONE;
                lossy && s.forces[j] != 0.0 && c.sigma(e, self.motion) == Some(0)
            })
            .collect();
        if stuck.is_empty() {
            return vec![];
        }
        if stuck.len() > MOST_STUCK {
            let what = format!("{} loaded meshes at rest: too many to bound; any torque behind them", stuck.len());
            return vec![StictionRange { what, low: None, high: None }];
        }
        let mut low: Vec<Option<f64>> = flow.torques.clone();
        let mut high = low.clone();
        let efficiency = |f: &Flow| if f.input_power > 0.0 { f.output_power / f.input_power } else { 0.0 };
        let mut eta = (efficiency(flow), efficiency(flow));
        for mask in 0..1u32 << stuck.len() {
            let choice: Vec<(usize, f64)> = stuck
                .iter()
                .enumerate()
                .map(|(bit, &j)| {
                    let e = &c.elements[j];
                    (j, if mask >> bit & 1 == 0 { e.forward.to_f64() } else { 1.0 / e.backward.to_f64() })
                })
                .collect();
            let Some(shifted) = self.equilibrium.with_rho(s, &choice, &self.problem.torques) else { continue };
            let f = stuck_flow(self, &shifted);
            for m in 0..low.len() {
                if let (Some(l), Some(h), Some(t)) = (low[m], high[m], f[m]) {
                    (low[m], high[m]) = (Some(l.min(t)), Some(h.max(t)));
                }
            }
            // Efficiency from the torques of the terminals.
            let (mut power_in, mut power_out) = (0.0, 0.0);
            for (m, t) in f.iter().enumerate() {
                let p = t.unwrap_or(0.0) * flow.speeds[m];
                if p > 0.0 { power_in += p } else { power_out -= p }
            }
            if power_in > 0.0 {
                eta = (eta.0.min(power_out / power_in), eta.1.max(power_out / power_in));
            }
        }
        let size = flow.torques.iter().flatten().fold(0.0f64, |a, t| a.max(t.abs()));
        let mut all = Vec::new();
        if eta.1 - eta.0 > 1e-9 {
            all.push(StictionRange { what: "the efficiency".into(), low: Some(eta.0), high: Some(eta.1) });
        }
        for m in 1..low.len() {
            if let (Some(l), Some(h)) = (low[m], high[m])
                && h - l > 1e-9 * size
            {
                let what = format!("the torque on {} in N m", c.train.members[m].name);
                all.push(StictionRange { what, low: Some(l), high: Some(h) });
            }
        }
        all
    }
}

/// Most elements at rest whose friction is varied, two values each.
const MOST_STUCK: usize = 8;

/// External torques with other ρ in stuck elements. The mesh walk of [`Flow`] takes ρ from the
/// driver, so the torques are summed here from the elements.
fn stuck_flow(frame: &Frame<'_>, s: &Solution) -> Vec<Option<f64>> {
    let c = frame.c;
    let scale = frame.scale();
    let demand: Vec<f64> = crate::power_flow::demand(c, s).iter().map(|x| x * scale).collect();
    let mut external = vec![0.0; demand.len()];
    for x in &frame.problem.externals {
        external[x.member.0] = match (x.torque, c.node(x.member)) {
            (Some(t), _) => t,
            (None, Some(n)) => (torque(c, s, n) - frame.problem.torques[n].to_f64()) * scale,
            (None, None) => 0.0,
        };
    }
    let (_, reactions) = crate::power_flow::ties(c, &demand, &external);
    reactions.into_iter().zip(&external).map(|(r, x)| r.map(|r| r + x)).collect()
}

/// A one-way clutch can only push one way.
fn one_way_torques(train: &Train, s: &SolutionReport, place: &str, title: &str, diagnostics: &mut Diagnostics) {
    for (name, e) in s.shift_elements.iter().filter(|(_, e)| e.kind == ShiftElementKind::OneWay) {
        let blocks = train.shift_elements.iter().find(|x| x.name == *name).map_or(-1, |x| x.blocks);
        if e.torque_n_m.is_some_and(|t| t * f64::from(blocks) > 0.0) {
            diagnostics.push(
                Diagnostic::new(
                    Code::OneWay,
                    place,
                    format!(
                        "{title}: the one-way clutch {name} would have to hold {} against its free direction ({} N m); \
                         it overruns instead and the torques shown do not arise",
                        e.members[0],
                        short(e.torque_n_m.unwrap_or(0.0))
                    ),
                )
                .hint("analyse the state without it, or engage a brake beside it"),
            );
        }
    }
}

/// Warns when a prescribed value lies within a percent of a boundary.
fn near_boundary(s: &SolutionReport, place: &str, title: &str, diagnostics: &mut Diagnostics) {
    let near = |b: &Boundary| (b.boundary - b.value).abs() <= 0.01 * b.value.abs().max(b.boundary.abs());
    for (b, what, unit, factor, effect) in [
        (&s.margin.torque, "torque", "N m", 1.0, "unloads"),
        (&s.margin.speed, "speed", "rpm", 30.0 / std::f64::consts::PI, "stops the relative motion in"),
    ] {
        if let Some(b) = b.as_ref().filter(|b| near(b)) {
            diagnostics.push(Diagnostic::new(
                Code::NearBoundary,
                place,
                format!(
                    "{title}: a {what} of {} instead of {} {unit} at {} {effect} {}",
                    short(b.boundary * factor),
                    short(b.value * factor),
                    b.member,
                    b.mesh
                ),
            ));
        }
    }
}
