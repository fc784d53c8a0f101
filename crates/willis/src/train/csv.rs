//! The grammar of every table that is read: commas between cells, decimal points, quotes where a cell has a comma in it.
//! Empty lines and lines that begin with `#` are skipped; the first line left is the header.

use std::ops::Range;

use super::words::clip;

/// After so many bad cells the file is another one than was meant.
const MOST_ERRORS: usize = 5;

/// A line with something in it.
pub(crate) struct Row<'t> {
    /// Counted from 1.
    pub line: usize,
    /// Where it stands, in bytes of the text.
    pub span: Range<usize>,
    pub cells: Vec<Cell<'t>>,
}

/// A cell without blanks and quotes around it.
pub(crate) struct Cell<'t> {
    pub text: &'t str,
    pub span: Range<usize>,
}

/// The rows of a text, its header first.
pub(crate) fn rows(text: &str) -> impl Iterator<Item = Row<'_>> {
    let mut at = 0;
    text.split_inclusive('\n').enumerate().filter_map(move |(k, line)| {
        let start = at;
        at += line.len();
        let mark = if start == 0 && line.starts_with('\u{feff}') { '\u{feff}'.len_utf8() } else { 0 };
        let (line, start) = (line[mark..].trim_end_matches(['\n', '\r']), start + mark);
        let is_row = !line.trim().is_empty() && !line.trim_start().starts_with('#');
        is_row.then(|| Row { line: k + 1, span: start..start + line.len(), cells: cells(line, start) })
    })
}

/// Cells of a line that begins at `at`.
fn cells(line: &str, at: usize) -> Vec<Cell<'_>> {
    let mut all = vec![];
    let (mut from, mut quoted) = (0, false);
    let mut push = |from: usize, to: usize| {
        let raw = &line[from..to];
        let inner = raw.trim();
        let start = from + (raw.len() - raw.trim_start().len());
        let (text, start) = match inner.strip_prefix('"').and_then(|c| c.strip_suffix('"')) {
            Some(bare) => (bare.trim(), start + 1),
            None => (inner, start),
        };
        all.push(Cell { text, span: at + start..at + start + text.len() });
    };
    for (k, b) in line.bytes().enumerate() {
        match b {
            b'"' => quoted = !quoted,
            b',' if !quoted => {
                push(from, k);
                from = k + 1;
            }
            _ => {}
        }
    }
    push(from, line.len());
    all
}

/// A finite number as the train file would write it.
pub(crate) fn number(cell: &str) -> Result<f64, String> {
    let plain = cell.bytes().all(|b| b.is_ascii_digit() || matches!(b, b'.' | b'+' | b'-' | b'e' | b'E'));
    match cell.parse::<f64>() {
        _ if cell.is_empty() => Err("the cell is empty".into()),
        Ok(x) if plain && x.is_finite() => Ok(x),
        _ => Err(format!("`{}` is no finite number", clip(cell))),
    }
}

/// The points of two columns, or what is wrong with them, each with its line.
pub(super) fn points(text: &str, columns: [&str; 2]) -> Result<Vec<[f64; 2]>, Vec<String>> {
    let mut rows = rows(text);
    let Some(header) = rows.next() else { return Err(vec!["the file is empty".into()]) };
    let header: Vec<&str> = header.cells.iter().map(|c| c.text).collect();
    let [time, value] = columns.map(|name| header.iter().position(|h| *h == name).ok_or(name));
    let (time, value) = match (time, value) {
        (Ok(time), Ok(value)) => (time, value),
        (time, value) => {
            return Err([time, value].iter().filter_map(|c| Some(no_column(c.err()?, &header))).collect());
        }
    };
    let mut points: Vec<[f64; 2]> = Vec::new();
    let mut wrong = Vec::new();
    for Row { line, cells, .. } in rows {
        if wrong.len() >= MOST_ERRORS {
            break;
        }
        if cells.len() != header.len() {
            wrong.push(format!("line {line} has {} cells, the header has {}", cells.len(), header.len()));
            continue;
        }
        let [t, x] = [time, value]
            .map(|c| number(cells[c].text).map_err(|e| format!("line {line}, column `{}`: {e}", clip(header[c]))));
        match (t, x) {
            (Ok(t), Ok(_)) if points.last().is_some_and(|p| t < p[0]) => {
                let before = points.last().map_or(0.0, |p| p[0]);
                wrong.push(format!("line {line}: the time {t} s lies before {before} s in the row above"));
            }
            (Ok(t), Ok(x)) => points.push([t, x]),
            (t, x) => wrong.extend([t.err(), x.err()].into_iter().flatten()),
        }
    }
    if points.is_empty() && wrong.is_empty() {
        wrong.push("there is no row below the header".into());
    }
    if wrong.is_empty() { Ok(points) } else { Err(wrong) }
}

fn no_column(name: &str, header: &[&str]) -> String {
    const MOST_NAMES: usize = 12;
    let known: Vec<String> = header.iter().take(MOST_NAMES).map(|h| format!("`{}`", clip(h))).collect();
    let separator = if header.len() == 1 && header[0].contains(';') { "; commas separate columns" } else { "" };
    format!("there is no column `{}`; the header has {}{separator}", clip(name), known.join(", "))
}
