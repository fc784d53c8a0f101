//! The program `willis`.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(willis_cli::run_command(std::env::args_os()))
}
