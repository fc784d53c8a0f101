//! Reports as PDF: typesetting takes long to build, so that a program of its own does it.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use clap::{Arg, ArgMatches};

/// The program.
const TYPESETTER: &str = "willis-pdf";

/// The options of a report that only paper knows.
pub fn options(command: clap::Command) -> clap::Command {
    let paper = Arg::new("paper").long("paper").value_name("PAPER").value_parser(["a4", "us-letter"]);
    command.arg(paper.default_value("a4").help("Paper of a PDF: 210 mm x 297 mm, or 8.5 in x 11 in"))
}

/// The paper that was asked for.
pub fn paper(matches: &ArgMatches) -> &str {
    matches.get_one::<String>("paper").map_or("a4", String::as_str)
}

/// The typesetter beside this program, where it was built in the tree, or on the path.
fn typesetter() -> PathBuf {
    let name = format!("{TYPESETTER}{}", std::env::consts::EXE_SUFFIX);
    let own = std::env::current_exe().ok();
    let beside = own.as_deref().and_then(Path::parent).map(|folder| folder.join(&name));
    let built = (own.as_deref())
        .and_then(|p| p.ancestors().nth(3))
        .map(|root| root.join("crates").join(TYPESETTER).join("target/release").join(&name));
    [beside, built].into_iter().flatten().find(|p| p.is_file()).unwrap_or_else(|| name.into())
}

/// A report, `willis-report-1`, as PDF.
pub fn typeset(json: &str, paper: &str) -> Result<Vec<u8>, String> {
    let program = typesetter();
    let missing = |e: std::io::Error| {
        format!(
            "a PDF is set by the program {TYPESETTER}, which could not be started: {e}\n  build it once (about five \
             minutes): cargo build --release --manifest-path crates/willis-pdf/Cargo.toml\n  or install it: cargo \
             install --path crates/willis-pdf\n  or write .html and print it\n"
        )
    };
    let mut command = Command::new(&program);
    command.args(["--paper", paper]).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut running = command.spawn().map_err(missing)?;
    let mut input = running.stdin.take().expect("it was piped");
    let result = std::thread::scope(|scope| {
        // It may answer before it has read everything.
        scope.spawn(move || {
            let _ = input.write_all(json.as_bytes());
        });
        running.wait_with_output()
    });
    let done = result.map_err(|e| format!("{TYPESETTER}: {e}\n"))?;
    match done.status.success() && done.stdout.starts_with(b"%PDF") {
        true => Ok(done.stdout),
        false => Err(format!("{}\n", String::from_utf8_lossy(&done.stderr).trim_end())),
    }
}
