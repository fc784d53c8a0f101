//! Prose that shows what the program prints: every such line must come out of the program.
//!
//! A block that begins with `$ willis …` (or `$ cargo run --release -- …`) is a command and lines of its output,
//! in order; `...` stands for lines left out. A train file without a folder is the last TOML block above it.

use std::fs;
use std::path::{Path, PathBuf};

use crate::context::{Context, passes, said};
use crate::examples::example_files;
use crate::program::build_willis;
use crate::step::{Outcome, outcome};

/// A command of the prose and what it is said to print.
pub(crate) struct Shown {
    line: usize,
    pub(crate) words: Vec<String>,
    pub(crate) output: Vec<String>,
    /// The TOML block above.
    train: Option<String>,
}

/// Runs the commands of README and book and compares.
pub(crate) fn book(context: &Context) -> Outcome {
    match build_willis(context).and_then(|()| run(context)) {
        Ok(told) => {
            println!("{told}");
            Outcome::Passed
        }
        Err(e) => Outcome::Failed(e),
    }
}

/// `cargo xtask pages`: the book as web pages, by the tool that it is written for.
pub(crate) fn pages(context: &Context) -> Outcome {
    let program = match mdbook(context) {
        Ok(program) => program,
        Err(why) => return Outcome::Skipped(why),
    };
    let mut build = context.command(program);
    build.args(["build", "book", "--dest-dir"]).arg(context.target.join("book-pages"));
    let said = said(&build);
    outcome(passes(&mut build, &said))
}

/// The tool that makes pages, or why it cannot be had.
///
/// The tool is built once, without what serves and searches pages and without optimisation, and kept beside the other
/// build results.
pub(crate) fn mdbook(context: &Context) -> Result<PathBuf, String> {
    let tools = context.target.join("tools");
    let own = tools.join("bin").join(format!("mdbook{}", std::env::consts::EXE_SUFFIX));
    let runs = |program: &Path| {
        context.output(context.command(program).arg("--version")).is_ok_and(|o| o.stdout.starts_with(b"mdbook v0.5"))
    };
    let program = if runs(Path::new("mdbook")) { PathBuf::from("mdbook") } else { own };
    if !runs(&program) {
        let words = "cargo install --quiet --locked mdbook --version ^0.5 --no-default-features --debug";
        let mut install = context.words(words);
        install.arg("--root").arg(&tools).arg("--target-dir").arg(tools.join("build"));
        if passes(&mut install, words).is_err() || !runs(&program) {
            return Err("mdbook is not installed, and cannot be had here".into());
        }
        let _ = fs::remove_dir_all(tools.join("build"));
    }
    Ok(program)
}

/// A new folder with the examples in it, where the reader of a page begins.
fn reader(context: &Context, folder: &Path) -> Result<(), String> {
    let fail = |e: std::io::Error| format!("{}: {e}", folder.display());
    let _ = fs::remove_dir_all(folder);
    fs::create_dir_all(folder.join("examples/design")).map_err(fail)?;
    for file in example_files(context)? {
        fs::copy(context.root.join(&file), folder.join(&file)).map_err(fail)?;
    }
    // Profiles and files of other programs stand beside the trains, design files in a folder of theirs.
    for (place, ending) in [("examples", "csv"), ("examples", "rexs"), ("examples/design", "toml")] {
        for entry in fs::read_dir(context.root.join(place)).map_err(fail)? {
            let file = entry.map_err(fail)?.path();
            if let (Some(name), true) = (file.file_name(), file.extension().is_some_and(|e| e == ending)) {
                fs::copy(&file, folder.join(place).join(name)).map_err(fail)?;
            }
        }
    }
    Ok(())
}

/// Runs all of them, those of a page in a folder of their own. How many there were, or what differs.
fn run(context: &Context) -> Result<String, String> {
    let folder = context.target.join("book");
    let fail = |e: std::io::Error| format!("{}: {e}", folder.display());
    let mut pages = vec!["README.md".to_owned()];
    let chapters = fs::read_dir(context.root.join("book/src")).map_err(fail)?;
    let names = chapters.filter_map(|c| c.ok()?.file_name().into_string().ok());
    pages.extend(names.filter(|n| n.ends_with(".md")).map(|n| format!("book/src/{n}")));
    pages.sort();
    let (mut commands, mut lines, mut wrong) = (0, 0, Vec::new());
    for page in &pages {
        let text = fs::read_to_string(context.root.join(page)).map_err(|e| format!("{page}: {e}"))?;
        reader(context, &folder)?;
        for shown in commands_of(&text) {
            if let Some(train) = &shown.train {
                let bare = |w: &&String| w.ends_with(".toml") && Path::new(w).components().count() == 1;
                for file in shown.words.iter().filter(bare) {
                    fs::write(folder.join(file), train).map_err(fail)?;
                }
            }
            let mut command = context.willis();
            let output = command.args(&shown.words).current_dir(&folder).output().map_err(fail)?;
            let printed = [output.stderr, output.stdout].concat();
            let printed = String::from_utf8_lossy(&printed);
            commands += 1;
            lines += shown.output.len();
            if let Some(line) = first_missing(&shown.output, &printed) {
                wrong.push(format!("{page}:{}: `willis {}` does not print\n{line}", shown.line, shown.words.join(" ")));
            }
        }
    }
    match wrong.is_empty() {
        true => Ok(format!("{commands} commands, {lines} lines of their output")),
        false => Err(wrong.join("\n")),
    }
}

/// The first line that does not follow those before it.
pub(crate) fn first_missing<'a>(shown: &'a [String], printed: &str) -> Option<&'a String> {
    let mut rest = printed.lines().map(without_round_off);
    shown.iter().find(|line| !rest.any(|l| l == without_round_off(line)))
}

/// A line without the number that is round-off, which no two processors have alike.
fn without_round_off(line: &str) -> String {
    const BEFORE: &str = "closes to ";
    match line.trim_end().split_once(BEFORE) {
        Some((head, tail)) => format!("{head}{BEFORE}{}", tail.trim_start_matches(|c: char| c != ' ')),
        None => line.trim_end().to_owned(),
    }
}

/// Commands in the blocks of a page.
pub(crate) fn commands_of(text: &str) -> Vec<Shown> {
    let mut all: Vec<Shown> = Vec::new();
    let mut train = None;
    let mut block: Option<(&str, usize, Vec<&str>)> = None;
    for (k, line) in text.lines().enumerate() {
        match (&mut block, line.strip_prefix("```")) {
            (None, Some(kind)) => block = Some((kind, k + 2, vec![])),
            (None, None) => {}
            (Some((.., lines)), None) => lines.push(line),
            (Some(_), Some(_)) => {
                let (kind, first, lines) = block.take().expect("matched");
                if kind.starts_with("toml") {
                    train = Some(lines.join("\n") + "\n");
                } else if lines.first().is_some_and(|l| l.starts_with("$ ")) {
                    read_block(first, &lines, train.as_ref(), &mut all);
                }
            }
        }
    }
    all
}

fn read_block(first: usize, lines: &[&str], train: Option<&String>, all: &mut Vec<Shown>) {
    let mut lines = lines.iter().enumerate();
    let mut other = false;
    while let Some((k, line)) = lines.next() {
        let Some(start) = line.strip_prefix("$ ") else {
            if let (false, false, Some(shown)) = (other, ["", "..."].contains(&line.trim()), all.last_mut()) {
                shown.output.push((*line).to_owned());
            }
            continue;
        };
        let mut command = start.to_owned();
        while let Some(begun) = command.strip_suffix('\\') {
            command = begun.to_owned() + lines.next().map_or("", |(_, l)| l);
        }
        let words = words(&command.replace("cargo run --release --", "willis"));
        other = words.first().is_none_or(|w| w != "willis");
        if !other {
            all.push(Shown { line: first + k, words: words[1..].to_vec(), output: vec![], train: train.cloned() });
        }
    }
}

/// Words as a shell would split them.
fn words(command: &str) -> Vec<String> {
    let mut all = Vec::new();
    let mut word: Option<String> = None;
    let mut quote = None;
    for c in command.chars() {
        match (quote, c) {
            (Some(q), _) if c == q => quote = None,
            (None, '"' | '\'') => {
                quote = Some(c);
                word.get_or_insert_default();
            }
            (None, ' ') => all.extend(word.take()),
            _ => word.get_or_insert_default().push(c),
        }
    }
    all.extend(word);
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_are_read_with_their_output_and_train() {
        let text = "```toml,train\nname = 1\n```\nwords\n```console\n$ willis analyze a.toml \\\n  --state 'two three'\none\n...\ntwo\n\
                    $ other thing\nthree\n$ willis check a.toml\n```\n```rust\n$ no\n";
        let all = commands_of(text);
        assert_eq!(all.len(), 2);
        assert_eq!(all[0].words, ["analyze", "a.toml", "--state", "two three"]);
        assert_eq!((all[0].line, all[0].output.join(" ").as_str()), (6, "one two"));
        assert_eq!(all[1].words, ["check", "a.toml"]);
        assert_eq!(all[1].train.as_deref(), Some("name = 1\n"));
    }

    #[test]
    fn output_is_compared_in_order() {
        let shown = ["b", "c"].map(str::to_owned);
        assert_eq!(first_missing(&shown, "a\nb\n\nc \n"), None);
        assert_eq!(first_missing(&shown, "c\nb\n"), Some(&shown[1]));
    }
}
