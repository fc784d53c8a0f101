//! Sweeps: many points on all cores, to a table or to a few numbers.

mod table;
mod text;

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use willis::diagnostic::Diagnostics;
use willis::model::Model;
use willis::study::{Axis, Cells, Column, CompiledSweep, Hold, Question, Room, Rows, Summary, Sweep, Trains};

use crate::{interrupt, work};
use table::Form;

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

/// An axis as it is told.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AxisReport {
    pub quantity: String,
    pub unit: String,
    pub count: u64,
    pub first: String,
    pub last: String,
}

/// What a sweep is: the same for all its shards, and for every run of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Study {
    pub format: String,
    pub version: String,
    pub train: String,
    /// Of the train file, of the tables that it names, and of all that was asked.
    pub sha256: String,
    pub operation: String,
    pub state: Option<String>,
    pub held: String,
    /// `analyze`, or `compiled`.
    pub method: String,
    pub axes: Vec<AxisReport>,
    pub points: u64,
    pub columns: Vec<Column>,
    /// Points of a piece.
    pub piece: u64,
    pub assumptions: Vec<String>,
}

/// A sweep that was run.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Report {
    #[serde(flatten)]
    pub study: Study,
    /// `3/16`, of a part of a sweep.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shard: Option<String>,
    pub rows: u64,
    /// Of the table, where one was written.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub table_sha256: Option<String>,
    pub summary: Summary,
    /// The points of the extremes, in words.
    pub places: BTreeMap<String, String>,
}

/// What is kept beside a piece.
#[derive(Serialize, Deserialize)]
struct Piece {
    sha256: String,
    summary: Summary,
}

/// Points above which a sweep is tried for time and size first.
const MANY: u64 = 20_000;
/// What is done without asking: seconds and bytes.
const UNASKED: (f64, f64) = (3600.0, 20e9);
/// Points between two looks for Ctrl-C.
const LOOK: u64 = 256;

/// How points are answered.
enum Engine<'a, 's> {
    Analyze(&'a Sweep<'s>),
    Compiled(CompiledSweep<'a, 's>),
}

/// What a thread needs of its own.
#[derive(Default)]
struct Own {
    trains: Trains,
    room: Room,
}

impl Engine<'_, '_> {
    fn columns(&self) -> Vec<Column> {
        match self {
            Self::Analyze(s) => s.columns().cloned().collect(),
            Self::Compiled(s) => s.columns().cloned().collect(),
        }
    }

    /// Rows of a piece; none where Ctrl-C was pressed.
    fn rows(&self, from: u64, to: u64, group: u64, own: &mut Own) -> Option<Rows> {
        let Self::Analyze(sweep) = self else {
            let Self::Compiled(sweep) = self else { unreachable!("one of the two") };
            return (!interrupt::interrupted()).then(|| sweep.rows(from, to, &mut own.room));
        };
        let step = (LOOK / group).max(1) * group;
        let mut all: Option<Rows> = None;
        let mut point = from;
        while point < to {
            if interrupt::interrupted() {
                return None;
            }
            let end = (point + step).min(to);
            let rows = sweep.rows(point, end, &mut own.trains);
            match &mut all {
                None => all = Some(rows),
                Some(all) => append(all, rows),
            }
            point = end;
        }
        all
    }

    fn summary(&self, from: u64, to: u64, group: u64, own: &mut Own) -> Option<Summary> {
        match self {
            Self::Analyze(_) => self.rows(from, to, group, own).map(|r| r.summary),
            Self::Compiled(s) => (!interrupt::interrupted()).then(|| s.summary(from, to, &mut own.room)),
        }
    }
}

fn append(all: &mut Rows, more: Rows) {
    for (to, from) in all.columns.iter_mut().zip(more.columns) {
        match (to, from) {
            (Cells::Numbers(to), Cells::Numbers(from)) => to.extend(from),
            (Cells::Texts(to), Cells::Texts(from)) => to.extend(from),
            _ => unreachable!("columns keep their kind"),
        }
    }
    all.summary.join(&more.summary);
}

/// Points of a piece: a few dozen pieces of a small sweep, groups whole.
fn piece(points: u64, group: u64, fast: bool) -> u64 {
    let [least, most] = if fast { [1 << 16, 1 << 18] } else { [1 << 7, 1 << 13] };
    // However many points, a list of the pieces fits anywhere.
    let wanted = (points / 64).next_power_of_two().clamp(least, most).max(points / 1_000_000);
    wanted.div_ceil(group) * group
}

fn sha256(parts: &[&str]) -> String {
    let mut hash = Sha256::new();
    for part in parts {
        // With its length, so that no two lists mean the same bytes.
        hash.update((part.len() as u64).to_le_bytes());
        hash.update(part.as_bytes());
    }
    hex(&hash.finalize())
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

/// Runs a sweep of a train file with `text`.
pub fn run(model: &Model, text: &str, laws: &[String], request: &Request) -> Result<Report, Failure> {
    let sweep = match &request.study {
        Some(name) => Sweep::of_file(model, name)?,
        None => {
            let mut wrong = Diagnostics::default();
            let mut axes = vec![];
            for over in &request.over {
                match Axis::parse(over, model) {
                    Ok(axis) => axes.push(axis),
                    Err(d) => wrong.push(*d),
                }
            }
            if wrong.has_errors() {
                return Err(wrong.into());
            }
            let (operation, state) = (request.operation.as_deref(), request.state.as_deref());
            Sweep::new(Question::new(model, operation, state, request.hold)?, axes, &request.columns)?
        }
    };
    let engine = if request.fast { Engine::Compiled(sweep.compile()?) } else { Engine::Analyze(&sweep) };
    let form = request.out.as_deref().map(Form::of).transpose()?;
    let group = sweep.group();
    let piece = piece(sweep.len(), group, request.fast);
    let pieces = sweep.len().div_ceil(piece);
    let (first, last) = match request.shard {
        None => (0, pieces),
        Some((k, n)) => {
            // Wide enough for any product.
            let at = |k: u64| (u128::from(pieces) * u128::from(k) / u128::from(n)) as u64;
            (at(k - 1), at(k))
        }
    };
    let shard = request.shard.map(|(k, n)| format!("{k}/{n}"));
    let rows = (last * piece).min(sweep.len()) - (first * piece).min(sweep.len());
    let columns = engine.columns();
    let study = study(model, text, laws, request, &sweep, columns, piece);
    let threads = request.threads.unwrap_or_else(work::cores);

    refuse_nonsense(&sweep)?;
    if !request.yes && rows > MANY {
        ask(&engine, &sweep, form, &study.columns, rows, threads)?;
    }
    interrupt::listen(|| {});
    let span = |k: u64| (k * piece, ((k + 1) * piece).min(sweep.len()));
    let summary = match (&request.out, form) {
        (Some(out), Some(form)) => {
            let folder = Folder::open(out, form, &study, shard.as_deref(), request.force)?;
            let todo: Vec<u64> = (first..last).filter(|k| !folder.has(*k)).collect();
            let kept = (last - first) - todo.len() as u64;
            if kept > 0 {
                eprintln!("going on: {kept} of {} pieces are there already", last - first);
            }
            let done: u64 = rows - todo.iter().map(|k| span(*k).1 - span(*k).0).sum::<u64>();
            let make = |k: u64, own: &mut Own| -> Result<Option<()>, String> {
                let (from, to) = span(k);
                let Some(rows) = engine.rows(from, to, group, own) else { return Ok(None) };
                let bytes = form.encode(&study.columns, &rows)?;
                folder.keep(k, &bytes, &rows.summary).map(Some)
            };
            let left = work::run(&todo, threads, (done, rows, "points"), |k| span(k).1 - span(k).0, make, |_, ()| {});
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
            let mut report = report(&sweep, study, shard, rows, summary);
            folder.finish(first..last, &mut report)?;
            return Ok(report);
        }
        _ => {
            let all: Vec<u64> = (first..last).collect();
            let mut ordered = work::InOrder::new(first);
            let mut summary = Summary::default();
            let make = |k: u64, own: &mut Own| {
                let (from, to) = span(k);
                Ok(engine.summary(from, to, group, own))
            };
            let left = work::run(
                &all,
                threads,
                (0, rows, "points"),
                |k| span(k).1 - span(k).0,
                make,
                |k, s: Summary| {
                    ordered.push(k, s, |s| summary.join(&s));
                },
            )?;
            if left > 0 {
                return Err(Failure::Interrupted(
                    "interrupted: nothing was written (give --out to keep pieces)\n".into(),
                ));
            }
            summary
        }
    };
    Ok(report(&sweep, study, shard, rows, summary))
}

fn study(
    model: &Model,
    text: &str,
    laws: &[String],
    request: &Request,
    sweep: &Sweep<'_>,
    columns: Vec<Column>,
    piece: u64,
) -> Study {
    let train = model.train();
    let axis = |a: &Axis| AxisReport {
        quantity: a.name.clone(),
        unit: a.unit.clone(),
        count: a.len() as u64,
        first: a.setting(0),
        last: a.setting(a.len() - 1),
    };
    let base = sweep.question().base();
    let state = base.state.map(|k| train.states()[k].name.clone());
    let method = if request.fast { "compiled" } else { "analyze" };
    let held = serde_json::to_value(sweep.question().hold()).ok().and_then(|v| v.as_str().map(str::to_owned));
    let held = held.unwrap_or_default();
    let names: Vec<&str> = columns.iter().map(|c| c.name.as_str()).collect();
    let (names, laws) = (names.join("\n"), laws.join("\n"));
    let over = request.over.iter().map(|o| o.trim()).collect::<Vec<_>>().join("\n");
    let over = request.study.as_ref().map_or(over, |name| format!("study {name}"));
    let files = model.files().map(|(name, text)| format!("{name}\n{text}")).collect::<Vec<_>>().join("\n");
    let version = env!("CARGO_PKG_VERSION");
    let state_text = state.as_deref().unwrap_or_default();
    let parts = [version, text, &files, &laws, &over, &base.name, state_text, &held, method, &names];
    Study {
        format: "willis-sweep-1".into(),
        version: version.into(),
        train: train.name().into(),
        sha256: sha256(&parts),
        operation: base.name.clone(),
        state,
        held,
        method: method.into(),
        axes: sweep.axes().iter().map(axis).collect(),
        points: sweep.len(),
        columns,
        piece,
        assumptions: willis::analysis::assumptions(train),
    }
}

fn report(sweep: &Sweep<'_>, study: Study, shard: Option<String>, rows: u64, summary: Summary) -> Report {
    let mut places = BTreeMap::new();
    for (name, extent) in [("efficiency", &summary.efficiency), ("loss_w", &summary.loss_w)] {
        if extent.count > 0 {
            places.insert(format!("least_{name}"), sweep.describe(extent.least.1));
            places.insert(format!("most_{name}"), sweep.describe(extent.most.1));
        }
    }
    for (code, seen) in &summary.seen {
        places.insert(code.clone(), sweep.describe(seen.point));
    }
    Report { study, shard, rows, table_sha256: None, summary, places }
}

/// A sweep none of whose first, last and middle points makes a question is wrong itself.
fn refuse_nonsense(sweep: &Sweep<'_>) -> Result<(), Failure> {
    let mut trains = Trains::default();
    let mut first = None;
    for k in 0..=4 {
        let point = (sweep.len() - 1) * k / 4;
        match sweep.ask(point, &mut trains).and_then(|(train, o)| willis::analysis::operate(&train, &o).map(drop)) {
            Ok(()) => return Ok(()),
            Err(wrong) => drop(first.get_or_insert(wrong)),
        }
    }
    Err(first.map_or_else(|| Failure::Told(String::new()), Failure::Input))
}

/// Asks for `--yes` where a sweep is very long or very large.
fn ask(
    engine: &Engine<'_, '_>,
    sweep: &Sweep<'_>,
    form: Option<Form>,
    columns: &[Column],
    rows: u64,
    threads: usize,
) -> Result<(), Failure> {
    // Compiled points are a matter of nanoseconds; nobody waits for those, only for what is written.
    if matches!(engine, Engine::Compiled(_)) && form.is_none() && rows < 1_000_000_000 {
        return Ok(());
    }
    let group = sweep.group();
    let (mut own, mut tried, mut bytes) = (Own::default(), 0, 0);
    let started = Instant::now();
    const TRIALS: u64 = 32;
    let mut spent = Duration::ZERO;
    for k in 0..TRIALS {
        let from = sweep.len() / TRIALS * k / group * group;
        let wide = if matches!(engine, Engine::Compiled(_)) { 4096 } else { 1 };
        let to = (from + wide.max(group).div_ceil(group) * group).min(sweep.len());
        let before = Instant::now();
        let Some(found) = engine.rows(from, to, group, &mut own) else { break };
        // The first call pays for what is made once.
        if k > 0 {
            spent += before.elapsed();
            tried += to - from;
            bytes += form.map_or(0, |f| f.encode(columns, &found).map_or(0, |b| b.len()) as u64);
        }
        if started.elapsed() > Duration::from_millis(300) {
            break;
        }
    }
    let tried = tried.max(1) as f64;
    let seconds = spent.as_secs_f64() / tried * rows as f64 / threads as f64;
    // A table of few rows is mostly its footer.
    let each = if form == Some(Form::Parquet) { columns.len() as f64 * 6.0 } else { bytes as f64 / tried };
    let size = form.map_or(0.0, |_| each * rows as f64);
    if seconds <= UNASKED.0 && size <= UNASKED.1 {
        return Ok(());
    }
    let mut what = format!("{} would take about {} on {threads} threads", text::points(rows), text::duration(seconds));
    if size > 0.0 {
        what += &format!(" and about {} of disk", text::bytes(size));
    }
    let mut hint = "add --yes to go, --shard 1/16 to share it among machines, or take fewer values".to_owned();
    if matches!(engine, Engine::Analyze(_)) && sweep.compile().is_ok() {
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
    fn open(out: &Path, form: Form, study: &Study, shard: Option<&str>, force: bool) -> Result<Self, String> {
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
        let parsed = report.shard.as_deref().and_then(|s| {
            let (k, n) = s.split_once('/')?;
            Some((k.parse().ok()?, n.parse().ok()?))
        });
        match parsed {
            Some((k, n)) => all.push((k, n, shard.clone(), report)),
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
    let Some((_, _, _, first)) = all.first() else { return Err("no shards to merge\n".into()) };
    let mut report = Report {
        shard: None,
        rows: 0,
        table_sha256: None,
        summary: Summary::default(),
        places: BTreeMap::new(),
        ..first.clone()
    };
    for (.., own) in &all {
        // Where an extreme or a warning is comes from the shard that had it first.
        let before = report.summary.clone();
        report.rows += own.rows;
        report.summary.join(&own.summary);
        for (name, place) in &own.places {
            let is_new = match name.as_str() {
                "least_efficiency" => report.summary.efficiency.least != before.efficiency.least,
                "most_efficiency" => report.summary.efficiency.most != before.efficiency.most,
                "least_loss_w" => report.summary.loss_w.least != before.loss_w.least,
                "most_loss_w" => report.summary.loss_w.most != before.loss_w.most,
                _ => !before.seen.contains_key(name),
            };
            if is_new {
                report.places.insert(name.clone(), place.clone());
            }
        }
    }
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
