//! `cargo xtask bench`: the compiled train beside numpy and numba, and motion beside scipy, in one run, as ratios.
//!
//! A ratio is printed only between programs whose checksums agree; the smoothed friction of the scripts in scipy ends
//! elsewhere, so that each side checks its own end.

use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

use crate::context::Context;
use crate::step::{Outcome, outcome};

/// Task, peer, ratio asked for (`performance` goals of the project).
const GOALS: &[(&str, &str, Option<f64>)] = &[
    ("map-all", "numpy-whole-array", Some(10.0)),
    ("map-all", "numpy-blocked", None),
    ("map-all", "numba-fused", Some(0.9)),
    ("map-efficiency", "numpy-whole-array", Some(40.0)),
    ("map-efficiency", "numba-fused", None),
    ("map-reduced", "numpy-whole-array", Some(40.0)),
    ("map-reduced", "numba-fused", None),
    ("automatic-gear-1", "numpy-batched-solve", Some(200.0)),
    ("automatic-gear-1", "numpy-precomputed", Some(15.0)),
    ("automatic-gear-1", "numpy-grouped", None),
    ("automatic-gear-1", "numba-fused", None),
    ("automatic-gear-3", "numpy-batched-solve", Some(200.0)),
    ("automatic-gear-3", "numpy-precomputed", Some(15.0)),
    ("automatic-gear-3", "numpy-grouped", None),
    ("automatic-gear-3", "numba-fused", None),
    ("automatic-gear-5", "numpy-batched-solve", Some(200.0)),
    ("automatic-gear-5", "numpy-precomputed", Some(15.0)),
    ("automatic-gear-5", "numpy-grouped", None),
    ("automatic-gear-5", "numba-fused", None),
    ("automatic-load-gear-1", "numpy-batched-solve", Some(30.0)),
    ("automatic-load-gear-3", "numpy-batched-solve", Some(30.0)),
    ("automatic-load-gear-5", "numpy-batched-solve", Some(30.0)),
];

/// Cold starts: criterion group and task, most seconds.
const COLD: &[(&str, f64)] = &[
    ("eight-speed-text-to-answer", 1e-3),
    ("nine-automatics-two-loss-levels", 50e-3),
    ("eight-speed-compile-one-gear", 1e-3),
];

/// Motion beside a peer, or beside itself step by step: task, peer or task, ratio asked for.
const MOTION_RATIOS: &[(&str, &str, Option<f64>)] = &[
    ("set-adaptive", "scipy-lsoda", Some(30.0)),
    ("set-adaptive", "scipy-lsoda-numba", None),
    ("set-batch", "set-fixed-1e-3", Some(5.0)),
    ("automatic-batch", "automatic-fixed-1e-3", None),
];

/// Seconds of a scenario, or steps of fixed length, in a second: task, fewest.
const RATES: &[(&str, f64)] = &[
    ("set-adaptive-again", 5e4),
    ("automatic-adaptive-again", 5e4),
    ("set-fixed-1e-3", 1.3e7),
    ("set-fixed-1e-4", 1.3e7),
    ("automatic-fixed-1e-3", 7e6),
    ("automatic-fixed-1e-4", 7e6),
];

/// The longest step of the automatic, modes known, at most, ns.
const LONGEST_STEP: f64 = 1000.0;

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

/// Runs everything and prints the table. `Err` when a program failed or checksums differ.
fn run(root: &Path) -> Result<(), String> {
    let folder = root.join("target/willis-bench");
    fs::create_dir_all(&folder).map_err(|e| e.to_string())?;
    let checksums = folder.join("checksums.jsonl");
    let _ = fs::remove_file(&checksums);
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
    println!("Willis …");
    let criterion = ["bench", "-p", "willis", "--bench", "compiled", "--bench", "motion", "--", "--noplot"];
    let samples = root.join("target/criterion");
    command(Command::new("cargo").current_dir(root).args(criterion).env("CRITERION_HOME", samples))?;
    let mut peers = Vec::new();
    let scripts: [(&str, &[&str]); 3] =
        [("map.py", &["--points", "10000000"]), ("automatic.py", &["--points", "100000"]), ("motion.py", &[])];
    for (script, arguments) in scripts {
        println!("{script} …");
        let mut c = Command::new(&python);
        c.current_dir(root.join("benches/baselines")).args([script, "--json"]).args(arguments);
        c.env("OMP_NUM_THREADS", "1").env("OPENBLAS_NUM_THREADS", "1").env("PYTHONDONTWRITEBYTECODE", "1");
        let out = c.output().map_err(|e| e.to_string())?;
        if !out.status.success() {
            return Err(format!("{script}: {}", String::from_utf8_lossy(&out.stderr)));
        }
        peers.extend(lines(&String::from_utf8_lossy(&out.stdout))?);
    }
    let own = lines(&fs::read_to_string(&checksums).map_err(|e| e.to_string())?)?;

    println!("\n{:24} {:20} {:>12} {:>12} {:>8} {:>8}", "task", "peer", "peer Mpt/s", "Willis Mpt/s", "ratio", "goal");
    let mut wrong = Vec::new();
    for (task, peer, goal) in GOALS {
        let find =
            |all: &[Value], key: &str, name: &str| all.iter().find(|v| v["task"] == *task && v[key] == name).cloned();
        let (Some(theirs), Some(ours)) = (find(&peers, "peer", peer), find(&own, "peer", "willis")) else {
            wrong.push(format!("{task} {peer}: no result"));
            continue;
        };
        let points = ours["points"].as_f64().unwrap_or(f64::NAN);
        for (key, mine) in ours["checksum"].as_object().into_iter().flatten() {
            let (mine, other) = (mine.as_f64().unwrap_or(f64::NAN), theirs["checksum"][key].as_f64());
            // Sums that nearly cancel are compared against the number of points.
            let near = other.is_some_and(|o| (mine - o).abs() <= 1e-9 * o.abs().max(points));
            if other.is_some() && !near {
                wrong.push(format!("{task} {peer}: {key} is {mine}, theirs {other:?}"));
            }
        }
        let speed = points / best(root, task)?;
        let peer_speed = theirs["points_per_s"].as_f64().unwrap_or(f64::NAN);
        let ratio = speed / peer_speed;
        let goal = verdict(ratio, *goal);
        println!("{task:24} {peer:20} {:12.2} {:12.2} {ratio:8.2} {goal:>8}", peer_speed / 1e6, speed / 1e6);
    }
    for task in ["automatic-one-point", "automatic-load-one-point"] {
        println!("{task:24} {:20} {:>12} {:12.2}", "", "", 1e-6 / best(root, task)?);
    }
    for (task, most) in COLD {
        let seconds = best(root, task)?;
        let verdict = if seconds <= *most { "ok" } else { "MISS" };
        println!("{task:34} {:9.3} ms, at most {} ms: {verdict}", 1e3 * seconds, 1e3 * most);
    }
    motion(root, &own, &peers)?;
    study(root, &python, &mut wrong)?;
    if wrong.is_empty() { Ok(()) } else { Err(wrong.join("\n")) }
}

/// Motion: seconds of the scenario, or steps, in a second.
fn motion(root: &Path, own: &[Value], peers: &[Value]) -> Result<(), String> {
    let ours = |task: &str| own.iter().find(|v| v["task"] == task).ok_or_else(|| format!("{task}: no result"));
    let rate = |task: &str| Ok::<f64, String>(ours(task)?["points"].as_f64().unwrap_or(f64::NAN) / best(root, task)?);
    println!("\n{:24} {:20} {:>12} {:>12} {:>8} {:>8}", "task", "peer", "peer 1/s", "Willis 1/s", "ratio", "goal");
    for (task, peer, goal) in MOTION_RATIOS {
        let theirs = match peers.iter().find(|v| v["task"] == *task && v["peer"] == *peer) {
            Some(v) => v["points_per_s"].as_f64().unwrap_or(f64::NAN),
            None => rate(peer)?,
        };
        let speed = rate(task)?;
        let (ratio, goal) = (speed / theirs, verdict(speed / theirs, *goal));
        println!("{task:24} {peer:20} {theirs:12.3e} {speed:12.3e} {ratio:8.2} {goal:>8}");
    }
    for (task, fewest) in RATES {
        let speed = rate(task)?;
        println!("{task:24} {:20} {:>12} {speed:12.3e} {:>8} {:>8}", "", "", "", verdict(speed, Some(*fewest)));
    }
    let ns =
        |key: &str| Ok::<f64, String>(ours("automatic-longest-step")?["checksum"][key].as_f64().unwrap_or(f64::NAN));
    let (longest, median, first) = (ns("longest_ns")?, ns("median_ns")?, ns("first_ns")?);
    let verdict = if longest <= LONGEST_STEP { "ok" } else { "MISS" };
    println!("automatic-longest-step {longest:.0} ns, at most {LONGEST_STEP} ns: {verdict}");
    println!("median {median:.0} ns; the longest that meets a mode for the first time {:.1} us", 1e-3 * first);
    Ok(())
}

/// Sweeps through the command line: wall time of the whole program, the best of several runs.
fn study(root: &Path, python: &Path, wrong: &mut Vec<String>) -> Result<(), String> {
    println!("sweeps …");
    command(Command::new("cargo").current_dir(root).args([
        "build",
        "--profile",
        "dist",
        "--quiet",
        "-p",
        "willis-cli",
    ]))?;
    let willis = root.join("target/dist/willis");
    let mut c = Command::new(python);
    c.current_dir(root.join("benches/baselines")).args(["study.py", "--json"]).env("PYTHONDONTWRITEBYTECODE", "1");
    let out = c.output().map_err(|e| e.to_string())?;
    if !out.status.success() {
        return Err(format!("study.py: {}", String::from_utf8_lossy(&out.stderr)));
    }
    let peers = lines(&String::from_utf8_lossy(&out.stdout))?;
    let run = |arguments: &[&str], runs: usize| -> Result<(f64, Value), String> {
        let mut best = f64::INFINITY;
        let mut told = Value::Null;
        for _ in 0..runs {
            let started = std::time::Instant::now();
            let out = Command::new(&willis).current_dir(root).args(arguments).output().map_err(|e| e.to_string())?;
            best = best.min(started.elapsed().as_secs_f64());
            if !out.status.success() {
                return Err(String::from_utf8_lossy(&out.stderr).into_owned());
            }
            told = serde_json::from_slice(&out.stdout).map_err(|e| e.to_string())?;
        }
        Ok((best, told))
    };
    let map = ["sweep", "benches/map.toml", "--study", "map", "--fast", "--format", "json", "--threads"];
    let on = |threads: &'static str| [&map[..], &[threads]].concat();
    println!("\n{:24} {:20} {:>12} {:>12} {:>8} {:>8}", "task", "peer", "peer Mpt/s", "Willis Mpt/s", "ratio", "goal");
    for threads in ["1", "2"] {
        let (seconds, told) = run(&on(threads), 15)?;
        let points = told["points"].as_f64().unwrap_or(f64::NAN);
        for peer in &peers {
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
            let theirs = peer["points_per_s"].as_f64().unwrap_or(f64::NAN);
            let name = peer["peer"].as_str().unwrap_or_default();
            let goal = (name == "numpy-whole-array").then_some(20.0);
            let ratio = points / seconds / theirs;
            let task = format!("study-map, {threads} threads");
            let mpt = points / seconds / 1e6;
            println!("{task:24} {name:20} {:12.2} {mpt:12.2} {ratio:8.2} {:>8}", theirs / 1e6, verdict(ratio, goal));
        }
    }
    // A physical map: bearings, seals, windage.
    let table = root.join("target/willis-bench/physical.parquet");
    let table = table.to_str().ok_or("a path that is no text")?;
    let physical = [
        "sweep",
        "examples/fva-planetary-stage.toml",
        "--over",
        "sun.speed=100..3000 rpm:100",
        "--over",
        "sun.torque=50..1600 N m:100",
        "--format",
        "json",
        "--threads",
    ];
    let on = |threads: &'static str, more: &[&'static str]| [&physical[..], &[threads], more].concat();
    let (one, _) = run(&on("1", &[]), 3)?;
    let (two, _) = run(&on("2", &[]), 3)?;
    let with_table = [&physical[..], &["1", "--force", "--out", table]].concat();
    let (written, _) = run(&with_table, 3)?;
    println!("physical map of 10,000 points: {:.0} points/s on one thread, {:.0} on two", 1e4 / one, 1e4 / two);
    println!("two threads: {:.2} times one: {}", one / two, verdict(one / two, Some(1.8)));
    let share = (written / one - 1.0).max(0.0);
    let reached = if share <= 0.3 { "ok" } else { "MISS" };
    println!("writing Parquet: {:.1} % of the time to compute, at most 30 %: {reached}", 100.0 * share);
    Ok(())
}

/// Whether as much as asked for was reached.
fn verdict(value: f64, goal: Option<f64>) -> String {
    let Some(goal) = goal else { return String::new() };
    let number = if goal < 1e4 { goal.to_string() } else { format!("{goal:.1e}") };
    format!("{number} {}", if value >= goal { "ok" } else { "MISS" })
}

/// Seconds of the best sample of a criterion task.
fn best(root: &Path, task: &str) -> Result<f64, String> {
    for group in ["map", "automatic", "cold", "motion"] {
        let file = root.join(format!("target/criterion/{group}/{task}/new/sample.json"));
        let Ok(text) = fs::read_to_string(file) else { continue };
        let v: Value = serde_json::from_str(&text).map_err(|e| e.to_string())?;
        let numbers =
            |key: &str| -> Vec<f64> { v[key].as_array().into_iter().flatten().filter_map(Value::as_f64).collect() };
        let each = numbers("times").into_iter().zip(numbers("iters")).map(|(t, n)| t / n * 1e-9);
        return each.min_by(f64::total_cmp).ok_or_else(|| format!("{task}: no samples"));
    }
    Err(format!("{task}: criterion left no samples"))
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
