//! `willis-pdf`: a report or figure of Willis, written as JSON, comes in; a PDF goes out.

use std::io::{IsTerminal, Read, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::{env, fs, io};

use willis_pdf::{Measured, Paper};

const HELP: &str = "\
Sets an engineering report of Willis, or one of its figures, as PDF.

Usage: willis-pdf [--paper PAPER] [-o FILE | --measure] < report.json

Reads a document of the format willis-report-1 or a figure of the format willis-plate-1 from standard input.

  -o, --output FILE  where to write; without it, standard output
      --paper PAPER  a4 (default) or us-letter; a figure has a page of its own size
      --measure      no PDF, but the number of pages and the size of the smallest text
  -h, --help         this text
  -V, --version      the version
";

enum Request {
    Say(String),
    Set { paper: Paper, output: Option<PathBuf> },
    Measure { paper: Paper },
}

fn main() -> ExitCode {
    match arguments().and_then(run) {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("willis-pdf: {why}");
            ExitCode::FAILURE
        }
    }
}

fn arguments() -> Result<Request, String> {
    let (mut paper, mut output, mut measured) = (Paper::A4, None, false);
    // The first is the program itself.
    let mut rest = env::args_os().skip(1);
    while let Some(argument) = rest.next() {
        let mut value = || rest.next().ok_or(format!("{} needs a value", argument.display()));
        match argument.to_str() {
            Some("-h" | "--help") => return Ok(Request::Say(HELP.to_owned())),
            Some("-V" | "--version") => return Ok(Request::Say(format!("willis-pdf {}\n", env!("CARGO_PKG_VERSION")))),
            Some("--measure") => measured = true,
            Some("-o" | "--output") => output = Some(PathBuf::from(value()?)),
            Some("--paper") => {
                let name = value()?;
                paper = name
                    .to_str()
                    .and_then(Paper::named)
                    .ok_or(format!("paper {}: there are a4 and us-letter", name.display()))?;
            }
            _ => return Err(format!("unknown argument {}; see --help", argument.display())),
        }
    }
    match (measured, output) {
        (true, None) => Ok(Request::Measure { paper }),
        (true, Some(_)) => Err("--measure writes no PDF: leave -o out".to_owned()),
        (false, output) => Ok(Request::Set { paper, output }),
    }
}

fn run(request: Request) -> Result<(), String> {
    let (paper, output) = match request {
        Request::Say(text) => return io::stdout().write_all(text.as_bytes()).map_err(|e| e.to_string()),
        Request::Measure { paper } => {
            let found = Measured::of(&willis_pdf::pages(&willis_pdf::read(&input()?)?, paper)?);
            let told = format!("{} pages, smallest text {:.2} pt\n", found.pages, found.smallest);
            return io::stdout().write_all(told.as_bytes()).map_err(|e| e.to_string());
        }
        Request::Set { paper, output } => (paper, output),
    };
    if output.is_none() && io::stdout().is_terminal() {
        return Err("a PDF is nothing for a terminal; give -o FILE".to_owned());
    }
    let bytes = willis_pdf::pdf(&willis_pdf::read(&input()?)?, paper)?;
    match output {
        None => io::stdout().write_all(&bytes).map_err(|e| format!("standard output: {e}")),
        Some(path) => replace(&path, &bytes).map_err(|e| format!("{}: {e}", path.display())),
    }
}

fn input() -> Result<String, String> {
    let mut json = String::new();
    io::stdin().read_to_string(&mut json).map_err(|e| format!("standard input: {e}"))?;
    Ok(json)
}

/// Writes a file beside its place and then moves it there: nobody ever sees half of one.
fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let name = path.file_name().ok_or_else(|| io::Error::other("no name of a file"))?;
    let beside = path.with_file_name(format!(".{}.{}", name.display(), std::process::id()));
    fs::write(&beside, bytes).and_then(|()| fs::rename(&beside, path)).inspect_err(|_| {
        // The first error is the one to tell.
        let _ = fs::remove_file(&beside);
    })
}
