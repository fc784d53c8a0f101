//! Sweeps through the [compiled train](crate::compiled), for maps of millions of points.
//!
//! A train with given efficiencies whose speeds and torques vary needs no elimination at a point. The numbers are
//! those of [`Sweep::rows`] to a part in 10¹², not to the last bit; points that are not plainly unique are asked the
//! long way, so that verdicts and their words are the same.

use std::borrow::Cow;
use std::sync::Arc;

use crate::arch::Arch;
use crate::compiled::{
    BatchInputs, CompileRequest, CompiledOutput, CompiledTrain, GridInputs, OutputSummary, Workspace,
};
use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::kinematics::Configuration;
use crate::model::{ShaftRef, Target};
use crate::train::{Load, MemberId, ShiftElement, ShiftElementKind};
use crate::units::{self, Dimension};

use super::answer::{PointAnswer, PointVerdict};
use super::column::{Column, ColumnValues, Rows};
use super::question::{Hold, TrainCache};
use super::summary::{AxisValue, MinMaxSum, Summary};
use super::sweep::{Sweep, What};

/// Most trains and states that are compiled.
const MOST_CASES: usize = 4096;
/// Points worked off at a time: what they need stays in the second-level cache.
const BLOCK: usize = 2048;

/// Where a prescribed quantity comes from.
#[derive(Clone, Debug)]
enum Input {
    Constant(f64),
    /// An axis, its values in SI.
    Axis(Values),
    /// Likewise, the torque turned so that it drives: how the member's speed follows from those prescribed.
    Role(Values, Vec<f64>),
}

/// The values of an axis in SI; made once, unless there are very many.
#[derive(Clone, Debug)]
struct Values {
    axis: usize,
    factor: f64,
    si: Arc<[f64]>,
}

impl Values {
    fn new(sweep: &Sweep<'_>, axis: usize, factor: f64, dimension: Dimension) -> Self {
        const MOST_KEPT: usize = 1 << 20;
        /// So many are read as they would stand in a file: to the last bit what is prescribed there.
        const MOST_READ: usize = 1 << 16;
        let own = &sweep.axes[axis];
        let kept = if own.len() <= MOST_KEPT { own.len() } else { 0 };
        let read = |k: usize| units::parse(&own.setting(k), dimension).ok().filter(|_| own.len() <= MOST_READ);
        let si = |k: usize| read(k).map_or(own.number(k) * factor, |q| q.si().copysign(own.number(k) * factor));
        Self { axis, factor, si: (0..kept).map(si).collect() }
    }

    fn at(&self, sweep: &Sweep<'_>, k: usize) -> f64 {
        self.si.get(k).copied().unwrap_or_else(|| sweep.axes[self.axis].number(k) * self.factor)
    }

    /// At the points from `from` on.
    fn fill(&self, sweep: &Sweep<'_>, from: u64, out: &mut [f64]) {
        let stride = sweep.stride(self.axis);
        let n = sweep.axes[self.axis].len() as u64;
        let (mut point, mut at) = (from, 0);
        while at < out.len() {
            let k = (point / stride % n) as usize;
            let run = if stride == 1 { n as usize - k } else { (stride - point % stride) as usize };
            let run = run.min(out.len() - at);
            let out = &mut out[at..at + run];
            match self.si.get(k..k + run) {
                // A row of the map.
                Some(row) if stride == 1 => out.copy_from_slice(row),
                _ if stride == 1 => out.iter_mut().enumerate().for_each(|(i, o)| *o = self.at(sweep, k + i)),
                _ => out.fill(self.at(sweep, k)),
            }
            (point, at) = (point + run as u64, at + run);
        }
    }
}

/// One train in one state.
#[derive(Clone, Debug)]
struct Case {
    train: CompiledTrain,
    speeds: Vec<Input>,
    torques: Vec<Input>,
    grid: Option<Grid>,
}

/// The inputs of a train, speeds first, where they are a grid that is numbered as the sweep is.
#[derive(Clone, Debug)]
struct Grid {
    values: Vec<Arc<[f64]>>,
    /// From the slowest to the fastest.
    order: Vec<usize>,
}

impl Grid {
    fn new(sweep: &Sweep<'_>, inputs: &[&Input]) -> Option<Self> {
        let mut values: Vec<Arc<[f64]>> = vec![];
        let mut axes = vec![];
        for input in inputs {
            let (own, axis) = match input {
                Input::Constant(x) => (Arc::from([*x]), None),
                Input::Axis(values) => (Arc::clone(&values.si), Some(values.axis)),
                // Its sign follows the speeds.
                Input::Role(..) => return None,
            };
            values.push(own);
            axes.push(axis);
        }
        let points = values.iter().try_fold(1u64, |n, v| n.checked_mul(v.len() as u64));
        let mut order: Vec<usize> = (0..axes.len()).collect();
        order.sort_by_key(|k| axes[*k]);
        // Every axis is an input, and its values are kept.
        (points == Some(sweep.len())).then_some(Self { values, order })
    }

    fn with<T>(&self, speeds: usize, job: impl FnOnce(&GridInputs<'_>) -> T) -> T {
        let values: Vec<&[f64]> = self.values.iter().map(|v| &v[..]).collect();
        let (speeds, torques) = values.split_at(speeds);
        job(&GridInputs::new(speeds, torques).nested(&self.order))
    }
}

/// A sweep whose points are answered by compiled trains.
#[derive(Clone, Debug)]
pub struct CompiledSweep<'s> {
    sweep: Arc<Sweep<'s>>,
    cases: Vec<Case>,
    /// Axes that choose the case, and how many cases one step of each is.
    choosing: Vec<(usize, usize)>,
    columns: Vec<(Column, What)>,
    /// The output that each number column takes.
    output: Vec<Option<usize>>,
    arch: Arch,
}

/// Work arrays; one for each thread.
#[derive(Debug, Default)]
pub struct SweepWorkspace {
    pub(super) trains: TrainCache,
    work: Vec<Option<Workspace>>,
    inputs: Vec<Vec<f64>>,
    outputs: Vec<Vec<f64>>,
}

fn refuse(message: &str, hint: &str) -> Diagnostics {
    Diagnostics::from_iter([Diagnostic::new(Code::Unfit, "", message).hint(hint)])
}

impl<'s> Sweep<'s> {
    /// Compiles the sweep.
    ///
    /// # Errors
    /// Losses that are computed, loads that are powers, axes other than speeds, torques, states and a few values of
    /// the train file; and what [`Train::compile`](crate::Train::compile) refuses.
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
    /// let axes = ["input.speed=1 rpm..2000 rpm:2000", "input.torque=1 N m..100 N m:500"];
    /// let axes = axes.iter().map(|a| Axis::parse(a, &model)).collect::<Result<_, _>>()?;
    /// let sweep = Sweep::new(PointSetup::new(&model, None, None, Hold::AsGiven).unwrap(), axes, &[]).unwrap();
    /// let map = sweep.compile().unwrap().summary(0, sweep.len(), &mut Default::default());
    /// assert_eq!(map.verdicts[&PointVerdict::Unique], 1_000_000);
    /// assert!((map.efficiency.least.unwrap().value - 0.98607).abs() < 1e-9);
    /// # Ok::<(), Box<willis::diagnostic::Diagnostic>>(())
    /// ```
    pub fn compile(&self) -> Result<CompiledSweep<'s>, Diagnostics> {
        CompiledSweep::new(Arc::new(self.clone()))
    }

    /// Columns of a compiled sweep, the outputs they need, and which column takes which.
    #[expect(clippy::type_complexity, reason = "three parallel lists, taken apart at once")]
    fn compiled_columns(&self) -> Result<(Vec<(Column, What)>, Vec<CompiledOutput>, Vec<Option<usize>>), Diagnostics> {
        let mut outputs = vec![CompiledOutput::Efficiency, CompiledOutput::Loss];
        let (mut columns, mut output) = (vec![], vec![]);
        for (column, what) in &self.columns {
            let wanted = match what {
                What::Efficiency => Some(CompiledOutput::Efficiency),
                What::Loss => Some(CompiledOutput::Loss),
                What::Speed(m) => Some(CompiledOutput::Speed(m.clone())),
                What::Torque(m) => Some(CompiledOutput::Torque(m.clone())),
                What::ElementTorque(e) => Some(CompiledOutput::ShiftElementTorque(e.clone())),
                What::Axis(_) | What::Verdict | What::Best | What::Reason => None,
                // Not of every point at little cost; the long way has them.
                What::InputPower | What::OutputPower | What::LossOf(_) | What::Warnings => continue,
                _ => {
                    let message = format!("`{}` is no column of a compiled sweep", column.name);
                    return Err(refuse(&message, "ask for speeds and torques, or leave out `fast`"));
                }
            };
            output.push(wanted.map(|w| {
                outputs.iter().position(|o| *o == w).unwrap_or_else(|| {
                    outputs.push(w);
                    outputs.len() - 1
                })
            }));
            columns.push((column.clone(), what.clone()));
        }
        Ok((columns, outputs, output))
    }

    fn case(
        &self,
        case: usize,
        choosing: &[(usize, usize)],
        outputs: &[CompiledOutput],
        trains: &mut TrainCache,
    ) -> Result<Case, Diagnostics> {
        let value =
            |k: usize| choosing.iter().find(|c| c.0 == k).map_or(0, |&(k, step)| case / step % self.axes[k].len());
        let settings: Vec<(&Target, String)> =
            self.axes.iter().enumerate().map(|(k, a)| (&a.target, a.setting(value(k)))).collect();
        let (train, operation) = self.question.at(&settings, trains)?;
        let prescribed: Vec<MemberId> = operation.speeds.iter().map(|s| s.0).collect();
        let si = |k: usize| {
            let axis = &self.axes[k];
            let dimension = match axis.target {
                Target::Speed(_) => units::Dimension::ANGULAR_SPEED,
                _ => units::Dimension::TORQUE,
            };
            units::parse(&format!("1 {}", axis.unit), dimension).map_or(f64::NAN, |q| q.si())
        };
        let axis_of = |member: MemberId, speed: bool| -> Result<Option<(usize, ShaftRef)>, Diagnostics> {
            for (k, axis) in self.axes.iter().enumerate() {
                let who = match axis.target {
                    Target::Speed(who) if speed => who,
                    Target::Torque(who) if !speed => who,
                    _ => continue,
                };
                if self.question.role(&train, &operation, who)? == member {
                    return Ok(Some((k, who)));
                }
            }
            Ok(None)
        };
        let mut speeds = vec![];
        for (member, q) in &operation.speeds {
            speeds.push(match axis_of(*member, true)? {
                Some((k, _)) => Input::Axis(Values::new(self, k, si(k), Dimension::ANGULAR_SPEED)),
                None => Input::Constant(q.si()),
            });
        }
        let engaged = operation.state.map_or(&[][..], |k| &train.states[k].engaged);
        let c = Configuration::new(&train, engaged, &operation.fixed, &prescribed);
        let transfer = c.transfer(&prescribed);
        let mut torques = vec![];
        for (member, load) in &operation.loads {
            let Load::Torque(q) = load else {
                return Err(refuse(
                    "a load is a power; compiled sweeps take torques",
                    "hold the torque: `hold` = torque",
                ));
            };
            torques.push(match axis_of(*member, false)? {
                None => Input::Constant(q.si()),
                Some((k, ShaftRef::Member(_))) => Input::Axis(Values::new(self, k, si(k), Dimension::TORQUE)),
                Some((k, who)) => {
                    let sign = if who == ShaftRef::Input { 1.0 } else { -1.0 };
                    let follows = transfer.speeds[member.0].as_ref().map(|f| f.iter().map(|x| x.to_f64()).collect());
                    Input::Role(Values::new(self, k, sign * si(k), Dimension::TORQUE), follows.unwrap_or_default())
                }
            });
        }
        let name = |m: &MemberId| train.member_name(*m).to_owned();
        let names: (Vec<String>, Vec<String>) =
            (prescribed.iter().map(name).collect(), operation.loads.iter().map(|l| name(&l.0)).collect());
        let mut duty = CompileRequest::new(names.0.iter().map(String::as_str), names.1.iter().map(String::as_str));
        if let Some(k) = operation.state {
            duty = duty.state(&train.states[k].name);
        }
        for m in &operation.fixed {
            duty = duty.fixed(train.member_name(*m));
        }
        for output in outputs {
            duty = duty.output(output.clone());
        }
        let inputs: Vec<&Input> = speeds.iter().chain(&torques).collect();
        let grid = Grid::new(self, &inputs);
        Ok(Case { train: train.compile(&duty)?, grid, speeds, torques })
    }
}

impl<'s> CompiledSweep<'s> {
    /// See [`Sweep::compile`].
    pub(super) fn new(sweep: Arc<Sweep<'s>>) -> Result<Self, Diagnostics> {
        let axes = &sweep.axes;
        let with_hold = "sweep without `fast`";
        if sweep.question.model().train().is_physical() {
            return Err(refuse(
                "losses of this train are computed from load and speed; they cannot be compiled",
                with_hold,
            ));
        }
        if !sweep.question.model().train().variators.is_empty() {
            return Err(refuse(
                "this train has a variator, whose torques depend on the speeds; it cannot be compiled",
                with_hold,
            ));
        }
        let one_way = |e: &&ShiftElement| e.kind == ShiftElementKind::OneWay;
        if let Some(e) = sweep.question.model().train().shift_elements().iter().find(one_way) {
            let message = format!("`{}` is a one-way clutch: what it allows is looked at point by point", e.name);
            return Err(refuse(&message, with_hold));
        }
        if let Some(a) = axes.iter().find(|a| {
            matches!(
                a.target,
                Target::Ratio | Target::Store(_) | Target::Power(_) | Target::Temperature | Target::Law(_)
            )
        }) {
            let message = format!("`{}` cannot vary in a compiled sweep", a.name);
            return Err(refuse(
                &message,
                "vary speeds, torques, states or values of the train file, or leave out `fast`",
            ));
        }
        if sweep.question.hold() == Hold::Power {
            return Err(refuse("a held power is no torque that could be compiled", with_hold));
        }
        // The states first in memory order: the last case axis runs fastest.
        let mut choosing = vec![];
        let mut count = 1usize;
        for (k, axis) in axes.iter().enumerate().rev() {
            if !matches!(axis.target, Target::Speed(_) | Target::Torque(_)) {
                choosing.push((k, count));
                count = count.saturating_mul(axis.len());
            }
        }
        if count > MOST_CASES {
            let message = format!("{count} different trains are too many to compile; {MOST_CASES} are not");
            return Err(refuse(&message, with_hold));
        }
        let (columns, outputs, output) = sweep.compiled_columns()?;
        let mut trains = TrainCache::default();
        let cases = (0..count).map(|case| sweep.case(case, &choosing, &outputs, &mut trains));
        let cases = cases.collect::<Result<Vec<_>, _>>()?;
        Ok(Self { sweep: Arc::clone(&sweep), cases, choosing, columns, output, arch: Arch::new() })
    }

    /// The columns of the rows.
    pub fn columns(&self) -> impl ExactSizeIterator<Item = &Column> {
        self.columns.iter().map(|c| &c.0)
    }

    fn case_of(&self, point: u64) -> usize {
        let place = self.sweep.place(point);
        self.choosing.iter().map(|&(k, step)| place[k] * step).sum()
    }

    /// Fills the outputs of a case at some points. Returns the points that are not plainly unique.
    fn evaluate(&self, case: usize, points: &Span<'_>, room: &mut SweepWorkspace) -> usize {
        let own = &self.cases[case];
        let n = points.len();
        room.work.resize_with(self.cases.len(), || None);
        let work = room.work[case].get_or_insert_with(|| own.train.workspace());
        room.inputs.resize_with(own.speeds.len() + own.torques.len(), Vec::new);
        room.outputs.resize_with(own.train.outputs(), Vec::new);
        room.inputs.iter_mut().chain(&mut room.outputs).for_each(|v| v.resize(n, 0.0));
        if let (Some(grid), Span::Run(from, _)) = (&own.grid, points) {
            let points = *from as usize..*from as usize + n;
            let mut outputs: Vec<&mut [f64]> = room.outputs.iter_mut().map(Vec::as_mut_slice).collect();
            return grid.with(own.speeds.len(), |grid| own.train.evaluate_grid(grid, points, work, &mut outputs));
        }
        let set = |input: &Input, speeds: &[Vec<f64>], out: &mut [f64]| match input {
            Input::Constant(x) => out.fill(*x),
            Input::Axis(values) => points.axis(&self.sweep, values, out),
            Input::Role(values, follows) => {
                points.axis(&self.sweep, values, out);
                for (i, o) in out.iter_mut().enumerate() {
                    let speed: f64 = follows.iter().zip(speeds).map(|(f, s)| f * s[i]).sum();
                    if speed < 0.0 {
                        *o = -*o;
                    }
                }
            }
        };
        let (speeds, torques) = room.inputs.split_at_mut(own.speeds.len());
        for (input, out) in own.speeds.iter().zip(speeds.iter_mut()) {
            set(input, &[], out);
        }
        for (input, out) in own.torques.iter().zip(torques.iter_mut()) {
            set(input, speeds, out);
        }
        let speeds: Vec<&[f64]> = speeds.iter().map(Vec::as_slice).collect();
        let torques: Vec<&[f64]> = torques.iter().map(Vec::as_slice).collect();
        let mut outputs: Vec<&mut [f64]> = room.outputs.iter_mut().map(Vec::as_mut_slice).collect();
        own.train.evaluate_batch(&BatchInputs { speeds: &speeds, torques: &torques }, work, &mut outputs)
    }

    /// What the points from `from` up to `to` say together; no row is made.
    pub fn summary(&self, from: u64, to: u64, room: &mut SweepWorkspace) -> Summary {
        let mut summary = Summary::default();
        let blocks = (from..to).step_by(BLOCK).map(|point| point..to.min(point + BLOCK as u64));
        let [Case { train, grid: Some(grid), speeds, .. }] = &self.cases[..] else {
            blocks.for_each(|b| self.block(b.start, (b.end - b.start) as usize, room, &mut summary, None));
            return summary;
        };
        grid.with(speeds.len(), |grid| {
            let layout = train.layout(grid);
            let mut work = room.work.pop().flatten().unwrap_or_else(|| train.workspace());
            let mut known = [OutputSummary::default(); 2];
            for block in blocks {
                let before = known;
                known.iter_mut().for_each(|k| k.sum = 0.0);
                let points = block.start as usize..block.end as usize;
                let odd = train.summarize_grid_block(&layout, points, &mut work, &mut known);
                let n = block.end - block.start;
                if odd == 0 && all_drive(&known[0]) {
                    // All unique and driving: nothing to look at one by one.
                    all_unique(&mut summary, n, &known);
                } else {
                    known = before;
                    self.block(block.start, n as usize, room, &mut summary, None);
                }
            }
            room.work = vec![Some(work)];
        });
        summary
    }

    /// The rows of the points from `from` up to `to`, whole [groups](Sweep::group).
    pub fn rows(&self, from: u64, to: u64, room: &mut SweepWorkspace) -> Rows {
        let mut rows = Rows::with_capacity(self.columns(), (to - from) as usize);
        let step = (BLOCK as u64 / self.sweep.group()).max(1) * self.sweep.group();
        let mut point = from;
        while point < to {
            let n = (to - point).min(step) as usize;
            let mut summary = std::mem::take(&mut rows.summary);
            self.block(point, n, room, &mut summary, Some(&mut rows.columns));
            rows.summary = summary;
            point += n as u64;
        }
        rows
    }

    fn block(
        &self,
        from: u64,
        n: usize,
        room: &mut SweepWorkspace,
        summary: &mut Summary,
        cells: Option<&mut Vec<ColumnValues>>,
    ) {
        let to = from + n as u64;
        let single = self.cases.len() == 1;
        if single && self.evaluate(0, &Span::Run(from, n), room) == 0 {
            let [efficiency, loss, ..] = &room.outputs[..] else { unreachable!("always asked for") };
            let known = [efficiency, loss].map(|values| {
                let mut known = OutputSummary::default();
                known.add_block(self.arch, values, from as usize);
                known
            });
            if all_drive(&known[0]) {
                // All unique and driving: nothing to look at one by one.
                all_unique(summary, n as u64, &known);
                if let Some(cells) = cells {
                    self.plain_rows(from, n, &room.outputs, cells);
                }
                return;
            }
        }
        // Number columns by point, and whether the point is to be asked the long way.
        let outputs = self.cases[0].train.outputs();
        let mut values = vec![vec![0.0; n]; outputs];
        let mut doubtful = vec![false; n];
        for case in 0..self.cases.len() {
            let own: Vec<u64> = match single {
                true => vec![],
                false => (from..to).filter(|p| self.case_of(*p) == case).collect(),
            };
            let span = if single { Span::Run(from, n) } else { Span::List(&own) };
            if span.len() == 0 {
                continue;
            }
            let odd = self.evaluate(case, &span, room);
            for i in 0..span.len() {
                let at = (span.point(i) - from) as usize;
                for (all, own) in values.iter_mut().zip(&room.outputs) {
                    all[at] = own[i];
                }
                // Where nothing enters or nothing leaves, and where a pattern is not the only one, words are needed.
                let drives = room.outputs[0][i].partial_cmp(&0.0).is_some_and(|o| o.is_gt());
                doubtful[at] = odd > 0 || !drives;
            }
        }
        // Boxed: hardly any point has one.
        let mut answers: Vec<Option<Box<PointAnswer>>> = vec![None; n];
        for i in (0..n).filter(|i| doubtful[*i]) {
            let answer = self.sweep.answer(from + i as u64, &mut room.trains);
            values[0][i] = answer.efficiency();
            values[1][i] = answer.loss();
            answers[i] = Some(Box::new(answer));
        }
        self.tell(from, n, &values, &answers, summary, cells);
    }

    /// The column of an axis, in its own unit.
    fn axis_column(&self, axis: usize, from: u64, n: usize, out: &mut Vec<f64>) {
        let (stride, own) = (self.sweep.stride(axis), &self.sweep.axes[axis]);
        let to = from + n as u64;
        let mut point = from;
        while point < to {
            let k = (point / stride % own.len() as u64) as usize;
            let run = (stride - point % stride).min(to - point);
            out.resize(out.len() + run as usize, own.number(k));
            point += run;
        }
    }

    /// Rows of points that are all unique.
    fn plain_rows(&self, from: u64, n: usize, outputs: &[Vec<f64>], cells: &mut [ColumnValues]) {
        for ((cells, (_, what)), output) in cells.iter_mut().zip(&self.columns).zip(&self.output) {
            match (cells, what, output) {
                (ColumnValues::Numbers(all), What::Axis(k), _) => self.axis_column(*k, from, n, all),
                (ColumnValues::Numbers(all), _, Some(o)) => all.extend_from_slice(&outputs[*o]),
                (ColumnValues::Texts(all), What::Verdict, _) => {
                    all.resize(all.len() + n, PointVerdict::Unique.name().into())
                }
                (ColumnValues::Texts(all), What::Reason, _) => all.resize(all.len() + n, "".into()),
                _ => unreachable!("a single train has no axis of texts"),
            }
        }
    }

    fn tell(
        &self,
        from: u64,
        n: usize,
        values: &[Vec<f64>],
        answers: &[Option<Box<PointAnswer>>],
        summary: &mut Summary,
        cells: Option<&mut Vec<ColumnValues>>,
    ) {
        let sweep = &self.sweep;
        let group = sweep.group() as usize;
        let verdict = |i: usize| answers[i].as_ref().map_or(PointVerdict::Unique, |a| a.verdict);
        let efficiency = |i: usize| if verdict(i) == PointVerdict::Unique { values[0][i] } else { f64::NAN };
        let mut best = vec![false; if group > 1 { n } else { 0 }];
        if group > 1 {
            for first in (0..n).step_by(group) {
                let all = first..(first + group).min(n);
                let most = all.filter(|i| efficiency(*i) > 0.0);
                if let Some(i) = most.max_by(|a, b| efficiency(*a).total_cmp(&efficiency(*b)).then(b.cmp(a))) {
                    best[i] = true;
                }
            }
        }
        summary.points += n as u64;
        let texts: Vec<usize> = (0..sweep.axes.len()).filter(|k| sweep.axes[*k].is_text()).collect();
        let mut by_verdict: Vec<(PointVerdict, u64)> = vec![];
        let (mut all_efficiency, mut all_loss) = (MinMaxSum::default(), MinMaxSum::default());
        for i in 0..n {
            let point = from + i as u64;
            match by_verdict.iter_mut().find(|v| v.0 == verdict(i)) {
                Some(v) => v.1 += 1,
                None => by_verdict.push((verdict(i), 1)),
            }
            all_efficiency.add(efficiency(i), point);
            all_loss.add(values[1][i], point);
            if !texts.is_empty() {
                let place = sweep.place(point);
                for &k in &texts {
                    let value = sweep.axes[k].setting(place[k]);
                    if best.get(i) == Some(&true) && sweep.axes[k].is_state() {
                        *summary.best.entry(value.clone()).or_default() += 1;
                    }
                    let text = AxisValue { axis: sweep.axes[k].name.clone(), value };
                    summary.by_text.entry(text).or_default().add(efficiency(i), point);
                }
            }
            if let Some(a) = &answers[i] {
                summary.hear(a, point);
            }
        }
        for (verdict, count) in by_verdict {
            *summary.verdicts.entry(verdict).or_default() += count;
        }
        summary.efficiency.join(&all_efficiency);
        summary.loss_w.join(&all_loss);
        let Some(cells) = cells else { return };
        for ((cells, (_, what)), output) in cells.iter_mut().zip(&self.columns).zip(&self.output) {
            match cells {
                ColumnValues::Numbers(all) => match (what, output) {
                    (What::Axis(k), _) => self.axis_column(*k, from, n, all),
                    (_, Some(o)) => {
                        // A point without an answer has no numbers.
                        let has = |i: usize| answers[i].as_ref().is_none_or(|a| a.solution.is_some());
                        all.extend((0..n).map(|i| if has(i) { values[*o][i] } else { f64::NAN }));
                    }
                    _ => unreachable!("numbers are axes or outputs"),
                },
                ColumnValues::Integers(_) => unreachable!("no column of a sweep counts"),
                ColumnValues::Texts(all) => all.extend((0..n).map(|i| -> Cow<'static, str> {
                    match what {
                        What::Axis(k) => sweep.axes[*k].setting(sweep.place(from + i as u64)[*k]).into(),
                        What::Verdict => verdict(i).name().into(),
                        What::Best => if best[i] { "yes" } else { "no" }.into(),
                        _ => answers[i].as_ref().map_or("".into(), |a| a.reason.clone().into()),
                    }
                })),
            }
        }
    }
}

/// Points of a block.
enum Span<'a> {
    Run(u64, usize),
    List(&'a [u64]),
}

impl Span<'_> {
    fn len(&self) -> usize {
        match self {
            Self::Run(_, n) => *n,
            Self::List(all) => all.len(),
        }
    }

    fn point(&self, i: usize) -> u64 {
        match self {
            Self::Run(from, _) => from + i as u64,
            Self::List(all) => all[i],
        }
    }

    /// Values of an axis at the points, SI.
    fn axis(&self, sweep: &Sweep<'_>, values: &Values, out: &mut [f64]) {
        match self {
            Self::Run(from, _) => values.fill(sweep, *from, out),
            Self::List(all) => {
                let (stride, n) = (sweep.stride(values.axis), sweep.axes[values.axis].len() as u64);
                for (o, p) in out.iter_mut().zip(*all) {
                    *o = values.at(sweep, (p / stride % n) as usize);
                }
            }
        }
    }
}

/// Whether all efficiencies are above 0: a single NaN would be in the sum.
fn all_drive(efficiency: &OutputSummary) -> bool {
    efficiency.min.is_some_and(|min| min.value > 0.0) && !efficiency.sum.is_nan()
}

/// Adds points that are all unique and drive, by their efficiency and loss.
fn all_unique(summary: &mut Summary, points: u64, [efficiency, loss]: &[OutputSummary; 2]) {
    summary.points += points;
    *summary.verdicts.entry(PointVerdict::Unique).or_default() += points;
    for (all, own) in [(&mut summary.efficiency, efficiency), (&mut summary.loss_w, loss)] {
        let (Some(min), Some(max)) = (own.min, own.max) else { continue };
        let at = |x: f64| if x == min.value { min.point } else { max.point } as u64;
        all.add_run(points, own.sum, [min.value, max.value], at);
    }
}
