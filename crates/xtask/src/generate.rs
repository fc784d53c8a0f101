//! Files that are generated and committed: `cargo xtask generate`, `validate`, and the step that compares.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

use serde_json::Value;

use crate::context::Context;
use crate::growth;
use crate::program::build_willis;
use crate::reference::{PAGES, PARTS, write_reference};
use crate::step::{Outcome, outcome, tested};
use crate::tested::{test, test_with};

/// Files that are generated, and committed; so are the [`FIGURES`].
const GENERATED: &[&str] = &[
    "schema/willis-1.schema.json",
    "validation/README.md",
    "validation/esmail-2018-table-1/README.md",
    "validation/losses/README.md",
    "validation/design/README.md",
    "validation/galvagno/README.md",
    "validation/modelica/README.md",
    "validation/wang-2020/report.md",
    "validation/wang-2020/planets.csv",
    "validation/wang-2020/speed-constant-torque.csv",
    "validation/wang-2020/speed-constant-power.csv",
    "validation/wang-2020/power.csv",
    "validation/wang-2020/temperature.csv",
    "validation/wang-2020/lubrication.csv",
    "crates/willis/src/dynamics/fixed/examples/galvagno.toml",
    "crates/willis/src/dynamics/fixed/examples/launch.toml",
    "crates/willis/src/dynamics/fixed/examples/lossy-gear.toml",
    "crates/willis/src/dynamics/fixed/examples/shift-8hp70.toml",
    "crates/willis/src/dynamics/fixed/examples/simpson-ford-c4.toml",
    "crates/willis/src/dynamics/fixed/examples/zf-6hp26.toml",
    "crates/willis/src/dynamics/fixed/examples/zf-8hp70.toml",
    "crates/willis/src/study/sensitivity/examples/fva-planetary-stage.toml",
    "crates/willis/src/study/sensitivity/examples/industrial-planetary-heat.toml",
    "crates/willis/src/study/sensitivity/examples/two-speed-wet-brake.toml",
    "crates/willis-casebook/data/examples/nrel-5mw-stage-1.toml",
    "crates/willis-casebook/data/examples/wang-herringbone.toml",
    "crates/willis-casebook/data/examples/wang-herringbone-physical.toml",
];

/// A crate can only hold what lies inside it: the case book, and tests inside the library, have copies of the examples that
/// they need.
const COPIES: &[&str] = &[
    "crates/willis-casebook/data/examples",
    "crates/willis/src/dynamics/fixed/examples",
    "crates/willis/src/study/sensitivity/examples",
];

/// Figures of README and book, and what draws them.
const FIGURES: &[(&str, &[&str])] = &[
    (
        "book/src/figures/prius-regimes.svg",
        &["draw", "regimes", "examples/prius-p112.toml", "--terminals", "engine,ring,mg1", "--theme", "auto", "-o"],
    ),
    (
        "book/src/figures/compound-regimes.svg",
        &[
            "draw",
            "regimes",
            "examples/compound-split.toml",
            "--terminals",
            "engine,wheels,mg_a,mg_b",
            "--balance",
            "mg_a,mg_b",
            "--theme",
            "auto",
            "-o",
        ],
    ),
    (
        "book/src/figures/herringbone-flow.svg",
        &["draw", "flow", "examples/wang-herringbone.toml", "--theme", "auto", "-o"],
    ),
    (
        "book/src/figures/shift-handed-over.svg",
        &[
            "simulate",
            "examples/shift-8hp70.toml",
            "--scenario",
            "1 to 2, handed over",
            "--columns",
            "input.speed,output.speed,C.torque,E.torque,C.mode,E.mode",
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
            "input.speed,output.speed,C.torque,E.torque,C.mode,E.mode",
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
            "sun.speed,motor.torque,mode",
            "--plot",
        ],
    ),
    (
        "book/src/figures/galvagno-coast-down.svg",
        &["draw", "time", "examples/galvagno-coast-down.toml", "--part", "coast down", "--theme", "auto", "-o"],
    ),
    (
        "book/src/figures/9g-schemes.svg",
        &[
            "schemes",
            "--layout",
            "examples/mercedes-9g-tronic.toml",
            "--elements",
            "6",
            "--forward",
            "9",
            "--forward-range",
            "0.5..6",
            "--step",
            "1.1..1.8",
            "--reverse-range",
            "2..6",
            "--plot",
        ],
    ),
    ("book/src/figures/launch-run.svg", &["draw", "time", "examples/launch.toml", "--theme", "auto", "-o"]),
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
    (
        "book/src/figures/actuator.svg",
        &["design", "--kind", "3k", "--ratio", "100", "--ring", "90mm", "--module", "0.8mm", "--plot"],
    ),
    (
        "book/src/figures/heat-industrial.svg",
        &["draw", "heat", "examples/industrial-planetary-heat.toml", "--operation", "rated", "--theme", "auto", "-o"],
    ),
    ("book/src/figures/ivt-drive-away.svg", &["draw", "time", "examples/ivt-drive-away.toml", "--theme", "auto", "-o"]),
    ("book/src/figures/nrel-front.svg", &["draw", "front", "examples/nrel-5mw-stage-1.toml", "--theme", "auto", "-o"]),
    (
        "book/src/figures/two-mode-split.svg",
        &["draw", "split", "examples/two-mode-split.toml", "--theme", "auto", "-o"],
    ),
    (
        "book/src/figures/tractor-split.svg",
        &["draw", "split", "examples/tractor-hydrostat.toml", "--theme", "auto", "-o"],
    ),
    (
        "book/src/figures/belt-sankey.svg",
        &["draw", "sankey", "examples/belt-ivt.toml", "--operation", "forward", "--theme", "auto", "-o"],
    ),
    ("book/src/figures/8hp70-table.svg", &["draw", "table", "examples/zf-8hp70.toml", "--theme", "auto", "-o"]),
    (
        "book/src/figures/nrel-tornado.svg",
        &["draw", "tornado", "examples/nrel-5mw-stage-1.toml", "--theme", "auto", "-o"],
    ),
    ("book/src/figures/nrel-band.svg", &["draw", "band", "examples/nrel-5mw-stage-1.toml", "--theme", "auto", "-o"]),
    (
        "book/src/figures/esmail-regimes.svg",
        &["draw", "regimes", "examples/esmail-table-1.toml", "--theme", "auto", "-o"],
    ),
    (
        "book/src/figures/two-efficiencies-lever.svg",
        &["draw", "lever", "examples/two-efficiencies.toml", "--theme", "auto", "-o"],
    ),
    ("book/src/figures/prius-lever.svg", &["draw", "lever", "examples/prius-p112.toml", "--theme", "auto", "-o"]),
    (
        "book/src/figures/c4-front.svg",
        &["draw", "front", "examples/simpson-ford-c4.toml", "--nominal", "--theme", "auto", "-o"],
    ),
    (
        "book/src/figures/wolfrom-front.svg",
        &["draw", "front", "examples/wolfrom-498-self-locking.toml", "--nominal", "--theme", "auto", "-o"],
    ),
    (
        "book/src/figures/wolfrom-stick.svg",
        &["draw", "stick", "examples/wolfrom-498-self-locking.toml", "--theme", "auto", "-o"],
    ),
    (
        // What `willis new automatic` writes.
        "book/src/figures/new-stick.svg",
        &[
            "draw",
            "stick",
            "crates/willis-ask/src/questions/new/automatic.toml",
            "--state",
            "2",
            "--theme",
            "auto",
            "-o",
        ],
    ),
    (
        "book/src/figures/bevel-stick.svg",
        &["draw", "stick", "examples/bevel-differential.toml", "--theme", "auto", "-o"],
    ),
    (
        "book/src/figures/ravigneaux-stick.svg",
        &["draw", "stick", "examples/aisin-tl-80sn.toml", "--state", "3", "--theme", "auto", "-o"],
    ),
    ("book/src/figures/gen4-shift.svg", &["draw", "shift", "examples/zf-8hp-gen4.toml", "--theme", "auto", "-o"]),
    (
        "book/src/figures/fva-tornado.svg",
        &["draw", "tornado", "examples/fva-planetary-stage.toml", "--operation", "rated", "--theme", "auto", "-o"],
    ),
    (
        "book/src/figures/fva-band.svg",
        &["draw", "band", "examples/fva-planetary-stage.toml", "--operation", "rated", "--theme", "auto", "-o"],
    ),
    (
        "book/src/figures/fva-losses.svg",
        &["draw", "losses", "examples/fva-planetary-stage.toml", "--operation", "rated", "--theme", "auto", "-o"],
    ),
    ("book/src/figures/nrel-film.svg", &["draw", "film", "examples/nrel-5mw-stage-1.toml", "--theme", "auto", "-o"]),
];

/// Where the schemas of answers lie, each called by its question; and that of what is told instead of an answer.
const ANSWERS: &str = "schema/answers";
const REFUSAL: &str = "refusal";

/// Every question, as the program tells of it.
fn questions(context: &Context) -> Result<Vec<Value>, String> {
    let list = context.output(context.willis().args(["schema", "list"]))?.stdout;
    serde_json::from_slice(&list).map_err(|e| format!("the list of questions: {e}"))
}

/// Writes the JSON Schema of every answer, and none of a question that is gone.
fn write_schemas(context: &Context, questions: &[Value]) -> Result<(), String> {
    let folder = context.root.join(ANSWERS);
    let fail = |e: std::io::Error| format!("{ANSWERS}: {e}");
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).map_err(fail)?;
    for name in questions.iter().filter_map(|q| q["name"].as_str()).chain([REFUSAL]) {
        let schema = context.output(context.willis().args(["schema", name]))?.stdout;
        fs::write(folder.join(format!("{name}.schema.json")), schema).map_err(fail)?;
    }
    Ok(())
}

/// Writes every generated file. Needs the optimised program.
fn write_generated(context: &Context) -> Result<(), String> {
    let questions = questions(context)?;
    write_schemas(context, &questions)?;
    let schema = context.output(context.willis().arg("schema"))?.stdout;
    let file = context.root.join(GENERATED[0]);
    fs::create_dir_all(file.parent().expect("a folder")).map_err(|e| format!("the folder schema: {e}"))?;
    fs::write(&file, schema).map_err(|e| format!("{}: {e}", GENERATED[0]))?;
    for (file, arguments) in FIGURES {
        let path = context.root.join(file);
        fs::create_dir_all(path.parent().expect("a folder")).map_err(|e| format!("{file}: {e}"))?;
        context.output(context.willis().args(*arguments).arg(&path).arg("--force"))?;
    }
    growth::write(&context.root)?;
    let is_copy = |file: &&&str| COPIES.iter().any(|folder| file.starts_with(folder));
    for copy in GENERATED.iter().filter(is_copy) {
        let from = context.root.join("examples").join(copy.rsplit('/').next().expect("a name"));
        fs::copy(&from, context.root.join(copy)).map_err(|e| format!("{}: {e}", from.display()))?;
    }
    write_pages(context)?;
    // Its counts are those of the pages.
    write_reference(context)
}

/// Writes the pages of `validation`.
fn write_pages(context: &Context) -> Result<(), String> {
    // With the features that all tests have, so that nothing is built twice.
    let words = "cargo test --workspace --test validation -- --nocapture write_page";
    context.output(context.words(words).env("WILLIS_WRITE", "1")).map(drop)
}

/// `cargo xtask validate`
pub(crate) fn validate(context: &Context) -> Outcome {
    tested(write_pages(context).and_then(|()| match &context.options.modelica {
        None => test(context, "cargo test --workspace --tests --no-fail-fast -- val_"),
        Some(folder) => {
            let words = "cargo test --workspace --test validation -- --ignored --nocapture whole_trajectories";
            test_with(context, words, &[("WILLIS_MODELICA", folder.as_os_str())])
        }
    }))
}

/// `cargo xtask generate`
pub(crate) fn generate(context: &Context) -> Outcome {
    outcome(build_willis(context).and_then(|()| write_generated(context)))
}

/// Every generated file that is there, with what is in it.
fn there(context: &Context) -> Result<BTreeMap<String, Vec<u8>>, String> {
    let mut names: Vec<String> =
        GENERATED.iter().chain(FIGURES.iter().map(|f| &f.0)).map(|n| (*n).to_owned()).collect();
    names.push(growth::FIGURE.to_owned());
    names.extend(PAGES.iter().map(|p| p.0).chain(PARTS.iter().map(|p| p.0)).map(str::to_owned));
    names.sort();
    names.dedup();
    // A folder that is not there has no file.
    for entry in fs::read_dir(context.root.join(ANSWERS)).into_iter().flatten() {
        let name = entry.map_err(|e| format!("{ANSWERS}: {e}"))?.file_name();
        names.push(format!("{ANSWERS}/{}", name.to_string_lossy()));
    }
    Ok(names.into_iter().filter_map(|name| Some((name.clone(), fs::read(context.root.join(name)).ok()?))).collect())
}

/// Writes the generated files, compares them with what was there, and puts that back.
pub(crate) fn generated(context: &Context) -> Outcome {
    outcome(build_willis(context).and_then(|()| compare(context)))
}

fn compare(context: &Context) -> Result<(), String> {
    let before = there(context)?;
    let written = write_generated(context);
    let after = there(context)?;
    let mut stale = Vec::new();
    for name in before.keys().chain(after.keys()).collect::<BTreeSet<_>>() {
        let (old, new) = (before.get(name), after.get(name));
        if old == new {
            continue;
        }
        stale.push(match (old, new) {
            (Some(old), Some(new)) => {
                let same = old.split(|b| *b == b'\n').zip(new.split(|b| *b == b'\n')).take_while(|(a, b)| a == b);
                format!("{name} differs from line {} on", same.count() + 1)
            }
            (None, _) => format!("{name} is missing"),
            (_, None) => format!("{name} is no longer generated"),
        });
        let file = context.root.join(name);
        let back = old.map_or_else(|| fs::remove_file(&file), |bytes| fs::write(&file, bytes));
        back.map_err(|e| format!("{name}: {e}"))?;
    }
    written?;
    if stale.is_empty() { Ok(()) } else { Err(format!("{}: run `cargo xtask generate`", stale.join("; "))) }
}
