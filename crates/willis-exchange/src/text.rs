//! Texts of train files.

use willis::diagnostic::printable;

/// A text in quotes.
pub fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            c if (c as u32) < 0x20 || c as u32 == 0x7f => out.push_str(&format!("\\u{:04X}", c as u32)),
            c => out.push(c),
        }
    }
    out + "\""
}

/// A key: bare where it may be.
pub fn key(text: &str) -> String {
    let is_bare = !text.is_empty() && text.bytes().all(|b| b.is_ascii_alphanumeric() || b"-_".contains(&b));
    if is_bare { text.to_owned() } else { quoted(text) }
}

/// A number with its unit, in quotes.
pub fn quantity(x: f64, unit: &str) -> String {
    format!("\"{} {unit}\"", plain(x))
}

/// A number without an exponent where it can be read without.
pub fn plain(x: f64) -> String {
    if x != 0.0 && !(1e-6..1e15).contains(&x.abs()) { format!("{x:e}") } else { x.to_string() }
}

/// A number that TOML takes for one with a fraction.
pub fn number(x: f64) -> String {
    let text = plain(x);
    if text.contains(['.', 'e']) { text } else { text + ".0" }
}

/// One line of a comment.
pub fn comment(text: &str) -> String {
    let line: String = printable(text).chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    format!("# {line}\n")
}

/// A name as trains have it: no dot, nothing that cannot be shown, not too long, and not that of another one.
pub fn name(wanted: &str, instead: &str, taken: &mut Vec<String>) -> String {
    /// Names have 64 characters at most; some are for a number behind.
    const MOST: usize = 56;
    let plain = printable(wanted.trim());
    let clean: String = plain.chars().map(|c| if c == '.' || c.is_control() { '-' } else { c }).take(MOST).collect();
    let clean = match clean.trim() {
        "" | "frame" => instead.to_owned(),
        clean => clean.to_owned(),
    };
    let free = |n: &String| !taken.contains(n);
    let found = Some(clean.clone()).filter(free);
    let found = found.unwrap_or_else(|| (2..).map(|k| format!("{clean} {k}")).find(free).expect("numbers do not end"));
    taken.push(found.clone());
    found
}
