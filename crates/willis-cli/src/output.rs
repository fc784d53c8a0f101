//! Writing files: whole or not at all, and nothing of the user's unasked. Every file that any command writes goes through
//! here.
//!
//! A file is written under another name beside its target and takes its own name when it is whole and on the disk. What is
//! at the target is replaced only by force; a link counts as what is there and is itself replaced, never what it leads to:
//! else a folder that came from somebody else could lead the output anywhere.

use std::fs::{self, File, TryLockError};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use tempfile::NamedTempFile;

/// What the name of an unfinished file ends with.
const UNFINISHED: &str = ".willis-part";

/// The unfinished files of this program, for an end that waits for nothing.
static OPEN: Mutex<Vec<PathBuf>> = Mutex::new(vec![]);

/// Leaves no unfinished file behind.
pub fn clear() {
    for path in OPEN.lock().unwrap_or_else(PoisonError::into_inner).drain(..) {
        let _ = fs::remove_file(path);
    }
}

/// Whether a file of this name is one that was not finished.
pub fn is_unfinished(name: &str) -> bool {
    name.ends_with(UNFINISHED)
}

/// An error of the system with the file that it is about.
pub fn told(path: &Path) -> impl Fn(io::Error) -> String {
    move |e| match e.kind() {
        ErrorKind::AlreadyExists => format!("{}: {TAKEN}\n", path.display()),
        _ => format!("{}: {e}\n", path.display()),
    }
}

const TAKEN: &str = "is there already; --force replaces it";

/// Refuses to write over what is read, whatever is forced.
pub fn apart(out: &Path, inputs: &[&Path]) -> Result<(), String> {
    let real = |p: &Path| p.canonicalize().ok();
    match inputs.iter().find(|p| **p == out || real(p).is_some_and(|r| real(out) == Some(r))) {
        Some(p) => Err(format!("{}: is read here and cannot be written over; give another name\n", p.display())),
        None => Ok(()),
    }
}

/// Refuses what cannot or must not be written, before anything is computed for it.
pub fn free(path: &Path, force: bool) -> Result<(), String> {
    possible(path)?;
    match fs::symlink_metadata(path).is_ok() && !force {
        true => Err(format!("{}: {TAKEN}\n", path.display())),
        false => Ok(()),
    }
}

/// Refuses where no file can be written, or only by breaking something. What earlier runs could not finish there is
/// cleared away.
pub fn possible(path: &Path) -> Result<(), String> {
    let told = |why: &str| Err(format!("{}: {why}\n", path.display()));
    if path.file_name().is_none() {
        return told("not the name of a file");
    }
    if path.is_dir() {
        return told("is a directory; name a file in it");
    }
    if path.exists() && !path.is_file() {
        return told("is no ordinary file");
    }
    let folder = folder_of(path);
    if !folder.is_dir() {
        return told("its folder does not exist");
    }
    // A link there stands for a stream; a file in its place would break other programs.
    if folder.canonicalize().is_ok_and(|f| ["/dev", "/proc", "/sys"].iter().any(|s| f.starts_with(s))) {
        return told("is a place of the system; without -o the answer goes to standard output");
    }
    match fs::symlink_metadata(path) {
        // A name that the system cannot have, a folder that nobody may look into.
        Err(e) if e.kind() != ErrorKind::NotFound => return told(&e.to_string()),
        _ => {}
    }
    clear_unfinished(path);
    // Whether a file can be made there is known only by making one.
    tempfile::tempfile_in(folder).map(drop).or_else(|e| told(&e.to_string()))
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// What the name of an unfinished file begins with. Cut: the name of a file may be as long as names can be.
fn beginning(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    name.chars().take(40).collect::<String>() + "."
}

/// Removes what killed runs left beside a target. Whoever still writes holds a lock.
fn clear_unfinished(target: &Path) {
    const MOST: usize = 10_000;
    let begins = beginning(target);
    for entry in fs::read_dir(folder_of(target)).into_iter().flatten().take(MOST).flatten() {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        let is_own = name.starts_with(&begins) && is_unfinished(&name) && entry.file_type().is_ok_and(|t| t.is_file());
        if is_own && File::open(entry.path()).is_ok_and(|file| file.try_lock().is_ok()) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Whether a path still leads to an open file: nobody removed it before it was locked.
pub fn leads_to(path: &Path, file: &File) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        let at = |m: fs::Metadata| (m.dev(), m.ino());
        fs::symlink_metadata(path).map(at).ok() == file.metadata().map(at).ok()
    }
    // An open file cannot be removed there.
    #[cfg(not(unix))]
    {
        let _ = file;
        path.exists()
    }
}

/// A file that gets its name when it is whole; dropped before, it is gone.
pub struct Unfinished {
    file: NamedTempFile,
    target: PathBuf,
    force: bool,
}

impl Unfinished {
    /// Beside its target.
    pub fn new(target: &Path, force: bool) -> Result<Self, String> {
        let fail = told(target);
        let begins = beginning(target);
        let mut named = tempfile::Builder::new();
        named.prefix(&begins).suffix(UNFINISHED);
        #[cfg(unix)]
        let readable = std::os::unix::fs::PermissionsExt::from_mode(0o666);
        #[cfg(unix)]
        named.permissions(readable);
        loop {
            let file = named.tempfile_in(folder_of(target)).map_err(&fail)?;
            // Another run may just have taken it for one that was left behind.
            match file.as_file().try_lock() {
                Err(TryLockError::WouldBlock) => continue,
                Ok(()) if !leads_to(file.path(), file.as_file()) => continue,
                // A file system without locks has to do without.
                _ => {}
            }
            OPEN.lock().unwrap_or_else(PoisonError::into_inner).push(file.path().to_owned());
            return Ok(Self { file, target: target.to_owned(), force });
        }
    }

    /// The file to write into.
    pub fn file(&self) -> &File {
        self.file.as_file()
    }

    /// Where it is until it is whole.
    pub fn path(&self) -> &Path {
        self.file.path()
    }

    /// Gives it its name, on the disk too.
    pub fn complete(self) -> Result<(), String> {
        self.file().sync_all().map_err(told(&self.target))?;
        let folder = folder_of(&self.target).to_owned();
        self.name()?;
        // Some systems open no folders.
        let _ = File::open(folder).and_then(|folder| folder.sync_all());
        Ok(())
    }

    /// Gives it its name. Should the power fail, it may be empty or gone.
    fn name(self) -> Result<(), String> {
        let fail = told(&self.target);
        let before = fs::symlink_metadata(&self.target).ok().filter(|m| m.is_file());
        if let Some(before) = before {
            // Who may read the old file may read the new one, and nobody else.
            let _ = self.file().set_permissions(before.permissions());
        }
        let own = self.path().to_owned();
        let done = match self.force {
            true => self.file.persist(&self.target),
            false => self.file.persist_noclobber(&self.target),
        };
        OPEN.lock().unwrap_or_else(PoisonError::into_inner).retain(|p| *p != own);
        done.map(drop).map_err(|e| fail(e.error))
    }
}

/// Writes a file that its reader checks, and can do without: no disk is waited for.
pub fn write_checked(path: &Path, bytes: &[u8]) -> Result<(), String> {
    let unfinished = Unfinished::new(path, true)?;
    unfinished.file().write_all(bytes).map_err(told(path))?;
    unfinished.name()
}

/// Writes a file.
pub fn write(path: &Path, bytes: &[u8], force: bool) -> Result<(), String> {
    write_all(&[(path, bytes)], force)
}

/// Writes files: none takes its name before all of them are written.
pub fn write_all(files: &[(&Path, &[u8])], force: bool) -> Result<(), String> {
    let one = |(path, bytes): &(&Path, &[u8])| {
        let unfinished = Unfinished::new(path, force)?;
        unfinished.file().write_all(bytes).map_err(told(path))?;
        Ok(unfinished)
    };
    let all = files.iter().map(one).collect::<Result<Vec<_>, String>>()?;
    all.into_iter().try_for_each(Unfinished::complete)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("willis-output-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        folder
    }

    fn names(folder: &Path) -> Vec<String> {
        let mut all: Vec<String> =
            fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        all.sort();
        all
    }

    #[test]
    fn a_file_has_its_name_only_when_it_is_whole() {
        let folder = folder("whole");
        let path = folder.join("run.csv");
        fs::write(&path, "of yesterday").unwrap();
        let read = || fs::read_to_string(&path).unwrap();
        drop(Unfinished::new(&path, true).unwrap());
        assert_eq!((read().as_str(), names(&folder).len()), ("of yesterday", 1));
        let unfinished = Unfinished::new(&path, true).unwrap();
        assert_eq!(names(&folder).len(), 2);
        // Who looks for leftovers leaves it alone.
        free(&path, true).unwrap();
        assert_eq!(names(&folder).len(), 2);
        unfinished.complete().unwrap();
        assert_eq!((read().as_str(), names(&folder).len()), ("", 1));
        // Nobody was there when it was begun.
        let other = folder.join("other.csv");
        let unfinished = Unfinished::new(&other, false).unwrap();
        fs::write(&other, "of somebody else").unwrap();
        assert!(unfinished.complete().unwrap_err().contains("--force"));
        assert_eq!(fs::read_to_string(&other).unwrap(), "of somebody else");
        assert_eq!(names(&folder), ["other.csv", "run.csv"]);
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn what_was_left_behind_is_cleared_and_nothing_else() {
        let folder = folder("left");
        let path = folder.join("run.csv");
        for name in ["run.csv.Ab12Cd.willis-part", "run.csv.part", "other.csv.Ab12Cd.willis-part", "run.csv.bak"] {
            fs::write(folder.join(name), "x").unwrap();
        }
        free(&path, false).unwrap();
        assert_eq!(names(&folder), ["other.csv.Ab12Cd.willis-part", "run.csv.bak", "run.csv.part"]);
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn all_files_or_none() {
        let folder = folder("all");
        let (a, b) = (folder.join("a"), folder.join("nowhere/b"));
        assert!(write_all(&[(&a, b"a"), (&b, b"b")], false).is_err());
        assert!(names(&folder).is_empty());
        // A name as long as names can be.
        let long = folder.join("n".repeat(255));
        write(&long, b"long", false).unwrap();
        assert!(write(&long, b"long", false).unwrap_err().contains("is there already"));
        write(&long, b"longer", true).unwrap();
        assert_eq!(fs::read(&long).unwrap(), b"longer");
        fs::remove_dir_all(folder).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn a_link_is_replaced_and_what_it_leads_to_stays() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = folder("link");
        let (secret, link, dangling) = (folder.join("secret"), folder.join("out.csv"), folder.join("new.csv"));
        fs::write(&secret, "secret").unwrap();
        symlink(&secret, &link).unwrap();
        symlink(folder.join("nothing"), &dangling).unwrap();
        for path in [&link, &dangling] {
            assert!(free(path, false).unwrap_err().contains("is there already"));
            free(path, true).unwrap();
            assert!(write(path, b"out", false).is_err());
            write(path, b"out", true).unwrap();
            assert!(fs::symlink_metadata(path).unwrap().is_file());
        }
        assert_eq!(fs::read_to_string(&secret).unwrap(), "secret");
        assert_eq!(names(&folder), ["new.csv", "out.csv", "secret"]);
        assert!(free(Path::new("/dev/stdout"), true).is_err());
        assert!(free(Path::new("/dev/null"), true).is_err());
        // Who may read it stays.
        fs::set_permissions(&link, fs::Permissions::from_mode(0o600)).unwrap();
        write(&link, b"out", true).unwrap();
        assert_eq!(fs::metadata(&link).unwrap().permissions().mode() & 0o777, 0o600);
        fs::remove_dir_all(folder).unwrap();
    }
}
