//! The operating point, exactly: speeds that settle every terminal, and torques on terminals.

use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::exact::Rational;
use crate::kinematics::{Configuration, Deviation, Motion, common};
use crate::regimes::SelectedConfiguration;
use crate::regimes::arrangement::dot;
use crate::regimes::setup::{Linked, Setup};
use crate::train::{MemberId, Train};
use crate::units::{Dimension, Quantity};

use super::request::Given;

/// Torques prescribed on terminals.
pub(super) type Loads = Vec<(usize, Rational)>;

/// An operating point. Speeds and torques stand without the power of π that they share.
pub(super) struct Point<'t> {
    /// Name of the state.
    pub state: String,
    pub setup: Setup<'t>,
    /// The base speeds.
    pub base: Vec<Rational>,
    /// The speeds that were prescribed.
    pub speeds: Vec<(MemberId, Rational)>,
    /// As many torques as are independent.
    pub loads: Loads,
    /// Powers that are prescribed, by terminal, W.
    pub powers: Vec<(usize, f64)>,
    /// One unit of speed, rad/s.
    pub speed_unit: f64,
    /// One unit of torque, N m.
    pub torque_unit: f64,
    /// One unit of power, W: of one power of π, so that what cancels rounds nothing.
    pub power_unit: f64,
}

impl<'t> Point<'t> {
    /// The point at which a configuration is asked to stand.
    ///
    /// # Errors
    /// Speeds that contradict each other; too few or too many speeds or torques.
    pub fn new(train: &'t Train, choice: SelectedConfiguration<'t>, given: &Given) -> Result<Self, Diagnostics> {
        let SelectedConfiguration { state, configuration, terminals, balance, basis: _ } = choice;
        // Planets whose speed is given stay visible.
        let keep: Vec<MemberId> = terminals.iter().copied().chain(given.speeds.iter().map(|(m, _)| *m)).collect();
        let c = Configuration::new(train, &configuration.engaged, &given.held, &keep)
            .with_terminals_apart(&terminals, &keep)
            .with_efficiencies(configuration.efficiencies);
        let motion = c.motion(&given.speeds).map_err(|broken| contradictory(&c, &broken))?;
        let setup = Setup::new(c, &terminals, Linked::of(balance))
            .map_err(|why| refuse(Code::Unfit, format!("{state}: {why}"), "name other `terminals`"))?;
        let base = base_speeds(&setup, &state, &motion, given.speeds.len())?;
        let torques =
            given.torques.iter().cloned().map(Ok).chain(given.powers.iter().map(|p| torque_of(train, &motion, p)));
        let (loads, torque_pi) = loads(&setup, &state, &torques.collect::<Result<Vec<_>, _>>()?)?;
        let speed = |m: MemberId| motion.speeds[m.0].clone().unwrap_or(Rational::ZERO);
        let of_power = |(m, p): &(MemberId, Quantity)| Some((terminal(&setup, *m)?, p.si()));
        let powers = given.powers.iter().filter_map(of_power).collect();
        Ok(Self {
            state,
            setup,
            base,
            speeds: given.speeds.iter().map(|(m, _)| (*m, speed(*m))).collect(),
            loads,
            powers,
            speed_unit: std::f64::consts::PI.powi(motion.pi_power.into()),
            torque_unit: std::f64::consts::PI.powi(torque_pi.into()),
            power_unit: std::f64::consts::PI.powi((torque_pi + motion.pi_power).into()),
        })
    }

    /// Speed of a terminal.
    pub fn speed(&self, t: usize) -> Rational {
        dot(self.setup.terminal_speed(t), &self.base)
    }
}

fn refuse(code: Code, text: impl Into<String>, hint: &str) -> Diagnostics {
    let mut all = Diagnostics::default();
    all.push(Diagnostic::new(code, "", text).hint(hint));
    all
}

/// Speeds that the gears tie to each other and that do not agree.
fn contradictory(c: &Configuration<'_>, broken: &[Deviation]) -> Diagnostics {
    let mut all = Diagnostics::default();
    for Deviation { members, .. } in broken {
        let names: Vec<&str> = members.iter().map(|m| c.train.member_name(*m)).collect();
        let text = format!("the speeds given for {} contradict each other: the gears tie them", names.join(", "));
        let hint = format!("give as many independent speeds as there are freedoms ({})", c.degrees_of_freedom());
        all.push(Diagnostic::new(Code::ContradictorySpeeds, "", text).hint(hint));
    }
    all
}

/// The base speeds, which settle all others; `given` speeds were prescribed.
fn base_speeds(setup: &Setup<'_>, state: &str, motion: &Motion, given: usize) -> Result<Vec<Rational>, Diagnostics> {
    let base: Option<Vec<Rational>> =
        setup.base.iter().map(|&b| motion.speeds[setup.terminals[b].member.0].clone()).collect();
    let Some(base) = base else {
        let text = format!(
            "{} given; {state} needs {} to settle {}",
            match given {
                0 => "no speed is".to_owned(),
                1 => "one speed is".to_owned(),
                n => format!("{n} speeds are"),
            },
            setup.base.len(),
            terminals(setup)
        );
        return Err(refuse(Code::Unfit, text, "name them in `speeds`, as in engine=2000rpm,ring=1000rpm"));
    };
    if base.iter().all(Rational::is_zero) {
        return Err(refuse(Code::Unfit, "everything stands still: no regime", "give a speed other than zero"));
    }
    Ok(base)
}

/// The torque with which a power enters at the speed that its member has.
fn torque_of(
    train: &Train,
    motion: &Motion,
    (member, power): &(MemberId, Quantity),
) -> Result<(MemberId, Quantity), Diagnostics> {
    let name = train.member_name(*member);
    match &motion.speeds[member.0] {
        Some(w) if !w.is_zero() => {
            let (value, pi_power) = (&power.value / w, power.pi_power - motion.pi_power);
            Ok((*member, Quantity { value, pi_power, dimension: Dimension::TORQUE }))
        }
        Some(_) if power.value.is_zero() => {
            let (value, dimension) = (Rational::ZERO, Dimension::TORQUE);
            Ok((*member, Quantity { value, dimension, ..power.clone() }))
        }
        Some(_) => Err(refuse(Code::Unfit, format!("{name} stands still and takes no power"), "give its torque")),
        None => Err(refuse(Code::Unfit, format!("the speed of {name} is not settled"), "give its torque")),
    }
}

/// The terminal on the shaft of a member.
fn terminal(setup: &Setup<'_>, m: MemberId) -> Option<usize> {
    (0..setup.terminals.len()).find(|&t| setup.c.node(m) == Some(setup.terminals[t].node))
}

/// Torques: as many as are independent, on terminals that determine the others. With them their power of π.
fn loads(setup: &Setup<'_>, state: &str, torques: &[(MemberId, Quantity)]) -> Result<(Loads, i8), Diagnostics> {
    let mut errors = Diagnostics::default();
    let mut given: Vec<(usize, &Quantity)> = Vec::new();
    for (m, q) in torques {
        match terminal(setup, *m) {
            Some(t) if given.iter().any(|(other, _)| *other == t) => {
                let name = setup.c.train.member_name(*m);
                let text = format!("{name} is clutched to a member whose torque is given too");
                errors.push(Diagnostic::new(Code::TooManyTorques, "", text));
            }
            Some(t) => given.push((t, q)),
            None => {
                let name = setup.c.train.member_name(*m);
                let text = format!("{name} carries no torque through the gears of {state}");
                errors.push(
                    Diagnostic::new(Code::NotATerminal, "", text)
                        .hint(format!("its terminals are: {}", terminals(setup))),
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
            terminals(setup)
        );
        let code = if given.len() < needed { Code::MissingTorque } else { Code::TooManyTorques };
        return Err(refuse(code, text, "name them in `torques`, as in 'engine=100 N m'"));
    }
    let (values, pi_power) = common(given.iter().map(|(_, q)| *q));
    Ok((given.iter().map(|(t, _)| *t).zip(values).collect(), pi_power))
}

/// The names of the terminals.
fn terminals(setup: &Setup<'_>) -> String {
    (0..setup.terminals.len()).map(|t| setup.terminal_name(t)).collect::<Vec<_>>().join(", ")
}
