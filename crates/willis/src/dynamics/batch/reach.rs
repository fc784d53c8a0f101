//! How far speeds and inputs may go while a mode certainly goes on.
//!
//! Margins are sums over speeds and inputs, so that they hold at all points of a box if the least that they can be in it does.
//! Where a block stays in such boxes its steps need not look at margins, which are most of the rows of a step. What is held has no
//! slip while a mode goes on, so that only such points of a box count.

use crate::dynamics::fixed::FixedStep;
use crate::dynamics::fused::BLOCK;
use crate::dynamics::mode::dot;
use crate::dynamics::rounding::NOISE;

use super::lanes::{LANES, Lanes, Mask, write};

/// The step of a mode as blocks take it.
pub(super) struct Packed {
    /// By block of rows: the weights of speeds and of inputs that are not level, a column in one piece.
    pub weights: Vec<f64>,
    /// By margin: by how much each speed and input changes it where what is held has no slip; empty where nobody asks.
    spans: Vec<f64>,
    /// Rows of the speeds, those with the margins, and all.
    free: usize,
    checked: usize,
    rows: usize,
}

impl Packed {
    /// Of a mode; `cruises` tells whether blocks may.
    pub fn of(one: &FixedStep, mode: usize, cruises: bool) -> Self {
        let fused = &one.fused[mode];
        let speeds = one.v.len();
        let terms = speeds + one.varying.len();
        let mut weights = vec![];
        fused.pack(speeds, &one.varying, &mut weights);
        let mut packed = Self { weights, spans: vec![], free: fused.free, checked: fused.checked, rows: fused.rows };
        if !cruises || packed.is_small() {
            return packed;
        }
        // Directions in which nothing moves while the mode goes on, at right angles and of length one. What holds would end a
        // slip within the step, so that its force weighs them thousands of times as much as others.
        let mut held: Vec<Vec<f64>> = vec![];
        let groups = one.engine.system.groups.iter().enumerate();
        for (_, group) in groups.filter(|(g, _)| fused.mode.held >> g & 1 == 1) {
            let mut row = group.row.clone();
            remove(&held, &mut row);
            let size = dot(&row, &row).sqrt();
            // A slip that follows from others has none of its own.
            if size > 1e-9 * dot(&group.row, &group.row).sqrt() {
                row.iter_mut().for_each(|x| *x /= size);
                held.push(row);
            }
        }
        for row in packed.of_speeds()..fused.checked {
            let start = packed.spans.len();
            packed.spans.extend(weights_of(&packed.weights, row, terms));
            remove(&held, &mut packed.spans[start..start + speeds]);
        }
        packed
    }

    /// The end of the blocks of rows that hold speeds: what follows are margins.
    fn of_speeds(&self) -> usize {
        self.free.next_multiple_of(BLOCK)
    }

    /// Whether all rows are looked at.
    fn is_small(&self) -> bool {
        self.rows <= self.of_speeds() + FEW
    }
}

/// The weights of a row.
fn weights_of(weights: &[f64], row: usize, terms: usize) -> impl Iterator<Item = &f64> {
    let columns = &weights.as_chunks::<BLOCK>().0[row / BLOCK * terms..][..terms];
    columns.iter().map(move |column| &column[row % BLOCK])
}

/// Takes away the parts along directions; twice, since the first time leaves round-off.
fn remove(directions: &[Vec<f64>], x: &mut [f64]) {
    for q in directions.iter().chain(directions) {
        let along = dot(q, x);
        x.iter_mut().zip(q).for_each(|(x, q)| *x -= along * q);
    }
}

/// Where a step has at most so many rows beside those of the speeds, all are looked at and there is no box: it would cost as
/// much.
const FEW: usize = 2 * BLOCK;

/// Boxes that lasted fewer steps were not worth their price; steps until there are new ones then.
const LEAST_WORTH: u32 = 4;
const WAIT: u32 = 8;

/// Of the way to the nearest edge of a mode, the part that a box takes.
const SAFE: f64 = 0.9;

/// How far ahead of the run the middle of its box is, in halves of its length: runs seldom turn round.
const AHEAD: f64 = 0.8;

/// What a block needs to step its runs inside their modes: rows to look at, and a box for each run that is as long in each
/// direction as the run has moved of late.
///
/// Each run brings the rows of its own mode, so that those of different modes go on side by side.
pub(super) struct Reach {
    /// Middle and half the length of the boxes in each direction: negative where a run has none, without end where it needs none.
    pub centre: Vec<Lanes>,
    pub half: Vec<Lanes>,
    /// By row: its part of level inputs and its round-off; by block of rows and by column, its weights.
    pub base: Vec<Lanes>,
    pub least: Vec<Lanes>,
    pub weights: Vec<Lanes>,
    /// The mode whose weights stand there, of each run: they are as good when the run comes back from elsewhere.
    modes: [Option<usize>; LANES],
    /// Where the runs were when boxes were laid.
    from: Vec<Lanes>,
    /// Room for how boxes are laid: by how much each run moved since, and how much that is at least.
    moved: Vec<Lanes>,
    size: Vec<Lanes>,
    /// Steps since boxes were laid, and steps to wait before they are again.
    since: u32,
    waits: u32,
    /// When it was last asked whether they are due, and the answer.
    asked: (u64, bool),
    /// What stands in places without a run: a box without an end. Elsewhere none.
    none: Lanes,
}

impl Reach {
    /// For so many runs.
    pub fn new(lanes: usize) -> Self {
        Self {
            centre: vec![],
            half: vec![],
            base: vec![],
            least: vec![],
            weights: vec![],
            modes: [None; LANES],
            from: vec![],
            moved: vec![],
            size: vec![],
            since: LEAST_WORTH,
            waits: 0,
            asked: (u64::MAX, false),
            none: Lanes(std::array::from_fn(|lane| if lane < lanes { -1.0 } else { f64::INFINITY })),
        }
    }

    /// Whether every run may step inside.
    #[inline]
    pub fn is_open(&self, terms: usize) -> bool {
        let has_all = |half: &Lanes| half.iter().all(|half| *half >= 0.0);
        self.half.len() == terms && self.half.first().is_some_and(has_all)
    }

    /// Inputs are others now.
    pub fn start_over(&mut self) {
        self.half.fill(self.none);
        self.modes = [None; LANES];
    }

    /// A run no longer may.
    pub fn forget(&mut self, lane: usize) {
        let none = self.none[lane];
        self.half.iter_mut().for_each(|half| half[lane] = none);
    }

    pub fn count(&mut self, steps: usize) {
        self.since = self.since.saturating_add(steps as u32);
    }

    /// At a step that is not taken inside: whether new boxes are worth while.
    fn is_due(&mut self, step: u64) -> bool {
        if self.asked.0 != step {
            if self.waits > 0 {
                self.waits -= 1;
            } else if self.since < LEAST_WORTH {
                self.waits = WAIT;
            }
            let is_due = self.waits == 0;
            self.since = if is_due { 0 } else { self.since + 1 };
            self.asked = (step, is_due);
        }
        self.asked.1
    }

    /// Makes the runs of `alike` ready, all in the mode of `packed`, if that is worth while: at speeds and inputs at which every
    /// margin holds. Given are the parts of level inputs and the round-off of all rows, too.
    #[inline(always)]
    pub fn open<S: pulp::Simd>(
        &mut self,
        simd: S,
        (mode, packed): (usize, &Packed),
        [v, entering]: [&[Lanes]; 2],
        [base, least]: [&[Lanes]; 2],
        step: u64,
        alike: Mask,
    ) {
        let is_small = packed.is_small();
        let alike_lanes = (0..LANES).filter(|lane| alike >> lane & 1 == 1);
        if is_small {
            if alike_lanes.clone().all(|lane| self.half.first().is_some_and(|half| half[lane] >= 0.0)) {
                return;
            }
        } else if !self.is_due(step) {
            return alike_lanes.for_each(|lane| self.forget(lane));
        }
        let terms = v.len() + entering.len();
        self.half.resize(terms, self.none);
        for of_terms in [&mut self.centre, &mut self.from, &mut self.moved, &mut self.size] {
            of_terms.resize(terms, Lanes::of(0.0));
        }
        // Rows that only others have ask nothing.
        let rows = if is_small { packed.rows } else { packed.of_speeds() };
        let nothing = [Lanes::of(0.0), Lanes::of(f64::NEG_INFINITY)];
        for ((own, all), nothing) in [&mut self.base, &mut self.least].into_iter().zip([base, least]).zip(nothing) {
            own.resize(own.len().max(rows), nothing);
            let all = all[..rows].iter().chain(std::iter::repeat(&nothing));
            own.iter_mut().zip(all).for_each(|(own, all)| write(own, all, alike));
        }
        self.weights.resize(self.base.len() * terms, Lanes::of(0.0));
        let others = alike_lanes.filter(|&lane| self.modes[lane].replace(mode) != Some(mode));
        let others = others.fold(0, |others, lane| others | 1 << lane);
        if others != 0 {
            let weights = packed.weights[..rows * terms].iter().chain(std::iter::repeat(&0.0));
            self.weights.iter_mut().zip(weights).for_each(|(own, weight)| write(own, &Lanes::of(*weight), others));
        }
        if is_small {
            self.half.iter_mut().for_each(|half| write(half, &Lanes::of(f64::INFINITY), alike));
        } else {
            self.lay(simd, packed, [v, entering], base, alike);
        }
    }

    /// Lays boxes in which every margin holds.
    #[inline(always)]
    fn lay<S: pulp::Simd>(
        &mut self,
        simd: S,
        packed: &Packed,
        [v, entering]: [&[Lanes]; 2],
        base: &[Lanes],
        alike: Mask,
    ) {
        let terms = v.len() + entering.len();
        let x = || v.iter().chain(entering);
        for (((x, from), moved), size) in x().zip(&self.from).zip(&mut self.moved).zip(&mut self.size) {
            for k in 0..LANES {
                moved[k] = x[k] - from[k];
                // What does not move does so by round-off.
                size[k] = moved[k].abs() + 1e-9 * x[k].abs() + f64::MIN_POSITIVE;
            }
        }
        let mut most = Lanes::of(1e9);
        let all = |x: f64| simd.splat_f64s(x);
        let add = |sum, w: f64, x| simd.add_f64s(sum, simd.mul_f64s(all(w), x));
        for part in 0..Lanes::parts(simd, LANES) {
            let mut least = most.part(simd, part);
            let margins = (packed.of_speeds()..packed.checked).zip(packed.spans.chunks_exact(terms.max(1)));
            for (row, spans) in margins {
                let (mut margin, mut change, mut noise) = (base[row].part(simd, part), all(0.0), all(0.0));
                let moves = self.moved.iter().zip(&self.size);
                for (((w, span), x), (moved, size)) in
                    weights_of(&packed.weights, row, terms).zip(spans).zip(x()).zip(moves)
                {
                    let x = x.part(simd, part);
                    margin = add(margin, *w, x);
                    noise = add(noise, w.abs(), simd.abs_f64s(x));
                    change = add(change, span.abs(), size.part(simd, part));
                    change = add(change, -AHEAD * span, moved.part(simd, part));
                }
                // A margin that nothing changes holds as it does. Of one that is no more than round-off nobody knows.
                let sure = simd.mul_f64s(all(SAFE), add(margin, -NOISE, noise));
                let ahead = simd.div_f64s(sure, change);
                let nearer = simd.select_f64s(simd.less_than_f64s(ahead, least), ahead, least);
                least = simd.select_f64s(simd.greater_than_f64s(change, all(0.0)), nearer, least);
            }
            most.set_part(simd, part, simd.max_f64s(least, all(0.0)));
        }
        let moves = self.moved.iter().zip(&self.size);
        let boxes = self.centre.iter_mut().zip(&mut self.half).zip(&mut self.from);
        for ((x, (moved, size)), ((centre, half), from)) in x().zip(moves).zip(boxes) {
            let (mut middle, mut long) = (*x, Lanes::of(0.0));
            for k in 0..LANES {
                middle[k] += AHEAD * most[k] * moved[k];
                long[k] = most[k] * size[k];
            }
            write(centre, &middle, alike);
            write(half, &long, alike);
            write(from, x, alike);
        }
    }
}
