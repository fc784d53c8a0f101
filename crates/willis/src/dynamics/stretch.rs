//! What a stretch has in common: one mode, and one smooth piece of every signal.
//!
//! Most of what acts at a state then acts at every other one too, a constant torque or what rubs as hard at every speed.
//! That is kept for the stretch, with the list of what else has to be asked and of what has to be watched.

use super::mode::Mode;

/// What is watched within a mode: it changes where a margin becomes negative.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Watch {
    /// A sliding group comes to rest.
    Slip(usize),
    /// A held group breaks away, forward or backward; 0: either way.
    Hold(usize, i8),
    /// Something of what is held breaks away, decided for all of it together.
    Rest,
    /// The drive of an element reverses.
    Side(usize),
    /// A backlash or its damper changes.
    Touch(usize),
    /// The ratio of a variator reaches a limit, or leaves it.
    End(usize),
    /// A shift element begins or ceases to be engaged.
    Engage(usize),
}

/// Torques of the ports that do not change, and where those come from that do.
#[derive(Clone)]
pub(super) struct Steady {
    /// The mode, and the end of the piece.
    pub mode: Mode,
    pub segment: f64,
    /// The time that says which piece it is of.
    pub inside: f64,
    /// Torques of the ports; zero where they change.
    pub tau: Vec<f64>,
    pub sources: Vec<(usize, usize)>,
    /// Friction elements with a part in proportion to their speed, and those whose other part changes.
    pub viscous: Vec<usize>,
    pub sliding: Vec<usize>,
    pub elements: Vec<usize>,
    /// How far friction elements are engaged, where that does not change.
    pub engaged: Vec<Option<f64>>,
    /// What is watched.
    pub watches: Vec<Watch>,
    /// All of it as one map, where it is affine.
    pub affine: Option<Affine>,
}

/// A margin, as a row of the map.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    pub watch: Watch,
    /// Its round-off over the amounts of which it is the sum, and the amounts in its constant.
    pub noise: f64,
    pub constant: f64,
}

/// A stretch as one affine map of the speeds and of what sources give.
#[derive(Clone)]
pub(super) struct Affine {
    /// Sources whose torque changes.
    pub sources: Vec<usize>,
    /// One, speeds, torques of those sources.
    pub given: Vec<f64>,
    /// Rows over what is given: accelerations of the free coordinates.
    pub rates: Vec<f64>,
    /// Margins, and their rows; none if something is watched that is no affine margin.
    pub margins: Option<(Vec<Line>, Vec<f64>)>,
}
