//! The program `willis`.

use std::process::ExitCode;

/// An analysis makes thousands of short arrays: a quarter of its time with the allocator of the C library.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> ExitCode {
    ExitCode::from(willis_cli::run_command(std::env::args_os()))
}
