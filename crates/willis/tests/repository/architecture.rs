//! lib.rs lists the modules in pipeline order; a module uses only those above it. The physics
//! touches no file, clock, environment or thread. In no crate do files import each other in a circle.

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
    let module = |line: &str| {
        line.strip_prefix("pub ").unwrap_or(line).strip_prefix("mod ")?.strip_suffix(';').map(str::to_owned)
    };
    let order: Vec<String> = lib.lines().filter_map(module).collect();
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

/// The paths of an import, `a::{b, c::d}` taken apart.
fn paths(import: &str) -> Vec<String> {
    let Some((before, list)) = import.split_once('{') else {
        return vec![import.split(" as ").next().unwrap_or_default().trim().to_owned()];
    };
    let list = list.trim_end().strip_suffix('}').expect("closed");
    let (mut parts, mut depth) = (vec![String::new()], 0);
    for c in list.chars() {
        match c {
            ',' if depth == 0 => parts.push(String::new()),
            _ => {
                depth += i32::from(c == '{') - i32::from(c == '}');
                parts.last_mut().expect("one").push(c);
            }
        }
    }
    let parts = parts.iter().map(|p| p.trim()).filter(|p| !p.is_empty());
    parts.flat_map(|p| paths(&format!("{}{p}", before.trim()))).collect()
}

/// Files that a file imports from, tests aside. What it only hands on, as in `pub use`, is no import.
fn imports(module: &str, code: &str, all: &[String]) -> Vec<String> {
    let code = code.split("#[cfg(test)]\nmod tests").next().unwrap_or_default();
    let code = format!("\n{code}");
    let own: Vec<&str> = module.split("::").collect();
    let mut found = vec![];
    for import in code.split("\nuse ").skip(1).filter_map(|rest| rest.split(';').next()) {
        for path in paths(&import.split_whitespace().collect::<Vec<_>>().join(" ")) {
            let steps: Vec<&str> = path.split("::").map(str::trim).collect();
            let full: Vec<&str> = match steps[0] {
                "crate" => own[..1].iter().chain(&steps[1..]).copied().collect(),
                "super" => own[..own.len() - 1].iter().chain(&steps[1..]).copied().collect(),
                "self" => own.iter().chain(&steps[1..]).copied().collect(),
                _ => own.iter().chain(&steps).copied().collect(),
            };
            // The deepest file on the way; a name of another crate has none below this file.
            let file = (1..=full.len()).rev().map(|n| full[..n].join("::")).find(|m| all.contains(m));
            found.extend(file.filter(|file| file != module));
        }
    }
    found
}

/// A reader can take the files one after another: none imports from one that, step by step, imports from it.
#[test]
fn files_import_in_no_circle() {
    let mut modules: Vec<(String, String)> = Vec::new();
    for of in [
        "willis",
        "willis-figure",
        "willis-casebook",
        "willis-synthesis",
        "willis-ask",
        "willis-fmu",
        "willis-cli",
        "xtask",
    ] {
        let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(of).join("src");
        for file in rust_files(&src).into_iter().filter(|file| file.extension().is_some_and(|e| e == "rs")) {
            let path = file.strip_prefix(&src).unwrap().with_extension("");
            let steps = path.iter().map(|p| p.to_str().unwrap()).filter(|p| !["lib", "main"].contains(p));
            modules.push(([of].into_iter().chain(steps).collect::<Vec<_>>().join("::"), code(&file)));
        }
    }
    let all: Vec<String> = modules.iter().map(|m| m.0.clone()).collect();
    let imports: Vec<Vec<usize>> = modules
        .iter()
        .map(|(name, code)| {
            let found = imports(name, code, &all);
            found.iter().map(|f| all.iter().position(|m| m == f).expect("a file")).collect()
        })
        .collect();
    let count = imports.iter().flatten().count();
    assert!(count > 1000, "only {count} imports are found");
    // Everything that can be reached from a file.
    let reach = |from: usize| {
        let (mut seen, mut open) = (vec![false; all.len()], vec![from]);
        while let Some(k) = open.pop() {
            for &next in &imports[k] {
                if !std::mem::replace(&mut seen[next], true) {
                    open.push(next);
                }
            }
        }
        seen
    };
    let reached: Vec<Vec<bool>> = (0..all.len()).map(reach).collect();
    if let Some(k) = (0..all.len()).find(|&k| reached[k][k]) {
        let circle: Vec<&String> =
            (0..all.len()).filter(|&j| reached[k][j] && reached[j][k]).map(|j| &all[j]).collect();
        panic!("these files import each other, step by step: {circle:?}");
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
const GRAMMARS: [(&str, &str); 4] = [
    // Keys of warnings in a report, with their own grammar.
    ("summary.rs", r#"strip_prefix("reason: ")"#),
    // The recorded events of another program.
    ("galvagno.rs", "their.why.starts_with"),
    // Text in comments of C, and the loops of C that is filled in.
    ("willis-exchange/src/c.rs", r#"text.replace("/*""#),
    ("willis-exchange/src/c.rs", r#"starts_with("for (")"#),
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
            let sentence = of.is_some_and(|name| SENTENCES.contains(&name));
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

/// A library says which field of a request is meant; how a front end writes it is the front end's.
#[test]
fn libraries_name_no_option_of_the_command_line() {
    // The report quotes the command that makes it again; style sheets have names that begin so.
    let own = ["willis-ask/src/questions/report.rs", "willis-figure/src/report/html.rs"];
    let option = |text: &str| {
        let mut rest = text.split(" --").skip(1).chain(text.split("\"--").skip(1));
        rest.any(|after| after.starts_with(|c: char| c.is_ascii_lowercase()))
    };
    let libraries = ["willis/", "willis-ask/", "willis-figure/"];
    let is_asked = |name: &str| name.ends_with(".rs") && libraries.iter().any(|l| name.starts_with(l));
    for (name, code) in programs().into_iter().filter(|(name, _)| is_asked(name) && !own.contains(&name.as_str())) {
        for line in code.lines() {
            assert!(!option(line), "{name}: {}", line.trim());
        }
    }
}

/// Whether a closure on a line has parameters that are large numbers by value. One that leaves their type to be found is not seen.
fn takes_numbers_by_value(line: &str) -> bool {
    let numbers = ["R", "D", "Inner<D>", "Dual<R>", "Plane<R>", "Moving", "T"];
    // Parameters stand between an odd bar and the next: what is before the first is none.
    line.split('|')
        .skip(1)
        .step_by(2)
        .flat_map(|parameters| parameters.split(','))
        .filter_map(|parameter| parameter.split_once(':'))
        .any(|(_, of)| numbers.contains(&of.trim()))
}

/// A closure that is called by name with a large number by value may change that of its caller: a defect of the compiler, see
/// [`willis::Real`].
#[test]
fn closures_take_numbers_by_reference() {
    assert!(takes_numbers_by_value("let z = |nu: R| (nu * 1e6 + 0.7).log10();"));
    assert!(takes_numbers_by_value("let over = |out: &R, input: R| out / input;"));
    assert!(!takes_numbers_by_value("let z = |nu: &R, k: usize| (*nu * 1e6 + 0.7).log10();"));
    let found: Vec<String> = rust_files(&src())
        .into_iter()
        .flat_map(|path| {
            let of = path.file_name().unwrap().to_string_lossy().into_owned();
            let code = code(&path);
            code.lines()
                .filter(|line| takes_numbers_by_value(line))
                .map(|line| format!("{of}: {line}"))
                .collect::<Vec<_>>()
        })
        .collect();
    assert!(found.is_empty(), "by reference, please:\n{}", found.join("\n"));
}
