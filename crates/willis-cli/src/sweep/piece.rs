//! What a table is put together from.

use std::path::PathBuf;

/// A file to put into a table.
pub struct Piece {
    pub path: PathBuf,
    /// Whether it is a table with a header, not only rows.
    pub is_table: bool,
}
