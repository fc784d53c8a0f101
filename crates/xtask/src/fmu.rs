//! FMUs in the hands of simulators that others wrote: FMPy, libcosim and Ecos, in an environment of their own.

use std::process::Command;

use crate::context::{Context, passes};
use crate::environment::Environment;
use crate::program::build_willis;
use crate::step::{Outcome, outcome};

/// The simulators, and what runs the tests.
const TOOLS: &str = "fmpy>=0.3.20 libcosimpy ecospy tbb pytest";

/// The tests.
const TESTS: &str = "crates/willis-fmu/tests/hosts.py";

/// Exports units and lets others run them.
pub(crate) fn fmu(context: &Context) -> Outcome {
    let environment = environment(context);
    if let Err(why) = environment.install(context) {
        return Outcome::Skipped(why);
    }
    outcome(build_willis(context).and_then(|()| {
        let mut pytest = environment.program(context, "python");
        let willis = context.target.join("release").join(format!("willis{}", std::env::consts::EXE_SUFFIX));
        // What is measured is printed.
        pytest.args(["-m", "pytest", "--quiet", "-rP", "-p", "no:cacheprovider", TESTS]);
        passes(pytest.env("WILLIS", willis).env("PYTHONDONTWRITEBYTECODE", "1"), "pytest")
    }))
}

/// Its environment.
fn environment(context: &Context) -> Environment {
    Environment::new(context, "fmu/venv", TOOLS)
}

/// What can be fetched before.
pub(crate) fn builds(context: &Context) -> Vec<Command> {
    environment(context).commands(context).into()
}
