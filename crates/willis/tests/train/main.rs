//! The train file: what it reads to, and what is said of one that is wrong, odd or hostile.

#[path = "../common/mod.rs"]
mod common;

mod bad_input;
mod diagnostics;
mod dynamic_format;
mod specification;
