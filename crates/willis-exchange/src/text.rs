//! Texts of train files.

use std::collections::{HashMap, HashSet};

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

/// Names that are given away.
#[derive(Default)]
pub struct Taken {
    names: HashSet<String>,
    /// The number that the next one of that name is tried with.
    next: HashMap<String, usize>,
}

impl Taken {
    /// One name that none may have.
    pub fn with(name: &str) -> Self {
        Self { names: HashSet::from([name.to_owned()]), next: HashMap::new() }
    }

    pub fn len(&self) -> usize {
        self.names.len()
    }
}

/// A name as trains have it: no dot, nothing that cannot be shown, not too long, and not that of another one.
pub fn name(wanted: &str, instead: &str, taken: &mut Taken) -> String {
    /// Names have 64 characters at most; some are for a number behind.
    const MOST: usize = 56;
    let plain = printable(wanted.trim());
    let clean: String = plain.chars().map(|c| if c == '.' || c.is_control() { '-' } else { c }).take(MOST).collect();
    let clean = match clean.trim() {
        "" | "frame" => instead.to_owned(),
        clean => clean.to_owned(),
    };
    let mut found = clean.clone();
    if taken.names.contains(&found) {
        let next = taken.next.entry(clean.clone()).or_insert(2);
        loop {
            found = format!("{clean} {next}");
            *next += 1;
            if !taken.names.contains(&found) {
                break;
            }
        }
    }
    taken.names.insert(found.clone());
    found
}
