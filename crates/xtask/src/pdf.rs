//! Reports as PDF: the typesetter is tested, reports are measured, and one is set.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

use crate::context::{Context, component, passes, said};
use crate::program::build_willis;
use crate::step::{Outcome, outcome};

/// Reports that are measured, and how many pages they may have.
const MEASURED: [(&str, usize); 7] = [
    ("shift-8hp70", 8),
    ("prius-hybrid", 16),
    ("fva-planetary-stage", 16),
    ("wolfrom-236", 10),
    ("aisin-tl-80sn", 12),
    ("wang-herringbone-physical", 16),
    ("two-mode-split", 14),
];

/// No text of a report is smaller than 7 pt, and none has more pages than it should.
fn measured(context: &Context, typesetter: &Path) -> Result<(), String> {
    for (train, most) in MEASURED {
        let json = context.target.join(format!("report-{train}.json"));
        let file = format!("examples/{train}.toml");
        let mut command = context.willis();
        command.args(["report", &file, "--author", "Willis", "--format", "json", "--force", "-o"]).arg(&json);
        context.output(&mut command)?;
        let input = fs::File::open(&json).map_err(|e| format!("{}: {e}", json.display()))?;
        let told = context.output(Command::new(typesetter).arg("--measure").stdin(input))?;
        let told = String::from_utf8_lossy(&told.stdout);
        println!("{train}: {}", told.trim());
        let mut numbers = told.split_whitespace().filter_map(|w| w.parse::<f64>().ok());
        let (Some(pages), Some(smallest)) = (numbers.next(), numbers.next()) else {
            return Err(format!("{train}: not measured"));
        };
        if pages > most as f64 || smallest < 6.995 {
            return Err(format!("{train}: {pages} pages of {most}, smallest text {smallest} pt of 7"));
        }
    }
    Ok(())
}

const MANIFEST: &str = "crates/willis-pdf/Cargo.toml";

/// Built once, for tests and program alike; beside its manifest, where `report` looks for it.
fn own_target(context: &Context) -> PathBuf {
    context.root.join("crates/willis-pdf/target")
}

/// `cargo` for the typesetter.
fn cargo(context: &Context, words: &str) -> Command {
    let mut command = context.words(&format!("cargo {words} --manifest-path {MANIFEST}"));
    command.env("CARGO_TARGET_DIR", own_target(context));
    command
}

/// Builds the typesetter and its tests.
pub(crate) fn builds(context: &Context) -> Vec<Command> {
    ["test --no-run", "build"].map(|words| cargo(context, words)).into()
}

/// Tests the typesetter, measures reports, and sets one.
pub(crate) fn pdf(context: &Context) -> Outcome {
    let all = || -> Result<(), String> {
        component(context, "rustfmt")?;
        context.run(&format!("cargo fmt --manifest-path {MANIFEST} --check"))?;
        let own = own_target(context);
        for words in ["test", "build"] {
            let mut command = cargo(context, words);
            let said = said(&command);
            passes(&mut command, &said)?;
        }
        build_willis(context)?;
        measured(context, &own.join("debug/willis-pdf"))?;
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
