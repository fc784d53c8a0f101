//! How far a prescribed speed or torque can change before a regime ends, and what lies behind.

use serde::{Deserialize, Serialize};

use crate::exact::Rational;
use crate::regimes::arrangement::dot;
use crate::regimes::atlas::arrow;
use crate::regimes::cells::{efficiency_at, efficiency_towards};
use crate::regimes::formula::element_label;
use crate::regimes::setup::{Pattern, Setup};
use crate::train::MemberId;

use super::equilibria::{State, equilibria};
use super::point::{Loads, Point};
use super::surroundings::Surroundings;

/// What is prescribed on a member.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Prescribes {
    /// Its speed.
    Speed,
    /// Its torque.
    Torque,
}

impl Prescribes {
    /// For people: `speed`.
    pub fn words(self) -> &'static str {
        match self {
            Self::Speed => "speed",
            Self::Torque => "torque",
        }
    }
}

/// How far one prescribed value can change before the regime ends.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
// The schema keeps the name that is published.
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "Range"))]
#[non_exhaustive]
pub struct PrescribedRange {
    /// What it is.
    pub quantity: Prescribes,
    /// The member.
    pub member: String,
    /// Its value, rad/s or N m.
    pub value: f64,
    /// The boundary below, if there is one.
    pub below: Option<Edge>,
    /// The boundary above, if there is one.
    pub above: Option<Edge>,
}

/// A boundary that a changing value meets.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Edge {
    /// The value there, rad/s or N m.
    pub at: f64,
    /// What is the case there.
    pub label: String,
    /// What changes behind it; empty when nothing does.
    pub changes: Vec<String>,
    /// Efficiency just before it.
    pub efficiency_before: f64,
    /// The same, exactly.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub efficiency_before_exact: Option<Rational>,
    /// Efficiencies just behind it; none when no equilibrium exists there.
    pub efficiency_after: Vec<f64>,
}

/// A prescribed speed that can change alone.
pub(super) struct SpeedAxis {
    member: MemberId,
    value: Rational,
    /// The change of the base speeds that it makes.
    direction: Vec<Rational>,
}

/// Prescribed speeds that matter; none when they are tied to each other and none can change alone.
pub(super) fn speed_axes(point: &Point<'_>) -> Vec<SpeedAxis> {
    let setup = &point.setup;
    if point.speeds.len() != setup.base.len() {
        return vec![];
    }
    let members: Vec<MemberId> = point.speeds.iter().map(|(m, _)| *m).collect();
    let transfer = setup.c.transfer(&members);
    let axis = |(k, (member, value)): (usize, &(MemberId, Rational))| {
        let of_base = |&b: &usize| transfer.speeds[setup.terminals[b].member.0].as_ref().map(|f| f[k].clone());
        let direction: Vec<Rational> = setup.base.iter().map(of_base).collect::<Option<_>>()?;
        let matters = direction.iter().any(|x| !x.is_zero());
        matters.then(|| SpeedAxis { member: *member, value: value.clone(), direction })
    };
    point.speeds.iter().enumerate().filter_map(axis).collect()
}

/// The boundaries that a changing value meets: by how much it changes until then, and what is the case there.
struct Boundaries(Vec<(Rational, String)>);

/// The nearest boundary in one direction.
struct Nearest<'b> {
    step: &'b Rational,
    /// A little further.
    behind: Rational,
    label: String,
}

impl Boundaries {
    fn new(mut steps: Vec<(Rational, String)>) -> Self {
        steps.sort_by(|a, b| a.0.cmp(&b.0));
        Self(steps)
    }

    fn nearest(&self, value: &Rational, up: bool) -> Option<Nearest<'_>> {
        // On a plane already, every change leaves it.
        let beyond = |s: &Rational| if up { s.sign() >= 0 } else { s.sign() <= 0 };
        let mut ahead: Vec<&(Rational, String)> = self.0.iter().filter(|(s, _)| beyond(s)).collect();
        if !up {
            ahead.reverse();
        }
        let (step, _) = ahead.first()?;
        let met: Vec<&str> = ahead.iter().filter(|(s, _)| s == step).map(|(_, l)| l.as_str()).collect();
        let next = ahead.iter().find(|(s, _)| s != step).map(|(s, _)| s);
        Some(Nearest { step, behind: step + &little(step, next, value, up), label: met.join("; ") })
    }
}

/// A small step behind a boundary: towards the next one, or in proportion to the value.
fn little(step: &Rational, next: Option<&Rational>, value: &Rational, up: bool) -> Rational {
    let gap = match next {
        Some(next) => next - step,
        None => {
            let size = step.abs().max(value.abs());
            let size = if size.is_zero() { Rational::ONE } else { size };
            if up { size } else { -size }
        }
    };
    gap * Rational::new(1, 1_000_000)
}

/// How far a speed can go, and what lies behind.
pub(super) fn speed_range(point: &Point<'_>, around: &Surroundings, here: &State, axis: &SpeedAxis) -> PrescribedRange {
    let (setup, base) = (&point.setup, &point.base[..]);
    let SpeedAxis { member, value, direction } = axis;
    // Steps along the direction at which a plane is met.
    let boundaries = Boundaries::new(
        (around.planes.iter().zip(&around.labels))
            .filter_map(|(f, label)| {
                let slope = dot(f, direction);
                (!slope.is_zero()).then(|| (-(dot(f, base) / slope), label.clone()))
            })
            .collect(),
    );
    let at = |step: &Rational| -> Vec<Rational> { base.iter().zip(direction).map(|(b, d)| b + &(d * step)).collect() };
    let edge = |up: bool| -> Option<Edge> {
        let Nearest { step, behind, label } = boundaries.nearest(value, up)?;
        let (boundary, behind) = (at(step), at(&behind));
        let after = equilibria(setup, &behind, &point.loads).states;
        let still = boundary.iter().all(Rational::is_zero);
        let limit = efficiency_towards(setup, &boundary, base, &here.pattern, &here.torques);
        Some(Edge {
            at: (value + step).to_f64() * point.speed_unit,
            label: if still { "everything stands still".to_owned() } else { label },
            changes: changes(setup, (base, here), (&behind, &after)),
            efficiency_before: limit.to_f64(),
            efficiency_before_exact: Some(limit),
            efficiency_after: after.iter().map(|s| efficiency_at(setup, &behind, &s.torques).to_f64()).collect(),
        })
    };
    PrescribedRange {
        quantity: Prescribes::Speed,
        member: setup.c.train.member_name(*member).to_owned(),
        value: value.to_f64() * point.speed_unit,
        below: edge(false),
        above: edge(true),
    }
}

/// How far the torque at a position of [`Point::loads`] can go: a force or a terminal torque vanishes at the end.
pub(super) fn torque_range(point: &Point<'_>, here: &State, n: usize) -> PrescribedRange {
    let (setup, base) = (&point.setup, &point.base[..]);
    let (terminal, value) = &point.loads[n];
    let load_at = |step: &Rational| -> Loads {
        let mut loads = point.loads.clone();
        loads[n].1 = value + step;
        loads
    };
    let lines = match setup.link {
        // Everything is linear in the load: two solutions give the lines.
        None => lines(setup, &here.pattern, &point.loads).zip(lines(setup, &here.pattern, &load_at(&Rational::ONE))),
        // All torques are proportional to the only one that is given.
        Some(_) => None,
    };
    let boundaries = Boundaries::new(match lines {
        Some((now, then)) => (now.into_iter().zip(then))
            .filter_map(|((label, a), (_, b))| {
                let slope = &b - &a;
                (!slope.is_zero()).then(|| (-(a / slope), label))
            })
            .collect(),
        None => vec![(-value.clone(), "no torque acts".to_owned())],
    });
    let edge = |up: bool| -> Option<Edge> {
        let Nearest { step, behind, label } = boundaries.nearest(value, up)?;
        let after = equilibria(setup, base, &load_at(&behind)).states;
        let loads = load_at(step);
        let none = loads.iter().all(|(_, x)| x.is_zero());
        let before = match none || setup.link.is_some() {
            true => here.torques.clone(),
            false => setup.torques_for(&here.pattern, &loads).unwrap_or_else(|| here.torques.clone()),
        };
        let limit = efficiency_at(setup, base, &before);
        Some(Edge {
            at: (value + step).to_f64() * point.torque_unit,
            label: if none { "no torque acts".to_owned() } else { label },
            changes: changes(setup, (base, here), (base, &after)),
            efficiency_before: limit.to_f64(),
            efficiency_before_exact: Some(limit),
            efficiency_after: after.iter().map(|s| efficiency_at(setup, base, &s.torques).to_f64()).collect(),
        })
    };
    PrescribedRange {
        quantity: Prescribes::Torque,
        member: setup.terminal_name(*terminal).to_owned(),
        value: value.to_f64() * point.torque_unit,
        below: edge(false),
        above: edge(true),
    }
}

/// Values whose sign the regime needs, under given loads.
fn lines(setup: &Setup<'_>, pattern: &Pattern, loads: &[(usize, Rational)]) -> Option<Vec<(String, Rational)>> {
    let torques = setup.torques_for(pattern, loads)?;
    let forces = setup.forces_for(pattern, loads)?;
    let mut all: Vec<(String, Rational)> = (0..setup.terminals.len())
        .map(|t| (format!("no torque on {}", setup.terminal_name(t)), torques[t].clone()))
        .collect();
    for j in (0..setup.active.len()).filter(|&j| pattern[j].is_some()) {
        all.push((format!("{} is unloaded", element_label(setup, j)), forces[j].clone()));
    }
    Some(all)
}

/// What differs between a state and those behind a boundary, in words.
fn changes(
    setup: &Setup<'_>,
    (base, here): (&[Rational], &State),
    (behind, after): (&[Rational], &[State]),
) -> Vec<String> {
    let roles = |base: &[Rational], s: &State| -> Vec<i8> {
        let power = |t: usize| s.torques[t].sign() * dot(setup.terminal_speed(t), base).sign();
        (0..setup.terminals.len()).map(|t| if setup.is_end(t) { 0 } else { power(t) }).collect()
    };
    let names = |roles: &[i8], sign: i8| -> Vec<String> {
        (0..roles.len()).filter(|&t| roles[t] == sign).map(|t| setup.terminal_name(t).to_owned()).collect()
    };
    if after.is_empty() {
        return vec!["no equilibrium: friction locks the train".to_owned()];
    }
    let before = roles(base, here);
    let mut all = Vec::new();
    for s in after {
        let now = roles(behind, s);
        let mut own = Vec::new();
        if now != before {
            own.push(arrow(&names(&now, 1), &names(&now, -1)));
        }
        for j in 0..setup.active.len() {
            if let Some(b) = s.pattern[j]
                && here.pattern[j] != Some(b)
            {
                let e = setup.element(j);
                let driver = setup.member_name(if b { e.p } else { e.q });
                own.push(format!("{driver} drives in {}", element_label(setup, j)));
            }
        }
        let through = setup.active.len();
        if let (Some(link), Some(Some(forward))) = (&setup.link, s.pattern.get(through))
            && here.pattern[through] != Some(*forward)
        {
            let from = setup.terminal_name(link.ends[usize::from(!forward)]);
            own.push(format!("power runs through {} from {from}", setup.link_name()));
        }
        if !own.is_empty() {
            all.push(own.join(", "));
        }
    }
    if after.len() > 1 {
        all.insert(0, format!("{} equilibria", after.len()));
    }
    all
}
