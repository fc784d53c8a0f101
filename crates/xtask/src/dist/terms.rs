//! The licence texts of everything that a release holds and others wrote: crates, packages of the studio, Rust's own library.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::context::Context;

/// What becomes part of a program, of a wheel or of the runtime of an FMU.
const PROGRAMS: &[&str] = &["willis-cli", "willis-fmu", "willis-py"];
/// What becomes part of the studio, and the platform of browsers.
const STUDIO: &str = "willis-web";
const BROWSER: &str = "wasm32-unknown-unknown";

/// How names of files with terms begin, in small letters.
const BEGIN: &[&str] = &["license", "licence", "copying", "copyright", "notice", "unlicense"];

/// Something that others wrote.
#[derive(Debug)]
struct Package {
    name: String,
    version: String,
    licence: String,
    place: String,
    texts: Vec<String>,
}

/// The page of all licences.
pub(super) struct Terms {
    pub(super) page: String,
    pub(super) packages: usize,
    /// Packages that come without a text, with the licence that they name.
    pub(super) without: Vec<String>,
}

/// Collects them for a platform; `studio`: with what is in the studio.
pub(super) fn terms(context: &Context, host: &str, studio: bool) -> Result<Terms, String> {
    let mut words = format!("cargo metadata --format-version 1 --locked --filter-platform {host}");
    let mut roots: Vec<&str> = PROGRAMS.to_vec();
    if studio {
        roots.push(STUDIO);
        words += &format!(" --filter-platform {BROWSER}");
    }
    let mut packages = crates(&metadata(context, &words)?, Some(&roots))?;
    if studio {
        let unpack = "--manifest-path studio/unpack/Cargo.toml";
        let words = format!("cargo metadata --format-version 1 --locked --filter-platform {BROWSER} {unpack}");
        packages.extend(crates(&metadata(context, &words)?, None)?);
        packages.extend(pages(&context.root.join("studio"))?);
    }
    packages.sort_by(|a, b| (&a.name, &a.version).cmp(&(&b.name, &b.version)));
    packages.dedup_by(|a, b| (&a.name, &a.version) == (&b.name, &b.version));
    Ok(page(&packages))
}

/// From the network, or from what was fetched before.
fn metadata(context: &Context, words: &str) -> Result<Value, String> {
    context.json(words).or_else(|_| context.json(&format!("{words} --offline")))
}

/// Crates from registries that the roots (all members where none are named) are built with; tools and tests are left out.
fn crates(metadata: &Value, roots: Option<&[&str]>) -> Result<Vec<Package>, String> {
    let list = |value: &Value| value.as_array().cloned().unwrap_or_default();
    let by_id: BTreeMap<String, Value> =
        list(&metadata["packages"]).into_iter().map(|p| (text(&p["id"]).to_owned(), p)).collect();
    let nodes: BTreeMap<String, Value> =
        list(&metadata["resolve"]["nodes"]).into_iter().map(|n| (text(&n["id"]).to_owned(), n)).collect();
    let members = list(&metadata["workspace_members"]);
    let is_root = |id: &&str| {
        let name = by_id.get(*id).map(|p| text(&p["name"])).unwrap_or_default();
        roots.is_none_or(|roots| roots.contains(&name))
    };
    let mut open: Vec<String> = members.iter().map(text).filter(is_root).map(str::to_owned).collect();
    if open.len() < roots.map_or(1, <[&str]>::len) {
        return Err("cargo does not list the crates that a release is made of".into());
    }
    let mut seen: BTreeSet<String> = BTreeSet::new();
    while let Some(id) = open.pop() {
        if !seen.insert(id.clone()) {
            continue;
        }
        for dependency in list(nodes.get(&id).map_or(&Value::Null, |n| &n["deps"])) {
            // No kind is the usual kind; `build` and `dev` have names.
            if list(&dependency["dep_kinds"]).iter().any(|k| k["kind"].is_null()) {
                open.push(text(&dependency["pkg"]).to_owned());
            }
        }
    }
    let others = seen.iter().filter_map(|id| by_id.get(id)).filter(|p| !p["source"].is_null());
    others
        .map(|p| {
            let folder = Path::new(text(&p["manifest_path"])).parent().unwrap_or(Path::new("")).to_owned();
            let named = p["license_file"].as_str().map(|file| folder.join(file));
            Ok(Package {
                name: text(&p["name"]).into(),
                version: text(&p["version"]).into(),
                licence: p["license"].as_str().unwrap_or("a licence file of its own").into(),
                place: text(&p["repository"]).into(),
                texts: texts(&folder, named)?,
            })
        })
        .collect()
}

/// Packages of the registry of JavaScript that the studio's code imports, and what those need.
fn pages(folder: &Path) -> Result<Vec<Package>, String> {
    let lock = fs::read_to_string(folder.join("package-lock.json")).map_err(|e| format!("package-lock.json: {e}"))?;
    let lock: Value = serde_json::from_str(&lock).map_err(|e| format!("package-lock.json: {e}"))?;
    let mut open: Vec<String> = imports(&folder.join("src"))?.into_iter().collect();
    let mut seen = BTreeSet::new();
    let mut all = Vec::new();
    while let Some(name) = open.pop() {
        let entry = &lock["packages"][format!("node_modules/{name}")];
        if entry.is_null() || !seen.insert(name.clone()) {
            continue;
        }
        for field in ["dependencies", "peerDependencies"] {
            open.extend(entry[field].as_object().into_iter().flatten().map(|(name, _)| name.clone()));
        }
        let own = folder.join("node_modules").join(&name);
        all.push(Package {
            texts: if own.is_dir() { texts(&own, None)? } else { vec![] },
            version: text(&entry["version"]).into(),
            licence: entry["license"].as_str().unwrap_or("no licence is named").into(),
            place: format!("npm package {name}"),
            name,
        });
    }
    Ok(all)
}

/// Names of packages that code imports.
fn imports(folder: &Path) -> Result<BTreeSet<String>, String> {
    let mut all = BTreeSet::new();
    for entry in fs::read_dir(folder).map_err(|e| format!("{}: {e}", folder.display()))?.flatten() {
        let path = entry.path();
        let name = path.to_string_lossy().into_owned();
        if path.is_dir() {
            all.extend(imports(&path)?);
        } else if [".ts", ".svelte", ".js"].iter().any(|e| name.ends_with(e)) {
            let code = fs::read_to_string(&path).map_err(|e| format!("{name}: {e}"))?;
            all.extend(imported(&code));
        }
    }
    Ok(all)
}

fn imported(code: &str) -> Vec<String> {
    let mut all = Vec::new();
    // The first piece of each stands before any import.
    for piece in code.split("from \"").skip(1).chain(code.split("import \"").skip(1)) {
        let from = piece.split('"').next().unwrap_or_default();
        let parts = if from.starts_with('@') { 2 } else { 1 };
        if from.starts_with(|c: char| c.is_ascii_alphabetic() || c == '@') {
            all.push(from.split('/').take(parts).collect::<Vec<_>>().join("/"));
        }
    }
    all
}

/// Texts in a folder of a package and in the folders of what it brings along: each once.
fn texts(folder: &Path, named: Option<PathBuf>) -> Result<Vec<String>, String> {
    let mut files: BTreeSet<PathBuf> = named.into_iter().collect();
    find(folder, 3, &mut files)?;
    let mut all = Vec::new();
    for file in files {
        let bytes = fs::read(&file).map_err(|e| format!("{}: {e}", file.display()))?;
        let lines: Vec<String> =
            String::from_utf8_lossy(&bytes).lines().map(|l| l.trim_end().replace('\u{c}', "")).collect();
        let text = lines.join("\n").trim_matches('\n').to_owned();
        if !text.is_empty() && !all.contains(&text) {
            all.push(text);
        }
    }
    Ok(all)
}

fn find(folder: &Path, depth: usize, files: &mut BTreeSet<PathBuf>) -> Result<(), String> {
    for entry in fs::read_dir(folder).map_err(|e| format!("{}: {e}", folder.display()))?.flatten() {
        let (path, name) = (entry.path(), entry.file_name().to_string_lossy().to_ascii_lowercase());
        if path.is_dir() {
            // Packages of JavaScript that lie within others are asked for themselves.
            if depth > 0 && !["node_modules", "target", "tests", ".git"].contains(&name.as_str()) {
                find(&path, depth - 1, files)?;
            }
        } else if is_terms(&name) {
            files.insert(path);
        }
    }
    Ok(())
}

/// Whether a file of this name, in small letters, has terms; code that deals with licences has not.
fn is_terms(name: &str) -> bool {
    const CODE: &[&str] = &["rs", "js", "ts", "json", "toml", "py", "c", "h", "sh", "yml", "yaml", "hbs", "spdx"];
    let ending = name.rsplit_once('.').map_or("", |(_, e)| e);
    BEGIN.iter().any(|b| name.starts_with(b)) && !CODE.contains(&ending)
}

fn page(packages: &[Package]) -> Terms {
    let mut numbers: BTreeMap<&str, usize> = BTreeMap::new();
    let mut order: Vec<&str> = Vec::new();
    for text in packages.iter().flat_map(|p| &p.texts) {
        numbers.entry(text).or_insert_with(|| {
            order.push(text);
            order.len()
        });
    }
    let without: Vec<String> = packages
        .iter()
        .filter(|p| p.texts.is_empty())
        .map(|p| format!("{} {}: {}; {}", p.name, p.version, p.licence, p.place))
        .collect();
    let mut page = format!(
        "Willis is MIT OR Apache-2.0, at your choice. It holds code of {} packages that others wrote, each under the licence that stands \
         beside it. The numbers are those of the texts below; {} texts in all. The library of Rust is MIT OR Apache-2.0 with parts under \
         other terms: see `rust-library-copyright.html` beside this file where it is there, else\n\
         https://www.rust-lang.org/policies/licenses.\n\n",
        packages.len(),
        order.len()
    );
    for p in packages.iter().filter(|p| !p.texts.is_empty()) {
        let texts: Vec<String> = p.texts.iter().map(|t| numbers[t.as_str()].to_string()).collect();
        writeln!(page, "{} {}: {}; texts {}; {}", p.name, p.version, p.licence, texts.join(", "), p.place)
            .expect("to a text");
    }
    if !without.is_empty() {
        page += "\nThese name a licence and come without its text:\n\n";
        without.iter().for_each(|line| writeln!(page, "{line}").expect("to a text"));
    }
    for (k, text) in order.iter().enumerate() {
        let rule = "-".repeat(100);
        write!(page, "\n{rule}\nText {}\n{rule}\n\n{text}\n", k + 1).expect("to a text");
    }
    Terms { page, packages: packages.len(), without }
}

fn text(value: &Value) -> &str {
    value.as_str().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packages_are_those_that_code_imports() {
        let code = "import { mount } from \"svelte\";\nimport x from \"@codemirror/view/dist\";\nimport \"uplot\";\nimport y from \"./own\";\n";
        assert_eq!(imported(code), ["svelte", "@codemirror/view", "uplot"]);
    }

    #[test]
    fn terms_are_told_from_code() {
        assert!(["license", "license-mit", "licence.md", "copying.lesser", "notice.txt"].iter().all(|n| is_terms(n)));
        assert!(["licenses.rs", "readme.md", "license.json"].iter().all(|n| !is_terms(n)));
    }

    #[test]
    fn what_has_no_text_is_named_and_equal_texts_stand_once() {
        let package = |name: &str, texts: &[&str]| Package {
            name: name.into(),
            version: "1.0.0".into(),
            licence: "MIT".into(),
            place: "https://example.org".into(),
            texts: texts.iter().map(|t| (*t).to_owned()).collect(),
        };
        let terms = page(&[package("a", &["one"]), package("b", &["two", "one"]), package("c", &[])]);
        assert_eq!(
            (terms.packages, terms.without.as_slice()),
            (3, &["c 1.0.0: MIT; https://example.org".to_owned()][..])
        );
        assert_eq!(terms.page.matches("\none\n").count(), 1);
        assert!(terms.page.contains("b 1.0.0: MIT; texts 2, 1; "));
    }

    #[test]
    fn only_what_is_built_in_counts() {
        let metadata = serde_json::json!({
            "packages": [
                { "id": "w", "name": "w", "version": "1.0.0", "source": null, "manifest_path": "/nowhere/Cargo.toml" },
                { "id": "t", "name": "t", "version": "1.0.0", "source": "r", "manifest_path": "/nowhere/Cargo.toml" },
            ],
            "workspace_members": ["w"],
            "resolve": { "nodes": [{ "id": "w", "deps": [{ "pkg": "t", "dep_kinds": [{ "kind": "dev" }] }] }] },
        });
        assert_eq!(crates(&metadata, Some(&["w"])).unwrap().len(), 0);
        assert!(crates(&metadata, Some(&["other"])).is_err());
    }
}
