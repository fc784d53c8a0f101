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
    let mut engaged = Vec::new();
    match state {
        None | Some("as drawn") => {}
        Some(name) => match train.state(name) {
            Some(state) => engaged.clone_from(&state.engaged),
            None => {
                let known: Vec<_> = train.states.iter().map(|s| s.name.as_str()).chain(["as drawn"]).collect();
                let d = Diagnostic::new(Code::UnknownSelection, "", format!("the train has no state `{name}`"));
                wrong
                    .push(d.suggest(name, known.iter().copied()).hint(format!("its states are: {}", known.join(", "))));
            }
        },
    }
    let mut held = Vec::new();
    for name in fixed {
        match train.member(name) {
            Some(member) => held.push(member),
            None => {
                let d = Diagnostic::new(Code::UnknownName, "", format!("the train has no member `{name}`"));
                wrong.push(d.suggest(name, train.members.iter().map(|m| m.name.as_str())));
            }
        }
    }
    if wrong.has_errors() { Err(wrong) } else { Ok((engaged, held)) }
}
