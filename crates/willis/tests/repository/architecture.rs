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

/// Circles of imports that are known, as the files in each. A new one fails the test, and so does one that is gone.
const CIRCLES: &[&[&str]] = &[
    &["compiled", "compiled::iterated", "compiled::kernel"],
    &["regimes", "regimes::atlas"],
    &["train::assemble", "train::describe", "train::describe::dynamic", "train::expand", "train::input"],
];

/// The paths of an import, `a::{b, c::d}` taken apart.
fn paths(import: &str) -> Vec<String> {
    let Some((before, list)) = import.split_once('{') else {
        return vec![import.split(" as ").next().unwrap_or_default().trim().to_owned()];
    };
    let list = list.trim_end().strip_suffix('}').expect("closed");
    let (mut parts, mut depth) = (vec![String::new()], 0);
    for c in list.chars() {
        match c {
            ',' if depth == 0 => parts.push(String::new()),
            _ => {
                depth += i32::from(c == '{') - i32::from(c == '}');
                parts.last_mut().expect("one").push(c);
            }
        }
    }
    let parts = parts.iter().map(|p| p.trim()).filter(|p| !p.is_empty());
    parts.flat_map(|p| paths(&format!("{}{p}", before.trim()))).collect()
}

/// Files that a file imports from, tests aside. What it only hands on, as in `pub use`, is no import.
fn imports(module: &str, code: &str, all: &[String]) -> Vec<String> {
    let code = code.split("#[cfg(test)]\nmod tests").next().unwrap_or_default();
    let code = format!("\n{code}");
    let own: Vec<&str> = module.split("::").collect();
    let mut found = vec![];
    for import in code.split("\nuse ").skip(1).filter_map(|rest| rest.split(';').next()) {
        for path in paths(&import.split_whitespace().collect::<Vec<_>>().join(" ")) {
            let steps: Vec<&str> = path.split("::").map(str::trim).collect();
            let full: Vec<&str> = match steps[0] {
                "crate" => steps[1..].to_vec(),
                "super" => own[..own.len() - 1].iter().chain(&steps[1..]).copied().collect(),
                "self" => own.iter().chain(&steps[1..]).copied().collect(),
                _ => own.iter().chain(&steps).copied().collect(),
            };
            // The deepest file on the way; a name of another crate has none below this file.
            let file = (1..=full.len()).rev().map(|n| full[..n].join("::")).find(|m| all.contains(m));
            found.extend(file.filter(|file| file != module));
        }
    }
    found
}

/// A reader can take the files one after another: none imports from one that, step by step, imports from it.
#[test]
fn files_import_in_no_circle() {
    let modules: Vec<(String, String)> = rust_files(&src())
        .iter()
        .map(|file| {
            let path = file.strip_prefix(src()).unwrap().with_extension("");
            let name = path.iter().map(|p| p.to_str().unwrap()).collect::<Vec<_>>().join("::");
            (name, code(file))
        })
        .filter(|(name, _)| name != "lib")
        .collect();
    let all: Vec<String> = modules.iter().map(|m| m.0.clone()).collect();
    let imports: Vec<Vec<usize>> = modules
        .iter()
        .map(|(name, code)| {
            let found = imports(name, code, &all);
            found.iter().map(|f| all.iter().position(|m| m == f).expect("a file")).collect()
        })
        .collect();
    assert!(imports.iter().flatten().count() > 300, "imports are no longer found");
    // Everything that can be reached from a file.
    let reach = |from: usize| {
        let (mut seen, mut open) = (vec![false; all.len()], vec![from]);
        while let Some(k) = open.pop() {
            for &next in &imports[k] {
                if !std::mem::replace(&mut seen[next], true) {
                    open.push(next);
                }
            }
        }
        seen
    };
    let reached: Vec<Vec<bool>> = (0..all.len()).map(reach).collect();
    let mut circles: Vec<Vec<&str>> = (0..all.len())
        .filter(|&k| reached[k][k])
        .map(|k| {
            let mut circle: Vec<&str> =
                (0..all.len()).filter(|&j| reached[k][j] && reached[j][k]).map(|j| all[j].as_str()).collect();
            circle.sort_unstable();
            circle
        })
        .collect();
    circles.sort_unstable();
    circles.dedup();
    assert_eq!(circles, CIRCLES);
}
