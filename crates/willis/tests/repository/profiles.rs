//! What is published is optimised in full.

use std::fs;
use std::path::{Path, PathBuf};

use toml::{Table, Value};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn table(path: &Path) -> Table {
    fs::read_to_string(path).unwrap().parse().unwrap()
}

/// A profile and those that it inherits from, the nearest first.
fn inherited<'t>(profiles: &'t Table, name: &str) -> Vec<&'t Table> {
    let mut all = vec![];
    let mut next = Some(name);
    while let Some(profile) = next.and_then(|n| profiles.get(n)).and_then(Value::as_table) {
        all.push(profile);
        next = profile.get("inherits").and_then(Value::as_str);
    }
    all
}

fn level(profiles: &Table, profile: &str, package: &str) -> Option<i64> {
    let all = inherited(profiles, profile);
    let own = |p: &&Table| p.get("package")?.get(package)?.get("opt-level").cloned();
    let found = all.iter().find_map(own).or_else(|| all.iter().find_map(|p| p.get("opt-level").cloned()));
    found.and_then(|level| level.as_integer())
}

/// Crates from which a program or a library of machine code is linked.
fn linked() -> Vec<String> {
    let mut all = vec![];
    for folder in fs::read_dir(root().join("crates")).unwrap() {
        let folder = folder.unwrap().path();
        let manifest = table(&folder.join("Cargo.toml"));
        let name = manifest["package"]["name"].as_str().unwrap().to_owned();
        let kinds = manifest.get("lib").and_then(|lib| lib.get("crate-type")).and_then(Value::as_array);
        let is_dynamic = kinds.is_some_and(|kinds| kinds.iter().any(|k| k.as_str() == Some("cdylib")));
        if is_dynamic || manifest.contains_key("bin") {
            all.push(name);
        }
    }
    all
}

/// With optimisation at link time the crate that is linked decides whether loops become loops over vectors, in the code of
/// all others too: with `opt-level = "s"` there the published program took four times as long for a map.
#[test]
fn what_is_linked_for_publication_is_optimised_in_full() {
    let workspace = table(&root().join("Cargo.toml"));
    let profiles = workspace["profile"].as_table().unwrap();
    assert!(profiles["dist"].get("lto").is_some());
    // That for browsers is small, and has a profile of its own.
    let published: Vec<String> = linked().into_iter().filter(|name| name != "willis-web").collect();
    assert!(published.len() >= 3, "{published:?}");
    for name in published {
        assert_eq!(level(profiles, "dist", &name), Some(3), "{name} in the profile `dist`");
    }
    assert_eq!(level(profiles, "web", "willis"), None, "a word, \"z\"");
    assert_eq!(level(profiles, "release", "willis"), Some(3));
}
