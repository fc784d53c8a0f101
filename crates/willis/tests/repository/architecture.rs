//! lib.rs lists the modules in pipeline order; a module uses only those above it. The physics
//! touches no file, clock, environment or thread.

use std::fs;
use std::path::{Path, PathBuf};

fn rust_files(dir: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(dir).unwrap().map(|e| e.unwrap().path());
    entries.flat_map(|p| if p.is_dir() { rust_files(&p) } else { vec![p] }).collect()
}

fn src() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

/// Code without comments.
fn code(path: &Path) -> String {
    let text = fs::read_to_string(path).unwrap();
    text.lines().map(|l| l.split("//").next().unwrap_or_default()).collect::<Vec<_>>().join("\n")
}

/// Modules named after `crate::`, also in `crate::{a, b::c}`.
fn used(code: &str) -> Vec<String> {
    let word = |t: &str| t.trim().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect::<String>();
    code.split("crate::")
        .skip(1)
        .flat_map(|rest| match rest.strip_prefix('{') {
            Some(list) => list.split("};").next().unwrap().split(',').map(word).collect::<Vec<_>>(),
            None => vec![word(rest)],
        })
        .collect()
}

#[test]
fn a_module_uses_only_those_above_it() {
    let lib = fs::read_to_string(src().join("lib.rs")).unwrap();
    let order: Vec<_> = lib.lines().filter_map(|l| l.strip_prefix("pub mod ")?.strip_suffix(';')).collect();
    assert!(order.len() > 5);
    // The root exports `Real` under its own name.
    let rank = |m: &str| order.iter().position(|o| *o == if m == "Real" { "real" } else { m });
    for file in rust_files(&src()) {
        let path = file.strip_prefix(src()).unwrap().to_str().unwrap().to_owned();
        let own = path.split(['/', '.']).next().unwrap();
        if own == "lib" {
            continue;
        }
        let code = code(&file);
        assert!(!code.contains("super::super"), "{path}: name the module through `crate::`");
        for name in used(&code) {
            let (Some(theirs), Some(ours)) = (rank(&name), rank(own)) else {
                panic!("{path} uses `crate::{name}`, which lib.rs does not list");
            };
            assert!(theirs <= ours, "{path} uses `{name}`, below `{own}` in lib.rs");
        }
    }
}

#[test]
fn the_physics_touches_nothing_outside() {
    for file in rust_files(&src()) {
        let code = code(&file);
        for outside in
            ["std::fs", "std::io", "std::env", "std::time", "std::thread", "std::net", "std::process", "println!"]
        {
            assert!(!code.contains(outside), "{} uses {outside}", file.display());
        }
    }
}

/// Sources of all programs and libraries, without comments and without their own tests. The chores of the repository
/// read what other programs print; that is their work.
fn programs() -> Vec<(String, String)> {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().to_owned();
    let mut all = Vec::new();
    for member in fs::read_dir(&crates).unwrap().map(|e| e.unwrap().path()) {
        let src = member.join("src");
        if member.ends_with("xtask") || !src.is_dir() {
            continue;
        }
        for file in rust_files(&src).into_iter().filter(|f| !f.ends_with("tests.rs")) {
            let name = file.strip_prefix(&crates).unwrap().to_str().unwrap().replace('\\', "/");
            let code = code(&file);
            all.push((name, code.split("#[cfg(test)]\nmod ").next().unwrap().to_owned()));
        }
    }
    assert!(all.len() > 200, "{}", all.len());
    all
}

/// Methods that look into a text.
const LOOKS: [&str; 15] = [
    "contains",
    "ends_with",
    "eq",
    "find",
    "matches",
    "replace",
    "replacen",
    "rsplit_once",
    "split",
    "split_once",
    "splitn",
    "starts_with",
    "strip_prefix",
    "strip_suffix",
    "trim_start_matches",
];

/// What a sentence is called.
const SENTENCES: [&str; 9] = ["message", "reason", "reach", "meaning", "sentence", "warning", "hint", "note", "why"];

/// What is read is no sentence of ours: the file, and what it may say there.
const GRAMMARS: [(&str, &str); 2] = [
    // Keys of warnings in a report, with their own grammar.
    ("summary.rs", r#"strip_prefix("reason: ")"#),
    // The recorded events of another program.
    ("galvagno.rs", "their.why.starts_with"),
];

/// The text literal at the beginning of an argument.
fn literal(argument: &str) -> Option<&str> {
    let argument = argument.trim_start().trim_start_matches('&');
    let argument = argument.strip_prefix("format!(").unwrap_or(argument).trim_start();
    argument.strip_prefix('"')?.split('"').next()
}

/// Places in which a program looks for words in a text, or into a sentence at all.
fn looks_into_sentences(code: &str) -> Vec<&str> {
    let words = |text: &str| text.contains(' ') && text.chars().any(char::is_alphabetic);
    let line = |at: usize| {
        let (from, to) =
            (code[..at].rfind('\n').map_or(0, |k| k + 1), code[at..].find('\n').map_or(code.len(), |k| at + k));
        code[from..to].trim()
    };
    let mut found = Vec::new();
    for method in LOOKS {
        for (at, call) in code.match_indices(&format!(".{method}(")) {
            let argument = &code[at + call.len()..];
            // One sign is typography: a minus, a line break.
            let sign = argument.starts_with(['\'', '|', '[']) || argument.starts_with("char::");
            let before = code[..at].trim_end().rsplit(|c: char| !(c.is_alphanumeric() || "_.()".contains(c))).next();
            let of = before.unwrap_or_default().split('.').rfind(|part| !part.contains(['(', ')']));
            let sentence = of.is_some_and(|name| SENTENCES.iter().any(|s| name == *s));
            if literal(argument).is_some_and(words) || sentence && !sign {
                found.push(line(at));
            }
        }
    }
    for sign in ["== \"", "!= \""] {
        for (at, _) in code.match_indices(sign) {
            if literal(&code[at + 3..]).is_some_and(words) {
                found.push(line(at));
            }
        }
    }
    found.sort_unstable();
    found.dedup();
    found
}

#[test]
fn no_program_reads_its_own_sentences() {
    let mut wrong = Vec::new();
    for (file, code) in programs() {
        for line in looks_into_sentences(&code) {
            if !GRAMMARS.iter().any(|(f, words)| file.ends_with(f) && line.contains(words)) {
                wrong.push(format!("{file}: {line}"));
            }
        }
    }
    assert!(wrong.is_empty(), "carry an enum or a number instead, and make the sentence last:\n{}", wrong.join("\n"));
}

#[test]
fn a_program_that_reads_a_sentence_is_found() {
    let specimens = [
        r#"w.split(" of ").next()"#,
        r#"notes.filter(|n| !n.starts_with("without loss"))"#,
        r#"match message.contains("alone") {"#,
        r#"d.message.strip_prefix(&title)"#,
        r#"answer.reason.replace(&format!("operation `{}`: ", name), "")"#,
        r#"d.message.as_str().find(|m| m.contains("spaced equally"))"#,
        r#"if x.reach != "cannot be reached" {"#,
    ];
    for specimen in specimens {
        assert_eq!(looks_into_sentences(specimen).len(), 1, "{specimen}");
    }
    for fine in [
        r#"name.contains("-")"#,
        r#"text.split_once(" = ")"#,
        r#"line.starts_with("schema")"#,
        "why.replace('-', \"−\")",
    ] {
        assert_eq!(looks_into_sentences(fine), Vec::<&str>::new());
    }
}
