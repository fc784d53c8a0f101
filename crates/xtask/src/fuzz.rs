//! Random texts: train files begun from the examples, every other text that is read, and files of other programs.

use std::fs;
use std::path::Path;

use crate::context::{Context, passes};
use crate::examples::example_files;
use crate::step::{Outcome, outcome};

/// The targets, each in a file of its own.
const TARGETS: &[&str] = &["analyze", "texts", "imports"];

/// Readers of the target `texts` that take a whole train file.
const WHOLE: &[char] = &['d', 'v'];

/// What is tried in `ci`, and by `--long`, seconds a target.
const SECONDS: [u64; 2] = [20, 900];

/// Puts the examples and the committed seeds into the corpora, which grow from run to run.
fn seed(context: &Context) -> Result<(), String> {
    let folder = |target: &str| -> Result<_, String> {
        let corpus = context.root.join("fuzz/corpus").join(target);
        fs::create_dir_all(&corpus).map_err(|e| format!("{}: {e}", corpus.display()))?;
        Ok(corpus)
    };
    let [analyze, texts, imports] = [folder(TARGETS[0])?, folder(TARGETS[1])?, folder(TARGETS[2])?];
    for file in example_files(context)? {
        let name = Path::new(&file).file_name().expect("a file").to_string_lossy().into_owned();
        let text = fs::read_to_string(context.root.join(&file)).map_err(|e| format!("{file}: {e}"))?;
        let fail = |e| format!("the corpus, {name}: {e}");
        fs::write(analyze.join(&name), &text).map_err(fail)?;
        for reader in WHOLE {
            fs::write(texts.join(format!("{reader}-{name}")), format!("{reader}{text}")).map_err(fail)?;
        }
    }
    for (target, corpus) in [(TARGETS[1], texts), (TARGETS[2], imports)] {
        let seeds = context.root.join("fuzz/seeds").join(target);
        for entry in fs::read_dir(&seeds).map_err(|e| format!("{}: {e}", seeds.display()))? {
            let entry = entry.map_err(|e| format!("{}: {e}", seeds.display()))?;
            fs::copy(entry.path(), corpus.join(entry.file_name()))
                .map_err(|e| format!("{}: {e}", entry.path().display()))?;
        }
    }
    Ok(())
}

/// Random train files; with `--long` random texts for every target.
pub(crate) fn fuzz(context: &Context) -> Outcome {
    // The nightly toolchain only compiles the fuzz targets; the rest of the project never needs it.
    if !context.succeeds("cargo +nightly --version") {
        return Outcome::Skipped("there is no nightly toolchain here".into());
    }
    if !context.succeeds("cargo fuzz --version") {
        let _ = context.run("cargo install --quiet cargo-fuzz --version ^0.13");
        if !context.succeeds("cargo fuzz --version") {
            return Outcome::Skipped("cargo-fuzz cannot be installed here".into());
        }
    }
    if let Err(e) = seed(context) {
        return Outcome::Failed(e);
    }
    let seconds = context.options.seconds.unwrap_or(SECONDS[usize::from(context.options.long)]);
    let one = |target: &&str| {
        let words = format!(
            "cargo +nightly fuzz run --sanitizer none {target} -- -max_total_time={seconds} -timeout=20 \
             -rss_limit_mb=4096 -dict=fuzz/analyze.dict -verbosity=0 -print_final_stats=1"
        );
        let mut command = context.words(&words);
        // This program was started by another toolchain, whose settings must not reach nightly.
        command.env_remove("RUSTUP_TOOLCHAIN").env_remove("LD_LIBRARY_PATH");
        passes(&mut command, &words)
    };
    // Building the second target takes longer than trying it: that is for those who take their time.
    let targets = if context.options.long { TARGETS } else { &TARGETS[..1] };
    outcome(targets.iter().try_for_each(one))
}
