//! Sweeps: many points on all cores, to a table or to a few numbers.

mod table;
mod text;

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use willis::diagnostic::Diagnostics;
use willis::model::Model;
use willis::study::{
    Hold, Shard, Summary, SweepMethod, SweepPlan, SweepReport as Report, SweepRequest, SweepStudy as Study,
    SweepWorkspace,
};
use willis::work::Work;

use crate::{interrupt, work};
use table::Form;

pub use table::table_csv as csv;
pub use text::text;

/// What is asked.
pub struct Request {
    /// Of the train file; then the axes and what follows up to the columns are its.
    pub study: Option<String>,
    pub over: Vec<String>,
    pub operation: Option<String>,
    pub state: Option<String>,
    pub hold: Hold,
    pub columns: Vec<String>,
    pub out: Option<PathBuf>,
    pub force: bool,
    pub yes: bool,
    /// Which of how many, from 1.
    pub shard: Option<(u64, u64)>,
    pub threads: Option<usize>,
    pub fast: bool,
}

/// Why there is no answer.
pub enum Failure {
    /// The question is wrong.
    Input(Diagnostics),
    /// Anything else, in words.
    Told(String),
    /// Ctrl-C, with what is left.
    Interrupted(String),
}

impl From<String> for Failure {
    fn from(text: String) -> Self {
        Self::Told(text)
    }
}

impl From<Diagnostics> for Failure {
    fn from(wrong: Diagnostics) -> Self {
        Self::Input(wrong)
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

/// Work that Ctrl-C stops.
struct UntilInterrupted;

impl Work for UntilInterrupted {
    fn cancelled(&self) -> bool {
        interrupt::interrupted()
    }
}

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

/// Runs a sweep.
pub fn run(model: &Model, request: &Request) -> Result<Report, Failure> {
    let plan = SweepPlan::new(
        model,
        &SweepRequest {
            study: request.study.clone(),
            over: request.over.clone(),
            operation: request.operation.clone(),
            state: request.state.clone(),
            hold: request.hold,
            columns: request.columns.clone(),
            method: if request.fast { SweepMethod::Compiled } else { SweepMethod::Analyze },
            summary_only: request.out.is_none(),
        },
    )?;
    let form = request.out.as_deref().map(Form::of).transpose()?;
    let shard = request.shard.and_then(|(k, n)| Shard::new(k, n));
    let pieces = shard.map_or(0..plan.pieces(), |shard| shard.pieces(plan.pieces()));
    let (first, last) = (pieces.start, pieces.end);
    let rows = (first..last).map(|k| plan.points(k)).map(|p| p.end - p.start).sum();
    let study = plan.study();
    let threads = request.threads.unwrap_or_else(work::cores);

    plan.check()?;
    if !request.yes {
        ask(&plan, form, rows, threads)?;
    }
    interrupt::listen(|| {});
    let size = |k: u64| plan.points(k).end - plan.points(k).start;
    let summary = match (&request.out, form) {
        (Some(out), Some(form)) => {
            let folder = Folder::open(out, form, study, shard, request.force)?;
            let todo: Vec<u64> = (first..last).filter(|k| !folder.has(*k)).collect();
            let kept = (last - first) - todo.len() as u64;
            if kept > 0 {
                eprintln!("going on: {kept} of {} pieces are there already", last - first);
            }
            let done: u64 = rows - todo.iter().map(|k| size(*k)).sum::<u64>();
            let make = |k: u64, room: &mut SweepWorkspace| -> Result<Option<()>, String> {
                let Ok(rows) = plan.rows(plan.points(k), room, &UntilInterrupted) else { return Ok(None) };
                let bytes = form.encode(&study.columns, &rows)?;
                folder.keep(k, &bytes, &rows.summary).map(Some)
            };
            let left = work::run(&todo, threads, (done, rows, "points"), size, make, |_, ()| {});
            let left = left.map_err(|e| format!("{e}{}", folder.advice()))?;
            if left > 0 {
                return Err(Failure::Interrupted(format!(
                    "interrupted: {} of {} pieces are kept in {}; the same command goes on from there\n",
                    (last - first) - left,
                    last - first,
                    folder.path.display()
                )));
            }
            let summary = folder.summary(first..last)?;
            let mut report = plan.report(shard, summary);
            folder.finish(first..last, &mut report)?;
            return Ok(report);
        }
        _ => {
            let all: Vec<u64> = (first..last).collect();
            let mut ordered = work::InOrder::new(first);
            let mut summary = Summary::default();
            let make =
                |k: u64, room: &mut SweepWorkspace| Ok(plan.summary(plan.points(k), room, &UntilInterrupted).ok());
            let left = work::run(&all, threads, (0, rows, "points"), size, make, |k, s: Summary| {
                ordered.push(k, s, |s| summary.join(&s));
            })?;
            if left > 0 {
                return Err(Failure::Interrupted(
                    "interrupted: nothing was written (give --out to keep pieces)\n".into(),
                ));
            }
            summary
        }
    };
    Ok(plan.report(shard, summary))
}

/// Asks for `--yes` where a sweep is very long or very large.
fn ask(plan: &SweepPlan<'_>, form: Option<Form>, rows: u64, threads: usize) -> Result<(), Failure> {
    let (mut room, mut tried, mut bytes) = (SweepWorkspace::default(), 0, 0);
    let (started, mut spent) = (Instant::now(), Duration::ZERO);
    for (k, points) in plan.trials(rows, form.is_some()).enumerate() {
        let (before, count) = (Instant::now(), points.end - points.start);
        let Ok(found) = plan.rows(points, &mut room, &UntilInterrupted) else { break };
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
    let each = if form == Some(Form::Parquet) { plan.columns().len() as f64 * 6.0 } else { bytes as f64 / tried };
    let size = form.map_or(0.0, |_| each * rows as f64);
    if seconds <= UNASKED.0 && size <= UNASKED.1 {
        return Ok(());
    }
    let mut what = format!("{} would take about {} on {threads} threads", text::points(rows), text::duration(seconds));
    if size > 0.0 {
        what += &format!(" and about {} of disk", text::bytes(size));
    }
    let mut hint = "add --yes to go, --shard 1/16 to share it among machines, or take fewer values".to_owned();
    if plan.could_be_compiled() {
        hint += "; --fast is some thousand times faster here, to a part in 10^12";
    }
    Err(Failure::Told(format!("{what}; {hint}\n")))
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
    let form = Form::of(out)?;
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
        if Form::of(shard).ok() != Some(form) || !shard.exists() {
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
