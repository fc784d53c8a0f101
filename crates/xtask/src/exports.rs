//! Exports in the hands of engines and readers that others wrote: MuJoCo, Drake, FMPy, rumoca, openfast-io, and the XML Schema of
//! REXS where `WILLIS_REXS_SCHEMA` names it, in an environment of their own.
//!
//! No step of `ci`: Drake alone is more than a hundred megabytes.

use crate::context::{Context, passes};
use crate::environment::Environment;
use crate::program::build_willis;
use crate::step::{Outcome, outcome};

/// The engines. What is newer than these versions is tried too: its deviations are in the table.
const TOOLS: &str = "mujoco>=4.0 drake>=1.51 rumoca fmpy>=0.3.20 numpy openfast-io xmlschema";

/// Loads, moves, compares.
const SCRIPT: &str = "crates/willis-cli/tests/engines.py";

/// Exports an actuator and lets others move it.
pub(crate) fn exports(context: &Context) -> Outcome {
    let environment = Environment::new(context, "exports/venv", TOOLS);
    if let Err(why) = environment.install(context) {
        return Outcome::Skipped(why);
    }
    outcome(build_willis(context).and_then(|()| {
        let mut python = environment.program(context, "python");
        let willis = context.target.join("release").join(format!("willis{}", std::env::consts::EXE_SUFFIX));
        python.arg(SCRIPT);
        if context.options.speed {
            python.arg("--speed");
        }
        passes(python.env("WILLIS", willis).env("PYTHONDONTWRITEBYTECODE", "1"), "engines.py")
    }))
}
