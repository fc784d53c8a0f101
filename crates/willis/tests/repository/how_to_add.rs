//! CONTRIBUTING.md says which files an addition takes. Each such list names a specimen that exists, and must hold every
//! file in which the specimen stands, and no other.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// A section of CONTRIBUTING.md with a specimen.
struct Addition {
    title: String,
    /// Names of the specimen, as the code has them.
    names: Vec<String>,
    /// Paths in the numbered list.
    files: BTreeSet<String>,
}

/// What stands in backticks.
fn spans(text: &str) -> impl Iterator<Item = &str> {
    text.split('`').skip(1).step_by(2)
}

fn additions() -> Vec<Addition> {
    let text = fs::read_to_string(root().join("CONTRIBUTING.md")).unwrap();
    let mut all = Vec::new();
    for section in text.split("\n## ").filter(|s| s.starts_with("Add ")) {
        let Some(specimen) = section.lines().find_map(|l| l.strip_prefix("Specimen: ")) else { continue };
        // An entry of a list begins with its number; its other lines are indented.
        let list = section.lines().filter(|l| l.starts_with(|c: char| c.is_ascii_digit() || c == ' '));
        let paths = list.flat_map(spans).filter(|s| s.contains('/') && !s.contains(' '));
        all.push(Addition {
            title: section.lines().next().unwrap_or_default().to_owned(),
            names: spans(specimen).map(str::to_owned).collect(),
            files: paths.map(str::to_owned).collect(),
        });
    }
    assert!(all.len() >= 8, "only {} sections have a specimen", all.len());
    all
}

/// Programs, libraries and their data: path and code, without comments and without tests.
fn sources() -> Vec<(String, String)> {
    fn files(folder: &Path) -> Vec<PathBuf> {
        let entries = fs::read_dir(folder).into_iter().flatten().map(|e| e.unwrap().path());
        entries.flat_map(|p| if p.is_dir() { files(&p) } else { vec![p] }).collect()
    }
    let members = fs::read_dir(root().join("crates")).unwrap().map(|e| e.unwrap().path());
    let all = members.flat_map(|m| ["src", "data"].map(|folder| files(&m.join(folder)))).flatten();
    let code = |path: PathBuf| {
        let name = path.strip_prefix(root()).unwrap().to_str().unwrap().replace('\\', "/");
        let text = fs::read_to_string(&path).unwrap_or_else(|e| panic!("{name}: {e}"));
        if !name.ends_with(".rs") {
            return (name, text);
        }
        let code = text.lines().map(|l| l.split("//").next().unwrap_or_default()).collect::<Vec<_>>().join("\n");
        (name, code.split("#[cfg(test)]\nmod ").next().unwrap_or_default().to_owned())
    };
    // Copies of examples are for tests.
    let is_copy = |p: &PathBuf| p.parent().is_some_and(|folder| folder.ends_with("examples"));
    let all: Vec<_> = all.filter(|p| !p.ends_with("tests.rs") && !is_copy(p)).map(code).collect();
    assert!(all.len() > 300, "{}", all.len());
    all
}

/// Whether a name stands in a text as a word or as a part of a longer name: `tornado` in `draw_tornado`, `Tornado` in
/// `TornadoBar`, but `cycle` not in `bicycle`.
fn stands(name: &str, text: &str) -> bool {
    let capital = name.starts_with(|c: char| c.is_ascii_uppercase());
    text.match_indices(name).any(|(at, _)| {
        let before = text[..at].chars().next_back();
        let after = text[at + name.len()..].chars().next();
        (capital || !before.is_some_and(char::is_alphanumeric))
            && !after.is_some_and(|c| c.is_lowercase() || c.is_numeric())
    })
}

#[test]
fn a_list_has_every_file_of_its_specimen_and_no_other() {
    let sources = sources();
    let mut wrong = Vec::new();
    for Addition { title, names, files } in additions() {
        assert!(!names.is_empty() && !files.is_empty(), "`{title}`: no specimen in backticks, or no list of files");
        let is_in = |text: &str| names.iter().any(|name| stands(name, text));
        let named = names.join("`, `");
        for (path, _) in sources.iter().filter(|s| is_in(&s.1) && !files.contains(&s.0)) {
            wrong.push(format!("`{title}`: `{named}` also stands in {path}, which is not in the list"));
        }
        for path in &files {
            let found = match sources.iter().find(|s| s.0 == *path) {
                Some((_, code)) => is_in(code),
                // Tests and the book are no code here; what the list names there must hold the specimen too.
                None => fs::read_to_string(root().join(path)).is_ok_and(|text| is_in(&text)),
            };
            if !found {
                wrong.push(format!("`{title}` lists {path}, in which `{named}` does not stand"));
            }
        }
    }
    assert!(wrong.is_empty(), "CONTRIBUTING.md is not what the code is:\n{}", wrong.join("\n"));
}

#[test]
fn a_specimen_is_found_as_a_word() {
    for (name, text) in [("tornado", "fn draw_tornado("), ("Tornado", "PlainTornadoBar"), ("x-y", "\"x-y\"")] {
        assert!(stands(name, text), "{name} in {text}");
    }
    for (name, text) in [("cycle", "bicycle"), ("cycle", "cycles"), ("Explain", "Explained"), ("w303", "w3031")] {
        assert!(!stands(name, text), "{name} in {text}");
    }
}
