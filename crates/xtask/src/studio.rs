//! The studio: the library as WebAssembly, which answers like the program, packed into one page, which is tested in a browser.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::context::{Context, Options, passes, said};
use crate::program::build_willis;
use crate::step::Outcome;

const TARGET: &str = "wasm32-unknown-unknown";

/// What a page may make its reader load, packed, in bytes.
const MOST_BYTES: u64 = 2_000_000;

/// Why the step ended early.
enum Stop {
    /// Something cannot be had here.
    Lack(String),
    Fault(String),
}

impl From<String> for Stop {
    fn from(why: String) -> Self {
        Self::Fault(why)
    }
}

/// Builds the page and tests it.
pub(crate) fn studio(context: &Context) -> Outcome {
    match all(context) {
        Ok(()) => Outcome::Passed,
        Err(Stop::Lack(why)) => Outcome::Skipped(why),
        Err(Stop::Fault(why)) => Outcome::Failed(why),
    }
}

fn all(context: &Context) -> Result<(), Stop> {
    if !is_there(context) {
        let _ = context.run(&format!("rustup target add {TARGET}"));
    }
    if !is_there(context) {
        return Err(Stop::Lack(format!("the target {TARGET} cannot be had here")));
    }
    if !context.succeeds("node --version") {
        return Err(Stop::Lack("there is no Node.js here".into()));
    }
    let wasm = context.root.join("studio/src/wasm");
    let packed = library(context, &wasm)?;
    let tested = !context.options.no_tests;
    if tested {
        build_willis(context)?;
        node(context, &["answers", path(&wasm)?, path(Path::new(&willis(context)))?])?;
    }
    let page = page(context)?;
    println!(
        "{}: {:.2} MB, in it {:.2} MB of packed WebAssembly",
        page.display(),
        megabytes(&page)?,
        packed as f64 / 1e6
    );
    if tested {
        in_a_browser(context, &page)?;
    }
    // Last: a page that is too large can be looked at and tested all the same.
    match packed <= MOST_BYTES {
        true => Ok(()),
        false => Err(Stop::Fault(format!("{packed} bytes of packed WebAssembly are more than {MOST_BYTES}"))),
    }
}

/// The page alone, built and not tested; why it cannot be had.
pub(crate) fn studio_page(context: &Context) -> Result<PathBuf, String> {
    let options = Options { no_tests: true, ..Options::default() };
    match all(&context.with(options)) {
        Ok(()) => Ok(context.target.join("studio.html")),
        Err(Stop::Lack(why) | Stop::Fault(why)) => Err(why),
    }
}

fn is_there(context: &Context) -> bool {
    let output = context.words(&format!("rustc --print target-libdir --target {TARGET}")).output();
    output.is_ok_and(|o| Path::new(String::from_utf8_lossy(&o.stdout).trim()).is_dir())
}

/// Builds the library for browsers.
fn build_library(context: &Context) -> Command {
    context.words(&format!("cargo build --profile web -p willis-web --target {TARGET}"))
}

/// `cargo` for the writer of JavaScript: a workspace of its own, built for this machine, once, and for nobody else.
fn bindgen(context: &Context, word: &str) -> Command {
    let words = format!("cargo {word} --quiet --manifest-path studio/bindgen/Cargo.toml --target-dir");
    let mut command = context.words(&words);
    command.arg(context.target.join("tools/bindgen"));
    command
}

/// What can be built before.
pub(crate) fn builds(context: &Context) -> Vec<Command> {
    vec![context.words(&format!("rustup target add {TARGET}")), build_library(context), bindgen(context, "build")]
}

/// The library with its JavaScript in a folder; how many bytes it has, packed.
fn library(context: &Context, folder: &Path) -> Result<u64, String> {
    let mut build = build_library(context);
    let words = said(&build);
    passes(&mut build, &words)?;
    let unpack = context.target.join("tools/unpack");
    let mut build = context.words("cargo build --quiet --release --manifest-path studio/unpack/Cargo.toml --target");
    build.arg(TARGET).arg("--target-dir").arg(&unpack);
    passes(&mut build, "cargo build --manifest-path studio/unpack/Cargo.toml")?;
    bound(context, &context.target.join(TARGET).join("web/willis_web.wasm"), folder, &["--pack"])?;
    bound(context, &unpack.join(TARGET).join("release/willis_unpack.wasm"), folder, &[])?;
    node(context, &["pack", path(folder)?])?;
    let size = |name: &str| {
        let file = folder.join(name);
        fs::metadata(&file).map(|m| m.len()).map_err(|e| format!("{}: {e}", file.display()))
    };
    Ok(size("willis_web_bg.wasm.lzma")? + size("willis_unpack_bg.wasm.gz")?)
}

/// Writes the JavaScript for a module.
fn bound(context: &Context, module: &Path, folder: &Path, more: &[&str]) -> Result<(), String> {
    let mut bindgen = bindgen(context, "run");
    bindgen.arg("--").arg(module).arg(folder).args(more);
    passes(&mut bindgen, "cargo run --manifest-path studio/bindgen/Cargo.toml")
}

/// A chore that is done in JavaScript: `pack`, or to compare the `answers`.
fn node(context: &Context, words: &[&str]) -> Result<(), String> {
    let mut node = context.command("node");
    node.args(["--no-warnings", "--input-type=module", "--eval", include_str!("studio.mjs"), "--"]).args(words);
    passes(&mut node, &format!("node {}", words[0]))
}

fn path(path: &Path) -> Result<&str, String> {
    path.to_str().ok_or_else(|| format!("{}: the path is no text", path.display()))
}

fn willis(context: &Context) -> PathBuf {
    context.willis().get_program().into()
}

fn megabytes(file: &Path) -> Result<f64, String> {
    fs::metadata(file).map(|m| m.len() as f64 / 1e6).map_err(|e| format!("{}: {e}", file.display()))
}

/// The page, checked and built.
fn page(context: &Context) -> Result<PathBuf, Stop> {
    let folder = context.root.join("studio");
    let run = |words: &str| {
        let mut command = context.words(words);
        passes(command.current_dir(&folder), words)
    };
    if !is_installed(&folder) {
        if !context.succeeds("npm --version") {
            return Err(Stop::Lack("there is no npm here".into()));
        }
        run("npm ci --no-audit --no-fund").map_err(|why| Stop::Lack(format!("packages cannot be had: {why}")))?;
    }
    run("npx --no-install svelte-check --fail-on-warnings")?;
    run("npx --no-install vite build")?;
    let page = context.target.join("studio.html");
    fs::copy(folder.join("dist/index.html"), &page).map_err(|e| format!("studio/dist/index.html: {e}"))?;
    Ok(page)
}

/// Whether the packages that are there are those of the lock file.
fn is_installed(folder: &Path) -> bool {
    let when = |name: &str| fs::metadata(folder.join(name)).and_then(|m| m.modified());
    match (when("node_modules/.package-lock.json"), when("package-lock.json")) {
        (Ok(installed), Ok(wanted)) => installed >= wanted,
        _ => false,
    }
}

/// The tests of the page; what measures has the machine for itself.
fn in_a_browser(context: &Context, page: &Path) -> Result<(), Stop> {
    let browser = chromium(context).ok_or_else(|| {
        Stop::Lack("the page is built, but there is no Chromium here to test it, and it cannot be had".into())
    })?;
    let folder = context.root.join("studio/tests");
    let entries = fs::read_dir(&folder).map_err(|e| format!("studio/tests: {e}"))?;
    let mut tests: Vec<PathBuf> = entries.filter_map(|e| Some(e.ok()?.path())).collect();
    tests.retain(|p| p.to_string_lossy().ends_with(".test.mjs"));
    tests.sort();
    let (measuring, others): (Vec<_>, Vec<_>) = tests.into_iter().partition(|p| p.ends_with("speed.test.mjs"));
    for (together, tests) in [(2, others), (1, measuring)] {
        let mut node = context.words(&format!("node --test --test-concurrency={together} --test-reporter=spec"));
        node.args(tests).env("STUDIO", page).env("WILLIS", willis(context)).env("CHROMIUM", &browser);
        let said = said(&node);
        passes(&mut node, &said)?;
    }
    Ok(())
}

/// The browser, installed where this may install and it is missing.
fn chromium(context: &Context) -> Option<String> {
    let find = || {
        ["chromium", "chromium-browser", "google-chrome"]
            .into_iter()
            .find(|name| context.succeeds(&format!("which {name}")))
    };
    let is_root = || context.words("id -u").output().is_ok_and(|o| o.stdout.trim_ascii() == b"0");
    if find().is_none() && is_root() {
        // With a face: text is measured.
        let install = "apt-get install -y --no-install-recommends chromium fonts-dejavu-core";
        let quiet = |words: &str| {
            println!("{words}");
            let mut command = context.words(words);
            command.env("DEBIAN_FRONTEND", "noninteractive");
            context.output(&mut command).is_ok()
        };
        let _ = quiet(install) || quiet("apt-get update") && quiet(install);
    }
    let name = find()?;
    let output = context.words(&format!("which {name}")).output().ok()?;
    Some(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}
