//! Numbers of others beside ours.

#[path = "../common/mod.rs"]
mod common;

mod cases;
mod esmail_table;
