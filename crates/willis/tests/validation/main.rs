//! Numbers of others beside ours.

#[path = "../common/mod.rs"]
mod common;

mod cases;
mod dynamics;
mod esmail_table;
mod losses;
