//! `willis sweep`: many points on all cores, to a table in a file piece by piece, or to a few numbers.

#[cfg(feature = "parquet")]
mod parquet;
mod merge;
mod parts;
mod piece;
mod table;

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use clap::{Arg, ArgMatches, Command, value_parser};
use willis::study::{Shard, Summary, SweepPlan, SweepReport as Report, SweepWorkspace};
use willis::work::{self, Work};
use willis_ask::questions::{Sweep, bytes_in_words, duration_in_words, points_in_words, sweep_text};
use willis_ask::{Entry, Given};

use crate::form::{CSV, JSON, JSON_LINES, PARQUET, TEXT};
use crate::run::{Asked, notes};
use crate::work::{Terminal, cores};
use crate::{Ended, output};
pub use merge::{merge_command, run_merge};
use parts::Parts;
use table::Form;

/// The options of a sweep that only a terminal has.
pub fn options(command: Command) -> Command {
    command
        .arg(
            Arg::new("shard").long("shard").value_name("K/N").value_parser(shard).help(
                "Only this part of the work: 3/16 is the third of sixteen; `willis merge` puts the parts together",
            ),
        )
        .arg(
            Arg::new("threads")
                .long("threads")
                .value_name("THREADS")
                .value_parser(value_parser!(u16).range(1..=1024))
                .help("Threads. Default: as many as there are cores"),
        )
}

/// `3/16`
fn shard(text: &str) -> Result<Shard, String> {
    let parts = text.split_once('/').and_then(|(k, n)| Some((k.parse().ok()?, n.parse().ok()?)));
    match parts {
        Some((_, n)) if n > 1_000_000 => Err("more than a million parts are not made".into()),
        Some((k, n)) => Shard::new(k, n).ok_or_else(|| format!("there is no part {k} of {n}; parts count from 1")),
        None => Err("write which of how many, as in 3/16".into()),
    }
}

/// Runs a sweep.
pub fn run(entry: &'static Entry, matches: &ArgMatches) -> Result<Ended, Ended> {
    let named = matches.get_one::<String>("format").map(String::as_str);
    let out = matches.get_one::<PathBuf>("output").map(PathBuf::as_path);
    let form = out.and_then(Form::of);
    // A small table for the screen, and an answer in another file, are made in memory as any.
    let is_table = named.is_some_and(|f| [CSV, JSON_LINES, PARQUET].contains(&f));
    let threads = matches.get_one::<u16>("threads").map_or_else(cores, |n| usize::from(*n));
    if form.is_none() && (is_table || out.is_some()) {
        if matches.contains_id("shard") {
            let endings = if cfg!(feature = "parquet") { ".csv, .jsonl or .parquet" } else { ".csv or .jsonl" };
            return Err(format!("a shard is a table in a file: name it with -o, ending in {endings}\n").into());
        }
        return crate::run::run_on(threads, entry, matches);
    }
    if let (Some(form), true, Some(named)) = (form, is_table, named)
        && form.name() != named
    {
        return Err(format!("the name of the file says {}, --format {named}\n", form.name()).into());
    }
    let request = entry.of_matches(matches).unwrap_or_else(|e| e.exit());
    let request = request.as_any().downcast_ref::<Sweep>().expect("the question of this command");
    let request = Sweep { summary_only: out.is_none(), ..request.clone() };
    let asked = Asked::screen(entry, matches, if named == Some(JSON) { JSON } else { TEXT });
    if let Some(out) = out {
        let file = matches.get_one::<String>("file").map_or("-", String::as_str);
        output::apart(out, &[file.as_ref()])?;
    }
    let of = asked.trains()?;
    let plan = SweepPlan::new(&of[0].model, &request.request())
        .and_then(|plan| plan.check().map(|()| plan))
        .map_err(|wrong| asked.refused(&wrong.into(), &of))?;
    let shard = matches.get_one::<Shard>("shard").copied();
    let report = compute(&plan, out.zip(form), shard, threads, asked.force, matches.get_flag("yes"))?;
    Ok(Ended::Answered(told(&asked, &report, &of)))
}

/// A report for the screen.
fn told(asked: &Asked<'_>, report: &Report, of: &[Given]) -> String {
    match asked.form {
        JSON => willis_ask::json(report),
        _ => sweep_text(report) + &notes(of[0].model.warnings(), of),
    }
}

/// What is done without asking: seconds and bytes.
const UNASKED: (f64, f64) = (3600.0, 20e9);

/// Computes a sweep, or a shard of it, into a table or to a few numbers.
fn compute(
    plan: &SweepPlan<'_>,
    out: Option<(&Path, Form)>,
    shard: Option<Shard>,
    threads: usize,
    force: bool,
    yes: bool,
) -> Result<Report, Ended> {
    let pieces = shard.map_or(0..plan.pieces(), |shard| shard.pieces(plan.pieces()));
    let size = |k: u64| plan.points(k).end - plan.points(k).start;
    let rows: u64 = pieces.clone().map(size).sum();
    let terminal = Terminal::new(threads, yes);
    if !yes {
        ask(plan, out.map(|o| o.1), rows, threads, &terminal)?;
    }
    let rooms = Mutex::new(Vec::new());
    // Each thread has a workspace of its own while it works.
    let with_room = |job: &mut dyn FnMut(&mut SweepWorkspace)| {
        let mut room = rooms.lock().ok().and_then(|mut all| all.pop()).unwrap_or_default();
        job(&mut room);
        if let Ok(mut all) = rooms.lock() {
            all.push(room);
        }
    };
    let count = pieces.end - pieces.start;
    let Some((out, form)) = out else {
        terminal.begin("points", rows);
        let parts = work::map(&terminal, count as usize, |k| {
            let points = plan.points(pieces.start + k as u64);
            let mut part = Err(work::Cancelled);
            with_room(&mut |room| part = plan.summary(points.clone(), room, &terminal));
            terminal.advance(points.end - points.start);
            part
        });
        let parts: Result<Vec<Summary>, _> = parts.and_then(|all| all.into_iter().collect());
        let Ok(parts) = parts else {
            let told = "interrupted: there is no answer (-o keeps finished pieces)\n";
            return Err(Ended::Interrupted { out: String::new(), told: told.into() });
        };
        let mut summary = Summary::default();
        parts.iter().for_each(|part| summary.join(part));
        return Ok(plan.report(shard, summary));
    };
    let parts = Parts::open(out, form, plan.study(), shard, force)?;
    if let Some(report) = parts.whole()? {
        return Ok(report);
    }
    let todo: Vec<u64> = pieces.clone().filter(|k| !parts.has(*k)).collect();
    if (todo.len() as u64) < count {
        eprintln!("going on: {} of {count} pieces are there already", count - todo.len() as u64);
    }
    let (failed, kept) = (Mutex::new(None), AtomicU64::new(0));
    terminal.begin("points", todo.iter().map(|k| size(*k)).sum());
    terminal.run(todo.len(), &|at| {
        let k = todo[at];
        if failed.lock().is_ok_and(|f| f.is_some()) {
            return;
        }
        with_room(&mut |room| {
            let Ok(rows) = plan.rows(plan.points(k), room, &terminal) else { return };
            let bytes = form.encode(&plan.study().columns, &rows);
            match bytes.and_then(|bytes| parts.keep(k, &bytes, &rows.summary)) {
                Ok(()) => drop(kept.fetch_add(1, Ordering::Relaxed)),
                Err(why) => {
                    if let Ok(mut failed) = failed.lock() {
                        failed.get_or_insert(why);
                    }
                }
            }
        });
        terminal.advance(size(k));
    });
    terminal.finish();
    if let Ok(Some(why)) = failed.into_inner() {
        return Err(format!("{why}{}", parts.advice()).into());
    }
    let left = todo.len() as u64 - kept.into_inner();
    if left > 0 {
        let kept = format!("{} of {count} pieces are kept in {}", count - left, parts.path().display());
        let told = format!("interrupted: {kept}; the same command goes on from there\n");
        return Err(Ended::Interrupted { out: String::new(), told });
    }
    let mut report = plan.report(shard, parts.summary(pieces.clone())?);
    parts.finish(pieces, &mut report)?;
    Ok(report)
}

/// Asks for `--yes` where a sweep is very long or very large.
fn ask(plan: &SweepPlan<'_>, form: Option<Form>, rows: u64, threads: usize, terminal: &Terminal) -> Result<(), Ended> {
    let (mut room, mut tried, mut bytes) = (SweepWorkspace::default(), 0, 0);
    let (started, mut spent) = (Instant::now(), Duration::ZERO);
    for (k, points) in plan.trials(rows, form.is_some()).enumerate() {
        let (before, count) = (Instant::now(), points.end - points.start);
        let Ok(found) = plan.rows(points, &mut room, terminal) else { break };
        // The first call pays for what is made once.
        if k > 0 {
            spent += before.elapsed();
            tried += count;
            bytes += form.map_or(0, |f| f.encode(&plan.study().columns, &found).map_or(0, |b| b.len()) as u64);
        }
        if started.elapsed() > Duration::from_millis(300) {
            break;
        }
    }
    let tried = tried.max(1) as f64;
    let seconds = spent.as_secs_f64() / tried * rows as f64 / threads as f64;
    // A table of few rows is mostly its footer.
    let is_parquet = form.is_some_and(|f| f.name() == PARQUET);
    let each = if is_parquet { plan.columns().len() as f64 * 6.0 } else { bytes as f64 / tried };
    let size = form.map_or(0.0, |_| each * rows as f64);
    if seconds <= UNASKED.0 && size <= UNASKED.1 {
        return Ok(());
    }
    let mut what =
        format!("{} would take about {} on {threads} threads", points_in_words(rows), duration_in_words(seconds));
    if size > 0.0 {
        what += &format!(" and about {} of disk", bytes_in_words(size));
    }
    let mut hint = "add --yes to go, --shard 1/16 to share it among machines, or take fewer values".to_owned();
    if plan.could_be_compiled() {
        hint += "; --fast is some thousand times faster here, to a part in 10^12";
    }
    Err(format!("{what}; {hint}\n").into())
}
