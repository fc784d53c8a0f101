//! `willis export`: files for other programs, whole or not at all.

use std::io::Write;
use std::path::{Path, PathBuf};

use willis::study::export::{Export, KINDS};

use crate::output;

/// The formats, one line each.
pub fn list() -> String {
    KINDS.iter().map(|k| format!("{:<21}{}\n", k.id, k.about)).collect()
}

/// Writes what came out, or gives it back where no place is named. Notes go to standard error.
pub fn deliver(export: &Export, place: Option<&Path>, force: bool) -> Result<String, String> {
    let one = match export.files.as_slice() {
        [one] => Some(one),
        _ => None,
    };
    let Some(place) = place else {
        let Some(one) = one else {
            let n = export.files.len();
            return Err(format!("this makes {n} files, one a state: name a folder for them with -o\n"));
        };
        tell(&export.notes);
        return Ok(one.text.clone());
    };
    let folder = one.is_none() || place.is_dir() || place.as_os_str().to_string_lossy().ends_with(['/', '\\']);
    let paths: Vec<PathBuf> = match folder {
        true => export.files.iter().map(|f| place.join(&f.name)).collect(),
        false => vec![place.to_owned()],
    };
    for (k, path) in paths.iter().enumerate() {
        if paths[..k].contains(path) {
            return Err(format!("{}: two states make a file of this name; export them one by one\n", path.display()));
        }
        if path.exists() && !force {
            return Err(format!("{}: is there already; --force writes over it\n", path.display()));
        }
    }
    if folder {
        std::fs::create_dir_all(place).map_err(|e| format!("{}: {e}\n", place.display()))?;
    }
    let mut said = String::new();
    for (path, file) in paths.iter().zip(&export.files) {
        output::write(path, file.text.as_bytes())?;
        said += &format!("{}: {}\n", path.display(), file.about);
    }
    tell(&export.notes);
    Ok(said)
}

fn tell(notes: &[String]) {
    let text: String = notes.iter().map(|n| crate::text::wrap(n, "note: ") + "\n").collect();
    let _ = anstream::stderr().write_all(text.as_bytes());
}
