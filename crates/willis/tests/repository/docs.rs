//! The prose that can be wrong: trains in README and book are analysed, paths in ARCHITECTURE.md
//! exist. The Rust code in them runs as doctests.

use std::fs;
use std::path::{Path, PathBuf};

use willis::analysis::{Selection, analyze};
use willis::train::Train;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// README and the chapters of the book.
fn pages() -> Vec<PathBuf> {
    let chapters = fs::read_dir(root().join("book/src")).unwrap().map(|e| e.unwrap().path());
    let mut all: Vec<_> = chapters.filter(|p| p.extension().is_some_and(|e| e == "md")).collect();
    all.push(root().join("README.md"));
    all.sort();
    all
}

/// The fenced blocks of a page: line, info string, text.
fn blocks(page: &Path) -> Vec<(usize, String, String)> {
    let text = read(page);
    let mut all = Vec::new();
    let mut open: Option<(usize, String, String)> = None;
    for (k, line) in text.lines().enumerate() {
        match (&mut open, line.strip_prefix("```")) {
            (None, Some(info)) => open = Some((k + 1, info.trim().to_owned(), String::new())),
            (Some(_), Some(_)) => all.extend(open.take()),
            (Some((.., body)), None) => {
                body.push_str(line);
                body.push('\n');
            }
            (None, None) => {}
        }
    }
    assert!(open.is_none(), "{}: a fence is not closed", page.display());
    all
}

#[test]
fn trains_in_the_prose_are_good() {
    let mut count = 0;
    for page in pages() {
        for (line, _, text) in blocks(&page).into_iter().filter(|b| b.1 == "toml,train") {
            let at = format!("{}:{line}", page.display());
            let train = Train::from_toml(&text).unwrap_or_else(|e| panic!("{at}: {e}"));
            analyze(&train, &Selection::default()).unwrap_or_else(|e| panic!("{at}: {e}"));
            count += 1;
        }
    }
    assert!(count > 0, "no train found");
}

#[test]
fn every_block_says_what_it_is() {
    // A fence without a language, or with an unknown one, would be compiled as Rust or not at all. Python runs in the tests
    // of its package.
    let known = ["rust", "toml", "toml,train", "text", "console", "sh", "python"];
    let mut rust = 0;
    for page in pages() {
        for (line, info, _) in blocks(&page) {
            assert!(known.contains(&info.as_str()), "{}:{line}: block of kind `{info}`", page.display());
            rust += usize::from(info == "rust");
        }
    }
    assert!(rust > 0, "no Rust code found");
}

#[test]
fn every_page_is_in_the_summary() {
    let summary = read(&root().join("book/src/SUMMARY.md"));
    for page in pages() {
        let name = page.file_name().unwrap().to_str().unwrap();
        if !["README.md", "SUMMARY.md"].contains(&name) {
            assert!(summary.contains(&format!("({name})")), "{name} is not in SUMMARY.md");
        }
    }
}

#[test]
fn paths_in_the_architecture_exist() {
    let text = read(&root().join("ARCHITECTURE.md"));
    let prose: String = {
        let mut inside = false;
        let keep = |l: &&str| {
            let fence = l.starts_with("```");
            inside ^= fence;
            !inside && !fence
        };
        text.lines().filter(keep).collect::<Vec<_>>().join("\n")
    };
    let mut count = 0;
    for span in prose.split('`').skip(1).step_by(2) {
        let is_path = span.contains('/') || [".rs", ".toml", ".md"].iter().any(|e| span.ends_with(e));
        if !is_path || span.contains(' ') {
            continue;
        }
        // Of a pattern, the folder before the first wild card is looked for.
        let fixed = span.split('*').next().unwrap();
        assert!(root().join(fixed).exists(), "ARCHITECTURE.md names `{span}`, which does not exist");
        count += 1;
    }
    assert!(count > 10, "only {count} paths found");
}
