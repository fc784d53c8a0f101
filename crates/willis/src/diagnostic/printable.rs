//! Which characters may stand in names and reach a terminal or a picture.

use std::borrow::Cow;

/// Whether a character can be shown as it is: no control character (a terminal obeys them, those from U+0080 to U+009F too),
/// none that turns the direction of writing (text would be read otherwise than it is), no line or paragraph separator, and
/// no code point that is no character (XML has no place for those).
///
/// Joiners of letters (U+200C, U+200D) are printable: names in some scripts need them.
///
/// Sources: Unicode Standard, section 23.1 (control codes), 23.7 (noncharacters); Unicode Standard Annex 9, table of
/// explicit directional formatting characters.
pub fn is_printable(c: char) -> bool {
    let turns = matches!(c, '\u{061c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    let separates = matches!(c, '\u{2028}' | '\u{2029}');
    let is_none = matches!(c, '\u{fdd0}'..='\u{fdef}') || (c as u32) & 0xfffe == 0xfffe;
    !(c.is_control() || turns || separates || is_none)
}

/// The text with an escape, `\u{9b}`, for every character that is not [printable](is_printable).
///
/// # Example
/// ```
/// use willis::diagnostic::printable;
///
/// assert_eq!(printable("gear 3"), "gear 3");
/// assert_eq!(printable("\u{9b}31m"), "\\u{9b}31m");
/// assert_eq!(printable("a\tb\u{202e}"), "a\\tb\\u{202e}");
/// ```
pub fn printable(text: &str) -> Cow<'_, str> {
    if text.chars().all(is_printable) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        match c {
            c if is_printable(c) => out.push(c),
            '\t' | '\r' | '\n' | '\0' => out.extend(c.escape_default()),
            c => out.extend(c.escape_unicode()),
        }
    }
    Cow::Owned(out)
}

/// A text with marks for what is not printable, as lines still, and where a part of it went.
pub(super) fn excerpt(text: &str, part: std::ops::Range<usize>) -> (Cow<'_, str>, std::ops::Range<usize>) {
    let keeps = |c: char| is_printable(c) || matches!(c, '\n' | '\r' | '\t');
    if text.chars().all(keeps) {
        return (Cow::Borrowed(text), part);
    }
    const MARK: char = '\u{fffd}';
    let mut out = String::with_capacity(text.len() + 16);
    let (mut start, mut end) = (part.start, part.end);
    for (at, c) in text.char_indices() {
        if at == part.start {
            start = out.len();
        }
        if at == part.end {
            end = out.len();
        }
        out.push(if keeps(c) { c } else { MARK });
    }
    if part.start == text.len() {
        start = out.len();
    }
    if part.end == text.len() {
        end = out.len();
    }
    (Cow::Owned(out), start..end)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_shown_is_escaped_and_the_rest_stays() {
        for c in [
            '\0',
            '\u{1b}',
            '\u{7f}',
            '\u{80}',
            '\u{9b}',
            '\u{202e}',
            '\u{2066}',
            '\u{200f}',
            '\u{2028}',
            '\u{fdd0}',
            '\u{ffff}',
            '\u{1fffe}',
            '\u{10ffff}',
        ] {
            assert!(!is_printable(c), "{c:?}");
            assert!(printable(&c.to_string()).chars().all(is_printable));
        }
        for c in ['a', 'é', '齿', '😀', '\u{200d}', '\u{301}', '\u{fffd}', ' ', '\u{a0}'] {
            assert!(is_printable(c), "{c:?}");
        }
    }

    #[test]
    fn an_excerpt_keeps_its_part() {
        let text = "a\u{9b}b = \"\u{202e}x\u{ffff}\"\n";
        let from = text.find('"').unwrap();
        let to = text.rfind('"').unwrap() + 1;
        let (shown, part) = excerpt(text, from..to);
        assert_eq!(&shown[part], "\"\u{fffd}x\u{fffd}\"");
        assert!(shown.chars().all(|c| is_printable(c) || c == '\n'));
        let (_, whole) = excerpt(text, 0..text.len());
        assert_eq!(whole, 0..shown.len());
    }
}
