//! What an operating point gives rise to, told to people: the only place where its warnings and refusals become text.

use crate::diagnostic::{Code, Diagnostic, Diagnostics, apart};
use crate::train::{MemberId, Operation, ShiftElementId, Train};

use super::{BeyondLimit, Boundary, Doubt, OutsideLaw, SpeedDeviation, StictionRange, Why};

/// Why an operation makes no question.
#[derive(Clone, Debug)]
pub(super) enum Refusal {
    /// The gears tie these members together, and not as prescribed: the last one turns otherwise. `relative` is what the
    /// tolerance of speeds is compared with.
    Contradiction { freedoms: usize, members: Vec<MemberId>, relative: f64, follows_rpm: Option<f64>, given_rpm: f64 },
    /// A speed that no number holds.
    SpeedTooLarge,
    /// A torque or power that no number holds.
    TorqueTooLarge,
    /// A drag that no exact number holds.
    DragTooLarge(MemberId),
    /// A power, W, where nothing turns.
    PowerAtRest(MemberId, f64),
    /// A power where no speed is known.
    PowerWithoutSpeed(MemberId),
    /// Two terminals that turn as one, and neither has a torque.
    Together([MemberId; 2]),
    /// So many more terminals must carry a load than those that are not left open.
    MissingLoads { freedoms: usize, coupled: usize, at_rest: Vec<usize>, open: Vec<MemberId>, more: usize },
    /// So many loads too many; so many terminals are left open.
    TooManyLoads { freedoms: usize, coupled: usize, at_rest: Vec<usize>, open: usize, more: usize },
}

/// What a reader of the answer must know beside it.
#[derive(Clone, Debug)]
pub(super) enum Finding {
    /// What explains the verdict.
    Why(Why),
    /// Members that nothing drives.
    MaySpin(Vec<MemberId>),
    /// A variator of which all members stand still.
    VariatorAtRest(usize),
    /// A limit of a variator is exceeded.
    Beyond(BeyondLimit),
    /// A machine runs outside its map.
    OutsideMap(String),
    /// Ranges that friction at rest leaves open.
    Stiction(Vec<StictionRange>),
    /// A number that cannot be right.
    Doubt(Doubt),
    /// A law was used outside its range.
    Outside(OutsideLaw),
    /// Prescribed speeds contradict the gears within the tolerance.
    Yield(SpeedDeviation),
    /// There is no heat balance, because the operating point has no single answer.
    NoHeat(Option<super::Verdict>),
    /// At the limit, K, more heat reaches the oil than is carried away, W.
    TooHot { limit: f64, reaching: f64, carried: f64 },
    /// Oil temperatures that hold, K, and whether they are stable; and where it is not decided.
    SeveralTemperatures { others: Vec<(f64, bool)>, undecided: Vec<[f64; 2]>, taken: f64 },
    /// The oil temperature, K, is that of a step of a law: heat below and above, W.
    HeatStep { oil: f64, step: [f64; 2] },
    /// The cooler warms the oil, W.
    CoolerHeats(f64),
    /// A prescribed torque (or else speed) is near a boundary.
    Near { torque: bool, boundary: Boundary },
}

/// The refusals of an operation as errors that do not name it.
pub(super) fn refused(train: &Train, operation: &Operation, all: &[Refusal]) -> Diagnostics {
    all.iter().map(|r| r.tell(train, operation)).collect()
}

/// What was found as warnings and notes that do not name the operation.
pub(super) fn found(train: &Train, operation: &Operation, all: &[Finding]) -> Diagnostics {
    all.iter().filter_map(|f| f.tell(train, operation)).collect()
}

/// Puts the operation's name before each message.
pub(crate) fn named(operation: &Operation, all: Diagnostics) -> Diagnostics {
    let name = |mut d: Diagnostic| {
        d.message = format!("operation `{}`: {}", operation.name, d.message);
        d
    };
    all.into_iter().map(name).collect()
}

impl Refusal {
    fn tell(&self, train: &Train, operation: &Operation) -> Diagnostic {
        let place = operation.place.as_str();
        let name = |m: MemberId| name_of(train, m);
        match self {
            Self::Contradiction { freedoms, members, relative, follows_rpm, given_rpm } => {
                let (last, others) = members.split_last().expect("a conflict names members");
                let message = match others {
                    [] => format!("`{}` cannot turn, but {} rpm is prescribed", name(*last), short(*given_rpm)),
                    _ => {
                        let [follows, given] = match follows_rpm {
                            Some(follows) => apart(*follows, *given_rpm, short),
                            None => ["another number of".into(), short(*given_rpm)],
                        };
                        format!(
                            "the gears tie {} together; with the other speeds `{}` turns at {follows} rpm, not at {given} rpm",
                            names(train, members.iter().copied()).join(", "),
                            name(*last),
                        )
                    }
                };
                let hint = match freedoms {
                    0 => "nothing can turn here: release a shift element or a held member".to_owned(),
                    1 => "prescribe one speed in this configuration".to_owned(),
                    n => format!("prescribe {n} independent speeds in this configuration"),
                };
                let d = Diagnostic::new(Code::ContradictorySpeeds, format!("{place}.speeds"), message).hint(hint);
                // Measured speeds contradict each other a little.
                match *relative < Train::MOST_SPEED_TOLERANCE && !others.is_empty() {
                    true => d.hint(format!(
                        "the speeds contradict the gears by {} % of the largest, as the gears tie them; where speeds are \
                         measured, `speed_tolerance` says by how much they may",
                        significant(100.0 * relative)
                    )),
                    false => d,
                }
            }
            Self::SpeedTooLarge => Diagnostic::new(Code::TooLarge, place, "a speed is beyond 1e308 rad/s"),
            Self::TorqueTooLarge => Diagnostic::new(Code::TooLarge, place, "a torque or power is beyond 1e308"),
            Self::DragTooLarge(m) => {
                Diagnostic::new(Code::TooLarge, place, format!("the drag on `{}` is beyond 1e50 N m", name(*m)))
            }
            Self::PowerAtRest(m, power) => {
                let (place, name) = (format!("{place}.powers.{}", name(*m)), name(*m));
                let message = format!("{} W at `{name}`, which stands still here", short(*power));
                Diagnostic::new(Code::PowerAtRest, place, message).hint("give its torque instead")
            }
            Self::PowerWithoutSpeed(m) => {
                let place = format!("{place}.powers.{}", name(*m));
                let message = format!("`{}` has no determined speed here", name(*m));
                Diagnostic::new(Code::PowerAtRest, place, message)
                    .hint("give its torque instead, or prescribe another speed")
            }
            Self::Together([a, b]) => {
                let message = format!(
                    "`{}` and `{}` turn as one here, and neither has a torque: only their sum can be found",
                    name(*a),
                    name(*b)
                );
                Diagnostic::new(Code::MissingTorque, format!("{place}.torques"), message)
                    .hint("give the torque or power of one of them")
            }
            Self::MissingLoads { freedoms, coupled, at_rest, open, more } => {
                let message = format!(
                    "with {} {} can be left without a torque or power, but {}: {}",
                    self::freedoms(*freedoms),
                    balancing(*freedoms, *coupled, open.len().saturating_sub(*more)),
                    if open.len() == 1 { "1 has none".to_owned() } else { format!("{} have none", open.len()) },
                    names(train, open.iter().copied()).join(", ")
                );
                let d = Diagnostic::new(Code::MissingTorque, format!("{place}.torques"), message);
                resting(train, at_rest, d.hint(format!("give {more} more, \"0 N m\" where nothing acts")))
            }
            Self::TooManyLoads { freedoms, coupled, at_rest, open, more } => {
                let message = format!(
                    "with {} {} must be left without a prescribed torque to balance the train; here {} left",
                    self::freedoms(*freedoms),
                    balancing(*freedoms, *coupled, open + more),
                    if *open == 1 { "1 is".to_owned() } else { format!("{open} are") },
                );
                let hint = match train.terminals.is_empty() {
                    true => "name the members that take part in `terminals`".to_owned(),
                    false => format!("leave out {more} of the torques, or list another member in `terminals`"),
                };
                let d = Diagnostic::new(Code::TooManyTorques, format!("{place}.torques"), message).hint(hint);
                resting(train, at_rest, d)
            }
        }
    }
}

impl Finding {
    fn tell(&self, train: &Train, operation: &Operation) -> Option<Diagnostic> {
        let place = operation.place.as_str();
        Some(match self {
            Self::Why(why) => {
                let (code, hint) = why.warning()?;
                let d = Diagnostic::new(code, place, why.to_string());
                hint.into_iter().fold(d, Diagnostic::hint)
            }
            Self::MaySpin(members) => {
                let members = names(train, members.iter().copied()).join(", ");
                let message = format!("{members} may spin at any speed; nothing is transmitted there");
                Diagnostic::new(Code::Undetermined, place, message)
            }
            Self::VariatorAtRest(k) => Diagnostic::new(Code::VariatorAtRest, place, at_rest(train, *k))
                .hint("give one more torque, of a machine or of a terminal, or a speed at which one side turns"),
            Self::Beyond(beyond) => Diagnostic::new(Code::BeyondLimit, place, beyond.to_string()),
            Self::OutsideMap(machine) => {
                let message =
                    format!("{machine} runs outside the map of its efficiency; the value at its edge was taken");
                Diagnostic::new(Code::OutsideMap, place, message)
            }
            Self::Stiction(ranges) => {
                let range = |r: &StictionRange| match (r.low, r.high) {
                    (Some(low), Some(high)) => format!("{} between {} and {}", r.what, short(low), short(high)),
                    _ => format!("{} open", r.what),
                };
                let ranges: Vec<_> = ranges.iter().map(range).collect();
                let message = format!(
                    "a loaded mesh is at rest relative to its carrier; its friction leaves {}",
                    ranges.join(", ")
                );
                Diagnostic::new(Code::Stiction, place, message)
            }
            Self::Yield(d) => {
                let (last, others) = d.members.split_last()?;
                let message = format!(
                    "the speeds of {} contradict the gears by {} % of the largest, as the gears tie them; `{last}` follows {}",
                    d.members.join(", "),
                    significant(100.0 * d.relative),
                    if others.len() == 1 { "the other" } else { "the others" },
                );
                Diagnostic::new(Code::SpeedsYield, format!("{place}.speeds"), message)
            }
            Self::Doubt(doubt) => Diagnostic::new(Code::Implausible, place, doubt.to_string()),
            Self::Outside(law) => Diagnostic::new(Code::OutsideLaw, place, law.to_string()),
            Self::NoHeat(verdict) => {
                let message = match verdict {
                    Some(verdict) => format!(
                        "no oil temperature follows: at some temperature the operating point is {}",
                        verdict.words()
                    ),
                    None => "no oil temperature follows: the thermal network has no finite temperatures".to_owned(),
                };
                Diagnostic::new(Code::NoHeatBalance, place, message)
                    .hint("the temperature of the oil in the file was taken")
            }
            Self::TooHot { limit, reaching, carried } => {
                let message = format!(
                    "at the limit of {} °C {} W reach the oil and {} W are carried away: it gets hotter than allowed",
                    celsius(*limit),
                    watts(*reaching),
                    watts(*carried)
                );
                Diagnostic::new(Code::NoHeatBalance, place, message)
                    .hint("the answer is that at the limit; less load, a larger area, moving air or a cooler helps")
            }
            Self::SeveralTemperatures { others, undecided, taken } => {
                let all = others
                    .iter()
                    .map(|(t, stable)| format!("{} °C{}", celsius(*t), if *stable { "" } else { " (not stable)" }));
                let mut parts: Vec<String> = vec![];
                if others.len() > 1 {
                    parts.push(format!("losses and heat flow agree at {}", all.collect::<Vec<_>>().join(", ")));
                }
                let open = |[a, b]: &[f64; 2]| format!("{} to {} °C", celsius(*a), celsius(*b));
                if !undecided.is_empty() {
                    let list: Vec<String> = undecided.iter().map(open).collect();
                    parts.push(format!("it is not decided whether they agree from {}", list.join(", ")));
                }
                let message = format!("{}; from a cold start: {} °C", parts.join("; "), celsius(*taken));
                Diagnostic::new(Code::SeveralTemperatures, place, message)
            }
            Self::HeatStep { oil, step: [below, above] } => {
                let message = format!(
                    "the oil temperature of {} °C rests on a step of a law: {} W just below it, {} W just above",
                    celsius(*oil),
                    watts(*below),
                    watts(*above)
                );
                Diagnostic::new(Code::HeatStep, place, message)
            }
            Self::CoolerHeats(heat) => {
                let message = format!("what should cool is warmer than the oil and heats it by {} W", watts(*heat));
                Diagnostic::new(Code::NoHeatBalance, place, message)
                    .hint("a thermostat keeps it shut until the oil is warm")
            }
            Self::Near { torque, boundary: b } => {
                let (what, unit, factor, effect) = match torque {
                    true => ("torque", "N m", 1.0, "unloads"),
                    false => ("speed", "rpm", 30.0 / std::f64::consts::PI, "stops the relative motion in"),
                };
                let message = format!(
                    "a {what} of {} instead of {} {unit} at {} {effect} {}",
                    short(b.boundary * factor),
                    short(b.value * factor),
                    b.member,
                    b.mesh
                );
                Diagnostic::new(Code::NearBoundary, place, message)
            }
        })
    }
}

/// Names of members.
pub(super) fn names(train: &Train, members: impl IntoIterator<Item = MemberId>) -> Vec<String> {
    members.into_iter().map(|m| name_of(train, m)).collect()
}

/// The name of a member, or what stands behind a [bus](crate::kinematics::Configuration::bus).
pub(super) fn name_of(train: &Train, member: MemberId) -> String {
    if let Some(own) = train.members.get(member.0) {
        return own.name.clone();
    }
    let mut buses = train.variators.iter().filter(|v| v.has_bus());
    let bus = member.0.checked_sub(train.members.len()).and_then(|k| buses.nth(k));
    format!("the store of {}", bus.map_or("a variator", |v| &v.name))
}

/// Names of shift elements.
pub(super) fn element_names(train: &Train, elements: &[ShiftElementId]) -> Vec<String> {
    elements.iter().map(|e| train.shift_elements[e.0].name.clone()).collect()
}

/// What it means that all members of a variator stand still.
fn at_rest(train: &Train, variator: usize) -> String {
    let v = &train.variators[variator];
    format!(
        "{} stand still, so {} passes no power and nothing couples the torques of its sides; it is left out",
        names(train, v.members()).join(" and "),
        v.name
    )
}

/// A refusal with what variators at rest have to do with it.
fn resting(train: &Train, variators: &[usize], refusal: Diagnostic) -> Diagnostic {
    variators.iter().map(|k| at_rest(train, *k)).fold(refusal, Diagnostic::hint)
}

/// How many terminals balance a train whose variators settle `coupled` torques. A freedom may be that of a member that no
/// terminal moves, and a terminal may stand still.
fn balancing(freedoms: usize, coupled: usize, terminals: usize) -> String {
    let count = |n: usize| match n {
        0 => "no terminal".to_owned(),
        1 => "one terminal".to_owned(),
        n => format!("{n} terminals"),
    };
    match (coupled, freedoms.saturating_sub(coupled)) {
        (0, n) if n == terminals => "as many terminals".into(),
        (0, _) => format!("{} (not each freedom moves one)", count(terminals)),
        _ => format!("and its variators {}", count(terminals)),
    }
}

/// `2 degrees of freedom`.
pub(super) fn freedoms(n: usize) -> String {
    format!("{n} degree{} of freedom", if n == 1 { "" } else { "s" })
}

/// A number for a sentence.
/// Two significant digits.
fn significant(x: f64) -> String {
    let decimals = (1 - x.abs().log10().floor() as i32).clamp(0, 12) as usize;
    format!("{x:.decimals$}")
}

pub(super) fn short(x: f64) -> String {
    let text = format!("{x:.4}");
    if text.parse::<f64>() == Ok(0.0) && x != 0.0 { format!("{x:.3e}") } else { text }
}

/// A temperature for a sentence.
fn celsius(kelvin: f64) -> String {
    format!("{:.1}", kelvin - 273.15)
}

/// A power for a sentence.
fn watts(x: f64) -> String {
    if x.abs() < 100.0 { format!("{x:.1}") } else { format!("{x:.0}") }
}
