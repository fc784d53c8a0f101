//! Files that somebody made to do harm: hundreds of them, generated from the examples, through every command. Each run
//! ends with an answer or a clear error, within bounds of time and memory, and says nothing that a terminal obeys.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// A generator of numbers: the same every time.
struct Dice(u64);

impl Dice {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        self.0 >> 33
    }

    fn below(&mut self, n: usize) -> usize {
        if n == 0 { 0 } else { self.next() as usize % n }
    }

    fn of<T: Clone>(&mut self, all: &[T]) -> T {
        all[self.below(all.len())].clone()
    }
}

const NUMBERS: &[&str] = &[
    "0",
    "-1",
    "-0",
    "0.0",
    "1e308",
    "-1e308",
    "1e-308",
    "4.9e-324",
    "nan",
    "inf",
    "-inf",
    "99999999999999999999",
    "9223372036854775807",
    "-9223372036854775808",
    "0x7fffffffffffffff",
    "0.1e-400",
    "3.0000000000000004",
    "1_000",
    "100000",
    "100001",
    "1e5",
    "2.5",
    "true",
    "[]",
    "{}",
    "\"\"",
    "1979-05-27",
];

const TEXTS: &[&str] = &[
    "\"\"",
    "\" \"",
    "\"frame\"",
    "\"\\u0000\"",
    "\"\\u001b[31mred\"",
    "\"\\u009b31m\"",
    "\"\\u202eevil\"",
    "\"\\u2066x\"",
    "\"\\uffff\"",
    "\"\\ufdd0\"",
    "\"a.b\"",
    "\"../../../etc/passwd\"",
    "\"/proc/self/environ\"",
    "\"<script>alert(1)</script>\"",
    "\"' onload='x\"",
    "\"]]>\"",
    "\"--><x>\"",
    "\"%s%n%x\"",
    "\"=1+1\"",
    "\"$(id)\"",
    "\"`id`\"",
    "\"\\n\\r\\t\"",
    "\"\\\\\"",
    "\"\\\"\"",
    "\"\u{301}\u{301}\u{301}\u{301}\"",
    "\"😀\"",
    "\"\u{5d0}\u{5d1}\"",
    "\"NaN rpm\"",
    "\"1e999 rpm\"",
    "\"-1e308 N m\"",
    "\"0 rpm\"",
    "\"1 furlong\"",
    "\"∞ rpm\"",
    "\"1 rpm rpm\"",
    "\"1/0\"",
    "\"1/3\"",
    "\"1e-400 mm\"",
    "\"99999999999999999999/7\"",
    "\"t\"",
    "\"((((((((((t\"",
    "\"t^t^t^t^t^t\"",
    "\"1/(t-t)\"",
    "\"sin(1e308*t)\"",
    "12",
    "[1, 2]",
    "{ a = 1 }",
];

/// Numbers of a text: where they begin and end.
fn spans(text: &str, is_part: impl Fn(char) -> bool, starts: impl Fn(char) -> bool) -> Vec<(usize, usize)> {
    let mut all = vec![];
    let mut begun: Option<usize> = None;
    for (k, c) in text.char_indices() {
        match begun {
            None if starts(c) => begun = Some(k),
            Some(from) if !is_part(c) => {
                all.push((from, k));
                begun = None;
            }
            _ => {}
        }
    }
    all
}

/// Quoted texts that stand on one line.
fn quoted(text: &str) -> Vec<(usize, usize)> {
    let mut all = vec![];
    let mut at = 0;
    for line in text.split_inclusive('\n') {
        let marks: Vec<usize> = line.match_indices('"').map(|m| at + m.0).collect();
        all.extend(marks.chunks_exact(2).map(|m| (m[0], m[1] + 1)));
        at += line.len();
    }
    all
}

fn replaced(text: &str, (from, to): (usize, usize), new: &str) -> String {
    format!("{}{new}{}", &text[..from], &text[to..])
}

/// A way to spoil a file.
type Spoiler = fn(&str, &mut Dice) -> Vec<u8>;

const SPOILERS: &[(&str, Spoiler)] = &[
    ("cut", |text, dice| text.as_bytes()[..dice.below(text.len())].to_vec()),
    ("number", |text, dice| {
        let mut text = text.to_owned();
        for _ in 0..1 + dice.below(4) {
            let all = spans(&text, |c| c.is_ascii_digit() || c == '.', |c| c.is_ascii_digit());
            if let Some(span) = all.get(dice.below(all.len())).copied() {
                text = replaced(&text, span, dice.of(NUMBERS));
            }
        }
        text.into_bytes()
    }),
    ("text", |text, dice| {
        let mut text = text.to_owned();
        for _ in 0..1 + dice.below(3) {
            let all = quoted(&text);
            if let Some(span) = all.get(dice.below(all.len())).copied() {
                text = replaced(&text, span, dice.of(TEXTS));
            }
        }
        text.into_bytes()
    }),
    ("name everywhere", |text, dice| {
        // A name keeps its meaning: what was a train stays one, with a name that is hard to show.
        let all = quoted(text);
        let Some((from, to)) = all.get(dice.below(all.len())).copied() else { return text.into() };
        text.replace(&text[from..to], dice.of(TEXTS)).into_bytes()
    }),
    ("line out", |text, dice| {
        let mut lines: Vec<&str> = text.lines().collect();
        for _ in 0..1 + dice.below(5) {
            lines.remove(dice.below(lines.len().saturating_sub(1)));
        }
        lines.join("\n").into_bytes()
    }),
    ("line twice", |text, dice| {
        let mut lines: Vec<&str> = text.lines().collect();
        let (from, to) = (dice.below(lines.len()), dice.below(lines.len()));
        lines.insert(to, lines[from]);
        lines.join("\n").into_bytes()
    }),
    ("lines swapped", |text, dice| {
        let mut lines: Vec<&str> = text.lines().collect();
        for _ in 0..3 {
            let (a, b) = (dice.below(lines.len()), dice.below(lines.len()));
            lines.swap(a, b);
        }
        lines.join("\n").into_bytes()
    }),
    ("table many times", |text, dice| {
        let blocks: Vec<&str> = text.split("\n[[").collect();
        let Some(block) = blocks.get(1 + dice.below(blocks.len() - 1)) else { return text.into() };
        let mut out = text.to_owned();
        let times = dice.of(&[2, 20, 300]);
        for k in 0..times {
            // With a name of its own, or with the same.
            let named = if dice.below(4) > 0 {
                block.replacen("name = \"", &format!("name = \"{k} "), 1)
            } else {
                (*block).into()
            };
            out += &format!("\n[[{named}");
        }
        out.into_bytes()
    }),
    ("deep", |text, dice| {
        let n = dice.of(&[100, 2_000, 50_000]);
        let what = match dice.below(4) {
            0 => format!("x = {}{}", "[".repeat(n), "]".repeat(n)),
            1 => format!("x = {}1{}", "{a=".repeat(n), "}".repeat(n)),
            2 => format!("{} = 1", vec!["a"; n].join(".")),
            _ => format!("members = [{}]", vec!["\"m\""; n].join(", ")),
        };
        match dice.below(2) {
            0 => format!("{what}\n{text}").into_bytes(),
            _ => format!("{text}\n{what}\n").into_bytes(),
        }
    }),
    ("unknown keys", |text, dice| {
        let n = dice.of(&[3, 100, 5_000]);
        let keys: String = (0..n).map(|k| format!("clutch{k} = {k}\n")).collect();
        format!("{keys}{text}").into_bytes()
    }),
    ("bytes", |text, dice| {
        let mut bytes = text.as_bytes().to_vec();
        for _ in 0..1 + dice.below(8) {
            let k = dice.below(bytes.len());
            bytes[k] = dice.next() as u8;
        }
        bytes
    }),
    ("line ends", |text, dice| match dice.below(4) {
        0 => text.replace('\n', "\r\n").into_bytes(),
        1 => text.replace('\n', "\r").into_bytes(),
        2 => format!("\u{feff}{text}").into_bytes(),
        _ => text.replace('\n', "\u{2028}").into_bytes(),
    }),
];

/// Profiles and tables, by what is odd about them.
fn tables() -> Vec<(&'static str, Vec<u8>)> {
    let many = |n: usize, piece: &str| piece.repeat(n).into_bytes();
    vec![
        ("empty", vec![]),
        ("one byte", vec![0xff]),
        ("commas", many(100_000, ",")),
        ("lines of commas", many(2_000, ",,,,,,,,,,,,,,,,,,,,,,,,,,,,,,\n")),
        ("long line", [b"time [s],sun.speed [rpm]\n".to_vec(), many(300_000, "1")].concat()),
        ("quotes", many(50_000, "\"")),
        ("many columns", (0..6_000).map(|k| format!("sun{k}.speed [rpm],")).collect::<String>().into_bytes()),
        ("many errors", [b"time [s],sun.speed [rpm]\n".to_vec(), many(20_000, "x,y\n")].concat()),
        ("control", "time [s],sun.speed\u{9b}31m [rpm]\n0,\u{1b}[31m\n1,\u{202e}\n".into()),
        ("numbers", b"time [s],sun.speed [rpm]\n0,1e308\n1e-300,-1e308\n1e300,0\n".to_vec()),
        ("many rows", {
            let rows: String = (0..3_000).map(|k| format!("{k},{}\n", k % 17)).collect();
            format!("time [s],sun.speed [rpm]\n{rows}").into_bytes()
        }),
    ]
}

/// What is asked of each file; `FILE` stands for it. Every file gets the first two and some of the others.
const QUESTIONS: &[&[&str]] = &[
    &["check", "FILE"],
    &["analyze", "FILE", "--format", "json"],
    &["analyze", "FILE"],
    &["flow", "FILE"],
    &["losses", "FILE"],
    &["sensitivity", "FILE", "--format", "json"],
    &["regimes", "FILE"],
    &["formula", "FILE"],
    &["simulate", "FILE", "--samples", "50"],
    &["modes", "FILE"],
    &["draw", "stick", "FILE"],
    &["draw", "lever", "FILE"],
    &["draw", "sankey", "FILE"],
    &["report", "FILE"],
    &["export", "csv", "FILE"],
    &["export", "modelica", "FILE"],
    &["locate", "FILE"],
    &["compare", "FILE", "FILE"],
    &["uncertainty", "FILE", "--samples", "128"],
    &["sweep", "FILE", "--over", "state=all"],
];

/// Runs a command within bounds and looks at what it says.
fn run(folder: &Path, arguments: &[&str]) {
    // Far above what any of them takes; an endless loop or a flood of memory ends here on the slowest machine.
    const MOST_CPU_S: u32 = 120;
    const MOST_KIB: u32 = 3 << 20;
    const MOST_SAID: usize = 8 << 20;
    let line = format!("ulimit -t {MOST_CPU_S} -v {MOST_KIB}; exec \"$@\"");
    let mut command = Command::new("bash");
    command.args(["-c", &line, "bash", env!("CARGO_BIN_EXE_willis")]).args(arguments);
    let done = command.current_dir(folder).env("NO_COLOR", "1").output().unwrap();
    let told = String::from_utf8_lossy(&done.stderr);
    let said = String::from_utf8(done.stdout).unwrap_or_else(|_| panic!("{arguments:?}: no text"));
    let end: String = told.chars().take(2_000).collect();
    let fault = |what: &str| panic!("{what}: {arguments:?}: {}\n{end}", done.status);
    if !matches!(done.status.code(), Some(0..=2)) || told.contains("panicked") {
        fault("no proper end");
    }
    if said.len() + told.len() > MOST_SAID {
        fault("a flood");
    }
    if done.status.code() != Some(0) && told.trim().is_empty() {
        fault("refused without a word");
    }
    let obeyed = |c: char| {
        let bidi = matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
        c.is_control() && c != '\n' || bidi
    };
    for text in [&said, &*told] {
        if let Some(c) = text.chars().find(|c| obeyed(*c)) {
            fault(&format!("{c:?} reaches the terminal"));
        }
    }
    if arguments.contains(&"json") && !said.is_empty() {
        match serde_json::from_str::<Value>(&said) {
            Ok(value) => assert!(value["format"].is_string()),
            Err(e) => fault(&format!("no JSON: {e}")),
        }
    }
    if let ("draw", Err(e)) = (arguments[0], roxmltree::Document::parse(&said))
        && !said.is_empty()
    {
        fault(&format!("no XML: {e}"));
    }
}

/// Runs all of them on a few threads.
fn all(folder: &Path, lines: &[Vec<String>]) {
    let next = std::sync::atomic::AtomicUsize::new(0);
    let one = || {
        while let Some(line) = lines.get(next.fetch_add(1, std::sync::atomic::Ordering::Relaxed)) {
            run(folder, &line.iter().map(String::as_str).collect::<Vec<_>>());
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(2, usize::from).min(8) {
            scope.spawn(one);
        }
    });
}

fn folder(name: &str) -> PathBuf {
    let path = std::env::temp_dir().join(format!("willis-hostile-{name}-{}", std::process::id()));
    let _ = fs::remove_dir_all(&path);
    fs::create_dir_all(&path).unwrap();
    path
}

#[cfg(target_os = "linux")]
#[test]
fn spoiled_trains_do_no_harm() {
    /// Files of each kind.
    const EACH: usize = 28;
    let folder = folder("trains");
    let mut examples: Vec<PathBuf> =
        fs::read_dir(root().join("examples")).unwrap().map(|e| e.unwrap().path()).collect();
    examples.retain(|p| p.extension().is_some_and(|e| e == "toml"));
    examples.sort();
    let texts: Vec<String> = examples.iter().map(|p| fs::read_to_string(p).unwrap()).collect();
    let (mut dice, mut lines, mut files) = (Dice(7), vec![], 0);
    for (kind, spoil) in SPOILERS {
        for k in 0..EACH {
            let text = dice.of(&texts);
            let name = format!("{}-{k}.toml", kind.replace(' ', "-"));
            fs::write(folder.join(&name), spoil(&text, &mut dice)).unwrap();
            files += 1;
            let mut asked: Vec<usize> = vec![0, 1];
            // One after the other, so that every kind of file meets every question.
            asked.extend((0..2).map(|j| 2 + (files * 2 + j) % (QUESTIONS.len() - 2)));
            lines.extend(asked.into_iter().map(|q| {
                QUESTIONS[q]
                    .iter()
                    .map(|w| if *w == "FILE" { name.clone() } else { (*w).to_owned() })
                    .collect::<Vec<_>>()
            }));
        }
    }
    assert!(files >= 300);
    all(&folder, &lines);
    // Nothing was written, by whatever name.
    assert_eq!(fs::read_dir(&folder).unwrap().count(), files);
    fs::remove_dir_all(&folder).unwrap();
}

#[cfg(target_os = "linux")]
#[test]
fn spoiled_tables_do_no_harm() {
    let folder = folder("tables");
    fs::copy(root().join("examples/fva-planetary-stage.toml"), folder.join("stage.toml")).unwrap();
    let mut lines = vec![];
    for (name, bytes) in tables() {
        let file = format!("{}.csv", name.replace(' ', "-"));
        fs::write(folder.join(&file), bytes).unwrap();
        let train = format!("{file}.toml");
        let text = format!(
            "format = 1\nname = \"wheel\"\nmembers = [\"a\"]\ninertias = {{ a = \"1 kg m^2\" }}\n[[scenario]]\nname = \"s\"\n\
             duration = \"1 s\"\n[[scenario.source]]\nmember = \"a\"\n\
             torque = {{ type = \"csv\", file = {file:?}, time = \"time [s]\", value = \"sun.speed [rpm]\" }}\n"
        );
        fs::write(folder.join(&train), text).unwrap();
        let line = |words: &[&str]| words.iter().map(|w| (*w).to_owned()).collect::<Vec<_>>();
        lines.push(line(&["cycle", "stage.toml", "--profile", &file]));
        lines.push(line(&["cycle", "stage.toml", "--profile", &file, "--format", "json"]));
        lines.push(line(&["check", &train]));
        lines.push(line(&["simulate", &train, "--samples", "20", "--format", "json"]));
        lines.push(line(&["merge", &file, "-o", "merged.csv"]));
    }
    all(&folder, &lines);
    fs::remove_dir_all(&folder).unwrap();
}

/// What a user types can be as odd as a file.
#[cfg(target_os = "linux")]
#[test]
fn spoiled_requests_do_no_harm() {
    let folder = folder("requests");
    fs::copy(root().join("examples/zf-8hp70.toml"), folder.join("zf.toml")).unwrap();
    let mut lines = vec![];
    let odd = [
        "",
        " ",
        "\u{1b}[31m",
        "\u{9b}31m",
        "\u{202e}x",
        "\u{ffff}",
        "-1",
        "1e308",
        "nan",
        "=",
        "a=b=c",
        "..",
        "1..2",
        "1..2:0",
        "1..2:99999999999999999999",
        "0..1 rpm:1e9",
        "\u{301}",
        "'\"<>&",
        "%s",
        "999999999999999999999999999999",
    ];
    for text in odd {
        for words in [
            vec!["analyze", "zf.toml", "--state", text],
            vec!["analyze", "zf.toml", "--set", text],
            vec!["analyze", "zf.toml", "--law", text],
            vec!["analyze", text],
            vec!["sweep", "zf.toml", "--over", text],
            vec!["sweep", "zf.toml", "--over", "output.torque=1..2 N m:2", "--columns", text],
            vec!["uncertainty", "zf.toml", "--samples", "128", "--vary", text],
            vec!["export", "csv", "zf.toml", "--state", "1", "--speeds", text],
            vec!["regimes", "zf.toml", "--terminals", text],
            vec!["explain", text],
            vec!["draw", text, "zf.toml"],
        ] {
            lines.push(words.into_iter().map(str::to_owned).collect::<Vec<_>>());
        }
    }
    all(&folder, &lines);
    fs::remove_dir_all(&folder).unwrap();
}
