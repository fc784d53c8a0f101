//! Pieces of work on all cores, with a bar that tells how fast and how long yet.

use std::collections::BTreeMap;
use std::io::IsTerminal;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Threads to use where nothing is said.
pub fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// How long work lasts before a bar shows it.
const PATIENCE: Duration = Duration::from_millis(500);

/// Works off pieces in any order; `told` hears of each on this thread. Returns how many are left, because `make` gave
/// nothing. `(done, all)` is what the bar counts, of things called `what`; `size` is what a piece adds.
pub fn run<T: Send, S: Default>(
    pieces: &[u64],
    threads: usize,
    (done, all, what): (u64, u64, &'static str),
    size: impl Fn(u64) -> u64,
    make: impl Fn(u64, &mut S) -> Result<Option<T>, String> + Sync,
    mut told: impl FnMut(u64, T),
) -> Result<u64, String> {
    let next = AtomicUsize::new(0);
    let (send, receive) = channel();
    let bar = std::io::stderr().is_terminal().then(|| {
        let bar = bar(what, all);
        bar.set_position(done);
        bar.reset_eta();
        bar
    });
    let (mut left, started, mut is_shown) = (pieces.len() as u64, Instant::now(), false);
    let mut failed = None;
    std::thread::scope(|scope| {
        for _ in 0..threads.min(pieces.len()).max(1) {
            let (send, next, make) = (send.clone(), &next, &make);
            scope.spawn(move || {
                let mut own = S::default();
                while let Some(&piece) = pieces.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let made = make(piece, &mut own);
                    let ends = !matches!(made, Ok(Some(_)));
                    if send.send((piece, made)).is_err() || ends {
                        // The others see that there is no more.
                        next.fetch_max(pieces.len(), Ordering::Relaxed);
                        return;
                    }
                }
            });
        }
        drop(send);
        loop {
            if let Some(bar) = bar.as_ref().filter(|_| !is_shown && started.elapsed() > PATIENCE) {
                bar.set_draw_target(ProgressDrawTarget::stderr_with_hz(5));
                is_shown = true;
            }
            match receive.recv_timeout(Duration::from_millis(200)) {
                Ok((piece, Ok(Some(made)))) => {
                    left -= 1;
                    if let Some(bar) = &bar {
                        bar.inc(size(piece));
                    }
                    told(piece, made);
                }
                Ok((_, Ok(None))) => {}
                Ok((_, Err(e))) => drop(failed.get_or_insert(e)),
                Err(RecvTimeoutError::Timeout) => bar.iter().for_each(ProgressBar::tick),
                Err(RecvTimeoutError::Disconnected) => break,
            }
        }
    });
    if let Some(bar) = bar {
        bar.finish_and_clear();
    }
    failed.map_or(Ok(left), Err)
}

/// All cores, with a bar that counts what is done.
#[derive(Default)]
pub struct Threads(Mutex<Option<ProgressBar>>);

impl Threads {
    fn bar(&self) -> MutexGuard<'_, Option<ProgressBar>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl willis::work::Work for Threads {
    fn begin(&self, what: &'static str, of: u64) {
        if std::io::stderr().is_terminal() {
            *self.bar() = Some(bar(what, of));
        }
    }

    fn advance(&self, steps: u64) {
        if let Some(bar) = &*self.bar() {
            bar.inc(steps);
            if bar.is_hidden() && bar.elapsed() > PATIENCE {
                bar.set_draw_target(ProgressDrawTarget::stderr_with_hz(5));
            }
        }
    }

    fn run(&self, parts: usize, job: &(dyn Fn(usize) + Sync)) {
        let next = AtomicUsize::new(0);
        std::thread::scope(|scope| {
            for _ in 0..cores().min(parts) {
                scope.spawn(|| {
                    while let Some(part) = Some(next.fetch_add(1, Ordering::Relaxed)).filter(|k| *k < parts) {
                        job(part);
                    }
                });
            }
        });
        if let Some(bar) = self.bar().take() {
            bar.finish_and_clear();
        }
    }
}

fn bar(what: &'static str, of: u64) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(of), ProgressDrawTarget::hidden());
    let style = "{bar:40} {percent:>3} %  {human_pos} of {human_len} {msg}  {per_sec}  {eta} left";
    bar.set_message(what);
    bar.set_style(ProgressStyle::with_template(style).expect("a good template"));
    bar
}

/// Passes results on in the order of their numbers.
pub struct InOrder<T> {
    next: u64,
    waiting: BTreeMap<u64, T>,
}

impl<T> InOrder<T> {
    pub fn new(first: u64) -> Self {
        Self { next: first, waiting: BTreeMap::new() }
    }

    pub fn push(&mut self, number: u64, value: T, mut pass: impl FnMut(T)) {
        self.waiting.insert(number, value);
        while let Some(value) = self.waiting.remove(&self.next) {
            pass(value);
            self.next += 1;
        }
    }
}
