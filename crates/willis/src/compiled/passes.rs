//! What all passes over a chunk share: loops for each vector width, and sums of products.

use crate::arch::Arch;

/// Declares loops over lanes that are compiled for each vector width and chosen at run time. (A
/// closure would do, but nothing forces it to be inlined into the function that has the width.)
macro_rules! lanes {
    ($($(#[$doc:meta])* $name:ident<$lt:lifetime $(, const $g:ident)*> { $($field:ident: $type:ty),+ $(,)? } -> $out:ty $body:block)+) => {
        $(
            $(#[$doc])*
            struct $name<$lt $(, const $g: usize)*> { $($field: $type),+ }

            impl<$lt $(, const $g: usize)*> pulp::WithSimd for $name<$lt $(, $g)*> {
                type Output = $out;
                #[inline(always)]
                fn with_simd<S: pulp::Simd>(self, _: S) -> $out {
                    let Self { $($field),+ } = self;
                    $body
                }
            }
        )+
    };
}

/// Calls a function that is generic over the number of features with that number as a constant.
macro_rules! by_count {
    ($count:expr, $call:ident ( $($argument:expr),* )) => {
        match $count {
            1 => $call::<1>($($argument),*),
            2 => $call::<2>($($argument),*),
            3 => $call::<3>($($argument),*),
            4 => $call::<4>($($argument),*),
            5 => $call::<5>($($argument),*),
            6 => $call::<6>($($argument),*),
            7 => $call::<7>($($argument),*),
            8 => $call::<8>($($argument),*),
            _ => $call::<0>($($argument),*),
        }
    };
}

#[inline]
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |s, (a, b)| s + a * b)
}

/// The first `F` columns and factors; all of them for `F = 0`, which is then not constant.
#[inline(always)]
pub(super) fn lane<const F: usize>(x: &[&[f64]; F], row: &[f64; F], i: usize) -> f64 {
    let mut s = row[0] * x[0][i];
    for k in 1..F {
        s += row[k] * x[k][i];
    }
    s
}

lanes! {
    /// The smallest power of two among those at the front of the numbers: 0 where one is 0 or has not all digits.
    LeastExponent<'a> { x: &'a [f64] } -> f64 {
        const EXPONENT: u64 = 0x7ff << 52;
        const LANES: usize = 32;
        let size = |x: f64| f64::from_bits(x.to_bits() & EXPONENT);
        let (chunks, rest) = x.as_chunks::<LANES>();
        let mut least = [f64::INFINITY; LANES];
        for c in chunks {
            for k in 0..LANES {
                least[k] = if size(c[k]) < least[k] { size(c[k]) } else { least[k] };
            }
        }
        rest.iter().map(|x| size(*x)).chain(least).fold(f64::INFINITY, f64::min)
    }
    /// `out = Σ row_k x_k`.
    Combine<'a, const F> { x: [&'a [f64]; F], row: [f64; F], out: &'a mut [f64] } -> () {
        let n = out.len();
        let x = x.map(|x| &x[..n]);
        for i in 0..n {
            out[i] = lane::<F>(&x, &row, i);
        }
    }
}

/// Whether a number is too small for all digits of floating point.
pub(super) fn is_tiny(arch: Arch, x: &[f64]) -> bool {
    // Nearly never, so that a quick look at the exponents says it.
    arch.dispatch(LeastExponent { x }) == 0.0 && x.iter().any(|x| x.is_subnormal())
}

/// `out = Σ row_k x_k`.
pub(super) fn combine(arch: Arch, x: &[&[f64]], row: &[f64], out: &mut [f64]) {
    fn go<const F: usize>(arch: Arch, x: &[&[f64]], row: &[f64], out: &mut [f64]) {
        let n = out.len();
        match (<[&[f64]; F]>::try_from(x), <[f64; F]>::try_from(row)) {
            (Ok(x), Ok(row)) => arch.dispatch(Combine { x, row, out }),
            _ => {
                out.fill(0.0);
                for (x, r) in x.iter().zip(row) {
                    out.iter_mut().zip(&x[..n]).for_each(|(o, x)| *o += r * x);
                }
            }
        }
    }
    if x.is_empty() {
        return out.fill(0.0);
    }
    by_count!(x.len(), go(arch, x, row, out));
}
