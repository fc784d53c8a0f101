//! Writing a file whole, or not at all.

use std::path::Path;

/// Refuses to write over what is read, whatever is forced.
pub fn apart(out: &Path, inputs: &[&Path]) -> Result<(), String> {
    let real = |p: &Path| p.canonicalize().ok();
    match inputs.iter().find(|p| **p == out || real(p).is_some_and(|r| real(out) == Some(r))) {
        Some(p) => Err(format!("{}: is read here and cannot be written over; give another name\n", p.display())),
        None => Ok(()),
    }
}

/// Writes beside the target and renames, so that no half-written file is left behind.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), String> {
    let fail = |e: std::io::Error| format!("{}: {e}\n", path.display());
    let Some(name) = path.file_name() else {
        return Err(format!("{}: not the name of a file\n", path.display()));
    };
    if path.is_dir() {
        return Err(format!("{}: is a directory; name a file in it\n", path.display()));
    }
    let mut temporary = name.to_owned();
    temporary.push(format!(".{}.part", std::process::id()));
    let beside = path.with_file_name(temporary);
    let written = std::fs::write(&beside, bytes).and_then(|()| std::fs::rename(&beside, path));
    written.map_err(|e| {
        let _ = std::fs::remove_file(&beside);
        fail(e)
    })
}
