//! Ctrl-C, and a polite request to end: the first ends the work where it is, the second the program.

use std::sync::Once;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::output;

static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// Whether the work is to end. From the first time that it is asked, Ctrl-C ends the work and not the program; work that
/// never asks ends with the program.
pub fn interrupted() -> bool {
    static LISTENING: Once = Once::new();
    LISTENING.call_once(|| {
        let pressed = || {
            if INTERRUPTED.swap(true, Ordering::Relaxed) {
                output::clear();
                std::process::exit(130);
            }
        };
        // Without it the system's own handling stays: the program ends at once.
        let _ = ctrlc::set_handler(pressed);
    });
    INTERRUPTED.load(Ordering::Relaxed)
}
