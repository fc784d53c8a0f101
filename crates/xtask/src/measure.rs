//! `cargo xtask measure [--build]`: how long the way from text to answer is; and, from nothing, how long the program
//! takes to build and how large it is.
//!
//! The way is measured in imports, which are counted and not judged. A *module* is a `pub mod` of
//! `crates/willis/src/lib.rs`; those that `analysis` needs, directly or not, are the modules between text and answer. A
//! *hop* is an import of one of them by a file of another. A hop *climbs* if it leads to a module further down in
//! lib.rs. A *circle* is a group of files that import one another, directly or not; that a file and its own parts do
//! is left out, since a part is written to be used by the whole.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use crate::context::Context;
use crate::step::{Outcome, outcome, time};

/// Files by module path (`train::format::keys`), and the paths that each imports.
type Imports = BTreeMap<String, BTreeSet<String>>;

/// `cargo xtask measure`
pub(crate) fn measure(context: &Context) -> Outcome {
    let all = || -> Result<(), String> {
        way(context)?;
        if context.options.build { build(context) } else { Ok(()) }
    };
    outcome(all())
}

/// Builds the program from nothing, in a folder of its own, and says how large it is.
fn build(context: &Context) -> Result<(), String> {
    let folder = context.target.join("measure");
    for (what, features) in [("program", ""), ("lean program", " --no-default-features")] {
        let _ = fs::remove_dir_all(&folder);
        let words = format!("cargo build --quiet --release -p willis-cli{features}");
        let start = Instant::now();
        crate::context::passes(context.words(&words).env("CARGO_TARGET_DIR", &folder), &words)?;
        let took = time(start.elapsed());
        let program = folder.join("release").join(format!("willis{}", std::env::consts::EXE_SUFFIX));
        let size = fs::metadata(&program).map_err(|e| format!("{}: {e}", program.display()))?.len();
        let processors = std::thread::available_parallelism().map_or(1, |n| n.get());
        println!("{what}: {took} from nothing on {processors} processors, {:.1} MB", size as f64 / 1e6);
    }
    let _ = fs::remove_dir_all(&folder);
    Ok(())
}

/// Prints the way from text to answer.
fn way(context: &Context) -> Result<(), String> {
    let src = context.root.join("crates/willis/src");
    let read = |path: &Path| fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()));
    let lib = read(&src.join("lib.rs"))?;
    let order: Vec<&str> = lib.lines().filter_map(|l| l.strip_prefix("pub mod ")?.strip_suffix(';')).collect();
    let mut sources = BTreeMap::new();
    for file in rust_files(&src)? {
        let path = file.strip_prefix(&src).unwrap_or(&file).with_extension("");
        let name = path.components().map(|c| c.as_os_str().to_string_lossy()).collect::<Vec<_>>().join("::");
        if name != "lib" && !name.ends_with("tests") {
            sources.insert(name, read(&file)?);
        }
    }
    let imports: Imports =
        sources.iter().map(|(name, text)| (name.clone(), imports_of(name, text, &sources))).collect();

    let module = |file: &str| file.split("::").next().unwrap_or_default().to_owned();
    let mut reached = BTreeSet::from(["analysis".to_owned()]);
    loop {
        let inside = imports.iter().filter(|(file, _)| reached.contains(&module(file)));
        let more: BTreeSet<String> = inside.flat_map(|(_, used)| used.iter().map(|u| module(u))).collect();
        if more.is_subset(&reached) {
            break;
        }
        reached.extend(more);
    }
    let rank = |m: &str| order.iter().position(|o| *o == m);
    let (mut hops, mut climbs) = (0, Vec::new());
    for (file, used) in imports.iter().filter(|(file, _)| reached.contains(&module(file))) {
        for other in used.iter().filter(|o| module(o) != module(file)) {
            hops += 1;
            if rank(&module(other)) > rank(&module(file)) {
                climbs.push(format!("{file} -> {other}"));
            }
        }
    }
    println!("from text to answer: {} modules, {hops} hops, {} of them climb", reached.len(), climbs.len());
    climbs.iter().for_each(|c| println!("    {c}"));
    let circles = circles(&imports);
    println!("circles of files: {}", circles.len());
    circles.iter().for_each(|c| println!("    {}", c.join(", ")));
    Ok(())
}

fn rust_files(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let mut all = Vec::new();
    for entry in fs::read_dir(folder).map_err(|e| format!("{}: {e}", folder.display()))? {
        let path = entry.map_err(|e| e.to_string())?.path();
        if path.is_dir() {
            all.extend(rust_files(&path)?);
        } else if path.extension().is_some_and(|e| e == "rs") {
            all.push(path);
        }
    }
    Ok(all)
}

/// Files that a source names, through `crate::` and `super::`; without itself.
fn imports_of(name: &str, text: &str, files: &BTreeMap<String, String>) -> BTreeSet<String> {
    let code: String = text.lines().map(|l| l.split("//").next().unwrap_or_default().to_owned() + "\n").collect();
    let parent = name.rsplit_once("::").map_or("", |p| p.0);
    let mut found = BTreeSet::new();
    for (marker, base) in [("crate::", ""), ("super::", parent)] {
        for (at, _) in code.match_indices(marker) {
            let before = code[..at].chars().next_back();
            if before.is_some_and(|c| c.is_alphanumeric() || c == '_' || c == ':' || c == '$') {
                continue;
            }
            for path in paths(&code[at + marker.len()..]) {
                let whole = if base.is_empty() { path } else { format!("{base}::{path}") };
                found.extend(longest(&whole, files));
            }
        }
    }
    found.remove(name);
    found
}

/// The file that holds what a path names.
fn longest(path: &str, files: &BTreeMap<String, String>) -> Option<String> {
    let mut path = path;
    loop {
        if files.contains_key(path) {
            return Some(path.to_owned());
        }
        path = path.rsplit_once("::")?.0;
    }
}

/// The paths at the begin of a text: `a::b`, or each of `a::{b, c::d}`.
fn paths(text: &str) -> Vec<String> {
    let word = |c: char| c.is_alphanumeric() || c == '_';
    let text = text.trim_start();
    if let Some(inside) = text.strip_prefix('{') {
        let (mut depth, mut begin, mut all) = (0, 0, Vec::new());
        for (k, c) in inside.char_indices() {
            match c {
                ',' if depth == 0 => {
                    all.extend(paths(&inside[begin..k]));
                    begin = k + 1;
                }
                '}' if depth == 0 => {
                    all.extend(paths(&inside[begin..k]));
                    break;
                }
                '{' => depth += 1,
                '}' => depth -= 1,
                _ => {}
            }
        }
        return all;
    }
    let end = text.find(|c| !word(c)).unwrap_or(text.len());
    let (first, rest) = text.split_at(end);
    if first.is_empty() {
        return vec![];
    }
    match rest.strip_prefix("::").map(paths) {
        Some(more) if !more.is_empty() => more.into_iter().map(|m| format!("{first}::{m}")).collect(),
        _ => vec![first.to_owned()],
    }
}

/// Groups of files of which each reaches all the others.
fn circles(imports: &Imports) -> Vec<Vec<&str>> {
    let part = |of: &str, whole: &str| of.strip_prefix(whole).is_some_and(|rest| rest.starts_with("::"));
    let reach = |from: &str| {
        let (mut seen, mut open) = (BTreeSet::new(), vec![from.to_owned()]);
        while let Some(file) = open.pop() {
            for other in &imports[&file] {
                if !part(&file, other) && !part(other, &file) && seen.insert(other.clone()) {
                    open.push(other.clone());
                }
            }
        }
        seen
    };
    let reached: BTreeMap<&str, BTreeSet<String>> = imports.keys().map(|f| (f.as_str(), reach(f))).collect();
    let mut groups: Vec<Vec<&str>> = Vec::new();
    for (file, to) in &reached {
        if groups.iter().any(|g| g.contains(file)) || !to.contains(*file) {
            continue;
        }
        groups.push(
            reached.iter().filter(|(o, back)| to.contains(**o) && back.contains(*file)).map(|(o, _)| *o).collect(),
        );
    }
    groups
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn imports_are_read_with_their_braces() {
        assert_eq!(paths("a::b::C;"), ["a::b::C"]);
        assert_eq!(paths("a::{self, b::{C, D}, e::f};"), ["a::self", "a::b::C", "a::b::D", "a::e::f"]);
        assert_eq!(paths("{a, b::c}"), ["a", "b::c"]);
    }

    #[test]
    fn circles_are_found_and_parts_are_none() {
        let files = ["a", "a::x", "b", "c"].map(|n| (n.to_owned(), String::new())).into();
        let of = |name: &str, text: &str| (name.to_owned(), imports_of(name, text, &files));
        let all: Imports = [
            of("a", "use crate::b::B; // crate::c\nuse crate::a::x::X;"),
            of("a::x", "use super::A; use super::super::c;"),
            of("b", "use crate::c;"),
            of("c", "use crate::{a, b};"),
        ]
        .into();
        assert_eq!(circles(&all), [["a", "b", "c"]]);
    }
}
