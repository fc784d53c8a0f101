//! The forms in which an answer can be had.

use willis_ask::Entry;

use crate::pdf;

/// Forms of every answer, and of one with tables.
pub const TEXT: &str = "text";
pub const JSON: &str = "json";
pub const CSV: &str = "csv";
pub const JSON_LINES: &str = "jsonl";
pub const PARQUET: &str = "parquet";
/// The form that a program of its own makes.
pub const PDF: &str = "pdf";

/// The forms in which the answer to a question can be had.
pub fn forms(entry: &Entry) -> Vec<&'static str> {
    let mut all = vec![TEXT, JSON];
    if !entry.tables.is_empty() {
        all.extend([CSV, JSON_LINES]);
        if cfg!(feature = "parquet") {
            all.push(PARQUET);
        }
    }
    all.extend(entry.forms.iter().map(|f| f.name));
    if pdf::sets(entry) {
        all.push(PDF);
    }
    all
}
