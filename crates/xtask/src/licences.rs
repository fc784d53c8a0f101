//! What others wrote and we use: under licences that allow it, and without known holes.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::{env, fs};

use semver::{Version, VersionReq};
use serde_json::Value;
use spdx::{Expression, LicenseReq, ParseMode};

use crate::context::Context;
use crate::step::{Outcome, outcome};

/// Licences under which a program of ours may hold the code of others: permissive ones, and the one that binds only the
/// files it came with.
const ALLOWED: &[&str] = &[
    "0BSD",
    "Apache-2.0",
    "Apache-2.0 WITH LLVM-exception",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "BSL-1.0",
    "CC0-1.0",
    "ISC",
    "MIT",
    "MIT-0",
    "MPL-2.0",
    "NCSA",
    "Unicode-3.0",
    "Unlicense",
    "Zlib",
];

/// Packages that give a file of terms instead of a name, and what the file was found to say.
const READ: &[(&str, &str)] = &[];

/// `cargo xtask licences`
pub(crate) fn licences(context: &Context) -> Outcome {
    let metadata = match metadata(context) {
        Ok(metadata) => metadata,
        Err(e) => return Outcome::Failed(e),
    };
    outcome(judge(&metadata).map(|told| println!("{told}")))
}

/// All packages of all platforms, or of this one where those of others cannot be had.
fn metadata(context: &Context) -> Result<Value, String> {
    let words = "cargo metadata --format-version 1 --locked";
    context.json(words).or_else(|_| {
        let output = context.output(&mut context.words("rustc --print host-tuple"))?;
        let host = String::from_utf8_lossy(&output.stdout).trim().to_owned();
        println!("packages of other platforms than {host} cannot be had here");
        context.json(&format!("{words} --offline --filter-platform {host}"))
    })
}

/// Packages counted by licence, or those that are not allowed.
fn judge(metadata: &Value) -> Result<String, String> {
    let allowed: Vec<LicenseReq> = ALLOWED
        .iter()
        .map(|one| {
            let expression = Expression::parse(one).expect("an allowed licence is named as SPDX names it");
            expression.requirements().next().expect("it names one").req.clone()
        })
        .collect();
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    let mut wrong = Vec::new();
    for package in metadata["packages"].as_array().ok_or("cargo lists no packages")? {
        let name = package["name"].as_str().unwrap_or_default();
        let read = READ.iter().find(|r| r.0 == name).map(|r| r.1);
        let Some(licence) = package["license"].as_str().or(read) else {
            wrong.push(format!("{name}: no licence is named"));
            continue;
        };
        // Old packages write `MIT/Apache-2.0`.
        match Expression::parse_mode(licence, ParseMode::LAX) {
            Ok(e) if e.evaluate(|req| allowed.contains(req)) => *counts.entry(licence).or_default() += 1,
            Ok(_) => wrong.push(format!("{name}: `{licence}` is not on the list of `crates/xtask/src/licences.rs`")),
            Err(e) => wrong.push(format!("{name}: `{licence}`: {e}")),
        }
    }
    if !wrong.is_empty() {
        return Err(wrong.join("\n"));
    }
    let mut all: Vec<_> = counts.into_iter().collect();
    all.sort_by_key(|c| std::cmp::Reverse(c.1));
    Ok(all.iter().map(|(licence, count)| format!("{count:>4}  {licence}")).collect::<Vec<_>>().join("\n"))
}

/// `cargo xtask advisories`
pub(crate) fn advisories(context: &Context) -> Outcome {
    let Some(folder) = database(context) else {
        return Outcome::Skipped(
            "the database of rustsec.org cannot be had here; `WILLIS_ADVISORIES` names a folder with it".into(),
        );
    };
    let lock = || -> Result<(), String> {
        let text = fs::read_to_string(context.root.join("Cargo.lock")).map_err(|e| format!("Cargo.lock: {e}"))?;
        let lock: toml::Table = text.parse().map_err(|e| format!("Cargo.lock: {e}"))?;
        let (count, found) = holes(&lock, &folder)?;
        println!("{count} advisories read");
        if found.is_empty() { Ok(()) } else { Err(found.join("\n")) }
    };
    outcome(lock())
}

/// The folder of advisories: named, kept by cargo's own tools, or fetched.
fn database(context: &Context) -> Option<PathBuf> {
    let named = env::var_os("WILLIS_ADVISORIES").map(PathBuf::from);
    let home = env::var_os("CARGO_HOME").map(PathBuf::from).or_else(|| Some(env::home_dir()?.join(".cargo")));
    let fetched = context.target.join("advisory-db");
    let there = |folder: &PathBuf| folder.join("crates").is_dir();
    if let Some(found) = [named, home.map(|h| h.join("advisory-db"))].into_iter().flatten().find(there) {
        return Some(found);
    }
    let mut clone = context.words("git clone --quiet --depth 1 https://github.com/rustsec/advisory-db");
    let mut pull = context.words("git pull --quiet --depth 1");
    pull.current_dir(if there(&fetched) { &fetched } else { &context.root });
    // Nobody is there to be asked for a password.
    let command = if there(&fetched) { &mut pull } else { clone.arg(&fetched) };
    let _ = context.output(command.env("GIT_TERMINAL_PROMPT", "0"));
    there(&fetched).then_some(fetched)
}

/// How many advisories there are, and those that hold for a locked package.
fn holes(lock: &toml::Table, folder: &Path) -> Result<(usize, Vec<String>), String> {
    let (mut count, mut found) = (0, Vec::new());
    for package in lock.get("package").and_then(|p| p.as_array()).ok_or("Cargo.lock lists no packages")? {
        let (Some(name), Some(version)) = (package["name"].as_str(), package["version"].as_str()) else { continue };
        let version: Version = version.parse().map_err(|e| format!("{name} {version}: {e}"))?;
        let Ok(advisories) = fs::read_dir(folder.join("crates").join(name)) else { continue };
        for entry in advisories.flatten().filter(|e| e.path().extension().is_some_and(|e| e == "md")) {
            let text = fs::read_to_string(entry.path()).map_err(|e| format!("{}: {e}", entry.path().display()))?;
            count += 1;
            if let Some(told) = hole(&text, &version).map_err(|e| format!("{}: {e}", entry.path().display()))? {
                found.push(format!("{name} {version}: {told}"));
            }
        }
    }
    Ok((count, found))
}

/// What an advisory says of a version. Those that only inform (no longer maintained, say) are no holes.
fn hole(text: &str, version: &Version) -> Result<Option<String>, String> {
    let head = text.split("```toml").nth(1).and_then(|t| t.split("```").next()).ok_or("no table at its head")?;
    let head: toml::Table = head.parse().map_err(|e| format!("{e}"))?;
    let advisory = head.get("advisory").ok_or("no advisory")?;
    if advisory.get("informational").is_some() || advisory.get("withdrawn").is_some() {
        return Ok(None);
    }
    let without = |key: &str| -> Result<bool, String> {
        let all = head.get("versions").and_then(|v| v.get(key)).and_then(|v| v.as_array());
        let requirements = all.into_iter().flatten().filter_map(|r| r.as_str()).map(|r| r.parse::<VersionReq>());
        let requirements: Vec<_> = requirements.collect::<Result<_, _>>().map_err(|e| e.to_string())?;
        Ok(requirements.iter().any(|r| r.matches(version)))
    };
    if without("patched")? || without("unaffected")? {
        return Ok(None);
    }
    let title = text.lines().find_map(|l| l.strip_prefix("# ")).unwrap_or("no title");
    Ok(Some(format!("{}, {title}", advisory.get("id").and_then(|i| i.as_str()).unwrap_or("no number"))))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn package(licence: &str) -> Value {
        serde_json::json!({ "packages": [{ "name": "one", "license": licence }] })
    }

    #[test]
    fn licences_are_read_as_expressions() {
        for good in ["MIT OR Apache-2.0", "MIT/Apache-2.0", "GPL-3.0-only OR MIT", "(MIT OR Zlib) AND Unicode-3.0"] {
            assert!(judge(&package(good)).is_ok(), "{good}");
        }
        for bad in ["GPL-3.0-only", "MIT AND GPL-3.0-only", "no licence"] {
            assert!(judge(&package(bad)).is_err(), "{bad}");
        }
    }

    #[test]
    fn advisories_hold_for_versions() {
        let text = "```toml\n[advisory]\nid = \"RUSTSEC-2020-0001\"\npackage = \"one\"\n[versions]\npatched = [\">= 1.2.3\"]\nunaffected = [\"< 1.0.0\"]\n```\n\n# Reads beyond the end\n";
        let of = |version: &str| hole(text, &version.parse().unwrap()).unwrap();
        assert_eq!(of("1.1.0").as_deref(), Some("RUSTSEC-2020-0001, Reads beyond the end"));
        assert_eq!((of("1.2.3"), of("0.9.0")), (None, None));
        let informs = text.replace("[versions]", "informational = \"unmaintained\"\n[versions]");
        assert_eq!(hole(&informs, &"1.1.0".parse().unwrap()), Ok(None));
    }
}
