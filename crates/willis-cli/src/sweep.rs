//! `willis sweep`: many points on all cores, to a table in a file piece by piece, or to a few numbers.

#[cfg(feature = "parquet")]
mod parquet;
mod table;

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use willis::study::{Shard, Summary, SweepPlan, SweepReport as Report, SweepStudy as Study, SweepWorkspace};
use willis::work::{self, Work};
use willis_ask::questions::{Sweep, bytes_in_words, duration_in_words, points_in_words, sweep_text};
use willis_ask::{Entry, Given};

use crate::form::{CSV, JSON, JSON_LINES, PARQUET, TEXT};
use crate::run::{Asked, notes};
use crate::work::{Terminal, cores};
use crate::{Ended, output};
use table::Form;

/// The options of a sweep that only a terminal has.
pub fn options(command: Command) -> Command {
    command
        .arg(
            Arg::new("yes")
                .long("yes")
                .action(ArgAction::SetTrue)
                .help("Go, however long it takes and however large it gets"),
        )
        .arg(
            Arg::new("shard")
                .long("shard")
                .value_name("K/N")
                .value_parser(shard)
                .help("Only this part of the sweep, 3/16; `willis merge` puts the parts together"),
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
        JSON => serde_json::to_string_pretty(report).expect("plain data") + "\n",
        _ => sweep_text(report) + &notes(of[0].model.warnings(), of),
    }
}

/// What is kept beside a piece.
#[derive(Serialize, Deserialize)]
struct Piece {
    sha256: String,
    summary: Summary,
}

/// What is done without asking: seconds and bytes.
const UNASKED: (f64, f64) = (3600.0, 20e9);

/// Of a file.
fn sha256_of(path: &Path) -> std::io::Result<String> {
    let (mut hash, mut file) = (Sha256::new(), File::open(path)?);
    let mut buffer = vec![0; 1 << 20];
    loop {
        match std::io::Read::read(&mut file, &mut buffer)? {
            0 => return Ok(hex(&hash.finalize())),
            n => hash.update(&buffer[..n]),
        }
    }
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|b| format!("{b:02x}")).collect()
}

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
    let terminal = Terminal::new(threads);
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
            let told = "interrupted: nothing was written (-o keeps finished pieces)\n";
            return Err(Ended::Interrupted(told.into()));
        };
        let mut summary = Summary::default();
        parts.iter().for_each(|part| summary.join(part));
        return Ok(plan.report(shard, summary));
    };
    let folder = Folder::open(out, form, plan.study(), shard, force)?;
    let todo: Vec<u64> = pieces.clone().filter(|k| !folder.has(*k)).collect();
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
            match bytes.and_then(|bytes| folder.keep(k, &bytes, &rows.summary)) {
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
        return Err(format!("{why}{}", folder.advice()).into());
    }
    let left = todo.len() as u64 - kept.into_inner();
    if left > 0 {
        let told = "the same command goes on from there";
        let kept = format!("{} of {count} pieces are kept in {}", count - left, folder.path.display());
        return Err(Ended::Interrupted(format!("interrupted: {kept}; {told}\n")));
    }
    let mut report = plan.report(shard, folder.summary(pieces.clone())?);
    folder.finish(pieces, &mut report)?;
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

/// The folder beside the table in which finished pieces are kept.
struct Folder {
    path: PathBuf,
    out: PathBuf,
    form: Form,
    /// Held as long as this run works here.
    _lock: File,
}

fn io(path: &Path) -> impl Fn(std::io::Error) -> String {
    move |e| format!("{}: {e}\n", path.display())
}

/// Writes a file whole, or not at all.
fn whole(path: &Path, bytes: &[u8]) -> Result<(), String> {
    let beside = with_end(path, ".new");
    let write = || -> std::io::Result<()> {
        let mut file = File::create(&beside)?;
        std::io::Write::write_all(&mut file, bytes)?;
        file.sync_all()?;
        fs::rename(&beside, path)
    };
    write().map_err(|e| {
        let _ = fs::remove_file(&beside);
        io(path)(e)
    })
}

fn with_end(path: &Path, end: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(end);
    PathBuf::from(name)
}

fn sidecar(out: &Path) -> PathBuf {
    with_end(out, ".json")
}

impl Folder {
    /// Takes up what an interrupted run left, or begins.
    fn open(out: &Path, form: Form, study: &Study, shard: Option<Shard>, force: bool) -> Result<Self, String> {
        let name = out.display();
        if out.is_dir() {
            return Err(format!("{name}: is a directory; name a file in it\n"));
        }
        if out.parent().is_some_and(|p| !p.as_os_str().is_empty() && !p.is_dir()) {
            return Err(format!("{name}: its folder does not exist\n"));
        }
        let path = with_end(out, ".parts");
        let told = serde_json::to_string_pretty(&(study, shard)).expect("plain data");
        let begun = path.join("study.json");
        // Beside the folder: that may go and come again.
        let beside = with_end(out, ".lock");
        let lock = File::create(&beside).map_err(io(&beside))?;
        if lock.try_lock().is_err() {
            return Err(format!("{name}: another willis is writing it; wait for that, or give another name\n"));
        }
        let own = Self { path, out: out.to_owned(), form, _lock: lock };
        match fs::read_to_string(&begun) {
            Ok(text) if text == told => return Ok(own),
            Ok(_) if !force => {
                return Err(format!(
                    "{}: pieces of another sweep; finish that one with its own command, or add --force to drop them\n",
                    own.path.display()
                ));
            }
            _ => {}
        }
        if out.exists() && !force {
            return Err(format!("{name}: exists already; add --force to replace it\n"));
        }
        if own.path.exists() {
            fs::remove_dir_all(&own.path).map_err(io(&own.path))?;
        }
        fs::create_dir(&own.path).map_err(io(&own.path))?;
        whole(&begun, told.as_bytes())?;
        Ok(own)
    }

    fn piece(&self, k: u64) -> PathBuf {
        self.path.join(format!("{k:09}.{}", self.form.name()))
    }

    /// A piece counts when what is said of it was written, after it, and is true.
    fn has(&self, k: u64) -> bool {
        let piece = self.piece(k);
        self.told(k).is_ok_and(|told| sha256_of(&piece).is_ok_and(|own| own == told.sha256))
    }

    fn told(&self, k: u64) -> Result<Piece, String> {
        let path = self.piece(k).with_extension("json");
        let text = fs::read(&path).map_err(io(&path))?;
        serde_json::from_slice(&text).map_err(|e| format!("{}: {e}\n", path.display()))
    }

    fn keep(&self, k: u64, bytes: &[u8], summary: &Summary) -> Result<(), String> {
        let piece = self.piece(k);
        whole(&piece, bytes)?;
        let told = Piece { sha256: hex(&Sha256::digest(bytes)), summary: summary.clone() };
        let told = serde_json::to_vec(&told).expect("plain data");
        whole(&piece.with_extension("json"), &told)
    }

    fn advice(&self) -> String {
        format!(
            "finished pieces are kept in {}; with the cause removed the same command goes on from there\n",
            self.path.display()
        )
    }

    fn summary(&self, pieces: std::ops::Range<u64>) -> Result<Summary, String> {
        let mut all = Summary::default();
        for k in pieces {
            all.join(&self.told(k)?.summary);
        }
        Ok(all)
    }

    /// The table and what is said of it; then the pieces go.
    fn finish(&self, pieces: std::ops::Range<u64>, report: &mut Report) -> Result<(), String> {
        let pieces: Vec<PathBuf> = pieces.map(|k| self.piece(k)).collect();
        write_table(&self.out, self.form, &pieces, report).map_err(|e| format!("{e}{}", self.advice()))?;
        fs::remove_dir_all(&self.path).map_err(io(&self.path))
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_file(with_end(&self.out, ".lock"));
    }
}

fn write_table(out: &Path, form: Form, pieces: &[PathBuf], report: &mut Report) -> Result<(), String> {
    let beside = with_end(out, ".new");
    let told = serde_json::to_string(&report.study).expect("plain data");
    let table = File::create(&beside).map_err(io(&beside)).and_then(|f| {
        form.join(&report.study.columns, &told, pieces, f).map_err(|e| format!("{}: {e}\n", out.display()))
    });
    if let Err(e) = table {
        let _ = fs::remove_file(&beside);
        return Err(e);
    }
    report.table_sha256 = Some(sha256_of(&beside).map_err(io(&beside))?);
    let told = serde_json::to_string_pretty(report).expect("plain data") + "\n";
    whole(&sidecar(out), told.as_bytes())?;
    fs::rename(&beside, out).map_err(io(out))
}

/// Puts the shards of a sweep together.
pub fn merge(out: &Path, shards: &[PathBuf], force: bool) -> Result<Report, String> {
    let Some(form) = Form::of(out) else {
        return Err(format!("{}: end the name with .csv, .jsonl or .parquet\n", out.display()));
    };
    if out.exists() && !force {
        return Err(format!("{}: exists already; add --force to replace it\n", out.display()));
    }
    let mut wrong = String::new();
    let mut all: Vec<(u64, u64, PathBuf, Report)> = vec![];
    for shard in shards {
        let path = sidecar(shard);
        let read = fs::read_to_string(&path).map_err(|e| e.to_string());
        let report = read.and_then(|text| serde_json::from_str::<Report>(&text).map_err(|e| e.to_string()));
        let report = match report {
            Ok(report) => report,
            Err(e) => {
                wrong += &format!("{}: what belongs beside every shard cannot be read: {e}\n", path.display());
                continue;
            }
        };
        if Form::of(shard) != Some(form) || !shard.exists() {
            wrong += &format!("{}: is no table written as {}\n", shard.display(), form.name());
            continue;
        }
        if sha256_of(shard).ok() != report.table_sha256 {
            let what = "is not the table that was written (cut, changed, or of another shard)";
            wrong += &format!("{}: {what}; make that shard again\n", shard.display());
            continue;
        }
        match report.shard {
            Some(own) => all.push((own.number, own.of, shard.clone(), report)),
            None => wrong += &format!("{}: is a whole sweep, no shard\n", shard.display()),
        }
    }
    all.sort_by_key(|a| a.0);
    if let Some((_, n, path, first)) = all.first() {
        for (k, other, shard, report) in &all[1..] {
            if report.study != first.study {
                let what =
                    if report.study.sha256 == first.study.sha256 { "was cut otherwise" } else { "is of another sweep" };
                wrong += &format!("{}: {what} than {}\n", shard.display(), path.display());
            } else if other != n {
                wrong += &format!("{}: is shard {k} of {other}, {} one of {n}\n", shard.display(), path.display());
            }
        }
        if wrong.is_empty() {
            let twice: Vec<String> = all.windows(2).filter(|w| w[0].0 == w[1].0).map(|w| w[0].0.to_string()).collect();
            let missing: Vec<String> =
                (1..=*n).filter(|k| !all.iter().any(|a| a.0 == *k)).map(|k| k.to_string()).collect();
            if !twice.is_empty() {
                wrong += &format!("given twice: shard {}\n", twice.join(", "));
            }
            if !missing.is_empty() {
                wrong += &format!("missing: shard {} of {n}\n", missing.join(", "));
            }
        }
    }
    if !wrong.is_empty() {
        return Err(format!("{wrong}these shards do not make a sweep\n"));
    }
    let reports: Vec<Report> = all.iter().map(|a| a.3.clone()).collect();
    let Some(mut report) = Report::merged(&reports) else { return Err("no shards to merge\n".into()) };
    if report.rows != report.study.points {
        return Err(format!("the shards have {} rows, the sweep {} points\n", report.rows, report.study.points));
    }
    let bodies = Bodies::of(form, &all)?;
    write_table(out, form, &bodies.0, &mut report)?;
    Ok(report)
}

/// The shards as pieces: of texts, without their header.
struct Bodies(Vec<PathBuf>, bool);

impl Bodies {
    fn of(form: Form, shards: &[(u64, u64, PathBuf, Report)]) -> Result<Self, String> {
        if form != Form::Csv {
            return Ok(Self(shards.iter().map(|s| s.2.clone()).collect(), false));
        }
        let mut all = Self(vec![], true);
        for (_, _, path, _) in shards {
            let body = with_end(path, ".body");
            let copy = || -> std::io::Result<()> {
                let mut from = std::io::BufReader::new(File::open(path)?);
                let mut header = vec![];
                // Names of columns have no line breaks.
                std::io::BufRead::read_until(&mut from, b'\n', &mut header)?;
                std::io::copy(&mut from, &mut File::create(&body)?)?;
                Ok(())
            };
            copy().map_err(io(&body))?;
            all.0.push(body);
        }
        Ok(all)
    }
}

impl Drop for Bodies {
    fn drop(&mut self) {
        if self.1 {
            self.0.iter().for_each(|p| drop(fs::remove_file(p)));
        }
    }
}

/// The command that puts shards together.
pub fn merge_command() -> Command {
    let path = |name: &'static str, value: &'static str| {
        Arg::new(name).value_name(value).required(true).value_parser(value_parser!(PathBuf))
    };
    let output = path("output", "FILE").short('o').long("output").visible_alias("out");
    Command::new("merge")
        .about("Put the shards of a sweep together, after checking that they belong together")
        .arg(output.help("The table to write"))
        .arg(
            path("shards", "SHARDS")
                .num_args(1..)
                .help("The shards, in any order; what was written beside them must be there too"),
        )
        .arg(Arg::new("force").long("force").action(ArgAction::SetTrue).help("Replace files that are there already"))
}

/// Puts shards together.
pub fn run_merge(matches: &ArgMatches) -> Result<Ended, Ended> {
    let out = matches.get_one::<PathBuf>("output").expect("it is required");
    let shards: Vec<PathBuf> = matches.get_many("shards").into_iter().flatten().cloned().collect();
    let read: Vec<&Path> = shards.iter().map(PathBuf::as_path).collect();
    output::apart(out, &read)?;
    let report = merge(out, &shards, matches.get_flag("force"))?;
    Ok(Ended::Answered(sweep_text(&report)))
}
