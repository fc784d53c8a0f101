//! Tasks of the repository: `cargo xtask ci` runs everything that must hold, each step alone is
//! `cargo xtask STEP`.
//!
//! [`STEPS`] is the whole list. Adding a step is adding an entry there.

mod bench;
mod book;

use std::env;
use std::ffi::OsStr;
use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Output, Stdio};
use std::time::{Duration, Instant};

/// What a step needs, what it does and when it runs.
struct Step {
    /// Also the name of the task that runs it alone.
    name: &'static str,
    /// Said in the list of tasks.
    about: &'static str,
    /// Environment of the command.
    env: &'static [(&'static str, &'static str)],
    action: Action,
    /// Whether a tool that cannot be had makes the step `skipped` instead of failed.
    may_skip: bool,
    /// Whether `check` runs it too.
    in_check: bool,
}

enum Action {
    /// Words of a command, run in the root of the repository.
    Run(&'static str),
    /// The same, of a tool that is a component of the toolchain: `component`, command.
    RunComponent(&'static str, &'static str),
    /// The same, counting tests.
    Test(&'static str),
    /// Anything else.
    Call(fn(&Context) -> Outcome),
}

/// In order: what fails soonest comes first, what may be skipped last. The tests come late, so
/// that their result lines stand at the end.
const STEPS: &[Step] = &[
    Step {
        name: "fmt",
        about: "formatting",
        env: &[],
        action: Action::RunComponent("rustfmt", "cargo fmt --all --check"),
        may_skip: false,
        in_check: true,
    },
    Step {
        name: "clippy",
        about: "lints, warnings are errors",
        env: &[],
        action: Action::RunComponent("clippy", "cargo clippy --workspace --all-targets -- -D warnings"),
        may_skip: false,
        in_check: true,
    },
    Step {
        name: "test",
        about: "unit, integration, validation and documentation tests",
        env: &[],
        action: Action::Test("cargo test --workspace --no-fail-fast"),
        may_skip: false,
        in_check: true,
    },
    Step {
        name: "doc",
        about: "documentation, warnings are errors",
        env: &[("RUSTDOCFLAGS", "-D warnings")],
        action: Action::Run("cargo doc --workspace --no-deps"),
        may_skip: false,
        in_check: true,
    },
    Step {
        name: "release",
        about: "the optimised program",
        env: &[],
        action: Action::Run("cargo build --release -p willis-cli"),
        may_skip: false,
        in_check: false,
    },
    Step {
        name: "generated",
        about: "generated files are as `cargo xtask generate` writes them",
        env: &[],
        action: Action::Call(generated),
        may_skip: false,
        in_check: false,
    },
    Step {
        name: "examples",
        about: "the program answers for every example train",
        env: &[],
        action: Action::Call(examples),
        may_skip: false,
        in_check: false,
    },
    Step {
        name: "book",
        about: "what README and book say the program prints is what it prints",
        env: &[],
        action: Action::Call(book),
        may_skip: false,
        in_check: false,
    },
    Step {
        name: "bench-gate",
        about: "work counts have not grown",
        env: &[],
        action: Action::Call(bench_gate),
        may_skip: true,
        in_check: false,
    },
    Step {
        name: "wasm",
        about: "the library builds for the browser",
        env: &[],
        action: Action::Call(wasm),
        may_skip: true,
        in_check: false,
    },
    Step {
        name: "pdf",
        about: "reports as PDF, by a typesetter that is built for nobody else",
        env: &[],
        action: Action::Call(pdf),
        may_skip: false,
        in_check: false,
    },
    Step {
        name: "fuzz",
        about: "no panic on random train files: [--seconds N], 20 if not said",
        env: &[],
        action: Action::Call(fuzz),
        may_skip: true,
        in_check: false,
    },
];

/// What a step came to.
enum Outcome {
    Passed,
    /// With the reason. Only for steps that may be skipped.
    Skipped(String),
    /// With the reason; the output is already on the screen.
    Failed(String),
    /// With the lines of the test runner.
    Tested(Tests),
}

/// The count of a test run.
#[derive(Default)]
struct Tests {
    passed: u64,
    failed: u64,
    ignored: u64,
    /// `test result: …` of each binary that ran any.
    lines: Vec<String>,
}

/// Where things are, and what was said on the command line.
struct Context {
    root: PathBuf,
    /// The folder of build results, with `debug` and `release` in it.
    target: PathBuf,
    seconds: u64,
}

impl Context {
    fn new(seconds: u64) -> Result<Self, String> {
        let manifest =
            env::var_os("CARGO_MANIFEST_DIR").map_or_else(|| env!("CARGO_MANIFEST_DIR").into(), PathBuf::from);
        let root = manifest.ancestors().nth(2).ok_or("the root of the repository is not to be found")?.to_owned();
        // This program is `<target>/debug/xtask`, wherever that folder was configured to be.
        let program = env::current_exe().map_err(|e| format!("this program is not to be found: {e}"))?;
        let target = program.ancestors().nth(2).ok_or("the target folder is not to be found")?.to_owned();
        Ok(Self { root, target, seconds })
    }

    /// `cargo`, `rustup` or another program, in the root of the repository.
    fn command(&self, program: impl AsRef<OsStr>) -> Command {
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
    fn words(&self, words: &str) -> Command {
        let mut words = words.split_whitespace();
        let mut command = self.command(words.next().expect("a program"));
        command.args(words);
        command
    }

    /// Runs with the output on the screen.
    fn run(&self, words: &str) -> Result<(), String> {
        passes(&mut self.words(words), words)
    }

    /// Whether it runs and succeeds; output is dropped.
    fn succeeds(&self, words: &str) -> bool {
        self.words(words).stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok_and(|s| s.success())
    }

    /// Output of a command that succeeds.
    fn output(&self, command: &mut Command) -> Result<Output, String> {
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

    /// The optimised program `willis`.
    fn willis(&self) -> Command {
        self.command(self.target.join("release").join(format!("willis{}", env::consts::EXE_SUFFIX)))
    }
}

/// Runs with the output on the screen.
fn passes(command: &mut Command, said: &str) -> Result<(), String> {
    match command.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("`{said}`: {status}")),
        Err(e) => Err(format!("`{said}` cannot be started: {e}")),
    }
}

/// A command as it would be typed, the program without its folder.
fn said(command: &Command) -> String {
    let program = Path::new(command.get_program()).file_name().unwrap_or_default();
    let words = std::iter::once(program).chain(command.get_args());
    words.map(|w| w.to_string_lossy().into_owned()).collect::<Vec<_>>().join(" ")
}

fn outcome(result: Result<(), String>) -> Outcome {
    result.map_or_else(Outcome::Failed, |()| Outcome::Passed)
}

impl Step {
    /// What to type to see it again.
    fn repeat(&self) -> String {
        match self.action {
            Action::Run(words) | Action::RunComponent(_, words) | Action::Test(words) => {
                let env = self.env.iter().map(|(name, value)| format!("{name}='{value}' "));
                env.collect::<String>() + words
            }
            Action::Call(_) => format!("cargo xtask {}", self.name),
        }
    }

    fn run(&self, context: &Context) -> Outcome {
        let outcome = match self.action {
            Action::Run(words) => outcome(passes(context.words(words).envs(self.env.iter().copied()), words)),
            Action::RunComponent(name, words) => outcome(component(context, name).and_then(|()| context.run(words))),
            Action::Test(words) => test(context, words),
            Action::Call(call) => call(context),
        };
        match outcome {
            Outcome::Skipped(reason) if !self.may_skip => Outcome::Failed(reason),
            other => other,
        }
    }
}

/// Makes sure that a component of the toolchain is there.
fn component(context: &Context, name: &str) -> Result<(), String> {
    let tool = name.trim_start_matches("rust");
    if context.succeeds(&format!("cargo {tool} --version")) || context.succeeds(&format!("rustup component add {name}"))
    {
        return Ok(());
    }
    Err(format!("{name} is not part of this toolchain and rustup could not add it; install it and run again"))
}

/// Runs tests, passes their output through and reads the result lines.
///
/// The random trains are the same in every run, so that a run can be repeated and tells of the
/// change that was made; `PROPTEST_RNG_SEED` in the environment looks at others.
fn test(context: &Context, words: &str) -> Outcome {
    let mut command = context.words(words);
    if std::env::var_os("PROPTEST_RNG_SEED").is_none() {
        command.env("PROPTEST_RNG_SEED", "1841");
    }
    let mut child = match command.stdout(Stdio::piped()).spawn() {
        Ok(child) => child,
        Err(e) => return Outcome::Failed(format!("`{words}` cannot be started: {e}")),
    };
    let mut tests = Tests::default();
    let mut reader = BufReader::new(child.stdout.take().expect("piped"));
    let mut line = Vec::new();
    while reader.read_until(b'\n', &mut line).is_ok_and(|n| n > 0) {
        let _ = std::io::stdout().write_all(&line);
        tests.read(String::from_utf8_lossy(&line).trim_end());
        line.clear();
    }
    match child.wait() {
        Ok(status) if !status.success() => Outcome::Failed(format!("{} tests failed: {status}", tests.failed)),
        Err(e) => Outcome::Failed(format!("`{words}`: {e}")),
        Ok(_) if tests.passed == 0 => Outcome::Failed("no test ran".into()),
        Ok(_) => Outcome::Tested(tests),
    }
}

impl Tests {
    /// Counts a line such as `test result: ok. 3 passed; 0 failed; 1 ignored; …`.
    fn read(&mut self, line: &str) {
        // A test that prints without a line end may stand before it.
        let Some(at) = line.find("test result: ") else { return };
        let line = &line[at..];
        let count = |word: &str| -> u64 {
            let words: Vec<&str> = line.split([' ', ';', '.']).filter(|w| !w.is_empty()).collect();
            words.windows(2).find(|w| w[1] == word).and_then(|w| w[0].parse().ok()).unwrap_or(0)
        };
        let (passed, failed, ignored) = (count("passed"), count("failed"), count("ignored"));
        self.passed += passed;
        self.failed += failed;
        self.ignored += ignored;
        if passed + failed > 0 {
            self.lines.push(line.to_owned());
        }
    }
}

/// Files that are generated, and committed; so are the [`FIGURES`].
const GENERATED: &[&str] = &[
    "schema/willis-1.schema.json",
    "validation/README.md",
    "validation/esmail-2018-table-1/README.md",
    "validation/losses/README.md",
    "validation/galvagno/README.md",
    "validation/modelica/README.md",
    "validation/wang-2020/report.md",
    "validation/wang-2020/planets.csv",
    "validation/wang-2020/speed-constant-torque.csv",
    "validation/wang-2020/speed-constant-power.csv",
    "validation/wang-2020/power.csv",
    "validation/wang-2020/temperature.csv",
    "validation/wang-2020/lubrication.csv",
];

/// Figures of README and book, and what draws them.
const FIGURES: &[(&str, &[&str])] = &[
    (
        "book/src/figures/prius-regimes.svg",
        &["regimes", "examples/prius-p112.toml", "--terminals", "engine,ring,mg1", "--map"],
    ),
    (
        "book/src/figures/compound-regimes.svg",
        &[
            "regimes",
            "examples/compound-split.toml",
            "--terminals",
            "engine,wheels,mg_a,mg_b",
            "--balance",
            "mg_a,mg_b",
            "--map",
        ],
    ),
    ("book/src/figures/herringbone-flow.svg", &["flow", "examples/wang-herringbone.toml", "--output"]),
    (
        "book/src/figures/shift-handed-over.svg",
        &[
            "simulate",
            "examples/shift-8hp70.toml",
            "--scenario",
            "1 to 2, handed over",
            "--columns",
            "speed.input,speed.output,torque.C,torque.E,mode.C,mode.E",
            "--plot",
        ],
    ),
    (
        "book/src/figures/shift-overlap.svg",
        &[
            "simulate",
            "examples/shift-8hp70.toml",
            "--scenario",
            "overlap too long",
            "--columns",
            "speed.input,speed.output,torque.C,torque.E,mode.C,mode.E",
            "--plot",
        ],
    ),
    (
        "book/src/figures/why-does-it-not-move.svg",
        &[
            "simulate",
            "examples/why-does-it-not-move.toml",
            "--scenario",
            "lift, let go, lower",
            "--columns",
            "speed.sun,torque.motor,mode",
            "--plot",
        ],
    ),
    (
        "book/src/figures/galvagno-coast-down.svg",
        &["simulate", "examples/galvagno-coast-down.toml", "--scenario", "coast down", "--plot"],
    ),
    ("book/src/figures/launch-modes.svg", &["modes", "examples/launch.toml", "--state", "clutch closed", "--plot"]),
    (
        "book/src/figures/8hp70-stick.svg",
        &["draw", "stick", "examples/zf-8hp70.toml", "--state", "3", "--theme", "auto", "-o"],
    ),
    ("book/src/figures/8hp70-shift.svg", &["draw", "shift", "examples/zf-8hp70.toml", "--theme", "auto", "-o"]),
    (
        "book/src/figures/8hp70-lever.svg",
        &["draw", "lever", "examples/zf-8hp70.toml", "--state", "3", "--theme", "auto", "-o"],
    ),
    ("book/src/figures/8hp70-map.svg", &["draw", "map", "examples/zf-8hp70.toml", "--theme", "auto", "-o"]),
    (
        "book/src/figures/herringbone-sankey.svg",
        &["draw", "sankey", "examples/wang-herringbone-physical.toml", "--theme", "auto", "-o"],
    ),
    (
        "book/src/figures/herringbone-losses.svg",
        &["draw", "losses", "examples/wang-herringbone-physical.toml", "--theme", "auto", "-o"],
    ),
    ("book/src/figures/nrel-front.svg", &["draw", "front", "examples/nrel-5mw-stage-1.toml", "--theme", "auto", "-o"]),
    (
        "book/src/figures/nrel-tornado.svg",
        &["draw", "tornado", "examples/nrel-5mw-stage-1.toml", "--theme", "auto", "-o"],
    ),
    ("book/src/figures/nrel-band.svg", &["draw", "band", "examples/nrel-5mw-stage-1.toml", "--theme", "auto", "-o"]),
    ("book/src/figures/nrel-film.svg", &["draw", "film", "examples/nrel-5mw-stage-1.toml", "--theme", "auto", "-o"]),
];

/// Writes every generated file. Needs the optimised program.
fn write_generated(context: &Context) -> Result<(), String> {
    let schema = context.output(context.willis().arg("schema"))?.stdout;
    let file = context.root.join(GENERATED[0]);
    fs::create_dir_all(file.parent().expect("a folder")).map_err(|e| format!("the folder schema: {e}"))?;
    fs::write(&file, schema).map_err(|e| format!("{}: {e}", GENERATED[0]))?;
    for (file, arguments) in FIGURES {
        let path = context.root.join(file);
        fs::create_dir_all(path.parent().expect("a folder")).map_err(|e| format!("{file}: {e}"))?;
        context.output(context.willis().args(*arguments).arg(&path))?;
    }
    write_pages(context)
}

/// Writes the pages of `validation`.
fn write_pages(context: &Context) -> Result<(), String> {
    let words = "cargo test -p willis --test validation -- --nocapture write_page";
    context.output(context.words(words).env("WILLIS_WRITE", "1")).map(drop)
}

/// `cargo xtask validate`
fn validate(context: &Context) -> Outcome {
    match write_pages(context) {
        Ok(()) => test(context, "cargo test --workspace --tests --no-fail-fast -- val_"),
        Err(e) => Outcome::Failed(e),
    }
}

/// `cargo xtask generate`
fn generate(context: &Context) -> Outcome {
    outcome(build_willis(context).and_then(|()| write_generated(context)))
}

fn build_willis(context: &Context) -> Result<(), String> {
    context.run("cargo build --quiet --release -p willis-cli")
}

/// Writes the generated files, compares them with what was there, and puts that back.
fn generated(context: &Context) -> Outcome {
    let names = || GENERATED.iter().copied().chain(FIGURES.iter().map(|f| f.0));
    let read = || names().map(|name| fs::read(context.root.join(name)).ok()).collect::<Vec<_>>();
    let before = read();
    if let Err(e) = build_willis(context).and_then(|()| write_generated(context)) {
        return Outcome::Failed(e);
    }
    let after = read();
    let mut stale = Vec::new();
    for ((name, before), after) in names().zip(before).zip(after) {
        if before == after {
            continue;
        }
        let line = match (&before, &after) {
            (Some(before), Some(after)) => {
                let same = before.split(|b| *b == b'\n').zip(after.split(|b| *b == b'\n')).take_while(|(a, b)| a == b);
                format!("{name} differs from line {} on", same.count() + 1)
            }
            _ => format!("{name} is missing"),
        };
        stale.push(line);
        let file = context.root.join(name);
        let _ = before.map_or_else(|| fs::remove_file(&file), |bytes| fs::write(&file, bytes));
    }
    if stale.is_empty() {
        return Outcome::Passed;
    }
    Outcome::Failed(format!("{}: run `cargo xtask generate`", stale.join("; ")))
}

/// Example trains, by path from the root, in order.
fn example_files(context: &Context) -> Result<Vec<String>, String> {
    let folder = fs::read_dir(context.root.join("examples")).map_err(|e| format!("the folder examples: {e}"))?;
    let names = folder.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    let mut files: Vec<String> = names.filter(|n| n.ends_with(".toml")).map(|n| format!("examples/{n}")).collect();
    files.sort();
    if files.is_empty() {
        return Err("there are no examples".into());
    }
    Ok(files)
}

/// Names of the scenarios of a train file: the first key of each.
fn scenarios(text: &str) -> Vec<&str> {
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    let heads = lines.windows(2).filter(|w| w[0].split('#').next().is_some_and(|l| l.trim() == "[[scenario]]"));
    heads.filter_map(|w| w[1].strip_prefix("name = \"")?.split('"').next()).collect()
}

/// Checks and analyses every example, and runs every scenario.
fn examples(context: &Context) -> Outcome {
    let all = || -> Result<usize, String> {
        build_willis(context)?;
        let mut wrong = Vec::new();
        let files = example_files(context)?;
        for file in &files {
            let json = ["--format", "json"];
            let questions = [
                &["check"][..],
                &["analyze"],
                &["analyze", json[0], json[1]],
                &["regimes"],
                &["regimes", json[0], json[1]],
                &["formula", "--derivatives"],
                &["report"],
            ];
            // Power flow and losses need an operating point.
            let text = fs::read_to_string(context.root.join(file)).map_err(|e| format!("{file}: {e}"))?;
            let flows: &[&[&str]] = match text.lines().any(|l| l.trim() == "[[operation]]") {
                true => &[
                    &["flow"],
                    &["flow", "--format", "json"],
                    &["flow", "--format", "svg"],
                    &["losses"],
                    &["losses", "--compare", "mesh_friction", "--format", "json"],
                ],
                false => &[],
            };
            let names = scenarios(&text);
            if names.len() != text.lines().filter(|l| l.trim_start().starts_with("[[scenario]]")).count() {
                wrong.push(format!("{file}: a scenario does not begin with its name"));
            }
            let runs: Vec<[&str; 5]> = (names.iter())
                .flat_map(|name| ["text", "json"].map(|format| ["simulate", "--scenario", name, "--format", format]))
                .collect();
            let shafts: &[&[&str]] = match text.contains("stiffness = ") {
                true => &[&["modes"], &["modes", "--format", "json"]],
                false => &[],
            };
            let moves = runs.iter().map(|r| &r[..]).chain(shafts.iter().copied());
            for arguments in questions.iter().chain(flows).copied().chain(moves) {
                let mut command = context.willis();
                match context.output(command.args(arguments).arg(file)) {
                    Err(e) => wrong.push(e),
                    Ok(output) if arguments.contains(&"json") && !is_object(&output.stdout) => {
                        wrong.push(format!("`{}` does not print a JSON object", said(&command)));
                    }
                    Ok(_) => {}
                }
            }
        }
        if wrong.is_empty() { Ok(files.len()) } else { Err(wrong.join("\n")) }
    };
    match all() {
        Ok(count) => {
            println!(
                "{count} example trains: check, analyze, regimes, formula, report, flow, losses, simulate, modes, and as JSON"
            );
            Outcome::Passed
        }
        Err(e) => Outcome::Failed(e),
    }
}

/// Whether this looks like one JSON object: braces at the ends, brackets closed, strings ended.
fn is_object(text: &[u8]) -> bool {
    let text = text.trim_ascii();
    let (mut open, mut string, mut escaped) = (Vec::new(), false, false);
    for &byte in text {
        match (string, byte) {
            (true, _) if escaped => escaped = false,
            (true, b'\\') => escaped = true,
            (_, b'"') => string = !string,
            (false, b'{') => open.push(b'}'),
            (false, b'[') => open.push(b']'),
            (false, b'}' | b']') if open.pop() != Some(byte) => return false,
            _ => {}
        }
    }
    text.starts_with(b"{") && text.ends_with(b"}") && open.is_empty() && !string
}

/// Runs the commands of README and book and compares.
fn book(context: &Context) -> Outcome {
    match build_willis(context).and_then(|()| book::run(context)) {
        Ok(told) => {
            println!("{told}");
            Outcome::Passed
        }
        Err(e) => Outcome::Failed(e),
    }
}

/// Work counts against their committed values, once that benchmark exists.
fn bench_gate(context: &Context) -> Outcome {
    if !context.root.join("crates/willis/benches/gate.rs").exists() {
        return Outcome::Skipped("there is no crates/willis/benches/gate.rs".into());
    }
    if !context.succeeds("valgrind --version") {
        return Outcome::Skipped("valgrind, which counts the instructions, is not installed".into());
    }
    outcome(context.run("cargo bench -p willis --bench gate"))
}

/// Builds the library for the browser.
fn wasm(context: &Context) -> Outcome {
    const TARGET: &str = "wasm32-unknown-unknown";
    let there = || {
        let output = context.words(&format!("rustc --print target-libdir --target {TARGET}")).output();
        output.is_ok_and(|o| Path::new(String::from_utf8_lossy(&o.stdout).trim()).is_dir())
    };
    if !there() {
        let _ = context.run(&format!("rustup target add {TARGET}"));
        if !there() {
            return Outcome::Skipped(format!("the target {TARGET} cannot be had here"));
        }
    }
    outcome(context.run(&format!("cargo build -p willis -p willis-figure --target {TARGET}")))
}

/// Tests the typesetter, and sets one report.
fn pdf(context: &Context) -> Outcome {
    const MANIFEST: &str = "crates/willis-pdf/Cargo.toml";
    let all = || -> Result<(), String> {
        component(context, "rustfmt")?;
        context.run(&format!("cargo fmt --manifest-path {MANIFEST} --check"))?;
        // Built once, for tests and program alike; beside its manifest, where `report` looks for it.
        let own = context.root.join("crates/willis-pdf/target");
        for words in ["cargo test --release --manifest-path", "cargo build --release --manifest-path"] {
            let words = format!("{words} {MANIFEST}");
            passes(context.words(&words).env("CARGO_TARGET_DIR", &own), &words)?;
        }
        build_willis(context)?;
        let report = context.target.join("report.pdf");
        let mut command = context.willis();
        let path = env::join_paths(
            [own.join("release")].into_iter().chain(env::split_paths(&env::var_os("PATH").unwrap_or_default())),
        );
        command.env("PATH", path.map_err(|e| e.to_string())?);
        context.output(command.args(["report", "examples/wang-herringbone-physical.toml", "-o"]).arg(&report))?;
        let bytes = fs::read(&report).map_err(|e| format!("{}: {e}", report.display()))?;
        println!("a report of {} kB", bytes.len() / 1000);
        if bytes.starts_with(b"%PDF") { Ok(()) } else { Err(format!("{} is no PDF", report.display())) }
    };
    outcome(all())
}

/// Random train files, begun from the examples.
fn fuzz(context: &Context) -> Outcome {
    // The nightly toolchain only compiles the fuzz target; the rest of the project never needs it.
    if !context.succeeds("cargo +nightly --version") {
        return Outcome::Skipped("there is no nightly toolchain here".into());
    }
    if !context.succeeds("cargo fuzz --version") {
        let _ = context.run("cargo install --quiet cargo-fuzz --version ^0.13");
        if !context.succeeds("cargo fuzz --version") {
            return Outcome::Skipped("cargo-fuzz cannot be installed here".into());
        }
    }
    let seed = || -> Result<(), String> {
        let corpus = context.root.join("fuzz/corpus/analyze");
        fs::create_dir_all(&corpus).map_err(|e| format!("the folder fuzz/corpus/analyze: {e}"))?;
        for file in example_files(context)? {
            let name = Path::new(&file).file_name().expect("a file");
            fs::copy(context.root.join(&file), corpus.join(name)).map_err(|e| format!("{file}: {e}"))?;
        }
        Ok(())
    };
    if let Err(e) = seed() {
        return Outcome::Failed(e);
    }
    let seconds = context.seconds;
    let words = format!(
        "cargo +nightly fuzz run --sanitizer none analyze -- -max_total_time={seconds} -timeout=20 \
         -rss_limit_mb=4096 -dict=fuzz/analyze.dict -verbosity=0 -print_final_stats=1"
    );
    let mut command = context.words(&words);
    // This program was started by another toolchain, whose settings must not reach nightly.
    command.env_remove("RUSTUP_TOOLCHAIN").env_remove("LD_LIBRARY_PATH");
    outcome(passes(&mut command, &words))
}

/// `cargo xtask bench`
fn bench(context: &Context) -> Outcome {
    match bench::run(&context.root) {
        Ok(()) => Outcome::Passed,
        Err(why) => Outcome::Failed(why),
    }
}

/// Times as people read them.
fn time(duration: Duration) -> String {
    let seconds = duration.as_secs_f64();
    if seconds < 99.5 {
        format!("{seconds:.1} s")
    } else {
        format!("{:.0} min {:02.0} s", (seconds / 60.0).floor(), (seconds % 60.0).floor())
    }
}

/// Runs steps up to the first that fails, and closes with what they came to.
fn run(steps: &[&Step], context: &Context) -> ExitCode {
    let begin = Instant::now();
    let mut summary = Vec::new();
    let mut tests = None;
    let mut failure = None;
    for (k, step) in steps.iter().enumerate() {
        println!("── {}/{} {}: {}", k + 1, steps.len(), step.name, step.repeat());
        let _ = std::io::stdout().flush();
        let start = Instant::now();
        let outcome = step.run(context);
        let took = time(start.elapsed());
        let (word, remark) = match outcome {
            Outcome::Passed => ("ok", String::new()),
            Outcome::Tested(counted) => {
                let remark = format!("{} passed, {} ignored", counted.passed, counted.ignored);
                tests = Some(counted);
                ("ok", remark)
            }
            Outcome::Skipped(reason) => ("skipped", reason),
            Outcome::Failed(reason) => {
                eprintln!("{reason}");
                failure = Some(step);
                ("FAILED", reason.lines().next().unwrap_or_default().to_owned())
            }
        };
        let colon = if word == "skipped" { ": " } else { "  " };
        let line =
            format!("{:<11} {took:>12}  {word}{}{remark}", step.name, if remark.is_empty() { "" } else { colon });
        println!("── {line}\n");
        summary.push(line);
        if failure.is_some() {
            summary.extend(steps[k + 1..].iter().map(|s| format!("{:<11} {:>12}  not run", s.name, "")));
            break;
        }
    }
    println!("{}\n{:<11} {:>12}", summary.join("\n"), "all", time(begin.elapsed()));
    if let Some(tests) = tests {
        println!("\n{}", tests.lines.join("\n"));
        println!("tests: {} passed, {} failed, {} skipped", tests.passed, tests.failed, tests.ignored);
    }
    let Some(step) = failure else { return ExitCode::SUCCESS };
    println!("\n{} failed; repeat it with\n    {}", step.name, step.repeat());
    ExitCode::FAILURE
}

/// What `cargo xtask` can do.
fn usage() -> String {
    let mut text = String::from(
        "usage: cargo xtask TASK\n\n\
         ci          every step below, in order, up to the first that fails\n\
         check       those marked *: no optimised build\n\
         generate    write the generated files\n\
         validate    write the validation pages, then compare every number of others with ours\n\
         bench       benchmarks of the library\n\n",
    );
    for step in STEPS {
        text += &format!("{:<11}{}{}\n", step.name, if step.in_check { "*" } else { " " }, step.about);
    }
    text
}

fn main() -> ExitCode {
    let words: Vec<String> = env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let (task, seconds) = match words[..] {
        [task] => (task, 20),
        [task @ "fuzz", "--seconds", n] if n.parse::<u64>().is_ok_and(|n| n > 0) => (task, n.parse().expect("checked")),
        _ => ("", 0),
    };
    let context = match Context::new(seconds) {
        Ok(context) => context,
        Err(e) => {
            eprintln!("{e}");
            return ExitCode::FAILURE;
        }
    };
    // `generate`, `validate` and `bench` are no steps of `ci`, but are shown like steps.
    let lone = |name, about, call| Step {
        name,
        about,
        env: &[],
        action: Action::Call(call),
        may_skip: false,
        in_check: false,
    };
    match task {
        "ci" => run(&STEPS.iter().collect::<Vec<_>>(), &context),
        "check" => run(&STEPS.iter().filter(|s| s.in_check).collect::<Vec<_>>(), &context),
        "generate" => run(&[&lone("generate", "", generate)], &context),
        "validate" => run(&[&lone("validate", "", validate)], &context),
        "bench" => run(&[&lone("bench", "", bench)], &context),
        "help" | "--help" | "-h" => {
            print!("{}", usage());
            ExitCode::SUCCESS
        }
        name => match STEPS.iter().find(|s| s.name == name) {
            Some(step) => run(&[step], &context),
            None => {
                eprint!("{}", usage());
                ExitCode::from(2)
            }
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn result_lines_are_counted() {
        let mut tests = Tests::default();
        tests.read("test result: ok. 3 passed; 0 failed; 1 ignored; 0 measured; 0 filtered out; finished in 0.00s");
        tests
            .read("test result: FAILED. 12 passed; 2 failed; 0 ignored; 0 measured; 0 filtered out; finished in 1.25s");
        tests.read("test result: ok. 0 passed; 0 failed; 0 ignored; 0 measured; 9 filtered out; finished in 0.00s");
        tests.read("test passed ... ok");
        assert_eq!((tests.passed, tests.failed, tests.ignored, tests.lines.len()), (15, 2, 1, 2));
    }

    #[test]
    fn objects_are_told_from_other_text() {
        for good in ["{}", " {\"a\": [1, {\"b\": \"}\\\"\"}]}\n"] {
            assert!(is_object(good.as_bytes()), "{good}");
        }
        for bad in ["", "[]", "{", "{]}", "{\"a}", "error {}", "{}}"] {
            assert!(!is_object(bad.as_bytes()), "{bad}");
        }
    }

    #[test]
    fn scenarios_are_found_by_name() {
        let text = "[[scenario]]\nname = \"up, down\"\n\n[[scenario.source]]\nname = \"m\"\n\n[[scenario]]   # two\nname = \"2\"\n";
        assert_eq!(scenarios(text), ["up, down", "2"]);
    }

    #[test]
    fn a_failure_can_be_repeated() {
        for step in STEPS {
            assert!(step.repeat().contains("cargo "), "{}", step.name);
        }
        let doc = STEPS.iter().find(|s| s.name == "doc").unwrap();
        assert_eq!(doc.repeat(), "RUSTDOCFLAGS='-D warnings' cargo doc --workspace --no-deps");
    }
}
