//! Ctrl-C, and a request of the system to end: the first ends the work where it is, the second the program; work that
//! does not end by itself is ended after a while.

use std::sync::Once;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use crate::output;

static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// How long work may take to end by itself.
const PATIENCE: Duration = Duration::from_secs(10);

/// Ends the program where it is.
fn end() -> ! {
    output::clear();
    std::process::exit(130);
}

/// Whether the work is to end. From the first time that it is asked, Ctrl-C ends the work and not the program; work that
/// never asks ends with the program.
pub fn interrupted() -> bool {
    static LISTENING: Once = Once::new();
    LISTENING.call_once(|| {
        let pressed = || {
            if INTERRUPTED.swap(true, Ordering::Relaxed) {
                end();
            }
            // Nobody presses twice where a batch system asked; and some work asks seldom.
            std::thread::spawn(|| {
                std::thread::sleep(PATIENCE);
                end();
            });
        };
        // Without it the system's own handling stays: the program ends at once.
        let _ = ctrlc::set_handler(pressed);
    });
    INTERRUPTED.load(Ordering::Relaxed)
}
