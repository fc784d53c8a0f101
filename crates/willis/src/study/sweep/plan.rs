//! A sweep from the question to the answer: in one call, or piece by piece.

use std::ops::Range;
use std::sync::{Arc, Mutex, PoisonError};

use serde::{Deserialize, Serialize};

use crate::analysis;
use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::model::Model;
use crate::study::axis::Axis;
use crate::study::column::{Column, ColumnTable, Rows};
use crate::study::compiled::{CompiledSweep, SweepWorkspace};
use crate::study::question::{Hold, PointSetup, TrainCache};
use crate::study::summary::Summary;
use crate::work::{self, Cancelled, Effort, Work};

use super::Sweep;
use super::report::{Shard, SweepMethod, SweepReport, SweepStudy};

/// Points above which a sweep is tried for time and size first.
const MANY: u64 = 20_000;
/// Compiled points above which this is so where no table is made: they are a matter of nanoseconds.
const MANY_COMPILED: u64 = 1_000_000_000;
/// How many pieces are tried.
const TRIALS: u64 = 32;
/// Points between two looks whether to stop.
const LOOK: u64 = 256;
/// Most values that a table in memory holds.
const MOST_VALUES: u64 = 1 << 27;

/// What a sweep is asked.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct SweepRequest {
    /// The name of a `[[study]]` of the train file. Axes, operation, state, hold and columns are then those of the study
    /// and must not be given.
    pub study: Option<String>,
    /// The axes, each a quantity and its values: `input.speed=500 rpm..6000 rpm:50` takes 50 evenly spaced values, both
    /// ends included; `input.torque=1 N m..1000 N m:31:log` takes 31 values with a constant ratio;
    /// `input.speed=500 rpm..6000 rpm:step 500 rpm` takes every 500 rpm; `state=all` takes every state of the shift
    /// table; `P1.sun.teeth=20..30` and `oil.temperature=20 degC, 60 degC` vary the train and its oil. Every
    /// combination of the values is a point. Torques and powers of `input` and `output` are positive driving, negative
    /// coasting.
    pub over: Vec<String>,
    /// The operation of the train file from which every point starts. Default: the first one that suits the state.
    pub operation: Option<String>,
    /// The state of the shift table from which every point starts. Default: that of the operation.
    pub state: Option<String>,
    /// What stays the same while the axes vary: `as-given` (the loads as the operation gives them, torques as torques
    /// and powers as powers; the default), `torque` (the torques of the loads), `power` (their powers) or `output` (the
    /// torque at the output).
    pub hold: Hold,
    /// Columns of the table beside the usual ones: single ones, `carrier.torque_n_m`, or `members`, `meshes`,
    /// `elements`, `sources` or `all` for several.
    pub columns: Vec<String>,
    /// How points are computed: `analyze` (exactly as `analyze` does; the default) or `compiled` (some thousand times
    /// faster, to a part in 10¹²; for trains whose efficiencies are given, over speeds, torques, states and a few
    /// values of the train file).
    pub method: SweepMethod,
    /// Keep the summary alone and no row for each point. A summary takes the same memory however many points there are.
    pub summary_only: bool,
}

/// A sweep in memory.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct SweepAnswer {
    /// What was asked, and what the points say together.
    pub report: SweepReport,
    /// One row a point; without columns where only the summary was asked for.
    pub table: ColumnTable,
}

/// Computes every point of a sweep.
///
/// The answer does not depend on how `work` shares the points out.
///
/// # Errors
/// What [`SweepPlan::new`] and [`SweepPlan::check`] refuse, a table that is too large for memory, and
/// [`Code::Cancelled`].
///
/// # Example
/// ```
/// use willis::model::Model;
/// use willis::study::{PointVerdict, SweepRequest, sweep};
/// use willis::work::Serial;
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
/// let over = vec!["input.speed=1000 rpm..2000 rpm:3".into(), "output.torque=-10 N m, 10 N m".into()];
/// let answer = sweep(&model, &SweepRequest { over, ..Default::default() }, &Serial)?;
/// // Driving and coasting in one map.
/// assert_eq!(answer.report.summary.verdicts[&PointVerdict::Unique], 6);
/// assert_eq!(answer.table.len(), 6);
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn sweep(model: &Model, request: &SweepRequest, work: &dyn Work) -> Result<SweepAnswer, Diagnostics> {
    let plan = SweepPlan::new(model, request)?;
    plan.check()?;
    let values = plan.sweep().len().saturating_mul(plan.columns().len() as u64);
    if !request.summary_only && values > MOST_VALUES {
        let message = format!(
            "{} points with {} columns are too many values for a table in memory",
            plan.sweep().len(),
            plan.columns().len()
        );
        let d = Diagnostic::new(Code::Unfit, "", message);
        return Err(d.hint("ask for the summary alone, or take fewer values or columns").into());
    }
    work.afford(&plan.effort())?;
    let rooms = Pool::default();
    work.begin("points", plan.sweep().len());
    let pieces = usize::try_from(plan.pieces()).unwrap_or(usize::MAX);
    let done = |points: &Range<u64>| work.advance(points.end - points.start);
    if request.summary_only {
        let parts = work::map(work, pieces, |k| {
            let points = plan.points(k as u64);
            let part = rooms.with(|room| plan.summary(points.clone(), room, work));
            done(&points);
            part
        })?;
        let mut summary = Summary::default();
        for part in parts {
            summary.join(&part?);
        }
        return Ok(SweepAnswer { report: plan.report(None, summary), table: ColumnTable::default() });
    }
    let parts = work::map(work, pieces, |k| {
        let points = plan.points(k as u64);
        let part = rooms.with(|room| plan.rows(points.clone(), room, work));
        done(&points);
        part
    })?;
    let mut rows = Rows::with_capacity(plan.columns().iter(), plan.sweep().len() as usize);
    for part in parts {
        rows.append(part?);
    }
    let table = ColumnTable { columns: plan.columns().to_vec(), values: rows.columns };
    Ok(SweepAnswer { report: plan.report(None, rows.summary), table })
}

/// Workspaces, each used by one thread at a time.
#[derive(Default)]
struct Pool(Mutex<Vec<SweepWorkspace>>);

impl Pool {
    fn with<T>(&self, job: impl FnOnce(&mut SweepWorkspace) -> T) -> T {
        let kept = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let mut room = kept().pop().unwrap_or_default();
        let done = job(&mut room);
        kept().push(room);
        done
    }
}

/// A sweep, ready to be computed piece by piece: what a caller needs who keeps pieces in files, or shares them among
/// machines.
///
/// The pieces and their rows depend on the request alone; joined in order they are the whole sweep.
#[derive(Clone, Debug)]
pub struct SweepPlan<'s> {
    sweep: Arc<Sweep<'s>>,
    compiled: Option<CompiledSweep<'s>>,
    columns: Vec<Column>,
    study: SweepStudy,
}

impl<'s> SweepPlan<'s> {
    /// Reads what is asked.
    ///
    /// # Errors
    /// Everything that is wrong with the request: axes, operation, state, columns; a train that cannot be compiled where
    /// that is asked for.
    pub fn new(model: &'s Model, request: &SweepRequest) -> Result<Self, Diagnostics> {
        let (sweep, over) = match &request.study {
            Some(name) => {
                let alone = SweepRequest {
                    study: request.study.clone(),
                    method: request.method,
                    summary_only: request.summary_only,
                    ..SweepRequest::default()
                };
                if *request != alone {
                    let message = format!(
                        "the study `{name}` says itself what varies, from which operation and with which columns"
                    );
                    let d = Diagnostic::new(Code::Conflict, "", message);
                    return Err(d.hint("give the study alone, or the axes without a study").into());
                }
                (Sweep::of_file(model, name)?, format!("study {name}"))
            }
            None => {
                let mut wrong = Diagnostics::default();
                let mut axes = vec![];
                for over in &request.over {
                    match Axis::parse(over, model) {
                        Ok(axis) => axes.push(axis),
                        Err(d) => wrong.push(*d),
                    }
                }
                if wrong.has_errors() {
                    return Err(wrong);
                }
                let (operation, state) = (request.operation.as_deref(), request.state.as_deref());
                let question = PointSetup::new(model, operation, state, request.hold)?;
                let over: Vec<&str> = request.over.iter().map(|o| o.trim()).collect();
                (Sweep::new(question, axes, &request.columns)?, over.join("\n"))
            }
        };
        let sweep = Arc::new(sweep);
        let compiled = match request.method {
            SweepMethod::Analyze => None,
            SweepMethod::Compiled => Some(CompiledSweep::new(Arc::clone(&sweep))?),
        };
        let columns: Vec<Column> = match &compiled {
            None => sweep.columns().cloned().collect(),
            Some(compiled) => compiled.columns().cloned().collect(),
        };
        let piece = piece(sweep.len(), sweep.group(), request.method);
        let study = SweepStudy::new(&sweep, request.method, &columns, &over, piece);
        Ok(Self { sweep, compiled, columns, study })
    }

    /// The grid of points.
    pub fn sweep(&self) -> &Sweep<'s> {
        &self.sweep
    }

    /// What is asked: the same for every piece and shard, and for every run.
    pub fn study(&self) -> &SweepStudy {
        &self.study
    }

    /// The columns of the rows.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// How much work all points are.
    pub fn effort(&self) -> Effort {
        /// A point of the compiled train, with its row, s.
        const COMPILED: f64 = 5e-8;
        let points = self.sweep.len();
        match self.compiled {
            Some(_) => Effort::new("points", points, COMPILED),
            None => Effort::of_points(self.sweep.question().model().train(), points),
        }
    }

    /// How many pieces there are.
    pub fn pieces(&self) -> u64 {
        self.sweep.len().div_ceil(self.study.piece)
    }

    /// The points of a piece.
    pub fn points(&self, piece: u64) -> Range<u64> {
        let at = |k: u64| (k * self.study.piece).min(self.sweep.len());
        at(piece)..at(piece + 1)
    }

    /// Refuses a sweep of which neither the first, the last nor the middle points make a question.
    ///
    /// # Errors
    /// Why the first point makes none.
    pub fn check(&self) -> Result<(), Diagnostics> {
        let mut trains = TrainCache::default();
        let mut first = None;
        for k in 0..=4 {
            let point = (self.sweep.len() - 1) * k / 4;
            let asked = self.sweep.ask(point, &mut trains);
            match asked.and_then(|(train, o)| analysis::operate(&train, &o).map(drop)) {
                Ok(()) => return Ok(()),
                Err(wrong) => drop(first.get_or_insert(wrong)),
            }
        }
        Err(first.unwrap_or_default())
    }

    /// Points by which a caller with a clock may find out how long `rows` rows take, and how large a table of them is;
    /// none where there are so few that nobody waits. The first run pays for what is made once: do not count it.
    pub fn trials(&self, rows: u64, with_table: bool) -> impl Iterator<Item = Range<u64>> + '_ {
        let is_quick = rows <= MANY || (self.compiled.is_some() && !with_table && rows < MANY_COMPILED);
        let group = self.sweep.group();
        let wide = if self.compiled.is_some() { 4096u64 } else { 1 };
        (0..if is_quick { 0 } else { TRIALS }).map(move |k| {
            let from = self.sweep.len() / TRIALS * k / group * group;
            from..(from + wide.max(group).div_ceil(group) * group).min(self.sweep.len())
        })
    }

    /// Whether the method `compiled` could answer this sweep, and it is not used.
    pub fn could_be_compiled(&self) -> bool {
        self.compiled.is_none() && CompiledSweep::new(Arc::clone(&self.sweep)).is_ok()
    }

    /// The rows of some points: a [piece](Self::points), or whole [groups](Sweep::group).
    ///
    /// # Errors
    /// The work was cancelled.
    pub fn rows(&self, points: Range<u64>, room: &mut SweepWorkspace, work: &dyn Work) -> Result<Rows, Cancelled> {
        let group = self.sweep.group();
        let step = (LOOK / group).max(1) * group;
        let mut all = Rows::with_capacity(self.columns.iter(), (points.end - points.start) as usize);
        let mut from = points.start;
        while from < points.end {
            if work.cancelled() {
                return Err(Cancelled);
            }
            let to = match &self.compiled {
                Some(_) => points.end,
                None => (from + step).min(points.end),
            };
            all.append(match &self.compiled {
                Some(compiled) => compiled.rows(from, to, room),
                None => self.sweep.rows(from, to, &mut room.trains),
            });
            from = to;
        }
        Ok(all)
    }

    /// What some points say together.
    ///
    /// # Errors
    /// The work was cancelled.
    pub fn summary(
        &self,
        points: Range<u64>,
        room: &mut SweepWorkspace,
        work: &dyn Work,
    ) -> Result<Summary, Cancelled> {
        match &self.compiled {
            Some(_) if work.cancelled() => Err(Cancelled),
            Some(compiled) => Ok(compiled.summary(points.start, points.end, room)),
            None => self.rows(points, room, work).map(|rows| rows.summary),
        }
    }

    /// The report of the points that `summary` sums up: of the whole sweep, or of a shard.
    pub fn report(&self, shard: Option<Shard>, summary: Summary) -> SweepReport {
        SweepReport::new(&self.sweep, self.study.clone(), shard, summary)
    }
}

/// Points of a piece: a few dozen pieces of a small sweep, groups whole.
fn piece(points: u64, group: u64, method: SweepMethod) -> u64 {
    let [least, most] = match method {
        SweepMethod::Analyze => [1 << 7, 1 << 13],
        SweepMethod::Compiled => [1 << 16, 1 << 18],
    };
    // However many points, a list of the pieces fits anywhere.
    let wanted = (points / 64).next_power_of_two().clamp(least, most).max(points / 1_000_000);
    wanted.div_ceil(group) * group
}
