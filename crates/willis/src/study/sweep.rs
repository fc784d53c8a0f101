//! A grid of operating points, one row a point.

mod columns;
mod plan;
mod report;

use std::sync::Arc;

use crate::diagnostic::{Code, Diagnostic, Diagnostics, Severity};
use crate::model::{Model, Target};
use crate::train::{Operation, Train};

use super::answer::{PointAnswer, PointAnswers, PointWarning};
use super::axis::Axis;
use super::column::{Column, Rows};
use super::question::{Hold, PointSetup, TrainCache};
use super::summary::{AxisValue, Summary};

pub(super) use columns::What;
pub use plan::{SweepAnswer, SweepPlan, SweepRequest, sweep};
pub use report::{Shard, SweepAxis, SweepColumn, SweepMethod, SweepPlace, SweepReport, SweepStudy};

/// A grid of operating points.
///
/// Points are numbered with the last axis running fastest. The states of the shift table, where they are an axis, run
/// fastest of all, wherever they stand, so that the states of one point lie side by side.
///
/// # Example
/// ```
/// use willis::model::Model;
/// use willis::study::{Axis, Hold, PointSetup, PointVerdict, Sweep};
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
/// let model = Model::from_toml(text).unwrap();
/// let axis = |text: &str| Axis::parse(text, &model);
/// let axes = vec![axis("input.speed=1000 rpm..2000 rpm:3")?, axis("output.torque=-10 N m, 10 N m")?];
/// let question = PointSetup::new(&model, None, None, Hold::AsGiven).unwrap();
/// let sweep = Sweep::new(question, axes, &[]).unwrap();
/// assert_eq!(sweep.len(), 6);
/// let rows = sweep.rows(0, 6, &mut Default::default());
/// // Driving and coasting in one map.
/// assert_eq!(rows.summary.verdicts[&PointVerdict::Unique], 6);
/// assert!((rows.summary.efficiency.most.unwrap().value - 0.98607).abs() < 1e-9);
/// # Ok::<(), Box<willis::diagnostic::Diagnostic>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Sweep<'s> {
    pub(super) question: PointSetup<'s>,
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
    pub fn new(question: PointSetup<'s>, mut axes: Vec<Axis>, columns: &[String]) -> Result<Self, Diagnostics> {
        let mut wrong = Diagnostics::default();
        if axes.is_empty() {
            let d = Diagnostic::new(Code::BadAxis, "", "nothing varies");
            wrong.push(d.hint("name an axis in `over`, such as \"input.speed=500 rpm..6000 rpm:50\""));
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
    pub fn of_file(model: &'s Model, name: &str) -> Result<Self, Diagnostics> {
        let studies = model.train().studies();
        let Some(k) = studies.iter().position(|s| s.name == name) else {
            let known = studies.iter().map(|s| s.name.as_str());
            let d = Diagnostic::missing(Code::UnknownSelection, "study", name, known);
            return Err(d.hint("a [[study]] has a name and `over`").into());
        };
        let study = &studies[k];
        let mut wrong = Diagnostics::default();
        let mut axes = vec![];
        for (j, over) in study.over.iter().enumerate() {
            match Axis::parse(over, model) {
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
        match PointSetup::new(model, study.operation.as_deref(), study.state.as_deref(), hold) {
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
    pub fn question(&self) -> &PointSetup<'s> {
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
    pub fn answer(&self, point: u64, trains: &mut TrainCache) -> PointAnswer {
        let mut found = None;
        PointAnswers::each([self.ask(point, trains)], true, |answer, asked| {
            found = Some(self.completed(answer, asked))
        });
        found.expect("one is asked")
    }

    /// An answer with what only a sweep says.
    fn completed(&self, mut answer: PointAnswer, asked: Option<(&Arc<Train>, &Operation)>) -> PointAnswer {
        let Some((train, operation)) = asked else { return answer };
        if self.columns.iter().any(|c| c.1 == What::Ratio) {
            answer = answer.with_ratio(train, operation);
        }
        let base = self.question.model().train().warnings();
        // What is wrong with this train and not with that of the file: planets that touch, for one.
        let own = train.warnings().iter().filter(|d| d.severity == Severity::Warning);
        let new = own.filter(|d| !base.iter().any(|b| b.code == d.code && b.message == d.message));
        let told = new.map(|d| PointWarning { code: d.code, law: None, message: d.message.clone(), deviation: None });
        answer.warnings.extend(told);
        answer
    }

    /// The train and the operating point at a point.
    ///
    /// # Errors
    /// See [`PointSetup::at`].
    pub fn ask(&self, point: u64, trains: &mut TrainCache) -> Result<(Arc<Train>, Operation), Diagnostics> {
        let place = self.place(point);
        let settings: Vec<(&Target, String)> =
            self.axes.iter().zip(&place).map(|(a, k)| (&a.target, a.setting(*k))).collect();
        self.question.at(&settings, trains)
    }

    /// The rows of the points from `from` up to `to`, whole [groups](Self::group).
    pub fn rows(&self, from: u64, to: u64, trains: &mut TrainCache) -> Rows {
        let n = (to - from) as usize;
        let mut rows = Rows::with_capacity(self.columns(), n);
        let group = self.group();
        let text_axes: Vec<usize> = (0..self.axes.len()).filter(|k| self.axes[*k].is_text()).collect();
        let mut answers: Vec<PointAnswer> = vec![];
        let mut point = from;
        let whole = self.columns.iter().any(|c| !c.1.is_among_numbers());
        let asked = (from..to).map(|p| self.ask(p, trains));
        PointAnswers::each(asked, whole, |answer, asked| {
            answers.push(self.completed(answer, asked));
            // The states of one point belong together.
            if answers.len() as u64 == group.min(to - point) {
                self.add(&mut rows, point, &answers, &text_axes);
                point += answers.len() as u64;
                answers.clear();
            }
        });
        rows
    }

    /// Adds the rows of the points from one on that belong together.
    fn add(&self, rows: &mut Rows, point: u64, answers: &[PointAnswer], text_axes: &[usize]) {
        let best = match self.group() {
            1 => None,
            _ => (0..answers.len())
                .filter(|k| answers[*k].is_unique() && answers[*k].efficiency() > 0.0)
                .max_by(|a, b| answers[*a].efficiency().total_cmp(&answers[*b].efficiency()).then(b.cmp(a))),
        };
        for (k, answer) in answers.iter().enumerate() {
            let place = self.place(point + k as u64);
            self.summarise(&mut rows.summary, point + k as u64, &place, text_axes, answer, best == Some(k));
            for (values, (_, what)) in rows.columns.iter_mut().zip(&self.columns) {
                self.cell(values, what, &place, answer, best == Some(k));
            }
        }
    }

    fn summarise(
        &self,
        summary: &mut Summary,
        point: u64,
        place: &[usize],
        text_axes: &[usize],
        answer: &PointAnswer,
        is_best: bool,
    ) {
        summary.points += 1;
        *summary.verdicts.entry(answer.verdict).or_default() += 1;
        let efficiency = if answer.is_unique() { answer.efficiency() } else { f64::NAN };
        summary.efficiency.add(efficiency, point);
        summary.loss_w.add(answer.loss(), point);
        for &k in text_axes {
            let axis = &self.axes[k];
            let value = axis.setting(place[k]);
            if is_best && axis.is_state() {
                *summary.best.entry(value.clone()).or_default() += 1;
            }
            let text = AxisValue { axis: axis.name.clone(), value };
            summary.by_text.entry(text).or_default().add(efficiency, point);
        }
        summary.hear(answer, point);
    }
}
