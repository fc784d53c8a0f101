//! How answers are set for eyes: numbers, tables, lines. Styles are ANSI escapes; [`plain`] takes them off.

use comfy_table::{CellAlignment, Table, presets};
use willis::diagnostic::is_printable;

/// A speed in rpm, from rad/s.
pub fn rpm(rad_s: f64) -> f64 {
    rad_s * 30.0 / std::f64::consts::PI
}

/// A share as percent: two decimals, more where two would hide the loss or the efficiency.
pub fn percent(x: f64) -> String {
    let p = 100.0 * x;
    if (99.995..100.0).contains(&p) || (0.0 < p && p < 0.1) { format!("{p:.4} %") } else { format!("{p:.2} %") }
}

/// A number with so many significant digits, in plain notation where that is readable.
pub fn significant(x: f64, digits: i32) -> String {
    if x == 0.0 {
        return "0".into();
    }
    let size = x.abs().log10().floor() as i32;
    if !(-4..9).contains(&size) {
        return format!("{x:.*e}", digits as usize - 1);
    }
    let decimals = (digits - 1 - size).clamp(0, 8) as usize;
    let text = format!("{x:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// A count with its word: `1 mesh`, `2 meshes`.
pub fn plural(n: usize, one: &str, many: &str) -> String {
    format!("{n} {}", if n == 1 { one } else { many })
}

/// An empty table without lines.
pub fn table() -> Table {
    let mut t = Table::new();
    t.load_style(presets::NOTHING);
    t
}

/// Names the columns of a table.
pub fn set_header(t: &mut Table, names: &[&str]) {
    t.set_header(names.iter().copied());
    t.column_mut(0).expect("a table has a column").set_padding((2, 1));
}

/// The table with its header dimmed and no blanks at line ends.
pub fn show(t: &Table) -> String {
    let text = t.to_string();
    let mut lines = text.lines().map(str::trim_end);
    let header = dim(lines.next().unwrap_or_default());
    std::iter::once(header).chain(lines.map(String::from)).map(|l| l + "\n").collect()
}

/// Aligns columns to the right.
pub fn right(t: &mut Table, columns: std::ops::Range<usize>) {
    for k in columns {
        if let Some(c) = t.column_mut(k) {
            c.set_cell_alignment(CellAlignment::Right);
        }
    }
}

/// In bold.
pub fn bold(text: &str) -> String {
    format!("\u{1b}[1m{text}\u{1b}[0m")
}

/// Dimmed.
pub fn dim(text: &str) -> String {
    format!("\u{1b}[2m{text}\u{1b}[0m")
}

/// Breaks a line at 100 characters; the first line begins with `head`, the others are indented
/// as far. Control characters, which a terminal would obey, separate words and are dropped.
pub fn wrap(text: &str, head: &str) -> String {
    const WIDTH: usize = 100;
    let indent = " ".repeat(head.chars().count());
    let mut lines = vec![head.to_owned()];
    for word in text.split(|c: char| c.is_whitespace() || !is_printable(c)).filter(|w| !w.is_empty()) {
        let line = lines.last_mut().expect("never empty");
        let used = line.chars().count();
        let blank = used == indent.len();
        if !blank && used + 1 + word.chars().count() > WIDTH {
            lines.push(format!("{indent}{word}"));
        } else {
            if !blank {
                line.push(' ');
            }
            line.push_str(word);
        }
    }
    lines.join("\n")
}

/// The same without styles, for a file or a page.
pub fn plain(text: &str) -> String {
    anstream::adapter::strip_str(text).to_string()
}

/// Width of the longest bar.
const BAR: usize = 28;

/// A bar of that part of the full length.
pub fn bar(part: f64) -> String {
    let eighths = (part * (BAR * 8) as f64).round() as usize;
    let rest = [' ', '▏', '▎', '▍', '▌', '▋', '▊', '▉'][eighths % 8];
    let mut text = "█".repeat(eighths / 8);
    if rest != ' ' {
        text.push(rest);
    }
    text
}

/// As a shell takes it.
pub fn quoted(text: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=:".contains(c);
    match !text.is_empty() && text.chars().all(plain) {
        true => text.to_owned(),
        false => format!("'{}'", text.replace('\'', "'\\''")),
    }
}
