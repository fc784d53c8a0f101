//! The library and everything that answers with it are fit for the browser: they compile for it, and as WebAssembly they
//! give the same answers as here.

use std::fs::File;
use std::path::Path;

use crate::context::Context;
use crate::examples::example_files;
use crate::generate::build_willis;
use crate::step::{Outcome, outcome};

const BROWSER: &str = "wasm32-unknown-unknown";
/// WebAssembly with a standard input and output, which a browser lacks.
const WASI: &str = "wasm32-wasip1";

/// Checks what a browser needs.
pub(crate) fn wasm(context: &Context) -> Outcome {
    for target in [BROWSER, WASI] {
        if !is_there(context, target) {
            let _ = context.run(&format!("rustup target add {target}"));
        }
        if !is_there(context, target) {
            return Outcome::Skipped(format!("the target {target} cannot be had here"));
        }
    }
    if !context.succeeds("node --version") {
        return Outcome::Skipped("there is no Node.js here to run WebAssembly".into());
    }
    let check = format!("cargo check -p willis -p willis-figure -p willis-ask --target {BROWSER}");
    outcome(context.run(&check).and_then(|()| answers(context)))
}

fn is_there(context: &Context, target: &str) -> bool {
    let output = context.words(&format!("rustc --print target-libdir --target {target}")).output();
    output.is_ok_and(|o| Path::new(String::from_utf8_lossy(&o.stdout).trim()).is_dir())
}

/// Asks for the analysis of every example, here and as WebAssembly: the two must agree to the last bit.
fn answers(context: &Context) -> Result<(), String> {
    context.run(&format!("cargo build -p willis-ask --no-default-features --example analyze --target {WASI}"))?;
    build_willis(context)?;
    let program = context.target.join(WASI).join("debug/examples/analyze.wasm");
    let files = example_files(context)?;
    for file in &files {
        let here = context.output(context.willis().args(["analyze", file, "--format", "json"]))?;
        let train = File::open(context.root.join(file)).map_err(|e| format!("{file}: {e}"))?;
        let mut node = context.command("node");
        node.args(["--no-warnings", "--input-type=module", "--eval", include_str!("wasm.mjs"), "--"]);
        let there = context.output(node.arg(&program).stdin(train))?;
        if here.stdout != there.stdout {
            return Err(format!("{file}: WebAssembly gives another answer"));
        }
    }
    println!("{} examples have the same answer as WebAssembly", files.len());
    Ok(())
}
