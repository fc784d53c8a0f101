//! Words of users in messages.

use crate::diagnostic::printable;

/// Text from the user, short enough for a message.
pub(super) fn clip(text: &str) -> String {
    // What a terminal would obey is shown instead.
    let text = printable(text);
    if text.chars().count() > 64 { text.chars().take(64).chain(['…']).collect() } else { text.into_owned() }
}

/// Names for a hint, not more than fit a line.
pub(super) fn list(names: Vec<&str>) -> String {
    const MOST: usize = 12;
    let mut text = names.iter().take(MOST).copied().collect::<Vec<_>>().join(", ");
    if names.len() > MOST {
        text += ", …";
    }
    text
}
