//! Rows as CSV, written as they come.

use std::io::{BufWriter, Write};

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
