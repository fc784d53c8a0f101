//! Rows as CSV, written as they come.

use std::fs::File;
use std::io::{BufWriter, Read, Seek, SeekFrom, Write};

use willis::dynamics::Column;
use willis_ask::table::{field, number};

/// A header, then a row a sample; empty where a value is not determined.
///
/// A run that ends before its scenario leaves a last line that begins with `# ` and says when and why.
pub struct Rows<W: Write> {
    out: BufWriter<W>,
    line: String,
}

impl<W: Write> Rows<W> {
    pub fn new(out: W) -> Self {
        Self { out: BufWriter::with_capacity(1 << 16, out), line: String::new() }
    }

    pub fn columns(&mut self, columns: &[Column]) -> Result<(), String> {
        let mut header = String::new();
        for (k, column) in columns.iter().enumerate() {
            if k > 0 {
                header.push(',');
            }
            field(&mut header, &column.name);
        }
        header.push('\n');
        self.out.write_all(header.as_bytes()).map_err(|e| e.to_string())
    }

    pub fn row(&mut self, values: &[f64]) -> Result<(), String> {
        self.line.clear();
        for (k, v) in values.iter().enumerate() {
            if k > 0 {
                self.line.push(',');
            }
            number(&mut self.line, *v);
        }
        self.line.push('\n');
        self.out.write_all(self.line.as_bytes()).map_err(|e| e.to_string())
    }

    pub fn finish(mut self, early: Option<&str>) -> Result<(), String> {
        if let Some(why) = early {
            // One line, whatever the words are.
            let why: String = why.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
            writeln!(self.out, "# {why}").map_err(|e| e.to_string())?;
        }
        self.out.flush().map_err(|e| e.to_string())
    }
}

/// Bytes from the end in which whole lines are looked for.
const TAIL: u64 = 1 << 20;

/// Makes a file whole whose writing failed: whole rows, and in the place of the last of them a line that says when and
/// why it ends. The time of the last row, as it is written; none if there is no row.
pub fn salvage(mut file: &File, why: impl Fn(&str) -> String) -> std::io::Result<Option<String>> {
    let length = file.metadata()?.len();
    let begins = length.saturating_sub(TAIL);
    file.seek(SeekFrom::Start(begins))?;
    let mut tail = Vec::new();
    file.read_to_end(&mut tail)?;
    let ends: Vec<usize> = (0..tail.len()).filter(|&k| tail[k] == b'\n').map(|k| k + 1).collect();
    // From the last row backwards, until the words fit where there were bytes before.
    for pair in ends.windows(2).rev() {
        let row = String::from_utf8_lossy(&tail[pair[0]..pair[1]]);
        let Some(time) = row.split(',').next().filter(|t| t.parse::<f64>().is_ok()) else { break };
        let line = format!("# {}\n", why(time));
        if pair[1] + line.len() <= tail.len() {
            file.set_len(begins + pair[1] as u64)?;
            file.seek(SeekFrom::End(0))?;
            file.write_all(line.as_bytes())?;
            return Ok(Some(time.to_owned()));
        }
    }
    Ok(None)
}
