//! Many runs of one scenario side by side, for sweeps and Monte Carlo.
//!
//! Runs that are in the same mode share the affine map of its step ([`super::fused`]), so that a block of them is stepped by
//! vector instructions. A run that leaves its mode takes that one step alone.

mod block;
mod cruise;
mod lanes;
mod law;
mod reach;

use crate::arch::Arch;
use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::train::{SourceKind, Train};

use super::fixed::FixedStep;
use super::fused::BLOCK;
use super::mode::dot;
use super::report::Outcome;
use block::{Block, Room};
use lanes::{LANES, Lanes, Mask, add_terms, breaks, mask, turns, write};
use law::{Law, followed, may_cruise};
use reach::{Packed, Reach};

/// Steps that a block takes before the next block takes as many: what it works on stays near.
const STRETCH: u64 = 64;

fn wrong(message: String) -> Diagnostics {
    Diagnostic::new(Code::UnknownName, "", message).into()
}

/// Several runs of a scenario in steps of fixed length, which differ in initial speeds and in the size of torques.
///
/// # Example
/// ```
/// use willis::dynamics::Batch;
/// use willis::train::Train;
///
/// let train = Train::from_toml(r#"
///     format = 1
///     name = "a rotor coasts"
///     members = ["rotor"]
///     inertias = { rotor = "2 kg m^2" }
///
///     [[drag]]
///     name = "bearing"
///     members = ["rotor"]
///     coulomb = "4 N m"
///
///     [[scenario]]
///     name = "coast"
///     duration = "10 s"
///     initial_speeds = { rotor = "12 rad/s" }
/// "#)?;
/// let mut runs = Batch::new(&train, "coast", 1e-3, 20)?;
/// for k in 0..runs.len() {
///     runs.scale(k, "bearing", 1.0 + 0.1 * k as f64)?;
/// }
/// runs.run(3000);
/// assert!((runs.speed(0, "rotor").unwrap() - 6.0).abs() < 1e-9);
/// assert!((runs.speed(10, "rotor").unwrap() - 0.0).abs() < 1e-9);
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub struct Batch {
    /// Steps what does not go on with its block; holds the modes met so far.
    one: FixedStep,
    blocks: Vec<Block>,
    len: usize,
    arch: Arch,
    /// Inputs that are not level, step by step, where all runs have the same.
    common: Vec<Option<f64>>,
    /// Steps of modes as blocks take them, in the order of the modes met, once one does.
    packed: Vec<Option<Packed>>,
    room: Room,
    impacts: u64,
}

impl Batch {
    /// Prepares as many equal runs of a scenario, with steps of `h`, s.
    ///
    /// # Errors
    /// As [`FixedStep::new`].
    pub fn new(train: &Train, scenario: &str, h: f64, runs: usize) -> Result<Self, Diagnostics> {
        let mut one = FixedStep::new(train, scenario, h)?;
        one.without_angles();
        let spread = |x: &[f64]| x.iter().map(|x| Lanes::of(*x)).collect::<Vec<Lanes>>();
        let block = |lanes: usize| Block {
            v: spread(&one.v),
            rest: spread(&one.rest),
            inputs: spread(&one.inputs),
            factors: vec![Lanes::of(1.0); one.inputs.len()],
            base: vec![],
            least: vec![],
            reach: Reach::new(lanes),
            sign: one.sign.repeat(LANES),
            side: one.side.repeat(LANES),
            touch: one.shafts.iter().map(|shaft| shaft.touch).collect::<Vec<_>>().repeat(LANES),
            present: [None; LANES],
            uniform: true,
            // Places without a run have no bound to grow beyond.
            bound: Lanes(std::array::from_fn(|lane| if lane < lanes { 0.0 } else { f64::INFINITY })),
            turns: [0; LANES],
            verdict: Default::default(),
            ended: 0,
        };
        Ok(Self {
            blocks: (0..runs.div_ceil(LANES)).map(|b| block((runs - b * LANES).min(LANES))).collect(),
            len: runs,
            arch: Arch::new(),
            common: vec![],
            packed: vec![],
            room: Room::default(),
            impacts: 0,
            one,
        })
    }

    /// Number of runs.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Time reached, s.
    pub fn time(&self) -> f64 {
        self.one.time()
    }

    /// Speed of a member in a run, rad/s.
    pub fn speed(&self, run: usize, member: &str) -> Option<f64> {
        let s = &self.one.engine.system;
        let row = &s.speeds[s.train.member(member)?.index()];
        let block = self.blocks.get(run / LANES).filter(|_| run < self.len)?;
        let v: Vec<f64> = block.v.iter().map(|v| v[run % LANES]).collect();
        Some(dot(row, &v))
    }

    /// Sets the speed of a free coordinate of a run, rad/s.
    ///
    /// # Errors
    /// If the member is no free coordinate: its speed follows from others or is prescribed.
    pub fn set_speed(&mut self, run: usize, member: &str, speed: f64) -> Result<(), Diagnostics> {
        let s = &self.one.engine.system;
        let names: Vec<&str> = s.coordinates[..s.free].iter().map(|m| s.train.member_name(*m)).collect();
        let Some(k) = names.iter().position(|n| *n == member) else {
            return Err(wrong(format!("`{member}` is no free coordinate; those are: {}", names.join(", "))));
        };
        let block = self.block(run, speed)?;
        block.v[k][run % LANES] = speed;
        block.forget(run % LANES);
        Ok(())
    }

    /// Multiplies the torque of a source (of a vehicle all but its rolling resistance), or the friction of a drag or a
    /// shift element (not the viscous part), in a run.
    ///
    /// # Errors
    /// If there is no such source, drag or shift element; if it prescribes a speed, controls one, or is a one-way clutch;
    /// if the factor of a friction is negative.
    pub fn scale(&mut self, run: usize, name: &str, factor: f64) -> Result<(), Diagnostics> {
        let s = &self.one.engine.system;
        let drivers = s.drivers.len();
        let source = s.scenario.sources.iter().position(|x| x.name == name);
        let friction = || s.frictions.iter().position(|f| f.name == name && f.group.is_some()).map(|k| drivers + k);
        let Some(k) = source.or_else(friction) else {
            let sources = s.scenario.sources.iter().map(|x| x.name.as_str());
            let frictions = s.frictions.iter().filter(|f| f.group.is_some()).map(|f| f.name.as_str());
            let known: Vec<&str> = sources.chain(frictions).collect();
            return Err(wrong(format!("there is no source or friction `{name}`; there are: {}", known.join(", "))));
        };
        let refused = match s.scenario.sources.get(k).map(|source| &source.kind) {
            Some(SourceKind::Speed(_)) => Some("a prescribed speed"),
            Some(SourceKind::Controller { .. }) => Some("a controller"),
            Some(_) => None,
            None if s.frictions[k - drivers].blocks.is_some() => Some("a one-way clutch"),
            None if factor < 0.0 => {
                return Err(wrong(format!("the friction of `{name}` cannot be multiplied by {factor}")));
            }
            None => None,
        };
        if let Some(what) = refused {
            return Err(wrong(format!("`{name}` is {what}, which has no size to multiply")));
        }
        let block = self.block(run, factor)?;
        block.factors[k][run % LANES] = factor;
        block.forget(run % LANES);
        Ok(())
    }

    fn block(&mut self, run: usize, value: f64) -> Result<&mut Block, Diagnostics> {
        if !value.is_finite() {
            return Err(wrong(format!("a finite number is needed, not {value}")));
        }
        match self.blocks.get_mut(run / LANES) {
            Some(block) if run < self.len => Ok(block),
            _ => Err(wrong(format!("there is no run {run}; there are {}", self.len))),
        }
    }

    /// Steps, over all runs, in which parts of different speed were joined at once, as in an inelastic impact.
    pub fn impacts(&self) -> u64 {
        self.impacts
    }

    /// Why a run cannot go on: it stays at the last state that can be believed, while the others go on.
    pub fn verdict(&self, run: usize) -> Option<&Outcome> {
        self.blocks.get(run / LANES)?.verdict[run % LANES].as_ref()
    }

    /// Takes steps.
    pub fn run(&mut self, steps: u64) {
        let mut left = steps;
        while left > 0 {
            left -= self.stretch(left.min(STRETCH));
        }
    }

    /// Takes as many steps, or those up to where an input begins to change or ceases to; how many.
    fn stretch(&mut self, most: u64) -> u64 {
        let Self { one, blocks, common, .. } = self;
        let first = one.count;
        if one.is_over(one.middle()) {
            let (ended, middle) = (one.until, one.middle());
            one.refresh(middle);
            one.count_jumps(ended, middle);
            self.impacts += std::mem::take(&mut one.impacts) * self.len as u64;
            self.packed.clear();
            for block in blocks.iter_mut() {
                block.present = [None; LANES];
                block.uniform = true;
                block.reach.start_over();
            }
        }
        common.clear();
        let mut steps = 0;
        while steps < most && !(steps > 0 && one.is_over(one.middle())) {
            let middle = one.middle();
            common.extend(one.varying.iter().map(|&k| (!one.depends_on_speed(k)).then(|| one.enters(k, middle))));
            one.count += 1;
            steps += 1;
        }
        for (b, block) in blocks.iter_mut().enumerate() {
            one.count = first;
            self.arch.dispatch(Stretch {
                block,
                lanes: (self.len - b * LANES).min(LANES),
                one,
                steps,
                common,
                packed: &mut self.packed,
                room: &mut self.room,
                impacts: &mut self.impacts,
            });
        }
        one.count = first + steps;
        steps
    }
}

impl Block {
    fn forget(&mut self, lane: usize) {
        self.present[lane] = None;
        self.uniform = false;
        self.reach.forget(lane);
    }

    /// Runs in a mode, as bits.
    fn alike(&self, mode: Option<u32>) -> Mask {
        self.present.iter().enumerate().map(|(lane, p)| Mask::from(*p == mode) << lane).sum()
    }

    /// An input that differs between runs, but for its factor.
    #[inline(always)]
    fn inputs_at<S: pulp::Simd>(&self, simd: S, one: &mut FixedStep, k: usize, middle: f64) -> Lanes {
        if let Some(law) = Law::of(one, k) {
            return law.at(simd, &self.v);
        }
        let w = followed(simd, one.row_of_input(k), &self.v);
        let integral = one.integral_of(k).map(|i| *self.rest[i]).unwrap_or_default();
        let needs_all = one.needs_all_speeds(k);
        Lanes(std::array::from_fn(|lane| {
            if needs_all {
                copy_lane(&self.v, lane, &mut one.v);
            }
            one.input_at(k, middle, w[lane], integral[lane])
        }))
    }

    /// Takes the step of the runs of a mask one after the other; impacts met.
    #[cold]
    #[inline(never)]
    fn step_each(&mut self, one: &mut FixedStep, mask: Mask, lanes: usize) -> u64 {
        let (count, mut impacts) = (one.count, 0);
        for lane in (0..lanes).filter(|lane| mask >> lane & 1 == 1) {
            self.step_alone(one, lane);
            impacts += std::mem::take(&mut one.impacts);
            one.count = count;
        }
        self.uniform = self.present[..lanes].iter().all(|p| *p == self.present[0]) && self.ended == 0;
        impacts
    }

    /// Takes the step of one run.
    fn step_alone(&mut self, one: &mut FixedStep, lane: usize) {
        copy_lane(&self.v, lane, &mut one.v);
        copy_lane(&self.rest, lane, &mut one.rest);
        copy_lane(&self.inputs, lane, &mut one.inputs);
        copy_lane(&self.factors, lane, &mut one.factors);
        let (groups, elements) = (one.sign.len(), one.side.len());
        one.sign.copy_from_slice(&self.sign[lane * groups..(lane + 1) * groups]);
        one.side.copy_from_slice(&self.side[lane * elements..(lane + 1) * elements]);
        let touch = self.touch.chunks_exact(one.shafts.len().max(1)).nth(lane).unwrap_or_default();
        one.shafts.iter_mut().zip(touch).for_each(|(shaft, touch)| shaft.touch = *touch);
        one.present = None;
        // Each goes on in its own mode if it can, as a single run does.
        if let Some(k) = self.present[lane] {
            let rows = one.fused[k as usize].rows;
            for (from, to) in [(&self.base, &mut one.base), (&self.least, &mut one.least), (&self.least, &mut one.ends)]
            {
                to.resize(rows, 0.0);
                copy_lane(from, lane, to);
            }
            one.present = Some(k);
        }
        (one.bound, one.turns) = (self.bound[lane], self.turns[lane]);
        let settled = one.settled;
        one.step();
        if one.settled != settled {
            self.reach.forget(lane);
        }
        (self.bound[lane], self.turns[lane], self.verdict[lane]) = (one.bound, one.turns, one.verdict.take());
        self.ended |= Mask::from(self.verdict[lane].is_some()) << lane;
        paste_lane(&one.v, lane, &mut self.v);
        paste_lane(&one.rest, lane, &mut self.rest);
        paste_lane(&one.inputs, lane, &mut self.inputs);
        self.sign[lane * groups..(lane + 1) * groups].copy_from_slice(&one.sign);
        self.side[lane * elements..(lane + 1) * elements].copy_from_slice(&one.side);
        let touch = self.touch.chunks_exact_mut(one.shafts.len().max(1)).nth(lane).unwrap_or_default();
        touch.iter_mut().zip(&one.shafts).for_each(|(touch, shaft)| *touch = shaft.touch);
        self.present[lane] = one.present;
        if one.present.is_some() {
            for (from, to) in [(&one.base, &mut self.base), (&one.least, &mut self.least)] {
                if to.len() < from.len() {
                    to.resize(from.len(), Lanes::of(0.0));
                }
                paste_lane(from, lane, to);
            }
        }
        one.factors.fill(1.0);
    }
}

fn copy_lane(from: &[Lanes], lane: usize, to: &mut [f64]) {
    to.iter_mut().zip(from).for_each(|(to, from)| *to = from[lane]);
}

fn paste_lane(from: &[f64], lane: usize, to: &mut [Lanes]) {
    to.iter_mut().zip(from).for_each(|(to, from)| to[lane] = *from);
}

/// What runs in one mode share in a step.
#[derive(Clone, Copy)]
struct Shared<'a> {
    mode: usize,
    packed: &'a Packed,
    common: &'a [Option<f64>],
    /// Whether blocks may cruise at all.
    cruises: bool,
}

/// Some steps of a block.
struct Stretch<'a> {
    block: &'a mut Block,
    /// Runs in it.
    lanes: usize,
    one: &'a mut FixedStep,
    steps: u64,
    common: &'a [Option<f64>],
    packed: &'a mut Vec<Option<Packed>>,
    room: &'a mut Room,
    impacts: &'a mut u64,
}

impl pulp::WithSimd for Stretch<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, simd: S) {
        let Self { block, lanes, one, steps, common, packed, room, impacts } = self;
        let all = ((1u32 << lanes) - 1) as Mask;
        // The torque of a shaft follows from its twist, which only a single run knows.
        let needs_itself = one.needs_itself();
        let varying = one.varying.len();
        let cruises = !needs_itself && may_cruise(one, common);
        let (mut step, steps) = (0, steps as usize);
        while step < steps {
            if cruises && block.ended == 0 {
                step += block.cruise(simd, one, common, step..steps, all, room);
                if step == steps {
                    break;
                }
            }
            let common = &common[step * varying..(step + 1) * varying];
            // Those in the same mode go together; those that leave it, alone.
            let mut left = all & !block.ended;
            let mut alone = 0;
            while left != 0 {
                let present = block.present[left.trailing_zeros() as usize];
                let alike = if block.uniform { left } else { left & block.alike(present) };
                alone |= match present {
                    Some(k) if !needs_itself => {
                        let at = k as usize;
                        if packed.len() <= at {
                            packed.resize_with(at + 1, || None);
                        }
                        let packed = packed[at].get_or_insert_with(|| Packed::of(one, at, cruises));
                        block.glide(simd, one, Shared { mode: at, packed, common, cruises }, alike, room)
                    }
                    _ => alike,
                };
                left &= !alike;
            }
            if alone != 0 {
                *impacts += block.step_each(one, alone, lanes);
            }
            one.count += 1;
            step += 1;
        }
    }
}

impl Block {
    /// The step of the runs of `alike` in the mode they share; gives those that do not go on in it, and have not moved.
    #[inline(always)]
    fn glide<S: pulp::Simd>(
        &mut self,
        simd: S,
        one: &mut FixedStep,
        shared: Shared<'_>,
        alike: Mask,
        room: &mut Room,
    ) -> Mask {
        let Shared { mode, packed, common, cruises } = shared;
        let middle = one.middle();
        let s = &one.engine.system;
        let (drivers, frictions) = (s.drivers.len(), s.frictions.len());
        let mut alone = 0;
        let Room { entering, ends, .. } = room;
        entering.clear();
        for (at, common) in common.iter().enumerate() {
            let k = one.varying[at];
            let mut u = self.factors[k];
            match common {
                Some(value) => u.iter_mut().for_each(|u| *u *= value),
                None => {
                    let own = self.inputs_at(simd, one, k, middle);
                    u.iter_mut().zip(*own).for_each(|(u, own)| *u *= own);
                }
            }
            // What opens, closes or locks is more than a change of torque: such a run sees it by what it had before.
            let turned = if k >= drivers && k < drivers + frictions { turns(&u, &self.inputs[k]) } else { 0 };
            alone |= turned;
            write(&mut self.inputs[k], &u, alike & !turned);
            entering.push(u);
        }
        let fused = &one.fused[mode];
        let (rows, free) = (fused.rows, fused.free);
        ends.resize(free.next_multiple_of(BLOCK), Lanes::of(0.0));
        let settled = [&self.base[..rows], &self.least[..rows]];
        let margins = product(simd, &packed.weights, [&self.v, entering], settled, ends, free);
        // As a single run looks at its growth; what is no number counts as grown.
        let mut square = Lanes::of(0.0);
        let mut add = |of: &Lanes| {
            for (sum, x) in S::as_mut_simd_f64s(&mut square.0).0.iter_mut().zip(S::as_simd_f64s(&of.0).0) {
                *sum = simd.add_f64s(*sum, simd.mul_f64s(*x, *x));
            }
        };
        ends[..free].iter().for_each(&mut add);
        let s = &one.engine.system;
        if s.prescribed > 0 {
            let prescribed = s.drivers.iter().zip(&self.inputs).filter(|(driver, _)| driver.prescribed.is_some());
            prescribed.for_each(|(_, u)| add(u));
        }
        if breaks(simd, &margins, &square, &self.bound) {
            alone |= mask(|lane| (margins[lane] < 0.0) | (square[lane] > self.bound[lane]) | square[lane].is_nan());
        }
        alone &= alike;
        if cruises && alone == 0 && self.ended == 0 {
            self.reach.open(simd, (mode, packed), [&self.v, entering], settled, one.count, alike);
        }
        let going = alike & !alone;
        self.v[..free].iter_mut().zip(ends.iter()).for_each(|(v, end)| write(v, end, going));
        if s.prescribed > 0 {
            for (driver, u) in s.drivers.iter().zip(&self.inputs) {
                if let Some(i) = driver.prescribed {
                    write(&mut self.v[free + i], u, going);
                }
            }
        }
        if s.integrals > 0 {
            for (driver, source) in s.drivers.iter().zip(&s.scenario.sources) {
                if let (Some(i), SourceKind::Controller { setpoint, .. }) = (driver.integral, &source.kind) {
                    let set = setpoint.value(middle, middle, &|_| 0.0);
                    let w = followed(simd, &s.speeds[driver.member.index()], &self.v);
                    let mut sum = self.rest[s.all() + i];
                    sum.iter_mut().zip(*w).for_each(|(sum, w)| *sum += one.h * (set - w));
                    write(&mut self.rest[s.all() + i], &sum, going);
                }
            }
        }
        alone
    }
}

/// The product of a fused step with speeds and inputs of a block. Kept are the speeds it ends with, as many as are free; told
/// is the least margin of each run.
#[inline(always)]
fn product<S: pulp::Simd>(
    simd: S,
    packed: &[f64],
    [v, entering]: [&[Lanes]; 2],
    [base, least]: [&[Lanes]; 2],
    ends: &mut [Lanes],
    free: usize,
) -> Lanes {
    let terms = v.len() + entering.len();
    let mut least_margins = Lanes::of(f64::INFINITY);
    let (worst, _) = S::as_mut_simd_f64s(&mut least_margins.0);
    for (part, worst) in worst.iter_mut().enumerate() {
        let of = |x: &Lanes| S::as_simd_f64s(&x.0).0[part];
        let mut margin = *worst;
        let rows = base.as_chunks::<BLOCK>().0.iter().zip(least.as_chunks::<BLOCK>().0);
        for (at, ((base, least), weights)) in rows.zip(packed.chunks_exact(BLOCK * terms)).enumerate() {
            let mut sums = [0, 1, 2, 3].map(|k| of(&base[k]));
            let (of_speeds, of_inputs) = weights.as_chunks().0.split_at(v.len());
            add_terms(simd, &mut sums, of_speeds, v, part);
            add_terms(simd, &mut sums, of_inputs, entering, part);
            let [a, b, c, d] = [0, 1, 2, 3].map(|k| simd.sub_f64s(sums[k], of(&least[k])));
            margin = simd.min_f64s(margin, simd.min_f64s(simd.min_f64s(a, b), simd.min_f64s(c, d)));
            if at * BLOCK < free {
                for k in 0..BLOCK {
                    S::as_mut_simd_f64s(&mut ends[at * BLOCK + k].0).0[part] = sums[k];
                }
            }
        }
        *worst = margin;
    }
    least_margins
}
