//! A grid of operating points, one row a point.

use std::borrow::Cow;
use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::analysis::{self, Losses, SolutionReport, Verdict};
use crate::diagnostic::{Code, Diagnostic, Diagnostics, Severity};
use crate::train::{Operation, Train};

use super::axis::Axis;
use super::question::{Hold, Question, Trains};
use crate::model::Model;
use crate::model::Target;

/// What can be said of a point: the [verdicts](Verdict) of an operating point, and one for a point that makes none.
pub const VERDICTS: [&str; 6] = ["unique", "multiple", "locked", "unloaded", "undetermined", "refused"];

/// What a column holds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum What {
    Axis(usize),
    Verdict,
    Best,
    Efficiency,
    InputPower,
    OutputPower,
    Loss,
    LossOf(usize),
    Residual,
    Circulating,
    LockFactor,
    Speed(String),
    Torque(String),
    Power(String),
    MeshLoss(String),
    MeshEfficiency(String),
    MeshFriction(String),
    ElementTorque(String),
    SourceLoss(String),
    Reason,
    Warnings,
}

/// A column of the rows.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Column {
    /// Its name, with the unit in it.
    pub name: String,
    /// Whether it holds texts, not numbers.
    pub is_text: bool,
}

/// The values of a column.
#[derive(Clone, Debug, PartialEq)]
pub enum Cells {
    /// Numbers; NaN where there is none, and the verdict says why.
    Numbers(Vec<f64>),
    /// Texts; empty where there is none.
    Texts(Vec<Cow<'static, str>>),
}

/// Some rows, column by column.
#[derive(Clone, Debug, PartialEq)]
pub struct Rows {
    /// One for each column.
    pub columns: Vec<Cells>,
    /// What they say together.
    pub summary: Summary,
}

/// Least, greatest and sum of a quantity over the points that have one, and where the extremes are.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Extent {
    /// Points that have a value.
    pub count: u64,
    /// Their sum.
    pub sum: f64,
    /// The smallest, and the number of its point; told only where there is a value.
    #[serde(with = "extreme")]
    pub least: (f64, u64),
    /// The largest, and the number of its point.
    #[serde(with = "extreme")]
    pub most: (f64, u64),
}

/// `null` of no point at all.
mod extreme {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub fn serialize<S: Serializer>(value: &(f64, u64), to: S) -> Result<S::Ok, S::Error> {
        (value.0.abs() < f64::MAX).then_some(value).serialize(to)
    }

    /// Joined to others only where it counts points, so that either end of the numbers does.
    pub fn deserialize<'d, D: Deserializer<'d>>(from: D) -> Result<(f64, u64), D::Error> {
        Ok(Option::deserialize(from)?.unwrap_or((f64::NAN, 0)))
    }
}

impl Default for Extent {
    fn default() -> Self {
        Self { count: 0, sum: 0.0, least: (f64::MAX, 0), most: (f64::MIN, 0) }
    }
}

impl Extent {
    pub(super) fn add(&mut self, value: f64, point: u64) {
        if value.is_nan() {
            return;
        }
        self.count += 1;
        self.sum += value;
        if value < self.least.0 {
            self.least = (value, point);
        }
        if value > self.most.0 {
            self.most = (value, point);
        }
    }

    pub(super) fn join(&mut self, other: &Self) {
        if other.count == 0 {
            return;
        }
        self.count += other.count;
        self.sum += other.sum;
        if other.least.0 < self.least.0 {
            self.least = other.least;
        }
        if other.most.0 > self.most.0 {
            self.most = other.most;
        }
    }

    /// Mean of the points that have a value.
    pub fn mean(&self) -> Option<f64> {
        (self.count > 0).then(|| self.sum / self.count as f64)
    }
}

/// A kind of warning.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Seen {
    /// At how many points.
    pub count: u64,
    /// What it says at the first of them that was looked at.
    pub message: String,
    /// The number of that point.
    pub point: u64,
}

/// What many rows say together.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// How many points.
    pub points: u64,
    /// Points by verdict; see [`VERDICTS`].
    pub verdicts: BTreeMap<String, u64>,
    /// Of all points with a unique answer.
    pub efficiency: Extent,
    /// W.
    pub loss_w: Extent,
    /// By value of a text axis (states, laws): efficiency.
    pub by_text: BTreeMap<String, Extent>,
    /// By state: at how many points it is the most efficient.
    pub best: BTreeMap<String, u64>,
    /// Warnings by their code, and by `reason` why points have no answer.
    pub seen: BTreeMap<String, Seen>,
}

impl Summary {
    /// Adds what later rows say.
    pub fn join(&mut self, other: &Self) {
        self.points += other.points;
        for (verdict, count) in &other.verdicts {
            *self.verdicts.entry(verdict.clone()).or_default() += count;
        }
        self.efficiency.join(&other.efficiency);
        self.loss_w.join(&other.loss_w);
        for (text, extent) in &other.by_text {
            self.by_text.entry(text.clone()).or_default().join(extent);
        }
        for (state, count) in &other.best {
            *self.best.entry(state.clone()).or_default() += count;
        }
        for (code, seen) in &other.seen {
            match self.seen.get_mut(code) {
                Some(own) => own.count += seen.count,
                None => drop(self.seen.insert(code.clone(), seen.clone())),
            }
        }
    }

    pub(super) fn see(&mut self, code: &str, message: &str, point: u64) {
        match self.seen.get_mut(code) {
            Some(own) => own.count += 1,
            None => drop(self.seen.insert(code.into(), Seen { count: 1, message: message.into(), point })),
        }
    }
}

/// The answer at one point.
#[derive(Clone, Debug)]
pub struct Answer {
    /// One of [`VERDICTS`].
    pub verdict: &'static str,
    /// One sentence that explains a verdict other than `unique`.
    pub reason: String,
    /// The one equilibrium, where there is one.
    pub solution: Option<SolutionReport>,
    /// Warnings of this point, by code.
    pub warnings: Vec<(Code, String)>,
}

impl Answer {
    /// What [`analyze`](crate::analyze) says of an operation.
    pub fn of(train: &Train, operation: &Operation) -> Self {
        let (report, notes) = match analysis::operate(train, operation) {
            Ok(answer) => answer,
            Err(wrong) => {
                let title = format!("operation `{}`: ", operation.name);
                let mut answer = Self::refused(wrong);
                answer.reason = answer.reason.replace(&title, "");
                return answer;
            }
        };
        let verdict = match report.verdict {
            Verdict::Unique => "unique",
            Verdict::Multiple => "multiple",
            Verdict::Locked => "locked",
            Verdict::Unloaded => "unloaded",
            Verdict::Undetermined => "undetermined",
        };
        let is_one = matches!(report.verdict, Verdict::Unique | Verdict::Unloaded);
        let title = format!("operation `{}`: ", operation.name);
        let oil = train.lubrication.iter().filter_map(|l| l.beyond(operation.temperature.unwrap_or(l.temperature)));
        let warnings = notes.into_iter().filter(|d| d.severity == Severity::Warning && d.code != Code::SelfLocking);
        let warnings = warnings.map(|d| (d.code, d.message.strip_prefix(&title).unwrap_or(&d.message).to_owned()));
        Self {
            verdict,
            reason: report.reason.unwrap_or_default(),
            solution: report.solutions.into_iter().next().filter(|_| is_one),
            warnings: oil.map(|text| (Code::OutsideLaw, text)).chain(warnings).collect(),
        }
    }

    /// Of a point that makes no question.
    pub fn refused(wrong: Diagnostics) -> Self {
        let errors: Vec<String> =
            wrong.into_iter().filter(|d| d.severity == Severity::Error).map(|d| d.message).collect();
        Self { verdict: "refused", reason: errors.join("; "), solution: None, warnings: vec![] }
    }

    /// Output over input power, NaN where there is none.
    pub fn efficiency(&self) -> f64 {
        self.solution.as_ref().and_then(|s| s.efficiency).unwrap_or(f64::NAN)
    }

    /// All losses, W; NaN where there is no answer.
    pub fn loss(&self) -> f64 {
        self.solution.as_ref().map_or(f64::NAN, |s| s.loss_w)
    }
}

pub(super) fn yes_or_no(is: bool) -> &'static str {
    if is { "yes" } else { "no" }
}

const LOSS_KINDS: [&str; 5] = ["mesh", "bearing", "windage", "churning", "seal"];

fn loss_of(l: &Losses, kind: usize) -> f64 {
    [l.mesh, l.bearing, l.windage, l.churning, l.seal][kind]
}

/// A grid of operating points.
///
/// Points are numbered with the last axis running fastest. The states of the shift table, where they are an axis, run
/// fastest of all, wherever they stand, so that the states of one point lie side by side.
///
/// # Example
/// ```
/// use willis::model::Model;
/// use willis::study::{Axis, Hold, Question, Sweep};
///
/// let text = r#"
///     format = 1
///     name = "reducer"
///     members = ["s", "c"]
///     terminals = ["s", "c"]
///     [[set]]
///     name = "P1"
///     sun = { member = "s", teeth = 30 }
///     ring = { member = "frame", teeth = 70 }
///     carrier = "c"
///     mesh_efficiency = 0.99
/// "#;
/// let subject = Model::from_toml(text).unwrap();
/// let axis = |text: &str| Axis::parse(text, &subject);
/// let axes = vec![axis("input.speed=1000 rpm..2000 rpm:3")?, axis("output.torque=-10 N m, 10 N m")?];
/// let question = Question::new(&subject, None, None, Hold::AsGiven).unwrap();
/// let sweep = Sweep::new(question, axes, &[]).unwrap();
/// assert_eq!(sweep.len(), 6);
/// let rows = sweep.rows(0, 6, &mut Default::default());
/// // Driving and coasting in one map.
/// assert_eq!(rows.summary.verdicts["unique"], 6);
/// assert!((rows.summary.efficiency.most.0 - 0.98607).abs() < 1e-9);
/// # Ok::<(), Box<willis::diagnostic::Diagnostic>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Sweep<'s> {
    pub(super) question: Question<'s>,
    pub(super) axes: Vec<Axis>,
    pub(super) columns: Vec<(Column, What)>,
    points: u64,
}

impl<'s> Sweep<'s> {
    /// A sweep over axes; `columns` names more columns than the usual ones: single ones (`carrier.torque_n_m`), or
    /// `members`, `meshes`, `elements`, `sources`, `all`.
    ///
    /// # Errors
    /// An axis twice, no axis, more points than can be numbered, columns that there are not; a sweep whose first point
    /// cannot be asked because it is open what an axis replaces.
    pub fn new(question: Question<'s>, mut axes: Vec<Axis>, columns: &[String]) -> Result<Self, Diagnostics> {
        let mut wrong = Diagnostics::default();
        if axes.is_empty() {
            let d = Diagnostic::new(Code::BadAxis, "", "nothing varies");
            wrong.push(d.hint("name an axis: --over \"input.speed=500 rpm..6000 rpm:50\""));
        }
        for (k, axis) in axes.iter().enumerate() {
            if axes[..k].iter().any(|a| a.target == axis.target) {
                wrong.push(Diagnostic::new(Code::BadAxis, "", format!("`{}` varies along two axes", axis.name)));
            }
        }
        // Stable: all others stay in their order.
        axes.sort_by_key(Axis::is_state);
        let points = axes.iter().try_fold(1u64, |n, a| n.checked_mul(a.len() as u64));
        let Some(points) = points.filter(|n| *n < 1 << 53) else {
            let product = axes.iter().map(|a| a.len().to_string()).collect::<Vec<_>>().join(" × ");
            wrong.push(Diagnostic::new(Code::BadAxis, "", format!("{product} points are beyond all measure")));
            return Err(wrong);
        };
        if wrong.has_errors() {
            return Err(wrong);
        }
        let mut sweep = Self { question, axes, columns: vec![], points };
        sweep.columns = sweep.choose(columns)?;
        Ok(sweep)
    }

    /// The sweep that a [`study`](crate::train::StudySpec) of the train file describes.
    ///
    /// # Errors
    /// No study of that name; all that is wrong with it, at its place in the file.
    pub fn of_file(subject: &'s Model, name: &str) -> Result<Self, Diagnostics> {
        let studies = subject.train().studies();
        let Some(k) = studies.iter().position(|s| s.name == name) else {
            let known: Vec<&str> = studies.iter().map(|s| s.name.as_str()).collect();
            let d = Diagnostic::new(Code::UnknownSelection, "", format!("the train has no study `{name}`"));
            let d = d.suggest(name, known.iter().copied());
            return Err(Diagnostics::from_iter([d.hint(match known.is_empty() {
                true => "add a [[study]] with a name and `over`".to_owned(),
                false => format!("its studies are: {}", known.join(", ")),
            })]));
        };
        let study = &studies[k];
        let mut wrong = Diagnostics::default();
        let mut axes = vec![];
        for (j, over) in study.over.iter().enumerate() {
            match Axis::parse(over, subject) {
                Ok(axis) => axes.push(axis),
                Err(mut d) => {
                    d.place = format!("study[{k}].over[{j}]");
                    // It would replace the values too.
                    d.replacement = None;
                    wrong.push(*d);
                }
            }
        }
        let at = |what: Diagnostics, key: &str| {
            what.into_iter().map(move |d| Diagnostic { place: format!("study[{k}].{key}"), ..d }).collect::<Vec<_>>()
        };
        let hold = study.hold.as_deref().and_then(Hold::named).unwrap_or_default();
        match Question::new(subject, study.operation.as_deref(), study.state.as_deref(), hold) {
            Ok(question) if !wrong.has_errors() => {
                Self::new(question, axes, &study.columns).map_err(|w| at(w, "over").into_iter().collect())
            }
            Ok(_) => Err(wrong),
            Err(more) => {
                wrong.extend(at(more, "hold"));
                Err(wrong)
            }
        }
    }

    /// How many points.
    pub fn len(&self) -> u64 {
        self.points
    }

    /// Whether there is none; never.
    pub fn is_empty(&self) -> bool {
        self.points == 0
    }

    /// The axes in the order in which points are numbered.
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// What is asked.
    pub fn question(&self) -> &Question<'s> {
        &self.question
    }

    /// The columns of the rows.
    pub fn columns(&self) -> impl ExactSizeIterator<Item = &Column> {
        self.columns.iter().map(|c| &c.0)
    }

    /// How many rows belong together: the states of one point.
    pub fn group(&self) -> u64 {
        self.axes.last().filter(|a| a.is_state()).map_or(1, |a| a.len() as u64)
    }

    /// Points from one value of an axis to its next.
    pub(super) fn stride(&self, axis: usize) -> u64 {
        self.axes[axis + 1..].iter().map(|a| a.len() as u64).product()
    }

    /// The positions on the axes of a point.
    pub fn place(&self, point: u64) -> Vec<usize> {
        let mut rest = point;
        let mut place: Vec<usize> = (self.axes.iter().rev())
            .map(|a| {
                let k = rest % a.len() as u64;
                rest /= a.len() as u64;
                k as usize
            })
            .collect();
        place.reverse();
        place
    }

    /// The values of a point in words: `input.speed = 500 rpm, state = 3`.
    pub fn describe(&self, point: u64) -> String {
        let values = self.axes.iter().zip(self.place(point)).map(|(a, k)| format!("{} = {}", a.name, a.setting(k)));
        values.collect::<Vec<_>>().join(", ")
    }

    /// The answer at a point.
    pub fn answer(&self, point: u64, trains: &mut Trains) -> Answer {
        match self.ask(point, trains) {
            Ok((train, operation)) => {
                let mut answer = Answer::of(&train, &operation);
                let base = self.question.model().train().warnings();
                // What is wrong with this train and not with that of the file: planets that touch, for one.
                let own = train.warnings().iter().filter(|d| d.severity == Severity::Warning);
                let new = own.filter(|d| !base.iter().any(|b| b.code == d.code && b.message == d.message));
                answer.warnings.extend(new.map(|d| (d.code, d.message.clone())));
                answer
            }
            Err(wrong) => Answer::refused(wrong),
        }
    }

    /// The train and the operating point at a point.
    ///
    /// # Errors
    /// See [`Question::at`].
    pub fn ask(&self, point: u64, trains: &mut Trains) -> Result<(std::sync::Arc<Train>, Operation), Diagnostics> {
        let place = self.place(point);
        let settings: Vec<(&Target, String)> =
            self.axes.iter().zip(&place).map(|(a, k)| (&a.target, a.setting(*k))).collect();
        self.question.at(&settings, trains)
    }

    /// The rows of the points from `from` up to `to`, whole [groups](Self::group).
    pub fn rows(&self, from: u64, to: u64, trains: &mut Trains) -> Rows {
        let n = (to - from) as usize;
        let mut rows = self.blank(n);
        let group = self.group();
        let text_axes: Vec<usize> = (0..self.axes.len()).filter(|k| self.axes[*k].is_text()).collect();
        let mut point = from;
        while point < to {
            let answers: Vec<Answer> = (point..(point + group).min(to)).map(|p| self.answer(p, trains)).collect();
            let best = match group {
                1 => None,
                _ => (0..answers.len())
                    .filter(|k| answers[*k].verdict == "unique" && answers[*k].efficiency() > 0.0)
                    .max_by(|a, b| answers[*a].efficiency().total_cmp(&answers[*b].efficiency()).then(b.cmp(a))),
            };
            for (k, answer) in answers.iter().enumerate() {
                let place = self.place(point + k as u64);
                self.summarise(&mut rows.summary, point + k as u64, &place, &text_axes, answer, best == Some(k));
                for (cells, (_, what)) in rows.columns.iter_mut().zip(&self.columns) {
                    self.cell(cells, what, &place, answer, best == Some(k));
                }
            }
            point += group;
        }
        rows
    }

    fn blank(&self, n: usize) -> Rows {
        let columns = self.columns.iter().map(|(c, _)| match c.is_text {
            true => Cells::Texts(Vec::with_capacity(n)),
            false => Cells::Numbers(Vec::with_capacity(n)),
        });
        Rows { columns: columns.collect(), summary: Summary::default() }
    }

    fn summarise(
        &self,
        summary: &mut Summary,
        point: u64,
        place: &[usize],
        text_axes: &[usize],
        answer: &Answer,
        is_best: bool,
    ) {
        summary.points += 1;
        *summary.verdicts.entry(answer.verdict.into()).or_default() += 1;
        let efficiency = if answer.verdict == "unique" { answer.efficiency() } else { f64::NAN };
        summary.efficiency.add(efficiency, point);
        summary.loss_w.add(answer.loss(), point);
        for &k in text_axes {
            let text = format!("{} = {}", self.axes[k].name, self.axes[k].setting(place[k]));
            if is_best && self.axes[k].is_state() {
                *summary.best.entry(self.axes[k].setting(place[k])).or_default() += 1;
            }
            summary.by_text.entry(text).or_default().add(efficiency, point);
        }
        // What is to be said of a unique answer is a warning.
        if !answer.reason.is_empty() && answer.verdict != "unique" {
            summary.see(&format!("reason: {}", answer.verdict), &answer.reason, point);
        }
        let mut last = None;
        for (code, message) in &answer.warnings {
            // At a point a kind of warning counts once.
            if last != Some(code) {
                summary.see(code.as_str(), message, point);
            }
            last = Some(code);
        }
    }

    fn cell(&self, cells: &mut Cells, what: &What, place: &[usize], answer: &Answer, is_best: bool) {
        let texts = match cells {
            Cells::Numbers(all) => return all.push(self.number(what, place, answer)),
            Cells::Texts(all) => all,
        };
        texts.push(match what {
            What::Axis(k) => self.axes[*k].setting(place[*k]).into(),
            What::Verdict => answer.verdict.into(),
            What::Best => yes_or_no(is_best).into(),
            What::Reason => answer.reason.clone().into(),
            What::Warnings => {
                let all: Vec<String> = answer.warnings.iter().map(|(c, m)| format!("{} {m}", c.as_str())).collect();
                all.join("; ").into()
            }
            _ => unreachable!("all others are numbers"),
        });
    }

    fn number(&self, what: &What, place: &[usize], answer: &Answer) -> f64 {
        let Some(s) = &answer.solution else {
            return match what {
                What::Axis(k) => self.axes[*k].number(place[*k]),
                _ => f64::NAN,
            };
        };
        let found = match what {
            What::Axis(k) => Some(self.axes[*k].number(place[*k])),
            What::Efficiency => s.efficiency,
            What::InputPower => Some(s.input_power_w),
            What::OutputPower => Some(s.output_power_w),
            What::Loss => Some(s.loss_w),
            What::LossOf(kind) => Some(loss_of(&s.losses_w, *kind)),
            What::Residual => Some(s.power_residual_w),
            What::Circulating => Some(s.recirculation.iter().map(|r| r.power_w).fold(0.0, f64::max)),
            What::LockFactor => s.margin.lock_loss_factor,
            What::Speed(name) => s.members.get(name).and_then(|m| m.speed_rad_s),
            What::Torque(name) => s.members.get(name).and_then(|m| m.torque_n_m),
            What::Power(name) => s.members.get(name).and_then(|m| m.power_w),
            What::MeshLoss(name) => s.meshes.get(name).map(|m| m.loss_w),
            What::MeshEfficiency(name) => s.meshes.get(name).map(|m| m.efficiency),
            What::MeshFriction(name) => s.contacts.get(name).and_then(|m| m.friction),
            What::ElementTorque(name) => s.shift_elements.get(name).and_then(|m| m.torque_n_m),
            What::SourceLoss(name) => {
                let mut own = s.sources.iter().filter(|x| x.name == *name).map(|x| x.loss_w).peekable();
                own.peek().is_some().then(|| own.sum())
            }
            _ => None,
        };
        found.unwrap_or(f64::NAN)
    }

    /// The usual columns and those asked for.
    fn choose(&self, asked: &[String]) -> Result<Vec<(Column, What)>, Diagnostics> {
        let train = self.question.model().train();
        let text = |name: &str, what: What| (Column { name: name.into(), is_text: true }, what);
        let number = |name: String, what: What| (Column { name, is_text: false }, what);
        let physical = train.is_physical() || self.axes.iter().any(|a| matches!(a.target, Target::File(_)));
        let mut all: Vec<(Column, What)> = (self.axes.iter().enumerate())
            .map(|(k, a)| (Column { name: a.column(), is_text: a.is_text() }, What::Axis(k)))
            .collect();
        all.push(text("verdict", What::Verdict));
        if self.group() > 1 {
            all.push(text("best", What::Best));
        }
        all.push(number("efficiency".into(), What::Efficiency));
        all.push(number("input_power_w".into(), What::InputPower));
        all.push(number("output_power_w".into(), What::OutputPower));
        all.push(number("loss_w".into(), What::Loss));
        if physical {
            all.extend(LOSS_KINDS.iter().enumerate().map(|(k, n)| number(format!("{n}_loss_w"), What::LossOf(k))));
        }
        // What may be asked for: group, column.
        let mut more: Vec<(&str, Column, What)> = vec![];
        let mut offer = |group, name: String, what| more.push((group, Column { name, is_text: false }, what));
        offer("all", "power_residual_w".into(), What::Residual);
        offer("all", "circulating_power_w".into(), What::Circulating);
        offer("all", "lock_loss_factor".into(), What::LockFactor);
        // All but the frame, which is at rest.
        for m in train.members().iter().skip(1).map(|m| &m.name) {
            offer("members", format!("{m}.speed_rad_s"), What::Speed(m.clone()));
            offer("members", format!("{m}.torque_n_m"), What::Torque(m.clone()));
            offer("members", format!("{m}.power_w"), What::Power(m.clone()));
        }
        for m in train.meshes().iter().map(|m| &m.name) {
            offer("meshes", format!("{m}.loss_w"), What::MeshLoss(m.clone()));
            offer("meshes", format!("{m}.efficiency"), What::MeshEfficiency(m.clone()));
            if train.is_physical() {
                offer("meshes", format!("{m}.friction"), What::MeshFriction(m.clone()));
            }
        }
        for e in train.shift_elements().iter().map(|e| &e.name) {
            offer("elements", format!("{e}.torque_n_m"), What::ElementTorque(e.clone()));
        }
        let sources = (train.meshes().iter().map(|m| &m.name))
            .chain(train.bearings.iter().map(|b| &b.name))
            .chain(train.seals.iter().map(|b| &b.name))
            .chain(train.rotors.iter().map(|b| &b.name));
        for s in sources {
            offer("sources", format!("loss.{s}_w"), What::SourceLoss(s.clone()));
        }
        let mut wrong = Diagnostics::default();
        for name in asked {
            let name = name.trim();
            let known = all.iter().any(|c| c.0.name == name);
            let chosen: Vec<_> =
                more.iter().filter(|(g, c, _)| name == "all" || *g == name || c.name == name).cloned().collect();
            if chosen.is_empty() && !known && name != "elements" {
                let d = Diagnostic::new(Code::UnknownName, "", format!("there is no column `{name}`"));
                let names = more.iter().map(|c| c.1.name.as_str()).chain(["members", "meshes", "elements", "sources"]);
                let d = d.suggest(name, names);
                wrong.push(d.hint("`members`, `meshes`, `elements`, `sources` and `all` name several"));
            }
            for (_, column, what) in chosen {
                // An axis of that name has its values.
                if !all.iter().any(|c| c.1 == what || c.0.name == column.name) {
                    all.push((column, what));
                }
            }
        }
        if wrong.has_errors() {
            return Err(wrong);
        }
        all.push(text("reason", What::Reason));
        all.push(text("warnings", What::Warnings));
        Ok(all)
    }
}
