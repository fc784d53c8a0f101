//! `willis`: the questions of Willis on the command line. Files, terminal, threads and progress are here; what is asked and
//! answered is in `willis-ask`.
//!
//! A library, so that the Python package has the same command and reads the same files.

mod command;
mod examples;
mod fmu;
mod form;
pub mod input;
mod interrupt;
mod output;
#[cfg(feature = "parquet")]
mod parquet;
mod pdf;
mod run;
mod simulate;
mod studio;
mod sweep;
mod tools;
mod topics;
pub mod work;

use std::ffi::OsString;
use std::io::Write;

use clap::ArgMatches;
use clap::error::ErrorKind;
use willis::diagnostic::printable;

/// How a command ended.
pub(crate) enum Ended {
    /// With this on standard output.
    Answered(String),
    /// Before its end: exit status 130.
    Interrupted {
        /// The answer until then, for standard output.
        out: String,
        /// For eyes.
        told: String,
    },
    /// With this on standard output and on standard error: exit status 1.
    Refused {
        /// For machines, where they asked.
        out: String,
        /// For eyes.
        told: String,
    },
    /// As the command line itself does not allow, for this reason: exit status 2.
    Misused(String),
}

impl From<String> for Ended {
    /// In plain words; what a terminal would obey, as in the name of a file, is shown instead.
    fn from(told: String) -> Self {
        let lines: Vec<_> = told.split('\n').map(printable).collect();
        Self::Refused { out: String::new(), told: lines.join("\n") }
    }
}

/// Runs a command line of a program that shows the answer itself: what would be on standard output, or what is wrong.
///
/// # Errors
/// What the command line does not allow, a refusal, or that the work was interrupted, in words.
pub fn answer(words: impl IntoIterator<Item = OsString>) -> Result<String, String> {
    let matches = command::matches(words).map_err(|e| e.to_string())?;
    let (name, own) = matches.subcommand().expect("clap asks for a command");
    match run(name, own).unwrap_or_else(|ended| ended) {
        Ended::Answered(out) => Ok(out),
        Ended::Interrupted { told, .. } | Ended::Refused { told, .. } | Ended::Misused(told) => {
            Err(willis_ask::style::plain(&told))
        }
    }
}

/// Runs the command line with these words, the first of them the name of the program, and gives its exit status. What the
/// command line does not allow ends the program.
pub fn run_command(words: impl IntoIterator<Item = OsString>) -> u8 {
    let matches = command::matches(words).unwrap_or_else(|e| e.exit());
    match matches.get_one::<String>("color").map(String::as_str) {
        Some("always") => anstream::ColorChoice::Always.write_global(),
        Some("never") => anstream::ColorChoice::Never.write_global(),
        _ => {}
    }
    let (name, own) = matches.subcommand().expect("clap asks for a command");
    let ended = run(name, own).unwrap_or_else(|ended| ended);
    let (out, told, status) = match ended {
        Ended::Answered(out) => (out, String::new(), 0),
        Ended::Interrupted { out, told } => (out, told, 130),
        Ended::Refused { out, told } => (out, told, 1),
        Ended::Misused(told) => command::command().error(ErrorKind::ArgumentConflict, told).exit(),
    };
    let _ = anstream::stderr().write_all(told.as_bytes());
    // A reader that closes the pipe early (`willis … | head`) is no error.
    let mut stdout = anstream::stdout();
    match stdout.write_all(out.as_bytes()).and_then(|()| stdout.flush()) {
        Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => {
            let _ = writeln!(anstream::stderr(), "standard output: {e}");
            1
        }
        _ => status,
    }
}

fn run(name: &str, own: &ArgMatches) -> Result<Ended, Ended> {
    if let Some(tool) = tools::TOOLS.iter().find(|t| t.name == name) {
        return (tool.run)(own, command::command());
    }
    let entry = willis_ask::question(name).expect("clap knows the commands");
    match (name, own.try_get_one::<std::path::PathBuf>("output").ok().flatten()) {
        ("export", _) if fmu::is_asked(own) => fmu::run(entry, own),
        ("export", _) => fmu::beside(own, || run::run(entry, own)),
        ("sweep", _) => sweep::run(entry, own),
        ("simulate", Some(out)) if simulate::streams(out) => simulate::run(entry, own, out),
        _ => run::run(entry, own),
    }
}
