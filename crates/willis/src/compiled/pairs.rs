//! Linear outputs where every point has one of two patterns, in one pass.
//!
//! In a train with one prescribed speed that keeps its sign, the sign of each relative speed is a constant, and so is the
//! drag that does not depend on speed. A pattern fits where a few sums of products are not negative; its outputs are sums
//! of the same form. Vectors of points stay in registers while the rows of both patterns run past them.
//!
//! A sum is added up in the order of [`lane`](super::passes::lane): the same bits as from the general passes.

use pulp::Simd;

use super::parts::{CHUNK, MOST_LINEAR, MOST_MOVING};

/// A sum of products with inputs, and a constant.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line<const F: usize> {
    by: [f64; F],
    constant: f64,
}

impl<const F: usize> Line<F> {
    pub const NONE: Self = Self { by: [0.0; F], constant: -0.0 };

    /// From factors of the inputs and of a sign, which is constant. Without one, -0 is added: it changes nothing.
    pub fn new(row: &[f64], sign: f64) -> Self {
        let mut by = [0.0; F];
        by.copy_from_slice(&row[..F]);
        Self { by, constant: row.get(F).map_or(-0.0, |r| r * sign) }
    }

    /// The sum with the other sign.
    pub fn negative(self) -> Self {
        Self { by: self.by.map(|r| -r), constant: -self.constant }
    }
}

/// The rows of two patterns.
pub(super) struct Pair<const F: usize> {
    /// What is not negative where the patterns fit, for each moving element.
    pub fits: [[Line<F>; 2]; MOST_MOVING],
    pub moving: usize,
    pub outputs: [[Line<F>; 2]; MOST_LINEAR],
    pub linear: usize,
}

/// How the points of a chunk were shared out.
pub(super) struct Shared {
    /// Points of the first pattern and of the second.
    pub taken: [usize; 2],
    /// The points that neither fits, and how many.
    pub left: [u16; CHUNK],
    pub open: usize,
}

/// Fills the outputs of the points that one of two patterns fits, the first where both do. Where neither does, what is
/// written has no meaning.
pub(super) struct Fill<'a, 'o, const F: usize> {
    pub x: [&'a [f64]; F],
    pub pair: &'a Pair<F>,
    pub out: &'a mut [&'o mut [f64]],
    pub shared: &'a mut Shared,
}

/// Vectors that are worked on side by side.
const WIDE: usize = 2;
/// Vectors whose pattern is found before their outputs are written.
const BLOCK: usize = 16;

#[inline(always)]
fn sum<S: Simd, const F: usize>(simd: S, x: &[S::f64s; F], by: &[S::f64s; F], constant: S::f64s) -> S::f64s {
    let mut s = simd.mul_f64s(by[0], x[0]);
    for k in 1..F {
        s = simd.add_f64s(s, simd.mul_f64s(by[k], x[k]));
    }
    simd.add_f64s(s, constant)
}

impl<const F: usize> pulp::WithSimd for Fill<'_, '_, F> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { x, pair, out, shared } = self;
        let n = x[0].len();
        let x = x.map(|x| S::as_simd_f64s(&x[..n]).0);
        let vectors = x[0].len() / WIDE * WIDE;
        let (fits, outputs) = (&pair.fits[..pair.moving], &pair.outputs[..pair.linear]);
        let out = &mut out[..pair.linear];
        let [zero, one] = [0.0, 1.0].map(|x| simd.splat_f64s(x));
        let mut counts = [zero; 2];
        shared.open = 0;
        let mut start = 0;
        while start < vectors {
            let len = BLOCK.min(vectors - start);
            let x = x.map(|x| &x[start..start + len]);
            let mut first = [simd.less_than_f64s(one, zero); BLOCK];
            let before = shared.open;
            let mut others = zero;
            let mut inputs = [[zero; F]; BLOCK];
            for v in (0..len).step_by(WIDE) {
                let now: [[S::f64s; F]; WIDE] = std::array::from_fn(|u| std::array::from_fn(|k| x[k][v + u]));
                inputs[v..v + WIDE].copy_from_slice(&now);
                // The smallest of what must not be negative. NaN is in it only from the first, as everywhere.
                let mut worst = [[zero; 2]; WIDE];
                for (row, lines) in fits.iter().enumerate() {
                    for (p, line) in lines.iter().enumerate() {
                        let (by, constant) = (line.by.map(|r| simd.splat_f64s(r)), simd.splat_f64s(line.constant));
                        for u in 0..WIDE {
                            let g = sum(simd, &now[u], &by, constant);
                            let old = worst[u][p];
                            worst[u][p] =
                                if row == 0 { g } else { simd.select_f64s(simd.less_than_f64s(g, old), g, old) };
                        }
                    }
                }
                for u in 0..WIDE {
                    let [a, b] = worst[u].map(|w| simd.greater_than_or_equal_f64s(w, zero));
                    first[v + u] = a;
                    let is_a = simd.select_f64s(a, one, zero);
                    let only_b = simd.select_f64s(a, zero, simd.select_f64s(b, one, zero));
                    others = simd.add_f64s(others, only_b);
                    counts = [simd.add_f64s(counts[0], is_a), simd.add_f64s(counts[1], only_b)];
                    if simd.first_true_m64s(simd.not_m64s(simd.or_m64s(a, b))) < S::F64_LANES {
                        // Rare: looked at one by one.
                        let taken = simd.add_f64s(is_a, only_b);
                        let lanes: &[f64] = pulp::bytemuck::cast_slice(std::slice::from_ref(&taken));
                        for (i, _) in lanes.iter().enumerate().filter(|(_, taken)| **taken == 0.0) {
                            shared.left[shared.open] = ((start + v + u) * S::F64_LANES + i) as u16;
                            shared.open += 1;
                        }
                    }
                }
            }
            let only_first = shared.open == before && simd.reduce_sum_f64s(others) == 0.0;
            // One output after the other, so that what is written lies side by side.
            for (out, [a, b]) in out.iter_mut().zip(outputs) {
                let out = &mut S::as_mut_simd_f64s(out).0[start..start + len];
                let (by_a, by_b) = (a.by.map(|r| simd.splat_f64s(r)), b.by.map(|r| simd.splat_f64s(r)));
                let [c_a, c_b] = [a.constant, b.constant].map(|c| simd.splat_f64s(c));
                if only_first {
                    out.iter_mut().zip(&inputs).for_each(|(out, now)| *out = sum(simd, now, &by_a, c_a));
                    continue;
                }
                for ((out, now), first) in out.iter_mut().zip(&inputs).zip(&first) {
                    let by: [S::f64s; F] = std::array::from_fn(|k| simd.select_f64s(*first, by_a[k], by_b[k]));
                    *out = sum(simd, now, &by, simd.select_f64s(*first, c_a, c_b));
                }
            }
            start += len;
        }
        let total = |counts: S::f64s| {
            let lanes: &[f64] = pulp::bytemuck::cast_slice(std::slice::from_ref(&counts));
            lanes.iter().sum::<f64>() as usize
        };
        shared.taken = counts.map(total);
        // What does not fill the vectors.
        for i in vectors * S::F64_LANES..n {
            shared.left[shared.open] = i as u16;
            shared.open += 1;
        }
    }
}
