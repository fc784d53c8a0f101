//! Where things are, and how other programs are run.

use std::env;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use serde_json::Value;

/// What was said on the command line after the task.
#[derive(Clone, Default)]
pub(crate) struct Options {
    /// Seconds of fuzzing.
    pub(crate) seconds: Option<u64>,
    /// Whether fuzzing takes its time.
    pub(crate) long: bool,
    /// Whether the studio is built and not tested.
    pub(crate) no_tests: bool,
    /// A folder with whole reference trajectories of Modelica's examples.
    pub(crate) modelica: Option<PathBuf>,
    /// Whether the program is built from nothing and timed.
    pub(crate) build: bool,
    /// Whether simulators are timed.
    pub(crate) speed: bool,
    /// A studio that is built, for the site.
    pub(crate) studio: Option<PathBuf>,
    /// Whether the site does without the pages of the library.
    pub(crate) no_api: bool,
    /// The program that is asked, where it is not the optimised one of this checkout.
    pub(crate) program: Option<PathBuf>,
    /// How what is released is built; else as what is published.
    pub(crate) profile: Option<String>,
    /// A wheel that is built, for the release.
    pub(crate) wheel: Option<PathBuf>,
    /// Parts that the release does without.
    pub(crate) no_python: bool,
    pub(crate) no_studio: bool,
    pub(crate) no_site: bool,
}

/// Where things are, and what was said on the command line.
pub(crate) struct Context {
    pub(crate) root: PathBuf,
    /// The folder of build results, with `debug` and `release` in it.
    pub(crate) target: PathBuf,
    pub(crate) options: Options,
}

impl Context {
    pub(crate) fn new(options: Options) -> Result<Self, String> {
        let manifest =
            env::var_os("CARGO_MANIFEST_DIR").map_or_else(|| env!("CARGO_MANIFEST_DIR").into(), PathBuf::from);
        let root = manifest.ancestors().nth(2).ok_or("the root of the repository is not to be found")?.to_owned();
        // This program is `<target>/debug/xtask`, wherever that folder was configured to be.
        let program = env::current_exe().map_err(|e| format!("this program is not to be found: {e}"))?;
        let target = program.ancestors().nth(2).ok_or("the target folder is not to be found")?.to_owned();
        Ok(Self { root, target, options })
    }

    /// `cargo`, `rustup` or another program, in the root of the repository.
    pub(crate) fn command(&self, program: impl AsRef<OsStr>) -> Command {
        let mut command = Command::new(program);
        // What `cargo run` says about this package is nobody else's business.
        for (name, _) in env::vars_os() {
            let text = name.to_string_lossy();
            if text == "CARGO" || text.starts_with("CARGO_PKG_") || text.starts_with("CARGO_MANIFEST_") {
                command.env_remove(&name);
            }
        }
        command.current_dir(&self.root).stdin(Stdio::null());
        command
    }

    /// A command given as words.
    pub(crate) fn words(&self, words: &str) -> Command {
        let mut words = words.split_whitespace();
        let mut command = self.command(words.next().expect("a program"));
        command.args(words);
        command
    }

    /// Runs with the output on the screen.
    pub(crate) fn run(&self, words: &str) -> Result<(), String> {
        passes(&mut self.words(words), words)
    }

    /// Whether it runs and succeeds; output is dropped.
    pub(crate) fn succeeds(&self, words: &str) -> bool {
        self.words(words).stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok_and(|s| s.success())
    }

    /// Output of a command that succeeds.
    pub(crate) fn output(&self, command: &mut Command) -> Result<Output, String> {
        let said = said(command);
        let output = command.output().map_err(|e| format!("`{said}` cannot be started: {e}"))?;
        if output.status.success() {
            return Ok(output);
        }
        Err(format!(
            "`{said}`: {}\n{}{}",
            output.status,
            String::from_utf8_lossy(&output.stdout),
            String::from_utf8_lossy(&output.stderr)
        ))
    }

    /// What a command prints, as JSON.
    pub(crate) fn json(&self, words: &str) -> Result<Value, String> {
        let output = self.output(&mut self.words(words))?;
        serde_json::from_slice(&output.stdout).map_err(|e| format!("`{words}` prints no JSON: {e}"))
    }

    /// The same with other options.
    pub(crate) fn with(&self, options: Options) -> Self {
        Self { root: self.root.clone(), target: self.target.clone(), options }
    }

    /// The optimised program `willis`, or the one that was named.
    pub(crate) fn willis(&self) -> Command {
        if let Some(program) = &self.options.program {
            return self.command(program);
        }
        self.command(self.target.join("release").join(format!("willis{}", env::consts::EXE_SUFFIX)))
    }
}

/// Runs with the output on the screen.
pub(crate) fn passes(command: &mut Command, said: &str) -> Result<(), String> {
    match command.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("`{said}`: {status}")),
        Err(e) => Err(format!("`{said}` cannot be started: {e}")),
    }
}

/// A command as it would be typed, the program without its folder.
pub(crate) fn said(command: &Command) -> String {
    let program = Path::new(command.get_program()).file_name().unwrap_or_default();
    let words = std::iter::once(program).chain(command.get_args());
    words.map(|w| w.to_string_lossy().into_owned()).collect::<Vec<_>>().join(" ")
}

/// Makes sure that a component of the toolchain is there.
pub(crate) fn component(context: &Context, name: &str) -> Result<(), String> {
    let tool = name.trim_start_matches("rust");
    if context.succeeds(&format!("cargo {tool} --version")) || context.succeeds(&format!("rustup component add {name}"))
    {
        return Ok(());
    }
    Err(format!("{name} is not part of this toolchain and rustup could not add it; install it and run again"))
}
