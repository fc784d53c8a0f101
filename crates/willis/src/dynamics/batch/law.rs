//! Inputs that are not level, as a block takes them.

use crate::dynamics::fixed::FixedStep;
use crate::train::SourceKind;

use super::lanes::Lanes;

/// Inputs that are not level, at most, where a block cruises.
pub(super) const MOST_VARYING: usize = 8;

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
    pub fn part<S: pulp::Simd>(self, simd: S, v: &[Lanes], common: Option<f64>, part: usize) -> S::f64s {
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

/// Whether steps of a block depend on no more than its speeds, and on inputs that are common or follow a law; `common` begins with those
/// of a step.
pub(super) fn may_cruise(one: &FixedStep, common: &[Option<f64>]) -> bool {
    let s = &one.engine.system;
    let has_law = |(&k, common): (&usize, &Option<f64>)| common.is_some() || Law::of(one, k).is_some();
    s.prescribed == 0
        && s.integrals == 0
        && one.varying.len() <= MOST_VARYING
        && one.varying.iter().zip(common).all(has_law)
}
