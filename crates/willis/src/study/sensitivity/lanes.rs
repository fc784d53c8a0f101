//! Several derivatives in one pass: what does not depend on the quantity that moves, values, powers, roots, is worked out once for
//! all of them.

use nalgebra::SVector;
use num_dual::{Dual64, DualSVec64};

use crate::train::Slot;

/// What moves beside the numbers of the train.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Moved {
    /// Nothing that the operation prescribes.
    Train,
    /// Its prescribed speed of this place.
    Speed(usize),
    /// Its prescribed torque or power of this place.
    Load(usize),
}

/// A quantity that moves: what of the train moves with it, each at its rate, and what of the operation.
#[derive(Clone, Copy)]
pub(super) struct Asked<'a> {
    pub slots: &'a [(Slot, f64)],
    pub moved: Moved,
}

/// As many quantities are moved side by side. What a browser loads has a limit, and no vectors of eight.
pub(super) const LANES: usize = if cfg!(target_arch = "wasm32") { 1 } else { 8 };

/// A number with its derivative by each of `N` quantities.
pub(super) type Moving<const N: usize> = DualSVec64<N>;

/// A number that moves at the given rate in each lane.
pub(super) fn moving<const N: usize>(value: f64, rate: impl Fn(usize) -> f64) -> Moving<N> {
    let mut moving = Moving::from_re(value);
    let rates = SVector::<f64, N>::from_fn(|k, _| rate(k));
    // Without derivatives it takes no part in theirs.
    if rates.iter().any(|rate| *rate != 0.0) {
        moving.eps.0 = Some(rates);
    }
    moving
}

/// The number with its derivative in one lane.
pub(super) fn lane<const N: usize>(number: &Moving<N>, k: usize) -> Dual64 {
    Dual64::new(number.re, number.eps.0.map_or(0.0, |rates| rates[k]))
}
