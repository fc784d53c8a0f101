//! Numbers and names as other programs read them.

use crate::analysis::Verdict;
use crate::diagnostic::is_printable;

/// The shortest text that reads back as the same number.
pub fn number(x: f64) -> String {
    // Adding zero turns -0.0 into 0.0; a whole number needs no decimals.
    let text = format!("{:?}", x + 0.0);
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

/// A number for a sentence.
pub fn short(x: f64) -> String {
    let digits = if x == 0.0 { 0 } else { (5 - x.abs().log10().floor() as i32).clamp(0, 12) as usize };
    let text = format!("{x:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// A percentage for a sentence.
pub fn percent(x: f64) -> String {
    format!("{:.2} %", 100.0 * x)
}

/// Text of the file on one line, printable: a comment must not end early.
pub fn line(text: &str) -> String {
    text.chars().map(|c| if is_printable(c) { c } else { ' ' }).collect()
}

/// The same inside an XML comment or attribute.
pub fn xml(text: &str) -> String {
    let escaped = line(text).replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;");
    // Two hyphens end a comment.
    let mut out = escaped.replace("--", "- -");
    while out.contains("--") {
        out = out.replace("--", "- -");
    }
    if out.ends_with('-') { out + " " } else { out }
}

/// Letters, digits and hyphens: for the name of a file.
pub fn slug(text: &str) -> String {
    let mut out = String::new();
    for c in text.to_lowercase().chars() {
        if c.is_alphanumeric() {
            out.push(c);
        } else if !out.is_empty() && !out.ends_with('-') {
            out.push('-');
        }
    }
    let out: String = out.chars().take(40).collect();
    let out = out.trim_end_matches('-').to_owned();
    if out.is_empty() { "train".into() } else { out }
}

/// The name of a file for a state of a train.
pub fn file(train: &str, state: Option<&str>, ending: &str) -> String {
    match state {
        Some(state) => format!("{}-{}.{ending}", slug(train), slug(state)),
        None => format!("{}.{ending}", slug(train)),
    }
}

/// Letters, digits and underscores, not beginning with a digit, none of `reserved`: an identifier of Modelica, MATLAB.
pub fn identifier(text: &str, reserved: &[&str]) -> String {
    let mut out: String = text.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    if !out.starts_with(|c: char| c.is_ascii_alphabetic()) {
        out.insert(0, 'x');
    }
    out.truncate(50);
    if reserved.contains(&out.as_str()) {
        out.push('_');
    }
    out
}

/// Identifiers that differ from each other.
pub fn identifiers<'a>(all: impl IntoIterator<Item = &'a str>, reserved: &[&str]) -> Vec<String> {
    let mut out: Vec<String> = Vec::new();
    for text in all {
        let wish = identifier(text, reserved);
        let mut own = wish.clone();
        let mut k = 2;
        while out.contains(&own) {
            own = format!("{wish}_{k}");
            k += 1;
        }
        out.push(own);
    }
    out
}

/// The word of the results contract.
pub fn verdict(v: Verdict) -> &'static str {
    match v {
        Verdict::Unique => "unique",
        Verdict::Multiple => "multiple",
        Verdict::Locked => "locked",
        Verdict::Unloaded => "unloaded",
        Verdict::Undetermined => "undetermined",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_for_other_programs() {
        assert_eq!(slug("ZF 8HP70: (pilot)"), "zf-8hp70-pilot");
        assert_eq!(slug("---"), "train");
        assert_eq!(identifier("input", &["input"]), "input_");
        assert_eq!(identifier("2nd gear", &[]), "x2nd_gear");
        assert_eq!(identifiers(["a b", "a_b", "a-b"], &[]), ["a_b", "a_b_2", "a_b_3"]);
        assert_eq!(xml("a -- <b> & \"c\" -"), "a - - &lt;b&gt; &amp; &quot;c&quot; - ");
        assert!(!xml("-----").contains("--"));
        assert_eq!([number(-0.0), number(2.0), number(0.1)], ["0", "2", "0.1"]);
        assert_eq!([short(0.0), short(1591.549), short(2.0)], ["0", "1591.55", "2"]);
    }
}
