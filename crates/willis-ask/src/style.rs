//! How answers are set for eyes: numbers, tables, lines. Styles are ANSI escapes; [`plain`] takes them off.

use comfy_table::{CellAlignment, Table, presets};
use willis::analysis::{BandEnd, LawBand, OutsideLaw};
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

/// An efficiency with what other laws of loss make of it, in the digits that they support:
/// `98.4 %; 97.6 to 99.3 % over laws in range`. Laws in force that are outside their ranges are named.
pub fn efficiency(value: f64, band: Option<&LawBand>, outside: &[OutsideLaw]) -> String {
    let mut text = match band {
        None => percent(value),
        Some(band) => {
            let decimals = band.decimals();
            let [value, low, high] =
                [value, band.low.efficiency, band.high.efficiency].map(|e| format!("{:.decimals$}", 100.0 * e));
            let which = if band.beyond_ranges() { "laws, some outside their ranges" } else { "laws in range" };
            format!("{value} %; {low} to {high} % over {which}")
        }
    };
    let mut laws: Vec<(String, Vec<&str>)> = vec![];
    // A film says how teeth run, and its own warning says so; what they lose is what friction says.
    for o in outside.iter().filter(|o| !o.family.starts_with("film")) {
        let law = format!("{} = {}", o.family, o.law);
        match laws.iter_mut().find(|l| l.0 == law) {
            Some(own) => own.1.push(&o.symbol),
            None => laws.push((law, vec![&o.symbol])),
        }
    }
    for (law, symbols) in laws {
        text += &format!("; {law} outside its range in {}", symbols.join(", "));
    }
    text
}

/// The same in a cell of a table: `98.4 % (97.6..99.3)`.
pub fn efficiency_cell(value: f64, band: Option<&LawBand>) -> String {
    let Some(band) = band else { return percent(value) };
    let decimals = band.decimals();
    let [value, low, high] =
        [value, band.low.efficiency, band.high.efficiency].map(|e| format!("{:.decimals$}", 100.0 * e));
    format!("{value} % ({low}..{high})")
}

/// The laws at both ends of a band: `97.6 % by mesh_friction = constant; 99.3 % by …`.
pub fn band_ends(band: &LawBand) -> String {
    let decimals = band.decimals();
    let end = |end: &BandEnd| {
        let laws: Vec<String> = end.laws.iter().map(|(family, law)| format!("{family} = {law}")).collect();
        format!("{:.decimals$} % by {}", 100.0 * end.efficiency, laws.join(", "))
    };
    format!("{}; {}", end(&band.low), end(&band.high))
}

/// What is assumed, one a line under a heading.
pub fn assumptions(all: &[String]) -> String {
    let lines = all.iter().map(|line| wrap(line, "  · ") + "\n");
    std::iter::once(bold("Assumptions in force") + "\n").chain(lines).collect()
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
