//! `willis simulate`: rows into a file or the answer, a figure, and the run for eyes.
//!
//! Rows are written as they come, into a file beside the target that takes its name at the end, also
//! after an interruption: a run that ended early is a whole file that says so. Only an error leaves
//! nothing behind.

mod csv;
mod parquet;
mod text;

use std::fs::File;
use std::io::IsTerminal;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use willis::dynamics::{Column, ColumnKind, Event, Options, Outcome, Recorder, RunReport, Sample};
use willis::train::Train;
use willis_figure::TimePlotBuilder;

use crate::interrupt::{interrupted, listen};

pub use text::text;

/// What to do with a run beside telling it.
pub struct Request {
    pub scenario: Option<String>,
    pub out: Option<PathBuf>,
    pub plot: Option<PathBuf>,
    pub columns: Vec<String>,
    pub options: Options,
    /// The answer is JSON: all events, and the rows unless a file takes them.
    pub json: bool,
}

impl Request {
    fn rows(&self) -> bool {
        self.json && self.out.is_none()
    }
}

/// A run and what was kept of it.
pub struct Run {
    pub report: RunReport,
}

impl Run {
    /// Whether Ctrl-C ended the run.
    pub fn interrupted(&self) -> bool {
        self.report.outcome == Outcome::Interrupted
    }
}

/// Why there is no run.
pub enum Failure {
    /// The train or its scenario are wrong.
    Input(willis::Diagnostics),
    /// Anything else, in words.
    Told(String),
}

impl From<String> for Failure {
    fn from(text: String) -> Self {
        Self::Told(text)
    }
}

/// Rows that are kept in memory for an answer.
const MOST_ROWS: usize = 1_000_000;

/// The unfinished file, for a second Ctrl-C.
static UNFINISHED: Mutex<Option<PathBuf>> = Mutex::new(None);

/// Leaves no unfinished file behind.
fn clear() {
    if let Ok(Some(path)) = UNFINISHED.lock().as_deref() {
        let _ = std::fs::remove_file(path);
    }
}

/// Runs a scenario with the engine.
pub fn run(train: &Train, request: &Request) -> Result<Run, Failure> {
    let target = request.out.as_deref().map(Target::of).transpose()?;
    if let Some(path) = &request.plot {
        // Said before the run rather than after it.
        let told = |why: &str| Err(Failure::Told(format!("{}: {why}\n", path.display())));
        if !path.extension().is_some_and(|e| e.eq_ignore_ascii_case("svg")) {
            return told("--plot writes SVG; end the name with .svg");
        }
        if path.is_dir() {
            return told("is a directory; name a file in it");
        }
        if path.parent().is_some_and(|p| !p.as_os_str().is_empty() && !p.is_dir()) {
            return told("its folder does not exist");
        }
    }
    let names: Vec<&str> = train.scenarios().iter().map(|s| s.name.as_str()).collect();
    let scenario = &train.scenarios()[choose(train.name(), &names, request.scenario.as_deref())?];
    let rows = request.options.samples.unwrap_or(scenario.samples);
    if request.rows() && rows > MOST_ROWS {
        let why =
            format!("{rows} rows are too many for one JSON document; stream them with --out run.csv or run.parquet\n");
        return Err(Failure::Told(why));
    }
    listen(clear);
    let engine = |recorder: &mut dyn Recorder| {
        willis::dynamics::simulate(train, &scenario.name, &request.options, recorder).map_err(Failure::Input)
    };
    record(train, [scenario.start, scenario.end], target, request, engine)
}

/// Position of the scenario of that name, or of the only one.
fn choose(train: &str, all: &[&str], name: Option<&str>) -> Result<usize, String> {
    let known = || all.iter().map(|n| format!("`{n}`")).collect::<Vec<_>>().join(", ");
    match (name, all) {
        (_, []) => Err(format!("`{train}` has no scenario to simulate; add a [[scenario]] to its file\n")),
        (None, [_]) => Ok(0),
        (None, _) => Err(format!("name one of the scenarios with --scenario: {}\n", known())),
        (Some(name), _) => all
            .iter()
            .position(|n| *n == name)
            .ok_or_else(|| format!("there is no scenario `{name}`; the scenarios are: {}\n", known())),
    }
}

/// A file for rows.
#[derive(Clone, Copy)]
struct Target<'a> {
    path: &'a Path,
    parquet: bool,
}

impl<'a> Target<'a> {
    fn of(path: &'a Path) -> Result<Self, String> {
        let ending = path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase);
        let told = |why: &str| Err(format!("{}: {why}\n", path.display()));
        match ending.as_deref() {
            _ if path.is_dir() => told("is a directory; name a file in it"),
            _ if path.exists() && !path.is_file() => told("is no ordinary file"),
            Some("csv") => Ok(Self { path, parquet: false }),
            Some("parquet") => Ok(Self { path, parquet: true }),
            _ => told("rows are written as .csv or .parquet; end the name with one of them"),
        }
    }
}

/// Runs what feeds a recorder, with everything that was asked for listening.
fn record(
    train: &Train,
    span: [f64; 2],
    target: Option<Target<'_>>,
    request: &Request,
    engine: impl FnOnce(&mut dyn Recorder) -> Result<RunReport, Failure>,
) -> Result<Run, Failure> {
    let unfinished = target.map(|t| Unfinished::create(t.path)).transpose()?;
    let sink = match (&unfinished, target) {
        (Some(u), Some(t)) => {
            let fail = |e: std::io::Error| format!("{}: {e}\n", t.path.display());
            let file = u.file.try_clone().map_err(fail)?;
            Some(if t.parquet {
                Sink::Parquet(Box::new(parquet::Rows::new(file)))
            } else {
                Sink::Csv(csv::Rows::new(file))
            })
        }
        _ => None,
    };
    let mut listener = Listener {
        wanted: &request.columns,
        kept: vec![],
        columns: vec![],
        row: vec![],
        sink,
        plot: request.plot.is_some().then(|| TimePlotBuilder::new(train, span)),
        with_rows: request.rows(),
        rows: vec![],
        all_events: request.json,
        events: vec![],
        progress: Progress::new(span),
        wrong: None,
    };
    let result = engine(&mut listener);
    listener.progress.finish();
    if let Some(wrong) = listener.wrong {
        return Err(Failure::Told(match &target {
            Some(t) if !wrong.starts_with("--") => format!("{}: {wrong}\n", t.path.display()),
            _ => wrong + "\n",
        }));
    }
    let mut report = result?;
    if let (Some(sink), Some(u), Some(t)) = (listener.sink, unfinished, target) {
        let early = (report.outcome != Outcome::Finished).then(|| early(&report, span[1]));
        let closed = match sink {
            Sink::Csv(rows) => rows.finish(early.as_deref()),
            Sink::Parquet(rows) => rows.finish(&report, early.as_deref()),
        };
        closed.map_err(|why| format!("{}: {why}\n", t.path.display()))?;
        u.complete()?;
    }
    if let (Some(path), Some(plot)) = (&request.plot, listener.plot) {
        crate::output::write(path, (willis_figure::draw_time(&plot.finish(&report)) + "\n").as_bytes())?;
    }
    report.events = listener.events;
    if request.rows() {
        (report.columns, report.rows) = (Some(listener.columns), Some(listener.rows));
    }
    Ok(Run { report })
}

/// What a file says of a run that did not reach its end.
fn early(r: &RunReport, end: f64) -> String {
    let word = if r.outcome == Outcome::Interrupted { "interrupted" } else { "ended" };
    let why = if r.outcome.why().is_empty() { String::new() } else { format!("; {}", r.outcome.why()) };
    format!("{word} at t = {} s of {end} s: the run {}{why}", r.end_s, r.outcome.words())
}

/// `willis-simulation-1`
pub fn json(run: &Run) -> String {
    serde_json::to_string_pretty(&run.report).expect("plain data") + "\n"
}

/// A file that has its name only when it is whole.
struct Unfinished {
    path: PathBuf,
    target: PathBuf,
    file: File,
    done: bool,
}

impl Unfinished {
    fn create(target: &Path) -> Result<Self, String> {
        let fail = |e: std::io::Error| format!("{}: {e}\n", target.display());
        // Beside the file itself, which a link stays a link to.
        let target = target.canonicalize().unwrap_or_else(|_| target.to_owned());
        let mut name = target.file_name().unwrap_or_default().to_owned();
        name.push(format!(".{}.part", std::process::id()));
        let path = target.with_file_name(name);
        let file = File::create(&path).map_err(fail)?;
        if let Ok(mut unfinished) = UNFINISHED.lock() {
            *unfinished = Some(path.clone());
        }
        Ok(Self { path, target, file, done: false })
    }

    fn complete(mut self) -> Result<(), String> {
        let fail = |e: std::io::Error| format!("{}: {e}\n", self.target.display());
        std::fs::rename(&self.path, &self.target).map_err(fail)?;
        self.done = true;
        Ok(())
    }
}

impl Drop for Unfinished {
    fn drop(&mut self) {
        if !self.done {
            let _ = std::fs::remove_file(&self.path);
        }
        if let Ok(mut unfinished) = UNFINISHED.lock() {
            *unfinished = None;
        }
    }
}

enum Sink {
    Csv(csv::Rows<File>),
    Parquet(Box<parquet::Rows<File>>),
}

/// Hands a run to everyone who wants it.
struct Listener<'a> {
    wanted: &'a [String],
    /// Positions of the columns that were asked for.
    kept: Vec<usize>,
    columns: Vec<Column>,
    row: Vec<f64>,
    sink: Option<Sink>,
    plot: Option<TimePlotBuilder>,
    with_rows: bool,
    rows: Vec<Vec<Option<f64>>>,
    all_events: bool,
    events: Vec<Event>,
    progress: Progress,
    wrong: Option<String>,
}

impl Listener<'_> {
    fn check(&mut self, result: Result<(), String>) -> ControlFlow<()> {
        match result {
            Ok(()) => ControlFlow::Continue(()),
            Err(why) => {
                self.wrong.get_or_insert(why);
                ControlFlow::Break(())
            }
        }
    }
}

impl Recorder for Listener<'_> {
    fn columns(&mut self, columns: &[Column]) -> ControlFlow<()> {
        match select(columns, self.wanted) {
            Ok(kept) => self.kept = kept,
            Err(why) => return self.check(Err(why)),
        }
        self.columns = self.kept.iter().map(|&k| columns[k].clone()).collect();
        if let Some(plot) = &mut self.plot {
            let _ = plot.columns(&self.columns);
        }
        let started = match &mut self.sink {
            Some(Sink::Csv(rows)) => rows.columns(&self.columns),
            Some(Sink::Parquet(rows)) => rows.columns(&self.columns),
            None => Ok(()),
        };
        self.check(started)
    }

    fn sample(&mut self, sample: Sample<'_>) -> ControlFlow<()> {
        self.row.clear();
        self.row.extend(self.kept.iter().map(|&k| sample.values[k]));
        if let Some(plot) = &mut self.plot {
            let _ = plot.sample(Sample { time_s: sample.time_s, values: &self.row });
        }
        if self.with_rows {
            self.rows.push(self.row.iter().map(|x| Some(*x).filter(|x| x.is_finite())).collect());
        }
        let written = match &mut self.sink {
            Some(Sink::Csv(rows)) => rows.row(&self.row),
            Some(Sink::Parquet(rows)) => rows.row(&self.row),
            None => Ok(()),
        };
        self.check(written)?;
        // One step may have many rows.
        self.progress(sample.time_s)
    }

    fn event(&mut self, event: &Event) -> ControlFlow<()> {
        if let Some(plot) = &mut self.plot {
            let _ = plot.event(event);
        }
        // The text shows the first of them only.
        if self.all_events || self.events.len() < text::MOST_EVENTS {
            self.events.push(event.clone());
        }
        ControlFlow::Continue(())
    }

    fn progress(&mut self, time: f64) -> ControlFlow<()> {
        self.progress.reached(time);
        if interrupted() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// Positions of the time and of the columns that were asked for, by kind or by name.
fn select(columns: &[Column], wanted: &[String]) -> Result<Vec<usize>, String> {
    if wanted.is_empty() {
        return Ok((0..columns.len()).collect());
    }
    let named = |c: &Column, w: &str| c.kind.name() == w || c.name == w;
    for w in wanted {
        if !columns.iter().any(|c| named(c, w)) {
            let mut kinds: Vec<&str> = Vec::new();
            for c in columns {
                if !kinds.contains(&c.kind.name()) {
                    kinds.push(c.kind.name());
                }
            }
            let example = columns.iter().find(|c| c.kind != ColumnKind::Time).map_or("time_s", |c| c.name.as_str());
            return Err(format!(
                "--columns {w}: this run has no such column; give kinds ({}) or names such as {example}",
                kinds.join(", ")
            ));
        }
    }
    let kept = |c: &Column| c.kind == ColumnKind::Time || wanted.iter().any(|w| named(c, w));
    Ok((0..columns.len()).filter(|&k| kept(&columns[k])).collect())
}

/// A bar on standard error, where that is a terminal and the run takes its time.
struct Progress {
    span: [f64; 2],
    since: Instant,
    bar: Option<ProgressBar>,
    shown: bool,
    calls: u32,
}

impl Progress {
    const STEPS: u64 = 1000;

    fn new(span: [f64; 2]) -> Self {
        let bar = std::io::stderr().is_terminal().then(|| {
            let bar = ProgressBar::with_draw_target(Some(Self::STEPS), ProgressDrawTarget::hidden());
            let style = ProgressStyle::with_template("{bar:40} {percent:>3} %  {msg}  {eta} left");
            bar.set_style(style.expect("a good template"));
            bar
        });
        Self { span, since: Instant::now(), bar, shown: false, calls: 0 }
    }

    fn reached(&mut self, time: f64) {
        let Some(bar) = &self.bar else { return };
        self.calls = self.calls.wrapping_add(1);
        if self.calls % 16 != 1 {
            return;
        }
        if !self.shown && self.since.elapsed() > Duration::from_millis(500) {
            self.shown = true;
            bar.set_draw_target(ProgressDrawTarget::stderr());
        }
        if self.shown {
            let [start, end] = self.span;
            let part = ((time - start) / (end - start)).clamp(0.0, 1.0);
            bar.set_message(format!("t = {time:.4} s of {end} s"));
            bar.set_position((part * Self::STEPS as f64) as u64);
        }
    }

    fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

#[cfg(test)]
mod tests;
