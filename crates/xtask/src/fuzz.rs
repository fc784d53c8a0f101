//! Random train files, begun from the examples.

use std::fs;
use std::path::Path;

use crate::context::{Context, passes};
use crate::examples::example_files;
use crate::step::{Outcome, outcome};

/// Random train files, begun from the examples.
pub(crate) fn fuzz(context: &Context) -> Outcome {
    // The nightly toolchain only compiles the fuzz target; the rest of the project never needs it.
    if !context.succeeds("cargo +nightly --version") {
        return Outcome::Skipped("there is no nightly toolchain here".into());
    }
    if !context.succeeds("cargo fuzz --version") {
        let _ = context.run("cargo install --quiet cargo-fuzz --version ^0.13");
        if !context.succeeds("cargo fuzz --version") {
            return Outcome::Skipped("cargo-fuzz cannot be installed here".into());
        }
    }
    let seed = || -> Result<(), String> {
        let corpus = context.root.join("fuzz/corpus/analyze");
        fs::create_dir_all(&corpus).map_err(|e| format!("the folder fuzz/corpus/analyze: {e}"))?;
        for file in example_files(context)? {
            let name = Path::new(&file).file_name().expect("a file");
            fs::copy(context.root.join(&file), corpus.join(name)).map_err(|e| format!("{file}: {e}"))?;
        }
        Ok(())
    };
    if let Err(e) = seed() {
        return Outcome::Failed(e);
    }
    let seconds = context.options.seconds.unwrap_or(20);
    let words = format!(
        "cargo +nightly fuzz run --sanitizer none analyze -- -max_total_time={seconds} -timeout=20 \
         -rss_limit_mb=4096 -dict=fuzz/analyze.dict -verbosity=0 -print_final_stats=1"
    );
    let mut command = context.words(&words);
    // This program was started by another toolchain, whose settings must not reach nightly.
    command.env_remove("RUSTUP_TOOLCHAIN").env_remove("LD_LIBRARY_PATH");
    outcome(passes(&mut command, &words))
}
