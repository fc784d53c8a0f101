//! The shift table: exact ratio, and efficiency driving and coasting, of every state.

use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::exact::Rational;
use crate::kinematics::{Configuration, Motion, Ratio, Transfer};
use crate::power_flow::{self, demand};
use crate::statics::{Answer, Certificate, Equilibrium, Solution, Unsolvable, torque};
use crate::train::{MemberId, ShiftElementId, ShiftElementKind, Train};

use super::words::{element_names, names};
use super::{Direction, NameMap, StateReport, Verdict, Why};

/// The row of a state; `None` when the train has no input and output.
pub(super) fn row(
    train: &Train,
    state: Option<usize>,
    engaged: &[ShiftElementId],
    name: &str,
    diagnostics: &mut Diagnostics,
) -> Option<StateReport> {
    let place = state.map_or(String::new(), |k| format!("state[{k}]"));
    let (input, output) = match train.ends(state) {
        [Some(input), Some(output)] if input != output => (input, output),
        _ => {
            if state.is_some() {
                let text = format!("state {name}: input and output are not two different members, so it has no ratio");
                diagnostics.push(
                    Diagnostic::new(Code::NothingAsked, &place, text)
                        .hint("name two `terminals`, or `input` and `output`, for the train or the state"),
                );
            }
            return None;
        }
    };
    let c = Configuration::new(train, engaged, &[], &[]);
    let forward = c.transfer(&[input]);
    let ratio = forward.ratio(output);
    let name_of = |m: MemberId| train.member_name(m).to_owned();
    let (exact, no_ratio) = match &ratio {
        Ratio::Exact(r) => (Some(r.clone()), None),
        Ratio::OutputAtRest => (None, Some(Why::OutputAtRest { output: name_of(output), input: name_of(input) })),
        Ratio::InputLocked => (None, Some(locked(&c, input))),
        Ratio::Undetermined => (None, Some(free(&c, &forward, input, output))),
    };
    // A variator sets what the gears leave open.
    let varied = ratio == Ratio::Undetermined && !train.variators.is_empty();
    // As drawn a train may be meant for several speeds; one that nothing can turn is not.
    let told = state.is_some() || matches!(no_ratio, Some(Why::NothingTurns { .. }));
    if let (Some(text), true, false) = (&no_ratio, told, varied) {
        let code = if ratio == Ratio::Undetermined { Code::Undetermined } else { Code::KinematicallyLocked };
        let of = if state.is_some() { format!("state {name}: ") } else { String::new() };
        diagnostics.push(Diagnostic::new(code, &place, format!("{of}{text}")));
    }
    // A ratio that floating point cannot hold stays a fraction; nothing else can be told.
    let beyond = exact.as_ref().is_some_and(|r| !(1e-300..1e300).contains(&r.to_f64().abs()));
    let redundant = c.redundant();
    for group in &redundant {
        let meshes: Vec<_> = group.iter().map(|m| train.meshes[m.0].name.as_str()).collect();
        diagnostics.push(
            Diagnostic::new(
                Code::Indeterminate,
                &place,
                format!("{name}: the meshes {} constrain each other: statically indeterminate", meshes.join(", ")),
            )
            .hint("remove one of them, or take one of its members out of the constraint"),
        );
    }
    let (drive, coast) = match &exact {
        Some(_) if beyond => {
            let none = Direction::without(Verdict::Undetermined, Why::RatioTooLarge);
            (none.clone(), none)
        }
        Some(ratio) if redundant.is_empty() => {
            let backward = forward.seen_from_other(ratio);
            (direction(&c, &forward, [input, output], input), direction(&c, &backward, [output, input], input))
        }
        Some(_) => {
            let none = Direction::without(Verdict::Undetermined, Why::Indeterminate);
            (none.clone(), none)
        }
        None => {
            let v = if ratio == Ratio::Undetermined { Verdict::Undetermined } else { Verdict::Locked };
            let none = Direction::without(v, no_ratio.clone().expect("without a ratio there is a reason"));
            (none.clone(), none)
        }
    };
    for (way, from, to, d) in [("driving", input, output, &drive), ("coasting", output, input, &coast)] {
        if exact.is_none() {
            continue;
        }
        let (from, to) = (train.member_name(from), train.member_name(to));
        match d.verdict {
            Verdict::Locked => diagnostics.push(Diagnostic::new(
                Code::SelfLocking,
                &place,
                format!("{name}: locks {way}: friction lets {from} drive no load at {to}"),
            )),
            Verdict::Multiple => {
                let all: Vec<_> = d.efficiencies.iter().map(|e| format!("{e:.4}")).collect();
                diagnostics.push(Diagnostic::new(
                    Code::SeveralSolutions,
                    &place,
                    format!("{name}: {way} has several equilibria, with efficiencies {}", all.join(" and ")),
                ));
            }
            _ => {}
        }
        if d.certificate.is_some_and(|c| c.method == Certificate::Undecided) {
            diagnostics.push(Diagnostic::new(
                Code::NotEnumerated,
                &place,
                format!("{name}: {way}: uniqueness could not be decided"),
            ));
        }
    }
    if exact.is_some() {
        one_way_speeds(&c, &forward, &place, name, diagnostics);
    }
    Some(StateReport {
        input: train.member_name(input).to_owned(),
        output: train.member_name(output).to_owned(),
        value: exact.as_ref().filter(|_| !beyond).map(Rational::to_f64),
        exact,
        no_ratio: no_ratio.map(|why| why.to_string()),
        step: None,
        engaged: element_names(train, engaged),
        degrees_of_freedom: c.degrees_of_freedom(),
        drive,
        coast,
        at_load: None,
    })
}

/// Ratio of each state over that of the next one.
pub(super) fn steps(ratios: &mut NameMap<StateReport>) {
    for k in 1..ratios.0.len() {
        let [(_, a), (_, b)] = &ratios.0[k - 1..=k] else { unreachable!("two rows") };
        if let (Some(i), Some(j), true) = (a.value, b.value, (&a.input, &a.output) == (&b.input, &b.output)) {
            ratios.0[k - 1].1.step = (i * j > 0.0).then_some(i / j);
        }
    }
}

impl Direction {
    fn without(verdict: Verdict, why: Why) -> Self {
        Self {
            verdict,
            efficiency: None,
            efficiency_exact: None,
            efficiencies: vec![],
            certificate: None,
            reason: Some(why.to_string()),
            why: Some(why),
        }
    }
}

/// A load at one end of a train with one freedom, driven from the other.
pub(super) struct Drive {
    pub motion: Motion,
    /// Speeds of the two ends.
    pub speeds: [Rational; 2],
    /// Where power enters and leaves, and the equilibria under a load of one; none where both ends turn as one.
    pub balance: Option<DriveBalance>,
}

/// The equilibria of a drive.
pub(super) struct DriveBalance {
    pub node: usize,
    pub equilibrium: Equilibrium,
    pub loads: Vec<Rational>,
    pub answer: Answer,
}

impl Drive {
    /// Power from `from`, which turns forward, to a resisting load of one at `to`: the load is given, what drives it is
    /// found.
    pub fn new(c: &Configuration<'_>, from: MemberId, to: MemberId) -> Result<Self, (Verdict, Why)> {
        Self::at(c, &c.transfer(&[from]), from, to)
    }

    /// The same, when the speeds over that of `from` are known.
    fn at(c: &Configuration<'_>, transfer: &Transfer, from: MemberId, to: MemberId) -> Result<Self, (Verdict, Why)> {
        let name = |m: MemberId| c.train.member_name(m).to_owned();
        let motion = Motion {
            speeds: transfer.speeds.iter().map(|s| s.as_ref().map(|w| w[0].clone())).collect(),
            pi_power: 0,
            is_exact: true,
            deviation: None,
        };
        let (Some(node), Some(node_to)) = (c.node(from), c.node(to)) else {
            return Err((Verdict::Locked, Why::CannotTurn { member: name(from) }));
        };
        let (Some(w_from), Some(w_to)) = (&motion.speeds[from.0], &motion.speeds[to.0]) else {
            return Err((Verdict::Undetermined, Why::SpeedsNotDetermined));
        };
        if !transfer.conflicts.is_empty() || w_to.is_zero() || w_from.is_zero() {
            return Err((Verdict::Locked, Why::CannotDrive { from: name(from), to: name(to) }));
        }
        let speeds = [w_from.clone(), w_to.clone()];
        if node == node_to {
            return Ok(Self { motion, speeds, balance: None });
        }
        let sigma: Vec<_> = c.elements.iter().map(|e| c.sigma(e, &motion)).collect();
        let equilibrium = Equilibrium::new(c, &sigma, &[node], &[node_to])
            .map_err(|why| (Verdict::Undetermined, unsolvable(&why)))?;
        let mut loads = vec![Rational::ZERO; c.nodes];
        loads[node_to] = Rational::from(-i64::from(w_to.sign()));
        let answer = equilibrium.solve(&loads);
        Ok(Self { motion, speeds, balance: Some(DriveBalance { node, equilibrium, loads, answer }) })
    }
}

/// What can be said of power from `from` to a resisting load at `to`, the speeds over that of `from` being known. The
/// train's input turns forward.
fn direction(c: &Configuration<'_>, transfer: &Transfer, [from, to]: [MemberId; 2], input: MemberId) -> Direction {
    let train = c.train;
    let name = |m: MemberId| train.member_name(m).to_owned();
    let Drive { speeds: [w_from, w_to], balance, .. } = match Drive::at(c, transfer, from, to) {
        Ok(drive) => drive,
        Err((verdict, why)) => return Direction::without(verdict, why),
    };
    let forward = if from == input { f64::from(w_from.sign()) } else { f64::from(w_to.sign()) };
    let load = -f64::from(w_to.sign());
    let Some(DriveBalance { node: node_from, equilibrium, loads, answer }) = balance else {
        if let Some(clutch) = overrunning(c, &vec![0.0; train.members.len()], [(from, -load), (to, load)], forward) {
            return Direction::without(Verdict::Undetermined, Why::Overruns { clutch });
        }
        return Direction {
            verdict: Verdict::Unique,
            efficiency: Some(1.0),
            efficiency_exact: Some(Rational::ONE),
            efficiencies: vec![1.0],
            certificate: Some(Certificate::SpectralRadius.into()),
            reason: None,
            why: None,
        };
    };
    let w_in = w_from.to_f64();
    // Only then is it worth the torques of all shift elements.
    if has_one_way(c) {
        for s in &answer.solutions {
            let ends = [(from, torque(c, s, node_from)), (to, load)];
            if let Some(clutch) = overrunning(c, &demand(c, &s.forces, &s.rho), ends, forward) {
                return Direction::without(Verdict::Undetermined, Why::Overruns { clutch });
            }
        }
    }
    let mut efficiencies: Vec<f64> = answer
        .solutions
        .iter()
        .filter_map(|s| {
            let (torque, sign) = equilibrium.balancing_torque(c, s, &loads, node_from);
            let power = torque * w_in;
            // Without a driver nothing is lost, whatever the round-off says.
            let lossless = s.driver.iter().all(Option::is_none);
            (sign * w_from.sign() > 0).then(|| if lossless { 1.0 } else { w_to.to_f64().abs() / power })
        })
        .collect();
    efficiencies.sort_by(f64::total_cmp);
    let undecided = answer.certificate == Certificate::Undecided;
    let (v, why) = match efficiencies[..] {
        _ if undecided => (Verdict::Undetermined, Some(Why::TooManyMeshes)),
        [] => (Verdict::Locked, Some(Why::FrictionLocks { from: name(from), to: name(to) })),
        _ if !answer.stretches.is_empty() => (Verdict::Multiple, Some(Why::Threshold { ranges: vec![] })),
        [_] => (Verdict::Unique, None),
        _ => (Verdict::Multiple, Some(Why::Several)),
    };
    let is_unique = v == Verdict::Unique;
    let power_in = |s: &Solution| equilibrium.exact_torque(c, s, &loads, node_from).map(|t| t * w_from.clone());
    let exact = |s: &Solution| Some(w_to.abs() / power_in(s).filter(|p| p.sign() > 0)?);
    Direction {
        verdict: v,
        efficiency: match efficiencies[..] {
            [e] if is_unique => Some(e),
            _ => None,
        },
        efficiency_exact: answer.solutions.iter().find_map(exact).filter(|_| is_unique && c.is_exact()),
        efficiencies,
        certificate: Some(answer.certificate.into()),
        reason: why.as_ref().map(ToString::to_string),
        why,
    }
}

fn has_one_way(c: &Configuration<'_>) -> bool {
    c.engaged.iter().any(|e| c.train.shift_elements[e.0].kind == ShiftElementKind::OneWay)
}

/// A one-way clutch that would have to hold against its free direction, if there is one.
fn overrunning(c: &Configuration<'_>, demand: &[f64], ends: [(MemberId, f64); 2], forward: f64) -> Option<String> {
    let mut external = vec![0.0; demand.len()];
    ends.iter().for_each(|(m, t)| external[m.0] += t);
    let (ties, _) = power_flow::ties(c, demand, &external);
    ties.iter()
        .map(|t| (&c.train.shift_elements[t.element.0], t.torque))
        .find(|(e, torque)| {
            let against = torque.unwrap_or(0.0) * forward * f64::from(e.blocks);
            e.kind == ShiftElementKind::OneWay && against > 1e-12
        })
        .map(|(e, _)| e.name.clone())
}

/// What stands in the way of an equilibrium problem.
fn unsolvable(unsolvable: &Unsolvable) -> Why {
    match unsolvable {
        Unsolvable::MissingLoads(_) => Why::LoadMissing,
        Unsolvable::TooManyLoads(_) => Why::LoadNotCarried,
        Unsolvable::Indeterminate => Why::Indeterminate,
        Unsolvable::UndeterminedSpeed => Why::RelativeSpeedNotDetermined,
    }
}

fn locked(c: &Configuration<'_>, input: MemberId) -> Why {
    let train = c.train;
    let engaged = element_names(train, &c.engaged);
    match c.degrees_of_freedom() {
        0 => Why::NothingTurns { engaged },
        _ => Why::InputLocked {
            input: train.member_name(input).to_owned(),
            engaged,
            locked: names(train, c.locked_members()),
        },
    }
}

fn free(c: &Configuration<'_>, transfer: &Transfer, input: MemberId, output: MemberId) -> Why {
    let train = c.train;
    let loose = (1..train.members.len()).map(MemberId).filter(|m| transfer.speeds[m.0].is_none() && !c.inner[m.0]);
    Why::SpeedNotSettled {
        freedoms: c.degrees_of_freedom(),
        input: train.member_name(input).to_owned(),
        output: train.member_name(output).to_owned(),
        open: names(train, loose),
    }
}

/// One-way clutches that are not engaged must not turn the way they block.
fn one_way_speeds(c: &Configuration<'_>, transfer: &Transfer, place: &str, name: &str, diagnostics: &mut Diagnostics) {
    let train = c.train;
    let open = (0..train.shift_elements.len()).map(ShiftElementId).filter(|e| !c.engaged.contains(e));
    let elements = open.filter(|e| train.shift_elements[e.0].kind == ShiftElementKind::OneWay);
    for id in elements {
        let element = &train.shift_elements[id.0];
        let [a, b] = element.members.map(|m| transfer.speeds[m.0].as_ref().map(|w| w[0].clone()));
        if let (Some(a), Some(b)) = (a, b)
            && a.cmp(&b) as i8 == element.blocks
        {
            diagnostics.push(
                Diagnostic::new(
                    Code::OneWay,
                    place,
                    format!(
                        "state {name}: {} would turn in the direction that the one-way clutch {} blocks \
                             (relative speed {:.4} of the input's, input turning forward)",
                        train.member_name(element.members[0]),
                        element.name,
                        (&a - &b).to_f64()
                    ),
                )
                .hint("engage it in this state, or check which direction it blocks"),
            );
        }
    }
}
