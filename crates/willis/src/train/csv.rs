//! The grammar of every table that is read: commas, semicolons or tabs between cells, whichever the header has; quotes
//! where a cell has one of them in it. Empty lines and lines that begin with `#` are skipped; the first line left is the
//! header. Where no commas separate, a number may have a decimal comma.

use std::ops::Range;

use super::words::clip;

/// Columns of a table. What has more is another file than was meant, and would only cost memory.
pub(crate) const MOST_COLUMNS: usize = 4096;

/// After so many bad cells the file is another one than was meant.
const MOST_ERRORS: usize = 5;

/// A line with something in it.
pub(crate) struct Row<'t> {
    /// Counted from 1.
    pub line: usize,
    /// Where it stands, in bytes of the text.
    pub span: Range<usize>,
    /// Those within [`MOST_COLUMNS`].
    pub cells: Vec<Cell<'t>>,
    /// How many cells there are.
    pub count: usize,
    /// What separates them.
    separator: u8,
}

/// A cell without blanks and quotes around it.
pub(crate) struct Cell<'t> {
    pub text: &'t str,
    pub span: Range<usize>,
}

impl Row<'_> {
    /// What separates the cells.
    pub fn separator(&self) -> char {
        char::from(self.separator)
    }

    /// A finite number in a cell, as the train file would write it: with a decimal point.
    pub fn number(&self, cell: &str) -> Result<String, Unread> {
        // A true minus, as some programs write it.
        let mut plain = cell.replace('\u{2212}', "-");
        if self.separator != b',' && plain.contains(',') {
            if plain.contains('.') || plain.matches(',').count() > 1 {
                return Err(Unread::Thousands);
            }
            plain = plain.replace(',', ".");
        }
        let is_plain = plain.bytes().all(|b| b.is_ascii_digit() || matches!(b, b'.' | b'+' | b'-' | b'e' | b'E'));
        match plain.parse::<f64>() {
            _ if plain.is_empty() => Err(Unread::Empty),
            Ok(x) if is_plain && x.is_finite() => Ok(plain.strip_prefix('+').unwrap_or(&plain).to_owned()),
            _ => Err(Unread::NoNumber),
        }
    }

    /// The same as a number.
    pub fn value(&self, cell: &str) -> Result<f64, Unread> {
        Ok(self.number(cell)?.parse().expect("it was just read"))
    }
}

/// Why a cell is no number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Unread {
    Empty,
    NoNumber,
    Thousands,
}

impl Unread {
    /// In words that show the cell.
    pub fn of(self, cell: &str) -> String {
        match self {
            Self::Empty => "the cell is empty".into(),
            Self::NoNumber => format!("`{}` is no finite number", clip(cell)),
            Self::Thousands => format!("`{}` has marks between its digits; write it without them", clip(cell)),
        }
    }

    /// In words that show nothing of the file.
    fn unseen(self) -> &'static str {
        match self {
            Self::Empty => "the cell is empty",
            Self::NoNumber => "the cell is no finite number",
            Self::Thousands => "the cell has marks between its digits; write it without them",
        }
    }
}

/// The rows of a text, its header first.
pub(crate) fn rows(text: &str) -> impl Iterator<Item = Row<'_>> {
    let mut at = 0;
    let mut separator = None;
    text.split_inclusive('\n').enumerate().filter_map(move |(k, line)| {
        let start = at;
        at += line.len();
        let mark = if start == 0 && line.starts_with('\u{feff}') { '\u{feff}'.len_utf8() } else { 0 };
        let (line, start) = (line[mark..].trim_end_matches(['\n', '\r']), start + mark);
        if line.trim().is_empty() || line.trim_start().starts_with('#') {
            return None;
        }
        let separator = *separator.get_or_insert_with(|| separator_of(line));
        // A tab at either end is an empty cell, where tabs separate.
        let (cells, count) = cells(line, start, separator);
        Some(Row { line: k + 1, span: start..start + line.len(), cells, count, separator })
    })
}

/// What separates the cells of a header: whatever makes most of them, a comma where nothing does.
fn separator_of(header: &str) -> u8 {
    let mut counts = [(b',', 0usize), (b';', 0), (b'\t', 0)];
    let mut quoted = false;
    for b in header.bytes() {
        quoted ^= b == b'"';
        if let Some(own) = counts.iter_mut().find(|c| c.0 == b && !quoted) {
            own.1 += 1;
        }
    }
    counts.into_iter().rev().max_by_key(|c| c.1).map_or(b',', |c| c.0)
}

/// Cells of a line that begins at `at`, and how many there are.
fn cells(line: &str, at: usize, separator: u8) -> (Vec<Cell<'_>>, usize) {
    let mut all = vec![];
    let (mut from, mut quoted, mut count) = (0, false, 0);
    let mut push = |from: usize, to: usize| {
        count += 1;
        if count > MOST_COLUMNS {
            return;
        }
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
            b if b == separator && !quoted => {
                push(from, k);
                from = k + 1;
            }
            _ => {}
        }
    }
    push(from, line.len());
    (all, count)
}

/// The points of two columns, or what is wrong with them, each with its line. Nothing of the text is shown: a train file
/// from somebody else may name any file as its table.
pub(super) fn points(text: &str, columns: [&str; 2]) -> Result<Vec<[f64; 2]>, Vec<String>> {
    let mut rows = rows(text);
    let Some(header) = rows.next() else { return Err(vec!["the file is empty".into()]) };
    if header.count > MOST_COLUMNS {
        return Err(vec![too_many(header.count)]);
    }
    let found = columns.map(|name| header.cells.iter().position(|c| c.text == name).ok_or(name));
    let [Ok(time), Ok(value)] = found else {
        let missing = found.into_iter().filter_map(Result::err);
        let told = missing.map(|name| {
            let s = if header.count == 1 { "" } else { "s" };
            format!("there is no column `{}` among the {} column{s} of line {}", clip(name), header.count, header.line)
        });
        return Err(told.collect());
    };
    let mut points: Vec<[f64; 2]> = Vec::new();
    let mut wrong = Vec::new();
    for row in rows {
        let line = row.line;
        if wrong.len() >= MOST_ERRORS {
            break;
        }
        if row.count != header.count {
            wrong.push(format!("line {line} has {} cells, the header has {}", row.count, header.count));
            continue;
        }
        let read = [time, value].map(|c| {
            let told = |why: Unread| format!("line {line}, column `{}`: {}", clip(header.cells[c].text), why.unseen());
            row.value(row.cells[c].text).map_err(told)
        });
        match read {
            [Ok(t), Ok(_)] if points.last().is_some_and(|p| t < p[0]) => {
                wrong.push(format!("line {line}: the time lies before that of the row above"));
            }
            [Ok(t), Ok(x)] => points.push([t, x]),
            read => wrong.extend(read.into_iter().filter_map(Result::err)),
        }
    }
    if points.is_empty() && wrong.is_empty() {
        wrong.push("there is no row below the header".into());
    }
    if wrong.is_empty() { Ok(points) } else { Err(wrong) }
}

/// Why a header is not read.
pub(crate) fn too_many(columns: usize) -> String {
    format!("the header has {columns} columns; a table has at most {MOST_COLUMNS}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whatever_separates_in_the_header_separates() {
        let all = |text: &str| -> Vec<Vec<String>> {
            rows(text).map(|r| r.cells.iter().map(|c| c.text.to_owned()).collect()).collect()
        };
        let same = [vec!["a".to_owned(), "b, c".into()], vec!["1".into(), "2".into()]];
        assert_eq!(all("a,\"b, c\"\n1,2\n"), same);
        assert_eq!(all("a;\"b, c\"\n1;2\n"), same);
        assert_eq!(all("a;b, c;d\n")[0], ["a", "b, c", "d"]);
        assert_eq!(all("# x\n\u{feff}\na\tb, c\r\n1\t2"), [vec!["\u{feff}"], vec!["a\tb", "c"], vec!["1\t2"]]);
        assert_eq!(all("a\t\"b, c\"\r\n1\t2"), same);
        // One column has no separator.
        assert_eq!(all("a\n1,5"), [vec!["a"], vec!["1", "5"]]);
    }

    #[test]
    fn a_decimal_comma_is_read_where_no_commas_separate() {
        let row = |text: &'static str| rows(text).next().unwrap();
        let semicolons = row("a;b");
        for (cell, value) in [("1,5", 1.5), ("-0,25", -0.25), ("+1,5e3", 1500.0), ("\u{2212}2", -2.0), ("1.5", 1.5)] {
            assert_eq!(semicolons.value(cell), Ok(value), "{cell}");
        }
        assert_eq!(semicolons.value("1.234,5"), Err(Unread::Thousands));
        assert_eq!(semicolons.value("1,234,567"), Err(Unread::Thousands));
        for cell in ["nan", "inf", "1e999", "0x1", "1_0", "1 0", "x"] {
            assert_eq!(semicolons.value(cell), Err(Unread::NoNumber), "{cell}");
        }
        assert_eq!(row("a,b").value("1,5"), Err(Unread::NoNumber));
        assert_eq!(row("a,b").value(""), Err(Unread::Empty));
    }

    #[test]
    fn cells_beyond_the_most_are_only_counted() {
        let text = ",".repeat(1_000_000);
        let row = rows(&text).next().unwrap();
        assert_eq!((row.cells.len(), row.count), (MOST_COLUMNS, 1_000_001));
        assert!(points(&text, ["t", "x"]).unwrap_err()[0].contains("1000001 columns"));
    }
}
