//! The state of the shift table and the members held, by name.

use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::train::{MemberId, ShiftElementId, Train};

/// The shift elements engaged in a state and the members held.
pub(super) fn selection(
    train: &Train,
    state: Option<&str>,
    fixed: &[&str],
) -> Result<(Vec<ShiftElementId>, Vec<MemberId>), Diagnostics> {
    let mut wrong = Diagnostics::default();
    let engaged = match train.find_configuration(state) {
        Ok(state) => state.map_or_else(Vec::new, |s| s.engaged.clone()),
        Err(d) => {
            wrong.push(*d);
            vec![]
        }
    };
    let mut held = Vec::new();
    for name in fixed {
        match train.member(name) {
            Some(member) => held.push(member),
            None => {
                let known = train.members.iter().map(|m| m.name.as_str());
                wrong.push(Diagnostic::missing(Code::UnknownName, "member", name, known));
            }
        }
    }
    if wrong.has_errors() { Err(wrong) } else { Ok((engaged, held)) }
}
