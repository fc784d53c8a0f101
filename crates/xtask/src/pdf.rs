//! Reports as PDF: the typesetter is tested, and sets one.

use std::{env, fs};

use crate::context::{Context, component, passes};
use crate::generate::build_willis;
use crate::step::{Outcome, outcome};

/// Tests the typesetter, and sets one report.
pub(crate) fn pdf(context: &Context) -> Outcome {
    const MANIFEST: &str = "crates/willis-pdf/Cargo.toml";
    let all = || -> Result<(), String> {
        component(context, "rustfmt")?;
        context.run(&format!("cargo fmt --manifest-path {MANIFEST} --check"))?;
        // Built once, for tests and program alike; beside its manifest, where `report` looks for it.
        let own = context.root.join("crates/willis-pdf/target");
        for words in ["cargo test --manifest-path", "cargo build --manifest-path"] {
            let words = format!("{words} {MANIFEST}");
            passes(context.words(&words).env("CARGO_TARGET_DIR", &own), &words)?;
        }
        build_willis(context)?;
        let report = context.target.join("report.pdf");
        let mut command = context.willis();
        let path = env::join_paths(
            [own.join("debug")].into_iter().chain(env::split_paths(&env::var_os("PATH").unwrap_or_default())),
        );
        command.env("PATH", path.map_err(|e| e.to_string())?);
        // One of an earlier run is this task's own.
        let train = "examples/wang-herringbone-physical.toml";
        context.output(command.args(["report", train, "--force", "-o"]).arg(&report))?;
        let bytes = fs::read(&report).map_err(|e| format!("{}: {e}", report.display()))?;
        println!("a report of {} kB", bytes.len() / 1000);
        if bytes.starts_with(b"%PDF") { Ok(()) } else { Err(format!("{} is no PDF", report.display())) }
    };
    outcome(all())
}
