//! The library and everything that answers with it are fit for the browser.

use std::path::Path;

use crate::context::Context;
use crate::step::{Outcome, outcome};

/// Checks what a browser needs.
pub(crate) fn wasm(context: &Context) -> Outcome {
    const TARGET: &str = "wasm32-unknown-unknown";
    let there = || {
        let output = context.words(&format!("rustc --print target-libdir --target {TARGET}")).output();
        output.is_ok_and(|o| Path::new(String::from_utf8_lossy(&o.stdout).trim()).is_dir())
    };
    if !there() {
        let _ = context.run(&format!("rustup target add {TARGET}"));
        if !there() {
            return Outcome::Skipped(format!("the target {TARGET} cannot be had here"));
        }
    }
    outcome(context.run(&format!("cargo check -p willis -p willis-figure -p willis-ask --target {TARGET}")))
}
