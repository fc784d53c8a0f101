//! What a gear costs at a stated load, and with none: the shift table of a train whose losses depend on load and speed.

use serde::{Deserialize, Serialize};

use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::exact::Rational;
use crate::kinematics::{Configuration, Ratio};
use crate::train::{Load, MemberId, Operation, Train};
use crate::units::{AngularSpeed, Dimension, Quantity, Torque};

use super::band::LawBand;
use super::losses::{self, beyond_oils, quantity};
use super::{
    HeatBasis, LossSource, Losses, OperationReport, SolutionReport, Verdict, at_its_temperature, operate_unnamed,
};

/// Speed and load of an input that drives: what gears are compared at.
///
/// # Example
/// ```
/// use willis::analysis::DrivingLoad;
/// use willis::train::{Load, Train};
/// use willis::units::{AngularSpeed, Torque};
///
/// let load = DrivingLoad::new(AngularSpeed::rpm(2000.0), Torque::n_m(150.0));
/// assert!(matches!(load.load, Load::Torque(_)));
/// // 150 N m at 2000 r/min.
/// assert!((load.torque() - 150.0).abs() < 1e-12);
/// # Ok::<(), willis::Diagnostics>(())
/// ```
#[derive(Clone, Debug)]
pub struct DrivingLoad {
    /// Speed of the input.
    pub speed: Quantity,
    /// Torque or power at the input.
    pub load: Load,
    /// Oil temperature, K, where it is prescribed.
    pub temperature: Option<f64>,
    /// The operation of the file whose speed and load these are.
    pub operation: Option<String>,
}

impl DrivingLoad {
    /// A speed and a torque at the input.
    pub fn new(speed: AngularSpeed, torque: Torque) -> Self {
        Self { speed: speed.into(), load: Load::Torque(torque.into()), temperature: None, operation: None }
    }

    /// That of an operation in which this member drives: as it is given there, else as it is found. None where anything beside
    /// input and output loads the train, holds it or hands power over: that is another point than a speed and a torque.
    ///
    /// # Example
    /// ```
    /// use willis::analysis::DrivingLoad;
    /// use willis::train::Train;
    ///
    /// let train = Train::from_toml(r#"
    ///     format = 1
    ///     name = "one set"
    ///     members = ["s", "c"]
    ///     terminals = ["s", "c"]
    ///     [[set]]
    ///     name = "P1"
    ///     sun = { member = "s", teeth = 30 }
    ///     ring = { member = "frame", teeth = 70 }
    ///     carrier = "c"
    ///     mesh_efficiency = 1.0
    ///     [[operation]]
    ///     name = "from the output"
    ///     speeds = { s = "1000 rpm" }
    ///     torques = { c = "-100 N m" }
    /// "#)?;
    /// let load = DrivingLoad::of_operation(&train, &train.operations()[0], train.member("s").unwrap()).unwrap();
    /// assert!((load.torque() - 30.0).abs() < 1e-9);
    /// # Ok::<(), willis::Diagnostics>(())
    /// ```
    pub fn of_operation(train: &Train, operation: &Operation, input: MemberId) -> Option<Self> {
        let output = train.ends(operation.state)[1];
        let aside = |(m, load): &(MemberId, Load)| *m != input && Some(*m) != output && !quantity(load).value.is_zero();
        let more = !operation.fixed.is_empty() || !operation.stores.is_empty() || !operation.machines.is_empty();
        if more || operation.loads.iter().any(aside) {
            return None;
        }
        let speed = operation.speeds.iter().find(|s| s.0 == input).map(|s| s.1.clone());
        let load = operation.loads.iter().find(|l| l.0 == input).map(|l| l.1.clone());
        let (speed, load) = speed.zip(load).or_else(|| Self::found(train, operation, input))?;
        let all = Self { speed, load, temperature: operation.temperature, operation: Some(operation.name.clone()) };
        all.drives().then_some(all)
    }

    /// That of the first operation of the file in which this member drives, as [`Self::of_operation`] has it.
    pub fn of_file(train: &Train, input: MemberId) -> Option<Self> {
        train.operations.iter().find_map(|o| Self::of_operation(train, o, input))
    }

    /// Speed and torque of a member in the only equilibrium of an operation.
    fn found(train: &Train, operation: &Operation, member: MemberId) -> Option<(Quantity, Load)> {
        let report = at_its_temperature(train, operation, false).ok()?.report;
        let ([only], Verdict::Unique) = (&report.solutions[..], report.verdict) else { return None };
        let found = only.members.get(train.member_name(member))?;
        let quantity =
            |value: f64, dimension| Some(Quantity { value: Rational::from_f64(value)?, pi_power: 0, dimension });
        let speed = quantity(found.speed_rad_s?, Dimension::ANGULAR_SPEED)?;
        Some((speed, Load::Torque(quantity(found.torque_n_m?, Dimension::TORQUE)?)))
    }

    fn drives(&self) -> bool {
        self.torque() * self.speed.si() > 0.0
    }

    /// Torque at the input, N m.
    pub fn torque(&self) -> f64 {
        match &self.load {
            Load::Torque(t) => t.si(),
            Load::Power(p) => p.si() / self.speed.si(),
        }
    }

    /// The operating point of a state in which its input drives its output so, while other terminals carry nothing. None
    /// where the output does not follow the input, or stands still.
    pub fn point(&self, train: &Train, state: Option<usize>, name: impl Into<String>) -> Option<Operation> {
        let [input, output] = follows(train, state)?;
        let loads =
            [(input, self.load.clone())].into_iter().chain(nothing_at_others(train, &[input, output])).collect();
        let speeds = vec![(input, self.speed.clone())];
        Some(Operation { state, speeds, loads, temperature: self.temperature, ..Operation::new(name) })
    }
}

fn nothing_at_others(train: &Train, but: &[MemberId]) -> impl Iterator<Item = (MemberId, Load)> {
    let none = Quantity { value: Rational::ZERO, pi_power: 0, dimension: Dimension::TORQUE };
    train.terminals.iter().filter(|m| !but.contains(m)).map(move |m| (*m, Load::Torque(none.clone())))
}

/// The operating point of a state in which its input turns and nothing acts on any other terminal: what turns it then is lost.
/// `oil_k`: oil temperature, K, where it is prescribed. None without an input.
///
/// # Example
/// ```
/// use willis::analysis::{idle, operate};
/// use willis::train::Train;
/// use willis::units::AngularSpeed;
///
/// let train = Train::from_toml(r#"
///     format = 1
///     name = "one set"
///     members = ["s", "c"]
///     terminals = ["s", "c"]
///     [[set]]
///     name = "P1"
///     sun = { member = "s", teeth = 30 }
///     ring = { member = "frame", teeth = 70 }
///     carrier = "c"
///     mesh_efficiency = 1.0
///     [[drag]]
///     name = "seal"
///     members = ["s", "frame"]
///     coulomb = "0.2 N m"
/// "#)?;
/// let point = idle(&train, None, &AngularSpeed::rad_s(100.0).into(), None).unwrap();
/// let (report, _) = operate(&train, &point)?;
/// let found = report.solutions.iter().chain(&report.dissipative_solutions).next().unwrap();
/// assert!((found.loss_w - 20.0).abs() < 1e-9);
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn idle(train: &Train, state: Option<usize>, speed: &Quantity, oil_k: Option<f64>) -> Option<Operation> {
    let input = train.ends(state)[0]?;
    let loads = nothing_at_others(train, &[input]).collect();
    let speeds = vec![(input, speed.clone())];
    Some(Operation { state, speeds, loads, temperature: oil_k, ..Operation::new("no load") })
}

/// Input and output of a state in which one follows the other.
fn follows(train: &Train, state: Option<usize>) -> Option<[MemberId; 2]> {
    let [Some(input), Some(output)] = train.ends(state) else { return None };
    let engaged = state.map_or(&[][..], |k| &train.states[k].engaged);
    let c = Configuration::new(train, engaged, &[], &[]);
    (input != output && matches!(c.ratio(input, output), Ratio::Exact(_))).then_some([input, output])
}

/// What of a load is asked for; the rest is that of the file's first operation in which the input drives.
///
/// # Example
/// ```
/// use willis::analysis::{AskedLoad, ShaftTableRequest, shaft_table};
/// use willis::train::Train;
/// use willis::units::{AngularSpeed, Torque};
///
/// let train = Train::from_toml(r#"
///     format = 1
///     name = "one set"
///     members = ["s", "c"]
///     terminals = ["s", "c"]
///     [[set]]
///     name = "P1"
///     sun = { member = "s", teeth = 30 }
///     ring = { member = "frame", teeth = 70 }
///     carrier = "c"
///     mesh_efficiency = 1.0
///     [[drag]]
///     name = "seal"
///     members = ["s", "frame"]
///     coulomb = "0.2 N m"
/// "#)?;
/// let (speed, torque) = (Some(AngularSpeed::rpm(3000.0).into()), Some(Torque::n_m(20.0).into()));
/// let load = Some(AskedLoad { speed, torque, temperature: None });
/// let table = shaft_table(&train, &ShaftTableRequest { load, ..ShaftTableRequest::default() })?;
/// let at = table.states.0[0].1.at_load.as_ref().unwrap();
/// assert!((at.efficiency.unwrap() - 0.99).abs() < 1e-9);
/// # Ok::<(), willis::Diagnostics>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct AskedLoad {
    /// Speed of the input.
    pub speed: Option<Quantity>,
    /// Torque at the input, positive: it drives whichever way the input turns.
    pub torque: Option<Quantity>,
    /// Oil temperature, K.
    pub temperature: Option<f64>,
}

impl AskedLoad {
    /// All that is wrong with it for a train whose losses depend on load.
    fn check(&self, train: &Train) -> Diagnostics {
        let mut wrong = beyond_oils(train, self.temperature.as_slice());
        for (what, given) in [("speed", &self.speed), ("torque", &self.torque)] {
            if given.as_ref().is_some_and(|q| q.value.is_zero()) {
                let text = format!("a {what} of zero at the input: nothing is driven");
                wrong.push(Diagnostic::new(Code::OutOfRange, "", text).hint("give another value, or leave it out"));
            }
        }
        if let Some(torque) = self.torque.as_ref().filter(|q| q.value.sign() < 0) {
            let text =
                format!("a torque of {:.6} N m at the input brakes it, and a driven train is asked for", torque.si());
            let hint = "give it as positive: it drives whichever way the input turns";
            wrong.push(Diagnostic::new(Code::OutOfRange, "", text).hint(hint));
        }
        wrong
    }

    /// The load of an input; none where neither this nor the file says at which speed, or under which torque. Where it is asked
    /// to turn the other way than in the file, it drives that way.
    fn of(&self, train: &Train, input: MemberId) -> Option<DrivingLoad> {
        let all = self.speed.is_some() && self.torque.is_some() && self.temperature.is_some();
        let file = if all { None } else { DrivingLoad::of_file(train, input) };
        let of_file = self.speed.is_none() && self.torque.is_none();
        let temperature = self.temperature.or_else(|| file.as_ref().and_then(|f| f.temperature));
        let operation = file.as_ref().and_then(|f| f.operation.clone()).filter(|_| of_file);
        let speed = self.speed.clone().or_else(|| file.as_ref().map(|f| f.speed.clone()));
        let speed = speed?;
        let load = match self.torque.clone() {
            Some(torque) => Load::Torque(torque),
            None => file?.load,
        };
        let mut load = DrivingLoad { speed, load, temperature, operation };
        // A power drives by itself.
        if !load.drives()
            && let Load::Torque(torque) = &mut load.load
        {
            torque.value = -&torque.value;
        }
        Some(load)
    }
}

/// The loads of inputs, each found once.
pub(super) struct Loads<'a> {
    train: &'a Train,
    asked: &'a AskedLoad,
    known: Vec<(MemberId, Option<DrivingLoad>)>,
}

impl<'a> Loads<'a> {
    /// # Errors
    /// All that is wrong with what is asked for.
    pub fn new(train: &'a Train, asked: &'a AskedLoad) -> Result<Self, Diagnostics> {
        let wrong = if train.depends_on_load() { asked.check(train) } else { Diagnostics::default() };
        if wrong.has_errors() { Err(wrong) } else { Ok(Self { train, asked, known: vec![] }) }
    }

    /// A state at the load of its input; none without one, and where losses depend on nothing.
    pub fn at(&mut self, state: Option<usize>) -> Option<Box<AtLoad>> {
        let input = self.train.ends(state)[0].filter(|_| self.train.depends_on_load())?;
        let at = self.known.iter().position(|(own, _)| *own == input).unwrap_or_else(|| {
            self.known.push((input, self.asked.of(self.train, input)));
            self.known.len() - 1
        });
        AtLoad::of(self.train, state, self.known[at].1.as_ref()?).map(Box::new)
    }
}

/// A gear at a stated load, and at the same speed without one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct AtLoad {
    /// The operation of the file whose speed and load these are; absent where they were asked for.
    pub operation: Option<String>,
    /// Speed of the input, rad/s.
    pub speed_rad_s: f64,
    /// Torque at the input, N m.
    pub torque_n_m: f64,
    /// Oil temperature, K: prescribed, of the heat balance, or of the oil; absent without an oil.
    pub temperature_k: Option<f64>,
    /// Whether no temperature up to the limit balances losses and heat flow: then it is the limit.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub beyond_limit: bool,
    /// What can be said of the point.
    pub verdict: Verdict,
    /// Output over input power.
    pub efficiency: Option<f64>,
    /// Between which values other laws put it, where that is asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub band: Option<Box<LawBand>>,
    /// All losses, W.
    pub loss_w: Option<f64>,
    /// Losses by kind, W.
    pub losses_w: Option<Losses>,
    /// What turns the input at this speed and temperature with nothing at the output, W: the spin loss.
    pub spin_loss_w: Option<f64>,
    /// That by kind, W.
    pub spin_losses_w: Option<Losses>,
    /// That by source, the largest first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub spin_sources: Vec<LossSource>,
    /// Why there is no efficiency.
    pub reason: Option<String>,
    /// Warnings of the point under load: laws outside their ranges, the heat balance, limits.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<String>,
}

impl AtLoad {
    /// A state of the train at a load. None where the output does not follow the input, and where losses depend on nothing:
    /// the table of ratios says all then.
    ///
    /// # Example
    /// ```
    /// use willis::analysis::{AtLoad, DrivingLoad};
    /// use willis::train::Train;
    /// use willis::units::{AngularSpeed, Torque};
    ///
    /// let train = Train::from_toml(r#"
    ///     format = 1
    ///     name = "one set"
    ///     members = ["s", "c"]
    ///     terminals = ["s", "c"]
    ///     [[set]]
    ///     name = "P1"
    ///     sun = { member = "s", teeth = 30 }
    ///     planet = { teeth = 20, count = 4 }
    ///     ring = { member = "frame", teeth = 70 }
    ///     carrier = "c"
    ///     mesh_efficiency = 0.99
    ///     [[drag]]
    ///     name = "seal"
    ///     members = ["s", "frame"]
    ///     coulomb = "0.2 N m"
    /// "#)?;
    /// let gear = AtLoad::of(&train, None, &DrivingLoad::new(AngularSpeed::rad_s(100.0), Torque::n_m(10.0))).unwrap();
    /// // The seal takes 20 W with and without load; of the rest the set passes 0.98607.
    /// assert!((gear.spin_loss_w.unwrap() - 20.0).abs() < 1e-9);
    /// assert!((gear.efficiency.unwrap() - 0.98 * 0.98607).abs() < 1e-9);
    /// # Ok::<(), willis::Diagnostics>(())
    /// ```
    pub fn of(train: &Train, state: Option<usize>, load: &DrivingLoad) -> Option<Self> {
        if !train.depends_on_load() {
            return None;
        }
        let point = load.point(train, state, "at load")?;
        let mut all = Self {
            operation: load.operation.clone(),
            speed_rad_s: load.speed.si(),
            torque_n_m: load.torque(),
            temperature_k: None,
            beyond_limit: false,
            verdict: Verdict::Undetermined,
            efficiency: None,
            band: None,
            loss_w: None,
            losses_w: None,
            spin_loss_w: None,
            spin_losses_w: None,
            spin_sources: vec![],
            reason: None,
            warnings: vec![],
        };
        let (loaded, notes) = match operate_unnamed(train, &point) {
            Ok(found) => found,
            Err(wrong) => {
                all.reason = Some(wrong.to_string());
                return Some(all);
            }
        };
        all.temperature_k = loaded.oil_k(train, &point);
        all.beyond_limit = loaded.heat.as_ref().is_some_and(|h| h.basis == HeatBasis::Limit);
        all.verdict = loaded.verdict;
        all.reason = loaded.reason;
        if let ([only], Verdict::Unique | Verdict::Unloaded) = (&loaded.solutions[..], loaded.verdict) {
            all.efficiency = only.efficiency;
            all.loss_w = Some(only.loss_w);
            all.losses_w = Some(only.losses_w);
        }
        all.warnings = losses::warnings(train, all.temperature_k, notes);
        // As warm as under load, not as warm as it would become without.
        let point = idle(train, state, &load.speed, all.temperature_k)?;
        let settled = at_its_temperature(train, &point, false).ok();
        if let Some(found) = settled.as_ref().and_then(|settled| dissipating(&settled.report)) {
            all.spin_loss_w = Some(found.loss_w);
            all.spin_losses_w = Some(found.losses_w);
            all.spin_sources = found.sources.clone();
        }
        Some(all)
    }
}

impl AtLoad {
    /// Between which values other laws put the efficiency of a state at this load and temperature.
    pub(super) fn law_band(&self, train: &Train, state: Option<usize>) -> Option<LawBand> {
        self.efficiency?;
        let quantity =
            |value: f64, dimension| Some(Quantity { value: Rational::from_f64(value)?, pi_power: 0, dimension });
        let load = DrivingLoad {
            speed: quantity(self.speed_rad_s, Dimension::ANGULAR_SPEED)?,
            load: Load::Torque(quantity(self.torque_n_m, Dimension::TORQUE)?),
            temperature: self.temperature_k,
            operation: None,
        };
        LawBand::of(train, &load.point(train, state, "at load")?)
    }

    /// For people: speed and torque at the input, `1500 rpm and 60 N m at the input`, by a writer of numbers; with the operation
    /// that has them, by a writer of names.
    pub fn point(&self, number: impl Fn(f64) -> String, name: impl Fn(&str) -> String) -> String {
        let of = self.operation.as_ref().map_or(String::new(), |o| format!(", the load of {}", name(o)));
        let rpm = self.speed_rad_s * 30.0 / std::f64::consts::PI;
        format!("{} rpm and {} N m at the input{of}", number(rpm), number(self.torque_n_m))
    }

    /// Warnings of several gears, each once.
    pub fn warnings_of<'a>(all: impl Iterator<Item = &'a Self>) -> Vec<&'a str> {
        let mut told: Vec<&str> = vec![];
        for text in all.flat_map(|a| &a.warnings) {
            if !told.contains(&text.as_str()) {
                told.push(text);
            }
        }
        told
    }

    /// Why nothing leaves at the output, or why that cannot be told.
    pub fn without_output(&self) -> Option<&str> {
        self.reason.as_deref().filter(|_| self.efficiency.is_none_or(|e| e == 0.0))
    }
}

/// The only equilibrium of a train that drives nothing.
fn dissipating(report: &OperationReport) -> Option<&SolutionReport> {
    let found = if report.solutions.is_empty() { &report.dissipative_solutions } else { &report.solutions };
    match &found[..] {
        [only] if !matches!(report.verdict, Verdict::Undetermined | Verdict::Multiple) => Some(only),
        _ => None,
    }
}
