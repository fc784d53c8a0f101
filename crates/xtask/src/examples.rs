//! The program answers for every example train.

use std::fs;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use serde_json::Value;

use crate::context::{Context, said};
use crate::program::build_willis;
use crate::step::Outcome;

/// Example trains, by path from the root, in order.
pub(crate) fn example_files(context: &Context) -> Result<Vec<String>, String> {
    let folder = fs::read_dir(context.root.join("examples")).map_err(|e| format!("the folder examples: {e}"))?;
    let names = folder.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    let mut files: Vec<String> = names.filter(|n| n.ends_with(".toml")).map(|n| format!("examples/{n}")).collect();
    files.sort();
    if files.is_empty() {
        return Err("there are no examples".into());
    }
    Ok(files)
}

/// Names of the scenarios of a train file: the first key of each.
fn scenarios(text: &str) -> Vec<&str> {
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    let heads = lines.windows(2).filter(|w| w[0].split('#').next().is_some_and(|l| l.trim() == "[[scenario]]"));
    heads.filter_map(|w| w[1].strip_prefix("name = \"")?.split('"').next()).collect()
}

/// What is wrong with the answers for a train: every question, every scenario.
fn wrong_with(context: &Context, file: &str) -> Result<Vec<String>, String> {
    let mut wrong = Vec::new();
    let json = ["--format", "json"];
    let questions = [
        &["check"][..],
        &["analyze"],
        &["analyze", json[0], json[1]],
        &["regimes"],
        &["regimes", json[0], json[1]],
        &["formula", "--derivatives"],
        &["report"],
    ];
    // Power flow and losses need an operating point.
    let text = fs::read_to_string(context.root.join(file)).map_err(|e| format!("{file}: {e}"))?;
    let flows: &[&[&str]] = match text.lines().any(|l| l.trim() == "[[operation]]") {
        true => &[
            &["flow"],
            &["flow", "--format", "json"],
            &["flow", "--format", "svg"],
            &["losses"],
            &["losses", "--compare", "mesh_friction", "--format", "json"],
        ],
        false => &[],
    };
    let names = scenarios(&text);
    if names.len() != text.lines().filter(|l| l.trim_start().starts_with("[[scenario]]")).count() {
        wrong.push(format!("{file}: a scenario does not begin with its name"));
    }
    let runs: Vec<[&str; 5]> = (names.iter())
        .flat_map(|name| ["text", "json"].map(|format| ["simulate", "--scenario", name, "--format", format]))
        .collect();
    let shafts: &[&[&str]] = match text.contains("stiffness = ") {
        true => &[&["modes"], &["modes", "--format", "json"]],
        false => &[],
    };
    let moves = runs.iter().map(|r| &r[..]).chain(shafts.iter().copied());
    for arguments in questions.iter().chain(flows).copied().chain(moves) {
        let mut command = context.willis();
        match context.output(command.args(arguments).arg(file)) {
            Err(e) => wrong.push(e),
            Ok(output) if arguments.contains(&"json") && !is_object(&output.stdout) => {
                wrong.push(format!("`{}` does not print a JSON object", said(&command)));
            }
            Ok(_) => {}
        }
    }
    Ok(wrong)
}

/// Checks and analyses every example, and runs every scenario; two at a time.
pub(crate) fn examples(context: &Context) -> Outcome {
    let all = || -> Result<usize, String> {
        build_willis(context)?;
        let files = example_files(context)?;
        let next = AtomicUsize::new(0);
        let worker = || -> Result<Vec<String>, String> {
            let mut wrong = Vec::new();
            while let Some(file) = files.get(next.fetch_add(1, Ordering::Relaxed)) {
                wrong.extend(wrong_with(context, file)?);
            }
            Ok(wrong)
        };
        let [one, other] = thread::scope(|scope| {
            let workers = [scope.spawn(worker), scope.spawn(worker)];
            workers.map(|w| w.join().unwrap_or_else(|_| Err("a worker ended early".into())))
        });
        let wrong = [one?, other?].concat();
        if wrong.is_empty() { Ok(files.len()) } else { Err(wrong.join("\n")) }
    };
    match all() {
        Ok(count) => {
            println!(
                "{count} example trains: check, analyze, regimes, formula, report, flow, losses, simulate, modes, and as JSON"
            );
            Outcome::Passed
        }
        Err(e) => Outcome::Failed(e),
    }
}

/// Whether this is one JSON object.
fn is_object(text: &[u8]) -> bool {
    serde_json::from_slice::<Value>(text).is_ok_and(|v| v.is_object())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenarios_are_found_by_name() {
        let text = "[[scenario]]\nname = \"up, down\"\n\n[[scenario.source]]\nname = \"m\"\n\n[[scenario]]   # two\nname = \"2\"\n";
        assert_eq!(scenarios(text), ["up, down", "2"]);
    }
}
