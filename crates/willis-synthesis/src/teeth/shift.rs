//! Profile shifts.

use super::layout::SetKind;

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Rack;

impl Rack {
    pub fn with_angle(_angle: Option<f64>) -> Self {
        Self
    }
}

pub(crate) fn shifts(_kind: SetKind, _teeth: &[i64], _rack: Rack) -> Option<Vec<f64>> {
    None
}
