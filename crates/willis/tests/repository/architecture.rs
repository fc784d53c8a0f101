//! lib.rs lists the modules in pipeline order; a module uses only those above it. The physics
//! touches no file, clock, environment or thread.

use std::fs;
use std::path::{Path, PathBuf};

fn rust_files(dir: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(dir).unwrap().map(|e| e.unwrap().path());
    entries.flat_map(|p| if p.is_dir() { rust_files(&p) } else { vec![p] }).collect()
}

fn src() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

/// Code without comments.
fn code(path: &Path) -> String {
    let text = fs::read_to_string(path).unwrap();
    text.lines().map(|l| l.split("//").next().unwrap_or_default()).collect::<Vec<_>>().join("\n")
}

/// Modules named after `crate::`, also in `crate::{a, b::c}`.
fn used(code: &str) -> Vec<String> {
    let word = |t: &str| t.trim().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect::<String>();
    code.split("crate::")
        .skip(1)
        .flat_map(|rest| match rest.strip_prefix('{') {
            Some(list) => list.split("};").next().unwrap().split(',').map(word).collect::<Vec<_>>(),
            None => vec![word(rest)],
        })
        .collect()
}

#[test]
fn a_module_uses_only_those_above_it() {
    let lib = fs::read_to_string(src().join("lib.rs")).unwrap();
    let order: Vec<_> = lib.lines().filter_map(|l| l.strip_prefix("pub mod ")?.strip_suffix(';')).collect();
    assert!(order.len() > 5);
    // The root exports `Real` under its own name.
    let rank = |m: &str| order.iter().position(|o| *o == if m == "Real" { "real" } else { m });
    for file in rust_files(&src()) {
        let path = file.strip_prefix(src()).unwrap().to_str().unwrap().to_owned();
        let own = path.split(['/', '.']).next().unwrap();
        if own == "lib" {
            continue;
        }
        let code = code(&file);
        assert!(!code.contains("super::super"), "{path}: name the module through `crate::`");
        for name in used(&code) {
            let (Some(theirs), Some(ours)) = (rank(&name), rank(own)) else {
                panic!("{path} uses `crate::{name}`, which lib.rs does not list");
            };
            assert!(theirs <= ours, "{path} uses `{name}`, below `{own}` in lib.rs");
        }
    }
}

#[test]
fn the_physics_touches_nothing_outside() {
    for file in rust_files(&src()) {
        let code = code(&file);
        for outside in
            ["std::fs", "std::io", "std::env", "std::time", "std::thread", "std::net", "std::process", "println!"]
        {
            assert!(!code.contains(outside), "{} uses {outside}", file.display());
        }
    }
}
