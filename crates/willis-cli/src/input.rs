//! Reading a train file and the tables it names, or saying why they cannot be read.

use std::io::Read;
use std::path::Path;

use willis::diagnostic::{Code, Diagnostic, Diagnostics};

/// What is read: its limits, and what to do when it is not that.
struct Kind {
    /// Larger files are something else; reading them would only cost memory.
    most_mib: u64,
    too_large: &'static str,
    directory: &'static str,
    no_text: &'static str,
}

const TRAIN: Kind = Kind {
    most_mib: 4,
    too_large: "a train file is a few kilobytes",
    directory: "name a train file in it",
    no_text: "a train file is TOML text",
};

/// A table that a train file names.
const TABLE: Kind = Kind {
    most_mib: 64,
    too_large: "thin out the table",
    directory: "name a CSV file in it",
    no_text: "a table is CSV text",
};

const PERMISSIONS: &str = "check the path and its permissions";

/// Why a file was not read, and what to do.
type Refusal = (String, &'static str);

pub fn read(file: &str) -> Result<String, Diagnostics> {
    let text = match file {
        "-" => text_of(std::io::stdin(), "standard input", &TRAIN),
        _ => open(Path::new(file), file, &TRAIN),
    };
    text.map_err(|(message, hint)| [Diagnostic::new(Code::Unreadable, "", message).hint(hint)].into_iter().collect())
}

/// Reads a table that is named on the command line.
pub fn table(file: &str) -> Result<String, Diagnostics> {
    let text = match file {
        "-" => text_of(std::io::stdin(), "standard input", &TABLE),
        _ => open(Path::new(file), file, &TABLE),
    };
    text.map_err(|(message, hint)| [Diagnostic::new(Code::Unreadable, "", message).hint(hint)].into_iter().collect())
}

/// Reads the tables that a train file names, seen from its folder.
pub fn tables_beside(file: &str) -> impl FnMut(&str) -> Result<String, String> {
    let folder = Path::new(file).parent().map(Path::to_path_buf).unwrap_or_default();
    move |name| open(&folder.join(name), name, &TABLE).map_err(|(message, hint)| format!("{message}; {hint}"))
}

fn open(path: &Path, name: &str, kind: &Kind) -> Result<String, Refusal> {
    let io = |e: std::io::Error| (format!("{name}: {e}"), PERMISSIONS);
    let handle = std::fs::File::open(path).map_err(io)?;
    if handle.metadata().map_err(io)?.is_dir() {
        return Err((format!("{name} is a directory"), kind.directory));
    }
    text_of(handle, name, kind)
}

fn text_of(from: impl Read, name: &str, kind: &Kind) -> Result<String, Refusal> {
    let most = kind.most_mib << 20;
    let mut bytes = Vec::new();
    let read = from.take(most + 1).read_to_end(&mut bytes);
    read.map_err(|e| (format!("{name}: {e}"), PERMISSIONS))?;
    if bytes.len() as u64 > most {
        return Err((format!("{name} is larger than {} MiB", kind.most_mib), kind.too_large));
    }
    String::from_utf8(bytes).map_err(|e| {
        let at = e.utf8_error().valid_up_to();
        (format!("{name} is not text in UTF-8 (byte {at})"), kind.no_text)
    })
}
