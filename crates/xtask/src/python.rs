//! The Python package: built as a wheel, installed where nothing else is, and tested there.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::context::{Context, passes};
use crate::environment::Environment;
use crate::step::{Outcome, outcome};

/// What tests and type checkers need beside the package. NumPy comes with it.
const TOOLS: &str = "maturin>=1.9,<2 pytest hypothesis mypy pyright pyarrow polars pandas duckdb sympy pint distributed nbclient \
                     nbformat ipykernel matplotlib tqdm";

const CRATE: &str = "crates/willis-py";

/// Builds the wheel, installs it and runs what is written for it.
pub(crate) fn python(context: &Context) -> Outcome {
    let (environment, wheels) = (environment(context), context.target.join("python/wheels"));
    if let Err(why) = environment.install(context) {
        return Outcome::Skipped(why);
    }
    outcome(test(context, &environment, &wheels))
}

/// What builds wheels, alone.
pub(crate) fn builder(context: &Context) -> Environment {
    let (whole, alone) = (environment(context), "maturin>=1.9,<2");
    if whole.program(context, "maturin").arg("--version").output().is_ok_and(|o| o.status.success()) {
        return whole;
    }
    Environment::new(context, "dist/maturin", alone)
}

/// Its environment.
fn environment(context: &Context) -> Environment {
    Environment::new(context, "python/venv", TOOLS)
}

/// What can be fetched before.
pub(crate) fn builds(context: &Context) -> Vec<Command> {
    environment(context).commands(context).into()
}

/// The wheel, built into a folder that has no other.
pub(crate) fn build_wheel(
    context: &Context,
    environment: &Environment,
    folder: &Path,
    profile: Option<&str>,
) -> Result<PathBuf, String> {
    let manifest = format!("{CRATE}/Cargo.toml");
    let mut build = environment.program(context, "maturin");
    build.env("WILLIS_WHEEL", "1");
    build.args(["build", "--quiet", "--manifest-path", &manifest, "--out"]).arg(folder);
    if let Some(profile) = profile {
        build.args(["--profile", profile]);
    }
    passes(&mut build, "maturin build")?;
    let files = fs::read_dir(folder).map_err(|e| e.to_string())?.flatten().map(|e| e.path());
    let wheel = files.into_iter().find(|path| path.extension().is_some_and(|e| e == "whl"));
    wheel.ok_or("maturin made no wheel".into())
}

fn test(context: &Context, environment: &Environment, wheels: &Path) -> Result<(), String> {
    let _ = fs::remove_dir_all(wheels);
    let wheel = build_wheel(context, environment, wheels, None)?;
    let size = fs::metadata(&wheel).map_err(|e| e.to_string())?.len();
    println!("{}: {:.1} MB", wheel.display(), size as f64 / 1e6);
    // Without link-time optimisation, which the published one has.
    if size > 16_500_000 {
        return Err("the wheel is larger than 16.5 MB".into());
    }
    let mut pip = environment.program(context, "pip");
    passes(pip.args(["install", "--quiet", "--force-reinstall", "--no-deps"]).arg(&wheel), "pip install of the wheel")?;
    let script = |name: &str| format!("{CRATE}/{name}");
    let mut check = environment.program(context, "python");
    passes(check.arg(script("generate.py")).arg("--check"), "generate.py --check")?;
    let mut mypy = environment.program(context, "mypy");
    mypy.args(["--strict", "--config-file"]).args(["pyproject.toml", "python/willis", "tests/typed.py"].map(script));
    let mut pyright = environment.program(context, "pyright");
    pyright.arg("--pythonpath").arg(environment.python()).args(["--project", CRATE]);
    // Types are checked beside the tests; what that prints comes after what they print.
    std::thread::scope(|scope| {
        let types = scope.spawn(|| -> Result<Vec<Output>, String> {
            [&mut mypy, &mut pyright].into_iter().map(|c| context.output(c)).collect()
        });
        let mut pytest = environment.program(context, "python");
        pytest.args(["-m", "pytest", "--quiet", "-p", "no:cacheprovider"]).arg(script("tests"));
        let tested = passes(&mut pytest, "pytest");
        let types = types.join().map_err(|_| "the check of types ended early".to_owned())?;
        tested?;
        for output in types? {
            print!("{}", String::from_utf8_lossy(&output.stdout));
        }
        Ok(())
    })
}
