//! `willis help`: of a command its options, of a topic a page; without either, all there is.
//!
//! Pages are Markdown in `topics/`, each with an example. The reference of the book has the same text.

use clap::{Arg, ArgMatches, Command};
use willis::diagnostic::{Code, Diagnostic};
use willis_ask::style::wrap;

use crate::Ended;

/// A page of words.
pub struct Topic {
    pub name: &'static str,
    pub page: &'static str,
}

/// All of them. Adding one is adding a file and a line.
pub const TOPICS: &[Topic] = &[
    Topic { name: "units", page: include_str!("topics/units.md") },
    Topic { name: "signs", page: include_str!("topics/signs.md") },
    Topic { name: "verdicts", page: include_str!("topics/verdicts.md") },
    Topic { name: "files", page: include_str!("topics/files.md") },
    Topic { name: "quantities", page: include_str!("topics/quantities.md") },
    Topic { name: "values", page: include_str!("topics/values.md") },
    Topic { name: "laws", page: include_str!("topics/laws.md") },
    Topic { name: "exit-status", page: include_str!("topics/exit-status.md") },
];

/// What the help says of its topics, below the list of commands.
pub fn list() -> String {
    let names: Vec<&str> = TOPICS.iter().map(|t| t.name).collect();
    format!("{}\n\nExample:\n  willis help units", wrap(&names.join(", "), "Topics of `willis help TOPIC`: "))
}

pub fn command() -> Command {
    let words = Arg::new("topic").value_name("COMMAND or TOPIC").num_args(0..);
    Command::new("help")
        .about("Print the help of a command or of a topic, such as units; without either, all there are")
        .arg(words.help("A command such as `sweep`, or a topic such as `units`"))
        .after_help(list())
}

pub fn run(own: &ArgMatches, whole: Command) -> Result<Ended, Ended> {
    let words: Vec<&str> = own.get_many::<String>("topic").into_iter().flatten().map(String::as_str).collect();
    match words.as_slice() {
        [] => Ok(Ended::Answered(options(whole, None))),
        [name] => match (whole.find_subcommand(name).is_some(), topic(name)) {
            // `laws` is both: the command, and below it the page.
            (true, page) => {
                let page = page.map_or(String::new(), |t| format!("\n{}", rendered(t.page)));
                Ok(Ended::Answered(options(whole, Some(name)) + &page))
            }
            (false, Some(topic)) => Ok(Ended::Answered(rendered(topic.page))),
            (false, None) => Err(unknown(name, &whole)),
        },
        [first, ..] => {
            Err(Ended::Misused(format!("help takes one command or one topic, such as `willis help {first}`")))
        }
    }
}

/// What `--help` prints, of all or of a command.
fn options(whole: Command, name: Option<&str>) -> String {
    let words = ["willis"].into_iter().chain(name).chain(["--help"]);
    whole.try_get_matches_from(words).expect_err("help ends the reading").render().ansi().to_string()
}

fn topic(name: &str) -> Option<&'static Topic> {
    let name = name.to_ascii_lowercase();
    TOPICS.iter().find(|t| t.name == name || t.name.strip_suffix('s') == Some(name.as_str()))
}

/// What there is, nearest first.
fn unknown(name: &str, whole: &Command) -> Ended {
    let commands: Vec<&str> = whole.get_subcommands().map(Command::get_name).collect();
    let topics: Vec<&str> = TOPICS.iter().map(|t| t.name).collect();
    let near = Diagnostic::new(Code::UnknownSelection, "", "").suggest(name, topics.iter().chain(&commands).copied());
    let near = near.hints.first().map_or(String::new(), |hint| format!("; {hint}"));
    Ended::Misused(format!(
        "there is no command and no topic `{name}`{near}\n\n{}\n{}",
        wrap(&topics.join(", "), "topics:   "),
        wrap(&commands.join(", "), "commands: ")
    ))
}

/// Markdown as a terminal shows it: headings bold, paragraphs and cells filled to the width of help texts, code indented.
fn rendered(page: &str) -> String {
    let mut all = String::new();
    let mut paragraph = String::new();
    let mut table: Vec<Vec<String>> = Vec::new();
    let mut code = false;
    for line in page.lines().chain([""]) {
        let item = line.strip_prefix("- ");
        let row = line.starts_with('|');
        if !paragraph.is_empty() && (line.is_empty() || item.is_some() || row || line.starts_with("```")) {
            let head = if paragraph.starts_with("- ") { "  - " } else { "" };
            all += &(wrap(&plain(paragraph.trim_start_matches("- ")), head) + "\n");
            paragraph.clear();
        }
        if !table.is_empty() && !row {
            all += &set(&table);
            table.clear();
        }
        if line.starts_with("```") {
            code = !code;
        } else if code {
            all += &format!("    {line}\n");
        } else if let Some(heading) = line.strip_prefix("# ") {
            all += &format!("\u{1b}[1m{heading}\u{1b}[0m\n");
        } else if row {
            let cells: Vec<String> = line.trim_matches('|').split('|').map(|c| plain(c.trim())).collect();
            if !cells.iter().all(|c| c.chars().all(|c| c == '-')) {
                table.push(cells);
            }
        } else if line.is_empty() {
            all.push('\n');
        } else {
            paragraph = if paragraph.is_empty() { line.into() } else { format!("{paragraph} {}", line.trim_start()) };
        }
    }
    all.trim_end().to_owned() + "\n"
}

/// A table of two columns.
fn set(rows: &[Vec<String>]) -> String {
    let first = rows.iter().filter_map(|r| Some(r.first()?.chars().count())).max().unwrap_or(0).min(36);
    let line = |row: &Vec<String>| {
        let (name, about) = (row[0].as_str(), row[1..].join("  "));
        if name.chars().count() <= first {
            return wrap(&about, &format!("  {name:<first$}  ")) + "\n";
        }
        format!("  {name}\n{}\n", wrap(&about, &" ".repeat(first + 4)))
    };
    let mut lines = rows.iter().map(line);
    let head = lines.next().unwrap_or_default();
    format!("\u{1b}[4m{}\u{1b}[0m\n{}", head.trim_end_matches('\n'), lines.collect::<String>())
}

/// Text without the marks of Markdown; code keeps its marks, as in help texts.
fn plain(text: &str) -> String {
    let mut code = false;
    text.chars()
        .filter(|c| {
            code ^= *c == '`';
            code || *c != '*'
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pages_become_text_of_terminals() {
        let page = "# Signs\n\nOne *word*\nand `a*b`.\n\n| a | b |\n|---|---|\n| `x` | y |\n\n- one\n- two\n\n```console\n$ willis\n```\n";
        let text = willis_ask::style::plain(&rendered(page));
        assert_eq!(text, "Signs\n\nOne word and `a*b`.\n\n  a    b\n  `x`  y\n\n  - one\n  - two\n\n    $ willis\n");
    }

    #[test]
    fn every_topic_has_an_example_and_fits_the_terminal() {
        for topic in TOPICS {
            assert!(topic.page.contains("\nExample: ") && topic.page.contains("\n$ willis "), "{}", topic.name);
            for line in willis_ask::style::plain(&rendered(topic.page)).lines() {
                assert!(line.chars().count() <= 100 || line.contains("$ willis"), "{}: {line}", topic.name);
            }
        }
    }
}
