//! The command line: a command a question, with the options of its request and those that all share.

use std::ffi::OsString;
use std::path::PathBuf;

use clap::builder::PossibleValuesParser;
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use willis_ask::{Entry, Of, QUESTIONS};

use crate::form::forms;
use crate::{examples, tools, topics};

/// The whole command line.
pub fn command() -> Command {
    command_for(None)
}

/// The command line, of which only this command is to be run: the others have their names alone, because what all options
/// of all questions are takes longer to say than many a question to answer.
fn command_for(only: Option<&str>) -> Command {
    let of_name = |name: &'static str, whole: &dyn Fn() -> Command| match only.is_none_or(|only| only == name) {
        true => shown(whole()),
        false => Command::new(name),
    };
    let color = Arg::new("color")
        .long("color")
        .global(true)
        .value_name("WHEN")
        .value_parser(["auto", "always", "never"])
        .default_value("auto")
        .help("When to use colours");
    let mut all = Command::new("willis")
        .version(env!("CARGO_PKG_VERSION"))
        .about(
            "Planetary gear trains: ratios, speeds, torques, power flow and efficiency, with a proof of uniqueness where \
             there is one",
        )
        .after_help(format!("`willis FILE` is short for `willis analyze FILE`.\n\n{}", topics::list()))
        .disable_help_subcommand(true)
        .max_term_width(100)
        .subcommand_required(true)
        .arg_required_else_help(true)
        .arg(color);
    for entry in QUESTIONS {
        all = all.subcommand(of_name(entry.name, &|| of(entry)));
        // Shards are put together where sweeps are made.
        if entry.name == "sweep" {
            let merge = tools::TOOLS.iter().filter(|t| t.name == "merge");
            all = all.subcommands(merge.map(|t| of_name(t.name, &t.command)));
        }
    }
    let others = tools::TOOLS.iter().filter(|t| t.name != "merge");
    all.subcommands(others.map(|t| of_name(t.name, &t.command)))
}

/// Whether there is such a command.
fn is_known(name: &str) -> bool {
    QUESTIONS.iter().map(|q| q.name).chain(tools::TOOLS.iter().map(|t| t.name)).any(|n| n == name)
}

/// A command whose help ends with an example.
fn shown(command: Command) -> Command {
    let Some(example) = examples::example(command.get_name()) else { return command };
    let more = command.get_after_help().map_or(String::new(), |more| format!("{more}\n\n"));
    command.after_help(format!("{more}{example}"))
}

/// What was said on the command line; a file name alone is analysed.
pub fn matches(words: impl IntoIterator<Item = OsString>) -> Result<ArgMatches, clap::Error> {
    let mut words: Vec<OsString> = words.into_iter().collect();
    let is_value = |k: usize| k > 1 && words[k - 1] == "--color";
    let first = (1..words.len()).find(|&k| !words[k].to_string_lossy().starts_with("--") && !is_value(k));
    if let Some(k) = first {
        let word = words[k].to_string_lossy();
        let known = is_known(&word) || word.starts_with('-');
        let file = word == "-" || word.ends_with(".toml") || std::path::Path::new(&words[k]).is_file();
        if file && (!known || word == "-") {
            words.insert(k, "analyze".into());
        }
    }
    // Behind an option, which may ask for the help of all, stands no command alone.
    let only = words.get(1).and_then(|w| w.to_str()).filter(|w| is_known(w)).map(str::to_owned);
    command_for(only.as_deref()).try_get_matches_from(words)
}

/// `0.5%` or `0.005`
fn part(text: &str) -> Result<f64, String> {
    let (number, unit) = text.trim().strip_suffix('%').map_or((text.trim(), 1.0), |n| (n.trim(), 0.01));
    match number.parse::<f64>() {
        Ok(x) if x.is_finite() => Ok(x * unit),
        _ => Err("write 0.5% or 0.005".into()),
    }
}

/// What the values of options are called that may be negative, so that what follows is no option whatever it begins with.
const NUMBERS: [&str; 17] = [
    "EFFICIENCY",
    "FACTOR",
    "K",
    "LENGTH",
    "MIN..MAX",
    "MM",
    "N",
    "PART",
    "POWER",
    "RANGE",
    "RATIO",
    "SPEED",
    "TEETH",
    "TEMPERATURE",
    "TIME",
    "TOLERANCE",
    "TORQUE",
];

/// The command of a question.
fn of(entry: &Entry) -> Command {
    let mut c = entry.options(Command::new(entry.name)).mut_args(|a| {
        let is_number = a.get_value_names().is_some_and(|names| names.iter().any(|n| NUMBERS.contains(&n.as_str())));
        if is_number { a.allow_hyphen_values(true) } else { a }
    });
    let file =
        |name: &'static str| Arg::new("file").value_name(name).help("Train file (TOML), or - for standard input");
    c = match entry.of {
        Of::Nothing => c,
        Of::AtMostOne => c.arg(file("FILE")),
        Of::Train => c.arg(file("FILE").required(true)),
        Of::Trains => c.arg(file("FILES").required(true).num_args(2..).help("Train files (TOML), two or more")),
    };
    if entry.of != Of::Nothing {
        let many = |name: &'static str| Arg::new(name).long(name).action(ArgAction::Append);
        c = c
            .arg(
                many("law")
                    .value_name("FAMILY=LAW")
                    .help("Use this loss law instead of the file's; repeatable: mesh_friction=niemann"),
            )
            .arg(
                many("set")
                    .value_name("QUANTITY=VALUE")
                    .help("Use this value of a quantity instead of the file's; repeatable: P1.sun.teeth=23"),
            )
            .arg(Arg::new("speed-tolerance").long("speed-tolerance").value_name("PART").value_parser(part).help(
                "Measured speeds: they may contradict the gears by this part, 0.5% or 0.005; the answer tells by how \
                 much they do at worst",
            ))
            .arg(
                many("allow")
                    .value_name("FOLDER")
                    .value_parser(value_parser!(PathBuf))
                    .help("Tables that the train file names may lie in this folder too, not only in that of the file"),
            );
    }
    for extra in entry.extras {
        c = c.arg(
            Arg::new(extra.name)
                .long(extra.name)
                .value_name(extra.value)
                .value_parser(value_parser!(PathBuf))
                .help(extra.about),
        );
    }
    let forms = forms(entry);
    let told: Vec<String> = entry.forms.iter().map(|f| format!("{}: {}", f.name, f.about)).collect();
    let told = if told.is_empty() { String::new() } else { format!(" ({})", told.join("; ")) };
    c = c.arg(
        Arg::new("format")
            .long("format")
            .value_name("FORM")
            .value_parser(PossibleValuesParser::new(forms))
            .help(format!("What to print or write; else what the name of the output file says{told}")),
    );
    if entry.tables.len() > 1 {
        c = c.arg(
            Arg::new("table")
                .long("table")
                .value_name("TABLE")
                .value_parser(PossibleValuesParser::new(entry.tables))
                .help("With --format csv, jsonl or parquet: only this table, without a heading"),
        );
    }
    c = c
        .arg(
            Arg::new("output")
                .short('o')
                .long("output")
                .visible_alias("out")
                .value_name("FILE")
                .value_parser(value_parser!(PathBuf))
                .help("Write into this file; its ending says in which form. A folder where there are several files"),
        )
        .arg(Arg::new("force").long("force").action(ArgAction::SetTrue).help("Replace files that are there already"));
    if entry.of != Of::Nothing || entry.is_cut {
        let help = "Go on, however long it takes and however large it gets";
        c = c.arg(Arg::new("yes").long("yes").action(ArgAction::SetTrue).help(help));
    }
    match entry.name {
        "export" => crate::fmu::options(c),
        "sweep" => crate::sweep::options(c),
        "report" => crate::pdf::options(c),
        _ => c,
    }
}
