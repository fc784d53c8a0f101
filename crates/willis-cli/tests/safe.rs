//! What the README promises about files from strangers, output and interruption, seen from outside the program.

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::Duration;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// A folder of its own for each test.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("willis-safe-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn file(&self, name: &str) -> String {
        self.0.join(name).to_str().unwrap().to_owned()
    }

    fn write(&self, name: &str, text: &str) -> String {
        fs::write(self.0.join(name), text).unwrap();
        self.file(name)
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
    c.current_dir(root()).args(arguments).env("NO_COLOR", "1").stdin(Stdio::null());
    c
}

fn willis(arguments: &[&str]) -> Output {
    command(arguments).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// What it said on both streams; the status is as it should be.
fn says(arguments: &[&str], status: i32) -> String {
    let out = willis(arguments);
    let told = text(&out.stdout) + &text(&out.stderr);
    assert_eq!(out.status.code(), Some(status), "{arguments:?}: {told}");
    told
}

const FVA: &str = "examples/fva-planetary-stage.toml";

/// A train whose torque comes from a table of this name.
fn with_table(name: &str) -> String {
    format!(
        "format = 1\nname = \"wheel\"\nmembers = [\"a\"]\ninertias = {{ a = \"1 kg m^2\" }}\n[[scenario]]\nname = \"s\"\n\
         duration = \"1 s\"\n[[scenario.source]]\nmember = \"a\"\n\
         torque = {{ type = \"csv\", file = {name:?}, time = \"t\", value = \"torque\" }}\n"
    )
}

// ---- Time ---------------------------------------------------------------------------------

/// Sixty sets in series: the longest train there may be, nearly.
fn sixty_sets() -> String {
    let member = |k: usize| if k == 60 { "out".to_owned() } else { format!("c{k}") };
    let members: Vec<String> = (0..=60).map(|k| format!("{:?}", member(k))).collect();
    let sets = (0..60).map(|k| {
        let (sun, carrier) = (member(k), member(k + 1));
        format!(
            "[[set]]\nname = \"P{k}\"\nsun = {{ member = {sun:?}, teeth = 30 }}\nring = {{ member = \"frame\", teeth = 70 }}\n\
             carrier = {carrier:?}\nmesh_efficiency = 0.98\n"
        )
    });
    format!(
        "format = 1\nname = \"series\"\nmembers = [{}]\nterminals = [\"c0\", \"out\"]\n{}\
         [[operation]]\nname = \"o\"\nspeeds = {{ c0 = \"1000 rpm\" }}\ntorques = {{ c0 = \"10 N m\" }}\n",
        members.join(", "),
        sets.collect::<String>()
    )
}

/// What would take minutes is refused with its size and time, in words and as JSON; a report leaves it out and says so.
#[test]
fn what_takes_minutes_is_not_begun_unasked() {
    let folder = Folder::new("long");
    let train = folder.write("long.toml", &sixty_sets());
    let told = says(&["uncertainty", &train], 1);
    for word in ["error[E212]", "operating points", "of one core", "`yes`"] {
        assert!(told.contains(word), "{word}: {told}");
    }
    let json: serde_json::Value =
        serde_json::from_str(&text(&willis(&["uncertainty", &train, "--format", "json"]).stdout)).unwrap();
    assert_eq!(json["diagnostics"][0]["code"], "E212");
    let report = folder.file("long.html");
    says(&["report", &train, "-o", &report], 0);
    let written = fs::read_to_string(&report).unwrap();
    assert_eq!(written.matches("this picture could not be made. this takes long").count(), 2, "map and band");
    // Allowed, it goes on.
    says(&["draw", "stick", &train, "--yes", "-o", &folder.file("stick.svg")], 0);
    says(&["uncertainty", FVA, "--samples", "128", "--yes"], 0);
}

// ---- Files from strangers ------------------------------------------------------------------

/// A stranger's train file reads the tables in its own folder and nothing else, and tells nothing of what it did not
/// read, not even whether it is there.
#[test]
fn a_train_file_reads_only_tables_in_its_folder() {
    let folder = Folder::new("tables");
    let own = Folder::new("own");
    folder.write("secret.csv", "t,torque,hunter2\n0,swordfish\n");
    own.write("good.csv", "t,torque\n0,1\n1,2\n");
    fs::create_dir(own.file("below")).unwrap();
    own.write("below/deep.csv", "t,torque\n0,1\n1,2\n");
    let elsewhere = folder.0.file_name().unwrap().to_str().unwrap();
    let absolute = folder.file("secret.csv");
    for name in ["good.csv", "./good.csv", "below/deep.csv", "below/../good.csv"] {
        says(&["check", &own.write("train.toml", &with_table(name))], 0);
    }
    let outside = format!("../{elsewhere}/secret.csv");
    let missing = format!("../{elsewhere}/missing.csv");
    let through = format!("below/../../{elsewhere}/secret.csv");
    let mut names: Vec<&str> = vec![&absolute, &outside, &missing, &through];
    names.extend(["/proc/self/environ", "/etc/passwd", "/dev/zero", "..", "../..", "/", "", ".", "C:/secret.csv"]);
    for name in names {
        let train = own.write("train.toml", &with_table(name));
        for question in ["check", "analyze", "simulate"] {
            let told = says(&[question, &train], 1);
            let is_silent = ["hunter2", "swordfish", "PATH=", "root:"].iter().all(|s| !told.contains(s));
            assert!(is_silent && told.contains("E002"), "{name}: {told}");
        }
    }
    // Whether a file is there makes no difference.
    let [there, not_there] = [&outside, &missing].map(|name| {
        let told = says(&["check", &own.write("train.toml", &with_table(name))], 1);
        told.replace("secret", "missing").replace('^', "")
    });
    assert_eq!(there, not_there);
    assert!(there.contains("--allow FOLDER"), "{there}");
    // A folder that the user names.
    let train = own.write("train.toml", &with_table(&outside));
    folder.write("secret.csv", "t,torque\n0,1\n1,2\n");
    says(&["check", &train, "--allow", folder.0.to_str().unwrap()], 0);
    says(&["check", &train, "--allow", own.0.to_str().unwrap()], 1);
    // Told with the train on standard input: the folder is where the user is.
    let mut piped = command(&["check", "-"]);
    piped.current_dir(&own.0).stdin(fs::File::open(own.write("good.toml", &with_table("good.csv"))).unwrap());
    assert!(piped.output().unwrap().status.success());
    let mut piped = command(&["check", "-"]);
    piped.current_dir(&own.0).stdin(fs::File::open(&train).unwrap());
    assert_eq!(piped.output().unwrap().status.code(), Some(1));
}

/// What is wrong in a table is told by line and column, without what stands there: a table may be any file.
#[test]
fn a_table_is_never_quoted() {
    let folder = Folder::new("quoted");
    let train = folder.write("train.toml", &with_table("load.csv"));
    for table in [
        "hunter2\nhunter2\n",
        "t,torque\nhunter2,1\n",
        "t,torque\n0,hunter2\n",
        "t,hunter2\n0,1\n",
        "t,torque\nhunter2\n",
    ] {
        folder.write("load.csv", table);
        let told = says(&["check", &train], 1);
        assert!(!told.contains("hunter2") && told.contains("load.csv"), "{told}");
    }
}

#[cfg(unix)]
#[test]
fn links_and_pipes_are_no_tables() {
    use std::os::unix::fs::symlink;
    let folder = Folder::new("pipes");
    let other = Folder::new("other");
    other.write("secret.csv", "t,torque\n0,1\n1,2\n");
    let table = |name: &str| with_table(name);
    symlink(other.file("secret.csv"), folder.file("link.csv")).unwrap();
    symlink(&other.0, folder.file("linked")).unwrap();
    for name in ["link.csv", "linked/secret.csv"] {
        let told = says(&["check", &folder.write("train.toml", &table(name))], 1);
        assert!(told.contains("not in the folder of the train file"), "{told}");
        says(&["check", &folder.file("train.toml"), "--allow", other.0.to_str().unwrap()], 0);
    }
    // A link within the folder is a table like any other.
    folder.write("good.csv", "t,torque\n0,1\n1,2\n");
    symlink("good.csv", folder.file("same.csv")).unwrap();
    says(&["check", &folder.write("train.toml", &table("same.csv"))], 0);
    // A pipe that nobody writes into would be waited for without end.
    let pipe = folder.file("pipe.csv");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    for arguments in [
        vec!["check", &folder.write("train.toml", &table("pipe.csv"))],
        vec!["analyze", &pipe],
        vec!["cycle", FVA, "--profile", &pipe],
        vec!["merge", &pipe, "-o", &folder.file("merged.csv")],
    ] {
        let told = says(&arguments, 1);
        assert!(told.contains("no ordinary file") || told.contains("cannot be read"), "{told}");
    }
    // Beside a shard as well.
    let shard = folder.write("shard.csv", "x\n");
    assert!(Command::new("mkfifo").arg(format!("{shard}.json")).status().unwrap().success());
    assert!(says(&["merge", &shard, "-o", &folder.file("merged.csv")], 1).contains("no ordinary file"));
}

// ---- Output is never lost --------------------------------------------------------------------

/// Every command that writes: its arguments without the place, and the name of what it writes.
fn writers(folder: &Folder) -> Vec<(Vec<String>, &'static str)> {
    let line = |words: &str| words.split('|').map(str::to_owned).collect::<Vec<_>>();
    let braked = folder.write("braked.toml", BRAKED);
    vec![
        (line(&format!("analyze|{FVA}")), "a.json"),
        (line(&format!("analyze|{FVA}")), "a.csv"),
        (line(&format!("sweep|{FVA}|--over|sun.speed=1000..2000 rpm:3")), "s.csv"),
        (line(&format!("sweep|{FVA}|--over|sun.speed=1000..2000 rpm:3")), "s.json"),
        (line(&format!("uncertainty|{FVA}|--samples|128")), "u.json"),
        (line(&format!("draw|stick|{FVA}")), "d.svg"),
        (line(&format!("report|{FVA}")), "r.html"),
        (line(&format!("simulate|{braked}")), "run.csv"),
        (line(&format!("simulate|{braked}")), "run.json"),
        (line("new|set"), "new.toml"),
        (line("export|csv|examples/wolfrom-236.toml"), "e.csv"),
    ]
}

const BRAKED: &str = r#"format = 1
name = "braked wheel"
members = ["wheel"]
inertias = { wheel = "0.5 kg m^2" }

[[drag]]
name = "shoe"
members = ["wheel"]
coulomb = "2 N m"

[[scenario]]
name = "stop"
duration = "10 s"
initial_speeds = { wheel = "100 rad/s" }
"#;

/// Without `--force` nothing that is there is touched, with it a link is replaced and what it leads to stays; a folder
/// without room or permission gives an error and no file.
#[test]
fn every_command_writes_by_the_same_rule() {
    let folder = Folder::new("rule");
    for (arguments, name) in writers(&folder) {
        let place = |name: &str| {
            let mut all: Vec<String> = arguments.clone();
            all.extend(["-o".to_owned(), name.to_owned()]);
            all
        };
        let run = |all: &[String]| willis(&all.iter().map(String::as_str).collect::<Vec<_>>());
        let out = folder.file(name);
        let forced = [place(&out), vec!["--force".into()]].concat();
        fs::write(&out, "mine").unwrap();
        let done = run(&place(&out));
        assert_eq!(done.status.code(), Some(1), "{arguments:?}");
        assert!(
            text(&done.stderr).contains("is there already; --force replaces it"),
            "{arguments:?}: {}",
            text(&done.stderr)
        );
        assert_eq!(fs::read_to_string(&out).unwrap(), "mine");
        let done = run(&forced);
        assert!(done.status.success(), "{arguments:?}: {}", text(&done.stderr));
        let written = fs::read(&out).unwrap();
        assert!(written.len() > 20 && written != b"mine", "{arguments:?}");
        #[cfg(unix)]
        {
            let secret = folder.write("secret", "secret");
            fs::remove_file(&out).unwrap();
            std::os::unix::fs::symlink(&secret, &out).unwrap();
            assert_eq!(run(&place(&out)).status.code(), Some(1), "{arguments:?}");
            assert!(run(&forced).status.success(), "{arguments:?}");
            assert_eq!(fs::read_to_string(&secret).unwrap(), "secret", "{arguments:?}");
            assert!(fs::symlink_metadata(&out).unwrap().is_file());
        }
        for nowhere in [folder.file(&format!("nowhere/{name}")), format!("{FVA}/{name}")] {
            let done = run(&place(&nowhere));
            assert_eq!(done.status.code(), Some(1), "{arguments:?}");
            assert!(text(&done.stderr).contains(name), "{}", text(&done.stderr));
        }
        #[cfg(target_os = "linux")]
        {
            // Nobody may write there, not even the superuser.
            let done = run(&place(&format!("/proc/self/{name}")));
            assert_eq!(done.status.code(), Some(1), "{arguments:?}");
            // A limit on the size of files stands for the end of the disk.
            fs::remove_file(&out).unwrap();
            let _ = fs::remove_file(format!("{out}.json"));
            let before = folder.names();
            let words: Vec<String> = place(&out).iter().map(|a| format!("'{a}'")).collect();
            let line = format!("ulimit -f 0; trap '' XFSZ; exec {} {}", env!("CARGO_BIN_EXE_willis"), words.join(" "));
            let done = Command::new("bash").current_dir(root()).args(["-c", &line]).output().unwrap();
            assert_eq!(done.status.code(), Some(1), "{arguments:?}: {}", text(&done.stderr));
            assert!(text(&done.stderr).contains("large"), "{}", text(&done.stderr));
            let after: Vec<String> = folder.names().into_iter().filter(|n| !n.ends_with(".parts")).collect();
            assert_eq!(after, before, "{arguments:?}");
            let _ = fs::remove_dir_all(format!("{out}.parts"));
        }
    }
}

/// Where the tests write, nothing is left but whole files.
fn only_whole(folder: &Folder, name: &str, whole: &[u8], is_stream: bool) {
    for entry in folder.names() {
        assert!(!entry.ends_with(".willis-part"), "{entry}");
    }
    if let Ok(written) = fs::read(folder.file(name)) {
        // A run over time that was ended early is a whole file that says so.
        let is_early = is_stream && text(&written).lines().last().is_some_and(|l| l.starts_with("# interrupted"));
        assert!(written == whole || is_early, "{name}");
    }
}

fn begun(child: &mut Child, folder: &Folder) -> bool {
    loop {
        if child.try_wait().unwrap().is_some() {
            return false;
        }
        if folder.names().iter().any(|n| n.ends_with(".willis-part") || n.ends_with(".parts")) {
            return true;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// Killed or asked to end at any time, each long command leaves a whole file or none; the next run clears up what was
/// left and gives the whole.
#[cfg(unix)]
#[test]
fn ended_at_any_moment_no_half_file_stays() {
    let folder = Folder::new("ended");
    let braked = folder.write("braked.toml", BRAKED);
    let commands: [(&[&str], &str); 4] = [
        (&["simulate", &braked, "--samples", "300000"], "run.csv"),
        (&["sweep", FVA, "--over", "sun.speed=100..3000 rpm:40", "--over", "sun.torque=-800..1600 N m:31"], "map.csv"),
        (&["uncertainty", FVA, "--samples", "512"], "u.json"),
        (&["report", FVA], "r.html"),
    ];
    for (arguments, name) in commands {
        let out = folder.file(name);
        let all = [arguments, &["-o", &out]].concat();
        says(&all, 0);
        let whole = fs::read(&out).unwrap();
        for signal in ["-KILL", "-TERM", "-INT"] {
            for early in [true, false] {
                let _ = fs::remove_file(&out);
                let _ = fs::remove_file(format!("{out}.json"));
                let mut child = command(&all).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
                if !early {
                    begun(&mut child, &folder);
                }
                let _ = Command::new("kill").args([signal, &child.id().to_string()]).stderr(Stdio::null()).status();
                child.wait().unwrap();
                if signal != "-KILL" {
                    only_whole(&folder, name, &whole, name == "run.csv");
                } else if let Ok(written) = fs::read(&out) {
                    assert!(written == whole, "{name}");
                }
                // The next run: of a sweep it goes on, of the others it begins anew.
                let more: &[&str] = if Path::new(&out).exists() { &["--force"] } else { &[] };
                says(&[&all[..], more].concat(), 0);
                assert!(fs::read(&out).unwrap() == whole, "{name} after {signal}");
                let left = folder.names().into_iter().find(|n| n.ends_with(".willis-part") || n.ends_with(".parts"));
                assert_eq!(left, None, "{name} after {signal}");
            }
        }
    }
}

/// Two runs with one target: one of them writes it, the other is refused, and what is there is whole.
#[test]
fn two_at_once_make_one_whole_file() {
    let folder = Folder::new("two");
    let braked = folder.write("braked.toml", BRAKED);
    let commands: [(&[&str], &str); 4] = [
        (&["simulate", &braked, "--samples", "100000"], "run.csv"),
        (&["sweep", FVA, "--over", "sun.speed=100..3000 rpm:40", "--over", "sun.torque=-800..1600 N m:31"], "map.csv"),
        (&["uncertainty", FVA, "--samples", "128"], "u.json"),
        (&["report", FVA], "r.html"),
    ];
    for (arguments, name) in commands {
        let out = folder.file(name);
        let all = [arguments, &["-o", &out]].concat();
        let both: Vec<Child> =
            (0..2).map(|_| command(&all).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap()).collect();
        let ends: Vec<Output> = both.into_iter().map(|c| c.wait_with_output().unwrap()).collect();
        let good = ends.iter().filter(|e| e.status.success()).count();
        assert_eq!(good, 1, "{name}: {:?}", ends.iter().map(|e| text(&e.stderr)).collect::<Vec<_>>());
        let refused = ends.iter().find(|e| !e.status.success()).unwrap();
        let told = text(&refused.stderr);
        assert!(told.contains("is there already") || told.contains("another willis"), "{told}");
        let written = fs::read(&out).unwrap();
        says(&[&all[..], &["--force"]].concat(), 0);
        assert!(fs::read(&out).unwrap() == written, "{name}");
        assert!(folder.names().iter().all(|n| !n.ends_with(".willis-part") && !n.ends_with(".parts")));
    }
}

/// An answer for machines is valid or not there.
#[cfg(unix)]
#[test]
fn an_interrupted_answer_is_json_or_nothing() {
    for out in [None, Some("map.csv")] {
        let folder = Folder::new("json");
        let place = out.map(|o| folder.file(o));
        let mut all = vec!["sweep", FVA, "--format", "json", "--over", "sun.speed=100..3000 rpm:400"];
        all.extend(["--over", "sun.torque=-800..1600 N m:401"]);
        if let Some(place) = &place {
            all.extend(["-o", place]);
        }
        let mut child = command(&all).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        match out {
            Some(_) => drop(begun(&mut child, &folder)),
            None => std::thread::sleep(Duration::from_millis(300)),
        }
        let _ = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
        let status = child.wait().unwrap();
        let (mut said, mut told) = (String::new(), String::new());
        child.stdout.take().unwrap().read_to_string(&mut said).unwrap();
        child.stderr.take().unwrap().read_to_string(&mut told).unwrap();
        // Before the program listens the system ends it.
        assert!(status.code().is_none_or(|c| c == 130 || c == 0), "{status}: {told}");
        assert!(said.is_empty() || serde_json::from_str::<serde_json::Value>(&said).is_ok(), "{said}");
        assert!(status.code() != Some(130) || told.contains("interrupted"), "{told}");
    }
}
