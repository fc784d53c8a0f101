//! The Python package: built as a wheel, installed where nothing else is, and tested there.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::context::{Context, passes};
use crate::step::{Outcome, outcome};

/// What tests and type checkers need beside the package. NumPy comes with it.
const TOOLS: &str = "maturin>=1.9,<2 pytest hypothesis mypy pyright pyarrow polars pandas duckdb sympy pint distributed nbclient \
                     nbformat ipykernel matplotlib tqdm";

const CRATE: &str = "crates/willis-py";

/// Builds the wheel, installs it and runs what is written for it.
pub(crate) fn python(context: &Context) -> Outcome {
    let folder = context.target.join("python");
    let (venv, wheels) = (folder.join("venv"), folder.join("wheels"));
    if let Err(why) = install(context, &venv, TOOLS) {
        return Outcome::Skipped(why);
    }
    outcome(test(context, &venv, &wheels))
}

/// A new environment with these packages.
fn install(context: &Context, venv: &Path, packages: &str) -> Result<(), String> {
    let mut make = context.words("python3 -m venv --clear");
    passes(make.arg(venv), "python3 -m venv")?;
    let mut pip = of(context, venv, "pip");
    pip.args(["install", "--quiet", "--disable-pip-version-check"]).args(packages.split_whitespace());
    passes(&mut pip, "pip install").map_err(|why| format!("packages cannot be had: {why}"))
}

/// A program of an environment, run in the root of the repository.
fn of(context: &Context, venv: &Path, program: &str) -> Command {
    let mut command = Command::new(venv.join("bin").join(program));
    command.current_dir(&context.root).env_remove("PYTHONPATH");
    command
}

fn test(context: &Context, venv: &Path, wheels: &Path) -> Result<(), String> {
    let _ = fs::remove_dir_all(wheels);
    let manifest = format!("{CRATE}/Cargo.toml");
    let mut build = of(context, venv, "maturin");
    build.args(["build", "--quiet", "--manifest-path", &manifest, "--out"]).arg(wheels);
    passes(&mut build, "maturin build")?;
    let wheel = fs::read_dir(wheels).map_err(|e| e.to_string())?.flatten().map(|e| e.path()).next();
    let wheel = wheel.ok_or("maturin made no wheel")?;
    let size = fs::metadata(&wheel).map_err(|e| e.to_string())?.len();
    println!("{}: {:.1} MB", wheel.display(), size as f64 / 1e6);
    if size > 15_000_000 {
        return Err("the wheel is larger than 15 MB".into());
    }
    let mut pip = of(context, venv, "pip");
    passes(pip.args(["install", "--quiet", "--force-reinstall", "--no-deps"]).arg(&wheel), "pip install of the wheel")?;
    let script = |name: &str| format!("{CRATE}/{name}");
    let steps: &[(&str, &[&str])] = &[
        ("python", &[&script("generate.py"), "--check"]),
        ("python", &["-m", "pytest", "--quiet", "-p", "no:cacheprovider", &script("tests")]),
        (
            "mypy",
            &[
                "--strict",
                "--config-file",
                &script("pyproject.toml"),
                &script("python/willis"),
                &script("tests/typed.py"),
            ],
        ),
    ];
    for (program, words) in steps {
        let mut command = of(context, venv, program);
        passes(command.args(*words), &format!("{program} {}", words.join(" ")))?;
    }
    let mut pyright = of(context, venv, "pyright");
    pyright.arg("--pythonpath").arg(venv.join("bin/python")).args(["--project", CRATE]);
    passes(&mut pyright, "pyright")
}
