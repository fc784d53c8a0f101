//! `willis merge`: the shards of a sweep put together, after it is clear that they belong together.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use willis::study::{Shard, SweepReport as Report};
use willis_ask::questions::sweep_text;

use super::parts::{said, sha256_of, sidecar, table};
use super::piece::Piece;
use super::table::Form;
use crate::{Ended, input, output};

/// The command that puts shards together.
pub fn merge_command() -> Command {
    let path = |name: &'static str, value: &'static str| {
        Arg::new(name).value_name(value).required(true).value_parser(value_parser!(PathBuf))
    };
    let output = path("output", "FILE").short('o').long("output").visible_alias("out");
    Command::new("merge")
        .about("Put the shards of a sweep together, after checking that they belong together")
        .arg(output.help("The table to write"))
        .arg(
            path("shards", "SHARDS")
                .num_args(1..)
                .help("The shards, in any order; what was written beside them must be there too"),
        )
        .arg(Arg::new("force").long("force").action(ArgAction::SetTrue).help("Replace files that are there already"))
}

/// Puts shards together.
pub fn run_merge(matches: &ArgMatches) -> Result<Ended, Ended> {
    let out = matches.get_one::<PathBuf>("output").expect("it is required");
    let shards: Vec<PathBuf> = matches.get_many("shards").into_iter().flatten().cloned().collect();
    let beside: Vec<PathBuf> = shards.iter().map(|s| sidecar(s)).collect();
    let read: Vec<&Path> = shards.iter().chain(&beside).map(PathBuf::as_path).collect();
    output::apart(out, &read)?;
    output::apart(&sidecar(out), &read)?;
    Ok(Ended::Answered(sweep_text(&merge(out, &shards, matches.get_flag("force"))?)))
}

/// A shard that was read.
struct Part {
    path: PathBuf,
    shard: Shard,
    report: Report,
}

impl Part {
    /// Reads what stands beside a shard, and checks that the table is the one that was written.
    fn read(path: &Path, form: Form) -> Result<Self, String> {
        let beside = sidecar(path);
        let text = input::whole(&beside).and_then(|t| serde_json::from_slice::<Report>(&t).map_err(|e| e.to_string()));
        let report =
            text.map_err(|e| format!("{}: what belongs beside every shard cannot be read: {e}\n", beside.display()))?;
        let wrong = |why: &str| Err(format!("{}: {why}\n", path.display()));
        let sum = sha256_of(path);
        if Form::of(path) != Some(form) || sum.is_err() {
            return wrong(&format!("is no table written as {}", form.name()));
        }
        if sum.ok() != report.table_sha256 {
            return wrong(
                "is not the table that was written (cut, changed, or of another shard); make that shard again",
            );
        }
        match report.shard {
            Some(shard) => Ok(Self { path: path.to_owned(), shard, report }),
            None => wrong("is a whole sweep, no shard"),
        }
    }
}

/// Why shards do not make a sweep; they stand in their order.
fn misfits(all: &[Part]) -> Vec<String> {
    let Some(first) = all.first() else { return vec![] };
    let (path, n) = (first.path.display(), first.shard.of);
    let one = |other: &Part| {
        let own = other.path.display();
        if other.report.study != first.report.study {
            let is_same = other.report.study.sha256 == first.report.study.sha256;
            Some(format!("{own}: {} than {path}\n", if is_same { "was cut otherwise" } else { "is of another sweep" }))
        } else if other.shard.of != n {
            Some(format!("{own}: is shard {} of {}, {path} one of {n}\n", other.shard.number, other.shard.of))
        } else {
            None
        }
    };
    let wrong: Vec<String> = all[1..].iter().filter_map(one).collect();
    if !wrong.is_empty() {
        return wrong;
    }
    // A file may say that there are more shards than could be listed.
    const MOST: usize = 50;
    let list = |what: &str, numbers: &mut dyn Iterator<Item = u64>, count: u64, of: &str| {
        let all: Vec<String> = numbers.take(MOST).map(|k| k.to_string()).collect();
        let more = count - all.len() as u64;
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        (count > 0).then(|| format!("{what}: shard {}{more}{of}\n", all.join(", ")))
    };
    let twice: Vec<u64> = all.windows(2).filter(|w| w[0].shard == w[1].shard).map(|w| w[0].shard.number).collect();
    let numbers: BTreeSet<u64> = all.iter().map(|part| part.shard.number).collect();
    let mut missing = (1..=n).filter(|k| !numbers.contains(k));
    let lists = [
        list("given twice", &mut twice.iter().copied(), twice.len() as u64, ""),
        list("missing", &mut missing, n - numbers.len() as u64, &format!(" of {n}")),
    ];
    lists.into_iter().flatten().collect()
}

/// Puts the shards of a sweep together.
fn merge(out: &Path, shards: &[PathBuf], force: bool) -> Result<Report, String> {
    let Some(form) = Form::of(out) else {
        return Err(format!("{}: end the name with .csv, .jsonl or .parquet\n", out.display()));
    };
    output::free(out, force)?;
    output::free(&sidecar(out), force)?;
    let (mut all, mut wrong) = (vec![], vec![]);
    for shard in shards {
        match Part::read(shard, form) {
            Ok(part) => all.push(part),
            Err(why) => wrong.push(why),
        }
    }
    all.sort_by_key(|part| part.shard.number);
    if wrong.is_empty() {
        wrong = misfits(&all);
    }
    if !wrong.is_empty() {
        const MOST: usize = 50;
        let more = wrong.len().saturating_sub(MOST);
        let more = if more > 0 { format!("… and {more} more\n") } else { String::new() };
        wrong.truncate(MOST);
        return Err(format!("{}{more}these shards do not make a sweep\n", wrong.concat()));
    }
    let reports: Vec<Report> = all.iter().map(|part| part.report.clone()).collect();
    let Some(mut report) = Report::merged(&reports) else { return Err("no shards to merge\n".into()) };
    if report.rows != report.study.points {
        return Err(format!("the shards have {} rows, the sweep {} points\n", report.rows, report.study.points));
    }
    let pieces: Vec<Piece> = all.into_iter().map(|part| Piece { path: part.path, is_table: true }).collect();
    let whole = table(out, form, &pieces, &mut report, force)?;
    let told = said(&report);
    whole.complete()?;
    output::write(&sidecar(out), told.as_bytes(), force)?;
    Ok(report)
}
