//! Reports and figures as PDF: typesetting takes long to build, so that a program of its own does it.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use clap::{Arg, ArgMatches};
use willis_ask::Entry;

/// The program.
const TYPESETTER: &str = "willis-pdf";
/// The form of a figure that the program reads, and how the names of its files end.
pub const PLATE: &str = "plate";
pub const PLATE_ENDING: &str = ".plate.json";

/// Whether the answer to a question can be had as PDF.
pub fn sets(entry: &Entry) -> bool {
    entry.name == "report" || entry.forms.iter().any(|f| f.name == PLATE)
}

/// The options of a report that only paper knows.
pub fn options(command: clap::Command) -> clap::Command {
    let paper = Arg::new("paper").long("paper").value_name("PAPER").value_parser(["a4", "us-letter"]);
    command.arg(paper.default_value("a4").help("Paper of a PDF: 210 mm x 297 mm, or 8.5 in x 11 in"))
}

/// The paper that was asked for.
pub fn paper(matches: &ArgMatches) -> &str {
    matches.try_get_one::<String>("paper").ok().flatten().map_or("a4", String::as_str)
}

/// The program that sets pages, known to start.
pub struct Typesetter(PathBuf);

impl Typesetter {
    /// Beside this program, where it was built in the tree, or on the path.
    ///
    /// # Errors
    /// It is not there, or does not start; how to come by it.
    pub fn find() -> Result<Self, String> {
        let name = format!("{TYPESETTER}{}", std::env::consts::EXE_SUFFIX);
        let own = std::env::current_exe().ok();
        let beside = own.as_deref().and_then(Path::parent).map(|folder| folder.join(&name));
        // `target/release/willis` beside `crates/willis-pdf/target/release/willis-pdf`.
        let root = own.as_deref().and_then(|p| p.ancestors().nth(3));
        let built = ["release", "debug"].map(|profile| {
            root.map(|root| root.join("crates").join(TYPESETTER).join("target").join(profile).join(&name))
        });
        let places = [beside].into_iter().chain(built).flatten();
        let program = places.into_iter().find(|p| p.is_file()).unwrap_or_else(|| name.into());
        let quiet = Command::new(&program).arg("--version").stdin(Stdio::null()).output();
        match quiet {
            Ok(said) if said.status.success() => Ok(Self(program)),
            Ok(said) => Err(format!("{}: does not work: {}\n", program.display(), said.status)),
            Err(e) => Err(format!(
                "a PDF is set by the program {TYPESETTER}, which could not be started: {e}\n  install it once (about five \
                 minutes): cargo install --path crates/willis-pdf\n  or write .html and print it\n"
            )),
        }
    }

    /// A report or a figure, as JSON, as PDF.
    ///
    /// # Errors
    /// What the program says.
    pub fn set(&self, json: &[u8], paper: &str) -> Result<Vec<u8>, String> {
        let mut command = Command::new(&self.0);
        command.args(["--paper", paper]).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let told = |e: std::io::Error| format!("{TYPESETTER}: {e}\n");
        let mut running = command.spawn().map_err(told)?;
        let mut input = running.stdin.take().expect("it was piped");
        let result = std::thread::scope(|scope| {
            // It may answer before it has read everything.
            scope.spawn(move || {
                let _ = input.write_all(json);
            });
            running.wait_with_output()
        });
        let done = result.map_err(told)?;
        match done.status.success() && done.stdout.starts_with(b"%PDF") {
            true => Ok(done.stdout),
            false => Err(format!("{}\n", String::from_utf8_lossy(&done.stderr).trim_end())),
        }
    }
}
