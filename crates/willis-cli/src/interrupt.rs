//! Ctrl-C: the first ends the work where it is, the second the program.

use std::sync::atomic::{AtomicBool, Ordering};

/// Set by Ctrl-C.
static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// Whether Ctrl-C was pressed.
pub fn interrupted() -> bool {
    INTERRUPTED.load(Ordering::Relaxed)
}

/// Listens from now on; `at_last` runs before the program ends at the second Ctrl-C.
pub fn listen(at_last: fn()) {
    let pressed = move || {
        if INTERRUPTED.swap(true, Ordering::Relaxed) {
            at_last();
            std::process::exit(130);
        }
    };
    // Without it the system's own handling stays: the program ends at once.
    let _ = ctrlc::set_handler(pressed);
}
