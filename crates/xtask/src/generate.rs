//! Files that are generated and committed: `cargo xtask generate`, `validate`, and the step that compares.

use std::fs;

use crate::context::Context;
use crate::step::{Outcome, outcome};
use crate::tested::{test, test_with};

/// Files that are generated, and committed; so are the [`FIGURES`].
const GENERATED: &[&str] = &[
    "schema/willis-1.schema.json",
    "README.md",
    "schema/answers/analyze.schema.json",
    "schema/answers/new.schema.json",
    "schema/answers/check.schema.json",
    "schema/answers/flow.schema.json",
    "schema/answers/losses.schema.json",
    "schema/answers/sensitivity.schema.json",
    "schema/answers/uncertainty.schema.json",
    "schema/answers/sweep.schema.json",
    "schema/answers/cycle.schema.json",
    "schema/answers/compare.schema.json",
    "schema/answers/regimes.schema.json",
    "schema/answers/formula.schema.json",
    "schema/answers/locate.schema.json",
    "schema/answers/simulate.schema.json",
    "schema/answers/modes.schema.json",
    "schema/answers/draw.schema.json",
    "schema/answers/report.schema.json",
    "schema/answers/export.schema.json",
    "schema/answers/laws.schema.json",
    "schema/answers/validate.schema.json",
    "schema/answers/explain.schema.json",
    "schema/answers/refusal.schema.json",
    "validation/README.md",
    "validation/esmail-2018-table-1/README.md",
    "validation/losses/README.md",
    "validation/galvagno/README.md",
    "validation/modelica/README.md",
    "validation/wang-2020/report.md",
    "validation/wang-2020/planets.csv",
    "validation/wang-2020/speed-constant-torque.csv",
    "validation/wang-2020/speed-constant-power.csv",
    "validation/wang-2020/power.csv",
    "validation/wang-2020/temperature.csv",
    "validation/wang-2020/lubrication.csv",
    "crates/willis-casebook/data/examples/nrel-5mw-stage-1.toml",
    "crates/willis-casebook/data/examples/wang-herringbone.toml",
    "crates/willis-casebook/data/examples/wang-herringbone-physical.toml",
];

/// A crate can only hold what lies inside it: the case book has copies of the examples that it needs.
const COPIES: &str = "crates/willis-casebook/data/examples";

/// Figures of README and book, and what draws them.
const FIGURES: &[(&str, &[&str])] = &[
    (
        "book/src/figures/prius-regimes.svg",
        &["regimes", "examples/prius-p112.toml", "--terminals", "engine,ring,mg1", "--map"],
    ),
    (
        "book/src/figures/compound-regimes.svg",
        &[
            "regimes",
            "examples/compound-split.toml",
            "--terminals",
            "engine,wheels,mg_a,mg_b",
            "--balance",
            "mg_a,mg_b",
            "--map",
        ],
    ),
    ("book/src/figures/herringbone-flow.svg", &["flow", "examples/wang-herringbone.toml", "--output"]),
    (
        "book/src/figures/shift-handed-over.svg",
        &[
            "simulate",
            "examples/shift-8hp70.toml",
            "--scenario",
            "1 to 2, handed over",
            "--columns",
            "speed.input,speed.output,torque.C,torque.E,mode.C,mode.E",
            "--plot",
        ],
    ),
    (
        "book/src/figures/shift-overlap.svg",
        &[
            "simulate",
            "examples/shift-8hp70.toml",
            "--scenario",
            "overlap too long",
            "--columns",
            "speed.input,speed.output,torque.C,torque.E,mode.C,mode.E",
            "--plot",
        ],
    ),
    (
        "book/src/figures/why-does-it-not-move.svg",
        &[
            "simulate",
            "examples/why-does-it-not-move.toml",
            "--scenario",
            "lift, let go, lower",
            "--columns",
            "speed.sun,torque.motor,mode",
            "--plot",
        ],
    ),
    (
        "book/src/figures/galvagno-coast-down.svg",
        &["simulate", "examples/galvagno-coast-down.toml", "--scenario", "coast down", "--plot"],
    ),
    ("book/src/figures/launch-modes.svg", &["modes", "examples/launch.toml", "--state", "clutch closed", "--plot"]),
    (
        "book/src/figures/8hp70-stick.svg",
        &["draw", "stick", "examples/zf-8hp70.toml", "--state", "3", "--theme", "auto", "-o"],
    ),
    ("book/src/figures/8hp70-shift.svg", &["draw", "shift", "examples/zf-8hp70.toml", "--theme", "auto", "-o"]),
    (
        "book/src/figures/8hp70-lever.svg",
        &["draw", "lever", "examples/zf-8hp70.toml", "--state", "3", "--theme", "auto", "-o"],
    ),
    ("book/src/figures/8hp70-map.svg", &["draw", "map", "examples/zf-8hp70.toml", "--theme", "auto", "-o"]),
    (
        "book/src/figures/herringbone-sankey.svg",
        &["draw", "sankey", "examples/wang-herringbone-physical.toml", "--theme", "auto", "-o"],
    ),
    (
        "book/src/figures/herringbone-losses.svg",
        &["draw", "losses", "examples/wang-herringbone-physical.toml", "--theme", "auto", "-o"],
    ),
    ("book/src/figures/nrel-front.svg", &["draw", "front", "examples/nrel-5mw-stage-1.toml", "--theme", "auto", "-o"]),
    (
        "book/src/figures/nrel-tornado.svg",
        &["draw", "tornado", "examples/nrel-5mw-stage-1.toml", "--theme", "auto", "-o"],
    ),
    ("book/src/figures/nrel-band.svg", &["draw", "band", "examples/nrel-5mw-stage-1.toml", "--theme", "auto", "-o"]),
    ("book/src/figures/nrel-film.svg", &["draw", "film", "examples/nrel-5mw-stage-1.toml", "--theme", "auto", "-o"]),
];

/// Where the schemas of answers lie; each is called by its question.
const ANSWERS: &str = "schema/answers/";

/// Writes the JSON Schema of every answer.
fn write_schemas(context: &Context) -> Result<(), String> {
    for file in GENERATED.iter().filter(|f| f.starts_with(ANSWERS)) {
        let question = file[ANSWERS.len()..].split('.').next().unwrap_or_default();
        let schema = context.output(context.willis().args(["schema", question]))?.stdout;
        let path = context.root.join(file);
        fs::create_dir_all(path.parent().expect("a folder")).map_err(|e| format!("{file}: {e}"))?;
        fs::write(&path, schema).map_err(|e| format!("{file}: {e}"))?;
    }
    Ok(())
}

/// Writes the table of questions into the README, between its marks.
fn write_questions(context: &Context) -> Result<(), String> {
    const MARKS: [&str; 2] = ["<!-- questions -->\n", "<!-- /questions -->"];
    let list = context.output(context.willis().args(["schema", "list"]))?.stdout;
    let list: serde_json::Value = serde_json::from_slice(&list).map_err(|e| format!("the list of questions: {e}"))?;
    let mut table = "| question | what it answers |\n|---|---|\n".to_owned();
    for question in list.as_array().into_iter().flatten() {
        let (name, about) = (&question["name"], question["about"].as_str().unwrap_or_default());
        let trains = match question["of"].as_str() {
            Some("train") => " FILE",
            Some("trains") => " FILES",
            Some("at-most-one") => " KIND FILE",
            _ => "",
        };
        let first = about.split("\n\n").next().unwrap_or_default().replace('\n', " ");
        table += &format!("| `willis {}{trains}` | {first} |\n", name.as_str().unwrap_or_default());
    }
    let path = context.root.join("README.md");
    let text = fs::read_to_string(&path).map_err(|e| format!("README.md: {e}"))?;
    let (before, rest) = text.split_once(MARKS[0]).ok_or("README.md has no table of questions")?;
    let (_, after) = rest.split_once(MARKS[1]).ok_or("README.md has no end of the table of questions")?;
    fs::write(&path, format!("{before}{}{table}{}{after}", MARKS[0], MARKS[1])).map_err(|e| format!("README.md: {e}"))
}

/// Writes every generated file. Needs the optimised program.
fn write_generated(context: &Context) -> Result<(), String> {
    write_schemas(context)?;
    write_questions(context)?;
    let schema = context.output(context.willis().arg("schema"))?.stdout;
    let file = context.root.join(GENERATED[0]);
    fs::create_dir_all(file.parent().expect("a folder")).map_err(|e| format!("the folder schema: {e}"))?;
    fs::write(&file, schema).map_err(|e| format!("{}: {e}", GENERATED[0]))?;
    for (file, arguments) in FIGURES {
        let path = context.root.join(file);
        fs::create_dir_all(path.parent().expect("a folder")).map_err(|e| format!("{file}: {e}"))?;
        context.output(context.willis().args(*arguments).arg(&path).arg("--force"))?;
    }
    for copy in GENERATED.iter().filter_map(|file| file.strip_prefix(COPIES)) {
        let from = context.root.join("examples").join(&copy[1..]);
        fs::copy(&from, context.root.join(COPIES).join(&copy[1..])).map_err(|e| format!("{}: {e}", from.display()))?;
    }
    write_pages(context)
}

/// Writes the pages of `validation`.
fn write_pages(context: &Context) -> Result<(), String> {
    let words = "cargo test -p willis -p willis-casebook --test validation -- --nocapture write_page";
    context.output(context.words(words).env("WILLIS_WRITE", "1")).map(drop)
}

/// `cargo xtask validate`
pub(crate) fn validate(context: &Context) -> Outcome {
    match write_pages(context) {
        Ok(()) => match &context.options.modelica {
            None => test(context, "cargo test --workspace --tests --no-fail-fast -- val_"),
            Some(folder) => {
                let words =
                    "cargo test -p willis-casebook --test validation -- --ignored --nocapture whole_trajectories";
                test_with(context, words, &[("WILLIS_MODELICA", folder.as_os_str())])
            }
        },
        Err(e) => Outcome::Failed(e),
    }
}

/// `cargo xtask generate`
pub(crate) fn generate(context: &Context) -> Outcome {
    outcome(build_willis(context).and_then(|()| write_generated(context)))
}

/// Writes the generated files, compares them with what was there, and puts that back.
pub(crate) fn generated(context: &Context) -> Outcome {
    let names = || GENERATED.iter().copied().chain(FIGURES.iter().map(|f| f.0));
    let read = || names().map(|name| fs::read(context.root.join(name)).ok()).collect::<Vec<_>>();
    let before = read();
    if let Err(e) = build_willis(context).and_then(|()| write_generated(context)) {
        return Outcome::Failed(e);
    }
    let after = read();
    let mut stale = Vec::new();
    for ((name, before), after) in names().zip(before).zip(after) {
        if before == after {
            continue;
        }
        let line = match (&before, &after) {
            (Some(before), Some(after)) => {
                let same = before.split(|b| *b == b'\n').zip(after.split(|b| *b == b'\n')).take_while(|(a, b)| a == b);
                format!("{name} differs from line {} on", same.count() + 1)
            }
            _ => format!("{name} is missing"),
        };
        stale.push(line);
        let file = context.root.join(name);
        let _ = before.map_or_else(|| fs::remove_file(&file), |bytes| fs::write(&file, bytes));
    }
    if stale.is_empty() {
        return Outcome::Passed;
    }
    Outcome::Failed(format!("{}: run `cargo xtask generate`", stale.join("; ")))
}

/// The optimised program.
pub(crate) fn build_willis(context: &Context) -> Result<(), String> {
    context.run("cargo build --quiet --release -p willis-cli")
}
