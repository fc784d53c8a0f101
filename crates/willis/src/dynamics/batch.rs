//! Many runs of one scenario side by side, for sweeps and Monte Carlo.
//!
//! Runs that are in the same mode share the affine map of its step ([`super::fused`]), so that a block of them is stepped by
//! vector instructions. A run that leaves its mode takes that one step alone.

use crate::diagnostic::Diagnostics;
use crate::train::{SourceKind, Train};

use super::fixed::{FixedStep, UNBOUNDED};
use super::fused::Fused;
use super::mode::{Side, dot};

/// Runs in a block.
const LANES: usize = 8;

type Lanes = [f64; LANES];

/// Runs that are stepped together.
struct Block {
    /// Speeds of the coordinates, and angles with integrals.
    v: Vec<Lanes>,
    rest: Vec<Lanes>,
    /// The speeds before the step.
    before: Vec<Lanes>,
    /// What enters a step, and by what that is multiplied.
    inputs: Vec<Lanes>,
    factors: Vec<Lanes>,
    /// Of the present mode: the part of level inputs, and the round-off of each row.
    base: Vec<Lanes>,
    least: Vec<Lanes>,
    /// Modes of the runs one after another.
    sign: Vec<i8>,
    side: Vec<Side>,
    present: [Option<u32>; LANES],
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
///     runs.scale(k, "bearing", 1.0 + 0.1 * k as f64).unwrap();
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
    arch: pulp::Arch,
    /// Room for the ends of a step.
    ends: Vec<Lanes>,
    /// Inputs that are not level, and their values where all runs have the same.
    common: Vec<Option<f64>>,
    unsettled: u64,
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
        let spread = |x: &[f64]| x.iter().map(|x| [*x; LANES]).collect::<Vec<Lanes>>();
        let block = || Block {
            v: spread(&one.v),
            rest: spread(&one.rest),
            before: spread(&one.v),
            inputs: spread(&one.inputs),
            factors: vec![[1.0; LANES]; one.inputs.len()],
            base: vec![],
            least: vec![],
            sign: one.sign.repeat(LANES),
            side: one.side.repeat(LANES),
            present: [None; LANES],
        };
        Ok(Self {
            blocks: (0..runs.div_ceil(LANES)).map(|_| block()).collect(),
            len: runs,
            arch: pulp::Arch::new(),
            ends: vec![],
            common: vec![],
            unsettled: 0,
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
    pub fn set_speed(&mut self, run: usize, member: &str, speed: f64) -> Result<(), String> {
        let s = &self.one.engine.system;
        let names: Vec<&str> = s.coordinates[..s.free].iter().map(|m| s.train.member_name(*m)).collect();
        let Some(k) = names.iter().position(|n| *n == member) else {
            return Err(format!("`{member}` is no free coordinate; those are: {}", names.join(", ")));
        };
        let block = self.block(run, speed)?;
        block.v[k][run % LANES] = speed;
        block.forget(run % LANES);
        Ok(())
    }

    /// Multiplies what a source does, or the friction of a drag or a shift element, in a run.
    ///
    /// # Errors
    /// If there is no such source, drag or shift element.
    pub fn scale(&mut self, run: usize, name: &str, factor: f64) -> Result<(), String> {
        let s = &self.one.engine.system;
        let drivers = s.drivers.len();
        let source = s.scenario.sources.iter().position(|x| x.name == name);
        let friction = || s.frictions.iter().position(|f| f.name == name && f.group.is_some()).map(|k| drivers + k);
        let Some(k) = source.or_else(friction) else {
            let sources = s.scenario.sources.iter().map(|x| x.name.as_str());
            let frictions = s.frictions.iter().filter(|f| f.group.is_some()).map(|f| f.name.as_str());
            let known: Vec<&str> = sources.chain(frictions).collect();
            return Err(format!("there is no source or friction `{name}`; there are: {}", known.join(", ")));
        };
        let block = self.block(run, factor)?;
        block.factors[k][run % LANES] = factor;
        block.forget(run % LANES);
        Ok(())
    }

    fn block(&mut self, run: usize, value: f64) -> Result<&mut Block, String> {
        if !value.is_finite() {
            return Err(format!("a finite number is needed, not {value}"));
        }
        match self.blocks.get_mut(run / LANES) {
            Some(block) if run < self.len => Ok(block),
            _ => Err(format!("there is no run {run}; there are {}", self.len)),
        }
    }

    /// Steps, over all runs, whose mode was not settled within the bounded number of trials.
    pub fn unsettled_steps(&self) -> u64 {
        self.unsettled
    }

    /// Takes steps.
    pub fn run(&mut self, steps: u64) {
        for _ in 0..steps {
            self.step();
        }
    }

    fn step(&mut self) {
        let middle = self.one.middle();
        if self.one.is_over(middle) {
            self.one.refresh(middle);
            for block in &mut self.blocks {
                block.present = [None; LANES];
            }
        }
        let one = &mut self.one;
        self.common.clear();
        for &k in &one.varying {
            self.common.push((!one.depends_on_speed(k)).then(|| one.input(k, middle)));
        }
        let count = one.count;
        // The torque of a shaft follows from its twist, which only a single run knows.
        let twists = !one.engine.system.elastic.is_empty();
        for (b, block) in self.blocks.iter_mut().enumerate() {
            let lanes = (self.len - b * LANES).min(LANES);
            block.before.copy_from_slice(&block.v);
            // Those in the same mode go together; those that leave it, alone.
            let mut left = (1u32 << lanes) - 1;
            let mut alone = 0;
            while left != 0 {
                let present = block.present[left.trailing_zeros() as usize];
                let alike =
                    (0..lanes).filter(|lane| block.present[*lane] == present).map(|lane| 1 << lane).sum::<u32>();
                alone |= match present {
                    Some(k) if !twists => {
                        block.glide(one, k, alike & left, middle, &self.common, self.arch, &mut self.ends)
                    }
                    _ => alike & left,
                };
                left &= !alike;
            }
            for lane in (0..lanes).filter(|lane| alone >> lane & 1 == 1) {
                block.step_alone(one, lane);
                self.unsettled += std::mem::take(&mut one.unsettled);
                self.impacts += std::mem::take(&mut one.impacts);
                one.count = count;
            }
        }
        one.count = count + 1;
    }
}

impl Block {
    fn forget(&mut self, lane: usize) {
        self.present[lane] = None;
    }

    /// Steps the runs of `alike` in the mode they share; bits of those that do not go on in it, and have not moved.
    #[allow(clippy::too_many_arguments)]
    fn glide(
        &mut self,
        one: &mut FixedStep,
        k: u32,
        alike: u32,
        middle: f64,
        common: &[Option<f64>],
        arch: pulp::Arch,
        ends: &mut Vec<Lanes>,
    ) -> u32 {
        let (drivers, frictions) = {
            let s = &one.engine.system;
            (s.drivers.len(), s.frictions.len())
        };
        let mut alone = 0;
        let varying = std::mem::take(&mut one.varying);
        for (&k, common) in varying.iter().zip(common) {
            let mut u = self.factors[k];
            match common {
                Some(value) => u.iter_mut().for_each(|u| *u *= value),
                None => {
                    let mut w = [0.0; LANES];
                    for (x, v) in one.row_of_input(k).iter().zip(&self.before) {
                        (0..LANES).for_each(|lane| w[lane] += x * v[lane]);
                    }
                    for (lane, u) in u.iter_mut().enumerate() {
                        if one.needs_all_speeds(k) {
                            copy_lane(&self.before, lane, &mut one.v);
                        }
                        let sum = one.integral_of(k).map_or(0.0, |i| self.rest[i][lane]);
                        *u *= one.input_at(k, middle, w[lane], sum);
                    }
                }
            }
            // What opens, closes or locks is more than a change of torque.
            if k >= drivers && k < drivers + frictions {
                for (lane, (u, was)) in u.iter().zip(&self.inputs[k]).enumerate() {
                    if (*u == 0.0) != (*was == 0.0) || (*u == UNBOUNDED) != (*was == UNBOUNDED) {
                        alone |= 1 << lane;
                    }
                }
            }
            for lane in (0..LANES).filter(|lane| alike >> lane & 1 == 1) {
                self.inputs[k][lane] = u[lane];
            }
        }
        one.varying = varying;
        let fused = &one.fused[k as usize];
        ends.resize(fused.rows, [0.0; LANES]);
        let glide = Glide {
            fused,
            v: &self.before,
            inputs: &self.inputs,
            varying: &one.varying,
            base: &self.base,
            least: &self.least,
            ends,
        };
        alone |= arch.dispatch(glide);
        alone &= alike;
        let going = alike & !alone;
        let free = fused.free;
        let moved = |v: &mut Lanes, end: &Lanes| {
            for lane in 0..LANES {
                v[lane] = if going >> lane & 1 == 1 { end[lane] } else { v[lane] };
            }
        };
        self.v.iter_mut().zip(ends.iter()).take(free).for_each(|(v, end)| moved(v, end));
        for (driver, u) in one.engine.system.drivers.iter().zip(&self.inputs) {
            if let Some(i) = driver.prescribed {
                moved(&mut self.v[free + i], u);
            }
        }
        if one.engine.system.integrals > 0 {
            let s = &one.engine.system;
            for (driver, source) in s.drivers.iter().zip(&s.scenario.sources) {
                if let (Some(i), SourceKind::Controller { setpoint, .. }) = (driver.integral, &source.kind) {
                    let set = setpoint.value(middle, middle, &|_| 0.0);
                    let row = &s.speeds[driver.member.index()];
                    for lane in (0..LANES).filter(|lane| going >> lane & 1 == 1) {
                        let w: f64 = row.iter().zip(&self.v).map(|(r, v)| r * v[lane]).sum();
                        self.rest[s.all() + i][lane] += one.h * (set - w);
                    }
                }
            }
        }
        alone
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
        one.present = None;
        one.step();
        paste_lane(&one.v, lane, &mut self.v);
        paste_lane(&one.rest, lane, &mut self.rest);
        paste_lane(&one.inputs, lane, &mut self.inputs);
        self.sign[lane * groups..(lane + 1) * groups].copy_from_slice(&one.sign);
        self.side[lane * elements..(lane + 1) * elements].copy_from_slice(&one.side);
        self.present[lane] = one.present;
        if one.present.is_some() {
            for (from, to) in [(&one.base, &mut self.base), (&one.least, &mut self.least)] {
                if to.len() < from.len() {
                    to.resize(from.len(), [0.0; LANES]);
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

/// The product of a fused step with the states of a block, and which runs break a margin.
struct Glide<'a> {
    fused: &'a Fused,
    v: &'a [Lanes],
    inputs: &'a [Lanes],
    varying: &'a [usize],
    base: &'a [Lanes],
    least: &'a [Lanes],
    ends: &'a mut [Lanes],
}

impl pulp::WithSimd for Glide<'_> {
    type Output = u32;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, simd: S) -> u32 {
        let Self { fused, v, inputs, varying, base, least, ends } = self;
        let rows = fused.rows;
        let mut worst = [f64::INFINITY; LANES];
        let (worst_parts, _) = S::as_mut_simd_f64s(&mut worst);
        for (part, worst) in worst_parts.iter_mut().enumerate() {
            let of = |x: &Lanes| S::as_simd_f64s(x).0[part];
            for row in 0..rows {
                let mut sum = of(&base[row]);
                let mut add = |k: usize, x: &Lanes| {
                    let weight = simd.splat_f64s(fused.column(k)[row]);
                    sum = simd.add_f64s(sum, simd.mul_f64s(weight, of(x)));
                };
                v.iter().enumerate().for_each(|(k, x)| add(k, x));
                varying.iter().for_each(|&k| add(v.len() + k, &inputs[k]));
                *worst = simd.min_f64s(*worst, simd.sub_f64s(sum, of(&least[row])));
                S::as_mut_simd_f64s(&mut ends[row]).0[part] = sum;
            }
        }
        worst.iter().enumerate().map(|(lane, w)| u32::from(*w < 0.0) << lane).sum()
    }
}
