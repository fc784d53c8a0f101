//! Numbers of the runs of a block, side by side.

use std::ops::{Deref, DerefMut};

use crate::dynamics::fixed::groups::UNBOUNDED;
use crate::dynamics::fused::BLOCK;

/// Runs in a block: two of the widest vectors, since each step of a run waits for the one before.
pub(super) const LANES: usize = 16;

/// Runs of a block, as bits.
pub(super) type Mask = u16;

/// A number of each run of a block. A vector that begins anywhere lies in two lines of the cache, mostly.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(super) struct Lanes(pub [f64; LANES]);

impl Deref for Lanes {
    type Target = [f64; LANES];
    #[inline(always)]
    fn deref(&self) -> &[f64; LANES] {
        &self.0
    }
}

impl DerefMut for Lanes {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [f64; LANES] {
        &mut self.0
    }
}

impl Lanes {
    pub fn of(x: f64) -> Self {
        Self([x; LANES])
    }

    /// How many vectors so many runs fill.
    #[inline(always)]
    pub const fn parts<S: pulp::Simd>(_: S, runs: usize) -> usize {
        runs.div_ceil(S::F64_LANES)
    }

    /// One of them.
    #[inline(always)]
    pub fn part<S: pulp::Simd>(&self, _: S, part: usize) -> S::f64s {
        S::as_simd_f64s(&self.0).0[part]
    }

    #[inline(always)]
    pub fn set_part<S: pulp::Simd>(&mut self, _: S, part: usize, x: S::f64s) {
        S::as_mut_simd_f64s(&mut self.0).0[part] = x;
    }
}

/// Writes the runs of a mask.
#[inline(always)]
pub(super) fn write(to: &mut Lanes, from: &Lanes, mask: Mask) {
    if mask == Mask::MAX {
        *to = *from;
    } else {
        (0..LANES).filter(|lane| mask >> lane & 1 == 1).for_each(|lane| to[lane] = from[lane]);
    }
}

/// Runs in which what opens, closes or locks does so at these inputs, as bits.
#[inline(always)]
pub(super) fn turns(now: &Lanes, was: &Lanes) -> Mask {
    let turns = |lane: usize, at: f64| (now[lane] == at) != (was[lane] == at);
    mask(|lane| turns(lane, 0.0) | turns(lane, UNBOUNDED))
}

/// Runs of which that is so, as bits.
#[inline(always)]
pub(super) fn mask(is_so: impl Fn(usize) -> bool) -> Mask {
    // Of none of them, nearly always.
    if !(0..LANES).fold(false, |any, lane| any | is_so(lane)) {
        return 0;
    }
    (0..LANES).map(|lane| Mask::from(is_so(lane)) << lane).sum()
}

/// Adds the terms of a block of rows to their sums, one after the other. Weights are those of all runs, or of each.
#[inline(always)]
pub(super) fn add_terms<S: pulp::Simd, W: Weight>(
    simd: S,
    sums: &mut [S::f64s; BLOCK],
    weights: &[[W; BLOCK]],
    x: &[Lanes],
    part: usize,
) {
    // A row waits for each of its additions, so that several are under way at once.
    for (w, x) in weights.iter().zip(x) {
        let x = x.part(simd, part);
        for k in 0..BLOCK {
            sums[k] = simd.add_f64s(sums[k], simd.mul_f64s(w[k].of_part(simd, part), x));
        }
    }
}

/// A weight of a row, in a part of the runs.
pub(super) trait Weight {
    fn of_part<S: pulp::Simd>(&self, simd: S, part: usize) -> S::f64s;
}

impl Weight for f64 {
    #[inline(always)]
    fn of_part<S: pulp::Simd>(&self, simd: S, _: usize) -> S::f64s {
        simd.splat_f64s(*self)
    }
}

impl Weight for Lanes {
    #[inline(always)]
    fn of_part<S: pulp::Simd>(&self, simd: S, part: usize) -> S::f64s {
        self.part(simd, part)
    }
}

/// Whether a margin breaks, or a run has grown beyond its bound, in any run: nearly always in none.
#[inline(always)]
pub(super) fn breaks<S: pulp::Simd>(simd: S, margins: &Lanes, square: &Lanes, bound: &Lanes) -> bool {
    let [margins, square, bound] = [margins, square, bound].map(|x| S::as_simd_f64s(&x.0).0);
    let (holds, breaks) = (simd.splat_f64s(1.0), simd.splat_f64s(-1.0));
    let all = margins.iter().zip(square).zip(bound).fold(holds, |all, ((margin, square), bound)| {
        let of_margin = simd.select_f64s(simd.less_than_f64s(*margin, simd.splat_f64s(0.0)), breaks, all);
        simd.select_f64s(simd.less_than_or_equal_f64s(*square, *bound), of_margin, breaks)
    });
    simd.reduce_min_f64s(all) < 0.0
}
