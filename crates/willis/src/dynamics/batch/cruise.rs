//! Steps of a block whose runs stay well inside their modes.

use std::ops::Range;

use crate::dynamics::fixed::FixedStep;
use crate::dynamics::fused::BLOCK;

use super::block::{Block, Room};
use super::lanes::{Lanes, Mask, add_terms, breaks, turns};
use super::law::{Law, MOST_VARYING};
use super::reach::Reach;

impl Block {
    /// Takes steps as long as all runs stay in their boxes and do not grow beyond their bounds; how many. `common` is that of
    /// all steps, `all` are the runs of the block.
    #[inline(always)]
    pub(super) fn cruise<S: pulp::Simd>(
        &mut self,
        simd: S,
        one: &mut FixedStep,
        common: &[Option<f64>],
        steps: Range<usize>,
        all: Mask,
        room: &mut Room,
    ) -> usize {
        let s = &one.engine.system;
        let (free, varying) = (s.free, one.varying.len());
        let terms = free + varying;
        if !self.reach.is_open(terms) {
            return 0;
        }
        let mut laws = [Law::Common; MOST_VARYING];
        for ((law, &k), common) in laws.iter_mut().zip(&one.varying).zip(&common[steps.start * varying..]) {
            if common.is_none() {
                *law = Law::of(one, k).expect("a law, or it may not cruise");
            }
        }
        // Speeds and inputs of a step, and room for those of the next.
        let Room { x, ends, .. } = room;
        let width = terms.max(free.next_multiple_of(BLOCK));
        for of_step in [&mut *x, &mut *ends] {
            of_step.resize(width.max(of_step.len()), Lanes::of(0.0));
        }
        let (mut x, mut next) = (&mut x[..width], &mut ends[..width]);
        x[..free].copy_from_slice(&self.v);
        let Reach { centre, half, base, least, weights, .. } = &self.reach;
        let (centre, half) = (&centre[..terms], &half[..terms]);
        let (base, least) = (base.as_chunks::<BLOCK>().0, least.as_chunks::<BLOCK>().0);
        let rows = base.len().min(least.len());
        let (base, least) = (&base[..rows], &least[..rows]);
        let weights = &weights.as_chunks::<BLOCK>().0[..rows * terms];
        let of_friction = s.drivers.len()..s.drivers.len() + s.frictions.len();
        // Where all rows are looked at there is no box.
        let has_box = half.iter().any(|half| half.iter().any(|half| *half < f64::INFINITY));
        let rubs = one.varying.iter().any(|k| of_friction.contains(k));
        // Of few runs, only the parts that have any.
        let parts = Lanes::parts(simd, (Mask::BITS - all.leading_zeros()) as usize);
        let mut taken = 0;
        for step in steps {
            let common = &common[step * varying..(step + 1) * varying];
            let mut inside = Lanes::of(f64::INFINITY);
            let mut square = Lanes::of(0.0);
            for part in 0..parts {
                let (v, entering) = x[..terms].split_at_mut(free);
                for ((u, &k), (law, common)) in entering.iter_mut().zip(&one.varying).zip(laws.iter().zip(common)) {
                    let own = law.part(simd, v, *common, part);
                    u.set_part(simd, part, simd.mul_f64s(self.factors[k].part(simd, part), own));
                }
                let mut worst = simd.splat_f64s(f64::INFINITY);
                if has_box {
                    for ((x, centre), half) in x.iter().zip(centre).zip(half) {
                        let away = simd.abs_f64s(simd.sub_f64s(x.part(simd, part), centre.part(simd, part)));
                        worst = simd.min_f64s(worst, simd.sub_f64s(half.part(simd, part), away));
                    }
                }
                let mut sum = simd.splat_f64s(0.0);
                for (at, (base, least)) in base.iter().zip(least).enumerate() {
                    let mut sums = [0, 1, 2, 3].map(|k| base[k].part(simd, part));
                    add_terms(simd, &mut sums, &weights[at * terms..(at + 1) * terms], &x[..terms], part);
                    for k in 0..BLOCK {
                        worst = simd.min_f64s(worst, simd.sub_f64s(sums[k], least[k].part(simd, part)));
                    }
                    if at * BLOCK < free {
                        let ends = &mut next[at * BLOCK..(at + 1) * BLOCK];
                        (0..BLOCK).for_each(|k| ends[k].set_part(simd, part, sums[k]));
                        for end in sums.iter().take(free - at * BLOCK) {
                            sum = simd.add_f64s(sum, simd.mul_f64s(*end, *end));
                        }
                    }
                }
                inside.set_part(simd, part, worst);
                square.set_part(simd, part, sum);
            }
            if breaks(simd, &inside, &square, &self.bound) {
                break;
            }
            let entering = || one.varying.iter().zip(&x[free..terms]);
            if rubs && entering().any(|(&k, u)| of_friction.contains(&k) && turns(u, &self.inputs[k]) & all != 0) {
                break;
            }
            entering().for_each(|(&k, u)| self.inputs[k] = *u);
            std::mem::swap(&mut x, &mut next);
            taken += 1;
        }
        self.v.copy_from_slice(&x[..free]);
        self.reach.count(taken);
        one.count += taken as u64;
        taken
    }
}
