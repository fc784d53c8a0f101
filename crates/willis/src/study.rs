//! Many operating points: maps, trends, what matters most, how sure it is, and files for other programs.

pub mod export;
