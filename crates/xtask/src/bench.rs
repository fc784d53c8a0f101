//! `cargo xtask bench`: speed beside that of peers, in one run, in one table.
//!
//! A ratio is printed only between programs whose checksums agree; the smoothed friction of the scripts in scipy ends
//! elsewhere, so that each side checks its own end. Where samples of a task lie far apart the machine was busy, and the
//! row says so in the place of a verdict.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

use serde_json::Value;

use crate::context::Context;
use crate::step::{Outcome, outcome};

/// What is asked of a row.
#[derive(Clone, Copy)]
enum Goal {
    /// So many times as fast as the peer.
    Times(f64),
    /// At least so many a second.
    Least(f64),
    /// At most so many seconds.
    Most(f64),
    /// Nothing; for comparison.
    None,
}
use Goal::{Least, Most, Times};

/// What the machine allows at most.
#[derive(Clone, Copy)]
enum Limit {
    Words(&'static str),
    /// What the task itself measured: as much from arrays that stay in the cache.
    Measured(&'static str),
}
use Limit::Words;

impl Limit {
    fn told(self, results: &Results) -> Result<String, String> {
        match self {
            Words(words) => Ok(words.to_owned()),
            Limit::Measured(task) => {
                let cached = results.ours(&format!("{task}-cached"))?["checksum"]["points_per_s"].as_f64();
                Ok(format!("{:.1e} in the cache", cached.ok_or_else(|| format!("{task}: no rate in the cache"))?))
            }
        }
    }
}

/// Task, peer (a program, or another task of ours), what is asked, and what the machine allows.
type Asked = (&'static str, &'static str, Goal, Limit);

/// Points, steps, or seconds of a scenario, in a second. A peer `task/program` is that of another task, whose points are
/// others. Limits: measured beside it, or the same arithmetic written in C for this case alone, with fused
/// multiplication and sums in any order (measured in November 2026 on the machine of the figures in the README).
const RATES: &[Asked] = &[
    ("map-all", "numpy-whole-array", Times(10.0), Limit::Measured("map-all")),
    ("map-all", "numpy-blocked", Goal::None, Words("")),
    ("map-all", "numba-fused", Times(0.9), Words("5.0e8 in C")),
    ("map-efficiency", "numpy-whole-array", Times(40.0), Limit::Measured("map-efficiency")),
    ("map-efficiency", "numba-fused", Goal::None, Words("")),
    ("map-efficiency-f32", "map-efficiency/numpy-whole-array", Goal::None, Words("")),
    ("map-reduced", "numpy-whole-array", Times(40.0), Limit::Measured("map-reduced")),
    ("map-reduced", "numba-fused", Times(1.0), Words("sums in any order, fused multiplication")),
    ("map-grid-efficiency", "map-efficiency/numpy-whole-array", Times(100.0), Words("1.9e9 in C, single precision")),
    ("map-grid-reduced", "map-reduced/numba-fused", Times(2.0), Words("")),
    ("automatic-gear-1", "numpy-batched-solve", Times(200.0), Words("")),
    ("automatic-gear-1", "numpy-precomputed", Times(15.0), Words("")),
    ("automatic-gear-1", "numba-fused", Goal::None, Words("")),
    ("automatic-gear-1", "", Least(500e6), Words("2.6e8 in C")),
    ("automatic-gear-3", "numpy-batched-solve", Times(200.0), Words("")),
    ("automatic-gear-3", "numpy-precomputed", Times(15.0), Words("")),
    ("automatic-gear-3", "numba-fused", Goal::None, Words("")),
    ("automatic-gear-3", "", Least(500e6), Words("2.7e8 in C")),
    ("automatic-gear-5", "numpy-batched-solve", Times(200.0), Words("")),
    ("automatic-gear-5", "numpy-precomputed", Times(15.0), Words("")),
    ("automatic-gear-5", "numba-fused", Goal::None, Words("")),
    ("automatic-gear-5", "", Least(500e6), Words("2.6e8 in C")),
    ("automatic-load-gear-1", "numpy-batched-solve", Times(30.0), Words("6.0e7 in C, two rounds")),
    ("automatic-load-gear-3", "numpy-batched-solve", Times(30.0), Words("7.0e7 in C, two rounds")),
    ("automatic-load-gear-5", "numpy-batched-solve", Times(30.0), Words("5.1e7 in C, two rounds")),
    ("automatic-one-point", "", Goal::None, Words("")),
    ("automatic-load-one-point", "", Goal::None, Words("")),
    ("physical-stage", "", Least(1e5), Words("")),
    ("physical-eight-speed", "", Least(5e4), Words("")),
    ("set-adaptive", "scipy-lsoda", Times(30.0), Words("7.2e4 in C")),
    ("set-adaptive", "scipy-lsoda-numba", Goal::None, Words("")),
    ("set-adaptive-again", "", Least(5e4), Words("7.2e4 in C")),
    ("automatic-adaptive-again", "", Least(5e4), Words("")),
    ("set-fixed-1e-3", "", Least(1.3e7), Words("2.2e7 in C")),
    ("set-fixed-1e-4", "", Least(1.3e7), Words("2.2e7 in C")),
    ("automatic-fixed-1e-3", "", Least(3e7), Words("2.5e7 in C")),
    ("automatic-fixed-1e-4", "", Least(3e7), Words("2.8e7 in C")),
    ("set-batch", "set-fixed-1e-3", Times(5.0), Words("")),
    ("automatic-batch", "automatic-fixed-1e-3", Goal::None, Words("")),
];

/// Seconds of one answer. `set-thousand` and `automatic-thousand`, which have no seconds, stand in [`BATCHES`].
const ANSWERS: &[Asked] = &[
    ("eight-speed-text-to-answer", "", Most(0.35e-3), Words("")),
    ("nine-automatics-two-loss-levels", "", Most(50e-3), Words("")),
    ("eight-speed-compile-one-gear", "", Most(1e-3), Words("")),
    ("regimes-longest", "", Most(20e-3), Words("")),
    ("stage-one-point", "", Goal::None, Words("")),
    ("stage-analysis", "", Goal::None, Words("")),
    ("stage-sensitivity", "stage-analysis", Times(0.2), Words("")),
    ("stage-sensitivity", "stage-one-point", Goal::None, Words("the equilibrium alone, without its table")),
    // On one core; the command has all.
    ("stage-uncertainty", "", Goal::None, Words("")),
    ("automatic-longest-step", "", Most(1e-6), Words("")),
    // Sixteen times as many sets: sixteen times as long, were it linear.
    ("chain-analyze-64", "chain-analyze-4", Goal::None, Words("1/16")),
    ("chain-regimes-64", "chain-regimes-4", Goal::None, Words("1/16")),
    ("chain-simulate-64", "chain-simulate-4", Goal::None, Words("1/16")),
];

/// How many times as fast a thousand runs are side by side as one after the other.
const BATCHES: &[(&str, f64)] = &[("set-thousand", 10.0), ("automatic-thousand", 8.0)];

/// The slowest gear of an automatic: points a second, from arrays of as many points, with everything that the gear determines.
const GEARS: &[&str] = &["gears-8hp70-1e5", "gears-8hp70-1e6", "gears-10r80-1e5", "gears-10r80-1e6"];

/// Samples of a task that lie further apart than this share, the middle one beside the shortest, say nothing.
const STEADY: f64 = 0.15;

/// `cargo xtask bench`
pub(crate) fn bench(context: &Context) -> Outcome {
    match run(&context.root) {
        Ok(()) => Outcome::Passed,
        Err(why) => Outcome::Failed(why),
    }
}

const GATE: &str = "cargo bench -p willis --bench gate";

fn counts(context: &Context) -> bool {
    context.succeeds("valgrind --version")
}

/// What can be built before the work is counted.
pub(crate) fn builds(context: &Context) -> Vec<Command> {
    if counts(context) { vec![context.words(&format!("{GATE} --no-run"))] } else { vec![] }
}

/// Work counts against their committed values.
pub(crate) fn bench_gate(context: &Context) -> Outcome {
    match counts(context) {
        true => outcome(context.run(GATE)),
        false => Outcome::Skipped("valgrind, which counts the instructions, is not installed".into()),
    }
}

/// A measured value, and by how much the middle sample was worse than the best.
#[derive(Clone, Copy)]
struct Measured {
    value: f64,
    spread: f64,
}

/// The table, printed as it grows.
#[derive(Default)]
struct Table {
    lines: Vec<String>,
    missed: usize,
    unsteady: usize,
}

impl Table {
    fn head(&mut self) {
        self.push(format!(
            "{:34} {:32} {:>10} {:>10} {:>8} {:>9} {:>7}  {:8} {}",
            "what", "peer", "peer's", "Willis", "ratio", "goal", "spread", "", "limit"
        ));
    }

    fn push(&mut self, line: String) {
        println!("{line}");
        self.lines.push(line);
    }

    /// `rate`: more is better; else fewer seconds are. A goal in times is on the ratio.
    fn row(
        &mut self,
        (what, peer): (&str, &str),
        (theirs, ours): (Option<f64>, Measured),
        rate: bool,
        goal: Goal,
        limit: &str,
    ) {
        let ratio = theirs.map(|theirs| if rate { ours.value / theirs } else { theirs / ours.value });
        let (asked, reached) = match goal {
            Times(x) => (format!("{x:.3} x").replace(".000 x", " x"), ratio.is_some_and(|r| r >= x)),
            Least(x) => (format!("{x:.1e}"), ours.value >= x),
            Most(x) => (format!("{x:.1e} s"), ours.value <= x),
            Goal::None => (String::new(), true),
        };
        let verdict = match goal {
            // A goal that was reached all the same was reached.
            Goal::None => "",
            _ if reached => "ok",
            _ if ours.spread > STEADY => "busy",
            _ => "MISS",
        };
        self.missed += usize::from(verdict == "MISS");
        self.unsteady += usize::from(verdict == "busy");
        let number = |x: f64| format!("{x:.3e}");
        self.push(format!(
            "{what:34} {peer:32} {:>10} {:>10} {:>8} {asked:>9} {:>6.0}%  {verdict:8} {limit}",
            theirs.map_or(String::new(), number),
            number(ours.value),
            ratio.map_or(String::new(), |r| format!("{r:.3}")),
            100.0 * ours.spread,
        ));
    }
}

const BENCHES: [&str; 3] = ["compiled", "motion", "answers"];

/// The programs of a build, by their names.
struct Programs(Vec<(String, PathBuf)>);

impl Programs {
    /// Builds what is measured, all at once, so that the library is built once: as published, but with its names.
    fn build(root: &Path) -> Result<Self, String> {
        let mut c = Command::new("cargo");
        c.current_dir(root).args(["build", "--profile", "bench", "--quiet", "-p", "willis", "-p", "willis-cli"]);
        c.args(["--bin", "willis", "--message-format", "json-render-diagnostics"]);
        for bench in BENCHES {
            c.args(["--bench", bench]);
        }
        let out = c.stderr(Stdio::inherit()).output().map_err(|e| e.to_string())?;
        if !out.status.success() {
            return Err("the build failed".into());
        }
        let told = lines(&String::from_utf8_lossy(&out.stdout))?;
        let program = |v: &Value| Some((v["target"]["name"].as_str()?.to_owned(), v["executable"].as_str()?.into()));
        Ok(Self(told.iter().filter_map(program).collect()))
    }

    fn of(&self, name: &str) -> Result<&Path, String> {
        let found = self.0.iter().find(|(n, _)| n == name);
        found.map(|(_, path)| path.as_path()).ok_or_else(|| format!("the build has no program `{name}`"))
    }
}

/// What is being done, and since when.
#[derive(Default)]
struct Stage(Option<(&'static str, Instant)>);

impl Stage {
    fn begins(&mut self, what: &'static str) {
        self.ends();
        println!("{what} …");
        self.0 = Some((what, Instant::now()));
    }

    fn ends(&mut self) {
        if let Some((what, since)) = self.0.take() {
            println!("{what}: {:.0} s", since.elapsed().as_secs_f64());
        }
    }
}

/// Runs everything and prints the table. `Err` when a program failed or checksums differ.
fn run(root: &Path) -> Result<(), String> {
    let started = Instant::now();
    let folder = root.join("target/willis-bench");
    fs::create_dir_all(&folder).map_err(|e| e.to_string())?;
    let checksums = folder.join("checksums.jsonl");
    let _ = fs::remove_file(&checksums);
    let python = python(root, &folder)?;
    let mut stage = Stage::default();
    stage.begins("building");
    let built = Programs::build(root)?;
    stage.begins("Willis");
    for bench in BENCHES {
        // Two seconds a task: the best of many short samples is what is kept.
        let arguments = ["--bench", "--noplot", "--quiet", "--warm-up-time", "0.5", "--measurement-time", "2"];
        let mut c = Command::new(built.of(bench)?);
        c.current_dir(root.join("crates/willis")).args(arguments).stdout(Stdio::null());
        // Large pages for long arrays, as NumPy has them for its own.
        c.env("GLIBC_TUNABLES", "glibc.malloc.hugetlb=1").env("CRITERION_HOME", root.join("target/criterion"));
        command(&mut c)?;
    }
    let mut peers = Vec::new();
    let scripts: [(&str, &[&str]); 4] = [
        ("map.py", &["--points", "10000000"]),
        ("automatic.py", &["--points", "100000"]),
        ("motion.py", &[]),
        ("study.py", &[]),
    ];
    for (script, arguments) in scripts {
        stage.begins(script);
        let mut c = Command::new(&python);
        c.current_dir(root.join("benches/baselines")).args([script, "--json"]).args(arguments);
        c.env("OMP_NUM_THREADS", "1").env("OPENBLAS_NUM_THREADS", "1").env("PYTHONDONTWRITEBYTECODE", "1");
        let out = c.output().map_err(|e| e.to_string())?;
        if !out.status.success() {
            return Err(format!("{script}: {}", String::from_utf8_lossy(&out.stderr)));
        }
        peers.extend(lines(&String::from_utf8_lossy(&out.stdout))?);
    }
    stage.begins("commands");
    let own = lines(&fs::read_to_string(&checksums).map_err(|e| e.to_string())?)?;
    let results = Results { root: root.to_owned(), own, peers };

    let mut table = Table::default();
    let mut wrong = Vec::new();
    println!();
    table.head();
    for &(task, peer, goal, limit) in RATES {
        let theirs = results.theirs(task, peer, true, &mut wrong)?;
        table.row((task, peer), (theirs, results.rate(task)?), true, goal, &limit.told(&results)?);
    }
    for &task in GEARS {
        let ours = results.recorded(task, "points_per_s")?;
        let stored = results.recorded(task, "results")?.value;
        let told = format!("{stored} results a point, {:.1} GB/s", 8e-9 * stored * ours.value);
        table.row((task, "slowest gear"), (None, ours), true, Goal::None, &told);
    }
    for &(task, peer, goal, limit) in ANSWERS {
        let theirs = results.theirs(task, peer, false, &mut wrong)?;
        table.row((task, peer), (theirs, results.seconds(task)?), false, goal, &limit.told(&results)?);
    }
    for &(task, goal) in BATCHES {
        let ours = results.recorded(task, "ratio")?;
        let one = Measured { value: ours.value, spread: ours.spread };
        table.row((task, "one by one"), (Some(1.0), one), true, Times(goal), "");
    }
    commands(built.of("willis")?, &results, &mut table, &mut wrong)?;
    stage.ends();
    fs::write(folder.join("table.txt"), table.lines.join("\n") + "\n").map_err(|e| e.to_string())?;
    println!(
        "\n{} goals missed, {} rows unsteady; {:.0} s. Rates a second, answers in seconds, limits in C those of the \
         machine of the README; the table is in target/willis-bench",
        table.missed,
        table.unsteady,
        started.elapsed().as_secs_f64()
    );
    if table.unsteady > 0 {
        println!("samples of unsteady rows lie far apart: the machine was busy. Run it again when it is quiet.");
    }
    if wrong.is_empty() { Ok(()) } else { Err(wrong.join("\n")) }
}

/// The interpreter of an environment with the peers.
fn python(root: &Path, folder: &Path) -> Result<PathBuf, String> {
    let venv = folder.join("venv");
    let python = venv.join("bin/python");
    let requirements = root.join("benches/baselines/requirements.txt");
    let installed = venv.join("requirements.txt");
    let wanted = fs::read(&requirements).map_err(|e| e.to_string())?;
    if fs::read(&installed).ok().as_ref() != Some(&wanted) {
        command(Command::new("python3").args(["-m", "venv"]).arg(&venv))?;
        command(Command::new(&python).args(["-m", "pip", "install", "--quiet", "-r"]).arg(&requirements))?;
        fs::write(&installed, wanted).map_err(|e| e.to_string())?;
    }
    Ok(python)
}

/// What the programs said.
struct Results {
    root: PathBuf,
    own: Vec<Value>,
    peers: Vec<Value>,
}

impl Results {
    /// What a task of ours recorded beside its time.
    fn ours(&self, task: &str) -> Result<&Value, String> {
        self.own.iter().find(|v| v["task"] == task).ok_or_else(|| format!("{task}: no result"))
    }

    /// A task that measured itself.
    fn recorded(&self, task: &str, key: &str) -> Result<Measured, String> {
        let sums = &self.ours(task)?["checksum"];
        let at = |key: &str| sums[key].as_f64().ok_or_else(|| format!("{task}: no `{key}`"));
        Ok(Measured { value: at(key)?, spread: at("spread")? })
    }

    /// Points a second.
    fn rate(&self, task: &str) -> Result<Measured, String> {
        let points = match self.ours(task) {
            Ok(own) => own["points"].as_f64().unwrap_or(f64::NAN),
            // One point, or as many as criterion was told.
            Err(_) => self.throughput(task).unwrap_or(1.0),
        };
        let Measured { value, spread } = self.sampled(task)?;
        Ok(Measured { value: points / value, spread })
    }

    /// Seconds of an answer.
    fn seconds(&self, task: &str) -> Result<Measured, String> {
        self.sampled(task).or_else(|_| self.recorded(task, "seconds"))
    }

    fn file(&self, task: &str, name: &str) -> Option<Value> {
        ["map", "automatic", "cold", "motion", "answers"].iter().find_map(|group| {
            let file = self.root.join(format!("target/criterion/{group}/{task}/new/{name}"));
            serde_json::from_str(&fs::read_to_string(file).ok()?).ok()
        })
    }

    /// How many points criterion was told that one call has.
    fn throughput(&self, task: &str) -> Option<f64> {
        self.file(task, "benchmark.json")?["throughput"]["Elements"].as_f64()
    }

    /// Seconds of the best of the samples of criterion, and how far the middle one lies above it.
    fn sampled(&self, task: &str) -> Result<Measured, String> {
        let v = self.file(task, "sample.json").ok_or_else(|| format!("{task}: criterion left no samples"))?;
        let numbers =
            |key: &str| -> Vec<f64> { v[key].as_array().into_iter().flatten().filter_map(Value::as_f64).collect() };
        let mut each: Vec<f64> =
            numbers("times").into_iter().zip(numbers("iters")).map(|(t, n)| t / n * 1e-9).collect();
        each.sort_by(f64::total_cmp);
        let (Some(least), Some(middle)) = (each.first(), each.get(each.len() / 2)) else {
            return Err(format!("{task}: no samples"));
        };
        Ok(Measured { value: *least, spread: middle / least - 1.0 })
    }

    /// The rate or the seconds of a peer, whose checksums must be ours; of another task where no program has that name.
    fn theirs(&self, task: &str, peer: &str, rate: bool, wrong: &mut Vec<String>) -> Result<Option<f64>, String> {
        if peer.is_empty() {
            return Ok(None);
        }
        if let Some((task, peer)) = peer.split_once('/') {
            let theirs = self.peers.iter().find(|v| v["task"] == task && v["peer"] == peer);
            return Ok(Some(theirs.and_then(|v| v["points_per_s"].as_f64()).ok_or("no such peer")?));
        }
        let Some(theirs) = self.peers.iter().find(|v| v["task"] == task && v["peer"] == peer) else {
            let other = if rate { self.rate(peer)? } else { self.seconds(peer)? };
            return Ok(Some(other.value));
        };
        let ours = self.ours(task)?;
        let points = ours["points"].as_f64().unwrap_or(f64::NAN);
        for (key, mine) in ours["checksum"].as_object().into_iter().flatten() {
            let (mine, other) = (mine.as_f64().unwrap_or(f64::NAN), theirs["checksum"][key].as_f64());
            // Sums that nearly cancel are compared against the number of points.
            let near = other.is_some_and(|o| (mine - o).abs() <= 1e-9 * o.abs().max(points));
            if other.is_some() && !near {
                wrong.push(format!("{task} {peer}: {key} is {mine}, theirs {other:?}"));
            }
        }
        Ok(theirs["points_per_s"].as_f64())
    }
}

/// Wall time of a whole program, the best of several runs, and what it printed.
fn timed(program: &Path, root: &Path, arguments: &[&str], runs: usize) -> Result<(Measured, Vec<u8>), String> {
    let mut all = Vec::new();
    let mut told = Vec::new();
    for _ in 0..runs {
        let started = Instant::now();
        let out = Command::new(program).current_dir(root).args(arguments).output().map_err(|e| e.to_string())?;
        all.push(started.elapsed().as_secs_f64());
        if !out.status.success() {
            return Err(format!("{arguments:?}: {}", String::from_utf8_lossy(&out.stderr)));
        }
        told = out.stdout;
    }
    all.sort_by(f64::total_cmp);
    Ok((Measured { value: all[0], spread: all[runs / 2] / all[0] - 1.0 }, told))
}

/// How many times as much two programs get done at once as one, the best of several runs: what a second thread could give
/// on this machine, whose cores may share what they compute with.
fn two_at_once(program: &Path, root: &Path, arguments: &[&str], one: f64, runs: usize) -> Result<f64, String> {
    let mut least = f64::INFINITY;
    for _ in 0..runs {
        let started = Instant::now();
        let start = || {
            let quiet = (Stdio::null(), Stdio::null());
            Command::new(program).current_dir(root).args(arguments).stdout(quiet.0).stderr(quiet.1).spawn()
        };
        let both = [start(), start()];
        for child in both {
            child.and_then(|mut child| child.wait()).map_err(|e| e.to_string())?;
        }
        least = least.min(started.elapsed().as_secs_f64());
    }
    Ok(2.0 * one / least)
}

/// Whole commands: wall time of the program.
fn commands(willis: &Path, results: &Results, table: &mut Table, wrong: &mut Vec<String>) -> Result<(), String> {
    let root = &results.root;
    let run = |arguments: &[&str], runs: usize| timed(willis, root, arguments, runs);
    let map = ["sweep", "benches/map.toml", "--study", "map", "--fast", "--format", "json", "--threads"];
    let folder = root.join("target/willis-bench");
    let out = |name: &str| folder.join(name).to_string_lossy().into_owned();
    let on = |threads: &'static str| [&map[..], &[threads]].concat();
    let at_once = |arguments: &[&str], one: Measured, runs: usize| {
        two_at_once(willis, root, arguments, one.value, runs).map(|times| format!("{times:.2} x: two programs at once"))
    };
    let (mut two, mut limit) = (f64::NAN, String::new());
    for threads in ["1", "2"] {
        let (seconds, told) = run(&on(threads), 15)?;
        let told: Value = serde_json::from_slice(&told).map_err(|e| e.to_string())?;
        let points = told["points"].as_f64().unwrap_or(f64::NAN);
        two = seconds.value;
        for peer in results.peers.iter().filter(|v| v["task"] == "study-map") {
            for quantity in ["efficiency", "loss_w"] {
                let own = &told["summary"][quantity];
                let mean = own["sum"].as_f64().unwrap_or(f64::NAN) / points;
                let at = |key: &str| own[key][0].as_f64().unwrap_or(f64::NAN);
                for (what, mine) in [("mean", mean), ("least", at("least")), ("most", at("most"))] {
                    let theirs = peer["checksum"][format!("{quantity}_{what}")].as_f64().unwrap_or(f64::NAN);
                    if (mine - theirs).abs() > 1e-9 * theirs.abs().max(1e-6) {
                        wrong.push(format!("study-map: {quantity} {what} is {mine}, {} has {theirs}", peer["peer"]));
                    }
                }
            }
            let name = peer["peer"].as_str().unwrap_or_default();
            let goal = if name == "numpy-whole-array" && threads == "2" { Times(20.0) } else { Goal::None };
            let ours = Measured { value: points / seconds.value, ..seconds };
            let what = format!("sweep of 1e7 points, {threads} threads");
            table.row((&what, name), (peer["points_per_s"].as_f64(), ours), true, goal, &limit);
        }
        if threads == "1" {
            limit = at_once(&on(threads), seconds, 15)?;
        }
    }
    let table_file = out("map.parquet");
    let (written, _) = run(&[&on("2")[..], &["--force", "--out", &table_file]].concat(), 5)?;
    table.row(
        ("the same, into Parquet", "without a table"),
        (Some(two), written),
        false,
        Times(1.0 / 1.5),
        "texts and tables of values, by the library",
    );

    let physical = |more: &[&'static str]| {
        let sweep = ["sweep", "examples/fva-planetary-stage.toml", "--over", "sun.speed=100..3000 rpm:100", "--over"];
        [&sweep[..], &["sun.torque=50..1600 N m:100", "--format", "json", "--threads"], more].concat()
    };
    let (one, _) = run(&physical(&["1"]), 5)?;
    let (both, _) = run(&physical(&["2"]), 5)?;
    let limit = at_once(&physical(&["1"]), one, 5)?;
    table.row(("physical map, two threads", "one thread"), (Some(one.value), both), false, Times(1.8), &limit);
    let file = out("physical.parquet");
    let (written, _) = run(&[&physical(&["1"])[..], &["--force", "--out", &file]].concat(), 5)?;
    table.row(
        ("physical map, into Parquet", "without a table"),
        (Some(one.value), written),
        false,
        Times(1.0 / 1.3),
        "",
    );

    let (analyzed, _) = run(&["analyze", "examples/zf-8hp70.toml"], 25)?;
    table.row(("command: analyze 8HP70", ""), (None, analyzed), false, Most(4e-3), "");
    let stage = ["uncertainty", "examples/fva-planetary-stage.toml", "--operation", "rated", "--samples", "4096"];
    let (sampled, _) = run(&stage, 15)?;
    table.row(("command: 4096 samples", ""), (None, sampled), false, Most(0.2), "");
    let report = out("report.html");
    let (reported, _) = run(&["report", "examples/zf-8hp70.toml", "--force", "--out", &report], 7)?;
    table.row(("command: report 8HP70", ""), (None, reported), false, Most(0.3), "");
    Ok(())
}

fn lines(text: &str) -> Result<Vec<Value>, String> {
    text.lines().map(|l| serde_json::from_str(l).map_err(|e| format!("{l}: {e}"))).collect()
}

fn command(c: &mut Command) -> Result<(), String> {
    match c.status() {
        Ok(s) if s.success() => Ok(()),
        Ok(s) => Err(format!("{c:?}: {s}")),
        Err(e) => Err(format!("{c:?}: {e}")),
    }
}
