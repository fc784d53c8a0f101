//! Rows as bytes, and pieces of a table put together.

use std::fmt::Write as _;
use std::fs::File;
use std::io::{BufRead, BufReader, BufWriter, Write};
use std::path::Path;

use willis::study::{ColumnValues, Rows, SweepColumn};
use willis_ask::table::{field, number};

#[cfg(feature = "parquet")]
use super::parquet;
use super::piece::Piece;
use crate::input;

/// What a table is written as, by the end of its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    Csv,
    JsonLines,
    #[cfg(feature = "parquet")]
    Parquet,
}

impl Form {
    /// The form that the end of a name means.
    pub fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_string_lossy().to_lowercase().as_str() {
            "csv" => Some(Self::Csv),
            "jsonl" | "ndjson" => Some(Self::JsonLines),
            #[cfg(feature = "parquet")]
            "parquet" => Some(Self::Parquet),
            _ => None,
        }
    }

    pub fn name(self) -> &'static str {
        match self {
            Self::Csv => "csv",
            Self::JsonLines => "jsonl",
            #[cfg(feature = "parquet")]
            Self::Parquet => "parquet",
        }
    }

    /// Rows as a piece of the table.
    pub fn encode(self, columns: &[SweepColumn], rows: &Rows) -> Result<Vec<u8>, String> {
        match self {
            Self::Csv => Ok(csv(rows).into_bytes()),
            Self::JsonLines => Ok(json_lines(columns, rows).into_bytes()),
            #[cfg(feature = "parquet")]
            Self::Parquet => parquet::encode(columns, rows),
        }
    }

    /// Puts pieces of one table, or whole tables, together into a table.
    pub fn join(self, columns: &[SweepColumn], told: &str, pieces: &[Piece], out: File) -> Result<(), String> {
        #[cfg(feature = "parquet")]
        if self == Self::Parquet {
            return parquet::join(columns, told, pieces, out);
        }
        // What is told of the sweep stands beside a table of text.
        let _ = told;
        let mut out = BufWriter::with_capacity(1 << 20, out);
        let run = |out: &mut BufWriter<File>| -> std::io::Result<()> {
            if self == Self::Csv {
                let mut header = String::new();
                for (k, column) in columns.iter().enumerate() {
                    header.push_str(if k > 0 { "," } else { "" });
                    field(&mut header, &column.name);
                }
                header.push('\n');
                out.write_all(header.as_bytes())?;
            }
            for piece in pieces {
                let mut from = BufReader::with_capacity(1 << 20, input::regular(&piece.path)?);
                if self == Self::Csv && piece.is_table {
                    // Names of columns have no line breaks.
                    from.skip_until(b'\n')?;
                }
                std::io::copy(&mut from, out)?;
            }
            out.flush()
        };
        run(&mut out).map_err(|e| e.to_string())
    }
}

fn csv(rows: &Rows) -> String {
    let n = rows.len();
    let mut out = String::with_capacity(n * rows.columns.len() * 12);
    for i in 0..n {
        for (k, cells) in rows.columns.iter().enumerate() {
            if k > 0 {
                out.push(',');
            }
            match cells {
                ColumnValues::Numbers(all) => number(&mut out, all[i]),
                ColumnValues::Integers(all) => drop(write!(out, "{}", all[i])),
                ColumnValues::Texts(all) => field(&mut out, &all[i]),
            }
        }
        out.push('\n');
    }
    out
}

fn json_lines(columns: &[SweepColumn], rows: &Rows) -> String {
    let keys: Vec<String> = columns.iter().map(|c| serde_json::to_string(&c.name).expect("a text")).collect();
    let n = rows.len();
    let mut out = String::with_capacity(n * rows.columns.len() * 28);
    for i in 0..n {
        for (k, cells) in rows.columns.iter().enumerate() {
            out.push(if k == 0 { '{' } else { ',' });
            out.push_str(&keys[k]);
            out.push(':');
            match cells {
                ColumnValues::Numbers(all) if all[i].is_nan() => out.push_str("null"),
                ColumnValues::Numbers(all) => number(&mut out, all[i]),
                ColumnValues::Integers(all) => drop(write!(out, "{}", all[i])),
                ColumnValues::Texts(all) => out.push_str(&serde_json::to_string(&all[i]).expect("a text")),
            }
        }
        out.push_str("}\n");
    }
    out
}
