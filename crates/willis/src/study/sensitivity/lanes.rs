//! Several derivatives in one pass: what does not depend on the quantity that moves, values, powers, roots, is worked out once for
//! all of them.

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

pub(super) use several::{LANES, Moving, lane, moving};

#[cfg(not(target_arch = "wasm32"))]
mod several {
    use num_dual::{Dual64, DualSVec64};

    /// As many quantities are moved side by side.
    pub const LANES: usize = 8;

    /// A number with its derivative by each of them.
    pub type Moving = DualSVec64<LANES>;

    /// A number that moves at the given rates in the given lanes. One that does not move takes no part in derivatives.
    pub fn moving(value: f64, rates: impl Iterator<Item = (usize, f64)>) -> Moving {
        let mut moving = Moving::from_re(value);
        for (lane, rate) in rates.filter(|(_, rate)| *rate != 0.0) {
            moving.eps.0.get_or_insert_default()[lane] = rate;
        }
        moving
    }

    /// The number with its derivative in one lane.
    pub fn lane(number: &Moving, k: usize) -> Dual64 {
        Dual64::new(number.re, number.eps.0.map_or(0.0, |rates| rates[k]))
    }
}

/// What a browser loads has a limit, and few vectors: one after the other.
#[cfg(target_arch = "wasm32")]
mod several {
    use num_dual::Dual64;

    pub const LANES: usize = 1;

    pub type Moving = Dual64;

    pub fn moving(value: f64, mut rates: impl Iterator<Item = (usize, f64)>) -> Moving {
        Moving::new(value, rates.next().map_or(0.0, |(_, rate)| rate))
    }

    pub fn lane(number: &Moving, _: usize) -> Dual64 {
        *number
    }
}
