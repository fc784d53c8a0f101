//! The shift table: exact ratio, and efficiency driving and coasting, of every state.

use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::exact::Rational;
use crate::kinematics::{Configuration, Motion, Ratio};
use crate::power_flow::{self, demand};
use crate::statics::{Certificate, Equilibrium, Unsolvable};
use crate::train::{FRAME, MemberId, ShiftElementId, ShiftElementKind, Train};

use super::{Direction, Named, StateReport, Verdict, element_names, names};

/// The row of a state; `None` when the train has no input and output.
pub(super) fn row(
    train: &Train,
    state: Option<usize>,
    engaged: &[ShiftElementId],
    name: &str,
    diagnostics: &mut Diagnostics,
) -> Option<StateReport> {
    let own = state.map(|k| &train.states[k]);
    let input = own.and_then(|s| s.input).or(train.input);
    let output = own.and_then(|s| s.output).or(train.output);
    let place = state.map_or(String::new(), |k| format!("state[{k}]"));
    let (input, output) = match (input, output) {
        (Some(input), Some(output)) if input != output => (input, output),
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
    let ratio = c.ratio(input, output);
    let (exact, no_ratio) = match &ratio {
        Ratio::Exact(r) => (Some(r.clone()), None),
        Ratio::OutputAtRest => {
            (None, Some(format!("{} stands still while {} turns", names(train, [output]), names(train, [input]))))
        }
        Ratio::InputLocked => (None, Some(locked(&c, input))),
        Ratio::Undetermined => (None, Some(free(&c, input, output))),
    };
    if let (Some(text), Some(_)) = (&no_ratio, state) {
        let code = if ratio == Ratio::Undetermined { Code::Undetermined } else { Code::KinematicallyLocked };
        diagnostics.push(Diagnostic::new(code, &place, format!("state {name}: {text}")));
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
            let none = || verdict(Verdict::Undetermined, "the ratio is beyond floating point");
            (none(), none())
        }
        Some(_) if redundant.is_empty() => (direction(&c, input, output, input), direction(&c, output, input, input)),
        Some(_) => {
            let none = || verdict(Verdict::Undetermined, "statically indeterminate");
            (none(), none())
        }
        None => {
            let v = if ratio == Ratio::Undetermined { Verdict::Undetermined } else { Verdict::Locked };
            let none = || verdict(v, no_ratio.as_deref().unwrap_or_default());
            (none(), none())
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
        one_way_speeds(&c, input, &place, name, diagnostics);
    }
    Some(StateReport {
        input: train.member_name(input).to_owned(),
        output: train.member_name(output).to_owned(),
        value: exact.as_ref().filter(|_| !beyond).map(Rational::to_f64),
        exact,
        no_ratio,
        step: None,
        engaged: element_names(train, engaged),
        degrees_of_freedom: c.degrees_of_freedom(),
        drive,
        coast,
    })
}

/// Ratio of each state over that of the next one.
pub(super) fn steps(ratios: &mut Named<StateReport>) {
    for k in 1..ratios.0.len() {
        let [(_, a), (_, b)] = &ratios.0[k - 1..=k] else { unreachable!("two rows") };
        if let (Some(i), Some(j), true) = (a.value, b.value, (&a.input, &a.output) == (&b.input, &b.output)) {
            ratios.0[k - 1].1.step = (i * j > 0.0).then_some(i / j);
        }
    }
}

fn verdict(verdict: Verdict, reason: &str) -> Direction {
    Direction { verdict, efficiency: None, efficiencies: vec![], certificate: None, reason: Some(reason.to_owned()) }
}

/// Power from `from` to a resisting load at `to`: the load is given, what drives it is found.
/// The train's input turns forward.
fn direction(c: &Configuration<'_>, from: MemberId, to: MemberId, input: MemberId) -> Direction {
    let train = c.train;
    let transfer = c.transfer(&[from]);
    let motion =
        Motion { speeds: transfer.speeds.iter().map(|s| s.as_ref().map(|w| w[0].clone())).collect(), pi_power: 0 };
    let (Some(node_from), Some(node_to)) = (c.node(from), c.node(to)) else {
        return verdict(Verdict::Locked, &format!("{} cannot turn", names(train, [from])));
    };
    let (Some(w_from), Some(w_to)) = (&motion.speeds[from.0], &motion.speeds[to.0]) else {
        return verdict(Verdict::Undetermined, "the speeds are not determined");
    };
    if !transfer.conflicts.is_empty() || w_to.is_zero() || w_from.is_zero() {
        return verdict(
            Verdict::Locked,
            &format!("{} cannot drive {}", train.member_name(from), train.member_name(to)),
        );
    }
    let forward = if from == input { f64::from(w_from.sign()) } else { f64::from(w_to.sign()) };
    let load = -f64::from(w_to.sign());
    if node_from == node_to {
        if let Some(name) = overrunning(c, &vec![0.0; train.members.len()], [(from, -load), (to, load)], forward) {
            return verdict(
                Verdict::Undetermined,
                &format!("the one-way clutch {name} overruns: no load is carried this way"),
            );
        }
        return Direction {
            verdict: Verdict::Unique,
            efficiency: Some(1.0),
            efficiencies: vec![1.0],
            certificate: Some(Certificate::SpectralRadius.into()),
            reason: None,
        };
    }
    let sigma: Vec<_> = c.elements.iter().map(|e| c.sigma(e, &motion)).collect();
    let equilibrium = match Equilibrium::new(c, &sigma, &[node_from], &[node_to]) {
        Ok(e) => e,
        Err(why) => return verdict(Verdict::Undetermined, unsolvable(&why)),
    };
    let mut loads = vec![Rational::ZERO; c.nodes];
    loads[node_to] = Rational::from(-i64::from(w_to.sign()));
    let answer = equilibrium.solve(&loads);
    let w_in = w_from.to_f64();
    for s in &answer.solutions {
        let ends = [(from, torque(c, s, node_from)), (to, load)];
        if let Some(name) = overrunning(c, &demand(c, s), ends, forward) {
            return verdict(
                Verdict::Undetermined,
                &format!("the one-way clutch {name} overruns: no load is carried this way"),
            );
        }
    }
    let mut efficiencies: Vec<f64> = answer
        .solutions
        .iter()
        .filter_map(|s| {
            let exact = s.exact.as_ref().map(|f| torque_exact(c, &equilibrium, s, f, node_from));
            let torque = exact.map_or_else(|| torque(c, s, node_from), |t| t.to_f64());
            let power = torque * w_in;
            // Without a driver nothing is lost, whatever the round-off says.
            let lossless = s.driver.iter().all(Option::is_none);
            (power > 0.0).then(|| if lossless { 1.0 } else { w_to.to_f64().abs() / power })
        })
        .collect();
    efficiencies.sort_by(f64::total_cmp);
    let undecided = answer.certificate == Certificate::Undecided;
    let (v, reason) = match efficiencies[..] {
        _ if undecided => (
            Verdict::Undetermined,
            Some("too many interacting meshes to decide how many equilibria there are".to_owned()),
        ),
        [] => (
            Verdict::Locked,
            Some(format!("friction lets {} drive no load at {}", train.member_name(from), train.member_name(to))),
        ),
        _ if answer.continuum => (
            Verdict::Multiple,
            Some("the load lies on a self-locking threshold: a whole range of torques balances it".to_owned()),
        ),
        [_] => (Verdict::Unique, None),
        _ => (Verdict::Multiple, Some("several equilibria carry the same load".to_owned())),
    };
    Direction {
        verdict: v,
        efficiency: match efficiencies[..] {
            [e] if v == Verdict::Unique => Some(e),
            _ => None,
        },
        efficiencies,
        certificate: Some(answer.certificate.into()),
        reason,
    }
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

/// External torque on a node, from the forces of the elements.
pub(super) fn torque(c: &Configuration<'_>, s: &crate::statics::Solution, node: usize) -> f64 {
    let mut sum = 0.0;
    for (j, e) in c.elements.iter().enumerate() {
        let (a, b) = (e.a.to_f64(), e.b.to_f64() * s.rho[j]);
        for (member, coefficient) in [(e.p, a), (e.q, b), (e.carrier, -(a + b))] {
            if c.node(member) == Some(node) {
                sum += s.forces[j] * coefficient;
            }
        }
    }
    sum
}

/// The same in rationals.
pub(super) fn torque_exact(
    c: &Configuration<'_>,
    equilibrium: &Equilibrium,
    s: &crate::statics::Solution,
    forces: &[Rational],
    node: usize,
) -> Rational {
    let mut sum = Rational::ZERO;
    for (j, e) in c.elements.iter().enumerate() {
        let b = &e.b * &equilibrium.rho_of(s, j);
        let carrier = -(&e.a + &b);
        for (member, coefficient) in [(e.p, &e.a), (e.q, &b), (e.carrier, &carrier)] {
            if c.node(member) == Some(node) {
                sum += &forces[j] * coefficient;
            }
        }
    }
    sum
}

/// What stands in the way of an equilibrium problem, in words.
pub(super) fn unsolvable(why: &Unsolvable) -> &'static str {
    match why {
        Unsolvable::MissingLoads(_) => "a load is missing",
        Unsolvable::TooManyLoads(_) => "a freedom is left over: the load is not carried",
        Unsolvable::Indeterminate => "statically indeterminate",
        Unsolvable::UndeterminedSpeed => "a loaded mesh has no determined relative speed",
    }
}

fn locked(c: &Configuration<'_>, input: MemberId) -> String {
    let train = c.train;
    let held: Vec<_> = c.locked_members();
    let engaged = element_names(train, &c.engaged).join(", ");
    let with = if engaged.is_empty() { String::new() } else { format!(" with {engaged} engaged") };
    if c.degrees_of_freedom() == 0 {
        format!("nothing can turn{with}; release a shift element")
    } else {
        format!("{} cannot turn{with}; locked: {}", names(train, [input]), names(train, held))
    }
}

fn free(c: &Configuration<'_>, input: MemberId, output: MemberId) -> String {
    let train = c.train;
    let freedoms = c.degrees_of_freedom();
    let transfer = c.transfer(&[input]);
    let loose: Vec<_> = (1..train.members.len())
        .map(MemberId)
        .filter(|m| transfer.speeds[m.0].is_none() && *m != FRAME && !c.inner[m.0])
        .collect();
    format!(
        "{freedoms} degrees of freedom: the speed of {} does not settle that of {} (open: {}); \
         hold one member, or prescribe {freedoms} speeds in an [[operation]]",
        names(train, [input]),
        names(train, [output]),
        names(train, loose)
    )
}

/// One-way clutches that are not engaged must not turn the way they block.
fn one_way_speeds(c: &Configuration<'_>, input: MemberId, place: &str, name: &str, diagnostics: &mut Diagnostics) {
    let train = c.train;
    let open = (0..train.shift_elements.len()).map(ShiftElementId).filter(|e| !c.engaged.contains(e));
    let elements = open.filter(|e| train.shift_elements[e.0].kind == ShiftElementKind::OneWay);
    let transfer = c.transfer(&[input]);
    for id in elements {
        let element = &train.shift_elements[id.0];
        let [a, b] = element.members.map(|m| transfer.speeds[m.0].as_ref().map(|w| w[0].clone()));
        if let (Some(a), Some(b)) = (a, b)
            && (&a - &b).sign() == element.blocks
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
