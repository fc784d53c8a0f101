//! In which regime an operating point lies, how far it is to each boundary, and what changes there.

use serde::{Deserialize, Serialize};

use crate::analysis::{Named, Role};
use crate::contract::{Contract, Format};
use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::exact::Rational;
use crate::kinematics::{Configuration, common};
use crate::statics::Certificate;
use crate::symbolic::Notation;
use crate::train::{Load, MemberId, Train};
use crate::units::Quantity;

use super::arrangement::dot;
use super::atlas::{arrow, drivers, efficiency_at, efficiency_towards, enumerate, order, plane, regime_name};
use super::formula::{Efficiencies, Ratios, Shape, element_label};
use super::setup::{Pattern, Setup};
use super::{Choice, RegimeSelection, selected};

/// An operating point to place.
#[derive(Clone, Debug, Default)]
pub struct LocateRequest {
    /// State of the shift table, or `as drawn`; `None` for as drawn, or the operation's state.
    pub state: Option<String>,
    /// Members on which torque may act; `None` for the train's terminals.
    pub terminals: Option<Vec<String>>,
    /// Two terminals whose powers add to zero.
    pub balance: Option<[String; 2]>,
    /// An operation of the file that gives speeds and torques.
    pub operation: Option<String>,
    /// Speeds by member, as many as are independent.
    pub speeds: Vec<(String, Quantity)>,
    /// Torques by terminal, as many as are independent.
    pub torques: Vec<(String, Quantity)>,
}

/// Where an operating point lies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Location {
    /// `willis-location-1`.
    pub format: Format<Self>,
    /// Name of the train.
    pub train: String,
    /// The state.
    pub state: String,
    /// Speeds by terminal, rad/s.
    pub speeds_rad_s: Named<f64>,
    /// The order of the speeds.
    pub order: Vec<String>,
    /// Planes on which the point lies exactly: on the boundary between regions.
    pub on: Vec<String>,
    /// Number of the region, where the regions were enumerated and the point is inside one.
    pub region: Option<usize>,
    /// Whether every equilibrium was found.
    pub complete: bool,
    /// Why there is none, or what else must be known.
    pub reason: Option<String>,
    /// The equilibria; more than one where friction leaves a choice.
    pub regimes: Vec<Located>,
}

impl Contract for Location {
    const FORMAT: &'static str = "willis-location-1";
}

/// An equilibrium and its surroundings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Located {
    /// Name of the regime as `willis regimes` lists it, where that list was made.
    pub regime: Option<String>,
    /// Torques by terminal, N m.
    pub torques_n_m: Named<f64>,
    /// Powers into the train by terminal, W.
    pub powers_w: Named<f64>,
    /// What each terminal does.
    pub roles: Named<Role>,
    /// Which end drives each element.
    pub drivers: Named<Option<String>>,
    /// Output over input power; zero when all is dissipated.
    pub efficiency: f64,
    /// The same, exactly.
    pub efficiency_exact: Rational,
    /// The closed formula, where the train is small enough.
    pub formula: Option<String>,
    /// For each prescribed value the range within which the regime lasts, all others fixed.
    pub ranges: Vec<Range>,
}

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
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Range {
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
    /// Efficiencies just behind it; none when no equilibrium exists there.
    pub efficiency_after: Vec<f64>,
}

/// An equilibrium, exactly.
#[derive(Clone, Debug, PartialEq)]
struct State {
    pattern: Pattern,
    torques: Vec<Rational>,
}

/// Finds the regime of an operating point.
///
/// # Errors
/// Names that the train does not have; speeds that contradict each other; too few or too many speeds
/// or torques.
///
/// # Example
/// ```
/// use willis::regimes::{LocateRequest, locate};
/// use willis::train::{SetSpec, Train};
/// use willis::units::{self, Dimension};
///
/// let train = Train::builder("power split")
///     .members(["engine", "mg1", "ring"])
///     .terminals(["engine", "mg1", "ring"])
///     .set(SetSpec::simple("P1", ("mg1", 30), ("ring", 78), "engine").planet(24, 4).mesh_efficiency(0.99))
///     .build()?;
/// let speed = |text| units::parse(text, Dimension::ANGULAR_SPEED).unwrap();
/// let found = locate(&train, &LocateRequest {
///     speeds: vec![("engine".into(), speed("2000 rpm")), ("ring".into(), speed("1000 rpm"))],
///     torques: vec![("engine".into(), units::parse("100 N m", Dimension::TORQUE).unwrap())],
///     ..LocateRequest::default()
/// })?;
/// let here = &found.regimes[0];
/// assert_eq!(here.regime.as_deref(), Some("2+"));
/// // As fast as the engine the ring turns with it, and behind that another gear drives.
/// let ring = here.ranges.iter().find(|r| r.member == "ring").unwrap();
/// let limit = ring.above.as_ref().unwrap();
/// assert!((limit.at * 30.0 / std::f64::consts::PI - 2000.0).abs() < 1e-9);
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn locate(train: &Train, request: &LocateRequest) -> Result<Location, Diagnostics> {
    let mut errors = Diagnostics::default();
    let mut speeds: Vec<(MemberId, Quantity)> = Vec::new();
    let mut torques: Vec<(MemberId, Quantity)> = Vec::new();
    let mut state = request.state.clone();
    let mut held: Vec<MemberId> = Vec::new();
    if let Some(name) = &request.operation {
        match train.operations.iter().find(|o| o.name == *name) {
            Some(o) => {
                if state.is_none() {
                    state = o.state.map(|k| train.states[k].name.clone());
                }
                speeds.extend(o.speeds.iter().cloned());
                held.extend(&o.fixed);
                for (m, load) in &o.loads {
                    match load {
                        Load::Torque(q) => torques.push((*m, q.clone())),
                        Load::Power(_) => {
                            let text = format!(
                                "operation `{name}` prescribes a power on {}; a place needs torques",
                                train.member_name(*m)
                            );
                            errors.push(Diagnostic::new(Code::Unfit, "", text).hint("give the torque with --torques"));
                        }
                    }
                }
            }
            None => {
                let known: Vec<&str> = train.operations.iter().map(|o| o.name.as_str()).collect();
                let d = Diagnostic::new(Code::UnknownSelection, "", format!("the train has no operation `{name}`"));
                errors.push(
                    d.suggest(name, known.iter().copied()).hint(format!("its operations are: {}", known.join(", "))),
                );
            }
        }
    }
    for (list, given) in [(&mut speeds, &request.speeds), (&mut torques, &request.torques)] {
        for (name, quantity) in given {
            match train.member(name) {
                Some(id) => {
                    // What is typed wins over what the operation says.
                    list.retain(|(m, _)| *m != id);
                    list.push((id, quantity.clone()));
                }
                None => {
                    let known: Vec<&str> = train.members.iter().skip(1).map(|m| m.name.as_str()).collect();
                    let d = Diagnostic::new(Code::UnknownName, "", format!("the train has no member `{name}`"));
                    errors.push(
                        d.suggest(name, known.iter().copied()).hint(format!("its members are: {}", known.join(", "))),
                    );
                }
            }
        }
    }
    let selection = RegimeSelection {
        state: Some(state.unwrap_or_else(|| crate::analysis::AS_DRAWN.to_owned())),
        terminals: request.terminals.clone(),
        balance: request.balance.clone(),
    };
    let choice = match selected(train, &selection) {
        Ok(mut all) => all.pop(),
        Err(wrong) => {
            errors.extend(wrong);
            None
        }
    };
    let Some(Choice { state, configuration, terminals, balance }) = choice.filter(|_| !errors.has_errors()) else {
        return Err(errors);
    };
    let refuse = |code: Code, text: String, hint: String| {
        let mut all = Diagnostics::default();
        all.push(Diagnostic::new(code, "", text).hint(hint));
        all
    };
    // Planets whose speed is given stay visible.
    let keep: Vec<MemberId> = terminals.iter().copied().chain(speeds.iter().map(|(m, _)| *m)).collect();
    let c = Configuration::new(train, &configuration.engaged, &held, &keep);
    let motion = c.motion(&speeds).map_err(|broken| {
        let mut all = Diagnostics::default();
        for group in broken {
            let names: Vec<&str> = group.iter().map(|m| train.member_name(*m)).collect();
            let text = format!("the speeds given for {} contradict each other: the gears tie them", names.join(", "));
            let hint = format!("give as many independent speeds as there are freedoms ({})", c.degrees_of_freedom());
            all.push(Diagnostic::new(Code::ContradictorySpeeds, "", text).hint(hint));
        }
        all
    })?;
    let setup = Setup::new(c.clone(), &terminals, balance).map_err(|why| {
        refuse(Code::Unfit, format!("{state}: {why}"), "name other terminals with --terminals".into())
    })?;
    let name = |t: usize| train.member_name(setup.terminals[t].member).to_owned();
    let base: Option<Vec<Rational>> =
        setup.base.iter().map(|&b| motion.speeds[setup.terminals[b].member.0].clone()).collect();
    let Some(base) = base else {
        let text = format!(
            "{} given; {state} needs {} to settle {}",
            match speeds.len() {
                0 => "no speed is".to_owned(),
                1 => "one speed is".to_owned(),
                n => format!("{n} speeds are"),
            },
            setup.base.len(),
            (0..setup.terminals.len()).map(name).collect::<Vec<_>>().join(", ")
        );
        return Err(refuse(Code::Unfit, text, "name them as in --speeds engine=2000rpm,ring=1000rpm".into()));
    };
    if base.iter().all(Rational::is_zero) {
        return Err(refuse(
            Code::Unfit,
            "everything stands still: no regime".into(),
            "give a speed other than zero".into(),
        ));
    }

    // Torques: as many as are independent, on terminals that determine the others.
    let mut given: Vec<(usize, Quantity)> = Vec::new();
    for (m, q) in torques {
        match (0..setup.terminals.len()).find(|&t| setup.c.node(m) == Some(setup.terminals[t].node)) {
            Some(t) if given.iter().any(|(other, _)| *other == t) => {
                let text = format!("{} is clutched to a member whose torque is given too", train.member_name(m));
                errors.push(Diagnostic::new(Code::TooManyTorques, "", text));
            }
            Some(t) => given.push((t, q)),
            None => {
                let own: Vec<String> = (0..setup.terminals.len()).map(name).collect();
                let text = format!("{} carries no torque through the gears of {state}", train.member_name(m));
                errors.push(
                    Diagnostic::new(Code::NotATerminal, "", text)
                        .hint(format!("its terminals are: {}", own.join(", "))),
                );
            }
        }
    }
    if errors.has_errors() {
        return Err(errors);
    }
    let needed = setup.independent_torques();
    if given.len() != needed {
        let text = format!(
            "{} given; {state} has {needed} independent (terminals {})",
            match given.len() {
                0 => "no torque is".to_owned(),
                1 => "one torque is".to_owned(),
                n => format!("{n} torques are"),
            },
            (0..setup.terminals.len()).map(name).collect::<Vec<_>>().join(", ")
        );
        let code = if given.len() < needed { Code::MissingTorque } else { Code::TooManyTorques };
        return Err(refuse(code, text, "name them as in --torques 'engine=100 N m'".into()));
    }
    let (loads, torque_pi) = common(given.iter().map(|(_, q)| q));
    let torque_unit = std::f64::consts::PI.powi(torque_pi.into());
    let speed_unit = std::f64::consts::PI.powi(motion.pi_power.into());
    let loads: Vec<(usize, Rational)> = given.iter().map(|(t, _)| *t).zip(loads).collect();

    let finder = Finder { setup: &setup, loads: &loads };
    let (states, complete, reason) = finder.states(&base, &loads);
    let planes = setup.planes();
    let signs: Vec<i8> = planes.iter().map(|f| dot(f, &base).sign()).collect();
    let labels: Vec<String> = planes.iter().map(|f| plane(&setup, f).label).collect();
    let labels: Vec<String> =
        labels.into_iter().map(|l| if l.is_empty() { "a torque vanishes".to_owned() } else { l }).collect();
    let cells = enumerate(&setup);
    let region = cells.as_ref().ok().and_then(|cells| cells.regions.iter().position(|r| r.signs == signs));
    let shape = Shape::new(&setup, &[]).ok();
    // Prescribed speeds that matter, each with the change of the base speeds that it makes.
    let members: Vec<MemberId> = speeds.iter().map(|(m, _)| *m).collect();
    let transfer = setup.c.transfer(&members);
    let directions: Vec<(usize, Vec<Rational>)> = (0..members.len())
        .filter_map(|k| {
            let own: Option<Vec<Rational>> = setup
                .base
                .iter()
                .map(|&b| transfer.speeds[setup.terminals[b].member.0].as_ref().map(|f| f[k].clone()))
                .collect();
            own.filter(|d| d.iter().any(|x| !x.is_zero())).map(|d| (k, d))
        })
        .collect();
    let independent = members.len() == setup.base.len();

    let mut regimes = Vec::new();
    for s in &states {
        let powers: Vec<Rational> =
            (0..setup.terminals.len()).map(|t| &s.torques[t] * &dot(setup.terminal_speed(t), &base)).collect();
        let power_signs: Vec<i8> = powers.iter().map(Rational::sign).collect();
        let torque_signs: Vec<i8> = s.torques.iter().map(Rational::sign).collect();
        let own = cells.as_ref().ok().zip(region).and_then(|(cells, k)| {
            let list = &cells.torques[k];
            let n = list.iter().position(|x| x.pattern == s.pattern && x.signs == torque_signs)?;
            Some(regime_name(&setup, k, list, n))
        });
        let efficiency = efficiency_at(&setup, &base, &s.torques);
        let formula = shape.as_ref().map(|shape| {
            let f = shape.formula(&s.pattern, &power_signs, Ratios::Basic, Efficiencies::Basic);
            f.by_loss(Notation::Text).unwrap_or_else(|| f.names.show(Notation::Text, &f.efficiency))
        });
        let mut ranges = Vec::new();
        if independent {
            for (k, direction) in &directions {
                let value = motion.speeds[members[*k].0].clone().unwrap_or(Rational::ZERO);
                ranges.push(finder.speed_range(
                    &base,
                    s,
                    &planes,
                    &labels,
                    direction,
                    &value,
                    speed_unit,
                    train.member_name(members[*k]),
                ));
            }
        }
        for (n, (t, _)) in loads.iter().enumerate() {
            ranges.push(finder.torque_range(&base, s, n, torque_unit, &name(*t)));
        }
        regimes.push(Located {
            regime: own,
            torques_n_m: Named(
                (0..setup.terminals.len()).map(|t| (name(t), s.torques[t].to_f64() * torque_unit)).collect(),
            ),
            powers_w: Named(
                (0..setup.terminals.len()).map(|t| (name(t), powers[t].to_f64() * torque_unit * speed_unit)).collect(),
            ),
            roles: Named((0..setup.terminals.len()).map(|t| (name(t), role(power_signs[t]))).collect()),
            drivers: Named(drivers(&setup, &s.pattern)),
            efficiency: efficiency.to_f64(),
            efficiency_exact: efficiency,
            formula,
            ranges,
        });
    }
    Ok(Location {
        format: Format::new(),
        train: train.name.clone(),
        state,
        speeds_rad_s: Named(
            (0..setup.terminals.len())
                .map(|t| (name(t), dot(setup.terminal_speed(t), &base).to_f64() * speed_unit))
                .collect(),
        ),
        order: order(&setup, &base),
        on: planes.iter().zip(&labels).filter(|(f, _)| dot(f, &base).is_zero()).map(|(_, l)| l.clone()).collect(),
        region: region.map(|k| k + 1),
        complete,
        reason: reason.or(cells.err()),
        regimes,
    })
}

fn role(sign: i8) -> Role {
    match sign {
        1 => Role::Input,
        -1 => Role::Output,
        _ => Role::Idle,
    }
}

/// A small step behind a boundary: towards the next one, or in proportion to the value.
fn little(step: &Rational, next: Option<Rational>, value: &Rational, up: bool) -> Rational {
    let gap = match next {
        Some(next) => &next - step,
        None => {
            let size = step.abs().max(value.abs());
            let size = if size.is_zero() { Rational::ONE } else { size };
            if up { size } else { -size }
        }
    };
    gap * Rational::new(1, 1_000_000)
}

struct Finder<'a, 't> {
    setup: &'a Setup<'t>,
    loads: &'a [(usize, Rational)],
}

impl Finder<'_, '_> {
    /// Every equilibrium at given base speeds and loads; whether that is certain; and why there is
    /// none.
    fn states(&self, base: &[Rational], loads: &[(usize, Rational)]) -> (Vec<State>, bool, Option<String>) {
        let setup = self.setup;
        if loads.iter().all(|(_, x)| x.is_zero()) {
            return (vec![], true, Some("no torque acts: nothing is loaded".to_owned()));
        }
        if setup.balance.is_some() {
            // One torque is given; each ray of equilibria is scaled to it.
            let (t, load) = &loads[0];
            let Ok((cells, _)) = setup.torque_cells(base) else {
                return (vec![], false, Some("too many interacting meshes to try every pattern of drivers".to_owned()));
            };
            let states: Vec<State> = cells
                .into_iter()
                .filter(|c| c.signs[*t] == load.sign() && load.sign() != 0)
                .map(|c| {
                    let factor = load / &c.torques[*t];
                    State { pattern: c.pattern, torques: c.torques.iter().map(|x| x * &factor).collect() }
                })
                .collect();
            let reason = states.is_empty().then(|| "no equilibrium: friction locks the train here".to_owned());
            return (states, true, reason);
        }
        let loaded: Vec<usize> = loads.iter().map(|(t, _)| *t).collect();
        let equilibrium = match setup.equilibrium(base, &loaded) {
            Ok(e) => e,
            Err(_) => {
                let names: Vec<&str> =
                    loads.iter().map(|(t, _)| setup.c.train.member_name(setup.terminals[*t].member)).collect();
                let why = format!("the torques on {} do not settle the others", names.join(", "));
                return (vec![], true, Some(why));
            }
        };
        let mut right = vec![Rational::ZERO; setup.c.nodes];
        loads.iter().for_each(|(t, x)| right[setup.terminals[*t].node] = x.clone());
        let answer = equilibrium.solve(&right);
        let complete = answer.certificate != Certificate::Undecided;
        let states: Vec<State> = answer
            .solutions
            .iter()
            .filter_map(|s| {
                let pattern = setup.pattern_of(base, s);
                let torques = setup.torques_for(&pattern, loads)?;
                Some(State { pattern, torques })
            })
            .collect();
        let reason = match (states.is_empty(), complete) {
            (true, true) => Some("no equilibrium: friction locks the train at these speeds and torques".to_owned()),
            (true, false) => {
                Some("too many interacting meshes: no equilibrium was found, and none is excluded".to_owned())
            }
            (false, false) => {
                Some("too many interacting meshes: the equilibrium shown may not be the only one".to_owned())
            }
            (false, true) if answer.continuum => {
                Some("the load lies on a self-locking threshold: a whole range of torques balances it".to_owned())
            }
            _ => None,
        };
        (states, complete, reason)
    }

    /// How far a speed can go, and what lies behind.
    #[allow(clippy::too_many_arguments)]
    fn speed_range(
        &self,
        base: &[Rational],
        here: &State,
        planes: &[Vec<Rational>],
        labels: &[String],
        direction: &[Rational],
        value: &Rational,
        unit: f64,
        member: &str,
    ) -> Range {
        // Steps along the direction at which a plane is met, with the plane.
        let mut steps: Vec<(Rational, usize)> = planes
            .iter()
            .enumerate()
            .filter_map(|(p, f)| {
                let slope = dot(f, direction);
                (!slope.is_zero()).then(|| (-(dot(f, base) / slope), p))
            })
            .collect();
        steps.sort();
        let at =
            |step: &Rational| -> Vec<Rational> { base.iter().zip(direction).map(|(b, d)| b + &(d * step)).collect() };
        let edge = |up: bool| -> Option<Edge> {
            // On a plane already, every change leaves it.
            let beyond = |s: &Rational| if up { s.sign() >= 0 } else { s.sign() <= 0 };
            let mut ahead: Vec<&(Rational, usize)> = steps.iter().filter(|(s, _)| beyond(s)).collect();
            if !up {
                ahead.reverse();
            }
            let (step, _) = ahead.first()?;
            let met: Vec<&str> = ahead.iter().filter(|(s, _)| s == step).map(|(_, p)| labels[*p].as_str()).collect();
            let next = ahead.iter().find(|(s, _)| s != step).map(|(s, _)| s.clone());
            let behind = at(&(step + &little(step, next, value, up)));
            let boundary = at(step);
            let (after, _, _) = self.states(&behind, self.loads);
            let still = boundary.iter().all(Rational::is_zero);
            Some(Edge {
                at: (value + step).to_f64() * unit,
                label: if still { "everything stands still".to_owned() } else { met.join("; ") },
                changes: self.changes(base, here, &behind, &after),
                efficiency_before: efficiency_towards(self.setup, &boundary, base, &here.pattern, &here.torques)
                    .to_f64(),
                efficiency_after: after
                    .iter()
                    .map(|s| efficiency_at(self.setup, &behind, &s.torques).to_f64())
                    .collect(),
            })
        };
        Range {
            quantity: Prescribes::Speed,
            member: member.to_owned(),
            value: value.to_f64() * unit,
            below: edge(false),
            above: edge(true),
        }
    }

    /// How far a torque can go: a force or a terminal torque vanishes at the end.
    fn torque_range(&self, base: &[Rational], here: &State, n: usize, unit: f64, member: &str) -> Range {
        let setup = self.setup;
        let value = self.loads[n].1.clone();
        // Everything is linear in the load: two solutions give the lines.
        let mut more = self.loads.to_vec();
        more[n].1 = &more[n].1 + &Rational::ONE;
        let mut steps: Vec<(Rational, String)> = Vec::new();
        let lines = match setup.balance {
            None => self.lines(&here.pattern, self.loads).zip(self.lines(&here.pattern, &more)),
            // All torques are proportional to the only one that is given.
            Some(_) => None,
        };
        if let Some((now, then)) = lines {
            for ((label, a), (_, b)) in now.into_iter().zip(then) {
                let slope = &b - &a;
                if !slope.is_zero() {
                    steps.push((-(a / slope), label));
                }
            }
        } else {
            steps.push((-value.clone(), "no torque acts".to_owned()));
        }
        steps.sort_by(|a, b| a.0.cmp(&b.0));
        let edge = |up: bool| -> Option<Edge> {
            let beyond = |s: &Rational| if up { s.sign() >= 0 } else { s.sign() <= 0 };
            let mut ahead: Vec<&(Rational, String)> = steps.iter().filter(|(s, _)| beyond(s)).collect();
            if !up {
                ahead.reverse();
            }
            let (step, _) = ahead.first()?;
            let met: Vec<&str> = ahead.iter().filter(|(s, _)| s == step).map(|(_, l)| l.as_str()).collect();
            let next = ahead.iter().find(|(s, _)| s != step).map(|(s, _)| s.clone());
            let load_at = |step: &Rational| {
                let mut loads = self.loads.to_vec();
                loads[n].1 = &loads[n].1 + step;
                loads
            };
            let (after, _, _) = self.states(base, &load_at(&(step + &little(step, next, &value, up))));
            let loads = load_at(step);
            let none = loads.iter().all(|(_, x)| x.is_zero());
            let before = match none || setup.balance.is_some() {
                true => here.torques.clone(),
                false => setup.torques_for(&here.pattern, &loads).unwrap_or_else(|| here.torques.clone()),
            };
            Some(Edge {
                at: (&value + step).to_f64() * unit,
                label: if none { "no torque acts".to_owned() } else { met.join("; ") },
                changes: self.changes(base, here, base, &after),
                efficiency_before: efficiency_at(setup, base, &before).to_f64(),
                efficiency_after: after.iter().map(|s| efficiency_at(setup, base, &s.torques).to_f64()).collect(),
            })
        };
        Range {
            quantity: Prescribes::Torque,
            member: member.to_owned(),
            value: value.to_f64() * unit,
            below: edge(false),
            above: edge(true),
        }
    }

    /// Values whose sign the regime needs, under given loads.
    fn lines(&self, pattern: &Pattern, loads: &[(usize, Rational)]) -> Option<Vec<(String, Rational)>> {
        let setup = self.setup;
        let k = setup.active.len();
        let torques = setup.torques_for(pattern, loads)?;
        let forces = setup.forces_for(pattern, loads)?;
        let mut all: Vec<(String, Rational)> = (0..setup.terminals.len())
            .map(|t| {
                let name = setup.c.train.member_name(setup.terminals[t].member);
                (format!("no torque on {name}"), torques[t].clone())
            })
            .collect();
        for j in (0..k).filter(|&j| pattern[j].is_some()) {
            all.push((format!("{} is unloaded", element_label(setup, j)), forces[j].clone()));
        }
        Some(all)
    }

    /// What differs between a state and those behind a boundary, in words.
    fn changes(&self, base: &[Rational], here: &State, behind: &[Rational], after: &[State]) -> Vec<String> {
        let setup = self.setup;
        let train = setup.c.train;
        let roles = |base: &[Rational], s: &State| -> Vec<i8> {
            (0..setup.terminals.len())
                .map(|t| s.torques[t].sign() * dot(setup.terminal_speed(t), base).sign())
                .collect()
        };
        let names = |roles: &[i8], sign: i8| -> Vec<String> {
            (0..roles.len())
                .filter(|&t| roles[t] == sign)
                .map(|t| train.member_name(setup.terminals[t].member).to_owned())
                .collect()
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
                    let driver = train.member_name(if b { e.p } else { e.q });
                    own.push(format!("{driver} drives in {}", element_label(setup, j)));
                }
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
}
