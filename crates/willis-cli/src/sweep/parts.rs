//! The folder beside a table in which finished pieces are kept until the table is whole.
//!
//! `map.csv.parts` belongs to this program when `study.json` in it says so, or when nothing is in it that a run leaves
//! before it writes that. Nothing else is ever removed, by whatever force.

use std::fs::{self, File, OpenOptions};
use std::io::Read;
use std::ops::Range;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use willis::contract::{Contract, Format};
use willis::study::{Shard, Summary, SweepReport as Report, SweepStudy as Study};

use super::piece::Piece;
use super::table::Form;
use crate::input;
use crate::output::{self, Unfinished};

/// Whose pieces they are.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Begun {
    format: Format<Self>,
    study: Study,
    shard: Option<Shard>,
}

impl Contract for Begun {
    const FORMAT: &'static str = "willis-parts-1";
}

/// What is kept beside a piece.
#[derive(Serialize, Deserialize)]
struct Kept {
    sha256: String,
    summary: Summary,
}

/// Names of files in the folder. The report is written before the table takes its name: it tells which table is ours.
const BEGUN: &str = "study.json";
const REPORT: &str = "report.json";
const LOCK: &str = "willis.lock";

/// What is said beside a table.
pub fn sidecar(out: &Path) -> PathBuf {
    with_end(out, ".json")
}

fn with_end(path: &Path, end: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(end);
    PathBuf::from(name)
}

/// Of a file.
pub fn sha256_of(path: &Path) -> std::io::Result<String> {
    let (mut hash, mut file) = (Sha256::new(), input::regular(path)?);
    let mut buffer = vec![0; 1 << 20];
    loop {
        match file.read(&mut buffer)? {
            0 => return Ok(hex(&hash.finalize())),
            n => hash.update(&buffer[..n]),
        }
    }
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|b| format!("{b:02x}")).collect()
}

/// The finished pieces of a table.
pub struct Parts {
    path: PathBuf,
    out: PathBuf,
    form: Form,
    force: bool,
    /// Held as long as this run works here.
    _lock: File,
}

impl Parts {
    /// Takes up what an interrupted run left, or begins.
    pub fn open(out: &Path, form: Form, study: &Study, shard: Option<Shard>, force: bool) -> Result<Self, String> {
        output::possible(out)?;
        output::possible(&sidecar(out))?;
        let path = with_end(out, ".parts");
        match fs::symlink_metadata(&path) {
            Err(_) => {
                // Nothing is begun that could not be finished.
                output::free(out, force)?;
                output::free(&sidecar(out), force)?;
                match fs::create_dir(&path) {
                    Err(e) if e.kind() != std::io::ErrorKind::AlreadyExists => return Err(output::told(&path)(e)),
                    _ => {}
                }
            }
            Ok(there) if !there.is_dir() => {
                let told = "finished pieces would be kept there, and something else is; move it, or give another name";
                return Err(format!("{}: {told}\n", path.display()));
            }
            Ok(_) => {}
        }
        let strange = strangers(&path)?;
        if let Some(name) = strange.first() {
            let told = format!("finished pieces would be kept there, and it holds `{}`", name.escape_debug());
            return Err(format!(
                "{}: {told}, which is not of a sweep; move it, or give another name\n",
                path.display()
            ));
        }
        let lock = lock(&path)?;
        let own = Self { path, out: out.to_owned(), form, force, _lock: lock };
        let begun = Begun { format: Format::new(), study: study.clone(), shard };
        let there = own.begun()?;
        if there.as_ref() == Some(&begun) {
            return Ok(own);
        }
        if there.is_some() && !force {
            let told = "pieces of another sweep; finish that one with its own command, or add --force to drop them";
            return Err(format!("{}: {told}\n", own.path.display()));
        }
        if let Err(why) = output::free(out, force).and_then(|()| output::free(&sidecar(out), force)) {
            // Nothing was begun here.
            if there.is_none() {
                own.remove();
            }
            return Err(why);
        }
        own.empty();
        let told = serde_json::to_string_pretty(&begun).expect("plain data");
        output::write(&own.path.join(BEGUN), told.as_bytes(), true)?;
        Ok(own)
    }

    /// Where the pieces are.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Whose pieces are here: none where nothing was begun.
    fn begun(&self) -> Result<Option<Begun>, String> {
        let path = self.path.join(BEGUN);
        let unread = |why: String| {
            let told = "whose pieces these are cannot be read, and they are kept; move the folder to begin anew";
            format!("{}: {told} ({why})\n", path.display())
        };
        if fs::symlink_metadata(&path).is_err() {
            let pieces = names(&self.path)?.into_iter().any(|n| is_piece(&n));
            return if pieces { Err(unread("it is not there".into())) } else { Ok(None) };
        }
        let text = input::whole(&path).map_err(unread)?;
        serde_json::from_slice(&text).map(Some).map_err(|e| unread(e.to_string()))
    }

    /// The report of a table that is whole already: a run was killed while it tidied up.
    pub fn whole(&self) -> Result<Option<Report>, String> {
        let (path, beside) = (self.path.join(REPORT), sidecar(&self.out));
        let text = input::whole(&path).ok();
        let report: Option<Report> = text.as_deref().and_then(|text| serde_json::from_slice(text).ok());
        let is_there = |path: &Path| fs::symlink_metadata(path).is_ok();
        let own_table = report.as_ref().is_some_and(|r| sha256_of(&self.out).ok() == r.table_sha256);
        let own_sidecar = text.is_some() && input::whole(&beside).ok() == text;
        if is_there(&self.out) && !own_table {
            output::free(&self.out, self.force)?;
        }
        if is_there(&beside) && !own_sidecar {
            output::free(&beside, self.force)?;
        }
        let (Some(report), Some(text), true) = (report, text, own_table) else { return Ok(None) };
        if !own_sidecar {
            output::write(&beside, &text, self.force)?;
        }
        self.remove();
        Ok(Some(report))
    }

    fn piece(&self, k: u64) -> PathBuf {
        self.path.join(format!("{k:09}.{}", self.form.name()))
    }

    /// A piece counts when what is said of it was written, after it, and is true.
    pub fn has(&self, k: u64) -> bool {
        self.kept(k).is_ok_and(|kept| sha256_of(&self.piece(k)).is_ok_and(|own| own == kept.sha256))
    }

    fn kept(&self, k: u64) -> Result<Kept, String> {
        let path = self.piece(k).with_extension("json");
        let fail = |why: String| format!("{}: {why}\n", path.display());
        serde_json::from_slice(&input::whole(&path).map_err(fail)?).map_err(|e| fail(e.to_string()))
    }

    /// Keeps a piece. It is checked before it is taken for whole, so that no disk is waited for; the table is.
    pub fn keep(&self, k: u64, bytes: &[u8], summary: &Summary) -> Result<(), String> {
        let piece = self.piece(k);
        output::write_checked(&piece, bytes)?;
        let kept = Kept { sha256: hex(&Sha256::digest(bytes)), summary: summary.clone() };
        output::write_checked(&piece.with_extension("json"), &serde_json::to_vec(&kept).expect("plain data"))
    }

    /// What to do after an error.
    pub fn advice(&self) -> String {
        format!(
            "finished pieces are kept in {}; with the cause removed the same command goes on from there\n",
            self.path.display()
        )
    }

    /// What all pieces say together.
    pub fn summary(&self, pieces: Range<u64>) -> Result<Summary, String> {
        let mut all = Summary::default();
        for k in pieces {
            all.join(&self.kept(k)?.summary);
        }
        Ok(all)
    }

    /// The table and what is said of it; then the pieces go.
    pub fn finish(&self, pieces: Range<u64>, report: &mut Report) -> Result<(), String> {
        let pieces: Vec<Piece> = pieces.map(|k| Piece { path: self.piece(k), is_table: false }).collect();
        let mut write = || -> Result<(), String> {
            let table = table(&self.out, self.form, &pieces, report, self.force)?;
            let told = said(report);
            output::write(&self.path.join(REPORT), told.as_bytes(), true)?;
            table.complete()?;
            // A run that was killed may have written it; what is there else was seen at the beginning.
            let is_own = input::whole(&sidecar(&self.out)).is_ok_and(|text| text == told.as_bytes());
            output::write(&sidecar(&self.out), told.as_bytes(), self.force || is_own)
        };
        write().map_err(|e| format!("{e}{}", self.advice()))?;
        self.remove();
        Ok(())
    }

    /// Removes everything that a sweep leaves here, but for the lock: pieces first and the report last, so that whoever
    /// goes on from the middle of it finds out what is done.
    fn empty(&self) {
        let mut all: Vec<String> = names(&self.path).unwrap_or_default();
        all.retain(|n| is_own(n) && n != LOCK);
        all.sort_by_key(|n| [BEGUN, REPORT].iter().position(|last| n == last).map_or(0, |k| k + 1));
        for name in all {
            let _ = fs::remove_file(self.path.join(name));
        }
    }

    /// Removes the folder, if nothing else is in it.
    fn remove(&self) {
        self.empty();
        let _ = fs::remove_file(self.path.join(LOCK));
        let _ = fs::remove_dir(&self.path);
    }
}

/// A table of pieces, still without its name; the report is told what is in it.
pub fn table(out: &Path, form: Form, pieces: &[Piece], report: &mut Report, force: bool) -> Result<Unfinished, String> {
    let table = Unfinished::new(out, force)?;
    let told = serde_json::to_string(&report.study).expect("plain data");
    let file = table.file().try_clone().map_err(output::told(out))?;
    form.join(&report.study.columns, &told, pieces, file).map_err(|e| format!("{}: {e}\n", out.display()))?;
    report.table_sha256 = Some(sha256_of(table.path()).map_err(output::told(out))?);
    Ok(table)
}

/// What is said beside a table.
pub fn said(report: &Report) -> String {
    serde_json::to_string_pretty(report).expect("plain data") + "\n"
}

/// Names of the entries of a folder.
fn names(path: &Path) -> Result<Vec<String>, String> {
    let entries = fs::read_dir(path).map_err(output::told(path))?;
    let mut all: Vec<String> = entries.flatten().map(|e| e.file_name().to_string_lossy().into_owned()).collect();
    all.sort();
    Ok(all)
}

/// Entries of the folder that no sweep leaves there.
fn strangers(path: &Path) -> Result<Vec<String>, String> {
    let is_file = |name: &String| fs::symlink_metadata(path.join(name)).map_or(true, |m| m.is_file());
    Ok(names(path)?.into_iter().filter(|n| !is_own(n) || !is_file(n)).collect())
}

/// Whether a sweep leaves a file of this name.
fn is_own(name: &str) -> bool {
    [BEGUN, REPORT, LOCK].contains(&name) || is_piece(name) || output::is_unfinished(name)
}

fn is_piece(name: &str) -> bool {
    let forms = ["csv", "jsonl", "parquet", "json"];
    name.split_once('.').is_some_and(|(number, form)| {
        number.len() >= 9 && number.bytes().all(|b| b.is_ascii_digit()) && forms.contains(&form)
    })
}

/// The lock of a folder, which lives as long as the folder.
fn lock(path: &Path) -> Result<File, String> {
    let place = path.join(LOCK);
    let fail = output::told(&place);
    let busy = || format!("{}: another willis is writing here; wait for that, or give another name\n", path.display());
    // Who tidied up just now has removed the lock that was waited for.
    for _ in 0..100 {
        let mut options = OpenOptions::new();
        // What it holds is nobody's, and a link is never followed.
        options.read(true).write(true).create(true).truncate(false);
        input::carefully(&mut options, false);
        let file = match options.open(&place) {
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => return Err(busy()),
            opened => opened.map_err(&fail)?,
        };
        match file.try_lock() {
            Err(fs::TryLockError::WouldBlock) => return Err(busy()),
            // A file system without locks has to do without.
            _ if output::leads_to(&place, &file) => return Ok(file),
            _ => {}
        }
    }
    Err(busy())
}
