//! Runs that are stepped together, and room for what a step of them needs.

use crate::dynamics::engine::Touch;
use crate::dynamics::mode::Side;
use crate::dynamics::report::Outcome;

use super::lanes::{LANES, Lanes, Mask};
use super::reach::Reach;

/// Runs that are stepped together.
pub(super) struct Block {
    /// Speeds of the coordinates, and angles with integrals.
    pub v: Vec<Lanes>,
    pub rest: Vec<Lanes>,
    /// What enters a step, and by what that is multiplied.
    pub inputs: Vec<Lanes>,
    pub factors: Vec<Lanes>,
    /// Of the present mode: the part of level inputs, and the round-off of each row.
    pub base: Vec<Lanes>,
    pub least: Vec<Lanes>,
    pub reach: Reach,
    /// Modes of the runs one after another.
    pub sign: Vec<i8>,
    pub side: Vec<Side>,
    pub touch: Vec<Touch>,
    pub present: [Option<u32>; LANES],
    /// Whether that is the same in all of them.
    pub uniform: bool,
    /// What a step looks at growth by, in each run, and why some of them ended.
    pub bound: Lanes,
    pub turns: [u32; LANES],
    pub verdict: [Option<Outcome>; LANES],
    /// Those, as bits.
    pub ended: Mask,
}

/// Room for speeds with inputs, for inputs that are not level, and for the ends of a step; where a block cruises, for speeds with
/// inputs of the next step.
#[derive(Default)]
pub(super) struct Room {
    pub x: Vec<Lanes>,
    pub entering: Vec<Lanes>,
    pub ends: Vec<Lanes>,
}
