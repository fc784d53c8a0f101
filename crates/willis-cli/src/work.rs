//! Work on all cores, with a bar that tells how fast and how long yet.

use std::io::IsTerminal;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use willis::work::{Serial, Work};

use crate::interrupt::interrupted;

/// Threads to use where nothing is said.
pub fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// How long work lasts before a bar shows it.
const PATIENCE: Duration = Duration::from_millis(500);

/// The terminal as the surroundings of work: its cores, its standard error, Ctrl-C.
pub(crate) struct Terminal {
    threads: usize,
    /// However long it takes.
    is_patient: bool,
    stage: Mutex<Option<Stage>>,
}

/// A stage with its bar, which is shown once it takes long.
struct Stage {
    bar: ProgressBar,
    since: Instant,
    is_shown: bool,
}

impl Terminal {
    /// With so many threads, and whether everything may take as long as it takes.
    pub fn new(threads: usize, is_patient: bool) -> Self {
        Self { threads: threads.max(1), is_patient, stage: Mutex::new(None) }
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        if let Ok(Some(stage)) = self.stage.lock().as_deref() {
            stage.bar.finish_and_clear();
        }
    }
}

impl Drop for Terminal {
    fn drop(&mut self) {
        self.finish();
    }
}

impl Work for Terminal {
    fn begin(&self, what: &'static str, of: u64) {
        self.finish();
        let bar = std::io::stderr().is_terminal().then(|| {
            let bar = ProgressBar::with_draw_target(Some(of), ProgressDrawTarget::hidden());
            let style = "{bar:40} {percent:>3} %  {human_pos} of {human_len} {msg}  {per_sec}  {eta} left";
            bar.set_message(what);
            bar.set_style(ProgressStyle::with_template(style).expect("a good template"));
            Stage { bar, since: Instant::now(), is_shown: false }
        });
        if let Ok(mut stage) = self.stage.lock() {
            *stage = bar;
        }
    }

    fn advance(&self, steps: u64) {
        // Somebody else shows it just now.
        let Ok(mut stage) = self.stage.try_lock() else { return };
        let Some(stage) = stage.as_mut() else { return };
        stage.bar.inc(steps);
        if !stage.is_shown && stage.since.elapsed() > PATIENCE {
            stage.is_shown = true;
            stage.bar.set_draw_target(ProgressDrawTarget::stderr_with_hz(5));
        }
    }

    fn patience(&self) -> f64 {
        if self.is_patient { f64::INFINITY } else { Serial.patience() }
    }

    fn cancelled(&self) -> bool {
        interrupted()
    }

    fn run(&self, parts: usize, job: &(dyn Fn(usize) + Sync)) {
        on_threads(self.threads, parts, &|| self.cancelled(), job);
    }
}

/// Calls `job` with every number below `parts` on so many threads, the caller's among them; no further part is begun after
/// `cancelled` turned true.
pub fn on_threads(threads: usize, parts: usize, cancelled: &(dyn Fn() -> bool + Sync), job: &(dyn Fn(usize) + Sync)) {
    let next = AtomicUsize::new(0);
    let one = || {
        loop {
            let part = next.fetch_add(1, Ordering::Relaxed);
            if part >= parts || cancelled() {
                return;
            }
            job(part);
        }
    };
    std::thread::scope(|scope| {
        for _ in 1..threads.min(parts) {
            scope.spawn(one);
        }
        one();
    });
}
