//! Elastic shafts in a step: springs that look ahead.
//!
//! The angle goes on with the speed at the end of the step, and the spring acts with the twist `θ + α h ω⁺`, where `ω⁺`
//! is the rate at that end. `α = 0` keeps the energy of a slow oscillation and bursts where `z = h √(k/J) > 2`; `α = 1`
//! is stable for all `z` and takes a part `z/2` of the critical damping. `α = z²/(4 + z²)` is stable for all `z`, damps by
//! `z³/8` only where the step resolves the oscillation, and comes to rest at once where it does not. To the equations it is
//! a damper `d = c + α h k` that acts at the end of the step, constant while the contact is.

use nalgebra::{DMatrix, DVector};

use crate::dynamics::engine::Touch;
use crate::dynamics::mode::dot;
use crate::dynamics::rounding::NOISE;
use crate::dynamics::system::System;
use crate::train::Contact;

/// A sum over the twist before a step, its rate at the end of it, and one.
pub(in crate::dynamics) type OfTwist = [f64; 3];

/// An elastic shaft, ready for the step.
#[derive(Clone)]
pub(in crate::dynamics) struct ShaftStep {
    stiffness: f64,
    damping: f64,
    /// Half of its backlash, rad.
    half: f64,
    is_soft: bool,
    /// `α h`, s.
    ahead: f64,
    pub touch: Touch,
    /// Twist before the step, rad.
    pub twist: f64,
    /// At this step it left its contact, and came back without: it stays.
    came_back: bool,
    left: bool,
}

impl ShaftStep {
    /// The shafts of a train for steps of `h`.
    pub fn all(s: &System, h: f64) -> Vec<Self> {
        let shafts = s.train.shafts();
        if shafts.is_empty() {
            return vec![];
        }
        let mass = s.mass.clone().cholesky();
        let rows = DMatrix::from_fn(shafts.len(), s.free, |k, i| s.elastic[k].row[i]);
        // How far a torque in one shaft turns the ends of another: nothing held, so at most.
        let yields = match &mass {
            Some(mass) => &rows * mass.solve(&rows.transpose()),
            None => DMatrix::from_element(shafts.len(), shafts.len(), f64::INFINITY),
        };
        let stiffness = DVector::from_fn(shafts.len(), |k, _| shafts[k].stiffness.sqrt());
        (shafts.iter().enumerate())
            .map(|(k, shaft)| {
                // Row sums: no oscillation of several shafts together is faster.
                let square: f64 =
                    (0..shafts.len()).map(|j| h * h * stiffness[k] * stiffness[j] * yields[(k, j)].abs()).sum();
                let alpha = if square.is_finite() { square / (4.0 + square) } else { 1.0 };
                Self {
                    stiffness: shaft.stiffness,
                    damping: shaft.damping,
                    half: shaft.backlash / 2.0,
                    is_soft: shaft.contact == Contact::Soft,
                    ahead: alpha * h,
                    touch: if shaft.backlash > 0.0 { Touch::Gap } else { Touch::On(1) },
                    twist: 0.0,
                    came_back: false,
                    left: false,
                }
            })
            .collect()
    }

    /// Begins a step.
    pub fn begin(&mut self, twist: f64) {
        (self.twist, self.came_back, self.left) = (twist, false, false);
    }

    /// What the contact exerts against the twist.
    pub fn resists(&self) -> OfTwist {
        let k = self.stiffness;
        match self.touch {
            Touch::Gap | Touch::Parting(_) => [0.0; 3],
            Touch::On(side) => [k, self.damping + k * self.ahead, -k * self.half * f64::from(side)],
            Touch::Limited(side) => [2.0 * k, 2.0 * k * self.ahead, -2.0 * k * self.half * f64::from(side)],
        }
    }

    /// The part of that which turns the rate at the end into heat, as given: without what looking ahead adds.
    pub fn damper(&self) -> OfTwist {
        let k = self.stiffness;
        match self.touch {
            Touch::Gap | Touch::Parting(_) => [0.0; 3],
            Touch::On(_) => [0.0, self.damping, 0.0],
            Touch::Limited(side) => [k, k * self.ahead, -k * self.half * f64::from(side)],
        }
    }

    /// What is not below zero while the contact stays as it is.
    pub fn margins(&self) -> impl Iterator<Item = OfTwist> + use<> {
        let (k, half, ahead) = (self.stiffness, self.half, self.ahead);
        let times = |of: OfTwist, x: f64| of.map(|of| of * x);
        let beyond = |side: i8| {
            let along = f64::from(side);
            [along, along * ahead, -half]
        };
        // Spring and damper along the side, added and subtracted.
        let both = |side: i8, sign: f64| {
            let mut of = times(beyond(side), k);
            of[1] += sign * f64::from(side) * self.damping;
            of
        };
        let [first, second, third] = match self.touch {
            _ if half == 0.0 => [None, None, None],
            Touch::Gap => [Some(times(beyond(1), -1.0)), Some(times(beyond(-1), -1.0)), None],
            Touch::On(side) => {
                let soft = (self.is_soft && self.damping > 0.0).then(|| both(side, -1.0));
                [Some(beyond(side)), (self.damping > 0.0).then(|| both(side, 1.0)), soft]
            }
            Touch::Limited(side) => [Some(beyond(side)), Some(times(both(side, -1.0), -1.0)), None],
            Touch::Parting(side) => [Some(beyond(side)), Some(times(both(side, 1.0), -1.0)), None],
        };
        [first, second, third].into_iter().flatten()
    }

    /// What the contact would have to be at this rate at the end of the step, if not what it is.
    pub fn turns_to(&self, rate: f64) -> Option<Touch> {
        let x = [self.twist, rate, 1.0];
        let noise = |of: &OfTwist| NOISE * of.iter().zip(x).map(|(a, b)| (a * b).abs()).sum::<f64>();
        let is_broken = |of: OfTwist| dot(&of, &x) < -noise(&of);
        if !self.margins().any(is_broken) {
            return None;
        }
        let reached = self.twist + self.ahead * rate;
        let side = if reached >= 0.0 { 1 } else { -1 };
        let along = f64::from(side);
        let (spring, damper) = (self.stiffness * (reached.abs() - self.half), self.damping * rate * along);
        let next = if spring < 0.0 {
            // A damper that alone carries the contact: with it there is none, and without it there is one.
            match self.touch {
                Touch::On(of) if self.came_back && f64::from(of) * rate > 0.0 => self.touch,
                _ => Touch::Gap,
            }
        } else if spring + damper < 0.0 {
            Touch::Parting(side)
        } else if self.is_soft && damper > spring {
            Touch::Limited(side)
        } else {
            Touch::On(side)
        };
        (next != self.touch).then_some(next)
    }

    /// Changes the contact within the search for that of the step.
    pub fn turn(&mut self, next: Touch) {
        self.came_back |= self.left && matches!(next, Touch::On(_));
        self.left |= matches!(self.touch, Touch::On(_));
        self.touch = next;
    }
}

/// Bits of a key that each contact takes.
const BITS: usize = 3;

/// Shafts that fit the key of a mode.
pub(super) const MOST_SHAFTS: usize = 64 / BITS;

/// Contacts by their number in a word.
const TOUCHES: [Touch; 7] = [
    Touch::Gap,
    Touch::On(-1),
    Touch::On(1),
    Touch::Limited(-1),
    Touch::Limited(1),
    Touch::Parting(-1),
    Touch::Parting(1),
];

/// The contacts as a word.
pub(in crate::dynamics) fn word(shafts: &[ShaftStep]) -> u64 {
    let code = |touch: Touch| match touch {
        Touch::Gap => 0,
        Touch::On(side) => 1 + u64::from(side > 0),
        Touch::Limited(side) => 3 + u64::from(side > 0),
        Touch::Parting(side) => 5 + u64::from(side > 0),
    };
    shafts.iter().fold(0, |word, shaft| word << BITS | code(shaft.touch))
}

/// Contact of the shaft that is so far from the last.
fn code(word: u64, from_last: usize) -> usize {
    (word >> (BITS * from_last)) as usize & ((1 << BITS) - 1)
}

/// Takes the contacts from a word.
pub(super) fn set_word(shafts: &mut [ShaftStep], word: u64) {
    shafts.iter_mut().rev().enumerate().for_each(|(k, shaft)| shaft.touch = TOUCHES[code(word, k)]);
}

/// The words in which one of so many contacts is another.
pub(super) fn others(word: u64, shafts: usize) -> impl Iterator<Item = u64> {
    (0..shafts).flat_map(move |k| {
        let without = word & !(((1 << BITS) - 1) << (BITS * k));
        (0..TOUCHES.len() as u64).filter(move |c| *c != code(word, k) as u64).map(move |c| without | c << (BITS * k))
    })
}
