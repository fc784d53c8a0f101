//! The optimised program, which most tasks ask.

use std::process::Command;

use crate::context::Context;

/// Builds the optimised program, with the Python package and the runtime of FMUs, which lies beside it: alone each has other features of the same dependencies, so that
/// everything above them would be compiled twice.
pub(crate) const RELEASE: &str = "cargo build --release -p willis-cli -p willis-py -p willis-fmu";

/// What can be built before it is needed.
pub(crate) fn builds(context: &Context) -> Vec<Command> {
    vec![context.words(RELEASE)]
}

/// The optimised program, without a word where it is there.
pub(crate) fn build_willis(context: &Context) -> Result<(), String> {
    match context.options.program {
        Some(_) => Ok(()),
        None => context.run(&format!("{RELEASE} --quiet")),
    }
}
