//! The words of README and book, their links, anchors and figures, and that the reference part of the book has everything that
//! the program has.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;
use willis::diagnostic::Code;
use willis::losses::list;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// README and all pages of the book, by path from the root.
fn pages() -> Vec<String> {
    let folder = fs::read_dir(root().join("book/src")).unwrap();
    let names = folder.map(|e| e.unwrap().file_name().into_string().unwrap()).filter(|n| n.ends_with(".md"));
    let mut all: Vec<String> = names.map(|n| format!("book/src/{n}")).collect();
    all.push("README.md".into());
    all.sort();
    all
}

/// Whether a page is written by the program.
fn is_generated(page: &str) -> bool {
    page.contains("/reference-") || page.ends_with("/examples.md")
}

/// Lines of a page that are prose: no code block; what stands between backquotes is left out.
fn prose(text: &str) -> Vec<(usize, String)> {
    let mut inside = false;
    let mut all = Vec::new();
    for (k, line) in text.lines().enumerate() {
        if line.trim_start().starts_with("```") {
            inside = !inside;
        } else if !inside {
            all.push((k + 1, line.split('`').step_by(2).collect::<Vec<_>>().join("`")));
        }
    }
    all
}

/// Words that the glossary replaced, each with what stands for it.
const RETIRED: &[(&str, &str)] = &[
    ("told", "printed, listed"),
    ("tells", "shows, lists, explains"),
    ("honest", "say what was checked"),
    ("tooth power", "potential power"),
    ("power that rolls", "potential power"),
    ("way of the power", "power path"),
    ("film over roughness", "film ratio λ"),
    ("gear in fluid", "windage and churning"),
    ("gears in fluid", "windage and churning"),
    ("wheel of regimes", "regime map"),
    ("driving end", "driving gear"),
    ("loaded way", "power path"),
    ("in circles", "recirculating"),
    ("in a circle", "recirculates"),
    ("doubtful", "assumed uncertainty"),
    ("freedoms", "degrees of freedom"),
    ("one freedom", "one degree of freedom"),
    ("seen from the carrier", "relative to the carrier"),
    ("whatever the load", "for any load, in these directions of rotation"),
    ("turns round", "reverses"),
    ("not worth a thought", "name the number"),
];

/// Whether a line has this word, or these words, not as a part of longer ones.
fn has(line: &str, words: &str) -> bool {
    let line = line.to_lowercase();
    let part = |c: Option<char>| c.is_some_and(char::is_alphanumeric);
    line.match_indices(words)
        .any(|(at, _)| !part(line[..at].chars().next_back()) && !part(line[at + words.len()..].chars().next()))
}

#[test]
fn retired_words_are_not_in_the_prose() {
    let mut wrong = Vec::new();
    for page in pages().iter().filter(|p| !is_generated(p)) {
        for (line, text) in prose(&read(&root().join(page))) {
            // The glossary has the words of files and results beside those of the text.
            let text = if page.ends_with("glossary.md") && text.starts_with('|') { String::new() } else { text };
            let found = RETIRED.iter().filter(|(word, _)| has(&text, word));
            wrong.extend(found.map(|(word, instead)| format!("{page}:{line}: `{word}`; write: {instead}")));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The anchor of a heading, as mdBook makes it.
fn anchor(heading: &str) -> String {
    let kept = heading.trim().chars().filter_map(|c| match c {
        c if c.is_alphanumeric() || c == '_' || c == '-' => Some(c.to_ascii_lowercase()),
        c if c.is_whitespace() => Some('-'),
        _ => None,
    });
    kept.collect()
}

fn anchors(text: &str) -> BTreeSet<String> {
    let mut inside = false;
    let headings = text.lines().filter(|line| {
        inside ^= line.starts_with("```");
        !inside && line.starts_with('#')
    });
    headings.map(|h| anchor(h.trim_start_matches('#'))).collect()
}

/// Links and figures of a page: line, text, target, and whether it is a figure.
fn links(text: &str) -> Vec<(usize, String, String, bool)> {
    // A link may go over the end of a line.
    let mut all = Vec::new();
    let whole: String = prose(text).into_iter().map(|(k, l)| format!("\u{1}{k}\u{2}{l}\n")).collect();
    let mut line = 0;
    for (k, piece) in whole.split("](").enumerate() {
        if k > 0
            && let Some((target, _)) = piece.split_once(')')
        {
            let before = whole.split("](").nth(k - 1).unwrap();
            let open = before.rfind('[').map_or(0, |at| at + 1);
            let label: String =
                before[open..].split('\u{1}').map(|p| p.split('\u{2}').next_back().unwrap_or(p)).collect();
            let figure = before[..open.saturating_sub(1)].ends_with('!');
            all.push((line, label.trim().to_owned(), target.to_owned(), figure));
        }
        if let Some(number) = piece.rsplit('\u{1}').next().and_then(|p| p.split_once('\u{2}')) {
            line = number.0.parse().unwrap_or(line);
        }
    }
    all
}

#[test]
fn links_anchors_and_alternative_texts_are_right() {
    let mut wrong = Vec::new();
    let mut count = 0;
    for page in pages() {
        let path = root().join(&page);
        let folder = path.parent().unwrap();
        for (line, label, target, figure) in links(&read(&path)) {
            count += 1;
            if figure && label.split_whitespace().count() < 3 {
                wrong.push(format!("{page}:{line}: the figure {target} needs a text that says what it shows"));
            }
            if target.starts_with("https://") || target.starts_with("http://") {
                continue;
            }
            let (file, fragment) = target.split_once('#').unwrap_or((&target, ""));
            let file = if file.is_empty() { path.clone() } else { folder.join(file) };
            if !file.exists() {
                wrong.push(format!("{page}:{line}: {target} does not exist"));
            } else if !fragment.is_empty() && !anchors(&read(&file)).contains(fragment) {
                wrong.push(format!("{page}:{line}: {target}: there is no such heading"));
            }
        }
    }
    assert!(count > 100, "only {count} links found");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_chapter_has_a_figure() {
    for page in pages().iter().filter(|p| !p.contains("/reference-") && !p.ends_with("SUMMARY.md")) {
        assert!(links(&read(&root().join(page))).iter().any(|l| l.3), "{page} has no figure");
    }
}

#[test]
fn every_chapter_opens_with_its_question() {
    for page in pages().iter().filter(|p| p.starts_with("book/") && !is_generated(p) && !p.ends_with("SUMMARY.md")) {
        let text = read(&root().join(page));
        let question = text.split("\n\n").nth(1).unwrap_or_default();
        assert!(question.contains('*') && question.contains('?'), "{page} does not open with its question");
    }
}

/// Chapters of the first three parts: all but the reference.
fn chapters() -> Vec<String> {
    let summary = read(&root().join("book/src/SUMMARY.md"));
    let told = summary.split("\n# Reference").next().unwrap();
    let all: Vec<String> = links(told).into_iter().map(|l| format!("book/src/{}", l.2)).collect();
    assert!(all.len() > 25, "only {} chapters found", all.len());
    all
}

/// What is wrong with the order of a chapter: a command comes before headings, pictures and other code.
fn out_of_order(text: &str) -> Option<&'static str> {
    const PROGRAMS: [&str; 4] = ["willis ", "cargo ", "pip ", "python"];
    let Some(first) = text.lines().position(|l| l.starts_with("```")) else { return Some("there is no command") };
    let command = text.lines().nth(first + 1).unwrap_or_default().trim_start_matches("$ ");
    let before: Vec<&str> = text.lines().take(first).collect();
    if !PROGRAMS.iter().any(|p| command.starts_with(p)) {
        return Some("the first block is no command");
    }
    if before.iter().any(|l| l.starts_with("## ")) {
        return Some("a heading stands before the first command");
    }
    before.iter().any(|l| l.starts_with("![")).then_some("a picture stands before the first command")
}

#[test]
fn every_chapter_answers_before_it_explains() {
    for page in chapters() {
        assert_eq!(out_of_order(&read(&root().join(&page))), None, "{page}");
    }
    let [right, none, file, heading, picture] = [
        "```sh\nwillis x\n```\n",
        "words\n",
        "```toml\na = 1\n```\n",
        "## A\n```sh\nwillis x\n```\n",
        "![a](b)\n```sh\nwillis x\n",
    ]
    .map(out_of_order);
    assert!(right.is_none() && none.is_some() && file.is_some() && heading.is_some() && picture.is_some());
}

#[test]
fn every_figure_is_shown() {
    let shown: BTreeSet<String> = pages()
        .iter()
        .flat_map(|p| links(&read(&root().join(p))))
        .filter_map(|l| Some(l.2.rsplit_once("figures/")?.1.to_owned()))
        .collect();
    for file in fs::read_dir(root().join("book/src/figures")).unwrap() {
        let name = file.unwrap().file_name().into_string().unwrap();
        assert!(shown.contains(&name), "book/src/figures/{name} is on no page");
    }
}

#[test]
fn the_readme_is_short() {
    assert!(read(&root().join("README.md")).lines().count() <= 150);
}

/// All keys in a schema of tables.
fn keys(schema: &Value, all: &mut BTreeSet<String>) {
    match schema {
        Value::Object(fields) => {
            if let Some(Value::Object(of)) = fields.get("properties") {
                all.extend(of.keys().cloned());
            }
            fields.values().for_each(|v| keys(v, all));
        }
        Value::Array(items) => items.iter().for_each(|v| keys(v, all)),
        _ => {}
    }
}

fn reference(name: &str) -> String {
    read(&root().join(format!("book/src/reference-{name}.md")))
}

#[test]
fn the_reference_has_every_key() {
    let page = reference("keys");
    let schema: Value = serde_json::from_str(&read(&root().join("schema/willis-1.schema.json"))).unwrap();
    let mut all = BTreeSet::new();
    keys(&schema, &mut all);
    assert!(all.len() > 150, "only {} keys found", all.len());
    for key in all {
        assert!(
            page.contains(&format!("| `{key}` |")),
            "the key `{key}` is not in the reference: run `cargo xtask reference`"
        );
    }
}

#[test]
fn the_reference_has_every_code_and_law() {
    let page = reference("codes");
    for code in Code::ALL {
        assert!(page.contains(&format!("### {}: ", code.as_str())), "{} is not in the reference", code.as_str());
    }
    let page = reference("laws");
    for law in list(None).laws {
        let heading = format!("### {}={}", law.family, law.law);
        assert!(page.lines().any(|l| l.trim_end_matches(" (default)") == heading), "{heading} is not in the reference");
    }
}

#[test]
fn the_reference_has_every_question_and_figure() {
    let (commands, answers) = (reference("commands"), reference("answers"));
    for file in fs::read_dir(root().join("schema/answers")).unwrap() {
        let path = file.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().trim_end_matches(".schema.json").to_owned();
        if name == "refusal" {
            assert!(answers.contains("`willis-refusal-1`"));
            continue;
        }
        assert!(commands.contains(&format!("\n## willis {name}\n")), "the command {name} is not in the reference");
        let schema: Value = serde_json::from_str(&read(&path)).unwrap();
        let title = schema["title"].as_str().unwrap();
        assert!(answers.contains(&format!("\n## {title}\n")), "the format {title} is not in the reference");
        if name == "draw" {
            let kinds = schema["$defs"]["Figure"]["oneOf"].as_array().unwrap();
            let named = kinds.iter().filter_map(|k| k["properties"]["figure"]["const"].as_str());
            let draw = commands.split("\n## willis draw\n").nth(1).unwrap().split("\n## ").next().unwrap();
            for kind in named {
                assert!(
                    draw.lines().any(|l| l.split_whitespace().next() == Some(kind)),
                    "the figure {kind} is not in the reference"
                );
            }
        }
    }
}

#[test]
fn links_are_found_over_lines() {
    let text = "one [two\nthree](a.md#b) and ![four five six](c.svg)\n```text\n[no](no.md)\n```\n`[no](no.md)`\n";
    let all = links(text);
    let found: Vec<_> = all.iter().map(|l| (l.1.as_str(), l.2.as_str(), l.3)).collect();
    assert_eq!(found, [("two\nthree", "a.md#b", false), ("four five six", "c.svg", true)]);
    assert_eq!(anchor(" Teeth, oil, bearings"), "teeth-oil-bearings");
    assert_eq!(anchor(" The loop, and the step that lags"), "the-loop-and-the-step-that-lags");
    assert!(has("It is told.", "told") && !has("He untold it", "told"));
}
