//! Steps of a block whose runs stay well inside their modes.

use std::ops::Range;

use crate::dynamics::fixed::FixedStep;
use crate::dynamics::fused::BLOCK;
use crate::train::SourceKind;

use super::reach::Reach;
use super::{Block, Lanes, Room, breaks, turns};

/// Inputs that are not level, at most, where a block cruises.
const MOST_VARYING: usize = 8;

/// Where the value of an input comes from, but for its factor.
#[derive(Clone, Copy)]
pub(super) enum Law<'a> {
    /// It is the same in all runs.
    Common,
    /// A torque over a speed, which is a sum over the coordinates.
    Linear {
        row: &'a [f64],
        torque: f64,
        about: f64,
        slope: f64,
    },
    Quadratic {
        row: &'a [f64],
        torque: f64,
        about: f64,
        factor: f64,
        even: bool,
    },
}

impl<'a> Law<'a> {
    /// That of an input which is not common to all runs; none if each run has to find its own.
    pub fn of(one: &'a FixedStep, k: usize) -> Option<Self> {
        let row = one.row_of_input(k);
        match one.engine.system.scenario.sources.get(k)?.kind {
            SourceKind::Linear { torque, about, slope } => Some(Self::Linear { row, torque, about, slope }),
            SourceKind::Quadratic { torque, about, factor, even } => {
                Some(Self::Quadratic { row, torque, about, factor, even })
            }
            _ => None,
        }
    }

    /// Its value at the speeds, or the one that is common, in a part of the runs.
    #[inline(always)]
    fn part<S: pulp::Simd>(self, simd: S, v: &[Lanes], common: Option<f64>, part: usize) -> S::f64s {
        let all = |x: f64| simd.splat_f64s(x);
        match self {
            Self::Common => all(common.unwrap_or_default()),
            Self::Linear { row, torque, about, slope } => {
                let w = simd.sub_f64s(followed_part(simd, row, v, part), all(about));
                simd.sub_f64s(all(torque), simd.mul_f64s(all(slope), w))
            }
            Self::Quadratic { row, torque, about, factor, even } => {
                let w = simd.sub_f64s(followed_part(simd, row, v, part), all(about));
                let square = simd.mul_f64s(w, if even { w } else { simd.abs_f64s(w) });
                simd.sub_f64s(all(torque), simd.mul_f64s(all(factor), square))
            }
        }
    }

    /// Its value at the speeds.
    #[inline(always)]
    pub fn at<S: pulp::Simd>(self, simd: S, v: &[Lanes]) -> Lanes {
        let mut all = Lanes::of(0.0);
        let parts = S::as_mut_simd_f64s(&mut all.0).0.iter_mut().enumerate();
        parts.for_each(|(part, all)| *all = self.part(simd, v, None, part));
        all
    }
}

/// The speed or slip that an input may follow, in each run.
#[inline(always)]
pub(super) fn followed<S: pulp::Simd>(simd: S, row: &[f64], v: &[Lanes]) -> Lanes {
    let mut all = Lanes::of(0.0);
    let parts = S::as_mut_simd_f64s(&mut all.0).0.iter_mut().enumerate();
    parts.for_each(|(part, all)| *all = followed_part(simd, row, v, part));
    all
}

/// In the order of `dot`.
#[inline(always)]
fn followed_part<S: pulp::Simd>(simd: S, row: &[f64], v: &[Lanes], part: usize) -> S::f64s {
    let (fours, rest) = row.as_chunks::<4>();
    let (v, v_rest) = v.split_at(4 * fours.len());
    let add = |sum, w: f64, v: &Lanes| simd.add_f64s(sum, simd.mul_f64s(simd.splat_f64s(w), v.part(simd, part)));
    let zero = simd.splat_f64s(0.0);
    let last = rest.iter().zip(v_rest).fold(zero, |sum, (w, v)| add(sum, *w, v));
    let mut sums = [zero; 4];
    for (w, v) in fours.iter().zip(v.as_chunks::<4>().0) {
        (0..4).for_each(|k| sums[k] = add(sums[k], w[k], &v[k]));
    }
    let [a, b, c, d] = sums;
    match fours {
        [] => last,
        _ => simd.add_f64s(simd.add_f64s(simd.add_f64s(a, c), simd.add_f64s(b, d)), last),
    }
}

/// Whether steps of a block depend on no more than its speeds, and on inputs that are common or follow a law; `common` are those
/// of a step, at least.
pub(super) fn may_cruise(one: &FixedStep, common: &[Option<f64>]) -> bool {
    let s = &one.engine.system;
    let has_law = |(&k, common): (&usize, &Option<f64>)| common.is_some() || Law::of(one, k).is_some();
    s.prescribed == 0
        && s.integrals == 0
        && one.varying.len() <= MOST_VARYING
        && one.varying.iter().zip(common).all(has_law)
}

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
        all: u8,
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
        let Room { x, ends, .. } = room;
        x.clear();
        x.extend_from_slice(&self.v);
        x.resize(terms, Lanes::of(0.0));
        ends.resize(free.next_multiple_of(BLOCK), Lanes::of(0.0));
        let (x, ends) = (&mut x[..terms], ends[..free.next_multiple_of(BLOCK)].as_chunks_mut::<BLOCK>().0);
        let Reach { centre, half, base, least, weights, .. } = &self.reach;
        let (centre, half) = (&centre[..terms], &half[..terms]);
        let (base, least) = (base.as_chunks::<BLOCK>().0, least.as_chunks::<BLOCK>().0);
        let rows = base.len().min(least.len());
        let (base, least) = (&base[..rows], &least[..rows]);
        let weights = &weights.as_chunks::<BLOCK>().0[..rows * terms];
        let of_friction = s.drivers.len()..s.drivers.len() + s.frictions.len();
        let rubs = one.varying.iter().any(|k| of_friction.contains(k));
        let mut taken = 0;
        for step in steps {
            let common = &common[step * varying..(step + 1) * varying];
            let mut inside = Lanes::of(f64::INFINITY);
            let mut square = Lanes::of(0.0);
            for part in 0..inside.parts(simd) {
                let (v, entering) = x.split_at_mut(free);
                for ((u, &k), (law, common)) in entering.iter_mut().zip(&one.varying).zip(laws.iter().zip(common)) {
                    let own = law.part(simd, v, *common, part);
                    u.set_part(simd, part, simd.mul_f64s(self.factors[k].part(simd, part), own));
                }
                let mut worst = simd.splat_f64s(f64::INFINITY);
                for ((x, centre), half) in x.iter().zip(centre).zip(half) {
                    let away = simd.abs_f64s(simd.sub_f64s(x.part(simd, part), centre.part(simd, part)));
                    worst = simd.min_f64s(worst, simd.sub_f64s(half.part(simd, part), away));
                }
                let mut sum = simd.splat_f64s(0.0);
                for (at, (base, least)) in base.iter().zip(least).enumerate() {
                    // A row waits for each of its additions, so that several are under way at once.
                    let mut sums = [0, 1, 2, 3].map(|k| base[k].part(simd, part));
                    for (w, x) in weights[at * terms..(at + 1) * terms].iter().zip(x.iter()) {
                        let x = x.part(simd, part);
                        for k in 0..BLOCK {
                            sums[k] = simd.add_f64s(sums[k], simd.mul_f64s(w[k].part(simd, part), x));
                        }
                    }
                    for k in 0..BLOCK {
                        worst = simd.min_f64s(worst, simd.sub_f64s(sums[k], least[k].part(simd, part)));
                    }
                    if let Some(ends) = ends.get_mut(at) {
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
            let entering = || one.varying.iter().zip(&x[free..]);
            if rubs && entering().any(|(&k, u)| of_friction.contains(&k) && turns(u, &self.inputs[k]) & all != 0) {
                break;
            }
            entering().for_each(|(&k, u)| self.inputs[k] = *u);
            x[..free].copy_from_slice(&ends.as_flattened()[..free]);
            taken += 1;
        }
        self.v.copy_from_slice(&x[..free]);
        self.reach.count(taken);
        one.count += taken as u64;
        taken
    }
}
