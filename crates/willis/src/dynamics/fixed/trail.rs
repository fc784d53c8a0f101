//! Where the energy goes while steps go on in one mode.
//!
//! Within a mode every torque and every mean speed of a step is a sum over few numbers: the speeds before the step, the
//! inputs that are not level, and one. What a source gives and what a loss takes is a product of two such sums. A step
//! leaves its numbers here; the products are taken for many steps at once, by vector instructions, when there are
//! enough of them, when the mode ends, and when somebody asks.
//!
//! The products are taken step by step, though it would do to add up the squares of the numbers, `Σ z zᵀ`, and to put
//! both sums around them at the end: that costs as much, and where a torque and a slip are both small differences of
//! large numbers, `1/m` and `1/n` of them, it is wrong by `m n` times the round-off. Here, as in
//! a step that is counted by itself, it is `m + n` times. A difference over the length of the step, which
//! would make `m` large in short steps, is no part of the sums: a prescribed speed enters by its acceleration, and what
//! is held loses nothing.

use crate::dynamics::mode::Side;
use crate::dynamics::system::System;

/// Steps whose products are taken at once.
pub(super) const STEPS: usize = 32;

/// Partial sums, on every machine as many: the same run adds up to the same bits.
const LANES: usize = 8;

/// What one number of each of the steps is.
pub(super) type Row = [f64; STEPS];

/// What the steps in one mode left behind.
#[derive(Clone, Default)]
pub(super) struct Trail {
    /// Speeds of all coordinates, inputs that are not level, one: step by step.
    pub numbers: Vec<Row>,
    /// How many steps.
    pub steps: usize,
    /// Whether the accounts are those of the present mode.
    pub is_ready: bool,
    pub accounts: Vec<Account>,
    /// Terms of the sums of all accounts, one after another: which number, and its factor.
    pub terms: Vec<(u16, f64)>,
    /// Torques of the ports, accelerations, and room for one more, each as a sum over the numbers.
    pub torques: Sums,
    pub accelerations: Sums,
    pub torque: Vec<f64>,
    pub speed: Vec<f64>,
}

/// A torque and a mean speed whose product is the power of something.
#[derive(Clone, Copy)]
pub(super) struct Account {
    of: Of,
    /// Ends of their terms.
    torque: usize,
    speed: usize,
}

#[derive(Clone, Copy)]
pub(super) enum Of {
    Source(usize),
    /// By position among the energies.
    Loss(usize),
    Element(usize),
}

/// Sums over the same numbers.
#[derive(Clone, Default)]
pub(super) struct Sums {
    width: usize,
    factors: Vec<f64>,
}

impl Sums {
    pub fn clear(&mut self, sums: usize, width: usize) {
        self.width = width;
        self.factors.clear();
        self.factors.resize(sums * width, 0.0);
    }

    pub fn row(&self, k: usize) -> &[f64] {
        &self.factors[k * self.width..(k + 1) * self.width]
    }

    pub fn row_mut(&mut self, k: usize) -> &mut [f64] {
        &mut self.factors[k * self.width..(k + 1) * self.width]
    }

    /// Adds as much of each of them.
    pub fn add_to(&self, sum: &mut [f64], parts: &[f64], factor: f64) {
        for (row, part) in self.factors.chunks_exact(self.width).zip(parts).filter(|(_, part)| **part != 0.0) {
            sum.iter_mut().zip(row).for_each(|(sum, x)| *sum += factor * part * x);
        }
    }
}

impl Trail {
    /// Room for all that the modes of a train can need.
    pub fn new(s: &System) -> Self {
        let width = s.all() + s.drivers.len() + s.frictions.len() + s.elastic.len() + 1;
        let accounts = s.drivers.len() + s.frictions.len() + s.elastic.len() + s.elements.len();
        let sums = |rows: usize| Sums { width, factors: Vec::with_capacity(rows * width) };
        Self {
            numbers: vec![[0.0; STEPS]; width],
            steps: 0,
            is_ready: false,
            accounts: Vec::with_capacity(accounts),
            terms: Vec::with_capacity(2 * accounts * width),
            torques: sums(s.ports + s.groups.len()),
            accelerations: sums(s.all()),
            torque: Vec::with_capacity(width),
            speed: Vec::with_capacity(width),
        }
    }

    /// Forgets all steps.
    pub fn clear(&mut self) {
        (self.steps, self.is_ready) = (0, false);
    }

    /// Closes an account of the torque and the speed in the room for one more.
    pub fn open(&mut self, of: Of) {
        if self.torque.iter().all(|x| *x == 0.0) {
            return;
        }
        let terms = |sum: &[f64], terms: &mut Vec<(u16, f64)>| {
            terms.extend(sum.iter().enumerate().filter(|(_, x)| **x != 0.0).map(|(k, x)| (k as u16, *x)));
            terms.len()
        };
        let torque = terms(&self.torque, &mut self.terms);
        let speed = terms(&self.speed, &mut self.terms);
        self.accounts.push(Account { of, torque, speed });
    }
}

/// Takes the products and adds them up.
pub(super) struct Book<'a> {
    pub trail: &'a Trail,
    pub h: f64,
    pub s: &'a System,
    pub side: &'a [Side],
    pub energies: &'a mut [f64],
    pub came_in: &'a mut [f64],
}

impl pulp::WithSimd for Book<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, simd: S) {
        let Self { trail, h, s, side, energies, came_in } = self;
        let meshes = s.drivers.len() + s.frictions.len() + s.elastic.len();
        let mut start = 0;
        for account in &trail.accounts {
            let (torque, speed) = (&trail.terms[start..account.torque], &trail.terms[account.torque..account.speed]);
            start = account.speed;
            let [work, given] = works(simd, &trail.numbers, torque, speed).map(|sum| sum * h);
            match account.of {
                Of::Source(k) => {
                    energies[k] += work;
                    came_in[k] += given;
                }
                Of::Loss(k) => energies[k] += work,
                Of::Element(j) => {
                    for &(mesh, part) in &s.elements[j].shares[usize::from(side[j] == Side::Coast)] {
                        energies[meshes + mesh] += work * part;
                    }
                }
            }
        }
    }
}

/// Sum of the products of all steps, and of those above zero.
#[inline(always)]
fn works<S: pulp::Simd>(simd: S, numbers: &[Row], torque: &[(u16, f64)], speed: &[(u16, f64)]) -> [f64; 2] {
    const BLOCKS: usize = STEPS / LANES;
    let (mut sums, mut above) = ([0.0; LANES], [0.0; LANES]);
    let parts = S::as_simd_f64s(&[0.0; LANES]).0.len();
    for part in 0..parts {
        let sum = |terms: &[(u16, f64)]| {
            let mut sum = [simd.splat_f64s(0.0); BLOCKS];
            for &(k, factor) in terms {
                let row = S::as_simd_f64s(&numbers[usize::from(k)]).0;
                let factor = simd.splat_f64s(factor);
                for (block, sum) in sum.iter_mut().enumerate() {
                    *sum = simd.add_f64s(*sum, simd.mul_f64s(factor, row[block * parts + part]));
                }
            }
            sum
        };
        let (torque, speed) = (sum(torque), sum(speed));
        let zero = simd.splat_f64s(0.0);
        let (mut all, mut positive) = (zero, zero);
        for (torque, speed) in torque.into_iter().zip(speed) {
            let power = simd.mul_f64s(torque, speed);
            all = simd.add_f64s(all, power);
            positive = simd.add_f64s(positive, simd.max_f64s(power, zero));
        }
        S::as_mut_simd_f64s(&mut sums).0[part] = all;
        S::as_mut_simd_f64s(&mut above).0[part] = positive;
    }
    [sums.iter().sum(), above.iter().sum()]
}
