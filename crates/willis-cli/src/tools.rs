//! What only a command line has: the studio, schemas, completions, manual pages, shards put together.

use std::path::PathBuf;

use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use willis_ask::{File, QUESTIONS, RefusalReport};

use crate::run::deliver;
use crate::{Ended, studio, sweep, topics};

/// A command that asks no question.
pub struct Tool {
    pub name: &'static str,
    pub command: fn() -> Command,
    /// Takes its own options and the whole command.
    pub run: fn(&ArgMatches, Command) -> Result<Ended, Ended>,
}

/// All of them.
pub const TOOLS: &[Tool] = &[
    Tool { name: "merge", command: sweep::merge_command, run: |own, _| sweep::run_merge(own) },
    Tool { name: "studio", command: studio::command, run: |own, _| studio::run(own) },
    Tool { name: "schema", command: schema_command, run: schema },
    Tool { name: "completions", command: completions_command, run: completions },
    Tool { name: "man", command: man_command, run: man },
    Tool { name: "help", command: topics::command, run: topics::run },
];

fn schema_command() -> Command {
    let question = Arg::new("question").value_name("QUESTION").value_parser(value_parser!(String));
    Command::new("schema")
        .about("Print the JSON Schema of the train file, of an answer, or of a request")
        .long_about(
            "Print the JSON Schema of the train file, for editors; with a QUESTION that of its answer, with --request \
             that of its request. `willis schema list` lists all questions with their contracts, tables and forms, as JSON.",
        )
        .arg(question.help("The question: analyze, sweep, ...; refusal; or list"))
        .arg(
            Arg::new("request")
                .long("request")
                .action(ArgAction::SetTrue)
                .requires("question")
                .help("That of the request"),
        )
}

fn schema(matches: &ArgMatches, whole: Command) -> Result<Ended, Ended> {
    let pretty = |schema: &serde_json::Value| serde_json::to_string_pretty(schema).expect("plain data") + "\n";
    let Some(name) = matches.get_one::<String>("question") else {
        return Ok(Ended::Answered(pretty(&willis::train::schema())));
    };
    match name.as_str() {
        "list" => return Ok(Ended::Answered(pretty(&list(&whole)))),
        "refusal" => return Ok(Ended::Answered(pretty(RefusalReport::schema().as_value()))),
        _ => {}
    }
    let Some(entry) = willis_ask::question(name) else {
        let list = QUESTIONS.iter().map(|q| q.name).collect::<Vec<_>>().join(", ");
        return Err(format!("there is no question `{name}`; the questions are: {list}\n").into());
    };
    let schema = if matches.get_flag("request") { entry.request_schema() } else { entry.answer_schema() };
    Ok(Ended::Answered(pretty(schema.as_value())))
}

/// All questions as data, each with what its command line begins with: `willis draw KIND FILE`.
fn list(whole: &Command) -> serde_json::Value {
    let all = QUESTIONS.iter().map(|entry| {
        let mut told = entry.told();
        let own = whole.find_subcommand(entry.name).expect("every question is a command");
        let places = own.get_positionals().map(|arg| {
            let names = arg.get_value_names().unwrap_or_default().join(" ");
            if arg.is_required_set() { format!(" {names}") } else { format!(" [{names}]") }
        });
        told["usage"] = format!("willis {}{}", entry.name, places.collect::<String>()).into();
        told
    });
    all.collect()
}

fn completions_command() -> Command {
    let shell = Arg::new("shell").value_name("SHELL").required(true);
    Command::new("completions")
        .about("Print a completion script for a shell")
        .arg(shell.value_parser(value_parser!(clap_complete::Shell)).help("The shell"))
}

fn completions(matches: &ArgMatches, mut whole: Command) -> Result<Ended, Ended> {
    let shell = *matches.get_one::<clap_complete::Shell>("shell").expect("it is required");
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut whole, "willis", &mut script);
    Ok(Ended::Answered(String::from_utf8(script).expect("scripts are text")))
}

fn man_command() -> Command {
    let folder = Arg::new("folder").value_name("FOLDER").value_parser(value_parser!(PathBuf));
    Command::new("man")
        .about("Print the manual page, or write one for every command into a folder")
        .arg(folder.help("The folder"))
        .arg(Arg::new("force").long("force").action(ArgAction::SetTrue).help("Replace files that are there already"))
}

fn man(matches: &ArgMatches, whole: Command) -> Result<Ended, Ended> {
    let page = |command: &Command| {
        let man = clap_mangen::Man::new(command.clone());
        let mut bytes = Vec::new();
        man.render(&mut bytes).expect("writing to memory");
        File { name: man.get_filename(), bytes, about: String::new() }
    };
    let mut whole = whole;
    whole.build();
    let Some(folder) = matches.get_one::<PathBuf>("folder") else {
        return Ok(Ended::Answered(String::from_utf8(page(&whole).bytes).expect("pages are text")));
    };
    let pages = std::iter::once(&whole).chain(whole.get_subcommands()).map(page);
    Ok(Ended::Answered(deliver(pages.collect(), Some(folder), matches.get_flag("force"))?))
}
