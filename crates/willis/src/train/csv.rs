//! Columns of a CSV file: a header row, commas, numbers with a decimal point.

use super::words::clip;

/// After so many bad cells the file is another one than was meant.
const MOST_ERRORS: usize = 5;

/// The points of two columns, or what is wrong with them, each with its line.
pub(super) fn points(text: &str, columns: [&str; 2]) -> Result<Vec<[f64; 2]>, Vec<String>> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut lines = text.lines().enumerate().filter(|(_, l)| !l.trim().is_empty());
    let Some((_, header)) = lines.next() else { return Err(vec!["the file is empty".into()]) };
    let header: Vec<&str> = header.split(',').map(bare).collect();
    let [time, value] = columns.map(|name| header.iter().position(|h| *h == name).ok_or(name));
    let (time, value) = match (time, value) {
        (Ok(time), Ok(value)) => (time, value),
        (time, value) => {
            return Err([time, value].iter().filter_map(|c| Some(no_column(c.err()?, &header))).collect());
        }
    };
    let mut points: Vec<[f64; 2]> = Vec::new();
    let mut wrong = Vec::new();
    for (k, line) in lines {
        if wrong.len() >= MOST_ERRORS {
            break;
        }
        let line_number = k + 1;
        let cells: Vec<&str> = line.split(',').map(bare).collect();
        if cells.len() != header.len() {
            wrong.push(format!("line {line_number} has {} cells, the header has {}", cells.len(), header.len()));
            continue;
        }
        let [t, x] = [time, value]
            .map(|c| number(cells[c]).map_err(|e| format!("line {line_number}, column `{}`: {e}", clip(header[c]))));
        match (t, x) {
            (Ok(t), Ok(_)) if points.last().is_some_and(|p| t < p[0]) => {
                let before = points.last().map_or(0.0, |p| p[0]);
                wrong.push(format!("line {line_number}: the time {t} s lies before {before} s in the row above"));
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

/// A cell without blanks and quotes around it.
fn bare(cell: &str) -> &str {
    let cell = cell.trim();
    cell.strip_prefix('"').and_then(|c| c.strip_suffix('"')).unwrap_or(cell)
}

fn number(cell: &str) -> Result<f64, String> {
    match cell.parse::<f64>() {
        _ if cell.is_empty() => Err("the cell is empty".into()),
        Ok(x) if x.is_finite() => Ok(x),
        _ => Err(format!("`{}` is no finite number", clip(cell))),
    }
}

fn no_column(name: &str, header: &[&str]) -> String {
    const MOST_NAMES: usize = 12;
    let known: Vec<String> = header.iter().take(MOST_NAMES).map(|h| format!("`{}`", clip(h))).collect();
    let separator = if header.len() == 1 && header[0].contains(';') { "; commas separate columns" } else { "" };
    format!("there is no column `{}`; the header has {}{separator}", clip(name), known.join(", "))
}
