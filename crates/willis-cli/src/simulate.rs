//! `willis simulate -o rows.csv`: rows into a file as they come, for runs of any length.
//!
//! They go into a file beside the target that takes its name at the end, also after an interruption: a run that ended
//! early is a whole file that says so. Only an error leaves nothing behind.

mod csv;
#[cfg(feature = "parquet")]
mod parquet;
mod plot;

use std::fs::File;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use clap::ArgMatches;
use willis::dynamics::{Column, Event, Outcome, Recorder, RunReport, Sample};
use willis::work::Work;
use willis_ask::questions::{MOST_EVENTS, MOST_KEPT, Simulate, simulation_text, tell_of_events_left_out};
use willis_ask::{Entry, Refusal};

use crate::Ended;
use crate::form::{JSON, TEXT};
use crate::interrupt::interrupted;
use crate::output::{self, Unfinished};
use crate::run::Asked;
use crate::work::Terminal;
use plot::Plot;

/// Whether rows go into this file as they come.
pub fn streams(out: &Path) -> bool {
    Target::of(out).is_some()
}

/// A form of rows.
#[derive(Clone, Copy, PartialEq)]
enum Target {
    Csv,
    #[cfg(feature = "parquet")]
    Parquet,
}

impl Target {
    fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "csv" => Some(Self::Csv),
            #[cfg(feature = "parquet")]
            "parquet" => Some(Self::Parquet),
            _ => None,
        }
    }
}

/// Runs a scenario with its rows going into a file.
pub fn run(entry: &'static Entry, matches: &ArgMatches, out: &Path) -> Result<Ended, Ended> {
    let request = entry.of_matches(matches).unwrap_or_else(|e| e.exit());
    let request = request.as_any().downcast_ref::<Simulate>().expect("the question of this command");
    // What is told on the screen; the rows have a file.
    let form = match matches.get_one::<String>("format").map(String::as_str) {
        Some(JSON) => JSON,
        _ => TEXT,
    };
    let asked = Asked::screen(entry, matches, form);
    let file = matches.get_one::<String>("file").map_or("-", String::as_str);
    asked.guard(out, &[file])?;
    let plot = matches.try_get_one::<PathBuf>("plot").ok().flatten();
    if let (Some(path), Some(extra)) = (plot, entry.extras.first()) {
        asked.guard_extra(extra, path, &[file])?;
    }
    let terminal = Terminal::new(1, matches.get_flag("yes"));
    let of = asked.trains()?;
    let train = of[0].model.train();
    let (scenario, options) = request
        .scenario(train)
        .and_then(|s| Ok((s, request.options(&terminal)?)))
        .map_err(|refusal| asked.refused(&refusal, &of))?;
    let span = [scenario.start, options.to_s.unwrap_or(scenario.end)];
    // From here on Ctrl-C ends the run and not the program.
    interrupted();
    let unfinished = Unfinished::new(out, asked.force)?;
    let handle = unfinished.file().try_clone().map_err(output::told(out))?;
    let sink = match Target::of(out).expect("it streams") {
        Target::Csv => Sink::Csv(csv::Rows::new(handle)),
        #[cfg(feature = "parquet")]
        Target::Parquet => Sink::Parquet(Box::new(parquet::Rows::new(handle))),
    };
    terminal.begin("thousandths of the scenario", STEPS);
    let mut listener = Listener {
        request,
        terminal: &terminal,
        span,
        told: 0,
        kept: vec![],
        row: vec![],
        sink,
        plot: plot.and_then(|_| Plot::new(train, [options.from_s.unwrap_or(span[0]), span[1]])),
        most_events: if form == JSON { MOST_KEPT } else { MOST_EVENTS },
        events: vec![],
        wrong: None,
    };
    let result = willis::dynamics::simulate(train, &scenario.name, &options, &mut listener);
    terminal.finish();
    match listener.wrong {
        Some(Wrong::File(why)) => {
            drop(listener.sink);
            return Err(kept(unfinished, out, &why, span[1]).into());
        }
        Some(Wrong::Request(refusal)) => return Err(asked.refused(&refusal, &of)),
        None => {}
    }
    let mut report = result.map_err(|wrong| asked.refused(&wrong.into(), &of))?;
    report.events = listener.events;
    if form == JSON {
        tell_of_events_left_out(&mut report);
    }
    let early = (report.outcome != Outcome::Finished).then(|| early(&report, span[1]));
    let closed = match listener.sink {
        Sink::Csv(rows) => rows.finish(early.as_deref()),
        #[cfg(feature = "parquet")]
        Sink::Parquet(rows) => rows.finish(&report, early.as_deref()),
    };
    closed.map_err(|why| format!("{}: {why}\n", out.display()))?;
    unfinished.complete()?;
    if let (Some(path), Some(plot)) = (plot, listener.plot) {
        output::write(path, plot.svg(&report).as_bytes(), asked.force)?;
    }
    let told = match form {
        JSON => willis_ask::json(&report),
        _ => simulation_text(&report),
    };
    Ok(if report.outcome == Outcome::Interrupted {
        Ended::Interrupted { out: told, told: String::new() }
    } else {
        Ended::Answered(told)
    })
}

/// Keeps the rows that were written before a disk was full, where the form of the file allows it; what is told.
fn kept(unfinished: Unfinished, out: &Path, why: &str, end: f64) -> String {
    let told = format!("{}: {why}", out.display());
    if Target::of(out) != Some(Target::Csv) {
        return told + "\n";
    }
    let words = |time: &str| format!("ended at t = {time} s of {end} s: the rows could not be written; {why}");
    let time = csv::salvage(unfinished.file(), words).ok().flatten();
    match time.filter(|_| unfinished.complete().is_ok()) {
        Some(time) => format!("{told}; it has the rows up to t = {time} s\n"),
        None => told + "\n",
    }
}

/// What a file says of a run that did not reach its end.
fn early(r: &RunReport, end: f64) -> String {
    let word = if r.outcome == Outcome::Interrupted { "interrupted" } else { "ended" };
    let why = if r.outcome.why().is_empty() { String::new() } else { format!("; {}", r.outcome.why()) };
    format!("{word} at t = {} s of {end} s: the run {}{why}", r.end_s, r.outcome.words())
}

enum Sink {
    Csv(csv::Rows<File>),
    #[cfg(feature = "parquet")]
    Parquet(Box<parquet::Rows<File>>),
}

/// Why a run was ended from here.
enum Wrong {
    File(String),
    Request(Refusal),
}

/// Steps of the bar.
const STEPS: u64 = 1000;

/// Hands a run to everyone who wants it.
struct Listener<'a> {
    request: &'a Simulate,
    terminal: &'a Terminal,
    span: [f64; 2],
    told: u64,
    /// Positions of the columns that were asked for.
    kept: Vec<usize>,
    row: Vec<f64>,
    sink: Sink,
    plot: Option<Plot>,
    /// The text shows the first of them only.
    most_events: usize,
    events: Vec<Event>,
    wrong: Option<Wrong>,
}

impl Listener<'_> {
    fn check(&mut self, result: Result<(), String>) -> ControlFlow<()> {
        match result {
            Ok(()) => ControlFlow::Continue(()),
            Err(why) => {
                self.wrong.get_or_insert(Wrong::File(why));
                ControlFlow::Break(())
            }
        }
    }
}

impl Recorder for Listener<'_> {
    fn columns(&mut self, columns: &[Column]) -> ControlFlow<()> {
        match self.request.select(columns) {
            Ok(kept) => self.kept = kept,
            Err(refusal) => {
                self.wrong = Some(Wrong::Request(refusal));
                return ControlFlow::Break(());
            }
        }
        let columns: Vec<Column> = self.kept.iter().map(|&k| columns[k].clone()).collect();
        if let Some(plot) = &mut self.plot {
            let _ = plot.listener().columns(&columns);
        }
        let started = match &mut self.sink {
            Sink::Csv(rows) => rows.columns(&columns),
            #[cfg(feature = "parquet")]
            Sink::Parquet(rows) => rows.columns(&columns),
        };
        self.check(started)
    }

    fn sample(&mut self, sample: Sample<'_>) -> ControlFlow<()> {
        self.row.clear();
        self.row.extend(self.kept.iter().map(|&k| sample.values[k]));
        if let Some(plot) = &mut self.plot {
            let _ = plot.listener().sample(Sample { time_s: sample.time_s, values: &self.row });
        }
        let written = match &mut self.sink {
            Sink::Csv(rows) => rows.row(&self.row),
            #[cfg(feature = "parquet")]
            Sink::Parquet(rows) => rows.row(&self.row),
        };
        self.check(written)?;
        // One step may have many rows.
        self.progress(sample.time_s)
    }

    fn event(&mut self, event: &Event) -> ControlFlow<()> {
        if let Some(plot) = &mut self.plot {
            let _ = plot.listener().event(event);
        }
        if self.events.len() < self.most_events {
            self.events.push(event.clone());
        }
        ControlFlow::Continue(())
    }

    fn progress(&mut self, time_s: f64) -> ControlFlow<()> {
        let [start, end] = self.span;
        let now = ((time_s - start) / (end - start) * STEPS as f64).clamp(0.0, STEPS as f64) as u64;
        if now > self.told {
            self.terminal.advance(now - self.told);
            self.told = now;
        }
        if interrupted() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

#[cfg(test)]
mod tests;
