//! `cargo xtask dist`: what is released, made and tried: the program with completions, manual pages, studio, runtime of FMUs, examples and
//! licences as one archive; the Python wheel; the studio; the site; checksums.
//!
//! It empties three folders of its own, `release`, `stage` and `check` in `target/dist`, and nothing else.

mod room;
mod terms;

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use sha2::{Digest, Sha256};

use crate::book::{commands_of, first_missing, mdbook};
use crate::context::{Context, Options, passes, said};
use crate::examples::example_files;
use crate::python::{build_wheel, builder};
use crate::site::{build_site, copy, copy_folder, read, write};
use crate::step::{Outcome, outcome};
use crate::studio::studio_page;
use room::Room;
use terms::terms;

const VERSION: &str = env!("CARGO_PKG_VERSION");

/// `cargo xtask dist`
pub(crate) fn dist(context: &Context) -> Outcome {
    outcome(all(context).map(|told| print!("{told}")))
}

/// The folders of a release.
struct Folders {
    /// What is published.
    release: PathBuf,
    /// What goes into it.
    stage: PathBuf,
    /// Where it is tried.
    check: PathBuf,
}

impl Folders {
    /// Empty ones. Results of the profile of the same name lie beside them and stay.
    fn new(context: &Context) -> Result<Self, String> {
        let folder = |name: &str| -> Result<PathBuf, String> {
            let path = context.target.join("dist").join(name);
            match fs::remove_dir_all(&path) {
                Err(e) if e.kind() != std::io::ErrorKind::NotFound => return Err(format!("{}: {e}", path.display())),
                _ => {}
            }
            fs::create_dir_all(&path).map_err(|e| format!("{}: {e}", path.display()))?;
            Ok(path)
        };
        Ok(Self { release: folder("release")?, stage: folder("stage")?, check: folder("check")? })
    }
}

fn all(context: &Context) -> Result<String, String> {
    let options = &context.options;
    let folders = Folders::new(context)?;
    let host = host(context)?;
    let (program, runtime) = programs(context)?;
    let studio = match (&options.studio, options.no_studio) {
        (_, true) => None,
        (Some(file), _) => Some(file.clone()),
        (None, false) => Some(studio_page(context)?),
    };
    let mut told = String::new();
    let mut say = |line: String| writeln!(told, "{line}").expect("to a text");

    let name = format!("willis-{VERSION}-{host}");
    let folder = folders.stage.join(&name);
    fill(context, &folder, &program, runtime.as_deref(), studio.as_deref())?;
    let terms = terms(context, &host, studio.is_some())?;
    write(&folder.join("share/doc/willis/THIRD-PARTY-LICENCES.txt"), &terms.page)?;
    let archive = folders.release.join(format!("{name}.tar.gz"));
    pack(context, &folder, &archive)?;
    say(format!("licences of {} packages; {} without a text of their own", terms.packages, terms.without.len()));
    terms.without.iter().for_each(|line| say(format!("  {line}")));
    if runtime.is_none() {
        say("the runtime of FMUs is not in the archive: it is not beside the program".into());
    }

    let room = Room::install(context, &archive, &folders.check.join("root"))?;
    say(format!("the archive was tried in {}:", room.told));
    tried(context, &room)?.into_iter().for_each(|line| say(format!("  {line}")));

    if let Some(studio) = &studio {
        copy(studio, &folders.release.join(format!("willis-studio-{VERSION}.html")))?;
    }
    let wheel = match (&options.wheel, options.no_python) {
        (_, true) => None,
        (Some(file), _) => {
            if !file.to_string_lossy().contains(&format!("-{VERSION}-")) {
                return Err(format!("{} is no wheel of version {VERSION}", file.display()));
            }
            let to = folders.release.join(file.file_name().ok_or("a wheel has a name")?);
            copy(file, &to)?;
            Some(to)
        }
        (None, false) => {
            let tools = builder(context);
            tools.install(context)?;
            Some(build_wheel(context, &tools, &folders.release, Some(profile(options)))?)
        }
    };
    if let Some(wheel) = &wheel {
        say(in_a_new_environment(context, &room, &folders.check.join("venv"), wheel)?);
    }
    match (&studio, options.no_site) {
        (Some(studio), false) => {
            let of_site = Options { program: Some(program), studio: Some(studio.clone()), ..options.clone() };
            match mdbook(context) {
                Ok(tool) => {
                    let site = folders.stage.join(format!("willis-site-{VERSION}"));
                    say(build_site(&context.with(of_site), &tool, &folders.stage.join("site-source"), &site)?);
                    pack(context, &site, &folders.release.join(format!("willis-site-{VERSION}.tar.gz")))?;
                }
                Err(why) => say(format!("no site: {why}")),
            }
        }
        (None, false) => say("no site: the studio, which is a part of it, is left out".into()),
        _ => {}
    }
    checksums(&folders.release)?;
    say(format!("{}:", folders.release.display()));
    for (name, bytes) in files(&folders.release)? {
        say(format!("  {:>9.2} MB  {name}", bytes as f64 / 1e6));
    }
    Ok(told)
}

fn profile(options: &Options) -> &str {
    options.profile.as_deref().unwrap_or("dist")
}

fn host(context: &Context) -> Result<String, String> {
    let output = context.output(&mut context.words("rustc --print host-tuple"))?;
    Ok(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

// The archive

/// The program, and the runtime of FMUs where it is beside it.
fn programs(context: &Context) -> Result<(PathBuf, Option<PathBuf>), String> {
    let options = &context.options;
    let program = match &options.program {
        Some(file) => file.clone(),
        None => {
            let profile = profile(options);
            // With the wheel in one go: alone each has other features of the same dependencies.
            let python = if options.no_python || options.wheel.is_some() { "" } else { " -p willis-py" };
            context.run(&format!("cargo build --profile {profile} -p willis-cli -p willis-fmu{python}"))?;
            let folder = if profile == "dev" { "debug" } else { profile };
            context.target.join(folder).join(format!("willis{}", std::env::consts::EXE_SUFFIX))
        }
    };
    let library = format!("{}willis_fmu{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    let beside = program.parent().expect("a program is in a folder").join(library);
    Ok((program, beside.is_file().then_some(beside)))
}

/// Where completions of a shell are looked for.
const COMPLETIONS: &[(&str, &str)] = &[
    ("bash", "share/bash-completion/completions/willis"),
    ("zsh", "share/zsh/site-functions/_willis"),
    ("fish", "share/fish/vendor_completions.d/willis.fish"),
    ("powershell", "share/willis/completions/willis.ps1"),
    ("elvish", "share/willis/completions/willis.elv"),
];

/// Everything that is unpacked into `/usr/local` or another prefix.
fn fill(
    context: &Context,
    folder: &Path,
    program: &Path,
    runtime: Option<&Path>,
    studio: Option<&Path>,
) -> Result<(), String> {
    let own = folder.join("bin").join(format!("willis{}", std::env::consts::EXE_SUFFIX));
    copy(program, &own)?;
    stripped(context, &own, "--strip-all")?;
    if let Some(runtime) = runtime {
        let to = folder.join("lib/willis").join(runtime.file_name().expect("a library has a name"));
        copy(runtime, &to)?;
        stripped(context, &to, "--strip-unneeded")?;
    }
    for (shell, file) in COMPLETIONS {
        let script = context.output(context.command(&own).args(["completions", shell]))?;
        write(&folder.join(file), &String::from_utf8_lossy(&script.stdout))?;
    }
    let manual = folder.join("share/man/man1");
    fs::create_dir_all(&manual).map_err(|e| format!("{}: {e}", manual.display()))?;
    context.output(context.command(&own).arg("man").arg(&manual))?;
    if let Some(studio) = studio {
        copy(studio, &folder.join("share/willis/studio.html"))?;
    }
    for file in example_files(context)? {
        copy(&context.root.join(&file), &folder.join("share/willis").join(&file))?;
    }
    // Tables and files of other programs that examples name.
    let more = |path: &Path| {
        path.is_dir()
            || path.extension().is_some_and(|e| e != "toml")
            || path.components().any(|c| c.as_os_str() == "design")
    };
    copy_folder(&context.root.join("examples"), &folder.join("share/willis/examples"), &more)?;
    copy_folder(&context.root.join("schema"), &folder.join("share/willis/schema"), &|_| true)?;
    for file in ["README.md", "CHANGELOG.md", "LICENSE-MIT", "LICENSE-APACHE"] {
        copy(&context.root.join(file), &folder.join("share/doc/willis").join(file))?;
    }
    let sysroot = context.output(&mut context.words("rustc --print sysroot"))?;
    let rust = Path::new(String::from_utf8_lossy(&sysroot.stdout).trim()).join("share/doc/rust/COPYRIGHT-library.html");
    if rust.is_file() {
        copy(&rust, &folder.join("share/doc/willis/rust-library-copyright.html"))?;
    }
    Ok(())
}

/// Takes the symbols out of a program that was built with them. Profiles of releases leave them out themselves.
fn stripped(context: &Context, file: &Path, how: &str) -> Result<(), String> {
    let has_symbols = || -> Result<bool, String> {
        let bytes = fs::read(file).map_err(|e| format!("{}: {e}", file.display()))?;
        Ok(bytes.starts_with(b"\x7fELF") && bytes.windows(9).any(|w| w == b"\0.symtab\0"))
    };
    if has_symbols()? {
        context.output(context.command("strip").arg(how).arg(file))?;
    }
    match has_symbols()? {
        true => Err(format!("{} still has symbols", file.display())),
        false => Ok(()),
    }
}

/// Packs a folder under its name; the same contents give the same bytes where `tar` is that of GNU.
fn pack(context: &Context, folder: &Path, archive: &Path) -> Result<(), String> {
    let version = context.output(&mut context.words("tar --version"))?;
    let mut tar = context.command("tar");
    if String::from_utf8_lossy(&version.stdout).contains("GNU tar") {
        let when = context.output(&mut context.words("git log -1 --format=%ct")).ok();
        let when = when.map_or("0".into(), |o| String::from_utf8_lossy(&o.stdout).trim().to_owned());
        tar.args(["--sort=name", "--owner=0", "--group=0", "--numeric-owner"]).arg(format!("--mtime=@{when}"));
    }
    tar.arg("-czf")
        .arg(archive)
        .arg("-C")
        .arg(folder.parent().expect("a folder"))
        .arg(folder.file_name().expect("its name"));
    context.output(&mut tar).map(drop)
}

// Trying it

/// Runs the first command of the README in the room, and what else must be found there. What was run.
fn tried(context: &Context, room: &Room) -> Result<Vec<String>, String> {
    let readme = read(&context.root.join("README.md"))?;
    let first = commands_of(&readme).into_iter().next().ok_or("the README has no command")?;
    let mut run = Vec::new();
    let mut ask = |words: &[String]| -> Result<String, String> {
        let mut command = room.willis();
        command.args(words);
        let printed = context.output(&mut command)?.stdout;
        run.push(format!("willis {}", words.join(" ")));
        Ok(String::from_utf8_lossy(&printed).into_owned())
    };
    let printed = ask(&first.words)?;
    if let Some(line) = first_missing(&first.output, &printed) {
        return Err(format!("`willis {}` does not print what the README shows:\n{line}", first.words.join(" ")));
    }
    let version = ask(&["--version".to_owned()])?;
    if version.trim() != format!("willis {VERSION}") {
        return Err(format!("the program is {}, not willis {VERSION}", version.trim()));
    }
    let here = |file: &str| room.outside(file).is_file();
    let manual = ["share/man/man1/willis.1", "share/man/man1/willis-analyze.1"];
    match COMPLETIONS.iter().map(|c| c.1).chain(manual).find(|file| !here(file)) {
        Some(lost) => Err(format!("{lost} is not in the archive")),
        None => Ok(run),
    }
}

/// Installs the wheel where nothing else is, runs what the README shows of it, and its command.
fn in_a_new_environment(context: &Context, room: &Room, folder: &Path, wheel: &Path) -> Result<String, String> {
    passes(context.words("python3 -m venv").arg(folder), "python3 -m venv")?;
    let bin = |name: &str| -> Command {
        let mut command = context.command(folder.join("bin").join(name));
        command.env_remove("PYTHONPATH");
        command
    };
    let pip = ["install", "--quiet", "--disable-pip-version-check"];
    if passes(bin("pip").args(pip).arg("numpy>=1.23"), "pip install numpy").is_err() {
        return Ok("the wheel was not tried: numpy, which it needs, cannot be had".into());
    }
    let mut install = bin("pip");
    install.args(pip).arg("--no-index").arg(wheel);
    let words = said(&install);
    passes(&mut install, &words)?;
    let readme = read(&context.root.join("README.md"))?;
    let shown = readme.split("```python\n").nth(1).and_then(|t| t.split("```").next()).unwrap_or_default();
    let (script, expected) = script(shown);
    let mut python = bin("python");
    python.env_clear().current_dir(room.outside("share/willis")).args(["-I", "-c", &script]);
    let printed = context.output(&mut python)?;
    let printed = String::from_utf8_lossy(&printed.stdout);
    if expected.is_empty() || printed.trim() != expected.join("\n") {
        return Err(format!("Python prints\n{}\nand the README shows\n{}", printed.trim(), expected.join("\n")));
    }
    let mut command = bin("willis");
    command.env_clear().arg("--version");
    context.output(&mut command)?;
    let name = wheel.file_name().unwrap_or_default().to_string_lossy();
    Ok(format!("{name} was tried in a new environment: the Python of the README prints {}", expected.join(", ")))
}

/// Python that prints the values that lines of a page name as `value  # number`, to the digits shown; and those numbers.
fn script(shown: &str) -> (String, Vec<String>) {
    let (mut script, mut expected) = (String::new(), Vec::new());
    for line in shown.lines() {
        let number = line.rsplit_once('#').map(|(code, n)| (code.trim(), n.trim()));
        match number.filter(|(_, n)| n.parse::<f64>().is_ok()) {
            Some((code, number)) => {
                let digits = number.split_once('.').map_or(0, |(_, d)| d.len());
                writeln!(script, "print(f\"{{{code}:.{digits}f}}\")", code = code.replace('"', "'"))
                    .expect("to a text");
                expected.push(number.to_owned());
            }
            None => writeln!(script, "{line}").expect("to a text"),
        }
    }
    (script, expected)
}

// Checksums

/// Names and sizes, by name.
fn files(folder: &Path) -> Result<Vec<(String, u64)>, String> {
    let fail = |e: std::io::Error| format!("{}: {e}", folder.display());
    let mut all = Vec::new();
    for entry in fs::read_dir(folder).map_err(fail)? {
        let entry = entry.map_err(fail)?;
        all.push((entry.file_name().to_string_lossy().into_owned(), entry.metadata().map_err(fail)?.len()));
    }
    all.sort();
    Ok(all)
}

/// Writes `SHA256SUMS`, as `sha256sum --check` reads it.
fn checksums(folder: &Path) -> Result<(), String> {
    let mut text = String::new();
    for (name, _) in files(folder)? {
        let bytes = fs::read(folder.join(&name)).map_err(|e| format!("{name}: {e}"))?;
        writeln!(text, "{}  {name}", sum(&bytes)).expect("to a text");
    }
    write(&folder.join("SHA256SUMS"), &text)
}

fn sum(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|b| format!("{b:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_checksums_are_those_of_the_standard() {
        // FIPS 180-2, appendix B.1.
        assert_eq!(sum(b"abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    }

    #[test]
    fn python_of_a_page_is_run_and_its_numbers_are_compared() {
        let (script, expected) = script("import a\na.b(state=\"3\").c    # 0.98204\nx = 1   # an array\n");
        assert_eq!(script, "import a\nprint(f\"{a.b(state='3').c:.5f}\")\nx = 1   # an array\n");
        assert_eq!(expected, ["0.98204"]);
    }
}
