//! Sweeps as processes: killed and taken up again, shared among machines, refused.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::Duration;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// A folder of its own for each test.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("willis-sweep-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn file(&self, name: &str) -> String {
        self.0.join(name).to_str().unwrap().to_owned()
    }

    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.0).unwrap();
        let mut all: Vec<String> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        all.sort();
        all
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn command(arguments: &[&str]) -> Command {
    let mut c = Command::new(env!("CARGO_BIN_EXE_willis"));
    c.current_dir(root()).args(arguments);
    c
}

fn willis(arguments: &[&str]) -> Output {
    command(arguments).output().unwrap()
}

fn fine(arguments: &[&str]) -> String {
    let out = willis(arguments);
    assert!(out.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&out.stderr));
    String::from_utf8(out.stdout).unwrap()
}

fn refused(arguments: &[&str]) -> String {
    let out = willis(arguments);
    assert_eq!(out.status.code(), Some(1), "{arguments:?}: {}", String::from_utf8_lossy(&out.stdout));
    String::from_utf8(out.stderr).unwrap()
}

const FVA: &str = "examples/fva-planetary-stage.toml";
const AXES: [&str; 4] = ["--over", "sun.speed=100..3000 rpm:40", "--over", "sun.torque=-800..1600 N m:31"];

fn sweep<'a>(out: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    let mut all = vec!["sweep", FVA];
    all.extend(AXES);
    all.extend(["--out", out]);
    all.extend(more);
    all
}

#[test]
fn killed_at_any_moment_it_goes_on_to_the_same_bytes() {
    for form in ["csv", "jsonl", "parquet"] {
        let folder = Folder::new(&format!("kill-{form}"));
        let (whole, killed) = (folder.file(&format!("whole.{form}")), folder.file(&format!("killed.{form}")));
        fine(&sweep(&whole, &[]));
        // Killed at once, then whenever there is more on the disk than at the kill before: however fast the machine is,
        // it comes further each time.
        let on_disk = || {
            let entries = fs::read_dir(format!("{killed}.parts")).ok()?;
            Some(entries.filter_map(|e| Some(e.ok()?.metadata().ok()?.len() + 1)).sum::<u64>())
        };
        let (mut reached, mut kills) = (None, 0);
        // Killed after its last piece of work, it is done all the same.
        let is_done = || Path::new(&killed).exists() && !Path::new(&format!("{killed}.parts")).exists();
        while !is_done() {
            let mut child = command(&sweep(&killed, &[])).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
            let ends = loop {
                if let Some(status) = child.try_wait().unwrap() {
                    break status.success();
                }
                if kills == 0 || on_disk() > reached {
                    break false;
                }
                std::thread::sleep(Duration::from_millis(1));
            };
            if ends {
                break;
            }
            let _ = child.kill();
            let ended = child.wait().unwrap();
            if ended.success() {
                break;
            }
            kills += 1;
            reached = reached.max(on_disk());
            // Never half a table.
            assert!(!Path::new(&killed).exists() || fs::read(&killed).unwrap() == fs::read(&whole).unwrap());
        }
        assert!(kills > 0, "{form}");
        if !Path::new(&killed).exists() {
            fine(&sweep(&killed, &[]));
        }
        assert_eq!(fs::read(&killed).unwrap(), fs::read(&whole).unwrap(), "{form}");
        let told = [&whole, &killed].map(|f| fs::read_to_string(format!("{f}.json")).unwrap());
        assert_eq!(told[0], told[1], "{form}");
        let left: Vec<String> =
            folder.names().into_iter().filter(|n| n.contains("parts") || n.contains("new")).collect();
        assert!(left.is_empty(), "{left:?}");
    }
}

#[test]
fn shards_make_the_whole_and_nothing_else_does() {
    for form in ["csv", "jsonl", "parquet"] {
        let folder = Folder::new(&format!("shards-{form}"));
        let file = |name: &str| folder.file(&format!("{name}.{form}"));
        let (whole, merged) = (file("whole"), file("merged"));
        fine(&sweep(&whole, &["--threads", "1"]));
        let shards: Vec<String> = (1..=3).map(|k| file(&format!("part{k}"))).collect();
        for (k, shard) in shards.iter().enumerate() {
            fine(&sweep(shard, &["--shard", &format!("{}/3", k + 1), "--threads", "2"]));
        }
        let merge = |parts: &[&String], out: &str| {
            let mut all = vec!["merge", "-o", out];
            all.extend(parts.iter().map(|p| p.as_str()));
            all.into_iter().map(str::to_owned).collect::<Vec<_>>()
        };
        let run = |parts: &[&String], out: &str| {
            let all = merge(parts, out);
            willis(&all.iter().map(String::as_str).collect::<Vec<_>>())
        };
        let out = run(&[&shards[2], &shards[0], &shards[1]], &merged);
        assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
        assert_eq!(fs::read(&merged).unwrap(), fs::read(&whole).unwrap(), "{form}");
        let told = [&whole, &merged].map(|f| fs::read_to_string(format!("{f}.json")).unwrap());
        assert_eq!(told[0], told[1]);

        let fails = |parts: &[&String], says: &str| {
            let out = run(parts, &file("no"));
            let told = String::from_utf8(out.stderr).unwrap();
            assert!(out.status.code() == Some(1) && told.contains(says), "{told}");
            assert!(!Path::new(&file("no")).exists());
        };
        fails(&[&shards[0], &shards[1]], "missing: shard 3 of 3");
        fails(&[&shards[0], &shards[1], &shards[1], &shards[2]], "given twice: shard 2");
        fails(&[&whole], "is a whole sweep, no shard");
        let other = file("other");
        fine(&sweep(&other, &["--shard", "3/3", "--law", "mesh_friction=niemann"]));
        fails(&[&shards[0], &shards[1], &other], "is of another sweep");
        fine(&sweep(&other, &["--shard", "3/4", "--force"]));
        fails(&[&shards[0], &shards[1], &other], "is shard 3 of 4");
        assert!(String::from_utf8(run(&[&shards[0]], &merged).stderr).unwrap().contains("--force"));
        // A table that is not the one that was written.
        let kept = fs::read(&shards[1]).unwrap();
        fs::write(&shards[1], &kept[..kept.len() / 2]).unwrap();
        fails(&[&shards[0], &shards[1], &shards[2]], "is not the table that was written");
        fs::copy(&shards[0], &shards[1]).unwrap();
        fails(&[&shards[0], &shards[1], &shards[2]], "is not the table that was written");
        let over = ["merge", "-o", &shards[0], &shards[0], &shards[1], &shards[2], "--force"];
        assert!(refused(&over).contains("is read here and cannot be written over"));
    }
}

#[test]
fn what_cannot_be_done_is_told_and_leaves_nothing() {
    let folder = Folder::new("refused");
    let out = folder.file("map.csv");
    fine(&sweep(&out, &[]));
    let bytes = fs::read(&out).unwrap();
    assert!(refused(&sweep(&out, &[])).contains("is there already; --force replaces it"));
    assert_eq!(fs::read(&out).unwrap(), bytes);
    fine(&sweep(&out, &["--force"]));
    let at = |name: &str, says: &str| {
        let told = refused(&sweep(&folder.file(name), &[]));
        assert!(told.contains(says), "{told}");
    };
    at("map.xlsx", "its ending is none of .txt, .json, .csv, .jsonl, .parquet");
    at("nowhere/map.csv", "its folder does not exist");
    fs::create_dir(folder.file("folder.csv")).unwrap();
    at("folder.csv", "is a directory");
    let long = |over: &[&str], says: &[&str]| {
        let mut all = vec!["sweep", FVA];
        all.extend(over.iter().flat_map(|o| ["--over", *o]));
        let told = refused(&all);
        assert!(says.iter().all(|s| told.contains(s)), "{told}");
    };
    long(
        &["sun.speed=100..3000 rpm:1000000", "sun.torque=1..1000 N m:1000000"],
        &["1,000,000,000,000 points would take about", "--yes"],
    );
    long(
        &["sun.sped=1..2 rpm:2", "sun.torque=5 N m..1 N m:2"],
        &["did you mean `sun.speed`", "runs backwards", "2 errors"],
    );
    long(&["sun.speed=1..2 rpm:2", "sun.speed=3..4 rpm:2"], &["varies along two axes"]);
    long(&[], &["nothing varies"]);
    // A point that makes no question is a row, wherever it stands; if none does, that is the answer.
    let text = fine(&["sweep", FVA, "--over", "P1.planet.teeth=40,22"]);
    assert!(text.contains("1 refused, 1 unique"), "{text}");
    long(&["P1.planet.teeth=40,41"], &["error"]);
    long(&["carrier.speed=1..2 rpm:2", "sun.speed=1..2 rpm:2"], &["E201"]);
    let told = refused(&["sweep", FVA, "--over", "sun.speed=1..2 rpm:2", "--columns", "sun.torqe_n_m"]);
    assert!(told.contains("did you mean `sun.torque_n_m`"), "{told}");
    let told = refused(&["sweep", FVA, "--over", "sun.speed=1..2 rpm:2", "--fast"]);
    assert!(told.contains("cannot be compiled"), "{told}");
    let told = refused(&["sweep", FVA, "--study", "maps"]);
    assert!(told.contains("no study `maps`"), "{told}");
    // Pieces of another sweep are not taken for one's own.
    let other = folder.file("other.csv");
    fs::create_dir(format!("{other}.parts")).unwrap();
    fs::write(format!("{other}.parts/study.json"), "{}").unwrap();
    fs::write(format!("{other}.parts/000000000.csv"), "1,2\n").unwrap();
    for force in [&[][..], &["--force"]] {
        // Nobody knows whose they are.
        assert!(refused(&sweep(&other, force)).contains("they are kept; move the folder to begin anew"));
        assert_eq!(fs::read_to_string(format!("{other}.parts/000000000.csv")).unwrap(), "1,2\n");
    }
    fs::remove_file(format!("{other}.parts/study.json")).unwrap();
    assert!(refused(&sweep(&other, &["--force"])).contains("they are kept; move the folder to begin anew"));
    fs::remove_dir_all(format!("{other}.parts")).unwrap();
    fine(&sweep(&other, &[]));
    assert_eq!(fs::read(&other).unwrap(), bytes);
    let left = |n: &String| n.ends_with(".parts") || n.ends_with(".willis-part");
    assert!(!folder.names().iter().any(left), "{:?}", folder.names());
}

/// A folder or a file beside the table that is somebody else's is never removed, overwritten or followed.
#[test]
fn what_stands_beside_the_table_stays() {
    let folder = Folder::new("beside");
    let out = folder.file("map.csv");
    let read = |name: &str| fs::read_to_string(folder.file(name)).unwrap();
    // A folder that only has the name.
    fs::create_dir(folder.file("map.csv.parts")).unwrap();
    fs::write(folder.file("map.csv.parts/thesis.tex"), "mine").unwrap();
    for force in [&[][..], &["--force"]] {
        assert!(refused(&sweep(&out, force)).contains("holds `thesis.tex`"), "{force:?}");
    }
    assert_eq!(read("map.csv.parts/thesis.tex"), "mine");
    // Even beside our own pieces: a folder of a name that a piece could have.
    fs::remove_dir_all(folder.file("map.csv.parts")).unwrap();
    fs::create_dir_all(folder.file("map.csv.parts/000000001.csv")).unwrap();
    assert!(refused(&sweep(&out, &["--force"])).contains("holds `000000001.csv`"));
    fs::remove_dir_all(folder.file("map.csv.parts")).unwrap();
    fs::write(folder.file("map.csv.parts"), "mine").unwrap();
    assert!(refused(&sweep(&out, &["--force"])).contains("something else is"));
    assert_eq!(read("map.csv.parts"), "mine");
    fs::remove_file(folder.file("map.csv.parts")).unwrap();
    // What is said beside the table is under the same rule.
    fs::write(folder.file("map.csv.json"), "mine").unwrap();
    assert!(refused(&sweep(&out, &[])).contains("map.csv.json: is there already"));
    assert_eq!((read("map.csv.json").as_str(), folder.names().len()), ("mine", 1));
    fine(&sweep(&out, &["--force"]));
    assert!(read("map.csv.json").contains("willis-sweep-1"));
    // Files of other programs with names that were once used for unfinished ones.
    for name in ["map.csv.new", "map.csv.lock", "map.csv.body"] {
        fs::write(folder.file(name), "mine").unwrap();
    }
    fine(&sweep(&out, &["--force"]));
    let shard = folder.file("part.csv");
    fs::write(folder.file("part.csv.body"), "mine").unwrap();
    fine(&sweep(&shard, &["--shard", "1/1"]));
    fine(&["merge", &shard, "-o", &folder.file("all.csv")]);
    for name in ["map.csv.new", "map.csv.lock", "map.csv.body", "part.csv.body"] {
        assert_eq!(read(name), "mine");
    }
    // A merged table and what is said beside it, likewise.
    fs::write(folder.file("again.csv.json"), "mine").unwrap();
    assert!(refused(&["merge", &shard, "-o", &folder.file("again.csv")]).contains("again.csv.json: is there already"));
    assert_eq!(read("again.csv.json"), "mine");
}

#[cfg(unix)]
#[test]
fn links_beside_the_table_lead_nowhere() {
    use std::os::unix::fs::symlink;
    let folder = Folder::new("links");
    let out = folder.file("map.csv");
    let secret = folder.file("secret");
    fs::write(&secret, "secret").unwrap();
    let read = || fs::read_to_string(&secret).unwrap();
    symlink(&secret, folder.file("map.csv.json")).unwrap();
    assert!(refused(&sweep(&out, &[])).contains("map.csv.json: is there already"));
    fine(&sweep(&out, &["--force"]));
    assert_eq!(read(), "secret");
    assert!(fs::symlink_metadata(folder.file("map.csv.json")).unwrap().is_file());
    // The folder of pieces as a link; the lock in it as a link.
    let other = folder.file("other.csv");
    fs::create_dir(folder.file("elsewhere")).unwrap();
    symlink(folder.file("elsewhere"), folder.file("other.csv.parts")).unwrap();
    assert!(refused(&sweep(&other, &["--force"])).contains("something else is"));
    fs::remove_file(folder.file("other.csv.parts")).unwrap();
    fs::create_dir(folder.file("other.csv.parts")).unwrap();
    symlink(&secret, folder.file("other.csv.parts/willis.lock")).unwrap();
    assert!(refused(&sweep(&other, &["--force"])).contains("holds `willis.lock`"));
    assert_eq!(read(), "secret");
}

/// Killed while it tidied up, a sweep is whole: the next run tells it and clears away what is left.
#[test]
fn killed_at_the_last_moment_it_is_done() {
    let folder = Folder::new("last");
    let out = folder.file("map.csv");
    let run = |more: &[&str]| sweep(&out, more).into_iter().map(str::to_owned).collect::<Vec<_>>();
    let words = |all: &[String]| fine(&all.iter().map(String::as_str).collect::<Vec<_>>());
    let told = words(&run(&[]));
    let [table, said] = [&out, &format!("{out}.json")].map(|f| fs::read(f).unwrap());
    // The marker of the folder is that of an interrupted run.
    let marker = {
        let other = folder.file("begun.csv");
        let mut child = command(&sweep(&other, &["--threads", "1"])).stdout(Stdio::null()).spawn().unwrap();
        let at = format!("{other}.parts/study.json");
        loop {
            if let Ok(text) = fs::read(&at) {
                break text;
            }
            assert!(child.try_wait().unwrap().is_none(), "it ended before anybody looked");
        }
        .tap(|_| {
            let _ = child.kill();
            let _ = child.wait();
        })
    };
    let parts = format!("{out}.parts");
    let tidy = |with_report: bool, with_table: bool, with_said: bool| {
        fs::create_dir(&parts).unwrap();
        fs::write(format!("{parts}/study.json"), &marker).unwrap();
        fs::write(format!("{parts}/willis.lock"), "").unwrap();
        fs::write(format!("{parts}/000000000.csv.aB3dE6.willis-part"), "half").unwrap();
        fs::write(format!("{out}.aB3dE6.willis-part"), "half").unwrap();
        if with_report {
            fs::write(format!("{parts}/report.json"), &said).unwrap();
        }
        if !with_table {
            fs::remove_file(&out).unwrap();
        }
        if !with_said {
            fs::remove_file(format!("{out}.json")).unwrap();
        }
    };
    for (with_report, with_table, with_said) in
        [(true, true, true), (true, true, false), (true, false, false), (false, false, false)]
    {
        tidy(with_report, with_table, with_said);
        assert_eq!(words(&run(&[])), told);
        assert_eq!((fs::read(&out).unwrap(), fs::read(format!("{out}.json")).unwrap()), (table.clone(), said.clone()));
        let left: Vec<String> = folder.names().into_iter().filter(|n| n.starts_with("map")).collect();
        assert_eq!(left, ["map.csv", "map.csv.json"]);
    }
    // A table that is not ours stays what it is.
    tidy(true, true, true);
    fs::write(&out, "mine").unwrap();
    assert!(refused(&sweep(&out, &[])).contains("map.csv: is there already"));
    assert_eq!(fs::read_to_string(&out).unwrap(), "mine");
}

/// A value, after something was done beside it.
trait Tap: Sized {
    fn tap(self, beside: impl FnOnce(&Self)) -> Self {
        beside(&self);
        self
    }
}

impl<T> Tap for T {}

#[test]
fn a_damaged_piece_is_made_again() {
    let folder = Folder::new("damaged");
    let (whole, cut) = (folder.file("whole.csv"), folder.file("cut.csv"));
    fine(&sweep(&whole, &[]));
    // What a machine that lost its power may leave: a piece that is told of and is not whole.
    let mut child = command(&sweep(&cut, &["--threads", "1"])).stdout(Stdio::null()).spawn().unwrap();
    let first = format!("{cut}.parts/000000000");
    while child.try_wait().unwrap().is_none() && !Path::new(&format!("{first}.json")).exists() {
        std::thread::sleep(Duration::from_millis(1));
    }
    let _ = child.kill();
    let _ = child.wait();
    if let Ok(piece) = fs::read(format!("{first}.csv")) {
        fs::write(format!("{first}.csv"), &piece[..piece.len() / 3]).unwrap();
        // Or one whose bytes are there and what is told of it is not.
        let told = format!("{cut}.parts/000000001.json");
        if Path::new(&told).exists() {
            fs::write(&told, "").unwrap();
        }
        fine(&sweep(&cut, &[]));
    }
    assert_eq!(fs::read(&cut).unwrap(), fs::read(&whole).unwrap());
}

#[test]
fn what_is_read_is_never_written_over() {
    let folder = Folder::new("apart");
    let train = folder.file("train.toml");
    fs::copy(root().join(FVA), &train).unwrap();
    let text = fs::read(&train).unwrap();
    let told = refused(&["export", "csv", &train, "-o", &train, "--force"]);
    assert!(told.contains("cannot be written over"), "{told}");
    let profile = folder.file("profile.csv");
    fs::write(&profile, "hours,sun.speed [rpm]\n1,1000\n").unwrap();
    let told = refused(&["cycle", &train, "--profile", &profile, "--rows", &profile, "--force"]);
    assert!(told.contains("cannot be written over"), "{told}");
    assert_eq!(fs::read(&train).unwrap(), text);
}

/// Every disk is full at some point: a table that cannot be written is told, and what is finished stays.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_told() {
    let folder = Folder::new("full");
    let out = folder.file("map.csv");
    // A limit on the size of files stands for the end of the disk.
    let line = format!("ulimit -f 8; trap '' XFSZ; exec {} {}", env!("CARGO_BIN_EXE_willis"), {
        let all: Vec<String> = sweep(&out, &["--columns", "all"]).iter().map(|a| format!("'{a}'")).collect();
        all.join(" ")
    });
    let done = Command::new("bash").current_dir(root()).args(["-c", &line]).output().unwrap();
    let told = String::from_utf8(done.stderr).unwrap();
    assert_eq!(done.status.code(), Some(1), "{told}");
    assert!(told.contains("large") || told.contains("space"), "{told}");
    assert!(told.contains("the same command goes on from there"), "{told}");
    assert!(!Path::new(&out).exists());
    fine(&sweep(&out, &["--columns", "all"]));
}

#[test]
fn the_tables_say_the_same() {
    let folder = Folder::new("forms");
    let over = ["--over", "output.torque=-20,20 N m", "--over", "state=all"];
    let file = |name: &str| folder.file(name);
    for name in ["a.csv", "a.jsonl", "a.parquet"] {
        let out = file(name);
        let mut all = vec!["sweep", "examples/zf-8hp70.toml", "--out", &out, "--columns", "members"];
        all.extend(over);
        fine(&all);
    }
    let csv = fs::read_to_string(file("a.csv")).unwrap();
    let header: Vec<&str> = csv.lines().next().unwrap().split(',').collect();
    let lines = fs::read_to_string(file("a.jsonl")).unwrap();
    let read = parquet::file::reader::SerializedFileReader::new(fs::File::open(file("a.parquet")).unwrap()).unwrap();
    use parquet::file::reader::FileReader;
    let rows: Vec<_> = read.get_row_iter(None).unwrap().map(|r| r.unwrap()).collect();
    assert_eq!((csv.lines().count() - 1, lines.lines().count()), (18, 18));
    assert_eq!(rows.len(), 18);
    let unique: std::collections::HashSet<_> = header.iter().collect();
    assert_eq!(unique.len(), header.len(), "{header:?}");
    // After the header.
    for ((row, json), columns) in csv.lines().skip(1).zip(lines.lines()).zip(&rows) {
        let json: serde_json::Map<String, serde_json::Value> = serde_json::from_str(json).unwrap();
        assert_eq!(json.keys().map(String::as_str).collect::<Vec<_>>(), header);
        for ((cell, value), (name, field)) in row.split(',').zip(json.values()).zip(columns.get_column_iter()) {
            let shown = match value {
                serde_json::Value::String(s) => s.clone(),
                serde_json::Value::Null => String::new(),
                number => number.to_string(),
            };
            let same = cell == shown || cell.parse::<f64>().ok() == shown.parse::<f64>().ok();
            assert!(same, "{name}: {cell} and {shown}");
            match field {
                parquet::record::Field::Double(x) => assert_eq!(cell.parse::<f64>().unwrap(), *x, "{name}"),
                parquet::record::Field::Str(s) => assert_eq!(cell, s, "{name}"),
                parquet::record::Field::Null => assert_eq!(cell, "", "{name}"),
                other => panic!("{name}: {other:?}"),
            }
        }
    }
}
