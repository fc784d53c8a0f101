//! Writing files: whole or not at all, and nothing of the user's unasked.

use std::path::Path;

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
    if path.exists() && !force {
        return told("is there already; --force replaces it");
    }
    if path.parent().is_some_and(|p| !p.as_os_str().is_empty() && !p.is_dir()) {
        return told("its folder does not exist");
    }
    Ok(())
}

/// Writes beside the target and renames, so that no half-written file is left behind. A link stays a link to what it
/// leads to.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), String> {
    let fail = |e: std::io::Error| format!("{}: {e}\n", path.display());
    let target = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let Some(name) = target.file_name() else {
        return Err(format!("{}: not the name of a file\n", path.display()));
    };
    let mut temporary = name.to_owned();
    temporary.push(format!(".{}.part", std::process::id()));
    let beside = target.with_file_name(temporary);
    let written = std::fs::write(&beside, bytes).and_then(|()| std::fs::rename(&beside, &target));
    written.map_err(|e| {
        let _ = std::fs::remove_file(&beside);
        fail(e)
    })
}
