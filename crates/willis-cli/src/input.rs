//! Reading files, or saying why they cannot be read.
//!
//! Only ordinary files are read, opened without waiting, up to a size. A train file may come from a stranger: the tables
//! that it names lie in its own folder, or in a folder that the user names.

use std::fs::{File, OpenOptions};
use std::io::Read;
use std::path::{Component, Path, PathBuf};

use clap::ArgMatches;
use willis::diagnostic::{Code, Diagnostic, Diagnostics, printable};
use willis::model::Model;
use willis_ask::{Attachment, Given, Holds, Refusal, quoted};

/// What is read: its limits, and what to do when it is not that.
struct Kind {
    /// Larger files are something else; reading them would only cost memory.
    most_mib: u64,
    too_large: &'static str,
    directory: &'static str,
    no_text: &'static str,
    /// What the names of such files end with.
    ending: &'static str,
}

const TRAIN: Kind = Kind {
    most_mib: 4,
    too_large: "a train file is a few kilobytes",
    directory: "name a train file in it",
    no_text: "a train file is TOML text",
    ending: "toml",
};

/// A table that a train file names.
const TABLE: Kind = Kind {
    most_mib: 64,
    too_large: "thin out the table",
    directory: "name a CSV file in it",
    no_text: "a table is CSV text",
    ending: "csv",
};

/// How far a search came.
const PROGRESS: Kind = Kind {
    most_mib: 256,
    too_large: "no search writes so much",
    directory: "name a JSON file in it",
    no_text: "the progress of a search is JSON text",
    ending: "json",
};

/// A file of another program.
const EXCHANGE: Kind = Kind {
    most_mib: 64,
    too_large: "a gearbox is a few megabytes",
    directory: "name a file in it",
    no_text: "",
    ending: "rexs",
};

/// All tables of a train file together.
const MOST_TABLES_MIB: u64 = 256;

/// What this program wrote beside a table.
const MOST_OWN_MIB: u64 = 64;

const PERMISSIONS: &str = "check the path and its permissions";
const STREAM: &str = "a stream is read where `-` stands for the file: `... | willis check -`";

/// Why a file was not read, and what to do.
type Unread = (String, &'static str);

/// Reads a train file; `-` is standard input. The tables that it names are read from its folder and from the folders
/// allowed.
///
/// # Errors
/// Why the file cannot be read, or everything that is wrong with its text.
pub fn read(file: &str, allowed: &[&Path]) -> Result<Given, Refusal> {
    // As it is shown; a file may be called anything.
    let name = &*printable(if file == "-" { "standard input" } else { file });
    let text = of_kind(file, &TRAIN).map_err(|wrong| Refusal::File(wrong, name.into()))?;
    let model = Model::read(&text, &mut tables_of(file, allowed));
    let refused = |wrong| Refusal::File(wrong, Attachment { name: name.to_owned(), text: text.clone() });
    Ok(Given::new(name, model.map_err(refused)?))
}

/// The text of a train file, whatever it says.
pub(crate) fn train_text(file: &str) -> Result<String, Diagnostics> {
    of_kind(file, &TRAIN)
}

/// Reads a train file, with the laws and values that the command line puts in.
pub(crate) fn train(file: &str, matches: &ArgMatches) -> Result<Given, Refusal> {
    let allowed = matches.try_get_many::<PathBuf>("allow").ok().flatten().into_iter().flatten();
    let allowed: Vec<&Path> = allowed.map(PathBuf::as_path).collect();
    let mut given = read(file, &allowed)?;
    let (name, text) = (given.name.clone(), given.model.to_toml().to_owned());
    let refused = |wrong| Refusal::File(wrong, Attachment { name: name.clone(), text: text.clone() });
    let all = |name: &str| matches.try_get_many::<String>(name).ok().flatten().into_iter().flatten();
    let laws = all("law").map(|law| pair("law", law, "family=law", "mesh_friction=niemann"));
    let laws: Vec<(&str, &str)> = laws.collect::<Result<_, _>>()?;
    let sets = all("set").map(|set| pair("set", set, "quantity=value", "P1.sun.teeth=23"));
    let sets: Vec<(&str, &str)> = sets.collect::<Result<_, _>>()?;
    given.changes.extend(all("set").map(|s| format!("--set {}", quoted(s))));
    given.changes.extend(all("law").map(|l| format!("--law {}", quoted(l))));
    given.model = given.model.with(sets).map_err(refused)?;
    given.model = given.model.with_laws(laws).map_err(refused)?;
    if let Some(tolerance) = matches.try_get_one::<f64>("speed-tolerance").ok().flatten() {
        given.changes.push(format!("--speed-tolerance {tolerance}"));
        given.model =
            given.model.with_speed_tolerance(*tolerance).map_err(|wrong| Refusal::Wrong(wrong, usize::MAX))?;
    }
    Ok(given)
}

/// The two sides of an option `name=value`.
fn pair<'a>(option: &str, text: &'a str, form: &str, example: &str) -> Result<(&'a str, &'a str), Diagnostics> {
    let sides = text.split_once('=').map(|(name, value)| (name.trim(), value.trim()));
    sides.ok_or_else(|| {
        let d = Diagnostic::new(Code::UnknownSelection, "", format!("--{option} {text}: there is no `=` in it"));
        d.hint(format!("write {form}, as in --{option} {example}")).into()
    })
}

/// Reads a file that is named in a request.
///
/// # Errors
/// Why it cannot be read.
pub fn attached(file: &str, holds: Holds) -> Result<String, Diagnostics> {
    let kind = match holds {
        Holds::Train => &TRAIN,
        Holds::Progress => &PROGRESS,
        Holds::Exchange => return any_of(file, &EXCHANGE),
        _ => &TABLE,
    };
    of_kind(file, kind)
}

/// A file of any bytes, as the text of an attachment.
fn any_of(file: &str, kind: &Kind) -> Result<String, Diagnostics> {
    let bytes = match file {
        "-" => bytes_of(std::io::stdin(), "standard input", kind),
        _ => open_bytes(Path::new(file), file, kind),
    };
    bytes.map(|bytes| Attachment::holding(file, &bytes).text).map_err(|why| unread(file, kind, why))
}

fn of_kind(file: &str, kind: &Kind) -> Result<String, Diagnostics> {
    let text = match file {
        "-" => text_of(std::io::stdin(), "standard input", kind),
        _ => open(Path::new(file), file, kind),
    };
    text.map_err(|why| unread(file, kind, why))
}

/// Why a file was not read, with the nearest name of those that are there.
fn unread(file: &str, kind: &Kind, (message, hint): Unread) -> Diagnostics {
    let d = Diagnostic::new(Code::Unreadable, "", message);
    let near = neighbours(Path::new(file), kind);
    let d = if file == "-" || Path::new(file).exists() { d } else { d.suggest(file, near.iter().map(String::as_str)) };
    // A suggestion is for the command line and replaces nothing in a text.
    let mut d = d.hint(hint);
    d.replacement = None;
    d.into()
}

/// Files of that kind where a file was looked for.
fn neighbours(file: &Path, kind: &Kind) -> Vec<String> {
    const MOST: usize = 10_000;
    let folder = file.parent().filter(|p| !p.as_os_str().is_empty());
    let Ok(entries) = std::fs::read_dir(folder.unwrap_or(Path::new("."))) else { return vec![] };
    let names = entries.take(MOST).flatten().map(|e| Path::new(&e.file_name()).to_owned());
    let fitting = names.filter(|n| n.extension().is_some_and(|e| e.eq_ignore_ascii_case(kind.ending)));
    fitting.map(|n| folder.map_or(n.clone(), |f| f.join(&n)).to_string_lossy().into_owned()).collect()
}

/// Reads the tables that a train file names: files in its folder, or in one of these. Says nothing of what is anywhere
/// else, not even whether it is there.
pub(crate) fn tables_of(file: &str, allowed: &[&Path]) -> impl FnMut(&str) -> Result<String, String> {
    let folder = Path::new(file).parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new(".")).to_owned();
    let allowed: Vec<PathBuf> = std::iter::once(&*folder).chain(allowed.iter().copied()).map(PathBuf::from).collect();
    let mut left = MOST_TABLES_MIB << 20;
    move |name| {
        let path = Path::new(name);
        let is_relative =
            path.components().all(|c| matches!(c, Component::Normal(_) | Component::CurDir | Component::ParentDir));
        if !is_relative || path.file_name().is_none() {
            return Err(format!("`{name}`: a table is named by its path from the folder of the train file"));
        }
        let outside = || {
            format!("{name}: is not in the folder of the train file; put it there, or allow its folder: --allow FOLDER")
        };
        let allowed: Vec<PathBuf> = allowed.iter().filter_map(|folder| folder.canonicalize().ok()).collect();
        let own = allowed.first().cloned().unwrap_or_default();
        let within = |path: &Path| allowed.iter().any(|folder| path.starts_with(folder));
        // First as it is written: what is elsewhere is not even looked for. Then as it is, through all links.
        if !within(&plain(&own.join(path))) {
            return Err(outside());
        }
        let io = |e: std::io::Error| format!("{name}: {e}; {PERMISSIONS}");
        let real = own.join(path).canonicalize().map_err(io)?;
        if !within(&real) {
            return Err(outside());
        }
        let text = open(&real, name, &TABLE).map_err(|(message, hint)| format!("{message}; {hint}"))?;
        left = left.checked_sub(text.len() as u64).ok_or_else(|| {
            format!("{name}: with it the tables are larger than {MOST_TABLES_MIB} MiB; {}", TABLE.too_large)
        })?;
        Ok(text)
    }
}

/// A path without steps up.
fn plain(path: &Path) -> PathBuf {
    let mut all = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => drop(all.pop()),
            Component::CurDir => {}
            other => all.push(other),
        }
    }
    all
}

/// Opens without waiting for anybody: a pipe without a writer is opened at once, and then found to be no file.
pub(crate) fn carefully(options: &mut OpenOptions, follow: bool) {
    #[cfg(unix)]
    {
        use rustix::fs::OFlags;
        use std::os::unix::fs::OpenOptionsExt;
        let flags = if follow { OFlags::NONBLOCK } else { OFlags::NONBLOCK | OFlags::NOFOLLOW };
        options.custom_flags(flags.bits() as i32);
    }
    #[cfg(not(unix))]
    let _ = (options, follow);
}

/// Opens an ordinary file and nothing else.
pub(crate) fn regular(path: &Path) -> std::io::Result<File> {
    let mut options = OpenOptions::new();
    carefully(options.read(true), true);
    let file = options.open(path)?;
    match file.metadata()?.is_file() {
        true => Ok(file),
        false => Err(std::io::Error::other("is no ordinary file")),
    }
}

/// A file that this program wrote.
pub(crate) fn whole(path: &Path) -> Result<Vec<u8>, String> {
    let mut bytes = vec![];
    let read = regular(path).and_then(|file| file.take((MOST_OWN_MIB << 20) + 1).read_to_end(&mut bytes));
    match read.map_err(|e| e.to_string())? as u64 > MOST_OWN_MIB << 20 {
        true => Err(format!("is larger than {MOST_OWN_MIB} MiB")),
        false => Ok(bytes),
    }
}

fn open(path: &Path, name: &str, kind: &Kind) -> Result<String, Unread> {
    text(open_bytes(path, name, kind)?, name, kind)
}

fn open_bytes(path: &Path, name: &str, kind: &Kind) -> Result<Vec<u8>, Unread> {
    // Not every system opens a directory.
    if path.is_dir() {
        return Err((format!("{name} is a directory"), kind.directory));
    }
    match regular(path) {
        Ok(file) => bytes_of(file, name, kind),
        Err(_) if path.exists() && !path.is_file() => Err((format!("{name} is no ordinary file"), STREAM)),
        Err(e) => Err((format!("{name}: {e}"), PERMISSIONS)),
    }
}

fn text_of(from: impl Read, name: &str, kind: &Kind) -> Result<String, Unread> {
    text(bytes_of(from, name, kind)?, name, kind)
}

fn bytes_of(from: impl Read, name: &str, kind: &Kind) -> Result<Vec<u8>, Unread> {
    let most = kind.most_mib << 20;
    let mut bytes = Vec::new();
    let read = from.take(most + 1).read_to_end(&mut bytes);
    read.map_err(|e| (format!("{name}: {e}"), PERMISSIONS))?;
    if bytes.len() as u64 > most {
        return Err((format!("{name} is larger than {} MiB", kind.most_mib), kind.too_large));
    }
    Ok(bytes)
}

fn text(bytes: Vec<u8>, name: &str, kind: &Kind) -> Result<String, Unread> {
    String::from_utf8(bytes).map_err(|e| {
        let at = e.utf8_error().valid_up_to();
        (format!("{name} is not text in UTF-8 (byte {at})"), kind.no_text)
    })
}
