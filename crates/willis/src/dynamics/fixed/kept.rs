//! A step that is kept while another mode is tried.

use crate::dynamics::mode::Side;

/// A mode and the end of a step in it.
#[derive(Clone, Default)]
pub(super) struct Kept {
    pub sign: Vec<i8>,
    pub side: Vec<Side>,
    pub next: Vec<f64>,
    pub tau: Vec<f64>,
}
