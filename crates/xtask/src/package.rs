//! Every crate that is to be published makes a package that holds what it needs.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Component, Path, PathBuf};

use serde_json::Value;

use crate::context::Context;
use crate::step::{Outcome, outcome};

/// Fields of a manifest that a registry shows or asks for.
const FIELDS: &[&str] = &["description", "license", "readme", "keywords", "categories", "rust_version"];

/// `cargo xtask package`
pub(crate) fn package(context: &Context) -> Outcome {
    outcome(packages(context))
}

fn packages(context: &Context) -> Result<(), String> {
    let metadata = context.json("cargo metadata --format-version 1 --no-deps --offline")?;
    let empty = Vec::new();
    // `publish = false` is an empty list of registries.
    let published = |p: &&Value| p["publish"].as_array().is_none_or(|registries| !registries.is_empty());
    let all: Vec<&Value> = metadata["packages"].as_array().unwrap_or(&empty).iter().filter(published).collect();
    let mut wrong = Vec::new();
    for package in &all {
        let (name, missing) = (text(&package["name"]), FIELDS.iter().filter(|f| is_empty(&package[**f])));
        wrong.extend(missing.map(|field| format!("{name}: the manifest has no `{field}`")));
        if text(&package["repository"]).contains("invalid") {
            wrong.push(format!("{name}: `repository` leads nowhere"));
        }
    }
    if !wrong.is_empty() {
        return Err(wrong.join("\n"));
    }
    let chosen: String = all.iter().map(|p| format!(" -p {}", text(&p["name"]))).collect();
    // The sources were compiled by other steps; that they are all inside is looked at below.
    context.run(&format!("cargo package --no-verify --allow-dirty --offline --quiet{chosen}"))?;
    for package in &all {
        let name = text(&package["name"]);
        let words = format!("cargo package --list --allow-dirty --offline -p {name}");
        let output = context.output(&mut context.words(&words))?;
        let listed = String::from_utf8_lossy(&output.stdout).into_owned();
        let files: BTreeSet<PathBuf> = listed.lines().map(PathBuf::from).collect();
        let root = Path::new(text(&package["manifest_path"])).parent().unwrap_or(Path::new("")).to_owned();
        let needed = included(&root, Path::new("src"))?;
        wrong.extend(needed.difference(&files).map(|f| format!("{name}: `{}` is read but not inside", f.display())));
        let data: Vec<String> = needed.iter().map(|f| f.display().to_string()).collect();
        println!("{name}: {} files, of them read by the code: {}", files.len(), list(&data));
    }
    if wrong.is_empty() { Ok(()) } else { Err(wrong.join("\n")) }
}

fn text(value: &Value) -> &str {
    value.as_str().unwrap_or_default()
}

fn is_empty(value: &Value) -> bool {
    value.is_null() || value.as_array().is_some_and(Vec::is_empty)
}

fn list(all: &[String]) -> String {
    if all.is_empty() { "none".to_owned() } else { all.join(", ") }
}

/// Files that the sources under a folder of a crate read with `include_str!`, from the root of the crate.
fn included(root: &Path, folder: &Path) -> Result<BTreeSet<PathBuf>, String> {
    let mut found = BTreeSet::new();
    let path = root.join(folder);
    for entry in fs::read_dir(&path).map_err(|e| format!("{}: {e}", path.display()))? {
        let entry = entry.map_err(|e| format!("{}: {e}", path.display()))?;
        let file = folder.join(entry.file_name());
        if entry.path().is_dir() {
            found.extend(included(root, &file)?);
        } else if file.extension().is_some_and(|e| e == "rs") {
            let code = fs::read_to_string(entry.path()).map_err(|e| format!("{}: {e}", file.display()))?;
            found.extend(names(&code).into_iter().map(|name| plain(&folder.join(name))));
        }
    }
    Ok(found)
}

/// The names that a source reads as it is compiled; what only its documentation tests read is not needed.
fn names(code: &str) -> Vec<&str> {
    let lines = code.lines().filter(|l| !l.trim_start().starts_with("#[doc"));
    lines.filter_map(|l| l.split_once("include_str!(\"")?.1.split('"').next()).collect()
}

/// Without `..`.
fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir if plain.pop() => {}
            other => plain.push(other),
        }
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_found_where_they_are_read() {
        let code = "const A: &str = include_str!(\"../../data/oils.toml\");\n#[doc = include_str!(\"../README.md\")]\n";
        assert_eq!(names(code), ["../../data/oils.toml"]);
        assert_eq!(plain(Path::new("src/catalogue/../../data/oils.toml")), Path::new("data/oils.toml"));
        assert_eq!(plain(Path::new("src/../../examples/a.toml")), Path::new("../examples/a.toml"));
    }
}
