//! Tasks of the repository: `cargo xtask ci` runs everything that must hold, each step alone is
//! `cargo xtask STEP`.
//!
//! [`STEPS`] is the whole list. Adding a step is adding an entry there; what it does has a file of its own.

mod bench;
mod book;
mod context;
mod dist;
mod environment;
mod examples;
mod exports;
mod fmu;
mod fuzz;
mod generate;
mod growth;
mod licences;
mod measure;
mod package;
mod pdf;
mod program;
mod python;
mod reference;
mod site;
mod step;
mod studio;
mod tested;

use std::env;
use std::process::ExitCode;

use context::{Context, Options};
use step::{Action, Step, run};

/// In order: what fails soonest comes first, what may be skipped last. The tests come late, so
/// that their result lines stand at the end.
const STEPS: &[Step] = &[
    Step::new("fmt", "formatting", Action::RunComponent("rustfmt", "cargo fmt --all --check")).in_check(),
    Step::new("licences", "dependencies may be used", Action::Call(licences::licences)),
    Step::new("advisories", "dependencies have no known holes", Action::Call(licences::advisories)).may_skip(),
    Step::new(
        "clippy",
        "lints, warnings are errors",
        Action::RunComponent("clippy", "cargo clippy --workspace --all-targets -- -D warnings"),
    )
    .in_check(),
    Step::new(
        "test",
        "unit, integration, validation and documentation tests",
        Action::Test("cargo test --workspace --no-fail-fast"),
    )
    .in_check(),
    Step::new("doc", "documentation, warnings are errors", Action::Run("cargo doc --workspace --no-deps"))
        .env(&[("RUSTDOCFLAGS", "-D warnings")])
        .in_check(),
    Step::new("package", "every published crate holds what it needs", Action::Call(package::package)),
    Step::new("release", "the optimised program", Action::Run(program::RELEASE)).ahead(program::builds),
    Step::new(
        "generated",
        "generated files are as `cargo xtask generate` writes them",
        Action::Call(generate::generated),
    ),
    Step::new("examples", "the program answers for every example train", Action::Call(examples::examples)),
    Step::new("book", "what README and book say the program prints is what it prints", Action::Call(book::book)),
    Step::new("pages", "the book as web pages", Action::Call(book::pages)).may_skip(),
    Step::new("bench-gate", "work counts have not grown", Action::Call(bench::bench_gate)).may_skip().ahead(bench::builds),
    Step::new(
        "studio",
        "the library answers as WebAssembly, and the page around it works in a browser; [--no-tests] builds the page only",
        Action::Call(studio::studio),
    )
    .may_skip()
    .ahead(studio::builds),
    Step::new("python", "the Python package: wheel, tests, types, notebooks", Action::Call(python::python))
        .may_skip()
        .ahead(python::builds),
    Step::new("fmu", "units of the program run in simulators that others wrote", Action::Call(fmu::fmu))
        .may_skip()
        .ahead(fmu::builds),
    Step::new("pdf", "reports as PDF, by a typesetter that is built for nobody else", Action::Call(pdf::pdf)).ahead(pdf::builds),
];

/// Tasks that are no steps of `ci`, but are shown like steps.
const TASKS: &[Step] = &[
    Step::new("generate", "write the generated files", Action::Call(generate::generate)),
    Step::new("reference", "of the generated files the reference pages of the book only; [--program FILE] one that is built", Action::Call(reference::reference)),
    Step::new(
        "validate",
        "write the validation pages, then compare every number of others with ours; [--modelica FOLDER] whole trajectories",
        Action::Call(generate::validate),
    ),
    Step::new(
        "fuzz",
        "no panic on random train files that grow by what they reach: 20 s, [--seconds N]; [--long] every text, 15 min a target",
        Action::Call(fuzz::fuzz),
    )
    .may_skip(),
    Step::new(
        "site",
        "book, gallery, validation pages, studio and references as one folder of pages; [--studio FILE] [--program FILE] built before; [--no-api]",
        Action::Call(site::site),
    )
    .may_skip(),
    Step::new(
        "exports",
        "exported actuators loaded and moved in MuJoCo and Drake, units and equations in FMPy and rumoca; [--speed] how fast each is",
        Action::Call(exports::exports),
    )
    .may_skip(),
    Step::new(
        "dist",
        "the release: program, wheel, studio, site, licences and checksums, installed where nothing else is; [--profile PROFILE] \
         [--program FILE] [--wheel FILE] [--studio FILE] built before, [--no-python] [--no-studio] [--no-site] [--no-api]",
        Action::Call(dist::dist),
    ),
    Step::new("bench", "benchmarks of the library", Action::Call(bench::bench)),
    Step::new(
        "measure",
        "how long the way from text to answer is; [--build] time and size of a build from nothing",
        Action::Call(measure::measure),
    ),
];

/// What `cargo xtask` can do.
fn usage() -> String {
    let mut text = String::from(
        "usage: cargo xtask TASK\n\n\
         ci          every step below, in order, up to the first that fails\n\
         check       those marked *: no optimised build\n",
    );
    text.extend(TASKS.iter().map(|task| format!("{:<12}{}\n", task.name, task.about)));
    text += "\n";
    for step in STEPS {
        text += &format!("{:<11}{}{}\n", step.name, if step.in_check { "*" } else { " " }, step.about);
    }
    text
}

/// Task and options; `None` if they are not understood.
fn read(words: &[String]) -> Option<(&str, Options)> {
    let (task, mut rest) = words.split_first()?;
    let mut options = Options::default();
    while let [flag, more @ ..] = rest {
        rest = match (task.as_str(), flag.as_str(), more) {
            ("fuzz", "--seconds", [n, more @ ..]) => {
                options.seconds = Some(n.parse().ok().filter(|n| *n > 0)?);
                more
            }
            ("fuzz", "--long", more) => {
                options.long = true;
                more
            }
            ("studio", "--no-tests", more) => {
                options.no_tests = true;
                more
            }
            ("validate", "--modelica", [folder, more @ ..]) => {
                // Tests run in the folder of their crate.
                options.modelica = Some(std::path::absolute(folder).ok()?);
                more
            }
            ("site" | "dist", "--studio", [file, more @ ..]) => {
                options.studio = Some(std::path::absolute(file).ok()?);
                more
            }
            ("dist" | "reference" | "site", "--program", [file, more @ ..]) => {
                options.program = Some(std::path::absolute(file).ok()?);
                more
            }
            ("dist", "--wheel", [file, more @ ..]) => {
                options.wheel = Some(std::path::absolute(file).ok()?);
                more
            }
            ("dist", "--profile", [name, more @ ..]) => {
                options.profile = Some(name.clone());
                more
            }
            ("dist", "--no-python", more) => {
                options.no_python = true;
                more
            }
            ("dist", "--no-studio", more) => {
                options.no_studio = true;
                more
            }
            ("dist", "--no-site", more) => {
                options.no_site = true;
                more
            }
            ("site" | "dist", "--no-api", more) => {
                options.no_api = true;
                more
            }
            ("exports", "--speed", more) => {
                options.speed = true;
                more
            }
            ("measure", "--build", more) => {
                options.build = true;
                more
            }
            _ => return None,
        };
    }
    Some((task, options))
}

fn main() -> ExitCode {
    let words: Vec<String> = env::args().skip(1).collect();
    let Some((task, options)) = read(&words) else {
        eprint!("{}", usage());
        return ExitCode::from(2);
    };
    let context = match Context::new(options) {
        Ok(context) => context,
        Err(e) => {
            eprintln!("{e}");
            return ExitCode::FAILURE;
        }
    };
    match task {
        "ci" => run(&STEPS.iter().collect::<Vec<_>>(), &context),
        "check" => run(&STEPS.iter().filter(|s| s.in_check).collect::<Vec<_>>(), &context),
        "help" | "--help" | "-h" => {
            print!("{}", usage());
            ExitCode::SUCCESS
        }
        name => match STEPS.iter().chain(TASKS).find(|s| s.name == name) {
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
    fn a_failure_can_be_repeated() {
        for step in STEPS {
            assert!(step.repeat().contains("cargo "), "{}", step.name);
        }
        let doc = STEPS.iter().find(|s| s.name == "doc").unwrap();
        assert_eq!(doc.repeat(), "RUSTDOCFLAGS='-D warnings' cargo doc --workspace --no-deps");
    }

    #[test]
    fn options_belong_to_their_task() {
        let of = |words: &str| {
            let words: Vec<String> = words.split(' ').map(str::to_owned).collect();
            read(&words).map(|(task, options)| (task.to_owned(), options.seconds, options.build))
        };
        assert_eq!(of("fuzz --seconds 300"), Some(("fuzz".into(), Some(300), false)));
        assert_eq!(of("fuzz --long"), Some(("fuzz".into(), None, false)));
        assert_eq!(of("measure --build"), Some(("measure".into(), None, true)));
        assert_eq!((of("fuzz --seconds 0"), of("ci --build")), (None, None));
    }
}
