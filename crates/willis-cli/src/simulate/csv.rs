//! Rows as CSV, written as they come.

use std::io::{BufWriter, Write};

use willis::dynamics::Column;

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
        let mut header = crate::csv::Writer::default();
        header.row(columns.iter().map(|c| &c.name));
        self.out.write_all(header.0.as_bytes()).map_err(|e| e.to_string())
    }

    pub fn row(&mut self, values: &[f64]) -> Result<(), String> {
        use std::fmt::Write as _;
        self.line.clear();
        for (k, v) in values.iter().enumerate() {
            if k > 0 {
                self.line.push(',');
            }
            if !v.is_nan() {
                // The shortest text that reads back as the same number; adding zero turns -0.0 into 0.0.
                let _ = write!(self.line, "{:?}", v + 0.0);
                if self.line.ends_with(".0") {
                    self.line.truncate(self.line.len() - 2);
                }
            }
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
