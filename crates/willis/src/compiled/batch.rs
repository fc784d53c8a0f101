//! Many points at once: from arrays or from a grid, into arrays or into sums and extremes.

use std::ops::Range;

use crate::arch::Arch;

use super::duty::BatchInputs;
use super::grid::{GridInputs, Layout, OutputSummary, PointValue};
use super::kernel::{self, Chunk, SUMS};
use super::parts::{CHUNK, MOST_FEATURES, Target};
use super::passes::is_tiny;
use super::single::{Single, SingleOut};
use super::{Column, CompiledTrain};

/// Points that are added up before their sum is added to that of all points.
const SUM_BLOCK: usize = 4 * CHUNK;

/// Room for the work on a batch; make it once and use it again.
#[derive(Clone, Debug)]
pub struct Workspace {
    chunk: Chunk,
    /// The pattern that fitted last.
    pub(super) hint: usize,
    /// Inputs of a chunk of a grid: torques, then speeds.
    inputs: Vec<[f64; CHUNK]>,
    /// Partial sums of each output.
    sums: Vec<[f64; SUMS]>,
    /// Torques, loss and efficiency of a power split.
    single: Vec<[f64; SUM_BLOCK]>,
}

/// Where the inputs of a batch come from.
#[derive(Clone, Copy)]
enum Source<'s, 'a> {
    Arrays(&'s BatchInputs<'a>),
    Grid(&'s Layout<'a>),
}

impl<'s> Source<'s, '_> {
    /// The inputs at the points of a chunk, torques first. Where an efficiency is asked for, tiny ones are zero.
    fn given<'g>(
        self,
        train: &CompiledTrain,
        points: Range<usize>,
        inputs: &'g mut [[f64; CHUNK]],
    ) -> [&'g [f64]; MOST_FEATURES]
    where
        's: 'g,
    {
        let (speeds, torques) = (train.speeds, train.torques);
        let mut given: [&[f64]; MOST_FEATURES] = [&[]; MOST_FEATURES];
        match self {
            Self::Arrays(all) => {
                for ((slot, s), own) in given.iter_mut().zip(all.torques.iter().chain(all.speeds)).zip(inputs) {
                    let s = &s[points.clone()];
                    *slot = match train.divides && is_tiny(train.arch, s) {
                        true => {
                            own[..s.len()].copy_from_slice(s);
                            without_tiny(&mut own[..s.len()])
                        }
                        false => s,
                    };
                }
            }
            Self::Grid(layout) => {
                for (k, (slot, own)) in given.iter_mut().zip(inputs).enumerate() {
                    let input = if k < torques { speeds + k } else { k - torques };
                    let own = &mut own[..points.len()];
                    layout.fill(input, points.clone(), own);
                    *slot = if train.divides && layout.is_tiny { without_tiny(own) } else { &*own };
                }
            }
        }
        given
    }

    /// A prescribed torque at some points.
    fn torque(self, train: &CompiledTrain, torque: usize, points: Range<usize>, out: &mut [f64]) {
        match self {
            Self::Arrays(all) => out.copy_from_slice(&all.torques[torque][points]),
            Self::Grid(layout) => layout.fill(train.speeds + torque, points, out),
        }
    }
}

/// Zero of the same sign in the place of what is too small for all digits of floating point.
pub(super) fn without_tiny(x: &mut [f64]) -> &[f64] {
    x.iter_mut().filter(|x| x.is_subnormal()).for_each(|x| *x = 0f64.copysign(*x));
    x
}

impl CompiledTrain {
    /// Room for evaluation; reuse it.
    pub fn workspace(&self) -> Workspace {
        Workspace {
            chunk: Chunk::new(&self.general),
            hint: 0,
            inputs: vec![[0.0; CHUNK]; self.speeds + self.torques],
            sums: vec![[0.0; SUMS]; self.outputs.len()],
            single: vec![[0.0; SUM_BLOCK]; if self.single.is_some() { 4 } else { 0 }],
        }
    }

    /// Evaluates many points into one slice per output. Returns how many points are not unique.
    ///
    /// # Panics
    /// If a slice has another length than the inputs.
    pub fn evaluate_batch(&self, points: &BatchInputs<'_>, work: &mut Workspace, out: &mut [&mut [f64]]) -> usize {
        let n = points.len(self.speeds, self.torques);
        self.store(Source::Arrays(points), 0..n, work, out)
    }

    /// Evaluates some points of a grid, by their numbers, into one slice per output. Returns how many of them are not
    /// unique. The results are those of [`CompiledTrain::evaluate_batch`] to the last bit.
    ///
    /// # Example
    /// See [`GridInputs`].
    ///
    /// # Panics
    /// If the grid has other inputs than the request, a point is beyond its end, or a slice is not as long as the points are
    /// many.
    pub fn evaluate_grid(
        &self,
        grid: &GridInputs<'_>,
        points: Range<usize>,
        work: &mut Workspace,
        out: &mut [&mut [f64]],
    ) -> usize {
        assert!(points.end <= grid.len(), "points of the grid");
        self.store(Source::Grid(&self.layout(grid)), points, work, out)
    }

    /// The results of [`CompiledTrain::evaluate_batch`], rounded to single precision: half the memory to write, and the same
    /// work otherwise. A result beyond the range of single precision is infinite.
    ///
    /// # Example
    /// ```
    /// use willis::compiled::{BatchInputs, CompileRequest, CompiledOutput};
    /// use willis::train::{SetSpec, Train};
    ///
    /// let train = Train::builder("reducer")
    ///     .members(["sun", "carrier"])
    ///     .terminals(["sun", "carrier"])
    ///     .set(SetSpec::simple("P1", ("sun", 30), ("frame", 70), "carrier").mesh_efficiency(0.99))
    ///     .build()?;
    /// let compiled = train.compile(&CompileRequest::new(["sun"], ["sun"]).output(CompiledOutput::Efficiency))?;
    /// let points = BatchInputs { speeds: &[&[100.0, 200.0]], torques: &[&[10.0, 10.0]] };
    /// let mut out = [0f32; 2];
    /// compiled.evaluate_batch_f32(&points, &mut compiled.workspace(), &mut [&mut out]);
    /// // (1 + 7/3 · 0.99²)/(1 + 7/3)
    /// assert_eq!(out, [0.98607f32; 2]);
    /// # Ok::<(), willis::diagnostic::Diagnostics>(())
    /// ```
    ///
    /// # Panics
    /// As [`CompiledTrain::evaluate_batch`].
    pub fn evaluate_batch_f32(&self, points: &BatchInputs<'_>, work: &mut Workspace, out: &mut [&mut [f32]]) -> usize {
        let n = points.len(self.speeds, self.torques);
        self.store_rounded(Source::Arrays(points), 0..n, work, out)
    }

    /// The results of [`CompiledTrain::evaluate_grid`], rounded to single precision.
    ///
    /// # Example
    /// See [`CompiledTrain::evaluate_batch_f32`] and [`GridInputs`].
    ///
    /// # Panics
    /// As [`CompiledTrain::evaluate_grid`].
    pub fn evaluate_grid_f32(
        &self,
        grid: &GridInputs<'_>,
        points: Range<usize>,
        work: &mut Workspace,
        out: &mut [&mut [f32]],
    ) -> usize {
        assert!(points.end <= grid.len(), "points of the grid");
        self.store_rounded(Source::Grid(&self.layout(grid)), points, work, out)
    }

    /// What each output is over many points: its sum and its extremes, with no result stored. Returns how many points are
    /// not unique.
    ///
    /// # Example
    /// See [`GridInputs`].
    ///
    /// # Panics
    /// If `out` is not as long as the outputs are many.
    pub fn summarize_batch(&self, points: &BatchInputs<'_>, work: &mut Workspace, out: &mut [OutputSummary]) -> usize {
        let n = points.len(self.speeds, self.torques);
        self.summarize(Source::Arrays(points), 0..n, work, out)
    }

    /// The same over some points of a grid, by their numbers.
    ///
    /// # Panics
    /// If the grid has other inputs than the request, a point is beyond its end, or `out` is not as long as the outputs are
    /// many.
    pub fn summarize_grid(
        &self,
        grid: &GridInputs<'_>,
        points: Range<usize>,
        work: &mut Workspace,
        out: &mut [OutputSummary],
    ) -> usize {
        assert!(points.end <= grid.len(), "points of the grid");
        self.summarize(Source::Grid(&self.layout(grid)), points, work, out)
    }

    fn store(
        &self,
        source: Source<'_, '_>,
        points: Range<usize>,
        work: &mut Workspace,
        out: &mut [&mut [f64]],
    ) -> usize {
        assert_eq!(out.len(), self.outputs.len(), "one slice for each output of the request");
        let n = points.len();
        assert!(out.iter().all(|o| o.len() == n), "outputs as long as the inputs");
        if let Some(single) = &self.single {
            let mut direct = SingleOut::default();
            // Every quantity is written once, straight to where it was asked for.
            for (o, c) in out.iter_mut().zip(&self.outputs) {
                match *c {
                    Column::Linear(i) if direct.torque[i].is_none() => direct.torque[i] = Some(o),
                    Column::Loss if direct.loss.is_none() => direct.loss = Some(o),
                    Column::Efficiency if direct.efficiency.is_none() => direct.efficiency = Some(o),
                    Column::Input(i) => source.torque(self, i, points.clone(), o),
                    _ => {}
                }
            }
            self.run_single(single, source, points, &mut work.inputs, direct);
            for k in (1..out.len()).filter(|k| !matches!(self.outputs[*k], Column::Input(_))) {
                // What was asked for before.
                if let Some(from) = self.outputs[..k].iter().position(|c| *c == self.outputs[k]) {
                    let (head, tail) = out.split_at_mut(k);
                    tail[0].copy_from_slice(head[from]);
                }
            }
            return 0;
        }
        let mut odd = 0;
        let mut start = 0;
        while start < n {
            let len = CHUNK.min(n - start);
            let range = start..start + len;
            let now = points.start + start..points.start + start + len;
            let Workspace { chunk, hint, inputs, .. } = work;
            let given = source.given(self, now.clone(), inputs);
            let to = Target { column: &self.column_of, out, powers: self.needs_power() };
            odd += self.general.chunk(self.arch, &given[..self.speeds + self.torques], range.clone(), chunk, hint, to);
            for (k, c) in self.outputs.iter().enumerate() {
                match *c {
                    Column::Input(i) => source.torque(self, i, now.clone(), &mut out[k][range.clone()]),
                    Column::Linear(i) if self.column_of[i] == Some(k) => {}
                    Column::Linear(i) => {
                        let first = self.column_of[i].expect("a linear column is one of the outputs");
                        let (head, tail) = out.split_at_mut(k);
                        tail[0][range.clone()].copy_from_slice(&head[first][range.clone()]);
                    }
                    _ => out[k][range.clone()].copy_from_slice(chunk.column(c, len)),
                }
            }
            start += len;
        }
        odd
    }

    /// As [`Self::store`], block by block through the arrays of the workspace.
    fn store_rounded(
        &self,
        source: Source<'_, '_>,
        points: Range<usize>,
        work: &mut Workspace,
        out: &mut [&mut [f32]],
    ) -> usize {
        assert_eq!(out.len(), self.outputs.len(), "one slice for each output of the request");
        assert!(out.iter().all(|o| o.len() == points.len()), "outputs as long as the inputs");
        let from = points.start;
        self.in_blocks(source, points, work, &self.outputs, |k, values, start| {
            kernel::round(self.arch, values, &mut out[k][start - from..][..values.len()]);
        })
    }

    /// Points block by block through the arrays of the workspace: `take` gets the values of each wanted output, its number and
    /// the first point.
    fn in_blocks(
        &self,
        source: Source<'_, '_>,
        points: Range<usize>,
        work: &mut Workspace,
        wanted: &[Column],
        mut take: impl FnMut(usize, &[f64], usize),
    ) -> usize {
        let mut odd = 0;
        let block = self.block(source);
        for start in points.clone().step_by(block) {
            let now = start..points.end.min(start + block);
            odd += self.fill_work(source, now.clone(), work, wanted);
            for (k, c) in wanted.iter().enumerate() {
                match *c {
                    Column::Input(i) => {
                        let mut own = [0.0; SUM_BLOCK];
                        let own = &mut own[..now.len()];
                        source.torque(self, i, now.clone(), own);
                        take(k, own, start);
                    }
                    _ => take(k, self.in_work(&work.chunk, &work.single, c, now.len()), start),
                }
            }
        }
        odd
    }

    /// Points that are worked off at once where results stay in the workspace: rows of a grid are cut as seldom as can be,
    /// arrays so that inputs and results stay in the first-level cache.
    fn block(&self, source: Source<'_, '_>) -> usize {
        match source {
            Source::Grid(_) if self.single.is_some() => SUM_BLOCK,
            _ => CHUNK,
        }
    }

    /// The fused kernel over all points.
    fn run_single(
        &self,
        single: &Single,
        source: Source<'_, '_>,
        points: Range<usize>,
        inputs: &mut [[f64; CHUNK]],
        mut out: SingleOut<'_>,
    ) {
        match source {
            Source::Arrays(all) => {
                let [w0, w1] = [0, 1].map(|k| &all.speeds[k][points.clone()]);
                single.run(self.arch, w0, w1, &all.torques[0][points], out);
            }
            // A grid without points has no place to begin at.
            Source::Grid(layout) if layout.torque_runs && !layout.is_tiny && !points.is_empty() => {
                let mut counters = [0, 1].map(|input| layout.counter(input, points.start));
                let mut left = points.len();
                let mut torque = layout.rest_of_row(2, points.start);
                while left > 0 {
                    let now = &torque[..torque.len().min(left)];
                    single.run_row(self.arch, counters.each_ref().map(|c| c.value()), now, out.take(now.len()));
                    left -= now.len();
                    counters.iter_mut().for_each(|c| c.advance(now.len()));
                    torque = layout.row(2);
                }
            }
            Source::Grid(_) => {
                for start in points.clone().step_by(CHUNK) {
                    let now = start..points.end.min(start + CHUNK);
                    let [torque, w0, w1, ..] = source.given(self, now.clone(), inputs);
                    single.run(self.arch, w0, w1, torque, out.take(now.len()));
                }
            }
        }
    }

    /// A few points into the arrays of the workspace, at least what is wanted.
    fn fill_work(
        &self,
        source: Source<'_, '_>,
        points: Range<usize>,
        work: &mut Workspace,
        wanted: &[Column],
    ) -> usize {
        let n = points.len();
        let Workspace { chunk, hint, inputs, single: own, .. } = work;
        match &self.single {
            Some(single) => {
                let [first, second, loss, efficiency] = &mut own[..] else { unreachable!("one for each result") };
                let is = |c: Column| wanted.contains(&c);
                let torque = [
                    is(Column::Linear(0)).then_some(&mut first[..n]),
                    is(Column::Linear(1)).then_some(&mut second[..n]),
                ];
                let loss = is(Column::Loss).then_some(&mut loss[..n]);
                let efficiency = is(Column::Efficiency).then_some(&mut efficiency[..n]);
                self.run_single(single, source, points, inputs, SingleOut { torque, loss, efficiency });
                0
            }
            None => {
                let given = source.given(self, points, inputs);
                let to = Target { column: &self.column_of, out: &mut [], powers: self.needs_power() };
                self.general.chunk(self.arch, &given[..self.speeds + self.torques], 0..n, chunk, hint, to)
            }
        }
    }

    fn summarize(
        &self,
        source: Source<'_, '_>,
        points: Range<usize>,
        work: &mut Workspace,
        out: &mut [OutputSummary],
    ) -> usize {
        assert_eq!(out.len(), self.outputs.len(), "one summary for each output of the request");
        out.fill(OutputSummary::default());
        let mut odd = 0;
        for start in points.clone().step_by(SUM_BLOCK) {
            odd += self.summarize_block(source, start..points.end.min(start + SUM_BLOCK), work, out);
        }
        odd
    }

    /// A grid made ready once, for many blocks.
    pub(crate) fn layout<'a>(&self, grid: &GridInputs<'a>) -> Layout<'a> {
        grid.layout(self.speeds, self.torques)
    }

    /// What the first outputs are over a block of points of a grid: their sums over the block are added to those of
    /// `out`, extremes are taken in.
    pub(crate) fn summarize_grid_block(
        &self,
        layout: &Layout<'_>,
        points: Range<usize>,
        work: &mut Workspace,
        out: &mut [OutputSummary],
    ) -> usize {
        self.summarize_block(Source::Grid(layout), points, work, out)
    }

    fn summarize_block(
        &self,
        source: Source<'_, '_>,
        points: Range<usize>,
        work: &mut Workspace,
        out: &mut [OutputSummary],
    ) -> usize {
        let mut sums = std::mem::take(&mut work.sums);
        sums.fill([0.0; SUMS]);
        let wanted = &self.outputs[..out.len()];
        let odd = self.in_blocks(source, points, work, wanted, |k, values, start| {
            out[k].take_in(self.arch, values, start, &mut sums[k]);
        });
        for (o, sums) in out.iter_mut().zip(&sums) {
            o.sum += sums.iter().sum::<f64>();
        }
        work.sums = sums;
        odd
    }

    /// The sum of each output over many points, with no result stored.
    ///
    /// # Panics
    /// If `sums` is not as long as the outputs.
    pub fn sum_batch(&self, points: &BatchInputs<'_>, work: &mut Workspace, sums: &mut [f64]) -> usize {
        let n = points.len(self.speeds, self.torques);
        assert_eq!(sums.len(), self.outputs.len(), "one sum for each output of the request");
        sums.fill(0.0);
        self.in_blocks(Source::Arrays(points), 0..n, work, &self.outputs, |k, values, _| {
            sums[k] += kernel::sum(self.arch, values);
        })
    }

    /// An output that is in the arrays of the workspace.
    fn in_work<'w>(&self, chunk: &'w Chunk, single: &'w [[f64; SUM_BLOCK]], c: &Column, len: usize) -> &'w [f64] {
        match *c {
            Column::Linear(i) if self.single.is_some() => &single[i][..len],
            Column::Loss if self.single.is_some() => &single[2][..len],
            Column::Efficiency if self.single.is_some() => &single[3][..len],
            _ => chunk.column(c, len),
        }
    }

    fn needs_power(&self) -> bool {
        self.outputs.iter().any(|c| matches!(c, Column::Loss | Column::Efficiency))
    }
}

impl OutputSummary {
    /// Takes in a block of values, those of the points from `first` on.
    pub(crate) fn add_block(&mut self, arch: Arch, values: &[f64], first: usize) {
        let mut sums = [0.0; SUMS];
        self.take_in(arch, values, first, &mut sums);
        self.sum += sums.iter().sum::<f64>();
    }

    fn take_in(&mut self, arch: Arch, values: &[f64], first: usize, sums: &mut [f64; SUMS]) {
        let least = self.min.map_or(f64::INFINITY, |m| m.value);
        let most = self.max.map_or(f64::NEG_INFINITY, |m| m.value);
        // Where an extreme is, is looked up only when it is one.
        let Some([below, above]) = kernel::add(arch, values, sums, [least, most]) else { return };
        let found = |value: f64| {
            let at = values.iter().position(|v| *v == value);
            Some(PointValue { value, point: first + at.unwrap_or(0) })
        };
        if below < least {
            self.min = found(below);
        }
        if above > most {
            self.max = found(above);
        }
    }
}

impl Chunk {
    /// An output that is in the arrays of the chunk.
    fn column(&self, c: &Column, len: usize) -> &[f64] {
        match *c {
            Column::Speed(i) => &self.speeds[i][..len],
            Column::Linear(i) => &self.linear[i][..len],
            Column::Loss => &self.loss[..len],
            Column::Efficiency => &self.efficiency[..len],
            Column::Input(_) => unreachable!("handed through by the caller"),
        }
    }
}
