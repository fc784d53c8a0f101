//! FMUs in the hands of simulators that others wrote: FMPy and libcosim, in an environment of their own.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::context::{Context, passes};
use crate::program::build_willis;
use crate::step::{Outcome, outcome};

/// The simulators, and what runs the tests.
const TOOLS: &str = "fmpy>=0.3.20 libcosimpy pytest";

/// The tests.
const TESTS: &str = "crates/willis-fmu/tests/hosts.py";

/// Exports units and lets others run them.
pub(crate) fn fmu(context: &Context) -> Outcome {
    let venv = venv(context);
    let [mut make, mut pip] = tools(context, &venv);
    let had = passes(&mut make, "python3 -m venv").and_then(|()| passes(&mut pip, "pip install"));
    if let Err(why) = had {
        return Outcome::Skipped(format!("packages cannot be had: {why}"));
    }
    outcome(build_willis(context).and_then(|()| {
        let mut pytest = of(context, &venv, "python");
        let willis = context.target.join("release").join(format!("willis{}", std::env::consts::EXE_SUFFIX));
        // What is measured is printed.
        pytest.args(["-m", "pytest", "--quiet", "-rP", "-p", "no:cacheprovider", TESTS]);
        passes(pytest.env("WILLIS", willis).env("PYTHONDONTWRITEBYTECODE", "1"), "pytest")
    }))
}

fn venv(context: &Context) -> PathBuf {
    context.target.join("fmu/venv")
}

/// An environment with the tools: what makes it, and what fills it. Both do nothing where that is done.
fn tools(context: &Context, venv: &Path) -> [Command; 2] {
    let mut make = context.words("python3 -m venv");
    make.arg(venv);
    let mut pip = of(context, venv, "pip");
    pip.args(["install", "--quiet", "--disable-pip-version-check"]).args(TOOLS.split_whitespace());
    [make, pip]
}

/// What can be fetched before.
pub(crate) fn builds(context: &Context) -> Vec<Command> {
    tools(context, &venv(context)).into()
}

/// A program of the environment, run in the root of the repository.
fn of(context: &Context, venv: &Path, program: &str) -> Command {
    let mut command = context.command(venv.join("bin").join(program));
    command.env_remove("PYTHONPATH");
    command
}
