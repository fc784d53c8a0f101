//! What is asked at every point of a study: the operating point that the settings of a point mean.

use std::collections::HashMap;
use std::sync::{Arc, OnceLock};

use serde::{Deserialize, Serialize};

use crate::analysis;
use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::exact::Rational;
use crate::kinematics::{Configuration, Transfer, common};
use crate::model::{Model, ShaftRef, Target, oil_temperature, quantity};
use crate::train::{Document, Load, MemberId, Operation, Store, Train};
use crate::units::{Dimension, Quantity};
use crate::work::Effort;

/// What stays the same while other quantities vary.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Hold {
    /// The loads as the operation gives them, torques as torques and powers as powers.
    #[default]
    AsGiven,
    /// The torques of the loads.
    Torque,
    /// The powers of the loads.
    Power,
    /// The torque at the output, as it is in the operation.
    Output,
}

impl Hold {
    /// All there are.
    pub const ALL: [Self; 4] = [Self::AsGiven, Self::Torque, Self::Power, Self::Output];

    /// Its name in the train file: `as-given`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::AsGiven => "as-given",
            Self::Torque => "torque",
            Self::Power => "power",
            Self::Output => "output",
        }
    }

    /// By its name in the train file.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|h| h.name() == name)
    }
}

/// Most values that are kept.
const MOST_READ: usize = 4096;
/// Most trains that are kept.
const MOST_TRAINS: usize = 64;

/// The operating point from which a study starts, and what is held.
#[derive(Clone, Debug)]
pub struct PointSetup<'s> {
    model: &'s Model,
    base: Operation,
    hold: Hold,
    /// The torque that the output keeps, positive where it drives.
    output: Option<Quantity>,
    /// The file without its questions, for trains with other values: the point has its operation already.
    alone: OnceLock<Document>,
}

/// Trains that differ in quantities of their file, kept for the next point.
#[derive(Debug)]
pub struct TrainCache {
    /// How many are kept that differ from others in numbers alone.
    most: usize,
    known: HashMap<Settings, Made>,
    /// Trains that nobody asks for any more, to be given other numbers.
    spare: Vec<(Settings, Arc<Train>)>,
    /// How the speeds of a train follow from those that are prescribed, for the last such question.
    transfer: Option<(Tied, Transfer)>,
    /// Values that were read: an axis says the same ones again and again.
    read: HashMap<String, (Dimension, Quantity)>,
}

/// A train with other values of its file, or why there is none.
#[derive(Clone, Debug)]
struct Made {
    train: Result<Arc<Train>, Diagnostics>,
    /// Whether it differs from others with the same settings in those numbers alone.
    by_numbers: bool,
}

/// A train, and what of it is held and prescribed.
#[derive(Debug)]
struct Tied {
    train: Arc<Train>,
    state: Option<usize>,
    fixed: Vec<MemberId>,
    prescribed: Vec<MemberId>,
}

impl Tied {
    fn is_of(&self, train: &Arc<Train>, operation: &Operation) -> bool {
        Arc::ptr_eq(&self.train, train)
            && self.state == operation.state
            && self.fixed == operation.fixed
            && self.prescribed.iter().eq(operation.speeds.iter().map(|(m, _)| m))
    }
}

impl Default for TrainCache {
    fn default() -> Self {
        Self { most: MOST_TRAINS, known: HashMap::new(), spare: vec![], transfer: None, read: HashMap::new() }
    }
}

impl TrainCache {
    /// For points of which hardly one has the values of another.
    pub(crate) fn of_samples() -> Self {
        Self { most: 4, ..Self::default() }
    }

    /// Forgets trains where there are many; those that can be given other numbers are kept for that.
    fn make_room(&mut self) {
        let is_full = self.known.len() >= MOST_TRAINS;
        if !is_full && self.known.values().filter(|made| made.by_numbers).count() < self.most {
            return;
        }
        self.spare.clear();
        for (key, made) in std::mem::take(&mut self.known) {
            match made {
                Made { train: Ok(train), by_numbers: true } => self.spare.push((key, train)),
                _ if is_full => {}
                made => drop(self.known.insert(key, made)),
            }
        }
    }

    /// One that differs from the train asked for in the values of these settings alone.
    fn spare(&mut self, key: &Settings) -> Option<Arc<Train>> {
        let is_alike = |own: &Settings| own.len() == key.len() && own.iter().zip(key).all(|(a, b)| a.0 == b.0);
        let at = self.spare.iter().rposition(|(own, _)| is_alike(own))?;
        Some(self.spare.swap_remove(at).1)
    }

    /// A value with a unit.
    fn quantity(&mut self, text: &str, dimension: Dimension) -> Result<Quantity, Diagnostics> {
        if let Some((_, known)) = self.read.get(text).filter(|(of, _)| *of == dimension) {
            return Ok(known.clone());
        }
        let read = quantity(text, dimension).map_err(|message| refuse(Code::BadAxis, message, ""))?;
        if self.read.len() >= MOST_READ {
            self.read.clear();
        }
        self.read.insert(text.to_owned(), (dimension, read.clone()));
        Ok(read)
    }

    /// Whether a member turns backwards at the prescribed speeds, as far as they say.
    fn turns_backwards(&mut self, train: &Arc<Train>, operation: &Operation, member: MemberId) -> bool {
        if !self.transfer.as_ref().is_some_and(|(tied, _)| tied.is_of(train, operation)) {
            let engaged = operation.state.map_or(&[][..], |k| &train.states[k].engaged);
            let prescribed: Vec<MemberId> = operation.speeds.iter().map(|(m, _)| *m).collect();
            let transfer = Configuration::new(train, engaged, &operation.fixed, &prescribed).transfer(&prescribed);
            let (train, state, fixed) = (train.clone(), operation.state, operation.fixed.clone());
            self.transfer = Some((Tied { train, state, fixed, prescribed }, transfer));
        }
        let (_, transfer) = self.transfer.as_ref().expect("just made");
        if transfer.conflicts.is_empty() {
            let (values, _) = common(operation.speeds.iter().map(|(_, q)| q));
            let Some(factors) = &transfer.speeds[member.0] else { return false };
            let speed = factors.iter().zip(&values).fold(Rational::ZERO, |sum, (f, v)| sum + f * v);
            return speed.sign() < 0;
        }
        // Speeds that contradict each other may yield.
        speeds(train, operation)(member).is_some_and(|w| w.value.sign() < 0)
    }
}

/// What differs from the file.
type Settings = Vec<(Target, String)>;

/// Speeds of members in an operation, where they are determined.
pub(super) fn speeds(train: &Train, operation: &Operation) -> impl Fn(MemberId) -> Option<Quantity> + use<> {
    let engaged = operation.state.map_or(&[][..], |k| &train.states[k].engaged);
    let prescribed: Vec<MemberId> = operation.speeds.iter().map(|(m, _)| *m).collect();
    let c = Configuration::new(train, engaged, &operation.fixed, &prescribed);
    let motion = c.motion(&operation.speeds).ok();
    move |m| {
        let motion = motion.as_ref()?;
        let value = motion.speeds[m.0].clone()?;
        Some(Quantity { value, pi_power: motion.pi_power, dimension: Dimension::ANGULAR_SPEED })
    }
}

fn refuse(code: Code, message: String, hint: &str) -> Diagnostics {
    let d = Diagnostic::new(code, "", message);
    Diagnostics::from_iter([if hint.is_empty() { d } else { d.hint(hint) }])
}

impl<'s> PointSetup<'s> {
    /// The operation of that name, else the first of the state that is named, else the file's first (in that state), else
    /// an operating point in which nothing is prescribed yet.
    ///
    /// # Errors
    /// No such operation or state; an operation whose loads cannot be held as asked.
    pub fn new(
        model: &'s Model,
        operation: Option<&str>,
        state: Option<&str>,
        hold: Hold,
    ) -> Result<Self, Diagnostics> {
        let train = model.train();
        let state = state.map(|name| train.find_state(name)).transpose()?;
        let found = match operation {
            Some(name) => Some(train.find_operation(name)?),
            None => match state {
                Some(k) => train.operations.iter().find(|o| o.state == Some(k)).or(train.operations.first()),
                None => train.operations.first(),
            },
        };
        let mut base = found.cloned().unwrap_or_else(|| Operation {
            name: "study".into(),
            state: None,
            speeds: vec![],
            fixed: vec![],
            loads: vec![],
            stores: vec![],
            machines: vec![],
            temperature: None,
            place: String::new(),
        });
        base.state = state.or(base.state);
        let mut question = Self { model, base, hold, output: None, alone: OnceLock::new() };
        question.settle()?;
        Ok(question)
    }

    /// The train of the study.
    pub fn model(&self) -> &'s Model {
        self.model
    }

    /// The operating point from which the study starts.
    pub fn base(&self) -> &Operation {
        &self.base
    }

    /// Gives the oil a temperature, K, at every point that does not say another.
    pub(super) fn warm(&mut self, oil: f64) {
        self.base.temperature = Some(oil);
    }

    /// How much work it is at so many trains that differ in values of their file, at so many points each.
    pub fn effort(&self, trains: u64, points_each: u64) -> Effort {
        Effort::of_trains(self.model.train(), self.alone().text().len(), trains, points_each)
    }

    /// The file without its questions.
    fn alone(&self) -> &Document {
        self.alone.get_or_init(|| self.model.document().without_questions())
    }

    /// What is held.
    pub fn hold(&self) -> Hold {
        self.hold
    }

    /// Puts the loads of the base into the form that is held.
    fn settle(&mut self) -> Result<(), Diagnostics> {
        let train = self.model.train();
        if matches!(self.hold, Hold::AsGiven) || self.base.loads.is_empty() {
            return match self.hold {
                Hold::Output => Err(refuse(
                    Code::Unfit,
                    "there is no operation whose output could be held".into(),
                    "name one (`operation`), or prescribe `output.torque` itself",
                )),
                _ => Ok(()),
            };
        }
        if self.hold == Hold::Output {
            let output = self.role(train, &self.base, ShaftRef::Output)?;
            let (report, _) = analysis::operate(train, &self.base)?;
            let name = train.member_name(output);
            let torque = match &report.solutions[..] {
                [one] => one.members.get(name).and_then(|m| m.torque_n_m),
                _ => None,
            };
            let Some(torque) = torque.and_then(Rational::from_f64) else {
                let why = report.reason.unwrap_or_else(|| "its torque is not determined".into());
                let message = format!("operation `{}` has no one torque at the output to hold: {why}", self.base.name);
                return Err(refuse(Code::Unfit, message, ""));
            };
            let backwards = speeds(train, &self.base)(output).is_some_and(|w| w.value.sign() < 0);
            // By its role, so that it drives in every state.
            let torque = if backwards { torque } else { -torque };
            self.output = Some(Quantity { value: torque, pi_power: 0, dimension: Dimension::TORQUE });
            if self.base.loads.len() > 1 && !self.base.loads.iter().any(|l| l.0 == output) {
                let message =
                    format!("operation `{}` has several loads; which one `{name}` replaces is open", self.base.name);
                return Err(refuse(Code::Unfit, message, "give the loads at the output in the operation"));
            }
            match self.base.loads.len() {
                1 => self.base.loads.clear(),
                _ => self.base.loads.retain(|l| l.0 != output),
            }
            return Ok(());
        }
        let speeds = speeds(train, &self.base);
        for (member, load) in &mut self.base.loads {
            let speed = || {
                speeds(*member).filter(|w| !w.value.is_zero()).ok_or_else(|| {
                    let name = train.member_name(*member);
                    refuse(
                        Code::Unfit,
                        format!("`{name}` has no speed at which torque and power could be exchanged"),
                        "",
                    )
                })
            };
            *load = match (self.hold, &*load) {
                (Hold::Torque, Load::Power(p)) => {
                    let w = speed()?;
                    let (value, pi_power) = (&p.value / &w.value, p.pi_power - w.pi_power);
                    Load::Torque(Quantity { value, pi_power, dimension: Dimension::TORQUE })
                }
                (Hold::Power, Load::Torque(t)) => {
                    let w = speed()?;
                    let (value, pi_power) = (&t.value * &w.value, t.pi_power + w.pi_power);
                    Load::Power(Quantity { value, pi_power, dimension: Dimension::POWER })
                }
                (_, same) => same.clone(),
            };
        }
        Ok(())
    }

    pub(super) fn role(&self, train: &Train, operation: &Operation, who: ShaftRef) -> Result<MemberId, Diagnostics> {
        let [input, output] = train.ends(operation.state);
        let (found, what) = match who {
            ShaftRef::Member(m) => return Ok(m),
            ShaftRef::Input => (input, "input"),
            ShaftRef::Output => (output, "output"),
        };
        found.ok_or_else(|| {
            let hint = "name two `terminals`, or `input` and `output`; or call the member by its name";
            refuse(Code::NothingAsked, format!("the train has no {what}"), hint)
        })
    }

    /// The train and the operating point that these settings mean.
    ///
    /// # Errors
    /// A train that cannot be built so; a speed or load of which it is open what it replaces.
    pub fn at(
        &self,
        settings: &[(&Target, String)],
        trains: &mut TrainCache,
    ) -> Result<(Arc<Train>, Operation), Diagnostics> {
        let train = self.train(settings, trains)?;
        let operation = self.operation(&train, settings, trains)?;
        Ok((train, operation))
    }

    fn train(&self, settings: &[(&Target, String)], trains: &mut TrainCache) -> Result<Arc<Train>, Diagnostics> {
        let of_train: Vec<(&Target, String)> =
            settings.iter().filter(|s| s.0.is_of_train()).map(|(t, v)| (*t, v.clone())).collect();
        let key: Settings = of_train.iter().map(|(t, v)| ((*t).clone(), v.clone())).collect();
        if let Some(known) = trains.known.get(&key) {
            return known.train.clone();
        }
        trains.make_room();
        let made = self.make(&key, &of_train, trains);
        let train = made.train.clone();
        trains.known.insert(key, made);
        train
    }

    fn make(&self, key: &Settings, settings: &[(&Target, String)], trains: &mut TrainCache) -> Made {
        let spare = trains.spare(key).and_then(|spare| self.model.with_other_numbers(spare, settings));
        if let Some(train) = spare.or_else(|| self.model.with_numbers(settings).map(Arc::new)) {
            return Made { train: Ok(train), by_numbers: true };
        }
        let leads_into_a_question = |s: &(&Target, String)| matches!(s.0, Target::File(key) if key.is_of_a_question());
        let document = match settings.iter().any(leads_into_a_question) {
            true => self.model.document(),
            false => self.alone(),
        };
        Made { train: self.model.train_with(document, settings).map(Arc::new), by_numbers: false }
    }

    /// The operating point on a train.
    fn operation(
        &self,
        train: &Arc<Train>,
        settings: &[(&Target, String)],
        trains: &mut TrainCache,
    ) -> Result<Operation, Diagnostics> {
        let mut operation = self.base.clone();
        let wrong = |message: String| refuse(Code::BadAxis, message, "");
        // The state first: input and output are its.
        for (target, value) in settings {
            match target {
                Target::State => {
                    operation.state = Some(train.find_state(value)?);
                }
                Target::Temperature => {
                    let t = trains.quantity(value, Dimension::TEMPERATURE)?;
                    operation.temperature = Some(oil_temperature(t.si()).map_err(|d| Diagnostics::from_iter([*d]))?);
                }
                _ => {}
            }
        }
        let mut speeds = vec![];
        for (target, value) in settings {
            if let Target::Speed(who) = target {
                let member = self.role(train, &operation, *who)?;
                speeds.push((member, trains.quantity(value, Dimension::ANGULAR_SPEED)?));
            }
        }
        operation.speeds = replaced(train, "speed", &operation.speeds, speeds)?;
        for (target, value) in settings {
            match target {
                Target::Ratio => {
                    let ratio = value.parse().map_err(|_| wrong(format!("a ratio of {value}")))?;
                    self.at_ratio(train, &mut operation, &ratio)?;
                }
                Target::Store(k) => {
                    let power = trains.quantity(value, Dimension::POWER)?;
                    operation.stores.retain(|(of, _)| of != k);
                    operation.stores.push((*k, Store::Power(power)));
                }
                _ => {}
            }
        }
        let mut loads = vec![];
        for (target, value) in settings {
            let (who, load) = match target {
                Target::Torque(who) => (who, Load::Torque(trains.quantity(value, Dimension::TORQUE)?)),
                Target::Power(who) => (who, Load::Power(trains.quantity(value, Dimension::POWER)?)),
                _ => continue,
            };
            let member = self.role(train, &operation, *who)?;
            loads.push((member, *who, load));
        }
        if let Some(held) = &self.output {
            let member = self.role(train, &operation, ShaftRef::Output)?;
            if !loads.iter().any(|l| l.0 == member) {
                loads.push((member, ShaftRef::Output, Load::Torque(held.clone())));
            }
        }
        if loads.is_empty() {
            return Ok(operation);
        }
        let new = loads.into_iter().map(|(member, who, load)| {
            let with_role = matches!((who, &load), (ShaftRef::Input | ShaftRef::Output, Load::Torque(_)));
            let backwards = with_role && trains.turns_backwards(train, &operation, member);
            // Power of the load is positive into the train.
            let turn = match (&load, who) {
                (_, ShaftRef::Member(_)) => false,
                (Load::Torque(_), ShaftRef::Input) => backwards,
                (Load::Torque(_), ShaftRef::Output) => !backwards,
                (Load::Power(_), ShaftRef::Input) => false,
                (Load::Power(_), ShaftRef::Output) => true,
            };
            let sign = |q: Quantity| if turn { Quantity { value: -q.value, ..q } } else { q };
            let load = match load {
                Load::Torque(q) => Load::Torque(sign(q)),
                Load::Power(q) => Load::Power(sign(q)),
            };
            (member, load)
        });
        operation.loads = replaced(train, "load", &operation.loads, new.collect())?;
        Ok(operation)
    }
}

impl PointSetup<'_> {
    /// Lets the output turn so that the input, which turns as it did, is `ratio` times as fast.
    fn at_ratio(&self, train: &Train, operation: &mut Operation, ratio: &Rational) -> Result<(), Diagnostics> {
        let [input, output] =
            [self.role(train, operation, ShaftRef::Input)?, self.role(train, operation, ShaftRef::Output)?];
        let name = |m: MemberId| train.member_name(m);
        let Some(speed) = speeds(train, operation)(input).filter(|w| !w.value.is_zero()) else {
            let message =
                format!("`{}` has no speed, so a ratio says nothing of that of `{}`", name(input), name(output));
            return Err(refuse(Code::Unfit, message, "prescribe the speed of the input in the operation"));
        };
        let follows = Quantity { value: &speed.value / ratio, ..speed.clone() };
        let has = |m: MemberId| operation.speeds.iter().any(|(own, _)| *own == m);
        if !has(input) {
            // It followed from others; now it is what they follow from.
            let others: Vec<MemberId> = operation.speeds.iter().map(|s| s.0).filter(|m| *m != output).collect();
            let [other] = others[..] else {
                let message = format!("which speed gives way to that of `{}` is open", name(input));
                return Err(refuse(Code::BadAxis, message, "prescribe the speed of the input in the operation"));
            };
            operation.speeds.retain(|s| s.0 != other);
            operation.speeds.push((input, speed));
        }
        let mut all = operation.speeds.clone();
        match all.iter_mut().find(|s| s.0 == output) {
            Some(own) => own.1 = follows,
            None => {
                // One freedom is left, and the ratio takes it; a speed that stood there gives way.
                let others: Vec<MemberId> = all.iter().map(|s| s.0).filter(|m| *m != input).collect();
                if let [other] = others[..] {
                    all.retain(|s| s.0 != other);
                }
                all.push((output, follows));
            }
        }
        operation.speeds = all;
        Ok(())
    }
}

/// What the base prescribes, with new values: of the same member in its place, else of the only one that is left.
fn replaced<T: Clone>(
    train: &Train,
    what: &str,
    base: &[(MemberId, T)],
    new: Vec<(MemberId, T)>,
) -> Result<Vec<(MemberId, T)>, Diagnostics> {
    if let Some(k) = (1..new.len()).find(|&k| new[..k].iter().any(|n| n.0 == new[k].0)) {
        let message = format!("the {what} of `{}` is set twice", train.member_name(new[k].0));
        return Err(refuse(Code::BadAxis, message, "input and output may be the members that are named too"));
    }
    let mut all: Vec<(MemberId, T)> = base.to_vec();
    let (mut others, mut again) = (vec![], vec![]);
    for (member, value) in new {
        match all.iter_mut().find(|a| a.0 == member) {
            Some(own) => {
                own.1 = value;
                again.push(member);
            }
            None => others.push((member, value)),
        }
    }
    if others.is_empty() {
        return Ok(all);
    }
    let is_set = |m: &MemberId| !base.iter().any(|b| b.0 == *m) || again.contains(m);
    let left: Vec<MemberId> = all.iter().map(|a| a.0).filter(|m| !is_set(m)).collect();
    if others.len() >= left.len() {
        // As many new ones as are left: they take their places.
        all.retain(|a| is_set(&a.0));
        all.extend(others);
        return Ok(all);
    }
    let set: Vec<MemberId> = others.iter().map(|o| o.0).collect();
    let names = |m: &[MemberId]| m.iter().map(|m| train.member_name(*m)).collect::<Vec<_>>().join(", ");
    let message = format!(
        "the operation prescribes a {what} of {}; which one that of {} replaces is open",
        names(&left),
        names(&set)
    );
    Err(refuse(Code::Unfit, message, "vary as many as are to be replaced, or those that the operation prescribes"))
}
