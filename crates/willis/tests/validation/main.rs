//! Numbers of others beside ours.

mod cases;
mod dynamics;
mod esmail_table;
mod losses;
