//! Work under an interpreter: threads that do not hold it, Ctrl-C, progress.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread::ThreadId;
use std::time::{Duration, Instant};

use pyo3::prelude::*;
use willis::work::Work;
use willis_cli::work::{cores, on_threads};

/// How often the interpreter is asked whether somebody pressed Ctrl-C, and told how far the work is.
const BREATH: Duration = Duration::from_millis(50);

/// The surroundings of a long computation in Python.
pub struct Interpreter {
    threads: usize,
    patience: f64,
    /// The thread that asked: it alone talks with the interpreter.
    own: ThreadId,
    /// Called with what is counted, how many of it are done, and how many there are.
    progress: Option<Py<PyAny>>,
    stage: Mutex<(&'static str, u64)>,
    done: AtomicU64,
    stopped: AtomicBool,
    state: Mutex<State>,
}

struct State {
    last: Instant,
    /// What the interpreter raised.
    error: Option<PyErr>,
}

impl Interpreter {
    /// With so many threads, 0 for as many as there are cores.
    pub fn new(threads: usize, patience: f64, progress: Option<Py<PyAny>>) -> Self {
        Self {
            threads: if threads == 0 { cores() } else { threads },
            patience,
            own: std::thread::current().id(),
            progress,
            stage: Mutex::new(("", 0)),
            done: AtomicU64::new(0),
            stopped: AtomicBool::new(false),
            state: Mutex::new(State { last: Instant::now(), error: None }),
        }
    }

    /// What was raised meanwhile.
    pub fn raised(&self) -> Option<PyErr> {
        self.state.lock().ok()?.error.take()
    }

    /// The end of the stage, told to who watches.
    pub fn finish(&self) {
        if self.progress.is_some() {
            self.talk();
        }
    }

    /// Tells the interpreter how far the work is and asks whether to go on.
    fn talk(&self) {
        let Ok(mut state) = self.state.lock() else { return };
        state.last = Instant::now();
        if state.error.is_some() {
            return;
        }
        let told = Python::attach(|py| {
            py.check_signals()?;
            let Some(progress) = &self.progress else { return Ok(()) };
            let (what, of) = self.stage.lock().map_or(("", 0), |s| *s);
            progress.call1(py, (what, self.done.load(Ordering::Relaxed).min(of), of)).map(drop)
        });
        if let Err(error) = told {
            state.error = Some(error);
            self.stopped.store(true, Ordering::Relaxed);
        }
    }

    fn breathe(&self) {
        let is_due = || self.state.try_lock().is_ok_and(|s| s.last.elapsed() > BREATH);
        if std::thread::current().id() == self.own && is_due() {
            self.talk();
        }
    }
}

impl Work for Interpreter {
    fn begin(&self, what: &'static str, of: u64) {
        if let Ok(mut stage) = self.stage.lock() {
            *stage = (what, of);
        }
        self.done.store(0, Ordering::Relaxed);
        self.breathe();
    }

    fn advance(&self, steps: u64) {
        self.done.fetch_add(steps, Ordering::Relaxed);
        self.breathe();
    }

    fn patience(&self) -> f64 {
        self.patience
    }

    fn cancelled(&self) -> bool {
        self.breathe();
        self.stopped.load(Ordering::Relaxed)
    }

    fn run(&self, parts: usize, job: &(dyn Fn(usize) + Sync)) {
        on_threads(self.threads, parts, &|| self.cancelled(), job);
    }
}
